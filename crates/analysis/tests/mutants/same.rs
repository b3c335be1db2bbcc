//! Whether a mutant does the same as the program it was made of, by argument: from equal data, with the same
//! inputs and time, one scan leaves equal data again in everything that matters.

use std::collections::{HashMap, HashSet};

use analysis::proof::Scope;
use domore::Project;

use super::facts::{After, Facts};
use super::gates::{Answer, Line, OFF, ON, value};
use super::mutate::Mutant;
use super::relations::{bits_of, kept, line_of, speaks_of};
use super::scan::{Change, HALTED, Outside, Why, timed};

/// The answer.
#[derive(Clone, Debug)]
pub(crate) enum Same {
    /// It does. So many bits can differ that nothing compared depends on; relations of the program were needed.
    Yes { helpers: usize, related: bool },
    /// One scan from a state that the facts allow can make these bits differ.
    No(Vec<u32>),
    /// The question stayed open.
    Open(Why),
}

/// Steps of the solver for a question, where there is hope to find a difference yet and where there is none.
const STEPS: [u64; 2] = [10_000, 150_000];

/// Questions on the way through a scan, likewise.
const QUESTIONS: [usize; 2] = [48, 400];
/// Times that more bits that differ are looked for before a scan is followed anew with them.
const MORE: usize = 12;

/// Decides about the mutants of one program. What it has to know of the program is found when it is needed.
pub(crate) struct Judge<'j> {
    project: &'j Project,
    scope: &'j Scope,
    facts: Option<Result<Facts<'j>, Why>>,
    compared: HashSet<u32>,
    related: bool,
}

impl<'j> Judge<'j> {
    pub(crate) fn new(project: &'j Project, scope: &'j Scope) -> Judge<'j> {
        Judge { project, scope, facts: None, compared: HashSet::new(), related: false }
    }

    /// Whether a mutant does the same.
    pub(crate) fn ask(&mut self, mutant: &Mutant, thorough: bool) -> Same {
        let (project, scope) = (self.project, self.scope);
        let facts = match self.facts.get_or_insert_with(|| Facts::new(project, scope)) {
            Ok(facts) => facts,
            Err(why) => return Same::Open(why.clone()),
        };
        if self.compared.is_empty() {
            self.compared = compared(scope, facts);
        }
        if thorough && !self.related {
            self.related = true;
            if let Err(why) = facts.relate(project, scope) {
                return Same::Open(why);
            }
        }
        let change = mutant.change();
        facts.gates.patience = STEPS[usize::from(thorough)];
        let size = facts.gates.size();
        // Without relations first: they make a question longer.
        let mut answer = Same::Open(String::new());
        for depth in [0, 1, 2] {
            if !matches!(answer, Same::Yes { .. }) && (depth == 0 || thorough) {
                answer = decide(facts, &self.compared, change, depth).unwrap_or_else(Same::Open);
                facts.gates.forget(size);
                facts.outside.forget(size);
            }
        }
        answer
    }

    /// Why there is no argument.
    pub(crate) fn why(&self, answer: &Same) -> String {
        match (answer, &self.facts) {
            (Same::No(bits), Some(Ok(facts))) => {
                bits.iter().take(8).map(|bit| facts.model.name(*bit)).collect::<Vec<_>>().join(" ")
            }
            (Same::Open(why), _) => why.clone(),
            _ => String::new(),
        }
    }
}

/// Bits that have to be equal: what is compared, and what stops the machine.
fn compared(scope: &Scope, facts: &Facts<'_>) -> HashSet<u32> {
    let words = scope.compared.iter();
    let mut bits: HashSet<u32> =
        words.flat_map(|(at, mask)| (0..16).filter(move |bit| mask >> bit & 1 == 1).map(move |bit| at + bit)).collect();
    bits.insert(HALTED);
    if let Ok(domore::memory::Resolved::Place(place)) = facts.model.map.resolve_text("slcFault") {
        bits.insert(place.bit);
    }
    bits
}

