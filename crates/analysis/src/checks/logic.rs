//! Conditions of a rung that can only be one way, or say something twice.

use std::collections::{HashMap, HashSet};

use ladder::{Address, Element, FileType, Instruction, Number, Operand, Rung};

use super::context::{Context, form, is_condition};
use super::{Check, Found, Severity};
use crate::location::Location;

pub(super) const CHECKS: &[Check] = &[
    Check {
        code: "LOG01",
        title: "XIC and XIO of one bit in series",
        severity: Severity::Warning,
        default_on: true,
        explanation: "Both contacts examine one bit, one for 1 and one for 0, and nothing between them writes it: power never \
            passes both. Sometimes done to switch a rung off, which a comment should then say.",
        find: dead_contacts,
    },
    Check {
        code: "LOG02",
        title: "conditions bypassed by an empty branch",
        severity: Severity::Warning,
        default_on: true,
        explanation: "One leg of the branch is empty, so power passes whatever the contacts of the other legs say: they have no \
            effect. Often what is left after a contact was taken out.",
        find: bypassed,
    },
    Check {
        code: "LOG03",
        title: "coil that is always driven",
        severity: Severity::Note,
        default_on: true,
        explanation: "No condition stands before the coil: an OTE makes its bit 1 in every scan, an OTL or OTU sets or clears it \
            in every scan. Meant for always-on bits; elsewhere a condition has been lost. Settings that programs write in every \
            scan on purpose (status file, function files, PID and message blocks) are left out.",
        find: always_driven,
    },
    Check {
        code: "LOG04",
        title: "contact repeated in series",
        severity: Severity::Note,
        default_on: true,
        explanation: "The same contact of the same bit stands twice in one series with nothing in between that could change the \
            bit. The second one has no effect; perhaps another address was meant.",
        find: repeated,
    },
    Check {
        code: "LOG05",
        title: "XIC or XIO parallel to its opposite",
        severity: Severity::Warning,
        default_on: true,
        explanation: "Two legs of a branch hold nothing but an XIC and an XIO of one bit: one of them always passes, and the \
            branch is always true.",
        find: always_true,
    },
    Check {
        code: "LOG06",
        title: "value compared with itself",
        severity: Severity::Warning,
        default_on: true,
        explanation: "Both sides of the comparison are the same address, or both are constants: the result never changes.",
        find: compared_with_itself,
    },
    Check {
        code: "LOG07",
        title: "limit test with its low limit above its high limit",
        severity: Severity::Note,
        default_on: true,
        explanation: "When the low limit of LIM is above the high limit, the instruction is true outside of both instead of \
            between them. That is a feature of the instruction and surprises whoever did not mean it.",
        find: inverted_limits,
    },
    Check {
        code: "LOG08",
        title: "contact of a bit that nothing writes",
        severity: Severity::Note,
        default_on: false,
        explanation: "A bit is examined and no instruction of the program writes it. An operator terminal or another controller may: \
            such bits are how they talk to a program. Otherwise the contact never changes.",
        find: never_written,
    },
    Check {
        code: "LOG09",
        title: "two equal legs in a branch",
        severity: Severity::Note,
        default_on: true,
        explanation: "Two legs of one branch hold the same conditions: the second has no effect. Perhaps another address was \
            meant.",
        find: equal_legs,
    },
];

/// Deepest nesting that is followed.
const MAX_DEPTH: usize = 64;

/// A contact met before another one of its bit.
enum Pair {
    Same,
    Opposite,
}

/// The contacts that must all be true for power to be where the walk is.
struct Series<'x, 'a> {
    context: &'x Context<'a>,
    at: Location,
    /// State asked of a bit, and the age it was asked in.
    known: HashMap<Address, (bool, u32)>,
    /// Grows with every instruction that may write data.
    age: u32,
    hit: &'x mut dyn FnMut(Location, &Address, Pair),
}

