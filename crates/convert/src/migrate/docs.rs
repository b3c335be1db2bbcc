//! Documentation of the result: nicknames, descriptions, rung comments.

use std::collections::{BTreeMap, BTreeSet};

use domore::program::ElementDoc;
use ladder::{Address, Image, Rung, Target};

use super::allocate::Places;
use super::context::Context;
use super::facts::addresses;
use super::map_file::{MapError, NOTHING, Wish};

/// A nickname has at most this many characters.
pub const LONGEST_NICKNAME: usize = 16;

/// A comment line is broken at this many characters.
const LINE: usize = 100;

/// Makes names unique and short.
#[derive(Clone, Debug, Default)]
struct Names {
    /// In lower case, with what has them.
    taken: BTreeMap<String, String>,
}

/// `N7`, `X0`, `ST1`: what reads as an element is no name.
fn reads_as_element(name: &str) -> bool {
    let numbered =
        |address: domore::address::Address| matches!(address.element, domore::address::Element::Numbered { .. });
    domore::address::Address::parse(name).is_ok_and(numbered) && name.len() <= 6
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
        if reads_as_element(&name) {
            name.push('_');
        }
        name.truncate(LONGEST_NICKNAME);
        if name.is_empty() {
            return name;
        }
        let mut unique = name.clone();
        let mut number = 2;
        while self.taken.contains_key(&unique.to_ascii_lowercase()) {
            let suffix = format!("_{number}");
            unique = name.chars().take(LONGEST_NICKNAME - suffix.len()).collect::<String>() + &suffix;
            number += 1;
        }
        self.taken.insert(unique.to_ascii_lowercase(), symbol.to_owned());
        unique
    }

    /// A nickname a person chose, as it is.
    ///
    /// # Errors
    /// Why it is none.
    fn take(&mut self, name: &str, element: &str) -> Result<(), String> {
        let sign = name.chars().find(|c| !c.is_ascii_alphanumeric() && *c != '_');
        if let Some(sign) = sign {
            return Err(format!("nickname `{name}`: expected letters, digits and _, found `{sign}`"));
        }
        if name.len() > LONGEST_NICKNAME {
            return Err(format!("nickname `{name}` has {} characters, Designer takes {LONGEST_NICKNAME}", name.len()));
        }
        if name.starts_with(|c: char| c.is_ascii_digit()) || reads_as_element(name) {
            return Err(format!("nickname `{name}` reads as a number or as an element"));
        }
        match self.taken.insert(name.to_ascii_lowercase(), element.to_owned()) {
            Some(other) => Err(format!("nickname `{name}` is taken by {other}")),
            None => Ok(()),
        }
    }
}

/// An element with its documentation.
#[derive(Clone, Debug)]
pub(super) struct Documented {
    /// The address of the original; a helper has none.
    pub(super) address: Option<Address>,
    /// What it is in the result.
    pub(super) element: String,
    /// The nickname; empty for none.
    nickname: String,
    /// The symbol of the original.
    symbol: String,
    description: Vec<String>,
    /// A person took nickname or description away: the map has to say so again.
    taken: [bool; 2],
}

impl Documented {
    fn line(&self) -> ElementDoc {
        let mut description: Vec<String> = self.address.iter().map(Address::to_string).collect();
        if !self.symbol.is_empty() && self.symbol != self.nickname {
            description.push(format!("symbol {}", self.symbol));
        }
        description.extend(self.description.iter().cloned());
        let description = description.iter().map(|line| visible(line)).collect();
        let (element, nickname) = (self.element.clone(), self.nickname.clone());
        ElementDoc { element, flags: Some(String::new()), nickname, description, ..ElementDoc::default() }
    }

    /// The nickname as the map has it.
    pub(super) fn nickname_in_map(&self) -> String {
        if self.taken[0] { NOTHING.to_owned() } else { self.nickname.clone() }
    }

    /// The description as the map has it.
    pub(super) fn description_in_map(&self) -> String {
        if self.taken[1] { NOTHING.to_owned() } else { self.description.join(" ") }
    }
}

/// The lines of the result.
pub(super) fn elements(documented: &[Documented]) -> Vec<ElementDoc> {
    documented.iter().map(Documented::line).collect()
}

