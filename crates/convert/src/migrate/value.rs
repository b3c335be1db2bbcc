//! Values as text of MATH expressions, each with the range it can have.
//!
//! A conversion is exact only where nothing depends on what Do-more does with a 32-bit result that
//! does not fit, with the quotient of negative numbers, or with the order of operators. So values
//! carry their bounds, and parentheses stand wherever two readings of an expression are possible.

use instr::exec::{Number, Width};

/// How tightly the outermost operator of a text binds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Bind {
    /// Bitwise operators: their order against the others is not documented.
    Bits,
    /// A sum or difference.
    Sum,
    /// A product, quotient or remainder.
    Product,
    /// A sign in front.
    Sign,
    /// A name, a number, a call.
    Atom,
}

/// A value of the original as text of an expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Value {
    text: String,
    bind: Bind,
    /// The operand, where the value is one by itself, outside expressions too.
    plain: Option<String>,
    /// What it is in the original.
    pub(super) width: Width,
    /// Lowest value, for integers.
    pub(super) low: i64,
    /// Highest value, for integers.
    pub(super) high: i64,
    /// Known before the program runs.
    pub(super) constant: Option<Number>,
}

/// The limits of an integer width.
pub(super) fn limits(width: Width) -> (i64, i64) {
    match width {
        Width::Word => (i64::from(i16::MIN), i64::from(i16::MAX)),
        Width::Long | Width::Float => (i64::from(i32::MIN), i64::from(i32::MAX)),
    }
}

/// A number of single precision as an expression and Designer's editor take it: without exponent.
pub(super) fn real_text(value: f32) -> String {
    let text = value.to_string();
    if text.contains('.') { text } else { format!("{text}.0") }
}

impl Value {
    /// An element that is an operand by itself: `N7`, `R20`, `T0.Acc`.
    pub(super) fn element(text: impl Into<String>, width: Width) -> Value {
        let (low, high) = limits(width);
        let text = text.into();
        Value { plain: Some(text.clone()), text, bind: Bind::Atom, width, low, high, constant: None }
    }

    /// An element that only expressions can name: `N[N7 + 100]`.
    pub(super) fn indexed(text: impl Into<String>, width: Width) -> Value {
        Value { plain: None, ..Value::element(text, width) }
    }

    /// A text of an expression about which nothing but its width is known.
    pub(super) fn expression(text: impl Into<String>, width: Width) -> Value {
        Value { plain: None, bind: Bind::Bits, ..Value::element(text, width) }
    }

    /// A function call, or another text that needs no parentheses.
    pub(super) fn call(text: impl Into<String>, width: Width) -> Value {
        Value { bind: Bind::Atom, ..Value::expression(text, width) }
    }

    /// A whole number; its width in the original is the smallest that holds it.
    pub(super) fn integer(value: i64) -> Value {
        let word = i16::try_from(value);
        let width = if word.is_ok() { Width::Word } else { Width::Long };
        let number = match word {
            Ok(word) => Number::Word(word),
            Err(_) => Number::Long(value as i32),
        };
        let plain = value.to_string();
        // Behind the sign stands a number of its own, and 2147483648 is none of 32 bits.
        let (text, bind) = match value {
            value if value == i64::from(i32::MIN) => ("-2147483647 - 1".to_owned(), Bind::Sum),
            value if value < 0 => (plain.clone(), Bind::Sign),
            _ => (plain.clone(), Bind::Atom),
        };
        Value { text, bind, plain: Some(plain), width, low: value, high: value, constant: Some(number) }
    }

    /// A float constant.
    pub(super) fn real(value: f32) -> Value {
        let bind = if value.is_sign_negative() { Bind::Sign } else { Bind::Atom };
        let constant = Some(Number::Float(value));
        let text = real_text(value);
        Value { plain: Some(text.clone()), text, bind, width: Width::Float, low: 0, high: 0, constant }
    }

    /// A constant of any kind.
    pub(super) fn number(value: Number) -> Value {
        match value {
            Number::Word(value) => Value::integer(value.into()),
            Number::Long(value) => Value::integer(value.into()),
            Number::Float(value) => Value::real(value),
        }
    }

