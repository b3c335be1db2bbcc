//! The command line: every command, its arguments and an example.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Parser, Subcommand, ValueEnum};
use sim::Choices;
use sim::choices::Choice;

/// Opens RSLogix 500 projects (SLC 500, MicroLogix) without the vendor's software.
#[derive(Parser)]
#[command(
    name = "rungs",
    version,
    max_term_width = 100,
    after_help = "Exit codes: 0 done, 1 a difference or finding, 2 bad use or output that cannot be written, 3 unreadable input.\n\
                  Several files or folders are worked through in order; one that cannot be read is reported and the rest goes on.\n\n\
                  Example: rungs show conveyor.RSS --file 2"
)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    /// What a project is: processor, versions, I/O, channels, files, memory, documentation
    #[command(after_help = "Example: rungs info conveyor.RSS\n         rungs info --json plant/ > inventory.jsonl")]
    Info(InfoArguments),
    /// The ladder, drawn in the terminal with symbols, descriptions and comments
    #[command(after_help = "Example: rungs show conveyor.RSS --file 2 --rung 4..7\n         \
                            rungs show conveyor.RSS --width 120 | less")]
    Show(ShowArguments),
    /// Data tables as the engineer knows them
    #[command(after_help = "Example: rungs data conveyor.RSS\n         rungs data conveyor.RSS N7 T4:0 --radix hex")]
    Data(DataArguments),
    /// Every timer and counter: parameters, seconds, live values, who starts, reads and resets it
    #[command(after_help = "Example: rungs timers conveyor.RSS\n         rungs timers conveyor.RSS T4:0 --json")]
    Timers(AddressArguments),
    /// Cross reference: who reads and who writes, word, file, indexed and indirect access included
    #[command(after_help = "Example: rungs xref conveyor.RSS O:2/5\n         rungs xref conveyor.RSS --findings")]
    Xref(XrefArguments),
    /// What an experienced engineer would question: findings with codes and the rung drawn
    #[command(
        after_help = "Example: rungs check conveyor.RSS\n         rungs check plant/ --level warning --no-draw\n         \
                            rungs check conveyor.RSS --only OUT01,TIM\n         rungs check --explain OUT01\n\n\
                            Exit code 0: no finding at error level; 1: at least one; 2: bad use; 3: unreadable. All checks, rules and \
                            comments that take findings out: docs/checks.md."
    )]
    Check(CheckArguments),
    /// Search: address, symbol, text, instruction with wildcards, regular expression; rungs drawn
    #[command(
        after_help = "Example: rungs search O:2/5 conveyor.RSS\n         rungs search 'TON * 0.01 >=500 *' plant/\n         \
                            rungs search 'jam detected' conveyor.RSS\n         rungs search --regex '^XI[CO] B3:' conveyor.RSS\n\n\
                            A mnemonic first makes it a pattern: one word per operand, * and ? for any characters, >= <= > < = != for \
                            numbers, operands left out can be anything. Exit code 0: found; 1: not found; 2: bad use; 3: unreadable."
    )]
    Search(SearchArguments),
    /// Lossless check: bytes understood, byte-identical rewrite, compiled code agrees with operands
    #[command(after_help = "Example: rungs verify conveyor.RSS\n         rungs verify --json archive/ > verify.jsonl")]
    Verify(VerifyArguments),
    /// Files for other tools and people: JSON project, SLC text, CSV tables, drawings
    #[command(after_help = "Example: rungs export conveyor.RSS --to json -o conveyor.json\n         \
                            rungs export conveyor.RSS --to csv --table timers\n         \
                            rungs export conveyor.RSS --to svg --file 2 --rung 4 --out rung4.svg\n         \
                            rungs export conveyor.RSS --to html --out ladder.html")]
    Export(ExportArguments),
    /// SLC text or JSON project to a complete .RSS with code, data tables and documentation
    #[command(
        after_help = "Whether RSLogix 500 opens a project written by this command is UNTESTED: no copy of it was \
                            available. What is checked is that the file reads back equal here and that code generated from \
                            text equals the code RSLogix stored in every known project. Do not load it into a controller \
                            that matters without checking it in RSLogix 500 first.\n\n\
                            Example: rungs build conveyor.SLC -o conveyor.RSS"
    )]
    Build(BuildArguments),
    /// Runs a program in simulated time and prints how chosen addresses and rungs change
    #[command(after_help = "Example: rungs run conveyor.RSS --for 10s --set I:1/0=1 --watch O:2/5 T4:0\n         \
                            rungs run conveyor.RSS --for 2s --watch T4:0.ACC --format vcd -o trace.vcd\n         \
                            rungs run conveyor.RSS --for 100ms --trace-rung 2:4\n\n\
                            The first scan after entering run has no time before it; every later one comes --scan after the last.")]
    Run(RunArguments),
    /// Measures how fast a program runs here: instructions per scan, scans per second, time per instruction
    #[command(
        after_help = "Example: rungs bench conveyor.RSS\n         rungs bench conveyor.RSS --scans 100000 --json\n\n\
                            Inputs are at rest. Only the simulator is measured: a scan here has nothing to do with the scan time \
                            of the controller. Exit code 1: the program stopped by a fault, or is refused."
    )]
    Bench(BenchArguments),
    /// Watch, force and step a program in the browser
    ///
    /// A web server for this computer alone: it listens on the loopback address, its pages load nothing from elsewhere,
    /// and the program does not leave the machine. Other addresses must be asked for and then need the token that is
    /// printed.
    #[command(after_help = "Example: rungs serve conveyor.RSS --open\n         \
        rungs serve conveyor.RSS --plant conveyor_plant.toml --port 8600\n         \
        rungs serve conveyor.RSS out/conveyor.txt --map out/address-map.csv\n         \
        rungs serve conveyor.RSS out/conveyor.txt --map out/address-map.csv --replay proof/original.toml\n\n\
        Exit code 0: served until it was ended; 1: a program that cannot be run; 2: bad use; 3: unreadable. See docs/workbench.md.")]
    Serve(ServeArguments),
    /// Runs scenarios (TOML) and reports every expectation that is not met
    #[command(after_help = "Example: rungs test scenarios/\n         rungs test flash.toml --junit result.xml\n\n\
                            Exit code 0: all met; 1: an expectation not met or a program refused; 3: a scenario or program that cannot be read.")]
    Test(TestArguments),
    /// Converts a program for another controller: text to import, address map, report per rung
    #[command(after_help = "Whether Do-more Designer imports what this command writes is UNTESTED: no copy of it was \
                            available. The report's first lines list every form that no export of Designer shows. Test \
                            without machinery before use.\n\n\
                            Example: rungs migrate conveyor.RSS --to domore --out conveyor_domore\n         \
                            rungs migrate conveyor.RSS --to domore --out again --map conveyor_domore/address-map.csv --prove\n\n\
                            Exit code 0: every rung converted; 1: rungs need a person, or a proof found a difference; 2: bad use; \
                            3: unreadable. See docs/migration.md.")]
    Migrate(MigrateArguments),
    /// Runs two programs side by side with the same inputs and compares them after every scan
    #[command(
        after_help = "Example: rungs prove conveyor.RSS out/conveyor.txt --map out/map.csv --out proof\n         \
                            rungs prove conveyor_old.RSS conveyor.RSS --scans 1000000\n\n\
                            Exit code 0: no difference found within the coverage reported; 1: different, or not comparable in whole or \
                            in part; 2: bad use; 3: a program or map that cannot be read. See docs/proof.md for what a verdict means."
    )]
    Prove(ProveArguments),
    /// The whole project as a document with every section of the vendor's report: an HTML page with search and links, or a PDF
    #[command(after_help = sections_help())]
    Report(ReportArguments),
    /// What changed between two programs, rung by rung; documentation, values and configuration apart
    #[command(
        after_help = "Example: rungs diff conveyor_old.RSS conveyor.RSS\n         rungs diff conveyor.RSS --online\n         \
                            rungs diff archive/2023 archive/2024 --only logic --json\n         \
                            rungs diff conveyor_old.RSS conveyor.RSS --html diff.html\n\n\
                            Exit code 0: equal in what --only names; 1: a difference; 2: bad use; 3: unreadable."
    )]
    Diff(DiffArguments),
    /// The saves of a machine in order, and what changed from each to the next; as a git repository too
    #[command(after_help = "Example: rungs history archive/\n         rungs history archive/ --full | less\n         \
                            rungs history archive/ --to-git archive.git\n\n\
                            Saves are put together by name, processor, program ID, creation and content, and in order by the save time \
                            in the file; what each place rests on is told. Exit code 0: done; 2: bad use; 3: a file is unreadable. See \
                            docs/history.md.")]
    History(HistoryArguments),
    /// Lets git show rungs in diff, log and show, and merge projects
    #[command(
        after_help = "Example: rungs git-setup --merge\n         rungs git-setup --global\n         rungs git-setup --remove\n\n\
                            Run inside a repository, or with --global for all of yours. It can be run again at any time. See docs/history.md."
    )]
    GitSetup(GitSetupArguments),
    /// Merges two saves of a project that were made of one; what git-setup --merge lets git call
    #[command(after_help = "Example: rungs merge-driver base.RSS ours.RSS theirs.RSS conveyor.RSS\n\n\
                            A merge without conflicts is written to OURS. Exit code 0: merged; 1: a person must decide, OURS is unchanged \
                            and NAME.conflict.slc has both sides; 2: bad use. See docs/history.md.")]
    MergeDriver(MergeArguments),
    /// The text of a project that git compares
    #[command(hide = true, after_help = "Example: rungs textconv conveyor.RSS")]
    Textconv(TextconvArguments),
}

