//! Facts that hold after every scan, shown together by induction.
//!
//! Candidates are what no state of a run ever violated. Those that the first scan can violate are dropped,
//! then those that one scan can violate from a state in which all that are left hold, until none is: what is
//! left holds after the first scan and is kept by every other one.

use std::collections::{BTreeMap, BTreeSet};

use batsat::Lit;

use super::gates::{Answer, Gates};
use super::scan::Scan;
use crate::proof::progress::Progress;

/// At least one of these bits has this value; one bit, or two.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Fact(pub(super) Vec<(u32, bool)>);

struct Held {
    fact: Fact,
    /// Assumes the fact before the scan.
    assumed: Lit,
    /// It holds behind the scan.
    holds: Lit,
}

/// Searches for what can be kept of one set of candidates.
const MOST_SEARCHES: u32 = 4_000;

/// The two circuits, and what is known.
pub(super) struct Induction<'o> {
    /// The first scan.
    pub(super) first: Scan<'o>,
    /// Any scan.
    pub(super) any: Scan<'o>,
    held: Vec<Held>,
    /// Facts that the induction step of a fact needs.
    needs: BTreeMap<usize, Vec<usize>>,
    searches: u32,
    progress: Option<&'o Progress>,
}

impl<'o> Induction<'o> {
    pub(super) fn new(first: Scan<'o>, any: Scan<'o>, progress: Option<&'o Progress>) -> Induction<'o> {
        Induction { first, any, held: Vec::new(), needs: BTreeMap::new(), searches: 0, progress }
    }

    /// Facts that hold after every scan.
    pub(super) fn facts(&self) -> impl Iterator<Item = &Fact> {
        self.held.iter().map(|held| &held.fact)
    }

    /// Takes candidates in and keeps what holds with all that was known before. `false`: the search took too
    /// long, and nothing is known.
    pub(super) fn take(&mut self, candidates: Vec<Fact>) -> bool {
        let known: BTreeSet<Fact> = self.facts().cloned().collect();
        let new: BTreeSet<Fact> = candidates.into_iter().filter(|fact| !known.contains(fact)).collect();
        let begins: Vec<(Fact, Lit)> = new
            .into_iter()
            .map(|fact| {
                let holds = holds(&mut self.first, &fact);
                (fact, holds)
            })
            .collect();
        let mut live = begins;
        if !self.drop_violated(&mut live) {
            self.held.clear();
            return false;
        }
        for (fact, _) in live {
            let Some(before) = fact
                .0
                .iter()
                .map(|(at, on)| {
                    let stored = self.any.initial.get(at).copied()?;
                    Some(if *on { stored } else { !stored })
                })
                .collect::<Option<Vec<Lit>>>()
            else {
                continue;
            };
            let assumed = self.any.gates.free();
            let clause: Vec<Lit> = before.into_iter().chain([!assumed]).collect();
            self.any.gates.clause(&clause);
            let holds = holds(&mut self.any, &fact);
            self.held.push(Held { fact, assumed, holds });
        }
        self.needs.clear();
        loop {
            let assumed = self.assumed();
            let open: Vec<Lit> = self.held.iter().map(|held| !held.holds).collect();
            match self.violated(false, &assumed, &open) {
                Some(violated) if violated.is_empty() => return true,
                Some(violated) => {
                    let mut index = 0;
                    self.held.retain(|_| {
                        index += 1;
                        !violated.contains(&(index - 1))
                    });
                }
                None => {
                    self.held.clear();
                    return false;
                }
            }
        }
    }

    /// Drops what the first scan can violate.
    fn drop_violated(&mut self, live: &mut Vec<(Fact, Lit)>) -> bool {
        loop {
            let open: Vec<Lit> = live.iter().map(|(_, holds)| !*holds).collect();
            match self.violated(true, &[], &open) {
                Some(violated) if violated.is_empty() => return true,
                Some(violated) => {
                    let mut index = 0;
                    live.retain(|_| {
                        index += 1;
                        !violated.contains(&(index - 1))
                    });
                }
                None => return false,
            }
        }
    }

    /// Some of these that can be true, all together in one scan; none: none of them can. `None`: not known.
    fn violated(&mut self, first: bool, assumed: &[Lit], open: &[Lit]) -> Option<BTreeSet<usize>> {
        self.searches += 1;
        if self.searches > MOST_SEARCHES || self.progress.is_some_and(Progress::is_stopped) {
            return None;
        }
        let gates = if first { &mut self.first.gates } else { &mut self.any.gates };
        let some = gates.free();
        let clause: Vec<Lit> = open.iter().copied().chain([!some]).collect();
        gates.clause(&clause);
        let all: Vec<Lit> = assumed.iter().copied().chain([some]).collect();
        match gates.ask(&all) {
            Answer::Impossible => Some(BTreeSet::new()),
            Answer::Possible => {
                let found = |gates: &Gates, literal: Lit| gates.found(literal);
                let hit = open.iter().enumerate().filter(|(_, literal)| found(gates, **literal));
                Some(hit.map(|(index, _)| index).collect())
            }
            Answer::Unknown => None,
        }
    }

    fn assumed(&self) -> Vec<Lit> {
        self.held.iter().map(|held| held.assumed).collect()
    }

    /// Whether something can happen in no scan, and which facts exclude it; each literal of its own circuit.
    pub(super) fn excludes(&mut self, in_first: Lit, in_any: Lit) -> Option<BTreeSet<usize>> {
        if self.first.gates.ask(&[in_first]) != Answer::Impossible {
            return None;
        }
        self.needed(in_any)
    }

    fn needed(&mut self, in_any: Lit) -> Option<BTreeSet<usize>> {
        if in_any == self.any.gates.no() {
            return Some(BTreeSet::new());
        }
        let mut assumed = self.assumed();
        assumed.push(in_any);
        if self.any.gates.ask(&assumed) != Answer::Impossible {
            return None;
        }
        let gates = &self.any.gates;
        Some((0..).zip(&self.held).filter(|(_, held)| gates.needed(held.assumed)).map(|(index, _)| index).collect())
    }

    /// The facts whose induction rests on each other that these rest on, themselves included.
    pub(super) fn support(&mut self, from: &BTreeSet<usize>) -> BTreeSet<usize> {
        let mut all = BTreeSet::new();
        let mut open: Vec<usize> = from.iter().copied().collect();
        while let Some(index) = open.pop() {
            if !all.insert(index) {
                continue;
            }
            let known = self.needs.get(&index).cloned();
            let needs = known.unwrap_or_else(|| {
                let violated = self.held.get(index).map(|held| !held.holds);
                let needed = violated.and_then(|violated| self.needed(violated)).unwrap_or_default();
                needed.into_iter().collect()
            });
            open.extend(&needs);
            self.needs.insert(index, needs);
        }
        all
    }

    pub(super) fn fact(&self, index: usize) -> Option<&Fact> {
        self.held.get(index).map(|held| &held.fact)
    }
}

/// The fact behind the scan of a circuit.
fn holds(scan: &mut Scan<'_>, fact: &Fact) -> Lit {
    let mut some = scan.gates.no();
    for (at, on) in &fact.0 {
        let bit = scan.bit(*at);
        some = scan.gates.or(some, if *on { bit } else { !bit });
    }
    some
}
