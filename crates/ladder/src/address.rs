//! Data table addresses in every form a program can write.
//!
//! ```text
//! N7:3        B3:0/15      T4:136/DN    T4:0.ACC     I:4.3        O:0.0/4
//! S:1/15      #N7:3        N9:[N7:0]    N[N7:4]:21/0 B3:10/[N7:0] T4:[C5:1.ACC].PRE
//! HSC:0.HIP   ES1:9        ST9:1.LEN    L9:1/31      MG68:0/DN    M0:1.4/2
//! ```
//!
//! [`Address::parse`] also takes the short forms that ladder printouts use (`I:1/3`, `B3/17`) and
//! members by number (`T4:0.1`, `T4:0/13`); [`Display`](fmt::Display) always writes the complete
//! form, so text settles after one step.

use std::fmt;
use std::hash::{Hash, Hasher};

use crate::FileType;
use crate::members::{member_by_name, member_name};

/// A number in an address, or the address whose value gives it when the program runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// Written in the program.
    Number(u16),
    /// Read from the data table each time the instruction executes.
    Indirect(Box<Address>),
}

impl Place {
    /// The number, unless it is indirect.
    pub fn number(&self) -> Option<u16> {
        match self {
            Place::Number(n) => Some(*n),
            Place::Indirect(_) => None,
        }
    }
}

/// An address in the data table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Address {
    /// Written with `#`: the start of a file, or an address indexed by S:24.
    pub indexed: bool,
    /// The type letters.
    pub file_type: FileType,
    /// File number; 0, 1, 2 for O, I, S.
    pub file: Place,
    /// Element number; for O, I, M0 and M1 the slot.
    pub element: Place,
    /// Word inside the element (`PRE` = 1), for O, I, M0 and M1 the word of the slot. `None`: the
    /// element itself, or a flag of an element whose flags fill one word (`T4:0/DN`).
    pub word: Option<u16>,
    /// Bit number: 0 to 15, to 31 in long words.
    pub bit: Option<Place>,
}

impl Hash for Address {
    /// The plain numbers at once: documentation and cross reference look addresses up by the ten
    /// thousand.
    fn hash<H: Hasher>(&self, state: &mut H) {
        let plain = |place: Option<&Place>| place.and_then(Place::number).unwrap_or(u16::MAX);
        let numbers = [plain(Some(&self.file)), plain(Some(&self.element)), plain(self.bit.as_ref())];
        let [file, element, bit] = numbers.map(u64::from);
        state.write_u64(file << 48 | element << 32 | bit << 16 | u64::from(self.word.unwrap_or(u16::MAX)));
        (self.file_type, self.indexed).hash(state);
        for place in [Some(&self.file), Some(&self.element), self.bit.as_ref()].into_iter().flatten() {
            if let Place::Indirect(inner) = place {
                inner.hash(state);
            }
        }
    }
}

/// Why a text is not an address.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AddressError {
    /// Byte offset in the text where reading stopped.
    pub offset: usize,
    /// What an address has at that place.
    pub expected: &'static str,
}

impl fmt::Display for AddressError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "not an address: expected {} at character {}", self.expected, self.offset + 1)
    }
}

impl std::error::Error for AddressError {}

/// Brackets nest at most this deep; the processors allow one level.
const MAX_DEPTH: usize = 8;

impl Address {
    /// A plain element address such as `N7:3`.
    pub fn element(file_type: FileType, file: u16, element: u16) -> Address {
        Address {
            indexed: false,
            file_type,
            file: Place::Number(file),
            element: Place::Number(element),
            word: None,
            bit: None,
        }
    }

    /// The same address with this word of the element.
    pub fn with_word(mut self, word: u16) -> Address {
        self.word = Some(word);
        self
    }

    /// The same address with this bit.
    pub fn with_bit(mut self, bit: u16) -> Address {
        self.bit = Some(Place::Number(bit));
        self
    }

    /// Reads an address in any spelling a program or a person uses.
    ///
    /// # Errors
    /// Where the text stops being an address, and what belongs there.
    pub fn parse(text: &str) -> Result<Address, AddressError> {
        let mut reader = Reader { text: text.as_bytes(), at: 0 };
        let address = reader.address(0)?;
        if reader.at == reader.text.len() { Ok(address) } else { Err(reader.expected("the end of the address")) }
    }

