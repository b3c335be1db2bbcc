//! One pass over operations: contacts, coils, the stack of booleans, program flow.

use super::Fault;
use super::op::*;
use super::state::{BlockState, EdgeMemory, FRESH, State};
use super::watch::Watch;
use crate::choices::Choice;
use crate::instruction::Join;
use crate::math::compare;
use crate::memory::{Num, Place, STAGES};

/// Subroutines inside subroutines.
const MOST_CALLS: usize = 16;

/// A program with its state, for the length of a call.
pub(crate) struct Core<'a> {
    pub(crate) p: &'a Compiled,
    pub(crate) s: &'a mut State,
}

/// How a block ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ended {
    Done,
    /// EXIT.
    Exit,
    /// The machine has stopped.
    Fault,
}

#[derive(Clone, Copy, Default)]
struct Loop {
    value: i64,
    to: i64,
    step: i64,
}

fn joined(stack: u64, join: Join, on: bool) -> u64 {
    match join {
        Join::Push => stack << 1 | u64::from(on),
        Join::And => stack & (u64::from(on) | !1),
        Join::Or => stack | u64::from(on),
    }
}

impl Core<'_> {
    /// The number of a source; 0 with a trouble counted where an index leads nowhere.
    #[inline]
    pub(crate) fn number(&mut self, source: Source) -> Num {
        match source {
            Source::Constant(value) => value,
            Source::Place(place) => self.s.data.number(place),
            Source::Indexed(index) => match self.indexed(index) {
                Some(place) => self.s.data.number(place),
                None => Num::Int(0),
            },
        }
    }

    pub(crate) fn indexed(&mut self, index: u32) -> Option<Place> {
        let place = self.p.indexed.get(index as usize)?.place(&self.s.data, self.p.choices);
        if place.is_err() {
            self.s.troubles += 1;
        }
        place.ok()
    }

    #[inline]
    pub(crate) fn store(&mut self, target: Target, value: Num) {
        let place = match target {
            Target::Place(place) => Some(place),
            Target::Indexed(index) => self.indexed(index),
        };
        if let Some(place) = place {
            self.s.data.store(place, value, self.p.choices);
        }
    }

    /// What an edge memory says about a bit that is `on` now.
    #[inline]
    pub(crate) fn edge(&mut self, memory: u32, on: bool, rise: bool) -> bool {
        let Some(memory) = self.s.edges.get_mut(memory as usize) else { return false };
        let was: EdgeMemory = std::mem::replace(memory, 1 + u8::from(on));
        match was {
            // Never processed: an edge only in the reading that starts from OFF.
            FRESH => rise && on && self.p.choices.has(Choice::FirstScanEdge),
            1 => rise && on,
            _ => !rise && !on,
        }
    }

    /// Executes operations from `start` up to `end`.
    pub(crate) fn execute<W: Watch>(&mut self, start: u32, end: u32, depth: usize, watch: &mut W) -> Ended {
        let p = self.p;
        let (mut pc, mut stack, mut count) = (start, 0u64, 0u64);
        let mut loops = [Loop::default(); super::compile::MOST_LOOPS];
        let ended = loop {
            if pc >= end {
                break Ended::Done;
            }
            let Some(op) = p.ops.get(pc as usize) else { break Ended::Done };
            let at = pc;
            pc += 1;
            count += 1;
            match *op {
                Op::Rung => {
                    count -= 1;
                    stack = 0;
                    watch.rung(at);
                    continue;
                }
                Op::Push(bit) => {
                    let on = self.s.data.bit(bit);
                    watch.contact(at, on);
                    stack = stack << 1 | u64::from(on);
                }
                Op::PushNot(bit) => {
                    let on = !self.s.data.bit(bit);
                    watch.contact(at, on);
                    stack = stack << 1 | u64::from(on);
                }
                Op::And(bit) => {
                    let on = self.s.data.bit(bit);
                    watch.contact(at, on);
                    stack &= u64::from(on) | !1;
                }
                Op::AndNot(bit) => {
                    let on = !self.s.data.bit(bit);
                    watch.contact(at, on);
                    stack &= u64::from(on) | !1;
                }
                Op::Or(bit) => {
                    let on = self.s.data.bit(bit);
                    watch.contact(at, on);
                    stack |= u64::from(on);
                }
                Op::OrNot(bit) => {
                    let on = !self.s.data.bit(bit);
                    watch.contact(at, on);
                    stack |= u64::from(on);
                }
                Op::Power => {
                    count -= 1;
                    stack = stack << 1 | 1;
                    continue;
                }
                Op::Compare { join, compare: index } => {
                    let Some(code) = p.compares.get(index as usize).copied() else { continue };
                    let (a, b) = (self.number(code.a), self.number(code.b));
                    let on = compare(code.relation, a, b);
                    watch.compare(at, a, b, on);
                    stack = joined(stack, join, on);
                }
                Op::Indexed { join, negated, place } => {
                    let on = self.indexed(place).is_some_and(|place| self.s.data.number(place).is_on()) != negated;
                    watch.contact(at, on);
                    stack = joined(stack, join, on);
                }
                Op::Edge { join, rise, bit, memory } => {
                    let on = self.s.data.bit(bit);
                    let on = self.edge(memory, on, rise);
                    watch.contact(at, on);
                    stack = joined(stack, join, on);
                }
                Op::Change { join, source, memory } => {
                    let value = p.sources.get(source as usize).copied().map(|source| self.number(source));
                    let was =
                        self.s.values.get_mut(memory as usize).and_then(|memory| std::mem::replace(memory, value));
                    let on = was.is_some() && was != value;
                    watch.contact(at, on);
                    stack = joined(stack, join, on);
                }
                Op::Series => {
                    let top = stack & 1;
                    stack = stack >> 1 & (top | !1);
                }
                Op::Parallel => {
                    let top = stack & 1;
                    stack = stack >> 1 | top;
                }
                Op::Invert => stack ^= 1,
                Op::FlowEdge { rise, memory } => {
                    let on = self.edge(memory, stack & 1 != 0, rise);
                    watch.contact(at, on);
                    stack = stack & !1 | u64::from(on);
                }
                Op::Duplicate => stack = stack << 1 | stack & 1,
                Op::Drop => stack >>= 1,
                Op::Out(bit) => {
                    let on = stack & 1 != 0;
                    watch.power(at, on);
                    self.s.data.set_bit(bit, on);
                }
                Op::Set(bit) => {
                    let on = stack & 1 != 0;
                    watch.power(at, on);
                    if on {
                        self.s.data.set_bit(bit, true);
                    }
                }
                Op::Reset(bit) => {
                    let on = stack & 1 != 0;
                    watch.power(at, on);
                    if on {
                        self.s.data.set_bit(bit, false);
                    }
                }
                Op::Timer(index) => {
                    watch.power(at, stack & 1 != 0);
                    stack = self.timer(index, stack);
                }
                Op::Counter(index) => {
                    watch.power(at, stack & 1 != 0);
                    stack = self.counter(index, stack);
                }
                Op::Move(index) => {
                    let on = stack & 1 != 0;
                    watch.power(at, on);
                    if on && let Some((from, to)) = p.moves.get(index as usize).copied() {
                        let value = self.number(from);
                        self.store(to, value);
                    }
                }
                Op::Math(index) => {
                    let on = stack & 1 != 0;
                    watch.power(at, on);
                    if on && let Some((formula, target)) = p.maths.get(index as usize) {
                        match formula.value(&self.s.data, p.choices) {
                            Ok(value) => self.store(*target, value),
                            Err(_) => self.s.troubles += 1,
                        }
                    }
                }
                Op::Stage(index) => {
                    let Some(stage) = p.stages.get(index as usize).copied() else { continue };
                    let on = self.s.data.bit(stage.bit);
                    watch.contact(at, on);
                    let ran = self.s.stages.get_mut(index as usize).is_some_and(|ran| std::mem::replace(ran, on));
                    if !on {
                        if ran {
                            self.terminate(stage.start, stage.end);
                        }
                        pc = stage.end;
                    }
                }
                Op::For(index) => {
                    let Some(code) = p.loops.get(index as usize).copied() else { continue };
                    let choices = p.choices;
                    let from = self.number(code.from).integer(choices);
                    let to = self.number(code.to).integer(choices);
                    let step = self.number(code.step).integer(choices);
                    self.store(code.variable, Num::Int(from));
                    if let Some(running) = loops.get_mut(code.level) {
                        *running = Loop { value: from, to, step };
                    }
                    if !runs(from, to, step) {
                        pc = code.next + 1;
                    }
                }
                Op::Next(index) => {
                    let Some(code) = p.loops.get(index as usize).copied() else { continue };
                    let Some(running) = loops.get_mut(code.level) else { continue };
                    running.value = running.value.saturating_add(running.step);
                    let Loop { value, to, step } = *running;
                    self.store(code.variable, Num::Int(value));
                    if runs(value, to, step) {
                        pc = code.body;
                    }
                    if self.s.executed + count > self.s.limit {
                        break self.stop(Fault::Watchdog);
                    }
                }
                Op::Until { place, start } => {
                    let source = p.sources.get(place as usize).copied().unwrap_or(Source::Constant(Num::Int(1)));
                    let on = self.number(source).is_on();
                    watch.contact(at, on);
                    if !on {
                        pc = start;
                    }
                    if self.s.executed + count > self.s.limit {
                        break self.stop(Fault::Watchdog);
                    }
                }
                Op::Call(index) => {
                    let on = stack & 1 != 0;
                    watch.power(at, on);
                    if !on {
                        continue;
                    }
                    self.s.executed += std::mem::take(&mut count);
                    if depth >= MOST_CALLS {
                        break self.stop(Fault::CallDepth);
                    }
                    if self.s.executed > self.s.limit {
                        break self.stop(Fault::Watchdog);
                    }
                    if let Some(call) = p.calls.get(index as usize) {
                        self.copy_rows(&call.inputs);
                        if let Some(block) = p.blocks.get(call.block as usize)
                            && self.execute(block.start, block.end, depth + 1, watch) == Ended::Fault
                        {
                            break Ended::Fault;
                        }
                        self.copy_rows(&call.outputs);
                    }
                }
                Op::Return => break Ended::Done,
                Op::ReturnIf => {
                    watch.power(at, stack & 1 != 0);
                    if stack & 1 != 0 {
                        break Ended::Done;
                    }
                }
                Op::Exit => {
                    watch.power(at, stack & 1 != 0);
                    if stack & 1 != 0 {
                        break Ended::Exit;
                    }
                }
                Op::Unsupported => {
                    watch.power(at, stack & 1 != 0);
                    if stack & 1 != 0 {
                        break self.stop(Fault::Unsupported { operation: at });
                    }
                }
                Op::Nothing => {}
                Op::OrOut { .. }
                | Op::ResetRange { .. }
                | Op::Pulse { .. }
                | Op::ResetTimer(_)
                | Op::ResetCounter(_)
                | Op::Step { .. }
                | Op::Box(_)
                | Op::Control(..)
                | Op::Jump { .. }
                | Op::StageBits { .. } => {
                    let on = stack & 1 != 0;
                    watch.power(at, on);
                    self.rare(*op, on);
                }
            }
        };
        self.s.executed += count;
        ended
    }

    /// Coils and boxes that are executed less often.
    fn rare(&mut self, op: Op, on: bool) {
        match op {
            Op::OrOut { bit, memory } => {
                let scan = self.s.scans + 1;
                let Some(last) = self.s.or_outs.get_mut(memory as usize) else { return };
                // The first OROUT of a scan writes the bit, the others add to it.
                if std::mem::replace(last, scan) != scan || on {
                    self.s.data.set_bit(bit, on);
                }
            }
            Op::ResetRange { first, last } if on => (first..=last).for_each(|bit| self.s.data.set_bit(bit, false)),
            Op::Pulse { rise, bit, memory } => {
                let pulse = self.edge(memory, on, rise);
                self.s.data.set_bit(bit, pulse);
            }
            Op::ResetTimer(index) if on => self.reset_timer(index),
            Op::ResetCounter(index) if on => self.reset_counter(index),
            Op::Step { add, target } if on => {
                let Some(target) = self.p.targets.get(target as usize).copied() else { return };
                let source = match target {
                    Target::Place(place) => Source::Place(place),
                    Target::Indexed(index) => Source::Indexed(index),
                };
                let value = match self.number(source) {
                    Num::Int(value) => Num::Int(value + i64::from(add)),
                    Num::Real(value) => Num::Real(value + f64::from(add)),
                };
                self.store(target, value);
            }
            Op::Box(index) => self.process_box(index, on),
            Op::Control(action, block) if on => {
                let Some(state) = self.s.blocks.get_mut(block as usize) else { return };
                match action {
                    Action::Run => (state.enabled, state.suspended) = (true, false),
                    Action::Halt => (state.enabled, state.suspended) = (false, false),
                    Action::Restart => (state.enabled, state.suspended, state.restart) = (true, false, state.ran),
                    Action::Suspend => state.suspended = true,
                }
            }
            Op::Jump { stage, own } if on => {
                if let Some(own) = own {
                    self.s.data.set_bit(own, false);
                }
                self.s.data.set_bit(stage, true);
            }
            Op::StageBits { first, last, on: level } if on => {
                (first..=last).for_each(|bit| self.s.data.set_bit(bit, level));
            }
            _ => {}
        }
    }

    pub(crate) fn stop(&mut self, fault: Fault) -> Ended {
        self.s.fault = Some(fault);
        Ended::Fault
    }

    /// Runs a program, or shuts it down if it was stopped.
    pub(crate) fn program<W: Watch>(&mut self, index: usize, watch: &mut W) -> Ended {
        let p = self.p;
        let (Some(block), Some(state)) = (p.blocks.get(index), self.s.blocks.get(index).copied()) else {
            return Ended::Done;
        };
        if state.ran && (!state.enabled || state.restart) {
            self.terminate_block(index);
            return Ended::Done;
        }
        if !state.enabled || state.suspended {
            return Ended::Done;
        }
        if !state.ran {
            if let Some(stage) = block.first_stage {
                self.s.data.set_bit(stage, true);
            }
            if let Some(state) = self.s.blocks.get_mut(index) {
                (state.ran, state.restart) = (true, false);
            }
        }
        let ended = self.execute(block.start, block.end, 0, watch);
        if ended == Ended::Exit
            && let Some(state) = self.s.blocks.get_mut(index)
        {
            state.enabled = false;
        }
        ended
    }

    /// The termination scan of a whole program or task.
    pub(crate) fn terminate_block(&mut self, index: usize) {
        let p = self.p;
        let Some(block) = p.blocks.get(index) else { return };
        self.terminate(block.start, block.end);
        for bit in block.stages..block.stages + if block.first_stage.is_some() { STAGES } else { 0 } {
            self.s.data.set_bit(bit, false);
        }
        for (stage, ran) in p.stages.iter().zip(&mut self.s.stages) {
            if (block.start..block.end).contains(&stage.start) {
                *ran = false;
            }
        }
        if let Some(state) = self.s.blocks.get_mut(index) {
            *state = BlockState { enabled: state.enabled, last: state.last, ..BlockState::default() };
        }
    }

    /// Shuts operations down: coils OFF, timers and counters reset, edges forgotten.
    pub(crate) fn terminate(&mut self, start: u32, end: u32) {
        let p = self.p;
        for op in p.ops.get(start as usize..end as usize).unwrap_or_default() {
            match *op {
                Op::Out(bit) | Op::OrOut { bit, .. } => self.s.data.set_bit(bit, false),
                Op::Pulse { bit, memory, .. } => {
                    self.s.data.set_bit(bit, false);
                    self.forget(memory);
                }
                Op::Edge { memory, .. } | Op::FlowEdge { memory, .. } => self.forget(memory),
                Op::Change { memory, .. } => {
                    if let Some(memory) = self.s.values.get_mut(memory as usize) {
                        *memory = None;
                    }
                }
                Op::Timer(index) => self.terminate_timer(index),
                Op::Counter(index) => self.terminate_counter(index),
                Op::Box(index) => self.terminate_box(index),
                _ => {}
            }
        }
    }

    pub(crate) fn forget(&mut self, memory: u32) {
        if let Some(memory) = self.s.edges.get_mut(memory as usize) {
            *memory = FRESH;
        }
    }
}

/// Whether a loop goes on with this value.
fn runs(value: i64, to: i64, step: i64) -> bool {
    match step.signum() {
        1 => value <= to,
        -1 => value >= to,
        _ => false,
    }
}
