//! Between project files, the program model, SLC text, Do-more text, JSON and CSV.
//!
//! [`open()`] reads a project of any form. The joints between byte records and the model are here
//! and nowhere else: `rss` knows no instruction, `ladder` no byte.

// A panic in a reader loses what was read: input must end in a value or a located error.
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::unreachable))]

pub mod code;
mod codes;
pub mod csv;
pub mod designer;
pub mod from_rss;
pub mod json;
mod limits;
mod message;
pub mod migrate;
mod open;
pub mod slc;
pub mod tables;
pub mod to_rss;
pub mod verify;

pub use limits::{MAX_DATA_WORDS, MAX_PARTS};
pub use open::{AnyProject, MAX_JSON, MAX_SLC_TEXT, OpenError, open, open_any};
