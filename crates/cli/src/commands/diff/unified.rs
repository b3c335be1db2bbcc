//! A difference as unified text for reviews: SLC text with its context, then the other sections.

use std::collections::BTreeMap;
use std::io::{self, Write};

use analysis::diff::{Change, ChangeKind, Difference, LogicChange, RungChange, ValueChange, Word};
use convert::slc::rung::rung_text;
use ladder::{Comment, ProgramFile, Rung};

use super::{Program, Sections};
use crate::output::printable;

/// Unchanged rungs shown before and behind changed ones.
const CONTEXT: usize = 1;

/// A rung of the new or of the old program, in the order of the text.
struct Line {
    sign: char,
    /// Place in the old and in the new file.
    at: (usize, usize),
    text: Vec<String>,
    remark: Option<String>,
}

pub(super) fn write(
    sections: Sections,
    programs: (&Program<'_>, &Program<'_>),
    difference: &Difference,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut line = |text: &str| writeln!(out, "{}", render::clean(text));
    if difference.is_empty() {
        if difference.documentation_left_out && sections.documentation {
            line("# documentation was not compared")?;
        }
        return notes(difference, &mut line);
    }
    line(&format!("--- {}", programs.0.name))?;
    line(&format!("+++ {}", programs.1.name))?;
    if !difference.logic.is_empty() {
        logic(programs, difference, &mut line)?;
    }
    if !difference.documentation.is_empty() {
        line("# Documentation")?;
        changes(&difference.documentation, &mut line)?;
    }
    if !difference.values.is_empty() {
        line("# Values")?;
        difference.values.iter().try_for_each(|change| values(change, &mut line))?;
    }
    if !difference.configuration.is_empty() {
        line("# Configuration")?;
        changes(&difference.configuration, &mut line)?;
    }
    notes(difference, &mut line)
}

type Put<'p> = &'p mut dyn FnMut(&str) -> io::Result<()>;

fn notes(difference: &Difference, line: Put<'_>) -> io::Result<()> {
    difference.notes.iter().try_for_each(|note| line(&format!("# Note: {note}.")))
}

/// What happened to the rungs of both programs, by file and rung.
#[derive(Default)]
struct Fates<'d> {
    /// Old rungs that are gone from their place.
    gone: BTreeMap<(u16, usize), &'d RungChange>,
    /// New rungs that came to their place.
    came: BTreeMap<(u16, usize), &'d RungChange>,
    /// New rungs that are changed where they are.
    changed: BTreeMap<(u16, usize), &'d RungChange>,
}

fn logic(programs: (&Program<'_>, &Program<'_>), difference: &Difference, line: Put<'_>) -> io::Result<()> {
    line("# Logic")?;
    for found in &difference.renames {
        line(&format!("# {} is now {} ({} operands)", found.old, found.new, found.operands))?;
    }
    let mut fates = Fates::default();
    // Old file number by new one, where they differ.
    let (mut old_of, mut new_files, mut gone_files) = (BTreeMap::new(), Vec::new(), Vec::new());
    for change in &difference.logic {
        match change {
            LogicChange::File(file) => match (file.kind, file.old, file.new) {
                (ChangeKind::Moved, Some(old), Some(new)) => old_of.extend([(new, old)]),
                (_, None, Some(new)) => new_files.push(new),
                (_, Some(old), None) => gone_files.push(old),
                _ => {}
            },
            LogicChange::Rung(rung) => {
                let moved = rung.kind == ChangeKind::Moved;
                if let (Some(_), Some(new), false) = (rung.old, rung.new, moved) {
                    fates.changed.insert((new.file, new.rung), rung);
                    continue;
                }
                fates.gone.extend(rung.old.map(|old| ((old.file, old.rung), &**rung)));
                fates.came.extend(rung.new.map(|new| ((new.file, new.rung), &**rung)));
            }
        }
    }
    let none = ProgramFile {
        number: 0,
        name: String::new(),
        description: String::new(),
        kind: ladder::ProgramFileKind::Ladder,
        rungs: Vec::new(),
    };
    for file in programs.1.image.ladder_files() {
        let number = old_of.get(&file.number).copied().unwrap_or(file.number);
        let is_new = new_files.contains(&file.number);
        let old = programs.0.image.program_file(number).filter(|_| !is_new).unwrap_or(&none);
        if old.number != file.number && !is_new {
            line(&format!("# program file {number} is now program file {}", file.number))?;
        }
        hunks(&lines((old, file), &fates), file, line)?;
    }
    for file in programs.0.image.ladder_files().filter(|file| gone_files.contains(&file.number)) {
        hunks(&lines((file, &none), &fates), file, line)?;
    }
    Ok(())
}

