//! Cross reference: every access to the data table, found by any address it overlaps.
//!
//! An address is touched by more than the instructions that name it: a bit by a move of its word, a
//! copy over its file, a shift through it, a message; a member of a timer by the timer instruction.
//! [`CrossReference::of`] answers with all of them. Where brackets or S:24 choose the place while the
//! program runs, the access *may* touch the address, and says so.
//!
//! What it does not know stands in [`CrossReference::notes`] and [`CrossReference::unresolved`]; who
//! writes from outside the program (terminals, other controllers) does not stand in a project at all.

mod collect;
mod findings;
mod index;
mod message;
mod query;
mod reach;
mod symbols;

use std::cmp::Reverse;
use std::collections::{HashMap, HashSet};
use std::ops::ControlFlow;

use instr::{Kind, Role};
use ladder::{Address, Documentation, Family, FileType, Image, Mnemonic, Operand, Value};

use crate::budget::Budget;
use crate::location::Location;
use crate::space::{Area, Key, Spaces};
pub(crate) use collect::Use;
use collect::{Collected, Spelled, collect};
use index::Index;
pub(crate) use index::Span;

pub use findings::{Finding, FindingKind, Findings, Reason};
pub use query::Found;
pub(crate) use symbols::Symbols;

/// Who reads and writes what, for one image.
pub struct CrossReference<'a> {
    image: &'a Image,
    documentation: &'a Documentation,
    data: Collected<'a>,
    index: Index,
    /// Stretches of uses whose address is decided at run time, by that address as it is written.
    computed: HashMap<Spelled<'a>, Vec<Span>>,
}

/// An access to an address, seen from that address.
#[derive(Clone, Debug)]
pub struct Access<'x> {
    /// Where.
    pub location: Location,
    /// By which instruction.
    pub mnemonic: &'x Mnemonic,
    /// Through which operand, by its name in the box; empty when no operand names the data (flags) or
    /// the instruction is not known.
    pub operand: &'static str,
    /// That operand as written; for flags and the like the address itself.
    pub address: &'x Address,
    /// The symbol that stood in its place, in rungs that were never verified.
    pub symbol: Option<&'x str>,
    /// What happens to the data asked for.
    pub role: Role,
    /// Whether it happens.
    pub certainty: Certainty,
    /// How much of the data table the access takes at once.
    pub level: Level,
    /// In which way the operand leads there.
    pub through: Through,
    /// The data touched, as addresses: `N7:10..N7:14`, `T4:*.ACC` for that member of any element,
    /// `N7:10..` for an end not known. Several stretches are separated by a comma and a space.
    pub touched: String,
}

/// Whether an access happens when its instruction does its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Certainty {
    /// It does.
    Definite,
    /// It can: the place is decided at run time, or by a setting that is not known.
    May,
}

impl Certainty {
    /// `definite` or `may`.
    pub fn as_str(self) -> &'static str {
        match self {
            Certainty::Definite => "definite",
            Certainty::May => "may",
        }
    }
}

/// How much one access takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Level {
    /// One bit.
    Bit,
    /// Some bits of a word, through a mask.
    Bits,
    /// A word, long word, float or word member.
    Word,
    /// A whole structured element: timer, string, message.
    Element,
    /// Several words or bits in a row, from a file operand.
    Range,
    /// Any place of a file, or from one place to its end.
    File,
    /// Any file of the type.
    AnyFile,
}

impl Level {
    /// The word in outputs: `bit`, `bits`, `word`, `element`, `range`, `file`, `any file`.
    pub fn as_str(self) -> &'static str {
        match self {
            Level::Bit => "bit",
            Level::Bits => "bits",
            Level::Word => "word",
            Level::Element => "element",
            Level::Range => "range",
            Level::File => "file",
            Level::AnyFile => "any file",
        }
    }
}

