//! Where the data of the original lies in Do-more memory.
//!
//! Data files keep the order of their words, so that indirect and block access stay what they are:
//!
//! | file | block | |
//! |---|---|---|
//! | I, O | X, Y | 16 points per word; words that are only used as words (analog) become WX, WY |
//! | B | C | 16 relays per word; N when its words are reached by run-time numbers or as a file |
//! | N, T, C, R, S and other word files | N | word by word, three words per timer, counter and control |
//! | L | D | |
//! | F | R | |
//! | ST | SL | |

use std::collections::BTreeMap;

use ladder::{Address, FileType, Image, Place};

use super::facts::Facts;

/// A Do-more memory block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)] // the names of the blocks
pub enum Block {
    X,
    Y,
    C,
    Wx,
    Wy,
    N,
    D,
    R,
    Sl,
    T,
}

/// Name, type word of MEM_CONFIG, elements of the default project.
const BLOCKS: [(Block, &str, &str, u32); 10] = [
    (Block::X, "X", "BIT", 2048),
    (Block::Y, "Y", "BIT", 2048),
    (Block::C, "C", "BIT", 2048),
    (Block::Wx, "WX", "SWORD", 256),
    (Block::Wy, "WY", "SWORD", 256),
    (Block::N, "N", "SWORD", 4096),
    (Block::D, "D", "SDWORD", 4096),
    (Block::R, "R", "REAL", 4096),
    (Block::Sl, "SL", "STRING", 64),
    (Block::T, "T", "TIMER", 256),
];

impl Block {
    /// All blocks a migration uses.
    pub fn all() -> impl Iterator<Item = Block> {
        BLOCKS.iter().map(|row| row.0)
    }

    fn row(self) -> (Block, &'static str, &'static str, u32) {
        BLOCKS.iter().copied().find(|row| row.0 == self).unwrap_or(BLOCKS[0])
    }

    /// `X`, `N`, ...
    pub fn name(self) -> &'static str {
        self.row().1
    }

    /// The type word of its elements.
    pub fn type_word(self) -> &'static str {
        self.row().2
    }

    /// Elements it has in a new project.
    pub fn default_count(self) -> u32 {
        self.row().3
    }

    /// The block of that name, upper or lower case.
    pub fn by_name(name: &str) -> Option<Block> {
        BLOCKS.iter().find(|row| row.1.eq_ignore_ascii_case(name)).map(|row| row.0)
    }

    /// Elements are bits.
    pub fn is_bits(self) -> bool {
        matches!(self, Block::X | Block::Y | Block::C)
    }
}

/// An element of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Element {
    /// The block.
    pub block: Block,
    /// The number in it.
    pub number: u32,
}

impl std::fmt::Display for Element {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{}", self.block.name(), self.number)
    }
}

/// A run of words of one data file, or one I/O word, and where it lies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Span {
    /// Type of the data file.
    pub file_type: FileType,
    /// Its number; for I, O, M0 and M1 the slot.
    pub file: u16,
    /// First word, counted through the file; for I, O, M0 and M1 the word of the slot.
    pub first_word: u32,
    /// Number of words.
    pub words: u32,
    /// Words per element of the data file.
    pub size: u32,
    /// Words of these that the original has: rungs that were never verified can name more.
    pub own: u32,
    /// Of I and O: index of the first word in the data file; `None` for a word the file does not have.
    pub stored: Option<u32>,
    /// Where the first word lies. In bit blocks a word takes 16 elements; in D and R an element takes
    /// two words, in SL one takes 42.
    pub at: Element,
}

impl Span {
    /// Elements of the block it takes.
    pub fn elements(&self) -> u32 {
        match self.at.block {
            block if block.is_bits() => self.words.saturating_mul(16),
            Block::D | Block::R => self.words / 2,
            Block::Sl => self.words / 42,
            _ => self.words,
        }
    }

