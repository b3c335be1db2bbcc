//! From a goal back to the inputs that lead there: a search through contacts, coils, timers and counters.
//!
//! It proposes; it proves nothing. What it proposes is tried on both machines like any other input.

use std::collections::HashMap;

use ladder::{Element, Image, Instruction, Operand, Series};

use super::goals::{Goal, GoalKind, Source, is_condition};
use super::random::Random;
use super::side::{Kind, Side, Slc};

/// What writes a bit or a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Does {
    Ote,
    Otl,
    Otu,
    /// TON, RTO: done a preset after power; the place of PRE and milliseconds per count.
    TimerOn(u32, u32),
    /// TOF: done at once with power, not done a preset after it.
    TimerOff(u32, u32),
    /// EN, TT, CU: follows power.
    Power,
    /// CTU, CTD: the place of PRE.
    Counter(u32),
    /// RES.
    Reset,
    /// MOV, CLR and FLL of a constant.
    Store(i64),
    /// ADD of a constant to the word itself: so much in every scan.
    Step(i64),
    /// A one-shot's output.
    Pulse,
}

#[derive(Clone, Copy, Debug)]
struct Writer {
    file: u16,
    rung: u32,
    instruction: u32,
    does: Does,
}

/// Who writes what in the original.
#[derive(Debug)]
pub(crate) struct Solver<'a> {
    image: &'a Image,
    bits: HashMap<u32, Vec<Writer>>,
    words: HashMap<u32, Vec<Writer>>,
    /// Inputs by place.
    inputs: HashMap<u32, usize>,
    kinds: Vec<Kind>,
}

/// What to do to come closer to a goal.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plan {
    /// Inputs and their values.
    pub(crate) sets: Vec<(usize, u32)>,
    /// Time to pass with these inputs, in milliseconds.
    pub(crate) wait: u64,
    /// Rising edges of the last input.
    pub(crate) pulses: u32,
    /// Scans with these inputs: what counts scans needs them.
    pub(crate) hold: u32,
}

/// Steps back from a goal at most.
const DEEPEST: u32 = 14;
/// Scans to hold inputs for at most.
const LONGEST_HOLD: u32 = 2_500;
/// Places looked at for one plan.
const MOST_STEPS: u32 = 400;

