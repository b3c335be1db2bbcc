//! Symbols, descriptions and comments, and the rules by which they are shown at an operand.

use std::collections::HashMap;
use std::fmt;

use crate::{Address, Place};

/// What a documentation entry is about.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// A data table address, indirect ones taken literally.
    Address(Address),
    /// `U:5`: program file 5 as the operand of JSR.
    ProgramFileOperand(u16),
    /// `Q51:1`: label 1 of program file 51.
    Label {
        /// Program file.
        file: u16,
        /// Label number.
        number: u16,
    },
    /// The description of a program file.
    ProgramFile(u16),
    /// Name and description of a data file.
    DataFile(u16),
    /// A symbol not assigned to an address yet.
    Unassigned,
    /// A key of a form not known; as stored.
    Other(String),
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Target::Address(address) => write!(f, "{address}"),
            Target::ProgramFileOperand(number) => write!(f, "U:{number}"),
            Target::Label { file, number } => write!(f, "Q{file}:{number}"),
            Target::ProgramFile(number) => write!(f, "program file {number}"),
            Target::DataFile(number) => write!(f, "data file {number}"),
            Target::Unassigned => Ok(()),
            Target::Other(text) => f.write_str(text),
        }
    }
}

/// Symbol and description of one target.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AddressEntry {
    /// What it documents.
    pub target: Target,
    /// Symbol, at most 20 characters, or empty.
    pub symbol: String,
    /// Up to 5 lines of at most 20 characters. Blank lines between used ones keep their place;
    /// there are none at the end.
    pub description: Vec<String>,
}

/// A description for one address under one instruction: replaces the address description there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InstructionComment {
    /// The mnemonic; some imports leave `0`, which matches no instruction.
    pub mnemonic: String,
    /// The address, or `None` if the address record is gone.
    pub target: Option<Target>,
    /// The lines, blank ones at the end left out.
    pub lines: Vec<String>,
}

/// What a rung comment is attached to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CommentOwner {
    /// File and rung number.
    Rung {
        /// Program file.
        file: u16,
        /// Rung, from 0.
        rung: u32,
    },
    /// The address written by the last instruction of the rung.
    Address(Target),
}

/// A rung comment and page title.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Comment {
    /// The comment, lines separated by `\r\n` as stored; may be empty.
    pub text: String,
    /// Page title, or empty.
    pub title: String,
    /// What it hangs on: the rung's number, or the address of its last instruction.
    pub owner: CommentOwner,
}

impl Comment {
    /// The comment's lines without the blank ones editors leave at the end.
    pub fn lines(&self) -> impl Iterator<Item = &str> {
        self.text.trim_end().lines().map(str::trim_end)
    }
}

/// All documentation of a program.
#[derive(Clone, Debug, Default)]
pub struct Documentation {
    entries: Vec<AddressEntry>,
    by_target: HashMap<Target, usize>,
    instruction_comments: Vec<InstructionComment>,
    /// Comments that no rung shows: their rung was deleted or got another comment. Kept.
    pub detached_comments: Vec<Comment>,
}

impl PartialEq for Documentation {
    fn eq(&self, other: &Self) -> bool {
        self.entries == other.entries
            && self.instruction_comments == other.instruction_comments
            && self.detached_comments == other.detached_comments
    }
}

/// What is shown above an operand.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Shown {
    /// Symbol, with the suffix of the operand when the symbol is the element's (`MODE/3`).
    pub symbol: Option<String>,
    /// Description lines.
    pub description: Vec<String>,
}

impl Documentation {
    /// Adds an entry. A later entry for the same target is kept but never looked up.
    pub fn add(&mut self, entry: AddressEntry) {
        if entry.target != Target::Unassigned {
            self.by_target.entry(entry.target.clone()).or_insert(self.entries.len());
        }
        self.entries.push(entry);
    }

    /// Adds an instruction comment.
    pub fn add_instruction_comment(&mut self, comment: InstructionComment) {
        self.instruction_comments.push(comment);
    }

    /// All entries in stored order.
    pub fn entries(&self) -> &[AddressEntry] {
        &self.entries
    }

    /// All instruction comments in stored order.
    pub fn instruction_comments(&self) -> &[InstructionComment] {
        &self.instruction_comments
    }

    /// The entry of a target.
    pub fn entry(&self, target: &Target) -> Option<&AddressEntry> {
        self.by_target.get(target).and_then(|index| self.entries.get(*index))
    }

    /// What a person means by `symbol`: the entry that has it, upper or lower case.
    pub fn by_symbol(&self, symbol: &str) -> Option<&AddressEntry> {
        self.entries.iter().find(|entry| !entry.symbol.is_empty() && entry.symbol.eq_ignore_ascii_case(symbol))
    }

