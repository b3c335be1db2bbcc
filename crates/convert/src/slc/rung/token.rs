//! Splits rung text into words and quoted operands, each with its line and column.

use std::borrow::Cow;

use super::error::TextError;
use crate::limits::MAX_PARTS;

/// One word of rung text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Token<'a> {
    /// The word; of a quoted operand its content.
    pub text: Cow<'a, str>,
    /// It stood in double quotes: an operand whatever it says.
    pub quoted: bool,
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
}

impl Token<'_> {
    /// An unquoted word that reads like this, upper or lower case.
    pub(super) fn is(&self, word: &str) -> bool {
        !self.quoted && self.text.eq_ignore_ascii_case(word)
    }
}

/// Splits `text`, whose first character stands in `first_line`, at white space.
pub(super) fn tokens(text: &str, first_line: u32) -> Result<Vec<Token<'_>>, TextError> {
    let mut lexer = Lexer { text, at: 0, line: first_line, column: 1 };
    let mut found = Vec::new();
    while let Some(token) = lexer.next()? {
        if found.len() >= MAX_PARTS {
            let expected = format!("a rung of at most {MAX_PARTS} words");
            return Err(TextError::at(token.line, token.column, &token.text).expected(expected));
        }
        found.push(token);
    }
    Ok(found)
}

struct Lexer<'a> {
    text: &'a str,
    at: usize,
    line: u32,
    column: u32,
}

impl<'a> Lexer<'a> {
    fn rest(&self) -> &'a str {
        self.text.get(self.at..).unwrap_or("")
    }

    /// Takes one character; line ends are LF, with or without CR before it.
    fn advance(&mut self) -> Option<char> {
        let c = self.rest().chars().next()?;
        self.at += c.len_utf8();
        if c == '\n' {
            self.line = self.line.saturating_add(1);
            self.column = 1;
        } else {
            self.column = self.column.saturating_add(1);
        }
        Some(c)
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn next(&mut self) -> Result<Option<Token<'a>>, TextError> {
        while self.peek().is_some_and(char::is_whitespace) {
            self.advance();
        }
        let (line, column, start) = (self.line, self.column, self.at);
        match self.peek() {
            None => return Ok(None),
            Some('"') => {
                let text = self.quoted(start)?;
                return Ok(Some(Token { text: Cow::Owned(text), quoted: true, line, column }));
            }
            Some(_) => {}
        }
        while self.peek().is_some_and(|c| !c.is_whitespace()) {
            self.advance();
        }
        let text = Cow::Borrowed(self.text.get(start..self.at).unwrap_or(""));
        Ok(Some(Token { text, quoted: false, line, column }))
    }

    fn quoted(&mut self, start: usize) -> Result<String, TextError> {
        let (line, column) = (self.line, self.column);
        let fault = |at: &Self, expected: &str| {
            let word = at.text.get(start..at.at).unwrap_or("");
            Err(TextError::at(line, column, word).expected(expected))
        };
        self.advance();
        let mut text = String::new();
        loop {
            match self.advance() {
                None | Some('\n') => return fault(self, "a closing \" on the same line"),
                Some('"') if self.peek() == Some('"') => {
                    self.advance();
                    text.push('"');
                }
                Some('"') => break,
                Some('\\') => match self.escape() {
                    Some(c) => text.push(c),
                    None => return fault(self, r"\\ or \u{hexadecimal number} after \"),
                },
                Some(c) => text.push(c),
            }
        }
        if self.peek().is_none_or(char::is_whitespace) { Ok(text) } else { fault(self, "a blank after the closing \"") }
    }

    /// The character of an escape whose `\` is already taken.
    fn escape(&mut self) -> Option<char> {
        match self.advance()? {
            '\\' => Some('\\'),
            'u' if self.advance()? == '{' => {
                let mut code = 0_u32;
                loop {
                    match self.advance()? {
                        '}' => return char::from_u32(code),
                        digit => code = code.checked_mul(16)?.checked_add(digit.to_digit(16)?)?,
                    }
                }
            }
            _ => None,
        }
    }
}

/// The text in quotes, as [`tokens`] reads it back. Control characters and line separators are
/// escaped so that a rung stays on its line.
pub(super) fn quote(text: &str) -> String {
    use std::fmt::Write as _;
    let mut quoted = String::with_capacity(text.len() + 2);
    quoted.push('"');
    for c in text.chars() {
        match c {
            '"' => quoted.push_str("\"\""),
            '\\' => quoted.push_str(r"\\"),
            c if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}') => {
                // Writing to a string cannot fail.
                let _ = write!(quoted, r"\u{{{:X}}}", u32::from(c));
            }
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_know_their_place() {
        let found = tokens("SOR XIC  B3:0/0\r\n\tOTE \"a \"\"b\"\"\" EOR", 7).expect("text");
        let places: Vec<_> = found.iter().map(|t| (t.text.as_ref(), t.quoted, t.line, t.column)).collect();
        assert_eq!(
            places,
            [
                ("SOR", false, 7, 1),
                ("XIC", false, 7, 5),
                ("B3:0/0", false, 7, 10),
                ("OTE", false, 8, 2),
                ("a \"b\"", true, 8, 6),
                ("EOR", false, 8, 16),
            ]
        );
    }

    #[test]
    fn quoted_text_reads_back() {
        for text in ["", "a b", "\"", "\\", "x\r\ny\u{0}", "\u{85}", "ä\u{A0}%", "\u{2028}"] {
            let quoted = quote(text);
            assert!(!quoted.contains(['\r', '\n']), "{quoted}");
            let found = tokens(&quoted, 1).expect(&quoted);
            assert_eq!(found.len(), 1, "{quoted}");
            assert_eq!((found[0].text.as_ref(), found[0].quoted), (text, true));
        }
    }

    #[test]
    fn broken_quotes_are_located() {
        for (text, expected) in [
            ("XIC \"B3:0/0", "closing"),
            ("XIC \"B3\n\"", "closing"),
            ("XIC \"a\"b", "blank"),
            ("XIC \"\\n\"", "after \\"),
            ("XIC \"\\u{110000}\"", "after \\"),
            ("XIC \"\\u{FFFFFFFFFFFF}\"", "after \\"),
        ] {
            let error = tokens(text, 1).expect_err(text);
            assert_eq!((error.line, error.column), (1, 5), "{text}");
            assert!(error.expected.contains(expected), "{error}");
        }
    }
}
