//! Expressions bound to memory, and their values.
//!
//! Integers are 32 bits, reals single precision at every step; a real on either side makes an operation
//! a real one. `IF` evaluates only the side it takes. Where documentation ends, [`Choices`] decide.

use super::{Binary, Does, Expression, Unary};
use crate::address::{Address, Constant, Element, Number, Operand};
use crate::choices::{Choice, Choices};
use crate::instruction::Relation;
use crate::memory::{Block, Data, Kind, Map, Num, Place, Resolved, member};

/// Why an expression has no value now. What it was for stays as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// Division or remainder by zero.
    DivideByZero,
    /// An index outside its block, or a range that leaves it.
    Index,
}

/// An expression whose names are places.
#[derive(Clone, Debug, PartialEq)]
pub struct Formula(Node);

#[derive(Clone, Debug, PartialEq)]
enum Node {
    Constant(Num),
    Place(Place),
    Indexed(Box<IndexedPlace>),
    Unary(Unary, Box<Node>),
    Binary(Binary, Box<(Node, Node)>),
    If(Box<(Node, Node, Node)>),
    One(Does, Box<Node>),
    Extreme(Does, Vec<Node>),
    Range(Does, Place, u32, u32, Box<Node>),
}

/// `Block[expression]` with member or cast.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct IndexedPlace {
    index: Formula,
    /// The place for element 0.
    first: Place,
    /// Bits from element to element.
    stride: u32,
    count: u32,
    /// First bit behind the block.
    end: u32,
}

impl IndexedPlace {
    pub(crate) fn bind(map: &Map, block: &Block, expression: &str, address: &Address) -> Result<Self, String> {
        let index = Formula::parse(expression, map)?;
        let stride = block.element.bits();
        let Resolved::Place(first) = member(block, 0, address)? else {
            return Err(format!("{} holds structures: name a member", block.name));
        };
        Ok(IndexedPlace { index, first, stride, count: block.count, end: block.start + block.count * stride })
    }

    /// Where it is now.
    pub(crate) fn place(&self, data: &Data, choices: Choices) -> Result<Place, Trouble> {
        let number = self.index.value(data, choices)?.integer(choices);
        let number = u32::try_from(number).ok().filter(|number| *number < self.count).ok_or(Trouble::Index)?;
        let bit = self.first.bit + number * self.stride;
        let (width, aligned) = match self.first.kind {
            Kind::Bit | Kind::Text(_) => (1, true),
            Kind::U8 | Kind::I8 => (8, bit.is_multiple_of(8)),
            Kind::U16 | Kind::I16 => (16, bit.is_multiple_of(8)),
            Kind::I32 | Kind::U32 | Kind::F32 => (32, bit.is_multiple_of(8)),
        };
        if !aligned || bit + width > self.end {
            return Err(Trouble::Index);
        }
        Ok(Place { bit, ..self.first })
    }
}

impl Formula {
    /// Reads an expression of a project and binds it to its memory.
    ///
    /// # Errors
    /// What does not read or stands for nothing, in words.
    pub fn parse(text: &str, map: &Map) -> Result<Formula, String> {
        let radix = |block: &str| map.radix(block);
        let expression = Expression::parse_with(text, &radix).map_err(|error| error.to_string())?;
        Formula::bind(&expression, map)
    }

    /// Binds an expression to memory.
    ///
    /// # Errors
    /// A name that stands for nothing, or for something without a value.
    pub fn bind(expression: &Expression, map: &Map) -> Result<Formula, String> {
        node(expression, map, 0).map(Formula)
    }

    /// The value now.
    ///
    /// # Errors
    /// It has none.
    #[inline]
    pub fn value(&self, data: &Data, choices: Choices) -> Result<Num, Trouble> {
        value(&self.0, data, choices)
    }
}

