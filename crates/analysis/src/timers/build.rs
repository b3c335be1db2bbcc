//! Collects timers and counters and puts the rungs of each together.

use std::collections::BTreeMap;

use instr::{Kind, Role};
use ladder::{Address, FileType, Image, Instruction, Target, TimeBase, Value};

use crate::budget::Budget;
use crate::location::{Location, instructions};
use crate::space::{Area, OPEN};
use crate::xref::{Certainty, CrossReference, Span, Use, certainty, joined_role};

use super::findings::findings;
use super::{
    DataValues, ElementKind, InstructionValues, LeftOut, Reference, TimerCounter, TimerFinding, TimerReport, Usage,
};

impl TimerReport {
    /// Collects the timers and counters of an image from its cross reference, which must be of the
    /// same image.
    pub fn build(image: &Image, xref: &CrossReference<'_>) -> TimerReport {
        let mut report = TimerReport::default();
        let mut active: BTreeMap<Key, Vec<InstructionValues>> = BTreeMap::new();
        for (location, instruction) in instructions(image) {
            let Some((mnemonic, at)) = timing(instruction) else { continue };
            let operand = instruction.operands.get(at);
            let element = operand.and_then(|operand| xref.resolve(operand));
            let values = values_of(location, mnemonic, instruction);
            match element.filter(Address::is_direct).and_then(|address| key_of(&address)) {
                Some(key) => active.entry(key).or_default().push(values),
                None => report.elsewhere.push(values),
            }
        }
        // Whether an instruction certainly touches the element.
        let mut elements: BTreeMap<Key, bool> = active.keys().map(|key| (*key, true)).collect();
        for key in xref.named().into_iter().filter_map(key_of) {
            elements.insert(key, true);
        }
        for file in image.data_files.iter().filter(|f| matches!(f.file_type, FileType::T | FileType::C)) {
            let touched = xref.touched_elements(file.file_type, file.number, file.elements);
            for (element, touched) in (0..file.elements).zip(touched) {
                let preset = file.element_words(element).and_then(|words| words.get(1)).is_some_and(|pre| *pre != 0);
                if preset || touched {
                    *elements.entry((file.number, file.file_type, element)).or_default() |= touched;
                }
            }
        }
        let mut budget = Budget::of_report();
        for (key, touched) in elements {
            let instructions = active.remove(&key).unwrap_or_default();
            let (element, findings) = element(image, xref, key, instructions, touched, &mut budget);
            report.findings.extend(findings);
            report.elements.push(element);
        }
        report
    }

    /// Lists all references of the elements that are `wanted`, however many there are.
    pub fn complete(&mut self, xref: &CrossReference<'_>, wanted: impl Fn(&TimerCounter) -> bool) {
        for element in &mut self.elements {
            if element.left_out != Some(LeftOut::default()) && wanted(element) {
                let found = references(xref, &element.address, &mut Budget::unlimited());
                let References { read_by, reset_by, written_by, left_out, .. } = found.unwrap_or_default();
                (element.read_by, element.reset_by, element.written_by) = (read_by, reset_by, written_by);
                element.left_out = Some(left_out);
            }
        }
    }
}

/// File number, T or C, element.
type Key = (u16, FileType, u16);

fn key_of(address: &Address) -> Option<Key> {
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
    (file, file_type, number): Key,
    instructions: Vec<InstructionValues>,
    touched: bool,
    budget: &mut Budget,
) -> (TimerCounter, Vec<TimerFinding>) {
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
    let uses = references(xref, &address, budget);
    let definite = uses.as_ref().map_or(touched, |uses| uses.definite);
    let usage = if !instructions.is_empty() {
        Usage::Active
    } else if definite {
        Usage::ReferencedOnly
    } else {
        Usage::ConfiguredOnly
    };
    let shown = xref.documentation().shown(&Target::Address(address.clone()), "");
    let left_out = uses.as_ref().map(|uses| uses.left_out);
    let mut element = TimerCounter {
        kind: if file_type == FileType::T { ElementKind::Timer } else { ElementKind::Counter },
        usage,
        symbol: shown.symbol,
        description: shown.description,
        instructions,
        data,
        base: base.filter(|_| file_type == FileType::T),
        preset,
        accum,
        read_by: Vec::new(),
        reset_by: Vec::new(),
        written_by: Vec::new(),
        left_out,
        address,
    };
    let found = findings(&element, uses.as_ref());
    if let Some(uses) = uses {
        (element.read_by, element.reset_by, element.written_by) = (uses.read_by, uses.reset_by, uses.written_by);
    }
    (element, found)
}

