//! Rungs of two programs, matched and compared.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::align::{Work, align, pair_similar};
use super::files::{self, Keyed};
use super::inside;
use super::keys::{Interner, RungKey};
use super::language::{BlockId, Half, Language};
use super::{ChangeKind, Difference, FileChange, LogicChange, Place, RungChange};
use foldhash::{HashMap, HashMapExt};

/// Words in common, of 1000, from which two rungs at one place are one rung that was changed.
const CHANGED: u32 = 400;

/// Words in common from which two rungs at different places are one that was moved and changed.
const MOVED_AND_CHANGED: u32 = 750;

/// What a pair of equal rungs counts beside similar ones: more than all similar ones of a file together.
const EQUAL: u32 = 1_000_000_000;

/// Pairs of rungs up to which choices are weighed by similarity.
const MOST_TIES: usize = 500_000;

/// Which parts of the old program are which of the new.
#[derive(Default)]
pub(super) struct Matched {
    /// Numbers of program files.
    pub(super) files: Vec<(u16, u16)>,
    /// Rungs, ascending in the new program.
    pub(super) rungs: Vec<(Place, Place)>,
}

/// A rung by the indexes of its file and its own.
type At = (usize, usize);

/// How two rungs were found to belong together.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Found {
    InPlace,
    Moved,
}

/// What matching gave.
#[derive(Default)]
struct Matching {
    pairs: Vec<(At, At, Found)>,
    deleted: Vec<At>,
    inserted: Vec<At>,
}

pub(super) fn compare<L: Language>(old: &L::Program, new: &L::Program, difference: &mut Difference) -> Matched {
    let mut interner = Interner::default();
    let nothing = L::Mapping::default();
    let raw = keyed::<L>(old, &mut interner, &nothing);
    let right = keyed::<L>(new, &mut interner, &nothing);
    let mut work = Work::new();
    let pairs = files::pair(&raw, &right, &mut work);

    let number = |files: &[Keyed<'_, L>], index: usize| files.get(index).map_or(0, |keyed| keyed.file.number);
    let numbers: Vec<(u16, u16)> = pairs.iter().map(|(i, j)| (number(&raw, *i), number(&right, *j))).collect();
    let ids = |(i, j): &(usize, usize)| Some((raw.get(*i)?.file.id, right.get(*j)?.file.id));
    let ids: Vec<(BlockId<'_>, BlockId<'_>)> = pairs.iter().filter_map(ids).collect();
    let mut mapping = L::renumbered(&ids);
    let mut left = if L::is_identity(&mapping) { None } else { Some(keyed::<L>(old, &mut interner, &mapping)) };
    let mut matching = matched(left.as_deref().unwrap_or(&raw), &right, &pairs, &mut work);

    // A first look at what differs finds the addresses that were replaced throughout; matching again
    // with them finds rungs that look different only because of them.
    let mut replaced = L::Replaced::default();
    let sides = (left.as_deref().unwrap_or(&raw), right.as_slice());
    for (a, b, _) in &matching.pairs {
        if let Some((a, b)) = halves(sides, (old, new), *a, *b)
            && a.key.id != b.key.id
        {
            inside::compare(a, b, &mapping, &mut work, Some(&mut replaced));
        }
    }
    difference.renames = L::renames(&replaced, old, new, &mut mapping);
    if !difference.renames.is_empty() {
        work.refill();
        let renamed = keyed::<L>(old, &mut interner, &mapping);
        matching = matched(&renamed, &right, &pairs, &mut work);
        left = Some(renamed);
    }

    let sides = (left.as_deref().unwrap_or(&raw), right.as_slice());
    let place = |files: &[Keyed<'_, L>], at: At| Place { file: number(files, at.0), rung: at.1 };
    let mut changes: Vec<(u16, usize, u8, RungChange)> = Vec::new();
    let (mut rungs, mut setups) = (Vec::new(), 0);
    for (i, j, found) in &matching.pairs {
        let (from, to) = (place(&raw, *i), place(&right, *j));
        rungs.push((from, to));
        let Some((a, b)) = halves(sides, (old, new), *i, *j) else { continue };
        setups += L::one_sided_setups(a, b);
        let changed = a.key.id != b.key.id || L::values_differ(a, b);
        let renamed = raw.get(i.0).and_then(|file| file.keys.get(i.1)).is_some_and(|key| key.id != b.key.id);
        if !changed && !renamed && *found == Found::InPlace {
            continue;
        }
        let inside = if changed || renamed {
            let shown = if changed { &mapping } else { &nothing };
            inside::compare(a, b, shown, &mut work, None)
        } else {
            inside::Inside { new_words: inside::words::<L>(b.rung), ..inside::Inside::default() }
        };
        let kind = if *found == Found::Moved { ChangeKind::Moved } else { ChangeKind::Changed };
        changes.push((
            to.file,
            to.rung,
            1,
            RungChange {
                kind,
                old: Some(from),
                new: Some(to),
                edits: inside.edits,
                old_words: inside.old_words,
                new_words: inside.new_words,
                only_rename: !changed && renamed && *found == Found::InPlace,
            },
        ));
    }
    let became: BTreeMap<u16, u16> = numbers.iter().copied().collect();
    for (kind, all, files) in
        [(ChangeKind::Deleted, &matching.deleted, &raw), (ChangeKind::Inserted, &matching.inserted, &right)]
    {
        for at in all {
            let Some(rung) = files.get(at.0).and_then(|keyed| keyed.file.rungs.get(at.1)) else { continue };
            changes.push(one_sided::<L>(kind, place(files, *at), rung, &became));
        }
    }
    changes.sort_by_key(|(file, rung, order, _)| (*file, *rung, *order));
    difference.logic = file_changes(&raw, &right, &pairs);
    difference.logic.extend(changes.into_iter().map(|change| LogicChange::Rung(Box::new(change.3))));
    if setups > 0 {
        difference.notes.push(format!(
            "set-ups of {setups} message instructions are on one side only, as rung text holds none: they were not compared"
        ));
    }
    if work.cut {
        difference.notes.push(
            "the programs are too large and too different to compare every rung with every other: some changed or \
             moved rungs are told as deleted and inserted"
                .to_owned(),
        );
    }
    rungs.sort_unstable_by_key(|pair| pair.1);
    Matched { files: numbers, rungs }
}

fn one_sided<L: Language>(
    kind: ChangeKind,
    at: Place,
    rung: &L::Rung,
    became: &BTreeMap<u16, u16>,
) -> (u16, usize, u8, RungChange) {
    let words = inside::words::<L>(rung);
    let deleted = kind == ChangeKind::Deleted;
    let file = if deleted { became.get(&at.file).copied().unwrap_or(at.file) } else { at.file };
    let (old_words, new_words) = if deleted { (words, Vec::new()) } else { (Vec::new(), words) };
    let change = RungChange {
        kind,
        old: deleted.then_some(at),
        new: (!deleted).then_some(at),
        edits: Vec::new(),
        old_words,
        new_words,
        only_rename: false,
    };
    (file, at.rung, u8::from(!deleted), change)
}

fn keyed<'a, L: Language>(program: &'a L::Program, interner: &mut Interner, mapping: &L::Mapping) -> Vec<Keyed<'a, L>> {
    let keys = |rungs: &[L::Rung], interner: &mut Interner| -> Vec<RungKey> {
        rungs.iter().map(|rung| interner.rung::<L>(program, rung, mapping)).collect()
    };
    let files = L::blocks(program).into_iter();
    files.map(|file| Keyed { keys: keys(file.rungs, interner), file }).collect()
}