fn node(expression: &Expression, map: &Map, depth: usize) -> Result<Node, String> {
    // Index expressions nest in texts of their own, so the depth of the parser does not bound them.
    if depth > 400 {
        return Err("nested too deeply".to_owned());
    }
    let bind = |part: &Expression| node(part, map, depth + 1);
    Ok(match expression {
        Expression::Operand(Operand::Constant(constant)) => Node::Constant(match constant.value {
            Number::Integer(value) => Num::Int((value as i32).into()),
            Number::Real(value) => Num::Real(value),
        }),
        Expression::Operand(Operand::Quoted(_)) => return Err("text has no value".to_owned()),
        Expression::Operand(Operand::Address(address)) => address_node(address, map)?,
        // The sign belongs to a literal: 2147483648 alone has no place in 32 bits.
        Expression::Unary(Unary::Negate, operand) if let Some(value) = whole(operand) => {
            Node::Constant(Num::Int((value.wrapping_neg() as i32).into()))
        }
        Expression::Unary(operator, operand) => Node::Unary(*operator, Box::new(bind(operand)?)),
        Expression::Binary(operator, left, right) => Node::Binary(*operator, Box::new((bind(left)?, bind(right)?))),
        Expression::Call(function, arguments) => {
            let name = function.name;
            let missing = || format!("{name} lacks an argument");
            let argument = |index: usize| arguments.get(index).ok_or_else(missing);
            match function.does {
                Does::If => Node::If(Box::new((bind(argument(0)?)?, bind(argument(1)?)?, bind(argument(2)?)?))),
                Does::Pi => Node::Constant(Num::Real(std::f64::consts::PI)),
                Does::Euler => Node::Constant(Num::Real(std::f64::consts::E)),
                does @ (Does::Minimum | Does::Maximum) => {
                    Node::Extreme(does, arguments.iter().map(bind).collect::<Result<_, _>>()?)
                }
                does @ (Does::RangeAverage | Does::RangeSum | Does::RangeMinimum | Does::RangeMaximum) => {
                    let Expression::Operand(Operand::Address(first)) = argument(0)? else {
                        return Err(format!("{name} expects the first element of a range"));
                    };
                    let (place, stride, room) = range(first, map)?;
                    Node::Range(does, place, stride, room, Box::new(bind(argument(1)?)?))
                }
                does => Node::One(does, Box::new(bind(argument(0)?)?)),
            }
        }
    })
}

/// The number of a literal that is whole.
fn whole(expression: &Expression) -> Option<i64> {
    match expression {
        Expression::Operand(Operand::Constant(Constant { value: Number::Integer(value), .. })) => Some(*value),
        _ => None,
    }
}

/// A first element, the bits to the next one, and how many there are.
fn range(first: &Address, map: &Map) -> Result<(Place, u32, u32), String> {
    let Ok(Resolved::Place(place)) = map.resolve(first) else {
        return Err(format!("{first} is no element a range can begin with"));
    };
    let inside = |block: &&Block| {
        let end = block.start + block.count * block.element.bits();
        (block.start..end).contains(&place.bit)
    };
    let block = map.blocks().iter().find(inside).ok_or_else(|| format!("{first} stands in no block"))?;
    if first.cast.is_some() || first.field.is_some() {
        return Err(format!("{first}: ranges of casts or members are not modelled"));
    }
    let stride = block.element.bits();
    Ok((place, stride, block.count - (place.bit - block.start) / stride))
}

fn address_node(address: &Address, map: &Map) -> Result<Node, String> {
    match map.resolve(address).map_err(|error| error.to_string())? {
        Resolved::Place(Place { kind: Kind::Text(_), .. }) => Err(format!("{address} is a string")),
        Resolved::Place(place) => Ok(Node::Place(place)),
        Resolved::Constant(value) => Ok(Node::Constant(value)),
        Resolved::Structure(..) => Err(format!("{address} is a whole structure: name a member")),
        Resolved::Indexed { block, expression } => {
            let block = map.blocks().get(block).ok_or("no such block")?;
            // What stands in brackets is text as long as the parser takes; nesting shortens it each time.
            let indexed = IndexedPlace::bind(map, block, &expression, address)?;
            if matches!(address.element, Element::Indexed { .. }) && matches!(indexed.first.kind, Kind::Text(_)) {
                return Err(format!("{address} is a string"));
            }
            Ok(Node::Indexed(Box::new(indexed)))
        }
    }
}

/// An integer of 32 bits.
#[inline]
fn integer(value: i64, choices: Choices) -> Num {
    let wrapped = value as i32;
    if i64::from(wrapped) != value && choices.has(Choice::MathSaturates) {
        return Num::Int(if value < 0 { i32::MIN.into() } else { i32::MAX.into() });
    }
    Num::Int(wrapped.into())
}

#[inline]
fn real(value: f64, choices: Choices) -> Num {
    Num::Real(if choices.has(Choice::MathInDouble) { value } else { f64::from(value as f32) })
}

