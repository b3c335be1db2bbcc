//! Two programs side by side: what belongs together, and the search for a difference.

use std::sync::Arc;

use analysis::proof::{Kind, Pairing};
use axum::Json;
use axum::extract::rejection::{JsonRejection, QueryRejection};
use axum::extract::{FromRequestParts, Query, State};
use axum::http::request::Parts;
use ladder::{Address, Documentation, Target};
use serde::{Deserialize, Serialize};

use super::Served;
use super::asked::{Object, SAFE, Whole};
use super::problem::Problem;
use crate::engine;
use crate::prover::{self, Prover};
use crate::view::{Outline, Program};
use crate::workbench::pair::OTHER;

/// Rows of one answer.
const ROWS: u64 = 2000;

/// Paths of what two programs have together.
pub(super) const PATHS: [&str; 3] = ["/api/pair", "/api/pair/rows", "/api/pair/proof"];

/// What paths begin with that ask the other program what `/api/` asks the original.
pub(super) const OTHER_PATHS: &str = "/api/other/";

/// The program a request means, by its path.
pub(super) struct Side(pub(super) Served);

impl FromRequestParts<Served> for Side {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, served: &Served) -> Result<Side, Problem> {
        if !parts.uri.path().starts_with(OTHER_PATHS) {
            return Ok(Side(served.clone()));
        }
        let program = Arc::clone(&pair(served)?.other);
        Ok(Side(Served { program, prefix: OTHER, ..served.clone() }))
    }
}

/// What pages show of two programs side by side.
pub struct PairView {
    other: Arc<dyn Program>,
    pairing: Arc<Pairing>,
    /// Per row symbol and description.
    documented: Vec<(String, String)>,
    /// Routine and rung of the original, of the other program.
    rungs: Vec<[usize; 4]>,
    prover: Prover,
}

impl PairView {
    /// Prepares two programs to be served: the other one as pages show it, what belongs together, the documentation of
    /// the original, and which rung became which (routine and rung of the original, then of the other program).
    pub fn new(
        other: Arc<dyn Program>,
        pairing: Arc<Pairing>,
        documentation: &Documentation,
        rungs: Vec<[usize; 4]>,
        prover: Prover,
    ) -> PairView {
        let documented = pairing.rows().iter().map(|row| {
            let Ok(address) = Address::parse(&row.original) else { return Default::default() };
            let shown = documentation.shown(&Target::from(&address), "");
            (shown.symbol.unwrap_or_default(), shown.description.join(" "))
        });
        PairView { other, documented: documented.collect(), pairing, rungs, prover }
    }

    pub(super) fn outline(&self) -> &Outline {
        self.other.outline()
    }
}

fn pair(served: &Served) -> Result<Arc<PairView>, Problem> {
    served.pair.clone().ok_or_else(|| Problem::missing("one program is served, not two side by side"))
}

/// A tape, as browsers get it.
#[derive(Debug, Serialize)]
pub(super) struct TapeStatus {
    name: String,
    /// Scans of it that have run.
    at: u64,
    scans: u64,
}

impl TapeStatus {
    pub(super) fn of(status: &engine::TapeStatus) -> TapeStatus {
        TapeStatus { name: status.name.clone(), at: status.at, scans: status.scans }
    }
}

/// Differing rows that are told with every frame.
const TOLD: usize = 200;

/// Two machines, as browsers get them.
#[derive(Debug, Serialize)]
pub(super) struct PairStatus {
    /// Mode of the other machine.
    mode: &'static str,
    fault: Option<String>,
    /// The first difference since both began.
    first: Option<First>,
    /// Rows that differ now, by number, the first of them.
    differing: Vec<u32>,
    /// How many rows differ now.
    differences: usize,
    left_conditions: bool,
    stop_at_difference: bool,
    /// Installed forces, as the other program spells them.
    forces: Vec<(String, bool)>,
}

#[derive(Debug, Serialize)]
struct First {
    scan: u64,
    /// Simulated seconds.
    time: f64,
    what: String,
    /// Address of the original and of the other program.
    addresses: Option<(String, String)>,
}

impl PairStatus {
    pub(super) fn of(status: &engine::PairStatus) -> PairStatus {
        let first = status.first.as_ref().map(|first| First {
            scan: first.scan,
            time: first.time.as_secs_f64(),
            what: first.what.clone(),
            addresses: first.addresses.clone(),
        });
        PairStatus {
            mode: status.mode,
            fault: status.fault.clone(),
            first,
            differing: status.differing.iter().take(TOLD).copied().collect(),
            differences: status.differing.len(),
            left_conditions: status.left_conditions,
            stop_at_difference: status.stops,
            forces: status.forces.clone(),
        }
    }
}

/// Two programs.
#[derive(Debug, Serialize)]
pub(super) struct Overview {
    original: String,
    other: String,
    /// Routine and rung of the original, routine and rung of the other program.
    rungs: Vec<[usize; 4]>,
    /// How many rows of data both have.
    rows: usize,
    /// Addresses without a place on both sides, with why.
    unmapped: Vec<(String, String)>,
    /// Why parts, or the whole, cannot be compared.
    incomparable: Vec<String>,
}

