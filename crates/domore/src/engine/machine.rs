//! A machine: a program with its memory, time and mode.

use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use sim::shared::{nanoseconds, steps};

use super::op::{Compiled, Runs};
use super::run::{Core, Ended};
use super::snapshot::{self, RestoreError};
use super::state::{BlockState, FRESH, State};
use super::watch::{NoWatch, Watch};
use super::{Fault, Mode, Program};
use crate::memory::{ElementType, Kind, NameError, Num, Place, Resolved, Retention};

/// A value as callers see it.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A bit.
    Bit(bool),
    /// A byte, word or double word.
    Integer(i64),
    /// A real.
    Real(f32),
    /// A string.
    Text(String),
}

/// A place of a machine, found once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Handle(Place);

impl Handle {
    /// How the place is read: its type.
    pub fn kind(self) -> Kind {
        self.0.kind
    }
}

/// What one scan did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScanReport {
    /// The mode after it.
    pub mode: Mode,
    /// Instructions it executed.
    pub instructions: u64,
}

/// A simulated controller.
pub struct Machine {
    program: Arc<Compiled>,
    state: State,
}

impl fmt::Debug for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Machine")
            .field("mode", &self.state.mode)
            .field("scans", &self.state.scans)
            .field("fault", &self.state.fault)
            .finish_non_exhaustive()
    }
}

impl Machine {
    /// A controller in program mode with all memory zero.
    pub fn new(program: Program) -> Machine {
        let program = program.compiled;
        let state = State::new(&program);
        let mut machine = Machine { program, state };
        machine.core().show_system(0);
        machine.show_mode();
        machine
    }

