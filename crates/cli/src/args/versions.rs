//! What is asked about versions: `diff`, `history`, `git-setup` and what git calls.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

#[derive(Args)]
pub struct DiffArguments {
    /// The old program: a project, SLC text, JSON project or Do-more text; or a folder of projects
    #[arg(value_name = "A")]
    pub old: PathBuf,
    /// The new program, or a folder: its files are found by name, then by content
    #[arg(value_name = "B")]
    pub new: Option<PathBuf>,
    /// Compare the image last exchanged with a processor with the program in the same file
    #[arg(long)]
    pub online: bool,
    /// What counts and is shown; default: everything
    #[arg(long, value_enum, value_delimiter = ',', value_name = "SECTION")]
    pub only: Vec<Section>,
    /// Unified text for reviews: rungs as text (of SLC or of Do-more) with their neighbours, then the other sections
    #[arg(long, conflicts_with_all = ["two_sided", "json"])]
    pub unified: bool,
    /// Write a page with the rungs drawn side by side instead; for two folders a folder of pages with a list
    #[arg(long, value_name = "OUT", conflicts_with_all = ["json", "unified", "two_sided"])]
    pub html: Option<PathBuf>,
    /// With --html: overwrite pages that exist
    #[arg(long, requires = "html")]
    pub force: bool,
    /// Rungs drawn side by side, whatever the width
    #[arg(long)]
    pub two_sided: bool,
    /// Columns; default: the terminal's width, 100 in a pipe
    #[arg(long)]
    pub width: Option<usize>,
    /// Strict reading: the first deviation from the format is an error
    #[arg(long)]
    pub strict: bool,
    /// JSON, one document per line and pair of files
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct HistoryArguments {
    /// Saves, or folders of saves
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Only machines whose name or one of whose files contains this text
    #[arg(long, value_name = "TEXT")]
    pub machine: Option<String>,
    /// Every change; default: the first few of each section
    #[arg(long)]
    pub full: bool,
    /// Write the history as a new git repository into this folder, which must not exist or be empty
    #[arg(long, value_name = "DIR")]
    pub to_git: Option<PathBuf>,
    /// Strict reading: the first deviation from the format is an error
    #[arg(long)]
    pub strict: bool,
    /// JSON, one document per line and machine
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct GitSetupArguments {
    /// For all repositories of this user, not for this one alone
    #[arg(long)]
    pub global: bool,
    /// The merge driver too: rungs, documentation and data tables are merged, conflicts marked in SLC text
    #[arg(long)]
    pub merge: bool,
    /// Take everything out again
    #[arg(long, conflicts_with = "merge")]
    pub remove: bool,
    /// Where git finds rungs; default: this program
    #[arg(long, value_name = "PATH")]
    pub program: Option<PathBuf>,
}

#[derive(Args)]
pub struct MergeArguments {
    /// What both were made of
    #[arg(value_name = "BASE")]
    pub base: PathBuf,
    /// The save to merge into; the result replaces it
    #[arg(value_name = "OURS")]
    pub ours: PathBuf,
    /// The save to merge
    #[arg(value_name = "THEIRS")]
    pub theirs: PathBuf,
    /// The project's path: for messages, and for the conflict file beside it
    #[arg(value_name = "NAME")]
    pub path: String,
}

#[derive(Args)]
pub struct TextconvArguments {
    /// The form of the text that is meant: git keeps texts by the command that made them
    #[arg(long, value_name = "N")]
    pub form: Option<u32>,
    /// A project
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
}

/// A part of a comparison.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Section {
    /// Rungs and program files
    Logic,
    /// Symbols, descriptions, comments, page titles
    Documentation,
    /// Contents of data files, and forces
    Values,
    /// Processor, I/O, channels, shape of data files, names of program files
    Configuration,
}
