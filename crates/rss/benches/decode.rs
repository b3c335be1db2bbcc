//! Decoding against inflating: `cargo bench -p rss`. Ratios are taken in one run, so that the machine cancels out.
//!
//! "Inflate" opens every envelope; "decode" does the same and reads every record.
//! Synthetic programs of 1, 10 and 100 times the size show how cost grows.

use rss::program::{Instruction, Item, LadFile, Leg, ProgramFiles, Rung, mark};
use rss::verify::read_stream;
use rss::{ImageKind, Mode, Project, StreamKind, Text, serialize};
use std::borrow::Cow;
use std::path::PathBuf;
use std::time::{Duration, Instant};

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod place;

/// Inflates every stream, and reads its record if asked to.
fn run(projects: &[Project], records: bool) -> Duration {
    // Clones, because a project keeps the payloads it has inflated.
    let fresh = projects.to_vec();
    let start = Instant::now();
    for project in &fresh {
        for stream in project.streams() {
            std::hint::black_box(stream.payload());
            if records {
                std::hint::black_box(read_stream(stream));
            }
        }
    }
    start.elapsed()
}

fn report(name: &str, projects: &[Project], runs: usize) {
    let best = |records| (0..runs).map(|_| run(projects, records)).min().unwrap_or_default();
    let (inflate, decode) = (best(false), best(true));
    println!("{name:24} inflate {inflate:>10.1?}  decode {decode:>10.1?}  ratio {:.2}", ratio(decode, inflate));
}

fn ratio(a: Duration, b: Duration) -> f64 {
    a.as_secs_f64() / b.as_secs_f64().max(1e-9)
}

fn corpus() -> Vec<PathBuf> {
    place::root().map_or_else(Vec::new, |root| place::files(&root, ".rss").expect("the corpus can be listed"))
}

/// A program of `rungs` rungs with three instructions each.
fn synthetic(rungs: usize) -> Project {
    let instruction = |opcode: u16, operand: &'static str, code: &'static [u8]| {
        Item::Instruction(Instruction {
            operands: (!operand.is_empty()).then(|| Text::from_bytes(operand.as_bytes())).into_iter().collect(),
            has_code: u16::from(!code.is_empty()),
            opcode,
            code: Cow::Borrowed(code),
            ..Instruction::default()
        })
    };
    let items = vec![
        instruction(mark::RUNG_START, "", &[]),
        instruction(0x39, "B3:0/15", &[0x39, 0x17, 0x08, 0xF3, 0x00, 0x03, 0x00]),
        instruction(0x3A, "T4:136/DN", &[0x3A, 0x17, 0x08, 0xD4, 0x00, 0x04, 0x88]),
        instruction(0x2F, "I:0.0/4", &[0x2F, 0x1F, 0x08, 0x41, 0x00, 0x01, 0x00]),
        instruction(mark::RUNG_END, "", &[]),
    ];
    let rung = Rung { leg: Leg { items }, ..Rung::default() };
    let file = LadFile {
        rung_count: u16::try_from(rungs).unwrap_or(u16::MAX),
        flags: LadFile::LADDER,
        rungs: vec![rung; rungs],
        ..LadFile::default()
    };
    let payload = serialize(&ProgramFiles { files: vec![file] }).expect("writes");
    let mut project = Project::new();
    project.set_payload(ImageKind::Main, StreamKind::ProgramFiles, &payload).expect("sets");
    project
}

fn main() {
    let files = corpus();
    if files.is_empty() {
        println!("skipped: corpus not present");
    } else {
        let read = |path: &PathBuf| Project::read(&std::fs::read(path).ok()?, Mode::Permissive).ok();
        let largest: Vec<_> = files.iter().filter(|p| p.ends_with("LANLOGIX_BR.RSS")).filter_map(read).collect();
        report("LANLOGIX_BR", &largest, 40);
        let all: Vec<_> = files.iter().filter_map(read).collect();
        report("corpus", &all, 5);
    }
    let time = |rungs| {
        let project = [synthetic(rungs)];
        (0..20).map(|_| run(&project, true)).min().unwrap_or_default()
    };
    let one = time(500);
    println!("500 rungs                {one:>10.1?}");
    for times in [10, 100] {
        let t = time(500 * times);
        println!("{:5} rungs             {t:>11.1?}  {:.1} times the cost of 500", 500 * times, ratio(t, one));
    }
}
