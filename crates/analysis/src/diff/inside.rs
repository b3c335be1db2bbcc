//! What differs inside a rung: instructions and operands.

use super::align::{Work, align, pair_similar};
use super::language::{Half, Language, Marks, Piece};

/// A difference inside a rung.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// What happened.
    pub kind: EditKind,
    /// Number of the instruction in the old rung, branch marks not counted.
    pub old_instruction: Option<u32>,
    /// Number of the instruction in the new rung.
    pub new_instruction: Option<u32>,
    /// Its mnemonic, that of the new rung if both have one; empty for branches.
    pub mnemonic: String,
    /// Which operand, from 0.
    pub operand: Option<usize>,
    /// What was there: the operand, the instruction or the setting.
    pub old: String,
    /// What is there now.
    pub new: String,
}

/// Kinds of differences inside a rung.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EditKind {
    /// Another operand.
    Operand,
    /// Another instruction in its place.
    Instruction,
    /// A new instruction.
    Inserted,
    /// An instruction that is gone.
    Deleted,
    /// A setting behind the setup screen.
    Setting,
    /// Branches begin, divide or end elsewhere.
    Branches,
}

impl EditKind {
    /// The lower-case word of outputs.
    pub fn as_str(self) -> &'static str {
        match self {
            EditKind::Operand => "operand",
            EditKind::Instruction => "instruction",
            EditKind::Inserted => "inserted",
            EditKind::Deleted => "deleted",
            EditKind::Setting => "setting",
            EditKind::Branches => "branches",
        }
    }
}

/// A mnemonic, operand or branch mark of a rung.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word {
    /// As rung text has it.
    pub text: String,
    /// The other rung has something else.
    pub marked: bool,
}

/// Edits and both rungs as words.
#[derive(Default)]
pub(super) struct Inside {
    pub(super) edits: Vec<Edit>,
    pub(super) old_words: Vec<Word>,
    pub(super) new_words: Vec<Word>,
}

/// The words of a rung that has no counterpart.
pub(super) fn words<L: Language>(rung: &L::Rung) -> Vec<Word> {
    let pieces = L::pieces(rung);
    let none = vec![Marks::default(); pieces.len()];
    L::text(rung, &pieces, &none)
}

/// Compares two rungs piece by piece. `mapping` is applied to the old one; addresses in the place of
/// others go to `replaced`.
pub(super) fn compare<L: Language>(
    old: Half<'_, L>,
    new: Half<'_, L>,
    mapping: &L::Mapping,
    work: &mut Work,
    mut replaced: Option<&mut L::Replaced>,
) -> Inside {
    let (a, b) = (L::pieces(old.rung), L::pieces(new.rung));
    let mut inside = Inside::default();
    let whole = Marks { whole: true, ..Marks::default() };
    let mut marks = (vec![whole.clone(); a.len()], vec![whole; b.len()]);
    let mut branches = false;
    let mut steps: Vec<(Option<usize>, Option<usize>)> = Vec::new();
    let mut from = (0, 0);
    let anchors = align(&old.key.tokens, &new.key.tokens, work);
    for (i, j) in anchors.into_iter().chain([(a.len(), b.len())]) {
        steps.extend(gap::<L>(&a, &b, from, (i, j), work));
        if i < a.len() {
            steps.push((Some(i), Some(j)));
        }
        from = (i + 1, j + 1);
    }
    for (i, j) in steps {
        let left = i.and_then(|i| a.get(i)).copied();
        let right = j.and_then(|j| b.get(j)).copied();
        let instructions = (left.and_then(Piece::instruction), right.and_then(Piece::instruction));
        match instructions {
            (Some((m, x)), Some((n, y))) => {
                let edit = |kind, operand, old, new| Edit {
                    kind,
                    old_instruction: Some(m),
                    new_instruction: Some(n),
                    mnemonic: L::mnemonic(y),
                    operand,
                    old,
                    new,
                };
                let before = inside.edits.len();
                if !L::same_mnemonic(x, y) {
                    inside.edits.push(edit(EditKind::Instruction, None, L::mnemonic(x), L::mnemonic(y)));
                }
                let differing = L::differing((old, x), (new, y), mapping);
                if !differing.is_empty() {
                    let (p, q) = (L::operands(x), L::operands(y));
                    let text = |all: &[String], index: usize| all.get(index).cloned().unwrap_or_default();
                    for index in differing {
                        if let Some(replaced) = replaced.as_deref_mut() {
                            L::note(x, y, index, (old.program, new.program), replaced);
                        }
                        let (mut before, mut after) = (text(&p, index), text(&q, index));
                        if before == after {
                            before = L::meaning(old.program, x, index);
                            after = L::meaning(new.program, y, index);
                        }
                        inside.edits.push(edit(EditKind::Operand, Some(index), before, after));
                    }
                }
                let settings = L::settings(x, y).into_iter();
                inside.edits.extend(settings.map(|(old, new)| edit(EditKind::Setting, None, old, new)));
                let edits = inside.edits.get(before..).unwrap_or_default();
                let mark = Marks {
                    whole: false,
                    name: edits.iter().any(|edit| matches!(edit.kind, EditKind::Instruction | EditKind::Setting)),
                    operands: edits.iter().filter_map(|edit| edit.operand).collect(),
                };
                set(&mut marks.0, i, mark.clone());
                set(&mut marks.1, j, mark);
            }
            (Some((m, x)), None) => inside.edits.push(one_sided::<L>(EditKind::Deleted, m, x)),
            (None, Some((n, y))) => inside.edits.push(one_sided::<L>(EditKind::Inserted, n, y)),
            (None, None) if left.is_some() && right.is_some() => {
                set(&mut marks.0, i, Marks::default());
                set(&mut marks.1, j, Marks::default());
            }
            (None, None) => branches = true,
        }
    }
    // Rungs that differ in nothing but how their pieces are joined.
    if branches || (inside.edits.is_empty() && L::form(old.rung) != L::form(new.rung)) {
        inside.edits.push(Edit {
            kind: EditKind::Branches,
            old_instruction: None,
            new_instruction: None,
            mnemonic: String::new(),
            operand: None,
            old: String::new(),
            new: String::new(),
        });
    }
    inside.old_words = L::text(old.rung, &a, &marks.0);
    inside.new_words = L::text(new.rung, &b, &marks.1);
    inside
}