/// Which copy of the program a project holds to work on.
#[derive(Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum ImageChoice {
    /// The program an engineer opens
    #[default]
    Main,
    /// The image last exchanged with a processor
    Online,
    /// The automatic save
    Autosave,
}

impl ImageChoice {
    /// The image, if the project holds it.
    pub fn of(self, project: &ladder::Project) -> Option<&ladder::Image> {
        match self {
            ImageChoice::Main => Some(&project.main),
            ImageChoice::Online => project.online.as_ref(),
            ImageChoice::Autosave => project.autosave.as_ref(),
        }
    }
}

#[derive(Args)]
pub struct Input {
    /// Strict reading: the first deviation from the format is an error
    #[arg(long)]
    pub strict: bool,
    /// Which copy of the program
    #[arg(long, value_enum, default_value_t)]
    pub image: ImageChoice,
    /// JSON, one document per line and file
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct InfoArguments {
    /// Projects or folders of projects
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    #[command(flatten)]
    pub input: Input,
}

#[derive(Args)]
pub struct ShowArguments {
    /// Projects or folders of projects
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Only these program files
    #[arg(long = "file", value_name = "N")]
    pub program_files: Vec<u16>,
    /// Only these code blocks of a Do-more project
    #[arg(long = "block", value_name = "NAME")]
    pub blocks: Vec<String>,
    /// Only this rung or range of rungs: 4, 4..7, 4.., ..7 (both ends included)
    #[arg(long, value_name = "A[..B]")]
    pub rung: Option<RungRange>,
    /// Columns to draw in, at least 60; default: the terminal's width, 100 in a pipe
    #[arg(long)]
    pub width: Option<usize>,
    /// Plain ASCII instead of box-drawing characters
    #[arg(long)]
    pub ascii: bool,
    /// Mark contacts that conduct and coils that are on with T, by the data tables of the image
    #[arg(long)]
    pub state: bool,
    #[command(flatten)]
    pub input: Input,
}

#[derive(Args)]
pub struct DataArguments {
    /// A project, then data files (N7), elements (T4:0) or symbols; paths that exist are read as further projects
    #[arg(required = true, value_name = "FILE [ADDRESS]")]
    pub files: Vec<String>,
    /// How words are written
    #[arg(long, value_enum)]
    pub radix: Option<Radix>,
    #[command(flatten)]
    pub input: Input,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Radix {
    /// Signed decimal
    Dec,
    /// Hexadecimal
    Hex,
    /// Sixteen bits
    Bin,
    /// Octal
    Oct,
    /// Two characters
    Ascii,
}

impl From<Radix> for ladder::Radix {
    fn from(radix: Radix) -> ladder::Radix {
        match radix {
            Radix::Dec => ladder::Radix::Decimal,
            Radix::Hex => ladder::Radix::Hexadecimal,
            Radix::Bin => ladder::Radix::Binary,
            Radix::Oct => ladder::Radix::Octal,
            Radix::Ascii => ladder::Radix::Ascii,
        }
    }
}

#[derive(Args)]
pub struct AddressArguments {
    /// A project, then addresses or symbols; paths that exist are read as further projects
    #[arg(required = true, value_name = "FILE [ADDRESS]")]
    pub files: Vec<String>,
    #[command(flatten)]
    pub input: Input,
}

#[derive(Args)]
pub struct XrefArguments {
    /// A project, then addresses or symbols; paths that exist are read as further projects
    #[arg(required = true, value_name = "FILE [ADDRESS]")]
    pub files: Vec<String>,
    /// Only what deserves a look: written never read, read never written, used but undocumented, beyond a file's end
    #[arg(long)]
    pub findings: bool,
    #[command(flatten)]
    pub input: Input,
}

#[derive(Args)]
pub struct CheckArguments {
    /// Projects or folders of projects
    #[arg(required_unless_present = "explain", value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Only these checks, those that are off included: codes (OUT01) or subjects (OUT)
    #[arg(long, value_name = "CODES", value_delimiter = ',')]
    pub only: Vec<String>,
    /// Without these checks
    #[arg(long, value_name = "CODES", value_delimiter = ',')]
    pub skip: Vec<String>,
    /// Findings of this level and above
    #[arg(long, value_enum, default_value_t)]
    pub level: CheckLevel,
    /// File of rules that take findings out, besides .rungs-check.toml beside each project
    #[arg(long, value_name = "FILE")]
    pub suppress: Option<PathBuf>,
    /// Do not draw rungs
    #[arg(long)]
    pub no_draw: bool,
    /// Explain a check and do nothing else
    #[arg(long, value_name = "CODE")]
    pub explain: Option<String>,
    #[command(flatten)]
    pub input: Input,
}

#[derive(Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum CheckLevel {
    /// It cannot work so
    Error,
    /// Often wrong
    Warning,
    /// Worth knowing
    #[default]
    Note,
}

#[derive(Args)]
pub struct SearchArguments {
    /// What to search for
    #[arg(value_name = "PATTERN")]
    pub pattern: String,
    /// Projects or folders of projects
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// The pattern is a regular expression, over instructions, symbols, descriptions and comments
    #[arg(long)]
    pub regex: bool,
    /// Do not draw rungs
    #[arg(long)]
    pub no_draw: bool,
    #[command(flatten)]
    pub input: Input,
}

#[derive(Args)]
pub struct VerifyArguments {
    /// Projects or folders of projects
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Strict reading: the first deviation from the format is an error
    #[arg(long)]
    pub strict: bool,
    /// JSON, one document per line and file
    #[arg(long)]
    pub json: bool,
}

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
fn sections_help() -> String {
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

#[derive(Args)]
pub struct RunArguments {
    /// A project, SLC text or JSON project
    #[arg(value_name = "FILE")]
    pub program: PathBuf,
    /// Simulated time to run
    #[arg(long = "for", value_name = "TIME", default_value = "10s", value_parser = sim::scenario::parse_duration)]
    pub duration: Duration,
    /// Simulated time from one scan to the next
    #[arg(long, value_name = "TIME", default_value = "10ms", value_parser = sim::scenario::parse_duration)]
    pub scan: Duration,
    /// Value to write before the first scan, or from a time on: B3:0/0=1, I:1/3=1@2s, N7:0=0xFF
    #[arg(long, value_name = "ADDR=VALUE[@TIME]", num_args = 1..)]
    pub set: Vec<String>,
    /// Addresses or symbols to follow; a whole timer, counter or control element stands for all its members
    #[arg(long, value_name = "ADDR", num_args = 1..)]
    pub watch: Vec<String>,
    /// Rungs whose power flow to follow: 4, or 3:4 for rung 4 of program file 3
    #[arg(long, value_name = "[FILE:]RUNG", num_args = 1..)]
    pub trace_rung: Vec<String>,
    /// How to write the trace: table shows the scans in which something changed, csv and json every scan
    #[arg(long, value_enum, default_value_t)]
    pub format: TraceForm,
    /// File to write the trace to. Default: standard output
    #[arg(short, long)]
    pub output: Option<PathBuf>,
    /// Overwrite the output if it exists
    #[arg(long)]
    pub force: bool,
    /// Load a program that holds instructions which cannot be simulated; executing one is major fault 0031
    #[arg(long)]
    pub accept_unsupported: bool,
    #[command(flatten)]
    pub simulation: Simulation,
    /// Which copy of the program
    #[arg(long, value_enum, default_value_t)]
    pub image: ImageChoice,
}

#[derive(Args)]
pub struct ServeArguments {
    /// A project, SLC text, JSON project or Do-more text
    #[arg(value_name = "FILE")]
    pub program: PathBuf,
    /// What was made of it, or another version of it: both run side by side with the same inputs
    #[arg(value_name = "OTHER")]
    pub other: Option<PathBuf>,
    /// With OTHER: the address map `rungs migrate` wrote. Needed unless both are SLC programs: then every address means
    /// itself
    #[arg(long, value_name = "CSV", requires = "other")]
    pub map: Option<PathBuf>,
    /// Step through this scenario: a counterexample of `rungs prove`, a recording
    #[arg(long, value_name = "TOML")]
    pub replay: Option<PathBuf>,
    /// Port; 0 takes one that is free
    #[arg(long, value_name = "N", default_value_t = 8500)]
    pub port: u16,
    /// Address to listen on; others than loopback need the token that is printed then
    #[arg(long, value_name = "IP", default_value = "127.0.0.1")]
    pub address: std::net::IpAddr,
    /// Open the page in the browser
    #[arg(long)]
    pub open: bool,
    /// Nothing can be changed by those who look
    #[arg(long)]
    pub read_only: bool,
    /// Wire the controller to this plant model
    #[arg(long, value_name = "TOML")]
    pub plant: Option<PathBuf>,
    /// Load a program that holds instructions which cannot be simulated; executing one is major fault 0031
    #[arg(long)]
    pub accept_unsupported: bool,
    #[command(flatten)]
    pub simulation: Simulation,
}

#[derive(Args)]
pub struct BenchArguments {
    /// A project, SLC text, JSON project or Do-more text
    #[arg(value_name = "FILE")]
    pub program: PathBuf,
    /// Scans to run. Default: as many as take a second
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    pub scans: Option<u64>,
    /// Simulated time from one scan to the next
    #[arg(long, value_name = "TIME", default_value = "10ms", value_parser = sim::scenario::parse_duration)]
    pub scan: Duration,
    /// JSON
    #[arg(long)]
    pub json: bool,
    /// Load a program that holds instructions which cannot be simulated; executing one is major fault 0031
    #[arg(long)]
    pub accept_unsupported: bool,
    #[command(flatten)]
    pub simulation: Simulation,
    /// Which copy of the program
    #[arg(long, value_enum, default_value_t)]
    pub image: ImageChoice,
}

#[derive(Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum TraceForm {
    /// Columns for reading
    #[default]
    Table,
    /// Comma-separated values
    Csv,
    /// One JSON document per scan
    Json,
    /// Value change dump, for waveform viewers such as GTKWave
    Vcd,
}

#[derive(Args)]
pub struct TestArguments {
    /// Scenarios or folders of scenarios (*.toml)
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Write the results as JUnit XML too
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
    /// Print only what failed, and the sum
    #[arg(short, long)]
    pub quiet: bool,
    /// JSON, one document per line and scenario
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub simulation: Simulation,
}

#[derive(Args)]
pub struct ProveArguments {
    /// The original: a project, SLC text or JSON project
    #[arg(value_name = "A")]
    pub original: PathBuf,
    /// The other program: Do-more text, or another project or SLC text
    #[arg(value_name = "B")]
    pub other: PathBuf,
    /// The address map `rungs migrate` wrote; between two SLC programs every address means itself without one
    #[arg(long, value_name = "MAP")]
    pub map: Option<PathBuf>,
    /// Compare Do-more text whose rungs do not say which one of the original they were made from (`SLC 2:0`): a
    /// rung that went missing then shows in behaviour only
    #[arg(long)]
    pub no_marks: bool,
    /// Scans of both programs
    #[arg(long, value_name = "N", default_value_t = 100_000)]
    pub scans: u64,
    /// Start of the random sequence: the same seed gives the same run
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub seed: u64,
    /// End the run after so many seconds, whatever is left of the scans; the report says how many were made
    #[arg(long, value_name = "N", value_parser = seconds)]
    pub seconds: Option<Duration>,
    /// Folder for the report and, if the programs differ, for a scenario of each; those of an earlier run are replaced
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// JSON on one line
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub simulation: Simulation,
}

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

#[derive(Args)]
pub struct MigrateArguments {
    /// A project, SLC text or JSON project
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The controller family to convert to
    #[arg(long, value_enum, value_name = "FAMILY")]
    pub to: Family,
    /// Folder to write to; made if it does not exist
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// An address map written before and edited: its choices are kept
    #[arg(long, value_name = "MAP")]
    pub map: Option<PathBuf>,
    /// Use no text form that is only inferred; rungs that need one are left to a person. Forms known from help
    /// topics or a public generator of such texts remain, and the report lists them
    #[arg(long)]
    pub only_confirmed: bool,
    /// Run both programs side by side afterwards, see `rungs prove`
    #[arg(long)]
    pub prove: bool,
    /// With --prove: scans of both programs
    #[arg(long, value_name = "N", default_value_t = 100_000)]
    pub scans: u64,
    /// With --prove: start of the random sequence
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub seed: u64,
    /// With --prove: end the run after so many seconds
    #[arg(long, value_name = "N", value_parser = seconds)]
    pub seconds: Option<Duration>,
    /// Replace files that exist in the folder
    #[arg(long, visible_alias = "force")]
    pub overwrite: bool,
    /// Strict reading: the first deviation from the format is an error
    #[arg(long)]
    pub strict: bool,
    /// Which copy of the program
    #[arg(long, value_enum, default_value_t)]
    pub image: ImageChoice,
    /// JSON on one line
    #[arg(long)]
    pub json: bool,
}

/// What a program is converted to.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Family {
    /// AutomationDirect Do-more and BRX, as text for Do-more Designer
    Domore,
}

