//! The rungs of both programs in one order: what changed, and how much stayed between.

use std::collections::{BTreeMap, BTreeSet};

use analysis::diff::{ChangeKind, Difference, LogicChange, Place, RungChange};

use super::side::{Part, Side};

/// A program file or code block with everything that happened in it.
#[derive(Clone, Debug)]
pub struct Chapter<'d> {
    /// On the old side; `None`: it is new.
    pub old: Option<Part>,
    /// On the new side; `None`: it is gone.
    pub new: Option<Part>,
    /// In the order of the program.
    pub rows: Vec<Row<'d>>,
}

/// Rungs that stand at one place of the comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Row<'d> {
    /// So many rungs without a change.
    Same {
        /// The first of them on the old side.
        old: Place,
        /// The first of them on the new side.
        new: Place,
        /// How many.
        count: usize,
    },
    /// A rung with a change, at its new place; one that is gone at its old place.
    Change(&'d RungChange),
    /// Here a rung stood that is elsewhere now.
    Left(&'d RungChange),
}

/// All program files and code blocks, those that are gone last.
pub fn chapters<'d>(sides: (&Side<'_>, &Side<'_>), difference: &'d Difference) -> Vec<Chapter<'d>> {
    let (mut was, mut inserted, mut deleted) = (BTreeMap::new(), BTreeSet::new(), BTreeSet::new());
    let mut gone: BTreeMap<Place, &RungChange> = BTreeMap::new();
    let mut came: BTreeMap<Place, &RungChange> = BTreeMap::new();
    let mut changed: BTreeMap<Place, &RungChange> = BTreeMap::new();
    // Rungs that differ tell which file became which, also where code blocks of one name stand elsewhere.
    for change in &difference.logic {
        match change {
            LogicChange::File(file) => {
                match (file.old, file.new) {
                    (Some(old), Some(new)) => drop(was.insert(new, old)),
                    (None, Some(new)) => drop(inserted.insert(new)),
                    (Some(old), None) => drop(deleted.insert(old)),
                    (None, None) => {}
                };
            }
            LogicChange::Rung(rung) => match (rung.old, rung.new) {
                (Some(_), Some(new)) if rung.kind != ChangeKind::Moved => drop(changed.insert(new, rung)),
                (old, new) => {
                    gone.extend(old.map(|at| (at, &**rung)));
                    came.extend(new.map(|at| (at, &**rung)));
                }
            },
        }
    }
    let (left, right) = (sides.0.parts(), sides.1.parts());
    let taken: BTreeSet<u16> = was.values().copied().collect();
    let by_number: BTreeMap<u16, &Part> = left.iter().rev().map(|part| (part.number, part)).collect();
    let old_names = sides.0.known_by();
    let same: BTreeMap<u16, u16> = sides
        .1
        .known_by()
        .into_iter()
        .filter_map(|(name, number)| Some((number, *old_names.get(&name)?)))
        .filter(|(_, old)| !deleted.contains(old) && !taken.contains(old))
        .collect();
    let partner = |part: &Part| -> Option<Part> {
        if inserted.contains(&part.number) {
            return None;
        }
        let old = was.get(&part.number).or_else(|| same.get(&part.number))?;
        by_number.get(old).map(|part| (*part).clone())
    };
    let mut all = Vec::new();
    for new in right {
        let old = partner(&new);
        let rows = match &old {
            Some(old) => merge(old, &new, &gone, &came, &changed),
            None => Vec::new(),
        };
        all.push(Chapter { old, new: Some(new), rows });
    }
    let gone_files = left.into_iter().filter(|part| deleted.contains(&part.number));
    all.extend(gone_files.map(|old| Chapter { old: Some(old), new: None, rows: Vec::new() }));
    all
}

/// Rungs without a change stand in one order on both sides.
fn merge<'d>(
    old: &Part,
    new: &Part,
    gone: &BTreeMap<Place, &'d RungChange>,
    came: &BTreeMap<Place, &'d RungChange>,
    changed: &BTreeMap<Place, &'d RungChange>,
) -> Vec<Row<'d>> {
    let (mut i, mut j, mut rows) = (0, 0, Vec::new());
    while i < old.rungs || j < new.rungs {
        let (a, b) = (Place { file: old.number, rung: i }, Place { file: new.number, rung: j });
        if let Some(change) = gone.get(&a).filter(|_| i < old.rungs) {
            rows.push(if change.new.is_some() { Row::Left(change) } else { Row::Change(change) });
            i += 1;
        } else if let Some(change) = came.get(&b).filter(|_| j < new.rungs) {
            rows.push(Row::Change(change));
            j += 1;
        } else if let Some(change) = changed.get(&b).filter(|_| j < new.rungs) {
            rows.push(Row::Change(change));
            (i, j) = (i + 1, j + 1);
        } else {
            if i >= old.rungs || j >= new.rungs {
                // The difference is not one of these programs.
                break;
            }
            match rows.last_mut() {
                Some(Row::Same { count, .. }) => *count += 1,
                _ => rows.push(Row::Same { old: a, new: b, count: 1 }),
            }
            (i, j) = (i + 1, j + 1);
        }
    }
    rows
}
