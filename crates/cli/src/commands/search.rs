//! `rungs search`: addresses, symbols, instructions with wildcards, texts, regular expressions.

use std::collections::HashSet;
use std::io::Write;

use analysis::search::{Hit, Query, search};
use serde_json::{Value, json};

use super::{draw_rung, drawing_style, each_project, write_json};
use crate::args::SearchArguments;
use crate::output::{Error, Outcome, Printable};

pub fn run(arguments: &SearchArguments) -> Result<Outcome, Error> {
    let query = match arguments.regex {
        true => Query::regex(&arguments.pattern).map_err(Error::Use)?,
        false => Query::new(&arguments.pattern),
    };
    if arguments.pattern.trim().is_empty() {
        return Err(Error::Use("expected something to search for".to_owned()));
    }
    let style = drawing_style(None);
    let mut any = false;
    let outcome = each_project(&arguments.files, &arguments.input, |opened, out| {
        let hits = search(opened.image(), opened.documentation(), &query);
        any |= !hits.list.is_empty();
        if arguments.input.json {
            let document = json!({
                "file": opened.path.display().to_string(),
                "hits": hits.list.iter().map(describe).collect::<Value>(),
                "not_listed": hits.not_listed,
            });
            write_json(opened, document, out)?;
            return Ok(Outcome::Done);
        }
        if hits.list.is_empty() {
            return Ok(Outcome::Done);
        }
        let count = hits.list.len() + hits.not_listed;
        writeln!(Printable(&mut *out), "{}: {count} found", opened.title())?;
        let mut drawn = HashSet::new();
        for hit in &hits.list {
            let place = hit.location.map_or_else(|| "-".to_owned(), |at| at.to_string());
            let text = hit.text.split_whitespace().collect::<Vec<_>>().join(" ");
            writeln!(Printable(&mut *out), "{place:>8}  {}  {text}", hit.kind)?;
            if let Some(at) = hit.location.filter(|_| !arguments.no_draw)
                && drawn.insert((at.file, at.rung))
            {
                draw_rung(opened, at, &style, out)?;
            }
        }
        if hits.not_listed > 0 {
            writeln!(out, "{} more are not listed", hits.not_listed)?;
        }
        writeln!(out)?;
        Ok(Outcome::Done)
    })?;
    Ok(if any { outcome } else { outcome.max(Outcome::Finding) })
}

fn describe(hit: &Hit) -> Value {
    json!({
        "rung": hit.location.map(|at| json!({"file": at.file, "rung": at.rung, "instruction": at.instruction})),
        "kind": hit.kind,
        "text": hit.text,
    })
}
