//! Two machines in lock step: an original and what was made of it, with the same inputs, the same time and the same
//! scans, compared after every scan as a proof compares them.

use std::sync::Arc;
use std::time::Duration;

use analysis::proof::{AnySide, AnySideMut, Difference, Mapping, Pairing, RungFate};
use ladder::{Address, FileType, Image, Value};
use sim::scenario::{Controller, Stop};

use super::flow::Flow;
use super::subject::{Point, Slc, Subject};

/// An address that begins so is the other program's; all else is the original's.
pub const OTHER: &str = "other:";

/// The original and the other program. Where one of them does not execute, none is scanned.
pub struct Pair {
    a: Slc,
    b: Box<dyn Subject>,
    pairing: Arc<Pairing>,
    other_flow: Flow,
    first: Option<Arc<First>>,
}

/// The first difference of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct First {
    /// Scans up to it, that scan included.
    pub scan: u64,
    /// Simulated time.
    pub time: Duration,
    /// What differs, in the words of a proof.
    pub what: String,
    /// Address of the original and of the other program, where it is a value.
    pub addresses: Option<(String, String)>,
}

impl Pair {
    /// Puts two machines that have not run side by side, made to begin alike. `fates` is what the migration says of
    /// the rungs of the original ([`analysis::proof::fates`]).
    ///
    /// # Errors
    /// What makes them begin alike cannot be written.
    pub fn new(
        image: &Image,
        mut a: Slc,
        mut b: Box<dyn Subject>,
        map: &[Mapping],
        fates: Option<&[RungFate]>,
    ) -> Result<Pair, String> {
        let side = b.side().ok_or("the other program is itself a pair")?;
        let pairing = Pairing::new(image, a.as_side(), side, map, fates);
        // Forces saved with the original have no counterpart.
        a.enable_forces(false)?;
        for (original, other, value) in pairing.start() {
            a.controller_mut().write(original, value)?;
            pairing.write(b.side_mut().ok_or("no machine")?, other, value)?;
        }
        let other_flow = b.flow();
        Ok(Pair { a, b, pairing: Arc::new(pairing), other_flow, first: None })
    }

    /// What belongs together.
    pub fn pairing(&self) -> &Arc<Pairing> {
        &self.pairing
    }

    /// The other machine.
    pub fn other(&self) -> &dyn Subject {
        self.b.as_ref()
    }

    /// Power flow of the other program in the last scan that was watched.
    pub fn other_flow(&self) -> &Flow {
        &self.other_flow
    }

    /// The first difference since both began.
    pub fn first(&self) -> Option<&First> {
        self.first.as_deref()
    }

    /// Numbers of the rows of the pairing that differ now. Before the first scan a converted program has not stored
    /// its initial values: nothing is compared then.
    pub fn differing(&self) -> Vec<u32> {
        match (self.a.controller().scans(), self.b.side()) {
            (0, _) | (_, None) => Vec::new(),
            (_, Some(b)) => self.pairing.differing(self.a.as_side(), b),
        }
    }

    /// The values of a row on both sides.
    pub fn values(&self, row: usize) -> Option<[Value; 2]> {
        self.pairing.values(row, self.a.as_side(), self.b.side()?)
    }

    /// The original stopped where a stated condition is not kept: what follows is no difference.
    pub fn has_left_conditions(&self) -> bool {
        self.b.side().is_some_and(|b| self.pairing.has_left_conditions(self.a.as_side(), b))
    }

    /// How the other program spells an address of the original.
    ///
    /// # Errors
    /// It has no place there.
    pub fn spelled(&self, original: &str) -> Result<String, String> {
        self.pairing.other(self.a.as_side(), original)
    }

    fn is_converted(&self) -> bool {
        matches!(self.b.side(), Some(AnySide::DoMore(_)))
    }

    /// The address of the original that an address of either program means.
    ///
    /// # Errors
    /// It is the other program's alone.
    pub fn own(&self, address: &str) -> Result<String, String> {
        match (address.strip_prefix(OTHER), self.b.side()) {
            (Some(other), Some(b)) => {
                let why = |why| format!("{why}: a change of one program alone would be no comparison");
                self.pairing.original(self.a.as_side(), b, other).map_err(why)
            }
            _ => Ok(address.to_owned()),
        }
    }

    fn look(&mut self) {
        if self.first.is_some() {
            return;
        }
        let Some(b) = self.b.side() else { return };
        let Some(found) = self.pairing.compare(self.a.as_side(), b) else { return };
        let addresses = match &found {
            Difference::Value(it) => Some((it.original.clone(), it.other.clone())),
            Difference::OriginalStopped(..) | Difference::OtherStopped(_) => None,
        };
        let (scan, time) = (self.a.controller().scans(), self.a.controller().now());
        self.first = Some(Arc::new(First { scan, time, what: found.to_string(), addresses }));
    }
}

impl Controller for Pair {
    fn enter_program(&mut self) {
        self.a.controller_mut().enter_program();
        self.b.controller_mut().enter_program();
    }

    fn enter_run(&mut self) {
        self.a.controller_mut().enter_run();
        self.b.controller_mut().enter_run();
    }

    fn scan(&mut self, dt: Duration) {
        Subject::scan(self, dt);
    }

