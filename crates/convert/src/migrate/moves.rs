//! MOV, MVM, AND, OR, XOR, NOT, and the conversions TOD, FRD, DCD, ENC, GCD and SWP.

use instr::exec::Width;
use ladder::{Instruction, Operand};

use super::context::{Context, Converted, Person};
use super::emit::{Emitter, Relation};
use super::marks::Mark;
use super::math::unary;
use super::operand::{Target, operand};
use super::store::{Carry, FLOAT, Wrap, fixed_flags, float, has_register, integer, integer_as, put, settled};
use super::table::{Row, row};
use super::value::{Value, choose, relation};

pub(super) const TABLE: &[Row] = &[
    row("MOV", mov),
    row("MVM", masked),
    row("AND", |cx, e, i| bitwise(cx, e, i, Value::bit_and)),
    row("OR", |cx, e, i| bitwise(cx, e, i, Value::bit_or)),
    row("XOR", |cx, e, i| bitwise(cx, e, i, Value::bit_xor)),
    row("NOT", not),
    row("TOD", to_bcd),
    row("FRD", from_bcd),
    row("DCD", decode),
    row("ENC", encode),
    row("GCD", from_gray),
];

fn mov(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (source, to) = unary(cx, i)?;
    match (source.width, to.width) {
        (Width::Float, Width::Float) => {
            put(e, &source, &to);
            if cx.facts.names_status(0) {
                float(cx, e, &source, &to);
            }
        }
        (Width::Float, _) => {
            if source.constant.is_none() {
                cx.condition(Mark::Rounding, FLOAT);
            }
            float(cx, e, &source, &to);
        }
        (width, Width::Float) => {
            if width == Width::Long && source.constant.is_none() {
                cx.condition(Mark::Rounding, "a long word becomes the nearest float");
            }
            let value = if source.constant.is_some() { source.as_float() } else { source };
            put(e, &value, &to);
            fixed_or_integer_flags(cx, e, &value, &to);
        }
        _ => integer(cx, e, &source, &Carry::Off, &to),
    }
    Ok(())
}

/// Flags of an integer moved to a float.
fn fixed_or_integer_flags(cx: &mut Context<'_>, e: &mut Emitter, value: &Value, to: &Target) {
    if !cx.facts.names_status(0) {
        return;
    }
    match value.known_float() {
        Some(number) => fixed_flags(
            cx,
            e,
            if number == 0.0 {
                4
            } else if number < 0.0 {
                8
            } else {
                0
            },
        ),
        None => float(cx, e, value, to),
    }
}

/// Bit patterns have no float form; the original refuses them too.
fn no_floats(values: &[&Value], to: &Target, name: &str) -> Converted {
    if to.width == Width::Float || values.iter().any(|value| value.is_float()) {
        return Err(Person::new(Mark::Operand, format!("{name} of floats")));
    }
    Ok(())
}

/// Stores a bit pattern: a narrower destination takes the low bits, without overflow.
fn pattern(cx: &mut Context<'_>, e: &mut Emitter, value: &Value, to: &Target) {
    let stored = if to.width == Width::Word && !value.fits(Width::Word) {
        let value = settled(e, value, &cx.scratch_long(2));
        super::value::wrapped(&value)
    } else {
        value.clone()
    };
    integer(cx, e, &stored, &Carry::Off, to);
}

fn bitwise(
    cx: &mut Context<'_>,
    e: &mut Emitter,
    i: &Instruction,
    operation: fn(&Value, &Value) -> Value,
) -> Converted {
    let operands = [operand(i, 0)?, operand(i, 1)?, operand(i, 2)?];
    let long = cx.any_long(&operands);
    let [a, b, to] = operands;
    let (a, b, to) = (cx.value(a, long)?, cx.value(b, long)?, cx.write(to)?);
    no_floats(&[&a, &b], &to, i.mnemonic.name().unwrap_or_default())?;
    pattern(cx, e, &operation(&a, &b), &to);
    Ok(())
}

fn not(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (source, to) = unary(cx, i)?;
    no_floats(&[&source], &to, "NOT")?;
    pattern(cx, e, &source.inverted(), &to);
    Ok(())
}

