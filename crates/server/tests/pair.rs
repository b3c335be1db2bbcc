//! Two programs side by side: the same inputs, time and scans, compared as a proof compares them.

#[path = "support/pair.rs"]
mod two;

use analysis::proof::Verdict;
use ladder::Value;
use server::workbench::pair::First;
use server::workbench::{Change, ModeChange, Pair, Tape, Workbench};
use sim::scenario::Literal;
use two::Two;

/// The seal-in contact inverted.
const SEAL: (&str, &str) = ("STR\tX0\nOR\tC0\n", "STR\tX0\nORN\tC0\n");

fn pair(bench: &Workbench) -> &Pair {
    bench.state().machine.pair().expect("two machines")
}

fn read(bench: &Workbench, address: &str) -> Value {
    bench.state().machine.controller().read(address).expect(address)
}

fn set(bench: &mut Workbench, address: &str, value: i64) {
    bench.write(address, &Literal::Integer(value)).expect(address);
}

fn scans(bench: &mut Workbench, count: usize) {
    (0..count).for_each(|_| assert!(bench.scan(true), "it runs"));
}

fn running(two: &Two) -> Workbench {
    let mut bench = two.bench();
    bench.change(Change::Mode(ModeChange::Run)).expect("runs");
    scans(&mut bench, 1);
    bench
}

#[test]
fn both_get_the_same_inputs_time_and_scans() {
    let mut bench = running(&Two::of("motor/motor.RSS", &[]));
    // Either side's name, the same input.
    set(&mut bench, "other:X1", 1);
    set(&mut bench, "I:0.0/2", 1);
    set(&mut bench, "I:0.0/0", 1);
    for (original, other) in [("I:0.0/0", "other:X0"), ("I:0.0/1", "other:X1"), ("I:0.0/2", "other:X2")] {
        assert_eq!((read(&bench, original), read(&bench, other)), (Value::Bit(true), Value::Bit(true)));
    }
    scans(&mut bench, 400);
    assert_eq!((read(&bench, "O:0.0/0"), read(&bench, "other:Y0")), (Value::Bit(true), Value::Bit(true)));
    let (a, b) = (bench.state().machine.controller(), pair(&bench).other().controller());
    assert_eq!((a.scans(), a.now()), (b.scans(), b.now()));
    assert_eq!((pair(&bench).first(), pair(&bench).differing()), (None, vec![]));
    // Words go through the map too, and structures by their members.
    set(&mut bench, "T4:0.PRE", 7);
    assert_eq!(read(&bench, "other:N3"), Value::Word(7));
    assert!(pair(&bench).other_flow().rung(0, 5).iter().any(|bits| *bits != 0), "power flow of both");
}

#[test]
fn one_side_alone_cannot_be_changed() {
    let mut bench = running(&Two::of("motor/motor.RSS", &[]));
    for address in ["other:C17", "other:T1.Acc", "other:D4", "N99:0", "other:nothing"] {
        let before = bench.state().machine.controller().read(address).ok();
        let refused = bench.write(address, &Literal::Integer(1));
        assert!(refused.is_err(), "{address}");
        assert_eq!(bench.state().machine.controller().read(address).ok(), before);
    }
    let forced = bench.change(Change::Force { address: "O:0.0/0".to_owned(), state: Some(true) });
    assert!(forced.is_err_and(|why| why.contains("output")));
    bench.change(Change::Force { address: "other:X0".to_owned(), state: Some(true) }).expect("an input");
    bench.change(Change::EnableForces(true)).expect("both have forces");
    scans(&mut bench, 1);
    assert_eq!((read(&bench, "I:0.0/0"), read(&bench, "other:X0")), (Value::Bit(true), Value::Bit(true)));
    assert!(bench.change(Change::Mode(ModeChange::Test)).is_err(), "Do-more has no test mode");
    assert_eq!(bench.state().machine.mode(), "run", "then none goes there");
    assert!(bench.set_scan_time(std::time::Duration::from_micros(2500)).is_err(), "whole milliseconds");
}

