//! What a caller decides about a simulation before it starts.

use ladder::{Address, Family, Image, Processor, ProgramFile, ProgramFileKind, Rung};

use crate::Choices;

/// Settings of a simulation.
#[derive(Clone, Debug)]
pub struct Options {
    /// The processor to simulate; `None`: the one of the image.
    pub family: Option<Family>,
    /// Instructions one scan may execute before the watchdog fault 0022, interrupt routines included.
    /// The engine takes no wall-clock time into account, so S:3 high byte does not matter.
    pub watchdog: u64,
    /// Switchable readings where documentation ends.
    pub choices: Choices,
    /// The image is an inline ladder: data files come into being as large as the program and
    /// [`addresses`](Options::addresses) need, and parameters written in the rungs (PRE, ACC, LEN,
    /// POS) set the elements.
    pub inline: bool,
    /// Further addresses that must exist in an inline ladder.
    pub addresses: Vec<Address>,
    /// What happens to an instruction that cannot be executed.
    pub unsupported: Unsupported,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            family: None,
            watchdog: 1_000_000,
            choices: Choices::default(),
            inline: false,
            addresses: Vec::new(),
            unsupported: Unsupported::Refuse,
        }
    }
}

/// What happens to an instruction that cannot be executed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unsupported {
    /// The program is refused, every such instruction named.
    #[default]
    Refuse,
    /// The program loads; executing such an instruction with a true rung is major fault 0031
    /// (unsupported instruction), as condition it is false. Each is listed as an approximation.
    Fault,
}

/// An image of nothing but rungs: program files by number, END rungs added where they are missing.
/// Data files are made by [`Options::inline`].
pub fn inline_image(family: Family, files: Vec<(u16, Vec<Rung>)>) -> Image {
    let mut program_files: Vec<ProgramFile> = files
        .into_iter()
        .map(|(number, rungs)| ProgramFile {
            number,
            name: String::new(),
            description: String::new(),
            kind: ProgramFileKind::Ladder,
            rungs,
        })
        .collect();
    program_files.sort_by_key(|file| file.number);
    Image { processor: Processor { family, ..Processor::default() }, program_files, ..Image::default() }
}
