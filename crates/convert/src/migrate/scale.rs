//! SCP: a line through two points.

use instr::exec::Width;
use ladder::Instruction;

use super::context::{Context, Converted};
use super::emit::{Emitter, Relation};
use super::marks::Mark;
use super::operand::{Target, operand};
use super::store::{Carry, FLOAT, fixed_flags, float, integer, put, settled};
use super::value::{Value, choose, limits, relation, rounded_quotient};

/// Input and output range of SCP.
struct Line {
    x: Value,
    x0: Value,
    x1: Value,
    y0: Value,
    y1: Value,
}

/// SCP.
pub(super) fn scale_parameters(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let mut values = Vec::with_capacity(5);
    for index in 0..5 {
        values.push(cx.value(operand(i, index)?, true)?);
    }
    let to = cx.write(operand(i, 5)?)?;
    let Ok([x, x0, x1, y0, y1]) = <[Value; 5]>::try_from(values) else { return Ok(()) };
    let line = Line { x, x0, x1, y0, y1 };
    let is_float =
        to.width == Width::Float || [&line.x, &line.x0, &line.x1, &line.y0, &line.y1].iter().any(|v| v.is_float());
    let width = match (line.x0.known_float(), line.x1.known_float()) {
        (Some(low), Some(high)) => Some(low == high),
        _ => None,
    };
    match width {
        Some(true) => flat(cx, e, &to),
        Some(false) if is_float => float_line(cx, e, &line, &to),
        Some(false) => integer_line(cx, e, &line, &to),
        None => guarded(cx, e, &line, &to, is_float),
    }
    Ok(())
}

/// An input range without width: the limit of the destination and the trap.
fn flat(cx: &mut Context<'_>, e: &mut Emitter, to: &Target) {
    let trap = cx.minor_error_bit(0);
    e.set(&trap);
    if to.width == Width::Float {
        cx.condition(
            Mark::Fault,
            "SCP without an input range stores infinity there; here the destination keeps its value and the trap S:5/0 is set",
        );
    } else {
        put(e, &Value::integer(limits(to.width).1), to);
        fixed_flags(cx, e, 2);
    }
}

/// The width of the input range is known at run time only.
fn guarded(cx: &mut Context<'_>, e: &mut Emitter, line: &Line, to: &Target, is_float: bool) {
    let scratch = |cx: &mut Context<'_>, value: &Value, number| {
        if value.is_float() { cx.scratch_float(number) } else { cx.scratch_long(number) }
    };
    let x0 = settled(e, &line.x0, &scratch(cx, &line.x0, 13));
    let x1 = settled(e, &line.x1, &scratch(cx, &line.x1, 14));
    // The limits may stand in the destination: what is decided must stay decided.
    let zero = cx.scratch_bit(91);
    let text = |value: &Value| value.plain().unwrap_or_default().to_owned();
    e.when(|e| {
        e.and_compare(Relation::Equal, &text(&x0), &text(&x1));
        e.hold(&zero);
    });
    let line = Line { x: line.x.clone(), x0, x1, y0: line.y0.clone(), y1: line.y1.clone() };
    e.when(|e| {
        e.and_not(&zero);
        if is_float {
            float_line(cx, e, &line, to);
        } else {
            integer_line(cx, e, &line, to);
        }
    });
    e.when(|e| {
        e.and(&zero);
        flat(cx, e, to);
    });
}

/// The line in single precision, in the order of the formula.
fn float_line(cx: &mut Context<'_>, e: &mut Emitter, line: &Line, to: &Target) {
    cx.condition(Mark::Rounding, FLOAT);
    let difference = |a: &Value, b: &Value| {
        if b.known_float() == Some(0.0) { a.clone() } else { a.float_operation('-', b) }
    };
    let slope = difference(&line.y1, &line.y0).as_float().float_operation('/', &difference(&line.x1, &line.x0));
    let rise = slope.float_operation('*', &difference(&line.x, &line.x0));
    // Adding 0.0 turns -0.0 into 0.0, which only a falling line gives.
    let rising = slope.known_float().is_some_and(|slope| slope > 0.0) && line.y0.known_float() == Some(0.0);
    let result = if rising { rise } else { rise.float_operation('+', &line.y0.as_float()) };
    float(cx, e, &result, to);
}

