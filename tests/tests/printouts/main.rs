//! The model against what RSLogix printed: lists, values, documentation, rungs and branches.
//!
//! The witness is always the printout. Each report is compared with every image (offline and
//! online copy, automatic save) of the projects that may be its source, and must agree completely with the best
//! one; a row that does not is an exception and stands in [`exceptions`] with its reason.
//! Run with `--nocapture` to see the figures.

mod documentation;
mod exceptions;
mod faces;
mod lists;
mod outcome;
mod pair;
mod rungs;
mod status;
mod values;

use outcome::Outcome;
use pair::Pair;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Compares one part of a report with an image.
type Compare = fn(&Pair<'_>) -> Outcome;

/// What is compared, in the order of a report.
const ASPECTS: &[(&str, Compare)] = &[
    ("processor", lists::processor),
    ("memory", lists::memory),
    ("io", lists::io),
    ("channels", lists::channels),
    ("program files", lists::program_files),
    ("data files", lists::data_files),
    ("values", values::values),
    ("status", status::status),
    ("symbols", documentation::symbols),
    ("comments", documentation::comments),
    ("rungs", rungs::rungs),
    ("displayed", rungs::displayed),
    ("labels", faces::labels),
    ("boxes", faces::boxes),
    ("points", faces::points),
    ("operands", faces::operands),
    ("highlights", faces::highlights),
];

#[test]
fn projects_agree_with_their_printouts() {
    let Some(root) = rungs_tests::corpus::root() else { return };
    let reports = pair::reports(&root);
    assert!(!reports.is_empty(), "a corpus without printouts");
    let mut totals: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    let mut faults = String::new();
    let mut used = Vec::new();
    for report in &reports {
        let Some((pair, outcomes)) = pair::best(report) else {
            let _ = writeln!(faults, "{}: no project beside it can be read", report.name);
            continue;
        };
        println!("{} <- {} ({})", report.name, pair.project, pair.image_name);
        for (aspect, outcome) in outcomes {
            let total = totals.entry(aspect).or_default();
            total.0 += outcome.rows - outcome.wrong.len();
            total.1 += outcome.rows;
            if outcome.wrong.is_empty() {
                continue;
            }
            let (allowed, reason) = exceptions::reason(&report.name, aspect).unwrap_or((0, "no exception"));
            println!("    {aspect}: {} of {} rows differ: {reason}", outcome.wrong.len(), outcome.rows);
            if outcome.wrong.len() <= allowed {
                used.push((report.name.clone(), aspect));
                continue;
            }
            for line in outcome.wrong.iter().take(12) {
                let _ = writeln!(faults, "{} {aspect}: {line}", report.name);
            }
        }
    }
    for (aspect, _) in ASPECTS {
        let (right, rows) = totals.get(aspect).copied().unwrap_or_default();
        println!("{aspect}: {right} of {rows} rows agree");
        if rows == 0 {
            let _ = writeln!(faults, "{aspect}: nothing was compared");
        }
    }
    let status = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/status.md"));
    for (report, aspect) in exceptions::all() {
        if status.as_ref().is_ok_and(|text| !text.contains(report)) {
            let _ = writeln!(faults, "docs/status.md does not name {report}");
        }
        let is_used = used.iter().any(|(name, other)| name.contains(report) && *other == aspect);
        if !is_used {
            let _ = writeln!(faults, "exception for {report}, {aspect} is not needed");
        }
    }
    assert!(faults.is_empty(), "{faults}");
}

/// A hand-made listing of addresses, symbols and descriptions. Its descriptions are worded
/// differently here and there (RSLogix's own report sides with the project), so they do not count.
#[test]
fn the_tag_dictionary_agrees_with_its_project() {
    let Some(root) = rungs_tests::corpus::root() else { return };
    for (rows, project) in pair::tags(&root) {
        let entries = project.main.documentation.entries();
        let known = |address: &str, symbol: &str| {
            entries.iter().any(|e| documentation::spelled(&e.target) == address && e.symbol == symbol)
        };
        let missing: Vec<_> = rows.iter().filter(|row| !known(&row.address, &row.symbol)).collect();
        println!("{} of {} tags are in the project", rows.len() - missing.len(), rows.len());
        assert!(!rows.is_empty() && missing.is_empty(), "{missing:?}");
    }
}