impl<'a> Solver<'a> {
    pub(crate) fn new(image: &'a Image, a: &Slc, inputs: impl Iterator<Item = (u32, Kind)>) -> Solver<'a> {
        let (mut by_place, mut kinds) = (HashMap::new(), Vec::new());
        for (index, (at, kind)) in inputs.enumerate() {
            by_place.insert(at, index);
            kinds.push(kind);
        }
        let mut solver = Solver { image, bits: HashMap::new(), words: HashMap::new(), inputs: by_place, kinds };
        for (location, instruction) in crate::instructions(image) {
            let (file, rung, number) = (location.file, location.rung, location.instruction);
            let writer = |does| Writer { file, rung, instruction: number, does };
            solver.instruction(a, instruction, writer);
        }
        solver
    }

    fn instruction(&mut self, a: &Slc, it: &Instruction, writer: impl Fn(Does) -> Writer) {
        let place = |index: usize| {
            let address = it.operands.get(index)?.address().filter(|address| address.is_direct())?;
            a.place(&address.to_string()).ok()
        };
        let Some((at, kind)) = place(0) else { return };
        let mut bit = |at: u32, does| self.bits.entry(at).or_default().push(writer(does));
        match it.mnemonic.name() {
            Some("OTE") => bit(at, Does::Ote),
            Some("OTL") => bit(at, Does::Otl),
            Some("OTU") => bit(at, Does::Otu),
            Some("OSR" | "OSF") if it.operands.len() == 2 => {
                if let Some((at, Kind::Bit)) = place(1) {
                    bit(at, Does::Pulse);
                }
            }
            Some(name @ ("TON" | "TOF" | "RTO")) => {
                let base = ladder::TimeBase::from_control(a.word(at)).map_or(10, ladder::TimeBase::milliseconds);
                let does = if name == "TOF" { Does::TimerOff(at + 16, base) } else { Does::TimerOn(at + 16, base) };
                bit(at + 13, does);
                bit(at + 14, if name == "TOF" { Does::Ote } else { Does::Power });
                bit(at + 15, Does::Power);
                self.words.entry(at + 32).or_default().push(writer(does));
            }
            Some("CTU" | "CTD") => {
                bit(at + 13, Does::Counter(at + 16));
                bit(at + 15, Does::Power);
                bit(at + 14, Does::Power);
                self.words.entry(at + 32).or_default().push(writer(Does::Counter(at + 16)));
            }
            Some("RES") => {
                bit(at + 13, Does::Reset);
                self.words.entry(at + 32).or_default().push(writer(Does::Reset));
            }
            Some("CLR") if kind == Kind::Word => self.words.entry(at).or_default().push(writer(Does::Store(0))),
            _ => {}
        }
        if let (Some("ADD"), Some((to, Kind::Word | Kind::Long))) = (it.mnemonic.name(), place(2)) {
            let step = |index: usize| it.operands.get(index).and_then(Operand::constant)?.as_integer();
            let itself = |index: usize| place(index).is_some_and(|(at, _)| at == to);
            if let Some(step) = step(1).filter(|_| itself(0)).or_else(|| step(0).filter(|_| itself(1))) {
                self.words.entry(to).or_default().push(writer(Does::Step(step)));
            }
        }
        let constant = it.operands.first().and_then(Operand::constant).and_then(|constant| constant.as_integer());
        if let (Some("MOV"), Some(value), Some((to, Kind::Word))) = (it.mnemonic.name(), constant, place(1)) {
            self.words.entry(to).or_default().push(writer(Does::Store(value)));
        }
    }

    /// A proposal for a goal from the present state.
    pub(crate) fn plan(&self, goal: &Goal, a: &Slc, random: &mut Random) -> Plan {
        let mut search = Search { solver: self, a, random, plan: Plan::default(), steps: 0 };
        let location = goal.location;
        let (file, rung, number) = (location.file, location.rung, location.instruction);
        match goal.kind {
            GoalKind::False => search.block(file, rung, number, 0),
            GoalKind::True => search.reach(file, rung, number, 0),
            _ => {
                if let Some(instruction) = self.find(file, rung, number) {
                    match goal.kind {
                        GoalKind::Passes => search.condition(instruction, true, 0),
                        GoalKind::Blocks => search.condition(instruction, false, 0),
                        GoalKind::Equal => search.compare(instruction, Some(0), 0),
                        GoalKind::JustBelow => search.compare(instruction, Some(-1), 0),
                        GoalKind::JustAbove => search.compare(instruction, Some(1), 0),
                        GoalKind::Done | GoalKind::NotDone => search.done(instruction, goal.kind == GoalKind::Done),
                        GoalKind::True | GoalKind::False => {}
                    }
                }
                search.reach(file, rung, number, 0);
            }
        }
        search.plan
    }

    /// What the numbers of the instruction of a goal are now.
    pub(crate) fn numbers(&self, goal: &Goal, a: &Slc) -> Vec<i64> {
        let location = goal.location;
        let found = self.find(location.file, location.rung, location.instruction);
        let operands = found.iter().flat_map(|it| &it.operands);
        operands.filter_map(|operand| Source::of(operand, a)).map(|source| source.value(a)).collect()
    }

    /// Words that hold bits the program writes, and which: what tells its states apart.
    pub(crate) fn flags(&self) -> Vec<(u32, u16)> {
        let mut flags = std::collections::BTreeMap::<u32, u16>::new();
        for at in self.bits.keys() {
            *flags.entry(at >> 4).or_default() |= 1 << (at & 15);
        }
        flags.into_iter().collect()
    }

    /// Inputs among the words of the instruction of a goal.
    pub(crate) fn words(&self, goal: &Goal, a: &Slc) -> Vec<usize> {
        let location = goal.location;
        let found = self.find(location.file, location.rung, location.instruction);
        let addresses = found.iter().flat_map(|it| &it.operands).filter_map(Operand::address);
        let places = addresses.filter(|address| address.is_direct()).filter_map(|it| a.place(&it.to_string()).ok());
        places.filter(|place| place.1 != Kind::Bit).filter_map(|(at, _)| self.inputs.get(&at).copied()).collect()
    }

    fn rung(&self, file: u16, rung: u32) -> Option<&'a ladder::Rung> {
        self.image.program_file(file)?.rungs.get(rung as usize)
    }

