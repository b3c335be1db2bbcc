//! TOD, FRD, DCD, ENC, GCD and SWP.

use super::choices::Choice;
use super::flags::Flags;
use super::number::{Number, Outcome, Register, Width, fit_integer};
use super::rules::MathMode;

/// TOD: the absolute value as BCD. S tells a negative source (printed).
///
/// Five digits go to the math register, at overflow too (printed); the destination takes the low four.
/// V: the value is above 9999 (printed). What a destination other than S:13 holds then is not said;
/// it takes the same low four digits (inferred: a destination in S:13 shows them).
pub fn tod(source: i16) -> Outcome {
    let value = u32::from(source.unsigned_abs());
    let mut digits = 0_u32;
    for place in 0..5 {
        digits |= (value / 10_u32.pow(place) % 10) << (4 * place);
    }
    let register = Register { low: digits as u16, high: (digits >> 16) as u16 };
    let flags = Flags::new(false, value > 9999, register.low == 0, source < 0);
    Outcome { value: Some(Number::Word(register.low as i16)), flags, register: Some(register) }
}

/// FRD of a word: four BCD digits to an integer.
pub fn frd(source: u16, to: Width, mode: MathMode) -> Outcome {
    from_bcd(u32::from(source), to, mode)
}

/// FRD of the math register: the digits of S:14 before those of S:13 (printed). For a value of four
/// digits the program has to clear S:14 first.
pub fn frd_register(register: Register, to: Width, mode: MathMode) -> Outcome {
    from_bcd(register.long() as u32, to, mode)
}

/// V: a digit above 9, or a value above 32767 (manual, unseen), which is limited: S:2/14 is not said
/// to concern FRD. What a digit above 9 leaves in the destination is open:
/// [`Choice::FrdTakesAnyDigit`].
fn from_bcd(digits: u32, to: Width, mode: MathMode) -> Outcome {
    let (mut value, mut valid) = (0_i64, true);
    for place in (0..8).rev() {
        let digit = digits >> (4 * place) & 0xF;
        valid &= digit <= 9;
        value = value * 10 + i64::from(digit);
    }
    if !valid && !mode.rules.has(Choice::FrdTakesAnyDigit) {
        return Outcome { value: None, flags: Flags::OVERFLOW, register: None };
    }
    let (stored, overflow) = fit_integer(value, to, false);
    Outcome::stored(stored, false, overflow || !valid)
}

/// DCD: a word with one bit set, the one numbered by the low four bits of the source. No flag changes
/// (manual, unseen).
#[inline]
pub const fn dcd(source: u16) -> u16 {
    1 << (source & 0xF)
}

/// ENC: the number of the lowest bit that is set (printed), 0 without one. V: more than one is set;
/// Z: the source is zero (manual, unseen).
pub const fn enc(source: u16) -> Outcome {
    let position = if source == 0 { 0 } else { source.trailing_zeros() as i16 };
    let flags = Flags::new(false, source.count_ones() > 1, source == 0, false);
    Outcome { value: Some(Number::Word(position)), flags, register: None }
}

/// GCD: Gray code to an integer. A source with its high bit set gives 32767 and V (manual, unseen).
pub const fn gcd(source: u16) -> Outcome {
    if source & 0x8000 != 0 {
        return Outcome { value: Some(Number::Word(i16::MAX)), flags: Flags::OVERFLOW, register: None };
    }
    let mut value = source;
    value ^= value >> 8;
    value ^= value >> 4;
    value ^= value >> 2;
    value ^= value >> 1;
    Outcome {
        value: Some(Number::Word(value as i16)),
        flags: Flags::of_word(value as i16, false, false),
        register: None,
    }
}

