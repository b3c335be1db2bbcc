//! `rungs merge-driver`: merges two saves of a project for git, or says what a person must decide.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use analysis::diff::{Side as Compared, compare};
use analysis::merge::{Conflict, Merge, Piece, RungConflict, Side, merge};
use convert::to_rss::merge::{FileSource, RungSource, Sides, Whole, merged_file};
use ladder::{Image, Project, Severity, Source};
use rss::Mode;

use super::{MOST_BYTES, read_file};
use crate::args::MergeArguments;
use crate::listing;
use crate::output::{Error, Outcome, printable};

/// A side as it was read.
struct Opened {
    file: rss::Project,
    project: Project,
}

pub fn run(arguments: &MergeArguments) -> Result<Outcome, Error> {
    let name = &arguments.path;
    let say = |text: &str| eprintln!("{}", printable(&format!("{name}: {text}")));
    let mut opened = Vec::new();
    for (path, side) in [(&arguments.base, "base"), (&arguments.ours, "ours"), (&arguments.theirs, "theirs")] {
        match open(path) {
            Ok(side) => opened.push(side),
            Err(why) => {
                say(&format!("not merged, ours stays: {side}: {why}"));
                return Ok(Outcome::Finding);
            }
        }
    }
    let [base, ours, theirs] = opened.as_slice() else { return Ok(Outcome::Finding) };
    let merged = merge(&base.project.main, &ours.project.main, &theirs.project.main);
    merged.notes.iter().for_each(|note| say(note));
    if !merged.is_clean() {
        let text = conflicts(&merged, [base, ours, theirs].map(|side| &side.project.main));
        let count = super::history::plural(merged.count(), "conflict");
        let beside = beside(name);
        match write_new(&beside, &text) {
            Ok(()) => say(&format!("{count}, see {}; ours stays", beside.display())),
            Err(why) => say(&format!("{count}; ours stays. {}: {why}\n{text}", beside.display())),
        }
        return Ok(Outcome::Finding);
    }
    let bytes = match built([base, ours, theirs], &merged) {
        Ok(None) => return Ok(Outcome::Done),
        Ok(Some((bytes, notes))) => {
            notes.iter().for_each(|note| say(note));
            bytes
        }
        Err(why) => {
            say(&format!("merged without conflicts, but the result cannot be written; ours stays: {why}"));
            return Ok(Outcome::Finding);
        }
    };
    std::fs::write(&arguments.ours, bytes)
        .map_err(|error| Error::Use(format!("{}: {error}", arguments.ours.display())))?;
    Ok(Outcome::Done)
}

/// A project that is there whole: what could not be read would be lost.
fn open(path: &Path) -> Result<Opened, String> {
    let bytes = read_file(path, MOST_BYTES)?;
    if bytes.is_empty() {
        return Err("there is no such file: it was added on both sides".to_owned());
    }
    let file = rss::Project::read(&bytes, Mode::Permissive).map_err(|error| error.to_string())?;
    let project = convert::from_rss::project(&file, Source::default());
    match project.diagnostics.iter().find(|found| found.severity == Severity::Error) {
        Some(found) => Err(format!("{}: {}", found.place, found.message)),
        None => Ok(Opened { file, project }),
    }
}

/// The bytes of a result and what to know of it.
type Written = (Vec<u8>, Vec<String>);

/// The result as a project file; `None` if it is ours as it stands.
fn built([base, ours, theirs]: [&Opened; 3], merged: &Merge) -> Result<Option<Written>, String> {
    let files: Vec<FileSource> = merged
        .files
        .iter()
        .map(|file| FileSource {
            number: file.number,
            theirs: file.side == Side::Theirs,
            rungs: file.pieces.iter().filter_map(source).collect(),
        })
        .collect();
    let is_theirs = |side| side == Side::Theirs;
    let parts = merged.parts;
    let whole =
        Whole { processor: is_theirs(parts.processor), io: is_theirs(parts.io), channels: is_theirs(parts.channels) };
    let sides = Sides { base: &base.file, ours: &ours.file, theirs: &theirs.file, image: &ours.project.main };
    let written = merged_file(sides, &files, &merged.image, whole).map_err(|error| error.to_string())?;
    let bytes = written.file.write().map_err(|error| error.to_string())?;
    if ours.file.write().is_ok_and(|before| before == bytes) {
        return Ok(None);
    }
    // What was written must say what was merged, whatever the writer knows.
    let back = rss::Project::read(&bytes, Mode::Permissive).map_err(|error| error.to_string())?;
    let back = convert::from_rss::project(&back, Source::default());
    if let Some(found) = back.diagnostics.iter().find(|found| found.severity == Severity::Error) {
        return Err(format!("it would not read back: {}: {}", found.place, found.message));
    }
    let side = |image| Compared { image, documentation: Some(&image.documentation) };
    let difference = compare(side(&merged.image), side(&back.main));
    if !difference.is_empty() {
        let named = difference.documentation.iter().chain(&difference.configuration);
        let named = named.map(|change| format!("{} {}", change.what, change.name));
        let values = difference.values.iter().map(|change| change.first.clone());
        let logic = (!difference.logic.is_empty()).then(|| format!("{} rungs", difference.logic.len()));
        let lost: Vec<String> = logic.into_iter().chain(named).chain(values).take(5).collect();
        return Err(format!("it would lose something: {}", lost.join(", ")));
    }
    let notes = written.notes.iter().map(|note| format!("{}: {}", note.place, note.message));
    Ok(Some((bytes, notes.collect())))
}

