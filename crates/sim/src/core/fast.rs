//! High-speed counters and event inputs of MicroLogix 1100 to 1500.
//!
//! Pulses and events come from the caller; pulses of counter 0 and event inputs are also seen where a
//! terminal changes between two scans. Which bits of the function file tell direction and causes is not published, so those do
//! not change.

use instr::exec::counter::{limits_are_valid, pulse_down, pulse_up};
use ladder::FileType;

use super::interrupt::{FLAGS, flag};
use super::{Core, Watch};
use crate::fault::code;
use crate::machine::Mode;

const ERROR_CODE: u32 = 1;
const MASKS: u32 = 3;
const MODE: u32 = 4;
const ACC: u32 = 5;
const HIGH: u32 = 7;
const LOW: u32 = 9;
const OVERFLOW: u32 = 11;
const UNDERFLOW: u32 = 13;
const OUTPUT_MASK: u32 = 15;
const HIGH_OUTPUT: u32 = 16;
const LOW_OUTPUT: u32 = 17;

/// HSC flags in word 2.
const FUNCTION_ENABLED: u16 = 1 << 4;
const COUNTING: u16 = 1 << 11;
const SET_PARAMETERS: u16 = 1 << 15;

/// Interrupt masks in word 3, in the order the manuals list them; all are on in a new project.
const UNDERFLOW_MASK: u16 = 1;
const LOW_MASK: u16 = 1 << 1;
const HIGH_MASK: u16 = 1 << 2;
const OVERFLOW_MASK: u16 = 1 << 3;

/// EII flags in word 2: event enabled, rising edge.
const EVENT_ENABLED: u16 = 1 << 4;
const RISING: u16 = 1 << 14;
const SELECT: u32 = 3;

/// What a counter was loaded with; the function file can differ until SP rises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct FastCounter {
    pub(crate) loaded: bool,
    pub(crate) set: bool,
    pub(crate) high: i32,
    pub(crate) low: i32,
    pub(crate) overflow: i32,
    pub(crate) underflow: i32,
    pub(crate) mask: u16,
    pub(crate) high_output: u16,
    pub(crate) low_output: u16,
}

