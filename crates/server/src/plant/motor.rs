//! A motor whose feedback follows its contactor late.

use serde::Deserialize;

use super::{Element, Wires, seconds};

/// A motor with a feedback contact.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Motor {
    name: String,
    /// Bit that runs it.
    run: String,
    /// Bit that says that it runs.
    feedback: String,
    /// From `run` on to feedback on.
    #[serde(default, deserialize_with = "seconds")]
    start_delay: f64,
    /// From `run` off to feedback off.
    #[serde(default, deserialize_with = "seconds")]
    stop_delay: f64,
    /// Bit that keeps it from running while on, such as a tripped overload made by hand.
    blocked: Option<String>,
    #[serde(skip)]
    runs: bool,
    /// Seconds since the contactor and the feedback differ.
    #[serde(skip)]
    waited: f64,
}

impl Element for Motor {
    fn name(&self) -> &str {
        &self.name
    }

    fn check(&self) -> Result<(), String> {
        Ok(())
    }

    fn step(&mut self, seconds: f64, wires: &mut Wires<'_>) {
        let blocked = self.blocked.as_ref().is_some_and(|bit| wires.is_on(bit));
        let wanted = wires.is_on(&self.run) && !blocked;
        if wanted == self.runs {
            self.waited = 0.0;
        } else {
            self.waited += seconds;
            let delay = if wanted { self.start_delay } else { self.stop_delay };
            if self.waited >= delay {
                self.runs = wanted;
                self.waited = 0.0;
            }
        }
        wires.write(&self.feedback, f64::from(u8::from(self.runs)));
    }

    fn shown(&self) -> Vec<(String, f64, &'static str)> {
        vec![("runs".to_owned(), f64::from(u8::from(self.runs)), "")]
    }
}
