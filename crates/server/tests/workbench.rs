//! The workbench without a browser: what is done, undone, kept and recorded.

mod support;

use std::time::Duration;

use ladder::Value;
use server::workbench::flow::{AFTER, BEFORE, CHANGED, EXECUTED};
use server::workbench::{Change, Condition, ModeChange, Recorded, Relation, Subject, Workbench};
use sim::scenario::{Literal, Scenario, play};
use support::{machine, read};

const LADDER: &[&str] = &[
    "XIC I:0.0/0 TON T4:0 0.01 100 0",
    "XIC T4:0/DN OTE O:0.0/0",
    "XIC I:0.0/1 CTU C5:0 5 0",
    "MOV N7:0 N7:1",
    "BST XIC I:0.0/2 NXB XIC B3:0/0 BND XIO I:0.0/3 OTE B3:0/0",
];

fn bench() -> Workbench {
    let mut bench = Workbench::new(Box::new(machine(LADDER)));
    bench.change(Change::Mode(ModeChange::Run)).expect("runs");
    bench
}

fn set(bench: &mut Workbench, address: &str, value: i64) {
    bench.write(address, &Literal::Integer(value)).expect(address);
}

fn scans(bench: &mut Workbench, count: usize) {
    (0..count).for_each(|_| assert!(bench.scan(true), "it runs"));
}

#[test]
fn power_flow_is_that_of_the_last_scan() {
    let mut bench = bench();
    scans(&mut bench, 2);
    assert_eq!(bench.flow().rung(2, 0), [EXECUTED | BEFORE, EXECUTED]);
    set(&mut bench, "I:0.0/0", 1);
    scans(&mut bench, 1);
    let on = EXECUTED | BEFORE | AFTER | CHANGED;
    assert_eq!(bench.flow().rung(2, 0).first(), Some(&on));
    scans(&mut bench, 1);
    assert_eq!(bench.flow().rung(2, 0).first(), Some(&(on & !CHANGED)));
}

#[test]
fn every_scan_can_be_gone_back_to() {
    let mut bench = bench();
    let mut past = Vec::new();
    // Across several copies of the state, with changes in between.
    for scan in 0..1200 {
        if scan % 7 == 0 {
            set(&mut bench, "I:0.0/0", i64::from(scan % 3 != 0));
        }
        if scan % 5 == 0 {
            set(&mut bench, "I:0.0/1", i64::from(scan % 2));
        }
        if scan == 400 {
            bench.change(Change::Force { address: "I:0.0/2".to_owned(), state: Some(true) }).expect("an input");
        }
        scans(&mut bench, 1);
        let values = ["T4:0.ACC", "C5:0.ACC", "B3:0/0"].map(|address| read(&bench, address));
        past.push((values, bench.flow().rung(2, 0).to_vec(), bench.state().forces.len()));
    }
    while past.len() > 3 {
        for step in [1, 1, 249, 250, 3] {
            if past.len() <= step + 1 {
                break;
            }
            past.truncate(past.len() - step);
            assert_eq!(bench.back(step as u64), Ok(step as u64));
            let values = ["T4:0.ACC", "C5:0.ACC", "B3:0/0"].map(|address| read(&bench, address));
            let now = (values, bench.flow().rung(2, 0).to_vec(), bench.state().forces.len());
            assert_eq!(Some(&now), past.last(), "{} scans in", past.len());
        }
        if past.len() <= 4 {
            break;
        }
    }
    let depth = bench.depth();
    assert_eq!(bench.back(u64::MAX), Ok(depth), "no further than it goes");
    assert_eq!(read(&bench, "T4:0.ACC"), Value::Word(0));
}

#[test]
fn a_change_since_the_last_scan_goes_with_going_back() {
    let mut bench = bench();
    scans(&mut bench, 3);
    set(&mut bench, "N7:0", 5);
    bench.back(0).expect("no recording");
    assert_eq!(read(&bench, "N7:0"), Value::Word(0));
}

#[test]
fn the_past_is_bounded() {
    let mut bench = bench();
    scans(&mut bench, 1);
    for _ in 0..60_000 {
        bench.scan(false);
    }
    assert!((49_000..=50_500).contains(&bench.depth()), "{}", bench.depth());
    let at = bench.state().machine.controller().scans();
    let depth = bench.depth();
    assert_eq!(bench.back(depth), Ok(depth));
    assert_eq!(bench.state().machine.controller().scans(), at - depth);
}

const SETS: [&str; 6] = ["N7:0", "N7:1", "T4:0.PRE", "T4:0.ACC", "C5:0.PRE", "C5:0.ACC"];

