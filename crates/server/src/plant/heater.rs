//! A body that is heated and cools down towards its surroundings.

use serde::Deserialize;

use super::{Element, Wires, within};

/// A heated body. Temperatures are degrees.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Heater {
    name: String,
    /// Bit that heats.
    on: String,
    /// Address the temperature is written to.
    temperature: String,
    /// The number written is the temperature times this.
    #[serde(default = "one")]
    scale: f64,
    /// Temperature at the start and around.
    #[serde(default = "room")]
    ambient: f64,
    /// Degrees per second while heating.
    rate: f64,
    /// Share of the difference to `ambient` that is lost per second.
    #[serde(default)]
    loss: f64,
    #[serde(skip)]
    above: f64,
}

fn one() -> f64 {
    1.0
}

fn room() -> f64 {
    20.0
}

impl Element for Heater {
    fn name(&self) -> &str {
        &self.name
    }

    fn check(&self) -> Result<(), String> {
        within("rate", self.rate, -1e6, 1e6)?;
        within("loss", self.loss, 0.0, 1.0)?;
        within("scale", self.scale, -1e6, 1e6)?;
        within("ambient", self.ambient, -1e6, 1e6)
    }

    fn step(&mut self, seconds: f64, wires: &mut Wires<'_>) {
        let heat = if wires.is_on(&self.on) { self.rate } else { 0.0 };
        self.above += heat * seconds;
        // Backward step: stable however long the scan.
        self.above /= 1.0 + self.loss * seconds;
        wires.write(&self.temperature, (self.ambient + self.above) * self.scale);
    }

    fn shown(&self) -> Vec<(String, f64, &'static str)> {
        vec![("temperature".to_owned(), self.ambient + self.above, "°")]
    }
}
