//! Codes of the traps a migration can meet, as the report names them.

use std::fmt;

/// A trap: why a rung holds under a condition only, or needs a person.
///
/// The codes are this program's own. Where the vendor's translator for another target, from SLC 500 to
/// Logix, puts a numbered mark (its instruction PCE, program conversion error) for the same trap,
/// [`Mark::pce`] names it, because integrators know these numbers. No list for Do-more was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Mark {
    /// Time base, preset or accumulator of a timer.
    TimerBase,
    /// One-shots whose result depends on the order of the scan.
    OneShot,
    /// The math register S:13, S:14 or the arithmetic flags S:0.
    MathRegister,
    /// A place decided at run time.
    Indirect,
    /// Inputs or outputs transferred in the middle of the scan.
    ImmediateIo,
    /// Interrupts and fault routines.
    Interrupt,
    /// OV and UN of counters.
    OverUnder,
    /// Values that change while the scan runs: module data, messages, high-speed counters.
    AsyncIo,
    /// The original stops with a major fault here.
    Fault,
    /// Program flow: jumps, returns, calls.
    Flow,
    /// Values of the status file.
    Status,
    /// Floating point, rounding and conversion.
    Rounding,
    /// Strings.
    Text,
    /// The real-time clock.
    Clock,
    /// Overlapping or unlike files in COP, FLL, shifts, stacks.
    Files,
    /// Calibrated functions without a counterpart: PID, messages, pulse outputs.
    NoCounterpart,
    /// The instruction is not known.
    Unknown,
    /// An operand that leads nowhere.
    Operand,
}

/// Numbers of the vendor's PCE marks, from its published help ("Program Conversion Error (PCE)", Logix
/// Designer 37): 102 OV or UN of a counter, 103 status file, 107 index to be validated, 120 types of
/// source and destination of a copy.
const PCE: [(Mark, u16); 5] =
    [(Mark::MathRegister, 103), (Mark::Indirect, 107), (Mark::OverUnder, 102), (Mark::Status, 103), (Mark::Files, 120)];

/// Codes and titles; one row per mark.
const MARKS: [(Mark, &str, &str); 18] = [
    (Mark::TimerBase, "TIMER-BASE", "time base, preset or accumulator of a timer"),
    (Mark::OneShot, "ONE-SHOT", "one-shot against scan order"),
    (Mark::MathRegister, "MATH-REG", "math register and arithmetic flags"),
    (Mark::Indirect, "INDIRECT", "address decided at run time"),
    (Mark::ImmediateIo, "IMM-IO", "immediate input or output"),
    (Mark::Interrupt, "INTERRUPT", "interrupt or fault routine"),
    (Mark::OverUnder, "OV-UN", "overflow and underflow of a counter"),
    (Mark::AsyncIo, "ASYNC-IO", "data that changes during the scan"),
    (Mark::Fault, "FAULT", "the original stops with a major fault"),
    (Mark::Flow, "FLOW", "jumps, returns and calls"),
    (Mark::Status, "STATUS", "status file"),
    (Mark::Rounding, "ROUNDING", "rounding and conversion of numbers"),
    (Mark::Text, "STRING", "strings"),
    (Mark::Clock, "CLOCK", "real-time clock"),
    (Mark::Files, "FILES", "copies, shifts and stacks over files"),
    (Mark::NoCounterpart, "NO-EQUAL", "no counterpart in Do-more"),
    (Mark::Unknown, "UNKNOWN", "instruction not known"),
    (Mark::Operand, "OPERAND", "operand that leads nowhere"),
];

impl Mark {
    /// All marks in the order of the report.
    pub fn all() -> impl Iterator<Item = Mark> {
        MARKS.iter().map(|row| row.0)
    }

    /// The code in reports: `TIMER-BASE`.
    pub fn code(self) -> &'static str {
        MARKS.iter().find(|row| row.0 == self).map_or("UNKNOWN", |row| row.1)
    }

    /// The vendor's mark for the same trap.
    pub fn pce(self) -> Option<u16> {
        PCE.iter().find(|row| row.0 == self).map(|row| row.1)
    }

    /// What it is about, in words.
    pub fn title(self) -> &'static str {
        MARKS.iter().find(|row| row.0 == self).map_or("", |row| row.2)
    }
}

impl fmt::Display for Mark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.code())
    }
}

/// A trap with what it means for one rung.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Note {
    /// Which trap.
    pub mark: Mark,
    /// What holds, or what a person has to do, in one sentence.
    pub text: String,
}

impl Note {
    /// A note.
    pub fn new(mark: Mark, text: impl Into<String>) -> Note {
        Note { mark, text: text.into() }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.mark, self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique_and_complete() {
        let mut codes: Vec<_> = Mark::all().map(Mark::code).collect();
        assert_eq!(codes.len(), MARKS.len());
        codes.sort_unstable();
        codes.dedup();
        assert_eq!(codes.len(), MARKS.len());
    }
}
