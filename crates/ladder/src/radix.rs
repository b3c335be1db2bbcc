//! Values of data tables as text: the radix of a file, and the columns of structured elements.

use crate::{Address, DataFile, FileType, IoConfiguration, Place, TimeBase, Value, format_float};

/// How words are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Radix {
    /// Signed decimal.
    Decimal,
    /// Hexadecimal, upper case, without marks.
    Hexadecimal,
    /// All 16 or 32 bits.
    Binary,
    /// Octal.
    Octal,
    /// Two characters, what is not printable as `\0A`.
    Ascii,
}

impl Radix {
    /// The radix RSLogix prints a type in when nobody chose one: I/O and bits binary, the status file
    /// hexadecimal (title lines of printed data pages).
    pub fn printed(file_type: FileType) -> Radix {
        match file_type {
            FileType::O | FileType::I | FileType::B => Radix::Binary,
            FileType::S => Radix::Hexadecimal,
            FileType::A => Radix::Ascii,
            _ => Radix::Decimal,
        }
    }

    /// The word in printed titles: `bin`, `hex`, `dec`.
    pub fn as_str(self) -> &'static str {
        match self {
            Radix::Decimal => "dec",
            Radix::Hexadecimal => "hex",
            Radix::Binary => "bin",
            Radix::Octal => "oct",
            Radix::Ascii => "ascii",
        }
    }

    /// A 16-bit word.
    pub fn word(self, value: u16) -> String {
        match self {
            Radix::Decimal => value.cast_signed().to_string(),
            Radix::Hexadecimal => format!("{value:X}"),
            Radix::Binary => format!("{value:016b}"),
            Radix::Octal => format!("{value:o}"),
            Radix::Ascii => value
                .to_be_bytes()
                .iter()
                .map(|byte| match byte {
                    0x20..=0x7E => char::from(*byte).to_string(),
                    other => format!("\\{other:02X}"),
                })
                .collect(),
        }
    }

    /// A 32-bit word; characters make no sense of it, it is decimal then.
    pub fn long(self, value: i32) -> String {
        match self {
            Radix::Hexadecimal => format!("{value:X}"),
            Radix::Binary => format!("{value:032b}"),
            Radix::Octal => format!("{value:o}"),
            Radix::Decimal | Radix::Ascii => value.to_string(),
        }
    }
}

impl Value {
    /// The value as text: words in `radix`, a string in quotes, a structured element with the names of
    /// its columns.
    pub fn text(&self, radix: Radix) -> String {
        match self {
            Value::Bit(bit) => u8::from(*bit).to_string(),
            Value::Word(value) => radix.word(value.cast_unsigned()),
            Value::Long(value) => radix.long(*value),
            Value::Float(value) => format_float(*value),
            Value::Text(text) => format!("\"{text}\""),
            Value::Words(words) => words.iter().map(|value| radix.word(*value)).collect::<Vec<_>>().join(" "),
            Value::Timer(_) | Value::Counter(_) | Value::Control(_) => {
                let (names, cells) = self.columns();
                names.iter().zip(cells).map(|(name, cell)| format!("{name} {cell}")).collect::<Vec<_>>().join("  ")
            }
        }
    }

    /// Names and cells of the columns of a structured element, in the order of printed tables; none for
    /// other values.
    pub fn columns(&self) -> (&'static [&'static str], Vec<String>) {
        let bits = |control: u16, count: u16| (0..count).map(move |n| (control >> (15 - n) & 1).to_string());
        match self {
            Value::Timer(timer) => {
                let base = timer.base().map_or("?", TimeBase::text).to_owned();
                let values = [base, timer.pre.to_string(), timer.acc.to_string()];
                (&["EN", "TT", "DN", "BASE", "PRE", "ACC"], bits(timer.control, 3).chain(values).collect())
            }
            Value::Counter(counter) => {
                let values = [counter.pre.to_string(), counter.acc.to_string()];
                let names = &["CU", "CD", "DN", "OV", "UN", "UA", "PRE", "ACC"];
                (names, bits(counter.control, 6).chain(values).collect())
            }
            Value::Control(control) => {
                let values = [control.len.to_string(), control.pos.to_string()];
                let names = &["EN", "EU", "DN", "EM", "ER", "UL", "IN", "FD", "LEN", "POS"];
                (names, bits(control.control, 8).chain(values).collect())
            }
            _ => (&[], Vec::new()),
        }
    }
}

impl DataFile {
    /// The address of an element the way the program writes it: words of I and O by slot.
    pub fn element_address(&self, element: u16, io: &IoConfiguration) -> Address {
        let of_slot = self.file_type.has_slots().then(|| io.address_of(self.file_type, element)).flatten();
        of_slot.unwrap_or_else(|| Address {
            file: Place::Number(self.number),
            ..Address::element(self.file_type, self.number, element)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_in_every_radix() {
        let text = |radix: Radix| radix.word(0xFF41);
        assert_eq!(text(Radix::Decimal), "-191");
        assert_eq!(text(Radix::Hexadecimal), "FF41");
        assert_eq!(text(Radix::Binary), "1111111101000001");
        assert_eq!(text(Radix::Octal), "177501");
        assert_eq!(text(Radix::Ascii), "\\FFA");
    }

    #[test]
    fn a_timer_has_the_columns_of_paper() {
        let mut file = DataFile::new(FileType::T, 4, 1);
        file.words = vec![0xC000, 100, 7];
        let (names, cells) = file.value(0).expect("an element").columns();
        assert_eq!(names, ["EN", "TT", "DN", "BASE", "PRE", "ACC"]);
        assert_eq!(cells, ["1", "1", "0", "0.01", "100", "7"]);
    }
}