    /// The text of the expression.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// The operand, where the value is one by itself.
    pub(super) fn plain(&self) -> Option<&str> {
        self.plain.as_deref()
    }

    /// It is a float.
    pub(super) fn is_float(&self) -> bool {
        self.width == Width::Float
    }

    /// Its constant value as an integer.
    pub(super) fn known(&self) -> Option<i64> {
        self.constant.and_then(Number::integer)
    }

    /// Every value it can have lies between the two.
    pub(super) fn within(&self, low: i64, high: i64) -> bool {
        !self.is_float() && self.low >= low && self.high <= high
    }

    /// It fits the destination of an integer width.
    pub(super) fn fits(&self, width: Width) -> bool {
        let (low, high) = limits(width);
        self.within(low, high)
    }

    /// The same value with narrower bounds.
    #[must_use]
    pub(super) fn bounded(mut self, low: i64, high: i64) -> Value {
        (self.low, self.high) = (low, high);
        self
    }

    fn compound(text: String, bind: Bind, low: i64, high: i64) -> Value {
        Value { text, bind, plain: None, width: Width::Long, low, high, constant: None }
    }

    /// The text where an operand of at least this strength belongs.
    fn tight(&self, least: Bind) -> String {
        if self.bind >= least { self.text.clone() } else { format!("({})", self.text) }
    }

    /// The text where only a name, a number or a call may stand without parentheses.
    pub(super) fn atom(&self) -> String {
        self.tight(Bind::Atom)
    }

    /// The text for the left of a product.
    fn factor(&self) -> String {
        self.tight(Bind::Product)
    }

    /// `self + other`.
    pub(super) fn plus(&self, other: &Value) -> Value {
        let bounds = (self.low.saturating_add(other.low), self.high.saturating_add(other.high));
        match (self.known(), other.known()) {
            (Some(a), Some(b)) => return Value::integer(a.saturating_add(b)),
            (_, Some(0)) => return self.clone(),
            (Some(0), _) => return other.clone(),
            _ => {}
        }
        let text = match other.known() {
            Some(negative) if negative < 0 => format!("{} - {}", self.tight(Bind::Sum), negative.unsigned_abs()),
            _ => format!("{} + {}", self.tight(Bind::Sum), other.right()),
        };
        Value::compound(text, Bind::Sum, bounds.0, bounds.1)
    }

    /// `self - other`.
    pub(super) fn minus(&self, other: &Value) -> Value {
        let bounds = (self.low.saturating_sub(other.high), self.high.saturating_sub(other.low));
        match (self.known(), other.known()) {
            (Some(a), Some(b)) => return Value::integer(a.saturating_sub(b)),
            (_, Some(0)) => return self.clone(),
            (Some(0), _) => return other.negated(),
            _ => {}
        }
        let text = match other.known() {
            Some(negative) if negative < 0 => format!("{} + {}", self.tight(Bind::Sum), negative.unsigned_abs()),
            _ => format!("{} - {}", self.tight(Bind::Sum), other.right()),
        };
        Value::compound(text, Bind::Sum, bounds.0, bounds.1)
    }

    /// The text to the right of a sum.
    fn right(&self) -> String {
        match self.bind {
            Bind::Product | Bind::Atom => self.text.clone(),
            _ => format!("({})", self.text),
        }
    }

    /// `self * other`.
    pub(super) fn times(&self, other: &Value) -> Value {
        match (self.known(), other.known()) {
            (Some(a), Some(b)) => return Value::integer(a.saturating_mul(b)),
            (_, Some(1)) => return self.clone(),
            (Some(1), _) => return other.clone(),
            (_, Some(0)) | (Some(0), _) => return Value::integer(0),
            _ => {}
        }
        let corners = [
            self.low.saturating_mul(other.low),
            self.low.saturating_mul(other.high),
            self.high.saturating_mul(other.low),
            self.high.saturating_mul(other.high),
        ];
        let (low, high) = (corners.into_iter().min().unwrap_or(0), corners.into_iter().max().unwrap_or(0));
        Value::compound(format!("{} * {}", self.factor(), other.atom()), Bind::Product, low, high)
    }

