//! What a program does to its data, step by step: for reasoning about a program without running it.
//!
//! The list is the one the engine runs, in terms a reader outside can follow. What has an exact meaning of
//! few words has a step of its own; everything else says which words it can write ([`Does::Other`]), never
//! fewer than it does.

mod blocks;
mod routines;

use ladder::FileType;

use crate::op::{BitAt, NO_INSTRUCTION, Op};
use crate::{Choices, Machine, Program, status};

pub use routines::Routine;

/// A number: words and bits are counted through all data, bit 16 being bit 0 of word 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Value {
    /// The word at this index.
    Word(u32),
    /// The long word that begins at this index, low word first.
    Long(u32),
    /// A constant.
    Constant(i32),
}

/// Words that something can write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Write {
    /// From the first word to before the second.
    Words(u32, u32),
    /// Somewhere in a file, as an element number decides that is known when the program runs.
    Element {
        /// First word of the file and first word after it.
        file: (u32, u32),
        /// The element number.
        element: Value,
        /// Elements of the file.
        elements: u32,
        /// A number beyond the file reaches other data instead of being a fault.
        strays: bool,
    },
    /// Anything.
    Anywhere,
}

/// How a comparison relates its values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names say it
pub enum Relation {
    Equal,
    NotEqual,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

/// Which timer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimerKind {
    /// TON.
    On,
    /// TOF.
    Off,
    /// RTO.
    Retentive,
}

/// Two values into one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names say it
pub enum Binary {
    Add,
    Subtract,
    And,
    Or,
    Xor,
}

/// What a step does. Bits are counted through all data.
#[derive(Clone, Debug, PartialEq)]
pub enum Does {
    /// A rung begins.
    Rung,
    /// A branch begins.
    BranchStart,
    /// Its next leg begins.
    NextLeg,
    /// It ends.
    BranchEnd,
    /// XIC, or XIO when `closed`.
    Contact {
        /// The bit.
        bit: u32,
        /// Passes while the bit is off.
        closed: bool,
    },
    /// OTE.
    Coil(u32),
    /// OTL.
    Latch(u32),
    /// OTU.
    Unlatch(u32),
    /// ONS, OSR of one operand: passes where power is new.
    OneShot(u32),
    /// OSR with output.
    Rising {
        /// Remembers the rung.
        storage: u32,
        /// On for one scan.
        output: u32,
    },
    /// OSF.
    Falling {
        /// Remembers the rung.
        storage: u32,
        /// On for one scan.
        output: u32,
    },
    /// A timer; `word` is its first one.
    #[allow(missing_docs)]
    Timer { kind: TimerKind, word: u32 },
    /// CTU, or CTD when `down`.
    #[allow(missing_docs)]
    Counter { down: bool, word: u32 },
    /// A comparison of two values.
    #[allow(missing_docs)]
    Compare { relation: Relation, a: Value, b: Value },
    /// LIM.
    #[allow(missing_docs)]
    Limit { low: Value, test: Value, high: Value },
    /// MEQ.
    #[allow(missing_docs)]
    MaskedEqual { source: Value, mask: Value, compare: Value },
    /// RES of a timer.
    ResetTimer(u32),
    /// RES of a counter.
    ResetCounter(u32),
    /// MOV, CLR.
    #[allow(missing_docs)]
    Move { source: Value, dest: Value },
    /// ADD, SUB, AND, OR, XOR.
    #[allow(missing_docs)]
    Binary { op: Binary, a: Value, b: Value, dest: Value },
    /// COP of words that do not overlap.
    #[allow(missing_docs)]
    Copy { from: u32, to: u32, words: u32 },
    /// FLL of words with a constant.
    #[allow(missing_docs)]
    Fill { value: u16, to: u32, words: u32 },
    /// SQO into a word; control element, file and the words of it up to its end.
    #[allow(missing_docs)]
    Sequencer { control: u32, file: (u32, u32), mask: Value, dest: u32 },
    /// MCR.
    Mcr,
    /// JMP to a step.
    Jump(u32),
    /// JSR.
    Call(u16),
    /// RET.
    Return,
    /// TND.
    TempEnd,
    /// SUS.
    Suspend,
    /// The end of a file.
    End,
    /// Nothing that data or power could show.
    Nothing,
    /// Anything else.
    Other {
        /// It can take power away.
        condition: bool,
        /// It acts without power too.
        always: bool,
        /// What it can write.
        writes: Vec<Write>,
        /// Where it reads an element whose number is known when the program runs.
        reads: Vec<Write>,
        /// It can end in a major fault for other reasons than such a number.
        faults: bool,
    },
}

/// A step of a program file.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Program file.
    pub file: u16,
    /// Rung, from 0.
    pub rung: u16,
    /// Instruction of the rung, from 0; `None` for what only shapes it.
    pub instruction: Option<u16>,
    /// What it does.
    pub does: Does,
}

/// A data file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DataRange {
    /// Its type.
    pub file_type: FileType,
    /// Its number.
    pub number: u16,
    /// First word and first word after it.
    pub words: (u32, u32),
    /// Words per element.
    pub size: u32,
}

