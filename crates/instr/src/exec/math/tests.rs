//! Printed numbers of the arithmetic instructions, their limits, and laws that hold for all values.

use proptest::prelude::*;

use super::*;
use crate::exec::{Lineage, Rules};

fn mode(lineage: Lineage, wrap: bool) -> MathMode {
    Rules::new(lineage).math(if wrap { 0x4000 } else { 0 })
}

const CV: Flags = Flags::new(true, true, false, false);

fn w(value: i16) -> Number {
    Number::Word(value)
}

fn words(op: fn(Number, Number, Width, MathMode) -> Outcome, a: i16, b: i16, wrap: bool) -> Outcome {
    op(w(a), w(b), Width::Word, mode(Lineage::M10, wrap))
}

fn result(outcome: Outcome) -> (i16, Flags) {
    match outcome.value {
        Some(Number::Word(value)) => (value, outcome.flags),
        other => panic!("not a word: {other:?}"),
    }
}

fn register(high: u16, low: u16) -> Option<Register> {
    Some(Register { high, low })
}

#[test]
fn add_limits_or_wraps_and_carries_unsigned() {
    assert_eq!(result(words(add, 32767, 1, false)), (32767, Flags::OVERFLOW));
    assert_eq!(result(words(add, 32767, 1, true)), (-32768, Flags::OVERFLOW | Flags::SIGN));
    assert_eq!(result(words(add, -1, 1, false)), (0, Flags::CARRY | Flags::ZERO));
    assert_eq!(result(words(add, -32768, -1, false)), (-32768, CV | Flags::SIGN));
    assert_eq!(result(words(add, -32768, -1, true)), (32767, CV));
    let fixed = add(w(32767), w(1), Width::Word, Rules::new(Lineage::S1).math(0x4000));
    assert_eq!(result(fixed), (32767, Flags::OVERFLOW), "no overflow selection");
    assert_eq!(words(add, 1, 1, false).register, None);
}

#[test]
fn sub_limits_and_borrows_unsigned() {
    assert_eq!(result(words(sub, -32768, 1, false)), (-32768, Flags::OVERFLOW | Flags::SIGN));
    assert_eq!(result(words(sub, -32768, 1, true)), (32767, Flags::OVERFLOW));
    assert_eq!(result(words(sub, 0, 1, false)), (-1, Flags::CARRY | Flags::SIGN));
    assert_eq!(result(words(sub, 5, 5, false)), (0, Flags::ZERO));
    assert_eq!(result(words(sub, 32767, -1, false)), (32767, CV));
}

#[test]
fn a_long_sum_out_of_words() {
    // By the rungs printed for S:2/14 = 1: low words, carry into the high word, sign of the addend.
    let long_add = |addend: i16, high: i16, low: i16| {
        let (low, flags) = result(words(add, addend, low, true));
        let carried = if flags.has(Flags::CARRY) { result(words(add, 1, high, true)).0 } else { high };
        let high = if addend < 0 { result(words(sub, carried, 1, true)).0 } else { carried };
        (high as u16, low as u16)
    };
    assert_eq!(long_add(0x55A8, 0x0003, 0x1940), (0x0003, 0x6EE8), "203072 + 21928 = 225000, printed");
    for (addend, start) in [(-1, 65536), (1, 65535), (-32768, 0), (32767, -1), (-5, 3)] {
        let register = Register::of_long(start);
        let sum = long_add(addend, register.high as i16, register.low as i16);
        let expected = Register::of_long(start + i32::from(addend));
        assert_eq!(sum, (expected.high, expected.low), "{start} + {addend}");
    }
}

