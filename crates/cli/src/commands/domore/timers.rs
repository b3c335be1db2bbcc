//! `rungs timers` of a Do-more project: every timer and counter that an instruction owns.

use std::io::Write;

use domore::address::{Constant, Number};
use domore::documentation::Documentation;
use domore::instruction::{Kind, Role, by_mnemonic};
use domore::xref::{Access, CrossReference};
use domore::{CodeBlock, Instruction};
use serde_json::{Value, json};

use super::OpenedDomore;
use crate::commands::one_line;
use crate::output::{Columns, Error, Outcome, Printable};

/// An instruction that times or counts.
struct Owner<'p> {
    block: &'p CodeBlock,
    /// From 1.
    rung: usize,
    instruction: &'p Instruction,
    is_timer: bool,
    /// The structure as written.
    element: &'p str,
}

impl Owner<'_> {
    fn place(&self) -> String {
        format!("{}:{}", self.block.name, self.rung)
    }

    /// The operand that the table calls preset, delay or time.
    fn preset(&self) -> Option<&str> {
        let entry = by_mnemonic(&self.instruction.mnemonic)?;
        let is = |name: &str| matches!(name, "Preset" | "Delay" | "Time" | "On time" | "Off time");
        let index = entry.operands.iter().position(|operand| is(operand.name))?;
        self.instruction.operands.get(index).map(String::as_str)
    }
}

/// Seconds of a preset in milliseconds: a number, or a named constant.
fn seconds(preset: &str, documentation: &Documentation<'_>) -> Option<String> {
    let named = documentation.nickname(preset).map(|entry| entry.extra.trim()).filter(|text| !text.is_empty());
    match Constant::parse(named.unwrap_or(preset))?.value {
        Number::Integer(ms) if ms >= 0 => {
            let text = format!("{}.{:03}", ms / 1000, ms % 1000);
            Some(text.trim_end_matches('0').trim_end_matches('.').to_owned())
        }
        _ => None,
    }
}

fn owners(opened: &OpenedDomore) -> Vec<Owner<'_>> {
    let mut all = Vec::new();
    for block in opened.document.project.code_blocks() {
        for (rung, content) in (1..).zip(&block.rungs) {
            for instruction in &content.instructions {
                let Some(entry) = by_mnemonic(&instruction.mnemonic) else { continue };
                let own = entry.operands.iter().zip(&instruction.operands).find(|(operand, _)| {
                    operand.role == Role::Own && matches!(operand.kind, Kind::Timer | Kind::Counter)
                });
                if let Some((operand, element)) = own {
                    all.push(Owner { block, rung, instruction, is_timer: operand.kind == Kind::Timer, element });
                }
            }
        }
    }
    all
}

