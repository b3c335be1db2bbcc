//! One scan of a program as a circuit: from the data before it to the data behind it.
//!
//! Everything the program cannot decide is left free: inputs, status words, function files, how far a timer
//! has counted, whether run is entered anew before the scan. So is what an instruction does that has no
//! exact meaning here, within the words it can write. What the circuit cannot do, the machine cannot do.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use batsat::Lit;
use ladder::FileType;
use sim::choices::Choice;
use sim::outline::{Does, Outline, Routine, Step, Value, Write};

use super::cells::{Cell, Disturbance, Nature, nature};
use super::gates::Gates;

/// The data a scan begins with.
#[derive(Clone, Copy)]
pub(super) enum Before<'d> {
    /// The first scan after power-up, from these words.
    Loaded(&'d [u16]),
    /// Any scan, from any data.
    Any,
}

/// What can happen at an instruction.
#[derive(Clone, Copy)]
pub(super) struct Happens {
    /// With power before it: power behind it, or none.
    pub(super) passes: Lit,
    pub(super) blocks: Lit,
    /// Executed with power before it, or without.
    pub(super) on: Lit,
    pub(super) off: Lit,
}

/// Why there is no circuit.
pub(super) type Refused = &'static str;

pub(super) struct Scan<'o> {
    pub(super) gates: Gates,
    pub(super) outline: &'o Outline,
    pub(super) before: Before<'o>,
    /// Bits of words that people and devices write.
    pub(super) inputs: &'o BTreeSet<u32>,
    pub(super) nature: Vec<Nature>,
    pub(super) prescan: BTreeMap<u32, bool>,
    pub(super) cells: HashMap<u32, Cell>,
    /// Bits the scan depends on, as they were before it.
    pub(super) initial: BTreeMap<u32, Lit>,
    pub(super) disturbed: Vec<Disturbance>,
    /// Words that interrupts can change between two rungs.
    pub(super) volatile: Vec<(u32, u32)>,
    /// Run was entered anew before this scan.
    pub(super) first: Lit,
    /// The scan has ended.
    gone: Lit,
    /// A fault has occurred; a routine may have run.
    pub(super) faults: Lit,
    /// An element number has led out of its file.
    pub(super) strays: Lit,
    minor: Lit,
    fault_writes: Option<Vec<Write>>,
    pub(super) happens: BTreeMap<(u16, u16, u16), Happens>,
    steps: usize,
    pub(super) main_files: BTreeSet<u16>,
}

/// Steps of a scan, calls included.
const MOST_STEPS: usize = 30_000;
/// Gates of a circuit.
const MOST_GATES: usize = 600_000;

/// Power in a rung.
#[derive(Clone)]
struct Flow {
    power: Lit,
    /// Power where open branches began, and what their legs passed on.
    branches: Vec<(Lit, Lit)>,
    zone: Lit,
}

