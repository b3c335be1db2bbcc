//! What a person or a plant model does to a machine between two scans.

use ladder::Value;

use crate::plant::Plant;

/// A change of a machine that is not a scan.
#[derive(Clone, Debug)]
pub enum Change {
    /// A value was written.
    Write {
        /// Where, as a text of the dialect.
        address: String,
        /// What.
        value: Value,
    },
    /// A force was installed or removed.
    Force {
        /// The bit.
        address: String,
        /// Its state, `None` when removed.
        state: Option<bool>,
    },
    /// All forces were enabled or disabled.
    EnableForces(bool),
    /// Another mode was chosen.
    Mode(ModeChange),
    /// The controller was wired to a plant, or to none.
    Plant(Option<Box<Plant>>),
}

impl Change {
    /// About how much memory it takes.
    pub fn bytes(&self) -> usize {
        let more = match self {
            Change::Write { address, value: Value::Text(text) } => address.len() + text.len(),
            Change::Write { address, .. } | Change::Force { address, .. } => address.len(),
            Change::Plant(plant) => plant.as_ref().map_or(0, |plant| plant.bytes()),
            Change::EnableForces(_) | Change::Mode(_) => 0,
        };
        size_of::<Change>() + more
    }
}

/// A mode a person can choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModeChange {
    /// Does not execute.
    Program,
    /// Executes.
    Run,
    /// Executes, output terminals stay off.
    Test,
    /// Power is lost and comes back.
    PowerCycle,
}

impl ModeChange {
    /// The mode it leads to, as a machine tells it; a power cycle leads to none of its own.
    pub fn name(self) -> Option<&'static str> {
        match self {
            ModeChange::Program => Some("program"),
            ModeChange::Run => Some("run"),
            ModeChange::Test => Some("test"),
            ModeChange::PowerCycle => None,
        }
    }
}
