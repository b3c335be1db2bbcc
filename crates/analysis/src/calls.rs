//! Which program file runs because of which rung or interrupt, and which labels are jumped to.

use std::collections::{BTreeMap, BTreeSet};

use ladder::{Documentation, Family, FileType, Image, Operand, ProgramFileKind, Target as Documented, Value};

use crate::location::{Location, instructions};
use crate::xref::Symbols;

/// Calls, interrupts and labels of an image.
#[derive(Clone, Debug, Default)]
pub struct CallGraph {
    /// Every JSR, in program order.
    pub calls: Vec<Call>,
    /// Every ladder file, ascending.
    pub files: Vec<CalledFile>,
    /// Every label that is defined or jumped to, by file and number.
    pub labels: Vec<Label>,
}

/// One JSR.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Call {
    /// Where.
    pub location: Location,
    /// What it calls.
    pub target: Target,
}

/// What a JSR calls.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// A program file with ladder.
    File(u16),
    /// A file number without ladder.
    Missing(u16),
    /// The operand does not say: kept as it is.
    Unknown(String),
}

/// A ladder file and what makes it run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CalledFile {
    /// File number.
    pub number: u16,
    /// Name, often empty.
    pub name: String,
    /// Rungs, END included.
    pub rungs: usize,
    /// JSR instructions that name it, in program order.
    pub called_by: Vec<Location>,
    /// What the processor itself runs it for.
    pub entries: Vec<Entry>,
    /// It can run: from file 2 or an entry, through any number of calls. A file that only files that
    /// cannot run call is not reachable.
    pub reachable: bool,
}

impl CalledFile {
    /// No JSR names it, and it is not the main program. An interrupt can still start it: see `entries`.
    pub fn is_never_called(&self) -> bool {
        self.called_by.is_empty() && !self.entries.iter().any(|entry| entry.kind == EntryKind::Main)
    }
}

/// What a processor runs a program file for, without a call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The occasion.
    pub kind: EntryKind,
    /// Where the file number stands: `S:29`, `STI:0.PFN`; empty where the processor fixes it.
    pub source: String,
}

/// Occasions on which a processor starts a program file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum EntryKind {
    /// File 2, every scan.
    Main,
    /// User fault routine.
    Fault,
    /// Selectable timed interrupt.
    TimedInterrupt,
    /// Discrete input interrupt.
    DiscreteInputInterrupt,
    /// Event input interrupt.
    EventInputInterrupt,
    /// High-speed counter interrupt.
    HighSpeedCounter,
    /// A file the processor keeps for itself.
    Reserved,
}

impl EntryKind {
    /// The occasion in words.
    pub fn as_str(self) -> &'static str {
        match self {
            EntryKind::Main => "main program",
            EntryKind::Fault => "fault routine",
            EntryKind::TimedInterrupt => "selectable timed interrupt",
            EntryKind::DiscreteInputInterrupt => "discrete input interrupt",
            EntryKind::EventInputInterrupt => "event input interrupt",
            EntryKind::HighSpeedCounter => "high-speed counter interrupt",
            EntryKind::Reserved => "reserved by the processor",
        }
    }
}

/// A label and its jumps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Program file.
    pub file: u16,
    /// Label number.
    pub number: u16,
    /// LBL instructions with this number in this file: exactly one in a program that runs.
    pub defined: Vec<Location>,
    /// JMP instructions to it.
    pub jumps: Vec<Location>,
}

impl CallGraph {
    /// Walks through an image; the documentation resolves symbols in rungs that were never verified.
    ///
    /// Interrupt routines that a SLC 500 assigns to the slots of modules stand in the modules'
    /// configuration and are not known here: such a file looks never called.
    pub fn build(image: &Image, documentation: &Documentation) -> CallGraph {
        let symbols = Symbols::new(documentation);
        let mut graph = CallGraph::default();
        let mut labels: BTreeMap<(u16, u16), Label> = BTreeMap::new();
        for (location, instruction) in instructions(image) {
            let name = instruction.mnemonic.name().unwrap_or("");
            match name {
                "JSR" => {
                    let target = target(image, &symbols, instruction.operands.first());
                    graph.calls.push(Call { location, target });
                }
                "JMP" | "LBL" => {
                    let Some(number) = label(&symbols, instruction.operands.first()) else { continue };
                    let key = (location.file, number);
                    let entry = labels.entry(key).or_insert_with(|| Label {
                        file: location.file,
                        number,
                        defined: Vec::new(),
                        jumps: Vec::new(),
                    });
                    if name == "LBL" { entry.defined.push(location) } else { entry.jumps.push(location) }
                }
                _ => {}
            }
        }
        graph.labels = labels.into_values().collect();
        graph.files = called_files(image, &graph.calls);
        graph
    }

