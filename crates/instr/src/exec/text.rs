//! Strings: ACI, AIC, ACN, AEX, ASC, ASR, and what ABL and ACB count.
//!
//! A string element has 42 words: the length, 0 to 82, then two characters a word, the first in the
//! high byte (printed). With a length outside 0 to 82 an instruction is not executed and S:5/15 is set
//! (printed); on MicroLogix 1100 and 1400 [`STRING_FAULT`] then goes to S:6 (printed).

use super::choices::Choice;
use super::flags::Flags;
use super::number::{Number, Outcome, Width, fit_integer};
use super::rules::{MathMode, Rules};

/// Characters a string holds.
pub const CAPACITY: usize = 82;
/// Words of a string element.
pub const WORDS: usize = 42;
/// What a string error writes to S:6 on MicroLogix 1100 and 1400: invalid string length.
pub const STRING_FAULT: u16 = 0x1F39;

/// The error every string instruction can have: S:5/15 is to be set, nothing is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StringError;

/// The characters of a string, out of the data table.
#[derive(Clone, Copy, Debug)]
pub struct Text {
    length: usize,
    characters: [u8; CAPACITY],
}

impl Text {
    /// No character.
    pub const EMPTY: Text = Text { length: 0, characters: [0; CAPACITY] };

    /// The string in the words of an element.
    ///
    /// # Errors
    /// A length outside 0 to 82, or fewer words than the length needs.
    pub fn read(words: &[u16]) -> Result<Text, StringError> {
        let (length, content) = words.split_first().ok_or(StringError)?;
        let length = usize::from(*length);
        if length > CAPACITY || content.len() < length.div_ceil(2) {
            return Err(StringError);
        }
        let mut text = Text { length, ..Text::EMPTY };
        for (pair, word) in text.characters.chunks_mut(2).zip(content) {
            pair.copy_from_slice(&word.to_be_bytes());
        }
        Ok(text)
    }

    /// The first 82 of these characters, and whether there were more.
    pub fn cut(characters: impl IntoIterator<Item = u8>) -> (Text, bool) {
        let mut text = Text::EMPTY;
        for character in characters {
            match text.characters.get_mut(text.length) {
                Some(place) => *place = character,
                None => return (text, true),
            }
            text.length += 1;
        }
        (text, false)
    }

    /// The characters.
    pub fn characters(&self) -> &[u8] {
        self.characters.get(..self.length).unwrap_or_default()
    }

    /// Stores the string in the words of an element. What stands behind its end stays, or becomes 0
    /// ([`Choice::StringClearsRest`]). Words that the slice does not have are left out.
    pub fn write(&self, words: &mut [u16], rules: Rules) {
        let Some((length, content)) = words.split_first_mut() else { return };
        *length = self.length as u16;
        let clear = rules.has(Choice::StringClearsRest);
        for (index, word) in content.iter_mut().take(WORDS - 1).enumerate() {
            let mut bytes = word.to_be_bytes();
            for (offset, byte) in bytes.iter_mut().enumerate() {
                match self.characters().get(2 * index + offset) {
                    Some(character) => *byte = *character,
                    None if clear => *byte = 0,
                    None => {}
                }
            }
            *word = u16::from_be_bytes(bytes);
        }
    }
}

impl PartialEq for Text {
    /// Equal characters; what stands behind the end does not count.
    fn eq(&self, other: &Text) -> bool {
        self.characters() == other.characters()
    }
}

impl Eq for Text {}

/// ACI: the first number in a string as an integer; `Ok(None)`: there is no digit, nothing is done
/// (printed).
///
/// A sign directly before the first digit counts (printed: signs are allowed; which one: inferred), commas
/// are skipped, the first other character ends the number (printed). Out of range V is set and 32767 is
/// stored (printed), also below the range unless [`Choice::AciSigned`]. C is called reserved and is reset.
///
/// # Errors
/// A bad length.
pub fn aci(source: &[u16], to: Width, mode: MathMode) -> Result<Option<Outcome>, StringError> {
    let text = Text::read(source)?;
    let characters = text.characters();
    let Some(start) = characters.iter().position(u8::is_ascii_digit) else { return Ok(None) };
    let before = characters.get(..start).unwrap_or_default().iter().rfind(|character| **character != b',');
    let negative = before == Some(&b'-');
    let mut value = 0_i64;
    for character in characters.get(start..).unwrap_or_default() {
        match character {
            b'0'..=b'9' => value = value.saturating_mul(10).saturating_add(i64::from(character - b'0')),
            b',' => {}
            _ => break,
        }
    }
    let value = if negative { -value } else { value };
    let (stored, overflow) = fit_integer(value, to, false);
    let stored = if overflow && !mode.rules.has(Choice::AciSigned) { super::math::limit(to, false) } else { stored };
    Ok(Some(Outcome { value: Some(stored), flags: Flags::of(stored, false, overflow), register: None }))
}