    fn find(&self, file: u16, rung: u32, number: u32) -> Option<&'a Instruction> {
        self.rung(file, rung)?.instructions().nth(number as usize)
    }
}

struct Search<'s, 'a> {
    solver: &'s Solver<'a>,
    a: &'s Slc,
    random: &'s mut Random,
    plan: Plan,
    steps: u32,
}

impl Search<'_, '_> {
    fn spent(&mut self, depth: u32) -> bool {
        self.steps += 1;
        depth > DEEPEST || self.steps > MOST_STEPS
    }

    /// Brings power to an instruction, and the program to its file.
    fn reach(&mut self, file: u16, rung: u32, number: u32, depth: u32) {
        if self.spent(depth) {
            return;
        }
        if let Some(found) = self.solver.rung(file, rung) {
            self.way(&found.series, &mut 0, number, depth);
        }
        if file != 2
            && let Some((location, _)) = crate::instructions(self.solver.image).find(|(_, it)| {
                it.mnemonic == "JSR"
                    && it.operands.first().is_some_and(|operand| match operand {
                        Operand::ProgramFile(number) => *number == file,
                        other => other.constant().and_then(|constant| constant.as_integer()) == Some(file.into()),
                    })
            })
        {
            self.reach(location.file, location.rung, location.instruction, depth + 1);
        }
    }

    /// Makes everything before instruction `target` pass; answers whether it stands in this series.
    fn way(&mut self, series: &Series, at: &mut u32, target: u32, depth: u32) -> bool {
        for element in series {
            let first = *at;
            let count = count(element);
            *at += count;
            if target >= first + count {
                self.conduct(element, depth);
                continue;
            }
            if let Element::Branch(branch) = element {
                let mut inner = first;
                for leg in &branch.legs {
                    let size: u32 = leg.iter().map(self::count).sum();
                    if target < inner + size {
                        return self.way(leg, &mut inner, target, depth);
                    }
                    inner += size;
                }
            }
            return true;
        }
        false
    }

    fn conduct(&mut self, element: &Element, depth: u32) {
        match element {
            Element::Instruction(it) if is_condition(it, self.solver.image.family()) => self.condition(it, true, depth),
            Element::Instruction(_) => {}
            Element::Branch(branch) => {
                if let Some(leg) = self.random.pick(&branch.legs) {
                    leg.iter().for_each(|element| self.conduct(element, depth));
                }
            }
        }
    }

    /// Takes power away from an instruction.
    fn block(&mut self, file: u16, rung: u32, number: u32, depth: u32) {
        if self.spent(depth) {
            return;
        }
        let Some(found) = self.solver.rung(file, rung) else { return };
        let mut before = Vec::new();
        gather(&found.series, &mut 0, number, &mut before);
        if let Some(element) = self.random.pick(&before).copied() {
            self.stop(element, depth);
        }
    }

    fn stop(&mut self, element: &Element, depth: u32) {
        match element {
            Element::Instruction(it) => self.condition(it, false, depth),
            Element::Branch(branch) => {
                for leg in &branch.legs {
                    let conditions: Vec<&Element> = leg.iter().collect();
                    if let Some(element) = self.random.pick(&conditions).copied() {
                        self.stop(element, depth);
                    }
                }
            }
        }
    }

