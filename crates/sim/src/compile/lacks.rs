//! What a program uses that its processor family does not have, or that its editor would not take: it
//! runs, and every report says so. Numbers that no word holds are refused.

use instr::parameters;
use instr::{Kind, Position, by_mnemonic};
use ladder::{Address, Family, FileType, Instruction, Operand, Rung, TimeBase};

use super::Compiler;
use super::operand::Result;
use crate::family::Lineage;
use crate::program::Approximation;

/// Elements of the fixed files of a MicroLogix 1000 (1000 6-9; all but T: recalled).
const SMALL_FILES: [(FileType, u16); 6] =
    [(FileType::S, 33), (FileType::B, 32), (FileType::T, 40), (FileType::C, 32), (FileType::R, 16), (FileType::N, 105)];
/// The last file of a MicroLogix 1000 is N7.
const SMALL_LAST_FILE: u16 = 7;
/// Elements of a data file and the last file number (DTAM B-8, 1100 p.192).
const LAST_ELEMENT: u16 = 255;
const LAST_FILE: u16 = 255;
/// The last slot (SLC 1-2).
const LAST_SLOT: u16 = 30;
/// The last label of SLC processors and of any (recalled).
const LAST_LABEL: u16 = 255;
const LAST_LABEL_OF_ANY: u16 = 999;

impl Compiler<'_> {
    /// Reports what the family of the program does not have.
    pub(super) fn lacks(&mut self, instruction: &Instruction) {
        let family = self.family();
        if family == Family::Unknown {
            return;
        }
        let mut found: Vec<String> = Vec::new();
        for address in addresses(instruction) {
            found.extend(self.lacks_address(address));
        }
        if let Some(why) = self.lacks_time_base(instruction) {
            found.push(why);
        }
        if let Some(why) = self.label(instruction) {
            found.push(why);
        }
        found.sort();
        found.dedup();
        for what in found {
            let why = format!("{} has no {what}: it runs as on those that have it", family.name());
            self.approximate(instruction, why);
        }
    }

    fn lacks_address(&self, address: &Address) -> Option<String> {
        let lineage = self.traits.lineage;
        let old = matches!(lineage, Lineage::S1 | Lineage::S2 | Lineage::M10);
        let file_type = address.file_type;
        if address.indirections().next().is_some() && old {
            return Some("indirect addresses".to_owned());
        }
        if (file_type.is_function_file() && lineage != Lineage::Mx)
            || (matches!(file_type, FileType::F | FileType::ST | FileType::A) && old)
            || (matches!(file_type, FileType::L | FileType::PD | FileType::MG | FileType::PLS)
                && lineage != Lineage::Mx)
        {
            return Some(format!("{file_type} files"));
        }
        if file_type.is_function_file() {
            return None;
        }
        let element = address.element.number().unwrap_or(0);
        if file_type.has_slots() {
            return (element > LAST_SLOT).then(|| format!("slot {element}"));
        }
        let file = address.file.number().unwrap_or(0);
        let (most, last_file) = match lineage {
            Lineage::M10 => {
                let row = SMALL_FILES.iter().find(|row| row.0 == file_type);
                (row.map_or(LAST_ELEMENT, |row| row.1 - 1), SMALL_LAST_FILE)
            }
            _ => (LAST_ELEMENT, LAST_FILE),
        };
        if file > last_file {
            return Some(format!("data file {file}"));
        }
        (element > most).then(|| format!("element {element} in a {file_type} file"))
    }

    fn lacks_time_base(&self, instruction: &Instruction) -> Option<String> {
        if !matches!(instruction.mnemonic.name(), Some("TON" | "TOF" | "RTO")) {
            return None;
        }
        let missing = match (parameters::time_base(instruction.operands.get(1))?, self.traits.lineage) {
            (TimeBase::Millisecond, lineage) => lineage != Lineage::Mx,
            (TimeBase::Second, lineage) => lineage == Lineage::S1,
            _ => false,
        };
        missing.then(|| "timers of this time base".to_owned())
    }

    fn label(&self, instruction: &Instruction) -> Option<String> {
        let Some("LBL" | "JMP") = instruction.mnemonic.name() else { return None };
        let number = match instruction.operands.first()? {
            Operand::Label { number, .. } => *number,
            other => u16::try_from(other.constant()?.as_integer()?).ok()?,
        };
        let last = if self.traits.mx() { LAST_LABEL_OF_ANY } else { LAST_LABEL };
        (number > last).then(|| format!("label {number}"))
    }

    /// Reports what an editor would not have taken in a rung.
    pub(super) fn shape(&mut self, rung: &Rung) {
        let names = || rung.instructions().map(|instruction| instruction.mnemonic.name());
        // What is not known may be an output.
        let acts = |name: Option<&str>| {
            name.and_then(by_mnemonic).is_none_or(|entry| {
                entry.forms.iter().any(|form| matches!(form.position, Position::Output | Position::FileEnd))
            })
        };
        if !names().any(acts) {
            let why = "no editor takes a rung without an output: it does nothing but what its conditions do".to_owned();
            self.approximations.push(Approximation { site: Some(self.site("rung")), why });
        }
        if names().skip(1).any(|name| name == Some("LBL")) {
            let why =
                "no editor takes LBL behind other instructions: jumps lead to the beginning of its rung".to_owned();
            self.approximations.push(Approximation { site: Some(self.site("rung")), why });
        }
    }
}

/// Refuses numbers that the words they belong in do not hold.
pub(super) fn fits(instruction: &Instruction) -> Result<()> {
    let bits = |value: i64| {
        (0..=0xFFFF).contains(&value) && {
            let mut constants = instruction.operands.iter().filter_map(Operand::constant);
            constants.any(|constant| constant.is_hex() && constant.as_integer() == Some(value))
        }
    };
    let check = |value: i64, what: &str| match i16::try_from(value) {
        Err(_) if !bits(value) => Err(format!("{what} {value} is outside the range of a word")),
        _ => Ok(()),
    };
    for written in parameters::written(instruction) {
        let [first, second] = match written.element.file_type {
            FileType::R => ["length", "position"],
            _ => ["preset", "accumulator"],
        };
        for (value, what) in written.values.into_iter().zip([first, second]) {
            value.map_or(Ok(()), |value| check(value, what))?;
        }
    }
    let entry = instruction.mnemonic.name().and_then(by_mnemonic);
    let forms = entry.into_iter().flat_map(|entry| entry.forms);
    let Some(form) = forms.into_iter().find(|form| form.operands.len() == instruction.operands.len()) else {
        return Ok(());
    };
    for (operand, described) in instruction.operands.iter().zip(form.operands) {
        if described.kind == Kind::Length
            && let Some(value) = operand.constant().and_then(|constant| constant.as_integer())
        {
            check(value, "length")?;
        }
    }
    Ok(())
}

/// Every address of an instruction, those in brackets and expressions too.
fn addresses(instruction: &Instruction) -> Vec<&Address> {
    fn inside(operand: &Operand) -> Vec<&Operand> {
        match operand {
            Operand::Expression(expression) => expression.operands(),
            operand => vec![operand],
        }
    }
    let plain = instruction.operands.iter().flat_map(inside).filter_map(Operand::address);
    plain.flat_map(|address| std::iter::once(address).chain(address.indirections())).collect()
}
