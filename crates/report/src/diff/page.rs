//! A difference as one HTML page that needs nothing beside it: rungs drawn side by side, what changed in them marked,
//! texts compared word by word, values and configuration as tables.

use std::io::{self, Write};

use analysis::diff::{Change, ChangeKind, Difference, Edit, EditKind, LogicChange, Place, RungChange, ValueChange};

use super::drawing::{Half, drawing};
use super::rows::{Chapter, Row, chapters};
use super::side::{Part, Side};
use super::text::{Stretch, stretches};
use super::words::sentence;
use crate::page::{self, escape, relative};

const STYLE: &str = include_str!("../../assets/diff.css");
const SCRIPT: &str = include_str!("../../assets/diff.js");

/// Rungs that are drawn; further ones stand as text.
const MOST_DRAWN: usize = 4_000;

/// Unchanged rungs that are drawn beside a changed one.
const CONTEXT: usize = 1;

/// Rungs of one fold that are listed by number and text.
const MOST_LISTED: usize = 2_000;

/// Values of one range that are shown.
const MOST_VALUES: usize = 200;

/// Two programs and what differs.
#[derive(Clone, Debug)]
pub struct Comparison<'a> {
    /// Names of the old and of the new program.
    pub names: (&'a str, &'a str),
    /// The programs.
    pub sides: (&'a Side<'a>, &'a Side<'a>),
    /// What differs in the sections that are shown.
    pub difference: &'a Difference,
    /// The sections that are shown.
    pub shown: Shown,
    /// What made the page: program and version.
    pub tool: &'a str,
    /// What a reader must know first: parts that could not be read.
    pub warnings: &'a [String],
}

/// Sections of a comparison.
#[derive(Clone, Copy, Debug)]
pub struct Shown {
    /// Rungs and program files.
    pub logic: bool,
    /// Symbols, descriptions, comments.
    pub documentation: bool,
    /// Contents of data files.
    pub values: bool,
    /// Processor, I/O, channels, shape of data files.
    pub configuration: bool,
}

impl Default for Shown {
    /// All.
    fn default() -> Shown {
        Shown { logic: true, documentation: true, values: true, configuration: true }
    }
}

/// Writes the page of a comparison.
///
/// # Errors
/// What writing gives.
pub fn page(comparison: &Comparison<'_>, out: &mut dyn Write) -> io::Result<()> {
    let (old, new) = comparison.names;
    let title = format!("{} \u{2192} {}", last(old), last(new));
    head(&title, out)?;
    bar(&title, true, out)?;
    out.write_all(b"<main id=content class=diff tabindex=-1>\n")?;
    write!(
        out,
        "<dl class=names><div><dt>Before</dt><dd>{}</dd></div><div><dt>After</dt><dd>{}</dd></div></dl>\n\
         <p class=made>{}</p>\n",
        escape(old),
        escape(new),
        escape(comparison.tool)
    )?;
    for warning in comparison.warnings {
        writeln!(out, "<p class=\"note b\"><strong>Not complete:</strong> {}</p>", escape(warning))?;
    }
    summary(comparison, out)?;
    for note in &comparison.difference.notes {
        writeln!(out, "<p class=note><strong>Note:</strong> {}.</p>", escape(note))?;
    }
    let mut writer = Writer { comparison, drawn: 0, out };
    writer.sections()?;
    foot(true, out)
}

/// One pair of files in a list of comparisons.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Entry {
    /// The file of its page beside the list; empty: there is none.
    pub href: String,
    /// The file of the old folder; empty: it was added.
    pub old: String,
    /// The file of the new folder; empty: it was removed.
    pub new: String,
    /// Differences in logic, documentation, values and configuration; `None`: not compared.
    pub counts: Option<[usize; 4]>,
    /// In words: equal, removed, why it could not be read.
    pub remark: String,
}