    fn condition(&mut self, it: &Instruction, pass: bool, depth: u32) {
        match it.mnemonic.name() {
            Some(name @ ("XIC" | "XIO")) => {
                let address = it.operands.first().and_then(Operand::address).filter(|address| address.is_direct());
                if let Some(Ok((at, _))) = address.map(|address| self.a.place(&address.to_string())) {
                    self.bit(at, (name == "XIC") == pass, depth + 1);
                }
            }
            // An edge: the input before it goes off and on again.
            Some("ONS" | "OSR") => self.plan.pulses = self.plan.pulses.max(1),
            Some("EQU" | "NEQ" | "LES" | "LEQ" | "GRT" | "GEQ" | "LIM" | "MEQ") => {
                let wanted = wanted_difference(it.mnemonic.name().unwrap_or(""), pass, self.random);
                self.compare(it, wanted, depth + 1);
            }
            _ => {}
        }
    }

    fn bit(&mut self, at: u32, on: bool, depth: u32) {
        if let Some(input) = self.solver.inputs.get(&at) {
            self.plan.sets.push((*input, on.into()));
            return;
        }
        if self.spent(depth) || self.a.bit(at) == on && self.random.chance(4, 5) {
            return;
        }
        let writers = self.solver.bits.get(&at).map(Vec::as_slice).unwrap_or_default();
        let word = at - at % 16;
        if on && self.solver.words.contains_key(&word) && !writers.iter().any(|writer| can(writer.does, true)) {
            // A bit of a word that counts: the next value that has it.
            let bit = at % 16;
            let now = i64::from(self.a.word(word));
            self.number(word, (now | 1 << bit) >> bit << bit, depth);
            return;
        }
        let fits: Vec<&Writer> = writers.iter().filter(|writer| can(writer.does, on)).collect();
        let Some(writer) = self.random.pick(&fits).copied().copied() else { return };
        let Writer { file, rung, instruction, does } = writer;
        match (does, on) {
            (Does::Ote | Does::Power | Does::TimerOn(..), false) => self.block(file, rung, instruction, depth),
            (Does::TimerOff(preset, base), false) => {
                self.block(file, rung, instruction, depth);
                self.wait(preset, base);
            }
            (Does::TimerOn(preset, base), true) => {
                self.reach(file, rung, instruction, depth);
                self.wait(preset, base);
            }
            (Does::Counter(preset), true) => {
                let pulses = u32::from(self.a.word(preset));
                self.reach(file, rung, instruction, depth);
                self.plan.pulses = self.plan.pulses.max(pulses.min(i16::MAX as u32) + 1);
            }
            (Does::Pulse, _) => {
                self.reach(file, rung, instruction, depth);
                self.plan.pulses = self.plan.pulses.max(1);
            }
            _ => self.reach(file, rung, instruction, depth),
        }
    }

    fn wait(&mut self, preset: u32, base: u32) {
        let counts = u64::from(self.a.word(preset).min(i16::MAX as u16));
        self.plan.wait = self.plan.wait.saturating_add(counts * u64::from(base) + u64::from(base));
    }

    fn done(&mut self, it: &Instruction, on: bool) {
        let address = it.operands.first().and_then(Operand::address).filter(|address| address.is_direct());
        if let Some(Ok((at, _))) = address.map(|address| self.a.place(&address.to_string())) {
            self.bit(at + 13, on, 0);
        }
    }

