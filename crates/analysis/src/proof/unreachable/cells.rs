//! The data of a scan, bit by bit: what it begins with, and what it is at every step.

use batsat::Lit;
use ladder::FileType;
use sim::outline::{Outline, Value, Write};

use super::gates::Number;
use super::scan::{Before, Scan, words};

/// What is free during a scan, of the words the machine has.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Nature {
    /// The program's own data.
    Kept,
    /// Terminals: free before the scan.
    Input,
    /// The controller's: free at every look.
    Alien,
}

#[derive(Clone, Copy)]
pub(super) struct Cell {
    pub(super) value: Lit,
    /// Disturbances that are in the value already.
    pub(super) seen: usize,
}

/// Words that something unknown may have happened to.
pub(super) struct Disturbance {
    pub(super) when: Lit,
    pub(super) words: (u32, u32),
}

/// Marks the place of what a timer remembers beside its words: it was not executed since run was entered.
const FRESH: u32 = 1 << 31;

impl Scan<'_> {
    /// Something unknown may happen to words where the condition holds.
    pub(super) fn disturb(&mut self, when: Lit, write: &Write) {
        if when != self.gates.no() {
            self.disturbed.push(Disturbance { when, words: words(write) });
        }
    }

    /// The bit now.
    pub(super) fn bit(&mut self, at: u32) -> Lit {
        let word = (at & !FRESH) / 16;
        if at == self.outline.first_pass && !self.outline.writes(word) {
            return self.first;
        }
        let alien = self.nature.get(word as usize).is_none_or(|nature| *nature == Nature::Alien);
        let volatile = self.volatile.iter().any(|(from, to)| (*from..*to).contains(&word));
        if alien || volatile {
            return self.gates.free();
        }
        let cell = self.cells.get(&at).copied();
        let mut cell = cell.unwrap_or_else(|| Cell { value: self.start(at), seen: 0 });
        while let Some(disturbance) = self.disturbed.get(cell.seen) {
            cell.seen += 1;
            let (from, to) = disturbance.words;
            if (from..to).contains(&word) {
                let unknown = self.gates.free();
                cell.value = self.gates.choose(disturbance.when, unknown, cell.value);
            }
        }
        self.cells.insert(at, cell);
        cell.value
    }

    /// The bit where the program begins.
    fn start(&mut self, at: u32) -> Lit {
        let word = at & !FRESH;
        if at & FRESH != 0 {
            return match self.before {
                Before::Loaded(_) => self.gates.yes(),
                Before::Any => {
                    let fresh = self.gates.free();
                    self.initial.insert(at, fresh);
                    self.gates.or(self.first, fresh)
                }
            };
        }
        let input = self.nature.get((word / 16) as usize) == Some(&Nature::Input);
        if input || self.inputs.contains(&at) {
            return self.gates.free();
        }
        let stored = match self.before {
            Before::Loaded(data) => {
                let word = data.get((at / 16) as usize).copied().unwrap_or(0);
                self.gates.constant(word >> (at % 16) & 1 != 0)
            }
            Before::Any => {
                let stored = self.gates.free();
                self.initial.insert(at, stored);
                stored
            }
        };
        match self.prescan.get(&at).copied() {
            Some(set) => {
                let set = self.gates.constant(set);
                self.gates.choose(self.first, set, stored)
            }
            None => stored,
        }
    }

    pub(super) fn set(&mut self, at: u32, value: Lit, when: Lit) {
        let old = self.bit(at);
        let value = self.gates.choose(when, value, old);
        let seen = self.disturbed.len();
        self.cells.insert(at, Cell { value, seen });
    }

    /// A timer was not executed since run was entered.
    pub(super) fn fresh(&mut self, word: u32) -> Lit {
        self.bit(FRESH | (word * 16))
    }

    pub(super) fn executed(&mut self, word: u32, when: Lit) {
        let no = self.gates.no();
        self.set(FRESH | (word * 16), no, when);
    }

    pub(super) fn word(&mut self, at: u32) -> Number {
        (0..16).map(|bit| self.bit(at * 16 + bit)).collect()
    }

    pub(super) fn put(&mut self, at: u32, number: &[Lit], when: Lit) {
        for (bit, value) in (0..).zip(number) {
            self.set(at * 16 + bit, *value, when);
        }
    }

    /// A value with its own width.
    pub(super) fn value(&mut self, value: Value) -> Number {
        match value {
            Value::Word(at) => self.word(at),
            Value::Long(at) => {
                let mut number = self.word(at);
                number.extend(self.word(at + 1));
                number
            }
            Value::Constant(value) => {
                let width = if i16::try_from(value).is_ok() { 16 } else { 32 };
                self.gates.number(value.into(), width)
            }
        }
    }
}

/// A place that is no bit of the data but what a timer remembers.
pub(super) fn is_hidden(at: u32) -> bool {
    at & FRESH != 0
}

pub(super) fn nature(outline: &Outline) -> Vec<Nature> {
    let mut nature = vec![Nature::Alien; outline.words as usize];
    for range in &outline.files {
        use FileType::{A, B, C, D, F, I, L, N, O, R, ST, T};
        let own = match range.file_type {
            O | B | T | C | R | N | F | A | ST | L | D => Nature::Kept,
            I => Nature::Input,
            _ => continue,
        };
        let (from, to) = range.words;
        if let Some(words) = nature.get_mut(from as usize..to as usize) {
            words.fill(own);
        }
    }
    nature
}
