//! The discrete input interrupt of the SLC 5/03 and higher: a pattern at an input module runs a program
//! file.
//!
//! The processor looks at the module many times a scan; here inputs change between scans, so the pattern
//! is looked at once, before the program scan. What S:46 to S:52 say is taken as it stands then.

use ladder::FileType;

use super::run::Context;
use super::{Core, Watch};
use crate::fault::code;
use crate::status;

/// What is remembered of the module between two scans.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct DiscreteInput {
    /// The pattern was there.
    pub(crate) matched: bool,
    /// The inputs.
    pub(crate) last: u16,
}

/// Slots of a chassis that hold modules.
const SLOTS: std::ops::RangeInclusive<u16> = 1..=30;
/// The mask and the compare value have eight bits.
const BITS: u16 = 0x00FF;

impl Core<'_> {
    /// The inputs of the module, or the fault of a set-up that makes no sense; `None`: it is off.
    fn discrete_set_up(&self) -> Result<Option<u16>, u16> {
        let file = self.status(status::DII_FILE);
        if file == 0 {
            return Ok(None);
        }
        if !(3..=255).contains(&file) || self.p.entry(file).is_none() {
            return Err(code::DII_FILE);
        }
        let slot = self.status(status::DII_SLOT);
        let word = self.p.layout.io_word(FileType::I, slot, 0).filter(|_| SLOTS.contains(&slot));
        word.map(|word| Some(self.word(word))).ok_or(code::DII_SLOT)
    }

    fn matches(&self, inputs: u16) -> bool {
        let mask = self.status(status::DII_MASK) & BITS;
        mask != 0 && (inputs ^ self.status(status::DII_COMPARE)) & mask == 0
    }

    /// On the way to run: a pattern that is there already is no event.
    pub(crate) fn enter_run_discrete(&mut self) {
        self.set_status_bit(status::DII_PENDING, false);
        self.set_status_bit(status::DII_EXECUTING, false);
        match self.discrete_set_up() {
            Ok(Some(inputs)) => {
                self.s.discrete = DiscreteInput { matched: self.matches(inputs), last: inputs };
            }
            Ok(None) => self.s.discrete = DiscreteInput::default(),
            Err(code) => self.halt(code, Self::nowhere()),
        }
    }

    /// Looks at the module, counts, and runs the routine.
    pub(crate) fn discrete_input<W: Watch>(&mut self, watch: &mut W) {
        let inputs = match self.discrete_set_up() {
            Ok(Some(inputs)) => inputs,
            Ok(None) => return,
            Err(code) => return self.halt(code, Self::nowhere()),
        };
        let matched = self.matches(inputs);
        let before = std::mem::replace(&mut self.s.discrete, DiscreteInput { matched, last: inputs });
        if matched && !before.matched {
            let count = self.status(status::DII_ACCUMULATOR).wrapping_add(1);
            let preset = self.status(status::DII_PRESET);
            // Preset 0 and 1: every event interrupts.
            if (preset as i16) > 1 && count < preset {
                self.set_status(status::DII_ACCUMULATOR, count);
            } else {
                self.set_status(status::DII_ACCUMULATOR, 0);
                let changed = (before.last ^ inputs) & self.status(status::DII_MASK) & BITS;
                self.set_status(status::DII_RETURN, changed);
                if self.status_bit(status::DII_PENDING) {
                    let minor = self.status(status::MINOR);
                    self.set_status(status::MINOR, minor | status::DII_OVERFLOW);
                    let extended = self.status(status::EXTENDED_MINOR);
                    self.set_status(status::EXTENDED_MINOR, extended | status::DII_LOST);
                }
                self.set_status_bit(status::DII_PENDING, true);
            }
        }
        if self.status_bit(status::DII_PENDING) && self.status_bit(status::DII_ENABLED) {
            self.discrete_routine(watch);
        }
    }

    fn discrete_routine<W: Watch>(&mut self, watch: &mut W) {
        let Some(entry) = self.p.entry(self.status(status::DII_FILE)) else { return };
        self.set_status_bit(status::DII_PENDING, false);
        self.set_status_bit(status::DII_EXECUTING, true);
        let ending = self.interrupting(|core| core.run(entry, Context::Discrete, watch));
        self.set_status_bit(status::DII_EXECUTING, false);
        self.ended(ending);
    }
}
