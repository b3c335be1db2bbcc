//! An image of the program model to the sections of a text file.

use std::borrow::Cow;

use ladder::{
    CommentOwner, DataFile, Diagnostic, FileType, Force, Image, IoRange, ProgramFile, ProgramFileKind, Rung, Severity,
    Slot,
};

use super::processor;
use crate::slc::file::{Data, Forces, Ladder, Names, RungLines, Section, SlcFile, Slot as SlotLine, TitleBlock};
use crate::slc::rung::{not_in_text, rung_text_for};

/// A text file made from an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Export {
    /// The file; [`SlcFile::write`] gives its text.
    pub file: SlcFile,
    /// What such a file cannot hold or holds in our own notation, with its place.
    pub notes: Vec<Diagnostic>,
}

/// Makes a text file of an image. Reading it back gives the same program, data words, forces and
/// rung comments, but for what the notes say.
pub fn export(image: &Image) -> Export {
    let mut exporter = Exporter { image, sections: Vec::new(), notes: Vec::new() };
    exporter.sections.push(Section::Start(processor::start(&image.processor)));
    let slots: Vec<SlotLine> = image.io.slots.iter().map(|slot| exporter.slot(slot)).collect();
    if !slots.is_empty() {
        exporter.sections.push(Section::Rack(slots));
    }
    exporter.names();
    for file in image.ladder_files() {
        exporter.ladder(file);
    }
    exporter.data();
    exporter.forces();
    exporter.documentation();
    Export { file: SlcFile { sections: exporter.sections, diagnostics: Vec::new() }, notes: exporter.notes }
}

struct Exporter<'a> {
    image: &'a Image,
    sections: Vec<Section>,
    notes: Vec<Diagnostic>,
}

