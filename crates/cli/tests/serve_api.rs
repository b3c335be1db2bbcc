//! The interface of `rungs serve` against its own description: a schema-driven tester makes requests that fit
//! `/api/openapi.json` and requests that do not, and looks at every answer.
//!
//! `cargo xtask setup` installs the tester. It stays below the limit of 2,000 requests in ten seconds that the server
//! keeps for everybody.

mod support;

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use support::among_examples::examples;
use support::served::Server;

/// Set to 1, these tests say that they are skipped.
const WITHOUT: &str = "RUNGS_NO_API_TESTER";

/// Far more than a run takes: a server that hangs must not hang the tests.
const PATIENCE: Duration = Duration::from_secs(180);

/// The tester below the target folder; `None` where these tests are left out.
fn tester() -> Option<PathBuf> {
    if std::env::var_os(WITHOUT).is_some_and(|value| value == "1") {
        println!("skipped: {WITHOUT}=1");
        return None;
    }
    let folder = if cfg!(windows) { "Scripts" } else { "bin" };
    let name = format!("schemathesis/{folder}/schemathesis{}", std::env::consts::EXE_SUFFIX);
    let found = Path::new(env!("CARGO_BIN_EXE_rungs")).ancestors().map(|folder| folder.join(&name));
    let found = found.into_iter().find(|path| path.is_file());
    Some(found.unwrap_or_else(|| {
        panic!(
            "the tester of interfaces is missing: `cargo xtask setup` installs it; {WITHOUT}=1 leaves these tests out"
        )
    }))
}

/// Runs the tester with every check it has on a server, in a folder of its own.
fn conforms(name: &str, program: &str, arguments: &[&str]) {
    let Some(tester) = tester() else { return };
    let server = Server::start(&examples().join(program), arguments);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("serve-api-{name}"));
    std::fs::create_dir_all(&folder).expect("a folder");
    let mut command = Command::new(tester);
    command.current_dir(&folder).env("PYTHONUTF8", "1").env("NO_COLOR", "1");
    command.arg("--config-file").arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/schemathesis.toml"));
    command.arg("run").arg(format!("http://{}/api/openapi.json", server.at));
    command.args(["--checks", "all", "--continue-on-failure", "--seed", "1", "--max-examples", "20", "--no-shrink"]);
    command.args(["--rate-limit", "190/s", "--request-timeout", "20"]);
    if let Some(token) = &server.token {
        command.arg("--header").arg(format!("Authorization: Bearer {token}"));
    }
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::inherit()).spawn().expect("the tester starts");
    let mut out = child.stdout.take().expect("its output");
    let said = std::thread::spawn(move || {
        let mut said = Vec::new();
        out.read_to_end(&mut said).map(|_| String::from_utf8_lossy(&said).into_owned())
    });
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().expect("its status") {
            break status;
        }
        if start.elapsed() > PATIENCE {
            child.kill().expect("it is ours");
            panic!("the tester did not end in {PATIENCE:?}");
        }
        std::thread::sleep(Duration::from_millis(50));
    };
    let said = said.join().expect("reads").expect("its output");
    let said: Vec<String> = said.lines().map(|line| line.chars().take(300).collect()).collect();
    let said = said.join("\n");
    assert!(status.success(), "{name}: {said}");
    // Every operation was tried, and none left out because its description could not be read.
    let count = |what: &str| {
        let number = said.lines().find_map(|line| line.trim().strip_prefix(what)?.trim().split('/').next());
        number.and_then(|number| number.parse::<usize>().ok()).unwrap_or_else(|| panic!("no `{what}` in {said}"))
    };
    assert!(count("Tested:") >= 16 && count("Tested:") == count("Selected:"), "{said}");
    println!("{name}: {}", said.lines().rfind(|line| line.contains("generated")).unwrap_or_default().trim());
}

#[test]
fn an_slc_program_is_served_as_described() {
    conforms("slc", "motor/motor.RSS", &[]);
}

#[test]
fn a_do_more_program_is_served_as_described() {
    conforms("do-more", "filling_domore/filling.txt", &["--plant", "../../examples/filling_domore/plant.toml"]);
}

#[test]
fn a_read_only_server_answers_as_described() {
    conforms("read-only", "batch/batch.RSS", &["--read-only"]);
}

#[test]
fn a_server_for_others_wants_its_token_everywhere() {
    conforms("token", "motor/motor.RSS", &["--address", "0.0.0.0"]);
}

#[test]
fn two_programs_are_served_as_described() {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("serve-api-migrated");
    let mut command = Command::new(env!("CARGO_BIN_EXE_rungs"));
    command.arg("migrate").arg(examples().join("motor/motor.RSS"));
    let done = command.args(["--to", "domore", "--overwrite", "--out"]).arg(&out).output().expect("migrates");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let [text, map] = ["motor.txt", "address-map.csv"].map(|name| out.join(name).to_string_lossy().into_owned());
    conforms("pair", "motor/motor.RSS", &[&text, "--map", &map]);
}
