//! A tag dictionary: a plain listing of address, symbol and description made by hand.
//!
//! One project of the corpus has such a list beside RSLogix's own report. It is a
//! weaker witness: where the two differ, the report sides with the project.

use super::row;

/// A row of the dictionary.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TagRow {
    /// Address as printed.
    pub address: String,
    /// Symbol.
    pub symbol: String,
    /// Description.
    pub description: String,
}

/// Reads the rows of a tag dictionary; the second value holds the lines that are no rows.
#[must_use]
pub fn parse_tags(text: &str) -> (Vec<TagRow>, Vec<String>) {
    let (mut rows, mut lost) = (Vec::new(), Vec::new());
    for line in text.lines().map(|l| l.trim_matches(['\u{c}', ' '])).filter(|l| !l.is_empty()) {
        let mut texts = row::cells(line).into_iter().map(|c| c.text);
        match (texts.next(), texts.next(), texts.next(), texts.next()) {
            (Some(address), Some(symbol), Some(description), None) if address.contains(':') => {
                rows.push(TagRow { address, symbol, description });
            }
            _ => lost.push(line.to_owned()),
        }
    }
    (rows, lost)
}
