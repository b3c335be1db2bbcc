//! ADD, SUB, MUL, DIV, DDV, NEG, ABS, CLR, SQR, SCL, SCP and the functions of floats.
//!
//! Integers are computed so that no 32-bit sum or product overflows and only numbers that are not
//! negative are divided: what Do-more does elsewhere is not documented.

use instr::exec::{Number, Width};
use ladder::Instruction;

use super::context::{Context, Converted, Person};
use super::emit::{Emitter, Relation};
use super::marks::Mark;
use super::operand::{Target, operand};
use super::store::{
    Carry, FLOAT, Wrap, carry_of, fixed_flags, float, has_register, integer, integer_as, long_sum, put, register,
    register_long, settled,
};
use super::table::{Row, row};
use super::value::{Value, choose, limits, relation, rounded_quotient};

pub(super) const TABLE: &[Row] = &[
    row("ADD", |cx, e, i| sum(cx, e, i, false)),
    row("SUB", |cx, e, i| sum(cx, e, i, true)),
    row("MUL", multiply),
    row("DIV", divide),
    row("DDV", double_divide),
    row("NEG", negate),
    row("ABS", absolute),
    row("CLR", clear),
    row("SQR", square_root),
    row("SCL", scale),
    row("SCP", super::scale::scale_parameters),
    row("CPT", super::compute::compute),
    row("SIN", |cx, e, i| function(cx, e, i, "SIN")),
    row("COS", |cx, e, i| function(cx, e, i, "COS")),
    row("TAN", |cx, e, i| function(cx, e, i, "TAN")),
    row("ASN", |cx, e, i| function(cx, e, i, "ASIN")),
    row("ACS", |cx, e, i| function(cx, e, i, "ACOS")),
    row("ATN", |cx, e, i| function(cx, e, i, "ATAN")),
    row("LN", |cx, e, i| function(cx, e, i, "LN")),
    row("LOG", |cx, e, i| function(cx, e, i, "LOG")),
    row("DEG", |cx, e, i| factor(cx, e, i, 180.0 / std::f64::consts::PI)),
    row("RAD", |cx, e, i| factor(cx, e, i, std::f64::consts::PI / 180.0)),
    row("XPY", power),
];

/// The two sources and the destination.
fn binary(cx: &mut Context<'_>, i: &Instruction) -> Converted<(Value, Value, Target)> {
    let operands = [operand(i, 0)?, operand(i, 1)?, operand(i, 2)?];
    let long = cx.any_long(&operands);
    let [a, b, to] = operands;
    Ok((cx.value(a, long)?, cx.value(b, long)?, cx.write(to)?))
}

/// The source and the destination.
pub(super) fn unary(cx: &mut Context<'_>, i: &Instruction) -> Converted<(Value, Target)> {
    let operands = [operand(i, 0)?, operand(i, 1)?];
    let long = cx.any_long(&operands);
    let [source, to] = operands;
    Ok((cx.value(source, long)?, cx.write(to)?))
}

/// Any float among the operands, the destination included, makes the operation a float one.
fn is_float(values: &[&Value], to: &Target) -> bool {
    to.width == Width::Float || values.iter().any(|value| value.is_float())
}

/// Stores the result of an operation of floats.
fn store_float(cx: &mut Context<'_>, e: &mut Emitter, result: &Value, to: &Target) {
    cx.condition(Mark::Rounding, FLOAT);
    float(cx, e, result, to);
}

fn sum(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction, minus: bool) -> Converted {
    let (a, b, to) = binary(cx, i)?;
    if is_float(&[&a, &b], &to) {
        let result = a.float_operation(if minus { '-' } else { '+' }, &b);
        store_float(cx, e, &result, &to);
        return Ok(());
    }
    let carry = carry_of(&a, &b, minus, to.width);
    if to.width == Width::Long || !(a.fits(Width::Word) && b.fits(Width::Word)) {
        long_sum(cx, e, (&a, &b), minus, &carry, &to);
        return Ok(());
    }
    let result = if minus { a.minus(&b) } else { a.plus(&b) };
    integer(cx, e, &result, &carry, &to);
    Ok(())
}

