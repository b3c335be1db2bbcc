//! `rungs export`: files for other tools.

use std::cell::RefCell;
use std::collections::HashSet;
use std::io::Write;
use std::path::{Path, PathBuf};

use analysis::{CrossReference, TimerReport};
use ladder::Severity;

use super::drawings::{self, Rungs};
use super::{Opened, domore, each_dialect};
use crate::args::{ExportArguments, Form, Input, Table};
use crate::files::is_same_file;
use crate::output::{Error, Outcome, printable};

pub fn run(arguments: &ExportArguments) -> Result<Outcome, Error> {
    let into_folder = arguments.output.as_ref().is_some_and(|output| output.is_dir());
    let many = arguments.files.len() > 1 || arguments.files.iter().any(|path| path.is_dir());
    if many && arguments.output.is_some() && !into_folder {
        return Err(Error::Use("several projects: -o must name a folder that exists".to_owned()));
    }
    let input = Input { strict: arguments.strict, image: arguments.image, json: false };
    let written = RefCell::new(HashSet::new());
    let put = |path: &Path, bytes: &[u8], ending: &str, out: &mut dyn Write| -> Result<Outcome, Error> {
        let Some(output) = &arguments.output else {
            out.write_all(bytes)?;
            return Ok(Outcome::Done);
        };
        let target = if into_folder { target(output, &arguments.files, path, ending) } else { output.clone() };
        let why = match write(&target, bytes, arguments, &mut written.borrow_mut()) {
            Ok(()) => {
                writeln!(out, "{}", target.display())?;
                return Ok(Outcome::Done);
            }
            Err(why) => why,
        };
        if !many {
            return Err(Error::Use(why));
        }
        // One project must not stop the others.
        eprintln!("{}: not written: {why}", path.display());
        Ok(Outcome::NotWritten)
    };
    let slc = |opened: &Opened, out: &mut dyn Write| {
        let incomplete = opened.project.diagnostics.iter().any(|d| d.severity == Severity::Error);
        if incomplete && arguments.output.is_some() {
            // A file outlives the message that says what it lacks.
            eprintln!("{}: not written, because it could not be read whole", opened.path.display());
            return Ok(Outcome::Unreadable);
        }
        if arguments.to == Form::Svg {
            let rungs = Rungs::of_project(opened, arguments);
            let outcome = put_drawings(arguments, many, &opened.path, &rungs, &mut written.borrow_mut(), out)?;
            return Ok(if incomplete { Outcome::Unreadable } else { outcome });
        }
        let bytes = exported(opened, arguments, many && arguments.output.is_none())?;
        let outcome = put(&opened.path, &bytes, ending(arguments), out)?;
        Ok(if incomplete { Outcome::Unreadable } else { outcome })
    };
    each_dialect(&arguments.files, &input, slc, |opened, out| {
        if arguments.to == Form::Svg {
            let rungs = Rungs::of_domore(opened, arguments);
            return put_drawings(arguments, many, &opened.path, &rungs, &mut written.borrow_mut(), out);
        }
        // What could not be understood is carried, so that a text is whole in any case.
        let bytes = match domore::exported(opened, arguments) {
            Ok(bytes) => bytes,
            // A folder of both dialects: what the other one has no form for does not stop the rest.
            Err(Error::Use(why)) if many => {
                eprintln!("{}", printable(&format!("left out: {why}")));
                return Ok(Outcome::Done);
            }
            Err(error) => return Err(error),
        };
        put(&opened.path, &bytes, domore::ending(arguments), out)
    })
}

/// Writes a file unless something is there that was not to be overwritten.
fn write(
    target: &Path,
    bytes: &[u8],
    arguments: &ExportArguments,
    written: &mut HashSet<PathBuf>,
) -> Result<(), String> {
    if arguments.files.iter().any(|project| is_same_file(project, target)) {
        // Not even --force lets an export replace the project it is of.
        return Err(format!("{} is the project itself", target.display()));
    }
    if written.contains(target) {
        // Not even --force lets one project of a run replace another.
        return Err(format!("{} was just written from another project", target.display()));
    }
    if target.exists() && !arguments.force {
        return Err(format!("{} exists; --force overwrites it", target.display()));
    }
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty());
    folder
        .map_or(Ok(()), std::fs::create_dir_all)
        .and_then(|()| std::fs::write(target, bytes))
        .map_err(|error| format!("{}: {error}", target.display()))?;
    written.insert(target.to_owned());
    Ok(())
}

