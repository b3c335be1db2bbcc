//! A compiled program: operations, where they came from, data as loaded.

use ladder::Family;

use super::{BitAt, Block, Op, Reference};
use crate::family::Traits;
use crate::layout::Layout;
use crate::{Choices, Options};

/// A ladder file in the list.
#[derive(Clone, Debug)]
pub(crate) struct CodeFile {
    pub(crate) number: u16,
    pub(crate) rungs: u16,
}

/// Which instruction an operation belongs to; structural operations have instruction [`NO_INSTRUCTION`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct OpSite {
    pub(crate) file: u16,
    pub(crate) rung: u16,
    pub(crate) instruction: u16,
}

pub(crate) const NO_INSTRUCTION: u16 = u16::MAX;

/// What going to run does to a bit before the first scan.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prescan {
    pub(crate) bit: BitAt,
    pub(crate) set: bool,
}

/// Everything about a program that does not change while it runs.
#[derive(Debug)]
pub(crate) struct Compiled {
    pub(crate) family: Family,
    pub(crate) traits: Traits,
    pub(crate) choices: Choices,
    pub(crate) rules: instr::exec::Rules,
    pub(crate) watchdog: u64,
    pub(crate) ops: Vec<Op>,
    pub(crate) sites: Vec<OpSite>,
    /// Instructions among the operations before each position: differences count what was executed.
    pub(crate) before: Vec<u32>,
    pub(crate) blocks: Vec<Block>,
    pub(crate) references: Vec<Reference>,
    pub(crate) files: Vec<CodeFile>,
    /// Start of each ladder file by number.
    pub(crate) entries: Vec<Option<u32>>,
    pub(crate) layout: Layout,
    /// Data as the image holds it, with parameters of inline rungs applied.
    pub(crate) data: Vec<u16>,
    /// Words of files I and O in `data`: first and count.
    pub(crate) inputs: (usize, usize),
    pub(crate) outputs: (usize, usize),
    /// Forces of the image: `(on, off)` per word of I, then of O.
    pub(crate) input_forces: Vec<(u16, u16)>,
    pub(crate) output_forces: Vec<(u16, u16)>,
    /// First timer slot of each timer file, by file index.
    pub(crate) timer_slots: Vec<(usize, u32)>,
    pub(crate) timers: usize,
    pub(crate) pids: usize,
    pub(crate) adjusts: usize,
    pub(crate) messages: usize,
    pub(crate) prescan: Vec<Prescan>,
    /// Storage bits of one-shots, for [`Choice::OneShotSetByPrescan`](crate::choices::Choice).
    pub(crate) one_shots: Vec<BitAt>,
    /// A fault that prevents entering run: missing or duplicate label, no file 2.
    pub(crate) going_to_run: Option<(u16, OpSite)>,
    /// Identifies program and layout in saved states.
    pub(crate) identity: u64,
}

impl Compiled {
    /// Some instruction copies files before it works.
    pub(crate) fn needs_scratch(&self) -> bool {
        self.blocks.iter().any(|block| matches!(block, Block::FileBits { .. }))
    }

    pub(crate) fn instructions(&self) -> usize {
        self.before.last().map_or(0, |count| *count as usize)
    }

    pub(crate) fn entry(&self, file: u16) -> Option<u32> {
        self.entries.get(usize::from(file)).copied().flatten()
    }

    /// Slot of the timer whose control word is at `word`.
    pub(crate) fn timer_slot(&self, word: u32) -> Option<u32> {
        self.timer_slots.iter().find_map(|(file, first)| {
            let info = self.layout.files.get(*file)?;
            info.contains(word).then(|| first + (word - info.start) / info.size)
        })
    }
}

/// The simulated family of an image under these options.
pub(crate) fn family_of(image: &ladder::Image, options: &Options) -> Family {
    options.family.unwrap_or(image.processor.family)
}
