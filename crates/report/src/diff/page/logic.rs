//! Rungs and program files of a page: changed ones side by side, all others folded.

use std::io;

use analysis::diff::{ChangeKind, EditKind, Place, RungChange};

use super::{Comparison, Writer, sign};
use crate::diff::drawing::{Half, drawing};
use crate::diff::rows::{Chapter, Row, chapters};
use crate::diff::side::{Part, Side};
use crate::diff::words::sentence;
use crate::page::escape;

/// Rungs that are drawn; further ones stand as text.
const MOST_DRAWN: usize = 4_000;

/// Unchanged rungs that are drawn beside a changed one.
const CONTEXT: usize = 1;

/// Rungs of one fold that are listed by number and text.
const MOST_LISTED: usize = 2_000;

/// The place of a rung in the page, by where it stands in the new program, else in the old one.
fn anchor(change: &RungChange) -> String {
    match (change.old, change.new) {
        (_, Some(at)) => format!("c-{}-{}", at.file, at.rung),
        (Some(at), None) => format!("o-{}-{}", at.file, at.rung),
        (None, None) => String::new(),
    }
}

impl Writer<'_, '_> {
    pub(super) fn logic(&mut self) -> io::Result<()> {
        let Comparison { sides, difference, .. } = self.comparison;
        if !difference.renames.is_empty() {
            self.out.write_all(
                b"<h3>Addresses that another one replaced throughout</h3>\n<div class=wide><table><thead><tr><th>Before<th>After\
                  <th class=n>Operands<tbody>\n",
            )?;
            for found in &difference.renames {
                let (old, new) = (escape(&found.old), escape(&found.new));
                writeln!(self.out, "<tr><td class=f>{old}<td class=f>{new}<td class=n>{}", found.operands)?;
            }
            self.out.write_all(b"</table></div>\n")?;
        }
        let all = chapters(*sides, difference);
        for chapter in all.iter().filter(|chapter| !is_quiet(chapter)) {
            self.chapter(chapter)?;
        }
        self.quiet(&all)
    }

