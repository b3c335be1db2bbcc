//! Symbols that stand in a program instead of addresses.

use std::collections::HashMap;

use ladder::{Address, Documentation, Operand, Target};

/// Symbols by upper-case name.
pub(crate) struct Symbols<'a> {
    by_name: HashMap<String, &'a Target>,
}

impl<'a> Symbols<'a> {
    pub(crate) fn new(documentation: &'a Documentation) -> Symbols<'a> {
        let mut by_name = HashMap::new();
        for entry in documentation.entries() {
            if !entry.symbol.is_empty() && entry.target != Target::Unassigned {
                by_name.entry(entry.symbol.to_ascii_uppercase()).or_insert(&entry.target);
            }
        }
        Symbols { by_name }
    }

    /// What a symbol with its suffix stands for: `ENTRY_TON.ACC`, `MODE/3`, `#RECIPES`.
    pub(crate) fn resolve(&self, text: &str) -> Option<Target> {
        let (indexed, text) = match text.strip_prefix('#') {
            Some(rest) => (true, rest),
            None => (false, text),
        };
        let (name, suffix) = match text.find(['.', '/']) {
            Some(at) => text.split_at(at),
            None => (text, ""),
        };
        let target = *self.by_name.get(&name.to_ascii_uppercase())?;
        match target {
            Target::Address(address) => {
                let mut whole = match suffix {
                    "" => address.clone(),
                    // `I:1/3` as symbol of a word of I/O prints with its word, which the suffix follows.
                    suffix => Address::parse(&format!("{address}{suffix}")).ok()?,
                };
                whole.indexed |= indexed;
                Some(Target::Address(whole))
            }
            other if suffix.is_empty() && !indexed => Some(other.clone()),
            _ => None,
        }
    }

    /// The address an operand means.
    pub(crate) fn address(&self, operand: &Operand) -> Option<Address> {
        match operand {
            Operand::Address(address) => Some(address.clone()),
            Operand::Symbol(text) => match self.resolve(text)? {
                Target::Address(address) => Some(address),
                _ => None,
            },
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ladder::AddressEntry;

    #[test]
    fn suffixes_follow_the_address_of_the_symbol() {
        let mut docs = Documentation::default();
        for (text, symbol) in [("T4:3", "ENTRY_TON"), ("N7:10", "Mode"), ("I:1.0", "INPUTS")] {
            let target = Target::Address(Address::parse(text).expect(text));
            docs.add(AddressEntry { target, symbol: symbol.into(), description: Vec::new() });
        }
        docs.add(AddressEntry {
            target: Target::ProgramFileOperand(7),
            symbol: "PUMPS".into(),
            description: Vec::new(),
        });
        let symbols = Symbols::new(&docs);
        for (text, address) in [
            ("ENTRY_TON.ACC", "T4:3.ACC"),
            ("entry_ton/DN", "T4:3/DN"),
            ("MODE/3", "N7:10/3"),
            ("#MODE", "#N7:10"),
            ("INPUTS/4", "I:1.0/4"),
            ("PUMPS", "U:7"),
        ] {
            assert_eq!(symbols.resolve(text).map(|t| t.to_string()).as_deref(), Some(address), "{text}");
        }
        assert_eq!(symbols.resolve("NOBODY"), None);
        assert_eq!(symbols.resolve("PUMPS/1"), None);
    }
}