    /// Symbol and description shown at a target under an instruction.
    ///
    /// Own symbol, else the element's symbol with the operand's suffix; the instruction comment of
    /// this mnemonic and address, else the own description, else the element's. Read off printed
    /// ladder pages; how a word or bit of I and O inherits was never seen printed, they do not here.
    pub fn shown(&self, target: &Target, mnemonic: &str) -> Shown {
        let own = self.entry(target);
        let element = match target {
            Target::Address(address) => self.element_entry(address),
            _ => None,
        };
        let own_symbol = own.filter(|entry| !entry.symbol.is_empty()).map(|entry| entry.symbol.clone());
        let symbol = own_symbol.or_else(|| {
            let (entry, suffix) = element.as_ref()?;
            (!entry.symbol.is_empty()).then(|| format!("{}{suffix}", entry.symbol))
        });
        let instruction_comment = self
            .instruction_comments
            .iter()
            .find(|comment| comment.mnemonic == mnemonic && comment.target.as_ref() == Some(target));
        let description = match instruction_comment {
            Some(comment) => comment.lines.clone(),
            None => [own, element.map(|(entry, _)| entry)]
                .into_iter()
                .flatten()
                .map(|entry| &entry.description)
                .find(|lines| !lines.is_empty())
                .cloned()
                .unwrap_or_default(),
        };
        Shown { symbol, description }
    }

    /// The entry of the element a word or bit lies in, and the suffix that names the part.
    fn element_entry(&self, address: &Address) -> Option<(&AddressEntry, String)> {
        let has_part = address.word.is_some() || address.bit.is_some();
        if !has_part || address.file_type.has_slots() {
            return None;
        }
        let element = Address { indexed: false, word: None, bit: None, ..address.clone() };
        let whole = element.to_string();
        let entry = self.entry(&Target::Address(element))?;
        let full = Address { indexed: false, ..address.clone() }.to_string();
        let suffix = full.strip_prefix(&whole).unwrap_or("").to_owned();
        Some((entry, suffix))
    }

    /// Share of the given addresses that have a symbol or description of their own or of their
    /// element: (documented, all).
    pub fn coverage<'a>(&self, addresses: impl Iterator<Item = &'a Address>) -> (usize, usize) {
        addresses.fold((0, 0), |(documented, all), address| {
            let shown = self.shown(&Target::Address(address.clone()), "");
            let is = shown.symbol.is_some() || !shown.description.is_empty();
            (documented + usize::from(is), all + 1)
        })
    }
}

/// Documentation is looked up by complete addresses without the `#` of file operands.
impl From<&Address> for Target {
    fn from(address: &Address) -> Target {
        Target::Address(Address { indexed: false, ..address.clone() })
    }
}

impl Target {
    /// The address, if the target is one and no part of it is indirect.
    pub fn direct_address(&self) -> Option<&Address> {
        match self {
            Target::Address(address) if matches!(address.element, Place::Number(_)) && address.is_direct() => {
                Some(address)
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn target(text: &str) -> Target {
        Target::Address(Address::parse(text).expect("address"))
    }

    fn entry(text: &str, symbol: &str, lines: &[&str]) -> AddressEntry {
        AddressEntry {
            target: target(text),
            symbol: symbol.into(),
            description: lines.iter().map(|line| (*line).into()).collect(),
        }
    }

    #[test]
    fn parts_inherit_from_their_element() {
        let mut docs = Documentation::default();
        docs.add(entry("T4:0", "TIMER_500MS", &["half second"]));
        docs.add(entry("T4:0/DN", "", &[]));
        docs.add(entry("T4:1/DN", "CONTACT", &[]));
        docs.add(entry("T4:1", "", &["valve in"]));
        docs.add(entry("I:1.0", "WORD", &["not for bits"]));
        docs.add_instruction_comment(InstructionComment {
            mnemonic: "XIO".into(),
            target: Some(target("T4:0/DN")),
            lines: vec!["still timing".into()],
        });
        let shown = docs.shown(&target("T4:0/DN"), "XIC");
        assert_eq!(shown.symbol.as_deref(), Some("TIMER_500MS/DN"));
        assert_eq!(shown.description, ["half second"]);
        assert_eq!(docs.shown(&target("T4:0/DN"), "XIO").description, ["still timing"]);
        assert_eq!(docs.shown(&target("T4:0.ACC"), "MOV").symbol.as_deref(), Some("TIMER_500MS.ACC"));
        let own = docs.shown(&target("T4:1/DN"), "XIC");
        assert_eq!((own.symbol.as_deref(), own.description), (Some("CONTACT"), vec!["valve in".to_owned()]));
        assert_eq!(docs.shown(&target("I:1.0/3"), "XIC"), Shown::default());
        assert_eq!(docs.by_symbol("contact").map(|e| e.target.to_string()).as_deref(), Some("T4:1/DN"));
    }
}