#[test]
fn mul_keeps_the_product_in_the_register() {
    let overflown = words(mul, 200, 200, false);
    assert_eq!((result(overflown), overflown.register), ((32767, Flags::OVERFLOW), register(0, 0x9C40)));
    let cut = words(mul, 200, 200, true);
    assert_eq!((result(cut), cut.register), ((-25536, Flags::OVERFLOW | Flags::SIGN), register(0, 0x9C40)));
    let negative = words(mul, 300, -200, false);
    assert_eq!(result(negative), (-32768, Flags::OVERFLOW | Flags::SIGN));
    assert_eq!(negative.register, register(0xFFFF, 0x15A0));
    let cut = words(mul, 300, -200, true);
    assert_eq!((result(cut).0, cut.register), (5536, register(0xFFFF, 0x15A0)));
    assert_eq!(result(words(mul, 0, 60, false)), (0, Flags::ZERO));
    assert_eq!(words(mul, -32768, -32768, false).register, register(0x4000, 0));
}

#[test]
fn div_rounds_and_keeps_quotient_and_remainder() {
    for (a, b, rounded, quotient, remainder) in
        [(11, 2, 6, 5, 1), (10, 4, 3, 2, 2), (9, 4, 2, 2, 1), (100, 100, 1, 1, 0), (6214, 19, 327, 327, 1)]
    {
        let outcome = words(div, a, b, false);
        assert_eq!((result(outcome).0, outcome.register), (rounded, register(quotient, remainder)), "{a} / {b}");
    }
    let negative = words(div, -11, 2, false);
    assert_eq!((result(negative).0, negative.register), (-6, register(-5_i16 as u16, -1_i16 as u16)));
    let towards_zero = Rules::new(Lineage::M10).with(Choice::DivHalfTowardsZero).math(0);
    assert_eq!(div(w(-11), w(2), Width::Word, towards_zero).value, Some(w(-5)));
    assert_eq!(div(w(11), w(2), Width::Word, towards_zero).value, Some(w(6)));
    assert_eq!(div(w(-10), w(3), Width::Word, towards_zero).value, Some(w(-3)));
    assert_eq!(div(w(-11), w(3), Width::Word, towards_zero).value, Some(w(-4)));
}

#[test]
fn div_by_zero_and_the_one_overflow() {
    for (dividend, wrap) in [(100, false), (100, true), (-100, false), (0, false)] {
        let outcome = words(div, dividend, 0, wrap);
        assert_eq!((result(outcome), outcome.register), ((32767, Flags::OVERFLOW), None));
    }
    let signed = Rules::new(Lineage::M10).with(Choice::DivideByZeroSigned).math(0);
    assert_eq!(div(w(-100), w(0), Width::Word, signed).value, Some(w(-32768)));
    assert_eq!(result(words(div, -32768, -1, false)), (32767, Flags::OVERFLOW));
    assert_eq!(result(words(div, -32768, -1, true)), (-32768, Flags::OVERFLOW | Flags::SIGN));
    let long = div(Number::Long(7), Number::Long(0), Width::Long, mode(Lineage::Mx, true));
    assert_eq!((long.value, long.flags), (Some(Number::Long(i32::MAX)), Flags::OVERFLOW));
}

#[test]
fn double_divide() {
    let m10 = mode(Lineage::M10, false);
    let outcome = ddv(Register { high: 0, low: 0x9C40 }, 100, m10);
    assert_eq!((result(outcome), outcome.register), ((400, Flags::NONE), register(400, 0)));
    let rounded = ddv(Register::of_long(-100_001), 1000, m10);
    assert_eq!((result(rounded), rounded.register), ((-100, Flags::SIGN), register(-100_i16 as u16, -1_i16 as u16)));
    for (dividend, divisor) in [(1, 0), (32768, 1), (-32769, 1), (-65536, 1), (i32::MIN, -1)] {
        let outcome = ddv(Register::of_long(dividend), divisor, mode(Lineage::S3, true));
        assert_eq!((result(outcome), outcome.register), ((32767, Flags::OVERFLOW), None), "{dividend} / {divisor}");
    }
    assert_eq!(result(ddv(Register::of_long(-32768), 1, m10)), (-32768, Flags::SIGN));
}

