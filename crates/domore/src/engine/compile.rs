//! A project to operations: every element resolved, every instruction either executed faithfully, named
//! as an approximation, or refused with its rung.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

use super::op::*;
use super::operand::Why;
use super::{Approximation, Options, Refusal, Site, Unsupported};
use crate::instruction::{self, Effect, Flow, Join, Test};
use crate::memory::{Map, STAGES};
use crate::program::{CodeBlock, CodeKind, Instruction, Project, Rung};

/// Values the stack of a rung holds at most.
const MOST_DEPTH: usize = 60;
/// Operations of a program; the largest controllers hold far fewer instructions.
const MOST_OPS: usize = 2_000_000;
/// Loops inside loops.
pub(crate) const MOST_LOOPS: usize = 8;

pub(crate) fn compile(project: &Project, options: &Options) -> Result<(Compiled, Vec<Approximation>), Vec<Refusal>> {
    let whole = |why: String| vec![Refusal { site: None, why }];
    let map = Map::new(project).map_err(|error| whole(error.to_string()))?;
    let notes = map.notes.clone();
    let compiled = Compiled {
        system: super::clock::System::of(&map),
        inputs: inputs(&map),
        map,
        choices: options.choices,
        watchdog: options.watchdog,
        ..Compiled::default()
    };
    let blocks: Vec<&CodeBlock> = project.code_blocks().collect();
    let mut compiler = Compiler {
        out: compiled,
        blocks: HashMap::new(),
        structures: HashMap::new(),
        owners: HashMap::new(),
        refusals: Vec::new(),
        approximations: notes.into_iter().map(|why| Approximation { site: None, why }).collect(),
        unsupported: options.unsupported,
        stage: None,
        loops: Vec::new(),
        repeats: Vec::new(),
    };
    for (index, block) in blocks.iter().enumerate() {
        if compiler.blocks.insert(name_of(block).to_ascii_uppercase(), index as u32).is_some() {
            compiler.refusals.push(Refusal { site: None, why: format!("code block {} stands twice", name_of(block)) });
        }
    }
    if !blocks.iter().any(|block| matches!(block.kind, CodeKind::Program | CodeKind::Bare)) {
        compiler.refusals.push(Refusal { site: None, why: "there is no program to run".to_owned() });
    }
    for (index, block) in blocks.iter().enumerate() {
        compiler.block(index as u32, block);
    }
    compiler.finish(project)
}

/// The blocks the I/O scan fills, their terminals one behind the other.
fn inputs(map: &Map) -> Vec<Input> {
    let blocks = map.blocks().iter().filter(|block| block.is_input());
    let row = |terminal: &mut usize, block: &crate::memory::Block| {
        let (image, bytes) = (block.bytes().start, block.bytes().len());
        let terminal = std::mem::replace(terminal, *terminal + bytes);
        Some(Input { image, terminal, bytes })
    };
    blocks.scan(0, row).collect()
}

fn name_of(block: &CodeBlock) -> &str {
    if block.kind == CodeKind::Bare { "$Main" } else { &block.name }
}

pub(super) struct Compiler {
    pub(super) out: Compiled,
    pub(super) blocks: HashMap<String, u32>,
    /// First bit of a structure to its reset memory.
    structures: HashMap<u32, u32>,
    /// First bit of a structure to the box that owns it.
    owners: HashMap<u32, u32>,
    refusals: Vec<Refusal>,
    approximations: Vec<Approximation>,
    unsupported: Unsupported,
    /// Bit of the stage the current rung stands in.
    pub(super) stage: Option<u32>,
    pub(super) loops: Vec<u32>,
    pub(super) repeats: Vec<u32>,
}

