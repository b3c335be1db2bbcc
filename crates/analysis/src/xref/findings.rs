//! What the cross reference shows to be missing: readers, writers, documentation, data.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use ladder::{Address, FileType, Value};

use crate::budget::Budget;
use crate::coverage::documented;
use crate::location::Location;

use super::collect::Named;
use super::{CrossReference, GroupKey, group_key, owns_element};

/// One address that something is missing for.
#[derive(Clone, Debug)]
pub struct Finding {
    /// What is missing.
    pub kind: FindingKind,
    /// The address as the program names it.
    pub address: Address,
    /// Why that is normal for this address; `None` when it deserves a look.
    pub expected: Option<Reason>,
    /// The accesses it rests on: the writers of what is never read, the readers of what is never
    /// written, else all that name the address.
    pub locations: Vec<Location>,
    /// Rungs beyond those in `locations`.
    pub left_out: usize,
    /// The value stored in the project.
    pub value: Option<Value>,
}

/// What is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FindingKind {
    /// The program writes it and nothing in the program reads it.
    WrittenNeverRead,
    /// The program reads it and nothing in the program writes it, not even perhaps.
    ReadNeverWritten,
    /// Neither symbol nor description, of its own or of its element.
    Undocumented,
    /// The access ends beyond the end of its data file.
    BeyondEnd,
    /// The project has no such data file.
    NoSuchFile,
    /// The I/O configuration has no such slot or word, or the module no such point.
    NoSuchPoint,
}

impl FindingKind {
    /// The finding in words.
    pub fn as_str(self) -> &'static str {
        match self {
            FindingKind::WrittenNeverRead => "written, never read",
            FindingKind::ReadNeverWritten => "read, never written",
            FindingKind::Undocumented => "used, undocumented",
            FindingKind::BeyondEnd => "beyond the end of its file",
            FindingKind::NoSuchFile => "no such data file",
            FindingKind::NoSuchPoint => "no such I/O point",
        }
    }
}

/// Why a finding is normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Reason {
    /// Inputs are written by the input scan.
    Input,
    /// Outputs are read by the output scan.
    Output,
    /// The processor reads and writes its status file.
    StatusFile,
    /// The controller reads and writes its function files.
    FunctionFile,
    /// A module reads and writes it.
    ModuleFile,
    /// The element belongs to the instruction that names it (control element, message, PID).
    OwnedByInstruction,
    /// A setting with a value in the data table: preset, length, PID or message setting.
    SetInDataTable,
    /// The rung was never verified; verifying it creates the element.
    NotVerified,
}

impl Reason {
    /// The reason in words.
    pub fn as_str(self) -> &'static str {
        match self {
            Reason::Input => "input, written by the input scan",
            Reason::Output => "output, read by the output scan",
            Reason::StatusFile => "status file",
            Reason::FunctionFile => "function file",
            Reason::ModuleFile => "module file",
            Reason::OwnedByInstruction => "belongs to its instruction",
            Reason::SetInDataTable => "set in the data table",
            Reason::NotVerified => "rung not verified yet",
        }
    }
}

/// What deserves a look in a program.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// By kind, then by address.
    pub list: Vec<Finding>,
    /// Addresses that were not judged by their readers and writers, because the program has so many
    /// accesses that overlap. 0 for any real program.
    pub not_judged: usize,
}

/// Sorted locations, each once, and how many more there are.
fn bounded(mut locations: Vec<Location>, budget: &mut Budget) -> (Vec<Location>, usize) {
    locations.sort_unstable();
    locations.dedup();
    let listed = budget.rows(locations.len());
    let more = locations.len() - listed;
    locations.truncate(listed);
    (locations, more)
}

