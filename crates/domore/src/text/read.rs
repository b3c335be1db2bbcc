//! Text to model. Every line ends up in the model; what deviates is carried and reported.

use std::fmt;

use super::rows::{Line, begin_word, comment_kind, is_comment_line, is_end};
use super::words::split;
use crate::diagnostic::{Diagnostic, Problem};
use crate::elements;
use crate::instruction::{self, Effect, Join};
use crate::program::{
    CodeBlock, CodeKind, Comment, Controller, Device, ElementDoc, Format, Instruction, LineEnd, MemoryBlock, Origin,
    Part, Project, RawSection, Row, Rung, Section, Unread,
};
use crate::stack;

/// Longest text that is read, in bytes; the largest known export has less than a hundredth of that.
pub const MAX_TEXT: usize = 16 << 20;
/// Most lines that are read. The model of a line takes many times the line.
pub const MAX_LINES: usize = 1_000_000;

/// A project and what was found wrong with it.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// Everything in the text.
    pub project: Project,
    /// What deviates, in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
}

/// Why a text is not read at all.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// More bytes or lines than any project has.
    TooLarge {
        /// `bytes` or `lines`.
        unit: &'static str,
        /// How many are read at most.
        limit: usize,
    },
    /// A character that no text has.
    NotText {
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// The character.
        found: char,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::TooLarge { unit, limit } => {
                write!(f, "expected a Do-more text of at most {limit} {unit}, found more")
            }
            Error::NotText { line, column, found } => {
                write!(f, "line {line}, column {column}: expected text, found character U+{:04X}", u32::from(*found))
            }
        }
    }
}

impl std::error::Error for Error {}

/// Whether a text looks like one for Do-more Designer: its first lines name a controller, a section, a
/// code block, or it begins with an instruction that begins a rung.
pub fn is_domore(text: &str) -> bool {
    const SECTIONS: [&str; 5] = ["SYS_CONFIG", "DEVICE", "MEM_CONFIG", "UDT_CONFIG", "ELEMENT_DOC"];
    let mut lines = text.lines().take(200).filter(|line| !is_between(line)).peekable();
    let Some(first) = lines.peek() else { return false };
    let begins_rung = split(first).words.first().and_then(|word| instruction::by_mnemonic(word)).is_some_and(|entry| {
        let push = matches!(entry.effect, Effect::Contact { join: Join::Push, .. });
        push || matches!(entry.mnemonic, "SG" | "NOP" | "FOR" | "REPEAT")
    });
    let is_comment = begin_word(first).is_some_and(|word| comment_kind(word).is_some());
    begins_rung
        || is_comment
        || lines.take(20).any(|line| {
            let word = line.split_whitespace().next().unwrap_or_default();
            word == "PLC"
                || begin_word(line).is_some_and(|word| SECTIONS.contains(&word))
                || CodeKind::from_begin(word).is_some_and(|kind| !matches!(kind, CodeKind::Other { .. }))
        })
}

/// Reads a text. What deviates from the known form is carried and reported, never left out.
///
/// # Errors
/// If it is too large, or no text at all.
pub fn read(text: &str) -> Result<Reading, Error> {
    if text.len() > MAX_TEXT {
        return Err(Error::TooLarge { unit: "bytes", limit: MAX_TEXT });
    }
    if text.bytes().filter(|byte| *byte == b'\n').count() >= MAX_LINES {
        return Err(Error::TooLarge { unit: "lines", limit: MAX_LINES });
    }
    // A carriage return that no line feed follows is no line end, and nothing else either.
    for (index, line) in text.lines().enumerate() {
        let odd = |c: &char| c.is_control() && !matches!(c, '\t' | '\u{80}'..='\u{9F}');
        if let Some(found) = line.chars().find(odd) {
            let column = line.chars().take_while(|c| !odd(c)).count() + 1;
            return Err(Error::NotText { line: index + 1, column, found });
        }
    }
    Ok(Reader::new(text).run())
}

/// Blank and `//` lines stand between things and belong to the next one.
fn is_between(line: &str) -> bool {
    let line = line.trim();
    line.is_empty() || line.starts_with("//")
}

#[derive(Clone, Copy)]
struct TextLine<'a> {
    number: u32,
    text: &'a str,
}

