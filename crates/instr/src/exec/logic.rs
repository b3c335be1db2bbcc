//! MOV, MVM, AND, OR, XOR and NOT.
//!
//! C and V are reset, Z and S are those of the stored value, the math register is not affected
//! (printed: the register; the flags: manual, unseen). Bitwise operations are for integers; the
//! caller refuses floats when it loads a program, here a float counts as its converted integer.

use super::flags::Flags;
use super::number::{Number, Outcome, Width, convert};
use super::rules::MathMode;

/// MOV: the source, converted to the kind of the destination. V is set when it does not fit; a long
/// word into a word is limited or cut by S:2/14 (manual, unseen).
#[inline]
pub fn mov(source: Number, to: Width, mode: MathMode) -> Outcome {
    let (value, overflow) = convert(source, to, mode);
    Outcome::stored(value, false, overflow)
}

/// The flags of a moved word, for the commonest case: word to word.
#[inline]
pub const fn word_flags(value: i16) -> Flags {
    Flags::of_word(value, false, false)
}

fn bits(value: Number, mode: MathMode) -> u32 {
    match value {
        Number::Word(value) => value as u32,
        Number::Long(value) => value as u32,
        Number::Float(_) => match convert(value, Width::Long, mode).0 {
            Number::Long(value) => value as u32,
            _ => 0,
        },
    }
}

/// A bit pattern as the value of a destination. Operands of these instructions have one size (manual,
/// unseen); a smaller destination takes the low bits.
fn pattern(bits: u32, to: Width) -> Outcome {
    let value = match to {
        Width::Word => Number::Word(bits as i16),
        Width::Long => Number::Long(bits as i32),
        Width::Float => Number::Float(bits as i32 as f32),
    };
    Outcome::stored(value, false, false)
}

/// MVM: the bits of the source that are 1 in the mask, the other bits of the destination (manual,
/// unseen).
#[inline]
pub fn mvm(source: Number, mask: Number, destination: Number, mode: MathMode) -> Outcome {
    let (source, mask, old) = (bits(source, mode), bits(mask, mode), bits(destination, mode));
    pattern(masked(source, mask, old), destination.width())
}

/// `old` with the bits of `source` where `mask` is 1: the rule of MVM and of the sequencers.
#[inline]
pub const fn masked(source: u32, mask: u32, old: u32) -> u32 {
    old & !mask | source & mask
}

/// AND: bits that are 1 in both sources.
#[inline]
pub fn and(a: Number, b: Number, to: Width, mode: MathMode) -> Outcome {
    pattern(bits(a, mode) & bits(b, mode), to)
}

/// OR: bits that are 1 in one source or both.
#[inline]
pub fn or(a: Number, b: Number, to: Width, mode: MathMode) -> Outcome {
    pattern(bits(a, mode) | bits(b, mode), to)
}

/// XOR: bits in which the sources differ.
#[inline]
pub fn xor(a: Number, b: Number, to: Width, mode: MathMode) -> Outcome {
    pattern(bits(a, mode) ^ bits(b, mode), to)
}

/// NOT: every bit of the source inverted.
#[inline]
pub fn not(source: Number, to: Width, mode: MathMode) -> Outcome {
    pattern(!bits(source, mode), to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exec::{Lineage, Rules};

    fn w(value: u16) -> Number {
        Number::Word(value as i16)
    }

    fn slc() -> MathMode {
        Rules::new(Lineage::S3).math(0)
    }

    #[test]
    fn masked_move() {
        let outcome = mvm(w(0x5555), w(0xF0F0), w(0xFFFF), slc());
        assert_eq!(outcome.value, Some(w(0x5F5F)));
        assert_eq!(outcome.flags, Flags::NONE);
        assert_eq!(mvm(w(0x5555), w(0), w(0x8000), slc()).flags, Flags::SIGN);
    }

    #[test]
    fn bitwise() {
        assert_eq!(and(w(0xFF00), w(0x0FF0), Width::Word, slc()).value, Some(w(0x0F00)));
        assert_eq!(or(w(0xFF00), w(0x0FF0), Width::Word, slc()).value, Some(w(0xFFF0)));
        let outcome = xor(w(0xFF00), w(0xFF00), Width::Word, slc());
        assert_eq!((outcome.value, outcome.flags), (Some(w(0)), Flags::ZERO));
        let outcome = not(w(0x0FFF), Width::Word, slc());
        assert_eq!((outcome.value, outcome.flags), (Some(w(0xF000)), Flags::SIGN));
        assert_eq!(not(Number::Long(0), Width::Long, slc()).value, Some(Number::Long(-1)));
        assert_eq!(and(Number::Long(0x12345), w(0xFFFF), Width::Long, slc()).value, Some(Number::Long(0x12345)));
    }

    #[test]
    fn moves_convert() {
        let mx = Rules::new(Lineage::Mx).math(0);
        let to_word = |value| mov(Number::Float(value), Width::Word, mx);
        assert_eq!([2.5, 3.5, -2.5].map(|v| to_word(v).value), [w(2), w(4), w(-2_i16 as u16)].map(Some));
        assert_eq!(to_word(1e9).flags, Flags::OVERFLOW);
        assert_eq!(to_word(-1e9).flags, Flags::OVERFLOW | Flags::SIGN);
        assert_eq!(to_word(0.2).flags, Flags::ZERO);
        assert_eq!(mov(w(0xFFFF), Width::Float, mx).value, Some(Number::Float(-1.0)));
        assert_eq!(mov(w(0xFFFF), Width::Long, mx).value, Some(Number::Long(-1)));
        assert_eq!(word_flags(-1), Flags::SIGN);
    }
}
