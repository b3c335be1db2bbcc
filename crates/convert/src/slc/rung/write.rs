//! Writes rungs as text.

use std::borrow::Cow;

use instr::Form;
use ladder::{Element, Family, Instruction, Mnemonic, Operand, Rung, Series};

use super::operand;

/// Mnemonic of the stand-in for a rung whose text could not be read: its one operand is the text.
/// No processor has such an instruction; every output shows it by this name.
pub const UNREAD: &str = "UNREAD";

/// The rung as RSLogix 500's own text, on one line, without `SOR` and `EOR` unless it is empty.
///
/// What that notation cannot say is written so that [`super::parse_rung`] gives the same rung back:
///
/// | in the rung | in the text |
/// |---|---|
/// | operand with blanks, or that would read as something else | `"in double quotes"`, a quote inside doubled, `\` and control characters as `\\` and `\u{D}` |
/// | instruction without a known name; operands that fit no form of the instruction | `op0x4D( N7:0 5 )`: all operands in parentheses, empty ones as `""` |
/// | rung without instructions | `SOR EOR` |
/// | rung that could not be read ([`UNREAD`]) | its original text |
///
/// Placeholders of the box such as *Setup Screen* are left out; reading puts them back.
pub fn rung_text(rung: &Rung) -> String {
    rung_text_for(rung, None)
}

/// As [`rung_text`], for a text that will be read with this family: an instruction in another
/// family's form is written in parentheses.
pub fn rung_text_for(rung: &Rung, family: Option<Family>) -> String {
    if let Some(text) = unread_text(rung) {
        return text.to_owned();
    }
    if rung.series.is_empty() {
        return "SOR EOR".to_owned();
    }
    let mut out = String::new();
    let mut work = vec![Work::Elements(&rung.series)];
    // A stack of its own, not recursion: rungs of damaged projects can nest deeper than ours.
    while let Some(step) = work.pop() {
        match step {
            Work::Word(word) => push_word(&mut out, word),
            Work::Elements(elements) => {
                let Some((first, rest)) = elements.split_first() else { continue };
                work.push(Work::Elements(rest));
                match first {
                    Element::Instruction(instruction) => push_word(&mut out, &instruction_text(instruction, family)),
                    Element::Branch(branch) => {
                        push_word(&mut out, "BST");
                        work.push(Work::Word("BND"));
                        work.push(Work::Legs(&branch.legs, true));
                    }
                }
            }
            Work::Legs(legs, first) => {
                let Some((leg, rest)) = legs.split_first() else { continue };
                if !first {
                    push_word(&mut out, "NXB");
                }
                work.push(Work::Legs(rest, false));
                work.push(Work::Elements(leg));
            }
        }
    }
    out
}

enum Work<'a> {
    Word(&'static str),
    Elements(&'a [Element]),
    Legs(&'a [Series], bool),
}

fn push_word(out: &mut String, word: &str) {
    if !out.is_empty() {
        out.push(' ');
    }
    out.push_str(word);
}

/// The original text of a rung that could not be read.
pub fn unread_text(rung: &Rung) -> Option<&str> {
    match rung.series.as_slice() {
        [Element::Instruction(Instruction { mnemonic, operands, .. })] if *mnemonic == UNREAD => {
            match operands.as_slice() {
                [Operand::Text(text)] => Some(text),
                _ => None,
            }
        }
        _ => None,
    }
}

/// A rung that stands for a text which could not be read.
pub fn unread_rung(text: &str) -> Rung {
    let operands = vec![Operand::Text(text.to_owned())];
    Rung::new(vec![Element::Instruction(Instruction::new(Mnemonic::named(UNREAD), operands))])
}

/// One instruction as [`rung_text`] writes it.
pub fn instruction_text(instruction: &Instruction, family: Option<Family>) -> String {
    let mut out = instruction.mnemonic.to_string();
    match plain_form(instruction, family) {
        Some(form) => {
            for (operand, spec) in instruction.operands.iter().zip(form.operands) {
                if spec.in_text() {
                    push_word(&mut out, &operand::write(operand, Some(spec.kind)));
                }
            }
        }
        None => {
            out.push('(');
            for operand in &instruction.operands {
                push_word(&mut out, &operand::write(operand, None));
            }
            out.push_str(" )");
        }
    }
    out
}

/// The form whose operands a reader would restore from the plain text, if they are these.
fn plain_form(instruction: &Instruction, family: Option<Family>) -> Option<&'static Form> {
    let entry = instr::by_mnemonic(instruction.mnemonic.name()?)?;
    let mut forms: Vec<&'static Form> = match family {
        Some(family) => entry.forms_for(family).collect(),
        None => Vec::new(),
    };
    if forms.is_empty() {
        forms = entry.forms.iter().collect();
    }
    let fits = |form: &Form| {
        form.operands.len() == instruction.operands.len()
            && form.operands.iter().zip(&instruction.operands).all(|(spec, o)| spec.in_text() || *o == Operand::Empty)
    };
    let count = |form: &Form| form.operands.iter().filter(|spec| spec.in_text()).count();
    let form = forms.iter().copied().find(|form| fits(form))?;
    // Readers take the first form with as many operands.
    let first = forms.iter().copied().find(|other| count(other) == count(form))?;
    fits(first).then_some(first)
}

/// What the text of a rung leaves out, in words; empty when reading it back gives the same rung.
///
/// Values last displayed and the marks of unverified edits are snapshots and are not mentioned.
pub fn not_in_text(rung: &Rung) -> Vec<Cow<'static, str>> {
    let set_up = rung.instructions().filter(|instruction| instruction.message.is_some());
    set_up
        .map(|instruction| match instruction.operands.first() {
            Some(first) => format!("the settings behind the setup screen of {} {first}", instruction.mnemonic).into(),
            None => format!("the settings behind the setup screen of {}", instruction.mnemonic).into(),
        })
        .collect()
}
