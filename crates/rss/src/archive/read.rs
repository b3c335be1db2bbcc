//! The archive reader: a bounds-checked cursor with the class and object map and the path for messages.

use super::{BIG, BIG_CLASS, CLASS, MAX_DEPTH, MAX_NOTES, MAX_OBJECTS, MAX_STRINGS, NEW_CLASS, NULL, SCHEMA};
use crate::error::{Deviation, Error, Mode, Result, Space};
use crate::text::{LengthForm, Text};
use std::fmt::Write as _;

/// A class as its first object introduced it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Class<'a> {
    /// Name, e.g. `CIns`.
    pub name: &'a [u8],
    /// Schema number, 128 in every known project.
    pub schema: u16,
    /// Place in the order of first appearance, from 0: a cheap key for a table of one's own.
    pub slot: usize,
}

/// What an object tag announces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Object<'a> {
    /// No object.
    Null,
    /// An object whose body follows; it took `number`.
    New {
        /// Its class.
        class: Class<'a>,
        /// Its archive number.
        number: u32,
    },
    /// Object `number`, read before.
    Reference {
        /// Archive number of that object.
        number: u32,
    },
}

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

    // ---- plain fields --------------------------------------------------

    /// `n` bytes, borrowed.
    ///
    /// # Errors
    /// If fewer are left.
    #[inline(always)]
    pub fn bytes(&mut self, what: &'static str, n: usize) -> Result<&'a [u8]> {
        let end = self.pos.checked_add(n);
        match end.and_then(|end| self.bytes.get(self.pos..end)) {
            Some(bytes) => {
                self.pos += n;
                Ok(bytes)
            }
            None => Err(self.short(what, n)),
        }
    }

    /// `n` bytes that are carried without knowing what they mean. They do not
    /// count as understood.
    ///
    /// # Errors
    /// If fewer are left.
    pub fn opaque(&mut self, what: &'static str, n: usize) -> Result<&'a [u8]> {
        let bytes = self.bytes(what, n)?;
        self.opaque += n;
        Ok(bytes)
    }

    /// `N` bytes as an array.
    ///
    /// # Errors
    /// If fewer are left.
    #[inline(always)]
    pub fn array<const N: usize>(&mut self, what: &'static str) -> Result<[u8; N]> {
        match self.bytes.get(self.pos..).and_then(|rest| rest.first_chunk::<N>()) {
            Some(array) => {
                self.pos += N;
                Ok(*array)
            }
            None => Err(self.short(what, N)),
        }
    }

    /// One byte.
    ///
    /// # Errors
    /// At the end of the payload.
    #[inline(always)]
    pub fn u8(&mut self, what: &'static str) -> Result<u8> {
        Ok(u8::from_le_bytes(self.array(what)?))
    }

    /// A little-endian u16.
    ///
    /// # Errors
    /// If fewer than 2 bytes are left.
    #[inline(always)]
    pub fn u16(&mut self, what: &'static str) -> Result<u16> {
        Ok(u16::from_le_bytes(self.array(what)?))
    }

    /// A little-endian u32.
    ///
    /// # Errors
    /// If fewer than 4 bytes are left.
    #[inline(always)]
    pub fn u32(&mut self, what: &'static str) -> Result<u32> {
        Ok(u32::from_le_bytes(self.array(what)?))
    }

    /// Checks `n` items of at least `min_bytes` each against what is left, so
    /// that room for `n` items may be allocated.
    ///
    /// # Errors
    /// If that many cannot follow.
    #[inline(always)]
    pub fn check_room(&self, what: &'static str, n: usize, min_bytes: usize) -> Result<usize> {
        if n.checked_mul(min_bytes).is_none_or(|need| need > self.remaining()) {
            return Err(self.no_room(what, n));
        }
        Ok(n)
    }

    #[cold]
    fn no_room(&self, what: &'static str, n: usize) -> Error {
        self.fault(format_args!("{what} that fits the {} bytes left", self.remaining()), n)
    }

    #[cold]
    fn too_many(&self, what: &'static str, limit: usize) -> Error {
        self.fault(format_args!("at most {limit} {what}"), "one more")
    }

    /// An MFC count (`ReadCount`): u16, or `FFFF` and a u32. Checked against
    /// what is left: each item takes at least `min_bytes`.
    ///
    /// # Errors
    /// If that many items cannot follow.
    #[inline(always)]
    pub fn count(&mut self, what: &'static str, min_bytes: usize) -> Result<usize> {
        let at = self.pos;
        let n = match self.u16(what)? {
            0xFFFF => {
                let n = self.u32(what)?;
                if n < 0xFFFF {
                    self.deviation_at(at, format_args!("{what} in its short form"), format_args!("long form of {n}"))?;
                }
                // 32 bits always fit: the crate supports no smaller address space.
                usize::try_from(n).unwrap_or(usize::MAX)
            }
            n => usize::from(n),
        };
        self.check_room(what, n, min_bytes)
    }

    /// A plain u16 count, checked like [`Reader::count`].
    ///
    /// # Errors
    /// If that many items cannot follow.
    #[inline]
    pub fn count_u16(&mut self, what: &'static str, min_bytes: usize) -> Result<usize> {
        let n = usize::from(self.u16(what)?);
        self.check_room(what, n, min_bytes)
    }

    /// A plain u32 count, checked like [`Reader::count`].
    ///
    /// # Errors
    /// If that many items cannot follow.
    #[inline]
    pub fn count_u32(&mut self, what: &'static str, min_bytes: usize) -> Result<usize> {
        let n = usize::try_from(self.u32(what)?).unwrap_or(usize::MAX);
        self.check_room(what, n, min_bytes)
    }

    // ---- strings -------------------------------------------------------

    /// A `CString`. Length: u8; or `FF` and a u16; or `FF FFFF` and a u32;
    /// `FF FFFE` announces UTF-16 and is followed by the length in the same forms.
    ///
    /// # Errors
    /// If the text is longer than what is left, or the stream holds more than
    /// [`MAX_STRINGS`] strings.
    #[inline(always)]
    pub fn string(&mut self, what: &'static str) -> Result<Text<'a>> {
        if self.strings >= MAX_STRINGS {
            return Err(self.too_many("strings", MAX_STRINGS));
        }
        self.strings += 1;
        match self.u8(what)? {
            0xFF => self.long_string(what),
            n => Ok(Text::from_bytes(self.bytes(what, usize::from(n))?)),
        }
    }

    /// [`Reader::string`] `count` times, onto a list.
    ///
    /// # Errors
    /// As [`Reader::string`].
    #[inline]
    pub fn strings(&mut self, what: &'static str, count: usize, out: &mut Vec<Text<'a>>) -> Result<()> {
        // Each takes a byte at least, but most are short lists: room for a hostile count is not made.
        out.reserve_exact(count.min(16));
        for _ in 0..count {
            match self.peek().split_first() {
                // The common case, built where it goes to: a copy of each costs more than reading it.
                Some((&n, rest)) if n < 0xFF && usize::from(n) <= rest.len() && self.strings < MAX_STRINGS => {
                    self.strings += 1;
                    self.pos += 1 + usize::from(n);
                    out.push(Text::from_bytes(rest.get(..usize::from(n)).unwrap_or_default()));
                }
                _ => out.push(self.string(what)?),
            }
        }
        Ok(())
    }

    #[cold]
    fn long_string(&mut self, what: &'static str) -> Result<Text<'a>> {
        let mut wide = false;
        let mut first = self.u16(what)?;
        if first == 0xFFFE {
            wide = true;
            match self.u8(what)? {
                0xFF => first = self.u16(what)?,
                n => {
                    let bytes = self.bytes(what, usize::from(n) * 2)?;
                    return Ok(Text::from_parts(bytes, true, LengthForm::Shortest));
                }
            }
        }
        let (units, form) = match first {
            0xFFFF => {
                let n = self.u32(what)?;
                let n = usize::try_from(n).unwrap_or(usize::MAX);
                (n, if n < 0xFFFE { LengthForm::Long } else { LengthForm::Shortest })
            }
            n => {
                let n = usize::from(n);
                (n, if (0xFF..0xFFFE).contains(&n) { LengthForm::Shortest } else { LengthForm::Word })
            }
        };
        let size = if wide { 2 } else { 1 };
        self.check_room(what, units, size)?;
        Ok(Text::from_parts(self.bytes(what, units * size)?, wide, form))
    }

    // ---- objects -------------------------------------------------------

    #[inline]
    fn check_objects(&self) -> Result<()> {
        if self.map.len() + self.loose >= MAX_OBJECTS {
            return Err(self.too_many("classes and objects", MAX_OBJECTS));
        }
        Ok(())
    }

    fn null(&mut self) -> Result<Object<'a>> {
        self.check_objects()?;
        self.loose += 1;
        Ok(Object::Null)
    }

    fn number(&mut self, entry: Entry) -> Result<u32> {
        self.check_objects()?;
        let number = self.map.len();
        self.map.push(entry);
        Ok(u32::try_from(number).unwrap_or(u32::MAX))
    }

    /// An object tag. For [`Object::New`] the body follows; read it before the next tag.
    ///
    /// # Errors
    /// If the tag names a class or an object that this archive has not introduced.
    #[inline]
    pub fn object(&mut self) -> Result<Object<'a>> {
        let at = self.pos;
        let tag = self.u16("an object tag")?;
        if tag & CLASS != 0 && tag != NEW_CLASS {
            return self.known_class(at, u32::from(tag & !CLASS));
        }
        match tag {
            NULL => self.null(),
            NEW_CLASS => self.new_class(),
            BIG => {
                let big = self.u32("a 32-bit object tag")?;
                let number = big & !BIG_CLASS;
                if number < u32::from(BIG) {
                    self.deviation_at(at, "a 16-bit tag for a small number", format_args!("32-bit tag {big:#010x}"))?;
                }
                if big & BIG_CLASS != 0 {
                    self.known_class(at, number)
                } else if number == 0 {
                    self.null()
                } else {
                    self.known_object(at, number)
                }
            }
            number => self.known_object(at, u32::from(number)),
        }
    }

    /// True if what follows can only be an object of its own: the tag of a class
    /// introduced before, or the introduction of a new one. Moves nothing.
    ///
    /// Serves to tell whether an optional record stands before the next object.
    #[must_use]
    pub fn at_object(&self) -> bool {
        let is_class = |number: u32| {
            let entry = usize::try_from(number).ok().and_then(|i| self.map.get(i));
            matches!(entry, Some(Entry::Class(_)))
        };
        match *self.peek() {
            [0xFF, 0xFF, a, b, length, 0, first, ..] => {
                u16::from_le_bytes([a, b]) == SCHEMA && length > 0 && first.is_ascii_alphabetic()
            }
            [0xFF, 0x7F, a, b, c, d, ..] if d & 0x80 != 0 => is_class(u32::from_le_bytes([a, b, c, d & 0x7F])),
            [low, high, ..] if high & 0x80 != 0 => is_class(u32::from(u16::from_le_bytes([low, high & 0x7F]))),
            _ => false,
        }
    }

    #[inline]
    fn known_class(&mut self, at: usize, number: u32) -> Result<Object<'a>> {
        let entry = usize::try_from(number).ok().and_then(|i| self.map.get(i));
        let class = match entry {
            Some(Entry::Class(slot)) => self.classes.get(*slot as usize).copied(),
            _ => None,
        };
        match class {
            Some(class) => Ok(Object::New { class, number: self.number(Entry::Object)? }),
            None => {
                Err(self.fault_at(at, "the tag of a class introduced before", format_args!("class number {number}")))
            }
        }
    }

    #[cold]
    fn known_object(&mut self, at: usize, number: u32) -> Result<Object<'a>> {
        match usize::try_from(number).ok().and_then(|i| self.map.get(i)) {
            Some(Entry::Object) => {
                self.check_objects()?;
                self.loose += 1;
                Ok(Object::Reference { number })
            }
            _ => Err(self.fault_at(
                at,
                "an object tag",
                format_args!("a reference to object {number}, which does not exist"),
            )),
        }
    }

    #[cold]
    fn new_class(&mut self) -> Result<Object<'a>> {
        let schema = self.u16("a class schema")?;
        let length = self.u16("the length of a class name")?;
        let at = self.pos;
        let name = self.bytes("a class name", usize::from(length))?;
        if !name.iter().all(|b| b.is_ascii_alphanumeric() || *b == b'_') || name.is_empty() {
            return Err(self.fault_at(
                at,
                "a class name",
                format_args!("{:?}", crate::text::decode(&name[..name.len().min(40)])),
            ));
        }
        if schema != SCHEMA {
            let name = crate::text::decode(name);
            self.deviation_at(at - 4, format_args!("schema {SCHEMA} for class {name}"), schema)?;
        }
        if self.classes.iter().any(|c| c.name == name) {
            self.deviation_at(at, "each class introduced once", format_args!("{} again", crate::text::decode(name)))?;
        }
        let slot = self.classes.len();
        let class = Class { name, schema, slot };
        self.number(Entry::Class(u32::try_from(slot).unwrap_or(u32::MAX)))?;
        self.classes.push(class);
        Ok(Object::New { class, number: self.number(Entry::Object)? })
    }

    /// Takes the tag of an object of one class if it is what follows and the
    /// class is known already; otherwise moves nothing. The short cut through
    /// [`Reader::object`] for lists that are mostly of one class.
    #[inline]
    pub fn try_object(&mut self, class: &'static str) -> bool {
        let Some(&[low, high]) = self.peek().first_chunk::<2>() else { return false };
        let number = usize::from(u16::from_le_bytes([low, high & 0x7F]));
        if high & 0x80 == 0 || self.map.len() + self.loose >= MAX_OBJECTS {
            return false;
        }
        let Some(Entry::Class(slot)) = self.map.get(number) else { return false };
        if self.classes.get(*slot as usize).is_none_or(|c| c.name != class.as_bytes()) {
            return false;
        }
        self.map.push(Entry::Object);
        self.pos += 2;
        true
    }

    /// An object of one class; its body follows. Returns its archive number.
    ///
    /// # Errors
    /// If anything else stands there.
    #[inline]
    pub fn expect_object(&mut self, class: &'static str) -> Result<u32> {
        let at = self.pos;
        if self.try_object(class) {
            return Ok(u32::try_from(self.map.len() - 1).unwrap_or(u32::MAX));
        }
        match self.object()? {
            Object::New { class: c, number } if c.name == class.as_bytes() => Ok(number),
            other => Err(self.unexpected(at, class, &other)),
        }
    }

    /// The error for an object of the wrong class.
    #[cold]
    pub fn unexpected(&self, at: usize, expected: impl std::fmt::Display, found: &Object<'_>) -> Error {
        let expected = format_args!("an object of class {expected}").to_string();
        match found {
            Object::Null => self.fault_at(at, expected, "a null object"),
            Object::New { class, .. } => {
                self.fault_at(at, expected, format_args!("class {}", crate::text::decode(class.name)))
            }
            Object::Reference { number } => self.fault_at(at, expected, format_args!("a reference to object {number}")),
        }
    }
}
