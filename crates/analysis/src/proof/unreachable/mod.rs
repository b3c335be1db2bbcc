//! What cannot happen in any scan, by argument across rungs.
//!
//! A goal that a run does not reach is either one the run did not find the way to, or one the program
//! excludes: two timers of a chain that are never done together, an alarm for a state that its own logic
//! prevents. To tell them apart a scan becomes a circuit ([`scan`]), facts about the data between scans are
//! shown by induction ([`facts`]), and a goal is impossible when no scan leads to it from data for which
//! these facts hold. Everything that is not shown stays a goal.

mod act;
mod argument;
mod candidates;
mod cells;
mod facts;
mod gates;
mod scan;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};

use batsat::Lit;
use sim::outline::{Outline, Routine};

use super::goals::{GoalKind, Goals, Monitor, Source};
use super::progress::Progress;
use super::side::Kind;
use candidates::States;
use facts::Induction;
use scan::{Before, Happens, Scan, called};

/// Why an argument was not finished.
const ENDED: &str = "the run was stopped early";

/// What an argument starts from.
pub(crate) struct Surroundings<'s> {
    /// The program.
    pub(crate) outline: &'s Outline,
    /// The data before the first scan.
    pub(crate) loaded: &'s [u16],
    /// Places that are written from outside.
    pub(crate) inputs: &'s [(u32, Kind)],
    /// Addresses of terminals by place.
    pub(crate) names: &'s BTreeMap<u32, String>,
    /// Can end the search.
    pub(crate) progress: Option<&'s Progress>,
}

impl Surroundings<'_> {
    /// Somebody asked for the end.
    fn is_stopped(&self) -> bool {
        self.progress.is_some_and(Progress::is_stopped)
    }
}

