//! Copy, fill, shift, stack and sequencer instructions over the block of words.

use instr::exec::control::Control;
use instr::exec::diagnostic::{self, Controls};
use instr::exec::sequencer::{self, Step};
use instr::exec::shift::{self, Direction};
use instr::exec::stack::{self, Entry, Order};
use instr::exec::{Number, Width, conversion, file, logic};

use super::{Core, Exec};
use crate::choices::Choice;
use crate::fault::code;
use crate::op::*;
use crate::status;

impl Core<'_> {
    /// The words from a place to the end of its file.
    fn area(&mut self, from: u32, end: u32) -> &mut [u16] {
        let (from, end) = (from as usize, end as usize);
        self.s.mem.get_mut(from..end.max(from)).unwrap_or_default()
    }

    fn control_error(&mut self, error: bool) {
        if error {
            let minor = self.status(status::MINOR);
            self.set_minor(minor, minor | status::CONTROL_ERROR);
        }
    }

    /// Words that `length` elements of a destination take. Past its file SLC stops; MicroLogix checks
    /// when the program is made, so only an indirect address gets there, which is a fault.
    fn extent(&mut self, dest: Start, at: u32, end: u32, length: Source) -> Exec<usize> {
        let length = self.integer(length)?;
        let length = i16::try_from(length).unwrap_or(if length < 0 { 0 } else { i16::MAX });
        let room = end.saturating_sub(at) as usize;
        let wanted = file::extent(length, dest.size as usize, usize::MAX);
        if wanted > room && self.p.traits.mx() && matches!(dest.at, StartAt::At(_)) {
            return Err(code::OUTSIDE_DATA);
        }
        Ok(wanted.min(room))
    }

    pub(crate) fn copy(&mut self, source: Start, dest: Start, length: Source, words: bool) -> Exec<()> {
        let (from, _) = self.start(source)?;
        let (to, end) = self.start(dest)?;
        let unit = if words { Start { size: 1, ..dest } } else { dest };
        let count = self.extent(unit, to, end, length)?;
        let copied = file::copy(&mut self.s.mem, from as usize, to as usize, count);
        let (from_long, to_long) = (source.kind != Width::Word, dest.kind != Width::Word);
        if self.p.choices.has(Choice::HighWordFirst) && from_long != to_long {
            let moved = self.s.mem.get_mut(to as usize..to as usize + copied).unwrap_or_default();
            moved.chunks_exact_mut(2).for_each(|pair| pair.swap(0, 1));
        }
        self.leave_index(copied as i32);
        Ok(())
    }

    pub(crate) fn fill(&mut self, source: Source, dest: Start, length: Source) -> Exec<()> {
        let value = self.load(source)?;
        let (to, end) = self.start(dest)?;
        let count = self.extent(dest, to, end, length)?;
        let mode = self.p.rules.math(self.status(status::CONTROL));
        let stored = logic::mov(value, dest.kind, mode).value.unwrap_or(value);
        let (words, size) = match stored {
            Number::Word(value) => ([value as u16, 0], 1),
            Number::Long(value) => ([value as u16, (value >> 16) as u16], 2),
            Number::Float(value) => ([value.to_bits() as u16, (value.to_bits() >> 16) as u16], 2),
        };
        let area = self.s.mem.get_mut(to as usize..to as usize + count).unwrap_or_default();
        file::fill(area, words.get(..size).unwrap_or_default());
        self.leave_index(count as i32);
        Ok(())
    }

    pub(crate) fn fill_element(&mut self, source: Start, dest: Start, length: Source) -> Exec<()> {
        let (from, _) = self.start(source)?;
        let (to, end) = self.start(dest)?;
        let count = self.extent(dest, to, end, length)?;
        for offset in 0..count as u32 {
            let word = self.word(from + offset % source.size.max(1));
            self.put(to + offset, word);
        }
        self.leave_index(count as i32);
        Ok(())
    }

    pub(crate) fn swap_bytes(&mut self, at: Start, length: Source) -> Exec<()> {
        let length = self.integer(length)?;
        let (from, end) = self.start(at)?;
        let area = self.area(from, end);
        let count = usize::try_from(length).unwrap_or(0).min(area.len());
        conversion::swp(area.get_mut(..count).unwrap_or_default());
        Ok(())
    }

    pub(crate) fn shift(&mut self, left: bool, file: Start, control: Start, bit: BitAt, power: bool) -> Exec<()> {
        let (at, _) = self.start(control)?;
        let control = self.control_at(at);
        if !power || control.has(instr::exec::control::bit::ENABLE) {
            // Nothing but the control bits changes: no operand is looked at.
            let direction = Direction::Left;
            let done = shift::shift(direction, power, control, false, &mut []).map_err(|_| code::SHIFT)?;
            self.put_control(at, done.control);
            return Ok(());
        }
        let entering = self.read_bit(bit)?;
        let (from, end) = self.start(file)?;
        let direction = if left { Direction::Left } else { Direction::Right };
        let done = shift::shift(direction, power, control, entering, self.area(from, end)).map_err(|_| code::SHIFT)?;
        self.put_control(at, done.control);
        self.control_error(done.control_error);
        self.leave_index(i32::from(control.length).max(0) / 16);
        Ok(())
    }

    pub(crate) fn stack_load(
        &mut self,
        source: Source,
        file: Start,
        control: Start,
        long: bool,
        power: bool,
    ) -> Exec<()> {
        let (at, _) = self.start(control)?;
        let control = self.control_at(at);
        let value = if power { self.integer(source)? as u32 } else { 0 };
        let (from, end) = if power { self.start(file)? } else { (0, 0) };
        let entry = if long { Entry::Long } else { Entry::Word };
        let done = stack::load(power, control, value, self.area(from, end), entry).map_err(|_| code::SHIFT)?;
        self.put_control(at, done.control);
        self.control_error(done.control_error);
        if power {
            self.leave_index(i32::from(control.position));
        }
        Ok(())
    }

    pub(crate) fn stack_unload(
        &mut self,
        order: Order,
        file: Start,
        dest: Target,
        control: Start,
        long: bool,
        power: bool,
    ) -> Exec<()> {
        let (at, _) = self.start(control)?;
        let control = self.control_at(at);
        let (from, end) = if power { self.start(file)? } else { (0, 0) };
        let entry = if long { Entry::Long } else { Entry::Word };
        let rules = self.p.rules;
        let unloaded = stack::unload(order, power, control, self.area(from, end), entry, rules);
        let (done, value) = unloaded.map_err(|_| code::SHIFT)?;
        self.put_control(at, done.control);
        self.control_error(done.control_error);
        if power {
            self.leave_index(i32::from(done.control.position));
        }
        if let Some(value) = value {
            let number = if long { Number::Long(value as i32) } else { Number::Word(value as i16) };
            let mode = rules.math(self.status(status::CONTROL));
            let stored = logic::mov(number, self.kind(dest), mode).value.unwrap_or(number);
            self.store(dest, stored)?;
        }
        Ok(())
    }

    /// Moves a sequencer on and finds its word; the control element is stored.
    fn step(&mut self, file: Start, at: u32, power: bool) -> Exec<(Step, Option<u32>)> {
        let control = self.control_at(at);
        let step = sequencer::advance(power, self.status_bit(status::FIRST_PASS), control);
        self.put_control(at, step.control);
        self.control_error(step.control_error);
        let Some(number) = step.word else { return Ok((step, None)) };
        self.leave_index(i32::from(step.control.position));
        let (from, end) = self.start(file)?;
        let last = number.max(usize::from(step.control.length.unsigned_abs())) as u32;
        if from + last * file.size >= end {
            return Err(code::SEQUENCER);
        }
        Ok((step, Some(number as u32)))
    }

    /// First word of the entry of a file at a step.
    fn entry_at(&mut self, file: Start, number: u32) -> Exec<u32> {
        let (from, end) = self.start(file)?;
        let at = from + number * file.size;
        if at < end { Ok(at) } else { Err(code::SEQUENCER) }
    }

    fn entry(&mut self, file: Start, number: u32) -> Exec<u32> {
        let at = self.entry_at(file, number)?;
        Ok(if file.kind == Width::Word { u32::from(self.word(at)) } else { self.long(at) })
    }

    fn put_entry(&mut self, file: Start, number: u32, value: u32) -> Exec<()> {
        let at = self.entry_at(file, number)?;
        if file.kind == Width::Word {
            self.put(at, value as u16)
        } else {
            self.put_long(at, value)
        }
        Ok(())
    }

    fn stepped(&mut self, operand: Stepped, number: u32) -> Exec<u32> {
        match operand {
            Stepped::Value(source) => self.integer(source).map(|value| value as u32),
            Stepped::File(file) => self.entry(file, number),
        }
    }

    pub(crate) fn sequencer_output(
        &mut self,
        file: Start,
        mask: Stepped,
        dest: SteppedTarget,
        control: Start,
        power: bool,
    ) -> Exec<()> {
        let (at, _) = self.start(control)?;
        let (_, Some(number)) = self.step(file, at, power)? else { return Ok(()) };
        let (value, mask) = (self.entry(file, number)?, self.stepped(mask, number)?);
        match dest {
            SteppedTarget::File(dest) => {
                let old = self.entry(dest, number)?;
                self.put_entry(dest, number, logic::masked(value, mask, old))
            }
            SteppedTarget::Value(dest) => {
                let old = match self.present(dest)? {
                    Number::Word(old) => old as u32,
                    Number::Long(old) => old as u32,
                    Number::Float(old) => old as i32 as u32,
                };
                let value = logic::masked(value, mask, old);
                let stored = match self.kind(dest) {
                    Width::Word => Number::Word(value as i16),
                    Width::Long => Number::Long(value as i32),
                    Width::Float => Number::Float(value as i32 as f32),
                };
                self.store(dest, stored)
            }
        }
    }

    pub(crate) fn sequencer_compare(
        &mut self,
        file: Start,
        mask: Stepped,
        source: Stepped,
        control: Start,
        power: bool,
    ) -> Exec<()> {
        let (at, _) = self.start(control)?;
        let (step, Some(number)) = self.step(file, at, power)? else { return Ok(()) };
        let (word, mask) = (self.entry(file, number)?, self.stepped(mask, number)?);
        let source = self.stepped(source, number)?;
        let narrow = if file.kind == Width::Word { 0xFFFF } else { u32::MAX };
        let control: Control = sequencer::found(step.control, source & narrow, mask & narrow, word);
        self.put_control(at, control);
        Ok(())
    }

    pub(crate) fn sequencer_load(&mut self, file: Start, source: Stepped, control: Start, power: bool) -> Exec<()> {
        let (at, _) = self.start(control)?;
        let (_, Some(number)) = self.step(file, at, power)? else { return Ok(()) };
        let value = self.stepped(source, number)?;
        self.put_entry(file, number, value)
    }

    /// FBC and DDT. The three files can overlap, so the function works on copies in a buffer kept for it.
    pub(crate) fn file_bits(
        &mut self,
        detect: bool,
        [source, reference, result]: [Start; 3],
        [compare, control]: [Start; 2],
        power: bool,
    ) -> Exec<()> {
        let (compare_at, _) = self.start(compare)?;
        let (result_at, _) = self.start(control)?;
        let controls = Controls { compare: self.control_at(compare_at), result: self.control_at(result_at) };
        let mut buffer = std::mem::take(&mut self.s.scratch);
        buffer.clear();
        let mut places = [(0u32, 0usize); 3];
        if power {
            for (place, start) in places.iter_mut().zip([source, reference, result]) {
                let (from, end) = self.start(start)?;
                let words = self.s.mem.get(from as usize..end as usize).unwrap_or_default();
                buffer.extend_from_slice(words);
                *place = (from, words.len());
            }
        }
        let (first, rest) = buffer.split_at_mut(places[0].1);
        let (second, third) = rest.split_at_mut(places[1].1);
        let detected = diagnostic::detect(power, detect, controls, first, second, third);
        let store = [(places[1].0, &*second), (places[2].0, &*third)];
        for (from, words) in store {
            if let Some(area) = self.s.mem.get_mut(from as usize..from as usize + words.len()) {
                area.copy_from_slice(words);
            }
        }
        buffer.clear();
        self.s.scratch = buffer;
        let detected = detected.map_err(|_| code::SHIFT)?;
        self.put_control(compare_at, detected.controls.compare);
        self.put_control(result_at, detected.controls.result);
        self.control_error(detected.control_error);
        Ok(())
    }
}
