//! Every single mutant of a Do-more program: one contact, number, address or instruction changed.

use domore::{Instruction, Part, Project, Rung};

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
    /// The rung was made from one of the original, and does not belong to the frame around them.
    pub(crate) converted: bool,
    /// Code block, rung and change, in words.
    pub(crate) what: String,
    pub(crate) project: Project,
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
                let mut lines = rung.comment.iter().flat_map(|comment| &comment.lines);
                let converted = lines.any(|line| line.starts_with("SLC "));
                mutants.push(Mutant { kind, place: (block, number, index), converted, what, project });
            }
        }
    }
    mutants
}

/// Mutants that do what the program does, by argument: a bit is reset that nothing ever sets, or a constant is
/// stored where the initial value is the same and nothing else writes.
pub(crate) fn is_equivalent(mutant: &Mutant, project: &Project) -> bool {
    let (block, rung, Some(index)) = mutant.place else { return false };
    let Some(code) = project.code_blocks().nth(block) else { return false };
    let Some(it) = code.rungs.get(rung).and_then(|rung| rung.instructions.get(index)) else { return false };
    let all = || project.code_blocks().flat_map(|code| &code.rungs).flat_map(|rung| &rung.instructions);
    let never_set = |bit: &str| {
        let word = bit.split(':').next().unwrap_or(bit);
        !all().any(|it| match it.mnemonic.as_str() {
            "SET" | "OUT" => it.operand(0) == bit,
            "MATH" => it.operand(0) == word,
            "MOVE" => it.operand(1) == word,
            _ => false,
        })
    };
    match (it.mnemonic.as_str(), mutant.kind) {
        ("RST", Kind::ResetRemoved) => never_set(it.operand(0)),
        ("RST", Kind::AddressOffByOne) => {
            let other = mutant.project.code_blocks().nth(block).and_then(|code| code.rungs.get(rung));
            let other = other.and_then(|rung| rung.instructions.get(index));
            never_set(it.operand(0)) && other.is_some_and(|other| never_set(other.operand(0)))
        }
        ("MOVE", Kind::InstructionDropped) => {
            let (value, to) = (it.operand(0), it.operand(1));
            let row = format!("{to} {to} {value}");
            let writers = all().filter(|it| match it.mnemonic.as_str() {
                "MATH" => it.operand(0) == to,
                "MOVE" => it.operand(1) == to,
                _ => false,
            });
            value.parse::<i64>().is_ok()
                && writers.count() == 1
                && all().any(|it| it.is("INIT") && it.operand(0).contains(&row))
        }
        _ => false,
    }
}

type Change = (Kind, Option<usize>, String, Option<Rung>);

fn of_rung(rung: &Rung) -> Vec<Change> {
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
            "RST" => push(Kind::ResetRemoved, None),
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

fn other_relation(name: &str) -> Option<String> {
    const RELATIONS: [(&str, &str); 6] =
        [("<=", "<"), (">=", ">"), ("!=", "=="), ("==", "!="), ("<", "<="), (">", ">=")];
    let head = ["STR", "AND", "OR"].into_iter().find(|head| name.starts_with(head))?;
    let relation = name.strip_prefix(head)?;
    let (_, other) = RELATIONS.iter().find(|row| row.0 == relation)?;
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
