//! What clients can take of a server: too many, too slow, too much, or never reading.

mod support;

use std::net::SocketAddr;
use std::time::Duration;

use futures_util::{SinkExt, StreamExt};
use serde_json::json;
use server::{Access, Limits};
use support::wire::{Socket, get, live, post, serve, told};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpSocket, TcpStream};
use tokio::time::timeout;
use tokio_tungstenite::tungstenite::Message;

/// Long enough for any machine, short enough to notice.
const PATIENCE: Duration = Duration::from_secs(20);

async fn serve_within(limits: Limits) -> SocketAddr {
    serve(Access { limits, ..Access::default() }).await
}

/// What comes until the server closes.
async fn rest(stream: &mut TcpStream) -> String {
    let mut all = Vec::new();
    // A connection that is reset has ended too.
    let _ = timeout(PATIENCE, stream.read_to_end(&mut all)).await.expect("the server closes");
    String::from_utf8_lossy(&all).into_owned()
}

#[tokio::test]
async fn who_sends_slowly_is_not_waited_for() {
    let short = Duration::from_millis(300);
    let at = serve_within(Limits { head: short, body: short, ..Limits::default() }).await;
    // A byte of the head now and then.
    let mut head = TcpStream::connect(at).await.expect("listens");
    let dripping = async {
        for byte in b"GET /api/state HTTP/1.1\r\nHost: x\r\nX-Slow: ".iter().chain([b'a'; 1000].iter()) {
            if head.write_all(&[*byte]).await.is_err() {
                return;
            }
            tokio::time::sleep(Duration::from_millis(20)).await;
        }
        panic!("a head may take any time");
    };
    timeout(PATIENCE, dripping).await.expect("is closed");
    // Nothing at all.
    let mut mute = TcpStream::connect(at).await.expect("listens");
    assert_eq!(rest(&mut mute).await, "");
    // A body that does not come, and one that does not end.
    for body in ["Content-Length: 30\r\n\r\n{", "Transfer-Encoding: chunked\r\n\r\n1\r\n{\r\n"] {
        let mut stream = TcpStream::connect(at).await.expect("listens");
        let head = format!("POST /api/write HTTP/1.1\r\nHost: {at}\r\nContent-Type: application/json\r\n");
        stream.write_all(format!("{head}{body}").as_bytes()).await.expect("takes it");
        let answer = rest(&mut stream).await;
        assert!(answer.starts_with("HTTP/1.1 408 ") && answer.contains("did not arrive"), "{answer}");
    }
    // A connection that stays open after an answer, for a next request that does not come.
    let mut idle = TcpStream::connect(at).await.expect("listens");
    idle.write_all(format!("GET /api/state HTTP/1.1\r\nHost: {at}\r\n\r\n").as_bytes()).await.expect("takes it");
    assert!(rest(&mut idle).await.starts_with("HTTP/1.1 200 "));
    assert_eq!(get(at, "/api/state").await.0, 200);
}

#[tokio::test]
async fn connections_are_counted_and_given_back() {
    let at = serve_within(Limits { connections_of_one: 5, ..Limits::default() }).await;
    let mut open = Vec::new();
    for _ in 0..5 {
        open.push(TcpStream::connect(at).await.expect("listens"));
    }
    // They are accepted in their order, so this is the sixth.
    assert_eq!(rest(&mut TcpStream::connect(at).await.expect("listens")).await, "");
    drop(open);
    // The server notices a little later.
    let again = async {
        loop {
            let mut stream = TcpStream::connect(at).await.expect("listens");
            let request = format!("GET /api/state HTTP/1.1\r\nHost: {at}\r\nConnection: close\r\n\r\n");
            if stream.write_all(request.as_bytes()).await.is_ok() && rest(&mut stream).await.contains(" 200 ") {
                return;
            }
        }
    };
    timeout(PATIENCE, again).await.expect("places come back");
}

/// A text message as browsers send it, masked with zeros.
fn frame(text: &str) -> Vec<u8> {
    let length = u16::try_from(text.len()).expect("a short one");
    let mut frame = vec![0x81, 0x80 | 126];
    frame.extend(length.to_be_bytes());
    frame.extend([0; 4]);
    frame.extend(text.as_bytes());
    frame
}

/// Opens a live connection that says what it shows, with little room for what it is told, and never reads.
async fn deaf(at: SocketAddr) -> TcpStream {
    let socket = TcpSocket::new_v4().expect("a socket");
    socket.set_recv_buffer_size(4096).expect("a small one");
    let mut stream = socket.connect(at).await.expect("listens");
    let upgrade = format!(
        "GET /api/live HTTP/1.1\r\nHost: {at}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
         Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    );
    stream.write_all(upgrade.as_bytes()).await.expect("takes it");
    let see = json!({"rungs": [[2, 0], [2, 1]], "values": ["N7:0", "T4:0.ACC"]}).to_string();
    stream.write_all(&frame(&see)).await.expect("takes it");
    stream
}

