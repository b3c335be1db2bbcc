//! A Do-more machine on the workbench.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;
use std::time::Duration;

use analysis::proof::{self, AnySide, AnySideMut, Side};
use domore::engine::{Fault, Handle, Machine, Mode, Program, Watch};
use ladder::Value;
use render::scene::{Node, Scene};
use sim::scenario::Controller;

use super::flow::{AFTER, EXECUTED, Flow};
use super::subject::{Point, Subject};

/// A rung as wires with instructions between them, in the order of power flow.
#[derive(Clone, Debug, Default)]
struct Wires {
    instructions: usize,
    /// Instruction, wire it takes power from, wire it gives power to.
    spots: Vec<(usize, Node, Node)>,
    shorts: Vec<(Node, Node)>,
}

/// A Do-more machine. The engine tells what every contact says and every output gets; power in between follows from
/// the drawing.
pub struct DoMore {
    side: proof::DoMore,
    routines: Arc<Vec<Vec<Wires>>>,
    /// Names of input and output bits by their places.
    points: Arc<HashMap<Handle, String>>,
    /// Forced bits by their names. The engine has no forces: inputs are written before, outputs behind every scan.
    forces: BTreeMap<String, (Handle, bool)>,
    enabled: bool,
}

impl DoMore {
    /// The machine of a project, in program mode.
    pub fn new(program: Program, project: &domore::Project) -> DoMore {
        let documentation = domore::documentation::Documentation::default();
        let style = render::Style { comments: false, descriptions: false, ..render::Style::graphic(render::MAX_WIDTH) };
        let wires = |block: &domore::CodeBlock, index: usize| {
            let Scene { instructions, shorts, .. } = render::domore::scene(block, index, &documentation, &style);
            Wires {
                instructions: block.rungs.get(index).map_or(0, |rung| rung.instructions.len()),
                spots: instructions.iter().map(|spot| (spot.index, spot.enters, spot.leaves)).collect(),
                shorts,
            }
        };
        let rungs = |block: &domore::CodeBlock| (0..block.rungs.len()).map(|index| wires(block, index)).collect();
        let machine = Machine::new(program.clone());
        DoMore {
            points: Arc::new(points(&machine, project)),
            side: proof::DoMore::new(program),
            routines: Arc::new(project.code_blocks().map(rungs).collect()),
            forces: BTreeMap::new(),
            enabled: false,
        }
    }

    fn force_all(&mut self, wanted: fn(&str) -> bool) {
        if !self.enabled {
            return;
        }
        for (address, (handle, on)) in &self.forces {
            if wanted(address) {
                // It is a bit that can be written: that was tried when the force was installed.
                let _ = self.side.machine.put_shown(*handle, &Value::Bit(*on));
            }
        }
    }

    fn scan_with(&mut self, scan: impl FnOnce(&mut Machine)) {
        self.force_all(is_input);
        scan(&mut self.side.machine);
        self.force_all(|address| !is_input(address));
    }
}

/// By the name of the point, which begins with the name of its block.
fn is_input(name: &str) -> bool {
    name.starts_with('X')
}

fn points(machine: &Machine, project: &domore::Project) -> HashMap<Handle, String> {
    // A project that declares impossible memory did not compile.
    let map = domore::memory::Map::new(project);
    let blocks = map.iter().flat_map(|map| map.blocks()).filter(|block| ["X", "Y"].contains(&block.name.as_str()));
    let names = blocks.flat_map(|block| (0..block.count).map(|index| block.element_name(index)));
    names.filter_map(|name| Some((machine.handle(&name).ok()?, name))).collect()
}

/// What contacts said and outputs got, per instruction.
struct Seen<'a> {
    program: &'a Program,
    all: &'a mut Flow,
}

impl Watch for Seen<'_> {
    fn contact(&mut self, operation: u32, on: bool) {
        if let Some((block, rung, instruction)) = self.program.spot(operation) {
            let number = |index: usize| u16::try_from(index).unwrap_or(u16::MAX);
            self.all.saw(number(block), number(rung), number(instruction), false, on);
        }
    }

    fn power(&mut self, operation: u32, on: bool) {
        self.contact(operation, on);
    }
}

