//! A whole project as a document: the sections people know from paper, and what paper lacks.
//!
//! [`project`] and [`domore_project`] build a [`Document`] once; painters make a page or a book of it.
//! This crate reads no files, knows no network and no clock: the same project and options give the same
//! document, byte for byte.
//!
//! ```
//! use report::{Options, Selection};
//!
//! let project = ladder::Project::default();
//! let options = Options { sections: Selection::parse("program-files,coverage", "").unwrap(), ..Options::default() };
//! let document = report::project(&report::Source::of(&project), &options);
//! let titles: Vec<_> = document.sections.iter().map(|section| section.title.as_str()).collect();
//! assert_eq!(titles, ["Program File List", "Documentation Coverage"]);
//! ```

pub mod anchor;
pub mod diff;
mod domore;
pub mod html;
pub mod model;
mod options;
mod page;
pub mod pdf;
mod rslogix;
pub mod words;

pub use anchor::Anchor;
pub use domore::{DomoreSource, domore_project};
pub use model::{
    Block, Column, ColumnKind, Document, Note, NoteKind, Pair, Row, RowKind, Run, Rung, Section, Table, Text, TreeItem,
};
pub use options::{Kind, Options, Selection};
pub use rslogix::{Source, project};