impl Series<'_, '_> {
    fn walk(&mut self, series: &[Element], depth: usize) {
        let mut own: Vec<(Address, Option<(bool, u32)>)> = Vec::new();
        for element in series {
            match element {
                Element::Instruction(it) => {
                    if let Some((address, closed)) = contact(self.context, it) {
                        self.meet(address, closed, &mut own);
                    } else if !is_pure(self.context, it) {
                        self.age += 1;
                    }
                    self.at.instruction = self.at.instruction.saturating_add(1);
                }
                Element::Branch(branch) => {
                    if depth >= MAX_DEPTH {
                        // Numbers of later instructions would be wrong.
                        self.age += 1;
                        continue;
                    }
                    for leg in &branch.legs {
                        self.walk(leg, depth + 1);
                    }
                }
            }
        }
        for (address, before) in own.into_iter().rev() {
            match before {
                Some(before) => drop(self.known.insert(address, before)),
                None => drop(self.known.remove(&address)),
            }
        }
    }

    fn meet(&mut self, address: Address, closed: bool, own: &mut Vec<(Address, Option<(bool, u32)>)>) {
        // The controller changes status bits in the middle of a scan.
        if address.file_type == FileType::S || address.file_type.is_function_file() {
            return;
        }
        let before = self.known.get(&address).copied();
        if let Some((state, age)) = before
            && age == self.age
        {
            let pair = if state == closed { Pair::Same } else { Pair::Opposite };
            (self.hit)(self.at, &address, pair);
            return;
        }
        self.known.insert(address.clone(), (closed, self.age));
        own.push((address, before));
    }
}

/// The bit of a contact, and whether it is an XIC.
fn contact(context: &Context<'_>, it: &Instruction) -> Option<(Address, bool)> {
    let closed = match it.mnemonic.name()? {
        "XIC" => true,
        "XIO" => false,
        _ => return None,
    };
    Some((context.xref.resolve(it.operands.first()?)?, closed))
}

/// A condition that writes no data.
fn is_pure(context: &Context<'_>, it: &Instruction) -> bool {
    let Some(info) = it.mnemonic.name().and_then(instr::by_mnemonic) else { return false };
    let found = form(info, context.image, it);
    is_condition(found) && found.is_some_and(|form| form.operands.iter().all(|operand| !operand.role.writes()))
}

fn contacts(context: &Context<'_>, mut hit: impl FnMut(Location, &Address, Pair)) {
    each_rung(context, |at, rung| {
        let mut series = Series { context, at, known: HashMap::new(), age: 0, hit: &mut hit };
        series.walk(&rung.series, 0);
    });
}

fn each_rung(context: &Context<'_>, mut each: impl FnMut(Location, &Rung)) {
    for file in context.image.ladder_files() {
        for (rung, content) in (0..).zip(&file.rungs) {
            each(Location { file: file.number, rung, instruction: 0 }, content);
        }
    }
}

/// Every branch of the program with its rung.
fn each_branch(context: &Context<'_>, mut each: impl FnMut(Location, &[Vec<Element>])) {
    each_rung(context, |at, rung| {
        let mut open: Vec<&[Element]> = vec![&rung.series];
        while let Some(series) = open.pop() {
            for element in series {
                if let Element::Branch(branch) = element {
                    each(at, &branch.legs);
                    open.extend(branch.legs.iter().map(Vec::as_slice));
                }
            }
        }
    });
}

/// The instructions of a leg when all are conditions that write nothing and no branch is among them.
fn conditions<'e>(context: &Context<'_>, leg: &'e [Element]) -> Option<Vec<&'e Instruction>> {
    leg.iter()
        .map(|element| match element {
            Element::Instruction(it) if is_pure(context, it) => Some(it),
            _ => None,
        })
        .collect()
}

fn dead_contacts(context: &Context<'_>, found: &mut Found) {
    contacts(context, |at, address, pair| {
        if matches!(pair, Pair::Opposite) {
            found.add(&[at], address, format!("XIC and XIO of {address} in series: power never passes both"));
        }
    });
}

fn repeated(context: &Context<'_>, found: &mut Found) {
    contacts(context, |at, address, pair| {
        if matches!(pair, Pair::Same) {
            found.add(&[at], address, format!("the contact of {address} stands twice in one series"));
        }
    });
}

fn bypassed(context: &Context<'_>, found: &mut Found) {
    each_branch(context, |at, legs| {
        let empty = legs.iter().any(Vec::is_empty);
        let rest: Vec<_> = legs.iter().filter(|leg| !leg.is_empty()).collect();
        if empty && !rest.is_empty() && rest.iter().all(|leg| conditions(context, leg).is_some()) {
            found.add(&[at], "", "an empty leg bypasses every condition of its branch");
        }
    });
}

