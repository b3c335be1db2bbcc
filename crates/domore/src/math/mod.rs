//! MATH expressions: read into a tree of names and numbers, written back, and evaluated on memory.
//!
//! Operators are those of the vendor's list, with the ranks of C; which functions exist is
//! [`FUNCTIONS`], with the evidence for each name.

mod eval;
mod parse;

use std::fmt;

use crate::address::{Address, Constant, Operand};
use crate::instruction::Evidence;

pub use eval::{Formula, Trouble};
pub(crate) use eval::{IndexedPlace, compare};
pub use parse::ExpressionError;

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// An element, a constant.
    Operand(Operand),
    /// `-a`, `~a`, `!a`.
    Unary(Unary, Box<Expression>),
    /// `a + b`.
    Binary(Binary, Box<Expression>, Box<Expression>),
    /// `ROUND(a)`.
    Call(&'static Function, Vec<Expression>),
}

/// Operators with one operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unary {
    /// `-`
    Negate,
    /// `~`
    Invert,
    /// `!`
    Not,
}

/// Operators with two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binary {
    /// `||`
    Or,
    /// `&&`
    And,
    /// `|`
    BitOr,
    /// `^`
    BitXor,
    /// `&`
    BitAnd,
    /// `==`
    Equal,
    /// `!=`
    NotEqual,
    /// `<`
    Less,
    /// `<=`
    LessOrEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterOrEqual,
    /// `<<`
    ShiftLeft,
    /// `>>`: the sign is kept.
    ShiftRight,
    /// `>>>`: zeros come in.
    ShiftRightUnsigned,
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `%`
    Remainder,
    /// `**`
    Power,
}

/// Sign, operator, rank (a higher one binds more). Longer signs stand before their beginnings.
pub(crate) const BINARY: &[(&str, Binary, u8)] = &[
    (">>>", Binary::ShiftRightUnsigned, 8),
    ("||", Binary::Or, 1),
    ("&&", Binary::And, 2),
    ("==", Binary::Equal, 6),
    ("!=", Binary::NotEqual, 6),
    ("<>", Binary::NotEqual, 6),
    ("<=", Binary::LessOrEqual, 7),
    (">=", Binary::GreaterOrEqual, 7),
    ("<<", Binary::ShiftLeft, 8),
    (">>", Binary::ShiftRight, 8),
    ("**", Binary::Power, 11),
    ("|", Binary::BitOr, 3),
    ("^", Binary::BitXor, 4),
    ("&", Binary::BitAnd, 5),
    ("<", Binary::Less, 7),
    (">", Binary::Greater, 7),
    ("+", Binary::Add, 9),
    ("-", Binary::Subtract, 9),
    ("*", Binary::Multiply, 10),
    ("/", Binary::Divide, 10),
    ("%", Binary::Remainder, 10),
];

/// A function of MATH.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// Its name in capitals.
    pub name: &'static str,
    /// Least and most arguments.
    pub arguments: (usize, usize),
    /// How well name and arguments are known.
    pub evidence: Evidence,
    pub(crate) does: Does,
}

impl PartialEq for Function {
    fn eq(&self, other: &Function) -> bool {
        self.name == other.name
    }
}

/// What a function computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Does {
    If,
    Round,
    Truncate,
    Fraction,
    Absolute,
    ToReal,
    ToInteger,
    SquareRoot,
    NaturalLogarithm,
    Logarithm,
    Exponential,
    Sine,
    Cosine,
    Tangent,
    ArcSine,
    ArcCosine,
    ArcTangent,
    Pi,
    Euler,
    Minimum,
    Maximum,
    /// Over a range of elements: first element and count.
    RangeAverage,
    RangeSum,
    RangeMinimum,
    RangeMaximum,
}

const fn function(name: &'static str, least: usize, most: usize, evidence: Evidence, does: Does) -> Function {
    Function { name, arguments: (least, most), evidence, does }
}

