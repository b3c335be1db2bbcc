//! Every project of the corpus loads and runs.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use sim::{Machine, Options, Program, Unsupported};

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod place;

/// Reasons without the addresses and numbers in them, so that they can be counted.
fn kind(text: &str) -> String {
    text.split(' ')
        .map(|word| if word.contains(|c: char| c.is_ascii_digit()) { "#" } else { word })
        .collect::<Vec<_>>()
        .join(" ")
}

#[test]
fn every_project_runs() {
    let Some(folder) = place::root() else { return };
    let scans: u32 = std::env::var("RUNGS_SCANS").ok().and_then(|text| text.parse().ok()).unwrap_or(300);
    let mut approximated: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    let mut refused: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    let mut classes: BTreeMap<&str, usize> = BTreeMap::new();
    let (mut programs, mut clean, mut instructions) = (0, 0, 0u64);
    let mut faults: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut busy = Duration::ZERO;
    for path in place::files(&folder, ".rss").expect("the corpus can be listed") {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let bytes = std::fs::read(&path).expect("readable file");
        let Ok(file) = rss::Project::read(&bytes, rss::Mode::Permissive) else {
            println!("{name}: not a project");
            continue;
        };
        let project = convert::from_rss::project(&file, ladder::Source::default());
        if project.main.ladder_files().next().is_none() {
            println!("{name}: no ladder");
            continue;
        }
        programs += 1;
        let class = project.main.processor.family.id();
        *classes.entry(class).or_default() += 1;
        let strict = Program::compile(&project.main, &Options::default());
        let program = match strict {
            Ok(program) => {
                clean += 1;
                program
            }
            Err(refusals) => {
                let mut seen = std::collections::BTreeSet::new();
                for refusal in &refusals {
                    let mnemonic = refusal.site.as_ref().map_or("", |s| s.text.split(' ').next().unwrap_or(""));
                    let reason = format!("{class}, {mnemonic}: {}", kind(&refusal.why));
                    let entry = refused.entry(reason.clone()).or_default();
                    entry.0 += 1;
                    if seen.insert(reason) {
                        entry.1 += 1;
                    }
                    if std::env::var_os("RUNGS_REFUSALS").is_some() {
                        println!("{name}: {refusal}");
                    }
                }
                let options = Options { unsupported: Unsupported::Fault, ..Options::default() };
                Program::compile(&project.main, &options).expect("loads with unsupported instructions as faults")
            }
        };
        let mut seen = std::collections::BTreeSet::new();
        for approximation in program.approximations() {
            let mnemonic = approximation.site.as_ref().map_or("", |s| s.text.split(' ').next().unwrap_or(""));
            let reason = format!("{class}, {mnemonic}: {}", kind(&approximation.why));
            let entry = approximated.entry(reason.clone()).or_default();
            entry.0 += 1;
            if seen.insert(reason) {
                entry.1 += 1;
            }
        }
        let mut machine = Machine::new(program);
        machine.enter_run();
        let start = Instant::now();
        machine.scan(Duration::ZERO);
        for _ in 1..scans {
            machine.scan(Duration::from_millis(10));
        }
        busy += start.elapsed();
        instructions += machine.instructions();
        if let Some(fault) = machine.fault() {
            faults.entry(kind(&fault.to_string())).or_default().push(format!("{name}: {fault}"));
        }
    }
    println!(
        "{programs} programs, {clean} without refusal, {scans} scans each, {instructions} instructions in {busy:?}"
    );
    println!("{classes:?}");
    for (reason, (count, projects)) in &refused {
        println!("refused {count:5} in {projects:3}: {reason}");
    }
    for (reason, (count, projects)) in &approximated {
        println!("approximated {count:5} in {projects:3}: {reason}");
    }
    for (fault, sites) in &faults {
        println!("{} x {fault}", sites.len());
        for site in sites {
            println!("   {site}");
        }
    }
}
