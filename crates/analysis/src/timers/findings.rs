//! What about a timer or counter deserves a look.

use ladder::Address;

use crate::location::Location;

use super::{ElementKind, InstructionValues, Reference, TimerCounter, Usage};

/// Something about an element that deserves a look.
#[derive(Clone, Debug)]
pub struct TimerFinding {
    /// The element.
    pub address: Address,
    /// What.
    pub kind: TimerFindingKind,
    /// The rungs it is about.
    pub locations: Vec<Location>,
}

/// What deserves a look.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TimerFindingKind {
    /// Several instructions time or count with it. CTU with CTD on one counter is not meant: that is
    /// an up/down counter.
    SeveralInstructions,
    /// Preset 0, and nothing writes it.
    PresetNeverSet,
    /// Preset or accumulated value below 0: a running timer stops the processor with fault 0034.
    Negative,
    /// A verified instruction shows another preset or time base than the data table holds.
    DiffersFromData,
    /// It shows another accumulated value: the data was read at another moment.
    AccumDiffers,
    /// The data table does not have the element.
    NoElement,
    /// Only read: it never starts.
    OnlyRead,
    /// RTO, CTU or CTD that nothing resets and whose ACC nothing writes.
    NeverReset,
    /// RES on a TOF: the manuals call the result unpredictable.
    ResetOfOffDelay,
    /// Timed or counted, and nothing looks at it.
    NeverRead,
    /// Preset in the data table, no use in the program.
    Unused,
}

impl TimerFindingKind {
    /// The finding in words.
    pub fn as_str(self) -> &'static str {
        match self {
            TimerFindingKind::SeveralInstructions => "used by several timer or counter instructions",
            TimerFindingKind::PresetNeverSet => "preset is 0 and nothing writes it",
            TimerFindingKind::Negative => "preset or accumulated value below 0",
            TimerFindingKind::DiffersFromData => "preset or base of instruction and data table differ",
            TimerFindingKind::AccumDiffers => "accumulated value of instruction and data table differ",
            TimerFindingKind::NoElement => "not in the data table",
            TimerFindingKind::OnlyRead => "only read, never timed or counted",
            TimerFindingKind::NeverReset => "never reset",
            TimerFindingKind::ResetOfOffDelay => "RES on a TOF",
            TimerFindingKind::NeverRead => "never read",
            TimerFindingKind::Unused => "has a preset, not used",
        }
    }
}

pub(super) fn findings(element: &TimerCounter) -> Vec<TimerFinding> {
    use TimerFindingKind as K;
    let mut found = Vec::new();
    let own: Vec<Location> = element.instructions.iter().map(|it| it.location).collect();
    let mut add = |kind, locations: &[Location]| {
        found.push(TimerFinding { address: element.address.clone(), kind, locations: locations.to_vec() });
    };
    let places = |all: &[Reference]| all.iter().map(|it| it.location).collect::<Vec<_>>();
    let touches = |all: &[Reference], member: &str| {
        all.iter().any(|it| it.role.writes() && (it.members.is_empty() || it.members.iter().any(|m| m == member)))
    };
    if own.len() > 1 && !is_up_down(element) {
        add(K::SeveralInstructions, &own);
    }
    match element.usage {
        Usage::ConfiguredOnly => add(K::Unused, &[]),
        Usage::ReferencedOnly if element.written_by.is_empty() && element.reset_by.is_empty() => {
            add(K::OnlyRead, &places(&element.read_by));
        }
        Usage::ReferencedOnly => {}
        Usage::Active => {
            if element.preset == Some(0) && !touches(&element.written_by, "PRE") {
                add(K::PresetNeverSet, &own);
            }
            let retentive = element.mnemonics().iter().any(|m| matches!(*m, "RTO" | "CTU" | "CTD"));
            if retentive && element.reset_by.is_empty() && !touches(&element.written_by, "ACC") {
                add(K::NeverReset, &own);
            }
            if element.mnemonics().contains(&"TOF") && !element.reset_by.is_empty() {
                add(K::ResetOfOffDelay, &places(&element.reset_by));
            }
            if element.read_by.is_empty() && !element.written_by.iter().any(|it| it.role.reads()) {
                add(K::NeverRead, &own);
            }
        }
    }
    if element.usage != Usage::ConfiguredOnly && element.data.is_none() {
        let mut all = own.clone();
        all.extend(places(&element.read_by));
        all.sort_unstable();
        all.dedup();
        add(K::NoElement, &all);
    }
    let negative = element.preset.is_some_and(|n| n < 0) || element.accum.is_some_and(|n| n < 0);
    if negative && element.kind == ElementKind::Timer {
        add(K::Negative, &own);
    }
    for (kind, differs) in [
        (K::DiffersFromData, InstructionValues::setting_differs as fn(&InstructionValues, &_) -> bool),
        (K::AccumDiffers, InstructionValues::accum_differs),
    ] {
        let Some(data) = element.data else { continue };
        let verified = element.instructions.iter().filter(|it| it.compiled);
        let all: Vec<Location> = verified.filter(|it| differs(it, &data)).map(|it| it.location).collect();
        if !all.is_empty() {
            add(kind, &all);
        }
    }
    found.sort_by_key(|finding| finding.kind);
    found
}

/// Counted up in one place and down in another.
fn is_up_down(element: &TimerCounter) -> bool {
    let count = |mnemonic| element.instructions.iter().filter(|it| it.mnemonic == mnemonic).count();
    count("CTU") == 1 && count("CTD") == 1 && element.instructions.len() == 2
}
