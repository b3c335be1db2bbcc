//! The control element: its status bits, and RES.

/// Bits of the first word of an R element (printed). The low byte is the error code.
pub mod bit {
    /// EN: the rung is true.
    pub const ENABLE: u16 = 1 << 15;
    /// EU: the rung of an unload is true; queued, for an ASCII port instruction.
    pub const ENABLE_UNLOAD: u16 = 1 << 14;
    /// DN: finished, full.
    pub const DONE: u16 = 1 << 13;
    /// EM: empty.
    pub const EMPTY: u16 = 1 << 12;
    /// ER: the length or position makes no sense.
    pub const ERROR: u16 = 1 << 11;
    /// UL: the bit a shift moved out.
    pub const UNLOAD: u16 = 1 << 10;
    /// IN: one mismatch at a time; running, for an ASCII port instruction.
    pub const INHIBIT: u16 = 1 << 9;
    /// FD: found.
    pub const FOUND: u16 = 1 << 8;
}

/// A control element as its three words.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Control {
    /// Status bits, see [`bit`].
    pub status: u16,
    /// LEN.
    pub length: i16,
    /// POS.
    pub position: i16,
}

impl Control {
    /// Every bit of the mask is set.
    #[inline]
    pub const fn has(self, mask: u16) -> bool {
        self.status & mask == mask
    }

    #[inline]
    pub(super) const fn put(&mut self, mask: u16, on: bool) {
        self.status = if on { self.status | mask } else { self.status & !mask };
    }

    /// RES: POS and the bits EN, EU, DN, EM, ER and UL become 0; IN, FD, LEN and the error code stay
    /// (manual, unseen; the error code: open).
    #[must_use]
    pub const fn reset(self) -> Control {
        use bit::{DONE, EMPTY, ENABLE, ENABLE_UNLOAD, ERROR, UNLOAD};
        let cleared = ENABLE | ENABLE_UNLOAD | DONE | EMPTY | ERROR | UNLOAD;
        Control { status: self.status & !cleared, length: self.length, position: 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_layout() {
        let control = Control { status: 0x8403, ..Control::default() };
        assert!(control.has(bit::ENABLE) && control.has(bit::UNLOAD) && !control.has(bit::DONE));
        assert_eq!(control.status & 0xFF, 3, "error code");
    }

    #[test]
    fn reset_keeps_what_is_set_up() {
        let control = Control { status: 0xFFFF, length: 10, position: 7 };
        assert_eq!(control.reset(), Control { status: 0x03FF, length: 10, position: 0 });
    }
}
