//! Data that a message moves, as far as its set-up tells.

use instr::Role;
use ladder::{Instruction, MessageSetup};

/// What is known about a message's data area.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Transfer {
    /// `Write` when data comes in, `Read` when it goes out.
    pub(super) role: Role,
    /// The direction is known.
    pub(super) direction_known: bool,
    /// How much.
    pub(super) size: Size,
}

/// How much a message moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Size {
    Elements(u64),
    Bits(u64),
    Unknown,
}

/// The transfer of one data operand. `role` is what the instruction table says of that operand:
/// `ReadWrite` where only the set-up decides.
pub(super) fn transfer(instruction: &Instruction, role: Role) -> Transfer {
    let setup = instruction.message.as_deref();
    let command = setting(setup, &["command"]).map(str::to_ascii_lowercase);
    let (from_table, role) = match role {
        // SLC and MicroLogix 1000 boxes show the direction among the operands.
        Role::ReadWrite => {
            let shown = instruction.operands.iter().map(|operand| operand.to_string().to_ascii_lowercase());
            let texts: Vec<String> = command.iter().cloned().chain(shown).collect();
            let has = |word: &str| texts.iter().any(|text| text.split_whitespace().any(|part| part == word));
            match (has("read"), has("write")) {
                (true, false) => (true, Role::Write),
                (false, true) => (true, Role::Read),
                _ => (false, Role::ReadWrite),
            }
        }
        known => (true, known),
    };
    let number = |names: &[&str]| {
        setting(setup, names).and_then(|text| text.trim().parse::<u64>().ok()).filter(|n| (1..=4096).contains(n))
    };
    let is_coil = command.as_deref().is_some_and(|c| c.contains("coil") || c.contains("input status"));
    let cip = command.as_deref().is_some_and(|c| c.contains("cip"));
    let size = if cip {
        // The length of a CIP request counts the bytes sent; nothing bounds what is received.
        match number(&["bytes"]) {
            Some(bytes) if role == Role::Read => Size::Bits(bytes.div_ceil(2) * 16),
            _ => Size::Unknown,
        }
    } else {
        match number(&["elements"]) {
            Some(points) if is_coil => Size::Bits(points),
            Some(elements) => Size::Elements(elements),
            None => Size::Unknown,
        }
    };
    Transfer { role, direction_known: from_table, size }
}

/// The first setting whose name has one of these words in it.
fn setting<'s>(setup: Option<&'s MessageSetup>, words: &[&str]) -> Option<&'s str> {
    let settings = &setup?.settings;
    let named = |name: &str| {
        let name = name.to_ascii_lowercase();
        words.iter().any(|word| name.split(|c: char| !c.is_ascii_alphanumeric()).any(|part| part == *word))
    };
    settings.iter().find(|(name, _)| named(name)).map(|(_, text)| text.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ladder::Mnemonic;

    fn message(settings: &[(&'static str, &str)]) -> Instruction {
        let settings = settings.iter().map(|(name, text)| ((*name).into(), (*text).to_owned())).collect();
        let mut instruction = Instruction::new(Mnemonic::named("MSG"), Vec::new());
        instruction.message = Some(Box::new(MessageSetup { settings }));
        instruction
    }

    #[test]
    fn the_command_gives_direction_and_the_size_gives_length() {
        let read = message(&[
            ("Communication Command", "03 Read Holding Registers (4xxxxx)"),
            ("Channel", "0"),
            ("Size in Elements", "7"),
        ]);
        let expected = Transfer { role: Role::Write, direction_known: true, size: Size::Elements(7) };
        assert_eq!(transfer(&read, Role::ReadWrite), expected);
        let write =
            message(&[("Communication Command", "16 Write Multiple Registers (4xxxxx)"), ("Size in Elements", "0")]);
        let expected = Transfer { role: Role::Read, direction_known: true, size: Size::Unknown };
        assert_eq!(transfer(&write, Role::ReadWrite), expected);
        let none = Instruction::new(Mnemonic::named("MSG"), Vec::new());
        let expected = Transfer { role: Role::ReadWrite, direction_known: false, size: Size::Unknown };
        assert_eq!(transfer(&none, Role::ReadWrite), expected);
    }

    #[test]
    fn a_cip_length_bounds_what_is_sent_only() {
        let cip =
            message(&[("Communication Command", "CIP Generic"), ("Size in Elements", "3"), ("Size in Bytes", "252")]);
        assert_eq!(transfer(&cip, Role::Read).size, Size::Bits(2016));
        assert_eq!(transfer(&cip, Role::Write).size, Size::Unknown);
    }
}