/// MVM: the bits of the source that are 1 in the mask, the other bits of the destination.
fn masked(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let operands = [operand(i, 0)?, operand(i, 1)?, operand(i, 2)?];
    let long = cx.any_long(&[operands[0], operands[2]]);
    let [source, mask, to] = operands;
    let (source, mask) = (cx.value(source, long)?, cx.value(mask, long)?);
    let old = cx.value(to, long)?;
    let to = cx.write(to)?;
    no_floats(&[&source, &mask], &to, "MVM")?;
    pattern(cx, e, &blend(&source, &mask, &old), &to);
    Ok(())
}

/// `old` with the bits of `source` where `mask` is 1.
pub(super) fn blend(source: &Value, mask: &Value, old: &Value) -> Value {
    match mask.known() {
        Some(-1) => source.clone(),
        Some(0) => old.clone(),
        _ => old.bit_and(&mask.inverted()).bit_or(&source.bit_and(mask)),
    }
}

/// The low 16 bits of an operand as a number from 0 to 65535.
fn low_word(value: &Value) -> Value {
    match value.known() {
        Some(known) => Value::integer(known & 0xFFFF),
        None => value.bit_and(&Value::integer(0xFFFF)),
    }
}

/// A number from 0 to 65535 as a signed word.
fn signed(value: &Value) -> Value {
    let top = Value::integer(32_767);
    choose(&relation(value, ">", &top), &value.minus(&Value::integer(65_536)), value).bounded(-32_768, 32_767)
}

/// S:13 as the operand means the register of both words.
fn is_register(operand: &Operand) -> bool {
    operand.address().is_some_and(|address| {
        address.file_type == ladder::FileType::S && address.element.number() == Some(13) && address.bit.is_none()
    })
}

/// TOD: the magnitude as BCD, low four digits; five of them in the math register.
fn to_bcd(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let to_register = is_register(operand(i, 1)?);
    let (source, to) = unary(cx, i)?;
    if source.is_float() || to.width == Width::Float || !source.fits(Width::Word) {
        return Err(Person::new(Mark::Operand, "TOD of other than words"));
    }
    let negative = relation(&source, "<", &Value::integer(0));
    let flags = cx.facts.names_status(0);
    let sign = cx.scratch_long(6);
    if flags {
        e.math(&sign, &format!("IF({negative}, 8, 0)"));
    }
    let size = cx.scratch_long(2);
    e.math(&size, source.magnitude().text());
    let digits = cx.scratch_long(3);
    e.math(
        &digits,
        &format!("{size} % 10 + ({size} / 10) % 10 * 16 + ({size} / 100) % 10 * 256 + ({size} / 1000) % 10 * 4096"),
    );
    let low = Value::element(digits.clone(), Width::Long).bounded(0, 0x9999);
    let stored = signed(&low);
    put(e, &stored, &to);
    if has_register(cx) || to_register {
        let high = Value::expression(format!("{size} / 10000"), Width::Word).bounded(0, 3);
        super::store::register(cx, e, &stored, &high);
    }
    let trap = cx.minor_error_bit(0);
    e.when(|e| {
        e.and_compare(Relation::Greater, &size, "9999");
        e.set(&trap);
    });
    if flags {
        let word = cx.status_word(0);
        e.math(&word, &format!("({word} & (-16)) + IF({size} > 9999, 2, 0) + IF({digits} == 0, 4, 0) + {sign}"));
    }
    Ok(())
}

/// FRD: BCD digits to an integer; with a digit above 9 the destination keeps its value.
fn from_bcd(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let from_register = is_register(operand(i, 0)?);
    let (source, to) = unary(cx, i)?;
    if source.is_float() || to.width == Width::Float {
        return Err(Person::new(Mark::Operand, "FRD of other than words"));
    }
    let (bits, digits) = (cx.scratch_long(2), cx.scratch_long(3));
    e.math(&bits, low_word(&source).text());
    let places = [(1, 1), (16, 10), (256, 100), (4096, 1000)];
    let mut value: Vec<String> = places.iter().map(|(place, weight)| digit(&bits, *place, *weight)).collect();
    let mut worst: Vec<String> = places.iter().map(|(place, _)| wrong(&bits, *place)).collect();
    let mut high = 15 * 1111;
    if from_register {
        // Five digits are what 16 bits can hold; a larger value is limited in any case.
        let upper = cx.scratch_long(4);
        let word = cx.status_word(14);
        e.math(&upper, &format!("{word} & 65535"));
        let top = [(1, 10_000), (16, 100_000), (256, 1_000_000), (4096, 10_000_000)];
        value.extend(top.iter().map(|(place, weight)| digit(&upper, *place, *weight)));
        worst.extend(top.iter().map(|(place, _)| wrong(&upper, *place)));
        high = 15 * 11_111_111;
    }
    let bad = cx.scratch_long(5);
    e.math(&bad, &worst.join(" + "));
    e.math(&digits, &value.join(" + "));
    let value = Value::element(digits, Width::Long).bounded(0, high);
    let trap = cx.minor_error_bit(0);
    // A destination in the operands changes nothing: all digits are read.
    e.when(|e| {
        e.and_compare(Relation::NotEqual, &bad, "0");
        e.set(&trap);
        fixed_flags(cx, e, 2);
    });
    e.when(|e| {
        e.and_compare(Relation::Equal, &bad, "0");
        integer_as(cx, e, &value, &Carry::Off, &to, &Wrap::Never);
    });
    Ok(())
}

