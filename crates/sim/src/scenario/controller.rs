//! What scenarios are played on: one set of rules for every dialect.

use std::fmt;
use std::time::Duration;

use ladder::{Address, FileType, Place, Value};

use crate::{Machine, outside};

/// A simulated controller of any dialect. Addresses are texts of that dialect.
pub trait Controller {
    /// Leaves run.
    fn enter_program(&mut self);
    /// Goes to run.
    fn enter_run(&mut self);
    /// Time passes, then one scan runs.
    fn scan(&mut self, dt: Duration);
    /// Scans so far.
    fn scans(&self) -> u64;
    /// The program is executed.
    fn is_executing(&self) -> bool;
    /// Simulated time.
    fn now(&self) -> Duration;
    /// Instructions executed so far.
    fn instructions(&self) -> u64;
    /// Why it has stopped by itself.
    fn stopped(&self) -> Option<Stop>;
    /// Indirect addresses that left their file and reached other data.
    fn strays(&self) -> u64 {
        0
    }
    /// The value at an address.
    ///
    /// # Errors
    /// Why there is none, in words.
    fn read(&self, address: &str) -> Result<Value, String>;
    /// Writes a value.
    ///
    /// # Errors
    /// Why it cannot be written, in words.
    fn write(&mut self, address: &str, value: &Value) -> Result<(), String>;
    /// Whether what a step with a mode change sets here is left to that change, instead of being written
    /// once more behind it.
    fn follows_mode(&self, address: &str) -> bool {
        let _ = address;
        false
    }
}

/// Why a controller has stopped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stop {
    /// The code of the fault; 0 where faults of the dialect have none.
    pub code: u16,
    /// In words, with the place.
    pub text: String,
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Controller for Machine {
    fn enter_program(&mut self) {
        Machine::enter_program(self);
    }

    fn enter_run(&mut self) {
        Machine::enter_run(self);
    }

    fn scan(&mut self, dt: Duration) {
        Machine::scan(self, dt);
    }

    fn scans(&self) -> u64 {
        Machine::scans(self)
    }

    fn is_executing(&self) -> bool {
        Machine::is_executing(self)
    }

    fn now(&self) -> Duration {
        Machine::now(self)
    }

    fn instructions(&self) -> u64 {
        Machine::instructions(self)
    }

    fn stopped(&self) -> Option<Stop> {
        self.fault().map(|fault| Stop { code: fault.code, text: fault.to_string() })
    }

    fn strays(&self) -> u64 {
        Machine::strays(self)
    }

    fn read(&self, address: &str) -> Result<Value, String> {
        self.get(&place(self, address)?).map_err(|why| why.to_string())
    }

    fn write(&mut self, address: &str, value: &Value) -> Result<(), String> {
        self.set(&place(self, address)?, value).map_err(|why| why.to_string())
    }

    /// Timers enter run the way the change of mode leaves them, and so does what counters remember of
    /// their rungs: CU and CD.
    fn follows_mode(&self, address: &str) -> bool {
        outside::address(address).is_ok_and(|address| match address.file_type {
            FileType::T => true,
            FileType::C => address.bit.is_some() && matches!(address.member(), Some("CU" | "CD")),
            _ => false,
        })
    }
}

/// The address with what stands in brackets read from the data table.
fn place(machine: &Machine, text: &str) -> Result<Address, String> {
    let mut address = outside::address(text).map_err(|why| why.to_string())?;
    for place in [Some(&mut address.file), Some(&mut address.element), address.bit.as_mut()].into_iter().flatten() {
        if let Place::Indirect(inner) = place {
            let value = machine.get(inner).map_err(|why| why.to_string())?;
            let number = match value {
                Value::Word(word) => u16::try_from(word).ok(),
                Value::Long(long) => u16::try_from(long).ok(),
                _ => None,
            };
            *place = Place::Number(number.ok_or_else(|| format!("[{inner}] holds no place"))?);
        }
    }
    Ok(address)
}
