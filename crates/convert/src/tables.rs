//! Data tables a program needs before it can be stored or run.

use ladder::{DataFile, Diagnostic, FileType, Image, IoRange, Severity, Target};

use crate::to_rss::program::addresses;

/// Files every processor has, with their names: O, I, S, B, T, C, R, N.
const STANDARD: [(FileType, &str); 8] = [
    (FileType::O, "OUTPUT"),
    (FileType::I, "INPUT"),
    (FileType::S, "STATUS"),
    (FileType::B, "BINARY"),
    (FileType::T, "TIMER"),
    (FileType::C, "COUNTER"),
    (FileType::R, "CONTROL"),
    (FileType::N, "INTEGER"),
];

/// S:3, whose high byte is the watchdog in units of 10 ms.
const WATCHDOG_WORD: usize = 3;
/// 100 ms, what all known projects of most processors have. 0 would stop the processor at once.
const WATCHDOG: u16 = 0x0A00;

/// Characters of a documentation line.
const LINE: usize = 20;

/// Gives program and data files the names and descriptions that the documentation holds for them,
/// where they have none of their own. Stored projects keep a copy of them there.
pub fn name_files(image: &mut Image) {
    for file in &mut image.program_files {
        let entry = image.documentation.entry(&Target::ProgramFile(file.number));
        if let Some(entry) = entry.filter(|_| file.description.is_empty()) {
            file.description = joined(&entry.description);
        }
    }
    for file in &mut image.data_files {
        let Some(entry) = image.documentation.entry(&Target::DataFile(file.number)) else { continue };
        let Some((name, description)) = entry.description.split_first() else { continue };
        if file.name.is_empty() {
            file.name.clone_from(name);
        }
        if file.description.is_empty() {
            file.description = joined(description);
        }
    }
}

/// Lines cut at the full width go on without a blank; lines written by hand get one.
fn joined(lines: &[String]) -> String {
    let mut text = String::new();
    for (index, line) in lines.iter().enumerate() {
        let cut = index.checked_sub(1).and_then(|before| lines.get(before)).is_none_or(|l| l.chars().count() == LINE);
        if !cut {
            text.push(' ');
        }
        text.push_str(line);
    }
    text
}

/// Adds the files every processor has and makes tables as large as the program's direct addresses
/// need. What was added is reported; existing values never change.
pub fn complete(image: &mut Image, notes: &mut Vec<Diagnostic>) {
    for ((file_type, name), number) in STANDARD.iter().zip(0u16..) {
        if image.data_files.iter().all(|file| file.number != number || is_module_file(file)) {
            let elements = standard_elements(image, *file_type);
            let mut file = DataFile::new(*file_type, number, elements);
            if *file_type == FileType::S
                && let Some(watchdog) = file.words.get_mut(WATCHDOG_WORD)
            {
                *watchdog = WATCHDOG;
            }
            image.data_files.push(file);
        }
        // Text forms hold no names of data files; these are what a new project has.
        for file in image.data_files.iter_mut().filter(|file| file.number == number && file.file_type == *file_type) {
            if file.name.is_empty() {
                (*name).clone_into(&mut file.name);
            }
        }
    }
    let mut needs = std::collections::BTreeMap::new();
    for address in addresses(image) {
        let (Some(file), Some(element)) = (address.file.number(), address.element.number()) else { continue };
        // I/O tables are as large as the slots; function files belong to the controller.
        if address.file_type.has_slots() || address.file_type.is_function_file() {
            continue;
        }
        let need = needs.entry((address.file_type, file)).or_insert(0u16);
        *need = (*need).max(element.saturating_add(1));
    }
    for ((file_type, number), elements) in needs {
        let place = format!("data file {file_type}{number}");
        match image.data_files.iter_mut().find(|file| file.number == number && !is_module_file(file)) {
            Some(file) if file.file_type == file_type => {
                if file.elements < elements {
                    note(
                        notes,
                        place,
                        format!("enlarged from {} to {elements} elements the program uses", file.elements),
                    );
                    grow(file, elements);
                }
            }
            Some(file) if file.file_type != FileType::Unused => notes.push(Diagnostic {
                severity: Severity::Warning,
                place,
                message: format!("the program uses it, but file {number} is of type {}", file.file_type),
            }),
            unused => {
                note(notes, place, format!("added with {elements} elements the program uses"));
                let file = DataFile::new(file_type, number, elements);
                match unused {
                    Some(place) => *place = file,
                    None => image.data_files.push(file),
                }
            }
        }
    }
    image.data_files.sort_by_key(|file| (is_module_file(file), file.number));
}

fn note(notes: &mut Vec<Diagnostic>, place: String, message: String) {
    notes.push(Diagnostic { severity: Severity::Note, place, message });
}

/// M0 and M1 are numbered on their own.
fn is_module_file(file: &DataFile) -> bool {
    matches!(file.file_type, FileType::M0 | FileType::M1)
}

fn grow(file: &mut DataFile, elements: u16) {
    let words = usize::from(elements) * usize::from(file.words_per_element);
    file.words.resize(words, 0);
    file.elements = elements;
}

/// Words of all slots for O and I, the status file of the family, one element otherwise.
fn standard_elements(image: &Image, file_type: FileType) -> u16 {
    let end = |range: IoRange| range.first_word.saturating_add(range.words);
    let slots = || image.io.slots.iter();
    match file_type {
        FileType::O => slots().map(|slot| end(slot.outputs)).max().unwrap_or(1),
        FileType::I => slots().map(|slot| end(slot.inputs)).max().unwrap_or(1),
        FileType::S => status_words(image.family()),
        _ => 1,
    }
}

/// Words of the status file: stored sizes for the families known from projects, sizes stated by the
/// instruction set manuals for the chassis processors.
fn status_words(family: ladder::Family) -> u16 {
    use ladder::Family::*;
    match family {
        SlcFixed | Slc501 => 16,
        Slc502 | MicroLogix1000 => 33,
        Slc503 | Slc505 => 83,
        Slc504 => 164,
        _ => 66,
    }
}
