//! A machine: a program with its data, time and surroundings.

use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use crate::shared::{nanoseconds, steps};

use crate::core::{Core, NoWatch};
use crate::op::Compiled;
use crate::peer::{NoPeer, Peer};
use crate::state::State;
use crate::trace::Trace;
use crate::{MajorFault, Program};

/// What the processor does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// The program is not executed, outputs are off.
    #[default]
    Program,
    /// The program is executed.
    Run,
    /// The program is executed, the output terminals stay off.
    Test,
    /// Stopped by SUS.
    Suspend,
    /// Stopped by a major fault.
    Fault,
}

impl Mode {
    /// The mode code of S:1, where the mode has one of its own.
    pub(crate) fn code(self) -> Option<u16> {
        match self {
            Mode::Program => Some(1),
            Mode::Run => Some(6),
            Mode::Test => Some(7),
            Mode::Suspend => Some(3),
            Mode::Fault => None,
        }
    }
}

/// What one scan did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScanReport {
    /// The mode after it.
    pub mode: Mode,
    /// Instructions it executed, interrupt and fault routines included.
    pub instructions: u64,
}

/// A simulated controller.
pub struct Machine {
    pub(crate) program: Arc<Compiled>,
    pub(crate) state: State,
    peer: Box<dyn Peer + Send + Sync>,
}

impl fmt::Debug for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Machine")
            .field("family", &self.program.family)
            .field("mode", &self.state.mode)
            .field("scans", &self.state.scans)
            .field("fault", &self.state.fault)
            .finish_non_exhaustive()
    }
}

impl Machine {
    /// A controller in program mode with the data of the image.
    pub fn new(program: Program) -> Machine {
        let program = program.compiled;
        let state = State::new(&program);
        Machine { program, state, peer: Box::new(NoPeer) }
    }

    /// Connects a partner for messages and serial ports; [`NoPeer`] until then.
    pub fn connect(&mut self, peer: Box<dyn Peer + Send + Sync>) {
        self.peer = peer;
    }

