//! `rungs diff` of Do-more projects: code blocks have names, and rungs count from 1.

use std::io::Write;
use std::path::Path;

use analysis::diff::{Difference, LogicChange, Place, compare_domore};
use convert::designer::Document;
use ladder::Severity;
use report::diff::Side;
use serde_json::{Value, json};

use super::folders::Paired;
use super::{Both, Printer, Read};
use crate::output::{Error, Outcome, printable};

/// Compares two Do-more projects.
pub(super) fn compare(
    (old, a): (&Path, &Document),
    (new, b): (&Path, &Document),
    how: Option<Paired>,
    printer: &Printer,
    out: &mut dyn Write,
) -> Result<Outcome, Error> {
    let read = |document: &Document| {
        // A rung that does not balance was read all the same: it is compared as it stands.
        let lines = document.diagnostics.iter().filter(|found| found.rung.is_none());
        let errors = lines.filter(|found| found.problem.severity() == Severity::Error);
        let all = document.diagnostics.iter().map(|found| {
            let found = found.to_ladder();
            json!({"severity": found.severity.as_str(), "place": found.place, "message": found.message})
        });
        Read {
            file: document.source.file.clone(),
            diagnostics: all.collect(),
            errors: errors.map(ToString::to_string).collect(),
        }
    };
    let both = Both {
        names: (old.display().to_string(), new.display().to_string()),
        sides: (Side::domore(&a.project), Side::domore(&b.project)),
        rslogix: None,
        files: vec![read(a), read(b)],
    };
    printer.print(&both, how, compare_domore(&a.project, &b.project), out)
}

/// Says that programs of two dialects are compared in other ways.
pub(super) fn refuse(
    old: &Path,
    new: &Path,
    how: Option<Paired>,
    printer: &Printer,
    out: &mut dyn Write,
) -> Result<Outcome, Error> {
    let why = "one is a program of RSLogix 500, the other one of Do-more: `rungs prove` runs both side by side, `rungs \
               migrate` converts one and reports each rung";
    let message = format!("{} and {}: {why}", old.display(), new.display());
    if how.is_none() {
        return Err(Error::Use(printable(&message)));
    }
    if let Some(pages) = &printer.pages {
        let remark = "not compared: one is a program of RSLogix 500, the other one of Do-more";
        pages.without_page(&old.display().to_string(), &new.display().to_string(), remark);
    } else if printer.json {
        writeln!(out, "{}", json!({"file": new.display().to_string(), "error": message}))?;
    }
    eprintln!("{}", printable(&message));
    Ok(Outcome::Finding)
}

/// Adds the names of code blocks, and counts rungs as Designer does.
pub(super) fn name_places(document: &mut Value, difference: &Difference, sides: &(Side<'_>, Side<'_>)) {
    let Some(rows) = document["logic"].as_array_mut() else { return };
    for (row, change) in rows.iter_mut().zip(&difference.logic) {
        let (old, new) = match change {
            LogicChange::File(file) => {
                row["what"] = "code block".into();
                (file.old, file.new)
            }
            LogicChange::Rung(rung) => {
                let number = |at: Option<Place>| at.map(|at| at.rung + 1);
                (row["old_rung"], row["new_rung"]) = (number(rung.old).into(), number(rung.new).into());
                (rung.old.map(|at| at.file), rung.new.map(|at| at.file))
            }
        };
        let old = old.and_then(|number| sides.0.block_name(number));
        let new = new.and_then(|number| sides.1.block_name(number));
        row["code_block"] = new.clone().or_else(|| old.clone()).into();
        (row["old_code_block"], row["new_code_block"]) = (old.into(), new.into());
    }
}
