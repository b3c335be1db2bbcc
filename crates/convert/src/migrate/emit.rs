//! Builds one Do-more rung: contacts and outputs on the stack of booleans.
//!
//! Between two instructions of the original the top of the stack is the power flow, and only that.
//! An instruction's conversion appends to the rung, leaves the power flow it hands on at the top, and
//! may use more of the stack in between ([`Emitter::when`]).
//!
//! A `STR` directly behind an output would begin a new rung. [`Emitter::finish`] never lets that happen:
//! it puts a contact that is always on between the two.

use domore::Instruction;
use domore::instruction::{Effect, Entry, Join as Joining, by_mnemonic};

/// A relation of two values, as contacts spell it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// `E`
    Equal,
    /// `NE`
    NotEqual,
    /// `GT`
    Greater,
    /// `GE`
    GreaterOrEqual,
    /// `LT`
    Less,
    /// `LE`
    LessOrEqual,
}

impl Relation {
    fn suffix(self) -> &'static str {
        match self {
            Relation::Equal => "E",
            Relation::NotEqual => "NE",
            Relation::Greater => "GT",
            Relation::GreaterOrEqual => "GE",
            Relation::Less => "LT",
            Relation::LessOrEqual => "LE",
        }
    }

    /// The sign in an expression.
    pub fn sign(self) -> &'static str {
        match self {
            Relation::Equal => "==",
            Relation::NotEqual => "!=",
            Relation::Greater => ">",
            Relation::GreaterOrEqual => ">=",
            Relation::Less => "<",
            Relation::LessOrEqual => "<=",
        }
    }
}

/// One contact: a test of one element or of two values, without effect.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Contact {
    /// The bit is ON.
    On(String),
    /// The bit is OFF.
    Off(String),
    /// Two plain operands compare so.
    Compare(Relation, String, String),
}

/// How a contact joins the stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Join {
    Push,
    And,
    Or,
}

impl Contact {
    fn instruction(&self, join: Join) -> Instruction {
        let word = match join {
            Join::Push => "STR",
            Join::And => "AND",
            Join::Or => "OR",
        };
        match self {
            Contact::On(bit) => Instruction::new(word, [bit.clone()]),
            Contact::Off(bit) => Instruction::new(format!("{word}N"), [bit.clone()]),
            Contact::Compare(relation, a, b) => {
                Instruction::new(format!("{word}{}", relation.suffix()), [a.clone(), b.clone()])
            }
        }
    }
}

/// The contact that is always ON.
pub const ALWAYS: &str = "ST1";
/// The contact that is ON in the first scan after entering RUN.
pub const FIRST_SCAN: &str = "ST0";

/// A coil or box; what is not known counts as one.
fn is_output(instruction: &Instruction) -> bool {
    by_mnemonic(&instruction.mnemonic).is_none_or(Entry::is_output)
}

/// A contact that pushes: the `STR` family.
fn is_push(instruction: &Instruction) -> bool {
    by_mnemonic(&instruction.mnemonic)
        .is_some_and(|entry| matches!(entry.effect, Effect::Contact { join: Joining::Push, .. }))
}

/// A rung being built.
#[derive(Clone, Debug, Default)]
pub struct Emitter {
    code: Vec<Instruction>,
    /// Entries on the stack.
    depth: usize,
}

impl Emitter {
    /// An empty rung: power flows until a contact says otherwise.
    pub fn new() -> Emitter {
        Emitter::default()
    }

    /// Nothing has been appended yet.
    pub fn is_empty(&self) -> bool {
        self.code.is_empty()
    }

    /// How many instructions the rung has.
    pub fn len(&self) -> usize {
        self.code.len()
    }

    /// The rung's instructions. An empty rung becomes one that does nothing.
    pub fn finish(mut self) -> Vec<Instruction> {
        // Behind the last output nothing has an effect, and a branch needs no way back to its trunk.
        while let Some(last) = self.code.last() {
            if is_output(last) {
                break;
            }
            if last.is("POPBOOL")
                && let Some(opening) = self.opening()
            {
                self.code.remove(opening);
            }
            self.code.pop();
        }
        if self.code.is_empty() {
            self.code.push(Instruction::new("NOP", [""; 0]));
        }
        self.separate();
        self.code
    }

