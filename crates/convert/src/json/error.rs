//! Why a JSON document is no project, and where.

use std::fmt;

/// A place in a JSON document that a project does not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JsonError {
    /// JSON pointer (RFC 6901) of the member: `/program_files/2/rungs/0/text`. Empty for the whole
    /// document.
    pub pointer: String,
    /// Line and column in the text, from 1, where the text itself or the type of a member is wrong.
    /// `None` where the content of a well-formed member is.
    pub position: Option<(usize, usize)>,
    /// What belongs there.
    pub expected: String,
    /// What is there.
    pub found: String,
}

impl fmt::Display for JsonError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = if self.pointer.is_empty() { "JSON document" } else { &self.pointer };
        write!(f, "{place}")?;
        if let Some((line, column)) = self.position {
            write!(f, " (line {line}, column {column})")?;
        }
        write!(f, ": expected {}, found {}", self.expected, self.found)
    }
}

impl std::error::Error for JsonError {}

impl JsonError {
    /// An error about content.
    pub(super) fn new(pointer: String, expected: impl Into<String>, found: impl Into<String>) -> JsonError {
        JsonError { pointer, position: None, expected: expected.into(), found: found.into() }
    }

    /// An error of the JSON text or of a member's type, as the JSON library words it.
    pub(super) fn from_text(path: &serde_path_to_error::Path, inner: &serde_json::Error) -> JsonError {
        let mut pointer = String::new();
        for segment in path {
            match segment {
                serde_path_to_error::Segment::Seq { index } => push(&mut pointer, &index.to_string()),
                serde_path_to_error::Segment::Map { key } => push(&mut pointer, key),
                serde_path_to_error::Segment::Enum { variant } => push(&mut pointer, variant),
                serde_path_to_error::Segment::Unknown => {}
            }
        }
        let position = (inner.line() > 0).then(|| (inner.line(), inner.column()));
        let message = inner.to_string();
        let place = format!(" at line {} column {}", inner.line(), inner.column());
        let message = message.strip_suffix(&place).unwrap_or(&message);
        let (expected, found) = split(message, inner.classify());
        JsonError { pointer, position, expected, found }
    }
}

/// Adds a reference token to a pointer.
fn push(pointer: &mut String, token: &str) {
    pointer.push('/');
    pointer.push_str(&token.replace('~', "~0").replace('/', "~1"));
}

/// The library says `invalid type: FOUND, expected WANTED`, ``missing field `name` `` and so on.
fn split(message: &str, category: serde_json::error::Category) -> (String, String) {
    if category != serde_json::error::Category::Data {
        return ("JSON text".to_owned(), message.to_owned());
    }
    if let Some(name) = message.strip_prefix("missing field ") {
        return (format!("a member {name}"), "none".to_owned());
    }
    if let Some(name) = message.strip_prefix("duplicate field ") {
        return (format!("{name} once"), "it again".to_owned());
    }
    match message.split_once(", expected ") {
        Some((found, expected)) => {
            let found = ["invalid type: ", "invalid value: ", "invalid length: "]
                .into_iter()
                .find_map(|prefix| found.strip_prefix(prefix))
                .unwrap_or(found);
            // Names of our structs say nothing to whoever reads the message.
            let expected = if expected.starts_with("struct ") { "an object" } else { expected };
            (expected.to_owned(), found.to_owned())
        }
        None => ("a rungs.project/1 document".to_owned(), message.to_owned()),
    }
}
