//! SCL and SCP.

use super::choices::Choice;
use super::math::{self, limit, rounded_quotient, rounds_away};
use super::number::{Number, Outcome, Width, fit_integer};
use super::rules::MathMode;

/// SCL: source × rate / 10000, rounded, plus offset (printed).
///
/// SLC and MicroLogix 1000 check for overflow before and after the offset is added; a product above
/// 32767 stores 32767 whatever the offset (printed; the lower limit: inferred). MicroLogix 1100 to
/// 1500 round after adding and check once (printed for the 1100). The value stored at overflow is the
/// limit; S:2/14 is not among what is said to concern SCL. C is called reserved and is reset.
/// Floats, which no family's SCL takes, are computed as floats.
pub fn scl(source: Number, rate: Number, offset: Number, to: Width, mode: MathMode) -> Outcome {
    let (Some(x), Some(factor), Some(added)) = (source.integer(), rate.integer(), offset.integer()) else {
        return math::float(source.float() * rate.float() / 10_000.0 + offset.float(), to, mode);
    };
    // 32-bit operands multiply to at most 63 bits.
    let product = rounded_quotient(x * factor, 10_000, mode);
    let (limited, overflow) = fit_integer(product, to, false);
    if overflow && mode.rules.lineage.is_slc_like() {
        return Outcome::stored(limited, false, true);
    }
    let (value, overflow) = fit_integer(product.saturating_add(added), to, false);
    Outcome::stored(value, false, overflow)
}

/// The parameters of SCP, as the box names them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Input minimum, x0.
    pub input_min: Number,
    /// Input maximum, x1.
    pub input_max: Number,
    /// Scaled minimum, y0.
    pub scaled_min: Number,
    /// Scaled maximum, y1.
    pub scaled_max: Number,
}

/// SCP: y = (y1 - y0) / (x1 - x0) × (x - x0) + y0 (printed). The input range does not limit the input
/// (manual, unseen).
///
/// Integer parameters are computed exactly and rounded once; how halves go is open:
/// [`Choice::ScpTiesToEven`]. With a float among them the line is computed in single precision in the
/// order of the formula: a MicroLogix 1400 saved while it ran holds 0.21000001 for 560 / 16000 × 6,
/// where the product first, or a higher precision, gives 0.21 (seen once). Without a width, x1 = x0, V is set; what is stored is open:
/// [`Choice::ScpFlatKeeps`].
pub fn scp(input: Number, line: Line, to: Width, mode: MathMode) -> Outcome {
    let flat = || {
        let value = (!mode.rules.has(Choice::ScpFlatKeeps)).then(|| limit(to, false));
        let flags = value.map_or(super::Flags::OVERFLOW, |value| super::Flags::of(value, false, true));
        Outcome { value, flags, register: None }
    };
    let integers = (
        input.integer(),
        line.input_min.integer(),
        line.input_max.integer(),
        line.scaled_min.integer(),
        line.scaled_max.integer(),
    );
    if let (Some(x), Some(x0), Some(x1), Some(y0), Some(y1)) = integers
        && (to != Width::Float || mode.rules.has(Choice::FloatDestinationConverts))
    {
        if x1 == x0 {
            return flat();
        }
        let quotient = nearest(i128::from(y1 - y0) * i128::from(x - x0), i128::from(x1 - x0), mode);
        let value = i64::try_from(quotient).unwrap_or(if quotient < 0 { i64::MIN } else { i64::MAX });
        return math::integer(value.saturating_add(y0), false, to, mode);
    }
    let [x, x0, x1, y0, y1] =
        [input, line.input_min, line.input_max, line.scaled_min, line.scaled_max].map(Number::float);
    if x1 == x0 {
        return flat();
    }
    math::float((y1 - y0) / (x1 - x0) * (x - x0) + y0, to, mode)
}

