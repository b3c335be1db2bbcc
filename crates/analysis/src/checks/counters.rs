//! Counters: presets, resets, who counts.

use ladder::{Address, FileType};

use super::context::Context;
use super::elements::COUNTERS;
use super::{Check, Found, Severity, rungs};
use crate::timers::TimerFindingKind as Kind;

pub(super) const CHECKS: &[Check] = &[
    Check {
        code: "CNT01",
        title: "counter used by several counter instructions",
        severity: Severity::Warning,
        default_on: true,
        explanation: "Several instructions count with one element. CU and CD remember the state of one rung: shared, counts are lost or \
            doubled. One CTU with one CTD is an up/down counter and not meant here.",
        find: |context, found| COUNTERS.shared(context, found),
    },
    Check {
        code: "CNT02",
        title: "DN of a counter with preset 0",
        severity: Severity::Warning,
        default_on: true,
        explanation: "The preset is 0, nothing writes it, and the program examines the counter's DN: DN is on from the start.",
        find: preset_never_set,
    },
    Check {
        code: "CNT03",
        title: "counter that nothing resets",
        severity: Severity::Warning,
        default_on: true,
        explanation: "Nothing resets the counter or writes its ACC. It keeps its count through power loss and after its preset goes on to \
            the limit of a word.",
        find: |context, found| {
            COUNTERS
                .report(context, found, Kind::NeverReset, |it| format!("nothing in the program resets {}", it.address))
        },
    },
    Check {
        code: "CNT04",
        title: "counter without conditions",
        severity: Severity::Warning,
        default_on: true,
        explanation: "A counter counts when its rung changes from false to true. Without a condition the rung never changes: it \
            counts at most once.",
        find: unconditional,
    },
    Check {
        code: "CNT05",
        title: "counter read and never counted",
        severity: Severity::Warning,
        default_on: true,
        explanation: "The program examines a counter that no instruction counts and nothing else writes.",
        find: |context, found| COUNTERS.only_read(context, found),
    },
    Check {
        code: "CNT06",
        title: "counter that nothing reads",
        severity: Severity::Note,
        default_on: true,
        explanation: "The counter counts and no instruction looks at it. An operator terminal may.",
        find: |context, found| COUNTERS.never_read(context, found),
    },
    Check {
        code: "CNT07",
        title: "negative preset of a counter",
        severity: Severity::Note,
        default_on: true,
        explanation: "Counters take negative presets. DN is then on while ACC is at or above that number, 0 included.",
        find: negative,
    },
];

fn preset_never_set(context: &Context<'_>, found: &mut Found) {
    for it in COUNTERS.findings(context, Kind::PresetNeverSet) {
        let done = it.address.clone().with_bit(13);
        let Some(reads) = context.reads(&done) else { return };
        let contacts = reads.iter().filter(|read| *read.mnemonic == *"XIC" || *read.mnemonic == *"XIO");
        let readers: Vec<_> = contacts.map(|read| read.at).collect();
        if !readers.is_empty() {
            let mut all = it.locations.clone();
            let message = format!("{} has preset 0 and its DN is examined in {}", it.address, rungs(&readers));
            all.extend(readers);
            found.add(&all, &it.address, message);
        }
    }
}

fn unconditional(context: &Context<'_>, found: &mut Found) {
    for step in context.steps.iter().filter(|step| matches!(step.name, "CTU" | "CTD") && !step.gated) {
        if let Some(address) = context.address(step, 0) {
            found.add(&[step.at], &address, format!("the rung of {} {address} is always true", step.name));
        }
    }
}

fn negative(context: &Context<'_>, found: &mut Found) {
    for counter in context.timers.active().filter(|it| it.address.file_type == FileType::C) {
        let places: Vec<_> = counter.instructions.iter().map(|it| it.location).collect();
        let address: &Address = &counter.address;
        if let Some(preset) = counter.preset.filter(|preset| *preset < 0) {
            found.add(&places, address, format!("{address} has preset {preset}"));
        }
    }
}
