//! Every drawn rung: series and branches, instructions, operands, displayed values.

use crate::{Outcome, Pair};
use ladder::{Address, Element, FileType, Image, Instruction, Operand, Place, Rung};
use rungs_tests::drawing::{self, DrawnRung, Node, Shape};

/// A drawn rung and the rung of the same file and number in an image.
pub(crate) struct Both<'a> {
    pub(crate) file: u16,
    pub(crate) number: usize,
    pub(crate) drawn: &'a DrawnRung,
    pub(crate) rung: &'a Rung,
}

impl std::fmt::Display for Both<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "file {} rung {}", self.file, self.number)
    }
}

impl<'a> Both<'a> {
    /// The instructions of both, if there are as many drawn as read.
    pub(crate) fn instructions(&self) -> Vec<(&'a drawing::Instruction, &'a Instruction)> {
        let drawn = self.drawn.instructions();
        let read: Vec<_> = self.rung.instructions().collect();
        if drawn.len() == read.len() { drawn.into_iter().zip(read).collect() } else { Vec::new() }
    }
}

/// Drawn rungs beside the rungs of the same file and number in an image.
pub(crate) fn pairs<'a>(pair: &Pair<'a>, image: &'a Image) -> Vec<Both<'a>> {
    let mut found = Vec::new();
    for file in &pair.report.drawing {
        let Some(read) = image.program_file(file.number) else { continue };
        for drawn in &file.rungs {
            let Some(number) = drawn.number else { continue };
            if let Some(rung) = read.rungs.get(number) {
                found.push(Both { file: file.number, number, drawn, rung });
            }
        }
    }
    found
}

/// Structure, mnemonics, operands and edit marks of every rung, and that none is missing.
pub(crate) fn rungs(pair: &Pair<'_>) -> Outcome {
    let mut outcome = Outcome::default();
    for file in &pair.report.drawing {
        let read = pair.image.program_file(file.number);
        let count = read.map(|f| f.rungs.len());
        if count != Some(file.rungs.len()) {
            let drawn = file.rungs.len();
            outcome.missing(format!("file {}: {drawn} rungs drawn, {count:?} read", file.number));
        }
    }
    for both in pairs(pair, pair.image) {
        let mut read = Vec::new();
        outline(&both.rung.series, both.file, &mut read);
        let mut printed = Vec::new();
        outline_drawn(&both.drawn.nodes, &mut printed);
        outcome.row(&both, (printed.join(" "), both.drawn.edited), (read.join(" "), both.rung.edited));
    }
    outcome
}

fn outline(series: &[Element], file: u16, words: &mut Vec<String>) {
    for element in series {
        match element {
            Element::Instruction(instruction) => {
                words.push(instruction.mnemonic.to_string());
                words.extend(operands(instruction, file));
            }
            Element::Branch(branch) => {
                for (index, leg) in branch.legs.iter().enumerate() {
                    words.push(if index == 0 { "BST" } else { "NXB" }.to_owned());
                    outline(leg, file, words);
                }
                words.push("BND".to_owned());
            }
        }
    }
}

/// Operands as printed; preset, accum and other snapshots are compared by [`displayed`].
fn operands(instruction: &Instruction, file: u16) -> Vec<String> {
    let name = instruction.mnemonic.to_string();
    let all = instruction.operands.len();
    let texts = instruction.operands.iter().enumerate().filter(|(index, _)| !snapshot(&name, *index, all));
    texts.map(|(_, operand)| spelled(operand, file)).filter(|text| !text.is_empty()).collect()
}

/// Whether an operand only repeats a member of the timer, counter or control element.
fn snapshot(mnemonic: &str, index: usize, operands: usize) -> bool {
    let first = match mnemonic {
        "TON" | "TOF" | "RTO" => 2,
        "CTU" | "CTD" => 1,
        "BSL" | "BSR" => 3,
        "SQO" | "SQC" | "SQL" | "FFL" | "FFU" | "LFL" | "LFU" => operands.saturating_sub(2),
        _ => return false,
    };
    index >= first
}

fn spelled(operand: &Operand, file: u16) -> String {
    match operand {
        // A label belongs to the file its instruction is in, whatever number is stored.
        Operand::Label { number, .. } => format!("Q{file}:{number}"),
        Operand::Address(address) => address_text(address),
        other => other.to_string().trim().to_owned(),
    }
}

/// The spelling of printed pages: the bits of a slot are counted through its words, `O:0.2/5` is `O:0/37`.
pub(crate) fn address_text(address: &Address) -> String {
    let io = matches!(address.file_type, FileType::I | FileType::O);
    match (address.element.number(), &address.bit) {
        (Some(slot), Some(Place::Number(bit))) if io => {
            format!("{}:{slot}/{}", address.file_type, 16 * address.word.unwrap_or(0) + bit)
        }
        _ => address.to_string(),
    }
}

fn outline_drawn(nodes: &[Node], words: &mut Vec<String>) {
    for node in nodes {
        match node {
            Node::Instruction(instruction) => {
                words.push(instruction.mnemonic.clone());
                let texts = instruction.operands();
                let all = texts.len();
                let texts = texts.into_iter().enumerate();
                words.extend(texts.filter(|(i, _)| !snapshot(&instruction.mnemonic, *i, all)).map(|(_, text)| text));
            }
            Node::Branch(legs) => {
                for (index, leg) in legs.iter().enumerate() {
                    words.push(if index == 0 { "BST" } else { "NXB" }.to_owned());
                    outline_drawn(leg, words);
                }
                words.push("BND".to_owned());
            }
        }
    }
}

/// The values drawn beside the operands of boxes.
pub(crate) fn displayed(pair: &Pair<'_>) -> Outcome {
    let mut outcome = Outcome::default();
    for both in pairs(pair, pair.image) {
        for (drawn, read) in both.instructions().into_iter().filter(|(d, _)| d.shape == Shape::Box) {
            let printed = values(drawn);
            let stored = stored_values(read);
            if !printed.is_empty() || !stored.is_empty() {
                outcome.row(format!("{both} {}", drawn.mnemonic), printed, stored);
            }
        }
    }
    outcome
}

/// Live values as drawn, without their `<`; rungs that are being edited are printed without one.
fn values(drawn: &drawing::Instruction) -> Vec<String> {
    let all = drawn.fields.len();
    let bare = |text: &String| text.trim_end_matches('<').to_owned();
    let fields = drawn.fields.iter().enumerate();
    fields
        .flat_map(|(index, f)| {
            let own = (snapshot(&drawn.mnemonic, index, all) && !f.text.is_empty()).then(|| bare(&f.text));
            own.into_iter().chain(f.values.iter().map(bare))
        })
        .collect()
}

fn stored_values(instruction: &Instruction) -> Vec<String> {
    let name = instruction.mnemonic.to_string();
    let all = instruction.operands.len();
    let texts = instruction.operands.iter().enumerate();
    let value = |(index, operand): (usize, &Operand)| match instruction.displayed(index) {
        Some(value) => Some(value.to_owned()),
        None => snapshot(&name, index, all).then(|| operand.to_string()),
    };
    texts.filter_map(value).collect()
}
