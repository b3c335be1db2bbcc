//! The memory of a project: blocks with their types and sizes, where each element lies, what names stand for.
//!
//! All data is one row of bytes, low byte first, bits packed eight to a byte: the layout that makes casts
//! such as `C32:UW` and raw copies what the controller makes of them. [`Map`] says where things are; the
//! bytes themselves belong to whoever runs a program.

mod value;

use std::collections::HashMap;
use std::fmt;
use std::ops::Range;

pub use value::{Data, Num};

use crate::address::{Address, Cast, Constant, Element, Radix, View};
use crate::program::{MemoryBlock, Project};

/// Most bytes the memory of a project may take. The largest controllers have far less.
const MOST_BYTES: u64 = 64 << 20;

/// Stages of a program. (help DMD0508)
pub const STAGES: u32 = 128;

/// Blocks that the I/O scan fills from the terminals before the programs run. MI and MIR are not among them: other
/// devices only read those, and programs write them.
const INPUTS: [&str; 3] = ["X", "WX", "RX"];

/// What an element is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ElementType {
    /// `BIT`.
    Bit,
    /// `UBYTE`.
    UnsignedByte,
    /// `SBYTE`.
    SignedByte,
    /// `UWORD`.
    UnsignedWord,
    /// `SWORD`.
    SignedWord,
    /// `SDWORD`.
    SignedDword,
    /// `REAL`.
    Real,
    /// `TIMER`.
    Timer,
    /// `COUNTER`.
    Counter,
    /// `STRING` of so many characters.
    String(u16),
    /// `DATETIME`.
    DateTime,
}

impl ElementType {
    /// The type a word of MEM_CONFIG stands for; `None` for user types and what is not modelled (PID, ...).
    pub fn from_word(word: &str, block: &str) -> Option<ElementType> {
        Some(match word.to_ascii_uppercase().as_str() {
            "BIT" => ElementType::Bit,
            "UBYTE" => ElementType::UnsignedByte,
            "SBYTE" => ElementType::SignedByte,
            "UWORD" => ElementType::UnsignedWord,
            "SWORD" => ElementType::SignedWord,
            "SDWORD" => ElementType::SignedDword,
            "REAL" => ElementType::Real,
            "TIMER" => ElementType::Timer,
            "COUNTER" => ElementType::Counter,
            // Short strings hold 64 characters; all others are taken as long ones.
            "STRING" => ElementType::String(if block.eq_ignore_ascii_case("SS") { 64 } else { 256 }),
            "DATETIME" => ElementType::DateTime,
            _ => return None,
        })
    }

    /// Size of an element in bits.
    pub fn bits(self) -> u32 {
        match self {
            ElementType::Bit => 1,
            ElementType::UnsignedByte | ElementType::SignedByte => 8,
            ElementType::UnsignedWord | ElementType::SignedWord => 16,
            ElementType::SignedDword | ElementType::Real => 32,
            ElementType::Timer | ElementType::Counter | ElementType::DateTime => 64,
            ElementType::String(length) => 32 + 8 * (length as u32).next_multiple_of(4),
        }
    }

    fn kind(self) -> Option<Kind> {
        Some(match self {
            ElementType::Bit => Kind::Bit,
            ElementType::UnsignedByte => Kind::U8,
            ElementType::SignedByte => Kind::I8,
            ElementType::UnsignedWord => Kind::U16,
            ElementType::SignedWord => Kind::I16,
            ElementType::SignedDword => Kind::I32,
            ElementType::Real => Kind::F32,
            ElementType::String(length) => Kind::Text(length),
            ElementType::Timer | ElementType::Counter | ElementType::DateTime => return None,
        })
    }
}

/// How the bytes at a place are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// One bit.
    Bit,
    /// 0 to 255.
    U8,
    /// -128 to 127.
    I8,
    /// 0 to 65535.
    U16,
    /// -32768 to 32767.
    I16,
    /// Signed, 32 bits.
    I32,
    /// Unsigned, 32 bits: by cast only.
    U32,
    /// IEEE single.
    F32,
    /// A string of at most so many characters.
    Text(u16),
}

