//! A proof run beside the workbench: on a thread of its own, one at a time, bounded, and stopped when asked.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use analysis::proof::{Counterexample, Coverage, GoalKind, Progress, Report};

/// Scans of one run: minutes.
pub const SCANS: u64 = 10_000_000;

/// Runs a proof over so many scans, from a seed, telling how far it is.
pub type Run = dyn Fn(u64, u64, Arc<Progress>) -> Report + Send + Sync;

/// Runs proofs of one pair of programs. A run ends when this is gone.
pub struct Prover {
    run: Arc<Run>,
    state: Arc<Mutex<State>>,
}

/// How the search for a difference stands.
#[derive(Clone, Default)]
pub enum State {
    /// None was asked for yet.
    #[default]
    Idle,
    /// One is under way.
    Running {
        /// Where it is.
        progress: Arc<Progress>,
        /// Start of its random sequence.
        seed: u64,
        /// Scans it may make.
        scans: u64,
    },
    /// It broke off without a result.
    Broken,
    /// It has ended.
    Done(Arc<Verdict>),
}

/// What a run says.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Start of its random sequence.
    pub seed: u64,
    /// Scans it made, and those it was allowed.
    pub scans: (u64, u64),
    /// The verdict in the words of the proof.
    pub verdict: &'static str,
    /// The whole report.
    pub text: String,
    /// What was covered.
    pub coverage: Vec<(&'static str, Coverage)>,
    /// The difference, as scenarios for both sides.
    pub found: Option<Counterexample>,
}

impl Verdict {
    fn of(report: &Report, seed: u64, asked: u64) -> Verdict {
        let coverage = vec![
            ("rung conditions", report.conditions_covered()),
            (
                "timers and counters done and not done",
                report.coverage(|kind| matches!(kind, GoalKind::Done | GoalKind::NotDone)),
            ),
            (
                "comparisons at, below and above their boundary",
                report.coverage(|kind| matches!(kind, GoalKind::Equal | GoalKind::JustBelow | GoalKind::JustAbove)),
            ),
            ("contacts and outputs of the other program, on and off", report.other_coverage),
        ];
        Verdict {
            seed,
            scans: (report.scans, asked),
            verdict: report.verdict().as_str(),
            text: report.to_string(),
            // No percentage of nothing: a reader would take it for all of it.
            coverage: coverage.into_iter().filter(|(_, found)| report.scans > 0 && found.all > 0).collect(),
            found: report.found.as_ref().map(|(_, example)| example.clone()),
        }
    }
}

/// Tells that a run broke off if nothing else was told before it is dropped.
struct Ending(Arc<Mutex<State>>);

impl Drop for Ending {
    fn drop(&mut self) {
        let mut state = lock(&self.0);
        if matches!(*state, State::Running { .. }) {
            *state = State::Broken;
        }
    }
}

impl Prover {
    /// Runs nothing yet.
    pub fn new(run: Arc<Run>) -> Prover {
        Prover { run, state: Arc::default() }
    }

    /// How it stands.
    pub fn state(&self) -> State {
        lock(&self.state).clone()
    }

    /// Starts a run.
    ///
    /// # Errors
    /// One is under way, the number of scans is out of range, or there is no thread to be had.
    pub fn start(&self, seed: u64, scans: u64) -> Result<(), String> {
        if !(1..=SCANS).contains(&scans) {
            return Err(format!("expected 1 to {SCANS} scans, found {scans}"));
        }
        let progress = Arc::new(Progress::default());
        {
            let mut state = lock(&self.state);
            if matches!(*state, State::Running { .. }) {
                return Err("a search is under way: it must end or be stopped first".to_owned());
            }
            *state = State::Running { progress: Arc::clone(&progress), seed, scans };
        }
        let (run, ending) = (Arc::clone(&self.run), Ending(Arc::clone(&self.state)));
        let work = move || {
            let verdict = Verdict::of(&run(seed, scans, progress), seed, scans);
            *lock(&ending.0) = State::Done(Arc::new(verdict));
        };
        // Without a thread the closure is dropped, and with it the ending, which tells.
        let thread = std::thread::Builder::new().name("proof".to_owned()).spawn(work);
        thread.map(drop).map_err(|why| why.to_string())
    }

    /// Asks the run under way to end; what it has seen is its result.
    pub fn stop(&self) {
        if let State::Running { progress, .. } = &*lock(&self.state) {
            progress.stop();
        }
    }
}

impl Drop for Prover {
    fn drop(&mut self) {
        self.stop();
    }
}

fn lock(state: &Mutex<State>) -> MutexGuard<'_, State> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}
