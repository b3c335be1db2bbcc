//! What changed inside a rung, in words.

use analysis::diff::{Edit, EditKind};

use super::side::Side;

/// What changed, for a person: `TON Preset: 500 -> 600`, with the symbols of addresses. Without the two programs
/// operands go by their number and have no symbols.
pub fn sentence(edit: &Edit, sides: Option<(&Side<'_>, &Side<'_>)>) -> String {
    let Edit { mnemonic, .. } = edit;
    let told = |side: Option<&Side<'_>>, operand: &str| match side.and_then(|side| side.symbol(operand)) {
        Some(symbol) => format!("{operand} ({symbol})"),
        None if operand.is_empty() => "nothing".to_owned(),
        None => operand.to_owned(),
    };
    let (before, after) = (sides.map(|sides| sides.0), sides.map(|sides| sides.1));
    // `XIC B3:0/1`: words of an instruction, the first of them its mnemonic.
    let whole = |side: Option<&Side<'_>>, text: &str| {
        let mut words = text.split(' ');
        let mnemonic = words.next().unwrap_or_default().to_owned();
        match (words.next(), words.next()) {
            (Some(operand), None) => format!("{mnemonic} {}", told(side, operand)),
            _ => text.to_owned(),
        }
    };
    match edit.kind {
        EditKind::Operand => {
            let name = edit.operand.zip(after).and_then(|(index, side)| side.operand_name(mnemonic, index));
            let name = match (name, edit.operand) {
                (Some(""), _) | (None, None) => mnemonic.clone(),
                (Some(name), _) => format!("{mnemonic} {name}"),
                (None, Some(index)) => format!("{mnemonic}, operand {}", index + 1),
            };
            format!("{name}: {} -> {}", told(before, &edit.old), told(after, &edit.new))
        }
        EditKind::Setting => format!("{mnemonic}, {} -> {}", told(None, &edit.old), told(None, &edit.new)),
        EditKind::Instruction => format!("{} is now {}", edit.old, edit.new),
        EditKind::Inserted => format!("inserted {}", whole(after, &edit.new)),
        EditKind::Deleted => format!("deleted {}", whole(before, &edit.old)),
        EditKind::Branches => "branches begin, divide or end elsewhere".to_owned(),
    }
}