    /// `self / divisor` of numbers that are not negative, `divisor` not zero: the quotient without
    /// its fraction.
    pub(super) fn over(&self, divisor: &Value) -> Value {
        if divisor.known() == Some(1) {
            return self.clone();
        }
        let high = self.high / divisor.low.max(1);
        Value::compound(format!("{} / {}", self.factor(), divisor.atom()), Bind::Product, 0, high)
    }

    /// `self % divisor` of numbers that are not negative, `divisor` not zero.
    pub(super) fn rest(&self, divisor: &Value) -> Value {
        let high = divisor.high.saturating_sub(1).min(self.high);
        Value::compound(format!("{} % {}", self.factor(), divisor.atom()), Bind::Product, 0, high)
    }

    /// `-self`.
    #[must_use]
    pub(super) fn negated(&self) -> Value {
        match self.known() {
            Some(value) => Value::integer(value.saturating_neg()),
            None => {
                let bounds = (self.high.saturating_neg(), self.low.saturating_neg());
                Value::compound(format!("-{}", self.atom()), Bind::Sign, bounds.0, bounds.1)
            }
        }
    }

    /// `ABS(self)`; nothing where it cannot be negative.
    #[must_use]
    pub(super) fn magnitude(&self) -> Value {
        if self.low >= 0 {
            return self.clone();
        }
        if let Some(value) = self.known() {
            return Value::integer(value.saturating_abs());
        }
        let high = self.low.saturating_abs().max(self.high.saturating_abs());
        let low = if self.high < 0 { self.high.saturating_abs() } else { 0 };
        Value::compound(format!("ABS({})", self.text), Bind::Atom, low, high)
    }

    /// `self & other`: of 32 bits in two's complement.
    pub(super) fn bit_and(&self, other: &Value) -> Value {
        if let (Some(a), Some(b)) = (self.known(), other.known()) {
            return Value::integer(a & b);
        }
        // A factor that is not negative limits the result; two words give a word.
        let positive = [self, other].into_iter().filter(|value| value.low >= 0).map(|value| value.high).min();
        let (low, high) = match positive {
            Some(high) => (0, high),
            None => joint_limits(self, other),
        };
        Value::compound(format!("{} & {}", self.atom(), other.atom()), Bind::Bits, low, high)
    }

    /// `self | other`.
    pub(super) fn bit_or(&self, other: &Value) -> Value {
        match (self.known(), other.known()) {
            (Some(a), Some(b)) => return Value::integer(a | b),
            (Some(0), _) => return other.clone(),
            (_, Some(0)) => return self.clone(),
            _ => {}
        }
        let (low, high) = joint_limits(self, other);
        Value::compound(format!("{} | {}", self.atom(), other.atom()), Bind::Bits, low, high)
    }

    /// The exclusive or, by operators that are known: `(a | b) - (a & b)`.
    pub(super) fn bit_xor(&self, other: &Value) -> Value {
        if let (Some(a), Some(b)) = (self.known(), other.known()) {
            return Value::integer(a ^ b);
        }
        let (low, high) = joint_limits(self, other);
        let [a, b] = [self.atom(), other.atom()];
        Value::compound(format!("({a} | {b}) - ({a} & {b})"), Bind::Sum, low, high)
    }

    /// Every bit inverted: `-1 - self`.
    #[must_use]
    pub(super) fn inverted(&self) -> Value {
        Value::integer(-1).minus(self)
    }

    /// A float as it stands in an expression of floats: integers are converted.
    pub(super) fn as_float(&self) -> Value {
        match (self.width, self.known()) {
            (Width::Float, _) => self.clone(),
            (_, Some(value)) => Value::real(value as f32),
            (_, None) => float(format!("TOREAL({})", self.text), Bind::Atom),
        }
    }

    /// A float operand beside another: an integer is left to be converted by the operation when the
    /// other one is a float.
    fn beside(&self, other: &Value) -> Value {
        match (self.width, other.width) {
            (Width::Word, Width::Float) if self.constant.is_none() => Value { width: Width::Float, ..self.clone() },
            _ => self.as_float(),
        }
    }

