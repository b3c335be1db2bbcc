//! What the text of an instruction says about the data table: values of its control element, and how
//! many words an operand needs.
//!
//! A box shows the parameters of its timer, counter or control element beside the address. In a
//! controller they live in the data table alone; where a program comes as text without a table, the
//! text is all there is. Programs that are stored and programs that are run take them from here.

use ladder::{Address, Family, FileType, Instruction, Number, Operand, TimeBase};

use crate::{Extent, by_mnemonic};

/// Parameters that an instruction shows for one element of the data table.
#[derive(Clone, Debug, PartialEq)]
pub struct Written<'a> {
    /// The timer, counter or control element.
    pub element: &'a Address,
    /// Time base, for timers.
    pub time_base: Option<TimeBase>,
    /// What the instruction shows for word 1 (PRE or LEN) and word 2 (ACC or POS), if numbers stand there.
    pub values: [Option<i64>; 2],
}

/// The elements whose parameters stand as numbers in the text of `instruction`.
pub fn written(instruction: &Instruction) -> impl Iterator<Item = Written<'_>> {
    let name = instruction.mnemonic.name().unwrap_or("");
    let number = |index: usize| instruction.operands.get(index)?.constant()?.as_integer();
    let is_timer = matches!(name, "TON" | "TOF" | "RTO");
    rows(name).iter().filter_map(move |(element, first, second)| {
        Some(Written {
            element: instruction.operands.get(*element)?.address()?,
            time_base: if is_timer { time_base(instruction.operands.get(1)) } else { None },
            values: [number(*first), second.and_then(number)],
        })
    })
}

/// The operand of the element, then those of the values of its words 1 and 2.
fn rows(name: &str) -> &'static [(usize, usize, Option<usize>)] {
    match name {
        "TON" | "TOF" | "RTO" => &[(0, 2, Some(3))],
        "CTU" | "CTD" => &[(0, 1, Some(2))],
        "BSL" | "BSR" => &[(1, 3, None)],
        "FFL" | "LFL" | "FFU" | "LFU" | "SQL" => &[(2, 3, Some(4))],
        "SQO" | "SQC" => &[(3, 4, Some(5))],
        "FBC" | "DDT" => &[(3, 4, Some(5)), (6, 7, Some(8))],
        "ARD" | "ARL" | "AWA" | "AWT" => &[(2, 3, None)],
        _ => &[],
    }
}

/// The time base written as an operand; `1` means one second.
pub fn time_base(operand: Option<&Operand>) -> Option<TimeBase> {
    match operand? {
        Operand::Constant(constant) => TimeBase::from_text(constant.text()).or(match constant.number() {
            Number::Integer(1) => Some(TimeBase::Second),
            _ => None,
        }),
        Operand::Text(text) => TimeBase::from_text(text),
        _ => None,
    }
}

/// Words that operand `index` reaches from the address it names, 1 where nothing tells.
pub fn words(instruction: &Instruction, index: usize, family: Family) -> u32 {
    let Some(operand) = instruction.operands.get(index) else { return 1 };
    let entry = instruction.mnemonic.name().and_then(by_mnemonic);
    let form = entry.and_then(|entry| entry.form_for(family, instruction.operands.len()));
    let words = form.and_then(|form| form.operands.get(index)).map_or(1, |described| {
        let count = |index: usize| count(instruction.operands.get(index)).unwrap_or(1).clamp(1, MOST);
        let size = |index: usize| size_of(instruction.operands.get(index));
        match described.extent {
            Extent::Elements { length, size_of } => count(length) * size(size_of),
            Extent::Steps { length } => (count(length) + 1) * size(index),
            Extent::ValueOrSteps { length } if is_file(operand) => (count(length) + 1) * size(index),
            Extent::Words { length } => count(length),
            Extent::Bits { length } => count(length).div_ceil(16),
            Extent::Block { words } => u32::from(words),
            _ => 1,
        }
    });
    words.max(block_words(entry.map(|entry| entry.mnemonic), index, operand))
}

/// No file has more words; a larger count is a mistake.
const MOST: u32 = 4096;

/// Words of a block of integers that an instruction works on from its first operand; what the operand
/// is called differs by processor, what the block holds does not.
fn block_words(mnemonic: Option<&str>, index: usize, operand: &Operand) -> u32 {
    let integers = operand.address().is_some_and(|address| address.file_type == FileType::N);
    match mnemonic {
        Some("PID") if index == 0 && integers => crate::exec::process::WORDS as u32,
        Some("MSG") if integers => 14,
        _ => 1,
    }
}

fn is_file(operand: &Operand) -> bool {
    operand.address().is_some_and(|address| address.indexed)
}

fn count(operand: Option<&Operand>) -> Option<u32> {
    u32::try_from(operand?.constant()?.as_integer()?).ok()
}

fn size_of(operand: Option<&Operand>) -> u32 {
    operand.and_then(Operand::address).map_or(1, |address| element_words(address.file_type))
}

/// Words of an element of this type, 1 where the type does not fix it.
pub fn element_words(file_type: FileType) -> u32 {
    u32::from(file_type.words_per_element().unwrap_or(1)).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ladder::Mnemonic;

    fn instruction(text: &str) -> Instruction {
        let mut words = text.split(' ');
        let mnemonic = Mnemonic::named(words.next().expect("a mnemonic").to_owned());
        Instruction::new(mnemonic, words.map(Operand::parse).collect())
    }

    #[test]
    fn parameters_stand_where_the_box_shows_them() {
        for (text, expected) in [
            ("TON T4:0 1.0 10 3", vec![("T4:0", Some(TimeBase::Second), [Some(10), Some(3)])]),
            ("TOF T4:3 0.001 7 0", vec![("T4:3", Some(TimeBase::Millisecond), [Some(7), Some(0)])]),
            ("CTU C5:0 33 1", vec![("C5:0", None, [Some(33), Some(1)])]),
            ("BSL #B3:0 R6:0 I:0/0 20", vec![("R6:0", None, [Some(20), None])]),
            ("SQO #N7:0 FFFFh O:0 R6:2 4 1", vec![("R6:2", None, [Some(4), Some(1)])]),
            ("TON T4:0 1.0 N7:0 0", vec![("T4:0", Some(TimeBase::Second), [None, Some(0)])]),
            ("MOV 5 N7:0", vec![]),
        ] {
            let instruction = instruction(text);
            let found: Vec<_> =
                written(&instruction).map(|it| (it.element.to_string(), it.time_base, it.values)).collect();
            let expected: Vec<_> =
                expected.into_iter().map(|(at, base, values)| (at.to_owned(), base, values)).collect();
            assert_eq!(found, expected, "{text}");
        }
    }

    #[test]
    fn lengths_size_the_operands() {
        for (text, index, expected) in [
            ("COP #N7:0 #N10:0 10", 1, 10),
            ("COP #T4:0 #T4:5 2", 1, 6),
            ("COP #T4:0 #N7:0 12", 0, 12),
            ("FLL 0 #N11:0 10", 1, 10),
            ("BSL #B3:0 R6:0 I:0/0 33", 0, 3),
            ("SQO #N7:0 FFFFh O:0 R6:2 4 1", 0, 5),
            ("FFL N7:0 #N13:0 R6:0 8 0", 1, 8),
        ] {
            assert_eq!(words(&instruction(text), index, Family::MicroLogix1400), expected, "{text}");
        }
    }
}
