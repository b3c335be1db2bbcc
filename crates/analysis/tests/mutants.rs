//! Whether a proof run sees a converted program that does not do the same: every kind of single mistake, in
//! the program a migration makes of each proven example.

#[path = "mutants/mutate.rs"]
mod mutate;
mod support;

use std::collections::BTreeMap;

use analysis::proof::{Options, Verdict, prove_domore};
use support::Migrated;

/// How many mutants of each program, and scans a mutant has to be found in.
fn effort() -> (usize, u64) {
    match std::env::var("RUNGS_MUTANTS").ok().and_then(|text| text.parse().ok()) {
        Some(count) => (count, 200_000),
        None => (25, 20_000),
    }
}

/// Why a mutant cannot be told from the program: rules about the text of the mutation, each with its
/// argument.
const EQUIVALENT: &[(&str, &str)] = &[];

#[test]
fn mutants_are_reported_as_different() {
    let (count, scans) = effort();
    let mut table: BTreeMap<mutate::Kind, [usize; 3]> = BTreeMap::new();
    let mut survivors = Vec::new();
    for program in support::proven() {
        let all = mutate::all(&program.project);
        assert!(all.len() >= 200, "{}: only {} mutants", program.name, all.len());
        // Spread over the whole program; the stride is odd so that kinds do not fall into step with it.
        let wanted = count.min(all.len());
        let mut tried = 0;
        for index in 0..all.len() {
            if tried >= wanted || index * wanted / all.len() == (index + 1) * wanted / all.len() {
                continue;
            }
            let mutant = &all[index];
            let Some(found) = is_found(&program, mutant, scans) else { continue };
            tried += 1;
            let argued = EQUIVALENT.iter().any(|(part, _)| mutant.what.contains(part));
            let row = table.entry(mutant.kind).or_default();
            match (found, argued) {
                (true, _) => row[0] += 1,
                (false, true) => row[1] += 1,
                (false, false) => {
                    row[2] += 1;
                    survivors.push(format!("{}: {:?} {}", program.name, mutant.kind, mutant.what));
                }
            }
        }
    }
    let sum = |column: usize| table.values().map(|row| row[column]).sum::<usize>();
    let (killed, alive) = (sum(0), sum(2));
    println!("{:20} {:>8} {:>10} {:>8}", "mutation", "found", "equivalent", "missed");
    for (kind, row) in &table {
        println!("{:20} {:>8} {:>10} {:>8}", format!("{kind:?}"), row[0], row[1], row[2]);
    }
    println!("{:20} {killed:>8} {:>10} {alive:>8}", "all", sum(1));
    survivors.iter().for_each(|line| println!("missed: {line}"));
    assert!(alive * 100 <= killed + alive, "{alive} of {} mutants were not seen", killed + alive);
}

/// Whether the run reports a mutant; `None` for one that no controller would load.
fn is_found(program: &Migrated, mutant: &mutate::Mutant, scans: u64) -> Option<bool> {
    let options = Options { scans, minimize: false, ..Options::default() };
    let report = prove_domore(&program.image, &mutant.project, &program.map, Some(&program.fates), &options);
    match report.verdict() {
        Verdict::Different => Some(true),
        Verdict::NoDifference => Some(false),
        // Refused by the engine, or an address beyond its block.
        Verdict::NotComparable => None,
    }
}
