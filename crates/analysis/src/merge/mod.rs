//! Two programs that were made of one, put together again: three-way merge.
//!
//! Rungs are merged by what they are, not by lines of text: each side's rungs are matched with those of
//! the base as [`crate::diff`] does it, and what one side changed, inserted or deleted is taken over where
//! the other side left it alone. Where both sides touched the same, nothing is chosen: that is a conflict.
//! Two rungs inserted at one place are a conflict too, as their order is the order of the scan.
//!
//! Documentation is merged entry by entry, data tables element by element. Values that the running
//! machine leaves behind are no conflict: ours stay, and a note counts them.

mod data;
mod documentation;
mod program;

use ladder::{Comment, Image};

use crate::diff::{Place, matched};

/// Which of the two programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// The program that is merged into.
    Ours,
    /// The program that is merged.
    Theirs,
}

/// What merging gave.
#[derive(Clone, Debug)]
pub struct Merge {
    /// The merged program. Where [`Merge::is_clean`] is false, ours stands where a conflict is.
    pub image: Image,
    /// The ladder files rung by rung.
    pub files: Vec<MergedFile>,
    /// Conflicts outside of rungs.
    pub conflicts: Vec<Conflict>,
    /// What was decided without anybody having said so.
    pub notes: Vec<String>,
    /// From which side processor, I/O and channels are.
    pub parts: Parts,
}

impl Merge {
    /// Nothing has to be decided by a person.
    pub fn is_clean(&self) -> bool {
        self.count() == 0
    }

    /// Conflicts.
    pub fn count(&self) -> usize {
        let rungs = self.files.iter().flat_map(|file| &file.pieces);
        self.conflicts.len() + rungs.filter(|piece| matches!(piece, Piece::Conflict(_))).count()
    }
}

/// From which side the parts are that are taken whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    /// Processor.
    pub processor: Side,
    /// I/O configuration.
    pub io: Side,
    /// Communication channels.
    pub channels: Side,
}

/// A ladder file.
#[derive(Clone, Debug, PartialEq)]
pub struct MergedFile {
    /// Its number.
    pub number: u16,
    /// The side that has it, ours if both have.
    pub side: Side,
    /// Rungs and conflicts in order.
    pub pieces: Vec<Piece>,
}

/// A part of a ladder file.
#[derive(Clone, Debug, PartialEq)]
pub enum Piece {
    /// A rung.
    Rung(MergedRung),
    /// Both sides touched the same rungs.
    Conflict(RungConflict),
}

/// A rung of the result.
#[derive(Clone, Debug, PartialEq)]
pub struct MergedRung {
    /// The side its logic is from.
    pub side: Side,
    /// Its place there.
    pub at: Place,
    /// Its comment, which can be from the other side.
    pub comment: Option<Comment>,
}

/// Rungs that both sides touched.
#[derive(Clone, Debug, PartialEq)]
pub struct RungConflict {
    /// Why, in words.
    pub why: &'static str,
    /// In the base.
    pub base: Vec<Place>,
    /// In ours.
    pub ours: Vec<Place>,
    /// In theirs.
    pub theirs: Vec<Place>,
}

/// Something else that both sides changed. `None`: not there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Conflict {
    /// What: `symbol of B3:0/1`, `T4:0.PRE`, `I/O configuration`.
    pub what: String,
    /// In the base.
    pub base: Option<String>,
    /// In ours.
    pub ours: Option<String>,
    /// In theirs.
    pub theirs: Option<String>,
}

/// The three programs.
#[derive(Clone, Copy)]
struct Three<'a> {
    base: &'a Image,
    ours: &'a Image,
    theirs: &'a Image,
}

/// Merges two programs that were made of `base`.
pub fn merge(base: &Image, ours: &Image, theirs: &Image) -> Merge {
    let three = Three { base, ours, theirs };
    let (mut conflicts, mut notes) = (Vec::new(), Vec::new());
    let mut image = ours.clone();
    let parts = parts(three, &mut conflicts);
    if parts.processor == Side::Theirs {
        image.processor = theirs.processor.clone();
    }
    if parts.io == Side::Theirs {
        image.io = theirs.io.clone();
    }
    if parts.channels == Side::Theirs {
        image.channels = theirs.channels.clone();
    }
    let named = [("processor", parts.processor), ("I/O configuration", parts.io), ("channels", parts.channels)];
    let taken = named.iter().filter(|(_, side)| *side == Side::Theirs);
    notes.extend(taken.map(|(name, _)| format!("the {name} is taken from theirs")));
    let left = matched(base, ours);
    let right = matched(base, theirs);
    for (found, side) in [(&left.0, "ours"), (&right.0, "theirs")] {
        notes.extend(found.notes.iter().map(|note| format!("{side}: {note}")));
    }
    let files = program::merge(three, (&left, &right), &mut image, &mut conflicts);
    image.documentation = documentation::merge(three, &mut conflicts);
    data::merge(three, &mut image, &mut conflicts, &mut notes);
    Merge { image, files, conflicts, notes, parts }
}

/// Who changed something: `None` if both did, each in another way.
fn decide<T: PartialEq + ?Sized>(base: &T, ours: &T, theirs: &T) -> Option<Side> {
    if ours == theirs || theirs == base {
        Some(Side::Ours)
    } else if ours == base {
        Some(Side::Theirs)
    } else {
        None
    }
}

/// Decides a text; both changed is a conflict, and ours stands.
fn text(what: impl FnOnce() -> String, all: [Option<&str>; 3], conflicts: &mut Vec<Conflict>) -> Option<String> {
    let [base, ours, theirs] = all;
    let owned = |text: Option<&str>| text.map(str::to_owned);
    match decide(&base, &ours, &theirs) {
        Some(Side::Ours) => owned(ours),
        Some(Side::Theirs) => owned(theirs),
        None => {
            conflicts.push(Conflict { what: what(), base: owned(base), ours: owned(ours), theirs: owned(theirs) });
            owned(ours)
        }
    }
}

/// Processor, I/O and channels as wholes.
fn parts(three: Three<'_>, conflicts: &mut Vec<Conflict>) -> Parts {
    let Three { base, ours, theirs } = three;
    // What the computer and the last download left there is no setting.
    let processor = |image: &Image| {
        let p = &image.processor;
        let names = (p.project_name.clone(), p.main_program.clone());
        (p.model, p.catalog.clone(), p.name.clone(), names, p.deny_future_access, p.password_fields_used)
    };
    let mut whole = |what: &str, found: Option<Side>| {
        found.unwrap_or_else(|| {
            let one = |side: &str| Some(format!("the {what} of {side}"));
            conflicts.push(Conflict {
                what: what.to_owned(),
                base: one("the base"),
                ours: one("ours"),
                theirs: one("theirs"),
            });
            Side::Ours
        })
    };
    Parts {
        processor: whole("processor", decide(&processor(base), &processor(ours), &processor(theirs))),
        io: whole("I/O configuration", decide(&base.io, &ours.io, &theirs.io)),
        channels: whole("channel configuration", decide(&base.channels, &ours.channels, &theirs.channels)),
    }
}
