//! Relations between bits and words that hold after every scan: proposed from the words of each rung and what
//! a random run shows, kept where one scan from any state in which all of them hold keeps them.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::time::Duration;

use analysis::proof::{Kind, Scope};
use domore::address::{Constant, Number, Operand};
use domore::engine::{Handle, Machine, Program};
use domore::math::{Binary, Expression};
use domore::memory::{Data, Kind as MemoryKind, Map, Num, Place, Resolved};
use domore::{Project, Rung};

use super::facts::Facts;
use super::gates::{Answer, Line, ON, value};
use super::scan::Why;
use super::words::{Word, constant, of_bits};

/// A number of a relation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Part {
    Fixed(i64),
    /// First bit, bits.
    Word(u32, u32),
}

/// One side of an alternative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Atom {
    Bit(u32, bool),
    LessOrEqual(Part, Part),
    Less(Part, Part),
    Equal(Part, Part),
}

/// At least one of these holds.
pub(crate) type Clause = Vec<Atom>;

/// States a random run is looked at in.
const SAMPLES: usize = 1500;
const MOST_CLAUSES: usize = 6000;
/// Elements of a row that are looked at.
const LONGEST_ROW: u32 = 32;

impl Part {
    fn read(self, data: &Data) -> i64 {
        match self {
            Part::Fixed(value) => value,
            Part::Word(bit, bits) => {
                let kind = if bits == 16 { MemoryKind::I16 } else { MemoryKind::I32 };
                match data.number(Place { kind, bit, read_only: false }) {
                    Num::Int(value) => value,
                    Num::Real(_) => 0,
                }
            }
        }
    }

    fn word(self, line: &dyn Fn(u32) -> Line) -> Word {
        match self {
            Part::Fixed(value) => constant(value),
            Part::Word(at, bits) => of_bits((at..at + bits).map(line).collect(), true),
        }
    }

    fn bits(self) -> std::ops::Range<u32> {
        match self {
            Part::Fixed(_) => 0..0,
            Part::Word(at, bits) => at..at + bits,
        }
    }
}

impl Atom {
    fn holds(self, data: &Data) -> bool {
        match self {
            Atom::Bit(at, on) => data.bit(at) == on,
            Atom::LessOrEqual(a, b) => a.read(data) <= b.read(data),
            Atom::Less(a, b) => a.read(data) < b.read(data),
            Atom::Equal(a, b) => a.read(data) == b.read(data),
        }
    }
}

/// Whether a clause speaks of one of these bits.
pub(crate) fn speaks_of(clause: &Clause, of: &dyn Fn(u32) -> bool) -> bool {
    clause.iter().any(|atom| match *atom {
        Atom::Bit(at, _) => of(at),
        Atom::LessOrEqual(a, b) | Atom::Less(a, b) | Atom::Equal(a, b) => a.bits().chain(b.bits()).any(of),
    })
}

/// The line that a clause holds in a memory.
pub(crate) fn line_of(facts: &mut Facts<'_>, clause: &Clause, memory: &dyn Fn(u32) -> Line) -> Line {
    let mut any = 0;
    for atom in clause {
        let line = match *atom {
            Atom::Bit(at, on) => memory(at) ^ u32::from(!on),
            Atom::LessOrEqual(a, b) => facts.gates.less(&b.word(memory), &a.word(memory)) ^ 1,
            Atom::Less(a, b) => facts.gates.less(&a.word(memory), &b.word(memory)),
            Atom::Equal(a, b) => facts.gates.equal(&a.word(memory), &b.word(memory)),
        };
        any = facts.gates.or(any, line);
    }
    any
}

