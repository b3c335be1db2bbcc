//! What a proof run should reach: every condition both ways, every output with and without power, every
//! timer done, every comparison at its boundary.

use std::collections::{BTreeMap, BTreeSet};

use ladder::{Element, FileType, Image, Instruction, Operand, Series};
use sim::{PowerFlow, Trace};

use super::side::{Kind, Side, Slc};
use crate::{CallGraph, CrossReference, Location};

/// What kind of goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum GoalKind {
    /// A condition with power before it passes power on.
    Passes,
    /// A condition with power before it stops the power.
    Blocks,
    /// An output is executed with a true rung.
    True,
    /// An output is executed with a false rung.
    False,
    /// A timer or counter is done.
    Done,
    /// A timer or counter is not done.
    NotDone,
    /// A comparison sees two equal values.
    Equal,
    /// It sees the first value one below the second.
    JustBelow,
    /// It sees the first value one above the second.
    JustAbove,
}

impl GoalKind {
    /// In words, behind the instruction.
    pub fn as_str(self) -> &'static str {
        match self {
            GoalKind::Passes => "passes power",
            GoalKind::Blocks => "stops power",
            GoalKind::True => "with a true rung",
            GoalKind::False => "with a false rung",
            GoalKind::Done => "done",
            GoalKind::NotDone => "not done",
            GoalKind::Equal => "at equal values",
            GoalKind::JustBelow => "one below",
            GoalKind::JustAbove => "one above",
        }
    }

    /// It is a condition of a rung: a contact or comparison both ways, an output with and without power.
    pub fn is_rung_condition(self) -> bool {
        matches!(self, GoalKind::Passes | GoalKind::Blocks | GoalKind::True | GoalKind::False)
    }
}

/// A goal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Goal {
    /// The instruction.
    pub location: Location,
    /// What should happen at it.
    pub kind: GoalKind,
    /// The instruction as text.
    pub text: String,
    /// Why it cannot happen, by argument from the program.
    pub impossible: Option<String>,
    /// It happened.
    pub reached: bool,
}

/// A value a comparison looks at.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Source {
    Constant(i64),
    Word(u32),
    Long(u32),
}

impl Source {
    pub(crate) fn value(self, a: &Slc) -> i64 {
        match self {
            Source::Constant(value) => value,
            Source::Word(at) => i64::from(a.word(at) as i16),
            Source::Long(at) => i64::from((u32::from(a.word(at)) | u32::from(a.word(at + 16)) << 16) as i32),
        }
    }

    pub(crate) fn of(operand: &Operand, a: &Slc) -> Option<Source> {
        match operand {
            Operand::Constant(constant) => constant.as_integer().map(Source::Constant),
            Operand::Address(address) if address.is_direct() => match a.place(&address.to_string()).ok()? {
                (at, Kind::Word) => Some(Source::Word(at)),
                (at, Kind::Long) => Some(Source::Long(at)),
                _ => None,
            },
            _ => None,
        }
    }
}

/// Looked at after every scan until it has shown everything.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Monitor {
    /// A done bit, with the numbers of the goals done and not done.
    Done(u32, usize, usize),
    /// A comparison, with the number of its first goal: equal, below, above.
    Compare(Source, Source, usize),
}

/// All goals and what was reached of them.
#[derive(Debug)]
pub(crate) struct Goals {
    pub(crate) all: Vec<Goal>,
    /// Slot of the first instruction by program file and rung.
    rungs: Vec<Vec<u32>>,
    /// Per slot: what was not seen yet, as bits of [`PASSES`] and so on.
    open: Vec<u8>,
    /// Per slot the goal of each of the four bits.
    numbers: Vec<[u32; 4]>,
    /// Open bits by program file and rung: a rung without is not watched any more.
    left: Vec<Vec<u32>>,
    monitors: Vec<Monitor>,
    /// A contact that saw a done bit: it was on, whatever it is at the end of the scan.
    implied: BTreeMap<u32, Vec<u32>>,
    /// Goals reached since somebody asked last.
    pub(crate) fresh: Vec<u32>,
}

const PASSES: u8 = 1;
const BLOCKS: u8 = 2;
const TRUE: u8 = 4;
const FALSE: u8 = 8;
const NONE: u32 = u32::MAX;

/// Instructions that only mark a place.
const MARKERS: [&str; 5] = ["LBL", "SBR", "INT", "END", "NOP"];

