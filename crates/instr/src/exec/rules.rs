//! Which processor's rules apply.

use ladder::Family;

use super::choices::{Choice, Choices};

/// Families that execute alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Lineage {
    /// SLC 500 fixed and 5/01.
    S1,
    /// SLC 5/02.
    S2,
    /// SLC 5/03, 5/04, 5/05.
    S3,
    /// MicroLogix 1000: a small 5/02 in math, status file and interrupts.
    M10,
    /// MicroLogix 1100, 1200, 1400, 1500: long integers, function files.
    Mx,
}

impl Lineage {
    /// The lineage of a family. An unknown family counts as SLC 5/03, which has most of what is common.
    pub const fn of(family: Family) -> Lineage {
        match family {
            Family::SlcFixed | Family::Slc501 => Lineage::S1,
            Family::Slc502 => Lineage::S2,
            Family::Slc503 | Family::Slc504 | Family::Slc505 | Family::Unknown => Lineage::S3,
            Family::MicroLogix1000 => Lineage::M10,
            Family::MicroLogix1100 | Family::MicroLogix1200 | Family::MicroLogix1400 | Family::MicroLogix1500 => {
                Lineage::Mx
            }
        }
    }

    /// SLC 500 and MicroLogix 1000, one lineage as opposed to the later MicroLogix.
    pub const fn is_slc_like(self) -> bool {
        !matches!(self, Lineage::Mx)
    }
}

/// The rules an execution follows: fixed for a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rules {
    /// The processor.
    pub lineage: Lineage,
    /// Readings where documentation ends.
    pub choices: Choices,
}

impl Rules {
    /// Rules of a family with the default readings.
    pub fn of(family: Family) -> Rules {
        Rules { lineage: Lineage::of(family), choices: Choices::default() }
    }

    /// Rules of a lineage with the default readings.
    pub fn new(lineage: Lineage) -> Rules {
        Rules { lineage, choices: Choices::default() }
    }

    /// The same rules with one reading switched.
    #[must_use]
    pub const fn with(self, choice: Choice) -> Rules {
        Rules { choices: self.choices.with(choice), ..self }
    }

    /// The reading is switched from its default.
    pub const fn has(self, choice: Choice) -> bool {
        self.choices.has(choice)
    }

    /// How arithmetic works with the status word S:2 as it is now.
    ///
    /// Bit 14 keeps the low bits of an overflown result instead of limiting it: printed for
    /// SLC 5/02 and higher and MicroLogix; fixed and 5/01 always limit (inferred).
    #[inline]
    pub const fn math(self, s2: u16) -> MathMode {
        MathMode { rules: self, wrap: s2 & 1 << 14 != 0 && !matches!(self.lineage, Lineage::S1) }
    }
}

/// How arithmetic works at this moment: the rules and the state of S:2/14.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MathMode {
    /// The rules.
    pub rules: Rules,
    /// An integer result that does not fit keeps its low bits instead of being limited.
    pub wrap: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overflow_selection_needs_a_processor_that_has_it() {
        assert!(!Rules::of(Family::Slc501).math(0x4000).wrap);
        for family in [Family::Slc502, Family::Slc505, Family::MicroLogix1000, Family::MicroLogix1400] {
            assert!(Rules::of(family).math(0x4000).wrap, "{family:?}");
            assert!(!Rules::of(family).math(0xBFFF).wrap, "{family:?}");
        }
    }
}