/// Keeps of `clauses` those that one scan keeps: `before` and `after` are the memories around it, `given` what
/// else is known before it.
pub(crate) fn kept(
    facts: &mut Facts<'_>,
    clauses: Vec<Clause>,
    before: &dyn Fn(u32) -> Line,
    after: &dyn Fn(u32) -> Line,
    given: &[Line],
) -> Vec<Clause> {
    let mut rows: Vec<(Clause, Line, Line)> = clauses
        .into_iter()
        .map(|clause| {
            let (was, is) = (line_of(facts, &clause, before), line_of(facts, &clause, after));
            (clause, was, is)
        })
        .collect();
    loop {
        let all = rows.iter().fold(ON, |all, row| facts.gates.and(all, row.1));
        let broken = rows.iter().fold(0, |broken, row| facts.gates.or(broken, row.2 ^ 1));
        let known: Vec<Line> = given.iter().copied().chain([all]).collect();
        match facts.gates.ask(broken, &known) {
            Answer::Never => break,
            Answer::Values(values) => rows.retain(|row| value(&values, row.2)),
            Answer::Open => {
                // One by one: what cannot be decided is not used.
                let count = rows.len();
                let mut index = 0;
                while index < rows.len() {
                    match facts.gates.ask(rows[index].2 ^ 1, &known) {
                        Answer::Never => index += 1,
                        _ => drop(rows.remove(index)),
                    }
                }
                if rows.len() == count {
                    break;
                }
            }
        }
    }
    rows.into_iter().map(|row| row.0).collect()
}

/// The relations of a program.
pub(crate) fn find(facts: &mut Facts<'_>, project: &Project, scope: &Scope) -> Result<Vec<Clause>, Why> {
    let samples = samples(project, scope)?;
    let varying: BTreeSet<u32> = facts.varying().collect();
    let mut clauses = BTreeSet::new();
    for rung in project.code_blocks().flat_map(|code| &code.rungs) {
        propose(&facts.model.map, rung, &varying, &samples, &mut clauses);
    }
    let mut clauses: Vec<Clause> = clauses.into_iter().collect();
    clauses.sort_by_key(Vec::len);
    clauses.truncate(MOST_CLAUSES);
    let mut outside = Default::default();
    let first = facts.first_scan(None, &mut outside)?;
    let after_first = |bit: u32| first.get(&bit).copied().unwrap_or(0);
    let mut holding = Vec::new();
    for clause in clauses {
        if line_of(facts, &clause, &after_first) == ON {
            holding.push(clause);
        }
    }
    let next = facts.next(None, &HashMap::new())?;
    let before: HashMap<u32, Line> = varying.iter().map(|bit| (*bit, facts.before(*bit))).collect();
    let fixed = facts.fixed();
    let was = |bit: u32| before.get(&bit).copied().unwrap_or_else(|| fixed.get(&bit).copied().unwrap_or(0));
    let is = |bit: u32| next.get(&bit).copied().unwrap_or_else(|| was(bit));
    let given = facts.given.clone();
    Ok(kept(facts, holding, &was, &is, &given))
}

/// What a rung names.
struct Named {
    bits: BTreeSet<u32>,
    words: BTreeSet<Part>,
    numbers: BTreeSet<i64>,
    /// A bit and a word that one index chooses.
    pairs: BTreeSet<(u32, Part)>,
}

impl Named {
    fn of(map: &Map, rung: &Rung) -> Named {
        let (mut bits, mut words, mut numbers) = (BTreeSet::new(), BTreeSet::new(), BTreeSet::from([0]));
        let mut rows = BTreeMap::new();
        let mut take = |resolved: Resolved| match resolved {
            Resolved::Indexed { block, expression } => {
                if let Some((index, first)) = row_of(map, &expression) {
                    rows.entry(index).or_insert_with(BTreeSet::new).insert((block, first));
                }
            }
            Resolved::Place(place) => match place.kind {
                MemoryKind::Bit => drop(bits.insert(place.bit)),
                MemoryKind::I16 => drop(words.insert(Part::Word(place.bit, 16))),
                MemoryKind::I32 => drop(words.insert(Part::Word(place.bit, 32))),
                _ => {}
            },
            // A timer: done, and its count.
            Resolved::Structure(_, at) => {
                bits.insert(at + 32);
                words.insert(Part::Word(at, 32));
            }
            _ => {}
        };
        for text in rung.instructions.iter().flat_map(|it| &it.operands) {
            match Operand::parse_with(text, |block| map.radix(block)) {
                Ok(Operand::Constant(_)) => numbers.extend(text.parse::<i64>().ok()),
                Ok(Operand::Address(address)) => map.resolve(&address).into_iter().for_each(&mut take),
                Ok(Operand::Quoted(inside)) => {
                    let radix = |block: &str| map.radix(block);
                    let Ok(expression) = Expression::parse_with(&inside, &radix) else { continue };
                    for (address, _) in expression.addresses() {
                        map.resolve(&address).into_iter().for_each(&mut take);
                    }
                    let digits = inside.split(|c: char| !c.is_ascii_alphanumeric() && c != '.' && c != ':');
                    numbers.extend(digits.filter_map(|word| word.parse::<i64>().ok()));
                }
                Err(_) => {}
            }
        }
        let pairs = rows.values().flat_map(|starts| pairs_of(map, starts)).collect();
        Named { bits, words, numbers, pairs }
    }
}

