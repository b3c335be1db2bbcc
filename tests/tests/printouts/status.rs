//! The status file, printed as labelled fields.

use crate::{Outcome, Pair};
use ladder::{DataFile, FileType};

/// Compares every field whose label names its place and that has a value.
pub(crate) fn status(pair: &Pair<'_>) -> Outcome {
    let mut outcome = Outcome::default();
    let file = pair.image.data_files.iter().find(|f| f.file_type == FileType::S);
    let printed = pair.report.printout.values.iter().filter(|f| f.kind == "S");
    for field in printed.flat_map(|f| &f.status).filter(|f| !f.text.is_empty()) {
        let read = file.and_then(|f| read(f, &field.label, &field.text));
        outcome.row(&field.label, Some(field.text.clone()), read);
    }
    outcome
}

fn word(file: &DataFile, number: usize) -> Option<u16> {
    file.words.get(number).copied()
}

/// The stored value in the form of the printed one.
fn read(file: &DataFile, label: &str, printed: &str) -> Option<String> {
    let (name, rest) = label.split_once("S:")?;
    let (first, more) = rest.split_once([' ', '-']).unwrap_or((rest, ""));
    let (number, bit) = first.split_once('/').unwrap_or((first, ""));
    let value = word(file, number.parse().ok()?)?;
    let both = || Some((u32::from(word(file, 14)?) << 16) | u32::from(word(file, 13)?));
    if name.starts_with("Processor Mode") {
        return Some(mode(value & 0x1F).to_owned());
    }
    if let Ok(bit) = bit.parse::<u16>() {
        let set = value >> bit & 1 != 0;
        return Some(match printed {
            "Yes" | "No" => if set { "Yes" } else { "No" }.to_owned(),
            "True" | "False" => if set { "True" } else { "False" }.to_owned(),
            _ => u8::from(set).to_string(),
        });
    }
    Some(match name.trim() {
        "Free Running Clock" => {
            let nibble = |shift: u16| format!("{:04b}", value >> shift & 15);
            [12, 8, 4, 0].map(nibble).join("-")
        }
        // Baud codes begin at 1; these processors keep none here.
        "Baud Rate" if value >> 8 == 0 => "?".to_owned(),
        "OS Series" | "Processor Series" => char::from(b'A' + u8::try_from(value).ok()?).to_string(),
        "User Program Type" | "Major Error" => format!("{value:x}h"),
        "Math Register (high word)" => word(file, 14)?.to_string(),
        "Math Register (32 Bit)" => both()?.to_string(),
        _ if more.contains("high byte") => (value >> 8).to_string(),
        _ if more.contains("low byte") => (value & 0xFF).to_string(),
        _ => value.to_string(),
    })
}

/// Mode bits S:1/0 to 4 as the field shows them.
fn mode(bits: u16) -> &'static str {
    match bits {
        0x01 => "Remote Program Mode",
        0x06 => "Remote Run",
        0x11 => "Program Mode",
        0x1E => "Run",
        _ => "?",
    }
}
