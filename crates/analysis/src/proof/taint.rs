//! Data that rungs left to a person decide, directly or through other rungs: it cannot be compared.

use std::collections::BTreeSet;

use ladder::{Address, FileType, Image, Operand, Place};

use super::goals::is_condition;
use super::side::{Side, Slc};

/// What a rung reads and writes, as words of the original.
struct Effects {
    place: (u16, u32),
    reads: BTreeSet<u32>,
    writes: BTreeSet<u32>,
    /// It decides which other rungs run.
    control: bool,
}

/// Instructions that decide which rungs run.
const CONTROL: [&str; 8] = ["JMP", "JSR", "MCR", "TND", "RET", "SUS", "STS", "REF"];

/// Words that cannot be compared; `None`: which rungs run at all depends on a rung left to a person.
pub(crate) fn tainted(image: &Image, a: &Slc, persons: &BTreeSet<(u16, u32)>) -> Option<BTreeSet<u32>> {
    let mut tainted = BTreeSet::new();
    if persons.is_empty() {
        return Some(tainted);
    }
    let rungs: Vec<Effects> = image
        .ladder_files()
        .flat_map(|file| (0..).zip(&file.rungs).map(move |(number, rung)| (file.number, number, rung)))
        .map(|(file, number, rung)| effects(image, a, (file, number), rung))
        .collect();
    loop {
        let before = tainted.len();
        for rung in &rungs {
            let person = persons.contains(&rung.place);
            if person || rung.reads.iter().any(|word| tainted.contains(word)) {
                if rung.control {
                    return None;
                }
                tainted.extend(&rung.writes);
            }
        }
        if tainted.len() == before {
            return Some(tainted);
        }
    }
}

fn effects(image: &Image, a: &Slc, place: (u16, u32), rung: &ladder::Rung) -> Effects {
    let mut effects = Effects { place, reads: BTreeSet::new(), writes: BTreeSet::new(), control: false };
    for instruction in rung.instructions() {
        let writes = !is_condition(instruction, image.family())
            || matches!(instruction.mnemonic.name(), Some("ONS" | "OSR" | "OSF"));
        effects.control |= CONTROL.iter().any(|name| instruction.mnemonic == *name);
        for address in instruction.operands.iter().flat_map(addresses) {
            let words = words_of(image, a, address);
            if writes {
                effects.writes.extend(&words);
            }
            effects.reads.extend(words);
        }
    }
    effects
}

fn addresses(operand: &Operand) -> Vec<&Address> {
    let mut found: Vec<&Address> = match operand {
        Operand::Expression(expression) => expression.operands().into_iter().filter_map(Operand::address).collect(),
        other => other.address().into_iter().collect(),
    };
    let inner: Vec<&Address> = found.iter().flat_map(|address| address.indirections()).collect();
    found.extend(inner);
    found
}

/// Every word an address can mean: its element, or all of its file where that is decided at run time.
fn words_of(image: &Image, a: &Slc, address: &Address) -> Vec<u32> {
    let span = |address: &Address, words: u32| match a.place(&address.to_string()) {
        Ok((at, _)) => (at >> 4..(at >> 4) + words).collect(),
        Err(_) => Vec::new(),
    };
    let computed = address.indexed || address.indirections().next().is_some();
    let files = image.data_files.iter().filter(|file| {
        file.file_type == address.file_type && address.file.number().is_none_or(|number| number == file.number)
    });
    if computed {
        return files
            .flat_map(|file| {
                let words = u32::from(file.elements) * u32::from(file.words_per_element.max(1));
                span(&Address::element(file.file_type, file.number, 0), words)
            })
            .collect();
    }
    let size = if address.file_type == FileType::ST { 42 } else { 3 };
    let whole = address.file_type.is_structure()
        || matches!(address.file_type, FileType::F | FileType::L | FileType::ST)
        || address.file_type.is_function_file();
    if !whole {
        let plain = Address { bit: None, ..address.clone() };
        return span(&plain, 1);
    }
    let element = Address { bit: None, word: None, indexed: false, ..address.clone() };
    let words = image
        .data_file(address.file_type, address.file.number().unwrap_or(0))
        .map_or(size, |file| u32::from(file.words_per_element.max(1)));
    match element.element {
        Place::Number(_) => span(&element, words),
        Place::Indirect(_) => Vec::new(),
    }
}
