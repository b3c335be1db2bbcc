//! Whether the followed scan is what the engine does: everything that is argued rests on it.
//!
//! The engine scans from states of a random run, and from such states with everything that can change set at
//! random. Behind each scan every bit of memory is compared with the same scan followed over fixed values, and
//! with the formulas over all values that arguments use, evaluated for the state the scan began with.

use std::collections::{HashMap, HashSet};
use std::time::Duration;

use analysis::proof::{Driven, Kind, Scope};
use domore::Project;
use domore::engine::{Machine, Program};
use domore::memory::{Data, ElementType, Num, Resolved};

use super::dice::Dice;
use super::facts::{After, Facts, LONGEST};
use super::gates::{Line, OFF, ON, value};
use super::mutate::Mutant;
use super::scan::{Begin, Change, HALTED, Model, Outside, Scan, Start, Why, timed};
use super::words::{bit, constant};

/// Milliseconds before a scan.
const TIMES: [i64; 12] = [1, 7, 10, 13, 50, 990, 1000, 2001, 70_000, 3_599_987, 500_000_000, LONGEST];

/// A scan that was made: what it began with and what it left.
pub(crate) struct Made {
    begin: Begin,
    /// Before the writes.
    before: Memory,
    after: After,
    /// What came from outside: the clock and the like.
    outside: Outside,
    /// Nothing was set at random since power-up.
    reached: bool,
}

/// A machine that runs at random, with what is followed beside it.
pub(crate) struct Walk<'w> {
    name: String,
    model: &'w Model<'w>,
    change: Option<Change<'w>>,
    driven: &'w [Driven],
    machine: Machine,
    /// State that has no place in the machine's memory, as followed.
    hidden: After,
    /// When the time of each timer was taken last, in milliseconds of `now`.
    taken: HashMap<u32, i64>,
    now: i64,
    reached: bool,
    pub(crate) dice: Dice,
    /// Scans compared.
    pub(crate) told: usize,
}

/// All of memory.
struct Memory {
    data: Data,
    hidden: After,
}

impl Start for Memory {
    fn line(&self, bit: u32) -> Line {
        if bit < HALTED { self.data.bit(bit).into() } else { self.hidden.get(&bit).copied().unwrap_or(OFF) }
    }
}

impl<'w> Walk<'w> {
    /// `project` is what runs: the model's with the change, if there is one. `None`: no controller loads it.
    pub(crate) fn new(
        name: String,
        model: &'w Model<'w>,
        (project, change): (&Project, Option<Change<'w>>),
        scope: &'w Scope,
        seed: u64,
    ) -> Option<Walk<'w>> {
        let machine = Machine::new(Program::compile(project, &Default::default()).ok()?);
        Some(Walk {
            name,
            model,
            change,
            driven: &scope.driven,
            machine,
            hidden: model.hidden().collect(),
            taken: HashMap::new(),
            now: 0,
            reached: true,
            dice: Dice(seed),
            told: 0,
        })
    }

    fn below(&mut self, limit: i64) -> i64 {
        self.dice.below(limit.max(1).unsigned_abs()) as i64
    }

    fn some_word(&mut self, bits: u32) -> i64 {
        let any = self.dice.next() as i64;
        let top = 1i64 << (bits - 1);
        let number = match self.below(9) {
            0 => 0,
            1 => any & 7,
            2 => -1 - (any & 3),
            3 | 8 => top - 1 - (any & 1),
            4 => -top + (any & 1),
            5 => any % 2001,
            6 => 999_999_990 + any % 20,
            _ => any,
        };
        // As a number of so many bits with a sign.
        (number << (64 - bits)) >> (64 - bits)
    }

    /// Sets elements with a bit that can change at random, in those bits.
    pub(crate) fn disturb(&mut self, varying: &[u32]) {
        self.reached = false;
        let mut elements: HashMap<(usize, u32), Vec<u32>> = HashMap::new();
        for bit in varying {
            let blocks = self.model.map.blocks();
            let Some(index) = blocks.iter().position(|block| block.bits().contains(bit)) else { continue };
            let block = &blocks[index];
            // The system's own memory is written anew in every scan.
            if !matches!(block.name.as_str(), "ST" | "DST" | "SDT") {
                elements.entry((index, (bit - block.start) / block.element.bits())).or_default().push(*bit);
            }
        }
        let mut elements: Vec<_> = elements.into_iter().collect();
        elements.sort_unstable();
        for ((index, number), bits) in elements {
            if self.below(2) == 0 {
                continue;
            }
            let block = &self.model.map.blocks()[index];
            let name = format!("{}{number}", block.name);
            let first = block.start + number * block.element.bits();
            if block.element == ElementType::Timer {
                self.place(&format!("{name}.Acc"), first, 32, &bits);
                for (flag, at) in [(".Done", 32), (".Reset", 33), (".Zero", 34), (".Timing", 35)] {
                    self.place(&format!("{name}{flag}"), first + at, 1, &bits);
                }
            } else {
                self.place(&name, first, block.element.bits(), &bits);
            }
        }
    }

