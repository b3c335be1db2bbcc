//! A rung as series and branches, for drawing and for conversions that think in them.
//!
//! Text is a program for a stack of booleans; paper is contacts between rails. Nearly every rung is both.
//! Where one is not (a coil inside of a group that something is in parallel with, an inverted group behind
//! other contacts, ...) [`circuit`] says so: a drawing would show something else than what runs.

use std::fmt;

use crate::instruction::{self, Effect, Join};
use crate::program::Rung;
use crate::stack::effect;

/// Branches nest at most this deep.
pub const MAX_DEPTH: usize = 32;

/// A part of a circuit; power flows from left to right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Node {
    /// The instruction of that index: a contact, coil, box with one leg, or what inverts the flow.
    Instruction(usize),
    /// Parallel legs, top leg first. A leg that ends in a coil or box does not join the others.
    Branch(Vec<Vec<Node>>),
    /// A box with several legs, top leg first, each with its own way from the left rail.
    Box {
        /// Index of the instruction.
        index: usize,
        /// What leads to each leg.
        legs: Vec<Vec<Node>>,
    },
}

/// Why a rung is not series and branches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotDrawable {
    /// It does not balance, see [`crate::stack::check`].
    Unbalanced,
    /// A coil or box takes its power inside of a group that something is in parallel with.
    OutputInGroup,
    /// An inverted or one-shot group stands behind other contacts.
    FlowInGroup,
    /// A copy of the power flow is joined with contacts of its own.
    JoinedCopy,
    /// Something stands behind a box with several legs.
    BehindBox,
    /// Branches nest deeper than [`MAX_DEPTH`].
    Depth,
}

impl fmt::Display for NotDrawable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            NotDrawable::Unbalanced => "the rung does not balance on the stack of conditions",
            NotDrawable::OutputInGroup => "a coil or box takes its power inside of a group of contacts",
            NotDrawable::FlowInGroup => "an inverted group stands behind other contacts",
            NotDrawable::JoinedCopy => "a copy of the power flow is joined with other contacts",
            NotDrawable::BehindBox => "an instruction stands behind a box with several legs",
            NotDrawable::Depth => "branches nest too deep",
        })
    }
}

impl std::error::Error for NotDrawable {}

/// A value on the stack, as a way from the left rail (or, for a copy, from what was copied).
#[derive(Default)]
struct Value {
    items: Vec<Item>,
    /// Pushed by `DUPBOOL`: begins where the value below it was at that time.
    copy: bool,
    /// Holds what works on the whole way before it.
    flow: bool,
    /// Holds coils, boxes or legs with them.
    taps: bool,
    /// How deep branches in it nest.
    depth: usize,
}

enum Item {
    /// Power flows on behind it.
    Through(Node),
    /// A leg of its own, from here to the right rail.
    Leg(Vec<Node>),
}

impl Value {
    fn contact(index: usize) -> Value {
        Value { items: vec![Item::Through(Node::Instruction(index))], ..Value::default() }
    }

    /// The way without legs; `None` if there are any.
    fn nodes(self) -> Option<Vec<Node>> {
        let through = |item| match item {
            Item::Through(node) => Some(node),
            Item::Leg(_) => None,
        };
        self.items.into_iter().map(through).collect()
    }

    /// The way with legs as branches: what follows a leg is the last leg of its branch.
    fn circuit(self) -> Result<(Vec<Node>, usize), NotDrawable> {
        let mut depth = self.depth;
        let mut nodes: Vec<Node> = Vec::new();
        let mut legs: Vec<Vec<Node>> = Vec::new();
        // From the right: `nodes` is what follows, reversed.
        for item in self.items.into_iter().rev() {
            match item {
                Item::Leg(leg) => legs.push(leg),
                Item::Through(node) => {
                    depth += join_legs(&mut nodes, &mut legs);
                    if depth > MAX_DEPTH {
                        return Err(NotDrawable::Depth);
                    }
                    nodes.push(node);
                }
            }
        }
        depth += join_legs(&mut nodes, &mut legs);
        if depth > MAX_DEPTH {
            return Err(NotDrawable::Depth);
        }
        nodes.reverse();
        Ok((nodes, depth))
    }
}

/// Puts legs (reversed) before what follows them (reversed); returns how much deeper that nests.
fn join_legs(nodes: &mut Vec<Node>, legs: &mut Vec<Vec<Node>>) -> usize {
    let mut all: Vec<Vec<Node>> = legs.drain(..).rev().collect();
    if all.is_empty() {
        return 0;
    }
    let mut rest = std::mem::take(nodes);
    rest.reverse();
    if !rest.is_empty() {
        all.push(rest);
    }
    match all.len() {
        1 => {
            nodes.extend(all.into_iter().flatten().rev());
            0
        }
        _ => {
            nodes.push(Node::Branch(all));
            1
        }
    }
}

