//! What the timers do, as functions of values: one call is one processing of the box.
//!
//! Labels behind rules: *help* a help topic, *inferred*, *model choice* where nothing is written.

use crate::choices::{Choice, Choices};

/// The timer instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TimerKind {
    /// TMR: up while enabled, else reset. (help DMD0177)
    Tmr,
    /// TMRDOWN: down from the preset while enabled, else reset. (help DMD0180)
    TmrDown,
    /// TMRA: up while enabled, kept while not, reset by its second leg. (help DMD0178)
    Tmra,
    /// TMRADOWN: the same, down from the preset. (help DMD0179)
    TmraDown,
    /// TMRAG: TMRA without reset leg and without termination. (help DMD0095)
    Tmrag,
    /// ONDTMR: output ON after the delay. (help DMD0175)
    OnDelay,
    /// OFFDTMR: output OFF after the delay. (help DMD0174)
    OffDelay,
}

impl TimerKind {
    /// The kind of a mnemonic in capitals.
    pub fn from_mnemonic(mnemonic: &str) -> Option<TimerKind> {
        Some(match mnemonic {
            "TMR" => TimerKind::Tmr,
            "TMRDOWN" => TimerKind::TmrDown,
            "TMRA" => TimerKind::Tmra,
            "TMRADOWN" => TimerKind::TmraDown,
            "TMRAG" => TimerKind::Tmrag,
            "ONDTMR" => TimerKind::OnDelay,
            "OFFDTMR" => TimerKind::OffDelay,
            _ => return None,
        })
    }

    /// Whether .Acc goes down.
    pub fn counts_down(self) -> bool {
        matches!(self, TimerKind::TmrDown | TimerKind::TmraDown | TimerKind::OffDelay)
    }

    /// Whether it keeps .Acc while not enabled.
    pub fn accumulates(self) -> bool {
        matches!(self, TimerKind::Tmra | TimerKind::TmraDown | TimerKind::Tmrag)
    }

    /// What .Acc is reset to. (help for the up timers and TMRADOWN; OFFDTMR by RSTT is a model choice)
    pub fn reset_value(self, preset: i32) -> i32 {
        match self {
            TimerKind::TmrDown | TimerKind::TmraDown => preset,
            _ => 0,
        }
    }
}

/// A timer structure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Timer {
    /// .Acc in milliseconds.
    pub acc: i32,
    /// .Done
    pub done: bool,
    /// .Reset
    pub reset: bool,
    /// .Zero
    pub zero: bool,
    /// .Timing
    pub timing: bool,
    /// .EN: the enable leg. (inferred from the name)
    pub enabled: bool,
}

impl Timer {
    /// The structure from .Acc and its byte of flags.
    pub(crate) fn unpack(acc: i32, flags: u8) -> Timer {
        let flag = |bit: u8| flags >> bit & 1 != 0;
        Timer { acc, done: flag(0), reset: flag(1), zero: flag(2), timing: flag(3), enabled: flag(4) }
    }

    /// The byte of flags.
    pub(crate) fn flags(self) -> u8 {
        let bits = [self.done, self.reset, self.zero, self.timing, self.enabled];
        bits.iter().enumerate().fold(0, |byte, (bit, on)| byte | u8::from(*on) << bit)
    }

    /// Reset by leg, RSTT or termination.
    pub fn set_reset(&mut self, kind: TimerKind, preset: i32) {
        *self = Timer { acc: kind.reset_value(preset), reset: true, enabled: self.enabled, ..Timer::default() };
        self.zero = self.acc == 0;
    }
}

/// What a box sees when it is processed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimerInput {
    /// The first leg.
    pub enable: bool,
    /// The second leg, or an RSTT at work.
    pub reset: bool,
    /// It was not enabled when it was processed last.
    pub starts: bool,
    /// Preset or delay in milliseconds.
    pub preset: i32,
    /// Milliseconds since it was processed last; 0 if it starts.
    pub elapsed: i32,
}

