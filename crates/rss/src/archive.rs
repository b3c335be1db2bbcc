//! MFC `CArchive`, the object serialization inside every stream: a reader that locates its errors, and its writer.
//!
//! A payload is a sequence of little-endian fields, strings and *objects*. An
//! object opens with a tag:
//!
//! | tag (u16) | meaning |
//! |---|---|
//! | `0000` | null |
//! | `FFFF` | first object of a class: u16 schema, u16 name length, name; the body follows |
//! | `8000 \| i` | object of class number *i*; the body follows |
//! | `7FFF` | u32 follows: `80000000 \| i` is an object of class *i*, anything else refers to object *i* |
//! | *i* | refers to object *i* read before |
//!
//! Classes and objects draw their numbers from one counter that starts at 1. An
//! object takes its number before its body is read. Numbers are assigned per
//! file; nothing can be told from their value.
//!
//! A stream is described by a type that implements [`Record`]; [`parse`] and
//! [`serialize`] run it:
//!
//! ```
//! use rss::archive::{Reader, Record, Writer, parse, serialize};
//! use rss::{Mode, Result, Text};
//!
//! /// `CVersionData { CString full; CString version; CString build }`
//! #[derive(Default)]
//! struct Version<'a> { full: Text<'a>, version: Text<'a>, build: Text<'a> }
//!
//! impl<'a> Record<'a> for Version<'a> {
//!     fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
//!         r.expect_object("CVersionData")?;
//!         self.full = r.string("full version")?;
//!         self.version = r.string("version")?;
//!         self.build = r.string("build")?;
//!         Ok(())
//!     }
//!     fn write(&self, w: &mut Writer) -> Result<()> {
//!         w.object("CVersionData");
//!         w.string(&self.full)?;
//!         w.string(&self.version)?;
//!         w.string(&self.build)
//!     }
//! }
//!
//! let payload = b"\xFF\xFF\x80\0\x0C\0CVersionData\x0A8.30.00.16\x078.30.00\x0216";
//! let parsed = parse::<Version>(payload, "Version/ObjectData", Mode::Strict);
//! assert!(parsed.error.is_none());
//! assert_eq!(parsed.understood, payload.len());
//! assert_eq!(parsed.value.build, "16");
//! assert_eq!(serialize(&parsed.value)?, payload);
//! # Ok::<(), rss::Error>(())
//! ```

mod read;
mod write;

pub use read::{Class, Object, Reader};
pub use write::Writer;

use crate::error::{Deviation, Error, Mode, Result};

/// Schema number of every class of every known project.
pub const SCHEMA: u16 = 128;

/// Records may nest this deep. Real programs stay below 16; the bound keeps a
/// hostile file from exhausting the stack.
pub const MAX_DEPTH: usize = 128;

/// Archive numbers (classes and objects) that one stream may use up. The
/// largest known program uses 30,990; the bound keeps a small file of tiny
/// objects from claiming all memory.
pub const MAX_OBJECTS: usize = 1 << 19;

/// Strings that one stream may hold; see [`MAX_OBJECTS`].
pub const MAX_STRINGS: usize = 1 << 20;

/// Deviations kept per stream; those beyond are counted only.
pub(crate) const MAX_NOTES: usize = 200;

const NULL: u16 = 0;
const NEW_CLASS: u16 = 0xFFFF;
const BIG: u16 = 0x7FFF;
const CLASS: u16 = 0x8000;
const BIG_CLASS: u32 = 0x8000_0000;

/// A typed stream: how its payload is read and written.
///
/// Reading fills `self` in place, so that what was complete before an error
/// survives it. Containers call [`Reader::mark`] after each complete item.
pub trait Record<'a>: Default {
    /// Reads the whole payload, from the root object's tag on.
    ///
    /// # Errors
    /// The first place where the bytes cannot be this record.
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()>;

    /// Writes the payload; after an undisturbed read, the same bytes.
    ///
    /// # Errors
    /// [`Error::Unwritable`] if a field's value has no stored form.
    fn write(&self, w: &mut Writer) -> Result<()>;
}

/// A record as far as it could be read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parsed<R> {
    /// The record; after an error, what was complete before it.
    pub value: R,
    /// Payload bytes that belong to fields of `value`.
    pub understood: usize,
    /// What stopped reading.
    pub error: Option<Error>,
    /// What deviates from the rules without stopping reading.
    pub deviations: Vec<Deviation>,
}

impl<R> Parsed<R> {
    /// The record, if nothing stopped reading it.
    ///
    /// # Errors
    /// What stopped reading.
    pub fn into_result(self) -> Result<R> {
        match self.error {
            Some(error) => Err(error),
            None => Ok(self.value),
        }
    }
}

/// Reads a payload as a record. `stream` is the full path, for messages.
#[must_use]
pub fn parse<'a, R: Record<'a>>(payload: &'a [u8], stream: &str, mode: Mode) -> Parsed<R> {
    let mut r = Reader::new(payload, stream, mode);
    let mut value = R::default();
    let result = value.read(&mut r).and_then(|()| {
        r.mark();
        r.expect_end()
    });
    let (understood, deviations) = r.into_findings();
    Parsed { value, understood, error: result.err(), deviations }
}

/// The payload of a record.
///
/// # Errors
/// [`Error::Unwritable`] if a field's value has no stored form.
pub fn serialize<'a, R: Record<'a>>(record: &R) -> Result<Vec<u8>> {
    let mut w = Writer::new();
    record.write(&mut w)?;
    Ok(w.into_bytes())
}

#[cfg(test)]
mod tests;
