//! The data table as numbered bits, so that overlapping addresses can be compared.
//!
//! Every data file is a [`Space`] of bits: bit 0 is bit 0 of word 0 of element 0, elements follow one
//! another as they do in memory. Words of files O and I are placed by the I/O configuration; where
//! that does not know the slot, the slot gets a space of its own, because then the place of its words
//! in the file is not known either.

use std::collections::HashMap;

use ladder::{Address, FileType, Image, IoConfiguration, Place, members_of};

/// Number of bits of an area whose end is not known.
pub(crate) const OPEN: u64 = u64::MAX;

/// Elements of function files that the project does not contain: wider than any known one.
const UNKNOWN_WORDS: u16 = 256;

/// What tells spaces apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Key {
    pub(crate) file_type: FileType,
    /// `None`: any file of the type, for addresses whose file number is indirect.
    pub(crate) number: Option<u16>,
    /// A slot whose place in the I/O files is not known; always given for M0 and M1.
    pub(crate) slot: Option<u16>,
}

/// One data file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Space {
    pub(crate) key: Key,
    pub(crate) words_per_element: u16,
    /// `None`: the image has no such file, or its size says nothing about this space.
    pub(crate) elements: Option<u16>,
    /// There is a data file behind the space, or it is one of any files.
    pub(crate) exists: bool,
}

impl Space {
    /// Bits per element.
    pub(crate) fn stride(&self) -> u64 {
        u64::from(self.words_per_element.max(1)) * 16
    }

    /// Bits of the file, if known.
    pub(crate) fn bits(&self) -> Option<u64> {
        self.elements.map(|elements| u64::from(elements) * self.stride())
    }
}

/// Part of an element, for areas that repeat in every element: `T4:[N7:0].ACC`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Part {
    pub(crate) offset: u64,
    pub(crate) bits: u64,
}

/// A stretch of bits of one space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Area {
    pub(crate) space: usize,
    pub(crate) first: u64,
    /// [`OPEN`] when it reaches to the end of the file.
    pub(crate) bits: u64,
    /// Only this part of each element inside.
    pub(crate) part: Option<Part>,
}

impl Area {
    pub(crate) fn end(&self) -> u64 {
        self.first.saturating_add(self.bits)
    }

    /// The areas have a bit in common; `stride` is that of their space.
    pub(crate) fn overlaps(&self, other: &Area, stride: u64) -> bool {
        let (first, end) = (self.first.max(other.first), self.end().min(other.end()));
        if first >= end {
            return false;
        }
        match (self.part, other.part) {
            (None, None) => true,
            (Some(part), None) | (None, Some(part)) => part_meets(part, first, end, stride),
            (Some(a), Some(b)) => a.offset.max(b.offset) < (a.offset + a.bits).min(b.offset + b.bits),
        }
    }
}

/// The repeated part has a bit in `first..end`.
fn part_meets(part: Part, first: u64, end: u64, stride: u64) -> bool {
    if end - first >= stride {
        return true;
    }
    let (low, high) = (first % stride, first % stride + (end - first));
    let hits = |offset: u64| low.max(offset) < high.min(offset + part.bits);
    hits(part.offset) || hits(part.offset + stride)
}

/// Where an address leads.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    /// The bits it can mean.
    pub(crate) area: Area,
    /// It means exactly these; `false` when brackets or S:24 decide at run time.
    pub(crate) definite: bool,
}

/// The spaces of an image, made as addresses need them.
pub(crate) struct Spaces<'a> {
    image: &'a Image,
    by_key: HashMap<Key, usize>,
    /// Whole data files by number, because nearly every address is in one.
    by_number: Vec<Option<(FileType, usize)>>,
    list: Vec<Space>,
}

/// File numbers that exist.
const NUMBERS: usize = 256;

impl<'a> Spaces<'a> {
    pub(crate) fn new(image: &'a Image) -> Spaces<'a> {
        Spaces { image, by_key: HashMap::new(), by_number: vec![None; NUMBERS], list: Vec::new() }
    }

    pub(crate) fn get(&self, space: usize) -> Option<&Space> {
        self.list.get(space)
    }

    pub(crate) fn len(&self) -> usize {
        self.list.len()
    }

    pub(crate) fn stride(&self, space: usize) -> u64 {
        self.get(space).map_or(16, Space::stride)
    }

    pub(crate) fn io(&self) -> &'a IoConfiguration {
        &self.image.io
    }

