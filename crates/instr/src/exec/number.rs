//! Numbers of three kinds, and how a result gets into a destination of another kind.

use super::choices::Choice;
use super::flags::Flags;
use super::rules::MathMode;

/// A value as instructions compute with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    /// A 16-bit word.
    Word(i16),
    /// A 32-bit long word.
    Long(i32),
    /// A single-precision float.
    Float(f32),
}

/// The kind of a destination.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Width {
    /// 16 bits.
    Word,
    /// 32 bits.
    Long,
    /// Single precision.
    Float,
}

/// The math register: S:13 and S:14.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Register {
    /// S:13.
    pub low: u16,
    /// S:14.
    pub high: u16,
}

impl Register {
    /// The register holding 32 bits.
    pub const fn of_long(value: i32) -> Register {
        Register { low: value as u16, high: (value >> 16) as u16 }
    }

    /// The register read as one 32-bit value.
    pub const fn long(self) -> i32 {
        ((self.high as u32) << 16 | self.low as u32) as i32
    }
}

/// What an instruction leaves behind. The math register is to be stored after the value, so that a
/// destination in S:13 or S:14 ends with the register: two MicroLogix 1400 programs divide into S:13
/// and were saved while they ran with the remainder there (seen for DIV).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// For the destination; `None`: the destination keeps its value.
    pub value: Option<Number>,
    /// For S:0, and through [`Flags::trap`] for S:5.
    pub flags: Flags,
    /// For S:13 and S:14; `None`: they keep their values.
    pub register: Option<Register>,
}

impl Outcome {
    /// A stored value, Z and S from it, C and V as given.
    #[inline]
    pub(super) fn stored(value: Number, carry: bool, overflow: bool) -> Outcome {
        Outcome { value: Some(value), flags: Flags::of(value, carry, overflow), register: None }
    }

    #[inline]
    pub(super) fn with_register(self, register: Register) -> Outcome {
        Outcome { register: Some(register), ..self }
    }
}

impl Number {
    /// The kind of this number.
    #[inline]
    pub const fn width(self) -> Width {
        match self {
            Number::Word(_) => Width::Word,
            Number::Long(_) => Width::Long,
            Number::Float(_) => Width::Float,
        }
    }

    /// The value if it is an integer.
    #[inline]
    pub const fn integer(self) -> Option<i64> {
        match self {
            Number::Word(value) => Some(value as i64),
            Number::Long(value) => Some(value as i64),
            Number::Float(_) => None,
        }
    }

    /// The value as a float: integers rounded to the nearest one, denormal floats taken as +0
    /// (printed for the MicroLogix 1100; SLC open).
    #[inline]
    pub fn float(self) -> f32 {
        match self {
            Number::Word(value) => f32::from(value),
            Number::Long(value) => value as f32,
            Number::Float(value) => flushed(value),
        }
    }

    /// Equal to zero.
    #[inline]
    pub fn is_zero(self) -> bool {
        match self {
            Number::Word(value) => value == 0,
            Number::Long(value) => value == 0,
            Number::Float(value) => value == 0.0,
        }
    }

    /// The most significant bit is 1: of a float, -0 included (printed for the MicroLogix 1400).
    #[inline]
    pub fn is_negative(self) -> bool {
        match self {
            Number::Word(value) => value < 0,
            Number::Long(value) => value < 0,
            Number::Float(value) => value.is_sign_negative(),
        }
    }
}

/// What is stored as not-a-number: 7FFFFFFFh (printed for the MicroLogix 1400).
pub(super) const NOT_A_NUMBER: f32 = f32::from_bits(0x7FFF_FFFF);

/// A denormal number counts as +0, as a source and as a result (printed for the MicroLogix 1100).
#[inline]
pub(super) fn flushed(value: f32) -> f32 {
    if value.is_subnormal() { 0.0 } else { value }
}

/// Puts an integer result into a destination: the value, and whether it did not fit.
///
/// Without room it is limited to the nearest value, or cut to its low bits with S:2/14 (printed for
/// words; for long words the same idea, manual unseen).
#[inline]
pub(super) fn fit_integer(result: i64, to: Width, wrap: bool) -> (Number, bool) {
    match to {
        Width::Word => {
            let overflow = i16::try_from(result).is_err();
            let value = if wrap { result as i16 } else { result.clamp(i16::MIN.into(), i16::MAX.into()) as i16 };
            (Number::Word(value), overflow)
        }
        Width::Long => {
            let overflow = i32::try_from(result).is_err();
            let value = if wrap { result as i32 } else { result.clamp(i32::MIN.into(), i32::MAX.into()) as i32 };
            (Number::Long(value), overflow)
        }
        Width::Float => (Number::Float(result as f32), false),
    }
}

