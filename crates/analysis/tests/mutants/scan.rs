//! One scan of a Do-more program over all values at once: memory holds lines of a graph of gates.
//!
//! What it does not know it refuses; nothing is said about such a program then.

use std::collections::{HashMap, HashSet};

use domore::address::{Number, Operand, columns};
use domore::instruction::{Effect, Flow, Join, Relation, Test, by_mnemonic};
use domore::math::Expression;
use domore::memory::{Kind, Map, Num, Place, Resolved};
use domore::{CodeBlock, CodeKind, Instruction, Project, Rung};

use super::gates::{Gates, Line, OFF, ON};
use super::meet::{Meeting, Notes, Step, Visit};
pub(crate) use super::outside::Outside;
use super::relations::words_of;
use super::words::{Word, bit, constant, ends, fixed, of_bits, wrapped};

/// Why a program is not followed.
pub(crate) type Why = String;

/// State that has no place in memory stands behind it.
const HIDDEN: u32 = 1 << 30;
/// The program was halted in this scan. All bits from here on have no place in memory.
pub(crate) const HALTED: u32 = HIDDEN;
/// Elements an index may choose from.
const MOST_CHOICES: i64 = 1024;
const MOST_CALLS: usize = 16;
/// Runs of a rung in a scan.
const MOST_RUNS: usize = 2000;

/// A timer that was not enabled when it was processed last.
fn fresh(timer: u32) -> u32 {
    HIDDEN + 1 + 2 * timer
}

/// A timer whose time was taken in this scan.
fn moved(timer: u32) -> u32 {
    HIDDEN + 2 + 2 * timer
}

/// The timer whose time was taken in a scan if the bit is on, with the bit that it starts anew.
pub(crate) fn timed(bit: u32) -> Option<u32> {
    (bit > HIDDEN && bit.is_multiple_of(2)).then_some(bit - 1)
}

/// A program to follow.
pub(crate) struct Model<'m> {
    pub(crate) map: Map,
    blocks: Vec<&'m CodeBlock>,
    /// Block, rung and which one in it.
    timers: HashMap<(usize, usize, usize), u32>,
}

/// A rung that stands in the place of another one, or nothing.
#[derive(Clone, Copy)]
pub(crate) struct Change<'c> {
    pub(crate) place: (usize, usize),
    pub(crate) rung: Option<&'c Rung>,
}

/// Memory before a scan.
pub(crate) trait Start {
    fn line(&self, bit: u32) -> Line;
}

/// How the next scan begins.
pub(crate) struct Begin {
    /// Run was left and entered before it.
    pub(crate) mode: Line,
    /// Milliseconds since the scan before.
    pub(crate) time: Word,
    /// Data changed from outside: first bit, value, and whether it is.
    pub(crate) writes: Vec<(u32, Word, Line)>,
}

/// A number and whether there is one.
type Value = (Word, Line);

enum Source {
    Fixed(i64),
    Place(Place),
    Indexed(usize, String),
}

