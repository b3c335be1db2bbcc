//! Timers: presets, resets, time bases.

use std::collections::{BTreeSet, HashMap};

use instr::Category;
use ladder::{Address, FileType, Operand, TimeBase, Value};

use super::context::{Context, Step};
use super::elements::{COUNTERS, TIMERS};
use super::{Check, Found, Severity, rungs};
use crate::location::Location;
use crate::timers::TimerFindingKind as Kind;

pub(super) const CHECKS: &[Check] = &[
    Check {
        code: "TIM01",
        title: "timer used by several timer instructions",
        severity: Severity::Warning,
        default_on: true,
        explanation: "Two timer instructions share one element. The one whose rung is false resets what the other one counts; \
            when both are true the element counts faster. Give each its own timer.",
        find: |context, found| TIMERS.shared(context, found),
    },
    Check {
        code: "TIM02",
        title: "preset 0 that nothing writes",
        severity: Severity::Warning,
        default_on: true,
        explanation: "The timer is done in the scan it starts. Perhaps the preset was never entered; an operator terminal may \
            write it while the machine runs.",
        find: |context, found| {
            TIMERS.report(context, found, Kind::PresetNeverSet, |it| {
                format!("{} has preset 0 and nothing in the program writes it", it.address)
            })
        },
    },
    Check {
        code: "TIM03",
        title: "negative preset or accumulated value",
        severity: Severity::Error,
        default_on: true,
        explanation: "A timer that runs with PRE or ACC below 0 stops the processor with major fault 0034.",
        find: |context, found| {
            TIMERS.report(context, found, Kind::Negative, |it| {
                format!("{} has a preset or accumulated value below 0: fault 0034 when it runs", it.address)
            })
        },
    },
    Check {
        code: "TIM04",
        title: "RES of an off-delay timer",
        severity: Severity::Warning,
        default_on: true,
        explanation: "RES clears the bits of a TOF while its rung may be false and timing: the manuals call the result \
            unpredictable and warn of machine motion. Let the rung of the TOF end the time instead.",
        find: |context, found| {
            TIMERS.report(context, found, Kind::ResetOfOffDelay, |it| {
                format!("{} is a TOF and is reset in {}", it.address, rungs(&it.locations))
            })
        },
    },
    Check {
        code: "TIM05",
        title: "retentive timer without reset",
        severity: Severity::Warning,
        default_on: true,
        explanation: "An RTO keeps its time while its rung is false and through power loss. Nothing resets it or writes its ACC: \
            it gets to its preset once and stays done.",
        find: |context, found| {
            TIMERS
                .report(context, found, Kind::NeverReset, |it| format!("{} is an RTO that nothing resets", it.address))
        },
    },
    Check {
        code: "TIM06",
        title: "timer read and never timed",
        severity: Severity::Warning,
        default_on: true,
        explanation: "The program examines a timer that no instruction times and nothing else writes. Its bits never change.",
        find: |context, found| TIMERS.only_read(context, found),
    },
    Check {
        code: "TIM07",
        title: "timer that nothing reads",
        severity: Severity::Note,
        default_on: true,
        explanation: "The timer runs and no instruction looks at its bits or its time. An operator terminal may; otherwise it is \
            left over.",
        find: |context, found| TIMERS.never_read(context, found),
    },
    Check {
        code: "TIM08",
        title: "mixed time bases",
        severity: Severity::Warning,
        default_on: true,
        explanation: "Ticks of one time base are used as ticks of another: one element is timed with two bases, a PRE or ACC is moved or \
            compared between timers of different bases, or one word sets the presets of such timers. 100 ticks are 100 s with \
            base 1.0, 1 s with 0.01 and 0.1 s with 0.001.",
        find: mixed_bases,
    },
    Check {
        code: "TIM09",
        title: "status bit of a timer or counter written",
        severity: Severity::Warning,
        default_on: true,
        explanation: "A coil writes EN, TT, DN or another status bit of an element that an instruction runs. The instruction \
            writes them too, in every scan: which state holds depends on the order of rungs.",
        find: written_status,
    },
    Check {
        code: "TIM10",
        title: "timer without conditions that nothing resets",
        severity: Severity::Note,
        default_on: true,
        explanation: "No condition stands before the timer. A TON or RTO then times once after the start and stays done; a TOF never \
            times at all. Meant for a delay after power-up.",
        find: unconditional,
    },
    Check {
        code: "TIM11",
        title: "exact comparison with a running time",
        severity: Severity::Warning,
        default_on: true,
        explanation: "EQU asks for one exact tick of a timer with base 0.01 or 0.001. Accumulated time moves by as many ticks as a scan \
            lasts, so that tick can be passed over. Use GEQ, or LIM with some width.",
        find: exact_time,
    },
    Check {
        code: "TIM12",
        title: "number that equals the preset it is compared with",
        severity: Severity::Note,
        default_on: true,
        explanation: "ACC is compared with a constant that is the preset of the same element today. When someone changes the preset, \
            the constant stays. Compare with .PRE, or examine DN.",
        find: preset_as_number,
    },
    Check {
        code: "TIM13",
        title: "time base 1.0 with a short preset",
        severity: Severity::Note,
        default_on: false,
        explanation: "With a time base of 1.0 s the time is up to one second short. For a preset of 1 or 2 that is a large part of it: use \
            base 0.01.",
        find: coarse_base,
    },
    Check {
        code: "TIM14",
        title: "preset in a timer or counter that the program does not use",
        severity: Severity::Note,
        default_on: false,
        explanation: "The data table holds a preset for an element nothing in the program refers to: left from logic that is gone, or \
            a spare.",
        find: |context, found| {
            for elements in [TIMERS, COUNTERS] {
                elements
                    .report(context, found, Kind::Unused, |it| format!("{} has a preset and is not used", it.address));
            }
        },
    },
];