/// A file for each rung: in the folder that `-o` names, below one for each project if there are several;
/// a single rung is the output itself.
fn put_drawings(
    arguments: &ExportArguments,
    many: bool,
    path: &Path,
    rungs: &Rungs<'_>,
    written: &mut HashSet<PathBuf>,
    out: &mut dyn Write,
) -> Result<Outcome, Error> {
    let (name, count) = (path.display(), rungs.len());
    if count == 0 {
        eprintln!("{name}: no such rungs");
        return Ok(Outcome::Finding);
    }
    let Some(output) = &arguments.output else {
        if many || count > 1 {
            return Err(Error::Use(format!("{name}: {count} rungs are as many files: -o must name a folder")));
        }
        for drawn in rungs.drawn() {
            out.write_all(drawings::svg(&drawn).as_bytes())?;
        }
        return Ok(Outcome::Done);
    };
    let folder = if many { target(output, &arguments.files, path, "svg").with_extension("") } else { output.clone() };
    for drawn in rungs.drawn() {
        let single = count == 1 && !many && !output.is_dir();
        let target = if single { output.clone() } else { folder.join(format!("{}.svg", drawn.stem)) };
        write(&target, drawings::svg(&drawn).as_bytes(), arguments, written).map_err(Error::Use)?;
        writeln!(out, "{}", target.display())?;
    }
    Ok(Outcome::Done)
}

/// The file for one project; `line`: a JSON project goes on one line, as one of several.
fn exported(opened: &Opened, arguments: &ExportArguments, line: bool) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    match (arguments.to, arguments.table) {
        (Form::Json, _) if line => convert::json::write_json_line(&opened.project, &mut bytes)?,
        (Form::Json, _) => convert::json::write_json(&opened.project, &mut bytes)?,
        (Form::Slc, _) => {
            let export = convert::slc::project::export(opened.image());
            for note in &export.notes {
                let (severity, place, message) = (note.severity.as_str(), &note.place, &note.message);
                eprintln!("{}", printable(&format!("{}: {severity}: {place}: {message}", opened.path.display())));
            }
            bytes = convert::slc::encode(&export.file.write());
        }
        (Form::Html, _) => {
            drawings::page(&printable(&opened.title()), &Rungs::of_project(opened, arguments), &mut bytes)?;
        }
        (Form::Pdf, _) => {
            let processor = report::words::processor(&opened.image().processor);
            let rungs = Rungs::of_project(opened, arguments);
            bytes = drawings::book(opened.title(), processor, &rungs, arguments);
        }
        // Files of their own, see `put_drawings`.
        (Form::Svg, _) => {}
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

/// In the folder `-o` names: the project's name with the ending of the form, below the same subfolders
/// as in the folder the project was found in, so that projects of one name stay apart.
fn target(output: &Path, roots: &[PathBuf], project: &Path, ending: &str) -> PathBuf {
    let below = |root: &PathBuf| project.strip_prefix(root).ok().and_then(Path::parent).filter(|_| root.is_dir());
    let folder = roots.iter().find_map(below).unwrap_or(Path::new(""));
    let stem = project.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    output.join(folder).join(format!("{stem}.{ending}"))
}

fn ending(arguments: &ExportArguments) -> &'static str {
    match (arguments.to, arguments.table) {
        (Form::Json, _) => "json",
        (Form::Slc, _) => "SLC",
        (Form::Domore, _) => "txt",
        (Form::Svg, _) => "svg",
        (Form::Html, _) => "html",
        (Form::Pdf, _) => "pdf",
        (Form::Csv, Table::Symbols) => "symbols.csv",
        (Form::Csv, Table::Timers) => "timers.csv",
        (Form::Csv, Table::Xref) => "xref.csv",
    }
}