fn value(node: &Node, data: &Data, choices: Choices) -> Result<Num, Trouble> {
    match node {
        Node::Constant(Num::Int(value)) => Ok(Num::Int(*value)),
        Node::Constant(Num::Real(value)) => Ok(real(*value, choices)),
        Node::Place(place) => Ok(data.number(*place)),
        Node::Indexed(indexed) => indexed.place(data, choices).map(|place| data.number(place)),
        Node::Unary(operator, operand) => {
            let operand = value(operand, data, choices)?;
            Ok(match (operator, operand) {
                (Unary::Negate, Num::Int(value)) => integer(-value, choices),
                (Unary::Negate, Num::Real(value)) => Num::Real(-value),
                (Unary::Invert, operand) => Num::Int((!bits(operand)).into()),
                (Unary::Not, operand) => Num::Int((!operand.is_on()).into()),
            })
        }
        Node::Binary(operator, sides) => {
            let left = value(&sides.0, data, choices)?;
            // The right side of a decided && or || has no effect of its own; its trouble is none then.
            match operator {
                Binary::And if !left.is_on() => return Ok(Num::Int(0)),
                Binary::Or if left.is_on() => return Ok(Num::Int(1)),
                _ => {}
            }
            let right = value(&sides.1, data, choices)?;
            binary(*operator, left, right, choices)
        }
        Node::If(parts) => {
            let taken = if value(&parts.0, data, choices)?.is_on() { &parts.1 } else { &parts.2 };
            value(taken, data, choices)
        }
        Node::One(does, operand) => {
            let operand = value(operand, data, choices)?;
            Ok(one(*does, operand, choices))
        }
        Node::Extreme(does, operands) => {
            let mut best: Option<Num> = None;
            for operand in operands {
                let value = value(operand, data, choices)?;
                best = Some(best.map_or(value, |best| extreme(*does == Does::Minimum, best, value)));
            }
            Ok(best.unwrap_or(Num::Int(0)))
        }
        Node::Range(does, first, stride, room, count) => {
            let count = value(count, data, choices)?.integer(choices);
            let count = u32::try_from(count).ok().filter(|count| (1..=*room).contains(count)).ok_or(Trouble::Index)?;
            let values = (0..count).map(|number| data.number(Place { bit: first.bit + number * stride, ..*first }));
            Ok(over_range(*does, values, count, choices))
        }
    }
}

fn over_range(does: Does, mut values: impl Iterator<Item = Num>, count: u32, choices: Choices) -> Num {
    match does {
        Does::RangeMinimum | Does::RangeMaximum => {
            let first = values.next().unwrap_or(Num::Int(0));
            values.fold(first, |best, value| extreme(does == Does::RangeMinimum, best, value))
        }
        Does::RangeSum => values.fold(Num::Int(0), |sum, value| match (sum, value) {
            (Num::Int(sum), Num::Int(value)) => integer(sum + value, choices),
            (sum, value) => real(sum.real() + value.real(), choices),
        }),
        _ => real(values.map(Num::real).sum::<f64>() / f64::from(count), choices),
    }
}

fn extreme(least: bool, a: Num, b: Num) -> Num {
    let takes_b = if least { compare(Relation::Less, b, a) } else { compare(Relation::Greater, b, a) };
    if takes_b { b } else { a }
}

/// 32 bits as they are; a real becomes the whole number first.
fn bits(value: Num) -> i32 {
    match value {
        Num::Int(value) => value as i32,
        Num::Real(value) => value as i32,
    }
}

/// Compares two numbers by value, whatever their types.
#[inline]
pub(crate) fn compare(relation: Relation, a: Num, b: Num) -> bool {
    if let (Num::Int(a), Num::Int(b)) = (a, b) {
        return match relation {
            Relation::Equal => a == b,
            Relation::NotEqual => a != b,
            Relation::Greater => a > b,
            Relation::GreaterOrEqual => a >= b,
            Relation::Less => a < b,
            Relation::LessOrEqual => a <= b,
        };
    }
    let (a, b) = (a.real(), b.real());
    match relation {
        Relation::Equal => a == b,
        Relation::NotEqual => a != b,
        Relation::Greater => a > b,
        Relation::GreaterOrEqual => a >= b,
        Relation::Less => a < b,
        Relation::LessOrEqual => a <= b,
    }
}