fn digit(bits: &str, place: u32, weight: u32) -> String {
    match (place, weight) {
        (1, 1) => format!("{bits} % 16"),
        (1, _) => format!("{bits} % 16 * {weight}"),
        _ => format!("({bits} / {place}) % 16 * {weight}"),
    }
}

fn wrong(bits: &str, place: u32) -> String {
    match place {
        1 => format!("IF({bits} % 16 > 9, 1, 0)"),
        _ => format!("IF(({bits} / {place}) % 16 > 9, 1, 0)"),
    }
}

/// GCD: Gray code to an integer. A source with its high bit set is beyond 32767: the limit and the trap, whatever
/// S:2/14 says.
fn from_gray(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (source, to) = unary(cx, i)?;
    if source.width != Width::Word || to.width != Width::Word {
        return Err(Person::new(Mark::Operand, "GCD of other than words"));
    }
    let bits = cx.scratch_long(2);
    e.math(&bits, low_word(&source).text());
    for shift in [256, 16, 4, 2] {
        // Without a sign, so that dividing shifts and what both have in common is never more than either.
        let shifted = format!("({bits} / {shift})");
        e.math(&bits, &format!("({bits} | {shifted}) - ({bits} & {shifted})"));
    }
    let value = Value::element(bits, Width::Long).bounded(0, 65_535);
    integer_as(cx, e, &value, &Carry::Off, &to, &Wrap::Never);
    Ok(())
}

/// DCD: one bit set, the one numbered by the low four bits of the source.
fn decode(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (source, to) = unary(cx, i)?;
    no_floats(&[&source], &to, "DCD")?;
    let bits = source.bit_and(&Value::integer(15));
    if let Some(number) = bits.known() {
        let value = 1_i64 << number;
        put(e, &Value::integer(if number == 15 && to.width == Width::Word { -32_768 } else { value }), &to);
        return Ok(());
    }
    let bits = settled(e, &bits, &cx.scratch_long(2));
    let power = |low: &str, high: &str| format!("IF(({0} & {low}) > 0, {high}, 1)", bits.text());
    let text = format!("{} * {} * {} * {}", power("1", "2"), power("2", "4"), power("4", "16"), power("8", "256"));
    let value = Value::expression(text, Width::Long).bounded(1, 32_768);
    let value = if to.width == Width::Word {
        let value = settled(e, &value, &cx.scratch_long(3));
        signed(&value)
    } else {
        value
    };
    put(e, &value, &to);
    Ok(())
}

/// ENC: the number of the lowest bit that is set.
fn encode(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (source, to) = unary(cx, i)?;
    no_floats(&[&source], &to, "ENC")?;
    let (bits, lowest) = (cx.scratch_long(2), cx.scratch_long(3));
    e.math(&bits, low_word(&source).text());
    e.math(&lowest, &format!("{bits} & (-{bits})"));
    let part = |mask: u32, weight: u32| format!("IF(({lowest} & {mask}) > 0, {weight}, 0)");
    let text =
        [(43_690, 1), (52_428, 2), (61_680, 4), (65_280, 8)].map(|(mask, weight)| part(mask, weight)).join(" + ");
    put(e, &Value::expression(text, Width::Word).bounded(0, 15), &to);
    let trap = cx.minor_error_bit(0);
    e.when(|e| {
        e.and_compare(Relation::NotEqual, &bits, &lowest);
        e.set(&trap);
    });
    if cx.facts.names_status(0) {
        let word = cx.status_word(0);
        e.math(&word, &format!("({word} & (-16)) + IF({bits} == {lowest}, 0, 2) + IF({bits} == 0, 4, 0)"));
    }
    Ok(())
}
