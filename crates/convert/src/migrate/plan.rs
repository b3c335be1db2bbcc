//! Which rung goes where: files behind each other, subroutines, and what a jump can skip.
//!
//! * A file called once, always and from what runs every scan, stands at the place of the call.
//! * Any other file that is called becomes a subroutine (`$LGCMOD`).
//! * Rungs that a jump, a return or an end can skip go to subroutines of their own, called while they
//!   are not skipped: what is skipped keeps its state, as on the original. A register per file holds the
//!   number of the rung a jump leads to; 0 is none.

use std::collections::{BTreeMap, BTreeSet};

use ladder::{Element, FileType, Image, Instruction, Operand, ProgramFile, Rung};

use super::interrupts::Timed;
use super::marks::{Mark, Note};

/// All code blocks.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    /// The main program first.
    pub(super) blocks: Vec<Block>,
    /// One per program file that has rungs.
    pub(super) frames: Vec<Frame>,
    /// The timed interrupt.
    pub(super) timed: Option<Timed>,
    /// Subroutine of a called file that is not in place.
    pub(super) subroutines: BTreeMap<u16, usize>,
}

/// A code block of the result.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// `$Main`, `SLC3`, ...
    pub(super) name: String,
    /// Not executed in every scan.
    pub(super) conditional: bool,
    pub(super) items: Vec<Item>,
}

/// What stands in a block.
#[derive(Clone, Debug)]
pub(super) enum Item {
    /// A rung of the original.
    Rung(Place),
    /// The jump register of a frame becomes 0.
    Enter(usize),
    /// A loop begins: its first rung.
    Repeat {
        /// The file's.
        frame: usize,
        /// Its first rung.
        from: u32,
    },
    /// The loop that began last goes on while a jump led back.
    Until {
        /// The file's.
        frame: usize,
        /// The loop's first rung.
        from: u32,
    },
    /// A block is called unless a jump skips it.
    Segment {
        /// Whose register decides.
        frame: usize,
        /// Its first rung.
        from: u32,
        /// Which block.
        block: usize,
    },
}

/// A rung of the original and what its surroundings mean for it.
#[derive(Clone, Debug)]
pub(super) struct Place {
    pub(super) frame: usize,
    pub(super) rung: u32,
    pub(super) zone: Zone,
    /// Not executed exactly once in every scan.
    pub(super) conditional: bool,
    /// The rung is a call whose file follows in place.
    pub(super) in_place: Option<u16>,
    /// What keeps it from being converted.
    pub(super) problem: Option<Note>,
    /// What its file being called by the controller means for it.
    pub(super) condition: Option<Note>,
}

/// Where a rung stands with respect to MCR zones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Zone {
    Outside,
    /// Its MCR opens one.
    Opens,
    Inside,
    /// Its MCR, alone in the rung, closes one.
    Closes,
    /// Its MCR has conditions: closes one that was false, else opens or closes by the rung.
    Turns,
}

/// A program file while its rungs are placed.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub(super) file: u16,
    /// Rung of each label.
    pub(super) labels: BTreeMap<u16, u32>,
    /// Number of rungs, END left out: where a return leads.
    pub(super) end: u32,
    /// A jump can skip rungs: its register is needed.
    pub(super) jumps: bool,
    /// First and last rung of each loop.
    pub(super) loops: Vec<(u32, u32)>,
}

/// What ends or leaves the sequence of rungs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Leap {
    To(u32),
    /// Back, or to a label that is not there.
    Impossible,
}

/// Files nest at most this deep.
const MAX_DEPTH: usize = 8;

/// Plans an image. Deterministic.
pub(super) fn plan(image: &Image) -> Plan {
    let mut planner = Planner {
        image,
        calls: calls(image),
        interrupts: interrupts(image),
        plan: Plan::default(),
        placed: BTreeSet::new(),
        wanted: Vec::new(),
    };
    planner.plan.timed = planner.interrupts.iter().find_map(|(file, source)| match source {
        Interrupt::Timed(period, unit) => Some(Timed { file: *file, period: *period, unit: *unit }),
        _ => None,
    });
    planner.plan.blocks.push(Block { name: "$Main".to_owned(), conditional: false, items: Vec::new() });
    if let Some(main) = image.program_file(2) {
        planner.placed.insert(2);
        planner.file(main, 0, 0, None);
    }
    // Called files first, in the order of the calls; then those nothing calls.
    let mut next = 0;
    loop {
        while let Some(number) = planner.wanted.get(next).copied() {
            next += 1;
            planner.subroutine(number);
        }
        let rest = image.ladder_files().map(|file| file.number).find(|number| !planner.placed.contains(number));
        match rest {
            Some(number) => planner.wanted.push(number),
            None => break,
        }
    }
    planner.plan
}