struct Reader<'a> {
    lines: std::iter::Peekable<std::vec::IntoIter<TextLine<'a>>>,
    format: Format,
    /// Blank and `//` lines that belong to whatever comes next.
    before: Vec<Box<str>>,
    parts: Vec<Part>,
    /// The code block that is open.
    block: Option<CodeBlock>,
    /// The last rung of the open block takes the next instruction, whatever is between.
    awaiting: bool,
    diagnostics: Vec<Diagnostic>,
}

impl<'a> Reader<'a> {
    fn new(text: &'a str) -> Self {
        let first_end = text.find('\n');
        let crlf = first_end.is_none_or(|at| text.get(..at).is_some_and(|line| line.ends_with('\r')));
        let line_end = if crlf { LineEnd::CrLf } else { LineEnd::Lf };
        let ends_with_line_end = text.ends_with('\n');
        let body = text.strip_suffix('\n').unwrap_or(text);
        let mut mixed = None;
        let mut lines = Vec::new();
        if !text.is_empty() {
            for (number, line) in (1_u32..).zip(body.split('\n')) {
                let (line, ended_crlf) = match line.strip_suffix('\r') {
                    Some(line) if crlf => (line, true),
                    Some(line) => {
                        mixed.get_or_insert(number);
                        (line, true)
                    }
                    None => (line, false),
                };
                lines.push((TextLine { number, text: line }, ended_crlf));
            }
        }
        // The last line may have no end at all.
        let ended = if ends_with_line_end { lines.len() } else { lines.len().saturating_sub(1) };
        if crlf {
            mixed = lines.iter().take(ended).find(|(_, ended_crlf)| !ended_crlf).map(|(line, _)| line.number);
        }
        let diagnostics = mixed
            .map(|line| Diagnostic { line, column: 1, rung: None, problem: Problem::MixedLineEnds })
            .into_iter()
            .collect();
        Reader {
            lines: lines.into_iter().map(|(line, _)| line).collect::<Vec<_>>().into_iter().peekable(),
            format: Format { line_end, ends_with_line_end, ..Format::default() },
            before: Vec::new(),
            parts: Vec::new(),
            block: None,
            awaiting: false,
            diagnostics,
        }
    }

    fn run(mut self) -> Reading {
        while let Some(line) = self.lines.next() {
            self.line(line);
        }
        self.close_block(None);
        let tail = self.origin(0);
        let project = Project { format: self.format, parts: self.parts, tail };
        let mut diagnostics = self.diagnostics;
        diagnostics.extend(stack::check_project(&project));
        diagnostics.extend(elements::check(&project));
        diagnostics.sort_by_key(|found| (found.line, found.column));
        Reading { project, diagnostics }
    }

    fn line(&mut self, line: TextLine<'a>) {
        let text = line.text.trim();
        if is_between(text) {
            self.before.push(line.text.into());
        } else if let Some(word) = begin_word(text) {
            self.section(line, word);
        } else if text.starts_with('$') {
            self.delimiter(line);
        } else if is_end(text) && self.block.is_none() {
            self.unread(line, Problem::StrayEnd);
        } else if let Some(controller) = self.controller(line.text) {
            self.close_block(None);
            let origin = self.origin(line.number);
            self.parts.push(Part::Controller(Controller { origin: keep(origin, &controller.origin), ..controller }));
        } else {
            self.instruction(line);
        }
    }

    /// `PLC` stands outside of code blocks.
    fn controller(&self, line: &str) -> Option<Controller> {
        let inside = self.block.as_ref().is_some_and(|block| block.kind != CodeKind::Bare);
        if inside { None } else { Controller::read(line) }
    }

    /// The origin of what comes now: takes the lines before it.
    fn origin(&mut self, line: u32) -> Origin {
        let before = std::mem::take(&mut self.before).into_boxed_slice();
        Origin { line, before: Some(before), spelling: None }
    }

    /// An origin that also keeps the line, unless `canonical` is just that.
    fn origin_spelled(&mut self, line: TextLine<'a>, canonical: &str) -> Origin {
        let spelling = (line.text != canonical).then(|| line.text.into());
        Origin { spelling, ..self.origin(line.number) }
    }

    fn report(&mut self, line: u32, column: usize, problem: Problem) {
        let column = u32::try_from(column).unwrap_or(u32::MAX);
        self.diagnostics.push(Diagnostic { line, column, rung: None, problem });
    }

    fn unread(&mut self, line: TextLine<'a>, problem: Problem) {
        self.report(line.number, indent(line.text) + 1, problem);
        let origin = self.origin(line.number);
        self.parts.push(Part::Unread(Unread { text: line.text.to_owned(), origin }));
    }

