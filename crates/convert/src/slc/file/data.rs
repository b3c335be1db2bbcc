//! The rows of data sections: which type is written how, for reading and writing alike.

use std::fmt::Write as _;

use ladder::format_float;

use super::Data;
use super::lines::{Lines, push_line};

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

/// Reads `N7:0`, the address behind `DATA`.
pub(super) fn header(address: &str) -> Option<Data> {
    let (name, element) = address.trim().split_once(':')?;
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let number = name.get(letters.len()..)?;
    let is_number = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    if letters.is_empty() || !letters.bytes().all(|b| b.is_ascii_uppercase()) || !is_number(element) {
        return None;
    }
    Some(Data {
        letters: letters.to_owned(),
        number: if number.is_empty() { None } else { Some(number.parse().ok()?) },
        first: element.parse().ok()?,
        ..Data::default()
    })
}

/// Reads rows until `ends` says that the line begins another section.
pub(super) fn read(data: &mut Data, lines: &mut Lines<'_>, ends: impl Fn(&str) -> bool) {
    let rows = rows(&data.letters);
    data.words_per_element = match rows {
        Rows::Io | Rows::Words => 1,
        Rows::Longs | Rows::Floats => 2,
        Rows::Control => 3,
        Rows::Strings => 42,
        Rows::Element(_) => 0,
    };
    while let Some(line) = lines.peek() {
        let text = line.trim();
        if text.is_empty() {
            lines.next();
            continue;
        }
        if ends(line) {
            break;
        }
        match rows {
            Rows::Strings => string(data, lines),
            Rows::Element(layout) => element(data, lines, layout, &ends),
            _ => row(data, lines, rows),
        }
    }
}

/// The label in a row's comment and the values outside of it. `None` if the comment is not closed.
fn parts(line: &str) -> Option<(Option<&str>, Vec<&str>)> {
    let mut pieces = line.splitn(3, '%');
    let before = pieces.next().unwrap_or("");
    let Some(label) = pieces.next() else { return Some((None, before.split_whitespace().collect())) };
    let after = pieces.next()?;
    Some((Some(label.trim()), before.split_whitespace().chain(after.split_whitespace()).collect()))
}

/// The element number in a label `N7:10`, the word number in `I:1.0`.
fn label_index(label: &str) -> Option<u32> {
    label.rsplit([':', '.']).next()?.parse().ok()
}

fn row(data: &mut Data, lines: &mut Lines<'_>, rows: Rows) {
    let line = lines.peek().unwrap_or("");
    let Some((label, values)) = parts(line) else {
        return lines.keep(&mut data.extra, "expected % after the label of a data row");
    };
    if values.is_empty() && label.is_some_and(|label| label.starts_with('.')) {
        lines.next();
        return;
    }
    let mut words = Vec::new();
    let read = values.iter().all(|value| match rows {
        Rows::Longs => long(value).map(|v| push_long(&mut words, v)).is_some(),
        Rows::Floats => float_bits(value).map(|v| push_long(&mut words, v)).is_some(),
        _ => word(value).map(|v| words.push(v)).is_some(),
    });
    if !read || values.is_empty() || (rows == Rows::Control && words.len() != 3) {
        return lines.keep(&mut data.extra, "expected a row of data values");
    }
    let element = data.words.len() / usize::from(data.words_per_element.max(1));
    if let Some(label) = label
        && label_index(label).and_then(|index| usize::try_from(index).ok()) != Some(element)
    {
        let message = format!("expected the row of element {element}, found `{label}`; rows are taken in file order");
        lines.warn(lines.number(), message);
    }
    lines.next();
    data.words.append(&mut words);
}

fn string(data: &mut Data, lines: &mut Lines<'_>) {
    let line = lines.peek().unwrap_or("").trim();
    if let Some(words) = line.strip_prefix(STRING_WORDS_MARK) {
        let words: Option<Vec<u16>> = words.trim_end_matches('%').split_whitespace().map(word).collect();
        let last = data.words.len().checked_sub(STRING_WORDS);
        match (words, last) {
            (Some(words), Some(last)) if words.len() == STRING_WORDS => {
                data.words.truncate(last);
                data.words.extend(words);
                lines.next();
            }
            _ => lines.keep(&mut data.extra, "expected the 42 words of a string"),
        }
        return;
    }
    if matches!(parts(line), Some((Some(label), values)) if values.is_empty() && label_index(label).is_some()) {
        lines.next();
        return;
    }
    let text = line.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
    match text.and_then(string_bytes) {
        Some(bytes) => {
            data.words.extend(string_words(&bytes));
            lines.next();
        }
        None => lines.keep(&mut data.extra, "expected a string of up to 82 characters in double quotes"),
    }
}

