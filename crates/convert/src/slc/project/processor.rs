//! Processors and modules by the names in a text.

use ladder::{Confidence, Family, Module, Processor};
use rss::tables::{self, BaseUnit, ModuleName};

use crate::slc::file::{Slot, Start};

/// Words in the name of a processor and the family they mean, the more telling first. Catalogue
/// numbers are those of the vendor's catalogue.
const NAMES: &[(&str, Family)] = &[
    ("MICROLOGIX 1000", Family::MicroLogix1000),
    ("MICROLOGIX 1100", Family::MicroLogix1100),
    ("MICROLOGIX 1200", Family::MicroLogix1200),
    ("MICROLOGIX 1400", Family::MicroLogix1400),
    ("MICROLOGIX 1500", Family::MicroLogix1500),
    ("5/01", Family::Slc501),
    ("5/02", Family::Slc502),
    ("5/03", Family::Slc503),
    ("5/04", Family::Slc504),
    ("5/05", Family::Slc505),
    ("BUL.1761", Family::MicroLogix1000),
    ("BUL.1762", Family::MicroLogix1200),
    ("BUL.1763", Family::MicroLogix1100),
    ("BUL.1764", Family::MicroLogix1500),
    ("BUL.1766", Family::MicroLogix1400),
    ("1747-L20", Family::SlcFixed),
    ("1747-L30", Family::SlcFixed),
    ("1747-L40", Family::SlcFixed),
    ("1747-L51", Family::Slc501),
    ("1747-L52", Family::Slc502),
    ("1747-L53", Family::Slc503),
    ("1747-L54", Family::Slc504),
    ("1747-L55", Family::Slc505),
    ("1747-L1", Family::SlcFixed),
    ("SLC 500 FIXED", Family::SlcFixed),
];

/// The processor a START line names.
pub(super) fn processor(start: &Start, project_name: &str) -> Processor {
    // The description repeats the catalogue number, at times with letters behind it (`1747-L532B`),
    // which belong to the name.
    let repeated = start.description.strip_prefix(&start.catalog);
    let name = repeated.filter(|rest| rest.is_empty() || rest.starts_with(' ')).unwrap_or(&start.description).trim();
    let model = tables::PROCESSOR_MODELS.iter().find(|model| model.name.eq_ignore_ascii_case(name));
    let words = format!("{} {name}", start.catalog).to_ascii_uppercase();
    let family = NAMES.iter().find(|(part, _)| words.contains(part)).map(|(_, family)| *family);
    let family = family.or_else(|| model.and_then(|model| Family::from_id(model.family))).unwrap_or(Family::Unknown);
    let known = |text: &str| (!text.is_empty() && text != UNKNOWN).then(|| text.to_owned());
    Processor {
        model: model.map(|model| model.code),
        catalog: known(&start.catalog),
        name: known(name),
        family,
        family_confidence: if family == Family::Unknown { Confidence::Unknown } else { Confidence::Proven },
        evidence: "named in the START line of the text".to_owned(),
        project_name: project_name.to_owned(),
        ..Processor::default()
    }
}

/// The START line of a processor.
pub(super) fn start(processor: &Processor) -> Start {
    let catalog = processor.catalog.clone().unwrap_or_else(|| UNKNOWN.to_owned());
    let description = match &processor.name {
        Some(name) if name.starts_with(&catalog) => name.clone(),
        Some(name) => format!("{catalog:<12} {name}"),
        None => catalog.clone(),
    };
    Start { catalog, description }
}

/// Stands where a catalogue number belongs and none is known.
pub(super) const UNKNOWN: &str = "unknown";

/// The module in a slot. Slot 0 of a MicroLogix is the controller, whose kind of base unit the first
/// number after `IOCARD` states.
pub(super) fn module(slot: &Slot, is_controller: bool) -> Module {
    let catalog = (!slot.catalog.is_empty() && slot.catalog != UNKNOWN).then(|| slot.catalog.clone());
    let named = |name: &ModuleName| Some(name.catalog) == catalog.as_deref();
    let expansion = tables::EXPANSION_MODULES.iter().find(|(_, name)| named(name));
    let chassis = tables::SLC_MODULES.iter().find(|(_, name)| named(name));
    let identity = match (base_unit(slot), expansion, chassis) {
        (Some(unit), ..) if is_controller => format!("base unit 0x{:04X}", unit.0),
        (_, Some((id, _)), _) => format!("vendor {}, type {}, code {}", id.vendor, id.device_type, id.code),
        (_, _, Some((id, _))) => format!("ID {id}"),
        _ => String::new(),
    };
    Module {
        // The text itself names the module.
        confidence: if catalog.is_some() { Confidence::Proven } else { Confidence::Unknown },
        catalog,
        description: slot.description.clone(),
        identity,
    }
}

pub(super) fn base_unit(slot: &Slot) -> Option<BaseUnit> {
    let first = slot.io_card.as_ref()?.first()?;
    u16::try_from(*first).ok().map(BaseUnit)
}

/// Points of a module by its description (`8-Input 10/30 VDC`): inputs, outputs.
pub(super) fn points(description: &str) -> (Option<u16>, Option<u16>) {
    let mut found = (None, None);
    for word in description.split([' ', '/', ',']) {
        let Some((number, kind)) = word.split_once('-') else { continue };
        let Ok(number) = number.parse() else { continue };
        if kind.to_ascii_lowercase().starts_with("input") {
            found.0 = Some(number);
        } else if kind.to_ascii_lowercase().starts_with("output") {
            found.1 = Some(number);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_the_family() {
        for (catalog, description, family, name, model) in [
            (
                "Bul.1766",
                "Bul.1766     MicroLogix 1400 Series A",
                Family::MicroLogix1400,
                Some("MicroLogix 1400 Series A"),
                Some(62),
            ),
            (
                "1747-L532",
                "1747-L532C/D  5/03 CPU - 16K Mem.",
                Family::Slc503,
                Some("1747-L532C/D  5/03 CPU - 16K Mem."),
                None,
            ),
            ("1747-L552", "", Family::Slc505, None, None),
            ("unknown", "unknown", Family::Unknown, None, None),
        ] {
            let read = processor(&Start { catalog: catalog.to_owned(), description: description.to_owned() }, "P");
            assert_eq!((read.family, read.name.as_deref(), read.model), (family, name, model), "{catalog}");
            assert_eq!(processor(&super::start(&read), "P"), read, "{catalog}");
        }
    }

    #[test]
    fn every_known_model_is_found_by_its_own_line() {
        for model in tables::PROCESSOR_MODELS {
            let known = Processor {
                catalog: Some(model.catalog.to_owned()),
                name: Some(model.name.to_owned()),
                ..Processor::default()
            };
            let read = processor(&start(&known), "");
            assert_eq!((read.model, read.catalog, read.name), (Some(model.code), known.catalog, known.name));
            assert_ne!(read.family, Family::Unknown, "{}", model.name);
        }
    }

    #[test]
    fn descriptions_tell_points() {
        assert_eq!(points("8-Input 10/30 VDC"), (Some(8), None));
        assert_eq!(points("16-Output (TRANS-SRC) 10/50 VDC"), (None, Some(16)));
        assert_eq!(points("8-Input 6-Output Relay"), (Some(8), Some(6)));
        assert_eq!(points("Analog"), (None, None));
    }
}
