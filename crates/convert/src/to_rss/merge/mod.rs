//! A merged program into the project file it was merged into: only what changed is written anew.
//!
//! Every rung keeps the record it has in the project it comes from: compiled code, set-ups of messages,
//! operation codes nobody knows. Streams nobody merged (windows, print options, the online image) stay as
//! ours has them. The download image of the last verify belongs to no merged program and is taken out, so
//! RSLogix verifies again.

mod data;
mod documentation;

use std::collections::BTreeMap;

use ladder::{Comment, Image, ProgramFileKind};
use rss::compiler::Compiler;
use rss::data::{DataFiles, ExtensionalDataFiles};
use rss::database::Database;
use rss::program::{self, LadFile, ProgramFiles};
use rss::{Error, ImageKind, Mode, Record, Result, StreamKind};

use super::{Built, Notes, program as fresh, text};

/// A ladder file of the result.
#[derive(Clone, Debug)]
pub struct FileSource {
    /// Its number.
    pub number: u16,
    /// It comes from theirs: ours has no such file.
    pub theirs: bool,
    /// Its rungs.
    pub rungs: Vec<RungSource>,
}

/// Where a rung of the result comes from.
#[derive(Clone, Debug)]
pub struct RungSource {
    /// From theirs.
    pub theirs: bool,
    /// Program file there.
    pub file: u16,
    /// Rung there, from 0.
    pub rung: usize,
    /// Its comment.
    pub comment: Option<Comment>,
}

/// Parts that are taken whole from theirs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Whole {
    /// Processor.
    pub processor: bool,
    /// I/O configuration.
    pub io: bool,
    /// Communication channels.
    pub channels: bool,
}

/// The projects with what was read of ours.
#[derive(Clone, Copy, Debug)]
pub struct Sides<'a> {
    /// The project both were made of.
    pub base: &'a rss::Project,
    /// The project that is merged into.
    pub ours: &'a rss::Project,
    /// The project that is merged.
    pub theirs: &'a rss::Project,
    /// The program of ours.
    pub image: &'a Image,
}

/// Writes a merged program into a copy of ours.
///
/// # Errors
/// A stream that cannot be read whole, and what its fields cannot hold. Nothing is written then.
pub fn merged_file(sides: Sides<'_>, files: &[FileSource], merged: &Image, whole: Whole) -> Result<Built> {
    let mut notes = Notes(Vec::new());
    let mut file = sides.ours.clone();
    let logic = sides.image.program_files != merged.program_files;
    if logic || sides.image.documentation != merged.documentation {
        let both = (record::<ProgramFiles<'_>>(sides.ours)?, record::<ProgramFiles<'_>>(sides.theirs)?);
        let databases = (record::<Database<'_>>(sides.ours)?, record::<Database<'_>>(sides.theirs)?);
        let mut comments = documentation::Comments::new(&databases.0);
        let programs = programs(&both, files, merged, &mut comments)?;
        let database = documentation::database(&databases, comments, &merged.documentation)?;
        if databases.0.groups != databases.1.groups {
            notes.note("symbol groups", "differ: those of ours stay");
        }
        set(&mut file, StreamKind::ProgramFiles, &programs)?;
        set(&mut file, StreamKind::MemDatabase, &database)?;
    }
    if logic {
        set(&mut file, StreamKind::Compiler, &Compiler::default())?;
        notes.note("program", "has to be verified in RSLogix: the image of the last verify was taken out");
    }
    if (&sides.image.data_files, &sides.image.function_files) != (&merged.data_files, &merged.function_files) {
        let both = (record::<DataFiles<'_>>(sides.ours)?.0, record::<DataFiles<'_>>(sides.theirs)?.0);
        set(&mut file, StreamKind::DataFiles, &DataFiles(data::holder(&both, sides.image, merged)?))?;
        let both =
            (record::<ExtensionalDataFiles<'_>>(sides.ours)?.0, record::<ExtensionalDataFiles<'_>>(sides.theirs)?.0);
        let holder = data::holder(&both, sides.image, merged)?;
        set(&mut file, StreamKind::ExtensionalDataFiles, &ExtensionalDataFiles(holder))?;
    }
    for (take, kinds) in [
        (whole.processor, &[StreamKind::Processor][..]),
        (whole.io, &[StreamKind::IoConfiguration, StreamKind::PowerConfiguration]),
        (whole.channels, &[StreamKind::ChannelConfiguration]),
    ] {
        for kind in kinds.iter().filter(|_| take) {
            if let Some(stream) = sides.theirs.stream(ImageKind::Main, *kind) {
                file.set_payload(ImageKind::Main, *kind, stream.payload())?;
            }
        }
    }
    streams(sides, &mut file, &mut notes)?;
    if sides.image.processor.program_id != merged.processor.program_id && !whole.processor {
        notes.note("processor", "the program ID is that of ours");
    }
    for image in file.images().filter(|image| *image != ImageKind::Main) {
        let name = if image == ImageKind::Online { "the online image" } else { "the automatic save" };
        notes.note(name, "is that of ours: it was not merged");
    }
    Ok(Built { file, notes: notes.0 })
}