/// Whether an instruction stands as a condition in its rung.
pub(crate) fn is_condition(instruction: &Instruction, family: ladder::Family) -> bool {
    let Some(known) = instruction.mnemonic.name().and_then(instr::by_mnemonic) else { return false };
    let form = known.form_for(family, instruction.operands.len()).or_else(|| known.forms.first());
    form.is_some_and(|form| form.position == instr::Position::Input)
}

impl Goals {
    pub(crate) fn new(image: &Image, xref: &CrossReference<'_>, a: &Slc) -> Goals {
        let calls = CallGraph::build(image, &image.documentation);
        let mut goals = Goals {
            all: Vec::new(),
            rungs: Vec::new(),
            open: Vec::new(),
            numbers: Vec::new(),
            left: Vec::new(),
            monitors: Vec::new(),
            implied: BTreeMap::new(),
            fresh: Vec::new(),
        };
        let mut contacts: Vec<(u32, u32)> = Vec::new();
        let constant = constant_bits(xref, a);
        for file in image.ladder_files() {
            let dead = calls.file(file.number).is_some_and(|called| !called.reachable);
            let zones = file.rungs.iter().flat_map(|rung| rung.instructions()).any(|it| it.mnemonic == "MCR");
            for (number, rung) in (0..).zip(&file.rungs) {
                let mut walk = Walk {
                    contacts: &mut contacts,
                    goals: &mut goals,
                    a,
                    constant: &constant,
                    family: image.family(),
                    file: file.number,
                    rung: number,
                    instruction: 0,
                    dead,
                    zones,
                };
                let base = walk.goals.open.len() as u32;
                walk.series(&rung.series, true, &mut BTreeMap::new());
                let open = goals.open.iter().skip(base as usize).map(|open| open.count_ones()).sum();
                let index = usize::from(file.number);
                if goals.rungs.len() <= index {
                    goals.rungs.resize(index + 1, Vec::new());
                    goals.left.resize(index + 1, Vec::new());
                }
                if let (Some(rungs), Some(left)) = (goals.rungs.get_mut(index), goals.left.get_mut(index)) {
                    rungs.push(base);
                    left.push(open);
                }
            }
        }
        for monitor in &goals.monitors {
            if let Monitor::Done(at, done, _) = monitor {
                for (_, contact) in contacts.iter().filter(|contact| contact.0 == *at) {
                    goals.implied.entry(*contact).or_default().push(*done as u32);
                }
            }
        }
        goals
    }

    fn add(&mut self, location: Location, kind: GoalKind, text: &str, impossible: Option<&'static str>) -> u32 {
        let number = self.all.len() as u32;
        let impossible = impossible.map(str::to_owned);
        self.all.push(Goal { location, kind, text: text.to_owned(), impossible, reached: false });
        number
    }

    fn reach(&mut self, number: u32) {
        if let Some(goal) = self.all.get_mut(number as usize)
            && !goal.reached
        {
            goal.reached = true;
            self.fresh.push(number);
            for done in self.implied.get(&number).cloned().unwrap_or_default() {
                self.reach(done);
            }
        }
    }

    /// Looks at timers and comparisons after a scan.
    pub(crate) fn look(&mut self, a: &Slc) {
        let mut index = 0;
        while let Some(monitor) = self.monitors.get(index).copied() {
            let finished = match monitor {
                Monitor::Done(at, done, not) => {
                    let number = if a.bit(at) { done } else { not };
                    self.reach(number as u32);
                    self.is_reached(done) && self.is_reached(not)
                }
                Monitor::Compare(x, y, first) => {
                    match x.value(a) - y.value(a) {
                        0 => self.reach(first as u32),
                        -1 => self.reach(first as u32 + 1),
                        1 => self.reach(first as u32 + 2),
                        _ => {}
                    }
                    (first..first + 3).all(|goal| self.is_reached(goal))
                }
            };
            if finished {
                self.monitors.swap_remove(index);
            } else {
                index += 1;
            }
        }
    }

    /// What is looked at behind every scan.
    pub(crate) fn monitors(&self) -> &[Monitor] {
        &self.monitors
    }

    /// Goals at contacts that reach this goal with them.
    pub(crate) fn contacts_of(&self, number: usize) -> impl Iterator<Item = u32> {
        let with = move |(_, reached): &(&u32, &Vec<u32>)| reached.iter().any(|one| *one as usize == number);
        self.implied.iter().filter(with).map(|(contact, _)| *contact)
    }

    fn is_reached(&self, number: usize) -> bool {
        self.all.get(number).is_none_or(|goal| goal.reached)
    }