#[test]
fn sign_changes() {
    let one = |op: fn(Number, Width, MathMode) -> Outcome, a: i16, wrap| {
        result(op(w(a), Width::Word, mode(Lineage::S3, wrap)))
    };
    assert_eq!(one(neg, 5, false), (-5, Flags::CARRY | Flags::SIGN));
    assert_eq!(one(neg, -5, false), (5, Flags::CARRY));
    assert_eq!(one(neg, 0, false), (0, Flags::ZERO));
    assert_eq!(one(neg, -32768, false), (32767, Flags::OVERFLOW));
    assert_eq!(one(neg, -32768, true), (-32768, Flags::OVERFLOW | Flags::SIGN));
    assert_eq!(one(abs, -5, false), (5, Flags::NONE));
    assert_eq!(one(abs, -32768, false), (32767, Flags::OVERFLOW));
    assert_eq!(one(abs, -32768, true), (-32768, Flags::OVERFLOW | Flags::SIGN));
    let mx = abs(w(-5), Width::Word, mode(Lineage::Mx, false));
    assert_eq!(result(mx), (5, Flags::CARRY), "the MicroLogix 1100 tells a negative source");
    let bits = abs(Number::Float(f32::from_bits(0xFFC1_2345)), Width::Float, mode(Lineage::Mx, false));
    assert!(matches!(bits.value, Some(Number::Float(value)) if value.to_bits() == 0x7FC1_2345));
    assert_eq!(clr(Width::Word), Outcome { value: Some(w(0)), flags: Flags::ZERO, register: None });
}

#[test]
fn square_roots() {
    let root = |source: Number, to| sqr(source, to, mode(Lineage::Mx, false));
    for (source, expected) in
        [(0, 0), (1, 1), (2, 1), (3, 2), (6, 2), (7, 3), (25, 5), (-25, 5), (32767, 181), (-32768, 181)]
    {
        assert_eq!(root(w(source), Width::Word).value, Some(w(expected)), "{source}");
    }
    assert_eq!(root(w(0), Width::Word).flags, Flags::ZERO);
    assert_eq!(root(Number::Long(i32::MIN), Width::Long).value, Some(Number::Long(46341)));
    assert_eq!(root(Number::Long(i32::MIN), Width::Word).flags, Flags::OVERFLOW);
    assert_eq!(root(Number::Float(-2.25), Width::Float).value, Some(Number::Float(1.5)));
    assert_eq!(root(Number::Float(6.25), Width::Word).value, Some(w(2)), "2.5 to the even integer");
    assert_eq!(root(w(2), Width::Float).value, Some(Number::Float(2.0_f32.sqrt())));
}

#[test]
fn floats_and_mixtures() {
    let mx = mode(Lineage::Mx, true);
    let sum = add(Number::Float(40000.0), Number::Float(0.0), Width::Word, mx);
    assert_eq!((sum.value, sum.flags), (Some(w(32767)), Flags::OVERFLOW), "limited although S:2/14 is 1");
    assert_eq!(div(w(10), w(4), Width::Float, mx).value, Some(Number::Float(2.5)));
    let converting = mx.rules.with(Choice::FloatDestinationConverts).math(0);
    assert_eq!(div(w(10), w(4), Width::Float, converting).value, Some(Number::Float(3.0)));
    let float = mul(Number::Float(1.5), w(3), Width::Word, mx);
    assert_eq!((float.value, float.register), (Some(w(4)), None), "4.5 to the even integer, no register");
    let infinite = mul(Number::Float(f32::MAX), Number::Float(-2.0), Width::Float, mx);
    assert_eq!(
        (infinite.value, infinite.flags),
        (Some(Number::Float(f32::NEG_INFINITY)), Flags::OVERFLOW | Flags::SIGN)
    );
    let nothing = add(Number::Float(f32::NAN), w(1), Width::Float, mx);
    assert!(matches!(nothing.value, Some(Number::Float(value)) if value.is_nan()));
    let small = mul(Number::Float(f32::MIN_POSITIVE), Number::Float(-0.5), Width::Float, mx);
    assert!(matches!(small.value, Some(Number::Float(value)) if value == 0.0 && value.is_sign_positive()));
    assert_eq!(small.flags, Flags::ZERO);
    let by_zero = div(Number::Float(-1.0), w(0), Width::Float, mx);
    assert_eq!((by_zero.value, by_zero.flags), (Some(Number::Float(f32::NEG_INFINITY)), Flags::OVERFLOW | Flags::SIGN));
    assert_eq!(div(Number::Float(0.0), w(0), Width::Word, mx).flags, Flags::OVERFLOW);
}

