//! Every single mutant of a Do-more program: one contact, number, address or instruction changed.

use domore::{Instruction, Part, Project, Rung};

use super::scan::Change;

/// What was changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Kind {
    /// A contact examined the other way round.
    ContactInverted,
    /// A number one higher or lower: presets, limits, initial values, factors.
    NumberChanged,
    /// The element beside the one that was meant.
    AddressOffByOne,
    /// A parallel path made a series, or a series a parallel path.
    LegSwapped,
    /// An instruction left out.
    InstructionDropped,
    /// A comparison with another relation.
    CompareChanged,
    /// A RST left out.
    ResetRemoved,
    /// A rung left out.
    RungDropped,
}

/// A mutant: what was done and where.
#[derive(Clone, Debug)]
pub(crate) struct Mutant {
    pub(crate) kind: Kind,
    /// Code block and rung, counted from 0, and the instruction; none for a whole rung.
    pub(crate) place: (usize, usize, Option<usize>),
    /// Code block, rung and change, in words.
    pub(crate) what: String,
    pub(crate) project: Project,
}

impl Mutant {
    /// What stands in the place of which rung.
    pub(crate) fn change(&self) -> Change<'_> {
        let (block, rung, instruction) = self.place;
        let code = self.project.code_blocks().nth(block);
        let changed = code.and_then(|code| code.rungs.get(rung)).filter(|_| instruction.is_some());
        Change { place: (block, rung), rung: changed }
    }
}

/// All of them, in the order of the text.
pub(crate) fn all(project: &Project) -> Vec<Mutant> {
    let mut mutants = Vec::new();
    let mut blocks = 0;
    for (part, block) in project.parts.iter().enumerate() {
        let Part::Code(code) = block else { continue };
        let block = blocks;
        blocks += 1;
        for (number, rung) in code.rungs.iter().enumerate() {
            for (kind, index, what, mutated) in of_rung(rung) {
                let mut project = project.clone();
                if let Some(Part::Code(code)) = project.parts.get_mut(part) {
                    match mutated {
                        Some(rung) => code.rungs[number] = rung,
                        None => drop(code.rungs.remove(number)),
                    }
                }
                let what = format!("{} rung {}: {what}", code.name, number + 1);
                mutants.push(Mutant { kind, place: (block, number, index), what, project });
            }
        }
    }
    mutants
}

type Changed = (Kind, Option<usize>, String, Option<Rung>);

fn of_rung(rung: &Rung) -> Vec<Changed> {
    let mut changes = Vec::new();
    let acts = rung.instructions.iter().any(|it| !matches!(it.mnemonic.as_str(), "NOP" | "RET" | "END"));
    if acts {
        let text: Vec<String> = rung.instructions.iter().map(ToString::to_string).collect();
        changes.push((Kind::RungDropped, None, format!("dropped {}", text.join("; ")), None));
    }
    for (index, it) in rung.instructions.iter().enumerate() {
        let mut push = |kind, changed: Option<Instruction>| {
            let mut mutated = rung.clone();
            let what = match changed {
                Some(changed) => {
                    let what = format!("{it} -> {changed}");
                    mutated.instructions[index] = changed;
                    what
                }
                None => {
                    mutated.instructions.remove(index);
                    format!("{it} dropped")
                }
            };
            changes.push((kind, Some(index), what, Some(mutated)));
        };
        if let Some(name) = inverted(&it.mnemonic) {
            push(Kind::ContactInverted, Some(renamed(it, &name)));
        }
        if let Some(name) = other_relation(&it.mnemonic) {
            push(Kind::CompareChanged, Some(renamed(it, &name)));
        }
        match it.mnemonic.as_str() {
            "ORSTR" => push(Kind::LegSwapped, Some(renamed(it, "ANDSTR"))),
            "ANDSTR" => push(Kind::LegSwapped, Some(renamed(it, "ORSTR"))),
            "RST" | "RSTR" => push(Kind::ResetRemoved, None),
            // Nothing looks at the power behind a NOT that ends a rung or a part of it.
            "NOT" if rung.instructions.get(index + 1).is_none_or(|next| next.is("POPBOOL")) => {}
            "OUT" | "SET" | "MATH" | "MOVE" | "COPY" | "TMR" | "CALL" | "INIT" | "NOT" => {
                push(Kind::InstructionDropped, None);
            }
            _ => {}
        }
        // Numbers of a CALL say how its parameters are laid out; there are none.
        for (operand, text) in it.operands.iter().enumerate().filter(|_| !it.is("CALL")) {
            for (kind, other) in numbers(text) {
                let mut changed = it.clone();
                changed.operands[operand] = other;
                push(kind, Some(changed));
            }
        }
    }
    changes
}

fn renamed(it: &Instruction, name: &str) -> Instruction {
    Instruction { mnemonic: name.to_owned(), ..it.clone() }
}

fn inverted(name: &str) -> Option<String> {
    match name {
        "STR" | "AND" | "OR" => Some(format!("{name}N")),
        "STRN" | "ANDN" | "ORN" => Some(name.trim_end_matches('N').to_owned()),
        _ => None,
    }
}

/// The same values compared with the relation beside it, and with the opposite one where there is none.
fn other_relation(name: &str) -> Option<String> {
    const RELATIONS: [(&str, &str); 6] =
        [("LE", "LT"), ("GE", "GT"), ("NE", "E"), ("E", "NE"), ("LT", "LE"), ("GT", "GE")];
    let entry = domore::instruction::by_mnemonic(name)?;
    let domore::instruction::Effect::Contact { test: domore::instruction::Test::Compare(_), .. } = entry.effect else {
        return None;
    };
    let head = ["STR", "AND", "OR"].into_iter().find(|head| name.starts_with(head))?;
    let (_, other) = RELATIONS.iter().find(|row| name.strip_prefix(head) == Some(row.0))?;
    Some(format!("{head}{other}"))
}

/// The text with one of its numbers one higher, or lower where it is a constant; numbers of elements count
/// as addresses.
fn numbers(text: &str) -> Vec<(Kind, String)> {
    let bytes = text.as_bytes();
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        if !bytes[at].is_ascii_digit() {
            at += 1;
            continue;
        }
        let end = at + bytes[at..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        let before = at.checked_sub(1).map(|before| bytes[before]);
        let constant = !before.is_some_and(|byte| byte.is_ascii_alphabetic() || matches!(byte, b':' | b'.' | b'_'));
        let real = bytes.get(end) == Some(&b'.') && bytes.get(end + 1).is_some_and(u8::is_ascii_digit);
        if let Ok(number) = text[at..end].parse::<i64>() {
            let with = |number: i64| format!("{}{number}{}", &text[..at], &text[end..]);
            let kind = if constant { Kind::NumberChanged } else { Kind::AddressOffByOne };
            found.push((kind, with(number + 1)));
            if constant && number > 0 && !real {
                found.push((kind, with(number - 1)));
            }
        }
        at = end;
    }
    found
}
