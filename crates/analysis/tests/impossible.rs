//! What a proof run calls impossible must never happen: random programs, programs of the corpus, and cases
//! made by hand for both answers.

#[allow(dead_code)]
mod migrated;
#[allow(dead_code)]
#[path = "../../sim/tests/random/mod.rs"]
mod random;

use std::collections::BTreeMap;
use std::time::Duration;

use analysis::proof::{Goal, GoalKind, Options, Report, prove_slc};
use ladder::{Address, Family, Image, Value};
use random::{Dice, Plan};
use sim::{Machine, PowerFlow, Program, Trace};

fn report(image: &Image, scans: u64) -> Report {
    prove_slc(image, image, None, &Options { scans, minimize: false, ..Options::default() })
}

/// Notes what a run does although it was called impossible.
struct Watcher {
    impossible: BTreeMap<(u16, u16, u16), Vec<Goal>>,
    /// Done bits of timers and counters whose goals are watched behind scans.
    done: Vec<(Address, Goal)>,
    happened: Vec<Goal>,
}

impl Watcher {
    fn new(report: &Report) -> Watcher {
        let mut impossible: BTreeMap<_, Vec<Goal>> = BTreeMap::new();
        let mut done = Vec::new();
        for goal in report.goals.iter().filter(|goal| goal.impossible.is_some()) {
            let at = goal.location;
            let element = goal.text.split(' ').nth(1).and_then(|text| Address::parse(text).ok());
            match (goal.kind, element) {
                // The bits of a timer nobody executes are what they are.
                _ if goal.impossible.as_deref() == Some("the program file is never called") => {}
                (GoalKind::Done | GoalKind::NotDone, Some(element)) => done.push((element.with_bit(13), goal.clone())),
                _ => {
                    let site = (at.file, at.rung as u16, at.instruction as u16);
                    impossible.entry(site).or_default().push(goal.clone());
                }
            }
        }
        Watcher { impossible, done, happened: Vec::new() }
    }

    fn look(&mut self, machine: &Machine) {
        for (address, goal) in &self.done {
            let on = machine.get(address) == Ok(Value::Bit(true));
            if on == (goal.kind == GoalKind::Done) {
                self.happened.push(goal.clone());
            }
        }
    }
}

impl Trace for Watcher {
    fn wants(&self, _: u16, _: u16) -> bool {
        !self.impossible.is_empty()
    }

    fn flow(&mut self, flow: PowerFlow) {
        let Some(goals) = self.impossible.get(&(flow.file, flow.rung, flow.instruction)) else { return };
        let hit = goals.iter().filter(|goal| match goal.kind {
            GoalKind::Passes => flow.before && flow.after,
            GoalKind::Blocks => flow.before && !flow.after,
            GoalKind::True => flow.before,
            GoalKind::False => !flow.before,
            _ => false,
        });
        self.happened.extend(hit.cloned());
    }
}

/// Runs a program with random terminals, times and changes of mode.
fn simulate(image: &Image, report: &Report, scans: u64, seed: u64) -> Vec<Goal> {
    let mut watcher = Watcher::new(report);
    let program = Program::compile(image, &sim::Options::default()).expect("it ran before");
    let mut machine = Machine::new(program.clone());
    let (mut dice, words) = (Dice(seed | 1), Address::parse("I:0.0").expect("an address"));
    machine.enter_run();
    for scan in 0..scans {
        let mut entered = scan == 0;
        if dice.below(300) == 0 {
            machine = Machine::new(program.clone());
            machine.enter_run();
            entered = true;
        } else if !machine.is_executing() || dice.below(40) == 0 {
            machine.enter_program();
            machine.enter_run();
            entered = true;
        } else if scan % 3 == 0 {
            let value = match dice.below(3) {
                0 => dice.below(0x10000),
                1 => 1 << dice.below(16),
                _ => 0xFFFF,
            };
            let _ = machine.set(&words, &Value::Word(value as u16 as i16));
        }
        // The first scan follows at once: a timed interrupt has no time to come before it.
        let dt = if entered { 0 } else { [0, 0, 1, 7, 10, 50, 300, 2000, 30_000][dice.below(9) as usize] };
        machine.scan_traced(Duration::from_millis(dt), &mut watcher);
        watcher.look(&machine);
    }
    watcher.happened
}

fn check(name: &str, image: &Image, scans: u64, seed: u64) -> usize {
    let report = report(image, scans);
    let argued: Vec<&Goal> = report.goals.iter().filter(|goal| goal.impossible.is_some()).collect();
    let wrong: Vec<&&Goal> = argued.iter().filter(|goal| goal.reached).collect();
    assert!(wrong.is_empty(), "{name}: reached all the same: {wrong:?}");
    if report.scans > 1 {
        let wrong = simulate(image, &report, scans * 4, seed);
        assert!(wrong.is_empty(), "{name}: it happened: {:?}", wrong.first());
    }
    argued.len()
}