impl<'m> Model<'m> {
    pub(crate) fn new(project: &'m Project) -> Result<Model<'m>, Why> {
        let map = Map::new(project).map_err(|error| error.why)?;
        let blocks: Vec<&CodeBlock> = project.code_blocks().collect();
        let mut timers = HashMap::new();
        for (block, code) in blocks.iter().enumerate() {
            if !matches!(code.kind, CodeKind::Bare | CodeKind::Program | CodeKind::Subroutine) {
                return Err(format!("{} runs by itself", code.name));
            }
            for (number, rung) in code.rungs.iter().enumerate() {
                for nth in 0..timers_of(rung) {
                    timers.insert((block, number, nth), timers.len() as u32);
                }
            }
        }
        Ok(Model { map, blocks, timers })
    }

    /// The bits of all timers that are not in memory, with what they are at power-up.
    pub(crate) fn hidden(&self) -> impl Iterator<Item = (u32, Line)> {
        (0..self.timers.len() as u32).map(|timer| (fresh(timer), ON))
    }

    /// The timers, each with the bit that its time was taken.
    pub(crate) fn timed(&self) -> impl Iterator<Item = (u32, u32)> {
        (0..self.timers.len() as u32).map(|timer| (moved(timer), timer))
    }

    /// Waves, counts and the clock, which come from outside: name, first bit, bits.
    pub(crate) fn system(&self) -> Result<[(&'static str, u32, usize); 4], Why> {
        let start = |name: &str| self.map.block(name).map(|block| block.start).ok_or("no system memory");
        let (bits, words, date) = (start("ST")?, start("DST")?, start("SDT")?);
        Ok([("waves", bits + 3, 3), ("scans", words, 64), ("state", words + 320, 32), ("date", date, 64)])
    }

    /// These bits with all words of the rungs that name one of them in a word.
    pub(crate) fn around(&self, near: &HashSet<u32>) -> HashSet<u32> {
        let mut all = near.clone();
        for rung in self.blocks.iter().flat_map(|block| &block.rungs) {
            let words = words_of(&self.map, rung);
            if words.iter().any(|bit| near.contains(bit)) {
                all.extend(words);
            }
        }
        all
    }

    /// What a bit is called.
    pub(crate) fn name(&self, bit: u32) -> String {
        let block = self.map.blocks().iter().find(|block| block.bits().contains(&bit));
        match block {
            Some(block) => {
                let (offset, size) = (bit - block.start, block.element.bits());
                format!("{}{}:{}", block.name, offset / size, offset % size)
            }
            None => format!("hidden {}", bit - HIDDEN.min(bit)),
        }
    }

    pub(crate) fn rung<'r>(&self, place: (usize, usize), change: Option<Change<'r>>) -> Option<&'r Rung>
    where
        'm: 'r,
    {
        match change.filter(|change| change.place == place) {
            Some(change) => change.rung,
            None => self.blocks.get(place.0)?.rungs.get(place.1),
        }
    }
}

fn timers_of(rung: &Rung) -> usize {
    rung.instructions.iter().filter(|it| it.is("TMR")).count()
}

/// A scan under way.
pub(crate) struct Scan<'s, S: Start> {
    pub(crate) gates: &'s mut Gates,
    pub(crate) outside: &'s mut Outside,
    model: &'s Model<'s>,
    start: &'s S,
    change: Option<Change<'s>>,
    pub(crate) memory: HashMap<u32, Line>,
    time: Word,
    /// How often each rung of a block ran in this scan.
    runs: HashMap<(usize, usize), usize>,
    /// The instruction that writes now.
    step: Option<Step>,
    /// What is written, where that is noted.
    pub(crate) notes: Option<Notes>,
    /// What another program wrote: what cannot differ from it is taken for equal.
    pub(crate) peer: Option<Meeting<'s>>,
}

impl<'s, S: Start> Scan<'s, S> {
    pub(crate) fn new(
        model: &'s Model<'s>,
        change: Option<Change<'s>>,
        start: &'s S,
        (gates, outside): (&'s mut Gates, &'s mut Outside),
    ) -> Result<Self, Why> {
        if let Some(Change { place, rung: Some(rung) }) = change {
            let usual = model.rung(place, None).map_or(0, timers_of);
            if usual > 1 && usual != timers_of(rung) {
                return Err("which timer is which is not clear".to_owned());
            }
        }
        Ok(Scan {
            gates,
            outside,
            model,
            start,
            change,
            memory: HashMap::new(),
            time: constant(0),
            runs: HashMap::new(),
            step: None,
            notes: None,
            peer: None,
        })
    }

    /// The bit now.
    pub(crate) fn bit(&self, at: u32) -> Line {
        self.memory.get(&at).copied().unwrap_or_else(|| self.start.line(at))
    }

    fn put(&mut self, at: u32, value: Line, power: Line) {
        let before = self.bit(at);
        let after = self.gates.choose(power, value, before);
        if after != before || self.memory.contains_key(&at) {
            self.memory.insert(at, after);
        }
        if let (Some(notes), Some(step)) = (&mut self.notes, self.step) {
            notes.write(step, at, after);
        }
    }

