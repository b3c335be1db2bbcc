//! Whether a proof run sees a converted program that does not do the same: every kind of single mistake, in
//! the program a migration makes of each proven example. What it does not see must be shown equivalent.

#[path = "mutants/agree.rs"]
mod agree;
#[path = "mutants/argued.rs"]
mod argued;
#[path = "../../../tests/src/dice.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod dice;
#[path = "mutants/facts.rs"]
mod facts;
#[path = "mutants/gates.rs"]
mod gates;
#[path = "mutants/meet.rs"]
mod meet;
mod migrated;
#[path = "mutants/mutate.rs"]
mod mutate;
#[path = "mutants/outside.rs"]
mod outside;
#[path = "mutants/relations.rs"]
mod relations;
#[path = "mutants/same.rs"]
mod same;
#[path = "mutants/scan.rs"]
mod scan;
#[path = "mutants/words.rs"]
mod words;

use std::collections::BTreeMap;

use analysis::proof::{Options, Report, Verdict, fates, prove_domore};
use domore::{Instruction, Part, Project};
use migrated::Migrated;
use mutate::Mutant;
use same::{Judge, Same};

/// Mutants of each program in the normal test run, which leaves the corpus to the nightly one.
const FEW: usize = 25;

/// How many mutants of each program, and scans a mutant has to be found in.
fn effort() -> (usize, u64) {
    match std::env::var("RUNGS_MUTANTS").ok().and_then(|text| text.parse().ok()) {
        Some(count) => (count, 400_000),
        None => (FEW, 40_000),
    }
}

/// Scans of a run that is followed by a longer one.
const LONG: u64 = 400_000;

const HEADS: [&str; 7] = ["found", "unchanged", "helpers", "related", "argued", "refused", "unexplained"];

/// The column of those that no controller would load.
const REFUSED: usize = 5;

/// Counts by [`HEADS`].
type Row = [usize; 7];

#[test]
fn mutants_are_reported_as_different() {
    let (count, scans) = effort();
    let (mut kinds, mut programs): (BTreeMap<String, Row>, BTreeMap<String, Row>) = Default::default();
    let mut open = Vec::new();
    // To look at a few again.
    let only = std::env::var("RUNGS_MUTANT").unwrap_or_default();
    for program in migrated::proven(count > FEW) {
        let base = prove(&program, &program.project, scans.min(100_000));
        assert_ne!(base.verdict(), Verdict::Different, "{}: {base}", program.name);
        let mut judge = Judge::new(&program.project, &base.scope);
        let all = mutate::all(&program.project);
        argued::check(&program.name, &all, &base.scope);
        let wanted = |mutant: &&Mutant| only.is_empty() || only.lines().any(|text| mutant.what.contains(text));
        let mut loaded = 0;
        for mutant in spread(&all, count).filter(wanted) {
            if loaded == count {
                break;
            }
            let column = try_one(&program, mutant, scans, &mut judge);
            loaded += usize::from(column != REFUSED);
            if column == HEADS.len() - 1 {
                open.push(format!("{}: {:?} {}", program.name, mutant.kind, mutant.what));
            }
            kinds.entry(format!("{:?}", mutant.kind)).or_default()[column] += 1;
            programs.entry(program.name.clone()).or_default()[column] += 1;
        }
        assert!(loaded == count || !only.is_empty(), "{}: only {loaded} mutants load", program.name);
        println!("{}: {:?}", program.name, programs.get(&program.name));
    }
    let mut sum = Row::default();
    programs.values().for_each(|row| sum.iter_mut().zip(row).for_each(|(sum, count)| *sum += count));
    println!("{:34}{}", "", HEADS.map(|head| format!("{head:>12}")).concat());
    for (name, row) in kinds.iter().chain(&programs).chain([(&"all".to_owned(), &sum)]) {
        println!("{name:34}{}", row.map(|count| format!("{count:>12}")).concat());
    }
    for (name, row) in &programs {
        let (found, unexplained) = (row[0], row[6]);
        // Of few mutants one may be left that only a long run finds.
        let most = usize::from(count == FEW);
        assert!(
            unexplained <= most,
            "{name}: {unexplained} mutants are neither found, {found} are, nor shown equivalent: {open:#?}"
        );
    }
}