    /// Puts a contact that is always ON between an output and a push behind it. Only the rung as a whole
    /// shows where that is needed: a branch whose `DUPBOOL` was dropped may begin with a push.
    fn separate(&mut self) {
        let code = std::mem::take(&mut self.code);
        for instruction in code {
            if is_push(&instruction) && self.code.last().is_some_and(is_output) {
                self.code.push(Instruction::new("AND", [ALWAYS]));
            }
            self.code.push(instruction);
        }
    }

    /// Where the `DUPBOOL` of the last `POPBOOL` stands.
    fn opening(&self) -> Option<usize> {
        let mut open = 0usize;
        self.code.iter().rposition(|instruction| {
            if instruction.is("POPBOOL") {
                open += 1;
            } else if instruction.is("DUPBOOL") {
                open = open.saturating_sub(1);
                return open == 0;
            }
            false
        })
    }

    /// The power flow is at the top of the stack afterwards, a plain rail included.
    fn rail(&mut self) {
        if self.depth == 0 {
            self.code.push(Instruction::new("STR", [ALWAYS]));
            self.depth = 1;
        }
    }

    fn push(&mut self, instruction: Instruction) {
        self.code.push(instruction);
    }

    /// Power flows on only where the contact passes it.
    pub fn contact(&mut self, contact: &Contact) {
        if self.depth == 0 {
            self.push(contact.instruction(Join::Push));
            self.depth = 1;
        } else {
            self.push(contact.instruction(Join::And));
        }
    }

    /// Power flows on only while the bit is ON.
    pub fn and(&mut self, bit: &str) {
        self.contact(&Contact::On(bit.to_owned()));
    }

    /// Power flows on only while the bit is OFF.
    pub fn and_not(&mut self, bit: &str) {
        self.contact(&Contact::Off(bit.to_owned()));
    }

    /// Power flows on only while two plain operands compare so.
    pub fn and_compare(&mut self, relation: Relation, a: &str, b: &str) {
        self.contact(&Contact::Compare(relation, a.to_owned(), b.to_owned()));
    }

    /// Power flows on also while the contact passes: `(what was) OR contact`.
    pub fn or(&mut self, contact: &Contact) {
        self.rail();
        self.push(contact.instruction(Join::Or));
    }

    /// Power flows on, whatever was before.
    pub fn or_always(&mut self) {
        self.or(&Contact::On(ALWAYS.to_owned()));
    }

    /// Pushes a contact of its own: the beginning of a parallel group. Join it with
    /// [`Emitter::join_or`] or [`Emitter::join_and`].
    pub fn store(&mut self, contact: &Contact) {
        self.push(contact.instruction(Join::Push));
        self.depth += 1;
    }

    /// The two top values become one, in parallel.
    pub fn join_or(&mut self) {
        self.push(Instruction::new("ORSTR", [""; 0]));
        self.depth = self.depth.saturating_sub(1).max(1);
    }

    /// The two top values become one, in series.
    pub fn join_and(&mut self) {
        self.push(Instruction::new("ANDSTR", [""; 0]));
        self.depth = self.depth.saturating_sub(1).max(1);
    }

    /// Entries on the stack: 0 before anything was appended.
    pub fn depth(&self) -> usize {
        self.depth
    }

    /// Inverts the power flow.
    pub fn invert(&mut self) {
        self.rail();
        self.push(Instruction::new("NOT", [""; 0]));
    }

    /// Appends a branch: what `body` appends works on a copy of the power flow, which is as before
    /// afterwards.
    pub fn when<T>(&mut self, body: impl FnOnce(&mut Emitter) -> T) -> T {
        self.duplicate();
        let result = body(self);
        self.pop();
        result
    }

    /// As [`Emitter::when`], with power whatever the power flow is.
    pub fn always<T>(&mut self, body: impl FnOnce(&mut Emitter) -> T) -> T {
        let rail = self.depth == 0;
        self.when(|e| {
            if !rail {
                e.or_always();
            }
            body(e)
        })
    }

