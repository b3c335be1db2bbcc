//! Inputs, outputs, forces, messages, high-speed counters.

use std::collections::BTreeMap;

use instr::Kind;
use ladder::{Address, FileType, Force};

use super::context::Context;
use super::{Check, Found, Severity, rungs};
use crate::location::Location;
use crate::xref::{FindingKind, Level, Reason, Through};

pub(super) const CHECKS: &[Check] = &[
    Check {
        code: "IOC01",
        title: "input written by the program",
        severity: Severity::Warning,
        default_on: true,
        explanation: "An instruction writes the input image. The next input scan writes the real state over it, so the rungs in between see \
            something the terminals do not show. Common in programs for training and simulation, dangerous on a machine.",
        find: input_written,
    },
    Check {
        code: "IOC02",
        title: "force on an I/O point",
        severity: Severity::Warning,
        default_on: true,
        explanation: "The project holds a force: while forces are enabled the point has the forced state, whatever the field device or the rungs say.",
        find: forces,
    },
    Check {
        code: "IOC03",
        title: "forces enabled",
        severity: Severity::Warning,
        default_on: true,
        explanation: "The project holds forces and status bit S:1/5 is set: they were in force when this image was saved.",
        find: forces_enabled,
    },
    Check {
        code: "IOC04",
        title: "I/O address without a point",
        severity: Severity::Error,
        default_on: true,
        explanation: "The I/O configuration has no such slot or word, or the module no such point.",
        find: no_point,
    },
    Check {
        code: "IOC05",
        title: "I/O without symbol and description",
        severity: Severity::Note,
        default_on: true,
        explanation: "Inputs and outputs that the program uses and nobody has named: what is wired there stands on the drawings only.",
        find: undocumented,
    },
    Check {
        code: "IOC06",
        title: "output examined that nothing drives",
        severity: Severity::Warning,
        default_on: true,
        explanation: "A contact examines an output bit no instruction writes: it never changes.",
        find: dead_output,
    },
    Check {
        code: "IOC07",
        title: "message block used by more than one MSG",
        severity: Severity::Error,
        default_on: true,
        explanation: "Each MSG keeps its state and its settings in its block. Two of them on one block disturb each other.",
        find: shared_message,
    },
    Check {
        code: "IOC08",
        title: "MSG without conditions",
        severity: Severity::Note,
        default_on: true,
        explanation: "A message starts when its rung becomes true. With a rung that is always true nothing in the rung paces it or starts it \
            anew: usual is XIO of its own EN bit, or a timer.",
        find: unconditional_message,
    },
    Check {
        code: "IOC09",
        title: "control bits of a message written",
        severity: Severity::Note,
        default_on: true,
        explanation: "A coil writes EN, TO or another control bit of a message. Setting TO or clearing EN while the message is under way is the \
            usual way to try again and goes wrong when it happens in the wrong scan; look at what starts it.",
        find: message_bits,
    },
    Check {
        code: "IOC10",
        title: "failure of a message not looked at",
        severity: Severity::Note,
        default_on: true,
        explanation: "Nothing in the program reads the ER bit of this message: when communication fails, the program goes on with old data.",
        find: message_errors,
    },
    Check {
        code: "IOC11",
        title: "module that is not known",
        severity: Severity::Note,
        default_on: true,
        explanation: "The project names a module by a code this program has no catalogue number for. Its points are taken from the counts \
            stored with it.",
        find: unknown_module,
    },
];

fn input_written(context: &Context<'_>, found: &mut Found) {
    let mut inputs: BTreeMap<String, Vec<Location>> = BTreeMap::new();
    for step in context.steps.iter().filter(|step| context.runs(step.at.file)) {
        let Some(form) = step.form else { continue };
        // IIM reads the terminals: writing the image is what it is for.
        if step.name == "IIM" {
            continue;
        }
        for (index, operand) in form.operands.iter().enumerate() {
            if operand.role.writes()
                && let Some(address) = context.address(step, index).filter(|it| it.file_type == FileType::I)
            {
                inputs.entry(address.to_string()).or_default().push(step.at);
            }
        }
    }
    for (address, places) in inputs {
        found.add(&places, &address, format!("{address} is an input and is written in {}", rungs(&places)));
    }
}

fn forces(context: &Context<'_>, found: &mut Found) {
    for file in &context.image.data_files {
        for (word, force) in (0_u16..).zip(&file.forces) {
            if *force == Force::NONE {
                continue;
            }
            let name = match context.image.io.address_of(file.file_type, word) {
                Some(address) => address.to_string(),
                None => format!("{} word {word}", file.label()),
            };
            for bit in 0..16 {
                let state = match (force.on >> bit & 1, force.off >> bit & 1) {
                    (_, 0) => "off",
                    (1, _) => "on",
                    _ => continue,
                };
                found.add(&[], format!("{name}/{bit}"), format!("{name}/{bit} is forced {state}"));
            }
        }
    }
}

