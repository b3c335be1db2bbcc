//! Every timer and counter: parameters, seconds, live values, and the rungs that use it.
//!
//! Preset and accumulated value stand in two places. The element in the data table is what the
//! processor works with; the box shows a copy of it. Only in an instruction that was never verified
//! the box holds what was entered, and verifying it writes that into the element.

use std::collections::BTreeSet;

use instr::{Kind, Role};
use ladder::{Address, FileType, Image, Instruction, Target, TimeBase, Value};

use crate::location::{Location, instructions};
use crate::space::{Area, OPEN};
use crate::xref::{Certainty, CrossReference, certainty, joined_role};

/// Timers and counters of an image.
#[derive(Clone, Debug, Default)]
pub struct TimerReport {
    /// Elements that are timed, counted, read, written or reset, or that have a preset; by address.
    pub elements: Vec<TimerCounter>,
    /// What deserves a look, by address.
    pub findings: Vec<TimerFinding>,
    /// Timer and counter instructions whose element is decided at run time or not known.
    pub elsewhere: Vec<InstructionValues>,
}

/// One timer or counter element.
#[derive(Clone, Debug)]
pub struct TimerCounter {
    /// `T4:0`, `C5:3`.
    pub address: Address,
    /// Timer or counter.
    pub kind: ElementKind,
    /// What the program does with it.
    pub usage: Usage,
    /// Symbol.
    pub symbol: Option<String>,
    /// Description lines.
    pub description: Vec<String>,
    /// The instructions that time or count with it, in program order.
    pub instructions: Vec<InstructionValues>,
    /// The element of the data table; `None` if the data file does not reach that far.
    pub data: Option<DataValues>,
    /// Time base in force; `None` for counters and where nothing tells.
    pub base: Option<TimeBase>,
    /// Preset in force, in ticks or counts: the data table's, or the instruction's as long as no
    /// instruction with the element was verified.
    pub preset: Option<i32>,
    /// Accumulated value in force, as `preset`.
    pub accum: Option<i32>,
    /// Reads, bits and members told apart.
    pub read_by: Vec<Reference>,
    /// Resets.
    pub reset_by: Vec<Reference>,
    /// Other writes: to a preset, a copy over the element.
    pub written_by: Vec<Reference>,
}

impl TimerCounter {
    /// Preset in seconds as exact decimal text: 5000 ticks of 0.01 s are `50`.
    pub fn preset_seconds(&self) -> Option<String> {
        Some(self.base?.seconds_text(self.preset?))
    }

    /// Accumulated time in seconds.
    pub fn accum_seconds(&self) -> Option<String> {
        Some(self.base?.seconds_text(self.accum?))
    }

    /// Mnemonics of the instructions that time or count with it, each once.
    pub fn mnemonics(&self) -> Vec<&'static str> {
        let mut all: Vec<_> = self.instructions.iter().map(|it| it.mnemonic).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// Timer or counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ElementKind {
    /// In a T file.
    Timer,
    /// In a C file.
    Counter,
}

/// What a program does with an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Usage {
    /// An instruction times or counts with it.
    Active,
    /// Read, written or reset, never timed or counted.
    ReferencedOnly,
    /// Has a preset in the data table and nothing refers to it.
    ConfiguredOnly,
}

/// What a timer or counter instruction shows.
#[derive(Clone, Debug)]
pub struct InstructionValues {
    /// Where.
    pub location: Location,
    /// TON, TOF, RTO, CTU, CTD, HSC.
    pub mnemonic: &'static str,
    /// The element as written.
    pub address: String,
    /// Time base.
    pub base: Option<TimeBase>,
    /// Preset text as a number.
    pub preset: Option<i32>,
    /// Accum text as a number.
    pub accum: Option<i32>,
    /// Verified; `false`: its texts are the program, not the data table.
    pub compiled: bool,
}

/// An element of the data table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DataValues {
    /// The whole control word.
    pub control: u16,
    /// Time base of a timer's control word.
    pub base: Option<TimeBase>,
    /// Preset.
    pub preset: i16,
    /// Accumulated value.
    pub accum: i16,
}

impl DataValues {
    /// The state bits of the control word by name, in display order: EN TT DN or CU CD DN OV UN UA.
    pub fn bits(self, kind: ElementKind) -> impl Iterator<Item = (&'static str, bool)> {
        let names: &'static [&'static str] = match kind {
            ElementKind::Timer => &["EN", "TT", "DN"],
            ElementKind::Counter => &["CU", "CD", "DN", "OV", "UN", "UA"],
        };
        let control = self.control;
        names.iter().zip((0..16).rev()).map(move |(name, bit)| (*name, control >> bit & 1 != 0))
    }
}

