//! Carries a scenario out.

use std::fmt;
use std::time::Duration;

use ladder::{Address, Family, Image, Rung, Value};

use super::controller::{Controller, Stop};
use super::literal::{Mismatch, matches, value_for};
use super::{Assignment, Length, Scenario, Spot, Step, Subject, Target};
use crate::{Approximation, Choices, Machine, Options, Program, Refusal, inline_image, outside};

/// Where programs come from: `sim` reads no file and no text.
pub trait Loader {
    /// The program at a path as the scenario spells it.
    ///
    /// # Errors
    /// Why it cannot be had.
    fn program(&self, path: &str) -> Result<Image, String>;

    /// The rungs of an inline ladder, one per line.
    ///
    /// # Errors
    /// Each place that cannot be read: its line in the text, from 1, and what is wrong.
    fn rungs(&self, text: &str, family: Family) -> Result<Vec<Rung>, Vec<(u32, String)>>;

    /// A controller for a scenario that this crate has none for: another dialect. `None`: there is none
    /// either.
    ///
    /// # Errors
    /// Why the scenario cannot be played on it.
    fn controller(&self, scenario: &Scenario) -> Result<Option<Foreign>, RunError> {
        let _ = scenario;
        Ok(None)
    }
}

/// A controller of another dialect, ready to enter run.
pub struct Foreign {
    /// The controller, its program loaded.
    pub controller: Box<dyn Controller>,
    /// What of the program runs only approximately.
    pub approximations: Vec<Approximation>,
}

/// Why a scenario could not be carried out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RunError {
    /// Something in the scenario, with its line.
    Scenario(Spot<String>),
    /// The program holds instructions that cannot be simulated.
    Refused(Vec<Refusal>),
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RunError::Scenario(spot) => write!(f, "line {}: {}", spot.line, spot.value),
            RunError::Refused(refusals) => {
                f.write_str("the program cannot be simulated")?;
                refusals.iter().try_for_each(|refusal| write!(f, "; {refusal}"))
            }
        }
    }
}

impl std::error::Error for RunError {}

/// How a scenario went.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// Every expectation that was not met, in order.
    pub failures: Vec<Failure>,
    /// Expectations looked at, faults included.
    pub checks: usize,
    /// Scans.
    pub scans: u64,
    /// Simulated time.
    pub time: Duration,
    /// What of the program ran only approximately.
    pub approximations: Vec<Approximation>,
    /// Indirect addresses that left their file and reached other data.
    pub strays: u64,
}

/// An expectation that was not met.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// The step, from 1.
    pub step: usize,
    /// Its remark.
    pub note: Option<String>,
    /// Line of the expectation in the scenario, from 1.
    pub line: u32,
    /// Scans made so far.
    pub scan: u64,
    /// Simulated time so far.
    pub time: Duration,
    /// What is wrong.
    pub found: Found,
}

/// What was found in place of what was expected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Found {
    /// Another value at this address.
    Value {
        /// The address as written.
        address: String,
        /// Both values.
        mismatch: Mismatch,
    },
    /// Another major fault, or none, or one that nobody expected.
    Fault {
        /// The code the step expects.
        expected: Option<u16>,
        /// The fault the processor stopped with.
        found: Option<Stop>,
    },
}

impl fmt::Display for Failure {
    /// `step 2 (press start), scan 3, 0.020 s: T4:0.ACC expected 100 (0064h), found 99 (0063h)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "step {}", self.step)?;
        if let Some(note) = &self.note {
            write!(f, " ({note})")?;
        }
        write!(f, ", scan {}, {:.3} s: ", self.scan, self.time.as_secs_f64())?;
        match &self.found {
            Found::Value { address, mismatch } => {
                write!(f, "{address} expected {}, found {}", mismatch.expected, mismatch.found)
            }
            Found::Fault { expected, found } => {
                match expected.filter(|code| *code != 0) {
                    Some(code) => write!(f, "expected major fault {code:04X}, found ")?,
                    None => f.write_str("expected no major fault, found ")?,
                }
                match found {
                    Some(fault) => write!(f, "{fault}"),
                    None => f.write_str("none"),
                }
            }
        }
    }
}

