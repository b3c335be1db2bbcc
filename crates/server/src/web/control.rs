//! Requests that change something: run and pause, values, forces, recordings, traces.

use std::time::Duration;

use axum::Json;
use axum::extract::State;
use axum::extract::rejection::JsonRejection;
use serde::{Deserialize, Serialize};
use sim::scenario::Literal;

use super::Served;
use super::problem::Problem;
use crate::engine::{Engine, MOST_SCANS, Pace};
use crate::plant::Plant;
use crate::workbench::{Change, Condition, ModeChange, Recorded, Relation};

type Asked<T> = Result<Json<T>, JsonRejection>;
type Answer<T> = Result<Json<T>, Problem>;

/// Longest text of a name, an address or a value.
const TEXT: usize = 200;

/// What can be done with the run.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum Control {
    /// Scans run in real time, `speed` times as fast; without a speed as fast as they can.
    Run { speed: Option<f64> },
    /// No scan runs any more.
    Pause,
    /// So many scans, then a pause.
    Scan { count: u32 },
    /// As fast as they can, until a condition holds.
    Until { address: String, relation: String, value: f64, scans: Option<u64> },
    /// Back by so many scans, then a pause.
    Back { count: u64 },
    /// Begins again with the data of the project.
    Restart,
    /// The key switch.
    Mode { mode: String },
    /// Simulated milliseconds from one scan to the next.
    ScanTime { ms: f64 },
    /// Keeps the state under a name.
    Keep { name: String },
    /// Goes on from a state that was kept.
    Resume { name: String },
    /// Enables or disables all forces.
    Forces { enabled: bool },
    /// Removes all forces.
    ClearForces,
    /// Wires the controller to a plant, given as the text of a plant file, or to none.
    Plant { text: Option<String> },
}

/// What was done.
#[derive(Debug, Default, Serialize)]
pub(super) struct Done {
    /// Scans run or gone back.
    scans: u64,
}

/// Scans one request may run: some seconds.
const SCANS: u32 = 10_000;

pub(super) async fn control(State(served): State<Served>, asked: Asked<Control>) -> Answer<Done> {
    let Json(control) = asked?;
    if let Control::Scan { count } = control
        && count > SCANS
    {
        return Err(Problem::refused(format!("expected at most {SCANS} scans in one request, found {count}")));
    }
    let done = served.engine.ask(move |engine| carry_out(engine, control)).await?;
    done.map(|scans| Json(Done { scans })).map_err(Problem::refused)
}

fn carry_out(engine: &mut Engine, control: Control) -> Result<u64, String> {
    match control {
        Control::Run { speed: None } => start(engine, Pace::Fast)?,
        Control::Run { speed: Some(speed) } if (0.01..=1000.0).contains(&speed) => {
            start(engine, Pace::RealTime(speed))?
        }
        Control::Run { speed: Some(speed) } => {
            return Err(format!("expected a speed from 0.01 to 1000, found {speed}"));
        }
        Control::Pause => engine.set_pace(Pace::Paused),
        Control::Scan { count } => {
            start(engine, Pace::Paused)?;
            // The last two are watched, so that what changed between them shows.
            return Ok((0..count).take_while(|number| engine.bench.scan(number + 2 >= count)).count() as u64);
        }
        Control::Until { address, relation, value, scans } => {
            start(engine, Pace::Paused)?;
            let relation = relation_of(&relation)?;
            let scans = scans.unwrap_or(MOST_SCANS).min(MOST_SCANS);
            engine.run_until(Condition { address, relation, value }, scans)?;
        }
        Control::Back { count } => {
            engine.set_pace(Pace::Paused);
            return engine.bench.back(count);
        }
        Control::Restart => {
            engine.set_pace(Pace::Paused);
            engine.bench.restart()?;
        }
        Control::Mode { mode } => {
            let mode = match mode.as_str() {
                "program" => ModeChange::Program,
                "run" => ModeChange::Run,
                "test" => ModeChange::Test,
                "power-cycle" => ModeChange::PowerCycle,
                other => return Err(format!("expected program, run, test or power-cycle, found `{other}`")),
            };
            if mode == ModeChange::Program {
                engine.set_pace(Pace::Paused);
            }
            engine.bench.change(Change::Mode(mode))?;
        }
        Control::ScanTime { ms } => {
            let time = Duration::try_from_secs_f64(ms / 1000.0).map_err(|why| why.to_string())?;
            engine.bench.set_scan_time(time)?;
        }
        Control::Keep { name } => engine.bench.keep(short(&name)?)?,
        Control::Resume { name } => {
            engine.set_pace(Pace::Paused);
            engine.bench.resume(&name)?;
        }
        Control::Forces { enabled } => engine.bench.change(Change::EnableForces(enabled))?,
        Control::ClearForces => {
            let forced: Vec<String> = engine.bench.state().forces.keys().cloned().collect();
            for address in forced {
                engine.bench.change(Change::Force { address, state: None })?;
            }
        }
        Control::Plant { text } => {
            let plant = text.map(|text| Plant::parse(&text)).transpose()?.map(Box::new);
            engine.bench.change(Change::Plant(plant))?;
        }
    }
    Ok(0)
}