#[derive(Args)]
pub struct Simulation {
    /// Take the other reading of an open question, see docs/semantics-choices.md
    #[arg(long = "choice", value_name = "NAME", value_parser = choice)]
    pub choices: Vec<AnyChoice>,
}

/// The other reading of an open question, of either dialect.
#[derive(Clone, Copy)]
pub enum AnyChoice {
    /// Of SLC 500 and MicroLogix.
    Slc(Choice),
    /// Of Do-more.
    DoMore(domore::choices::Choice),
}

impl Simulation {
    /// All answers about SLC 500 and MicroLogix together.
    pub fn choices(&self) -> Choices {
        self.choices.iter().fold(Choices::default(), |all, choice| match choice {
            AnyChoice::Slc(choice) => all.with(*choice),
            AnyChoice::DoMore(_) => all,
        })
    }

    /// All answers about Do-more together.
    pub fn do_more(&self) -> domore::choices::Choices {
        self.choices.iter().fold(Default::default(), |all: domore::choices::Choices, choice| match choice {
            AnyChoice::DoMore(choice) => all.with(*choice),
            AnyChoice::Slc(_) => all,
        })
    }
}

fn choice(name: &str) -> Result<AnyChoice, String> {
    let do_more = domore::choices::LIST.iter().find(|row| row.name == name).map(|row| AnyChoice::DoMore(row.choice));
    let slc = Choices::by_name(name).map(AnyChoice::Slc);
    slc.or(do_more).ok_or_else(|| {
        let names = sim::choices::LIST.iter().map(|row| row.name);
        let names: Vec<_> = names.chain(domore::choices::LIST.iter().map(|row| row.name)).collect();
        format!("expected one of {}", names.join(", "))
    })
}

