//! The order in which rungs run: subroutines, jumps, zones, ends.

use std::collections::{BTreeMap, BTreeSet};

use ladder::{Family, ProgramFile};

use super::context::{Context, Step};
use super::{Check, Found, Severity, rungs};
use crate::calls::{EntryKind, Target};
use crate::location::Location;

pub(super) const CHECKS: &[Check] = &[
    Check {
        code: "FLW01",
        title: "program file that never runs",
        severity: Severity::Warning,
        default_on: true,
        explanation: "No JSR that runs names the file, and no interrupt or fault routine is set to it. Its rungs are drawn and printed like \
            any others and do nothing. Interrupts that SLC 500 modules start stand in the modules' configuration, which is not \
            looked at.",
        find: never_runs,
    },
    Check {
        code: "FLW02",
        title: "JSR to a file without ladder",
        severity: Severity::Error,
        default_on: true,
        explanation: "The program file that is called does not exist, or holds no ladder.",
        find: missing_file,
    },
    Check {
        code: "FLW03",
        title: "JMP without its label",
        severity: Severity::Error,
        default_on: true,
        explanation: "The program file has no LBL with the number the JMP names.",
        find: missing_label,
    },
    Check {
        code: "FLW04",
        title: "label defined twice",
        severity: Severity::Error,
        default_on: true,
        explanation: "Two LBL of one program file have the same number: where a JMP goes is not defined.",
        find: double_label,
    },
    Check {
        code: "FLW05",
        title: "JMP into a master control zone",
        severity: Severity::Warning,
        default_on: true,
        explanation: "The label lies between two MCR and the jump does not: rungs of the zone run as if its conditions were true, though \
            they are not.",
        find: jump_into_zone,
    },
    Check {
        code: "FLW06",
        title: "MCR without its partner",
        severity: Severity::Error,
        default_on: true,
        explanation: "MCR come in pairs in one program file: one behind conditions opens the zone, one alone on its rung closes it. Zones \
            cannot nest. Here one is missing, opens a second zone, or closes none.",
        find: unpaired_zone,
    },
    Check {
        code: "FLW07",
        title: "END missing or out of place",
        severity: Severity::Error,
        default_on: true,
        explanation: "A program file ends with a rung that holds END alone. Without it the file is damaged or was cut off; rungs after it \
            never run.",
        find: end,
    },
    Check {
        code: "FLW08",
        title: "jump backwards",
        severity: Severity::Warning,
        default_on: true,
        explanation: "The label stands before the JMP: the rungs between are repeated within one scan, inputs and outputs are not \
            updated meanwhile, and a condition that does not end the loop in time lets the watchdog stop the processor.",
        find: backward_jump,
    },
    Check {
        code: "FLW09",
        title: "label that nothing jumps to",
        severity: Severity::Note,
        default_on: true,
        explanation: "No JMP of the program file names the label: left over, or the jump is gone.",
        find: unused_label,
    },
    Check {
        code: "FLW10",
        title: "subroutine that calls itself",
        severity: Severity::Warning,
        default_on: true,
        explanation: "A file calls itself, directly or through others. Each call takes a nesting level; when they are used up the \
            processor stops with a fault.",
        find: recursion,
    },
    Check {
        code: "FLW11",
        title: "subroutines nested deeper than the processor takes",
        severity: Severity::Error,
        default_on: true,
        explanation: "Fixed SLC 500 and SLC 5/01 take 4 levels of JSR, the others 8. One call more is a major fault.",
        find: nesting,
    },
    Check {
        code: "FLW12",
        title: "rungs that no scan gets to",
        severity: Severity::Warning,
        default_on: true,
        explanation: "A TND, RET, SUS or JMP without conditions stands before these rungs, and no label in between lets a jump reach \
            them. Sometimes done to switch rungs off during commissioning.",
        find: unreachable_rungs,
    },
    Check {
        code: "FLW13",
        title: "SUS left in the program",
        severity: Severity::Warning,
        default_on: true,
        explanation: "SUS stops the program in suspend mode, for debugging. In a running machine it is a stop nobody expects.",
        find: suspend,
    },
    Check {
        code: "FLW14",
        title: "timer, counter or one-shot in a subroutine called from several rungs",
        severity: Severity::Note,
        default_on: true,
        explanation: "If more than one of the calls runs in one scan, the instructions of the file execute more than once: timers \
            run on, one shots see the state of the call before. Harmless when the calls exclude each other.",
        find: called_twice,
    },
    Check {
        code: "FLW15",
        title: "off-delay timer in a master control zone",
        severity: Severity::Warning,
        default_on: true,
        explanation: "While a zone is off its rungs are scanned as false, and a false rung is what starts a TOF: switching the zone off starts \
            the delay.",
        find: off_delay_in_zone,
    },
];

