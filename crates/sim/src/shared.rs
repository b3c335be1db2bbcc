//! What machines of every dialect share: taking a saved state apart, and simulated time.

use std::fmt;
use std::time::Duration;

/// Why bytes are no state of a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestoreError {
    /// They do not begin as a saved state, or end early or late.
    NotAState,
    /// The state was saved from another program or under other options.
    OtherProgram,
}

impl fmt::Display for RestoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            RestoreError::NotAState => "not a saved machine state, or a damaged one",
            RestoreError::OtherProgram => "the state was saved from another program or with other options",
        })
    }
}

impl std::error::Error for RestoreError {}

/// Takes a saved state apart: numbers in little-endian order, one behind the other.
#[derive(Clone, Copy, Debug)]
pub struct Reader<'a> {
    bytes: &'a [u8],
}

impl<'a> Reader<'a> {
    /// A reader behind the head of a state: eight characters that tell its form, and the identity of its program.
    ///
    /// # Errors
    /// The form is another one, or the program.
    pub fn new(bytes: &'a [u8], form: [u8; 8], program: u64) -> Result<Reader<'a>, RestoreError> {
        let mut reader = Reader { bytes };
        if reader.take()? != form {
            return Err(RestoreError::NotAState);
        }
        if reader.long()? != program {
            return Err(RestoreError::OtherProgram);
        }
        Ok(reader)
    }

    /// The next bytes.
    ///
    /// # Errors
    /// There are fewer.
    pub fn take<const N: usize>(&mut self) -> Result<[u8; N], RestoreError> {
        let (taken, rest) = self.bytes.split_first_chunk::<N>().ok_or(RestoreError::NotAState)?;
        self.bytes = rest;
        Ok(*taken)
    }

    /// The next byte.
    ///
    /// # Errors
    /// As [`Reader::take`].
    pub fn byte(&mut self) -> Result<u8, RestoreError> {
        self.take::<1>().map(|[byte]| byte)
    }

    /// The next 16 bits.
    ///
    /// # Errors
    /// As [`Reader::take`].
    pub fn word(&mut self) -> Result<u16, RestoreError> {
        self.take().map(u16::from_le_bytes)
    }

    /// The next 64 bits.
    ///
    /// # Errors
    /// As [`Reader::take`].
    pub fn long(&mut self) -> Result<u64, RestoreError> {
        self.take().map(u64::from_le_bytes)
    }

    /// The next byte, 0 or 1.
    ///
    /// # Errors
    /// It is another one, or there is none.
    pub fn flag(&mut self) -> Result<bool, RestoreError> {
        match self.byte()? {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(RestoreError::NotAState),
        }
    }

    /// Nothing may be left.
    ///
    /// # Errors
    /// Something is.
    pub fn end(self) -> Result<(), RestoreError> {
        if self.bytes.is_empty() { Ok(()) } else { Err(RestoreError::NotAState) }
    }
}

/// Time in nanoseconds, at most what the clock of a machine holds.
pub fn nanoseconds(time: Duration) -> u64 {
    u64::try_from(time.as_nanos()).unwrap_or(u64::MAX / 4)
}

/// Times between scans of length `step` until `time` has passed, the last one shorter if it does not fit. None for a
/// step of no length.
pub fn steps(time: Duration, step: Duration) -> impl Iterator<Item = Duration> {
    let mut left = time;
    std::iter::from_fn(move || {
        let dt = left.min(step);
        left -= dt;
        (!dt.is_zero()).then_some(dt)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_step_is_what_is_left() {
        let ms = Duration::from_millis;
        assert_eq!(steps(ms(25), ms(10)).collect::<Vec<_>>(), [ms(10), ms(10), ms(5)]);
        assert_eq!(steps(ms(25), ms(0)).count() + steps(ms(0), ms(10)).count(), 0);
    }

    #[test]
    fn a_head_of_another_form_or_program_is_told() {
        let mut bytes = b"SOMEFORM".to_vec();
        bytes.extend(7u64.to_le_bytes());
        bytes.extend([1, 2]);
        assert!(matches!(Reader::new(&bytes, *b"OTHERFOR", 7), Err(RestoreError::NotAState)));
        assert!(matches!(Reader::new(&bytes, *b"SOMEFORM", 8), Err(RestoreError::OtherProgram)));
        let mut reader = Reader::new(&bytes, *b"SOMEFORM", 7).expect("a head");
        assert_eq!((reader.flag(), reader.end()), (Ok(true), Err(RestoreError::NotAState)));
        assert_eq!((reader.flag(), reader.byte()), (Err(RestoreError::NotAState), Err(RestoreError::NotAState)));
        assert_eq!(reader.end(), Ok(()));
    }
}
