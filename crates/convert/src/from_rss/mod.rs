//! A project file to the program model.
//!
//! Nothing is dropped silently: what a record holds and the model has no place for is reported in
//! the project's diagnostics, and so is every deviation the byte layer found.

mod channel;
mod configuration;
pub(crate) mod documentation;
mod program;

use ladder::{DataFile, Diagnostic, FileType, Force, Image, Project, RevisionNote, Severity, Source};
use rss::compiler::Compiler;
use rss::data::{DataFiles, DataHolder, ExtensionalDataFiles};
use rss::database::Database;
use rss::program::ProgramFiles;
use rss::small::{RevisionNotes, Version};
use rss::summary::{Summary, id};
use rss::{ImageKind, Mode, Record, StreamKind};

use crate::codes;
use crate::limits::{self, Parts};
use documentation::Comments;

/// Reads every image of a project file into the model. `source` names the file; the version and
/// times are filled in here.
pub fn project(file: &rss::Project, source: Source) -> Project {
    let mut reader = ImageReader { file, comments: Comments::default(), diagnostics: Vec::new() };
    for missing in file.missing() {
        let severity = if missing.essential { Severity::Error } else { Severity::Warning };
        reader.diagnostics.push(diagnostic(severity, &missing.deviation));
    }
    for deviation in file.deviations() {
        reader.diagnostics.push(diagnostic(Severity::Error, deviation));
    }
    let mut main = reader.image(ImageKind::Main);
    let has = |kind| file.images().any(|image| image == kind);
    let online = has(ImageKind::Online).then(|| reader.image(ImageKind::Online));
    let autosave = has(ImageKind::Autosave).then(|| reader.image(ImageKind::Autosave));
    let revision_notes = reader.revision_notes();
    let source = reader.source(source);
    if source.application == crate::to_rss::CHOSEN {
        configuration::chosen(&mut main.processor);
    }
    Project { source, main, online, autosave, revision_notes, diagnostics: reader.diagnostics }
}

/// One stored instruction in the model, for callers that look at instructions alone.
pub(crate) fn instruction(stored: &rss::program::Instruction<'_>) -> ladder::Instruction {
    let mut unread = Vec::new();
    let mut notes = Notes::new(String::new(), &mut unread);
    program::instruction(stored, &mut notes)
}

fn diagnostic(severity: Severity, deviation: &rss::Deviation) -> Diagnostic {
    let mut place = deviation.stream.escape_debug().to_string();
    if !place.is_empty() {
        place.push_str(", ");
    }
    place.push_str(&format!("{} {:#x}", deviation.space, deviation.offset));
    if !deviation.record.is_empty() {
        place.push_str(", in ");
        place.push_str(&deviation.record);
    }
    Diagnostic { severity, place, message: format!("expected {}, found {}", deviation.expected, deviation.found) }
}

/// Where conversion notes what it could not carry over.
pub(crate) struct Notes<'d> {
    stream: String,
    record: String,
    /// The rungs refer to the comments of another image, which may have changed since.
    borrowed_comments: bool,
    /// Of the program so far.
    parts: Parts,
    diagnostics: &'d mut Vec<Diagnostic>,
}

impl<'d> Notes<'d> {
    fn new(stream: String, diagnostics: &'d mut Vec<Diagnostic>) -> Notes<'d> {
        Notes { stream, record: String::new(), borrowed_comments: false, parts: Parts::default(), diagnostics }
    }

    fn within(&mut self, record: String) {
        self.record = record;
    }

    fn note(&mut self, message: String) {
        self.push(Severity::Note, message);
    }

    fn warning(&mut self, message: String) {
        self.push(Severity::Warning, message);
    }

    fn error(&mut self, message: String) {
        self.push(Severity::Error, message);
    }

    fn push(&mut self, severity: Severity, message: String) {
        let place = format!("{}, in {}", self.stream, self.record);
        self.diagnostics.push(Diagnostic { severity, place, message });
    }
}

struct ImageReader<'f> {
    file: &'f rss::Project,
    /// Rung comments of the main image: the online image refers to them too.
    comments: Comments,
    diagnostics: Vec<Diagnostic>,
}

