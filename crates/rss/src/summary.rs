//! `\x05SummaryInformation`: the property set with project figures, under a format identifier of its own.

use crate::error::{Deviation, Error, Result, Space};
use crate::stream::StreamKind;
use crate::text::{decode, encode};
use std::borrow::Cow;

/// Format identifier that RSLogix uses instead of the standard one, and its
/// class identifier: {DC192244-B4EF-11D0-8298-00C04FD8FC64}.
pub const FORMAT_ID: [u8; 16] =
    [0x44, 0x22, 0x19, 0xDC, 0xEF, 0xB4, 0xD0, 0x11, 0x82, 0x98, 0x00, 0xC0, 0x4F, 0xD8, 0xFC, 0x64];

/// Property ids; evidence in `docs/format/project-streams.md`.
pub mod id {
    /// Code page (I2).
    pub const CODE_PAGE: u32 = 1;
    /// Revision number (text).
    pub const REVISION: u32 = 9;
    /// Edit time (duration).
    pub const EDIT_TIME: u32 = 10;
    /// Last printed.
    pub const PRINTED: u32 = 11;
    /// Created.
    pub const CREATED: u32 = 12;
    /// Last saved.
    pub const SAVED: u32 = 13;
    /// Application (text).
    pub const APPLICATION: u32 = 18;
    /// Processor name (text).
    pub const PROCESSOR_NAME: u32 = 20;
    /// Program ID (I4).
    pub const PROGRAM_ID: u32 = 21;
    /// Instruction words left (I4).
    pub const WORDS_LEFT: u32 = 23;
    /// Instruction words used (I4).
    pub const WORDS_USED: u32 = 24;
    /// Program files, unused numbers not counted (I4).
    pub const PROGRAM_FILES: u32 = 25;
    /// Data files, unused ones not counted (I4).
    pub const DATA_FILES: u32 = 32;
}

/// A property's value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Value<'a> {
    /// VT_I2.
    I2(i16),
    /// VT_I4.
    I4(i32),
    /// VT_LPSTR without its terminating zero, as stored (code page 1252).
    Text(Cow<'a, [u8]>),
    /// VT_FILETIME: 100 ns since 1601-01-01 UTC, or a duration; 0 = never.
    Time(u64),
    /// Another type, or the dictionary (id 0): type number, bytes not taken apart.
    Other(u32),
}

/// One property.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Property<'a> {
    /// Property id; see [`id`].
    pub id: u32,
    /// Value.
    pub value: Value<'a>,
}

/// The property set as read. The stored bytes stay with it: padding between
/// properties holds leftovers, so only they can be written back identically.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Summary<'a> {
    bytes: &'a [u8],
    /// Properties in stored order.
    pub properties: Vec<Property<'a>>,
}

const VT_I2: u32 = 2;
const VT_I4: u32 = 3;
const VT_LPSTR: u32 = 30;
const VT_FILETIME: u32 = 64;
/// Bytes before the section's offset, and before the properties of a section.
const HEADER: usize = 48;
/// A property set of more properties than this is no summary.
const MAX_PROPERTIES: u32 = 4096;

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk::<4>()?))
}

fn fault(offset: usize, expected: &str, found: impl Into<String>) -> Error {
    Deviation {
        stream: StreamKind::SummaryInformation.name().to_owned(),
        space: Space::Stored,
        offset,
        record: String::new(),
        expected: expected.to_owned(),
        found: found.into(),
    }
    .into()
}

impl<'a> Summary<'a> {
    /// Reads the stream.
    ///
    /// # Errors
    /// If it is no property set, or a property lies outside of it.
    pub fn read(bytes: &'a [u8]) -> Result<Summary<'a>> {
        let short = || fault(bytes.len(), "a property set", format!("{} bytes", bytes.len()));
        if bytes.first_chunk::<2>() != Some(&[0xFE, 0xFF]) {
            return Err(fault(0, "a property set (FE FF)", "other bytes"));
        }
        // Format identifiers are not compared: the layout is that of every
        // property set, and the private one may change with the application.
        let section = u32_at(bytes, 44).ok_or_else(short)?;
        let section = usize::try_from(section).map_err(|_| short())?;
        let body = bytes.get(section..).filter(|body| body.len() >= 8);
        let Some(body) = body else {
            return Err(fault(44, "the offset of a section", format!("{section:#x}")));
        };
        let count = u32_at(body, 4).ok_or_else(short)?;
        let room = body.len() / 8 - 1;
        if count > MAX_PROPERTIES || usize::try_from(count).is_ok_and(|count| count > room) {
            return Err(fault(section + 4, "a number of properties that fits", count.to_string()));
        }
        let mut properties = Vec::new();
        for index in 0..usize::try_from(count).unwrap_or_default() {
            let entry = 8 + 8 * index;
            let (Some(id), Some(offset)) = (u32_at(body, entry), u32_at(body, entry + 4)) else {
                return Err(short());
            };
            let value = usize::try_from(offset).ok().and_then(|offset| read_value(id, body.get(offset..)?));
            let Some(value) = value else {
                return Err(fault(
                    section + entry,
                    "a property inside the section",
                    format!("property {id} at {offset:#x}"),
                ));
            };
            properties.push(Property { id, value });
        }
        Ok(Summary { bytes, properties })
    }

    /// The stored bytes, for an identical copy.
    #[must_use]
    pub fn as_bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// Value of a property.
    #[must_use]
    pub fn get(&self, id: u32) -> Option<&Value<'a>> {
        self.properties.iter().find(|property| property.id == id).map(|property| &property.value)
    }