#[tokio::test]
async fn a_browser_that_never_reads_holds_up_nobody_and_is_given_up() {
    let at = serve_within(Limits { deaf: Duration::from_millis(500), ..Limits::default() }).await;
    let mut stream = deaf(at).await;
    let mut good = live(at).await;
    good.send(Message::Text(json!({"values": ["N7:0"]}).to_string().into())).await.expect("sends");
    assert_eq!(post(at, "/api/control", json!({"do": "run", "speed": null})).await.0, 200);
    // The engine goes on, and others are told, long after the deaf one's room is full.
    let scans = async |good: &mut Socket| {
        let told = timeout(PATIENCE, told(good, |_| true)).await.expect("is told");
        told["status"]["scans"].as_u64().expect("scans")
    };
    let first = scans(&mut good).await;
    // Whatever the system keeps for a socket must be full: it asks for all of a table again and again.
    let values: Vec<String> = (0..255).flat_map(|word| (0..16).map(move |bit| format!("N7:{word}/{bit}"))).collect();
    let all = frame(&json!({"values": values}).to_string());
    let mut last = first;
    let given_up = async {
        loop {
            tokio::select! {
                written = stream.write_all(&all) => if written.is_err() { return },
                now = scans(&mut good) => last = now,
            }
        }
    };
    timeout(PATIENCE, given_up).await.expect("the deaf one is given up");
    assert!(last > first + 1000, "{first} {last}");
    assert_eq!(post(at, "/api/control", json!({"do": "pause"})).await.0, 200);
}

#[tokio::test]
async fn a_browser_that_is_gone_without_a_word_is_given_up() {
    let at = serve_within(Limits { silent: Duration::from_millis(300), ..Limits::default() }).await;
    // Not read, so no ping is answered; nothing is told either while nothing changes.
    let mut gone = deaf(at).await;
    let told = rest(&mut gone).await;
    assert!(told.starts_with("HTTP/1.1 101 "), "{told}");
    // One that answers pings stays, though it says nothing by itself.
    let mut there = live(at).await;
    let waited =
        timeout(Duration::from_millis(1500), async { while there.next().await.is_some_and(|it| it.is_ok()) {} });
    assert!(waited.await.is_err(), "still open");
}

/// What a live connection says when it closes.
async fn parting(mut socket: Socket, after: &str) -> String {
    let close = async {
        while let Some(Ok(message)) = socket.next().await {
            if let Message::Close(frame) = message {
                return frame.map(|frame| frame.reason.to_string()).unwrap_or_default();
            }
        }
        String::new()
    };
    timeout(PATIENCE, close).await.unwrap_or_else(|_| panic!("{after} does not close"))
}