/// Streams that are taken whole: what RSLogix keeps beside the program for people.
const BESIDE: [StreamKind; 12] = [
    StreamKind::RevisionNotes,
    StreamKind::CustomDataMonitors,
    StreamKind::GraphicFiles,
    StreamKind::RecipeFiles,
    StreamKind::RcpHolder,
    StreamKind::Trends,
    StreamKind::DataLogging,
    StreamKind::ReportOptions,
    StreamKind::ReportOptions5,
    StreamKind::ReportOptionSetup,
    StreamKind::Pc5Options,
    StreamKind::SourceControl,
];

/// Takes over what only theirs changed beside the program, and tells what both did.
fn streams(sides: Sides<'_>, file: &mut rss::Project, notes: &mut Notes) -> Result<()> {
    let payload = |project: &'_ rss::Project, kind| -> Option<Vec<u8>> {
        project.stream(ImageKind::Main, kind).map(|stream| stream.payload().to_vec())
    };
    for kind in BESIDE {
        let [base, ours, theirs] = [sides.base, sides.ours, sides.theirs].map(|project| payload(project, kind));
        let Some(new) = theirs.as_deref().filter(|_| theirs != base && theirs != ours) else { continue };
        if ours == base {
            file.set_payload(ImageKind::Main, kind, new)?;
        } else {
            notes.note(kind.name(), "was changed on both sides: that of ours stays");
        }
    }
    Ok(())
}

/// A stream of the main image, whole.
fn record<'p, R: Record<'p> + Named>(project: &'p rss::Project) -> Result<R> {
    let path = R::KIND.path(ImageKind::Main);
    let stream = project
        .stream(ImageKind::Main, R::KIND)
        .ok_or_else(|| Error::Unwritable(format!("{path}: the project has no such stream")))?;
    let parsed = rss::parse::<R>(stream.payload(), stream.path(), Mode::Permissive);
    if let Some(error) = parsed.error {
        return Err(error);
    }
    match parsed.deviations.first().or(stream.deviations().first()) {
        Some(first) => Err(first.clone().into()),
        None => Ok(parsed.value),
    }
}

/// The stream of a record.
trait Named {
    const KIND: StreamKind;
}

impl Named for ProgramFiles<'_> {
    const KIND: StreamKind = StreamKind::ProgramFiles;
}

impl Named for Database<'_> {
    const KIND: StreamKind = StreamKind::MemDatabase;
}

impl Named for DataFiles<'_> {
    const KIND: StreamKind = StreamKind::DataFiles;
}

impl Named for ExtensionalDataFiles<'_> {
    const KIND: StreamKind = StreamKind::ExtensionalDataFiles;
}

fn set<'a>(file: &mut rss::Project, kind: StreamKind, record: &impl Record<'a>) -> Result<()> {
    file.set_payload(ImageKind::Main, kind, &rss::serialize(record)?)
}

/// Program files with the rungs of both sides.
fn programs<'a>(
    (ours, theirs): &(ProgramFiles<'a>, ProgramFiles<'a>),
    files: &[FileSource],
    merged: &'a Image,
    comments: &mut documentation::Comments,
) -> Result<ProgramFiles<'a>> {
    let by_number = |records: &ProgramFiles<'a>| -> BTreeMap<u16, LadFile<'a>> {
        records.files.iter().map(|file| (file.number, file.clone())).collect()
    };
    let (ours, theirs) = (by_number(ours), by_number(theirs));
    let last = merged.program_files.iter().map(|file| file.number).max().unwrap_or(2).max(2);
    let mut result = Vec::new();
    for number in 0..=last {
        let stored = ours.get(&number).or(theirs.get(&number));
        let model = merged.program_file(number);
        let Some(source) = files.iter().find(|file| file.number == number) else {
            let ladder = |file: &&LadFile<'_>| file.rungs.is_empty() || number < 2;
            let is_free = model.is_none_or(|file| file.kind != ProgramFileKind::Ladder);
            result.push(match stored.filter(ladder) {
                Some(file) if is_free => file.clone(),
                _ => LadFile { number, flags: fresh::unused_flags(number), ..LadFile::default() },
            });
            continue;
        };
        let place = |side: bool, file: u16, rung: usize| {
            let name = if side { "theirs" } else { "ours" };
            Error::Unwritable(format!("file {number}: rung {file}:{rung} of {name} is not there"))
        };
        let mut rungs = Vec::with_capacity(source.rungs.len());
        for (index, rung) in source.rungs.iter().enumerate() {
            let from = if rung.theirs { &theirs } else { &ours };
            let stored = from.get(&rung.file).and_then(|file| file.rungs.get(rung.rung));
            let stored = stored.ok_or_else(|| place(rung.theirs, rung.file, rung.rung))?;
            let old = if rung.theirs { 0 } else { stored.comment_id };
            let comment_id = match &rung.comment {
                Some(comment) => comments.id(comment, number, index, old)?,
                None => 0,
            };
            rungs.push(program::Rung { comment_id, ..stored.clone() });
        }
        let header = if source.theirs { theirs.get(&number) } else { stored };
        let mut file = header.cloned().unwrap_or_else(|| LadFile { number, ..LadFile::default() });
        file.flags = if file.rungs.is_empty() { LadFile::LADDER } else { file.flags };
        file.rung_count = u16::try_from(rungs.len())
            .map_err(|_| Error::Unwritable(format!("file {number}: {} rungs, a file holds 65,535", rungs.len())))?;
        file.rungs = rungs;
        if let Some(model) = model {
            file.name = fresh::stored_name(model)?;
            file.description = text(&model.description)?;
        }
        result.push(file);
    }
    Ok(ProgramFiles { files: result })
}