pub(super) async fn overview(State(served): State<Served>) -> Result<Json<Overview>, Problem> {
    let pair = pair(&served)?;
    Ok(Json(Overview {
        original: served.program.file_name().to_owned(),
        other: pair.other.file_name().to_owned(),
        rungs: pair.rungs.clone(),
        rows: pair.pairing.rows().len(),
        unmapped: pair.pairing.unmapped().to_vec(),
        incomparable: pair.pairing.incomparable().to_vec(),
    }))
}

/// Data both programs have.
#[derive(Debug, Serialize)]
pub(super) struct Row {
    row: usize,
    original: String,
    other: String,
    kind: &'static str,
    symbol: String,
    description: String,
    /// It is compared after every scan.
    compared: bool,
}

/// A stretch of rows.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Stretch {
    from: Option<Whole<0, SAFE>>,
    count: Option<Whole<0, ROWS>>,
}

pub(super) async fn rows(
    State(served): State<Served>,
    asked: Result<Query<Stretch>, QueryRejection>,
) -> Result<Json<Vec<Row>>, Problem> {
    let Query(Stretch { from, count }) = asked?;
    let pair = pair(&served)?;
    let all = (0..).zip(pair.pairing.rows()).zip(&pair.documented);
    let row = |((number, row), (symbol, description)): ((usize, &analysis::proof::Row), &(String, String))| Row {
        row: number,
        original: row.original.clone(),
        other: row.other.clone(),
        kind: match row.kind {
            Kind::Bit => "bit",
            Kind::Word => "word",
            Kind::Long => "long",
            Kind::Float => "float",
            Kind::Text => "text",
        },
        symbol: symbol.clone(),
        description: description.clone(),
        compared: row.compared,
    };
    Ok(Json(all.skip(from.map_or(0, Whole::size)).take(count.map_or(ROWS as usize, Whole::size)).map(row).collect()))
}

/// The search for a difference.
#[derive(Debug, Default, Serialize)]
pub(super) struct Proof {
    /// `idle`, `running`, `arguing`, `shortening`, `stopping`, `broken` or `done`.
    state: &'static str,
    seed: Option<u64>,
    /// Scans of both so far.
    scans: u64,
    /// Scans it may make.
    of: u64,
    /// The verdict in the words of the proof.
    verdict: Option<&'static str>,
    /// The whole report.
    text: Option<String>,
    /// What, how much of it was reached, of how much.
    coverage: Vec<(&'static str, usize, usize)>,
    found: Option<Found>,
}

#[derive(Debug, Serialize)]
struct Found {
    what: String,
    scans: usize,
    changes: usize,
    /// Scenarios for both sides.
    original: String,
    other: String,
}

pub(super) async fn proof(State(served): State<Served>) -> Result<Json<Proof>, Problem> {
    Ok(Json(Proof::of(&pair(&served)?.prover)))
}

impl Proof {
    fn of(prover: &Prover) -> Proof {
        match prover.state() {
            prover::State::Idle => Proof { state: "idle", ..Proof::default() },
            prover::State::Broken => Proof { state: "broken", ..Proof::default() },
            prover::State::Running { progress, seed, scans } => Proof {
                state: match (progress.is_stopped(), progress.is_shortening(), progress.is_arguing()) {
                    (true, ..) => "stopping",
                    (false, true, _) => "shortening",
                    (false, false, true) => "arguing",
                    (false, false, false) => "running",
                },
                seed: Some(seed),
                scans: progress.scans(),
                of: scans,
                ..Proof::default()
            },
            prover::State::Done(verdict) => Proof {
                state: "done",
                seed: Some(verdict.seed),
                scans: verdict.scans.0,
                of: verdict.scans.1,
                verdict: Some(verdict.verdict),
                text: Some(verdict.text.clone()),
                coverage: verdict.coverage.iter().map(|(what, found)| (*what, found.reached, found.all)).collect(),
                found: verdict.found.as_ref().map(|example| Found {
                    what: example.what.clone(),
                    scans: example.scans,
                    changes: example.changes,
                    original: example.original.clone(),
                    other: example.other.clone(),
                }),
            },
        }
    }
}

/// What can be asked of the search.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum Prove {
    /// Begins.
    Start { seed: Option<Whole<0, SAFE>>, scans: Option<Whole<1, { prover::SCANS }>> },
    /// Ends with what was seen so far.
    Stop {},
}

/// Scans and seed when nothing else is said, as `rungs prove` has them.
const USUAL: (u64, u64) = (100_000, 1);

pub(super) async fn prove(
    State(served): State<Served>,
    asked: Result<Json<Object<Prove>>, JsonRejection>,
) -> Result<Json<Proof>, Problem> {
    let Json(Object(asked)) = asked?;
    let pair = pair(&served)?;
    match asked {
        Prove::Start { seed, scans } => {
            let (scans, seed) = (scans.map_or(USUAL.0, Whole::get), seed.map_or(USUAL.1, Whole::get));
            pair.prover.start(seed, scans).map_err(Problem::refused)?;
        }
        Prove::Stop {} => pair.prover.stop(),
    }
    Ok(Json(Proof::of(&pair.prover)))
}
