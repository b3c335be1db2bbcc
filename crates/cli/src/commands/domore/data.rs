//! `rungs data` of a Do-more project: its memory. The text holds no values.

use std::io::Write;

use domore::memory::{Map, Retention};
use domore::program::Radix;
use serde_json::{Value, json};

use super::OpenedDomore;
use crate::output::{Columns, Error, Outcome, Printable};

pub fn data(opened: &OpenedDomore, wanted: &[String], json: bool, out: &mut dyn Write) -> Result<Outcome, Error> {
    let project = &opened.document.project;
    let map = Map::new(project).map_err(|error| Error::Use(format!("{}: {error}", opened.name())))?;
    let mut outcome = Outcome::Done;
    for text in wanted.iter().filter(|text| map.block(text).is_none()) {
        eprintln!("{}: `{text}` is no memory block, and a Do-more text holds no values of elements", opened.name());
        outcome = Outcome::Finding;
    }
    let declared = |name: &str| project.memory().any(|block| block.name.eq_ignore_ascii_case(name));
    let chosen: Vec<_> = map
        .blocks()
        .iter()
        .filter(|block| match wanted {
            [] => declared(&block.name),
            wanted => wanted.iter().any(|text| text.eq_ignore_ascii_case(&block.name)),
        })
        .collect();
    let kept = |retention| match retention {
        Retention::None => "no",
        Retention::All => "yes",
    };
    let kind = |name: &str| {
        let line = project.memory().find(|block| block.name.eq_ignore_ascii_case(name));
        line.map_or_else(|| "(as every project has it)".to_owned(), |block| block.type_word.clone())
    };
    if json {
        let one = |block: &&domore::memory::Block| {
            json!({
                "name": block.name, "type": kind(&block.name), "count": block.count,
                "numbers": if block.radix == Radix::Octal { "octal" } else { "decimal" },
                "retentive": block.retention == Retention::All,
            })
        };
        let memory: Value = chosen.iter().map(one).collect();
        let document = json!({"file": opened.name(), "memory": memory, "values": [], "notes": map.notes});
        opened.write_json(document, out)?;
        return Ok(outcome);
    }
    let out = &mut Printable(out);
    writeln!(out, "{}", opened.name())?;
    let mut table = Columns::new(&["Block", "Type", "Elements", "Numbers", "Kept over power off"]);
    for block in &chosen {
        let (count, numbers) = match block.radix {
            Radix::Octal => (format!("{:o}", block.count), "octal"),
            Radix::Decimal => (block.count.to_string(), "decimal"),
        };
        table.row([block.name.clone(), kind(&block.name), count, numbers.to_owned(), kept(block.retention).to_owned()]);
    }
    if table.is_empty() && wanted.is_empty() {
        writeln!(out, "  it declares no memory of its own")?;
    } else {
        table.write(out, "  ")?;
    }
    for note in &map.notes {
        writeln!(out, "  {note}")?;
    }
    writeln!(
        out,
        "\n  The text holds no values: a program sets its initial values in rungs that run in the first scan."
    )?;
    Ok(outcome)
}
