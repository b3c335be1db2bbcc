//! The instructions a migration converts: one row each, in the module of their family.

use ladder::Instruction;

use super::context::{Context, Convert};
use super::emit::Contact;
use super::{bits, compare, control, counters, files, interrupts, math, moves, sequencer, strings, timers};

/// One instruction.
#[derive(Clone, Copy)]
pub(super) struct Row {
    /// Mnemonic of the original.
    pub(super) mnemonic: &'static str,
    /// Appends its conversion to a rung.
    pub(super) convert: Convert,
    /// The single contact it is, where it is one without effects on operands that are plain. Such a
    /// contact can join parallel legs.
    pub(super) contact: Option<fn(&mut Context<'_>, &Instruction) -> Option<Contact>>,
}

/// An output, or a condition with effects.
pub(super) const fn row(mnemonic: &'static str, convert: Convert) -> Row {
    Row { mnemonic, convert, contact: None }
}

/// All rows by family.
const TABLES: &[&[Row]] = &[
    bits::TABLE,
    timers::TABLE,
    counters::TABLE,
    compare::TABLE,
    math::TABLE,
    moves::TABLE,
    files::TABLE,
    sequencer::TABLE,
    strings::TABLE,
    control::TABLE,
    interrupts::TABLE,
];

/// The row of a mnemonic.
pub(super) fn by_mnemonic(mnemonic: &str) -> Option<&'static Row> {
    TABLES.iter().flat_map(|rows| rows.iter()).find(|row| row.mnemonic == mnemonic)
}
