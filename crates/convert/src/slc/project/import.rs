//! Sections of a text file to the program model.

use std::collections::HashSet;

use ladder::{
    Comment, CommentOwner, DataFile, Diagnostic, Family, FileType, Force, Image, IoConfiguration, IoRange, ProgramFile,
    ProgramFileKind, Project, Rung, Severity, Slot,
};

use super::processor;
use crate::limits::{self, Parts};
use crate::slc::file::{self, SlcFile};
use crate::slc::rung::{parse_rung_at, unread_rung};

/// Builds the model of a file. The diagnostics of the file come first in the project's.
pub fn project(file: &SlcFile) -> Project {
    let mut reader = Importer { diagnostics: file.diagnostics.clone(), noted: 0 };
    let names = file.names().cloned().unwrap_or_default();
    let start = file.start().cloned().unwrap_or_default();
    let mut image = Image { processor: processor::processor(&start, &names.project), ..Image::default() };
    image.io = reader.io(file, image.family());
    image.program_files = reader.program_files(file, &names, image.family());
    reader.data_files(file, &mut image);
    reader.forces(file, &mut image);
    if image.family() == Family::Unknown {
        reader.note(Severity::Warning, "START", "the processor is not known; instructions are read by their operands");
    }
    reader.count_unreported();
    let status = image.data_file(FileType::S, 2);
    image.processor.deny_future_access = status.and_then(|file| file.words.get(1)).map(|word| word & 0x4000 != 0);
    Project { main: image, diagnostics: reader.diagnostics, ..Project::default() }
}

struct Importer {
    diagnostics: Vec<Diagnostic>,
    noted: usize,
}

/// A text can have as many faults as lines; nobody reads more than this.
const MOST_NOTES: usize = 1000;

/// Program and data files are numbered to here, and no controller has as many slots.
const LARGEST_NUMBER: u16 = 255;

impl Importer {
    fn note(&mut self, severity: Severity, place: impl Into<String>, message: impl Into<String>) {
        self.noted += 1;
        if self.noted <= MOST_NOTES {
            self.diagnostics.push(Diagnostic { severity, place: place.into(), message: message.into() });
        }
    }

    /// Says how many notes there were no room for.
    fn count_unreported(&mut self) {
        if let Some(more @ 1..) = self.noted.checked_sub(MOST_NOTES) {
            let message = format!("{more} more parts could not be read as expected");
            self.diagnostics.push(Diagnostic { severity: Severity::Error, place: "file".to_owned(), message });
        }
    }

    /// The slots, with their words of files I and O laid out in slot order.
    fn io(&mut self, file: &SlcFile, family: Family) -> IoConfiguration {
        let mut slots: Vec<&file::Slot> = Vec::new();
        for slot in file.slots() {
            if slot.number > LARGEST_NUMBER {
                let message = "expected a slot number of a chassis; the slot is left out";
                self.note(Severity::Error, format!("SLOT {}", slot.number), message);
            } else {
                slots.push(slot);
            }
        }
        slots.sort_by_key(|slot| slot.number);
        slots.dedup_by_key(|slot| slot.number);
        let is_controller = |slot: &file::Slot| slot.number == 0 && family.is_micrologix();
        let (mut first_input, mut first_output) = (0_u16, 0_u16);
        let mut configured = Vec::with_capacity(slots.len());
        for slot in &slots {
            let (inputs, outputs) =
                if is_controller(slot) { (None, None) } else { processor::points(&slot.description) };
            let range = |first: &mut u16, words: u16, points: Option<u16>| {
                let first_word = *first;
                *first = first.saturating_add(words);
                // The text counts words; fewer points than bits are known from the description alone.
                let all = words.saturating_mul(16);
                let bits = points.filter(|points| *points <= all && words > 0 && *points > all - 16).unwrap_or(all);
                IoRange { first_word, words, bits }
            };
            configured.push(Slot {
                number: slot.number,
                module: processor::module(slot, is_controller(slot)),
                inputs: range(&mut first_input, slot.scan_in, inputs),
                outputs: range(&mut first_output, slot.scan_out, outputs),
                configuration: slot.configuration.clone().unwrap_or_default(),
            });
        }
        let base = slots.iter().find(|slot| is_controller(slot)).and_then(|slot| processor::base_unit(slot));
        IoConfiguration {
            slots: configured,
            base_unit: base.and_then(|unit| unit.letters()).unwrap_or_default(),
            unknown: slots.is_empty().then(|| "the text has no SLOT lines".to_owned()),
        }
    }

