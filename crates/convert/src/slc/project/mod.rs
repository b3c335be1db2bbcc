//! `.SLC` files to the program model and back.
//!
//! Such a file holds the program, rung comments and page titles, data tables, forces and the I/O
//! slots. It has no symbols, no descriptions, no names of data files and no channels: [`export()`]
//! lists what it had to leave out.

mod export;
mod import;
mod processor;

use std::fmt;

use ladder::Project;

pub use export::{Export, export};
pub use import::project;

use super::file::Section;

/// Why a text is no `.SLC` file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileError {
    /// Line, from 1.
    pub line: u32,
    /// What belongs there.
    pub expected: String,
    /// What stands there, shortened.
    pub found: String,
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: expected {}, found `{}`", self.line, self.expected, self.found)
    }
}

impl std::error::Error for FileError {}

/// Reads the text of an `.SLC` file. What could not be read of it is in the project's diagnostics;
/// a rung with an error keeps its text and number, see [`super::rung::UNREAD`].
///
/// # Errors
/// A text without any section of such a file, or with more rungs than [`crate::MAX_PARTS`] by far
/// allows.
pub fn read(text: &str) -> Result<Project, FileError> {
    within(text)?;
    let file = super::file::read(text);
    if file.sections.iter().all(|section| matches!(section, Section::Other(_))) {
        let lines = || (1_u32..).zip(text.lines());
        let (line, found) = lines().find(|(_, line)| !line.trim().is_empty()).unwrap_or((1, ""));
        let found = found.trim().chars().take(40).collect();
        return Err(FileError { line, expected: "an SLC file, which begins with START".to_owned(), found });
    }
    Ok(project(&file))
}

/// Rungs that a text may have: as many as a project file can. Empty ones and unreadable ones count.
const MAX_RUNGS: usize = 65_535;

/// Looks for the first rung too many before anything is made of the others.
fn within(text: &str) -> Result<(), FileError> {
    let rungs = (1_u32..).zip(text.lines()).filter(|(_, line)| line.trim_start().starts_with("SOR"));
    match rungs.into_iter().nth(MAX_RUNGS) {
        None => Ok(()),
        Some((line, found)) => {
            let found = found.trim().chars().take(40).collect();
            Err(FileError { line, expected: format!("an SLC file of at most {MAX_RUNGS} rungs"), found })
        }
    }
}
