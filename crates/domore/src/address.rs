//! Element addresses and operands of the Do-more dialect, from text and back to the same text.
//!
//! An address names an element (`X0`, `N10`, `DLV1400`), a heap item or nickname (`SerialNum`,
//! `PumpDelay`), a member of a structure (`T0.Acc`, `$Main.S1`), and may carry a cast (`C32:UW`,
//! `N3:15`) or an index expression (`N[D80 - 1]`). What a name stands for is the business of
//! [`crate::memory`]: this module knows spelling only.

use std::fmt;

pub use crate::program::Radix;
pub use crate::text::{quote, unquote};

/// Longest operand that is read: the longest text of a generated table stays far below.
const LONGEST: usize = 65_536;

impl Radix {
    /// The radix of a block in a project that declares nothing else.
    pub fn of_block(block: &str) -> Radix {
        let octal = ["DLX", "DLY", "DLC", "DLV"].iter().any(|name| block.eq_ignore_ascii_case(name));
        if octal { Radix::Octal } else { Radix::Decimal }
    }

    fn base(self) -> u32 {
        match self {
            Radix::Decimal => 10,
            Radix::Octal => 8,
        }
    }
}

/// The element an address starts from.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Element {
    /// `N10`: a block and a number. `PID_0` reads so too: whether a name with a number behind it is one
    /// element of a block or an item of its own is decided by the memory of the project.
    Numbered {
        /// The block, in the case written.
        block: String,
        /// The element, in the radix of the block.
        number: u32,
        /// The radix the number is written in.
        radix: Radix,
        /// Leading zeros as written: `SS007` and `SS7` are one element with two spellings.
        zeros: u8,
    },
    /// `N[D80 - 1]`: a block and an expression in brackets, without them.
    Indexed {
        /// The block, in the case written.
        block: String,
        /// The expression as written.
        expression: String,
    },
    /// `SerialNum`, `$Main`, `@IntEthernet`, a nickname: a name without a number.
    Named(String),
}

/// Bits read as another type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Cast {
    /// `:n`: one bit of a byte, word or double word, from 0.
    Bit(u8),
    /// `:Bn`: a byte of a word or double word, from 0.
    Byte(u8),
    /// `:Wn`: a word of a double word, 0 or 1.
    Word(u8),
    /// `:UW`, `:SD`, ...: the bits from here on, read as this type; with a number the part of that size,
    /// as in `D1000:UB2`.
    As(View, Option<u8>),
}

/// Types a cast can name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum View {
    /// `UB`: 0 to 255.
    UnsignedByte,
    /// `SB`: -128 to 127.
    SignedByte,
    /// `UW`: 0 to 65535.
    UnsignedWord,
    /// `SW`: -32768 to 32767.
    SignedWord,
    /// `SD`: signed, 32 bits.
    SignedDword,
    /// `UD`: unsigned, 32 bits. No export has it; the vendor lists no such type.
    UnsignedDword,
    /// `R`: IEEE single.
    Real,
}

/// Views with their spelling.
const VIEWS: [(&str, View); 7] = [
    ("UB", View::UnsignedByte),
    ("SB", View::SignedByte),
    ("UW", View::UnsignedWord),
    ("SW", View::SignedWord),
    ("SD", View::SignedDword),
    ("UD", View::UnsignedDword),
    ("R", View::Real),
];

impl View {
    /// Its width in bits.
    pub fn bits(self) -> u32 {
        match self {
            View::UnsignedByte | View::SignedByte => 8,
            View::UnsignedWord | View::SignedWord => 16,
            View::SignedDword | View::UnsignedDword | View::Real => 32,
        }
    }
}

/// An address as written.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Address {
    /// What it starts from.
    pub element: Element,
    /// The member behind the point, in the case written: `Acc`, `Done`, `S1`, `Year`.
    pub field: Option<String>,
    /// The cast behind the colon.
    pub cast: Option<Cast>,
}

/// Why a text is no address or operand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AddressError {
    /// The text.
    pub text: String,
    /// Place in it, in bytes from 0.
    pub offset: usize,
    /// What belongs there.
    pub expected: &'static str,
}

impl fmt::Display for AddressError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shown: String = self.text.chars().take(60).collect();
        write!(f, "`{shown}` at character {}: expected {}", self.offset + 1, self.expected)
    }
}

impl std::error::Error for AddressError {}

impl Address {
    /// An element of a block in the default radix of that block.
    pub fn numbered(block: &str, number: u32) -> Address {
        let element = Element::Numbered { block: block.to_owned(), number, radix: Radix::of_block(block), zeros: 0 };
        Address { element, field: None, cast: None }
    }

    /// The same with a member.
    #[must_use]
    pub fn with_field(mut self, field: &str) -> Address {
        self.field = Some(field.to_owned());
        self
    }