/// Writes the list of the comparisons of two folders.
///
/// # Errors
/// What writing gives.
pub fn index(names: (&str, &str), tool: &str, entries: &[Entry], out: &mut dyn Write) -> io::Result<()> {
    let title = format!("{} \u{2192} {}", last(names.0), last(names.1));
    head(&title, out)?;
    bar(&title, false, out)?;
    write!(
        out,
        "<main id=content class=diff tabindex=-1>\n<dl class=names><div><dt>Before</dt><dd>{}</dd></div><div><dt>After</dt>\
         <dd>{}</dd></div></dl>\n<p class=made>{}</p>\n<div class=wide><table class=list><thead><tr><th>Before<th>After\
         <th class=n>Logic<th class=n>Documentation<th class=n>Values<th class=n>Configuration<th>Remark<tbody>\n",
        escape(names.0),
        escape(names.1),
        escape(tool)
    )?;
    for entry in entries {
        let name = |text: &str| match (entry.href.is_empty(), text.is_empty()) {
            (_, true) => "\u{2014}".to_owned(),
            (true, _) => escape(text).to_string(),
            (false, _) => format!("<a href=\"{}\">{}</a>", relative(&entry.href), escape(text)),
        };
        write!(out, "<tr><td>{}<td>{}", name(&entry.old), name(&entry.new))?;
        for index in 0..4 {
            match entry.counts.and_then(|counts| counts.get(index).copied()) {
                Some(0) => out.write_all(b"<td class=\"n zero\">0")?,
                Some(count) => write!(out, "<td class=n><b>{count}</b>")?,
                None => out.write_all(b"<td>")?,
            }
        }
        writeln!(out, "<td>{}", escape(&entry.remark))?;
    }
    out.write_all(b"</table></div>\n")?;
    foot(false, out)
}

/// The last part of a path, for where there is little room.
fn last(name: &str) -> &str {
    name.trim_end_matches(['/', '\\']).rsplit(['/', '\\']).next().unwrap_or(name)
}

fn head(title: &str, out: &mut dyn Write) -> io::Result<()> {
    page::head(title, &format!("{}{}{STYLE}", page::STYLE, super::drawing::style()), SCRIPT, out)
}

fn bar(title: &str, steps: bool, out: &mut dyn Write) -> io::Result<()> {
    write!(
        out,
        "<a class=skip href=\"#content\">To the content</a>\n<header>\n<h1 title=\"{0}\">{0}</h1>\n<span class=fill></span>\n",
        escape(title)
    )?;
    if steps {
        out.write_all(
            b"<output class=script id=where></output>\n\
              <button class=script id=back type=button title=\"Previous change (p)\" aria-label=\"Previous change\">&#9650;</button>\n\
              <button class=script id=on type=button title=\"Next change (n)\" aria-label=\"Next change\">&#9660;</button>\n",
        )?;
    }
    out.write_all(b"<button class=script id=theme type=button title=\"Dark or light (t)\">Theme</button>\n</header>\n")
}

fn foot(steps: bool, out: &mut dyn Write) -> io::Result<()> {
    if steps {
        out.write_all(
            b"<p class=\"made keys\"><kbd>n</kbd> next change, <kbd>p</kbd> previous change, <kbd>u</kbd> unfold or fold \
              unchanged rungs, <kbd>t</kbd> dark or light</p>\n",
        )?;
    }
    write!(out, "</main>\n<script>{SCRIPT}</script>\n</body>\n</html>\n")
}

/// How often each kind occurs.
fn tally(kinds: impl Iterator<Item = ChangeKind>) -> [usize; 4] {
    let mut counts = [0; 4];
    for kind in kinds {
        let index = match kind {
            ChangeKind::Changed => 0,
            ChangeKind::Inserted => 1,
            ChangeKind::Deleted => 2,
            ChangeKind::Moved => 3,
        };
        if let Some(count) = counts.get_mut(index) {
            *count += 1;
        }
    }
    counts
}

fn kind_of(change: &LogicChange) -> ChangeKind {
    match change {
        LogicChange::File(file) => file.kind,
        LogicChange::Rung(rung) => rung.kind,
    }
}

