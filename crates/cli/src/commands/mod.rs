//! The commands: each opens projects, asks one library, prints.

mod bench;
mod build;
mod check;
mod data;
mod diff;
mod domore;
mod drawings;
mod export;
mod git;
mod git_setup;
mod history;
mod info;
mod junit;
mod merge_driver;
mod migrate;
mod prove;
mod report;
mod run;
mod search;
mod serve;
mod serve_pair;
mod show;
mod test;
mod timers;
mod trace;
mod verify;
mod xref;

use std::io::{IsTerminal, Read, Write};
use std::path::{Path, PathBuf};

use ::report::words::one_line;
use convert::AnyProject;
use ladder::{Documentation, Image, Project, Severity};
use rss::Mode;

use crate::args::{Arguments, Command, ImageChoice, Input};
use crate::commands::domore::OpenedDomore;
use crate::files;
use crate::output::{Error, Outcome, printable};

/// Runs the command that was asked for.
pub fn run(arguments: Arguments) -> Result<Outcome, Error> {
    match arguments.command {
        Command::Info(arguments) => info::run(&arguments),
        Command::Show(arguments) => show::run(&arguments),
        Command::Data(arguments) => data::run(&arguments),
        Command::Timers(arguments) => timers::run(&arguments),
        Command::Xref(arguments) => xref::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Search(arguments) => search::run(&arguments),
        Command::Verify(arguments) => verify::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Build(arguments) => build::run(&arguments),
        Command::Run(arguments) => run::run(&arguments),
        Command::Serve(arguments) => serve::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Test(arguments) => test::run(&arguments),
        Command::Migrate(arguments) => migrate::run(&arguments),
        Command::Prove(arguments) => prove::run(&arguments),
        Command::Diff(arguments) => diff::run(&arguments),
        Command::History(arguments) => history::run(&arguments),
        Command::GitSetup(arguments) => git_setup::run(&arguments),
        Command::MergeDriver(arguments) => merge_driver::run(&arguments),
        Command::Textconv(arguments) => git_setup::textconv(&arguments),
        Command::Report(arguments) => report::run(&arguments),
    }
}

/// A project with the image that was asked for.
struct Opened {
    path: PathBuf,
    project: Project,
    choice: ImageChoice,
}

impl Opened {
    fn image(&self) -> &Image {
        // `each_project` has made sure that the image is there.
        self.choice.of(&self.project).unwrap_or(&self.project.main)
    }

    /// Says so and answers `true` when the project does not hold the image that was asked for.
    fn lacks_image(&self) -> bool {
        let missing = self.choice.of(&self.project).is_none();
        if missing {
            eprintln!("{}: the project holds no such image", self.path.display());
        }
        missing
    }

    /// The documentation shown with the image: the online image has none of its own.
    fn documentation(&self) -> &Documentation {
        match self.choice {
            ImageChoice::Online => &self.project.main.documentation,
            _ => &self.image().documentation,
        }
    }

    /// `conveyor.RSS`, with the image when it is not the main one.
    fn title(&self) -> String {
        let name = self.path.display();
        match self.choice {
            ImageChoice::Main => name.to_string(),
            ImageChoice::Online => format!("{name} (online image)"),
            ImageChoice::Autosave => format!("{name} (autosave image)"),
        }
    }
}

/// Bytes of a project that are read at all; what is known of its content has limits of its own.
const MOST_BYTES: usize = 64 << 20;

/// Reads a file whole, up to `limit` bytes, whatever its directory entry states.
fn read_file(path: &Path, limit: usize) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(|error| error.to_string())?;
    let most = u64::try_from(limit).unwrap_or(u64::MAX).saturating_add(1);
    file.take(most).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    if bytes.len() > limit {
        return Err(format!("expected a file of at most {limit} bytes, found more"));
    }
    Ok(bytes)
}

pub(crate) fn open(path: &Path, mode: Mode) -> Result<Project, String> {
    let bytes = read_file(path, MOST_BYTES)?;
    convert::open(&bytes, &file_name(path), mode).map_err(|error| error.to_string())
}

fn file_name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

fn mode(strict: bool) -> Mode {
    if strict { Mode::Strict } else { Mode::Permissive }
}

/// Opens one project after the other and hands each to `work`, those of Do-more to `domore`. What cannot be read is
/// reported and the rest goes on; so do findings of the reader.
fn each_dialect(
    paths: &[PathBuf],
    input: &Input,
    mut work: impl FnMut(&Opened, &mut dyn Write) -> Result<Outcome, Error>,
    mut domore: impl FnMut(&OpenedDomore, &mut dyn Write) -> Result<Outcome, Error>,
) -> Result<Outcome, Error> {
    each_file(paths, input.json, |path, is_last, mut out| {
        let bytes = match read_file(path, MOST_BYTES) {
            Ok(bytes) => bytes,
            Err(why) => return Ok(Err(why)),
        };
        let path = path.to_owned();
        match convert::open_any(&bytes, &file_name(&path), mode(input.strict)) {
            Ok(AnyProject::Rslogix(project)) => {
                let opened = Opened { path, project: *project, choice: input.image };
                let outcome = one_project(&opened, input.json, out, &mut work)?;
                if is_last {
                    // The process ends next. Giving back a large model piece by piece would take a tenth of
                    // the whole run.
                    std::mem::forget(opened);
                }
                Ok(Ok(outcome))
            }
            Ok(AnyProject::Domore(_)) if input.image != ImageChoice::Main => {
                eprintln!("{}: the project holds no such image", path.display());
                Ok(Ok(Outcome::Finding))
            }
            Ok(AnyProject::Domore(document)) => {
                let opened = OpenedDomore { path, document: *document };
                let outcome = domore(&opened, &mut out)?.max(opened.outcome());
                if !input.json {
                    out.flush()?;
                    opened.warn();
                }
                if is_last {
                    std::mem::forget(opened);
                }
                Ok(Ok(outcome))
            }
            Err(why) => Ok(Err(why.to_string())),
        }
    })
}

