//! What a reader found wrong or did not understand, with its place.

/// How much a finding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing; nothing is missing.
    Note,
    /// Of a file: something deviates from what is known of the format, data is kept. Of a program: often wrong.
    Warning,
    /// Of a file: a part could not be read, what is shown is incomplete. Of a program: it cannot run or do its work so.
    Error,
}

impl Severity {
    /// Lower-case word used in every output.
    pub fn as_str(self) -> &'static str {
        match self {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        }
    }
}

/// One finding about a project.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// How much it matters.
    pub severity: Severity,
    /// Where: stream, offset and record path, or file and rung, as a person would look for it.
    pub place: String,
    /// What was expected and what was found.
    pub message: String,
}
