//! The I/O configuration, and which module point an I/O address means.

use crate::{Address, Confidence, FileType, Place};

/// Slots of a controller or chassis.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct IoConfiguration {
    /// Slots in use, ascending; slot 0 is the controller itself on fixed and MicroLogix units, and
    /// the processor in a chassis.
    pub slots: Vec<Slot>,
    /// The kind of base unit by the letters of its catalogue number (`BWA`), which are inferred from
    /// stored digits and never printed; empty if not stated.
    pub base_unit: String,
    /// Why nothing or not everything is known, when that is so: shown beside the slots.
    pub unknown: Option<String>,
}

/// One slot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slot {
    /// Slot number.
    pub number: u16,
    /// What sits in it.
    pub module: Module,
    /// Its part of file I.
    pub inputs: IoRange,
    /// Its part of file O.
    pub outputs: IoRange,
    /// Configuration words (filters, ranges), as stored.
    pub configuration: Vec<u16>,
}

/// Words and bits of a slot in file I or O.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct IoRange {
    /// First word in the data file.
    pub first_word: u16,
    /// Number of words.
    pub words: u16,
    /// Bits in use; a multiple of 16 when all bits of the words are.
    pub bits: u16,
}

/// The identity of a module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Module {
    /// Catalogue number (`1762-IQ8`), or `None` if unknown.
    pub catalog: Option<String>,
    /// What it is, in words; for an unknown module what its counts tell.
    pub description: String,
    /// The stored identity: `vendor 1, type 7, code 96` or `ID 500`.
    pub identity: String,
    /// How sure the catalogue number is.
    pub confidence: Confidence,
}

/// The point or word an I/O address resolves to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Point<'a> {
    /// The slot.
    pub slot: &'a Slot,
    /// Word inside the slot.
    pub word: u16,
    /// Bit inside the word, if the address has one.
    pub bit: Option<u16>,
    /// Index of the word in data file I or O.
    pub word_index: u16,
    /// The slot has this word and bit in use. `false` when a bit lies beyond the module's points.
    pub in_range: bool,
}

impl IoConfiguration {
    /// Slot, word and bit of a direct I or O address; `None` if there is no such slot or word, or
    /// the address is not one of I/O.
    pub fn resolve(&self, address: &Address) -> Option<Point<'_>> {
        let slot_number = address.element.number()?;
        let slot = self.slots.iter().find(|slot| slot.number == slot_number)?;
        let range = match address.file_type {
            FileType::I => slot.inputs,
            FileType::O => slot.outputs,
            _ => return None,
        };
        let word = address.word.unwrap_or(0);
        let bit = match &address.bit {
            None => None,
            Some(Place::Number(bit)) => Some(*bit),
            Some(Place::Indirect(_)) => None,
        };
        if word >= range.words {
            return None;
        }
        let position = u32::from(word) * 16 + u32::from(bit.unwrap_or(0));
        Some(Point {
            slot,
            word,
            bit,
            word_index: range.first_word.checked_add(word)?,
            in_range: bit.is_none() || position < u32::from(range.bits),
        })
    }

    /// Index of the addressed word in data file I or O.
    pub fn word_index(&self, address: &Address) -> Option<u16> {
        self.resolve(address).map(|point| point.word_index)
    }

    /// Module and point of an I/O address in words, or that there is none; `None` for addresses that are
    /// not of I/O or are decided at run time.
    pub fn describe(&self, address: &Address) -> Option<String> {
        let Some(point) = self.resolve(address) else {
            let slot = address.element.number().filter(|_| address.file_type.has_slots() && address.is_direct())?;
            return Some(match self.slots.iter().any(|of| of.number == slot) {
                _ if self.unknown.is_some() => format!("slot {slot}, I/O configuration not understood"),
                true => format!("slot {slot}, the module has no such word"),
                false => format!("no module in slot {slot}"),
            });
        };
        let module = &point.slot.module;
        let name = module.catalog.as_deref().unwrap_or("unknown module");
        let bit =
            point.bit.map(|bit| format!(" point {}", u32::from(point.word) * 16 + u32::from(bit))).unwrap_or_default();
        let beyond = if point.in_range { "" } else { " (the module has no such point)" };
        Some(format!("slot {} {name}, word {}{bit}{beyond}", point.slot.number, point.word))
    }

    /// The address of a word of file I or O, the way the program writes it.
    pub fn address_of(&self, file_type: FileType, word_index: u16) -> Option<Address> {
        let file = file_type.implied_file()?;
        self.slots.iter().find_map(|slot| {
            let range = if file_type == FileType::I { slot.inputs } else { slot.outputs };
            let word = word_index.checked_sub(range.first_word).filter(|word| *word < range.words)?;
            Some(Address::element(file_type, file, slot.number).with_word(word))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_resolve_to_points() {
        let module = Module {
            catalog: None,
            description: "24 inputs".into(),
            identity: "ID 2100".into(),
            confidence: Confidence::Inferred,
        };
        let slot = Slot {
            number: 2,
            module,
            inputs: IoRange { first_word: 3, words: 2, bits: 24 },
            outputs: IoRange::default(),
            configuration: Vec::new(),
        };
        let io = IoConfiguration { slots: vec![slot], ..Default::default() };
        let resolve = |text: &str| io.resolve(&Address::parse(text).expect("address"));
        let point = resolve("I:2/20").expect("point");
        assert_eq!((point.word, point.bit, point.word_index, point.in_range), (1, Some(4), 4, true));
        assert!(!resolve("I:2.1/9").expect("point").in_range);
        assert_eq!(resolve("I:2.2/0"), None);
        assert_eq!(resolve("O:2.0/0"), None);
        assert_eq!(resolve("I:1.0/0"), None);
        assert_eq!(io.address_of(FileType::I, 4).map(|a| a.to_string()).as_deref(), Some("I:2.1"));
        assert_eq!(io.address_of(FileType::I, 0), None);
    }
}
