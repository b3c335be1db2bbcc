//! Walks the lines of a text and collects what is wrong with them.

use ladder::{Diagnostic, Severity};

/// The lines of a text from the current one on.
pub(super) struct Lines<'a> {
    rest: std::iter::Peekable<std::str::Lines<'a>>,
    /// Number of the line `peek` shows, from 1.
    number: u32,
    diagnostics: Vec<Diagnostic>,
    unreported: usize,
    unreported_severity: Severity,
}

/// A text that is no `.SLC` file at all has as many faults as lines; nobody reads that many.
const MOST_DIAGNOSTICS: usize = 1000;

impl<'a> Lines<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Lines {
            rest: text.lines().peekable(),
            number: 1,
            diagnostics: Vec::new(),
            unreported: 0,
            unreported_severity: Severity::Note,
        }
    }

    /// The current line without its line end.
    pub(super) fn peek(&mut self) -> Option<&'a str> {
        self.rest.peek().copied()
    }

    pub(super) fn next(&mut self) -> Option<&'a str> {
        let line = self.rest.next()?;
        self.number = self.number.saturating_add(1);
        Some(line)
    }

    pub(super) fn number(&self) -> u32 {
        self.number
    }

    pub(super) fn warn(&mut self, line: u32, message: impl Into<String>) {
        self.push(Severity::Warning, line, message.into());
    }

    /// Something that is in the text and will not be in the project.
    pub(super) fn lost(&mut self, line: u32, message: impl Into<String>) {
        self.push(Severity::Error, line, message.into());
    }

    fn push(&mut self, severity: Severity, line: u32, message: String) {
        if self.diagnostics.len() + 1 >= MOST_DIAGNOSTICS {
            self.unreported += 1;
            self.unreported_severity = self.unreported_severity.max(severity);
            return;
        }
        self.diagnostics.push(Diagnostic { severity, place: format!("line {line}"), message });
    }

    /// Moves the current line to `kept` because nothing explains it.
    pub(super) fn keep(&mut self, kept: &mut String, why: &str) {
        let line = self.number;
        let Some(text) = self.next() else { return };
        push_line(kept, text.trim_end());
        self.lost(line, format!("{why}, found `{}`; the project does not hold this line", shortened(text)));
    }

    pub(super) fn into_diagnostics(mut self) -> Vec<Diagnostic> {
        if self.unreported > 0 {
            self.diagnostics.push(Diagnostic {
                severity: self.unreported_severity,
                place: "file".to_owned(),
                message: format!("{} more lines deviate", self.unreported),
            });
        }
        self.diagnostics
    }
}

/// Appends a line to lines separated by LF.
pub(super) fn push_line(lines: &mut String, line: &str) {
    if !lines.is_empty() {
        lines.push('\n');
    }
    lines.push_str(line);
}

/// The beginning of a text, for messages.
pub(super) fn shortened(text: &str) -> String {
    const SHOWN: usize = 40;
    let text = text.trim();
    let mut shown: String = text.chars().take(SHOWN).collect();
    if shown.len() < text.len() {
        shown.push('…');
    }
    shown
}
