//! What a proof run says.

use std::collections::BTreeMap;
use std::fmt;
use std::time::Duration;

use super::Options;
use super::campaign::Campaign;
use super::goals::{Goal, GoalKind};
use super::pairs::Pairs;
use super::play::Difference;
use super::scenario::Counterexample;
use super::side::{Kind, Side};

/// The result of a proof run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// No difference was found within the coverage reported. Nothing is claimed beyond it.
    NoDifference,
    /// The programs differ.
    Different,
    /// Parts cannot be compared, or nothing can; no difference was found in the rest.
    NotComparable,
}

impl Verdict {
    /// `no difference found within this coverage`, `different`, `not comparable`.
    pub fn as_str(self) -> &'static str {
        match self {
            Verdict::NoDifference => "no difference found within this coverage",
            Verdict::Different => "different",
            Verdict::NotComparable => "not comparable",
        }
    }
}

/// How much of a set of goals was reached, those that are impossible by argument left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Coverage {
    /// Reached.
    pub reached: usize,
    /// All that can be.
    pub all: usize,
}

impl Coverage {
    /// Percent; 100 where there is nothing to reach, which says nothing where nothing was compared either.
    pub fn percent(self) -> f64 {
        if self.all == 0 { 100.0 } else { 100.0 * self.reached as f64 / self.all as f64 }
    }
}

impl fmt::Display for Coverage {
    /// `38 of 40 (95.0 %)`, cut, never rounded up; no percentage of nothing.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.all == 0 {
            return f.write_str("0 of 0");
        }
        write!(f, "{} of {} ({:.1} %)", self.reached, self.all, (self.percent() * 10.0).floor() / 10.0)
    }
}

/// Coverage of a rung.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RungCoverage {
    /// Program file.
    pub file: u16,
    /// Rung, from 0.
    pub rung: u32,
    /// Its conditions and outputs, timers and comparisons.
    pub coverage: Coverage,
    /// What was not reached.
    pub missing: Vec<Goal>,
}

/// What a proof run found and covered.
#[derive(Clone, Debug)]
pub struct Report {
    /// Start of the random sequence.
    pub seed: u64,
    /// Scans of both sides.
    pub scans: u64,
    /// Stretches of scans, each from a state seen before.
    pub episodes: u64,
    /// Times run was left and entered.
    pub mode_changes: u64,
    /// Times both sides stopped alike.
    pub stops: u64,
    /// Stretches that ended because the original stopped where a stated condition was not kept.
    pub outside: u64,
    /// Simulated time.
    pub time: Duration,
    /// Words, bits and strings compared after every scan.
    pub compared: usize,
    /// Words left out of the comparison because rungs left to a person decide them.
    pub not_compared: usize,
    /// Inputs that were changed.
    pub inputs: usize,
    /// What exactly was compared and changed, by the other program's memory.
    pub scope: Scope,
    /// All goals with what was reached.
    pub goals: Vec<Goal>,
    /// Contacts and outputs of the other program, seen on and off, of those that ran; nothing where that is
    /// not told.
    pub other_coverage: Coverage,
    /// Instructions of the other program that were not seen both with and without power: code block, rung and
    /// instruction, from 0. Those that only compute count where they were never executed with power.
    pub other_missing: Vec<(usize, usize, usize)>,
    /// The first difference and how to see it.
    pub found: Option<(Difference, Counterexample)>,
    /// Why parts, or the whole, cannot be compared.
    pub incomparable: Vec<String>,
    /// Which rung came from which was not checked, as [`Options::without_marks`] asked for.
    pub identity_unchecked: bool,
    /// Rungs of the original that the migration does not mention, or that have nothing in their place.
    pub missing_rungs: Vec<String>,
    /// Rungs left to a person, with the reason.
    pub persons: Vec<String>,
    /// Conditions under which rungs behave the same.
    pub conditions: Vec<String>,
    /// Addresses the program uses that cannot be compared, with why.
    pub unmapped: Vec<(String, String)>,
    /// What a reader must know besides.
    pub notes: Vec<String>,
    /// What the simulation of the original and of the other program only approximates.
    pub approximations: [Vec<String>; 2],
}

/// What a run compares and what it changes, named by the other program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Scope {
    /// Words compared after every scan: first bit in the memory of the other program, and which of their bits.
    pub compared: Vec<(u32, u16)>,
    /// Data that is changed between scans.
    pub driven: Vec<Driven>,
}

/// Data of the other program that is changed between scans.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Driven {
    /// Its address.
    pub address: String,
    /// What stands there.
    pub kind: Kind,
    /// Least and greatest raw value, where not all of the type are sensible.
    pub range: Option<(u32, u32)>,
}

