//! Expressions through the parser, postfix and evaluation.

use ladder::Constant;
use proptest::prelude::*;

use super::*;
use crate::exec::{Lineage, Rules};

/// Operands are constants here.
fn steps(text: &str) -> Vec<Step<Number>> {
    let expression = Expression::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    let mut resolve = |operand: &Operand| match operand {
        Operand::Constant(constant) => Ok(number(constant)),
        other => Err(format!("{other:?}")),
    };
    postfix(&expression, &mut resolve).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn number(constant: &Constant) -> Number {
    match constant.to_string().parse::<i32>() {
        Ok(value) => i16::try_from(value).map_or(Number::Long(value), Number::Word),
        Err(_) => Number::Float(constant.to_string().parse().unwrap_or(f32::NAN)),
    }
}

fn computed(text: &str, to: Width, mode: MathMode) -> (Option<Number>, Flags) {
    let steps = steps(text);
    assert!(is_well_formed(&steps), "{text}");
    let float = is_float(&steps, to, |value| value.width());
    let outcome = evaluate(&steps, |value| value, float, to, mode).unwrap_or_else(|| panic!("{text}"));
    (outcome.value, outcome.flags)
}

fn word(text: &str) -> (Option<Number>, Flags) {
    computed(text, Width::Word, Rules::new(Lineage::S3).math(0))
}

fn w(value: i16) -> Option<Number> {
    Some(Number::Word(value))
}

#[test]
fn precedence_and_rounding() {
    assert_eq!(word("2 + 3 * 4"), (w(14), Flags::NONE));
    assert_eq!(word("( 2 + 3 ) * 4"), (w(20), Flags::NONE));
    assert_eq!(word("11 | 2"), (w(6), Flags::NONE), "rounded as in DIV");
    assert_eq!(word("1 | 2 * 2"), (w(2), Flags::NONE), "each integer step is rounded");
    assert_eq!(word("1 | 2 * 2.0"), (w(1), Flags::NONE), "a float anywhere makes every step a float one");
    assert_eq!(word("5 - 5"), (w(0), Flags::ZERO));
    assert_eq!(word("- 5 + 2"), (w(-3), Flags::SIGN));
    assert_eq!(word("2 ** 10"), (w(1024), Flags::NONE));
    assert_eq!(word("7 MOD 4"), (w(3), Flags::NONE));
    assert_eq!(word("SQR 16"), (w(4), Flags::NONE));
    assert_eq!(word("ABS ( 3 - 5 )"), (w(2), Flags::NONE));
    assert_eq!(word("12 AND 10 OR 1"), (w(9), Flags::NONE));
    assert_eq!(word("12 XOR 10"), (w(6), Flags::NONE));
    assert_eq!(word("NOT 0"), (w(-1), Flags::SIGN));
    assert_eq!(word("TOD 1234"), (w(0x1234), Flags::NONE));
    assert_eq!(word("FRD 4660"), (w(1234), Flags::NONE));
    assert_eq!(word("COS 0"), (w(1), Flags::NONE));
}

#[test]
fn long_intermediates_and_the_final_store() {
    assert_eq!(word("30000 * 30000 | 30000"), (w(30000), Flags::NONE));
    assert_eq!(word("30000 + 30000"), (w(32767), Flags::OVERFLOW));
    let wrapping = Rules::new(Lineage::S3).math(0x4000);
    assert_eq!(computed("30000 + 30000", Width::Word, wrapping), (w(-5536), Flags::OVERFLOW | Flags::SIGN));
    assert_eq!(word("1 | 0 * 0").1, Flags::OVERFLOW | Flags::ZERO, "an overflow on the way is told");
    assert_eq!(word("7 MOD 0").1, Flags::OVERFLOW);
    let float = computed("10 | 4", Width::Float, Rules::new(Lineage::S3).math(0));
    assert_eq!(float, (Some(Number::Float(2.5)), Flags::NONE));
}

#[test]
fn stepwise_reading() {
    let stepwise = Rules::new(Lineage::S3).with(Choice::CptStepwise).math(0);
    assert_eq!(computed("1 | 2 * 2.0", Width::Word, stepwise), (w(2), Flags::NONE));
}

#[test]
fn malformed_steps_are_refused() {
    let value = Step::Value(Number::Word(1));
    let deep = vec![value; MAX_DEPTH + 1];
    let broken: [&[Step<Number>]; 5] =
        [&[], &[value, value], &[Step::Binary(Operator::Add)], &[value, Step::Binary(Operator::Add)], &deep];
    for steps in broken {
        assert!(!is_well_formed(steps));
        let outcome = evaluate(steps, |value| value, false, Width::Word, Rules::new(Lineage::S3).math(0));
        assert_eq!(outcome, None);
    }
}

fn any_step() -> impl Strategy<Value = Step<Number>> {
    let functions = ["-", "NOT", "SQR", "ABS", "LN", "SIN", "FRD", "TOD", "DEG"];
    let operators = ["OR", "XOR", "AND", "+", "-", "*", "|", "MOD", "**"];
    let unary = prop::sample::select(functions.to_vec()).prop_filter_map("function", |name| {
        steps(&format!("{name} 1")).into_iter().find(|step| matches!(step, Step::Unary(_)))
    });
    let binary = prop::sample::select(operators.to_vec()).prop_filter_map("operator", |name| {
        steps(&format!("1 {name} 1")).into_iter().find(|step| matches!(step, Step::Binary(_)))
    });
    prop_oneof![
        any::<i16>().prop_map(|v| Step::Value(Number::Word(v))),
        any::<i32>().prop_map(|v| Step::Value(Number::Long(v))),
        any::<u32>().prop_map(|v| Step::Value(Number::Float(f32::from_bits(v)))),
        unary,
        binary,
    ]
}

proptest! {
    #[test]
    fn evaluation_agrees_with_the_check(steps in prop::collection::vec(any_step(), 0..12), float: bool, s2: u16) {
        let mode = Rules::new(Lineage::Mx).math(s2);
        let outcome = evaluate(&steps, |value| value, float, Width::Word, mode);
        prop_assert_eq!(outcome.is_some(), is_well_formed(&steps));
    }
}