    /// Ladder files that no rung calls. Those with `entries` are routines of an interrupt or fault.
    pub fn never_called(&self) -> impl Iterator<Item = &CalledFile> {
        self.files.iter().filter(|file| file.is_never_called())
    }

    /// The ladder file with this number.
    pub fn file(&self, number: u16) -> Option<&CalledFile> {
        self.files.iter().find(|file| file.number == number)
    }
}

fn called_files(image: &Image, calls: &[Call]) -> Vec<CalledFile> {
    let mut called: BTreeMap<u16, Vec<Location>> = BTreeMap::new();
    let mut unknown_from: BTreeSet<u16> = BTreeSet::new();
    for call in calls {
        match &call.target {
            Target::File(number) => called.entry(*number).or_default().push(call.location),
            Target::Unknown(_) => {
                unknown_from.insert(call.location.file);
            }
            Target::Missing(_) => {}
        }
    }
    let entries = entries(image);
    let mut files: Vec<CalledFile> = image
        .ladder_files()
        .map(|file| CalledFile {
            number: file.number,
            name: file.name.clone(),
            rungs: file.rungs.len(),
            called_by: called.remove(&file.number).unwrap_or_default(),
            entries: entries.iter().filter(|(n, _)| *n == file.number).map(|(_, entry)| entry.clone()).collect(),
            reachable: false,
        })
        .collect();
    let mut targets: BTreeMap<u16, Vec<u16>> = BTreeMap::new();
    for file in &files {
        for caller in &file.called_by {
            targets.entry(caller.file).or_default().push(file.number);
        }
    }
    let started = files.iter().filter(|file| file.entries.iter().any(|e| e.kind != EntryKind::Reserved));
    let mut open: Vec<u16> = started.map(|file| file.number).collect();
    let mut reached: BTreeSet<u16> = BTreeSet::new();
    while let Some(number) = open.pop() {
        if reached.insert(number) {
            open.extend(targets.get(&number).into_iter().flatten());
        }
    }
    // A call whose target is not known could be to any file.
    let any = unknown_from.iter().any(|file| reached.contains(file));
    for file in &mut files {
        file.reachable = any || reached.contains(&file.number);
    }
    files
}

/// Files the processor starts, with the reason.
fn entries(image: &Image) -> Vec<(u16, Entry)> {
    let mut found = vec![(2, Entry { kind: EntryKind::Main, source: String::new() })];
    if image.family() == Family::MicroLogix1000 {
        // This controller has fixed routines, and file 16 for its own use.
        for (number, kind) in [
            (3, EntryKind::Fault),
            (4, EntryKind::HighSpeedCounter),
            (5, EntryKind::TimedInterrupt),
            (16, EntryKind::Reserved),
        ] {
            found.push((number, Entry { kind, source: String::new() }));
        }
        return found;
    }
    for (word, kind, applies) in STATUS_WORDS {
        if applies(image.family())
            && let Some(Value::Word(number)) = image.data_file(FileType::S, 2).and_then(|file| file.value(*word))
        {
            add_entry(&mut found, i32::from(number), *kind, format!("S:{word}"));
        }
    }
    for (file_type, kind) in [
        (FileType::STI, EntryKind::TimedInterrupt),
        (FileType::EII, EntryKind::EventInputInterrupt),
        (FileType::HSC, EntryKind::HighSpeedCounter),
    ] {
        let Some(file) = image.data_file(file_type, 0) else { continue };
        for element in 0..file.elements {
            // PFN is the first word of all three.
            if let Some(number) = file.element_words(element).and_then(|words| words.first()) {
                add_entry(&mut found, i32::from(*number), kind, format!("{file_type}:{element}.PFN"));
            }
        }
    }
    found
}

/// Families that have a status word.
type Applies = fn(Family) -> bool;

/// Status words that hold the number of a routine, where the processor has them.
const STATUS_WORDS: &[(u16, EntryKind, Applies)] = &[
    (29, EntryKind::Fault, |_| true),
    (31, EntryKind::TimedInterrupt, |family| !family.is_micrologix()),
    (46, EntryKind::DiscreteInputInterrupt, |family| !family.is_micrologix()),
];