impl<'f> ImageReader<'f> {
    /// A typed stream; what stopped reading it and what deviates goes to the diagnostics.
    fn read<R: Record<'f>>(&mut self, image: ImageKind, kind: StreamKind) -> Option<R> {
        let stream = self.file.stream(image, kind)?;
        let parsed = rss::parse::<R>(stream.payload(), stream.path(), Mode::Permissive);
        for deviation in &parsed.deviations {
            self.diagnostics.push(diagnostic(Severity::Warning, deviation));
        }
        if let Some(error) = &parsed.error {
            self.diagnostics.push(match error.deviation() {
                Some(deviation) => diagnostic(Severity::Error, deviation),
                None => Diagnostic {
                    severity: Severity::Error,
                    place: stream.path().to_owned(),
                    message: error.to_string(),
                },
            });
        }
        Some(parsed.value)
    }

    fn image(&mut self, kind: ImageKind) -> Image {
        let mut image = Image::default();
        let mut model = 0;
        if let Some(record) = self.read::<rss::processor::Processor<'_>>(kind, StreamKind::Processor) {
            model = record.model.0;
            image.processor = configuration::processor(&record);
        }
        if let Some(record) = self.read::<rss::io::IoConfiguration<'_>>(kind, StreamKind::IoConfiguration) {
            image.io = configuration::io(&record);
        }
        if let Some(record) =
            self.read::<rss::channel::ChannelConfiguration<'_>>(kind, StreamKind::ChannelConfiguration)
        {
            image.channels = channel::channels(&record);
        }
        if let Some(record) = self.read::<Compiler<'_>>(kind, StreamKind::Compiler) {
            image.memory = configuration::memory(&record, model);
        }
        self.data(kind, &mut image);
        channel::hardware_address(&mut image.channels, &image.function_files, model);
        // The online image has no documentation of its own; its rungs refer to the main one's.
        let mut comments = match kind {
            ImageKind::Online => std::mem::take(&mut self.comments),
            _ => self.documentation(kind, &mut image),
        };
        if let Some(record) = self.read::<ProgramFiles<'_>>(kind, StreamKind::ProgramFiles) {
            let mut notes = Notes::new(StreamKind::ProgramFiles.path(kind), &mut self.diagnostics);
            notes.borrowed_comments = kind == ImageKind::Online;
            image.program_files = program::program_files(&record, &mut comments, &mut notes);
        }
        if kind != ImageKind::Online {
            image.documentation.detached_comments = comments.detached();
        }
        if kind == ImageKind::Main {
            self.comments = comments;
        }
        image
    }

    /// The rung comments of an image; its other documentation goes into the image. The record, the
    /// largest of all, is gone before the programs are read.
    fn documentation(&mut self, kind: ImageKind, image: &mut Image) -> Comments {
        let Some(database) = self.read::<Database<'_>>(kind, StreamKind::MemDatabase) else {
            return Comments::default();
        };
        image.documentation = documentation::documentation(&database);
        Comments::new(&database, &StreamKind::MemDatabase.path(kind), &mut self.diagnostics)
    }

    fn data(&mut self, kind: ImageKind, image: &mut Image) {
        let plain = self.read::<DataFiles<'_>>(kind, StreamKind::DataFiles).map(|files| files.0);
        let twin = self.read::<ExtensionalDataFiles<'_>>(kind, StreamKind::ExtensionalDataFiles).map(|files| files.0);
        // Both streams hold the same tables; the one that reads further is taken.
        let holder = match (plain, twin) {
            (Some(plain), Some(twin)) => {
                self.compare_twins(kind, &plain, &twin);
                if count(&twin) > count(&plain) { twin } else { plain }
            }
            (Some(only), None) | (None, Some(only)) => only,
            (None, None) => return,
        };
        let mut total = 0;
        let mut data_file = |stored: &rss::data::DataFile<'_>| {
            let words = stored.data.iter().count();
            let fits = limits::admit_words(&mut total, words);
            if !fits {
                self.diagnostics.push(Diagnostic {
                    severity: Severity::Error,
                    place: format!("{}, in file {}", StreamKind::DataFiles.path(kind), stored.number),
                    message: limits::words_left_out(words),
                });
            }
            data_file(stored, fits)
        };
        image.data_files = holder.user.iter().map(&mut data_file).collect();
        image.function_files = holder.function.iter().map(&mut data_file).collect();
        let module_files: Vec<DataFile> = holder.m.iter().map(&mut data_file).collect();
        for file in image.data_files.iter().chain(&image.function_files) {
            if let FileType::Unknown(code) = file.file_type {
                self.diagnostics.push(Diagnostic {
                    severity: Severity::Warning,
                    place: format!("{}, in file {}", StreamKind::DataFiles.path(kind), file.number),
                    message: format!(
                        "type number {code} has no known letters; its words are kept and shown as they are"
                    ),
                });
            }
        }
        image.data_files.extend(module_files.into_iter().filter(|file| file.elements > 0));
        let status = image.data_file(FileType::S, 2);
        image.processor.deny_future_access = status.and_then(|file| file.words.get(1)).map(|word| word & 0x4000 != 0);
    }

    fn compare_twins(&mut self, kind: ImageKind, plain: &DataHolder<'_>, twin: &DataHolder<'_>) {
        let all = |holder: &'_ DataHolder<'_>| holder.user.len() + holder.function.len() + holder.m.len();
        let pairs = plain.user.iter().zip(&twin.user).chain(plain.function.iter().zip(&twin.function));
        let differing = pairs.filter(|(a, b)| a.data != b.data || a.forces != b.forces || a.name != b.name).count();
        if differing > 0 || all(plain) != all(twin) {
            self.diagnostics.push(Diagnostic {
                severity: Severity::Warning,
                place: StreamKind::ExtensionalDataFiles.path(kind),
                message: format!(
                    "expected the same tables as in {}, found {differing} that differ ({} and {} files)",
                    StreamKind::DataFiles.name(),
                    all(plain),
                    all(twin)
                ),
            });
        }
    }

    fn revision_notes(&mut self) -> Vec<RevisionNote> {
        let record = self.read::<RevisionNotes<'_>>(ImageKind::Main, StreamKind::RevisionNotes);
        let notes = record.map(|record| record.notes).unwrap_or_default();
        let note = |(revision, note): (u32, rss::Text<'_>)| RevisionNote { revision, note: note.decode().into_owned() };
        notes.into_iter().map(note).collect()
    }

    fn source(&mut self, mut source: Source) -> Source {
        if let Some(version) = self.read::<Version<'_>>(ImageKind::Main, StreamKind::Version) {
            source.saved_by = version.version.decode().into_owned();
        }
        let Some(stream) = self.file.stream(ImageKind::Main, StreamKind::SummaryInformation) else { return source };
        match Summary::read(stream.payload()) {
            Ok(summary) => {
                source.application = summary.text(id::APPLICATION).map(|text| text.into_owned()).unwrap_or_default();
                source.saved_at = summary.time(id::SAVED).and_then(rfc3339);
                source.created_at = summary.time(id::CREATED).and_then(rfc3339);
            }
            Err(error) => self.diagnostics.push(match error.deviation() {
                Some(deviation) => diagnostic(Severity::Warning, deviation),
                None => Diagnostic {
                    severity: Severity::Warning,
                    place: "summary properties".to_owned(),
                    message: error.to_string(),
                },
            }),
        }
        source
    }
}