/// What no run exercises, whatever the program.
pub const NOT_MODELLED: [&str; 5] = [
    "loss of power: only leaving and entering run is tried",
    "inputs and communication that change during a scan, and the time a scan takes itself",
    "times between scans that are no whole milliseconds",
    "forces, hardware faults and messages of other controllers",
    "a timer that is timing while nothing executes it for more than eleven days",
];

impl Report {
    pub(crate) fn empty(options: &Options) -> Report {
        Report {
            seed: options.seed,
            scans: 0,
            episodes: 0,
            mode_changes: 0,
            stops: 0,
            outside: 0,
            time: Duration::ZERO,
            compared: 0,
            not_compared: 0,
            inputs: 0,
            scope: Scope::default(),
            goals: Vec::new(),
            other_coverage: Coverage::default(),
            other_missing: Vec::new(),
            found: None,
            incomparable: Vec::new(),
            identity_unchecked: false,
            missing_rungs: Vec::new(),
            persons: Vec::new(),
            conditions: Vec::new(),
            unmapped: Vec::new(),
            notes: Vec::new(),
            approximations: [Vec::new(), Vec::new()],
        }
    }

    pub(crate) fn impossible(why: Vec<String>, options: &Options) -> Report {
        Report { incomparable: why, ..Report::empty(options) }
    }

    pub(crate) fn take_map(&mut self, pairs: &Pairs, left_out: &[(String, String)]) {
        self.compared = pairs.compared();
        self.unmapped = pairs.unmapped.iter().chain(left_out).cloned().collect();
        // What the program uses of these rows is among the unmapped.
        let unusable = pairs.unusable.iter().map(|(what, why)| format!("row of the map not used: {what}: {why}"));
        self.notes.extend(unusable);
        self.unmapped.sort();
        self.unmapped.dedup();
    }

    pub(crate) fn take_run<B: Side>(&mut self, campaign: &Campaign<'_, B>, inputs: usize) {
        self.scans = campaign.scans;
        self.episodes = campaign.episodes;
        self.mode_changes = campaign.mode_changes;
        self.stops = campaign.stops;
        self.outside = campaign.outside;
        self.time = campaign.time;
        self.inputs = inputs;
        self.scope = Scope { compared: campaign.pairs.places(), driven: campaign.inputs.driven() };
        let (reached, all) = campaign.seen.both_ways();
        self.other_coverage = Coverage { reached, all };
        let spots = campaign.seen.missing().filter_map(|operation| campaign.both.b.spot(operation));
        self.other_missing = spots.collect();
        self.other_missing.dedup();
        self.goals.clone_from(&campaign.goals.all);
        if let Some(why) = campaign.unargued {
            self.notes.push(format!("what was not reached was not examined further: {why}"));
        }
        if self.scans < 2 && campaign.found.is_none() {
            let why = match (self.scans, campaign.both.a.stopped()) {
                (0, _) if campaign.is_stopped() => "the run was stopped before its first scan: nothing was compared",
                (0, _) => "no scan was asked for: nothing was compared",
                (_, Some(_)) => "the original stops in its first scan",
                (_, None) => "one scan only: no input was changed",
            };
            self.incomparable.push(why.to_owned());
        }
    }

    /// The result. Anything that is missing, unmapped or left to a person excludes
    /// [`Verdict::NoDifference`].
    pub fn verdict(&self) -> Verdict {
        let parts = [&self.incomparable, &self.missing_rungs, &self.persons];
        if self.found.is_some() || !self.missing_rungs.is_empty() {
            Verdict::Different
        } else if parts.iter().any(|part| !part.is_empty()) || !self.unmapped.is_empty() {
            Verdict::NotComparable
        } else {
            Verdict::NoDifference
        }
    }

    /// Coverage of goals of some kinds.
    pub fn coverage(&self, of: impl Fn(GoalKind) -> bool) -> Coverage {
        let goals = self.goals.iter().filter(|goal| of(goal.kind) && (goal.reached || goal.impossible.is_none()));
        goals.fold(Coverage::default(), |sum, goal| Coverage {
            reached: sum.reached + usize::from(goal.reached),
            all: sum.all + 1,
        })
    }

    /// Coverage of rung conditions: contacts and comparisons both ways, outputs with and without power.
    pub fn conditions_covered(&self) -> Coverage {
        self.coverage(GoalKind::is_rung_condition)
    }