/// AIC: an integer as decimal digits, with a minus sign where needed, without padding (manual, unseen; the
/// range of long words: printed). A float, which AIC does not take, is rounded first.
pub fn aic(source: Number, mode: MathMode) -> Text {
    let value = source.integer().or_else(|| super::number::convert(source, Width::Long, mode).0.integer()).unwrap_or(0);
    let mut digits = [0_u8; 20];
    let (mut rest, mut first) = (value.unsigned_abs(), digits.len());
    loop {
        first -= 1;
        if let Some(place) = digits.get_mut(first) {
            *place = b'0' + (rest % 10) as u8;
        }
        rest /= 10;
        if rest == 0 || first == 0 {
            break;
        }
    }
    let sign = (value < 0).then_some(b'-');
    Text::cut(sign.into_iter().chain(digits.get(first..).unwrap_or_default().iter().copied())).0
}

/// ACN: source A followed by source B. `true`: more than 82 characters, so that it was cut and S:5/15
/// is to be set (manual, unseen).
///
/// # Errors
/// A bad length of a source: nothing is stored.
pub fn acn(a: &[u16], b: &[u16]) -> Result<(Text, bool), StringError> {
    let (a, b) = (Text::read(a)?, Text::read(b)?);
    Ok(Text::cut(a.characters().iter().chain(b.characters()).copied()))
}

/// AEX: `number` characters of the source from `index`, counted from 1. Where the source has fewer, those
/// up to its end are taken without an error (printed).
///
/// # Errors
/// An empty source or a bad length, index or number outside 1 to 82, an index behind the end: the
/// destination is not changed (printed).
pub fn aex(source: &[u16], index: i32, number: i32, rules: Rules) -> Result<Text, StringError> {
    let text = Text::read(source)?;
    let start = offset(index)?;
    let number = offset(number)? + 1;
    let rest = text.characters().get(start..).filter(|rest| !rest.is_empty()).ok_or(StringError)?;
    if rest.len() < number && rules.has(Choice::ExtractNeedsAll) {
        return Err(StringError);
    }
    Ok(Text::cut(rest.iter().copied().take(number)).0)
}

/// ASC: the position, counted from 1, of the first place from `index` on where `within` contains the
/// source; 0 when there is none.
///
/// # Errors
/// An empty source, a bad length, an index outside 1 to 82 or behind the end of the searched string: the
/// result is not changed (printed; that the last concerns the searched string, which the page calls the
/// source string: inferred).
pub fn asc(source: &[u16], index: i32, within: &[u16]) -> Result<i16, StringError> {
    let (wanted, text) = (Text::read(source)?, Text::read(within)?);
    let start = offset(index)?;
    let rest = text.characters().get(start..).filter(|rest| !rest.is_empty()).ok_or(StringError)?;
    if wanted.characters().is_empty() {
        return Err(StringError);
    }
    let found = rest.windows(wanted.characters().len()).position(|part| part == wanted.characters());
    Ok(found.map_or(0, |at| (start + at + 1) as i16))
}

/// An index or number from 1 to 82, counted from 0.
fn offset(value: i32) -> Result<usize, StringError> {
    if (1..=CAPACITY as i32).contains(&value) { Ok(value as usize - 1) } else { Err(StringError) }
}

/// ASR: lengths and characters are equal, upper and lower case apart (printed).
///
/// # Errors
/// A bad length: false, and S:5/15 (printed).
pub fn asr(a: &[u16], b: &[u16]) -> Result<bool, StringError> {
    Ok(Text::read(a)? == Text::read(b)?)
}

/// ABL: the characters in a receive buffer up to and including the first end of a line; `None` without
/// one. `end` are the one or two termination characters of the channel (manual, unseen). ACB counts all
/// characters, the length of the buffer.
pub fn line_length(buffer: &[u8], end: &[u8]) -> Option<usize> {
    if end.is_empty() {
        return None;
    }
    buffer.windows(end.len()).position(|part| part == end).map(|at| at + end.len())
}

#[cfg(test)]
mod tests;
