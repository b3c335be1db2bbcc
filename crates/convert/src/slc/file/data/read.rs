//! Reads the rows of data sections.

use super::{Field, Layout, Rows, STRING_WORDS, STRING_WORDS_MARK, rows, string_words};
use crate::slc::file::Data;
use crate::slc::file::lines::{Lines, push_line};

/// Reads `N7:0`, the address behind `DATA`.
pub(in crate::slc::file) fn header(address: &str) -> Option<Data> {
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
pub(in crate::slc::file) fn read(data: &mut Data, lines: &mut Lines<'_>, ends: impl Fn(&str) -> bool) {
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
        && fields.iter().zip(&values).all(|(field, (value, _))| *field != Field::Hex || hex(value).is_some());
    let mut words = Vec::new();
    let read = values.iter().enumerate().all(|(index, (value, wide))| {
        let is_long = if known { fields.get(index) == Some(&Field::Long) } else { *wide };
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
            let message = "expected an element with as many values as the one before; the project does not hold it";
            lines.lost(number, message);
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
pub(in crate::slc::file) fn word(text: &str) -> Option<u16> {
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

pub(super) fn float_bits(text: &str) -> Option<u32> {
    if let Some(digits) = hex(text) {
        return u32::from_str_radix(digits, 16).ok();
    }
    let plain = text.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'.' | b'-' | b'+' | b'e' | b'E'));
    let value: f32 = if plain { text.parse().ok()? } else { return None };
    value.is_finite().then_some(value.to_bits())
}

fn push_long(words: &mut Vec<u16>, value: u32) {
    words.push((value & 0xFFFF) as u16);
    words.push((value >> 16) as u16);
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
