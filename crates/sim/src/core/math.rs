//! Arithmetic, conversions, moves: operands in, the pure functions of `instr`, results out.

use instr::exec::function::apply;
use instr::exec::scale::Line;
use instr::exec::{Flags, MathMode, Number, Outcome, Register, Width};
use instr::exec::{conversion, expression, function, logic, math, scale};

use super::{Core, Exec};
use crate::op::*;
use crate::status;

impl Core<'_> {
    fn mode(&self) -> MathMode {
        self.p.rules.math(self.status(status::CONTROL))
    }

    fn register(&self) -> Register {
        Register { low: self.status(status::MATH_LOW), high: self.status(status::MATH_HIGH) }
    }

    fn set_register(&mut self, register: Register) {
        self.set_status(status::MATH_LOW, register.low);
        self.set_status(status::MATH_HIGH, register.high);
    }

    /// Stores what an instruction leaves behind: value, register, flags. The destination is resolved
    /// before anything changes, so that a fault leaves no half of a result.
    pub(crate) fn leave(&mut self, dest: Target, outcome: Outcome) -> Exec<()> {
        let dest = self.fixed(dest)?;
        if let Some(mut value) = outcome.value {
            let kind = self.kind(dest);
            if value.width() != kind {
                // Conversions answer with words whatever the destination is.
                value = logic::mov(value, kind, self.mode()).value.unwrap_or(value);
            }
            self.store(dest, value)?;
        }
        if let Some(register) = outcome.register {
            self.set_register(register);
        }
        self.flags(outcome.flags);
        Ok(())
    }

    pub(crate) fn flags(&mut self, flags: Flags) {
        let word = self.status(status::FLAGS);
        self.set_status(status::FLAGS, flags.store(word));
        let minor = self.status(status::MINOR);
        self.set_minor(minor, flags.trap(minor, self.p.rules));
    }

    /// Stores S:5 as a box leaves it.
    pub(super) fn set_minor(&mut self, before: u16, after: u16) {
        if before & status::MINOR_FATAL == 0 && after & status::MINOR_FATAL != 0 {
            self.s.minor_by = Some(self.s.acting);
        }
        self.set_status(status::MINOR, after);
    }

    /// A destination decided at run time as a fixed one.
    fn fixed(&mut self, dest: Target) -> Exec<Target> {
        let Target::At(reference) = dest else { return Ok(dest) };
        let (at, _) = self.resolve(reference)?;
        Ok(match self.kind(dest) {
            Width::Word => Target::Word(at),
            Width::Long => Target::Long(at),
            Width::Float => Target::Float(at),
        })
    }

    pub(crate) fn unary(&mut self, op: Unary, source: Source, dest: Target) -> Exec<()> {
        let value = self.load(source)?;
        let to = self.kind(dest);
        let mode = self.mode();
        let outcome = match op {
            Unary::Move => logic::mov(value, to, mode),
            Unary::Not => logic::not(value, to, mode),
            Unary::Negate => math::neg(value, to, mode),
            Unary::Absolute => math::abs(value, to, mode),
            Unary::SquareRoot => math::sqr(value, to, mode),
            Unary::Decode => return self.decode(value, dest),
            Unary::Encode => conversion::enc(low_word(value)),
            Unary::GrayCode => conversion::gcd(low_word(value)),
            Unary::Function(function) => apply(function, value, to, mode),
        };
        self.leave(dest, outcome)
    }

    fn decode(&mut self, value: Number, dest: Target) -> Exec<()> {
        let dest = self.fixed(dest)?;
        let bits = conversion::dcd(low_word(value));
        let value = match self.kind(dest) {
            Width::Word => Number::Word(bits as i16),
            Width::Long => Number::Long(i32::from(bits)),
            Width::Float => Number::Float(f32::from(bits)),
        };
        self.store(dest, value)
    }

    pub(crate) fn binary(&mut self, op: Binary, a: Source, b: Source, dest: Target) -> Exec<()> {
        let (a, b) = (self.load(a)?, self.load(b)?);
        let to = self.kind(dest);
        let mode = self.mode();
        let function = match op {
            Binary::Add => math::add,
            Binary::Subtract => math::sub,
            Binary::Multiply => math::mul,
            Binary::Divide => math::div,
            Binary::Power => function::xpy,
            Binary::And => logic::and,
            Binary::Or => logic::or,
            Binary::Xor => logic::xor,
        };
        self.leave(dest, function(a, b, to, mode))
    }

    pub(crate) fn clear(&mut self, dest: Target) -> Exec<()> {
        let outcome = math::clr(self.kind(dest));
        self.leave(dest, outcome)
    }

    pub(crate) fn masked_move(&mut self, source: Source, mask: Source, dest: Target) -> Exec<()> {
        let (source, mask) = (self.load(source)?, self.load(mask)?);
        let present = self.present(dest)?;
        let outcome = logic::mvm(source, mask, present, self.mode());
        self.leave(dest, outcome)
    }

    /// TOD; into S:13 the whole register is the destination.
    pub(crate) fn encode_bcd(&mut self, source: Source, dest: Target, register: bool) -> Exec<()> {
        let value = self.word_of(source)?;
        let outcome = conversion::tod(value);
        if register {
            let dest = Outcome { value: None, ..outcome };
            if let Some(register) = dest.register {
                self.set_register(register);
            }
            self.flags(dest.flags);
            return Ok(());
        }
        self.leave(dest, outcome)
    }

    pub(crate) fn decode_bcd(&mut self, source: Source, dest: Target, register: bool) -> Exec<()> {
        let to = self.kind(dest);
        let outcome = if register {
            conversion::frd_register(self.register(), to, self.mode())
        } else {
            let value = self.word_of(source)?;
            conversion::frd(value as u16, to, self.mode())
        };
        self.leave(dest, outcome)
    }

    pub(crate) fn double_divide(&mut self, source: Source, dest: Target) -> Exec<()> {
        let source = self.word_of(source)?;
        let outcome = math::ddv(self.register(), source, self.mode());
        self.leave(dest, outcome)
    }

    /// The low 16 bits of an operand.
    pub(crate) fn word_of(&mut self, source: Source) -> Exec<i16> {
        Ok(self.integer(source)? as i16)
    }

    pub(crate) fn scale(&mut self, [source, rate, offset]: [Source; 3], dest: Target) -> Exec<()> {
        let (source, rate, offset) = (self.load(source)?, self.load(rate)?, self.load(offset)?);
        let outcome = scale::scl(source, rate, offset, self.kind(dest), self.mode());
        self.leave(dest, outcome)
    }

    pub(crate) fn scale_parameters(&mut self, input: [Source; 5], dest: Target) -> Exec<()> {
        let mut values = [Number::Word(0); 5];
        for (value, source) in values.iter_mut().zip(input) {
            *value = self.load(source)?;
        }
        let [input, input_min, input_max, scaled_min, scaled_max] = values;
        let line = Line { input_min, input_max, scaled_min, scaled_max };
        let outcome = scale::scp(input, line, self.kind(dest), self.mode());
        self.leave(dest, outcome)
    }
}

impl Core<'_> {
    /// CPT. Operands decided at run time are resolved first, so that a fault comes before any effect.
    pub(crate) fn compute(&mut self, steps: &[expression::Step<Source>], float: bool, dest: Target) -> Exec<()> {
        let mut failed = None;
        let (to, mode) = (self.kind(dest), self.mode());
        let outcome = expression::evaluate(
            steps,
            |source| {
                self.load(source).unwrap_or_else(|code| {
                    failed.get_or_insert(code);
                    Number::Word(0)
                })
            },
            float,
            to,
            mode,
        );
        match (failed, outcome) {
            (Some(code), _) => Err(code),
            (None, Some(outcome)) => self.leave(dest, outcome),
            (None, None) => Err(crate::fault::code::UNSUPPORTED),
        }
    }
}

fn low_word(value: Number) -> u16 {
    match value {
        Number::Word(value) => value as u16,
        Number::Long(value) => value as u16,
        Number::Float(value) => value.round_ties_even() as i32 as u16,
    }
}
