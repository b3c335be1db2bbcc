//! PID: one closed loop on its block of 23 words, an N file on SLC, a PD element on MicroLogix.
//!
//! Printed: the block, its flags, ranges and errors; the equation with dependent gains
//! Kc × (E + 1/Ti ∫E dt + Td d(PV)/dt) + bias; that the rate term passes a low-pass filter whose
//! cut-off is 16 times its corner frequency; limits, alarms, anti-reset windup, manual mode and the
//! zero-crossing deadband. Open, and decided here: how the equation is cut into updates (rectangles,
//! backward differences), in which unit words 17 and 18 hold the integral sum ([`INTEGRAL_UNIT`]), and
//! what words 10 and 19 to 22 hold, which are left alone; [`Loop`] is kept beside the block instead.
//! Numbers on the way are double precision.

mod check;

pub use check::ErrorCode;

use super::rules::{Lineage, Rules};

/// Words of a block.
pub const WORDS: usize = 23;
/// The range of PV, CV and an unscaled set point (printed).
pub const FULL_SCALE: i16 = 16383;
/// The integral sum in words 17 and 18 counts 1/65536 of a unit of CV.
pub const INTEGRAL_UNIT: f64 = 65536.0;

/// Bits of word 0 (printed).
pub mod flag {
    /// TM: timed mode; off: updates at every execution, in an STI routine.
    pub const TIMED: u16 = 1;
    /// AM: manual.
    pub const MANUAL: u16 = 1 << 1;
    /// CM: forward acting, E = PV - SP; off: reverse acting, E = SP - PV.
    pub const FORWARD: u16 = 1 << 2;
    /// OL: the output is limited to words 11 and 12.
    pub const LIMITED: u16 = 1 << 3;
    /// RG: gain and reset in hundredths instead of tenths. SLC 5/03 and higher, MicroLogix.
    pub const FINE: u16 = 1 << 4;
    /// SC: off when set point scaling is specified.
    pub const UNSCALED: u16 = 1 << 5;
    /// TF: the loop is not updated in time.
    pub const TOO_FAST: u16 = 1 << 6;
    /// DA: the rate term acts on the error instead of PV. SLC 5/03 and higher, MicroLogix.
    pub const RATE_OF_ERROR: u16 = 1 << 7;
    /// DB: PV is within the deadband.
    pub const IN_DEADBAND: u16 = 1 << 8;
    /// UL: the output exceeds its upper limit.
    pub const UPPER_ALARM: u16 = 1 << 9;
    /// LL: the output is below its lower limit.
    pub const LOWER_ALARM: u16 = 1 << 10;
    /// SP: the set point is out of range.
    pub const BAD_SETPOINT: u16 = 1 << 11;
    /// PV: the process variable is out of range.
    pub const BAD_PROCESS: u16 = 1 << 12;
    /// DN: the loop was updated in this scan.
    pub const DONE: u16 = 1 << 13;
    /// EN: the rung is true.
    pub const ENABLE: u16 = 1 << 15;
}

/// Words of the block (printed).
mod word {
    pub(super) const FLAGS: usize = 0;
    pub(super) const ERROR: usize = 1;
    pub(super) const SETPOINT: usize = 2;
    pub(super) const GAIN: usize = 3;
    pub(super) const RESET: usize = 4;
    pub(super) const RATE: usize = 5;
    pub(super) const BIAS: usize = 6;
    pub(super) const SCALED_MAX: usize = 7;
    pub(super) const SCALED_MIN: usize = 8;
    pub(super) const DEADBAND: usize = 9;
    pub(super) const OUTPUT_MAX: usize = 11;
    pub(super) const OUTPUT_MIN: usize = 12;
    pub(super) const UPDATE: usize = 13;
    pub(super) const SCALED_PROCESS: usize = 14;
    pub(super) const SCALED_ERROR: usize = 15;
    pub(super) const OUTPUT: usize = 16;
    pub(super) const INTEGRAL_HIGH: usize = 17;
    pub(super) const INTEGRAL_LOW: usize = 18;
}

/// What a loop remembers between updates beside its block. The default is a loop that has not run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loop {
    /// It has been updated since its rung became true.
    pub running: bool,
    /// Nanoseconds since the last update.
    pub waited: u64,
    /// What the rate term acts on, at the last update.
    pub last: f64,
    /// The filtered rate of change, per minute.
    pub rate: f64,
    /// The last set point that was in range.
    pub setpoint: i16,
    /// The error at the last update, as shown in word 15.
    pub last_error: i32,
    /// PV has passed the set point since it entered the deadband.
    pub crossed: bool,
}

/// The loop cannot run: major error 0036, with this code in the high byte of word 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PidError(pub ErrorCode);