/// In which way an instruction reaches data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Through {
    /// The operand names it, or an element or file it lies in.
    Operand,
    /// Nothing in the box names it: flags, math register, a function file.
    Implied,
    /// It stands in the brackets of an operand.
    Pointer,
    /// S:24, read because an operand is written with `#`.
    IndexRegister,
    /// A message moves it, in the background and not when the rung is scanned.
    Message,
}

impl Through {
    /// The word in outputs.
    pub fn as_str(self) -> &'static str {
        match self {
            Through::Operand => "operand",
            Through::Implied => "implied",
            Through::Pointer => "pointer",
            Through::IndexRegister => "index register",
            Through::Message => "message",
        }
    }
}

/// An operand or instruction whose data cannot be told.
#[derive(Clone, Debug)]
pub struct Unresolved<'a> {
    /// Where.
    pub location: Location,
    /// The instruction.
    pub mnemonic: &'a Mnemonic,
    /// Name of the operand, empty when the instruction as a whole is meant.
    pub operand: &'static str,
    /// What stands there.
    pub text: String,
    /// Why it says nothing.
    pub kind: UnresolvedKind,
}

/// Why an operand or instruction says nothing about data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UnresolvedKind {
    /// A symbol without an address in the documentation.
    Symbol,
    /// No operand entered yet.
    NotEntered,
    /// A text of no known form.
    Operand,
    /// An instruction that is not in the table. Its addresses count as perhaps read and written.
    Instruction,
    /// A known instruction with a number of operands that no form of it has; treated the same.
    OperandCount,
}

impl UnresolvedKind {
    /// The reason in words.
    pub fn as_str(self) -> &'static str {
        match self {
            UnresolvedKind::Symbol => "symbol without an address",
            UnresolvedKind::NotEntered => "operand not entered",
            UnresolvedKind::Operand => "operand not understood",
            UnresolvedKind::Instruction => "unknown instruction",
            UnresolvedKind::OperandCount => "unknown number of operands",
        }
    }
}

/// A limit of what this cross reference can say about the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Note {
    /// S:2/3 is set: an indexed address can leave its file, and is listed within it.
    IndexLeavesFiles,
    /// Direction or size of this message is not known; it is listed as far as it could reach.
    MessageArea(Location),
    /// The addresses of this recipe stand in the controller's configuration, which is not read.
    RecipeAddresses(Location),
}

impl Note {
    /// The note in words, without the place.
    pub fn as_str(self) -> &'static str {
        match self {
            Note::IndexLeavesFiles => "S:2/3 is set: indexed addresses can leave their file; they are listed within it",
            Note::MessageArea(_) => "direction or size of the message is not known; listed as far as it could reach",
            Note::RecipeAddresses(_) => "the addresses of the recipe are not known",
        }
    }

    /// The instruction it is about.
    pub fn location(self) -> Option<Location> {
        match self {
            Note::IndexLeavesFiles => None,
            Note::MessageArea(location) | Note::RecipeAddresses(location) => Some(location),
        }
    }
}

/// All accesses to one address the program names.
#[derive(Clone, Debug)]
pub struct Group<'x> {
    /// The address. One with brackets or `#` lists only the accesses written with it.
    pub address: Address,
    /// Definite accesses first, then the others, each in program order.
    pub accesses: Vec<Access<'x>>,
    /// Accesses beyond those listed, see [`crate::MAX_LISTED`]; `None` where they were not even looked
    /// up. [`CrossReference::of`] gives all of them.
    pub left_out: Option<usize>,
}

