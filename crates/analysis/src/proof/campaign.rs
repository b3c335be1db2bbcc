//! The run: both machines scan by scan, with inputs that lead to what was not seen yet.

use std::time::Duration;

use super::goals::Goals;
use super::inputs::Inputs;
use super::pairs::{Mismatch, Pairs};
use super::random::Random;
use super::side::{Kind, Seen, Side, Slc};
use super::solve::{Plan, Solver};
use super::tape::{Head, Set, Tape};
use super::unreachable::{self, Surroundings};

/// How the two sides differ.
#[derive(Clone, Debug, PartialEq)]
pub enum Difference {
    /// A value.
    Value(Mismatch),
    /// The original stopped and the other did not: why, and the code of its major fault if it has one.
    OriginalStopped(String, Option<u16>),
    /// The other stopped and the original did not.
    OtherStopped(String),
}

/// Both machines at one moment.
#[derive(Debug)]
pub(crate) struct Both<B> {
    pub(crate) a: Slc,
    pub(crate) b: B,
}

impl<B: Side> Both<B> {
    fn fork(&self) -> Both<B> {
        Both { a: self.a.fork(), b: self.b.fork() }
    }

    pub(crate) fn copy_from(&mut self, other: &Both<B>) {
        self.a.copy_from(&other.a);
        self.b.copy_from(&other.b);
    }
}

/// A state that showed something new, and how it was reached.
struct Entry<B> {
    both: Both<B>,
    /// The entry it grew from; itself for the first.
    parent: usize,
    /// Scans since the parent.
    tape: Tape,
    /// Scans since power-up.
    depth: usize,
    /// How often it was gone on from.
    used: u32,
}

/// Everything a run works on.
pub(crate) struct Campaign<'c, B: Side> {
    pub(crate) both: Both<B>,
    pub(crate) pairs: &'c Pairs,
    pub(crate) inputs: &'c Inputs<B::Target>,
    pub(crate) goals: Goals,
    /// What the other side's instructions did.
    pub(crate) seen: Seen,
    solver: &'c Solver<'c>,
    surroundings: &'c Surroundings<'c>,
    /// Data of the original behind stretches, for arguments about what cannot happen.
    states: Vec<Vec<u16>>,
    /// Why nothing could be argued.
    pub(crate) unargued: Option<&'static str>,
    random: Random,
    corpus: Vec<Entry<B>>,
    /// Scans since the state the present episode began from.
    tape: Tape,
    from: usize,
    /// Changes for the next scan.
    pending: Vec<Set>,
    /// The time before scans that an episode uses most, in microseconds.
    pace: u32,
    buffers: [Vec<u8>; 2],
    presets: Vec<(u32, u32)>,
    pub(crate) scans: u64,
    pub(crate) episodes: u64,
    pub(crate) mode_changes: u64,
    pub(crate) stops: u64,
    /// Stretches that ended because the inputs left the stated conditions.
    pub(crate) outside: u64,
    pub(crate) time: Duration,
    budget: u64,
    /// A timed interrupt runs in the original: times between scans stay short, so that it comes no more
    /// than once between two of them.
    short: bool,
    quiet: u64,
    /// The first difference, with all scans from power-up to it.
    pub(crate) found: Option<(Difference, Tape)>,
}

/// States kept.
const MOST_ENTRIES: usize = 3000;
/// States looked at for arguments, besides those kept.
const MOST_STATES: usize = 1000;
/// The part of all scans after which is argued for the first time.
const FIRST_ARGUMENT: u64 = 8;
/// Scans from power-up to a state that is gone on from.
const DEEPEST: usize = 30_000;
/// Scans of a long wait, and the part of all scans it may take if that is more.
const LONGEST_WAIT: u64 = 600;
const PART_OF_ALL: u64 = 20;
/// Times before a scan that are tried, in milliseconds.
const PACES: [u32; 5] = [1, 7, 10, 13, 50];
/// Longest time before a scan in a long wait, in microseconds. A controller's watchdog ends far longer ones.
const LONGEST_PACE: u64 = 2_000_000;
/// Longest time before a scan beside a timed interrupt, in microseconds: the shortest period there is.
const SHORT_PACE: u32 = 10_000;
/// Time before a scan where weeks are to pass, in microseconds: no controller scans so slowly, but what it
/// counts must add up the same.
const DAY_PACE: u32 = 3_599_987_000;

