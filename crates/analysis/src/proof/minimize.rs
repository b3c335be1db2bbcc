//! From the scans that led to a difference to the few that are needed.

use std::time::Duration;

use super::inputs::Inputs;
use super::pairs::Pairs;
use super::play::{Both, Difference, apply, compare, enter};
use super::progress::Progress;
use super::side::Side;
use super::tape::{Head, Set, Tape};

/// Scans that may be spent on it.
const BUDGET: u64 = 4_000_000;

/// Plays tapes from power-up.
pub(crate) struct Player<'p, B: Side> {
    /// Both sides before they entered run for the first time.
    pub(crate) base: &'p Both<B>,
    pub(crate) scratch: Both<B>,
    pub(crate) pairs: &'p Pairs,
    pub(crate) inputs: &'p Inputs<B::Target>,
    pub(crate) spent: u64,
    /// Who may want to see what is found so far.
    pub(crate) progress: Option<&'p Progress>,
}

type Scans = Vec<(Head, Vec<Set>)>;

fn tape_of(scans: &Scans) -> Tape {
    let mut tape = Tape::default();
    tape.extend(scans.iter().map(|(head, sets)| (*head, sets.as_slice())));
    tape
}

fn scans_of(tape: &Tape) -> Scans {
    tape.iter().map(|(head, sets)| (head, sets.to_vec())).collect()
}

impl<B: Side> Player<'_, B> {
    /// The first difference and the scans up to it, that scan included.
    pub(crate) fn play(&mut self, tape: &Tape) -> Option<(usize, Difference)> {
        self.scratch.copy_from(self.base);
        enter(&mut self.scratch);
        let mut buffers = [Vec::new(), Vec::new()];
        for (index, (head, sets)) in tape.iter().enumerate() {
            apply(&mut self.scratch, self.inputs, head, sets);
            let time = Duration::from_micros(head.dt.into());
            self.scratch.a.scan(time);
            self.scratch.b.scan(time);
            self.spent += 1;
            if let Some(difference) = compare(&self.scratch.a, &self.scratch.b, self.pairs, &mut buffers) {
                return Some((index + 1, difference));
            }
            let stopped = [self.scratch.a.stopped().is_some(), self.scratch.b.stopped().is_some()];
            if stopped == [true, false] {
                return None;
            }
            if stopped[0] && tape.get(index + 1).is_none_or(|next| !next.0.program_run) {
                return None;
            }
        }
        None
    }

    fn goes_on(&self) -> bool {
        self.spent < BUDGET && !self.progress.is_some_and(Progress::is_stopped)
    }

    /// Whether scans still show a difference; cuts behind it if so.
    fn fails(&mut self, scans: &mut Scans) -> bool {
        match self.play(&tape_of(scans)) {
            Some((length, _)) => {
                scans.truncate(length);
                true
            }
            None => false,
        }
    }

    /// The shortest tape found that shows a difference, and that difference.
    pub(crate) fn shortest(&mut self, tape: &Tape) -> Option<(Tape, Difference)> {
        let mut best = scans_of(tape);
        if !self.fails(&mut best) {
            return None;
        }
        self.without_scans(&mut best);
        self.even(&mut best);
        self.without_scans(&mut best);
        self.without_sets(&mut best);
        self.without_scans(&mut best);
        self.even(&mut best);
        let tape = tape_of(&best);
        let (length, difference) = self.play(&tape)?;
        Some((tape.first(length), difference))
    }

    /// Leaves out stretches of scans, long ones first. The first scan stays: it stores initial values.
    fn without_scans(&mut self, best: &mut Scans) {
        let mut size = best.len().div_ceil(2);
        while size > 0 && self.goes_on() {
            let mut at = 1;
            let mut shorter = false;
            while at < best.len() && self.goes_on() {
                let end = (at + size).min(best.len());
                let mut candidate: Scans = best.iter().take(at).chain(best.iter().skip(end)).cloned().collect();
                // Without the scans but with their last word on each input.
                let mut merged = candidate.clone();
                let sets: Vec<Set> = best.iter().take(end).skip(at).flat_map(|scan| scan.1.clone()).collect();
                if let Some(next) = merged.get_mut(at)
                    && !sets.is_empty()
                {
                    next.1.splice(0..0, sets);
                }
                if self.fails(&mut candidate) {
                    *best = candidate;
                    shorter = true;
                } else if self.fails(&mut merged) {
                    *best = merged;
                    shorter = true;
                } else {
                    at = end;
                }
            }
            if size == 1 && !shorter {
                break;
            }
            size = if size == 1 { 1 } else { size / 2 };
            if size == 1 && best.len() > 3000 {
                break;
            }
        }
    }

    /// Leaves out changes of inputs.
    fn without_sets(&mut self, best: &mut Scans) {
        let mut scan = best.len();
        while scan > 0 && self.goes_on() {
            scan -= 1;
            let mut set = best.get(scan).map_or(0, |scan| scan.1.len());
            while set > 0 {
                set -= 1;
                let mut candidate = best.clone();
                if let Some(sets) = candidate.get_mut(scan).map(|scan| &mut scan.1)
                    && set < sets.len()
                {
                    sets.remove(set);
                    if self.fails(&mut candidate) {
                        *best = candidate;
                    }
                }
            }
            scan = scan.min(best.len());
        }
    }

    /// One time for all scans, where the difference shows with one too.
    fn even(&mut self, best: &mut Scans) {
        let mut times: Vec<u32> = best.iter().map(|scan| scan.0.dt).filter(|dt| *dt > 0).collect();
        times.sort_unstable();
        times.dedup();
        if times.len() < 2 {
            return;
        }
        times.insert(0, 10_000);
        for dt in times {
            let mut candidate = best.clone();
            for (head, _) in candidate.iter_mut().skip(1) {
                head.dt = if head.program_run { 0 } else { dt };
            }
            if self.fails(&mut candidate) {
                *best = candidate;
                return;
            }
        }
    }
}
