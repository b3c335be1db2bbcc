//! What RSLogix 500 printed of a project, read from the text of its PDF reports.
//!
//! The input is the output of `pdftotext -layout`: one page after the other,
//! parted by form feeds, with columns kept by spaces. On ladder pages the drawn
//! lines are lost there; [`crate::drawing`] reads those from the PDF itself.
//! Every line is either taken into a field or listed in [`Printout::unexplained`].

mod channels;
mod database;
mod ladder;
mod lists;
mod page;
mod pairing;
mod processor;
mod row;
mod tags;
mod values;

pub use channels::{Channel, Setting};
pub use database::{CommentRow, GroupRow, SymbolRow};
pub use ladder::{LadderFile, Rung};
pub use lists::{DataFileRow, ProgramFileRow};
pub use page::Page;
pub use pairing::{Candidate, candidates};
pub use processor::{IoRow, Processor};
pub use row::{Cell, cells};
pub use tags::{TagRow, parse_tags};
pub use values::{DataValues, StatusField, Value, ValueRow};

/// One report, each part `None` or empty where the report was printed without it.
#[derive(Debug, Clone, Default)]
pub struct Printout {
    /// The name in the page head, as printed: a file name in upper case with or
    /// without `.RSS`, or the project's own title.
    pub name: String,
    /// The date and time of the first page, as printed.
    pub printed: String,
    /// Number of pages with content.
    pub pages: usize,
    /// "Processor Information".
    pub processor: Option<Processor>,
    /// "I/O Configuration", one row per slot.
    pub io: Option<Vec<IoRow>>,
    /// "Channel Configuration".
    pub channels: Vec<Channel>,
    /// "Program File List".
    pub program_files: Option<Vec<ProgramFileRow>>,
    /// "Data File List".
    pub data_files: Option<Vec<DataFileRow>>,
    /// The ladder pages, one entry per program file in printed order.
    pub ladder: Vec<LadderFile>,
    /// The data pages, one entry per data file in printed order.
    pub values: Vec<DataValues>,
    /// "Address/Symbol Database".
    pub symbols: Option<Vec<SymbolRow>>,
    /// "Instruction Comment Database".
    pub instruction_comments: Option<Vec<CommentRow>>,
    /// "Symbol Group Database".
    pub symbol_groups: Option<Vec<GroupRow>>,
    /// Lines that no part claimed, with the page they stand on.
    pub unexplained: Vec<Unexplained>,
}

/// A printed line that the parser could not place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unexplained {
    /// Page of the text, counted from 0.
    pub page: usize,
    /// The line as it stands in the text.
    pub line: String,
}

/// Reads a whole report.
#[must_use]
pub fn parse(text: &str) -> Printout {
    let mut report = Printout::default();
    for page in page::pages(text) {
        report.pages += 1;
        if report.name.is_empty() {
            report.name.clone_from(&page.name);
        }
        if report.printed.is_empty() {
            report.printed.clone_from(&page.printed);
        }
        let lost = place(&mut report, &page);
        let number = page.number;
        report.unexplained.extend(lost.into_iter().map(|line| Unexplained { page: number, line }));
    }
    report
}

/// Hands a page to the part named by its title; gives back what was not understood.
fn place(report: &mut Printout, page: &Page) -> Vec<String> {
    let title = page.title.as_str();
    match title {
        "" if page.lines.is_empty() => Vec::new(),
        "Processor Information" => processor::read(report.processor.get_or_insert_default(), page),
        "I/O Configuration" => processor::read_io(report.io.get_or_insert_default(), page),
        "Channel Configuration" => channels::read(&mut report.channels, page),
        "Program File List" => lists::read_programs(report.program_files.get_or_insert_default(), page),
        "Data File List" => lists::read_data(report.data_files.get_or_insert_default(), page),
        "Address/Symbol Database" => database::read_symbols(report.symbols.get_or_insert_default(), page),
        "Instruction Comment Database" => {
            database::read_comments(report.instruction_comments.get_or_insert_default(), page)
        }
        "Symbol Group Database" => database::read_groups(report.symbol_groups.get_or_insert_default(), page),
        _ if title.starts_with("LAD ") => ladder::read(&mut report.ladder, page),
        _ if title.starts_with("Data File ") => values::read(&mut report.values, page),
        _ => std::iter::once(title.to_owned()).chain(page.lines.iter().cloned()).collect(),
    }
}