/// Documentation of all elements: of helpers, of addresses that have a symbol or a description, of parts of
/// structures the program names, and what a person wants them to be called. `blocks` are names of code blocks.
///
/// # Errors
/// A nickname that is none, or that two elements are to have.
pub(super) fn documented<'b>(
    context: &Context<'_>,
    wishes: &[Wish],
    blocks: impl IntoIterator<Item = &'b str>,
) -> Result<Vec<Documented>, MapError> {
    let mut names = Names::default();
    names.taken.extend(blocks.into_iter().map(|name| (name.to_ascii_lowercase(), "a code block".to_owned())));
    let mut found = Vec::new();
    // Helpers first: rungs are read with their names.
    for (element, helper) in &context.helpers {
        found.push(Documented {
            address: None,
            element: element.to_string(),
            nickname: names.make(&helper.nickname),
            symbol: String::new(),
            description: vec![helper.text.clone()],
            taken: [false; 2],
        });
    }
    let mut documented: BTreeSet<String> = found.iter().map(|row| row.element.clone()).collect();
    let mut wanted: BTreeMap<String, &Wish> = BTreeMap::new();
    let mut entries = entries(context.image);
    for wish in wishes {
        let wrong = |what: String| MapError { row: wish.row, what };
        let Some(wished) = &wish.address else {
            let helper = found.iter().find(|row| row.element == wish.domore && row.nickname != wish.name);
            let known = wish.name.is_empty() || found.iter().any(|row| row.nickname == wish.name);
            match helper.filter(|_| !known) {
                Some(helper) => {
                    let (found, kept) = (&wish.name, &helper.nickname);
                    return Err(wrong(format!(
                        "expected the helper {kept}, found `{found}`: helpers keep their names"
                    )));
                }
                None => continue,
            }
        };
        if wish.name.is_empty() && wish.description.is_empty() {
            continue;
        }
        let element = operand(&context.places, wished);
        let element = element.filter(|element| !documented.contains(element));
        let element = element.ok_or_else(|| wrong(format!("{wished} has no element that could have a nickname")))?;
        let shown = context.image.documentation.shown(&Target::Address(wished.clone()), "");
        let symbol = shown.symbol.unwrap_or_default();
        // Maps can have the symbol where the nickname made of it stands now.
        if !wish.name.is_empty() && wish.name != NOTHING && wish.name != symbol.trim() {
            names.take(&wish.name, &element).map_err(wrong)?;
        }
        if let Some(other) = wanted.insert(element.clone(), wish) {
            return Err(wrong(format!("{element} has its nickname and description in row {} already", other.row)));
        }
        entries.push((wished.clone(), symbol, shown.description));
    }
    for (address, symbol, mut description) in entries {
        let Some(element) = operand(&context.places, &address) else { continue };
        if !documented.insert(element.clone()) {
            continue;
        }
        let wish = wanted.get(&element);
        let (name, text) = wish.map_or(("", ""), |wish| (wish.name.as_str(), wish.description.as_str()));
        let nickname = match name {
            NOTHING => String::new(),
            own if !own.is_empty() && own != symbol.trim() => own.to_owned(),
            _ if symbol.is_empty() => names.make(&structure_name(&address)),
            _ => names.make(&symbol),
        };
        if text == NOTHING {
            description.clear();
        } else if !text.is_empty() && text.trim() != description.join(" ").trim() {
            description = text.lines().map(str::to_owned).collect();
        }
        let taken = [name == NOTHING, text == NOTHING];
        found.push(Documented { address: Some(address), element, nickname, symbol, description, taken });
    }
    Ok(found)
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
pub(super) fn operand(places: &Places, address: &Address) -> Option<String> {
    let (file_type, file, word) = places.word_of(address)?;
    match &address.bit {
        Some(bit) => places.bit(file_type, file, word, bit.number()? % 16),
        None => match places.element(file_type, file, word) {
            Some(element) => Some(element.to_string()),
            None if address.word.is_none() && address.file_type.is_structure() => None,
            None => places.word(file_type, file, word),
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
    lines.into_iter().map(|line| visible(&line)).collect()
}

/// A text without what a line of Designer's text cannot hold: white space is a blank, any other control
/// character its number.
fn visible(text: &str) -> String {
    let spelled = |c: char| match c {
        '\t' | '\r' | '\n' => " ".to_owned(),
        c if c.is_control() => format!("\\x{:02X}", u32::from(c)),
        c => c.to_string(),
    };
    if text.contains(char::is_control) { text.chars().map(spelled).collect() } else { text.to_owned() }
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
