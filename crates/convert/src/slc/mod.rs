//! RSLogix 500's text forms: rungs as text, and whole `.SLC` project files.
//!
//! * [`rung`]: one rung between text and model.
//! * [`mod@file`]: an `.SLC` file as sections of typed lines, read and written; knows no instruction.
//! * [`project`]: sections to the program model and back, with a list of what such a file cannot hold.
//! * [`decode`] and [`encode`]: the bytes of such a file.
//!
//! What the notation does not define and this module adds to it is in `docs/format/slc-text.md`.

mod encoding;
pub mod file;
pub mod project;
pub mod rung;

pub use encoding::{decode, encode};
pub use project::FileError;
