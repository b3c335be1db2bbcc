//! What changes while a program runs.

use super::op::Compiled;
use super::{Fault, Mode};
use crate::memory::{Data, Num};

/// The memory of an edge: nothing yet, OFF, ON.
pub(crate) type EdgeMemory = u8;
pub(crate) const FRESH: EdgeMemory = 0;

/// When a timer was processed last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TimerClock {
    /// It was not enabled then, or was reset since.
    pub(crate) fresh: bool,
    /// In nanoseconds; the part of a millisecond not yet counted is behind it.
    pub(crate) last: u64,
}

/// FLASHER, DEBOUNCE, TIMEDOUT: where they are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Phase {
    pub(crate) active: bool,
    pub(crate) since: u64,
}

/// A program, subroutine or task.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct BlockState {
    pub(crate) enabled: bool,
    pub(crate) suspended: bool,
    pub(crate) restart: bool,
    /// It ran and was not terminated since.
    pub(crate) ran: bool,
    /// When a task with an interval ran last.
    pub(crate) last: u64,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct State {
    pub(crate) data: Data,
    /// What the inputs carry, which the scan copies into `data`.
    pub(crate) terminals: Data,
    /// Nanoseconds since the machine was made.
    pub(crate) now: u64,
    pub(crate) scans: u64,
    pub(crate) executed: u64,
    /// Instructions the machine may have executed by the end of the scan.
    pub(crate) limit: u64,
    pub(crate) troubles: u64,
    pub(crate) mode: Mode,
    pub(crate) fault: Option<Fault>,
    /// The next scan is the first one of run.
    pub(crate) first: bool,
    /// Seconds from the year 2000 to the clock of the controller when the machine was made.
    pub(crate) clock: i64,
    pub(crate) shown_second: i64,
    pub(crate) blocks: Vec<BlockState>,
    pub(crate) edges: Vec<EdgeMemory>,
    pub(crate) values: Vec<Option<Num>>,
    pub(crate) timers: Vec<TimerClock>,
    /// Scan, from 1, in which RSTT or RSTCT reset a structure last.
    pub(crate) resets: Vec<u64>,
    pub(crate) phases: Vec<Phase>,
    /// Scan, from 1, in which an OROUT of a bit was processed last.
    pub(crate) or_outs: Vec<u64>,
    /// Stages that ran and were not terminated since.
    pub(crate) stages: Vec<bool>,
}

impl State {
    pub(crate) fn new(program: &Compiled) -> State {
        let counts = program.counts;
        State {
            data: Data::new(program.map.bytes()),
            terminals: Data::new(program.terminals()),
            now: 0,
            scans: 0,
            executed: 0,
            limit: 0,
            troubles: 0,
            mode: Mode::Program,
            fault: None,
            first: false,
            clock: 0,
            shown_second: i64::MIN,
            blocks: vec![BlockState::default(); program.blocks.len()],
            edges: vec![FRESH; counts.edges as usize],
            values: vec![None; counts.values as usize],
            timers: vec![TimerClock { fresh: true, last: 0 }; program.timers.len()],
            resets: vec![0; counts.structures as usize],
            phases: vec![Phase::default(); counts.phases as usize],
            or_outs: vec![0; counts.or_outs as usize],
            stages: vec![false; program.stages.len()],
        }
    }

    /// Takes over another state without new allocations.
    pub(crate) fn copy_from(&mut self, other: &State) {
        // Named one by one, so that a new field cannot be forgotten.
        let State {
            data,
            terminals,
            now,
            scans,
            executed,
            limit,
            troubles,
            mode,
            fault,
            first,
            clock,
            shown_second,
            blocks,
            edges,
            values,
            timers,
            resets,
            phases,
            or_outs,
            stages,
        } = other;
        self.data.bytes_mut().copy_from_slice(data.bytes());
        self.terminals.bytes_mut().copy_from_slice(terminals.bytes());
        (self.now, self.scans, self.executed) = (*now, *scans, *executed);
        (self.limit, self.troubles) = (*limit, *troubles);
        (self.mode, self.fault, self.first) = (*mode, *fault, *first);
        (self.clock, self.shown_second) = (*clock, *shown_second);
        self.blocks.copy_from_slice(blocks);
        self.edges.copy_from_slice(edges);
        self.values.copy_from_slice(values);
        self.timers.copy_from_slice(timers);
        self.resets.copy_from_slice(resets);
        self.phases.copy_from_slice(phases);
        self.or_outs.copy_from_slice(or_outs);
        self.stages.copy_from_slice(stages);
    }
}
