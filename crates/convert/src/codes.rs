//! Data file type numbers of project files and the letters they stand for.

use ladder::FileType::{self, *};

/// Number in the data file record and in compiled code, and the type. Evidence for each row is in
/// `docs/format/data-files.md`. 11 and 15 have never been seen.
const TYPES: &[(u16, FileType)] = &[
    (0, O),
    (1, I),
    (2, S),
    (3, B),
    (4, T),
    (5, C),
    (6, R),
    (7, N),
    (8, F),
    (9, Reserved),
    (10, Unused),
    (12, M1),
    (13, M0),
    (14, ST),
    (16, L),
    (17, HSC),
    (18, PTO),
    (19, MG),
    (20, STI),
    (21, EII),
    (22, PD),
    (23, RTC),
    (24, BHI),
    (25, MMI),
    (27, TPI),
    (28, CS),
    (29, IOS),
    (30, PWM),
    (31, DLS),
    (38, LCD),
    (39, ES),
    (44, RIX),
    (45, PTOX),
    (46, PWMX),
];

/// The type with this number; an unlisted number keeps it.
pub(crate) fn file_type(code: u16) -> FileType {
    TYPES.iter().find(|row| row.0 == code).map_or(Unknown(code), |row| row.1)
}

/// The number of a type, `None` for types no project has been seen to store.
pub(crate) fn type_code(file_type: FileType) -> Option<u16> {
    match file_type {
        Unknown(code) => Some(code),
        known => TYPES.iter().find(|row| row.1 == known).map(|row| row.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_types_are_unique() {
        for code in 0..=u16::from(u8::MAX) {
            assert_eq!(type_code(file_type(code)), Some(code));
        }
        for (index, row) in TYPES.iter().enumerate() {
            assert!(TYPES[index + 1..].iter().all(|other| other.0 != row.0 && other.1 != row.1));
        }
    }
}