    /// A number property (I2 or I4).
    #[must_use]
    pub fn number(&self, id: u32) -> Option<i32> {
        match self.get(id)? {
            Value::I2(number) => Some(i32::from(*number)),
            Value::I4(number) => Some(*number),
            _ => None,
        }
    }

    /// A text property.
    #[must_use]
    pub fn text(&self, id: u32) -> Option<Cow<'_, str>> {
        match self.get(id)? {
            Value::Text(bytes) => Some(decode(bytes)),
            _ => None,
        }
    }

    /// A time property; `None` also for 0, which means never.
    #[must_use]
    pub fn time(&self, id: u32) -> Option<u64> {
        match self.get(id)? {
            Value::Time(0) => None,
            Value::Time(ticks) => Some(*ticks),
            _ => None,
        }
    }

    /// Instruction words used and left, `None` where the project was not
    /// verified before saving (both are 0 then).
    #[must_use]
    pub fn instruction_words(&self) -> Option<(u32, u32)> {
        let used = u32::try_from(self.number(id::WORDS_USED)?).ok()?;
        let left = u32::try_from(self.number(id::WORDS_LEFT)?).ok()?;
        (used != 0 || left != 0).then_some((used, left))
    }
}

fn read_value(id: u32, bytes: &[u8]) -> Option<Value<'_>> {
    let (kind, rest) = bytes.split_first_chunk::<4>()?;
    let kind = u32::from_le_bytes(*kind);
    if id == 0 {
        // The dictionary has no type; what stands here is its entry count.
        return Some(Value::Other(kind));
    }
    Some(match kind {
        VT_I2 => Value::I2(i16::from_le_bytes(*rest.first_chunk::<2>()?)),
        VT_I4 => Value::I4(i32::from_le_bytes(*rest.first_chunk::<4>()?)),
        VT_FILETIME => Value::Time(u64::from_le_bytes(*rest.first_chunk::<8>()?)),
        VT_LPSTR => {
            let (length, rest) = rest.split_first_chunk::<4>()?;
            let length = usize::try_from(u32::from_le_bytes(*length)).ok()?;
            let text = rest.get(..length)?;
            Value::Text(Cow::Borrowed(text.strip_suffix(&[0]).unwrap_or(text)))
        }
        other => Value::Other(other),
    })
}

/// Figures for the property set of a new project.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct NewSummary<'a> {
    /// Processor name.
    pub processor_name: &'a str,
    /// Application that wrote the file.
    pub application: &'a str,
    /// Revision number.
    pub revision: u32,
    /// Program ID.
    pub program_id: u16,
    /// Instruction words used and left; `None` if not verified.
    pub instruction_words: Option<(u32, u32)>,
    /// Program files, unused numbers not counted.
    pub program_files: u32,
    /// Data files, unused ones not counted.
    pub data_files: u32,
    /// Time of creation and of saving, 100 ns since 1601-01-01 UTC; 0 = never.
    /// Time is an argument so that the same project gives the same bytes.
    pub created: u64,
    /// Time of saving.
    pub saved: u64,
}

impl NewSummary<'_> {
    /// The stream, with properties in the order that RSLogix writes.
    ///
    /// # Errors
    /// If a text does not fit code page 1252 or a number 31 bits.
    pub fn write(&self) -> Result<Vec<u8>> {
        let text = |text: &str| {
            encode(text)
                .map(|bytes| Value::Text(Cow::Owned(bytes)))
                .map_err(|c| Error::Unwritable(format!("{c:?} is not in code page 1252")))
        };
        let number = |number: u32| {
            i32::try_from(number)
                .map(Value::I4)
                .map_err(|_| Error::Unwritable(format!("{number} in a 31-bit property")))
        };
        let (used, left) = self.instruction_words.unwrap_or_default();
        let mut list = vec![
            (id::CODE_PAGE, Value::I2(1252)),
            (id::REVISION, text(&self.revision.to_string())?),
            (id::EDIT_TIME, Value::Time(0)),
            (id::PRINTED, Value::Time(0)),
            (id::SAVED, Value::Time(self.saved)),
            (id::CREATED, Value::Time(self.created)),
        ];
        // Title, subject, author, keywords, comments, template, last author.
        for id in 2..=8 {
            list.push((id, text("")?));
        }
        list.extend([
            (id::PROCESSOR_NAME, text(self.processor_name)?),
            (id::PROGRAM_ID, number(u32::from(self.program_id))?),
            (22, Value::I4(1)),
            (id::WORDS_LEFT, number(left)?),
            (id::WORDS_USED, number(used)?),
            (id::PROGRAM_FILES, number(self.program_files)?),
            (id::DATA_FILES, number(self.data_files)?),
            (33, Value::I4(1)),
            (id::APPLICATION, text(self.application)?),
            (0x8000_0002, Value::I4(0)),
            (0, Value::Other(1)),
        ]);
        write_section(&list)
    }
}

