//! `rungs serve` as a process that is killed, starved and started again.

mod support;

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

use rungs_tests::browser::Browser;
use serde_json::{Value, json};
use support::among_examples::examples;
use support::served::Server;

/// One request; answers the JSON of its answer.
fn ask(at: SocketAddr, method: &str, path: &str, body: &str) -> Value {
    let mut stream = TcpStream::connect(at).expect("listens");
    stream.set_read_timeout(Some(Duration::from_secs(20))).expect("a time");
    let length = body.len();
    let head = format!("{method} {path} HTTP/1.1\r\nHost: {at}\r\nConnection: close\r\nContent-Length: {length}\r\n");
    write!(stream, "{head}Content-Type: application/json\r\n\r\n{body}").expect("takes it");
    let mut answer = String::new();
    stream.read_to_string(&mut answer).expect("answers");
    let (head, body) = answer.split_once("\r\n\r\n").expect("a head");
    assert!(head.starts_with("HTTP/1.1 200 "), "{path}: {answer}");
    serde_json::from_str(body).expect("JSON")
}

fn control(at: SocketAddr, what: &Value) {
    ask(at, "POST", "/api/control", &what.to_string());
}

#[test]
fn a_killed_server_loses_what_was_not_saved_and_nothing_else() {
    let program = examples().join("motor/motor.RSS");
    let before = std::fs::read(&program).expect("the example");
    let server = Server::start(&program, &[]);
    let at = server.at;
    ask(at, "POST", "/api/record", r#"{"do": "start"}"#);
    control(at, &json!({"do": "scan", "count": 3}));
    // What was saved is in the hands of whoever saved it.
    let recording = ask(at, "POST", "/api/record", r#"{"do": "stop", "name": "saved"}"#);
    let scenario = recording["scenario"].as_str().expect("a scenario").to_owned();
    control(at, &json!({"do": "keep", "name": "not saved"}));
    control(at, &json!({"do": "run", "speed": null}));
    let first = ask(at, "GET", "/api/state", "");
    server.kill();
    assert_eq!(std::fs::read(&program).expect("the example"), before, "serving changes no file");
    let port = at.port().to_string();
    let server = Server::start(&program, &["--port", &port]);
    assert_eq!(server.at, at, "the same address again");
    let again = ask(at, "GET", "/api/state", "");
    assert_ne!(again["server"], first["server"], "another run, and it says so");
    assert_eq!((&again["scans"], &again["snapshots"]), (&json!(0), &json!([])));
    // The recording replays on it as on any machine.
    let file = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("saved.toml");
    let place = program.canonicalize().expect("a path");
    let here = scenario.replace("\"motor.RSS\"", &format!("{:?}", place.to_string_lossy()));
    std::fs::write(&file, here).expect("saved");
    let played = support::at_root::rungs(&["test", &file.to_string_lossy()]);
    assert!(played.status.success(), "{}", String::from_utf8_lossy(&played.stdout));
}

/// What a page says and does when its server is killed and started again.
#[test]
fn a_page_tells_that_the_controller_was_started_again() {
    let Some(browser) = Browser::start() else { return };
    let program = examples().join("motor/motor.RSS");
    let server = Server::start(&program, &[]);
    let at = server.at;
    browser.go(&format!("http://{at}/#ladder/2"));
    browser.wait_for("document.querySelector('.rung svg g.i')");
    browser.click("#step");
    browser.wait_for("document.querySelector('#status').textContent.includes('scan 1 ')");
    assert_eq!(browser.complaints(), Vec::<String>::new());
    server.kill();
    browser.wait_for("document.body.classList.contains('offline')");
    let port = at.port().to_string();
    let server = Server::start(&program, &["--port", &port]);
    let told = "[...document.querySelectorAll('.banner.wrong')].some((one) => \
                one.textContent.includes('started again') && one.textContent.includes('not saved is gone'))";
    browser.wait_for(told);
    browser.wait_for("!document.body.classList.contains('offline')");
    browser.wait_for("document.querySelector('#status').textContent.includes('scan 0 ')");
    // While there was no server the browser itself logged that it found none; from here on all is well.
    let _ = browser.complaints();
    browser.click("#step");
    browser.wait_for("document.querySelector('#status').textContent.includes('scan 1 ')");
    browser.wait_for("document.querySelector('.rung svg g.i:not(.idle)')");
    // Another program at the same address: the page shows that one, and says the same.
    server.kill();
    browser.wait_for("document.body.classList.contains('offline')");
    let _server = Server::start(&examples().join("batch/batch.RSS"), &["--port", &port]);
    browser.wait_for("document.querySelector('#title').textContent === 'batch.RSS'");
    browser.wait_for(told);
    let _ = browser.complaints();
    browser.click("#step");
    browser.wait_for("document.querySelector('#status').textContent.includes('scan 1 ')");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

/// Resident memory of a process in KiB; `None` where the system does not tell.
fn memory(id: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{id}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    line.trim().trim_end_matches(" kB").parse().ok()
}

/// Twenty pages that never read, and many requests whose answers nobody takes.
#[test]
fn clients_that_never_read_do_not_fill_memory() {
    let server = Server::start(&examples().join("motor/motor.RSS"), &[]);
    let at = server.at;
    control(at, &json!({"do": "run", "speed": 1.0}));
    let Some(before) = memory(server.id()) else { return };
    let mut deaf = Vec::new();
    for _ in 0..20 {
        let mut stream = TcpStream::connect(at).expect("listens");
        let upgrade = "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
                       Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
        write!(stream, "GET /api/live HTTP/1.1\r\nHost: {at}\r\n{upgrade}").expect("takes it");
        deaf.push(stream);
        let mut stream = TcpStream::connect(at).expect("listens");
        let many = format!("GET /api/routines/2/rungs?count=200 HTTP/1.1\r\nHost: {at}\r\n\r\n").repeat(60);
        stream.set_write_timeout(Some(Duration::from_millis(200))).expect("a time");
        // The server stops reading when nobody takes its answers.
        let _ = stream.write_all(many.as_bytes());
        deaf.push(stream);
    }
    let first = ask(at, "GET", "/api/state", "")["scans"].as_u64();
    std::thread::sleep(Duration::from_secs(3));
    let last = ask(at, "GET", "/api/state", "")["scans"].as_u64();
    assert!(last > first.map(|first| first + 50), "the engine goes on: {first:?} {last:?}");
    let after = memory(server.id()).expect("as before");
    assert!(after < before + 65_536, "{before} KiB before, {after} KiB after");
}
