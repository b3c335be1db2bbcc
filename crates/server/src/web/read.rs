//! Requests that only look.

use axum::Json;
use axum::extract::rejection::{PathRejection, QueryRejection};
use axum::extract::{Path, Query, State};
use serde::{Deserialize, Serialize};
use tokio::task::spawn_blocking;

use super::asked::{Address, SAFE, Text, Whole};
use super::pair::Side;
use super::problem::Problem;
use super::{Served, Status};
use crate::view::{DataView, HitsView, NamedView, Outline, RungView, UsesView};

type Answer<T> = Result<Json<T>, Problem>;
type Asked<T> = Result<Query<T>, QueryRejection>;
type Named<T> = Result<Path<T>, PathRejection>;

/// Rungs and elements of one answer.
const RUNGS: u64 = 200;
const ELEMENTS: u64 = 1000;

/// Longest text that is searched for, characters.
const TEXT: usize = 500;

/// Columns of a drawing, and how many it has when nothing is said.
type Columns = Whole<{ render::MIN_WIDTH as u64 }, { render::MAX_WIDTH as u64 }>;
const COLUMNS: usize = 100;

pub(super) async fn project(Side(served): Side) -> Json<Outline> {
    Json(served.program.outline().clone())
}

pub(super) async fn state(State(served): State<Served>) -> Json<Status> {
    let frame = std::sync::Arc::clone(&served.engine.frames().borrow());
    Json(Status::of(&frame.status, &served))
}

/// A stretch of rungs.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Rungs {
    /// The first.
    from: Option<Whole<0, SAFE>>,
    /// How many.
    count: Option<Whole<0, RUNGS>>,
    width: Option<Columns>,
}

pub(super) async fn rungs(Side(served): Side, routine: Named<u16>, asked: Asked<Rungs>) -> Answer<Vec<RungView>> {
    let (Path(routine), Query(Rungs { from, count, width })) = (routine?, asked?);
    let outline = served.program.outline();
    let Some(found) = outline.routines.iter().find(|it| it.number == routine) else {
        return Err(no_routine(routine));
    };
    let from = from.map_or(0, Whole::size);
    let last = found.rungs.min(from.saturating_add(count.map_or(50, Whole::size)));
    let width = width.map_or(COLUMNS, Whole::size);
    let program = served.program;
    let drawn = spawn_blocking(move || (from..last).filter_map(|index| program.rung(routine, index, width)).collect());
    Ok(Json(drawn.await.map_err(broken)?))
}

/// Columns of a drawing.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Width {
    width: Option<Columns>,
}

pub(super) async fn heights(Side(served): Side, routine: Named<u16>, asked: Asked<Width>) -> Answer<Vec<usize>> {
    let (Path(routine), Query(Width { width })) = (routine?, asked?);
    if !served.program.outline().routines.iter().any(|it| it.number == routine) {
        return Err(no_routine(routine));
    }
    let heights = spawn_blocking(move || served.program.heights(routine, width.map_or(COLUMNS, Whole::size)));
    Ok(Json(heights.await.map_err(broken)?))
}

fn no_routine(routine: u16) -> Problem {
    Problem::missing(format!("there is no program file or code block {routine}"))
}

/// A task that was cancelled: the server ends.
fn broken(why: tokio::task::JoinError) -> Problem {
    Problem::new(axum::http::StatusCode::SERVICE_UNAVAILABLE, why.to_string())
}

/// A stretch of elements.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Elements {
    from: Option<Whole<0, SAFE>>,
    count: Option<Whole<0, ELEMENTS>>,
}

pub(super) async fn data(Side(served): Side, file: Named<String>, asked: Asked<Elements>) -> Answer<DataView> {
    let (Path(file), Query(Elements { from, count })) = (file?, asked?);
    let view = served.program.data(&file, from.map_or(0, Whole::size), count.map_or(200, Whole::size));
    view.map(Json).ok_or_else(|| Problem::missing(format!("there is no data file {file}")))
}

/// An address or symbol.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Of {
    address: Address,
}

pub(super) async fn uses(Side(served): Side, asked: Asked<Of>) -> Answer<UsesView> {
    let Query(Of { address }) = asked?;
    let found = spawn_blocking(move || served.program.uses(address.as_str())).await.map_err(broken)?;
    found.map(Json).map_err(Problem::missing)
}

/// A text to search for.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct For {
    q: Text<TEXT>,
}

pub(super) async fn search(Side(served): Side, asked: Asked<For>) -> Answer<HitsView> {
    let Query(For { q }) = asked?;
    if q.as_str().trim().is_empty() {
        return Ok(Json(HitsView::default()));
    }
    let look = move || {
        let text = q.as_str();
        let named = served.program.uses(text.trim()).ok().map(|found| NamedView {
            uses: found.uses.len() + found.left_out,
            address: found.address,
            symbol: found.symbol,
        });
        served.program.search(text).map(|hits| HitsView { named, ..hits })
    };
    spawn_blocking(look).await.map_err(broken)?.map(Json).map_err(Problem::refused)
}

/// From which scan on.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Since {
    since: Option<Whole<0, SAFE>>,
}

/// The traces that are followed.
#[derive(Debug, Serialize)]
pub(super) struct Trend {
    traces: Vec<Trace>,
}

#[derive(Debug, Serialize)]
struct Trace {
    address: String,
    /// Points that were forgotten because there were too many.
    forgotten: u64,
    /// Scan, simulated seconds, value from there on.
    points: Vec<(u64, f64, f64)>,
}

pub(super) async fn trend(State(served): State<Served>, asked: Asked<Since>) -> Answer<Trend> {
    let Query(Since { since }) = asked?;
    let since = since.map_or(0, Whole::get);
    let traces = served.engine.ask(move |engine| {
        let trace = |trace: &crate::workbench::trend::Trace| Trace {
            address: trace.address.clone(),
            forgotten: trace.forgotten(),
            points: trace.since(since).map(|point| (point.scan, point.time as f64 / 1e9, point.value)).collect(),
        };
        engine.bench.traces().iter().map(trace).collect()
    });
    Ok(Json(Trend { traces: traces.await? }))
}
