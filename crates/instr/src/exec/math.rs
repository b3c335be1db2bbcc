//! ADD, SUB, MUL, DIV, DDV, NEG, CLR, ABS and SQR.
//!
//! Any float among the operands makes the operation a float one (printed for the MicroLogix 1100),
//! the destination included; [`Choice::FloatDestinationConverts`] reads that narrower. Integer
//! results are exact before they are put into the destination. Z and S are those of the stored value.

use std::cmp::Ordering;
use std::ops::Sub;

use super::choices::Choice;
use super::flags::Flags;
use super::number::{Number, Outcome, Register, Width, fit_float, fit_integer};
use super::rules::MathMode;

/// The operands as integers, if the operation is an integer one.
#[inline]
fn integers<const N: usize>(operands: [Number; N], to: Width, mode: MathMode) -> Option<[i64; N]> {
    if to == Width::Float && !mode.rules.has(Choice::FloatDestinationConverts) {
        return None;
    }
    let mut values = [0; N];
    for (value, operand) in values.iter_mut().zip(operands) {
        *value = operand.integer()?;
    }
    Some(values)
}

#[inline]
pub(super) fn integer(result: i64, carry: bool, to: Width, mode: MathMode) -> Outcome {
    let (value, overflow) = fit_integer(result, to, mode.wrap);
    Outcome::stored(value, carry, overflow)
}

#[inline]
pub(super) fn float(result: f32, to: Width, mode: MathMode) -> Outcome {
    let (value, overflow) = fit_float(result, to, mode);
    Outcome::stored(value, false, overflow)
}

/// Low bits of both operands at the width carries are counted in: that of the destination (inferred:
/// the flag is documented as in unsigned arithmetic, without a word on mixed widths).
#[inline]
fn unsigned(a: i64, b: i64, to: Width) -> (u64, u64, u64) {
    let mask = if to == Width::Word { 0xFFFF } else { 0xFFFF_FFFF };
    (a as u64 & mask, b as u64 & mask, mask)
}

/// ADD: A + B. C is the unsigned carry (printed: the flag; community: that ADD sets it so).
#[inline]
pub fn add(a: Number, b: Number, to: Width, mode: MathMode) -> Outcome {
    match integers([a, b], to, mode) {
        Some([a, b]) => {
            let (low_a, low_b, mask) = unsigned(a, b, to);
            integer(a + b, to != Width::Float && low_a + low_b > mask, to, mode)
        }
        None => float(a.float() + b.float(), to, mode),
    }
}

/// ADD of two words into a word, without the detour over [`Number`].
#[inline]
pub const fn add_words(a: i16, b: i16, mode: MathMode) -> (i16, Flags) {
    let (wrapped, overflow) = a.overflowing_add(b);
    let carry = (a as u16).overflowing_add(b as u16).1;
    let value = if mode.wrap { wrapped } else { a.saturating_add(b) };
    (value, Flags::of_word(value, carry, overflow))
}

/// SUB: A - B. C is the unsigned borrow (manual, unseen).
#[inline]
pub fn sub(a: Number, b: Number, to: Width, mode: MathMode) -> Outcome {
    match integers([a, b], to, mode) {
        Some([a, b]) => {
            let (low_a, low_b, _) = unsigned(a, b, to);
            integer(a - b, to != Width::Float && low_a < low_b, to, mode)
        }
        None => float(a.float() - b.float(), to, mode),
    }
}

/// SUB of two words into a word, without the detour over [`Number`].
#[inline]
pub const fn sub_words(a: i16, b: i16, mode: MathMode) -> (i16, Flags) {
    let (wrapped, overflow) = a.overflowing_sub(b);
    let borrow = (a as u16) < (b as u16);
    let value = if mode.wrap { wrapped } else { a.saturating_sub(b) };
    (value, Flags::of_word(value, borrow, overflow))
}

/// Sources and destination are words: the operations that use the math register use it.
///
/// Printed for SLC and MicroLogix 1000; MicroLogix 1100 to 1500 with 16-bit operands: manual, unseen.
fn word_sized(a: Number, b: Number, to: Width) -> bool {
    a.width() == Width::Word && b.width() == Width::Word && to == Width::Word
}

/// MUL: A × B. The 32-bit product of words goes to the math register, at overflow too (printed).
#[inline]
pub fn mul(a: Number, b: Number, to: Width, mode: MathMode) -> Outcome {
    match integers([a, b], to, mode) {
        Some([x, y]) => {
            let product = x * y;
            let outcome = integer(product, false, to, mode);
            if word_sized(a, b, to) { outcome.with_register(Register::of_long(product as i32)) } else { outcome }
        }
        None => float(a.float() * b.float(), to, mode),
    }
}

/// A remainder calls for the next integer away from zero: it is more than half the divisor, or half
/// and halves go away.
#[inline]
pub(super) fn rounds_away<T: Ord + Copy + Sub<Output = T>>(remainder: T, divisor: T, half_away: bool) -> bool {
    match remainder.cmp(&(divisor - remainder)) {
        Ordering::Less => false,
        Ordering::Equal => half_away,
        Ordering::Greater => true,
    }
}

