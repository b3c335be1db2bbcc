//! `rungs xref` of a Do-more project.

use std::io::Write;

use domore::documentation::Documentation;
use domore::instruction::Role;
use domore::xref::{Access, Area, CrossReference, OneSided};
use serde_json::{Value, json};

use super::OpenedDomore;
use crate::commands::one_line;
use crate::output::{Columns, Error, Outcome};

/// A text that was asked for, or an element of the program, and what touches it.
struct Group<'x> {
    name: String,
    accesses: Vec<&'x Access>,
}

pub fn xref(
    opened: &OpenedDomore,
    wanted: &[String],
    only_findings: bool,
    json: bool,
    out: &mut dyn Write,
) -> Result<Outcome, Error> {
    let project = &opened.document.project;
    let xref = CrossReference::build(project).map_err(|error| Error::Use(format!("{}: {error}", opened.name())))?;
    let documentation = Documentation::new(project);
    let mut outcome = Outcome::Done;
    let mut groups = Vec::new();
    for text in wanted {
        let accesses = xref.area(text).map(|area| (xref.touching(&area), area));
        match accesses {
            // What stands for nothing in memory is only known by being used.
            None => {}
            Some((accesses, Area::Name(_))) if accesses.is_empty() && project.code_block(text).is_none() => {}
            Some((accesses, _)) => {
                groups.push(Group { name: text.clone(), accesses });
                continue;
            }
        }
        eprintln!("{}: `{text}` is no element, nickname or code block of this program", opened.name());
        outcome = Outcome::Finding;
    }
    let asked = !wanted.is_empty();
    if !asked && !xref.is_listable() {
        eprintln!("{}: so many ranges that accesses through them are shown for single elements only", opened.name());
        outcome = Outcome::Finding;
    }
    let all = || {
        xref.elements().map(|name| Group { name: name.to_owned(), accesses: xref.of_element(name) }).filter(|group| {
            // A nickname for a constant, and the like.
            !group.accesses.is_empty()
        })
    };
    if json {
        let describe = |group: &Group<'_>| {
            let shown = documentation.shown(&group.name);
            json!({
                "address": group.name, "nickname": shown.name, "description": one_line(shown.description),
                "accesses": group.accesses.iter().map(|access| access_json(access)).collect::<Value>(),
            })
        };
        let addresses: Value = match (only_findings, asked) {
            (true, _) => Value::Array(Vec::new()),
            (_, true) => groups.iter().map(describe).collect(),
            (_, false) => all().map(|group| describe(&group)).collect(),
        };
        let unresolved: Value = xref.unresolved().iter().map(unresolved_json).collect();
        let findings: Value = if asked {
            Value::Array(Vec::new())
        } else {
            all().filter_map(|g| finding(&g).map(|f| json!({"finding": f, "address": g.name}))).collect()
        };
        let document =
            json!({"file": opened.name(), "addresses": addresses, "findings": findings, "unresolved": unresolved});
        opened.write_json(document, out)?;
        return Ok(outcome);
    }
    writeln!(out, "{}", opened.name())?;
    if asked {
        groups.iter().try_for_each(|group| print_group(group, &documentation, out))?;
        return Ok(outcome);
    }
    if !only_findings {
        all().try_for_each(|group| print_group(&group, &documentation, out))?;
    }
    let mut table = Columns::new(&["Finding", "Address", "Nickname", "Rungs"]);
    for group in all() {
        if let Some(finding) = finding(&group) {
            let name = documentation.shown(&group.name).name.into_owned();
            let places: Vec<String> = group.accesses.iter().map(|access| place(access)).collect();
            table.row([finding.to_owned(), group.name.clone(), name, places.join(", ")]);
        }
    }
    if !table.is_empty() {
        writeln!(out, "\nWorth a look")?;
        table.write(out, "  ")?;
    }
    for it in xref.unresolved() {
        writeln!(out, "{}:{}  {} {}: expected {}", it.code_block, it.rung, it.mnemonic, it.operand, it.why)?;
    }
    Ok(outcome)
}

fn finding(group: &Group<'_>) -> Option<&'static str> {
    OneSided::of(&group.name, &group.accesses).map(OneSided::as_str)
}

fn place(access: &Access) -> String {
    if access.code_block.is_empty() {
        access.rung.to_string()
    } else {
        format!("{}:{}", access.code_block, access.rung)
    }
}

fn print_group(group: &Group<'_>, documentation: &Documentation<'_>, out: &mut dyn Write) -> Result<(), Error> {
    let shown = documentation.shown(&group.name);
    let parts = [shown.name.into_owned(), one_line(shown.description)];
    let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    writeln!(out, "{}  {}", group.name, parts.join("  -  "))?;
    let mut table = Columns::new(&["Rung", "Does", "Instruction", "Operand", "Through"]);
    for access in &group.accesses {
        table.row([
            place(access),
            access.does(),
            access.mnemonic.clone(),
            access.written.clone(),
            access.through.as_str().to_owned(),
        ]);
    }
    if table.is_empty() {
        writeln!(out, "    no instruction reads or writes it")?;
    } else {
        table.write(out, "    ")?;
    }
    Ok(())
}

fn access_json(access: &Access) -> Value {
    json!({
        "code_block": access.code_block, "rung": access.rung, "line": access.line, "mnemonic": access.mnemonic,
        "operand": access.written, "role": access.role.map_or("unknown", Role::as_str),
        "certainty": if access.may { "may" } else { "definite" }, "through": access.through.as_str(),
    })
}

fn unresolved_json(it: &domore::xref::Unresolved) -> Value {
    json!({
        "code_block": it.code_block, "rung": it.rung, "mnemonic": it.mnemonic, "operand": it.operand,
        "expected": it.why,
    })
}
