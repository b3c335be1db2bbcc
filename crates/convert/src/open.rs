//! Opens a project of any form by its content.

use std::fmt;

use ladder::{Project, Source};
use rss::Mode;
use sha2::{Digest, Sha256};

use crate::designer::Document;

/// Why a file is no project.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum OpenError {
    /// Not a project file, or one too damaged to read.
    File(rss::Error),
    /// A text that is no SLC file.
    Text(crate::slc::FileError),
    /// A JSON document that is no project.
    Json(crate::json::JsonError),
    /// A text for Do-more Designer where only a project of RSLogix 500 will do.
    OtherDialect,
    /// A text for Do-more Designer that cannot be read.
    Domore(domore::text::Error),
    /// A project with a deviation, read strictly.
    Deviation(ladder::Diagnostic),
    /// A text for Do-more Designer with a deviation, read strictly.
    Strict(domore::Diagnostic),
}

impl fmt::Display for OpenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OpenError::File(error) => error.fmt(f),
            OpenError::Text(error) => error.fmt(f),
            OpenError::Json(error) => error.fmt(f),
            OpenError::OtherDialect => f.write_str("expected a project of RSLogix 500, found one of Do-more Designer"),
            OpenError::Domore(error) => error.fmt(f),
            OpenError::Deviation(found) => write!(f, "strict reading: {}: {}", found.place, found.message),
            OpenError::Strict(found) => write!(f, "strict reading: {found}"),
        }
    }
}

impl std::error::Error for OpenError {}

/// Largest SLC text that is read: ten times what the largest known program gives. The model of a text
/// takes many times its size.
pub const MAX_SLC_TEXT: usize = 4 << 20;

/// Largest JSON project that is read, as large as a project file may be.
pub const MAX_JSON: usize = rss::container::MAX_FILE;

/// Opens an `.RSS` file, SLC text or a JSON project; the content decides, never the name.
/// `file_name` is only recorded.
///
/// # Errors
/// What the file is instead, or where it is damaged. In [`Mode::Strict`] the first deviation.
pub fn open(bytes: &[u8], file_name: &str, mode: Mode) -> Result<Project, OpenError> {
    let source = source(bytes, file_name);
    match rss::Project::read(bytes, mode) {
        Ok(file) => strict(crate::from_rss::project(&file, source), mode),
        Err(rss::Error::Foreign(rss::Foreign::SlcText)) => {
            within(bytes, MAX_SLC_TEXT, "an SLC text")?;
            let project = crate::slc::project::read(&crate::slc::decode(bytes)).map_err(OpenError::Text)?;
            strict(Project { source, ..project }, mode)
        }
        Err(error) => match json_text(bytes) {
            Some(text) => {
                within(bytes, MAX_JSON, "a JSON project")?;
                crate::json::from_json(text).map_err(OpenError::Json)
            }
            None if crate::designer::is_designer(bytes) => Err(OpenError::OtherDialect),
            None => Err(OpenError::File(error)),
        },
    }
}

/// A project of any dialect.
#[derive(Clone, Debug)]
pub enum AnyProject {
    /// SLC 500 or MicroLogix.
    Rslogix(Box<Project>),
    /// Do-more.
    Domore(Box<Document>),
}

/// As [`open()`], and texts for Do-more Designer besides.
///
/// # Errors
/// As [`open()`].
pub fn open_any(bytes: &[u8], file_name: &str, mode: Mode) -> Result<AnyProject, OpenError> {
    match open(bytes, file_name, mode) {
        Err(OpenError::OtherDialect) => {}
        result => return result.map(|project| AnyProject::Rslogix(Box::new(project))),
    }
    let document = crate::designer::from_bytes(bytes, source(bytes, file_name)).map_err(OpenError::Domore)?;
    let worst = document.diagnostics.iter().find(|found| found.problem.severity() >= ladder::Severity::Warning);
    match worst {
        Some(found) if mode == Mode::Strict => Err(OpenError::Strict(found.clone())),
        _ => Ok(AnyProject::Domore(Box::new(document))),
    }
}

fn source(bytes: &[u8], file_name: &str) -> Source {
    Source {
        file: file_name.to_owned(),
        sha256: hex(&Sha256::digest(bytes)),
        bytes: u64::try_from(bytes.len()).unwrap_or(u64::MAX),
        ..Source::default()
    }
}

fn within(bytes: &[u8], limit: usize, what: &str) -> Result<(), OpenError> {
    if bytes.len() <= limit {
        return Ok(());
    }
    Err(OpenError::File(rss::Error::from(rss::Deviation {
        stream: String::new(),
        space: rss::Space::File,
        offset: limit,
        record: String::new(),
        expected: format!("{what} of at most {limit} bytes"),
        found: format!("{} bytes", bytes.len()),
    })))
}

/// A document that opens with `{` and names our schema near its beginning.
fn json_text(bytes: &[u8]) -> Option<&str> {
    let text = std::str::from_utf8(bytes).ok()?;
    let head: String = text.chars().take(400).collect();
    (head.trim_start().starts_with('{') && head.contains("\"rungs.project/")).then_some(text)
}

fn strict(project: Project, mode: Mode) -> Result<Project, OpenError> {
    let worst = project.diagnostics.iter().find(|d| d.severity >= ladder::Severity::Warning);
    match worst {
        Some(first) if mode == Mode::Strict => Err(OpenError::Deviation(first.clone())),
        _ => Ok(project),
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