    /// No part of the address is decided at run time: no brackets and no `#`.
    pub fn is_direct(&self) -> bool {
        !self.indexed
            && self.file.number().is_some()
            && self.element.number().is_some()
            && self.bit.as_ref().is_none_or(|b| b.number().is_some())
    }

    /// The whole element this address lies in, when file and element are numbers.
    pub fn element_address(&self) -> Option<Address> {
        let mut element = Address::element(self.file_type, self.file.number()?, self.element.number()?);
        if self.file_type.has_slots() {
            element.word = self.word;
        }
        Some(element)
    }

    /// The addresses in brackets, outermost first: what the program reads to find this place.
    pub fn indirections(&self) -> impl Iterator<Item = &Address> {
        [Some(&self.file), Some(&self.element), self.bit.as_ref()].into_iter().flatten().filter_map(|place| match place
        {
            Place::Indirect(address) => Some(&**address),
            Place::Number(_) => None,
        })
    }

    /// The member name at this word and bit, if the type names one: `PRE`, `DN`.
    pub fn member(&self) -> Option<&'static str> {
        let bit = match &self.bit {
            None => None,
            Some(place) => Some(place.number()?),
        };
        let word = match self.word {
            Some(word) => word,
            None if bit.is_some() && self.file_type.has_single_flag_word() => 0,
            None => return None,
        };
        member_name(self.file_type, word, bit).map(|m| m.name)
    }
}

impl FileType {
    /// Element numbers are slots and words count inside the slot: O, I, M0, M1.
    pub fn has_slots(self) -> bool {
        matches!(self, FileType::O | FileType::I | FileType::M0 | FileType::M1)
    }

    /// Elements have exactly one word of flags, so a flag's address leaves the word out.
    fn has_single_flag_word(self) -> bool {
        matches!(self, FileType::T | FileType::C | FileType::R)
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.indexed {
            f.write_str("#")?;
        }
        write!(f, "{}", self.file_type)?;
        if matches!(self.file_type, FileType::Unknown(_)) {
            // `?15-7:0`: the type number would run into the file number.
            f.write_str("-")?;
        }
        match &self.file {
            Place::Number(n) if self.file_type.implied_file() == Some(*n) => {}
            place => write!(f, "{place}")?,
        }
        write!(f, ":{}", self.element)?;
        if self.bit.is_some()
            && let Some(member) = self.member()
        {
            return write!(f, "/{member}");
        }
        match self.word {
            None => {}
            Some(word) if self.file_type == FileType::ST && word > 0 => {
                write!(f, ".DATA[{}]", word - 1)?;
            }
            Some(word) => match member_name(self.file_type, word, None) {
                Some(member) => write!(f, ".{}", member.name)?,
                None => write!(f, ".{word}")?,
            },
        }
        match &self.bit {
            None => Ok(()),
            Some(bit) => write!(f, "/{bit}"),
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Number(n) => write!(f, "{n}"),
            Place::Indirect(address) => write!(f, "[{address}]"),
        }
    }
}

