//! Saved states: a stable byte form of [`State`].
//!
//! `RUNGSDM2`, the identity of the program, then every field in a fixed order, numbers little-endian.

use sim::shared::Reader;
pub use sim::shared::RestoreError;

use super::op::Compiled;
use super::state::{BlockState, Phase, State, TimerClock};
use super::{Fault, Mode};
use crate::memory::Num;

const MAGIC: &[u8; 8] = b"RUNGSDM2";

pub(crate) fn save(program: &Compiled, state: &State) -> Vec<u8> {
    let mut out = Vec::with_capacity(256 + state.data.bytes().len());
    out.extend_from_slice(MAGIC);
    let long = |out: &mut Vec<u8>, value: u64| out.extend_from_slice(&value.to_le_bytes());
    long(&mut out, program.identity);
    out.extend_from_slice(state.data.bytes());
    out.extend_from_slice(state.terminals.bytes());
    for value in [state.now, state.scans, state.executed, state.limit, state.troubles] {
        long(&mut out, value);
    }
    long(&mut out, state.clock as u64);
    long(&mut out, state.shown_second as u64);
    let (kind, operation) = match state.fault {
        None => (0, 0),
        Some(Fault::Watchdog) => (1, 0),
        Some(Fault::CallDepth) => (2, 0),
        Some(Fault::Unsupported { operation }) => (3, operation),
    };
    out.extend_from_slice(&[u8::from(state.mode == Mode::Run), state.first.into(), kind]);
    out.extend_from_slice(&operation.to_le_bytes());
    for block in &state.blocks {
        let flags = [block.enabled, block.suspended, block.restart, block.ran];
        out.extend(flags.map(u8::from));
        long(&mut out, block.last);
    }
    out.extend_from_slice(&state.edges);
    for value in &state.values {
        let (kind, bits) = match value {
            None => (0, 0),
            Some(Num::Int(value)) => (1, *value as u64),
            Some(Num::Real(value)) => (2, value.to_bits()),
        };
        out.push(kind);
        long(&mut out, bits);
    }
    for timer in &state.timers {
        out.push(timer.fresh.into());
        long(&mut out, timer.last);
    }
    for phase in &state.phases {
        out.push(phase.active.into());
        long(&mut out, phase.since);
    }
    state.resets.iter().chain(&state.or_outs).for_each(|value| long(&mut out, *value));
    out.extend(state.stages.iter().map(|ran| u8::from(*ran)));
    out
}

pub(crate) fn restore(program: &Compiled, bytes: &[u8]) -> Result<State, RestoreError> {
    let mut reader = Reader::new(bytes, *MAGIC, program.identity)?;
    let mut state = State::new(program);
    for byte in state.data.bytes_mut().iter_mut().chain(state.terminals.bytes_mut()) {
        *byte = reader.byte()?;
    }
    for field in [&mut state.now, &mut state.scans, &mut state.executed, &mut state.limit, &mut state.troubles] {
        *field = reader.long()?;
    }
    state.clock = reader.long()? as i64;
    state.shown_second = reader.long()? as i64;
    state.mode = if reader.flag()? { Mode::Run } else { Mode::Program };
    state.first = reader.flag()?;
    let kind = reader.byte()?;
    let operation = u32::from_le_bytes(reader.take()?);
    state.fault = match kind {
        0 => None,
        1 => Some(Fault::Watchdog),
        2 => Some(Fault::CallDepth),
        3 => Some(Fault::Unsupported { operation }),
        _ => return Err(RestoreError::NotAState),
    };
    for block in &mut state.blocks {
        *block = BlockState {
            enabled: reader.flag()?,
            suspended: reader.flag()?,
            restart: reader.flag()?,
            ran: reader.flag()?,
            last: reader.long()?,
        };
    }
    for edge in &mut state.edges {
        *edge = reader.byte()?;
    }
    for value in &mut state.values {
        let (kind, bits) = (reader.byte()?, reader.long()?);
        *value = match kind {
            0 => None,
            1 => Some(Num::Int(bits as i64)),
            2 => Some(Num::Real(f64::from_bits(bits))),
            _ => return Err(RestoreError::NotAState),
        };
    }
    for timer in &mut state.timers {
        *timer = TimerClock { fresh: reader.flag()?, last: reader.long()? };
    }
    for phase in &mut state.phases {
        *phase = Phase { active: reader.flag()?, since: reader.long()? };
    }
    for value in state.resets.iter_mut().chain(&mut state.or_outs) {
        *value = reader.long()?;
    }
    for ran in &mut state.stages {
        *ran = reader.flag()?;
    }
    reader.end()?;
    Ok(state)
}
