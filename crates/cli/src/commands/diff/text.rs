//! A difference for reading: two-sided with drawn rungs on a wide terminal, unified otherwise.

use std::io::{self, Write};

use analysis::diff::{Change, ChangeKind, Difference, FileChange, LogicChange, Place, RungChange, ValueChange, Word};
use report::diff::{Side, sentence};

use super::Sections;

/// How it is written.
pub struct Look {
    /// Columns.
    pub width: usize,
    /// Old rung left, new rung right, both drawn.
    pub two_sided: bool,
    /// ANSI colours.
    pub color: bool,
}

/// Lines of one text that are shown; `--json` has all.
const MOST_LINES: usize = 60;

/// Values of one range that are shown.
const MOST_VALUES: usize = 8;

/// Documentation and value entries that are shown.
const MOST_ENTRIES: usize = 400;

const OLD: &str = "\x1B[31m";
const NEW: &str = "\x1B[32m";
const HEAD: &str = "\x1B[1m";
/// Reversed, and back.
const STRONG: &str = "\x1B[7m";
const PLAIN: &str = "\x1B[27m";
const OFF: &str = "\x1B[0m";

struct Writer<'w> {
    look: &'w Look,
    out: &'w mut dyn Write,
}

/// A program with its name on the command line.
pub type Named<'n> = (&'n str, &'n Side<'n>);

pub fn write(
    look: &Look,
    sections: Sections,
    programs: (Named<'_>, Named<'_>),
    difference: &Difference,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut writer = Writer { look, out };
    writer.line(OLD, &format!("--- {}", programs.0.0))?;
    writer.line(NEW, &format!("+++ {}", programs.1.0))?;
    let programs = (programs.0.1, programs.1.1);
    writer.plain("")?;
    if sections.logic {
        writer.logic(programs, difference)?;
    }
    if sections.documentation && difference.documentation_left_out {
        writer.line(HEAD, "Documentation: not compared")?;
        writer.plain("")?;
    } else if sections.documentation {
        writer.section("Documentation", difference.documentation.len())?;
        writer.changes(&difference.documentation)?;
    }
    if sections.values && difference.values_left_out {
        writer.line(HEAD, "Values: not compared, the files hold none")?;
        writer.plain("")?;
    } else if sections.values {
        writer.section("Values", difference.values.len())?;
        writer.values(&difference.values)?;
    }
    if sections.configuration {
        writer.section("Configuration", difference.configuration.len())?;
        writer.changes(&difference.configuration)?;
    }
    for note in &difference.notes {
        writer.plain(&format!("Note: {note}."))?;
    }
    Ok(())
}

