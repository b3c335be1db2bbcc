//! What differs inside a rung: instructions and operands.

use ladder::{Image, Operand, Rung};

use super::align::{Work, align, pair_similar};
use super::keys::{self, Parameter, RungKey, Token, parameters, tokens};
use super::renames::{Mapping, Replaced};

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

/// One of the two rungs.
#[derive(Clone, Copy)]
pub(super) struct Half<'a> {
    pub(super) image: &'a Image,
    pub(super) rung: &'a Rung,
    pub(super) key: &'a RungKey,
}

/// Edits and both rungs as words.
#[derive(Default)]
pub(super) struct Inside {
    pub(super) edits: Vec<Edit>,
    pub(super) old_words: Vec<Word>,
    pub(super) new_words: Vec<Word>,
}

/// The words of a rung that has no counterpart.
pub(super) fn words(rung: &Rung) -> Vec<Word> {
    let tokens = tokens(rung);
    let whole = tokens.iter().map(|_| Marks::default()).collect::<Vec<_>>();
    words_of(&tokens, &whole)
}

/// Instructions whose set-up only one of two rungs of equal numbers has: rung text holds none.
pub(super) fn one_sided_setups(old: Half<'_>, new: Half<'_>) -> usize {
    let pairs = old.rung.instructions().zip(new.rung.instructions());
    pairs.filter(|(a, b)| a.message.is_some() != b.message.is_some()).count()
}

/// Something differs in two rungs of equal numbers: set-ups of messages, or values that are program on at
/// least one side.
pub(super) fn values_differ(old: Half<'_>, new: Half<'_>) -> bool {
    let mut setups = old.rung.instructions().zip(new.rung.instructions());
    if setups.any(|(a, b)| !settings((0, a), (0, b)).is_empty()) {
        return true;
    }
    let open = |rung: &Rung| rung.instructions().any(|instruction| !instruction.compiled);
    if !open(old.rung) && !open(new.rung) {
        return false;
    }
    old.rung.instructions().zip(new.rung.instructions()).any(|(a, b)| {
        let (a, b) = (parameters(old.image, a), parameters(new.image, b));
        !a.iter().zip(&b).all(|(a, b)| a.same(b))
    })
}

