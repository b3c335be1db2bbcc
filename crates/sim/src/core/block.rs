//! Instructions of the block table.

use instr::exec::compare;

use super::run::Context;
use super::{Core, Exec};
use crate::fault::code;
use crate::op::*;

impl Core<'_> {
    /// A condition, with power before it.
    pub(crate) fn test(&mut self, block: u32) -> Exec<bool> {
        let program = self.p;
        let Some(block) = program.blocks.get(block as usize) else { return Err(code::UNSUPPORTED) };
        match block {
            Block::Bit { bit, closed } => Ok(self.read_bit(*bit)? != *closed),
            Block::Compare { relation, a, b } => {
                let (a, b) = (self.load(*a)?, self.load(*b)?);
                let compare = match relation {
                    Relation::Equal => compare::equ,
                    Relation::NotEqual => compare::neq,
                    Relation::Less => compare::les,
                    Relation::LessOrEqual => compare::leq,
                    Relation::Greater => compare::grt,
                    Relation::GreaterOrEqual => compare::geq,
                };
                Ok(compare(a, b))
            }
            Block::MaskedEqual { source, mask, compare } => {
                let mut pattern = |source| self.integer(source).map(|value| value as u32);
                let (source, mask, compare) = (pattern(*source)?, pattern(*mask)?, pattern(*compare)?);
                Ok(compare::meq(source, mask, compare))
            }
            Block::Limit { low, test, high } => {
                let (low, test, high) = (self.load(*low)?, self.load(*test)?, self.load(*high)?);
                Ok(compare::lim(low, test, high))
            }
            _ => Err(code::UNSUPPORTED),
        }
    }

    /// An output. Those that do nothing without power are called with power only.
    pub(crate) fn act(&mut self, block: u32, power: bool, context: Context) -> Exec<()> {
        let program = self.p;
        let Some(block) = program.blocks.get(block as usize) else { return Err(code::UNSUPPORTED) };
        match block {
            Block::Coil(bit) => self.write_bit(*bit, power),
            Block::Latch(bit) => self.write_bit(*bit, true),
            Block::Unlatch(bit) => self.write_bit(*bit, false),
            Block::Rising { storage, output } => {
                let was = self.read_bit(*storage)?;
                self.write_bit(*storage, power)?;
                self.write_bit(*output, power && !was)
            }
            Block::Falling { storage, output } => {
                let was = self.read_bit(*storage)?;
                self.write_bit(*storage, power)?;
                self.write_bit(*output, !power && was)
            }
            Block::Timer { kind, base, at } => {
                let (word, _) = self.resolve(*at)?;
                let slot = program.timer_slot(word).ok_or(code::OUTSIDE_DATA)?;
                self.timer(*kind, *base, word, slot, power)
            }
            Block::Counter { down, at } => {
                let (word, _) = self.resolve(*at)?;
                self.counter(*down, word, power);
                Ok(())
            }
            Block::Reset { at, file_type } => self.reset(*at, *file_type),
            Block::Unary { op, source, dest } => self.unary(*op, *source, *dest),
            Block::Binary { op, a, b, dest } => self.binary(*op, *a, *b, *dest),
            Block::Clear(dest) => self.clear(*dest),
            Block::MaskedMove { source, mask, dest } => self.masked_move(*source, *mask, *dest),
            Block::ToBcd { source, dest, register } => self.to_bcd(*source, *dest, *register),
            Block::FromBcd { source, dest, register } => self.from_bcd(*source, *dest, *register),
            Block::DoubleDivide { source, dest } => self.double_divide(*source, *dest),
            Block::Scale { source, rate, offset, dest } => self.scale([*source, *rate, *offset], *dest),
            Block::ScaleParameters { input, dest } => self.scale_parameters(*input, *dest),
            Block::Compute { steps, float, dest } => self.compute(steps, *float, *dest),
            Block::Refresh => self.refresh(context),
            Block::Service | Block::Idle => Ok(()),
            Block::InterruptMask { change, types } => self.interrupt_mask(*change, *types),
            Block::TimedStart { file, time } => self.timed_start(*file, *time),
            Block::TimedEnable(on) => {
                self.timed_enable(*on);
                Ok(())
            }
            _ => Err(code::UNSUPPORTED),
        }
    }
}
