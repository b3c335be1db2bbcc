//! `PROGRAM FILES` to rungs: marks become structure, texts become typed operands.

use instr::{Form, Kind, Stored};
use ladder::{Branch, Element, Expression, Instruction, Mnemonic, Operand, ProgramFile, ProgramFileKind, Rung, Series};
use rss::Text;
use rss::program::{self, Item, LadFile, ProgramFiles};

use super::Notes;
use super::documentation::Comments;
use crate::code;
use crate::limits;

pub(crate) fn program_files(
    stored: &ProgramFiles<'_>,
    comments: &mut Comments,
    notes: &mut Notes<'_>,
) -> Vec<ProgramFile> {
    stored.files.iter().map(|file| program_file(file, comments, notes)).collect()
}

fn program_file(stored: &LadFile<'_>, comments: &mut Comments, notes: &mut Notes<'_>) -> ProgramFile {
    let number = stored.number;
    let mut rungs: Vec<Rung> = Vec::with_capacity(stored.rungs.len());
    for (index, rung) in stored.rungs.iter().enumerate() {
        notes.within(format!("file {number} > rung {index}"));
        notes.parts.admit(1);
        let series = series(&rung.leg.items, notes);
        if notes.parts.exceeded() {
            // Half a rung would look like a whole one.
            notes.error(limits::left_out(stored.rungs.len() - index));
            break;
        }
        let comment = match rung.comment_id {
            0 => None,
            id => {
                let comment = comments.shown(id);
                if comment.is_none() {
                    let missing = format!("expected rung comment {id} in the documentation database, found none");
                    // The online image refers to comments as they were at its upload or download.
                    if notes.borrowed_comments { notes.note(missing) } else { notes.warning(missing) }
                }
                comment
            }
        };
        rungs.push(Rung { series, edited: rung.edited != 0, comment });
    }
    ProgramFile {
        number,
        name: stored.name().trim_end().to_owned(),
        description: stored.description.decode().into_owned(),
        kind: kind(stored, number),
        rungs,
    }
}

/// Files 0 and 1 belong to the processor. A file with rungs is ladder whatever its flags say.
fn kind(stored: &LadFile<'_>, number: u16) -> ProgramFileKind {
    if !stored.rungs.is_empty() {
        ProgramFileKind::Ladder
    } else if number < 2 {
        ProgramFileKind::System
    } else if stored.flags & LadFile::NO_PROGRAM != 0 {
        ProgramFileKind::Unused
    } else {
        ProgramFileKind::Ladder
    }
}

