//! Text to expression.

use std::fmt;

use super::{BINARY, Expression, FUNCTIONS, Unary};
use crate::address::{Operand, Radix};

/// Brackets, signs and calls nest at most this deep. Designer allows 8 levels of brackets.
const MOST_DEPTH: usize = 48;

/// Index brackets nest at most this deep.
const MOST_BRACKETS: usize = 8;

/// Longest expression that is read.
const LONGEST: usize = 16_384;

/// Why a text is no expression, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExpressionError {
    /// Place in the text, in bytes from 0.
    pub offset: usize,
    /// What is wrong there.
    pub message: String,
}

impl fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expression, character {}: {}", self.offset + 1, self.message)
    }
}

impl std::error::Error for ExpressionError {}

impl Expression {
    /// Reads an expression of the default project, without the quotes around it.
    ///
    /// # Errors
    /// The first place where no expression goes on.
    pub fn parse(text: &str) -> Result<Expression, ExpressionError> {
        Expression::parse_with(text, &Radix::of_block)
    }

    /// Reads an expression with the radix a project declares for its blocks.
    ///
    /// # Errors
    /// As [`Expression::parse`].
    pub fn parse_with(text: &str, radix: &dyn Fn(&str) -> Radix) -> Result<Expression, ExpressionError> {
        let mut parser = Parser { text, at: 0, depth: 0, radix };
        if text.len() > LONGEST {
            return Err(parser.error(format!("more than {LONGEST} characters")));
        }
        // What stands in brackets is read as an expression of its own, level by level.
        if brackets(text) > MOST_BRACKETS {
            return Err(parser.error(format!("more than {MOST_BRACKETS} levels of index brackets")));
        }
        let expression = parser.binary(1)?;
        parser.blanks();
        if parser.at < text.len() {
            return Err(parser.error("expected an operator or the end".to_owned()));
        }
        Ok(expression)
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    radix: &'a dyn Fn(&str) -> Radix,
}

impl Parser<'_> {
    fn rest(&self) -> &str {
        self.text.get(self.at..).unwrap_or("")
    }

    fn error(&self, message: String) -> ExpressionError {
        ExpressionError { offset: self.at, message }
    }

    fn blanks(&mut self) {
        let rest = self.rest();
        self.at += rest.len() - rest.trim_start().len();
    }

    fn take(&mut self, sign: &str) -> bool {
        self.blanks();
        let found = self.rest().starts_with(sign);
        self.at += if found { sign.len() } else { 0 };
        found
    }

    fn deeper(&mut self) -> Result<(), ExpressionError> {
        self.depth += 1;
        if self.depth > MOST_DEPTH { Err(self.error(format!("more than {MOST_DEPTH} levels"))) } else { Ok(()) }
    }

    /// Operands joined by operators of at least this rank.
    fn binary(&mut self, least: u8) -> Result<Expression, ExpressionError> {
        self.deeper()?;
        let mut left = self.unary()?;
        // A long chain makes a tree as deep as itself on the left.
        let mut links = 0usize;
        loop {
            self.blanks();
            // The longest sign first, then its rank: `||` of too low a rank is no `|`.
            let found = BINARY.iter().find(|row| self.rest().starts_with(row.0));
            let Some((sign, operator, rank)) = found.filter(|row| row.2 >= least) else { break };
            links += 1;
            if links > 200 {
                return Err(self.error("more than 200 operators in a row".to_owned()));
            }
            self.at += sign.len();
            let power = *operator == super::Binary::Power;
            let right = self.binary(if power { *rank } else { rank + 1 })?;
            left = Expression::Binary(*operator, Box::new(left), Box::new(right));
        }
        self.depth -= 1;
        Ok(left)
    }

    fn unary(&mut self) -> Result<Expression, ExpressionError> {
        for (sign, operator) in [("-", Unary::Negate), ("~", Unary::Invert), ("!", Unary::Not)] {
            self.blanks();
            if self.rest().starts_with(sign) && !self.rest().starts_with("!=") {
                self.deeper()?;
                self.at += sign.len();
                let operand = self.unary()?;
                self.depth -= 1;
                return Ok(Expression::Unary(operator, Box::new(operand)));
            }
        }
        if self.take("(") {
            let inside = self.binary(1)?;
            return if self.take(")") { Ok(inside) } else { Err(self.error("expected )".to_owned())) };
        }
        self.operand()
    }

    fn operand(&mut self) -> Result<Expression, ExpressionError> {
        let end = self.at + token(self.rest());
        let word = self.text.get(self.at..end).unwrap_or("");
        if word.is_empty() {
            let found = self.rest().chars().next().map_or("the end".to_owned(), |c| format!("`{c}`"));
            return Err(self.error(format!("expected an element, number or function, found {found}")));
        }
        if self.text.get(end..).unwrap_or("").trim_start().starts_with('(') {
            return self.call(end);
        }
        match Operand::parse_with(word, self.radix) {
            Ok(Operand::Quoted(_)) | Err(_) => {
                let why = Operand::parse_with(word, self.radix).err().map(|error| error.to_string());
                Err(self.error(why.unwrap_or_else(|| "text has no value".to_owned())))
            }
            Ok(operand) => {
                self.at = end;
                Ok(Expression::Operand(operand))
            }
        }
    }

    fn call(&mut self, end: usize) -> Result<Expression, ExpressionError> {
        let word = self.text.get(self.at..end).unwrap_or("");
        let Some(function) = FUNCTIONS.iter().find(|function| function.name.eq_ignore_ascii_case(word)) else {
            return Err(self.error(format!("function {word} is not known")));
        };
        let start = self.at;
        self.at = end;
        self.deeper()?;
        self.take("(");
        let mut arguments = Vec::new();
        if !self.take(")") {
            loop {
                arguments.push(self.binary(1)?);
                if self.take(")") {
                    break;
                }
                if !self.take(",") {
                    return Err(self.error("expected , or )".to_owned()));
                }
            }
        }
        self.depth -= 1;
        let (least, most) = function.arguments;
        if !(least..=most).contains(&arguments.len()) {
            let count = arguments.len();
            let expected = if least == most { least.to_string() } else { format!("{least} to {most}") };
            let message = format!("{} takes {expected} arguments, found {count}", function.name);
            return Err(ExpressionError { offset: start, message });
        }
        Ok(Expression::Call(function, arguments))
    }
}

/// How deep index brackets nest.
fn brackets(text: &str) -> usize {
    let (mut depth, mut most) = (0usize, 0);
    for byte in text.bytes() {
        match byte {
            b'[' => depth += 1,
            b']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        most = most.max(depth);
    }
    most
}

/// The length of the element, number or name at the start of a text. Brackets belong to it with all inside.
fn token(text: &str) -> usize {
    let number = text.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    let mut depth = 0usize;
    let mut last = ' ';
    for (offset, c) in text.char_indices() {
        let inside = match c {
            '[' => {
                depth += 1;
                true
            }
            ']' if depth > 0 => {
                depth -= 1;
                true
            }
            _ if depth > 0 => true,
            '+' | '-' => number && matches!(last, 'e' | 'E') && !text.starts_with("0x") && !text.starts_with("0X"),
            c => c.is_alphanumeric() || matches!(c, '_' | '.' | ':' | '$' | '@'),
        };
        if !inside {
            return offset;
        }
        last = c;
    }
    text.len()
}
