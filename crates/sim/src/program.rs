//! A compiled program and what was said about it while compiling.

use std::fmt;
use std::sync::Arc;

use ladder::{Family, Image};

use crate::Options;
use crate::compile;
use crate::op::Compiled;

/// Where an instruction stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Site {
    /// Program file.
    pub file: u16,
    /// Rung, from 0.
    pub rung: u16,
    /// Instruction in the rung, from 0, in stored order.
    pub instruction: u16,
    /// The instruction as text: `MSG MG9:0`.
    pub text: String,
}

impl fmt::Display for Site {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "file {} rung {}: {}", self.file, self.rung, self.text)
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

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.site {
            Some(site) => write!(f, "{site}: {}", self.why),
            None => f.write_str(&self.why),
        }
    }
}

impl std::error::Error for Refusal {}

/// An instruction that does not behave in every respect as on the processor, or whose behaviour no
/// document settles.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Approximation {
    /// The instruction; `None` when it concerns the program as a whole.
    pub site: Option<Site>,
    /// What differs, in words. Equal words for equal reasons, so that reports can count them.
    pub why: String,
}

impl fmt::Display for Approximation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.site {
            Some(site) => write!(f, "{site}: {}", self.why),
            None => f.write_str(&self.why),
        }
    }
}

/// A program ready to run. Cheap to clone; machines made from clones share it.
#[derive(Clone, Debug)]
pub struct Program {
    pub(crate) compiled: Arc<Compiled>,
    approximations: Arc<Vec<Approximation>>,
}

impl Program {
    /// Compiles the ladder of an image: checks every instruction and address, resolves the
    /// addresses, lays the data files out in one block.
    ///
    /// # Errors
    /// Every instruction that cannot be executed, in program order.
    pub fn compile(image: &Image, options: &Options) -> Result<Program, Vec<Refusal>> {
        let (compiled, approximations) = compile::compile(image, options)?;
        Ok(Program { compiled: Arc::new(compiled), approximations: Arc::new(approximations) })
    }

    /// What runs only approximately, in program order.
    pub fn approximations(&self) -> &[Approximation] {
        &self.approximations
    }

    /// The family that is simulated.
    pub fn family(&self) -> Family {
        self.compiled.family
    }

    /// Ladder files by number with their count of rungs, END included.
    pub fn files(&self) -> impl Iterator<Item = (u16, u16)> {
        self.compiled.files.iter().map(|file| (file.number, file.rungs))
    }

    /// Instructions in all files, END included.
    pub fn instructions(&self) -> usize {
        self.compiled.instructions()
    }

    /// Words of data the program works on.
    pub fn data_words(&self) -> usize {
        self.compiled.layout.words()
    }
}
