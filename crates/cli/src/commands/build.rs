//! `rungs build`: text to project.

use std::path::{Path, PathBuf};

use ladder::{Project, Severity};

use super::{open, read_file};
use crate::args::BuildArguments;
use crate::output::{Error, Outcome};

pub fn run(arguments: &BuildArguments) -> Result<Outcome, Error> {
    let output = &arguments.output;
    if output.exists() && !arguments.force {
        return Err(Error::Use(format!("{} exists; --force overwrites it", output.display())));
    }
    let mut project = match open(&arguments.text, rss::Mode::Permissive) {
        Ok(project) => project,
        Err(why) => {
            eprintln!("{}: {why}", arguments.text.display());
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
    let built = convert::to_rss::project_file(&project).map_err(|error| Error::Use(error.to_string()))?;
    let bytes = built.file.write().map_err(|error| Error::Use(error.to_string()))?;
    report(output, &built.notes);
    std::fs::write(output, &bytes)?;
    println!(
        "{}: {} bytes, {} ladder files, {} rungs",
        output.display(),
        bytes.len(),
        project.main.ladder_files().count(),
        project.main.ladder_files().map(|file| file.rungs.len()).sum::<usize>()
    );
    Ok(Outcome::Done)
}

/// Prints what was noted; true if something is worse than a warning.
fn report(path: &Path, diagnostics: &[ladder::Diagnostic]) -> bool {
    for diagnostic in diagnostics {
        eprintln!("{}: {}: {}: {}", path.display(), diagnostic.severity.as_str(), diagnostic.place, diagnostic.message);
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
