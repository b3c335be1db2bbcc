//! `rungs prove`: two programs side by side.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use analysis::proof::{
    Coverage, Goal, GoalKind, Mapping, NOT_MODELLED, Named, Options, Progress, Refused, Report, Verdict, fates,
    prove_domore, prove_slc, refused_domore, refused_slc,
};
use convert::AnyProject;
use convert::migrate::map_file::{self, MapRow};
use indicatif::{ProgressBar, ProgressStyle};
use ladder::Severity;
use serde_json::{Value, json};

use super::{MOST_BYTES, file_name, read_file};
use crate::args::ProveArguments;
use crate::output::{Error, Outcome, printable};

/// How often a person is told how far a run is.
const LOOK: Duration = Duration::from_millis(100);

/// Most bytes of an address map.
const MOST_MAP: usize = 64 << 20;

pub fn run(arguments: &ProveArguments) -> Result<Outcome, Error> {
    let (first, second) = match (open(&arguments.original), open(&arguments.other)) {
        (Ok(first), Ok(second)) => (first, second),
        (first, second) => {
            for why in [first.err(), second.err()].into_iter().flatten() {
                eprintln!("{}", printable(&why));
            }
            return Ok(Outcome::Unreadable);
        }
    };
    let AnyProject::Rslogix(original) = first else {
        let name = arguments.original.display();
        return Err(Error::Use(format!("{name}: the original must be an SLC 500 or MicroLogix program")));
    };
    let map = match arguments.map.as_deref().map(mappings).transpose() {
        Ok(map) => map,
        Err(why) => {
            eprintln!("{}", printable(&why));
            return Ok(Outcome::Unreadable);
        }
    };
    let folder = arguments.out.clone().unwrap_or_default();
    let mut options = Options {
        scans: arguments.scans,
        seed: arguments.seed,
        without_marks: arguments.no_marks,
        choices: arguments.simulation.choices(),
        domore_choices: arguments.simulation.do_more(),
        original: Named { program: beside(&arguments.original, &folder), family: None },
        ..Options::default()
    };
    options.other.program = beside(&arguments.other, &folder);
    let (numbers, map): (Vec<usize>, Option<Vec<Mapping>>) = match map {
        Some(rows) => {
            let (numbers, map): (Vec<usize>, Vec<Mapping>) = rows.into_iter().unzip();
            (numbers, Some(map))
        }
        None => (Vec::new(), None),
    };
    if let (Some(map), Some(path)) = (&map, &arguments.map) {
        refuse(&original.main, &second, map, &numbers, path, &options)?;
    }
    if map.is_none() && matches!(second, AnyProject::Domore(_)) {
        return Err(needs_map());
    }
    let progress = Arc::new(Progress::default());
    options.progress = Some(progress.clone());
    let started = Instant::now();
    let report = watched(&progress, options.scans, arguments.seconds, || match &second {
        AnyProject::Rslogix(other) => {
            let other_named = Named { family: None, ..options.other.clone() };
            let options = Options { other: other_named, ..options.clone() };
            prove_slc(&original.main, &other.main, map.as_deref(), &options)
        }
        AnyProject::Domore(document) => {
            let fates = fates(&document.project);
            prove_domore(
                &original.main,
                &document.project,
                map.as_deref().unwrap_or_default(),
                fates.as_deref(),
                &options,
            )
        }
    });
    let seconds = started.elapsed().as_secs_f64();
    if let Some(folder) = &arguments.out {
        write(&report, folder)?;
    }
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let names = [&arguments.original, &arguments.other].map(|path| path.display().to_string());
        writeln!(out, "{}", describe(&report, &names))?;
    } else {
        write!(out, "{}", printable(&report.to_string()))?;
        if std::io::stderr().is_terminal() {
            eprintln!("{:.0} scan pairs a second", report.scans as f64 / seconds.max(1e-9));
        }
    }
    Ok(outcome(&report))
}

/// A Do-more program has nothing at the addresses of the original.
pub fn needs_map() -> Error {
    Error::Use("--map is needed: the address map `rungs migrate` wrote".to_owned())
}

