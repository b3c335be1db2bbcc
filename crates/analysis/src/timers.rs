//! Every timer and counter: parameters, seconds, live values, and the rungs that use it.
//!
//! Preset and accumulated value stand in two places. The element in the data table is what the
//! processor works with; the box shows a copy of it. Only in an instruction that was never verified
//! the box holds what was entered, and verifying it writes that into the element.

mod build;
mod findings;

use instr::Role;
use ladder::{Address, TimeBase};

use crate::location::Location;
use crate::xref::Certainty;

pub use findings::{TimerFinding, TimerFindingKind};

/// Timers and counters of an image.
#[derive(Clone, Debug, Default)]
pub struct TimerReport {
    /// Elements that are timed, counted, read, written or reset, or that have a preset; by address.
    pub elements: Vec<TimerCounter>,
    /// What deserves a look, by address.
    pub findings: Vec<TimerFinding>,
    /// Timer and counter instructions whose element is decided at run time or not known.
    pub elsewhere: Vec<InstructionValues>,
}

/// One timer or counter element.
#[derive(Clone, Debug)]
pub struct TimerCounter {
    /// `T4:0`, `C5:3`.
    pub address: Address,
    /// Timer or counter.
    pub kind: ElementKind,
    /// What the program does with it.
    pub usage: Usage,
    /// Symbol.
    pub symbol: Option<String>,
    /// Description lines.
    pub description: Vec<String>,
    /// The instructions that time or count with it, in program order.
    pub instructions: Vec<InstructionValues>,
    /// The element of the data table; `None` if the data file does not reach that far.
    pub data: Option<DataValues>,
    /// Time base in force; `None` for counters and where nothing tells.
    pub base: Option<TimeBase>,
    /// Preset in force, in ticks or counts: the data table's, or the instruction's as long as no
    /// instruction with the element was verified.
    pub preset: Option<i32>,
    /// Accumulated value in force, as `preset`.
    pub accum: Option<i32>,
    /// Reads, bits and members told apart.
    pub read_by: Vec<Reference>,
    /// Resets.
    pub reset_by: Vec<Reference>,
    /// Other writes: to a preset, a copy over the element.
    pub written_by: Vec<Reference>,
    /// References beyond those listed, see [`crate::MAX_LISTED`]; `None` where they were not even looked
    /// up. [`TimerReport::complete`] gives all of them.
    pub left_out: Option<LeftOut>,
}

/// How many references are not listed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LeftOut {
    /// Of [`TimerCounter::read_by`].
    pub read_by: usize,
    /// Of [`TimerCounter::reset_by`].
    pub reset_by: usize,
    /// Of [`TimerCounter::written_by`].
    pub written_by: usize,
}

impl TimerCounter {
    /// Preset in seconds as exact decimal text: 5000 ticks of 0.01 s are `50`.
    pub fn preset_seconds(&self) -> Option<String> {
        Some(self.base?.seconds_text(self.preset?))
    }

    /// Accumulated time in seconds.
    pub fn accum_seconds(&self) -> Option<String> {
        Some(self.base?.seconds_text(self.accum?))
    }

    /// Mnemonics of the instructions that time or count with it, each once.
    pub fn mnemonics(&self) -> Vec<&'static str> {
        let mut all: Vec<_> = self.instructions.iter().map(|it| it.mnemonic).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// Timer or counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ElementKind {
    /// In a T file.
    Timer,
    /// In a C file.
    Counter,
}

/// What a program does with an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Usage {
    /// An instruction times or counts with it.
    Active,
    /// Read, written or reset, never timed or counted.
    ReferencedOnly,
    /// Has a preset in the data table and nothing refers to it.
    ConfiguredOnly,
}

/// What a timer or counter instruction shows.
#[derive(Clone, Debug)]
pub struct InstructionValues {
    /// Where.
    pub location: Location,
    /// TON, TOF, RTO, CTU, CTD, HSC.
    pub mnemonic: &'static str,
    /// The element as written.
    pub address: String,
    /// Time base.
    pub base: Option<TimeBase>,
    /// Preset text as a number.
    pub preset: Option<i32>,
    /// Accum text as a number.
    pub accum: Option<i32>,
    /// Verified; `false`: its texts are the program, not the data table.
    pub compiled: bool,
}

impl InstructionValues {
    /// The box shows another preset or time base than the element.
    pub fn setting_differs(&self, data: &DataValues) -> bool {
        self.preset.is_some_and(|preset| preset != i32::from(data.preset))
            || (self.base.is_some() && data.base.is_some() && self.base != data.base)
    }

    /// The box shows another accumulated value than the element.
    pub fn accum_differs(&self, data: &DataValues) -> bool {
        self.accum.is_some_and(|accum| accum != i32::from(data.accum))
    }
}

/// An element of the data table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DataValues {
    /// The whole control word.
    pub control: u16,
    /// Time base of a timer's control word.
    pub base: Option<TimeBase>,
    /// Preset.
    pub preset: i16,
    /// Accumulated value.
    pub accum: i16,
}

impl DataValues {
    /// The state bits of the control word by name, in display order: EN TT DN or CU CD DN OV UN UA.
    pub fn bits(self, kind: ElementKind) -> impl Iterator<Item = (&'static str, bool)> {
        let names: &'static [&'static str] = match kind {
            ElementKind::Timer => &["EN", "TT", "DN"],
            ElementKind::Counter => &["CU", "CD", "DN", "OV", "UN", "UA"],
        };
        let control = self.control;
        names.iter().zip((0..16).rev()).map(move |(name, bit)| (*name, control >> bit & 1 != 0))
    }
}

/// A rung that refers to an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reference {
    /// Where.
    pub location: Location,
    /// Mnemonic.
    pub mnemonic: String,
    /// Operand name as in the box.
    pub operand: &'static str,
    /// The operand as written.
    pub written: String,
    /// Parts of the element it touches: `DN`, `PRE`, `ACC/3`; empty when it is the whole element.
    pub members: Vec<String>,
    /// Read, written or both.
    pub role: Role,
    /// Whether it happens.
    pub certainty: Certainty,
}

impl TimerReport {
    /// Elements that an instruction times or counts with.
    pub fn active(&self) -> impl Iterator<Item = &TimerCounter> {
        self.elements.iter().filter(|element| element.usage == Usage::Active)
    }
}
