//! Results into their destinations, with what else a math instruction leaves behind: the overflow
//! trap S:5/0, the flags S:0 and the math register S:13, S:14.
//!
//! A result is computed in 32 bits, limited (or cut to its low bits with S:2/14), then stored. Where
//! the bounds of the operands show that it fits, nothing of this is emitted; flags and register are
//! kept up only in programs that name them.

use instr::exec::{Lineage, Number, Width, math};
use ladder::{FileType, Operand};

use super::context::{Context, Converted};
use super::emit::{Emitter, Relation};
use super::marks::Mark;
use super::operand::Target;
use super::value::{Value, choose, limited, limits, relation, wrapped};

/// What happens to an integer that does not fit: S:2/14.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Wrap {
    /// It is limited.
    Never,
    /// It keeps its low bits.
    Always,
    /// This bit decides.
    By(String),
}

/// How the carry flag comes out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Carry {
    /// Reset.
    Off,
    /// 1 or 0 as this expression says; read before the result is stored.
    Is(String),
}

/// The scratches this module uses; callers keep theirs below.
const WHOLE: usize = 8;
const KEPT: usize = 9;
const CARRY: usize = 10;
const PART: usize = 8;

impl Context<'_> {
    /// What S:2/14 says, as far as it is known.
    pub(super) fn wrap(&mut self) -> Wrap {
        if self.rules.lineage == Lineage::S1 {
            return Wrap::Never;
        }
        if self.facts.names_status(2) {
            return Wrap::By(self.status_bit(2, 14));
        }
        let status = self.image.data_file(FileType::S, 2);
        let word = status.and_then(|file| file.words.get(2)).copied().unwrap_or(0);
        if word & 1 << 14 == 0 { Wrap::Never } else { Wrap::Always }
    }

    /// An operand that is read, with its bounds.
    pub(super) fn value(&mut self, operand: &Operand, long: bool) -> Converted<Value> {
        let term = self.read(operand, long)?;
        Ok(match term.constant {
            Some(ladder::Number::Integer(value)) => Value::integer(value),
            Some(ladder::Number::Float(value)) => Value::real(value),
            None if term.plain => Value::element(term.text, term.width),
            None => Value::indexed(term.text, term.width),
        })
    }
}

/// The destination operand of MATH: a blank would end it.
pub(super) fn destination(target: &Target) -> String {
    target.text.replace(' ', "")
}

/// Moves a value of the destination's own kind there.
pub(super) fn put(e: &mut Emitter, value: &Value, target: &Target) {
    match value.plain() {
        Some(plain) if target.plain => e.mov(plain, &target.text),
        _ => e.math(&destination(target), value.text()),
    }
}

/// The value as an operand of contacts and boxes: through the D word `scratch` unless it is one.
pub(super) fn settled(e: &mut Emitter, value: &Value, scratch: &str) -> Value {
    if value.plain().is_some() {
        return value.clone();
    }
    e.math(scratch, value.text());
    Value::element(scratch, value.width).bounded(value.low, value.high)
}

/// Stores an integer result whose value 32 bits hold.
pub(super) fn integer(cx: &mut Context<'_>, e: &mut Emitter, result: &Value, carry: &Carry, target: &Target) {
    let wrap = cx.wrap();
    integer_as(cx, e, result, carry, target, &wrap);
}

/// As [`integer`], with S:2/14 as given: some instructions ignore it.
pub(super) fn integer_as(
    cx: &mut Context<'_>,
    e: &mut Emitter,
    result: &Value,
    carry: &Carry,
    target: &Target,
    wrap: &Wrap,
) {
    if target.width == Width::Float {
        return float(cx, e, &result.as_float(), target);
    }
    let flags = cx.facts.names_status(0);
    if flags && let Carry::Is(expression) = carry {
        let scratch = cx.scratch_long(CARRY);
        e.math(&scratch, expression);
    }
    let fits = result.fits(target.width);
    // What is compared and flagged afterwards must be an operand that stays what it is.
    let kept = if target.plain { target.text.clone() } else { cx.scratch_long(KEPT) };
    let via = Target { text: kept.clone(), width: target.width, plain: true };
    if fits {
        if target.plain || !flags {
            put(e, result, target);
        } else {
            put(e, result, &via);
            e.math(&destination(target), &kept);
        }
        if flags {
            store_flags(cx, e, carry, "0", &kept);
        }
        return;
    }
    let whole = settled(e, result, &cx.scratch_long(WHOLE));
    let stored = match wrap {
        Wrap::Never => limited(&whole, target.width),
        _ if target.width == Width::Long => whole.clone(),
        Wrap::Always => wrapped(&whole),
        Wrap::By(bit) => choose(&format!("{bit} == 1"), &wrapped(&whole), &limited(&whole, target.width)),
    };
    // The value itself may stand in the destination; then it has to be looked at first.
    let shown = whole.plain().unwrap_or_default().to_owned();
    let whole = if shown == kept {
        let scratch = cx.scratch_long(WHOLE);
        e.mov(&shown, &scratch);
        scratch
    } else {
        shown
    };
    put(e, &stored, &via);
    if !target.plain {
        e.math(&destination(target), &kept);
    }
    trap_unless_equal(cx, e, &whole, &kept);
    if flags {
        store_flags(cx, e, carry, &format!("IF({whole} == {kept}, 0, 2)"), &kept);
    }
}

