//! What changed between two saves, in words a person can follow.

use std::collections::BTreeMap;

use analysis::diff::{Change, ChangeKind, Difference, LogicChange, RungChange, ValueChange};
use report::diff::sentence;

use crate::commands::diff::text::headline;

/// Columns of one line of a change; what is longer is cut, `rungs diff` has it whole.
const WIDTH: usize = 110;

/// Changes of one section.
pub struct Section {
    pub title: &'static str,
    /// How much of what changed: `2 rungs changed, 1 inserted`.
    pub sum: String,
    /// One line for each change.
    pub lines: Vec<String>,
}

/// Sections in which something changed, logic first.
pub fn sections(difference: &Difference) -> Vec<Section> {
    let all = [
        logic(difference),
        named("Documentation", &difference.documentation),
        values(&difference.values),
        named("Configuration", &difference.configuration),
    ];
    all.into_iter().flatten().collect()
}

/// `1 rung`, `2 rungs`.
fn count(number: usize, one: &str, many: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { many })
}

fn logic(difference: &Difference) -> Option<Section> {
    if difference.logic.is_empty() {
        return None;
    }
    let (mut kinds, mut files, mut lines) = (BTreeMap::new(), Vec::new(), Vec::new());
    for found in &difference.renames {
        lines.push(format!("{} is now {} ({} operands)", found.old, found.new, found.operands));
    }
    let mut renamed = 0;
    for change in &difference.logic {
        match change {
            LogicChange::File(file) => {
                let told = match (file.kind, file.old, file.new) {
                    (ChangeKind::Moved, Some(old), Some(new)) => format!("program file {old} is now {new}"),
                    (_, None, Some(new)) => format!("program file {new} is new"),
                    (_, Some(old), _) => format!("program file {old} is gone"),
                    _ => continue,
                };
                lines.push(format!("{told} ({})", count(file.rungs, "rung", "rungs")));
                files.push(told);
            }
            LogicChange::Rung(rung) if rung.only_rename => renamed += 1,
            LogicChange::Rung(rung) => {
                *kinds.entry(rung.kind).or_insert(0_usize) += 1;
                lines.push(rung_line(rung));
            }
        }
    }
    let mut sums = files;
    for (nth, (kind, number)) in kinds.into_iter().enumerate() {
        sums.push(if nth == 0 {
            format!("{} {kind}", count(number, "rung", "rungs"))
        } else {
            format!("{number} {kind}")
        });
    }
    if renamed > 0 {
        sums.push(format!("{} with renamed addresses only", count(renamed, "rung", "rungs")));
    }
    Some(Section { title: "Logic", sum: sums.join(", "), lines })
}

fn rung_line(rung: &RungChange) -> String {
    let mut line = headline(rung);
    if let Some(rest) = line.strip_prefix("File ") {
        line = format!("file {rest}");
    }
    let words = if rung.kind == ChangeKind::Deleted { &rung.old_words } else { &rung.new_words };
    let text = || words.iter().map(|word| word.text.as_str()).collect::<Vec<_>>().join(" ");
    let edits = || rung.edits.iter().map(|edit| sentence(edit, None)).collect::<Vec<_>>().join("; ");
    let told = if rung.edits.is_empty() { text() } else { edits() };
    cut(&format!("{line}: {}", if told.is_empty() { "an empty rung" } else { &told }))
}

fn cut(text: &str) -> String {
    let text = text.split(['\r', '\n']).map(str::trim).filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" / ");
    if text.chars().count() <= WIDTH {
        return text;
    }
    text.chars().take(WIDTH - 3).chain("...".chars()).collect()
}

fn named(title: &'static str, changes: &[Change]) -> Option<Section> {
    if changes.is_empty() {
        return None;
    }
    let mut sums: Vec<(&str, [usize; 3])> = Vec::new();
    for change in changes {
        let place = match change.kind() {
            ChangeKind::Inserted => 0,
            ChangeKind::Deleted => 1,
            _ => 2,
        };
        let sum = match sums.iter().position(|(what, _)| *what == change.what) {
            Some(at) => at,
            None => {
                sums.push((change.what, [0; 3]));
                sums.len() - 1
            }
        };
        if let Some(number) = sums.get_mut(sum).and_then(|(_, counts)| counts.get_mut(place)) {
            *number += 1;
        }
    }
    let sum = sums.iter().map(|(what, counts)| {
        if *what == "processor" {
            // There is one processor: its fields tell more than their number.
            let fields = changes.iter().filter(|change| change.what == "processor").map(|change| change.name.as_str());
            return fields.collect::<Vec<_>>().join(", ");
        }
        let mut words = counts.iter().zip(["added", "removed", "changed"]).filter(|(number, _)| **number > 0);
        let first = words.next().map(|(number, word)| format!("{number} {} {word}", things(what, *number)));
        let rest = words.map(|(number, word)| format!("{number} {word}"));
        first.into_iter().chain(rest).collect::<Vec<_>>().join(", ")
    });
    let sum = sum.collect::<Vec<_>>().join("; ");
    let line = |change: &Change| {
        let name = format!("{} {}", change.what, change.name);
        match (&change.old, &change.new) {
            (Some(old), Some(new)) => {
                let (old, new) = differing_part(old, new);
                cut(&format!("{name}: {} -> {}", empty(&old), empty(&new)))
            }
            (None, Some(new)) => cut(&format!("{name} added: {}", empty(new))),
            (Some(old), None) => cut(&format!("{name} removed: {}", empty(old))),
            (None, None) => cut(&name),
        }
    };
    Some(Section { title, sum, lines: changes.iter().map(line).collect() })
}

