//! Model to text.

use super::rows::{Line, begin_word, is_end, one_line};
use super::words::split;
use crate::program::{CodeBlock, CodeKind, Instruction, Origin, Part, Project, RawSection, Row, Section, Unread};
use crate::stack;

/// Writes a project: what was read and not changed as it stood, everything else as Designer writes it.
///
/// The text has no byte order mark; [`crate::program::Format::encoding`] says how to store it.
pub fn write(project: &Project) -> String {
    let mut out = Writer { lines: Vec::new() };
    for part in &project.parts {
        out.part(part);
    }
    out.before(&project.tail, 0);
    let mut text = out.lines.join(project.format.line_end.as_str());
    if project.format.ends_with_line_end && !out.lines.is_empty() {
        text.push_str(project.format.line_end.as_str());
    }
    text
}

struct Writer {
    lines: Vec<String>,
}

impl Writer {
    /// The lines before something; for something that was not read, `blanks` blank lines.
    fn before(&mut self, origin: &Origin, blanks: usize) {
        match &origin.before {
            Some(lines) => self.lines.extend(lines.iter().map(|line| between(line))),
            None => self.lines.extend(std::iter::repeat_n(String::new(), blanks)),
        }
    }

    fn line(&mut self, content: &impl Line, blanks: usize) {
        self.before(content.origin(), blanks);
        self.lines.push(content.spelled());
    }

    /// A line that is as it was read while `valid`, otherwise `canonical`.
    fn spelled(&mut self, origin: &Origin, blanks: usize, valid: impl Fn(&str) -> bool, canonical: String) {
        self.before(origin, blanks);
        match &origin.spelling {
            Some(line) if valid(line) => self.lines.push(line.to_string()),
            _ => self.lines.push(canonical),
        }
    }

    fn begin(&mut self, origin: &Origin, word: &str) {
        let canonical = format!("#BEGIN {}", one_line(word));
        self.spelled(origin, 1, |line| begin_word(line) == Some(word), canonical);
    }

    fn end(&mut self, origin: &Origin) {
        if is_missing(origin) {
            self.before(origin, 0);
        } else {
            self.spelled(origin, 0, is_end, "#END".to_owned());
        }
    }

    fn part(&mut self, part: &Part) {
        match part {
            Part::Controller(controller) => self.line(controller, 0),
            Part::Devices(section) => self.section(section, "DEVICE"),
            Part::Memory(section) => self.section(section, "MEM_CONFIG"),
            Part::Documentation(section) => self.section(section, "ELEMENT_DOC"),
            Part::Raw(section) => self.raw(section),
            Part::Code(block) => self.code(block),
            Part::Unread(unread) => self.unread(unread),
        }
    }

    fn unread(&mut self, unread: &Unread) {
        self.before(&unread.origin, 0);
        self.lines.push(one_line(&unread.text));
    }

    fn section<T: Line>(&mut self, section: &Section<T>, word: &str) {
        self.begin(&section.origin, word);
        for row in &section.rows {
            match row {
                Row::Entry(entry) => self.line(entry, 0),
                Row::Unread(unread) => self.unread(unread),
            }
        }
        self.end(&section.end);
    }

    fn raw(&mut self, section: &RawSection) {
        self.begin(&section.origin, &section.name);
        self.lines.extend(section.lines.iter().map(|line| one_line(line)));
        self.end(&section.end);
    }

    fn code(&mut self, block: &CodeBlock) {
        let bare = block.kind == CodeKind::Bare;
        if !bare {
            let (word, name) = (block.kind.begin(), block.name.as_str());
            let valid = |line: &str| is_delimiter(line, word, name);
            self.spelled(&block.origin, 1, valid, format!("{word}\t{name}"));
        }
        let mut previous: Option<&[Instruction]> = None;
        for rung in &block.rungs {
            if let Some(comment) = &rung.comment {
                self.before(&comment.origin, 1);
                self.lines.extend(comment.spelled().split('\n').map(str::to_owned));
                previous = None;
            }
            for (index, instruction) in rung.instructions.iter().enumerate() {
                let first = index == 0;
                let start = self.lines.len();
                self.before(&instruction.origin, usize::from(first));
                let blank = |line: &String| line.trim().is_empty() || line.starts_with("// Rung ");
                if first {
                    // Whatever was before it in the file it came from, a rung must begin here.
                    let apart = self.lines.iter().skip(start).any(blank);
                    let begins = previous.is_none_or(|last| stack::begins_rung(last, &rung.instructions));
                    if !apart && !begins {
                        self.lines.push(String::new());
                    }
                } else {
                    // A blank line would end the rung.
                    let mut before = self.lines.split_off(start);
                    before.retain(|line| !blank(line));
                    self.lines.append(&mut before);
                }
                self.lines.push(instruction.spelled());
            }
            previous = Some(&rung.instructions);
        }
        if bare {
            return;
        }
        if is_missing(&block.end) {
            self.before(&block.end, 0);
        } else {
            let (word, name) = (block.kind.end(), block.name.as_str());
            let valid = |line: &str| is_delimiter(line, word, name);
            self.spelled(&block.end, 1, valid, format!("{word}\t{name}"));
        }
    }
}

/// Whether a line begins or ends the code block of that name.
fn is_delimiter(line: &str, word: &str, name: &str) -> bool {
    let words = split(line).words;
    words.first() == Some(&word) && words.get(1).copied().unwrap_or_default() == name
}

/// What was read had no such line.
fn is_missing(origin: &Origin) -> bool {
    origin.spelling.as_deref() == Some("")
}

/// A line that cannot be taken for content.
fn between(line: &str) -> String {
    let line = one_line(line);
    let trimmed = line.trim();
    if trimmed.is_empty() || trimmed.starts_with("//") { line } else { format!("// {line}") }
}
