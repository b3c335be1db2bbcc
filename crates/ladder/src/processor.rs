//! The processor a program is written for.

use std::fmt;

/// Controllers that share an instruction set and behaviour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Family {
    /// SLC 500 fixed controllers (1747-L20, L30, L40).
    SlcFixed,
    /// SLC 5/01.
    Slc501,
    /// SLC 5/02.
    Slc502,
    /// SLC 5/03.
    Slc503,
    /// SLC 5/04.
    Slc504,
    /// SLC 5/05.
    Slc505,
    /// MicroLogix 1000.
    MicroLogix1000,
    /// MicroLogix 1100.
    MicroLogix1100,
    /// MicroLogix 1200.
    MicroLogix1200,
    /// MicroLogix 1400.
    MicroLogix1400,
    /// MicroLogix 1500.
    MicroLogix1500,
    /// Not known from the project.
    Unknown,
}

const FAMILIES: &[(Family, &str, &str)] = &[
    (Family::SlcFixed, "slc-500-fixed", "SLC 500 fixed"),
    (Family::Slc501, "slc-5/01", "SLC 5/01"),
    (Family::Slc502, "slc-5/02", "SLC 5/02"),
    (Family::Slc503, "slc-5/03", "SLC 5/03"),
    (Family::Slc504, "slc-5/04", "SLC 5/04"),
    (Family::Slc505, "slc-5/05", "SLC 5/05"),
    (Family::MicroLogix1000, "micrologix-1000", "MicroLogix 1000"),
    (Family::MicroLogix1100, "micrologix-1100", "MicroLogix 1100"),
    (Family::MicroLogix1200, "micrologix-1200", "MicroLogix 1200"),
    (Family::MicroLogix1400, "micrologix-1400", "MicroLogix 1400"),
    (Family::MicroLogix1500, "micrologix-1500", "MicroLogix 1500"),
    (Family::Unknown, "unknown", "unknown"),
];

impl Family {
    /// All families, `Unknown` last.
    pub fn all() -> impl Iterator<Item = Family> {
        FAMILIES.iter().map(|row| row.0)
    }

    /// The identifier in files and JSON: `micrologix-1100`, `slc-5/03`.
    pub fn id(self) -> &'static str {
        FAMILIES.iter().find(|row| row.0 == self).map_or("unknown", |row| row.1)
    }

    /// The name people use: `MicroLogix 1100`.
    pub fn name(self) -> &'static str {
        FAMILIES.iter().find(|row| row.0 == self).map_or("unknown", |row| row.2)
    }

    /// Reads an identifier.
    pub fn from_id(id: &str) -> Option<Family> {
        FAMILIES.iter().find(|row| row.1 == id).map(|row| row.0)
    }

    /// One of the MicroLogix controllers.
    pub fn is_micrologix(self) -> bool {
        matches!(
            self,
            Family::MicroLogix1000
                | Family::MicroLogix1100
                | Family::MicroLogix1200
                | Family::MicroLogix1400
                | Family::MicroLogix1500
        )
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// How sure a name or meaning is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Confidence {
    /// No evidence: shown as unknown with its code.
    Unknown,
    /// One indirect sign.
    Weak,
    /// Consistent everywhere, never printed.
    Inferred,
    /// Stands in a published document.
    Published,
    /// Holds in every known project, or printed by RSLogix itself.
    Proven,
}

impl Confidence {
    /// Lower-case word used in outputs.
    pub fn as_str(self) -> &'static str {
        match self {
            Confidence::Unknown => "unknown",
            Confidence::Weak => "weak",
            Confidence::Inferred => "inferred",
            Confidence::Published => "published",
            Confidence::Proven => "proven",
        }
    }
}

/// The processor of an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Processor {
    /// Model number the project stores, if it came from one.
    pub model: Option<u16>,
    /// Catalogue number as printed: `Bul.1763`; `None` if unknown.
    pub catalog: Option<String>,
    /// Name as printed: `MicroLogix 1100 Series B`; `None` if unknown.
    pub name: Option<String>,
    /// Family.
    pub family: Family,
    /// How sure `family` is.
    pub family_confidence: Confidence,
    /// Why model, name and family are believed, in words.
    pub evidence: String,
    /// The processor name an engineer gave (printed *Processor Name*).
    pub project_name: String,
    /// Name of the main program, often empty.
    pub main_program: String,
    /// Program ID, printed in hex.
    pub program_id: Option<u16>,
    /// Type number the processor of the last connection reported.
    pub reported_type: Option<u16>,
    /// Communication driver name.
    pub driver: String,
    /// `HOST!DRIVER\address` of the last connection, or empty.
    pub route: String,
    /// Status bit S:1/14 "deny future access" is set.
    pub deny_future_access: Option<bool>,
    /// Fields where a password could be stored are not all zero. The fields' content is never shown.
    pub password_fields_used: Option<bool>,
}

impl Default for Processor {
    fn default() -> Self {
        Processor {
            model: None,
            catalog: None,
            name: None,
            family: Family::Unknown,
            family_confidence: Confidence::Unknown,
            evidence: String::new(),
            project_name: String::new(),
            main_program: String::new(),
            program_id: None,
            reported_type: None,
            driver: String::new(),
            route: String::new(),
            deny_future_access: None,
            password_fields_used: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_read_back() {
        for family in Family::all() {
            assert_eq!(Family::from_id(family.id()), Some(family));
        }
    }
}
