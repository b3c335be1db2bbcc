//! Rungs over the whole instruction table: text and model give each other back.

use convert::slc::rung::{parse_rung, parse_rungs, rung_text, rung_text_for};
use instr::{Form, Kind};
use ladder::{Branch, Element, Expression, Family, Instruction, Mnemonic, Operand, Rung, Series};
use proptest::prelude::*;

/// Texts of operands as they stand in projects, and some that should not.
fn operand_text() -> impl Strategy<Value = String> {
    prop_oneof![
        8 => (0..12_u16, 0..256_u16, 0..16_u16).prop_map(|(kind, element, bit)| match kind {
            0 => format!("B3:{element}/{bit}"),
            1 => format!("I:{bit}.0/{bit}"),
            2 => format!("T4:{element}/DN"),
            3 => format!("T4:{element}.PRE"),
            4 => format!("#N7:{element}"),
            5 => format!("N[N7:{element}]:[N7:{bit}]"),
            6 => format!("S:1/{bit}"),
            7 => format!("HSC:{bit}.ACC"),
            8 => format!("C5:{element}"),
            9 => format!("ST9:{element}"),
            _ => format!("N{bit}:{element}"),
        }),
        3 => (-40_000..70_000_i32).prop_map(|number| number.to_string()),
        1 => any::<u16>().prop_map(|mask| format!("0{mask:04X}h")),
        1 => (0..10_000_u32).prop_map(|part| format!("{}.{}", part % 7, part)),
        1 => any::<u16>().prop_map(|file| format!("U:{file}")),
        1 => (any::<u16>(), any::<u16>()).prop_map(|(file, label)| format!("Q{file}:{label}")),
        1 => Just("HSC0".to_owned()),
        1 => Just("?".to_owned()),
        1 => Just(String::new()),
        1 => "[A-Z][A-Z0-9_]{0,12}(\\.ACC|/3)?",
        1 => prop::sample::select(vec!["MOV", "OR", "and", "END", "BST", "op0x12", "op0x", "(", ")", "TON("])
            .prop_map(str::to_owned),
        1 => "\\PC{0,12}",
        1 => any::<String>().prop_map(|text| text.chars().take(9).collect()),
    ]
}

fn expression_text() -> impl Strategy<Value = String> {
    let value = "(N7:[0-9]|F8:1|-?[0-9]{1,4}|1\\.5|TANK_LEVEL|NEXT)";
    value.prop_recursive(4, 16, 2, |inner| {
        let operator = prop::sample::select(vec!["+", "-", "*", "|", "**", "AND", "OR", "XOR", "MOD"]);
        let function = prop::sample::select(vec!["-", "NOT", "SQR", "SIN", "LN", "RAD"]);
        prop_oneof![
            (inner.clone(), operator, inner.clone()).prop_map(|(a, op, b)| format!("( {a} {op} {b} )")),
            (inner.clone(), Just("OR"), inner.clone()).prop_map(|(a, op, b)| format!("{a} {op} {b}")),
            (function, inner).prop_map(|(name, a)| format!("{name} {a}")),
        ]
    })
}

fn operand(kind: Kind) -> BoxedStrategy<Operand> {
    let any_text = operand_text().prop_map(|text| Operand::parse(&text));
    match kind {
        Kind::Expression => prop_oneof![
            6 => expression_text().prop_filter_map("an expression", |text| {
                Expression::parse(&text).ok().map(Operand::Expression)
            }),
            1 => any_text,
        ]
        .boxed(),
        Kind::ProgramFile => prop_oneof![4 => any::<u16>().prop_map(Operand::ProgramFile), 1 => any_text].boxed(),
        _ => any_text.boxed(),
    }
}

/// Operands for a form; now and then one too many or not blank where the box is.
fn operands(form: &'static Form) -> impl Strategy<Value = Vec<Operand>> {
    let each: Vec<BoxedStrategy<Operand>> = form
        .operands
        .iter()
        .map(|spec| if spec.in_text() { operand(spec.kind) } else { Just(Operand::Empty).boxed() })
        .collect();
    (each, prop::option::weighted(0.05, operand(Kind::Word)), prop::bool::weighted(0.05)).prop_map(
        |(mut operands, surplus, less)| {
            operands.extend(surplus);
            if less {
                operands.pop();
            }
            operands
        },
    )
}

