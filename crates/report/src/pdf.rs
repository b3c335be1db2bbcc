//! A document as a book: pages with heads and numbers, a list of contents, bookmarks, links.
//!
//! The same document and options give the same bytes: no clock, no random identifiers.

mod block;
mod book;
mod columns;
mod contents;
mod file;
mod rung;
mod table;
mod text;

use crate::model::{Block, Document};
use book::Book;

/// Paper.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Paper {
    /// 210 mm by 297 mm.
    #[default]
    A4,
    /// 8.5 inches by 11 inches.
    Letter,
}

/// How the book is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Format {
    /// Size of a page.
    pub paper: Paper,
    /// The longer side lies.
    pub landscape: bool,
    /// Contacts that conduct and coils that are on are highlighted, by the data tables of the project.
    pub state: bool,
}

/// What became of a document.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Pdf {
    /// The file.
    pub bytes: Vec<u8>,
    /// How many pages it has.
    pub pages: usize,
    /// Characters that stand spelled out (`\u{2192}`) because the standard fonts lack them.
    pub escaped: usize,
}

/// Makes a PDF file of a document.
pub fn write(document: &Document<'_>, format: Format) -> Pdf {
    let mut book = Book::new(document, format);
    for chapter in document.chapters() {
        for (index, section) in chapter.iter().enumerate() {
            book.section(section, (chapter.len() > 1).then_some(index));
            for block in &section.blocks {
                match block {
                    Block::Heading(title) => book.heading(title),
                    Block::Pairs(pairs) => book.pairs(pairs),
                    Block::Table(table) => book.table(table),
                    Block::Rung(rung) => book.rung(rung),
                    Block::Note(note) => book.note(note),
                    Block::Tree(items) => book.tree(items),
                }
            }
        }
    }
    file::write(book, format)
}
