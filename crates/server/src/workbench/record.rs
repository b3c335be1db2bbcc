//! What was done on the workbench, as a scenario that replays it.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::time::Duration;

use ladder::Value;
use sim::scenario::Stop;
use sim::scenario::spell::{duration, literal, quoted};

use super::change::{Change, ModeChange};
use super::state::State;
use super::subject::Point;

/// Steps of one recording, and values that are set or expected in all of them: a plant model can write every analog
/// input in every scan.
const STEPS: usize = 100_000;
const SETS: usize = 500_000;

/// A recording that began with the data of the project, in program mode.
#[derive(Clone, Debug, Default)]
pub struct Recorder {
    steps: Vec<Step>,
    /// Scans of all steps, and values set or expected in them.
    scans: u64,
    sets: usize,
    /// What a scenario cannot say, in words.
    notes: Vec<String>,
    /// Points that were forced, by name: a forced input is recorded as written.
    forced: BTreeSet<String>,
    /// Entering run changes data: what was written before must be written before it.
    prescan: bool,
    /// The controller has stopped, as far as is known.
    stopped: bool,
    full: bool,
}

#[derive(Clone, Debug, Default)]
struct Step {
    program_run: bool,
    /// What was done that is said in words besides.
    notes: Vec<String>,
    sets: Vec<(String, Value)>,
    dt: Duration,
    scans: u64,
    /// Major fault at its end.
    fault: Option<u16>,
    expect: Vec<(String, Value)>,
}

impl Step {
    /// What is changed now belongs to it: nothing came behind its changes yet.
    fn is_open(&self) -> bool {
        self.scans == 0 && self.fault.is_none() && self.expect.is_empty()
    }
}

/// How a recording names its program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Subject {
    /// What the scenario shows.
    pub name: String,
    /// Path of the program as the scenario spells it.
    pub program: String,
    /// `family` of the scenario, where it needs one.
    pub family: Option<String>,
}

impl Recorder {
    /// A recording of a controller that has a prescan, as SLC and MicroLogix have, or of one that has none.
    pub fn new(prescan: bool) -> Recorder {
        Recorder { prescan, ..Recorder::default() }
    }

    /// A change was made before the next scan.
    pub fn changed(&mut self, change: &Change) {
        self.full |= self.sets >= SETS;
        if self.full {
            return;
        }
        // A change behind an expectation is another step, as one behind a scan. A step enters run before it writes, so run
        // behind something written is another one too, where a prescan would change that.
        let enters = self.prescan && matches!(change, Change::Mode(ModeChange::Run | ModeChange::PowerCycle));
        let begun = |step: &Step| step.is_open() && (!enters || step.sets.is_empty());
        let begun = self.steps.last().is_some_and(begun);
        if !begun {
            if self.steps.len() == STEPS {
                self.full = true;
                return;
            }
            self.steps.push(Step::default());
        }
        let Some(step) = self.steps.last_mut() else { return };
        match change {
            Change::Write { address, value } => {
                step.sets.retain(|(other, _)| other != address);
                step.sets.push((address.clone(), value.clone()));
                self.sets += 1;
            }
            Change::Mode(ModeChange::Run) => step.program_run = true,
            // What a plant writes is recorded as written.
            Change::Mode(ModeChange::Program) | Change::Plant(_) => {}
            Change::Mode(ModeChange::Test) => self.note("test mode: a scenario runs in run mode"),
            Change::Mode(ModeChange::PowerCycle) => {
                step.program_run = true;
                self.note("a power cycle: the scenario leaves and enters run instead");
            }
            Change::Force { address, state } => step.notes.push(match state {
                Some(on) => format!("{address} forced {}", if *on { "ON" } else { "OFF" }),
                None => format!("force of {address} removed"),
            }),
            Change::EnableForces(on) => {
                step.notes.push(format!("forces {}", if *on { "enabled" } else { "disabled" }));
            }
        }
    }

    /// Forces act on what was just written, or were changed themselves: forced inputs are recorded with what the program
    /// reads there. A force of an output that the program does not see needs no more than the words of its step.
    pub fn forced(&mut self, state: &State) {
        self.forced.extend(state.forces.keys().cloned());
        let enabled = state.machine.forces_enabled();
        let mut reads = Vec::new();
        for name in &self.forced {
            let forced = state.forces.get(name).filter(|_| enabled);
            match (state.machine.point(name), forced) {
                (Point::Input(_), Some(on)) => reads.push((name.clone(), Value::Bit(*on))),
                (Point::Input(carries), None) => reads.push((name.clone(), carries)),
                (Point::ReadBack, Some(_)) => {
                    let note = format!("a force of {name}, which the program reads back");
                    if !self.notes.contains(&note) {
                        self.notes.push(note);
                    }
                }
                (Point::Output | Point::ReadBack, _) => {}
            }
        }
        let Some(step) = self.steps.last_mut().filter(|step| step.is_open()) else { return };
        for (name, value) in reads {
            step.sets.retain(|(other, _)| *other != name);
            step.sets.push((name, value));
        }
    }

