//! What a person types to ask for a cross reference.

use ladder::{Address, FileType, Operand, Target};

use crate::budget::Budget;

use super::{CrossReference, Group, group_key};

/// What an entered text means.
#[derive(Clone, Debug)]
pub enum Found<'x> {
    /// An address, or a symbol that has one.
    Address(Group<'x>),
    /// A data file: every address of it that the program names.
    File {
        /// `N7`, `HSC`.
        label: String,
        /// Ascending; bounded as [`CrossReference::all`] is.
        groups: Vec<Group<'x>>,
    },
    /// A program file, `U:4`: see [`crate::CallGraph`].
    ProgramFile(u16),
    /// A label, `Q2:1`: see [`crate::CallGraph`].
    Label {
        /// Program file.
        file: u16,
        /// Label number.
        number: u16,
    },
}

impl CrossReference<'_> {
    /// Looks up what a person entered: an address in any spelling, a symbol (with a member or bit
    /// after it), a data file (`N7`), a program file (`U:4`) or a label (`Q2:1`). `None` if it is none
    /// of these.
    pub fn find(&self, text: &str) -> Option<Found<'_>> {
        let text = text.trim();
        match Operand::parse(text) {
            Operand::Address(address) => return Some(Found::Address(self.whole_group(address))),
            Operand::ProgramFile(number) => return Some(Found::ProgramFile(number)),
            Operand::Label { file, number } => return Some(Found::Label { file, number }),
            _ => {}
        }
        match self.data.symbols.resolve(text) {
            Some(Target::Address(address)) => return Some(Found::Address(self.whole_group(address))),
            Some(Target::ProgramFileOperand(number)) => return Some(Found::ProgramFile(number)),
            Some(Target::Label { file, number }) => return Some(Found::Label { file, number }),
            _ => {}
        }
        let (file_type, number) = file_label(text)?;
        let named = self.data.named.iter();
        let mut named: Vec<_> = named
            .filter(|named| named.address.file_type == file_type && named.address.file.number() == Some(number))
            .map(|named| (group_key(&named.address, Some(named.area)), named))
            .collect();
        named.sort_by(|a, b| a.0.cmp(&b.0));
        let mut budget = Budget::of_report();
        let groups = named.into_iter().map(|(_, it)| self.group(&it.address, Some(it.area), &mut budget)).collect();
        Some(Found::File { label: text.to_ascii_uppercase(), groups })
    }

    fn whole_group(&self, address: Address) -> Group<'_> {
        let accesses = self.of(&address);
        Group { address, accesses, left_out: Some(0) }
    }
}

/// `N7`, `t4`, `I`, `HSC`, `ES1`.
fn file_label(text: &str) -> Option<(FileType, u16)> {
    let letters = text.trim_end_matches(|c: char| c.is_ascii_digit());
    let (letters, digits) = match text {
        // The module files have their number in the letters.
        "M0" | "M1" | "m0" | "m1" => (text, ""),
        _ => text.split_at(letters.len()),
    };
    let file_type = FileType::from_letters(letters)?;
    let number = if digits.is_empty() { file_type.implied_file()? } else { digits.parse().ok()? };
    Some((file_type, number))
}
