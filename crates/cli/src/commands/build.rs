//! `rungs build`: text to project.

use std::io::Write;
use std::path::{Path, PathBuf};

use ladder::{Project, Severity};

use super::{open, read_file};
use crate::args::BuildArguments;
use crate::files::is_same_file;
use crate::output::{Error, Outcome, printable};

pub fn run(arguments: &BuildArguments) -> Result<Outcome, Error> {
    let output = &arguments.output;
    let sources = [Some(arguments.text.clone()), symbols_file(arguments)];
    if let Some(source) = sources.iter().flatten().find(|source| is_same_file(source, output)) {
        return Err(Error::Use(format!("{}: the project would overwrite the text it is made of", source.display())));
    }
    if output.exists() && !arguments.force {
        return Err(Error::Use(format!("{} exists; --force overwrites it", output.display())));
    }
    let mut project = match open(&arguments.text, rss::Mode::Permissive) {
        Ok(project) => project,
        Err(why) => {
            eprintln!("{}", printable(&format!("{}: {why}", arguments.text.display())));
            return Ok(Outcome::Unreadable);
        }
    };
    if report(&arguments.text, &project.diagnostics) {
        eprintln!("{}: nothing written: a project must hold all of its text", arguments.text.display());
        return Ok(Outcome::Unreadable);
    }
    if let Some(symbols) = symbols_file(arguments) {
        add_symbols(&mut project, &symbols)?;
    }
    let wrong = |error: rss::Error| Error::Use(printable(&error.to_string()));
    let built = convert::to_rss::project_file(&project).map_err(wrong)?;
    let bytes = built.file.write().map_err(wrong)?;
    report(output, &built.notes);
    std::fs::write(output, &bytes).map_err(|error| Error::Use(format!("{}: {error}", output.display())))?;
    writeln!(
        std::io::stdout(),
        "{}: {} bytes, {} ladder files, {} rungs",
        output.display(),
        bytes.len(),
        project.main.ladder_files().count(),
        project.main.ladder_files().map(|file| file.rungs.len()).sum::<usize>()
    )?;
    Ok(Outcome::Done)
}

/// Both names lead to one file, by whatever path.
/// Prints what was noted; true if something is worse than a warning.
fn report(path: &Path, diagnostics: &[ladder::Diagnostic]) -> bool {
    for diagnostic in diagnostics {
        let (severity, place, message) = (diagnostic.severity.as_str(), &diagnostic.place, &diagnostic.message);
        eprintln!("{}", printable(&format!("{}: {severity}: {place}: {message}", path.display())));
    }
    diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error)
}

/// The table named on the command line, else `TEXT.csv` beside the text.
fn symbols_file(arguments: &BuildArguments) -> Option<PathBuf> {
    let beside = arguments.text.with_extension("csv");
    arguments.symbols.clone().or_else(|| beside.is_file().then_some(beside))
}

fn add_symbols(project: &mut Project, path: &Path) -> Result<(), Error> {
    let wrong = |why: String| Error::Use(format!("{}: {why}", path.display()));
    let bytes = read_file(path, convert::csv::MAX_BYTES).map_err(wrong)?;
    // Spreadsheet programs write the code page of their country or UTF-8, as it happens.
    let text = convert::slc::decode(&bytes);
    convert::csv::read_symbols(&text, &mut project.main).map_err(|error| wrong(error.to_string()))
}