/// What the instruction reads besides its block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inputs {
    /// PV.
    pub process: i16,
    /// CV as it stands: in manual mode the program sets it.
    pub control: i16,
    /// Nanoseconds since the instruction was executed last.
    pub elapsed: u64,
}

/// One execution of PID. Returns what to write to CV; `None` leaves it.
///
/// In timed mode the loop updates when word 13 × 10 ms have passed, otherwise at every execution, and
/// counts word 13 as the time passed either way (printed: both rates must agree). The first execution of
/// a true rung updates (inferred). A false rung clears EN, DN and the integral sum and leaves CV (manual,
/// unseen). A block shorter than 23 words, which a loader should refuse, is not executed.
///
/// # Errors
/// A parameter out of range.
pub fn pid(
    rung: bool,
    block: &mut [u16],
    inputs: Inputs,
    state: &mut Loop,
    rules: Rules,
) -> Result<Option<i16>, PidError> {
    let Some(block) = block.first_chunk_mut::<WORDS>() else { return Ok(None) };
    if !rung {
        block[word::FLAGS] &= !(flag::ENABLE | flag::DONE);
        (block[word::INTEGRAL_HIGH], block[word::INTEGRAL_LOW]) = (0, 0);
        *state = Loop::default();
        return Ok(None);
    }
    block[word::FLAGS] = block[word::FLAGS] & !flag::DONE | flag::ENABLE;
    let period = u64::from(block[word::UPDATE]) * 10_000_000;
    if block[word::FLAGS] & flag::TIMED != 0 && state.running {
        state.waited = state.waited.saturating_add(inputs.elapsed);
        if state.waited < period {
            return Ok(None);
        }
        // A whole period late: this rate cannot be held (printed: the flag; inferred: from when on).
        let late = state.waited - period >= period.max(1);
        put(block, flag::TOO_FAST, late);
        state.waited = if late { 0 } else { state.waited - period };
    }
    if let Err(code) = check::parameters(block, rules.lineage) {
        block[word::ERROR] = block[word::ERROR] & 0x00FF | (code.code() << 8);
        return Err(PidError(code));
    }
    let setpoint = check::setpoint(block, state).map_err(|code| {
        block[word::ERROR] = block[word::ERROR] & 0x00FF | (code.code() << 8);
        PidError(code)
    })?;
    Ok(update(block, setpoint, inputs, state, rules))
}

fn put(block: &mut [u16; WORDS], mask: u16, on: bool) {
    block[word::FLAGS] = if on { block[word::FLAGS] | mask } else { block[word::FLAGS] & !mask };
}

fn signed(block: &[u16; WORDS], index: usize) -> f64 {
    f64::from(block[index] as i16)
}

/// Minimum and width of the engineering units; `None` without scaling.
fn scaling(block: &[u16; WORDS]) -> Option<(f64, f64)> {
    let (low, high) = (signed(block, word::SCALED_MIN), signed(block, word::SCALED_MAX));
    // With SC off and equal limits, as in a block of zeros, nothing was specified.
    (block[word::FLAGS] & flag::UNSCALED == 0 && low != high).then_some((low, high - low))
}

fn to_word(value: f64) -> u16 {
    value.round().clamp(f64::from(i16::MIN), f64::from(i16::MAX)) as i16 as u16
}

