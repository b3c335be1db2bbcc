//! What the controller itself makes of data that an operator or another device writes: the clock refuses
//! dates that do not exist, and keys of the data access tool toggle their latches. And the names of
//! bits whose place in their function file nobody has published.

use ladder::{Address, Element, FileType, Image, Operand, Series};

use crate::Machine;
use crate::family::Lineage;

/// Members known by name only (1200UM 6-2, 1500UM chapter 5): type, name, and the word and bit the
/// simulator keeps them at. The data model has no such places, so that nothing is written to a
/// project file or printed on the strength of them.
const NAMED: [(FileType, &str, u16, u16); 6] = [
    (FileType::RTC, "DS", 7, 0),
    (FileType::RTC, "BL", 7, 1),
    (FileType::DAT, "F1P", 127, 0),
    (FileType::DAT, "F1L", 127, 1),
    (FileType::DAT, "F2P", 127, 2),
    (FileType::DAT, "F2L", 127, 3),
];

/// Status and command bits of a pulse train output (1100 p.136-137, 1400 p.146, some recalled): done, decelerating, run,
/// accelerating, ramp profile, idle, error, normal operation, jog pulse and jog continuous with their
/// states, enable hard stop, enabled. CS, the one whose place is known, is in the data model.
const TRAIN: [&str; 14] = ["DN", "DS", "RS", "AS", "RP", "IS", "ED", "NS", "JPS", "JCS", "JP", "JC", "EH", "EN"];
/// Those of a pulse width output (1200 6-10, some recalled).
const WIDTH: [&str; 9] = ["DS", "RS", "AS", "PP", "IS", "ED", "NS", "EH", "EN"];

/// The word behind the elements of pulse outputs where the simulator keeps these bits: projects store 8 to
/// 15 words.
pub(crate) const PULSE_WORD: u16 = 15;

/// Pulse outputs, whose elements are [`PULSE_WORD`] words and the one behind them here.
pub(crate) const PULSES: [FileType; 4] = [FileType::PTO, FileType::PTOX, FileType::PWM, FileType::PWMX];

/// Least and greatest value of the words of RTC:0 from the year to the second (1200 3-3).
const CLOCK: [(u16, u16); 6] = [(1998, 2097), (1, 12), (1, 31), (0, 23), (0, 59), (0, 59)];

/// `I/23` and `O0/5`: bits counted through the words of the controller's own points, slot 0. Which
/// word of a chassis it is depends on the I/O configuration, so the data model reads no such text.
fn linear(text: &str) -> Option<Address> {
    let (file, bit) = text.split_once('/')?;
    let file_type = match file.to_ascii_uppercase().as_str() {
        "I" | "I1" => FileType::I,
        "O" | "O0" => FileType::O,
        _ => return None,
    };
    let bit: u16 = bit.parse().ok()?;
    let file = file_type.implied_file().unwrap_or(0);
    Some(Address::element(file_type, file, 0).with_word(bit / 16).with_bit(bit % 16))
}

fn pulse_bit(file_type: FileType, name: &str) -> Option<u16> {
    let names: &[&str] = match file_type {
        FileType::PTO | FileType::PTOX => &TRAIN,
        FileType::PWM | FileType::PWMX => &WIDTH,
        _ => return None,
    };
    let bit = names.iter().position(|known| known.eq_ignore_ascii_case(name))?;
    u16::try_from(bit).ok()
}

/// The place of a text such as `RTC:0/BL`.
fn named(text: &str) -> Option<Address> {
    let (element, name) = text.split_once('/')?;
    let address = Address::parse(element).ok().filter(|address| address.word.is_none())?;
    let row = NAMED.iter().find(|row| row.0 == address.file_type && row.1.eq_ignore_ascii_case(name));
    let (word, bit) = match row {
        Some(row) => (row.2, row.3),
        None => (PULSE_WORD, pulse_bit(address.file_type, name)?),
    };
    Some(address.with_word(word).with_bit(bit))
}

/// An address of the data model, or one of the names above.
pub(crate) fn address(text: &str) -> Result<Address, ladder::AddressError> {
    Address::parse(text).or_else(|why| named(text).or_else(|| linear(text)).ok_or(why))
}

