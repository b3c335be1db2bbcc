//! Text as the archive stores it: 8-bit bytes in code page 1252, with the form its length was written in.

use std::borrow::Cow;
use std::fmt;

/// Characters of the bytes 0x80 to 0x9F in code page 1252. The five bytes the
/// code page leaves free (81, 8D, 8F, 90, 9D) stand for the C1 control of the
/// same number, as Windows itself maps them, so that every byte has a
/// character of its own and decoding can be undone.
const HIGH: [char; 32] = [
    '\u{20AC}', '\u{81}', '\u{201A}', '\u{192}', '\u{201E}', '\u{2026}', '\u{2020}', '\u{2021}', '\u{2C6}', '\u{2030}',
    '\u{160}', '\u{2039}', '\u{152}', '\u{8D}', '\u{17D}', '\u{8F}', '\u{90}', '\u{2018}', '\u{2019}', '\u{201C}',
    '\u{201D}', '\u{2022}', '\u{2013}', '\u{2014}', '\u{2DC}', '\u{2122}', '\u{161}', '\u{203A}', '\u{153}', '\u{9D}',
    '\u{17E}', '\u{178}',
];

/// The character of one byte in code page 1252; every byte has one.
#[must_use]
pub fn decode_byte(byte: u8) -> char {
    match byte {
        0x80..=0x9F => HIGH[usize::from(byte - 0x80)],
        _ => char::from(byte),
    }
}

/// The byte of one character in code page 1252, `None` if the code page lacks it.
#[must_use]
pub fn encode_char(c: char) -> Option<u8> {
    match u32::from(c) {
        low @ (0..=0x7F | 0xA0..=0xFF) => u8::try_from(low).ok(),
        _ => HIGH.iter().position(|&h| h == c).and_then(|i| u8::try_from(0x80 + i).ok()),
    }
}

/// Decodes code page 1252 bytes; borrows when they are plain ASCII.
#[must_use]
pub fn decode(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) if bytes.is_ascii() => Cow::Borrowed(text),
        _ => Cow::Owned(bytes.iter().map(|&b| decode_byte(b)).collect()),
    }
}

/// Encodes text to code page 1252.
///
/// # Errors
/// The first character that the code page lacks.
pub fn encode(text: &str) -> Result<Vec<u8>, char> {
    text.chars().map(|c| encode_char(c).ok_or(c)).collect()
}

/// How wide the length in front of a string was written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LengthForm {
    /// The shortest form that holds the length: what every known writer uses.
    #[default]
    Shortest,
    /// `FF`, then a u16, although a u8 would have held it.
    Word,
    /// `FF FFFF`, then a u32, although less would have held it.
    Long,
}

/// One string of an archive: its bytes, and how its length was encoded.
///
/// `Display` decodes code page 1252 (or UTF-16 for the wide form, which no known
/// project uses). Comparing with `str` compares the decoded characters.
#[derive(Clone)]
pub struct Text<'a>(Repr<'a>);

/// Three words, as a program holds tens of thousands of these.
#[derive(Clone)]
enum Repr<'a> {
    /// 8-bit, length in its shortest form: nearly every text.
    Borrowed(&'a [u8]),
    /// The same, owned.
    Owned(Box<[u8]>),
    /// Any other form.
    Odd(Box<Odd<'a>>),
}

#[derive(Clone)]
struct Odd<'a> {
    bytes: Cow<'a, [u8]>,
    wide: bool,
    form: LengthForm,
}

impl<'a> Text<'a> {
    /// Text of 8-bit bytes, its length written in the shortest form.
    #[must_use]
    pub const fn from_bytes(bytes: &'a [u8]) -> Self {
        Text(Repr::Borrowed(bytes))
    }

    /// Text as read: bytes, width and the form of the length.
    #[must_use]
    pub(crate) fn from_parts(bytes: &'a [u8], wide: bool, form: LengthForm) -> Self {
        match (wide, form) {
            (false, LengthForm::Shortest) => Text::from_bytes(bytes),
            _ => Text(Repr::Odd(Box::new(Odd { bytes: Cow::Borrowed(bytes), wide, form }))),
        }
    }

