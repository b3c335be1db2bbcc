//! XIC, XIO, OTE, OTL, OTU and the one-shots.

/// What a one-shot leaves behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shot {
    /// The state handed on (ONS, one-operand OSR) or written to the output bit (OSR, OSF of two).
    pub pulse: bool,
    /// For the storage bit.
    pub storage: bool,
}

/// One-operand OSR and ONS: true once when the rung before it becomes true. The storage bit remembers
/// the rung (community).
#[inline]
pub const fn one_shot(rung: bool, storage: bool) -> Shot {
    Shot { pulse: rung && !storage, storage: rung }
}

/// Two-operand OSR: the output bit is 1 in the scan in which the rung becomes true (community). The
/// rule is that of ONS; the pulse is written instead of handed on.
#[inline]
pub const fn rising(rung: bool, storage: bool) -> Shot {
    one_shot(rung, storage)
}

/// OSF: the output bit is 1 in the scan in which the rung becomes false (community).
#[inline]
pub const fn falling(rung: bool, storage: bool) -> Shot {
    Shot { pulse: !rung && storage, storage: rung }
}

/// OTL: what the bit becomes. A false rung leaves it (printed).
#[inline]
pub const fn latch(rung: bool, bit: bool) -> bool {
    bit || rung
}

/// OTU: what the bit becomes. A false rung leaves it (printed).
#[inline]
pub const fn unlatch(rung: bool, bit: bool) -> bool {
    bit && !rung
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(shot: fn(bool, bool) -> Shot, rungs: [u8; 5]) -> ([u8; 5], [u8; 5]) {
        let (mut storage, mut pulses, mut stored) = (false, [0; 5], [0; 5]);
        for (scan, rung) in rungs.into_iter().enumerate() {
            let result = shot(rung == 1, storage);
            storage = result.storage;
            (pulses[scan], stored[scan]) = (result.pulse.into(), storage.into());
        }
        (pulses, stored)
    }

    #[test]
    fn pulses() {
        assert_eq!(run(one_shot, [0, 1, 1, 0, 1]), ([0, 1, 0, 0, 1], [0, 1, 1, 0, 1]));
        assert_eq!(run(rising, [0, 1, 1, 0, 1]), ([0, 1, 0, 0, 1], [0, 1, 1, 0, 1]));
        assert_eq!(run(falling, [0, 1, 1, 0, 0]), ([0, 0, 0, 1, 0], [0, 1, 1, 0, 0]));
    }

    #[test]
    fn latches() {
        let mut bit = false;
        let mut seen = [false; 3];
        for (scan, (set, clear)) in [(true, false), (false, false), (false, true)].into_iter().enumerate() {
            bit = unlatch(clear, latch(set, bit));
            seen[scan] = bit;
        }
        assert_eq!(seen, [true, true, false]);
    }
}
