//! Where every data file lies in the one block of words a machine works on.

use std::collections::BTreeMap;

use ladder::{Address, DataFile, FileType, IoConfiguration, Place, members_of};

use crate::status;

/// A data file in the block.
#[derive(Clone, Debug)]
pub(crate) struct FileInfo {
    pub(crate) file_type: FileType,
    pub(crate) number: u16,
    /// Word index of element 0.
    pub(crate) start: u32,
    pub(crate) elements: u32,
    /// Words per element.
    pub(crate) size: u32,
}

impl FileInfo {
    pub(crate) fn end(&self) -> u32 {
        self.start + self.elements * self.size
    }

    pub(crate) fn contains(&self, word: u32) -> bool {
        (self.start..self.end()).contains(&word)
    }
}

/// What stands at an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Width {
    Bit,
    Word,
    Long,
    Float,
    /// A whole structured element.
    Element,
}

/// A place in the block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Location {
    pub(crate) word: u32,
    /// Bit in that word, 0 unless `width` is [`Width::Bit`].
    pub(crate) bit: u8,
    pub(crate) width: Width,
    /// Index of the file.
    pub(crate) file: usize,
}

/// The data files and the I/O words of an image.
#[derive(Clone, Debug, Default)]
pub(crate) struct Layout {
    pub(crate) files: Vec<FileInfo>,
    /// Word index of `(O or I or M0 or M1, slot, word)`.
    io: BTreeMap<(FileType, u16, u16), u32>,
    /// First word of the status file.
    pub(crate) status: usize,
    /// First word after the data table files.
    pub(crate) user_end: u32,
    /// Start, elements and words per element of the STI, EII and HSC function files.
    interrupts: [Option<(u32, u32, u32)>; 3],
    words: u32,
}

/// Function files with interrupts.
const INTERRUPTS: [FileType; 3] = [FileType::STI, FileType::EII, FileType::HSC];

/// Slots have at most this many words behind them when nothing says how many.
const MODULE_WORDS: u16 = 256;

impl Layout {
    /// Lays out `files` in order. `wanted` are I/O and module addresses `(type, slot, word)` in
    /// ascending order; those the configuration does not place get words of their own at the end of
    /// their file and are returned.
    pub(crate) fn new(
        files: &[&DataFile],
        io: &IoConfiguration,
        wanted: &[(FileType, u16, u16)],
    ) -> (Layout, Vec<u16>, Vec<(FileType, u16, u16)>) {
        let mut layout = Layout::default();
        let mut block = Vec::new();
        let mut unplaced = Vec::new();
        for file in files {
            let start = block.len() as u32;
            let size = u32::from(file.words_per_element.max(1));
            block.extend_from_slice(&file.words);
            block.resize(start as usize + file.elements as usize * size as usize, 0);
            let mut elements = u32::from(file.elements);
            if matches!(file.file_type, FileType::O | FileType::I) && !file.file_type.is_function_file() {
                elements += layout.place_io(file, io, wanted, start, &mut unplaced);
                block.resize((start + elements) as usize, 0);
            }
            if file.file_type == FileType::S {
                layout.status = start as usize;
                // The engine writes words that small processors do not have; they lie behind the file.
                block.resize(block.len().max(start as usize + status::WORDS), 0);
            }
            let user = !file.file_type.is_function_file();
            layout.files.push(FileInfo { file_type: file.file_type, number: file.number, start, elements, size });
            if user {
                layout.user_end = block.len() as u32;
            }
        }
        layout.place_modules(wanted, &mut block);
        layout.words = block.len() as u32;
        layout.interrupts = INTERRUPTS.map(|file_type| {
            let file = layout.files.iter().find(|file| file.file_type == file_type && file.number == 0)?;
            Some((file.start, file.elements, file.size))
        });
        (layout, block, unplaced)
    }

    /// Gives I/O words their place; answers how many words were added behind the file.
    fn place_io(
        &mut self,
        file: &DataFile,
        io: &IoConfiguration,
        wanted: &[(FileType, u16, u16)],
        start: u32,
        unplaced: &mut Vec<(FileType, u16, u16)>,
    ) -> u32 {
        for slot in &io.slots {
            let range = if file.file_type == FileType::I { slot.inputs } else { slot.outputs };
            for word in 0..range.words {
                let index = u32::from(range.first_word) + u32::from(word);
                if index < u32::from(file.elements) {
                    self.io.insert((file.file_type, slot.number, word), start + index);
                }
            }
        }
        let known = !io.slots.is_empty();
        let mut added = 0;
        let mut first = if known { u32::from(file.elements) } else { 0 };
        for key in wanted.iter().filter(|key| key.0 == file.file_type) {
            if self.io.contains_key(key) {
                continue;
            }
            if known {
                unplaced.push(*key);
            }
            self.io.insert(*key, start + first);
            first += 1;
            added = added.max(first.saturating_sub(u32::from(file.elements)));
        }
        added
    }

