//! Arithmetic flags S:0/0 to S:0/3 and the overflow trap S:5/0.

use std::ops::BitOr;

use super::Number;
use super::choices::Choice;
use super::rules::{Lineage, Rules};

/// Carry, overflow, zero and sign, in the bit order of S:0 (printed in the SLC manual, appendix B).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Flags(u8);

impl Flags {
    /// No flag.
    pub const NONE: Flags = Flags(0);
    /// C, S:0/0: carry or borrow, as in unsigned arithmetic.
    pub const CARRY: Flags = Flags(1);
    /// V, S:0/1: the result does not fit the destination.
    pub const OVERFLOW: Flags = Flags(2);
    /// Z, S:0/2: the result is zero.
    pub const ZERO: Flags = Flags(4);
    /// S, S:0/3: the result is negative, its most significant bit is 1.
    pub const SIGN: Flags = Flags(8);

    /// The flags that are asked for.
    #[inline]
    pub const fn new(carry: bool, overflow: bool, zero: bool, sign: bool) -> Flags {
        Flags(carry as u8 | (overflow as u8) << 1 | (zero as u8) << 2 | (sign as u8) << 3)
    }

    /// Z and S of a stored value; C and V as given.
    #[inline]
    pub fn of(value: Number, carry: bool, overflow: bool) -> Flags {
        Flags::new(carry, overflow, value.is_zero(), value.is_negative())
    }

    /// Z and S of a stored word; C and V as given.
    #[inline]
    pub const fn of_word(value: i16, carry: bool, overflow: bool) -> Flags {
        Flags::new(carry, overflow, value == 0, value < 0)
    }

    /// Every flag of `other` is set.
    #[inline]
    pub const fn has(self, other: Flags) -> bool {
        self.0 & other.0 == other.0
    }

    /// The bits of S:0.
    pub const fn bits(self) -> u16 {
        self.0 as u16
    }

    /// The four flags in a status word S:0.
    pub const fn from_bits(s0: u16) -> Flags {
        Flags((s0 & 0xF) as u8)
    }

    /// S:0 after an instruction with these flags: its other bits stay.
    #[inline]
    pub const fn store(self, s0: u16) -> u16 {
        s0 & !0xF | self.0 as u16
    }

    /// S:5 after an instruction with these flags.
    ///
    /// Overflow sets bit 0. A later good result leaves it set: the fault comes when the bit is still
    /// set at the end of the scan, and a program clears it with OTU (printed). One MicroLogix 1400
    /// page can be read as rewriting it each time: [`Choice::TrapFollowsOverflow`].
    #[inline]
    pub const fn trap(self, s5: u16, rules: Rules) -> u16 {
        if self.has(Flags::OVERFLOW) {
            s5 | 1
        } else if rules.has(Choice::TrapFollowsOverflow) && matches!(rules.lineage, Lineage::Mx) {
            s5 & !1
        } else {
            s5
        }
    }
}

impl BitOr for Flags {
    type Output = Flags;

    fn bitor(self, other: Flags) -> Flags {
        Flags(self.0 | other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_keep_the_rest_of_the_status_word() {
        assert_eq!((Flags::CARRY | Flags::SIGN).store(0xFFF6), 0xFFF9);
        assert_eq!(Flags::from_bits(0xFFF9), Flags::CARRY | Flags::SIGN);
        assert_eq!(Flags::new(true, true, true, true).bits(), 0xF);
    }

    #[test]
    fn the_trap_is_latched_unless_read_otherwise() {
        let rules = Rules::new(Lineage::Mx);
        assert_eq!(Flags::OVERFLOW.trap(0x8004, rules), 0x8005);
        assert_eq!(Flags::ZERO.trap(0x8005, rules), 0x8005);
        let rewriting = rules.with(Choice::TrapFollowsOverflow);
        assert_eq!(Flags::ZERO.trap(0x8005, rewriting), 0x8004);
        let slc = Rules::new(Lineage::S3).with(Choice::TrapFollowsOverflow);
        assert_eq!(Flags::ZERO.trap(0x8005, slc), 0x8005, "the latch is printed for SLC");
    }
}
