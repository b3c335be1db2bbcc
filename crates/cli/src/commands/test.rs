//! `rungs test`: scenarios.

use std::collections::BTreeMap;
use std::io::{IsTerminal, Write};
use std::path::Path;
use std::time::Instant;

use serde_json::{Value, json};
use sim::Approximation;
use sim::scenario::{Failure, Found, Report, RunError, Scenario, run as run_scenario};

use super::junit::{self, Case, Verdict};
use super::read_file;
use crate::args::TestArguments;
use crate::files;
use crate::output::{Error, Outcome};
use crate::scenario_loader::FolderLoader;

/// Why a scenario was not carried out.
enum Stopped {
    /// Scenario or program cannot be read.
    Unreadable(String),
    /// The program cannot be simulated.
    Refused(String),
}

/// A scenario that was tried.
struct Tried {
    /// What it calls itself.
    name: String,
    source: Vec<String>,
    result: Result<Report, Stopped>,
}

#[derive(Default)]
struct Sum {
    passed: usize,
    failed: usize,
    stopped: usize,
    /// Scenarios whose program runs only approximately.
    approximate: usize,
    scans: u64,
    checks: usize,
}

pub fn run(arguments: &TestArguments) -> Result<Outcome, Error> {
    let files = files::expand(&arguments.files, files::SCENARIOS).map_err(Error::Use)?;
    let stdout = std::io::stdout();
    let bar = files::progress(files.len(), stdout.is_terminal());
    let mut out = std::io::BufWriter::new(stdout.lock());
    let (mut outcome, mut sum, mut cases) = (Outcome::Done, Sum::default(), Vec::new());
    for path in &files {
        let started = Instant::now();
        let tried = attempt(path, arguments);
        outcome = outcome.max(sum.add(&tried.result));
        if arguments.json {
            writeln!(out, "{}", describe(path, &tried))?;
        } else {
            print(&mut out, path, &tried, arguments.quiet)?;
        }
        if arguments.junit.is_some() {
            cases.push(case(path, &tried, started.elapsed().as_secs_f64()));
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    if !arguments.json {
        let Sum { passed, failed, stopped, approximate, scans, checks } = sum;
        writeln!(out, "{passed} passed, {failed} failed, {stopped} not run; {checks} expectations, {scans} scans")?;
        if approximate > 0 {
            writeln!(out, "{approximate} of them ran with instructions that are only approximated")?;
        }
    }
    out.flush()?;
    if let Some(path) = &arguments.junit {
        let written = std::fs::write(path, junit::document(&cases));
        written.map_err(|error| Error::Use(format!("{}: {error}", path.display())))?;
    }
    Ok(outcome)
}

impl Sum {
    fn add(&mut self, result: &Result<Report, Stopped>) -> Outcome {
        match result {
            Ok(report) => {
                self.scans += report.scans;
                self.checks += report.checks;
                self.approximate += usize::from(!report.approximations.is_empty());
                if report.failures.is_empty() {
                    self.passed += 1;
                    return Outcome::Done;
                }
                self.failed += 1;
                Outcome::Finding
            }
            Err(stopped) => {
                self.stopped += 1;
                match stopped {
                    Stopped::Unreadable(_) => Outcome::Unreadable,
                    Stopped::Refused(_) => Outcome::Finding,
                }
            }
        }
    }
}

fn attempt(path: &Path, arguments: &TestArguments) -> Tried {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let text = read_file(path, super::MOST_BYTES)
        .and_then(|bytes| String::from_utf8(bytes).map_err(|_| "not UTF-8 text".to_owned()));
    let scenario = text.and_then(|text| Scenario::parse(&text).map_err(|error| error.to_string()));
    let scenario = match scenario {
        Ok(scenario) => scenario,
        Err(why) => return Tried { name: stem, source: Vec::new(), result: Err(Stopped::Unreadable(why)) },
    };
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let result = run_scenario(
        &scenario,
        &FolderLoader { folder, do_more: arguments.simulation.do_more() },
        arguments.simulation.choices(),
    );
    let result = result.map_err(|error| match &error {
        RunError::Scenario(_) => Stopped::Unreadable(error.to_string()),
        RunError::Refused(_) => Stopped::Refused(error.to_string()),
    });
    let name = if scenario.name.is_empty() { stem } else { scenario.name };
    Tried { name, source: scenario.source, result }
}

fn print(out: &mut impl Write, path: &Path, tried: &Tried, quiet: bool) -> Result<(), Error> {
    let title = format!("{}  {}", path.display(), tried.name);
    match &tried.result {
        Ok(report) if report.failures.is_empty() => {
            if !quiet {
                writeln!(out, "ok    {title}")?;
                approximations(out, report)?;
            }
        }
        Ok(report) => {
            writeln!(out, "FAIL  {title}")?;
            for failure in &report.failures {
                writeln!(out, "      {failure}")?;
            }
            if !tried.source.is_empty() {
                writeln!(out, "      by {}", tried.source.join("; "))?;
            }
            approximations(out, report)?;
        }
        Err(Stopped::Unreadable(why) | Stopped::Refused(why)) => {
            writeln!(out, "ERROR {title}")?;
            writeln!(out, "      {why}")?;
        }
    }
    Ok(())
}

fn approximations(out: &mut impl Write, report: &Report) -> Result<(), Error> {
    for note in notes(report) {
        writeln!(out, "      {note}")?;
    }
    Ok(())
}

/// What a reader must know beside the verdict, a line each.
fn notes(report: &Report) -> Vec<String> {
    let mut notes: Vec<_> =
        reasons(&report.approximations).into_iter().map(|line| format!("approximate: {line}")).collect();
    if report.strays > 0 {
        notes.push(format!("note: indirect addresses reached beyond their file {} times", report.strays));
    }
    notes
}

/// Approximations of a program, equal reasons together, each with its first place.
pub(super) fn reasons(approximations: &[Approximation]) -> Vec<String> {
    let mut reasons: BTreeMap<&str, (&Approximation, usize)> = BTreeMap::new();
    for approximation in approximations {
        reasons.entry(&approximation.why).or_insert((approximation, 0)).1 += 1;
    }
    let line = |(first, count): (&Approximation, usize)| match count {
        1 => first.to_string(),
        _ => format!("{first} (and {} more)", count - 1),
    };
    reasons.into_values().map(line).collect()
}

fn describe(path: &Path, tried: &Tried) -> Value {
    let mut line = json!({"file": path.display().to_string(), "name": tried.name, "source": tried.source});
    let rest = match &tried.result {
        Ok(report) => json!({
            "result": if report.failures.is_empty() { "passed" } else { "failed" },
            "expectations": report.checks,
            "scans": report.scans,
            "time_s": report.time.as_secs_f64(),
            "failures": report.failures.iter().map(failure).collect::<Value>(),
            "approximations": report.approximations.iter().map(ToString::to_string).collect::<Value>(),
            "strays": report.strays,
        }),
        Err(Stopped::Unreadable(why)) => json!({"result": "unreadable", "error": why}),
        Err(Stopped::Refused(why)) => json!({"result": "refused", "error": why}),
    };
    if let (Value::Object(line), Value::Object(rest)) = (&mut line, rest) {
        line.extend(rest);
    }
    line
}

fn failure(failure: &Failure) -> Value {
    let (address, expected, found) = match &failure.found {
        Found::Value { address, mismatch } => (json!(address), json!(mismatch.expected), json!(mismatch.found)),
        Found::Fault { expected, found } => (
            json!("fault"),
            json!(expected.map(|code| format!("{code:04X}"))),
            json!(found.as_ref().map(ToString::to_string)),
        ),
    };
    json!({
        "step": failure.step, "note": failure.note, "line": failure.line, "address": address,
        "expected": expected, "found": found, "scan": failure.scan, "time_s": failure.time.as_secs_f64(),
    })
}

fn case(path: &Path, tried: &Tried, seconds: f64) -> Case {
    let class = path.parent().map(|folder| folder.display().to_string()).unwrap_or_default();
    let file = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let result = match &tried.result {
        Ok(report) if report.failures.is_empty() => Verdict::Passed,
        Ok(report) => Verdict::Failed(report.failures.iter().map(ToString::to_string).collect()),
        Err(Stopped::Unreadable(why) | Stopped::Refused(why)) => Verdict::Error(why.clone()),
    };
    let notes = tried.result.as_ref().map(notes).unwrap_or_default();
    Case { class, name: format!("{file}: {}", tried.name), seconds, result, notes }
}
