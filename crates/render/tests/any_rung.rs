//! Any rung at all: nothing cut off, nothing twice, nothing beyond the width.

mod common;

use common::{file, image, ins};
use ladder::{Branch, Documentation, Element, Rung, Series};
use proptest::prelude::*;
use render::Style;

/// What an element of a random rung becomes.
#[derive(Clone, Debug)]
enum Shape {
    Instruction(usize),
    Legs(Vec<Vec<Shape>>),
}

fn shapes(depth: u32) -> impl Strategy<Value = Vec<Shape>> {
    let leaf = (0..KINDS.len()).prop_map(Shape::Instruction);
    let element = leaf.prop_recursive(depth, 40, 4, |inner| {
        let leg = prop::collection::vec(inner, 0..4);
        prop::collection::vec(leg, 0..4).prop_map(Shape::Legs)
    });
    prop::collection::vec(element, 0..8)
}

/// Mnemonic and operands; `#` becomes a number that occurs once in the rung.
const KINDS: [(&str, &str); 9] = [
    ("XIC", "B3:#/5"),
    ("XIO", "I:0.0/#"),
    ("OTE", "B3:#/1"),
    ("ONS", "B3:#/2"),
    ("EQU", "N7:# N7:#"),
    ("ADD", "N7:# F8:# N7:#"),
    ("TON", "T4:# 1.0 # #"),
    ("XYZ", "N7:# #"),
    ("END", ""),
];

fn build(shapes: &[Shape], operands: &mut Vec<String>) -> Series {
    let mut next = |text: &str| {
        let parts: Vec<&str> = text.split('#').collect();
        let (last, heads) = parts.split_last().expect("split gives a part");
        let mut out = String::new();
        for head in heads {
            let number = (100 + operands.len()).to_string();
            out.push_str(head);
            out.push_str(&number);
            operands.push(number);
        }
        out + last
    };
    let mut series = Series::new();
    let mut rest = Vec::new();
    for shape in shapes {
        match shape {
            Shape::Instruction(kind) => series.push(ins(KINDS[*kind].0, &next(KINDS[*kind].1))),
            Shape::Legs(legs) => {
                rest.push((series.len(), legs));
                series.push(Element::Branch(Branch::default()));
            }
        }
    }
    for (at, legs) in rest {
        let legs = legs.iter().map(|leg| build(leg, operands)).collect();
        series[at] = Element::Branch(Branch { legs });
    }
    series
}

/// Columns of a text whose characters are all one wide.
fn columns(line: &str) -> usize {
    line.chars().count()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn every_operand_once_and_no_line_too_long(shapes in shapes(6), width in 60_usize..140, ascii: bool) {
        let mut operands = Vec::new();
        let rung = Rung::new(build(&shapes, &mut operands));
        let style = Style { width, ascii, ..Style::default() };
        let text = render::rung(&image(), &file(vec![rung]), 0, &Documentation::default(), &style);
        for line in text.lines() {
            prop_assert_eq!(columns(line), width, "{}", text);
        }
        for operand in &operands {
            let numbers = text.split(|c: char| !c.is_ascii_digit());
            prop_assert_eq!(numbers.filter(|number| number == operand).count(), 1, "{} in\n{}", operand, text);
        }
        prop_assert!(!ascii || text.is_ascii(), "{}", text);
    }

    #[test]
    fn any_text_stays_on_the_grid(symbol in ".{0,200}", comment in "\\PC{0,300}", width in 0_usize..90) {
        let mut series = vec![ins("XIC", "B3:0/0")];
        if let Element::Instruction(instruction) = &mut series[0] {
            instruction.operands[0] = ladder::Operand::Text(symbol);
        }
        let rung = common::commented(series, "", &comment);
        let style = Style { width, ascii: true, ..Style::default() };
        let text = render::rung(&image(), &file(vec![rung]), 0, &Documentation::default(), &style);
        prop_assert!(!text.contains(|c: char| c.is_control() && c != '\n'), "{text:?}");
        let rails = text.lines().all(|line| line.ends_with(['|', '+']));
        prop_assert!(rails, "{text}");
    }
}

fn drawn(rung: Rung) -> String {
    render::rung(&image(), &file(vec![rung]), 0, &Documentation::default(), &Style::default())
}

#[test]
fn long_rungs_cost_in_proportion() {
    let series = |count: usize| drawn(Rung::new((0..count).map(|_| ins("EQU", "N7:0 N7:1")).collect())).len();
    assert!(series(4000) < 11 * series(400), "{} {}", series(4000), series(400));
    let legs = |count: usize| {
        let legs = (0..count).map(|_| vec![ins("XIC", "B3:0/1")]).collect();
        drawn(Rung::new(vec![Element::Branch(Branch { legs }), ins("OTE", "B3:0/2")])).len()
    };
    assert!(legs(5000) < 11 * legs(500), "{} {}", legs(5000), legs(500));
}

#[test]
fn rungs_nested_too_deep_are_written_in_words() {
    let mut series = vec![ins("XIC", "B3:0/7")];
    for _ in 0..500 {
        series = vec![Element::Branch(Branch { legs: vec![series, Vec::new()] })];
    }
    series.push(ins("OTE", "B3:0/8"));
    let text = drawn(Rung::new(series));
    assert!(text.contains("nested too deep"), "{text}");
    let words: Vec<&str> = text.split(|c: char| c == '│' || c.is_whitespace()).collect();
    let count = |word| words.iter().filter(|w| **w == word).count();
    assert_eq!((count("BST"), count("NXB"), count("BND"), count("B3:0/7"), count("B3:0/8")), (500, 500, 500, 1, 1));
    for line in text.lines() {
        assert_eq!(columns(line), 100, "{line}");
    }
}

#[test]
fn rungs_with_too_many_elements_are_written_in_words() {
    let rung = |count: usize| Rung::new((0..count).map(|_| ins("XIC", "B3:0/7")).collect());
    let words = |text: &str| text.matches("XIC").count();
    // A contact has no mnemonic in a drawing.
    assert_eq!(words(&drawn(rung(20_000))), 0, "the largest rung that is drawn");
    let text = drawn(rung(20_001));
    assert!(text.contains("more elements than a drawing can show"), "{}", text.get(..500).unwrap_or(&text));
    assert_eq!(words(&text), 20_001);
    assert!(text.lines().all(|line| columns(line) == 100));
    // Branches and their legs count too, however they are spread.
    let legs = |count: usize| Branch { legs: (0..count).map(|_| vec![ins("XIC", "B3:0/7")]).collect() };
    let text = drawn(Rung::new(vec![Element::Branch(legs(5_000)), Element::Branch(legs(5_001))]));
    assert!(text.contains("more elements than a drawing can show"));
    assert_eq!((words(&text), text.matches("NXB").count()), (10_001, 9_999));
}

#[test]
fn nothing_beyond_the_last_rung() {
    assert_eq!(render::rung(&image(), &file(Vec::new()), 3, &Documentation::default(), &Style::default()), "");
}
