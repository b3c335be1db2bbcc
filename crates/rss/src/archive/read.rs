//! The archive reader: a bounds-checked cursor with the class and object map and the path for messages.

mod fields;
mod objects;

pub use objects::{Class, Object};

use super::{MAX_DEPTH, MAX_NOTES};
use crate::error::{Deviation, Error, Mode, Result, Space};
use std::fmt::Write as _;

/// What an archive number stands for: a class slot, or an object.
#[derive(Clone, Copy)]
enum Entry {
    Class(u32),
    Object,
}

#[derive(Clone, Copy)]
struct Frame {
    name: &'static str,
    number: u32,
}

const UNNUMBERED: u32 = u32::MAX;

/// Where a [`Reader`] can return to; see [`Reader::checkpoint`].
#[derive(Clone, Copy, Debug)]
pub struct Checkpoint {
    pos: usize,
    map: usize,
    classes: usize,
    path: usize,
    notes: usize,
    more: usize,
    strings: usize,
    loose: usize,
    opaque: usize,
}

/// Cursor over one payload.
///
/// Every reading function takes a name for what it reads; it appears in the
/// message if the bytes are not there. Messages also carry the path of
/// [`Reader::enter`] calls, which costs a push and a pop per record.
pub struct Reader<'a> {
    bytes: &'a [u8],
    pos: usize,
    complete: usize,
    /// Bytes taken by [`Reader::opaque`] so far, and how many of them lie before `complete`.
    opaque: usize,
    complete_opaque: usize,
    stream: Box<str>,
    mode: Mode,
    map: Vec<Entry>,
    classes: Vec<Class<'a>>,
    path: Vec<Frame>,
    strings: usize,
    /// Null and reference tags, which take no number but room in a caller's list.
    loose: usize,
    notes: Vec<Deviation>,
    more: usize,
}

impl<'a> Reader<'a> {
    /// A reader at the start of an inflated payload. `stream` is the full path, for messages.
    #[must_use]
    pub fn new(bytes: &'a [u8], stream: &str, mode: Mode) -> Self {
        Reader {
            bytes,
            pos: 0,
            complete: 0,
            opaque: 0,
            complete_opaque: 0,
            stream: stream.into(),
            mode,
            // Index 0 is null; numbers are assigned from 1.
            map: vec![Entry::Object],
            classes: Vec::new(),
            path: Vec::new(),
            strings: 0,
            loose: 0,
            notes: Vec::new(),
            more: 0,
        }
    }

    /// Offset of the next byte in the payload.
    #[must_use]
    pub fn offset(&self) -> usize {
        self.pos
    }

    /// Bytes not read yet.
    #[must_use]
    pub fn remaining(&self) -> usize {
        self.bytes.len() - self.pos
    }

