//! Fonts of a report: which character a code stands for and how wide it is.

use lopdf::{Dictionary, Document, Object};
use std::collections::HashMap;

/// A composite font with two-byte codes, the only kind that RSLogix reports use.
#[derive(Debug, Clone, Default)]
pub(super) struct Font {
    characters: HashMap<u16, String>,
    widths: HashMap<u16, f64>,
    default_width: f64,
}

impl Font {
    /// Reads `ToUnicode` and the widths of the descendant font.
    pub(super) fn read(pdf: &Document, font: &Dictionary) -> Result<Self, String> {
        let map = font.get_deref(b"ToUnicode", pdf).and_then(Object::as_stream).map_err(told)?;
        let map = map.decompressed_content().map_err(told)?;
        let descendants = font.get_deref(b"DescendantFonts", pdf).and_then(Object::as_array).map_err(told)?;
        let first = descendants.first().ok_or("a font without descendant")?;
        let descendant = pdf.dereference(first).and_then(|(_, o)| o.as_dict()).map_err(told)?;
        let default = descendant.get_deref(b"DW", pdf).and_then(Object::as_float).unwrap_or(1000.0);
        let mut widths = HashMap::new();
        if let Ok(list) = descendant.get_deref(b"W", pdf).and_then(Object::as_array) {
            read_widths(pdf, list, &mut widths);
        }
        Ok(Self { characters: characters(&map), widths, default_width: f64::from(default) })
    }

    /// Decodes a shown string: its text and its width in thousandths of the font size.
    ///
    /// A code that the font does not map shows as U+FFFD, so that it is seen and not lost.
    pub(super) fn decode(&self, bytes: &[u8]) -> (String, f64) {
        let (mut text, mut width) = (String::new(), 0.0);
        for pair in bytes.chunks(2) {
            let code = pair.iter().fold(0_u16, |code, b| (code << 8) | u16::from(*b));
            text.push_str(self.characters.get(&code).map_or("\u{fffd}", String::as_str));
            width += self.widths.get(&code).copied().unwrap_or(self.default_width);
        }
        (text, width)
    }
}

pub(super) fn told(error: lopdf::Error) -> String {
    error.to_string()
}

/// `W` holds `first [w w w]` and `first last w` in any order.
fn read_widths(pdf: &Document, list: &[Object], widths: &mut HashMap<u16, f64>) {
    let number = |o: &Object| pdf.dereference(o).ok().and_then(|(_, o)| o.as_float().ok()).map(f64::from);
    let code = |o: &Object| o.as_i64().ok().and_then(|n| u16::try_from(n).ok());
    let mut rest = list;
    while let [first, second, tail @ ..] = rest {
        let Some(from) = code(first) else { return };
        if let Ok((_, Object::Array(array))) = pdf.dereference(second) {
            for (at, width) in (from..).zip(array) {
                if let Some(width) = number(width) {
                    widths.insert(at, width);
                }
            }
            rest = tail;
        } else {
            let (Some(to), Some((width, tail))) = (code(second), tail.split_first()) else { return };
            if let Some(width) = number(width) {
                widths.extend((from..=to).map(|at| (at, width)));
            }
            rest = tail;
        }
    }
}

/// Reads the `bfchar` and `bfrange` blocks of a character map.
fn characters(map: &[u8]) -> HashMap<u16, String> {
    let text = String::from_utf8_lossy(map);
    let mut found = HashMap::new();
    let mut block = "";
    let mut codes: Vec<String> = Vec::new();
    let spaced = text.replace('<', " <").replace('>', "> ").replace(['[', ']'], " ");
    for word in spaced.split_whitespace() {
        match word {
            "beginbfchar" | "beginbfrange" => {
                block = word;
                codes.clear();
            }
            "endbfchar" | "endbfrange" => block = "",
            _ => codes.push(word.trim_matches(['<', '>']).to_owned()),
        }
        match (block, codes.as_slice()) {
            ("beginbfchar", [code, unicode]) => {
                if let (Ok(code), Some(text)) = (u16::from_str_radix(code, 16), utf16(unicode, 0)) {
                    found.insert(code, text);
                }
                codes.clear();
            }
            ("beginbfrange", [from, to, unicode]) => {
                if let (Ok(from), Ok(to)) = (u16::from_str_radix(from, 16), u16::from_str_radix(to, 16)) {
                    let each = |code: u16| Some((code, utf16(unicode, code - from)?));
                    found.extend((from..=to).filter_map(each));
                }
                codes.clear();
            }
            _ => {}
        }
    }
    found
}

/// UTF-16 in hexadecimal, its last unit raised by `step`.
fn utf16(hex: &str, step: u16) -> Option<String> {
    let mut units: Vec<u16> = Vec::new();
    for at in (0..hex.len()).step_by(4) {
        units.push(u16::from_str_radix(hex.get(at..at + 4)?, 16).ok()?);
    }
    let last = units.last_mut()?;
    *last = last.checked_add(step)?;
    String::from_utf16(&units).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_codes_and_ranges() {
        let map = b"2 beginbfchar <0003> <0020> <0010> <002D> endbfchar 1 beginbfrange <0024><0026><0041> endbfrange";
        let found = characters(map);
        let text: Vec<_> = [3, 0x10, 0x24, 0x26].iter().map(|c| found[c].as_str()).collect();
        assert_eq!(text, [" ", "-", "A", "C"]);
        assert_eq!(found.len(), 5);
    }
}