/// Functions that are evaluated. Angles are radians. (inferred)
pub const FUNCTIONS: &[Function] = &[
    function("IF", 3, 3, Evidence::Export, Does::If),
    function("ROUND", 1, 1, Evidence::Export, Does::Round),
    function("TRUNC", 1, 1, Evidence::Export, Does::Truncate),
    function("FRAC", 1, 1, Evidence::Export, Does::Fraction),
    function("ABS", 1, 1, Evidence::Export, Does::Absolute),
    function("TOREAL", 1, 1, Evidence::Export, Does::ToReal),
    function("AVGR", 2, 2, Evidence::Export, Does::RangeAverage),
    function("SQRT", 1, 1, Evidence::Inferred, Does::SquareRoot),
    function("LN", 1, 1, Evidence::Inferred, Does::NaturalLogarithm),
    function("LOG", 1, 1, Evidence::Inferred, Does::Logarithm),
    function("EXP", 1, 1, Evidence::Inferred, Does::Exponential),
    function("SIN", 1, 1, Evidence::Inferred, Does::Sine),
    function("COS", 1, 1, Evidence::Inferred, Does::Cosine),
    function("TAN", 1, 1, Evidence::Inferred, Does::Tangent),
    function("ASIN", 1, 1, Evidence::Inferred, Does::ArcSine),
    function("ACOS", 1, 1, Evidence::Inferred, Does::ArcCosine),
    function("ATAN", 1, 1, Evidence::Inferred, Does::ArcTangent),
    function("PI", 0, 0, Evidence::Inferred, Does::Pi),
    function("E", 0, 0, Evidence::Inferred, Does::Euler),
    function("TOINT", 1, 1, Evidence::Inferred, Does::ToInteger),
    function("MIN", 2, 8, Evidence::Inferred, Does::Minimum),
    function("MAX", 2, 8, Evidence::Inferred, Does::Maximum),
    function("SUMR", 2, 2, Evidence::Inferred, Does::RangeSum),
    function("MINR", 2, 2, Evidence::Inferred, Does::RangeMinimum),
    function("MAXR", 2, 2, Evidence::Inferred, Does::RangeMaximum),
];

impl Expression {
    /// Every address in it, those in index brackets included, with whether it is the first element of a
    /// range. Addresses that do not read are left out: parsing has refused them.
    pub fn addresses(&self) -> Vec<(Address, bool)> {
        let mut found = Vec::new();
        self.collect(&mut found, false);
        found
    }

    fn collect(&self, found: &mut Vec<(Address, bool)>, range: bool) {
        match self {
            Expression::Operand(Operand::Address(address)) => {
                if let crate::address::Element::Indexed { expression, .. } = &address.element
                    && let Ok(inner) = Expression::parse(expression)
                {
                    inner.collect(found, false);
                }
                found.push((address.clone(), range));
            }
            Expression::Operand(_) => {}
            Expression::Unary(_, operand) => operand.collect(found, false),
            Expression::Binary(_, left, right) => {
                left.collect(found, false);
                right.collect(found, false);
            }
            Expression::Call(function, arguments) => {
                let ranged = matches!(
                    function.does,
                    Does::RangeAverage | Does::RangeSum | Does::RangeMinimum | Does::RangeMaximum
                );
                for (index, argument) in arguments.iter().enumerate() {
                    argument.collect(found, ranged && index == 0);
                }
            }
        }
    }

    /// Functions it calls.
    pub fn functions(&self) -> Vec<&'static Function> {
        match self {
            Expression::Operand(_) => Vec::new(),
            Expression::Unary(_, operand) => operand.functions(),
            Expression::Binary(_, left, right) => {
                let mut found = left.functions();
                found.extend(right.functions());
                found
            }
            Expression::Call(function, arguments) => {
                std::iter::once(*function).chain(arguments.iter().flat_map(Expression::functions)).collect()
            }
        }
    }

    /// A whole number.
    pub fn integer(value: i64) -> Expression {
        let constant = Constant { value: crate::address::Number::Integer(value), text: value.to_string() };
        Expression::Operand(Operand::Constant(constant))
    }

    fn rank(&self) -> u8 {
        match self {
            Expression::Binary(operator, ..) => rank(*operator),
            Expression::Unary(..) => 12,
            _ => 13,
        }
    }
}

fn rank(operator: Binary) -> u8 {
    BINARY.iter().find(|row| row.1 == operator).map_or(0, |row| row.2)
}

impl fmt::Display for Expression {
    /// With the brackets it needs and blanks around operators.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let part = |f: &mut fmt::Formatter<'_>, part: &Expression, least: u8| {
            if part.rank() < least { write!(f, "({part})") } else { write!(f, "{part}") }
        };
        match self {
            Expression::Operand(operand) => write!(f, "{operand}"),
            Expression::Unary(operator, operand) => {
                f.write_str(match operator {
                    Unary::Negate => "-",
                    Unary::Invert => "~",
                    Unary::Not => "!",
                })?;
                // A sign before a sign or a negative number would read as something else.
                let bracketed = matches!(**operand, Expression::Unary(..)) || operand.to_string().starts_with('-');
                if bracketed { write!(f, "({operand})") } else { part(f, operand, 13) }
            }
            Expression::Binary(operator, left, right) => {
                let sign = BINARY.iter().find(|row| row.1 == *operator).map_or("", |row| row.0);
                let rank = rank(*operator);
                let power = *operator == Binary::Power;
                part(f, left, if power { 13 } else { rank })?;
                write!(f, " {sign} ")?;
                part(f, right, if power { rank } else { rank + 1 })
            }
            Expression::Call(function, arguments) => {
                write!(f, "{}(", function.name)?;
                for (index, argument) in arguments.iter().enumerate() {
                    write!(f, "{}{argument}", if index > 0 { ", " } else { "" })?;
                }
                f.write_str(")")
            }
        }
    }
}

#[cfg(test)]
mod tests;
