//! What a program does with its data: cross reference, timers and counters, calls, documentation.
//!
//! Everything here is computed from a [`ladder::Image`] and the instruction table of `instr`; nothing
//! reads a file or a clock. Statements are about the program alone: an operator terminal, another
//! controller or a programming terminal can read and write the data table too, and none of that
//! stands in a project.
//!
//! * [`CrossReference`]: who reads and who writes an address, whatever way it is reached.
//! * [`TimerReport`]: every timer and counter with its parameters, its seconds and its rungs.
//! * [`CallGraph`]: which program file runs because of which rung or interrupt.
//! * [`Coverage`]: how much of the program is documented.
//! * [`diff`]: what differs between two programs.
//! * [`history`]: saves of one machine in order, and what changed from each to the next.
//! * [`merge`]: two programs that were made of one, put together again.
//! * [`checks`]: what an experienced engineer would question, with codes.
//! * [`proof`]: two programs side by side, scan by scan, with the same inputs.
//! * [`search`]: addresses, instructions with wildcards, texts, regular expressions.

// A panic in a reader loses what was read: input must end in a value or a located error.
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::unreachable))]

mod budget;
mod calls;
pub mod checks;
mod coverage;
pub mod csv;
pub mod diff;
pub mod history;
mod location;
pub mod merge;
pub mod proof;
pub mod search;
mod space;
mod timers;
mod xref;

pub use budget::{MAX_LISTED, MAX_ROWS};
pub use calls::{Call, CallGraph, CalledFile, Entry, EntryKind, Label, Target};
pub use coverage::Coverage;
pub use location::{Location, instructions};
pub use timers::{
    DataValues, ElementKind, InstructionValues, LeftOut, Reference, TimerCounter, TimerFinding, TimerFindingKind,
    TimerReport, Usage,
};
pub use xref::{
    Access, Certainty, CrossReference, Finding, FindingKind, Findings, Found, Group, Level, Note, Reason, Through,
    Unresolved, UnresolvedKind,
};