impl Kind {
    /// Least and greatest number of an integer; `None` for reals and strings.
    #[inline]
    pub fn limits(self) -> Option<(i64, i64)> {
        Some(match self {
            Kind::Bit => (0, 1),
            Kind::U8 => (0, u8::MAX.into()),
            Kind::I8 => (i8::MIN.into(), i8::MAX.into()),
            Kind::U16 => (0, u16::MAX.into()),
            Kind::I16 => (i16::MIN.into(), i16::MAX.into()),
            Kind::I32 => (i32::MIN.into(), i32::MAX.into()),
            Kind::U32 => (0, u32::MAX.into()),
            Kind::F32 | Kind::Text(_) => return None,
        })
    }
}

/// Where a value lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Place {
    /// How it is read.
    pub kind: Kind,
    /// Its first bit, counted through all memory.
    pub bit: u32,
    /// The program may not write it: flags of timers and counters.
    pub read_only: bool,
}

/// Which elements of a block survive a power cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Retention {
    /// None: the fifth column of MEM_CONFIG is -1.
    None,
    /// All: that column is absent. (inferred)
    All,
}

/// A memory block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// Its name.
    pub name: String,
    /// Type of its elements.
    pub element: ElementType,
    /// How they are numbered.
    pub radix: Radix,
    /// How many.
    pub count: u32,
    /// First bit, counted through all memory.
    pub start: u32,
    /// What survives a power cycle.
    pub retention: Retention,
}

impl Block {
    /// The first bit of an element; `None` outside the block.
    pub fn element_bit(&self, number: u32) -> Option<u32> {
        (number < self.count).then(|| self.start + number * self.element.bits())
    }

    /// The name of an element, numbered as programs write it.
    pub fn element_name(&self, number: u32) -> String {
        match self.radix {
            Radix::Octal => format!("{}{number:o}", self.name),
            Radix::Decimal => format!("{}{number}", self.name),
        }
    }

    /// Whether the I/O scan fills it from the terminals.
    pub fn is_input(&self) -> bool {
        INPUTS.iter().any(|name| self.name.eq_ignore_ascii_case(name))
    }

    /// Its bits in all memory.
    pub fn bits(&self) -> Range<u32> {
        self.start..self.start.saturating_add(self.count.saturating_mul(self.element.bits()))
    }

    /// Its bytes in all memory.
    pub fn bytes(&self) -> Range<usize> {
        let start = (self.start >> 3) as usize;
        let bytes = (u64::from(self.count) * u64::from(self.element.bits())).div_ceil(8);
        start..start + bytes as usize
    }

    /// The place of an element that is no structure.
    pub fn place(&self, number: u32) -> Option<Place> {
        Some(Place { kind: self.element.kind()?, bit: self.element_bit(number)?, read_only: false })
    }
}

/// What a name stands for.
#[derive(Clone, Debug, PartialEq)]
pub enum Resolved {
    /// A value.
    Place(Place),
    /// A whole timer, counter or date: its type and first bit.
    Structure(ElementType, u32),
    /// A named constant.
    Constant(Num),
    /// `Block[expression]`, the expression still as text; member and cast are left to the caller.
    Indexed {
        /// Index in [`Map::blocks`].
        block: usize,
        /// What stands between the brackets.
        expression: String,
    },
}

/// Why a name stands for nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NameError {
    /// The address as written.
    pub address: String,
    /// What is wrong with it.
    pub why: String,
}

impl fmt::Display for NameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.address, self.why)
    }
}

impl std::error::Error for NameError {}