impl Writer<'_> {
    /// A line of anything; control characters of a project are spelled out.
    fn plain(&mut self, text: &str) -> io::Result<()> {
        writeln!(self.out, "{}", render::clean(text))
    }

    fn line(&mut self, color: &str, text: &str) -> io::Result<()> {
        if !self.look.color {
            return self.plain(text);
        }
        writeln!(self.out, "{color}{}{OFF}", render::clean(text))
    }

    fn section(&mut self, name: &str, count: usize) -> io::Result<()> {
        let text = match count {
            0 => format!("{name}: equal"),
            1 => format!("{name}: 1 difference"),
            count => format!("{name}: {count} differences"),
        };
        self.line(HEAD, &text)?;
        if count == 0 { self.plain("") } else { Ok(()) }
    }

    fn logic(&mut self, programs: (&Side<'_>, &Side<'_>), difference: &Difference) -> io::Result<()> {
        self.section("Logic", difference.logic.len())?;
        for found in &difference.renames {
            self.plain(&format!(
                "  {} is now {} (replaced throughout, {} operands)",
                found.old, found.new, found.operands
            ))?;
        }
        let renamed: Vec<String> = difference
            .logic
            .iter()
            .filter_map(|change| match change {
                LogicChange::Rung(rung) if rung.only_rename => rung.new.map(|at| programs.1.place(at)),
                _ => None,
            })
            .collect();
        if !renamed.is_empty() {
            let (shown, more) = renamed.split_at(renamed.len().min(MOST_ENTRIES));
            let more = if more.is_empty() { String::new() } else { format!(", and {} more", more.len()) };
            self.plain(&format!("  rungs in which nothing else changed: {}{more}", shown.join(", ")))?;
        }
        for change in &difference.logic {
            match change {
                LogicChange::File(file) => self.file(programs, file)?,
                LogicChange::Rung(rung) if rung.only_rename => {}
                LogicChange::Rung(rung) => self.rung(programs, rung)?,
            }
        }
        if difference.logic.is_empty() { Ok(()) } else { self.plain("") }
    }

    fn file(&mut self, programs: (&Side<'_>, &Side<'_>), file: &FileChange) -> io::Result<()> {
        let name = |side: &Side<'_>, number: Option<u16>| match number {
            Some(number) if side.block_name(number).is_some() => side.part_name(number),
            Some(number) => format!("program {}", side.part_name(number)),
            None => String::new(),
        };
        let (old, new) = (name(programs.0, file.old), name(programs.1, file.new));
        let rungs = file.rungs;
        self.plain("")?;
        match file.kind {
            ChangeKind::Inserted => self.line(NEW, &format!("  + {new} ({rungs} rungs) is new")),
            ChangeKind::Deleted => self.line(OLD, &format!("  - {old} ({rungs} rungs) is gone")),
            _ => self.plain(&format!("  {old} is now {new}")),
        }
    }

    fn rung(&mut self, programs: (&Side<'_>, &Side<'_>), found: &RungChange) -> io::Result<()> {
        self.plain("")?;
        self.line(HEAD, &format!("  {}", headline_of(found, programs)))?;
        for edit in &found.edits {
            self.plain(&format!("      {}", sentence(edit, Some(programs))))?;
        }
        if self.look.two_sided && self.drawn(programs, found)? {
            return Ok(());
        }
        self.marked('-', OLD, &found.old_words)?;
        let comment = found.new.filter(|_| found.kind == ChangeKind::Inserted);
        self.comment('-', OLD, found.old.filter(|_| found.kind == ChangeKind::Deleted), programs.0)?;
        self.marked('+', NEW, &found.new_words)?;
        self.comment('+', NEW, comment, programs.1)
    }

    /// The comment that comes or goes with a rung.
    fn comment(&mut self, sign: char, color: &str, at: Option<Place>, program: &Side<'_>) -> io::Result<()> {
        for line in at.map(|at| program.comment(at)).unwrap_or_default().iter().take(MOST_LINES) {
            self.line(color, &format!("  {sign}   (* {line} *)"))?;
        }
        Ok(())
    }

    /// A rung as text, broken at words; what differs stands out by colour, else by a line of marks below.
    fn marked(&mut self, sign: char, color: &str, words: &[Word]) -> io::Result<()> {
        let room = self.look.width.saturating_sub(5).max(20);
        let lead = format!("  {sign} ");
        let (mut line, mut columns) = (Vec::new(), 0);
        for word in words {
            let shown = render::clean(&word.text).into_owned();
            let width = shown.chars().count();
            if columns > 0 && columns + 1 + width > room {
                self.marked_line(&lead, color, &line)?;
                (line, columns) = (Vec::new(), 0);
            }
            columns += width + usize::from(columns > 0);
            line.push((shown, word.marked));
        }
        if line.is_empty() { Ok(()) } else { self.marked_line(&lead, color, &line) }
    }

    fn marked_line(&mut self, lead: &str, color: &str, words: &[(String, bool)]) -> io::Result<()> {
        if self.look.color {
            let word = |(text, marked): &(String, bool)| match marked {
                true => format!("{STRONG}{text}{PLAIN}"),
                false => text.clone(),
            };
            let text = words.iter().map(word).collect::<Vec<_>>().join(" ");
            return writeln!(self.out, "{color}{lead}{text}{OFF}");
        }
        let text: Vec<&str> = words.iter().map(|word| word.0.as_str()).collect();
        self.plain(&format!("{lead}{}", text.join(" ")))?;
        let mark = |(text, marked): &(String, bool)| if *marked { "^" } else { " " }.repeat(text.chars().count());
        let marks = words.iter().map(mark).collect::<Vec<_>>().join(" ");
        let marks = marks.trim_end();
        if marks.is_empty() { Ok(()) } else { self.plain(&format!("{}{marks}", " ".repeat(lead.len()))) }
    }

    /// Both rungs drawn beside each other; `false` if there is nothing to draw.
    fn drawn(&mut self, programs: (&Side<'_>, &Side<'_>), found: &RungChange) -> io::Result<bool> {
        let half = (self.look.width - 3) / 2;
        let style = render::Style { width: half, color: false, values: false, ..render::Style::default() };
        let draw = |program: &Side<'_>, at: Option<Place>| -> Vec<String> {
            let text = at.and_then(|at| program.rung(at)).map(|rung| rung.drawn(&style)).unwrap_or_default();
            text.lines().map(str::to_owned).collect()
        };
        let (left, right) = (draw(programs.0, found.old), draw(programs.1, found.new));
        if left.is_empty() && right.is_empty() {
            return Ok(false);
        }
        let blank = String::new();
        for row in 0..left.len().max(right.len()) {
            let (a, b) = (left.get(row).unwrap_or(&blank), right.get(row).unwrap_or(&blank));
            let room = half.saturating_sub(a.chars().count());
            if self.look.color {
                writeln!(self.out, "{OLD}{a}{OFF}{} | {NEW}{b}{OFF}", " ".repeat(room))?;
            } else {
                writeln!(self.out, "{}", format!("{a}{} | {b}", " ".repeat(room)).trim_end())?;
            }
        }
        Ok(true)
    }

    fn changes(&mut self, changes: &[Change]) -> io::Result<()> {
        for found in changes.iter().take(MOST_ENTRIES) {
            self.plain(&format!("  {} {} {}", found.what, found.name, found.kind()))?;
            for (sign, color, text) in [('-', OLD, &found.old), ('+', NEW, &found.new)] {
                let lines: Vec<&str> = text.iter().flat_map(|text| text.split('\n')).collect();
                for line in lines.iter().take(MOST_LINES) {
                    self.line(color, &format!("    {sign} {line}"))?;
                }
                if lines.len() > MOST_LINES {
                    self.plain(&format!("    ({} more lines, see --json)", lines.len() - MOST_LINES))?;
                }
            }
        }
        self.more(changes.len())
    }

    fn values(&mut self, values: &[ValueChange]) -> io::Result<()> {
        for found in values.iter().take(MOST_ENTRIES) {
            let places = match found.first == found.last {
                true => found.first.clone(),
                false => format!("{} .. {}", found.first, found.last),
            };
            let list = |values: &[String]| {
                let shown = values.iter().take(MOST_VALUES).cloned().collect::<Vec<_>>().join(" ");
                if values.len() > MOST_VALUES { format!("{shown} ...") } else { shown }
            };
            self.plain(&format!("  {places}: {} -> {}", list(&found.old), list(&found.new)))?;
        }
        self.more(values.len())
    }

    fn more(&mut self, count: usize) -> io::Result<()> {
        if count > MOST_ENTRIES {
            self.plain(&format!("  and {} more, see --json", count - MOST_ENTRIES))?;
        }
        if count > 0 { self.plain("") } else { Ok(()) }
    }
}

