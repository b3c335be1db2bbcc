//! What can be wrong with a file, and where: one error type, and the deviation it locates.

use std::fmt;

/// How far reading follows real files away from the rules.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Read on wherever what follows is still certain, and report each deviation.
    #[default]
    Permissive,
    /// The first deviation is an error.
    Strict,
}

/// What the offset of a [`Deviation`] counts in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Space {
    /// Bytes of the payload after decompression, without the 16-byte envelope.
    Inflated,
    /// Bytes of the stream as the compound file stores it, envelope included.
    Stored,
    /// Bytes of the whole file.
    File,
}

impl fmt::Display for Space {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Space::Inflated => "inflated offset",
            Space::Stored => "stored offset",
            Space::File => "file offset",
        })
    }
}

/// One place where bytes are not what the format says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Deviation {
    /// Full path of the stream, e.g. `ONLINEIMAGE/PROGRAM FILES/ObjectData`; empty for the file itself.
    pub stream: String,
    /// What `offset` counts in.
    pub space: Space,
    /// Where, in bytes.
    pub offset: usize,
    /// The records being read, outermost first: `file 4 > rung 12 > instruction 3`; may be empty.
    pub record: String,
    /// What the format asks for there.
    pub expected: String,
    /// What stands there.
    pub found: String,
}

impl fmt::Display for Deviation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.stream.is_empty() {
            write!(f, "{}, ", self.stream.escape_debug())?;
        }
        write!(f, "{} {:#x}", self.space, self.offset)?;
        if !self.record.is_empty() {
            write!(f, ", in {}", self.record)?;
        }
        write!(f, ": expected {}, found {}", self.expected, self.found)
    }
}

/// What a file is that is no RSLogix 500 project, told from its content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Foreign {
    /// No byte at all.
    Empty,
    /// `%PDF-`.
    Pdf,
    /// A zip archive.
    Zip,
    /// A gzip, 7z, RAR or cabinet archive.
    OtherArchive,
    /// A compound file that holds no stream at all: a save cut short.
    CompoundWithoutStreams,
    /// A compound file with streams, but none that RSLogix 500 writes.
    CompoundOther,
    /// A compound file whose streams are those of an RSLogix 5 (PLC-5) project.
    Rsp,
    /// A Studio 5000 / RSLogix 5000 project database.
    Acd,
    /// A Studio 5000 / RSLogix 5000 export in XML.
    L5x,
    /// A Studio 5000 / RSLogix 5000 export as text.
    L5k,
    /// RSLogix 500's own text form of a project.
    SlcText,
    /// An XML document.
    Xml,
    /// Readable text of no known kind.
    Text,
    /// Only zero bytes.
    Zeros,
    /// None of these; its first bytes. The archives of the DOS-era editors
    /// (`.ACH`) land here: no mark is known by which to tell their content.
    Unknown {
        /// Up to eight bytes from the start, zeros if there are fewer.
        start: [u8; 8],
    },
}

impl fmt::Display for Foreign {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = match self {
            Foreign::Empty => "an empty file",
            Foreign::Pdf => "a PDF document",
            Foreign::Zip => "a zip archive",
            Foreign::OtherArchive => "a compressed archive",
            Foreign::CompoundWithoutStreams => {
                "a compound file without RSLogix streams (it holds no stream at all: a save cut short?)"
            }
            Foreign::CompoundOther => "a compound file without RSLogix streams",
            Foreign::Rsp => "an RSLogix 5 (PLC-5) project, not an RSLogix 500 one",
            Foreign::Acd => "a Logix 5000 project database (.ACD)",
            Foreign::L5x => "a Logix 5000 export in XML (.L5X)",
            Foreign::L5k => "a Logix 5000 export as text (.L5K)",
            Foreign::SlcText => "a project in SLC text form (.SLC), not a compound file",
            Foreign::Xml => "an XML document",
            Foreign::Text => "a text file",
            Foreign::Zeros => "a file of zero bytes only",
            Foreign::Unknown { start } => {
                let [a, b, c, d, ..] = start;
                return write!(
                    f,
                    "no compound file and of no kind known here (it starts with {a:02x} {b:02x} {c:02x} {d:02x}; \
                     an .ACH archive of the DOS editors would look like this too)"
                );
            }
        };
        f.write_str(text)
    }
}

/// Why a file, a stream or a record could not be read or written.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// The file is something else.
    Foreign(Foreign),
    /// The compound file itself is damaged or too large.
    Container(Box<Deviation>),
    /// A stream's envelope, archive or record is damaged.
    Record(Box<Deviation>),
    /// A value handed to the writer cannot be stored.
    Unwritable(String),
}

impl Error {
    /// Where the bytes deviate, if the error has a place.
    #[must_use]
    pub fn deviation(&self) -> Option<&Deviation> {
        match self {
            Error::Container(d) | Error::Record(d) => Some(d),
            Error::Foreign(_) | Error::Unwritable(_) => None,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Foreign(what) => write!(f, "this is {what}"),
            Error::Container(d) => write!(f, "damaged compound file: {d}"),
            Error::Record(d) => d.fmt(f),
            Error::Unwritable(why) => write!(f, "cannot be written: {why}"),
        }
    }
}

impl std::error::Error for Error {}

impl From<Deviation> for Error {
    fn from(d: Deviation) -> Self {
        Error::Record(Box::new(d))
    }
}

/// Result of everything in this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deviation_says_where_and_what() {
        let d = Deviation {
            stream: "PROGRAM FILES/ObjectData".into(),
            space: Space::Inflated,
            offset: 0x1a3c,
            record: "file 4 > rung 12".into(),
            expected: "a class tag".into(),
            found: "0x1234".into(),
        };
        assert_eq!(
            d.to_string(),
            "PROGRAM FILES/ObjectData, inflated offset 0x1a3c, in file 4 > rung 12: expected a class tag, found 0x1234"
        );
    }
}