impl Subject for DoMore {
    fn side(&self) -> Option<AnySide<'_>> {
        Some(AnySide::DoMore(&self.side))
    }

    fn side_mut(&mut self) -> Option<AnySideMut<'_>> {
        Some(AnySideMut::DoMore(&mut self.side))
    }

    fn controller(&self) -> &dyn Controller {
        &self.side.machine
    }

    fn controller_mut(&mut self) -> &mut dyn Controller {
        &mut self.side.machine
    }

    fn fork(&self) -> Box<dyn Subject> {
        Box::new(DoMore {
            side: Side::fork(&self.side),
            routines: Arc::clone(&self.routines),
            points: Arc::clone(&self.points),
            forces: self.forces.clone(),
            enabled: self.enabled,
        })
    }

    fn flow(&self) -> Flow {
        let count = |rungs: &Vec<Wires>| rungs.iter().map(|rung| rung.instructions).collect();
        Flow::new((0..).zip(self.routines.iter().map(count)))
    }

    fn scan(&mut self, dt: Duration) {
        self.scan_with(|machine| {
            machine.scan(dt);
        });
    }

    fn scan_watched(&mut self, dt: Duration, flow: &mut Flow) {
        let mut said = self.flow();
        let program = self.side.program().clone();
        self.scan_with(|machine| {
            machine.scan_watched(dt, &mut Seen { program: &program, all: &mut said });
        });
        flow.begin();
        for (routine, rungs) in (0..).zip(self.routines.iter()) {
            for (number, rung) in (0..).zip(rungs) {
                let bits = said.rung(routine, number);
                if bits.iter().all(|bits| bits & EXECUTED == 0) {
                    continue;
                }
                let says = |index: usize| bits.get(index).is_some_and(|bits| bits & AFTER != 0);
                let ends = rung.spots.iter().map(|spot| spot.2).chain(rung.shorts.iter().map(|short| short.1));
                let mut power = vec![false; ends.max().unwrap_or(0) + 1];
                if let Some(rail) = power.first_mut() {
                    *rail = true;
                }
                let mut shorts = rung.shorts.as_slice();
                for (index, enters, leaves) in &rung.spots {
                    while let [(from, to), rest @ ..] = shorts
                        && from <= enters
                    {
                        lead(&mut power, *from, *to);
                        shorts = rest;
                    }
                    let before = power.get(*enters).copied().unwrap_or(false);
                    let after = before && says(*index);
                    if after && let Some(wire) = power.get_mut(*leaves) {
                        *wire = true;
                    }
                    flow.saw(routine, number, u16::try_from(*index).unwrap_or(u16::MAX), before, after);
                }
            }
        }
    }

    fn mode(&self) -> &'static str {
        match (self.side.machine.fault(), self.side.machine.mode()) {
            (Some(_), _) => "fault",
            (None, Mode::Run) => "run",
            (None, Mode::Program) => "program",
        }
    }

    fn enter_test(&mut self) -> Result<(), String> {
        Err("Do-more has no test mode".to_owned())
    }

    fn power_cycle(&mut self) {
        self.side.machine.power_cycle();
    }

    fn fault_site(&self) -> Option<(u16, u16)> {
        let Some(Fault::Unsupported { operation }) = self.side.machine.fault() else { return None };
        let (block, rung, _) = self.side.program().spot(operation)?;
        Some((u16::try_from(block).ok()?, u16::try_from(rung).ok()?))
    }

    fn force(&mut self, address: &str, state: Option<bool>) -> Result<String, String> {
        let handle = self.side.machine.handle(address).map_err(|error| error.why)?;
        let Some(name) = self.points.get(&handle).cloned() else {
            return Err(format!("{address} is no input or output bit: only those can be forced"));
        };
        match state {
            Some(on) => {
                self.side.machine.put_shown(handle, &self.side.machine.shown(handle))?;
                self.forces.insert(name.clone(), (handle, on));
            }
            None => {
                self.forces.remove(&name);
            }
        }
        Ok(name)
    }

    fn enable_forces(&mut self, on: bool) -> Result<(), String> {
        self.enabled = on;
        Ok(())
    }

    fn forces_enabled(&self) -> bool {
        self.enabled
    }

    /// A force stands in the memory of the point, for inputs and outputs alike.
    fn point(&self, name: &str) -> Point {
        match self.side.machine.read(name).ok().filter(|_| is_input(name)) {
            Some(value) => Point::Input(value),
            None => Point::ReadBack,
        }
    }

    fn terminal(&self, address: &str) -> Option<Value> {
        let output = address.starts_with(['Y', 'y']) || address.starts_with("WY") || address.starts_with("wy");
        match (output, self.side.machine.mode()) {
            (false, _) => None,
            (true, Mode::Run) => self.side.machine.read(address).ok(),
            // Outputs of a stopped controller are off.
            (true, Mode::Program) => match self.side.machine.read(address).ok()? {
                Value::Bit(_) => Some(Value::Bit(false)),
                Value::Word(_) => Some(Value::Word(0)),
                other => Some(other),
            },
        }
    }
}

fn lead(power: &mut [bool], from: Node, to: Node) {
    let on = power.get(from).copied().unwrap_or(false);
    if let Some(wire) = power.get_mut(to) {
        *wire |= on;
    }
}
