//! Saves of programs put together and in order: which belong to one machine, which came first, on what
//! evidence, and what changed from each to the next.
//!
//! A project file holds the time of its last save and of its creation, the name and program ID of its
//! processor; RSLogix renames the file it replaces to `.._BAKnnn`. [`machines`] joins saves by these and
//! by what their programs have in common, [`steps()`] compares each with the one before. Nothing here
//! opens a file or asks a clock: names and times are arguments.

mod group;
mod name;
mod order;
mod steps;

use ladder::Project;

use crate::diff::Profile;

pub use name::Name;
pub use steps::{Step, steps};

/// What is known of one save, without its program.
#[derive(Clone, Debug, Default)]
pub struct Save {
    /// File name, as given.
    pub file: String,
    /// SHA-256 of the file in hex; empty if not known.
    pub sha256: String,
    /// Time of the save, as the file holds it: RFC 3339, UTC.
    pub saved_at: Option<String>,
    /// Time of the project's creation, as the file holds it.
    pub created_at: Option<String>,
    /// Time of the last change of the file on disk: copies and downloads set it, so it is the last resort.
    pub modified: Option<String>,
    /// Name of the processor, empty if there is none.
    pub processor_name: String,
    /// Catalogue number of the processor, empty if not known.
    pub catalog: String,
    /// Program ID of the last verify; 0 and absent tell nothing.
    pub program_id: Option<u16>,
    /// The way to the processor, as the computer that saved was set up.
    pub route: String,
    /// The instructions.
    pub profile: Profile,
}

impl Save {
    /// What is known of a project that was read.
    pub fn of(file: &str, project: &Project, modified: Option<String>) -> Save {
        let processor = &project.main.processor;
        Save {
            file: file.to_owned(),
            sha256: project.source.sha256.clone(),
            saved_at: project.source.saved_at.clone(),
            created_at: project.source.created_at.clone(),
            modified,
            processor_name: processor.project_name.trim().to_owned(),
            catalog: processor.catalog.clone().unwrap_or_default(),
            program_id: processor.program_id.filter(|id| *id != 0),
            route: processor.route.clone(),
            profile: Profile::of(&project.main),
        }
    }

    /// The file name taken apart.
    pub fn name(&self) -> Name {
        Name::of(&self.file)
    }
}

/// Saves that belong together, in order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Machine {
    /// The name of its files without what saving adds, as the last save has it.
    pub name: String,
    /// The saves, first one first. Copies of one file are one entry.
    pub saves: Vec<Entry>,
    /// Why these saves were put together, in words.
    pub evidence: Vec<String>,
    /// What contradicts itself or is uncertain, in words.
    pub notes: Vec<String>,
    /// Machines whose programs go back to the same project, by their place in the list, with how much their
    /// nearest saves have in common, of 1000.
    pub related: Vec<(usize, u32)>,
}

/// One save of a machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Its index in the list given.
    pub save: usize,
    /// What its place rests on.
    pub order: Order,
    /// The time its place rests on; `None` where a number does.
    pub when: Option<String>,
    /// Further files with the same bytes, by their index.
    pub copies: Vec<usize>,
}

/// What the place of a save rests on, the surest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Order {
    /// The save time in the file.
    SaveTime,
    /// The number RSLogix put into the name of the file it replaced.
    BackupNumber,
    /// A date in the file's name.
    DateInName,
    /// The time of the file on disk.
    FileTime,
    /// Nothing is known; it stands by its name.
    NameOnly,
}

impl Order {
    /// In words.
    pub fn as_str(self) -> &'static str {
        match self {
            Order::SaveTime => "save time in the file",
            Order::BackupNumber => "backup number in the name",
            Order::DateInName => "date in the name",
            Order::FileTime => "time of the file on disk, which copying changes",
            Order::NameOnly => "name alone: nothing tells when it was saved",
        }
    }

    /// The word of JSON.
    pub fn key(self) -> &'static str {
        match self {
            Order::SaveTime => "save_time",
            Order::BackupNumber => "backup_number",
            Order::DateInName => "date_in_name",
            Order::FileTime => "file_time",
            Order::NameOnly => "name",
        }
    }
}

/// Puts saves together to machines, and the saves of each in order. Machines come by name.
pub fn machines(saves: &[Save]) -> Vec<Machine> {
    let mut all: Vec<Machine> = group::groups(saves)
        .into_iter()
        .map(|group| {
            let (entries, notes) = order::in_order(saves, &group.saves);
            let last = entries.last().and_then(|entry| saves.get(entry.save));
            Machine {
                name: last.map(|save| save.name().shown).unwrap_or_default(),
                saves: entries,
                evidence: group.evidence,
                notes,
                related: Vec::new(),
            }
        })
        .collect();
    let first_file = |machine: &Machine| machine.saves.first().and_then(|e| saves.get(e.save)).map(|s| s.file.clone());
    all.sort_by_cached_key(|machine| (machine.name.to_lowercase(), first_file(machine)));
    let related = group::related(saves, &all);
    for (machine, related) in all.iter_mut().zip(related) {
        machine.related = related;
    }
    all
}
