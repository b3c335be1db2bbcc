//! Whether a proof run sees a converted program that does not do the same: every kind of single mistake, in
//! the program a migration makes of each proven example.

mod migrated;
#[path = "mutants/mutate.rs"]
mod mutate;

use std::collections::{BTreeMap, BTreeSet};

use analysis::proof::{Options, Verdict, prove_domore};
use migrated::Migrated;

/// Mutants of each program in the normal test run, which leaves the corpus to the nightly one.
const FEW: usize = 25;

/// How many mutants of each program, and scans a mutant has to be found in.
fn effort() -> (usize, u64) {
    match std::env::var("RUNGS_MUTANTS").ok().and_then(|text| text.parse().ok()) {
        Some(count) => (count, 100_000),
        None => (FEW, 10_000),
    }
}

#[test]
fn mutants_are_reported_as_different() {
    let (count, scans) = effort();
    // Found, equivalent by argument, not exercised by the run (which lists it), in the frame around the
    // program, missed.
    let mut table: BTreeMap<mutate::Kind, [usize; 5]> = BTreeMap::new();
    let mut lines = Vec::new();
    for program in migrated::proven(count > FEW) {
        let base = prove(&program, &program.project, scans);
        assert_ne!(base.verdict(), Verdict::Different, "{}: {base}", program.name);
        let open: BTreeSet<_> = base.other_missing.iter().copied().collect();
        let all = mutate::all(&program.project);
        assert!(all.len() >= 200, "{}: only {} mutants", program.name, all.len());
        // Spread over the whole program.
        let wanted = count.min(all.len());
        for (index, mutant) in all.iter().enumerate() {
            if index * wanted / all.len() == (index + 1) * wanted / all.len() {
                continue;
            }
            let column = match prove(&program, &mutant.project, scans).verdict() {
                Verdict::Different => 0,
                // Refused by the engine, or an address beyond its block: no controller would load it.
                Verdict::NotComparable => continue,
                Verdict::NoDifference if mutate::is_equivalent(mutant, &program.project) => 1,
                Verdict::NoDifference if is_open(mutant, &open) => 2,
                Verdict::NoDifference if !mutant.converted => 3,
                Verdict::NoDifference => 4,
            };
            table.entry(mutant.kind).or_default()[column] += 1;
            if column > 0 {
                let why = ["", "equivalent", "not exercised", "frame", "missed"][column];
                lines.push(format!("{why}: {}: {:?} {}", program.name, mutant.kind, mutant.what));
            }
        }
    }
    lines.iter().for_each(|line| println!("{line}"));
    let heads = ["found", "equivalent", "not exercised", "frame", "missed"];
    println!("{:20} {}", "mutation", heads.map(|head| format!("{head:>14}")).concat());
    for (kind, row) in &table {
        println!("{:20} {}", format!("{kind:?}"), row.map(|count| format!("{count:>14}")).concat());
    }
    let sum = |column: usize| table.values().map(|row| row[column]).sum::<usize>();
    let sums = [0, 1, 2, 3, 4].map(sum);
    println!("{:20} {}", "all", sums.map(|count| format!("{count:>14}")).concat());
    let [found, _, _, _, missed] = sums;
    assert!(missed * 100 <= (found + missed) * MOST_MISSED, "{missed} mutants were missed, {found} found");
}

/// Percent of the mutants of converted, exercised rungs that may be missed: see docs/proof.md for which those
/// are.
const MOST_MISSED: usize = 15;

/// The run itself says that it has not seen what was mutated do anything.
fn is_open(mutant: &mutate::Mutant, open: &BTreeSet<(usize, usize, usize)>) -> bool {
    let (block, rung, instruction) = mutant.place;
    match instruction {
        Some(instruction) => open.contains(&(block, rung, instruction)),
        None => open.iter().any(|spot| (spot.0, spot.1) == (block, rung)),
    }
}

fn prove(program: &Migrated, project: &domore::Project, scans: u64) -> analysis::proof::Report {
    let options = Options { scans, minimize: false, ..Options::default() };
    prove_domore(&program.image, project, &program.map, Some(&program.fates), &options)
}
