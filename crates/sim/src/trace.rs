//! Watching power flow.

/// Power at one instruction in one execution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PowerFlow {
    /// Program file.
    pub file: u16,
    /// Rung, from 0.
    pub rung: u16,
    /// Instruction in the rung, from 0, in stored order.
    pub instruction: u16,
    /// Power reaches it.
    pub before: bool,
    /// It passes power on.
    pub after: bool,
}

/// Receives the power flow of the rungs it wants.
pub trait Trace {
    /// Whether this rung is of interest; asked at every instruction.
    fn wants(&self, file: u16, rung: u16) -> bool;
    /// An instruction of such a rung was executed.
    fn flow(&mut self, flow: PowerFlow);
}

/// Collects everything of the chosen rungs; all rungs when none is chosen.
#[derive(Clone, Debug, Default)]
pub struct Recorder {
    /// Rungs to watch, as file and rung.
    pub rungs: Vec<(u16, u16)>,
    /// What was seen, in order of execution.
    pub seen: Vec<PowerFlow>,
}

impl Trace for Recorder {
    fn wants(&self, file: u16, rung: u16) -> bool {
        self.rungs.is_empty() || self.rungs.contains(&(file, rung))
    }

    fn flow(&mut self, flow: PowerFlow) {
        self.seen.push(flow);
    }
}
