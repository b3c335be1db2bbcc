//! Why a rung text cannot be read, and where.

use std::fmt;

/// A place where rung text stops making sense.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextError {
    /// Line of the text, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
    /// The word found there, shortened when long; empty at the end of the text.
    pub found: String,
    /// What belongs there.
    pub expected: String,
    /// The mnemonic the writer may have meant.
    pub suggestion: Option<&'static str>,
}

impl fmt::Display for TextError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}: expected {}, found ", self.line, self.column, self.expected)?;
        if self.found.is_empty() {
            f.write_str("the end of the text")?;
        } else {
            write!(f, "`{}`", self.found)?;
        }
        match self.suggestion {
            Some(mnemonic) => write!(f, "; did you mean {mnemonic}?"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for TextError {}

/// Longest word shown in an error.
const SHOWN: usize = 40;

impl TextError {
    pub(super) fn at(line: u32, column: u32, word: &str) -> TextError {
        let mut found: String = word.chars().take(SHOWN).collect();
        if found.len() < word.len() {
            found.push('…');
        }
        TextError { line, column, found, expected: String::new(), suggestion: None }
    }

    pub(super) fn expected(mut self, expected: impl Into<String>) -> TextError {
        self.expected = expected.into();
        self
    }

    /// Adds the nearest mnemonic to the word found.
    pub(super) fn suggest(mut self) -> TextError {
        self.suggestion = nearest_mnemonic(&self.found);
        self
    }
}

/// The mnemonic or branch word that differs least from `word`; `None` when nothing is near.
fn nearest_mnemonic(word: &str) -> Option<&'static str> {
    let word = word.to_ascii_uppercase();
    if !(2..=8).contains(&word.len()) || !word.is_ascii() {
        return None;
    }
    let letters = |word: &str| {
        let mut letters = word.as_bytes().to_vec();
        letters.sort_unstable();
        letters
    };
    let typed = letters(&word);
    // A short word has many neighbours: it may differ in one place only.
    let farthest = if word.len() <= 3 { 1 } else { 2 };
    let known = instr::all().iter().map(|instruction| instruction.mnemonic);
    known
        .chain(["BST", "NXB", "BND", "SOR", "EOR"])
        .map(|name| (distance(word.as_bytes(), name.as_bytes()), name))
        .filter(|(distance, _)| *distance <= farthest)
        // Letters in the wrong order are the likelier slip.
        .min_by_key(|(distance, name)| (*distance, letters(name) != typed))
        .map(|(_, name)| name)
}

/// Edits between two short words: insert, delete, replace, swap neighbours.
fn distance(a: &[u8], b: &[u8]) -> usize {
    let width = b.len() + 1;
    let mut table = vec![0_usize; (a.len() + 1) * width];
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            let at = i * width + j;
            table[at] = match (i.checked_sub(1), j.checked_sub(1)) {
                (None, _) => j,
                (_, None) => i,
                (Some(p), Some(q)) => {
                    let replaced = table[at - width - 1] + usize::from(a[p] != b[q]);
                    let least = replaced.min(table[at - width] + 1).min(table[at - 1] + 1);
                    let swapped = p > 0 && q > 0 && a[p] == b[q - 1] && a[p - 1] == b[q];
                    if swapped { least.min(table[at - 2 * width - 2] + 1) } else { least }
                }
            };
        }
    }
    table[a.len() * width + b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_misses_are_suggested() {
        for (word, meant) in [("XCI", Some("XIC")), ("xio1", Some("XIO")), ("TONN", Some("TON")), ("BDN", Some("BND"))]
        {
            assert_eq!(nearest_mnemonic(word), meant, "{word}");
        }
        for word in ["", "Q", "N7:0", "QQQQ", "TEMPERATURE", "ÄÖ"] {
            assert_eq!(nearest_mnemonic(word), None, "{word}");
        }
    }

    #[test]
    fn errors_read_as_sentences() {
        let error = TextError::at(3, 14, "XCI").expected("an instruction").suggest();
        assert_eq!(error.to_string(), "line 3, column 14: expected an instruction, found `XCI`; did you mean XIC?");
        let end = TextError::at(1, 4, "").expected("EOR");
        assert_eq!(end.to_string(), "line 1, column 4: expected EOR, found the end of the text");
    }
}
