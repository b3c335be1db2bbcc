//! Requests that change something: run and pause, values, forces, recordings, traces.

use std::time::Duration;

use axum::Json;
use axum::extract::State;
use axum::extract::rejection::JsonRejection;
use serde::{Deserialize, Serialize};
use sim::scenario::Literal;

use super::Served;
use super::asked::{Address, List, Name, Object, SAFE, Whole};
use super::pair::Side;
use super::problem::Problem;
use crate::engine::{Engine, MOST_SCANS, Pace};
use crate::plant::Plant;
use crate::workbench::{Change, Condition, ModeChange, Recorded, Relation, Tape, trend};

type Asked<T> = Result<Json<Object<T>>, JsonRejection>;
type Answer<T> = Result<Json<T>, Problem>;

/// Longest text of a value, characters.
const TEXT: usize = 200;

/// Longest text of a plant file or a scenario, characters.
const FILE: usize = 200_000;

/// Scans one request may run: some seconds.
const SCANS: u64 = 10_000;

/// Addresses of one expectation.
const EXPECTED: usize = 1000;

/// What can be done with the run.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum Control {
    /// Scans run in real time, `speed` times as fast; without a speed as fast as they can.
    Run { speed: Option<f64> },
    /// No scan runs any more.
    Pause {},
    /// So many scans, then a pause.
    Scan { count: Whole<0, SCANS> },
    /// As fast as they can, until a condition holds.
    Until { address: Address, relation: Comparison, value: f64, scans: Option<Whole<0, SAFE>> },
    /// Back by so many scans, then a pause.
    Back { count: Whole<0, SAFE> },
    /// Begins again with the data of the project.
    Restart {},
    /// The key switch.
    Mode { mode: Key },
    /// Simulated milliseconds from one scan to the next.
    ScanTime { ms: f64 },
    /// Keeps the state under a name.
    Keep { name: Name },
    /// Goes on from a state that was kept.
    Resume { name: Name },
    /// Enables or disables all forces.
    Forces { enabled: bool },
    /// Removes all forces.
    ClearForces {},
    /// Wires the controller to a plant, given as the text of a plant file, or to none.
    Plant { text: Option<String> },
    /// Begins again with a scenario as a tape: every scan is its next one. `null`: goes on by hand from where it is.
    Tape { text: Option<String> },
    /// Of two programs side by side: whether a run stops at the first difference.
    StopAtDifference { on: bool },
}

/// Positions of the key switch.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Key {
    Program,
    Run,
    Test,
    PowerCycle,
}

/// How two numbers are compared, as the page spells it.
#[derive(Clone, Copy, Debug, Deserialize)]
pub(super) enum Comparison {
    #[serde(rename = "=")]
    Equal,
    #[serde(rename = "<>")]
    NotEqual,
    #[serde(rename = "<")]
    Less,
    #[serde(rename = "<=")]
    AtMost,
    #[serde(rename = ">")]
    Greater,
    #[serde(rename = ">=")]
    AtLeast,
}

/// What was done.
#[derive(Debug, Default, Serialize)]
pub(super) struct Done {
    /// Scans run or gone back.
    scans: u64,
}

pub(super) async fn control(State(served): State<Served>, asked: Asked<Control>) -> Answer<Done> {
    let Json(Object(control)) = asked?;
    fits(&control).map_err(Problem::unfit)?;
    let done = served.engine.ask(move |engine| carry_out(engine, control)).await?;
    done.map(|scans| Json(Done { scans })).map_err(Problem::refused)
}

/// What types do not say about a request.
fn fits(control: &Control) -> Result<(), String> {
    match control {
        Control::Run { speed: Some(speed) } if !(0.01..=1000.0).contains(speed) => {
            Err(format!("expected a speed from 0.01 to 1000, found {speed}"))
        }
        Control::ScanTime { ms } if !(0.1..=10_000.0).contains(ms) => {
            Err(format!("expected from 0.1 to 10000 milliseconds from one scan to the next, found {ms}"))
        }
        Control::Plant { text: Some(text) } | Control::Tape { text: Some(text) }
            if text.chars().nth(FILE).is_some() =>
        {
            Err(format!("expected a file of at most {FILE} characters, found {}", text.chars().count()))
        }
        _ => Ok(()),
    }
}