/// Sets a pace; a controller in program mode goes to run first, as a person expects who presses run.
fn start(engine: &mut Engine, pace: Pace) -> Result<(), String> {
    if engine.bench.state().machine.mode() == "program" {
        engine.bench.change(Change::Mode(ModeChange::Run))?;
    }
    engine.set_pace(pace);
    Ok(())
}

fn relation_of(text: &str) -> Result<Relation, String> {
    Ok(match text {
        "=" => Relation::Equal,
        "<>" => Relation::NotEqual,
        "<" => Relation::Less,
        "<=" => Relation::AtMost,
        ">" => Relation::Greater,
        ">=" => Relation::AtLeast,
        other => return Err(format!("expected one of = <> < <= > >=, found `{other}`")),
    })
}

fn short(text: &str) -> Result<&str, String> {
    match text.chars().count() {
        1..=TEXT => Ok(text),
        count => Err(format!("expected a text of 1 to {TEXT} characters, found {count}")),
    }
}

/// A value for an address.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Write {
    address: String,
    value: Given,
}

/// A value as JSON has it; a text can be a number in hex.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Given {
    Bit(bool),
    Integer(i64),
    Float(f64),
    Text(String),
}

pub(super) async fn write(State(served): State<Served>, asked: Asked<Write>) -> Answer<Done> {
    let Json(Write { address, value }) = asked?;
    let literal = match value {
        Given::Bit(on) => Literal::Integer(on.into()),
        Given::Integer(number) => Literal::Integer(number),
        Given::Float(number) => Literal::Float(number),
        Given::Text(text) => Literal::Text(text),
    };
    let done = served.engine.ask(move |engine| engine.bench.write(&address, &literal)).await?;
    done.map(|()| Json(Done::default())).map_err(Problem::refused)
}

/// A force for a bit; `null` removes it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Force {
    address: String,
    state: Option<bool>,
}

pub(super) async fn force(State(served): State<Served>, asked: Asked<Force>) -> Answer<Done> {
    let Json(Force { address, state }) = asked?;
    let done = served.engine.ask(move |engine| engine.bench.change(Change::Force { address, state })).await?;
    done.map(|()| Json(Done::default())).map_err(Problem::refused)
}

/// What can be done with a recording.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum Record {
    /// Begins, from the data of the project.
    Start,
    /// The values these addresses have now are what the scenario expects here.
    Expect { addresses: Vec<String> },
    /// Ends.
    Stop { name: String },
}

/// A recording.
#[derive(Debug, Default, Serialize)]
pub(super) struct Recording {
    /// The scenario, once the recording has ended.
    #[serde(skip_serializing_if = "Option::is_none")]
    scenario: Option<String>,
    /// What the scenario lacks, and where its replay on a fresh machine did not meet what was recorded.
    problems: Vec<String>,
}

pub(super) async fn record(State(served): State<Served>, asked: Asked<Record>) -> Answer<Recording> {
    let Json(record) = asked?;
    let (program, family) = (served.program.file_name().to_owned(), served.program.scenario_family());
    let done = served.engine.ask(move |engine| -> Result<Recording, String> {
        match record {
            Record::Start => {
                engine.set_pace(Pace::Paused);
                engine.bench.record()?;
                Ok(Recording::default())
            }
            Record::Expect { addresses } => {
                engine.bench.expect(&addresses)?;
                Ok(Recording::default())
            }
            Record::Stop { name } => {
                engine.set_pace(Pace::Paused);
                let recorded = Recorded { name: short(&name)?.to_owned(), program, family };
                let (scenario, problems) = engine.bench.recorded(&recorded)?;
                Ok(Recording { scenario: Some(scenario), problems })
            }
        }
    });
    done.await?.map(Json).map_err(Problem::refused)
}

/// Addresses to follow.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Follow {
    addresses: Vec<String>,
}

pub(super) async fn follow(State(served): State<Served>, asked: Asked<Follow>) -> Answer<Done> {
    let Json(Follow { addresses }) = asked?;
    let done = served.engine.ask(move |engine| engine.bench.follow(&addresses)).await?;
    done.map(|()| Json(Done::default())).map_err(Problem::refused)
}
