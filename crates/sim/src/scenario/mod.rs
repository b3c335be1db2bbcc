//! Scenarios: programs with steps and expectations, written as TOML.
//!
//! A [`Scenario`] is read from text with [`Scenario::parse`] and carried out by [`run()`]. Neither
//! reads a file: where the program comes from is the business of a [`Loader`].
//!
//! ```toml
//! name   = "lamp flashes"
//! ladder = "XIC B3:0/0 TON T4:0 0.01 100 0"
//! family = "slc-5/03"
//! scan   = "10ms"
//! [[step]]
//! note   = "press start"
//! set    = { "B3:0/0" = 1 }
//! scans  = 1
//! expect = { "T4:0/EN" = 1, "T4:0.ACC" = 0 }
//! ```
//!
//! A step can have a `scan` of its own. The order inside a step is `mode`, `set`, `edges`, then `scans` or `run`, then `fault` and `expect`.
//! A step without `edges`, `scans` and `run` scans nothing. What the first step sets is there when the
//! processor enters run, and is written once more behind the prescan: it is the state the test starts from.
//! So is what a later step with `mode` sets; its timers alone stay as the change of mode leaves them.

mod controller;
mod duration;
mod literal;
mod parse;
mod run;
pub mod spell;

use std::fmt;
use std::time::Duration;

use ladder::Family;

pub use controller::{Controller, Stop};
pub use duration::parse_duration;
pub(crate) use literal::text;
pub use literal::{Literal, Mismatch, matches, value_for};
pub use run::{Failure, Foreign, Found, Loader, Report, RunError, play, run};

/// A program, steps, expectations.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// What it shows; empty when the text names nothing.
    pub name: String,
    /// The evidence expectations rest on: manual pages, rules.
    pub source: Vec<String>,
    /// Remarks.
    pub note: Option<String>,
    /// What runs.
    pub program: Subject,
    /// What it runs on; `None`: the program's own processor.
    pub target: Option<Target>,
    /// Simulated time from one scan to the next.
    pub scan: Duration,
    /// The steps in order.
    pub steps: Vec<Step>,
}

/// The program of a scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A file, as the scenario spells its path (relative to the scenario's own folder, else to the current one).
    File(Spot<String>),
    /// Ladder in the scenario itself.
    Inline(Vec<Routine>),
}

/// One program file of an inline ladder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Routine {
    /// Its number, or for Do-more the head of its code block; a bare string is program file 2.
    pub name: Spot<String>,
    /// Rungs as text, one per line.
    pub text: String,
    /// Line of the scenario the text begins in, from 1.
    pub line: u32,
}

/// What a scenario runs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// A member of the SLC 500 or MicroLogix families.
    Slc(Family),
    /// Do-more and BRX.
    DoMore,
}

/// A step.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Line of the scenario it begins in, from 1.
    pub line: u32,
    /// Remark, shown when the step fails.
    pub note: Option<String>,
    /// Leave run and enter it again before everything else.
    pub program_run: bool,
    /// Simulated time from one scan to the next in this step, where it is not the scenario's.
    pub scan: Option<Duration>,
    /// Values written before scanning, in the order written.
    pub set: Vec<Assignment>,
    /// Pairs of a scan with the bit 0 and a scan with the bit 1.
    pub edges: Option<Edges>,
    /// How long to scan after that.
    pub length: Length,
    /// The major fault code expected at the end; 0 expects none.
    pub fault: Option<Spot<u16>>,
    /// Values expected at the end, in the order written.
    pub expect: Vec<Assignment>,
}

/// How long a step scans.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Length {
    /// Not at all.
    #[default]
    None,
    /// This many scans.
    Scans(u64),
    /// Until this much simulated time has passed.
    For(Duration),
}

/// False-to-true changes of a bit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edges {
    /// The bit.
    pub bit: Spot<String>,
    /// How many changes.
    pub count: u64,
}

/// An address with a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Assignment {
    /// The address as written.
    pub address: Spot<String>,
    /// The value as written.
    pub value: Literal,
}

/// Something with its line in the scenario, from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spot<T> {
    /// The thing.
    pub value: T,
    /// Its line.
    pub line: u32,
}

/// Why a text is no scenario, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScenarioError {
    /// Line, from 1.
    pub line: u32,
    /// The key it concerns, as a path: `step[2].set."N7:0"`; empty where TOML itself is broken.
    pub key: String,
    /// What is wrong and what belongs there.
    pub message: String,
}

impl fmt::Display for ScenarioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: ", self.line)?;
        if !self.key.is_empty() {
            write!(f, "{}: ", self.key)?;
        }
        f.write_str(&self.message)
    }
}

impl std::error::Error for ScenarioError {}