/// Name, type word, count, retentive: the blocks of a project that declares none. (Designer export)
const DEFAULTS: &[(&str, &str, u32, bool)] = &[
    ("X", "BIT", 2048, false),
    ("Y", "BIT", 2048, false),
    ("WX", "SWORD", 256, false),
    ("WY", "SWORD", 256, false),
    ("C", "BIT", 2048, true),
    ("V", "UWORD", 4096, true),
    ("N", "SWORD", 4096, true),
    ("D", "SDWORD", 4096, true),
    ("R", "REAL", 4096, true),
    ("T", "TIMER", 256, true),
    ("CT", "COUNTER", 256, true),
    ("SS", "STRING", 128, true),
    ("SL", "STRING", 64, true),
    ("UDT", "DATETIME", 32, true),
    ("PL", "UWORD", 256, true),
    ("DLX", "BIT", 0o1000, false),
    ("DLY", "BIT", 0o1000, false),
    ("DLC", "BIT", 0o1000, true),
    ("DLV", "UWORD", 0o4000, true),
    ("MI", "BIT", 1024, true),
    ("MC", "BIT", 1024, true),
    ("MIR", "SWORD", 2048, true),
    ("MHR", "SWORD", 2048, true),
    ("RX", "REAL", 256, false),
    ("RY", "REAL", 256, false),
    ("MSG", "STRING", 0, false),
    ("ERR", "STRING", 0, false),
    ("SysName", "STRING", 0, false),
    ("SysDesc", "STRING", 0, false),
    ("SerialNum", "STRING", 0, false),
    ("PartNum", "STRING", 0, false),
    // System memory, which MEM_CONFIG never lists.
    ("ST", "BIT", 1024, false),
    ("DST", "SDWORD", 512, false),
    ("SDT", "DATETIME", 8, false),
];

/// Nicknames that the system gives its own elements.
pub const SYSTEM_NICKNAMES: &[(&str, &str)] = &[
    ("$FirstScan", "ST0"),
    ("$On", "ST1"),
    ("$Off", "ST2"),
    ("$1Minute", "ST3"),
    ("$1Second", "ST4"),
    ("$100ms", "ST5"),
    ("$HasErrors", "ST10"),
    ("$HasWarnings", "ST11"),
    ("$BatteryLow", "ST149"),
    ("$ScanCounter", "DST0"),
    ("$PLCMode", "DST10"),
    ("$Now", "SDT0"),
];

/// Flags of a timer: member, bit in the flag byte.
pub(crate) const TIMER_FLAGS: &[(&str, u32)] =
    &[("Done", 0), ("DN", 0), ("Reset", 1), ("Zero", 2), ("Timing", 3), ("EN", 4)];
/// Flags of a counter.
pub(crate) const COUNTER_FLAGS: &[(&str, u32)] = &[("Done", 0), ("DnDone", 1), ("Reset", 2), ("Zero", 3)];
/// Members of a date: name, byte, kind.
const DATE_MEMBERS: &[(&str, u32, Kind)] = &[
    ("Year", 0, Kind::U16),
    ("Month", 2, Kind::U8),
    ("Day", 3, Kind::U8),
    ("DayOfWeek", 4, Kind::U8),
    ("Hour", 5, Kind::U8),
    ("Minute", 6, Kind::U8),
    ("Second", 7, Kind::U8),
];

/// Where everything lies.
#[derive(Clone, Debug, Default)]
pub struct Map {
    blocks: Vec<Block>,
    /// Blocks and heap items by name in upper case.
    names: HashMap<String, usize>,
    /// Nicknames in upper case, with what they stand for.
    nicknames: HashMap<String, Nickname>,
    /// Programs in upper case, with the first bit of their stages.
    stages: HashMap<String, u32>,
    /// Items of types that are not modelled, in upper case, with the type word.
    foreign: HashMap<String, String>,
    bytes: u32,
    /// What was assumed or left out, in words.
    pub notes: Vec<String>,
}

#[derive(Clone, Debug)]
enum Nickname {
    Element(String),
    Constant(Num),
}

