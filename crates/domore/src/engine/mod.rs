//! Running Do-more programs: compiled once, then scan by scan in simulated time.
//!
//! [`Program::compile`] resolves every element and instruction; [`Machine`] runs the result. The engine
//! reads no file and no clock: time is an argument of [`Machine::scan`], inputs are written with
//! [`Machine::set`]. The same inputs give the same run on any machine.
//!
//! ```
//! use domore::engine::{Machine, Options, Program, Value};
//! use std::time::Duration;
//!
//! let text = "$PRGRM $Main\n\nSTR X0\nTMR T0 500\n\nSTR T0.Done\nOUT Y0\n\n$PGMEND $Main\n";
//! let project = domore::text::read(text)?.project;
//! let program = Program::compile(&project, &Options::default()).map_err(|refusals| format!("{refusals:?}"))?;
//! let mut machine = Machine::new(program);
//! machine.enter_run();
//! machine.set("X0", &Value::Bit(true))?;
//! machine.scan(Duration::ZERO);
//! machine.scan(Duration::from_millis(500));
//! assert_eq!(machine.get("T0.Acc")?, Value::Integer(500));
//! assert_eq!(machine.get("Y0")?, Value::Bit(true));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Nothing is left out silently: what has no faithful execution is refused with its rung ([`Refusal`]),
//! or runs in an approximation that [`Program::approximations`] names.

mod boxes;
mod clock;
mod compile;
mod controller;
mod machine;
mod op;
mod operand;
mod outputs;
mod run;
mod snapshot;
mod state;
mod watch;

use std::fmt;
use std::sync::Arc;

use crate::choices::Choices;
use crate::memory::Map;
use crate::program::Project;

pub use machine::{Handle, Machine, ScanReport, Value};
pub use snapshot::RestoreError;
pub use watch::{NoWatch, Watch};

/// What a caller decides before a program runs.
#[derive(Clone, Debug)]
pub struct Options {
    /// Switchable readings where documentation ends.
    pub choices: Choices,
    /// Instructions one scan may execute before the machine stops with [`Fault::Watchdog`].
    pub watchdog: u64,
    /// What happens to an instruction that cannot be executed.
    pub unsupported: Unsupported,
}

impl Default for Options {
    fn default() -> Self {
        Options { choices: Choices::default(), watchdog: 1_000_000, unsupported: Unsupported::Refuse }
    }
}

/// What happens to an instruction that cannot be executed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unsupported {
    /// The program is refused, every such instruction named.
    #[default]
    Refuse,
    /// The program loads; a coil or box that is not modelled stops the machine where it has power. Each
    /// is listed as an approximation. Contacts that are not modelled are refused all the same.
    Stop,
}

/// What the controller does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Nothing is executed.
    #[default]
    Program,
    /// Programs are executed.
    Run,
}

/// Why a machine stopped by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A scan executed more instructions than [`Options::watchdog`].
    Watchdog,
    /// Subroutines call each other too deeply.
    CallDepth,
    /// An instruction that is not modelled had power.
    Unsupported {
        /// What [`Program::site`] takes.
        operation: u32,
    },
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Fault::Watchdog => "watchdog: the scan executes too many instructions",
            Fault::CallDepth => "subroutines call each other too deeply",
            Fault::Unsupported { .. } => "an instruction that is not modelled had power",
        })
    }
}

/// Where an instruction stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Site {
    /// The code block.
    pub block: String,
    /// The rung, from 1 as Designer counts.
    pub rung: usize,
    /// The instruction in the rung, from 0.
    pub instruction: usize,
    /// The instruction as text; empty where only the place is known.
    pub text: String,
}

impl fmt::Display for Site {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} rung {}: {}", self.block, self.rung, self.text)
    }
}

/// Why a program, or an instruction of it, cannot run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// The instruction; `None` when it is the program as a whole.
    pub site: Option<Site>,
    /// Why, in words.
    pub why: String,
}

/// An instruction that may not behave as on the controller in every respect.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Approximation {
    /// The instruction; `None` when it concerns a code block or the whole.
    pub site: Option<Site>,
    /// What differs or is not known. Equal words for equal reasons, so that reports can count them.
    pub why: String,
}

fn placed(f: &mut fmt::Formatter<'_>, site: Option<&Site>, why: &str) -> fmt::Result {
    match site {
        Some(site) => write!(f, "{site}: {why}"),
        None => f.write_str(why),
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        placed(f, self.site.as_ref(), &self.why)
    }
}

impl fmt::Display for Approximation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        placed(f, self.site.as_ref(), &self.why)
    }
}

impl std::error::Error for Refusal {}

/// A program ready to run. Cheap to clone; machines made from clones share it.
#[derive(Clone, Debug)]
pub struct Program {
    compiled: Arc<op::Compiled>,
    approximations: Arc<Vec<Approximation>>,
}

impl Program {
    /// Compiles all code blocks of a project.
    ///
    /// # Errors
    /// Every instruction that cannot be executed, in the order of the text.
    pub fn compile(project: &Project, options: &Options) -> Result<Program, Vec<Refusal>> {
        let (compiled, approximations) = compile::compile(project, options)?;
        Ok(Program { compiled: Arc::new(compiled), approximations: Arc::new(approximations) })
    }

    /// What runs only approximately, in the order of the text.
    pub fn approximations(&self) -> &[Approximation] {
        &self.approximations
    }

    /// The memory it works on.
    pub fn memory(&self) -> &Map {
        &self.compiled.map
    }

    /// How many operations it has: [`Watch`] is told numbers below this.
    pub fn operations(&self) -> u32 {
        self.compiled.ops.len() as u32
    }

    /// Where an operation stands, as index of the code block, rung from 0 and instruction from 0.
    pub fn spot(&self, operation: u32) -> Option<(usize, usize, usize)> {
        let spot = self.compiled.spots.get(operation as usize)?;
        Some((spot.block as usize, spot.rung as usize, spot.instruction as usize))
    }

    /// Where an operation stands; the text of the instruction is left empty.
    pub fn site(&self, operation: u32) -> Option<Site> {
        let (block, rung, instruction) = self.spot(operation)?;
        let name = self.compiled.blocks.get(block)?.name.clone();
        Some(Site { block: name, rung: rung + 1, instruction, text: String::new() })
    }

    /// Code blocks with their number of rungs.
    pub fn blocks(&self) -> impl Iterator<Item = (&str, u32)> {
        self.compiled.blocks.iter().map(|block| (block.name.as_str(), block.rungs))
    }
}

#[cfg(test)]
mod tests;
