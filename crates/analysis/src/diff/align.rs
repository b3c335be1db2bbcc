//! Sequences side by side: equal items first, then similar ones, with bounded work.

use std::collections::HashMap;

/// Steps of one comparison of two programs. The largest known program needs 2 % of it against a changed
/// copy of itself; all of it takes about a tenth of a second.
const MOST_STEPS: usize = 40_000_000;

/// Cells of one table.
const MOST_CELLS: usize = 4_000_000;

/// Halving a range by its unique items more often than this finds little.
const MOST_DEPTH: usize = 24;

/// Items looked ahead when tables are out of reach.
const WINDOW: usize = 32;

/// How much work is left.
pub(super) struct Work {
    steps: usize,
    /// Something was compared less well than it could be.
    pub(super) cut: bool,
}

impl Work {
    pub(super) fn new() -> Work {
        Work { steps: MOST_STEPS, cut: false }
    }

    /// Begins anew, for a second run over the same programs.
    pub(super) fn refill(&mut self) {
        *self = Work::new();
    }

    /// Takes steps if there are as many, otherwise marks the work as cut.
    pub(super) fn take(&mut self, steps: usize) -> bool {
        let Some(left) = self.steps.checked_sub(steps) else {
            self.cut = true;
            return false;
        };
        self.steps = left;
        true
    }
}

/// A part of both sequences: `a.0..a.1` beside `b.0..b.1`.
#[derive(Clone, Copy)]
struct Part {
    a: (usize, usize),
    b: (usize, usize),
    depth: usize,
}

/// Pairs of equal items, ascending on both sides: a longest common subsequence while tables are
/// affordable, found between the items that are unique on both sides otherwise.
pub(super) fn align(a: &[u32], b: &[u32], work: &mut Work) -> Vec<(usize, usize)> {
    let mut pairs = Vec::new();
    let mut parts = vec![Part { a: (0, a.len()), b: (0, b.len()), depth: 0 }];
    while let Some(part) = parts.pop() {
        let (mut start, mut end) = ((part.a.0, part.b.0), (part.a.1, part.b.1));
        while start.0 < end.0 && start.1 < end.1 && a.get(start.0) == b.get(start.1) {
            pairs.push(start);
            start = (start.0 + 1, start.1 + 1);
        }
        while start.0 < end.0 && start.1 < end.1 && a.get(end.0 - 1) == b.get(end.1 - 1) {
            end = (end.0 - 1, end.1 - 1);
            pairs.push(end);
        }
        let (Some(left), Some(right)) = (a.get(start.0..end.0), b.get(start.1..end.1)) else { continue };
        if left.is_empty() || right.is_empty() {
            continue;
        }
        let shift = |(i, j): (usize, usize)| (start.0 + i, start.1 + j);
        let cells = left.len().saturating_mul(right.len());
        if cells <= MOST_CELLS && work.take(cells) {
            pairs.extend(longest_common(left, right).into_iter().map(shift));
            continue;
        }
        let anchors = if part.depth < MOST_DEPTH { unique_anchors(left, right) } else { Vec::new() };
        if anchors.is_empty() {
            work.cut = true;
            pairs.extend(near(left, right).into_iter().map(shift));
            continue;
        }
        let mut from = start;
        for anchor in anchors.into_iter().map(shift) {
            pairs.push(anchor);
            parts.push(Part { a: (from.0, anchor.0), b: (from.1, anchor.1), depth: part.depth + 1 });
            from = (anchor.0 + 1, anchor.1 + 1);
        }
        parts.push(Part { a: (from.0, end.0), b: (from.1, end.1), depth: part.depth + 1 });
    }
    pairs.sort_unstable();
    pairs
}

/// A longest common subsequence by its table, which has a cell for every item of one side with every one of the
/// other: callers look at the lengths first. Pairs of places, ascending on both sides.
pub fn longest_common<T: PartialEq>(a: &[T], b: &[T]) -> Vec<(usize, usize)> {
    let width = b.len() + 1;
    let mut table = vec![0_u32; (a.len() + 1) * width];
    let at = |table: &[u32], i: usize, j: usize| table.get(i * width + j).copied().unwrap_or(0);
    for (i, x) in a.iter().enumerate().rev() {
        for (j, y) in b.iter().enumerate().rev() {
            let best =
                if x == y { at(&table, i + 1, j + 1) + 1 } else { at(&table, i + 1, j).max(at(&table, i, j + 1)) };
            if let Some(cell) = table.get_mut(i * width + j) {
                *cell = best;
            }
        }
    }
    let (mut i, mut j, mut pairs) = (0, 0, Vec::new());
    while let (Some(x), Some(y)) = (a.get(i), b.get(j)) {
        if x == y {
            pairs.push((i, j));
            (i, j) = (i + 1, j + 1);
        } else if at(&table, i + 1, j) >= at(&table, i, j + 1) {
            i += 1;
        } else {
            j += 1;
        }
    }
    pairs
}

/// Items that occur once on each side, the longest ascending run of them.
fn unique_anchors(a: &[u32], b: &[u32]) -> Vec<(usize, usize)> {
    let once = |items: &[u32]| {
        let mut places: HashMap<u32, Option<usize>> = HashMap::new();
        for (index, item) in items.iter().enumerate() {
            places.entry(*item).and_modify(|place| *place = None).or_insert(Some(index));
        }
        places
    };
    let right = once(b);
    let mut both: Vec<(usize, usize)> =
        once(a).into_iter().filter_map(|(item, place)| Some((place?, (*right.get(&item)?)?))).collect();
    both.sort_unstable();
    ascending(&both)
}

