//! The standard fonts every PDF reader has, what they can show, and how wide it is.
//!
//! They need no font file, so documents stay small; in exchange only the characters of
//! `WinAnsiEncoding` can be shown. [`printable`] spells the others out.

use std::borrow::Cow;
use std::fmt::Write;

use pdf_writer::types::FontFlags;
use pdf_writer::{Chunk, Name, Rect, Ref};

/// A font.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Font {
    /// Courier: every character 0.6 of the size wide.
    Mono,
    /// Courier Bold.
    MonoBold,
    /// Helvetica.
    Sans,
    /// Helvetica Bold.
    SansBold,
}

/// What a font descriptor says besides widths, from the metrics Adobe published for its core fonts.
struct Metrics {
    bounds: [f32; 4],
    ascent: f32,
    descent: f32,
    capitals: f32,
    stem: f32,
}

/// First code with a width.
const FIRST: u8 = 32;
/// Width of every character of Courier, in thousandths of the size.
const COURIER: u16 = 600;

impl Font {
    /// Every font.
    pub const ALL: [Font; 4] = [Font::Mono, Font::MonoBold, Font::Sans, Font::SansBold];

    /// The name by which page contents call it.
    pub fn resource(self) -> &'static str {
        match self {
            Font::Mono => "M",
            Font::MonoBold => "MB",
            Font::Sans => "S",
            Font::SansBold => "SB",
        }
    }

    fn base(self) -> &'static str {
        match self {
            Font::Mono => "Courier",
            Font::MonoBold => "Courier-Bold",
            Font::Sans => "Helvetica",
            Font::SansBold => "Helvetica-Bold",
        }
    }

    fn metrics(self) -> Metrics {
        let metrics = |bounds, ascent, descent, capitals, stem| Metrics { bounds, ascent, descent, capitals, stem };
        match self {
            Font::Mono => metrics([-23.0, -250.0, 715.0, 805.0], 629.0, -157.0, 562.0, 51.0),
            Font::MonoBold => metrics([-113.0, -250.0, 749.0, 801.0], 629.0, -157.0, 562.0, 106.0),
            Font::Sans => metrics([-166.0, -225.0, 1000.0, 931.0], 718.0, -207.0, 718.0, 88.0),
            Font::SansBold => metrics([-170.0, -228.0, 1003.0, 962.0], 718.0, -207.0, 718.0, 140.0),
        }
    }

    fn units(self, code: u8) -> u16 {
        let of = |widths: &[u16; 224]| code.checked_sub(FIRST).and_then(|at| widths.get(usize::from(at))).copied();
        match self {
            Font::Mono | Font::MonoBold => COURIER,
            Font::Sans => of(&HELVETICA).unwrap_or(0),
            Font::SansBold => of(&HELVETICA_BOLD).unwrap_or(0),
        }
    }

    /// How wide a character is at a size, in the unit of the size.
    pub fn advance(self, c: char, size: f32) -> f32 {
        f32::from(code(c).map_or(0, |code| self.units(code))) * size / 1000.0
    }

    /// How wide a text that went through [`printable`] is at a size, in the unit of the size.
    pub fn width(self, text: &str, size: f32) -> f32 {
        text.chars().map(|c| self.advance(c, size)).sum()
    }

    /// Writes the font as object `id`, and its descriptor as object `descriptor`.
    pub fn write(self, chunk: &mut Chunk, id: Ref, descriptor: Ref) {
        let mut font = chunk.type1_font(id);
        font.base_font(Name(self.base().as_bytes()));
        font.encoding_predefined(Name(b"WinAnsiEncoding"));
        // A reader may put another font in place of a standard one; with widths, nothing moves.
        font.first_char(FIRST).last_char(u8::MAX);
        font.widths((FIRST..=u8::MAX).map(|code| f32::from(self.units(code))));
        font.font_descriptor(descriptor);
        drop(font);
        let Metrics { bounds: [left, bottom, right, top], ascent, descent, capitals, stem } = self.metrics();
        let fixed = matches!(self, Font::Mono | Font::MonoBold);
        let mut descriptor = chunk.font_descriptor(descriptor);
        descriptor.name(Name(self.base().as_bytes()));
        descriptor.flags(if fixed { FontFlags::FIXED_PITCH } else { FontFlags::empty() } | FontFlags::NON_SYMBOLIC);
        descriptor.bbox(Rect::new(left, bottom, right, top)).italic_angle(0.0);
        descriptor.ascent(ascent).descent(descent).cap_height(capitals).stem_v(stem);
    }
}

/// Characters of the codes 0x80 to 0x9F; the code itself where there is none.
const HIGH: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8D}', 'Ž', '\u{8F}', //
    '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9D}', 'ž', 'Ÿ',
];

/// The code of a character, if the fonts can show it. Soft hyphens are left out: readers hide them.
fn code(c: char) -> Option<u8> {
    match c {
        ' '..='~' | '\u{A0}'..='\u{AC}' | '\u{AE}'..='\u{FF}' => u8::try_from(u32::from(c)).ok(),
        '\0'..='\u{FF}' => None,
        _ => HIGH.iter().position(|high| *high == c).and_then(|at| u8::try_from(0x80 + at).ok()),
    }
}

/// The text with every character the fonts cannot show spelled out, as `\x1B` or `\u{2192}`, and how many
/// that are. Tabs become four spaces, as on the terminal.
pub fn printable(text: &str) -> (Cow<'_, str>, usize) {
    if text.chars().all(|c| code(c).is_some()) {
        return (Cow::Borrowed(text), 0);
    }
    let mut out = String::with_capacity(text.len() + 8);
    let mut escaped = 0;
    for c in text.chars() {
        if code(c).is_some() {
            out.push(c);
            continue;
        }
        if c == '\t' {
            out.push_str("    ");
            continue;
        }
        escaped += 1;
        // Writing to a string cannot fail.
        let _ = match u32::from(c) {
            number if number < 0x100 => write!(out, "\\x{number:02X}"),
            number => write!(out, "\\u{{{number:X}}}"),
        };
    }
    (Cow::Owned(out), escaped)
}