impl<'c, B: Side> Campaign<'c, B> {
    pub(crate) fn new(
        both: Both<B>,
        pairs: &'c Pairs,
        inputs: &'c Inputs<B::Target>,
        goals: Goals,
        (solver, surroundings): (&'c Solver<'c>, &'c Surroundings<'c>),
        presets: Vec<(u32, u32)>,
        (seed, budget, short): (u64, u64, bool),
    ) -> Campaign<'c, B> {
        let seen = Seen::new(both.b.operations());
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
            quiet: 0,
            found: None,
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
                0..3 => self.aim(),
                3 if self.random.chance(1, 2) => self.reach_preset(),
                3 => self.wait_long(),
                4 => self.change_mode(),
                5 if round % 1024 == 5 => self.wait_days(),
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
        if self.found.is_none() {
            self.rule_out();
        }
    }

    /// Looks for goals that no run can reach.
    fn rule_out(&mut self) {
        let kept = self.corpus.iter().map(|entry| entry.both.a.machine.data());
        let states: Vec<&[u16]> = kept.chain(self.states.iter().map(Vec::as_slice)).collect();
        self.unargued = unreachable::rule_out(&mut self.goals, self.surroundings, &states);
    }

    fn open(&self) -> bool {
        self.found.is_none() && self.scans < self.budget
    }

    /// Both sides are scanning and nothing was found.
    fn goes_on(&self) -> bool {
        self.open() && self.both.a.stopped().is_none()
    }

    /// Starts an episode from a state seen before, newer and less used ones more often.
    fn begin(&mut self) {
        if self.states.len() < MOST_STATES && self.both.a.stopped().is_none() {
            self.states.push(self.both.a.machine.data().to_vec());
        }
        self.episodes += 1;
        let count = self.corpus.len();
        let mut best = 0;
        for turn in 0..3 {
            let candidate = if self.random.chance(1, 2) && count > 8 {
                count - 1 - self.random.below(count / 2)
            } else {
                self.random.below(count)
            };
            let used = |index: usize| self.corpus.get(index).map_or(u32::MAX, |entry| entry.used);
            if turn == 0 || used(candidate) < used(best) {
                best = candidate;
            }
        }
        if let Some(entry) = self.corpus.get_mut(best) {
            entry.used += 1;
            self.both.copy_from(&entry.both);
        }
        self.from = best;
        self.tape.clear();
        self.pending.clear();
        let pace = self.random.pick(&PACES).copied().unwrap_or(10);
        self.pace = pace * 1000;
    }

    /// Keeps the present state to go on from.
    fn keep(&mut self) {
        self.goals.fresh.clear();
        let base = self.corpus.get(self.from).map_or(0, |entry| entry.depth);
        let depth = base + self.tape.len();
        if self.corpus.len() >= MOST_ENTRIES || depth > DEEPEST || self.both.a.stopped().is_some() {
            return;
        }
        let entry = Entry { both: self.both.fork(), parent: self.from, tape: self.tape.clone(), depth, used: 0 };
        self.from = self.corpus.len();
        self.corpus.push(entry);
        self.tape.clear();
    }

    /// One scan of both sides with the pending changes, and the comparison.
    fn scan(&mut self, program_run: bool, dt: u32) {
        let dt = if program_run { 0 } else { dt.min(if self.short { SHORT_PACE } else { u32::MAX }) };
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
        if self.quiet < 20_000 || self.scans.is_multiple_of(4) {
            self.both.b.scan_seen(time, &mut self.seen);
        } else {
            self.both.b.scan(time);
        }
        self.goals.look(&self.both.a);
        self.scans += 1;
        self.time += time;
        self.mode_changes += u64::from(program_run);
        self.quiet += 1;
        if let Some(difference) = compare(&self.both, self.pairs, &mut self.buffers) {
            let tape = self.history();
            self.found = Some((difference, tape));
            return;
        }
        if self.both.a.stopped().is_some() {
            match self.both.b.stopped() {
                Some(_) => self.stops += 1,
                None => self.outside += 1,
            }
        }
        if self.seen.take_fresh() | !self.goals.fresh.is_empty() {
            self.quiet = 0;
            self.keep();
        }
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

    fn some_dt(&mut self) -> u32 {
        match self.random.below(8) {
            0 => self.random.pick(&PACES).copied().unwrap_or(10) * 1000,
            1 if self.pace.is_multiple_of(3) => 1000 * (1 + self.random.below(50) as u32),
            _ => self.pace,
        }
    }

    /// A value for an input, unlike the present one where there is a choice.
    fn some_value(&mut self, index: usize) -> u32 {
        let Some(input) = self.inputs.all.get(index) else { return 0 };
        let now = super::inputs::stored(&self.both.a, input.at, input.kind);
        if input.kind == Kind::Bit {
            return 1 - now.min(1);
        }
        match self.random.below(8) {
            0 if !input.bounded && input.kind == Kind::Word => self.random.next() as u32 & 0xFFFF,
            1 if !input.bounded && input.kind == Kind::Word => now.wrapping_add(1) & 0xFFFF,
            2 if !input.bounded && input.kind == Kind::Word => now.wrapping_sub(1) & 0xFFFF,
            3 if input.terminal && input.kind == Kind::Word => now ^ 1 << self.random.below(16),
            _ => self.random.pick(&input.values).copied().unwrap_or(now),
        }
    }

    /// Every input on its own: both edges of bits, every value of words.
    fn each_input(&mut self) {
        for index in 0..self.inputs.all.len() {
            self.from = 0;
            self.episodes += 1;
            self.tape.clear();
            if let Some(entry) = self.corpus.first() {
                self.both.copy_from(&entry.both);
            }
            let values = self.inputs.all.get(index).map(|input| input.values.len().max(2)).unwrap_or(0);
            let number = u16::try_from(index).unwrap_or(u16::MAX);
            for turn in 0..values.min(40) {
                let bit = self.inputs.all.get(index).is_some_and(|input| input.kind == Kind::Bit);
                let value = match self.inputs.all.get(index).and_then(|input| input.values.get(turn)) {
                    Some(value) if !bit => *value,
                    _ => self.some_value(index),
                };
                self.pending.push((number, value));
                for dt in [10_000, 7_000] {
                    if !self.goes_on() {
                        break;
                    }
                    self.scan(false, dt);
                }
            }
            if !self.open() {
                return;
            }
        }
    }

    /// Random changes for a while.
    fn wander(&mut self) {
        let scans = 8 + self.random.below(56);
        let busy = 1 + self.random.below(6);
        for _ in 0..scans {
            if !self.goes_on() {
                return;
            }
            if self.random.chance(1, busy) {
                for _ in 0..1 + self.random.below(3) {
                    self.change();
                }
            }
            if self.random.chance(1, 200) {
                self.scan(true, 0);
            } else {
                let dt = self.some_dt();
                self.scan(false, dt);
            }
        }
    }

    /// Towards a goal that is still open.
    fn aim(&mut self) {
        let missing: Vec<usize> = (0..self.goals.all.len())
            .filter(|index| self.goals.all.get(*index).is_some_and(|goal| !goal.reached && goal.impossible.is_none()))
            .collect();
        let Some(goal) = self.random.pick(&missing).and_then(|index| self.goals.all.get(*index)).cloned() else {
            return self.wander();
        };
        for _ in 0..1 + self.random.below(4) {
            let plan = self.solver.plan(&goal, &self.both.a, &mut self.random);
            if plan.sets.is_empty() && plan.wait == 0 && plan.hold == 0 {
                return self.wander();
            }
            self.carry_out(&plan);
            if !self.goes_on() || self.is_reached(&goal) {
                return;
            }
        }
    }

    fn is_reached(&self, wanted: &super::goals::Goal) -> bool {
        self.goals.all.iter().any(|goal| goal.location == wanted.location && goal.kind == wanted.kind && goal.reached)
    }

    fn carry_out(&mut self, plan: &Plan) {
        for (index, value) in &plan.sets {
            let input = self.inputs.all.get(*index).filter(|input| input.bounded);
            let inside = input.is_none_or(|input| {
                let (least, most) = (input.values.first(), input.values.last());
                least.is_none_or(|least| value >= least) && most.is_none_or(|most| value <= most)
            });
            if inside {
                self.pending.push((u16::try_from(*index).unwrap_or(u16::MAX), *value));
            }
        }
        self.scans_of(1 + plan.sets.len().min(3) as u64);
        if plan.pulses > 0
            && let Some((index, value)) = plan.sets.last().copied()
        {
            let number = u16::try_from(index).unwrap_or(u16::MAX);
            let bit = self.inputs.all.get(index).is_some_and(|input| input.kind == Kind::Bit);
            let opposite = if bit { 1 - value.min(1) } else { 0 };
            for _ in 0..plan.pulses.min(400) {
                self.pending.push((number, opposite));
                self.scans_of(1);
                self.pending.push((number, value));
                self.scans_of(1);
            }
        }
        self.scans_of(plan.hold.into());
        self.pass(plan.wait);
    }

    fn scans_of(&mut self, count: u64) {
        for _ in 0..count {
            if !self.goes_on() {
                return;
            }
            let pace = self.pace;
            self.scan(false, pace);
        }
    }

    /// Lets milliseconds pass and a little more: most of it in few long scans, the end in short ones.
    fn pass(&mut self, milliseconds: u64) {
        if milliseconds == 0 {
            return;
        }
        let total = milliseconds.saturating_mul(1000);
        let pace = u64::from(self.pace);
        // Whole milliseconds: the other side may count nothing finer.
        let coarse = (total.saturating_sub(6 * pace) / 24_000).saturating_mul(1000);
        let coarse = coarse.clamp(pace, LONGEST_PACE.max(pace));
        let mut left = total.saturating_sub(4 * pace);
        let most = LONGEST_WAIT.max(self.budget / PART_OF_ALL);
        let mut scans = 0;
        while left > 0 && scans < most && self.goes_on() {
            let dt = left.min(coarse);
            self.scan(false, u32::try_from(dt).unwrap_or(u32::MAX));
            left -= dt;
            scans += 1;
        }
        self.scans_of(8);
    }

    /// To the millisecond a timer is done in: a preset that is off by one must show.
    fn reach_preset(&mut self) {
        if self.random.chance(1, 2) {
            self.change();
        }
        self.pace = 1000;
        self.scans_of(2);
        // Timers that are timing: their words follow their preset.
        let timing: Vec<(u32, u32)> = self
            .presets
            .iter()
            .copied()
            .filter(|(preset, _)| self.both.a.word(preset - 16) & 0x6000 == 0x4000)
            .collect();
        let Some((preset, base)) = self.random.pick(&timing).copied() else { return self.wait_long() };
        let left = |both: &Both<B>| {
            let counts = i32::from(both.a.word(preset) as i16) - i32::from(both.a.word(preset + 16) as i16);
            u64::from(counts.max(0).unsigned_abs()) * u64::from(base)
        };
        // Counts of the timer first, then milliseconds: part of a count may have passed already.
        let mut most = LONGEST_WAIT;
        while left(&self.both) > u64::from(base) && most > 0 && self.goes_on() {
            let dt = (left(&self.both) - u64::from(base)).clamp(1, LONGEST_PACE / 1000);
            self.scan(false, u32::try_from(dt * 1000).unwrap_or(u32::MAX));
            most -= 1;
        }
        let fine = u64::from(base).min(60) + 3;
        if base > 60 {
            let coarse = self.random.below(base as usize) as u32;
            if self.goes_on() {
                self.scan(false, 1000 * coarse.max(1));
            }
        }
        self.scans_of(fine);
    }

    /// Past presets: one of them, or all one after the other.
    fn wait_long(&mut self) {
        let length = |both: &Both<B>, (preset, base): (u32, u32)| {
            u64::from(both.a.word(preset).min(i16::MAX as u16)) * u64::from(base)
        };
        if self.random.chance(1, 2) {
            self.change();
        }
        let Some(one) = self.random.pick(&self.presets).copied() else { return self.wander() };
        let wait = if self.random.chance(1, 8) {
            self.presets.iter().map(|preset| length(&self.both, *preset)).sum()
        } else {
            length(&self.both, one)
        };
        self.scans_of(2);
        self.pass(wait);
    }

    /// Out of run and back once or a few times, with and without changes meanwhile.
    fn change_mode(&mut self) {
        for _ in 0..1 + self.random.below(3) {
            let before = self.random.below(4) as u64;
            self.scans_of(before);
            if !self.goes_on() {
                return;
            }
            if self.random.chance(1, 2) {
                self.change();
            }
            self.scan(true, 0);
            let after = self.random.below(6) as u64;
            self.scans_of(after);
        }
        self.wander();
    }

    /// One input changes before the next scan.
    fn change(&mut self) {
        if self.inputs.all.is_empty() {
            return;
        }
        let index = self.random.below(self.inputs.all.len());
        let value = self.some_value(index);
        self.pending.push((u16::try_from(index).unwrap_or(u16::MAX), value));
    }

    /// Many short scans of one length with hardly a change: parts of counts of slow timers must add up.
    fn steady(&mut self) {
        if self.random.chance(2, 3) {
            self.change();
        }
        let scans = if self.pace == 1000 { 1100 } else { 250 };
        for _ in 0..scans {
            if !self.goes_on() {
                return;
            }
            if self.random.chance(1, 80) {
                self.change();
            }
            let pace = self.pace;
            self.scan(false, pace);
        }
    }

    /// More time than any counter of milliseconds in 31 bits can hold: what runs for weeks must go on right.
    fn wait_days(&mut self) {
        for _ in 0..900 {
            if !self.goes_on() {
                return;
            }
            if self.random.chance(1, 4) {
                self.change();
            }
            let dt = if self.random.chance(1, 5) { self.pace } else { DAY_PACE };
            self.scan(false, dt);
        }
    }
}