/// The parts of an index that is a sum with a constant.
fn row_of(map: &Map, expression: &str) -> Option<(String, u32)> {
    let radix = |block: &str| map.radix(block);
    match Expression::parse_with(expression, &radix).ok()? {
        Expression::Binary(Binary::Add, first, index) => match *first {
            Expression::Operand(Operand::Constant(Constant { value: Number::Integer(first), .. })) => {
                Some((format!("{index:?}"), first.try_into().ok()?))
            }
            _ => None,
        },
        _ => None,
    }
}

/// Elements of rows that belong together, as far as they are looked at.
fn pairs_of(map: &Map, starts: &BTreeSet<(usize, u32)>) -> Vec<(u32, Part)> {
    let element = |(block, first): (usize, u32), index: u32| map.blocks().get(block)?.place(first + index);
    let mut pairs = Vec::new();
    for (one, other) in starts.iter().flat_map(|one| starts.iter().map(move |other| (*one, *other))) {
        for (bit, word) in (0..LONGEST_ROW).filter_map(|index| element(one, index).zip(element(other, index))) {
            match (bit.kind, word.kind) {
                (MemoryKind::Bit, MemoryKind::I16) => pairs.push((bit.bit, Part::Word(word.bit, 16))),
                (MemoryKind::Bit, MemoryKind::I32) => pairs.push((bit.bit, Part::Word(word.bit, 32))),
                _ => {}
            }
        }
    }
    pairs
}

/// All bits of words a rung names.
pub(crate) fn words_of(map: &Map, rung: &Rung) -> Vec<u32> {
    Named::of(map, rung).words.into_iter().flat_map(Part::bits).collect()
}

/// All bits a rung names, alone or in words.
pub(crate) fn bits_of(map: &Map, rung: &Rung) -> Vec<u32> {
    let named = Named::of(map, rung);
    let chosen = named.pairs.into_iter().flat_map(|(bit, word)| word.bits().chain([bit]));
    named.bits.into_iter().chain(named.words.into_iter().flat_map(Part::bits)).chain(chosen).collect()
}

