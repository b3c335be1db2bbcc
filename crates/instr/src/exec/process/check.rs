//! The parameters of a loop and the errors they can have.

use super::{FULL_SCALE, Loop, WORDS, flag, scaling, word};
use crate::exec::rules::Lineage;

/// The error codes of PID (printed, except where said).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ErrorCode {
    /// 11h: loop update 0, or above 255 on SLC 5/02, 1024 elsewhere.
    LoopUpdate,
    /// 12h: gain negative; on SLC 5/02 0 or above 255.
    Gain,
    /// 13h: reset negative; on SLC 5/02 above 255.
    Reset,
    /// 14h: rate negative; on SLC 5/02 above 255.
    Rate,
    /// 15h: feed forward beyond ±16383. MicroLogix.
    FeedForward,
    /// 21h: scaled maximum beyond ±16383. SLC 5/02.
    ScaledMaximum,
    /// 22h: scaled minimum beyond ±16383. SLC 5/02.
    ScaledMinimum,
    /// 23h: scaled minimum above the scaled maximum.
    ScaledRange,
    /// 31h: the set point is out of range when the loop starts.
    Setpoint,
    /// 41h: deadband negative or wider than the range.
    Deadband,
    /// 51h: upper output limit outside 0 to 100 %.
    OutputMaximum,
    /// 52h: lower output limit outside 0 to 100 % (manual, unseen).
    OutputMinimum,
    /// 53h: lower output limit above the upper one (manual, unseen).
    OutputRange,
}

impl ErrorCode {
    /// The byte in the high half of word 1.
    pub const fn code(self) -> u16 {
        match self {
            ErrorCode::LoopUpdate => 0x11,
            ErrorCode::Gain => 0x12,
            ErrorCode::Reset => 0x13,
            ErrorCode::Rate => 0x14,
            ErrorCode::FeedForward => 0x15,
            ErrorCode::ScaledMaximum => 0x21,
            ErrorCode::ScaledMinimum => 0x22,
            ErrorCode::ScaledRange => 0x23,
            ErrorCode::Setpoint => 0x31,
            ErrorCode::Deadband => 0x41,
            ErrorCode::OutputMaximum => 0x51,
            ErrorCode::OutputMinimum => 0x52,
            ErrorCode::OutputRange => 0x53,
        }
    }
}

pub(super) fn parameters(block: &[u16; WORDS], lineage: Lineage) -> Result<(), ErrorCode> {
    let value = |index: usize| i32::from(block[index] as i16);
    let small = matches!(lineage, Lineage::S1 | Lineage::S2 | Lineage::M10);
    let within = |value: i32| if small { (0..=255).contains(&value) } else { value >= 0 };
    let full = i32::from(FULL_SCALE);
    let require = |holds: bool, code: ErrorCode| if holds { Ok(()) } else { Err(code) };
    let (low, high) = (value(word::SCALED_MIN), value(word::SCALED_MAX));
    let scaled = scaling(block).is_some();

    require((1..=if small { 255 } else { 1024 }).contains(&value(word::UPDATE)), ErrorCode::LoopUpdate)?;
    require(within(value(word::GAIN)) && !(small && value(word::GAIN) == 0), ErrorCode::Gain)?;
    require(within(value(word::RESET)), ErrorCode::Reset)?;
    require(within(value(word::RATE)), ErrorCode::Rate)?;
    require(lineage != Lineage::Mx || value(word::BIAS).abs() <= full, ErrorCode::FeedForward)?;
    require(!small || high.abs() <= full, ErrorCode::ScaledMaximum)?;
    require(!small || low.abs() <= full, ErrorCode::ScaledMinimum)?;
    require(!scaled || low <= high, ErrorCode::ScaledRange)?;
    let widest = if scaled { (high - low).min(full) } else { full };
    require((0..=widest).contains(&value(word::DEADBAND)), ErrorCode::Deadband)?;
    if block[word::FLAGS] & flag::LIMITED != 0 {
        let (lowest, highest) = (value(word::OUTPUT_MIN), value(word::OUTPUT_MAX));
        require((0..=100).contains(&highest), ErrorCode::OutputMaximum)?;
        require((0..=100).contains(&lowest), ErrorCode::OutputMinimum)?;
        require(lowest <= highest, ErrorCode::OutputRange)?;
    }
    Ok(())
}

/// The set point to work with. Out of range it is an error when the loop starts; a running loop goes on
/// with the last good one. Bit 11 of word 0 is set either way (printed).
pub(super) fn setpoint(block: &mut [u16; WORDS], state: &mut Loop) -> Result<i16, ErrorCode> {
    let value = block[word::SETPOINT] as i16;
    let range = match scaling(block) {
        Some(_) => block[word::SCALED_MIN] as i16..=block[word::SCALED_MAX] as i16,
        None => 0..=FULL_SCALE,
    };
    let good = range.contains(&value);
    super::put(block, flag::BAD_SETPOINT, !good);
    if good {
        state.setpoint = value;
    } else if !state.running {
        return Err(ErrorCode::Setpoint);
    }
    Ok(state.setpoint)
}
