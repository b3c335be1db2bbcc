//! Saved states: a stable byte form of [`State`].
//!
//! `RUNGSIM3`, the identity of the program, then every field in a fixed order, numbers little-endian.

use crate::shared::Reader;
pub use crate::shared::RestoreError;

use instr::exec::process::Loop;

use crate::core::discrete::DiscreteInput;
use crate::core::fast::FastCounter;
use crate::fault::MajorFault;
use crate::machine::Mode;
use crate::op::Compiled;
use crate::state::{MessageSlot, PidSlot, State, TimedInterrupt, TimerSlot};

const MAGIC: &[u8; 8] = b"RUNGSIM3";

const MODES: [Mode; 5] = [Mode::Program, Mode::Run, Mode::Test, Mode::Suspend, Mode::Fault];

pub(crate) fn save(program: &Compiled, state: &State) -> Vec<u8> {
    let mut out = Vec::with_capacity(64 + 2 * state.mem.len() + 24 * state.timers.len());
    out.extend_from_slice(MAGIC);
    let long = |out: &mut Vec<u8>, value: u64| out.extend_from_slice(&value.to_le_bytes());
    long(&mut out, program.identity);
    for word in state.mem.iter().chain(&state.inputs).chain(&state.outputs) {
        out.extend_from_slice(&word.to_le_bytes());
    }
    for (on, off) in state.input_forces.iter().chain(&state.output_forces) {
        out.extend_from_slice(&on.to_le_bytes());
        out.extend_from_slice(&off.to_le_bytes());
    }
    for timer in &state.timers {
        long(&mut out, timer.last);
        long(&mut out, timer.part);
        out.push(timer.fresh.into());
    }
    for pid in &state.pids {
        long(&mut out, pid.last);
        let memory = pid.memory;
        out.push(memory.running.into());
        long(&mut out, memory.waited);
        long(&mut out, memory.last.to_bits());
        long(&mut out, memory.rate.to_bits());
        out.extend_from_slice(&memory.setpoint.to_le_bytes());
        out.extend_from_slice(&memory.last_error.to_le_bytes());
        out.push(memory.crossed.into());
    }
    for message in &state.messages {
        long(&mut out, message.started);
        out.push(message.active.into());
    }
    out.extend(state.adjusts.iter().map(|edge| u8::from(*edge)));
    for value in [
        state.now,
        state.scans,
        state.executed,
        state.limit,
        state.clock_part,
        state.second_part,
        state.since_scan,
        state.strays,
        state.timed.next,
        state.timed.period,
    ] {
        long(&mut out, value);
    }
    let timed = state.timed;
    out.extend_from_slice(&[timed.enabled.into(), timed.fine.into(), timed.executing.into()]);
    out.push(state.due.into());
    out.extend_from_slice(&state.events);
    out.extend_from_slice(&state.event_inputs.to_le_bytes());
    out.push(state.discrete.matched.into());
    out.extend_from_slice(&state.discrete.last.to_le_bytes());
    for counter in state.fast {
        out.extend_from_slice(&[counter.loaded.into(), counter.set.into()]);
        for value in [counter.high, counter.low, counter.overflow, counter.underflow] {
            out.extend_from_slice(&value.to_le_bytes());
        }
        for word in [counter.mask, counter.high_output, counter.low_output] {
            out.extend_from_slice(&word.to_le_bytes());
        }
    }
    out.push(MODES.iter().position(|mode| *mode == state.mode).unwrap_or(0) as u8);
    let fault = state.fault.map_or([0; 7], |fault| {
        let (file, rung) = fault.cause.unwrap_or_default();
        [1, fault.code, fault.file, fault.rung, fault.cause.is_some().into(), file, rung]
    });
    fault.into_iter().for_each(|word: u16| out.extend_from_slice(&word.to_le_bytes()));
    out.push(state.minor_by.is_some().into());
    out.extend_from_slice(&state.minor_by.unwrap_or(0).to_le_bytes());
    out
}

pub(crate) fn restore(program: &Compiled, bytes: &[u8]) -> Result<State, RestoreError> {
    let mut reader = Reader::new(bytes, *MAGIC, program.identity)?;
    let mut state = State::new(program);
    for word in state.mem.iter_mut().chain(&mut state.inputs).chain(&mut state.outputs) {
        *word = reader.word()?;
    }
    for force in state.input_forces.iter_mut().chain(&mut state.output_forces) {
        *force = (reader.word()?, reader.word()?);
    }
    for timer in &mut state.timers {
        *timer = TimerSlot { last: reader.long()?, part: reader.long()?, fresh: reader.flag()? };
    }
    for pid in &mut state.pids {
        let last = reader.long()?;
        let memory = Loop {
            running: reader.flag()?,
            waited: reader.long()?,
            last: f64::from_bits(reader.long()?),
            rate: f64::from_bits(reader.long()?),
            setpoint: reader.word()? as i16,
            last_error: reader.take().map(i32::from_le_bytes)?,
            crossed: reader.flag()?,
        };
        *pid = PidSlot { last, memory };
    }
    for message in &mut state.messages {
        *message = MessageSlot { started: reader.long()?, active: reader.flag()? };
    }
    for edge in &mut state.adjusts {
        *edge = reader.flag()?;
    }
    state.now = reader.long()?;
    state.scans = reader.long()?;
    state.executed = reader.long()?;
    state.limit = reader.long()?;
    state.clock_part = reader.long()?;
    state.second_part = reader.long()?;
    state.since_scan = reader.long()?;
    state.strays = reader.long()?;
    state.timed = TimedInterrupt {
        next: reader.long()?,
        period: reader.long()?,
        enabled: reader.flag()?,
        fine: reader.flag()?,
        executing: reader.flag()?,
    };
    state.due = reader.flag()?;
    state.events = reader.take::<8>()?;
    state.event_inputs = reader.word()?;
    state.discrete = DiscreteInput { matched: reader.flag()?, last: reader.word()? };
    for counter in &mut state.fast {
        *counter = FastCounter {
            loaded: reader.flag()?,
            set: reader.flag()?,
            high: reader.take().map(i32::from_le_bytes)?,
            low: reader.take().map(i32::from_le_bytes)?,
            overflow: reader.take().map(i32::from_le_bytes)?,
            underflow: reader.take().map(i32::from_le_bytes)?,
            mask: reader.word()?,
            high_output: reader.word()?,
            low_output: reader.word()?,
        };
    }
    let mode = reader.take::<1>()?[0];
    state.mode = *MODES.get(usize::from(mode)).ok_or(RestoreError::NotAState)?;
    let (present, code, file, rung) = (reader.word()?, reader.word()?, reader.word()?, reader.word()?);
    let (known, cause) = (reader.word()?, (reader.word()?, reader.word()?));
    let cause = (known != 0).then_some(cause);
    state.fault = (present != 0).then_some(MajorFault { code, file, rung, cause });
    let (known, by) = (reader.flag()?, reader.take().map(u32::from_le_bytes)?);
    state.minor_by = known.then_some(by);
    reader.end()?;
    Ok(state)
}
