//! Coils: who else writes their bit, and what never sets or clears it.

use std::collections::{BTreeSet, HashMap};

use ladder::{Address, FileType};

use super::context::{Context, Step};
use super::{Check, Found, Severity, rungs};
use crate::location::Location;
use crate::xref::{Level, Through};

pub(super) const CHECKS: &[Check] = &[
    Check {
        code: "OUT01",
        title: "bit driven by more than one OTE",
        severity: Severity::Warning,
        default_on: true,
        explanation: "Each OTE writes its bit in every scan, 1 or 0. When two of them drive one bit, the one scanned last \
            decides, and the rungs before it only have an effect on what reads the bit in between. Join the conditions \
            in one rung, or give each rung a bit of its own. Rungs of which a jump or a subroutine call lets only one run \
            are listed too: whether the jumps exclude each other is not looked at.",
        find: duplicate_ote,
    },
    Check {
        code: "OUT02",
        title: "OTL that nothing unlatches",
        severity: Severity::Warning,
        default_on: true,
        explanation: "An OTL sets its bit and nothing in the program clears it: no OTU, no OTE, no move or copy over its \
            word. The bit stays 1 for ever, through power loss too, unless an operator terminal or another controller \
            clears it.",
        find: never_unlatched,
    },
    Check {
        code: "OUT03",
        title: "output driven from several program files",
        severity: Severity::Warning,
        default_on: true,
        explanation: "Coils in more than one program file write one physical output. Someone who reads one of the files \
            sees half of what switches the output.",
        find: several_files,
    },
    Check {
        code: "OUT04",
        title: "OTU of a bit that nothing sets",
        severity: Severity::Note,
        default_on: false,
        explanation: "An OTU clears a bit that no instruction of the program sets. Either the OTL is gone, or the bit comes \
            from outside the program, such as a button of an operator terminal.",
        find: never_latched,
    },
    Check {
        code: "OUT05",
        title: "OTE and OTL or OTU on one bit",
        severity: Severity::Warning,
        default_on: true,
        explanation: "An OTE writes its bit in every scan. A latch of the same bit lasts only until that OTE is scanned.",
        find: mixed_coils,
    },
    Check {
        code: "OUT06",
        title: "output bit written by a coil and by a word instruction",
        severity: Severity::Warning,
        default_on: true,
        explanation: "A coil drives one bit of an output word and a move, copy or other word instruction writes the word. \
            Whichever is scanned last decides.",
        find: word_over_coil,
    },
    Check {
        code: "OUT07",
        title: "bit read before the rung that drives it",
        severity: Severity::Note,
        default_on: false,
        explanation: "A contact stands in an earlier rung of the file than the only OTE of its bit, so it sees the state of \
            the scan before. That is one scan of delay, and often meant; where pulses of one scan or handshakes depend on \
            the order of rungs it decides how the machine behaves.",
        find: read_before_write,
    },
    Check {
        code: "OUT08",
        title: "output driven in a subroutine that is not called in every scan",
        severity: Severity::Note,
        default_on: false,
        explanation: "Every JSR to this file stands behind conditions. While the file is not scanned its coils are not \
            either: an output that was on stays on.",
        find: in_conditional_subroutine,
    },
    Check {
        code: "OUT09",
        title: "physical output latched",
        severity: Severity::Note,
        default_on: false,
        explanation: "An OTL on a physical output keeps it on through loss of power and change of mode: it can come on when \
            the controller starts, before any condition is looked at again.",
        find: latched_output,
    },
    Check {
        code: "OUT10",
        title: "storage bit used by more than one one-shot",
        severity: Severity::Error,
        default_on: true,
        explanation: "The storage bit of ONS, OSR and OSF remembers the state of their rung in the scan before. Shared by two \
            of them it remembers the wrong rung: one shots are lost or repeat in every scan. Give each its own bit.",
        find: shared_storage,
    },
    Check {
        code: "OUT11",
        title: "storage bit of a one-shot written elsewhere",
        severity: Severity::Warning,
        default_on: true,
        explanation: "Another instruction writes the storage bit of a one-shot, its whole word included. That makes the one-shot \
            fire again, or not at all. Rungs that examine S:1/15, the first scan, are not meant.",
        find: written_storage,
    },
];