#[test]
fn long_words() {
    let mx = |wrap| mode(Lineage::Mx, wrap);
    let long = Number::Long;
    let sum = add(long(i32::MAX), w(1), Width::Long, mx(false));
    assert_eq!((sum.value, sum.flags), (Some(long(i32::MAX)), Flags::OVERFLOW));
    assert_eq!(add(long(i32::MAX), w(1), Width::Long, mx(true)).value, Some(long(i32::MIN)));
    let carried = add(long(-1), w(1), Width::Long, mx(false));
    assert_eq!(carried.flags, Flags::CARRY | Flags::ZERO);
    let product = mul(w(30000), w(30000), Width::Long, mx(false));
    assert_eq!((product.value, product.register), (Some(long(900_000_000)), None));
    assert_eq!(mul(long(i32::MIN), long(i32::MIN), Width::Long, mx(false)).value, Some(long(i32::MAX)));
    assert_eq!(div(long(1_000_001), w(2), Width::Long, mx(false)).value, Some(long(500_001)));
    assert_eq!(div(long(100_000), w(2), Width::Word, mx(false)).flags, Flags::OVERFLOW);
}

proptest! {
    #[test]
    fn short_cuts_agree(a: i16, b: i16, wrap: bool) {
        let mode = mode(Lineage::S3, wrap);
        prop_assert_eq!(result(add(w(a), w(b), Width::Word, mode)), add_words(a, b, mode));
        prop_assert_eq!(result(sub(w(a), w(b), Width::Word, mode)), sub_words(a, b, mode));
    }

    #[test]
    fn register_restores_the_operands(a: i16, b: i16) {
        let product = words(mul, a, b, false).register.map(Register::long);
        prop_assert_eq!(product, Some(i32::from(a) * i32::from(b)));
        if b != 0 {
            let divided = words(div, a, b, false).register.unwrap_or(Register::of_long(0));
            // -32768 / -1 has a quotient of 32768, which 16 bits hold as unsigned only.
            let quotient = if (a, b) == (i16::MIN, -1) { 32768 } else { i32::from(divided.high as i16) };
            prop_assert_eq!(quotient * i32::from(b) + i32::from(divided.low as i16), i32::from(a));
        }
    }

    #[test]
    fn nothing_panics(bits_a: u32, bits_b: u32, kinds in 0_u8..27, s2: u16) {
        let kind = |n: u8, bits: u32| match n % 3 {
            0 => w(bits as i16),
            1 => Number::Long(bits as i32),
            _ => Number::Float(f32::from_bits(bits)),
        };
        let (a, b) = (kind(kinds, bits_a), kind(kinds / 3, bits_b));
        let to = [Width::Word, Width::Long, Width::Float][usize::from(kinds / 9)];
        let mode = Rules::new(Lineage::Mx).math(s2);
        for op in [add, sub, mul, div] {
            let outcome = op(a, b, to, mode);
            prop_assert_eq!(outcome.value.map(Number::width), Some(to));
        }
        for op in [neg, abs, sqr] {
            prop_assert_eq!(op(a, to, mode).value.map(Number::width), Some(to));
        }
        let _ = ddv(Register::of_long(bits_a as i32), bits_b as i16, mode);
    }
}