/// Goes to run for the first time.
pub(crate) fn enter<B: Side>(both: &mut Both<B>) {
    both.a.enter_run();
    both.b.enter_run();
}

/// Does to both sides what comes before a scan.
pub(crate) fn apply<B: Side>(both: &mut Both<B>, inputs: &Inputs<B::Target>, head: Head, sets: &[Set]) {
    if head.program_run {
        both.a.leave_run();
        both.b.leave_run();
        write(both, inputs, sets);
        both.a.enter_run();
        both.b.enter_run();
    }
    write(both, inputs, sets);
}

fn write<B: Side>(both: &mut Both<B>, inputs: &Inputs<B::Target>, sets: &[Set]) {
    for (index, value) in sets {
        if let Some(input) = inputs.all.get(usize::from(*index)) {
            both.a.write(&input.a, *value);
            both.b.write(&input.b, *value);
        }
    }
}

/// Compares both sides after a scan.
pub(crate) fn compare<B: Side>(both: &Both<B>, pairs: &Pairs, buffers: &mut [Vec<u8>; 2]) -> Option<Difference> {
    match (both.a.stopped(), both.b.stopped()) {
        (None, None) => pairs.difference(&both.a, &both.b, buffers).map(Difference::Value),
        // Stopped alike: outputs are off on both; data is what the fault left.
        (Some(_), Some(_)) => pairs.output_on(&both.b).map(Difference::Value),
        // The inputs left the conditions under which the programs are the same: nothing follows from it.
        (Some(_), None) if both.a.machine.fault().is_some_and(|fault| pairs.is_stated(fault)) => None,
        (Some(_), None) | (None, Some(_)) if pairs.stops_unknown => None,
        (Some(why), None) => Some(Difference::OriginalStopped(why, both.a.machine.fault().map(|fault| fault.code))),
        (None, Some(why)) => Some(Difference::OtherStopped(why)),
    }
}
