//! `rungs history`: the saves of each machine in order, and what changed from one to the next.

mod repository;
mod words;

use std::io::{IsTerminal, Write};
use std::path::PathBuf;

use analysis::history::{Entry, Machine, Order, Save, Step, machines, steps};
use convert::AnyProject;
use jiff::Timestamp;
use ladder::{Project, Severity};
use serde_json::{Value, json};

use super::{MOST_BYTES, diagnostics_json, diff, file_name, mode, open, read_file};
use crate::args::HistoryArguments;
use crate::files;
use crate::listing;
use crate::output::{Error, Outcome, Printable, printable};
use repository::Commit;

/// Changes of one section that are listed without `--full`.
const SHOWN: usize = 6;

/// The saves that could be read, with their paths.
struct Archive {
    paths: Vec<PathBuf>,
    saves: Vec<Save>,
}

pub fn run(arguments: &HistoryArguments) -> Result<Outcome, Error> {
    let terminal = std::io::stdout().is_terminal();
    let mut out = crate::output::standard(arguments.json);
    let (archive, mut outcome) = read(arguments, terminal, &mut out)?;
    let found = machines(&archive.saves);
    let wanted = |machine: &Machine| {
        let Some(text) = arguments.machine.as_deref().map(str::to_lowercase) else { return true };
        let mut files = machine.saves.iter().filter_map(|entry| archive.paths.get(entry.save));
        machine.name.to_lowercase().contains(&text)
            || files.any(|path| path.display().to_string().to_lowercase().contains(&text))
    };
    let chosen: Vec<&Machine> = found.iter().filter(|machine| wanted(machine)).collect();
    if chosen.is_empty() && outcome == Outcome::Done {
        return Err(Error::Use("no machine of this name among the saves".to_owned()));
    }
    if let Some(target) = &arguments.to_git {
        repository::check_target(target).map_err(Error::Use)?;
    }
    let writer = Writer { arguments, archive: &archive, machines: &found };
    let (mut commits, mut names) = (Vec::new(), repository::Names::default());
    if !arguments.json && !chosen.is_empty() {
        writer.overview(&chosen, &mut out)?;
    }
    for machine in chosen {
        let projects = projects(&archive, machine, arguments)?;
        let refs: Vec<&Project> = projects.iter().collect();
        let steps = steps(&refs);
        if arguments.to_git.is_some() {
            commits.push(writer.commits(machine, &names.take(&machine.name), &refs, &steps));
        }
        if arguments.json {
            writeln!(out, "{}", writer.json(machine, &refs, &steps))?;
        } else if arguments.to_git.is_none() {
            writer.text(machine, &refs, &steps, &mut out)?;
        }
        out.flush()?;
        for (project, entry) in projects.iter().zip(&machine.saves) {
            if report_errors(project, &writer.path(entry.save)) {
                outcome = outcome.max(Outcome::Unreadable);
            }
        }
    }
    if let Some(target) = &arguments.to_git {
        let (machines, commits) = (commits.len(), in_time(commits));
        repository::write(target, &commits).map_err(Error::Use)?;
        if !arguments.json {
            let (commits, folders) = (plural(commits.len(), "commit"), plural(machines, "folder"));
            let line = format!("{}: {commits}, {folders}", target.display());
            writeln!(Printable(&mut out), "{line}")?;
        }
    }
    out.flush()?;
    Ok(outcome)
}

/// Commits of all machines one after the other by their times; those of a machine keep their order.
fn in_time(machines: Vec<Vec<Commit>>) -> Vec<Commit> {
    let mut keyed: Vec<(i64, usize, usize, Commit)> = Vec::new();
    for (machine, commits) in machines.into_iter().enumerate() {
        let mut time = i64::MIN;
        for (number, commit) in commits.into_iter().enumerate() {
            time = commit.time.unwrap_or(time).max(time);
            keyed.push((time, machine, number, commit));
        }
    }
    keyed.sort_by_key(|(time, machine, number, _)| (*time, *machine, *number));
    keyed.into_iter().map(|(.., commit)| commit).collect()
}

/// Findings of the reader that are named of one save; `rungs info --json` has all.
const NAMED: usize = 3;

/// Says what of a save could not be read, true if something is missing.
fn report_errors(project: &Project, name: &str) -> bool {
    for found in project.diagnostics.iter().filter(|found| found.severity >= Severity::Warning).take(NAMED) {
        let severity = found.severity.as_str();
        eprintln!("{}", printable(&format!("{name}: {severity}: {}: {}", found.place, found.message)));
    }
    project.diagnostics.iter().any(|found| found.severity == Severity::Error)
}