fn count(holder: &DataHolder<'_>) -> usize {
    holder.user.len() + holder.function.len() + holder.m.len()
}

/// A data file with its values, or without where there are too many.
fn data_file(stored: &rss::data::DataFile<'_>, with_words: bool) -> DataFile {
    let forces = (0..stored.forces.len() / 2).filter_map(|index| stored.force(index));
    DataFile {
        number: stored.number,
        file_type: codes::file_type(stored.type_code.0),
        name: stored.name.decode().into_owned(),
        description: stored.description.decode().into_owned(),
        elements: stored.elements,
        words_per_element: stored.words,
        words: if with_words { stored.data.iter().collect() } else { Vec::new() },
        forces: forces.map(|(on, off)| Force { on, off }).collect(),
    }
}

/// Seconds from 1601, where Windows file times start, to 1970.
const EPOCH_SECONDS: i64 = 11_644_473_600;

/// A Windows file time (100 ns since 1601, UTC) to the second.
fn rfc3339(ticks: u64) -> Option<String> {
    let seconds = i64::try_from(ticks / 10_000_000).ok()?.checked_sub(EPOCH_SECONDS)?;
    Some(jiff::Timestamp::from_second(seconds).ok()?.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_times_are_utc() {
        assert_eq!(rfc3339(116_444_736_000_000_000).as_deref(), Some("1970-01-01T00:00:00Z"));
        assert_eq!(rfc3339(128_166_372_003_061_629).as_deref(), Some("2007-02-22T17:00:00Z"));
        assert_eq!(rfc3339(u64::MAX), None);
    }
}