fn always_true(context: &Context<'_>, found: &mut Found) {
    each_branch(context, |at, legs| {
        let mut met: HashSet<(Address, bool)> = HashSet::new();
        for leg in legs {
            let [Element::Instruction(only)] = leg.as_slice() else { continue };
            let Some((address, closed)) = contact(context, only) else { continue };
            if met.contains(&(address.clone(), !closed)) {
                found.add(&[at], &address, format!("XIC and XIO of {address} in parallel: the branch is always true"));
            }
            met.insert((address, closed));
        }
    });
}

fn equal_legs(context: &Context<'_>, found: &mut Found) {
    each_branch(context, |at, legs| {
        let mut met: HashSet<String> = HashSet::new();
        for leg in legs.iter().filter(|leg| !leg.is_empty()) {
            let Some(all) = conditions(context, leg) else { continue };
            let mut text = String::new();
            for it in all {
                text.push_str(&it.mnemonic.to_string());
                it.operands.iter().for_each(|operand| text.push_str(&format!(" {operand}")));
                text.push(';');
            }
            if !met.insert(text.clone()) {
                found.add(&[at], "", format!("two legs hold the same: {}", text.trim_end_matches(';')));
            }
        }
    });
}

/// One finding per rung: programs often set many bits in one.
fn always_driven(context: &Context<'_>, found: &mut Found) {
    let coils = context.steps.iter().filter(|step| matches!(step.name, "OTE" | "OTL" | "OTU") && !step.gated);
    // Status bits, function files and loops have settings that programs write in every scan on purpose, S:5/0 first
    // of all.
    let is_setting = |address: &Address| {
        address.file_type.is_function_file() || matches!(address.file_type, FileType::S | FileType::PD | FileType::MG)
    };
    let driven = coils.filter_map(|step| Some((step, context.address(step, 0).filter(|it| !is_setting(it))?)));
    let driven: Vec<_> = driven.collect();
    for rung in driven.chunk_by(|a, b| (a.0.at.file, a.0.at.rung) == (b.0.at.file, b.0.at.rung)) {
        let Some((step, address)) = rung.first() else { continue };
        let text = match rung.len() - 1 {
            0 => format!("{} {address} has no condition before it", step.name),
            more => format!("{} {address} and {more} more of this rung have no condition before them", step.name),
        };
        found.add(&[step.at], address, text);
    }
}

fn compared_with_itself(context: &Context<'_>, found: &mut Found) {
    for step in context.steps.iter().filter(|step| matches!(step.name, "EQU" | "NEQ" | "LES" | "LEQ" | "GRT" | "GEQ")) {
        let [a, b] = step.it.operands.as_slice() else { continue };
        let constant = matches!((a, b), (Operand::Constant(_), Operand::Constant(_)));
        let same = matches!(a, Operand::Address(_)) && a == b;
        if constant || same {
            found.add(&[step.at], a, format!("{} {a} {b} never changes", step.name));
        }
    }
}

fn inverted_limits(context: &Context<'_>, found: &mut Found) {
    for step in context.steps.iter().filter(|step| step.name == "LIM") {
        let [Operand::Constant(low), test, Operand::Constant(high)] = step.it.operands.as_slice() else { continue };
        let number = |it: &ladder::Constant| match it.number() {
            Number::Integer(number) => number as f64,
            Number::Float(number) => number.into(),
        };
        if number(low) > number(high) {
            found.add(&[step.at], test, format!("LIM {low} {test} {high} is true outside of the two limits"));
        }
    }
}

fn never_written(context: &Context<'_>, found: &mut Found) {
    for (address, steps) in context.by_address(|step| matches!(step.name, "XIC" | "XIO").then_some(0)) {
        if !matches!(address.file_type, FileType::B | FileType::N | FileType::O | FileType::L) {
            continue;
        }
        let Some(writes) = context.writes(&address) else { return };
        if writes.is_empty() {
            let all: Vec<Location> = steps.iter().map(|step| step.at).collect();
            found.add(&all, &address, format!("nothing in the program writes {address}"));
        }
    }
}
