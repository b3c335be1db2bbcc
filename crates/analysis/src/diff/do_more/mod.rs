//! Rungs of Do-more: text is a program for a stack, people think in contacts and branches.
//!
//! Rungs are compared as series and branches where a drawing says the same as the text, so that a contact put
//! before another is one inserted contact, and not also an `STR` that became an `AND`. The stack program decides
//! whether two rungs are equal.

mod names;
mod sections;

use domore::circuit::{Node, circuit};
use domore::instruction::{self, Effect, Entry, Join};
use domore::{Instruction, Project, Rung};

use super::language::{Block, BlockId, Half, Language, Marks, Piece};
use super::{Difference, Rename, Word};
use names::{Mapping, Names, Replaced};

/// Code blocks that have a number in a comparison.
const MOST_BLOCKS: usize = 65_535;

/// Compares two programs of Do-more.
///
/// Their text holds no data values: [`Difference::values`] is empty and [`Difference::values_left_out`] set.
/// Places name a code block by its place in the text, from 1, and rungs from 0.
pub fn compare_domore(old: &Project, new: &Project) -> Difference {
    let mut difference = Difference { values_left_out: true, ..Difference::default() };
    let programs = (Program::new(old), Program::new(new));
    let matched = super::logic::compare::<Domore<'_>>(&programs.0, &programs.1, &mut difference);
    difference.documentation = sections::documentation(old, new, &matched);
    difference.configuration = sections::configuration(old, new, &matched);
    if [old, new].iter().any(|project| project.code_blocks().nth(MOST_BLOCKS).is_some()) {
        difference.notes.push(format!("only the first {MOST_BLOCKS} code blocks were compared"));
    }
    difference
}

/// The dialect.
struct Domore<'p>(std::marker::PhantomData<&'p Project>);

/// A project with what its names stand for.
struct Program<'p> {
    project: &'p Project,
    names: Names,
}

impl<'p> Program<'p> {
    fn new(project: &'p Project) -> Program<'p> {
        Program { project, names: Names::new(project) }
    }
}

/// An instruction of a rung.
#[derive(Clone, Copy)]
struct Step<'a> {
    instruction: &'a Instruction,
    /// Its place among contacts and branches is known: how it joins the stack is no part of it.
    placed: bool,
}

impl Step<'_> {
    /// The mnemonic by what it means: of contacts that are placed the one that begins a rung.
    fn meaning(self) -> String {
        let entry = instruction::by_mnemonic(&self.instruction.mnemonic);
        match entry.filter(|_| self.placed).map(|entry| entry.effect) {
            Some(Effect::Contact { test, .. }) => {
                let alike = |other: &&Entry| other.effect == Effect::Contact { join: Join::Push, test };
                let first = instruction::TABLE.iter().find(alike);
                first.map_or_else(|| self.instruction.mnemonic.to_ascii_uppercase(), |it| it.mnemonic.to_owned())
            }
            _ => self.instruction.mnemonic.to_ascii_uppercase(),
        }
    }
}

impl<'p> Language for Domore<'p> {
    type Program = Program<'p>;
    type Rung = Rung;
    type Instruction<'a> = Step<'a>;
    type Mapping = Mapping;
    type Replaced = Replaced;

    fn blocks<'a>(program: &'a Program<'p>) -> Vec<Block<'a, Rung>> {
        let numbered = (1..=u16::MAX).zip(program.project.code_blocks());
        numbered
            .map(|(number, block)| Block {
                id: BlockId::Name(&block.name),
                number,
                name: &block.name,
                rungs: &block.rungs,
            })
            .collect()
    }

    /// Designer counts no rung that ends a code block; a comment at the end of one may have no rung.
    fn is_end(rung: &Rung) -> bool {
        rung.instructions.is_empty()
    }

