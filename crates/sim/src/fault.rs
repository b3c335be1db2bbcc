//! Major faults.

use std::fmt;

/// A fault that stops the processor unless the user fault routine clears it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MajorFault {
    /// The code in S:6.
    pub code: u16,
    /// Program file that was executing.
    pub file: u16,
    /// Its rung.
    pub rung: u16,
    /// Of a minor error at the end of the scan: program file and rung of the instruction that set the first bit of
    /// S:5 that stops. `None` for all other faults, and where the program stored the bit itself.
    pub cause: Option<(u16, u16)>,
}

impl MajorFault {
    /// Program file and rung to look at: of the cause where it is known.
    pub fn place(&self) -> (u16, u16) {
        self.cause.unwrap_or((self.file, self.rung))
    }
}

impl fmt::Display for MajorFault {
    /// `major fault 0034 (negative timer preset or accumulator) at file 2 rung 5`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "major fault {:04X}", self.code)?;
        if let Some(text) = meaning(self.code) {
            write!(f, " ({text})")?;
        }
        write!(f, " at file {} rung {}", self.file, self.rung)?;
        match self.cause {
            Some((file, rung)) => write!(f, ", set by file {file} rung {rung}"),
            None => Ok(()),
        }
    }
}

/// What the user fault routine can do about a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultClass {
    /// The routine runs and may clear it.
    Recoverable,
    /// The routine runs once, then the processor halts.
    NonRecoverable,
    /// The routine does not run.
    NonUser,
}

/// Codes the engine raises.
pub(crate) mod code {
    pub(crate) const NO_MAIN: u16 = 0x11;
    pub(crate) const LABEL: u16 = 0x19;
    pub(crate) const MINOR_ERROR: u16 = 0x20;
    pub(crate) const WATCHDOG: u16 = 0x22;
    pub(crate) const STI_FILE: u16 = 0x23;
    pub(crate) const STI_PERIOD: u16 = 0x24;
    pub(crate) const NESTING_STI: u16 = 0x25;
    pub(crate) const NESTING_IO: u16 = 0x26;
    pub(crate) const NESTING_FAULT_ROUTINE: u16 = 0x27;
    pub(crate) const FAULT_ROUTINE: u16 = 0x28;
    pub(crate) const OUTSIDE_DATA: u16 = 0x29;
    pub(crate) const OUTSIDE_FILE: u16 = 0x2A;
    pub(crate) const INDIRECT_FILE: u16 = 0x2B;
    pub(crate) const INDIRECT_ELEMENT: u16 = 0x2C;
    pub(crate) const INDIRECT_SUB: u16 = 0x2D;
    pub(crate) const DII_SLOT: u16 = 0x2E;
    pub(crate) const DII_FILE: u16 = 0x2F;
    pub(crate) const NESTING: u16 = 0x30;
    pub(crate) const UNSUPPORTED: u16 = 0x31;
    pub(crate) const SEQUENCER: u16 = 0x32;
    pub(crate) const SHIFT: u16 = 0x33;
    pub(crate) const TIMER: u16 = 0x34;
    pub(crate) const IN_INTERRUPT: u16 = 0x35;
    pub(crate) const PID: u16 = 0x36;
    pub(crate) const HIGH_SPEED: u16 = 0x37;
    pub(crate) const RET_IN_MAIN: u16 = 0x38;
}

const MEANINGS: &[(u16, &str)] = &[
    (code::NO_MAIN, "program file 2 is missing"),
    (code::LABEL, "missing or duplicate label"),
    (code::MINOR_ERROR, "minor error bit set at the end of the scan"),
    (code::WATCHDOG, "watchdog"),
    (code::STI_FILE, "invalid STI file"),
    (code::STI_PERIOD, "invalid STI period"),
    (code::NESTING_STI, "too many nested subroutines in the STI routine"),
    (code::NESTING_IO, "too many nested subroutines in the DII routine"),
    (code::NESTING_FAULT_ROUTINE, "too many nested subroutines in the fault routine"),
    (code::FAULT_ROUTINE, "invalid fault routine file"),
    (code::OUTSIDE_DATA, "address outside the data space"),
    (code::OUTSIDE_FILE, "indexed address beyond its file"),
    (code::INDIRECT_FILE, "invalid indirect file"),
    (code::INDIRECT_ELEMENT, "invalid indirect element"),
    (code::INDIRECT_SUB, "invalid indirect bit or sub-element"),
    (code::DII_SLOT, "invalid DII slot"),
    (code::DII_FILE, "invalid DII file"),
    (code::NESTING, "too many nested subroutines"),
    (code::UNSUPPORTED, "unsupported instruction"),
    (code::SEQUENCER, "sequencer beyond its data file"),
    (code::SHIFT, "shift or stack beyond its data file"),
    (code::TIMER, "negative timer preset or accumulator"),
    (code::IN_INTERRUPT, "instruction not allowed in an interrupt or fault routine"),
    (code::PID, "PID parameter"),
    (code::HIGH_SPEED, "high-speed counter"),
    (code::RET_IN_MAIN, "RET in the main program"),
];

/// What a code means, for those the engine raises.
pub(crate) fn meaning(code: u16) -> Option<&'static str> {
    MEANINGS.iter().find(|row| row.0 == code).map(|row| row.1)
}

/// The class of a code. Pages name 0020 and 0034 as recoverable, 0028 and 0030 as non-user; of the others
/// no page was found, and they are taken as non-recoverable except those a routine can repair.
pub(crate) fn class(code: u16) -> FaultClass {
    match code {
        code::NO_MAIN | code::LABEL | code::FAULT_ROUTINE => FaultClass::NonUser,
        code::NESTING | code::NESTING_STI | code::NESTING_IO | code::NESTING_FAULT_ROUTINE => FaultClass::NonUser,
        code::WATCHDOG | code::UNSUPPORTED | code::IN_INTERRUPT | code::RET_IN_MAIN => FaultClass::NonRecoverable,
        _ => FaultClass::Recoverable,
    }
}