impl Map {
    /// The memory of a project: the default blocks, those it declares in place of them or besides, and
    /// stage bits for each of its programs.
    ///
    /// # Errors
    /// The declared sizes exceed any controller.
    pub fn new(project: &Project) -> Result<Map, NameError> {
        let mut map = Map::default();
        let declared: HashMap<String, &MemoryBlock> =
            project.memory().map(|block| (block.name.to_ascii_uppercase(), block)).collect();
        for (name, word, count, retentive) in DEFAULTS {
            if !declared.contains_key(&name.to_ascii_uppercase()) {
                let retention = if *retentive { Retention::All } else { Retention::None };
                if let Some(element) = ElementType::from_word(word, name) {
                    map.add(name, element, Radix::of_block(name), *count, retention)?;
                }
            }
        }
        for block in project.memory() {
            map.declare(block)?;
        }
        for block in project.code_blocks() {
            let start = map.reserve(STAGES.div_ceil(8).into(), &block.name)?;
            map.stages.insert(block.name.to_ascii_uppercase(), start);
        }
        for (nickname, element) in SYSTEM_NICKNAMES {
            map.nicknames.insert(nickname.to_ascii_uppercase(), Nickname::Element((*element).to_owned()));
        }
        for line in project.documentation() {
            if line.nickname.is_empty() {
                continue;
            }
            let constant = line.element.strip_prefix("SK").is_some_and(|rest| rest.parse::<u32>().is_ok());
            let target = match (constant, Constant::parse(line.extra.trim())) {
                (true, Some(constant)) => Nickname::Constant(Num::of(constant.value)),
                (true, None) => continue,
                (false, _) => Nickname::Element(line.element.clone()),
            };
            map.nicknames.insert(line.nickname.to_ascii_uppercase(), target);
        }
        Ok(map)
    }

    fn declare(&mut self, block: &MemoryBlock) -> Result<(), NameError> {
        let radix = block.radix.unwrap_or_else(|| Radix::of_block(&block.name));
        let Some(element) = ElementType::from_word(&block.type_word, &block.name) else {
            let code = matches!(block.type_word.as_str(), "PROGRAM" | "<Virtual>" | "INTERRUPT" | "TASK");
            if !code {
                self.foreign.insert(block.name.to_ascii_uppercase(), block.type_word.clone());
            }
            return Ok(());
        };
        let retention = match block.extra.first().map(|column| column.trim()) {
            Some("-1") => Retention::None,
            None | Some("") => Retention::All,
            Some(other) => {
                self.notes.push(format!(
                    "memory block {}: retention `{other}` is not understood; all of it is kept over a power cycle",
                    block.name
                ));
                Retention::All
            }
        };
        self.add(&block.name, element, radix, block.count, retention)
    }

    fn add(
        &mut self,
        name: &str,
        element: ElementType,
        radix: Radix,
        count: u32,
        retention: Retention,
    ) -> Result<(), NameError> {
        // An item of the heap is declared with count 0.
        let elements = count.max(1);
        let bytes = (u64::from(elements) * u64::from(element.bits())).div_ceil(8).next_multiple_of(4);
        let start = self.reserve(bytes, name)?;
        let block = Block { name: name.to_owned(), element, radix, count: elements, start, retention };
        self.names.insert(name.to_ascii_uppercase(), self.blocks.len());
        self.blocks.push(block);
        Ok(())
    }

    /// Room for so many bytes; its first bit.
    fn reserve(&mut self, bytes: u64, name: &str) -> Result<u32, NameError> {
        let end = u64::from(self.bytes) + bytes.next_multiple_of(4);
        if end > MOST_BYTES {
            let why = format!("memory of {end} bytes up to this block, more than any controller has");
            return Err(NameError { address: name.to_owned(), why });
        }
        let start = self.bytes * 8;
        self.bytes = end as u32;
        Ok(start)
    }

    /// Bytes of all memory.
    pub fn bytes(&self) -> usize {
        self.bytes as usize
    }

    /// All blocks.
    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// The block of a name, in any case of letters.
    pub fn block(&self, name: &str) -> Option<&Block> {
        self.blocks.get(*self.names.get(&name.to_ascii_uppercase())?)
    }

    /// The first bit of the stages of a code block.
    pub fn stages(&self, code_block: &str) -> Option<u32> {
        self.stages.get(&code_block.to_ascii_uppercase()).copied()
    }

    /// How numbers of a block are written.
    pub fn radix(&self, block: &str) -> Radix {
        self.block(block).map_or_else(|| Radix::of_block(block), |block| block.radix)
    }

    /// Reads an address of this project and says what it stands for.
    ///
    /// # Errors
    /// It is no address, or stands for nothing here.
    pub fn resolve_text(&self, text: &str) -> Result<Resolved, NameError> {
        let wrong = |why: String| NameError { address: text.to_owned(), why };
        let address = Address::parse_with(text, |block| self.radix(block)).map_err(|error| wrong(error.to_string()))?;
        self.resolve(&address)
    }

