//! Cross reference: which instruction reads or writes what.
//!
//! Every operand is taken for the bits of memory it stands for, so that members, casts, ranges,
//! nicknames and table operands find each other: `C32:UW` touches `C40`, `RSTR C0 C10` touches `C5`,
//! `T0.Done` touches `T0` but not `T0.Acc`.

mod collect;

use std::collections::HashMap;

use crate::address::Address;
use crate::instruction::Role;
use crate::memory::{Kind, Map, NameError, Resolved};
use crate::program::Project;

/// One access of an instruction to something.
#[derive(Clone, Debug, PartialEq)]
pub struct Access {
    /// Name of the code block; empty for bare rungs.
    pub code_block: String,
    /// Number of the rung, from 1.
    pub rung: usize,
    /// Line of the file, if it was read from one.
    pub line: Option<u32>,
    /// The instruction.
    pub mnemonic: String,
    /// The address as written.
    pub written: String,
    /// What happens; `None` for an instruction that is not known.
    pub role: Option<Role>,
    /// Where in the instruction it stands.
    pub through: Through,
    /// Not certain to be touched: an index or count that only running decides.
    pub may: bool,
    /// What is touched.
    pub area: Area,
}

/// Where in an instruction an address stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Through {
    /// It is an operand.
    Operand,
    /// In a MATH expression.
    Expression,
    /// In a table operand.
    Table,
    /// In the brackets of an indexed address.
    Index,
}

impl Through {
    /// Lower-case word used in every output.
    pub fn as_str(self) -> &'static str {
        match self {
            Through::Operand => "operand",
            Through::Expression => "expression",
            Through::Table => "table",
            Through::Index => "index",
        }
    }
}

impl Role {
    /// Lower-case words used in every output.
    pub fn as_str(self) -> &'static str {
        match self {
            Role::Read => "read",
            Role::Write => "write",
            Role::ReadWrite => "read and write",
            Role::Reset => "reset",
            Role::Own => "own",
            Role::Refer => "refer",
            Role::Parameter => "parameter",
        }
    }

    /// Whether it can change.
    pub fn writes(self) -> bool {
        matches!(self, Role::Write | Role::ReadWrite | Role::Reset | Role::Own)
    }
}

/// What an access touches.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Area {
    /// Bits of memory, counted through all of it: first and one behind the last.
    Bits(u32, u32),
    /// A name that stands for no memory that is modelled (a code block, a PID structure, ...), or for
    /// none at all; in upper case.
    Name(String),
}

/// All accesses of a project.
#[derive(Debug)]
pub struct CrossReference {
    map: Map,
    accesses: Vec<Access>,
    /// Elements the accesses name, as first written, in order of first use, with their whole area.
    elements: Vec<(String, Area)>,
    /// Accesses of [`Self::elements`] by their area, as indices.
    of_element: HashMap<Area, Vec<usize>>,
    /// Accesses that reach beyond the element they name.
    wide: Vec<usize>,
    /// Elements that are all of a block: indexed ones.
    blocks: usize,
    unresolved: Vec<Unresolved>,
}

/// An operand that could not be looked into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unresolved {
    /// Name of the code block.
    pub code_block: String,
    /// Number of the rung, from 1.
    pub rung: usize,
    /// The instruction.
    pub mnemonic: String,
    /// The operand as written.
    pub operand: String,
    /// What was expected.
    pub why: String,
}

/// An element with only one side of its use in the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OneSided {
    /// Nothing writes it.
    ReadNeverWritten,
    /// Nothing reads it.
    WrittenNeverRead,
}

impl OneSided {
    /// What deserves a look: a control relay or register with only one side of its use in the program.
    /// Inputs, outputs, communication and system memory have their other side elsewhere.
    pub fn of(element: &str, accesses: &[&Access]) -> Option<OneSided> {
        const OWN: [&str; 8] = ["C", "V", "N", "D", "R", "SS", "SL", "DLC"];
        let block = element.trim_end_matches(|c: char| c.is_ascii_digit());
        if block.len() == element.len() || !OWN.iter().any(|own| own.eq_ignore_ascii_case(block)) {
            return None;
        }
        // An instruction that is not known may do anything.
        let role = |test: fn(Role) -> bool| accesses.iter().any(|access| access.role.is_none_or(test));
        match (role(|role| !matches!(role, Role::Write | Role::Reset)), role(Role::writes)) {
            (true, false) => Some(OneSided::ReadNeverWritten),
            (false, true) => Some(OneSided::WrittenNeverRead),
            _ => None,
        }
    }

    /// The finding in words.
    pub fn as_str(self) -> &'static str {
        match self {
            OneSided::ReadNeverWritten => "read, never written",
            OneSided::WrittenNeverRead => "written, never read",
        }
    }
}

impl Access {
    /// What happens in words: `read`, `may write`, `unknown`.
    pub fn does(&self) -> String {
        let role = self.role.map_or("unknown", Role::as_str);
        if self.may { format!("may {role}") } else { role.to_owned() }
    }
}

/// Comparisons of wide accesses with elements that listing everything may take.
const BUDGET: usize = 50_000_000;