    /// The address of its word `index`, counted from the span's first, as the original spells it.
    pub fn address(&self, index: u32) -> Option<Address> {
        let word = self.first_word.checked_add(index)?;
        if self.file_type.has_slots() {
            let file = self.file_type.implied_file()?;
            return Some(Address::element(self.file_type, file, self.file).with_word(u16::try_from(word).ok()?));
        }
        let size = self.size.max(1);
        let element = u16::try_from(word / size).ok()?;
        let address = Address::element(self.file_type, self.file, element);
        Some(match (size, self.at.block) {
            (1, _) | (_, Block::D | Block::R | Block::Sl) => address,
            _ => address.with_word(u16::try_from(word % size).ok()?),
        })
    }
}

/// All places.
#[derive(Clone, Debug, Default)]
pub struct Places {
    spans: Vec<Span>,
    /// Spans by file type and file number (I/O: slot), ascending first words.
    index: BTreeMap<(FileType, u16), Vec<usize>>,
    /// Single I/O points a person has put elsewhere: type, slot, word, bit.
    points: BTreeMap<(FileType, u16, u32, u16), Element>,
    /// First free element per block: what follows is for helpers.
    next: BTreeMap<Block, u32>,
    /// Bits are not put together to words.
    only_confirmed: bool,
}

impl Places {
    /// The allocation of an image without a person's choices: deterministic.
    ///
    /// `only_confirmed`: points and relays are never read as words (`C0:SW`), so a B file of which words are
    /// used lies in N.
    pub fn automatic(image: &Image, facts: &Facts, only_confirmed: bool) -> Places {
        let mut places = Places { only_confirmed, ..Places::default() };
        places.io(image, facts);
        // N7 first: its numbers stay what people know.
        let mut files: Vec<_> = image.data_files.iter().collect();
        files.sort_by_key(|file| (file.file_type != FileType::N, file.file_type == FileType::S, file.number));
        let named: BTreeMap<_, _> = facts.named().collect();
        for file in files {
            let elements = named.get(&(file.file_type, file.number)).map_or(0, |highest| u32::from(*highest) + 1);
            let size = u32::from(file.words_per_element.max(1));
            let own = u32::from(file.elements).saturating_mul(size);
            let words = own.max(elements.saturating_mul(size));
            places.data_file(facts, file.file_type, file.number, words, size, own);
        }
        // Files rungs name that the data table does not have: verifying would make them.
        for ((file_type, number), highest) in facts.named() {
            let known = image.data_files.iter().any(|file| {
                file.number == number && !matches!(file.file_type, FileType::Unused) && !file_type.is_function_file()
            });
            let Some(size) = file_type.words_per_element() else { continue };
            if !known && !file_type.is_function_file() {
                let size = u32::from(size);
                places.data_file(facts, file_type, number, (u32::from(highest) + 1).saturating_mul(size), size, 0);
            }
        }
        for file in &image.function_files {
            if file.file_type != FileType::RTC && facts.file(file.file_type, file.number) == Default::default() {
                continue;
            }
            let size = u32::from(file.words_per_element.max(1));
            let words = u32::from(file.elements).saturating_mul(size);
            places.append(file.file_type, file.number, 0, words, size, Block::N);
        }
        places
    }

    /// A data file of the data table.
    fn data_file(&mut self, facts: &Facts, file_type: FileType, number: u16, words: u32, size: u32, own: u32) {
        let block = match file_type {
            FileType::I | FileType::O | FileType::M0 | FileType::M1 => return,
            FileType::Unused | FileType::Reserved | FileType::Unknown(_) => return,
            FileType::B if self.only_confirmed && facts.file(FileType::B, number).words => Block::N,
            FileType::B if !facts.file(FileType::B, number).dynamic => Block::C,
            FileType::F => Block::R,
            FileType::L => Block::D,
            FileType::ST => Block::Sl,
            _ => Block::N,
        };
        let status = file_type == FileType::S;
        let words = if status { words.max(STATUS_WORDS) } else { words };
        let before = self.spans.len();
        self.append(file_type, number, 0, words, size, block);
        if let Some(span) = self.spans.get_mut(before) {
            // The controller has status words an old image does not hold.
            span.own = if status { words } else { own };
        }
    }