    /// The space of this key if any address has led there.
    pub(crate) fn find(&self, key: Key) -> Option<usize> {
        let known = match key {
            Key { number: Some(number), slot: None, .. } => self.by_number.get(usize::from(number)).copied().flatten(),
            _ => None,
        };
        match known {
            Some((file_type, id)) if file_type == key.file_type => Some(id),
            _ => self.by_key.get(&key).copied(),
        }
    }

    fn id(&mut self, key: Key) -> usize {
        if let Some(id) = self.find(key) {
            return id;
        }
        let file = key.number.and_then(|number| self.image.data_file(key.file_type, number));
        let stored = file.map(|file| file.words_per_element).filter(|words| *words > 0);
        let words = stored.or(key.file_type.words_per_element()).unwrap_or(UNKNOWN_WORDS);
        let sized = key.slot.is_none() && !matches!(key.file_type, FileType::M0 | FileType::M1);
        self.list.push(Space {
            key,
            words_per_element: if key.file_type.has_slots() { 1 } else { words },
            elements: file.filter(|_| sized).map(|file| file.elements),
            exists: file.is_some() || key.number.is_none(),
        });
        let id = self.list.len() - 1;
        self.by_key.insert(key, id);
        // Function files share their numbers with data files: the first one met keeps the place.
        if let Key { number: Some(number), slot: None, file_type } = key
            && let Some(place @ None) = self.by_number.get_mut(usize::from(number))
        {
            *place = Some((file_type, id));
        }
        id
    }

    /// The place of an address; `#` is not looked at.
    pub(crate) fn place(&mut self, address: &Address) -> Placed {
        let (key, word_index) = key_of(address, self.io());
        let space = self.id(key);
        place_in(space, self.stride(space), address, word_index)
    }

    /// As [`Spaces::place`], for addresses whose file, or any file of the type, something led to.
    pub(crate) fn find_place(&self, address: &Address) -> Option<Placed> {
        let (key, word_index) = key_of(address, self.io());
        let space = self.find(key).or_else(|| self.find(Key { number: None, slot: None, ..key }))?;
        Some(place_in(space, self.stride(space), address, word_index))
    }

    /// 16-bit words of one element of the file an address lies in.
    pub(crate) fn words_per_element(&mut self, address: &Address) -> u16 {
        let (key, _) = key_of(address, self.io());
        let space = self.id(key);
        self.get(space).map_or(1, |space| space.words_per_element)
    }

    /// The address of the bits `first..first + bits`, as a program writes it.
    pub(crate) fn address_of(&self, space: usize, first: u64, bits: u64) -> Option<Address> {
        let space = self.get(space)?;
        let Key { file_type, number, slot } = space.key;
        let file = number.or(file_type.implied_file()).unwrap_or(0);
        let bit = (bits == 1).then_some(first);
        if file_type.has_slots() {
            let word = u16::try_from(first / 16).ok()?;
            let address = match slot {
                Some(slot) => Address::element(file_type, file, slot).with_word(word),
                None => self.io().address_of(file_type, word)?,
            };
            return Some(match bit {
                Some(bit) => address.with_bit((bit % 16) as u16),
                None => address,
            });
        }
        let offset = first % space.stride();
        let address = Address::element(file_type, file, u16::try_from(first / space.stride()).ok()?);
        if !file_type.is_structure() {
            return Some(match bit {
                Some(_) => address.with_bit(u16::try_from(offset).ok()?),
                None => address,
            });
        }
        let word = u16::try_from(offset / 16).ok()?;
        // `T4:0/DN` leaves the word out, as the address of the whole element does.
        let flag = bit.is_some() && word == 0 && matches!(file_type, FileType::T | FileType::C | FileType::R);
        let whole = offset == 0 && bits >= space.stride();
        let address = if flag || whole { address } else { address.with_word(word) };
        Some(match bit {
            Some(_) => address.with_bit((offset % 16) as u16),
            None => address,
        })
    }