fn number(name: &str, usual: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

#[test]
fn random_programs_never_do_what_is_called_impossible() {
    let families = [Family::Slc501, Family::Slc503, Family::MicroLogix1000, Family::MicroLogix1100];
    let mut argued = 0;
    for case in 0..number("RUNGS_CASES", 120) {
        let mut dice = Dice(case * 0x9E37_79B9 + 77);
        for _ in 0..8 {
            dice.below(2);
        }
        let mut rungs = |most: u64| -> Vec<u64> {
            let count = 1 + dice.below(most);
            (0..count).map(|_| dice.below(1 << 47)).collect()
        };
        let (main, subroutine) = (rungs(12), rungs(4));
        let family = families[(case % 4) as usize];
        let plan = Plan { family, main, subroutine, seed: case + 1, scans: 0, forgiving: !case.is_multiple_of(5) };
        let mut image = plan.image();
        let mut data = plan.data();
        for file in &mut image.data_files {
            // Half of the programs start from anything, half from nothing.
            if case.is_multiple_of(2) && file.file_type != ladder::FileType::S {
                let file_type = file.file_type;
                file.words.iter_mut().enumerate().for_each(|(index, word)| *word = data.word(file_type, index));
            }
        }
        argued += check(&format!("case {case}: {}", plan.text()), &image, 400, case + 5);
    }
    println!("{argued} goals were called impossible");
    assert!(argued > 0);
}

#[test]
fn programs_of_the_corpus_never_do_what_is_called_impossible() {
    let Some(corpus) = migrated::corpus() else { return println!("skipped: corpus not present") };
    let most = number("RUNGS_RUNGS", 30) as usize;
    let (mut programs, mut argued) = (0, 0);
    let mut open = vec![corpus];
    while let Some(folder) = open.pop() {
        let mut entries: Vec<_> = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path()).collect();
        entries.sort();
        for path in entries {
            if path.is_dir() {
                open.push(path);
                continue;
            }
            if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("rss")) {
                continue;
            }
            let name = path.display().to_string();
            let Ok(bytes) = std::fs::read(&path) else { continue };
            let Ok(project) = convert::open(&bytes, &name, rss::Mode::Permissive) else { continue };
            let rungs: usize = project.main.ladder_files().map(|file| file.rungs.len()).sum();
            let runs = Program::compile(&project.main, &sim::Options::default()).is_ok();
            if rungs <= most && runs {
                programs += 1;
                argued += check(&name, &project.main, 500, 3);
            }
        }
    }
    println!("{argued} goals of {programs} programs were called impossible");
    assert!(argued > 0);
}

/// An SLC text with these rungs in the main program and in file 3.
fn program(rungs: &[&str], subroutine: &[&str]) -> Image {
    let text = |rungs: &[&str]| {
        let family = Some(Family::MicroLogix1100);
        rungs.iter().map(|text| convert::slc::rung::parse_rung(text, family).expect("a rung")).collect::<Vec<_>>()
    };
    let mut image = sim::inline_image(Family::MicroLogix1100, vec![(2, text(rungs)), (3, text(subroutine))]);
    let plan = Plan { family: image.family(), main: vec![1], subroutine: vec![], seed: 1, scans: 0, forgiving: false };
    image.data_files = plan.image().data_files;
    for (number, preset) in [(0, 100), (1, 200), (2, 300)] {
        let file = image.data_files.iter_mut().find(|file| file.file_type == ladder::FileType::T);
        file.expect("timers").words[number * 3 + 1] = preset;
    }
    image
}

/// What is said of a goal: reached, impossible with its argument, or neither.
fn verdict(image: &Image, at: (u16, u32, u32), kind: GoalKind) -> Result<bool, String> {
    check("case by hand", image, 3000, 9);
    let report = report(image, 3000);
    let location = |goal: &&Goal| (goal.location.file, goal.location.rung, goal.location.instruction) == at;
    let goal = report.goals.iter().filter(location).find(|goal| goal.kind == kind).expect("the goal is there");
    match &goal.impossible {
        Some(why) => Err(why.clone()),
        None => Ok(goal.reached),
    }
}

const ALARM: (u16, u32, u32) = (2, 2, 2);

