//! What clients of the workbench send: requests, messages of pages, plant files, conditions, addresses.

use std::sync::{Arc, LazyLock};
use std::time::Duration;

use server::plant::Plant;
use server::view::SlcProgram;
use server::workbench::{Slc, Subject, Workbench};
use server::{Offline, engine};

const LADDER: &str = "\
START Bul.1763

PROJECT \"FUZZ\"
  2  \"MAIN\"

LADDER 2
% Rung: 0 %
SOR XIC I:0.0/0 TON T4:0 0.01 100 0 EOR
% Rung: 1 %
SOR XIC T4:0/DN BST OTE O:0.0/0 NXB CTU C5:0 5 0 BND EOR
% Rung: 2 %
SOR ADD N7:0 1 N7:1 EOR
";

fn project() -> ladder::Project {
    convert::slc::project::read(LADDER).expect("our own text")
}

fn machine() -> Slc {
    let project = project();
    let options = sim::Options { inline: true, ..sim::Options::default() };
    let program = sim::Program::compile(&project.main, &options).expect("compiles");
    Slc::new(sim::Machine::new(program), &project.main)
}

static SERVER: LazyLock<Offline> = LazyLock::new(|| {
    let handle = engine::start(Workbench::new(Box::new(machine()))).expect("a thread");
    Offline::new(handle, Arc::new(SlcProgram::new("fuzz.SLC".to_owned(), project(), Vec::new()))).expect("a runtime")
});

/// A request (`POST /api/write`, a line end, its body), a message of a page (`LIVE`), or a plant file (`PLANT`).
pub fn client(bytes: &[u8]) {
    let cut = bytes.iter().position(|byte| *byte == b'\n').unwrap_or(bytes.len());
    let (first, body) = (&bytes[..cut], bytes.get(cut + 1..).unwrap_or_default());
    let Ok(first) = std::str::from_utf8(first) else { return };
    match (first, std::str::from_utf8(body)) {
        ("LIVE", Ok(message)) => match SERVER.see(message) {
            Ok(told) => assert!(told.starts_with("{\"frame\":"), "{told}"),
            Err(why) => assert!(why.contains("line "), "no place: {why}"),
        },
        ("PLANT", Ok(text)) => match Plant::parse(text) {
            Ok(mut plant) => {
                let mut machine = machine();
                machine.controller_mut().enter_run();
                for _ in 0..3 {
                    let _ = plant.step(Duration::from_millis(10), &mut machine);
                }
                assert!(plant.gauges().iter().all(|gauge| gauge.value.is_finite()), "{text}");
            }
            Err(why) => assert!(!why.is_empty()),
        },
        _ => {
            let Some((method, path)) = first.split_once(' ') else { return };
            let Some((status, answer)) = SERVER.ask(method, path, body) else { return };
            assert!(status < 500, "{first}: {status}");
            let answer = String::from_utf8(answer).expect("text");
            if status >= 400 && method != "HEAD" {
                assert!(answer.starts_with("{\"error\":\"") && answer.len() > 13, "{first}: {status} {answer}");
            }
        }
    }
}

/// One of everything.
#[must_use]
pub fn seeds() -> Vec<Vec<u8>> {
    let mut all: Vec<String> = [
        r#"{"do": "run", "speed": 10}"#,
        r#"{"do": "scan", "count": 3}"#,
        r#"{"do": "until", "address": "T4:0.ACC", "relation": ">=", "value": 5, "scans": 100}"#,
        r#"{"do": "back", "count": 2}"#,
        r#"{"do": "mode", "mode": "power-cycle"}"#,
        r#"{"do": "scan-time", "ms": 2.5}"#,
        r#"{"do": "keep", "name": "a"}"#,
        r#"{"do": "resume", "name": "a"}"#,
        r#"{"do": "forces", "enabled": true}"#,
        r#"{"do": "clear-forces"}"#,
        r#"{"do": "plant", "text": "[[motor]]\nname = \"m\"\nrun = \"O:0.0/0\"\n"}"#,
        r#"{"do": "tape", "text": "name = \"t\"\nprogram = \"p\"\n[[step]]\nset = { \"N7:0\" = 3 }\nscans = 2\n"}"#,
        r#"{"do": "restart"}"#,
    ]
    .map(|body| format!("POST /api/control\n{body}"))
    .to_vec();
    let others = [
        "POST /api/write\n{\"address\": \"N7:0\", \"value\": \"0x1F0\"}",
        "POST /api/force\n{\"address\": \"I:0.0/0\", \"state\": true}",
        "POST /api/record\n{\"do\": \"start\"}",
        "POST /api/record\n{\"do\": \"expect\", \"addresses\": [\"N7:1\"]}",
        "POST /api/record\n{\"do\": \"stop\", \"name\": \"r\"}",
        "POST /api/trend\n{\"addresses\": [\"T4:0.ACC\"]}",
        "GET /api/routines/2/rungs?from=1&count=2&width=90\n",
        "GET /api/data/T4?from=0&count=5\n",
        "GET /api/uses?address=T4%3A0%2FDN\n",
        "GET /api/search?q=TON%20*%200.01%20%3E%3D50\n",
        "GET /api/trend?since=3\n",
        "LIVE\n{\"rungs\": [[2, 0]], \"values\": [\"T4:0.ACC\", \"#N7:0\"]}",
    ];
    all.extend(others.map(str::to_owned));
    let plants = crate::seed::files("toml").into_iter().map(|plant| [b"PLANT\n".to_vec(), plant].concat());
    all.into_iter().map(String::into_bytes).chain(plants).collect()
}