/// The longest run of pairs, given by ascending first numbers, whose second numbers ascend too.
fn ascending(pairs: &[(usize, usize)]) -> Vec<(usize, usize)> {
    // The pair that ends the best run of each length, and the pair before each pair in its run.
    let mut ends: Vec<usize> = Vec::new();
    let mut before: Vec<Option<usize>> = Vec::with_capacity(pairs.len());
    for (index, pair) in pairs.iter().enumerate() {
        let length = ends.partition_point(|end| pairs.get(*end).is_some_and(|other| other.1 < pair.1));
        before.push(length.checked_sub(1).and_then(|last| ends.get(last).copied()));
        match ends.get_mut(length) {
            Some(end) => *end = index,
            None => ends.push(index),
        }
    }
    let mut run = Vec::with_capacity(ends.len());
    let mut next = ends.last().copied();
    while let Some(index) = next {
        run.extend(pairs.get(index));
        next = before.get(index).copied().flatten();
    }
    run.reverse();
    run
}

/// Each item with the next equal one not far ahead.
fn near(a: &[u32], b: &[u32]) -> Vec<(usize, usize)> {
    let (mut from, mut pairs) = (0, Vec::new());
    for (i, item) in a.iter().enumerate() {
        let found = b.iter().enumerate().skip(from).take(WINDOW).find(|(_, other)| *other == item);
        if let Some((j, _)) = found {
            pairs.push((i, j));
            from = j + 1;
        }
    }
    pairs
}

/// Pairs of similar items in ascending order on both sides, with the largest sum of similarities.
/// `similarity` gives 0 for items that must not be paired, `cost` its steps.
pub(super) fn pair_similar(
    count: (usize, usize),
    cost: usize,
    work: &mut Work,
    similarity: impl Fn(usize, usize) -> u32,
) -> Vec<(usize, usize)> {
    let (n, m) = count;
    let cells = n.saturating_mul(m);
    if cells == 0 {
        return Vec::new();
    }
    if cells > MOST_CELLS || !work.take(cells.saturating_mul(cost.max(1))) {
        work.cut = true;
        let each = work.take(n.min(m).saturating_mul(cost.max(1)));
        return (0..n.min(m)).filter(|i| each && similarity(*i, *i) > 0).map(|i| (i, i)).collect();
    }
    let width = m + 1;
    let mut alike = vec![0_u32; n * width];
    let mut best = vec![0_u64; (n + 1) * width];
    let at = |best: &[u64], i: usize, j: usize| best.get(i * width + j).copied().unwrap_or(0);
    for i in (0..n).rev() {
        for j in (0..m).rev() {
            let found = similarity(i, j);
            let paired = if found > 0 { at(&best, i + 1, j + 1) + u64::from(found) } else { 0 };
            let most = paired.max(at(&best, i + 1, j)).max(at(&best, i, j + 1));
            if let (Some(cell), Some(kept)) = (best.get_mut(i * width + j), alike.get_mut(i * width + j)) {
                (*cell, *kept) = (most, found);
            }
        }
    }
    let (mut i, mut j, mut pairs) = (0, 0, Vec::new());
    while i < n && j < m {
        let found = alike.get(i * width + j).copied().unwrap_or(0);
        let here = at(&best, i, j);
        if found > 0 && here == at(&best, i + 1, j + 1) + u64::from(found) {
            pairs.push((i, j));
            (i, j) = (i + 1, j + 1);
        } else if here == at(&best, i + 1, j) {
            i += 1;
        } else {
            j += 1;
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_items_keep_their_order() {
        let pairs = |a: &[u32], b: &[u32]| align(a, b, &mut Work::new());
        assert_eq!(pairs(&[1, 2, 3], &[1, 3]), [(0, 0), (2, 1)]);
        assert_eq!(pairs(&[9, 1, 2, 3], &[1, 2, 3, 9]), [(1, 0), (2, 1), (3, 2)]);
        assert_eq!(pairs(&[1, 1, 2], &[1, 2, 2]), [(0, 0), (2, 2)]);
        assert_eq!(pairs(&[], &[1]), []);
    }

    #[test]
    fn unique_items_split_what_no_table_holds() {
        // A block of 3,000 items moved behind 3,000 others: a table of 36 million cells.
        let a: Vec<u32> = (0..6000).collect();
        let b: Vec<u32> = (3000..6000).chain(0..3000).collect();
        let mut work = Work::new();
        assert_eq!(align(&a, &b, &mut work).len(), 3000);
        assert!(!work.cut);
    }

    #[test]
    fn sequences_made_to_be_slow_are_cut() {
        let a: Vec<u32> = (0..400_000).map(|i| i % 7).collect();
        let b: Vec<u32> = (0..400_000).map(|i| i % 5).collect();
        let mut work = Work::new();
        let pairs = align(&a, &b, &mut work);
        assert!(work.cut && pairs.is_sorted() && pairs.iter().all(|(i, j)| a[*i] == b[*j]));
    }

    #[test]
    fn similar_items_are_paired_in_order() {
        let (a, b) = ([10_u32, 20, 30], [21_u32, 31]);
        let alike = |i: usize, j: usize| if a[i].abs_diff(b[j]) < 2 { 5 } else { 0 };
        assert_eq!(pair_similar((3, 2), 1, &mut Work::new(), alike), [(1, 0), (2, 1)]);
    }
}
