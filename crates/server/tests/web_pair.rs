//! Two programs side by side as a browser meets them.

mod support;
#[path = "support/pair.rs"]
mod two;

use std::net::SocketAddr;
use std::time::Duration;

use futures_util::SinkExt;
use serde_json::{Value, json};
use server::workbench::Workbench;
use server::{Access, engine};
use support::wire::{get, live, post, serve, told};
use tokio::net::TcpListener;
use tokio_tungstenite::tungstenite::Message;

/// Two programs side by side, the converted one with a contact inverted.
async fn serve_two(changes: &[(&str, &str)], access: Access) -> SocketAddr {
    let two = two::Two::of("motor/motor.RSS", changes);
    let pair = two.pair();
    let (program, pages) = two.views(&pair);
    let listener = TcpListener::bind("127.0.0.1:0").await.expect("a free port");
    let address = listener.local_addr().expect("bound");
    let handle = engine::start(Workbench::new(Box::new(pair))).expect("a thread");
    tokio::spawn(server::serve_pair(listener, handle, program, pages, access, std::future::pending()));
    address
}

const SEAL: (&str, &str) = ("STR\tX0\nOR\tC0\n", "STR\tX0\nORN\tC0\n");

#[tokio::test]
async fn two_programs_are_told_together() {
    let at = serve_two(&[SEAL], Access::default()).await;
    let (_, pair) = get(at, "/api/pair").await;
    assert_eq!((&pair["original"], &pair["other"]), (&json!("original.RSS"), &json!("converted.txt")));
    assert_eq!(pair["rungs"][0], json!([2, 0, 0, 5]), "{pair}");
    let (_, rows) = get(at, "/api/pair/rows").await;
    let row = |name: &str| rows.as_array().expect("rows").iter().find(|row| row["original"] == name).expect(name);
    assert_eq!((&row("I:0.0/1")["other"], &row("I:0.0/1")["symbol"]), (&json!("X1"), &json!("STOP_PB")));
    assert_eq!(get(at, "/api/other/project").await.1["dialect"], "do-more");
    assert_eq!(get(at, "/api/other/routines/0/rungs?from=5&count=1").await.1[0]["instructions"][1]["mnemonic"], "ORN");
    let mut socket = live(at).await;
    let see = json!({"rungs": [[2, 0]], "other_rungs": [[0, 5]], "rows": [row("I:0.0/1")["row"], row("B3:0/0")["row"], 9999],
        "values": ["other:Y1"]});
    socket.send(Message::Text(see.to_string().into())).await.expect("sends");
    // An input of either side goes to both.
    assert_eq!(post(at, "/api/other/write", json!({"address": "X1", "value": true})).await.0, 200);
    assert_eq!(post(at, "/api/write", json!({"address": "I:0.0/2", "value": 1})).await.0, 200);
    let refused = post(at, "/api/other/write", json!({"address": "C17", "value": 1})).await;
    assert!(refused.0 == 409 && refused.1["error"].as_str().is_some_and(|why| why.contains("C17")), "{refused:?}");
    // It stops in the scan of the difference although more were asked for.
    assert_eq!(post(at, "/api/control", json!({"do": "scan", "count": 100})).await.1["scans"], 1);
    let told = told(&mut socket, |told: &Value| told["status"]["pair"]["first"] != Value::Null).await;
    assert_eq!(told["status"]["pair"]["first"]["scan"], 1, "{told}");
    assert_eq!(told["rows"][row("B3:0/0")["row"].to_string()], json!([0, 1]), "{told}");
    assert_eq!(told["values"]["other:Y1"], 1);
    assert_eq!(told["rungs"]["2:0"].as_str().map(str::len), Some(5), "{told}");
    assert_eq!(told["other_rungs"]["0:5"].as_str().map(str::len), Some(5), "{told}");
    assert_eq!(post(at, "/api/control", json!({"do": "stop-at-difference", "on": false})).await.0, 200);
    assert_eq!(post(at, "/api/control", json!({"do": "scan", "count": 100})).await.1["scans"], 100);
}