fn add_entry(found: &mut Vec<(u16, Entry)>, number: i32, kind: EntryKind, source: String) {
    // Files 0 to 2 cannot be routines; 0 means none.
    if let Some(number) = u16::try_from(number).ok().filter(|number| *number > 2) {
        found.push((number, Entry { kind, source }));
    }
}

fn target(image: &Image, symbols: &Symbols<'_>, operand: Option<&Operand>) -> Target {
    let number = match operand {
        Some(Operand::ProgramFile(number)) => Some(*number),
        Some(Operand::Constant(constant)) => constant.as_integer().and_then(|number| u16::try_from(number).ok()),
        Some(Operand::Symbol(symbol)) => match symbols.resolve(symbol) {
            Some(Documented::ProgramFileOperand(number)) => Some(number),
            _ => None,
        },
        _ => None,
    };
    match number {
        Some(number) if image.program_file(number).is_some_and(|file| file.kind == ProgramFileKind::Ladder) => {
            Target::File(number)
        }
        Some(number) => Target::Missing(number),
        None => Target::Unknown(operand.map(ToString::to_string).unwrap_or_default()),
    }
}

fn label(symbols: &Symbols<'_>, operand: Option<&Operand>) -> Option<u16> {
    match operand? {
        // The file number that is stored can be stale: a label belongs to the file it stands in.
        Operand::Label { number, .. } => Some(*number),
        Operand::Constant(constant) => constant.as_integer().and_then(|number| u16::try_from(number).ok()),
        Operand::Symbol(symbol) => match symbols.resolve(symbol) {
            Some(Documented::Label { number, .. }) => Some(number),
            _ => None,
        },
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ladder::{DataFile, Element, Instruction, Mnemonic, ProgramFile, Rung};

    fn rung(mnemonic: &'static str, operands: &[&str]) -> Rung {
        let operands = operands.iter().map(|text| Operand::parse(text)).collect();
        Rung::new(vec![Element::Instruction(Instruction::new(Mnemonic::named(mnemonic), operands))])
    }

    fn file(number: u16, rungs: Vec<Rung>) -> ProgramFile {
        ProgramFile { number, name: String::new(), description: String::new(), kind: ProgramFileKind::Ladder, rungs }
    }

    #[test]
    fn calls_interrupts_and_what_is_left() {
        let mut image = Image {
            program_files: vec![
                file(2, vec![rung("JSR", &["U:3"]), rung("JSR", &["9"]), rung("JMP", &["Q0:7"])]),
                file(3, vec![rung("JSR", &["U:4"])]),
                file(4, vec![]),
                file(5, vec![rung("JSR", &["U:6"])]),
                file(6, vec![]),
                file(7, vec![rung("LBL", &["Q7:7"])]),
                file(8, vec![]),
            ],
            ..Image::default()
        };
        image.processor.family = Family::MicroLogix1400;
        let mut status = DataFile::new(FileType::S, 2, 66);
        status.words[29] = 7;
        status.words[31] = 8;
        image.data_files.push(status);
        let mut events = DataFile::new(FileType::EII, 0, 0);
        (events.elements, events.words_per_element, events.words) = (1, 4, vec![2, 0, 0, 0]);
        image.function_files.push(events);

        let graph = CallGraph::build(&image, &image.documentation);
        let targets: Vec<&Target> = graph.calls.iter().map(|call| &call.target).collect();
        assert_eq!(targets, [&Target::File(3), &Target::Missing(9), &Target::File(4), &Target::File(6)]);
        let never: Vec<u16> = graph.never_called().map(|file| file.number).collect();
        assert_eq!(never, [5, 7, 8]);
        let started: Vec<u16> = graph.never_called().filter(|f| !f.entries.is_empty()).map(|f| f.number).collect();
        assert_eq!(started, [7], "S:31 is no interrupt file of a MicroLogix, PFN 2 is none of any");
        let reachable: Vec<u16> = graph.files.iter().filter(|f| f.reachable).map(|f| f.number).collect();
        assert_eq!(reachable, [2, 3, 4, 7], "6 is called by a file that never runs");
        assert_eq!(graph.file(7).map(|f| f.entries[0].source.clone()).as_deref(), Some("S:29"));
        let labels: Vec<_> = graph.labels.iter().map(|l| (l.file, l.number, l.defined.len(), l.jumps.len())).collect();
        assert_eq!(labels, [(2, 7, 0, 1), (7, 7, 1, 0)], "a label belongs to the file it stands in");
    }
}