/// An element of a function file or another structure: a label line and the lines of values below.
fn element(data: &mut Data, lines: &mut Lines<'_>, layout: Layout, ends: &impl Fn(&str) -> bool) {
    let number = lines.number();
    let mut taken = String::new();
    let mut values = Vec::new();
    if let Some(line) = lines.peek()
        && matches!(parts(line), Some((Some(_), inline)) if inline.is_empty())
    {
        push_line(&mut taken, line.trim_end());
        lines.next();
    }
    while let Some(line) = lines.peek() {
        if line.trim().is_empty() || line.contains('%') || ends(line) {
            break;
        }
        push_line(&mut taken, line.trim_end());
        columns(line, &mut values);
        lines.next();
    }
    if values.is_empty() && taken.is_empty() {
        return lines.keep(&mut data.extra, "expected the label of an element");
    }
    let fields: Vec<Field> = layout.lines.concat();
    let known = fields.len() == values.len()
        && fields.iter().zip(&values).all(|(field, (value, _))| *field != X || hex(value).is_some());
    let mut words = Vec::new();
    let read = values.iter().enumerate().all(|(index, (value, wide))| {
        let is_long = if known { fields.get(index) == Some(&L) } else { *wide };
        if is_long {
            long(value).map(|v| push_long(&mut words, v)).is_some()
        } else {
            word(value).map(|v| words.push(v)).is_some()
        }
    });
    let count = u16::try_from(words.len()).ok().filter(|count| *count > 0);
    match count {
        Some(count) if read && (data.words_per_element == count || data.words.is_empty()) => {
            data.words_per_element = count;
            data.words.append(&mut words);
        }
        _ => {
            lines.warn(number, "expected an element with as many values as the one before; its lines are kept");
            // An empty line keeps the lines of one element from those of the next.
            if !data.extra.is_empty() {
                data.extra.push('\n');
            }
            push_line(&mut data.extra, &taken);
        }
    }
}

/// The values of a line, and whether each stands in a column as wide as RSLogix makes long words.
fn columns<'a>(line: &'a str, values: &mut Vec<(&'a str, bool)>) {
    let mut end = 0;
    let mut rest = line.trim_end();
    while !rest.trim_start().is_empty() {
        let blanks = rest.len() - rest.trim_start().len();
        let value = rest.trim_start();
        let length = value.find(char::is_whitespace).unwrap_or(value.len());
        let width = blanks + length;
        values.push((value.get(..length).unwrap_or(""), width >= 13));
        end += width;
        rest = line.trim_end().get(end..).unwrap_or("");
    }
}

/// A word in decimal, signed or not, or hex.
pub(super) fn word(text: &str) -> Option<u16> {
    if let Some(digits) = hex(text) {
        return u16::from_str_radix(digits, 16).ok();
    }
    let number: i32 = text.parse().ok()?;
    u16::try_from(number).ok().or_else(|| i16::try_from(number).ok().map(|n| n as u16))
}

fn long(text: &str) -> Option<u32> {
    if let Some(digits) = hex(text) {
        return u32::from_str_radix(digits, 16).ok();
    }
    let number: i64 = text.parse().ok()?;
    u32::try_from(number).ok().or_else(|| i32::try_from(number).ok().map(|n| n as u32))
}

fn hex(text: &str) -> Option<&str> {
    text.strip_prefix("0X").or_else(|| text.strip_prefix("0x")).filter(|digits| !digits.starts_with('+'))
}

fn float_bits(text: &str) -> Option<u32> {
    if let Some(digits) = hex(text) {
        return u32::from_str_radix(digits, 16).ok();
    }
    let plain = text.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'.' | b'-' | b'+' | b'e' | b'E'));
    let value: f32 = if plain { text.parse().ok()? } else { return None };
    value.is_finite().then_some(value.to_bits())
}

/// The float as RSLogix spells it; with more digits where seven do not give the same number back,
/// and as its bits in hex where no digits do.
fn float_text(bits: u32) -> String {
    let value = f32::from_bits(bits);
    let vendor = format_float(value);
    if float_bits(&vendor) == Some(bits) {
        return vendor;
    }
    let exact = format!("{value:?}");
    if float_bits(&exact) == Some(bits) { exact } else { format!("0X{bits:08X}") }
}

fn push_long(words: &mut Vec<u16>, value: u32) {
    words.push((value & 0xFFFF) as u16);
    words.push((value >> 16) as u16);
}

fn pair(words: &[u16]) -> u32 {
    let at = |index: usize| u32::from(words.get(index).copied().unwrap_or(0));
    at(0) | at(1) << 16
}

/// The bytes of a string's text: `\hh` is the byte of that hex number, every other character the
/// byte it has in code page 1252.
fn string_bytes(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let code = rest.get(1..3).filter(|d| c == '\\' && d.bytes().all(|b| b.is_ascii_hexdigit()));
        match code.and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = rest.get(3..).unwrap_or("");
            }
            None => {
                bytes.push(rss::text::encode_char(c)?);
                rest = rest.get(c.len_utf8()..).unwrap_or("");
            }
        }
    }
    (bytes.len() <= 2 * (STRING_WORDS - 1)).then_some(bytes)
}

fn string_words(bytes: &[u8]) -> Vec<u16> {
    let length = u16::try_from(bytes.len()).unwrap_or(u16::MAX);
    let pairs = bytes.chunks(2).map(|pair| u16::from_be_bytes([pair[0], pair.get(1).copied().unwrap_or(0)]));
    let mut words: Vec<u16> = std::iter::once(length).chain(pairs).collect();
    words.resize(STRING_WORDS, 0);
    words
}