fn multiply(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (a, b, to) = binary(cx, i)?;
    if is_float(&[&a, &b], &to) {
        store_float(cx, e, &a.float_operation('*', &b), &to);
        return Ok(());
    }
    let product = a.times(&b);
    if product.fits(Width::Long) {
        let words = a.width == Width::Word && b.width == Width::Word && to.width == Width::Word;
        if words && has_register(cx) {
            // The register is stored last, but the operands may stand in the destination or be the flags.
            let whole = held(cx, e, &product, 2);
            integer(cx, e, &whole, &Carry::Off, &to);
            register_long(cx, e, &whole);
        } else {
            integer(cx, e, &product, &Carry::Off, &to);
        }
        return Ok(());
    }
    long_product(cx, e, &a, &b, &to)
}

/// A product that can leave 32 bits. With a constant factor the other one is compared with the last
/// values that fit.
fn long_product(cx: &mut Context<'_>, e: &mut Emitter, a: &Value, b: &Value, to: &Target) -> Converted {
    let (value, factor) = match (a.known(), b.known()) {
        (Some(factor), _) => (b, factor),
        (_, Some(factor)) => (a, factor),
        _ => {
            cx.condition(Mark::Rounding, "the product of two long words must fit 32 bits");
            let product = a.times(b).bounded(limits(Width::Long).0, limits(Width::Long).1);
            integer(cx, e, &product, &Carry::Off, to);
            return Ok(());
        }
    };
    let (low, high) = limits(Width::Long);
    // Quotients towards zero: the last multiples inside the limits.
    let (least, most) = if factor > 0 { (low / factor, high / factor) } else { (high / factor, low / factor) };
    let wrap = cx.wrap();
    if wrap != Wrap::Never {
        cx.condition(
            Mark::MathRegister,
            "S:2/14: a 32-bit result beyond its limits keeps its low bits there, here it is limited",
        );
    }
    let (most_value, least_value) = (Value::integer(most), Value::integer(least));
    let (over, under) = if factor > 0 { (high, low) } else { (low, high) };
    let source = settled(e, value, &cx.scratch_long(2));
    let trap = cx.minor_error_bit(0);
    for (relation, limit) in [(Relation::Greater, most), (Relation::Less, least)] {
        e.when(|e| {
            e.and_compare(relation, source.text(), &limit.to_string());
            e.set(&trap);
        });
    }
    let product = source.times(&Value::integer(factor)).bounded(low, high);
    let below = choose(&relation(&source, "<", &least_value), &Value::integer(under), &product);
    let result = choose(&relation(&source, ">", &most_value), &Value::integer(over), &below);
    if to.width == Width::Long {
        put(e, &result, to);
        if cx.facts.names_status(0) {
            cx.condition(Mark::MathRegister, "S:0 (flags) of 32-bit products is not kept up");
        }
    } else {
        integer(cx, e, &result, &Carry::Off, to);
    }
    Ok(())
}

fn divide(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (a, b, to) = binary(cx, i)?;
    if is_float(&[&a, &b], &to) {
        return float_quotient(cx, e, &a, &b, &to);
    }
    let words = a.width == Width::Word && b.width == Width::Word && to.width == Width::Word;
    if b.known() == Some(0) {
        let top = Value::integer(limits(to.width).1);
        let trap = cx.minor_error_bit(0);
        e.set(&trap);
        put(e, &top, &to);
        fixed_flags(cx, e, 2);
        return Ok(());
    }
    let keeps_register = words && has_register(cx);
    let (dividend, divisor) = if keeps_register {
        // The register is stored last, but the operands may stand in the destination.
        (held(cx, e, &a, 2), held(cx, e, &b, 3))
    } else {
        (a.clone(), b.clone())
    };
    // Above the limit of a word, so that limiting it leaves the limit and sets the trap.
    let quotient = quotient(cx, e, &dividend, &divisor, 32_768);
    let zero = divisor.known().is_none();
    let wrap = cx.wrap();
    if zero && (wrap != Wrap::Never || to.width == Width::Long) {
        // The limit that a zero divisor leaves does not depend on S:2/14.
        zero_by_contact(cx, e, &divisor, &quotient, &to, &wrap);
    } else {
        integer_as(cx, e, &quotient, &Carry::Off, &to, &wrap);
    }
    if keeps_register {
        let (dividend, divisor) = (&dividend, &divisor);
        let whole = truncated(dividend, divisor);
        let whole = settled(e, &whole, &cx.scratch_long(4)).bounded(-32_768, 32_768);
        let rest = dividend.minus(&whole.times(divisor));
        let store = |cx: &mut Context<'_>, e: &mut Emitter| {
            register(cx, e, &rest, &super::value::wrapped(&whole));
        };
        if divisor.known().is_some() {
            store(cx, e);
        } else {
            e.when(|e| {
                e.and_compare(Relation::NotEqual, divisor.text(), "0");
                store(cx, e);
            });
        }
    }
    Ok(())
}