    fn scans(&self) -> u64 {
        self.a.controller().scans()
    }

    fn is_executing(&self) -> bool {
        self.a.controller().is_executing() && self.b.controller().is_executing()
    }

    fn now(&self) -> Duration {
        self.a.controller().now()
    }

    fn instructions(&self) -> u64 {
        self.a.controller().instructions().saturating_add(self.b.controller().instructions())
    }

    fn stopped(&self) -> Option<Stop> {
        let other = || {
            let stop = self.b.controller().stopped()?;
            Some(Stop { text: format!("the other program: {}", stop.text), ..stop })
        };
        self.a.controller().stopped().or_else(other)
    }

    fn strays(&self) -> u64 {
        self.a.controller().strays()
    }

    fn read(&self, address: &str) -> Result<Value, String> {
        match address.strip_prefix(OTHER) {
            Some(other) => self.b.controller().read(other),
            None => self.a.controller().read(address),
        }
    }

    /// Writes on both sides, or on none.
    fn write(&mut self, address: &str, value: &Value) -> Result<(), String> {
        let own = self.own(address)?;
        let other = self.spelled(&own)?;
        let before = self.a.controller().read(&own)?;
        self.a.controller_mut().write(&own, value)?;
        let written = match value {
            Value::Text(_) => self.b.controller_mut().write(&other, value),
            _ => self.b.side_mut().ok_or("no machine".to_owned()).and_then(|b| self.pairing.write(b, &other, value)),
        };
        if written.is_err() {
            self.a.controller_mut().write(&own, &before)?;
        }
        written
    }

    fn follows_mode(&self, address: &str) -> bool {
        self.a.controller().follows_mode(address)
    }
}

impl Subject for Pair {
    fn controller(&self) -> &dyn Controller {
        self
    }

    fn controller_mut(&mut self) -> &mut dyn Controller {
        self
    }

    fn side(&self) -> Option<AnySide<'_>> {
        None
    }

    fn side_mut(&mut self) -> Option<AnySideMut<'_>> {
        None
    }

    fn pair(&self) -> Option<&Pair> {
        Some(self)
    }

    fn changeable(&self, address: &str) -> Result<String, String> {
        let own = self.own(address)?;
        let other = self.spelled(&own)?;
        let terminal = Address::parse(&own).is_ok_and(|own| matches!(own.file_type, FileType::I | FileType::O));
        if self.is_converted() && !terminal && self.a.controller().scans() == 0 {
            return Err(format!("{other} gets its initial value in the first scan: run one scan before changing it"));
        }
        Ok(own)
    }

    fn takes_scan_time(&self, time: Duration) -> Result<(), String> {
        match self.is_converted() && !time.as_nanos().is_multiple_of(1_000_000) {
            true => Err(format!("Do-more counts whole milliseconds, found {time:?}")),
            false => Ok(()),
        }
    }

    fn fork(&self) -> Box<dyn Subject> {
        Box::new(Pair {
            a: self.a.copy(),
            b: self.b.fork(),
            pairing: Arc::clone(&self.pairing),
            other_flow: self.other_flow.clone(),
            first: self.first.clone(),
        })
    }

    fn flow(&self) -> Flow {
        self.a.flow()
    }

    fn scan(&mut self, dt: Duration) {
        Subject::scan(&mut self.a, dt);
        self.b.scan(dt);
        self.look();
    }

    fn scan_watched(&mut self, dt: Duration, flow: &mut Flow) {
        self.a.scan_watched(dt, flow);
        self.b.scan_watched(dt, &mut self.other_flow);
        self.look();
    }

    fn mode(&self) -> &'static str {
        match self.a.mode() {
            "run" => self.b.mode(),
            mode => mode,
        }
    }

    fn enter_test(&mut self) -> Result<(), String> {
        self.b.enter_test()?;
        self.a.enter_test()
    }

    fn power_cycle(&mut self) {
        self.a.power_cycle();
        self.b.power_cycle();
    }

    fn fault_site(&self) -> Option<(u16, u16)> {
        self.a.fault_site()
    }

    /// Inputs on both sides. A forced output is forced where each controller does it, terminal or memory, which a
    /// comparison would take for the program's work.
    fn force(&mut self, address: &str, state: Option<bool>) -> Result<String, String> {
        let own = self.own(address)?;
        let output = Address::parse(&own).is_ok_and(|own| own.file_type == FileType::O);
        if output && self.is_converted() {
            return Err(format!("{own} is an output: side by side only inputs can be forced"));
        }
        let other = self.spelled(&own)?;
        self.b.force(&other, state)?;
        let forced = self.a.force(&own, state);
        if forced.is_err() {
            self.b.force(&other, None)?;
        }
        forced
    }

    fn enable_forces(&mut self, on: bool) -> Result<(), String> {
        self.b.enable_forces(on)?;
        self.a.enable_forces(on)
    }

    fn forces_enabled(&self) -> bool {
        self.a.forces_enabled()
    }

    fn point(&self, name: &str) -> Point {
        self.a.point(name)
    }

    fn terminal(&self, address: &str) -> Option<Value> {
        match address.strip_prefix(OTHER) {
            Some(other) => self.b.terminal(other),
            None => self.a.terminal(address),
        }
    }
}
