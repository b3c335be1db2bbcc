//! Values as scenarios write them, against values as the data table holds them.

use std::fmt;

use ladder::{Value, format_float};

/// A value as written.
#[derive(Clone, Debug, PartialEq)]
pub enum Literal {
    /// A whole number.
    Integer(i64),
    /// A number with a point.
    Float(f64),
    /// Text, or digits in hex such as `0xF0F0`.
    Text(String),
}

impl fmt::Display for Literal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Literal::Integer(value) => write!(f, "{value}"),
            Literal::Float(value) => write!(f, "{value}"),
            Literal::Text(text) => write!(f, "\"{text}\""),
        }
    }
}

/// Relative distance up to which two floats count as equal: a few units of the last place, since the
/// decimal a person writes is rounded and no manual states the last bit of a sine.
const TOLERANCE: f64 = 1e-6;

/// A value that is not what was expected, both as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// As the scenario says, in the notation of what was found.
    pub expected: String,
    /// As the data table says.
    pub found: String,
}

/// The value to write at a place that now holds `present`.
///
/// # Errors
/// The literal does not fit there.
pub fn value_for(literal: &Literal, present: &Value) -> Result<Value, String> {
    match present {
        Value::Bit(_) => match integer(literal)? {
            0 => Ok(Value::Bit(false)),
            1 => Ok(Value::Bit(true)),
            other => Err(format!("a bit is 0 or 1, not {other}")),
        },
        Value::Word(_) => word(integer(literal)?).map(Value::Word),
        Value::Long(_) => long(integer(literal)?).map(Value::Long),
        Value::Float(_) => match literal {
            Literal::Float(value) => Ok(Value::Float(*value as f32)),
            Literal::Integer(value) => Ok(Value::Float(*value as f32)),
            Literal::Text(text) => match text.trim().parse::<f32>() {
                Ok(value) => Ok(Value::Float(value)),
                Err(_) => Err(format!("expected a number, found {literal}")),
            },
        },
        Value::Text(_) => match literal {
            Literal::Text(text) => Ok(Value::Text(text.clone())),
            _ => Err(format!("expected a string in quotes, found {literal}")),
        },
        Value::Timer(_) | Value::Counter(_) => {
            Err("it is a whole element: name a member such as .PRE, .ACC or /DN".to_owned())
        }
        Value::Control(_) => Err("it is a whole element: name a member such as .LEN, .POS or /DN".to_owned()),
        Value::Words(_) => Err("it is a whole element: name one of its words or bits".to_owned()),
    }
}

/// Compares; `Ok(None)` when found is as expected.
///
/// # Errors
/// The literal can never be equal to such a value.
pub fn matches(literal: &Literal, found: &Value) -> Result<Option<Mismatch>, String> {
    let expected = value_for(literal, found)?;
    let equal = match (&expected, found) {
        (Value::Float(expected), Value::Float(found)) => same_float(*expected, *found),
        _ => expected == *found,
    };
    Ok((!equal).then(|| Mismatch { expected: text(&expected), found: text(found) }))
}

fn same_float(expected: f32, found: f32) -> bool {
    if !expected.is_finite() || !found.is_finite() {
        return expected == found || (expected.is_nan() && found.is_nan());
    }
    let (expected, found) = (f64::from(expected), f64::from(found));
    expected == found || (expected - found).abs() <= TOLERANCE * expected.abs().max(1.0)
}

/// A value as failures show it: words in decimal and hex.
pub(crate) fn text(value: &Value) -> String {
    match value {
        Value::Bit(bit) => u8::from(*bit).to_string(),
        Value::Word(word) if (0..10).contains(word) => word.to_string(),
        Value::Word(word) => format!("{word} ({:04X}h)", *word as u16),
        Value::Long(long) => long.to_string(),
        Value::Float(float) => format_float(*float),
        Value::Text(text) => format!("\"{text}\""),
        other => format!("{other:?}"),
    }
}

fn integer(literal: &Literal) -> Result<i64, String> {
    match literal {
        Literal::Integer(value) => Ok(*value),
        Literal::Float(value) if value.fract() == 0.0 && value.abs() < 1e15 => Ok(*value as i64),
        Literal::Float(value) => Err(format!("expected a whole number, found {value}")),
        Literal::Text(text) => digits(text).ok_or_else(|| format!("expected a number, found \"{text}\"")),
    }
}

/// `0xF0F0`, `F0F0h`, `0b1010`, `-12`.
pub(super) fn digits(text: &str) -> Option<i64> {
    let text = text.trim().replace('_', "");
    let lower = text.to_ascii_lowercase();
    let (digits, radix) = match (lower.strip_prefix("0x"), lower.strip_prefix("0b"), lower.strip_suffix('h')) {
        (Some(digits), _, _) => (digits, 16),
        (_, _, Some(digits)) => (digits, 16),
        (_, Some(digits), _) => (digits, 2),
        _ => (lower.as_str(), 10),
    };
    if radix != 10 && digits.starts_with(['+', '-']) {
        return None;
    }
    i64::from_str_radix(digits, radix).ok()
}

/// Signed, or 16 bits written without a sign.
fn word(value: i64) -> Result<i16, String> {
    match (i16::try_from(value), u16::try_from(value)) {
        (Ok(word), _) => Ok(word),
        (_, Ok(bits)) => Ok(bits as i16),
        _ => Err(format!("{value} does not fit a word (-32768 to 32767, or 0 to FFFFh)")),
    }
}

fn long(value: i64) -> Result<i32, String> {
    match (i32::try_from(value), u32::try_from(value)) {
        (Ok(long), _) => Ok(long),
        (_, Ok(bits)) => Ok(bits as i32),
        _ => Err(format!("{value} does not fit a long word")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hex(text: &str) -> Literal {
        Literal::Text(text.to_owned())
    }

    #[test]
    fn words_are_equal_as_bits() {
        for literal in [hex("0xF0F0"), hex("F0F0h"), Literal::Integer(-3856), Literal::Integer(61680)] {
            assert_eq!(matches(&literal, &Value::Word(-3856)), Ok(None), "{literal}");
        }
        let wrong = matches(&Literal::Integer(100), &Value::Word(99)).expect("comparable").expect("different");
        assert_eq!((wrong.expected.as_str(), wrong.found.as_str()), ("100 (0064h)", "99 (0063h)"));
        assert!(matches(&Literal::Integer(70000), &Value::Word(0)).is_err());
        assert!(matches(&hex("ABC"), &Value::Word(0)).is_err());
        assert!(matches(&Literal::Integer(2), &Value::Bit(true)).is_err());
    }

    #[test]
    fn floats_are_equal_to_the_decimals_people_write() {
        assert_eq!(matches(&Literal::Float(0.1), &Value::Float(0.1)), Ok(None));
        assert_eq!(matches(&Literal::Integer(2), &Value::Float(2.0)), Ok(None));
        assert_eq!(matches(&Literal::Float(f64::NAN), &Value::Float(f32::NAN)), Ok(None));
        assert!(matches(&Literal::Float(1.0), &Value::Float(1.001)).is_ok_and(|found| found.is_some()));
        assert!(matches(&Literal::Float(f64::INFINITY), &Value::Float(f32::MAX)).is_ok_and(|found| found.is_some()));
    }

    #[test]
    fn strings_need_quotes_and_elements_a_member() {
        assert_eq!(matches(&hex("ABC"), &Value::Text("ABC".into())), Ok(None));
        assert!(value_for(&Literal::Integer(3), &Value::Text(String::new())).is_err());
        assert!(value_for(&Literal::Integer(3), &Value::Words(vec![0; 23])).is_err());
    }
}
