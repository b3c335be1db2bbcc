//! What `report`, `export` and `build` are asked.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::*;

#[derive(Args)]
pub struct ReportArguments {
    /// Projects or folders of projects
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// File to write: a page (.html) or a book to print (.pdf); with several projects or a folder: the folder that gets a file each and index.html
    #[arg(short, long, value_name = "PATH")]
    pub out: PathBuf,
    /// What to write where --out has no ending that tells it
    #[arg(long, value_enum, value_name = "FORM")]
    pub to: Option<Medium>,
    /// Paper of a PDF; default: A4
    #[arg(long, value_enum, value_name = "SIZE")]
    pub paper: Option<Paper>,
    /// The longer side of a PDF's paper lies: wide rungs stay in one line
    #[arg(long)]
    pub landscape: bool,
    /// Only these sections, separated by commas; names below
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub sections: Vec<String>,
    /// All sections but these
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub without: Vec<String>,
    /// A date to show; none is taken from the clock, so that equal projects give equal reports
    #[arg(long, value_name = "TEXT")]
    pub date: Option<String>,
    /// Overwrite files that exist
    #[arg(long)]
    pub force: bool,
    /// Strict reading: the first deviation from the format is an error
    #[arg(long)]
    pub strict: bool,
    /// Which copy of the program
    #[arg(long, value_enum, default_value_t)]
    pub image: ImageChoice,
}

/// Forms of a report.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Medium {
    /// One page with search, that needs no network
    Html,
    /// A book with contents, page numbers and bookmarks
    Pdf,
}

/// Sizes of paper.
#[derive(Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum Paper {
    /// 210 mm by 297 mm
    #[default]
    A4,
    /// 8.5 inches by 11 inches
    Letter,
}

impl From<Paper> for report::pdf::Paper {
    fn from(paper: Paper) -> Self {
        match paper {
            Paper::A4 => report::pdf::Paper::A4,
            Paper::Letter => report::pdf::Paper::Letter,
        }
    }
}

/// The sections of a report by name, with an example.
pub(super) fn sections_help() -> String {
    let mut text = String::from(
        "Example: rungs report conveyor.RSS --out conveyor.html\n         rungs report plant/ --out reports\n         \
         rungs report conveyor.RSS --out conveyor.pdf --paper letter\n         \
         rungs report conveyor.RSS --out io.html --sections io,io-map,timers\n\nSections, in their order:\n",
    );
    for kind in report::Kind::all() {
        text.push_str(&format!("  {:<22}{}\n", kind.name(), kind.help()));
    }
    text
}

#[derive(Args)]
pub struct ExportArguments {
    /// Projects or folders of projects
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Form to write
    #[arg(long, value_enum, value_name = "FORM")]
    pub to: Form,
    /// With --to csv: which table
    #[arg(long, value_enum, default_value_t)]
    pub table: Table,
    /// File to write; a folder when several projects are exported, which gets the subfolders they come from; with --to svg and several rungs a folder, made if it does not exist. Default: standard output, where each of several JSON projects is one line
    #[arg(short, long, visible_alias = "out")]
    pub output: Option<PathBuf>,
    /// Overwrite files that exist
    #[arg(long)]
    pub force: bool,
    /// With --to pdf: paper; default: A4
    #[arg(long, value_enum, value_name = "SIZE")]
    pub paper: Option<Paper>,
    /// With --to pdf: the longer side of the paper lies
    #[arg(long)]
    pub landscape: bool,
    /// With --to svg, html and pdf: only these program files
    #[arg(long = "file", value_name = "N")]
    pub program_files: Vec<u16>,
    /// With --to svg, html and pdf: only these code blocks of a Do-more project
    #[arg(long = "block", value_name = "NAME")]
    pub blocks: Vec<String>,
    /// With --to svg, html and pdf: only this rung or range of rungs: 4, 4..7, 4.., ..7 (both ends included)
    #[arg(long, value_name = "A[..B]")]
    pub rung: Option<RungRange>,
    /// With --to svg and html: columns to draw in, from 60 to 400; a column is 8 pixels wide
    #[arg(long, default_value_t = 120)]
    pub width: usize,
    /// With --to svg, html and pdf: highlight contacts that conduct and coils that are on, by the data tables of the image
    #[arg(long)]
    pub state: bool,
    /// Strict reading: the first deviation from the format is an error
    #[arg(long)]
    pub strict: bool,
    /// Which copy of the program (json always holds all)
    #[arg(long, value_enum, default_value_t)]
    pub image: ImageChoice,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Form {
    /// Project as JSON (schema rungs.project/1; of a Do-more project rungs.domore/1)
    Json,
    /// SLC text, RSLogix 500's own text form
    Slc,
    /// A table, see --table
    Csv,
    /// Text for Do-more Designer, of a Do-more project
    Domore,
    /// Every rung drawn, a file each
    Svg,
    /// The ladder drawn, as one page that needs no network
    Html,
    /// The ladder drawn, as pages to print; `rungs report` has the whole project
    Pdf,
}

#[derive(Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum Table {
    /// Addresses with symbol and description
    #[default]
    Symbols,
    /// Timers and counters
    Timers,
    /// Cross reference
    Xref,
}

#[derive(Args)]
pub struct BuildArguments {
    /// SLC text (.SLC) or JSON project
    #[arg(value_name = "TEXT")]
    pub text: PathBuf,
    /// Symbols and descriptions, as `rungs export --to csv` writes them; default: TEXT with the ending .csv, if there is one
    #[arg(long, value_name = "FILE.csv")]
    pub symbols: Option<PathBuf>,
    /// Project to write
    #[arg(short, long, value_name = "FILE.RSS")]
    pub output: PathBuf,
    /// Overwrite the output if it exists
    #[arg(long)]
    pub force: bool,
}