    pub(crate) fn core(&mut self) -> Core<'_> {
        Core { p: &self.program, s: &mut self.state, peer: &mut *self.peer }
    }

    /// Goes to run mode as from the key switch: prescan, then first pass (S:1/15) in the next scan. A
    /// fault is cleared first; S:5 and S:6 keep their values. Going to run can fault itself (labels,
    /// STI set-up): see [`Machine::fault`].
    pub fn enter_run(&mut self) {
        self.core().enter_run(Mode::Run);
    }

    /// Goes to continuous test mode: as run, but the output terminals stay off.
    pub fn enter_test(&mut self) {
        self.core().enter_run(Mode::Test);
    }

    /// Goes on where a running controller was when its data was saved: no prescan, no first pass,
    /// timers count from now. For programs stored while they ran.
    pub fn resume(&mut self) {
        let mut core = self.core();
        core.s.fault = None;
        core.set_mode(Mode::Run);
        let now = core.s.now;
        core.s.timers.iter_mut().for_each(|timer| timer.last = now);
        core.enter_run_interrupts();
    }

    /// Goes to program mode: outputs off, data kept.
    pub fn enter_program(&mut self) {
        self.core().stop(Mode::Program);
    }

    /// Time passes, then one scan runs: inputs, program from file 2, outputs, housekeeping. Timed
    /// interrupts that expire in this time run first, each at its own moment. In a mode that does not
    /// execute only time passes. The first scan after entering run usually has `dt` 0.
    pub fn scan(&mut self, dt: Duration) -> ScanReport {
        self.scan_watched(dt, &mut NoWatch)
    }

    /// As [`Machine::scan`], with the power flow of chosen rungs.
    pub fn scan_traced(&mut self, dt: Duration, trace: &mut dyn Trace) -> ScanReport {
        let mut watch = trace;
        self.scan_watched(dt, &mut watch)
    }

    fn scan_watched<W: crate::core::Watch>(&mut self, dt: Duration, watch: &mut W) -> ScanReport {
        let before = self.state.executed;
        let mut core = self.core();
        core.advance(nanoseconds(dt), watch);
        core.scan(watch);
        ScanReport { mode: self.state.mode, instructions: self.state.executed - before }
    }

    /// Time passes without a scan: clocks move, timed interrupts run.
    pub fn advance(&mut self, dt: Duration) {
        self.core().advance(nanoseconds(dt), &mut NoWatch);
    }

    /// Pulses at high-speed counter `counter` of a MicroLogix 1100 to 1500, negative ones down. `false`:
    /// there is no such counter, or it does not count now.
    pub fn pulses(&mut self, counter: usize, count: i32) -> bool {
        self.core().refill();
        self.core().pulses(counter, count, &mut NoWatch)
    }

    /// An event at event input interrupt `number` of a MicroLogix 1100 to 1500. `false`: there is none.
    pub fn event(&mut self, number: usize) -> bool {
        self.core().refill();
        self.core().event(number, &mut NoWatch)
    }

    /// Scans of length `step` until `time` has passed, the last one shorter if it does not fit. Ends
    /// early when the controller stops. Returns the number of scans.
    pub fn run_for(&mut self, time: Duration, step: Duration) -> u64 {
        let mut scans = 0;
        for dt in steps(time, step) {
            if !self.is_executing() {
                break;
            }
            self.scan(dt);
            scans += 1;
        }
        scans
    }

    /// The mode.
    pub fn mode(&self) -> Mode {
        self.state.mode
    }

    /// The program is executed: run or test mode.
    pub fn is_executing(&self) -> bool {
        matches!(self.state.mode, Mode::Run | Mode::Test)
    }

    /// The major fault the controller stopped with.
    pub fn fault(&self) -> Option<MajorFault> {
        self.state.fault
    }

    /// Time that has passed since the machine was made.
    pub fn now(&self) -> Duration {
        Duration::from_nanos(self.state.now)
    }

    /// How long from now until the timed interrupt expires next, and its period; `None` while none is running.
    pub fn timed_interrupt(&self) -> Option<(Duration, Duration)> {
        let timed = &self.state.timed;
        let left = timed.next.saturating_sub(self.state.now);
        (timed.period > 0).then(|| (Duration::from_nanos(left), Duration::from_nanos(timed.period)))
    }

    /// Scans since the machine was made.
    pub fn scans(&self) -> u64 {
        self.state.scans
    }

    /// Instructions executed since the machine was made.
    pub fn instructions(&self) -> u64 {
        self.state.executed
    }

    /// How many times an indirect address left its file and reached other data, which MicroLogix 1100
    /// to 1500 allow.
    pub fn strays(&self) -> u64 {
        self.state.strays
    }

    /// The program this machine runs.
    pub fn family(&self) -> ladder::Family {
        self.program.family
    }

    /// A second machine in the same state. It has no partner on the network, see [`Machine::connect`].
    pub fn fork(&self) -> Machine {
        Machine { program: Arc::clone(&self.program), state: self.state.clone(), peer: Box::new(NoPeer) }
    }

    /// Takes over the state of another machine with the same program, without allocating. `false`: it
    /// runs another program; nothing has changed then.
    pub fn copy_from(&mut self, other: &Machine) -> bool {
        let same = Arc::ptr_eq(&self.program, &other.program);
        if same {
            self.state.copy_from(&other.state);
        }
        same
    }

    /// The whole state as bytes of a stable form.
    pub fn save(&self) -> Vec<u8> {
        crate::snapshot::save(&self.program, &self.state)
    }

    /// Takes over a state saved from a machine with the same program.
    ///
    /// # Errors
    /// The bytes are no saved state, or one of another program. The machine is unchanged then.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), crate::RestoreError> {
        self.state = crate::snapshot::restore(&self.program, bytes)?;
        Ok(())
    }
}
