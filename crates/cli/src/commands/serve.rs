//! `rungs serve`: the workbench in the browser.

use std::net::SocketAddr;
use std::process::{Command, Stdio};
use std::sync::Arc;

use ladder::Project;
use server::plant::Plant;
use server::view::{DoMoreProgram, SlcProgram};
use server::workbench::{Change, DoMore, Slc, Subject, Workbench};
use server::{Access, engine};
use sim::{Approximation, Machine, Options, Program, Unsupported};
use tokio::net::TcpListener;

use super::open;
use super::run::do_more_text;
use super::test::reasons;
use crate::args::ServeArguments;
use crate::do_more;
use crate::output::{Error, Outcome};

pub fn run(arguments: &ServeArguments) -> Result<Outcome, Error> {
    let name = arguments.program.display();
    let file = arguments.program.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let loaded = match do_more_text(&arguments.program) {
        Some(text) => do_more(arguments, file, &text),
        None => match open(&arguments.program, rss::Mode::Permissive) {
            Ok(project) => slc(arguments, file, project),
            Err(why) => {
                eprintln!("{name}: {why}");
                return Ok(Outcome::Unreadable);
            }
        },
    };
    let (machine, view) = match loaded {
        Ok(loaded) => loaded,
        Err(why) => {
            why.iter().for_each(|line| eprintln!("{name}: {line}"));
            eprintln!("{name}: not run");
            return Ok(Outcome::Finding);
        }
    };
    let mut bench = Workbench::new(machine);
    if let Some(path) = &arguments.plant {
        let located = |why: &dyn std::fmt::Display| Error::Use(format!("{}: {why}", path.display()));
        let text = std::fs::read_to_string(path).map_err(|why| located(&why))?;
        let plant = Plant::parse(&text).map_err(|why| located(&why))?;
        bench.change(Change::Plant(Some(Box::new(plant)))).map_err(|why| located(&why))?;
    }
    let runtime = tokio::runtime::Builder::new_current_thread().enable_io().enable_time().build();
    runtime.and_then(|runtime| runtime.block_on(serve(arguments, bench, view))).map_err(Error::Write)?;
    Ok(Outcome::Done)
}

/// The machine and what pages show of its program, or a line for everything that keeps it from running.
type Loaded = Result<(Box<dyn Subject>, Arc<dyn server::view::Program>), Vec<String>>;

fn slc(arguments: &ServeArguments, file: String, project: Project) -> Loaded {
    let unsupported = if arguments.accept_unsupported { Unsupported::Fault } else { Unsupported::Refuse };
    let options = Options { choices: arguments.simulation.choices(), unsupported, ..Options::default() };
    let program = Program::compile(&project.main, &options);
    let program = program.map_err(|refusals| refusals.iter().map(ToString::to_string).collect::<Vec<_>>())?;
    let notes = notes(program.approximations());
    let machine = Slc::new(Machine::new(program), &project.main);
    Ok((Box::new(machine), Arc::new(SlcProgram::new(file, project, notes))))
}

fn do_more(arguments: &ServeArguments, file: String, text: &str) -> Loaded {
    let unsupported = match arguments.accept_unsupported {
        true => domore::engine::Unsupported::Stop,
        false => domore::engine::Unsupported::Refuse,
    };
    let options =
        domore::engine::Options { choices: arguments.simulation.do_more(), unsupported, ..Default::default() };
    let (project, program, approximations) = do_more::program_of(text, &options)?;
    let machine = DoMore::new(program, &project);
    let view = DoMoreProgram::new(file, project, notes(&approximations)).map_err(|why| vec![why])?;
    Ok((Box::new(machine), Arc::new(view)))
}

fn notes(approximations: &[Approximation]) -> Vec<String> {
    reasons(approximations).into_iter().map(|line| format!("approximate: {line}")).collect()
}

async fn serve(
    arguments: &ServeArguments,
    bench: Workbench,
    view: Arc<dyn server::view::Program>,
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
    eprintln!(
        "Serving {}; Ctrl-C ends it. What is not recorded or exported is gone then.",
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
    server::serve(listener, engine::start(bench)?, view, access, ended).await
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