/// The quotient rounded to the nearest integer. Halves go away from zero: printed for positive
/// quotients; open for negative ones, [`Choice::DivHalfTowardsZero`]. A zero divisor gives 0.
#[inline]
pub(super) fn rounded_quotient(dividend: i64, divisor: i64, mode: MathMode) -> i64 {
    let (Some(quotient), Some(remainder)) = (dividend.checked_div(divisor), dividend.checked_rem(divisor)) else {
        return 0;
    };
    let negative = (dividend < 0) != (divisor < 0);
    let half_away = !(negative && mode.rules.has(Choice::DivHalfTowardsZero));
    let away = rounds_away(remainder.unsigned_abs(), divisor.unsigned_abs(), half_away);
    quotient + i64::from(away) * if negative { -1 } else { 1 }
}

/// DIV: A / B, rounded. Of words, the quotient before rounding goes to S:14 and the remainder, with
/// the sign of the dividend, to S:13 (printed; the sign: inferred).
///
/// Division by zero stores 32767 (printed); with a negative dividend that is open,
/// [`Choice::DivideByZeroSigned`]. What the math register holds then is open: it is left alone.
/// S:2/14 decides about -32768 / -1 (printed), and leaves the 32767 of a zero divisor (inferred).
#[inline]
pub fn div(a: Number, b: Number, to: Width, mode: MathMode) -> Outcome {
    let Some([x, y]) = integers([a, b], to, mode) else {
        return float(a.float() / b.float(), to, mode);
    };
    if y == 0 {
        let negative = x < 0 && mode.rules.has(Choice::DivideByZeroSigned);
        return Outcome::stored(limit(to, negative), false, true);
    }
    let outcome = integer(rounded_quotient(x, y, mode), false, to, mode);
    if word_sized(a, b, to) {
        outcome.with_register(Register { high: (x / y) as u16, low: (x % y) as u16 })
    } else {
        outcome
    }
}

/// The limit of a destination that a result without a value becomes.
pub(super) const fn limit(to: Width, negative: bool) -> Number {
    match (to, negative) {
        (Width::Word, false) => Number::Word(i16::MAX),
        (Width::Word, true) => Number::Word(i16::MIN),
        (Width::Long, false) => Number::Long(i32::MAX),
        (Width::Long, true) => Number::Long(i32::MIN),
        (Width::Float, false) => Number::Float(f32::INFINITY),
        (Width::Float, true) => Number::Float(f32::NEG_INFINITY),
    }
}

/// DDV: the math register (S:14, S:13) / source, rounded (printed).
///
/// A zero divisor and a quotient beyond 16 bits store 32767, S:2/14 notwithstanding (printed). The
/// register takes quotient and remainder as in DIV; what it holds after an overflow is open: it is
/// left alone.
pub fn ddv(register: Register, source: i16, mode: MathMode) -> Outcome {
    let (dividend, divisor) = (i64::from(register.long()), i64::from(source));
    let overflown = Outcome::stored(Number::Word(i16::MAX), false, true);
    if divisor == 0 {
        return overflown;
    }
    match i16::try_from(rounded_quotient(dividend, divisor, mode)) {
        Ok(quotient) => Outcome::stored(Number::Word(quotient), false, false)
            .with_register(Register { high: (dividend / divisor) as u16, low: (dividend % divisor) as u16 }),
        Err(_) => overflown,
    }
}

/// NEG: 0 - source. C is 0 when the result is 0 or overflows, else 1 (manual, unseen). Only the most
/// negative integer overflows.
#[inline]
pub fn neg(source: Number, to: Width, mode: MathMode) -> Outcome {
    match integers([source], to, mode) {
        Some([source]) => {
            let (value, overflow) = fit_integer(-source, to, mode.wrap);
            Outcome::stored(value, to != Width::Float && source != 0 && !overflow, overflow)
        }
        None => float(-source.float(), to, mode),
    }
}

/// ABS: the source without its sign. Only the most negative integer overflows: limited, or cut with
/// S:2/14 (printed for the MicroLogix 1100).
///
/// C tells a negative integer source on MicroLogix 1100 to 1500 (printed for the 1100) and is reset on
/// SLC (manual, unseen). Of a float moved to a float only the sign bit changes, whatever the other bits
/// are (printed for the 1100).
#[inline]
pub fn abs(source: Number, to: Width, mode: MathMode) -> Outcome {
    if let (Number::Float(source), Width::Float) = (source, to) {
        return Outcome::stored(Number::Float(source.abs()), false, !source.is_finite());
    }
    match integers([source], to, mode) {
        Some([source]) => {
            let carry = to != Width::Float && source < 0 && !mode.rules.lineage.is_slc_like();
            integer(source.abs(), carry, to, mode)
        }
        None => float(source.float().abs(), to, mode),
    }
}

/// CLR: 0, with Z set and the other flags reset (manual, unseen).
#[inline]
pub const fn clr(to: Width) -> Outcome {
    let value = match to {
        Width::Word => Number::Word(0),
        Width::Long => Number::Long(0),
        Width::Float => Number::Float(0.0),
    };
    Outcome { value: Some(value), flags: Flags::ZERO, register: None }
}

/// SQR: the square root of the absolute value, rounded for an integer destination (manual, unseen).
/// C is called reserved and is reset here.
pub fn sqr(source: Number, to: Width, mode: MathMode) -> Outcome {
    match integers([source], to, mode) {
        Some([source]) => {
            let value = source.unsigned_abs();
            let root = value.isqrt();
            // The root of an integer never lies halfway: (r + 1/2)² is no integer.
            let rounded = if value - root * root > root { root + 1 } else { root };
            integer(rounded as i64, false, to, mode)
        }
        None => float(source.float().abs().sqrt(), to, mode),
    }
}

#[cfg(test)]
mod tests;