    fn place(&mut self, address: &str, first: u32, size: u32, bits: &[u32]) {
        let Ok(handle) = self.machine.handle(address) else { return };
        let mask = (0..size).filter(|bit| bits.contains(&(first + bit))).fold(0i64, |mask, bit| mask | 1 << bit);
        let Num::Int(now) = self.machine.number(handle) else { return };
        let some = if size == 1 { self.below(2) } else { self.some_word(size) };
        let number = (now & !mask) | (some & mask);
        let number = if size == 1 { number & 1 } else { (number << (64 - size)) >> (64 - size) };
        self.machine.set_number(handle, Num::Int(number));
    }

    /// One scan of the machine, and the same one followed over fixed values.
    pub(crate) fn step(&mut self) -> Made {
        let first = self.now == 0 && self.machine.scans() == 0;
        let mode = first || self.hidden.get(&HALTED) == Some(&ON) || self.below(30) == 0;
        let time = match self.below(3) {
            _ if first => 0,
            0 => self.below(5000),
            _ => TIMES[self.below(TIMES.len() as i64) as usize],
        };
        let before = Memory { data: self.machine.data().clone(), hidden: self.hidden.clone() };
        if mode {
            self.machine.enter_program();
            self.machine.enter_run();
        }
        // Where the initial values are stored nothing is written: nor is it by runs.
        let writes = if first { Vec::new() } else { self.drive() };
        self.machine.scan(Duration::from_millis(time.unsigned_abs()));
        self.now += time;
        let mut gates = super::gates::Gates::new();
        let mut outside = self.outside();
        let begin = Begin { mode: u32::from(mode), time: constant(time), writes };
        let mut scan = Scan::new(self.model, self.change, &before, (&mut gates, &mut outside)).expect("it is followed");
        scan.run(&begin).unwrap_or_else(|why| panic!("{}: {why}", self.name));
        let after = scan.memory;
        self.check(&before, &after);
        for (bit, line) in &after {
            if timed(*bit).is_some() && *line == ON {
                self.taken.insert(*bit, self.now);
            }
            if *bit >= HALTED {
                self.hidden.insert(*bit, *line);
            }
        }
        Made { begin, before, after, outside, reached: self.reached }
    }

    /// Changes of what people and terminals change; the terminals carry their values in every scan.
    fn drive(&mut self) -> Vec<(u32, Vec<Line>, Line)> {
        let mut writes = Vec::new();
        for driven in self.driven {
            let (place, handle) = (self.model.map.resolve_text(&driven.address), self.machine.handle(&driven.address));
            let (Ok(Resolved::Place(place)), Ok(handle)) = (place, handle) else { panic!("{}", driven.address) };
            let bits = match driven.kind {
                Kind::Bit => 1,
                Kind::Word => 16,
                _ => 32,
            };
            let changes = self.below(3) == 0;
            if changes {
                let number = match (driven.range, bits) {
                    (Some((least, most)), _) => i64::from(least) + self.below(i64::from(most - least) + 1),
                    (_, 1) => self.below(2),
                    _ => self.some_word(bits),
                };
                self.machine.set_number(handle, Num::Int(number));
            }
            // The clock comes from outside in every scan.
            if !driven.address.starts_with("SDT0") {
                let data = self.machine.data();
                // What is not changed may hold what nobody writes there.
                let blocks = self.model.map.blocks();
                let terminal = blocks.iter().any(|block| block.is_input() && block.bits().contains(&place.bit));
                let told = |at: u32| u32::from((changes || terminal) && data.bit(at));
                let word = (0..bits).map(|bit| told(place.bit + bit)).collect();
                writes.push((place.bit, word, u32::from(changes)));
            }
        }
        writes
    }

    /// What came from outside in the scan just made: read back, since programs do not write it.
    fn outside(&self) -> Outside {
        let mut outside = Outside::default();
        for (name, first, count) in self.model.system().expect("system memory") {
            let lines = (first..first + count as u32).map(|bit| u32::from(self.machine.data().bit(bit))).collect();
            outside.put(name, &[], lines);
        }
        for (moved, timer) in self.model.timed() {
            let passed = self.now - self.taken.get(&moved).copied().unwrap_or(self.now);
            let passed = passed.min(i32::MAX.into());
            outside.put("passed", &[timer], (0..31).map(|bit| (passed >> bit & 1) as Line).collect());
        }
        outside
    }

    /// Every bit of memory as followed is what the machine has.
    fn check(&mut self, before: &Memory, after: &After) {
        let number = self.machine.scans();
        let mut followed = before.data.clone();
        for (bit, line) in after.iter().filter(|row| *row.0 < HALTED) {
            assert!(*line < 2, "{}: scan {number}: {} has no value", self.name, self.model.name(*bit));
            followed.set_bit(*bit, *line == ON);
        }
        let data = self.machine.data();
        if followed.bytes() != data.bytes() {
            let all = 0..data.bytes().len() as u32 * 8;
            let differ: Vec<u32> = all.filter(|bit| followed.bit(*bit) != data.bit(*bit)).collect();
            let names: Vec<String> = differ.iter().take(8).map(|bit| self.model.name(*bit)).collect();
            panic!("{}: scan {number}: followed otherwise than executed: {}", self.name, names.join(" "));
        }
        let halted = after.get(&HALTED).copied().unwrap_or(OFF) == ON;
        let stands = self.machine.fork().scan(Duration::ZERO).instructions == 0;
        assert_eq!(halted, stands, "{}: scan {number}: halted", self.name);
        self.told += 1;
    }
}

