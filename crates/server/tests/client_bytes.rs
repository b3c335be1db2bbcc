//! Bytes that no page sends: requests, messages and plant files damaged in all ways, always answered and never with a 5xx. The
//! fuzz target `client` does the same without end.

mod support;

use std::sync::Arc;
use std::time::Duration;

use ladder::Project;
use server::plant::Plant;
use server::view::SlcProgram;
use server::workbench::{Slc, Subject, Workbench};
use server::{Offline, engine};

const LADDER: &[&str] = &["XIC I:0.0/0 TON T4:0 0.01 100 0", "XIC T4:0/DN OTE O:0.0/0", "ADD N7:0 1 N7:1"];

const REQUESTS: &[(&str, &str)] = &[
    ("/api/control", r#"{"do": "run", "speed": 10}"#),
    ("/api/control", r#"{"do": "scan", "count": 3}"#),
    ("/api/control", r#"{"do": "until", "address": "T4:0.ACC", "relation": ">=", "value": 5, "scans": 100}"#),
    ("/api/control", r#"{"do": "mode", "mode": "power-cycle"}"#),
    ("/api/control", r#"{"do": "scan-time", "ms": 2.5e0}"#),
    ("/api/control", r#"{"do": "plant", "text": "[[motor]]\nname = \"m\"\nrun = \"O:0.0/0\"\nstart_delay = \"8ms\""}"#),
    ("/api/control", r#"{"do": "tape", "text": "name = \"t\"\nprogram = \"p\"\n[[step]]\nset = { \"N7:0\" = 3 }"}"#),
    ("/api/write", r##"{"address": "#N7:[N7:1]", "value": "0x1F0"}"##),
    ("/api/force", r#"{"address": "I:0.0/0", "state": true}"#),
    ("/api/record", r#"{"do": "expect", "addresses": ["N7:1", "T4:0/DN"]}"#),
    ("/api/trend", r#"{"addresses": ["T4:0.ACC"]}"#),
];

/// Every kind of element, with every key.
const PLANT: &str = r#"
name = "all"
[[motor]]
name = "m"
run = "O:0.0/0"
feedback = "I:0.0/1"
start_delay = "800ms"
stop_delay = "1.5s"
blocked = "B3:0/0"
[[tank]]
name = "t"
level = "N7:0"
range = 4095
start = 40.0
flows = [ { rate = 3.0 }, { when = "O:0.0/0", rate = -8.0 } ]
switches = [ { at = 80.0, hysteresis = 2.0, input = "I:0.0/2", inverted = true } ]
[[conveyor]]
name = "c"
run = "O:0.0/1"
reverse = "O:0.0/2"
length = 3.0
speed = 0.5
part = 0.2
every = "2s"
sensors = [ { at = 1.0, input = "I:0.0/3" } ]
[[heater]]
name = "h"
on = "O:0.0/3"
temperature = "N7:1"
scale = 10
ambient = 20.0
rate = 3.0
loss = 0.01
"#;

const SEEN: &str = r##"{"rungs": [[2, 0], [2, 65535]], "values": ["T4:0.ACC", "#N7:0", "S:1/5"]}"##;

/// What damaged JSON is made of.
const PARTS: &[&str] = &[
    "\"",
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "\\",
    "\\u0000",
    "\\ud800",
    "-",
    "1e999",
    "18446744073709551616",
    "0.5",
    "null",
    "true",
    "\u{0}",
    "é",
    "#",
    "/",
    ".ACC",
    "65536",
    "-1",
    "[[",
    "\"do\": \"pause\",",
];

/// The same inputs every time.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).expect("31 bits") % sides
    }

    /// A text with some places damaged.
    fn damage(&mut self, text: &str) -> Vec<u8> {
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..=self.roll(3) {
            let at = self.roll(bytes.len() + 1);
            match self.roll(4) {
                0 => drop(bytes.splice(at..at, PARTS[self.roll(PARTS.len())].bytes())),
                1 => bytes.truncate(at),
                2 => drop(bytes.drain(at..(at + self.roll(6)).min(bytes.len()))),
                _ => {
                    let letter = u8::try_from(self.roll(256)).expect("a byte");
                    if let Some(byte) = bytes.get_mut(at) {
                        *byte = letter;
                    }
                }
            }
        }
        bytes
    }
}

#[test]
fn every_request_is_answered_and_says_what_is_wrong() {
    let image = support::image(LADDER);
    let machine = support::machine(LADDER);
    let view = SlcProgram::new("bytes".to_owned(), Project { main: image, ..Project::default() }, Vec::new());
    let bench = Workbench::new(Box::<Slc>::new(machine));
    let server = Offline::new(engine::start(bench).expect("a thread"), Arc::new(view)).expect("a runtime");
    let (mut dice, mut refused, mut done) = (Dice(1), 0, 0);
    for round in 0..4000 {
        let (path, body) = REQUESTS[round % REQUESTS.len()];
        let body = if dice.roll(8) == 0 { body.as_bytes().to_vec() } else { dice.damage(body) };
        let (status, answer) = server.ask("POST", path, &body).expect("a request");
        let said = String::from_utf8_lossy(&answer);
        let body = String::from_utf8_lossy(&body);
        assert!(status < 500, "{path} {body}: {status} {said}");
        match status {
            200 => done += 1,
            _ => {
                refused += 1;
                assert!(said.starts_with("{\"error\":\"") && said.len() > 13, "{path} {body}: {status} {said}");
            }
        }
        let message = dice.damage(SEEN);
        if let Err(why) = server.see(&String::from_utf8_lossy(&message)) {
            assert!(why.contains("line "), "no place: {why}");
        }
        let query = String::from_utf8_lossy(&dice.damage("T4%3A0%2FDN&count=5"))
            .replace(|c: char| !c.is_ascii_graphic(), "%ff");
        for path in ["/api/uses?address=", "/api/search?q=", "/api/data/T4?from=", "/api/routines/2/rungs?from="] {
            if let Some((status, said)) = server.ask("GET", &format!("{path}{query}"), b"") {
                assert!(status < 500 && !said.is_empty(), "{path}{query}: {status}");
            }
        }
    }
    let (mut read, mut wrong) = (0, 0);
    for round in 0..4000 {
        let text = [include_str!("../../../examples/batch/plant.toml"), PLANT][round % 2];
        let text = String::from_utf8_lossy(&dice.damage(text)).into_owned();
        match Plant::parse(&text) {
            Ok(mut plant) => {
                read += 1;
                let mut machine = support::machine(LADDER);
                machine.controller_mut().enter_run();
                for _ in 0..3 {
                    // Addresses that do not exist are told and stop nothing.
                    let _ = plant.step(Duration::from_millis(10), &mut machine);
                }
                assert!(plant.gauges().iter().all(|gauge| gauge.value.is_finite()), "{text}");
            }
            Err(why) => {
                wrong += 1;
                assert!(!why.is_empty(), "{text}");
            }
        }
    }
    assert!(read > 200 && wrong > 200, "{read} read, {wrong} wrong");
    assert!(done > 100 && refused > 1000, "{done} done, {refused} refused");
}
