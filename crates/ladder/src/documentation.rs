//! Symbols, descriptions and comments, and the rules by which they are shown at an operand.

use std::borrow::Cow;
use std::fmt;
use std::hash::{BuildHasher, Hash};

use foldhash::HashMap;
use foldhash::fast::RandomState;

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
    by_target: Index,
    instruction_comments: Vec<InstructionComment>,
    /// By target and mnemonic; the first of equal ones.
    by_target_and_mnemonic: Index,
    /// Comments that no rung shows: their rung was deleted or got another comment. Kept.
    pub detached_comments: Vec<Comment>,
}

/// Where the first of equal keys stands in a list. The list has the keys; a second copy of each here
/// would be the larger part of all documentation, so this has their hashes only.
#[derive(Clone, Debug, Default)]
struct Index {
    state: RandomState,
    by_hash: HashMap<u64, usize>,
}

impl Index {
    /// The number of the item with this key, or else the free place for it. `is` tells whether the
    /// item of a number has the key.
    fn find(&self, key: &impl Hash, is: impl Fn(usize) -> bool) -> Result<usize, u64> {
        let mut place = self.state.hash_one(key);
        loop {
            match self.by_hash.get(&place) {
                None => return Err(place),
                Some(number) if is(*number) => return Ok(*number),
                // Another key of the same hash: its place is taken, the next one serves.
                Some(_) => place = place.wrapping_add(1),
            }
        }
    }

    /// Gives a key its number, unless it has one.
    fn add(&mut self, key: &impl Hash, number: usize, is: impl Fn(usize) -> bool) {
        if let Err(free) = self.find(key, is) {
            self.by_hash.insert(free, number);
        }
    }
}

fn is_about(entries: &[AddressEntry], number: usize, target: &Target) -> bool {
    entries.get(number).is_some_and(|entry| *entry.target.looked_up() == *target)
}

fn is_comment_on(comments: &[InstructionComment], number: usize, target: &Target, mnemonic: &str) -> bool {
    let same = |of: &Target| *of.looked_up() == *target;
    comments.get(number).is_some_and(|c| c.mnemonic == mnemonic && c.target.as_ref().is_some_and(same))
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
    /// Symbol, with the suffix of the operand when the symbol is the element's (`MODE/3`,
    /// `SOURCE/[INDEX]`); an indirect address without one has the symbols of the addresses in its
    /// brackets there (`N9:[INDEX]`). An indexed address has its `#` before it.
    pub symbol: Option<String>,
    /// Description lines.
    pub description: Vec<String>,
}

impl Documentation {
    /// Adds an entry. A later entry for the same target is kept but never looked up.
    pub fn add(&mut self, entry: AddressEntry) {
        if entry.target != Target::Unassigned {
            let target = entry.target.looked_up();
            self.by_target.add(&*target, self.entries.len(), |number| is_about(&self.entries, number, &target));
        }
        self.entries.push(entry);
    }

    /// Adds an instruction comment. A later one for the same target and mnemonic is kept but never
    /// looked up.
    pub fn add_instruction_comment(&mut self, comment: InstructionComment) {
        if let Some(target) = &comment.target {
            let (target, comments) = (target.looked_up(), &self.instruction_comments);
            self.by_target_and_mnemonic.add(&(&*target, &*comment.mnemonic), comments.len(), |number| {
                is_comment_on(comments, number, &target, &comment.mnemonic)
            });
        }
        self.instruction_comments.push(comment);
    }

    /// All entries in the order they were added.
    pub fn entries(&self) -> &[AddressEntry] {
        &self.entries
    }

    /// All instruction comments in the order they were added.
    pub fn instruction_comments(&self) -> &[InstructionComment] {
        &self.instruction_comments
    }

    /// The entry of a target; the `#` of an indexed address does not count.
    pub fn entry(&self, target: &Target) -> Option<&AddressEntry> {
        let target = target.looked_up();
        let number = self.by_target.find(&*target, |number| is_about(&self.entries, number, &target)).ok()?;
        self.entries.get(number)
    }

    /// The instruction comment of a target under a mnemonic.
    fn instruction_comment(&self, target: &Target, mnemonic: &str) -> Option<&InstructionComment> {
        let (target, comments) = (target.looked_up(), &self.instruction_comments);
        let is = |number| is_comment_on(comments, number, &target, mnemonic);
        comments.get(self.by_target_and_mnemonic.find(&(&*target, mnemonic), is).ok()?)
    }

    /// What a person means by `symbol`: the entry that has it, upper or lower case.
    pub fn by_symbol(&self, symbol: &str) -> Option<&AddressEntry> {
        self.entries.iter().find(|entry| !entry.symbol.is_empty() && entry.symbol.eq_ignore_ascii_case(symbol))
    }

    /// Symbol and description shown at a target under an instruction.
    ///
    /// Own symbol, else the element's symbol with the operand's suffix, else the address with symbols
    /// in its brackets; the instruction comment of this mnemonic and address, else the own
    /// description, else the element's. Read off printed ladder pages; how a word or bit of I and O
    /// inherits was never seen printed, they do not here.
    pub fn shown(&self, target: &Target, mnemonic: &str) -> Shown {
        let own = self.entry(target);
        let (symbol, element) = match target {
            Target::Address(address) => {
                let mark = if address.indexed { "#" } else { "" };
                let symbol = self.address_symbol(address).map(|symbol| format!("{mark}{symbol}"));
                (symbol, self.element_entry(address))
            }
            _ => (own.and_then(AddressEntry::symbol).map(str::to_owned), None),
        };
        let description = match self.instruction_comment(target, mnemonic) {
            Some(comment) => comment.lines.clone(),
            None => [own, element]
                .into_iter()
                .flatten()
                .map(|entry| &entry.description)
                .find(|lines| !lines.is_empty())
                .cloned()
                .unwrap_or_default(),
        };
        Shown { symbol, description }
    }

