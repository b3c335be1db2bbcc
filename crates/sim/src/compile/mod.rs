//! From the program model to the flat list.

mod data;
mod device;
mod instruction;
mod lacks;
mod operand;
mod tables;

use std::collections::BTreeMap;

use ladder::{Element, FileType, Image, Instruction, ProgramFile, Series};

use crate::family::Traits;
use crate::fault::code;
use crate::layout::Layout;
use crate::op::*;
use crate::program::{Approximation, Refusal, Site};
use crate::{Options, Unsupported, outside};

/// Branches nest at most this deep in the engine; the editors allow four levels.
const MAX_NESTING: u32 = 60;

/// Program memory of the largest processor is far below this; a bound against hostile images.
const MAX_OPS: usize = 4_000_000;

/// Compiles an image.
pub(crate) fn compile(image: &Image, options: &Options) -> Result<(Compiled, Vec<Approximation>), Vec<Refusal>> {
    if let Some((image, named)) = outside::resolve(image) {
        let (compiled, mut approximations) = compile(&image, options)?;
        approximations.extend(named.into_iter().map(|why| Approximation { site: None, why }));
        return Ok((compiled, approximations));
    }
    let family = family_of(image, options);
    let traits = Traits::of(family);
    let tables = tables::tables(image, options, family);
    let references: Vec<_> = tables.files.iter().collect();
    let (layout, data, unplaced) = Layout::new(&references, &image.io, &tables.wanted);
    let mut compiler = Compiler {
        image,
        options,
        traits,
        layout,
        ops: Vec::new(),
        sites: Vec::new(),
        blocks: Vec::new(),
        references: Vec::new(),
        prescan: Vec::new(),
        one_shots: Vec::new(),
        timer_slots: Vec::new(),
        timers: 0,
        pids: 0,
        adjusts: 0,
        messages: 0,
        refusals: Vec::new(),
        approximations: tables.approximations,
        here: OpSite { file: 0, rung: 0, instruction: NO_INSTRUCTION },
        labels: BTreeMap::new(),
        jumps: Vec::new(),
        going_to_run: None,
    };
    compiler.notes(&unplaced);
    compiler.timer_slots();
    compiler.finish(family, data)
}

struct Compiler<'a> {
    image: &'a Image,
    options: &'a Options,
    traits: Traits,
    layout: Layout,
    ops: Vec<Op>,
    sites: Vec<OpSite>,
    blocks: Vec<Block>,
    references: Vec<Reference>,
    prescan: Vec<Prescan>,
    one_shots: Vec<BitAt>,
    timer_slots: Vec<(usize, u32)>,
    timers: u32,
    pids: u32,
    adjusts: u32,
    messages: u32,
    refusals: Vec<Refusal>,
    approximations: Vec<Approximation>,
    here: OpSite,
    /// Position of the rung of each label of the file being compiled.
    labels: BTreeMap<u16, u32>,
    /// Jumps of the file being compiled: operation and label.
    jumps: Vec<(usize, u16, OpSite)>,
    going_to_run: Option<(u16, OpSite)>,
}

