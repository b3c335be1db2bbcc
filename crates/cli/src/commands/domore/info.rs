//! `rungs info` of a Do-more project.

use std::io::Write;

use domore::figures::Figures;
use domore::program::{MemoryBlock, Radix};
use serde_json::{Value, json};

use super::OpenedDomore;
use crate::output::{Columns, Error};

fn radix(block: &MemoryBlock) -> &'static str {
    block.radix.map_or("", Radix::as_str)
}

pub fn info(opened: &OpenedDomore, json: bool, out: &mut dyn Write) -> Result<(), Error> {
    if json { opened.write_json(describe(opened), out) } else { print(opened, out) }
}

fn describe(opened: &OpenedDomore) -> Value {
    let (source, project) = (&opened.document.source, &opened.document.project);
    let figures = Figures::of(project);
    json!({
        "file": opened.name(),
        "sha256": source.sha256,
        "bytes": source.bytes,
        "processor": {"family": "do-more", "name": project.controller()},
        "devices": project.devices().map(|device| json!({"name": device.name, "parameters": device.parameters}))
            .collect::<Value>(),
        "memory": project.memory().map(|block| json!({
            "name": block.name, "type": block.type_word, "radix": radix(block), "count": block.count,
            "extra": block.extra,
        })).collect::<Value>(),
        "code_blocks": project.code_blocks().map(|block| json!({
            "kind": block.kind.title(), "name": block.name, "rungs": block.rungs.len(),
            "instructions": block.instructions(), "stages": block.stages(),
        })).collect::<Value>(),
        "sections": project.carried().map(|(name, lines)| json!({"name": name, "lines": lines})).collect::<Value>(),
        "instructions": figures.instructions,
        "unknown_instructions": figures.unknown,
        "documentation": {
            "entries": figures.documented,
            "nicknames": figures.nicknames,
            "rungs": figures.rungs,
            "rungs_with_comment": figures.commented,
        },
    })
}

fn print(opened: &OpenedDomore, out: &mut dyn Write) -> Result<(), Error> {
    let project = &opened.document.project;
    let figures = Figures::of(project);
    writeln!(out, "{}", opened.name())?;
    let controller = match project.controller() {
        "" => "not named",
        model => model,
    };
    writeln!(out, "  Controller        {controller}  (Do-more)")?;
    let mut blocks = Columns::new(&["Name", "Kind", "Rungs", "Instructions", "Stages"]);
    for block in project.code_blocks() {
        blocks.row([
            block.name.clone(),
            block.kind.title().to_owned(),
            block.rungs.len().to_string(),
            block.instructions().to_string(),
            block.stages().to_string(),
        ]);
    }
    section(out, "Code blocks", &blocks)?;
    let mut memory = Columns::new(&["Name", "Type", "Count", "Numbers", "Further columns"]);
    for block in project.memory() {
        let extra = block.extra.join(" ");
        memory.row([block.name.clone(), block.type_word.clone(), block.count_text(), radix(block).to_owned(), extra]);
    }
    section(out, "Memory", &memory)?;
    let mut devices = Columns::new(&["Device", "Parameters"]);
    for device in project.devices() {
        devices.row([device.name.clone(), device.parameters.join(", ")]);
    }
    section(out, "Devices", &devices)?;
    writeln!(
        out,
        "\n  Documentation: {} elements, {} with a nickname; {} of {} rungs have a comment",
        figures.documented, figures.nicknames, figures.commented, figures.rungs
    )?;
    for (name, lines) in project.carried() {
        writeln!(out, "  Section {name}: {lines} lines, carried untouched")?;
    }
    if !figures.unknown.is_empty() {
        let list: Vec<String> = figures.unknown.iter().map(|(name, count)| format!("{name} ({count})")).collect();
        writeln!(out, "  Instructions that are not known, carried with their operands: {}", list.join(", "))?;
    }
    Ok(())
}

fn section(out: &mut dyn Write, title: &str, table: &Columns) -> Result<(), Error> {
    if table.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n  {title}")?;
    Ok(table.write(out, "    ")?)
}
