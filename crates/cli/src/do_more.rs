//! Do-more programs for scenarios and runs: text to a machine, and the machine as the runner of scenarios
//! drives it.

use std::time::Duration;

use domore::engine::{Handle, Machine, Mode, Options, Program, Value};
use domore::memory::Kind;
use domore::program::CodeKind;
use ladder::Severity;
use sim::scenario::{Controller, Foreign, Routine, RunError, Spot, Stop};
use sim::{Approximation, Refusal};

/// A Do-more machine as scenarios see it.
pub struct DoMore(pub Machine);

impl Controller for DoMore {
    fn enter_program(&mut self) {
        self.0.enter_program();
    }

    fn enter_run(&mut self) {
        self.0.enter_run();
    }

    fn scan(&mut self, dt: Duration) {
        self.0.scan(dt);
    }

    fn scans(&self) -> u64 {
        self.0.scans()
    }

    fn is_executing(&self) -> bool {
        self.0.mode() == Mode::Run
    }

    fn now(&self) -> Duration {
        self.0.now()
    }

    fn instructions(&self) -> u64 {
        self.0.instructions()
    }

    fn stopped(&self) -> Option<Stop> {
        self.0.fault().map(|fault| Stop { code: 0, text: fault.to_string() })
    }

    fn read(&self, address: &str) -> Result<ladder::Value, String> {
        self.0.handle(address).map(|handle| self.value(handle)).map_err(|error| error.why)
    }

    fn write(&mut self, address: &str, value: &ladder::Value) -> Result<(), String> {
        self.0.set(address, &plain(value)?).map_err(|error| error.why)
    }
}

impl DoMore {
    /// Writes a value at a place.
    ///
    /// # Errors
    /// It is read-only, or of another sort.
    pub fn put(&mut self, handle: Handle, value: &ladder::Value) -> Result<(), String> {
        self.0.set_value(handle, &plain(value)?).map_err(|error| error.why)
    }

    /// The value at a place.
    pub fn value(&self, handle: Handle) -> ladder::Value {
        match (self.0.value(handle), handle.kind()) {
            (Value::Bit(on), _) => ladder::Value::Bit(on),
            (Value::Integer(number), Kind::I16) => ladder::Value::Word(number as i16),
            // Unsigned words and bytes count from 0: they are shown and compared as whole numbers.
            (Value::Integer(number), _) => ladder::Value::Long(number as i32),
            (Value::Real(number), _) => ladder::Value::Float(number),
            (Value::Text(text), _) => ladder::Value::Text(text),
        }
    }
}

fn plain(value: &ladder::Value) -> Result<Value, String> {
    Ok(match value {
        ladder::Value::Bit(on) => Value::Bit(*on),
        ladder::Value::Word(word) => Value::Integer((*word).into()),
        ladder::Value::Long(long) => Value::Integer((*long).into()),
        ladder::Value::Float(number) => Value::Real(*number),
        ladder::Value::Text(text) => Value::Text(text.clone()),
        _ => return Err("no such value in Do-more".to_owned()),
    })
}

/// What is followed where a person names a timer or counter: its members; else the name itself.
pub fn members(text: &str) -> Vec<String> {
    let number = |rest: &str| !rest.is_empty() && rest.bytes().all(|byte| byte.is_ascii_digit());
    let members: &[&str] = match text.strip_prefix("CT") {
        Some(rest) if number(rest) => &["Acc", "Done", "DnDone", "Reset", "Zero"],
        _ if text.strip_prefix('T').is_some_and(number) => &["Acc", "Done", "Timing", "Reset", "Zero"],
        _ => return vec![text.to_owned()],
    };
    members.iter().map(|member| format!("{text}.{member}")).collect()
}

