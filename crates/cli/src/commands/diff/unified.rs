//! A difference as unified text for reviews: rungs as text with their neighbours, then the other sections.

use std::collections::BTreeMap;
use std::io::{self, Write};

use analysis::diff::{Change, ChangeKind, Difference, LogicChange, Place, RungChange, ValueChange, Word};
use convert::slc::rung::rung_text;
use ladder::Comment;
use report::diff::Side;

use super::{Program, Sections};
use crate::output::printable;

/// A program as text.
pub(super) struct Listing {
    name: String,
    files: Vec<Listed>,
    /// Number of the first rung: rungs of Do-more count from 1.
    first: usize,
}

/// A program file or code block.
struct Listed {
    number: u16,
    /// `program file 2`, `code block Fill`.
    title: String,
    /// Behind the title, with a blank.
    name: String,
    rungs: Vec<Text>,
}

struct Text {
    rung: String,
    comment: Vec<String>,
}

impl Listing {
    pub(super) fn rslogix(program: &Program<'_>) -> Listing {
        let text = |rung: &ladder::Rung| Text { rung: rung_text(rung), comment: comment_lines(rung.comment.as_ref()) };
        let file = |file: &ladder::ProgramFile| Listed {
            number: file.number,
            title: format!("program file {}", file.number),
            name: if file.name.is_empty() { String::new() } else { format!(" {}", file.name) },
            rungs: file.rungs.iter().map(text).collect(),
        };
        Listing { name: program.name.clone(), files: program.image.ladder_files().map(file).collect(), first: 0 }
    }

    pub(super) fn domore(name: &str, side: &Side<'_>) -> Listing {
        let text = |at: Place| Text {
            rung: side.text(at),
            comment: side.comment(at).iter().map(|line| format!("(* {line} *)")).collect(),
        };
        let files = side.parts().into_iter().map(|part| Listed {
            number: part.number,
            title: side.part_name(part.number),
            name: String::new(),
            rungs: (0..part.rungs).map(|rung| text(Place { file: part.number, rung })).collect(),
        });
        Listing { name: name.to_owned(), files: files.collect(), first: 1 }
    }

    fn file(&self, number: u16) -> Option<&Listed> {
        self.files.iter().find(|file| file.number == number)
    }

    /// `2:4`, `code block Fill rung 5`.
    fn place(&self, at: Place) -> String {
        match self.file(at.file).filter(|_| self.first > 0) {
            Some(file) => format!("{} rung {}", file.title, at.rung + self.first),
            None => format!("{}:{}", at.file, at.rung),
        }
    }
}

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
    programs: (&Listing, &Listing),
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

fn logic(programs: (&Listing, &Listing), difference: &Difference, line: Put<'_>) -> io::Result<()> {
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
    let none = Listed { number: 0, title: String::new(), name: String::new(), rungs: Vec::new() };
    for file in &programs.1.files {
        let number = old_of.get(&file.number).copied().unwrap_or(file.number);
        let is_new = new_files.contains(&file.number);
        let old = programs.0.file(number).filter(|_| !is_new).unwrap_or(&none);
        if old.title != file.title && !is_new && !old.title.is_empty() {
            line(&format!("# {} is now {}", old.title, file.title))?;
        }
        hunks(&lines((old, file), programs, &fates), file, programs.1.first, line)?;
    }
    for file in programs.0.files.iter().filter(|file| gone_files.contains(&file.number)) {
        hunks(&lines((file, &none), programs, &fates), file, programs.0.first, line)?;
    }
    Ok(())
}

/// All rungs of a file in both versions. Rungs without a change stand in the same order on both sides.
fn lines(files: (&Listed, &Listed), programs: (&Listing, &Listing), fates: &Fates<'_>) -> Vec<Line> {
    let (mut i, mut j, mut all) = (0, 0, Vec::new());
    // Words of Do-more come without what stands between instructions.
    let words = |words| if programs.0.first == 0 { words } else { None };
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
            let remark = to.map(|to| format!("moved to {}", programs.1.place(to)));
            all.push(Line {
                sign: '-',
                at,
                text: with_comment(rung, text(rung, words(gone.map(|c| &c.old_words)))),
                remark,
            });
            i += 1;
        } else if let Some(rung) = new
            && let came = fates.came.get(&(files.1.number, j))
            && (came.is_some() || old.is_none())
        {
            let from = came.and_then(|change| change.old);
            let remark = from.map(|from| format!("moved from {}", programs.0.place(from)));
            all.push(Line {
                sign: '+',
                at,
                text: with_comment(rung, text(rung, words(came.map(|c| &c.new_words)))),
                remark,
            });
            j += 1;
        } else if let (Some(before), Some(after)) = (old, new) {
            match fates.changed.get(&(files.1.number, j)) {
                Some(change) => {
                    let remark = change.only_rename.then(|| "only addresses renamed".to_owned());
                    all.push(Line { sign: '-', at, text: vec![text(before, words(Some(&change.old_words)))], remark });
                    let text = vec![text(after, words(Some(&change.new_words)))];
                    all.push(Line { sign: '+', at: (i + 1, j), text, remark: None });
                }
                None => all.push(Line { sign: ' ', at, text: vec![after.rung.clone()], remark: None }),
            }
            (i, j) = (i + 1, j + 1);
        }
    }
}

/// The rung as the comparison saw it: values that only the data table has are not part of it.
fn text(rung: &Text, words: Option<&Vec<Word>>) -> String {
    match words.filter(|words| !words.is_empty()) {
        Some(words) => words.iter().map(|word| word.text.as_str()).collect::<Vec<_>>().join(" "),
        None => rung.rung.clone(),
    }
}

/// The comment that comes or goes with a rung, above it.
fn with_comment(rung: &Text, text: String) -> Vec<String> {
    let mut all = rung.comment.clone();
    all.push(text);
    all
}

fn comment_lines(comment: Option<&Comment>) -> Vec<String> {
    let Some(comment) = comment else { return Vec::new() };
    let title = Some(comment.title.as_str()).filter(|title| !title.is_empty());
    title.into_iter().chain(comment.lines()).map(|line| format!("(* {line} *)")).collect()
}

/// Changed rungs with the unchanged ones around them.
fn hunks(lines: &[Line], file: &Listed, base: usize, put: Put<'_>) -> io::Result<()> {
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
        let (title, name) = (&file.title, &file.name);
        put(&format!("@@ -{},{} +{},{} @@ {title}{name}", at.0 + base, count('-'), at.1 + base, count('+')))?;
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