/// Puts a float result into a destination: the value, and whether it did not fit.
///
/// Into an integer it is rounded to the nearest one, halves to the even one; not-a-number, infinity
/// and what is out of range are limited whatever S:2/14 says; underflow gives +0 (printed for the
/// MicroLogix 1100 and 1400). Halves on SLC are open, and a MicroLogix 1400 was saved with the other
/// reading: [`Choice::FloatTiesAway`]. Not-a-number becomes the positive limit (printed for the
/// MicroLogix 1400). A float that is no finite number counts as not fitting, and stays in a float
/// destination (printed for SLC: the overflow result remains there).
#[inline]
pub(super) fn fit_float(result: f32, to: Width, mode: MathMode) -> (Number, bool) {
    let rounded = || if mode.rules.has(Choice::FloatTiesAway) { result.round() } else { result.round_ties_even() };
    match to {
        Width::Word => {
            let value = rounded();
            let fits = (f32::from(i16::MIN)..=f32::from(i16::MAX)).contains(&value);
            (Number::Word(if value.is_nan() { i16::MAX } else { value as i16 }), !fits)
        }
        Width::Long => {
            // 2^31 is the float next above the limit: the limit itself is no float.
            let value = rounded();
            let fits = (-2_147_483_648.0..2_147_483_648.0).contains(&value);
            (Number::Long(if value.is_nan() { i32::MAX } else { value as i32 }), !fits)
        }
        Width::Float if result.is_nan() => (Number::Float(NOT_A_NUMBER), true),
        Width::Float => (Number::Float(flushed(result)), !result.is_finite()),
    }
}

/// A value converted to the kind of a destination: the value, and whether it did not fit.
#[inline]
pub(super) fn convert(value: Number, to: Width, mode: MathMode) -> (Number, bool) {
    match (value, to) {
        (Number::Word(_), Width::Word) => (value, false),
        (Number::Float(float), _) => fit_float(flushed(float), to, mode),
        (Number::Word(integer), _) => fit_integer(i64::from(integer), to, mode.wrap),
        (Number::Long(integer), _) => fit_integer(i64::from(integer), to, mode.wrap),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exec::choices::Choices;
    use crate::exec::{Lineage, Rules};

    const MX: MathMode = MathMode { rules: Rules { lineage: Lineage::Mx, choices: Choices::NONE }, wrap: false };

    fn word(value: f32) -> (Number, bool) {
        fit_float(value, Width::Word, MX)
    }

    #[test]
    fn halves_go_to_even_and_limits_hold() {
        assert_eq!(word(2.5), (Number::Word(2), false));
        assert_eq!(word(3.5), (Number::Word(4), false));
        assert_eq!(word(-2.5), (Number::Word(-2), false));
        assert_eq!(word(32767.4), (Number::Word(32767), false));
        assert_eq!(word(32767.5), (Number::Word(32767), true), "the tie goes to 32768");
        assert_eq!(word(-32768.5), (Number::Word(-32768), false), "the tie goes to -32768");
        assert_eq!(word(-32769.0), (Number::Word(-32768), true));
        assert_eq!(word(f32::INFINITY), (Number::Word(32767), true));
        assert_eq!(word(f32::NEG_INFINITY), (Number::Word(-32768), true));
        assert_eq!(word(f32::NAN), (Number::Word(32767), true));
        let wrapping = MathMode { wrap: true, ..MX };
        assert_eq!(fit_float(40000.0, Width::Word, wrapping), (Number::Word(32767), true));
    }

    #[test]
    fn long_limits_hold() {
        let long = |value| fit_float(value, Width::Long, MX);
        assert_eq!(long(2_147_483_520.0), (Number::Long(2_147_483_520), false), "the last float below the limit");
        assert_eq!(long(2_147_483_648.0), (Number::Long(i32::MAX), true));
        assert_eq!(long(-2_147_483_648.0), (Number::Long(i32::MIN), false));
        assert_eq!(long(-2_147_483_904.0), (Number::Long(i32::MIN), true));
        assert_eq!(long(f32::NAN), (Number::Long(i32::MAX), true));
    }

    #[test]
    fn halves_can_be_read_otherwise() {
        for lineage in [Lineage::S3, Lineage::Mx] {
            let mode = Rules::new(lineage).with(Choice::FloatTiesAway).math(0);
            assert_eq!(fit_float(-2.5, Width::Word, mode).0, Number::Word(-3));
            assert_eq!(fit_float(3.0 - 0.5, Width::Word, mode).0, Number::Word(3));
        }
    }

    #[test]
    fn denormals_are_zero() {
        let tiny = f32::MIN_POSITIVE / 2.0;
        assert_eq!(Number::Float(tiny).float(), 0.0);
        assert!(Number::Float(-0.0).is_negative() && Number::Float(-0.0).is_zero());
        let nothing = fit_float(-f32::NAN, Width::Float, MX);
        assert!(matches!(nothing, (Number::Float(value), true) if value.to_bits() == 0x7FFF_FFFF));
        assert_eq!(fit_float(-tiny, Width::Float, MX), (Number::Float(0.0), false));
        assert!(matches!(fit_float(-tiny, Width::Float, MX).0, Number::Float(zero) if zero.is_sign_positive()));
    }

    #[test]
    fn integers_convert_both_ways() {
        assert_eq!(convert(Number::Long(70000), Width::Word, MX), (Number::Word(32767), true));
        let wrapping = MathMode { wrap: true, ..MX };
        assert_eq!(convert(Number::Long(70000), Width::Word, wrapping), (Number::Word(4464), true));
        assert_eq!(convert(Number::Word(-1), Width::Long, MX), (Number::Long(-1), false));
        assert_eq!(convert(Number::Long(16_777_217), Width::Float, MX), (Number::Float(16_777_216.0), false));
        assert_eq!(convert(Number::Float(f32::NAN), Width::Word, MX), (Number::Word(32767), true));
    }

    #[test]
    fn the_register_is_two_words() {
        assert_eq!(Register::of_long(-60000), Register { high: 0xFFFF, low: 0x15A0 });
        assert_eq!(Register { high: 0xFFFF, low: 0x15A0 }.long(), -60000);
    }
}
