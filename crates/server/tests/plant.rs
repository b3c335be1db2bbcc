//! Plant models in the loop with a program.

mod support;

use ladder::Value;
use server::plant::Plant;
use server::workbench::{Change, ModeChange, Recorded, Workbench};
use support::{machine, read};

/// A running program with a plant.
fn bench(ladder: &[&str], plant: &str) -> Workbench {
    let mut bench = Workbench::new(Box::new(machine(ladder)));
    let plant = Plant::parse(plant).expect("reads");
    bench.change(Change::Plant(Some(Box::new(plant)))).expect("can");
    bench.change(Change::Mode(ModeChange::Run)).expect("can");
    bench
}

/// Scans of 10 ms until a bit is so, at most 100,000.
fn until(bench: &mut Workbench, address: &str, on: bool) -> usize {
    let reached = (0..100_000).find(|_| {
        assert!(bench.scan(false), "it runs");
        assert_eq!(bench.state().plant_wrong, None);
        read(bench, address) == Value::Bit(on)
    });
    reached.unwrap_or_else(|| panic!("{address} never became {on}")) + 1
}

fn gauge(bench: &Workbench, element: &str) -> f64 {
    let gauges = bench.state().plant.as_ref().map(Plant::gauges).unwrap_or_default();
    gauges.iter().find(|gauge| gauge.element == element).map(|gauge| gauge.value).expect(element)
}

#[test]
fn feedback_of_a_motor_comes_late() {
    let plant = r#"motor = [{ name = "pump", run = "O:0.0/0", feedback = "I:0.0/1", start_delay = "500ms", stop_delay = "200ms" }]"#;
    let mut bench = bench(&["XIC B3:0/0 OTE O:0.0/0", "XIC I:0.0/1 OTE B3:0/1"], plant);
    bench.scan(false);
    let on = |bench: &mut Workbench, value| {
        bench.change(Change::Write { address: "B3:0/0".to_owned(), value: Value::Bit(value) }).expect("can");
    };
    on(&mut bench, true);
    // One scan for the output, 50 for the motor, seen by the program in the last of them.
    assert_eq!(until(&mut bench, "B3:0/1", true), 51);
    on(&mut bench, false);
    assert_eq!(until(&mut bench, "B3:0/1", false), 21);
}

const TANK: &str = r#"
[[tank]]
name = "sump"
level = "N7:0"
range = 1000
start = 50
flows = [{ rate = 5.0 }, { when = "O:0.0/0", rate = -15.0 }]
switches = [{ at = 80, hysteresis = 5, input = "I:0.0/0" }, { at = 20, input = "I:0.0/1" }]
"#;

/// Pump on at the upper switch, off below the lower one.
const PUMP: &[&str] = &["BST XIC I:0.0/0 NXB XIC O:0.0/0 BND XIC I:0.0/1 OTE O:0.0/0", "MOV N7:0 N7:1"];

#[test]
fn a_tank_is_pumped_between_its_switches() {
    let mut bench = bench(PUMP, TANK);
    // 30 % at 5 % per second; the first scan passes no time.
    let filled = until(&mut bench, "O:0.0/0", true);
    assert!((600..=602).contains(&filled), "{filled}");
    assert!((read(&bench, "N7:0") == Value::Word(800)) && (gauge(&bench, "sump") - 80.0).abs() < 0.06);
    // 60 % at 10 % per second.
    let emptied = until(&mut bench, "O:0.0/0", false);
    assert!((600..=603).contains(&emptied), "{emptied}");
    assert_eq!(read(&bench, "I:0.0/0"), Value::Bit(false));
}

#[test]
fn the_plant_goes_back_with_the_program() {
    let mut bench = bench(PUMP, TANK);
    let mut levels = Vec::new();
    for _ in 0..900 {
        bench.scan(false);
        levels.push(gauge(&bench, "sump"));
    }
    assert_eq!(bench.back(700), Ok(700));
    assert_eq!(Some(gauge(&bench, "sump")), levels.get(199).copied());
    for level in levels.iter().skip(200) {
        bench.scan(false);
        assert_eq!(gauge(&bench, "sump"), *level, "it goes on as it did");
    }
}

