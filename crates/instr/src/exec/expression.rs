//! CPT: an expression in postfix form.
//!
//! Flags and rounding are those of the final store, as for MOV; an overflow on the way sets V too
//! (manual, unseen: the flags reflect the store; inferred: that an overflow is not forgotten). The
//! precision between the steps is not described: by default the whole expression is computed in floats
//! as soon as one operand is a float or one function needs floats, otherwise in 32-bit integers with
//! the rounding of DIV ([`Choice::CptStepwise`] decides step by step).

use ladder::{Expression, Function, Operand, Operator};

use super::choices::Choice;
use super::function;
use super::number::{Number, Outcome, Register, Width, convert};
use super::rules::MathMode;
use super::{Flags, conversion, logic, math};

/// A step of an expression in postfix order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step<T> {
    /// Puts an operand on the stack.
    Value(T),
    /// Replaces the top by a function of it.
    Unary(Function),
    /// Replaces the two on top by their combination; the right one is on top.
    Binary(Operator),
}

/// Values an expression may have waiting at once. RSLogix limits the text of an expression to 255
/// characters, which cannot need more.
pub const MAX_DEPTH: usize = 64;

/// The postfix form of a parsed expression, `resolve` turning each operand into what the caller
/// fetches values by.
///
/// # Errors
/// The first error of `resolve`.
pub fn postfix<T, E>(
    expression: &Expression,
    resolve: &mut impl FnMut(&Operand) -> Result<T, E>,
) -> Result<Vec<Step<T>>, E> {
    // An explicit stack: an expression nested as deep as its parser allows must not end this one.
    enum Work<'a> {
        Enter(&'a Expression),
        Unary(Function),
        Binary(Operator),
    }
    let (mut work, mut steps) = (vec![Work::Enter(expression)], Vec::new());
    while let Some(next) = work.pop() {
        match next {
            Work::Enter(Expression::Value(operand)) => steps.push(Step::Value(resolve(operand)?)),
            Work::Enter(Expression::Group(inner)) => work.push(Work::Enter(inner)),
            Work::Enter(Expression::Unary(function, inner)) => {
                work.push(Work::Unary(*function));
                work.push(Work::Enter(inner));
            }
            Work::Enter(Expression::Binary(operator, left, right)) => {
                work.push(Work::Binary(*operator));
                work.push(Work::Enter(right));
                work.push(Work::Enter(left));
            }
            Work::Unary(function) => steps.push(Step::Unary(function)),
            Work::Binary(operator) => steps.push(Step::Binary(operator)),
        }
    }
    Ok(steps)
}

/// The steps leave exactly one value and never more than [`MAX_DEPTH`] waiting: what [`evaluate`]
/// needs, to be asked when a program is loaded.
pub fn is_well_formed<T>(steps: &[Step<T>]) -> bool {
    let mut depth = 0_usize;
    for step in steps {
        let (needed, left) = match step {
            Step::Value(_) => (0, depth + 1),
            Step::Unary(_) => (1, depth),
            Step::Binary(_) => (2, depth.saturating_sub(1)),
        };
        if depth < needed || left > MAX_DEPTH {
            return false;
        }
        depth = left;
    }
    depth == 1
}

/// A function that has float results only.
fn real_function(function: Function) -> Option<function::Function> {
    use function::Function as Real;
    Some(match function {
        Function::Ln => Real::NaturalLog,
        Function::Log => Real::Log10,
        Function::Sin => Real::Sine,
        Function::Cos => Real::Cosine,
        Function::Tan => Real::Tangent,
        Function::Asn => Real::ArcSine,
        Function::Acs => Real::ArcCosine,
        Function::Atn => Real::ArcTangent,
        Function::Deg => Real::Degrees,
        Function::Rad => Real::Radians,
        Function::Negate | Function::Not | Function::Sqr | Function::Abs | Function::Frd | Function::Tod => {
            return None;
        }
    })
}

/// The expression is computed in floats: an operand is one, the destination is one, or a function in
/// it has no integer form. Fixed for a program, so it is asked once.
pub fn is_float<T>(steps: &[Step<T>], to: Width, width: impl Fn(&T) -> Width) -> bool {
    to == Width::Float
        || steps.iter().any(|step| match step {
            Step::Value(value) => width(value) == Width::Float,
            Step::Unary(function) => real_function(*function).is_some(),
            Step::Binary(operator) => *operator == Operator::Power,
        })
}

