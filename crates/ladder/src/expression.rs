//! CPT expressions: ` ( N7:62 * 1.5 ) + 500.0 `.
//!
//! Infix with `+ - * |` (division), `**`, `AND`, `OR`, `XOR`, `MOD` and functions before their
//! operand. RSLogix writes parentheses around every nesting; the tree keeps them by structure, and
//! [`Display`](fmt::Display) writes them back, so text settles.

use std::fmt;

use crate::operand::Operand;

/// A CPT expression.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// An address, constant or symbol.
    Value(Box<Operand>),
    /// `function operand`, e.g. `SIN F8:0`, `- N7:0`.
    Unary(Function, Box<Expression>),
    /// `left operator right`.
    Binary(Operator, Box<Expression>, Box<Expression>),
    /// Parentheses as written.
    Group(Box<Expression>),
}

/// A binary operator, in RSLogix's spelling.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // named by what they compute
pub enum Operator {
    Or,
    Xor,
    And,
    Add,
    Subtract,
    Multiply,
    Divide,
    Modulo,
    Power,
}

const OPERATORS: &[(Operator, &str, u8)] = &[
    (Operator::Or, "OR", 1),
    (Operator::Xor, "XOR", 2),
    (Operator::And, "AND", 3),
    (Operator::Add, "+", 4),
    (Operator::Subtract, "-", 4),
    (Operator::Multiply, "*", 5),
    (Operator::Divide, "|", 5),
    (Operator::Modulo, "MOD", 5),
    (Operator::Power, "**", 6),
];

impl Operator {
    /// The spelling: `|` divides.
    pub fn symbol(self) -> &'static str {
        OPERATORS.iter().find(|row| row.0 == self).map_or("?", |row| row.1)
    }

    /// Binding strength, larger binds tighter.
    pub fn precedence(self) -> u8 {
        OPERATORS.iter().find(|row| row.0 == self).map_or(0, |row| row.2)
    }

    fn from_symbol(text: &str) -> Option<Operator> {
        OPERATORS.iter().find(|row| row.1.eq_ignore_ascii_case(text)).map(|row| row.0)
    }
}

/// A function or sign before an operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // named by their mnemonics
pub enum Function {
    Negate,
    Not,
    Sqr,
    Abs,
    Ln,
    Log,
    Sin,
    Cos,
    Tan,
    Asn,
    Acs,
    Atn,
    Frd,
    Tod,
    Deg,
    Rad,
}

const FUNCTIONS: &[(Function, &str)] = &[
    (Function::Negate, "-"),
    (Function::Not, "NOT"),
    (Function::Sqr, "SQR"),
    (Function::Abs, "ABS"),
    (Function::Ln, "LN"),
    (Function::Log, "LOG"),
    (Function::Sin, "SIN"),
    (Function::Cos, "COS"),
    (Function::Tan, "TAN"),
    (Function::Asn, "ASN"),
    (Function::Acs, "ACS"),
    (Function::Atn, "ATN"),
    (Function::Frd, "FRD"),
    (Function::Tod, "TOD"),
    (Function::Deg, "DEG"),
    (Function::Rad, "RAD"),
];

impl Function {
    /// The spelling.
    pub fn symbol(self) -> &'static str {
        FUNCTIONS.iter().find(|row| row.0 == self).map_or("?", |row| row.1)
    }

    fn from_symbol(text: &str) -> Option<Function> {
        // Lists of CPT's operators name the sign by its instruction.
        if text.eq_ignore_ascii_case("NEG") {
            return Some(Function::Negate);
        }
        FUNCTIONS.iter().find(|row| row.1.eq_ignore_ascii_case(text)).map(|row| row.0)
    }
}

/// Why a text is not an expression.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExpressionError {
    /// Index of the token where reading stopped, from 0.
    pub token: usize,
    /// What an expression has there.
    pub expected: &'static str,
}

impl fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "not an expression: expected {} at token {}", self.expected, self.token + 1)
    }
}

impl std::error::Error for ExpressionError {}

/// Parentheses and signs nest at most this deep; the editor allows far fewer.
const MAX_DEPTH: usize = 64;

/// An expression has at most this many operators: `a + a + a ..` makes a tree as deep as it is long,
/// and the editor's limit is a few hundred characters.
const MAX_OPERATORS: usize = 1024;

impl Expression {
    /// Reads a whole text as one expression; tokens are separated by white space, parentheses need
    /// none.
    ///
    /// # Errors
    /// The token where the text stops being an expression.
    pub fn parse(text: &str) -> Result<Expression, ExpressionError> {
        let tokens = tokens(text);
        let (expression, used) = Expression::parse_prefix(&tokens)?;
        if used == tokens.len() {
            Ok(expression)
        } else {
            Err(ExpressionError { token: used, expected: "an operator or the end" })
        }
    }

    /// Reads the longest expression that `tokens` begins with and tells how many tokens it took:
    /// in rung text an expression ends before the first token that cannot continue it.
    ///
    /// # Errors
    /// The token where no expression can begin or go on.
    pub fn parse_prefix(tokens: &[&str]) -> Result<(Expression, usize), ExpressionError> {
        let mut parser = Parser { tokens, at: 0, operators: 0 };
        let expression = parser.binary(0, 0)?;
        Ok((expression, parser.at))
    }

