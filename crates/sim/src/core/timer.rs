//! Timers, counters and RES.

use ladder::{FileType, TimeBase};

use super::{Core, Exec};
use crate::choices::Choice;
use crate::fault::code;
use crate::op::{Start, TimerKind};

const ENABLED: u16 = 0x8000;
const TIMING: u16 = 0x4000;
const DONE: u16 = 0x2000;
const UP: u16 = 0x8000;
const DOWN: u16 = 0x4000;
const OVERFLOWN: u16 = 0x1000;
const UNDERFLOWN: u16 = 0x0800;

/// Longest gap that an eight-bit count of 10 ms tells apart.
const GAP: u64 = 2_560_000_000;

impl Core<'_> {
    /// One execution of a timer. `slot` is what the element has beside its words.
    pub(crate) fn timer(&mut self, kind: TimerKind, base: TimeBase, at: u32, slot: u32, power: bool) -> Exec<()> {
        let tick = u64::from(base.milliseconds()) * 1_000_000;
        let choices = self.p.choices;
        let now = self.s.now;
        let Some(&before) = self.s.timers.get(slot as usize) else { return Ok(()) };
        let mut hidden = before;
        let mut control = self.word(at);
        let (pre, mut acc) = (self.word(at + 1) as i16, self.word(at + 2) as i16);
        let active = power || (kind == TimerKind::Off && control & DONE != 0 && !hidden.fresh);
        if (pre < 0 || acc < 0) && (active || choices.has(Choice::NegativeTimerAlways)) {
            return Err(code::TIMER);
        }
        let mut elapsed = now - hidden.last.min(now);
        if choices.has(Choice::TimerGapWraps) {
            elapsed %= GAP;
        }
        hidden.last = now;
        hidden.fresh = false;
        // Counts the time since the last execution and says whether ACC has reached PRE.
        let mut count = |acc: &mut i16, part: &mut u64| {
            let gathered = elapsed + *part;
            *part = gathered % tick;
            let ticks = i16::try_from(gathered / tick).unwrap_or(i16::MAX);
            let sum = acc.saturating_add(ticks);
            // A PRE below ACC never lowers ACC.
            *acc = if choices.has(Choice::AccOvershoots) { sum } else { sum.min(pre.max(*acc)) };
            *acc >= pre
        };
        match kind {
            TimerKind::On if !power => {
                control &= !(ENABLED | TIMING | DONE);
                acc = 0;
                hidden.part = 0;
            }
            TimerKind::On => {
                let starts = before.fresh || control & ENABLED == 0;
                if before.fresh {
                    acc = 0;
                }
                if starts {
                    hidden.part = 0;
                    control &= !DONE;
                }
                let latched = control & DONE != 0 && !choices.has(Choice::DoneFollowsPreset);
                let done = latched || if starts { acc >= pre } else { count(&mut acc, &mut hidden.part) };
                control = with(control | ENABLED, done);
            }
            TimerKind::Off if power => {
                control = control & !TIMING | ENABLED | DONE;
                acc = 0;
                hidden.part = 0;
            }
            TimerKind::Off => {
                control &= !ENABLED;
                if before.fresh {
                    // An interrupted off-delay does not resume.
                    control &= !(TIMING | DONE);
                    acc = pre;
                } else if control & DONE != 0 {
                    let starts = control & TIMING == 0;
                    if starts {
                        hidden.part = 0;
                    }
                    let over = if starts { acc >= pre } else { count(&mut acc, &mut hidden.part) };
                    control = if over { control & !(TIMING | DONE) } else { control | TIMING };
                } else {
                    control &= !TIMING;
                }
            }
            TimerKind::Retentive if !power => {
                control &= !(ENABLED | TIMING);
                if choices.has(Choice::RtoDropsPartTick) {
                    hidden.part = 0;
                }
            }
            TimerKind::Retentive => {
                let starts = before.fresh || control & ENABLED == 0;
                let latched = control & DONE != 0 && !choices.has(Choice::DoneFollowsPreset);
                let done = latched || if starts { acc >= pre } else { count(&mut acc, &mut hidden.part) };
                control = with(control | ENABLED, done);
            }
        }
        self.put(at, control);
        self.put(at + 2, acc as u16);
        if let Some(place) = self.s.timers.get_mut(slot as usize) {
            *place = hidden;
        }
        Ok(())
    }

    /// One execution of CTU or CTD.
    pub(crate) fn counter(&mut self, down: bool, at: u32, power: bool) {
        let mut control = self.word(at);
        let (pre, mut acc) = (self.word(at + 1) as i16, self.word(at + 2) as i16);
        let edge = if down { DOWN } else { UP };
        if power && control & edge == 0 {
            let (wraps_at, own, other, step) =
                if down { (i16::MIN, UNDERFLOWN, OVERFLOWN, -1) } else { (i16::MAX, OVERFLOWN, UNDERFLOWN, 1) };
            if acc == wraps_at {
                let counts_back = !self.p.traits.mx() || self.p.choices.has(Choice::CountBackClearsOnMx);
                let back = counts_back && control & other != 0;
                if back {
                    control &= !other;
                }
                if !back || self.p.choices.has(Choice::CountBackSetsOpposite) {
                    control |= own;
                }
            }
            acc = acc.wrapping_add(step);
        }
        control = if power { control | edge } else { control & !edge };
        control = if acc >= pre { control | DONE } else { control & !DONE };
        self.put(at, control);
        self.put(at + 2, acc as u16);
    }

    /// RES with a true rung.
    pub(crate) fn reset(&mut self, start: Start, file_type: FileType) -> Exec<()> {
        let (at, _) = self.start(start)?;
        // IN and FD of a control element stay, and so do the hidden bits of a timer.
        let cleared = match file_type {
            FileType::T => ENABLED | TIMING | DONE,
            FileType::C => UP | DOWN | DONE | OVERFLOWN | UNDERFLOWN,
            _ => 0xFC00,
        };
        self.put_bits(at, cleared, false);
        self.put(at + 2, 0);
        if file_type == FileType::T
            && let Some(slot) = self.p.timer_slot(at)
            && let Some(hidden) = self.s.timers.get_mut(slot as usize)
        {
            hidden.part = 0;
        }
        Ok(())
    }
}

fn with(control: u16, done: bool) -> u16 {
    if done { control & !TIMING | DONE } else { control & !DONE | TIMING }
}
