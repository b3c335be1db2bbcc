//! Every printed value of the data table.

use crate::{Outcome, Pair};
use ladder::{Address, DataFile, FileType, Place, Value};

/// Compares all values of all printed data files except the status file.
pub(crate) fn values(pair: &Pair<'_>) -> Outcome {
    let mut outcome = Outcome::default();
    for printed in pair.report.printout.values.iter().filter(|f| f.kind != "S") {
        let number = printed.number;
        let file = pair.image.data_files.iter().find(|f| f.number == number && f.file_type.to_string() == printed.kind);
        for (address, column, text) in printed.elements() {
            let read = file.and_then(|f| read(pair, f, &address, column));
            outcome.row(format!("{address} {column}"), Some(comparable(&printed.kind, text)), read);
        }
    }
    outcome
}

/// A printed value in the form in which [`read`] gives it.
fn comparable(kind: &str, text: &str) -> String {
    match (kind, text.parse::<f64>()) {
        ("F", Ok(number)) => float(number),
        _ => text.to_owned(),
    }
}

/// Floats are printed with 7 significant digits.
fn float(number: f64) -> String {
    format!("{:.6e}", if number == 0.0 { 0.0 } else { number })
}

fn read(pair: &Pair<'_>, file: &DataFile, address: &str, column: &str) -> Option<String> {
    let parsed = Address::parse(address).ok()?;
    if let Ok(bit) = column.parse::<u16>() {
        let value = pair.image.value_at(&Address { bit: Some(Place::Number(bit)), ..parsed })?;
        return match value {
            Value::Bit(bit) => Some(u8::from(bit).to_string()),
            _ => None,
        };
    }
    Some(match (file.value(parsed.element.number()?)?, column) {
        (Value::Word(word), "") => word.to_string(),
        (Value::Long(long), "") => long.to_string(),
        (Value::Float(value), "") => float(f64::from(value)),
        (Value::Timer(timer), column) => match column {
            "BASE" => match timer.base()? {
                ladder::TimeBase::Millisecond => ".001 sec".to_owned(),
                ladder::TimeBase::Centisecond => ".01 sec".to_owned(),
                ladder::TimeBase::Second => "1.0 sec".to_owned(),
            },
            "PRE" => timer.pre.to_string(),
            "ACC" => timer.acc.to_string(),
            flag => bit(timer.control, &["EN", "TT", "DN"], flag)?,
        },
        (Value::Counter(counter), column) => match column {
            "PRE" => counter.pre.to_string(),
            "ACC" => counter.acc.to_string(),
            flag => bit(counter.control, &["CU", "CD", "DN", "OV", "UN", "UA"], flag)?,
        },
        (Value::Control(control), column) => match column {
            "LEN" => control.len.to_string(),
            "POS" => control.pos.to_string(),
            flag => bit(control.control, &["EN", "EU", "DN", "EM", "ER", "UL", "IN", "FD"], flag)?,
        },
        (Value::Text(text), "LEN") => text.chars().count().to_string(),
        (Value::Text(text), "text") if file.file_type == FileType::ST => text.trim_end().to_owned(),
        _ => return None,
    })
}

/// The flags of a control word are printed from bit 15 down.
fn bit(word: u16, names: &[&str], name: &str) -> Option<String> {
    let place = names.iter().position(|n| *n == name)?;
    Some((word >> (15 - place) & 1).to_string())
}
