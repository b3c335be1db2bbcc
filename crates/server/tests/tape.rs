//! A tape does what the scenario does: the same values after the same scans and the same time, forwards and back.

mod support;

use server::workbench::{Subject, Tape, Workbench};
use sim::scenario::{Scenario, play};
use support::{machine, read};

const LADDER: &[&str] = &[
    "XIC I:0.0/0 TON T4:0 0.01 100 0",
    "XIC T4:0/DN OTE O:0.0/0",
    "XIC I:0.0/1 CTU C5:0 5 0",
    "XIC S:1/15 ADD N7:0 1 N7:0",
    "XIO I:0.0/2 TOF T4:1 1.0 3 0",
    "ADD N7:1 1 N7:1",
];

const SCENARIO: &str = r#"
name = "everything a step can say"
program = "x.RSS"
scan = "10ms"
[[step]]
set = { "I:0.0/0" = 1, "N7:0" = 5, "T4:0.ACC" = 20, "C5:0.ACC" = 3 }
scans = 3
[[step]]
edges = { bit = "I:0.0/1", count = 4 }
scan = "7ms"
run = "50ms"
[[step]]
set = { "I:0.0/2" = 1, "N7:1" = -3 }
[[step]]
scan = "25ms"
run = "1s"
[[step]]
mode = "program-run"
set = { "I:0.0/0" = 0, "T4:0.ACC" = 99, "N7:0" = 40 }
scan = "13ms"
run = "100ms"
[[step]]
mode = "program-run"
scans = 2
"#;

const LOOKED_AT: [&str; 8] = ["T4:0.ACC", "T4:0/DN", "T4:1.ACC", "T4:1/DN", "C5:0.ACC", "C5:0/CU", "N7:0", "N7:1"];

#[test]
fn a_tape_does_what_the_scenario_does() {
    let mut played = machine(LADDER);
    let scenario = Scenario::parse(SCENARIO).expect("reads");
    let report = play(&scenario, played.controller_mut(), Vec::new()).expect("plays");
    let wanted = LOOKED_AT.map(|address| played.controller().read(address).expect(address));
    let mut bench = Workbench::new(Box::new(machine(LADDER)));
    let tape = Tape::read(SCENARIO, bench.initial()).expect("reads");
    assert_eq!((tape.name(), tape.scans()), ("everything a step can say", report.scans));
    bench.play(tape).expect("no recording");
    while bench.scan(true) {}
    let found = |bench: &Workbench| LOOKED_AT.map(|address| read(bench, address));
    let time = |bench: &Workbench| bench.state().machine.controller().now();
    assert_eq!((found(&bench), time(&bench)), (wanted.clone(), report.time));
    // Back over changes of mode, and on again.
    let end = report.scans;
    for step in [1, 7, 40] {
        assert_eq!(bench.back(step), Ok(step));
        assert_eq!(bench.tape().map(|(_, at)| at), Some(end - step));
        while bench.scan(false) {}
        assert_eq!((found(&bench), time(&bench)), (wanted.clone(), report.time), "{step} back");
    }
}

#[test]
fn what_begins_anew_leaves_the_tape() {
    let mut bench = Workbench::new(Box::new(machine(LADDER)));
    let tape = || Tape::read(SCENARIO, &machine(LADDER)).expect("reads");
    bench.keep("begin").expect("room");
    bench.play(tape()).expect("plays");
    bench.resume("begin").expect("is kept");
    assert!(bench.tape().is_none());
    bench.play(tape()).expect("plays");
    bench.restart().expect("no recording");
    assert!(bench.tape().is_none());
    bench.record().expect("begins");
    assert!(bench.play(tape()).is_err(), "a recording goes on");
}
