//! Operands as words of rung text: plain where that reads back, in double quotes where it does not.

use std::borrow::Cow;

use instr::{Instruction, Kind};
use ladder::{Expression, Operand};

use super::token::{Token, quote};

/// An unquoted expression may have this many words; the editor's limit is far below.
pub(super) const MAX_EXPRESSION: usize = 2048;

/// What a word means where an instruction can begin.
pub(super) enum Keyword {
    /// `SOR`, `EOR`, `BST`, `NXB` or `BND`.
    Structure(&'static str),
    /// An instruction of the set.
    Known(&'static Instruction),
    /// `op0x4D`: an operation code without a name.
    Code(u16),
}

const STRUCTURE: [&str; 5] = ["SOR", "EOR", "BST", "NXB", "BND"];

/// Looks a word up, upper or lower case, without the `(` that can follow it.
pub(super) fn keyword(word: &str) -> Option<Keyword> {
    // Nearly all operands hold a `:` or are longer: do not look those up.
    if word.len() > 10 || !word.bytes().all(|b| b.is_ascii_alphanumeric()) {
        return None;
    }
    let upper = word.to_ascii_uppercase();
    if let Some(digits) = upper.strip_prefix("OP0X") {
        return u16::from_str_radix(digits, 16).ok().map(Keyword::Code);
    }
    if let Some(name) = STRUCTURE.iter().find(|name| **name == upper) {
        return Some(Keyword::Structure(name));
    }
    instr::by_mnemonic(&upper).map(Keyword::Known)
}

/// The unquoted word cannot be an operand: it begins something else.
pub(super) fn is_reserved(word: &str) -> bool {
    matches!(word, "(" | ")") || keyword(word.strip_suffix('(').unwrap_or(word)).is_some()
}

/// Types the operand that `token` spells. `kind` is what the instruction has there, `None` inside
/// parentheses, where every operand is spelled as the project stores it.
pub(super) fn read(token: &Token<'_>, kind: Option<Kind>) -> Operand {
    let text = token.text.as_ref();
    if token.quoted {
        return Operand::parse(text);
    }
    let number = || plain_number(text);
    match kind {
        Some(Kind::ProgramFile) => number().map_or_else(|| Operand::parse(text), Operand::ProgramFile),
        // A label belongs to the file its instruction is in, whatever file number stands before it.
        Some(Kind::Label) => number().map_or_else(|| Operand::parse(text), |number| Operand::Label { file: 0, number }),
        _ => Operand::parse(text),
    }
}

fn plain_number(text: &str) -> Option<u16> {
    text.bytes().all(|b| b.is_ascii_digit()).then(|| text.parse().ok()).flatten()
}

/// The word that [`read`] turns back into `operand`.
pub(super) fn write(operand: &Operand, kind: Option<Kind>) -> String {
    if let (Operand::Expression(expression), Some(Kind::Expression)) = (operand, kind) {
        let text = expression.to_string();
        if expression_reads_back(&text, expression) {
            return text;
        }
    }
    let plain = match (operand, kind) {
        (Operand::ProgramFile(number), Some(Kind::ProgramFile)) => number.to_string(),
        _ => operand.to_string(),
    };
    // Parentheses and operators would belong to the expression of a CPT before this instruction.
    let is_word = !plain.is_empty()
        && !plain.starts_with('"')
        && !plain.contains(|c: char| c.is_whitespace() || "()".contains(c))
        && !is_shared(&plain);
    if is_word && kind != Some(Kind::Expression) && !plain.chars().any(char::is_control) && !is_reserved(&plain) {
        let token = Token { text: Cow::Borrowed(&plain), quoted: false, line: 1, column: 1 };
        if read(&token, kind) == *operand {
            return plain;
        }
    }
    match operand {
        // The blanks keep a bare address or number an expression when it is read back.
        Operand::Expression(expression) => quote(&format!(" {expression} ")),
        _ => quote(&plain),
    }
}

fn expression_reads_back(text: &str, expression: &Expression) -> bool {
    let words: Vec<&str> = text.split_whitespace().collect();
    words.len() <= MAX_EXPRESSION
        && words.iter().all(|word| expression_word(word))
        && Expression::parse_prefix(&words).is_ok_and(|(read, used)| used == words.len() && read == *expression)
}

/// The word is an operator or function of expressions and, mostly, an instruction as well.
pub(super) fn is_shared(word: &str) -> bool {
    const SHARED: [&str; 24] = [
        "AND", "OR", "XOR", "NOT", "SQR", "ABS", "LN", "LOG", "SIN", "COS", "TAN", "ASN", "ACS", "ATN", "FRD", "TOD",
        "DEG", "RAD", "MOD", "+", "-", "*", "|", "**",
    ];
    SHARED.iter().any(|name| name.eq_ignore_ascii_case(word))
}

/// The word may stand in an unquoted expression: it is not the mnemonic of the next instruction.
/// Functions and operators share their names with instructions and may.
pub(super) fn expression_word(word: &str) -> bool {
    !word.starts_with('"') && (matches!(word, "(" | ")") || is_shared(word) || !is_reserved(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_where_it_reads_back_else_quoted() {
        for (text, kind, word) in [
            ("N7:0", Kind::Word, "N7:0"),
            ("?", Kind::Word, "?"),
            ("", Kind::Word, "\"\""),
            ("MOV", Kind::Word, "\"MOV\""),
            ("mov", Kind::Word, "\"mov\""),
            ("op0x4d", Kind::Word, "\"op0x4d\""),
            ("a b", Kind::Word, "\"a b\""),
            ("a\u{A0}b", Kind::Word, "\"a\u{A0}b\""),
            ("\"x", Kind::Word, "\"\"\"x\""),
            (")", Kind::Word, "\")\""),
            ("U:4", Kind::ProgramFile, "4"),
            ("4", Kind::ProgramFile, "\"4\""),
            ("U:4", Kind::Word, "U:4"),
            ("Q2:1", Kind::Label, "Q2:1"),
            ("1", Kind::Label, "\"1\""),
            ("N7:0 + 1", Kind::Expression, "N7:0 + 1"),
            ("N7:0 + 1", Kind::Word, "\" N7:0 + 1 \""),
            ("N7:0", Kind::Expression, "\"N7:0\""),
            ("?", Kind::Expression, "\"?\""),
        ] {
            assert_eq!(write(&Operand::parse(text), Some(kind)), word, "{text} as {kind:?}");
        }
    }
}
