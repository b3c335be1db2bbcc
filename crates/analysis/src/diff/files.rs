//! Which program file became which: by number, and by content for files with another number.

use std::collections::{BTreeMap, BTreeSet};

use super::align::Work;
use super::keys::{RungKey, similarity};
use super::language::{Block, BlockId, Language};

/// Rungs in common, of 1000, from which a file that kept its number is the same file for sure.
const SURELY_SAME: u32 = 300;

/// Rungs in common from which a file with another number is the same.
const SAME_CONTENT: u32 = 500;

/// A program file with the keys of its rungs.
pub(super) struct Keyed<'a, L: Language> {
    pub(super) file: Block<'a, L::Rung>,
    pub(super) keys: Vec<RungKey>,
}

impl<L: Language> Keyed<'_, L> {
    /// Numbers of the rungs, sorted, without those that only end the file.
    fn content(&self) -> Vec<u32> {
        let rungs = self.keys.iter().zip(self.file.rungs).filter(|(_, rung)| !L::is_end(rung));
        let mut ids: Vec<u32> = rungs.map(|(key, _)| key.id).collect();
        ids.sort_unstable();
        ids
    }
}

/// Pairs of indexes, ascending in the new program.
pub(super) fn pair<L: Language>(old: &[Keyed<'_, L>], new: &[Keyed<'_, L>], work: &mut Work) -> Vec<(usize, usize)> {
    let content = |files: &[Keyed<'_, L>]| files.iter().map(Keyed::content).collect::<Vec<_>>();
    let (a, b) = (content(old), content(new));
    let empty = Vec::new();
    let alike = |i: usize, j: usize| similarity(a.get(i).unwrap_or(&empty), b.get(j).unwrap_or(&empty));
    let numbers: BTreeMap<_, usize> = identified(old).into_iter().enumerate().map(|(i, id)| (id, i)).collect();
    let by_number: Vec<(usize, usize)> =
        identified(new).into_iter().enumerate().filter_map(|(j, id)| Some((*numbers.get(&id)?, j))).collect();

    let mut pairs: Vec<(usize, usize)> =
        by_number.iter().copied().filter(|(i, j)| alike(*i, *j) >= SURELY_SAME).collect();
    let mut left: BTreeSet<usize> = (0..old.len()).collect();
    let mut right: BTreeSet<usize> = (0..new.len()).collect();
    for (i, j) in &pairs {
        left.remove(i);
        right.remove(j);
    }

    let size = |all: &[Vec<u32>], chosen: &BTreeSet<usize>| -> usize {
        chosen.iter().filter_map(|index| all.get(*index)).map(|ids| ids.len() + 1).sum()
    };
    let steps = size(&a, &left) * right.len() + size(&b, &right) * left.len();
    let mut found = Vec::new();
    if work.take(steps) {
        for i in &left {
            for j in &right {
                let filled = a.get(*i).is_some_and(|ids| !ids.is_empty());
                let shared = if filled { alike(*i, *j) } else { 0 };
                if shared >= SAME_CONTENT {
                    let same_name = old.get(*i).map(|file| file.file.name) == new.get(*j).map(|file| file.file.name);
                    found.push((shared, same_name, *i, *j));
                }
            }
        }
    }
    found.sort_by_key(|(shared, same_name, i, j)| (std::cmp::Reverse((*shared, *same_name)), *i, *j));
    let rest = found.into_iter().map(|(_, _, i, j)| (i, j)).chain(by_number);
    for (i, j) in rest {
        if left.contains(&i) && right.contains(&j) {
            left.remove(&i);
            right.remove(&j);
            pairs.push((i, j));
        }
    }
    pairs.sort_unstable_by_key(|pair| pair.1);
    pairs
}

/// Each file by what it is known by; of several with one name or number each by its place among them.
fn identified<'a, L: Language>(files: &'a [Keyed<'_, L>]) -> Vec<(BlockId<'a>, usize)> {
    let mut seen: BTreeMap<BlockId<'_>, usize> = BTreeMap::new();
    let mut number = |id| {
        let count = seen.entry(id).or_default();
        *count += 1;
        (id, *count)
    };
    files.iter().map(|file| number(file.file.id)).collect()
}
