//! The web server: routes, what stands before them, and what a browser gets.

mod asked;
mod connections;
mod control;
mod describe;
mod guard;
mod live;
mod offline;
mod pages;
mod pair;
mod problem;
mod read;

use std::hash::{BuildHasher, Hasher, RandomState};
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::middleware;
use axum::routing::{MethodRouter, get, post};
use ladder::Value;
use serde::Serialize;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;

use crate::engine::{self, Handle, Pace};
use crate::view::Program;
pub use connections::Limits;
use guard::Guard;
pub use offline::Offline;
pub use pair::PairView;

/// Longest body of a request: a plant file.
const BODY: usize = 256 << 10;

/// What all routes share.
#[derive(Clone)]
pub(crate) struct Served {
    engine: Handle,
    program: Arc<dyn Program>,
    browsers: Arc<Semaphore>,
    read_only: bool,
    /// Those who ask must give a token.
    token: bool,
    /// How long a WebSocket may be silent.
    silent: Duration,
    /// How many messages a WebSocket may send in ten seconds.
    messages: u32,
    /// Tells this run of the server from others, so that a page sees that it was started again.
    server: Arc<str>,
    /// What pages show of two programs side by side.
    pair: Option<Arc<PairView>>,
    /// What stands before addresses of `program` where the engine is asked.
    prefix: &'static str,
}

impl Served {
    fn new(engine: Handle, (program, pair): (Arc<dyn Program>, Option<Arc<PairView>>), access: &Access) -> Served {
        Served {
            engine,
            program,
            browsers: Arc::new(Semaphore::new(live::BROWSERS)),
            read_only: access.read_only,
            token: access.token.is_some(),
            silent: access.limits.silent,
            messages: access.limits.messages,
            server: format!("{:016x}", RandomState::new().build_hasher().finish()).into(),
            pair,
            prefix: "",
        }
    }

    /// An address of the program served, as the engine takes it.
    fn spelled(&self, address: &str) -> String {
        format!("{}{address}", self.prefix)
    }
}

/// How a program is served.
#[derive(Clone, Debug, Default)]
pub struct Access {
    /// All who ask must give this token. Needed on addresses other than loopback.
    pub token: Option<String>,
    /// Nothing can be changed.
    pub read_only: bool,
    /// What one client may take.
    pub limits: Limits,
}

/// Serves a program until `ended` is done.
///
/// # Errors
/// The listener has no address; it listens beyond loopback and there is no token.
pub async fn serve(
    listener: TcpListener,
    engine: Handle,
    program: Arc<dyn Program>,
    access: Access,
    ended: impl Future<Output = ()> + Send + 'static,
) -> std::io::Result<()> {
    serve_either(listener, engine, (program, None), access, ended).await
}

/// Serves two programs side by side until `ended` is done; `engine` runs a [`crate::workbench::Pair`] of them.
///
/// # Errors
/// As [`serve`].
pub async fn serve_pair(
    listener: TcpListener,
    engine: Handle,
    program: Arc<dyn Program>,
    pair: PairView,
    access: Access,
    ended: impl Future<Output = ()> + Send + 'static,
) -> std::io::Result<()> {
    serve_either(listener, engine, (program, Some(Arc::new(pair))), access, ended).await
}

async fn serve_either(
    listener: TcpListener,
    engine: Handle,
    (program, pair): (Arc<dyn Program>, Option<Arc<PairView>>),
    access: Access,
    ended: impl Future<Output = ()> + Send + 'static,
) -> std::io::Result<()> {
    let bound = listener.local_addr()?;
    if !bound.ip().is_loopback() && access.token.is_none() {
        return Err(std::io::Error::other("a server that others can reach needs a token"));
    }
    let served = Served::new(engine, (program, pair), &access);
    let guard = Arc::new(Guard::new(bound, access.token, access.limits.body));
    connections::serve(listener, router(served, guard), access.limits, ended).await;
    Ok(())
}

/// Paths behind `/api/` and [`pair::OTHER_PATHS`]: what is asked of one program.
const ASKED_OF_A_PROGRAM: [&str; 8] = [
    "project",
    "routines/{routine}/rungs",
    "routines/{routine}/heights",
    "data/{file}",
    "uses",
    "search",
    "write",
    "force",
];

/// Every route with what answers it; the same paths stand in the description.
fn routes() -> Vec<(String, MethodRouter<Served>)> {
    let fixed: [(&str, MethodRouter<Served>); 11] = [
        ("/", get(pages::index)),
        ("/assets/{name}", get(pages::asset)),
        ("/api/openapi.json", get(pages::openapi)),
        ("/api/state", get(read::state)),
        ("/api/trend", get(read::trend).post(control::follow)),
        ("/api/control", post(control::control)),
        ("/api/record", post(control::record)),
        ("/api/live", get(live::live)),
        (pair::PATHS[0], get(pair::overview)),
        (pair::PATHS[1], get(pair::rows)),
        (pair::PATHS[2], get(pair::proof).post(pair::prove)),
    ];
    let of_a_program: [MethodRouter<Served>; 8] = [
        get(read::project),
        get(read::rungs),
        get(read::heights),
        get(read::data),
        get(read::uses),
        get(read::search),
        post(control::write),
        post(control::force),
    ];
    let all = fixed.into_iter().map(|(path, answer)| (path.to_owned(), answer));
    let sides = ASKED_OF_A_PROGRAM.into_iter().zip(of_a_program).flat_map(|(path, answer)| {
        [(format!("/api/{path}"), answer.clone()), (format!("{}{path}", pair::OTHER_PATHS), answer)]
    });
    all.chain(sides).collect()
}

