//! Whether a mutant does the same as the program it was made of, by argument: from equal data, with the same
//! inputs and time, one scan leaves equal data again in everything that matters.

use std::collections::{HashMap, HashSet};

use analysis::proof::Scope;
use domore::Project;

use super::facts::{After, Facts};
use super::gates::{Answer, Line, ON, value};
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
        let found = differing(facts, &ours, &theirs, &apart, None)?;
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
    let (ours, behind) = facts.next_watched(change.place)?;
    let near: HashSet<u32> = [change, Change { rung: facts.model.rung(change.place, None), ..change }]
        .into_iter()
        .flat_map(|change| change.rung.map(|rung| bits_of(&facts.model.map, rung)).unwrap_or_default())
        .collect();
    let near = if depth > 1 { facts.model.around(&near) } else { near };
    loop {
        let own: HashMap<u32, Line> = apart.iter().map(|bit| (*bit, facts.gates.input())).collect();
        let known = if related { facts.known_of(&|bit| near.contains(&bit)) } else { facts.given.clone() };
        let theirs = facts.next_changed(change, &own, &behind, &known)?;
        let given = if related { theirs_too(facts, &begun, &own, &theirs, &near) } else { facts.given.clone() };
        let found = differing(facts, &ours, &theirs, &apart, Some(given.clone()))?;
        if found.is_empty() {
            return Ok(Same::Yes { helpers: apart.len(), related });
        }
        if found.iter().any(|bit| compared.contains(bit) || timed(*bit).is_some()) {
            if related && apart.len() <= MOST_GUARDED {
                for guard in near.iter().filter(|bit| !apart.contains(bit)).flat_map(|bit| [(*bit, 0), (*bit, 1)]) {
                    if guarded(facts, guard, (&begun, &own), (&ours, &theirs), &given)? {
                        return Ok(Same::Yes { helpers: apart.len(), related });
                    }
                }
            }
            return Ok(Same::No(found));
        }
        apart.extend(found);
    }
}

/// Bits that may differ under a guard: two double words.
const MOST_GUARDED: usize = 64;

/// Whether helpers differ only while a bit of the program is on (0) or off (1), and nothing else does.
fn guarded(
    facts: &mut Facts<'_>,
    (bit, inverted): (u32, Line),
    (begun, own): (&After, &HashMap<u32, Line>),
    (ours, theirs): (&After, &After),
    given: &[Line],
) -> Result<bool, Why> {
    let first = begun.get(&bit).copied().unwrap_or(0) ^ inverted;
    let flag = facts.before(bit);
    let guard = flag ^ inverted;
    // With the guard on behind the first scan nothing has to be equal there.
    if flag < 2 || own.is_empty() || first != ON {
        return Ok(false);
    }
    let mut equal = ON;
    let mut differs = 0;
    for (helper, line) in own {
        let before = facts.before(*helper);
        let apart = facts.gates.xor(before, *line);
        equal = facts.gates.and(equal, apart ^ 1);
        let (x, y) = (after(ours, *helper, before), after(theirs, *helper, *line));
        let apart = facts.gates.xor(x, y);
        differs = facts.gates.or(differs, apart);
    }
    let known = facts.gates.or(guard, equal);
    let guard_after = after(ours, bit, flag) ^ inverted;
    let broken = facts.gates.and(guard_after ^ 1, differs);
    let given: Vec<Line> = given.iter().copied().chain([known]).collect();
    if !matches!(facts.gates.ask(broken, &given), Answer::Never) {
        return Ok(false);
    }
    let helpers = own.keys().copied().collect();
    Ok(differing(facts, ours, theirs, &helpers, Some(given))?.is_empty())
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
    apart: &HashSet<u32>,
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
    let any = differences.iter().fold(0, |any, (_, line)| facts.gates.or(any, *line));
    match facts.gates.ask(any, &given.unwrap_or_default()) {
        Answer::Never => Ok(Vec::new()),
        Answer::Open => Err("too much work".to_owned()),
        Answer::Values(values) => {
            Ok(differences.into_iter().filter(|(_, line)| value(&values, *line)).map(|(bit, _)| bit).collect())
        }
    }
}
