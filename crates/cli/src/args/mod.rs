//! The command line: every command, its arguments and an example.

mod document;
mod simulate;
mod versions;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use document::sections_help;

pub use document::*;
pub use simulate::*;
pub use versions::*;

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
