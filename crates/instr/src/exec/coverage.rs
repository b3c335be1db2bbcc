//! What is not exactly known about what instructions compute, in words for reports.
//!
//! An instruction that is in neither list computes by rules of this module that documents or inference
//! give, apart from the single questions of [`choices`](super::choices). What depends on a scan engine,
//! a network or hardware is the business of the caller.

/// Why results of an instruction can differ from the controller's, or `None`.
pub fn approximation(mnemonic: &str) -> Option<&'static str> {
    find(APPROXIMATE, mnemonic)
}

/// Why an instruction cannot be computed at all: no page describes what it works on. `None` for the
/// others.
pub fn undocumented(mnemonic: &str) -> Option<&'static str> {
    find(UNDOCUMENTED, mnemonic)
}

fn find(list: &[(&str, &'static str)], mnemonic: &str) -> Option<&'static str> {
    list.iter().find(|row| row.0 == mnemonic).map(|row| row.1)
}

const LAST_BIT: &str = "the last bit of the result can differ: the controller's mathematical library is not documented";

const APPROXIMATE: &[(&str, &str)] = &[
    (
        "PID",
        "the equation is documented, how the controller cuts it into updates is not: its results can differ in detail",
    ),
    ("CPT", "the precision between the steps of an expression is not documented"),
    ("SIN", LAST_BIT),
    ("COS", LAST_BIT),
    ("TAN", LAST_BIT),
    ("ASN", LAST_BIT),
    ("ACS", LAST_BIT),
    ("ATN", LAST_BIT),
    ("LN", LAST_BIT),
    ("LOG", LAST_BIT),
    ("XPY", LAST_BIT),
];

const UNDOCUMENTED: &[(&str, &str)] = &[
    // SLC 4-22 was seen: it validates its parameters and ramps while the rung is true, holds its time while it is false,
    // and is retentive. The pages before it, with the seven words, were not.
    ("RMP", "no page with the layout of its control block and the equations of its curves was found"),
    ("RPC", "how the controller computes the checksum of a program was not found"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_an_instruction() {
        for (mnemonic, why) in APPROXIMATE.iter().chain(UNDOCUMENTED) {
            assert!(crate::by_mnemonic(mnemonic).is_some(), "{mnemonic}");
            assert!(!why.is_empty() && !why.ends_with('.'));
        }
        assert!(approximation("PID").is_some() && approximation("ADD").is_none());
        assert!(undocumented("RMP").is_some() && undocumented("FBC").is_none());
    }
}