/// CPT: the value of the expression, stored as MOV stores it.
///
/// `float` is what [`is_float`] said. `None`: the steps are not well formed.
pub fn evaluate<T: Copy>(
    steps: &[Step<T>],
    mut fetch: impl FnMut(T) -> Number,
    float: bool,
    to: Width,
    mode: MathMode,
) -> Option<Outcome> {
    let whole =
        if mode.rules.has(Choice::CptStepwise) { None } else { Some(if float { Width::Float } else { Width::Long }) };
    let mut stack = [Number::Word(0); MAX_DEPTH];
    let (mut depth, mut overflow) = (0_usize, false);
    for step in steps {
        let (at, value) = match *step {
            Step::Value(operand) => {
                let value = fetch(operand);
                (depth, whole.map_or(value, |width| convert(value, width, mode).0))
            }
            Step::Unary(function) => {
                let at = depth.checked_sub(1)?;
                let (value, overflown) = unary(function, *stack.get(at)?, mode);
                overflow |= overflown;
                (at, value)
            }
            Step::Binary(operator) => {
                let at = depth.checked_sub(2)?;
                let (value, overflown) = binary(operator, *stack.get(at)?, *stack.get(at + 1)?, mode);
                overflow |= overflown;
                (at, value)
            }
        };
        *stack.get_mut(at)? = value;
        depth = at + 1;
    }
    if depth != 1 {
        return None;
    }
    let mut outcome = logic::mov(stack[0], to, mode);
    if overflow {
        outcome.flags = outcome.flags | Flags::OVERFLOW;
    }
    Some(outcome)
}

/// Intermediate integers have 32 bits.
fn joint(a: Number, b: Number) -> Width {
    if a.width() == Width::Float || b.width() == Width::Float { Width::Float } else { Width::Long }
}

fn taken(outcome: Outcome, otherwise: Number) -> (Number, bool) {
    (outcome.value.unwrap_or(otherwise), outcome.flags.has(Flags::OVERFLOW))
}

/// Bitwise operations and BCD are for integers; a float takes part rounded.
fn long(value: Number, mode: MathMode) -> Number {
    convert(value, Width::Long, mode).0
}

fn unary(function: Function, value: Number, mode: MathMode) -> (Number, bool) {
    if let Some(real) = real_function(function) {
        return taken(function::apply(real, value, Width::Float, mode), value);
    }
    let width = joint(value, value);
    let outcome = match function {
        Function::Abs => math::abs(value, width, mode),
        Function::Sqr => math::sqr(value, width, mode),
        Function::Not => logic::not(long(value, mode), Width::Long, mode),
        Function::Tod => match convert(value, Width::Word, mode).0 {
            Number::Word(word) => {
                let digits = conversion::tod(word).register.map_or(0, Register::long);
                math::integer(digits.into(), false, Width::Long, mode)
            }
            other => logic::mov(other, Width::Long, mode),
        },
        Function::Frd => match long(value, mode) {
            Number::Long(digits) => conversion::frd_register(Register::of_long(digits), Width::Long, mode),
            other => logic::mov(other, Width::Long, mode),
        },
        _ => math::neg(value, width, mode),
    };
    taken(outcome, value)
}

fn binary(operator: Operator, a: Number, b: Number, mode: MathMode) -> (Number, bool) {
    let width = joint(a, b);
    let bitwise =
        |op: fn(Number, Number, Width, MathMode) -> Outcome| op(long(a, mode), long(b, mode), Width::Long, mode);
    let outcome = match operator {
        Operator::Add => math::add(a, b, width, mode),
        Operator::Subtract => math::sub(a, b, width, mode),
        Operator::Multiply => math::mul(a, b, width, mode),
        Operator::Divide => math::div(a, b, width, mode),
        Operator::Modulo => return modulo(a, b, width, mode),
        Operator::Power => function::xpy(a, b, Width::Float, mode),
        Operator::And => bitwise(logic::and),
        Operator::Or => bitwise(logic::or),
        Operator::Xor => bitwise(logic::xor),
    };
    taken(outcome, a)
}

/// MOD: the remainder, with the sign of the dividend; by zero as in DIV (open: no page describes it).
fn modulo(a: Number, b: Number, width: Width, mode: MathMode) -> (Number, bool) {
    match (a.integer(), b.integer()) {
        (Some(x), Some(y)) => match x.checked_rem(y) {
            Some(remainder) => taken(math::integer(remainder, false, width, mode), a),
            None => (math::limit(width, false), true),
        },
        _ => taken(math::float(a.float() % b.float(), width, mode), a),
    }
}

#[cfg(test)]
mod tests;