    /// As [`Emitter::when`], on the inverted power flow.
    pub fn unless<T>(&mut self, body: impl FnOnce(&mut Emitter) -> T) -> T {
        self.when(|e| {
            e.invert();
            body(e)
        })
    }

    /// Pushes a copy of the power flow.
    pub fn duplicate(&mut self) {
        self.rail();
        self.push(Instruction::new("DUPBOOL", [""; 0]));
        self.depth += 1;
    }

    /// Drops the top of the stack, back to what was duplicated. Outputs alone need no copy of the power
    /// flow: they stand one after another.
    pub fn pop(&mut self) {
        let opening = self.code.iter().rposition(|instruction| !is_output(instruction));
        match opening.filter(|at| self.code.get(*at).is_some_and(|opening| opening.is("DUPBOOL"))) {
            Some(at) => drop(self.code.remove(at)),
            None => self.push(Instruction::new("POPBOOL", [""; 0])),
        }
        self.depth = self.depth.saturating_sub(1).max(1);
    }

    /// Appends an output: a coil or a box with one leg.
    pub fn output<O: Into<String>>(&mut self, mnemonic: &str, operands: impl IntoIterator<Item = O>) {
        self.rail();
        self.push(Instruction::new(mnemonic, operands));
    }

    /// `OUT`: the bit follows the power flow. Goes OFF when the program stops.
    pub fn out(&mut self, bit: &str) {
        self.output("OUT", [bit]);
    }

    /// `SET`
    pub fn set(&mut self, bit: &str) {
        self.output("SET", [bit]);
    }

    /// `RST`
    pub fn reset(&mut self, bit: &str) {
        self.output("RST", [bit]);
    }

    /// The bit follows the power flow and keeps its state when the program stops: `SET`, `NOT`,
    /// `RST`, `NOT`.
    pub fn hold(&mut self, bit: &str) {
        self.set(bit);
        self.invert();
        self.reset(bit);
        self.invert();
    }

    /// `MATH`: with power, the destination gets the value of the expression.
    pub fn math(&mut self, destination: &str, expression: &str) {
        self.output("MATH", [destination.to_owned(), domore::address::quote(expression)]);
    }

    /// `MOVE`: with power, the destination gets a plain value of its own type.
    pub fn mov(&mut self, source: &str, destination: &str) {
        self.output("MOVE", [source, destination]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(e: Emitter) -> String {
        e.finish().iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
    }

    #[test]
    fn rails_and_branches() {
        let mut e = Emitter::new();
        e.out("C0");
        assert_eq!(text(e), "STR ST1; OUT C0");
        let mut e = Emitter::new();
        e.and("X0");
        e.when(|e| {
            e.and_not("C1");
            e.out("Y0");
        });
        e.when(|e| e.out("Y1"));
        assert_eq!(text(e), "STR X0; DUPBOOL; ANDN C1; OUT Y0; POPBOOL; OUT Y1");
        let mut e = Emitter::new();
        e.and("X0");
        e.hold("C2");
        assert_eq!(text(e), "STR X0; SET C2; NOT; RST C2");
        assert_eq!(text(Emitter::new()), "NOP");
    }

    #[test]
    fn a_group_behind_an_output_is_kept_in_the_rung() {
        let mut e = Emitter::new();
        e.out("Y0");
        e.store(&Contact::On("X1".into()));
        e.or(&Contact::On("X2".into()));
        e.join_and();
        e.out("Y1");
        assert_eq!(text(e), "STR ST1; OUT Y0; AND ST1; STR X1; OR X2; ANDSTR; OUT Y1");
    }
    #[test]
    fn a_last_branch_that_begins_with_a_group_is_kept_in_the_rung() {
        let mut e = Emitter::new();
        e.and("X0");
        e.when(|e| e.out("Y0"));
        e.when(|e| {
            e.store(&Contact::Compare(Relation::Equal, "N1".into(), "2".into()));
            e.or(&Contact::On("X2".into()));
            e.join_and();
            e.out("Y1");
        });
        assert_eq!(text(e), "STR X0; OUT Y0; AND ST1; STRE N1 2; OR X2; ANDSTR; OUT Y1");
    }
}