    /// The same with a cast.
    #[must_use]
    pub fn with_cast(mut self, cast: Cast) -> Address {
        self.cast = Some(cast);
        self
    }

    /// Reads an address; block numbers in the radix of the default project.
    ///
    /// # Errors
    /// The first place where no address goes on.
    pub fn parse(text: &str) -> Result<Address, AddressError> {
        Address::parse_with(text, Radix::of_block)
    }

    /// Reads an address with the radix a project declares for its blocks.
    ///
    /// # Errors
    /// As [`Address::parse`].
    pub fn parse_with(text: &str, radix: impl Fn(&str) -> Radix) -> Result<Address, AddressError> {
        let wrong = |offset, expected| AddressError { text: text.to_owned(), offset, expected };
        if text.len() > LONGEST {
            return Err(wrong(0, "an address of less than 64 KB"));
        }
        let end = text.find(|c: char| !is_name(c)).unwrap_or(text.len());
        let (name, rest) = text.split_at(end);
        if name.is_empty() || name.starts_with(|c: char| c.is_ascii_digit()) {
            return Err(wrong(0, "an element, nickname or name"));
        }
        let (element, rest) = match rest.strip_prefix('[') {
            Some(inside) => {
                let close = closing(inside).ok_or_else(|| wrong(end, "a bracket that is closed"))?;
                let (expression, behind) = inside.split_at(close);
                if expression.trim().is_empty() {
                    return Err(wrong(end + 1, "an index expression"));
                }
                let element = Element::Indexed { block: name.to_owned(), expression: expression.to_owned() };
                (element, behind.strip_prefix(']').unwrap_or(""))
            }
            None => (numbered(name, radix), rest),
        };
        let place = |rest: &str| text.len() - rest.len();
        let (field, rest) = match rest.strip_prefix('.') {
            Some(behind) => {
                let end = behind.find(|c: char| !is_name(c)).unwrap_or(behind.len());
                let (field, behind) = behind.split_at(end);
                if field.is_empty() {
                    return Err(wrong(place(behind), "the name of a member"));
                }
                (Some(field.to_owned()), behind)
            }
            None => (None, rest),
        };
        let cast = match rest.strip_prefix(':') {
            Some(cast) => {
                Some(Cast::parse(cast).ok_or_else(|| wrong(place(cast), "a cast such as 15, B1, W0, UW or SD"))?)
            }
            None if rest.is_empty() => None,
            None => return Err(wrong(place(rest), "the end of the address, a member or a cast")),
        };
        Ok(Address { element, field, cast })
    }

    /// The name the address starts with, number included, member and cast left out: `N10`, `PID_0`,
    /// `SerialNum`. `None` for an indexed one.
    pub fn base(&self) -> Option<String> {
        match &self.element {
            Element::Indexed { .. } => None,
            element => Some(element.to_string()),
        }
    }
}

/// `N10` is block and number, `red_light` a name. A digit that does not exist in the radix makes a name.
fn numbered(name: &str, radix: impl Fn(&str) -> Radix) -> Element {
    let digits = name.bytes().rev().take_while(u8::is_ascii_digit).count();
    let (block, number) = name.split_at(name.len() - digits);
    let named = Element::Named(name.to_owned());
    if block.is_empty() || digits == 0 {
        return named;
    }
    let radix = radix(block);
    let Ok(value) = u32::from_str_radix(number, radix.base()) else { return named };
    // All zeros but the last digit are leading ones, `000` has two.
    let zeros = number.bytes().take(digits - 1).take_while(|byte| *byte == b'0').count();
    let Ok(zeros) = u8::try_from(zeros) else { return named };
    Element::Numbered { block: block.to_owned(), number: value, radix, zeros }
}

fn is_name(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '$' | '@' | '#' | '~' | '?')
}

/// The offset of the bracket that closes what is open before `text`.
fn closing(text: &str) -> Option<usize> {
    let mut depth = 1usize;
    for (offset, c) in text.char_indices() {
        match c {
            '[' => depth += 1,
            ']' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(offset);
        }
    }
    None
}

impl Cast {
    /// Reads what stands behind the colon.
    fn parse(text: &str) -> Option<Cast> {
        if text.bytes().all(|byte| byte.is_ascii_digit()) {
            return plain(text, 31).map(Cast::Bit);
        }
        let upper = text.to_ascii_uppercase();
        if let Some(number) = upper.strip_prefix('B') {
            return plain(number, 3).map(Cast::Byte);
        }
        if let Some(number) = upper.strip_prefix('W') {
            return plain(number, 1).map(Cast::Word);
        }
        let (name, view) = VIEWS.iter().find(|row| upper.starts_with(row.0))?;
        match upper.get(name.len()..)? {
            "" => Some(Cast::As(*view, None)),
            number => plain(number, 31).map(|number| Cast::As(*view, Some(number))),
        }
    }
}

