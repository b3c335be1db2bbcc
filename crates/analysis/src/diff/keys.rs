//! What a rung is, apart from what RSLogix displays in it: numbers that are equal for equal logic.

use std::fmt::Write;

use foldhash::HashMap;
use instr::{Form, Kind, Stored};
use ladder::{Element, FileType, Image, Instruction, Number, Operand, Rung, Series};

use super::renames::Mapping;

/// A piece of a rung in stored order.
#[derive(Clone, Copy)]
pub(super) enum Token<'a> {
    /// Number in the rung, branch marks not counted.
    Instruction(u32, &'a Instruction),
    /// `BST`
    Start,
    /// `NXB`
    Next,
    /// `BND`
    End,
}

impl<'a> Token<'a> {
    /// The word of a branch mark.
    pub(super) fn mark(self) -> Option<&'static str> {
        match self {
            Token::Instruction(..) => None,
            Token::Start => Some("BST"),
            Token::Next => Some("NXB"),
            Token::End => Some("BND"),
        }
    }

    pub(super) fn instruction(self) -> Option<(u32, &'a Instruction)> {
        match self {
            Token::Instruction(number, instruction) => Some((number, instruction)),
            _ => None,
        }
    }
}

/// The pieces of a rung. No recursion: damaged projects nest deep.
pub(super) fn tokens(rung: &Rung) -> Vec<Token<'_>> {
    enum Step<'a> {
        Elements(&'a [Element]),
        Legs(&'a [Series]),
        Mark(Token<'a>),
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
                        out.push(Token::Instruction(number, instruction));
                        number += 1;
                    }
                    Element::Branch(branch) => {
                        out.push(Token::Start);
                        steps.push(Step::Mark(Token::End));
                        if let Some((first, rest)) = branch.legs.split_first() {
                            steps.push(Step::Legs(rest));
                            steps.push(Step::Elements(first));
                        }
                    }
                }
            }
            Step::Legs(legs) => {
                let Some((first, rest)) = legs.split_first() else { continue };
                out.push(Token::Next);
                steps.push(Step::Legs(rest));
                steps.push(Step::Elements(first));
            }
        }
    }
    out
}

/// A rung as numbers of an [`Interner`].
#[derive(Clone, Debug, Default)]
pub(super) struct RungKey {
    /// Equal for equal rungs.
    pub(super) id: u32,
    /// Equal for equal pieces.
    pub(super) tokens: Vec<u32>,
    /// All words, sorted: for similarity.
    pub(super) bag: Vec<u32>,
}

impl RungKey {
    /// Words in common, of 1000; at least `whole` if one rung has all words of the other, as after a branch
    /// was put around a rung of few words.
    pub(super) fn similarity(&self, other: &RungKey, whole: u32) -> u32 {
        let shared = shared(&self.bag, &other.bag);
        let least = if shared > 0 && shared == self.bag.len().min(other.bag.len()) { whole } else { 0 };
        thousandths(shared, self.bag.len() + other.bag.len()).max(least)
    }
}

/// Items that two sorted lists share, of 1000.
pub(super) fn similarity(a: &[u32], b: &[u32]) -> u32 {
    thousandths(shared(a, b), a.len() + b.len())
}

/// Of two lists of `all` items together. Two empty lists are alike.
fn thousandths(shared: usize, all: usize) -> u32 {
    u32::try_from((2000 * shared).checked_div(all).unwrap_or(1000)).unwrap_or(0)
}

/// How many items two sorted lists share.
fn shared(a: &[u32], b: &[u32]) -> usize {
    let (mut i, mut j, mut shared) = (0, 0, 0_usize);
    while let (Some(x), Some(y)) = (a.get(i), b.get(j)) {
        match x.cmp(y) {
            std::cmp::Ordering::Less => i += 1,
            std::cmp::Ordering::Greater => j += 1,
            std::cmp::Ordering::Equal => (i, j, shared) = (i + 1, j + 1, shared + 1),
        }
    }
    shared
}