/// The codes of a text that went through [`printable`]; a character it left out would become `?`.
pub(super) fn codes(text: &str) -> Vec<u8> {
    text.chars().map(|c| code(c).unwrap_or(b'?')).collect()
}

// Thousandths of the size for the codes from 32 on; 0 where the encoding has none. Values of the metrics
// Adobe published for its core fonts.
#[rustfmt::skip]
const HELVETICA: [u16; 224] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278,
    556, 556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556,
    1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778,
    667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556,
    333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556,
    556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584, 0,
    556, 0, 222, 556, 333, 1000, 556, 556, 333, 1000, 667, 333, 1000, 0, 611, 0,
    0, 222, 222, 333, 333, 350, 556, 1000, 333, 1000, 500, 333, 944, 0, 500, 667,
    278, 333, 556, 556, 556, 556, 260, 556, 333, 737, 370, 556, 584, 333, 737, 333,
    400, 584, 333, 333, 333, 556, 537, 278, 333, 333, 365, 556, 834, 834, 834, 611,
    667, 667, 667, 667, 667, 667, 1000, 722, 667, 667, 667, 667, 278, 278, 278, 278,
    722, 722, 778, 778, 778, 778, 778, 584, 778, 722, 722, 722, 722, 667, 667, 611,
    556, 556, 556, 556, 556, 556, 889, 500, 556, 556, 556, 556, 278, 278, 278, 278,
    556, 556, 556, 556, 556, 556, 556, 584, 611, 556, 556, 556, 556, 500, 556, 500,
];

#[rustfmt::skip]
const HELVETICA_BOLD: [u16; 224] = [
    278, 333, 474, 556, 556, 889, 722, 238, 333, 333, 389, 584, 278, 333, 278, 278,
    556, 556, 556, 556, 556, 556, 556, 556, 556, 556, 333, 333, 584, 584, 584, 611,
    975, 722, 722, 722, 722, 667, 611, 778, 722, 278, 556, 722, 611, 833, 722, 778,
    667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 333, 278, 333, 584, 556,
    333, 556, 611, 556, 611, 556, 333, 611, 611, 278, 278, 556, 278, 889, 611, 611,
    611, 611, 389, 556, 333, 611, 556, 778, 556, 556, 500, 389, 280, 389, 584, 0,
    556, 0, 278, 556, 500, 1000, 556, 556, 333, 1000, 667, 333, 1000, 0, 611, 0,
    0, 278, 278, 500, 500, 350, 556, 1000, 333, 1000, 556, 333, 944, 0, 500, 667,
    278, 333, 556, 556, 556, 556, 280, 556, 333, 737, 370, 556, 584, 333, 737, 333,
    400, 584, 333, 333, 333, 611, 556, 278, 333, 333, 365, 556, 834, 834, 834, 611,
    722, 722, 722, 722, 722, 722, 1000, 722, 667, 667, 667, 667, 278, 278, 278, 278,
    722, 722, 778, 778, 778, 778, 778, 584, 778, 722, 722, 722, 722, 667, 667, 611,
    556, 556, 556, 556, 556, 556, 889, 556, 556, 556, 556, 556, 278, 278, 278, 278,
    611, 611, 611, 611, 611, 611, 611, 584, 611, 611, 611, 611, 611, 556, 611, 556,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_reads_back_as_its_character() {
        // Windows-1252, written out from its definition in the encoding's standard order.
        for c in "€‚ƒ„…†‡ˆ‰Š‹ŒŽ‘’“”•–—˜™š›œžŸ é÷ÿ".chars() {
            assert!(code(c).is_some(), "{c}");
            assert!(Font::Sans.advance(c, 1000.0) > 0.0, "{c}");
            assert!(Font::SansBold.advance(c, 1000.0) > 0.0, "{c}");
        }
        assert_eq!((code('€'), code('Ÿ'), code('ÿ'), code('–')), (Some(0x80), Some(0x9F), Some(0xFF), Some(0x96)));
        for c in ['\u{81}', '\u{8D}', '\u{9D}', '\u{7F}', '\u{AD}', '\n', '\0', '→', '温', '\u{202E}'] {
            assert_eq!(code(c), None, "{c:?}");
        }
    }

    #[test]
    fn nothing_is_dropped() {
        assert_eq!(printable("20 °C – ok (a\\b)"), (Cow::Borrowed("20 °C – ok (a\\b)"), 0));
        let (text, escaped) = printable("a\u{1B}[2J→温\tb\u{AD}\u{81}\r\n");
        assert_eq!(text, "a\\x1B[2J\\u{2192}\\u{6E29}    b\\xAD\\x81\\x0D\\x0A");
        assert_eq!(escaped, 7);
    }

    #[test]
    fn widths_are_those_of_the_fonts() {
        // Adobe's metrics: H 722, e 556, l 222 (bold 278), o 556 (bold 611).
        assert_eq!(Font::Sans.width("Hello", 1000.0), 722.0 + 556.0 + 222.0 + 222.0 + 556.0);
        assert_eq!(Font::SansBold.width("Hello", 1000.0), 722.0 + 556.0 + 278.0 + 278.0 + 611.0);
        assert_eq!(Font::Mono.width("T4:0.ACC", 10.0), 48.0);
    }
}