    /// What an address stands for.
    ///
    /// # Errors
    /// Nothing has that name, the number is outside its block, there is no such member, or the cast
    /// does not fit.
    pub fn resolve(&self, address: &Address) -> Result<Resolved, NameError> {
        let wrong = |why: String| NameError { address: address.to_string(), why };
        if let Some(base) = address.base()
            && !self.names.contains_key(&base.to_ascii_uppercase())
            && let Some(nickname) = self.nicknames.get(&base.to_ascii_uppercase())
            && !matches!(&address.element, Element::Numbered { block, .. } if self.block(block).is_some())
        {
            return self.nickname(address, nickname);
        }
        match &address.element {
            Element::Indexed { block, expression } => {
                let index = self.names.get(&block.to_ascii_uppercase());
                let index = *index.ok_or_else(|| wrong(self.nothing(block)))?;
                Ok(Resolved::Indexed { block: index, expression: expression.clone() })
            }
            Element::Named(name) => {
                if let (Some(stages), Some(field)) = (self.stages(name), &address.field) {
                    let number = field.strip_prefix(['S', 's']).and_then(|number| number.parse::<u32>().ok());
                    let number = number.filter(|number| *number < STAGES);
                    let number =
                        number.ok_or_else(|| wrong(format!("{name} has no member {field} that is modelled")))?;
                    return Ok(Resolved::Place(Place { kind: Kind::Bit, bit: stages + number, read_only: false }));
                }
                let block = self.block(name).ok_or_else(|| wrong(self.nothing(name)))?;
                self.member(block, 0, address)
            }
            Element::Numbered { block, number, .. } => {
                let item = self.block(&address.base().unwrap_or_default());
                if let Some(item) = item {
                    return self.member(item, 0, address);
                }
                let code = address.base().and_then(|base| self.stages(&base));
                if code.is_some() {
                    let named =
                        Address { element: Element::Named(address.base().unwrap_or_default()), ..address.clone() };
                    return self.resolve(&named);
                }
                let block = self.block(block).ok_or_else(|| wrong(self.nothing(&address.element.to_string())))?;
                if *number >= block.count {
                    let last = Address::numbered(&block.name, block.count - 1);
                    return Err(wrong(format!("the last element of {} is {last}", block.name)));
                }
                self.member(block, *number, address)
            }
        }
    }

    /// An item of a type that is not modelled.
    pub(crate) fn is_foreign(&self, name: &str) -> bool {
        self.foreign.contains_key(&name.to_ascii_uppercase())
    }

    fn nothing(&self, name: &str) -> String {
        match self.foreign.get(&name.to_ascii_uppercase()) {
            Some(word) => format!("its type {word} is not modelled"),
            None => "no memory block, item or nickname of this project".to_owned(),
        }
    }

    fn nickname(&self, address: &Address, nickname: &Nickname) -> Result<Resolved, NameError> {
        let wrong = |why: String| NameError { address: address.to_string(), why };
        let element = match nickname {
            Nickname::Constant(value) => return Ok(Resolved::Constant(*value)),
            Nickname::Element(element) => element,
        };
        let mut target = Address::parse_with(element, |block| self.radix(block))
            .map_err(|error| wrong(format!("the nickname stands for {element}: {error}")))?;
        if let (Some(_), Some(_)) = (&target.field, &address.field) {
            return Err(wrong(format!("{element} has no member of its own")));
        }
        target.field = address.field.clone().or(target.field);
        target.cast = address.cast.or(target.cast);
        let documented = target.base().is_some_and(|base| {
            self.nicknames.contains_key(&base.to_ascii_uppercase()) && self.block_of(&target).is_none()
        });
        if documented {
            return Err(wrong(format!("the nickname stands for {element}, which is no element")));
        }
        self.resolve(&target)
    }

    fn block_of(&self, address: &Address) -> Option<&Block> {
        match &address.element {
            Element::Numbered { block, .. } | Element::Indexed { block, .. } => self.block(block),
            Element::Named(name) => self.block(name),
        }
    }

