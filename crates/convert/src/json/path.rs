//! Where in a document the reader is, kept on the stack and spelled out only for an error.

use std::fmt::Write as _;

use super::error::JsonError;

/// A member of a document, as a list from the inside out.
#[derive(Clone, Copy)]
pub(super) struct Path<'a> {
    outer: Option<&'a Path<'a>>,
    step: Step<'a>,
}

#[derive(Clone, Copy)]
enum Step<'a> {
    Whole,
    Member(&'a str),
    Index(usize),
}

impl<'a> Path<'a> {
    pub(super) fn whole() -> Path<'static> {
        Path { outer: None, step: Step::Whole }
    }

    pub(super) fn member(&'a self, name: &'a str) -> Path<'a> {
        Path { outer: Some(self), step: Step::Member(name) }
    }

    pub(super) fn index(&'a self, index: usize) -> Path<'a> {
        Path { outer: Some(self), step: Step::Index(index) }
    }

    /// Converts each element of a list, which is the member `name` here.
    pub(super) fn each<T, U>(
        &self,
        name: &str,
        list: Vec<T>,
        convert: impl Fn(T, Path<'_>) -> Result<U, JsonError>,
    ) -> Result<Vec<U>, JsonError> {
        let list_path = self.member(name);
        list.into_iter().enumerate().map(|(index, item)| convert(item, list_path.index(index))).collect()
    }

    pub(super) fn error(&self, expected: impl Into<String>, found: impl Into<String>) -> JsonError {
        JsonError::new(self.pointer(), expected, found)
    }

    fn pointer(&self) -> String {
        let mut pointer = self.outer.map(Path::pointer).unwrap_or_default();
        // Writing to a string cannot fail. Member names here are ours and need no escapes, except
        // those of element members, which a document may spell in any way.
        let _ = match self.step {
            Step::Whole => Ok(()),
            Step::Member(name) => write!(pointer, "/{}", name.replace('~', "~0").replace('/', "~1")),
            Step::Index(index) => write!(pointer, "/{index}"),
        };
        pointer
    }
}

/// A text in an error, quoted and cut to a length one can read.
pub(super) fn quoted(text: &str) -> String {
    const SHOWN: usize = 40;
    let cut = if text.chars().nth(SHOWN).is_some() { "…" } else { "" };
    format!("\"{}{cut}\"", text.chars().take(SHOWN).collect::<String>())
}
