//! Stretches of days or of very many scans: what comes with time alone, or adds up with every scan.

use std::time::Duration;

use super::campaign::{Campaign, Mark, TIMING};
use super::goals::{Goal, GoalKind};
use super::side::Side;
use super::stretches::{LONGEST_WAIT, PART_OF_ALL};

/// Milliseconds before something that comes with time at which a state is kept.
const SLACKS: [i64; 8] = [0, 1, 2, 5, 40, 300, 2000, 20_000];
/// Such states kept.
const MOST_EVES: usize = 64;
/// Time before a scan where weeks are to pass, in microseconds: no controller scans so slowly, but what it
/// counts must add up the same.
const DAY_PACE: u32 = 3_599_987_000;
/// Scans of a drift: half the numbers of 32 bits in steps of half those of 16, and some.
const DRIFT: u64 = 66_000;
/// Drifts of a run.
const MOST_DRIFTS: u32 = 6;
/// Ways to its end that are tried.
const WAYS_TO_END: usize = 100;
/// Scans between two states of a drift that are gone back to.
const MARK_EVERY: u64 = 1000;
/// Times before them in milliseconds: greatest and least numbers of 16 bits, in tenths and whole ones.
const DRIFT_PACES: [u32; 4] = [3276, 3277, 32_767, 32_768];
/// After so many microseconds the clock that converted timers count by starts anew.
const CLOCK_TURN: u64 = 1_000_000_000_000;
/// Scans that are spent on the way there beside a timed interrupt.
const MOST_TO_TURN: u64 = 1_000_000;
/// Scans between two changes of mode on the way there.
const STAYS: [u64; 4] = [u64::MAX, 2, 3, 5];
/// Ways past it that are tried.
const TRIES_AT_TURN: usize = 6;
/// Milliseconds before it from which on time passes in short scans, at most.
const LONGEST_SLACK: usize = 100_000;