/// `File 2 rung 4 changed (was rung 3)`.
fn headline_of(found: &RungChange, programs: (&Side<'_>, &Side<'_>)) -> String {
    headline_with(found, &|is_new, at| {
        let side = if is_new { programs.1 } else { programs.0 };
        (side.part_name(at.file), side.rung_name(at))
    })
}

/// The same for a program of RSLogix 500, by its numbers.
pub fn headline(found: &RungChange) -> String {
    headline_with(found, &|_, at| (format!("file {}", at.file), format!("rung {}", at.rung)))
}

/// As `words` calls a place of the old or of the new program: its file and its rung.
fn headline_with(found: &RungChange, words: &dyn Fn(bool, Place) -> (String, String)) -> String {
    let name = |is_new: bool, at: Place| {
        let (part, rung) = words(is_new, at);
        let mut characters = part.chars();
        let first = characters.next().map(|first| first.to_uppercase().chain(characters).collect::<String>());
        format!("{} {rung}", first.unwrap_or_default())
    };
    let from = |old: Place, new: Place| {
        let (was, is) = (words(false, old), words(true, new));
        match (was.0 == is.0, old.rung == new.rung) {
            (true, true) => String::new(),
            (true, false) => was.1,
            (false, _) => format!("{} {}", was.0, was.1),
        }
    };
    match (found.old, found.new) {
        (Some(old), Some(new)) if found.kind == ChangeKind::Moved => {
            let too = if found.edits.is_empty() { "" } else { ", and changed" };
            format!("{} moved here from {}{too}", name(true, new), from(old, new))
        }
        (Some(old), Some(new)) => match from(old, new) {
            was if was.is_empty() => format!("{} changed", name(true, new)),
            was => format!("{} changed (was {was})", name(true, new)),
        },
        (Some(old), None) => format!("{} deleted", name(false, old)),
        (None, Some(new)) => format!("{} inserted", name(true, new)),
        (None, None) => String::new(),
    }
}