impl<'o> Scan<'o> {
    /// Builds the circuit.
    ///
    /// # Errors
    /// The program is too long or loops within a scan.
    pub(super) fn build(
        outline: &'o Outline,
        before: Before<'o>,
        inputs: &'o BTreeSet<u32>,
    ) -> Result<Scan<'o>, Refused> {
        let usual = sim::Choices::default();
        let known = [usual, usual.with(Choice::IndirectStaysInFile)];
        if !known.contains(&outline.choices) {
            return Err("the program runs with other readings than the usual ones");
        }
        let Some(prescan) = &outline.prescan else {
            return Err("going to run resets a bit that is only known then");
        };
        let mut gates = Gates::new();
        let (yes, no) = (gates.yes(), gates.no());
        let first = if matches!(before, Before::Loaded(_)) { yes } else { gates.free() };
        let mut scan = Scan {
            gates,
            outline,
            before,
            inputs,
            nature: nature(outline),
            prescan: prescan.iter().copied().collect(),
            cells: HashMap::new(),
            initial: BTreeMap::new(),
            disturbed: Vec::new(),
            volatile: Vec::new(),
            first,
            gone: no,
            faults: no,
            strays: no,
            minor: no,
            fault_writes: None,
            happens: BTreeMap::new(),
            steps: 0,
            main_files: BTreeSet::new(),
        };
        scan.routines();
        let entry = scan.entry(2).ok_or("there is no main program")?;
        let alive = !scan.gone;
        scan.file(entry, 2, alive, 0)?;
        // Minor errors become a fault at the end of the scan.
        let declared = if outline.minor_error { scan.gates.free() } else { scan.minor };
        scan.fault(declared);
        Ok(scan)
    }

    /// What runs before the program: interrupts.
    fn routines(&mut self) {
        if self.outline.refuses_run {
            let refused = self.gates.free();
            self.gone = self.gates.and(self.first, refused);
        }
        for (file, routine) in self.outline.routines.clone() {
            let (writes, plain) = self.reach_of(file);
            match routine {
                Routine::Fault => self.fault_writes.get_or_insert_default().extend(writes),
                Routine::Anytime => self.volatile.extend(writes.iter().map(words)),
                Routine::Timed | Routine::Event => {
                    let when = if routine == Routine::Timed { !self.first } else { self.gates.yes() };
                    for write in &writes {
                        self.disturbed.push(Disturbance { when, words: words(write) });
                    }
                }
            }
            if routine != Routine::Fault && !plain {
                // It may stop the controller.
                let stops = self.gates.free();
                self.gone = self.gates.or(self.gone, stops);
            }
        }
    }

    /// What a file and the files it calls can write; and whether nothing there can stop the controller.
    fn reach_of(&self, file: u16) -> (Vec<Write>, bool) {
        if file == 0 {
            let outputs = self.outline.files.iter().filter(|range| range.file_type == FileType::O);
            return (outputs.map(|range| Write::Words(range.words.0, range.words.1)).collect(), true);
        }
        let (mut writes, mut plain) = (Vec::new(), true);
        for file in called(self.outline, file) {
            for step in self.outline.steps.iter().filter(|step| step.file == file) {
                plain &= !matches!(
                    step.does,
                    Does::Timer { .. }
                        | Does::Sequencer { .. }
                        | Does::Jump(_)
                        | Does::Call(_)
                        | Does::TempEnd
                        | Does::Suspend
                        | Does::Other { .. }
                );
                // Beyond its file there is no telling.
                writes.extend(written(&step.does).into_iter().map(|write| match write {
                    Write::Element { strays: true, .. } => Write::Anywhere,
                    write => write,
                }));
            }
        }
        (writes, plain)
    }

    pub(super) fn entry(&self, file: u16) -> Option<usize> {
        self.outline.entries.get(usize::from(file)).copied().flatten().map(|entry| entry as usize)
    }

    /// Executes a file where `alive` holds.
    fn file(&mut self, entry: usize, number: u16, mut alive: Lit, depth: usize) -> Result<(), Refused> {
        self.main_files.insert(number);
        let (yes, no) = (self.gates.yes(), self.gates.no());
        let mut flow = Flow { power: yes, branches: Vec::new(), zone: yes };
        let mut jumps: BTreeMap<usize, Vec<(Lit, Lit)>> = BTreeMap::new();
        let outline = self.outline;
        for (at, step) in outline.steps.iter().enumerate().skip(entry) {
            self.steps += 1;
            if self.steps > MOST_STEPS || self.gates.size() > MOST_GATES {
                return Err("the program is too long");
            }
            for (arrives, zone) in jumps.remove(&at).unwrap_or_default() {
                flow.zone = self.gates.choose(arrives, zone, flow.zone);
                alive = self.gates.or(alive, arrives);
            }
            let before = flow.power;
            // Where a step ends the file the flow behind it is of no interest.
            let mut next = alive;
            match &step.does {
                Does::End => return Ok(()),
                Does::Jump(target) => {
                    let target = *target as usize;
                    if target <= at {
                        return Err("it jumps backwards within a scan");
                    }
                    let goes = self.gates.and(alive, flow.power);
                    jumps.entry(target).or_default().push((goes, flow.zone));
                    next = self.gates.and(alive, !flow.power);
                }
                Does::Call(file) => {
                    let goes = self.gates.and(alive, flow.power);
                    match self.entry(*file).filter(|_| depth < outline.levels) {
                        Some(start) if goes != no => self.file(start, *file, goes, depth + 1)?,
                        Some(_) => {}
                        None => self.fault(goes),
                    }
                }
                Does::Return => {
                    let goes = self.gates.and(alive, flow.power);
                    if depth == 0 {
                        self.fault(goes);
                    }
                    next = self.gates.and(alive, !flow.power);
                }
                Does::TempEnd | Does::Suspend => {
                    let goes = self.gates.and(alive, flow.power);
                    self.gone = self.gates.or(self.gone, goes);
                }
                _ => self.step(step, alive, &mut flow),
            }
            if let Some(instruction) = step.instruction {
                self.note((step.file, step.rung, instruction), alive, before, flow.power);
            }
            alive = self.gates.and(next, !self.gone);
        }
        Ok(())
    }

    fn note(&mut self, site: (u16, u16, u16), alive: Lit, before: Lit, after: Lit) {
        let on = self.gates.and(alive, before);
        let off = self.gates.and(alive, !before);
        let (passes, blocks) = (self.gates.and(on, after), self.gates.and(on, !after));
        let no = self.gates.no();
        let old = self.happens.get(&site).copied().unwrap_or(Happens { passes: no, blocks: no, on: no, off: no });
        let happens = Happens {
            passes: self.gates.or(old.passes, passes),
            blocks: self.gates.or(old.blocks, blocks),
            on: self.gates.or(old.on, on),
            off: self.gates.or(old.off, off),
        };
        self.happens.insert(site, happens);
    }

    /// Steps that only move power or write data.
    fn step(&mut self, step: &Step, alive: Lit, flow: &mut Flow) {
        let yes = self.gates.yes();
        match &step.does {
            Does::Rung => *flow = Flow { power: flow.zone, branches: Vec::new(), zone: flow.zone },
            Does::BranchStart => flow.branches.push((flow.power, self.gates.no())),
            Does::NextLeg => {
                if let Some((began, joined)) = flow.branches.last_mut() {
                    *joined = self.gates.or(*joined, flow.power);
                    flow.power = *began;
                }
            }
            Does::BranchEnd => {
                if let Some((_, joined)) = flow.branches.pop() {
                    flow.power = self.gates.or(flow.power, joined);
                }
            }
            Does::Mcr => flow.zone = self.gates.choose(flow.zone, flow.power, yes),
            does => {
                if let Some(power) = self.act(does, alive, flow.power) {
                    flow.power = power;
                }
            }
        }
    }

    /// A fault where the condition holds: the controller stops, unless a routine clears it.
    pub(super) fn fault(&mut self, when: Lit) {
        if when == self.gates.no() {
            return;
        }
        self.faults = self.gates.or(self.faults, when);
        let mut stops = when;
        if let Some(writes) = self.fault_writes.clone() {
            for write in &writes {
                self.disturb(when, write);
            }
            let cleared = self.gates.free();
            stops = self.gates.and(when, !cleared);
        }
        self.gone = self.gates.or(self.gone, stops);
    }

    pub(super) fn minor(&mut self, when: Lit) {
        self.minor = self.gates.or(self.minor, when);
    }

    pub(super) fn stray(&mut self, when: Lit) {
        self.strays = self.gates.or(self.strays, when);
    }
}

