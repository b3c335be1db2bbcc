//! Facts worth trying: what no state of a run ever violated.

use std::collections::{BTreeMap, BTreeSet};

use sim::outline::{Does, Outline};

use super::cells::is_hidden;
use super::facts::Fact;

/// States of a run, one word after the other.
pub(super) struct States<'s>(pub(super) &'s [&'s [u16]]);

impl States<'_> {
    fn bit(state: &[u16], at: u32) -> bool {
        state.get((at / 16) as usize).is_some_and(|word| word >> (at % 16) & 1 != 0)
    }

    /// Values a bit had: seen off, seen on.
    fn seen(&self, at: u32) -> [bool; 2] {
        let mut seen = [false; 2];
        for state in self.0.iter().copied() {
            seen[usize::from(Self::bit(state, at))] = true;
        }
        seen
    }

    /// Bits that always had one value.
    pub(super) fn constants(&self, bits: impl Iterator<Item = u32>) -> Vec<Fact> {
        bits.filter_map(|at| {
            if is_hidden(at) {
                return Some(Fact(vec![(at, false)]));
            }
            match self.seen(at) {
                [true, true] => None,
                [_, on] => Some(Fact(vec![(at, on)])),
            }
        })
        .collect()
    }

    /// Pairs of bits of which one always had a certain value.
    pub(super) fn pairs(&self, bits: &BTreeSet<u32>) -> Vec<Fact> {
        let moving: Vec<u32> = bits.iter().copied().filter(|at| self.seen(*at) == [true, true]).collect();
        // All states of a bit side by side, 64 to a word.
        let row = |at: &u32| -> Vec<u64> {
            let block =
                |states: &[&[u16]]| states.iter().fold(0u64, |sum, state| sum << 1 | u64::from(Self::bit(state, *at)));
            self.0.chunks_exact(64).map(block).collect()
        };
        let rows: Vec<Vec<u64>> = moving.iter().map(row).collect();
        let mut facts = Vec::new();
        for (index, (a, row_a)) in moving.iter().zip(&rows).enumerate() {
            for (b, row_b) in moving.iter().zip(&rows).skip(index + 1) {
                for (on_a, on_b) in [(false, false), (false, true), (true, false), (true, true)] {
                    let violated = |(x, y): (&u64, &u64)| {
                        let (x, y) = (if on_a { !x } else { *x }, if on_b { !y } else { *y });
                        x & y != 0
                    };
                    if !row_a.iter().zip(row_b).any(violated) {
                        facts.push(Fact(vec![(*a, on_a), (*b, on_b)]));
                    }
                }
            }
        }
        facts
    }
}

/// Bits that pairs are made of.
const MOST_BITS: usize = 96;

/// The bits of rungs, nearest to the given rungs first: those in them, those in rungs that write these, and
/// so on, as many as pairs can be tried with.
pub(super) fn near(outline: &Outline, rungs: &BTreeSet<(u16, u16)>, stored: impl Fn(u32) -> bool) -> BTreeSet<u32> {
    let mut reads: BTreeMap<(u16, u16), BTreeSet<u32>> = BTreeMap::new();
    let mut writers: BTreeMap<u32, BTreeSet<(u16, u16)>> = BTreeMap::new();
    for step in &outline.steps {
        let rung = (step.file, step.rung);
        let bits = reads.entry(rung).or_default();
        let mut write = |at: u32| {
            writers.entry(at).or_default().insert(rung);
        };
        match step.does {
            Does::Contact { bit, .. } => {
                bits.insert(bit);
            }
            Does::Coil(at) | Does::Latch(at) | Does::Unlatch(at) | Does::OneShot(at) => {
                bits.insert(at);
                write(at);
            }
            Does::Rising { storage, output } | Does::Falling { storage, output } => {
                bits.extend([storage, output]);
                [storage, output].into_iter().for_each(write);
            }
            Does::Timer { word, .. } | Does::Counter { word, .. } => {
                let flags = [13, 14, 15].map(|bit| word * 16 + bit);
                bits.extend(flags);
                flags.into_iter().for_each(write);
            }
            _ => {}
        }
    }
    let mut found = BTreeSet::new();
    let mut open: Vec<(u16, u16)> = rungs.iter().copied().collect();
    let mut done: BTreeSet<(u16, u16)> = BTreeSet::new();
    while !open.is_empty() {
        let mut next = BTreeSet::new();
        for rung in open {
            if !done.insert(rung) {
                continue;
            }
            for at in reads.get(&rung).into_iter().flatten().filter(|at| stored(**at)) {
                if found.len() >= MOST_BITS {
                    return found;
                }
                if found.insert(*at) {
                    next.extend(writers.get(at).into_iter().flatten().copied());
                }
            }
        }
        open = next.into_iter().collect();
    }
    found
}