/// Writes a section: header, rows, and the blank line of each element where there is one.
pub(super) fn write(data: &Data, out: &mut String) {
    let rows = rows(&data.letters);
    let name = match data.number {
        Some(number) => format!("{}{number}", data.letters),
        None => data.letters.clone(),
    };
    // Writing to a string cannot fail.
    let _ = write!(out, "DATA {name}:{}", data.first);
    let unnumbered = data.number.is_none() || data.words.is_empty();
    out.push_str(if unnumbered { "\n" } else { " \n" });
    // `% N7:0  %`: padded to two digits, the status file not.
    let label = |element: usize| match rows {
        Rows::Io => format!("% {name}:{}.{element} %", data.first),
        _ if data.number.is_none() => format!("% {name}:{element} %"),
        _ => format!("% {name}:{element:<2} %"),
    };
    let table = |out: &mut String, per_row: usize, size: usize, text: &dyn Fn(&[u16]) -> String| {
        let elements: Vec<&[u16]> = data.words.chunks(size).collect();
        for (row, values) in elements.chunks(per_row).enumerate() {
            out.push_str(&label(row * per_row));
            for value in values {
                out.push_str(&text(value));
            }
            out.push_str(" \n");
        }
    };
    match rows {
        Rows::Io => table(out, usize::MAX, 1, &|v| format!(" 0X{:04X}", pair(v))),
        Rows::Words => table(out, 10, 1, &|v| format!(" {:>6}", signed(v))),
        Rows::Longs => table(out, 5, 2, &|v| format!(" {:>11}", pair(v) as i32)),
        Rows::Floats => table(out, 5, 2, &|v| format!(" {:>13}", float_text(pair(v)))),
        Rows::Control => {
            let (second, third) = if data.letters == "R" { (".LEN", ".POS") } else { (".PRE", ".ACC") };
            let _ = writeln!(out, "% .CTL   {second}   {third}    %");
            for (element, words) in data.words.chunks(3).enumerate() {
                let at = |index: usize| words.get(index..).map_or(0, signed);
                let control = words.first().copied().unwrap_or(0);
                let _ = writeln!(out, "0X{control:04X} {:>6} {:>6} {}", at(1), at(2), label(element));
            }
        }
        Rows::Strings => {
            for (element, words) in data.words.chunks(STRING_WORDS).enumerate() {
                let _ = writeln!(out, "{}", label(element));
                write_string(words, out);
            }
        }
        Rows::Element(layout) => {
            let size = usize::from(data.words_per_element.max(1));
            for (element, words) in data.words.chunks(size).enumerate() {
                let _ = writeln!(out, "{}", label(element));
                write_element(words, layout, out);
            }
            if !layout.spaced && !data.extra.is_empty() {
                out.push('\n');
            }
        }
    }
    if !data.extra.is_empty() {
        out.push_str(&data.extra);
        out.push('\n');
    }
}

fn signed(words: &[u16]) -> i16 {
    words.first().map_or(0, |word| *word as i16)
}

fn write_string(words: &[u16], out: &mut String) {
    let length = usize::from(words.first().copied().unwrap_or(0)).min(2 * (STRING_WORDS - 1));
    let bytes: Vec<u8> = words.iter().skip(1).flat_map(|word| word.to_be_bytes()).take(length).collect();
    out.push('"');
    for byte in &bytes {
        match byte {
            b'"' | b'\\' | 0..=0x1F | 0x7F..=0x9F | 0xAD => {
                let _ = write!(out, "\\{byte:02X}");
            }
            _ => out.push(rss::text::decode_byte(*byte)),
        }
    }
    out.push_str("\"\n");
    // Characters behind the end of the text are data, too: a program can read them.
    if string_words(&bytes) != words {
        out.push_str(STRING_WORDS_MARK);
        for word in words {
            let _ = write!(out, "{word} ");
        }
        out.push_str("%\n");
    }
}

fn write_element(words: &[u16], layout: Layout, out: &mut String) {
    let size = |field: &Field| if *field == L { 2 } else { 1 };
    let sum: usize = layout.lines.iter().flat_map(|line| line.iter()).map(size).sum();
    let mut rest = words;
    let mut take = |count: usize| {
        let (taken, left) = rest.split_at(count.min(rest.len()));
        rest = left;
        taken
    };
    let mut lines: Vec<Vec<String>> = Vec::new();
    if sum == words.len() {
        for line in layout.lines {
            let text = |field: &Field| {
                let value = take(size(field));
                match field {
                    Field::Word => format!("{:>6}", signed(value)),
                    Field::Hex => format!("0X{:04X}", pair(value)),
                    Field::Long => format!("{:>13}", pair(value) as i32),
                }
            };
            lines.push(line.iter().map(text).collect());
        }
    } else {
        lines.extend(words.chunks(10).map(|line| line.iter().map(|w| format!("{:>6}", *w as i16)).collect()));
    }
    for line in lines {
        out.push_str(&line.join(" "));
        out.push_str(if layout.spaced { "\n" } else { " \n" });
    }
    if layout.spaced {
        out.push('\n');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
