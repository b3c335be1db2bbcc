//! What instructions compute: their rules on plain values, beside their definitions.
//!
//! Every function here takes values and returns values. Addresses, memory, the order of execution
//! and the clock belong to the caller; so does storing what a function returns. The functions are
//! what the instruction reference, a scan engine and a plain tree walker share, and they can be
//! tested with two numbers.
//!
//! Families differ ([`Lineage`]) and documentation ends in places ([`choices`]); both travel in
//! [`Rules`]. The evidence of each rule stands in its documentation, in these words:
//!
//! * *printed*: a page of a Rockwell manual that was read says so;
//! * *manual, unseen*: what those manuals are remembered to say, the page not at hand;
//! * *community*: forums, courses, other simulators;
//! * *inferred*: follows from the others;
//! * *open*: nobody says; the function takes a documented default, most with a [`choices::Choice`].
//!
//! ```
//! use instr::exec::{Lineage, Number, Rules, Width, math};
//! use ladder::Family;
//!
//! let rules = Rules::of(Family::MicroLogix1000);
//! assert_eq!(rules.lineage, Lineage::M10);
//! let quotient = math::div(Number::Word(11), Number::Word(2), Width::Word, rules.math(0));
//! assert_eq!(quotient.value, Some(Number::Word(6)));
//! assert_eq!(quotient.register.map(|r| (r.high, r.low)), Some((5, 1)));
//! ```
//!
//! No function panics, whatever the values, lengths and positions are.

pub mod bit;
pub mod choices;
pub mod clock;
pub mod compare;
pub mod control;
pub mod conversion;
pub mod counter;
pub mod coverage;
pub mod diagnostic;
pub mod expression;
pub mod file;
mod flags;
pub mod function;
pub mod logic;
pub mod math;
mod number;
pub mod process;
mod rules;
pub mod scale;
pub mod sequencer;
pub mod shift;
pub mod stack;
pub mod text;
pub mod timer;

pub use flags::Flags;
pub use number::{Number, Outcome, Register, Width};
pub use rules::{Lineage, MathMode, Rules};

/// What an instruction with a control element leaves behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Done {
    /// The control element afterwards.
    pub control: control::Control,
    /// S:5/2, control register error, is to be set; it becomes major error 0020 at the end of the scan.
    pub control_error: bool,
}

/// A length or position reaches beyond the file it applies to. Nothing has been changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BeyondFile;