/// Beyond this the quotient by any word leaves the range of words, and half a divisor more still fits 32 bits.
const FAR: i64 = 1_100_000_000;

/// DDV: the math register by a word. What 16 bits do not hold stores 32767 with the trap, whatever its sign and
/// S:2/14, and leaves the register alone.
fn double_divide(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (divisor, to) = unary(cx, i)?;
    if divisor.width != Width::Word || to.width != Width::Word {
        return Err(Person::new(Mark::Operand, "DDV of other than words"));
    }
    let (low, high) = (cx.status_word(13), cx.status_word(14));
    let long = cx.scratch_long(2);
    e.math(&long, &format!("{high} * 65536 + ({low} & 65535)"));
    let dividend = Value::element(long.clone(), Width::Long);
    let divisor = held(cx, e, &divisor, 3);
    let near = cx.scratch_long(13);
    e.math(&near, &format!("IF({long} > {FAR}, {FAR}, IF({long} < -{FAR}, -{FAR}, {long}))"));
    let near = Value::element(near, Width::Long).bounded(-FAR, FAR);
    let top = Value::integer(32_768);
    let rounded = match divisor.known() {
        Some(0) => top.clone(),
        _ => quotient(cx, e, &near, &divisor, 32_768),
    };
    let rounded = settled(e, &rounded, &cx.scratch_long(14));
    // The destination can be the register.
    let fits = cx.scratch_bit(91);
    let keeps = has_register(cx) && divisor.known() != Some(0);
    if keeps {
        e.when(|e| {
            e.and_compare(Relation::LessOrEqual, rounded.text(), "32767");
            e.and_compare(Relation::GreaterOrEqual, rounded.text(), "-32768");
            e.hold(&fits);
        });
    }
    let result = choose(&relation(&rounded, "<", &Value::integer(-32_768)), &top, &rounded);
    integer_as(cx, e, &result.bounded(-32_768, FAR), &Carry::Off, &to, &Wrap::Never);
    if keeps {
        let whole = truncated(&near, &divisor);
        e.when(|e| {
            e.and(&fits);
            let whole = settled(e, &whole, &cx.scratch_long(4)).bounded(-32_768, 32_768);
            let rest = dividend.minus(&whole.times(&divisor));
            register(cx, e, &rest, &super::value::wrapped(&whole));
            e.reset(&fits);
        });
    }
    Ok(())
}

/// A copy in a scratch, unless the value is a constant.
fn held(cx: &mut Context<'_>, e: &mut Emitter, value: &Value, number: usize) -> Value {
    if value.constant.is_some() {
        return value.clone();
    }
    let scratch = cx.scratch_long(number);
    match value.plain() {
        Some(plain) => e.mov(plain, &scratch),
        None => e.math(&scratch, value.text()),
    }
    Value::element(scratch, value.width).bounded(value.low, value.high)
}

/// A zero divisor stores the upper limit, any other one the quotient.
fn zero_by_contact(cx: &mut Context<'_>, e: &mut Emitter, divisor: &Value, quotient: &Value, to: &Target, wrap: &Wrap) {
    let sign = settled(e, divisor, &cx.scratch_long(5));
    let zero = cx.scratch_bit(90);
    e.when(|e| {
        e.and_compare(Relation::Equal, sign.text(), "0");
        e.hold(&zero);
    });
    e.when(|e| {
        e.and_not(&zero);
        integer_as(cx, e, quotient, &Carry::Off, to, wrap);
    });
    let trap = cx.minor_error_bit(0);
    let top = Value::integer(limits(to.width).1);
    e.when(|e| {
        e.and(&zero);
        e.set(&trap);
        put(e, &top, to);
        fixed_flags(cx, e, 2);
        e.reset(&zero);
    });
}

/// The divisor with 1 in the place of 0.
fn never_zero(divisor: &Value) -> Value {
    let one = Value::integer(1);
    let magnitude = divisor.magnitude();
    let high = magnitude.high.max(1);
    choose(&relation(divisor, "==", &Value::integer(0)), &one, &magnitude).bounded(1, high)
}

