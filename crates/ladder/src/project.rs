//! A project and its images.

use crate::{Channel, DataFile, Diagnostic, Documentation, Family, FileType, IoConfiguration, Processor, Rung};

/// Everything one project file holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Project {
    /// Where it was read from.
    pub source: Source,
    /// The offline program: what an engineer opens.
    pub main: Image,
    /// The image last exchanged with a processor. Can be for another processor model.
    pub online: Option<Image>,
    /// An automatic save.
    pub autosave: Option<Image>,
    /// Revision notes, in stored order.
    pub revision_notes: Vec<RevisionNote>,
    /// Everything the reader found wrong or did not understand.
    pub diagnostics: Vec<Diagnostic>,
}

/// Where a project came from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Source {
    /// File name without its folder.
    pub file: String,
    /// SHA-256 of the file in lower-case hex; empty if not computed.
    pub sha256: String,
    /// Size of the file in bytes.
    pub bytes: u64,
    /// Version of RSLogix that saved it: `8.30.00`; empty if not stored.
    pub saved_by: String,
    /// Product that saved it: `RSLogix Micro Starter Lite`; empty if not stored.
    pub application: String,
    /// Time of the last save, RFC 3339 in UTC, if stored.
    pub saved_at: Option<String>,
    /// Time of creation, RFC 3339 in UTC, if stored.
    pub created_at: Option<String>,
}

/// One copy of the program with its data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Image {
    /// The processor.
    pub processor: Processor,
    /// Program files; the index is the file number.
    pub program_files: Vec<ProgramFile>,
    /// Data table files, ascending numbers; unused ones included.
    pub data_files: Vec<DataFile>,
    /// Function files of the controller (HSC, RTC, ...), in stored order.
    pub function_files: Vec<DataFile>,
    /// I/O configuration.
    pub io: IoConfiguration,
    /// Communication channels.
    pub channels: Vec<Channel>,
    /// Memory figures of the last verify; not those of the program while [`Image::is_edited`].
    pub memory: Option<Memory>,
    /// Symbols, descriptions, comments. The online image has none of its own.
    pub documentation: Documentation,
}

/// Memory figures of the last verify.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Instruction words used.
    pub instruction_words_used: u32,
    /// Instruction words left.
    pub instruction_words_left: u32,
    /// Data table words used; `None` where the processor shares one memory.
    pub data_words_used: Option<u32>,
    /// Data table words left.
    pub data_words_left: Option<u32>,
}

/// A note on a revision.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RevisionNote {
    /// Revision number.
    pub revision: u32,
    /// Text.
    pub note: String,
}

/// A program file.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramFile {
    /// File number; 2 is the main program.
    pub number: u16,
    /// Name, at most 10 characters, often empty.
    pub name: String,
    /// Description.
    pub description: String,
    /// System, ladder or unused.
    pub kind: ProgramFileKind,
    /// Rungs, the END rung included.
    pub rungs: Vec<Rung>,
}

/// What a program file number holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ProgramFileKind {
    /// Files 0 and 1: the processor's own.
    System,
    /// A ladder program.
    Ladder,
    /// A free number below the highest file in use; may keep the name of a deleted file.
    Unused,
}

impl ProgramFileKind {
    /// The word in file lists: `SYS`, `LADDER`, `UNUSED`.
    pub fn as_str(self) -> &'static str {
        match self {
            ProgramFileKind::System => "SYS",
            ProgramFileKind::Ladder => "LADDER",
            ProgramFileKind::Unused => "UNUSED",
        }
    }
}

impl Image {
    /// A rung waits to be verified. RSLogix prints `*` for the memory figures then.
    pub fn is_edited(&self) -> bool {
        self.program_files.iter().flat_map(|file| &file.rungs).any(|rung| rung.edited)
    }

    /// The processor family.
    pub fn family(&self) -> Family {
        self.processor.family
    }

    /// The program file with this number.
    pub fn program_file(&self, number: u16) -> Option<&ProgramFile> {
        self.program_files.iter().find(|file| file.number == number)
    }

    /// Program files that hold ladder.
    pub fn ladder_files(&self) -> impl Iterator<Item = &ProgramFile> {
        self.program_files.iter().filter(|file| file.kind == ProgramFileKind::Ladder)
    }

    /// The data file of this type and number, function files included. Numbers are unique among
    /// data table files, so a wrong type means `None`.
    pub fn data_file(&self, file_type: FileType, number: u16) -> Option<&DataFile> {
        let all = self.data_files.iter().chain(&self.function_files);
        all.into_iter().find(|file| file.file_type == file_type && file.number == number)
    }

    /// The value at a direct address, I/O resolved through the configuration.
    pub fn value_at(&self, address: &crate::Address) -> Option<crate::Value> {
        let file = self.data_file(address.file_type, address.file.number()?)?;
        if matches!(address.file_type, FileType::I | FileType::O) {
            let index = self.io.word_index(address)?;
            let flat = crate::Address { element: crate::Place::Number(index), word: None, ..address.clone() };
            return file.value_at(&flat);
        }
        file.value_at(address)
    }
}