impl CrossReference {
    /// Looks at every instruction of a project.
    ///
    /// # Errors
    /// The project declares more memory than any controller has.
    pub fn build(project: &Project) -> Result<CrossReference, NameError> {
        let map = Map::new(project)?;
        let (accesses, unresolved) = collect::collect(project, &map);
        let mut xref = CrossReference {
            map,
            accesses: Vec::new(),
            elements: Vec::new(),
            of_element: HashMap::new(),
            wide: Vec::new(),
            blocks: 0,
            unresolved,
        };
        for (index, access) in accesses.iter().enumerate() {
            let base = xref.base(&access.written);
            // The area of the element as a whole; a nickname and its element have the same.
            let Some(whole) = xref.area(&base) else { continue };
            // A stage has a place of its own; the code block before its point has none.
            let (base, whole) = match (&whole, &access.area) {
                (Area::Name(_), Area::Bits(..)) => (access.written.clone(), access.area.clone()),
                _ => (base, whole),
            };
            let reaches = match (&access.area, &whole) {
                (Area::Bits(from, to), Area::Bits(first, end)) => from < first || to > end,
                _ => false,
            };
            if reaches || is_indexed(&base) {
                xref.wide.push(index);
            }
            let known = xref.of_element.entry(whole.clone()).or_default();
            if known.is_empty() {
                xref.blocks += usize::from(is_indexed(&base));
                xref.elements.push((base, whole));
            }
            known.push(index);
        }
        xref.accesses = accesses;
        Ok(xref)
    }

    /// All accesses, in the order of the program.
    pub fn accesses(&self) -> &[Access] {
        &self.accesses
    }

    /// Operands that could not be looked into.
    pub fn unresolved(&self) -> &[Unresolved] {
        &self.unresolved
    }

    /// Elements the program names, as first written, in order of first use.
    pub fn elements(&self) -> impl Iterator<Item = &str> {
        self.elements.iter().map(|(name, _)| name.as_str())
    }

    /// The element an address is about, without member and cast.
    fn base(&self, written: &str) -> String {
        let address = Address::parse_with(written, |block| self.map.radix(block));
        match address {
            Ok(address) => address.base().unwrap_or_else(|| written.to_owned()),
            Err(_) => written.to_owned(),
        }
    }

    /// What a text stands for: an element, a member or cast, a nickname, a name; `None` for a constant
    /// or what is no address.
    pub fn area(&self, text: &str) -> Option<Area> {
        area(&self.map, text)
    }

    /// Accesses that touch an area, in the order of the program.
    pub fn touching(&self, area: &Area) -> Vec<&Access> {
        self.accesses.iter().filter(|access| overlap(&access.area, area)).collect()
    }

    /// Whether listing the accesses of every element is quick; otherwise ask for single ones.
    pub fn is_listable(&self) -> bool {
        let ranges = self.wide.len().saturating_mul(self.elements.len());
        ranges.saturating_add(self.blocks.saturating_mul(self.accesses.len())) <= BUDGET
    }

    /// Accesses of one of [`CrossReference::elements`], those of ranges and casts around it included
    /// where [`CrossReference::is_listable`].
    pub fn of_element(&self, element: &str) -> Vec<&Access> {
        let Some(area) = self.area(element) else { return Vec::new() };
        let listable = self.is_listable();
        if listable && is_indexed(element) {
            return self.touching(&area);
        }
        let mut indices = self.of_element.get(&area).cloned().unwrap_or_default();
        if listable {
            let touches = |index: &usize| self.accesses.get(*index).is_some_and(|access| overlap(&access.area, &area));
            indices.extend(self.wide.iter().copied().filter(touches));
        }
        indices.sort_unstable();
        indices.dedup();
        indices.into_iter().filter_map(|index| self.accesses.get(index)).collect()
    }
}

fn is_indexed(element: &str) -> bool {
    element.contains('[')
}

fn overlap(a: &Area, b: &Area) -> bool {
    match (a, b) {
        (Area::Bits(from, to), Area::Bits(first, end)) => from < end && first < to,
        (Area::Name(a), Area::Name(b)) => a == b || is_member(a, b) || is_member(b, a),
        _ => false,
    }
}

/// Whether one name is another with a member or cast behind it.
fn is_member(name: &str, of: &str) -> bool {
    name.strip_prefix(of).is_some_and(|rest| rest.starts_with(['.', ':']))
}

/// What a text stands for in a project.
fn area(map: &Map, text: &str) -> Option<Area> {
    let address = Address::parse_with(text, |block| map.radix(block)).ok()?;
    match map.resolve(&address) {
        Ok(Resolved::Place(place)) => Some(Area::Bits(place.bit, place.bit.saturating_add(bits(place.kind)))),
        Ok(Resolved::Structure(element, start)) => Some(Area::Bits(start, start.saturating_add(element.bits()))),
        Ok(Resolved::Constant(_)) => None,
        Ok(Resolved::Indexed { block, .. }) => {
            let block = map.blocks().get(block)?;
            Some(Area::Bits(block.start, block.start.saturating_add(block.count.saturating_mul(block.element.bits()))))
        }
        Err(_) => Some(Area::Name(text.to_ascii_uppercase())),
    }
}

fn bits(kind: Kind) -> u32 {
    match kind {
        Kind::Bit => 1,
        Kind::U8 | Kind::I8 => 8,
        Kind::U16 | Kind::I16 => 16,
        Kind::I32 | Kind::U32 | Kind::F32 => 32,
        Kind::Text(characters) => (u32::from(characters) + 2) * 8,
    }
}