/// The quotient rounded to the nearest integer, halves away from zero; `beyond` for a zero divisor.
pub(super) fn quotient(cx: &mut Context<'_>, e: &mut Emitter, a: &Value, b: &Value, beyond: i64) -> Value {
    if let Some(divisor) = b.known() {
        if let Some(a) = a.known() {
            let exact = super::store::known_quotient(cx, a, divisor).unwrap_or(0);
            return Value::integer(exact);
        }
        let dividend = settled_if_long(cx, e, a, 11);
        let size = divisor.unsigned_abs() as i64;
        let quotient = match rounded_quotient(&dividend, size) {
            Some(quotient) => quotient,
            None => long_quotient(&dividend, size),
        };
        return if divisor < 0 { quotient.negated() } else { quotient };
    }
    let (dividend, divisor) = (settled_if_long(cx, e, a, 11), settled_if_long(cx, e, b, 12));
    let by = never_zero(&divisor);
    let size = divisor.magnitude();
    let sum = dividend.magnitude().plus(&size.over(&Value::integer(2)));
    let positive = if sum.fits(Width::Long) {
        sum.over(&by)
    } else {
        cx.condition(Mark::Rounding, "the dividend plus half the divisor must fit 32 bits");
        sum.bounded(0, limits(Width::Long).1).over(&by)
    };
    let whole = settled(e, &positive, &cx.scratch_long(6));
    let mut result = whole.clone();
    // Each negative operand turns the sign.
    let minus = Value::integer(0);
    if divisor.low < 0 {
        result = choose(&relation(&divisor, "<", &minus), &result.negated(), &result);
    }
    if dividend.low < 0 {
        result = choose(&relation(&dividend, "<", &minus), &result.negated(), &result);
    }
    choose(&relation(&divisor, "==", &minus), &Value::integer(beyond), &result)
}

/// What appears several times in an expression is computed once.
fn settled_if_long(cx: &mut Context<'_>, e: &mut Emitter, value: &Value, number: usize) -> Value {
    if value.text().len() > 12 && value.plain().is_none() {
        return settled(e, value, &cx.scratch_long(number));
    }
    value.clone()
}

/// A rounded quotient of the full range of long words by a positive constant.
fn long_quotient(dividend: &Value, divisor: i64) -> Value {
    let (by, zero) = (Value::integer(divisor), Value::integer(0));
    let half = Value::integer(divisor / 2);
    let of = |value: &Value| {
        let value = value.clone().bounded(0, limits(Width::Long).1);
        value.over(&by).plus(&value.rest(&by).plus(&half).over(&by))
    };
    let negative = of(&dividend.negated()).negated();
    let signed = choose(&relation(dividend, "<", &zero), &negative, &of(dividend));
    if dividend.low > limits(Width::Long).0 {
        return signed;
    }
    // The one number whose magnitude 32 bits do not hold.
    let least = limits(Width::Long).0;
    let exact = Value::integer((least - divisor / 2) / divisor);
    let result = choose(&relation(dividend, "<", &Value::integer(least + 1)), &exact, &signed);
    let bound = least.saturating_abs() / divisor + 1;
    result.bounded(-bound, bound)
}

/// The quotient without its fraction, for the math register; words only.
fn truncated(a: &Value, b: &Value) -> Value {
    let by = if b.known().is_some() { b.magnitude() } else { never_zero(b) };
    let whole = a.magnitude().over(&by);
    let zero = Value::integer(0);
    let mut result = whole;
    match b.known() {
        Some(divisor) if divisor < 0 => result = result.negated(),
        Some(_) => {}
        None => result = choose(&relation(b, "<", &zero), &result.negated(), &result),
    }
    if a.low < 0 {
        result = choose(&relation(a, "<", &zero), &result.negated(), &result);
    }
    result
}