/// The image with places for the texts it has in place of addresses, and what there is to say about them;
/// `None` when it has no such text.
pub(crate) fn resolve(image: &Image) -> Option<(Image, Vec<String>)> {
    let text = |operand: &Operand| match operand {
        Operand::Text(text) => named(text).is_some(),
        // No symbol has a slash.
        Operand::Symbol(text) => linear(text).is_some(),
        _ => false,
    };
    let mut instructions = image.ladder_files().flat_map(|f| f.rungs.iter()).flat_map(|r| r.instructions());
    if !instructions.any(|instruction| instruction.operands.iter().any(text)) {
        return None;
    }
    let mut image = image.clone();
    let mut found = Vec::new();
    let modular = image.processor.family.id().starts_with("slc-5/");
    for rung in image.program_files.iter_mut().flat_map(|file| &mut file.rungs) {
        replace(&mut rung.series, modular, &mut found);
    }
    found.sort();
    found.dedup();
    Some((image, found))
}

fn replace(series: &mut Series, modular: bool, found: &mut Vec<String>) {
    for element in series {
        match element {
            Element::Instruction(instruction) => {
                for operand in &mut instruction.operands {
                    let address = match operand {
                        Operand::Symbol(text) => linear(text).inspect(|_| {
                            if modular {
                                found.push(format!(
                                    "{text}: it is taken as a bit of slot 0; which word of a chassis it is depends on \
                                     the I/O configuration"
                                ));
                            }
                        }),
                        Operand::Text(text) => named(text).inspect(|_| {
                            found.push(format!(
                                "{text}: where the processor keeps this bit is not known: it has a place of its own"
                            ));
                        }),
                        _ => None,
                    };
                    if let Some(address) = address {
                        *operand = Operand::Address(address);
                    }
                }
            }
            Element::Branch(branch) => branch.legs.iter_mut().for_each(|leg| replace(leg, modular, found)),
        }
    }
}

impl Machine {
    /// A word that the clock does not take over: a month 13. Zeros stand for a module that is not there.
    pub(crate) fn clock_refuses(&self, at: u32, word: u16) -> bool {
        let layout = &self.program.layout;
        let clock = layout.file(FileType::RTC, 0).and_then(|file| layout.files.get(file));
        let Some(offset) = clock.and_then(|info| at.checked_sub(info.start)) else { return false };
        self.program.traits.lineage == Lineage::Mx
            && word != 0
            && CLOCK.get(offset as usize).is_some_and(|(least, most)| !(*least..=*most).contains(&word))
    }

    /// A key of the data access tool that goes down toggles the latch beside it.
    pub(crate) fn key_latches(&self, at: u32, before: u16, after: u16) -> u16 {
        let layout = &self.program.layout;
        let keys = layout.file(FileType::DAT, 0).and_then(|file| layout.files.get(file));
        let is_keys = keys.is_some_and(|info| at == info.start + u32::from(NAMED[2].2));
        // The latch is the bit above its key.
        if is_keys { after ^ (after & !before & 0b0101) << 1 } else { after }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_bits_count_through_the_points_of_slot_0() {
        let read = |text| address(text).map(|address| address.to_string()).ok();
        assert_eq!(read("I/23").as_deref(), Some("I:0.1/7"));
        assert_eq!(read("o0/5").as_deref(), Some("O:0.0/5"));
        assert_eq!(read("I/x"), None);
    }

    #[test]
    fn names_have_no_place_in_the_data_model() {
        for (file_type, name, ..) in NAMED {
            let text = format!("{file_type}:0/{name}");
            assert!(Address::parse(&text).is_err(), "{text}");
            assert!(address(&text.to_lowercase()).is_ok(), "{text}");
        }
        for text in ["PTO:0/DN", "PTOX:1/EH", "PWM:0/IS", "PWMX:2/EN"] {
            assert!(Address::parse(text).is_err() && named(text).is_some(), "{text}");
        }
        assert!(named("PWM:0/DN").is_none());
        assert!(address("RTC:0/XX").is_err() && address("N7:0/BL").is_err() && address("RTC:0.1/BL").is_err());
    }
}