/// How many JSR name each file.
fn calls(image: &Image) -> BTreeMap<u16, usize> {
    let mut calls = BTreeMap::new();
    for instruction in image.ladder_files().flat_map(|file| &file.rungs).flat_map(Rung::instructions) {
        if let Some(file) = called(instruction) {
            *calls.entry(file).or_default() += 1;
        }
    }
    calls
}

/// The file a JSR calls.
pub(super) fn called(instruction: &Instruction) -> Option<u16> {
    match instruction.operands.first() {
        Some(Operand::ProgramFile(file)) if instruction.mnemonic == "JSR" => Some(*file),
        Some(Operand::Constant(constant)) if instruction.mnemonic == "JSR" => {
            constant.as_integer().and_then(|file| u16::try_from(file).ok())
        }
        _ => None,
    }
}

/// What makes the controller itself call a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Interrupt {
    /// A major fault.
    Fault,
    /// Time: the period in milliseconds that is stored, 0 when it is not running, and its unit.
    Timed(u32, u32),
    /// An input or a high-speed counter.
    Event,
}

impl Interrupt {
    /// What keeps the rungs of such a file from being converted, or the condition they are under.
    fn notes(self, file: u16) -> (Option<Note>, Option<Note>) {
        let note = |text: String| Some(Note::new(Mark::Interrupt, text));
        match self {
            Interrupt::Fault => {
                (None, note(format!("file {file} is the fault routine: faults of the original do not occur here")))
            }
            Interrupt::Timed(..) => (
                None,
                note(format!(
                    "file {file} is a timed interrupt (STI): here it runs at the beginning of the scan in which its time \
                     is up, once in a scan"
                )),
            ),
            Interrupt::Event => (
                note(format!("file {file} is an interrupt of an input or a high-speed counter: nothing here calls it")),
                None,
            ),
        }
    }
}

/// Files that the controller itself calls, with what calls them.
pub(super) fn interrupts(image: &Image) -> BTreeMap<u16, Interrupt> {
    let mut found = BTreeMap::new();
    let status = |word: u16| {
        let file = image.data_file(FileType::S, 2)?;
        file.element_words(word).and_then(|words| words.first().copied())
    };
    let is_file = |file: &u16| (3..=255).contains(file);
    if let Some(file) = status(29).filter(is_file) {
        found.insert(file, Interrupt::Fault);
    }
    let rules = instr::exec::Rules::of(image.processor.family);
    let status_file = rules.lineage != instr::exec::Lineage::Mx;
    if let Some(file) = status(31).filter(|file| status_file && is_file(file)) {
        // S:2/10 of SLC 5/03 and higher: milliseconds instead of 10 ms. S:2/1: enabled.
        let control = status(2).unwrap_or(0);
        let fine = control & 1 << 10 != 0 && rules.lineage == instr::exec::Lineage::S3;
        let unit = if fine { 1 } else { 10 };
        let period = u32::from(status(30).unwrap_or(0)) * unit;
        let enabled = control & 2 != 0;
        found.insert(file, Interrupt::Timed(if enabled { period } else { 0 }, unit));
    }
    for file in &image.function_files {
        if !matches!(file.file_type, FileType::STI | FileType::EII | FileType::HSC) {
            continue;
        }
        for element in 0..file.elements {
            let Some(words) = file.element_words(element) else { continue };
            let word = |index: usize| words.get(index).copied().unwrap_or(0);
            let Some(number) = Some(word(0)).filter(is_file) else { continue };
            // AS or TIE: it runs; the set point is in milliseconds.
            let runs = word(2) & (1 << 5 | 1 << 4) != 0;
            let timed = Interrupt::Timed(if runs { word(3).into() } else { 0 }, 1);
            found.insert(number, if file.file_type == FileType::STI { timed } else { Interrupt::Event });
        }
    }
    found
}

