//! Which sections a report has.

/// The sections that can be chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// Processor, memory used, protection, source.
    Processor,
    /// Slots and modules; devices of a Do-more project.
    Io,
    /// Communication channels.
    Channels,
    /// Program files or code blocks.
    ProgramFiles,
    /// Data files or memory blocks.
    DataFiles,
    /// Every ladder file, drawn.
    Ladder,
    /// Every data table.
    Data,
    /// Addresses with symbols and descriptions.
    Symbols,
    /// Descriptions of an address under one instruction, and comments no rung shows.
    InstructionComments,
    /// Symbol groups.
    SymbolGroups,
    /// Who reads and writes what.
    CrossReference,
    /// Timers and counters with seconds.
    Timers,
    /// Which file calls which.
    Calls,
    /// Every I/O point with its use.
    IoMap,
    /// Addresses without symbol and description.
    Undocumented,
    /// Addresses that are written and never read.
    WrittenNeverRead,
    /// Addresses that are read and never written.
    ReadNeverWritten,
    /// How much is documented.
    Coverage,
    /// The online image against the offline program.
    Online,
    /// What could not be read or deviates.
    Diagnostics,
}

struct Entry {
    kind: Kind,
    name: &'static str,
    title: &'static str,
    help: &'static str,
}

const fn entry(kind: Kind, name: &'static str, title: &'static str, help: &'static str) -> Entry {
    Entry { kind, name, title, help }
}

/// In the order of the document: as on paper, then what paper lacks.
const KINDS: &[Entry] = &[
    entry(
        Kind::Processor,
        "processor",
        "Processor Information",
        "processor, memory used, protection, source and its SHA-256",
    ),
    entry(Kind::Io, "io", "I/O Configuration", "slots and modules"),
    entry(Kind::Channels, "channels", "Channel Configuration", "communication channels"),
    entry(Kind::ProgramFiles, "program-files", "Program File List", "program files, or code blocks"),
    entry(Kind::DataFiles, "data-files", "Data File List", "data files, or memory blocks"),
    entry(Kind::Ladder, "ladder", "Ladder", "every ladder file, drawn"),
    entry(Kind::Data, "data", "Data Tables", "every data table in its radix"),
    entry(Kind::Symbols, "symbols", "Address/Symbol Database", "addresses with symbol and description"),
    entry(
        Kind::InstructionComments,
        "instruction-comments",
        "Instruction Comment Database",
        "comments on instructions, and rung comments no rung shows",
    ),
    entry(Kind::SymbolGroups, "symbol-groups", "Symbol Group Database", "symbol groups"),
    entry(Kind::CrossReference, "xref", "Cross Reference", "who reads and writes each address"),
    entry(Kind::Timers, "timers", "Timers and Counters", "presets in seconds, who starts, reads and resets"),
    entry(Kind::Calls, "calls", "Call Tree", "which file calls which, labels and jumps"),
    entry(Kind::IoMap, "io-map", "I/O Map", "each point of each module with its symbol and rungs"),
    entry(Kind::Undocumented, "undocumented", "Used but Undocumented", "addresses without symbol and description"),
    entry(
        Kind::WrittenNeverRead,
        "written-never-read",
        "Written, Never Read",
        "addresses the program writes and nothing in it reads",
    ),
    entry(
        Kind::ReadNeverWritten,
        "read-never-written",
        "Read, Never Written",
        "addresses the program reads and nothing in it writes: often signals of an operator panel",
    ),
    entry(Kind::Coverage, "coverage", "Documentation Coverage", "how much is documented"),
    entry(Kind::Online, "online", "Online Image against Offline Program", "what differs in the online image"),
    entry(Kind::Diagnostics, "diagnostics", "Diagnostics", "what could not be read or deviates from the known form"),
];

impl Kind {
    /// Every kind in the order of the document.
    pub fn all() -> impl Iterator<Item = Kind> {
        KINDS.iter().map(|entry| entry.kind)
    }

    fn entry(self) -> Option<&'static Entry> {
        KINDS.iter().find(|entry| entry.kind == self)
    }

    /// The name by which it is chosen: `xref`.
    pub fn name(self) -> &'static str {
        self.entry().map_or("", |entry| entry.name)
    }

    /// The title of its section, or of all its sections together.
    pub fn title(self) -> &'static str {
        self.entry().map_or("", |entry| entry.title)
    }

    /// What it shows, in a few words.
    pub fn help(self) -> &'static str {
        self.entry().map_or("", |entry| entry.help)
    }

    /// The kind of a name, upper or lower case.
    pub fn by_name(name: &str) -> Option<Kind> {
        KINDS.iter().find(|entry| entry.name.eq_ignore_ascii_case(name.trim())).map(|entry| entry.kind)
    }
}

/// A choice of sections.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Selection {
    kinds: Vec<Kind>,
}

impl Default for Selection {
    /// All.
    fn default() -> Selection {
        Selection { kinds: Kind::all().collect() }
    }
}

impl Selection {
    /// Reads lists of names separated by commas: sections to have (empty: all) and sections to leave out.
    ///
    /// # Errors
    /// A name that is none, with those there are; nothing left.
    pub fn parse(only: &str, without: &str) -> Result<Selection, String> {
        let read = |list: &str| -> Result<Vec<Kind>, String> {
            let names = list.split(',').map(str::trim).filter(|name| !name.is_empty());
            names
                .map(|name| {
                    Kind::by_name(name).ok_or_else(|| {
                        let all: Vec<&str> = KINDS.iter().map(|entry| entry.name).collect();
                        format!("no section `{name}`; there are {}", all.join(", "))
                    })
                })
                .collect()
        };
        let (only, without) = (read(only)?, read(without)?);
        let kinds: Vec<Kind> = Kind::all()
            .filter(|kind| only.is_empty() || only.contains(kind))
            .filter(|k| !without.contains(k))
            .collect();
        if kinds.is_empty() { Err("no section is left".to_owned()) } else { Ok(Selection { kinds }) }
    }

    /// Was it chosen?
    pub fn has(&self, kind: Kind) -> bool {
        self.kinds.contains(&kind)
    }
}

/// How a document is made.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Which sections.
    pub sections: Selection,
    /// A date to show, as given. The document takes none from a clock.
    pub date: Option<String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_read_back() {
        for kind in Kind::all() {
            assert_eq!(Kind::by_name(kind.name()), Some(kind));
            assert!(!kind.title().is_empty() && !kind.help().is_empty());
        }
        let mut names: Vec<_> = Kind::all().map(Kind::name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), KINDS.len());
    }

    #[test]
    fn sections_are_chosen_and_left_out() {
        let chosen = Selection::parse("xref, timers,DATA", "timers").expect("names");
        assert_eq!(
            Kind::all().filter(|kind| chosen.has(*kind)).collect::<Vec<_>>(),
            [Kind::Data, Kind::CrossReference]
        );
        assert!(Selection::parse("", "").expect("all").has(Kind::Online));
        assert!(Selection::parse("cross", "").expect_err("no such name").contains("xref"));
        assert!(Selection::parse("data", "data").is_err());
    }
}