fn source(piece: &Piece) -> Option<RungSource> {
    match piece {
        Piece::Rung(rung) => Some(RungSource {
            theirs: rung.side == Side::Theirs,
            file: rung.at.file,
            rung: rung.at.rung,
            comment: rung.comment.clone(),
        }),
        Piece::Conflict(_) => None,
    }
}

/// The conflict file of a path git gave.
fn beside(path: &str) -> PathBuf {
    PathBuf::from(format!("{path}.conflict.slc"))
}

/// Writes a file anew; a link of that name is replaced, not followed.
fn write_new(path: &Path, text: &str) -> Result<(), String> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(error.to_string()),
        _ => {}
    }
    let file = std::fs::OpenOptions::new().write(true).create_new(true).open(path);
    file.and_then(|mut file| std::io::Write::write_all(&mut file, text.as_bytes())).map_err(|error| error.to_string())
}

/// The merged program as text, with both sides where they conflict.
fn conflicts(merged: &Merge, [base, ours, theirs]: [&Image; 3]) -> String {
    let mut out = format!(
        "% {} conflicts. The project itself is still that of ours. Enter what is right in RSLogix, then `git add` it. %\n",
        merged.count()
    );
    for conflict in &merged.conflicts {
        out.push('\n');
        other(conflict, &mut out);
    }
    for file in &merged.files {
        if !file.pieces.iter().any(|piece| matches!(piece, Piece::Conflict(_))) {
            continue;
        }
        let _ = write!(out, "\n% Program file {} %\n", file.number);
        for piece in &file.pieces {
            out.push('\n');
            match piece {
                Piece::Rung(found) => {
                    let image = if found.side == Side::Ours { ours } else { theirs };
                    let stored = image.program_file(found.at.file).and_then(|file| file.rungs.get(found.at.rung));
                    if let Some(rung) = stored {
                        let rung = ladder::Rung { comment: found.comment.clone(), ..rung.clone() };
                        listing::write_rung(image, &rung, &mut out);
                    }
                }
                Piece::Conflict(conflict) => rungs(conflict, [base, ours, theirs], &mut out),
            }
        }
    }
    out
}

fn rungs(conflict: &RungConflict, images: [&Image; 3], out: &mut String) {
    let _ = writeln!(out, "% CONFLICT: {} %", conflict.why);
    let sides = [&conflict.base, &conflict.ours, &conflict.theirs];
    // In the order git uses: ours, base, theirs.
    for (mark, side) in [("<<<<<<< ours", 1), ("||||||| base", 0), ("=======", 2)] {
        let _ = writeln!(out, "{mark}");
        let (Some(image), Some(places)) = (images.get(side), sides.get(side)) else { continue };
        for at in places.iter() {
            if let Some(rung) = image.program_file(at.file).and_then(|file| file.rungs.get(at.rung)) {
                let _ = writeln!(out, "% Rung {}:{} %", at.file, at.rung);
                listing::write_rung(image, rung, out);
            }
        }
    }
    let _ = writeln!(out, ">>>>>>> theirs");
}

fn other(conflict: &Conflict, out: &mut String) {
    let _ = writeln!(out, "% CONFLICT: {} %", listing::one_line(&conflict.what));
    let lines = |text: &Option<String>, out: &mut String| {
        for line in text.iter().flat_map(|text| text.split('\n')) {
            let _ = writeln!(out, "% {} %", listing::one_line(line));
        }
    };
    out.push_str("<<<<<<< ours\n");
    lines(&conflict.ours, out);
    out.push_str("||||||| base\n");
    lines(&conflict.base, out);
    out.push_str("=======\n");
    lines(&conflict.theirs, out);
    out.push_str(">>>>>>> theirs\n");
}