/// The quotient rounded to the nearest integer; `divisor` is not 0.
fn nearest(dividend: i128, divisor: i128, mode: MathMode) -> i128 {
    let (Some(quotient), Some(remainder)) = (dividend.checked_div(divisor), dividend.checked_rem(divisor)) else {
        return 0;
    };
    let half_away = !mode.rules.has(Choice::ScpTiesToEven) || quotient % 2 != 0;
    let away = rounds_away(remainder.unsigned_abs(), divisor.unsigned_abs(), half_away);
    quotient + i128::from(away) * if (dividend < 0) != (divisor < 0) { -1 } else { 1 }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::exec::{Flags, Lineage, Rules};

    fn w(value: i16) -> Number {
        Number::Word(value)
    }

    fn words(lineage: Lineage, source: i16, rate: i16, offset: i16) -> (Option<Number>, Flags) {
        let outcome = scl(w(source), w(rate), w(offset), Width::Word, Rules::new(lineage).math(0x4000));
        (outcome.value, outcome.flags)
    }

    fn line(x0: i16, x1: i16, y0: i16, y1: i16) -> Line {
        Line { input_min: w(x0), input_max: w(x1), scaled_min: w(y0), scaled_max: w(y1) }
    }

    fn mx() -> MathMode {
        Rules::new(Lineage::Mx).math(0)
    }

    #[test]
    fn scale_printed_numbers() {
        assert_eq!(words(Lineage::S2, 100, 25000, 127), (Some(w(377)), Flags::NONE));
        assert_eq!(words(Lineage::M10, 20000, 20000, -10000), (Some(w(32767)), Flags::OVERFLOW));
        assert_eq!(words(Lineage::Mx, 20000, 20000, -10000), (Some(w(30000)), Flags::NONE));
        assert_eq!(words(Lineage::M10, -20000, 20000, 10000), (Some(w(-32768)), Flags::OVERFLOW | Flags::SIGN));
        assert_eq!(words(Lineage::S3, 32767, 10000, 1), (Some(w(32767)), Flags::OVERFLOW));
        assert_eq!(words(Lineage::Mx, 1, 5000, 0), (Some(w(1)), Flags::NONE), "half goes up");
        assert_eq!(words(Lineage::Mx, -1, 5000, 0), (Some(w(-1)), Flags::SIGN));
        assert_eq!(words(Lineage::Mx, 1, 4999, 0), (Some(w(0)), Flags::ZERO));
    }

    #[test]
    fn scale_in_single_precision() {
        let f = |value: f32| Number::Float(value);
        let line = Line { input_min: f(4000.0), input_max: f(20000.0), scaled_min: f(0.0), scaled_max: w(560) };
        let outcome = scp(w(4006), line, Width::Float, mx());
        assert_eq!(outcome.value, Some(f(f32::from_bits(0x3E57_0A3E))), "as a running controller had stored it");
    }

    #[test]
    fn scale_with_parameters() {
        let at = |x: i16, l: Line| scp(w(x), l, Width::Word, mx());
        assert_eq!(at(250, line(0, 1000, 0, 200)).value, Some(w(50)));
        assert_eq!(at(1500, line(0, 1000, 0, 200)).value, Some(w(300)), "the input is not limited");
        assert_eq!(at(-250, line(0, 1000, 0, 200)).value, Some(w(-50)));
        assert_eq!(at(250, line(1000, 0, 0, 200)).value, Some(w(150)));
        assert_eq!(at(32767, line(0, 1, 0, 2)).flags, Flags::OVERFLOW);
        let halves = [1, 3, -1, -3].map(|x| at(x, line(0, 2, 0, 1)).value);
        assert_eq!(halves, [1, 2, -1, -2].map(|y| Some(w(y))));
        let even = mx().rules.with(Choice::ScpTiesToEven).math(0);
        let halves = [1, 3, -1, -3].map(|x| scp(w(x), line(0, 2, 0, 1), Width::Word, even).value);
        assert_eq!(halves, [0, 2, 0, -2].map(|y| Some(w(y))));
    }

    #[test]
    fn a_line_without_width() {
        let outcome = scp(w(5), line(7, 7, 0, 100), Width::Word, mx());
        assert_eq!((outcome.value, outcome.flags), (Some(w(32767)), Flags::OVERFLOW));
        let keeps = mx().rules.with(Choice::ScpFlatKeeps).math(0);
        let outcome = scp(w(5), line(7, 7, 0, 100), Width::Word, keeps);
        assert_eq!((outcome.value, outcome.flags), (None, Flags::OVERFLOW));
        let float = Line { input_min: Number::Float(1.0), ..line(0, 1, 0, 100) };
        assert!(scp(w(5), float, Width::Float, mx()).flags.has(Flags::OVERFLOW));
    }

    #[test]
    fn floats_scale() {
        let float = Line { scaled_max: Number::Float(0.5), ..line(0, 4, 0, 0) };
        assert_eq!(scp(w(1), float, Width::Float, mx()).value, Some(Number::Float(0.125)));
        assert_eq!(scp(w(1), line(0, 4, 0, 1), Width::Float, mx()).value, Some(Number::Float(0.25)));
        let not = Line { scaled_max: Number::Float(f32::NAN), ..line(0, 4, 0, 0) };
        assert!(scp(w(1), not, Width::Word, mx()).flags.has(Flags::OVERFLOW));
    }

    proptest! {
        #[test]
        fn ends_of_the_line_are_exact(x0: i16, x1: i16, y0: i16, y1: i16) {
            prop_assume!(x0 != x1);
            prop_assert_eq!(scp(w(x0), line(x0, x1, y0, y1), Width::Word, mx()).value, Some(w(y0)));
            prop_assert_eq!(scp(w(x1), line(x0, x1, y0, y1), Width::Word, mx()).value, Some(w(y1)));
        }

        #[test]
        fn never_panics(x: i32, x0: i32, x1: i32, y0: i32, y1: i32) {
            let long = Number::Long;
            let l = Line { input_min: long(x0), input_max: long(x1), scaled_min: long(y0), scaled_max: long(y1) };
            let exact = scp(long(x), l, Width::Long, mx());
            prop_assert!(exact.value.is_some());
            let _ = scl(long(x), long(x0), long(x1), Width::Long, mx());
            prop_assert!(scl(long(x), long(x0), Number::Float(f32::from_bits(y0 as u32)), Width::Word, mx()).value.is_some());
        }

        #[test]
        fn a_rising_line_never_falls(x in -32768_i16..32767, span in 1_i16..1000, rise in 0_i16..1000) {
            let l = line(0, span, 0, rise);
            let value = |x| match scp(w(x), l, Width::Long, mx()).value {
                Some(Number::Long(value)) => value,
                _ => i32::MIN,
            };
            prop_assert!(value(x) <= value(x + 1));
        }
    }
}
