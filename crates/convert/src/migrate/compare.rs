//! EQU, NEQ, LES, LEQ, GRT, GEQ, LIM and MEQ as contacts.
//!
//! Numbers of one kind compare the same on both sides. A word beside a float constant is compared
//! with the whole number that decides; other mixtures of integers and floats hold under a condition.

use instr::exec::Width;
use ladder::Instruction;

use super::context::{Context, Converted, Person};
use super::emit::{Contact, Emitter, Relation};
use super::marks::Mark;
use super::operand::operand;
use super::store::settled;
use super::table::{Row, row};
use super::value::Value;

pub(super) const TABLE: &[Row] = &[
    relation_row("EQU"),
    relation_row("NEQ"),
    relation_row("LES"),
    relation_row("LEQ"),
    relation_row("GRT"),
    relation_row("GEQ"),
    row("LIM", limit),
    row("MEQ", masked_equal),
];

const fn relation_row(mnemonic: &'static str) -> Row {
    Row { mnemonic, convert: compare, contact: Some(plain) }
}

fn relation_of(mnemonic: &str) -> Relation {
    match mnemonic {
        "EQU" => Relation::Equal,
        "NEQ" => Relation::NotEqual,
        "LES" => Relation::Less,
        "LEQ" => Relation::LessOrEqual,
        "GRT" => Relation::Greater,
        _ => Relation::GreaterOrEqual,
    }
}

fn relation_in(instruction: &Instruction) -> Relation {
    relation_of(instruction.mnemonic.name().unwrap_or_default())
}

/// `a R b` as `b R' a`.
fn mirrored(relation: Relation) -> Relation {
    match relation {
        Relation::Less => Relation::Greater,
        Relation::LessOrEqual => Relation::GreaterOrEqual,
        Relation::Greater => Relation::Less,
        Relation::GreaterOrEqual => Relation::LessOrEqual,
        same => same,
    }
}

fn holds<T: PartialOrd>(relation: Relation, a: T, b: T) -> bool {
    match relation {
        Relation::Equal => a == b,
        Relation::NotEqual => a != b,
        Relation::Less => a < b,
        Relation::LessOrEqual => a <= b,
        Relation::Greater => a > b,
        Relation::GreaterOrEqual => a >= b,
    }
}

/// A contact that always or never passes.
fn certain(passes: bool) -> Contact {
    let bit = super::emit::ALWAYS.to_owned();
    if passes { Contact::On(bit) } else { Contact::Off(bit) }
}

/// The contact of a comparison whose operands stand by themselves.
fn plain(cx: &mut Context<'_>, instruction: &Instruction) -> Option<Contact> {
    let (first, second) = (operand(instruction, 0).ok()?, operand(instruction, 1).ok()?);
    let long = cx.any_long(&[first, second]);
    let (a, b) = (cx.value(first, long).ok()?, cx.value(second, long).ok()?);
    contact(cx, relation_in(instruction), &a, &b)
}

fn compare(cx: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    let (first, second) = (operand(instruction, 0)?, operand(instruction, 1)?);
    let long = cx.any_long(&[first, second]);
    let (a, b) = (cx.value(first, long)?, cx.value(second, long)?);
    let (a, b) = (placed(cx, e, &a, 0), placed(cx, e, &b, 1));
    if let Some(contact) = contact(cx, relation_in(instruction), &a, &b) {
        e.contact(&contact);
    }
    Ok(())
}

/// The value as an operand of contacts: computed into a scratch unless it is one.
fn placed(cx: &mut Context<'_>, e: &mut Emitter, value: &Value, number: usize) -> Value {
    if value.plain().is_some() {
        return value.clone();
    }
    let scratch = if value.is_float() { cx.scratch_float(number) } else { cx.scratch_long(number) };
    settled(e, value, &scratch)
}

/// The contact `a relation b`; `None` when an operand cannot stand in a contact.
fn contact(cx: &mut Context<'_>, relation: Relation, a: &Value, b: &Value) -> Option<Contact> {
    if let (Some(a), Some(b)) = (a.constant, b.constant) {
        let passes = match (a.integer(), b.integer()) {
            (Some(a), Some(b)) => holds(relation, a, b),
            _ => holds(relation, a.float(), b.float()),
        };
        return Some(certain(passes));
    }
    if a.constant.is_some() && b.constant.is_none() {
        return contact(cx, mirrored(relation), b, a);
    }
    let (left, right) = (a.plain()?.to_owned(), b.plain()?.to_owned());
    if let Some(instr::exec::Number::Float(value)) = b.constant
        && a.width == Width::Word
    {
        return Some(beside_float(relation, &left, value));
    }
    if a.is_float() || b.is_float() {
        floats(cx, a, b);
    } else if let Some(value) = b.known()
        && !(a.low..=a.high).contains(&value)
    {
        // Beyond what the operand can hold the answer is known.
        return Some(certain(holds(relation, a.low, value)));
    }
    Some(Contact::Compare(relation, left, right))
}

/// Conditions of a comparison of floats.
fn floats(cx: &mut Context<'_>, a: &Value, b: &Value) {
    if a.width != b.width {
        cx.condition(Mark::Rounding, "integers and floats compare by value, the integer as single precision");
    }
    for value in [a, b] {
        if let Some(instr::exec::Number::Float(number)) = value.constant
            && number.to_string().parse() != Ok(f64::from(number))
        {
            cx.condition(Mark::Rounding, format!("the constant {number} is compared in single precision"));
        }
    }
}

