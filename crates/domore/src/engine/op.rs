//! What a program compiles to: operations whose elements are places in memory, in the order of the text.

use crate::counter::CounterKind;
use crate::instruction::{Join, Relation};
use crate::math::{Formula, IndexedPlace};
use crate::memory::{Map, Num, Place};
use crate::timer::TimerKind;

/// One operation. What does not fit a few bytes stands in the tables of [`Compiled`].
#[derive(Clone, Copy, Debug)]
pub(crate) enum Op {
    /// A rung begins: the stack is empty.
    Rung,
    Push(u32),
    PushNot(u32),
    And(u32),
    AndNot(u32),
    Or(u32),
    OrNot(u32),
    /// Power without a contact.
    Power,
    /// A bit that is found by index.
    Indexed {
        join: Join,
        negated: bool,
        place: u32,
    },
    Edge {
        join: Join,
        rise: bool,
        bit: u32,
        memory: u32,
    },
    Change {
        join: Join,
        source: u32,
        memory: u32,
    },
    Compare {
        join: Join,
        compare: u32,
    },
    Series,
    Parallel,
    Invert,
    FlowEdge {
        rise: bool,
        memory: u32,
    },
    Duplicate,
    Drop,
    Out(u32),
    OrOut {
        bit: u32,
        memory: u32,
    },
    Set(u32),
    Reset(u32),
    ResetRange {
        first: u32,
        last: u32,
    },
    Pulse {
        rise: bool,
        bit: u32,
        memory: u32,
    },
    Timer(u32),
    Counter(u32),
    ResetTimer(u32),
    ResetCounter(u32),
    Move(u32),
    Math(u32),
    Step {
        add: i8,
        target: u32,
    },
    Box(u32),
    Call(u32),
    Return,
    ReturnIf,
    Control(Action, u32),
    Exit,
    Stage(u32),
    Jump {
        stage: u32,
        own: Option<u32>,
    },
    StageBits {
        first: u32,
        last: u32,
        on: bool,
    },
    For(u32),
    Next(u32),
    Until {
        place: u32,
        start: u32,
    },
    Nothing,
    /// An instruction that is not modelled: the machine stops when it has power.
    Unsupported,
}

/// What is done to another program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Action {
    Run,
    Halt,
    Restart,
    Suspend,
}

/// Where a number comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Source {
    Constant(Num),
    Place(Place),
    Indexed(u32),
}

