//! The workbench in real time: a thread that runs scans when they are due and tells what it sees.
//!
//! The thread waits for nobody. What is asked of it stands in a bounded queue and is done between two scans;
//! what it shows is a [`Frame`] that replaces the one before, some twenty times a second. Whoever is slow
//! misses frames and catches up with the next one.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::time::{Duration, Instant};

use tokio::sync::{oneshot, watch};

use crate::plant::Gauge;
use crate::workbench::pair::First;
use crate::workbench::{Condition, Flow, Pair, Subject, Workbench};

/// Requests that wait at once; more are refused.
const QUEUE: usize = 256;

/// Time between two frames while scans run.
const FRAME: Duration = Duration::from_millis(50);

/// Time that scans run before requests are looked at again.
const SLICE: Duration = Duration::from_millis(10);

/// How far real time may be ahead before it is given up: the machine is too slow for the pace then.
const BEHIND: Duration = Duration::from_millis(250);

/// Scans of a run to a condition when nothing else is said.
pub const MOST_SCANS: u64 = 10_000_000;

/// How scans follow each other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Pace {
    /// None run.
    #[default]
    Paused,
    /// Simulated time passes so many times as fast as real time.
    RealTime(f64),
    /// As fast as they can.
    Fast,
}

/// What browsers look at: the machine as it was after one scan. Never changed.
pub struct Frame {
    /// Counts up; another number is another frame.
    pub number: u64,
    /// The machine, a copy.
    pub machine: Box<dyn Subject>,
    /// Its power flow.
    pub flow: Flow,
    /// What else is known.
    pub status: Status,
}

/// A workbench in a few words.
#[derive(Clone, Debug, Default)]
pub struct Status {
    /// How it runs.
    pub pace: Pace,
    /// Mode of the machine.
    pub mode: &'static str,
    /// Scans since the start.
    pub scans: u64,
    /// Simulated time.
    pub time: Duration,
    /// Simulated time from one scan to the next.
    pub scan_time: Duration,
    /// Why the machine has stopped.
    pub fault: Option<String>,
    /// Code of the fault, where faults of the dialect have one.
    pub fault_code: Option<u16>,
    /// What to look at, where that is known.
    pub advice: Option<&'static str>,
    /// Where: routine and rung.
    pub fault_site: Option<(u16, u16)>,
    /// Installed forces.
    pub forces: Vec<(String, bool)>,
    /// Forces act.
    pub forces_enabled: bool,
    /// Scans that can be gone back.
    pub depth: u64,
    /// Names of the snapshots.
    pub snapshots: Vec<String>,
    /// Scans recorded, while a recording is in progress.
    pub recording: Option<u64>,
    /// The pace asked for is not reached.
    pub slow: bool,
    /// What the controller is wired to.
    pub plant: Option<PlantStatus>,
    /// Why scans run no more, when not because a person paused.
    pub ended: Option<String>,
    /// The tape that is played.
    pub tape: Option<TapeStatus>,
    /// What two machines side by side do.
    pub pair: Option<PairStatus>,
}

/// A tape in a few words.
#[derive(Clone, Debug, Default)]
pub struct TapeStatus {
    /// What it shows.
    pub name: String,
    /// Scans of it that have run.
    pub at: u64,
    /// Scans it has.
    pub scans: u64,
}

/// Two machines side by side.
#[derive(Clone, Debug, Default)]
pub struct PairStatus {
    /// Mode of the other machine.
    pub mode: &'static str,
    /// Why the other machine has stopped.
    pub fault: Option<String>,
    /// The first difference.
    pub first: Option<First>,
    /// Rows of the pairing that differ now.
    pub differing: Vec<u32>,
    /// The original stopped where a stated condition is not kept.
    pub left_conditions: bool,
    /// The run stops at the first difference.
    pub stops: bool,
    /// Installed forces, as the other program spells them.
    pub forces: Vec<(String, bool)>,
}

/// A plant in figures.
#[derive(Clone, Debug, Default)]
pub struct PlantStatus {
    /// Its name.
    pub name: String,
    /// What was wrong with it in the last scan.
    pub wrong: Option<String>,
    /// What it shows.
    pub gauges: Vec<Gauge>,
}

/// A workbench with what drives it. Requests get it one at a time.
pub struct Engine {
    /// The workbench.
    pub bench: Workbench,
    pace: Pace,
    until: Option<(Condition, u64)>,
    ended: Option<String>,
    slow: bool,
    /// Of two machines side by side: a run stops in the scan of the first difference.
    pub stops_at_difference: bool,
    /// When the next scan is due.
    due: Instant,
    /// When the next frame is.
    frame_due: Instant,
    number: u64,
    frames: watch::Sender<Arc<Frame>>,
}

