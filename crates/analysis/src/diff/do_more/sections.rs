//! Documentation and configuration of two Do-more programs.

use std::collections::BTreeMap;

use domore::program::{CodeBlock, Comment, Part, Row};
use domore::{Project, Rung};

use crate::diff::Change;
use crate::diff::configuration::Named;
use crate::diff::logic::Matched;

/// Nicknames, descriptions, comments of rungs. Comments are compared along the matched rungs; those of inserted
/// and deleted rungs come and go with them.
pub(super) fn documentation(old: &Project, new: &Project, matched: &Matched) -> Vec<Change> {
    let mut changes = Vec::new();
    let column = |project: &Project, of: &dyn Fn(&domore::program::ElementDoc) -> String| -> Vec<(String, String)> {
        let filled = project.documentation().map(|entry| (entry.element.clone(), of(entry)));
        filled.filter(|(_, text)| !text.is_empty()).collect()
    };
    type Column = dyn Fn(&domore::program::ElementDoc) -> String;
    let columns: [(&'static str, &Column); 3] = [
        ("nickname", &|entry| entry.nickname.clone()),
        ("description", &|entry| entry.lines().join("\n")),
        ("flags", &|entry| entry.flags.clone().unwrap_or_default()),
    ];
    for (what, of) in columns {
        changes.extend(Named::new(column(old, of), column(new, of)).changes(what, String::clone));
    }
    let blocks = |project| numbered(project).collect::<BTreeMap<u16, &CodeBlock>>();
    let (before, after) = (blocks(old), blocks(new));
    for (a, b) in &matched.rungs {
        let rung = |blocks: &BTreeMap<u16, &'_ CodeBlock>, at: &crate::diff::Place| -> Option<Option<Comment>> {
            let rung: &Rung = blocks.get(&at.file)?.rungs.get(at.rung)?;
            Some(rung.comment.clone())
        };
        let (Some(x), Some(y)) = (rung(&before, a), rung(&after, b)) else { continue };
        if x == y {
            continue;
        }
        let plain = |comment: &Option<Comment>| comment.as_ref().map(|comment| comment.plain_lines().join("\n"));
        let name = format!("{}:{}", after.get(&b.file).map_or("", |block| block.name.as_str()), b.rung + 1);
        let (what, texts) = match (plain(&x), plain(&y)) {
            (p, q) if p != q => ("rung comment", (p, q)),
            // Only how it looks differs.
            _ => {
                let written = |comment: Option<Comment>| {
                    comment.map(|comment| format!("{}\n{}", comment.word(), comment.lines.join("\n")))
                };
                ("rung comment format", (written(x), written(y)))
            }
        };
        changes.push(Change { what, name, old: texts.0, new: texts.1 });
    }
    changes
}

/// Code blocks by their place in the text, from 1.
fn numbered(project: &Project) -> impl Iterator<Item = (u16, &CodeBlock)> {
    (1..=u16::MAX).zip(project.code_blocks())
}

/// Controller, devices, memory, named constants, kinds and order of code blocks, and what is carried unread.
pub(super) fn configuration(old: &Project, new: &Project, matched: &Matched) -> Vec<Change> {
    let mut changes = Vec::new();
    if old.controller() != new.controller() {
        let model = |project: &Project| Some(project.controller().to_owned());
        changes.push(Change { what: "controller", name: "model".into(), old: model(old), new: model(new) });
    }
    for (what, of) in [
        ("device", devices as fn(&Project) -> Vec<(String, String)>),
        ("memory", memory),
        ("named constant", constants),
        ("section", sections),
        ("not read", unread),
    ] {
        changes.extend(Named::new(of(old), of(new)).changes(what, String::clone));
    }
    let (before, after): (BTreeMap<_, _>, BTreeMap<_, _>) = (numbered(old).collect(), numbered(new).collect());
    for (a, b) in &matched.files {
        let (Some(x), Some(y)) = (before.get(a), after.get(b)) else { continue };
        if x.kind != y.kind {
            let kind = |block: &CodeBlock| Some(block.kind.title().to_owned());
            changes.push(Change { what: "code block kind", name: y.name.clone(), old: kind(x), new: kind(y) });
        }
    }
    // Code blocks of both programs, in the order of each: which runs first may matter.
    let mut order = matched.files.clone();
    let name = |blocks: &BTreeMap<u16, &CodeBlock>, number: u16| {
        blocks.get(&number).map_or_else(String::new, |block| block.name.clone())
    };
    order.sort_unstable_by_key(|pair| pair.1);
    if !order.is_sorted_by_key(|pair| pair.0) {
        let names =
            |pairs: &[(u16, u16)]| Some(pairs.iter().map(|pair| name(&after, pair.1)).collect::<Vec<_>>().join("\n"));
        let now = names(&order);
        order.sort_unstable_by_key(|pair| pair.0);
        changes.push(Change { what: "code blocks", name: "order".into(), old: names(&order), new: now });
    }
    changes
}

fn devices(project: &Project) -> Vec<(String, String)> {
    project.devices().map(|device| (device.name.clone(), device.parameters.join(", "))).collect()
}

fn memory(project: &Project) -> Vec<(String, String)> {
    let one = |block: &domore::program::MemoryBlock| {
        let radix = match block.radix {
            Some(domore::program::Radix::Decimal) => ", numbered in decimal",
            Some(domore::program::Radix::Octal) => ", numbered in octal",
            None => "",
        };
        let extra = block.extra.iter().map(|column| format!(", {column}")).collect::<String>();
        (block.name.clone(), format!("{} of {}{radix}{extra}", block.count, block.type_word))
    };
    project.memory().map(one).collect()
}

/// A constant that rungs use changes them too; here it stands by its name.
fn constants(project: &Project) -> Vec<(String, String)> {
    let filled = project.documentation().filter(|entry| !entry.extra.is_empty());
    filled.map(|entry| (entry.element.clone(), entry.extra.clone())).collect()
}

/// Sections that are carried line by line, `SYS_CONFIG` among them.
fn sections(project: &Project) -> Vec<(String, String)> {
    let raw = project.parts.iter().filter_map(|part| match part {
        Part::Raw(section) => Some((section.name.clone(), section.lines.join("\n"))),
        _ => None,
    });
    raw.collect()
}

/// Lines that nobody understood.
fn unread(project: &Project) -> Vec<(String, String)> {
    fn rows<'a, T>(name: &'static str, rows: &'a [Row<T>]) -> impl Iterator<Item = (String, String)> + use<'a, T> {
        rows.iter().filter_map(move |row| match row {
            Row::Unread(line) => Some((format!("line in {name}"), line.text.clone())),
            Row::Entry(_) => None,
        })
    }
    let mut all = Vec::new();
    for part in &project.parts {
        match part {
            Part::Unread(line) => all.push(("line".to_owned(), line.text.clone())),
            Part::Devices(section) => all.extend(rows("DEVICE", &section.rows)),
            Part::Memory(section) => all.extend(rows("MEM_CONFIG", &section.rows)),
            Part::Documentation(section) => all.extend(rows("ELEMENT_DOC", &section.rows)),
            Part::Controller(_) | Part::Raw(_) | Part::Code(_) => {}
        }
    }
    all
}