impl Core<'_> {
    fn element(&self, file_type: FileType, number: usize) -> Option<u32> {
        self.p.layout.interrupt(file_type, u32::try_from(number).ok()?)
    }

    /// Going to run: counters that start by themselves are loaded, events enabled by AS.
    pub(crate) fn enter_run_fast(&mut self) {
        for number in 0..self.s.fast.len() {
            let Some(at) = self.element(FileType::HSC, number) else { break };
            if self.word(at + FLAGS) & flag::AUTO_START != 0 {
                self.put_bits(at + FLAGS, FUNCTION_ENABLED | COUNTING | flag::ENABLE, true);
                self.load_counter(number, at);
            }
        }
        for number in 0..8 {
            let Some(at) = self.element(FileType::EII, number) else { break };
            self.put_bits(at + FLAGS, flag::EXECUTING | flag::PENDING, false);
            if self.word(at + FLAGS) & flag::AUTO_START != 0 {
                self.put_bits(at + FLAGS, EVENT_ENABLED | flag::ENABLE, true);
            }
        }
        self.s.event_inputs = self.s.inputs.first().copied().unwrap_or(0);
    }

    /// Takes parameters over where SP has risen, and serves events at the inputs.
    pub(crate) fn fast_inputs<W: Watch>(&mut self, watch: &mut W) {
        for number in 0..self.s.fast.len() {
            let Some(at) = self.element(FileType::HSC, number) else { break };
            let set = self.word(at + FLAGS) & SET_PARAMETERS != 0;
            let was = self.s.fast.get(number).is_some_and(|counter| counter.set);
            if set && !was {
                self.load_counter(number, at);
            }
            if let Some(counter) = self.s.fast.get_mut(number) {
                counter.set = set;
            }
        }
        let now = self.s.inputs.first().copied().unwrap_or(0);
        let changed = now ^ std::mem::replace(&mut self.s.event_inputs, now);
        if changed & 3 != 0 {
            self.count_inputs(changed & now, now, watch);
        }
        for number in 0..8 {
            if changed == 0 {
                break;
            }
            let Some(at) = self.element(FileType::EII, number) else { break };
            let flags = self.word(at + FLAGS);
            let input = self.word(at + SELECT) & 15;
            let edge = changed >> input & 1 != 0 && (now >> input & 1 != 0) == (flags & RISING != 0);
            if flags & EVENT_ENABLED != 0 && edge && self.executing() {
                self.function_file_interrupt(at, watch);
            }
        }
    }

    /// Inputs 0 and 1 are those of counter 0; `risen` are the inputs that went on. How they count is its
    /// mode (recalled from the manuals): input 0 up; the same with input 1 for down; input 0 up and
    /// input 1 down. Quadrature needs more edges than a scan shows.
    fn count_inputs<W: Watch>(&mut self, risen: u16, now: u16, watch: &mut W) {
        let Some(at) = self.element(FileType::HSC, 0) else { return };
        let (first, second) = (risen & 1 != 0, risen & 2 != 0);
        let mode = self.word(at + MODE);
        let counts = match mode {
            0 | 1 => [first.then_some(1), None],
            2 | 3 => [first.then_some(if now & 2 != 0 { -1 } else { 1 }), None],
            4 | 5 => [first.then_some(1), second.then_some(-1)],
            _ => [None, None],
        };
        for count in counts.into_iter().flatten() {
            self.pulses(0, count, watch);
        }
    }

    /// An event at an event input.
    pub(crate) fn event<W: Watch>(&mut self, number: usize, watch: &mut W) -> bool {
        let Some(at) = self.element(FileType::EII, number) else { return false };
        if self.executing() {
            self.function_file_interrupt(at, watch);
        }
        true
    }

    fn long_at(&self, at: u32) -> i32 {
        self.long(at) as i32
    }

    /// Parameters of the function file into the counter, if they make sense.
    fn load_counter(&mut self, number: usize, at: u32) {
        let [high, low, overflow, underflow] = [HIGH, LOW, OVERFLOW, UNDERFLOW].map(|word| self.long_at(at + word));
        let valid = limits_are_valid(overflow, underflow, high, low) || overflow == i32::MAX && high == i32::MAX;
        self.put_bits(at + FLAGS, flag::ERROR, !valid);
        self.put(at + ERROR_CODE, u16::from(!valid));
        if !valid {
            return self.halt(code::HIGH_SPEED, Self::nowhere());
        }
        let [mask, high_output, low_output] = [OUTPUT_MASK, HIGH_OUTPUT, LOW_OUTPUT].map(|word| self.word(at + word));
        if let Some(counter) = self.s.fast.get_mut(number) {
            // Which outputs it may switch is decided once, on going to run.
            let mask = if counter.loaded { counter.mask } else { mask };
            let set = counter.set;
            *counter = FastCounter { loaded: true, set, high, low, overflow, underflow, mask, high_output, low_output };
        }
    }

    /// Pulses at a counter, up or down; `false` when it is not there or does not count.
    pub(crate) fn pulses<W: Watch>(&mut self, number: usize, count: i32, watch: &mut W) -> bool {
        let Some(at) = self.element(FileType::HSC, number) else { return false };
        let Some(counter) = self.s.fast.get(number).copied().filter(|counter| counter.loaded) else { return false };
        let counts = FUNCTION_ENABLED | COUNTING;
        if self.word(at + FLAGS) & counts != counts || !self.executing() {
            return false;
        }
        for _ in 0..count.unsigned_abs().min(1_000_000) {
            let acc = self.long_at(at + ACC);
            let pulse = match count > 0 {
                true => pulse_up(acc, counter.overflow, counter.underflow),
                false => pulse_down(acc, counter.overflow, counter.underflow),
            };
            self.put_long(at + ACC, pulse.accumulated as u32);
            let (cause, output) = match (pulse.rolled_over, count > 0) {
                (true, true) => (OVERFLOW_MASK, None),
                (true, false) => (UNDERFLOW_MASK, None),
                (false, true) if pulse.accumulated == counter.high => (HIGH_MASK, Some(counter.high_output)),
                (false, false) if pulse.accumulated == counter.low => (LOW_MASK, Some(counter.low_output)),
                _ => continue,
            };
            if let Some(pattern) = output {
                self.drive(counter.mask, pattern);
            }
            if self.word(at + MASKS) & cause != 0 && self.word(at) != 0 {
                self.function_file_interrupt(at, watch);
            }
            if !self.executing() {
                break;
            }
        }
        true
    }

    /// The outputs a counter switches, image and terminals.
    fn drive(&mut self, mask: u16, pattern: u16) {
        let (first, count) = self.p.outputs;
        if count == 0 {
            return;
        }
        let word = self.word(first as u32) & !mask | pattern & mask;
        self.put(first as u32, word);
        if self.s.mode == Mode::Run
            && let Some(terminal) = self.s.outputs.first_mut()
        {
            *terminal = *terminal & !mask | pattern & mask;
        }
    }
}