/// A program as steps, with what surrounds it.
#[derive(Clone, Debug)]
pub struct Outline {
    /// All steps, program file after program file.
    pub steps: Vec<Step>,
    /// First step by program file number.
    pub entries: Vec<Option<u32>>,
    /// Data files and the words of modules.
    pub files: Vec<DataRange>,
    /// Words of data.
    pub words: u32,
    /// S:1/15.
    pub first_pass: u32,
    /// Bits that going to run sets or resets; `None`: it also writes bits decided at run time.
    pub prescan: Option<Vec<(u32, bool)>>,
    /// Levels of subroutines below the main program; one more is a fault.
    pub levels: usize,
    /// Instructions one scan may execute.
    pub watchdog: u64,
    /// Program files the processor can start by itself, with the occasion; file 0 stands for a counter that
    /// switches outputs. This and what follows holds as long as no element number leads out of its file.
    pub routines: Vec<(u16, Routine)>,
    /// Going to run can fail.
    pub refuses_run: bool,
    /// A minor error that ends a scan with a fault stands in the data already, or the program writes there.
    pub minor_error: bool,
    /// Readings the program runs with.
    pub choices: Choices,
}

impl Program {
    /// The program as steps.
    pub fn outline(&self) -> Outline {
        Outline::of(&self.compiled)
    }
}

impl Machine {
    /// The program as steps.
    pub fn outline(&self) -> Outline {
        Outline::of(&self.program)
    }
}

impl Outline {
    fn of(compiled: &crate::op::Compiled) -> Outline {
        let steps: Vec<Step> = compiled
            .ops
            .iter()
            .zip(&compiled.sites)
            .map(|(op, site)| Step {
                file: site.file,
                rung: site.rung,
                instruction: (site.instruction != NO_INSTRUCTION).then_some(site.instruction),
                does: does(compiled, op),
            })
            .collect();
        let prescan = compiled.prescan.iter().map(|prescan| bit(prescan.bit).map(|at| (at, prescan.set))).collect();
        let ranges = compiled.layout.files.iter().map(|file| DataRange {
            file_type: file.file_type,
            number: file.number,
            words: (file.start, file.end()),
            size: file.size,
        });
        let mut outline = Outline {
            entries: compiled.entries.clone(),
            files: ranges.collect(),
            words: u32::try_from(compiled.layout.words()).unwrap_or(u32::MAX),
            first_pass: ((compiled.layout.status + status::FIRST_PASS.0) * 16 + 15) as u32,
            prescan,
            levels: compiled.traits.levels,
            watchdog: compiled.watchdog,
            routines: Vec::new(),
            refuses_run: compiled.going_to_run.is_some(),
            minor_error: false,
            choices: compiled.choices,
            steps,
        };
        outline.surroundings(compiled);
        outline
    }
}

/// A bit known before the program runs.
fn bit(bit: BitAt) -> Option<u32> {
    match bit {
        BitAt::Direct { mask, word } if mask.is_power_of_two() => Some(word * 16 + mask.trailing_zeros()),
        _ => None,
    }
}

fn does(compiled: &crate::op::Compiled, op: &Op) -> Does {
    let direct = |mask: u16, word: u32| bit(BitAt::Direct { mask, word });
    let other = |condition, always, word: u32| Does::Other {
        condition,
        always,
        writes: vec![Write::Words(word, word.saturating_add(1))],
        reads: Vec::new(),
        faults: false,
    };
    match *op {
        Op::Rung => Does::Rung,
        Op::BranchStart => Does::BranchStart,
        Op::NextLeg => Does::NextLeg,
        Op::BranchEnd => Does::BranchEnd,
        Op::Contact { invert, mask, word } => match direct(mask, word) {
            Some(bit) if invert == 0 || invert == u16::MAX => Does::Contact { bit, closed: invert != 0 },
            _ => Does::Other { condition: true, always: false, writes: Vec::new(), reads: Vec::new(), faults: false },
        },
        Op::Ote { mask, word } => direct(mask, word).map_or(other(false, true, word), Does::Coil),
        Op::Otl { mask, word } => direct(mask, word).map_or(other(false, true, word), Does::Latch),
        Op::Otu { mask, word } => direct(mask, word).map_or(other(false, true, word), Does::Unlatch),
        Op::OneShot { mask, word } => direct(mask, word).map_or(other(true, true, word), Does::OneShot),
        Op::Timer { kind, word, .. } => Does::Timer { kind: blocks::kind(kind), word },
        Op::Counter { down, word } => Does::Counter { down, word },
        Op::CompareWords { relation, a, b } => {
            Does::Compare { relation: blocks::relation(relation), a: Value::Word(a), b: Value::Word(b) }
        }
        Op::CompareConstant { relation, value, a } => {
            Does::Compare { relation: blocks::relation(relation), a: Value::Word(a), b: Value::Constant(value.into()) }
        }
        Op::Test(block) => blocks::does(compiled, block, true, false),
        Op::Do(block) => blocks::does(compiled, block, false, false),
        Op::Always(block) => blocks::does(compiled, block, false, true),
        Op::Marker => Does::Nothing,
        Op::Mcr => Does::Mcr,
        Op::Jump(target) => Does::Jump(target),
        Op::Call(file) => Does::Call(file as u16),
        Op::Return => Does::Return,
        Op::TempEnd => Does::TempEnd,
        Op::Suspend(_) => Does::Suspend,
        Op::End => Does::End,
    }
}