    /// The whole scan with what comes before it.
    pub(crate) fn run(&mut self, begin: &Begin) -> Result<(), Why> {
        self.time.clone_from(&begin.time);
        self.terminate(begin.mode)?;
        for (at, value, changes) in &begin.writes {
            for (index, line) in value.iter().enumerate() {
                self.put(at + index as u32, *line, *changes);
            }
        }
        self.terminals(begin);
        self.system(begin.mode)?;
        self.put(HALTED, OFF, ON);
        for timer in self.model.timers.values() {
            self.put(moved(*timer), OFF, ON);
        }
        for block in 0..self.model.blocks.len() {
            let code = self.model.blocks[block];
            if code.kind == CodeKind::Bare || code.kind == CodeKind::Program && code.name == "$Main" {
                self.block(block, ON, 0)?;
            }
        }
        Ok(())
    }

    fn terminate(&mut self, mode: Line) -> Result<(), Why> {
        for block in 0..self.model.blocks.len() {
            let code = self.model.blocks[block];
            for number in 0..code.rungs.len() {
                let Some(rung) = self.model.rung((block, number), self.change) else { continue };
                for it in rung.instructions.iter().filter(|_| code.kind != CodeKind::Subroutine) {
                    match it.mnemonic.as_str() {
                        "OUT" => {
                            let place = self.place(it.operand(0))?;
                            self.put(place.bit, OFF, mode);
                        }
                        "TMR" => {
                            let at = self.structure(it.operand(0))?;
                            self.clear_timer(at, mode);
                        }
                        _ => {}
                    }
                }
            }
        }
        for timer in self.model.timers.values() {
            self.put(fresh(*timer), ON, mode);
        }
        Ok(())
    }

    fn clear_timer(&mut self, at: u32, power: Line) {
        (0..32).for_each(|bit| self.put(at + bit, OFF, power));
        // Done, reset, zero, timing.
        for (flag, on) in [OFF, ON, ON, OFF].into_iter().enumerate() {
            self.put(at + 32 + flag as u32, on, power);
        }
    }

    /// Inputs are read from their terminals, whatever the program wrote there. Nobody drives the others.
    fn terminals(&mut self, begin: &Begin) {
        let mut read: HashMap<u32, Line> = HashMap::new();
        for (at, value, _) in &begin.writes {
            read.extend((*at..).zip(value.iter().copied()));
        }
        let model = self.model;
        for block in model.map.blocks().iter().filter(|block| block.is_input()) {
            for bit in block.bits() {
                self.put(bit, read.get(&bit).copied().unwrap_or(OFF), ON);
            }
        }
    }

    /// System bits and words: the first scan, always, never; the others are from outside.
    fn system(&mut self, mode: Line) -> Result<(), Why> {
        let bits = self.model.map.block("ST").map(|block| block.start).ok_or("no system memory")?;
        for (number, line) in [(0, mode), (1, ON), (2, OFF)] {
            self.put(bits + number, line, ON);
        }
        for (name, first, count) in self.model.system()? {
            let word = self.outside.word(self.gates, name, &[], count);
            for (index, line) in word.iter().enumerate() {
                self.put(first + index as u32, *line, ON);
            }
        }
        Ok(())
    }

    fn block(&mut self, block: usize, power: Line, depth: usize) -> Result<(), Why> {
        if depth > MOST_CALLS {
            return Err("calls are nested too deeply".to_owned());
        }
        // Loops under way: the rung behind REPEAT, and the power of what runs behind UNTIL.
        let mut loops: Vec<(usize, Line)> = Vec::new();
        let mut active = power;
        let mut number = 0;
        while number < self.model.blocks[block].rungs.len() {
            let run = *self.runs.entry((block, number)).and_modify(|run| *run += 1).or_insert(0);
            if run > MOST_RUNS {
                return Err("a loop that takes long".to_owned());
            }
            let visit = (block, number, run);
            let mut next = number + 1;
            if let Some(rung) = self.model.rung((block, number), self.change) {
                let first = rung.instructions.first();
                if rung.instructions.iter().any(|it| it.is("RET")) {
                    let alone = rung.instructions.len() == 1 && loops.is_empty();
                    return if alone { Ok(()) } else { Err("RET in a rung or loop".to_owned()) };
                }
                if first.is_some_and(|it| it.is("REPEAT")) {
                    loops.push((next, active));
                } else if let Some(until) = first.filter(|it| it.is("UNTIL")) {
                    let (start, around) = loops.pop().ok_or("UNTIL without REPEAT")?;
                    let over = self.contact(Test::On, until)?;
                    active = self.gates.and(active, over ^ 1);
                    if active == OFF {
                        active = around;
                    } else {
                        loops.push((start, around));
                        next = start;
                    }
                } else {
                    if !loops.is_empty() && timers_of(rung) > 0 {
                        return Err("a timer in a loop".to_owned());
                    }
                    self.one(rung, visit, active, depth)?;
                }
            }
            if self.change.is_some_and(|change| change.place == (block, number)) {
                self.meet(visit, None);
            } else if let Some(notes) = &mut self.notes {
                notes.end(visit, &self.memory);
            }
            number = next;
        }
        if loops.is_empty() { Ok(()) } else { Err("REPEAT without UNTIL".to_owned()) }
    }