/// What is known of each save. Programs are not kept: an archive can be larger than memory.
fn read(arguments: &HistoryArguments, terminal: bool, out: &mut dyn Write) -> Result<(Archive, Outcome), Error> {
    let paths = files::expand(&arguments.files, files::PROJECTS).map_err(Error::Use)?;
    let bar = files::progress(paths.len(), terminal);
    let mut archive = Archive { paths: Vec::new(), saves: Vec::new() };
    let mut outcome = Outcome::Done;
    for path in paths {
        bar.set_message(path.display().to_string());
        let found = read_file(&path, MOST_BYTES).and_then(|bytes| {
            convert::open_any(&bytes, &file_name(&path), mode(arguments.strict)).map_err(|error| error.to_string())
        });
        match found {
            Ok(AnyProject::Domore(_)) => {
                let name = path.display().to_string();
                bar.suspend(|| eprintln!("{}", printable(&format!("{name}: left out: a program of Do-more"))));
            }
            Ok(AnyProject::Rslogix(project)) => {
                let modified = std::fs::metadata(&path).and_then(|data| data.modified()).ok();
                let modified = modified.and_then(|time| Timestamp::try_from(time).ok());
                let seconds = modified.and_then(|time| Timestamp::from_second(time.as_second()).ok());
                let save = Save::of(&file_name(&path), &project, seconds.map(|time| time.to_string()));
                archive.saves.push(save);
                archive.paths.push(path);
            }
            Err(why) => {
                let name = path.display().to_string();
                if arguments.json {
                    writeln!(out, "{}", json!({"file": name, "error": why}))?;
                }
                bar.suspend(|| eprintln!("{}", printable(&format!("{name}: {why}"))));
                outcome = outcome.max(Outcome::Unreadable);
            }
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok((archive, outcome))
}

/// The programs of a machine, in order.
fn projects(archive: &Archive, machine: &Machine, arguments: &HistoryArguments) -> Result<Vec<Project>, Error> {
    let paths = machine.saves.iter().filter_map(|entry| archive.paths.get(entry.save));
    let one = |path: &PathBuf| {
        open(path, mode(arguments.strict))
            .map_err(|why| Error::Use(format!("{}: changed while it was read: {why}", path.display())))
    };
    paths.map(one).collect()
}

struct Writer<'a> {
    arguments: &'a HistoryArguments,
    archive: &'a Archive,
    machines: &'a [Machine],
}

impl Writer<'_> {
    fn save(&self, entry: &Entry) -> Option<&Save> {
        self.archive.saves.get(entry.save)
    }

    fn path(&self, index: usize) -> String {
        self.archive.paths.get(index).map(|path| path.display().to_string()).unwrap_or_default()
    }

    /// File name, with its folder where another save of the machine has the same name.
    fn shown(&self, machine: &Machine, index: usize) -> String {
        let name = |index: usize| self.archive.saves.get(index).map(|save| save.file.as_str()).unwrap_or_default();
        let all =
            || machine.saves.iter().flat_map(|entry| std::iter::once(entry.save).chain(entry.copies.iter().copied()));
        if all().filter(|other| name(*other) == name(index)).count() > 1 {
            return self.path(index);
        }
        name(index).to_owned()
    }

    fn overview(&self, chosen: &[&Machine], out: &mut dyn Write) -> Result<(), Error> {
        let saves: usize = chosen.iter().map(|machine| machine.saves.len()).sum();
        let copies: usize = chosen.iter().flat_map(|machine| &machine.saves).map(|entry| entry.copies.len()).sum();
        let files = saves + copies;
        let copies = if copies == 1 { "1 copy".to_owned() } else { format!("{copies} copies") };
        let (machines, saves) = (plural(chosen.len(), "machine"), plural(saves, "save"));
        writeln!(out, "{}: {machines}, {saves}, {copies} of the same bytes", plural(files, "file"))?;
        Ok(())
    }

    fn text(&self, machine: &Machine, projects: &[&Project], steps: &[Step], out: &mut dyn Write) -> Result<(), Error> {
        let mut out = Printable(out);
        let last = machine.saves.last().and_then(|entry| self.save(entry));
        let processor = last.map(|save| {
            let name = if save.processor_name.is_empty() { "without a name" } else { &save.processor_name };
            // A name of several lines must not look like lines of this report.
            let name = name.lines().collect::<Vec<_>>().join(" ");
            format!("processor {name}, {}", if save.catalog.is_empty() { "model not known" } else { &save.catalog })
        });
        writeln!(out, "\n{}", "=".repeat(78))?;
        writeln!(out, "{}   ({})", machine.name, processor.unwrap_or_default())?;
        if machine.saves.len() > 1 {
            writeln!(out, "  Order: {}", self.order(machine))?;
        }
        for why in machine.evidence.iter().take(SHOWN) {
            writeln!(out, "  Together by: {why}")?;
        }
        if machine.evidence.len() > SHOWN {
            writeln!(out, "  Together by: {} more of these (--json has all)", machine.evidence.len() - SHOWN)?;
        }
        for (place, shared) in &machine.related {
            let name = self.machines.get(*place).map(|other| other.name.as_str()).unwrap_or_default();
            writeln!(out, "  Related: {name}, {} % of the instructions", shared / 10)?;
        }
        for note in &machine.notes {
            writeln!(out, "  Note: {note}.")?;
        }
        let mut before: Option<&Entry> = None;
        for (number, entry) in machine.saves.iter().enumerate() {
            let step = number.checked_sub(1).and_then(|step| steps.get(step));
            self.entry(machine, (number, entry, before), projects, step, &mut out)?;
            before = Some(entry);
        }
        Ok(())
    }

    /// What the order of a machine's saves rests on.
    fn order(&self, machine: &Machine) -> String {
        let mut kinds: Vec<_> = machine.saves.iter().map(|entry| entry.order).collect();
        kinds.sort_unstable();
        kinds.dedup();
        kinds.into_iter().map(|kind| kind.as_str()).collect::<Vec<_>>().join("; ")
    }

    fn entry(
        &self,
        machine: &Machine,
        (number, entry, before): (usize, &Entry, Option<&Entry>),
        projects: &[&Project],
        step: Option<&Step>,
        out: &mut dyn Write,
    ) -> Result<(), Error> {
        let when = entry.when.as_deref().map_or_else(|| "time not known".to_owned(), time);
        let later = before
            .filter(|before| before.order == entry.order)
            .and_then(|before| interval(before.when.as_deref()?, entry.when.as_deref()?));
        let later = later.map(|later| format!("  ({later} later)")).unwrap_or_default();
        let by = match entry.order {
            analysis::history::Order::SaveTime => String::new(),
            other => format!("  [{}]", other.as_str()),
        };
        writeln!(out, "\n  {:>3}  {when}  {}{later}{by}", number + 1, self.shown(machine, entry.save))?;
        for copy in &entry.copies {
            writeln!(out, "       the same bytes: {}", self.shown(machine, *copy))?;
        }
        let Some(project) = projects.get(number) else { return Ok(()) };
        let errors = project.diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
        if errors > 0 {
            writeln!(out, "       not all of it could be read ({errors} errors): see `rungs info --json`")?;
        }
        let Some(step) = step else {
            let rungs: usize = project.main.ladder_files().map(|file| file.rungs.len()).sum();
            let files = project.main.ladder_files().count();
            writeln!(out, "       {} in {}", plural(rungs, "rung"), plural(files, "program file"))?;
            return Ok(());
        };
        if step.change.is_empty() {
            writeln!(out, "       nothing changed in program, documentation, values and configuration")?;
            return Ok(());
        }
        if let Some(same) = step.same_as {
            writeln!(out, "       the same content as save {}", same + 1)?;
        } else if let Some(back) = step.logic_as {
            writeln!(out, "       the logic of save {} again", back + 1)?;
        }
        let sections = words::sections(&step.change);
        if step.change.logic.is_empty() {
            writeln!(out, "       Logic: equal")?;
        }
        for section in sections {
            writeln!(out, "       {}: {}", section.title, section.sum)?;
            let most = if self.arguments.full { usize::MAX } else { SHOWN };
            for line in section.lines.iter().take(most) {
                writeln!(out, "         {line}")?;
            }
            if section.lines.len() > most {
                writeln!(out, "         and {} more", section.lines.len() - most)?;
            }
        }
        for note in &step.change.notes {
            writeln!(out, "       Note: {note}.")?;
        }
        Ok(())
    }

    /// The saves as commits, in their order.
    fn commits(&self, machine: &Machine, folder: &str, projects: &[&Project], steps: &[Step]) -> Vec<Commit> {
        let all = machine.saves.iter().zip(projects).enumerate();
        let commits = all.map(|(number, (entry, project))| {
            let step = number.checked_sub(1).and_then(|step| steps.get(step));
            let (subject, mut body) = told(step);
            let source = &project.source;
            body.push_str(&format!("\nFile: {}\n", self.shown(machine, entry.save)));
            entry.copies.iter().for_each(|copy| {
                body.push_str(&format!("Same bytes: {}\n", self.shown(machine, *copy)));
            });
            body.push_str(&format!("SHA-256: {}\nPlace in the history by: {}\n", source.sha256, entry.order.as_str()));
            match (&entry.when, entry.order) {
                (Some(when), Order::SaveTime) => body.push_str(&format!("Saved: {when}\n")),
                (Some(when), _) => body.push_str(&format!("Date, not of the save: {when}\n")),
                (None, _) => body.push_str("Date: not known, that of the commit before\n"),
            }
            body.push_str("Author: the project names no person; the program that saved it stands there\n");
            let application = if source.application.is_empty() { "RSLogix 500" } else { &source.application };
            Commit {
                folder: folder.to_owned(),
                subject: format!("{subject} ({})", machine.name),
                body,
                time: entry.when.as_deref().and_then(repository::seconds),
                author: format!("{application} {}", source.saved_by),
                texts: listing::texts(project),
            }
        });
        commits.collect()
    }

    fn json(&self, machine: &Machine, projects: &[&Project], steps: &[Step]) -> Value {
        let name = |place: usize| self.machines.get(place).map(|machine| machine.name.clone());
        let saves = machine.saves.iter().enumerate().map(|(number, entry)| {
            let save = self.save(entry);
            let step = number.checked_sub(1).and_then(|step| steps.get(step));
            let before = number.checked_sub(1).and_then(|before| machine.saves.get(before));
            let changes = step.zip(before).map(|(step, before)| {
                let mut changes = diff::json::describe(&self.path(before.save), &self.path(entry.save), &step.change);
                let summary = words::sections(&step.change);
                changes["summary"] =
                    summary.iter().map(|section| format!("{}: {}", section.title, section.sum)).collect();
                changes
            });
            json!({
                "file": self.path(entry.save),
                "saved_at": save.and_then(|save| save.saved_at.clone()),
                "created_at": save.and_then(|save| save.created_at.clone()),
                "program_id": save.and_then(|save| save.program_id).map(|id| format!("{id:x}")),
                "order_by": entry.order.key(),
                "order_time": entry.when,
                "same_bytes": entry.copies.iter().map(|copy| self.path(*copy)).collect::<Vec<_>>(),
                "same_content_as": step.and_then(|step| step.same_as),
                "logic_as": step.and_then(|step| step.logic_as),
                "changes": changes,
                "diagnostics": projects.get(number).map(|project| diagnostics_json(project)),
            })
        });
        let saves: Vec<Value> = saves.collect();
        let last = machine.saves.last().and_then(|entry| self.save(entry));
        let related = machine.related.iter();
        let related = related.map(
            |(place, shared)| json!({"machine": name(*place), "instructions_in_common": f64::from(*shared) / 1000.0}),
        );
        json!({
            "machine": machine.name,
            "processor_name": last.map(|save| save.processor_name.clone()),
            "catalog": last.map(|save| save.catalog.clone()),
            "evidence": machine.evidence,
            "notes": machine.notes,
            "related": related.collect::<Vec<_>>(),
            "saves": saves,
        })
    }
}