    /// Coverage per rung, in program order.
    pub fn rungs(&self) -> Vec<RungCoverage> {
        let mut rungs: BTreeMap<(u16, u32), RungCoverage> = BTreeMap::new();
        for goal in &self.goals {
            let (file, rung) = (goal.location.file, goal.location.rung);
            let entry = rungs.entry((file, rung)).or_insert_with(|| RungCoverage {
                file,
                rung,
                coverage: Coverage::default(),
                missing: Vec::new(),
            });
            if goal.reached || goal.impossible.is_none() {
                entry.coverage.all += 1;
                entry.coverage.reached += usize::from(goal.reached);
                if !goal.reached {
                    entry.missing.push(goal.clone());
                }
            }
        }
        rungs.into_values().collect()
    }

    /// The verdict with what must be known to read it.
    fn headline(&self) -> String {
        let mut line = self.verdict().as_str().to_owned();
        if self.identity_unchecked {
            line.push_str("; the identity of the rungs was not checked");
        }
        line
    }

    fn coverage_lines(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} inputs changed, {} words compared after every scan", self.inputs, self.compared)?;
        let kinds: [(&str, Of); 4] = [
            ("rung conditions", GoalKind::is_rung_condition),
            ("  of these outputs with and without power", |kind| matches!(kind, GoalKind::True | GoalKind::False)),
            ("timers and counters done and not done", |kind| matches!(kind, GoalKind::Done | GoalKind::NotDone)),
            ("comparisons at, below and above their boundary", |kind| {
                matches!(kind, GoalKind::Equal | GoalKind::JustBelow | GoalKind::JustAbove)
            }),
        ];
        for (title, of) in kinds {
            writeln!(f, "{title}: {} reached", self.coverage(of))?;
        }
        if self.other_coverage.all > 0 {
            writeln!(f, "contacts and outputs of the other program, on and off: {} seen", self.other_coverage)?;
        }
        Ok(())
    }

    /// Goals that cannot be reached by argument, with the argument.
    pub fn impossible_goals(&self) -> impl Iterator<Item = &Goal> {
        self.goals.iter().filter(|goal| !goal.reached && goal.impossible.is_some())
    }
}

/// Chooses goals.
type Of = fn(GoalKind) -> bool;

/// Lines of a list that text shows.
const LISTED: usize = 40;

impl fmt::Display for Report {
    /// The report as text, the verdict first.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.headline())?;
        if let Some((_, example)) = &self.found {
            writeln!(f, "  {}", example.what)?;
            writeln!(f, "  after {} scans with {} changes of inputs", example.scans, example.changes)?;
        }
        writeln!(f)?;
        writeln!(f, "seed {}, {} scans of both in {} stretches", self.seed, self.scans, self.episodes)?;
        writeln!(
            f,
            "{:.1} s simulated, run entered anew {} times, both stopped alike {} times",
            self.time.as_secs_f64(),
            self.mode_changes,
            self.stops
        )?;
        if self.scans == 0 {
            writeln!(f, "nothing compared")?;
        } else {
            self.coverage_lines(f)?;
        }
        list(f, "cannot be compared", &self.incomparable)?;
        list(f, "rungs of the original that the other program does not have", &self.missing_rungs)?;
        list(f, "rungs left to a person", &self.persons)?;
        if self.not_compared > 0 {
            writeln!(f, "\n{} words depend on these rungs and were not compared", self.not_compared)?;
        }
        let unmapped: Vec<String> = self.unmapped.iter().map(|(what, why)| format!("{what}: {why}")).collect();
        list(f, "without a place on both sides", &unmapped)?;
        list(f, "same behaviour under these conditions only", &self.conditions)?;
        if self.outside > 0 {
            let times = self.outside;
            writeln!(
                f,
                "\n{times} stretches ended where such a condition was not kept: the original stopped with the fault"
            )?;
        }
        let goal = |goal: &Goal| format!("{} {} {}", goal.location, goal.text, goal.kind.as_str());
        let missing: Vec<String> = self.rungs().iter().flat_map(|rung| &rung.missing).map(goal).collect();
        list(f, "not reached", &missing)?;
        let argued: Vec<String> = self
            .impossible_goals()
            .map(|it| format!("{}: {}", goal(it), it.impossible.as_deref().unwrap_or_default()))
            .collect();
        list(f, "cannot be reached", &argued)?;
        list(f, "note", &self.notes)?;
        list(f, "the original is only approximated", &self.approximations[0])?;
        list(f, "the other program is only approximated", &self.approximations[1])?;
        list(f, "not exercised by any run", &NOT_MODELLED.map(str::to_owned))
    }
}

fn list(f: &mut fmt::Formatter<'_>, title: &str, lines: &[String]) -> fmt::Result {
    if lines.is_empty() {
        return Ok(());
    }
    writeln!(f, "\n{title}:")?;
    for line in lines.iter().take(LISTED) {
        writeln!(f, "  {line}")?;
    }
    match lines.len().saturating_sub(LISTED) {
        0 => Ok(()),
        more => writeln!(f, "  and {more} more"),
    }
}
