//! What is asked of programs that run: `run`, `serve`, `bench`, `test`, `prove` and `migrate`.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueEnum};
use sim::Choices;
use sim::choices::Choice;

use super::*;

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
