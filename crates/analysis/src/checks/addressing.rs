//! Addresses: what lies outside the data table, pointers, index register, shared control elements.

use std::collections::{HashMap, HashSet};

use instr::Kind;
use ladder::{Address, FileType, Operand, Place, Value};

use super::context::{Context, Step};
use super::{Check, Found, Severity, rungs};
use crate::location::Location;
use crate::xref::{FindingKind, Reason};

pub(super) const CHECKS: &[Check] = &[
    Check {
        code: "ADR01",
        title: "address outside the data table",
        severity: Severity::Error,
        default_on: true,
        explanation: "The data file does not exist, or the instruction reaches beyond its end. RSLogix does not verify such a rung.",
        find: outside,
    },
    Check {
        code: "ADR02",
        title: "pointer that leads outside its file",
        severity: Severity::Error,
        default_on: true,
        explanation: "The address in brackets is moved from a constant that is no element of the file, or nothing in the program writes it \
            and it holds such a number. Executed like that, the processor stops with a fault.",
        find: pointer,
    },
    Check {
        code: "ADR03",
        title: "index register overwritten before an indexed address",
        severity: Severity::Warning,
        default_on: true,
        explanation: "File, shift and sequencer instructions use S:24 for themselves and leave their own number there. Between the rung \
            that sets S:24 and the indexed address stands one of them, so the address means another word than the one that was \
            chosen. Set S:24 right before each use.",
        find: index_overwritten,
    },
    Check {
        code: "ADR04",
        title: "indexed address, and nothing sets S:24",
        severity: Severity::Warning,
        default_on: true,
        explanation: "An address with # is S:24 words further on, and no instruction of the program moves a number to S:24.",
        find: index_never_set,
    },
    Check {
        code: "ADR05",
        title: "control element shared",
        severity: Severity::Error,
        default_on: true,
        explanation: "Two file, shift, sequencer or ASCII instructions keep length, position and state in one control element and disturb each \
            other. FFL with FFU, LFL with LFU and SQO with SQC or SQL on one element belong together and are not meant.",
        find: shared_control,
    },
    Check {
        code: "ADR06",
        title: "copy onto its own source",
        severity: Severity::Note,
        default_on: true,
        explanation: "Source and destination of the COP overlap. It copies from the lowest word on: where the destination lies above the source, \
            what was just written is copied again and the first element fills the file.",
        find: overlapping_copy,
    },
    Check {
        code: "ADR07",
        title: "operand or instruction that is not complete",
        severity: Severity::Error,
        default_on: true,
        explanation: "An operand was never entered, or a symbol has no address: the rung cannot be verified or run.",
        find: incomplete,
    },
    Check {
        code: "ADR08",
        title: "instruction that is not known here",
        severity: Severity::Note,
        default_on: true,
        explanation: "The code of the instruction is not in the table of known instructions, or it has a number of operands no known form has. What \
            it reads and writes is not known, and no check can say anything about it.",
        find: unknown,
    },
    Check {
        code: "ADR09",
        title: "length or position of 0 elements",
        severity: Severity::Note,
        default_on: true,
        explanation: "A COP or FLL with length 0 copies nothing.",
        find: no_length,
    },
];

fn outside(context: &Context<'_>, found: &mut Found) {
    for it in &context.findings().list {
        let what = match it.kind {
            FindingKind::BeyondEnd => "reaches beyond the end of its data file",
            FindingKind::NoSuchFile => "lies in a data file the project does not have",
            _ => continue,
        };
        if it.expected != Some(Reason::NotVerified) {
            found.add(&it.locations, &it.address, format!("{} {what}", it.address));
        }
    }
}

/// Constants that MOV puts into each address, and who else writes it.
fn pointer(context: &Context<'_>, found: &mut Found) {
    let mut moved: HashMap<Address, Vec<(i64, Location)>> = HashMap::new();
    for step in context.steps.iter().filter(|step| step.name == "MOV") {
        if let (Some(number), Some(dest)) = (step.integer(0), context.address(step, 1)) {
            moved.entry(dest).or_default().push((number, step.at));
        }
    }
    let mut said: HashSet<(Address, i64)> = HashSet::new();
    for step in context.steps.iter().filter(|step| context.runs(step.at.file)) {
        for address in (0..step.it.operands.len()).filter_map(|index| context.address(step, index)) {
            let Place::Indirect(inner) = &address.element else { continue };
            let size = address.file.number().and_then(|number| context.image.data_file(address.file_type, number));
            let Some(size) = size.filter(|_| !address.file_type.has_slots()).map(|file| i64::from(file.elements))
            else {
                continue;
            };
            let mut bad = |number: i64, places: &[Location], what: &str| {
                if !(0..size).contains(&number) && said.insert((address.clone(), number)) {
                    found.add(
                        places,
                        &address,
                        format!("{inner} {what} {number}, and {} has {size} elements", file_of(&address)),
                    );
                }
            };
            for (number, at) in moved.get(&**inner).into_iter().flatten() {
                bad(*number, &[step.at, *at], "is set to");
            }
            let Some(writes) = context.writes(inner) else { return };
            if let (true, Some(Value::Word(now))) = (writes.is_empty(), context.xref.value(inner)) {
                bad(now.into(), &[step.at], "holds");
            }
        }
    }
}

fn file_of(address: &Address) -> String {
    format!("{}{}", address.file_type, address.file)
}

/// An operand with `#` that S:24 displaces; file instructions mark the start of a file with it.
fn is_displaced(step: &Step<'_>, index: usize) -> bool {
    let kind = step.form.and_then(|form| form.operands.get(index)).map(|operand| operand.kind);
    let marked = matches!(step.it.operands.get(index), Some(Operand::Address(address)) if address.indexed);
    marked && matches!(kind, Some(Kind::Word | Kind::Bit | Kind::Mask | Kind::String))
}