fn write_section(list: &[(u32, Value<'_>)]) -> Result<Vec<u8>> {
    let too_long = |_| Error::Unwritable("a property set beyond 4 GiB".to_owned());
    let mut index = Vec::new();
    let mut values: Vec<u8> = Vec::new();
    let start = 8 + 8 * list.len();
    for (id, value) in list {
        let at = u32::try_from(start + values.len()).map_err(too_long)?;
        index.extend(id.to_le_bytes());
        index.extend(at.to_le_bytes());
        match value {
            Value::I2(number) => {
                values.extend(VT_I2.to_le_bytes());
                values.extend(number.to_le_bytes());
            }
            Value::I4(number) => {
                values.extend(VT_I4.to_le_bytes());
                values.extend(number.to_le_bytes());
            }
            Value::Time(ticks) => {
                values.extend(VT_FILETIME.to_le_bytes());
                values.extend(ticks.to_le_bytes());
            }
            Value::Text(bytes) => {
                values.extend(VT_LPSTR.to_le_bytes());
                let length = u32::try_from(bytes.len() + 1).map_err(too_long)?;
                values.extend(length.to_le_bytes());
                values.extend_from_slice(bytes);
                values.push(0);
            }
            // The dictionary: one entry, id 0, the empty name.
            Value::Other(_) => values.extend([1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0]),
        }
        if *id != 0 {
            values.resize(values.len().next_multiple_of(4), 0);
        }
    }
    let mut bytes = vec![0xFE, 0xFF, 0, 0, 6, 1, 2, 0];
    bytes.extend(FORMAT_ID);
    bytes.extend(1u32.to_le_bytes());
    bytes.extend(FORMAT_ID);
    bytes.extend((HEADER as u32).to_le_bytes());
    bytes.extend(u32::try_from(start + values.len()).map_err(too_long)?.to_le_bytes());
    bytes.extend(u32::try_from(list.len()).map_err(too_long)?.to_le_bytes());
    bytes.extend(index);
    bytes.extend(values);
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Vec<u8> {
        NewSummary {
            processor_name: "MIXER",
            application: "rungs",
            revision: 12,
            program_id: 0xAB7B,
            instruction_words: Some((107, 6549)),
            program_files: 3,
            data_files: 9,
            created: 133_000_000_000_000_000,
            saved: 0,
        }
        .write()
        .expect("fits")
    }

    #[test]
    fn what_is_written_reads_back() {
        let bytes = sample();
        let summary = Summary::read(&bytes).expect("a property set");
        assert_eq!(summary.number(id::CODE_PAGE), Some(1252));
        assert_eq!(summary.text(id::PROCESSOR_NAME).as_deref(), Some("MIXER"));
        assert_eq!(summary.text(id::REVISION).as_deref(), Some("12"));
        assert_eq!(summary.number(id::PROGRAM_ID), Some(0xAB7B));
        assert_eq!(summary.instruction_words(), Some((107, 6549)));
        assert_eq!(summary.time(id::CREATED), Some(133_000_000_000_000_000));
        assert_eq!(summary.time(id::SAVED), None);
        assert_eq!(summary.as_bytes(), bytes);
    }

    #[test]
    fn the_layout_is_that_of_a_property_set() {
        let bytes = sample();
        assert_eq!(&bytes[..8], [0xFE, 0xFF, 0, 0, 6, 1, 2, 0]);
        assert_eq!(&bytes[8..24], FORMAT_ID);
        assert_eq!(&bytes[24..28], [1, 0, 0, 0]);
        assert_eq!(&bytes[44..48], [48, 0, 0, 0]);
        // Section size counts itself; the dictionary comes last, unpadded.
        let size = u32_at(&bytes, 48).expect("size") as usize;
        assert_eq!(48 + size, bytes.len());
        assert_eq!(u32_at(&bytes, 52), Some(24));
        assert_eq!(&bytes[bytes.len() - 13..], [1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0]);
    }

    #[test]
    fn damaged_sets_are_located() {
        let bytes = sample();
        for end in 0..bytes.len() {
            // The last bytes belong to the dictionary, which is not taken apart.
            if end < bytes.len() - 9 {
                let error = Summary::read(&bytes[..end]).expect_err("truncated");
                assert!(error.deviation().is_some(), "{error}");
            }
        }
        let mut huge = bytes.clone();
        huge[52..56].copy_from_slice(&[0xFF; 4]);
        assert!(Summary::read(&huge).is_err());
        let mut far = bytes;
        far[60..64].copy_from_slice(&[0xFF; 4]);
        assert!(Summary::read(&far).is_err());
    }
}