/// Sets the overflow trap while the two operands differ.
pub(super) fn trap_unless_equal(cx: &mut Context<'_>, e: &mut Emitter, whole: &str, kept: &str) {
    let trap = cx.minor_error_bit(0);
    e.when(|e| {
        e.and_compare(Relation::NotEqual, whole, kept);
        e.set(&trap);
    });
}

/// S:0 after an instruction: `overflow` is an expression that gives 2 or 0.
fn store_flags(cx: &mut Context<'_>, e: &mut Emitter, carry: &Carry, overflow: &str, kept: &str) {
    let word = cx.status_word(0);
    let mut text = format!("({word} & (-16)) + IF({kept} == 0, 4, 0) + IF({kept} < 0, 8, 0)");
    if overflow != "0" {
        text.push_str(" + ");
        text.push_str(overflow);
    }
    if let Carry::Is(_) = carry {
        text.push_str(&format!(" + {}", cx.scratch_long(CARRY)));
    }
    e.math(&word, &text);
}

/// S:0 after an instruction whose flags are known in advance.
pub(super) fn fixed_flags(cx: &mut Context<'_>, e: &mut Emitter, bits: u16) {
    if cx.facts.names_status(0) {
        let word = cx.status_word(0);
        e.math(&word, &format!("({word} & (-16)) + {bits}"));
    }
}

/// The math register gets the halves of a 32-bit value, where the program looks at it.
pub(super) fn register_long(cx: &mut Context<'_>, e: &mut Emitter, product: &Value) {
    let low = product.bit_and(&Value::integer(65_535));
    let high = format!("({} - {}) / 65536", product.atom(), low.atom());
    let high = Value::expression(high, Width::Word);
    register(cx, e, &wrapped(product), &high);
}

/// The math register gets two words, where the program looks at it.
pub(super) fn register(cx: &mut Context<'_>, e: &mut Emitter, low: &Value, high: &Value) {
    for (word, value) in [(13, low), (14, high)] {
        if cx.facts.names_status(word) {
            let text = cx.status_word(word);
            e.math(&text, value.text());
        }
    }
}

/// The program looks at S:13 or S:14.
pub(super) fn has_register(cx: &Context<'_>) -> bool {
    cx.facts.names_status(13) || cx.facts.names_status(14)
}