fn instruction() -> impl Strategy<Value = Element> {
    let forms: Vec<(&'static str, &'static Form)> =
        instr::all().iter().flat_map(|entry| entry.forms.iter().map(|form| (entry.mnemonic, form))).collect();
    let shared: Vec<_> = forms.iter().filter(|(name, _)| ["CPT", "AND", "OR", "XOR"].contains(name)).copied().collect();
    let known = |forms: Vec<(&'static str, &'static Form)>| {
        prop::sample::select(forms)
            .prop_flat_map(|(name, form)| operands(form).prop_map(move |o| Instruction::new(Mnemonic::named(name), o)))
    };
    let unknown = (any::<u16>(), prop::collection::vec(operand(Kind::Word), 0..4))
        .prop_map(|(code, operands)| Instruction::new(Mnemonic::Unknown(code), operands));
    prop_oneof![8 => known(forms), 2 => known(shared), 1 => unknown].prop_map(Element::Instruction)
}

fn series() -> impl Strategy<Value = Series> {
    prop::collection::vec(instruction(), 0..4).prop_recursive(4, 24, 4, |inner| {
        let branch = prop::collection::vec(inner.clone(), 1..4).prop_map(|legs| vec![Element::Branch(Branch { legs })]);
        (inner.clone(), branch, inner).prop_map(|(before, branch, after)| [before, branch, after].concat())
    })
}

fn family() -> impl Strategy<Value = Option<Family>> {
    prop::option::of(prop::sample::select(Family::all().collect::<Vec<_>>()))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn rungs_come_back(series in series(), family in family()) {
        let rung = Rung::new(series);
        let text = rung_text_for(&rung, family);
        prop_assert!(!text.contains(['\r', '\n']));
        let again = parse_rung(&text, family).map_err(|error| TestCaseError::fail(format!("{text}: {error}")))?;
        prop_assert!(again.same_logic(&rung), "{text}\n{again:?}\n{rung:?}");
        prop_assert_eq!(rung_text_for(&again, family), text);
    }

    #[test]
    fn lists_come_back(list in prop::collection::vec(series(), 0..4)) {
        let rungs: Vec<Rung> = list.into_iter().map(Rung::new).collect();
        let text: Vec<String> = rungs.iter().map(rung_text).collect();
        let again = parse_rungs(&text.join("\n"), None)
            .map_err(|errors| TestCaseError::fail(format!("{text:?}: {errors:?}")))?;
        prop_assert_eq!(again.len(), rungs.len());
        prop_assert!(again.iter().zip(&rungs).all(|(a, b)| a.same_logic(b)), "{text:#?}");
    }

    /// Words that can stand in rung text, in any order: whatever is accepted settles.
    #[test]
    fn accepted_text_settles(words in prop::collection::vec(word(), 0..30), family in family()) {
        if let Ok(rung) = parse_rung(&words.join(" "), family) {
            let text = rung_text_for(&rung, family);
            let again = parse_rung(&text, family).map_err(|error| TestCaseError::fail(format!("{text}: {error}")))?;
            prop_assert!(again.same_logic(&rung), "{text}");
            prop_assert_eq!(rung_text_for(&again, family), text);
        }
    }

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC*", family in family()) {
        let _ = parse_rung(&text, family);
        let _ = parse_rungs(&text, family);
    }
}

fn word() -> impl Strategy<Value = String> {
    prop_oneof![
        prop::sample::select(vec!["SOR", "EOR", "BST", "NXB", "BND", "(", ")", "?", "\"\"", "+", "CPT", "OSR", "MSG"])
            .prop_map(str::to_owned),
        prop::sample::select(instr::all()).prop_map(|entry| entry.mnemonic.to_owned()),
        prop::sample::select(instr::all()).prop_map(|entry| format!("{}(", entry.mnemonic)),
        operand_text(),
        expression_text(),
    ]
}
