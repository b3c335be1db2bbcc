//! The machine on the workbench: one interface for every dialect.

use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;

use analysis::proof::{self, AnySide, AnySideMut, Side};
use ladder::{Address, Image, Value};
use sim::scenario::Controller;
use sim::{Mode, PowerFlow, Trace};

use super::flow::Flow;
use super::pair::Pair;

/// A simulated machine that can be copied, watched and forced.
pub trait Subject: Send + Sync {
    /// What every dialect can do.
    fn controller(&self) -> &dyn Controller;
    /// The same, to change it.
    fn controller_mut(&mut self) -> &mut dyn Controller;
    /// The machine as comparisons look at it; `None` for two machines.
    fn side(&self) -> Option<AnySide<'_>>;
    /// The same, to write to it.
    fn side_mut(&mut self) -> Option<AnySideMut<'_>>;
    /// Both machines, where these are two side by side.
    fn pair(&self) -> Option<&Pair> {
        None
    }
    /// The address by which a person's change of this one is made and remembered.
    ///
    /// # Errors
    /// Nobody may change it now, with why.
    fn changeable(&self, address: &str) -> Result<String, String> {
        Ok(address.to_owned())
    }
    /// Whether scans can follow each other after this time.
    ///
    /// # Errors
    /// They cannot, with why.
    fn takes_scan_time(&self, time: Duration) -> Result<(), String> {
        let _ = time;
        Ok(())
    }
    /// A second machine in the same state.
    fn fork(&self) -> Box<dyn Subject>;
    /// Room for its power flow.
    fn flow(&self) -> Flow;
    /// Time passes, then one scan runs, forces applied.
    fn scan(&mut self, dt: Duration);
    /// The same, noting the power flow.
    fn scan_watched(&mut self, dt: Duration, flow: &mut Flow);
    /// The mode in a word: `program`, `run`, `test`, `suspend` or `fault`.
    fn mode(&self) -> &'static str;
    /// Goes to continuous test mode: the program runs, output terminals stay off.
    ///
    /// # Errors
    /// The controller has no such mode.
    fn enter_test(&mut self) -> Result<(), String>;
    /// Power is lost and comes back.
    fn power_cycle(&mut self);
    /// Where the fault stands that has stopped it: routine and rung, of a minor error those that set it.
    fn fault_site(&self) -> Option<(u16, u16)>;
    /// Installs or removes a force; answers the one name that its point has, however the address spells it.
    ///
    /// # Errors
    /// The address cannot be forced.
    fn force(&mut self, address: &str, state: Option<bool>) -> Result<String, String>;
    /// Enables or disables all forces.
    ///
    /// # Errors
    /// The controller has no forces.
    fn enable_forces(&mut self, on: bool) -> Result<(), String>;
    /// Installed forces act.
    fn forces_enabled(&self) -> bool;
    /// What a recording can say of a force of this point, as [`Subject::force`] names it.
    fn point(&self, name: &str) -> Point;
    /// What an output terminal carries, forces applied; `None` for an address that is no output.
    fn terminal(&self, address: &str) -> Option<Value>;
}

/// A point that can be forced.
#[derive(Clone, Debug, PartialEq)]
pub enum Point {
    /// An input, and what its terminal carries: forced, the program reads what it would read if that were written.
    Input(Value),
    /// An output whose force the program does not see.
    Output,
    /// An output whose force the program reads back.
    ReadBack,
}

/// An SLC 500 or MicroLogix machine.
pub struct Slc {
    side: proof::Slc,
    /// Instructions of the rungs of each program file.
    shape: Arc<Vec<(u16, Vec<usize>)>>,
    /// Input and output bits by their places: as the program spells them, or else as its data tables do.
    points: Arc<HashMap<u32, String>>,
}

impl Slc {
    /// The machine of an image, in program mode.
    pub fn new(machine: sim::Machine, image: &Image) -> Slc {
        let rungs = |file: &ladder::ProgramFile| file.rungs.iter().map(|rung| rung.instructions().count()).collect();
        let shape = image.ladder_files().map(|file| (file.number, rungs(file))).collect();
        let points = Arc::new(points(&machine, image));
        Slc { side: proof::Slc { machine }, shape: Arc::new(shape), points }
    }
}

impl Slc {
    /// The machine as comparisons look at it.
    pub fn as_side(&self) -> &proof::Slc {
        &self.side
    }