impl<B: Side> Campaign<'_, B> {
    /// So many scans of one length that what grows or falls with each of them comes to an end of 31 bits: mostly
    /// the time of a scan itself, as far as a word holds it.
    pub(super) fn drift(&mut self) {
        if self.drifts == MOST_DRIFTS || u64::from(self.drifts + 1) * DRIFT > self.budget / 4 {
            return self.wander();
        }
        self.drifts += 1;
        let pace = self.random.pick(&DRIFT_PACES).copied().unwrap_or(10) * 1000;
        for _ in 0..1 + self.random.below(3) {
            self.change();
        }
        // With the changes made: a mark is a state between two scans.
        self.scan(false, pace);
        let mut marks: Vec<Mark<B>> = Vec::new();
        for scan in 0..DRIFT {
            if scan % MARK_EVERY == 0 {
                marks.truncate(1);
                marks.insert(0, self.mark());
            }
            if !self.goes_on() {
                break;
            }
            self.scan(false, pace);
        }
        if self.both.a.stopped().is_some()
            && let Some(mark) = marks.last()
        {
            self.vary_end(mark, pace);
        }
    }

    /// A drift ended in a fault: its last scans are made again in many ways, so that what runs over does so at the
    /// same number.
    fn vary_end(&mut self, mark: &Mark<B>, pace: u32) {
        self.return_to(mark);
        let mut scans = 0;
        while self.goes_on() && scans < 2 * MARK_EVERY {
            self.scan(false, pace);
            scans += 1;
        }
        self.return_to(mark);
        for _ in 0..scans.saturating_sub(6) {
            if !self.goes_on() {
                return;
            }
            self.scan(false, pace);
        }
        let near = self.mark();
        let (pace, longest) = (pace / 1000, 2 * pace / 1000);
        for _ in 0..WAYS_TO_END {
            if !self.open() {
                return;
            }
            self.return_to(&near);
            for _ in 0..self.random.below(12) {
                let dt = 1 + self.random.below(longest as usize) as u32;
                if self.goes_on() {
                    self.scan(false, dt * 1000);
                }
            }
            for _ in 0..12 {
                if self.goes_on() && !self.would_stop(pace) {
                    self.scan(false, pace * 1000);
                }
            }
            if !self.goes_on() || !self.would_stop(pace) {
                continue;
            }
            // The time at which it just does not stop, if a longer or shorter one brings that about.
            for other in [1, longest - 1] {
                let before = self.mark();
                let (mut stops, mut goes_on) = (pace, other);
                while stops.abs_diff(goes_on) > 1 && !self.would_stop(goes_on) {
                    let middle = stops.midpoint(goes_on);
                    if self.would_stop(middle) { stops = middle } else { goes_on = middle }
                }
                for dt in [stops, goes_on] {
                    self.return_to(&before);
                    self.scan(false, dt * 1000);
                }
                self.scans_of(1);
                if !self.open() {
                    return;
                }
                self.return_to(&before);
            }
        }
    }

    /// Whether the original would stop in a scan behind so many milliseconds.
    fn would_stop(&mut self, dt: u32) -> bool {
        self.probe.copy_from(&self.both.a);
        let dt = (dt * 1000).min(self.longest());
        self.probe.scan(Duration::from_micros(dt.into()));
        self.probe.stopped().is_some()
    }

    /// More time than any counter of milliseconds in 31 bits can hold: what runs for weeks must go on right.
    pub(super) fn wait_days(&mut self) {
        // With changes, or quietly: a change can stop it all.
        let busy = self.random.chance(1, 2);
        for _ in 0..900 {
            if !self.goes_on() {
                return;
            }
            if busy && self.random.chance(1, 4) {
                self.change();
            }
            let dt = if self.random.chance(1, 5) { self.pace } else { DAY_PACE };
            self.scan(false, dt);
        }
        self.keep_eve();
        self.wander();
    }

    /// To where the clock that converted timers count by starts anew, whatever the program does meanwhile; run is
    /// left again and again on some ways there.
    pub(super) fn reach_age(&mut self) {
        let mut most = LONGEST_WAIT.max(self.budget / PART_OF_ALL);
        if self.short {
            // Scans are short beside a timed interrupt: it takes most of them, or cannot be.
            most = (self.budget - self.budget / 4).min(MOST_TO_TURN);
            let period = self.both.a.machine.timed_interrupt().map_or(0, |(_, period)| period.as_micros());
            let needed = u128::from(CLOCK_TURN).checked_div(period).unwrap_or(u128::MAX);
            if self.aged || u128::from(most) < needed || !self.begin_at(0) {
                return self.wander();
            }
            self.aged = true;
        }
        let stay = if self.short { u64::MAX } else { self.random.pick(&STAYS).copied().unwrap_or(u64::MAX) };
        if stay != u64::MAX {
            // With one of the timers timing, if that can be, and counting anew from here on.
            let timer = self.random.pick(&self.presets).copied();
            self.begin_where(|a| timer.is_some_and(|(preset, _)| a.word(preset - 16) & TIMING != 0));
            self.scan(true, 0);
        }
        let slack = match self.random.below(2) {
            0 => self.random.pick(&SLACKS).copied().unwrap_or(0).unsigned_abs(),
            _ => self.random.below(LONGEST_SLACK) as u64,
        };
        let turn = self.age - self.age % CLOCK_TURN + CLOCK_TURN - slack * 1000;
        let mut scans = 0;
        while self.age < turn && scans < most && self.goes_on() {
            scans += 1;
            if scans % stay == 0 {
                self.scan(true, 0);
            } else {
                let left = u32::try_from(turn - self.age).unwrap_or(u32::MAX);
                self.scan(false, left.min(DAY_PACE));
            }
        }
        if self.age < turn {
            return;
        }
        self.pace = 1000;
        let eve = self.keep_eve();
        if self.short {
            self.pass(slack);
            return self.scans_of(12_000);
        }
        for _ in 0..TRIES_AT_TURN {
            if !eve.is_some_and(|eve| self.begin_at(eve)) || !self.open() {
                return;
            }
            let Some(timer) = self.random.pick(&self.presets).copied() else { return self.pass(slack) };
            let left = if self.random.chance(1, 4) { slack } else { self.left_for(timer, slack).unwrap_or(slack) };
            if left < slack {
                self.pass(slack - left);
                if self.goes_on() {
                    self.scan(true, 0);
                }
            }
            self.pass(left);
            if self.goes_on() {
                self.reach(timer);
            }
        }
    }

    /// Milliseconds, fewer than `most`, after which a timer is timing if run is left and entered first.
    fn left_for(&mut self, (preset, _): (u32, u32), most: u64) -> Option<u64> {
        for _ in 0..8 {
            let left = self.random.below(usize::try_from(most).ok()?) as u64;
            self.probe.copy_from(&self.both.a);
            self.probe.leave_run();
            self.probe.enter_run();
            self.probe.scan(Duration::ZERO);
            for part in 0..24 {
                let rest = if part == 23 { left % 24 } else { 0 };
                self.probe.scan(Duration::from_millis(left / 24 + rest));
            }
            if self.probe.word(preset - 16) & TIMING != 0 {
                return Some(left);
            }
        }
        None
    }

    /// Towards equal values in a comparison of the other program that come with time, whatever it is: a state
    /// shortly before is kept, and what follows is looked at to the millisecond.
    pub(super) fn reach_boundary(&mut self) {
        self.looks = true;
        self.pace = 10_000;
        self.scans_of(1);
        let before = self.seen.gaps().to_vec();
        self.scans_of(1);
        let closer = |(index, gap): (usize, &i64)| {
            let came = before.get(index).map(|before| before - gap);
            (came == Some(10) && *gap > 0).then_some((index, *gap))
        };
        let coming: Vec<(usize, i64)> = self.seen.gaps().iter().enumerate().filter_map(closer).collect();
        let unseen: Vec<(usize, i64)> =
            coming.iter().copied().filter(|(index, _)| !self.seen.was_equal(*index)).collect();
        let chosen = self.random.pick(&unseen).copied();
        let Some((_, gap)) = chosen.or_else(|| self.random.pick(&coming).copied()) else {
            self.looks = false;
            return self.wander();
        };
        let slack = self.random.pick(&SLACKS).copied().unwrap_or(0);
        let mut left = u32::try_from(gap - slack).unwrap_or(0);
        let most = LONGEST_WAIT.max(self.budget / PART_OF_ALL);
        let mut scans = 0;
        while left > 0 && scans < most && self.goes_on() {
            let dt = left.min(self.longest().min(DAY_PACE) / 1000);
            self.scan(false, dt * 1000);
            left -= dt;
            scans += 1;
        }
        self.looks = false;
        if left == 0 {
            self.keep_eve();
        }
        self.pace = 1000;
        if self.random.chance(1, 2) {
            self.change();
        }
        self.scans_of(4);
        self.wander();
    }

    /// Around something that comes with time, such as a clock that starts anew after days: a timer is started shortly
    /// before, and looked at to the millisecond behind it.
    pub(super) fn at_eve(&mut self) {
        let eve = self.random.pick(&self.eves).copied();
        if !eve.is_some_and(|eve| self.begin_at(eve)) {
            return self.aim();
        }
        self.pace = if self.random.chance(1, 2) { 1000 } else { self.pace };
        let timers = |goal: &&Goal| goal.kind == GoalKind::Done && goal.impossible.is_none();
        let all: Vec<Goal> = self.goals.all.iter().filter(timers).cloned().collect();
        for _ in 0..1 + self.random.below(3) {
            let Some(goal) = self.random.pick(&all) else { break };
            let mut plan = self.solver.plan(goal, &self.both.a, &mut self.random);
            plan.wait = 0;
            self.carry_out(&plan);
        }
        let timing = |row: &&(u32, u32)| self.both.a.word(row.0 - 16) & TIMING != 0;
        let running: Vec<(u32, u32)> = self.presets.iter().filter(timing).copied().collect();
        match self.random.pick(&running).copied() {
            Some(timer) if self.goes_on() => self.reach(timer),
            _ => self.wander(),
        }
    }

    /// Keeps the present state as one before something that comes with time; answers its number.
    fn keep_eve(&mut self) -> Option<usize> {
        let number = self.kept();
        if self.goes_on() {
            self.keep();
        }
        // Not all are kept.
        if self.kept() == number {
            return None;
        }
        if self.eves.len() < MOST_EVES {
            self.eves.push(number);
        } else {
            let at = self.random.below(MOST_EVES);
            self.eves.splice(at..=at, [number]);
        }
        Some(number)
    }
}