#[tokio::test]
async fn a_search_runs_beside_the_machines_and_can_be_stopped() {
    let at = serve_two(&[SEAL], Access::default()).await;
    let ended = async |at: SocketAddr| loop {
        let (_, proof) = get(at, "/api/pair/proof").await;
        if proof["state"] == "done" {
            return proof;
        }
        assert_eq!(get(at, "/api/state").await.0, 200, "the machines answer meanwhile");
        tokio::time::sleep(Duration::from_millis(20)).await;
    };
    assert_eq!(get(at, "/api/pair/proof").await.1["state"], "idle");
    assert_eq!(post(at, "/api/pair/proof", json!({"do": "start", "scans": 50_000})).await.0, 200);
    let proof = ended(at).await;
    assert_eq!(proof["verdict"], "different", "{proof}");
    let tape = json!({"do": "tape", "text": proof["found"]["original"]});
    assert_eq!(post(at, "/api/control", tape).await.0, 200);
    assert_eq!(post(at, "/api/control", json!({"do": "run", "speed": null})).await.0, 200);
    let mut state = Value::Null;
    for _ in 0..200 {
        state = get(at, "/api/state").await.1;
        if state["ended"] != Value::Null {
            break;
        }
        tokio::time::sleep(Duration::from_millis(10)).await;
    }
    assert_eq!(state["pair"]["first"]["scan"], proof["found"]["scans"], "{state}");
    assert_eq!(state["pair"]["first"]["what"], proof["found"]["what"]);
    assert_eq!(state["tape"]["at"], state["tape"]["scans"]);
    // Nothing to find: the words of the proof and its coverage, and it ends when asked.
    let at = serve_two(&[], Access::default()).await;
    assert_eq!(post(at, "/api/pair/proof", json!({"do": "start", "seed": 7, "scans": 10_000_000})).await.0, 200);
    assert_eq!(post(at, "/api/pair/proof", json!({"do": "start"})).await.0, 409, "one at a time");
    while get(at, "/api/pair/proof").await.1["scans"].as_u64().is_none_or(|scans| scans < 2000) {
        tokio::time::sleep(Duration::from_millis(10)).await;
    }
    assert_eq!(post(at, "/api/pair/proof", json!({"do": "stop"})).await.0, 200);
    let proof = ended(at).await;
    assert_eq!(
        (&proof["verdict"], &proof["found"]),
        (&json!("no difference found within this coverage"), &Value::Null)
    );
    assert!(proof["scans"].as_u64().is_some_and(|scans| scans < 10_000_000));
    assert!(proof["text"].as_str().is_some_and(|text| text.contains("stopped early")), "{proof}");
    assert_eq!(proof["coverage"][0][0], "rung conditions");
    for body in [json!({"do": "start", "scans": 0}), json!({"do": "start", "scans": 10_000_001}), json!({"do": "go"})] {
        assert_eq!(post(at, "/api/pair/proof", body.clone()).await.0, 422, "{body}");
    }
}

#[tokio::test]
async fn one_program_has_nothing_beside_it_and_who_only_looks_starts_nothing() {
    let at = serve(Access::default()).await;
    for path in ["/api/pair", "/api/pair/rows", "/api/pair/proof", "/api/other/project"] {
        assert_eq!(get(at, path).await.0, 404, "{path}");
    }
    let write = json!({"address": "I:0.0/0", "value": 1});
    assert_eq!(post(at, "/api/other/write", write.clone()).await.0, 404);
    let at = serve_two(&[], Access { read_only: true, ..Access::default() }).await;
    assert_eq!(get(at, "/api/pair").await.0, 200);
    assert_eq!(post(at, "/api/other/write", write).await.0, 403);
    assert_eq!(post(at, "/api/pair/proof", json!({"do": "start"})).await.0, 403);
    assert_eq!(post(at, "/api/control", json!({"do": "tape", "text": ""})).await.0, 403);
}