/// The rung as series and branches.
///
/// # Errors
/// Why a drawing of contacts between rails would not say what the rung does.
pub fn circuit(rung: &Rung) -> Result<Vec<Node>, NotDrawable> {
    let mut stack: Vec<Value> = Vec::new();
    let last = rung.instructions.len().saturating_sub(1);
    for (index, instruction) in rung.instructions.iter().enumerate() {
        let known = instruction::by_mnemonic(&instruction.mnemonic).is_some();
        match effect(instruction) {
            Effect::Contact { join: Join::Push, .. } => stack.push(Value::contact(index)),
            Effect::Contact { join: Join::And, .. } => {
                top(&mut stack)?.items.push(Item::Through(Node::Instruction(index)));
            }
            Effect::Contact { join: Join::Or, .. } => {
                let first = pop(&mut stack)?;
                stack.push(parallel(first, Value::contact(index))?);
            }
            Effect::Flow(_) => {
                let top = top(&mut stack)?;
                top.items.push(Item::Through(Node::Instruction(index)));
                top.flow = true;
            }
            Effect::Series => {
                let second = pop(&mut stack)?;
                let first = pop(&mut stack)?;
                stack.push(series(first, second)?);
            }
            Effect::Parallel => {
                let second = pop(&mut stack)?;
                let first = pop(&mut stack)?;
                stack.push(parallel(first, second)?);
            }
            Effect::Duplicate => {
                top(&mut stack)?;
                stack.push(Value { copy: true, ..Value::default() });
            }
            Effect::Drop => {
                let leg = pop(&mut stack)?;
                if !leg.copy {
                    return Err(NotDrawable::OutputInGroup);
                }
                let (leg, depth) = leg.circuit()?;
                let top = top(&mut stack)?;
                top.items.push(Item::Leg(leg));
                top.depth = top.depth.max(depth);
                top.taps = true;
            }
            // An unknown box at the end takes whatever there is.
            Effect::Output if !known && index == last && stack.len() > 1 => {
                return into_box(stack, index).map(|node| vec![node]);
            }
            Effect::Output => {
                if stack.is_empty() {
                    stack.push(Value::default());
                }
                let top = top(&mut stack)?;
                top.items.push(Item::Leg(vec![Node::Instruction(index)]));
                top.taps = true;
            }
            Effect::Box { legs } => {
                if index != last {
                    return Err(NotDrawable::BehindBox);
                }
                if stack.len() != legs.len() {
                    return Err(NotDrawable::Unbalanced);
                }
                return into_box(stack, index).map(|node| vec![node]);
            }
            Effect::Alone if last == 0 => return Ok(vec![Node::Instruction(index)]),
            Effect::Alone => return Err(NotDrawable::Unbalanced),
        }
    }
    match (stack.pop(), stack.is_empty()) {
        (Some(value), true) => value.circuit().map(|(nodes, _)| nodes),
        (None, _) if rung.instructions.is_empty() => Ok(Vec::new()),
        _ => Err(NotDrawable::Unbalanced),
    }
}

fn top(stack: &mut [Value]) -> Result<&mut Value, NotDrawable> {
    stack.last_mut().ok_or(NotDrawable::Unbalanced)
}

fn pop(stack: &mut Vec<Value>) -> Result<Value, NotDrawable> {
    stack.pop().ok_or(NotDrawable::Unbalanced)
}

fn series(mut first: Value, second: Value) -> Result<Value, NotDrawable> {
    if second.copy {
        return Err(NotDrawable::JoinedCopy);
    }
    if second.taps {
        return Err(NotDrawable::OutputInGroup);
    }
    if second.flow {
        return Err(NotDrawable::FlowInGroup);
    }
    first.depth = first.depth.max(second.depth);
    first.items.extend(second.items);
    Ok(first)
}

fn parallel(first: Value, second: Value) -> Result<Value, NotDrawable> {
    if first.copy || second.copy {
        return Err(NotDrawable::JoinedCopy);
    }
    if first.taps || second.taps {
        return Err(NotDrawable::OutputInGroup);
    }
    let flow = first.flow || second.flow;
    let mut depth = 0;
    let mut legs = Vec::new();
    for value in [first, second] {
        let inner = value.depth;
        let nodes = value.nodes().ok_or(NotDrawable::OutputInGroup)?;
        match <[Node; 1]>::try_from(nodes) {
            // A branch alone gives its legs to the new one.
            Ok([Node::Branch(own)]) => {
                depth = depth.max(inner);
                // Long chains of OR must not copy their legs again and again.
                if legs.is_empty() { legs = own } else { legs.extend(own) }
            }
            Ok([node]) => {
                depth = depth.max(inner + 1);
                legs.push(vec![node]);
            }
            Err(nodes) => {
                depth = depth.max(inner + 1);
                legs.push(nodes);
            }
        }
    }
    if depth > MAX_DEPTH {
        return Err(NotDrawable::Depth);
    }
    let items = vec![Item::Through(Node::Branch(legs))];
    Ok(Value { items, flow, depth, ..Value::default() })
}

