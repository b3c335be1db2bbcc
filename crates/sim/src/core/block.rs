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
            Block::StringsEqual { a, b } => self.strings_equal(*a, *b),
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
            Block::ToBcd { source, dest, register } => self.encode_bcd(*source, *dest, *register),
            Block::FromBcd { source, dest, register } => self.decode_bcd(*source, *dest, *register),
            Block::DoubleDivide { source, dest } => self.double_divide(*source, *dest),
            Block::Scale { source, rate, offset, dest } => self.scale([*source, *rate, *offset], *dest),
            Block::ScaleParameters { input, dest } => self.scale_parameters(*input, *dest),
            Block::Compute { steps, float, dest } => self.compute(steps, *float, *dest),
            Block::SwapBytes { at, length } => self.swap_bytes(*at, *length),
            Block::Copy { source, dest, length, words } => self.copy(*source, *dest, *length, *words),
            Block::Fill { source, dest, length } => self.fill(*source, *dest, *length),
            Block::FillElement { source, dest, length } => self.fill_element(*source, *dest, *length),
            Block::Shift { left, file, control, bit } => self.shift(*left, *file, *control, *bit, power),
            Block::Load { source, file, control, long } => self.stack_load(*source, *file, *control, *long, power),
            Block::Unload { order, file, dest, control, long } => {
                self.stack_unload(*order, *file, *dest, *control, *long, power)
            }
            Block::SequencerOutput { file, mask, dest, control } => {
                self.sequencer_output(*file, *mask, *dest, *control, power)
            }
            Block::SequencerCompare { file, mask, source, control } => {
                self.sequencer_compare(*file, *mask, *source, *control, power)
            }
            Block::SequencerLoad { file, source, control } => self.sequencer_load(*file, *source, *control, power),
            Block::FileBits { detect, source, reference, result, compare, control } => {
                self.file_bits(*detect, [*source, *reference, *result], [*compare, *control], power)
            }
            Block::ImmediateInput { first, words, mask } => self.immediate_input(*first, *words, *mask),
            Block::ImmediateOutput { first, words, mask } => self.immediate_output(*first, *words, *mask),
            Block::EventInterrupts { change, slots } => self.event_interrupts(*change, *slots),
            Block::ClockRead { dest } => self.clock_read(*dest),
            Block::ClockDifference { start, stop, dest } => self.clock_difference(*start, *stop, *dest),
            Block::ClockAdjust { slot } => {
                self.clock_adjust(*slot, power);
                Ok(())
            }
            Block::HighSpeedLoad { counter, values } => self.high_speed_load(*counter, values),
            Block::HighSpeedReset { counter, source } => self.high_speed_reset(*counter, *source),
            Block::HighSpeedCounter { word } => {
                self.high_speed_counter(*word, power);
                Ok(())
            }
            Block::Pulse => Ok(()),
            Block::StringToInteger { source, dest } => self.string_to_integer(*source, *dest),
            Block::IntegerToString { source, dest } => self.integer_to_string(*source, *dest),
            Block::Concatenate { a, b, dest } => self.concatenate(*a, *b, *dest),
            Block::Extract { source, index, number, dest } => self.extract(*source, *index, *number, *dest),
            Block::Search { source, index, within, dest } => self.search(*source, *index, *within, *dest),
            Block::Port(port) => self.port(port, power),
            Block::ClearPort { channel, transmit, receive } => {
                self.clear_port(*channel, *transmit, *receive);
                Ok(())
            }
            Block::Message(message) => self.message(message, power),
            Block::Pid { at, process, control, present, slot } => {
                self.pid(*at, *process, (*control, *present), *slot, power)
            }
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
