//! A conveyor that carries parts past sensors.

use std::collections::VecDeque;

use serde::Deserialize;

use super::{Element, Wires, seconds, within};

/// Parts on one conveyor.
const PARTS: usize = 1000;

/// A conveyor. Lengths are metres.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Conveyor {
    name: String,
    /// Bit that runs it.
    run: String,
    /// Bit that runs it backwards.
    reverse: Option<String>,
    length: f64,
    /// Metres per second.
    speed: f64,
    /// Length of a part.
    #[serde(default = "part")]
    part: f64,
    /// A part is put on so often while it runs; none: by `feed` only.
    #[serde(default, deserialize_with = "seconds")]
    every: f64,
    /// Bit that puts a part on when it comes on.
    feed: Option<String>,
    #[serde(default)]
    sensors: Vec<Sensor>,
    /// Front ends of the parts, the oldest first.
    #[serde(skip)]
    parts: VecDeque<f64>,
    /// Seconds run since the last part was put on.
    #[serde(skip)]
    since: f64,
    #[serde(skip)]
    fed: bool,
    #[serde(skip)]
    left: u64,
}

/// A light barrier.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Sensor {
    /// From the beginning.
    at: f64,
    /// Bit that is on while a part is there.
    input: String,
}

fn part() -> f64 {
    0.2
}

impl Element for Conveyor {
    fn name(&self) -> &str {
        &self.name
    }

    fn check(&self) -> Result<(), String> {
        within("length", self.length, 0.001, 1e6)?;
        within("speed", self.speed, 0.0, 1e6)?;
        within("part", self.part, 0.0, self.length)?;
        self.sensors.iter().try_for_each(|sensor| within("at", sensor.at, 0.0, self.length))
    }

    fn step(&mut self, seconds: f64, wires: &mut Wires<'_>) {
        let forwards = wires.is_on(&self.run);
        let backwards = self.reverse.as_ref().is_some_and(|bit| wires.is_on(bit));
        let metres = f64::from(i8::from(forwards) - i8::from(backwards)) * self.speed * seconds;
        self.parts.iter_mut().for_each(|front| *front += metres);
        let end = self.length + self.part;
        let before = self.parts.len();
        self.parts.retain(|front| (0.0..=end).contains(front));
        self.left += (before - self.parts.len()) as u64;
        if metres > 0.0 && self.every > 0.0 {
            self.since += seconds;
            if self.since >= self.every {
                self.since -= self.every;
                self.put_on();
            }
        }
        if let Some(feed) = &self.feed {
            let on = wires.is_on(feed);
            if on && !self.fed {
                self.put_on();
            }
            self.fed = on;
        }
        for sensor in &self.sensors {
            let there = self.parts.iter().any(|front| *front >= sensor.at && *front - self.part <= sensor.at);
            wires.write(&sensor.input, f64::from(u8::from(there)));
        }
    }

    fn shown(&self) -> Vec<(String, f64, &'static str)> {
        vec![("parts".to_owned(), self.parts.len() as f64, ""), ("gone".to_owned(), self.left as f64, "")]
    }
}

impl Conveyor {
    fn put_on(&mut self) {
        if self.parts.len() < PARTS {
            self.parts.push_back(0.0);
        }
    }
}
