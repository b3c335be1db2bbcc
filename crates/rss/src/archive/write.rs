//! The archive writer: the mirror of the reader, numbering classes and objects as MFC does.

use super::{BIG, BIG_CLASS, CLASS, NEW_CLASS, NULL, SCHEMA};
use crate::error::{Error, Result};
use crate::text::{LengthForm, Text};

/// Builds one payload.
#[derive(Debug)]
pub struct Writer {
    out: Vec<u8>,
    /// Class names with their numbers; a stream has at most a handful, so a list is the fastest map.
    classes: Vec<(&'static str, u32)>,
    next: u32,
}

impl Default for Writer {
    fn default() -> Self {
        Writer::new()
    }
}

impl Writer {
    /// An empty archive.
    #[must_use]
    pub const fn new() -> Self {
        Writer { out: Vec::new(), classes: Vec::new(), next: 1 }
    }

    /// The payload written.
    #[must_use]
    pub fn into_bytes(self) -> Vec<u8> {
        self.out
    }

    /// Bytes written so far.
    #[must_use]
    pub fn len(&self) -> usize {
        self.out.len()
    }

    /// True before the first byte.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.out.is_empty()
    }

    /// Appends bytes as they are.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.out.extend_from_slice(bytes);
    }

    /// Appends one byte.
    pub fn u8(&mut self, v: u8) {
        self.out.push(v);
    }

    /// Appends a little-endian u16.
    pub fn u16(&mut self, v: u16) {
        self.bytes(&v.to_le_bytes());
    }

    /// Appends a little-endian u32.
    pub fn u32(&mut self, v: u32) {
        self.bytes(&v.to_le_bytes());
    }

    /// Appends an MFC count (`WriteCount`): u16, or `FFFF` and a u32 from 0xFFFF on.
    ///
    /// # Errors
    /// If `n` does not fit 32 bits.
    pub fn count(&mut self, n: usize) -> Result<()> {
        match u16::try_from(n) {
            Ok(short) if short != 0xFFFF => self.u16(short),
            _ => {
                self.u16(0xFFFF);
                return self.count_u32(n);
            }
        }
        Ok(())
    }

    /// Appends a plain u16 count.
    ///
    /// # Errors
    /// If `n` does not fit.
    pub fn count_u16(&mut self, n: usize) -> Result<()> {
        let n =
            u16::try_from(n).map_err(|_| Error::Unwritable(format!("{n} items where at most 65535 can be counted")))?;
        self.u16(n);
        Ok(())
    }

    /// Appends a plain u32 count.
    ///
    /// # Errors
    /// If `n` does not fit.
    pub fn count_u32(&mut self, n: usize) -> Result<()> {
        let n = u32::try_from(n).map_err(|_| Error::Unwritable(format!("{n} items where 32 bits count them")))?;
        self.u32(n);
        Ok(())
    }

    /// Appends a `CString`, its length in the form the text carries.
    ///
    /// # Errors
    /// If the form cannot hold the length.
    pub fn string(&mut self, text: &Text<'_>) -> Result<()> {
        let units = if text.is_wide() { text.len() / 2 } else { text.len() };
        if text.is_wide() {
            self.bytes(&[0xFF, 0xFE, 0xFF]);
        }
        match (text.length_form(), u8::try_from(units)) {
            (LengthForm::Shortest, Ok(short)) if short != 0xFF => self.u8(short),
            (LengthForm::Shortest, _) if units < 0xFFFE => {
                self.u8(0xFF);
                self.count_u16(units)?;
            }
            (LengthForm::Word, _) => {
                self.u8(0xFF);
                self.count_u16(units)?;
            }
            _ => {
                self.bytes(&[0xFF, 0xFF, 0xFF]);
                self.count_u32(units)?;
            }
        }
        self.bytes(text.as_bytes());
        Ok(())
    }

    /// Opens an object: writes its tag (introducing the class the first time) and
    /// returns its archive number. Write the body next.
    pub fn object(&mut self, class: &'static str) -> u32 {
        match self.classes.iter().find(|(name, _)| *name == class) {
            Some(&(_, number)) => match u16::try_from(number) {
                Ok(short) if short < BIG => self.u16(CLASS | short),
                _ => {
                    self.u16(BIG);
                    self.u32(BIG_CLASS | number);
                }
            },
            None => {
                self.u16(NEW_CLASS);
                self.u16(SCHEMA);
                // Class names are literals of this crate, far below 64 KiB.
                self.u16(u16::try_from(class.len()).unwrap_or(u16::MAX));
                self.bytes(class.as_bytes());
                let number = self.take_number();
                self.classes.push((class, number));
            }
        }
        self.take_number()
    }

    /// Writes a null object.
    pub fn null(&mut self) {
        self.u16(NULL);
    }

    /// Writes a reference to an object written before.
    pub fn reference(&mut self, number: u32) {
        match u16::try_from(number) {
            Ok(short) if short < BIG => self.u16(short),
            _ => {
                self.u16(BIG);
                self.u32(number);
            }
        }
    }

    fn take_number(&mut self) -> u32 {
        let number = self.next;
        // 2^32 objects would need more bytes than a payload can have.
        self.next = self.next.wrapping_add(1);
        number
    }
}
