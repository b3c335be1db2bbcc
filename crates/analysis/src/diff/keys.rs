//! Numbers that are equal for equal logic, and how much two rungs have in common.

use foldhash::HashMap;

use super::language::{Language, Piece};

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
pub(super) fn similarity<T: Ord>(a: &[T], b: &[T]) -> u32 {
    thousandths(shared(a, b), a.len() + b.len())
}

/// Of two lists of `all` items together. Two empty lists are alike.
fn thousandths(shared: usize, all: usize) -> u32 {
    u32::try_from((2000 * shared).checked_div(all).unwrap_or(1000)).unwrap_or(0)
}

/// How many items two sorted lists share.
fn shared<T: Ord>(a: &[T], b: &[T]) -> usize {
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
    pub(super) fn rung<L: Language>(&mut self, program: &L::Program, rung: &L::Rung, mapping: &L::Mapping) -> RungKey {
        let (mut key, mut text, mut words) = (RungKey::default(), String::new(), Vec::new());
        for piece in L::pieces(rung) {
            words.clear();
            match piece {
                Piece::Instruction(_, instruction) => {
                    let mut word = |text: &str| words.push(number_of(&mut self.words, text));
                    L::words(program, instruction, mapping, &mut text, &mut word);
                }
                mark => words.push(number_of(&mut self.words, mark.mark().unwrap_or(""))),
            }
            key.tokens.push(number_of(&mut self.tokens, words.as_slice()));
            key.bag.extend(&words);
        }
        let form = L::form(rung);
        key.id = if form.is_empty() {
            number_of(&mut self.rungs, key.tokens.as_slice())
        } else {
            // A number that no piece has, then that of the form.
            let mut whole = key.tokens.clone();
            whole.extend([u32::MAX, number_of(&mut self.words, form.as_str())]);
            number_of(&mut self.rungs, whole.as_slice())
        };
        key.bag.sort_unstable();
        key
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
