//! The rows of data sections: which type is written how, for reading and writing alike.

mod read;
mod write;

pub(super) use read::{header, read, word};
pub(super) use write::write;

/// How the elements of a type are laid out in rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rows {
    /// Hex words behind a label with slot and word: `% I:1.0 % 0X0002`.
    Io,
    /// Up to ten decimal words behind a label.
    Words,
    /// Up to five long words behind a label.
    Longs,
    /// Up to five floats behind a label.
    Floats,
    /// One element per line, control word in hex, label last.
    Control,
    /// Text in double quotes below a label.
    Strings,
    /// Words below a label, over lines of this layout.
    Element(Layout),
}

/// One value of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Field {
    Word,
    Hex,
    Long,
}

use Field::{Hex as X, Long as L, Word as W};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Layout {
    /// Values by line; empty for types whose lines have never been seen: ten words a line.
    lines: &'static [&'static [Field]],
    /// A blank line follows each element, and lines have no blank at their end.
    spaced: bool,
}

/// Function files as RSLogix lays them out. Element sizes agree with those of project files.
const LAYOUTS: &[(&str, Layout)] = &[
    ("HSC", Layout { lines: &[&[W, W, X, X, W], &[L, L, L, L, L], &[W, W, W]], spaced: true }),
    ("PTOX", Layout { lines: &[&[W, X, W, L, L, L], &[L, L, L]], spaced: true }),
    ("PWMX", Layout { lines: &[&[W, X, W, L, L, W, W, W]], spaced: true }),
    ("STI", Layout { lines: &[&[W, W, X, W]], spaced: true }),
    ("EII", Layout { lines: &[&[W, W, X, W]], spaced: true }),
    ("RTC", Layout { lines: &[&[W, W, W, W, W, W, W, X]], spaced: false }),
    ("BHI", Layout { lines: &[&[W, W, W, W, W, W, W]], spaced: true }),
    ("MMI", Layout { lines: &[&[W, W, W, W, W, W, W, X]], spaced: false }),
    ("LCD", Layout { lines: &[&[X, X, W, W, W, W, W, W], &[W, W, W, W, W, W, W, W]], spaced: false }),
];

const UNSEEN: Layout = Layout { lines: &[], spaced: true };

fn rows(letters: &str) -> Rows {
    match letters {
        "O" | "I" => Rows::Io,
        "S" | "B" | "N" | "A" | "D" | "G" | "CS" | "IOS" | "ES" => Rows::Words,
        "L" => Rows::Longs,
        "F" => Rows::Floats,
        "T" | "C" | "R" => Rows::Control,
        "ST" => Rows::Strings,
        _ => Rows::Element(LAYOUTS.iter().find(|row| row.0 == letters).map_or(UNSEEN, |row| row.1)),
    }
}

/// Words of a string element: its length, then two characters per word.
const STRING_WORDS: usize = 42;

/// Marks the words of a string that its text does not determine.
const STRING_WORDS_MARK: &str = "% WORDS ";

fn string_words(bytes: &[u8]) -> Vec<u16> {
    let length = u16::try_from(bytes.len()).unwrap_or(u16::MAX);
    let pairs = bytes.chunks(2).map(|pair| u16::from_be_bytes([pair[0], pair.get(1).copied().unwrap_or(0)]));
    let mut words: Vec<u16> = std::iter::once(length).chain(pairs).collect();
    words.resize(STRING_WORDS, 0);
    words
}

#[cfg(test)]
mod tests {
    use super::read::float_bits;
    use super::write::{float_text, write_string};
    use super::*;
    use crate::slc::file::Data;
    use crate::slc::file::lines::Lines;

    #[test]
    fn headers() {
        let read = |text: &str| header(text).map(|d| (d.letters, d.number, d.first));
        assert_eq!(read("N7:0 "), Some(("N".into(), Some(7), 0)));
        assert_eq!(read("O:3"), Some(("O".into(), None, 3)));
        assert_eq!(read("PTOX0:0"), Some(("PTOX".into(), Some(0), 0)));
        for text in ["", "N7", ":0", "7:0", "N7:", "N7:x", "N99999:0", "n7:0"] {
            assert_eq!(read(text), None, "{text}");
        }
    }

    #[test]
    fn floats_keep_their_bits() {
        for (bits, text) in [
            (0.016_666_67_f32.to_bits(), "0.01666667"),
            (0, "0.0"),
            (0x8000_0000, "-0.0"),
            (16_777_217.0_f32.to_bits(), "16777216.0"),
            (0.123_456_79_f32.to_bits(), "0.12345679"),
            (0x7FC0_0001, "0X7FC00001"),
            (0xFF80_0000, "0XFF800000"),
        ] {
            assert_eq!(float_text(bits), text);
            assert_eq!(float_bits(text), Some(bits), "{text}");
        }
    }

    #[test]
    fn strings_keep_their_words() {
        let mut words = string_words(b"A \"q\" \\41 \xB0\r\n");
        let mut text = String::new();
        write_string(&words, &mut text);
        assert_eq!(text, "\"A \\22q\\22 \\5C41 °\\0D\\0A\"\n");
        words[30] = 0x4142;
        words[0] = 200;
        let mut data = Data { letters: "ST".into(), number: Some(9), words_per_element: 42, words, ..Data::default() };
        data.words.extend(string_words(b""));
        let mut text = String::new();
        write(&data, &mut text);
        let mut lines = Lines::new(&text);
        let mut again = header(lines.next().and_then(|l| l.strip_prefix("DATA ")).expect("header")).expect("address");
        read(&mut again, &mut lines, |_| false);
        assert_eq!(again, data, "{text}");
        assert_eq!(lines.into_diagnostics(), []);
    }
}
