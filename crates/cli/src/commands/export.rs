//! `rungs export`: files for other tools.

use std::cell::RefCell;
use std::collections::HashSet;
use std::io::Write;
use std::path::{Path, PathBuf};

use analysis::{CrossReference, TimerReport};
use ladder::Severity;

use super::{Opened, domore, each_dialect};
use crate::args::{ExportArguments, Form, Input, Table};
use crate::output::{Error, Outcome};

pub fn run(arguments: &ExportArguments) -> Result<Outcome, Error> {
    let into_folder = arguments.output.as_ref().is_some_and(|output| output.is_dir());
    let many = arguments.files.len() > 1 || arguments.files.iter().any(|path| path.is_dir());
    if many && arguments.output.is_some() && !into_folder {
        return Err(Error::Use("several projects: -o must name a folder that exists".to_owned()));
    }
    let input = Input { strict: arguments.strict, image: arguments.image, json: false };
    let written = RefCell::new(HashSet::new());
    let put = |path: &Path, bytes: &[u8], ending: &str, out: &mut dyn Write| -> Result<(), Error> {
        let target = arguments.output.as_ref().map(|output| target(output, into_folder, path, ending));
        match target {
            None => out.write_all(bytes)?,
            Some(path) => {
                // Two projects of one name from different folders must not overwrite each other.
                if (path.exists() && !arguments.force) || !written.borrow_mut().insert(path.clone()) {
                    return Err(Error::Use(format!("{} exists; --force overwrites it", path.display())));
                }
                std::fs::write(&path, bytes)?;
                writeln!(out, "{}", path.display())?;
            }
        }
        Ok(())
    };
    let slc = |opened: &Opened, out: &mut dyn Write| {
        let incomplete = opened.project.diagnostics.iter().any(|d| d.severity == Severity::Error);
        if incomplete && arguments.output.is_some() {
            // A file outlives the message that says what it lacks.
            eprintln!("{}: not written, because it could not be read whole", opened.path.display());
            return Ok(Outcome::Unreadable);
        }
        let bytes = exported(opened, arguments)?;
        put(&opened.path, &bytes, ending(arguments), out)?;
        Ok(if incomplete { Outcome::Unreadable } else { Outcome::Done })
    };
    each_dialect(&arguments.files, &input, slc, |opened, out| {
        // What could not be understood is carried, so that a text is whole in any case.
        let bytes = domore::exported(opened, arguments)?;
        put(&opened.path, &bytes, domore::ending(arguments), out)?;
        Ok(Outcome::Done)
    })
}

fn exported(opened: &Opened, arguments: &ExportArguments) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    match (arguments.to, arguments.table) {
        (Form::Json, _) => convert::json::write_json(&opened.project, &mut bytes)?,
        (Form::Slc, _) => {
            let export = convert::slc::project::export(opened.image());
            for note in &export.notes {
                eprintln!("{}: {}: {}: {}", opened.path.display(), note.severity.as_str(), note.place, note.message);
            }
            bytes = convert::slc::encode(&export.file.write());
        }
        (Form::Domore, _) => {
            let name = opened.path.display();
            return Err(Error::Use(format!("{name}: `rungs migrate {name} --to domore --out DIR` converts a program")));
        }
        (Form::Csv, Table::Symbols) => {
            convert::csv::write_symbols(opened.documentation(), &mut bytes)?;
        }
        (Form::Csv, table) => {
            let xref = CrossReference::build(opened.image(), opened.documentation());
            match table {
                Table::Timers => analysis::csv::timers(&TimerReport::build(opened.image(), &xref), &mut bytes)?,
                _ => analysis::csv::xref(&xref, &mut bytes)?,
            }
        }
    }
    Ok(bytes)
}

/// `-o FILE`, or `-o FOLDER` with the project's name and the ending of the form.
fn target(output: &Path, into_folder: bool, project: &Path, ending: &str) -> PathBuf {
    if !into_folder {
        return output.to_path_buf();
    }
    let stem = project.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    output.join(format!("{stem}.{ending}"))
}

fn ending(arguments: &ExportArguments) -> &'static str {
    match (arguments.to, arguments.table) {
        (Form::Json, _) => "json",
        (Form::Slc, _) => "SLC",
        (Form::Domore, _) => "txt",
        (Form::Csv, Table::Symbols) => "symbols.csv",
        (Form::Csv, Table::Timers) => "timers.csv",
        (Form::Csv, Table::Xref) => "xref.csv",
    }
}
