//! The program model to a new project file.
//!
//! The result has every stream a project needs to be read back whole: program with compiled code,
//! both data table streams, documentation, processor, I/O, and the small streams with the content
//! they have in every known project. What RSLogix keeps there for itself (print options, an empty
//! VBA project, the download image of the last verify) is left out. Whether RSLogix opens such a
//! file has not been tested.

mod configuration;
mod data;
mod documentation;
pub mod merge;
pub(crate) mod program;
mod target;

use ladder::{Diagnostic, Image, ProgramFileKind, Project, Severity};
use rss::compiler::Compiler;
use rss::monitors::{MonitorKind, Monitors, Trends};
use rss::small::{self, PowerConfiguration, RcpHolder, RevisionNotes, SourceControl, Version};
use rss::summary::NewSummary;
use rss::{Error, ImageKind, Record, Result, StreamKind, Text};

/// A project file made from a model, and what it could not carry.
#[derive(Debug)]
pub struct Built {
    /// The file; [`rss::Project::write`] gives its bytes.
    pub file: rss::Project,
    /// What is missing in it or was added, with its place.
    pub notes: Vec<Diagnostic>,
}

pub(crate) use target::CHOSEN;
use target::{Target, target};

/// The RSLogix version whose format the writer follows: the one most known projects share.
const FORMAT_VERSION: [&str; 3] = ["8.30.00.16", "8.30.00", "16"];

/// Makes a project file of the main image. The same model always gives the same bytes: times are
/// left at "never".
///
/// # Errors
/// A processor without a known model number, and values a field of the format cannot hold.
pub fn project_file(project: &Project) -> Result<Built> {
    let mut image = project.main.clone();
    let mut notes = Notes(Vec::new());
    let model = target(project, &image, &mut notes)?;
    crate::tables::complete(&mut image, &mut notes.0);
    not_carried(project, &mut notes);
    let file = streams(project, &image, &model, &mut notes)?;
    Ok(Built { file, notes: notes.0 })
}

fn streams(project: &Project, image: &Image, model: &Target, notes: &mut Notes) -> Result<rss::Project> {
    let mut writer = ProjectWriter { file: rss::Project::new() };
    writer.record(StreamKind::Processor, &configuration::processor(&image.processor, model)?)?;
    writer.record(StreamKind::IoConfiguration, &configuration::io(image, model, notes)?)?;
    let channel_words = configuration::channel_bytes(model);
    writer.record(StreamKind::ChannelConfiguration, &configuration::channels(model, &channel_words))?;
    if !channel_words.is_empty() {
        notes.note("channels", "the communication channels are written blank: set them before a download");
    }
    writer.record(StreamKind::PowerConfiguration, &PowerConfiguration::default())?;
    writer.record(StreamKind::DataFiles, &data::files(image)?)?;
    writer.record(StreamKind::ExtensionalDataFiles, &data::extensional(image)?)?;
    let mut comments = documentation::CommentWriter::default();
    let programs = program::files(image, &mut comments, notes)?;
    writer.record(StreamKind::ProgramFiles, &programs)?;
    writer.record(StreamKind::MemDatabase, &documentation::database(&image.documentation, comments, notes)?)?;
    writer.record(StreamKind::Compiler, &Compiler::default())?;
    let [full, version, build] = FORMAT_VERSION.map(|text| Text::from_bytes(text.as_bytes()));
    writer.record(StreamKind::Version, &Version { full, version, build })?;
    let revision = project.revision_notes.iter().map(|note| note.revision).max().unwrap_or(0);
    let revision_notes = project.revision_notes.iter().map(|note| Ok((note.revision, text(&note.note)?)));
    writer.record(
        StreamKind::RevisionNotes,
        &RevisionNotes {
            current: revision,
            counter_a: 0,
            counter_b: revision,
            notes: revision_notes.collect::<Result<_>>()?,
        },
    )?;
    for (kind, monitors) in [
        (StreamKind::CustomDataMonitors, MonitorKind::Custom),
        (StreamKind::GraphicFiles, MonitorKind::Graphic),
        (StreamKind::RecipeFiles, MonitorKind::Recipe),
    ] {
        writer.record(kind, &Monitors::empty(monitors))?;
    }
    let recipes = u16::from(matches!(model.code, 60..=63));
    writer.record(StreamKind::RcpHolder, &RcpHolder { recipes, ..RcpHolder::default() })?;
    writer.record(StreamKind::Trends, &Trends::default())?;
    writer.record(StreamKind::SourceControl, &SourceControl::default())?;
    for constant in small::CONSTANTS {
        writer.payload(constant.kind, &constant.payload())?;
    }
    writer.payload(StreamKind::Contents, &small::CONTENTS)?;
    writer.payload(StreamKind::SummaryInformation, &summary(image, model, revision).write()?)?;
    Ok(writer.file)
}

/// What a project file could hold and this one will not.
fn not_carried(project: &Project, notes: &mut Notes) {
    for (image, name) in [(&project.online, "online image"), (&project.autosave, "automatic save")] {
        if image.is_some() {
            notes.warning(name, "is not written: the file has the offline program alone");
        }
    }
    if !project.main.processor.route.is_empty() {
        notes.note("processor", "the settings of the driver are written as of one that was never connected");
    }
}

fn summary<'a>(image: &'a Image, model: &Target, revision: u32) -> NewSummary<'a> {
    let count = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
    let programs = image.program_files.iter().filter(|file| file.kind != ProgramFileKind::Unused).count();
    let data = image.data_files.iter().filter(|file| file.file_type != ladder::FileType::Unused).count();
    NewSummary {
        processor_name: &image.processor.project_name,
        application: if model.chosen { CHOSEN } else { "rungs" },
        revision,
        program_id: image.processor.program_id.unwrap_or(0),
        instruction_words: None,
        program_files: count(programs),
        data_files: count(data),
        created: 0,
        saved: 0,
    }
}

struct ProjectWriter {
    file: rss::Project,
}

impl ProjectWriter {
    fn record<'a>(&mut self, kind: StreamKind, record: &impl Record<'a>) -> Result<()> {
        self.payload(kind, &rss::serialize(record)?)
    }

    fn payload(&mut self, kind: StreamKind, payload: &[u8]) -> Result<()> {
        self.file.set_payload(ImageKind::Main, kind, payload)
    }
}

/// What the writer tells about its result.
struct Notes(Vec<Diagnostic>);

impl Notes {
    fn note(&mut self, place: impl Into<String>, message: impl Into<String>) {
        self.push(Severity::Note, place, message);
    }

    fn warning(&mut self, place: impl Into<String>, message: impl Into<String>) {
        self.push(Severity::Warning, place, message);
    }

    fn push(&mut self, severity: Severity, place: impl Into<String>, message: impl Into<String>) {
        self.0.push(Diagnostic { severity, place: place.into(), message: message.into() });
    }
}

/// Text in the code page of project files.
pub(crate) fn text(value: &str) -> Result<Text<'_>> {
    Text::new(value).map_err(|c| Error::Unwritable(format!("`{value}`: {c:?} is not in code page 1252")))
}

/// The same, for texts made on the way.
fn owned(value: String) -> Result<Text<'static>> {
    Ok(text(&value)?.into_owned())
}