fn into_box(stack: Vec<Value>, index: usize) -> Result<Node, NotDrawable> {
    let mut legs = Vec::with_capacity(stack.len());
    for value in stack {
        if value.copy {
            return Err(NotDrawable::JoinedCopy);
        }
        legs.push(value.nodes().ok_or(NotDrawable::OutputInGroup)?);
    }
    Ok(Node::Box { index, legs })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Instruction;

    /// `a b ; c` as mnemonics and operands, the circuit with operands, branches in brackets.
    fn drawn(text: &str) -> Result<String, NotDrawable> {
        let instructions = text.split(';').map(|line| {
            let mut words = line.split_whitespace();
            Instruction::new(words.next().expect("a mnemonic"), words)
        });
        let rung = Rung::new(instructions);
        circuit(&rung).map(|nodes| words(&rung, &nodes))
    }

    fn words(rung: &Rung, nodes: &[Node]) -> String {
        let legs = |legs: &[Vec<Node>]| legs.iter().map(|leg| words(rung, leg)).collect::<Vec<_>>().join(" | ");
        let one = |node: &Node| match node {
            Node::Instruction(index) => match rung.instructions[*index].operands.as_slice() {
                [] => rung.instructions[*index].mnemonic.clone(),
                operands => operands.join(","),
            },
            Node::Branch(all) => format!("[{}]", legs(all)),
            Node::Box { index, legs: all } => format!("<{}>{}", legs(all), rung.instructions[*index].mnemonic),
        };
        nodes.iter().map(one).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn stack_programs_become_series_and_branches() {
        for (text, expected) in [
            ("STR a;AND b;OUT c", "a b c"),
            ("STR a;OR b;OR c;ANDN d;OUT e;OUT f", "[a | b | c] d [e | f]"),
            ("STR a;AND b;OR c;OUT d", "[a b | c] d"),
            ("STR a;STR b;STRGE c 5;ORSTR;ANDSTR;MOVE d e;MATH f g", "a [b | c,5] [d,e | f,g]"),
            ("STR a;AND b;STR c;AND d;ORSTR;OUT e", "[a b | c d] e"),
            ("STR a;RST b;AND c;MOVE d e", "a [b | c d,e]"),
            ("STR a;MOVE x y;NOT;MOVE z y", "a [x,y | NOT z,y]"),
            ("STR a;DUPBOOL;ANDE D 0;OUT b;POPBOOL;ANDNE D 0;OUT c", "a [D,0 b | D,0 c]"),
            ("STR a;MOVE 0 D27;AND C7;STRN d;OR e;ANDSTR;OUT f", "a [0,D27 | C7 [d | e] f]"),
            ("STR a;OUT b;AND c;OUT d;AND e;OUT f", "a [b | c [d | e f]]"),
            ("STR a;STR b;OR c;CNT CT0 5", "<a | [b | c]>CNT"),
            ("STR a;STR b;STR c;UDC CT0 5 0", "<a | b | c>UDC"),
            ("STR a;STR b;WHATEVER x", "<a | b>WHATEVER"),
            ("STR a;NOT;OR b;OUT c", "[a NOT | b] c"),
            ("STR a;DUPBOOL;AND b;DUPBOOL;AND c;OUT d;POPBOOL;OUT e;POPBOOL;OUT f", "a [b [c d | e] | f]"),
            ("SG a", "a"),
            ("OUT a;OUT b", "[a | b]"),
        ] {
            assert_eq!(drawn(text).as_deref(), Ok(expected), "{text}");
        }
    }

    #[test]
    fn what_paper_cannot_show_is_said() {
        use NotDrawable as N;
        for (text, expected) in [
            ("STR a;STR b;OUT c", N::Unbalanced),
            ("STR a;ANDSTR;OUT c", N::Unbalanced),
            ("STR a;OUT b;OR c;OUT d", N::OutputInGroup),
            ("STR a;STR b;OUT c;POPBOOL;OUT d", N::OutputInGroup),
            ("STR a;STR b;NOT;ANDSTR;OUT c", N::FlowInGroup),
            ("STR a;DUPBOOL;OR b;OUT c;POPBOOL;OUT d", N::JoinedCopy),
            ("STR a;STR b;CNT CT0 5;OUT d", N::BehindBox),
            ("STR a;RET", N::Unbalanced),
        ] {
            assert_eq!(drawn(text), Err(expected), "{text}");
        }
    }

    #[test]
    fn depth_is_bounded() {
        let chain = |steps: usize| {
            let steps = (0..steps).map(|i| if i % 2 == 0 { "AND a" } else { "OR b" }).collect::<Vec<_>>().join(";");
            format!("STR a;{steps};OUT c")
        };
        assert!(drawn(&chain(20)).is_ok());
        assert_eq!(drawn(&chain(200_000)), Err(NotDrawable::Depth));
        let ors = format!("STR a;{}OUT c", "OR b;".repeat(100_000));
        assert!(drawn(&ors).is_ok());
        let outs = format!("STR a;{}", "OUT b;AND c;".repeat(100_000));
        assert_eq!(drawn(outs.trim_end_matches(';')), Err(NotDrawable::Depth));
    }
}