/// Bits that the controller itself sets and clears.
fn is_managed(address: &Address) -> bool {
    use FileType as T;
    matches!(address.file_type, T::S | T::I | T::T | T::C | T::R | T::MG | T::PD | T::M0 | T::M1)
        || address.file_type.is_function_file()
}

type Coils<'s, 'a> = Vec<(Address, Vec<&'s Step<'a>>)>;

fn coils<'s, 'a>(context: &'s Context<'a>) -> Coils<'s, 'a> {
    context.by_address(|step| matches!(step.name, "OTE" | "OTL" | "OTU").then_some(0))
}

fn places(steps: &[&Step<'_>]) -> Vec<Location> {
    steps.iter().map(|step| step.at).collect()
}

fn duplicate_ote(context: &Context<'_>, found: &mut Found) {
    for (address, steps) in coils(context) {
        let drives: Vec<_> = steps.into_iter().filter(|it| it.name == "OTE" && context.runs(it.at.file)).collect();
        if drives.len() > 1 {
            let all = places(&drives);
            let message = format!("{address} is driven by {} OTE: rungs {}", drives.len(), rungs(&all));
            found.add(&all, &address, message);
        }
    }
}

fn never_unlatched(context: &Context<'_>, found: &mut Found) {
    one_sided(context, found, "OTL", |address| format!("nothing in the program clears {address}"));
}

fn never_latched(context: &Context<'_>, found: &mut Found) {
    one_sided(context, found, "OTU", |address| format!("nothing in the program sets {address}"));
}

/// Bits that only coils of one kind write.
fn one_sided(context: &Context<'_>, found: &mut Found, kind: &str, message: impl Fn(&Address) -> String) {
    for (address, steps) in coils(context) {
        if is_managed(&address) || steps.iter().any(|step| step.name != kind) {
            continue;
        }
        let Some(writes) = context.writes(&address) else { return };
        if writes.iter().all(|write| *write.mnemonic == *kind) {
            found.add(&places(&steps), &address, message(&address));
        }
    }
}

fn several_files(context: &Context<'_>, found: &mut Found) {
    for (address, mut steps) in coils(context) {
        steps.retain(|step| context.runs(step.at.file));
        let files: BTreeSet<u16> = steps.iter().map(|step| step.at.file).collect();
        if address.file_type == FileType::O && files.len() > 1 {
            let all = places(&steps);
            let message =
                format!("{address} is written by coils in {} program files: rungs {}", files.len(), rungs(&all));
            found.add(&all, &address, message);
        }
    }
}

fn mixed_coils(context: &Context<'_>, found: &mut Found) {
    for (address, mut steps) in coils(context) {
        steps.retain(|step| context.runs(step.at.file));
        let drives = steps.iter().any(|step| step.name == "OTE");
        if drives && steps.iter().any(|step| step.name != "OTE") {
            let all = places(&steps);
            found.add(&all, &address, format!("{address} has an OTE and a latch or unlatch: rungs {}", rungs(&all)));
        }
    }
}

fn word_over_coil(context: &Context<'_>, found: &mut Found) {
    for (address, mut steps) in coils(context) {
        steps.retain(|step| context.runs(step.at.file));
        if address.file_type != FileType::O || steps.is_empty() {
            continue;
        }
        let Some(writes) = context.writes(&address) else { return };
        let over = |level| matches!(level, Level::Word | Level::Range | Level::Element);
        let words: Vec<Location> = writes
            .iter()
            .filter(|it| it.definite && over(it.level) && it.through == Through::Operand && context.runs(it.at.file))
            .map(|it| it.at)
            .collect();
        if !words.is_empty() {
            let mut all = places(&steps);
            let message = format!("{address} has a coil, and its word is written in {}", rungs(&words));
            all.extend(&words);
            found.add(&all, &address, message);
        }
    }
}

fn read_before_write(context: &Context<'_>, found: &mut Found) {
    for (address, steps) in coils(context) {
        let [only] = steps.as_slice() else { continue };
        if only.name != "OTE" || is_managed(&address) || !context.runs(only.at.file) {
            continue;
        }
        let Some(touches) = context.touches(&address) else { return };
        if touches.iter().any(|it| it.role.writes() && it.at != only.at) {
            continue;
        }
        let is_contact = |it: &&super::context::Touch<'_>| *it.mnemonic == *"XIC" || *it.mnemonic == *"XIO";
        let early =
            touches.iter().filter(is_contact).filter(|it| it.at.file == only.at.file && it.at.rung < only.at.rung);
        let early: Vec<Location> = early.map(|it| it.at).collect();
        if !early.is_empty() {
            let message = format!("{address} is read in {} and driven later, in {}", rungs(&early), only.at);
            let all: Vec<Location> = [only.at].into_iter().chain(early).collect();
            found.add(&all, &address, message);
        }
    }
}

fn in_conditional_subroutine(context: &Context<'_>, found: &mut Found) {
    let mut calls: HashMap<u16, bool> = HashMap::new();
    for step in context.steps.iter().filter(|step| step.name == "JSR") {
        if let Some(call) = context.calls.calls.iter().find(|call| call.location == step.at)
            && let crate::calls::Target::File(file) = call.target
        {
            *calls.entry(file).or_insert(true) &= step.gated;
        }
    }
    for step in context.steps.iter().filter(|step| step.name == "OTE") {
        let conditional = calls.get(&step.at.file) == Some(&true)
            && context.calls.file(step.at.file).is_some_and(|file| file.entries.is_empty());
        if conditional
            && let Some(address) = context.address(step, 0)
            && address.file_type == FileType::O
        {
            let message = format!("{address} keeps its state while no rung calls file {}", step.at.file);
            found.add(&[step.at], &address, message);
        }
    }
}

fn latched_output(context: &Context<'_>, found: &mut Found) {
    for (address, steps) in coils(context) {
        let latches: Vec<_> = steps.into_iter().filter(|step| step.name == "OTL").collect();
        if address.file_type == FileType::O && !latches.is_empty() {
            found.add(
                &places(&latches),
                &address,
                format!("{address} is latched and keeps its state through power loss"),
            );
        }
    }
}

fn storages<'s, 'a>(context: &'s Context<'a>) -> Coils<'s, 'a> {
    context.by_address(|step| matches!(step.name, "ONS" | "OSR" | "OSF").then_some(0))
}

fn shared_storage(context: &Context<'_>, found: &mut Found) {
    for (address, mut steps) in storages(context) {
        steps.retain(|step| context.runs(step.at.file));
        if steps.len() > 1 {
            let all = places(&steps);
            let message = format!("{address} is the storage bit of {} one-shots: rungs {}", steps.len(), rungs(&all));
            found.add(&all, &address, message);
        }
    }
}

fn written_storage(context: &Context<'_>, found: &mut Found) {
    for (address, steps) in storages(context) {
        let own = places(&steps);
        let Some(writes) = context.writes(&address) else { return };
        let others = writes.iter().filter(|it| {
            it.definite && !own.contains(&it.at) && context.runs(it.at.file) && !context.is_first_scan(it.at)
        });
        let others: Vec<Location> = others.map(|it| it.at).collect();
        if !others.is_empty() {
            let message = format!("{address} is the storage bit of a one-shot and is written in {}", rungs(&others));
            let all: Vec<Location> = own.into_iter().chain(others).collect();
            found.add(&all, &address, message);
        }
    }
}