struct Planner<'a> {
    image: &'a Image,
    calls: BTreeMap<u16, usize>,
    interrupts: BTreeMap<u16, Interrupt>,
    plan: Plan,
    placed: BTreeSet<u16>,
    /// Files that become subroutines, in the order they were met.
    wanted: Vec<u16>,
}

impl Planner<'_> {
    fn subroutine(&mut self, number: u16) {
        if !self.placed.insert(number) {
            return;
        }
        let Some(file) = self.image.program_file(number) else { return };
        let block = self.plan.blocks.len();
        let name = block_name(&format!("SLC{number}"), &file.name);
        self.plan.blocks.push(Block { name, conditional: true, items: Vec::new() });
        self.plan.subroutines.insert(number, block);
        let interrupt = self.interrupts.get(&number).copied();
        let interrupt = interrupt.filter(|_| !self.calls.contains_key(&number));
        self.file(file, block, 0, interrupt);
    }

    /// Places the rungs of a file at the end of a block.
    fn file(&mut self, file: &ProgramFile, block: usize, depth: usize, interrupt: Option<Interrupt>) {
        let (problem, interrupt) = interrupt.map_or((None, None), |source| source.notes(file.number));
        let end = u32::try_from(file.rungs.iter().take_while(|rung| !rung.is_end()).count()).unwrap_or(u32::MAX);
        let labels = labels(file);
        let loops = loops(file, end, &labels);
        let leaps: Vec<Option<Leap>> = (0..end)
            .map(|number| file.rungs.get(number as usize).and_then(|rung| leap(rung, number, end, &labels, &loops)))
            .collect();
        // A rung can be skipped when a leap before it leads past it.
        let mut guarded = Vec::with_capacity(leaps.len());
        let mut furthest = 0;
        for (number, leap) in leaps.iter().enumerate() {
            guarded.push(furthest > number as u32);
            if let Some(Leap::To(to)) = leap {
                furthest = furthest.max(*to);
            }
        }
        let jumps = guarded.contains(&true);
        let zones = zones(file, end, &guarded, &labels);
        let frame = self.plan.frames.len();
        self.plan.frames.push(Frame { file: file.number, labels: labels.clone(), end, jumps, loops: loops.clone() });
        if jumps {
            self.push(block, Item::Enter(frame));
        }
        let targets: BTreeSet<u32> = labels.values().copied().collect();
        let mut segment: Option<usize> = None;
        // Loops that are open: the last rung of each and the block it repeats in.
        let mut open: Vec<(u32, u32, usize)> = Vec::new();
        for number in 0..end {
            let index = number as usize;
            let Some(rung) = file.rungs.get(index) else { break };
            let is_guarded = guarded.get(index).copied().unwrap_or(false);
            let after_leap = index.checked_sub(1).and_then(|before| leaps.get(before)).is_some_and(Option::is_some);
            let base = open.last().map_or(block, |open| open.2);
            let begins = loops.iter().find(|found| found.0 == number);
            let target = match (is_guarded, segment) {
                (false, _) => {
                    segment = None;
                    base
                }
                (true, Some(open)) if !after_leap && !targets.contains(&number) => open,
                (true, _) => {
                    let new = self.plan.blocks.len();
                    let name = format!("SLC{}from{number}", file.number);
                    self.plan.blocks.push(Block { name, conditional: true, items: Vec::new() });
                    self.push(base, Item::Segment { frame, from: number, block: new });
                    segment = Some(new);
                    new
                }
            };
            if let Some((from, to)) = begins {
                // The whole loop stays in one block; what is skipped inside it is called from there.
                self.push(target, Item::Repeat { frame, from: *from });
                open.push((*from, *to, target));
                segment = None;
            }
            let (zone, zone_problem) = zones.get(index).cloned().unwrap_or((Zone::Outside, None));
            let back = matches!(leaps.get(index), Some(Some(Leap::Impossible)))
                .then(|| Note::new(Mark::Flow, "a jump into or out of a loop, or to a label that is not there"));
            let in_place = if open.is_empty() { self.in_place(rung, target, zone, depth) } else { None };
            let problem = problem.clone().or(zone_problem).or(back).or_else(|| misplaced(rung, file.number));
            let conditional = !open.is_empty() || self.plan.blocks.get(target).is_some_and(|block| block.conditional);
            let condition = interrupt.clone();
            self.push(
                target,
                Item::Rung(Place { frame, rung: number, zone, conditional, in_place, problem, condition }),
            );
            match in_place.and_then(|called| self.image.program_file(called)) {
                Some(called) => self.file(called, target, depth + 1, None),
                None => self.wanted.extend(rung.instructions().filter_map(called)),
            }
            while let Some((from, to, block)) = open.last().copied() {
                if to != number {
                    break;
                }
                self.push(block, Item::Until { frame, from });
                open.pop();
                segment = None;
            }
        }
    }

    /// The file that follows in place of this call.
    fn in_place(&mut self, rung: &Rung, block: usize, zone: Zone, depth: usize) -> Option<u16> {
        let [Element::Instruction(only)] = rung.series.as_slice() else { return None };
        let file = called(only)?;
        let runs_always = self.plan.blocks.get(block).is_some_and(|block| !block.conditional);
        let once = self.calls.get(&file) == Some(&1) && !self.interrupts.contains_key(&file);
        let there = self.image.ladder_files().any(|known| known.number == file);
        let fits = runs_always && once && there && zone == Zone::Outside && depth < MAX_DEPTH;
        (fits && self.placed.insert(file)).then_some(file)
    }

    fn push(&mut self, block: usize, item: Item) {
        if let Some(block) = self.plan.blocks.get_mut(block) {
            block.items.push(item);
        }
    }
}