    /// An operation of floats: `+`, `-`, `*` or `/`.
    pub(super) fn float_operation(&self, sign: char, other: &Value) -> Value {
        if let (Some(a), Some(b)) = (self.constant, other.constant) {
            let (a, b) = (a.float(), b.float());
            return Value::real(match sign {
                '+' => a + b,
                '-' => a - b,
                '*' => a * b,
                _ => a / b,
            });
        }
        // A constant is written as a float, which makes the operation one.
        let known = |value: &Value| if value.constant.is_some() { value.as_float() } else { value.clone() };
        let (this, other) = (known(self), &known(other));
        let left = this.beside(other);
        // One float is enough to make the operation one.
        let right = other.beside(&Value { width: Width::Float, ..left.clone() });
        let (bind, left_least) = match sign {
            '+' | '-' => (Bind::Sum, Bind::Sum),
            _ => (Bind::Product, Bind::Product),
        };
        let right = if bind == Bind::Sum { right.right() } else { right.atom() };
        float(format!("{} {sign} {right}", left.tight(left_least)), bind)
    }

    /// A function of a float.
    pub(super) fn float_function(&self, name: &str) -> Value {
        float(format!("{name}({})", self.as_float().text), Bind::Atom)
    }

    /// `-self` of a float.
    #[must_use]
    pub(super) fn float_negated(&self) -> Value {
        match self.as_float() {
            Value { constant: Some(Number::Float(value)), .. } => Value::real(-value),
            value => float(format!("-{}", value.atom()), Bind::Sign),
        }
    }
}

impl Value {
    /// Its constant value as a float.
    pub(super) fn known_float(&self) -> Option<f32> {
        self.constant.map(Number::float)
    }
}

fn float(text: String, bind: Bind) -> Value {
    Value { text, bind, plain: None, width: Width::Float, low: 0, high: 0, constant: None }
}

/// The limits of the wider of two integers: bitwise results of sign-extended numbers stay inside.
fn joint_limits(a: &Value, b: &Value) -> (i64, i64) {
    if a.fits(Width::Word) && b.fits(Width::Word) { limits(Width::Word) } else { limits(Width::Long) }
}

/// `IF(condition, then, otherwise)`.
pub(super) fn choose(condition: &str, then: &Value, otherwise: &Value) -> Value {
    let text = format!("IF({condition}, {}, {})", then.text, otherwise.text);
    if then.is_float() || otherwise.is_float() {
        return float(text, Bind::Atom);
    }
    Value::compound(text, Bind::Atom, then.low.min(otherwise.low), then.high.max(otherwise.high))
}

/// A condition of an expression, `sign` one of `==`, `>` and `<`.
pub(super) fn relation(a: &Value, sign: &str, b: &Value) -> String {
    format!("{} {sign} {}", a.tight(Bind::Sum), b.tight(Bind::Sum))
}

/// The value kept between the limits of a width.
pub(super) fn limited(value: &Value, width: Width) -> Value {
    let (low, high) = limits(width);
    between(value, low, high)
}

/// The value kept between two numbers.
pub(super) fn between(value: &Value, low: i64, high: i64) -> Value {
    let inner = if value.low < low {
        choose(&relation(value, "<", &Value::integer(low)), &Value::integer(low), value)
    } else {
        value.clone()
    };
    let limited = if value.high > high {
        choose(&relation(value, ">", &Value::integer(high)), &Value::integer(high), &inner)
    } else {
        inner
    };
    limited.bounded(value.low.max(low).min(high), value.high.min(high).max(low))
}

/// The low 16 bits as a signed word.
pub(super) fn wrapped(value: &Value) -> Value {
    let low = Value::integer(65_535);
    if value.high > limits(Width::Long).1 - 32_768 {
        // No sum that leaves 32 bits.
        let low = value.bit_and(&low);
        let top = relation(&low, ">", &Value::integer(32_767));
        return choose(&top, &low.minus(&Value::integer(65_536)), &low).bounded(-32_768, 32_767);
    }
    let shifted = value.plus(&Value::integer(32_768)).bit_and(&low);
    shifted.minus(&Value::integer(32_768)).bounded(-32_768, 32_767)
}