#[test]
fn initial_values_are_stored_before_they_are_changed() {
    let mut bench = Two::of("motor/motor.RSS", &[]).bench();
    let refused = bench.write("N7:1", &Literal::Integer(5));
    assert!(refused.is_err_and(|why| why.contains("first scan")));
    set(&mut bench, "I:0.0/0", 1);
    bench.change(Change::Mode(ModeChange::Run)).expect("runs");
    scans(&mut bench, 1);
    set(&mut bench, "N7:1", 5);
    scans(&mut bench, 1);
    assert_eq!((read(&bench, "N7:1"), read(&bench, "other:N1")), (Value::Word(5), Value::Word(5)));
}

#[test]
fn a_difference_is_told_with_its_scan_and_goes_with_going_back() {
    let mut bench = running(&Two::of("motor/motor.RSS", &[SEAL]));
    set(&mut bench, "I:0.0/1", 1);
    set(&mut bench, "I:0.0/2", 1);
    scans(&mut bench, 1);
    let First { scan, what, addresses, .. } = pair(&bench).first().cloned().expect("a difference");
    assert_eq!((scan, addresses), (2, Some(("O:0.0/1".to_owned(), "Y1".to_owned()))));
    assert_eq!(what, "O:0.0/1 is 0 in the original, Y1 is 1 in the other program");
    let rows = pair(&bench).pairing().rows().to_vec();
    let differing: Vec<&str> =
        pair(&bench).differing().iter().map(|row| rows[*row as usize].original.as_str()).collect();
    assert!(differing.contains(&"B3:0/0") && !differing.contains(&"I:0.0/1"), "{differing:?}");
    scans(&mut bench, 3);
    assert_eq!(pair(&bench).first().map(|first| first.scan), Some(2), "the first one stays");
    bench.back(4).expect("no recording");
    assert_eq!((pair(&bench).first(), pair(&bench).differing()), (None, vec![]));
    assert_eq!(pair(&bench).other().controller().scans(), 1, "both went back");
    assert_eq!(read(&bench, "other:C0"), Value::Bit(false));
}

/// What a search finds is played to the scan it tells, and shows what it tells.
#[test]
fn a_counterexample_leads_to_the_difference_the_proof_tells() {
    for (example, change) in [
        ("motor/motor.RSS", SEAL),
        ("motor/motor.RSS", ("TMR\tT0\t3000", "TMR\tT0\t3010")),
        ("traffic_light/traffic_light.RSS", ("TMR\tT1\t3000", "TMR\tT1\t2000")),
        ("batch/batch.RSS", ("OUT\tY0\n", "NOP\n")),
    ] {
        let two = Two::of(example, &[change]);
        let report = two.prove(1, 100_000, None);
        assert_eq!(report.verdict(), Verdict::Different, "{example}");
        let (_, found) = report.found.as_ref().unwrap_or_else(|| panic!("{example}: {report}"));
        let mut at = Vec::new();
        for text in [&found.original, &found.other] {
            let mut bench = two.bench();
            let tape = Tape::read(text, bench.initial()).unwrap_or_else(|why| panic!("{why}\n{text}"));
            assert_eq!(tape.scans(), found.scans as u64);
            bench.play(tape).expect("no recording");
            while bench.scan(true) {
                let (played, scan) = (pair(&bench).first().is_some(), bench.tape().map(|tape| tape.1));
                assert_eq!(played, scan == Some(found.scans as u64), "{example}, scan {scan:?}\n{text}");
            }
            let first = pair(&bench).first().cloned().expect("a difference");
            assert_eq!((first.scan, &first.what), (found.scans as u64, &found.what), "{example}");
            // Back and forth on the tape leads to the same.
            let depth = bench.depth();
            assert_eq!(bench.back(depth), Ok(depth));
            assert_eq!((bench.tape().map(|tape| tape.1), pair(&bench).first()), (Some(0), None));
            while bench.scan(false) {}
            assert_eq!(pair(&bench).first(), Some(&first));
            at.push(first);
        }
        assert_eq!(at[0], at[1], "either scenario is the same tape");
    }
}