fn carry_out(engine: &mut Engine, control: Control) -> Result<u64, String> {
    match control {
        Control::Run { speed: None } => start(engine, Pace::Fast)?,
        Control::Run { speed: Some(speed) } => start(engine, Pace::RealTime(speed))?,
        Control::Pause {} => engine.set_pace(Pace::Paused),
        Control::Scan { count } => {
            start(engine, Pace::Paused)?;
            // The last two are watched, so that what changed between them shows.
            let (count, mut done) = (count.get(), 0);
            while done < count && engine.bench.scan(done + 2 >= count) {
                done += 1;
                if engine.stopping_difference(done + 1 >= count).is_some() {
                    break;
                }
            }
            return Ok(done);
        }
        Control::Until { address, relation, value, scans } => {
            start(engine, Pace::Paused)?;
            let scans = scans.map_or(MOST_SCANS, Whole::get).min(MOST_SCANS);
            let condition = Condition { address: address.into_string(), relation: relation.into(), value };
            engine.run_until(condition, scans)?;
        }
        Control::Back { count } => {
            engine.set_pace(Pace::Paused);
            return engine.bench.back(count.get());
        }
        Control::Restart {} => {
            engine.set_pace(Pace::Paused);
            engine.bench.restart()?;
        }
        Control::Mode { mode } => {
            let mode = match mode {
                Key::Program => ModeChange::Program,
                Key::Run => ModeChange::Run,
                Key::Test => ModeChange::Test,
                Key::PowerCycle => ModeChange::PowerCycle,
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
        Control::Keep { name } => engine.bench.keep(name.as_str())?,
        Control::Resume { name } => {
            engine.set_pace(Pace::Paused);
            engine.bench.resume(name.as_str())?;
        }
        Control::Forces { enabled } => engine.bench.change(Change::EnableForces(enabled))?,
        Control::ClearForces {} => {
            let forced: Vec<String> = engine.bench.state().forces.keys().cloned().collect();
            for address in forced {
                engine.bench.change(Change::Force { address, state: None })?;
            }
        }
        Control::Plant { text } => {
            let plant = text.map(|text| Plant::parse(&text)).transpose()?.map(Box::new);
            engine.bench.change(Change::Plant(plant))?;
        }
        Control::Tape { text: Some(text) } => {
            let tape = Tape::read(&text, engine.bench.initial())?;
            engine.set_pace(Pace::Paused);
            engine.bench.play(tape)?;
        }
        Control::Tape { text: None } => engine.bench.leave_tape(),
        Control::StopAtDifference { on } => engine.stops_at_difference = on,
    }
    Ok(0)
}

/// Sets a pace; a controller in program mode goes to run first, as a person expects who presses run.
fn start(engine: &mut Engine, pace: Pace) -> Result<(), String> {
    // A tape says itself when run is entered.
    if engine.bench.tape().is_none() && engine.bench.state().machine.mode() == "program" {
        engine.bench.change(Change::Mode(ModeChange::Run))?;
    }
    engine.set_pace(pace);
    Ok(())
}

impl From<Comparison> for Relation {
    fn from(comparison: Comparison) -> Relation {
        match comparison {
            Comparison::Equal => Relation::Equal,
            Comparison::NotEqual => Relation::NotEqual,
            Comparison::Less => Relation::Less,
            Comparison::AtMost => Relation::AtMost,
            Comparison::Greater => Relation::Greater,
            Comparison::AtLeast => Relation::AtLeast,
        }
    }
}

/// A value for an address.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Write {
    address: Address,
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

pub(super) async fn write(Side(served): Side, asked: Asked<Write>) -> Answer<Done> {
    let Json(Object(Write { address, value })) = asked?;
    let address = served.spelled(address.as_str());
    let literal = match value {
        Given::Bit(on) => Literal::Integer(on.into()),
        Given::Integer(number) => Literal::Integer(number),
        Given::Float(number) => Literal::Float(number),
        Given::Text(text) if text.chars().nth(TEXT).is_some() => {
            return Err(Problem::unfit(format!("expected a text of at most {TEXT} characters as a value")));
        }
        Given::Text(text) => Literal::Text(text),
    };
    let done = served.engine.ask(move |engine| engine.bench.write(&address, &literal)).await?;
    done.map(|()| Json(Done::default())).map_err(Problem::refused)
}

/// A force for a bit; `null` removes it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Force {
    address: Address,
    state: Option<bool>,
}

pub(super) async fn force(Side(served): Side, asked: Asked<Force>) -> Answer<Done> {
    let Json(Object(Force { address, state })) = asked?;
    let change = Change::Force { address: served.spelled(address.as_str()), state };
    let done = served.engine.ask(move |engine| engine.bench.change(change)).await?;
    done.map(|()| Json(Done::default())).map_err(Problem::refused)
}

/// What can be done with a recording.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum Record {
    /// Begins, from the data of the project.
    Start {},
    /// The values these addresses have now are what the scenario expects here.
    Expect { addresses: List<Address, EXPECTED> },
    /// Ends.
    Stop { name: Name },
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
    let Json(Object(record)) = asked?;
    let (program, family) = (served.program.file_name().to_owned(), served.program.scenario_family());
    let done = served.engine.ask(move |engine| -> Result<Recording, String> {
        match record {
            Record::Start {} => {
                engine.set_pace(Pace::Paused);
                engine.bench.record()?;
                Ok(Recording::default())
            }
            Record::Expect { addresses } => {
                engine.bench.expect(&texts(addresses))?;
                Ok(Recording::default())
            }
            Record::Stop { name } => {
                engine.set_pace(Pace::Paused);
                let recorded = Recorded { name: name.into_string(), program, family };
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
    addresses: List<Address, { trend::TRACES }>,
}

pub(super) async fn follow(State(served): State<Served>, asked: Asked<Follow>) -> Answer<Done> {
    let Json(Object(Follow { addresses })) = asked?;
    let done = served.engine.ask(move |engine| engine.bench.follow(&texts(addresses))).await?;
    done.map(|()| Json(Done::default())).map_err(Problem::refused)
}

fn texts<const MOST: usize>(addresses: List<Address, MOST>) -> Vec<String> {
    addresses.into_vec().into_iter().map(Address::into_string).collect()
}