#[test]
fn what_the_plant_did_is_in_a_recording() {
    let mut bench = bench(PUMP, TANK);
    bench.record().expect("begins");
    for _ in 0..1400 {
        bench.scan(false);
    }
    bench.expect(&["O:0.0/0".to_owned(), "N7:1".to_owned()]).expect("recording");
    let (text, problems) = bench.recorded(&Recorded::default()).expect("recording");
    assert_eq!(problems, Vec::<String>::new(), "the replay has no plant and ends the same: {text}");
}

#[test]
fn parts_pass_the_sensors_of_a_conveyor() {
    let plant = r#"
[[conveyor]]
name = "belt"
run = "O:0.0/0"
length = 2.0
speed = 0.5
part = 0.25
feed = "I:0.0/7"
sensors = [{ at = 0.5, input = "I:0.0/0" }, { at = 1.5, input = "I:0.0/1" }]
"#;
    let mut bench = bench(&["XIO I:0.0/6 OTE O:0.0/0", "XIC I:0.0/1 CTU C5:0 9 0", "XIC I:0.0/7 OTE B3:0/0"], plant);
    bench.scan(false);
    bench.change(Change::Write { address: "I:0.0/7".to_owned(), value: Value::Bit(true) }).expect("can");
    // 0.5 m at 0.5 m/s.
    let first = until(&mut bench, "I:0.0/0", true);
    assert!((100..=102).contains(&first), "{first}");
    // The part is a quarter of a metre long.
    let gone = until(&mut bench, "I:0.0/0", false);
    assert!((50..=52).contains(&gone), "{gone}");
    until(&mut bench, "C5:0/CU", true);
    assert_eq!(read(&bench, "C5:0.ACC"), Value::Word(1));
    // It falls off behind the end.
    for _ in 0..200 {
        bench.scan(false);
    }
    assert_eq!(gauge(&bench, "belt"), 0.0);
}

#[test]
fn a_heater_nears_its_balance() {
    let plant = r#"
[[heater]]
name = "oven"
on = "O:0.0/0"
temperature = "N7:0"
scale = 10
rate = 2.0
loss = 0.02
"#;
    let mut bench = bench(&["LES N7:0 5000 OTE O:0.0/0"], plant);
    for _ in 0..100_000 {
        bench.scan(false);
    }
    // 20 degrees around, and 2 / 0.02 above.
    assert!((gauge(&bench, "oven") - 120.0).abs() < 0.5, "{}", gauge(&bench, "oven"));
    assert_eq!(read(&bench, "N7:0"), Value::Word((gauge(&bench, "oven") * 10.0).round() as i16));
}

#[test]
fn a_wrong_address_is_named_and_stops_nothing() {
    let mut bench = bench(PUMP, r#"motor = [{ name = "m", run = "O:0.0/0", feedback = "N99:0" }]"#);
    assert!(bench.scan(false));
    assert!(bench.state().plant_wrong.as_ref().is_some_and(|why| why.contains("N99:0")));
}

#[test]
fn a_plant_file_with_a_mistake_is_refused() {
    for (text, expected) in [
        ("[[motor]]\nname = \"m\"\nrun = \"O:0/0\"\nfeedback = \"I:0/0\"\nstart_delay = \"soon\"", "soon"),
        ("[[motor]]\nname = \"m\"\nrun = \"O:0/0\"\nfeedbach = \"I:0/0\"", "feedbach"),
        ("[[tank]]\nname = \"t\"\nstart = 101", "start"),
        ("[[tank]]\nname = \"t\"\nstart = nan", "start"),
        ("[[heater]]\nname = \"h\"\non = \"O:0/0\"\ntemperature = \"N7:0\"\nrate = 1\nloss = 2", "loss"),
        ("[[pump]]\nname = \"p\"", "pump"),
        ("no toml", "line 1"),
    ] {
        let why = Plant::parse(text).expect_err(text);
        assert!(why.contains(expected), "{text}: {why}");
    }
}