/// Seconds of a person's time, with a fraction if need be.
fn seconds(text: &str) -> Result<Duration, String> {
    let number = text.trim_end_matches('s').parse::<f64>().ok();
    let time = number.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    time.ok_or_else(|| "expected seconds, such as 60 or 0.5".to_owned())
}

/// Rung numbers, both ends included.
#[derive(Clone, Copy)]
pub struct RungRange {
    pub first: usize,
    pub last: usize,
}

impl RungRange {
    /// Whether a rung is in it.
    pub fn holds(self, number: usize) -> bool {
        (self.first..=self.last).contains(&number)
    }
}

impl std::str::FromStr for RungRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |part: &str, default: usize| match part {
            "" => Ok(default),
            digits => digits.parse().map_err(|_| format!("`{digits}` is no rung number")),
        };
        let (first, last) = match text.split_once("..") {
            Some((first, last)) => (number(first, 0)?, number(last.trim_start_matches('='), usize::MAX)?),
            None => {
                let only = number(text, 0)?;
                (only, only)
            }
        };
        if first > last {
            Err(format!("the range is reversed: rung {first} comes after {last}"))
        } else if text.is_empty() {
            Err("expected A, A..B, A.. or ..B".to_owned())
        } else {
            Ok(RungRange { first, last })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn every_command_has_an_example() {
        let command = Arguments::command();
        command.clone().debug_assert();
        for sub in command.get_subcommands() {
            let help = sub.clone().render_long_help().to_string();
            assert!(help.contains("Example: rungs "), "{}", sub.get_name());
        }
    }

    #[test]
    fn rung_ranges() {
        let range = |text: &str| text.parse::<RungRange>().map(|r| (r.first, r.last));
        assert_eq!(range("4"), Ok((4, 4)));
        assert_eq!(range("4..7"), Ok((4, 7)));
        assert_eq!(range("4.."), Ok((4, usize::MAX)));
        assert_eq!(range("..7"), Ok((0, 7)));
        assert!(range("7..4").is_err() && range("x").is_err() && range("").is_err());
    }
}
