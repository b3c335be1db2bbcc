//! The state of the project and the settings of the processor.

use ladder::{Address, Family, FileType, ProgramFileKind, Value};

use super::context::Context;
use super::elements::{COUNTERS, TIMERS};
use super::{Check, Found, Severity, rungs};
use crate::calls::EntryKind;
use crate::location::Location;
use crate::timers::TimerFindingKind as Kind;

pub(super) const CHECKS: &[Check] = &[
    Check {
        code: "CFG01",
        title: "rungs edited and not verified",
        severity: Severity::Warning,
        default_on: true,
        explanation: "These rungs were changed and not verified since: the code stored for the processor is that of the rungs before the change. What \
            is drawn is not what would run.",
        find: not_verified,
    },
    Check {
        code: "CFG02",
        title: "box and data table show different presets",
        severity: Severity::Note,
        default_on: true,
        explanation: "The preset or time base a timer or counter box shows is not the one in its element. The processor works with the element; the \
            box is an older copy.",
        find: |context, found| {
            for elements in [TIMERS, COUNTERS] {
                elements.report(context, found, Kind::DiffersFromData, |it| {
                    format!("the box of {} shows another preset or base than the data table", it.address)
                });
            }
        },
    },
    Check {
        code: "CFG03",
        title: "protection",
        severity: Severity::Note,
        default_on: true,
        explanation: "The project denies future access, or fields that can hold a password are in use. What they hold is not shown.",
        find: protection,
    },
    Check {
        code: "CFG04",
        title: "saved with a fault",
        severity: Severity::Warning,
        default_on: true,
        explanation: "S:1/13 is set: the processor was stopped by a major fault when this image was saved. S:6 holds the code of the fault.",
        find: faulted,
    },
    Check {
        code: "CFG05",
        title: "routine of a fault or interrupt without ladder",
        severity: Severity::Error,
        default_on: true,
        explanation: "A routine is set to a program file that does not exist or holds no ladder: the processor stops with a fault when it is \
            to run.",
        find: missing_routine,
    },
    Check {
        code: "CFG06",
        title: "timed interrupt that never comes",
        severity: Severity::Warning,
        default_on: true,
        explanation: "A program file is set for the selectable timed interrupt and its period is 0, which switches the interrupt off, and nothing in \
            the program sets the period.",
        find: timed_interrupt,
    },
    Check {
        code: "CFG07",
        title: "high-speed counter instruction used twice",
        severity: Severity::Error,
        default_on: true,
        explanation: "Two HSC instructions that run name the same high-speed counter.",
        find: high_speed,
    },
    Check {
        code: "CFG08",
        title: "high-speed counter with a high preset above its overflow",
        severity: Severity::Warning,
        default_on: true,
        explanation: "HIP is above OVF: the counter overflows before it gets to its high preset, which is never reached.",
        find: high_preset,
    },
    Check {
        code: "CFG09",
        title: "no fault routine",
        severity: Severity::Note,
        default_on: false,
        explanation: "S:29 is 0: after a major fault the processor stops without running a routine that could bring the machine to a safe \
            state or record what happened.",
        find: no_fault_routine,
    },
    Check {
        code: "CFG10",
        title: "indexed addresses may leave their data file",
        severity: Severity::Note,
        default_on: true,
        explanation: "S:2/3 is set and the program has indexed addresses: a wrong number in S:24 then reaches into another data file without a fault.",
        find: index_across_files,
    },
    Check {
        code: "CFG11",
        title: "overflow keeps the low bits",
        severity: Severity::Note,
        default_on: true,
        explanation: "S:2/14 is set, or the program sets it: an overflow of ADD, SUB, MUL or DIV keeps the low 16 bits instead of the largest number. \
            Meant for 32-bit sums; in all other math a result jumps from 32767 to -32768.",
        find: truncates,
    },
];

fn not_verified(context: &Context<'_>, found: &mut Found) {
    let mut places: Vec<Location> = Vec::new();
    for file in context.image.ladder_files() {
        for (rung, _) in (0..).zip(&file.rungs).filter(|(_, rung)| rung.edited) {
            places.push(Location { file: file.number, rung, instruction: 0 });
        }
    }
    if !places.is_empty() {
        let noun = if places.len() == 1 { "rung was" } else { "rungs were" };
        found.add(&places, "", format!("{} {noun} edited and not verified: {}", places.len(), rungs(&places)));
    }
}

fn protection(context: &Context<'_>, found: &mut Found) {
    let processor = &context.image.processor;
    if processor.deny_future_access == Some(true) {
        found.add(&[], "S:1/14", "future access is denied");
    }
    if processor.password_fields_used == Some(true) {
        found.add(&[], "", "fields that can hold a password are in use");
    }
}

fn faulted(context: &Context<'_>, found: &mut Found) {
    if context.status_word(1).is_some_and(|word| word & 1 << 13 != 0) {
        let code = context.status_word(6).unwrap_or(0);
        found.add(&[], "S:1/13", format!("saved while stopped by fault {code:04X}"));
    }
}

