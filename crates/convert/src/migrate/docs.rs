//! Documentation of the result: nicknames, descriptions, rung comments.

use std::collections::BTreeSet;

use domore::program::ElementDoc;
use ladder::{Address, Image, Rung, Target};

use super::context::Context;
use super::facts::addresses;

/// A nickname has at most this many characters.
pub const LONGEST_NICKNAME: usize = 16;

/// A comment line is broken at this many characters.
const LINE: usize = 100;

/// Makes names unique and short.
#[derive(Clone, Debug, Default)]
struct Names {
    taken: BTreeSet<String>,
}

impl Names {
    /// A nickname from a symbol: letters, digits and `_`, at most 16 characters, unlike all others
    /// whatever the case. Empty if nothing is left of it.
    fn make(&mut self, symbol: &str) -> String {
        let mut name: String = symbol
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
            .collect::<String>()
            .trim_matches('_')
            .to_owned();
        if name.starts_with(|c: char| c.is_ascii_digit()) {
            name.insert(0, '_');
        }
        // `N7`, `X0`, `ST1`: what reads as an element is none.
        if domore::address::Address::parse(&name)
            .is_ok_and(|address| matches!(address.element, domore::address::Element::Numbered { .. }))
            && name.len() <= 6
        {
            name.push('_');
        }
        name.truncate(LONGEST_NICKNAME);
        if name.is_empty() {
            return name;
        }
        let mut unique = name.clone();
        let mut number = 2;
        while !self.taken.insert(unique.to_ascii_lowercase()) {
            let suffix = format!("_{number}");
            unique = name.chars().take(LONGEST_NICKNAME - suffix.len()).collect::<String>() + &suffix;
            number += 1;
        }
        unique
    }
}

/// Documentation of all elements: of addresses that have a symbol or a description, of parts of
/// structures the program names, of helpers.
pub(super) fn elements(context: &Context<'_>) -> Vec<ElementDoc> {
    let mut names = Names::default();
    let mut documented = BTreeSet::new();
    let mut found = Vec::new();
    let flags = || Some(String::new());
    // Helpers first: rungs are read with their names.
    for (element, helper) in &context.helpers {
        let nickname = names.make(&helper.nickname);
        let element = element.to_string();
        documented.insert(element.clone());
        let description = vec![helper.text.clone()];
        found.push(ElementDoc { element, flags: flags(), nickname, description, ..ElementDoc::default() });
    }
    for (address, symbol, description) in entries(context.image) {
        let Some(element) = element_of(context, &address) else { continue };
        if !documented.insert(element.clone()) {
            continue;
        }
        let wanted = if symbol.is_empty() { structure_name(&address) } else { symbol.clone() };
        let nickname = names.make(&wanted);
        let mut lines = vec![address.to_string()];
        if !symbol.is_empty() && symbol != nickname {
            lines.push(format!("symbol {symbol}"));
        }
        lines.extend(description);
        found.push(ElementDoc { element, flags: flags(), nickname, description: lines, ..ElementDoc::default() });
    }
    found
}

/// Addresses with documentation, then parts of structures and bits the rungs name, each with symbol and
/// description as the original shows them.
fn entries(image: &Image) -> Vec<(Address, String, Vec<String>)> {
    let mut found = Vec::new();
    for entry in image.documentation.entries() {
        if let Target::Address(address) = &entry.target
            && address.is_direct()
        {
            found.push((address.clone(), entry.symbol.clone(), entry.description.clone()));
        }
    }
    let mut seen = BTreeSet::new();
    let rungs = image.ladder_files().flat_map(|file| &file.rungs);
    for address in rungs.flat_map(Rung::instructions).flat_map(addresses) {
        if !address.is_direct() || !seen.insert(address.to_string()) {
            continue;
        }
        let shown = image.documentation.shown(&Target::Address(address.clone()), "");
        let symbol = shown.symbol.unwrap_or_default();
        found.push((address.clone(), symbol, shown.description));
    }
    found
}

/// The name of a part of a structure without a symbol: `T4_0_DN`. Plain words keep their element.
fn structure_name(address: &Address) -> String {
    let part = address.word.is_some() || address.bit.is_some();
    if part && address.file_type.is_structure() {
        return address.to_string().replace([':', '.', '/'], "_");
    }
    String::new()
}

/// The operand of the result that stands for an address, without effect on the migration.
fn element_of(context: &Context<'_>, address: &Address) -> Option<String> {
    let (file_type, file, word) = context.places.word_of(address)?;
    match &address.bit {
        Some(bit) => context.places.bit(file_type, file, word, bit.number()? % 16),
        None => match context.places.element(file_type, file, word) {
            Some(element) => Some(element.to_string()),
            None if address.word.is_none() && address.file_type.is_structure() => None,
            None => context.places.word(file_type, file, word),
        },
    }
}

/// The comment above a rung of the result: the original's comment, then its place and text.
pub(super) fn rung_comment(file: u16, number: u32, rung: &Rung, original: &str, reasons: &[String]) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(comment) = &rung.comment {
        if !comment.title.is_empty() {
            lines.extend(wrapped(&comment.title));
        }
        lines.extend(comment.lines().flat_map(wrapped));
    }
    lines.extend(reasons.iter().flat_map(|reason| wrapped(reason)));
    lines.extend(wrapped(&format!("SLC {file}:{number}  {original}")));
    lines
}

/// A line broken between words.
fn wrapped(line: &str) -> Vec<String> {
    let mut lines = Vec::new();
    let mut current = String::new();
    for word in line.split(' ') {
        if !current.is_empty() && current.chars().count() + 1 + word.chars().count() > LINE {
            lines.push(std::mem::take(&mut current));
        }
        if !current.is_empty() {
            current.push(' ');
        }
        current.push_str(word);
    }
    lines.push(current);
    lines.into_iter().map(|line| line.replace(['\t', '\r', '\n'], " ")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nicknames_are_short_unique_and_no_elements() {
        let mut names = Names::default();
        assert_eq!(names.make("CONVEYOR_START_BUTTON"), "CONVEYOR_START_B");
        assert_eq!(names.make("conveyor_start_but"), "conveyor_start_2");
        assert_eq!(names.make("N7"), "N7_");
        assert_eq!(names.make("2ND/PUMP"), "_2ND_PUMP");
        assert_eq!(names.make(""), "");
        assert_eq!(names.make("a"), "a");
        assert_eq!(names.make("A"), "A_2");
    }

    #[test]
    fn lines_break_between_words() {
        let lines = wrapped(&"word ".repeat(50));
        assert!(lines.iter().all(|line| line.chars().count() <= LINE));
        assert_eq!(lines.join(" ").split_whitespace().count(), 50);
    }
}
