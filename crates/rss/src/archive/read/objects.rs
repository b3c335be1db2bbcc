//! Object tags and the map of classes and objects behind their numbers.

use super::{Entry, Reader};
use crate::archive::{BIG, BIG_CLASS, CLASS, MAX_OBJECTS, NEW_CLASS, NULL, SCHEMA};
use crate::error::{Error, Result};

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

impl<'a> Reader<'a> {
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