    /// Takes bits for those the other program has behind the same rung or instruction where they cannot differ, so
    /// that what follows is the same logic.
    fn meet(&mut self, rung: Visit, instruction: Option<usize>) {
        let Some(mut peer) = self.peer.take() else { return };
        let rows = peer.rows(rung, instruction).filter_map(|(bit, line)| {
            let own = self.memory.get(bit).copied().unwrap_or_else(|| self.start.line(*bit));
            (own != *line).then_some((*bit, own, *line))
        });
        let rows = rows.collect();
        for (bit, line) in peer.alike(self.gates, rows) {
            self.memory.insert(bit, line);
        }
        self.peer = Some(peer);
    }

    fn one(&mut self, rung: &Rung, place: Visit, active: Line, depth: usize) -> Result<(), Why> {
        let mut stack: Vec<Line> = Vec::new();
        let mut timers = 0;
        for (index, it) in rung.instructions.iter().enumerate() {
            let entry = by_mnemonic(&it.mnemonic).ok_or_else(|| format!("{} is not known", it.mnemonic))?;
            let missing = || "the stack is empty".to_owned();
            match entry.effect {
                Effect::Contact { join, test } => {
                    let on = self.contact(test, it)?;
                    match join {
                        Join::Push => stack.push(on),
                        Join::And => {
                            let top = stack.pop().ok_or_else(missing)?;
                            stack.push(self.gates.and(top, on));
                        }
                        Join::Or => {
                            let top = stack.pop().ok_or_else(missing)?;
                            stack.push(self.gates.or(top, on));
                        }
                    }
                }
                Effect::Series | Effect::Parallel => {
                    let (b, a) = (stack.pop().ok_or_else(missing)?, stack.pop().ok_or_else(missing)?);
                    let both = if entry.effect == Effect::Series { self.gates.and(a, b) } else { self.gates.or(a, b) };
                    stack.push(both);
                }
                Effect::Flow(Flow::Invert) => {
                    let top = stack.pop().ok_or_else(missing)?;
                    stack.push(top ^ 1);
                }
                Effect::Duplicate => stack.push(*stack.last().ok_or_else(missing)?),
                Effect::Drop => drop(stack.pop().ok_or_else(missing)?),
                Effect::Flow(_) => return Err(format!("{} is not followed", it.mnemonic)),
                Effect::Output | Effect::Box { .. } | Effect::Alone => {
                    if index == 0 {
                        stack.push(ON);
                    }
                    let top = *stack.last().ok_or_else(missing)?;
                    let power = self.gates.and(active, top);
                    let changed = self.change.is_some_and(|change| change.place == (place.0, place.1));
                    self.step = Some((place, index));
                    if it.is("TMR") {
                        let key = (place.0, place.1, timers);
                        timers += 1;
                        let timer = *self.model.timers.get(&key).ok_or("a new timer")?;
                        self.timer(it, timer, active, top)?;
                    } else {
                        self.output(it, power, (active, top), depth)?;
                    }
                    if !changed {
                        self.meet(place, Some(index));
                    }
                }
            }
        }
        Ok(())
    }

    fn contact(&mut self, test: Test, it: &Instruction) -> Result<Line, Why> {
        match test {
            Test::On | Test::Off => {
                let place = self.place(it.operand(0))?;
                if place.kind != Kind::Bit {
                    return Err(format!("{} is no bit", it.operand(0)));
                }
                Ok(self.bit(place.bit) ^ u32::from(test == Test::Off))
            }
            Test::Compare(relation) => {
                let (a, b) = (self.number(it.operand(0))?, self.number(it.operand(1))?);
                Ok(self.compare(relation, &a, &b))
            }
            _ => Err(format!("{} is not followed", it.mnemonic)),
        }
    }