/// Counted, not timed: what is held stays below a bound however long the run and whatever is done.
#[test]
fn everything_that_is_kept_is_bounded() {
    let mut bench = bench();
    scans(&mut bench, 1);
    bench.follow(&["N7:0".to_owned(), "T4:0.ACC".to_owned()]).expect("numbers");
    let wide = "a".repeat(100_000);
    for number in 0..120_000u32 {
        set(&mut bench, "N7:0", i64::from(number % 1000));
        if number % 1000 == 0 {
            // Plants are the largest thing a person can do between two scans.
            let plant = server::plant::Plant::parse(&format!(
                "# {wide}\n[[heater]]\nname = \"h\"\non = \"N7:9/0\"\ntemperature = \"N7:2\"\nrate = 1.0\n"
            ));
            bench.change(Change::Plant(Some(Box::new(plant.expect("reads"))))).expect("wires");
        }
        bench.scan(false);
        let kept = bench.kept();
        assert!(kept.copies <= 200 && kept.scans <= 50_250 && kept.bytes <= 73 << 20, "{number}: {kept:?}");
    }
    assert!(bench.traces().iter().all(|trace| trace.since(0).count() <= 20_000));
    let trace = &bench.traces()[0];
    assert!(trace.forgotten() > 0, "{}", trace.since(0).count());
    // Changes without a scan: the past is given up before memory is.
    for number in 0..200_000 {
        set(&mut bench, "N7:0", number % 1000);
        assert!(bench.kept().bytes <= 73 << 20);
    }
    assert_eq!(read(&bench, "N7:0"), Value::Word(999));
    scans(&mut bench, 3);
    let depth = bench.depth();
    assert_eq!((depth, bench.back(depth + 100)), (3, Ok(3)), "only what came after can be gone back to");
    for number in 0..40 {
        assert_eq!(bench.keep(&format!("snapshot {number}")).is_ok(), number < 32);
    }
    // A recording says that it is full, and what it has is what was done until then.
    bench.record().expect("begins");
    for number in 0..600_000 {
        set(&mut bench, SETS[number % 6], 5);
        if number % 6 == 5 {
            bench.scan(false);
        }
    }
    let scans = bench.recorder().expect("in progress").scans();
    assert!((80_000..100_000).contains(&scans), "{scans}");
}

#[test]
fn forces_win_over_what_is_written_and_go_with_a_restart() {
    let mut bench = bench();
    bench.change(Change::Force { address: "I:0.0/0".to_owned(), state: Some(true) }).expect("an input");
    set(&mut bench, "I:0.0/0", 0);
    assert!(!bench.state().machine.forces_enabled(), "as on the controller, installed is not enabled");
    bench.change(Change::EnableForces(true)).expect("can");
    scans(&mut bench, 3);
    assert_eq!(read(&bench, "T4:0/EN"), Value::Bit(true));
    bench.change(Change::EnableForces(false)).expect("can");
    scans(&mut bench, 1);
    assert_eq!(read(&bench, "T4:0/EN"), Value::Bit(false));
    let refused = bench.change(Change::Force { address: "B3:0/0".to_owned(), state: Some(true) });
    assert!(refused.is_err_and(|why| why.contains("B3:0/0")));
    assert_eq!(bench.state().forces.len(), 1);
    bench.restart().expect("no recording");
    assert!(bench.state().forces.is_empty() && bench.depth() == 0);
}

#[test]
fn a_snapshot_goes_on_as_it_did() {
    let mut bench = bench();
    set(&mut bench, "I:0.0/0", 1);
    scans(&mut bench, 10);
    bench.keep("ten").expect("room");
    scans(&mut bench, 50);
    let later = read(&bench, "T4:0.ACC");
    bench.resume("ten").expect("is kept");
    scans(&mut bench, 50);
    assert_eq!(read(&bench, "T4:0.ACC"), later);
    assert!(bench.resume("eleven").is_err());
}

#[test]
fn a_condition_is_looked_at() {
    let mut bench = bench();
    set(&mut bench, "I:0.0/0", 1);
    let condition = Condition { address: "T4:0.ACC".to_owned(), relation: Relation::AtLeast, value: 30.0 };
    let mut count = 0;
    while !bench.holds(&condition).expect("a word") {
        scans(&mut bench, 1);
        count += 1;
    }
    assert_eq!((count, read(&bench, "T4:0.ACC")), (31, Value::Word(30)));
    assert!(bench.holds(&Condition { address: "T4:0".to_owned(), ..condition }).is_err());
}

