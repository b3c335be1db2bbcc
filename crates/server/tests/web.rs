//! The server as a browser and as an attacker meet it.

mod support;

use std::time::Duration;

use futures_util::SinkExt;
use serde_json::{Value, json};
use server::workbench::Workbench;
use server::{Access, engine};
use support::wire::{ask, get, live, post, serve, told};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio_tungstenite::tungstenite::Message;

#[tokio::test]
async fn a_program_is_run_and_told() {
    let at = serve(Access::default()).await;
    assert_eq!(post(at, "/api/write", json!({"address": "I:0.0/0", "value": true})).await.0, 200);
    assert_eq!(post(at, "/api/control", json!({"do": "scan", "count": 51})).await, (200, json!({"scans": 51})));
    let (_, state) = get(at, "/api/state").await;
    assert_eq!((&state["mode"], &state["scans"], &state["time"]), (&json!("run"), &json!(51), &json!(0.5)));
    assert_eq!(post(at, "/api/control", json!({"do": "back", "count": 20})).await, (200, json!({"scans": 20})));
    let until = json!({"do": "until", "address": "T4:0/DN", "relation": "=", "value": 1, "scans": 1000});
    assert_eq!(post(at, "/api/control", until).await.0, 200);
    let mut state = Value::Null;
    for _ in 0..100 {
        state = get(at, "/api/state").await.1;
        if state["ended"] != Value::Null {
            break;
        }
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    assert_eq!((&state["ended"], &state["scans"]), (&json!("the condition holds"), &json!(101)));
}

/// Who is answered that something was done sees it done, whatever else waits for the engine.
#[tokio::test]
async fn what_was_done_is_shown_before_it_is_answered() {
    let bench = Workbench::new(Box::new(support::machine(&["XIC I:0.0/0 OTE B3:0/0"])));
    let handle = engine::start(bench).expect("a thread");
    let busy = |time| handle.ask(move |_| std::thread::sleep(Duration::from_millis(time)));
    let change = async {
        handle.ask(|engine| engine.bench.keep("here")).await.expect("taken").expect("kept");
        handle.frames().borrow().status.snapshots.clone()
    };
    // The first keeps the engine busy until the others wait; the last one holds up the frame of both.
    let (first, shown, last) = tokio::join!(busy(100), change, busy(200));
    assert_eq!((first, shown, last), (Ok(()), vec!["here".to_owned()], Ok(())));
}

#[tokio::test]
async fn a_browser_is_told_what_it_shows_and_only_changes() {
    let at = serve(Access::default()).await;
    let mut socket = live(at).await;
    let see = json!({"rungs": [[2, 0]], "values": ["T4:0.ACC", "N7:0", "N99:0"]});
    socket.send(Message::Text(see.to_string().into())).await.expect("sends");
    let first = told(&mut socket, |told| told["values"] != Value::Null).await;
    assert_eq!(first["values"], json!({"T4:0.ACC": 0, "N7:0": 0, "N99:0": null}));
    assert_eq!(first["rungs"], json!({"2:0": "00"}), "not executed yet");
    post(at, "/api/write", json!({"address": "I:0.0/0", "value": 1})).await;
    post(at, "/api/control", json!({"do": "scan", "count": 3})).await;
    let next = told(&mut socket, |told| told["status"]["scans"] == json!(3)).await;
    assert_eq!(next["values"], json!({"T4:0.ACC": 2, "N7:0": 3}), "N99:0 has not changed");
    assert_eq!(next["rungs"], json!({"2:0": "77"}));
    post(at, "/api/force", json!({"address": "O:0.0/0", "state": true})).await;
    let forced = told(&mut socket, |told| told["status"]["forces"] != json!([])).await;
    assert_eq!(forced["status"]["forces"], json!([["O:0.0/0", true]]));
    assert_eq!(forced.get("values"), None, "nothing shown has changed");
}

#[tokio::test]
async fn other_origins_and_names_are_kept_out() {
    let at = serve(Access::default()).await;
    let status = async |headers: String| ask(at, "GET /api/state", &headers, "").await.0;
    assert_eq!(status(format!("Host: {at}\r\n")).await, 200);
    assert_eq!(status(format!("Host: localhost:{}\r\n", at.port())).await, 200);
    assert_eq!(status("Host: plant.example:80\r\n".to_owned()).await, 403, "a name that was made to point here");
    assert_eq!(status(format!("Host: {at}\r\nHost: {at}\r\n")).await, 403);
    assert_eq!(status(format!("Host: {at}\r\nOrigin: http://{at}\r\n")).await, 200);
    for origin in ["http://plant.example", "null", "https://127.0.0.1", "http://127.0.0.1"] {
        assert_eq!(status(format!("Host: {at}\r\nOrigin: {origin}\r\n")).await, 403, "{origin}");
    }
    for host in ["localhost.", "127.1", "2130706433", "0.0.0.0", "user@127.0.0.1", "127.0.0.1.plant.example", ""] {
        assert_eq!(status(format!("Host: {host}:{}\r\n", at.port())).await, 403, "{host}");
    }
    assert_eq!(status("Host: 127.0.0.1\r\n".to_owned()).await, 403, "another port");
    // The first line can name a server as well.
    let line =
        async |server: &str| ask(at, &format!("GET http://{server}/api/state"), &format!("Host: {at}\r\n"), "").await.0;
    assert_eq!((line(&at.to_string()).await, line("plant.example").await), (200, 403));
    // What browsers say about where a request comes from.
    let fetched = async |site: &str, mode: &str, to: &str| {
        let said = format!("Sec-Fetch-Site: {site}\r\nSec-Fetch-Mode: {mode}\r\nSec-Fetch-Dest: {to}\r\n");
        status(format!("Host: {at}\r\n{said}")).await
    };
    assert_eq!(fetched("same-origin", "cors", "empty").await, 200);
    assert_eq!(fetched("none", "navigate", "document").await, 200);
    assert_eq!(fetched("cross-site", "navigate", "document").await, 200, "a link");
    assert_eq!(fetched("cross-site", "no-cors", "image").await, 403);
    assert_eq!(fetched("cross-site", "navigate", "iframe").await, 403);
    assert_eq!(fetched("same-site", "no-cors", "script").await, 403);
    let (_, head, _) = ask(at, "OPTIONS /api/write", &format!("Host: {at}\r\n"), "").await;
    assert!(!head.contains("access-control"), "{head}");
    let upgrade = format!(
        "Host: {at}\r\nOrigin: http://plant.example\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
         Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
    );
    assert_eq!(ask(at, "GET /api/live", &upgrade, "").await.0, 403);
    // What a form of another page can send has no JSON type.
    let form = format!("Host: {at}\r\nContent-Type: text/plain\r\n");
    assert_eq!(ask(at, "POST /api/control", &form, "{\"do\":\"pause\"}").await.0, 415);
}

#[tokio::test]
async fn a_token_opens_the_door_and_nothing_else() {
    let at = serve(Access { token: Some("0123456789abcdef".to_owned()), ..Access::default() }).await;
    let host = format!("Host: {at}\r\n");
    assert_eq!(ask(at, "GET /", &host, "").await.0, 401);
    assert_eq!(ask(at, "GET /?token=0123456789abcdee", &host, "").await.0, 401);
    let bearer = format!("{host}Authorization: Bearer 0123456789abcdef\r\n");
    let described = ask(at, "GET /api/openapi.json", &bearer, "").await.2;
    let described: Value = serde_json::from_str(&described).expect("JSON");
    for path in described["paths"].as_object().expect("paths").keys() {
        let (status, head, body) = ask(at, &format!("GET {path}"), &host, "").await;
        assert_eq!(status, 401, "{path}");
        assert!(!format!("{head}{body}").contains("0123456789abcdef"), "{path}: {head}{body}");
    }
    let (status, head, _) = ask(at, "GET /?token=0123456789abcdef", &host, "").await;
    assert!(status == 303 && head.contains("httponly; samesite=strict"), "{head}");
    assert_eq!(ask(at, "GET /", &format!("{host}Cookie: a=b; rungs-token=0123456789abcdef\r\n"), "").await.0, 200);
    assert_eq!(ask(at, "GET /", &format!("{host}Authorization: Bearer 0123456789abcdef\r\n"), "").await.0, 200);
    assert_eq!(ask(at, "GET /", &format!("{host}Authorization: Bearer 0123456789abcde\r\n"), "").await.0, 401);
}

#[tokio::test]
async fn who_may_only_look_changes_nothing() {
    let at = serve(Access { read_only: true, ..Access::default() }).await;
    assert_eq!(get(at, "/api/state").await.1["read_only"], json!(true));
    for (path, body) in [
        ("/api/control", json!({"do": "restart"})),
        ("/api/write", json!({"address": "N7:0", "value": 1})),
        ("/api/force", json!({"address": "I:0.0/0", "state": true})),
        ("/api/record", json!({"do": "start"})),
        ("/api/trend", json!({"addresses": []})),
    ] {
        assert_eq!(post(at, path, body).await.0, 403, "{path}");
    }
}

#[tokio::test]
async fn what_makes_no_sense_is_refused_with_a_reason() {
    let at = serve(Access::default()).await;
    for (path, body, status) in [
        ("/api/control", json!({"do": "dance"}), 422),
        ("/api/control", json!({"do": "scan", "count": 1_000_000}), 422),
        ("/api/control", json!({"do": "scan", "count": -1}), 422),
        ("/api/control", json!({"do": "run", "speed": 0}), 422),
        ("/api/control", json!({"do": "run", "speed": 1e300}), 422),
        ("/api/control", json!({"do": "scan-time", "ms": -5}), 422),
        ("/api/control", json!({"do": "scan-time", "ms": 1e300}), 422),
        ("/api/control", json!({"do": "mode", "mode": "remote"}), 422),
        ("/api/control", json!({"do": "resume", "name": "none"}), 409),
        ("/api/control", json!({"do": "keep", "name": "x".repeat(300)}), 422),
        ("/api/control", json!({"do": "plant", "text": "[[tank]]"}), 409),
        ("/api/control", json!({"do": "until", "address": "N99:0", "relation": "=", "value": 0}), 409),
        ("/api/write", json!({"address": "N7:0", "value": 70000}), 409),
        ("/api/write", json!({"address": "N7:0", "value": "five"}), 409),
        ("/api/write", json!({"address": "", "value": 1}), 422),
        ("/api/force", json!({"address": "N7:0", "state": true}), 409),
        ("/api/record", json!({"do": "stop", "name": "x"}), 409),
        ("/api/trend", json!({"addresses": ["T4:0"]}), 409),
        ("/api/control", json!({"do": "pause", "speed": 1}), 422),
        ("/api/trend", json!({"addresses": vec!["N7:0"; 33]}), 422),
        ("/api/write", json!({"address": "N".repeat(201), "value": 1}), 422),
        ("/api/write", json!(["N7:0", 1]), 422),
        ("/api/control", json!(["pause"]), 422),
        ("/api/nothing", json!({}), 404),
        ("/api/state", json!({}), 405),
    ] {
        let (found, answer) = post(at, path, body.clone()).await;
        assert_eq!(found, status, "{path} {body}: {answer}");
        assert!(answer["error"].as_str().is_some_and(|why| !why.is_empty()), "{path} {body}: {answer}");
    }
    for path in [
        "/api/uses?address=..%2F..",
        "/api/data/N99",
        "/api/routines/9/rungs",
        "/api/routines/x/rungs",
        "/assets/..%2Fmain.js",
        "/api/search?q=",
        "/api/routines/2/rungs?count=201",
        "/api/routines/2/rungs?from=0.5",
        "/api/routines/2/heights?width=59",
        "/api/routines/9/heights",
    ] {
        let (status, answer) = get(at, path).await;
        assert!((400..500).contains(&status) && answer["error"].is_string(), "{path}: {status} {answer}");
    }
    let long = json!({"do": "plant", "text": "#".repeat(1 << 20)});
    assert_eq!(post(at, "/api/control", long).await.0, 413);
}

/// What stands in the description is what is there, and nothing else.
#[tokio::test]
async fn routes_take_the_methods_that_are_described() {
    let at = serve(Access::default()).await;
    let (_, described) = get(at, "/api/openapi.json").await;
    let paths = described["paths"].as_object().expect("paths");
    assert!(paths.len() >= 16, "{}", paths.len());
    for (path, operations) in paths {
        let real = path.replace("{routine}", "2").replace("{file}", "N7").replace("{name}", "main.js");
        for method in ["GET", "POST", "PUT", "PATCH", "DELETE", "TRACE"] {
            let described = operations.get(method.to_lowercase()).is_some();
            let (status, head, _) = ask(at, &format!("{method} {real}"), &format!("Host: {at}\r\n"), "").await;
            assert_eq!(status != 405, described, "{method} {path}: {status}");
            assert_eq!(head.contains("\r\nallow: "), status == 405, "{method} {path}: {head}");
        }
    }
}

#[tokio::test]
async fn one_address_cannot_ask_without_end() {
    let at = serve(Access::default()).await;
    let mut stream = TcpStream::connect(at).await.expect("listens");
    let request = format!("GET /api/state HTTP/1.1\r\nHost: {at}\r\n\r\n");
    stream.write_all(request.repeat(2100).as_bytes()).await.expect("takes it");
    let mut seen = String::new();
    let mut part = vec![0; 1 << 16];
    while !seen.contains("429") {
        let count = stream.read(&mut part).await.expect("reads");
        assert!(count > 0, "closed");
        seen.push_str(&String::from_utf8_lossy(&part[..count]));
    }
}

/// Requests that are no proper HTTP, or say more than one thing, are refused and harm nobody.
#[tokio::test]
async fn malformed_requests_are_refused() {
    let at = serve(Access::default()).await;
    let typed = format!("Host: {at}\r\nConnection: close\r\nContent-Type: application/json\r\n");
    let write = "POST /api/write HTTP/1.1\r\n";
    for (request, status) in [
        (format!("{write}{typed}Content-Length: 2\r\nContent-Length: 3\r\n\r\n{{}} "), "400"),
        (format!("{write}{typed}Transfer-Encoding: chunked\r\n\r\nzz\r\n{{}}\r\n0\r\n\r\n"), "400"),
        (format!("{write}{typed}Transfer-Encoding: gzip\r\n\r\n{{}}"), "400"),
        (format!("{write}{typed}Content-Length: 999999999999\r\n\r\n"), "413"),
        (format!("{write}{typed}Content-Length: 100000\r\n\r\n{}", "[".repeat(100_000)), "422"),
        (format!("GET /api/search?q={} HTTP/1.1\r\n{typed}\r\n", "a".repeat(20_000)), "400"),
        (format!("GET /api/search?q={} HTTP/1.1\r\n{typed}\r\n", "a".repeat(60_000)), "431"),
        (format!("GET /api/state HTTP/1.1\r\n{typed}{}\r\n", "X-A: b\r\n".repeat(100)), "431"),
        (format!("GET /api/state HTTP/1.1\r\n{typed}X-A: b\r\n c\r\n\r\n"), "400"),
        (format!("GET /assets/../api.js HTTP/1.1\r\n{typed}\r\n"), "404"),
        (format!("GET /assets/%2e%2e%2fapi.js HTTP/1.1\r\n{typed}\r\n"), "404"),
        (format!("GET //api/state HTTP/1.1\r\n{typed}\r\n"), "404"),
        (format!("GET /api/data/%ff HTTP/1.1\r\n{typed}\r\n"), "400"),
        (format!("CONNECT plant.example:80 HTTP/1.1\r\n{typed}\r\n"), "403"),
        ("GET /api/state HTTP/1.0\r\n\r\n".to_owned(), "403"),
        ("\u{16}\u{3}\u{1}\u{2}\r\n\r\n".to_owned(), "400"),
    ] {
        let mut stream = TcpStream::connect(at).await.expect("listens");
        // A refused request may not be read to its end.
        let _ = stream.write_all(request.as_bytes()).await;
        let mut answer = vec![0; 12];
        let _ = stream.read_exact(&mut answer).await;
        let answer = String::from_utf8_lossy(&answer).into_owned();
        assert_eq!(answer.get(9..12), Some(status), "{answer} to {request:.200}");
    }
    assert_eq!(get(at, "/api/state").await.0, 200);
}

#[tokio::test]
async fn pages_load_nothing_from_elsewhere() {
    let at = serve(Access::default()).await;
    let host = format!("Host: {at}\r\n");
    let (status, head, page) = ask(at, "GET /", &host, "").await;
    assert_eq!(status, 200);
    assert!(head.contains("content-security-policy: default-src 'none'") && head.contains("frame-ancestors 'none'"));
    assert!(!head.contains("unsafe-") && !head.contains("access-control-"), "{head}");
    for line in ["x-content-type-options: nosniff", "x-frame-options: deny", "referrer-policy: no-referrer"] {
        assert!(head.contains(line), "{line}: {head}");
    }
    let named: Vec<&str> = page.split(['"', '\'']).filter(|part| part.starts_with("/assets/")).collect();
    assert!(named.len() >= 3, "{named:?}");
    for path in named {
        assert_eq!(ask(at, &format!("GET {path}"), &host, "").await.0, 200, "{path}");
    }
    assert!(!page.contains("http://") && !page.contains("https://"));
}
