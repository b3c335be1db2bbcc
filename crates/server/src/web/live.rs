//! Live updates: what a browser looks at, when it changes.
//!
//! A browser says which rungs and values it shows; with every frame it gets those that are not what it was told
//! last. Nothing queues up: a browser that is slow gets the newest frame when it is ready for one, and one that
//! comes back says again what it shows and is told everything.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Duration;

use axum::body::Bytes;
use axum::extract::State;
use axum::extract::ws::rejection::WebSocketUpgradeRejection;
use axum::extract::ws::{CloseFrame, Message, WebSocket, WebSocketUpgrade, close_code};
use axum::response::Response;
use serde::{Deserialize, Serialize};
use tokio::sync::{Semaphore, watch};
use tokio::time::{Instant, interval, timeout};

use super::asked::{List, Object};
use super::problem::Problem;
use super::{Served, Status, json_value};
use crate::engine::Frame;
use crate::workbench::Flow;

/// Rungs and values of one browser.
const RUNGS: usize = 500;
const VALUES: usize = 5000;

/// Longest message of a browser, bytes.
const MESSAGE: usize = 256 << 10;

/// Browsers at once.
pub(super) const BROWSERS: usize = 200;

/// Messages of a browser are counted in it.
const WINDOW: Duration = Duration::from_secs(10);

/// What a browser shows.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct See {
    /// Rungs: routine and number.
    #[serde(default)]
    rungs: List<(u16, u16), RUNGS>,
    /// Addresses.
    #[serde(default)]
    values: List<String, VALUES>,
    /// Rungs of the other program, where there are two.
    #[serde(default)]
    other_rungs: List<(u16, u16), RUNGS>,
    /// Rows of what both have, by number.
    #[serde(default)]
    rows: List<u32, VALUES>,
}

/// What a browser is told.
#[derive(Debug, Serialize)]
struct Told<'a> {
    frame: u64,
    status: &'a Status,
    /// By `routine:rung`, a hexadecimal digit for every instruction: 1 executed, 2 power before it, 4 power behind it,
    /// 8 changed in this scan.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    rungs: BTreeMap<String, String>,
    /// By address; `null` where there is no such value.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    values: BTreeMap<&'a str, serde_json::Value>,
    /// As `rungs`, of the other program.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    other_rungs: BTreeMap<String, String>,
    /// By number, the values of a row on both sides.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    rows: BTreeMap<u32, [serde_json::Value; 2]>,
}

/// What was told last.
#[derive(Default)]
struct Known {
    rungs: BTreeMap<(u16, u16), Vec<u8>>,
    values: BTreeMap<String, serde_json::Value>,
    other_rungs: BTreeMap<(u16, u16), Vec<u8>>,
    rows: BTreeMap<u32, [serde_json::Value; 2]>,
}

impl Known {
    /// Forgets what is not shown any more: the browser does not follow it, and is told when it shows it again.
    fn keep(&mut self, see: &See) {
        fn all<T: Ord + Clone>(list: &[T]) -> BTreeSet<T> {
            list.iter().cloned().collect()
        }
        let (rungs, other) = (all(see.rungs.as_slice()), all(see.other_rungs.as_slice()));
        let (values, rows) = (all(see.values.as_slice()), all(see.rows.as_slice()));
        self.rungs.retain(|rung, _| rungs.contains(rung));
        self.other_rungs.retain(|rung, _| other.contains(rung));
        self.values.retain(|address, _| values.contains(address));
        self.rows.retain(|row, _| rows.contains(row));
    }
}

pub(super) async fn live(
    State(served): State<Served>,
    upgrade: Result<WebSocketUpgrade, WebSocketUpgradeRejection>,
) -> Result<Response, Problem> {
    let upgrade = upgrade?;
    let places: Arc<Semaphore> = Arc::clone(&served.browsers);
    let place = places.try_acquire_owned();
    let place =
        place.map_err(|_| Problem::new(axum::http::StatusCode::SERVICE_UNAVAILABLE, "too many pages are open"))?;
    Ok(upgrade.max_message_size(MESSAGE).max_frame_size(MESSAGE).on_upgrade(async move |socket| {
        let frames = served.engine.frames();
        // A page that is gone needs no farewell.
        let _ = follow(socket, frames, &served).await;
        drop(place);
    }))
}

