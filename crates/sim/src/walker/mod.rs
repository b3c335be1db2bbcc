//! A plain interpreter over the rung tree, to check the compiled engine against.
//!
//! It resolves every address at every use, keeps data files apart and knows one way of doing each
//! thing; it shares with the engine only the pure functions of `instr`. It covers the instructions
//! that random programs are made of: bits, timers, counters, comparisons, arithmetic, moves, file
//! instructions and program flow, without fault routines, interrupts and forces.

mod instruction;
mod memory;

use std::collections::BTreeMap;

use instr::exec::{Lineage, Rules};
use ladder::{Element, FileType, Image, Instruction, Operand, Series};

use crate::{Choices, status};

/// Why a series was left before its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Leave {
    Jump(u16),
    Return,
    TempEnd,
    Fault(u16),
}

type Walk<T> = Result<T, Leave>;

/// What a timer has beside its words.
#[derive(Clone, Copy, Debug, Default)]
struct Hidden {
    last: u64,
    part: u64,
    executed: bool,
}

/// An interpreter with its data.
#[derive(Clone, Debug)]
pub struct Walker<'a> {
    image: &'a Image,
    rules: Rules,
    /// Words of every data file; files I and O have the words of slot 0.
    files: BTreeMap<(FileType, u16), Vec<u16>>,
    timers: BTreeMap<(u16, u16), Hidden>,
    now: u64,
    fault: Option<u16>,
}

impl<'a> Walker<'a> {
    /// An interpreter for a program on data files of the given element counts, all zero.
    pub fn new(image: &'a Image, choices: Choices, files: &[(FileType, u16, u16)]) -> Walker<'a> {
        let words = |file_type: FileType| usize::from(file_type.words_per_element().unwrap_or(1));
        let files = files
            .iter()
            .map(|(file_type, number, elements)| {
                ((*file_type, *number), vec![0; usize::from(*elements) * words(*file_type)])
            })
            .collect();
        let rules = Rules { lineage: Lineage::of(image.processor.family), choices };
        Walker { image, rules, files, timers: BTreeMap::new(), now: 0, fault: None }
    }

    /// The words of a data file.
    pub fn words(&mut self, file_type: FileType, number: u16) -> Option<&mut Vec<u16>> {
        self.files.get_mut(&(file_type, number))
    }

    /// Code of the major fault that stopped it.
    pub fn fault(&self) -> Option<u16> {
        self.fault
    }

    /// Prescan and first pass.
    pub fn enter_run(&mut self) {
        self.timers.clear();
        let image = self.image;
        for instruction in image.ladder_files().flat_map(|f| f.rungs.iter()).flat_map(|r| r.instructions()) {
            let Some(Operand::Address(address)) = instruction.operands.first() else { continue };
            match instruction.mnemonic.name() {
                Some("OTE") => {
                    let _ = self.put_bit(address, false);
                }
                Some(name @ ("CTU" | "CTD")) => {
                    let mask = if name == "CTU" { 0x8000 } else { 0x4000 };
                    if let Ok(word) = self.word_at(address, 0) {
                        *word |= mask;
                    }
                }
                _ => {}
            }
        }
        self.status(status::MODE, |word| word | status::FIRST_PASS.1);
    }

    /// Time passes, then one scan.
    pub fn scan(&mut self, nanoseconds: u64) {
        if self.fault.is_some() {
            return;
        }
        self.now += nanoseconds;
        match self.file(2, 0) {
            Ok(()) | Err(Leave::TempEnd) => {
                if self.status(status::MINOR, |word| word) & status::MINOR_FATAL != 0 {
                    return self.stop(0x20);
                }
                self.status(status::MODE, |word| word & !status::FIRST_PASS.1);
            }
            Err(Leave::Return) => self.stop(0x38),
            Err(Leave::Fault(code)) => self.stop(code),
            Err(Leave::Jump(_)) => self.stop(0x19),
        }
    }

    fn stop(&mut self, code: u16) {
        self.fault = Some(code);
        self.status(status::FAULT_CODE, |_| code);
        self.status(status::MODE, |word| word | status::MAJOR_ERROR.1);
    }

    /// Reads a word of the status file and writes what `change` makes of it.
    fn status(&mut self, index: usize, change: impl FnOnce(u16) -> u16) -> u16 {
        let word = self.files.get_mut(&(FileType::S, 2)).and_then(|words| words.get_mut(index));
        word.map_or(0, |word| {
            let before = *word;
            *word = change(before);
            before
        })
    }

    /// Runs a program file; `depth` counts the calls that led to it.
    fn file(&mut self, number: u16, depth: usize) -> Walk<()> {
        let image = self.image;
        let Some(file) = image.program_file(number) else { return Err(Leave::Fault(0x31)) };
        let mut zone = true;
        let mut rung = 0;
        while let Some(current) = file.rungs.get(rung) {
            match self.series(&current.series, zone, &mut zone, depth) {
                Ok(_) => rung += 1,
                Err(Leave::Jump(label)) => {
                    let target = file.rungs.iter().position(|rung| has_label(&rung.series, label));
                    rung = target.ok_or(Leave::Fault(0x19))?;
                }
                Err(Leave::Return) if depth > 0 => return Ok(()),
                Err(other) => return Err(other),
            }
        }
        Ok(())
    }

    fn series(&mut self, series: &Series, power: bool, zone: &mut bool, depth: usize) -> Walk<bool> {
        let mut power = power;
        for element in series {
            power = match element {
                Element::Instruction(instruction) => self.step(instruction, power, zone, depth)?,
                Element::Branch(branch) => {
                    let mut any = branch.legs.is_empty() && power;
                    for leg in &branch.legs {
                        any |= self.series(leg, power, zone, depth)?;
                    }
                    any
                }
            };
        }
        Ok(power)
    }

    fn step(&mut self, instruction: &Instruction, power: bool, zone: &mut bool, depth: usize) -> Walk<bool> {
        let number = |index: usize| match instruction.operands.get(index) {
            Some(Operand::Label { number, .. } | Operand::ProgramFile(number)) => *number,
            Some(Operand::Constant(constant)) => constant.as_integer().unwrap_or(0) as u16,
            _ => 0,
        };
        match instruction.mnemonic.name().unwrap_or("") {
            "JMP" if power => Err(Leave::Jump(number(0))),
            "RET" if power => Err(Leave::Return),
            "TND" if power => Err(Leave::TempEnd),
            "JSR" if power => {
                let levels = if self.rules.lineage == Lineage::S1 { 4 } else { 8 };
                if depth >= levels {
                    return Err(Leave::Fault(0x30));
                }
                self.file(number(0), depth + 1)?;
                Ok(power)
            }
            "MCR" => {
                *zone = !*zone || power;
                Ok(power)
            }
            "JMP" | "RET" | "TND" | "JSR" | "LBL" | "SBR" | "END" => Ok(power),
            name => self.execute(name, &instruction.operands, power),
        }
    }
}

fn has_label(series: &Series, label: u16) -> bool {
    matches!(series.first(), Some(Element::Instruction(first)) if first.mnemonic == "LBL"
        && matches!(first.operands.first(), Some(Operand::Label { number, .. }) if *number == label)
        || matches!(series.first(), Some(Element::Instruction(first)) if first.mnemonic == "LBL"
            && first.operands.first().and_then(|o| o.constant()).and_then(|c| c.as_integer()) == Some(label.into())))
}