    /// Something of the rungs was not seen yet.
    pub(crate) fn rungs_open(&self) -> bool {
        self.left.iter().flatten().any(|left| *left > 0)
    }
}

impl Trace for Goals {
    #[inline]
    fn wants(&self, file: u16, rung: u16) -> bool {
        self.left.get(usize::from(file)).and_then(|left| left.get(usize::from(rung))).is_some_and(|left| *left > 0)
    }

    #[inline]
    fn flow(&mut self, flow: PowerFlow) {
        let base = self.rungs.get(usize::from(flow.file)).and_then(|rungs| rungs.get(usize::from(flow.rung)));
        let Some(base) = base.copied() else { return };
        let slot = (base + u32::from(flow.instruction)) as usize;
        let now = match (flow.before, flow.after) {
            (true, true) => PASSES | TRUE,
            (true, false) => BLOCKS | TRUE,
            _ => FALSE,
        };
        let Some(open) = self.open.get_mut(slot) else { return };
        let new = *open & now;
        if new == 0 {
            return;
        }
        *open &= !new;
        if let Some(left) =
            self.left.get_mut(usize::from(flow.file)).and_then(|left| left.get_mut(usize::from(flow.rung)))
        {
            *left = left.saturating_sub(new.count_ones());
        }
        let numbers = self.numbers.get(slot).copied().unwrap_or([NONE; 4]);
        for (bit, number) in numbers.into_iter().enumerate() {
            if new >> bit & 1 != 0 {
                self.reach(number);
            }
        }
    }
}

/// One rung on the way to its goals.
struct Walk<'g> {
    /// Bits that were on when a goal is reached.
    contacts: &'g mut Vec<(u32, u32)>,
    goals: &'g mut Goals,
    a: &'g Slc,
    constant: &'g BTreeMap<u32, bool>,
    family: ladder::Family,
    file: u16,
    rung: u32,
    instruction: u32,
    /// The file is never executed.
    dead: bool,
    /// The file has MCR zones: every rung can be without power.
    zones: bool,
}