impl CrossReference<'_> {
    /// All findings. Their locations are bounded as the accesses of [`CrossReference::all`] are.
    pub fn findings(&self) -> Findings {
        let mut budget = Budget::of_report();
        let mut found: Vec<(FindingKind, GroupKey, Finding)> = Vec::new();
        let mut not_judged = 0;
        for (named, users) in self.data.named.iter().zip(self.users()) {
            not_judged += usize::from(budget.is_spent());
            for finding in self.of_named(named, users, &mut budget) {
                found.push((finding.kind, group_key(&named.address, Some(named.area)), finding));
            }
        }
        found.extend(self.outside_the_data_table(&mut budget));
        found.sort_by(|a, b| (a.0, &a.1).cmp(&(b.0, &b.1)));
        Findings { list: found.into_iter().map(|(_, _, finding)| finding).collect(), not_judged }
    }

    /// For each named address the instructions that name it.
    fn users(&self) -> Vec<Vec<Location>> {
        let mut users = vec![Vec::new(); self.data.named.len()];
        for it in &self.data.uses {
            if let Some(users) = it.named.and_then(|named| users.get_mut(named)) {
                users.push(it.location);
            }
        }
        users
    }

    fn of_named(&self, named: &Named<'_>, users: Vec<Location>, budget: &mut Budget) -> Vec<Finding> {
        let area = crate::space::Area { bits: named.area.bits.max(named.reach), ..named.area };
        let (mut readers, mut writers) = (Vec::new(), Vec::new());
        let (mut read, mut written) = (false, false);
        if !budget.is_spent() {
            let compared = self.index.overlapping(&self.data.spans, &self.data.spaces, area, |span| {
                let Some(it) = self.use_of(span) else { return ControlFlow::Continue(()) };
                // A timer that reads its own ACC does not make the timer a used one.
                let names_it = self.named_area(it) == Some(named.area);
                if span.role.reads() && !(names_it && owns_element(it.kind)) {
                    read = true;
                    if span.definite {
                        readers.push(it.location);
                    }
                }
                if span.role.writes() {
                    written = true;
                    if span.definite {
                        writers.push(it.location);
                    }
                }
                // Both: neither is missing, and who else does it does not matter.
                if read && written { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            budget.spend(compared);
        }
        let mut found = Vec::new();
        let mut add = |kind, locations: Vec<Location>| {
            let (locations, left_out) = bounded(locations, budget);
            found.push(Finding {
                kind,
                address: (*named.address).clone(),
                expected: expected(kind, &named.address),
                locations,
                left_out,
                value: self.value(&named.address),
            });
        };
        if !writers.is_empty() && !read {
            add(FindingKind::WrittenNeverRead, writers);
        }
        if !readers.is_empty() && !written {
            add(FindingKind::ReadNeverWritten, readers);
        }
        if documented(self.documentation, &named.address) == (false, false) {
            add(FindingKind::Undocumented, users);
        }
        found
    }

    /// Accesses to data that the project does not have.
    fn outside_the_data_table(&self, budget: &mut Budget) -> Vec<(FindingKind, GroupKey, Finding)> {
        let io = &self.image.io;
        let io_known = io.unknown.is_none() && !io.slots.is_empty();
        let mut places: BTreeMap<(FindingKind, usize, u64), Place<'_>> = BTreeMap::new();
        for span in self.data.spans.iter().filter(|span| span.definite) {
            let (Some(it), Some(space)) = (self.use_of(span), self.data.spaces.get(span.area.space)) else { continue };
            let kind = match space.key.file_type {
                FileType::M0 | FileType::M1 => continue,
                FileType::O | FileType::I if !io_known => continue,
                FileType::O | FileType::I if space.key.slot.is_some() => FindingKind::NoSuchPoint,
                FileType::O | FileType::I if io.resolve(&it.address).is_some_and(|point| !point.in_range) => {
                    FindingKind::NoSuchPoint
                }
                // Flags that no operand names are not worth a missing file.
                _ if it.through == super::Through::Implied => continue,
                _ if !space.exists => FindingKind::NoSuchFile,
                _ if space.bits().is_some_and(|bits| span.area.end() > bits) => FindingKind::BeyondEnd,
                _ => continue,
            };
            let first = self.named_area(it).map_or(span.area.first, |area| area.first);
            let new = || Place { address: &it.address, locations: Vec::new(), verified: false };
            let place = places.entry((kind, span.area.space, first)).or_insert_with(new);
            place.locations.push(it.location);
            place.verified |= it.compiled;
        }
        let finding = |((kind, _, _), Place { address, locations, verified }): ((FindingKind, usize, u64), _)| {
            let (locations, left_out) = bounded(locations, budget);
            let address = Address { indexed: false, ..address.clone() };
            let key = group_key(&address, self.place(&address));
            let expected = (!verified).then_some(Reason::NotVerified);
            (kind, key, Finding { kind, address, expected, locations, left_out, value: None })
        };
        places.into_iter().map(finding).collect()
    }
}

/// Accesses to one place outside the data table.
struct Place<'x> {
    address: &'x Address,
    locations: Vec<Location>,
    /// Some instruction with it was verified.
    verified: bool,
}

fn expected(kind: FindingKind, address: &Address) -> Option<Reason> {
    use FileType as T;
    let member = address.member();
    Some(match (kind, address.file_type) {
        (_, T::S) => Reason::StatusFile,
        (_, T::M0 | T::M1) => Reason::ModuleFile,
        (_, t) if t.is_function_file() => Reason::FunctionFile,
        (FindingKind::ReadNeverWritten, T::I) => Reason::Input,
        (FindingKind::WrittenNeverRead, T::O) => Reason::Output,
        (FindingKind::WrittenNeverRead, T::R | T::MG | T::PD | T::RIX) => Reason::OwnedByInstruction,
        (FindingKind::ReadNeverWritten, T::MG | T::PD | T::RIX) => Reason::SetInDataTable,
        (FindingKind::ReadNeverWritten, T::T | T::C | T::R) if matches!(member, Some("PRE" | "LEN")) => {
            Reason::SetInDataTable
        }
        _ => return None,
    })
}
