//! The compiled form: a flat list of operations with addresses resolved to word and mask.

use instr::exec::expression::Step;
use instr::exec::function::Function;
use instr::exec::stack::Order;
use ladder::{Family, FileType, TimeBase};

use crate::family::Traits;
use crate::layout::{Layout, Width};
use crate::{Choices, Options};

/// One step of a rung. Bits are a word index and a mask; larger instructions stand in a table of
/// [`Block`]s so that the list stays compact.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Op {
    /// Start of a rung: power is on unless a zone holds it off.
    Rung,
    BranchStart,
    NextLeg,
    BranchEnd,
    /// XIC, and XIO with `invert` all ones: passes power while a bit of the mask is on after the
    /// exclusive or.
    Contact {
        invert: u16,
        mask: u16,
        word: u32,
    },
    Ote {
        mask: u16,
        word: u32,
    },
    Otl {
        mask: u16,
        word: u32,
    },
    Otu {
        mask: u16,
        word: u32,
    },
    /// One-shot as a condition: ONS, and OSR with one operand.
    OneShot {
        mask: u16,
        word: u32,
    },
    Timer {
        kind: TimerKind,
        base: TimeBase,
        word: u32,
        slot: u32,
    },
    Counter {
        down: bool,
        word: u32,
    },
    /// Two words, or a word and a constant.
    CompareWords {
        relation: Relation,
        a: u32,
        b: u32,
    },
    CompareConstant {
        relation: Relation,
        value: i16,
        a: u32,
    },
    /// A condition of the block table; evaluated with power only.
    Test(u32),
    /// An output of the block table that does nothing without power.
    Do(u32),
    /// An output of the block table that acts without power too.
    Always(u32),
    /// Markers that are always true: LBL, SBR, INT.
    Marker,
    Mcr,
    Jump(u32),
    Call(u32),
    Return,
    TempEnd,
    Suspend(i16),
    End,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TimerKind {
    On,
    Off,
    Retentive,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Relation {
    Equal,
    NotEqual,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

/// Where a value is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Source {
    Word(u32),
    Long(u32),
    Float(u32),
    Integer(i32),
    Real(f32),
    /// Index of a reference decided at run time.
    At(u32),
}

/// Where a value is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Target {
    Word(u32),
    Long(u32),
    Float(u32),
    At(u32),
}

/// A bit operand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BitAt {
    Direct { mask: u16, word: u32 },
    At(u32),
}

/// The start of a file operand or of a block of words.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Start {
    pub(crate) at: StartAt,
    /// Words per element there.
    pub(crate) size: u32,
    /// What its elements are as numbers; words unless long words or floats.
    pub(crate) kind: instr::exec::Width,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum StartAt {
    /// First word and first word after the file.
    Fixed {
        word: u32,
        end: u32,
    },
    At(u32),
}

/// A part of an address: fixed, or read when the instruction executes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Part {
    Fixed(u16),
    Read(Source),
}

/// An address decided at run time, by brackets or by S:24.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reference {
    pub(crate) file_type: FileType,
    pub(crate) file: Part,
    pub(crate) element: Part,
    pub(crate) sub: u16,
    pub(crate) bit: Option<Part>,
    /// Add S:24 to the element.
    pub(crate) indexed: bool,
    pub(crate) width: Width,
}

/// Operands of a sequencer that are a word or, with `#`, a file stepped along with POS.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Stepped {
    Value(Source),
    File(Start),
}

/// Where a sequencer writes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SteppedTarget {
    Value(Target),
    File(Start),
}

/// A port instruction.
#[derive(Clone, Debug)]
pub(crate) struct Port {
    pub(crate) what: PortAction,
    pub(crate) channel: u16,
    pub(crate) string: Option<Start>,
    pub(crate) control: Start,
    pub(crate) masks: Option<(Source, Source)>,
}

/// A message instruction.
#[derive(Clone, Debug)]
pub(crate) struct Message {
    pub(crate) at: Start,
    /// The local data.
    pub(crate) local: Option<Start>,
    /// A block of integers, as on SLC 500 and MicroLogix 1000.
    pub(crate) slc: bool,
    /// Number among the message instructions.
    pub(crate) id: u32,
    pub(crate) setup: Vec<(String, String)>,
}