    /// A `#BEGIN` line with all that belongs to it.
    fn section(&mut self, line: TextLine<'a>, word: &'a str) {
        match (word, &self.block) {
            (word, _) if comment_kind(word).is_some() => self.comment(line),
            ("DEVICE", _) => {
                let section = self.rows::<Device>(line, word);
                self.parts.push(Part::Devices(section));
            }
            ("MEM_CONFIG", _) => {
                let section = self.rows::<MemoryBlock>(line, word);
                self.parts.push(Part::Memory(section));
            }
            ("ELEMENT_DOC", _) => {
                let section = self.rows::<ElementDoc>(line, word);
                self.parts.push(Part::Documentation(section));
            }
            (word, Some(block)) if block.kind != CodeKind::Bare && !is_project_section(word) => self.comment(line),
            _ => self.raw(line, word),
        }
    }

    fn raw(&mut self, line: TextLine<'a>, word: &str) {
        self.close_block(None);
        let origin = self.origin_spelled(line, &format!("#BEGIN {word}"));
        let (lines, end) = self.body(line.number, word);
        let lines: Vec<String> = lines.into_iter().map(|line| line.text.to_owned()).collect();
        self.parts.push(Part::Raw(RawSection { name: word.to_owned(), lines, origin, end }));
    }

    fn rows<T: Line>(&mut self, line: TextLine<'a>, word: &str) -> Section<T> {
        self.close_block(None);
        let origin = self.origin_spelled(line, &format!("#BEGIN {word}"));
        let (lines, mut end) = self.body(line.number, word);
        let mut rows = Vec::new();
        for line in lines {
            if is_between(line.text) {
                self.before.push(line.text.into());
                continue;
            }
            rows.push(match T::read(line.text) {
                Some(mut entry) => {
                    let place = self.origin(line.number);
                    let kept = keep(place, entry.origin());
                    *entry.origin_mut() = kept;
                    Row::Entry(entry)
                }
                None => {
                    let problem = Problem::Row { section: word.to_owned(), expected: T::FORM };
                    self.report(line.number, indent(line.text) + 1, problem);
                    Row::Unread(Unread { text: line.text.to_owned(), origin: self.origin(line.number) })
                }
            });
        }
        end.before = self.origin(0).before;
        Section { rows, origin, end }
    }

    /// The lines of a section and its `#END`. A section that another `#BEGIN` or the end of the text
    /// cuts off has an end without spelling.
    fn body(&mut self, begin: u32, word: &str) -> (Vec<TextLine<'a>>, Origin) {
        let mut lines = Vec::new();
        while let Some(line) = self.lines.next_if(|line| begin_word(line.text).is_none()) {
            if is_end(line.text) {
                let spelling = (line.text != "#END").then(|| line.text.into());
                return (lines, Origin { line: line.number, before: None, spelling });
            }
            lines.push(line);
        }
        self.report(begin, 1, Problem::OpenSection(word.to_owned()));
        (lines, Origin { line: 0, before: None, spelling: Some("".into()) })
    }

    /// A comment above a rung, or another section among rungs.
    fn comment(&mut self, line: TextLine<'a>) {
        let word = begin_word(line.text).unwrap_or_default();
        self.open_block();
        let origin = self.origin(line.number);
        let (lines, end) = self.body(line.number, word);
        if let Some(block) = &mut self.block {
            block.rungs.push(Rung::default());
        }
        if comment_kind(word).is_some() {
            for line in lines.iter().filter(|line| !is_comment_line(line.text)) {
                self.report(line.number, 1, Problem::CommentLine);
            }
        }
        let mut text = line.text.to_owned();
        for line in &lines {
            text.push('\n');
            text.push_str(line.text);
        }
        if end.line > 0 {
            text.push('\n');
            text.push_str(end.spelling.as_deref().unwrap_or("#END"));
        }
        let comment = Comment::read(&text).unwrap_or_default();
        if let Some(rung) = self.block.as_mut().and_then(|block| block.rungs.last_mut()) {
            rung.comment = Some(Comment { origin: keep(origin, &comment.origin), ..comment });
        }
        self.awaiting = true;
    }