struct Reader<'a> {
    text: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    fn expected(&self, expected: &'static str) -> AddressError {
        AddressError { offset: self.at, expected }
    }

    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    fn take(&mut self, byte: u8) -> bool {
        let found = self.peek() == Some(byte);
        self.at += usize::from(found);
        found
    }

    fn word(&mut self, wanted: impl Fn(u8) -> bool) -> &'a str {
        let start = self.at;
        while self.peek().is_some_and(&wanted) {
            self.at += 1;
        }
        // Only ASCII bytes pass `wanted`, so the slice is always valid text.
        std::str::from_utf8(&self.text[start..self.at]).unwrap_or("")
    }

    fn number(&mut self) -> Result<u16, AddressError> {
        let expected = self.expected("a number from 0 to 65535");
        let mut number = None;
        while let Some(digit @ b'0'..=b'9') = self.peek() {
            let shifted = number.unwrap_or(0_u16).checked_mul(10);
            number = shifted.and_then(|number| number.checked_add(u16::from(digit - b'0')));
            if number.is_none() {
                return Err(expected);
            }
            self.at += 1;
        }
        number.ok_or(expected)
    }

    /// A number or a bracketed address.
    fn place(&mut self, depth: usize) -> Result<Place, AddressError> {
        if !self.take(b'[') {
            return self.number().map(Place::Number);
        }
        if depth >= MAX_DEPTH {
            return Err(self.expected("fewer nested brackets"));
        }
        let inner = self.address(depth + 1)?;
        if self.take(b']') { Ok(Place::Indirect(Box::new(inner))) } else { Err(self.expected("]")) }
    }

    fn address(&mut self, depth: usize) -> Result<Address, AddressError> {
        let indexed = self.take(b'#');
        let start = self.at;
        let file_type = self.file_type(start)?;
        let file = match (self.peek(), file_type.implied_file()) {
            (Some(b'/'), Some(number)) if file_type == FileType::S => Place::Number(number),
            (Some(b':'), Some(number)) => Place::Number(number),
            _ => self.place(depth)?,
        };
        let mut address = Address { indexed, file_type, file, element: Place::Number(0), word: None, bit: None };
        // A bit counted through file I or O would need the I/O configuration to find its slot.
        if !file_type.has_slots() && self.take(b'/') {
            // `B3/17`: bits counted through the whole file.
            address.bit = Some(self.place(depth)?);
            self.spread_file_bit(&mut address);
            return Ok(address);
        }
        if !self.take(b':') {
            return Err(self.expected(": or /"));
        }
        address.element = self.place(depth)?;
        if self.take(b'.') {
            self.sub_element(&mut address)?;
        }
        if self.take(b'/') {
            self.bit(&mut address, depth)?;
        }
        normalize(&mut address);
        Ok(address)
    }

    fn file_type(&mut self, start: usize) -> Result<FileType, AddressError> {
        let module_file = match self.text.get(start..start + 3) {
            Some([b'M' | b'm', b'0', b':']) => Some(FileType::M0),
            Some([b'M' | b'm', b'1', b':']) => Some(FileType::M1),
            _ => None,
        };
        if let Some(file_type) = module_file {
            self.at = start + 2;
            return Ok(file_type);
        }
        let letters = self.word(|b| b.is_ascii_alphabetic());
        let found = FileType::from_letters(letters);
        found.ok_or(AddressError { offset: start, expected: "data file letters such as N or T" })
    }

    fn sub_element(&mut self, address: &mut Address) -> Result<(), AddressError> {
        let start = self.at;
        if self.peek().is_some_and(|b| b.is_ascii_digit()) {
            let word = self.number()?;
            address.word = Some(word);
            return Ok(());
        }
        let name = self.word(|b| b.is_ascii_alphanumeric());
        if address.file_type == FileType::ST && name.eq_ignore_ascii_case("DATA") && self.take(b'[') {
            let index = self.number()?;
            address.word = index.checked_add(1);
            return if self.take(b']') && address.word.is_some() { Ok(()) } else { Err(self.expected("]")) };
        }
        match member_by_name(address.file_type, name) {
            Some(member) => {
                // `T4:0.DN` means the flag that the complete form writes `T4:0/DN`.
                address.word = Some(member.word);
                address.bit = member.bit.map(Place::Number);
                Ok(())
            }
            None => Err(AddressError { offset: start, expected: "a member of this data type" }),
        }
    }

    fn bit(&mut self, address: &mut Address, depth: usize) -> Result<(), AddressError> {
        let start = self.at;
        if address.bit.is_some() {
            return Err(self.expected("the end of the address"));
        }
        if !self.peek().is_some_and(|b| b.is_ascii_alphabetic()) {
            address.bit = Some(self.place(depth)?);
            return Ok(());
        }
        let name = self.word(|b| b.is_ascii_alphanumeric());
        match member_by_name(address.file_type, name) {
            Some(member) if member.bit.is_some() && address.word.is_none_or(|w| w == member.word) => {
                address.word = Some(member.word);
                address.bit = member.bit.map(Place::Number);
                Ok(())
            }
            _ => Err(AddressError { offset: start, expected: "a bit number or a flag of this data type" }),
        }
    }

    /// Turns a bit counted through the file into element (or I/O word) and bit.
    fn spread_file_bit(&self, address: &mut Address) {
        let Some(bit) = address.bit.as_ref().and_then(Place::number) else { return };
        let width = address.file_type.bits_per_word();
        if matches!(address.file_type, FileType::T | FileType::C) {
            return;
        }
        if address.file_type == FileType::R {
            // Three words an element; its flags, the first, are written without a word.
            address.element = Place::Number(bit / 48);
            address.word = Some(bit % 48 / 16).filter(|word| *word > 0);
            address.bit = Some(Place::Number(bit % 16));
            return;
        }
        address.element = Place::Number(bit / width);
        address.bit = Some(Place::Number(bit % width));
    }
}