    /// A second machine in the same state.
    pub(super) fn copy(&self) -> Slc {
        Slc { side: self.side.fork(), shape: Arc::clone(&self.shape), points: Arc::clone(&self.points) }
    }
}

fn points(machine: &sim::Machine, image: &Image) -> HashMap<u32, String> {
    let mut points = HashMap::new();
    let mut name = |address: &Address| {
        if address.file_type.has_slots()
            && let Ok((place, sim::Kind::Bit)) = machine.place(address)
        {
            points.entry(place).or_insert_with(|| address.to_string());
        }
    };
    let rungs = image.ladder_files().flat_map(|file| &file.rungs);
    rungs
        .flat_map(|rung| rung.instructions())
        .flat_map(|it| &it.operands)
        .filter_map(ladder::Operand::address)
        .for_each(&mut name);
    for file in image.data_files.iter().filter(|file| file.file_type.has_slots()) {
        for word in 0..u16::try_from(file.words.len()).unwrap_or(u16::MAX) {
            let Some(word) = image.io.address_of(file.file_type, word) else { continue };
            (0..16).for_each(|bit| name(&word.clone().with_bit(bit)));
        }
    }
    points
}

impl Subject for Slc {
    fn side(&self) -> Option<AnySide<'_>> {
        Some(AnySide::Slc(&self.side))
    }

    fn side_mut(&mut self) -> Option<AnySideMut<'_>> {
        Some(AnySideMut::Slc(&mut self.side))
    }

    fn controller(&self) -> &dyn Controller {
        &self.side.machine
    }

    fn controller_mut(&mut self) -> &mut dyn Controller {
        &mut self.side.machine
    }

    fn fork(&self) -> Box<dyn Subject> {
        Box::new(self.copy())
    }

    fn flow(&self) -> Flow {
        Flow::new(self.shape.iter().cloned())
    }

    fn scan(&mut self, dt: Duration) {
        self.side.machine.scan(dt);
    }

    fn scan_watched(&mut self, dt: Duration, flow: &mut Flow) {
        flow.begin();
        self.side.machine.scan_traced(dt, &mut Watching(flow));
    }

    fn mode(&self) -> &'static str {
        match self.side.machine.mode() {
            Mode::Program => "program",
            Mode::Run => "run",
            Mode::Test => "test",
            Mode::Suspend => "suspend",
            Mode::Fault => "fault",
        }
    }

    fn enter_test(&mut self) -> Result<(), String> {
        self.side.machine.enter_test();
        Ok(())
    }

    /// The data table is kept; a controller that ran runs again, with prescan and first pass.
    fn power_cycle(&mut self) {
        let mode = self.side.machine.mode();
        self.side.machine.enter_program();
        match mode {
            Mode::Run => self.side.machine.enter_run(),
            Mode::Test => self.side.machine.enter_test(),
            Mode::Program | Mode::Suspend | Mode::Fault => {}
        }
    }

    fn fault_site(&self) -> Option<(u16, u16)> {
        self.side.machine.fault().map(|fault| fault.place())
    }

    fn force(&mut self, address: &str, state: Option<bool>) -> Result<String, String> {
        let parsed = Address::parse(address).map_err(|why| why.to_string())?;
        let name = self.side.machine.place(&parsed).ok().and_then(|(place, _)| self.points.get(&place));
        match self.side.machine.force(&parsed, state) {
            true => Ok(name.cloned().unwrap_or_else(|| parsed.to_string())),
            false => Err(format!("{address} is no input or output bit: only those can be forced")),
        }
    }

    fn enable_forces(&mut self, on: bool) -> Result<(), String> {
        self.side.machine.enable_forces(on);
        Ok(())
    }

    /// S:1/5.
    fn forces_enabled(&self) -> bool {
        let enabled = Address::parse("S:1/5").ok().and_then(|address| self.side.machine.get(&address).ok());
        enabled == Some(Value::Bit(true))
    }

    fn point(&self, name: &str) -> Point {
        let input = Address::parse(name).ok().and_then(|address| self.side.machine.input(&address));
        input.map_or(Point::Output, Point::Input)
    }

    fn terminal(&self, address: &str) -> Option<Value> {
        self.side.machine.output(&Address::parse(address).ok()?)
    }
}

struct Watching<'a>(&'a mut Flow);

impl Trace for Watching<'_> {
    fn wants(&self, _: u16, _: u16) -> bool {
        true
    }

    fn flow(&mut self, flow: PowerFlow) {
        self.0.saw(flow.file, flow.rung, flow.instruction, flow.before, flow.after);
    }
}