impl Compiler {
    fn block(&mut self, index: u32, block: &CodeBlock) {
        let name = name_of(block).to_owned();
        let runs = self.runs(block, &name);
        let start = self.out.ops.len() as u32;
        self.stage = None;
        let stages = self.out.map.stages(&block.name).unwrap_or(0);
        let first = self.out.stages.len();
        for (number, rung) in block.rungs.iter().enumerate() {
            self.rung(index, number as u32, rung, &name);
            if self.out.ops.len() > MOST_OPS {
                self.refusals.push(Refusal { site: None, why: format!("more than {MOST_OPS} operations") });
                return;
            }
        }
        let end = self.out.ops.len() as u32;
        for open in [self.loops.len(), self.repeats.len()] {
            if open > 0 {
                self.refusals.push(Refusal { site: None, why: format!("code block {name}: a loop has no end") });
            }
        }
        self.loops.clear();
        self.repeats.clear();
        let mut until = end;
        for stage in self.out.stages.get_mut(first..).unwrap_or_default().iter_mut().rev() {
            stage.end = until;
            // Before the stage stand its own operation and the start of its rung.
            until = stage.start.saturating_sub(2);
        }
        let first_stage = self.out.stages.get(first).map(|stage| stage.bit);
        self.out.blocks.push(BlockCode {
            name,
            runs,
            start,
            end,
            stages,
            first_stage,
            rungs: block.rungs.len() as u32,
        });
    }

    fn runs(&mut self, block: &CodeBlock, name: &str) -> Runs {
        let mut note = |why: &str| {
            self.approximations.push(Approximation { site: None, why: format!("code block {name}: {why}") });
        };
        match &block.kind {
            CodeKind::Bare => Runs::Enabled { from_start: true },
            CodeKind::Program => Runs::Enabled { from_start: name == "$Main" },
            CodeKind::Subroutine => Runs::Called,
            CodeKind::Task if name == "$tFirstScan" => Runs::FirstScan,
            CodeKind::Task => match interval(name) {
                Some(time) => {
                    note("it runs before the programs of the first scan in which its interval has passed");
                    Runs::Every(time)
                }
                None => {
                    note("what starts this task is not modelled; it never runs");
                    Runs::Never
                }
            },
            CodeKind::Interrupt => {
                note("interrupts are not modelled; it never runs");
                Runs::Never
            }
            CodeKind::Other { begin, .. } => {
                note(&format!("blocks that {begin} begins are not modelled; it never runs"));
                Runs::Never
            }
        }
    }

    fn rung(&mut self, block: u32, number: u32, rung: &Rung, name: &str) {
        let spot = Spot { block, rung: number, instruction: 0 };
        self.emit(Op::Rung, spot);
        let mut depth = 0usize;
        for (position, instruction) in rung.instructions.iter().enumerate() {
            let spot = Spot { instruction: position as u32, ..spot };
            let site = || Site {
                block: name.to_owned(),
                rung: number as usize + 1,
                instruction: position,
                text: instruction.to_string(),
            };
            let before = self.out.ops.len();
            match self.instruction(instruction, spot, &mut depth) {
                Ok(notes) => {
                    for why in notes {
                        self.approximations.push(Approximation { site: Some(site()), why: why.to_owned() });
                    }
                }
                Err(why) => {
                    self.out.ops.truncate(before);
                    self.out.spots.truncate(before);
                    let contact = matches!(
                        instruction::by_mnemonic(&instruction.mnemonic).map(|entry| entry.effect),
                        Some(Effect::Contact { .. } | Effect::Alone)
                    );
                    if self.unsupported == Unsupported::Stop && !contact {
                        let why = format!("{why}; the machine stops where it has power");
                        self.approximations.push(Approximation { site: Some(site()), why });
                        self.emit(Op::Unsupported, spot);
                    } else {
                        self.refusals.push(Refusal { site: Some(site()), why });
                    }
                }
            }
        }
        let balanced = match rung.instructions.last().and_then(|last| instruction::by_mnemonic(&last.mnemonic)) {
            Some(entry) => entry.effect == Effect::Alone || depth == 1,
            None => true,
        };
        if !balanced && !rung.instructions.is_empty() {
            let text = rung.instructions.last().map(ToString::to_string).unwrap_or_default();
            let site = Site {
                block: name.to_owned(),
                rung: number as usize + 1,
                instruction: rung.instructions.len() - 1,
                text,
            };
            let why = format!("the rung does not balance: {depth} values are left on its stack, expected 1");
            self.refusals.push(Refusal { site: Some(site), why });
        }
    }