    fn compare(&mut self, relation: Relation, a: &[Line], b: &[Line]) -> Line {
        match relation {
            Relation::Equal => self.gates.equal(a, b),
            Relation::NotEqual => self.gates.equal(a, b) ^ 1,
            Relation::Less => self.gates.less(a, b),
            Relation::GreaterOrEqual => self.gates.less(a, b) ^ 1,
            Relation::Greater => self.gates.less(b, a),
            Relation::LessOrEqual => self.gates.less(b, a) ^ 1,
        }
    }

    /// `power` is the rung's within `active`, the call's; `top` is the rung's alone.
    fn output(&mut self, it: &Instruction, power: Line, at: (Line, Line), depth: usize) -> Result<(), Why> {
        let operand = |index: usize| it.operand(index);
        match it.mnemonic.as_str() {
            "NOP" | "END" => {}
            "OUT" | "SET" | "RST" => {
                let place = self.place(operand(0))?;
                if place.kind != Kind::Bit {
                    return Err(format!("{} is no bit", operand(0)));
                }
                match it.mnemonic.as_str() {
                    "OUT" => self.put(place.bit, at.1, at.0),
                    "SET" => self.put(place.bit, ON, power),
                    _ => self.put(place.bit, OFF, power),
                }
            }
            "RSTR" => {
                let (first, last) = (self.place(operand(0))?, self.place(operand(1))?);
                if first.kind != Kind::Bit || last.kind != Kind::Bit || last.bit < first.bit {
                    return Err("no range of bits".to_owned());
                }
                (first.bit..=last.bit).for_each(|bit| self.put(bit, OFF, power));
            }
            _ if power == OFF => {}
            "MOVE" => {
                let value = self.number(operand(0))?;
                self.store(operand(1), (value, ON), power)?;
            }
            "MATH" => {
                let Operand::Quoted(text) = self.operand(operand(1))? else { return Err("no expression".to_owned()) };
                let value = self.expression(&text)?;
                self.store(operand(0), value, power)?;
            }
            "INIT" => {
                for row in self.table(operand(0), 3)?.chunks(3) {
                    let [first, last, value] = row else { return Err("no row".to_owned()) };
                    let (first, last) = (self.place(first)?, self.place(last)?);
                    let value = self.number(value)?;
                    let size = size(first.kind)?;
                    for number in 0..=(last.bit.saturating_sub(first.bit)) / size {
                        self.keep(Place { bit: first.bit + number * size, ..first }, &value, power)?;
                    }
                }
            }
            "COPY" => {
                for row in self.table(operand(1), 4)?.chunks(4) {
                    let [_, from, to, count] = row else { return Err("no row".to_owned()) };
                    let (from, to) = (self.place(from)?, self.place(to)?);
                    let count = fixed(&self.number(count)?).ok_or("a count that changes")?;
                    let (size, other) = (size(from.kind)?, size(to.kind)?);
                    let count = u32::try_from(count).map_err(|error| error.to_string())?;
                    let values: Vec<Word> = (0..count)
                        .map(|number| self.load(Place { bit: from.bit + number * size, ..from }))
                        .collect::<Result<_, _>>()?;
                    for (number, value) in (0..).zip(values) {
                        self.keep(Place { bit: to.bit + number * other, ..to }, &value, power)?;
                    }
                }
            }
            "CALL" => {
                if !self.table(operand(3), 3)?.is_empty() || !self.table(operand(4), 3)?.is_empty() {
                    return Err("a call with parameters".to_owned());
                }
                let name = operand(0);
                let found = self.model.blocks.iter().position(|block| block.name.eq_ignore_ascii_case(name));
                self.block(found.ok_or("no such code block")?, power, depth + 1)?;
            }
            "HALT" if operand(0) == "$Main" => self.put(HALTED, ON, power),
            other => return Err(format!("{other} is not followed")),
        }
        Ok(())
    }

