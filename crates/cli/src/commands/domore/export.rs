//! `rungs export` of a Do-more project.

use convert::designer::{to_bytes, write_json, write_symbols, write_xref};
use domore::xref::CrossReference;

use super::OpenedDomore;
use crate::args::{ExportArguments, Form, Table};
use crate::commands::drawings::{self, Rungs};
use crate::output::Error;

/// The bytes of the file to write.
///
/// # Errors
/// A form or table that a Do-more project does not have.
pub fn exported(opened: &OpenedDomore, arguments: &ExportArguments) -> Result<Vec<u8>, Error> {
    let project = &opened.document.project;
    let mut bytes = Vec::new();
    match (arguments.to, arguments.table) {
        (Form::Domore, _) => bytes = to_bytes(project),
        (Form::Json, _) => write_json(&opened.document, &mut bytes)?,
        (Form::Csv, Table::Symbols) => write_symbols(project, &mut bytes)?,
        (Form::Csv, Table::Xref) => {
            let xref = CrossReference::build(project);
            write_xref(&xref.map_err(|error| Error::Use(format!("{}: {error}", opened.name())))?, &mut bytes)?;
        }
        (Form::Csv, Table::Timers) => {
            return Err(Error::Use(format!("{}: there is no timer table of Do-more projects", opened.name())));
        }
        (Form::Html, _) => {
            drawings::page(&opened.name(), &Rungs::of_domore(opened, arguments), &mut bytes)?;
        }
        (Form::Pdf, _) => {
            let processor = report::words::controller(project);
            bytes = drawings::book(opened.name(), processor, &Rungs::of_domore(opened, arguments), arguments);
        }
        // Files of their own.
        (Form::Svg, _) => {}
        (Form::Slc, _) => {
            return Err(Error::Use(format!("{}: a Do-more project has no SLC text", opened.name())));
        }
    }
    Ok(bytes)
}

/// The ending of a file of that form.
pub fn ending(arguments: &ExportArguments) -> &'static str {
    match (arguments.to, arguments.table) {
        (Form::Json, _) => "json",
        (Form::Csv, Table::Symbols) => "symbols.csv",
        (Form::Csv, Table::Timers) => "timers.csv",
        (Form::Csv, Table::Xref) => "xref.csv",
        (Form::Slc | Form::Domore, _) => "txt",
        (Form::Svg, _) => "svg",
        (Form::Html, _) => "html",
        (Form::Pdf, _) => "pdf",
    }
}
