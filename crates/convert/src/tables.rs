//! Data tables a program needs before it can be stored or run.

use std::collections::{BTreeMap, HashMap};

use instr::parameters::{Written, element_words, written};
use ladder::{DataFile, Diagnostic, FileType, Image, IoRange, Severity, Target, TimeBase};

use crate::to_rss::program::{addresses, instructions};

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

/// Adds the files every processor has, makes tables as large as the program needs, and gives the
/// elements added the parameters that instructions show for them. What was added is reported; values
/// that are there never change, but are compared with what the instructions show.
pub fn complete(image: &mut Image, notes: &mut Vec<Diagnostic>) {
    let given: Given = image
        .data_files
        .iter()
        .filter(|file| !is_module_file(file) && file.file_type != FileType::Unused)
        .map(|file| (file.number, file.elements))
        .collect();
    add_files(image, &given, notes);
    parameters(image, &given, notes);
}

/// Elements of the data files that came with the program, by file number.
type Given = HashMap<u16, u16>;

fn add_files(image: &mut Image, given: &Given, notes: &mut Vec<Diagnostic>) {
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
    // Elements named, and elements that instructions reach from there.
    let mut needs = BTreeMap::new();
    for (address, words) in addresses(image) {
        let (Some(file), Some(element)) = (address.file.number(), address.element.number()) else { continue };
        // I/O tables are as large as the slots; function files belong to the controller.
        if address.file_type.has_slots() || address.file_type.is_function_file() {
            continue;
        }
        let reached = u16::try_from(words.div_ceil(element_words(address.file_type))).unwrap_or(u16::MAX);
        let need = needs.entry((address.file_type, file)).or_insert((0u16, 0u16));
        need.0 = need.0.max(element.saturating_add(1));
        need.1 = need.1.max(element.saturating_add(reached.max(1)));
    }
    for ((file_type, number), (named, reached)) in needs {
        let place = format!("data file {file_type}{number}");
        // A table that came with the program is as long as its author made it.
        let elements = if given.contains_key(&number) { named } else { reached };
        if let Some(have) = given.get(&number).filter(|have| reached > **have && reached > named) {
            notes.push(Diagnostic {
                severity: Severity::Warning,
                place: place.clone(),
                message: format!("an instruction reaches {reached} elements by its length, the table has {have}"),
            });
        }
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

/// Sets the elements that no table gave to what the first instruction on them shows, and reports
/// where the others, or a table, differ.
fn parameters(image: &mut Image, given: &Given, notes: &mut Vec<Diagnostic>) {
    let mut found: Vec<(String, FileType, u16, u16, Shown)> = Vec::new();
    for it in instructions(image).flat_map(written).filter(|it| it.element.is_direct()) {
        let (Some(file), Some(element)) = (it.element.file.number(), it.element.element.number()) else { continue };
        found.push((it.element.to_string(), it.element.file_type, file, element, Shown::of(&it)));
    }
    let mut set: HashMap<(u16, u16), Shown> = HashMap::new();
    for (place, file_type, number, element, shown) in found {
        let is_it = |file: &&mut DataFile| file.number == number && file.file_type == file_type;
        let Some(file) = image.data_files.iter_mut().find(is_it) else { continue };
        let size = usize::from(file.words_per_element);
        let Some(words) = file.words.get_mut(usize::from(element) * size..).and_then(|words| words.get_mut(..size))
        else {
            continue;
        };
        let has_table = given.get(&number).is_some_and(|elements| element < *elements);
        let (stored, of) = match set.get(&(number, element)) {
            _ if has_table => (Shown::stored(words, file_type), "the data table holds"),
            Some(first) => (*first, "an instruction before it shows"),
            None => {
                shown.store(words);
                set.insert((number, element), shown);
                continue;
            }
        };
        if let Some((severity, differences)) = shown.differences(&stored, of, file_type) {
            let wins = if has_table { "the data table counts" } else { "the first one counts" };
            let message = format!("an instruction shows {differences}; {wins}");
            notes.push(Diagnostic { severity, place, message });
        }
    }
}

/// Parameters of one element, as an instruction shows them or a table holds them.
#[derive(Clone, Copy)]
struct Shown {
    base: Option<TimeBase>,
    values: [Option<i64>; 2],
}

impl Shown {
    fn of(written: &Written<'_>) -> Shown {
        Shown { base: written.time_base, values: written.values }
    }

    fn stored(words: &[u16], file_type: FileType) -> Shown {
        let word = |index: usize| words.get(index).map(|word| i64::from(*word as i16));
        let control = words.first().copied().filter(|_| file_type == FileType::T);
        Shown { base: control.and_then(TimeBase::from_control), values: [word(1), word(2)] }
    }

    fn store(&self, words: &mut [u16]) {
        if let (Some(base), Some(control)) = (self.base, words.first_mut()) {
            *control = *control & !0x0300 | base.control_bits();
        }
        for (value, word) in self.values.iter().zip(words.iter_mut().skip(1)) {
            if let Some(value) = value.and_then(|value| i16::try_from(value).ok()) {
                *word = value as u16;
            }
        }
    }

    /// What differs from `other`. An accumulator or position alone is only where a program stood.
    fn differences(&self, other: &Shown, of: &str, file_type: FileType) -> Option<(Severity, String)> {
        let names = if file_type == FileType::R { ["LEN", "POS"] } else { ["PRE", "ACC"] };
        let mut differences = Vec::new();
        let mut severity = Severity::Note;
        if let (Some(base), Some(found)) = (self.base, other.base)
            && base != found
        {
            severity = Severity::Warning;
            differences.push(format!("time base {base} ({of} {found})"));
        }
        for (name, (value, found)) in names.into_iter().zip(self.values.into_iter().zip(other.values)) {
            if let (Some(value), Some(found)) = (value, found)
                && value != found
            {
                severity = if matches!(name, "PRE" | "LEN") { Severity::Warning } else { severity };
                differences.push(format!("{name} {value} ({of} {found})"));
            }
        }
        (!differences.is_empty()).then(|| (severity, differences.join(", ")))
    }
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