    /// Files 0 and 1, those of the text, and unused numbers between.
    fn program_files(&mut self, file: &SlcFile, names: &file::Names, family: Family) -> Vec<ProgramFile> {
        let mut files: Vec<ProgramFile> = Vec::new();
        let mut parts = Parts::default();
        for section in file.ladders() {
            let number = section.number;
            if !(2..=LARGEST_NUMBER).contains(&number) || files.iter().any(|file| file.number == number) {
                let message = format!("expected program files from 2 to 255, each once, found another file {number}");
                self.note(Severity::Error, format!("LADDER {number}"), message);
                continue;
            }
            let mut rungs: Vec<Rung> = Vec::with_capacity(section.rungs.len() + 1);
            for (index, lines) in section.rungs.iter().enumerate() {
                let mut rung = match parse_rung_at(&lines.text, Some(family), lines.line.max(1)) {
                    Ok(rung) => rung,
                    Err(error) => {
                        let place = format!("file {number} > rung {}", rungs.len());
                        self.note(Severity::Error, place, format!("{error}; the rung is kept as text"));
                        unread_rung(inner_text(&lines.text).as_str())
                    }
                };
                if !parts.admit(limits::of_rung(&rung.series)) {
                    let message = limits::left_out(section.rungs.len() - index);
                    self.diagnostics.push(Diagnostic {
                        severity: Severity::Error,
                        place: format!("file {number} > rung {index}"),
                        message,
                    });
                    break;
                }
                if rung.is_end() && index + 1 < section.rungs.len() {
                    let message = format!(
                        "line {}: END ends the program file, and {} more rungs follow it",
                        lines.line.max(1),
                        section.rungs.len() - index - 1
                    );
                    self.note(Severity::Error, format!("file {number} > rung {index}"), message);
                }
                self.timers(&rung, lines.line.max(1), number, index);
                rung.comment = lines.title.as_ref().map(|block| comment(block, number, rungs.len()));
                self.open_instructions(&rung, number, rungs.len());
                rungs.push(rung);
            }
            if !rungs.last().is_some_and(Rung::is_end) {
                rungs.push(end_rung());
            }
            files.push(ProgramFile { rungs, ..program_file(number, ProgramFileKind::Ladder) });
        }
        let named = || names.program_files.iter().filter(|(number, _)| *number <= LARGEST_NUMBER);
        let last = files.iter().map(|file| file.number).chain(named().map(|name| name.0)).max().unwrap_or(2).max(2);
        for number in 0..=last {
            if files.iter().all(|file| file.number != number) {
                let kind = if number < 2 { ProgramFileKind::System } else { ProgramFileKind::Unused };
                files.push(program_file(number, kind));
            }
        }
        files.sort_by_key(|file| file.number);
        for (number, name) in named() {
            if let Some(file) = files.get_mut(usize::from(*number)) {
                name.clone_into(&mut file.name);
            }
        }
        for (number, _) in names.program_files.iter().filter(|(number, _)| *number > LARGEST_NUMBER) {
            self.note(Severity::Error, "PROJECT", format!("expected program file numbers up to 255, found {number}"));
        }
        files
    }

    /// Time bases and presets that no timer can have.
    fn timers(&mut self, rung: &Rung, line: u32, file: u16, index: usize) {
        for instruction in rung.instructions().filter(|it| matches!(it.mnemonic.name(), Some("TON" | "TOF" | "RTO"))) {
            let shown = |operand: usize| instruction.operands.get(operand).map(ToString::to_string).unwrap_or_default();
            let (element, base) = (shown(0), instruction.operands.get(1));
            let is_number = |operand: Option<&ladder::Operand>| operand.is_some_and(|it| it.constant().is_some());
            let mut wrong = Vec::new();
            if is_number(base) && instr::parameters::time_base(base).is_none() {
                wrong.push(format!("expected a time base of 0.001, 0.01 or 1.0, found {}", shown(1)));
            }
            for (operand, name) in [(2, "preset"), (3, "accumulator")] {
                let value = instruction.operands.get(operand).and_then(ladder::Operand::constant);
                if value.is_some_and(|value| value.as_integer().is_none_or(|value| i16::try_from(value).is_err())) {
                    wrong.push(format!("expected a {name} up to 32767, found {}", shown(operand)));
                }
            }
            let name = instruction.mnemonic.name().unwrap_or_default();
            for message in wrong {
                let message = format!("line {line}: {name} {element}: {message}");
                self.note(Severity::Error, format!("file {file} > rung {index}"), message);
            }
        }
    }