    fn timer(&mut self, it: &Instruction, timer: u32, active: Line, enable: Line) -> Result<(), Why> {
        let at = self.structure(it.operand(0))?;
        let preset = self.number(it.operand(1))?;
        if ends(&preset).0 < i32::MIN.into() {
            return Err("a preset below all numbers".to_owned());
        }
        let most = constant(i32::MAX.into());
        let above = self.gates.less(&most, &preset);
        let preset = self.gates.choose_word(above, &most, &preset);
        let acc = self.load(Place { kind: Kind::I32, bit: at, read_only: false })?;
        let was_fresh = self.bit(fresh(timer));
        // What runs in every scan sees the time of the scan; the others the time since they ran.
        let passed = match active {
            ON => self.time.clone(),
            _ => {
                let word = self.outside.word(self.gates, "passed", &[timer], 31);
                of_bits(word, false)
            }
        };
        let elapsed = self.gates.choose_word(was_fresh, &constant(0), &passed);
        let sum = self.gates.add(&acc, &elapsed);
        let over = self.gates.less(&most, &sum);
        let sum = self.gates.choose_word(over, &most, &sum);
        let done = self.gates.less(&sum, &preset) ^ 1;
        let value = self.gates.choose_word(enable, &sum, &constant(0));
        for index in 0..32 {
            self.put(at + index, bit(&value, index as usize), active);
        }
        let zero = self.gates.equal(&value, &constant(0));
        let done = self.gates.and(enable, done);
        for (flag, line) in [done, enable ^ 1, zero, enable, enable, OFF, OFF, OFF].into_iter().enumerate() {
            self.put(at + 32 + flag as u32, line, active);
        }
        self.put(fresh(timer), enable ^ 1, active);
        let taken = self.gates.and(active, enable);
        self.put(moved(timer), ON, taken);
        Ok(())
    }

    fn table(&self, text: &str, width: usize) -> Result<Vec<String>, Why> {
        let Operand::Quoted(inside) = self.operand(text)? else { return Err("no table".to_owned()) };
        let mut cells = columns(&inside).map_err(|error| error.to_string())?;
        if cells.is_empty() || cells.remove(0) != width.to_string() {
            return Err("another table".to_owned());
        }
        Ok(cells)
    }

    fn operand(&self, text: &str) -> Result<Operand, Why> {
        Operand::parse_with(text, |block| self.model.map.radix(block)).map_err(|error| error.to_string())
    }

    fn source(&self, operand: &Operand) -> Result<Source, Why> {
        let address = match operand {
            Operand::Constant(constant) => {
                return match constant.value {
                    Number::Integer(value) => Ok(Source::Fixed(value)),
                    Number::Real(_) => Err("reals are not followed".to_owned()),
                };
            }
            Operand::Quoted(_) => return Err("a text".to_owned()),
            Operand::Address(address) => address,
        };
        match self.model.map.resolve(address).map_err(|error| error.why)? {
            Resolved::Place(place) => Ok(Source::Place(place)),
            Resolved::Constant(Num::Int(value)) => Ok(Source::Fixed(value)),
            Resolved::Indexed { block, expression } if address.field.is_none() && address.cast.is_none() => {
                Ok(Source::Indexed(block, expression))
            }
            _ => Err(format!("{address} is not followed")),
        }
    }

    /// Where something is that is named directly.
    pub(crate) fn place(&self, text: &str) -> Result<Place, Why> {
        match self.source(&self.operand(text)?)? {
            Source::Place(place) => Ok(place),
            _ => Err(format!("{text} is no place")),
        }
    }

    fn structure(&self, text: &str) -> Result<u32, Why> {
        match self.model.map.resolve_text(text).map_err(|error| error.why)? {
            Resolved::Structure(_, at) => Ok(at),
            _ => Err(format!("{text} is no structure")),
        }
    }

    pub(crate) fn load(&self, place: Place) -> Result<Word, Why> {
        let bits = (0..size(place.kind)?).map(|index| self.bit(place.bit + index)).collect();
        Ok(of_bits(bits, matches!(place.kind, Kind::I8 | Kind::I16 | Kind::I32)))
    }