    /// I/O words of the configuration and those the program names besides.
    fn io(&mut self, image: &Image, facts: &Facts) {
        let mut words: BTreeMap<(FileType, u16, u16), Option<u32>> = BTreeMap::new();
        for slot in &image.io.slots {
            for (file_type, range) in [(FileType::I, slot.inputs), (FileType::O, slot.outputs)] {
                let file = image.data_file(file_type, u16::from(file_type == FileType::I));
                let elements = file.map_or(0, |file| file.elements);
                for word in 0..range.words {
                    let index = range.first_word.saturating_add(word);
                    if index < elements {
                        words.insert((file_type, slot.number, word), Some(index.into()));
                    }
                }
            }
        }
        // Without a configuration the words that are named are the words of the file, in order.
        let mut next: BTreeMap<FileType, u32> = BTreeMap::new();
        let mut uses = BTreeMap::new();
        for (key, usage) in facts.io() {
            uses.insert(key, usage);
            let named = next.entry(key.0).or_default();
            words.entry(key).or_insert_with(|| image.io.slots.is_empty().then_some(*named));
            *named = named.saturating_add(1);
        }
        for ((file_type, slot, word), stored) in words {
            let (as_word, as_bits) = uses.get(&(file_type, slot, word)).copied().unwrap_or_default();
            let analog = as_word && !as_bits;
            let block = match file_type {
                FileType::I if analog => Block::Wx,
                FileType::I => Block::X,
                FileType::O if analog => Block::Wy,
                FileType::O => Block::Y,
                _ => Block::N,
            };
            self.append(file_type, slot, u32::from(word), 1, 1, block);
            if let Some(span) = self.spans.last_mut() {
                span.stored = stored;
            }
        }
    }

    fn append(&mut self, file_type: FileType, file: u16, first_word: u32, words: u32, size: u32, block: Block) {
        if words == 0 {
            return;
        }
        let at = Element { block, number: self.next.get(&block).copied().unwrap_or(0) };
        let span = Span { file_type, file, first_word, words, size, own: words, stored: None, at };
        self.next.insert(block, at.number.saturating_add(span.elements()));
        self.index.entry((file_type, file)).or_default().push(self.spans.len());
        self.spans.push(span);
    }

    /// All spans in the order of allocation.
    pub fn spans(&self) -> &[Span] {
        &self.spans
    }

    pub(super) fn spans_mut(&mut self) -> &mut [Span] {
        &mut self.spans
    }

    /// Single I/O points that lie apart from their word: type, slot, word, bit and place.
    pub fn points(&self) -> impl Iterator<Item = ((FileType, u16, u32, u16), Element)> {
        self.points.iter().map(|(key, element)| (*key, *element))
    }

    pub(super) fn set_point(&mut self, key: (FileType, u16, u32, u16), element: Element) {
        self.points.insert(key, element);
    }

    pub(super) fn set_next(&mut self, block: Block, number: u32) {
        self.next.insert(block, number);
    }

    /// Number of elements of a block that are used so far.
    pub fn used(&self, block: Block) -> u32 {
        self.next.get(&block).copied().unwrap_or(0)
    }

    /// A free element for a helper.
    pub fn helper(&mut self, block: Block) -> Element {
        let number = self.used(block);
        self.next.insert(block, number.saturating_add(1));
        Element { block, number }
    }

    /// The span that holds a word.
    pub fn span(&self, file_type: FileType, file: u16, word: u32) -> Option<&Span> {
        let spans = self.index.get(&(file_type, file))?;
        spans
            .iter()
            .filter_map(|index| self.spans.get(*index))
            .find(|span| word.checked_sub(span.first_word).is_some_and(|offset| offset < span.words))
    }