#[inline]
fn binary(operator: Binary, left: Num, right: Num, choices: Choices) -> Result<Num, Trouble> {
    let truth = |relation| Ok(Num::Int(compare(relation, left, right).into()));
    let on_bits = |operation: fn(i32, i32) -> i32| Ok(Num::Int(operation(bits(left), bits(right)).into()));
    match operator {
        Binary::Equal => return truth(Relation::Equal),
        Binary::NotEqual => return truth(Relation::NotEqual),
        Binary::Less => return truth(Relation::Less),
        Binary::LessOrEqual => return truth(Relation::LessOrEqual),
        Binary::Greater => return truth(Relation::Greater),
        Binary::GreaterOrEqual => return truth(Relation::GreaterOrEqual),
        Binary::Or | Binary::And => return Ok(Num::Int(right.is_on().into())),
        Binary::BitOr => return on_bits(|a, b| a | b),
        Binary::BitXor => return on_bits(|a, b| a ^ b),
        Binary::BitAnd => return on_bits(|a, b| a & b),
        Binary::ShiftLeft => return on_bits(|a, b| u32::try_from(b).ok().and_then(|b| a.checked_shl(b)).unwrap_or(0)),
        Binary::ShiftRight => return on_bits(|a, b| a >> b.clamp(0, 31)),
        Binary::ShiftRightUnsigned => {
            return on_bits(|a, b| u32::try_from(b).ok().and_then(|b| (a as u32).checked_shr(b)).unwrap_or(0) as i32);
        }
        _ => {}
    }
    if matches!(operator, Binary::Divide | Binary::Remainder) && !right.is_on() {
        return if choices.has(Choice::DivideByZeroGivesZero) { Ok(Num::Int(0)) } else { Err(Trouble::DivideByZero) };
    }
    if let (Num::Int(a), Num::Int(b)) = (left, right) {
        let result = match operator {
            Binary::Add => a + b,
            Binary::Subtract => a - b,
            Binary::Multiply => a * b,
            Binary::Divide => a / b,
            Binary::Remainder => a % b,
            _ if b >= 0 => return Ok(power(a, b, choices)),
            _ => return Ok(real((a as f64).powf(b as f64), choices)),
        };
        return Ok(integer(result, choices));
    }
    let (a, b) = (left.real(), right.real());
    Ok(real(
        match operator {
            Binary::Add => a + b,
            Binary::Subtract => a - b,
            Binary::Multiply => a * b,
            Binary::Divide => a / b,
            Binary::Remainder => a % b,
            _ => a.powf(b),
        },
        choices,
    ))
}

/// An integer power, each product of 32 bits.
fn power(base: i64, exponent: i64, choices: Choices) -> Num {
    // Beyond 32 factors the product is 0, 1, -1 or has left 32 bits for good: 64 show which.
    let even = exponent % 2 == 0;
    let factors = if exponent > 64 { if even { 64 } else { 65 } } else { exponent };
    let mut product = 1i64;
    for _ in 0..factors {
        match integer(product * i64::from(base as i32), choices) {
            Num::Int(next) => product = next,
            Num::Real(_) => {}
        }
    }
    Num::Int(product)
}

fn one(does: Does, operand: Num, choices: Choices) -> Num {
    let on_real = |operation: fn(f64) -> f64| real(operation(operand.real()), choices);
    match (does, operand) {
        // A whole number is its own rounding.
        (Does::Round | Does::Truncate | Does::ToInteger, Num::Int(_)) => operand,
        (Does::Round, _) if choices.has(Choice::RoundHalfEven) => on_real(f64::round_ties_even),
        (Does::Round, _) => on_real(f64::round),
        (Does::Truncate, _) => on_real(f64::trunc),
        (Does::ToInteger, Num::Real(value)) => Num::Int((value as i32).into()),
        (Does::Fraction, _) => on_real(f64::fract),
        (Does::Absolute, Num::Int(value)) => integer(value.abs(), choices),
        (Does::Absolute, _) => on_real(f64::abs),
        (Does::SquareRoot, _) => on_real(f64::sqrt),
        (Does::NaturalLogarithm, _) => on_real(f64::ln),
        (Does::Logarithm, _) => on_real(f64::log10),
        (Does::Exponential, _) => on_real(f64::exp),
        (Does::Sine, _) => on_real(f64::sin),
        (Does::Cosine, _) => on_real(f64::cos),
        (Does::Tangent, _) => on_real(f64::tan),
        (Does::ArcSine, _) => on_real(f64::asin),
        (Does::ArcCosine, _) => on_real(f64::acos),
        (Does::ArcTangent, _) => on_real(f64::atan),
        _ => on_real(|value| value),
    }
}
