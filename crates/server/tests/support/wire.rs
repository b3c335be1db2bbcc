//! A server for the time of a test, and requests to it as they stand on the wire.

use std::net::SocketAddr;
use std::sync::Arc;

use futures_util::StreamExt;
use ladder::Project;
use serde_json::Value;
use server::view::SlcProgram;
use server::workbench::{Slc, Workbench};
use server::{Access, engine};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};
use tokio_tungstenite::tungstenite::Message;
use tokio_tungstenite::{MaybeTlsStream, WebSocketStream};

use super::image;

const LADDER: &[&str] =
    &["XIC I:0.0/0 TON T4:0 0.01 100 0", "XIC T4:0/DN OTE O:0.0/0", "AND N7:0 1023 N7:0", "ADD N7:0 1 N7:0"];

/// A server on a free port of this machine, for the time of a test.
pub(crate) async fn serve(access: Access) -> SocketAddr {
    let image = image(LADDER);
    let options = sim::Options { inline: true, ..sim::Options::default() };
    let program = sim::Program::compile(&image, &options).expect("compiles");
    let machine = Slc::new(sim::Machine::new(program), &image);
    let project = Project { main: image, ..Project::default() };
    let view = SlcProgram::new("test.RSS".to_owned(), project, Vec::new());
    let listener = TcpListener::bind("127.0.0.1:0").await.expect("a free port");
    let address = listener.local_addr().expect("bound");
    let handle = engine::start(Workbench::new(Box::new(machine))).expect("a thread");
    tokio::spawn(server::serve(listener, handle, Arc::new(view), access, std::future::pending()));
    address
}

/// One request with these header lines; answers status, head and body.
pub(crate) async fn ask(at: SocketAddr, first: &str, headers: &str, body: &str) -> (u16, String, String) {
    let mut stream = TcpStream::connect(at).await.expect("listens");
    let request =
        format!("{first} HTTP/1.1\r\n{headers}Content-Length: {}\r\nConnection: close\r\n\r\n{body}", body.len());
    stream.write_all(request.as_bytes()).await.expect("takes it");
    let mut answer = Vec::new();
    // A refused body may close the connection early.
    let _ = stream.read_to_end(&mut answer).await;
    let answer = String::from_utf8_lossy(&answer).into_owned();
    let (head, body) = answer.split_once("\r\n\r\n").unwrap_or((&answer, ""));
    let status = head.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0);
    (status, head.to_lowercase(), body.to_owned())
}

pub(crate) async fn get(at: SocketAddr, path: &str) -> (u16, Value) {
    let (status, _, body) = ask(at, &format!("GET {path}"), &format!("Host: {at}\r\n"), "").await;
    (status, serde_json::from_str(&body).unwrap_or(Value::Null))
}

pub(crate) async fn post(at: SocketAddr, path: &str, body: Value) -> (u16, Value) {
    let headers = format!("Host: {at}\r\nContent-Type: application/json\r\n");
    let (status, _, body) = ask(at, &format!("POST {path}"), &headers, &body.to_string()).await;
    (status, serde_json::from_str(&body).unwrap_or(Value::Null))
}

/// A live connection.
pub(crate) type Socket = WebSocketStream<MaybeTlsStream<TcpStream>>;

/// Opens a live connection.
pub(crate) async fn live(at: SocketAddr) -> Socket {
    tokio_tungstenite::connect_async(format!("ws://{at}/api/live")).await.expect("upgrades").0
}

/// The next thing told that is wanted.
pub(crate) async fn told(socket: &mut Socket, wanted: impl Fn(&Value) -> bool) -> Value {
    loop {
        let message: Message = socket.next().await.expect("open").expect("sound");
        let Message::Text(text) = message else { continue };
        let value: Value = serde_json::from_str(&text).expect("JSON");
        if wanted(&value) {
            return value;
        }
    }
}