/// The line in whole numbers: computed exactly and rounded once, halves away from zero.
fn integer_line(cx: &mut Context<'_>, e: &mut Emitter, line: &Line, to: &Target) {
    let rise = line.y1.minus(&line.y0);
    let run = line.x1.minus(&line.x0);
    let step = line.x.minus(&line.x0);
    // A positive run: otherwise both turn their sign.
    let (rise, run) = match run.known() {
        Some(known) if known < 0 => (rise.negated(), run.negated()),
        _ => (rise, run),
    };
    let scaled = match run.known() {
        Some(run) => by_constant(cx, e, &step, &rise, run),
        None => by_variable(cx, e, &step, &rise, &run),
    };
    let result = scaled.plus(&line.y0);
    let result = if result.fits(Width::Long) {
        result
    } else {
        // The rest is said where the product is formed.
        let (low, high) = limits(Width::Long);
        result.bounded(low, high)
    };
    integer(cx, e, &result, &Carry::Off, to);
}

/// `step * rise / run` with a constant run.
fn by_constant(cx: &mut Context<'_>, e: &mut Emitter, step: &Value, rise: &Value, run: i64) -> Value {
    let product = step.times(rise);
    if product.fits(Width::Long) {
        let scratch = cx.scratch_long(2);
        let product = if product.text().len() > 12 { settled(e, &product, &scratch) } else { product.clone() };
        if let Some(quotient) = rounded_quotient(&product, run) {
            return quotient;
        }
    }
    // The product of whole steps and that of the rest stay small where the product itself does not.
    if let Some(known) = rise.known()
        && step.fits(Width::Long)
    {
        let size = Value::integer(known.saturating_abs());
        let (by, half, zero) = (Value::integer(run), Value::integer(run / 2), Value::integer(0));
        let step = settled(e, step, &cx.scratch_long(2));
        // The lowest long word has no magnitude of 32 bits; its result is known.
        let (least, most) = limits(Width::Long);
        let magnitude = settled(e, &step.magnitude().bounded(0, most), &cx.scratch_long(3));
        let whole = magnitude.over(&by).times(&size);
        let part = magnitude.rest(&by).times(&size).plus(&half);
        let sum = whole.plus(&part.over(&by));
        if whole.fits(Width::Long) && part.fits(Width::Long) && sum.fits(Width::Long) {
            let sum = settled(e, &sum, &cx.scratch_long(3));
            let signed = choose(&relation(&step, "<", &zero), &sum.negated(), &sum);
            let signed = if known < 0 { signed.negated() } else { signed };
            if step.low > least {
                return signed;
            }
            let product = i128::from(least) * i128::from(known);
            let exact = (product + product.signum() * i128::from(run / 2)) / i128::from(run);
            let exact = Value::integer(i64::try_from(exact).unwrap_or(0));
            return choose(&relation(&step, "<", &Value::integer(least + 1)), &exact, &signed);
        }
    }
    large(cx, "(input - input minimum) x (scaled maximum - scaled minimum)");
    let product = settled(e, &product.bounded(-SAFE, SAFE), &cx.scratch_long(2));
    rounded_quotient(&product, run).unwrap_or(product)
}

/// `step * rise / run` with a run that is known at run time only, and not zero.
fn by_variable(cx: &mut Context<'_>, e: &mut Emitter, step: &Value, rise: &Value, run: &Value) -> Value {
    let product = step.times(rise);
    let half_run = run.magnitude().over(&Value::integer(2));
    if !product.magnitude().plus(&half_run).fits(Width::Long) {
        large(cx, "(input - input minimum) x (scaled maximum - scaled minimum) plus half the input range");
    }
    let zero = Value::integer(0);
    let product = settled(e, &product.bounded(-SAFE, SAFE), &cx.scratch_long(2));
    let run = settled(e, run, &cx.scratch_long(3));
    let size = run.magnitude();
    let by = size.clone().bounded(1, size.high.max(1));
    let sum = product.magnitude().plus(&size.over(&Value::integer(2))).bounded(0, limits(Width::Long).1);
    let quotient = settled(e, &sum.over(&by), &cx.scratch_long(4));
    let mut result = quotient.clone();
    if run.low < 0 {
        result = choose(&relation(&run, "<", &zero), &result.negated(), &result);
    }
    choose(&relation(&product, "<", &zero), &result.negated(), &result)
}

/// A bound that leaves room for half a divisor.
const SAFE: i64 = 2_000_000_000;

fn large(cx: &mut Context<'_>, what: &str) {
    cx.condition(Mark::Rounding, format!("SCP: {what} must stay within 2,000,000,000"));
}