/// Compares two rungs piece by piece. `mapping` is applied to the old one; addresses in the place of
/// others go to `replaced`.
pub(super) fn compare(
    old: Half<'_>,
    new: Half<'_>,
    mapping: &Mapping,
    work: &mut Work,
    mut replaced: Option<&mut Replaced>,
) -> Inside {
    let (a, b) = (tokens(old.rung), tokens(new.rung));
    let mut inside = Inside::default();
    let mut marks = (
        vec![Marks { whole: true, ..Marks::default() }; a.len()],
        vec![Marks { whole: true, ..Marks::default() }; b.len()],
    );
    let mut branches = false;
    let mut steps: Vec<(Option<usize>, Option<usize>)> = Vec::new();
    let mut from = (0, 0);
    let anchors = align(&old.key.tokens, &new.key.tokens, work);
    for (i, j) in anchors.into_iter().chain([(a.len(), b.len())]) {
        steps.extend(gap(&a, &b, from, (i, j), work));
        if i < a.len() {
            steps.push((Some(i), Some(j)));
        }
        from = (i + 1, j + 1);
    }
    for (i, j) in steps {
        let left = i.and_then(|i| a.get(i)).copied();
        let right = j.and_then(|j| b.get(j)).copied();
        let instructions = (left.and_then(Token::instruction), right.and_then(Token::instruction));
        match instructions {
            (Some((m, x)), Some((n, y))) => {
                let before = inside.edits.len();
                if x.mnemonic != y.mnemonic {
                    inside.edits.push(Edit {
                        kind: EditKind::Instruction,
                        old_instruction: Some(m),
                        new_instruction: Some(n),
                        mnemonic: y.mnemonic.to_string(),
                        operand: None,
                        old: x.mnemonic.to_string(),
                        new: y.mnemonic.to_string(),
                    });
                }
                let values = (parameters(old.image, x), parameters(new.image, y));
                let empty = Operand::Empty;
                for index in 0..x.operands.len().max(y.operands.len()) {
                    let (p, q) = (x.operands.get(index).unwrap_or(&empty), y.operands.get(index).unwrap_or(&empty));
                    if same_operand((x, p), (y, q), index, &values, mapping) {
                        continue;
                    }
                    if let Some(replaced) = replaced.as_deref_mut() {
                        replaced.add(p, q);
                    }
                    inside.edits.push(Edit {
                        kind: EditKind::Operand,
                        old_instruction: Some(m),
                        new_instruction: Some(n),
                        mnemonic: y.mnemonic.to_string(),
                        operand: Some(index),
                        old: p.to_string(),
                        new: q.to_string(),
                    });
                }
                inside.edits.extend(settings((m, x), (n, y)));
                let edits = inside.edits.get(before..).unwrap_or_default();
                let mark = Marks {
                    whole: false,
                    name: edits.iter().any(|edit| matches!(edit.kind, EditKind::Instruction | EditKind::Setting)),
                    operands: edits.iter().filter_map(|edit| edit.operand).collect(),
                };
                set(&mut marks.0, i, mark.clone());
                set(&mut marks.1, j, mark);
            }
            (Some((m, x)), None) => inside.edits.push(one_sided(EditKind::Deleted, m, x)),
            (None, Some((n, y))) => inside.edits.push(one_sided(EditKind::Inserted, n, y)),
            (None, None) if left.is_some() && right.is_some() => {
                set(&mut marks.0, i, Marks::default());
                set(&mut marks.1, j, Marks::default());
            }
            (None, None) => branches = true,
        }
    }
    if branches {
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
    inside.old_words = words_of(&a, &marks.0);
    inside.new_words = words_of(&b, &marks.1);
    inside
}

fn set(marks: &mut [Marks], index: Option<usize>, mark: Marks) {
    if let Some(place) = index.and_then(|index| marks.get_mut(index)) {
        *place = mark;
    }
}

fn one_sided(kind: EditKind, number: u32, instruction: &ladder::Instruction) -> Edit {
    let mut text = instruction.mnemonic.to_string();
    for operand in instruction.operands.iter().filter(|operand| **operand != Operand::Empty) {
        text.push(' ');
        text.push_str(&operand.to_string());
    }
    let new = kind == EditKind::Inserted;
    let (old_instruction, new_instruction) = if new { (None, Some(number)) } else { (Some(number), None) };
    let mnemonic = instruction.mnemonic.to_string();
    let (old, new) = if new { (String::new(), text) } else { (text, String::new()) };
    Edit { kind, old_instruction, new_instruction, mnemonic, operand: None, old, new }
}

/// Pairs between two anchors: similar pieces side by side, all others on their own, in order.
fn gap(
    a: &[Token<'_>],
    b: &[Token<'_>],
    from: (usize, usize),
    to: (usize, usize),
    work: &mut Work,
) -> Vec<(Option<usize>, Option<usize>)> {
    let count = (to.0.saturating_sub(from.0), to.1.saturating_sub(from.1));
    let alike = |i: usize, j: usize| match (a.get(from.0 + i), b.get(from.1 + j)) {
        (Some(x), Some(y)) => piece_similarity(*x, *y),
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

fn piece_similarity(a: Token<'_>, b: Token<'_>) -> u32 {
    match (a.instruction(), b.instruction()) {
        (Some((_, a)), Some((_, b))) => {
            let same = a.operands.iter().zip(&b.operands).filter(|(a, b)| a == b).count();
            let most = a.operands.len().max(b.operands.len()).max(1);
            let operands = u32::try_from(same * 500 / most).unwrap_or(0);
            match (a.mnemonic == b.mnemonic, operands) {
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

/// What another setting of a message is called, and its values.
fn settings(old: (u32, &ladder::Instruction), new: (u32, &ladder::Instruction)) -> Vec<Edit> {
    // Where one side has none, as in rung text, nothing is known of a difference.
    let (Some(a), Some(b)) = (&old.1.message, &new.1.message) else { return Vec::new() };
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
    differing
        .map(|(name, before, after)| Edit {
            kind: EditKind::Setting,
            old_instruction: Some(old.0),
            new_instruction: Some(new.0),
            mnemonic: new.1.mnemonic.to_string(),
            operand: None,
            old: format!("{name}: {before}"),
            new: format!("{name}: {after}"),
        })
        .collect()
}

fn same_operand(
    old: (&ladder::Instruction, &Operand),
    new: (&ladder::Instruction, &Operand),
    index: usize,
    values: &(Vec<Parameter>, Vec<Parameter>),
    mapping: &Mapping,
) -> bool {
    let of = |all: &[Parameter]| all.iter().find(|parameter| parameter.index == index).cloned();
    if let (Some(a), Some(b)) = (of(&values.0), of(&values.1)) {
        return a.same(&b);
    }
    let text = |(instruction, operand): (&ladder::Instruction, &Operand), mapping: &Mapping| {
        let mut text = String::new();
        keys::spell_at(instruction, index, operand, mapping, &mut text);
        text
    };
    text(old, mapping) == text(new, &Mapping::default())
}

/// Which words of a piece differ.
#[derive(Clone, Debug, Default)]
struct Marks {
    whole: bool,
    name: bool,
    operands: Vec<usize>,
}

fn words_of(tokens: &[Token<'_>], marks: &[Marks]) -> Vec<Word> {
    let mut words = Vec::new();
    for (token, marks) in tokens.iter().zip(marks) {
        match token.instruction() {
            None => words.push(Word { text: token.mark().unwrap_or("").to_owned(), marked: marks.whole }),
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
