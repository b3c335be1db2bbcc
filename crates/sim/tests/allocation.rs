//! No scan allocates memory: every case of the conformance suite, and with it every instruction, is
//! run with an allocator that counts.

use std::alloc::System;
use std::path::{Path, PathBuf};
use std::time::Duration;

use ladder::{Address, Place, Value};
use sim::scenario::{Assignment, Length, Scenario, Subject, Target, value_for};
use sim::{Machine, Options, Program};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Of the scans of one step.
const MOST_SCANS: u64 = 2_000;

fn scenarios(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            scenarios(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "toml") {
            found.push(path);
        }
    }
}

/// Direct addresses; what only a run can resolve, or the simulator alone has, is left out.
fn address(text: &str) -> Option<Address> {
    let address = Address::parse(text).ok()?;
    let fixed = |place: &Place| matches!(place, Place::Number(_));
    (fixed(&address.file) && fixed(&address.element) && address.bit.as_ref().is_none_or(fixed)).then_some(address)
}

fn machine(scenario: &Scenario) -> Option<Machine> {
    let (Some(Target::Slc(family)), Subject::Inline(routines)) = (scenario.target, &scenario.program) else {
        return None;
    };
    let files = routines.iter().map(|routine| {
        let rungs = convert::slc::rung::parse_rungs(&routine.text, Some(family)).expect("rungs");
        (routine.name.value.parse().expect("a file number"), rungs)
    });
    let image = sim::inline_image(family, files.collect());
    let named = scenario.steps.iter().flat_map(|step| {
        let bits = step.edges.iter().map(|edges| &edges.bit);
        step.set.iter().chain(&step.expect).map(|assignment| &assignment.address).chain(bits)
    });
    let addresses = named.filter_map(|spot| address(&spot.value)).collect();
    let options = Options { inline: true, addresses, ..Options::default() };
    Some(Machine::new(Program::compile(&image, &options).expect("the program compiles")))
}

fn assign(machine: &mut Machine, assignments: &[Assignment]) {
    for assignment in assignments {
        let Some(address) = address(&assignment.address.value) else { continue };
        let present = machine.get(&address).expect("a place");
        machine.set(&address, &value_for(&assignment.value, &present).expect("a value")).expect("a place");
    }
}

/// Allocations of the scans of a scenario, and how many scans there were.
fn run(scenario: &Scenario) -> Option<(usize, u64)> {
    let mut machine = machine(scenario)?;
    if let Some(first) = scenario.steps.first() {
        assign(&mut machine, &first.set);
    }
    machine.enter_run();
    let (mut allocations, mut scans) = (0, 0);
    let mut scan = |machine: &mut Machine, dt: Duration| {
        let region = Region::new(ALLOCATOR);
        machine.scan(dt);
        let change = region.change();
        allocations += change.allocations + change.reallocations;
        scans += 1;
    };
    for step in &scenario.steps {
        if step.program_run {
            machine.enter_program();
            machine.enter_run();
        }
        assign(&mut machine, &step.set);
        if let Some(edges) = &step.edges {
            let bit = address(&edges.bit.value).expect("a bit");
            for _ in 0..edges.count {
                for level in [false, true] {
                    machine.set(&bit, &Value::Bit(level)).expect("a bit");
                    scan(&mut machine, scenario.scan);
                }
            }
        }
        let count = match step.length {
            Length::None => 0,
            Length::Scans(count) => count,
            Length::For(time) => (time.as_nanos() / scenario.scan.as_nanos().max(1)) as u64,
        };
        for _ in 0..count.min(MOST_SCANS) {
            scan(&mut machine, scenario.scan);
        }
    }
    Some((allocations, scans))
}

/// One test, so that no other thread allocates meanwhile.
#[test]
fn no_scan_allocates() {
    let region = Region::new(ALLOCATOR);
    drop(std::hint::black_box(vec![1_u8; 100]));
    assert!(region.change().allocations > 0, "the allocator counts");

    let mut paths = Vec::new();
    scenarios(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../conformance"), &mut paths);
    paths.sort();
    let (mut total, mut guilty) = (0, Vec::new());
    for path in &paths {
        let text = std::fs::read_to_string(path).expect("a readable file");
        let scenario = Scenario::parse(&text).expect("a scenario");
        let Some((allocations, scans)) = run(&scenario) else { continue };
        total += scans;
        if allocations > 0 {
            guilty.push(format!("{}: {allocations} in {scans} scans", path.display()));
        }
    }
    assert!(total > 10_000, "{total} scans");
    assert!(guilty.is_empty(), "{}", guilty.join("\n"));
}
