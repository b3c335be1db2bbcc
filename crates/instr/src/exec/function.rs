//! SIN, COS, TAN, ASN, ACS, ATN, LN, LOG, XPY, DEG and RAD.
//!
//! The operands become floats, the result is converted to the kind of the destination (printed for
//! the MicroLogix 1400). A source that is no finite number gives not-a-number, or the upper limit of
//! an integer destination, and V (printed there). C is reset, Z and S follow the stored value.
//!
//! The last bit of a result depends on the controller's mathematical library, which nobody documents:
//! here each function is computed in double precision by code that gives the same bits on every
//! machine, and rounded once.

use super::math;
use super::number::{NOT_A_NUMBER, Number, Outcome, Width};
use super::rules::MathMode;
use super::{Flags, number};

/// A function of one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Function {
    /// SIN of an angle in radians.
    Sine,
    /// COS of an angle in radians.
    Cosine,
    /// TAN of an angle in radians.
    Tangent,
    /// ASN: the angle from -π/2 to π/2. A source beyond -1 to 1 is not supported: V (printed).
    ArcSine,
    /// ACS: the angle from 0 to π. A source beyond -1 to 1 is not supported: V (printed).
    ArcCosine,
    /// ATN: the angle between -π/2 and π/2.
    ArcTangent,
    /// LN. A source of 0 or below is not supported: V (manual, unseen). The value stored is open:
    /// minus infinity for 0, not-a-number below, or the limit of an integer destination.
    NaturalLog,
    /// LOG to base 10, with the limits of LN.
    Log10,
    /// DEG: radians to degrees.
    Degrees,
    /// RAD: degrees to radians.
    Radians,
}

impl Function {
    /// The function of a mnemonic.
    pub fn by_mnemonic(mnemonic: &str) -> Option<Function> {
        Some(match mnemonic {
            "SIN" => Function::Sine,
            "COS" => Function::Cosine,
            "TAN" => Function::Tangent,
            "ASN" => Function::ArcSine,
            "ACS" => Function::ArcCosine,
            "ATN" => Function::ArcTangent,
            "LN" => Function::NaturalLog,
            "LOG" => Function::Log10,
            "DEG" => Function::Degrees,
            "RAD" => Function::Radians,
            _ => return None,
        })
    }

    fn value(self, x: f64) -> f64 {
        match self {
            Function::Sine => libm::sin(x),
            Function::Cosine => libm::cos(x),
            Function::Tangent => libm::tan(x),
            Function::ArcSine => libm::asin(x),
            Function::ArcCosine => libm::acos(x),
            Function::ArcTangent => libm::atan(x),
            Function::NaturalLog => libm::log(x),
            Function::Log10 => libm::log10(x),
            Function::Degrees => x * (180.0 / std::f64::consts::PI),
            Function::Radians => x * (std::f64::consts::PI / 180.0),
        }
    }
}

/// The function of the source.
pub fn apply(function: Function, source: Number, to: Width, mode: MathMode) -> Outcome {
    let x = source.float();
    let result = if x.is_finite() { function.value(f64::from(x)) as f32 } else { NOT_A_NUMBER };
    math::float(result, to, mode)
}

