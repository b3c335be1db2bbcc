//! One program under a person's hands: run, paused, stepped, gone back in, forced, recorded.
//!
//! A [`Workbench`] owns the machine and everything that is done to it, and knows no thread, clock or
//! browser: whoever drives it says when a scan is due. [`crate::engine`] does so in real time.

mod change;
mod do_more;
pub mod flow;
mod history;
pub mod pair;
mod record;
mod state;
mod subject;
mod tape;
pub mod trend;

use std::time::Duration;

use analysis::proof::AnySide;
use ladder::Value;
use sim::scenario::{Literal, Scenario, play, value_for};

use crate::plant::Plant;
pub use change::{Change, ModeChange};
pub use do_more::DoMore;
pub use flow::Flow;
pub use history::{History, Kept};
pub use pair::Pair;
pub use record::{Recorder, Subject as Recorded};
pub use state::State;
pub use subject::{Point, Slc, Subject};
pub use tape::Tape;
use trend::Trace;

/// Snapshots a person can keep.
const SNAPSHOTS: usize = 32;

/// Shortest and longest scan that can be asked for.
pub const SCAN: (Duration, Duration) = (Duration::from_micros(100), Duration::from_secs(10));

/// A program on the workbench.
pub struct Workbench {
    state: State,
    /// The machine with the data of the project, in program mode.
    initial: Box<dyn Subject>,
    /// The plant as it was when it was wired.
    wired: Option<Box<Plant>>,
    history: History,
    flow: Flow,
    /// Simulated time from one scan to the next.
    scan: Duration,
    snapshots: Vec<(String, State)>,
    recorder: Option<Recorder>,
    traces: Vec<Trace>,
    /// What is played, scan by scan, since the history began.
    tape: Option<Tape>,
}

/// A comparison that ends a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// Address whose value is looked at after every scan.
    pub address: String,
    /// How it is compared.
    pub relation: Relation,
    /// With what.
    pub value: f64,
}

/// How two numbers are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// They are equal.
    Equal,
    /// They are not.
    NotEqual,
    /// The first is less.
    Less,
    /// The first is less or equal.
    AtMost,
    /// The first is greater.
    Greater,
    /// The first is greater or equal.
    AtLeast,
}

impl Relation {
    /// Whether it holds.
    pub fn holds(self, a: f64, b: f64) -> bool {
        match self {
            Relation::Equal => a == b,
            Relation::NotEqual => a != b,
            Relation::Less => a < b,
            Relation::AtMost => a <= b,
            Relation::Greater => a > b,
            Relation::AtLeast => a >= b,
        }
    }
}

impl Workbench {
    /// A machine in program mode.
    pub fn new(machine: Box<dyn Subject>) -> Workbench {
        let initial = machine.fork();
        let state = State::new(machine);
        Workbench {
            initial,
            wired: None,
            history: History::new(&state),
            flow: state.machine.flow(),
            state,
            scan: Duration::from_millis(10),
            snapshots: Vec::new(),
            recorder: None,
            traces: Vec::new(),
            tape: None,
        }
    }

    /// The machine as it stands, with its forces.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Power flow of the last scan that was watched.
    pub fn flow(&self) -> &Flow {
        &self.flow
    }

    /// Simulated time from one scan to the next.
    pub fn scan_time(&self) -> Duration {
        self.scan
    }

    /// Sets the simulated time from one scan to the next, in whole microseconds, which is what scenarios know.
    ///
    /// # Errors
    /// It is outside [`SCAN`].
    pub fn set_scan_time(&mut self, scan: Duration) -> Result<(), String> {
        if scan < SCAN.0 || scan > SCAN.1 {
            return Err(format!("expected a time between scans from {:?} to {:?}, found {scan:?}", SCAN.0, SCAN.1));
        }
        self.state.machine.takes_scan_time(scan)?;
        self.scan = Duration::from_micros(u64::try_from(scan.as_micros()).unwrap_or(u64::MAX));
        Ok(())
    }