impl<'a> CrossReference<'a> {
    /// Walks through all ladder files of an image. The documentation resolves symbols in rungs that
    /// were never verified; give the main image's for an online image, which has none of its own.
    pub fn build(image: &'a Image, documentation: &'a Documentation) -> CrossReference<'a> {
        let mut data = collect(image, documentation);
        let mut index = Index::new(&data.spans, &data.spaces);
        widen_written_lengths(&data, &mut index);
        if index_can_leave_files(image, &data) {
            data.notes.push(Note::IndexLeavesFiles);
        }
        let mut computed: HashMap<Spelled<'a>, Vec<Span>> = HashMap::new();
        for span in &data.spans {
            let address = data.uses.get(span.by).map(|it| &it.address).filter(|address| is_computed(address));
            if let Some(address) = address {
                match computed.get_mut(&**address) {
                    Some(spans) => spans.push(*span),
                    None => drop(computed.insert(address.clone(), vec![*span])),
                }
            }
        }
        CrossReference { image, documentation, data, index, computed }
    }

    /// Every access that touches some of what an address names. `#` before the address is not looked
    /// at; of an address with brackets only the accesses written exactly so.
    pub fn of(&self, address: &Address) -> Vec<Access<'_>> {
        let budget = &mut Budget::unlimited();
        let found = if address.indirections().next().is_some() {
            self.accesses(address, None, budget)
        } else {
            match self.data.spaces.find_place(address) {
                Some(placed) => self.accesses(address, Some(placed.area), budget),
                // No instruction leads into that file.
                None => None,
            }
        };
        found.map_or_else(Vec::new, |(accesses, _)| accesses)
    }

    /// Every address the program names with its accesses, files and addresses in ascending order;
    /// in each file the addresses that are decided at run time come last.
    ///
    /// Each group is made when it is asked for, and together they list at most [`crate::MAX_ROWS`]
    /// accesses: all could be larger than the program by the square, where many addresses lie under
    /// many copies of a whole file.
    pub fn all(&self) -> impl Iterator<Item = Group<'_>> {
        let mut addresses: Vec<(GroupKey, &Address, Option<Area>)> = Vec::new();
        for named in &self.data.named {
            addresses.push((group_key(&named.address, Some(named.area)), &named.address, Some(named.area)));
        }
        for address in self.computed_addresses() {
            addresses.push((group_key(address, None), address, None));
        }
        addresses.sort_by(|a, b| a.0.cmp(&b.0));
        let mut budget = Budget::of_report();
        addresses.into_iter().map(move |(_, address, area)| self.group(address, area, &mut budget))
    }

    /// The accesses of an address as far as the budget goes; without an area only those written so.
    fn group(&self, address: &Address, area: Option<Area>, budget: &mut Budget) -> Group<'_> {
        let found = self.accesses(address, area, budget);
        let (accesses, left_out) = found.map_or((Vec::new(), None), |(accesses, more)| (accesses, Some(more)));
        Group { address: address.clone(), accesses, left_out }
    }

    /// Addresses that operands name, ascending, without those that are decided at run time.
    pub fn named(&self) -> Vec<&Address> {
        let mut all: Vec<_> =
            self.data.named.iter().map(|n| (group_key(&n.address, Some(n.area)), &*n.address)).collect();
        all.sort_by(|a, b| a.0.cmp(&b.0));
        all.into_iter().map(|(_, address)| address).collect()
    }

    /// Operands and instructions about which nothing can be said.
    pub fn unresolved(&self) -> &[Unresolved<'a>] {
        &self.data.unresolved
    }

    /// Limits of this cross reference.
    pub fn notes(&self) -> &[Note] {
        &self.data.notes
    }

    /// Every stretch of data an instruction touches.
    pub(crate) fn spans(&self) -> impl Iterator<Item = (Location, &Span)> {
        self.data.spans.iter().filter_map(|span| Some((self.data.uses.get(span.by)?.location, span)))
    }

    /// The files the stretches lie in.
    pub(crate) fn spaces(&self) -> &Spaces<'a> {
        &self.data.spaces
    }

    /// The value stored at an address.
    pub fn value(&self, address: &Address) -> Option<Value> {
        self.image.value_at(address)
    }

    /// The program.
    pub fn image(&self) -> &'a Image {
        self.image
    }

    /// The documentation it resolves symbols with.
    pub fn documentation(&self) -> &'a Documentation {
        self.documentation
    }

    /// The address an operand means, a symbol resolved.
    pub fn resolve(&self, operand: &Operand) -> Option<Address> {
        self.data.symbols.address(operand)
    }

    /// Each address that is decided at run time, once, in program order.
    fn computed_addresses(&self) -> impl Iterator<Item = &Address> {
        let mut seen = HashSet::new();
        let all = self.data.computed.iter().filter_map(|by| self.data.uses.get(*by)).map(|it| &*it.address);
        all.filter(move |address| seen.insert(*address))
    }

    /// The first accesses, and how many more there are; `None` when the budget is spent.
    fn accesses(&self, address: &Address, area: Option<Area>, budget: &mut Budget) -> Option<(Vec<Access<'_>>, usize)> {
        let mut spans = match area {
            Some(area) => self.overlapping(area, budget)?,
            None => self.computed.get(address).cloned().unwrap_or_default(),
        };
        Some(self.to_accesses(&mut spans, budget))
    }

    /// All stretches that meet an area; `None` when the budget is spent.
    pub(crate) fn overlapping(&self, area: Area, budget: &mut Budget) -> Option<Vec<Span>> {
        if budget.is_spent() {
            return None;
        }
        let mut spans = Vec::new();
        let compared = self.index.overlapping(&self.data.spans, &self.data.spaces, area, |span| {
            spans.push(*span);
            ControlFlow::Continue(())
        });
        budget.spend(compared);
        Some(spans)
    }

    /// For each element of a file whether some access certainly touches it, ranges included.
    pub(crate) fn touched_elements(&self, file_type: FileType, number: u16, elements: u16) -> Vec<bool> {
        // Steps up where an access begins and down behind its end; their running sum counts accesses.
        let mut steps = vec![0_i64; usize::from(elements) + 1];
        let space = self.data.spaces.find(Key { file_type, number: Some(number), slot: None });
        for span in self.data.spans.iter().filter(|span| span.definite && Some(span.area.space) == space) {
            let stride = self.data.spaces.stride(span.area.space);
            let clamp = |element: u64| usize::try_from(element).unwrap_or(usize::MAX).min(usize::from(elements));
            let (first, end) = (clamp(span.area.first / stride), clamp(span.area.end().div_ceil(stride)));
            if let Some(step) = steps.get_mut(first) {
                *step += 1;
            }
            if let Some(step) = steps.get_mut(end) {
                *step -= 1;
            }
        }
        let mut open = 0;
        let touched = steps.into_iter().take(usize::from(elements)).map(|step| {
            open += step;
            open > 0
        });
        touched.collect()
    }

    pub(crate) fn overlap(&self, a: &Area, b: &Area) -> bool {
        a.overlaps(b, self.data.spaces.stride(b.space))
    }

    pub(crate) fn place(&self, address: &Address) -> Option<Area> {
        self.data.spaces.find_place(address).map(|placed| placed.area)
    }

    /// What the address of a use names, if nothing about it is decided at run time.
    fn named_area(&self, it: &Use<'_>) -> Option<Area> {
        Some(self.data.named.get(it.named?)?.area)
    }

    pub(crate) fn use_of(&self, span: &Span) -> Option<&Use<'a>> {
        self.data.uses.get(span.by)
    }

    /// One access per operand, its stretches joined; as many as the budget allows, and how many more.
    fn to_accesses(&self, spans: &mut [Span], budget: &mut Budget) -> (Vec<Access<'_>>, usize) {
        spans.sort_by_key(|span| (span.by, span.area.first));
        let mut all: Vec<(Certainty, &Use<'a>, &[Span])> = spans
            .chunk_by(|a, b| a.by == b.by)
            .filter_map(|spans| {
                let it = self.use_of(spans.first()?)?;
                Some((certainty(spans.iter().any(|span| span.definite)), it, spans))
            })
            .collect();
        all.sort_by_key(|(certainty, it, _)| (*certainty, it.location));
        let listed = budget.rows(all.len());
        let more = all.len() - listed;
        let accesses = all.into_iter().take(listed).filter_map(|(certainty, it, spans)| {
            let texts: Vec<String> = spans.iter().map(|span| self.data.spaces.text(span.area)).collect();
            Some(Access {
                location: it.location,
                mnemonic: it.mnemonic,
                operand: it.operand,
                address: &it.address,
                symbol: it.symbol,
                role: joined_role(spans.iter().map(|span| span.role)),
                certainty,
                level: spans.iter().map(|span| span.level).max()?,
                through: it.through,
                touched: texts.join(", "),
            })
        });
        (accesses.collect(), more)
    }
}

