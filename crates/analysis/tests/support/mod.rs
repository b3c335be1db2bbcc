//! Images from a few lines of rung text, for tests.
// Each test binary uses its part of a module that is not a crate.
#![allow(dead_code, unreachable_pub)]

use ladder::{
    Confidence, DataFile, Element, Family, FileType, Image, Instruction, IoRange, Mnemonic, Module, Operand,
    ProgramFile, ProgramFileKind, Rung, Slot,
};

/// Data files large enough for the tests: the ones every project has, and some more types.
pub fn data_files() -> Vec<DataFile> {
    [
        (FileType::O, 0, 3),
        (FileType::I, 1, 3),
        (FileType::S, 2, 66),
        (FileType::B, 3, 32),
        (FileType::T, 4, 10),
        (FileType::C, 5, 10),
        (FileType::R, 6, 10),
        (FileType::N, 7, 105),
        (FileType::F, 8, 20),
        (FileType::L, 9, 20),
        (FileType::N, 10, 50),
        (FileType::ST, 11, 5),
        (FileType::PD, 12, 2),
        (FileType::MG, 13, 2),
        (FileType::RIX, 14, 1),
    ]
    .into_iter()
    .map(|(file_type, number, elements)| DataFile::new(file_type, number, elements))
    .collect()
}

/// Slots 0 (words 0 and 1) and 2 (word 2) in both directions.
fn slots() -> Vec<Slot> {
    [(0, 0, 2), (2, 2, 1)]
        .into_iter()
        .map(|(number, first_word, words)| Slot {
            number,
            module: Module {
                catalog: None,
                description: String::new(),
                identity: String::new(),
                confidence: Confidence::Unknown,
            },
            inputs: IoRange { first_word, words, bits: words * 16 },
            outputs: IoRange { first_word, words, bits: words * 16 },
            configuration: Vec::new(),
        })
        .collect()
}

/// Instructions of a rung in series, separated by `;`; operands by blanks, `_` for a blank operand.
pub fn rung(text: &str) -> Rung {
    let instruction = |text: &str| {
        let mut words = text.split_whitespace();
        let mnemonic = Mnemonic::named(words.next().unwrap_or_default().to_owned());
        let operands = words.map(|word| Operand::parse(if word == "_" { "" } else { word })).collect();
        let mut instruction = Instruction::new(mnemonic, operands);
        instruction.compiled = true;
        Element::Instruction(instruction)
    };
    Rung::new(text.split(';').map(instruction).collect())
}

/// An image with one rung per line in file 2.
pub fn image(rungs: &[&str]) -> Image {
    let mut image = Image { data_files: data_files(), ..Image::default() };
    image.io.slots = slots();
    image.processor.family = Family::Slc503;
    image.program_files.push(ProgramFile {
        number: 2,
        name: "MAIN".into(),
        description: String::new(),
        kind: ProgramFileKind::Ladder,
        rungs: rungs.iter().map(|text| rung(text)).collect(),
    });
    image
}

/// Sets a word of a data file.
pub fn set(image: &mut Image, file_type: FileType, number: u16, word: usize, value: u16) {
    let files = image.data_files.iter_mut().chain(&mut image.function_files);
    for file in files.filter(|f| f.file_type == file_type && f.number == number) {
        file.words[word] = value;
    }
}