fn never_runs(context: &Context<'_>, found: &mut Found) {
    for file in context.calls.files.iter().filter(|file| !file.reachable) {
        let Some(ladder) = context.image.program_file(file.number) else { continue };
        let reserved = file.entries.iter().any(|entry| entry.kind == EntryKind::Reserved);
        let used = ladder.rungs.iter().filter(|rung| !rung.is_end()).count();
        if reserved || used == 0 {
            continue;
        }
        let first = Location { file: file.number, rung: 0, instruction: 0 };
        let why = match file.called_by.as_slice() {
            [] => "nothing calls it".to_owned(),
            calls => format!("it is only called from files that do not run: {}", rungs(calls)),
        };
        let plural = if used == 1 { "" } else { "s" };
        found.add(
            &[first],
            format!("U:{}", file.number),
            format!("file {} with {used} rung{plural} never runs: {why}", file.number),
        );
    }
}

fn missing_file(context: &Context<'_>, found: &mut Found) {
    for call in &context.calls.calls {
        if let Target::Missing(number) = call.target {
            found.add(&[call.location], format!("U:{number}"), format!("there is no ladder file {number}"));
        }
    }
}

fn missing_label(context: &Context<'_>, found: &mut Found) {
    for label in context.calls.labels.iter().filter(|label| label.defined.is_empty()) {
        let message = format!("file {} has no label {}", label.file, label.number);
        found.add(&label.jumps, format!("Q{}:{}", label.file, label.number), message);
    }
}

fn double_label(context: &Context<'_>, found: &mut Found) {
    for label in context.calls.labels.iter().filter(|label| label.defined.len() > 1) {
        let message = format!("label {} is defined in {}", label.number, rungs(&label.defined));
        found.add(&label.defined, format!("Q{}:{}", label.file, label.number), message);
    }
}

fn unused_label(context: &Context<'_>, found: &mut Found) {
    for label in context.calls.labels.iter().filter(|label| label.jumps.is_empty()) {
        let message = format!("no JMP names label {} of file {}", label.number, label.file);
        found.add(&label.defined, format!("Q{}:{}", label.file, label.number), message);
    }
}

fn backward_jump(context: &Context<'_>, found: &mut Found) {
    for label in &context.calls.labels {
        let Some(target) = label.defined.first() else { continue };
        for jump in label.jumps.iter().filter(|jump| jump.rung >= target.rung) {
            let message = format!("JMP in {jump} goes back to label {} in {target}", label.number);
            found.add(&[*jump, *target], format!("Q{}:{}", label.file, label.number), message);
        }
    }
}