    /// An area in words of addresses: `N7:3`, `N7:10..N7:14`, `T4:*.ACC` (that member of any
    /// element), `N7:10..` (from there on), `N*:2` (in any N file).
    pub(crate) fn text(&self, area: Area) -> String {
        let Some(space) = self.get(area.space) else { return String::new() };
        let file = match (space.key.number, space.key.file_type.implied_file()) {
            (None, None) => format!("{}*", space.key.file_type),
            (None, Some(_)) => space.key.file_type.to_string(),
            (Some(number), implied) if Some(number) == implied => space.key.file_type.to_string(),
            (Some(number), _) => format!("{}{number}", space.key.file_type),
        };
        let place = |first, bits| match self.address_of(area.space, first, bits) {
            Some(address) => match address.to_string().split_once(':') {
                Some((_, place)) => format!("{file}:{place}"),
                None => address.to_string(),
            },
            None => format!("{file}, word {}", first / 16),
        };
        if let Some(part) = area.part {
            return place(part.offset, part.bits).replacen(":0", ":*", 1);
        }
        if area.bits == OPEN {
            return if area.first == 0 { format!("{file}:*") } else { format!("{}..", place(area.first, 16)) };
        }
        let whole = area.first.is_multiple_of(space.stride()) && area.bits.is_multiple_of(space.stride());
        let unit = match area.bits {
            1 => 1,
            _ if whole => space.stride(),
            32 if self.is_long(space, area.first) => 32,
            bits if area.first.is_multiple_of(16) && bits.is_multiple_of(16) => 16,
            _ => 1,
        };
        if area.bits <= unit {
            return place(area.first, area.bits);
        }
        format!("{}..{}", place(area.first, unit), place(area.end() - unit, unit))
    }

    /// A two-word member starts at this bit.
    fn is_long(&self, space: &Space, first: u64) -> bool {
        let offset = first % space.stride();
        members_of(space.key.file_type).any(|m| m.long && u64::from(m.word) * 16 == offset)
    }
}

/// The space an address lies in, and for O and I the word of the file.
fn key_of(address: &Address, io: &IoConfiguration) -> (Key, u64) {
    let file_type = address.file_type;
    let number = address.file.number();
    let key = |number, slot| Key { file_type, number, slot };
    if !file_type.has_slots() {
        return (key(number, None), 0);
    }
    match address.element.number() {
        None => (key(None, None), 0),
        Some(slot) => match io.word_index(address) {
            Some(word) => (key(number, None), u64::from(word)),
            None => (key(number, Some(slot)), u64::from(address.word.unwrap_or(0))),
        },
    }
}

