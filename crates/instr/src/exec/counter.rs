//! CTU, CTD and RES on a counter, and what a high-speed counter does at its limits.

use super::choices::Choice;
use super::rules::Rules;

/// CU, bit 15 of the control word (printed): the state of the CTU rung.
pub const UP: u16 = 1 << 15;
/// CD, bit 14: the state of the CTD rung.
pub const DOWN: u16 = 1 << 14;
/// DN, bit 13: ACC is at or above PRE.
pub const DONE: u16 = 1 << 13;
/// OV, bit 12: counted up over 32767.
pub const OVERFLOW: u16 = 1 << 12;
/// UN, bit 11: counted down under -32768.
pub const UNDERFLOW: u16 = 1 << 11;
/// UA, bit 10: update accumulator, for the high-speed counter only.
pub const UPDATE: u16 = 1 << 10;

/// The words of a counter element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counter {
    /// CU, CD, DN, OV, UN; the other bits are kept.
    pub control: u16,
    /// PRE.
    pub preset: i16,
    /// ACC.
    pub accumulated: i16,
}

impl Counter {
    /// Every bit of the mask is set.
    #[inline]
    pub const fn has(self, mask: u16) -> bool {
        self.control & mask == mask
    }

    #[inline]
    const fn put(&mut self, mask: u16, on: bool) {
        self.control = if on { self.control | mask } else { self.control & !mask };
    }

    /// A wrap: sets its own flag, or takes the opposite one back.
    ///
    /// On SLC counting back over the wrap clears the flag it had set (printed for OV; UN: manual,
    /// unseen); the MicroLogix 1100 table names RES alone ([`Choice::CountBackClearsOnMx`]). Whether
    /// the own flag is set as well is open ([`Choice::CountBackSetsOpposite`]).
    const fn wrapped(&mut self, own: u16, opposite: u16, rules: Rules) {
        let takes_back = rules.lineage.is_slc_like() || rules.has(Choice::CountBackClearsOnMx);
        if takes_back && self.has(opposite) {
            self.put(opposite, false);
            if !rules.has(Choice::CountBackSetsOpposite) {
                return;
            }
        }
        self.put(own, true);
    }

    /// RES: ACC and the bits CU, CD, DN, OV and UN become 0 (printed), PRE and UA stay. With a negative
    /// PRE the next CTU or CTD sets DN again.
    #[must_use]
    pub const fn reset(self) -> Counter {
        Counter { control: self.control & !(UP | DOWN | DONE | OVERFLOW | UNDERFLOW), accumulated: 0, ..self }
    }

    /// Entering run sets CU (of a CTU) and CD (of a CTD), so that a rung that is true in the first scan
    /// does not count (printed for CU; CD: manual, unseen).
    #[must_use]
    pub const fn entering_run(self, mask: u16) -> Counter {
        Counter { control: self.control | mask & (UP | DOWN), ..self }
    }
}

/// CTU: counts up when the rung becomes true, the previous state being CU; past 32767 to -32768 with
/// OV. DN = ACC ≥ PRE, worked out at every execution (printed; the false ones: inferred). The flags of
/// S:0 are not touched (community).
#[inline]
pub const fn up(rung: bool, mut counter: Counter, rules: Rules) -> Counter {
    if rung && !counter.has(UP) {
        let (next, wrapped) = counter.accumulated.overflowing_add(1);
        counter.accumulated = next;
        if wrapped {
            counter.wrapped(OVERFLOW, UNDERFLOW, rules);
        }
    }
    counter.put(UP, rung);
    counter.put(DONE, counter.accumulated >= counter.preset);
    counter
}

/// CTD: counts down when the rung becomes true, the previous state being CD; past -32768 to 32767 with
/// UN. DN = ACC ≥ PRE, as for CTU (printed).
#[inline]
pub const fn down(rung: bool, mut counter: Counter, rules: Rules) -> Counter {
    if rung && !counter.has(DOWN) {
        let (next, wrapped) = counter.accumulated.overflowing_sub(1);
        counter.accumulated = next;
        if wrapped {
            counter.wrapped(UNDERFLOW, OVERFLOW, rules);
        }
    }
    counter.put(DOWN, rung);
    counter.put(DONE, counter.accumulated >= counter.preset);
    counter
}

/// What a pulse does to a high-speed counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pulse {
    /// ACC afterwards.
    pub accumulated: i32,
    /// It was counted past OVF or UNF: the interrupt of that side is due.
    pub rolled_over: bool,
}

/// A pulse up on a counter of a MicroLogix 1100 to 1500: past OVF it goes on at UNF (printed).
pub const fn pulse_up(accumulated: i32, overflow: i32, underflow: i32) -> Pulse {
    if accumulated >= overflow {
        Pulse { accumulated: underflow, rolled_over: true }
    } else {
        Pulse { accumulated: accumulated.saturating_add(1), rolled_over: false }
    }
}

/// A pulse down: past UNF it goes on at OVF (printed).
pub const fn pulse_down(accumulated: i32, overflow: i32, underflow: i32) -> Pulse {
    if accumulated <= underflow {
        Pulse { accumulated: overflow, rolled_over: true }
    } else {
        Pulse { accumulated: accumulated.saturating_sub(1), rolled_over: false }
    }
}

