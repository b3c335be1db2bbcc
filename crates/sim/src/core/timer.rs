//! Timers, counters and RES: elements out of the data table, the rules of `instr`, elements back.

use instr::exec::control::Control;
use instr::exec::counter::{self, Counter};
use instr::exec::timer::{self, Time, Timer};
use ladder::{FileType, TimeBase};

use super::{Core, Exec};
use crate::fault::code;
use crate::op::{Start, TimerKind};
use crate::state::TimerSlot;

impl Core<'_> {
    /// One execution of a timer. `slot` is what the element has beside its words.
    #[inline]
    pub(crate) fn timer(&mut self, kind: TimerKind, base: TimeBase, at: u32, slot: u32, power: bool) -> Exec<()> {
        let now = self.s.now;
        let Some(&hidden) = self.s.timers.get(slot as usize) else { return Ok(()) };
        let mut element = Timer {
            control: self.word(at),
            preset: self.word(at + 1) as i16,
            accumulated: self.word(at + 2) as i16,
            part: hidden.part,
        };
        // Time before the first execution in run does not count.
        let elapsed = if hidden.fresh { 0 } else { now - hidden.last.min(now) };
        let time = Time { base: u64::from(base.milliseconds()) * 1_000_000, elapsed };
        let rules = self.p.rules;
        let result = match kind {
            TimerKind::On => {
                if hidden.fresh {
                    // A TON stopped in mid-timing starts again from 0.
                    element.control &= !timer::ENABLE;
                }
                timer::on_delay(power, element, time, rules)
            }
            TimerKind::Off if hidden.fresh && !power && element.preset >= 0 => {
                Ok(timer::off_delay_entering_run(element))
            }
            TimerKind::Off => timer::off_delay(power, element, time, rules),
            TimerKind::Retentive => timer::retentive(power, element, time, rules),
        };
        let element = result.map_err(|_| code::TIMER)?;
        self.put(at, element.control);
        self.put(at + 2, element.accumulated as u16);
        if let Some(place) = self.s.timers.get_mut(slot as usize) {
            *place = TimerSlot { last: now, part: element.part, fresh: false };
        }
        Ok(())
    }

    /// One execution of CTU or CTD.
    #[inline]
    pub(crate) fn counter(&mut self, down: bool, at: u32, power: bool) {
        let element = self.counter_at(at);
        let step = if down { counter::down } else { counter::up };
        let element = step(power, element, self.p.rules);
        self.put(at, element.control);
        self.put(at + 2, element.accumulated as u16);
    }

    pub(crate) fn counter_at(&self, at: u32) -> Counter {
        Counter { control: self.word(at), preset: self.word(at + 1) as i16, accumulated: self.word(at + 2) as i16 }
    }

    pub(crate) fn control_at(&self, at: u32) -> Control {
        Control { status: self.word(at), length: self.word(at + 1) as i16, position: self.word(at + 2) as i16 }
    }

    pub(crate) fn put_control(&mut self, at: u32, control: Control) {
        self.put(at, control.status);
        self.put(at + 1, control.length as u16);
        self.put(at + 2, control.position as u16);
    }

    /// RES with a true rung.
    pub(crate) fn reset(&mut self, start: Start, file_type: FileType) -> Exec<()> {
        let (at, _) = self.start(start)?;
        match file_type {
            FileType::T => {
                let cleared = timer::ENABLE | timer::TIMING | timer::DONE;
                self.put_bits(at, cleared, false);
                self.put(at + 2, 0);
                if let Some(slot) = self.p.timer_slot(at)
                    && let Some(hidden) = self.s.timers.get_mut(slot as usize)
                {
                    hidden.part = 0;
                }
            }
            FileType::C => {
                let element = self.counter_at(at).reset();
                self.put(at, element.control);
                self.put(at + 2, element.accumulated as u16);
            }
            _ => {
                let control = self.control_at(at).reset();
                self.put_control(at, control);
            }
        }
        Ok(())
    }
}
