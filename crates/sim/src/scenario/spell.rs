//! Parts of a scenario as text, for those who write scenarios.

use std::fmt::Write;
use std::time::Duration;

use ladder::Value;

/// A string in quotes.
pub fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// A length of time, to the microsecond, which is what scenarios know.
pub fn duration(time: Duration) -> String {
    let microseconds = time.as_micros();
    for (size, unit) in [(1_000_000, "s"), (1_000, "ms")] {
        if microseconds.is_multiple_of(size) {
            return format!("\"{}{unit}\"", microseconds / size);
        }
    }
    format!("\"{microseconds}us\"")
}

/// A value, such that reading it gives the same one; `None` for whole elements, which scenarios name member
/// by member.
pub fn literal(value: &Value) -> Option<String> {
    Some(match value {
        Value::Bit(on) => u8::from(*on).to_string(),
        Value::Word(word) => word.to_string(),
        Value::Long(long) => long.to_string(),
        Value::Float(number) if number.is_finite() => format!("{:?}", f64::from(*number)),
        // TOML has words for these.
        Value::Float(number) if number.is_nan() => "nan".to_owned(),
        Value::Float(number) => if *number > 0.0 { "inf" } else { "-inf" }.to_owned(),
        Value::Text(text) => quoted(text),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{Scenario, parse_duration, value_for};

    #[test]
    fn what_is_written_reads_as_the_same() {
        for time in [0, 1, 999, 1_000, 10_500, 1_000_000, 90_000_000].map(Duration::from_micros) {
            assert_eq!(parse_duration(duration(time).trim_matches('"')), Ok(time));
        }
        let values = [
            Value::Bit(true),
            Value::Word(-32768),
            Value::Long(i32::MIN),
            Value::Float(0.1),
            Value::Float(f32::MAX),
            Value::Float(f32::MIN_POSITIVE),
            Value::Text("a \"b\" \\ \u{1b}[0m\n".to_owned()),
        ];
        for value in values {
            let text = literal(&value).expect("a plain value");
            let scenario = format!("name = \"\"\nladder = \"\"\n[[step]]\nset = {{ {} = {text} }}\n", quoted("N7:0"));
            let scenario = Scenario::parse(&scenario).expect("reads");
            let read = scenario.steps.first().and_then(|step| step.set.first()).map(|set| set.value.clone());
            assert_eq!(read.map(|read| value_for(&read, &value)), Some(Ok(value)), "{text}");
        }
    }
}
