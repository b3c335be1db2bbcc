//! A difference for reading: two-sided with drawn rungs on a wide terminal, unified otherwise.

use std::io::{self, Write};

use analysis::diff::{
    Change, ChangeKind, Difference, Edit, EditKind, FileChange, LogicChange, Place, RungChange, ValueChange, Word,
};
use ladder::ProgramFile;

use super::{Program, Sections};

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
const OFF: &str = "\x1B[0m";

struct Writer<'w> {
    look: &'w Look,
    out: &'w mut dyn Write,
}

pub fn write(
    look: &Look,
    sections: Sections,
    programs: (&Program<'_>, &Program<'_>),
    difference: &Difference,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut writer = Writer { look, out };
    writer.line(OLD, &format!("--- {}", programs.0.name))?;
    writer.line(NEW, &format!("+++ {}", programs.1.name))?;
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
    if sections.values {
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

    fn logic(&mut self, programs: (&Program<'_>, &Program<'_>), difference: &Difference) -> io::Result<()> {
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
                LogicChange::Rung(rung) if rung.only_rename => rung.new.map(place),
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
                LogicChange::File(file) => self.file(file)?,
                LogicChange::Rung(rung) if rung.only_rename => {}
                LogicChange::Rung(rung) => self.rung(programs, rung)?,
            }
        }
        if difference.logic.is_empty() { Ok(()) } else { self.plain("") }
    }

    fn file(&mut self, file: &FileChange) -> io::Result<()> {
        let number = |number: Option<u16>| number.map_or_else(String::new, |number| number.to_string());
        let rungs = file.rungs;
        self.plain("")?;
        match file.kind {
            ChangeKind::Inserted => {
                self.line(NEW, &format!("  + program file {} ({rungs} rungs) is new", number(file.new)))
            }
            ChangeKind::Deleted => {
                self.line(OLD, &format!("  - program file {} ({rungs} rungs) is gone", number(file.old)))
            }
            _ => self.plain(&format!("  program file {} is now program file {}", number(file.old), number(file.new))),
        }
    }

    fn rung(&mut self, programs: (&Program<'_>, &Program<'_>), found: &RungChange) -> io::Result<()> {
        self.plain("")?;
        self.line(HEAD, &format!("  {}", headline(found)))?;
        for edit in &found.edits {
            self.plain(&format!("      {}", sentence(edit)))?;
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
    fn comment(&mut self, sign: char, color: &str, at: Option<Place>, program: &Program<'_>) -> io::Result<()> {
        let rung = at.and_then(|at| program.image.program_file(at.file)?.rungs.get(at.rung));
        let Some(comment) = rung.and_then(|rung| rung.comment.as_ref()) else { return Ok(()) };
        let title = Some(comment.title.as_str()).filter(|title| !title.is_empty());
        for line in title.into_iter().chain(comment.lines()).take(MOST_LINES) {
            self.line(color, &format!("  {sign}   (* {line} *)"))?;
        }
        Ok(())
    }

    /// A rung as text, broken at words, with a line of marks below what differs.
    fn marked(&mut self, sign: char, color: &str, words: &[Word]) -> io::Result<()> {
        let room = self.look.width.saturating_sub(5).max(20);
        let (mut text, mut marks, mut columns) = (String::new(), String::new(), 0);
        let lead = format!("  {sign} ");
        for word in words {
            let shown = render::clean(&word.text).into_owned();
            let width = shown.chars().count();
            if columns > 0 && columns + 1 + width > room {
                self.marked_line(&lead, color, &text, &marks)?;
                (text, marks, columns) = (String::new(), String::new(), 0);
            }
            if columns > 0 {
                text.push(' ');
                marks.push(' ');
                columns += 1;
            }
            text.push_str(&shown);
            marks.extend(std::iter::repeat_n(if word.marked { '^' } else { ' ' }, width));
            columns += width;
        }
        if columns > 0 { self.marked_line(&lead, color, &text, &marks) } else { Ok(()) }
    }

    fn marked_line(&mut self, lead: &str, color: &str, text: &str, marks: &str) -> io::Result<()> {
        self.line(color, &format!("{lead}{text}"))?;
        let marks = marks.trim_end();
        if marks.is_empty() { Ok(()) } else { self.plain(&format!("{}{marks}", " ".repeat(lead.len()))) }
    }

    /// Both rungs drawn beside each other; `false` if there is nothing to draw.
    fn drawn(&mut self, programs: (&Program<'_>, &Program<'_>), found: &RungChange) -> io::Result<bool> {
        let half = (self.look.width - 3) / 2;
        let style = render::Style { width: half, color: false, values: false, ..render::Style::default() };
        let draw = |program: &Program<'_>, at: Option<Place>| -> Vec<String> {
            let file: Option<(&ProgramFile, usize)> =
                at.and_then(|at| Some((program.image.program_file(at.file)?, at.rung)));
            let Some((file, rung)) = file else { return Vec::new() };
            let text = render::rung(program.image, file, rung, program.documentation, &style);
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

/// `2:4`, file and rung.
fn place(at: Place) -> String {
    format!("{}:{}", at.file, at.rung)
}

/// `File 2 rung 4 changed (was rung 3)`.
fn headline(found: &RungChange) -> String {
    let name = |at: Place| format!("File {} rung {}", at.file, at.rung);
    let from = |old: Place, new: Place| match (old.file == new.file, old.rung == new.rung) {
        (true, true) => String::new(),
        (true, false) => format!("rung {}", old.rung),
        (false, _) => format!("file {} rung {}", old.file, old.rung),
    };
    match (found.old, found.new) {
        (Some(old), Some(new)) if found.kind == ChangeKind::Moved => {
            let too = if found.edits.is_empty() { "" } else { ", and changed" };
            format!("{} moved here from {}{too}", name(new), from(old, new))
        }
        (Some(old), Some(new)) => match from(old, new) {
            was if was.is_empty() => format!("{} changed", name(new)),
            was => format!("{} changed (was {was})", name(new)),
        },
        (Some(old), None) => format!("{} deleted", name(old)),
        (None, Some(new)) => format!("{} inserted", name(new)),
        (None, None) => String::new(),
    }
}

/// What changed inside a rung, for a person.
fn sentence(edit: &Edit) -> String {
    let Edit { mnemonic, old, new, .. } = edit;
    let filled = |text: &str| if text.is_empty() { "nothing".to_owned() } else { text.to_owned() };
    match edit.kind {
        EditKind::Operand => {
            let number = edit.operand.map_or(0, |operand| operand + 1);
            format!("{mnemonic}, operand {number}: {} -> {}", filled(old), filled(new))
        }
        EditKind::Setting => format!("{mnemonic}, {} -> {}", filled(old), filled(new)),
        EditKind::Instruction => format!("{old} is now {new}"),
        EditKind::Inserted => format!("inserted {new}"),
        EditKind::Deleted => format!("deleted {old}"),
        EditKind::Branches => "branches begin, divide or end elsewhere".to_owned(),
    }
}