#[test]
fn a_tape_is_not_changed_by_hand() {
    let two = Two::of("motor/motor.RSS", &[SEAL]);
    let report = two.prove(1, 10_000, None);
    let mut bench = two.bench();
    let text = &report.found.expect("a difference").1.original;
    let tape = Tape::read(text, bench.initial()).expect("reads");
    bench.play(tape).expect("plays");
    assert!(bench.write("I:0.0/0", &Literal::Integer(1)).is_err_and(|why| why.contains("tape")));
    while bench.scan(true) {}
    bench.leave_tape();
    set(&mut bench, "I:0.0/0", 1);
    scans(&mut bench, 1);
    for (text, why) in [
        (text.replace("program = ", "programm = "), "programm"),
        ("program = \"x\"\nscan = \"10ms\"\n[[step]]\nset = { \"N99:0\" = 1 }\nscans = 1\n".to_owned(), "N99:0"),
        ("program = \"x\"\nscan = \"2.5ms\"\n[[step]]\nscans = 1\n".to_owned(), "milliseconds"),
        ("program = \"x\"\nscan = \"10ms\"\n[[step]]\nscans = 9000000\n".to_owned(), "at most"),
        ("program = \"x\"\nscan = \"10ms\"\n[[step]]\nset = { \"I:0.0/0\" = 1 }\n".to_owned(), "no scan"),
    ] {
        let refused = Tape::read(&text, bench.initial());
        assert!(refused.as_ref().is_err_and(|told| told.contains(why)), "{why}: {:?}", refused.err());
    }
}

#[test]
fn what_is_recorded_replays_on_both() {
    let mut bench = Two::of("motor/motor.RSS", &[]).bench();
    bench.record().expect("begins");
    set(&mut bench, "other:X1", 1);
    set(&mut bench, "I:0.0/2", 1);
    set(&mut bench, "other:X0", 1);
    scans(&mut bench, 5);
    bench.expect(&["other:Y1".to_owned(), "T4:0.ACC".to_owned()]).expect("recording");
    let (text, problems) = bench.recorded(&Default::default()).expect("recording");
    assert_eq!(problems, Vec::<String>::new(), "{text}");
    assert!(
        text.contains("\"I:0.0/1\" = 1") && text.contains("\"O:0.0/1\" = 1") && !text.contains("other:"),
        "one program's scenario: {text}"
    );
    let tape = Tape::read(&text, bench.initial()).expect("reads");
    bench.play(tape).expect("plays");
    while bench.scan(true) {}
    assert_eq!((read(&bench, "O:0.0/1"), read(&bench, "other:Y1")), (Value::Bit(true), Value::Bit(true)));
}

#[test]
fn rungs_know_what_they_were_made_from() {
    let two = Two::of("motor/motor.RSS", &[]);
    let origins = analysis::proof::origins(&two.converted);
    let from: Vec<u32> = origins.iter().map(|it| it.from).collect();
    assert_eq!(from, (0..8).collect::<Vec<u32>>());
    let rung = |at: &analysis::proof::Origin| {
        two.converted.code_blocks().nth(at.block).and_then(|block| block.rungs.get(at.rung)).expect("is there")
    };
    for (origin, output) in [(0, "OUT\tC0"), (2, "OUT\tY1"), (3, "OUT\tY0")] {
        let text: Vec<String> = rung(&origins[origin]).instructions.iter().map(ToString::to_string).collect();
        assert!(text.iter().any(|it| it.replace('\t', " ").contains(&output.replace('\t', " "))), "{text:?}");
    }
}
