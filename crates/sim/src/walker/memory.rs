//! Addresses of the interpreter: resolved by the rules of the manuals at every use.

use instr::exec::{Lineage, Number, Width};
use ladder::{Address, FileType, Operand, Place};

use super::{Leave, Walk, Walker};
use crate::status;

/// A word of a data file.
type Spot = (FileType, u16, usize);

impl Walker<'_> {
    fn outside(&self, slc: u16) -> Leave {
        Leave::Fault(if self.rules.lineage == Lineage::Mx { 0x29 } else { slc })
    }

    fn number(&self, place: &Place) -> Walk<i64> {
        match place {
            Place::Number(number) => Ok((*number).into()),
            Place::Indirect(address) => match self.value(address)? {
                Number::Word(value) => Ok(value.into()),
                Number::Long(value) => Ok(value.into()),
                Number::Float(_) => Err(self.outside(0x2C)),
            },
        }
    }

    /// The word an address starts at and the bit in it.
    pub(super) fn spot(&self, address: &Address) -> Walk<(Spot, u16)> {
        let file_type = address.file_type;
        let element = self.number(&address.element)?;
        let mut bit = address.bit.as_ref().map_or(Ok(0), |bit| self.number(bit))?;
        let key = (file_type, self.number(&address.file)? as u16);
        let Some(words) = self.files.get(&key) else { return Err(self.outside(0x2B)) };
        let size = if file_type.has_slots() { 1 } else { i64::from(file_type.words_per_element().unwrap_or(1)) };
        let count = words.len() as i64 / size;
        let mut first = element * size + i64::from(address.word.unwrap_or(0));
        if address.indexed {
            let index = self.files.get(&(FileType::S, 2)).and_then(|words| words.get(status::INDEX));
            let unit = if matches!(file_type, FileType::F | FileType::L) { size } else { 1 };
            first += i64::from(index.copied().unwrap_or(0) as i16) * unit;
            if !(0..words.len() as i64).contains(&first) {
                return Err(Leave::Fault(0x2A));
            }
        } else if !(0..count).contains(&element) {
            return Err(self.outside(0x2C));
        }
        if bit < 0 {
            return Err(self.outside(0x2D));
        }
        first += bit / 16;
        bit %= 16;
        if first >= words.len() as i64 {
            return Err(self.outside(0x2C));
        }
        Ok(((key.0, key.1, first as usize), bit as u16))
    }

    fn at(&self, (file_type, number, index): Spot) -> u16 {
        self.files.get(&(file_type, number)).and_then(|words| words.get(index)).copied().unwrap_or(0)
    }

    fn place(&mut self, (file_type, number, index): Spot) -> Walk<&mut u16> {
        let word = self.files.get_mut(&(file_type, number)).and_then(|words| words.get_mut(index));
        word.ok_or(Leave::Fault(0x29))
    }

    /// The word `offset` behind an address.
    pub(super) fn word_at(&mut self, address: &Address, offset: usize) -> Walk<&mut u16> {
        let ((file_type, number, index), _) = self.spot(address)?;
        self.place((file_type, number, index + offset))
    }

    /// The words from an address to the end of its file.
    pub(super) fn rest(&mut self, address: &Address) -> Walk<&mut [u16]> {
        let plain = Address { indexed: false, ..address.clone() };
        let ((file_type, number, index), _) = self.spot(&plain)?;
        let words = self.files.get_mut(&(file_type, number)).ok_or(Leave::Fault(0x29))?;
        words.get_mut(index..).ok_or(Leave::Fault(0x29))
    }

    pub(super) fn bit(&self, address: &Address) -> Walk<bool> {
        let (spot, bit) = self.spot(address)?;
        Ok(self.at(spot) >> bit & 1 != 0)
    }

    pub(super) fn put_bit(&mut self, address: &Address, on: bool) -> Walk<()> {
        let (spot, bit) = self.spot(address)?;
        let word = self.place(spot)?;
        *word = *word & !(1 << bit) | u16::from(on) << bit;
        Ok(())
    }

    /// The kind of number at an address.
    pub(super) fn width(address: &Address) -> Width {
        match (address.file_type, address.word) {
            (FileType::F, None) => Width::Float,
            (FileType::L, None) => Width::Long,
            _ => Width::Word,
        }
    }

    fn value(&self, address: &Address) -> Walk<Number> {
        let ((file_type, number, index), _) = self.spot(address)?;
        let low = self.at((file_type, number, index));
        let long = u32::from(low) | u32::from(self.at((file_type, number, index + 1))) << 16;
        Ok(match Self::width(address) {
            Width::Word => Number::Word(low as i16),
            Width::Long => Number::Long(long as i32),
            Width::Float => Number::Float(f32::from_bits(long)),
        })
    }

    /// The value of an operand; `long` says that a long word takes part.
    pub(super) fn operand(&self, operand: &Operand, long: bool) -> Walk<Number> {
        match operand {
            Operand::Address(address) => self.value(address),
            Operand::Constant(constant) => Ok(match constant.number() {
                ladder::Number::Float(value) => Number::Float(value),
                ladder::Number::Integer(value) => {
                    let word = if constant.is_hex() && !long { value as u16 as i16 as i64 } else { value };
                    match i16::try_from(word) {
                        Ok(word) => Number::Word(word),
                        Err(_) => Number::Long(word as i32),
                    }
                }
            }),
            _ => Err(Leave::Fault(0x31)),
        }
    }

    pub(super) fn store(&mut self, address: &Address, value: Number) -> Walk<()> {
        let (low, high) = match value {
            Number::Word(value) => (value as u16, None),
            Number::Long(value) => (value as u16, Some((value >> 16) as u16)),
            Number::Float(value) => (value.to_bits() as u16, Some((value.to_bits() >> 16) as u16)),
        };
        *self.word_at(address, 0)? = low;
        if let Some(high) = high {
            *self.word_at(address, 1)? = high;
        }
        Ok(())
    }
}
