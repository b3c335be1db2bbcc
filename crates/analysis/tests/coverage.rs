//! How much of the rung conditions proof runs reach of our examples and of the programs that must be proven.

mod migrated;

use analysis::proof::{Options, prove_domore};

/// Percent of the rung conditions that can be reached.
const LEAST: f64 = 95.0;

#[test]
fn proof_runs_reach_the_conditions_of_rungs() {
    let scans = std::env::var("RUNGS_SCANS").ok().and_then(|text| text.parse().ok());
    let mut missed = Vec::new();
    for program in migrated::proven(true) {
        // The slow ones scan whole loops, or count for a thousand scans before something happens.
        let usual = match program.name.as_str() {
            "lecky_demo_tof_loop.RSS" => 3_000,
            "3_pump_sequencing.RSS" => 60_000,
            _ => 15_000,
        };
        let options = Options { scans: scans.unwrap_or(usual), minimize: false, ..Options::default() };
        let report = prove_domore(&program.image, &program.project, &program.map, Some(&program.fates), &options);
        let covered = report.conditions_covered();
        let argued = report.impossible_goals().filter(|goal| goal.kind.is_rung_condition()).count();
        let percent = covered.reached as f64 * 100.0 / covered.all.max(1) as f64;
        println!("{:<38} {covered}, {argued} impossible, {}", program.name, report.verdict().as_str());
        if report.found.is_some() || percent < LEAST {
            missed.push(format!("{}: {covered}", program.name));
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
}