#[test]
fn a_trace_keeps_changes_and_goes_back() {
    let mut bench = bench();
    bench.follow(&["I:0.0/0".to_owned(), "C5:0.ACC".to_owned()]).expect("numbers");
    for level in [0, 0, 1, 1, 0] {
        set(&mut bench, "I:0.0/0", level);
        scans(&mut bench, 1);
    }
    let points = |bench: &Workbench| -> Vec<(u64, f64)> {
        bench
            .traces()
            .first()
            .map(|trace| trace.since(0).map(|point| (point.scan, point.value)).collect())
            .unwrap_or_default()
    };
    assert_eq!(points(&bench), [(1, 0.0), (3, 1.0), (5, 0.0)]);
    bench.back(2).expect("no recording");
    assert_eq!(points(&bench), [(1, 0.0), (3, 1.0)]);
    assert!(bench.follow(&["T4:0".to_owned()]).is_err());
}

#[test]
fn a_recording_replays_on_a_fresh_machine() {
    let mut bench = bench();
    scans(&mut bench, 5);
    set(&mut bench, "C5:0.ACC", 3);
    bench.record().expect("begins anew");
    assert_eq!(read(&bench, "C5:0.ACC"), Value::Word(0));
    scans(&mut bench, 3);
    for level in [1, 0, 1, 0, 1] {
        set(&mut bench, "I:0.0/1", level);
        set(&mut bench, "I:0.0/2", level);
        scans(&mut bench, 2);
    }
    bench.expect(&["C5:0.ACC".to_owned(), "B3:0/0".to_owned()]).expect("recording");
    set(&mut bench, "I:0.0/3", 1);
    bench.set_scan_time(Duration::from_millis(25)).expect("in range");
    scans(&mut bench, 4);
    bench.change(Change::Mode(ModeChange::Program)).expect("can");
    bench.change(Change::Mode(ModeChange::Run)).expect("can");
    scans(&mut bench, 1);
    bench.expect(&["B3:0/0".to_owned(), "C5:0.ACC".to_owned()]).expect("recording");
    assert!(bench.back(1).is_err(), "a recording only goes forward");
    let subject = Recorded { name: "counts \"three\"".to_owned(), program: "x.RSS".to_owned(), family: None };
    let (text, problems) = bench.recorded(&subject).expect("recording");
    assert_eq!(problems, Vec::<String>::new(), "{text}");
    let scenario = Scenario::parse(&text).expect("reads");
    let report = play(&scenario, Subject::controller_mut(&mut machine(LADDER)), Vec::new()).expect("plays");
    assert_eq!((report.failures.len(), report.checks), (0, 4), "{text}");
    // It can fail: another count is noticed.
    let other = text.replacen("\"C5:0.ACC\" = 3", "\"C5:0.ACC\" = 2", 1);
    assert_ne!(other, text);
    let scenario = Scenario::parse(&other).expect("reads");
    let report = play(&scenario, Subject::controller_mut(&mut machine(LADDER)), Vec::new()).expect("plays");
    assert_eq!(report.failures.len(), 1);
}

#[test]
fn what_is_written_in_program_mode_meets_the_prescan_of_the_replay_too() {
    let mut bench = bench();
    bench.record().expect("begins");
    bench.change(Change::Mode(ModeChange::Program)).expect("can");
    set(&mut bench, "T4:0.ACC", 37);
    set(&mut bench, "I:0.0/0", 1);
    bench.change(Change::Mode(ModeChange::Run)).expect("can");
    set(&mut bench, "C5:0.ACC", 2);
    scans(&mut bench, 3);
    bench.expect(&["T4:0.ACC".to_owned(), "C5:0.ACC".to_owned()]).expect("recording");
    set(&mut bench, "T4:0.ACC", 37);
    bench.change(Change::Mode(ModeChange::PowerCycle)).expect("can");
    scans(&mut bench, 3);
    bench.expect(&["T4:0.ACC".to_owned()]).expect("recording");
    let (text, problems) = bench.recorded(&Recorded::default()).expect("recording");
    let replayed: Vec<&String> = problems.iter().filter(|problem| problem.starts_with("replayed")).collect();
    assert!(replayed.is_empty(), "{replayed:?} {text}");
}