/// SWP: the bytes of each word exchanged. No flag changes (manual, unseen).
pub fn swp(words: &mut [u16]) {
    for word in words {
        *word = word.swap_bytes();
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::exec::{Lineage, Rules};

    fn mode() -> MathMode {
        Rules::new(Lineage::S3).math(0)
    }

    fn w(value: u16) -> Option<Number> {
        Some(Number::Word(value as i16))
    }

    #[test]
    fn to_bcd_printed_numbers() {
        let outcome = tod(9760);
        assert_eq!((outcome.value, outcome.flags), (w(0x9760), Flags::NONE));
        let outcome = tod(32760);
        assert_eq!(outcome.register, Some(Register { high: 3, low: 0x2760 }));
        assert!(outcome.flags.has(Flags::OVERFLOW));
        let outcome = tod(-9760);
        assert_eq!((outcome.value, outcome.flags), (w(0x9760), Flags::SIGN));
        assert_eq!(tod(i16::MIN).register, Some(Register { high: 3, low: 0x2768 }));
        assert_eq!(tod(0).flags, Flags::ZERO);
        assert_eq!(tod(9999).flags, Flags::NONE);
        assert_eq!(tod(10000).flags, Flags::OVERFLOW | Flags::ZERO, "the four digits of the destination are 0");
    }

    #[test]
    fn from_bcd_printed_numbers() {
        let outcome = frd_register(Register { high: 3, low: 0x2760 }, Width::Word, mode());
        assert_eq!((outcome.value, outcome.flags), (w(32760), Flags::NONE));
        assert_eq!(frd(0x9999, Width::Word, mode()).value, w(9999));
        assert_eq!(frd(0, Width::Word, mode()).flags, Flags::ZERO);
        let large = frd_register(Register { high: 3, low: 0x2768 }, Width::Word, Rules::new(Lineage::S3).math(0x4000));
        assert_eq!((large.value, large.flags), (w(32767), Flags::OVERFLOW));
        let bad = frd(0x00A1, Width::Word, mode());
        assert_eq!((bad.value, bad.flags), (None, Flags::OVERFLOW));
        let taken = frd(0x00A1, Width::Word, Rules::new(Lineage::S3).with(Choice::FrdTakesAnyDigit).math(0));
        assert_eq!((taken.value, taken.flags), (w(101), Flags::OVERFLOW));
    }

    #[test]
    fn one_of_sixteen() {
        assert_eq!([0, 3, 15, 16, 0xFFF5].map(dcd), [1, 8, 0x8000, 1, 0x20]);
        assert_eq!((enc(8).value, enc(8).flags), (w(3), Flags::NONE));
        assert_eq!((enc(0).value, enc(0).flags), (w(0), Flags::ZERO));
        assert_eq!((enc(0x8004).value, enc(0x8004).flags), (w(2), Flags::OVERFLOW));
        assert_eq!((enc(1).value, enc(1).flags), (w(0), Flags::NONE), "Z is about the source");
    }

    #[test]
    fn gray_code() {
        assert_eq!([0, 1, 3, 2, 6, 7, 5, 4].map(|g| gcd(g).value), [0, 1, 2, 3, 4, 5, 6, 7].map(w));
        assert_eq!((gcd(0x8000).value, gcd(0x8000).flags), (w(32767), Flags::OVERFLOW));
        assert_eq!(gcd(0).flags, Flags::ZERO);
    }

    #[test]
    fn bytes_swap() {
        let mut words = [0x1234, 0xFF00];
        swp(&mut words);
        assert_eq!(words, [0x3412, 0x00FF]);
        swp(&mut []);
    }

    proptest! {
        #[test]
        fn bcd_comes_back(value: i16) {
            let register = tod(value).register.unwrap_or(Register::of_long(0));
            let back = frd_register(register, Width::Long, mode());
            prop_assert_eq!(back.value, Some(Number::Long(i32::from(value).abs())));
        }

        #[test]
        fn gray_neighbours_differ_in_one_bit(value in 0_u16..0x7FFF) {
            let gray = |v: u16| v ^ v >> 1;
            prop_assert_eq!(gcd(gray(value)).value, w(value));
            prop_assert_eq!((gray(value) ^ gray(value + 1)).count_ones(), 1);
        }

        #[test]
        fn decode_and_encode(source: u16, digits: u32) {
            prop_assert_eq!(enc(dcd(source)).value, w(source & 0xF));
            let _ = from_bcd(digits, Width::Word, mode());
        }
    }
}