    /// Instructions whose words could not be matched with their box.
    fn open_instructions(&mut self, rung: &Rung, file: u16, index: usize) {
        for instruction in rung.instructions() {
            let Some(entry) = instruction.mnemonic.name().and_then(instr::by_mnemonic) else { continue };
            if entry.forms.iter().all(|form| form.operands.len() != instruction.operands.len()) {
                let message = format!(
                    "the text of {} with {} operands is not known; they are shown as they stand",
                    entry.mnemonic,
                    instruction.operands.len()
                );
                self.note(Severity::Warning, format!("file {file} > rung {index}"), message);
            }
        }
    }

    fn data_files(&mut self, file: &SlcFile, image: &mut Image) {
        let mut seen = HashSet::new();
        let mut total = 0;
        for section in file.data() {
            let place = format!("DATA {}{}", section.letters, section.number.map_or(String::new(), |n| n.to_string()));
            if !limits::admit_words(&mut total, section.words.len()) {
                self.note(Severity::Error, place, limits::words_left_out(section.words.len()));
                continue;
            }
            let Some(file_type) = FileType::from_letters(&section.letters) else {
                self.note(
                    Severity::Error,
                    place,
                    format!("data files of type {} are not known; the section is left out", section.letters),
                );
                continue;
            };
            if matches!(file_type, FileType::O | FileType::I) {
                let outputs = file_type == FileType::O;
                io_words(image, file_type, section.first, &section.words);
                let expected = expected_words(&image.io, section.first, outputs);
                if expected.is_some_and(|expected| usize::from(expected) != section.words.len()) {
                    let message = format!(
                        "expected {} words of slot {}, found {}",
                        expected.unwrap_or(0),
                        section.first,
                        section.words.len()
                    );
                    self.note(Severity::Warning, place, message);
                }
                continue;
            }
            let number = section.number.or(file_type.implied_file()).unwrap_or(0);
            // Function files are numbered on their own, data files together.
            let key = (file_type.is_function_file().then_some(file_type), number);
            if number > LARGEST_NUMBER || !seen.insert(key) {
                let message = "expected data files numbered to 255, each once; this one is left out";
                self.note(Severity::Error, place, message);
                continue;
            }
            let mut table = DataFile::new(file_type, number, 0);
            if section.words_per_element > 0 {
                table.words_per_element = section.words_per_element;
            }
            let size = usize::from(table.words_per_element.max(1));
            match u16::try_from(section.words.len() / size) {
                Ok(elements) => {
                    table.elements = elements;
                    table.words = section.words.clone();
                }
                Err(_) => {
                    let message = format!("expected at most 65535 elements, found {}", section.words.len() / size);
                    self.note(Severity::Error, place, message);
                    continue;
                }
            }
            if file_type.is_function_file() {
                image.function_files.push(table);
            } else {
                image.data_files.push(table);
            }
        }
        fill_gaps(image);
    }

    fn forces(&mut self, file: &SlcFile, image: &mut Image) {
        for section in file.forces() {
            let file_type = if section.outputs { FileType::O } else { FileType::I };
            let range = |slot: &Slot| if section.outputs { slot.outputs } else { slot.inputs };
            let first =
                image.io.slots.iter().find(|slot| slot.number == section.slot).map(|slot| range(slot).first_word);
            let place = format!("FORCE {file_type}:{:02}", section.slot);
            let (Some(first), Some(table)) =
                (first, image.data_files.iter_mut().find(|file| file.file_type == file_type))
            else {
                if section.words.iter().any(|force| *force != Force::NONE) {
                    self.note(Severity::Error, place, "expected forces of a known slot; these are left out");
                }
                continue;
            };
            let end = usize::from(first) + section.words.len();
            if end > table.forces.len() {
                let message = format!("expected forces for {} words, found more", table.forces.len());
                self.note(Severity::Warning, place, message);
            }
            for (place, force) in table.forces.iter_mut().skip(usize::from(first)).zip(&section.words) {
                *place = *force;
            }
        }
    }
}