/// Gives equal texts, pieces and rungs equal numbers. Whole texts are compared, not their hashes: a
/// changed rung can never pass for an equal one.
#[derive(Default)]
pub(super) struct Interner {
    words: HashMap<Box<str>, u32>,
    tokens: HashMap<Box<[u32]>, u32>,
    rungs: HashMap<Box<[u32]>, u32>,
}

impl Interner {
    pub(super) fn rung(&mut self, rung: &Rung, mapping: &Mapping) -> RungKey {
        let (mut key, mut text, mut words) = (RungKey::default(), String::new(), Vec::new());
        for token in tokens(rung) {
            words.clear();
            match token {
                Token::Instruction(_, instruction) => self.words_of(instruction, mapping, &mut text, &mut words),
                mark => words.push(number_of(&mut self.words, mark.mark().unwrap_or(""))),
            }
            key.tokens.push(number_of(&mut self.tokens, words.as_slice()));
            key.bag.extend(&words);
        }
        key.id = number_of(&mut self.rungs, key.tokens.as_slice());
        key.bag.sort_unstable();
        key
    }

    fn words_of(&mut self, instruction: &Instruction, mapping: &Mapping, text: &mut String, words: &mut Vec<u32>) {
        let mut word = |text: &mut String| {
            words.push(number_of(&mut self.words, text.as_str()));
            text.clear();
        };
        text.clear();
        // Writing to a string cannot fail.
        let _ = write!(text, "{}", instruction.mnemonic);
        word(text);
        let form = form_of(instruction);
        for (index, operand) in instruction.operands.iter().enumerate() {
            // Values are compared by `parameters`, set-ups of messages by `inside`: whether they count depends on
            // both sides.
            if !matches!(stored(form, index), Stored::Value | Stored::Blank) {
                spell(operand, kind(form, index), mapping, text);
            }
            word(text);
        }
    }
}

/// The number of a key, the next free one for a new key.
fn number_of<K: ?Sized + std::hash::Hash + Eq>(numbers: &mut HashMap<Box<K>, u32>, key: &K) -> u32
where
    Box<K>: for<'a> From<&'a K>,
{
    if let Some(number) = numbers.get(key) {
        return *number;
    }
    let next = u32::try_from(numbers.len()).unwrap_or(u32::MAX);
    numbers.insert(Box::from(key), next);
    next
}

/// The form that gives the operands of an instruction their meaning.
pub(super) fn form_of(instruction: &Instruction) -> Option<&'static Form> {
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
pub(super) fn spell(operand: &Operand, kind: Option<Kind>, mapping: &Mapping, text: &mut String) {
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
pub(super) fn spell_at(
    instruction: &Instruction,
    index: usize,
    operand: &Operand,
    mapping: &Mapping,
    text: &mut String,
) {
    let form = form_of(instruction);
    if stored(form, index) != Stored::Blank {
        spell(operand, kind(form, index), mapping, text);
    }
}

/// A value that stands in the box of an instruction and in the data table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Parameter {
    /// Number of the operand.
    pub(super) index: usize,
    /// 1 for PRE and LEN, 2 for ACC and POS, 0 for a value of no known element.
    pub(super) word: usize,
    /// The data table has the value, the text only shows it.
    pub(super) held: bool,
    /// The value that counts.
    value: String,
}

impl Parameter {
    /// No difference of the program. Where only one side keeps the value in the table, a running value is
    /// no difference either.
    pub(super) fn same(&self, other: &Parameter) -> bool {
        match (self.held, other.held) {
            (true, true) => true,
            (false, false) => self.value == other.value,
            _ => self.word == 2 || self.value == other.value,
        }
    }
}

/// The values an instruction displays, with where they count from: those of a compiled instruction live
/// in the data table, and so do those of a text that says what its data table says.
pub(super) fn parameters(image: &Image, instruction: &Instruction) -> Vec<Parameter> {
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
        let mut id = |texts: &[&str]| interner.rung(&rung(texts), &Mapping::default()).id;
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
        let marks: Vec<_> = tokens(&branch(vec![leg("XIC B3:0/0"), vec![]])).into_iter().map(Token::mark).collect();
        assert_eq!(marks, [Some("BST"), None, Some("NXB"), Some("BND")]);
        let mut id = |rung: &Rung| interner.rung(rung, &Mapping::default()).id;
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