    /// The symbol shown at an address, without the `#` of an indexed one.
    fn address_symbol(&self, address: &Address) -> Option<String> {
        if let Some(symbol) = self.entry(&Target::Address(address.clone())).and_then(AddressEntry::symbol) {
            return Some(symbol.to_owned());
        }
        let text = Address { indexed: false, ..address.clone() }.to_string();
        if let Some(symbol) = self.element_entry(address).and_then(AddressEntry::symbol) {
            let element = whole_element(address).to_string();
            let suffix = text.strip_prefix(&element).unwrap_or("");
            let inside = match &address.bit {
                Some(Place::Indirect(inside)) => Some(&**inside),
                _ => None,
            };
            let suffix = self.with_symbols(suffix, inside.into_iter()).unwrap_or_else(|| suffix.to_owned());
            return Some(format!("{symbol}{suffix}"));
        }
        self.with_symbols(&text, address.indirections())
    }

    /// The text with the symbols of the addresses in its brackets, which are given in their order.
    /// `None` if none of them has one.
    fn with_symbols<'a>(&self, text: &str, inside: impl Iterator<Item = &'a Address>) -> Option<String> {
        let (mut shown, mut rest, mut found) = (String::new(), text, false);
        for address in inside {
            let written = format!("[{address}]");
            let Some((before, after)) = rest.split_once(&written) else { continue };
            shown.push_str(before);
            match self.address_symbol(address) {
                Some(symbol) => {
                    found = true;
                    shown.push_str(&format!("[{symbol}]"));
                }
                None => shown.push_str(&written),
            }
            rest = after;
        }
        shown.push_str(rest);
        found.then_some(shown)
    }

    /// The entry of the element a word or bit lies in.
    fn element_entry(&self, address: &Address) -> Option<&AddressEntry> {
        let has_part = address.word.is_some() || address.bit.is_some();
        if !has_part || address.file_type.has_slots() {
            return None;
        }
        self.entry(&Target::Address(whole_element(address)))
    }
}

/// The element an address lies in, its places as they are written.
fn whole_element(address: &Address) -> Address {
    Address { indexed: false, word: None, bit: None, ..address.clone() }
}

impl AddressEntry {
    /// The symbol, if there is one.
    fn symbol(&self) -> Option<&str> {
        Some(self.symbol.as_str()).filter(|symbol| !symbol.is_empty())
    }
}

impl From<&Address> for Target {
    fn from(address: &Address) -> Target {
        Target::Address(address.clone())
    }
}

impl Target {
    /// What an entry is stored under: addresses without the `#` of file operands.
    fn looked_up(&self) -> Cow<'_, Target> {
        match self {
            Target::Address(address) if address.indexed => {
                Cow::Owned(Target::Address(Address { indexed: false, ..address.clone() }))
            }
            target => Cow::Borrowed(target),
        }
    }

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

    /// Every key with the same hash: each still has its own number.
    #[test]
    fn keys_of_one_hash_stay_apart() {
        struct Same;
        impl Hash for Same {
            fn hash<H: std::hash::Hasher>(&self, _: &mut H) {}
        }
        let keys = [5, 6, 5, 7];
        let mut index = Index::default();
        for (number, key) in keys.into_iter().enumerate() {
            index.add(&Same, number, |n| keys[n] == key);
        }
        let found = [5, 6, 7, 8].map(|key| index.find(&Same, |n| keys[n] == key).ok());
        assert_eq!(found, [Some(0), Some(1), Some(3), None]);
    }

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
    #[test]
    fn symbols_stand_in_brackets() {
        let mut docs = Documentation::default();
        docs.add(entry("N7:4", "INDEX", &["which one"]));
        docs.add(entry("C5:1", "LOOP", &[]));
        docs.add(entry("L9:0", "SOURCE", &["all bits"]));
        docs.add(entry("N[N7:4]:0", "BUFFER", &[]));
        docs.add(entry("N[N7:4]:21", "BITS", &[]));
        docs.add(entry("N10:[N7:4]", "", &["described only"]));
        for (address, symbol) in [
            ("L9:0/[N7:4]", "SOURCE/[INDEX]"),
            ("L9:0/[N7:5]", "SOURCE/[N7:5]"),
            ("L9:1/[N7:4]", "L9:1/[INDEX]"),
            ("I:0.0/[N7:4]", "I:0.0/[INDEX]"),
            ("N10:[N7:4]", "N10:[INDEX]"),
            ("T104:[C5:1.ACC].PRE", "T104:[LOOP.ACC].PRE"),
            ("N[N7:4]:[N7:3]", "N[INDEX]:[N7:3]"),
            ("N[N7:3]:[N7:4]/[N7:4]", "N[N7:3]:[INDEX]/[INDEX]"),
            ("#N[N7:4]:0", "#BUFFER"),
            ("N[N7:4]:21/1", "BITS/1"),
            ("#N9:[N7:4]", "#N9:[INDEX]"),
            ("#L9:0", "#SOURCE"),
        ] {
            assert_eq!(docs.shown(&target(address), "MOV").symbol.as_deref(), Some(symbol), "{address}");
        }
        for address in ["N9:[N7:5]", "#N9:0", "ST9:1.DATA[3]"] {
            assert_eq!(docs.shown(&target(address), "MOV").symbol, None, "{address}");
        }
        assert_eq!(docs.shown(&target("L9:0/[N7:4]"), "XIC").description, ["all bits"]);
        assert_eq!(docs.shown(&target("N10:[N7:4]"), "MOV").description, ["described only"]);
        assert!(docs.shown(&target("N9:[N7:4]"), "MOV").description.is_empty());
    }
}