/// Carries a scenario out.
///
/// # Errors
/// The program cannot be had or simulated, or an address of the scenario does not exist in it.
/// Expectations that are not met are no error: they are in the [`Report`].
pub fn run(scenario: &Scenario, loader: &dyn Loader, choices: Choices) -> Result<Report, RunError> {
    if let Some(Foreign { mut controller, approximations }) = loader.controller(scenario)? {
        return play(scenario, &mut *controller, approximations);
    }
    let (image, mut options) = image(scenario, loader)?;
    options.choices = choices;
    options.addresses = named(scenario).map(address).collect::<Result<_, _>>()?;
    options.addresses.iter_mut().for_each(|address| address.indexed = false);
    let program = Program::compile(&image, &options).map_err(RunError::Refused)?;
    let approximations = program.approximations().to_vec();
    play(scenario, &mut Machine::new(program), approximations)
}

/// Plays the steps on a controller in program mode.
///
/// # Errors
/// An address of the scenario does not exist there.
pub fn play(
    scenario: &Scenario,
    machine: &mut dyn Controller,
    approximations: Vec<Approximation>,
) -> Result<Report, RunError> {
    let mut player = Player { machine, dt: scenario.scan, entered: true, scans: 0, checks: 0, failures: Vec::new() };
    if let Some(first) = scenario.steps.first() {
        player.assign(&first.set)?;
    }
    player.machine.enter_run();
    for (index, step) in scenario.steps.iter().enumerate() {
        player.step(index + 1, step)?;
    }
    Ok(Report {
        checks: player.checks,
        scans: player.scans,
        time: player.machine.now(),
        strays: player.machine.strays(),
        failures: player.failures,
        approximations,
    })
}

fn image(scenario: &Scenario, loader: &dyn Loader) -> Result<(Image, Options), RunError> {
    let family = match scenario.target {
        Some(Target::DoMore) => {
            let message = "family do-more: nothing here runs Do-more programs";
            return Err(at(1, message));
        }
        Some(Target::Slc(family)) => Some(family),
        None => None,
    };
    let options = Options { family, ..Options::default() };
    match &scenario.program {
        Subject::File(path) => {
            let image = loader.program(&path.value).map_err(|why| at(path.line, format!("{}: {why}", path.value)))?;
            Ok((image, options))
        }
        Subject::Inline(routines) => {
            let family = family.unwrap_or(Family::Unknown);
            let mut files = Vec::new();
            for routine in routines {
                let number = routine.name.value.parse().map_err(|_| {
                    at(routine.name.line, format!("`{}` is no program file number", routine.name.value))
                })?;
                let rungs = loader.rungs(&routine.text, family).map_err(|problems| {
                    let place = |(line, why): &(u32, String)| (routine.line + line.saturating_sub(1), why.clone());
                    let (line, why) = problems.first().map(place).unwrap_or((routine.line, "no rung".to_owned()));
                    at(line, format!("ladder of program file {number}: {why}"))
                })?;
                files.push((number, rungs));
            }
            Ok((inline_image(family, files), Options { inline: true, ..options }))
        }
    }
}

fn at(line: u32, message: impl Into<String>) -> RunError {
    RunError::Scenario(Spot { value: message.into(), line })
}

/// Every address a scenario names.
fn named(scenario: &Scenario) -> impl Iterator<Item = &Spot<String>> {
    scenario.steps.iter().flat_map(|step| {
        let values = step.set.iter().chain(&step.expect).map(|assignment| &assignment.address);
        values.chain(step.edges.as_ref().map(|edges| &edges.bit))
    })
}

fn address(spot: &Spot<String>) -> Result<Address, RunError> {
    outside::address(&spot.value).map_err(|why| at(spot.line, format!("{}: {why}", spot.value)))
}

/// Instructions a scenario may execute, minutes of work: scans are bounded as they are read, but those of
/// a program that loops up to the watchdog take long.
const MOST_INSTRUCTIONS: u64 = 20_000_000_000;

/// A machine with what is counted while a scenario runs on it.
struct Player<'m> {
    machine: &'m mut dyn Controller,
    dt: Duration,
    /// No scan since run was entered.
    entered: bool,
    scans: u64,
    checks: usize,
    failures: Vec<Failure>,
}

