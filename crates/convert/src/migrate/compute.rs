//! CPT: an expression becomes an expression.
//!
//! As on the original, everything is computed in floats as soon as one operand, the destination or a
//! function is one, otherwise in 32-bit integers whose quotients are rounded.

use instr::exec::Width;
use ladder::{Expression, Function, Instruction, Operand, Operator};

use super::context::{Context, Converted, Person};
use super::emit::{Emitter, Relation};
use super::marks::Mark;
use super::math::quotient;
use super::operand::{Target, operand};
use super::store::{Carry, FLOAT, float, integer, settled};
use super::value::{Value, choose, limits, relation};

/// Expressions nest at most this deep here: Designer allows 8 levels of parentheses, and what is deeper
/// goes through scratches.
const MAX_DEPTH: usize = 64;

/// First scratch of the parts of an expression.
const FIRST: usize = 20;

/// CPT.
pub(super) fn compute(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let to = cx.write(operand(i, 0)?)?;
    let source = operand(i, 1)?;
    let value = Expression::Value(Box::new(source.clone()));
    let expression = match source {
        Operand::Expression(expression) => expression,
        _ => &value,
    };
    let in_floats = is_float(cx, expression, &to)?;
    let mut parts = Parts { next: FIRST };
    if in_floats {
        cx.condition(Mark::Rounding, FLOAT);
        let result = parts.float(cx, e, expression, 0)?.as_float();
        float(cx, e, &result, &to);
    } else {
        let result = parts.integer(cx, e, expression, 0)?;
        integer(cx, e, &result, &Carry::Off, &to);
    }
    Ok(())
}

fn is_float(cx: &mut Context<'_>, expression: &Expression, to: &Target) -> Converted<bool> {
    if to.width == Width::Float || needs_floats(expression, 0)? {
        return Ok(true);
    }
    for operand in expression.operands() {
        if cx.value(operand, true)?.is_float() {
            return Ok(true);
        }
    }
    Ok(false)
}

fn too_deep() -> Person {
    Person::new(Mark::Operand, format!("the expression nests deeper than {MAX_DEPTH} levels"))
}

fn needs_floats(expression: &Expression, depth: usize) -> Converted<bool> {
    if depth > MAX_DEPTH {
        return Err(too_deep());
    }
    Ok(match expression {
        Expression::Value(_) => false,
        Expression::Group(inner) => needs_floats(inner, depth + 1)?,
        Expression::Unary(function, inner) => real(*function).is_some() || needs_floats(inner, depth + 1)?,
        Expression::Binary(operator, left, right) => {
            *operator == Operator::Power || needs_floats(left, depth + 1)? || needs_floats(right, depth + 1)?
        }
    })
}

/// The Do-more name of a function of floats.
fn real(function: Function) -> Option<&'static str> {
    Some(match function {
        Function::Ln => "LN",
        Function::Log => "LOG",
        Function::Sin => "SIN",
        Function::Cos => "COS",
        Function::Tan => "TAN",
        Function::Asn => "ASIN",
        Function::Acs => "ACOS",
        Function::Atn => "ATAN",
        Function::Deg | Function::Rad => "",
        _ => return None,
    })
}

struct Parts {
    next: usize,
}

impl Parts {
    fn number(&mut self) -> usize {
        self.next += 1;
        self.next - 1
    }

    fn integer(&mut self, cx: &mut Context<'_>, e: &mut Emitter, of: &Expression, depth: usize) -> Converted<Value> {
        if depth > MAX_DEPTH {
            return Err(too_deep());
        }
        let depth = depth + 1;
        let result = match of {
            Expression::Value(operand) => cx.value(operand, true)?,
            Expression::Group(inner) => self.integer(cx, e, inner, depth)?,
            Expression::Unary(function, inner) => {
                let value = self.integer(cx, e, inner, depth)?;
                match function {
                    Function::Negate => value.negated(),
                    Function::Abs => value.magnitude(),
                    Function::Not => value.inverted(),
                    Function::Sqr => {
                        cx.needs_unconfirmed("the function SQRT")?;
                        cx.condition(Mark::Rounding, "the name SQRT of the square root is inferred");
                        let root = value.magnitude().float_function("SQRT");
                        Value::expression(format!("TRUNC({} + 0.5)", root.text()), Width::Long).bounded(0, 46_341)
                    }
                    other => {
                        return Err(Person::new(Mark::NoCounterpart, format!("{} inside CPT", other.symbol())));
                    }
                }
            }
            Expression::Binary(operator, left, right) => {
                let (a, b) = (self.integer(cx, e, left, depth)?, self.integer(cx, e, right, depth)?);
                match operator {
                    Operator::Add => a.plus(&b),
                    Operator::Subtract => a.minus(&b),
                    Operator::Multiply => a.times(&b),
                    Operator::Divide => self.quotient(cx, e, &a, &b),
                    Operator::Modulo => self.remainder(cx, e, &a, &b),
                    Operator::And => a.bit_and(&b),
                    Operator::Or => a.bit_or(&b),
                    Operator::Xor => a.bit_xor(&b),
                    Operator::Power => return Err(Person::new(Mark::NoCounterpart, "** of integers inside CPT")),
                }
            }
        };
        if result.fits(Width::Long) {
            return Ok(result);
        }
        cx.condition(Mark::Rounding, "each step of the expression must fit 32 bits");
        let (low, high) = limits(Width::Long);
        Ok(result.clone().bounded(result.low.max(low), result.high.min(high)))
    }

