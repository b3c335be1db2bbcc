//! The text form: what Designer exports and imports.
//!
//! Reading keeps everything: [`write()`] of what [`read()`] gave is the same text, character by character. The
//! one exception is a file that mixes both kinds of line end, which is written with those of its first line.

mod read;
mod rows;
mod words;
mod write;

pub use read::{Error, MAX_LINES, MAX_TEXT, Reading, is_domore, read};
pub use words::{quote, unquote};
pub use write::write;
