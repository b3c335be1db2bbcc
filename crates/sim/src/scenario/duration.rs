//! Times as scenarios and command lines spell them: `10ms`, `2s`, `1.5min`.

use std::time::Duration;

/// Unit and its length in nanoseconds.
const UNITS: [(&str, f64); 5] = [("us", 1e3), ("ms", 1e6), ("s", 1e9), ("min", 60e9), ("h", 3600e9)];

/// Longest time accepted: a month of simulated time.
const LONGEST: f64 = 31.0 * 24.0 * 3600e9;

/// Reads a time: a number without sign and one of the units us, ms, s, min, h.
///
/// # Errors
/// What belongs there.
pub fn parse_duration(text: &str) -> Result<Duration, String> {
    let text = text.trim();
    let expected = || format!("expected a time such as 10ms, 2s or 1.5min, found `{text}`");
    let split = text.find(|c: char| c.is_ascii_alphabetic()).ok_or_else(expected)?;
    let (number, unit) = text.split_at(split);
    let scale = UNITS.iter().find(|row| row.0 == unit).ok_or_else(expected)?.1;
    let number = number.trim();
    if number.is_empty() || !number.bytes().all(|b| b.is_ascii_digit() || b == b'.') {
        return Err(expected());
    }
    let nanoseconds = number.parse::<f64>().map_err(|_| expected())? * scale;
    if nanoseconds > LONGEST {
        return Err(format!("{text} is longer than 31 days"));
    }
    // Rounded to whole microseconds, so that decimal fractions come out exact.
    Ok(Duration::from_micros((nanoseconds / 1e3).round() as u64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_read_in_every_unit() {
        for (text, micros) in
            [("10ms", 10_000), ("2s", 2_000_000), ("1.5min", 90_000_000), ("250us", 250), ("0.1 s", 100_000)]
        {
            assert_eq!(parse_duration(text), Ok(Duration::from_micros(micros)), "{text}");
        }
        for text in ["", "10", "ms", "-1s", "1e3s", "2 weeks", "9999h", "1.2.3s"] {
            assert!(parse_duration(text).is_err(), "{text}");
        }
    }
}