/// All rungs of a file in both versions. Rungs without a change stand in the same order on both sides.
fn lines(files: (&ProgramFile, &ProgramFile), fates: &Fates<'_>) -> Vec<Line> {
    let (mut i, mut j, mut all) = (0, 0, Vec::new());
    let place = |file: u16, rung: usize| format!("{file}:{rung}");
    loop {
        let (old, new) = (files.0.rungs.get(i), files.1.rungs.get(j));
        if old.is_none() && new.is_none() {
            return all;
        }
        let at = (i, j);
        if let Some(rung) = old
            && let gone = fates.gone.get(&(files.0.number, i))
            && (gone.is_some() || new.is_none())
        {
            let to = gone.and_then(|change| change.new);
            let remark = to.map(|to| format!("moved to {}", place(to.file, to.rung)));
            all.push(Line { sign: '-', at, text: with_comment(rung, text(rung, gone.map(|c| &c.old_words))), remark });
            i += 1;
        } else if let Some(rung) = new
            && let came = fates.came.get(&(files.1.number, j))
            && (came.is_some() || old.is_none())
        {
            let from = came.and_then(|change| change.old);
            let remark = from.map(|from| format!("moved from {}", place(from.file, from.rung)));
            all.push(Line { sign: '+', at, text: with_comment(rung, text(rung, came.map(|c| &c.new_words))), remark });
            j += 1;
        } else if let (Some(before), Some(after)) = (old, new) {
            match fates.changed.get(&(files.1.number, j)) {
                Some(change) => {
                    let remark = change.only_rename.then(|| "only addresses renamed".to_owned());
                    all.push(Line { sign: '-', at, text: vec![text(before, Some(&change.old_words))], remark });
                    let text = vec![text(after, Some(&change.new_words))];
                    all.push(Line { sign: '+', at: (i + 1, j), text, remark: None });
                }
                None => all.push(Line { sign: ' ', at, text: vec![rung_text(after)], remark: None }),
            }
            (i, j) = (i + 1, j + 1);
        }
    }
}

/// The rung as the comparison saw it: values that only the data table has are not part of it.
fn text(rung: &Rung, words: Option<&Vec<Word>>) -> String {
    match words.filter(|words| !words.is_empty()) {
        Some(words) => words.iter().map(|word| word.text.as_str()).collect::<Vec<_>>().join(" "),
        None => rung_text(rung),
    }
}

/// The comment that comes or goes with a rung, above it.
fn with_comment(rung: &Rung, text: String) -> Vec<String> {
    let mut all = comment_lines(rung.comment.as_ref());
    all.push(text);
    all
}

fn comment_lines(comment: Option<&Comment>) -> Vec<String> {
    let Some(comment) = comment else { return Vec::new() };
    let title = Some(comment.title.as_str()).filter(|title| !title.is_empty());
    title.into_iter().chain(comment.lines()).map(|line| format!("(* {line} *)")).collect()
}

/// Changed rungs with the unchanged ones around them.
fn hunks(lines: &[Line], file: &ProgramFile, put: Put<'_>) -> io::Result<()> {
    let mut from = 0;
    while let Some(first) = (from..lines.len()).find(|n| lines.get(*n).is_some_and(|line| line.sign != ' ')) {
        let start = first.saturating_sub(CONTEXT).max(from);
        let mut end = first + 1;
        // As far as the next change is nearer than both contexts.
        while let Some(next) =
            (end..lines.len().min(end + 2 * CONTEXT + 1)).find(|n| lines.get(*n).is_some_and(|line| line.sign != ' '))
        {
            end = next + 1;
        }
        let end = (end + CONTEXT).min(lines.len());
        let shown = lines.get(start..end).unwrap_or_default();
        let count = |sign: char| shown.iter().filter(|line| line.sign == ' ' || line.sign == sign).count();
        let at = shown.first().map_or((0, 0), |line| line.at);
        let name = if file.name.is_empty() { String::new() } else { format!(" {}", file.name) };
        put(&format!("@@ -{},{} +{},{} @@ program file {}{name}", at.0, count('-'), at.1, count('+'), file.number))?;
        for line in shown {
            if let Some(remark) = &line.remark {
                put(&format!("# {remark}"))?;
            }
            line.text.iter().try_for_each(|text| put(&format!("{}{text}", line.sign)))?;
        }
        from = end;
    }
    Ok(())
}

fn changes(changes: &[Change], put: Put<'_>) -> io::Result<()> {
    for found in changes {
        put(&format!("@@ {} {} {} @@", found.what, found.name, found.kind()))?;
        for (sign, text) in [('-', &found.old), ('+', &found.new)] {
            let lines = text.iter().flat_map(|text| text.split('\n'));
            for line in lines {
                put(&format!("{sign}{}", printable(line)))?;
            }
        }
    }
    Ok(())
}

fn values(found: &ValueChange, put: Put<'_>) -> io::Result<()> {
    let places =
        if found.first == found.last { found.first.clone() } else { format!("{} .. {}", found.first, found.last) };
    put(&format!("@@ {places} @@"))?;
    put(&format!("-{}", found.old.join(" ")))?;
    put(&format!("+{}", found.new.join(" ")))
}