fn decide(facts: &mut Facts<'_>, compared: &HashSet<u32>, change: Change<'_>, depth: usize) -> Result<Same, Why> {
    // Without relations, with those of the rung, with those of what its words are computed from.
    let related = depth > 0;
    // The first scan from power-up.
    let mut outside = Outside::default();
    let (ours, theirs) = (facts.first_scan(None, &mut outside)?, facts.first_scan(Some(change), &mut outside)?);
    let mut apart: HashSet<u32> = HashSet::new();
    loop {
        let found = differing(facts, &ours, &theirs, (&apart, compared), None)?;
        if found.is_empty() {
            break;
        }
        if found.iter().any(|bit| compared.contains(bit)) {
            return Ok(Same::No(found));
        }
        apart.extend(found);
    }
    // Every later one.
    let begun = theirs;
    let (ours, notes) = facts.next_noted(change.place)?;
    let near: HashSet<u32> = [change, Change { rung: facts.model.rung(change.place, None), ..change }]
        .into_iter()
        .flat_map(|change| change.rung.map(|rung| bits_of(&facts.model.map, rung)).unwrap_or_default())
        .collect();
    let near = if depth > 1 { facts.model.around(&near) } else { near };
    let questions = QUESTIONS[usize::from(related)];
    loop {
        let own: HashMap<u32, Line> = apart.iter().map(|bit| (*bit, facts.gates.input())).collect();
        let known = if related { facts.known_of(&|bit| near.contains(&bit)) } else { facts.given.clone() };
        let mut theirs = facts.next_changed(change, &own, (&notes, questions), &known)?;
        let mut given = known;
        if related {
            let more = theirs_too(facts, &begun, &own, &theirs, &near);
            if more.len() > given.len() {
                theirs = facts.next_changed(change, &own, (&notes, questions), &more)?;
            }
            given = more;
        }
        let mut found = differing(facts, &ours, &theirs, (&apart, compared), Some(given.clone()))?;
        // Some more at once.
        let mut also = found.clone();
        for _ in 0..MORE {
            if also.is_empty() || also.iter().any(|bit| compared.contains(bit) || timed(*bit).is_some()) {
                break;
            }
            let all = apart.iter().chain(&found).copied().collect();
            also = differing(facts, &ours, &theirs, (&all, compared), Some(given.clone()))?;
            found.extend(&also);
        }
        if found.is_empty() {
            return Ok(Same::Yes { helpers: apart.len(), related });
        }
        if found.iter().any(|bit| compared.contains(bit) || timed(*bit).is_some()) {
            if related && apart.len() <= MOST_GUARDED {
                for guard in near.iter().filter(|bit| !apart.contains(bit)).flat_map(|bit| [(*bit, 0), (*bit, 1)]) {
                    if guarded(facts, guard, (&begun, &own), (&ours, &theirs), (&given, compared))? {
                        return Ok(Same::Yes { helpers: apart.len(), related });
                    }
                }
                // Once more with all helpers that can differ.
                let matters = |bit: &u32| compared.contains(bit) || timed(*bit).is_some();
                let helpers: Vec<u32> = found.iter().copied().filter(|bit| !matters(bit)).collect();
                if !helpers.is_empty() {
                    apart.extend(with_words(facts, compared, &helpers));
                    continue;
                }
            }
            return Ok(Same::No(found));
        }
        apart.extend(with_words(facts, compared, &found));
    }
}

/// Helpers that differ with their whole double words: their bits need no question each.
fn with_words(facts: &Facts<'_>, compared: &HashSet<u32>, found: &[u32]) -> Vec<u32> {
    let words: HashSet<u32> = found.iter().filter(|bit| **bit < HALTED).map(|bit| bit >> 5).collect();
    let beside = facts.varying().filter(|bit| words.contains(&(bit >> 5)) && !compared.contains(bit));
    beside.chain(found.iter().copied()).collect()
}

/// Bits that are asked about word by word.
const MOST_APART: usize = 400;
/// Bits that may differ under a guard: a few double words.
const MOST_GUARDED: usize = 200;

/// Whether some of the helpers differ only while a bit of the program is on (0) or off (1), so that nothing else does.
fn guarded(
    facts: &mut Facts<'_>,
    (bit, inverted): (u32, Line),
    (begun, own): (&After, &HashMap<u32, Line>),
    (ours, theirs): (&After, &After),
    (given, compared): (&[Line], &HashSet<u32>),
) -> Result<bool, Why> {
    let first = begun.get(&bit).copied().unwrap_or(0) ^ inverted;
    let flag = facts.before(bit);
    let guard = flag ^ inverted;
    // With the guard on behind the first scan nothing has to be equal there.
    if flag < 2 || own.is_empty() || first != ON {
        return Ok(false);
    }
    let guard_after = after(ours, bit, flag) ^ inverted;
    // Those that are equal while the guard is on; of the others nothing is known.
    let mut bound: Vec<(u32, Line)> = own.iter().map(|(helper, line)| (*helper, *line)).collect();
    bound.sort_unstable();
    while !bound.is_empty() {
        let mut equal = ON;
        let mut differs = Vec::new();
        for (helper, line) in &bound {
            let before = facts.before(*helper);
            let apart = facts.gates.xor(before, *line);
            equal = facts.gates.and(equal, apart ^ 1);
            let (x, y) = (after(ours, *helper, before), after(theirs, *helper, *line));
            differs.push(facts.gates.xor(x, y));
        }
        let any = differs.iter().fold(OFF, |any, line| facts.gates.or(any, *line));
        let known = facts.gates.or(guard, equal);
        let broken = facts.gates.and(guard_after ^ 1, any);
        let given: Vec<Line> = given.iter().copied().chain([known]).collect();
        match facts.gates.ask(broken, &given) {
            Answer::Open => return Ok(false),
            Answer::Values(values) => {
                let mut differs = differs.iter();
                bound.retain(|_| differs.next().is_some_and(|line| !value(&values, *line)));
            }
            Answer::Never => {
                let helpers = own.keys().copied().collect();
                return Ok(differing(facts, ours, theirs, (&helpers, compared), Some(given))?.is_empty());
            }
        }
    }
    Ok(false)
}