    /// The mode in force.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// Everything not read yet, without moving.
    #[must_use]
    pub fn peek(&self) -> &'a [u8] {
        self.bytes.get(self.pos..).unwrap_or_default()
    }

    // ---- path ----------------------------------------------------------

    /// Enters a numbered record: `file 4`. Pair with [`Reader::leave`]; after an
    /// error the path stays as it was, so `?` between the two is right.
    ///
    /// # Errors
    /// If records nest deeper than [`MAX_DEPTH`].
    #[inline]
    pub fn enter(&mut self, name: &'static str, number: usize) -> Result<()> {
        if self.path.len() >= MAX_DEPTH {
            return Err(self.too_deep(name));
        }
        let number = u32::try_from(number).unwrap_or(UNNUMBERED);
        self.path.push(Frame { name, number });
        Ok(())
    }

    #[cold]
    fn too_deep(&self, name: &'static str) -> Error {
        self.fault(format_args!("records nested at most {MAX_DEPTH} deep"), format_args!("one more {name}"))
    }

    /// Enters a record without a number: `force table`.
    ///
    /// # Errors
    /// If records nest deeper than [`MAX_DEPTH`].
    #[inline]
    pub fn enter_named(&mut self, name: &'static str) -> Result<()> {
        self.enter(name, usize::MAX)
    }

    /// Leaves the record entered last.
    #[inline]
    pub fn leave(&mut self) {
        self.path.pop();
    }

    /// Notes that everything up to here belongs to complete items: this much
    /// stays understood if an error follows.
    #[inline]
    pub fn mark(&mut self) {
        self.complete = self.pos;
        self.complete_opaque = self.opaque;
    }

    // ---- errors --------------------------------------------------------

    fn located(&self, offset: usize, expected: impl std::fmt::Display, found: impl std::fmt::Display) -> Deviation {
        let mut record = String::new();
        for (i, frame) in self.path.iter().enumerate() {
            // A pathological nest would make a message of many lines: keep both ends.
            if self.path.len() > 16 && i == 8 {
                record.push_str(" > ..");
            }
            if self.path.len() > 16 && (8..self.path.len() - 6).contains(&i) {
                continue;
            }
            let sep = if i == 0 { "" } else { " > " };
            let _ = match frame.number {
                UNNUMBERED => write!(record, "{sep}{}", frame.name),
                n => write!(record, "{sep}{} {n}", frame.name),
            };
        }
        Deviation {
            stream: self.stream.to_string(),
            space: Space::Inflated,
            offset,
            record,
            expected: expected.to_string(),
            found: found.to_string(),
        }
    }

    /// An error at the current offset and path.
    #[cold]
    pub fn fault(&self, expected: impl std::fmt::Display, found: impl std::fmt::Display) -> Error {
        self.located(self.pos, expected, found).into()
    }

    /// An error at a given offset, with the current path.
    #[cold]
    pub fn fault_at(&self, offset: usize, expected: impl std::fmt::Display, found: impl std::fmt::Display) -> Error {
        self.located(offset, expected, found).into()
    }

    /// Reports a deviation after which reading can go on.
    ///
    /// # Errors
    /// The deviation itself in [`Mode::Strict`].
    #[cold]
    pub fn deviation(&mut self, expected: impl std::fmt::Display, found: impl std::fmt::Display) -> Result<()> {
        self.deviation_at(self.pos, expected, found)
    }

    /// [`Reader::deviation`] at a given offset.
    ///
    /// # Errors
    /// The deviation itself in [`Mode::Strict`].
    #[cold]
    pub fn deviation_at(
        &mut self,
        offset: usize,
        expected: impl std::fmt::Display,
        found: impl std::fmt::Display,
    ) -> Result<()> {
        if self.mode == Mode::Strict {
            return Err(self.fault_at(offset, expected, found));
        }
        if self.notes.len() < MAX_NOTES {
            let note = self.located(offset, expected, found);
            self.notes.push(note);
        } else {
            self.more += 1;
        }
        Ok(())
    }

    /// A field that has the same value in every known project: returns it, and
    /// reports a deviation if it differs.
    ///
    /// # Errors
    /// The deviation in [`Mode::Strict`].
    #[inline]
    pub fn usually<T: PartialEq + std::fmt::Debug>(&mut self, what: &'static str, value: T, usual: &T) -> Result<T> {
        if value != *usual {
            let at = self.pos.saturating_sub(size_of::<T>());
            self.deviation_at(at, format_args!("{what} {usual:02x?}"), format_args!("{value:02x?}"))?;
        }
        Ok(value)
    }

    #[cold]
    fn short(&self, what: &'static str, need: usize) -> Error {
        self.fault(format_args!("{what} ({need} bytes)"), format_args!("{} bytes before the end", self.remaining()))
    }

    /// How much was understood, and the deviations met.
    pub(super) fn into_findings(mut self) -> (usize, Vec<Deviation>) {
        if self.more > 0 {
            let last = self.located(
                self.complete,
                format_args!("at most {MAX_NOTES} deviations"),
                format_args!("{} more, not listed", self.more),
            );
            self.notes.push(last);
        }
        (self.complete - self.complete_opaque, self.notes)
    }

    /// Requires the payload to end here.
    ///
    /// # Errors
    /// The trailing bytes as a deviation, in [`Mode::Strict`].
    pub fn expect_end(&mut self) -> Result<()> {
        match self.remaining() {
            0 => Ok(()),
            n => self.deviation("the end of the payload", format_args!("{n} more bytes")),
        }
    }

    // ---- trying --------------------------------------------------------

    /// Remembers the state, for a look ahead that may have to be undone.
    #[must_use]
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            pos: self.pos,
            map: self.map.len(),
            classes: self.classes.len(),
            path: self.path.len(),
            notes: self.notes.len(),
            more: self.more,
            strings: self.strings,
            loose: self.loose,
            opaque: self.opaque,
        }
    }

    /// Undoes everything read since `to`.
    pub fn rewind(&mut self, to: &Checkpoint) {
        self.pos = to.pos;
        self.map.truncate(to.map);
        self.classes.truncate(to.classes);
        self.path.truncate(to.path);
        self.notes.truncate(to.notes);
        self.more = to.more;
        self.strings = to.strings;
        self.loose = to.loose;
        self.opaque = to.opaque;
    }
}