fn forces_enabled(context: &Context<'_>, found: &mut Found) {
    // The bit alone is set in nearly every project: it is how they are made.
    let present = context.image.data_files.iter().any(|file| file.forces.iter().any(|force| *force != Force::NONE));
    if present && context.status_word(1).is_some_and(|word| word & 1 << 5 != 0) {
        found.add(&[], "S:1/5", "forces are present, and were enabled when this image was saved");
    }
}

fn no_point(context: &Context<'_>, found: &mut Found) {
    for it in &context.findings().list {
        if it.kind == FindingKind::NoSuchPoint && it.expected != Some(Reason::NotVerified) {
            found.add(&it.locations, &it.address, format!("there is no I/O point {}", it.address));
        }
    }
}

/// Names said of a finding about many addresses.
const SAID: usize = 8;

fn undocumented(context: &Context<'_>, found: &mut Found) {
    let named: Vec<&Address> = context
        .xref
        .named()
        .into_iter()
        .filter(|it| matches!(it.file_type, FileType::I | FileType::O) && it.bit.is_some())
        .collect();
    let bare: Vec<&&Address> =
        named.iter().filter(|it| crate::coverage::documented(context.documentation, it) == (false, false)).collect();
    if !bare.is_empty() {
        let said: Vec<String> = bare.iter().take(SAID).map(ToString::to_string).collect();
        let more = if bare.len() > SAID { ", ..." } else { "" };
        let message = format!(
            "{} of {} I/O bits in use have neither symbol nor description: {}{more}",
            bare.len(),
            named.len(),
            said.join(", ")
        );
        found.add(&[], "", message);
    }
}

fn dead_output(context: &Context<'_>, found: &mut Found) {
    for (address, steps) in context.by_address(|step| matches!(step.name, "XIC" | "XIO").then_some(0)) {
        if address.file_type != FileType::O {
            continue;
        }
        let Some(writes) = context.writes(&address) else { return };
        if writes.is_empty() {
            let places: Vec<Location> = steps.iter().map(|step| step.at).collect();
            found.add(&places, &address, format!("{address} is examined in {} and nothing drives it", rungs(&places)));
        }
    }
}

/// The operand that is the block of a message.
fn block(step: &super::context::Step<'_>) -> Option<usize> {
    let is_block = |kind| matches!(kind, Kind::MessageBlock | Kind::ControlBlock);
    (step.name == "MSG").then(|| step.form?.operands.iter().position(|operand| is_block(operand.kind)))?
}

fn shared_message(context: &Context<'_>, found: &mut Found) {
    for (address, steps) in context.by_address(block) {
        let places: Vec<Location> =
            steps.iter().filter(|step| context.runs(step.at.file)).map(|step| step.at).collect();
        if places.len() > 1 {
            found.add(&places, &address, format!("{address} is the block of {} MSG: {}", places.len(), rungs(&places)));
        }
    }
}

fn unconditional_message(context: &Context<'_>, found: &mut Found) {
    for step in context.steps.iter().filter(|step| step.name == "MSG" && !step.gated) {
        if let Some(address) = block(step).and_then(|index| context.address(step, index)) {
            found.add(&[step.at], &address, format!("the rung of MSG {address} is always true"));
        }
    }
}

/// Messages with a block in a message file, with the rungs that name it.
fn messages(context: &Context<'_>) -> Vec<(Address, Vec<Location>)> {
    let all = context.by_address(block).into_iter().filter(|(address, _)| address.file_type == FileType::MG);
    all.map(|(address, steps)| (address, steps.iter().map(|step| step.at).collect())).collect()
}

fn message_bits(context: &Context<'_>, found: &mut Found) {
    let coil = |step: &super::context::Step<'_>| matches!(step.name, "OTE" | "OTL" | "OTU").then_some(0);
    let blocks: Vec<Address> = messages(context).into_iter().map(|(address, _)| address).collect();
    for (address, steps) in context.by_address(coil) {
        if address.element_address().is_some_and(|element| blocks.contains(&element)) {
            let places: Vec<Location> = steps.iter().map(|step| step.at).collect();
            found.add(&places, &address, format!("{address} is written in {}", rungs(&places)));
        }
    }
}

fn message_errors(context: &Context<'_>, found: &mut Found) {
    let Some(error) = ladder::member_by_name(FileType::MG, "ER") else { return };
    for (address, places) in messages(context) {
        let bit = Address { word: Some(error.word), ..address.clone() }.with_bit(error.bit.unwrap_or(0));
        let Some(reads) = context.reads(&bit) else { return };
        let looks = |it: &super::context::Touch<'_>| {
            it.through == Through::Operand && (it.level < Level::Element || *it.mnemonic != *"MSG")
        };
        if !reads.iter().any(|it| looks(it) && *it.mnemonic != *"MSG") {
            found.add(&places, &address, format!("nothing reads {bit}"));
        }
    }
}

fn unknown_module(context: &Context<'_>, found: &mut Found) {
    for slot in &context.image.io.slots {
        if slot.module.catalog.is_none() && slot.number > 0 {
            found.add(&[], format!("slot {}", slot.number), format!("slot {}: {}", slot.number, slot.module.identity));
        }
    }
}
