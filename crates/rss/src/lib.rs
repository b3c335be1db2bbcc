//! RSLogix 500 project files: container, streams, archive objects, typed records.
//!
//! The crate reads every byte of an `.RSS` file and writes it back. It knows
//! bytes and records; what an instruction does, it does not know.

pub mod archive;
pub mod error;
pub mod text;

pub use archive::{Parsed, Record, parse, serialize};
pub use error::{Deviation, Error, Foreign, Mode, Result, Space};
pub use text::Text;
