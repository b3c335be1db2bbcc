//! An `.SLC` file as sections in their order, each with its typed content.
//!
//! Reading keeps everything but white space: a line that fits nothing stays with its section and is
//! reported. Writing follows the layout RSLogix uses, so that a file it wrote comes back unchanged.
//! Instructions are not looked at here: a rung is its text.

mod comment;
mod data;
mod lines;
mod read;
mod write;

use ladder::{Diagnostic, Force};

pub use read::read;

/// A whole file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SlcFile {
    /// Sections in file order.
    pub sections: Vec<Section>,
    /// What the reader did not understand, by line; at most a thousand, the last of which then says
    /// how many more there are.
    pub diagnostics: Vec<Diagnostic>,
}

/// One section.
#[derive(Clone, Debug, PartialEq)]
pub enum Section {
    /// `START`: the processor.
    Start(Start),
    /// `SLOT` lines.
    Rack(Vec<Slot>),
    /// `PROJECT`: its name and those of its program files.
    Project(Names),
    /// `LADDER`: a program file.
    Ladder(Ladder),
    /// `DATA`: a data file, or one slot of file O or I.
    Data(Data),
    /// `FORCE`: the forces of one slot.
    Force(Forces),
    /// Lines that belong to no known section, as they stand.
    Other(String),
}

/// The processor.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Start {
    /// Catalogue number: `Bul.1766`.
    pub catalog: String,
    /// Description, which repeats the catalogue number: `Bul.1766     MicroLogix 1400 Series A`.
    pub description: String,
}

/// One slot.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Slot {
    /// Slot number; 0 is the controller itself on a MicroLogix.
    pub number: u16,
    /// Catalogue number of the module.
    pub catalog: String,
    /// Its description.
    pub description: String,
    /// Words of file I.
    pub scan_in: u16,
    /// Words of file O.
    pub scan_out: u16,
    /// Configuration words (`G_FILE`).
    pub configuration: Option<Vec<u16>>,
    /// The numbers after `IOCARD`, twelve in known files: kind of base unit, the six numbers of the
    /// controller's own I/O (input bits, words, first word; the same of outputs), five unknown ones.
    pub io_card: Option<Vec<i32>>,
}

/// Names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names {
    /// Processor name.
    pub project: String,
    /// Program file numbers with their names.
    pub program_files: Vec<(u16, String)>,
}

/// A program file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ladder {
    /// File number.
    pub number: u16,
    /// Its rungs without the one that ends the file.
    pub rungs: Vec<RungLines>,
    /// Lines before the first rung that fit nothing.
    pub extra: String,
}

/// A rung with what follows it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RungLines {
    /// Line of the file its text starts in, from 1; 0 if it was not read.
    pub line: u32,
    /// Text, `SOR` and `EOR` included; lines separated by LF if it spans several.
    pub text: String,
    /// Rung comment and page title.
    pub title: Option<TitleBlock>,
    /// Lines after it that fit nothing.
    pub extra: String,
}

/// A rung comment with its page title; lines separated by LF.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TitleBlock {
    /// Page title.
    pub title: String,
    /// Rung comment.
    pub description: String,
}

/// A data file, or one slot of file O or I.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Data {
    /// Type letters: `N`, `HSC`.
    pub letters: String,
    /// File number; none is written for O, I and S.
    pub number: Option<u16>,
    /// First element, 0; for O and I the slot.
    pub first: u16,
    /// 16-bit words per element; 0 if unknown because there is no element.
    pub words_per_element: u16,
    /// All words, element after element.
    pub words: Vec<u16>,
    /// Lines that fit nothing.
    pub extra: String,
}

/// The forces of one slot.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Forces {
    /// File O, not I.
    pub outputs: bool,
    /// Slot number.
    pub slot: u16,
    /// One pair of masks per word.
    pub words: Vec<Force>,
    /// Lines that fit nothing.
    pub extra: String,
}

impl SlcFile {
    /// The text of the file, lines ended by LF, laid out as RSLogix does.
    pub fn write(&self) -> String {
        write::write(self)
    }

    /// The processor line.
    pub fn start(&self) -> Option<&Start> {
        self.sections.iter().find_map(|section| match section {
            Section::Start(start) => Some(start),
            _ => None,
        })
    }

    /// All slots.
    pub fn slots(&self) -> impl Iterator<Item = &Slot> {
        self.sections.iter().flat_map(|section| match section {
            Section::Rack(slots) => slots.as_slice(),
            _ => &[],
        })
    }

    /// The names.
    pub fn names(&self) -> Option<&Names> {
        self.sections.iter().find_map(|section| match section {
            Section::Project(names) => Some(names),
            _ => None,
        })
    }

    /// Program files in file order.
    pub fn ladders(&self) -> impl Iterator<Item = &Ladder> {
        self.sections.iter().filter_map(|section| match section {
            Section::Ladder(ladder) => Some(ladder),
            _ => None,
        })
    }

    /// Data sections in file order.
    pub fn data(&self) -> impl Iterator<Item = &Data> {
        self.sections.iter().filter_map(|section| match section {
            Section::Data(data) => Some(data),
            _ => None,
        })
    }

    /// Force sections in file order.
    pub fn forces(&self) -> impl Iterator<Item = &Forces> {
        self.sections.iter().filter_map(|section| match section {
            Section::Force(forces) => Some(forces),
            _ => None,
        })
    }
}
