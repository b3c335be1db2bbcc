//! TON, TOF and RTO as steps from one execution to the next.
//!
//! A timer adds the ticks of its time base since its own last execution. The part of a tick that is
//! left over is no word of the element, so the caller keeps it and passes it in again (inferred). The
//! time before the execution in which timing starts does not count (inferred).

use super::choices::Choice;
use super::rules::Rules;

/// EN, bit 15 of the control word (printed).
pub const ENABLE: u16 = 1 << 15;
/// TT, bit 14.
pub const TIMING: u16 = 1 << 14;
/// DN, bit 13.
pub const DONE: u16 = 1 << 13;

/// The words of a timer element, and the part of a tick it has gathered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Timer {
    /// EN, TT, DN; the other bits are the controller's own and are kept.
    pub control: u16,
    /// PRE.
    pub preset: i16,
    /// ACC.
    pub accumulated: i16,
    /// Nanoseconds gathered towards the next tick.
    pub part: u64,
}

/// Time as a timer sees it, in nanoseconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Time {
    /// Length of a tick: 1 ms, 10 ms or 1 s. 0 counts as one.
    pub base: u64,
    /// Since the last execution of this timer.
    pub elapsed: u64,
}

/// A negative PRE or ACC: major error 0034, which a fault routine can clear (printed).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NegativeTimer;

/// Above this an accuracy is not promised; the 8-bit count of 10 ms that this suggests wraps here.
const WRAP: u64 = 2_560_000_000;

impl Timer {
    /// Every bit of the mask is set.
    #[inline]
    pub const fn has(self, mask: u16) -> bool {
        self.control & mask == mask
    }

    #[inline]
    const fn set(&mut self, enable: bool, timing: bool, done: bool) {
        self.control = self.control & !(ENABLE | TIMING | DONE)
            | if enable { ENABLE } else { 0 }
            | if timing { TIMING } else { 0 }
            | if done { DONE } else { 0 };
    }

    #[inline]
    const fn is_negative(self) -> bool {
        self.preset < 0 || self.accumulated < 0
    }

    /// Adds the elapsed ticks; `true` when ACC has reached PRE.
    ///
    /// ACC stops at PRE: printed for the MicroLogix 1100, open elsewhere ([`Choice::AccOvershoots`]).
    #[inline]
    fn count(&mut self, time: Time, rules: Rules) -> bool {
        let elapsed = if rules.has(Choice::TimerGapWraps) { time.elapsed % WRAP } else { time.elapsed };
        let gathered = self.part.saturating_add(elapsed);
        let base = time.base.max(1);
        let (ticks, part) = if gathered < base { (0, gathered) } else { (gathered / base, gathered % base) };
        let sum = i64::from(self.accumulated).saturating_add(i64::try_from(ticks).unwrap_or(i64::MAX));
        let highest = if rules.has(Choice::AccOvershoots) { i16::MAX } else { self.preset.max(self.accumulated) };
        self.accumulated = i16::try_from(sum).unwrap_or(i16::MAX).min(highest);
        let done = self.accumulated >= self.preset;
        self.part = if done { 0 } else { part };
        done
    }

    /// RES: ACC, EN, TT and DN become 0, PRE stays (printed; PRE: manual, unseen). On a TOF the manuals
    /// call the effect unpredictable; this is what it amounts to when the words are cleared.
    #[must_use]
    pub const fn reset(self) -> Timer {
        Timer { control: self.control & !(ENABLE | TIMING | DONE), accumulated: 0, part: 0, ..self }
    }
}

/// A true rung of TON and RTO, negative values excluded.
#[inline]
fn time_on(timer: &mut Timer, time: Time, rules: Rules) {
    let latched = timer.has(ENABLE | DONE) && !rules.has(Choice::DoneFollowsPreset);
    let done = latched
        || if timer.has(ENABLE) && timer.accumulated < timer.preset {
            timer.count(time, rules)
        } else {
            timer.accumulated >= timer.preset
        };
    timer.set(true, !done, done);
}

/// TON: times while the rung is true; a false rung clears ACC, EN, TT and DN (printed).
///
/// It starts from 0 in the execution that finds EN off (inferred). DN, once set, lasts until the rung
/// goes false: three printed tables say so, none describes raising PRE ([`Choice::DoneFollowsPreset`]).
///
/// # Errors
/// A negative PRE or ACC with a true rung, or with any ([`Choice::NegativeTimerAlways`]).
#[inline]
pub fn on_delay(rung: bool, mut timer: Timer, time: Time, rules: Rules) -> Result<Timer, NegativeTimer> {
    if timer.is_negative() && (rung || rules.has(Choice::NegativeTimerAlways)) {
        return Err(NegativeTimer);
    }
    if !rung {
        return Ok(timer.reset());
    }
    if !timer.has(ENABLE) {
        (timer.accumulated, timer.part) = (0, 0);
    }
    time_on(&mut timer, time, rules);
    Ok(timer)
}

/// RTO: times while the rung is true, keeps ACC and DN while it is false; only RES clears them
/// (printed).
///
/// The part of a tick is kept with ACC (open, [`Choice::RtoDropsPartTick`]). DN found set when the rung
/// becomes true again stays set: it lasts until RES (printed).
///
/// # Errors
/// As [`on_delay`].
#[inline]
pub fn retentive(rung: bool, mut timer: Timer, time: Time, rules: Rules) -> Result<Timer, NegativeTimer> {
    if timer.is_negative() && (rung || rules.has(Choice::NegativeTimerAlways)) {
        return Err(NegativeTimer);
    }
    if !rung {
        let done = timer.has(DONE);
        timer.set(false, false, done);
        if rules.has(Choice::RtoDropsPartTick) {
            timer.part = 0;
        }
    } else if timer.has(DONE) && !rules.has(Choice::DoneFollowsPreset) {
        timer.set(true, false, true);
    } else {
        time_on(&mut timer, time, rules);
    }
    Ok(timer)
}

/// TOF: a true rung sets EN and DN and clears ACC; a false rung times, and DN goes off when ACC
/// reaches PRE (printed).
///
/// A false rung times while DN is set (printed); without DN it stops, ACC as it is.
///
/// # Errors
/// A negative PRE or ACC when the rung is true or the timer is timing, or always
/// ([`Choice::NegativeTimerAlways`]).
#[inline]
pub fn off_delay(rung: bool, mut timer: Timer, time: Time, rules: Rules) -> Result<Timer, NegativeTimer> {
    let times = rung || timer.has(DONE);
    if timer.is_negative() && (times || rules.has(Choice::NegativeTimerAlways)) {
        return Err(NegativeTimer);
    }
    if rung {
        timer.set(true, false, true);
        (timer.accumulated, timer.part) = (0, 0);
    } else if timer.has(DONE) {
        let done = if timer.has(TIMING) && timer.accumulated < timer.preset {
            timer.count(time, rules)
        } else {
            timer.accumulated >= timer.preset
        };
        timer.set(false, !done, !done);
    } else {
        timer.set(false, false, false);
        timer.part = 0;
    }
    Ok(timer)
}

/// A TOF in the first scan after entering run with a false rung: an interrupted off-delay does not
/// resume, ACC = PRE, DN off (printed for SLC).
#[must_use]
pub const fn off_delay_entering_run(mut timer: Timer) -> Timer {
    timer.set(false, false, false);
    Timer { accumulated: timer.preset, part: 0, ..timer }
}

#[cfg(test)]
mod tests;
