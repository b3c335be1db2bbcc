//! The document: sections made of a few kinds of blocks, which every painter can paint.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use ladder::{Documentation, Image, ProgramFile};
use render::Style;
use render::scene::Scene;

use crate::anchor::Anchor;
use crate::options::Kind;

/// A report.
#[derive(Clone, Debug, Default)]
pub struct Document<'a> {
    /// File name of the project, with the image when it is not the main one.
    pub title: String,
    /// The processor, as far as it is known.
    pub processor: String,
    /// What made the report: program and version.
    pub tool: String,
    /// The date that was asked for, as given; empty: none is shown.
    pub date: String,
    /// What a reader must know before anything else, whatever sections were chosen: parts of the project
    /// that could not be read.
    pub notes: Vec<Note>,
    /// Sections in the order of the paper, then ours. Several can be of one kind: ladder files, data files.
    pub sections: Vec<Section<'a>>,
    pub(crate) places: HashSet<Anchor>,
}

/// One section: a bookmark, a chapter, something that folds.
#[derive(Clone, Debug)]
pub struct Section<'a> {
    /// Which of the sections that can be chosen it belongs to.
    pub kind: Kind,
    /// Its place.
    pub anchor: Anchor,
    /// The title as on paper: `LAD 2 - MAIN --- Total Rungs in File = 10`.
    pub title: String,
    /// The title in a list of contents: `LAD 2 - MAIN`.
    pub short: String,
    /// What it holds, in order.
    pub blocks: Vec<Block<'a>>,
}

/// A piece of a section.
#[derive(Clone, Debug)]
pub enum Block<'a> {
    /// A heading inside a section.
    Heading(String),
    /// Names and values.
    Pairs(Vec<Pair>),
    /// A table.
    Table(Table),
    /// A rung, drawn.
    Rung(Rung<'a>),
    /// A sentence.
    Note(Note),
    /// Nested items.
    Tree(Vec<TreeItem>),
}

/// A name and its value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pair {
    /// The name.
    pub name: String,
    /// The value; line ends separate lines.
    pub value: Text,
}

/// A sentence to the reader.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// How much it matters.
    pub kind: NoteKind,
    /// The sentence.
    pub text: Text,
}

/// How much a note matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NoteKind {
    /// Explains.
    Remark,
    /// Something is unusual or left out.
    Warning,
    /// Something could not be read.
    Error,
}

/// A table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its rows.
    pub rows: Vec<Row>,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Heading.
    pub title: String,
    /// How its cells are set.
    pub kind: ColumnKind,
}

/// How the cells of a column are set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ColumnKind {
    /// To the left; can be broken into lines.
    Text,
    /// To the right.
    Number,
    /// In a font of fixed width, blanks kept: addresses, bits.
    Fixed,
}

/// A row of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Its place, if links lead here.
    pub anchor: Option<Anchor>,
    /// What it is.
    pub kind: RowKind,
    /// Cells; those missing at the end are empty.
    pub cells: Vec<Text>,
}

/// What a row is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RowKind {
    /// One cell per column.
    Plain,
    /// Heads the rows below it, over all columns: the first cell is its name, the others tell about it.
    Group,
}

/// A text whose parts can be links.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Text {
    /// Its parts.
    pub runs: Vec<Run>,
}

/// A part of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    /// Characters as the project has them: painters must make control characters and marks harmless.
    pub text: String,
    /// Where it leads. Never a place that is not in the document.
    pub link: Option<Anchor>,
}

/// An item with items below it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TreeItem {
    /// What it says.
    pub text: Text,
    /// Items below.
    pub items: Vec<TreeItem>,
}

/// A rung. It is laid out when it is painted, so that a document stays small and every painter can have
/// its width.
#[derive(Clone, Debug)]
pub struct Rung<'a> {
    /// Its place.
    pub anchor: Anchor,
    /// File and rung as people write them: `2:4`.
    pub label: String,
    /// Page title, or empty.
    pub title: String,
    drawing: Drawing<'a>,
}

#[derive(Clone, Debug)]
enum Drawing<'a> {
    Rslogix {
        image: &'a Image,
        file: &'a ProgramFile,
        index: usize,
        documentation: &'a Documentation,
    },
    Domore {
        block: &'a ::domore::CodeBlock,
        index: usize,
        documentation: Rc<::domore::documentation::Documentation<'a>>,
    },
}

