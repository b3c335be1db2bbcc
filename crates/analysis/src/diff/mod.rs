//! What differs between two programs: logic, documentation, values and configuration apart.
//!
//! Rungs are matched before they are compared, so that a rung keeps its partner when others are
//! inserted, deleted or moved around it: equal rungs first, in order (`align`), then equal rungs that
//! changed their place, then similar ones. Two rungs are equal when `keys` gives them one number; it
//! interns whole texts, so that different rungs never share one. Values that RSLogix only displays in a
//! rung are not part of it.
//!
//! Work is bounded by `align::Work`: beyond it the result is still true, but a rung may be told as
//! deleted and inserted where a person would say changed; [`Difference::notes`] then says so.

mod align;
mod configuration;
mod do_more;
mod documentation;
mod equal;
mod files;
mod inside;
mod keys;
mod language;
mod logic;
mod profile;
mod renames;
mod rslogix;
mod values;

use std::fmt;

use ladder::{Documentation, Image};

pub use align::longest_common;
pub use do_more::compare_domore;
pub(crate) use equal::{Equality, matched};
pub use inside::{Edit, EditKind, Word};
pub use profile::Profile;

/// One of the two programs.
#[derive(Clone, Copy, Debug)]
pub struct Side<'a> {
    /// The program with its data.
    pub image: &'a Image,
    /// Its documentation; `None` leaves documentation out of the comparison, comments of rungs included.
    pub documentation: Option<&'a Documentation>,
}

/// Everything that differs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Difference {
    /// Program files, then rungs in the order of the new program.
    pub logic: Vec<LogicChange>,
    /// Addresses that another one replaced throughout.
    pub renames: Vec<Rename>,
    /// Symbols, descriptions, comments, page titles.
    pub documentation: Vec<Change>,
    /// A side came without documentation: nothing is known of differences in it.
    pub documentation_left_out: bool,
    /// Contents of data files, and forces.
    pub values: Vec<ValueChange>,
    /// The files hold no data: nothing is known of differences in it.
    pub values_left_out: bool,
    /// Processor, I/O, channels, shape of data files, names of program files.
    pub configuration: Vec<Change>,
    /// Where the comparison was cut short, and what was left out of it.
    pub notes: Vec<String>,
}

impl Difference {
    /// The two are equal in everything that was compared.
    pub fn is_empty(&self) -> bool {
        self.logic.is_empty()
            && self.documentation.is_empty()
            && self.values.is_empty()
            && self.configuration.is_empty()
    }
}

/// What happened to a rung or to a program file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ChangeKind {
    /// On both sides, with a difference.
    Changed,
    /// Only in the new program.
    Inserted,
    /// Only in the old program.
    Deleted,
    /// On both sides, at another place. A rung may be changed too, see [`RungChange::edits`].
    Moved,
}

impl ChangeKind {
    /// The lower-case word of outputs.
    pub fn as_str(self) -> &'static str {
        match self {
            ChangeKind::Changed => "changed",
            ChangeKind::Inserted => "inserted",
            ChangeKind::Deleted => "deleted",
            ChangeKind::Moved => "moved",
        }
    }
}

impl fmt::Display for ChangeKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// A rung of a program file or code block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Place {
    /// Program file number; of Do-more the place of the code block in the text, from 1.
    pub file: u16,
    /// Rung number, from 0.
    pub rung: usize,
}

/// A difference of the logic.
#[derive(Clone, Debug, PartialEq)]
pub enum LogicChange {
    /// A whole program file.
    File(FileChange),
    /// One rung.
    Rung(Box<RungChange>),
}

/// A program file that is new, gone, or has another number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileChange {
    /// Inserted, deleted, or moved: the file has another number.
    pub kind: ChangeKind,
    /// Its number in the old program.
    pub old: Option<u16>,
    /// Its number in the new program.
    pub new: Option<u16>,
    /// Its rungs, the END rung included.
    pub rungs: usize,
}

/// A rung that differs.
#[derive(Clone, Debug, PartialEq)]
pub struct RungChange {
    /// What happened.
    pub kind: ChangeKind,
    /// Where it stood.
    pub old: Option<Place>,
    /// Where it stands.
    pub new: Option<Place>,
    /// What is different inside, in the order of the rung; empty for rungs that are on one side only.
    pub edits: Vec<Edit>,
    /// The old rung as words; those that differ are marked. Empty if there is none.
    pub old_words: Vec<Word>,
    /// The new rung as words; those that differ are marked. Empty if there is none.
    pub new_words: Vec<Word>,
    /// Nothing but addresses of [`Difference::renames`] and numbers of renumbered program files.
    pub only_rename: bool,
}

/// An address that another one replaced wherever the program used it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rename {
    /// In the old program, which the new one no longer uses.
    pub old: String,
    /// In the new program, which the old one did not use.
    pub new: String,
    /// Operands in which it was seen.
    pub operands: usize,
}

/// A difference of a named thing, in words. `None`: not there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// What kind of thing: `symbol`, `rung comment`, `channel`, ...
    pub what: &'static str,
    /// Which one: `B3:0/1`, `2:4`, `channel 0, Node Address`.
    pub name: String,
    /// In the old program.
    pub old: Option<String>,
    /// In the new program.
    pub new: Option<String>,
}

impl Change {
    /// Inserted, deleted or changed.
    pub fn kind(&self) -> ChangeKind {
        match (&self.old, &self.new) {
            (None, _) => ChangeKind::Inserted,
            (_, None) => ChangeKind::Deleted,
            _ => ChangeKind::Changed,
        }
    }
}

/// Neighbouring elements of a data file, or one member of an element, with other values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ValueChange {
    /// The data file: `N7`.
    pub file: String,
    /// First address.
    pub first: String,
    /// Last address; the first one if it is one place only.
    pub last: String,
    /// Values of the old program, one per address.
    pub old: Vec<String>,
    /// Values of the new program, as many.
    pub new: Vec<String>,
}

/// A rung of RSLogix 500 as words: mnemonics, operands and branch marks in order, none of them marked.
pub fn words(rung: &ladder::Rung) -> Vec<Word> {
    inside::words::<rslogix::Rslogix>(rung)
}

/// Compares two programs.
///
/// ```
/// use analysis::diff::{Side, compare};
///
/// let image = ladder::Image::default();
/// let side = Side { image: &image, documentation: Some(&image.documentation) };
/// assert!(compare(side, side).is_empty());
/// ```
pub fn compare(old: Side<'_>, new: Side<'_>) -> Difference {
    let mut difference = Difference::default();
    let matched = logic::compare::<rslogix::Rslogix>(old.image, new.image, &mut difference);
    match (old.documentation, new.documentation) {
        (Some(a), Some(b)) => {
            difference.documentation = documentation::compare((old.image, a), (new.image, b), &matched);
        }
        _ => {
            difference.documentation_left_out = true;
            difference.notes.push("documentation was not compared: an image has none of its own".to_owned());
        }
    }
    difference.values = values::compare(old.image, new.image);
    difference.configuration = configuration::compare(old.image, new.image, &matched);
    difference
}

/// Rungs of two versions of a program that are the same rung, changed or not: the old and the new place.
pub fn rung_pairs(old: &Image, new: &Image) -> Vec<(Place, Place)> {
    logic::compare::<rslogix::Rslogix>(old, new, &mut Difference::default()).rungs
}