impl Compiler<'_> {
    fn finish(
        mut self,
        family: ladder::Family,
        mut data: Vec<u16>,
    ) -> Result<(Compiled, Vec<Approximation>), Vec<Refusal>> {
        let mut files = Vec::new();
        let mut entries = Vec::new();
        let image = self.image;
        for file in image.ladder_files() {
            let start = self.ops.len() as u32;
            self.program_file(file);
            let number = usize::from(file.number);
            if entries.len() <= number {
                entries.resize(number + 1, None);
            }
            entries[number] = Some(start);
            let rungs = u16::try_from(file.rungs.len()).unwrap_or(u16::MAX);
            files.push(CodeFile { number: file.number, rungs });
        }
        if entries.get(2).copied().flatten().is_none() {
            self.going_to_run = Some((code::NO_MAIN, OpSite { file: 2, rung: 0, instruction: NO_INSTRUCTION }));
        }
        if !self.refusals.is_empty() {
            return Err(self.refusals);
        }
        if self.options.inline {
            self.parameters(&mut data);
        }
        let mut before = Vec::with_capacity(self.sites.len() + 1);
        let mut count = 0;
        for site in &self.sites {
            before.push(count);
            count += u32::from(site.instruction != NO_INSTRUCTION);
        }
        before.push(count);
        let words = |file_type| {
            let info = self.layout.file(file_type, u16::from(file_type == FileType::I));
            info.and_then(|index| self.layout.files.get(index))
                .map_or((0, 0), |file| (file.start as usize, file.elements as usize))
        };
        let (inputs, outputs) = (words(FileType::I), words(FileType::O));
        let forces = |file_type: FileType, count: usize| {
            let file = image.data_file(file_type, u16::from(file_type == FileType::I));
            let mut forces: Vec<_> = file.into_iter().flat_map(|f| f.forces.iter().map(|f| (f.on, f.off))).collect();
            forces.resize(count, (0, 0xFFFF));
            forces
        };
        let mut compiled = Compiled {
            family,
            traits: self.traits,
            choices: self.options.choices,
            rules: instr::exec::Rules { lineage: self.traits.lineage, choices: self.options.choices },
            watchdog: self.options.watchdog,
            ops: self.ops,
            sites: self.sites,
            before,
            blocks: self.blocks,
            references: self.references,
            files,
            entries,
            data,
            input_forces: forces(FileType::I, inputs.1),
            output_forces: forces(FileType::O, outputs.1),
            inputs,
            outputs,
            layout: self.layout,
            timer_slots: self.timer_slots,
            timers: self.timers as usize,
            pids: self.pids as usize,
            adjusts: self.adjusts as usize,
            messages: self.messages as usize,
            prescan: self.prescan,
            one_shots: self.one_shots,
            going_to_run: self.going_to_run,
            identity: 0,
        };
        compiled.identity = identity(&compiled);
        Ok((compiled, self.approximations))
    }

    /// Says what the I/O configuration does not place and which family an unknown one runs as.
    fn notes(&mut self, unplaced: &[(FileType, u16, u16)]) {
        for (file_type, slot, word) in unplaced {
            let why = format!("{file_type}:{slot}.{word} is not in the I/O configuration: it is a word of its own");
            self.approximations.push(Approximation { site: None, why });
        }
        for file in self.layout.files.iter().filter(|file| file.file_type == FileType::PLS && file.elements > 0) {
            let why =
                format!("PLS{}: programmable limit switches switch no outputs: the table is data only", file.number);
            self.approximations.push(Approximation { site: None, why });
        }
        if self.image.processor.family == ladder::Family::Unknown && self.options.family.is_none() {
            let why = "the processor family is not known: the program runs as on SLC 5/03".to_owned();
            self.approximations.push(Approximation { site: None, why });
        }
    }

    fn timer_slots(&mut self) {
        for (index, file) in self.layout.files.iter().enumerate() {
            if file.file_type == FileType::T {
                self.timer_slots.push((index, self.timers));
                self.timers += file.elements;
            }
        }
    }

    fn program_file(&mut self, file: &ProgramFile) {
        self.labels.clear();
        self.jumps.clear();
        for (number, rung) in file.rungs.iter().enumerate() {
            self.here = OpSite {
                file: file.number,
                rung: u16::try_from(number).unwrap_or(u16::MAX),
                instruction: NO_INSTRUCTION,
            };
            if self.ops.len() > MAX_OPS {
                self.refusals.push(Refusal { site: None, why: "the program is too long".to_owned() });
                return;
            }
            let start = self.ops.len() as u32;
            self.structural(Op::Rung);
            self.shape(rung);
            let mut next = 0;
            self.series(&rung.series, start, 0, &mut next);
        }
        // Every file ends, whether or not its END rung is stored.
        self.here.instruction = NO_INSTRUCTION;
        let ends = file.rungs.last().is_some_and(ladder::Rung::is_end);
        if !ends {
            self.structural(Op::Rung);
            self.structural(Op::End);
        }
        for (position, label, site) in std::mem::take(&mut self.jumps) {
            match self.labels.get(&label) {
                Some(target) => {
                    if let Some(op) = self.ops.get_mut(position) {
                        *op = Op::Jump(*target);
                    }
                }
                None => {
                    self.going_to_run.get_or_insert((code::LABEL, site));
                }
            }
        }
    }

    fn structural(&mut self, op: Op) {
        self.ops.push(op);
        self.sites.push(OpSite { instruction: NO_INSTRUCTION, ..self.here });
    }

    fn series(&mut self, series: &Series, rung_start: u32, depth: u32, next: &mut u16) {
        for element in series {
            match element {
                Element::Instruction(instruction) => {
                    self.here.instruction = *next;
                    *next = next.saturating_add(1).min(NO_INSTRUCTION - 1);
                    self.instruction(instruction, rung_start);
                }
                Element::Branch(branch) => {
                    if depth >= MAX_NESTING {
                        self.refusals.push(Refusal {
                            site: Some(self.site("branch")),
                            why: format!("branches nest deeper than {MAX_NESTING} levels"),
                        });
                        return;
                    }
                    // A branch without legs passes nothing on and stops nothing: a plain wire.
                    if branch.legs.is_empty() {
                        continue;
                    }
                    self.structural(Op::BranchStart);
                    for (leg, inner) in branch.legs.iter().enumerate() {
                        if leg > 0 {
                            self.structural(Op::NextLeg);
                        }
                        self.series(inner, rung_start, depth + 1, next);
                    }
                    self.structural(Op::BranchEnd);
                }
            }
        }
    }

    fn site(&self, text: impl Into<String>) -> Site {
        Site { file: self.here.file, rung: self.here.rung, instruction: self.here.instruction, text: text.into() }
    }

    fn approximate(&mut self, instruction: &Instruction, why: impl Into<String>) {
        let site = Some(self.site(text_of(instruction)));
        self.approximations.push(Approximation { site, why: why.into() });
    }

    fn push(&mut self, op: Op) {
        self.ops.push(op);
        self.sites.push(self.here);
    }

    fn block(&mut self, block: Block) -> u32 {
        self.blocks.push(block);
        (self.blocks.len() - 1) as u32
    }

    fn instruction(&mut self, instruction: &Instruction, rung_start: u32) {
        if let Err(why) = self.translate(instruction, rung_start) {
            let site = Some(self.site(text_of(instruction)));
            match self.options.unsupported {
                Unsupported::Refuse => self.refusals.push(Refusal { site, why }),
                Unsupported::Fault => {
                    let why = format!("{why}: fault 0031 when it executes");
                    self.approximations.push(Approximation { site, why });
                    let block = self.block(Block::Unsupported);
                    self.push(Op::Do(block));
                }
            }
        }
    }
}

/// The instruction as rung text shows it.
fn text_of(instruction: &Instruction) -> String {
    let mut text = instruction.mnemonic.to_string();
    for operand in &instruction.operands {
        let operand = operand.to_string();
        if !operand.is_empty() {
            text.push(' ');
            text.push_str(&operand);
        }
    }
    text
}

/// FNV-1a over the shape of the compiled program: a saved state belongs to exactly one.
fn identity(compiled: &Compiled) -> u64 {
    let text = format!(
        "{:?}{:?}{:?}{:?}{:?}{:?}",
        compiled.family, compiled.choices, compiled.ops, compiled.blocks, compiled.references, compiled.layout.files
    );
    text.bytes().fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3))
}