    fn keep(&mut self, place: Place, value: &[Line], power: Line) -> Result<(), Why> {
        if self.model.map.block("SDT").is_some_and(|block| (block.start..block.start + 64).contains(&place.bit)) {
            return Err("it sets the clock".to_owned());
        }
        if place.kind == Kind::Bit {
            let on = self.gates.is_on(value);
            self.put(place.bit, on, power);
            return Ok(());
        }
        for index in 0..size(place.kind)? {
            self.put(place.bit + index, bit(value, index as usize), power);
        }
        Ok(())
    }

    /// The elements an index can mean, each with the line that it does.
    fn choices(&mut self, block: usize, expression: &str) -> Result<Vec<(Place, Line)>, Why> {
        let (index, there) = self.expression(expression)?;
        let block = self.model.map.blocks().get(block).ok_or("no such block")?.clone();
        let (least, most) = self.range(expression, &index)?;
        let (least, most) = (least.max(0), most.min(i64::from(block.count) - 1));
        if most - least > MOST_CHOICES {
            return Err("an index with too many values".to_owned());
        }
        let mut all = Vec::new();
        for number in least..=most {
            let place = block.place(u32::try_from(number).unwrap_or(0)).ok_or("no element")?;
            let meant = self.gates.equal(&index, &constant(number));
            all.push((place, self.gates.and(meant, there)));
        }
        Ok(all)
    }

    /// The least and greatest number an index can be: of a sum from its parts.
    fn range(&mut self, expression: &str, index: &[Line]) -> Result<(i64, i64), Why> {
        use domore::math::Binary;
        let radix = |block: &str| self.model.map.radix(block);
        let parsed = Expression::parse_with(expression, &radix).map_err(|error| error.to_string())?;
        if let Expression::Binary(Binary::Add, left, right) = &parsed {
            let (left, right) = (self.evaluate(left)?.0, self.evaluate(right)?.0);
            let ((a, b), (c, d)) = (ends(&left), ends(&right));
            if a + c >= i32::MIN.into() && b + d <= i32::MAX.into() {
                return Ok((a + c, b + d));
            }
        }
        Ok(ends(index))
    }

    fn value(&mut self, operand: &Operand) -> Result<Value, Why> {
        match self.source(operand)? {
            Source::Fixed(value) => Ok((constant(value), ON)),
            Source::Place(place) => Ok((self.load(place)?, ON)),
            Source::Indexed(block, expression) => {
                let (mut found, mut there) = (constant(0), OFF);
                for (place, meant) in self.choices(block, &expression)? {
                    let value = self.load(place)?;
                    found = self.gates.choose_word(meant, &value, &found);
                    there = self.gates.or(there, meant);
                }
                Ok((found, there))
            }
        }
    }

    /// A number of an instruction: 0 where an index leads nowhere.
    fn number(&mut self, text: &str) -> Result<Word, Why> {
        let operand = self.operand(text)?;
        Ok(self.value(&operand)?.0)
    }

    fn store(&mut self, text: &str, (mut value, there): Value, power: Line) -> Result<(), Why> {
        let power = self.gates.and(power, there);
        if let Some(step) = self.step {
            if let Some(notes) = &mut self.notes {
                notes.store(step, &value, power);
            }
            if let Some(peer) = &mut self.peer {
                peer.store(self.gates, step, &mut value, power);
            }
        }
        match self.source(&self.operand(text)?)? {
            Source::Fixed(_) => Err("a constant".to_owned()),
            Source::Place(place) => self.keep(place, &value, power),
            Source::Indexed(block, expression) => {
                for (place, meant) in self.choices(block, &expression)? {
                    let power = self.gates.and(power, meant);
                    self.keep(place, &value, power)?;
                }
                Ok(())
            }
        }
    }

    fn expression(&mut self, text: &str) -> Result<Value, Why> {
        let radix = |block: &str| self.model.map.radix(block);
        let expression = Expression::parse_with(text, &radix).map_err(|error| error.to_string())?;
        self.evaluate(&expression)
    }

