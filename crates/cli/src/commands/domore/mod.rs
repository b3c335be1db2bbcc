//! Commands on Do-more projects: the same questions, asked of the other dialect.

mod data;
mod export;
mod info;
mod show;
mod timers;
mod verify;
mod xref;

pub use data::data;
pub use export::{ending, exported};
pub use info::info;
pub use show::show;
pub use timers::timers;
pub use verify::verify;
pub use xref::xref;

use std::io::Write;
use std::path::PathBuf;

use convert::designer::Document;
use ladder::Severity;
use serde_json::{Value, json};

use crate::output::{Error, Outcome, printable};

/// A Do-more project from a file.
pub struct OpenedDomore {
    pub path: PathBuf,
    pub document: Document,
}

/// Findings printed below what a command prints.
const MOST_FINDINGS: usize = 20;

impl OpenedDomore {
    pub fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// How reading came out: lines nobody understood are unreadable input, rungs that do not balance are a
    /// finding.
    pub fn outcome(&self) -> Outcome {
        let errors = || self.document.diagnostics.iter().filter(|found| found.problem.severity() == Severity::Error);
        if errors().any(|found| found.rung.is_none()) {
            Outcome::Unreadable
        } else if errors().next().is_some() {
            Outcome::Finding
        } else {
            Outcome::Done
        }
    }

    /// Says what deviates, so that partial data never passes for the whole.
    pub fn warn(&self) {
        let found = || self.document.diagnostics.iter().filter(|found| found.problem.severity() >= Severity::Warning);
        for found in found().take(MOST_FINDINGS) {
            let severity = found.problem.severity().as_str();
            eprintln!("{}", printable(&format!("{}: {severity}: {found}", self.name())));
        }
        let more = found().count().saturating_sub(MOST_FINDINGS);
        if more > 0 {
            eprintln!("{}: {more} further findings, see `rungs verify --json`", self.name());
        }
    }

    /// Writes a document as one line, with what the reader found wrong.
    pub fn write_json(&self, mut document: Value, out: &mut dyn Write) -> Result<(), Error> {
        document["diagnostics"] = self.diagnostics();
        Ok(writeln!(out, "{document}")?)
    }

    pub fn diagnostics(&self) -> Value {
        let one = |found: &domore::Diagnostic| {
            let found = found.to_ladder();
            json!({"severity": found.severity.as_str(), "place": found.place, "message": found.message})
        };
        self.document.diagnostics.iter().map(one).collect()
    }
}