impl<'a> Rung<'a> {
    /// A rung of a program file; `index` from 0.
    pub fn of_file(image: &'a Image, file: &'a ProgramFile, index: usize, documentation: &'a Documentation) -> Self {
        let comment = file.rungs.get(index).and_then(|rung| rung.comment.as_ref());
        Rung {
            anchor: Anchor::rung(file.number, index),
            label: format!("{}:{index}", file.number),
            title: comment.map(|comment| comment.title.trim().to_owned()).unwrap_or_default(),
            drawing: Drawing::Rslogix { image, file, index, documentation },
        }
    }

    /// A rung of a code block, which is the `number`th of its project; `index` from 0.
    pub fn of_code_block(
        number: usize,
        block: &'a ::domore::CodeBlock,
        index: usize,
        documentation: Rc<::domore::documentation::Documentation<'a>>,
    ) -> Self {
        Rung {
            anchor: Anchor::rung(number, index + 1),
            label: format!("{}:{}", block.name, index + 1),
            title: String::new(),
            drawing: Drawing::Domore { block, index, documentation },
        }
    }

    /// What is drawn, its title and comment included.
    pub fn scene(&self, style: &Style) -> Scene {
        match &self.drawing {
            Drawing::Rslogix { image, file, index, documentation } => {
                render::scene(image, file, *index, documentation, style)
            }
            Drawing::Domore { block, index, documentation } => {
                render::domore::scene(block, *index, documentation, style)
            }
        }
    }

    /// The drawing as terminal text.
    pub fn drawn(&self, style: &Style) -> String {
        match &self.drawing {
            Drawing::Rslogix { image, file, index, documentation } => {
                render::rung(image, file, *index, documentation, style)
            }
            Drawing::Domore { block, index, documentation } => {
                render::domore::rung(block, *index, documentation, style)
            }
        }
    }
}

impl Text {
    /// A text that leads nowhere.
    pub fn plain(text: impl Into<String>) -> Text {
        let text = text.into();
        Text { runs: if text.is_empty() { Vec::new() } else { vec![Run { text, link: None }] } }
    }

    /// A text that leads somewhere.
    pub fn link(text: impl Into<String>, to: Anchor) -> Text {
        Text { runs: vec![Run { text: text.into(), link: Some(to) }] }
    }

    /// Adds a part.
    pub fn push(&mut self, text: impl Into<String>, link: Option<Anchor>) {
        let text = text.into();
        if !text.is_empty() {
            self.runs.push(Run { text, link });
        }
    }

    /// Adds a text.
    #[must_use]
    pub fn and(mut self, text: Text) -> Text {
        self.runs.extend(text.runs);
        self
    }

    /// The characters alone.
    pub fn characters(&self) -> String {
        self.runs.iter().map(|run| run.text.as_str()).collect()
    }

    /// Says nothing.
    pub fn is_empty(&self) -> bool {
        self.runs.iter().all(|run| run.text.is_empty())
    }
}

impl From<String> for Text {
    fn from(text: String) -> Text {
        Text::plain(text)
    }
}

impl From<&str> for Text {
    fn from(text: &str) -> Text {
        Text::plain(text)
    }
}

impl Note {
    /// A note.
    pub fn new(kind: NoteKind, text: impl Into<Text>) -> Note {
        Note { kind, text: text.into() }
    }
}

impl NoteKind {
    /// The word in front of a note; colour alone is not enough for every reader.
    pub fn as_str(self) -> &'static str {
        match self {
            NoteKind::Remark => "Note",
            NoteKind::Warning => "Warning",
            NoteKind::Error => "Error",
        }
    }
}

impl Table {
    /// A table without rows.
    pub fn new(columns: &[(&str, ColumnKind)]) -> Table {
        let column = |(title, kind): &(&str, ColumnKind)| Column { title: (*title).to_owned(), kind: *kind };
        Table { columns: columns.iter().map(column).collect(), rows: Vec::new() }
    }

    /// Adds a row that no link leads to.
    pub fn row(&mut self, cells: impl IntoIterator<Item = Text>) {
        self.rows.push(Row { anchor: None, kind: RowKind::Plain, cells: cells.into_iter().collect() });
    }

