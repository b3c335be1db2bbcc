//! Plain fields, counts and strings: each checked against what is left before it is taken.

use super::Reader;
use crate::archive::MAX_STRINGS;
use crate::error::{Error, Result};
use crate::text::{LengthForm, Text};

impl<'a> Reader<'a> {
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
    pub(super) fn too_many(&self, what: &'static str, limit: usize) -> Error {
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
}