impl Exporter<'_> {
    fn note(&mut self, severity: Severity, place: impl Into<String>, message: impl Into<String>) {
        self.notes.push(Diagnostic { severity, place: place.into(), message: message.into() });
    }

    fn slot(&self, slot: &Slot) -> SlotLine {
        let start = processor::start(&self.image.processor);
        let is_controller = slot.number == 0 && self.image.family().is_micrologix();
        let (catalog, description) = if is_controller {
            (start.catalog, start.description)
        } else {
            let catalog = slot.module.catalog.clone().unwrap_or_else(|| processor::UNKNOWN.to_owned());
            (catalog, slot.module.description.clone())
        };
        let plain = |text: String| text.replace(['%', '\r', '\n'], " ").trim().to_owned();
        SlotLine {
            number: slot.number,
            catalog: plain(catalog),
            description: plain(description),
            scan_in: slot.inputs.words,
            scan_out: slot.outputs.words,
            configuration: (!slot.configuration.is_empty()).then(|| slot.configuration.clone()),
            io_card: self.io_card(),
        }
    }

    /// The twelve numbers that follow every slot, for controllers whose kind of base unit is stored.
    /// The last five are those of the known files.
    fn io_card(&self) -> Option<Vec<i32>> {
        let base = self.image.io.slots.iter().find(|slot| slot.number == 0)?;
        let unit = u16::from_str_radix(base.module.identity.strip_prefix("base unit 0x")?, 16).ok()?;
        let range = |range: &IoRange| [i32::from(range.bits % 16), i32::from(range.words), i32::from(range.first_word)];
        let mut card = vec![i32::from(unit)];
        card.extend(range(&base.inputs));
        card.extend(range(&base.outputs));
        card.extend([0, 0, 2, 0, 0]);
        Some(card)
    }

    fn names(&mut self) {
        let one_line = |text: &str| text.replace(['\r', '\n'], " ");
        let files = self.image.program_files.iter().filter(|file| !file.name.is_empty());
        let program_files = files.map(|file| (file.number, one_line(&file.name))).collect();
        let project = one_line(&self.image.processor.project_name);
        self.sections.push(Section::Project(Names { project, program_files }));
    }

    fn ladder(&mut self, file: &ProgramFile) {
        // The rung that ends the file is not written, unless it carries a comment.
        let (last, before) = match file.rungs.split_last() {
            Some((last, before)) if last.is_end() => (last.comment.as_ref().map(|_| last), before),
            _ => {
                let message = "has no END rung; one is added when the text is read";
                self.note(Severity::Note, format!("program file {}", file.number), message);
                (None, file.rungs.as_slice())
            }
        };
        let mut rungs = Vec::with_capacity(before.len());
        for (index, rung) in before.iter().chain(last).enumerate() {
            let place = || format!("file {} > rung {index}", file.number);
            let not_carried: Vec<Cow<'_, str>> = not_in_text(rung);
            for what in not_carried {
                self.note(Severity::Warning, place(), format!("not in the text: {what}"));
            }
            let title = rung.comment.as_ref().map(|comment| {
                if let CommentOwner::Address(target) = &comment.owner {
                    let message = format!("its comment belongs to {target}; in the text it belongs to the rung");
                    self.note(Severity::Note, place(), message);
                }
                let normal = |text: &str| text.replace("\r\n", "\n").replace('\r', "\n");
                let block = TitleBlock { title: normal(&comment.title), description: normal(&comment.text) };
                if block.title.replace('\n', "\r\n") != comment.title
                    || block.description.replace('\n', "\r\n") != comment.text
                {
                    self.note(Severity::Note, place(), "line ends of its comment are made uniform");
                }
                block
            });
            if rung.edited {
                self.note(Severity::Note, place(), "not in the text: the mark of an edit that was not verified");
            }
            rungs.push(RungLines { text: framed(rung, self.image.family()), title, ..RungLines::default() });
        }
        self.sections.push(Section::Ladder(Ladder { number: file.number, rungs, extra: String::new() }));
    }

    fn data(&mut self) {
        let image = self.image;
        for file_type in [FileType::O, FileType::I] {
            let Some(file) = image.data_files.iter().find(|file| file.file_type == file_type) else { continue };
            for (slot, words) in self.by_slot(file, &file.words) {
                self.sections.push(Section::Data(data(file, None, slot, words)));
            }
        }
        let others = image.data_files.iter().filter(|file| !matches!(file.file_type, FileType::O | FileType::I));
        for file in others.chain(&image.function_files) {
            let place = format!("data file {}", file.label());
            match file.file_type {
                FileType::Unused | FileType::Reserved => continue,
                FileType::Unknown(_) | FileType::M0 | FileType::M1 => {
                    if !file.words.is_empty() {
                        self.note(Severity::Warning, place, "not in the text: the notation has no form for this type");
                    }
                    continue;
                }
                _ => {}
            }
            if file.words.len() != usize::from(file.elements) * usize::from(file.words_per_element) {
                self.note(Severity::Warning, place.clone(), "its words are not those of its elements");
            }
            if file.file_type.words_per_element().is_some_and(|size| size != file.words_per_element)
                && !file.words.is_empty()
            {
                let message = format!("not in the text: elements of {} words", file.words_per_element);
                self.note(Severity::Warning, place, message);
                continue;
            }
            let number = if file.file_type == FileType::S { None } else { Some(file.number) };
            self.sections.push(Section::Data(data(file, number, 0, file.words.clone())));
        }
    }

    /// The entries of a table of O or I by slot; all of them at slot 0 where the slots do not fit.
    fn by_slot<T: Clone>(&mut self, file: &DataFile, entries: &[T]) -> Vec<(u16, Vec<T>)> {
        let range = |slot: &Slot| if file.file_type == FileType::O { slot.outputs } else { slot.inputs };
        let mut next = 0_usize;
        let mut parts = Vec::new();
        for slot in &self.image.io.slots {
            let range = range(slot);
            if range.words == 0 {
                continue;
            }
            let end = next + usize::from(range.words);
            match entries.get(next..end) {
                Some(part) if usize::from(range.first_word) == next => parts.push((slot.number, part.to_vec())),
                _ => return self.unslotted(file, entries),
            }
            next = end;
        }
        if next == entries.len() { parts } else { self.unslotted(file, entries) }
    }

    fn unslotted<T: Clone>(&mut self, file: &DataFile, entries: &[T]) -> Vec<(u16, Vec<T>)> {
        let place = format!("data file {}", file.label());
        self.note(Severity::Note, place, "the slots do not account for its words; all are written at slot 0");
        if entries.is_empty() { Vec::new() } else { vec![(0, entries.to_vec())] }
    }

    fn forces(&mut self) {
        let image = self.image;
        for file_type in [FileType::O, FileType::I] {
            let Some(file) = image.data_files.iter().find(|file| file.file_type == file_type) else { continue };
            if file.forces.is_empty() {
                continue;
            }
            let notes = self.notes.len();
            let parts: Vec<(u16, Vec<Force>)> = self.by_slot(file, &file.forces);
            // Said once, with the data.
            self.notes.truncate(notes);
            for (slot, words) in parts {
                let outputs = file_type == FileType::O;
                self.sections.push(Section::Force(Forces { outputs, slot, words, extra: String::new() }));
            }
        }
    }

    /// What a text file has no place for.
    fn documentation(&mut self) {
        let image = self.image;
        let docs = &image.documentation;
        let described = |file: &&DataFile| !file.name.is_empty() || !file.description.is_empty();
        let counts = [
            (docs.entries().len(), "symbols and descriptions of addresses"),
            (docs.instruction_comments().len(), "instruction comments"),
            (docs.detached_comments.len(), "comments of rungs that no longer exist"),
            (image.program_files.iter().filter(|f| !f.description.is_empty()).count(), "descriptions of program files"),
            (image.data_files.iter().filter(described).count(), "names and descriptions of data files"),
            (image.channels.len(), "communication channels"),
        ];
        for (count, what) in counts.into_iter().filter(|(count, _)| *count > 0) {
            self.note(Severity::Note, "project", format!("not in the text: {what} ({count})"));
        }
        let odd = image.program_files.iter().filter(|f| f.kind != ProgramFileKind::Ladder && !f.rungs.is_empty());
        let odd: Vec<u16> = odd.map(|file| file.number).collect();
        for number in odd {
            self.note(Severity::Warning, format!("program file {number}"), "not in the text: it is no ladder file");
        }
    }
}

fn framed(rung: &Rung, family: ladder::Family) -> String {
    let text = rung_text_for(rung, Some(family).filter(|family| *family != ladder::Family::Unknown));
    if rung.series.is_empty() { text } else { format!("SOR {text} EOR") }
}

fn data(file: &DataFile, number: Option<u16>, first: u16, words: Vec<u16>) -> Data {
    Data {
        letters: file.file_type.to_string(),
        number,
        first,
        words_per_element: file.words_per_element,
        words,
        extra: String::new(),
    }
}
