//! What single instructions do in the circuit of a scan.

use batsat::Lit;
use sim::outline::{Binary, Does, Relation, TimerKind, Value, Write};

use super::gates::Number;
use super::scan::Scan;

/// Bits of the control word of timers, counters and control elements.
const ENABLE: u32 = 15;
const TIMING: u32 = 14;
const DONE: u32 = 13;
const OVERFLOW: u32 = 12;
const UNDERFLOW: u32 = 11;
const ERROR: u32 = 11;

/// As wide as the sum of two long words.
const WIDE: usize = 34;

impl Scan<'_> {
    /// An instruction that is executed where `alive` holds, with `power` before it. Answers the power behind
    /// it where that is another.
    pub(super) fn act(&mut self, does: &Does, alive: Lit, power: Lit) -> Option<Lit> {
        let (yes, no) = (self.gates.yes(), self.gates.no());
        let with = self.gates.and(alive, power);
        match *does {
            Does::Contact { bit, closed } => {
                let on = self.bit(bit);
                return Some(self.gates.and(power, if closed { !on } else { on }));
            }
            Does::Coil(bit) => self.set(bit, power, alive),
            Does::Latch(bit) => self.set(bit, yes, with),
            Does::Unlatch(bit) => self.set(bit, no, with),
            Does::OneShot(storage) => {
                let was = self.bit(storage);
                self.set(storage, power, alive);
                return Some(self.gates.and(power, !was));
            }
            Does::Rising { storage, output } => {
                let was = self.bit(storage);
                self.set(storage, power, alive);
                let edge = self.gates.and(power, !was);
                self.set(output, edge, alive);
            }
            Does::Falling { storage, output } => {
                let was = self.bit(storage);
                self.set(storage, power, alive);
                let edge = self.gates.and(!power, was);
                self.set(output, edge, alive);
            }
            Does::Timer { kind, word } => self.timer(kind, word, alive, power),
            Does::Counter { down, word } => self.counter(down, word, alive, power),
            Does::Compare { relation, a, b } => {
                let (a, b) = (self.value(a), self.value(b));
                let holds = self.compare(relation, &a, &b);
                return Some(self.gates.and(power, holds));
            }
            Does::Limit { low, test, high } => {
                let [low, test, high] = [low, test, high].map(|value| self.value(value));
                let swapped = self.compare(Relation::Greater, &low, &high);
                let above = self.compare(Relation::LessOrEqual, &low, &test);
                let below = self.compare(Relation::LessOrEqual, &test, &high);
                let (outside, inside) = (self.gates.or(above, below), self.gates.and(above, below));
                let holds = self.gates.choose(swapped, outside, inside);
                return Some(self.gates.and(power, holds));
            }
            Does::MaskedEqual { source, mask, compare } => {
                let numbers = [source, mask, compare].map(|value| self.value(value));
                let [source, mask, compare] = numbers.map(|number| self.gates.wider(&number, 32));
                let mut holds = yes;
                for ((a, mask), b) in source.iter().zip(&mask).zip(&compare) {
                    let same = self.gates.same(*a, *b);
                    let fits = self.gates.or(same, !*mask);
                    holds = self.gates.and(holds, fits);
                }
                return Some(self.gates.and(power, holds));
            }
            Does::ResetTimer(word) => {
                for bit in [ENABLE, TIMING, DONE] {
                    self.set(word * 16 + bit, no, with);
                }
                self.zero(word + 2, with);
            }
            Does::ResetCounter(word) => {
                for bit in [ENABLE, TIMING, DONE, OVERFLOW, UNDERFLOW] {
                    self.set(word * 16 + bit, no, with);
                }
                self.zero(word + 2, with);
            }
            Does::Move { source, dest } => {
                let number = self.value(source);
                self.store(dest, &number, with);
            }
            Does::Binary { op, a, b, dest } => self.binary(op, a, b, dest, with),
            Does::Copy { from, to, words } => {
                for word in 0..words {
                    let number = self.word(from + word);
                    self.put(to + word, &number, with);
                }
            }
            Does::Fill { value, to, words } => {
                let number = self.gates.number(value.into(), 16);
                (0..words).for_each(|word| self.put(to + word, &number, with));
            }
            Does::Sequencer { control, file, mask, dest } => self.sequencer(control, file, mask, dest, (alive, power)),
            Does::Other { condition, always, ref writes, ref reads, faults } => {
                let when = if always { alive } else { with };
                for place in reads.iter().chain(writes) {
                    self.element(place, when);
                }
                if faults {
                    let fails = self.gates.free();
                    let fails = self.gates.and(when, fails);
                    self.fault(fails);
                }
                for write in writes {
                    self.disturb(when, write);
                }
                if condition {
                    let passes = self.gates.free();
                    return Some(self.gates.and(power, passes));
                }
            }
            // Structure and transfers of control are not for here.
            _ => {}
        }
        None
    }

    /// An element number must stay in its file: elsewhere it is a fault, or leads to other data.
    fn element(&mut self, place: &Write, when: Lit) {
        let (element, elements, strays) = match *place {
            Write::Element { element, elements, strays, .. } => (element, elements, strays),
            Write::Words(..) => return,
            Write::Anywhere => {
                let fails = self.gates.free();
                let fails = self.gates.and(when, fails);
                return self.fault(fails);
            }
        };
        let number = self.value(element);
        let (zero, end) = (Value::Constant(0), Value::Constant(i32::try_from(elements).unwrap_or(i32::MAX)));
        let [zero, end] = [zero, end].map(|value| self.value(value));
        let below = self.compare(Relation::Less, &number, &zero);
        let beyond = self.compare(Relation::GreaterOrEqual, &number, &end);
        let outside = self.gates.or(below, beyond);
        let outside = self.gates.and(when, outside);
        if strays {
            self.stray(outside);
        }
        self.fault(outside);
    }

    fn compare(&mut self, relation: Relation, a: &[Lit], b: &[Lit]) -> Lit {
        let (a, b) = (self.gates.wider(a, WIDE), self.gates.wider(b, WIDE));
        match relation {
            Relation::Equal => self.gates.equal(&a, &b),
            Relation::NotEqual => !self.gates.equal(&a, &b),
            Relation::Less => self.gates.less(&a, &b),
            Relation::GreaterOrEqual => !self.gates.less(&a, &b),
            Relation::Greater => self.gates.less(&b, &a),
            Relation::LessOrEqual => !self.gates.less(&b, &a),
        }
    }

    /// Difference of two values as [`super::super::goals`] looks at it: equal, one below, one above.
    pub(super) fn near(&mut self, a: &[Lit], b: &[Lit]) -> [Lit; 3] {
        let (a, b, yes) = (self.gates.wider(a, WIDE), self.gates.wider(b, WIDE), self.gates.yes());
        let not = |number: &[Lit]| -> Number { number.iter().map(|bit| !*bit).collect() };
        let difference = self.gates.add(&a, &not(&b), yes);
        [0, -1, 1].map(|wanted| {
            let wanted = self.gates.number(wanted, WIDE);
            self.gates.equal(&difference, &wanted)
        })
    }

    fn zero(&mut self, word: u32, when: Lit) {
        let zero = self.gates.number(0, 16);
        self.put(word, &zero, when);
    }

    /// Stores a number; where it does not fit, anything.
    fn store(&mut self, dest: Value, number: &[Lit], when: Lit) {
        let (at, width) = match dest {
            Value::Word(at) => (at, 16),
            Value::Long(at) => (at, 32),
            Value::Constant(_) => return,
        };
        let narrow: Number = self.gates.wider(number, number.len().max(width)).into_iter().take(width).collect();
        let back = self.gates.wider(&narrow, number.len());
        let fits = self.gates.equal(&back, number);
        for (bit, value) in (0..).zip(narrow) {
            let value = if fits == self.gates.yes() {
                value
            } else {
                let unknown = self.gates.free();
                self.gates.choose(fits, value, unknown)
            };
            self.set(at * 16 + bit, value, when);
        }
    }

    fn binary(&mut self, op: Binary, a: Value, b: Value, dest: Value, when: Lit) {
        let (a, b) = (self.value(a), self.value(b));
        let (a, b) = (self.gates.wider(&a, WIDE), self.gates.wider(&b, WIDE));
        let (yes, no) = (self.gates.yes(), self.gates.no());
        let result: Number = match op {
            Binary::Add => self.gates.add(&a, &b, no),
            Binary::Subtract => {
                let b: Number = b.iter().map(|bit| !*bit).collect();
                self.gates.add(&a, &b, yes)
            }
            _ => {
                let pairs = a.iter().zip(&b).map(|(a, b)| (*a, *b));
                pairs
                    .map(|(a, b)| match op {
                        Binary::And => self.gates.and(a, b),
                        Binary::Or => self.gates.or(a, b),
                        _ => !self.gates.same(a, b),
                    })
                    .collect()
            }
        };
        if matches!(op, Binary::Add | Binary::Subtract) {
            return self.store(dest, &result, when);
        }
        // Bits of patterns are kept as they are, what is too many falls off.
        let (at, width) = match dest {
            Value::Word(at) => (at, 16),
            Value::Long(at) => (at, 32),
            Value::Constant(_) => return,
        };
        for (bit, value) in (0..width).zip(result) {
            self.set(at * 16 + bit, value, when);
        }
    }

    fn timer(&mut self, kind: TimerKind, word: u32, alive: Lit, power: Lit) {
        let control = word * 16;
        let (preset, old) = (self.word(word + 1), self.word(word + 2));
        let fresh = self.fresh(word);
        let (enabled, done) = (self.bit(control + ENABLE), self.bit(control + DONE));
        let timing = self.bit(control + TIMING);
        let sign = |number: &[Lit]| number.last().copied();
        let (Some(preset_sign), Some(old_sign)) = (sign(&preset), sign(&old)) else { return };
        let (yes, no) = (self.gates.yes(), self.gates.no());
        let zero = self.gates.number(0, 16);
        let negative = self.gates.or(preset_sign, old_sign);
        let counts = match kind {
            TimerKind::On | TimerKind::Retentive => power,
            TimerKind::Off => {
                let ended = self.gates.and(fresh, !preset_sign);
                let runs = self.gates.and(done, !ended);
                self.gates.or(power, runs)
            }
        };
        let fails = self.gates.all([alive, counts, negative]);
        self.fault(fails);
        let alive = self.gates.and(alive, !fails);
        // How far it counts in this scan nobody knows: between what it has and its preset.
        let counted: Number = (0..15).map(|_| self.gates.free()).chain([no]).collect();
        let (from, to) = match kind {
            TimerKind::On => {
                let running = self.gates.and(enabled, !fresh);
                (self.gates.choose_number(running, &old, &zero), running)
            }
            TimerKind::Retentive => (old.clone(), enabled),
            TimerKind::Off => (old.clone(), timing),
        };
        let at_preset = !self.gates.less(&from, &preset);
        let moves = self.gates.and(to, !at_preset);
        let back = self.gates.less(&counted, &from);
        let over = self.gates.less(&preset, &counted);
        let bounds = [!back, !over].map(|holds| self.gates.or(!moves, holds));
        for bound in bounds {
            // Free bits that nothing else uses: a bound on them takes no state away.
            let relevant = self.gates.or(bound, preset_sign);
            let relevant = self.gates.or(relevant, old_sign);
            self.gates.clause(&[relevant]);
        }
        let sum = self.gates.choose_number(moves, &counted, &from);
        let complete = !self.gates.less(&sum, &preset);
        let (new, is_done, is_timing, is_enabled) = match kind {
            TimerKind::On => {
                let latched = self.gates.all([to, done]);
                let sum = self.gates.choose_number(latched, &from, &sum);
                let complete = self.gates.or(latched, complete);
                let new = self.gates.choose_number(power, &sum, &zero);
                let (done, timing) = (self.gates.and(power, complete), self.gates.and(power, !complete));
                (new, done, timing, power)
            }
            TimerKind::Retentive => {
                let stays = self.gates.or(!power, done);
                let new = self.gates.choose_number(stays, &old, &sum);
                let complete = self.gates.choose(stays, done, complete);
                (new, complete, self.gates.and(power, !complete), power)
            }
            TimerKind::Off => {
                // Entering run with a false rung ends an off-delay: ACC is PRE.
                let ended = self.gates.all([fresh, !power, !preset_sign]);
                let runs = self.gates.and(done, !complete);
                let idle = self.gates.choose_number(done, &sum, &old);
                let idle = self.gates.choose_number(ended, &preset, &idle);
                let new = self.gates.choose_number(power, &zero, &idle);
                let runs = self.gates.and(runs, !ended);
                (new, self.gates.choose(power, yes, runs), self.gates.and(!power, runs), power)
            }
        };
        self.put(word + 2, &new, alive);
        self.set(control + ENABLE, is_enabled, alive);
        self.set(control + TIMING, is_timing, alive);
        self.set(control + DONE, is_done, alive);
        self.executed(word, alive);
    }

    fn counter(&mut self, down: bool, word: u32, alive: Lit, power: Lit) {
        let control = word * 16;
        let follows = control + if down { TIMING } else { ENABLE };
        let was = self.bit(follows);
        let edge = self.gates.and(power, !was);
        let (preset, old) = (self.word(word + 1), self.word(word + 2));
        let (no, step) = (self.gates.no(), self.gates.number(if down { -1 } else { 1 }, 16));
        let next = self.gates.add(&old, &step, no);
        let new = self.gates.choose_number(edge, &next, &old);
        let done = !self.gates.less(&new, &preset);
        self.put(word + 2, &new, alive);
        self.set(follows, power, alive);
        self.set(control + DONE, done, alive);
        let counted = self.gates.and(alive, edge);
        for flag in [OVERFLOW, UNDERFLOW] {
            let unknown = self.gates.free();
            self.set(control + flag, unknown, counted);
        }
    }

    fn sequencer(&mut self, control: u32, file: (u32, u32), mask: Value, dest: u32, (alive, power): (Lit, Lit)) {
        let with = self.gates.and(alive, power);
        let (length, position) = (self.word(control + 1), self.word(control + 2));
        let was = self.bit(control * 16 + ENABLE);
        self.set(control * 16 + ENABLE, power, alive);
        for flag in [DONE, ERROR] {
            let unknown = self.gates.free();
            self.set(control * 16 + flag, unknown, with);
        }
        let (zero, one) = (self.gates.number(0, 16), self.gates.number(1, 16));
        let short = self.compare(Relation::LessOrEqual, &length, &zero);
        let negative = self.compare(Relation::Less, &position, &zero);
        let bad = self.gates.or(short, negative);
        let errs = self.gates.and(with, bad);
        self.minor(errs);
        let first_pass = self.bit(self.outline.first_pass);
        let at_zero = self.gates.equal(&position, &zero);
        let start = self.gates.and(first_pass, at_zero);
        let moves = self.gates.all([with, !bad, !was, !start]);
        let no = self.gates.no();
        let up = self.gates.add(&position, &one, no);
        let last = self.compare(Relation::GreaterOrEqual, &position, &length);
        let next = self.gates.choose_number(last, &one, &up);
        self.put(control + 2, &next, moves);
        let now = self.gates.choose_number(moves, &next, &position);
        // The longest step and the present one must both lie within the file.
        let room = i64::from(file.1.saturating_sub(file.0));
        let room = self.gates.number(room, WIDE);
        let beyond = self.compare(Relation::GreaterOrEqual, &now, &room);
        let long = self.compare(Relation::GreaterOrEqual, &length, &room);
        let outside = self.gates.or(beyond, long);
        let works = self.gates.and(with, !bad);
        let fails = self.gates.and(works, outside);
        self.fault(fails);
        let works = self.gates.and(works, !outside);
        let (mask, old) = (self.value(mask), self.word(dest));
        let mask = self.gates.wider(&mask, 16);
        for ((bit, mask), old) in (0..).zip(mask).zip(old) {
            let unknown = self.gates.free();
            let value = self.gates.choose(mask, unknown, old);
            self.set(dest * 16 + bit, value, works);
        }
    }
}