/// Hands one file after the other to `work`, and whether it is the last. The text for one that cannot
/// be read is reported and the rest goes on. The worst outcome counts.
fn each_file(
    paths: &[PathBuf],
    json: bool,
    mut work: impl FnMut(&Path, bool, &mut dyn Write) -> Result<Result<Outcome, String>, Error>,
) -> Result<Outcome, Error> {
    let files = files::expand(paths, files::PROJECTS).map_err(Error::Use)?;
    let bar = files::progress(files.len(), std::io::stdout().is_terminal());
    let mut out = crate::output::standard(json);
    let mut outcome = Outcome::Done;
    let mut left = files.len();
    for path in files {
        left -= 1;
        let name = path.display().to_string();
        bar.set_message(name.clone());
        let result = match work(&path, left == 0, &mut out)? {
            Ok(result) => result,
            Err(why) => {
                if json {
                    writeln!(out, "{}", serde_json::json!({"file": name, "error": why}))?;
                }
                bar.suspend(|| eprintln!("{}", printable(&format!("{name}: {why}"))));
                Outcome::Unreadable
            }
        };
        outcome = outcome.max(result);
        bar.inc(1);
    }
    bar.finish_and_clear();
    out.flush()?;
    Ok(outcome)
}

fn one_project(
    opened: &Opened,
    json: bool,
    mut out: &mut dyn Write,
    work: &mut impl FnMut(&Opened, &mut dyn Write) -> Result<Outcome, Error>,
) -> Result<Outcome, Error> {
    if opened.lacks_image() {
        return Ok(Outcome::Finding);
    }
    let mut outcome = work(opened, &mut out)?;
    if opened.project.diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error) {
        // Part of the input could not be read, whatever was printed of the rest.
        outcome = outcome.max(Outcome::Unreadable);
    }
    if json {
        return Ok(outcome);
    }
    // Never let partial data pass for the whole.
    out.flush()?;
    for diagnostic in opened.project.diagnostics.iter().filter(|d| d.severity >= Severity::Warning).take(20) {
        let (severity, place, message) = (diagnostic.severity.as_str(), &diagnostic.place, &diagnostic.message);
        eprintln!("{}", printable(&format!("{}: {severity}: {place}: {message}", opened.path.display())));
    }
    let more = opened.project.diagnostics.iter().filter(|d| d.severity >= Severity::Warning).count().saturating_sub(20);
    if more > 0 {
        eprintln!("{}: {more} further findings, see `rungs info --json`", opened.path.display());
    }
    Ok(outcome)
}

/// Writes a document as one line, with what the reader found wrong: partial data must say so.
fn write_json(opened: &Opened, mut document: serde_json::Value, out: &mut dyn Write) -> Result<(), Error> {
    document["diagnostics"] = diagnostics_json(&opened.project);
    Ok(writeln!(out, "{document}")?)
}

fn diagnostics_json(project: &Project) -> serde_json::Value {
    let one = |d: &ladder::Diagnostic| serde_json::json!({"severity": d.severity.as_str(), "place": d.place, "message": d.message});
    project.diagnostics.iter().map(one).collect()
}

/// Rungs, then how many more there are.
fn places(locations: &[analysis::Location], left_out: usize) -> String {
    let rungs = locations.iter().map(ToString::to_string);
    rungs.chain((left_out > 0).then(|| more(left_out))).collect::<Vec<_>>().join(", ")
}

fn more(left_out: usize) -> String {
    format!("and {left_out} more")
}

/// How rungs are drawn between other results: as wide as the terminal, values left to `rungs show`.
fn drawing_style(width: Option<usize>) -> render::Style {
    let terminal = std::io::stdout().is_terminal();
    let columns = || terminal_size::terminal_size().filter(|_| terminal).map(|(width, _)| usize::from(width.0));
    render::Style {
        width: width.or_else(columns).unwrap_or(100),
        color: check::is_coloured(),
        values: false,
        ..render::Style::default()
    }
}

/// Draws the rung of a place, nothing if there is none.
fn draw_rung(opened: &Opened, at: analysis::Location, style: &render::Style, out: &mut dyn Write) -> Result<(), Error> {
    let index = usize::try_from(at.rung).unwrap_or(usize::MAX);
    if let Some(file) = opened.image().program_file(at.file).filter(|file| index < file.rungs.len()) {
        let text = render::rung(opened.image(), file, index, opened.documentation(), style);
        out.write_all(text.as_bytes())?;
    }
    Ok(())
}
