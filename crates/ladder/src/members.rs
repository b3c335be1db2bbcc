//! Named members of structured elements: `T4:0.ACC`, `C5:1/DN`, `PD25:0.CVP`.
//!
//! The one table that spelling, parsing, documentation keys and compiled code all use. Each row was
//! either read in compiled code or a printed report beside its name, or stands in the published
//! data file layouts of the processors (`evidence` says which).

use crate::FileType::{self, *};

/// A named word or bit of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Member {
    /// The file type whose elements have this member.
    pub file_type: FileType,
    /// The name as RSLogix spells it, case included (`Ti`).
    pub name: &'static str,
    /// Word number inside the element.
    pub word: u16,
    /// Bit inside that word, or `None` when the member is the word itself.
    pub bit: Option<u16>,
    /// The member spans two words (a 32-bit value, low word first).
    pub long: bool,
    /// Seen in a project's code or a vendor printout; `false`: only from published layouts.
    pub seen: bool,
}

const fn word(file_type: FileType, name: &'static str, word: u16, seen: bool) -> Member {
    Member { file_type, name, word, bit: None, long: false, seen }
}
const fn long(file_type: FileType, name: &'static str, word: u16, seen: bool) -> Member {
    Member { file_type, name, word, bit: None, long: true, seen }
}
const fn bit(file_type: FileType, name: &'static str, word: u16, bit: u16, seen: bool) -> Member {
    Member { file_type, name, word, bit: Some(bit), long: false, seen }
}

const TABLE: &[Member] = &[
    bit(T, "EN", 0, 15, true),
    bit(T, "TT", 0, 14, true),
    bit(T, "DN", 0, 13, true),
    word(T, "PRE", 1, true),
    word(T, "ACC", 2, true),
    bit(C, "CU", 0, 15, true),
    bit(C, "CD", 0, 14, false),
    bit(C, "DN", 0, 13, true),
    bit(C, "OV", 0, 12, false),
    bit(C, "UN", 0, 11, false),
    bit(C, "UA", 0, 10, false),
    word(C, "PRE", 1, true),
    word(C, "ACC", 2, true),
    bit(R, "EN", 0, 15, true),
    bit(R, "EU", 0, 14, false),
    bit(R, "DN", 0, 13, true),
    bit(R, "EM", 0, 12, false),
    bit(R, "ER", 0, 11, false),
    bit(R, "UL", 0, 10, true),
    bit(R, "IN", 0, 9, false),
    bit(R, "FD", 0, 8, false),
    word(R, "LEN", 1, true),
    word(R, "POS", 2, false),
    word(ST, "LEN", 0, true),
    bit(PD, "TM", 0, 0, true),
    bit(PD, "AM", 0, 1, true),
    bit(PD, "CM", 0, 2, true),
    bit(PD, "OL", 0, 3, true),
    bit(PD, "RG", 0, 4, false),
    bit(PD, "SC", 0, 5, false),
    bit(PD, "TF", 0, 6, false),
    bit(PD, "DA", 0, 7, false),
    bit(PD, "DB", 0, 8, false),
    bit(PD, "UL", 0, 9, false),
    bit(PD, "LL", 0, 10, false),
    bit(PD, "SP", 0, 11, false),
    bit(PD, "PV", 0, 12, false),
    bit(PD, "DN", 0, 13, false),
    bit(PD, "EN", 0, 15, false),
    word(PD, "SPS", 2, true),
    word(PD, "KC", 3, true),
    word(PD, "Ti", 4, true),
    word(PD, "TD", 5, true),
    word(PD, "FF", 6, false),
    word(PD, "MAXS", 7, true),
    word(PD, "MINS", 8, false),
    word(PD, "ZCD", 9, false),
    word(PD, "CVH", 11, true),
    word(PD, "CVL", 12, true),
    word(PD, "LUT", 13, true),
    word(PD, "SPV", 14, false),
    word(PD, "SE", 15, false),
    word(PD, "CVP", 16, true),
    word(MG, "NOD", 9, true),
    word(MG, "MTO", 10, true),
    bit(MG, "TO", 16, 8, true),
    bit(MG, "EN", 16, 15, true),
    bit(MG, "EW", 17, 10, false),
    bit(MG, "ER", 17, 12, true),
    bit(MG, "DN", 17, 13, true),
    bit(MG, "ST", 17, 14, false),
    word(HSC, "PFN", 0, false),
    word(HSC, "ER", 1, false),
    bit(HSC, "UIX", 2, 0, false),
    bit(HSC, "UIE", 2, 1, false),
    bit(HSC, "UIL", 2, 2, false),
    bit(HSC, "UIP", 2, 3, false),
    bit(HSC, "FE", 2, 4, true),
    bit(HSC, "AS", 2, 5, false),
    bit(HSC, "ED", 2, 6, false),
    bit(HSC, "CE", 2, 11, true),
    bit(HSC, "SP", 2, 15, true),
    word(HSC, "MOD", 4, false),
    long(HSC, "ACC", 5, true),
    long(HSC, "HIP", 7, true),
    long(HSC, "LOP", 9, false),
    long(HSC, "OVF", 11, false),
    long(HSC, "UNF", 13, false),
    word(HSC, "OMB", 15, false),
    word(HSC, "HPO", 16, false),
    word(HSC, "LPO", 17, false),
    word(TPI, "POT0", 0, true),
    word(TPI, "POT1", 1, true),
    word(RTC, "YR", 0, true),
    word(RTC, "MON", 1, true),
    word(RTC, "DAY", 2, true),
    word(RTC, "HR", 3, true),
    word(RTC, "MIN", 4, true),
    word(RTC, "SEC", 5, true),
    word(RTC, "DOW", 6, true),
    word(EII, "PFN", 0, true),
    word(EII, "ER", 1, false),
    bit(EII, "UIX", 2, 0, false),
    bit(EII, "UIE", 2, 1, false),
    bit(EII, "UIL", 2, 2, false),
    bit(EII, "UIP", 2, 3, false),
    bit(EII, "EIE", 2, 4, false),
    bit(EII, "AS", 2, 5, false),
    bit(EII, "ED", 2, 6, false),
    bit(EII, "ES", 2, 14, false),
    word(EII, "EIS", 3, true),
    word(STI, "PFN", 0, false),
    word(STI, "ER", 1, false),
    bit(STI, "UIX", 2, 0, false),
    bit(STI, "UIE", 2, 1, false),
    bit(STI, "UIL", 2, 2, false),
    bit(STI, "UIP", 2, 3, false),
    bit(STI, "TIE", 2, 4, false),
    bit(STI, "AS", 2, 5, false),
    bit(STI, "ED", 2, 6, false),
    word(STI, "SPM", 3, false),
    bit(PTO, "CS", 1, 5, true),
];