#[test]
fn an_interlock_excludes_both_outputs() {
    let rungs = ["XIC I:0/0 XIO O:0/1 OTE O:0/0", "XIC I:0/1 XIO O:0/0 OTE O:0/1", "XIC O:0/0 XIC O:0/1 OTL B3:0/0"];
    let why = verdict(&program(&rungs, &[]), ALARM, GoalKind::True).expect_err("they exclude each other");
    assert!(why.contains("O:0.0/0") || why.contains("whatever the data"), "{why}");
    let open = ["XIC I:0/0 OTE O:0/0", rungs[1], rungs[2]];
    let open = [open[1], open[0], open[2]];
    assert_eq!(verdict(&program(&open, &[]), ALARM, GoalKind::True), Ok(true), "one of them alone is no interlock");
}

#[test]
fn a_chain_of_timers_ends_in_order() {
    let rungs =
        ["XIC I:0/0 TON T4:0 0.001 100 0", "XIC T4:0/DN TON T4:1 0.001 200 0", "XIO T4:0/DN XIC T4:1/DN OTE B3:0/0"];
    assert!(verdict(&program(&rungs, &[]), ALARM, GoalKind::True).is_err());
    // The other way round the second one is a scan behind.
    let late = [rungs[1], rungs[0], rungs[2]];
    assert_eq!(verdict(&program(&late, &[]), ALARM, GoalKind::True), Ok(true));
}

#[test]
fn a_saved_value_counts() {
    let rungs = ["XIC B3:0/5 OTL B3:0/6", "XIC B3:0/6 OTL B3:0/5", "XIC B3:0/5 XIC B3:0/6 OTE B3:0/0"];
    let mut image = program(&rungs, &[]);
    // Bits that are only set are reset by somebody: they are inputs, so here they reset each other too.
    let resets = ["XIO B3:0/5 OTU B3:0/6", "XIO B3:0/6 OTU B3:0/5"];
    let all: Vec<&str> = rungs.iter().copied().chain(resets).collect();
    let mut image_off = program(&all, &[]);
    assert!(verdict(&image_off, ALARM, GoalKind::True).is_err(), "nothing ever sets them");
    let bits = |image: &mut Image| {
        let file = image.data_files.iter_mut().find(|file| file.file_type == ladder::FileType::B);
        file.expect("bits").words[0] = 0x0060;
    };
    bits(&mut image_off);
    assert_eq!(verdict(&image_off, ALARM, GoalKind::True), Ok(true), "they were saved on");
    bits(&mut image);
    assert_eq!(verdict(&image, ALARM, GoalKind::True), Ok(true));
}

#[test]
fn going_to_run_resets_coils_and_timers_in_the_first_scan_only() {
    let rungs =
        ["XIC S:1/15 XIC T4:0/DN OTL B3:0/1", "XIC I:0/0 TON T4:0 0.001 100 0", "XIC S:1/15 XIC T4:0/DN OTL B3:0/0"];
    let image = program(&rungs, &[]);
    assert!(verdict(&image, ALARM, GoalKind::True).is_err(), "it has not timed yet");
    assert_eq!(verdict(&image, (2, 0, 2), GoalKind::True), Ok(true), "its words are kept until it is executed");
}

#[test]
fn numbers_stay_where_the_program_keeps_them() {
    let rungs = ["XIC I:0/0 ADD N7:0 1 N7:0", "GRT N7:0 9 CLR N7:0", "EQU N7:0 12 OTE B3:0/0", "EQU N7:0 5 OTE B3:0/1"];
    let image = program(&rungs, &[]);
    assert!(
        verdict(&image, (2, 2, 1), GoalKind::True).is_err() || verdict(&image, (2, 2, 1), GoalKind::True) == Ok(false)
    );
    assert_eq!(verdict(&image, (2, 3, 1), GoalKind::True), Ok(true));
}

#[test]
fn what_leaves_its_file_or_loops_is_not_argued_about() {
    let alarm = "XIC B3:1/0 XIC B3:1/1 OTE B3:0/0";
    let sets = "XIO I:0/0 XIC I:0/0 OTE B3:1/0";
    let stray = ["XIC I:0/1 ADD N7:0 1 N7:0", "XIC I:0/2 MOV 3 N7:[N7:0]", alarm, sets, "XIO I:0/0 OTE B3:1/1"];
    assert_eq!(verdict(&program(&stray, &[]), ALARM, GoalKind::True), Ok(false), "the index can lead anywhere");
    let kept = [stray[0], "XIC I:0/2 MOV 3 N7:1", alarm, sets, stray[4]];
    assert!(verdict(&program(&kept, &[]), ALARM, GoalKind::True).is_err());
    let called = ["XIC I:0/3 JSR 3", "XIC I:0/2 MOV 3 N7:1", alarm, sets, stray[4]];
    assert_eq!(verdict(&program(&called, &["XIC I:0/5 OTE B3:1/0"]), ALARM, GoalKind::True), Ok(true));
}