/// A name for a code block, at most 16 characters.
fn block_name(prefix: &str, name: &str) -> String {
    let name: String = name.chars().filter(char::is_ascii_alphanumeric).collect();
    let mut full = if name.is_empty() { prefix.to_owned() } else { format!("{prefix}_{name}") };
    full.truncate(16);
    full
}

fn labels(file: &ProgramFile) -> BTreeMap<u16, u32> {
    let mut labels = BTreeMap::new();
    for (number, rung) in file.rungs.iter().enumerate() {
        for instruction in rung.instructions().filter(|instruction| instruction.mnemonic == "LBL") {
            if let Some(label) = label(instruction) {
                labels.entry(label).or_insert(u32::try_from(number).unwrap_or(u32::MAX));
            }
        }
    }
    labels
}

/// The label an instruction names.
pub(super) fn label(instruction: &Instruction) -> Option<u16> {
    match instruction.operands.first()? {
        Operand::Label { number, .. } => Some(*number),
        Operand::Constant(constant) => constant.as_integer().and_then(|number| u16::try_from(number).ok()),
        _ => None,
    }
}

/// The loops of a file, outer ones first: each label with a jump back to it, to the last of these jumps.
/// Empty when loops overlap without one lying inside the other, or a jump leads into one from outside.
fn loops(file: &ProgramFile, end: u32, labels: &BTreeMap<u16, u32>) -> Vec<(u32, u32)> {
    let mut found: BTreeMap<u32, u32> = BTreeMap::new();
    let mut jumps = Vec::new();
    for (number, rung) in file.rungs.iter().enumerate().take(end as usize) {
        let number = u32::try_from(number).unwrap_or(u32::MAX);
        for instruction in rung.instructions().filter(|instruction| instruction.mnemonic == "JMP") {
            let Some(to) = label(instruction).and_then(|label| labels.get(&label)).copied() else { continue };
            jumps.push((number, to));
            if to <= number {
                let last = found.entry(to).or_insert(number);
                *last = (*last).max(number);
            }
        }
    }
    let loops: Vec<(u32, u32)> = found.into_iter().collect();
    let nested = loops.iter().all(|a| {
        loops.iter().all(|b| b.1 < a.0 || a.1 < b.0 || (a.0 <= b.0 && b.1 <= a.1) || (b.0 <= a.0 && a.1 <= b.1))
    });
    let entered = jumps
        .iter()
        .any(|(from, to)| loops.iter().any(|(first, last)| first < to && to <= last && (from < first || last < from)));
    if nested && !entered { loops } else { Vec::new() }
}