/// Lines of one section in a commit message: the changed files have the rest.
const TOLD: usize = 40;

/// What a step did: one line, and all of it.
fn told(step: Option<&Step>) -> (String, String) {
    let Some(step) = step else { return ("first save".to_owned(), String::new()) };
    let sections = words::sections(&step.change);
    let mut body = String::new();
    for section in &sections {
        body.push_str(&format!("{}: {}\n", section.title, section.sum));
        section.lines.iter().take(TOLD).for_each(|line| body.push_str(&format!("  {line}\n")));
        if section.lines.len() > TOLD {
            body.push_str(&format!("  and {} more\n", section.lines.len() - TOLD));
        }
    }
    let subject = match sections.first() {
        None => "nothing changed".to_owned(),
        // Logic needs no word before it.
        Some(section) if section.title == "Logic" => section.sum.clone(),
        Some(section) => {
            let titles: Vec<&str> = sections.iter().map(|section| section.title).collect();
            match titles.as_slice() {
                [only] => format!("{}: {}", only.to_lowercase(), section.sum),
                _ => format!("{}; logic equal", titles.join(", ").to_lowercase()),
            }
        }
    };
    (subject, body)
}

pub(super) fn plural(number: usize, one: &str) -> String {
    format!("{number} {one}{}", if number == 1 { "" } else { "s" })
}

/// `2017-04-06 20:39:39`, for a time in UTC.
fn time(text: &str) -> String {
    text.replacen('T', " ", 1).trim_end_matches('Z').to_owned()
}

/// How long after: in the unit a person would use.
fn interval(from: &str, to: &str) -> Option<String> {
    let (from, to): (Timestamp, Timestamp) = (from.parse().ok()?, to.parse().ok()?);
    let seconds = to.as_second().checked_sub(from.as_second()).filter(|seconds| *seconds >= 0)?;
    let units = [
        (2 * 31_557_600, 31_557_600, "years"),
        (2 * 86_400, 86_400, "days"),
        (7200, 3600, "hours"),
        (120, 60, "minutes"),
    ];
    let unit = units.iter().find(|(least, ..)| seconds >= *least);
    Some(match unit {
        Some((_, length, name)) => format!("{} {name}", seconds / length),
        None => format!("{seconds} seconds"),
    })
}
