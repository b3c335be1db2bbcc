//! Places of instructions in a program.

use std::fmt;

use ladder::{Image, Instruction};

/// Where an instruction stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Location {
    /// Program file number.
    pub file: u16,
    /// Rung number, from 0.
    pub rung: u32,
    /// Number of the instruction in its rung in stored order, from 0; branch marks do not count.
    pub instruction: u32,
}

impl fmt::Display for Location {
    /// File and rung the way RSLogix pairs them: `2:14`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.file, self.rung)
    }
}

/// Every instruction of the ladder files with its place, in program order. END rungs included.
pub fn instructions(image: &Image) -> impl Iterator<Item = (Location, &Instruction)> {
    image.ladder_files().flat_map(|file| {
        (0..).zip(&file.rungs).flat_map(move |(rung, content)| {
            (0..)
                .zip(content.instructions())
                .map(move |(instruction, it)| (Location { file: file.number, rung, instruction }, it))
        })
    })
}
