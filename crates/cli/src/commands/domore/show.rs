//! `rungs show` of a Do-more project.

use std::io::Write;

use domore::CodeBlock;
use domore::documentation::Documentation;
use serde_json::{Value, json};

use super::OpenedDomore;
use crate::args::ShowArguments;
use crate::output::{Error, Outcome};

pub fn show(
    opened: &OpenedDomore,
    arguments: &ShowArguments,
    style: &render::Style,
    out: &mut dyn Write,
) -> Result<Outcome, Error> {
    let project = &opened.document.project;
    let mut outcome = Outcome::Done;
    if !arguments.program_files.is_empty() {
        eprintln!("{}: code blocks have names, not numbers: use --block NAME", opened.name());
        outcome = Outcome::Finding;
    }
    for name in &arguments.blocks {
        if project.code_block(name).is_none() {
            eprintln!("{}: there is no code block {name}", opened.name());
            outcome = Outcome::Finding;
        }
    }
    let wanted = &arguments.blocks;
    let none = !arguments.program_files.is_empty() && wanted.is_empty();
    let chosen: Vec<&CodeBlock> =
        project.code_blocks().filter(|block| !none && (wanted.is_empty() || wanted.contains(&block.name))).collect();
    for block in &chosen {
        if arguments.rung.is_some_and(|range| range.first > block.rungs.len()) {
            eprintln!("{}: code block {} has rungs 1 to {}", opened.name(), block.name, block.rungs.len());
            outcome = Outcome::Finding;
        }
    }
    if arguments.input.json {
        let blocks: Value = chosen.iter().map(|block| describe(block, arguments)).collect();
        opened.write_json(json!({"file": opened.name(), "code_blocks": blocks}), out)?;
        return Ok(outcome);
    }
    writeln!(out, "{}\n", opened.name())?;
    let documentation = Documentation::new(project);
    for block in chosen {
        // Designer counts rungs from 1.
        let range = arguments.rung.map(|range| range.first.saturating_sub(1)..=range.last.saturating_sub(1));
        if range.as_ref().is_some_and(|range| *range.start() >= block.rungs.len()) {
            continue;
        }
        render::domore::code_block(&mut *out, block, range, &documentation, style)?;
        writeln!(out)?;
    }
    Ok(outcome)
}

fn describe(block: &CodeBlock, arguments: &ShowArguments) -> Value {
    let wanted = |number: &usize| arguments.rung.is_none_or(|range| (range.first..=range.last).contains(number));
    let rungs = (1..).zip(&block.rungs).filter(|(number, _)| wanted(number)).map(|(number, rung)| {
        let text: Vec<String> = rung.instructions.iter().map(ToString::to_string).collect();
        json!({
            "number": number,
            "line": rung.line(),
            "comment": rung.comment.as_ref().map(|comment| comment.plain_lines().join("\n")),
            "text": text.join("\n"),
        })
    });
    json!({"kind": block.kind.title(), "name": block.name, "rungs": rungs.collect::<Value>()})
}