/// Brings equal addresses to one form, the one RSLogix stores.
fn normalize(address: &mut Address) {
    let bit = address.bit.as_ref().and_then(Place::number);
    if address.file_type.has_slots() {
        // `I:1/20` counts through the words of the slot; `I:1/3` leaves word 0 out.
        if address.word.is_none()
            && let Some(place) = &address.bit
        {
            let bit = place.number();
            address.word = Some(bit.map_or(0, |b| b / 16));
            address.bit = bit.map(|b| Place::Number(b % 16)).or(address.bit.take());
        }
    } else if address.file_type.has_single_flag_word() && address.word == Some(0) && bit.is_some() {
        address.word = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn settles(text: &str) -> Address {
        let address = Address::parse(text).expect(text);
        assert_eq!(address.to_string(), text);
        address
    }

    #[test]
    fn complete_forms_print_as_written() {
        for text in [
            "N7:3",
            "B3:0/15",
            "T4:136/DN",
            "I:4.3",
            "T4:0.ACC",
            "I:0.0/4",
            "B103:10/[N7:0]",
            "N9:[N7:0]",
            "T4:[C5:255.ACC].PRE",
            "N200:[N200:35]/1",
            "N100:[N7:14]/[N7:16]",
            "N[N41:2]:2",
            "N[N7:4]:21/0",
            "N[N7:4]:[N7:3]",
            "T[N77:110]:[C5:255.ACC].PRE",
            "#N7:3",
            "#I:0.0",
            "#ST46:[N41:1]",
            "#N[N7:4]:0",
            "L102:0",
            "L9:1/31",
            "PD25:0.CVP",
            "MG68:0/DN",
            "L9:0/[N7:4]",
            "L102:[N101:1]",
            "#L51:1",
            "ES1:9",
            "HSC:0.HIP",
            "TPI:0.POT1",
            "HSC:0/FE",
            "#RTC:0.YR",
            "O:2",
            "S:1/15",
            "S:24",
            "ST9:1.LEN",
            "ST9:1.DATA[3]",
            "R6:0.POS",
            "C5:1/OV",
            "T4:0/7",
            "T4:0.PRE/5",
            "HSC:0.3/15",
            "PD25:1.Ti",
            "M0:1.4/2",
            "M1:3.0",
            "RIX80:0",
            "PTO:0/CS",
            "CS0:5/8",
            "T4:0.0",
        ] {
            settles(text);
        }
    }

    #[test]
    fn short_and_numeric_forms_become_complete() {
        for (text, complete) in [
            ("I:1/3", "I:1.0/3"),
            ("I:0/23", "I:0.1/7"),
            ("B3/17", "B3:1/1"),
            ("S/31", "S:1/15"),
            ("S2/31", "S:1/15"),
            ("R6/61", "R6:1/DN"),
            ("R6/20", "R6:0.LEN/4"),
            ("R6:2/RN", "R6:2/IN"),
            ("T4:0/13", "T4:0/DN"),
            ("T4:0.0/15", "T4:0/EN"),
            ("T4:0.1", "T4:0.PRE"),
            ("R6:2.1/0", "R6:2.LEN/0"),
            ("o0:5.0/0", "O:5.0/0"),
            ("S2:1/15", "S:1/15"),
            ("pd25:1.TI", "PD25:1.Ti"),
            ("I:0/[N7:1]", "I:0.0/[N7:1]"),
            ("T4:0.DN", "T4:0/DN"),
            ("N7:07", "N7:7"),
        ] {
            let address = Address::parse(text).expect(text);
            assert_eq!(address.to_string(), complete);
            assert_eq!(Address::parse(complete).as_ref(), Ok(&address));
        }
    }

    #[test]
    fn other_texts_are_refused_with_their_place() {
        for (text, offset) in [
            ("", 0),
            ("5", 0),
            ("Q2:1", 0),
            ("N7", 2),
            ("N7:", 3),
            ("N7:70000", 3),
            ("N7:0/", 5),
            ("T4:0.FOO", 5),
            ("N7:[N7:0", 8),
            ("N7:0]", 4),
            ("U:4", 0),
            ("T4:0.PRE/DN", 9),
            ("I1/3", 2),
        ] {
            assert_eq!(Address::parse(text).map_err(|e| e.offset), Err(offset), "{text}");
        }
        let deep = "N7:[".repeat(100_000);
        assert!(Address::parse(&deep).is_err());
    }
}