    fn core(&mut self) -> Core<'_> {
        Core { p: &self.program, s: &mut self.state }
    }

    /// DST10: 2 stopped, 3 running.
    fn show_mode(&mut self) {
        if let Some(block) = self.program.map.block("DST") {
            let bit = block.start + 320;
            self.state.data.set_dword(bit, if self.state.mode == Mode::Run { 3 } else { 2 });
        }
    }

    /// Goes to run: `$Main` is enabled, the next scan is the first one. Memory stays as it is; a fault
    /// is cleared.
    pub fn enter_run(&mut self) {
        if self.state.mode == Mode::Run {
            return;
        }
        self.state.fault = None;
        self.state.mode = Mode::Run;
        self.state.first = true;
        for (code, state) in self.program.blocks.iter().zip(&mut self.state.blocks) {
            let enabled = matches!(code.runs, Runs::Enabled { from_start: true } | Runs::FirstScan | Runs::Every(_));
            *state = BlockState { enabled, last: self.state.now, ..BlockState::default() };
        }
        self.forget();
        self.show_mode();
    }

    /// What was ON or OFF before is not known any more; timers start anew.
    fn forget(&mut self) {
        self.state.edges.fill(FRESH);
        self.state.values.fill(None);
        self.state.stages.fill(false);
        self.state.timers.iter_mut().for_each(|clock| clock.fresh = true);
    }

    /// Goes to program mode: the termination scan of every program and task, then nothing more is
    /// executed. (help DMD0192)
    pub fn enter_program(&mut self) {
        if self.state.mode == Mode::Program {
            return;
        }
        for index in 0..self.program.blocks.len() {
            let terminates =
                !matches!(self.program.blocks.get(index).map(|block| block.runs), Some(Runs::Called | Runs::Never));
            if terminates {
                self.core().terminate_block(index);
            }
        }
        for state in &mut self.state.blocks {
            *state = BlockState::default();
        }
        self.state.mode = Mode::Program;
        self.show_mode();
    }

    /// Sets the mode.
    pub fn set_mode(&mut self, mode: Mode) {
        match mode {
            Mode::Run => self.enter_run(),
            Mode::Program => self.enter_program(),
        }
    }

    /// Power is lost and comes back: no termination scan, memory that is not retentive is zero, the mode
    /// is the one before. Terminals keep what they carry.
    pub fn power_cycle(&mut self) {
        let blocks: Vec<_> = self.program.map.blocks().to_vec();
        for block in blocks.iter().filter(|block| block.retention == Retention::None) {
            if let Some(bytes) = self.state.data.bytes_mut().get_mut(block.bytes()) {
                bytes.fill(0);
            }
        }
        let stages: Vec<_> = self.program.stages.iter().map(|stage| stage.bit).collect();
        stages.into_iter().for_each(|bit| self.state.data.set_bit(bit, false));
        self.state.phases.fill(Default::default());
        self.state.resets.fill(0);
        self.state.or_outs.fill(0);
        let mode = std::mem::take(&mut self.state.mode);
        self.forget();
        self.show_mode();
        if mode == Mode::Run {
            self.enter_run();
        }
    }

    /// Time passes, then one scan runs: inputs from their terminals, tasks and programs. In program mode only time passes. The first scan after entering
    /// run usually has `dt` 0.
    pub fn scan(&mut self, dt: Duration) -> ScanReport {
        self.scan_watched(dt, &mut NoWatch)
    }

    /// As [`Machine::scan`], telling `watch` what every operation does.
    pub fn scan_watched<W: Watch>(&mut self, dt: Duration, watch: &mut W) -> ScanReport {
        self.advance(dt);
        let before = self.state.executed;
        if self.state.mode == Mode::Run {
            self.state.limit = before.saturating_add(self.program.watchdog);
            let mut core = self.core();
            core.read_inputs();
            core.show_system(nanoseconds(dt));
            if core.all(watch) == Ended::Fault {
                // The machine stops as it stands, so that a person can look at it.
                self.state.mode = Mode::Program;
                self.show_mode();
            }
            self.state.first = false;
        }
        self.state.scans += 1;
        ScanReport { mode: self.state.mode, instructions: self.state.executed - before }
    }

    /// Time passes without a scan.
    pub fn advance(&mut self, dt: Duration) {
        self.state.now = self.state.now.saturating_add(nanoseconds(dt));
    }

    /// Scans of length `step` until `time` has passed, the last one shorter if it does not fit. Ends early
    /// when the machine stops. Returns the number of scans.
    pub fn run_for(&mut self, time: Duration, step: Duration) -> u64 {
        let mut scans = 0;
        for dt in steps(time, step) {
            if self.state.mode != Mode::Run {
                break;
            }
            self.scan(dt);
            scans += 1;
        }
        scans
    }

    /// The mode.
    pub fn mode(&self) -> Mode {
        self.state.mode
    }

    /// Why the machine stopped by itself.
    pub fn fault(&self) -> Option<Fault> {
        self.state.fault
    }

    /// Time since the machine was made.
    pub fn now(&self) -> Duration {
        Duration::from_nanos(self.state.now)
    }

    /// Scans since the machine was made.
    pub fn scans(&self) -> u64 {
        self.state.scans
    }

    /// Instructions executed since the machine was made.
    pub fn instructions(&self) -> u64 {
        self.state.executed
    }

    /// How often an expression had no value or an index or count led out of its block; nothing was
    /// written then.
    pub fn troubles(&self) -> u64 {
        self.state.troubles
    }

    /// Finds an element or nickname.
    ///
    /// # Errors
    /// It stands for nothing, or for no single value.
    pub fn handle(&self, address: &str) -> Result<Handle, NameError> {
        let wrong = |why: &str| NameError { address: address.to_owned(), why: why.to_owned() };
        match self.program.map.resolve_text(address)? {
            Resolved::Place(place) => Ok(Handle(place)),
            Resolved::Constant(_) => Err(wrong("it is a constant")),
            Resolved::Structure(ElementType::Timer | ElementType::Counter, _) => {
                Err(wrong("it is a whole structure: name a member such as .Acc or .Done"))
            }
            Resolved::Structure(..) => Err(wrong("it is a whole structure: name a member")),
            Resolved::Indexed { block, expression } => {
                // An index is evaluated now, so that tests can name what a pointer points at.
                let block = self.program.map.blocks().get(block).ok_or_else(|| wrong("no such block"))?;
                let parsed = crate::address::Address::parse(address).map_err(|error| wrong(&error.to_string()))?;
                let place = crate::math::IndexedPlace::bind(&self.program.map, block, &expression, &parsed);
                let place = place.map_err(|why| wrong(&why))?;
                let found = place.place(&self.state.data, self.program.choices);
                found.map(Handle).map_err(|_| wrong("the index leads out of its block"))
            }
        }
    }

    /// The value of an element, as [`Machine::handle`] finds it.
    ///
    /// # Errors
    /// As [`Machine::handle`].
    pub fn get(&self, address: &str) -> Result<Value, NameError> {
        Ok(self.value(self.handle(address)?))
    }

    /// Writes an element. Numbers are converted only where nothing is lost. An input is written to its terminal and
    /// its image.
    ///
    /// # Errors
    /// As [`Machine::handle`]; the element is read-only, of another sort, or too small for the value.
    pub fn set(&mut self, address: &str, value: &Value) -> Result<(), NameError> {
        let handle = self.handle(address)?;
        self.set_value(handle, value).map_err(|error| NameError { address: address.to_owned(), ..error })
    }

    /// Writes the value at a place; the error names no address.
    ///
    /// # Errors
    /// The element is read-only, of another sort, or too small for the value.
    pub fn set_value(&mut self, handle: Handle, value: &Value) -> Result<(), NameError> {
        let wrong = |why: String| NameError { address: String::new(), why };
        if handle.0.read_only {
            return Err(wrong("it is read-only: an instruction owns it".to_owned()));
        }
        let limits = handle.0.kind.limits();
        let fits = match value {
            Value::Integer(number) => limits.is_none_or(|(least, most)| (least..=most).contains(number)),
            Value::Real(_) if handle.0.kind == Kind::Bit => true,
            Value::Real(number) => limits.is_none_or(|(least, most)| {
                number.fract() == 0.0 && (least as f64..=most as f64).contains(&f64::from(*number))
            }),
            _ => true,
        };
        if !fits {
            return Err(wrong("the value does not fit".to_owned()));
        }
        match (value, handle.0.kind) {
            (Value::Text(text), Kind::Text(most)) => {
                if text.chars().count() > usize::from(most) || !self.state.data.set_text(handle.0, text) {
                    return Err(wrong(format!(
                        "the text has more than {most} characters, or one a string cannot hold"
                    )));
                }
                if let Some(terminal) = self.program.terminal(handle.0) {
                    self.state.terminals.set_text(terminal, text);
                }
            }
            (Value::Text(_), _) | (_, Kind::Text(_)) => {
                return Err(wrong("a string and a number do not mix".to_owned()));
            }
            (Value::Bit(on), _) => self.set_number(handle, Num::Int((*on).into())),
            (Value::Integer(number), _) => self.set_number(handle, Num::Int(*number)),
            (Value::Real(number), _) => self.set_number(handle, Num::Real((*number).into())),
        }
        Ok(())
    }

    /// The value at a place; of an input the image, as the program sees it.
    pub fn value(&self, handle: Handle) -> Value {
        match (handle.0.kind, self.state.data.number(handle.0)) {
            (Kind::Text(_), _) => Value::Text(self.state.data.text(handle.0)),
            (Kind::Bit, number) => Value::Bit(number.is_on()),
            (_, Num::Int(number)) => Value::Integer(number),
            (_, Num::Real(number)) => Value::Real(number as f32),
        }
    }

    /// The number at a place; of a string its length.
    #[inline]
    pub fn number(&self, handle: Handle) -> Num {
        self.state.data.number(handle.0)
    }

    /// Writes a number, converted to the type of the place; of an input to its terminal and its image.
    #[inline]
    pub fn set_number(&mut self, handle: Handle, number: Num) {
        self.state.data.store(handle.0, number, self.program.choices);
        if let Some(terminal) = self.program.terminal(handle.0) {
            self.state.terminals.store(terminal, number, self.program.choices);
        }
        let date = self.program.system.date;
        if (date..date + 64).contains(&handle.0.bit) {
            self.core().take_date();
        }
    }

    /// All memory: what [`crate::memory::Map`] of [`Program::memory`] places.
    pub fn data(&self) -> &crate::memory::Data {
        &self.state.data
    }

    /// A second machine in the same state.
    pub fn fork(&self) -> Machine {
        Machine { program: Arc::clone(&self.program), state: self.state.clone() }
    }

    /// Takes over the state of another machine with the same program, without allocating. `false`: it
    /// runs another program; nothing has changed then.
    pub fn copy_from(&mut self, other: &Machine) -> bool {
        let same = Arc::ptr_eq(&self.program, &other.program);
        if same {
            self.state.copy_from(&other.state);
        }
        same
    }

    /// The whole state as bytes of a stable form.
    pub fn save(&self) -> Vec<u8> {
        snapshot::save(&self.program, &self.state)
    }

    /// Takes over a saved state.
    ///
    /// # Errors
    /// The bytes are no saved state, or one of another program. The machine is unchanged then.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), RestoreError> {
        self.state = snapshot::restore(&self.program, bytes)?;
        Ok(())
    }
}

