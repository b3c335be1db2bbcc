//! What comes from outside in a scan: the clock, waves, and the time of timers that do not run in every scan.

use std::collections::HashMap;

use super::gates::{Gates, Line};
use super::words::Word;

/// Values from outside, the same for every program that is followed with them.
#[derive(Default)]
pub(crate) struct Outside {
    named: HashMap<(String, Vec<Line>), Word>,
}

impl Outside {
    /// Forgets what was named behind so many gates.
    pub(crate) fn forget(&mut self, size: usize) {
        self.named.retain(|(_, on), word| on.iter().chain(&*word).all(|line| ((*line >> 1) as usize) < size));
    }

    /// The bits of a name, as far as there are any.
    pub(crate) fn get(&self, key: &(String, Vec<Line>)) -> Option<&Word> {
        self.named.get(key)
    }

    /// Gives a name its bits.
    pub(crate) fn put(&mut self, name: &str, on: &[Line], word: Word) {
        self.named.insert((name.to_owned(), on.to_vec()), word);
    }

    /// All names with their bits.
    pub(crate) fn all(&self) -> impl Iterator<Item = (&(String, Vec<Line>), &Word)> {
        self.named.iter()
    }

    /// So many bits from outside, the same ones for the same name.
    pub(crate) fn word(&mut self, gates: &mut Gates, name: &str, on: &[Line], bits: usize) -> Word {
        self.named
            .entry((name.to_owned(), on.to_vec()))
            .or_insert_with(|| (0..bits).map(|_| gates.input()).collect())
            .clone()
    }
}
