//! Do-more projects as JSON documents of the schema `rungs.domore/1`.
//!
//! A document is for other tools to read; [`super::to_bytes`] gives the project itself. Everything a
//! person sees of the project is in it; lines that could not be read stand under `unread`.

use std::io::{self, Write};

use domore::instruction::by_mnemonic;
use domore::program::{Part, RawSection, Row, Section, Unread};
use domore::{CodeBlock, CodeKind, Rung};
use serde_json::{Value, json};

use super::Document;

/// The schema of the documents this module writes.
pub const SCHEMA: &str = "rungs.domore/1";

/// Writes a project as a JSON document, each code block as a value of its own.
///
/// # Errors
/// Only those of `writer`.
pub fn write_json(document: &Document, mut writer: impl Write) -> io::Result<()> {
    let (source, project) = (&document.source, &document.project);
    let head = json!({
        "file": source.file,
        "sha256": source.sha256,
        "bytes": source.bytes,
    });
    write!(writer, "{{\"schema\":\"{SCHEMA}\",\n \"source\":{head},\n")?;
    writeln!(writer, " \"controller\":{},", json!(project.controller()))?;
    let devices = project.devices().map(|device| json!({"name": device.name, "parameters": device.parameters}));
    list(&mut writer, "devices", devices)?;
    let memory = project.memory().map(|block| {
        json!({
            "name": block.name,
            "type": block.type_word,
            "radix": block.radix.map(|radix| match radix {
                domore::program::Radix::Decimal => "decimal",
                domore::program::Radix::Octal => "octal",
            }),
            "count": block.count,
            "extra": block.extra,
        })
    });
    list(&mut writer, "memory", memory)?;
    write!(writer, " \"code_blocks\":[")?;
    for (index, block) in project.code_blocks().enumerate() {
        write!(writer, "{}\n  ", if index > 0 { "," } else { "" })?;
        code_block(&mut writer, block)?;
    }
    writeln!(writer, "],")?;
    let documentation = project.documentation().map(|entry| {
        json!({
            "element": entry.element,
            "nickname": entry.nickname,
            "description": entry.lines(),
            "extra": entry.extra,
            "flags": entry.flags,
        })
    });
    list(&mut writer, "documentation", documentation)?;
    let raw = project.parts.iter().filter_map(|part| match part {
        Part::Raw(RawSection { name, lines, .. }) => Some(json!({"name": name, "lines": lines})),
        _ => None,
    });
    list(&mut writer, "sections", raw)?;
    list(&mut writer, "unread", project.parts.iter().flat_map(unread))?;
    let diagnostics = document.diagnostics.iter().map(|found| {
        json!({
            "severity": found.problem.severity().as_str(),
            "line": found.line,
            "column": found.column,
            "code_block": found.rung.as_ref().map(|(block, _)| block),
            "rung": found.rung.as_ref().map(|(_, rung)| rung),
            "message": found.problem.to_string(),
        })
    });
    write!(writer, " \"diagnostics\":")?;
    values(&mut writer, diagnostics)?;
    writeln!(writer, "}}")
}

fn list(writer: &mut impl Write, name: &str, items: impl Iterator<Item = Value>) -> io::Result<()> {
    write!(writer, " {}:", json!(name))?;
    values(writer, items)?;
    writeln!(writer, ",")
}

/// An array, one value per line.
fn values(writer: &mut impl Write, items: impl Iterator<Item = Value>) -> io::Result<()> {
    write!(writer, "[")?;
    for (index, item) in items.enumerate() {
        write!(writer, "{}\n  {item}", if index > 0 { "," } else { "" })?;
    }
    write!(writer, "]")
}

fn code_block(writer: &mut impl Write, block: &CodeBlock) -> io::Result<()> {
    let kind = match &block.kind {
        CodeKind::Program => "program",
        CodeKind::Subroutine => "subroutine",
        CodeKind::Task => "task",
        CodeKind::Interrupt => "interrupt",
        CodeKind::Bare => "none",
        CodeKind::Other { begin, .. } => begin,
    };
    write!(writer, "{{\"kind\":{},\"name\":{},\"rungs\":[", json!(kind), json!(block.name))?;
    for (index, rung) in block.rungs.iter().enumerate() {
        write!(writer, "{}\n   {}", if index > 0 { "," } else { "" }, rung_value(index + 1, rung))?;
    }
    write!(writer, "]}}")
}

/// A rung: `comment` as plain text, `instructions` in the order of the text. Operands are spelled as in
/// the text, quotes included. `known` is false for an instruction whose operands nobody decoded.
fn rung_value(number: usize, rung: &Rung) -> Value {
    let instructions = rung.instructions.iter().map(|instruction| {
        json!({
            "mnemonic": instruction.mnemonic,
            "operands": instruction.operands,
            "known": by_mnemonic(&instruction.mnemonic).is_some(),
        })
    });
    json!({
        "number": number,
        "line": rung.line(),
        "comment": rung.comment.as_ref().map(|comment| json!({
            "form": comment.word(),
            "text": comment.plain_lines().join("\n"),
            "lines": comment.lines,
        })),
        "instructions": instructions.collect::<Value>(),
    })
}

/// Lines that could not be read.
fn unread(part: &Part) -> Vec<Value> {
    fn of<T>(section: &Section<T>, name: &str) -> Vec<Value> {
        let one = |row: &Row<T>| match row {
            Row::Unread(unread) => Some(value(unread, name)),
            Row::Entry(_) => None,
        };
        section.rows.iter().filter_map(one).collect()
    }
    fn value(unread: &Unread, section: &str) -> Value {
        json!({"line": unread.origin.line(), "section": section, "text": unread.text})
    }
    match part {
        Part::Unread(unread) => vec![value(unread, "")],
        Part::Devices(section) => of(section, "DEVICE"),
        Part::Memory(section) => of(section, "MEM_CONFIG"),
        Part::Documentation(section) => of(section, "ELEMENT_DOC"),
        _ => Vec::new(),
    }
}
