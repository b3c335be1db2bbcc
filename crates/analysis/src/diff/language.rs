//! What a comparison must know of the language that rungs are written in: one implementation per dialect.

use super::keys::RungKey;
use super::{Rename, Word};

/// A dialect. A comparison works on pieces, words and marks; what they mean is said here.
pub(super) trait Language: Sized {
    /// A whole program.
    type Program;
    /// One of its rungs.
    type Rung;
    /// An instruction of a rung.
    type Instruction<'a>: Copy;
    /// What stands for what in the new program: addresses, program files. Applied to the old one before rungs
    /// are compared. The default one changes nothing.
    type Mapping: Default;
    /// Operands where one address stands in the place of another.
    type Replaced: Default;

    /// The program files or code blocks with rungs, in their order.
    fn blocks(program: &Self::Program) -> Vec<Block<'_, Self::Rung>>;

    /// The rung only ends its file.
    fn is_end(rung: &Self::Rung) -> bool;

    /// Instructions and branch marks in order.
    fn pieces(rung: &Self::Rung) -> Vec<Piece<Self::Instruction<'_>>>;

    /// What tells rungs of equal pieces apart; empty if nothing does.
    fn form(_rung: &Self::Rung) -> String {
        String::new()
    }

    /// Hands over the mnemonic and each operand by what they mean; values that are compared by
    /// [`Language::values_differ`] are empty. `text` is a buffer, empty before and after.
    fn words(
        program: &Self::Program,
        instruction: Self::Instruction<'_>,
        mapping: &Self::Mapping,
        text: &mut String,
        word: &mut dyn FnMut(&str),
    );

    /// The mnemonic as it is written.
    fn mnemonic(instruction: Self::Instruction<'_>) -> String;

    /// The same instruction, operands aside.
    fn same_mnemonic(a: Self::Instruction<'_>, b: Self::Instruction<'_>) -> bool {
        Self::mnemonic(a) == Self::mnemonic(b)
    }

    /// The operands as they are written; empty text for one that is not there.
    fn operands(instruction: Self::Instruction<'_>) -> Vec<String>;

    /// What an operand stands for, where it is written like another that means something else.
    fn meaning(_program: &Self::Program, instruction: Self::Instruction<'_>, index: usize) -> String {
        Self::operands(instruction).into_iter().nth(index).unwrap_or_default()
    }

    /// Operands that are written alike, and how many there are.
    fn alike(a: Self::Instruction<'_>, b: Self::Instruction<'_>) -> (usize, usize);

    /// Operands that differ, ascending.
    fn differing(
        old: (Half<'_, Self>, Self::Instruction<'_>),
        new: (Half<'_, Self>, Self::Instruction<'_>),
        mapping: &Self::Mapping,
    ) -> Vec<usize>;

    /// Notes that one operand stands in the place of another.
    fn note(
        old: Self::Instruction<'_>,
        new: Self::Instruction<'_>,
        index: usize,
        programs: (&Self::Program, &Self::Program),
        replaced: &mut Self::Replaced,
    );

    /// Settings behind a set-up screen that differ, in words.
    fn settings(_old: Self::Instruction<'_>, _new: Self::Instruction<'_>) -> Vec<(String, String)> {
        Vec::new()
    }

    /// Rungs of equal words differ in something that the words leave out.
    fn values_differ(_old: Half<'_, Self>, _new: Half<'_, Self>) -> bool {
        false
    }

    /// Instructions of which only one side has the settings.
    fn one_sided_setups(_old: Half<'_, Self>, _new: Half<'_, Self>) -> usize {
        0
    }

    /// The rung as a person reads it as text. `marks` has one entry per piece.
    fn text(rung: &Self::Rung, pieces: &[Piece<Self::Instruction<'_>>], marks: &[Marks]) -> Vec<Word>;

    /// What follows from files that have another number or name.
    fn renumbered(pairs: &[(BlockId<'_>, BlockId<'_>)]) -> Self::Mapping;

    /// The mapping changes nothing.
    fn is_identity(mapping: &Self::Mapping) -> bool;

    /// Addresses that were replaced throughout, which go to `mapping` too.
    fn renames(
        replaced: &Self::Replaced,
        old: &Self::Program,
        new: &Self::Program,
        mapping: &mut Self::Mapping,
    ) -> Vec<Rename>;
}

/// What a program file or code block is known by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum BlockId<'a> {
    /// RSLogix 500 gives numbers.
    Number(u16),
    /// Do-more gives names.
    Name(&'a str),
}

/// A program file or code block.
pub(super) struct Block<'a, R> {
    pub(super) id: BlockId<'a>,
    /// For [`super::Place::file`]: its number, or its place in the program from 1.
    pub(super) number: u16,
    /// Its name, which helps to find a file with another number.
    pub(super) name: &'a str,
    pub(super) rungs: &'a [R],
}

/// A piece of a rung in stored order.
#[derive(Clone, Copy)]
pub(super) enum Piece<I> {
    /// Number in the rung, branch marks not counted.
    Instruction(u32, I),
    /// `BST`
    Start,
    /// `NXB`
    Next,
    /// `BND`
    End,
}

impl<I: Copy> Piece<I> {
    /// The word of a branch mark.
    pub(super) fn mark(self) -> Option<&'static str> {
        match self {
            Piece::Instruction(..) => None,
            Piece::Start => Some("BST"),
            Piece::Next => Some("NXB"),
            Piece::End => Some("BND"),
        }
    }

    pub(super) fn instruction(self) -> Option<(u32, I)> {
        match self {
            Piece::Instruction(number, instruction) => Some((number, instruction)),
            _ => None,
        }
    }
}

/// Which words of a piece differ.
#[derive(Clone, Debug, Default)]
pub(super) struct Marks {
    pub(super) whole: bool,
    pub(super) name: bool,
    pub(super) operands: Vec<usize>,
}

/// One of two rungs that are compared.
pub(super) struct Half<'a, L: Language> {
    pub(super) program: &'a L::Program,
    pub(super) rung: &'a L::Rung,
    pub(super) key: &'a RungKey,
}

impl<L: Language> Clone for Half<'_, L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Language> Copy for Half<'_, L> {}