    /// M0 and M1 words: plain memory per slot, behind everything else.
    fn place_modules(&mut self, wanted: &[(FileType, u16, u16)], block: &mut Vec<u16>) {
        let mut slots: BTreeMap<(FileType, u16), u16> = BTreeMap::new();
        for (file_type, slot, word) in wanted.iter().filter(|key| matches!(key.0, FileType::M0 | FileType::M1)) {
            let most = slots.entry((*file_type, *slot)).or_default();
            *most = (*most).max(word.saturating_add(MODULE_WORDS));
        }
        for ((file_type, slot), words) in slots {
            let start = block.len() as u32;
            for word in 0..words {
                self.io.insert((file_type, slot, word), start + u32::from(word));
            }
            block.resize(block.len() + usize::from(words), 0);
            // The number of a module file is its slot: several of one type never collide.
            let elements = u32::from(words);
            self.files.push(FileInfo { file_type, number: slot, start, elements, size: 1 });
        }
    }

    /// First word of an element of the STI, EII or HSC function file.
    pub(crate) fn interrupt(&self, file_type: FileType, element: u32) -> Option<u32> {
        let index = INTERRUPTS.iter().position(|known| *known == file_type)?;
        let (start, elements, size) = (*self.interrupts.get(index)?)?;
        (element < elements).then(|| start + element * size)
    }

    pub(crate) fn words(&self) -> usize {
        self.words as usize
    }

    pub(crate) fn file(&self, file_type: FileType, number: u16) -> Option<usize> {
        self.files.iter().position(|file| file.file_type == file_type && file.number == number)
    }

    /// The file a word lies in.
    pub(crate) fn file_of(&self, word: u32) -> Option<usize> {
        self.files.iter().position(|file| file.contains(word))
    }

    /// Word index of a word of a slot.
    pub(crate) fn io_word(&self, file_type: FileType, slot: u16, word: u16) -> Option<u32> {
        self.io.get(&(file_type, slot, word)).copied()
    }

    /// The words of a slot that are known, ascending.
    pub(crate) fn slot_words(&self, file_type: FileType, slot: u16) -> impl Iterator<Item = u32> {
        self.io.range((file_type, slot, 0)..=(file_type, slot, u16::MAX)).map(|(_, index)| *index)
    }

    /// The place of a direct address; `None` when there is no such file, element, word or bit.
    pub(crate) fn locate(&self, address: &Address) -> Option<Location> {
        let element = address.element.number()?;
        let bit = match &address.bit {
            None => None,
            Some(Place::Number(bit)) => Some(*bit),
            Some(Place::Indirect(_)) => return None,
        };
        if address.file_type.has_slots() {
            let word = self.io_word(address.file_type, element, address.word.unwrap_or(0))?;
            let file = self.file_of(word)?;
            return finish(word, 1, FileType::N, 0, bit, file);
        }
        let file = self.file(address.file_type, address.file.number()?)?;
        let info = self.files.get(file)?;
        if u32::from(element) >= info.elements {
            return None;
        }
        let start = info.start + u32::from(element) * info.size;
        match (address.word, bit) {
            (None, None) => {
                let width = whole(info.file_type, info.size);
                Some(Location { word: start, bit: 0, width, file })
            }
            (sub, bit) => finish(start, info.size, info.file_type, sub.unwrap_or(0), bit, file),
        }
    }
}

/// What an element is when it is named as a whole.
pub(crate) fn whole(file_type: FileType, size: u32) -> Width {
    match file_type {
        FileType::F => Width::Float,
        FileType::L => Width::Long,
        _ if size == 1 => Width::Word,
        _ => Width::Element,
    }
}

/// A word, long word or bit inside the element at `start`.
fn finish(start: u32, size: u32, file_type: FileType, sub: u16, bit: Option<u16>, file: usize) -> Option<Location> {
    let sub = u32::from(sub);
    match bit {
        Some(bit) => {
            let sub = sub + u32::from(bit / 16);
            let bit = (bit % 16) as u8;
            (sub < size).then_some(Location { word: start + sub, bit, width: Width::Bit, file })
        }
        None => {
            let width = if is_long(file_type, sub) { Width::Long } else { Width::Word };
            let last = sub + u32::from(width == Width::Long);
            (last < size).then_some(Location { word: start + sub, bit: 0, width, file })
        }
    }
}

/// This word of an element begins a 32-bit member.
pub(crate) fn is_long(file_type: FileType, sub: u32) -> bool {
    members_of(file_type).any(|member| member.long && u32::from(member.word) == sub)
}