fn update(block: &mut [u16; WORDS], setpoint: i16, inputs: Inputs, state: &mut Loop, rules: Rules) -> Option<i16> {
    let full = f64::from(FULL_SCALE);
    let enhanced = !matches!(rules.lineage, Lineage::S1 | Lineage::S2 | Lineage::M10);
    let flags = block[word::FLAGS];
    let forward = flags & flag::FORWARD != 0;
    let towards = if forward { -1.0 } else { 1.0 };

    // Process variable, error and deadband.
    let process = f64::from(inputs.process.clamp(0, FULL_SCALE));
    put(block, flag::BAD_PROCESS, !(0..=FULL_SCALE).contains(&inputs.process));
    let scale = scaling(block);
    let shown = |raw: f64| scale.map_or(raw, |(low, width)| raw * width / full + low);
    let target = scale.map_or(f64::from(setpoint), |(low, width)| (f64::from(setpoint) - low) * full / width);
    block[word::SCALED_PROCESS] = to_word(shown(process));
    let difference = towards * (f64::from(setpoint) - f64::from(block[word::SCALED_PROCESS] as i16));
    block[word::SCALED_ERROR] = to_word(difference);
    let error = if in_deadband(block, difference as i32, state) { 0.0 } else { towards * (target - process) };

    // Gains. The rate is in hundredths of a minute whatever RG says (manual, unseen).
    let fine = enhanced && flags & flag::FINE != 0;
    let unit = if fine { 100.0 } else { 10.0 };
    let gain = signed(block, word::GAIN) / unit;
    let reset = signed(block, word::RESET) / unit;
    let rate = signed(block, word::RATE) / 100.0;
    let minutes = f64::from(block[word::UPDATE]) / 6000.0;

    // Rate term on PV, or on the error with DA. A rising PV lowers the output of a reverse acting loop
    // (inferred: the printed equation has one sign for both).
    let on_error = enhanced && flags & flag::RATE_OF_ERROR != 0;
    let signal = if on_error { error } else { -towards * process };
    if state.running && rate > 0.0 && minutes > 0.0 {
        let slope = (signal - state.last) / minutes;
        let filter = rate / 16.0;
        state.rate += (slope - state.rate) * minutes / (filter + minutes);
    } else {
        state.rate = 0.0;
    }
    state.last = signal;
    state.running = true;
    let without_integral = gain * (error + rate * state.rate) + signed(block, word::BIAS);

    let (low, high) = limits(block);
    let manual = flags & flag::MANUAL != 0;
    let output = if manual {
        // The integral sum follows CV, so that automatic mode takes over without a bump (printed).
        let control = f64::from(inputs.control).clamp(0.0, full);
        store_integral(block, if reset > 0.0 { control - without_integral } else { 0.0 });
        control
    } else {
        let before = integral(block);
        let push = gain * error;
        // Printed: the integral stops while the sum is at a limit. Moving back into the range it goes on
        // (inferred): a loop that starts with an output of 0 would never integrate otherwise.
        let sum = without_integral + before;
        let held = sum <= low && push <= 0.0 || sum >= high && push >= 0.0;
        let after = match (reset > 0.0, held) {
            (false, _) => 0.0,
            (true, true) => before,
            (true, false) => before + push * minutes / reset,
        };
        store_integral(block, after);
        without_integral + integral(block)
    };
    alarms(block, output);
    put(block, flag::DONE, true);
    let control = output.clamp(low, high).round() as i16;
    block[word::OUTPUT] = to_word((if manual { output } else { f64::from(control) }) * 100.0 / full);
    (!manual).then_some(control)
}

/// PV is within the deadband and has passed the set point there: the error counts as 0 (printed). DB says
/// that it is within.
fn in_deadband(block: &mut [u16; WORDS], difference: i32, state: &mut Loop) -> bool {
    let band = i32::from(block[word::DEADBAND] as i16);
    let inside = band > 0 && difference.abs() <= band;
    if !inside {
        state.crossed = false;
    } else if difference == 0 || state.running && difference.signum() == -state.last_error.signum() {
        state.crossed = true;
    }
    state.last_error = difference;
    put(block, flag::IN_DEADBAND, inside);
    inside && state.crossed
}

/// The limits of CV: words 11 and 12 in percent with OL, else the whole range (printed).
fn limits(block: &[u16; WORDS]) -> (f64, f64) {
    let full = f64::from(FULL_SCALE);
    if block[word::FLAGS] & flag::LIMITED == 0 {
        return (0.0, full);
    }
    (signed(block, word::OUTPUT_MIN) * full / 100.0, signed(block, word::OUTPUT_MAX) * full / 100.0)
}

/// UL and LL tell that the output exceeds words 11 and 12, whether it is limited to them or not; without
/// values there (both 0) the range counts (printed: entering values enables the alarms). The output is
/// the one within 0 to 100 %: two loops of a running MicroLogix 1400 whose sum was far above, with 100
/// in word 11 and OL off, were saved without UL.
fn alarms(block: &mut [u16; WORDS], output: f64) {
    let full = f64::from(FULL_SCALE);
    let output = output.clamp(0.0, full);
    let (low, high) = match (signed(block, word::OUTPUT_MIN), signed(block, word::OUTPUT_MAX)) {
        (0.0, 0.0) => (0.0, 100.0),
        entered => entered,
    };
    put(block, flag::UPPER_ALARM, output > high * full / 100.0);
    put(block, flag::LOWER_ALARM, output < low * full / 100.0);
}

fn integral(block: &[u16; WORDS]) -> f64 {
    let bits = u32::from(block[word::INTEGRAL_HIGH]) << 16 | u32::from(block[word::INTEGRAL_LOW]);
    f64::from(bits as i32) / INTEGRAL_UNIT
}

fn store_integral(block: &mut [u16; WORDS], value: f64) {
    let bits = (value * INTEGRAL_UNIT).round() as i32 as u32;
    (block[word::INTEGRAL_HIGH], block[word::INTEGRAL_LOW]) = ((bits >> 16) as u16, bits as u16);
}

#[cfg(test)]
mod tests;
