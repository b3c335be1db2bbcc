//! The stack of booleans that a rung works on: where rungs end, whether they balance.

use std::collections::HashSet;

use crate::diagnostic::{Diagnostic, Problem};
use crate::instruction::{self, Effect, Join};
use crate::program::{CodeBlock, Instruction, Project, Rung};

/// What an instruction does to the stack. One that is not known counts as a coil or box with one leg,
/// which is what nearly all instructions are.
pub fn effect(instruction: &Instruction) -> Effect {
    instruction::by_mnemonic(&instruction.mnemonic).map_or(Effect::Output, |entry| entry.effect)
}

/// A change of the depth of the stack.
struct Change {
    /// Values that must be there.
    needs: usize,
    /// Values that come instead of `takes`.
    takes: usize,
    gives: usize,
}

fn change(effect: Effect) -> Change {
    let (needs, takes, gives) = match effect {
        Effect::Contact { join: Join::Push, .. } => (0, 0, 1),
        Effect::Contact { .. } | Effect::Flow(_) => (1, 0, 0),
        Effect::Series | Effect::Parallel => (2, 1, 0),
        Effect::Duplicate => (1, 0, 1),
        Effect::Drop => (1, 1, 0),
        Effect::Output => (1, 0, 0),
        // What a box with several legs leaves is not known; one value, for whatever follows.
        Effect::Box { legs } => (legs.len(), legs.len().saturating_sub(1), 0),
        Effect::Alone => (0, 0, 0),
    };
    Change { needs, takes, gives }
}

fn is_push(effect: Effect) -> bool {
    matches!(effect, Effect::Contact { join: Join::Push, .. })
}

fn is_output(effect: Effect) -> bool {
    matches!(effect, Effect::Output | Effect::Box { .. })
}

/// Whether a new rung begins between two instructions that no blank line separates.
///
/// Text has no sign for it. In everything Designer wrote, no STR stands directly behind a coil or box of
/// its own rung; so one that does begins a rung, unless the stack still holds more than one value or
/// what follows could not be a rung of its own.
fn is_boundary(before: Effect, depth: usize, rest: &[Instruction]) -> bool {
    let Some(next) = rest.first().map(effect) else { return false };
    match (before, next) {
        (Effect::Alone, _) => true,
        (before, Effect::Alone) => is_output(before),
        (before, next) => is_output(before) && is_push(next) && depth <= 1 && !underflows(rest),
    }
}

/// Whether instructions, up to the next place where a rung may begin, take more than they push.
fn underflows(rest: &[Instruction]) -> bool {
    let mut depth = 0_usize;
    let mut before = Effect::Alone;
    for (index, instruction) in rest.iter().enumerate() {
        let effect = effect(instruction);
        if index > 0 && is_output(before) && depth <= 1 && (is_push(effect) || effect == Effect::Alone) {
            return false;
        }
        let change = change(effect);
        if depth < change.needs {
            return true;
        }
        depth = (depth - change.takes).saturating_add(change.gives);
        before = effect;
    }
    false
}

/// Whether `next` behind `previous`, with no blank line between, reads as a rung of its own.
pub(crate) fn begins_rung(previous: &[Instruction], next: &[Instruction]) -> bool {
    let Some(last) = previous.last() else { return true };
    let depth = previous.iter().fold(0_usize, |depth, instruction| {
        let change = change(effect(instruction));
        depth.saturating_sub(change.takes).saturating_add(change.gives)
    });
    is_boundary(effect(last), depth, next)
}

/// Cuts instructions that stand together into rungs; the comment goes with the first.
pub(crate) fn split_rungs(rung: Rung) -> Vec<Rung> {
    let mut starts = Vec::new();
    let mut depth = 0_usize;
    let mut before = None;
    for (index, instruction) in rung.instructions.iter().enumerate() {
        let rest = rung.instructions.get(index..).unwrap_or_default();
        if before.is_some_and(|before| is_boundary(before, depth, rest)) {
            starts.push(index);
            depth = 0;
        }
        let effect = effect(instruction);
        let change = change(effect);
        depth = depth.saturating_sub(change.takes).saturating_add(change.gives);
        before = Some(effect);
    }
    if starts.is_empty() {
        return vec![rung];
    }
    let mut rungs = Vec::with_capacity(starts.len() + 1);
    let mut rung = rung;
    for start in starts.into_iter().rev() {
        rungs.push(Rung { comment: None, instructions: rung.instructions.split_off(start) });
    }
    rungs.push(rung);
    rungs.reverse();
    rungs
}

