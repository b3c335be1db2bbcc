//! Projects as JSON documents of the schema `rungs.project/1`.
//!
//! A document is for other tools: everything a person sees of the project under stable names, with
//! more beside it so that [`from_json`] gives the same model back. The published JSON Schema,
//! `docs/schema/rungs.project-1.schema.json`, describes each member; in short:
//!
//! * The offline image stands at the top level; `online` and `autosave` are images of the same shape.
//! * A rung's `text` is SLC rung text and holds its branches; `instructions` lists the same
//!   instructions with operands as stored (`JSR 4` in the text, `U:4` as the operand). Where the text
//!   cannot be read back, for an operation code without a name, `structure` gives the branches.
//! * Words are signed. Where a value does not tell all bits of an element (spare control bits,
//!   characters behind a string), `raw` lists the element's words.
//! * JSON has no not-a-number: such floats are the strings `NaN`, `Infinity`, `-Infinity`.
//! * Unknown members are an error, not skipped: a misspelt name must not lose what it holds.

mod data_file;
mod document;
mod error;
mod layout;
mod path;
mod read;
mod structure;
pub(crate) mod target;
mod value;
mod write;

use std::io::{self, Write};

use ladder::Project;
use serde::Serialize as _;

pub use error::JsonError;

/// The schema of the documents this module writes, and the only one it reads.
pub const SCHEMA: &str = "rungs.project/1";

/// The project as a JSON value; member order is that of the schema.
pub fn to_json(project: &Project) -> serde_json::Value {
    // The shape has only string names and finite numbers: there is nothing a value cannot hold.
    serde_json::to_value(write::document(project)).unwrap_or_default()
}

/// Writes the project as a document of one rung, value or symbol per line, with a line end behind it.
///
/// # Errors
/// Only those of `writer`.
pub fn write_json(project: &Project, mut writer: impl Write) -> io::Result<()> {
    let mut serializer = serde_json::Serializer::with_formatter(&mut writer, layout::Layout::default());
    write::document(project).serialize(&mut serializer)?;
    writer.write_all(b"\n")
}

/// Writes the project as a document on one line: several of them are JSON Lines.
///
/// # Errors
/// Only those of `writer`.
pub fn write_json_line(project: &Project, mut writer: impl Write) -> io::Result<()> {
    serde_json::to_writer(&mut writer, &write::document(project))?;
    writer.write_all(b"\n")
}

/// The document that [`write_json`] writes.
pub fn to_json_text(project: &Project) -> String {
    let mut text = Vec::new();
    // Writing to memory cannot fail, and the document is UTF-8.
    let _ = write_json(project, &mut text);
    String::from_utf8(text).unwrap_or_default()
}

/// Reads a JSON document.
///
/// Members that the schema does not require can be left out; the model then has what is least:
/// nothing known, nothing compiled. Nesting is bounded, and memory stays within a small multiple of
/// the text.
///
/// # Errors
/// The first place where the text is no JSON, a member is missing, unknown or of the wrong type, or
/// its content contradicts another member.
pub fn from_json(text: &str) -> Result<Project, JsonError> {
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let mut track = serde_path_to_error::Track::new();
    let tracked = serde_path_to_error::Deserializer::new(&mut deserializer, &mut track);
    let document = match <document::Document<'_> as serde::Deserialize>::deserialize(tracked) {
        Ok(document) => document,
        Err(error) => return Err(JsonError::from_text(&track.path(), &error)),
    };
    deserializer.end().map_err(|error| JsonError::from_text(&serde_path_to_error::Track::new().path(), &error))?;
    read::project(document)
}
