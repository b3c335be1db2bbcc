//! Data file types by the letters engineers write in addresses.

use std::fmt;

/// The type of a data file or function file, named by the letters used in addresses.
///
/// `Unknown` carries the number a project stores for a type this crate has no letters for, so that
/// nothing is lost and outputs can show the number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)] // the variants are the letters themselves; `letters` and `description` document them
pub enum FileType {
    O,
    I,
    S,
    B,
    T,
    C,
    R,
    N,
    F,
    A,
    ST,
    L,
    D,
    G,
    M0,
    M1,
    PD,
    MG,
    PLS,
    RIX,
    HSC,
    PTO,
    PTOX,
    PWM,
    PWMX,
    STI,
    EII,
    RTC,
    MMI,
    BHI,
    TPI,
    CS,
    DLS,
    DAT,
    LCD,
    IOS,
    ES,
    /// A file number the processor keeps for itself (file 8 of a fixed SLC 500).
    Reserved,
    /// A free file number below the highest file in use.
    Unused,
    /// A stored type number that has no known letters.
    Unknown(u16),
}

use FileType::*;

/// Type, letters, words per element (0: not fixed), name in words.
const TABLE: &[(FileType, &str, u16, &str)] = &[
    (O, "O", 1, "output"),
    (I, "I", 1, "input"),
    (S, "S", 1, "status"),
    (B, "B", 1, "bit"),
    (T, "T", 3, "timer"),
    (C, "C", 3, "counter"),
    (R, "R", 3, "control"),
    (N, "N", 1, "integer"),
    (F, "F", 2, "float"),
    (A, "A", 1, "ASCII"),
    (ST, "ST", 42, "string"),
    (L, "L", 2, "long integer"),
    (D, "D", 1, "BCD"),
    (G, "G", 1, "global I/O"),
    (M0, "M0", 1, "module output image M0"),
    (M1, "M1", 1, "module input image M1"),
    (PD, "PD", 23, "PID"),
    (MG, "MG", 25, "message"),
    (PLS, "PLS", 6, "programmable limit switch"),
    (RIX, "RIX", 25, "routing information"),
    (HSC, "HSC", 0, "high-speed counter"),
    (PTO, "PTO", 0, "pulse train output"),
    (PTOX, "PTOX", 0, "pulse train output (MicroLogix 1400)"),
    (PWM, "PWM", 0, "pulse width modulation"),
    (PWMX, "PWMX", 0, "pulse width modulation (MicroLogix 1400)"),
    (STI, "STI", 0, "selectable timed interrupt"),
    (EII, "EII", 0, "event input interrupt"),
    (RTC, "RTC", 0, "real-time clock"),
    (MMI, "MMI", 0, "memory module information"),
    (BHI, "BHI", 0, "base hardware information"),
    (TPI, "TPI", 0, "trim pot information"),
    (CS, "CS", 0, "communication status"),
    (DLS, "DLS", 0, "data log status"),
    (DAT, "DAT", 0, "data access tool"),
    (LCD, "LCD", 0, "LCD information"),
    (IOS, "IOS", 0, "I/O status"),
    (ES, "ES", 0, "Ethernet status"),
];

impl FileType {
    /// The letters in addresses (`N`, `ST`, `HSC`), or `None` for types that have no address form.
    pub fn letters(self) -> Option<&'static str> {
        TABLE.iter().find(|row| row.0 == self).map(|row| row.1)
    }

    /// The type with these letters, upper or lower case.
    pub fn from_letters(letters: &str) -> Option<FileType> {
        TABLE.iter().find(|row| row.1.eq_ignore_ascii_case(letters)).map(|row| row.0)
    }

    /// 16-bit words per element where the type fixes it.
    pub fn words_per_element(self) -> Option<u16> {
        TABLE.iter().find(|row| row.0 == self && row.2 != 0).map(|row| row.2)
    }

    /// What the type holds, in words: `"timer"`.
    pub fn description(self) -> &'static str {
        match self {
            Reserved => "reserved",
            Unused => "unused",
            Unknown(_) => "unknown",
            _ => TABLE.iter().find(|row| row.0 == self).map_or("unknown", |row| row.3),
        }
    }

    /// Function files belong to the controller (HSC, RTC, ...); they are not data table files and
    /// an address leaves their number out when it is 0.
    pub fn is_function_file(self) -> bool {
        matches!(
            self,
            HSC | PTO | PTOX | PWM | PWMX | STI | EII | RTC | MMI | BHI | TPI | CS | DLS | DAT | LCD | IOS | ES
        )
    }

    /// The file number an address of this type has when none is written: O, I and S are always
    /// files 0, 1 and 2; most function files default to 0.
    pub fn implied_file(self) -> Option<u16> {
        match self {
            O => Some(0),
            I => Some(1),
            S => Some(2),
            M0 | M1 => Some(0),
            // One file per communication channel: its number is always written (`ES1:9`, `CS0:5`).
            CS | ES => None,
            t if t.is_function_file() => Some(0),
            _ => None,
        }
    }

    /// Bits that one addressable word of this type has: 32 for L and F, else 16.
    pub fn bits_per_word(self) -> u16 {
        if matches!(self, L | F) { 32 } else { 16 }
    }

    /// Elements are structures with named members (T, C, R, PD, MG, function files, ...).
    pub fn is_structure(self) -> bool {
        matches!(self, T | C | R | PD | MG | ST | RIX | PLS) || self.is_function_file()
    }
}

impl fmt::Display for FileType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unknown(code) => write!(f, "?{code}"),
            Reserved => f.write_str("RESERVED"),
            Unused => f.write_str("UNUSED"),
            other => f.write_str(other.letters().unwrap_or("?")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_unique_and_read_back() {
        for row in TABLE {
            assert_eq!(FileType::from_letters(row.1), Some(row.0));
            assert_eq!(FileType::from_letters(&row.1.to_lowercase()), Some(row.0));
        }
        assert_eq!(FileType::from_letters("Q"), None);
    }
}
