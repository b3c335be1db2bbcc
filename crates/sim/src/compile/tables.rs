//! The data files a program runs on: those of the image, or made to measure for an inline ladder.

use std::collections::{BTreeMap, BTreeSet};

use instr::parameters;
use ladder::{Address, DataFile, Expression, Family, FileType, Image, Instruction, Operand};

use super::Compiler;
use crate::family::Lineage;
use crate::program::Approximation;
use crate::status;
use crate::{Options, outside};

pub(super) struct Tables {
    pub(super) files: Vec<DataFile>,
    /// I/O and module words that the program or the caller names.
    pub(super) wanted: Vec<(FileType, u16, u16)>,
    pub(super) approximations: Vec<Approximation>,
}

/// Elements and words per element of function files, as projects of processors that have them store
/// them; the most elements of any processor.
const FUNCTION_FILES: &[(FileType, u16, u16)] = &[
    (FileType::HSC, 6, 18),
    (FileType::PTO, 2, 12),
    (FileType::PTOX, 3, 15),
    (FileType::PWM, 2, 8),
    (FileType::PWMX, 3, 10),
    (FileType::STI, 1, 4),
    (FileType::EII, 8, 4),
    (FileType::RTC, 1, 8),
    (FileType::TPI, 1, 3),
];
/// Size of the others, larger than any seen.
const OTHER_FUNCTION_FILE: (u16, u16) = (8, 128);

pub(super) fn tables(image: &Image, options: &Options, family: Family) -> Tables {
    let mut needs = Needs::default();
    for instruction in image.ladder_files().flat_map(|f| f.rungs.iter()).flat_map(|r| r.instructions()) {
        needs.instruction(instruction, family);
    }
    for address in &options.addresses {
        needs.address(address, 1);
    }
    let mut files: Vec<DataFile> = image
        .data_files
        .iter()
        .filter(|file| !matches!(file.file_type, FileType::Unused | FileType::Reserved | FileType::M0 | FileType::M1))
        .cloned()
        .collect();
    files.sort_by_key(|file| file.number);
    let mut functions = image.function_files.clone();
    let mut approximations = Vec::new();
    for (number, file_type) in [(0, FileType::O), (1, FileType::I), (2, FileType::S)] {
        if files.iter().all(|file| file.file_type != file_type) {
            let elements = if file_type == FileType::S { status::WORDS as u16 } else { 0 };
            files.push(DataFile::new(file_type, number, elements));
        }
    }
    if options.inline {
        needs.grow(&mut files, &mut functions);
    } else {
        for file_type in needs.function_files(&functions) {
            let why = format!("the project has no {file_type} function file: an empty one takes its place");
            approximations.push(Approximation { site: None, why });
            functions.push(function_file(file_type));
        }
    }
    files.sort_by_key(|file| file.number);
    functions.iter_mut().for_each(widen);
    files.append(&mut functions);
    Tables { files, wanted: needs.io.into_iter().collect(), approximations }
}

/// A function file as in a new project: interrupts enabled but not set up, limits as wide as they go.
fn function_file(file_type: FileType) -> DataFile {
    let row = FUNCTION_FILES.iter().find(|row| row.0 == file_type);
    let (elements, size) = row.map_or(OTHER_FUNCTION_FILE, |row| (row.1, row.2));
    let mut file = DataFile::new(file_type, file_type.implied_file().unwrap_or(0), elements);
    file.words_per_element = size;
    file.words = vec![0; usize::from(elements) * usize::from(size)];
    for (number, element) in file.words.chunks_exact_mut(usize::from(size)).enumerate() {
        let set_up: &[(usize, u16)] = match file_type {
            FileType::STI => &[(2, 2)],
            FileType::EII => &[(2, 0x4002), (3, number as u16)],
            FileType::HSC => {
                &[(2, 2), (3, 0x000F), (7, 0xFFFF), (8, 0x7FFF), (10, 0x8000), (11, 0xFFFF), (12, 0x7FFF), (14, 0x8000)]
            }
            _ => &[],
        };
        for (index, value) in set_up {
            if let Some(word) = element.get_mut(*index) {
                *word = *value;
            }
        }
    }
    file
}

/// Pulse outputs get a word for the bits whose place in their element is not known.
fn widen(file: &mut DataFile) {
    let (old, new) = (usize::from(file.words_per_element), outside::PULSE_WORD + 1);
    if !outside::PULSES.contains(&file.file_type) || old == 0 || old >= usize::from(new) {
        return;
    }
    let mut words = Vec::with_capacity(usize::from(file.elements) * usize::from(new));
    for element in file.words.chunks(old) {
        words.extend_from_slice(element);
        words.resize(words.len() + usize::from(new) - element.len(), 0);
    }
    (file.words, file.words_per_element) = (words, new);
}