/// What the instructions do with an element, those that time or count with it aside.
#[derive(Default)]
pub(super) struct References {
    pub(super) read_by: Vec<Reference>,
    pub(super) reset_by: Vec<Reference>,
    pub(super) written_by: Vec<Reference>,
    pub(super) left_out: LeftOut,
    /// Some of them certainly touches it.
    definite: bool,
    /// Something in `written_by` writes the preset.
    pub(super) writes_preset: bool,
    /// Something in `written_by` writes the accumulated value.
    pub(super) writes_accum: bool,
    /// Something in `written_by` reads it too.
    pub(super) writes_what_it_reads: bool,
}

impl References {
    pub(super) fn is_read(&self) -> bool {
        !self.read_by.is_empty() || self.left_out.read_by > 0
    }

    pub(super) fn is_reset(&self) -> bool {
        !self.reset_by.is_empty() || self.left_out.reset_by > 0
    }

    pub(super) fn is_written(&self) -> bool {
        !self.written_by.is_empty() || self.left_out.written_by > 0
    }
}

/// Reads, resets and writes of an element by other instructions than those that time it: as many as
/// the budget allows, counting the rest. `None` when it is spent.
fn references(xref: &CrossReference<'_>, element: &Address, budget: &mut Budget) -> Option<References> {
    let mut all = References::default();
    let Some(area) = xref.place(element) else { return Some(all) };
    let mut spans = xref.overlapping(area, budget)?;
    spans.sort_by_key(|span| (span.by, span.area.first));
    let (mut read, mut reset, mut written) = (Vec::new(), Vec::new(), Vec::new());
    for spans in spans.chunk_by(|a, b| a.by == b.by) {
        let Some(it) = spans.first().and_then(|span| xref.use_of(span)) else { continue };
        let role = joined_role(spans.iter().map(|span| span.role));
        let certainty = certainty(spans.iter().any(|span| span.definite));
        let kind = match it.kind {
            Some(Kind::Timer | Kind::Counter) => continue,
            Some(Kind::Resettable) => &mut reset,
            _ if role.writes() => {
                let word = |word: u64| {
                    let part = Area { first: area.first + 16 * word, bits: 16, ..area };
                    spans.iter().any(|span| span.role.writes() && xref.overlap(&span.area, &part))
                };
                all.writes_preset |= word(1);
                all.writes_accum |= word(2);
                all.writes_what_it_reads |= role.reads();
                &mut written
            }
            _ => &mut read,
        };
        all.definite |= certainty == Certainty::Definite;
        kind.push((certainty, it, role, spans));
    }
    let mut listed = |mut found: Vec<(Certainty, &Use<'_>, Role, &[Span])>| {
        found.sort_by_key(|(certainty, it, ..)| (*certainty, it.location));
        let count = budget.rows(found.len());
        let more = found.len() - count;
        let references = found.into_iter().take(count).map(|(certainty, it, role, spans)| {
            let mut members: Vec<String> =
                spans.iter().flat_map(|span| members(span.area, area, element.file_type)).collect();
            members.dedup();
            Reference {
                location: it.location,
                mnemonic: it.mnemonic.to_string(),
                operand: it.operand,
                written: it.symbol.map_or_else(|| it.address.to_string(), str::to_owned),
                members,
                role,
                certainty,
            }
        });
        (references.collect(), more)
    };
    (all.read_by, all.left_out.read_by) = listed(read);
    (all.reset_by, all.left_out.reset_by) = listed(reset);
    (all.written_by, all.left_out.written_by) = listed(written);
    Some(all)
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
