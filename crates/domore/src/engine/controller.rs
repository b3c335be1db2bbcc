//! The machine as scenarios, traces and workbenches drive it: with values of the program model, like
//! controllers of any dialect.

use std::time::Duration;

use sim::scenario::{Controller, Stop};

use super::{Handle, Machine, Mode, Value};
use crate::memory::Kind;

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
        self.mode() == Mode::Run
    }

    fn now(&self) -> Duration {
        Machine::now(self)
    }

    fn instructions(&self) -> u64 {
        Machine::instructions(self)
    }

    fn stopped(&self) -> Option<Stop> {
        self.fault().map(|fault| Stop { code: 0, text: fault.to_string() })
    }

    fn read(&self, address: &str) -> Result<ladder::Value, String> {
        self.handle(address).map(|handle| self.shown(handle)).map_err(|error| error.why)
    }

    fn write(&mut self, address: &str, value: &ladder::Value) -> Result<(), String> {
        self.set(address, &plain(value)?).map_err(|error| error.why)
    }
}

impl Machine {
    /// Writes a value of the program model at a place.
    ///
    /// # Errors
    /// It is read-only, or of another sort.
    pub fn put_shown(&mut self, handle: Handle, value: &ladder::Value) -> Result<(), String> {
        self.set_value(handle, &plain(value)?).map_err(|error| error.why)
    }

    /// The value at a place as the program model has it. Unsigned words and bytes count from 0: they are shown and
    /// compared as whole numbers.
    pub fn shown(&self, handle: Handle) -> ladder::Value {
        match (self.value(handle), handle.kind()) {
            (Value::Bit(on), _) => ladder::Value::Bit(on),
            (Value::Integer(number), Kind::I16) => ladder::Value::Word(number as i16),
            (Value::Integer(number), _) => ladder::Value::Long(number as i32),
            (Value::Real(number), _) => ladder::Value::Float(number),
            (Value::Text(text), _) => ladder::Value::Text(text),
        }
    }
}

fn plain(value: &ladder::Value) -> Result<Value, String> {
    Ok(match value {
        ladder::Value::Bit(on) => Value::Bit(*on),
        ladder::Value::Word(word) => Value::Integer((*word).into()),
        ladder::Value::Long(long) => Value::Integer((*long).into()),
        ladder::Value::Float(number) => Value::Real(*number),
        ladder::Value::Text(text) => Value::Text(text.clone()),
        _ => return Err("no such value in Do-more".to_owned()),
    })
}