async fn follow(
    mut socket: WebSocket,
    mut frames: watch::Receiver<Arc<Frame>>,
    served: &Served,
) -> Result<(), axum::Error> {
    let mut see = See::default();
    let mut known = Known::default();
    let mut heard = Instant::now();
    let mut window = (Instant::now(), 0);
    let mut pings = interval(served.silent / 3);
    frames.mark_changed();
    loop {
        tokio::select! {
            message = socket.recv() => {
                heard = Instant::now();
                if window.0.elapsed() >= WINDOW {
                    window = (heard, 0);
                }
                window.1 += 1;
                if window.1 > served.messages {
                    return part(&mut socket, format!("more than {} messages in {WINDOW:?}", served.messages)).await;
                }
                match message {
                    Some(Ok(Message::Text(text))) => match serde_json::from_str::<Object<See>>(&text) {
                        Ok(Object(asked)) => {
                            known.keep(&asked);
                            see = asked;
                            frames.mark_changed();
                        }
                        Err(why) => return part(&mut socket, why.to_string()).await,
                    },
                    Some(Ok(Message::Binary(_))) => return part(&mut socket, "expected a text".to_owned()).await,
                    Some(Ok(Message::Close(_)) | Err(_)) | None => return Ok(()),
                    Some(Ok(Message::Ping(_) | Message::Pong(_))) => {}
                }
            }
            changed = frames.changed() => {
                if changed.is_err() {
                    return part(&mut socket, "the simulation has ended".to_owned()).await;
                }
                // The frame itself is not held while a slow browser takes its time.
                let text = {
                    let frame = Arc::clone(&frames.borrow_and_update());
                    tell(&frame, &see, &mut known, served)
                };
                socket.send(Message::Text(text.into())).await?;
            }
            _ = pings.tick() => {
                if heard.elapsed() > served.silent {
                    return Ok(());
                }
                socket.send(Message::Ping(Bytes::new())).await?;
            }
        }
    }
}

/// Closes the connection and says why.
async fn part(socket: &mut WebSocket, mut why: String) -> Result<(), axum::Error> {
    // A close frame has room for so many bytes.
    while why.len() > 120 {
        why.pop();
    }
    socket.send(Message::Close(Some(CloseFrame { code: close_code::POLICY, reason: why.into() }))).await?;
    // What still comes is read for a moment: a connection with unread bytes is reset, and the reason lost.
    let rest = async { while let Some(Ok(_)) = socket.recv().await {} };
    let _ = timeout(Duration::from_secs(1), rest).await;
    Ok(())
}

/// What a page is told first that sends this message.
pub(super) fn told_first(message: &str, served: &Served) -> Result<String, String> {
    let Object(see) = serde_json::from_str::<Object<See>>(message).map_err(|why| why.to_string())?;
    let frame = Arc::clone(&served.engine.frames().borrow());
    Ok(tell(&frame, &see, &mut Known::default(), served))
}

fn tell(frame: &Frame, see: &See, known: &mut Known, served: &Served) -> String {
    let status = Status::of(&frame.status, served);
    let mut told = Told {
        frame: frame.number,
        status: &status,
        rungs: flow(&frame.flow, see.rungs.as_slice(), &mut known.rungs),
        values: BTreeMap::new(),
        other_rungs: BTreeMap::new(),
        rows: BTreeMap::new(),
    };
    if let Some(pair) = frame.machine.pair() {
        told.other_rungs = flow(pair.other_flow(), see.other_rungs.as_slice(), &mut known.other_rungs);
        for row in see.rows.as_slice() {
            let Some(values) = pair.values(*row as usize) else { continue };
            let values = values.map(|value| json_value(&value));
            if known.rows.get(row) != Some(&values) {
                known.rows.insert(*row, values.clone());
                told.rows.insert(*row, values);
            }
        }
    }
    for address in see.values.as_slice() {
        let value =
            frame.machine.controller().read(address).map_or(serde_json::Value::Null, |value| json_value(&value));
        if known.values.get(address) != Some(&value) {
            known.values.insert(address.clone(), value.clone());
            told.values.insert(address, value);
        }
    }
    // Keys are texts and values plain: there is nothing that JSON cannot say.
    serde_json::to_string(&told).unwrap_or_default()
}

/// Power flow of rungs that is not what was told last.
fn flow(flow: &Flow, rungs: &[(u16, u16)], known: &mut BTreeMap<(u16, u16), Vec<u8>>) -> BTreeMap<String, String> {
    let mut told = BTreeMap::new();
    for rung in rungs {
        let bits = flow.rung(rung.0, rung.1);
        if known.get(rung).is_none_or(|last| last != bits) {
            let digits = bits.iter().filter_map(|bits| char::from_digit(u32::from(bits & 15), 16)).collect();
            told.insert(format!("{}:{}", rung.0, rung.1), digits);
            known.insert(*rung, bits.to_vec());
        }
    }
    told
}