/// `dividend / divisor` rounded to the nearest integer, halves away from zero, as one expression.
///
/// `divisor` is a positive constant; every sum fits 32 bits, or `None`.
pub(super) fn rounded_quotient(dividend: &Value, divisor: i64) -> Option<Value> {
    let half = Value::integer(divisor / 2);
    let by = Value::integer(divisor);
    let positive = dividend.plus(&half);
    let negative = half.minus(dividend);
    let quotient = |value: &Value| value.over(&by);
    let bounds = |value: i64| (value.saturating_abs().saturating_add(divisor / 2) / divisor.max(1)) * value.signum();
    let (low, high) = (bounds(dividend.low), bounds(dividend.high));
    if divisor == 1 {
        return Some(dividend.clone());
    }
    if dividend.low >= 0 {
        return positive.fits(Width::Long).then(|| quotient(&positive).bounded(low, high));
    }
    if !positive.fits(Width::Long) || !negative.fits(Width::Long) {
        return None;
    }
    let below = quotient(&negative).negated();
    Some(choose(&relation(dividend, "<", &Value::integer(0)), &below, &quotient(&positive)).bounded(low, high))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn n(number: u32) -> Value {
        Value::element(format!("N{number}"), Width::Word)
    }

    fn k(value: i64) -> Value {
        Value::integer(value)
    }

    #[test]
    fn parentheses_stand_where_they_are_needed() {
        assert_eq!(n(1).plus(&n(2).times(&k(3))).text(), "N1 + N2 * 3");
        assert_eq!(n(1).plus(&n(2)).times(&k(3)).text(), "(N1 + N2) * 3");
        assert_eq!(n(1).minus(&n(2).minus(&n(3))).text(), "N1 - (N2 - N3)");
        assert_eq!(n(1).plus(&k(-5)).text(), "N1 - 5");
        assert_eq!(n(1).minus(&k(-5)).text(), "N1 + 5");
        assert_eq!(n(1).times(&k(-5)).text(), "N1 * (-5)");
        assert_eq!(n(1).bit_and(&k(255)).plus(&k(1)).text(), "(N1 & 255) + 1");
        assert_eq!(n(1).plus(&k(0)), n(1));
        assert_eq!(n(1).negated().text(), "-N1");
        assert_eq!(n(1).bit_xor(&k(7)).text(), "(N1 | 7) - (N1 & 7)");
    }

    #[test]
    fn bounds_are_kept() {
        let product = n(1).times(&n(2));
        assert_eq!((product.low, product.high), (-32_768 * 32_767, 32_768 * 32_768));
        assert!(!n(1).plus(&k(1)).fits(Width::Word) && n(1).plus(&k(1)).fits(Width::Long));
        assert_eq!(limited(&n(1).plus(&k(1)), Width::Word).text(), "IF(N1 + 1 > 32767, 32767, N1 + 1)");
        let magnitude = n(1).magnitude();
        assert_eq!((magnitude.text(), magnitude.low, magnitude.high), ("ABS(N1)", 0, 32_768));
    }

    #[test]
    fn quotients_round_halves_away() {
        let text = |value: Option<Value>| value.map(|value| value.text().to_owned());
        assert_eq!(text(rounded_quotient(&n(1), 10)).as_deref(), Some("IF(N1 < 0, -((5 - N1) / 10), (N1 + 5) / 10)"));
        assert_eq!(text(rounded_quotient(&n(1).bounded(0, 100), 3)).as_deref(), Some("(N1 + 1) / 3"));
        assert_eq!(rounded_quotient(&Value::element("D1", Width::Long), 10), None);
    }

    #[test]
    fn floats_have_no_exponent() {
        assert_eq!(real_text(1e-7), "0.0000001");
        assert_eq!(real_text(20.0), "20.0");
        assert_eq!(real_text(1e12), "1000000000000.0");
        assert_eq!(n(1).float_operation('/', &n(2)).text(), "TOREAL(N1) / N2");
        assert_eq!(n(1).float_operation('*', &k(4)).text(), "N1 * 4.0");
        assert_eq!(Value::element("R1", Width::Float).float_operation('-', &n(2)).text(), "R1 - N2");
    }
}
