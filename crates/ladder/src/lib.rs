//! The program model: what a maintenance engineer means by "the program".
//!
//! A [`Project`] holds up to three [`Image`]s (the offline program, the image last exchanged with
//! a processor, an automatic save). An image is the processor, its [`ProgramFile`]s made of
//! [`Rung`]s, its [`DataFile`]s, the I/O and channel configuration and the [`Documentation`].
//!
//! This crate knows no bytes of any file format, no clock and no instruction set: a mnemonic is a
//! name here, and operands are typed by their spelling alone. `convert` builds the model from files,
//! `instr` says what a mnemonic means.

// A panic in a reader loses what was read: input must end in a value or a located error.
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::unreachable))]

mod address;
mod channel;
mod constant;
mod data;
mod diagnostic;
mod documentation;
mod expression;
mod file_type;
mod io;
mod members;
mod operand;
mod processor;
mod project;
mod radix;
mod rung;

pub use address::{Address, AddressError, Place};
pub use channel::{Channel, Setting};
pub use constant::{Constant, Number, format_float};
pub use data::{ControlElement, CounterElement, DataFile, Force, TimeBase, TimerElement, Value};
pub use diagnostic::{Diagnostic, Severity};
pub use documentation::{AddressEntry, Comment, CommentOwner, Documentation, InstructionComment, Shown, Target};
pub use expression::{Expression, ExpressionError, Function, Operator};
pub use file_type::FileType;
pub use io::{IoConfiguration, IoRange, Module, Point, Slot};
pub use members::{Member, member_by_name, member_name, members_of};
pub use operand::Operand;
pub use processor::{Confidence, Family, Processor};
pub use project::{Image, Memory, ProgramFile, ProgramFileKind, Project, RevisionNote, Source};
pub use radix::Radix;
pub use rung::{Branch, Element, Instruction, MessageSetup, Mnemonic, Rung, Series};
