//! A tank that fills and empties, with level switches and an analog level.

use serde::Deserialize;

use super::{Element, Wires, within};

/// A tank. Levels are percent.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Tank {
    name: String,
    /// Address the level is written to, as a number from 0 to `range`.
    level: Option<String>,
    /// The number that stands for 100 %.
    #[serde(default = "full")]
    range: f64,
    /// Level at the start.
    #[serde(default, rename = "start")]
    now: f64,
    #[serde(default)]
    flows: Vec<Flow>,
    #[serde(default)]
    switches: Vec<Switch>,
}

/// A pipe.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Flow {
    /// Bit that opens it; none: always open.
    when: Option<String>,
    /// Percent per second, negative out of the tank.
    rate: f64,
}

/// A level switch.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Switch {
    /// Level it switches at.
    at: f64,
    /// How far the level must go back for it to switch off.
    #[serde(default)]
    hysteresis: f64,
    /// Bit it is wired to, on from this level upwards.
    input: String,
    /// On below the level instead.
    #[serde(default)]
    inverted: bool,
    #[serde(skip)]
    wet: bool,
}

fn full() -> f64 {
    100.0
}

impl Element for Tank {
    fn name(&self) -> &str {
        &self.name
    }

    fn check(&self) -> Result<(), String> {
        within("start", self.now, 0.0, 100.0)?;
        within("range", self.range, 1.0, 1e9)?;
        self.flows.iter().try_for_each(|flow| within("rate", flow.rate, -1e6, 1e6))?;
        self.switches.iter().try_for_each(|switch| {
            within("at", switch.at, 0.0, 100.0)?;
            within("hysteresis", switch.hysteresis, 0.0, 100.0)
        })
    }

    fn step(&mut self, seconds: f64, wires: &mut Wires<'_>) {
        let rate: f64 = self
            .flows
            .iter()
            .filter(|flow| flow.when.as_ref().is_none_or(|bit| wires.is_on(bit)))
            .map(|flow| flow.rate)
            .sum();
        self.now = (self.now + rate * seconds).clamp(0.0, 100.0);
        if let Some(level) = &self.level {
            wires.write(level, self.now / 100.0 * self.range);
        }
        for switch in &mut self.switches {
            let threshold = if switch.wet { switch.at - switch.hysteresis } else { switch.at };
            switch.wet = self.now >= threshold;
            wires.write(&switch.input, f64::from(u8::from(switch.wet != switch.inverted)));
        }
    }

    fn shown(&self) -> Vec<(String, f64, &'static str)> {
        vec![("level".to_owned(), self.now, "%")]
    }
}