    fn pieces(rung: &Rung) -> Vec<Piece<Step<'_>>> {
        let mut pieces = Vec::new();
        match circuit(rung) {
            Ok(nodes) => flatten(rung, &nodes, &mut pieces),
            Err(_) => {
                let steps = rung.instructions.iter().map(|instruction| Step { instruction, placed: false });
                pieces.extend((0..).zip(steps).map(|(number, step)| Piece::Instruction(number, step)));
            }
        }
        pieces
    }

    /// The stack program without operands: one drawing can be written in several ways.
    fn form(rung: &Rung) -> String {
        let mut form = String::new();
        for instruction in &rung.instructions {
            form.push_str(&instruction.mnemonic.to_ascii_uppercase());
            form.push(' ');
        }
        form
    }

    fn words(program: &Program<'p>, it: Step<'_>, mapping: &Mapping, text: &mut String, word: &mut dyn FnMut(&str)) {
        word(&it.meaning());
        for index in 0..it.instruction.operands.len() {
            program.names.spell(it.instruction, index, mapping, text);
            word(text);
            text.clear();
        }
    }

    fn mnemonic(it: Step<'_>) -> String {
        it.instruction.mnemonic.clone()
    }

    fn same_mnemonic(a: Step<'_>, b: Step<'_>) -> bool {
        a.meaning() == b.meaning()
    }

    fn operands(it: Step<'_>) -> Vec<String> {
        it.instruction.operands.clone()
    }

    fn meaning(program: &Program<'p>, it: Step<'_>, index: usize) -> String {
        let mut text = String::new();
        program.names.spell(it.instruction, index, &Mapping::default(), &mut text);
        format!("{} ({text})", it.instruction.operand(index))
    }

    fn alike(a: Step<'_>, b: Step<'_>) -> (usize, usize) {
        let (a, b) = (&a.instruction.operands, &b.instruction.operands);
        (a.iter().zip(b).filter(|(a, b)| a == b).count(), a.len().max(b.len()))
    }

    fn differing(
        (old, x): (Half<'_, Self>, Step<'_>),
        (new, y): (Half<'_, Self>, Step<'_>),
        mapping: &Mapping,
    ) -> Vec<usize> {
        let differs = |index: &usize| {
            let (mut a, mut b) = (String::new(), String::new());
            old.program.names.spell(x.instruction, *index, mapping, &mut a);
            new.program.names.spell(y.instruction, *index, &Mapping::default(), &mut b);
            a != b
        };
        (0..x.instruction.operands.len().max(y.instruction.operands.len())).filter(differs).collect()
    }

    fn note(
        old: Step<'_>,
        new: Step<'_>,
        index: usize,
        programs: (&Program<'p>, &Program<'p>),
        replaced: &mut Replaced,
    ) {
        let spell = |program: &Program<'_>, it: Step<'_>| {
            let mut text = String::new();
            program.names.spell(it.instruction, index, &Mapping::default(), &mut text);
            text
        };
        let (a, b) = (spell(programs.0, old), spell(programs.1, new));
        replaced.add((&programs.0.names, &a), (&programs.1.names, &b));
    }

    /// In the order of the text, which is the one that people import; instructions divided by `;`.
    fn text(rung: &Rung, pieces: &[Piece<Step<'_>>], marks: &[Marks]) -> Vec<Word> {
        let numbered = pieces.iter().zip(marks).filter_map(|(piece, marks)| Some((piece.instruction()?.0, marks)));
        let marks: std::collections::HashMap<u32, &Marks> = numbered.collect();
        let none = Marks::default();
        let mut words: Vec<Word> = Vec::new();
        for (number, instruction) in (0..).zip(&rung.instructions) {
            let marks = marks.get(&number).copied().unwrap_or(&none);
            if let Some(last) = words.last_mut() {
                last.text.push(';');
            }
            words.push(Word { text: instruction.mnemonic.clone(), marked: marks.whole || marks.name });
            for (index, operand) in instruction.operands.iter().enumerate() {
                words.push(Word { text: operand.clone(), marked: marks.whole || marks.operands.contains(&index) });
            }
        }
        words
    }

    fn renumbered(pairs: &[(BlockId<'_>, BlockId<'_>)]) -> Mapping {
        let names = pairs.iter().filter_map(|pair| match pair {
            (BlockId::Name(a), BlockId::Name(b)) if a != b => Some((*a, *b)),
            _ => None,
        });
        Mapping::of_blocks(names)
    }

    fn is_identity(mapping: &Mapping) -> bool {
        mapping.is_empty()
    }

    fn renames(replaced: &Replaced, old: &Program<'p>, new: &Program<'p>, mapping: &mut Mapping) -> Vec<Rename> {
        replaced.find((old.project, &old.names), (new.project, &new.names), mapping)
    }
}

/// Nesting is bounded by [`domore::circuit::MAX_DEPTH`].
fn flatten<'a>(rung: &'a Rung, nodes: &[Node], pieces: &mut Vec<Piece<Step<'a>>>) {
    let place = |index: usize, pieces: &mut Vec<Piece<Step<'a>>>| {
        if let (Some(instruction), Ok(number)) = (rung.instructions.get(index), u32::try_from(index)) {
            pieces.push(Piece::Instruction(number, Step { instruction, placed: true }));
        }
    };
    for node in nodes {
        let (legs, index) = match node {
            Node::Instruction(index) => {
                place(*index, pieces);
                continue;
            }
            Node::Branch(legs) => (legs, None),
            Node::Box { index, legs } => (legs, Some(*index)),
        };
        pieces.push(Piece::Start);
        for (number, leg) in legs.iter().enumerate() {
            if number > 0 {
                pieces.push(Piece::Next);
            }
            flatten(rung, leg, pieces);
        }
        pieces.push(Piece::End);
        if let Some(index) = index {
            place(index, pieces);
        }
    }
}