/// Program files set as routines: number and where it stands.
fn routines(context: &Context<'_>) -> Vec<(u16, String)> {
    let image = context.image;
    let mut all = Vec::new();
    if image.family() == Family::MicroLogix1000 || image.family() == Family::Unknown {
        return all;
    }
    let words: &[u16] = if image.family().is_micrologix() { &[29] } else { &[29, 31, 46] };
    for word in words {
        all.extend(context.status_word(*word).map(|number| (number, format!("S:{word}"))));
    }
    for file_type in [FileType::STI, FileType::EII, FileType::HSC] {
        let Some(file) = image.data_file(file_type, 0) else { continue };
        for element in 0..file.elements {
            let word = file.element_words(element).and_then(|words| words.first());
            all.extend(word.map(|number| (*number, format!("{file_type}:{element}.PFN"))));
        }
    }
    all
}

fn missing_routine(context: &Context<'_>, found: &mut Found) {
    for (number, source) in routines(context) {
        let ladder = context.image.program_file(number).is_some_and(|file| file.kind == ProgramFileKind::Ladder);
        if (3..=255).contains(&number) && !ladder {
            found.add(&[], &source, format!("{source} names program file {number}, which holds no ladder"));
        }
    }
}

fn timed_interrupt(context: &Context<'_>, found: &mut Found) {
    let image = context.image;
    let (file, period) = if image.family().is_micrologix() {
        let Some(member) = ladder::member_by_name(FileType::STI, "SPM") else { return };
        (
            Address::element(FileType::STI, 0, 0).with_word(0),
            Address::element(FileType::STI, 0, 0).with_word(member.word),
        )
    } else if image.family() == Family::Unknown {
        return;
    } else {
        (Address::element(FileType::S, 2, 31), Address::element(FileType::S, 2, 30))
    };
    let word = |address: &Address| match image.value_at(address) {
        Some(Value::Word(word)) => Some(word),
        _ => None,
    };
    let (Some(number), Some(0)) = (word(&file), word(&period)) else { return };
    let set = context.calls.files.iter().any(|file| {
        i32::from(file.number) == i32::from(number)
            && file.entries.iter().any(|it| it.kind == EntryKind::TimedInterrupt)
    });
    let Some(writes) = context.writes(&period) else { return };
    if set && writes.is_empty() && !context.steps.iter().any(|step| step.name == "STS") {
        found.add(&[], &period, format!("file {number} is set for the timed interrupt and {period} is 0"));
    }
}

fn high_speed(context: &Context<'_>, found: &mut Found) {
    let mut by_counter: std::collections::BTreeMap<String, Vec<Location>> = Default::default();
    for step in context.steps.iter().filter(|step| step.name == "HSC" && context.runs(step.at.file)) {
        if let Some(operand) = step.it.operands.first() {
            by_counter.entry(operand.to_string()).or_default().push(step.at);
        }
    }
    for (counter, places) in by_counter.into_iter().filter(|(_, places)| places.len() > 1) {
        found.add(&places, &counter, format!("{counter} stands in {} HSC: {}", places.len(), rungs(&places)));
    }
}

fn high_preset(context: &Context<'_>, found: &mut Found) {
    let Some(file) = context.image.data_file(FileType::HSC, 0) else { return };
    for element in 0..file.elements {
        let whole = Address::element(FileType::HSC, 0, element);
        let long = |name| {
            let member = ladder::member_by_name(FileType::HSC, name)?;
            match context.image.value_at(&whole.clone().with_word(member.word))? {
                Value::Long(value) => Some(value),
                _ => None,
            }
        };
        // An unused counter has no routine and no mode.
        let used = file.element_words(element).is_some_and(|words| words.first().is_some_and(|number| *number > 2));
        if let (true, Some(high), Some(over)) = (used, long("HIP"), long("OVF"))
            && high > over
        {
            found.add(&[], &whole, format!("{whole}.HIP is {high}, above {whole}.OVF, which is {over}"));
        }
    }
}

fn no_fault_routine(context: &Context<'_>, found: &mut Found) {
    if context.image.family() != Family::MicroLogix1000 && context.status_word(29) == Some(0) {
        found.add(&[], "S:29", "no fault routine is set");
    }
}

fn index_across_files(context: &Context<'_>, found: &mut Found) {
    if context.xref.notes().contains(&crate::xref::Note::IndexLeavesFiles) {
        found.add(&[], "S:2/3", "S:2/3 is set and the program has indexed addresses");
    }
}

fn truncates(context: &Context<'_>, found: &mut Found) {
    let select = Address::element(FileType::S, 2, 2).with_bit(14);
    let has_math = context.steps.iter().any(|step| matches!(step.name, "ADD" | "SUB" | "MUL" | "DIV"));
    if !has_math {
        return;
    }
    if context.xref.value(&select) == Some(Value::Bit(true)) {
        found.add(&[], &select, format!("{select} is set"));
        return;
    }
    let sets = |step: &&super::context::Step<'_>| {
        matches!(step.name, "OTE" | "OTL") && context.address(step, 0).as_ref() == Some(&select)
    };
    let places: Vec<Location> = context.steps.iter().filter(sets).map(|step| step.at).collect();
    if !places.is_empty() {
        found.add(&places, &select, format!("{select} is set in {}", rungs(&places)));
    }
}
