//! Any rung of Do-more text: nothing cut off, nothing twice, nothing beyond the width.

use domore::documentation::Documentation;
use domore::{CodeBlock, Instruction, Rung};
use proptest::prelude::*;
use render::Style;

/// Steps of a random stack program; `#` becomes a number that occurs once in the rung.
const STEPS: [(&str, &[&str]); 14] = [
    ("STR", &["C#"]),
    ("STRN", &["X#"]),
    ("AND", &["C#"]),
    ("OR", &["C#"]),
    ("ANDGE", &["N#", "N#"]),
    ("ORPD", &["C#"]),
    ("ANDSTR", &[]),
    ("ORSTR", &[]),
    ("DUPBOOL", &[]),
    ("POPBOOL", &[]),
    ("OUT", &["Y#"]),
    ("MATH", &["D#", "\"N# + 1\""]),
    ("TMR", &["T#", "5000"]),
    ("FANCY", &["D#", "\"x # y\""]),
];

const BOXES: [(&str, &[&str]); 3] = [("CNT", &["CT#", "N#"]), ("UDC", &["CT#", "N#", "DST#"]), ("TMRA", &["T#", "N#"])];

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn every_operand_once_and_no_line_too_long(
        steps in prop::collection::vec(0..STEPS.len(), 0..14),
        last in prop::option::of(0..BOXES.len()),
        width in 60_usize..140,
        ascii: bool,
    ) {
        let mut numbers = Vec::new();
        let mut make = |(mnemonic, operands): (&str, &[&str])| {
            let mut fill = |operand: &&str| {
                let number = (1000 + numbers.len()).to_string();
                if operand.contains('#') {
                    numbers.push(number.clone());
                }
                operand.replace('#', &number)
            };
            Instruction::new(mnemonic, operands.iter().map(&mut fill).collect::<Vec<_>>())
        };
        // A contact first, so that more rungs can be drawn than not.
        let mut instructions = vec![make(STEPS[0])];
        instructions.extend(steps.iter().map(|step| make(STEPS[*step])));
        instructions.extend(last.map(|last| make(BOXES[last])));
        let block = CodeBlock { rungs: vec![Rung::new(instructions)], ..CodeBlock::default() };
        let style = Style { width, ascii, ..Style::default() };
        let text = render::domore::rung(&block, 0, &Documentation::default(), &style);
        for line in text.lines() {
            prop_assert!(line.chars().count() <= width, "{}", text);
        }
        for number in &numbers {
            // Long operands are cut between words at most, never inside a number this short.
            prop_assert_eq!(text.matches(number.as_str()).count(), 1, "{} in\n{}", number, text);
        }
    }
}
