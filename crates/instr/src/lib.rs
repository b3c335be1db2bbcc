//! The SLC 500 and MicroLogix instruction set, one place per instruction.
//!
//! Every [`Instruction`] is one entry in one file under `set/`: mnemonic, the title RSLogix prints
//! in the box, operation codes with their evidence, operands with what each one does to data, the
//! processors that have it, and a short text. Readers, converters, renderers, cross reference and
//! help texts all read the same entry.
//!
//! ```
//! use instr::{Role, by_mnemonic, by_opcode};
//!
//! let ton = by_mnemonic("TON").ok_or("TON is in the set")?;
//! assert_eq!(ton.title, "Timer On Delay");
//! assert_eq!(ton.forms.len(), 3, "one form per time base");
//!
//! let (instruction, form) = by_opcode(0x1C).ok_or("0x1C is known")?;
//! assert_eq!(instruction.mnemonic, "MOV");
//! assert_eq!(form.operands[1].name, "Dest");
//! assert_eq!(form.operands[1].role, Role::Write);
//! assert_eq!(form.string_count(), 4, "each source text is stored with the value last displayed");
//! # Ok::<(), &str>(())
//! ```
//!
//! An operation code is a plain number here; what it looks like in a file is the business of `rss`.
//! A code that nobody has seen is `None`, never a guess.

// A panic in a reader loses what was read: input must end in a value or a located error.
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::unreachable))]

pub mod exec;
mod families;
mod model;
pub mod parameters;
pub mod reference;
mod row;
mod set;
pub mod structural;

pub use families::Families;
pub use model::{
    Category, Drawing, Evidence, Extent, Form, Instruction, Kind, Names, Operand, Position, Role, Stored, TextCount,
    TextLevel, Touch,
};
pub use set::{all, by_mnemonic, by_opcode};