fn displaced(step: &Step<'_>) -> Option<usize> {
    (0..step.it.operands.len()).find(|index| is_displaced(step, *index))
}

/// The instruction writes S:24 because an operand says so.
fn sets_index(context: &Context<'_>, step: &Step<'_>) -> bool {
    let Some(form) = step.form else { return false };
    let is_index = |address: &Address| address.file_type == FileType::S && address.element == Place::Number(24);
    form.operands
        .iter()
        .enumerate()
        .any(|(index, operand)| operand.role.writes() && context.address(step, index).is_some_and(|it| is_index(&it)))
}

fn index_overwritten(context: &Context<'_>, found: &mut Found) {
    let mut file = None;
    let mut set: Option<Location> = None;
    let mut over: Option<&Step<'_>> = None;
    for step in &context.steps {
        if file != Some(step.at.file) {
            (file, set, over) = (Some(step.at.file), None, None);
        }
        if let (Some(index), Some(set), Some(over)) = (displaced(step), set, over)
            && let Some(address) = context.address(step, index)
        {
            let message = format!("{} in {} changes S:24 after {set} has set it for {address}", over.name, over.at);
            found.add(&[step.at, over.at, set], &address, message);
        }
        if sets_index(context, step) {
            (set, over) = (Some(step.at), None);
        } else if step.info.is_some_and(|info| info.status.contains(&"S:24")) {
            over = Some(step);
        }
    }
}

fn index_never_set(context: &Context<'_>, found: &mut Found) {
    let register = Address::element(FileType::S, 2, 24);
    let mut places = Vec::new();
    let mut first = None;
    for step in &context.steps {
        if let Some(address) = displaced(step).and_then(|index| context.address(step, index)) {
            places.push(step.at);
            first.get_or_insert(address);
        }
    }
    let Some(address) = first else { return };
    let Some(writes) = context.writes(&register) else { return };
    if writes.iter().all(|write| write.through == crate::xref::Through::Implied) {
        let value = context.status_word(24).map_or_else(String::new, |value| format!(" (it holds {})", value as i16));
        found.add(&places, address, format!("{} uses S:24, and nothing sets it{value}", rungs(&places)));
    }
}

fn shared_control(context: &Context<'_>, found: &mut Found) {
    let control = |step: &Step<'_>| {
        let operands = step.form?.operands;
        operands.iter().position(|operand| operand.kind == Kind::Control)
    };
    for (address, steps) in context.by_address(control) {
        let steps: Vec<_> = steps.into_iter().filter(|step| context.runs(step.at.file)).collect();
        if steps.len() < 2 || is_team(&steps) {
            continue;
        }
        let places: Vec<Location> = steps.iter().map(|step| step.at).collect();
        let names: Vec<&str> = steps.iter().take(6).map(|step| step.name).collect();
        let message =
            format!("{address} controls {} instructions ({}): rungs {}", steps.len(), names.join(", "), rungs(&places));
        found.add(&places, &address, message);
    }
}

/// Instructions made to share a control element, at most one of each.
fn is_team(steps: &[&Step<'_>]) -> bool {
    const TEAMS: &[&[&str]] = &[&["FFL", "FFU"], &["LFL", "LFU"], &["SQO", "SQC", "SQL"]];
    let names: HashSet<&str> = steps.iter().map(|step| step.name).collect();
    names.len() == steps.len() && TEAMS.iter().any(|team| names.iter().all(|name| team.contains(name)))
}

fn overlapping_copy(context: &Context<'_>, found: &mut Found) {
    for step in context.steps.iter().filter(|step| step.name == "COP") {
        let (Some(source), Some(dest), Some(length)) =
            (context.address(step, 0), context.address(step, 1), step.integer(2))
        else {
            continue;
        };
        let plain = source.is_plain() && dest.is_plain();
        let same = source.file_type == dest.file_type && source.file == dest.file && !source.file_type.has_slots();
        let (Some(a), Some(b)) = (source.element.number(), dest.element.number()) else { continue };
        if plain && same && i64::from(a.abs_diff(b)) < length {
            found.add(&[step.at], &source, format!("COP {source} {dest} {length} copies onto its own source"));
        }
    }
}

trait Plain {
    /// A whole element: no member and no bit.
    fn is_plain(&self) -> bool;
}

impl Plain for Address {
    fn is_plain(&self) -> bool {
        self.word.is_none() && self.bit.is_none()
    }
}

fn incomplete(context: &Context<'_>, found: &mut Found) {
    use crate::xref::UnresolvedKind as K;
    for it in context.xref.unresolved() {
        if matches!(it.kind, K::Symbol | K::NotEntered) {
            let message = format!("{}: {} {}", it.mnemonic, it.kind.as_str(), it.text);
            found.add(&[it.location], &it.text, message.trim_end());
        }
    }
}

fn unknown(context: &Context<'_>, found: &mut Found) {
    use crate::xref::UnresolvedKind as K;
    for it in context.xref.unresolved() {
        if matches!(it.kind, K::Instruction | K::OperandCount) {
            found.add(&[it.location], it.mnemonic, format!("{}: {}", it.mnemonic, it.kind.as_str()));
        }
    }
}

fn no_length(context: &Context<'_>, found: &mut Found) {
    for step in context.steps.iter().filter(|step| matches!(step.name, "COP" | "FLL")) {
        if step.integer(2) == Some(0) {
            found.add(&[step.at], "", format!("{} with length 0 does nothing", step.name));
        }
    }
}