/// The plural of a thing, if there are several.
fn things(what: &str, number: usize) -> String {
    match what.split_once(' ') {
        _ if number == 1 || what == "I/O" => what.to_owned(),
        Some(("comment", rest)) => format!("comments {rest}"),
        _ => format!("{what}s"),
    }
}

fn empty(text: &str) -> &str {
    if text.trim().is_empty() { "(empty)" } else { text }
}

/// The lines of two texts that are not in the other one; both whole if that leaves nothing.
fn differing_part(old: &str, new: &str) -> (String, String) {
    if !old.contains('\n') && !new.contains('\n') {
        return (old.to_owned(), new.to_owned());
    }
    let only = |text: &str, other: &str| {
        let lines: Vec<&str> = text.lines().filter(|line| !other.lines().any(|same| same == *line)).collect();
        lines.join("\n")
    };
    let (a, b) = (only(old, new), only(new, old));
    if a.trim().is_empty() && b.trim().is_empty() { (old.to_owned(), new.to_owned()) } else { (a, b) }
}

/// What a value is to a person: set by somebody, or left by the running program.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Preset,
    Table,
    Forces,
    Running,
}

fn kind(change: &ValueChange) -> Kind {
    let letters: String = change.file.chars().take_while(char::is_ascii_alphabetic).collect();
    let member = change.first.rsplit_once('.').map_or("", |(_, member)| member);
    let forces = change.new.iter().any(|value| value.starts_with("forced on"));
    match letters.as_str() {
        _ if forces => Kind::Forces,
        "T" | "C" if member == "PRE" => Kind::Preset,
        "R" if member == "LEN" => Kind::Preset,
        "N" | "F" | "L" | "ST" | "A" | "PD" | "MG" | "B" => Kind::Table,
        _ => Kind::Running,
    }
}

fn values(changes: &[ValueChange]) -> Option<Section> {
    if changes.is_empty() {
        return None;
    }
    let mut sorted: Vec<(Kind, &ValueChange)> = changes.iter().map(|change| (kind(change), change)).collect();
    sorted.sort_by_key(|(kind, _)| *kind);
    let number = |wanted: Kind| -> usize {
        sorted.iter().filter(|(kind, _)| *kind == wanted).map(|(_, change)| change.new.len()).sum()
    };
    let mut sums = Vec::new();
    match number(Kind::Preset) {
        0 => {}
        presets => sums.push(count(presets, "preset", "presets")),
    }
    if number(Kind::Table) > 0 {
        let mut files: Vec<(&str, usize)> = Vec::new();
        for (_, change) in sorted.iter().filter(|(kind, _)| *kind == Kind::Table) {
            match files.iter_mut().find(|(file, _)| *file == change.file) {
                Some((_, number)) => *number += change.new.len(),
                None => files.push((&change.file, change.new.len())),
            }
        }
        let files = files.iter().map(|(file, number)| format!("{number} in {file}")).collect::<Vec<_>>().join(", ");
        sums.push(format!("data table: {files}"));
    }
    if number(Kind::Forces) > 0 {
        sums.push(format!("forces at {}", count(number(Kind::Forces), "word", "words")));
    }
    if number(Kind::Running) > 0 {
        let running = number(Kind::Running);
        sums.push(format!(
            "{} of timers, counters, inputs, outputs and status",
            count(running, "running value", "running values")
        ));
    }
    let line = |change: &ValueChange| {
        let places = match change.first == change.last {
            true => change.first.clone(),
            false => format!("{} .. {}", change.first, change.last),
        };
        cut(&format!("{places}: {} -> {}", change.old.join(" "), change.new.join(" ")))
    };
    // Running values are counted only: each run of the machine leaves others.
    let told = sorted.iter().filter(|(kind, _)| *kind != Kind::Running);
    Some(Section { title: "Values", sum: sums.join("; "), lines: told.map(|(_, change)| line(change)).collect() })
}