/// Puts the words of a slot into file O or I.
fn io_words(image: &mut Image, file_type: FileType, slot: u16, words: &[u16]) {
    let outputs = file_type == FileType::O;
    let range = |slot: &Slot| if outputs { slot.outputs } else { slot.inputs };
    if image.data_files.iter().all(|file| file.file_type != file_type) {
        let end = |slot: &Slot| range(slot).first_word.saturating_add(range(slot).words);
        let all = image.io.slots.iter().map(end).max().unwrap_or(0);
        // At the front, where every later slot finds it at once.
        image.data_files.insert(0, DataFile::new(file_type, file_type.implied_file().unwrap_or(0), all));
    }
    let first = image.io.slots.iter().find(|known| known.number == slot).map(|slot| range(slot).first_word);
    let Some(file) = image.data_files.iter_mut().find(|file| file.file_type == file_type) else { return };
    // Words of a slot that no SLOT line names follow what is there already.
    let start = first.map_or(file.words.len(), usize::from);
    let end = start.saturating_add(words.len()).min(usize::from(u16::MAX));
    if file.words.len() < end {
        file.words.resize(end, 0);
    }
    for (place, word) in file.words.iter_mut().skip(start).zip(words) {
        *place = *word;
    }
    file.elements = u16::try_from(file.words.len()).unwrap_or(u16::MAX);
    file.forces.resize(file.words.len(), Force::NONE);
}

fn program_file(number: u16, kind: ProgramFileKind) -> ProgramFile {
    ProgramFile { number, name: String::new(), description: String::new(), kind, rungs: Vec::new() }
}

fn end_rung() -> Rung {
    let end = ladder::Instruction::new(ladder::Mnemonic::named("END"), Vec::new());
    Rung::new(vec![ladder::Element::Instruction(end)])
}

/// The text between `SOR` and `EOR`, on one line.
fn inner_text(text: &str) -> String {
    let text = text.replace(['\r', '\n'], " ");
    let inner = text.trim();
    let framed = inner.strip_prefix("SOR").and_then(|rest| rest.strip_suffix("EOR"));
    framed.map_or(inner, str::trim).to_owned()
}

fn comment(block: &file::TitleBlock, file: u16, rung: usize) -> Comment {
    Comment {
        text: block.description.replace('\n', "\r\n"),
        title: block.title.replace('\n', "\r\n"),
        owner: CommentOwner::Rung { file, rung: u32::try_from(rung).unwrap_or(u32::MAX) },
    }
}

fn expected_words(io: &IoConfiguration, slot: u16, outputs: bool) -> Option<u16> {
    let slot = io.slots.iter().find(|known| known.number == slot)?;
    Some(if outputs { slot.outputs.words } else { slot.inputs.words })
}

/// Orders the files and names the free numbers between them. Numbers below 9 that are missing stay
/// missing: every processor has those files.
fn fill_gaps(image: &mut Image) {
    let is_module = |file: &DataFile| matches!(file.file_type, FileType::M0 | FileType::M1);
    let used: HashSet<u16> = image.data_files.iter().filter(|file| !is_module(file)).map(|file| file.number).collect();
    let last = used.iter().copied().max().unwrap_or(0);
    for number in (8..last).filter(|number| !used.contains(number)) {
        let reserved = number == 8 && image.family() == Family::SlcFixed;
        let mut file = DataFile::new(if reserved { FileType::Reserved } else { FileType::Unused }, number, 0);
        file.words_per_element = 0;
        if reserved {
            "RESERVED".clone_into(&mut file.name);
        }
        image.data_files.push(file);
    }
    image.data_files.sort_by_key(|file| (is_module(file), file.number));
}
