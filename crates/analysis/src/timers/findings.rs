//! What about a timer or counter deserves a look.

use ladder::Address;

use crate::location::Location;

use super::build::References;
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
    /// Places beyond those in `locations`.
    pub left_out: usize,
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

/// Findings of an element. Without its references, which were too many to look up, nothing is said of
/// who reads or writes it.
pub(super) fn findings(element: &TimerCounter, uses: Option<&References>) -> Vec<TimerFinding> {
    use TimerFindingKind as K;
    let mut found = Vec::new();
    let own: Vec<Location> = element.instructions.iter().map(|it| it.location).collect();
    let mut add_some = |kind, locations: &[Location], left_out| {
        found.push(TimerFinding { address: element.address.clone(), kind, locations: locations.to_vec(), left_out });
    };
    let mut add = |kind, locations: &[Location]| add_some(kind, locations, 0);
    let places = |all: &[Reference]| all.iter().map(|it| it.location).collect::<Vec<_>>();
    if own.len() > 1 && !is_up_down(element) {
        add(K::SeveralInstructions, &own);
    }
    match (element.usage, uses) {
        (Usage::ConfiguredOnly, Some(_)) => add(K::Unused, &[]),
        (Usage::Active, Some(uses)) => {
            if element.preset == Some(0) && !uses.writes_preset {
                add(K::PresetNeverSet, &own);
            }
            let retentive = element.mnemonics().iter().any(|m| matches!(*m, "RTO" | "CTU" | "CTD"));
            if retentive && !uses.is_reset() && !uses.writes_accum {
                add(K::NeverReset, &own);
            }
            if !uses.is_read() && !uses.writes_what_it_reads {
                add(K::NeverRead, &own);
            }
        }
        _ => {}
    }
    match (element.usage, uses) {
        (Usage::ReferencedOnly, Some(uses)) if !uses.is_written() && !uses.is_reset() => {
            add_some(K::OnlyRead, &places(&uses.read_by), uses.left_out.read_by);
        }
        (Usage::Active, Some(uses)) if element.mnemonics().contains(&"TOF") && uses.is_reset() => {
            add_some(K::ResetOfOffDelay, &places(&uses.reset_by), uses.left_out.reset_by);
        }
        _ => {}
    }
    if element.usage != Usage::ConfiguredOnly && element.data.is_none() {
        let mut all = own.clone();
        all.extend(uses.map(|uses| places(&uses.read_by)).unwrap_or_default());
        all.sort_unstable();
        all.dedup();
        add_some(K::NoElement, &all, uses.map_or(0, |uses| uses.left_out.read_by));
    }
    let mut add = |kind, locations: &[Location]| add_some(kind, locations, 0);
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
