//! The Do-more dialect (AutomationDirect Do-more, BRX, DM-SIM): the text that Designer exports and
//! imports, the instructions, and running them.
//!
//! A project is read with [`text::read`] into [`program::Project`], which keeps everything of the file
//! in its order, and written with [`text::write()`]. [`instruction`] says what each instruction does to the
//! stack of booleans and to its operands, [`stack`] whether a rung balances.
//!
//! Like every dialect this crate opens no file and reads no clock.

// A panic in a reader loses what was read: input must end in a value or a located error.
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::unreachable))]

pub mod address;
pub mod choices;
pub mod circuit;
pub mod counter;
pub mod diagnostic;
pub mod documentation;
pub mod elements;
pub mod engine;
pub mod figures;
pub mod instruction;
pub mod math;
pub mod memory;
pub mod program;
pub mod stack;
pub mod text;
pub mod timer;
pub mod xref;

pub use diagnostic::{Diagnostic, Problem};
pub use program::{CodeBlock, CodeKind, Comment, Instruction, Part, Project, Rung};