    fn evaluate(&mut self, expression: &Expression) -> Result<Value, Why> {
        use domore::math::{Binary, Unary};
        Ok(match expression {
            Expression::Operand(Operand::Constant(number)) => match number.value {
                Number::Integer(value) => (constant((value as i32).into()), ON),
                Number::Real(_) => return Err("reals are not followed".to_owned()),
            },
            Expression::Operand(operand) => self.value(operand)?,
            Expression::Unary(operator, operand) => {
                let (word, there) = self.evaluate(operand)?;
                let word = match operator {
                    Unary::Negate => {
                        let negated = self.gates.subtract(&constant(0), &word);
                        wrapped(&negated, 32)
                    }
                    Unary::Invert => self.gates.bitwise(&word, &constant(-1), Gates::xor),
                    Unary::Not => vec![self.gates.is_on(&word) ^ 1, OFF],
                };
                (word, there)
            }
            Expression::Binary(operator @ (Binary::And | Binary::Or), left, right) => {
                let ((left, there), (right, also)) = (self.evaluate(left)?, self.evaluate(right)?);
                let (left, right) = (self.gates.is_on(&left), self.gates.is_on(&right));
                let decided = if *operator == Binary::And { left ^ 1 } else { left };
                let on =
                    if *operator == Binary::And { self.gates.and(left, right) } else { self.gates.or(left, right) };
                let needed = self.gates.or(decided, also);
                (vec![on, OFF], self.gates.and(there, needed))
            }
            Expression::Binary(operator, left, right) => {
                let ((left, there), (right, also)) = (self.evaluate(left)?, self.evaluate(right)?);
                let there = self.gates.and(there, also);
                let (word, has) = self.binary(*operator, &left, &right)?;
                (word, self.gates.and(there, has))
            }
            Expression::Call(function, arguments) => match (function.name, arguments.as_slice()) {
                ("IF", [condition, on, off]) => {
                    let (condition, there) = self.evaluate(condition)?;
                    let select = self.gates.is_on(&condition);
                    let ((on, has), (off, also)) = (self.evaluate(on)?, self.evaluate(off)?);
                    let word = self.gates.choose_word(select, &on, &off);
                    let taken = self.gates.choose(select, has, also);
                    (word, self.gates.and(there, taken))
                }
                (name, _) => return Err(format!("{name} is not followed")),
            },
        })
    }

    fn binary(&mut self, operator: domore::math::Binary, a: &[Line], b: &[Line]) -> Result<Value, Why> {
        use domore::math::Binary;
        let truth = |line: Line| Ok((vec![line, OFF], ON));
        let relation = match operator {
            Binary::Equal => Some(Relation::Equal),
            Binary::NotEqual => Some(Relation::NotEqual),
            Binary::Less => Some(Relation::Less),
            Binary::LessOrEqual => Some(Relation::LessOrEqual),
            Binary::Greater => Some(Relation::Greater),
            Binary::GreaterOrEqual => Some(Relation::GreaterOrEqual),
            _ => None,
        };
        if let Some(relation) = relation {
            return truth(self.compare(relation, a, b));
        }
        let word = match (operator, fixed(a), fixed(b)) {
            (Binary::Add, ..) => self.gates.add(a, b),
            (Binary::Subtract, ..) => self.gates.subtract(a, b),
            (Binary::BitAnd, ..) => self.gates.bitwise(a, b, Gates::and),
            (Binary::BitOr, ..) => self.gates.bitwise(a, b, Gates::or),
            (Binary::BitXor, ..) => self.gates.bitwise(a, b, Gates::xor),
            (Binary::Multiply, _, Some(factor)) => self.gates.times(a, factor),
            (Binary::Multiply, Some(factor), _) => self.gates.times(b, factor),
            (Binary::Divide, _, Some(divisor)) if divisor > 0 => self.gates.divide(a, divisor).0,
            (Binary::Remainder, _, Some(divisor)) if divisor > 0 => self.gates.divide(a, divisor).1,
            // Without a divisor there is no value.
            (Binary::Divide | Binary::Remainder, _, Some(0)) => return Ok((constant(0), OFF)),
            _ => return Err(format!("{operator:?} of two values is not followed")),
        };
        Ok((wrapped(&word, 32), ON))
    }
}

fn size(kind: Kind) -> Result<u32, Why> {
    match kind {
        Kind::Bit => Ok(1),
        Kind::U8 | Kind::I8 => Ok(8),
        Kind::U16 | Kind::I16 => Ok(16),
        Kind::I32 | Kind::U32 => Ok(32),
        Kind::F32 | Kind::Text(_) => Err("reals and texts are not followed".to_owned()),
    }
}
