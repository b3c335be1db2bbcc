//! Drawings for `rungs export`: every rung as SVG, or the ladder as one page or as a book.

use std::io::{self, Write};
use std::rc::Rc;

use domore::CodeBlock;
use ladder::{ProgramFile, ProgramFileKind};
use render::Style;
use render::html::Page;
use render::scene::{Item, Scene};
use render::svg;
use report::pdf::Format;
use report::{Anchor, Block, Document, Kind, Rung, Section};

use super::{Opened, OpenedDomore};
use crate::args::ExportArguments;

/// The rungs that the arguments choose from a project.
pub enum Rungs<'a> {
    /// Program file and number from 0.
    Slc(&'a Opened, Style, Vec<(&'a ProgramFile, usize)>),
    /// Code block, its place in the project, and number from 0.
    Domore(Rc<domore::documentation::Documentation<'a>>, Style, Vec<(usize, &'a CodeBlock, usize)>),
}

/// One of them, drawn.
pub struct Drawn {
    /// The file name, without ending: `002-0004`.
    pub stem: String,
    /// The name for people: `2:4`.
    pub name: String,
    /// What it belongs to, as a heading.
    pub heading: String,
    /// The drawing.
    pub scene: Scene,
}

fn style(arguments: &ExportArguments) -> Style {
    Style { state: arguments.state, ..Style::graphic(arguments.width) }
}

impl<'a> Rungs<'a> {
    /// Of an RSLogix project.
    pub fn of_project(opened: &'a Opened, arguments: &ExportArguments) -> Rungs<'a> {
        let wanted = |file: &&ProgramFile| {
            let named = arguments.program_files.is_empty() || arguments.program_files.contains(&file.number);
            file.kind == ProgramFileKind::Ladder && named && arguments.blocks.is_empty()
        };
        let rung = |index: &usize| arguments.rung.is_none_or(|range| range.holds(*index));
        let files = opened.image().program_files.iter().filter(wanted);
        let chosen = files.flat_map(|file| (0..file.rungs.len()).filter(rung).map(move |index| (file, index)));
        Rungs::Slc(opened, style(arguments), chosen.collect())
    }

    /// Of a Do-more project, whose rungs Designer counts from 1.
    pub fn of_domore(opened: &'a OpenedDomore, arguments: &ExportArguments) -> Rungs<'a> {
        let project = &opened.document.project;
        let wanted = |(_, block): &(usize, &CodeBlock)| {
            let named = arguments.blocks.is_empty() || arguments.blocks.contains(&block.name);
            named && arguments.program_files.is_empty()
        };
        let rung = |index: &usize| arguments.rung.is_none_or(|range| range.holds(index + 1));
        let blocks = project.code_blocks().enumerate().filter(wanted);
        let of_block = |(place, block): (usize, &'a CodeBlock)| {
            (0..block.rungs.len()).filter(rung).map(move |index| (place, block, index))
        };
        let chosen = blocks.flat_map(of_block).collect();
        Rungs::Domore(Rc::new(domore::documentation::Documentation::new(project)), style(arguments), chosen)
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Rungs::Slc(_, _, chosen) => chosen.len(),
            Rungs::Domore(_, _, chosen) => chosen.len(),
        }
    }

    /// The chosen rungs as sections of a document.
    fn sections(&self) -> Vec<Section<'a>> {
        let section = |anchor, title: String, blocks| {
            let short = title.split(" --- ").next().unwrap_or_default().to_owned();
            Section { kind: Kind::Ladder, anchor, title, short, blocks }
        };
        match self {
            Rungs::Slc(opened, _, chosen) => {
                let of_file = |rungs: &[(&'a ProgramFile, usize)]| {
                    let (file, _) = rungs.first()?;
                    let rung = |(file, index): &(&'a ProgramFile, usize)| {
                        Block::Rung(Rung::of_file(opened.image(), file, *index, opened.documentation()))
                    };
                    Some(section(Anchor::file(file.number), render::title(file), rungs.iter().map(rung).collect()))
                };
                chosen.chunk_by(|(a, _), (b, _)| std::ptr::eq(*a, *b)).filter_map(of_file).collect()
            }
            Rungs::Domore(documentation, _, chosen) => {
                let of_block = |rungs: &[(usize, &'a CodeBlock, usize)]| {
                    let (place, block, _) = rungs.first()?;
                    let rung = |(place, block, index): &(usize, &'a CodeBlock, usize)| {
                        Block::Rung(Rung::of_code_block(*place, block, *index, Rc::clone(documentation)))
                    };
                    Some(section(Anchor::file(place), render::domore::title(block), rungs.iter().map(rung).collect()))
                };
                chosen.chunk_by(|(a, ..), (b, ..)| a == b).filter_map(of_block).collect()
            }
        }
    }

    /// Draws one after the other, so that only one is in memory.
    pub fn drawn(&self) -> Box<dyn Iterator<Item = Drawn> + '_> {
        match self {
            Rungs::Slc(opened, style, chosen) => Box::new(chosen.iter().map(|(file, index)| Drawn {
                stem: format!("{:03}-{index:04}", file.number),
                name: format!("{}:{index}", file.number),
                heading: render::title(file),
                scene: render::scene(opened.image(), file, *index, opened.documentation(), style),
            })),
            Rungs::Domore(documentation, style, chosen) => Box::new(chosen.iter().map(|(place, block, index)| Drawn {
                // By its place: a name can hold what no file name may.
                stem: format!("{:03}-{:04}", place + 1, index + 1),
                name: format!("{}:{}", block.name, index + 1),
                heading: render::domore::title(block),
                scene: render::domore::scene(block, *index, documentation, style),
            })),
        }
    }
}

/// A rung as a file of its own.
pub fn svg(drawn: &Drawn) -> String {
    let label = format!("Rung {}", drawn.name);
    let options = svg::Options { standalone: true, label: &label, ..svg::Options::default() };
    svg::drawing(&drawn.scene, &options) + "\n"
}

/// The rungs as one page.
pub fn page(title: &str, rungs: &Rungs<'_>, out: &mut dyn Write) -> io::Result<()> {
    let mut addresses = Vec::new();
    for drawn in rungs.drawn() {
        addresses.extend(drawn.scene.items.iter().filter_map(Item::link).map(str::to_owned));
    }
    let mut page = Page::begin(out, title, addresses)?;
    let mut heading = String::new();
    for drawn in rungs.drawn() {
        if heading != drawn.heading {
            page.heading(&drawn.heading)?;
            heading = drawn.heading;
        }
        page.rung(&drawn.scene, &drawn.name)?;
    }
    page.finish()
}

/// The rungs as a book, a PDF file.
pub fn book(title: String, processor: String, rungs: &Rungs<'_>, arguments: &ExportArguments) -> Vec<u8> {
    let document = Document::of_sections(title, processor, rungs.sections());
    let paper = arguments.paper.unwrap_or_default().into();
    report::pdf::write(&document, Format { paper, landscape: arguments.landscape, state: arguments.state }).bytes
}