/// Zones of one file: rung that opens and rung that closes; and the MCR without a partner.
struct Zones {
    pairs: Vec<(u32, u32)>,
    odd: Vec<(Location, &'static str)>,
}

fn zones(context: &Context<'_>) -> BTreeMap<u16, Zones> {
    let mut all: BTreeMap<u16, Zones> = BTreeMap::new();
    let mut open: BTreeMap<u16, Location> = BTreeMap::new();
    for step in context.steps.iter().filter(|step| step.name == "MCR") {
        let zones = all.entry(step.at.file).or_insert(Zones { pairs: Vec::new(), odd: Vec::new() });
        match (open.get(&step.at.file).copied(), step.gated) {
            (None, true) => drop(open.insert(step.at.file, step.at)),
            (None, false) => zones.odd.push((step.at, "closes a zone that is not open")),
            (Some(_), true) => zones.odd.push((step.at, "opens a zone inside another one")),
            (Some(start), false) => {
                zones.pairs.push((start.rung, step.at.rung));
                open.remove(&step.at.file);
            }
        }
    }
    for (file, start) in open {
        if let Some(zones) = all.get_mut(&file) {
            zones.odd.push((start, "opens a zone that is not closed"));
            zones.pairs.push((start.rung, u32::MAX));
        }
    }
    all
}

fn inside(zones: &Zones, rung: u32) -> Option<(u32, u32)> {
    // Zones do not overlap and come in order.
    let after = zones.pairs.partition_point(|(start, _)| *start < rung);
    zones.pairs.get(after.checked_sub(1)?).copied().filter(|(_, end)| rung < *end)
}

fn unpaired_zone(context: &Context<'_>, found: &mut Found) {
    for zones in zones(context).values() {
        for (at, why) in &zones.odd {
            found.add(&[*at], "", format!("this MCR {why}"));
        }
    }
}

fn jump_into_zone(context: &Context<'_>, found: &mut Found) {
    let zones = zones(context);
    for label in &context.calls.labels {
        let (Some(target), Some(zones)) = (label.defined.first(), zones.get(&label.file)) else { continue };
        let Some(zone) = inside(zones, target.rung) else { continue };
        for jump in label.jumps.iter().filter(|jump| inside(zones, jump.rung) != Some(zone)) {
            let message =
                format!("JMP in {jump} goes to label {} inside the zone that opens in rung {}", label.number, zone.0);
            found.add(&[*jump, *target], format!("Q{}:{}", label.file, label.number), message);
        }
    }
}

fn off_delay_in_zone(context: &Context<'_>, found: &mut Found) {
    let zones = zones(context);
    for step in context.steps.iter().filter(|step| step.name == "TOF") {
        if let Some((start, _)) = zones.get(&step.at.file).and_then(|zones| inside(zones, step.at.rung))
            && let Some(address) = context.address(step, 0)
        {
            found.add(&[step.at], &address, format!("{address} starts when the zone of rung {start} goes off"));
        }
    }
}

fn end(context: &Context<'_>, found: &mut Found) {
    for file in context.image.ladder_files() {
        let number = file.number;
        let at = |rung: usize| Location { file: number, rung: u32::try_from(rung).unwrap_or(u32::MAX), instruction: 0 };
        match first_end(file) {
            None => {
                found.add(&[at(file.rungs.len().saturating_sub(1))], "", format!("file {number} does not end with END"))
            }
            Some(rung) if rung + 1 < file.rungs.len() => {
                found.add(
                    &[at(rung)],
                    "",
                    format!("{} rungs stand after the END of file {number}", file.rungs.len() - rung - 1),
                );
            }
            Some(_) => {}
        }
    }
}

fn first_end(file: &ProgramFile) -> Option<usize> {
    file.rungs.iter().position(|rung| rung.instructions().any(|it| it.mnemonic == *"END"))
}

/// Which files each file calls.
fn edges(context: &Context<'_>) -> BTreeMap<u16, BTreeMap<u16, Location>> {
    let mut edges: BTreeMap<u16, BTreeMap<u16, Location>> = BTreeMap::new();
    for call in &context.calls.calls {
        if let Target::File(to) = call.target {
            edges.entry(call.location.file).or_default().entry(to).or_insert(call.location);
        }
    }
    edges
}

fn recursion(context: &Context<'_>, found: &mut Found) {
    let edges = edges(context);
    for (&file, targets) in &edges {
        let mut open: Vec<u16> = targets.keys().copied().collect();
        let mut reached = BTreeSet::new();
        while let Some(next) = open.pop() {
            if reached.insert(next) {
                open.extend(edges.get(&next).into_iter().flat_map(BTreeMap::keys));
            }
        }
        if reached.contains(&file) {
            let places: Vec<Location> =
                targets.iter().filter(|(to, _)| **to == file || reached.contains(to)).map(|it| *it.1).collect();
            found.add(&places, format!("U:{file}"), format!("file {file} can call itself"));
        }
    }
}

/// Longest chains of calls that are looked for; deeper ones are all too deep.
const DEEPEST: usize = 16;

fn nesting(context: &Context<'_>, found: &mut Found) {
    let limit = match context.image.family() {
        Family::SlcFixed | Family::Slc501 => 4,
        Family::Unknown => return,
        _ => 8,
    };
    let edges = edges(context);
    // Files at each depth of calls: bounded, so that files that call themselves end too.
    let mut level: BTreeSet<u16> = BTreeSet::from([2]);
    for depth in 1..=DEEPEST {
        let calls: Vec<(u16, Location)> =
            level.iter().filter_map(|file| edges.get(file)).flatten().map(|(to, at)| (*to, *at)).collect();
        if depth > limit && !calls.is_empty() {
            let places: Vec<Location> = calls.iter().map(|(_, at)| *at).collect();
            found.add(&places, "", format!("these calls are level {depth}; the processor takes {limit}"));
            return;
        }
        level = calls.into_iter().map(|(to, _)| to).collect();
    }
}

fn unreachable_rungs(context: &Context<'_>, found: &mut Found) {
    let mut labels: BTreeMap<u16, Vec<u32>> = BTreeMap::new();
    for label in context.calls.labels.iter().filter(|label| !label.jumps.is_empty()) {
        labels.entry(label.file).or_default().extend(label.defined.iter().map(|at| at.rung));
    }
    labels.values_mut().for_each(|rungs| rungs.sort_unstable());
    let stops = |step: &&Step<'_>| matches!(step.name, "TND" | "RET" | "SUS" | "JMP") && !step.gated;
    let mut covered: Option<(u16, u32)> = None;
    for step in context.steps.iter().filter(stops) {
        let Some(file) = context.image.program_file(step.at.file) else { continue };
        let end = first_end(file).and_then(|rung| u32::try_from(rung).ok()).unwrap_or(u32::MAX);
        let first = step.at.rung.saturating_add(1);
        let next = labels.get(&step.at.file).and_then(|all| all.get(all.partition_point(|rung| *rung < first)));
        let last = next.copied().unwrap_or(u32::MAX).min(end);
        let known = covered.is_some_and(|(file, until)| file == step.at.file && step.at.rung < until);
        if last > first && !known {
            covered = Some((step.at.file, last));
            let count = last - first;
            let place = Location { rung: first, instruction: 0, ..step.at };
            let (noun, verb) = if count == 1 { ("rung", "is") } else { ("rungs", "are") };
            found.add(
                &[step.at, place],
                "",
                format!("{count} {noun} after the {} in {} {verb} never scanned", step.name, step.at),
            );
        }
    }
}

fn suspend(context: &Context<'_>, found: &mut Found) {
    for step in context.steps.iter().filter(|step| step.name == "SUS") {
        found.add(&[step.at], "", "the program stops here in suspend mode");
    }
}

fn called_twice(context: &Context<'_>, found: &mut Found) {
    let keeps = |name| matches!(name, "TON" | "TOF" | "RTO" | "CTU" | "CTD" | "ONS" | "OSR" | "OSF");
    for file in context.calls.files.iter().filter(|file| file.reachable && file.called_by.len() > 1) {
        let callers = file.called_by.iter().filter(|at| context.runs(at.file)).copied().collect::<Vec<_>>();
        let first = context.steps.iter().find(|step| step.at.file == file.number && keeps(step.name));
        if let (Some(step), true) = (first, callers.len() > 1) {
            let message = format!("file {} is called in {} and holds {}", file.number, rungs(&callers), step.name);
            let places: Vec<Location> = callers.into_iter().chain([step.at]).collect();
            found.add(&places, format!("U:{}", file.number), message);
        }
    }
}