/// XPY: A to the power of B. A negative base needs a whole exponent: with another one V is set and the
/// absolute value of the base is used (printed).
///
/// The SLC manual gives 2^(B × log2 A) as the algorithm and lets an overflow on the way set V; so 0 to
/// a negative power is infinite with V, while 0 to the power of 0 is taken as 1 (open).
pub fn xpy(a: Number, b: Number, to: Width, mode: MathMode) -> Outcome {
    let (base, exponent) = (a.float(), b.float());
    if !base.is_finite() || !exponent.is_finite() {
        return math::float(NOT_A_NUMBER, to, mode);
    }
    let unsupported = base < 0.0 && exponent.fract() != 0.0;
    let base = if unsupported { base.abs() } else { base };
    let result = libm::pow(f64::from(base), f64::from(exponent)) as f32;
    let (value, overflow) = number::fit_float(result, to, mode);
    Outcome { value: Some(value), flags: Flags::of(value, false, overflow || unsupported), register: None }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::exec::{Lineage, Rules};

    fn mode() -> MathMode {
        Rules::new(Lineage::Mx).math(0)
    }

    fn float(function: &str, x: f32) -> (f32, Flags) {
        let function = Function::by_mnemonic(function).unwrap_or(Function::Sine);
        let outcome = apply(function, Number::Float(x), Width::Float, mode());
        match outcome.value {
            Some(Number::Float(value)) => (value, outcome.flags),
            other => panic!("not a float: {other:?}"),
        }
    }

    #[test]
    fn known_values() {
        use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, LN_10, PI};
        assert_eq!(float("SIN", FRAC_PI_2), (1.0, Flags::NONE));
        assert_eq!(float("SIN", 0.0), (0.0, Flags::ZERO));
        assert_eq!(float("COS", PI), (-1.0, Flags::SIGN));
        assert_eq!(float("TAN", FRAC_PI_4).0, 1.0);
        assert_eq!(float("ASN", -1.0), (-FRAC_PI_2, Flags::SIGN));
        assert_eq!(float("ACS", -1.0), (PI, Flags::NONE));
        assert_eq!(float("ATN", 1.0).0, FRAC_PI_4);
        assert_eq!(float("LN", 10.0).0, LN_10);
        assert_eq!(float("LOG", 1000.0).0, 3.0);
        assert_eq!(float("LOG", 1.0), (0.0, Flags::ZERO));
        assert_eq!(float("DEG", PI).0, 180.0);
        assert_eq!(float("RAD", 180.0).0, PI);
        assert!(Function::by_mnemonic("XPY").is_none());
    }

    #[test]
    fn unsupported_sources() {
        for (function, x) in [("ASN", 1.5), ("ACS", -1.5), ("LN", -1.0), ("LOG", -1.0), ("SIN", f32::INFINITY)] {
            let (value, flags) = float(function, x);
            assert_eq!((value.to_bits(), flags), (0x7FFF_FFFF, Flags::OVERFLOW), "{function} {x}");
        }
        assert_eq!(float("LN", 0.0), (f32::NEG_INFINITY, Flags::OVERFLOW | Flags::SIGN));
        assert_eq!(float("RAD", f32::NAN).1, Flags::OVERFLOW);
        let word = apply(Function::ArcSine, Number::Word(2), Width::Word, mode());
        assert_eq!((word.value, word.flags), (Some(Number::Word(32767)), Flags::OVERFLOW));
    }

    #[test]
    fn integers_round() {
        let word = |f, x| apply(f, Number::Word(x), Width::Word, mode()).value;
        assert_eq!(word(Function::Degrees, 1), Some(Number::Word(57)));
        assert_eq!(word(Function::Degrees, 32767), Some(Number::Word(32767)));
        assert_eq!(word(Function::Degrees, -32767), Some(Number::Word(-32768)));
        assert_eq!(word(Function::NaturalLog, 0), Some(Number::Word(-32768)));
    }

    #[test]
    fn powers() {
        let power = |a: f32, b: f32| {
            let outcome = xpy(Number::Float(a), Number::Float(b), Width::Float, mode());
            (outcome.value, outcome.flags)
        };
        assert_eq!(power(2.0, 3.0), (Some(Number::Float(8.0)), Flags::NONE));
        assert_eq!(power(-2.0, 3.0), (Some(Number::Float(-8.0)), Flags::SIGN));
        assert_eq!(power(-4.0, 0.5), (Some(Number::Float(2.0)), Flags::OVERFLOW));
        assert_eq!(power(0.0, -1.0), (Some(Number::Float(f32::INFINITY)), Flags::OVERFLOW));
        assert_eq!(power(0.0, 0.0), (Some(Number::Float(1.0)), Flags::NONE));
        assert_eq!(power(10.0, 39.0), (Some(Number::Float(f32::INFINITY)), Flags::OVERFLOW));
        assert_eq!(power(10.0, -60.0), (Some(Number::Float(0.0)), Flags::ZERO));
        assert!(power(f32::NAN, 1.0).1.has(Flags::OVERFLOW));
        let words = xpy(Number::Word(2), Number::Word(3), Width::Word, mode());
        assert_eq!(words.value, Some(Number::Word(8)));
        let large = xpy(Number::Word(2), Number::Word(15), Width::Word, mode());
        assert_eq!((large.value, large.flags), (Some(Number::Word(32767)), Flags::OVERFLOW));
    }

    proptest! {
        #[test]
        fn any_bits_have_a_result(bits: u32, other: u32) {
            let (a, b) = (Number::Float(f32::from_bits(bits)), Number::Float(f32::from_bits(other)));
            prop_assert!(xpy(a, b, Width::Word, mode()).value.is_some());
            for name in ["SIN", "COS", "TAN", "ASN", "ACS", "ATN", "LN", "LOG", "DEG", "RAD"] {
                let function = Function::by_mnemonic(name).unwrap_or(Function::Sine);
                prop_assert!(apply(function, a, Width::Long, mode()).value.is_some());
            }
        }
    }
}
