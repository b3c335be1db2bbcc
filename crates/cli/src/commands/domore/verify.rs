//! `rungs verify` of a Do-more project: reads and writes back the same, every rung balances.

use std::io::Write;

use convert::designer::to_bytes;
use domore::instruction::{Evidence, by_mnemonic};
use ladder::Severity;
use serde_json::{Value, json};

use super::OpenedDomore;
use crate::output::{Error, Outcome};

pub fn verify(opened: &OpenedDomore, bytes: &[u8], json: bool, out: &mut dyn Write) -> Result<Outcome, Error> {
    let project = &opened.document.project;
    let roundtrip = to_bytes(project) == bytes;
    let rungs: usize = project.code_blocks().map(|block| block.rungs.len()).sum();
    let found = &opened.document.diagnostics;
    // A rung can have several findings.
    let mut unbalanced: Vec<_> =
        found.iter().filter(|it| it.problem.severity() == Severity::Error).filter_map(|it| it.rung.as_ref()).collect();
    unbalanced.sort_unstable();
    unbalanced.dedup();
    let all = || project.code_blocks().flat_map(|block| &block.rungs).flat_map(|rung| &rung.instructions);
    let total = all().count();
    let of = |wanted: &dyn Fn(Option<Evidence>) -> bool| {
        all().filter(|it| wanted(by_mnemonic(&it.mnemonic).map(|entry| entry.evidence))).count()
    };
    let confirmed = of(&|evidence| evidence.is_some_and(Evidence::is_confirmed));
    let unknown = of(&|evidence| evidence.is_none());
    if json {
        opened.write_json(
            json!({
                "file": opened.name(), "dialect": "do-more", "bytes": bytes.len(), "roundtrip": roundtrip,
                "code_blocks": project.code_blocks().count(), "rungs": rungs,
                "balanced": rungs - unbalanced.len(),
                "unbalanced": unbalanced.iter().map(|(block, rung)| json!({"code_block": block, "rung": rung})).collect::<Value>(),
                "instructions": total, "instructions_confirmed": confirmed, "instructions_unknown": unknown,
            }),
            out,
        )?;
    } else {
        writeln!(out, "{}", opened.name())?;
        let back = if roundtrip { "gives the same bytes back" } else { "DOES NOT give the same bytes back" };
        writeln!(out, "  Do-more text of {} bytes; writing it {back}", bytes.len())?;
        writeln!(out, "  {} of {rungs} rungs balance on the stack of conditions", rungs - unbalanced.len())?;
        writeln!(
            out,
            "  {confirmed} of {total} instructions have a form that Designer wrote or read, {} a form that is inferred; {unknown} are not known",
            total - confirmed - unknown
        )?;
    }
    let outcome = if roundtrip && unbalanced.is_empty() { Outcome::Done } else { Outcome::Finding };
    Ok(outcome.max(opened.outcome()))
}
