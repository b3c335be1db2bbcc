//! The document of an RSLogix 500 project.

mod calls;
mod data;
mod findings;
mod io;
mod online;
mod overview;
mod program;
mod symbols;
mod timers;
mod xref;

pub(crate) use overview::{Pairs, diagnostics};

use std::collections::HashMap;

use analysis::{CallGraph, CrossReference, Location};
use ladder::{Address, Diagnostic, Documentation, Image, Project, Severity};

use crate::anchor::Anchor;
use crate::model::{Block, Document, Note, NoteKind, Section, Text};
use crate::options::{Kind, Options};
use crate::words::one_line;

/// The project and the image of it that is shown.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// The project.
    pub project: &'a Project,
    /// The image.
    pub image: &'a Image,
    /// Its documentation: the main image's for the online image, which has none of its own.
    pub documentation: &'a Documentation,
    /// Which image it is when it is not the main one: `online image`.
    pub which: &'a str,
}

impl<'a> Source<'a> {
    /// The offline program of a project.
    pub fn of(project: &'a Project) -> Source<'a> {
        let image = &project.main;
        Source { project, image, documentation: &image.documentation, which: "" }
    }
}

/// What the sections are made from.
struct Context<'a, 'x> {
    source: &'x Source<'a>,
    xref: CrossReference<'a>,
    calls: CallGraph,
    /// The first address the program names in each element: most bits and members have no entry for their
    /// element.
    first_named: HashMap<Address, Address>,
}

impl<'a> Context<'a, '_> {
    fn image(&self) -> &'a Image {
        self.source.image
    }

    fn documentation(&self) -> &'a Documentation {
        self.source.documentation
    }

    /// Symbol and description of an address.
    fn documented(&self, address: &Address) -> (String, String) {
        let shown = self.documentation().shown(&address.into(), "");
        (shown.symbol.unwrap_or_default(), one_line(&shown.description))
    }
}

impl Context<'_, '_> {
    /// The cross reference entry of an element, or the first of its bits and members.
    fn reference(&self, element: &Address) -> Anchor {
        let named = element.element_address().and_then(|element| self.first_named.get(&element));
        Anchor::reference(&named.unwrap_or(element).to_string())
    }
}

/// Builds the document of a project.
pub fn project<'a>(source: &Source<'a>, options: &Options) -> Document<'a> {
    let xref = CrossReference::build(source.image, source.documentation);
    let mut first_named = HashMap::new();
    for address in xref.named() {
        if let Some(element) = address.element_address() {
            first_named.entry(element).or_insert_with(|| address.clone());
        }
    }
    let context = Context { source, xref, first_named, calls: CallGraph::build(source.image, source.documentation) };
    let which = if source.which.is_empty() { String::new() } else { format!(" ({})", source.which) };
    let mut document = Document {
        title: format!("{}{which}", source.project.source.file),
        processor: crate::words::processor(&source.image.processor),
        tool: concat!("rungs ", env!("CARGO_PKG_VERSION")).to_owned(),
        date: options.date.clone().unwrap_or_default(),
        notes: notes(&source.project.diagnostics),
        ..Document::default()
    };
    for kind in Kind::all().filter(|kind| options.sections.has(*kind)) {
        match kind {
            Kind::Ladder => program::ladder(&context, &mut document.sections),
            Kind::Data => data::tables(&context, &mut document.sections),
            _ => document.sections.push(section(kind, blocks(kind, &context))),
        }
    }
    document.settle();
    document
}

fn section(kind: Kind, blocks: Vec<Block<'_>>) -> Section<'_> {
    Section {
        kind,
        anchor: Anchor::named(kind.name()),
        title: kind.title().to_owned(),
        short: kind.title().to_owned(),
        blocks,
    }
}

fn blocks<'a>(kind: Kind, context: &Context<'a, '_>) -> Vec<Block<'a>> {
    match kind {
        Kind::Processor => overview::processor(context),
        Kind::Io => io::configuration(context),
        Kind::Channels => overview::channels(context),
        Kind::ProgramFiles => program::list(context),
        Kind::DataFiles => data::list(context),
        Kind::Symbols => symbols::database(context),
        Kind::InstructionComments => symbols::instruction_comments(context),
        Kind::SymbolGroups => symbols::groups(context),
        Kind::CrossReference => xref::entries(context),
        Kind::Timers => timers::report(context),
        Kind::Calls => calls::tree(context),
        Kind::IoMap => io::map(context),
        Kind::Undocumented => findings::list(context, analysis::FindingKind::Undocumented),
        Kind::WrittenNeverRead => findings::list(context, analysis::FindingKind::WrittenNeverRead),
        Kind::ReadNeverWritten => findings::list(context, analysis::FindingKind::ReadNeverWritten),
        Kind::Coverage => findings::coverage(context),
        Kind::Online => online::difference(context),
        Kind::Diagnostics => overview::diagnostics(&context.source.project.diagnostics),
        // Several sections each.
        Kind::Ladder | Kind::Data => Vec::new(),
    }
}

/// Partial data must say so, whatever sections were chosen.
pub(crate) fn notes(found: &[Diagnostic]) -> Vec<Note> {
    let count = |severity| found.iter().filter(|found| found.severity == severity).count();
    let mut notes = Vec::new();
    let link = |text: String| Text::link(text, Anchor::named(Kind::Diagnostics.name()));
    match count(Severity::Error) {
        0 => {}
        1 => notes.push(Note::new(NoteKind::Error, link("A part of the project could not be read.".to_owned()))),
        n => notes.push(Note::new(NoteKind::Error, link(format!("{n} parts of the project could not be read.")))),
    }
    match count(Severity::Warning) {
        0 => {}
        n => {
            let text = format!("{} from the known form of projects.", crate::words::count(n, "deviation"));
            notes.push(Note::new(NoteKind::Warning, link(text)));
        }
    }
    notes
}

/// A rung, as a link to it.
fn rung(at: Location) -> Text {
    Text::link(at.to_string(), Anchor::rung(at.file, at.rung))
}

/// Rungs, each once, and how many more there are.
fn rungs(locations: &[Location], left_out: usize) -> Text {
    let mut text = Text::default();
    let mut last = None;
    for at in locations {
        if last.replace((at.file, at.rung)) != Some((at.file, at.rung)) {
            let before = if text.runs.is_empty() { "" } else { ", " };
            text.push(before, None);
            text = text.and(rung(*at));
        }
    }
    if left_out > 0 {
        text.push(format!("{}and {left_out} more", if text.runs.is_empty() { "" } else { ", " }), None);
    }
    text
}

fn remark<'a>(text: impl Into<Text>) -> Block<'a> {
    Block::Note(Note::new(NoteKind::Remark, text))
}