    /// Scans that can be gone back.
    pub fn depth(&self) -> u64 {
        self.history.depth()
    }

    /// How much of the past is held.
    pub fn kept(&self) -> Kept {
        self.history.kept()
    }

    /// Runs one scan; `watched` notes its power flow. `false`: the machine does not execute or the tape has ended,
    /// nothing was done.
    pub fn scan(&mut self, watched: bool) -> bool {
        let usual = match &self.tape {
            None => self.scan,
            Some(tape) => {
                let Some(next) = tape.get(self.history.end()) else { return false };
                // Going back to this scan undid what was done before the one that follows.
                for change in &next.changes {
                    // What the tape writes was found when it was read.
                    if self.state.apply(change).is_ok() {
                        self.history.changed(change.clone(), &self.state);
                    }
                }
                next.dt
            }
        };
        let Some(scanned) = self.state.scan(usual, watched.then_some(&mut self.flow)) else { return false };
        self.history.scanned(usual, &self.state);
        if let Some(recorder) = &mut self.recorder {
            let written = !scanned.written.is_empty();
            for (address, value) in scanned.written {
                recorder.changed(&Change::Write { address, value });
            }
            if written {
                recorder.forced(&self.state);
            }
            recorder.scanned(scanned.dt);
            recorder.stopped(self.state.machine.controller().stopped().as_ref());
        }
        let controller = self.state.machine.controller();
        let now = u64::try_from(controller.now().as_nanos()).unwrap_or(u64::MAX);
        for trace in &mut self.traces {
            if let Some(value) = controller.read(&trace.address).ok().and_then(|value| trend::number(&value)) {
                trace.note(controller.scans(), now, value);
            }
        }
        true
    }

    /// Makes a change.
    ///
    /// # Errors
    /// Why it cannot be made, in words; nothing has changed then.
    pub fn change(&mut self, mut change: Change) -> Result<(), String> {
        if self.tape.is_some() {
            return Err("a tape is being played: it must be left before anything is changed by hand".to_owned());
        }
        // The key already stands there.
        if let Change::Mode(mode) = &change
            && mode.name() == Some(self.state.machine.mode())
        {
            return Ok(());
        }
        if let Change::Write { address, .. } | Change::Force { address, .. } = &mut change {
            *address = self.state.machine.changeable(address)?;
        }
        self.state.apply(&change)?;
        if let Change::Plant(plant) = &change {
            self.wired.clone_from(plant);
        }
        if let Some(recorder) = &mut self.recorder {
            recorder.changed(&change);
            recorder.forced(&self.state);
            recorder.stopped(self.state.machine.controller().stopped().as_ref());
        }
        self.history.changed(change, &self.state);
        Ok(())
    }

    /// Writes a value as a person spells it.
    ///
    /// # Errors
    /// There is no such address, or the value does not fit there.
    pub fn write(&mut self, address: &str, literal: &Literal) -> Result<(), String> {
        let present = self.state.machine.controller().read(address)?;
        let value = value_for(literal, &present)?;
        kept(literal, &value)?;
        self.change(Change::Write { address: address.to_owned(), value })
    }

    /// Goes back so many scans, or as many as are kept; answers how many.
    ///
    /// # Errors
    /// A recording is in progress, which can only go forward.
    pub fn back(&mut self, scans: u64) -> Result<u64, String> {
        self.not_recording("going back")?;
        let gone = self.history.back(scans, &mut self.state, &mut self.flow);
        let scan = self.state.machine.controller().scans();
        self.traces.iter_mut().for_each(|trace| trace.back_to(scan));
        Ok(gone)
    }

    fn not_recording(&self, what: &str) -> Result<(), String> {
        match self.recorder {
            Some(_) => Err(format!("a recording is in progress: it must end before {what}")),
            None => Ok(()),
        }
    }