/// A file and all files it calls.
pub(super) fn called(outline: &Outline, file: u16) -> BTreeSet<u16> {
    let (mut files, mut open) = (BTreeSet::new(), vec![file]);
    while let Some(file) = open.pop() {
        if files.insert(file) {
            let steps = outline.steps.iter().filter(|step| step.file == file);
            open.extend(steps.filter_map(|step| match step.does {
                Does::Call(called) => Some(called),
                _ => None,
            }));
        }
    }
    files
}

/// The words of a write; an element number that leads out of its file is another matter.
pub(super) fn words(write: &Write) -> (u32, u32) {
    match *write {
        Write::Words(from, to) | Write::Element { file: (from, to), .. } => (from, to),
        Write::Anywhere => (0, u32::MAX),
    }
}

/// What a step can write.
fn written(does: &Does) -> Vec<Write> {
    let bit = |at: u32| Write::Words(at / 16, at / 16 + 1);
    let element = |at: u32| Write::Words(at, at + 3);
    match does {
        Does::Coil(at) | Does::Latch(at) | Does::Unlatch(at) | Does::OneShot(at) => vec![bit(*at)],
        Does::Rising { storage, output } | Does::Falling { storage, output } => vec![bit(*storage), bit(*output)],
        Does::Timer { word, .. } | Does::Counter { word, .. } | Does::ResetTimer(word) | Does::ResetCounter(word) => {
            vec![element(*word)]
        }
        Does::Move { dest, .. } | Does::Binary { dest, .. } => match *dest {
            Value::Word(at) => vec![Write::Words(at, at + 1)],
            Value::Long(at) => vec![Write::Words(at, at + 2)],
            Value::Constant(_) => Vec::new(),
        },
        Does::Copy { to, words, .. } | Does::Fill { to, words, .. } => vec![Write::Words(*to, *to + *words)],
        Does::Sequencer { control, dest, .. } => vec![element(*control), Write::Words(*dest, *dest + 1)],
        Does::Other { writes, .. } => writes.clone(),
        _ => Vec::new(),
    }
}