/// The elements between the marks of a leg.
fn series(items: &[Item<'_>], notes: &mut Notes<'_>) -> Series {
    let mut elements = Vec::with_capacity(items.len().saturating_sub(2));
    for item in items {
        if notes.parts.exceeded() {
            break;
        }
        match item {
            Item::Instruction(stored) if stored.is_mark() => {}
            Item::Instruction(stored) => {
                let mut read = instruction(stored, notes);
                notes.parts.admit(1 + read.operands.len());
                resolve_symbols(&mut read, stored, notes);
                elements.push(Element::Instruction(read));
            }
            Item::Branch(branch) => elements.push(Element::Branch(legs(&branch.items, notes))),
            Item::Leg(leg) => {
                notes.warning("expected an instruction or a branch in a leg, found another leg".to_owned());
                elements.extend(series(&leg.items, notes));
            }
            Item::Null | Item::Reference(_) => {
                notes.warning(
                    "expected an instruction or a branch in a leg, found an empty or shared object".to_owned(),
                );
            }
        }
    }
    elements
}

fn legs(items: &[Item<'_>], notes: &mut Notes<'_>) -> Branch {
    let mut branch = Branch::default();
    notes.parts.admit(1);
    for item in items {
        notes.parts.admit(1);
        if notes.parts.exceeded() {
            break;
        }
        match item {
            Item::Leg(leg) => branch.legs.push(series(&leg.items, notes)),
            Item::Instruction(stored) if stored.is_mark() => {}
            other => {
                notes.warning(
                    "expected a leg in a branch, found something else; it is shown as a leg of its own".to_owned(),
                );
                branch.legs.push(series(std::slice::from_ref(other), notes));
            }
        }
    }
    branch
}

pub(crate) fn instruction(stored: &program::Instruction<'_>, notes: &mut Notes<'_>) -> Instruction {
    let known = instr::by_opcode(stored.opcode);
    let mnemonic = match known {
        Some((instruction, _)) => Mnemonic::named(instruction.mnemonic),
        None => {
            notes.warning(format!(
                "operation code {:#04x} belongs to no known instruction; it is shown by its number",
                stored.opcode
            ));
            Mnemonic::Unknown(stored.opcode)
        }
    };
    let texts = &stored.operands;
    let (operands, displayed) = match known {
        Some((_, form)) if form.string_count() == texts.len() => typed(form, texts),
        _ => {
            if let Some((instruction, form)) = known {
                notes.warning(format!(
                    "expected {} texts for {}, found {}; all are shown as operands",
                    form.string_count(),
                    instruction.mnemonic,
                    texts.len()
                ));
            }
            (texts.iter().map(|text| Operand::parse(&text.decode())).collect(), Vec::new())
        }
    };
    if let Some((instruction, form)) = known
        && let Some((text, code)) = code::other_time_base(form, &operands)
    {
        let timer = operands.first().map(ToString::to_string).unwrap_or_default();
        notes.warning(format!(
            "expected one time base for {} {timer}, found {text} in its text and the operation code of {code}",
            instruction.mnemonic
        ));
    }
    Instruction {
        mnemonic,
        operands,
        displayed,
        compiled: stored.has_code != 0,
        message: stored.message.as_ref().map(|setup| Box::new(crate::message::settings(setup))),
    }
}

/// A verified instruction that stores a symbol as text: the code is what the processor runs, and
/// RSLogix prints all its operands from the code.
fn resolve_symbols(read: &mut Instruction, stored: &program::Instruction<'_>, notes: &mut Notes<'_>) {
    let symbolic = read.operands.iter().any(|operand| matches!(operand, Operand::Symbol(_)));
    let form = instr::by_opcode(stored.opcode).map(|(_, form)| form);
    let (true, Some(form)) = (symbolic && stored.has_code != 0, form) else { return };
    let Ok(rss::code::Code::Operands { operands: coded, .. }) = rss::code::Code::decode(&stored.code) else { return };
    if coded.len() != form.code_order.len() {
        return;
    }
    for (index, coded) in form.code_order.iter().zip(&coded) {
        let Some(operand) = read.operands.get_mut(*index) else { continue };
        if let (Operand::Symbol(_) | Operand::Constant(_), Some(resolved)) = (&*operand, code::operand_of(coded)) {
            if let Operand::Symbol(symbol) = operand {
                notes.note(format!("{symbol} stands for {resolved} in the compiled code"));
            }
            *operand = resolved;
        }
    }
}

/// Source texts become operands, value texts stay beside them as what was last displayed.
fn typed(form: &Form, texts: &[Text<'_>]) -> (Vec<Operand>, Vec<Option<String>>) {
    let mut operands = Vec::with_capacity(form.operands.len());
    let mut displayed = Vec::new();
    let mut rest = texts.iter();
    for (index, definition) in form.operands.iter().enumerate() {
        let text = rest.next().map(Text::decode).unwrap_or_default();
        operands.push(match definition.stored {
            // `Setup Screen`, `?` or nothing: a placeholder, never program content.
            Stored::Blank => Operand::Empty,
            _ => operand(definition.kind, &text),
        });
        if definition.stored == Stored::SourceAndValue
            && let Some(value) = rest.next()
        {
            displayed.resize(index, None);
            displayed.push(Some(value.decode().into_owned()));
        }
    }
    if !displayed.is_empty() {
        displayed.resize(form.operands.len(), None);
    }
    (operands, displayed)
}

/// An expression of one operand looks like that operand; only the table tells them apart.
fn operand(kind: Kind, text: &str) -> Operand {
    if kind == Kind::Expression
        && let Ok(expression) = Expression::parse(text)
    {
        return Operand::Expression(expression);
    }
    Operand::parse(text)
}