/// Second names: bit 9 of a control element is IN for shifts and sequencers and RN for ASCII ports
/// (1747-RM001G 1-8). Such a name is read; what is written is the name of the table.
const ALIASES: [(FileType, &str, &str); 1] = [(R, "RN", "IN")];

/// All members of a type, in word and bit order of the table.
pub fn members_of(file_type: FileType) -> impl Iterator<Item = &'static Member> {
    TABLE.iter().filter(move |m| m.file_type == file_type)
}

/// The member a person means by `name`, upper or lower case.
pub fn member_by_name(file_type: FileType, name: &str) -> Option<&'static Member> {
    let alias = ALIASES.iter().find(|row| row.0 == file_type && row.1.eq_ignore_ascii_case(name));
    let name = alias.map_or(name, |row| row.2);
    members_of(file_type).find(|m| m.name.eq_ignore_ascii_case(name))
}

/// The member at this word and bit; `word` `None` means the first flag word of the type, the way
/// addresses like `T4:0/DN` leave it out.
pub fn member_name(file_type: FileType, word: u16, bit: Option<u16>) -> Option<&'static Member> {
    members_of(file_type).find(|m| m.word == word && m.bit == bit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn second_names_lead_to_members() {
        for (file_type, alias, name) in ALIASES {
            let member = member_by_name(file_type, &alias.to_lowercase()).expect(alias);
            assert_eq!(member.name, name);
            assert!(members_of(file_type).all(|member| member.name != alias), "{alias}");
        }
    }

    #[test]
    fn names_and_places_are_unique_per_type() {
        for (index, a) in TABLE.iter().enumerate() {
            for b in &TABLE[index + 1..] {
                if a.file_type == b.file_type {
                    assert!(!a.name.eq_ignore_ascii_case(b.name), "{a:?} {b:?}");
                    assert!((a.word, a.bit) != (b.word, b.bit), "{a:?} {b:?}");
                }
            }
        }
    }
}