    /// An element of a block with member and cast.
    fn member(&self, block: &Block, number: u32, address: &Address) -> Result<Resolved, NameError> {
        member(block, number, address).map_err(|why| NameError { address: address.to_string(), why })
    }
}

/// What member and cast of `address` make of an element.
pub(crate) fn member(block: &Block, number: u32, address: &Address) -> Result<Resolved, String> {
    let start = block.element_bit(number).ok_or("outside its block")?;
    if let Some(field) = &address.field {
        if address.cast.is_some() {
            return Err("members of structures cannot be cast".to_owned());
        }
        let place = field_place(block.element, start, field);
        return place
            .map(Resolved::Place)
            .ok_or_else(|| format!("{} has no member {field} that is modelled", block.name));
    }
    let Some(place) = block.place(number) else {
        return match address.cast {
            Some(_) => Err("structures cannot be cast".to_owned()),
            None => Ok(Resolved::Structure(block.element, start)),
        };
    };
    let Some(cast) = address.cast else { return Ok(Resolved::Place(place)) };
    cast_place(block, place, cast).map(Resolved::Place)
}

/// The place of a member of a structure that begins at a bit.
pub(crate) fn field_place(element: ElementType, start: u32, field: &str) -> Option<Place> {
    let flag = |flags: &[(&str, u32)]| {
        let row = flags.iter().find(|row| row.0.eq_ignore_ascii_case(field))?;
        Some(Place { kind: Kind::Bit, bit: start + 32 + row.1, read_only: true })
    };
    let accumulated = field.eq_ignore_ascii_case("Acc");
    match element {
        ElementType::Timer | ElementType::Counter if accumulated => {
            Some(Place { kind: Kind::I32, bit: start, read_only: false })
        }
        ElementType::Timer => flag(TIMER_FLAGS),
        ElementType::Counter => flag(COUNTER_FLAGS),
        ElementType::DateTime => {
            let row = DATE_MEMBERS.iter().find(|row| row.0.eq_ignore_ascii_case(field))?;
            Some(Place { kind: row.2, bit: start + 8 * row.1, read_only: false })
        }
        ElementType::String(_) if field.eq_ignore_ascii_case("Length") => {
            Some(Place { kind: Kind::U16, bit: start, read_only: true })
        }
        _ => None,
    }
}

fn cast_place(block: &Block, place: Place, cast: Cast) -> Result<Place, String> {
    let width = block.element.bits();
    let text = matches!(place.kind, Kind::Text(_));
    let (kind, offset, taken) = match cast {
        _ if text => return Err("strings cannot be cast".to_owned()),
        Cast::Bit(number) if width > 1 => (Kind::Bit, u32::from(number), 1),
        Cast::Byte(number) if width >= 16 => (Kind::U8, 8 * u32::from(number), 8),
        Cast::Word(number) if width == 32 => (Kind::U16, 16 * u32::from(number), 16),
        Cast::As(view, number) => {
            let kind = match view {
                View::UnsignedByte => Kind::U8,
                View::SignedByte => Kind::I8,
                View::UnsignedWord => Kind::U16,
                View::SignedWord => Kind::I16,
                View::SignedDword => Kind::I32,
                View::UnsignedDword => Kind::U32,
                View::Real => Kind::F32,
            };
            (kind, view.bits() * u32::from(number.unwrap_or(0)), view.bits())
        }
        _ => return Err(format!("an element of {width} bits has no part :{cast}")),
    };
    if !matches!(cast, Cast::As(_, None)) && offset + taken > width {
        return Err(format!("an element of {width} bits has no part :{cast}"));
    }
    let bit = place.bit + offset;
    if kind != Kind::Bit && !bit.is_multiple_of(8) {
        return Err(format!("bits are read as :{cast} from a multiple of 8 only"));
    }
    if width == 1 && kind != Kind::Bit && !(bit - block.start).is_multiple_of(taken) {
        return Err(format!("bits are read as :{cast} from a multiple of {taken} only"));
    }
    if bit + taken > block.start + block.count * width {
        return Err(format!(":{cast} reaches beyond block {}", block.name));
    }
    Ok(Place { kind, bit, read_only: place.read_only })
}

#[cfg(test)]
mod tests;