/// Where a number goes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Target {
    Place(Place),
    Indexed(u32),
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Comparison {
    pub(crate) relation: Relation,
    pub(crate) a: Source,
    pub(crate) b: Source,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct TimerBox {
    pub(crate) kind: TimerKind,
    /// First bit of the structure.
    pub(crate) bit: u32,
    pub(crate) preset: Source,
    pub(crate) output: Option<u32>,
    /// Which reset memory the structure has.
    pub(crate) structure: u32,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct CounterBox {
    pub(crate) kind: CounterKind,
    pub(crate) bit: u32,
    pub(crate) preset: Option<Source>,
    pub(crate) down_preset: Option<Source>,
    pub(crate) structure: u32,
    /// Edge memories of the count legs.
    pub(crate) edges: [u32; 2],
}

/// RSTT or RSTCT: a structure and the box that owns it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StructureReset {
    pub(crate) bit: u32,
    pub(crate) structure: u32,
    pub(crate) owner: Option<u32>,
}

/// Elements in a row.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Span {
    /// First element, bits from one to the next, how many there are up to the end of the block.
    Fixed {
        first: Place,
        stride: u32,
        room: u32,
    },
    /// The first one found by index.
    Indexed {
        first: u32,
        stride: u32,
        end: u32,
    },
    Constant(Num),
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct CopyRow {
    pub(crate) from: Span,
    pub(crate) to: Span,
    pub(crate) count: Source,
}

/// Boxes that are rarer or larger.
#[derive(Clone, Debug)]
pub(crate) enum BoxCode {
    Copy(Vec<CopyRow>),
    /// Bits copied as they are.
    RawCopy {
        from: Span,
        to: Span,
        count: Source,
    },
    /// Ranges written with a value.
    Fill(Vec<(Place, u32, u32, Source)>),
    /// Bits cleared: first, how many per element, room, count.
    Clear {
        first: u32,
        stride: u32,
        room: u32,
        count: Source,
    },
    /// Pieces of text one behind the other, into a string.
    Print {
        pieces: Vec<Piece>,
        to: Place,
    },
    Scale {
        values: [Source; 5],
        to: Target,
    },
    Clamp {
        values: [Source; 3],
        to: Target,
    },
    Filter {
        factor: Source,
        input: Source,
        output: Target,
    },
    /// ON and OFF times, output, memory.
    Flasher {
        times: [Source; 2],
        output: u32,
        memory: u32,
    },
    Debounce {
        times: [Source; 2],
        output: u32,
        memory: u32,
    },
    TimedOut {
        time: Source,
        output: u32,
        memory: u32,
    },
}

/// A piece of text.
#[derive(Clone, Debug)]
pub(crate) enum Piece {
    Literal(Vec<u8>),
    /// A string.
    Text(Place),
}

#[derive(Clone, Debug)]
pub(crate) struct CallCode {
    pub(crate) block: u32,
    pub(crate) inputs: Vec<CopyRow>,
    pub(crate) outputs: Vec<CopyRow>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct ForCode {
    pub(crate) variable: Target,
    pub(crate) from: Source,
    pub(crate) to: Source,
    pub(crate) step: Source,
    /// The operation of its NEXT.
    pub(crate) next: u32,
    /// The operation behind FOR.
    pub(crate) body: u32,
    /// How many loops of the same block stand around it.
    pub(crate) level: usize,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct StageCode {
    pub(crate) bit: u32,
    /// The operations up to the next stage or the end of the block.
    pub(crate) start: u32,
    pub(crate) end: u32,
}

/// When a code block runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Runs {
    /// While its program is enabled; `$Main` is from the start.
    Enabled { from_start: bool },
    /// When called.
    Called,
    /// In the first scan.
    FirstScan,
    /// Each time so many nanoseconds have passed.
    Every(u64),
    /// Never: nothing that is modelled starts it.
    Never,
}

#[derive(Clone, Debug)]
pub(crate) struct BlockCode {
    pub(crate) name: String,
    pub(crate) runs: Runs,
    pub(crate) start: u32,
    pub(crate) end: u32,
    /// First of its stage bits.
    pub(crate) stages: u32,
    /// The stage that is active when it starts.
    pub(crate) first_stage: Option<u32>,
    /// Rungs it has.
    pub(crate) rungs: u32,
}

/// Where an operation stands: block, rung, instruction.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spot {
    pub(crate) block: u32,
    pub(crate) rung: u32,
    pub(crate) instruction: u32,
}

/// A block that the I/O scan fills.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Input {
    /// First byte of its image in all memory.
    pub(crate) image: usize,
    /// First byte among the terminals.
    pub(crate) terminal: usize,
    pub(crate) bytes: usize,
}

/// How many memories of each sort the operations need.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Counts {
    pub(crate) edges: u32,
    pub(crate) values: u32,
    pub(crate) structures: u32,
    pub(crate) phases: u32,
    pub(crate) or_outs: u32,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Compiled {
    pub(crate) map: Map,
    pub(crate) system: super::clock::System,
    pub(crate) inputs: Vec<Input>,
    pub(crate) ops: Vec<Op>,
    pub(crate) spots: Vec<Spot>,
    pub(crate) blocks: Vec<BlockCode>,
    pub(crate) compares: Vec<Comparison>,
    pub(crate) sources: Vec<Source>,
    pub(crate) targets: Vec<Target>,
    pub(crate) indexed: Vec<IndexedPlace>,
    pub(crate) timers: Vec<TimerBox>,
    pub(crate) counters: Vec<CounterBox>,
    pub(crate) resets: Vec<StructureReset>,
    pub(crate) moves: Vec<(Source, Target)>,
    pub(crate) maths: Vec<(Formula, Target)>,
    pub(crate) boxes: Vec<BoxCode>,
    pub(crate) calls: Vec<CallCode>,
    pub(crate) loops: Vec<ForCode>,
    pub(crate) stages: Vec<StageCode>,
    pub(crate) counts: Counts,
    pub(crate) choices: crate::choices::Choices,
    pub(crate) watchdog: u64,
    /// Tells programs apart in saved states.
    pub(crate) identity: u64,
}

impl Compiled {
    /// Where the terminals of an input lie; `None` for everything else.
    pub(crate) fn terminal(&self, place: Place) -> Option<Place> {
        let byte = (place.bit >> 3) as usize;
        let input = self.inputs.iter().find(|input| (input.image..input.image + input.bytes).contains(&byte))?;
        let bit = 8 * (byte - input.image + input.terminal) as u32 + (place.bit & 7);
        Some(Place { bit, ..place })
    }

    /// Bytes of all terminals.
    pub(crate) fn terminals(&self) -> usize {
        self.inputs.iter().map(|input| input.bytes).sum()
    }
}
