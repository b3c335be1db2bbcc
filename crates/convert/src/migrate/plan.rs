//! Which rung goes where: files behind each other, subroutines, and what a jump can skip.
//!
//! * A file called once, always and from what runs every scan, stands at the place of the call.
//! * Any other file that is called becomes a subroutine (`$LGCMOD`).
//! * Rungs that a jump, a return or an end can skip go to subroutines of their own, called while they
//!   are not skipped: what is skipped keeps its state, as on the original. A register per file holds the
//!   number of the rung a jump leads to; 0 is none.

use std::collections::{BTreeMap, BTreeSet};

use ladder::{Element, FileType, Image, Instruction, Operand, ProgramFile, Rung};

use super::marks::{Mark, Note};

/// All code blocks.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    /// The main program first.
    pub(super) blocks: Vec<Block>,
    /// One per program file that has rungs.
    pub(super) frames: Vec<Frame>,
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
    /// The rung is a call whose file follows in place.
    pub(super) in_place: Option<u16>,
    /// What keeps it from being converted.
    pub(super) problem: Option<Note>,
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

/// Files that the controller itself calls, with what calls them.
fn interrupts(image: &Image) -> BTreeMap<u16, &'static str> {
    let mut found = BTreeMap::new();
    let status = |word: u16| {
        let file = image.data_file(FileType::S, 2)?;
        file.element_words(word).and_then(|words| words.first().copied())
    };
    let words: [(u16, &str); 4] =
        [(29, "fault routine"), (31, "timed interrupt (STI)"), (47, "input interrupt (DII)"), (32, "I/O interrupt")];
    for (word, what) in words {
        // S:47 names a file on processors with a DII only, S:32 is the executing slot.
        if matches!(word, 47 | 32) {
            continue;
        }
        if let Some(file) = status(word).filter(|file| (3..=255).contains(file)) {
            found.insert(file, what);
        }
    }
    for file in &image.function_files {
        let what = match file.file_type {
            FileType::STI => "timed interrupt (STI)",
            FileType::EII => "event input interrupt",
            FileType::HSC => "high-speed counter interrupt",
            _ => continue,
        };
        for element in 0..file.elements {
            let number = file.element_words(element).and_then(|words| words.first().copied());
            if let Some(number) = number.filter(|file| (3..=255).contains(file)) {
                found.insert(number, what);
            }
        }
    }
    found
}

struct Planner<'a> {
    image: &'a Image,
    calls: BTreeMap<u16, usize>,
    interrupts: BTreeMap<u16, &'static str>,
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
        let problem = self.interrupts.get(&number).filter(|_| !self.calls.contains_key(&number)).map(|what| {
            Note::new(Mark::Interrupt, format!("file {number} is a {what}: nothing in Do-more calls it by itself"))
        });
        self.file(file, block, 0, problem);
    }

    /// Places the rungs of a file at the end of a block.
    fn file(&mut self, file: &ProgramFile, block: usize, depth: usize, problem: Option<Note>) {
        let end = u32::try_from(file.rungs.iter().take_while(|rung| !rung.is_end()).count()).unwrap_or(u32::MAX);
        let frame = self.plan.frames.len();
        let labels = labels(file);
        let leaps: Vec<Option<Leap>> = (0..end)
            .map(|number| file.rungs.get(number as usize).and_then(|rung| leap(rung, number, end, &labels)))
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
        self.plan.frames.push(Frame { file: file.number, labels: labels.clone(), end, jumps });
        if jumps {
            self.push(block, Item::Enter(frame));
        }
        let targets: BTreeSet<u32> = labels.values().copied().collect();
        let mut segment: Option<usize> = None;
        for number in 0..end {
            let index = number as usize;
            let Some(rung) = file.rungs.get(index) else { break };
            let is_guarded = guarded.get(index).copied().unwrap_or(false);
            let after_leap = index.checked_sub(1).and_then(|before| leaps.get(before)).is_some_and(Option::is_some);
            let target = match (is_guarded, segment) {
                (false, _) => {
                    segment = None;
                    block
                }
                (true, Some(open)) if !after_leap && !targets.contains(&number) => open,
                (true, _) => {
                    let new = self.plan.blocks.len();
                    let name = format!("SLC{}from{number}", file.number);
                    self.plan.blocks.push(Block { name, conditional: true, items: Vec::new() });
                    self.push(block, Item::Segment { frame, from: number, block: new });
                    segment = Some(new);
                    new
                }
            };
            let (zone, zone_problem) = zones.get(index).cloned().unwrap_or((Zone::Outside, None));
            let back = matches!(leaps.get(index), Some(Some(Leap::Impossible)))
                .then(|| Note::new(Mark::Flow, "a jump back, or to a label that is not there"));
            let in_place = self.in_place(rung, target, zone, depth);
            let problem = problem.clone().or(zone_problem).or(back).or_else(|| misplaced(rung, file.number));
            self.push(target, Item::Rung(Place { frame, rung: number, zone, in_place, problem }));
            match in_place.and_then(|called| self.image.program_file(called)) {
                Some(called) => self.file(called, target, depth + 1, None),
                None => self.wanted.extend(rung.instructions().filter_map(called)),
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

/// Where the furthest of a rung's jumps leads.
fn leap(rung: &Rung, number: u32, end: u32, labels: &BTreeMap<u16, u32>) -> Option<Leap> {
    let mut found = None;
    for instruction in rung.instructions() {
        let to = match instruction.mnemonic.name() {
            Some("JMP") => match label(instruction).and_then(|label| labels.get(&label)) {
                Some(to) if *to > number => Leap::To(*to),
                _ => Leap::Impossible,
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

/// Instructions that end the execution of their rung have to be the last of it.
fn misplaced(rung: &Rung, file: u16) -> Option<Note> {
    let mut instructions = rung.instructions().peekable();
    while let Some(instruction) = instructions.next() {
        let Some(name @ ("JMP" | "RET" | "TND")) = instruction.mnemonic.name() else { continue };
        if instructions.peek().is_some() {
            return Some(Note::new(Mark::Flow, format!("{name} in the middle of a rung: the rest of it is skipped")));
        }
        if name == "TND" && file != 2 {
            return Some(Note::new(Mark::Flow, "TND in a subroutine ends the whole scan"));
        }
        if name == "RET" && file == 2 {
            return Some(Note::new(Mark::Fault, "RET in the main program is major fault 0038"));
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