/// A rung that refers to an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reference {
    /// Where.
    pub location: Location,
    /// Mnemonic.
    pub mnemonic: String,
    /// Operand name as in the box.
    pub operand: &'static str,
    /// The operand as written.
    pub written: String,
    /// Parts of the element it touches: `DN`, `PRE`, `ACC/3`; empty when it is the whole element.
    pub members: Vec<String>,
    /// Read, written or both.
    pub role: Role,
    /// Whether it happens.
    pub certainty: Certainty,
}

/// Something about an element that deserves a look.
#[derive(Clone, Debug)]
pub struct TimerFinding {
    /// The element.
    pub address: Address,
    /// What.
    pub kind: TimerFindingKind,
    /// The rungs it is about.
    pub locations: Vec<Location>,
}

/// What deserves a look.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TimerFindingKind {
    /// Several instructions time or count with it. CTU with CTD on one counter is not meant: that is
    /// an up/down counter.
    SeveralInstructions,
    /// Preset 0, and nothing writes it.
    PresetNeverSet,
    /// Preset or accumulated value below 0: a running timer stops the processor with fault 0034.
    Negative,
    /// A verified instruction shows another preset, accumulated value or base than the data table.
    DiffersFromData,
    /// The data table does not have the element.
    NoElement,
    /// Only read: it never starts.
    OnlyRead,
    /// RTO, CTU or CTD that nothing resets and whose ACC nothing writes.
    NeverReset,
    /// RES on a TOF: the manuals call the result unpredictable.
    ResetOfOffDelay,
    /// Timed or counted, and nothing looks at it.
    NeverRead,
    /// Preset in the data table, no use in the program.
    Unused,
}

impl TimerFindingKind {
    /// The finding in words.
    pub fn as_str(self) -> &'static str {
        match self {
            TimerFindingKind::SeveralInstructions => "used by several timer or counter instructions",
            TimerFindingKind::PresetNeverSet => "preset is 0 and nothing writes it",
            TimerFindingKind::Negative => "preset or accumulated value below 0",
            TimerFindingKind::DiffersFromData => "instruction and data table differ",
            TimerFindingKind::NoElement => "not in the data table",
            TimerFindingKind::OnlyRead => "only read, never timed or counted",
            TimerFindingKind::NeverReset => "never reset",
            TimerFindingKind::ResetOfOffDelay => "RES on a TOF",
            TimerFindingKind::NeverRead => "never read",
            TimerFindingKind::Unused => "has a preset, not used",
        }
    }
}

impl TimerReport {
    /// Collects the timers and counters of an image from its cross reference, which must be of the
    /// same image.
    pub fn build(image: &Image, xref: &CrossReference<'_>) -> TimerReport {
        let mut report = TimerReport::default();
        let mut addresses: BTreeSet<(u16, FileType, u16)> = BTreeSet::new();
        let mut active = Vec::new();
        for (location, instruction) in instructions(image) {
            let Some((mnemonic, at)) = timing(instruction) else { continue };
            let operand = instruction.operands.get(at);
            let element = operand.and_then(|operand| xref.resolve(operand));
            let values = values_of(location, mnemonic, instruction);
            match element.filter(Address::is_direct).and_then(|address| key_of(&address)) {
                Some(key) => {
                    addresses.insert(key);
                    active.push((key, values));
                }
                None => report.elsewhere.push(values),
            }
        }
        active.sort_by_key(|(key, values)| (*key, values.location));
        for address in xref.named() {
            addresses.extend(key_of(address));
        }
        for file in image.data_files.iter().filter(|f| matches!(f.file_type, FileType::T | FileType::C)) {
            for element in 0..file.elements {
                // Elements in the middle of a copied range and those with a preset.
                let area = xref.place(&Address::element(file.file_type, file.number, element));
                let touched = || area.is_some_and(|area| xref.overlapping(area).iter().any(|span| span.definite));
                let preset = file.element_words(element).and_then(|words| words.get(1)).is_some_and(|pre| *pre != 0);
                if preset || touched() {
                    addresses.insert((file.number, file.file_type, element));
                }
            }
        }
        for key in addresses {
            let start = active.partition_point(|(other, _)| *other < key);
            let own = active.iter().skip(start).take_while(|(other, _)| *other == key);
            let element = element(image, xref, key, own.map(|(_, values)| values.clone()).collect());
            report.findings.extend(findings(&element));
            report.elements.push(element);
        }
        report
    }

    /// Elements that an instruction times or counts with.
    pub fn active(&self) -> impl Iterator<Item = &TimerCounter> {
        self.elements.iter().filter(|element| element.usage == Usage::Active)
    }
}

fn key_of(address: &Address) -> Option<(u16, FileType, u16)> {
    let timed = matches!(address.file_type, FileType::T | FileType::C);
    timed.then_some((address.file.number()?, address.file_type, address.element.number()?))
}

