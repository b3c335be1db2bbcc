//! EQU, NEQ, LES, LEQ, GRT, GEQ, MEQ and LIM. None of them touches the flags (manual, unseen).
//!
//! Operands of different kinds are widened to the largest: words to long words (printed), integers
//! to floats (manual, unseen). Not-a-number differs from everything and is neither above nor below
//! anything (open).

use std::cmp::Ordering;

use super::Number;

/// The order of two values; `None` when one of them is not a number.
#[inline]
pub fn order(a: Number, b: Number) -> Option<Ordering> {
    match (a, b) {
        (Number::Word(a), Number::Word(b)) => Some(a.cmp(&b)),
        _ => match (a.integer(), b.integer()) {
            (Some(a), Some(b)) => Some(a.cmp(&b)),
            _ => a.float().partial_cmp(&b.float()),
        },
    }
}

/// EQU: A = B.
#[inline]
pub fn equ(a: Number, b: Number) -> bool {
    order(a, b) == Some(Ordering::Equal)
}

/// NEQ: A ≠ B; true when one of them is not a number.
#[inline]
pub fn neq(a: Number, b: Number) -> bool {
    !equ(a, b)
}

/// LES: A < B.
#[inline]
pub fn les(a: Number, b: Number) -> bool {
    order(a, b) == Some(Ordering::Less)
}

/// LEQ: A ≤ B.
#[inline]
pub fn leq(a: Number, b: Number) -> bool {
    order(a, b).is_some_and(Ordering::is_le)
}

/// GRT: A > B.
#[inline]
pub fn grt(a: Number, b: Number) -> bool {
    order(a, b) == Some(Ordering::Greater)
}

/// GEQ: A ≥ B.
#[inline]
pub fn geq(a: Number, b: Number) -> bool {
    order(a, b).is_some_and(Ordering::is_ge)
}

/// MEQ: source and compare agree in every bit that is 1 in the mask (manual, unseen). Words are
/// sign-extended by the caller when a long word takes part.
#[inline]
pub const fn meq(source: u32, mask: u32, compare: u32) -> bool {
    (source ^ compare) & mask == 0
}

/// LIM: with low ≤ high, low ≤ test ≤ high; with low > high, test ≥ low or test ≤ high (printed, with
/// numbers, in the SLC manual). Limits that have no order make it false (open).
#[inline]
pub fn lim(low: Number, test: Number, high: Number) -> bool {
    match order(low, high) {
        Some(Ordering::Greater) => geq(test, low) || leq(test, high),
        Some(_) => leq(low, test) && leq(test, high),
        None => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn w(value: i16) -> Number {
        Number::Word(value)
    }

    #[test]
    fn limit_test_printed_numbers() {
        let inside = [5, 7, 8, 4, 9].map(|test| lim(w(5), w(test), w(8)));
        assert_eq!(inside, [true, true, true, false, false]);
        let outside = [5, 6, 7, 8, -32768].map(|test| lim(w(8), w(test), w(5)));
        assert_eq!(outside, [true, false, false, true, true]);
        assert!(lim(w(3), w(3), w(3)) && !lim(w(3), w(4), w(3)));
    }

    #[test]
    fn masked_equal() {
        assert!(meq(0x555F, 0xFF00, 0x5500));
        assert!(!meq(0x555F, 0xFFF0, 0x5500));
        assert!(meq(0x1234, 0, 0xFFFF));
        assert!(!meq(0x8000_0000, 0x8000_0000, 0));
    }

    #[test]
    fn kinds_are_widened() {
        assert!(equ(w(-1), Number::Long(-1)) && les(w(32767), Number::Long(32768)));
        assert!(equ(w(2), Number::Float(2.0)) && grt(Number::Float(2.5), w(2)));
        assert!(equ(Number::Long(16_777_217), Number::Float(16_777_216.0)), "the integer becomes a float");
        assert!(equ(Number::Float(-0.0), w(0)));
        assert!(equ(Number::Long(16_777_217), Number::Long(16_777_217)));
        assert!(neq(Number::Long(16_777_217), Number::Long(16_777_216)));
    }

    #[test]
    fn nothing_equals_not_a_number() {
        let nan = Number::Float(f32::NAN);
        assert!(neq(nan, nan) && neq(nan, w(0)));
        for test in [equ, les, leq, grt, geq] {
            assert!(!test(nan, w(0)) && !test(w(0), nan));
        }
        assert!(!lim(w(0), nan, w(1)) && !lim(nan, w(0), w(1)) && !lim(w(1), nan, w(0)));
    }

    #[test]
    fn signs_count() {
        assert!(les(w(-32768), w(32767)) && leq(w(-1), w(-1)) && geq(w(0), w(-1)) && grt(w(0), w(-1)));
    }
}
