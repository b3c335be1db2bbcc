//! Constants as written in a program: `-255`, `0.5`, `00FFh`.

use std::fmt;

/// A constant operand: its value, and the spelling it was written in.
///
/// The spelling is part of the program (a mask is written `00FFh`, a float `1000.0`) and is kept, so
/// that text and model settle.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    text: String,
    number: Number,
}

/// The value of a constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    /// Decimal, or hex as its unsigned pattern (`0FFFFh` is 65535).
    Integer(i64),
    /// Written with a point or an exponent.
    Float(f32),
}

impl Constant {
    /// Reads decimal, hex (`00FFh`, `0xFF`, `0X00FF`, `FF00h`) and floats.
    /// `None` if the text is no number or does not fit 32 bits.
    pub fn parse(text: &str) -> Option<Constant> {
        let number = parse_number(text)?;
        Some(Constant { text: text.to_owned(), number })
    }

    /// A decimal integer.
    pub fn integer(value: i32) -> Constant {
        Constant { text: value.to_string(), number: Number::Integer(value.into()) }
    }

    /// A float in RSLogix's spelling, see [`format_float`].
    pub fn float(value: f32) -> Constant {
        Constant { text: format_float(value), number: Number::Float(value) }
    }

    /// The value.
    pub fn number(&self) -> Number {
        self.number
    }

    /// The value if it is an integer.
    pub fn as_integer(&self) -> Option<i64> {
        match self.number {
            Number::Integer(value) => Some(value),
            Number::Float(_) => None,
        }
    }

    /// The spelling.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Written in hex, as masks are.
    pub fn is_hex(&self) -> bool {
        self.text.ends_with(['h', 'H']) || self.text.starts_with("0x") || self.text.starts_with("0X")
    }
}

impl fmt::Display for Constant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

fn parse_number(text: &str) -> Option<Number> {
    let digits = text.strip_prefix('-').unwrap_or(text);
    if !digits.starts_with(|c: char| c.is_ascii_hexdigit() || c == '.') {
        return None;
    }
    let hex = digits
        .strip_prefix("0x")
        .or_else(|| digits.strip_prefix("0X"))
        .or_else(|| digits.strip_suffix(['h', 'H']).filter(|d| d.starts_with(|c: char| c.is_ascii_digit())))
        // `FF00h` without the leading zero that RSLogix writes: symbols have no lower-case letters.
        .or_else(|| digits.strip_suffix('h').filter(|d| d.bytes().all(|b| matches!(b, b'0'..=b'9' | b'A'..=b'F'))));
    if let Some(hex) = hex {
        let plain = digits.len() == text.len() && !hex.is_empty() && hex.bytes().all(|b| b.is_ascii_hexdigit());
        let value = plain.then(|| u32::from_str_radix(hex, 16).ok()).flatten()?;
        return Some(Number::Integer(value.into()));
    }
    if digits.bytes().all(|b| b.is_ascii_digit()) {
        let value: i64 = text.parse().ok()?;
        return (i64::from(i32::MIN)..=i64::from(u32::MAX)).contains(&value).then_some(Number::Integer(value));
    }
    let float_like = digits.starts_with(|c: char| c.is_ascii_digit() || c == '.')
        && digits.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'.' | b'e' | b'E' | b'+' | b'-'));
    let value: f32 = float_like.then(|| text.parse().ok()).flatten()?;
    value.is_finite().then_some(Number::Float(value))
}

/// A float as RSLogix prints it: 7 significant digits, at least `.0`, exponents with three digits
/// (`-1.192093E-007`), `!NaN!.0` for not-a-number. Every printed float of the reports beside known
/// projects agrees with this; the exponent form is known from two printed values.
pub fn format_float(value: f32) -> String {
    if value.is_nan() {
        return "!NaN!.0".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "!INF!.0" } else { "-!INF!.0" }.to_owned();
    }
    if value == 0.0 {
        return "0.0".to_owned();
    }
    // Seven significant digits in scientific form decide both the digits and the exponent.
    let scientific = format!("{value:.6e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..7).contains(&exponent) {
        let decimals = usize::try_from(6 - exponent).unwrap_or(0);
        let fixed = format!("{value:.decimals$}");
        return with_point(trim_zeros(&fixed));
    }
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{}E{sign}{:03}", with_point(trim_zeros(mantissa)), exponent.abs())
}

fn trim_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

fn with_point(text: &str) -> String {
    if text.contains('.') { text.to_owned() } else { format!("{text}.0") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings() {
        for (text, value) in [
            ("-255", -255),
            ("0FF00h", 0xFF00),
            ("00FFh", 255),
            ("0xFF", 255),
            ("FF00h", 0xFF00),
            ("0X00FF", 255),
            ("999999", 999_999),
        ] {
            assert_eq!(Constant::parse(text).and_then(|c| c.as_integer()), Some(value), "{text}");
        }
        for (text, value) in [("0.5", 0.5_f32), ("1000.0", 1000.0), ("-1.192093E-007", -1.192_093E-7), ("1e3", 1000.0)]
        {
            assert_eq!(Constant::parse(text).map(|c| c.number()), Some(Number::Float(value)), "{text}");
        }
        for text in
            ["", "-", "h", "FFH", "DEAH", "fFh", "12x", "N7", "1.2.3", "99999999999", "1 ", "inf", "nan", "-0x5"]
        {
            assert_eq!(Constant::parse(text), None, "{text}");
        }
    }

    #[test]
    fn floats_print_with_seven_digits() {
        for (value, text) in [
            (0.0_f32, "0.0"),
            (1.0, "1.0"),
            (0.01666667, "0.01666667"),
            (1000.0, "1000.0"),
            (-1.192_093E-7, "-1.192093E-007"),
            (123_456.7, "123456.7"),
            (9_999_999.0, "9999999.0"),
            (1e7, "1.0E+007"),
            (0.1, "0.1"),
            (f32::NAN, "!NaN!.0"),
        ] {
            assert_eq!(format_float(value), text);
        }
    }
}