/// Runs `work` with a bar on a terminal, and ends it after a time.
pub fn watched<T>(progress: &Progress, scans: u64, limit: Option<Duration>, work: impl FnOnce() -> T) -> T {
    let bar = if std::io::stderr().is_terminal() { ProgressBar::new(scans) } else { ProgressBar::hidden() };
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {human_pos}/{human_len} scans {elapsed} {wide_msg}") {
        bar.set_style(style);
    }
    let done = AtomicBool::new(false);
    let started = Instant::now();
    std::thread::scope(|scope| {
        let watcher = scope.spawn(|| {
            while !done.load(Ordering::Relaxed) {
                std::thread::park_timeout(LOOK);
                bar.set_position(progress.scans());
                bar.set_message(match (progress.is_arguing(), progress.is_shortening()) {
                    (true, _) => "looking for what cannot happen",
                    (_, true) => "shortening the way to a difference",
                    _ => "",
                });
                if limit.is_some_and(|limit| started.elapsed() >= limit) {
                    progress.stop();
                }
            }
        });
        let result = work();
        done.store(true, Ordering::Relaxed);
        watcher.thread().unpark();
        bar.finish_and_clear();
        result
    })
}

/// How a proof counts: anything but "no difference found" is a finding.
pub fn outcome(report: &Report) -> Outcome {
    match report.verdict() {
        Verdict::NoDifference => Outcome::Done,
        Verdict::Different | Verdict::NotComparable => Outcome::Finding,
    }
}

/// A program that was read whole: a proof of half a program would prove nothing.
pub fn open(path: &Path) -> Result<AnyProject, String> {
    let named = |why: String| format!("{}: {why}", path.display());
    let bytes = read_file(path, MOST_BYTES).map_err(named)?;
    let project =
        convert::open_any(&bytes, &file_name(path), rss::Mode::Permissive).map_err(|e| named(e.to_string()))?;
    let worst = match &project {
        AnyProject::Rslogix(project) => {
            let errors = project.diagnostics.iter().find(|found| found.severity == Severity::Error);
            errors.map(|found| format!("{}: {}", found.place, found.message))
        }
        AnyProject::Domore(document) => {
            let errors = document.diagnostics.iter().find(|found| found.problem.severity() == Severity::Error);
            errors.map(ToString::to_string)
        }
    };
    match worst {
        Some(worst) => Err(named(format!("not all of it could be read: {worst}"))),
        None => Ok(project),
    }
}

/// A row that places nothing would leave its data uncompared without a word.
pub fn refuse(
    original: &ladder::Image,
    other: &AnyProject,
    map: &[Mapping],
    numbers: &[usize],
    path: &Path,
    options: &Options,
) -> Result<(), Error> {
    let refused = match other {
        AnyProject::Rslogix(other) => refused_slc(original, &other.main, map, options),
        AnyProject::Domore(document) => refused_domore(original, &document.project, map, options),
    };
    let number = |index: usize| numbers.get(index).copied().unwrap_or(0);
    let line = |found: &Refused| {
        let with = found.with.map(|with| format!(" (row {})", number(with))).unwrap_or_default();
        format!("{}: address map, row {}: {}{with}", path.display(), number(found.row), found.why)
    };
    match refused.is_empty() {
        true => Ok(()),
        false => Err(Error::Use(refused.iter().map(line).collect::<Vec<_>>().join("\n"))),
    }
}

/// The rows that place data, each with its number in the file, from 1.
pub fn mappings(path: &Path) -> Result<Vec<(usize, Mapping)>, String> {
    let named = |why: String| format!("{}: {why}", path.display());
    let bytes = read_file(path, MOST_MAP).map_err(named)?;
    let text = String::from_utf8(bytes).map_err(|_| named("not UTF-8 text".to_owned()))?;
    let rows = map_file::read(&text).map_err(|error| named(error.to_string()))?;
    Ok(numbered(&rows).collect())
}

/// The rows that place data.
pub fn of_rows(rows: &[MapRow]) -> Vec<Mapping> {
    numbered(rows).map(|(_, mapping)| mapping).collect()
}

fn numbered(rows: &[MapRow]) -> impl Iterator<Item = (usize, Mapping)> {
    let placed = (1..).zip(rows).filter(|(_, row)| row.places_data());
    placed.map(|(number, row)| {
        (number, Mapping { original: row.slc.clone(), words: row.words, other: row.domore.clone() })
    })
}

