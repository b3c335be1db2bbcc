//! Rungs: a series of instructions and branches, in power-flow order.

use std::borrow::Cow;
use std::fmt;

use crate::{Comment, Operand};

/// A rung of a program file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rung {
    /// What stands between the power rails, left to right.
    pub series: Series,
    /// Edited since the program was last verified: printed with `e` marks in the margin.
    pub edited: bool,
    /// Rung comment and page title.
    pub comment: Option<Comment>,
}

/// Elements one after the other: power flows through all of them.
pub type Series = Vec<Element>;

/// One element of a series.
#[derive(Clone, Debug, PartialEq)]
pub enum Element {
    /// A contact, coil or box.
    Instruction(Instruction),
    /// Parallel paths.
    Branch(Branch),
}

/// Parallel legs from top to bottom. An empty leg is a short circuit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Branch {
    /// The legs, top leg first.
    pub legs: Vec<Series>,
}

/// The name of an instruction, or the number of one without a known name.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Mnemonic {
    /// `XIC`, `TON`, ...
    Named(Cow<'static, str>),
    /// The project stores an operation code whose instruction is not known. Shown with its number,
    /// never guessed.
    Unknown(u16),
}

impl Mnemonic {
    /// A known name; upper case.
    pub fn named(name: impl Into<Cow<'static, str>>) -> Mnemonic {
        Mnemonic::Named(name.into())
    }

    /// The name, or `None` for an unknown operation code.
    pub fn name(&self) -> Option<&str> {
        match self {
            Mnemonic::Named(name) => Some(name),
            Mnemonic::Unknown(_) => None,
        }
    }
}

impl PartialEq<str> for Mnemonic {
    fn eq(&self, other: &str) -> bool {
        self.name() == Some(other)
    }
}

impl PartialEq<&str> for Mnemonic {
    fn eq(&self, other: &&str) -> bool {
        self.name() == Some(*other)
    }
}

impl fmt::Display for Mnemonic {
    /// The name; an unknown code as `op0x4D`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Mnemonic::Named(name) => f.write_str(name),
            Mnemonic::Unknown(code) => write!(f, "op0x{code:02X}"),
        }
    }
}

/// One instruction with its operands.
#[derive(Clone, Debug, PartialEq)]
pub struct Instruction {
    /// Which instruction.
    pub mnemonic: Mnemonic,
    /// Operands in the order of the box, placeholders such as `Setup Screen` included.
    /// Timers: timer, time base, preset, accum; preset and accum as last displayed.
    pub operands: Vec<Operand>,
    /// The value last displayed beside each operand that shows one (`5120<` on paper). A snapshot,
    /// never program content. Same length as `operands`, or empty when none is known.
    pub displayed: Vec<Option<String>>,
    /// The instruction was compiled when the program was last verified. `false`: never verified;
    /// then the texts of timer and counter parameters are the program, not the data table.
    pub compiled: bool,
    /// Settings of a MSG behind its setup screen.
    pub message: Option<Box<MessageSetup>>,
}

impl Instruction {
    /// An instruction as text gives it: nothing displayed, not yet compiled.
    pub fn new(mnemonic: Mnemonic, operands: Vec<Operand>) -> Instruction {
        Instruction { mnemonic, operands, displayed: Vec::new(), compiled: false, message: None }
    }

    /// Same instruction on the same operands, whatever was displayed or compiled. MSG set-ups count:
    /// they are program content.
    pub fn same_logic(&self, other: &Instruction) -> bool {
        self.mnemonic == other.mnemonic && self.operands == other.operands && self.message == other.message
    }

    /// The value last displayed beside operand `index`.
    pub fn displayed(&self, index: usize) -> Option<&str> {
        self.displayed.get(index).and_then(|text| text.as_deref())
    }
}

/// The settings of a message instruction that no operand shows, as named texts in screen order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MessageSetup {
    /// Setting name (`Communication Command`, `Channel`, `Target Address`) and its text. Settings
    /// whose meaning is unknown are named by their place in the record.
    pub settings: Vec<(Cow<'static, str>, String)>,
}

impl Rung {
    /// A rung with this series and nothing else.
    pub fn new(series: Series) -> Rung {
        Rung { series, ..Rung::default() }
    }

    /// The instructions in stored order: left to right, legs top to bottom.
    pub fn instructions(&self) -> impl Iterator<Item = &Instruction> {
        Instructions { stack: vec![self.series.iter()], legs: Vec::new() }
    }

    /// The rung that only ends its program file.
    pub fn is_end(&self) -> bool {
        matches!(self.series.as_slice(), [Element::Instruction(only)] if only.mnemonic == "END")
    }

    /// Same elements in the same places, see [`Instruction::same_logic`].
    pub fn same_logic(&self, other: &Rung) -> bool {
        same_series(&self.series, &other.series)
    }
}

fn same_series(a: &[Element], b: &[Element]) -> bool {
    a.len() == b.len()
        && a.iter().zip(b).all(|pair| match pair {
            (Element::Instruction(a), Element::Instruction(b)) => a.same_logic(b),
            (Element::Branch(a), Element::Branch(b)) => {
                a.legs.len() == b.legs.len() && a.legs.iter().zip(&b.legs).all(|(a, b)| same_series(a, b))
            }
            _ => false,
        })
}

/// Depth-first walk without recursion, so that nesting costs no stack.
struct Instructions<'a> {
    stack: Vec<std::slice::Iter<'a, Element>>,
    legs: Vec<std::slice::Iter<'a, Series>>,
}

impl<'a> Iterator for Instructions<'a> {
    type Item = &'a Instruction;

    fn next(&mut self) -> Option<&'a Instruction> {
        loop {
            match self.stack.last_mut()?.next() {
                Some(Element::Instruction(instruction)) => return Some(instruction),
                Some(Element::Branch(branch)) => {
                    let mut legs = branch.legs.iter();
                    if let Some(first) = legs.next() {
                        self.stack.push(first.iter());
                        self.legs.push(legs);
                    }
                }
                None => {
                    self.stack.pop();
                    if let Some(legs) = self.legs.last_mut() {
                        match legs.next() {
                            Some(leg) => self.stack.push(leg.iter()),
                            // The branch is done: its series, below on the stack, goes on.
                            None => drop(self.legs.pop()),
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ins(name: &'static str) -> Element {
        Element::Instruction(Instruction::new(Mnemonic::named(name), Vec::new()))
    }

    #[test]
    fn instructions_come_in_stored_order() {
        let inner = Element::Branch(Branch { legs: vec![vec![ins("C")], vec![], vec![ins("D")]] });
        let outer = Element::Branch(Branch { legs: vec![vec![ins("B"), inner, ins("E")], vec![ins("F")]] });
        let rung = Rung::new(vec![ins("A"), outer, ins("G")]);
        let names: String = rung.instructions().map(|i| i.mnemonic.to_string()).collect();
        assert_eq!(names, "ABCDEFG");
        assert!(!rung.is_end());
        assert!(Rung::new(vec![ins("END")]).is_end());
    }
}