    /// Adds a row with a place.
    pub fn row_at(&mut self, anchor: Anchor, cells: impl IntoIterator<Item = Text>) {
        self.rows.push(Row { anchor: Some(anchor), kind: RowKind::Plain, cells: cells.into_iter().collect() });
    }

    /// Adds a row that heads those after it.
    pub fn group(&mut self, anchor: Anchor, cells: impl IntoIterator<Item = Text>) {
        self.rows.push(Row { anchor: Some(anchor), kind: RowKind::Group, cells: cells.into_iter().collect() });
    }
}

impl<'a> Document<'a> {
    /// A document of sections that are there already.
    pub fn of_sections(title: String, processor: String, sections: Vec<Section<'a>>) -> Document<'a> {
        let tool = concat!("rungs ", env!("CARGO_PKG_VERSION")).to_owned();
        let mut document = Document { title, processor, tool, sections, ..Document::default() };
        document.settle();
        document
    }

    /// Is there such a place?
    pub fn has(&self, anchor: &Anchor) -> bool {
        self.places.contains(anchor)
    }

    /// Where an address written in a rung leads: its cross reference entry, else its row in the data table
    /// or symbol database, else those of the element it lies in.
    pub fn place_of_address(&self, address: &str) -> Option<Anchor> {
        let of = |address: &str| {
            let all = [Anchor::reference(address), Anchor::element(address), Anchor::symbol(address)];
            all.into_iter().find(|anchor| self.has(anchor))
        };
        of(address).or_else(|| of(address.trim_start_matches('#'))).or_else(|| {
            let whole = ladder::Address::parse(address).ok()?.element_address()?;
            of(&whole.to_string())
        })
    }

    /// Sections in runs of one kind, for lists of contents and bookmarks.
    pub fn chapters(&self) -> impl Iterator<Item = &[Section<'a>]> {
        self.sections.chunk_by(|a, b| a.kind == b.kind)
    }

    /// Collects the places, of equal ones the first, and takes out links that lead to none: their section
    /// was not chosen.
    pub(crate) fn settle(&mut self) {
        let mut places = HashSet::new();
        for section in &mut self.sections {
            let mut number = 1;
            while !places.insert(section.anchor.clone()) {
                number += 1;
                section.anchor = Anchor::named(&format!("{}-{number}", section.anchor));
            }
            for block in &mut section.blocks {
                match block {
                    Block::Table(table) => {
                        for row in &mut table.rows {
                            if row.anchor.as_ref().is_some_and(|anchor| !places.insert(anchor.clone())) {
                                row.anchor = None;
                            }
                        }
                    }
                    Block::Rung(rung) => drop(places.insert(rung.anchor.clone())),
                    _ => {}
                }
            }
        }
        let mut unlink = |text: &mut Text| {
            for run in &mut text.runs {
                if run.link.as_ref().is_some_and(|link| !places.contains(link)) {
                    run.link = None;
                }
            }
        };
        self.notes.iter_mut().for_each(|note| unlink(&mut note.text));
        for block in self.sections.iter_mut().flat_map(|section| &mut section.blocks) {
            each_text(block, &mut unlink);
        }
        self.places = places;
    }

    /// How many sections of each kind there are.
    pub fn counts(&self) -> HashMap<Kind, usize> {
        let mut counts = HashMap::new();
        for section in &self.sections {
            *counts.entry(section.kind).or_insert(0) += 1;
        }
        counts
    }
}

fn each_text(block: &mut Block<'_>, each: &mut impl FnMut(&mut Text)) {
    match block {
        Block::Pairs(pairs) => pairs.iter_mut().for_each(|pair| each(&mut pair.value)),
        Block::Table(table) => table.rows.iter_mut().flat_map(|row| &mut row.cells).for_each(each),
        Block::Note(note) => each(&mut note.text),
        Block::Tree(items) => {
            // Call trees are bounded in depth where they are built.
            fn walk(items: &mut [TreeItem], each: &mut impl FnMut(&mut Text)) {
                for item in items {
                    each(&mut item.text);
                    walk(&mut item.items, each);
                }
            }
            walk(items, each);
        }
        Block::Heading(_) | Block::Rung(_) => {}
    }
}
