//! How much of the rung conditions proof runs reach of our examples and of the programs that must be proven.

#[allow(dead_code)]
mod migrated;

use analysis::proof::{Options, prove_domore};
use migrated::Migrated;

/// Programs of the corpus besides those whose mutants are tried.
const FURTHER: [&str; 5] = [
    "PLC_2s_lamp_flash/sti_1000ms_live.RSS",
    "PLC/TRAFFIC_LIGHT_BAK017.RSS",
    "PLC/TRAFFIC_LIGHT_SEQUENCER_BAK017.RSS",
    "PLC/TRAFFIC_LIGHT_STOP_BAK015.RSS",
    "PLC_reject_timing/lecky_demo_tof_loop.RSS",
];

/// Percent of the rung conditions that can be reached.
const LEAST: f64 = 95.0;

#[test]
fn proof_runs_reach_the_conditions_of_rungs() {
    let scans = std::env::var("RUNGS_SCANS").ok().and_then(|text| text.parse().ok());
    let mut all = migrated::proven(true);
    if let Some(corpus) = migrated::corpus() {
        all.extend(FURTHER.iter().map(|path| Migrated::of(&corpus.join(path))));
    }
    let mut missed = Vec::new();
    for program in all {
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