/// What the direct addresses of a program reach.
#[derive(Default)]
struct Needs {
    /// Elements by type and file number.
    files: BTreeMap<(FileType, u16), u32>,
    io: BTreeSet<(FileType, u16, u16)>,
}

/// A data file has at most this many elements; more is asked by mistake only.
const MAX_ELEMENTS: u32 = 1024;

impl Needs {
    fn instruction(&mut self, instruction: &Instruction, family: Family) {
        for (index, operand) in instruction.operands.iter().enumerate() {
            self.operand(operand, parameters::words(instruction, index, family));
        }
    }

    fn operand(&mut self, operand: &Operand, words: u32) {
        match operand {
            Operand::Address(address) => self.address(address, words),
            Operand::Expression(expression) => self.expression(expression),
            Operand::HighSpeedCounter(_) => {
                self.files.entry((FileType::HSC, 0)).or_insert(1);
            }
            _ => {}
        }
    }

    fn expression(&mut self, expression: &Expression) {
        for operand in expression.operands() {
            self.operand(operand, 1);
        }
    }

    fn address(&mut self, address: &Address, words: u32) {
        for inner in address.indirections() {
            self.address(inner, 1);
        }
        let element = address.element.number();
        if address.file_type.has_slots() {
            let Some(slot) = element else { return };
            let first = address.word.unwrap_or(0);
            for word in 0..words.min(256) as u16 {
                self.io.insert((address.file_type, slot, first.saturating_add(word)));
            }
            return;
        }
        let (Some(file), Some(element)) = (address.file.number(), element) else { return };
        let size = parameters::element_words(address.file_type);
        let last = u32::from(element) + words.div_ceil(size).max(1);
        let need = self.files.entry((address.file_type, file)).or_insert(0);
        *need = (*need).max(last.min(MAX_ELEMENTS));
    }

    /// Function files that are named and that no file stands for.
    fn function_files(&self, present: &[DataFile]) -> Vec<FileType> {
        let mut missing: Vec<FileType> = Vec::new();
        for (file_type, _) in self.files.keys().filter(|key| key.0.is_function_file()) {
            if present.iter().all(|file| file.file_type != *file_type) && !missing.contains(file_type) {
                missing.push(*file_type);
            }
        }
        missing
    }

    fn grow(&self, files: &mut Vec<DataFile>, functions: &mut Vec<DataFile>) {
        for file_type in self.function_files(functions) {
            functions.push(function_file(file_type));
        }
        for ((file_type, number), elements) in &self.files {
            let elements = u16::try_from(*elements).unwrap_or(u16::MAX);
            if file_type.is_function_file() {
                continue;
            }
            match files.iter_mut().find(|file| file.number == *number) {
                Some(file) if file.file_type == *file_type => {
                    if file.elements < elements {
                        file.elements = elements;
                        let words = usize::from(elements) * usize::from(file.words_per_element);
                        file.words.resize(words, 0);
                    }
                }
                // Another type under this number: its addresses are refused one by one.
                Some(_) => {}
                None => files.push(DataFile::new(*file_type, *number, elements)),
            }
        }
    }
}

impl Compiler<'_> {
    /// Applies the parameters written in inline rungs; the first instruction on an element decides.
    pub(super) fn parameters(&self, data: &mut [u16]) {
        if self.traits.status_file_sti()
            && let Some(word) = data.get_mut(self.layout.status + status::STI_ENABLED.0)
        {
            // A new project has the timed interrupt enabled, and that of discrete inputs.
            *word |= status::STI_ENABLED.1;
            if self.traits.lineage == Lineage::S3 {
                *word |= status::DII_ENABLED.1;
            }
        }
        let mut done: BTreeSet<u32> = BTreeSet::new();
        let image = self.image;
        for instruction in image.ladder_files().flat_map(|f| f.rungs.iter()).flat_map(|r| r.instructions()) {
            for written in parameters::written(instruction) {
                let Some(location) = self.layout.locate(written.element) else { continue };
                if !done.insert(location.word) {
                    continue;
                }
                let at = location.word as usize;
                if let (Some(base), Some(word)) = (written.time_base, data.get_mut(at)) {
                    *word = *word & !0x0300 | base.control_bits();
                }
                for (offset, value) in (1..).zip(written.values) {
                    if let (Some(value), Some(word)) = (value, data.get_mut(at + offset)) {
                        *word = value as u16;
                    }
                }
            }
        }
    }
}