/// A number without sign and leading zeros, up to `most`.
fn plain(text: &str, most: u8) -> Option<u8> {
    let number: u8 = text.parse().ok()?;
    (number <= most && number.to_string() == text).then_some(number)
}

impl fmt::Display for Cast {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Cast::Bit(number) => write!(f, "{number}"),
            Cast::Byte(number) => write!(f, "B{number}"),
            Cast::Word(number) => write!(f, "W{number}"),
            Cast::As(view, number) => {
                let name = VIEWS.iter().find(|row| row.1 == *view).map_or("", |row| row.0);
                f.write_str(name)?;
                number.map_or(Ok(()), |number| write!(f, "{number}"))
            }
        }
    }
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Element::Numbered { block, number, radix, zeros } => {
                write!(f, "{block}{}", "0".repeat(usize::from(*zeros)))?;
                match radix {
                    Radix::Decimal => write!(f, "{number}"),
                    Radix::Octal => write!(f, "{number:o}"),
                }
            }
            Element::Indexed { block, expression } => write!(f, "{block}[{expression}]"),
            Element::Named(name) => f.write_str(name),
        }
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.element)?;
        if let Some(field) = &self.field {
            write!(f, ".{field}")?;
        }
        self.cast.map_or(Ok(()), |cast| write!(f, ":{cast}"))
    }
}

/// A constant with the text it was written as.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    /// Its value.
    pub value: Number,
    /// As written: `0x20000`, `5.0`, `-12`.
    pub text: String,
}

/// A number without a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    /// A whole number from -2147483648 to 4294967295; hex ones are bit patterns.
    Integer(i64),
    /// With a point or an exponent.
    Real(f64),
}

impl Constant {
    /// Reads a number: `12`, `-5`, `0x1F`, `2.5`, `.5`, `1e-3`.
    pub fn parse(text: &str) -> Option<Constant> {
        let (sign, digits) = match text.strip_prefix('-') {
            Some(digits) => (-1, digits),
            None => (1, text.strip_prefix('+').unwrap_or(text)),
        };
        let hex = digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X"));
        let value = match hex {
            Some(hex) if !hex.is_empty() && hex.bytes().all(|b| b.is_ascii_hexdigit()) => {
                Number::Integer(sign * i64::from(u32::from_str_radix(hex, 16).ok()?))
            }
            Some(_) => return None,
            None if !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()) => {
                let value = sign * digits.parse::<i64>().ok()?;
                let fits = (i64::from(i32::MIN)..=i64::from(u32::MAX)).contains(&value);
                if !fits {
                    return None;
                }
                Number::Integer(value)
            }
            None => {
                let plausible = digits.starts_with(|c: char| c.is_ascii_digit() || c == '.')
                    && digits.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'.' | b'e' | b'E' | b'-' | b'+'));
                if !plausible {
                    return None;
                }
                Number::Real(f64::from(sign as i32) * digits.parse::<f64>().ok()?)
            }
        };
        Some(Constant { value, text: text.to_owned() })
    }
}

/// An operand as written.
#[derive(Clone, Debug, PartialEq)]
pub enum Operand {
    /// An element, member, nickname or name of a code block.
    Address(Address),
    /// A number.
    Constant(Constant),
    /// What stands between quotes, doubled quotes undone: an expression, a table, a string.
    Quoted(String),
}

impl Operand {
    /// Reads an operand of the default project.
    ///
    /// # Errors
    /// The first place where no operand goes on.
    pub fn parse(text: &str) -> Result<Operand, AddressError> {
        Operand::parse_with(text, Radix::of_block)
    }

    /// Reads an operand with the radix a project declares for its blocks.
    ///
    /// # Errors
    /// As [`Operand::parse`].
    pub fn parse_with(text: &str, radix: impl Fn(&str) -> Radix) -> Result<Operand, AddressError> {
        if text.starts_with('"') {
            return match unquote(text) {
                Some(inside) => Ok(Operand::Quoted(inside)),
                None => Err(AddressError { text: text.to_owned(), offset: 0, expected: "quotes that are closed" }),
            };
        }
        match Constant::parse(text) {
            Some(constant) => Ok(Operand::Constant(constant)),
            None => Address::parse_with(text, radix).map(Operand::Address),
        }
    }

    /// The address, if it is one.
    pub fn address(&self) -> Option<&Address> {
        match self {
            Operand::Address(address) => Some(address),
            _ => None,
        }
    }
}

impl fmt::Display for Operand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Operand::Address(address) => write!(f, "{address}"),
            Operand::Constant(constant) => f.write_str(&constant.text),
            Operand::Quoted(text) => f.write_str(&quote(text)),
        }
    }
}