/// Stores a float result; into an integer it is rounded, halves to the even one, and limited.
pub(super) fn float(cx: &mut Context<'_>, e: &mut Emitter, result: &Value, target: &Target) {
    if let Some(Number::Float(value)) = result.constant
        && target.width != Width::Float
    {
        // A constant is rounded here.
        let mode = cx.rules.math(0);
        let outcome = instr::exec::logic::mov(Number::Float(value), target.width, mode);
        let stored = outcome.value.and_then(Number::integer).unwrap_or(0);
        if outcome.flags.has(instr::exec::Flags::OVERFLOW) {
            let trap = cx.minor_error_bit(0);
            e.set(&trap);
        }
        put(e, &Value::integer(stored), target);
        fixed_flags(cx, e, outcome.flags.bits());
        return;
    }
    match target.width {
        Width::Float => {
            put(e, result, target);
            if cx.facts.names_status(0) {
                cx.condition(Mark::MathRegister, "S:0 of floats: V is not set by a result beyond 3.4E38");
                let kept = if target.plain { target.text.clone() } else { result.text().to_owned() };
                float_flags(cx, e, &kept);
            }
        }
        Width::Word => {
            let source = float_scratch(cx, e, result);
            // Not-a-number is below nothing and takes the upper limit.
            let near = Value::expression(
                format!("IF({source} < 40000.0, IF({source} < -40000.0, -40000.0, {source}), 40000.0)"),
                Width::Float,
            );
            let whole = rounded(cx, e, &near).bounded(-40_000, 40_000);
            integer_as(cx, e, &whole, &Carry::Off, target, &Wrap::Never);
        }
        Width::Long => {
            let source = float_scratch(cx, e, result);
            // 2147483520 is the largest float that fits.
            let near = Value::expression(
                format!(
                    "IF({source} < 2147483520.0, IF({source} < -2147483648.0, -2147483648.0, {source}), 2147483520.0)"
                ),
                Width::Float,
            );
            let whole = rounded(cx, e, &near);
            let trap = cx.minor_error_bit(0);
            for (relation, limit) in [(Relation::Greater, "2147483520.0"), (Relation::Less, "-2147483648.0")] {
                e.when(|e| {
                    e.and_compare(relation, &source, limit);
                    e.set(&trap);
                });
            }
            let top = Value::integer(i64::from(i32::MAX));
            put(e, &choose(&format!("{source} > 2147483520.0"), &top, &whole), target);
            if cx.facts.names_status(0) {
                let overflow = format!("IF({source} > 2147483520.0, 2, 0) + IF({source} < -2147483648.0, 2, 0)");
                store_flags(cx, e, &Carry::Off, &overflow, whole.text());
            }
        }
    }
    cx.condition(Mark::Rounding, FLOAT);
}

/// What every conversion of float arithmetic assumes.
pub(super) const FLOAT: &str = "floats are ordinary numbers of single precision: infinity, not-a-number and results beyond \
                         3.4E38, which stop the original with fault 0020, are not reproduced";

/// The float as a plain operand.
fn float_scratch(cx: &mut Context<'_>, e: &mut Emitter, value: &Value) -> String {
    match value.plain() {
        Some(plain) => plain.to_owned(),
        None => {
            let scratch = cx.scratch_float(PART);
            e.math(&scratch, value.text());
            scratch
        }
    }
}

/// The nearest integer of a float inside 32 bits, halves to the even one, in a scratch D word. Built
/// from TRUNC, which leaves no room for readings.
fn rounded(cx: &mut Context<'_>, e: &mut Emitter, near: &Value) -> Value {
    let (part, whole) = (cx.scratch_float(PART + 1), cx.scratch_long(WHOLE));
    e.math(&part, near.text());
    e.math(&whole, &format!("TRUNC({part})"));
    e.math(&part, &format!("{part} - TOREAL({whole})"));
    let step = format!("IF(ABS({part}) > 0.5, 1, IF(ABS({part}) == 0.5, ABS({whole}) % 2, 0))");
    e.math(&whole, &format!("{whole} + {step} * IF({part} < 0.0, -1, 1)"));
    Value::element(whole, Width::Long)
}

fn float_flags(cx: &mut Context<'_>, e: &mut Emitter, kept: &str) {
    let word = cx.status_word(0);
    e.math(&word, &format!("({word} & (-16)) + IF({kept} == 0.0, 4, 0) + IF({kept} < 0.0, 8, 0)"));
}

