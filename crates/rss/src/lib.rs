//! RSLogix 500 project files: container, streams, archive objects, typed records.
//!
//! The crate reads every byte of an `.RSS` file and writes it back. It knows
//! bytes and records; what an instruction does, it does not know.
//!
//! From the outside in: [`container`] is the compound file, [`stream`] names
//! what is in it, [`envelope`] opens a stream's payload, [`archive`] reads and
//! writes the objects of a payload, and one module per stream describes its
//! records. [`Project`] holds a file together.

// A panic in a reader loses what was read: input must end in a value or a located error.
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::unreachable))]

pub mod archive;
pub mod channel;
pub mod code;
pub mod compiler;
pub mod container;
pub mod data;
pub mod database;
pub mod envelope;
pub mod error;
pub mod identify;
pub mod io;
pub mod monitors;
pub mod processor;
pub mod program;
pub mod project;
pub mod small;
pub mod stream;
pub mod summary;
pub mod tables;
pub mod text;
pub mod verify;

pub use archive::{Parsed, Record, parse, serialize};
pub use container::Container;
pub use error::{Deviation, Error, Foreign, Mode, Result, Space};
pub use identify::identify;
pub use project::{Missing, Project, Stream};
pub use stream::{ImageKind, StreamKind};
pub use text::Text;