/// Division of floats. By zero the original stores infinity and stops; here the destination stays.
fn float_quotient(cx: &mut Context<'_>, e: &mut Emitter, a: &Value, b: &Value, to: &Target) -> Converted {
    let certain = match b.constant {
        Some(Number::Float(value)) => value != 0.0,
        Some(value) => value.integer() != Some(0),
        None => false,
    };
    if certain {
        store_float(cx, e, &a.float_operation('/', b), to);
        return Ok(());
    }
    let divisor = match b.plain() {
        Some(_) => b.clone(),
        None => {
            let scratch = cx.scratch_float(7);
            e.math(&scratch, b.text());
            Value::element(scratch, Width::Float)
        }
    };
    let none = if divisor.is_float() { "0.0" } else { "0" };
    let trap = cx.minor_error_bit(0);
    let operand = divisor.plain().unwrap_or_default().to_owned();
    if to.width == Width::Float {
        cx.condition(
            Mark::Fault,
            "a float division by zero sets the trap S:5/0 and stores infinity there, or what is no number for 0 / 0; here \
             the trap is set and a product beyond 3.4E38 is stored, for 0 / 0 times zero",
        );
        // A product that overflows, whatever that is here: the nearest to infinity that can be written.
        let huge = Value::real(1e38).text().to_owned();
        let nothing = if a.is_float() { Value::real(0.0) } else { Value::integer(0) };
        let sign = relation(a, "<", &nothing);
        // Infinity times zero is no number, as 0 / 0 is.
        let number = match a.constant {
            Some(Number::Float(value)) if value != 0.0 => String::new(),
            Some(value) if value.integer().is_some_and(|value| value != 0) => String::new(),
            _ => format!(" * IF({}, 0.0, 1.0)", relation(a, "==", &nothing)),
        };
        let zero = cx.scratch_bit(93);
        e.when(|e| {
            e.and_compare(Relation::Equal, &operand, none);
            e.hold(&zero);
        });
        e.when(|e| {
            e.and(&zero);
            e.set(&trap);
            e.math(&super::store::destination(to), &format!("IF({sign}, -10.0, 10.0) * {huge}{number}"));
        });
        e.when(|e| {
            e.and_not(&zero);
            store_float(cx, e, &a.float_operation('/', &divisor), to);
        });
        return Ok(());
    }
    // Infinity is limited to the destination; operands may stand in it, so the decision is kept.
    let zero = cx.scratch_bit(93);
    e.when(|e| {
        e.and_compare(Relation::Equal, &operand, none);
        e.hold(&zero);
    });
    let (low, high) = limits(to.width);
    let below = relation(a, "<", &if a.is_float() { Value::real(0.0) } else { Value::integer(0) });
    let limit = choose(&below, &Value::integer(low), &Value::integer(high));
    e.when(|e| {
        e.and(&zero);
        e.set(&trap);
        put(e, &limit, to);
    });
    e.when(|e| {
        e.and_not(&zero);
        store_float(cx, e, &a.float_operation('/', &divisor), to);
    });
    if cx.facts.names_status(0) {
        cx.condition(Mark::MathRegister, "S:0 after a division by 0.0 is not kept up");
    }
    Ok(())
}

fn negate(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (source, to) = unary(cx, i)?;
    if is_float(&[&source], &to) {
        store_float(cx, e, &source.float_negated(), &to);
        return Ok(());
    }
    // Reset by 0 and by what does not fit.
    let value = source.atom();
    let beyond = |low: &str| format!("IF({value} < {low}, 0, 1)");
    let carry = match (to.width, source.fits(Width::Word)) {
        (Width::Long, true) => format!("IF({value} == 0, 0, 1)"),
        (Width::Long, false) => format!("IF({value} == 0, 0, {})", beyond("-2147483647")),
        (_, true) => format!("IF({value} == 0, 0, {})", beyond("-32767")),
        (_, false) => format!("IF({value} == 0, 0, IF({value} > 32768, 0, {}))", beyond("-32767")),
    };
    if source.fits(Width::Word) {
        integer(cx, e, &Value::integer(0).minus(&source), &Carry::Is(carry), &to);
    } else {
        long_sum(cx, e, (&Value::integer(0), &source), true, &Carry::Is(carry), &to);
    }
    Ok(())
}

fn absolute(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (source, to) = unary(cx, i)?;
    if is_float(&[&source], &to) {
        store_float(cx, e, &source.float_function("ABS"), &to);
        return Ok(());
    }
    let slc_like = cx.slc_like();
    let negative = |source: &Value| format!("IF({} < 0, 1, 0)", source.atom());
    if source.fits(Width::Word) {
        let carry = if slc_like { Carry::Off } else { Carry::Is(negative(&source)) };
        integer(cx, e, &source.magnitude(), &carry, &to);
        return Ok(());
    }
    // The magnitude of the lowest long word overflows: the highest one, or itself where it is cut.
    let low = limits(Width::Long).0;
    let source = settled(e, &source, &cx.scratch_long(2));
    let trap = cx.minor_error_bit(0);
    e.when(|e| {
        e.and_compare(Relation::Equal, source.text(), &low.to_string());
        e.set(&trap);
    });
    let wrap = cx.wrap();
    let (least, most) = (Value::integer(low), Value::integer(limits(Width::Long).1));
    let lowest = match &wrap {
        Wrap::Never => most,
        Wrap::Always => least,
        Wrap::By(bit) => choose(&format!("{bit} == 1"), &least, &most),
    };
    let magnitude = source.magnitude().bounded(0, limits(Width::Long).1);
    let result = choose(&relation(&source, "<", &Value::integer(low + 1)), &lowest, &magnitude);
    // A destination of 32 bits does not show by itself that the result was none of them.
    let mut flags = Vec::new();
    if !slc_like {
        flags.push(negative(&source));
    }
    if to.width == Width::Long {
        flags.push(format!("IF({} < -2147483647, 2, 0)", source.atom()));
    }
    let carry = if flags.is_empty() { Carry::Off } else { Carry::Is(flags.join(" + ")) };
    integer_as(cx, e, &result, &carry, &to, &wrap);
    Ok(())
}