/// Marks goals that cannot be reached, with the argument; `states` is data after scans of the run. Answers
/// why nothing could be shown, if so.
pub(crate) fn rule_out(goals: &mut Goals, given: &Surroundings<'_>, states: &[&[u16]]) -> Option<&'static str> {
    let missing: Vec<usize> = open(goals).collect();
    if missing.is_empty() {
        return None;
    }
    if given.is_stopped() {
        return Some(ENDED);
    }
    let inputs = bits(given.inputs);
    let outline = given.outline;
    let circuits = Scan::build(outline, Before::Loaded(given.loaded), &inputs)
        .and_then(|first| Ok((first, Scan::build(outline, Before::Any, &inputs)?)));
    let (first, any) = match circuits {
        Ok(circuits) => circuits,
        Err(why) => return Some(why),
    };
    let mut induction = Induction::new(first, any, given.progress);
    let wanted = wanted(goals, &mut induction, &missing);
    let states = States(states);
    let all: Vec<u32> = induction.any.initial.keys().copied().collect();
    let constants = states.constants(all.iter().copied());
    let pairs = {
        let rungs = missing.iter().filter_map(|number| goals.all.get(*number)).map(|goal| goal.location);
        let rungs = rungs.filter_map(|at| Some((at.file, u16::try_from(at.rung).ok()?))).collect();
        let stored = |at: u32| induction.any.initial.contains_key(&at);
        states.pairs(&candidates::near(outline, &rungs, stored))
    };
    // Few facts often do; with more of them each other one has more to rest on.
    for (more, last) in [(constants.clone(), false), ([constants, pairs].concat(), true)] {
        if !induction.take(more) {
            return Some(if given.is_stopped() { ENDED } else { "the search took too long" });
        }
        let (first, any) = (induction.first.strays, induction.any.strays);
        if induction.excludes(first, any).is_none() {
            if given.is_stopped() {
                return Some(ENDED);
            }
            if last {
                return Some("an index may lead out of its file");
            }
            continue;
        }
        for (number, first, any) in &wanted {
            if given.is_stopped() {
                return Some(ENDED);
            }
            let done = goals.all.get(*number).is_none_or(|goal| goal.reached || goal.impossible.is_some());
            if !done && let Some(used) = induction.excludes(*first, *any) {
                let why = argument::of(&mut induction, &used, given);
                if let Some(goal) = goals.all.get_mut(*number) {
                    goal.impossible = Some(why);
                }
            }
        }
        if open(goals).next().is_none() {
            break;
        }
    }
    None
}

/// Goals that are neither reached nor known to be impossible.
fn open(goals: &Goals) -> impl Iterator<Item = usize> {
    (0..).zip(&goals.all).filter(|(_, goal)| !goal.reached && goal.impossible.is_none()).map(|(number, _)| number)
}

/// Single bits of places.
fn bits(places: &[(u32, Kind)]) -> BTreeSet<u32> {
    let width = |kind: Kind| match kind {
        Kind::Bit => 1,
        Kind::Word => 16,
        Kind::Long | Kind::Float => 32,
        Kind::Text => 42 * 16,
    };
    places.iter().flat_map(|(at, kind)| *at..at.saturating_add(width(*kind))).collect()
}

/// Per goal when it happens, in the first scan and in any.
fn wanted(goals: &Goals, induction: &mut Induction<'_>, missing: &[usize]) -> Vec<(usize, Lit, Lit)> {
    let outline = induction.any.outline;
    let mut unknown: BTreeSet<u16> = BTreeSet::new();
    let mut on_fault: BTreeSet<u16> = BTreeSet::new();
    for (file, routine) in &outline.routines {
        let files = called(outline, *file);
        if *routine == Routine::Fault { on_fault.extend(files) } else { unknown.extend(files) }
    }
    let mut wanted = Vec::new();
    for number in missing {
        let Some(goal) = goals.all.get(*number) else { continue };
        let (file, rung) = (goal.location.file, u16::try_from(goal.location.rung));
        let (Ok(rung), Ok(instruction)) = (rung, u16::try_from(goal.location.instruction)) else { continue };
        // What an interrupt does is not in the circuits.
        if unknown.contains(&file) {
            continue;
        }
        let mut both = [&mut induction.first, &mut induction.any].map(|scan| {
            let no = scan.gates.no();
            let at = scan.happens.get(&(file, rung, instruction)).copied();
            let at = at.unwrap_or(Happens { passes: no, blocks: no, on: no, off: no });
            let literal = match goal.kind {
                GoalKind::Passes => at.passes,
                GoalKind::Blocks => at.blocks,
                GoalKind::True => at.on,
                GoalKind::False => at.off,
                _ => return end(goals, scan, *number),
            };
            Some(if on_fault.contains(&file) { scan.gates.or(literal, scan.faults) } else { literal })
        });
        if let [Some(first), Some(any)] = [both[0].take(), both[1].take()] {
            wanted.push((*number, first, any));
        }
    }
    wanted
}

/// When a goal is reached that is looked at behind the scan.
fn end(goals: &Goals, scan: &mut Scan<'_>, number: usize) -> Option<Lit> {
    for monitor in goals.monitors() {
        match *monitor {
            Monitor::Done(at, done, not) if number == done || number == not => {
                let on = scan.bit(at);
                // A contact in the middle of the scan shows it too.
                let mut seen = if number == done { on } else { !on };
                for contact in goals.contacts_of(number).filter_map(|contact| goals.all.get(contact as usize)) {
                    let place = contact.location;
                    let key = (place.file, u16::try_from(place.rung).ok()?, u16::try_from(place.instruction).ok()?);
                    if let Some(happens) = scan.happens.get(&key).copied() {
                        let shows = if contact.kind == GoalKind::Passes { happens.passes } else { happens.blocks };
                        seen = scan.gates.or(seen, shows);
                    }
                }
                return Some(seen);
            }
            Monitor::Compare(a, b, first) if (first..first + 3).contains(&number) => {
                let [a, b] = [a, b].map(|source| match source {
                    Source::Constant(value) => scan.gates.number(value, 34),
                    Source::Word(at) => scan.value(sim::outline::Value::Word(at / 16)),
                    Source::Long(at) => scan.value(sim::outline::Value::Long(at / 16)),
                });
                return scan.near(&a, &b).get(number - first).copied();
            }
            _ => {}
        }
    }
    None
}