impl Core<'_> {
    /// Terminals to X, WX and RX.
    fn read_inputs(&mut self) {
        let state = &mut *self.s;
        for input in &self.p.inputs {
            let terminals = state.terminals.bytes().get(input.terminal..input.terminal + input.bytes);
            let image = state.data.bytes_mut().get_mut(input.image..input.image + input.bytes);
            if let (Some(image), Some(terminals)) = (image, terminals) {
                image.copy_from_slice(terminals);
            }
        }
    }

    /// All code blocks of a scan: tasks that are due, then programs in the order of the text.
    fn all<W: Watch>(&mut self, watch: &mut W) -> Ended {
        let p = self.p;
        for (index, block) in p.blocks.iter().enumerate() {
            let due = match block.runs {
                Runs::FirstScan => {
                    let first = self.s.first;
                    if let Some(state) = self.s.blocks.get_mut(index) {
                        state.enabled = first;
                    }
                    true
                }
                Runs::Every(time) => {
                    let now = self.s.now;
                    self.s.blocks.get_mut(index).is_some_and(|state| {
                        let due = now.saturating_sub(state.last) >= time;
                        if due {
                            state.last = now;
                        }
                        due
                    })
                }
                _ => false,
            };
            if due && self.program(index, watch) == Ended::Fault {
                return Ended::Fault;
            }
        }
        for (index, block) in p.blocks.iter().enumerate() {
            if matches!(block.runs, Runs::Enabled { .. }) && self.program(index, watch) == Ended::Fault {
                return Ended::Fault;
            }
        }
        Ended::Done
    }
}
