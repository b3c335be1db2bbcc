//! Rung text, RSLogix 500's own notation: `XIC B3:0/0 BST OTE B3:0/1 NXB TON T4:0 0.01 100 0 BND`.
//!
//! The notation has no marks between operands, so reading it needs the instruction table; errors
//! name the place, the operand that is missing and the mnemonic that was probably meant. Text
//! settles after one step: `rung_text(parse_rung(text))` reads back as the same rung and is then
//! written the same way.

mod error;
mod operand;
mod parse;
mod token;
mod write;

pub use error::TextError;
pub use parse::{MAX_BRANCH_DEPTH, parse_rung, parse_rung_at, parse_rungs};
pub use write::{UNREAD, instruction_text, not_in_text, rung_text, rung_text_for, unread_rung, unread_text};