/// What is wrong with a rung, with the index of the instruction. `behind_stage`: the rung before it
/// begins a stage, which then is its condition.
///
/// A rung without findings balances: every value that is taken was pushed, and one is left.
pub fn check(rung: &Rung, behind_stage: bool) -> Vec<(usize, Problem)> {
    let mut found = Vec::new();
    let mut depth = 0_usize;
    let mut boxed = false;
    let mut executes = false;
    let mut underflow = false;
    let mut last_unknown = false;
    let count = rung.instructions.len();
    for (index, instruction) in rung.instructions.iter().enumerate() {
        let entry = instruction::by_mnemonic(&instruction.mnemonic);
        let effect = effect(instruction);
        let name = || instruction.mnemonic.clone();
        if let Some(entry) = entry {
            let expected = (entry.required, entry.operands.len());
            let given = instruction.operands.len();
            if given < expected.0 || given > expected.1 {
                found.push((index, Problem::OperandCount { mnemonic: name(), expected, found: given }));
            }
        }
        if boxed {
            found.push((index, Problem::BehindBox(name())));
            // Once is enough; what is counted behind it means nothing.
            return found;
        }
        last_unknown = entry.is_none();
        match effect {
            Effect::Alone if count > 1 => found.push((index, Problem::NotAlone(name()))),
            Effect::Output if depth == 0 && (behind_stage || !underflow) => {
                executes = true;
                if !behind_stage {
                    found.push((index, Problem::NoContact(name())));
                }
                continue;
            }
            _ => {}
        }
        let change = change(effect);
        if depth < change.needs {
            if !underflow {
                let needs = change.needs;
                found.push((index, Problem::StackUnderflow { mnemonic: name(), needs, found: depth }));
            }
            underflow = true;
        }
        depth = depth.saturating_sub(change.takes).saturating_add(change.gives);
        boxed = matches!(effect, Effect::Box { .. });
        executes |= is_output(effect) || effect == Effect::Alone;
    }
    let last = count.saturating_sub(1);
    // An unknown box may have as many legs as there are values.
    if depth > 1 && !underflow && !last_unknown {
        found.push((last, Problem::StackLeft(depth - 1)));
    }
    if !executes && count > 0 {
        found.push((last, Problem::NoOutput));
    }
    found
}

/// What is wrong with the rungs of a project.
pub fn check_project(project: &Project) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    // One report for each instruction that is not known: a project has them by the dozen.
    let mut unknown = HashSet::new();
    for block in project.code_blocks() {
        check_block(block, &mut unknown, &mut found);
    }
    found
}

fn check_block(block: &CodeBlock, unknown: &mut HashSet<String>, found: &mut Vec<Diagnostic>) {
    let mut behind_stage = false;
    for (index, rung) in block.rungs.iter().enumerate() {
        let mut report = |at: usize, problem: Problem| {
            let line = rung.instructions.get(at).and_then(|instruction| instruction.origin.line()).unwrap_or(0);
            found.push(Diagnostic { line, column: 1, rung: Some((block.name.clone(), index + 1)), problem });
        };
        for (at, problem) in check(rung, behind_stage) {
            report(at, problem);
        }
        for (at, instruction) in rung.instructions.iter().enumerate() {
            let name = &instruction.mnemonic;
            if instruction::by_mnemonic(name).is_none() && unknown.insert(name.clone()) {
                report(at, Problem::UnknownInstruction(name.clone()));
            }
        }
        if !rung.instructions.is_empty() {
            behind_stage = rung.stage().is_some();
        }
    }
}
