//! Execution: the flat list over the state.

mod block;
mod device;
pub(crate) mod discrete;
pub(crate) mod fast;
mod files;
mod interrupt;
mod math;
mod message;
mod operand;
mod run;
mod scan;
mod text;
mod timer;

use crate::op::Compiled;
use crate::peer::Peer;
use crate::state::State;
use crate::status;

/// A program, its state and its surroundings for the time of one call.
pub(crate) struct Core<'a> {
    pub(crate) p: &'a Compiled,
    pub(crate) s: &'a mut State,
    pub(crate) peer: &'a mut dyn Peer,
}

/// Result of something that can end in a major fault of this code.
pub(crate) type Exec<T> = Result<T, u16>;

pub(crate) use run::{NoWatch, Watch};

impl Core<'_> {
    #[inline(always)]
    pub(crate) fn word(&self, at: u32) -> u16 {
        self.s.mem.get(at as usize).copied().unwrap_or(0)
    }

    #[inline(always)]
    pub(crate) fn put(&mut self, at: u32, value: u16) {
        if let Some(word) = self.s.mem.get_mut(at as usize) {
            *word = value;
        }
    }

    #[inline(always)]
    pub(crate) fn put_bits(&mut self, at: u32, mask: u16, on: bool) {
        if let Some(word) = self.s.mem.get_mut(at as usize) {
            *word = if on { *word | mask } else { *word & !mask };
        }
    }

    /// A word of the status file.
    #[inline]
    pub(crate) fn status(&self, word: usize) -> u16 {
        self.s.mem.get(self.p.layout.status + word).copied().unwrap_or(0)
    }

    #[inline]
    pub(crate) fn set_status(&mut self, word: usize, value: u16) {
        if let Some(place) = self.s.mem.get_mut(self.p.layout.status + word) {
            *place = value;
        }
    }

    #[inline]
    pub(crate) fn status_bit(&self, bit: status::Bit) -> bool {
        self.status(bit.0) & bit.1 != 0
    }

    #[inline]
    pub(crate) fn set_status_bit(&mut self, bit: status::Bit, on: bool) {
        let word = self.status(bit.0);
        self.set_status(bit.0, if on { word | bit.1 } else { word & !bit.1 });
    }
}