#[tokio::test]
async fn messages_that_make_no_sense_close_with_a_reason() {
    let at = serve(Access::default()).await;
    let many: Vec<String> = (0..5001).map(|number| format!("N7:{number}")).collect();
    for (message, why) in [
        (Message::Text("{".into()), "EOF"),
        (Message::Text("[]".into()), "column"),
        (Message::Text(r#"{"rungs": [[2]]}"#.into()), "line 1 column"),
        (Message::Text(r#"{"rungs": [[2, 65536]]}"#.into()), "65536"),
        (Message::Text(r#"{"look": []}"#.into()), "unknown field"),
        (Message::Text(json!({"values": many}).to_string().into()), "at most 5000"),
        (Message::Text(json!({"rungs": vec![[2, 0]; 501]}).to_string().into()), "at most 500"),
        (Message::Binary(vec![0; 10].into()), "expected a text"),
    ] {
        let mut socket = live(at).await;
        socket.send(message.clone()).await.expect("sends");
        let reason = parting(socket, why).await;
        assert!(reason.contains(why), "{reason}, expected {why}");
    }
    // Longer than any message: the connection ends.
    let mut socket = live(at).await;
    let _ = socket.send(Message::Text(" ".repeat(300_000).into())).await;
    parting(socket, "a long message").await;
}

#[tokio::test]
async fn a_flood_of_messages_closes_with_a_reason() {
    // So few that a slow machine takes them in the time in which they are counted.
    let at = serve_within(Limits { messages: 50, ..Limits::default() }).await;
    let mut socket = live(at).await;
    for _ in 0..60 {
        let _ = socket.feed(Message::Text("{}".into())).await;
    }
    let _ = socket.flush().await;
    assert!(parting(socket, "a flood").await.contains("50 messages"));
    assert_eq!(get(at, "/api/state").await.0, 200);
}

#[tokio::test]
async fn fifty_browsers_all_see_the_newest_state() {
    let at = serve(Access::default()).await;
    let mut sockets = Vec::new();
    for _ in 0..50 {
        let mut socket = live(at).await;
        let see = json!({"rungs": [[2, 0], [2, 1], [2, 2], [2, 3]], "values": ["N7:0", "T4:0.ACC"]});
        socket.send(Message::Text(see.to_string().into())).await.expect("sends");
        sockets.push(socket);
    }
    assert_eq!(post(at, "/api/control", json!({"do": "run", "speed": 10.0})).await.0, 200);
    tokio::time::sleep(Duration::from_millis(300)).await;
    assert_eq!(post(at, "/api/control", json!({"do": "pause"})).await.0, 200);
    let state = get(at, "/api/state").await.1;
    assert!(state["scans"].as_u64() > Some(10), "{state}");
    for socket in &mut sockets {
        // Values come once, in the last frame in which they changed.
        let mut value = json!(null);
        let newest = async {
            loop {
                let told = told(socket, |_| true).await;
                if told["values"]["N7:0"] != json!(null) {
                    value = told["values"]["N7:0"].clone();
                }
                if told["status"]["scans"] == state["scans"] && told["status"]["pace"] == json!("paused") {
                    return;
                }
            }
        };
        timeout(PATIENCE, newest).await.expect("the newest state");
        // The program counts its scans up to 1023.
        assert_eq!(value.as_u64(), state["scans"].as_u64().map(|scans| scans % 1024));
    }
}

#[tokio::test]
async fn two_who_force_the_same_bit_see_one_truth() {
    let at = serve(Access::default()).await;
    let (mut one, mut two) = (live(at).await, live(at).await);
    for number in 0..20 {
        let on = json!({"address": "I:0/0", "state": true});
        let off = json!({"address": "i:0.0/0", "state": false});
        // At the same time, spelled in two ways: whichever comes last holds, for both.
        let (first, second) = tokio::join!(post(at, "/api/force", on), post(at, "/api/force", off));
        assert_eq!((first.0, second.0), (200, 200));
        let name = format!("mark {number}");
        assert_eq!(post(at, "/api/control", json!({"do": "keep", "name": name})).await.0, 200);
        let marked =
            |told: &serde_json::Value| told["status"]["snapshots"].as_array().is_some_and(|it| it.len() > number);
        let (one, two) = (told(&mut one, marked).await, told(&mut two, marked).await);
        let forces = &get(at, "/api/state").await.1["forces"];
        assert_eq!((&one["status"]["forces"], &two["status"]["forces"]), (forces, forces));
        assert_eq!(forces.as_array().map(Vec::len), Some(1), "{forces}");
        let held = &forces[0][1];
        assert_eq!(post(at, "/api/control", json!({"do": "forces", "enabled": true})).await.0, 200);
        assert_eq!(post(at, "/api/control", json!({"do": "scan", "count": 1})).await.0, 200);
        let mut look = live(at).await;
        look.send(Message::Text(json!({"values": ["I:0/0"]}).to_string().into())).await.expect("sends");
        let seen = told(&mut look, |told| told["values"] != json!(null)).await;
        assert_eq!(seen["values"]["I:0/0"] == json!(1), held == &json!(true), "{seen} {forces}");
    }
}

#[tokio::test]
async fn a_browser_that_comes_back_catches_up() {
    let at = serve(Access::default()).await;
    let see = json!({"rungs": [[2, 0]], "values": ["T4:0.ACC", "N7:0"]}).to_string();
    let mut socket = live(at).await;
    socket.send(Message::Text(see.clone().into())).await.expect("sends");
    let first = told(&mut socket, |told| told["values"] != json!(null)).await;
    drop(socket);
    assert_eq!(post(at, "/api/write", json!({"address": "I:0.0/0", "value": 1})).await.0, 200);
    assert_eq!(post(at, "/api/control", json!({"do": "scan", "count": 40})).await.0, 200);
    let mut socket = live(at).await;
    socket.send(Message::Text(see.into())).await.expect("sends");
    let next = told(&mut socket, |told| told["values"] != json!(null)).await;
    assert_eq!((&next["values"], &next["rungs"]), (&json!({"T4:0.ACC": 39, "N7:0": 40}), &json!({"2:0": "77"})));
    assert_eq!(next["status"]["server"], first["status"]["server"], "the same run of the server");
    assert!(next["frame"].as_u64() > first["frame"].as_u64());
}
