//! A machine with what is done to it from outside: everything that decides how a run goes on.

use std::collections::BTreeMap;
use std::time::Duration;

use ladder::Value;

use super::change::{Change, ModeChange};
use super::flow::Flow;
use super::subject::Subject;
use crate::plant::Plant;

/// The state of a workbench at one moment. The same state, changes and scans give the same run.
pub struct State {
    /// The machine.
    pub machine: Box<dyn Subject>,
    /// Installed forces, by the names of their points.
    pub forces: BTreeMap<String, bool>,
    /// What the controller is wired to.
    pub plant: Option<Plant>,
    /// What was wrong with the plant in the last scan.
    pub plant_wrong: Option<String>,
    /// No scan since run was entered: the next one passes no time.
    entered: bool,
}

impl State {
    /// A machine without forces.
    pub fn new(machine: Box<dyn Subject>) -> State {
        State { machine, forces: BTreeMap::new(), plant: None, plant_wrong: None, entered: true }
    }

    /// A second state like this.
    pub fn fork(&self) -> State {
        State {
            machine: self.machine.fork(),
            forces: self.forces.clone(),
            plant: self.plant.clone(),
            plant_wrong: self.plant_wrong.clone(),
            entered: self.entered,
        }
    }

    /// About how much memory its plant takes.
    pub fn plant_bytes(&self) -> usize {
        self.plant.as_ref().map_or(0, Plant::bytes)
    }

    /// Makes a change.
    ///
    /// # Errors
    /// Why it cannot be made, in words; nothing has changed then.
    pub fn apply(&mut self, change: &Change) -> Result<(), String> {
        match change {
            Change::Write { address, value } => self.machine.controller_mut().write(address, value)?,
            Change::Force { address, state } => {
                let name = self.machine.force(address, *state)?;
                match state {
                    Some(on) => self.forces.insert(name, *on),
                    None => self.forces.remove(&name),
                };
            }
            Change::EnableForces(on) => self.machine.enable_forces(*on)?,
            Change::Plant(plant) => {
                self.plant = plant.as_deref().cloned();
                self.plant_wrong = None;
            }
            Change::Mode(mode) => {
                match mode {
                    ModeChange::Program => self.machine.controller_mut().enter_program(),
                    ModeChange::Run => self.machine.controller_mut().enter_run(),
                    ModeChange::Test => self.machine.enter_test()?,
                    ModeChange::PowerCycle => self.machine.power_cycle(),
                }
                self.entered = true;
            }
        }
        Ok(())
    }

    /// Lets the plant answer and runs one scan, `usual` after the one before. `None`: the machine does not execute.
    pub fn scan(&mut self, usual: Duration, flow: Option<&mut Flow>) -> Option<Scanned> {
        if !self.machine.controller().is_executing() {
            return None;
        }
        let dt = if self.entered { Duration::ZERO } else { usual };
        self.entered = false;
        let mut written = Vec::new();
        if let Some(plant) = &mut self.plant {
            let stepped = plant.step(dt, self.machine.as_mut());
            self.plant_wrong = stepped.as_ref().err().cloned();
            written = stepped.unwrap_or_default();
        }
        match flow {
            Some(flow) => self.machine.scan_watched(dt, flow),
            None => self.machine.scan(dt),
        }
        Some(Scanned { dt, written })
    }
}

/// What a scan did besides running the program.
pub struct Scanned {
    /// Time that passed before it.
    pub dt: Duration,
    /// What the plant wrote.
    pub written: Vec<(String, Value)>,
}
