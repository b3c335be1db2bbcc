//! A difference as one HTML page that needs nothing beside it: rungs drawn side by side, what changed in them marked,
//! texts compared word by word, values and configuration as tables.

mod logic;
mod tables;

use std::io::{self, Write};

use analysis::diff::{Change, ChangeKind, Difference, LogicChange};

use super::side::Side;
use crate::page::{self, escape, relative};

const STYLE: &str = include_str!("../../assets/diff.css");
const SCRIPT: &str = concat!(include_str!("../../assets/theme.js"), include_str!("../../assets/diff.js"));

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
          <th class=n>Moved<th>Remark<tbody>\n",
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
}