fn place_in(space: usize, stride: u64, address: &Address, word_index: u64) -> Placed {
    let file_type = address.file_type;
    let word = address.word.unwrap_or(0);
    let long_member = members_of(file_type).any(|m| m.long && m.bit.is_none() && Some(m.word) == address.word);
    let slots = file_type.has_slots();
    // Offset inside the element (for slots: inside the word) and size of what is named.
    let in_element = if slots { 0 } else { u64::from(word) * 16 };
    let (offset, bits) = match (&address.bit, address.word) {
        (None, Some(_)) if long_member => (in_element, 32),
        (None, Some(_)) => (in_element, 16),
        (None, None) => (0, stride),
        (Some(Place::Number(bit)), _) => (in_element + u64::from(*bit), 1),
        (Some(Place::Indirect(_)), _) => (in_element, OPEN),
    };
    let exact_file = address.file.number().is_some();
    let start = match address.element.number() {
        Some(_) if slots => Some(word_index * 16),
        Some(element) => Some(u64::from(element) * stride),
        None => None,
    };
    match start {
        Some(start) => Placed {
            area: Area { space, first: start + offset, bits, part: None },
            definite: exact_file && bits != OPEN,
        },
        None => {
            let whole = bits == OPEN || (offset == 0 && bits >= stride) || slots;
            let part = (!whole).then_some(Part { offset, bits });
            Placed { area: Area { space, first: 0, bits: OPEN, part }, definite: false }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ladder::{Confidence, DataFile, IoRange, Module, Slot};

    fn image() -> Image {
        let slot = |number, first_word, words, bits| Slot {
            number,
            module: Module {
                catalog: None,
                description: String::new(),
                identity: String::new(),
                confidence: Confidence::Unknown,
            },
            inputs: IoRange::default(),
            outputs: IoRange { first_word, words, bits },
            configuration: Vec::new(),
        };
        let mut image = Image {
            data_files: vec![
                DataFile::new(FileType::O, 0, 4),
                DataFile::new(FileType::T, 4, 10),
                DataFile::new(FileType::N, 7, 20),
                DataFile::new(FileType::L, 9, 5),
            ],
            ..Image::default()
        };
        image.io.slots = vec![slot(0, 0, 2, 24), slot(2, 2, 1, 8)];
        image
    }

    #[track_caller]
    fn placed(spaces: &mut Spaces<'_>, text: &str) -> Placed {
        spaces.place(&Address::parse(text).expect(text))
    }

    #[test]
    fn addresses_and_areas_convert_both_ways() {
        let image = image();
        let mut spaces = Spaces::new(&image);
        for (text, first, bits) in [
            ("N7:3", 48, 16),
            ("N7:3/15", 63, 1),
            ("T4:1", 48, 48),
            ("T4:1/DN", 61, 1),
            ("T4:1.ACC", 80, 16),
            ("T4:1.PRE/2", 66, 1),
            ("L9:1", 32, 32),
            ("L9:1/31", 63, 1),
            ("O:0.1/7", 23, 1),
            ("O:2.0", 32, 16),
            ("HSC:0.ACC", 80, 32),
            ("ST9:0.LEN", 0, 16),
        ] {
            let Placed { area, definite } = placed(&mut spaces, text);
            assert_eq!((area.first, area.bits, definite), (first, bits, true), "{text}");
            let back = spaces.address_of(area.space, area.first, area.bits).map(|a| a.to_string());
            assert_eq!(back.as_deref(), Some(text));
            assert_eq!(spaces.text(area), text);
        }
    }

    #[test]
    fn areas_read_as_addresses() {
        let image = image();
        let mut spaces = Spaces::new(&image);
        let n7 = placed(&mut spaces, "N7:10").area;
        for (area, text) in [
            (Area { bits: 80, ..n7 }, "N7:10..N7:14"),
            (Area { bits: 20, ..n7 }, "N7:10/0..N7:11/3"),
            (Area { bits: OPEN, ..n7 }, "N7:10.."),
            (Area { first: 0, bits: OPEN, ..n7 }, "N7:*"),
            (placed(&mut spaces, "T4:[N7:0].ACC").area, "T4:*.ACC"),
            (placed(&mut spaces, "T4:[N7:0]/DN").area, "T4:*/DN"),
            (placed(&mut spaces, "N[N7:0]:2/5").area, "N*:2/5"),
            (placed(&mut spaces, "N[N7:0]:[N7:1]").area, "N*:*"),
            (Area { bits: 144, ..placed(&mut spaces, "T4:2").area }, "T4:2..T4:4"),
            (Area { bits: 32, ..placed(&mut spaces, "T4:2.PRE").area }, "T4:2.PRE..T4:2.ACC"),
            (Area { bits: 48, ..placed(&mut spaces, "O:0.0").area }, "O:0.0..O:2.0"),
        ] {
            assert_eq!(spaces.text(area), text);
        }
    }

    #[test]
    fn a_slot_outside_the_configuration_has_its_own_space() {
        let image = image();
        let mut spaces = Spaces::new(&image);
        let known = placed(&mut spaces, "O:0.0/1").area;
        let unknown = placed(&mut spaces, "O:5.0/1").area;
        assert_ne!(known.space, unknown.space);
        assert_eq!(spaces.address_of(unknown.space, 1, 1).map(|a| a.to_string()).as_deref(), Some("O:5.0/1"));
    }

    #[test]
    fn run_time_addresses_reach_what_their_brackets_allow() {
        let image = image();
        let mut spaces = Spaces::new(&image);
        let acc = placed(&mut spaces, "T4:[N7:0].ACC");
        assert!(!acc.definite);
        for (text, meets) in [("T4:3.ACC", true), ("T4:3", true), ("T4:3/DN", false), ("T4:3.PRE", false)] {
            let other = placed(&mut spaces, text).area;
            assert_eq!(acc.area.overlaps(&other, 48), meets, "{text}");
            assert_eq!(other.overlaps(&acc.area, 48), meets, "{text}");
        }
        let bit = placed(&mut spaces, "N7:3/[N7:0]");
        assert!(!bit.definite);
        assert!(bit.area.overlaps(&placed(&mut spaces, "N7:3/4").area, 16));
        assert!(!bit.area.overlaps(&placed(&mut spaces, "N7:2").area, 16));
    }
}
