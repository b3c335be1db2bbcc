//! Two programs that are followed one behind the other: where the second one cannot differ from the first, it goes
//! on with the same lines, so that what follows needs no argument.

use std::collections::HashMap;

use super::gates::{Answer, Gates, Line, OFF, value};
use super::words::{Word, bit};

/// Block, rung, and how often it ran before in this scan.
pub(crate) type Visit = (usize, usize, usize);

/// An instruction of a rung that is visited.
pub(crate) type Step = (Visit, usize);

/// What a program wrote.
#[derive(Default)]
pub(crate) struct Notes {
    /// The rung behind which all memory is noted.
    watched: (usize, usize),
    /// By instruction.
    steps: HashMap<Step, HashMap<u32, Line>>,
    /// Values that are stored, with the power they are stored under.
    stored: HashMap<Step, (Word, Line)>,
    /// All memory behind the watched rung.
    behind: HashMap<Visit, HashMap<u32, Line>>,
}

impl Notes {
    pub(crate) fn new(watched: (usize, usize)) -> Notes {
        Notes { watched, ..Notes::default() }
    }

    pub(crate) fn write(&mut self, step: Step, bit: u32, line: Line) {
        self.steps.entry(step).or_default().insert(bit, line);
    }

    /// A value is stored under power.
    pub(crate) fn store(&mut self, step: Step, value: &[Line], power: Line) {
        self.stored.insert(step, (value.to_vec(), power));
    }

    /// A rung ends.
    pub(crate) fn end(&mut self, visit: Visit, memory: &HashMap<u32, Line>) {
        if self.watched == (visit.0, visit.1) {
            self.behind.insert(visit, memory.clone());
        }
    }
}

/// The second program meets the first.
pub(crate) struct Meeting<'n> {
    notes: &'n Notes,
    /// What holds before the scan.
    given: &'n [Line],
    /// Values of all nodes for which something differed.
    seen: Vec<Vec<bool>>,
    /// Questions that may still be asked, and how many of them may stay open.
    questions: usize,
    open: usize,
}

/// Steps of the solver for a question.
const STEPS: u64 = 4000;

/// Questions about one place whose answer is a difference.
const MOST_QUESTIONS: usize = 12;
/// Differences kept.
const MOST_SEEN: usize = 24;

impl<'n> Meeting<'n> {
    /// Asks no more than so many questions.
    pub(crate) fn new(notes: &'n Notes, given: &'n [Line], questions: usize) -> Meeting<'n> {
        Meeting { notes, given, seen: Vec::new(), questions, open: questions / 16 }
    }

    /// Bits of the first program behind an instruction or the whole changed rung.
    pub(crate) fn rows(&self, visit: Visit, instruction: Option<usize>) -> impl Iterator<Item = (&u32, &Line)> {
        let rows = match instruction {
            Some(instruction) => self.notes.steps.get(&(visit, instruction)),
            None => self.notes.behind.get(&visit),
        };
        rows.into_iter().flatten()
    }

    /// A value to be stored under power, with the lines of the first program's where they cannot differ then.
    pub(crate) fn store(&mut self, gates: &mut Gates, step: Step, value: &mut Word, power: Line) {
        let Some((other, same)) = self.notes.stored.get(&step) else { return };
        let length = value.len().max(other.len());
        if *same != power || value == other || length > 32 {
            return;
        }
        let lines: Vec<(Line, Line)> = (0..length).map(|at| (bit(value, at), bit(other, at))).collect();
        let mut rows = Vec::new();
        for (at, (own, line)) in (0..).zip(&lines).filter(|row| row.1.0 != row.1.1) {
            rows.push((at, gates.and(power, *own), gates.and(power, *line)));
        }
        let mut word: Word = lines.iter().map(|row| row.0).collect();
        for (at, _) in self.alike(gates, rows) {
            word[at as usize] = lines[at as usize].1;
        }
        *value = word;
    }

    /// Of bits with their own line and the first program's, those that cannot differ.
    pub(crate) fn alike(&mut self, gates: &mut Gates, mut rows: Vec<(u32, Line, Line)>) -> Vec<(u32, Line)> {
        rows.sort_unstable();
        for _ in 0..MOST_QUESTIONS {
            for values in &mut self.seen {
                gates.extend(values);
            }
            rows.retain(|row| self.seen.iter().all(|values| value(values, row.1) == value(values, row.2)));
            if rows.is_empty() {
                return Vec::new();
            }
            match self.differ(gates, &rows) {
                Answer::Never => return rows.into_iter().map(|row| (row.0, row.2)).collect(),
                Answer::Values(values) => {
                    if self.seen.len() == MOST_SEEN {
                        self.seen.remove(0);
                    }
                    self.seen.push(values);
                }
                // Word by word.
                Answer::Open => {
                    let mut alike = Vec::new();
                    for word in rows.chunk_by(|a, b| a.0 >> 4 == b.0 >> 4) {
                        if word.len() < rows.len() && matches!(self.differ(gates, word), Answer::Never) {
                            alike.extend(word.iter().map(|row| (row.0, row.2)));
                        }
                    }
                    return alike;
                }
            }
        }
        Vec::new()
    }

    fn differ(&mut self, gates: &mut Gates, rows: &[(u32, Line, Line)]) -> Answer {
        if self.questions == 0 || self.open == 0 {
            return Answer::Open;
        }
        self.questions -= 1;
        let mut any = OFF;
        for row in rows {
            let differs = gates.xor(row.1, row.2);
            any = gates.or(any, differs);
        }
        let patience = std::mem::replace(&mut gates.patience, STEPS);
        let answer = gates.ask(any, self.given);
        gates.patience = patience;
        self.open -= usize::from(matches!(answer, Answer::Open));
        answer
    }
}