/// A path as a scenario in `folder` names it.
pub fn beside(path: &Path, folder: &Path) -> String {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (path, folder) = (absolute(path), absolute(folder));
    let shared = path.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    let mut relative: PathBuf = folder.components().skip(shared).map(|_| "..").collect();
    relative.extend(path.components().skip(shared));
    // Nothing in common, as on another drive: only the whole path leads there.
    let found = if shared == 0 { path } else { relative };
    found.to_string_lossy().replace('\\', "/")
}

/// What a run writes to a folder: the report, and what shows a difference.
pub const FILES: [&str; 3] = ["proof.txt", "original.toml", "converted.toml"];

/// Writes the report and, if the programs differ, a scenario for each of them; what an earlier run left is replaced.
pub fn write(report: &Report, folder: &Path) -> Result<(), Error> {
    let failed = |path: &Path, error: std::io::Error| Error::Use(format!("{}: {error}", path.display()));
    std::fs::create_dir_all(folder).map_err(|error| failed(folder, error))?;
    let example = report.found.as_ref().map(|(_, example)| example);
    let texts = [
        Some(report.to_string()),
        example.map(|example| example.original.clone()),
        example.map(|example| example.other.clone()),
    ];
    for (name, text) in FILES.iter().zip(texts) {
        let path = folder.join(name);
        let written = match text {
            Some(text) => std::fs::write(&path, text),
            // A difference of an earlier run must not stand beside a run that found none.
            None if path.is_file() => std::fs::remove_file(&path),
            None => Ok(()),
        };
        written.map_err(|error| failed(&path, error))?;
    }
    Ok(())
}

/// The report as JSON.
pub fn describe(report: &Report, names: &[String; 2]) -> Value {
    // No percentage of nothing: a reader would take 100 for all of it.
    let percent = |found: Coverage| (report.scans > 0).then(|| found.percent());
    let coverage = |found: Coverage| json!({"reached": found.reached, "all": found.all, "percent": percent(found)});
    let goal = |goal: &Goal| {
        json!({
            "file": goal.location.file, "rung": goal.location.rung, "instruction": goal.location.instruction,
            "text": goal.text, "what": goal.kind.as_str(), "impossible": goal.impossible,
        })
    };
    let rungs: Vec<Value> = report
        .rungs()
        .iter()
        .map(|rung| {
            json!({
                "file": rung.file, "rung": rung.rung, "reached": rung.coverage.reached, "all": rung.coverage.all,
                "missing": rung.missing.iter().map(goal).collect::<Value>(),
            })
        })
        .collect();
    let pairs = |all: &[(String, String)]| -> Value {
        all.iter().map(|(address, why)| json!({"address": address, "why": why})).collect()
    };
    let found = report.found.as_ref().map(|(_, example)| {
        json!({
            "what": example.what, "scans": example.scans, "changes": example.changes,
            "original": example.original, "other": example.other,
        })
    });
    json!({
        "schema": "rungs.proof/1",
        "original": names[0],
        "other": names[1],
        "verdict": report.verdict().as_str(),
        "seed": report.seed,
        "scans": report.scans,
        "stretches": report.episodes,
        "time_s": report.time.as_secs_f64(),
        "mode_changes": report.mode_changes,
        "stopped_alike": report.stops,
        "left_conditions": report.outside,
        "inputs": report.inputs,
        "compared_words": report.compared,
        "not_compared_words": report.not_compared,
        "coverage": {
            "rung_conditions": coverage(report.conditions_covered()),
            "done": coverage(report.coverage(|kind| matches!(kind, GoalKind::Done | GoalKind::NotDone))),
            "boundaries": coverage(report.coverage(|kind| {
                matches!(kind, GoalKind::Equal | GoalKind::JustBelow | GoalKind::JustAbove)
            })),
        },
        "other_coverage": coverage(report.other_coverage),
        "rungs": rungs,
        "impossible": report.impossible_goals().map(goal).collect::<Value>(),
        "difference": found,
        "not_comparable": report.incomparable,
        "rung_identity_checked": !report.identity_unchecked,
        "missing_rungs": report.missing_rungs,
        "persons": report.persons,
        "conditions": report.conditions,
        "unmapped": pairs(&report.unmapped),
        "notes": report.notes,
        "approximations": {"original": report.approximations[0], "other": report.approximations[1]},
        "not_exercised": NOT_MODELLED,
    })
}
