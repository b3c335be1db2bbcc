//! Immediate I/O, clocks, high-speed counters, pulse outputs.

use ladder::FileType;

use instr::exec::{Number, clock, process};

use super::{Core, Exec};
use crate::fault::code;
use crate::op::*;
use crate::status;

/// Nanoseconds per tick of the high-speed clock.
const CLOCK_TICK: u64 = 10_000;

/// Words of an HSC function file element, as its members are known.
const HSC_ACC: u32 = 5;
const HSC_HIGH: u32 = 7;
const HSC_LOW: u32 = 9;

impl Core<'_> {
    /// IIM: terminals of a slot into the image now, where the mask is 1.
    pub(crate) fn immediate_input(&mut self, first: u32, words: u32, mask: Source) -> Exec<()> {
        let mask = self.word_of(mask)? as u16;
        let forced = self.forced();
        let (start, _) = self.p.inputs;
        for at in first..first + words {
            let index = (at as usize).wrapping_sub(start);
            let Some(&terminal) = self.s.inputs.get(index) else { continue };
            let (on, off) = self.s.input_forces.get(index).copied().unwrap_or((0, 0xFFFF));
            let value = if forced { (terminal | on) & off } else { terminal };
            let word = self.word(at);
            self.put(at, word & !mask | value & mask);
        }
        Ok(())
    }

    /// IOM: image of a slot to its terminals now, where the mask is 1.
    pub(crate) fn immediate_output(&mut self, first: u32, words: u32, mask: Source) -> Exec<()> {
        let mask = self.word_of(mask)? as u16;
        if self.s.mode != crate::Mode::Run {
            return Ok(());
        }
        let forced = self.forced();
        let (start, _) = self.p.outputs;
        for at in first..first + words {
            let index = (at as usize).wrapping_sub(start);
            let word = self.word(at);
            let (on, off) = self.s.output_forces.get(index).copied().unwrap_or((0, 0xFFFF));
            let value = if forced { (word | on) & off } else { word };
            if let Some(terminal) = self.s.outputs.get_mut(index) {
                *terminal = *terminal & !mask | value & mask;
            }
        }
        Ok(())
    }

    /// IID, IIE, RPI: a mask of slots 1 to 15 over S:27 (enables) or S:25 (pending).
    pub(crate) fn event_interrupts(&mut self, change: MaskChange, slots: Source) -> Exec<()> {
        let slots = self.word_of(slots)? as u16;
        const ENABLES: usize = 27;
        const PENDING: usize = 25;
        match change {
            MaskChange::Disable => self.set_status(ENABLES, self.status(ENABLES) & !slots),
            MaskChange::Enable => self.set_status(ENABLES, self.status(ENABLES) | slots),
            MaskChange::Flush => self.set_status(PENDING, self.status(PENDING) & !slots),
        }
        Ok(())
    }

    /// PID on its block; the control variable is read for manual mode and written.
    pub(crate) fn pid(
        &mut self,
        at: Start,
        process: Source,
        (control, present): (Target, Source),
        slot: u32,
        power: bool,
    ) -> Exec<()> {
        let (first, end) = self.start(at)?;
        let (process, present) = match power {
            true => (self.word_of(process)?, self.word_of(present)?),
            false => (0, 0),
        };
        let now = self.s.now;
        let rules = self.p.rules;
        let state = &mut *self.s;
        let Some(memory) = state.pids.get_mut(slot as usize) else { return Ok(()) };
        let inputs = process::Inputs { process, control: present, elapsed: now.saturating_sub(memory.last) };
        memory.last = now;
        let block = state.mem.get_mut(first as usize..end as usize).unwrap_or_default();
        let answer = process::pid(power, block, inputs, &mut memory.memory, rules);
        match answer.map_err(|_| code::PID)? {
            Some(value) => self.store(control, Number::Word(value)),
            None => Ok(()),
        }
    }

    /// RHC: the free running clock, from the start of the simulation.
    pub(crate) fn clock_read(&mut self, dest: Target) -> Exec<()> {
        let value = clock::rhc(self.s.now / CLOCK_TICK, self.kind(dest));
        self.store(dest, value)
    }

    pub(crate) fn clock_difference(&mut self, start: Source, stop: Source, dest: Target) -> Exec<()> {
        let (start, stop) = (self.load(start)?, self.load(stop)?);
        let mode = self.p.rules.math(self.status(status::CONTROL));
        let value = clock::tdf(start, stop, self.kind(dest), mode);
        self.store(dest, value)
    }

    /// RTA: RTC:0 to the nearest minute when the rung becomes true.
    pub(crate) fn clock_adjust(&mut self, slot: u32, power: bool) {
        let Some(edge) = self.s.adjusts.get_mut(slot as usize) else { return };
        let rising = power && !*edge;
        *edge = power;
        let layout = &self.p.layout;
        let info = layout.file(FileType::RTC, 0).and_then(|file| layout.files.get(file));
        let Some(at) = info.map(|info| info.start).filter(|_| rising) else { return };
        let seconds = u64::from(self.word(at + 5));
        self.put(at + 5, 0);
        self.s.second_part = 0;
        if seconds >= 30 {
            self.move_clock(at, at + 6, 60);
        }
    }

    fn high_speed_file(&self, counter: u16) -> Option<u32> {
        let layout = &self.p.layout;
        let info = layout.file(FileType::HSC, 0).and_then(|file| layout.files.get(file))?;
        (u32::from(counter) < info.elements).then(|| info.start + u32::from(counter) * info.size)
    }

    /// HSL: presets into the function file. Its output patterns have no published place there.
    pub(crate) fn high_speed_load(&mut self, counter: u16, values: &[Source; 4]) -> Exec<()> {
        let Some(at) = self.high_speed_file(counter) else { return Ok(()) };
        for (source, word) in values.iter().zip([HSC_HIGH, HSC_LOW]) {
            let value = self.integer(*source)?;
            self.put_long(at + word, value as u32);
        }
        Ok(())
    }

    /// RAC: the accumulator takes the source at once.
    pub(crate) fn high_speed_reset(&mut self, counter: u16, source: Source) -> Exec<()> {
        let value = self.integer(source)?;
        if let Some(at) = self.high_speed_file(counter) {
            self.put_long(at + HSC_ACC, value as u32);
        }
        Ok(())
    }

    /// HSC of fixed controllers and MicroLogix 1000: the flags follow ACC; pulses come from outside.
    pub(crate) fn high_speed_counter(&mut self, at: u32, power: bool) {
        use instr::exec::counter::{DONE, UP};
        let counter = self.counter_at(at);
        self.put_bits(at, UP, power);
        self.put_bits(at, DONE, power && counter.accumulated >= counter.preset);
    }

    /// The index register after a file instruction, which uses it as its own pointer.
    pub(crate) fn leave_index(&mut self, value: i32) {
        if self.p.traits.indexes() {
            self.set_status(status::INDEX, value as u16);
        }
    }
}