/// A machine for a Do-more text, with what runs only approximately.
///
/// # Errors
/// A line for everything that keeps it from running.
pub fn machine_of(text: &str, options: &Options) -> Result<(DoMore, Vec<Approximation>), Vec<String>> {
    let reading = domore::text::read(text).map_err(|error| vec![error.to_string()])?;
    let errors = reading.diagnostics.iter().filter(|diagnostic| diagnostic.problem.severity() == Severity::Error);
    let errors: Vec<String> = errors.map(ToString::to_string).collect();
    if !errors.is_empty() {
        return Err(errors);
    }
    let program = Program::compile(&reading.project, options)
        .map_err(|refusals| refusals.iter().map(ToString::to_string).collect::<Vec<_>>())?;
    let named = program.approximations().iter();
    let approximations = named.map(|found| Approximation { site: None, why: found.to_string() }).collect();
    Ok((DoMore(Machine::new(program)), approximations))
}

/// A machine for the text of a program file.
///
/// # Errors
/// What keeps the text from being read whole, or the program from running.
pub fn from_file(text: &str, line: u32, options: &Options) -> Result<Foreign, RunError> {
    let reading = domore::text::read(text).map_err(|error| at(line, error.to_string()))?;
    match reading.diagnostics.iter().find(|diagnostic| diagnostic.problem.severity() == Severity::Error) {
        // A test on half a program would prove nothing.
        Some(worst) => Err(at(line, format!("not all of it could be read: {worst}"))),
        None => machine(&reading.project, options),
    }
}

/// A machine for a ladder inside a scenario: bodies of code blocks by their heads.
///
/// # Errors
/// The first place of the scenario that does not read, or what keeps the program from running.
pub fn from_routines(routines: &[Routine], options: &Options) -> Result<Foreign, RunError> {
    if let [only] = routines
        && has_heads(&only.text)
    {
        return from_file(&only.text, only.line, options);
    }
    let mut text = String::new();
    // Lines of the text so far, with the routine that begins behind each.
    let mut starts = Vec::new();
    for routine in routines {
        let head = routine.name.value.trim();
        let (word, name) = head.split_once(char::is_whitespace).unwrap_or(("$PRGRM", head));
        let kind = CodeKind::from_begin(word).filter(|kind| !matches!(kind, CodeKind::Other { .. }));
        let Some(kind) = kind else {
            let heads = "$Main, or $PRGRM, $LGCMOD, $TSK or $INT with a name";
            return Err(at(
                routine.name.line,
                format!("ladder.\"{head}\": expected the head of a code block: {heads}"),
            ));
        };
        let name = name.trim();
        text.push_str(&format!("{} {name}\n\n", kind.begin()));
        starts.push((text.lines().count() as u32, routine.line));
        text.push_str(&routine.text);
        text.push_str(&format!("\n\n{} {name}\n\n", kind.end()));
    }
    let line_of = |line: u32| {
        let start = starts.iter().rev().find(|start| start.0 < line);
        start.map_or(1, |(before, first)| first + (line - before).saturating_sub(1))
    };
    let first = starts.first().map_or(1, |start| start.1);
    let reading = domore::text::read(&text).map_err(|error| at(first, error.to_string()))?;
    match reading.diagnostics.iter().find(|diagnostic| diagnostic.problem.severity() == Severity::Error) {
        Some(worst) => Err(at(line_of(worst.line), format!("ladder: {}", worst.problem))),
        None => machine(&reading.project, options),
    }
}

/// Whether a ladder brings the heads of its code blocks with it.
fn has_heads(text: &str) -> bool {
    let mut words = text.lines().filter_map(|line| line.split_whitespace().next());
    words.any(|word| CodeKind::from_begin(word).is_some_and(|kind| !matches!(kind, CodeKind::Other { .. })))
}

fn machine(project: &domore::Project, options: &Options) -> Result<Foreign, RunError> {
    let program = Program::compile(project, options).map_err(|refusals| {
        let refusals = refusals.iter().map(|refusal| Refusal { site: None, why: refusal.to_string() });
        RunError::Refused(refusals.collect())
    })?;
    let named = program.approximations().iter();
    let approximations = named.map(|found| Approximation { site: None, why: found.to_string() }).collect();
    Ok(Foreign { controller: Box::new(DoMore(Machine::new(program))), approximations })
}

fn at(line: u32, message: String) -> RunError {
    RunError::Scenario(Spot { value: message, line })
}