fn clear(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let to = cx.write(operand(i, 0)?)?;
    let zero = if to.width == Width::Float { Value::real(0.0) } else { Value::integer(0) };
    put(e, &zero, &to);
    fixed_flags(cx, e, 4);
    Ok(())
}

/// SQR: of the magnitude; into an integer rounded, which never meets a half.
fn square_root(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (source, to) = unary(cx, i)?;
    cx.needs_unconfirmed("the function SQRT")?;
    cx.condition(Mark::Rounding, "the name SQRT of the square root is inferred");
    let root = |magnitude: &Value| magnitude.float_function("SQRT");
    if is_float(&[&source], &to) {
        let magnitude = Value::expression(format!("ABS({})", source.as_float().text()), Width::Float);
        store_float(cx, e, &root(&magnitude), &to);
        return Ok(());
    }
    let result = Value::expression(format!("TRUNC({} + 0.5)", root(&source.magnitude()).text()), Width::Long);
    integer(cx, e, &result.bounded(0, 46_341), &Carry::Off, &to);
    Ok(())
}

/// SCL: source × rate / 10000, rounded, plus offset.
fn scale(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (source, rate, offset) =
        (cx.value(operand(i, 0)?, false)?, cx.value(operand(i, 1)?, false)?, cx.value(operand(i, 2)?, false)?);
    let to = cx.write(operand(i, 3)?)?;
    let product = source.times(&rate);
    if is_float(&[&source, &rate, &offset], &to) || !product.fits(Width::Long) {
        return Err(Person::new(Mark::Rounding, "SCL of other than words"));
    }
    let product = settled(e, &product, &cx.scratch_long(2));
    let scaled = rounded_quotient(&product, 10_000).unwrap_or_else(|| product.clone());
    if !cx.slc_like() {
        integer_as(cx, e, &scaled.plus(&offset), &Carry::Off, &to, &Wrap::Never);
        return Ok(());
    }
    // SLC looks for overflow before it adds the offset, and stops there.
    let scaled = settled(e, &scaled, &cx.scratch_long(3));
    let with_offset = scaled.plus(&offset);
    if scaled.fits(Width::Word) {
        integer_as(cx, e, &with_offset, &Carry::Off, &to, &Wrap::Never);
        return Ok(());
    }
    let high = choose(&relation(&scaled, ">", &Value::integer(32_767)), &Value::integer(32_768), &with_offset);
    let result = choose(&relation(&scaled, "<", &Value::integer(-32_768)), &Value::integer(-32_769), &high);
    integer_as(cx, e, &result, &Carry::Off, &to, &Wrap::Never);
    Ok(())
}

/// A function of a float.
fn function(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction, name: &str) -> Converted {
    let (source, to) = unary(cx, i)?;
    cx.needs_unconfirmed(&format!("the function {name}"))?;
    cx.condition(
        Mark::Rounding,
        format!("the name {name} is inferred; the last digit of its results is not documented on either side"),
    );
    store_float(cx, e, &source.float_function(name), &to);
    Ok(())
}

fn factor(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction, factor: f64) -> Converted {
    let (source, to) = unary(cx, i)?;
    cx.condition(Mark::Rounding, "the last digit of the result is not documented on either side");
    store_float(cx, e, &source.float_operation('*', &Value::real(factor as f32)), &to);
    Ok(())
}

/// XPY: A to the power of B.
fn power(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (a, b, to) = binary(cx, i)?;
    cx.needs_unconfirmed("the operator **")?;
    cx.condition(
        Mark::Rounding,
        "the operator ** is inferred; the last digit of a power is not documented on either side, and a negative \
         base needs a whole exponent",
    );
    let result = Value::expression(format!("{} ** {}", a.as_float().atom(), b.as_float().atom()), Width::Float);
    store_float(cx, e, &result, &to);
    Ok(())
}
