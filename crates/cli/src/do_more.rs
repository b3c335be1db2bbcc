//! Do-more programs for scenarios and runs: text to a machine.

use domore::Project;
use domore::engine::{Machine, Options, Program};
use domore::program::CodeKind;
use ladder::Severity;
use sim::scenario::{Foreign, Routine, RunError, Spot};
use sim::{Approximation, Refusal};

use crate::output::Outcome;

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
pub fn machine_of(text: &str, options: &Options) -> Result<(Machine, Vec<Approximation>), Vec<String>> {
    let (_, program, approximations) = program_of(text, options)?;
    Ok((Machine::new(program), approximations))
}

/// The project of a Do-more text, the program to run, and what runs only approximately.
///
/// # Errors
/// A line for everything that keeps it from running.
pub fn program_of(text: &str, options: &Options) -> Result<(Project, Program, Vec<Approximation>), Vec<String>> {
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
    Ok((reading.project, program, approximations))
}

/// How a command ends whose program does not run: what nobody can read is unreadable input, any other program is refused.
pub fn refused(text: &str) -> Outcome {
    let lost = |found: &domore::Diagnostic| found.rung.is_none() && found.problem.severity() == Severity::Error;
    match domore::text::read(text) {
        Ok(reading) if !reading.diagnostics.iter().any(lost) => Outcome::Finding,
        _ => Outcome::Unreadable,
    }
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
    Ok(Foreign { controller: Box::new(Machine::new(program)), approximations })
}

fn at(line: u32, message: String) -> RunError {
    RunError::Scenario(Spot { value: message, line })
}
