//! Operands as a program writes them.

use std::fmt;

use crate::{Address, Constant, Expression};

/// One operand of an instruction, without the value last displayed beside it.
#[derive(Clone, Debug, PartialEq)]
pub enum Operand {
    /// A data table address.
    Address(Address),
    /// A number.
    Constant(Constant),
    /// `Q2:1`: label 1. The file number is what the project stores and can be stale; a label
    /// belongs to the file its instruction is in.
    Label {
        /// File number as stored.
        file: u16,
        /// Label number.
        number: u16,
    },
    /// `U:4`: program file 4.
    ProgramFile(u16),
    /// `HSC0`: high-speed counter 0.
    HighSpeedCounter(u16),
    /// The expression of CPT.
    Expression(Expression),
    /// A symbol that was not resolved to an address (rungs that were never verified).
    Symbol(String),
    /// Any other text, kept as it is.
    Text(String),
    /// `?`: no operand entered yet.
    Unset,
    /// A place in the box that holds no operand, such as `Setup Screen`.
    Empty,
}

impl Operand {
    /// Types an operand by its spelling. Never fails: what is not recognized is [`Operand::Text`].
    pub fn parse(text: &str) -> Operand {
        match text {
            "" => return Operand::Empty,
            "?" => return Operand::Unset,
            _ => {}
        }
        if let Some(constant) = Constant::parse(text) {
            return Operand::Constant(constant);
        }
        if let Ok(address) = Address::parse(text) {
            return Operand::Address(address);
        }
        if let Some(number) = text.strip_prefix("U:").and_then(plain_number) {
            return Operand::ProgramFile(number);
        }
        if let Some(number) = text.strip_prefix("HSC").and_then(plain_number) {
            return Operand::HighSpeedCounter(number);
        }
        if let Some((file, label)) = text.strip_prefix('Q').and_then(|rest| rest.split_once(':'))
            && let (Some(file), Some(number)) = (plain_number(file), plain_number(label))
        {
            return Operand::Label { file, number };
        }
        if is_symbol(text) {
            return Operand::Symbol(text.to_owned());
        }
        if text.contains([' ', '('])
            && let Ok(expression) = Expression::parse(text)
        {
            return Operand::Expression(expression);
        }
        Operand::Text(text.to_owned())
    }

    /// The address, if the operand is one.
    pub fn address(&self) -> Option<&Address> {
        match self {
            Operand::Address(address) => Some(address),
            _ => None,
        }
    }

    /// The constant, if the operand is one.
    pub fn constant(&self) -> Option<&Constant> {
        match self {
            Operand::Constant(constant) => Some(constant),
            _ => None,
        }
    }
}

/// A number without leading zeros, so that the spelling can be written back from the value.
fn plain_number(text: &str) -> Option<u16> {
    let number: u16 = text.parse().ok()?;
    (number.to_string() == text).then_some(number)
}

/// Symbols use letters, digits and `_`, at most 20 characters, with a member or bit of a structured
/// element after it (`ENTRY_TON.ACC`, `MODE/3`).
fn is_symbol(text: &str) -> bool {
    let (name, rest) = match text.find(['.', '/']) {
        Some(at) => text.split_at(at),
        None => (text, ""),
    };
    let name = name.strip_prefix('#').unwrap_or(name);
    let word = |part: &str| part.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
    !name.is_empty()
        && name.len() <= 20
        && word(name)
        && (rest.is_empty() || rest.split(['.', '/']).skip(1).all(|part| !part.is_empty() && word(part)))
}

impl fmt::Display for Operand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Operand::Address(address) => write!(f, "{address}"),
            Operand::Constant(constant) => write!(f, "{constant}"),
            Operand::Label { file, number } => write!(f, "Q{file}:{number}"),
            Operand::ProgramFile(number) => write!(f, "U:{number}"),
            Operand::HighSpeedCounter(number) => write!(f, "HSC{number}"),
            Operand::Expression(expression) => write!(f, "{expression}"),
            Operand::Symbol(text) | Operand::Text(text) => f.write_str(text),
            Operand::Unset => f.write_str("?"),
            Operand::Empty => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spelling_decides_the_kind() {
        use Operand as O;
        type Case = (&'static str, fn(&Operand) -> bool);
        let cases: [Case; 12] = [
            ("N7:0", |o| matches!(o, O::Address(_))),
            ("-5", |o| matches!(o, O::Constant(_))),
            ("00FFh", |o| matches!(o, O::Constant(_))),
            ("U:255", |o| *o == O::ProgramFile(255)),
            ("Q0:3", |o| *o == O::Label { file: 0, number: 3 }),
            ("HSC0", |o| *o == O::HighSpeedCounter(0)),
            ("ENTRY_TON.ACC", |o| matches!(o, O::Symbol(_))),
            ("2FAILS/3", |o| matches!(o, O::Symbol(_))),
            ("?", |o| *o == O::Unset),
            ("", |o| *o == O::Empty),
            (" ( N7:0 + 1 ) * 2 ", |o| matches!(o, O::Expression(_))),
            ("a$b", |o| matches!(o, O::Text(_))),
        ];
        for (text, is) in cases {
            let operand = Operand::parse(text);
            assert!(is(&operand), "{text}: {operand:?}");
            assert_eq!(operand.to_string(), text.trim(), "{text}");
        }
    }
}