fn halves<'a, L: Language>(
    sides: (&'a [Keyed<'a, L>], &'a [Keyed<'a, L>]),
    programs: (&'a L::Program, &'a L::Program),
    a: At,
    b: At,
) -> Option<(Half<'a, L>, Half<'a, L>)> {
    let half = |files: &'a [Keyed<'a, L>], program: &'a L::Program, at: At| {
        let keyed = files.get(at.0)?;
        Some(Half { program, rung: keyed.file.rungs.get(at.1)?, key: keyed.keys.get(at.1)? })
    };
    Some((half(sides.0, programs.0, a)?, half(sides.1, programs.1, b)?))
}

/// Program files that are new, gone, or have another number.
fn file_changes<L: Language>(old: &[Keyed<'_, L>], new: &[Keyed<'_, L>], pairs: &[(usize, usize)]) -> Vec<LogicChange> {
    let mut changes = Vec::new();
    let one = |kind, old: Option<&Keyed<'_, L>>, new: Option<&Keyed<'_, L>>| {
        LogicChange::File(FileChange {
            kind,
            old: old.map(|keyed| keyed.file.number),
            new: new.map(|keyed| keyed.file.number),
            rungs: new.or(old).map_or(0, |keyed| keyed.file.rungs.len()),
        })
    };
    for (i, j) in pairs {
        let (a, b) = (old.get(*i), new.get(*j));
        if a.map(|keyed| keyed.file.id) != b.map(|keyed| keyed.file.id) {
            changes.push(one(ChangeKind::Moved, a, b));
        }
    }
    let paired = |side: fn(&(usize, usize)) -> usize| pairs.iter().map(side).collect::<BTreeSet<_>>();
    let (left, right) = (paired(|pair| pair.0), paired(|pair| pair.1));
    changes.extend((0..old.len()).filter(|i| !left.contains(i)).map(|i| one(ChangeKind::Deleted, old.get(i), None)));
    changes.extend((0..new.len()).filter(|j| !right.contains(j)).map(|j| one(ChangeKind::Inserted, None, new.get(j))));
    changes
}