/// All routes, with what holds whoever asks.
fn unguarded(read_only: bool) -> Router<Served> {
    let mut all = routes().into_iter().fold(Router::new(), |all, (path, answer)| all.route(&path, answer));
    if read_only {
        all = all.route_layer(middleware::from_fn(guard::only_look));
    }
    all.fallback(pages::missing).method_not_allowed_fallback(pages::wrong_method).layer(DefaultBodyLimit::max(BODY))
}

fn router(served: Served, guard: Arc<Guard>) -> Router {
    let guarded = unguarded(served.read_only).layer(middleware::from_fn_with_state(guard, guard::guard));
    guarded.with_state(served)
}

/// The state of the run, as browsers get it.
#[derive(Debug, Serialize)]
pub(crate) struct Status {
    /// Another text than before: the server was started again.
    server: String,
    /// `paused`, `run` or `fast`.
    pace: &'static str,
    /// Times real time, while `run`.
    #[serde(skip_serializing_if = "Option::is_none")]
    speed: Option<f64>,
    mode: &'static str,
    scans: u64,
    /// Simulated seconds.
    time: f64,
    /// Milliseconds from one scan to the next.
    scan_ms: f64,
    fault: Option<String>,
    /// In hexadecimal, as S:6 is shown.
    fault_code: Option<String>,
    /// What to look at.
    advice: Option<&'static str>,
    /// Routine and rung.
    fault_site: Option<(u16, u16)>,
    forces: Vec<(String, bool)>,
    forces_enabled: bool,
    /// Scans that can be gone back.
    depth: u64,
    snapshots: Vec<String>,
    /// Scans recorded, while a recording is in progress.
    recording: Option<u64>,
    slow: bool,
    ended: Option<String>,
    plant: Option<PlantStatus>,
    read_only: bool,
    /// The tape that is played.
    tape: Option<pair::TapeStatus>,
    /// Two machines side by side.
    #[serde(skip_serializing_if = "Option::is_none")]
    pair: Option<pair::PairStatus>,
}

/// A plant in figures.
#[derive(Debug, Serialize)]
pub(crate) struct PlantStatus {
    name: String,
    wrong: Option<String>,
    /// Element, quantity, value, unit.
    gauges: Vec<(String, String, f64, &'static str)>,
}

impl Status {
    fn of(status: &engine::Status, served: &Served) -> Status {
        let (pace, speed) = match status.pace {
            Pace::Paused => ("paused", None),
            Pace::RealTime(speed) => ("run", Some(speed)),
            Pace::Fast => ("fast", None),
        };
        let gauges = |gauges: &[crate::plant::Gauge]| {
            gauges.iter().map(|it| (it.element.clone(), it.quantity.clone(), it.value, it.unit)).collect()
        };
        Status {
            server: served.server.to_string(),
            pace,
            speed,
            mode: status.mode,
            scans: status.scans,
            time: status.time.as_secs_f64(),
            scan_ms: status.scan_time.as_secs_f64() * 1000.0,
            fault: status.fault.clone(),
            fault_code: status.fault_code.map(|code| format!("{code:04X}")),
            advice: status.advice,
            fault_site: status.fault_site,
            forces: status.forces.clone(),
            forces_enabled: status.forces_enabled,
            depth: status.depth,
            snapshots: status.snapshots.clone(),
            recording: status.recording,
            slow: status.slow,
            ended: status.ended.clone(),
            plant: status.plant.as_ref().map(|plant| PlantStatus {
                name: plant.name.clone(),
                wrong: plant.wrong.clone(),
                gauges: gauges(&plant.gauges),
            }),
            read_only: served.read_only,
            tape: status.tape.as_ref().map(pair::TapeStatus::of),
            pair: status.pair.as_ref().map(pair::PairStatus::of),
        }
    }
}

/// A value as browsers get it: bits as 0 and 1, elements of words alone as those, other whole elements as nothing.
fn json_value(value: &Value) -> serde_json::Value {
    match value {
        Value::Bit(on) => u8::from(*on).into(),
        Value::Word(word) => (*word).into(),
        Value::Long(long) => (*long).into(),
        // JSON has no infinity.
        Value::Float(number) if !number.is_finite() => number.to_string().into(),
        Value::Float(number) => ladder::format_float(*number).parse::<f64>().unwrap_or(f64::from(*number)).into(),
        Value::Text(text) => text.as_str().into(),
        Value::Words(words) => {
            words.iter().map(|word| word.cast_signed().to_string()).collect::<Vec<_>>().join(" ").into()
        }
        _ => serde_json::Value::Null,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_an_element_are_told_as_data_tables_show_them() {
        assert_eq!(json_value(&Value::Words(vec![2, 38_704])), serde_json::json!("2 -26832"));
        assert_eq!(json_value(&Value::Word(-1)), serde_json::json!(-1));
    }
}