/// Does something and gives what answers it. Answers go out behind the frame, so that who is answered sees what was done.
type Request = Box<dyn FnOnce(&mut Engine) -> Answer + Send>;
type Answer = Box<dyn FnOnce() + Send>;

/// A way to an engine, for many at once. The engine ends when the last one is gone.
#[derive(Clone)]
pub struct Handle {
    requests: SyncSender<Request>,
    frames: watch::Receiver<Arc<Frame>>,
}

/// A request was not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotTaken {
    /// Too many wait already.
    Busy,
    /// The engine has ended.
    Ended,
}

impl std::fmt::Display for NotTaken {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            NotTaken::Busy => "too many requests wait for the simulation already",
            NotTaken::Ended => "the simulation has ended",
        })
    }
}

impl std::error::Error for NotTaken {}

impl Handle {
    /// Does something with the engine between two scans and answers its result.
    ///
    /// # Errors
    /// Too many requests wait, or the engine has ended.
    pub async fn ask<R: Send + 'static>(
        &self,
        what: impl FnOnce(&mut Engine) -> R + Send + 'static,
    ) -> Result<R, NotTaken> {
        let (answer, answered) = oneshot::channel();
        let request: Request = Box::new(move |engine| {
            let result = what(engine);
            Box::new(move || {
                // Nobody waits any more for the answer of a page that was closed.
                let _ = answer.send(result);
            })
        });
        self.requests.try_send(request).map_err(|error| match error {
            TrySendError::Full(_) => NotTaken::Busy,
            TrySendError::Disconnected(_) => NotTaken::Ended,
        })?;
        answered.await.map_err(|_| NotTaken::Ended)
    }

    /// The newest frame, and all later ones.
    pub fn frames(&self) -> watch::Receiver<Arc<Frame>> {
        self.frames.clone()
    }
}

/// Starts an engine on a thread of its own, paused.
///
/// # Errors
/// There is no thread to be had.
pub fn start(bench: Workbench) -> std::io::Result<Handle> {
    let (requests, queue) = sync_channel::<Request>(QUEUE);
    let first = Frame {
        number: 0,
        machine: bench.state().machine.fork(),
        flow: bench.flow().clone(),
        status: Status::default(),
    };
    let (sender, frames) = watch::channel(Arc::new(first));
    let now = Instant::now();
    let mut engine = Engine {
        bench,
        pace: Pace::Paused,
        until: None,
        ended: None,
        slow: false,
        stops_at_difference: true,
        due: now,
        frame_due: now,
        number: 0,
        frames: sender,
    };
    engine.show();
    std::thread::Builder::new().name("scans".to_owned()).spawn(move || engine.run(&queue))?;
    Ok(Handle { requests, frames })
}