    /// The operands in written order.
    pub fn operands(&self) -> Vec<&Operand> {
        let mut found = Vec::new();
        self.collect(&mut found);
        found
    }

    fn collect<'a>(&'a self, found: &mut Vec<&'a Operand>) {
        match self {
            Expression::Value(operand) => found.push(operand),
            Expression::Unary(_, inner) | Expression::Group(inner) => inner.collect(found),
            Expression::Binary(_, left, right) => {
                left.collect(found);
                right.collect(found);
            }
        }
    }
}

/// Splits at white space and around parentheses.
fn tokens(text: &str) -> Vec<&str> {
    let mut tokens = Vec::new();
    for word in text.split_whitespace() {
        let mut rest = word;
        while let Some(at) = rest.find(['(', ')']) {
            let (before, after) = rest.split_at(at);
            if !before.is_empty() {
                tokens.push(before);
            }
            tokens.push(&after[..1]);
            rest = &after[1..];
        }
        if !rest.is_empty() {
            tokens.push(rest);
        }
    }
    tokens
}

struct Parser<'a> {
    tokens: &'a [&'a str],
    at: usize,
    operators: usize,
}

impl Parser<'_> {
    fn expected(&self, expected: &'static str) -> ExpressionError {
        ExpressionError { token: self.at, expected }
    }

    fn binary(&mut self, lowest: u8, depth: usize) -> Result<Expression, ExpressionError> {
        let mut left = self.operand(depth)?;
        while let Some(operator) = self.tokens.get(self.at).and_then(|t| Operator::from_symbol(t)) {
            let precedence = operator.precedence();
            if precedence < lowest.max(1) {
                break;
            }
            self.operators += 1;
            if self.operators > MAX_OPERATORS {
                return Err(self.expected("a shorter expression"));
            }
            self.at += 1;
            let right = self.binary(precedence + 1, depth + 1)?;
            left = Expression::Binary(operator, Box::new(left), Box::new(right));
        }
        Ok(left)
    }

    fn operand(&mut self, depth: usize) -> Result<Expression, ExpressionError> {
        if depth > MAX_DEPTH {
            return Err(self.expected("fewer nested parentheses"));
        }
        let token = *self.tokens.get(self.at).ok_or_else(|| self.expected("an operand"))?;
        if token == "(" {
            self.at += 1;
            let inner = self.binary(0, depth + 1)?;
            if self.tokens.get(self.at) != Some(&")") {
                return Err(self.expected(")"));
            }
            self.at += 1;
            return Ok(Expression::Group(Box::new(inner)));
        }
        if let Some(function) = Function::from_symbol(token) {
            self.at += 1;
            let inner = self.operand(depth + 1)?;
            return Ok(Expression::Unary(function, Box::new(inner)));
        }
        match Operand::parse(token) {
            operand @ (Operand::Address(_) | Operand::Constant(_) | Operand::Symbol(_))
                if Operator::from_symbol(token).is_none() =>
            {
                self.at += 1;
                Ok(Expression::Value(Box::new(operand)))
            }
            _ => Err(self.expected("an address, a constant, a function or (")),
        }
    }
}

impl fmt::Display for Expression {
    /// Tokens separated by single spaces, without the leading and trailing space of stored texts.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Expression::Value(operand) => write!(f, "{operand}"),
            Expression::Unary(function, inner) => write!(f, "{} {inner}", function.symbol()),
            Expression::Binary(operator, left, right) => write!(f, "{left} {} {right}", operator.symbol()),
            Expression::Group(inner) => write!(f, "( {inner} )"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn settles(text: &str) -> Expression {
        let expression = Expression::parse(text).expect(text);
        assert_eq!(expression.to_string(), text.trim());
        expression
    }

    #[test]
    fn precedence_and_left_association() {
        let expression = settles(" ( N7:62 * 1.5 ) + 500.0 ");
        assert!(matches!(expression, Expression::Binary(Operator::Add, _, _)));
        let Expression::Binary(Operator::Subtract, left, _) = settles("N7:0 - N7:1 - N7:2") else {
            panic!("expected a subtraction at the top")
        };
        assert!(matches!(*left, Expression::Binary(Operator::Subtract, _, _)));
        let Expression::Binary(Operator::Add, _, right) = settles("N7:0 + N7:1 * N7:2") else {
            panic!("expected an addition at the top")
        };
        assert!(matches!(*right, Expression::Binary(Operator::Multiply, _, _)));
        settles("( ( F8:8 | N7:62 ) * 100.0 )");
        settles("SIN ( F8:0 ) ** 2.0 + - N7:0");
    }

    #[test]
    fn an_expression_ends_before_what_cannot_continue_it() {
        let tokens = ["N7:0", "+", "1", "OTE", "B3:0/0"];
        let (_, used) = Expression::parse_prefix(&tokens).expect("a sum");
        assert_eq!(used, 3);
        assert_eq!(Expression::parse("NEG N7:0"), Expression::parse("- N7:0"));
        assert!(Expression::parse("N7:0 +").is_err());
        assert!(Expression::parse(&"( ".repeat(100_000)).is_err());
        assert!(Expression::parse(&"- ".repeat(100_000)).is_err());
        assert!(Expression::parse(&format!("{}N7:0", "N7:0 + ".repeat(1_000_000))).is_err());
        assert!(Expression::parse("").is_err());
    }
}
