//! Writes the rows of data sections.

use std::fmt::Write as _;

use ladder::format_float;

use super::read::float_bits;
use super::{Field, Layout, Rows, STRING_WORDS, STRING_WORDS_MARK, rows, string_words};
use crate::slc::file::Data;

/// Writes a section: header, rows, and the blank line of each element where there is one.
pub(in crate::slc::file) fn write(data: &Data, out: &mut String) {
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

pub(super) fn write_string(words: &[u16], out: &mut String) {
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
    let size = |field: &Field| if *field == Field::Long { 2 } else { 1 };
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

/// The float as RSLogix spells it; with more digits where seven do not give the same number back,
/// and as its bits in hex where no digits do.
pub(super) fn float_text(bits: u32) -> String {
    let value = f32::from_bits(bits);
    let vendor = format_float(value);
    if float_bits(&vendor) == Some(bits) {
        return vendor;
    }
    let exact = format!("{value:?}");
    if float_bits(&exact) == Some(bits) { exact } else { format!("0X{bits:08X}") }
}

fn pair(words: &[u16]) -> u32 {
    let at = |index: usize| u32::from(words.get(index).copied().unwrap_or(0));
    at(0) | at(1) << 16
}