/// Brackets or `#` leave to run time what the address means.
fn is_computed(address: &Address) -> bool {
    address.indexed || address.indirections().next().is_some()
}

pub(crate) fn certainty(definite: bool) -> Certainty {
    if definite { Certainty::Definite } else { Certainty::May }
}

/// What several roles on the same data amount to.
pub(crate) fn joined_role(roles: impl Iterator<Item = Role>) -> Role {
    let (mut reads, mut writes) = (false, false);
    for role in roles {
        reads |= role.reads();
        writes |= role.writes();
    }
    match (reads, writes) {
        (true, true) => Role::ReadWrite,
        (_, true) => Role::Write,
        _ => Role::Read,
    }
}

/// An instruction whose length is written by another one can reach further than it does now.
fn widen_written_lengths(data: &Collected<'_>, index: &mut Index) {
    let mut budget = Budget::of_report();
    for length in &data.lengths {
        // What nobody has time to look up may be written.
        let mut written = budget.is_spent();
        if !written {
            let compared = index.overlapping(&data.spans, &data.spaces, length.len, |span| {
                let elsewhere = data.uses.get(span.by).is_some_and(|it| it.location != length.location);
                // RES and the instructions of a control element leave LEN alone: they do not overlap it.
                written = elsewhere && span.role.writes();
                if written { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            budget.spend(compared);
        }
        if written {
            index.add(length.beyond);
        }
    }
}

fn index_can_leave_files(image: &Image, data: &Collected<'_>) -> bool {
    let indexed = data.uses.iter().any(|it| it.through == Through::IndexRegister);
    let own_status_file = image.family().is_micrologix() && image.family() != Family::MicroLogix1000;
    let across = Address::element(FileType::S, 2, 2).with_bit(3);
    indexed && !own_status_file && image.value_at(&across) == Some(Value::Bit(true))
}

/// Order of addresses: data files by number, then module files, then function files.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct GroupKey {
    class: u8,
    file: u16,
    file_type: FileType,
    computed: bool,
    slot: u16,
    first: u64,
    bits: Reverse<u64>,
    text: String,
}

fn group_key(address: &Address, area: Option<Area>) -> GroupKey {
    let file_type = address.file_type;
    let class = match file_type {
        FileType::M0 | FileType::M1 => 1,
        t if t.is_function_file() => 2,
        _ => 0,
    };
    let (first, bits) = area.map_or((0, 0), |area| (area.first, area.bits));
    let slots = file_type.has_slots();
    GroupKey {
        class,
        file: address.file.number().unwrap_or(u16::MAX),
        file_type,
        computed: area.is_none(),
        slot: if slots { address.element.number().unwrap_or(u16::MAX) } else { 0 },
        first: if slots {
            let bit = address.bit.as_ref().and_then(ladder::Place::number).unwrap_or(0);
            u64::from(address.word.unwrap_or(0)) * 16 + u64::from(bit)
        } else {
            first
        },
        bits: Reverse(bits),
        text: if area.is_none() { address.to_string() } else { String::new() },
    }
}

/// Instructions that own the element they name: what they do to it is their own bookkeeping.
pub(crate) fn owns_element(kind: Option<Kind>) -> bool {
    matches!(
        kind,
        Some(Kind::Timer | Kind::Counter | Kind::Control | Kind::MessageBlock | Kind::PidBlock | Kind::RoutingBlock)
    )
}
