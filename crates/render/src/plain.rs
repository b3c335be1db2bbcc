//! A rung as words, for the rare one that cannot be drawn.

use ladder::{Element, Series};

use crate::text::clean;

/// Mnemonics and operands in stored order with `BST`, `NXB` and `BND` around branches. Works at any
/// depth.
pub(crate) fn words(series: &Series) -> String {
    let mut text = String::new();
    let mut word = |part: &str| {
        if !text.is_empty() {
            text.push(' ');
        }
        text.push_str(&clean(part));
    };
    // Series that are being written, and the legs still to come of the branches around them.
    let mut open = vec![series.iter()];
    let mut legs: Vec<std::slice::Iter<'_, Series>> = Vec::new();
    while let Some(elements) = open.last_mut() {
        match elements.next() {
            Some(Element::Instruction(instruction)) => {
                word(&instruction.mnemonic.to_string());
                for operand in instruction.operands.iter().map(ToString::to_string).filter(|text| !text.is_empty()) {
                    word(operand.trim());
                }
            }
            Some(Element::Branch(branch)) => {
                word("BST");
                let mut rest = branch.legs.iter();
                match rest.next() {
                    Some(first) => {
                        open.push(first.iter());
                        legs.push(rest);
                    }
                    None => word("BND"),
                }
            }
            None => {
                open.pop();
                match legs.last_mut().map(Iterator::next) {
                    Some(Some(leg)) => {
                        word("NXB");
                        open.push(leg.iter());
                    }
                    Some(None) => {
                        word("BND");
                        legs.pop();
                    }
                    None => {}
                }
            }
        }
    }
    text
}
