//! Reading and writing operands, those decided at run time included.

use instr::exec::{Number, Width as Kind};

use super::{Core, Exec};
use crate::choices::Choice;
use crate::fault::code;
use crate::layout::Width;
use crate::op::*;
use crate::status;
use ladder::FileType;

/// A word that does not exist: reads as 0, writes vanish.
const NOWHERE: u32 = u32::MAX;

impl Core<'_> {
    /// The value of an operand.
    #[inline]
    pub(crate) fn load(&mut self, source: Source) -> Exec<Number> {
        Ok(match source {
            Source::Word(at) => Number::Word(self.word(at) as i16),
            Source::Long(at) => Number::Long(self.long(at) as i32),
            Source::Float(at) => Number::Float(f32::from_bits(self.long(at))),
            Source::Integer(value) => match i16::try_from(value) {
                Ok(word) => Number::Word(word),
                Err(_) => Number::Long(value),
            },
            Source::Real(value) => Number::Float(value),
            Source::At(reference) => {
                let (at, _) = self.resolve(reference)?;
                match self.p.references.get(reference as usize).map(|found| found.width) {
                    Some(Width::Long) => Number::Long(self.long(at) as i32),
                    Some(Width::Float) => Number::Float(f32::from_bits(self.long(at))),
                    _ => Number::Word(self.word(at) as i16),
                }
            }
        })
    }

    /// The value as an integer, floats rounded to the nearest one: for lengths, masks, numbers of things.
    pub(crate) fn integer(&mut self, source: Source) -> Exec<i32> {
        Ok(match self.load(source)? {
            Number::Word(value) => i32::from(value),
            Number::Long(value) => value,
            Number::Float(value) => value.round_ties_even() as i32,
        })
    }

    /// Two words, the low one first.
    #[inline]
    pub(crate) fn long(&self, at: u32) -> u32 {
        u32::from(self.word(at)) | u32::from(self.word(at.saturating_add(1))) << 16
    }

    pub(crate) fn put_long(&mut self, at: u32, value: u32) {
        self.put(at, value as u16);
        self.put(at.saturating_add(1), (value >> 16) as u16);
    }

    /// The kind of number a destination takes.
    #[inline]
    pub(crate) fn kind(&self, target: Target) -> Kind {
        match target {
            Target::Word(_) => Kind::Word,
            Target::Long(_) => Kind::Long,
            Target::Float(_) => Kind::Float,
            Target::At(reference) => match self.p.references.get(reference as usize).map(|found| found.width) {
                Some(Width::Long) => Kind::Long,
                Some(Width::Float) => Kind::Float,
                _ => Kind::Word,
            },
        }
    }

    /// Stores a number of the destination's own kind.
    #[inline]
    pub(crate) fn store(&mut self, target: Target, value: Number) -> Exec<()> {
        let at = match target {
            Target::Word(at) | Target::Long(at) | Target::Float(at) => at,
            Target::At(reference) => self.resolve(reference)?.0,
        };
        match value {
            Number::Word(value) => self.put(at, value as u16),
            Number::Long(value) => self.put_long(at, value as u32),
            Number::Float(value) => self.put_long(at, value.to_bits()),
        }
        Ok(())
    }

    /// The number now in a destination.
    pub(crate) fn present(&mut self, target: Target) -> Exec<Number> {
        self.load(match target {
            Target::Word(at) => Source::Word(at),
            Target::Long(at) => Source::Long(at),
            Target::Float(at) => Source::Float(at),
            Target::At(reference) => Source::At(reference),
        })
    }

    pub(crate) fn read_bit(&mut self, bit: BitAt) -> Exec<bool> {
        let (mask, word) = self.bit_place(bit)?;
        Ok(self.word(word) & mask != 0)
    }

    pub(crate) fn write_bit(&mut self, bit: BitAt, on: bool) -> Exec<()> {
        let (mask, word) = self.bit_place(bit)?;
        self.put_bits(word, mask, on);
        Ok(())
    }

    fn bit_place(&mut self, bit: BitAt) -> Exec<(u16, u32)> {
        match bit {
            BitAt::Direct { mask, word } => Ok((mask, word)),
            BitAt::At(reference) => self.resolve(reference).map(|(word, bit)| (1 << (bit & 15), word)),
        }
    }

    /// First word of a file operand and the first word after its file.
    pub(crate) fn start(&mut self, start: Start) -> Exec<(u32, u32)> {
        match start.at {
            StartAt::Fixed { word, end } => Ok((word, end)),
            StartAt::At(reference) => {
                let (word, _) = self.resolve(reference)?;
                let file = self.p.layout.file_of(word).and_then(|file| self.p.layout.files.get(file));
                Ok((word, file.map_or(word, |file| file.end())))
            }
        }
    }

    /// Word and bit of an address decided at run time.
    pub(crate) fn resolve(&mut self, reference: u32) -> Exec<(u32, u8)> {
        let program = self.p;
        let Some(reference) = program.references.get(reference as usize) else { return Err(code::OUTSIDE_DATA) };
        let mx = program.traits.mx();
        let number = match reference.file {
            Part::Fixed(number) => i32::from(number),
            Part::Read(source) => self.integer(source)?,
        };
        let element = match reference.element {
            Part::Fixed(number) => i64::from(number),
            Part::Read(source) => i64::from(self.integer(source)?),
        };
        let bit = match reference.bit {
            None => None,
            Some(Part::Fixed(bit)) => Some(i64::from(bit)),
            Some(Part::Read(source)) => Some(i64::from(self.integer(source)?)),
        };
        if reference.file_type.has_slots() {
            return self.resolve_slot(reference, element, bit);
        }
        let file = u16::try_from(number).ok().and_then(|number| program.layout.file(reference.file_type, number));
        let Some(info) = file.and_then(|file| program.layout.files.get(file)) else {
            return Err(if mx { code::OUTSIDE_DATA } else { code::INDIRECT_FILE });
        };
        let size = i64::from(info.size);
        let mut word = i64::from(info.start) + element * size + i64::from(reference.sub);
        let inside = |word: i64| (i64::from(info.start)..i64::from(info.end())).contains(&word);
        if reference.indexed {
            let index = i64::from(self.status(status::INDEX) as i16);
            let whole_elements = matches!(info.file_type, FileType::F | FileType::L);
            word += index * if whole_elements { size } else { 1 };
            if !inside(word) {
                if !self.status_bit(status::INDEX_ACROSS) {
                    return Err(code::OUTSIDE_FILE);
                }
                if !(0..i64::from(program.layout.user_end)).contains(&word) {
                    return Err(code::OUTSIDE_DATA);
                }
            }
        } else if !(0..i64::from(info.elements)).contains(&element) {
            self.stray(word, mx)?;
        }
        let Some(bit) = bit else { return Ok((word as u32, 0)) };
        let linear = info.size == 1 && matches!(reference.element, Part::Fixed(0)) && reference.sub == 0;
        let bits = if matches!(info.file_type, FileType::F | FileType::L) { 32 } else { 16 };
        if (0..bits).contains(&bit) || (linear && bit >= 0) {
            word += bit / 16;
            if !inside(word) && linear && bit >= bits {
                self.stray(word, mx)?;
            }
            return Ok((word as u32, (bit % 16) as u8));
        }
        // Reports say that MicroLogix then writes nothing and goes on.
        if mx {
            self.s.strays += 1;
            return Ok((NOWHERE, 0));
        }
        Err(code::INDIRECT_SUB)
    }

    /// An indirect address beyond its file.
    fn stray(&mut self, word: i64, mx: bool) -> Exec<()> {
        if !mx {
            return Err(code::INDIRECT_ELEMENT);
        }
        let space = 0..i64::from(self.p.layout.user_end);
        if self.p.choices.has(Choice::IndirectStaysInFile) || !space.contains(&word) {
            return Err(code::OUTSIDE_DATA);
        }
        self.s.strays += 1;
        Ok(())
    }

    fn resolve_slot(&mut self, reference: &Reference, slot: i64, bit: Option<i64>) -> Exec<(u32, u8)> {
        let mx = self.p.traits.mx();
        let outside = if mx { code::OUTSIDE_DATA } else { code::INDIRECT_ELEMENT };
        let slot = u16::try_from(slot).map_err(|_| outside)?;
        let bit = bit.unwrap_or(0);
        let bit = u16::try_from(bit).map_err(|_| if mx { outside } else { code::INDIRECT_SUB })?;
        let word = reference.sub.saturating_add(bit / 16);
        let word = self.p.layout.io_word(reference.file_type, slot, word).ok_or(outside)?;
        let index = if reference.indexed { i64::from(self.status(status::INDEX) as i16) } else { 0 };
        let word = i64::from(word) + index;
        if !(0..self.p.layout.words() as i64).contains(&word) {
            return Err(code::OUTSIDE_DATA);
        }
        Ok((word as u32, (bit % 16) as u8))
    }
}
