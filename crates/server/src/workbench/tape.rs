//! A tape: what a scenario does, scan by scan, for stepping through it forwards and back.

use std::time::Duration;

use sim::scenario::{Assignment, Length, Literal, Scenario, Step, Target, value_for};

use super::change::{Change, ModeChange};
use super::pair::OTHER;
use super::subject::Subject;

/// Scans of a tape; a counterexample has some tens, rarely thousands.
const SCANS: usize = 200_000;

/// Scans of a scenario, each with what is done before it.
#[derive(Clone, Debug, Default)]
pub struct Tape {
    name: String,
    scans: Vec<TapeScan>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct TapeScan {
    pub(super) changes: Vec<Change>,
    pub(super) dt: Duration,
}

impl Tape {
    /// Reads a scenario for this machine, which holds the data of its project. Of two machines side by side it can be
    /// a scenario of either one. Expectations are left to whoever looks.
    ///
    /// # Errors
    /// Why the text cannot be played, with its line.
    pub fn read(text: &str, machine: &dyn Subject) -> Result<Tape, String> {
        let scenario = Scenario::parse(text).map_err(|why| why.to_string())?;
        let other = machine.pair().is_some_and(|pair| pair.other().side().is_some_and(is_do_more));
        let prefix = if other && scenario.target == Some(Target::DoMore) { OTHER } else { "" };
        let mut reader = Reader { machine, prefix, scans: Vec::new(), pending: Vec::new(), dt: scenario.scan };
        for (number, step) in (0..).zip(&scenario.steps) {
            reader.step(number == 0, step)?;
        }
        match reader.scans.is_empty() {
            true => Err("the scenario has no scan".to_owned()),
            false => Ok(Tape { name: scenario.name, scans: reader.scans }),
        }
    }

    /// What the scenario shows.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// How many scans it has.
    pub fn scans(&self) -> u64 {
        self.scans.len() as u64
    }

    pub(super) fn get(&self, scan: u64) -> Option<&TapeScan> {
        self.scans.get(usize::try_from(scan).ok()?)
    }
}

fn is_do_more(side: analysis::proof::AnySide<'_>) -> bool {
    matches!(side, analysis::proof::AnySide::DoMore(_))
}

struct Reader<'m> {
    machine: &'m dyn Subject,
    prefix: &'static str,
    scans: Vec<TapeScan>,
    /// Changes before the next scan.
    pending: Vec<Change>,
    dt: Duration,
}

impl Reader<'_> {
    /// The order of changes is that of a scenario's player: what is set with a change of mode is there when run is
    /// entered, and once more behind it.
    fn step(&mut self, first: bool, step: &Step) -> Result<(), String> {
        let sets = step.set.iter().map(|set| self.write(set)).collect::<Result<Vec<_>, _>>()?;
        let entered = first || step.program_run;
        if step.program_run {
            self.pending.push(Change::Mode(ModeChange::Program));
        }
        if entered {
            self.pending.extend(sets.iter().cloned());
            self.pending.push(Change::Mode(ModeChange::Run));
        }
        let stays = |set: &Change| match set {
            Change::Write { address, .. } => step.program_run && self.machine.controller().follows_mode(address),
            _ => false,
        };
        let again: Vec<_> = sets.into_iter().filter(|set| !stays(set)).collect();
        self.pending.extend(again);
        let dt = step.scan.unwrap_or(self.dt);
        self.machine.takes_scan_time(dt).map_err(|why| format!("line {}: {why}", step.line))?;
        if let Some(edges) = &step.edges {
            for level in (0..edges.count).flat_map(|_| [0, 1]) {
                let value = Literal::Integer(level);
                let change = self.write(&Assignment { address: edges.bit.clone(), value })?;
                self.pending.push(change);
                self.scan(dt)?;
            }
        }
        match step.length {
            Length::None => {}
            Length::Scans(count) => (0..count).try_for_each(|_| self.scan(dt))?,
            Length::For(time) => {
                let mut passed = Duration::ZERO;
                while passed < time {
                    // The first scan of run passes no time.
                    passed += if self.enters() { Duration::ZERO } else { dt };
                    self.scan(dt)?;
                }
            }
        }
        Ok(())
    }

    /// Run is entered before the next scan.
    fn enters(&self) -> bool {
        self.pending.iter().any(|change| matches!(change, Change::Mode(ModeChange::Run)))
    }

    fn scan(&mut self, dt: Duration) -> Result<(), String> {
        if self.scans.len() == SCANS {
            return Err(format!("expected at most {SCANS} scans, found more"));
        }
        self.scans.push(TapeScan { changes: std::mem::take(&mut self.pending), dt });
        Ok(())
    }

    fn write(&self, set: &Assignment) -> Result<Change, String> {
        let named = |why| format!("line {}: {}: {why}", set.address.line, set.address.value);
        let address = format!("{}{}", self.prefix, set.address.value);
        let present = self.machine.controller().read(&address).map_err(named)?;
        let value = value_for(&set.value, &present).map_err(named)?;
        if let Some(pair) = self.machine.pair() {
            // Both machines must have it, or the tape would be another one on each side.
            let own = pair.own(&address).map_err(named)?;
            pair.spelled(&own).map_err(named)?;
            return Ok(Change::Write { address: own, value });
        }
        Ok(Change::Write { address, value })
    }
}