    pub(super) fn emit(&mut self, op: Op, spot: Spot) {
        self.out.ops.push(op);
        self.out.spots.push(spot);
    }

    /// One instruction; what about it is approximate.
    fn instruction(
        &mut self,
        instruction: &Instruction,
        spot: Spot,
        depth: &mut usize,
    ) -> Result<Vec<&'static str>, Why> {
        let entry = instruction::by_mnemonic(&instruction.mnemonic)
            .ok_or_else(|| format!("{} is not known", instruction.mnemonic))?;
        let count = instruction.operands.len();
        if count < entry.required || count > entry.operands.len() {
            return Err(format!("{} takes {} operands, found {count}", entry.mnemonic, entry.operands.len()));
        }
        let needs = match entry.effect {
            Effect::Contact { join: Join::Push, .. } | Effect::Alone => 0,
            Effect::Series | Effect::Parallel => 2,
            Effect::Box { legs } => legs.len(),
            // An output first in its rung, as exports have it behind a stage, is unconditional.
            Effect::Output if spot.instruction == 0 => {
                self.emit(Op::Power, spot);
                *depth = 1;
                1
            }
            _ => 1,
        };
        if *depth < needs {
            return Err(format!("the stack holds {depth} values here, {} needs {needs}", entry.mnemonic));
        }
        match entry.effect {
            Effect::Contact { join: Join::Push, .. } | Effect::Duplicate => *depth += 1,
            Effect::Series | Effect::Parallel | Effect::Drop => *depth -= 1,
            Effect::Box { legs } => *depth -= legs.len() - 1,
            _ => {}
        }
        if *depth > MOST_DEPTH {
            return Err(format!("more than {MOST_DEPTH} values on the stack"));
        }
        let op = match entry.effect {
            Effect::Contact { join, test } => self.contact(join, test, instruction)?,
            Effect::Series => Op::Series,
            Effect::Parallel => Op::Parallel,
            Effect::Flow(Flow::Invert) => Op::Invert,
            Effect::Flow(flow) => {
                self.emit(Op::FlowEdge { rise: flow == Flow::Rise, memory: self.out.counts.edges }, spot);
                self.out.counts.edges += 1;
                return Ok(vec!["the first scan of a one-shot of the power flow is not described"]);
            }
            Effect::Duplicate => Op::Duplicate,
            Effect::Drop => Op::Drop,
            Effect::Output | Effect::Box { .. } | Effect::Alone => {
                let (op, notes) = self.output(entry.mnemonic, instruction, spot)?;
                self.emit(op, spot);
                return Ok(notes);
            }
        };
        self.emit(op, spot);
        Ok(Vec::new())
    }

    fn contact(&mut self, join: Join, test: Test, instruction: &Instruction) -> Result<Op, Why> {
        let operand = instruction.operand(0);
        Ok(match test {
            Test::On | Test::Off => {
                let negated = test == Test::Off;
                match (self.out.contact(operand)?, join, negated) {
                    (Source::Place(place), Join::Push, false) => Op::Push(place.bit),
                    (Source::Place(place), Join::Push, true) => Op::PushNot(place.bit),
                    (Source::Place(place), Join::And, false) => Op::And(place.bit),
                    (Source::Place(place), Join::And, true) => Op::AndNot(place.bit),
                    (Source::Place(place), Join::Or, false) => Op::Or(place.bit),
                    (Source::Place(place), Join::Or, true) => Op::OrNot(place.bit),
                    (Source::Indexed(place), join, negated) => Op::Indexed { join, negated, place },
                    (Source::Constant(_), ..) => return Err(format!("{operand} is no bit")),
                }
            }
            Test::Rise | Test::Fall => {
                let Source::Place(place) = self.out.contact(operand)? else {
                    return Err(format!("{operand}: the edge of an element found by index is not modelled"));
                };
                Op::Edge { join, rise: test == Test::Rise, bit: place.bit, memory: self.edge() }
            }
            Test::Change => {
                let source = self.out.source(operand)?;
                self.out.sources.push(source);
                self.out.counts.values += 1;
                Op::Change { join, source: self.out.sources.len() as u32 - 1, memory: self.out.counts.values - 1 }
            }
            Test::Compare(relation) => {
                let (a, b) = (self.out.source(operand)?, self.out.source(instruction.operand(1))?);
                self.out.compares.push(Comparison { relation, a, b });
                Op::Compare { join, compare: self.out.compares.len() as u32 - 1 }
            }
        })
    }

    /// A memory of an edge.
    pub(super) fn edge(&mut self) -> u32 {
        self.out.counts.edges += 1;
        self.out.counts.edges - 1
    }

    /// The reset memory of a timer or counter structure.
    pub(super) fn structure(&mut self, bit: u32) -> u32 {
        let next = self.structures.len() as u32;
        *self.structures.entry(bit).or_insert(next)
    }

    /// Makes a box the owner of its structure; `false` when another one already is.
    pub(super) fn own(&mut self, bit: u32, index: u32) -> bool {
        let mut first = false;
        self.owners.entry(bit).or_insert_with(|| {
            first = true;
            index
        });
        first
    }

    pub(super) fn code_block(&self, text: &str) -> Result<u32, Why> {
        self.blocks.get(&text.to_ascii_uppercase()).copied().ok_or_else(|| format!("{text} is no code block"))
    }

    /// The bit of a stage.
    pub(super) fn stage_bit(&self, text: &str) -> Result<u32, Why> {
        let wrong = || format!("{text} is no stage of a code block");
        let (block, stage) = text.rsplit_once('.').ok_or_else(wrong)?;
        let start = self.out.map.stages(block).ok_or_else(wrong)?;
        let number = stage.strip_prefix(['S', 's']).and_then(|number| number.parse::<u32>().ok());
        number.filter(|number| *number < STAGES).map(|number| start + number).ok_or_else(wrong)
    }

    fn finish(mut self, project: &Project) -> Result<(Compiled, Vec<Approximation>), Vec<Refusal>> {
        if !self.refusals.is_empty() {
            return Err(self.refusals);
        }
        self.out.counts.structures = self.structures.len() as u32;
        for reset in &mut self.out.resets {
            reset.owner = self.owners.get(&reset.bit).copied();
        }
        let mut hash = DefaultHasher::new();
        for block in project.code_blocks() {
            block.name.hash(&mut hash);
            for instruction in block.rungs.iter().flat_map(|rung| &rung.instructions) {
                instruction.mnemonic.hash(&mut hash);
                instruction.operands.hash(&mut hash);
            }
        }
        for block in self.out.map.blocks() {
            (&block.name, block.start, block.element).hash(&mut hash);
        }
        (self.out.map.bytes(), self.out.choices.bits(), self.out.watchdog).hash(&mut hash);
        self.out.identity = hash.finish();
        Ok((self.out, self.approximations))
    }
}

/// The interval of a system task such as `$t100ms`, in nanoseconds.
fn interval(name: &str) -> Option<u64> {
    let rest = name.strip_prefix("$t")?;
    let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let number: u64 = rest.get(..digits)?.parse().ok()?;
    let unit = match rest.get(digits..)?.to_ascii_lowercase().as_str() {
        "ms" => 1_000_000,
        "s" | "sec" | "second" => 1_000_000_000,
        "min" | "minute" => 60_000_000_000,
        _ => return None,
    };
    number.checked_mul(unit).filter(|time| *time > 0)
}