    /// File number (slot) and word number of a direct address, for [`Places::span`]; the bit's word
    /// included.
    pub fn word_of(&self, address: &Address) -> Option<(FileType, u16, u32)> {
        let bit = match &address.bit {
            None => 0,
            Some(Place::Number(bit)) => u32::from(*bit),
            Some(Place::Indirect(_)) => 0,
        };
        let element = address.element.number()?;
        let sub = u32::from(address.word.unwrap_or(0)) + bit / 16;
        if address.file_type.has_slots() {
            return Some((address.file_type, element, sub));
        }
        let file = address.file.number()?;
        let span = self.index.get(&(address.file_type, file))?.first().and_then(|index| self.spans.get(*index))?;
        (sub < span.size).then_some((address.file_type, file, u32::from(element) * span.size + sub))
    }

    /// The bit `bit` (0 to 15) of a word: `C17`, `N3:4`, `D2:20`.
    pub fn bit(&self, file_type: FileType, file: u16, word: u32, bit: u16) -> Option<String> {
        if let Some(point) = self.points.get(&(file_type, file, word, bit)) {
            return Some(point.to_string());
        }
        let span = self.span(file_type, file, word)?;
        let offset = word - span.first_word;
        let (block, first) = (span.at.block, span.at.number);
        Some(match block {
            block if block.is_bits() => Element { block, number: first + offset * 16 + u32::from(bit) }.to_string(),
            Block::D => format!("D{}:{}", first + offset / 2, offset % 2 * 16 + u32::from(bit)),
            Block::R | Block::Sl | Block::T => return None,
            block => format!("{}:{bit}", Element { block, number: first + offset }),
        })
    }

    /// A word as a signed 16-bit value: `N3`, `C16:SW`, `D2:W1`. `None` where it has no such form
    /// (floats, strings, words with points of their own).
    pub fn word(&self, file_type: FileType, file: u16, word: u32) -> Option<String> {
        let span = self.span(file_type, file, word)?;
        let offset = word - span.first_word;
        let (block, first) = (span.at.block, span.at.number);
        if self.points.range((file_type, file, word, 0)..=(file_type, file, word, 15)).next().is_some() {
            return None;
        }
        Some(match block {
            block if block.is_bits() => {
                let number = first + offset * 16;
                // Words are put together on boundaries of 16 only.
                if self.only_confirmed || !number.is_multiple_of(16) {
                    return None;
                }
                format!("{}:SW", Element { block, number })
            }
            Block::D => format!("D{}:W{}", first + offset / 2, offset % 2),
            Block::R | Block::Sl | Block::T => return None,
            block => Element { block, number: first + offset }.to_string(),
        })
    }

    /// A whole long word, float or string element by its first word: `D2`, `R5`, `SL0`.
    pub fn element(&self, file_type: FileType, file: u16, word: u32) -> Option<Element> {
        let span = self.span(file_type, file, word)?;
        let offset = word - span.first_word;
        let per = match span.at.block {
            Block::D | Block::R => 2,
            Block::Sl => 42,
            _ => return None,
        };
        offset.is_multiple_of(per).then_some(Element { block: span.at.block, number: span.at.number + offset / per })
    }

    /// The place of bit 0 of a B word in C, or of a word elsewhere, for run-time numbers: block, number
    /// of the element that word `word` begins at, elements per word, words from `word` to the end.
    pub fn base(&self, file_type: FileType, file: u16, word: u32) -> Option<Base> {
        let span = self.span(file_type, file, word)?;
        let offset = word - span.first_word;
        let left = span.words - offset;
        let number = match span.at.block {
            block if block.is_bits() => span.at.number + offset * 16,
            Block::D | Block::R => span.at.number + offset / 2,
            Block::Sl => span.at.number + offset / 42,
            _ => span.at.number + offset,
        };
        Some(Base { at: Element { block: span.at.block, number }, words: left })
    }

    /// The files of a type that are allocated: number, first element, words.
    pub fn files(&self, file_type: FileType) -> impl Iterator<Item = &Span> {
        self.spans.iter().filter(move |span| span.file_type == file_type)
    }
}

/// Where a word begins, see [`Places::base`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Base {
    /// Its first element.
    pub at: Element,
    /// Words from here to the end of the file.
    pub words: u32,
}

/// Words of the status file that have a place whatever the processor has.
pub const STATUS_WORDS: u32 = 66;