fn set(marks: &mut [Marks], index: Option<usize>, mark: Marks) {
    if let Some(place) = index.and_then(|index| marks.get_mut(index)) {
        *place = mark;
    }
}

fn one_sided<L: Language>(kind: EditKind, number: u32, instruction: L::Instruction<'_>) -> Edit {
    let mnemonic = L::mnemonic(instruction);
    let mut text = mnemonic.clone();
    for operand in L::operands(instruction).iter().filter(|operand| !operand.is_empty()) {
        text.push(' ');
        text.push_str(operand);
    }
    let new = kind == EditKind::Inserted;
    let (old_instruction, new_instruction) = if new { (None, Some(number)) } else { (Some(number), None) };
    let (old, new) = if new { (String::new(), text) } else { (text, String::new()) };
    Edit { kind, old_instruction, new_instruction, mnemonic, operand: None, old, new }
}

/// Pairs between two anchors: similar pieces side by side, all others on their own, in order.
fn gap<L: Language>(
    a: &[Piece<L::Instruction<'_>>],
    b: &[Piece<L::Instruction<'_>>],
    from: (usize, usize),
    to: (usize, usize),
    work: &mut Work,
) -> Vec<(Option<usize>, Option<usize>)> {
    let count = (to.0.saturating_sub(from.0), to.1.saturating_sub(from.1));
    let alike = |i: usize, j: usize| match (a.get(from.0 + i), b.get(from.1 + j)) {
        (Some(x), Some(y)) => piece_similarity::<L>(*x, *y),
        _ => 0,
    };
    let pairs = pair_similar(count, 4, work, alike);
    let (mut steps, mut next) = (Vec::new(), (0, 0));
    for (i, j) in pairs.into_iter().chain([count]) {
        steps.extend((next.0..i).map(|i| (Some(from.0 + i), None)));
        steps.extend((next.1..j).map(|j| (None, Some(from.1 + j))));
        if (i, j) != count {
            steps.push((Some(from.0 + i), Some(from.1 + j)));
        }
        next = (i + 1, j + 1);
    }
    steps
}

fn piece_similarity<L: Language>(a: Piece<L::Instruction<'_>>, b: Piece<L::Instruction<'_>>) -> u32 {
    match (a.instruction(), b.instruction()) {
        (Some((_, a)), Some((_, b))) => {
            let (same, most) = L::alike(a, b);
            let operands = u32::try_from(same * 500 / most.max(1)).unwrap_or(0);
            match (L::same_mnemonic(a, b), operands) {
                (true, operands) => 500 + operands,
                // A few of many operands agree by chance.
                (false, operands) if operands >= 300 => operands,
                _ => 0,
            }
        }
        // Marks of one kind have one number: `align` has them.
        _ => 0,
    }
}