/// A word against a float constant: against the whole number that decides.
fn beside_float(relation: Relation, word: &str, limit: f32) -> Contact {
    let whole = limit.fract() == 0.0;
    let contact = |relation, number: f32| {
        let number = number as i64;
        if (-32_768..=32_767).contains(&number) {
            Contact::Compare(relation, word.to_owned(), number.to_string())
        } else {
            certain(holds(relation, 0, number))
        }
    };
    match relation {
        Relation::Equal | Relation::NotEqual if !whole => certain(relation == Relation::NotEqual),
        Relation::Greater | Relation::LessOrEqual => contact(relation, limit.floor()),
        Relation::Less | Relation::GreaterOrEqual => contact(relation, limit.ceil()),
        _ => contact(relation, limit),
    }
}

/// LIM: inside the limits; with the low limit above the high one, outside or on them.
fn limit(cx: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    let operands = [operand(instruction, 0)?, operand(instruction, 1)?, operand(instruction, 2)?];
    let long = cx.any_long(&operands);
    let mut values = Vec::with_capacity(3);
    for (number, operand) in operands.into_iter().enumerate() {
        let value = cx.value(operand, long)?;
        values.push(placed(cx, e, &value, number));
    }
    let [low, test, high] = values.as_slice() else { return Ok(()) };
    let mut pair = |relation, a: &Value, b: &Value| contact(cx, relation, a, b).unwrap_or_else(|| certain(false));
    let (above, below) = (pair(Relation::GreaterOrEqual, test, low), pair(Relation::LessOrEqual, test, high));
    let crossed = match (low.constant, high.constant) {
        (Some(low), Some(high)) => Some(match (low.integer(), high.integer()) {
            (Some(low), Some(high)) => low > high,
            _ => low.float() > high.float(),
        }),
        _ => None,
    };
    let alone = e.depth() == 0;
    match crossed {
        Some(false) => {
            e.contact(&above);
            e.contact(&below);
        }
        Some(true) => {
            e.store(&above);
            e.or(&below);
            join(e, alone);
        }
        None => {
            let crossing = pair(Relation::Greater, low, high);
            e.store(&above);
            e.contact(&below);
            e.store(&crossing);
            e.store(&above);
            e.or(&below);
            e.join_and();
            e.join_or();
            join(e, alone);
        }
    }
    Ok(())
}

/// A group that was pushed goes in series with the power flow before it, if there was any.
fn join(e: &mut Emitter, alone: bool) {
    if !alone {
        e.join_and();
    }
}

/// MEQ: source and compare agree in the bits of the mask.
fn masked_equal(cx: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    let operands = [operand(instruction, 0)?, operand(instruction, 1)?, operand(instruction, 2)?];
    let long = cx.any_long(&[operands[0], operands[2]]);
    let [source, mask, wanted] = operands;
    let (source, mask, wanted) = (cx.value(source, long)?, cx.value(mask, long)?, cx.value(wanted, long)?);
    if [&source, &mask, &wanted].iter().any(|value| value.is_float()) {
        return Err(Person::new(Mark::Operand, "MEQ of floats"));
    }
    let (left, right) = (source.bit_and(&mask), wanted.bit_and(&mask));
    let (left, right) = (placed(cx, e, &left, 0), placed(cx, e, &right, 1));
    if let Some(contact) = contact(cx, Relation::Equal, &left, &right) {
        e.contact(&contact);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_beside_a_float_compares_with_the_deciding_integer() {
        let text = |relation, limit| match beside_float(relation, "N0", limit) {
            Contact::Compare(relation, a, b) => format!("{a} {} {b}", relation.sign()),
            Contact::On(_) => "always".to_owned(),
            Contact::Off(_) => "never".to_owned(),
        };
        assert_eq!(text(Relation::Greater, 2.5), "N0 > 2");
        assert_eq!(text(Relation::GreaterOrEqual, 2.5), "N0 >= 3");
        assert_eq!(text(Relation::Less, -2.5), "N0 < -2");
        assert_eq!(text(Relation::LessOrEqual, -2.5), "N0 <= -3");
        assert_eq!(text(Relation::Equal, 0.0), "N0 == 0");
        assert_eq!(text(Relation::Equal, 0.5), "never");
        assert_eq!(text(Relation::NotEqual, 0.5), "always");
        assert_eq!(text(Relation::Less, 1e6), "always");
        assert_eq!(text(Relation::Less, -1e6), "never");
        for word in [-3_i16, -2, 0, 2, 3, i16::MAX, i16::MIN] {
            for limit in [-2.5_f32, 0.0, 2.5, 3.0, 32767.5, -32768.0] {
                for name in ["EQU", "NEQ", "LES", "LEQ", "GRT", "GEQ"] {
                    let relation = relation_of(name);
                    let expected = holds(relation, f32::from(word), limit);
                    let actual = match beside_float(relation, "N0", limit) {
                        Contact::Compare(relation, _, b) => holds(relation, i64::from(word), b.parse().unwrap()),
                        Contact::On(_) => true,
                        Contact::Off(_) => false,
                    };
                    assert_eq!(actual, expected, "{name} {word} {limit}");
                }
            }
        }
    }
}
