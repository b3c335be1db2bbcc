//! `rungs serve`: the workbench in the browser.

use std::net::SocketAddr;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;

use ladder::Project;
use server::plant::Plant;
use server::view::{DoMoreProgram, SlcProgram};
use server::workbench::{Change, DoMore, Slc, Subject, Tape, Workbench};
use server::{Access, PairView, engine};
use sim::{Approximation, Machine, Options, Program, Unsupported};
use tokio::net::TcpListener;

use super::run::do_more_text;
use super::test::reasons;
use super::{file_name, open, read_file, serve_pair};
use crate::args::ServeArguments;
use crate::do_more;
use crate::output::{Error, Outcome};

pub fn run(arguments: &ServeArguments) -> Result<Outcome, Error> {
    if let Some(other) = &arguments.other {
        return match serve_pair::load(arguments, other)? {
            Ok((bench, view, pair)) => start(arguments, bench, view, Some(pair)),
            Err(outcome) => Ok(outcome),
        };
    }
    let name = arguments.program.display();
    let file = file_name(&arguments.program);
    let loaded = match do_more_text(&arguments.program) {
        Some(text) => do_more(arguments, file, &text),
        None => match open(&arguments.program, rss::Mode::Permissive) {
            Ok(project) => {
                let slc = slc(arguments, arguments.simulation.choices(), file, project);
                slc.map(|(machine, view)| (Box::new(machine) as Box<dyn Subject>, view))
            }
            Err(why) => {
                eprintln!("{name}: {why}");
                return Ok(Outcome::Unreadable);
            }
        },
    };
    match loaded {
        Ok((machine, view)) => start(arguments, Workbench::new(machine), view, None),
        Err(why) => Ok(not_run(&arguments.program, &why)),
    }
}

/// Tells what keeps a program from running.
pub fn not_run(path: &Path, why: &[String]) -> Outcome {
    let name = path.display();
    why.iter().for_each(|line| eprintln!("{name}: {line}"));
    eprintln!("{name}: not run");
    Outcome::Finding
}

/// Wires the plant, loads the tape, serves.
fn start(
    arguments: &ServeArguments,
    mut bench: Workbench,
    view: View,
    pair: Option<PairView>,
) -> Result<Outcome, Error> {
    let text = |path: &Path| {
        let located = |why: &dyn std::fmt::Display| Error::Use(format!("{}: {why}", path.display()));
        let bytes = read_file(path, MOST_TEXT).map_err(|why| located(&why))?;
        String::from_utf8(bytes).map_err(|_| located(&"not UTF-8 text"))
    };
    if let Some(path) = &arguments.plant {
        let located = |why: String| Error::Use(format!("{}: {why}", path.display()));
        let plant = Plant::parse(&text(path)?).map_err(located)?;
        bench.change(Change::Plant(Some(Box::new(plant)))).map_err(located)?;
    }
    if let Some(path) = &arguments.replay {
        let located = |why: String| Error::Use(format!("{}: {why}", path.display()));
        let tape = Tape::read(&text(path)?, bench.initial()).map_err(located)?;
        bench.play(tape).map_err(located)?;
    }
    let runtime = tokio::runtime::Builder::new_current_thread().enable_io().enable_time().build();
    let served = runtime.and_then(|runtime| runtime.block_on(serve(arguments, bench, view, pair)));
    served.map_err(Error::Write)?;
    Ok(Outcome::Done)
}

/// What pages show of a program.
pub type View = Arc<dyn server::view::Program>;

/// The machine and what pages show of its program, or a line for everything that keeps it from running.
pub type Loaded<M> = Result<(M, View), Vec<String>>;

/// Most bytes of a plant or a scenario.
const MOST_TEXT: usize = 16 << 20;

/// The machine of an SLC 500 or MicroLogix project.
pub fn slc(arguments: &ServeArguments, choices: sim::Choices, file: String, project: Project) -> Loaded<Slc> {
    let unsupported = if arguments.accept_unsupported { Unsupported::Fault } else { Unsupported::Refuse };
    let options = Options { choices, unsupported, ..Options::default() };
    let program = Program::compile(&project.main, &options);
    let program = program.map_err(|refusals| refusals.iter().map(ToString::to_string).collect::<Vec<_>>())?;
    let notes = notes(program.approximations());
    let machine = Slc::new(Machine::new(program), &project.main);
    Ok((machine, Arc::new(SlcProgram::new(file, project, notes))))
}

fn do_more(arguments: &ServeArguments, file: String, text: &str) -> Loaded<Box<dyn Subject>> {
    let unsupported = match arguments.accept_unsupported {
        true => domore::engine::Unsupported::Stop,
        false => domore::engine::Unsupported::Refuse,
    };
    let options =
        domore::engine::Options { choices: arguments.simulation.do_more(), unsupported, ..Default::default() };
    let (project, program, approximations) = do_more::program_of(text, &options)?;
    let (machine, view) = of_do_more(file, project, program, &approximations)?;
    Ok((Box::new(machine), view))
}

/// The machine of a Do-more program.
pub fn of_do_more(
    file: String,
    project: domore::Project,
    program: domore::engine::Program,
    approximations: &[Approximation],
) -> Loaded<DoMore> {
    let machine = DoMore::new(program, &project);
    let view = DoMoreProgram::new(file, project, notes(approximations)).map_err(|why| vec![why])?;
    Ok((machine, Arc::new(view)))
}

fn notes(approximations: &[Approximation]) -> Vec<String> {
    reasons(approximations).into_iter().map(|line| format!("approximate: {line}")).collect()
}

async fn serve(
    arguments: &ServeArguments,
    bench: Workbench,
    view: View,
    pair: Option<PairView>,
) -> std::io::Result<()> {
    let listener = TcpListener::bind(SocketAddr::new(arguments.address, arguments.port)).await?;
    let bound = listener.local_addr()?;
    let token = match bound.ip().is_loopback() {
        true => None,
        false => Some(token()?),
    };
    let page = match &token {
        Some(token) => format!("http://{bound}/?token={token}"),
        None => format!("http://{bound}/"),
    };
    println!("{page}");
    let other = arguments.other.as_ref().map(|other| format!(" beside {}", other.display())).unwrap_or_default();
    eprintln!(
        "Serving {}{other}; Ctrl-C ends it. What is not recorded or exported is gone then.",
        arguments.program.display()
    );
    if arguments.open {
        show(&page);
    }
    let access = Access { token, read_only: arguments.read_only, ..Access::default() };
    let ended = async {
        if tokio::signal::ctrl_c().await.is_err() {
            // Without signals only the end of the process ends the server.
            std::future::pending::<()>().await;
        }
    };
    let engine = engine::start(bench)?;
    match pair {
        Some(pair) => server::serve_pair(listener, engine, view, pair, access, ended).await,
        None => server::serve(listener, engine, view, access, ended).await,
    }
}

/// 128 random bits as text.
fn token() -> std::io::Result<String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|why| std::io::Error::other(why.to_string()))?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// Opens a page in the browser of the desktop; where there is none, the address has been printed.
fn show(page: &str) {
    let opener = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    let child = Command::new(opener).arg(page).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    if child.is_err() {
        eprintln!("`{opener}` could not open the page; open the address above");
    }
}