impl Player<'_> {
    fn step(&mut self, number: usize, step: &Step) -> Result<(), RunError> {
        if step.program_run {
            self.machine.enter_program();
            // As before the first step: what is set is there when run is entered, and again behind the prescan.
            self.assign(&step.set)?;
            self.machine.enter_run();
            self.entered = true;
        }
        // A fault on going to run belongs to the step that causes it.
        let before = if step.program_run || number == 1 { None } else { self.machine.stopped() };
        if step.program_run {
            // But what enters run the way the change of mode leaves it.
            for assignment in &step.set {
                if !self.machine.follows_mode(&assignment.address.value) {
                    self.assign([assignment])?;
                }
            }
        } else {
            self.assign(&step.set)?;
        }
        if let Some(edges) = &step.edges {
            if !matches!(self.read(&edges.bit)?, Value::Bit(_)) {
                return Err(at(edges.bit.line, format!("edges: {} is not a bit", edges.bit.value)));
            }
            for _ in 0..edges.count {
                for level in [false, true] {
                    self.write(&edges.bit, &Value::Bit(level))?;
                    self.scan(step)?;
                }
            }
        }
        match step.length {
            Length::None => {}
            Length::Scans(count) => (0..count).try_for_each(|_| self.scan(step))?,
            Length::For(time) => {
                let end = self.machine.now() + time;
                while self.machine.now() < end {
                    self.scan(step)?;
                }
            }
        }
        self.check_fault(number, step, before);
        for assignment in &step.expect {
            let spot = &assignment.address;
            let found = self.read(spot)?;
            self.checks += 1;
            let wrong =
                matches(&assignment.value, &found).map_err(|why| at(spot.line, format!("{}: {why}", spot.value)))?;
            if let Some(mismatch) = wrong {
                self.fail(number, step, spot.line, Found::Value { address: spot.value.clone(), mismatch });
            }
        }
        Ok(())
    }

    /// A fault must be the one expected; one that came in this step must have been expected.
    fn check_fault(&mut self, number: usize, step: &Step, before: Option<Stop>) {
        let found = self.machine.stopped();
        let expected = step.fault.as_ref().map(|spot| spot.value);
        let met = match expected {
            Some(0) => found.is_none(),
            Some(code) => found.as_ref().is_some_and(|fault| fault.code == code),
            None => found.is_none() || found == before,
        };
        self.checks += usize::from(expected.is_some());
        if !met {
            let line = step.fault.as_ref().map_or(step.line, |spot| spot.line);
            self.fail(number, step, line, Found::Fault { expected, found });
        }
    }

    fn fail(&mut self, number: usize, step: &Step, line: u32, found: Found) {
        let (note, scan, time) = (step.note.clone(), self.scans, self.machine.now());
        self.failures.push(Failure { step: number, note, line, scan, time, found });
    }

    fn scan(&mut self, step: &Step) -> Result<(), RunError> {
        let dt = if std::mem::take(&mut self.entered) { Duration::ZERO } else { step.scan.unwrap_or(self.dt) };
        self.machine.scan(dt);
        self.scans += 1;
        if self.machine.instructions() > MOST_INSTRUCTIONS {
            return Err(at(step.line, format!("the scenario executes more than {MOST_INSTRUCTIONS} instructions")));
        }
        Ok(())
    }

    fn assign<'a>(&mut self, assignments: impl IntoIterator<Item = &'a Assignment>) -> Result<(), RunError> {
        for assignment in assignments {
            let spot = &assignment.address;
            let present = self.read(spot)?;
            let value = value_for(&assignment.value, &present)
                .map_err(|why| at(spot.line, format!("{}: {why}", spot.value)))?;
            self.write(spot, &value)?;
        }
        Ok(())
    }

    fn read(&self, spot: &Spot<String>) -> Result<Value, RunError> {
        self.machine.read(&spot.value).map_err(|why| at(spot.line, format!("{}: {why}", spot.value)))
    }

    fn write(&mut self, spot: &Spot<String>, value: &Value) -> Result<(), RunError> {
        let written = self.machine.write(&spot.value, value);
        written.map_err(|why| at(spot.line, format!("{}: {why}", spot.value)))
    }
}
