//! Symbols, descriptions, comments and titles.

use std::collections::BTreeMap;

use ladder::{Comment, Documentation, Image, Rung, Target};

use super::configuration::Named;
use super::logic::Matched;
use super::{Change, Place};

type Documented<'a> = (&'a Image, &'a Documentation);
type CommentPart = fn(&Comment) -> String;

/// Comments of rungs are compared along the matched rungs: one that only has another number now keeps its
/// comment. Those of inserted and deleted rungs come and go with them.
pub(super) fn compare(old: Documented<'_>, new: Documented<'_>, matched: &Matched) -> Vec<Change> {
    let mut changes = Vec::new();
    let name = String::clone;
    changes.extend(Named::new(symbols(old.1), symbols(new.1)).changes("symbol", name));
    changes.extend(Named::new(descriptions(old.1), descriptions(new.1)).changes("description", name));
    changes.extend(Named::new(under(old.1), under(new.1)).changes("instruction comment", name));
    let rungs = matched.rungs.iter().filter_map(|(a, b)| Some((b, rung(old.0, *a)?, rung(new.0, *b)?)));
    for (at, a, b) in rungs {
        let parts: [(_, CommentPart); 2] = [("page title", |comment| comment.title.clone()), ("rung comment", text)];
        for (what, part) in parts {
            let of = |rung: &Rung| rung.comment.as_ref().map(part).filter(|text| !text.is_empty());
            let (before, after) = (of(a), of(b));
            if before != after {
                changes.push(Change { what, name: format!("{}:{}", at.file, at.rung), old: before, new: after });
            }
        }
    }
    let detached = |documentation: &Documentation| {
        let one = |comment: &Comment| {
            let (title, text) = (&comment.title, text(comment));
            (owner(comment), if title.is_empty() { text } else { format!("{title}\n{text}") })
        };
        documentation.detached_comments.iter().map(one).collect::<Vec<_>>()
    };
    changes.extend(Named::new(detached(old.1), detached(new.1)).changes("comment without a rung", name));
    let became: BTreeMap<u16, u16> = matched.files.iter().copied().collect();
    let files = |image: &Image, became: &BTreeMap<u16, u16>| {
        let of = |number: u16| became.get(&number).copied().unwrap_or(number);
        let filled = image.program_files.iter().filter(|file| !file.description.is_empty());
        filled.map(|file| (of(file.number), file.description.clone())).collect::<Vec<_>>()
    };
    let numbers = Named::new(files(old.0, &became), files(new.0, &BTreeMap::new()));
    changes.extend(numbers.changes("program file description", u16::to_string));
    let tables = |image: &Image| {
        let all = image.data_files.iter().chain(&image.function_files).filter(|file| !file.description.is_empty());
        all.map(|file| (file.label(), file.description.clone())).collect::<Vec<_>>()
    };
    changes.extend(Named::new(tables(old.0), tables(new.0)).changes("data file description", name));
    changes
}

fn rung(image: &Image, at: Place) -> Option<&Rung> {
    image.program_file(at.file)?.rungs.get(at.rung)
}

fn text(comment: &Comment) -> String {
    comment.lines().collect::<Vec<_>>().join("\n")
}

fn owner(comment: &Comment) -> String {
    match &comment.owner {
        ladder::CommentOwner::Rung { file, rung } => format!("{file}:{rung}"),
        ladder::CommentOwner::Address(target) => target.to_string(),
    }
}

/// Descriptions of files are compared with the files.
fn entries(documentation: &Documentation) -> impl Iterator<Item = &ladder::AddressEntry> {
    let of_file = |target: &Target| matches!(target, Target::ProgramFile(_) | Target::DataFile(_));
    documentation.entries().iter().filter(move |entry| !of_file(&entry.target))
}

fn symbols(documentation: &Documentation) -> Vec<(String, String)> {
    let filled = entries(documentation).filter(|entry| !entry.symbol.is_empty());
    let named = filled.map(|entry| match entry.target {
        // Without an address the symbol itself is all there is.
        Target::Unassigned => (format!("(no address) {}", entry.symbol), entry.symbol.clone()),
        _ => (entry.target.to_string(), entry.symbol.clone()),
    });
    named.collect()
}

fn descriptions(documentation: &Documentation) -> Vec<(String, String)> {
    let filled = entries(documentation).filter(|entry| !entry.description.is_empty());
    let named = filled.map(|entry| {
        let name = match entry.target {
            Target::Unassigned => format!("(no address) {}", entry.symbol),
            _ => entry.target.to_string(),
        };
        (name, entry.description.join("\n"))
    });
    named.collect()
}

fn under(documentation: &Documentation) -> Vec<(String, String)> {
    let all = documentation.instruction_comments().iter();
    all.map(|comment| {
        let target = comment.target.as_ref().map_or_else(|| "(address gone)".to_owned(), Target::to_string);
        (format!("{} {target}", comment.mnemonic), comment.lines.join("\n"))
    })
    .collect()
}