/// Operations that need more than a word and a mask.
#[derive(Clone, Debug)]
pub(crate) enum Block {
    // Conditions.
    Bit {
        bit: BitAt,
        closed: bool,
    },
    Compare {
        relation: Relation,
        a: Source,
        b: Source,
    },
    MaskedEqual {
        source: Source,
        mask: Source,
        compare: Source,
    },
    Limit {
        low: Source,
        test: Source,
        high: Source,
    },
    StringsEqual {
        a: Start,
        b: Start,
    },
    OneShot(BitAt),
    // Bits.
    Coil(BitAt),
    Latch(BitAt),
    Unlatch(BitAt),
    Rising {
        storage: BitAt,
        output: BitAt,
    },
    Falling {
        storage: BitAt,
        output: BitAt,
    },
    Timer {
        kind: TimerKind,
        base: TimeBase,
        at: u32,
    },
    Counter {
        down: bool,
        at: u32,
    },
    Reset {
        at: Start,
        file_type: FileType,
    },
    // Values.
    Unary {
        op: Unary,
        source: Source,
        dest: Target,
    },
    Binary {
        op: Binary,
        a: Source,
        b: Source,
        dest: Target,
    },
    Clear(Target),
    MaskedMove {
        source: Source,
        mask: Source,
        dest: Target,
    },
    ToBcd {
        source: Source,
        dest: Target,
        register: bool,
    },
    FromBcd {
        source: Source,
        dest: Target,
        register: bool,
    },
    DoubleDivide {
        source: Source,
        dest: Target,
    },
    Scale {
        source: Source,
        rate: Source,
        offset: Source,
        dest: Target,
    },
    ScaleParameters {
        input: [Source; 5],
        dest: Target,
    },
    Compute {
        steps: Vec<Step<Source>>,
        float: bool,
        dest: Target,
    },
    SwapBytes {
        at: Start,
        length: Source,
    },
    Copy {
        source: Start,
        dest: Start,
        length: Source,
        words: bool,
    },
    Fill {
        source: Source,
        dest: Start,
        length: Source,
    },
    FillElement {
        source: Start,
        dest: Start,
        length: Source,
    },
    Shift {
        left: bool,
        file: Start,
        control: Start,
        bit: BitAt,
    },
    Load {
        source: Source,
        file: Start,
        control: Start,
        long: bool,
    },
    Unload {
        order: Order,
        file: Start,
        dest: Target,
        control: Start,
        long: bool,
    },
    SequencerOutput {
        file: Start,
        mask: Stepped,
        dest: SteppedTarget,
        control: Start,
    },
    SequencerCompare {
        file: Start,
        mask: Stepped,
        source: Stepped,
        control: Start,
    },
    SequencerLoad {
        file: Start,
        source: Stepped,
        control: Start,
    },
    FileBits {
        detect: bool,
        source: Start,
        reference: Start,
        result: Start,
        compare: Start,
        control: Start,
    },
    // Strings.
    StringToInteger {
        source: Start,
        dest: Target,
    },
    IntegerToString {
        source: Source,
        dest: Start,
    },
    Concatenate {
        a: Start,
        b: Start,
        dest: Start,
    },
    Extract {
        source: Start,
        index: Source,
        number: Source,
        dest: Start,
    },
    Search {
        source: Start,
        index: Source,
        within: Start,
        dest: Target,
    },
    // Ports and messages.
    Port(Port),
    ClearPort {
        channel: u16,
        transmit: bool,
        receive: bool,
    },
    Message(Message),
    // Processor.
    ImmediateInput {
        first: u32,
        words: u32,
        mask: Source,
    },
    ImmediateOutput {
        first: u32,
        words: u32,
        mask: Source,
    },
    Refresh,
    Service,
    InterruptMask {
        change: MaskChange,
        types: Source,
    },
    TimedStart {
        file: Option<Source>,
        time: Source,
    },
    TimedEnable(bool),
    EventInterrupts {
        change: MaskChange,
        slots: Source,
    },
    Pid {
        at: Start,
        process: Source,
        control: Target,
        present: Source,
        slot: u32,
    },
    HighSpeedLoad {
        counter: u16,
        values: [Source; 4],
    },
    HighSpeedReset {
        counter: u16,
        source: Source,
    },
    HighSpeedCounter {
        word: u32,
    },
    /// A pulse output: nothing of it is visible to the program.
    Pulse,
    ClockRead {
        dest: Target,
    },
    ClockDifference {
        start: Source,
        stop: Source,
        dest: Target,
    },
    ClockAdjust {
        slot: u32,
    },

    Idle,
    /// Executing it is fault 0031.
    Unsupported,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unary {
    Move,
    Not,
    Negate,
    Absolute,
    SquareRoot,
    Decode,
    Encode,
    GrayCode,
    Function(Function),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    And,
    Or,
    Xor,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MaskChange {
    Disable,
    Enable,
    Flush,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PortAction {
    TestLine,
    CountCharacters,
    Read,
    ReadLine,
    Write,
    WriteAppend,
    Handshake,
}

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