fn summary(comparison: &Comparison<'_>, out: &mut dyn Write) -> io::Result<()> {
    let (difference, shown) = (comparison.difference, comparison.shown);
    out.write_all(
        b"<div class=wide><table class=sum><thead><tr><th>Section<th class=n>Changed<th class=n>Inserted<th class=n>Deleted\
          <th class=n>Moved<th><tbody>\n",
    )?;
    let changes = |changes: &[Change]| tally(changes.iter().map(Change::kind));
    let documentation =
        if difference.documentation_left_out { "not compared: an image has none of its own" } else { "" };
    let values = if difference.values_left_out { "not compared: the files hold none" } else { "" };
    let only_renamed =
        difference.logic.iter().filter(|it| matches!(it, LogicChange::Rung(rung) if rung.only_rename)).count();
    let renamed = match only_renamed {
        0 => String::new(),
        count => format!("{count} of the changed only by renamed addresses"),
    };
    let rows = [
        (shown.logic, "logic", "Logic", tally(difference.logic.iter().map(kind_of)), renamed.as_str()),
        (shown.documentation, "documentation", "Documentation", changes(&difference.documentation), documentation),
        (shown.values, "values", "Values", [difference.values.len(), 0, 0, 0], values),
        (shown.configuration, "configuration", "Configuration", changes(&difference.configuration), ""),
    ];
    for (is_shown, id, title, counts, remark) in rows {
        if !is_shown {
            writeln!(out, "<tr><td>{title}<td><td><td><td><td>not asked for")?;
            continue;
        }
        if remark.starts_with("not compared") {
            writeln!(out, "<tr><td>{title}<td><td><td><td><td>{remark}")?;
            continue;
        }
        write!(out, "<tr><td><a href=\"#{id}\">{title}</a>")?;
        for count in counts {
            match count {
                0 => out.write_all(b"<td class=\"n zero\">0")?,
                count => write!(out, "<td class=n><b>{count}</b>")?,
            }
        }
        let equal = if counts == [0; 4] && remark.is_empty() { "equal" } else { remark };
        writeln!(out, "<td>{}", escape(equal))?;
    }
    out.write_all(b"</table></div>\n")
}

/// The word and the sign of a kind: colour alone is not enough for every reader.
fn sign(kind: ChangeKind) -> &'static str {
    match kind {
        ChangeKind::Changed => "&#8800;",
        ChangeKind::Inserted => "+",
        ChangeKind::Deleted => "&#8722;",
        ChangeKind::Moved => "&#8693;",
    }
}

/// The place of a rung in the page, by where it stands in the new program, else in the old one.
fn anchor(change: &RungChange) -> String {
    match (change.old, change.new) {
        (_, Some(at)) => format!("c-{}-{}", at.file, at.rung),
        (Some(at), None) => format!("o-{}-{}", at.file, at.rung),
        (None, None) => String::new(),
    }
}

struct Writer<'w, 'a> {
    comparison: &'w Comparison<'a>,
    drawn: usize,
    out: &'w mut dyn Write,
}

impl Writer<'_, '_> {
    fn sections(&mut self) -> io::Result<()> {
        let (difference, shown) = (self.comparison.difference, self.comparison.shown);
        if shown.logic {
            self.section("logic", "Logic", difference.logic.len())?;
            self.logic()?;
            self.end()?;
        }
        if shown.documentation && !difference.documentation_left_out {
            self.section("documentation", "Documentation", difference.documentation.len())?;
            self.changes(&difference.documentation)?;
            self.end()?;
        }
        if shown.values && !difference.values_left_out {
            self.section("values", "Values", difference.values.len())?;
            self.values(&difference.values)?;
            self.end()?;
        }
        if shown.configuration {
            self.section("configuration", "Configuration", difference.configuration.len())?;
            self.changes(&difference.configuration)?;
            self.end()?;
        }
        Ok(())
    }

    fn section(&mut self, id: &str, title: &str, count: usize) -> io::Result<()> {
        let count = match count {
            0 => "equal".to_owned(),
            1 => "1 difference".to_owned(),
            count => format!("{count} differences"),
        };
        writeln!(self.out, "<section id={id}>\n<details open><summary><h2>{title}</h2> <span>{count}</span></summary>")
    }