    /// The files in which nothing changed, out of the way of those in which something did.
    fn quiet(&mut self, all: &[Chapter<'_>]) -> io::Result<()> {
        let quiet: Vec<&Chapter<'_>> = all.iter().filter(|chapter| is_quiet(chapter)).collect();
        let count = |chapter: &Chapter<'_>| chapter.new.as_ref().map_or(0, |part| part.rungs);
        let total = quiet.iter().map(|chapter| count(chapter)).sum();
        if quiet.is_empty() {
            return Ok(());
        }
        let number = quiet.len();
        let files = if number == 1 { "1 file".to_owned() } else { format!("{number} files") };
        writeln!(
            self.out,
            "<details class=same><summary>{files} without a change <span>{}</span></summary>\n<ul class=quiet>",
            rungs(total)
        )?;
        for chapter in quiet {
            let title = chapter.new.as_ref().map_or("", |part| part.title.as_str());
            writeln!(self.out, "<li>{} <span>{}</span>", escape(title), rungs(count(chapter)))?;
        }
        self.out.write_all(b"</ul></details>\n")
    }

    fn chapter(&mut self, chapter: &Chapter<'_>) -> io::Result<()> {
        let sides = self.comparison.sides;
        let (title, remark, class) = match (&chapter.old, &chapter.new) {
            (Some(old), Some(new)) => {
                let (was, is) = (sides.0.part_name(old.number), sides.1.part_name(new.number));
                // Code blocks are known by name: another place in the text is no other name.
                let moved = if was == is { String::new() } else { format!("was {was}") };
                (&new.title, moved, if was == is { "" } else { "change moved" })
            }
            (None, Some(new)) => (&new.title, format!("new, {}", rungs(new.rungs)), "change inserted"),
            (Some(old), None) => (&old.title, format!("gone, {}", rungs(old.rungs)), "change deleted"),
            (None, None) => return Ok(()),
        };
        write!(self.out, "<h3 class=\"part {class}\">{}", escape(title))?;
        if !remark.is_empty() {
            write!(self.out, " <span>{}</span>", escape(&remark))?;
        }
        self.out.write_all(b"</h3>\n")?;
        for (number, row) in chapter.rows.iter().enumerate() {
            match row {
                Row::Same { old, new, count } => {
                    let is_change = |at: Option<usize>| at.and_then(|at| chapter.rows.get(at)).is_some();
                    let (before, after) = (is_change(number.checked_sub(1)), is_change(number.checked_add(1)));
                    self.same(*old, *new, *count, (before, after))?;
                }
                Row::Change(change) => self.change(change)?,
                Row::Left(change) => {
                    if let (Some(old), Some(new)) = (change.old, change.new) {
                        let (was, is) = (sides.0.place(old), sides.1.place(new));
                        writeln!(
                            self.out,
                            "<p class=left id=\"l-{}-{}\">{} <b>{}</b> is now <a href=\"#{}\">{}</a></p>",
                            old.file,
                            old.rung,
                            sign(ChangeKind::Moved),
                            escape(&was),
                            anchor(change),
                            escape(&is)
                        )?;
                    }
                }
            }
        }
        // A file of one side only is shown as a whole.
        match (&chapter.old, &chapter.new) {
            (None, Some(new)) => self.whole(new, true),
            (Some(old), None) => self.whole(old, false),
            _ => Ok(()),
        }
    }

    /// The rungs of a file that the other program does not have.
    fn whole(&mut self, part: &Part, is_new: bool) -> io::Result<()> {
        let side = if is_new { self.comparison.sides.1 } else { self.comparison.sides.0 };
        let class = if is_new { "new" } else { "old" };
        writeln!(self.out, "<details class=same><summary>its rungs</summary><div class=\"alone {class}\">")?;
        for rung in 0..part.rungs.min(MOST_LISTED) {
            self.figure(side, Place { file: part.number, rung }, &Half::plain())?;
        }
        if part.rungs > MOST_LISTED {
            writeln!(self.out, "<p class=note>and {} more</p>", part.rungs - MOST_LISTED)?;
        }
        self.out.write_all(b"</div></details>\n")
    }

    /// Rungs without a change: those beside a change drawn, all others listed.
    fn same(&mut self, old: Place, new: Place, count: usize, beside: (bool, bool)) -> io::Result<()> {
        let sides = self.comparison.sides;
        let at = |number: usize| Place { file: new.file, rung: new.rung + number };
        let place = |number: usize| sides.1.place(at(number));
        let range = if count == 1 { place(0) } else { format!("{} to {}", place(0), place(count - 1)) };
        let was = if old.rung == new.rung { String::new() } else { format!(", were from {}", sides.0.place(old)) };
        writeln!(
            self.out,
            "<details class=same><summary>{} without a change <span>{}{}</span></summary>",
            rungs(count),
            escape(&range),
            escape(&was)
        )?;
        let first = if beside.0 { CONTEXT.min(count) } else { 0 };
        let last = if beside.1 { CONTEXT.min(count - first) } else { 0 };
        self.out.write_all(b"<div class=alone>\n")?;
        for number in 0..count {
            if number < first || number >= count - last {
                self.figure(sides.1, at(number), &Half::plain())?;
            } else if number - first < MOST_LISTED {
                let text = sides.1.text(at(number));
                writeln!(self.out, "<p class=line><b>{}</b> {}</p>", escape(&place(number)), escape(&text))?;
            }
        }
        if count - first - last > MOST_LISTED {
            writeln!(self.out, "<p class=note>and {} more</p>", count - first - last - MOST_LISTED)?;
        }
        self.out.write_all(b"</div></details>\n")
    }

    fn change(&mut self, change: &RungChange) -> io::Result<()> {
        let sides = self.comparison.sides;
        let kind = change.kind.as_str();
        let place = match (change.old, change.new) {
            (_, Some(at)) => sides.1.place(at),
            (Some(at), None) => sides.0.place(at),
            (None, None) => return Ok(()),
        };
        let was = match (change.old, change.new) {
            (Some(old), Some(new)) if sides.0.place(old) != sides.1.place(new) => {
                let was = sides.0.place(old);
                if change.kind == ChangeKind::Moved {
                    format!(" from <a href=\"#l-{}-{}\">{}</a>", old.file, old.rung, escape(&was))
                } else {
                    format!(" (was {})", escape(&was))
                }
            }
            _ => String::new(),
        };
        let too = match (change.kind, change.only_rename, change.edits.is_empty()) {
            (_, true, _) => ", only by renamed addresses",
            (ChangeKind::Moved, _, false) => " and changed",
            _ => "",
        };
        let head = format!("<b class=sign>{}</b> {} {kind}{was}{too}", sign(change.kind), escape(&place));
        if change.only_rename {
            writeln!(self.out, "<details class=\"change rename\" id=\"{}\"><summary>{head}</summary>", anchor(change))?;
        } else {
            writeln!(self.out, "<article class=\"change {kind}\" id=\"{}\">\n<h4>{head}</h4>", anchor(change))?;
        }
        if !change.edits.is_empty() {
            self.out.write_all(b"<ul class=edits>\n")?;
            for edit in &change.edits {
                let (class, mark) = match edit.kind {
                    EditKind::Inserted => ("inserted", "+"),
                    EditKind::Deleted => ("deleted", "&#8722;"),
                    _ => ("changed", "&#8800;"),
                };
                writeln!(
                    self.out,
                    "<li class={class}><b class=sign>{mark}</b> {}",
                    escape(&sentence(edit, Some(sides)))
                )?;
            }
            self.out.write_all(b"</ul>\n")?;
        }
        let (before, after) =
            (Half::old(&change.edits, &change.old_words), Half::new(&change.edits, &change.new_words));
        match (change.old, change.new) {
            // A rung that only moved looks the same on both sides.
            (Some(_), Some(new)) if change.kind == ChangeKind::Moved && change.edits.is_empty() => {
                self.out.write_all(b"<div class=alone>\n")?;
                self.figure(sides.1, new, &after)?;
            }
            (Some(old), Some(new)) => {
                self.out.write_all(b"<div class=pair>\n<div class=old><p class=side>Before</p>\n")?;
                self.figure(sides.0, old, &before)?;
                self.out.write_all(b"</div>\n<div class=new><p class=side>After</p>\n")?;
                self.figure(sides.1, new, &after)?;
                self.out.write_all(b"</div>\n")?;
            }
            (Some(old), None) => {
                self.out.write_all(b"<div class=\"alone old\">\n")?;
                self.figure(sides.0, old, &before)?;
            }
            (None, Some(new)) => {
                self.out.write_all(b"<div class=\"alone new\">\n")?;
                self.figure(sides.1, new, &after)?;
            }
            (None, None) => {}
        }
        self.out.write_all(if change.only_rename { b"</div></details>\n" } else { b"</div></article>\n" })
    }

    /// A rung, drawn while there is room for drawings.
    fn figure(&mut self, side: &Side<'_>, at: Place, half: &Half<'_>) -> io::Result<()> {
        self.drawn += 1;
        match side.rung(at).filter(|_| self.drawn <= MOST_DRAWN) {
            Some(rung) => drawing(&rung, half, self.out),
            None => {
                writeln!(self.out, "<p class=line><b>{}</b> {}</p>", escape(&side.place(at)), escape(&side.text(at)))
            }
        }
    }
}

/// Nothing changed, not even the number.
fn is_quiet(chapter: &Chapter<'_>) -> bool {
    match (&chapter.old, &chapter.new) {
        (Some(old), Some(new)) => {
            // Code blocks are known by name: another place in the text is no other name.
            let same_number = old.number == new.number || old.title == new.title;
            same_number && chapter.rows.iter().all(|row| matches!(row, Row::Same { .. }))
        }
        _ => false,
    }
}

/// `1 rung`, `12 rungs`.
fn rungs(count: usize) -> String {
    if count == 1 { "1 rung".to_owned() } else { format!("{count} rungs") }
}
