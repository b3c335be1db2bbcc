//! Scan pairs per second of a proof run on a program of 100 rungs: `cargo bench -p analysis --bench proof`.
//! The baseline is the same two machines scanned in turn with nothing compared or watched, in the same run.

#[path = "../tests/rungs/mod.rs"]
mod rungs;

use std::time::{Duration, Instant};

use analysis::proof::{DoMore, Mapping, Options, Side, Slc, prove_domore};
use ladder::{FileType, Image};

/// What the run must reach on a 2-core virtual machine.
const WANTED: f64 = 100_000.0;

const SCANS: u64 = 200_000;

/// Contacts, latches, timers, counters, comparisons and arithmetic in the mix of a packaging line.
fn hundred_rungs() -> Image {
    let mut image = rungs::motor();
    let base = ladder::TimeBase::from_text("0.01").expect("a time base").control_bits();
    for (file_type, number) in [(FileType::B, 3), (FileType::T, 4), (FileType::C, 5), (FileType::N, 7)] {
        image.data_files.retain(|file| file.file_type != file_type);
        let mut file = ladder::DataFile::new(file_type, number, 20);
        for element in 0..20u16 {
            let words = match file_type {
                FileType::T => [base, 50 + 10 * element],
                FileType::C => [0, 30],
                _ => continue,
            };
            for (offset, word) in words.into_iter().enumerate() {
                if let Some(place) = file.words.get_mut(3 * usize::from(element) + offset) {
                    *place = word;
                }
            }
        }
        image.data_files.push(file);
    }
    let mut rungs = Vec::new();
    for n in 0..20 {
        let next = (n + 1) % 16;
        rungs.push(format!("BST XIC I:0.0/{} NXB XIC B3:{n}/0 BND XIO I:0.0/{next} OTE B3:{n}/0", n % 16));
        rungs.push(format!("XIC B3:{n}/0 XIO B3:{n}/3 TON T4:{n} 0.01 {} 0", 50 + 10 * n));
        rungs.push(format!("XIC T4:{n}/DN BST OTE O:0.0/{} NXB OTE B3:{n}/3 BND", n % 16));
        rungs.push(format!("XIC B3:{n}/3 CTU C5:{n} 30 0"));
        rungs.push(format!("XIC B3:{n}/0 GEQ C5:{n}.ACC 10 BST MOV {n} N7:{n} NXB OTL B3:{n}/5 BND"));
    }
    rungs::with(image, &rungs)
}

fn main() {
    let image = hundred_rungs();
    let migration = convert::migrate::migrate(&image, &[], &Default::default()).expect("no map to be wrong");
    let rows = migration.map.iter().filter(|row| row.places_data());
    let map: Vec<Mapping> =
        rows.map(|row| Mapping { original: row.slc.clone(), words: row.words, other: row.domore.clone() }).collect();

    let program = sim::Program::compile(&image, &sim::Options::default()).expect("compiles");
    let other = domore::engine::Program::compile(&migration.project, &Default::default()).expect("compiles");
    let (mut a, mut b) = (Slc { machine: sim::Machine::new(program) }, DoMore::new(other));
    a.enter_run();
    b.enter_run();
    let started = Instant::now();
    for _ in 0..SCANS {
        a.scan(Duration::from_millis(10));
        b.scan(Duration::from_millis(10));
    }
    let bare = SCANS as f64 / started.elapsed().as_secs_f64();

    let started = Instant::now();
    let options = Options { scans: SCANS, without_marks: true, ..Options::default() };
    let report = prove_domore(&image, &migration.project, &map, None, &options);
    let proof = report.scans as f64 / started.elapsed().as_secs_f64();
    println!("{} rungs, {} words compared, {}", migration.rungs.len(), report.compared, report.verdict().as_str());
    println!("both machines alone      {bare:>12.0} scan pairs/s");
    println!("proof run                {proof:>12.0} scan pairs/s, {:.2} of the time alone", bare / proof);
    println!("conditions reached       {}", report.conditions_covered());
    if proof < WANTED {
        println!("below the {WANTED:.0} that are wanted");
        std::process::exit(1);
    }
}