    /// Begins again with the data of the project, in program mode, without forces and with the plant as it was when
    /// it was wired. Snapshots stay; traces go on from here.
    ///
    /// # Errors
    /// A recording is in progress.
    pub fn restart(&mut self) -> Result<(), String> {
        self.not_recording("beginning again")?;
        let mut state = State::new(self.initial.fork());
        state.plant = self.wired.as_deref().cloned();
        self.go_on_from(state);
        Ok(())
    }

    /// Begins again as [`Workbench::restart`] does, without a plant, and plays a tape from now on: every scan is the
    /// next one of the tape.
    ///
    /// # Errors
    /// A recording is in progress.
    pub fn play(&mut self, tape: Tape) -> Result<(), String> {
        self.not_recording("a tape")?;
        self.go_on_from(State::new(self.initial.fork()));
        self.tape = Some(tape);
        Ok(())
    }

    /// The tape that is played, and how many of its scans have run.
    pub fn tape(&self) -> Option<(&Tape, u64)> {
        self.tape.as_ref().map(|tape| (tape, self.history.end()))
    }

    /// Goes on by hand from where the tape is.
    pub fn leave_tape(&mut self) {
        self.tape = None;
    }

    /// The machine with the data of the project, in program mode.
    pub fn initial(&self) -> &dyn Subject {
        self.initial.as_ref()
    }

    fn go_on_from(&mut self, state: State) {
        self.tape = None;
        self.state = state;
        self.history = History::new(&self.state);
        self.flow = self.state.machine.flow();
        self.traces.iter_mut().for_each(|trace| *trace = Trace::new(trace.address.clone()));
    }

    /// Names of the snapshots.
    pub fn snapshots(&self) -> impl Iterator<Item = &str> {
        self.snapshots.iter().map(|(name, _)| name.as_str())
    }

    /// Keeps the state under a name; one that stands there is replaced.
    ///
    /// # Errors
    /// There are too many already.
    pub fn keep(&mut self, name: &str) -> Result<(), String> {
        self.snapshots.retain(|(other, _)| other != name);
        if self.snapshots.len() >= SNAPSHOTS {
            return Err(format!("expected at most {SNAPSHOTS} snapshots, found another one"));
        }
        self.snapshots.push((name.to_owned(), self.state.fork()));
        Ok(())
    }

    /// Goes on from a snapshot; what was before it cannot be gone back to.
    ///
    /// # Errors
    /// There is none of that name, or a recording is in progress.
    pub fn resume(&mut self, name: &str) -> Result<(), String> {
        self.not_recording("going to a snapshot")?;
        let found = self.snapshots.iter().find(|(other, _)| other == name).map(|(_, state)| state.fork());
        self.go_on_from(found.ok_or_else(|| format!("there is no snapshot `{name}`"))?);
        Ok(())
    }

    /// Follows these values from now on.
    ///
    /// # Errors
    /// There is no such address, it holds no number, or there are more than [`trend::TRACES`].
    pub fn follow(&mut self, addresses: &[String]) -> Result<(), String> {
        if addresses.len() > trend::TRACES {
            return Err(format!("expected at most {} traces, found {}", trend::TRACES, addresses.len()));
        }
        for address in addresses {
            let value = self.state.machine.controller().read(address)?;
            trend::number(&value).ok_or_else(|| format!("{address} is no number or bit"))?;
        }
        let mut traces = std::mem::take(&mut self.traces);
        let old = |address: &String| traces.iter().position(|trace| trace.address == *address);
        let chosen: Vec<_> = addresses.iter().map(|address| (address, old(address))).collect();
        self.traces = chosen
            .into_iter()
            .map(|(address, old)| match old.and_then(|at| traces.get_mut(at)) {
                Some(trace) => std::mem::replace(trace, Trace::new(String::new())),
                None => Trace::new(address.clone()),
            })
            .collect();
        Ok(())
    }

    /// The values followed.
    pub fn traces(&self) -> &[Trace] {
        &self.traces
    }

