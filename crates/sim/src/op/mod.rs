//! The compiled form: a flat list of operations with addresses resolved to word and mask.

mod compiled;
mod operand;

use instr::exec::expression::Step;
use instr::exec::function::Function;
use instr::exec::stack::Order;
use ladder::{FileType, TimeBase};

pub(crate) use compiled::*;
pub(crate) use operand::*;

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