impl Engine {
    fn run(&mut self, queue: &Receiver<Request>) {
        loop {
            let first = match self.scans() {
                None => queue.recv().map_err(|_| RecvTimeoutError::Disconnected),
                Some(wait) => queue.recv_timeout(wait),
            };
            match first {
                Ok(request) => {
                    let mut answers = vec![request(self)];
                    // Those that wait by now, but none that come meanwhile: scans are due too.
                    answers.extend(queue.try_iter().take(QUEUE).map(|request| request(self)));
                    self.show();
                    answers.into_iter().for_each(|answer| answer());
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    /// Sets the pace; a run to a condition ends with it.
    pub fn set_pace(&mut self, pace: Pace) {
        self.pace = pace;
        self.until = None;
        self.ended = None;
        self.slow = false;
        self.due = Instant::now();
    }

    /// Runs as fast as it can until a condition holds, at most so many scans.
    ///
    /// # Errors
    /// There is no such address, or it holds no number.
    pub fn run_until(&mut self, condition: Condition, scans: u64) -> Result<(), String> {
        self.bench.holds(&condition)?;
        self.set_pace(Pace::Fast);
        self.until = Some((condition, scans));
        Ok(())
    }

    fn end(&mut self, why: impl Into<String>) {
        self.set_pace(Pace::Paused);
        self.ended = Some(why.into());
    }

    /// Runs the scans that are due; answers how long to wait for the next one, nothing when none will be.
    fn scans(&mut self) -> Option<Duration> {
        let start = Instant::now();
        let interval = match self.pace {
            Pace::Paused => return None,
            Pace::Fast => Duration::ZERO,
            Pace::RealTime(factor) => self.bench.scan_time().div_f64(factor.clamp(0.01, 1000.0)),
        };
        let watched = matches!(self.pace, Pace::RealTime(factor) if factor <= 2.0) || self.until.is_some();
        while start.elapsed() < SLICE && self.due <= Instant::now() {
            self.due += interval;
            if !self.one(watched) {
                break;
            }
        }
        if self.pace == Pace::Paused {
            self.show();
            return None;
        }
        if !interval.is_zero() && self.due.elapsed() > BEHIND {
            self.due = Instant::now();
            self.slow = true;
        }
        if self.frame_due <= Instant::now() {
            // Counted from when it was due, so that twenty a second are twenty; not made up for where that is long ago.
            self.frame_due = (self.frame_due + FRAME).max(Instant::now());
            if !watched {
                // Two, so that what changed in the second one shows.
                let _ = self.one(true) && self.one(true);
                self.due += interval * 2;
            }
            self.show();
        }
        Some(self.due.saturating_duration_since(Instant::now()))
    }

    /// One scan while running; `false`: running has ended.
    fn one(&mut self, watched: bool) -> bool {
        if self.pace == Pace::Paused {
            return false;
        }
        if !self.bench.scan(watched) {
            let stopped = self.bench.state().machine.controller().stopped();
            self.end(match (stopped, self.bench.tape()) {
                (_, Some((tape, at))) if at >= tape.scans() => "the tape has ended".to_owned(),
                (Some(stop), _) => stop.text,
                (None, _) => "the controller is not in run mode".to_owned(),
            });
            return false;
        }
        if let Some(what) = self.stopping_difference(watched) {
            self.end(what);
            return false;
        }
        if let Some((condition, left)) = &mut self.until {
            *left = left.saturating_sub(1);
            let left = *left;
            match self.bench.holds(condition) {
                Ok(true) => self.end("the condition holds"),
                Ok(false) if left == 0 => self.end("the condition did not hold in the scans allowed"),
                Ok(false) => {}
                Err(why) => self.end(why),
            }
        }
        self.pace != Pace::Paused
    }

    /// The first difference, if it arose in the last scan and the run shall stop there. A scan that was not watched
    /// is looked at once more for its power flow.
    pub fn stopping_difference(&mut self, watched: bool) -> Option<String> {
        let machine = &self.bench.state().machine;
        let first = machine.pair().and_then(Pair::first).filter(|_| self.stops_at_difference)?;
        if first.scan != machine.controller().scans() {
            return None;
        }
        let what = format!("the programs differ: {}", first.what);
        if !watched {
            // A recording does not allow it: the flow shown is an older one then, the values are not.
            let _ = self.bench.back(0);
        }
        Some(what)
    }

    fn pair_status(&self) -> Option<PairStatus> {
        let state = self.bench.state();
        let pair = state.machine.pair()?;
        let other = pair.other();
        let spelled = |(address, on): (&String, &bool)| Some((pair.spelled(address).ok()?, *on));
        Some(PairStatus {
            mode: other.mode(),
            fault: other.controller().stopped().map(|stop| stop.text),
            first: pair.first().cloned(),
            differing: pair.differing(),
            left_conditions: pair.has_left_conditions(),
            stops: self.stops_at_difference,
            forces: state.forces.iter().filter_map(spelled).collect(),
        })
    }

    /// Shows the machine as it stands.
    fn show(&mut self) {
        self.number += 1;
        let state = self.bench.state();
        let controller = state.machine.controller();
        let stopped = controller.stopped();
        let status = Status {
            pace: self.pace,
            mode: state.machine.mode(),
            scans: controller.scans(),
            time: controller.now(),
            scan_time: self.bench.scan_time(),
            fault_site: stopped.as_ref().and_then(|_| state.machine.fault_site()),
            fault_code: stopped.as_ref().map(|stop| stop.code).filter(|code| *code != 0),
            advice: stopped.as_ref().and_then(crate::faults::advice),
            fault: stopped.map(|stop| stop.text),
            forces: state.forces.iter().map(|(address, on)| (address.clone(), *on)).collect(),
            forces_enabled: state.machine.forces_enabled(),
            depth: self.bench.depth(),
            snapshots: self.bench.snapshots().map(ToOwned::to_owned).collect(),
            recording: self.bench.recorder().map(|recorder| recorder.scans()),
            slow: self.slow,
            plant: state.plant.as_ref().map(|plant| PlantStatus {
                name: plant.name.clone(),
                wrong: state.plant_wrong.clone(),
                gauges: plant.gauges(),
            }),
            ended: self.ended.clone(),
            tape: self.bench.tape().map(|(tape, at)| TapeStatus {
                name: tape.name().to_owned(),
                at,
                scans: tape.scans(),
            }),
            pair: self.pair_status(),
        };
        let frame =
            Frame { number: self.number, machine: state.machine.fork(), flow: self.bench.flow().clone(), status };
        // Nobody may be looking.
        let _ = self.frames.send(Arc::new(frame));
    }
}