/// Clauses over the bits and words of one rung that all samples show.
fn propose(map: &Map, rung: &Rung, varying: &BTreeSet<u32>, samples: &[Data], clauses: &mut BTreeSet<Clause>) {
    let Named { mut bits, words, mut numbers, pairs } = Named::of(map, rung);
    // A mutant of a number lives one beside it.
    let near: Vec<i64> = numbers.iter().flat_map(|number| [number - 1, number + 1]).collect();
    numbers.extend(near.into_iter().filter(|number| number.abs() > 1000 || *number == -1));
    bits.retain(|bit| varying.contains(bit));
    let changes = |part: &Part| part.bits().any(|bit| varying.contains(&bit));
    let mut atoms = Vec::new();
    for a in words.iter().filter(|part| changes(part)) {
        for b in words.iter().copied().filter(|b| a != b).chain(numbers.iter().copied().map(Part::Fixed)) {
            for atom in [Atom::Equal(*a, b), Atom::Less(*a, b), Atom::LessOrEqual(*a, b)] {
                atoms.push(atom);
            }
            atoms.extend([Atom::Less(b, *a), Atom::LessOrEqual(b, *a)]);
        }
    }
    for (bit, word) in pairs.iter().filter(|(bit, _)| varying.contains(bit)) {
        let ends = numbers.iter().map(|number| Part::Fixed(*number));
        for atom in ends.flat_map(|end| [Atom::Less(*word, end), Atom::Less(end, *word)]) {
            for flag in [true, false].map(|on| Atom::Bit(*bit, on)) {
                // Even where no run came to this element.
                if samples.iter().all(|data| flag.holds(data) || atom.holds(data)) {
                    clauses.insert(vec![flag, atom]);
                }
            }
        }
    }
    let shows = |atom: &Atom| samples.iter().map(|data| atom.holds(data)).collect::<Vec<bool>>();
    let relations: BTreeMap<Atom, Vec<bool>> = atoms.into_iter().map(|atom| (atom, shows(&atom))).collect();
    // A word that is 0 is as good as a flag.
    let empty = words.iter().filter(|part| changes(part)).map(|part| Atom::Equal(*part, Part::Fixed(0)));
    let empty: Vec<(Atom, Vec<bool>)> = empty.map(|atom| (atom, shows(&atom))).collect();
    let both = bits.iter().flat_map(|bit| [Atom::Bit(*bit, true), Atom::Bit(*bit, false)]);
    let flags: Vec<(Atom, Vec<bool>)> = both.map(|atom| (atom, shows(&atom))).collect();
    let always = |seen: &[bool]| seen.iter().all(|seen| *seen);
    for (atom, seen) in &relations {
        if always(seen) {
            clauses.insert(vec![*atom]);
            continue;
        }
        let of_words = matches!(atom, Atom::Less(Part::Word(..), Part::Word(..)));
        for (flag, on) in flags.iter().chain(empty.iter().filter(|_| of_words)) {
            if !always(on) && seen.iter().zip(on).all(|(seen, on)| *seen || *on) {
                clauses.insert(vec![*flag, *atom]);
            }
        }
    }
    for (index, (x, on)) in flags.iter().enumerate() {
        for (offset, (y, also)) in flags[index + 1..].iter().enumerate() {
            let (Atom::Bit(one, _), Atom::Bit(two, _)) = (x, y) else { continue };
            if one == two {
                continue;
            }
            let either: Vec<bool> = on.iter().zip(also).map(|(on, also)| *on || *also).collect();
            if always(&either) {
                clauses.insert(vec![*x, *y]);
            } else if one >> 4 == two >> 4 {
                for (z, third) in &flags[index + offset + 2..] {
                    let Atom::Bit(three, _) = z else { continue };
                    let apart = three != one && three != two && three >> 4 == one >> 4;
                    if apart && either.iter().zip(third).all(|(either, third)| *either || *third) {
                        clauses.insert(vec![*x, *y, *z]);
                    }
                }
            }
        }
    }
}

/// Where an input is written, what stands there, and its range.
type Input = (Handle, Kind, Option<(u32, u32)>);

/// States of a random run.
fn samples(project: &Project, scope: &Scope) -> Result<Vec<Data>, Why> {
    let program = Program::compile(project, &Default::default()).map_err(|_| "it cannot be run".to_owned())?;
    let mut machine = Machine::new(program);
    let mut seed = 0x9E37_79B9_7F4A_7C15u64;
    let mut random = move |limit: u64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) % limit.max(1)
    };
    let inputs: Vec<Input> = scope
        .driven
        .iter()
        .filter_map(|driven| Some((machine.handle(&driven.address).ok()?, driven.kind, driven.range)))
        .collect();
    machine.enter_run();
    machine.scan(Duration::ZERO);
    let mut samples = vec![machine.data().clone()];
    while samples.len() < SAMPLES {
        for _ in 0..random(3) {
            let Some((handle, kind, range)) = inputs.get(random(inputs.len() as u64) as usize) else { continue };
            let number = match (kind, range) {
                (Kind::Bit, _) => random(2) as i64,
                (_, Some((least, most))) => i64::from(*least) + random(u64::from(most - least) + 1) as i64,
                _ if random(2) == 0 => random(5) as i64 - 2,
                _ => random(1 << 32) as u32 as i32 as i64,
            };
            let number = if *kind == Kind::Word { (number as i16).into() } else { number };
            machine.set_number(*handle, Num::Int(number));
        }
        if random(60) == 0 || machine.mode() != domore::engine::Mode::Run {
            machine.enter_program();
            machine.enter_run();
        }
        let times = [1, 7, 10, 13, 50, 990, 1000, 1001, 3000, 20_000, 3_599_987];
        let time = times[random(times.len() as u64) as usize];
        for _ in 0..1 + random(4) {
            machine.scan(Duration::from_millis(time));
        }
        samples.push(machine.data().clone());
    }
    Ok(samples)
}