/// Where the furthest of a rung's jumps leads.
fn leap(rung: &Rung, number: u32, end: u32, labels: &BTreeMap<u16, u32>, loops: &[(u32, u32)]) -> Option<Leap> {
    let mut found = None;
    for instruction in rung.instructions() {
        let to = match instruction.mnemonic.name() {
            Some("JMP") => match label(instruction).and_then(|label| labels.get(&label)) {
                Some(to) if *to > number => Leap::To(*to),
                // Back: past the rest of the loop, which then begins again.
                Some(to) => match loops.iter().find(|found| found.0 == *to) {
                    Some((_, last)) => Leap::To(last.saturating_add(1)),
                    None => Leap::Impossible,
                },
                None => Leap::Impossible,
            },
            Some("RET" | "TND") => Leap::To(end),
            _ => continue,
        };
        found = Some(match (found, to) {
            (Some(Leap::Impossible), _) | (_, Leap::Impossible) => Leap::Impossible,
            (Some(Leap::To(a)), Leap::To(b)) => Leap::To(a.max(b)),
            (None, to) => to,
        });
    }
    found
}

/// Instructions that do something without power too: skipped they keep what they would change.
const ACTIVE: [&str; 24] = [
    "OTE", "ONS", "OSR", "OSF", "TON", "TOF", "RTO", "CTU", "CTD", "SQO", "SQC", "SQL", "BSL", "BSR", "FFL", "FFU",
    "LFL", "LFU", "MCR", "MSG", "PID", "DDT", "FBC", "HSC",
];

/// What keeps a jump, return or end from standing where it does. Behind it in its rung only instructions
/// can stand that do nothing without power: the jump takes their power away.
fn misplaced(rung: &Rung, file: u16) -> Option<Note> {
    let mut left = None;
    for instruction in rung.instructions() {
        let name = instruction.mnemonic.name().unwrap_or_default();
        if let Some(before) = left
            && ACTIVE.contains(&name)
        {
            return Some(Note::new(
                Mark::Flow,
                format!("{name} behind {before} in one rung: it is skipped, not false"),
            ));
        }
        match name {
            "TND" if file != 2 => return Some(Note::new(Mark::Flow, "TND in a subroutine ends the whole scan")),
            "RET" if file == 2 => {
                return Some(Note::new(Mark::Fault, "RET in the main program is major fault 0038"));
            }
            "JMP" | "RET" | "TND" => left = Some(name),
            _ => {}
        }
    }
    None
}

/// The zone of each rung, and what is wrong with it.
fn zones(file: &ProgramFile, end: u32, guarded: &[bool], labels: &BTreeMap<u16, u32>) -> Vec<(Zone, Option<Note>)> {
    let mut zones = Vec::new();
    let mut opened: Option<usize> = None;
    let targets: BTreeSet<u32> = labels.values().copied().collect();
    for number in 0..end as usize {
        let Some(rung) = file.rungs.get(number) else { break };
        let has_mcr = rung.instructions().any(|instruction| instruction.mnemonic == "MCR");
        let alone = rung.series.len() == 1;
        let zone = match (opened.is_some(), has_mcr, alone) {
            (false, false, _) | (false, true, true) => Zone::Outside,
            (false, true, false) => Zone::Opens,
            (true, false, _) => Zone::Inside,
            (true, true, true) => Zone::Closes,
            (true, true, false) => Zone::Turns,
        };
        zones.push((zone, None));
        match zone {
            Zone::Opens => opened = Some(number),
            Zone::Closes => {
                mark_jumped(&mut zones, opened.take(), number, guarded, &targets);
            }
            _ => {}
        }
    }
    let last = zones.len().saturating_sub(1);
    mark_jumped(&mut zones, opened, last, guarded, &targets);
    zones
}

/// A jump into or out of a zone changes what the zone means.
fn mark_jumped(
    zones: &mut [(Zone, Option<Note>)],
    from: Option<usize>,
    to: usize,
    guarded: &[bool],
    targets: &BTreeSet<u32>,
) {
    let Some(from) = from else { return };
    let jumped = (from..=to).any(|number| {
        guarded.get(number).copied().unwrap_or(false) || (number > from && targets.contains(&(number as u32)))
    });
    if jumped {
        for zone in zones.iter_mut().take(to + 1).skip(from) {
            zone.1 = Some(Note::new(Mark::Flow, "jumps lead into or out of an MCR zone"));
        }
    }
}
