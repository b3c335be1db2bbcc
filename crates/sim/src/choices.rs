//! Readings of open questions, each switchable where two are possible.
//!
//! The list itself stands beside the instruction semantics, because the pure functions follow it too.

pub use instr::exec::choices::{Choice, Choices, LIST, Row};

/// The page of switchable readings in Markdown: what `docs/semantics-choices.md` holds.
pub fn markdown() -> String {
    let mut page = String::from(
        "<!-- Written from the list of choices in `crates/instr/src/exec` by a test of `crates/sim`; run it with \
         RUNGS_BLESS=1. -->\n\n# Readings where documentation ends\n\n\
         The manuals of these processors leave questions open. Each row is one: the reading the simulator\n\
         takes, the one it can be switched to, and why the default is the default.\n\n\
         | name | default | switched | reason |\n|---|---|---|---|\n",
    );
    for row in LIST {
        page.push_str(&format!("| `{}` | {} | {} | {} |\n", row.name, row.default, row.switched, row.reason));
    }
    page
}
