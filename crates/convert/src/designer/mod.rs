//! Do-more projects as files: bytes of a Designer text to the model and back, JSON and CSV for other tools.

mod csv;
mod json;

use std::borrow::Cow;

use domore::program::Encoding;
use domore::text::{Error, is_domore, read, write};
use domore::{Diagnostic, Project};
use ladder::Source;

pub use csv::{write_symbols, write_xref};
pub use json::{SCHEMA, write_json};

/// A Do-more project read from a file.
#[derive(Clone, Debug, Default)]
pub struct Document {
    /// Where it was read from.
    pub source: Source,
    /// The project.
    pub project: Project,
    /// What deviates from the known form, unbalanced rungs among it.
    pub diagnostics: Vec<Diagnostic>,
}

/// Byte order mark that says UTF-8.
const MARK: &[u8] = b"\xEF\xBB\xBF";
/// Bytes at the beginning of a file that tell a text from anything else.
const HEAD: usize = 16 << 10;

/// Whether a file is a text for Do-more Designer, by its beginning.
pub fn is_designer(bytes: &[u8]) -> bool {
    let head = bytes.get(..HEAD).unwrap_or(bytes);
    !head.contains(&0) && is_domore(&rss::text::decode(head.strip_prefix(MARK).unwrap_or(head)))
}

/// Reads a Designer text; `source` is only recorded.
///
/// # Errors
/// If it is too large, or no text.
pub fn from_bytes(bytes: &[u8], source: Source) -> Result<Document, Error> {
    let (text, encoding) = decode(bytes);
    let mut reading = read(&text)?;
    reading.project.format.encoding = encoding;
    Ok(Document { source, project: reading.project, diagnostics: reading.diagnostics })
}

/// The bytes of a Designer text. A project that was read and not changed gives the bytes it was read
/// from, apart from line ends where those were of both kinds.
pub fn to_bytes(project: &Project) -> Vec<u8> {
    let text = write(project);
    match project.format.encoding {
        Encoding::Utf8WithMark => [MARK, text.as_bytes()].concat(),
        Encoding::Utf8 => text.into_bytes(),
        Encoding::Windows1252 => crate::slc::encode(&text),
    }
}

/// The text of a file and how it is stored: UTF-8 if it is that, else code page 1252.
fn decode(bytes: &[u8]) -> (Cow<'_, str>, Encoding) {
    let unmarked = bytes.strip_prefix(MARK);
    match (std::str::from_utf8(unmarked.unwrap_or(bytes)), unmarked) {
        (Ok(text), Some(_)) => (Cow::Borrowed(text), Encoding::Utf8WithMark),
        (Ok(text), None) if text.is_ascii() => (Cow::Borrowed(text), Encoding::Windows1252),
        (Ok(text), None) => (Cow::Borrowed(text), Encoding::Utf8),
        (Err(_), _) => (rss::text::decode(bytes), Encoding::Windows1252),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_come_back_in_their_encoding() {
        for bytes in [
            b"PLC DM-SIM\r\n".as_slice(),
            b"PLC DM-SIM\n// 20 \xB0C\n",
            "PLC DM-SIM\n// 20 °C Ж\n".as_bytes(),
            b"\xEF\xBB\xBFPLC DM-SIM\n// 20 \xC2\xB0C\n",
            b"\xEF\xBB\xBF// no utf-8: \xB0\nPLC DM-SIM\n",
            b"PLC DM-SIM",
        ] {
            assert!(is_designer(bytes), "{}", bytes.escape_ascii());
            let document = from_bytes(bytes, Source::default()).expect("readable");
            assert_eq!(to_bytes(&document.project), bytes, "{}", bytes.escape_ascii());
        }
        for bytes in [b"".as_slice(), b"START 1747\nLADDER 2\n", b"SOR XIC B3:0/0 OTE B3:0/1 EOR", b"{}", b"PLC\0"] {
            assert!(!is_designer(bytes), "{}", bytes.escape_ascii());
        }
    }
}
