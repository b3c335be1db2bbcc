//! Rungs of RSLogix 500: what counts as program in them and what is only displayed.

use std::fmt::Write;

use instr::{Form, Kind, Stored};
use ladder::{Element, FileType, Image, Instruction, Number, Operand, Rung, Series};

use super::language::{Block, BlockId, Half, Language, Marks, Piece};
use super::renames::{Mapping, Replaced};
use super::{Rename, Word};

/// RSLogix 500: SLC 500 and MicroLogix.
pub(super) struct Rslogix;

impl Language for Rslogix {
    type Program = Image;
    type Rung = Rung;
    type Instruction<'a> = &'a Instruction;
    type Mapping = Mapping;
    type Replaced = Replaced;

    fn blocks(program: &Image) -> Vec<Block<'_, Rung>> {
        program
            .ladder_files()
            .map(|file| Block {
                id: BlockId::Number(file.number),
                number: file.number,
                name: &file.name,
                rungs: &file.rungs,
            })
            .collect()
    }

    fn is_end(rung: &Rung) -> bool {
        rung.is_end()
    }

    fn pieces(rung: &Rung) -> Vec<Piece<&Instruction>> {
        pieces(rung)
    }

    fn words(_: &Image, it: &Instruction, mapping: &Mapping, text: &mut String, word: &mut dyn FnMut(&str)) {
        // Writing to a string cannot fail.
        let _ = write!(text, "{}", it.mnemonic);
        word(text);
        text.clear();
        let form = form_of(it);
        for (index, operand) in it.operands.iter().enumerate() {
            // Values are compared by `parameters`, set-ups of messages by `settings`: whether they count depends on
            // both sides.
            if !matches!(stored(form, index), Stored::Value | Stored::Blank) {
                spell(operand, kind(form, index), mapping, text);
            }
            word(text);
            text.clear();
        }
    }

    fn mnemonic(instruction: &Instruction) -> String {
        instruction.mnemonic.to_string()
    }

    fn same_mnemonic(a: &Instruction, b: &Instruction) -> bool {
        a.mnemonic == b.mnemonic
    }

    fn operands(instruction: &Instruction) -> Vec<String> {
        instruction.operands.iter().map(ToString::to_string).collect()
    }

    fn alike(a: &Instruction, b: &Instruction) -> (usize, usize) {
        let same = a.operands.iter().zip(&b.operands).filter(|(a, b)| a == b).count();
        (same, a.operands.len().max(b.operands.len()))
    }

    fn differing(
        (old, x): (Half<'_, Self>, &Instruction),
        (new, y): (Half<'_, Self>, &Instruction),
        mapping: &Mapping,
    ) -> Vec<usize> {
        let values = (parameters(old.program, x), parameters(new.program, y));
        let empty = Operand::Empty;
        let differs = |index: &usize| {
            let (p, q) = (x.operands.get(*index).unwrap_or(&empty), y.operands.get(*index).unwrap_or(&empty));
            !same_operand((x, p), (y, q), *index, &values, mapping)
        };
        (0..x.operands.len().max(y.operands.len())).filter(differs).collect()
    }

    fn note(old: &Instruction, new: &Instruction, index: usize, _: (&Image, &Image), replaced: &mut Replaced) {
        if let (Some(old), Some(new)) = (old.operands.get(index), new.operands.get(index)) {
            replaced.add(old, new);
        }
    }

    fn settings(old: &Instruction, new: &Instruction) -> Vec<(String, String)> {
        settings(old, new)
    }

    /// Set-ups of messages, or values that are program on at least one side.
    fn values_differ(old: Half<'_, Self>, new: Half<'_, Self>) -> bool {
        let mut setups = old.rung.instructions().zip(new.rung.instructions());
        if setups.any(|(a, b)| !settings(a, b).is_empty()) {
            return true;
        }
        let open = |rung: &Rung| rung.instructions().any(|instruction| !instruction.compiled);
        if !open(old.rung) && !open(new.rung) {
            return false;
        }
        old.rung.instructions().zip(new.rung.instructions()).any(|(a, b)| {
            let (a, b) = (parameters(old.program, a), parameters(new.program, b));
            !a.iter().zip(&b).all(|(a, b)| a.same(b))
        })
    }

    /// Rung text holds no set-ups of messages.
    fn one_sided_setups(old: Half<'_, Self>, new: Half<'_, Self>) -> usize {
        let pairs = old.rung.instructions().zip(new.rung.instructions());
        pairs.filter(|(a, b)| a.message.is_some() != b.message.is_some()).count()
    }

    fn text(_: &Rung, pieces: &[Piece<&Instruction>], marks: &[Marks]) -> Vec<Word> {
        let mut words = Vec::new();
        for (piece, marks) in pieces.iter().zip(marks) {
            match piece.instruction() {
                None => words.push(Word { text: piece.mark().unwrap_or("").to_owned(), marked: marks.whole }),
                Some((_, instruction)) => {
                    words.push(Word { text: instruction.mnemonic.to_string(), marked: marks.whole || marks.name });
                    for (index, operand) in instruction.operands.iter().enumerate() {
                        let marked = marks.whole || marks.operands.contains(&index);
                        if *operand != Operand::Empty {
                            words.push(Word { text: operand.to_string(), marked });
                        }
                    }
                }
            }
        }
        words
    }

    fn renumbered(pairs: &[(BlockId<'_>, BlockId<'_>)]) -> Mapping {
        let numbers = pairs.iter().filter_map(|pair| match pair {
            (BlockId::Number(a), BlockId::Number(b)) if a != b => Some((*a, *b)),
            _ => None,
        });
        Mapping::of_files(numbers)
    }

    fn is_identity(mapping: &Mapping) -> bool {
        mapping.is_empty()
    }

    fn renames(replaced: &Replaced, old: &Image, new: &Image, mapping: &mut Mapping) -> Vec<Rename> {
        replaced.find(old, new, mapping)
    }
}

/// What another setting of a message is called, and its values.
fn settings(old: &Instruction, new: &Instruction) -> Vec<(String, String)> {
    // Where one side has none, as in rung text, nothing is known of a difference.
    let (Some(a), Some(b)) = (&old.message, &new.message) else { return Vec::new() };
    let (a, b) = (&a.settings, &b.settings);
    if a == b {
        return Vec::new();
    }
    let value = |all: &[(std::borrow::Cow<'static, str>, String)], name: &str| {
        all.iter().find(|setting| setting.0 == name).map(|setting| setting.1.clone())
    };
    let mut names: Vec<&str> = a.iter().map(|setting| &*setting.0).collect();
    names.extend(b.iter().map(|setting| &*setting.0).filter(|name| value(a, name).is_none()));
    let differing = names.into_iter().filter_map(|name| {
        let (old, new) = (value(a, name), value(b, name));
        // The flags of the last message, as they stood when the project was saved.
        (old != new && name != "Status").then(|| (name, old.unwrap_or_default(), new.unwrap_or_default()))
    });
    differing.map(|(name, before, after)| (format!("{name}: {before}"), format!("{name}: {after}"))).collect()
}

fn same_operand(
    old: (&Instruction, &Operand),
    new: (&Instruction, &Operand),
    index: usize,
    values: &(Vec<Parameter>, Vec<Parameter>),
    mapping: &Mapping,
) -> bool {
    let of = |all: &[Parameter]| all.iter().find(|parameter| parameter.index == index).cloned();
    if let (Some(a), Some(b)) = (of(&values.0), of(&values.1)) {
        return a.same(&b);
    }
    let text = |(instruction, operand): (&Instruction, &Operand), mapping: &Mapping| {
        let mut text = String::new();
        spell_at(instruction, index, operand, mapping, &mut text);
        text
    };
    text(old, mapping) == text(new, &Mapping::default())
}

/// The pieces of a rung. No recursion: damaged projects nest deep.
fn pieces(rung: &Rung) -> Vec<Piece<&Instruction>> {
    enum Step<'a> {
        Elements(&'a [Element]),
        Legs(&'a [Series]),
        Mark(Piece<&'a Instruction>),
    }
    let (mut out, mut number) = (Vec::new(), 0);
    let mut steps = vec![Step::Elements(&rung.series)];
    while let Some(step) = steps.pop() {
        match step {
            Step::Mark(mark) => out.push(mark),
            Step::Elements(elements) => {
                let Some((first, rest)) = elements.split_first() else { continue };
                steps.push(Step::Elements(rest));
                match first {
                    Element::Instruction(instruction) => {
                        out.push(Piece::Instruction(number, instruction));
                        number += 1;
                    }
                    Element::Branch(branch) => {
                        out.push(Piece::Start);
                        steps.push(Step::Mark(Piece::End));
                        if let Some((first, rest)) = branch.legs.split_first() {
                            steps.push(Step::Legs(rest));
                            steps.push(Step::Elements(first));
                        }
                    }
                }
            }
            Step::Legs(legs) => {
                let Some((first, rest)) = legs.split_first() else { continue };
                out.push(Piece::Next);
                steps.push(Step::Legs(rest));
                steps.push(Step::Elements(first));
            }
        }
    }
    out
}

/// The form that gives the operands of an instruction their meaning.
fn form_of(instruction: &Instruction) -> Option<&'static Form> {
    let entry = instr::by_mnemonic(instruction.mnemonic.name()?)?;
    entry.forms.iter().find(|form| form.operands.len() == instruction.operands.len())
}

fn stored(form: Option<&Form>, index: usize) -> Stored {
    form.and_then(|form| form.operands.get(index)).map_or(Stored::Source, |operand| operand.stored)
}

fn kind(form: Option<&Form>, index: usize) -> Option<Kind> {
    form.and_then(|form| form.operands.get(index)).map(|operand| operand.kind)
}

/// An operand by what it means: spellings of one number are one, the stored file of a label does not
/// count.
fn spell(operand: &Operand, kind: Option<Kind>, mapping: &Mapping, text: &mut String) {
    if kind == Some(Kind::TimeBase)
        && let Some(base) = instr::parameters::time_base(Some(operand))
    {
        text.push_str(base.text());
        return;
    }
    let _ = match operand {
        Operand::Label { number, .. } => write!(text, "Q:{number}"),
        Operand::ProgramFile(number) => write!(text, "U:{}", mapping.file(*number)),
        Operand::Constant(constant) => match constant.number() {
            Number::Integer(number) => write!(text, "{number}"),
            Number::Float(number) => write!(text, "{number:?}"),
        },
        Operand::Address(_) | Operand::Expression(_) if !mapping.is_empty() => {
            write!(text, "{}", mapping.operand(operand))
        }
        operand => write!(text, "{operand}"),
    };
}

/// As [`spell`], for an operand of this instruction; empty for one that is no program content.
fn spell_at(instruction: &Instruction, index: usize, operand: &Operand, mapping: &Mapping, text: &mut String) {
    let form = form_of(instruction);
    if stored(form, index) != Stored::Blank {
        spell(operand, kind(form, index), mapping, text);
    }
}

/// A value that stands in the box of an instruction and in the data table.
#[derive(Clone, Debug, PartialEq)]
struct Parameter {
    /// Number of the operand.
    index: usize,
    /// 1 for PRE and LEN, 2 for ACC and POS, 0 for a value of no known element.
    word: usize,
    /// The data table has the value, the text only shows it.
    held: bool,
    /// The value that counts.
    value: String,
}

impl Parameter {
    /// No difference of the program. Where only one side keeps the value in the table, a running value is
    /// no difference either.
    fn same(&self, other: &Parameter) -> bool {
        match (self.held, other.held) {
            (true, true) => true,
            (false, false) => self.value == other.value,
            _ => self.word == 2 || self.value == other.value,
        }
    }
}

/// The values an instruction displays, with where they count from: those of a compiled instruction live
/// in the data table, and so do those of a text that says what its data table says.
fn parameters(image: &Image, instruction: &Instruction) -> Vec<Parameter> {
    let Some(form) = form_of(instruction) else { return Vec::new() };
    let (mut found, mut element, mut count) = (Vec::new(), None, 0);
    for (index, operand) in instruction.operands.iter().enumerate() {
        if let Operand::Address(address) = operand
            && matches!(address.file_type, FileType::T | FileType::C | FileType::R)
            && address.word.is_none()
            && address.bit.is_none()
        {
            (element, count) = (Some(address), 0);
        }
        if stored(Some(form), index) != Stored::Value {
            continue;
        }
        count += 1;
        let table = element.and_then(|address| {
            let file = image.data_file(address.file_type, address.file.number()?)?;
            file.element_words(address.element.number()?)?.get(count).map(|word| *word as i16)
        });
        let mut text = String::new();
        spell(operand, None, &Mapping::default(), &mut text);
        let held = instruction.compiled || table.is_some_and(|value| value.to_string() == text);
        let value = table.filter(|_| held).map_or(text, |value| value.to_string());
        found.push(Parameter { index, word: if element.is_some() { count } else { 0 }, held, value });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diff::keys::Interner;
    use ladder::{Branch, Mnemonic};

    fn instruction(text: &str) -> Instruction {
        let mut words = text.split(' ');
        let mnemonic = Mnemonic::named(words.next().expect("a mnemonic").to_owned());
        Instruction::new(mnemonic, words.map(Operand::parse).collect())
    }

    fn rung(instructions: &[&str]) -> Rung {
        Rung::new(instructions.iter().map(|text| Element::Instruction(instruction(text))).collect())
    }

    #[test]
    fn equal_logic_has_equal_numbers() {
        let mut interner = Interner::default();
        let mut id = |texts: &[&str]| interner.rung::<Rslogix>(&Image::default(), &rung(texts), &Mapping::default()).id;
        let first = id(&["MVM N7:0 00FFh N7:1", "JMP Q2:1"]);
        assert_eq!(first, id(&["MVM N7:0 255 N7:1", "JMP Q9:1"]));
        assert_ne!(first, id(&["MVM N7:0 254 N7:1", "JMP Q2:1"]));
        assert_ne!(id(&["XIC B3:0/1"]), id(&["XIO B3:0/1"]));
        assert_eq!(id(&["TON T4:0 1.0 10 3"]), id(&["TON T4:0 1 20 4"]));
        assert_ne!(id(&["TON T4:0 1.0 10 3"]), id(&["TON T4:0 0.01 10 3"]));
    }

    #[test]
    fn branches_are_part_of_a_rung() {
        let mut interner = Interner::default();
        let branch = |legs: Vec<Series>| Rung::new(vec![Element::Branch(Branch { legs })]);
        let leg = |text| vec![Element::Instruction(instruction(text))];
        let marks: Vec<_> = pieces(&branch(vec![leg("XIC B3:0/0"), vec![]])).into_iter().map(Piece::mark).collect();
        assert_eq!(marks, [Some("BST"), None, Some("NXB"), Some("BND")]);
        let mut id = |rung: &Rung| interner.rung::<Rslogix>(&Image::default(), rung, &Mapping::default()).id;
        assert_ne!(id(&branch(vec![leg("XIC B3:0/0"), vec![]])), id(&branch(vec![vec![], leg("XIC B3:0/0")])));
    }

    #[test]
    fn values_count_where_no_table_has_them() {
        let mut image = Image::default();
        let timer =
            |preset: &str, compiled| Instruction { compiled, ..instruction(&format!("TON T4:0 1.0 {preset} 0")) };
        let differs = |image: &Image, a: &Instruction, b: &Instruction| {
            let (a, b) = (parameters(image, a), parameters(image, b));
            a.len() == 2 && b.len() == 2 && !a.iter().zip(&b).all(|(a, b)| a.same(b))
        };
        assert!(differs(&image, &timer("10", false), &timer("20", false)));
        assert!(!differs(&image, &timer("10", true), &timer("20", true)));
        let mut file = ladder::DataFile::new(FileType::T, 4, 1);
        file.words = vec![0x0200, 10, 0];
        image.data_files.push(file);
        // The text of a compiled timer shows a value of an earlier time; the table has 10.
        assert!(!differs(&image, &timer("10", false), &timer("99", true)));
        assert!(differs(&image, &timer("20", false), &timer("20", true)));
    }
}