    /// A scan was run.
    pub fn scanned(&mut self, dt: Duration) {
        if self.full {
            return;
        }
        let full = self.steps.len() == STEPS;
        match self.steps.last_mut() {
            // The first scan of run passes no time, whatever the step says.
            Some(last)
                if last.expect.is_empty()
                    && last.fault.is_none()
                    && (last.scans == 0 || last.dt.is_zero() || last.dt == dt) =>
            {
                last.scans += 1;
                self.scans += 1;
                last.dt = dt;
            }
            _ if full => self.full = true,
            _ => {
                self.steps.push(Step { dt, scans: 1, ..Step::default() });
                self.scans += 1;
            }
        }
    }

    /// Whether the controller has stopped, behind a change or a scan: a fault that came is expected where it came.
    pub fn stopped(&mut self, stop: Option<&Stop>) {
        let came = stop.filter(|_| !self.stopped);
        self.stopped = stop.is_some();
        let Some(stop) = came.filter(|_| !self.full) else { return };
        match self.steps.last_mut() {
            // Without a code a scenario says that there is no fault.
            Some(step) if stop.code != 0 => step.fault = Some(stop.code),
            _ => self.note(&format!("{}: a fault without a code, which a scenario cannot expect", stop.text)),
        }
    }

    /// Scans recorded.
    pub fn scans(&self) -> u64 {
        self.scans
    }

    /// These values are expected here.
    pub fn expect(&mut self, values: impl IntoIterator<Item = (String, Value)>) {
        self.full |= self.sets >= SETS;
        if self.full {
            return;
        }
        if self.steps.is_empty() {
            self.steps.push(Step::default());
        }
        let Some(step) = self.steps.last_mut() else { return };
        for (address, value) in values {
            step.expect.retain(|(other, _)| *other != address);
            step.expect.push((address, value));
            self.sets += 1;
        }
    }

    /// What the scenario does not say although it was done, in words.
    pub fn notes(&self) -> impl Iterator<Item = &str> {
        let full = self.full.then_some("the recording is full: what came later is not in it");
        self.notes.iter().map(String::as_str).chain(full)
    }

    /// The scenario.
    pub fn to_text(&self, subject: &Subject) -> String {
        let mut text = String::new();
        for note in self.notes() {
            let _ = writeln!(text, "# Not in this scenario: {}", note.replace(char::is_control, " "));
        }
        let _ = writeln!(text, "name = {}", quoted(&subject.name));
        let _ = writeln!(text, "program = {}", quoted(&subject.program));
        if let Some(family) = &subject.family {
            let _ = writeln!(text, "family = {}", quoted(family));
        }
        let usual = self.steps.iter().max_by_key(|step| step.scans).map(|step| step.dt).filter(|dt| !dt.is_zero());
        let usual = usual.unwrap_or(Duration::from_millis(10));
        let _ = writeln!(text, "scan = {}", duration(usual));
        for step in &self.steps {
            let _ = writeln!(text, "\n[[step]]");
            if step.program_run {
                let _ = writeln!(text, "mode = \"program-run\"");
            }
            if !step.notes.is_empty() {
                let _ = writeln!(text, "note = {}", quoted(&step.notes.join("; ")));
            }
            table(&mut text, "set", &step.sets);
            if step.scans > 0 {
                if step.dt != usual && !step.dt.is_zero() {
                    let _ = writeln!(text, "scan = {}", duration(step.dt));
                }
                let _ = writeln!(text, "scans = {}", step.scans);
            }
            if let Some(code) = step.fault {
                let _ = writeln!(text, "fault = \"{code:04X}\"");
            }
            table(&mut text, "expect", &step.expect);
        }
        text
    }

    fn note(&mut self, text: &str) {
        if !self.notes.iter().any(|note| note == text) {
            self.notes.push(text.to_owned());
        }
    }
}

fn table(text: &mut String, key: &str, values: &[(String, Value)]) {
    let pair = |(address, value): &(String, Value)| Some(format!("{} = {}", quoted(address), literal(value)?));
    let pairs: Vec<String> = values.iter().filter_map(pair).collect();
    if !pairs.is_empty() {
        let _ = writeln!(text, "{key} = {{ {} }}", pairs.join(", "));
    }
}