    /// Brings the first value to the second one, plus `wanted`.
    fn compare(&mut self, it: &Instruction, wanted: Option<i64>, depth: u32) {
        let Some(wanted) = wanted else { return };
        let (x, y) = match it.mnemonic.name() {
            Some("LIM") => (1, if self.random.chance(1, 2) { 0 } else { 2 }),
            _ => (0, 1),
        };
        let source = |index: usize| it.operands.get(index).and_then(|operand| Source::of(operand, self.a));
        let (Some(x), Some(y)) = (source(x), source(y)) else { return };
        match (x, y) {
            (Source::Word(at) | Source::Long(at), _) if self.number(at, y.value(self.a) + wanted, depth) => {}
            (_, Source::Word(at) | Source::Long(at)) => {
                self.number(at, x.value(self.a) - wanted, depth);
            }
            _ => {}
        }
    }

    /// Brings a word to a value; `false`: nothing is known that does.
    fn number(&mut self, at: u32, value: i64, depth: u32) -> bool {
        if let Some(input) = self.solver.inputs.get(&at) {
            let raw = match self.solver.kinds.get(*input) {
                Some(Kind::Word) => u32::from(value as u16),
                _ => value as u32,
            };
            self.plan.sets.push((*input, raw));
            return true;
        }
        if self.spent(depth) {
            return true;
        }
        let writers = self.solver.words.get(&at).map(Vec::as_slice).unwrap_or_default();
        let Some(writer) = self.random.pick(writers).copied() else { return false };
        let now = i64::from(self.a.word(at) as i16);
        let Writer { file, rung, instruction, does } = writer;
        self.reach(file, rung, instruction, depth);
        match does {
            Does::TimerOn(_, base) | Does::TimerOff(_, base) => {
                let counts = if value >= now { value - now } else { value };
                self.plan.wait += u64::try_from(counts).unwrap_or(0) * u64::from(base);
            }
            Does::Step(step) if step != 0 => {
                let scans = (value - now) / step;
                self.plan.hold = self.plan.hold.max(u32::try_from(scans).unwrap_or(0).min(LONGEST_HOLD) + 1);
            }
            Does::Counter(_) => {
                let counts = if value >= now { value - now } else { value };
                self.plan.pulses = self.plan.pulses.max(u32::try_from(counts).unwrap_or(0));
            }
            _ => {}
        }
        true
    }
}

/// Which difference of the values makes a comparison pass, or not.
fn wanted_difference(name: &str, pass: bool, random: &mut Random) -> Option<i64> {
    let options: &[i64] = match (name, pass) {
        ("EQU" | "MEQ", true) | ("NEQ", false) => &[0],
        ("EQU" | "MEQ", false) | ("NEQ", true) => &[-1, 1],
        ("LES", true) | ("GEQ", false) => &[-1],
        ("LES", false) | ("GEQ", true) => &[0, 1],
        ("LEQ", true) | ("GRT", false) => &[0, -1],
        ("LEQ", false) | ("GRT", true) => &[1],
        _ => &[-1, 0, 1],
    };
    random.pick(options).copied()
}

fn can(does: Does, on: bool) -> bool {
    match does {
        Does::Otl | Does::Pulse => on,
        Does::Otu | Does::Reset => !on,
        Does::Counter(_) => on,
        Does::Store(_) | Does::Step(_) => false,
        Does::Ote | Does::TimerOn(..) | Does::TimerOff(..) | Does::Power => true,
    }
}

/// Instructions of an element.
fn count(element: &Element) -> u32 {
    match element {
        Element::Instruction(_) => 1,
        Element::Branch(branch) => branch.legs.iter().flatten().map(count).sum(),
    }
}

/// Elements in series before instruction `target`.
fn gather<'e>(series: &'e Series, at: &mut u32, target: u32, before: &mut Vec<&'e Element>) {
    for element in series {
        let first = *at;
        let size = count(element);
        *at += size;
        if target >= first + size {
            before.push(element);
            continue;
        }
        if let Element::Branch(branch) = element {
            let mut inner = first;
            for leg in &branch.legs {
                let size: u32 = leg.iter().map(count).sum();
                if target < inner + size {
                    return gather(leg, &mut inner, target, before);
                }
                inner += size;
            }
        }
        return;
    }
}
