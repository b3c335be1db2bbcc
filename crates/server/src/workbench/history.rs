//! The past of a run: every scan can be gone back to, within a bound.
//!
//! The engine is deterministic, so the past is not kept as states but as what was done: a copy of the state
//! now and then, and between two copies the changes and the time of each scan. Going back copies the
//! nearest state before and runs on from there.

use std::collections::VecDeque;
use std::time::Duration;

use super::change::Change;
use super::flow::Flow;
use super::state::State;

/// Scans between two copies of the state.
const STRIDE: u64 = 250;

/// Copies that are kept; with [`STRIDE`] 50,000 scans, more than eight minutes of ten milliseconds each.
const COPIES: usize = 200;

/// Bytes that changes and plants of copies may take.
const BYTES: usize = 64 << 20;

/// Bytes that changes without a scan between them may take.
const PENDING: usize = 8 << 20;

/// One scan: what was changed before it, and the usual time between scans.
#[derive(Clone, Debug, Default)]
struct Moment {
    changes: Vec<Change>,
    usual: Duration,
}

impl Moment {
    fn bytes(&self) -> usize {
        self.changes.iter().map(Change::bytes).sum()
    }
}

/// What was done since the oldest scan that can be gone back to.
pub struct History {
    /// With the number of moments before each.
    copies: VecDeque<(u64, State)>,
    moments: VecDeque<Moment>,
    /// Moments that were forgotten.
    forgotten: u64,
    /// Changes since the last scan.
    pending: Vec<Change>,
    /// Their bytes.
    pending_bytes: usize,
    /// Bytes of the changes in all moments, and of plants in all copies.
    kept: usize,
}

/// How much a history holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kept {
    /// Copies of the state.
    pub copies: usize,
    /// Scans that can be gone back.
    pub scans: usize,
    /// Bytes of what was done before them and since.
    pub bytes: usize,
}

impl History {
    /// Begins with a state.
    pub fn new(state: &State) -> History {
        let copies = VecDeque::from([(0, state.fork())]);
        History {
            copies,
            moments: VecDeque::new(),
            forgotten: 0,
            pending: Vec::new(),
            pending_bytes: 0,
            kept: state.plant_bytes(),
        }
    }

    /// Something was changed; `state` is the one after it. Who changes without end and never scans cannot go back.
    pub fn changed(&mut self, change: Change, state: &State) {
        self.pending_bytes += change.bytes();
        self.pending.push(change);
        if self.pending_bytes > PENDING {
            let end = self.end();
            *self = History { copies: VecDeque::from([(end, state.fork())]), forgotten: end, ..History::new(state) };
        }
    }

    /// How much is held.
    pub fn kept(&self) -> Kept {
        Kept { copies: self.copies.len(), scans: self.moments.len(), bytes: self.kept + self.pending_bytes }
    }

    /// A scan was run; `state` is the one after it.
    pub fn scanned(&mut self, usual: Duration, state: &State) {
        let changes = std::mem::take(&mut self.pending);
        self.kept += std::mem::take(&mut self.pending_bytes);
        self.moments.push_back(Moment { changes, usual });
        let end = self.end();
        if end.is_multiple_of(STRIDE) {
            self.copies.push_back((end, state.fork()));
            self.kept += state.plant_bytes();
        }
        while self.copies.len() > COPIES || self.kept > BYTES && self.copies.len() > 1 {
            self.kept -= self.copies.pop_front().map_or(0, |copy| copy.1.plant_bytes());
            let first = self.copies.front().map_or(end, |copy| copy.0);
            let gone = usize::try_from(first - self.forgotten).unwrap_or(usize::MAX).min(self.moments.len());
            self.kept -= self.moments.drain(..gone).map(|moment| moment.bytes()).sum::<usize>();
            self.forgotten = first;
        }
    }

    /// Scans that can be gone back.
    pub fn depth(&self) -> u64 {
        self.moments.len() as u64
    }

    /// Scans since it began, those that were gone back left out.
    pub fn end(&self) -> u64 {
        self.forgotten + self.depth()
    }

    /// Goes back so many scans, at most [`History::depth`], and forgets what came after: `state` becomes the
    /// one right behind the scan gone back to, `flow` the power flow of that scan. Answers the scans gone back.
    /// Changes since the last scan are undone first, without being counted.
    pub fn back(&mut self, scans: u64, state: &mut State, flow: &mut Flow) -> u64 {
        let gone = scans.min(self.depth());
        let target = self.end() - gone;
        // The last scan is run again to see its power flow: the copy must be older.
        while self.copies.len() > 1 && self.copies.back().is_some_and(|copy| copy.0 >= target) {
            self.kept -= self.copies.pop_back().map_or(0, |copy| copy.1.plant_bytes());
        }
        let Some((start, copy)) = self.copies.back() else { return 0 };
        let mut now = copy.fork();
        let index = |at: u64| usize::try_from(at - self.forgotten).unwrap_or(usize::MAX).min(self.moments.len());
        let (from, to) = (index(*start), index(target));
        if from == to {
            *flow = now.machine.flow();
        }
        for (number, moment) in (from..).zip(self.moments.range(from..to)) {
            for change in &moment.changes {
                // It could be made then, so it can be made now.
                let _ = now.apply(change);
            }
            // The two last scans, so that what changed between them shows.
            now.scan(moment.usual, (number + 2 >= to).then_some(&mut *flow));
        }
        self.kept -= self.moments.drain(to..).map(|moment| moment.bytes()).sum::<usize>();
        self.pending.clear();
        self.pending_bytes = 0;
        *state = now;
        gone
    }
}