    fn end(&mut self) -> io::Result<()> {
        self.out.write_all(b"</details>\n</section>\n")
    }

    fn logic(&mut self) -> io::Result<()> {
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

    fn changes(&mut self, changes: &[Change]) -> io::Result<()> {
        if changes.is_empty() {
            return Ok(());
        }
        self.out
            .write_all(b"<div class=wide><table class=texts><thead><tr><th>What<th>Name<th>Before<th>After<tbody>\n")?;
        for change in changes {
            let kind = change.kind();
            write!(
                self.out,
                "<tr class=\"change {}\"><td><b class=sign>{}</b> {}<td>{}",
                kind.as_str(),
                sign(kind),
                escape(change.what),
                escape(&change.name)
            )?;
            match (&change.old, &change.new) {
                (Some(old), Some(new)) => {
                    let all = stretches(old, new);
                    self.out.write_all(b"<td>")?;
                    self.marked(&all, true)?;
                    self.out.write_all(b"<td>")?;
                    self.marked(&all, false)?;
                }
                (old, new) => {
                    let text = |text: &Option<String>, tag: &str| match text.as_deref() {
                        None => String::new(),
                        Some("") => format!("<{tag}>(empty)</{tag}>"),
                        Some(text) => format!("<{tag}>{}</{tag}>", escape(text)),
                    };
                    write!(self.out, "<td>{}<td>{}", text(old, "del"), text(new, "ins"))?;
                }
            }
            self.out.write_all(b"\n")?;
        }
        self.out.write_all(b"</table></div>\n")
    }

    /// One side of two texts.
    fn marked(&mut self, all: &[Stretch<'_>], is_old: bool) -> io::Result<()> {
        // Neighbouring words in one mark.
        let mut open = false;
        let tag = if is_old { "del" } else { "ins" };
        for stretch in all {
            let (text, mark) = match (stretch, is_old) {
                (Stretch::Same(text), _) => (text, false),
                (Stretch::Old(text), true) | (Stretch::New(text), false) => (text, true),
                _ => continue,
            };
            if mark != open {
                write!(self.out, "<{}{tag}>", if mark { "" } else { "/" })?;
                open = mark;
            }
            write!(self.out, "{}", escape(text))?;
        }
        if open { write!(self.out, "</{tag}>") } else { Ok(()) }
    }

    fn values(&mut self, values: &[ValueChange]) -> io::Result<()> {
        if values.is_empty() {
            return Ok(());
        }
        self.out.write_all(
            b"<div class=wide><table class=texts><thead><tr><th>File<th>Address<th class=n>Elements<th>Before<th>After<tbody>\n",
        )?;
        for found in values {
            let range = if found.first == found.last {
                found.first.clone()
            } else {
                format!("{} .. {}", found.first, found.last)
            };
            write!(
                self.out,
                "<tr class=\"change changed\"><td class=f>{}<td class=f>{}<td class=n>{}<td class=vals>",
                escape(&found.file),
                escape(&range),
                found.old.len()
            )?;
            self.list(&found.old, "del")?;
            self.out.write_all(b"<td class=vals>")?;
            self.list(&found.new, "ins")?;
            self.out.write_all(b"\n")?;
        }
        self.out.write_all(b"</table></div>\n")
    }

    fn list(&mut self, values: &[String], tag: &str) -> io::Result<()> {
        let shown: Vec<&str> = values.iter().take(MOST_VALUES).map(String::as_str).collect();
        write!(self.out, "<{tag}>{}</{tag}>", escape(&shown.join("  ")))?;
        if values.len() > MOST_VALUES {
            write!(self.out, " and {} more", values.len() - MOST_VALUES)?;
        }
        Ok(())
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

/// Edits of one rung on which a side can be marked.
pub(super) fn is_on(edit: &Edit, is_old: bool) -> Option<u32> {
    if is_old { edit.old_instruction } else { edit.new_instruction }
}