    /// Encodes a Rust string to code page 1252.
    ///
    /// # Errors
    /// The first character that the code page lacks.
    pub fn new(text: &'a str) -> Result<Self, char> {
        if text.is_ascii() {
            return Ok(Text::from_bytes(text.as_bytes()));
        }
        Ok(Text(Repr::Owned(encode(text)?.into_boxed_slice())))
    }

    /// The stored bytes: one per character, or two (UTF-16, low byte first) if [`Text::is_wide`].
    #[must_use]
    pub fn as_bytes(&self) -> &[u8] {
        match &self.0 {
            Repr::Borrowed(bytes) => bytes,
            Repr::Owned(bytes) => bytes,
            Repr::Odd(odd) => &odd.bytes,
        }
    }

    /// True if no character is stored.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.as_bytes().is_empty()
    }

    /// Length in stored bytes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.as_bytes().len()
    }

    /// True for the UTF-16 form.
    #[must_use]
    pub fn is_wide(&self) -> bool {
        matches!(&self.0, Repr::Odd(odd) if odd.wide)
    }

    /// The form in which the length was written.
    #[must_use]
    pub fn length_form(&self) -> LengthForm {
        match &self.0 {
            Repr::Odd(odd) => odd.form,
            _ => LengthForm::Shortest,
        }
    }

    /// The characters; borrows for plain ASCII.
    #[must_use]
    pub fn decode(&self) -> Cow<'_, str> {
        if !self.is_wide() {
            return decode(self.as_bytes());
        }
        let units = self.as_bytes().chunks_exact(2).map(|p| u16::from_le_bytes([p[0], p[1]]));
        Cow::Owned(char::decode_utf16(units).map(|r| r.unwrap_or(char::REPLACEMENT_CHARACTER)).collect())
    }

    /// The same text, owning its bytes.
    #[must_use]
    pub fn into_owned(self) -> Text<'static> {
        Text(match self.0 {
            Repr::Borrowed(bytes) => Repr::Owned(bytes.into()),
            Repr::Owned(bytes) => Repr::Owned(bytes),
            Repr::Odd(odd) => {
                let Odd { bytes, wide, form } = *odd;
                Repr::Odd(Box::new(Odd { bytes: Cow::Owned(bytes.into_owned()), wide, form }))
            }
        })
    }

    /// What makes two texts the same: bytes and form, owned or not.
    fn key(&self) -> (&[u8], bool, LengthForm) {
        (self.as_bytes(), self.is_wide(), self.length_form())
    }
}

impl Default for Text<'_> {
    fn default() -> Self {
        Text::from_bytes(&[])
    }
}

impl PartialEq for Text<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Eq for Text<'_> {}

impl std::hash::Hash for Text<'_> {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.key().hash(state);
    }
}

impl fmt::Debug for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.decode())?;
        match (self.is_wide(), self.length_form()) {
            (false, LengthForm::Shortest) => Ok(()),
            (wide, form) => write!(f, " (wide: {wide}, length: {form:?})"),
        }
    }
}

impl fmt::Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.decode())
    }
}

impl PartialEq<str> for Text<'_> {
    fn eq(&self, other: &str) -> bool {
        self.decode() == other
    }
}

impl PartialEq<&str> for Text<'_> {
    fn eq(&self, other: &&str) -> bool {
        self.decode() == *other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_has_a_character_of_its_own() {
        let all: Vec<u8> = (0..=255).collect();
        let text = decode(&all);
        assert_eq!(encode(&text), Ok(all));
        // Characters as the published code page lists them.
        assert_eq!(decode(&[0x80, 0xB0, 0xF7, 0x9C]), "\u{20AC}\u{B0}\u{F7}\u{153}");
    }

    #[test]
    fn a_character_outside_the_code_page_is_named() {
        assert_eq!(Text::new("20 \u{2103}"), Err('\u{2103}'));
        assert_eq!(Text::new("20 \u{B0}C").map(|t| t.as_bytes().to_vec()), Ok(b"20 \xB0C".to_vec()));
    }

    #[test]
    fn wide_text_shows_its_characters() {
        let text = Text::from_parts(b"T\x004\x00", true, LengthForm::Shortest);
        assert_eq!(text, "T4");
        assert_eq!(text.to_string(), "T4");
    }
}