/// The columns of a table operand: separated by spaces or tabs, a quoted one kept whole and unquoted.
///
/// # Errors
/// The text with a quote that is never closed.
pub fn columns(table: &str) -> Result<Vec<String>, AddressError> {
    let plain = |column: &str| match column.starts_with('"') {
        true => unquote(column).unwrap_or_default(),
        false => column.to_owned(),
    };
    Ok(written_columns(table)?.into_iter().map(plain).collect())
}

/// As [`columns`], quotes left on.
///
/// # Errors
/// As [`columns`].
pub fn written_columns(table: &str) -> Result<Vec<&str>, AddressError> {
    let mut found = Vec::new();
    let mut rest = table.trim_start();
    while !rest.is_empty() {
        let wrong = || AddressError {
            text: table.to_owned(),
            offset: table.len() - rest.len(),
            expected: "quotes that are closed",
        };
        let end = if rest.starts_with('"') { quoted_end(rest).ok_or_else(wrong)? } else { unbroken_end(rest) };
        let (column, behind) = rest.split_at(end);
        if column.starts_with('"') && unquote(column).is_none() {
            return Err(wrong());
        }
        found.push(column);
        rest = behind.trim_start();
    }
    Ok(found)
}

/// The end of a quoted text at the start of `text`, behind its last quote.
fn quoted_end(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let mut at = 1;
    loop {
        match (bytes.get(at), bytes.get(at + 1)) {
            (Some(b'"'), Some(b'"')) => at += 2,
            (Some(b'"'), _) => return Some(at + 1),
            (Some(_), _) => at += 1,
            (None, _) => return None,
        }
    }
}

/// The end of a column: the first blank outside brackets.
fn unbroken_end(text: &str) -> usize {
    let mut depth = 0usize;
    for (offset, c) in text.char_indices() {
        match c {
            '[' | '(' => depth += 1,
            ']' | ')' => depth = depth.saturating_sub(1),
            c if c.is_whitespace() && depth == 0 => return offset,
            _ => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_read_and_settle() {
        for text in [
            "X0",
            "C1",
            "N10",
            "T0.Acc",
            "CT0.Done",
            "ST1",
            "DST511",
            "SDT0.Hour",
            "C32:UW",
            "V84:SD",
            "N3:15",
            "D5:W1",
            "D5:B3",
            "D1000:UB2",
            "N[D80 - 1]",
            "V[N[3] + 1]:SW",
            "$Main.S1",
            "PID_0.SP",
            "SerialNum",
            "@IntEthernet",
            "DLV1400",
            "DLX17",
            "red_light",
            "ss007",
            "R1",
            "$FirstScan",
            "T[N0].Acc",
        ] {
            assert_eq!(Address::parse(text).expect(text).to_string(), text);
        }
        for text in ["", "5", "N10.", "N10:", "N10:UX", "N10:32", "N[", "N[]", "N1 2", "X0+1", ":UW", "D0:W2"] {
            assert!(Address::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn guest_blocks_count_in_octal() {
        let Element::Numbered { number, radix, .. } = Address::parse("DLV1400").expect("reads").element else {
            panic!("numbered")
        };
        assert_eq!((number, radix), (0o1400, Radix::Octal));
        assert_eq!(Address::parse("DLX8").expect("reads").element, Element::Named("DLX8".into()));
        let user = Address::parse_with("Rec10", |_| Radix::Octal).expect("reads");
        assert_eq!(user.to_string(), "Rec10");
        assert!(matches!(user.element, Element::Numbered { number: 8, .. }));
    }

    #[test]
    fn operands_keep_the_text_of_constants() {
        for (text, value) in [
            ("0x20000", Number::Integer(131_072)),
            ("-5", Number::Integer(-5)),
            ("0.50", Number::Real(0.5)),
            ("1e-3", Number::Real(0.001)),
        ] {
            let Operand::Constant(constant) = Operand::parse(text).expect(text) else { panic!("{text}") };
            assert_eq!((constant.value, constant.text.as_str()), (value, text));
        }
        assert!(Constant::parse("0x").is_none() && Constant::parse("1.2.3").is_none());
        assert!(Constant::parse("99999999999").is_none());
        let quoted = Operand::parse("\"\"\"text\"\"\"").expect("reads");
        assert_eq!(quoted, Operand::Quoted("\"text\"".into()));
        assert_eq!(quoted.to_string(), "\"\"\"text\"\"\"");
        assert!(Operand::parse("\"open").is_err() && Operand::parse("\"a\"b\"").is_err());
    }

    #[test]
    fn tables_split_at_blanks_outside_quotes_and_brackets() {
        assert_eq!(columns("3 N0 N[D0 + 1] \"a \"\"b\"\"\"").expect("reads"), ["3", "N0", "N[D0 + 1]", "a \"b\""]);
        assert!(columns("3 \"open").is_err());
    }
}