/// Rungs without a partner between two rungs that have one.
struct Gap {
    old: Vec<At>,
    new: Vec<At>,
}

fn matched<L: Language>(
    old: &[Keyed<'_, L>],
    new: &[Keyed<'_, L>],
    files: &[(usize, usize)],
    work: &mut Work,
) -> Matching {
    let mut matching = Matching::default();
    let mut gaps: Vec<(usize, Gap)> = Vec::new();
    for (number, (i, j)) in files.iter().enumerate() {
        let (Some(a), Some(b)) = (old.get(*i), new.get(*j)) else { continue };
        let (a, b) = (a.keys.as_slice(), b.keys.as_slice());
        let mut from = (0, 0);
        for (m, n) in equal_in_order(a, b, work).into_iter().chain([(a.len(), b.len())]) {
            if m < a.len() {
                matching.pairs.push(((*i, m), (*j, n), Found::InPlace));
            }
            if from.0 < m || from.1 < n {
                let gap =
                    Gap { old: (from.0..m).map(|m| (*i, m)).collect(), new: (from.1..n).map(|n| (*j, n)).collect() };
                gaps.push((number, gap));
            }
            from = (m + 1, n + 1);
        }
    }
    equal_elsewhere(old, new, &mut gaps, &mut matching);
    for (_, gap) in &mut gaps {
        similar_in_place(old, new, gap, &mut matching, work);
    }
    // What is left of a whole file: moved and changed.
    let mut rest: BTreeMap<usize, Gap> = BTreeMap::new();
    for (number, gap) in gaps {
        let file = rest.entry(number).or_insert_with(|| Gap { old: Vec::new(), new: Vec::new() });
        file.old.extend(gap.old);
        file.new.extend(gap.new);
    }
    for mut gap in rest.into_values() {
        similar_elsewhere(old, new, &mut gap, &mut matching, work);
        matching.deleted.extend(gap.old);
        matching.inserted.extend(gap.new);
    }
    matching
}

/// Equal rungs in order, as many as there can be; of several such choices the one that leaves changed rungs
/// beside what they became.
fn equal_in_order(a: &[RungKey], b: &[RungKey], work: &mut Work) -> Vec<(usize, usize)> {
    let ids = |keys: &[RungKey]| keys.iter().map(|key| key.id).collect::<Vec<u32>>();
    let (left, right) = (ids(a), ids(b));
    let start = left.iter().zip(&right).take_while(|(x, y)| x == y).count();
    let (rest, other) = (left.get(start..).unwrap_or_default(), right.get(start..).unwrap_or_default());
    let end = rest.iter().rev().zip(other.iter().rev()).take_while(|(x, y)| x == y).count();
    let (n, m) = (rest.len() - end, other.len() - end);
    let alone = |ids: &[u32], others: &[u32]| -> Vec<bool> {
        let others: BTreeSet<u32> = others.iter().copied().collect();
        ids.iter().map(|id| !others.contains(id)).collect()
    };
    let (alone_a, alone_b) = (alone(rest, other), alone(other, rest));
    let count = |alone: &[bool]| alone.iter().filter(|alone| **alone).count();
    let words = a.iter().chain(b).map(|key| key.bag.len()).sum::<usize>() / (a.len() + b.len()).max(1) + 1;
    let cost = count(&alone_a).saturating_mul(count(&alone_b)).saturating_mul(words);
    if n.saturating_mul(m) > MOST_TIES || cost > MOST_TIES * 4 || !work.take(cost) {
        return align(&left, &right, work);
    }
    let middle = pair_similar((n, m), 1, work, |i, j| {
        let (Some(x), Some(y)) = (a.get(start + i), b.get(start + j)) else { return 0 };
        if x.id == y.id {
            return EQUAL;
        }
        let both = alone_a.get(i) == Some(&true) && alone_b.get(j) == Some(&true);
        if both { Some(x.similarity(y, CHANGED)).filter(|alike| *alike >= CHANGED).unwrap_or(0) } else { 0 }
    });
    let middle = middle.into_iter().map(|(i, j)| (start + i, start + j));
    let equal = middle.filter(|(i, j)| left.get(*i) == right.get(*j));
    let tail = (0..end).map(|k| (start + n + k, start + m + k));
    (0..start).map(|k| (k, k)).chain(equal).chain(tail).collect()
}

fn key<'a, L: Language>(files: &'a [Keyed<'_, L>], at: At) -> Option<&'a RungKey> {
    files.get(at.0)?.keys.get(at.1)
}

/// Equal rungs at another place, in the same file first.
fn equal_elsewhere<L: Language>(
    old: &[Keyed<'_, L>],
    new: &[Keyed<'_, L>],
    gaps: &mut [(usize, Gap)],
    matching: &mut Matching,
) {
    let ends = |files: &[Keyed<'_, L>], at: At| {
        files.get(at.0).and_then(|keyed| keyed.file.rungs.get(at.1)).is_none_or(L::is_end)
    };
    for same_file in [true, false] {
        let group = |number: usize| if same_file { Some(number) } else { None };
        let mut free: HashMap<(Option<usize>, u32), VecDeque<At>> = HashMap::new();
        for (number, gap) in gaps.iter() {
            for at in gap.old.iter().filter(|at| !ends(old, **at)) {
                let Some(key) = key(old, *at) else { continue };
                free.entry((group(*number), key.id)).or_default().push_back(*at);
            }
        }
        let mut taken = BTreeSet::new();
        for (number, gap) in gaps.iter_mut() {
            let number = *number;
            gap.new.retain(|at| {
                let id = key(new, *at).map(|key| key.id);
                let from = id.and_then(|id| free.get_mut(&(group(number), id))).and_then(VecDeque::pop_front);
                let Some(from) = from.filter(|_| !ends(new, *at)) else { return true };
                taken.insert(from);
                matching.pairs.push((from, *at, Found::Moved));
                false
            });
        }
        for (_, gap) in gaps.iter_mut() {
            gap.old.retain(|at| !taken.contains(at));
        }
    }
}

/// Changed rungs that kept their place between their neighbours.
fn similar_in_place<L: Language>(
    old: &[Keyed<'_, L>],
    new: &[Keyed<'_, L>],
    gap: &mut Gap,
    matching: &mut Matching,
    work: &mut Work,
) {
    let cost = mean_words(old, &gap.old) + mean_words(new, &gap.new);
    let pairs = pair_similar((gap.old.len(), gap.new.len()), cost, work, |i, j| {
        let keys = (gap.old.get(i).and_then(|at| key(old, *at)), gap.new.get(j).and_then(|at| key(new, *at)));
        let (Some(a), Some(b)) = keys else { return 0 };
        Some(a.similarity(b, CHANGED)).filter(|alike| *alike >= CHANGED).unwrap_or(0)
    });
    take(gap, pairs, Found::InPlace, matching);
}

/// Changed rungs at another place of their file, the most similar first.
fn similar_elsewhere<L: Language>(
    old: &[Keyed<'_, L>],
    new: &[Keyed<'_, L>],
    gap: &mut Gap,
    matching: &mut Matching,
    work: &mut Work,
) {
    let cost = mean_words(old, &gap.old) + mean_words(new, &gap.new) + 1;
    let cells = gap.old.len().saturating_mul(gap.new.len());
    if cells == 0 || !work.take(cells.saturating_mul(cost)) {
        return;
    }
    let mut found = Vec::new();
    for (i, from) in gap.old.iter().enumerate() {
        for (j, to) in gap.new.iter().enumerate() {
            if let (Some(a), Some(b)) = (key(old, *from), key(new, *to)) {
                let alike = a.similarity(b, 0);
                if alike >= MOVED_AND_CHANGED {
                    found.push((std::cmp::Reverse(alike), i, j));
                }
            }
        }
    }
    found.sort_unstable();
    let (mut left, mut right) = (vec![false; gap.old.len()], vec![false; gap.new.len()]);
    let mut pairs = Vec::new();
    for (_, i, j) in found {
        if let (Some(a), Some(b)) = (left.get_mut(i), right.get_mut(j))
            && !*a
            && !*b
        {
            (*a, *b) = (true, true);
            pairs.push((i, j));
        }
    }
    take(gap, pairs, Found::Moved, matching);
}

/// Moves pairs from a gap to what is matched.
fn take(gap: &mut Gap, pairs: Vec<(usize, usize)>, found: Found, matching: &mut Matching) {
    let (mut left, mut right) = (vec![true; gap.old.len()], vec![true; gap.new.len()]);
    for (i, j) in pairs {
        if let (Some(a), Some(b)) = (gap.old.get(i), gap.new.get(j)) {
            matching.pairs.push((*a, *b, found));
            left.get_mut(i).into_iter().for_each(|free| *free = false);
            right.get_mut(j).into_iter().for_each(|free| *free = false);
        }
    }
    let (mut left, mut right) = (left.into_iter(), right.into_iter());
    gap.old.retain(|_| left.next().unwrap_or(true));
    gap.new.retain(|_| right.next().unwrap_or(true));
}

/// Words of these rungs on average: what one comparison costs.
fn mean_words<L: Language>(files: &[Keyed<'_, L>], rungs: &[At]) -> usize {
    let words: usize = rungs.iter().filter_map(|at| key(files, *at)).map(|key| key.bag.len()).sum();
    words.div_ceil(rungs.len().max(1))
}