/// Time base of each timer whose base is known.
fn bases(context: &Context<'_>) -> HashMap<Address, TimeBase> {
    let timers = context.timers.elements.iter().filter(|it| it.address.file_type == FileType::T);
    timers.filter(|it| !it.instructions.is_empty()).filter_map(|it| Some((it.address.clone(), it.base?))).collect()
}

/// The timer and its base when an operand is PRE or ACC of a timer.
fn ticks(bases: &HashMap<Address, TimeBase>, address: &Address) -> Option<TimeBase> {
    if address.file_type != FileType::T || !matches!(address.member(), Some("PRE" | "ACC")) {
        return None;
    }
    bases.get(&address.element_address()?).copied()
}

fn mixed_bases(context: &Context<'_>, found: &mut Found) {
    for timer in context.timers.elements.iter().filter(|it| it.address.file_type == FileType::T) {
        let all: BTreeSet<TimeBase> = timer.instructions.iter().filter_map(|it| it.base).collect();
        if all.len() > 1 {
            let places: Vec<Location> = timer.instructions.iter().map(|it| it.location).collect();
            found.add(&places, &timer.address, format!("{} is timed with {}", timer.address, text(&all)));
        }
    }
    let bases = bases(context);
    let mut sources: Vec<(Address, BTreeSet<TimeBase>, Vec<Location>)> = Vec::new();
    let mut numbers: HashMap<Address, usize> = HashMap::new();
    for step in &context.steps {
        let compares = step.info.is_some_and(|info| info.category == Category::Compare);
        if step.name != "MOV" && !compares {
            continue;
        }
        let addresses: Vec<Address> = (0..step.it.operands.len()).filter_map(|i| context.address(step, i)).collect();
        let used: BTreeSet<TimeBase> = addresses.iter().filter_map(|address| ticks(&bases, address)).collect();
        if used.len() > 1 {
            let names: Vec<String> = addresses.iter().map(ToString::to_string).collect();
            found.add(&[step.at], names.join(", "), format!("{} joins {}", step.name, text(&used)));
        }
        // One word that sets presets of several timers.
        if step.name == "MOV"
            && let [source, dest] = addresses.as_slice()
            && source.file_type != FileType::T
            && source.is_direct()
            && dest.member() == Some("PRE")
            && let Some(base) = ticks(&bases, dest)
        {
            let number = *numbers.entry(source.clone()).or_insert_with(|| {
                sources.push((source.clone(), BTreeSet::new(), Vec::new()));
                sources.len() - 1
            });
            if let Some((_, all, places)) = sources.get_mut(number) {
                all.insert(base);
                places.push(step.at);
            }
        }
    }
    for (source, all, places) in sources.iter().filter(|(_, all, _)| all.len() > 1) {
        found.add(places, source, format!("{source} sets presets of timers with {}", text(all)));
    }
}