    /// A line with `$`: begins or ends a code block.
    fn delimiter(&mut self, line: TextLine<'a>) {
        let words = split(line.text).words;
        let word = words.first().copied().unwrap_or_default();
        let name = words.get(1).copied().unwrap_or_default();
        if let Some(kind) = CodeKind::from_begin(word) {
            self.close_block(None);
            if matches!(kind, CodeKind::Other { .. }) {
                self.report(line.number, indent(line.text) + 1, Problem::UnknownCodeKind(word.to_owned()));
            }
            let origin = self.origin_spelled(line, &format!("{word}\t{name}"));
            self.block = Some(CodeBlock { kind, name: name.to_owned(), origin, ..CodeBlock::default() });
            self.awaiting = false;
            return;
        }
        match &self.block {
            Some(block) if block.kind != CodeKind::Bare && block.kind.end() == word && block.name == name => {
                self.close_block(Some(line));
            }
            _ => {
                self.close_block(None);
                self.unread(line, Problem::StrayCodeEnd(line.text.trim().to_owned()));
            }
        }
    }

    /// Ends the open block, if any: with its line, or without because something else begins.
    fn close_block(&mut self, end: Option<TextLine<'a>>) {
        let Some(mut block) = self.block.take() else { return };
        match end {
            Some(line) => {
                let canonical = format!("{}\t{}", block.kind.end(), block.name);
                block.end = self.origin_spelled(line, &canonical);
            }
            None => {
                block.end = Origin { line: 0, before: Some(Box::default()), spelling: Some("".into()) };
                if block.kind != CodeKind::Bare {
                    let expected = format!("{} {}", block.kind.end(), block.name);
                    let problem = Problem::OpenCodeBlock { name: block.name.clone(), expected };
                    self.report(block.origin.line, 1, problem);
                }
            }
        }
        block.rungs = block.rungs.into_iter().flat_map(stack::split_rungs).collect();
        let named = |part: &Part| matches!(part, Part::Code(other) if other.name == block.name);
        if block.kind != CodeKind::Bare && self.parts.iter().any(named) {
            self.report(block.origin.line, 1, Problem::DuplicateCodeBlock(block.name.clone()));
        }
        self.parts.push(Part::Code(block));
    }

    /// Rungs outside of a code block are one without delimiters.
    fn open_block(&mut self) {
        if self.block.is_none() {
            let origin = Origin { line: 0, before: Some(Box::default()), spelling: None };
            self.block = Some(CodeBlock { kind: CodeKind::Bare, origin, ..CodeBlock::default() });
            self.awaiting = false;
        }
    }

    fn instruction(&mut self, line: TextLine<'a>) {
        let words = split(line.text);
        let first = words.words.first().copied().unwrap_or_default();
        let shaped = is_mnemonic(first);
        let upper = shaped && !first.bytes().any(|byte| byte.is_ascii_lowercase());
        if self.block.is_none() && !upper && instruction::by_mnemonic(first).is_none() {
            self.unread(line, Problem::UnknownLine);
            return;
        }
        self.open_block();
        // Blank lines separate rungs; so do the annotations of Designer.
        let separated = self.before.iter().any(|line| line.trim().is_empty() || line.starts_with("// Rung "));
        let origin = self.origin(line.number);
        let instruction = Instruction::read(line.text).unwrap_or_default();
        let instruction = Instruction { origin: keep(origin, &instruction.origin), ..instruction };
        if let Some(block) = &mut self.block {
            if (separated && !self.awaiting) || block.rungs.is_empty() {
                block.rungs.push(Rung::default());
            }
            if let Some(rung) = block.rungs.last_mut() {
                rung.instructions.push(instruction);
            }
        }
        self.awaiting = false;
        if !shaped {
            self.report(line.number, indent(line.text) + 1, Problem::NotAnInstruction(first.to_owned()));
        }
        if let Some(at) = words.open_quote {
            let column = line.text.get(..at).map_or(0, |before| before.chars().count()) + 1;
            self.report(line.number, column, Problem::OpenQuote);
        }
    }
}

/// The origin of a place together with the spelling of a line.
fn keep(place: Origin, line: &Origin) -> Origin {
    Origin { spelling: line.spelling.clone(), ..place }
}

/// Sections that stand outside of code blocks only.
fn is_project_section(word: &str) -> bool {
    matches!(word, "SYS_CONFIG" | "UDT_CONFIG")
}

/// Letters, digits and underscores, beginning with a letter.
fn is_mnemonic(word: &str) -> bool {
    let mut bytes = word.bytes();
    bytes.next().is_some_and(|byte| byte.is_ascii_alphabetic())
        && bytes.all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
}

/// Characters of white space before the text of a line.
fn indent(line: &str) -> usize {
    line.chars().take_while(|c| c.is_whitespace()).count()
}
