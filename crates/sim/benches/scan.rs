//! Cost of a scan: `cargo bench -p sim`. Ratios against the same ladder as C (`gcc -O2`) and in pyrung
//! are taken in one run, so that the machine cancels out.

mod rivals;

use std::alloc::System;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use ladder::{Address, FileType, Value};
use sim::{Machine, Options, Program, Unsupported};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

use rivals::{MIX, SCANS_PER_INPUT, checksum, next_input};

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod place;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// How pyrung runs a program; its compiled form serves to replay what such a run recorded.
const RUNNER: &str = "runner";

const STEP: Duration = Duration::from_millis(10);

/// Stretches of scans of which the fastest counts.
const STRETCHES: u64 = 200;

/// What a stretch of scans cost.
#[derive(Clone, Copy)]
struct Cost {
    scans: u64,
    instructions: u64,
    time: Duration,
    allocations: usize,
}

impl Cost {
    fn per_instruction(&self) -> f64 {
        self.time.as_nanos() as f64 / self.instructions.max(1) as f64
    }

    fn per_scan(&self) -> f64 {
        self.time.as_nanos() as f64 / self.scans.max(1) as f64
    }

    fn print(&self, name: &str) {
        println!(
            "{name:28} {:>8} instructions/scan {:>10.0} scans/s {:>7.2} ns/instruction {:>4} allocations",
            self.instructions / self.scans.max(1),
            1e9 / self.per_scan().max(1e-9),
            self.per_instruction(),
            self.allocations
        );
    }
}

/// Runs `scans` scans; every eighth sees other inputs, unless there are none to change.
fn run(machine: &mut Machine, inputs: &[Address], scans: u64) -> Cost {
    let before = machine.instructions();
    let region = Region::new(ALLOCATOR);
    let start = Instant::now();
    let mut word = 1;
    for scan in 0..scans {
        if scan % SCANS_PER_INPUT == 0 {
            for input in inputs {
                word = next_input(word);
                machine.set(input, &Value::Word(word as i16)).expect("an input");
            }
        }
        std::hint::black_box(machine.scan(STEP));
    }
    let time = start.elapsed();
    let allocations = region.change().allocations;
    Cost { scans, instructions: machine.instructions() - before, time, allocations }
}

/// The best of many short stretches, so that what else the machine does counts little.
fn best(machine: &mut Machine, inputs: &[Address], scans: u64) -> Cost {
    let stretch = (scans / STRETCHES).max(SCANS_PER_INPUT);
    run(machine, inputs, stretch);
    let costs: Vec<Cost> = (0..STRETCHES).map(|_| run(machine, inputs, stretch)).collect();
    let allocations = costs.iter().map(|cost| cost.allocations).sum();
    let fastest = costs.into_iter().min_by(|a, b| a.per_instruction().total_cmp(&b.per_instruction()));
    Cost { allocations, ..fastest.expect("stretches") }
}

fn project(path: &Path) -> Option<(Machine, Vec<Address>)> {
    let file = rss::Project::read(&std::fs::read(path).ok()?, rss::Mode::Permissive).ok()?;
    let image = convert::from_rss::project(&file, ladder::Source::default()).main;
    let options = Options { unsupported: Unsupported::Fault, ..Options::default() };
    let mut machine = Machine::new(Program::compile(&image, &options).ok()?);
    machine.enter_run();
    let words = (0..32).filter_map(|word| image.io.address_of(FileType::I, word));
    let inputs = words.filter(|address| machine.kind(address).is_ok()).collect();
    Some((machine, inputs))
}

/// A project with its inputs at rest, then with inputs that change; the worse of the two.
fn measure(path: &Path, scans: u64) -> Option<f64> {
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let (mut machine, inputs) = project(path)?;
    let resting = best(&mut machine, &[], scans);
    resting.print(&name);
    let moving = best(&mut machine, &inputs, scans);
    if let Some(fault) = machine.fault() {
        println!("{name}, inputs change: arbitrary inputs end in {fault}");
        return Some(resting.per_instruction());
    }
    moving.print(&format!("{name}, inputs change"));
    Some(resting.per_instruction().max(moving.per_instruction()))
}

fn goal(what: &str, found: f64, reached: bool) {
    println!("goal: {what}: {found:.2}, {}", if reached { "reached" } else { "MISSED" });
}

fn main() {
    let home = Path::new(env!("CARGO_MANIFEST_DIR"));
    if let Some(cost) = place::root().and_then(|corpus| measure(&corpus.join("acd/LANLOGIX_BR.RSS"), 6000)) {
        goal("LANLOGIX_BR at most 10 ns per executed instruction", cost, cost <= 10.0);
    }
    for name in ["motor", "traffic_light", "batch"] {
        measure(&home.join(format!("../../examples/{name}/{name}.RSS")), 100_000);
    }

    let input = [Address::parse("I:0").expect("an address")];
    let table: Vec<Cost> =
        [100, 1_000, 10_000].map(|rungs| best(&mut rivals::machine(rungs), &input, 20_000_000 / rungs as u64)).into();
    for (cost, rungs) in table.iter().zip([100, 1_000, 10_000]) {
        cost.print(&format!("{rungs} rungs"));
    }
    if let [small, .., large] = table[..] {
        println!("10000 rungs cost {:.1} times as much as 100", large.per_scan() / small.per_scan());
    }

    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    for rungs in [100, 1_000] {
        against_c(&folder, rungs, &input);
    }
    against_pyrung(&folder, &input);
}

fn against_c(folder: &Path, rungs: usize, input: &[Address]) {
    let scans = 20_000_000 / rungs as u64;
    let mut machine = rivals::machine(rungs);
    let cost = run(&mut machine, input, scans);
    let sum = checksum(&machine, rungs.div_ceil(MIX.len()));
    match rivals::c::run(folder, rungs, scans) {
        Ok((time, expected)) => println!(
            "{rungs} rungs, gcc -O2           {:>7.2} ns/instruction; rungs takes {:.1} times as long; data {}",
            time.as_nanos() as f64 / cost.instructions.max(1) as f64,
            cost.time.as_secs_f64() / time.as_secs_f64().max(1e-9),
            if sum == expected { "equal" } else { "DIFFERENT" }
        ),
        Err(why) => println!("skipped: comparison with C: {why}"),
    }
}

fn against_pyrung(folder: &Path, input: &[Address]) {
    let rungs = 500;
    let cost = best(&mut rivals::machine(rungs), input, 20_000);
    let scans = 40;
    match rivals::pyrung::run(folder, rungs, scans) {
        Ok(times) => {
            for (name, time) in [RUNNER, "compiled replay"].iter().zip(times) {
                let per_scan = time.as_nanos() as f64 / scans as f64;
                let ratio = per_scan / cost.per_scan();
                let instructions = cost.instructions as f64 / cost.scans.max(1) as f64;
                println!(
                    "{rungs} rungs, pyrung's {name:16} {:>8.0} ns/instruction; rungs is {ratio:.0} times as fast",
                    per_scan / instructions
                );
                if *name == RUNNER {
                    goal("at least 200 times the speed of pyrung", ratio, ratio >= 200.0);
                }
            }
        }
        Err(why) => println!("skipped: comparison with pyrung: {why}"),
    }
}
