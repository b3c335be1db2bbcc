//! Short ways to write rungs, data and documentation in tests.
#![allow(dead_code, missing_docs)] // each test file uses its part

use ladder::{
    Address, AddressEntry, Branch, Comment, CommentOwner, Confidence, DataFile, Documentation, Element, FileType,
    Image, Instruction, IoConfiguration, IoRange, Mnemonic, Module, Operand, ProgramFile, ProgramFileKind, Rung,
    Series, Slot, Target,
};

/// A compiled instruction, its operands separated by spaces. `300=100` is operand `300` with `100` displayed.
pub(crate) fn ins(name: &'static str, operands: &str) -> Element {
    let mut instruction = Instruction::new(Mnemonic::named(name), Vec::new());
    for text in operands.split_whitespace() {
        let (operand, displayed) = text.split_once('=').map_or((text, None), |(o, d)| (o, Some(d.to_owned())));
        instruction.operands.push(Operand::parse(operand));
        instruction.displayed.push(displayed);
    }
    instruction.compiled = true;
    Element::Instruction(instruction)
}

pub(crate) fn legs<const N: usize>(legs: [Series; N]) -> Element {
    Element::Branch(Branch { legs: legs.into() })
}

pub(crate) fn file(rungs: Vec<Rung>) -> ProgramFile {
    ProgramFile { number: 2, name: "MAIN".into(), description: String::new(), kind: ProgramFileKind::Ladder, rungs }
}

pub(crate) fn commented(series: Series, title: &str, text: &str) -> Rung {
    let owner = CommentOwner::Rung { file: 2, rung: 0 };
    let comment = Comment { text: text.replace('\n', "\r\n"), title: title.into(), owner };
    Rung { comment: Some(comment), ..Rung::new(series) }
}

/// Entries `address|symbol|line 1|line 2`.
pub(crate) fn documentation(entries: &[&str]) -> Documentation {
    let mut documentation = Documentation::default();
    for entry in entries {
        let mut parts = entry.split('|');
        let key = parts.next().unwrap_or("");
        let target = match key.strip_prefix("U:") {
            Some(number) => Target::ProgramFileOperand(number.parse().expect("a file number")),
            None => Target::Address(Address::parse(key).expect("an address")),
        };
        let symbol = parts.next().unwrap_or("").to_owned();
        documentation.add(AddressEntry { target, symbol, description: parts.map(str::to_owned).collect() });
    }
    documentation
}

/// A MicroLogix 1100 with four timers, T4:0 with preset 500.
pub(crate) fn image() -> Image {
    let mut timers = DataFile::new(FileType::T, 4, 4);
    timers.words[1] = 500;
    timers.words[2] = 120;
    let module = Module {
        catalog: Some("Bul.1763".into()),
        description: String::new(),
        identity: String::new(),
        confidence: Confidence::Proven,
    };
    let slot = Slot {
        number: 0,
        module,
        inputs: IoRange { first_word: 0, words: 1, bits: 10 },
        outputs: IoRange { first_word: 0, words: 1, bits: 6 },
        configuration: Vec::new(),
    };
    let io = IoConfiguration { slots: vec![slot], ..IoConfiguration::default() };
    Image { data_files: vec![timers], io, ..Image::default() }
}