/// The values of a graph's inputs for a scan that was made; `None`: it began from a state that the program does not
/// allow.
fn inputs(facts: &Facts<'_>, made: &Made) -> Option<HashMap<Line, bool>> {
    let was = |bit: u32| made.before.line(bit);
    let mut lines: Vec<(Line, Line)> = facts.varying().map(|bit| (facts.before(bit), was(bit))).collect();
    let fixed = facts.fixed();
    let varying: HashSet<u32> = facts.varying().collect();
    let data = (0..made.before.data.bytes().len() as u32 * 8).filter(|bit| made.before.data.bit(*bit));
    let others = data.chain(fixed.keys().copied()).filter(|bit| !varying.contains(bit));
    lines.extend(others.map(|bit| (facts.before(bit), was(bit))));
    lines.push((facts.begin.mode, made.begin.mode));
    let mut words = vec![(&facts.begin.time, &made.begin.time)];
    for ((at, word, changes), (same, value, on)) in facts.begin.writes.iter().zip(&made.begin.writes) {
        assert_eq!(at, same);
        words.push((word, value));
        lines.push((*changes, *on));
    }
    for (key, word) in facts.outside.all() {
        words.push((word, made.outside.get(key).expect("it came from outside")));
    }
    for (word, value) in words {
        lines.extend((0..word.len().max(value.len())).map(|at| (bit(word, at), bit(value, at))));
    }
    let fits = lines.iter().all(|(line, on)| *line > 1 || line == on);
    fits.then(|| lines.into_iter().map(|(line, on)| (line, on == ON)).collect())
}

/// Nothing that formulas say differs from a scan that was made; how many bits they say.
fn formulas_say(facts: &Facts<'_>, name: &str, made: &Made, formulas: &After, known: &[Line]) -> Option<usize> {
    let values = facts.gates.evaluate(&inputs(facts, made)?);
    for line in known {
        assert!(value(&values, *line), "{name}: what is taken for granted does not hold");
    }
    for bit in formulas.keys().chain(made.after.keys()) {
        let line = formulas.get(bit).copied().unwrap_or_else(|| facts.before(*bit));
        let is = made.after.get(bit).copied().unwrap_or_else(|| made.before.line(*bit));
        assert_eq!(u32::from(value(&values, line)), is, "{name}: {}", facts.model.name(*bit));
    }
    Some(formulas.len())
}

/// Compares a program, and some of its mutants, with the engine: how many scans were, and how many bits that formulas
/// say. With `relations`, those of the program must hold in every state of the run.
pub(crate) fn compare(
    (name, project): (&str, &Project),
    scope: &Scope,
    mutants: &[&Mutant],
    (scans, relations): (u64, bool),
) -> Result<(usize, usize), Why> {
    let model = Model::new(project)?;
    let mut facts = Facts::new(project, scope)?;
    if relations {
        facts.relate(project, scope)?;
    }
    let varying: Vec<u32> = facts.varying().collect();
    let (mut told, mut said) = (0, 0);
    facts.gates.patience = 2_000;
    for (seed, mutant) in (77..).zip([None].into_iter().chain(mutants.iter().copied().map(Some))) {
        let change = mutant.map(Mutant::change);
        let (what, runs) = mutant.map_or(("unchanged", project), |mutant| (mutant.what.as_str(), &mutant.project));
        let size = facts.gates.size();
        // A mutant that is not followed, or loaded by no controller, is not argued about.
        let Ok(formulas) = formulas(&mut facts, change) else { continue };
        let Some(mut walk) = Walk::new(format!("{name}: {what}"), &model, (runs, change), scope, seed) else {
            continue;
        };
        // The formulas are about scans behind the first one.
        walk.step();
        for number in 0..scans {
            if number > scans / 2 && walk.below(4) > 0 {
                walk.disturb(&varying);
            }
            let made = walk.step();
            // What is known is known of the program itself, in its own states.
            let known = match mutant {
                None if made.reached => facts.known_of(&|_| true),
                _ => facts.given.clone(),
            };
            let bits = formulas_say(&facts, &walk.name, &made, &formulas, &known);
            assert!(bits.is_some() || mutant.is_some(), "{}: a bit that never changes did", walk.name);
            said += bits.unwrap_or(0);
        }
        told += walk.told;
        facts.gates.forget(size);
        facts.outside.forget(size);
    }
    Ok((told, said))
}

/// The formulas that arguments compare.
fn formulas(facts: &mut Facts<'_>, change: Option<Change<'_>>) -> Result<After, Why> {
    let Some(change) = change else { return facts.next(None, &HashMap::new()) };
    let (_, notes) = facts.next_noted(change.place)?;
    let given = facts.given.clone();
    facts.next_changed(change, &HashMap::new(), (&notes, 32), &given)
}