/// Stores a sum or difference of which one operand or the destination is a long word: what leaves 32
/// bits is limited (or cut).
pub(super) fn long_sum(
    cx: &mut Context<'_>,
    e: &mut Emitter,
    (a, b): (&Value, &Value),
    minus: bool,
    carry: &Carry,
    target: &Target,
) {
    let sum = if minus { a.minus(b) } else { a.plus(b) };
    let wrap = cx.wrap();
    if sum.fits(Width::Long) || target.width == Width::Float {
        return integer_as(cx, e, &sum, carry, target, &wrap);
    }
    let (low, high) = limits(Width::Long);
    let (top, bottom) = (Value::integer(high), Value::integer(low));
    // Each side is tested without leaving 32 bits: a + b > MAX is a > MAX - b for b > 0.
    let zero = Value::integer(0);
    let positive = if b.low >= 0 { b.clone() } else { choose(&relation(b, ">", &zero), b, &zero) };
    let negative = if b.high <= 0 { b.clone() } else { choose(&relation(b, "<", &zero), b, &zero) };
    let (over, under) = if minus {
        (top.plus(&negative), bottom.plus(&positive))
    } else {
        (top.minus(&positive), bottom.minus(&negative))
    };
    let mut test = Value::integer(0);
    if sum.low < low {
        test = choose(&relation(a, "<", &under), &Value::integer(-1), &test);
    }
    if sum.high > high {
        test = choose(&relation(a, ">", &over), &Value::integer(1), &test);
    }
    let side = settled(e, &test, &cx.scratch_long(KEPT));
    let side = side.text().to_owned();
    // 2^32 less or more, in steps that stay inside 32 bits: two of 2^31 - 1, and 2.
    let (two, whole) = (Value::integer(2), (low, high));
    let inside = |value: &Value| value.clone().bounded(whole.0, whole.1);
    let beside = |value: &Value, other: &Value| if minus { value.plus(other) } else { value.minus(other) };
    let lower = inside(&a.minus(&top).minus(&beside(&top, b)).minus(&two));
    let higher = if minus {
        inside(&a.plus(&top).plus(&top.minus(b)).plus(&two))
    } else {
        inside(&a.plus(&top).plus(&b.plus(&top)).plus(&two))
    };
    let chosen = |limit: &Value, cut: &Value| match &wrap {
        Wrap::Never => limit.clone(),
        Wrap::Always => cut.clone(),
        Wrap::By(bit) => choose(&format!("{bit} == 1"), cut, limit),
    };
    let mut value = sum.clone().bounded(low, high);
    if sum.low < low {
        value = choose(&format!("{side} == -1"), &chosen(&bottom, &higher), &value);
    }
    if sum.high > high {
        value = choose(&format!("{side} == 1"), &chosen(&top, &lower), &value);
    }
    if wrap != Wrap::Never && target.width != Width::Long {
        cx.condition(Mark::MathRegister, "S:2/14: a 32-bit sum beyond 32 bits, cut to a word, is formed from 32 bits");
    }
    let trap = cx.minor_error_bit(0);
    e.when(|e| {
        e.and_compare(Relation::NotEqual, &side, "0");
        e.set(&trap);
    });
    if target.width != Width::Long {
        integer_as(cx, e, &value, carry, target, &wrap);
    } else if cx.facts.names_status(0) {
        if let Carry::Is(expression) = carry {
            let scratch = cx.scratch_long(CARRY);
            e.math(&scratch, expression);
        }
        let kept = if target.plain { target.text.clone() } else { cx.scratch_long(WHOLE) };
        put(e, &value, &Target { text: kept.clone(), width: Width::Long, plain: true });
        if !target.plain {
            e.math(&destination(target), &kept);
        }
        store_flags(cx, e, carry, &format!("IF({side} == 0, 0, 2)"), &kept);
    } else {
        put(e, &value, target);
    }
}

/// Carry of A + B, or borrow of A - B, as of unsigned numbers of the destination's width.
pub(super) fn carry_of(a: &Value, b: &Value, minus: bool, width: Width) -> Carry {
    match width {
        Width::Float => Carry::Off,
        Width::Word => {
            let mask = Value::integer(65_535);
            let (low_a, low_b) = (a.bit_and(&mask), b.bit_and(&mask));
            Carry::Is(if minus {
                format!("IF({} < {}, 1, 0)", low_a.atom(), low_b.atom())
            } else {
                format!("IF({} + {} > 65535, 1, 0)", low_a.atom(), low_b.atom())
            })
        }
        // Expressions have signs: of unsigned numbers those below 0 are the large ones.
        Width::Long => {
            let (a, b) = (a.atom(), b.atom());
            Carry::Is(if minus {
                format!("IF({a} < 0, IF({b} < 0, IF({a} < {b}, 1, 0), 0), IF({b} < 0, 1, IF({a} < {b}, 1, 0)))")
            } else {
                let meets = format!("IF({a} + {b} < 0, 0, 1)");
                format!("IF({a} < 0, IF({b} < 0, 1, {meets}), IF({b} < 0, {meets}, 0))")
            })
        }
    }
}

/// The rounding of DIV on two known integers.
pub(super) fn known_quotient(cx: &Context<'_>, a: i64, b: i64) -> Option<i64> {
    let number = |value: i64| i32::try_from(value).ok().map(Number::Long);
    let outcome = math::div(number(a)?, number(b)?, Width::Long, cx.rules.math(0));
    (b != 0).then_some(()).and(outcome.value).and_then(Number::integer)
}