/// All mutants, in front so many from all over the program: those that no controller would load are made good for by
/// later ones.
fn spread(all: &[Mutant], count: usize) -> impl Iterator<Item = &Mutant> {
    let wanted = count.min(all.len());
    let is_chosen = |index: &usize| index * wanted / all.len() != (index + 1) * wanted / all.len();
    let (mut order, rest): (Vec<usize>, Vec<usize>) = (0..all.len()).partition(is_chosen);
    // From all over the program again: in steps that have no part in common with their number.
    let common = |mut a: usize, mut b: usize| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let step = (rest.len() * 5 / 8..).find(|step| common(*step, rest.len()) <= 1).unwrap_or(1);
    order.extend((0..rest.len()).map(|index| rest[index * step % rest.len()]));
    order.into_iter().map(|index| &all[index])
}

/// The column of a mutant.
fn try_one(program: &Migrated, mutant: &Mutant, scans: u64, judge: &mut Judge<'_>) -> usize {
    let mut answer = Same::Open("not asked".to_owned());
    // A short run finds most of them; what cannot be found needs no long one.
    for (scans, thorough) in [(scans / 20, false), (scans, true)] {
        match prove(program, &mutant.project, scans).verdict() {
            Verdict::Different => {
                let argument = argued::argument(&program.name, mutant);
                assert!(argument.is_none(), "the run shows what an argument excludes: {argument:?}");
                return 0;
            }
            // Refused by the engine, or an address beyond its block: no controller would load it.
            Verdict::NotComparable => return REFUSED,
            Verdict::NoDifference => answer = judge.ask(mutant, thorough),
        }
        match answer {
            Same::Yes { helpers: 0, related: false } => return 1,
            Same::Yes { related: false, .. } => return 2,
            Same::Yes { .. } => return 3,
            _ => {}
        }
    }
    if argued::argument(&program.name, mutant).is_some() {
        return 4;
    }
    // Some show only behind a time that few runs take.
    if scans >= LONG && prove(program, &mutant.project, 4 * scans).verdict() == Verdict::Different {
        return 0;
    }
    let why = judge.why(&answer);
    println!("unexplained: {}: {:?} {} at {:?} -- {why}", program.name, mutant.kind, mutant.what, mutant.place);
    6
}

fn prove(program: &Migrated, project: &Project, scans: u64) -> Report {
    let options = Options { scans, minimize: false, ..Options::default() };
    prove_domore(&program.image, project, &program.map, Some(&program.fates), &options)
}

#[test]
fn no_rung_goes_missing_silently() {
    // That nothing stands for a rung is told without a scan. A call that is left out shows in what the called
    // rungs do not do.
    let short = Options { scans: 5, minimize: false, ..Options::default() };
    let long = Options { scans: effort().1, ..short.clone() };
    for program in migrated::proven(effort().0 > FEW) {
        let mut tried = 0;
        for (part, block) in program.project.parts.iter().enumerate() {
            let Part::Code(code) = block else { continue };
            for (number, rung) in code.rungs.iter().enumerate() {
                let mut lines = rung.comment.iter().flat_map(|comment| &comment.lines);
                if !lines.any(|line| line.starts_with("SLC ")) || rung.instructions.iter().all(|it| it.is("NOP")) {
                    continue;
                }
                // With its mark, and its mark alone kept.
                for keeps_mark in [false, true] {
                    let mut project = program.project.clone();
                    if let Some(Part::Code(code)) = project.parts.get_mut(part) {
                        if keeps_mark {
                            code.rungs[number].instructions = vec![Instruction::new("NOP", [""; 0])];
                        } else {
                            code.rungs.remove(number);
                        }
                    }
                    let fates = fates(&project);
                    let differs = |options: &Options| {
                        let report = prove_domore(&program.image, &project, &program.map, fates.as_deref(), options);
                        report.verdict() == Verdict::Different
                    };
                    let what = format!("{}: {} rung {}", program.name, code.name, number + 1);
                    assert!(differs(&short) || differs(&long), "{what}, mark kept: {keeps_mark}");
                    tried += 1;
                }
            }
        }
        assert!(tried >= 4, "{}: only {tried} rungs left out", program.name);
    }
}

#[test]
fn what_is_followed_is_what_the_engine_does() {
    let thorough = effort().0 > FEW;
    let (count, scans) = if thorough { (40, 400) } else { (2, 30) };
    for program in migrated::proven(thorough || !cfg!(debug_assertions)) {
        let scope = prove(&program, &program.project, 2).scope;
        let all = mutate::all(&program.project);
        let mutants: Vec<&Mutant> = spread(&all, count).take(count).collect();
        let compared = agree::compare((&program.name, &program.project), &scope, &mutants, (scans, thorough));
        let (told, said) = compared.unwrap_or_else(|why| panic!("{}: {why}", program.name));
        println!("{}: {told} scans, {said} bits by formulas", program.name);
        assert!(told > 50 && said > 3_000, "{}: only {told} scans and {said} bits compared", program.name);
    }
}