/// Processes a timer; the value of the output bit of ONDTMR and OFFDTMR.
pub fn process(kind: TimerKind, timer: &mut Timer, input: TimerInput, choices: Choices) -> bool {
    let TimerInput { enable, reset, starts, preset, elapsed } = input;
    timer.enabled = enable;
    match kind {
        TimerKind::OffDelay => {
            if reset {
                timer.set_reset(kind, preset);
                return false;
            }
            if enable {
                // .Acc with the input ON is a model choice: what will remain when it drops.
                *timer = Timer { acc: preset.max(0), reset: true, enabled: true, ..Timer::default() };
                timer.zero = timer.acc == 0;
                return true;
            }
            timer.acc = timer.acc.saturating_sub(elapsed).max(0);
            timer.reset = false;
            timer.timing = timer.acc != 0;
            timer.zero = timer.acc == 0;
            // Done is not the output: it is ON when the time is over. (help DMD0174)
            timer.done = timer.acc == 0;
            timer.acc != 0
        }
        _ if reset || (!enable && !kind.accumulates()) => {
            timer.set_reset(kind, preset);
            false
        }
        _ if !enable => {
            // Flags are said to keep their values; .Timing is the open question.
            timer.timing &= choices.has(Choice::TimingKept);
            timer.reset = false;
            timer.zero = timer.acc == 0;
            false
        }
        _ => {
            timer.reset = false;
            if kind.counts_down() {
                // A TMRDOWN starts from its preset also where no disabled scan has loaded it.
                if starts && kind == TimerKind::TmrDown {
                    timer.acc = preset;
                }
                if timer.acc > 0 {
                    timer.acc = timer.acc.saturating_sub(elapsed).max(0);
                }
                timer.done = timer.acc <= 0;
                timer.timing = timer.acc > 0;
            } else {
                timer.acc = timer.acc.saturating_add(elapsed);
                timer.done = timer.acc >= preset;
                timer.timing = true;
            }
            timer.zero = timer.acc == 0;
            timer.done
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(kind: TimerKind, preset: i32, legs: &[(bool, bool)]) -> Vec<(i32, bool, bool, bool)> {
        let (mut timer, mut was) = (Timer::default(), false);
        let step = |(enable, reset): &(bool, bool)| {
            let active = *enable != (kind == TimerKind::OffDelay);
            let elapsed = if active && was { 10 } else { 0 };
            let input = TimerInput { enable: *enable, reset: *reset, starts: !was, preset, elapsed };
            was = active;
            let out = process(kind, &mut timer, input, Choices::default());
            (timer.acc, timer.done, timer.timing, out)
        };
        legs.iter().map(step).collect()
    }

    const ON: (bool, bool) = (true, false);
    const OFF: (bool, bool) = (false, false);

    #[test]
    fn tmr_runs_up_past_its_preset_and_resets_when_disabled() {
        let seen = run(TimerKind::Tmr, 20, &[ON, ON, ON, ON, OFF, ON]);
        let acc: Vec<_> = seen.iter().map(|row| (row.0, row.1, row.2)).collect();
        assert_eq!(
            acc,
            [
                (0, false, true),
                (10, false, true),
                (20, true, true),
                (30, true, true),
                (0, false, false),
                (0, false, true)
            ]
        );
    }

    #[test]
    fn accumulating_timers_keep_and_reset() {
        let seen = run(TimerKind::Tmra, 20, &[ON, ON, OFF, ON, ON, OFF, (true, true), (false, true)]);
        assert_eq!(seen.iter().map(|row| row.0).collect::<Vec<_>>(), [0, 10, 10, 10, 20, 20, 0, 0]);
        assert!(seen[5].1, "done is kept while disabled");
        let down = run(TimerKind::TmraDown, 20, &[(false, true), ON, ON, OFF, ON, ON]);
        assert_eq!(down.iter().map(|row| row.0).collect::<Vec<_>>(), [20, 20, 10, 10, 10, 0]);
        assert!(down[5].1 && !down[5].2);
    }

    #[test]
    fn off_delay_is_on_at_once_and_off_after_the_delay() {
        let seen = run(TimerKind::OffDelay, 20, &[OFF, ON, OFF, OFF, ON, OFF, OFF, OFF, OFF]);
        let out: Vec<_> = seen.iter().map(|row| row.3).collect();
        assert_eq!(out, [false, true, true, true, true, true, true, false, false]);
        assert_eq!((seen[7].0, seen[7].1), (0, true));
    }

    #[test]
    fn limits_do_not_wrap() {
        let mut timer = Timer { acc: i32::MAX - 1, ..Timer::default() };
        let input = TimerInput { enable: true, reset: false, starts: false, preset: 5, elapsed: i32::MAX };
        process(TimerKind::Tmr, &mut timer, input, Choices::default());
        assert_eq!(timer.acc, i32::MAX);
        let mut down = Timer { acc: i32::MIN, ..Timer::default() };
        process(TimerKind::TmrDown, &mut down, TimerInput { preset: i32::MIN, ..input }, Choices::default());
        assert!(down.done);
    }
}
