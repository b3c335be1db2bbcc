//! Values at places, and how they change from one type to another.

use super::{Kind, Place};
use crate::address::Number;
use crate::choices::{Choice, Choices};

/// A number of any type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Num {
    /// A whole number.
    Int(i64),
    /// A real.
    Real(f64),
}

impl Num {
    /// The number of a constant. Hex and decimal alike are whole numbers as written.
    pub fn of(number: Number) -> Num {
        match number {
            Number::Integer(value) => Num::Int(value),
            Number::Real(value) => Num::Real(value),
        }
    }

    /// As a real.
    pub fn real(self) -> f64 {
        match self {
            Num::Int(value) => value as f64,
            Num::Real(value) => value,
        }
    }

    /// Not zero; a NaN counts as not zero.
    pub fn is_on(self) -> bool {
        match self {
            Num::Int(value) => value != 0,
            Num::Real(value) => value != 0.0,
        }
    }

    /// The number as an integer of 64 bits: a fraction is lost or rounded as `choices` say.
    pub fn integer(self, choices: Choices) -> i64 {
        match self {
            Num::Int(value) => value,
            Num::Real(value) if choices.has(Choice::StoreRounds) => value.round() as i64,
            Num::Real(value) => value as i64,
        }
    }

    /// The number as it goes into an integer type; what is beyond its limits is left to whoever cuts the bits.
    #[inline]
    fn fitted(self, kind: Kind, choices: Choices) -> i64 {
        let value = self.integer(choices);
        let saturates = matches!(self, Num::Real(_)) || choices.has(Choice::StoreSaturates);
        match kind.limits() {
            Some((least, most)) if saturates => value.clamp(least, most),
            _ => value,
        }
    }
}

/// The bytes of all memory.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Data {
    bytes: Vec<u8>,
}

impl Data {
    /// So many zero bytes.
    pub fn new(bytes: usize) -> Data {
        Data { bytes: vec![0; bytes] }
    }

    /// All bytes.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// All bytes, to change.
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        &mut self.bytes
    }

    /// A bit; OFF outside memory.
    #[inline]
    pub fn bit(&self, bit: u32) -> bool {
        self.bytes.get((bit >> 3) as usize).is_some_and(|byte| byte >> (bit & 7) & 1 != 0)
    }

    /// Writes a bit.
    #[inline]
    pub fn set_bit(&mut self, bit: u32, on: bool) {
        if let Some(byte) = self.bytes.get_mut((bit >> 3) as usize) {
            let mask = 1u8 << (bit & 7);
            *byte = if on { *byte | mask } else { *byte & !mask };
        }
    }

    #[inline]
    fn chunk<const N: usize>(&self, bit: u32) -> [u8; N] {
        let rest = self.bytes.get((bit >> 3) as usize..).unwrap_or_default();
        rest.first_chunk::<N>().copied().unwrap_or([0; N])
    }

    #[inline]
    fn put<const N: usize>(&mut self, bit: u32, value: [u8; N]) {
        let rest = self.bytes.get_mut((bit >> 3) as usize..).unwrap_or_default();
        if let Some(chunk) = rest.first_chunk_mut::<N>() {
            *chunk = value;
        }
    }

    /// A signed double word, such as an accumulator.
    #[inline]
    pub fn dword(&self, bit: u32) -> i32 {
        i32::from_le_bytes(self.chunk(bit))
    }

    /// Writes a signed double word.
    #[inline]
    pub fn set_dword(&mut self, bit: u32, value: i32) {
        self.put(bit, value.to_le_bytes());
    }

    /// A byte of flags.
    #[inline]
    pub fn byte(&self, bit: u32) -> u8 {
        self.bytes.get((bit >> 3) as usize).copied().unwrap_or(0)
    }

    /// Writes a byte of flags.
    #[inline]
    pub fn set_byte(&mut self, bit: u32, value: u8) {
        self.put(bit, [value]);
    }

    /// The number at a place; a string is its length.
    #[inline]
    pub fn number(&self, place: Place) -> Num {
        let bit = place.bit;
        match place.kind {
            Kind::Bit => Num::Int(self.bit(bit).into()),
            Kind::U8 => Num::Int(self.byte(bit).into()),
            Kind::I8 => Num::Int((self.byte(bit) as i8).into()),
            Kind::U16 | Kind::Text(_) => Num::Int(u16::from_le_bytes(self.chunk(bit)).into()),
            Kind::I16 => Num::Int(i16::from_le_bytes(self.chunk(bit)).into()),
            Kind::I32 => Num::Int(self.dword(bit).into()),
            Kind::U32 => Num::Int(u32::from_le_bytes(self.chunk(bit)).into()),
            Kind::F32 => Num::Real(f32::from_le_bytes(self.chunk(bit)).into()),
        }
    }

    /// Writes a number, converted to the type of the place. Strings are left alone.
    #[inline]
    pub fn store(&mut self, place: Place, value: Num, choices: Choices) {
        let bit = place.bit;
        let fitted = || value.fitted(place.kind, choices);
        match place.kind {
            Kind::Bit => self.set_bit(bit, value.is_on()),
            Kind::U8 | Kind::I8 => self.set_byte(bit, fitted() as u8),
            Kind::U16 | Kind::I16 => self.put(bit, (fitted() as u16).to_le_bytes()),
            Kind::I32 | Kind::U32 => self.put(bit, (fitted() as u32).to_le_bytes()),
            Kind::F32 => self.put(bit, (value.real() as f32).to_le_bytes()),
            Kind::Text(_) => {}
        }
    }

    /// The characters at a string place.
    pub fn characters(&self, place: Place) -> &[u8] {
        let Kind::Text(most) = place.kind else { return &[] };
        let length = usize::from(u16::from_le_bytes(self.chunk(place.bit)).min(most));
        let start = (place.bit >> 3) as usize + 4;
        self.bytes.get(start..start + length).unwrap_or_default()
    }

    /// Writes characters; what does not fit is cut.
    pub fn set_characters(&mut self, place: Place, characters: &[u8]) {
        let Kind::Text(most) = place.kind else { return };
        let characters = characters.get(..usize::from(most)).unwrap_or(characters);
        self.put(place.bit, (characters.len() as u16).to_le_bytes());
        let start = (place.bit >> 3) as usize + 4;
        if let Some(room) = self.bytes.get_mut(start..start + characters.len()) {
            room.copy_from_slice(characters);
        }
    }

    /// The text at a string place.
    pub fn text(&self, place: Place) -> String {
        self.characters(place).iter().map(|byte| char::from(*byte)).collect()
    }

    /// Writes a text; what does not fit is cut. `false`: a character has no place in a string.
    pub fn set_text(&mut self, place: Place, text: &str) -> bool {
        let bytes: Option<Vec<u8>> = text.chars().map(|c| u8::try_from(u32::from(c)).ok()).collect();
        let Some(bytes) = bytes.filter(|_| matches!(place.kind, Kind::Text(_))) else { return false };
        self.set_characters(place, &bytes);
        true
    }
}