/// The limits and presets a high-speed counter accepts: OVF above HIP, UNF not above LOP (printed).
pub const fn limits_are_valid(overflow: i32, underflow: i32, high_preset: i32, low_preset: i32) -> bool {
    overflow > high_preset && underflow <= low_preset
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::exec::Lineage;

    fn slc() -> Rules {
        Rules::new(Lineage::S3)
    }

    fn counter(preset: i16, accumulated: i16, control: u16) -> Counter {
        Counter { control, preset, accumulated }
    }

    /// One false, one true execution.
    fn edge(step: fn(bool, Counter, Rules) -> Counter, counter: Counter, rules: Rules) -> Counter {
        step(true, step(false, counter, rules), rules)
    }

    #[test]
    fn counts_edges_past_the_preset() {
        let mut c = counter(3, 0, 0);
        for _ in 0..3 {
            c = edge(up, c, slc());
        }
        assert_eq!((c.accumulated, c.control), (3, UP | DONE));
        for _ in 0..10 {
            c = up(true, c, slc());
        }
        assert_eq!(c.accumulated, 3);
        c = edge(up, c, slc());
        assert_eq!((c.accumulated, c.control), (4, UP | DONE));
        assert_eq!(up(false, c, slc()).control, DONE);
    }

    #[test]
    fn entering_run_does_not_count() {
        let c = counter(10, 5, 0).entering_run(UP);
        assert_eq!((up(true, c, slc()).accumulated, c.control), (5, UP));
        assert_eq!(down(true, counter(10, 5, 0).entering_run(DOWN), slc()).accumulated, 5);
        assert_eq!(counter(10, 5, 0).entering_run(0xFFFF).control, UP | DOWN);
    }

    #[test]
    fn wraps_up_and_back() {
        let over = edge(up, counter(100, 32767, DONE), slc());
        assert_eq!((over.accumulated, over.control), (-32768, UP | OVERFLOW));
        let back = edge(down, over, slc());
        assert_eq!((back.accumulated, back.control), (32767, UP | DOWN | DONE));
        let both = edge(down, over, slc().with(Choice::CountBackSetsOpposite));
        assert_eq!(both.control, UP | DOWN | DONE | UNDERFLOW);
    }

    #[test]
    fn wraps_down_and_back() {
        let under = edge(down, counter(10, -32768, 0), slc());
        assert_eq!((under.accumulated, under.control), (32767, DOWN | UNDERFLOW | DONE));
        let back = edge(up, under, slc());
        assert_eq!((back.accumulated, back.control), (-32768, UP | DOWN));
        let mx = Rules::new(Lineage::Mx);
        let kept = edge(up, under, mx);
        assert_eq!(kept.control, UP | DOWN | UNDERFLOW | OVERFLOW, "RES alone clears there");
        let cleared = edge(up, under, mx.with(Choice::CountBackClearsOnMx));
        assert_eq!(cleared.control, UP | DOWN);
    }

    #[test]
    fn counts_down_with_the_done_rule_of_counting_up() {
        let c = edge(down, counter(10, 10, DONE), slc());
        assert_eq!((c.accumulated, c.control), (9, DOWN));
        let both = edge(up, c, slc());
        assert_eq!((both.accumulated, both.control), (10, UP | DOWN | DONE));
    }

    #[test]
    fn reset_and_layout() {
        let c = counter(50, 57, UP | DOWN | DONE | OVERFLOW | UNDERFLOW | UPDATE | 5).reset();
        assert_eq!(c, counter(50, 0, UPDATE | 5));
        assert_eq!(up(true, c, slc()).accumulated, 1, "the lost CU lets a true rung count");
        assert!(up(false, counter(-5, 0, 0), slc()).has(DONE));
        let printed = counter(0, 0, 0xB000);
        assert!(printed.has(UP | DONE | OVERFLOW) && !printed.has(DOWN) && !printed.has(UNDERFLOW));
    }

    #[test]
    fn fast_counters_roll_over() {
        assert_eq!(pulse_up(1000, 1000, -1000), Pulse { accumulated: -1000, rolled_over: true });
        assert_eq!(pulse_down(-1000, 1000, -1000), Pulse { accumulated: 1000, rolled_over: true });
        assert_eq!(pulse_up(999, 1000, -1000), Pulse { accumulated: 1000, rolled_over: false });
        assert_eq!(pulse_up(i32::MAX, i32::MAX, 0).accumulated, 0);
        assert!(!limits_are_valid(400, -1000, 500, 0));
        assert!(limits_are_valid(1000, -1000, 500, -1000));
        assert!(!limits_are_valid(1000, 1, 500, 0));
    }

    proptest! {
        #[test]
        fn up_and_down_cancel(control: u16, preset: i16, accumulated: i16) {
            let c = counter(preset, accumulated, control);
            let back = edge(down, edge(up, c, slc()), slc());
            prop_assert_eq!(back.accumulated, accumulated);
            prop_assert_eq!(back.has(DONE), accumulated >= preset);
        }
    }
}
