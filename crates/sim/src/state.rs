//! Everything that changes while a program runs.

use crate::core::discrete::DiscreteInput;
use crate::core::fast::FastCounter;
use crate::fault::MajorFault;
use crate::machine::Mode;
use crate::op::Compiled;

/// What a timer element has beside its three words.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TimerSlot {
    /// Time of the last execution, in nanoseconds.
    pub(crate) last: u64,
    /// Part of a tick gathered so far, in nanoseconds.
    pub(crate) part: u64,
    /// Not executed since entering run.
    pub(crate) fresh: bool,
}

/// What a PID instruction keeps between executions: the time of the last one and the loop's memory.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PidSlot {
    pub(crate) last: u64,
    pub(crate) memory: instr::exec::process::Loop,
}

/// A message or ASCII operation under way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct MessageSlot {
    pub(crate) started: u64,
    pub(crate) active: bool,
}

/// The selectable timed interrupt.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TimedInterrupt {
    /// Time of the next expiry; meaningful while `period` is not 0.
    pub(crate) next: u64,
    /// Running period in nanoseconds, 0 while it is off.
    pub(crate) period: u64,
    /// The enable bit as it was last taken over.
    pub(crate) enabled: bool,
    /// 1 ms units, taken over on entering run.
    pub(crate) fine: bool,
    /// The routine is executing.
    pub(crate) executing: bool,
}

/// Machine state: plain data.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct State {
    pub(crate) mem: Vec<u16>,
    /// What the input terminals carry, one word per word of file I.
    pub(crate) inputs: Vec<u16>,
    /// What the output terminals carry, one word per word of file O.
    pub(crate) outputs: Vec<u16>,
    pub(crate) input_forces: Vec<(u16, u16)>,
    pub(crate) output_forces: Vec<(u16, u16)>,
    pub(crate) timers: Vec<TimerSlot>,
    pub(crate) pids: Vec<PidSlot>,
    pub(crate) messages: Vec<MessageSlot>,
    pub(crate) adjusts: Vec<bool>,
    /// Simulated time since the machine was made, in nanoseconds.
    pub(crate) now: u64,
    pub(crate) scans: u64,
    /// Instructions executed so far.
    pub(crate) executed: u64,
    /// `executed` may reach this before the watchdog trips.
    pub(crate) limit: u64,
    pub(crate) mode: Mode,
    pub(crate) fault: Option<MajorFault>,
    /// The box that is executing, by its operation.
    pub(crate) acting: u32,
    /// The operation that set the first bit of S:5 that stops the processor at the end of the scan.
    pub(crate) minor_by: Option<u32>,
    /// Part of a count of S:4, and of a second of the clock, in nanoseconds.
    pub(crate) clock_part: u64,
    pub(crate) second_part: u64,
    /// Time since the last scan began.
    pub(crate) since_scan: u64,
    pub(crate) timed: TimedInterrupt,
    /// A waiting interrupt was enabled: it runs at the next rung.
    pub(crate) due: bool,
    /// Waiting interrupts per source of function files.
    pub(crate) events: [u8; 8],
    /// First word of input terminals as the event interrupts saw it last.
    pub(crate) event_inputs: u16,
    /// The discrete input interrupt.
    pub(crate) discrete: DiscreteInput,
    /// High-speed counters.
    pub(crate) fast: [FastCounter; 6],
    /// Indirect addresses that left their file, so far.
    pub(crate) strays: u64,
    /// Buffer of instructions that need copies of files; empty between instructions.
    pub(crate) scratch: Vec<u16>,
}

impl State {
    pub(crate) fn new(program: &Compiled) -> State {
        let (first, count) = program.inputs;
        let inputs = program.data.get(first..first + count).unwrap_or_default().to_vec();
        State {
            mem: program.data.clone(),
            inputs,
            outputs: vec![0; program.outputs.1],
            input_forces: program.input_forces.clone(),
            output_forces: program.output_forces.clone(),
            timers: vec![TimerSlot::default(); program.timers],
            pids: vec![PidSlot::default(); program.pids],
            messages: vec![MessageSlot::default(); program.messages],
            adjusts: vec![false; program.adjusts],
            now: 0,
            scans: 0,
            executed: 0,
            limit: 0,
            mode: Mode::Program,
            fault: None,
            acting: 0,
            minor_by: None,
            clock_part: 0,
            second_part: 0,
            since_scan: 0,
            timed: TimedInterrupt::default(),
            due: false,
            events: [0; 8],
            event_inputs: 0,
            discrete: DiscreteInput::default(),
            fast: [FastCounter::default(); 6],
            strays: 0,
            scratch: Vec::with_capacity(if program.needs_scratch() { 3 * program.data.len() } else { 0 }),
        }
    }

    /// Takes over all of another state in the memory this one has.
    pub(crate) fn copy_from(&mut self, other: &State) {
        // Named one by one, so that a new field cannot be forgotten.
        let State {
            mem,
            inputs,
            outputs,
            input_forces,
            output_forces,
            timers,
            pids,
            messages,
            adjusts,
            now,
            scans,
            executed,
            limit,
            mode,
            fault,
            acting,
            minor_by,
            clock_part,
            second_part,
            since_scan,
            timed,
            due,
            events,
            event_inputs,
            discrete,
            fast,
            strays,
            scratch: _,
        } = other;
        self.mem.clone_from(mem);
        self.inputs.clone_from(inputs);
        self.outputs.clone_from(outputs);
        self.input_forces.clone_from(input_forces);
        self.output_forces.clone_from(output_forces);
        self.timers.clone_from(timers);
        self.pids.clone_from(pids);
        self.messages.clone_from(messages);
        self.adjusts.clone_from(adjusts);
        self.now = *now;
        self.scans = *scans;
        self.executed = *executed;
        self.limit = *limit;
        self.mode = *mode;
        self.fault = *fault;
        self.acting = *acting;
        self.minor_by = *minor_by;
        self.clock_part = *clock_part;
        self.second_part = *second_part;
        self.since_scan = *since_scan;
        self.timed = *timed;
        self.due = *due;
        self.events = *events;
        self.event_inputs = *event_inputs;
        self.discrete = *discrete;
        self.fast = *fast;
        self.strays = *strays;
    }
}
