//! Sets of controllers that have an instruction.

use std::fmt;
use std::ops::BitOr;

use ladder::Family;

/// A set of controller families.
///
/// A family in the set has the instruction according to the manuals or because a project for it uses
/// it. Firmware matters too (ABS came to the MicroLogix 1200 with series C), so a family being absent
/// is a hint, not a proof.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Families(u16);

/// Bit of each family, in the order used for display, with a short name.
const BITS: [(Family, &str); 11] = [
    (Family::SlcFixed, "SLC fixed"),
    (Family::Slc501, "5/01"),
    (Family::Slc502, "5/02"),
    (Family::Slc503, "5/03"),
    (Family::Slc504, "5/04"),
    (Family::Slc505, "5/05"),
    (Family::MicroLogix1000, "ML 1000"),
    (Family::MicroLogix1100, "ML 1100"),
    (Family::MicroLogix1200, "ML 1200"),
    (Family::MicroLogix1400, "ML 1400"),
    (Family::MicroLogix1500, "ML 1500"),
];

impl Families {
    /// No family at all.
    pub const NONE: Families = Families(0);
    /// Every SLC 500 and MicroLogix.
    pub const ALL: Families = Families(0x07FF);
    /// SLC 500 fixed controllers.
    pub const SLC_FIXED: Families = Families(1);
    /// SLC 5/02.
    pub const SLC_5_02: Families = Families(1 << 2);
    /// SLC 5/03, 5/04 and 5/05.
    pub const SLC_5_03_UP: Families = Families(0b11_1000);
    /// SLC 5/05.
    pub const SLC_5_05: Families = Families(1 << 5);
    /// SLC 5/02 and higher.
    pub const SLC_5_02_UP: Families = Families(0b11_1100);
    /// Every SLC 500, fixed or chassis.
    pub const SLC: Families = Families(0b11_1111);
    /// MicroLogix 1000.
    pub const ML_1000: Families = Families(1 << 6);
    /// MicroLogix 1100.
    pub const ML_1100: Families = Families(1 << 7);
    /// MicroLogix 1200.
    pub const ML_1200: Families = Families(1 << 8);
    /// MicroLogix 1400.
    pub const ML_1400: Families = Families(1 << 9);
    /// MicroLogix 1500.
    pub const ML_1500: Families = Families(1 << 10);
    /// MicroLogix 1100, 1200, 1400 and 1500: function files, long integers, own status file.
    pub const ML_FUNCTION_FILES: Families = Families(0b111_1000_0000);

    /// The set of one family; an unknown family could be any.
    pub fn of(family: Family) -> Families {
        match BITS.iter().position(|(f, _)| *f == family) {
            Some(bit) => Families(1 << bit),
            None => Families::ALL,
        }
    }

    /// Both sets together, usable in constants.
    pub const fn and(self, other: Families) -> Families {
        Families(self.0 | other.0)
    }

    /// `family` is in the set. An unknown family is in every set that is not empty.
    pub fn contains(self, family: Family) -> bool {
        self.0 & Families::of(family).0 != 0
    }

    /// The sets have a family in common.
    pub const fn overlaps(self, other: Families) -> bool {
        self.0 & other.0 != 0
    }

    /// Every family of `other` is in this set.
    pub const fn covers(self, other: Families) -> bool {
        self.0 & other.0 == other.0
    }

    /// No family is in the set.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The families of the set, SLC 500 first.
    pub fn iter(self) -> impl Iterator<Item = Family> {
        BITS.iter().enumerate().filter(move |(bit, _)| self.0 & (1 << bit) != 0).map(|(_, (family, _))| *family)
    }
}

impl BitOr for Families {
    type Output = Families;

    fn bitor(self, other: Families) -> Families {
        self.and(other)
    }
}

/// Groups named as one where all of their members are in the set.
const GROUPS: [(Families, &str); 6] = [
    (Families::ALL, "all"),
    (Families::SLC, "all SLC 500"),
    (Families::SLC_5_02_UP, "SLC 5/02 and up"),
    (Families::SLC_5_03_UP, "SLC 5/03 and up"),
    (Families(0b111_1100_0000), "all MicroLogix"),
    (Families::ML_FUNCTION_FILES, "MicroLogix 1100 to 1500"),
];

impl fmt::Display for Families {
    /// `SLC 5/02 and up, ML 1000`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut left = self.0;
        let mut separator = "";
        for (group, name) in GROUPS {
            if left & group.0 == group.0 {
                write!(f, "{separator}{name}")?;
                left &= !group.0;
                separator = ", ";
            }
        }
        for (bit, (_, name)) in BITS.iter().enumerate() {
            if left & (1 << bit) != 0 {
                write!(f, "{separator}{name}")?;
                separator = ", ";
            }
        }
        if separator.is_empty() { f.write_str("none") } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_name_the_families_they_say() {
        assert_eq!(Families::ALL.iter().count(), BITS.len());
        assert_eq!(Families::of(Family::SlcFixed), Families::SLC_FIXED);
        assert_eq!(Families::of(Family::Slc502), Families::SLC_5_02);
        assert_eq!(Families::of(Family::Slc505), Families::SLC_5_05);
        assert_eq!(Families::of(Family::MicroLogix1000), Families::ML_1000);
        assert_eq!(Families::of(Family::MicroLogix1100), Families::ML_1100);
        assert_eq!(Families::of(Family::MicroLogix1200), Families::ML_1200);
        assert_eq!(Families::of(Family::MicroLogix1400), Families::ML_1400);
        assert_eq!(Families::of(Family::MicroLogix1500), Families::ML_1500);
        assert!(Families::SLC_5_03_UP.contains(Family::Slc503) && !Families::SLC_5_03_UP.contains(Family::Slc502));
        assert!(Families::ML_FUNCTION_FILES.contains(Family::Unknown) && !Families::NONE.contains(Family::Unknown));
        assert_eq!(Families::ALL.and(Families::NONE), Families::ALL);
    }

    #[test]
    fn names_are_short() {
        assert_eq!(Families::ALL.to_string(), "all");
        assert_eq!((Families::SLC_5_02_UP | Families::ML_1000).to_string(), "SLC 5/02 and up, ML 1000");
        assert_eq!((Families::SLC_5_03_UP | Families::ML_1400).to_string(), "SLC 5/03 and up, ML 1400");
        assert_eq!(Families::NONE.to_string(), "none");
    }
}