/// Mnemonic and index of the timer or counter operand, if the instruction times or counts.
fn timing(instruction: &Instruction) -> Option<(&'static str, usize)> {
    let known = instr::by_mnemonic(instruction.mnemonic.name()?)?;
    let form = known.forms.iter().find(|form| form.operands.len() == instruction.operands.len())?;
    let at = form.operands.iter().position(|operand| {
        matches!(operand.kind, Kind::Timer | Kind::Counter)
            && operand.role == Role::ReadWrite
            && !operand.touches.is_empty()
    })?;
    Some((known.mnemonic, at))
}

fn values_of(location: Location, mnemonic: &'static str, instruction: &Instruction) -> InstructionValues {
    let form = instr::by_mnemonic(mnemonic)
        .and_then(|known| known.forms.iter().find(|form| form.operands.len() == instruction.operands.len()));
    let operand = |kind: &[Kind]| {
        let at = form?.operands.iter().position(|operand| kind.contains(&operand.kind))?;
        instruction.operands.get(at)
    };
    let number = |kind| operand(&[kind])?.constant()?.as_integer().and_then(|n| i32::try_from(n).ok());
    InstructionValues {
        location,
        mnemonic,
        address: operand(&[Kind::Timer, Kind::Counter]).map(ToString::to_string).unwrap_or_default(),
        base: operand(&[Kind::TimeBase]).and_then(|base| TimeBase::from_text(&base.to_string())),
        preset: number(Kind::Preset),
        accum: number(Kind::Accum),
        compiled: instruction.compiled,
    }
}

fn element(
    image: &Image,
    xref: &CrossReference<'_>,
    (file, file_type, number): (u16, FileType, u16),
    instructions: Vec<InstructionValues>,
) -> TimerCounter {
    let address = Address::element(file_type, file, number);
    let data = match image.data_file(file_type, file).and_then(|file| file.value(number)) {
        Some(Value::Timer(t)) => Some(DataValues { control: t.control, base: t.base(), preset: t.pre, accum: t.acc }),
        Some(Value::Counter(c)) => Some(DataValues { control: c.control, base: None, preset: c.pre, accum: c.acc }),
        _ => None,
    };
    // The last entered text stands until an instruction with the element is verified.
    let entered = instructions.iter().rev().find(|it| !it.compiled);
    let from_text = entered.filter(|_| data.is_none() || !instructions.iter().any(|it| it.compiled));
    let any_text = instructions.last();
    let (base, preset, accum) = match (from_text, data) {
        (Some(text), data) => (
            text.base.or(data.and_then(|d| d.base)),
            text.preset.or(data.map(|d| d.preset.into())),
            text.accum.or(data.map(|d| d.accum.into())),
        ),
        (None, Some(data)) => {
            (data.base.or(any_text.and_then(|it| it.base)), Some(data.preset.into()), Some(data.accum.into()))
        }
        (None, None) => {
            (any_text.and_then(|it| it.base), any_text.and_then(|it| it.preset), any_text.and_then(|it| it.accum))
        }
    };
    let (read_by, reset_by, written_by) = references(xref, &address);
    let definite = |all: &[Reference]| all.iter().any(|it| it.certainty == Certainty::Definite);
    let usage = if !instructions.is_empty() {
        Usage::Active
    } else if definite(&read_by) || definite(&reset_by) || definite(&written_by) {
        Usage::ReferencedOnly
    } else {
        Usage::ConfiguredOnly
    };
    let shown = xref.documentation().shown(&Target::Address(address.clone()), "");
    TimerCounter {
        kind: if file_type == FileType::T { ElementKind::Timer } else { ElementKind::Counter },
        usage,
        symbol: shown.symbol,
        description: shown.description,
        instructions,
        data,
        base: base.filter(|_| file_type == FileType::T),
        preset,
        accum,
        read_by,
        reset_by,
        written_by,
        address,
    }
}

/// Reads, resets and writes of an element by other instructions than those that time it.
fn references(xref: &CrossReference<'_>, element: &Address) -> (Vec<Reference>, Vec<Reference>, Vec<Reference>) {
    let (mut read, mut reset, mut written) = (Vec::new(), Vec::new(), Vec::new());
    let Some(area) = xref.place(element) else { return (read, reset, written) };
    let mut spans = xref.overlapping(area);
    spans.sort_by_key(|span| (span.by, span.area.first));
    for spans in spans.chunk_by(|a, b| a.by == b.by) {
        let Some(it) = spans.first().and_then(|span| xref.use_of(span)) else { continue };
        let role = joined_role(spans.iter().map(|span| span.role));
        let mut reference = Reference {
            location: it.location,
            mnemonic: it.mnemonic.to_string(),
            operand: it.operand,
            written: it.symbol.map_or_else(|| it.address.to_string(), str::to_owned),
            members: spans.iter().flat_map(|span| members(span.area, area, element.file_type)).collect(),
            role,
            certainty: certainty(spans.iter().any(|span| span.definite)),
        };
        reference.members.dedup();
        match it.kind {
            Some(Kind::Timer | Kind::Counter) => {}
            Some(Kind::Resettable) => reset.push(reference),
            _ if role.writes() => written.push(reference),
            _ => read.push(reference),
        }
    }
    for all in [&mut read, &mut reset, &mut written] {
        all.sort_by_key(|it| (it.certainty, it.location));
    }
    (read, reset, written)
}

