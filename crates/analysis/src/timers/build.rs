//! Collects timers and counters and puts the rungs of each together.

use std::collections::BTreeSet;

use instr::{Kind, Role};
use ladder::{Address, FileType, Image, Instruction, Target, TimeBase, Value};

use crate::location::{Location, instructions};
use crate::space::{Area, OPEN};
use crate::xref::{Certainty, CrossReference, certainty, joined_role};

use super::findings::findings;
use super::{DataValues, ElementKind, InstructionValues, Reference, TimerCounter, TimerReport, Usage};

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
            let touched = xref.touched_elements(file.file_type, file.number, file.elements);
            for (element, touched) in (0..file.elements).zip(touched) {
                let preset = file.element_words(element).and_then(|words| words.get(1)).is_some_and(|pre| *pre != 0);
                if preset || touched {
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
