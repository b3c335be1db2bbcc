//! What stands around the controller: a simple model that answers outputs with inputs.
//!
//! A plant file names motors, tanks, conveyors and heaters with the addresses they are wired to:
//!
//! ```toml
//! [[motor]]
//! name        = "pump"
//! run         = "O:0.0/0"
//! feedback    = "I:0.0/1"
//! start_delay = "800ms"
//!
//! [[tank]]
//! name  = "sump"
//! level = "I:0.4"                      # written as a number from 0 to `range`
//! range = 4095
//! start = 40.0                         # percent
//! flows = [ { rate = 3.0 }, { when = "O:0.0/0", rate = -8.0 } ]      # percent per second
//! switches = [ { at = 80.0, input = "I:0.0/2" }, { at = 20.0, input = "I:0.0/3" } ]
//! ```
//!
//! Before every scan the model reads output terminals (or any other bit), lets the time of the scan pass and
//! writes inputs. It is plain arithmetic: the same scans give the same plant on any machine.

mod conveyor;
mod heater;
mod motor;
mod tank;

use std::time::Duration;

use ladder::Value;
use serde::{Deserialize, Deserializer, de::Error as _};
use sim::scenario::{Literal, parse_duration, value_for};

use crate::workbench::Subject;

/// Elements of one plant, of all kinds.
const ELEMENTS: usize = 1000;

/// A model of what the controller is wired to, with its state.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plant {
    /// What it is called.
    #[serde(default)]
    pub name: String,
    #[serde(default)]
    motor: Vec<motor::Motor>,
    #[serde(default)]
    tank: Vec<tank::Tank>,
    #[serde(default)]
    conveyor: Vec<conveyor::Conveyor>,
    #[serde(default)]
    heater: Vec<heater::Heater>,
    /// Length of the text it was read from.
    #[serde(skip)]
    text: usize,
}

/// One element of a plant.
trait Element {
    /// Name in the plant file.
    fn name(&self) -> &str;
    /// Whether its figures make sense; what is wrong, otherwise.
    fn check(&self) -> Result<(), String>;
    /// Time passes; inputs are written.
    fn step(&mut self, seconds: f64, wires: &mut Wires<'_>);
    /// What a person sees: name of a quantity, its value, its unit.
    fn shown(&self) -> Vec<(String, f64, &'static str)>;
}

/// What one element shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Gauge {
    /// Element it belongs to.
    pub element: String,
    /// What it is.
    pub quantity: String,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
}

/// The terminals, as a plant sees them. The first thing that goes wrong is kept.
pub(crate) struct Wires<'a> {
    machine: &'a mut dyn Subject,
    written: Vec<(String, Value)>,
    wrong: Option<String>,
}

impl Wires<'_> {
    fn keep(&mut self, why: String) {
        self.wrong.get_or_insert(why);
    }

    /// What stands at an address: for outputs the terminal, which is off while the controller does not run.
    fn read(&mut self, address: &str) -> Option<Value> {
        if let Some(value) = self.machine.terminal(address) {
            return Some(value);
        }
        match self.machine.controller().read(address) {
            Ok(value) => Some(value),
            Err(why) => {
                self.keep(format!("{address}: {why}"));
                None
            }
        }
    }

    /// A bit is on.
    fn is_on(&mut self, address: &str) -> bool {
        match self.read(address) {
            Some(Value::Bit(on)) => on,
            Some(_) => {
                self.keep(format!("{address}: expected a bit"));
                false
            }
            None => false,
        }
    }

    /// Writes a value where it is another one; numbers that do not fit stop at the end of their range.
    fn write(&mut self, address: &str, number: f64) {
        let Ok(present) = self.machine.controller().read(address).map_err(|why| self.keep(format!("{address}: {why}")))
        else {
            return;
        };
        let whole = |least: f64, most: f64| Literal::Integer(number.round().clamp(least, most) as i64);
        let literal = match present {
            Value::Bit(_) => Literal::Integer(i64::from(number != 0.0)),
            Value::Word(_) => whole(f64::from(i16::MIN), f64::from(i16::MAX)),
            Value::Long(_) => whole(f64::from(i32::MIN), f64::from(i32::MAX)),
            _ => Literal::Float(number),
        };
        let value = value_for(&literal, &present).map_err(|why| format!("{address}: {why}"));
        let done = value.and_then(|value| {
            if value != present {
                let written = self.machine.controller_mut().write(address, &value);
                written.map_err(|why| format!("{address}: {why}"))?;
                self.written.push((address.to_owned(), value));
            }
            Ok(())
        });
        if let Err(why) = done {
            self.keep(why);
        }
    }
}

impl Plant {
    /// Reads a plant file.
    ///
    /// # Errors
    /// The line and key that are wrong, or a figure without sense.
    pub fn parse(text: &str) -> Result<Plant, String> {
        let mut plant: Plant = toml::from_str(text).map_err(|error| error.to_string().trim_end().to_owned())?;
        plant.text = text.len();
        let count = plant.elements().count();
        if count > ELEMENTS {
            return Err(format!("expected at most {ELEMENTS} elements, found {count}"));
        }
        for element in plant.elements() {
            element.check().map_err(|why| format!("{}: {why}", element.name()))?;
        }
        Ok(plant)
    }

    /// About how much memory it takes: a key of a few characters becomes a number of eight bytes.
    pub fn bytes(&self) -> usize {
        size_of::<Plant>() + 8 * self.text
    }

    fn elements(&self) -> impl Iterator<Item = &dyn Element> {
        fn all<T: Element>(list: &[T]) -> impl Iterator<Item = &dyn Element> {
            list.iter().map(|element| element as &dyn Element)
        }
        all(&self.motor).chain(all(&self.tank)).chain(all(&self.conveyor)).chain(all(&self.heater))
    }

    /// Lets time pass and writes inputs of a machine; answers what was written.
    ///
    /// # Errors
    /// An address does not exist or holds something else; the other elements have been stepped.
    pub fn step(&mut self, time: Duration, machine: &mut dyn Subject) -> Result<Vec<(String, Value)>, String> {
        let seconds = time.as_secs_f64();
        let mut wires = Wires { machine, written: Vec::new(), wrong: None };
        self.motor.iter_mut().for_each(|motor| motor.step(seconds, &mut wires));
        self.tank.iter_mut().for_each(|tank| tank.step(seconds, &mut wires));
        self.conveyor.iter_mut().for_each(|conveyor| conveyor.step(seconds, &mut wires));
        self.heater.iter_mut().for_each(|heater| heater.step(seconds, &mut wires));
        match wires.wrong {
            Some(why) => Err(why),
            None => Ok(wires.written),
        }
    }

    /// What a person sees of it.
    pub fn gauges(&self) -> Vec<Gauge> {
        let gauges = |element: &dyn Element| {
            let name = element.name().to_owned();
            let all = element.shown().into_iter();
            all.map(|(quantity, value, unit)| Gauge { element: name.clone(), quantity, value, unit })
                .collect::<Vec<_>>()
        };
        self.elements().flat_map(gauges).collect()
    }
}

/// A time such as `800ms`, in seconds.
fn seconds<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    let text = String::deserialize(deserializer)?;
    parse_duration(&text).map(|time| time.as_secs_f64()).map_err(D::Error::custom)
}

/// `what` must be a number within limits.
fn within(what: &str, number: f64, least: f64, most: f64) -> Result<(), String> {
    match (least..=most).contains(&number) {
        true => Ok(()),
        false => Err(format!("{what}: expected from {least} to {most}, found {number}")),
    }
}
