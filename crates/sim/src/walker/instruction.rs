//! Instructions of the interpreter: operands in, one pure function, results out.

use instr::exec::control::Control;
use instr::exec::counter::{self, Counter};
use instr::exec::shift::Direction;
use instr::exec::stack::{Entry, Order};
use instr::exec::timer::{self, Time, Timer};
use instr::exec::{Lineage, Number, Outcome, Width, bit, compare, conversion, file, logic, math, scale, sequencer};
use instr::exec::{shift, stack};
use ladder::{Address, FileType, Operand};

use super::{Hidden, Leave, Walk, Walker};
use crate::status;

/// An instruction outside what the interpreter covers.
const NOT_COVERED: Leave = Leave::Fault(0x31);

impl Walker<'_> {
    pub(super) fn execute(&mut self, name: &str, operands: &[Operand], power: bool) -> Walk<bool> {
        let address = |index: usize| operands.get(index).and_then(Operand::address).ok_or(NOT_COVERED);
        match name {
            "XIC" => Ok(power && self.bit(address(0)?)?),
            "XIO" => Ok(power && !self.bit(address(0)?)?),
            "OTE" => self.put_bit(address(0)?, power).map(|()| power),
            "OTL" | "OTU" => {
                if power {
                    self.put_bit(address(0)?, name == "OTL")?;
                }
                Ok(power)
            }
            "OSR" | "ONS" | "OSF" => {
                let storage = address(0)?;
                let was = self.bit(storage)?;
                let shot = if name == "OSF" { bit::falling(power, was) } else { bit::rising(power, was) };
                self.put_bit(storage, shot.storage)?;
                if operands.len() == 1 {
                    return Ok(shot.pulse);
                }
                self.put_bit(address(1)?, shot.pulse).map(|()| power)
            }
            "TON" | "TOF" | "RTO" => self.timer(name, address(0)?, operands, power).map(|()| power),
            "CTU" | "CTD" => self.counter(name, address(0)?, power).map(|()| power),
            "EQU" | "NEQ" | "LES" | "LEQ" | "GRT" | "GEQ" | "LIM" | "MEQ" => {
                Ok(power && self.compares(name, operands)?)
            }
            "BSL" | "BSR" => self.shifts(name, operands, power).map(|()| power),
            "FFL" | "LFL" => self.loads(operands, power).map(|()| power),
            "FFU" | "LFU" => self.unloads(name, operands, power).map(|()| power),
            "SQO" | "SQC" | "SQL" => self.sequences(name, operands, power).map(|()| power),
            _ => {
                if power {
                    self.computes(name, operands)?;
                }
                Ok(power)
            }
        }
    }

    fn timer(&mut self, name: &str, address: &Address, operands: &[Operand], power: bool) -> Walk<()> {
        let base = match operands.get(1).map(Operand::to_string).as_deref() {
            Some("0.001") => 1_000_000,
            Some("1.0") => 1_000_000_000,
            _ => 10_000_000,
        };
        let key = (address.file.number().unwrap_or(0), address.element.number().unwrap_or(0));
        let hidden = self.timers.get(&key).copied().unwrap_or_default();
        let part = if hidden.executed { hidden.part } else { self.timers.get(&key).map_or(0, |hidden| hidden.part) };
        let mut element = Timer {
            control: *self.word_at(address, 0)?,
            preset: *self.word_at(address, 1)? as i16,
            accumulated: *self.word_at(address, 2)? as i16,
            part,
        };
        let elapsed = if hidden.executed { self.now - hidden.last } else { 0 };
        let time = Time { base, elapsed };
        let result = match name {
            "TON" => {
                if !hidden.executed {
                    element.control &= !timer::ENABLE;
                }
                timer::on_delay(power, element, time, self.rules)
            }
            "TOF" if !hidden.executed && !power && element.preset >= 0 => Ok(timer::off_delay_entering_run(element)),
            "TOF" => timer::off_delay(power, element, time, self.rules),
            _ => timer::retentive(power, element, time, self.rules),
        };
        let element = result.map_err(|_| Leave::Fault(0x34))?;
        *self.word_at(address, 0)? = element.control;
        *self.word_at(address, 2)? = element.accumulated as u16;
        self.timers.insert(key, Hidden { last: self.now, part: element.part, executed: true });
        Ok(())
    }

    fn counter(&mut self, name: &str, address: &Address, power: bool) -> Walk<()> {
        let element = Counter {
            control: *self.word_at(address, 0)?,
            preset: *self.word_at(address, 1)? as i16,
            accumulated: *self.word_at(address, 2)? as i16,
        };
        let step = if name == "CTU" { counter::up } else { counter::down };
        let element = step(power, element, self.rules);
        *self.word_at(address, 0)? = element.control;
        *self.word_at(address, 2)? = element.accumulated as u16;
        Ok(())
    }

    fn is_long(operands: &[Operand]) -> bool {
        operands.iter().filter_map(Operand::address).any(|address| Self::width(address) == Width::Long)
    }

    fn compares(&mut self, name: &str, operands: &[Operand]) -> Walk<bool> {
        let long = Self::is_long(operands);
        let value = |index: usize| self.operand(operands.get(index).ok_or(NOT_COVERED)?, long);
        let (a, b) = (value(0)?, value(1)?);
        Ok(match name {
            "EQU" => compare::equ(a, b),
            "NEQ" => compare::neq(a, b),
            "LES" => compare::les(a, b),
            "LEQ" => compare::leq(a, b),
            "GRT" => compare::grt(a, b),
            "GEQ" => compare::geq(a, b),
            "LIM" => compare::lim(a, b, value(2)?),
            _ => compare::meq(pattern(a), pattern(b), pattern(value(2)?)),
        })
    }

    fn leave(&mut self, address: &Address, outcome: Outcome) -> Walk<()> {
        let spot = self.spot(address)?;
        if let Some(value) = outcome.value {
            let mode = self.rules.math(self.status(status::CONTROL, |word| word));
            let value = logic::mov(value, Self::width(address), mode).value.unwrap_or(value);
            // The place was found before anything changed.
            let ((file_type, number, index), _) = spot;
            let halves = match value {
                Number::Word(value) => vec![value as u16],
                Number::Long(value) => vec![value as u16, (value >> 16) as u16],
                Number::Float(value) => vec![value.to_bits() as u16, (value.to_bits() >> 16) as u16],
            };
            for (offset, half) in halves.into_iter().enumerate() {
                if let Some(word) = self.files.get_mut(&(file_type, number)).and_then(|w| w.get_mut(index + offset)) {
                    *word = half;
                }
            }
        }
        if let Some(register) = outcome.register {
            self.status(status::MATH_LOW, |_| register.low);
            self.status(status::MATH_HIGH, |_| register.high);
        }
        self.status(status::FLAGS, |word| outcome.flags.store(word));
        let rules = self.rules;
        self.status(status::MINOR, |word| outcome.flags.trap(word, rules));
        Ok(())
    }

    fn computes(&mut self, name: &str, operands: &[Operand]) -> Walk<()> {
        let long = Self::is_long(operands);
        let mode = self.rules.math(self.status(status::CONTROL, |word| word));
        let last = operands.last().and_then(Operand::address);
        let to = last.map_or(Width::Word, Self::width);
        let value = |walker: &Self, index: usize| walker.operand(operands.get(index).ok_or(NOT_COVERED)?, long);
        match name {
            "RES" => return self.resets(last.ok_or(NOT_COVERED)?),
            "COP" | "FLL" => return self.moves_files(name, operands),
            _ => {}
        }
        let dest = last.ok_or(NOT_COVERED)?;
        let outcome = match name {
            "MOV" => logic::mov(value(self, 0)?, to, mode),
            "NOT" => logic::not(value(self, 0)?, to, mode),
            "NEG" => math::neg(value(self, 0)?, to, mode),
            "ABS" => math::abs(value(self, 0)?, to, mode),
            "SQR" => math::sqr(value(self, 0)?, to, mode),
            "CLR" => math::clr(to),
            "ADD" => math::add(value(self, 0)?, value(self, 1)?, to, mode),
            "SUB" => math::sub(value(self, 0)?, value(self, 1)?, to, mode),
            "MUL" => math::mul(value(self, 0)?, value(self, 1)?, to, mode),
            "DIV" => math::div(value(self, 0)?, value(self, 1)?, to, mode),
            "AND" => logic::and(value(self, 0)?, value(self, 1)?, to, mode),
            "OR" => logic::or(value(self, 0)?, value(self, 1)?, to, mode),
            "XOR" => logic::xor(value(self, 0)?, value(self, 1)?, to, mode),
            "MVM" => logic::mvm(value(self, 0)?, value(self, 1)?, value(self, 2)?, mode),
            "SCL" => scale::scl(value(self, 0)?, value(self, 1)?, value(self, 2)?, to, mode),
            "ENC" => conversion::enc(pattern(value(self, 0)?) as u16),
            "DCD" => {
                let bits = conversion::dcd(pattern(value(self, 0)?) as u16);
                return self.store(dest, Number::Word(bits as i16));
            }
            _ => return Err(NOT_COVERED),
        };
        self.leave(dest, outcome)
    }

    fn resets(&mut self, address: &Address) -> Walk<()> {
        let cleared = match address.file_type {
            FileType::T => 0xE000,
            FileType::C => 0xF800,
            _ => 0xFC00,
        };
        *self.word_at(address, 0)? &= !cleared;
        *self.word_at(address, 2)? = 0;
        if address.file_type == FileType::T {
            let key = (address.file.number().unwrap_or(0), address.element.number().unwrap_or(0));
            if let Some(hidden) = self.timers.get_mut(&key) {
                hidden.part = 0;
            }
        }
        Ok(())
    }

    fn index(&mut self, value: i32) {
        if matches!(self.rules.lineage, Lineage::S2 | Lineage::S3 | Lineage::M10) {
            self.status(status::INDEX, |_| value as u16);
        }
    }

    fn moves_files(&mut self, name: &str, operands: &[Operand]) -> Walk<()> {
        let [source, Operand::Address(dest), length] = operands else { return Err(NOT_COVERED) };
        let Number::Word(length) = self.operand(length, false)? else { return Err(NOT_COVERED) };
        let size = usize::from(dest.file_type.words_per_element().unwrap_or(1));
        let words: Vec<u16> = if name == "COP" {
            let source = source.address().ok_or(NOT_COVERED)?;
            let room = self.rest(dest)?.len();
            let count = file::extent(length, size, room);
            // Overlapping upward copies repeat: word by word.
            for offset in 0..count {
                let word = self.rest(source)?.get(offset).copied();
                // A source that ends goes on in the next file, which random programs never reach.
                let word = word.ok_or(NOT_COVERED)?;
                if let Some(place) = self.rest(dest)?.get_mut(offset) {
                    *place = word;
                }
            }
            self.index(count as i32);
            return Ok(());
        } else {
            let mode = self.rules.math(self.status(status::CONTROL, |word| word));
            let value = self.operand(source, Self::width(dest) == Width::Long)?;
            match logic::mov(value, Self::width(dest), mode).value.unwrap_or(value) {
                Number::Word(value) => vec![value as u16],
                Number::Long(value) => vec![value as u16, (value >> 16) as u16],
                Number::Float(value) => vec![value.to_bits() as u16, (value.to_bits() >> 16) as u16],
            }
        };
        let area = self.rest(dest)?;
        let count = file::extent(length, size, area.len());
        file::fill(area.get_mut(..count).unwrap_or_default(), &words);
        self.index(count as i32);
        Ok(())
    }

    fn control(&mut self, address: &Address) -> Walk<Control> {
        Ok(Control {
            status: *self.word_at(address, 0)?,
            length: *self.word_at(address, 1)? as i16,
            position: *self.word_at(address, 2)? as i16,
        })
    }

    fn put_control(&mut self, address: &Address, control: Control, error: bool) -> Walk<()> {
        *self.word_at(address, 0)? = control.status;
        *self.word_at(address, 1)? = control.length as u16;
        *self.word_at(address, 2)? = control.position as u16;
        self.status(status::MINOR, |word| if error { word | status::CONTROL_ERROR } else { word });
        Ok(())
    }

    fn shifts(&mut self, name: &str, operands: &[Operand], power: bool) -> Walk<()> {
        let [Operand::Address(array), Operand::Address(at), Operand::Address(source), ..] = operands else {
            return Err(NOT_COVERED);
        };
        let control = self.control(at)?;
        let works = power && !control.has(instr::exec::control::bit::ENABLE);
        let entering = works && self.bit(source)?;
        let direction = if name == "BSL" { Direction::Left } else { Direction::Right };
        let done = shift::shift(direction, power, control, entering, self.rest(array)?);
        let done = done.map_err(|_| Leave::Fault(0x33))?;
        self.put_control(at, done.control, done.control_error)?;
        if works {
            self.index(i32::from(control.length).max(0) / 16);
        }
        Ok(())
    }

    fn loads(&mut self, operands: &[Operand], power: bool) -> Walk<()> {
        let [source, Operand::Address(array), Operand::Address(at), ..] = operands else { return Err(NOT_COVERED) };
        let control = self.control(at)?;
        let value = if power { pattern(self.operand(source, false)?) } else { 0 };
        let done = stack::load(power, control, value, self.rest(array)?, Entry::Word);
        let done = done.map_err(|_| Leave::Fault(0x33))?;
        self.put_control(at, done.control, done.control_error)?;
        if power {
            self.index(control.position.into());
        }
        Ok(())
    }

    fn unloads(&mut self, name: &str, operands: &[Operand], power: bool) -> Walk<()> {
        let [Operand::Address(array), Operand::Address(dest), Operand::Address(at), ..] = operands else {
            return Err(NOT_COVERED);
        };
        let control = self.control(at)?;
        let order = if name == "FFU" { Order::FirstIn } else { Order::LastIn };
        let rules = self.rules;
        let result = stack::unload(order, power, control, self.rest(array)?, Entry::Word, rules);
        let (done, value) = result.map_err(|_| Leave::Fault(0x33))?;
        self.put_control(at, done.control, done.control_error)?;
        if power {
            self.index(done.control.position.into());
        }
        match value {
            Some(value) => self.store(dest, Number::Word(value as i16)),
            None => Ok(()),
        }
    }

    fn sequences(&mut self, name: &str, operands: &[Operand], power: bool) -> Walk<()> {
        let whole = |address: &&Address| address.file_type == FileType::R && address.word.is_none();
        let at = operands.iter().filter_map(Operand::address).find(whole);
        let at = at.ok_or(NOT_COVERED)?;
        let array = operands.first().and_then(Operand::address).ok_or(NOT_COVERED)?;
        let control = self.control(at)?;
        let first_pass = self.status(status::MODE, |word| word) & status::FIRST_PASS.1 != 0;
        let step = sequencer::advance(power, first_pass, control);
        self.put_control(at, step.control, step.control_error)?;
        let Some(number) = step.word else { return Ok(()) };
        self.index(step.control.position.into());
        let last = number.max(usize::from(step.control.length.unsigned_abs()));
        let words = self.rest(array)?;
        if last >= words.len() {
            return Err(Leave::Fault(0x32));
        }
        let word = words.get(number).copied().unwrap_or(0);
        let second = operands.get(1).ok_or(NOT_COVERED)?;
        if name == "SQL" {
            let value = pattern(self.operand(second, false)?) as u16;
            if let Some(place) = self.rest(array)?.get_mut(number) {
                *place = value;
            }
            return Ok(());
        }
        let mask = pattern(self.operand(second, false)?);
        let third = operands.get(2).ok_or(NOT_COVERED)?;
        let other = pattern(self.operand(third, false)?);
        if name == "SQC" {
            let control = sequencer::found(step.control, other & 0xFFFF, mask & 0xFFFF, word.into());
            return self.put_control(at, control, false);
        }
        let value = logic::masked(word.into(), mask, other);
        self.store(third.address().ok_or(NOT_COVERED)?, Number::Word(value as i16))
    }
}

/// The bits of a value, words sign-extended.
fn pattern(value: Number) -> u32 {
    match value {
        Number::Word(value) => value as u32,
        Number::Long(value) => value as u32,
        Number::Float(value) => value.round_ties_even() as i32 as u32,
    }
}