impl Walk<'_> {
    /// `always`: nothing before can take power away. `known`: bits that are on or off wherever power is.
    /// Answers whether power can be lost behind the series.
    fn series(&mut self, series: &Series, mut always: bool, known: &mut BTreeMap<u32, bool>) -> bool {
        for element in series {
            match element {
                Element::Instruction(instruction) => always = self.one(instruction, always, known),
                Element::Branch(branch) => {
                    let mut kept = branch.legs.is_empty() && always;
                    let mut begins = known.clone();
                    for leg in &branch.legs {
                        kept |= self.series(leg, always, &mut begins.clone());
                        // The next leg is executed behind this one.
                        if !leg.iter().all(|element| self.reads_only(element)) {
                            begins.clear();
                        }
                    }
                    // A leg can have changed what was known.
                    let writes = branch.legs.iter().flatten().any(|e| !self.reads_only(e));
                    if writes {
                        known.clear();
                    }
                    always = kept;
                }
            }
        }
        always
    }

    fn reads_only(&self, element: &Element) -> bool {
        match element {
            Element::Instruction(it) => it.mnemonic == "XIC" || it.mnemonic == "XIO",
            Element::Branch(branch) => branch.legs.iter().flatten().all(|element| self.reads_only(element)),
        }
    }

    fn one(&mut self, instruction: &Instruction, always: bool, known: &mut BTreeMap<u32, bool>) -> bool {
        let location = Location { file: self.file, rung: self.rung, instruction: self.instruction };
        self.instruction += 1;
        let text = spelled(instruction);
        let dead = self.dead.then_some("the program file is never called");
        let mut open = 0;
        let mut numbers = [NONE; 4];
        let mut still = always;
        if MARKERS.iter().any(|marker| instruction.mnemonic == *marker) {
            // Nothing to reach.
        } else if is_condition(instruction, self.family) {
            let contact = self.contact(instruction);
            let (mut passes, mut blocks) = (dead, dead);
            if let Some((at, wanted)) = contact {
                let fixed = known.get(&at).map(|on| (*on, "an earlier contact of the same bit decides it"));
                let fixed = fixed.or_else(|| {
                    self.constant.get(&at).map(|on| (*on, "nothing writes the bit and nobody can: it is no input"))
                });
                match fixed {
                    Some((on, why)) if on == wanted => blocks = blocks.or(Some(why)),
                    Some((_, why)) => passes = passes.or(Some(why)),
                    None => {}
                }
                known.insert(at, wanted);
            } else {
                known.retain(|_, _| self.keeps(instruction));
            }
            still = always && blocks.is_some() && dead.is_none();
            numbers[0] = self.goals.add(location, GoalKind::Passes, &text, passes);
            numbers[1] = self.goals.add(location, GoalKind::Blocks, &text, blocks);
            open = PASSES | BLOCKS;
            if let Some((at, wanted)) = contact {
                self.contacts.push((at, numbers[usize::from(!wanted)]));
            }
            self.boundaries(location, instruction, &text, dead);
        } else {
            known.clear();
            let without = "no condition stands before it";
            let never = (always && !self.zones).then_some(without);
            numbers[2] = self.goals.add(location, GoalKind::True, &text, dead);
            numbers[3] = self.goals.add(location, GoalKind::False, &text, dead.or(never));
            open = TRUE | FALSE;
            self.done(location, instruction, &text, dead);
        }
        self.goals.open.push(open);
        self.goals.numbers.push(numbers);
        still
    }

    /// Conditions that store nothing.
    fn keeps(&self, instruction: &Instruction) -> bool {
        !matches!(instruction.mnemonic.name(), Some("ONS" | "OSR" | "OSF"))
    }

    fn contact(&self, instruction: &Instruction) -> Option<(u32, bool)> {
        let wanted = match instruction.mnemonic.name() {
            Some("XIC") => true,
            Some("XIO") => false,
            _ => return None,
        };
        let address = instruction.operands.first()?.address().filter(|address| address.is_direct())?;
        Some((self.a.place(&address.to_string()).ok()?.0, wanted))
    }

    fn boundaries(&mut self, location: Location, it: &Instruction, text: &str, dead: Option<&'static str>) {
        let pairs: &[(usize, usize)] = match it.mnemonic.name() {
            Some("EQU" | "NEQ" | "LES" | "LEQ" | "GRT" | "GEQ") => &[(0, 1)],
            Some("LIM") => &[(1, 0), (1, 2)],
            _ => return,
        };
        for (x, y) in pairs {
            let source = |index: usize| it.operands.get(index).and_then(|operand| Source::of(operand, self.a));
            let (Some(x), Some(y)) = (source(*x), source(*y)) else { continue };
            if matches!((x, y), (Source::Constant(_), Source::Constant(_))) {
                continue;
            }
            let first = self.goals.all.len();
            for kind in [GoalKind::Equal, GoalKind::JustBelow, GoalKind::JustAbove] {
                self.goals.add(location, kind, text, dead);
            }
            // Values can be equal without anybody comparing them.
            if dead.is_none() {
                self.goals.monitors.push(Monitor::Compare(x, y, first));
            }
        }
    }

    fn done(&mut self, location: Location, it: &Instruction, text: &str, dead: Option<&'static str>) {
        if !matches!(it.mnemonic.name(), Some("TON" | "TOF" | "RTO" | "CTU" | "CTD")) {
            return;
        }
        let address = it.operands.first().and_then(Operand::address).filter(|address| address.is_direct());
        let place = address.and_then(|address| self.a.place(&address.clone().with_bit(13).to_string()).ok());
        if let Some((at, _)) = place {
            let done = self.goals.add(location, GoalKind::Done, text, dead);
            let not = self.goals.add(location, GoalKind::NotDone, text, dead);
            if dead.is_none() {
                self.goals.monitors.push(Monitor::Done(at, done as usize, not as usize));
            }
        }
    }
}

/// An instruction with its operands.
pub(crate) fn spelled(instruction: &Instruction) -> String {
    let mut text = instruction.mnemonic.to_string();
    for operand in &instruction.operands {
        text.push(' ');
        text.push_str(&operand.to_string());
    }
    text
}

/// Bits that contacts read, that nothing writes, and that no input can be: their present values.
fn constant_bits(xref: &CrossReference<'_>, a: &Slc) -> BTreeMap<u32, bool> {
    let mut constant = BTreeMap::new();
    let mut seen = BTreeSet::new();
    for address in xref.named() {
        // Status bits and function files belong to the controller; B, N and I to people and the machine.
        if !matches!(address.file_type, FileType::T | FileType::C | FileType::R) || !address.is_direct() {
            continue;
        }
        let Ok((at, Kind::Bit)) = a.place(&address.to_string()) else { continue };
        if seen.insert(at) && !xref.of(address).iter().any(|access| access.role.writes()) {
            constant.insert(at, a.bit(at));
        }
    }
    constant
}