fn text(bases: &BTreeSet<TimeBase>) -> String {
    let all: Vec<&str> = bases.iter().map(|base| base.text()).collect();
    format!("time bases {}", all.join(" and "))
}

fn written_status(context: &Context<'_>, found: &mut Found) {
    let active: HashMap<&Address, Location> = context
        .timers
        .elements
        .iter()
        .filter_map(|it| Some((&it.address, it.instructions.first()?.location)))
        .collect();
    for (address, steps) in context.by_address(|step| matches!(step.name, "OTE" | "OTL" | "OTU").then_some(0)) {
        if !matches!(address.file_type, FileType::T | FileType::C) || address.word.unwrap_or(0) != 0 {
            continue;
        }
        let Some(own) = address.element_address().and_then(|element| active.get(&element).copied()) else { continue };
        let mut places: Vec<Location> = steps.iter().map(|step| step.at).collect();
        let message = format!("{address} is written in {} and by its instruction in {own}", rungs(&places));
        places.push(own);
        found.add(&places, &address, message);
    }
}

fn unconditional(context: &Context<'_>, found: &mut Found) {
    for step in context.steps.iter().filter(|step| matches!(step.name, "TON" | "RTO" | "TOF") && !step.gated) {
        let Some(address) = context.address(step, 0) else { continue };
        let Some(timer) = context.timers.elements.iter().find(|it| it.address == address) else { continue };
        if step.name == "TOF" {
            found.add(&[step.at], &address, format!("{address} is a TOF whose rung is never false: it never times"));
            continue;
        }
        let acc = Address { word: Some(2), ..address.clone() };
        let Some(writes) = context.writes(&acc) else { return };
        if timer.reset_by.is_empty() && writes.iter().all(|write| write.at == step.at) {
            found.add(&[step.at], &address, format!("{address} times once after the start: its rung is always true"));
        }
    }
}

fn exact_time(context: &Context<'_>, found: &mut Found) {
    let bases = bases(context);
    for step in context.steps.iter().filter(|step| step.name == "EQU") {
        let zero = step.it.operands.iter().any(|it| it.constant().and_then(|it| it.as_integer()) == Some(0));
        for address in (0..step.it.operands.len()).filter_map(|i| context.address(step, i)) {
            let fine = ticks(&bases, &address).is_some_and(|base| base != TimeBase::Second);
            if fine && !zero && address.member() == Some("ACC") {
                found.add(&[step.at], &address, format!("EQU on {address} can miss the tick it waits for"));
            }
        }
    }
}

fn preset_as_number(context: &Context<'_>, found: &mut Found) {
    let compares = |step: &&Step<'_>| step.info.is_some_and(|info| info.category == Category::Compare);
    for step in context.steps.iter().filter(compares) {
        for (index, operand) in step.it.operands.iter().enumerate() {
            let Some(number) = operand.constant().and_then(|it| it.as_integer()).filter(|it| *it != 0) else {
                continue;
            };
            for other in (0..step.it.operands.len()).filter(|other| *other != index) {
                let Some(address) = context.address(step, other) else { continue };
                if !matches!(address.file_type, FileType::T | FileType::C) || address.member() != Some("ACC") {
                    continue;
                }
                let preset = Address { word: Some(1), ..address.clone() };
                if context
                    .xref
                    .value(&preset)
                    .is_some_and(|it| matches!(it, Value::Word(pre) if i64::from(pre) == number))
                {
                    found.add(
                        &[step.at],
                        &address,
                        format!("{address} is compared with {number}, its preset: use {preset}"),
                    );
                }
            }
        }
    }
}

fn coarse_base(context: &Context<'_>, found: &mut Found) {
    for step in context.steps.iter().filter(|step| matches!(step.name, "TON" | "TOF" | "RTO")) {
        let base = step.it.operands.get(1).map(Operand::to_string).and_then(|text| TimeBase::from_text(&text));
        let Some(address) = context.address(step, 0) else { continue };
        let preset = Operand::Address(Address { word: Some(1), ..address.clone() });
        let ticks = context.value(&preset);
        if base == Some(TimeBase::Second)
            && let Some(ticks) = ticks
            && (1.0..=2.0).contains(&ticks)
        {
            found.add(&[step.at], &address, format!("{address} times {ticks} s in steps of 1 s"));
        }
    }
}