#[test]
fn a_fault_of_a_recording_is_expected_by_its_scenario() {
    // Arithmetic overflow at the end of a scan is major fault 0020.
    let ladder = &["XIC I:0.0/0 OTE S:5/0", "ADD N7:0 1 N7:0"];
    let mut bench = Workbench::new(Box::new(machine(ladder)));
    bench.record().expect("begins");
    scans(&mut bench, 3);
    set(&mut bench, "I:0.0/0", 1);
    scans(&mut bench, 1);
    assert!(!bench.scan(true), "it has stopped");
    set(&mut bench, "I:0.0/0", 0);
    set(&mut bench, "S:5/0", 0);
    bench.change(Change::Mode(ModeChange::Run)).expect("clears it");
    scans(&mut bench, 2);
    bench.expect(&["N7:0".to_owned()]).expect("recording");
    let (text, problems) = bench.recorded(&Recorded::default()).expect("recording");
    assert_eq!(problems, Vec::<String>::new(), "{text}");
    assert!(text.contains("fault = \"0020\""), "{text}");
    let without = text.replace("fault = \"0020\"\n", "");
    let scenario = Scenario::parse(&without).expect("reads");
    let report = play(&scenario, Subject::controller_mut(&mut machine(ladder)), Vec::new()).expect("plays");
    assert_eq!(report.failures.len(), 1, "the fault is no surprise only where it is expected");
}

#[test]
fn a_number_that_would_become_another_one_is_refused() {
    let mut bench = bench();
    let why = bench.write("N7:0", &Literal::Integer(40_000)).expect_err("a word ends at 32767");
    assert!(why.contains("-32768 to 32767") && why.contains("40000"), "{why}");
    assert_eq!(read(&bench, "N7:0"), Value::Word(0));
    // Who spells bits means bits.
    bench.write("N7:0", &Literal::Text("0x9C40".to_owned())).expect("hex");
    assert_eq!(read(&bench, "N7:0"), Value::Word(-25_536));
    set(&mut bench, "N7:0", -32_768);
}

#[test]
fn the_key_does_nothing_where_it_stands_already() {
    let mut bench = bench();
    set(&mut bench, "I:0.0/0", 1);
    scans(&mut bench, 5);
    let before = read(&bench, "T4:0.ACC");
    bench.change(Change::Mode(ModeChange::Run)).expect("can");
    assert_eq!(read(&bench, "T4:0.ACC"), before, "no prescan");
    scans(&mut bench, 1);
    assert_eq!((before, read(&bench, "T4:0.ACC")), (Value::Word(4), Value::Word(5)), "and time goes on");
}

fn forced(bench: &mut Workbench, address: &str, state: Option<bool>) {
    bench.change(Change::Force { address: address.to_owned(), state }).expect(address);
}

#[test]
fn forces_of_inputs_are_recorded_as_what_the_program_reads() {
    let mut bench = bench();
    bench.record().expect("begins");
    set(&mut bench, "I:0.0/3", 1);
    forced(&mut bench, "I:0.0/0", Some(true));
    forced(&mut bench, "O:0.0/0", Some(true));
    // Installed, not enabled: nothing happens yet.
    scans(&mut bench, 3);
    bench.expect(&["T4:0.ACC".to_owned()]).expect("recording");
    bench.change(Change::EnableForces(true)).expect("can");
    scans(&mut bench, 20);
    // What is written under a force waits for its end, bit by bit or as a word.
    set(&mut bench, "I:0.0/0", 0);
    set(&mut bench, "I:0.0", 0b0110);
    scans(&mut bench, 10);
    bench.expect(&["T4:0.ACC".to_owned(), "C5:0.ACC".to_owned(), "B3:0/0".to_owned()]).expect("recording");
    assert_eq!((read(&bench, "T4:0.ACC"), read(&bench, "C5:0.ACC")), (Value::Word(29), Value::Word(1)));
    forced(&mut bench, "I:0.0/0", None);
    forced(&mut bench, "I:0.0/2", Some(false));
    scans(&mut bench, 2);
    bench.expect(&["T4:0.ACC".to_owned(), "B3:0/0".to_owned()]).expect("recording");
    let (text, problems) = bench.recorded(&Recorded::default()).expect("recording");
    assert_eq!(problems, Vec::<String>::new(), "{text}");
    let said =
        ["I:0.0/0 forced ON; O:0.0/0 forced ON", "forces enabled", "force of I:0.0/0 removed; I:0.0/2 forced OFF"];
    assert!(said.iter().all(|note| text.contains(&format!("note = \"{note}\""))), "{text}");
    let scenario = Scenario::parse(&text).expect("reads");
    let report = play(&scenario, Subject::controller_mut(&mut machine(LADDER)), Vec::new()).expect("plays");
    assert_eq!((report.failures.len(), report.checks), (0, 6), "{text}");
}

#[test]
fn what_a_scenario_cannot_say_is_said() {
    let mut bench = bench();
    bench.record().expect("begins");
    bench.change(Change::Mode(ModeChange::Test)).expect("can");
    scans(&mut bench, 2);
    let (text, problems) = bench.recorded(&Recorded::default()).expect("recording");
    assert!(text.contains("# Not in this scenario: test mode"), "{text}");
    assert!(problems.iter().any(|problem| problem.contains("test mode")), "{problems:?}");
}
