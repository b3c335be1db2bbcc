//! The run: both machines scan by scan, with inputs that lead to what was not seen yet.

use std::collections::HashSet;
use std::time::Duration;

use super::goals::{Goal, Goals};
use super::inputs::Inputs;
use super::pairs::Pairs;
use super::play::{Both, Difference, apply, compare, enter};
use super::progress::Progress;
use super::random::Random;
use super::side::{Seen, Side, Slc};
use super::solve::Solver;
use super::tape::{Set, Tape};
use super::unreachable::{self, Surroundings};

/// A state that showed something new, and how it was reached.
pub(super) struct Entry<B> {
    pub(super) both: Both<B>,
    /// The entry it grew from; itself for the first.
    parent: usize,
    /// Scans since the parent.
    tape: Tape,
    /// Scans since power-up.
    depth: usize,
    /// How often it was gone on from.
    used: u32,
    standing: Vec<Standing>,
    /// Microseconds since power-up.
    pub(super) age: u64,
}

/// A state of the present stretch to go back to.
pub(super) struct Mark<B> {
    both: Both<B>,
    from: usize,
    tape: Tape,
    standing: Vec<Standing>,
    age: u64,
}

/// A timer that is timing and yet does not count, since nothing executes it: its accumulated value, and for how
/// many microseconds.
type Standing = (u16, u64);

/// How a goal was reached for the first time.
#[derive(Clone)]
pub(super) struct Recipe {
    pub(super) goal: usize,
    /// The state it began from.
    pub(super) from: usize,
    /// Scans up to the one that reached it, and that one.
    pub(super) before: Tape,
    pub(super) last: Tape,
}

/// Everything a run works on.
pub(crate) struct Campaign<'c, B: Side> {
    pub(crate) both: Both<B>,
    pub(crate) pairs: &'c Pairs,
    pub(crate) inputs: &'c Inputs<B::Target>,
    pub(crate) goals: Goals,
    /// What the other side's instructions did.
    pub(crate) seen: Seen,
    pub(super) solver: &'c Solver<'c>,
    surroundings: &'c Surroundings<'c>,
    /// Data of the original behind stretches, for arguments about what cannot happen.
    states: Vec<Vec<u16>>,
    /// Why nothing could be argued.
    pub(crate) unargued: Option<&'static str>,
    pub(super) random: Random,
    pub(super) corpus: Vec<Entry<B>>,
    /// Scans since the state the present episode began from.
    pub(super) tape: Tape,
    pub(super) from: usize,
    /// Changes for the next scan.
    pub(super) pending: Vec<Set>,
    /// The time before scans that an episode uses most, in microseconds.
    pub(super) pace: u32,
    buffers: [Vec<u8>; 2],
    pub(super) presets: Vec<(u32, u32)>,
    pub(crate) scans: u64,
    pub(crate) episodes: u64,
    pub(crate) mode_changes: u64,
    pub(crate) stops: u64,
    /// Stretches that ended because the inputs left the stated conditions.
    pub(crate) outside: u64,
    pub(crate) time: Duration,
    pub(super) budget: u64,
    /// A timed interrupt runs in the original: times between scans stay so short that it comes no more
    /// than once between two of them.
    pub(super) short: bool,
    /// Its period does not change between two scans.
    steady: bool,
    /// Drifts made.
    pub(super) drifts: u32,
    /// A program with a timed interrupt was brought to where clocks start anew.
    pub(super) aged: bool,
    /// States before something that comes with time, by number in the corpus.
    pub(super) eves: Vec<usize>,
    /// Goals at instructions with words that are inputs.
    with_words: Vec<usize>,
    /// How such goals were reached.
    pub(super) recipes: Vec<Recipe>,
    /// Words that hold bits the program writes, and which.
    flags: Vec<(u32, u16)>,
    /// What these were in states seen so far, hashed.
    met: HashSet<u64>,
    /// Each of the timers.
    standing: Vec<Standing>,
    /// Microseconds since power-up.
    pub(super) age: u64,
    /// One of them has stood too long for a conversion to count: nothing follows from this stretch any more.
    lapsed: bool,
    /// A machine to look ahead with.
    pub(super) probe: Slc,
    quiet: u64,
    /// The other side is watched in every scan.
    pub(super) looks: bool,
    /// The first difference, with all scans from power-up to it.
    pub(crate) found: Option<(Difference, Tape)>,
    /// Who looks on from another thread.
    progress: Option<&'c Progress>,
}