    /// A condition holds now.
    ///
    /// # Errors
    /// There is no such address, or it holds no number.
    pub fn holds(&self, condition: &Condition) -> Result<bool, String> {
        let value = self.state.machine.controller().read(&condition.address)?;
        let number = trend::number(&value).ok_or_else(|| format!("{} is no number or bit", condition.address))?;
        Ok(condition.relation.holds(number, condition.value))
    }

    /// Begins a recording, from the data of the project: that is where a scenario begins. The machine is in run
    /// mode then and has not scanned.
    ///
    /// # Errors
    /// A recording is in progress.
    pub fn record(&mut self) -> Result<(), String> {
        self.restart()?;
        self.change(Change::Mode(ModeChange::Run))?;
        // Of two programs the original is recorded, which is one of RSLogix 500.
        self.recorder = Some(Recorder::new(!matches!(self.state.machine.side(), Some(AnySide::DoMore(_)))));
        Ok(())
    }

    /// The recording in progress.
    pub fn recorder(&self) -> Option<&Recorder> {
        self.recorder.as_ref()
    }

    /// Notes in the recording that these addresses must hold what they hold now.
    ///
    /// # Errors
    /// There is no recording, or no such address.
    pub fn expect(&mut self, addresses: &[String]) -> Result<(), String> {
        let recorder = self.recorder.as_mut().ok_or("there is no recording in progress")?;
        let controller = self.state.machine.controller();
        let pair = self.state.machine.pair();
        // A scenario is one program's: of two it is the original's.
        let own = |address: &String| pair.map_or_else(|| Ok(address.clone()), |pair| pair.own(address));
        let read = |address: &String| Ok((own(address)?, controller.read(address)?));
        recorder.expect(addresses.iter().map(read).collect::<Result<Vec<_>, String>>()?);
        Ok(())
    }

    /// Ends the recording and answers it as a scenario, with what a replay of it on a fresh machine found: nothing if
    /// all expectations are met there too.
    ///
    /// # Errors
    /// There is no recording.
    pub fn recorded(&mut self, subject: &Recorded) -> Result<(String, Vec<String>), String> {
        let recorder = self.recorder.take().ok_or("there is no recording in progress")?;
        let text = recorder.to_text(subject);
        let mut problems: Vec<String> = recorder.notes().map(ToOwned::to_owned).collect();
        let mut machine = self.initial.fork();
        match Scenario::parse(&text) {
            Err(why) => problems.push(format!("the scenario does not read back: {why}")),
            Ok(scenario) => match play(&scenario, machine.controller_mut(), Vec::new()) {
                Err(why) => problems.push(format!("the scenario does not play: {why}")),
                Ok(report) => problems.extend(report.failures.iter().map(|failure| format!("replayed: {failure}"))),
            },
        }
        Ok((text, problems))
    }
}

/// A person must find there what was typed: numbers that a word or float would hold as another one are refused. Scenarios
/// may spell the bits of a word without a sign, and a person can in hex.
fn kept(literal: &Literal, value: &Value) -> Result<(), String> {
    let integer = |least: i64, most: i64, held: i64| match literal {
        Literal::Integer(typed) if *typed != held => {
            Err(format!("expected a whole number from {least} to {most}, or bits in hex, found {typed}"))
        }
        _ => Ok(()),
    };
    match value {
        Value::Word(word) => integer(i16::MIN.into(), i16::MAX.into(), (*word).into()),
        Value::Long(long) => integer(i32::MIN.into(), i32::MAX.into(), (*long).into()),
        Value::Float(float) if float.is_infinite() => match literal {
            Literal::Float(typed) if typed.is_infinite() => Ok(()),
            Literal::Text(typed) if typed.to_ascii_lowercase().contains("inf") => Ok(()),
            _ => Err(format!("expected a number from {:?} to {:?}, found {literal}", f32::MIN, f32::MAX)),
        },
        _ => Ok(()),
    }
}
