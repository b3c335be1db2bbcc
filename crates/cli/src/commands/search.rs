//! `rungs search`: addresses, symbols, instructions with wildcards, texts, regular expressions.

use std::collections::HashSet;
use std::io::Write;

use analysis::Location;
use analysis::search::{Hit, Hits, Query, search, search_domore};
use domore::documentation::Documentation;
use serde_json::{Value, json};

use super::{draw_rung, drawing_style, each_dialect, write_json};
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
    let any = std::cell::Cell::new(false);
    let json = arguments.input.json;
    let slc = |opened: &super::Opened, out: &mut dyn Write| {
        let hits = search(opened.image(), opened.documentation(), &query);
        any.set(any.get() || !hits.list.is_empty());
        if json {
            write_json(opened, document(&opened.path.display().to_string(), &hits, describe), out)?;
        } else {
            let place = |at: Location| at.to_string();
            let draw = |at, out: &mut dyn Write| draw_rung(opened, at, &style, out);
            print(&opened.title(), &hits, &place, (!arguments.no_draw).then_some(&draw), out)?;
        }
        Ok(Outcome::Done)
    };
    let outcome = each_dialect(&arguments.files, &arguments.input, slc, |opened, out| {
        let project = &opened.document.project;
        let hits = search_domore(project, &query);
        any.set(any.get() || !hits.list.is_empty());
        let block = |at: Location| project.code_blocks().nth(usize::from(at.file).saturating_sub(1));
        let name = |at: Location| block(at).map_or("", |block| block.name.as_str());
        if json {
            let describe = |hit: &Hit| {
                let rung =
                    |at: Location| json!({"code_block": name(at), "rung": at.rung + 1, "instruction": at.instruction});
                json!({"rung": hit.location.map(rung), "kind": hit.kind, "text": hit.text})
            };
            opened.write_json(document(&opened.name(), &hits, describe), out)?;
            return Ok(Outcome::Done);
        }
        let documentation = Documentation::new(project);
        let place = |at: Location| format!("{}:{}", name(at), at.rung + 1);
        let draw = |at: Location, out: &mut dyn Write| {
            let index = usize::try_from(at.rung).unwrap_or(usize::MAX);
            let text = block(at).map(|block| render::domore::rung(block, index, &documentation, &style));
            Ok(out.write_all(text.unwrap_or_default().as_bytes())?)
        };
        print(&opened.name(), &hits, &place, (!arguments.no_draw).then_some(&draw), out)?;
        Ok(Outcome::Done)
    })?;
    Ok(if any.get() { outcome } else { outcome.max(Outcome::Finding) })
}

fn document(file: &str, hits: &Hits, describe: impl Fn(&Hit) -> Value) -> Value {
    json!({
        "file": file,
        "hits": hits.list.iter().map(describe).collect::<Value>(),
        "not_listed": hits.not_listed,
    })
}

/// Draws the rung of a place.
type Draw<'d> = &'d dyn Fn(Location, &mut dyn Write) -> Result<(), Error>;

/// Hits with the rungs they are in, each drawn once.
fn print(
    title: &str,
    hits: &Hits,
    place: &dyn Fn(Location) -> String,
    draw: Option<Draw<'_>>,
    out: &mut dyn Write,
) -> Result<(), Error> {
    if hits.list.is_empty() {
        return Ok(());
    }
    let count = hits.list.len() + hits.not_listed;
    writeln!(Printable(&mut *out), "{title}: {count} found")?;
    let mut drawn = HashSet::new();
    for hit in &hits.list {
        let place = hit.location.map_or_else(|| "-".to_owned(), place);
        let text = hit.text.split_whitespace().collect::<Vec<_>>().join(" ");
        writeln!(Printable(&mut *out), "{place:>8}  {}  {text}", hit.kind)?;
        if let (Some(at), Some(draw)) = (hit.location, draw)
            && drawn.insert((at.file, at.rung))
        {
            draw(at, out)?;
        }
    }
    if hits.not_listed > 0 {
        writeln!(out, "{} more are not listed", hits.not_listed)?;
    }
    Ok(writeln!(out)?)
}

fn describe(hit: &Hit) -> Value {
    json!({
        "rung": hit.location.map(|at| json!({"file": at.file, "rung": at.rung, "instruction": at.instruction})),
        "kind": hit.kind,
        "text": hit.text,
    })
}