/// States kept.
const MOST_ENTRIES: usize = 3000;
/// States looked at for arguments, besides those kept.
const MOST_STATES: usize = 1000;
/// The part of all scans after which is argued for the first time.
const FIRST_ARGUMENT: u64 = 8;
/// Scans from power-up to a state that is gone on from.
const DEEPEST: usize = 30_000;
/// Times before a scan that are tried, in milliseconds.
pub(super) const PACES: [u32; 5] = [1, 7, 10, 13, 50];
/// Longest time a timer that is timing may not be executed, in microseconds: conversions count it modulo a thousand
/// million milliseconds.
const LONGEST_STANDING: u64 = 990_000_000_000;
/// Time before a scan from which on timers that stand are looked at: shorter ones make no days.
const LONG_PACE: u32 = 60_000_000;
/// Scans to an instruction that are repeated.
const LONGEST_RECIPE: usize = 2500;
/// States kept because their bits are new.
const MOST_MET: usize = 800;
/// TT of the flags of a timer.
pub(super) const TIMING: u16 = 0x4000;
/// Longest time before a scan beside a timed interrupt that does not run yet or whose period can change, in
/// microseconds.
const SHORT_PACE: u32 = 10_000;

impl<'c, B: Side> Campaign<'c, B> {
    #[allow(clippy::too_many_arguments)] // called once
    pub(crate) fn new(
        both: Both<B>,
        pairs: &'c Pairs,
        inputs: &'c Inputs<B::Target>,
        goals: Goals,
        (solver, surroundings): (&'c Solver<'c>, &'c Surroundings<'c>),
        presets: Vec<(u32, u32)>,
        (seed, budget): (u64, u64),
        (short, steady): (bool, bool),
        progress: Option<&'c Progress>,
    ) -> Campaign<'c, B> {
        let seen = Seen::new(both.b.operations());
        let probe = both.a.fork();
        let words = |goal: &Goal| goal.impossible.is_none() && !solver.words(goal, &both.a).is_empty();
        let with_words = (0..).zip(&goals.all).filter(|(_, goal)| words(goal)).map(|(index, _)| index).collect();
        let flags = solver.flags();
        Campaign {
            seen,
            both,
            pairs,
            inputs,
            goals,
            solver,
            surroundings,
            states: Vec::new(),
            unargued: None,
            random: Random::new(seed),
            corpus: Vec::new(),
            tape: Tape::default(),
            from: 0,
            pending: Vec::with_capacity(64),
            pace: 10_000,
            buffers: [Vec::with_capacity(256), Vec::with_capacity(256)],
            presets,
            scans: 0,
            episodes: 0,
            mode_changes: 0,
            stops: 0,
            outside: 0,
            time: Duration::ZERO,
            budget,
            short,
            steady,
            drifts: 0,
            aged: false,
            eves: Vec::new(),
            with_words,
            recipes: Vec::new(),
            flags,
            met: HashSet::new(),
            standing: Vec::new(),
            age: 0,
            lapsed: false,
            probe,
            quiet: 0,
            looks: false,
            found: None,
            progress,
        }
    }

    /// Runs until the scans are used up or a difference is found.
    pub(crate) fn run(&mut self) {
        if !self.open() {
            return;
        }
        enter(&mut self.both);
        // Initial values are stored in the first scan: data is not touched before it.
        self.scan(false, 0);
        self.keep();
        if self.corpus.is_empty() {
            // The original stops in its first scan: there is nothing to go on from.
            return;
        }
        self.each_input();
        self.each_at_once();
        let mut round = 0usize;
        let mut argue_at = self.budget / FIRST_ARGUMENT;
        while self.open() {
            if self.scans >= argue_at {
                // What cannot happen is no aim for the rest of the run.
                self.rule_out();
                argue_at = u64::MAX;
            }
            self.begin();
            match round % 8 {
                _ if round % 24 == 6 => self.reach_boundary(),
                _ if matches!(round % 24, 13 | 15 | 21) => self.exercise(),
                _ if matches!(round % 24, 2 | 10) => self.at_eve(),
                0..3 => self.aim(),
                3 if self.random.chance(2, 3) => self.reach_preset(),
                3 => self.wait_long(),
                4 => self.change_mode(),
                5 if round % 384 == 5 => self.wait_days(),
                5 if round % 384 == 29 => self.reach_age(),
                5 if round % 384 == 53 => self.drift(),
                5 => self.steady(),
                _ => self.wander(),
            }
            let stopped = self.both.a.stopped().is_some() && self.both.b.stopped().is_some();
            if self.open() && stopped && self.random.chance(1, 4) {
                // Back into run after a fault, as a person would.
                self.scan(true, 0);
                self.wander();
            }
            round += 1;
        }
        // Whoever stopped the run does not wait for arguments.
        if self.found.is_none() && !self.is_stopped() {
            self.rule_out();
        }
    }

    /// Somebody wants no more scans.
    pub(crate) fn is_stopped(&self) -> bool {
        self.progress.is_some_and(Progress::is_stopped)
    }

    fn argues(&self, arguing: bool) {
        if let Some(progress) = self.progress {
            progress.argues(arguing);
        }
    }

    /// Looks for goals that no run can reach.
    fn rule_out(&mut self) {
        self.argues(true);
        let kept = self.corpus.iter().map(|entry| entry.both.a.machine.data());
        let states: Vec<&[u16]> = kept.chain(self.states.iter().map(Vec::as_slice)).collect();
        self.unargued = unreachable::rule_out(&mut self.goals, self.surroundings, &states);
        self.argues(false);
    }

    pub(super) fn open(&self) -> bool {
        self.found.is_none() && self.scans < self.budget && !self.is_stopped()
    }

    /// Both sides are scanning and nothing was found.
    pub(super) fn goes_on(&self) -> bool {
        self.open() && !self.lapsed && self.both.a.stopped().is_none()
    }

    /// Starts an episode from a state seen before, newer and less used ones more often.
    pub(super) fn begin(&mut self) {
        if self.states.len() < MOST_STATES && self.both.a.stopped().is_none() {
            self.states.push(self.both.a.machine.data().to_vec());
        }
        self.episodes += 1;
        let count = self.corpus.len();
        let mut best = 0;
        for turn in 0..3 {
            let eve = self.random.pick(&self.eves).copied().filter(|_| self.random.chance(1, 6));
            let candidate = if let Some(eve) = eve {
                eve
            } else if self.random.chance(1, 2) && count > 8 {
                count - 1 - self.random.below(count / 2)
            } else {
                self.random.below(count)
            };
            let used = |index: usize| self.corpus.get(index).map_or(u32::MAX, |entry| entry.used);
            if turn == 0 || used(candidate) < used(best) {
                best = candidate;
            }
        }
        self.begin_at(best);
        let pace = self.random.pick(&PACES).copied().unwrap_or(10);
        self.pace = pace * 1000;
    }

    /// Keeps the present state to go on from.
    pub(super) fn keep(&mut self) {
        self.goals.fresh.clear();
        let base = self.corpus.get(self.from).map_or(0, |entry| entry.depth);
        let depth = base + self.tape.len();
        if self.corpus.len() >= MOST_ENTRIES || depth > DEEPEST || self.lapsed || self.both.a.stopped().is_some() {
            return;
        }
        let (both, tape, standing) = (self.both.fork(), self.tape.clone(), self.standing.clone());
        let entry = Entry { both, parent: self.from, tape, depth, used: 0, standing, age: self.age };
        self.from = self.corpus.len();
        self.corpus.push(entry);
        self.tape.clear();
    }

    /// States kept so far.
    pub(super) fn kept(&self) -> usize {
        self.corpus.len()
    }

    /// One scan of both sides with the pending changes, and the comparison.
    pub(super) fn scan(&mut self, program_run: bool, dt: u32) {
        if self.lapsed {
            return;
        }
        let dt = if program_run { 0 } else { dt.min(self.longest()) };
        for set in self.pending.drain(..) {
            let written = self.inputs.all.get(usize::from(set.0)).is_some_and(|input| input.written);
            if !(program_run && written) {
                self.tape.set(set);
            }
        }
        self.tape.push(program_run, dt);
        let last = self.tape.len() - 1;
        let Some((head, sets)) = self.tape.get(last) else { return };
        apply(&mut self.both, self.inputs, head, sets);
        let time = Duration::from_micros(dt.into());
        // Coverage costs more than the scan: where it does not grow any more every fourth scan is watched.
        let watched = self.goals.rungs_open() && (self.quiet < 20_000 || self.scans.is_multiple_of(4));
        if watched {
            self.both.a.machine.scan_traced(time, &mut self.goals);
        } else {
            self.both.a.scan(time);
        }
        // The other side can need more than the original shows: state a conversion keeps for itself.
        if self.quiet < 20_000 || self.scans.is_multiple_of(4) || self.looks {
            self.both.b.scan_seen(time, &mut self.seen);
        } else {
            self.both.b.scan(time);
        }
        self.goals.look(&self.both.a);
        self.scans += 1;
        self.time += time;
        self.age += u64::from(dt);
        self.mode_changes += u64::from(program_run);
        self.quiet += 1;
        if let Some(progress) = self.progress {
            progress.at(self.scans);
        }
        if let Some(difference) = compare(&self.both.a, &self.both.b, self.pairs, &mut self.buffers) {
            let tape = self.history();
            self.found = Some((difference, tape));
            return;
        }
        if dt >= LONG_PACE {
            self.look_at_standing(dt);
        }
        if self.both.a.stopped().is_some() {
            match self.both.b.stopped() {
                Some(_) => self.stops += 1,
                None => self.outside += 1,
            }
        }
        for goal in &self.goals.fresh {
            let goal = *goal as usize;
            if self.with_words.contains(&goal) && self.tape.len() <= LONGEST_RECIPE {
                let (before, last) = (self.tape.first(last), self.tape.rest(last));
                self.recipes.push(Recipe { goal, from: self.from, before, last });
            }
        }
        let fresh = self.seen.take_fresh() | !self.goals.fresh.is_empty();
        if fresh {
            self.quiet = 0;
        }
        if self.is_new() || fresh {
            self.keep();
        }
    }

    /// The longest time before the next scan, in microseconds: a timed interrupt comes no more than once in it.
    pub(super) fn longest(&self) -> u32 {
        if !self.short {
            return u32::MAX;
        }
        let Some((left, period)) = self.both.a.machine.timed_interrupt() else { return SHORT_PACE };
        let below_two = (left + period).saturating_sub(Duration::from_millis(1));
        let below_two = u32::try_from(below_two.as_millis() * 1000).unwrap_or(u32::MAX).max(1000);
        if self.steady { below_two } else { below_two.min(SHORT_PACE) }
    }

    /// Adds a long scan to the time of timers that are timing but not executed.
    fn look_at_standing(&mut self, dt: u32) {
        self.standing.resize(self.presets.len(), (0, 0));
        for ((preset, _), (before, time)) in self.presets.iter().zip(&mut self.standing) {
            let now = self.both.a.word(preset + 16);
            let stands = now == *before && self.both.a.word(preset - 16) & TIMING != 0;
            *time = if stands { *time + u64::from(dt) } else { 0 };
            *before = now;
            self.lapsed |= *time > LONGEST_STANDING;
        }
    }

    /// The bits the program writes have not been seen like this, and not too many such states are kept.
    fn is_new(&mut self) -> bool {
        if self.met.len() >= MOST_MET {
            return false;
        }
        let data = self.both.a.machine.data();
        let word = |(word, mask): &(u32, u16)| u64::from(data.get(*word as usize).copied().unwrap_or(0) & mask);
        let hash = self.flags.iter().fold(0u64, |hash, flag| {
            let mixed = (hash ^ word(flag)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
            mixed ^ mixed >> 29
        });
        self.met.insert(hash)
    }

    /// Goes on from a state of this kind, if one is kept.
    pub(super) fn begin_where(&mut self, fits: impl Fn(&Slc) -> bool) {
        let found: Vec<usize> = (0..).zip(&self.corpus).filter(|(_, it)| fits(&it.both.a)).map(|(at, _)| at).collect();
        if let Some(index) = self.random.pick(&found).copied() {
            self.begin_at(index);
        }
    }

    /// Goes on from a kept state; `false`: there is no such one.
    pub(super) fn begin_at(&mut self, index: usize) -> bool {
        let Some(entry) = self.corpus.get_mut(index) else { return false };
        entry.used += 1;
        self.both.copy_from(&entry.both);
        self.standing.clone_from(&entry.standing);
        self.age = entry.age;
        self.lapsed = false;
        self.from = index;
        self.tape.clear();
        self.pending.clear();
        true
    }

    /// The present state.
    pub(super) fn mark(&self) -> Mark<B> {
        let (both, tape, standing) = (self.both.fork(), self.tape.clone(), self.standing.clone());
        Mark { both, from: self.from, tape, standing, age: self.age }
    }

    /// Goes back to a state.
    pub(super) fn return_to(&mut self, mark: &Mark<B>) {
        self.both.copy_from(&mark.both);
        self.from = mark.from;
        self.tape.clone_from(&mark.tape);
        self.standing.clone_from(&mark.standing);
        self.age = mark.age;
        self.lapsed = false;
        self.pending.clear();
    }

    /// All scans from power-up to now.
    fn history(&self) -> Tape {
        let mut chain = vec![&self.tape];
        let mut at = self.from;
        while let Some(entry) = self.corpus.get(at) {
            chain.push(&entry.tape);
            if entry.parent == at {
                break;
            }
            at = entry.parent;
        }
        let mut tape = Tape::default();
        for part in chain.into_iter().rev() {
            tape.extend(part.iter());
        }
        tape
    }
}