    fn quotient(&mut self, cx: &mut Context<'_>, e: &mut Emitter, a: &Value, b: &Value) -> Value {
        let (dividend, divisor) =
            (settled(e, a, &cx.scratch_long(self.number())), settled(e, b, &cx.scratch_long(self.number())));
        if divisor.known().is_none_or(|divisor| divisor == 0) {
            zero_divisor(cx, e, &divisor, "0");
        }
        let beyond = limits(Width::Long).1;
        let quotient = match divisor.known() {
            Some(0) => Value::integer(beyond),
            _ => quotient(cx, e, &dividend, &divisor, beyond),
        };
        // Used once in a sum, it may stand there; its scratches are free again only when it is settled.
        settled(e, &quotient, &cx.scratch_long(self.number()))
    }

    /// The remainder with the sign of the dividend.
    fn remainder(&mut self, cx: &mut Context<'_>, e: &mut Emitter, a: &Value, b: &Value) -> Value {
        let (dividend, divisor) =
            (settled(e, a, &cx.scratch_long(self.number())), settled(e, b, &cx.scratch_long(self.number())));
        if divisor.known().is_none_or(|divisor| divisor == 0) {
            zero_divisor(cx, e, &divisor, "0");
        }
        let (zero, one) = (Value::integer(0), Value::integer(1));
        let size = divisor.magnitude();
        let by = choose(&relation(&divisor, "==", &zero), &one, &size).bounded(1, size.high.max(1));
        let rest = dividend.magnitude().rest(&by);
        let rest =
            if dividend.low < 0 { choose(&relation(&dividend, "<", &zero), &rest.negated(), &rest) } else { rest };
        settled(e, &rest, &cx.scratch_long(self.number()))
    }

    fn float(&mut self, cx: &mut Context<'_>, e: &mut Emitter, of: &Expression, depth: usize) -> Converted<Value> {
        if depth > MAX_DEPTH {
            return Err(too_deep());
        }
        let depth = depth + 1;
        Ok(match of {
            Expression::Value(operand) => cx.value(operand, true)?,
            Expression::Group(inner) => self.float(cx, e, inner, depth)?,
            Expression::Unary(function, inner) => {
                let value = self.float(cx, e, inner, depth)?;
                match (function, real(*function)) {
                    (Function::Negate, _) => value.float_negated(),
                    (Function::Abs, _) => value.float_function("ABS"),
                    (Function::Deg, _) => value.float_operation('*', &Value::real(180.0 / std::f32::consts::PI)),
                    (Function::Rad, _) => value.float_operation('*', &Value::real(std::f32::consts::PI / 180.0)),
                    (Function::Sqr, _) => {
                        cx.needs_unconfirmed("the function SQRT")?;
                        cx.condition(Mark::Rounding, "the name SQRT of the square root is inferred");
                        value.float_function("ABS").float_function("SQRT")
                    }
                    (_, Some(name)) => {
                        cx.needs_unconfirmed(&format!("the function {name}"))?;
                        cx.condition(
                            Mark::Rounding,
                            format!("the name {name} is inferred; the last digit of its results is not documented on either side"),
                        );
                        value.float_function(name)
                    }
                    (other, None) => {
                        return Err(Person::new(
                            Mark::NoCounterpart,
                            format!("{} beside floats inside CPT", other.symbol()),
                        ));
                    }
                }
            }
            Expression::Binary(operator, left, right) => {
                let (a, b) = (self.float(cx, e, left, depth)?, self.float(cx, e, right, depth)?);
                match operator {
                    Operator::Add => a.float_operation('+', &b),
                    Operator::Subtract => a.float_operation('-', &b),
                    Operator::Multiply => a.float_operation('*', &b),
                    Operator::Divide => {
                        let divisor = self.divisor(cx, e, &b);
                        a.float_operation('/', &divisor)
                    }
                    Operator::Power => {
                        cx.needs_unconfirmed("the operator **")?;
                        cx.condition(
                            Mark::Rounding,
                            "the operator ** is inferred; the last digit of a power is not documented on either side",
                        );
                        let text = format!("({} ** {})", a.as_float().atom(), b.as_float().atom());
                        Value::expression(text, Width::Float)
                    }
                    other => {
                        return Err(Person::new(
                            Mark::NoCounterpart,
                            format!("{} beside floats inside CPT", other.symbol()),
                        ));
                    }
                }
            }
        })
    }

    /// A float divisor that is never zero: where it would be, the trap is set and 1.0 stands instead.
    fn divisor(&mut self, cx: &mut Context<'_>, e: &mut Emitter, value: &Value) -> Value {
        if value.known_float().is_some_and(|value| value != 0.0) {
            return value.clone();
        }
        let scratch = if value.is_float() { cx.scratch_float(self.number()) } else { cx.scratch_long(self.number()) };
        let divisor = settled(e, value, &scratch);
        let (zero, one) = if value.is_float() { ("0.0", "1.0") } else { ("0", "1") };
        zero_divisor(cx, e, &divisor, zero);
        let operand = divisor.text();
        let text = format!("IF({operand} == {zero}, {one}, {operand})");
        match value.is_float() {
            true => Value::call(text, Width::Float),
            false => Value::call(text, divisor.width),
        }
    }
}

/// Sets the trap where a divisor inside an expression is zero.
fn zero_divisor(cx: &mut Context<'_>, e: &mut Emitter, divisor: &Value, zero: &str) {
    cx.condition(
        Mark::Fault,
        "where a divisor inside CPT is zero, the trap S:5/0 is set as there, but the value stored differs",
    );
    let trap = cx.minor_error_bit(0);
    let operand = divisor.plain().unwrap_or_default().to_owned();
    e.when(|e| {
        e.and_compare(Relation::Equal, &operand, zero);
        e.set(&trap);
    });
}
