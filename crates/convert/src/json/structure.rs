//! The branches of a rung apart from its instructions: `0 BST 1 2 NXB BND 3`.
//!
//! Numbers are places in the rung's list of instructions. Where an instruction or operand is unknown
//! the rung text cannot tell where instructions end; this form always can.

use std::fmt::Write as _;

use ladder::{Branch, Element, Instruction, Rung, Series};

/// Branches nest at most this deep in a document; the editor allows far fewer.
const MAX_DEPTH: usize = 256;

/// The structure of a rung.
pub(super) fn structure_of(rung: &Rung) -> String {
    let mut text = String::new();
    let mut index = 0;
    write_series(&rung.series, &mut index, &mut text);
    text
}

fn write_series(series: &[Element], index: &mut usize, text: &mut String) {
    for element in series {
        if !text.is_empty() {
            text.push(' ');
        }
        match element {
            Element::Instruction(_) => {
                // Writing to a string cannot fail.
                let _ = write!(text, "{index}");
                *index += 1;
            }
            Element::Branch(branch) => {
                for (leg, series) in branch.legs.iter().enumerate() {
                    text.push_str(if leg == 0 { "BST" } else { " NXB" });
                    write_series(series, index, text);
                }
                text.push_str(if branch.legs.is_empty() { "BST BND" } else { " BND" });
            }
        }
    }
}

/// Puts instructions into the branches that `structure` describes.
///
/// # Errors
/// What was expected at a word of the text, and the word.
pub(super) fn series_from(structure: &str, instructions: Vec<Instruction>) -> Result<Series, (String, String)> {
    let count = instructions.len();
    let mut instructions = instructions.into_iter().enumerate();
    let mut series = Series::new();
    // Around the series being filled: the series that holds the branch, and the branch's legs so far.
    let mut outer: Vec<(Series, Vec<Series>)> = Vec::new();
    for word in structure.split_ascii_whitespace() {
        match word {
            "BST" if outer.len() >= MAX_DEPTH => return Err(("fewer nested branches".into(), word.into())),
            "BST" => outer.push((std::mem::take(&mut series), Vec::new())),
            "NXB" | "BND" => {
                let Some((around, mut legs)) = outer.pop() else {
                    return Err(("BST before it".into(), word.into()));
                };
                legs.push(std::mem::take(&mut series));
                if word == "NXB" {
                    outer.push((around, legs));
                } else {
                    series = around;
                    series.push(Element::Branch(Branch { legs }));
                }
            }
            number => match instructions.next() {
                Some((index, instruction)) if number == index.to_string() => {
                    series.push(Element::Instruction(instruction));
                }
                Some((index, _)) => return Err((format!("BST, NXB, BND or {index}"), word.into())),
                None => return Err((format!("BST, NXB or BND after {count} instructions"), word.into())),
            },
        }
    }
    if !outer.is_empty() {
        return Err(("BND".into(), "the end".into()));
    }
    match instructions.next() {
        Some((index, _)) => Err((format!("instruction {index}"), "the end".into())),
        None => Ok(series),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ladder::Mnemonic;

    fn ins(number: usize) -> Instruction {
        Instruction::new(Mnemonic::named(format!("I{number}")), Vec::new())
    }

    #[test]
    fn branches_read_back() {
        for text in ["", "0", "0 BST 1 2 NXB BND 3", "BST BST NXB 0 BND NXB 1 NXB BND", "BST BND BST NXB BND"] {
            let count = text.split(' ').filter(|word| word.parse::<usize>().is_ok()).count();
            let series = series_from(text, (0..count).map(ins).collect()).expect(text);
            assert_eq!(structure_of(&Rung::new(series)), text);
        }
    }

    #[test]
    fn broken_structures_are_refused() {
        for (text, count) in [("0 1", 1), ("0", 2), ("BST 0", 1), ("BND", 0), ("1 0", 2), ("x", 1), ("0 NXB", 1)] {
            assert!(series_from(text, (0..count).map(ins).collect()).is_err(), "{text}");
        }
        assert!(series_from(&"BST ".repeat(100_000), Vec::new()).is_err());
    }
}