pub fn timers(opened: &OpenedDomore, wanted: &[String], json: bool, out: &mut dyn Write) -> Result<Outcome, Error> {
    let project = &opened.document.project;
    let xref = CrossReference::build(project).map_err(|error| Error::Use(format!("{}: {error}", opened.name())))?;
    let documentation = Documentation::new(project);
    let named = |owner: &Owner<'_>, text: &str| {
        owner.element.eq_ignore_ascii_case(text) || documentation.shown(owner.element).name.eq_ignore_ascii_case(text)
    };
    let all = owners(opened);
    let chosen: Vec<&Owner<'_>> =
        all.iter().filter(|owner| wanted.is_empty() || wanted.iter().any(|text| named(owner, text))).collect();
    let mut outcome = Outcome::Done;
    for text in wanted.iter().filter(|text| !all.iter().any(|owner| named(owner, text))) {
        eprintln!("{}: no instruction of this program times or counts with `{text}`", opened.name());
        outcome = Outcome::Finding;
    }
    let accesses = |owner: &Owner<'_>| match xref.area(owner.element) {
        Some(area) if xref.is_listable() => xref.touching(&area),
        _ => Vec::new(),
    };
    if json {
        let rows: Value = chosen.iter().map(|owner| row(owner, &accesses(owner), &documentation)).collect();
        opened.write_json(json!({"file": opened.name(), "timers": rows}), out)?;
        return Ok(outcome);
    }
    let out = &mut Printable(out);
    writeln!(out, "{}", opened.name())?;
    for (is_timer, title) in [(true, "Timers"), (false, "Counters")] {
        let mut table = Columns::new(&["Element", "Kind", "Preset", "Seconds", "Rung", "Nickname"]);
        for owner in chosen.iter().filter(|owner| owner.is_timer == is_timer) {
            let preset = owner.preset().unwrap_or_default();
            let shown = documentation.shown(owner.element);
            let name = if shown.name.is_empty() { one_line(shown.description) } else { shown.name.into_owned() };
            let seconds = if is_timer { seconds(preset, &documentation) } else { None };
            let kind = owner.instruction.mnemonic.clone();
            table.row([
                owner.element.to_owned(),
                kind,
                preset.to_owned(),
                seconds.unwrap_or_default(),
                owner.place(),
                name,
            ]);
            for (what, places) in uses(&accesses(owner)) {
                table.note(&format!("{what} {places}"));
            }
        }
        if !table.is_empty() {
            writeln!(out, "\n{title}")?;
            table.write(out, "  ")?;
        }
    }
    if chosen.is_empty() && wanted.is_empty() {
        writeln!(out, "  no instruction times or counts")?;
    }
    if !xref.is_listable() {
        writeln!(
            out,
            "\nSo many ranges overlap that reads and resets are not listed; `rungs xref` shows single elements."
        )?;
    }
    Ok(outcome)
}

/// Rungs by what they do with the element, its owner left out.
fn uses(accesses: &[&Access]) -> Vec<(&'static str, String)> {
    let of = |is: &dyn Fn(Option<Role>) -> bool| {
        let mut places: Vec<String> = accesses
            .iter()
            .filter(|access| is(access.role))
            .map(|access| {
                let member = access.written.find('.').map_or("", |at| access.written.get(at..).unwrap_or_default());
                format!("{}:{}{}{}", access.code_block, access.rung, if member.is_empty() { "" } else { " " }, member)
            })
            .collect();
        places.dedup();
        places.join(", ")
    };
    let all = [
        ("read in", of(&|role| role == Some(Role::Read))),
        ("reset in", of(&|role| role == Some(Role::Reset))),
        ("written in", of(&|role| matches!(role, Some(Role::Write | Role::ReadWrite)))),
        ("used by an unknown instruction in", of(&|role| role.is_none())),
    ];
    all.into_iter().filter(|(_, places)| !places.is_empty()).collect()
}

fn row(owner: &Owner<'_>, accesses: &[&Access], documentation: &Documentation<'_>) -> Value {
    let shown = documentation.shown(owner.element);
    let preset = owner.preset();
    let list = |is: &dyn Fn(Option<Role>) -> bool| -> Value {
        let rows = accesses.iter().filter(|access| is(access.role)).map(|access| {
            json!({
                "code_block": access.code_block, "rung": access.rung, "mnemonic": access.mnemonic,
                "operand": access.written, "certainty": if access.may { "may" } else { "definite" },
            })
        });
        rows.collect()
    };
    json!({
        "address": owner.element,
        "type": if owner.is_timer { "timer" } else { "counter" },
        "mnemonic": owner.instruction.mnemonic,
        "code_block": owner.block.name,
        "rung": owner.rung,
        "preset": preset,
        "preset_seconds": preset.filter(|_| owner.is_timer).and_then(|preset| seconds(preset, documentation)),
        "nickname": shown.name,
        "description": shown.description,
        "read_by": list(&|role| role == Some(Role::Read)),
        "reset_by": list(&|role| role == Some(Role::Reset)),
        "written_by": list(&|role| matches!(role, Some(Role::Write | Role::ReadWrite))),
    })
}