/// The parts of an element inside an area, nothing when it is all of it.
fn members(area: Area, element: Area, file_type: FileType) -> Vec<String> {
    let (first, end) = match area.part {
        Some(part) => (part.offset, part.offset + part.bits),
        None if area.bits == OPEN && area.first <= element.first => return Vec::new(),
        None => {
            let first = area.first.max(element.first) - element.first;
            (first, area.end().min(element.end()).saturating_sub(element.first))
        }
    };
    if first == 0 && end >= 48 {
        return Vec::new();
    }
    let word_names = ["", "PRE", "ACC"];
    (0..3)
        .zip(word_names)
        .filter_map(|(word, name)| {
            let (low, high) = (first.max(word * 16), end.min((word + 1) * 16));
            if low >= high {
                return None;
            }
            let bit = u16::try_from(low - word * 16).ok()?;
            Some(match (high - low, word) {
                (1, 0) => Address::element(file_type, 0, 0)
                    .with_bit(bit)
                    .member()
                    .map_or_else(|| bit.to_string(), str::to_owned),
                (1, _) => format!("{name}/{bit}"),
                (_, 0) => "control word".to_owned(),
                _ => name.to_owned(),
            })
        })
        .collect()
}

fn findings(element: &TimerCounter) -> Vec<TimerFinding> {
    use TimerFindingKind as K;
    let mut found = Vec::new();
    let own: Vec<Location> = element.instructions.iter().map(|it| it.location).collect();
    let mut add = |kind, locations: &[Location]| {
        found.push(TimerFinding { address: element.address.clone(), kind, locations: locations.to_vec() });
    };
    let places = |all: &[Reference]| all.iter().map(|it| it.location).collect::<Vec<_>>();
    let touches = |all: &[Reference], member: &str| {
        all.iter().any(|it| it.role.writes() && (it.members.is_empty() || it.members.iter().any(|m| m == member)))
    };
    if own.len() > 1 && !is_up_down(element) {
        add(K::SeveralInstructions, &own);
    }
    match element.usage {
        Usage::ConfiguredOnly => add(K::Unused, &[]),
        Usage::ReferencedOnly if element.written_by.is_empty() && element.reset_by.is_empty() => {
            add(K::OnlyRead, &places(&element.read_by));
        }
        Usage::ReferencedOnly => {}
        Usage::Active => {
            if element.preset == Some(0) && !touches(&element.written_by, "PRE") {
                add(K::PresetNeverSet, &own);
            }
            let retentive = element.mnemonics().iter().any(|m| matches!(*m, "RTO" | "CTU" | "CTD"));
            if retentive && element.reset_by.is_empty() && !touches(&element.written_by, "ACC") {
                add(K::NeverReset, &own);
            }
            if element.mnemonics().contains(&"TOF") && !element.reset_by.is_empty() {
                add(K::ResetOfOffDelay, &places(&element.reset_by));
            }
            if element.read_by.is_empty() && !element.written_by.iter().any(|it| it.role.reads()) {
                add(K::NeverRead, &own);
            }
        }
    }
    if element.usage != Usage::ConfiguredOnly && element.data.is_none() {
        let mut all = own.clone();
        all.extend(places(&element.read_by));
        add(K::NoElement, &all);
    }
    let negative = element.preset.is_some_and(|n| n < 0) || element.accum.is_some_and(|n| n < 0);
    if negative && element.kind == ElementKind::Timer {
        add(K::Negative, &own);
    }
    if let Some(data) = element.data {
        let differs = |it: &&InstructionValues| {
            it.compiled
                && (it.preset.is_some_and(|n| n != i32::from(data.preset))
                    || it.accum.is_some_and(|n| n != i32::from(data.accum))
                    || (it.base.is_some() && data.base.is_some() && it.base != data.base))
        };
        let all: Vec<Location> = element.instructions.iter().filter(differs).map(|it| it.location).collect();
        if !all.is_empty() {
            add(K::DiffersFromData, &all);
        }
    }
    found.sort_by_key(|finding| finding.kind);
    found
}

/// Counted up in one place and down in another.
fn is_up_down(element: &TimerCounter) -> bool {
    let count = |mnemonic| element.instructions.iter().filter(|it| it.mnemonic == mnemonic).count();
    count("CTU") == 1 && count("CTD") == 1 && element.instructions.len() == 2
}