fn after(memory: &After, bit: u32, before: Line) -> Line {
    memory.get(&bit).copied().unwrap_or(before)
}

/// What holds before a scan: the facts, and of the relations those that the mutant keeps with its own bits.
fn theirs_too(
    facts: &mut Facts<'_>,
    begun: &After,
    own: &HashMap<u32, Line>,
    theirs: &After,
    near: &HashSet<u32>,
) -> Vec<Line> {
    let given = facts.known_of(&|bit| near.contains(&bit) || own.contains_key(&bit));
    let after_first = |bit: u32| begun.get(&bit).copied().unwrap_or(0);
    let mut clauses = Vec::new();
    for clause in facts.relations.clone() {
        if speaks_of(&clause, &|bit| own.contains_key(&bit)) && line_of(facts, &clause, &after_first) == ON {
            clauses.push(clause);
        }
    }
    if clauses.is_empty() {
        return given;
    }
    let lines: HashMap<u32, Line> = facts.varying().map(|bit| (bit, facts.before(bit))).collect();
    let fixed = facts.fixed();
    let was = |bit: u32| own.get(&bit).or_else(|| lines.get(&bit)).or_else(|| fixed.get(&bit)).copied().unwrap_or(0);
    let is = |bit: u32| theirs.get(&bit).copied().unwrap_or_else(|| was(bit));
    let clauses = kept(facts, clauses, &was, &is, &given);
    let lines: Vec<Line> = clauses.iter().map(|clause| line_of(facts, clause, &was)).collect();
    given.into_iter().chain(lines).collect()
}

/// Bits that one scan can leave different, besides those known already; some of them.
fn differing(
    facts: &mut Facts<'_>,
    ours: &After,
    theirs: &After,
    (apart, compared): (&HashSet<u32>, &HashSet<u32>),
    given: Option<Vec<Line>>,
) -> Result<Vec<u32>, Why> {
    let mut bits: Vec<u32> = ours.keys().chain(theirs.keys()).copied().filter(|bit| !apart.contains(bit)).collect();
    bits.sort_unstable();
    bits.dedup();
    let mut differences = Vec::new();
    for bit in bits {
        let before = if given.is_some() { facts.before(bit) } else { 0 };
        let [x, y] = [ours, theirs].map(|memory| memory.get(&bit).copied().unwrap_or(before));
        let mut differs = facts.gates.xor(x, y);
        if let Some(fresh) = timed(bit) {
            // When a timer's time was taken is of no account where it starts anew.
            let [x, y] = [ours, theirs].map(|memory| memory.get(&fresh).copied().unwrap_or(before));
            let both = facts.gates.and(x, y);
            differs = facts.gates.and(differs, both ^ 1);
        }
        if differs != 0 {
            differences.push((bit, differs));
        }
    }
    let given = given.unwrap_or_default();
    if let Some(found) = asked(facts, &differences, &given) {
        return Ok(found);
    }
    // Word by word; a helper about which nothing is known differs.
    let mut found = Vec::new();
    for word in differences.chunk_by(|a, b| a.0 >> 4 == b.0 >> 4).take_while(|_| differences.len() <= MOST_APART) {
        let matters = || word.iter().any(|(bit, _)| compared.contains(bit) || timed(*bit).is_some());
        match asked(facts, word, &given) {
            Some(bits) => found.extend(bits),
            None if matters() => return Err("too much work".to_owned()),
            None => found.extend(word.iter().map(|row| row.0)),
        }
    }
    if found.is_empty() && differences.len() > MOST_APART { Err("too much work".to_owned()) } else { Ok(found) }
}

/// Those of the bits that can differ at once, some of them; `None`: after much work nothing is known.
fn asked(facts: &mut Facts<'_>, differences: &[(u32, Line)], given: &[Line]) -> Option<Vec<u32>> {
    let any = differences.iter().fold(OFF, |any, (_, line)| facts.gates.or(any, *line));
    match facts.gates.ask(any, given) {
        Answer::Never => Some(Vec::new()),
        Answer::Open => None,
        Answer::Values(values) => {
            Some(differences.iter().filter(|(_, line)| value(&values, *line)).map(|row| row.0).collect())
        }
    }
}
