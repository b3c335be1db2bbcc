//! Stretches of scans, each with an aim of its own: edges and values of single inputs, goals, presets, long
//! waits, changes of mode, random changes.

use std::time::Duration;

use super::campaign::{Campaign, PACES, TIMING};
use super::goals::Goal;
use super::inputs::Input;
use super::play::Both;
use super::side::{Kind, Side, Slc};
use super::solve::Plan;

/// Scans of a long wait, and the part of all scans it may take if that is more.
pub(super) const LONGEST_WAIT: u64 = 600;
pub(super) const PART_OF_ALL: u64 = 20;
/// Longest time before a scan in a long wait, in microseconds. A controller's watchdog ends far longer ones.
const LONGEST_PACE: u64 = 2_000_000;
/// Times before a scan that hold whole counts of a timer or nearly so, in milliseconds.
const LEAPS: [u32; 18] =
    [9, 11, 20, 99, 100, 101, 300, 999, 1000, 1001, 1999, 2000, 2001, 2999, 3000, 5000, 10_000, 60_001];
/// Changes of a bit before any time has passed.
const EDGES: usize = 40;

impl<B: Side> Campaign<'_, B> {
    fn some_dt(&mut self) -> u32 {
        match self.random.below(10) {
            0 => self.random.pick(&PACES).copied().unwrap_or(10) * 1000,
            // Whole counts of a timer in one scan, and nearly whole ones.
            2 if self.pace.is_multiple_of(2) => self.random.pick(&LEAPS).copied().unwrap_or(10) * 1000,
            3 if self.pace == 50_000 => 1000 * (1 + self.random.below(5000) as u32),
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

    /// A value at an end of the range of an input, or a little inside it; sometimes any value.
    fn some_end(&mut self, index: usize) -> u32 {
        let ends: &[u32] = match self.inputs.all.get(index) {
            Some(input) if !input.bounded && input.kind == Kind::Word => &[0x7FFF, 0x7FFE, 0x8000, 0x8001, 0xFFFF],
            Some(input) if !input.bounded && input.kind == Kind::Long => &[0x7FFF_FFFF, 0x7FFF_FFFE, 1 << 31, u32::MAX],
            _ => &[],
        };
        let end = self.random.pick(ends).copied().filter(|_| self.random.chance(3, 4));
        end.unwrap_or_else(|| self.some_value(index))
    }

    /// Every input on its own: both edges of bits, every value of words.
    pub(super) fn each_input(&mut self) {
        for index in 0..self.inputs.all.len() {
            self.episodes += 1;
            self.begin_at(0);
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

    /// First scans with every bit from outside on and off in turn before any time has passed: what was loaded still
    /// stands then.
    pub(super) fn each_at_once(&mut self) {
        // Nobody writes on the way to run what going there resets.
        let bit = |row: &(usize, &Input<B::Target>)| row.1.kind == Kind::Bit && !row.1.written;
        let bits: Vec<usize> = (0..).zip(&self.inputs.all).filter(bit).map(|row| row.0).collect();
        if (bits.len() * EDGES) as u64 > self.budget / PART_OF_ALL {
            return;
        }
        for index in bits {
            self.episodes += 1;
            self.begin_at(0);
            for _ in 0..EDGES {
                let value = self.some_value(index);
                self.pending.push((u16::try_from(index).unwrap_or(u16::MAX), value));
                if !self.goes_on() {
                    break;
                }
                self.scan(true, 0);
            }
            self.scans_of(2);
            if !self.open() {
                return;
            }
        }
    }

    /// Random changes for a while.
    pub(super) fn wander(&mut self) {
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
    pub(super) fn aim(&mut self) {
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

    /// An instruction is executed again as when it was first, with values at the ends of their range in its words.
    pub(super) fn exercise(&mut self) {
        let index = self.random.below(self.recipes.len());
        let Some(mut recipe) = self.recipes.get(index).cloned() else { return self.wander() };
        if !self.begin_at(recipe.from) {
            return;
        }
        if recipe.before.len() > 0 {
            // Up to the scan before, once: the state is kept.
            for (head, sets) in recipe.before.iter() {
                self.pending.extend_from_slice(sets);
                self.scan(head.program_run, head.dt);
                if !self.goes_on() {
                    return;
                }
            }
            recipe.from = self.kept();
            recipe.before.clear();
            self.keep();
            if self.kept() > recipe.from
                && let Some(place) = self.recipes.get_mut(index)
            {
                place.clone_from(&recipe);
            }
        }
        let Some(goal) = self.goals.all.get(recipe.goal) else { return };
        let (words, numbers) = (self.solver.words(goal, &self.both.a), self.solver.numbers(goal, &self.both.a));
        for index in words {
            let mut value = self.some_end(index);
            // So that a sum or difference with another number ends there, or one beside it.
            if self.random.chance(1, 2)
                && let Some(number) = self.random.pick(&numbers).map(|number| *number as u32)
            {
                value = if self.random.chance(2, 3) { value.wrapping_sub(number) } else { value.wrapping_add(number) };
                value = value.wrapping_add(self.random.below(2) as u32);
            }
            if self.inputs.all.get(index).is_some_and(|input| input.bounded && !input.values.contains(&value)) {
                continue;
            }
            self.pending.push((u16::try_from(index).unwrap_or(u16::MAX), value));
        }
        for (head, sets) in recipe.last.iter() {
            self.pending.extend_from_slice(sets);
            self.scan(head.program_run, head.dt);
        }
        if self.open() && self.both.a.stopped().is_some() && self.both.b.stopped().is_some() {
            self.scan(true, 0);
        }
        self.scans_of(2);
    }

    fn is_reached(&self, wanted: &Goal) -> bool {
        self.goals.all.iter().any(|goal| goal.location == wanted.location && goal.kind == wanted.kind && goal.reached)
    }

    pub(super) fn carry_out(&mut self, plan: &Plan) {
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

    pub(super) fn scans_of(&mut self, count: u64) {
        for _ in 0..count {
            if !self.goes_on() {
                return;
            }
            let pace = self.pace;
            self.scan(false, pace);
        }
    }

    /// Lets milliseconds pass and a little more: most of it in few long scans, the end in short ones.
    pub(super) fn pass(&mut self, milliseconds: u64) {
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

    /// To the millisecond a timer is done or counts in: a preset or factor that is off by one must show.
    pub(super) fn reach_preset(&mut self) {
        // Any of the timers: from a state in which it is timing, if there is one.
        let Some((preset, base)) = self.random.pick(&self.presets).copied() else { return self.wander() };
        if self.both.a.word(preset - 16) & TIMING == 0 {
            self.begin_where(|a| a.word(preset - 16) & TIMING != 0);
        }
        if self.random.chance(1, 3) {
            self.change();
        }
        self.reach((preset, base));
    }

    /// To the millisecond a timer is done or counts in, from the present state.
    pub(super) fn reach(&mut self, (preset, base): (u32, u32)) {
        self.pace = 1000;
        self.scans_of(2);
        match self.random.below(8) {
            // What has counted goes on, or begins anew, behind a change of mode.
            0 if self.goes_on() => {
                self.scan(true, 0);
                self.scans_of(2);
            }
            1 | 2 => self.interrupt(base),
            _ => {}
        }
        if self.both.a.word(preset - 16) & TIMING == 0 {
            return self.wait_long();
        }
        let counts = |a: &Slc| i32::from(a.word(preset) as i16) - i32::from(a.word(preset + 16) as i16);
        let left = u64::from(counts(&self.both.a).max(0).unsigned_abs()) * u64::from(base);
        let tick = self.both.a.word(preset + 16);
        let done = |a: &Slc| a.word(preset - 16) & TIMING == 0;
        let counted = |a: &Slc| a.word(preset + 16) != tick;
        let exact = if self.random.chance(1, 3) { self.lies_ahead(base, counted) } else { None };
        let Some(exact) = exact.or_else(|| self.lies_ahead(left.try_into().unwrap_or(u32::MAX), done)) else {
            return self.pass(left);
        };
        // Mostly just before it, sometimes at it or behind it at once.
        let early = match self.random.below(7) {
            0 => 0,
            // One count too far at once.
            6 => {
                self.scan(false, exact.saturating_add(base).saturating_mul(1000));
                return self.wander();
            }
            1 => 1 + self.random.below(60) as u32,
            near => near as u32 - 1,
        };
        let mut wait = exact.saturating_sub(early);
        while wait > 0 && self.goes_on() {
            // At once, or in a few long scans.
            let dt = if self.random.chance(1, 2) { wait } else { 1 + self.random.below(wait as usize) as u32 };
            let dt = dt.min((LONGEST_PACE / 1000) as u32 * 30);
            self.scan(false, dt * 1000);
            wait -= dt;
        }
        let behind = self.random.below(4) as u64;
        self.scans_of(u64::from(early.min(8)) + behind);
        if self.goes_on() && self.random.chance(1, 6) {
            // Run is left with the timer just done or about to be.
            for _ in 0..self.random.below(4) {
                self.change();
            }
            self.scan(true, 0);
        }
        if self.random.chance(1, 2) {
            self.wander();
        }
    }

    /// Part of a count passes; then an input changes for a few scans and changes back.
    fn interrupt(&mut self, base: u32) {
        let part = 1 + self.random.below(base as usize) as u32;
        if self.goes_on() {
            self.scan(false, part * 1000);
        }
        let index = self.random.below(self.inputs.all.len());
        let Some(input) = self.inputs.all.get(index) else { return };
        let before = super::inputs::stored(&self.both.a, input.at, input.kind);
        let (number, value) = (u16::try_from(index).unwrap_or(u16::MAX), self.some_value(index));
        for value in [value, before] {
            self.pending.push((number, value));
            let scans = 1 + self.random.below(2) as u64;
            self.scans_of(scans);
        }
    }

    /// The least milliseconds before one scan of the original that bring something about, up to `most`.
    fn lies_ahead(&mut self, most: u32, happens: impl Fn(&Slc) -> bool) -> Option<u32> {
        let mut try_it = |dt: u32| {
            self.probe.copy_from(&self.both.a);
            self.probe.scan(Duration::from_millis(dt.into()));
            happens(&self.probe)
        };
        if most == 0 || !try_it(most) {
            return None;
        }
        let (mut before, mut after) = (0, most);
        while after - before > 1 {
            let middle = before + (after - before) / 2;
            if try_it(middle) { after = middle } else { before = middle }
        }
        Some(after)
    }

    /// Past presets: one of them, or all one after the other.
    pub(super) fn wait_long(&mut self) {
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
    pub(super) fn change_mode(&mut self) {
        for _ in 0..1 + self.random.below(3) {
            let before = self.random.below(4) as u64;
            self.scans_of(before);
            if !self.goes_on() {
                return;
            }
            // What changes while nobody looks can be much.
            for _ in 0..self.random.below(4) {
                self.change();
            }
            self.scan(true, 0);
            let after = self.random.below(6) as u64;
            self.scans_of(after);
        }
        self.wander();
    }

    /// One input changes before the next scan.
    pub(super) fn change(&mut self) {
        if self.inputs.all.is_empty() {
            return;
        }
        let index = self.random.below(self.inputs.all.len());
        let value = self.some_value(index);
        self.pending.push((u16::try_from(index).unwrap_or(u16::MAX), value));
    }

    /// Many short scans of one length with hardly a change: parts of counts of slow timers must add up.
    pub(super) fn steady(&mut self) {
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
}
