//! What a proof run can change from outside: terminals, and data that people write and the program reads.

use std::collections::{BTreeMap, BTreeSet};

use instr::Role;
use ladder::{Address, FileType, Image, Operand};

use super::pairs::Pairs;
use super::report::Driven;
use super::side::{Kind, Side, Slc};
use crate::{Access, CrossReference, Level, Through};

/// An input of both sides.
#[derive(Clone, Debug)]
pub(crate) struct Input<T> {
    /// Address of the original.
    pub(crate) original: String,
    /// Address of the other side.
    pub(crate) other: String,
    pub(crate) kind: Kind,
    /// Place in the original.
    pub(crate) at: u32,
    pub(crate) a: (Address, Kind),
    pub(crate) b: T,
    /// Words worth trying; empty for bits.
    pub(crate) values: Vec<u32>,
    /// Only these values are sensible: pointers within their files, fields of the clock.
    pub(crate) bounded: bool,
    /// A terminal; otherwise data a person or another device writes.
    pub(crate) terminal: bool,
    /// The program can write it too: going to run resets it, so nobody writes it on the way there.
    pub(crate) written: bool,
}

/// Inputs and what could not become one.
#[derive(Debug)]
pub(crate) struct Inputs<T> {
    pub(crate) all: Vec<Input<T>>,
    /// Addresses the program reads as inputs that cannot be driven on both sides, with why.
    pub(crate) left_out: Vec<(String, String)>,
}

/// Fields of the clock: status word, word of RTC:0, field of SDT0, least and greatest value. Days stay
/// below 29, so that every combination is a date.
const CLOCK: [(u16, u16, &str, u32, u32); 6] = [
    (37, 0, "Year", 2000, 2090),
    (38, 1, "Month", 1, 12),
    (39, 2, "Day", 1, 28),
    (40, 3, "Hour", 0, 23),
    (41, 4, "Minute", 0, 59),
    (42, 5, "Second", 0, 59),
];

impl<T> Inputs<T> {
    /// What is changed, as the other side names it.
    pub(crate) fn driven(&self) -> Vec<Driven> {
        let range = |input: &Input<T>| {
            let ends = input.values.iter().min().zip(input.values.iter().max());
            ends.filter(|_| input.bounded).map(|(least, most)| (*least, *most))
        };
        let driven = |input: &Input<T>| Driven { address: input.other.clone(), kind: input.kind, range: range(input) };
        self.all.iter().map(driven).collect()
    }
}

impl<T: Clone> Inputs<T> {
    /// Finds all inputs of the original and where the other side has them.
    pub(crate) fn new<B: Side<Target = T>>(
        image: &Image,
        xref: &CrossReference<'_>,
        a: &Slc,
        b: &B,
        pairs: &Pairs,
    ) -> Inputs<T> {
        let mut inputs = Inputs { all: Vec::new(), left_out: Vec::new() };
        let compared = compared_values(image, a);
        let mut seen = BTreeSet::new();
        for address in xref.named() {
            if !address.is_direct() {
                continue;
            }
            let accesses = xref.of(address);
            let written = !is_input(address, &accesses);
            if written && !is_left_out(xref, address, &accesses) {
                continue;
            }
            // A bit of a field of the clock: the field is what changes.
            let word = Address { bit: None, ..address.clone() };
            let address = if clock_field(&word).is_some() { &word } else { address };
            let text = address.to_string();
            let Ok((at, kind)) = a.place(&text) else { continue };
            if kind == Kind::Text || !seen.insert((at, kind)) {
                continue;
            }
            let clock = clock_field(address);
            let other = match clock {
                Some((field, ..)) => pairs.clock(field, &text),
                None => pairs.other(at, kind),
            };
            let mut values = compared.get(&at).cloned().unwrap_or_default();
            let limit = pointer_limit(xref, address, &accesses);
            let bounded = clock.is_some() || limit.is_some();
            if let Some((_, least, most)) = clock {
                values.retain(|value| (least..=most).contains(value));
                values.extend([least, most]);
            } else if let Some(limit) = limit {
                values.retain(|value| *value < limit);
                values.extend([0, limit.saturating_sub(1)]);
            } else if kind != Kind::Bit {
                values.extend(edges(kind));
                values.push(stored(a, at, kind));
            }
            values.sort_unstable();
            values.dedup();
            inputs.add(a, b, (text, other), (at, kind), values, bounded, address.file_type == FileType::I);
            if let Some(added) = inputs.all.last_mut().filter(|added| written && added.at == at) {
                added.written = true;
            }
        }
        // Operators set counters: what follows must go on from there, up to the ends of their range.
        for address in counted(image) {
            let text = address.to_string();
            if let Ok((at, Kind::Word)) = a.place(&text)
                && seen.insert((at, Kind::Word))
            {
                let mut values = edges(Kind::Word);
                values.extend(compared.get(&at).into_iter().flatten());
                values.extend([0x7FFE, 0x8001]);
                // Around the preset: done begins at equal values.
                let preset = a.word(at - 16);
                values.extend([preset.wrapping_sub(1), preset, preset.wrapping_add(1)].map(u32::from));
                let other = pairs.other(at, Kind::Word);
                inputs.add(a, b, (text, other), (at, Kind::Word), values, true, false);
            }
        }
        // People preset what a program counts up itself, too.
        for address in accumulated(image) {
            let text = address.to_string();
            let Ok((at, kind @ (Kind::Word | Kind::Long))) = a.place(&text) else { continue };
            if !seen.insert((at, kind)) {
                continue;
            }
            let limit = pointer_limit(xref, &address, &xref.of(&address));
            let mut values = compared.get(&at).cloned().unwrap_or_default();
            values.extend(edges(kind));
            values.extend(if kind == Kind::Word { [0x7FFE, 0x8001] } else { [0x7FFF_FFFE, 0x8000_0001] });
            if let Some(limit) = limit {
                values.retain(|value| *value < limit);
                values.extend([0, limit.saturating_sub(1)]);
            }
            values.sort_unstable();
            values.dedup();
            let other = pairs.other(at, kind);
            inputs.add(a, b, (text, other), (at, kind), values, limit.is_some(), false);
        }
        // Steps of sequencers that nothing in the program writes.
        for address in steps(image) {
            let text = address.to_string();
            let writes = xref.of(&address).iter().any(|access| access.role.writes());
            if let Ok((at, Kind::Word)) = a.place(&text)
                && !writes
                && seen.insert((at, Kind::Word))
            {
                let mut values = edges(Kind::Word);
                values.push(stored(a, at, Kind::Word));
                let other = pairs.other(at, Kind::Word);
                inputs.add(a, b, (text, other), (at, Kind::Word), values, false, false);
            }
        }
        // Words of terminals that instructions take whole.
        for (at, own, other) in pairs.input_words() {
            let Ok(address) = Address::parse(&own) else { continue };
            let whole = xref.of(&address).iter().any(|access| access.level > Level::Bit && access.role.reads());
            if whole && seen.insert((at, Kind::Word)) {
                inputs.add(a, b, (own, Some(other)), (at, Kind::Word), edges(Kind::Word), false, true);
            }
        }
        inputs
    }

    #[allow(clippy::too_many_arguments)] // called twice, in order of the fields
    fn add<B: Side<Target = T>>(
        &mut self,
        a: &Slc,
        b: &B,
        (original, other): (String, Option<String>),
        (at, kind): (u32, Kind),
        values: Vec<u32>,
        bounded: bool,
        terminal: bool,
    ) {
        let Some(other) = other else {
            self.left_out.push((original, "the map has no row for it".to_owned()));
            return;
        };
        match (a.target(&original), b.target(&other)) {
            (Ok(own), Ok(target)) => {
                let written = false;
                self.all.push(Input {
                    original,
                    other,
                    kind,
                    at,
                    a: own,
                    b: target,
                    values,
                    bounded,
                    terminal,
                    written,
                });
            }
            (Err(why), _) | (_, Err(why)) => self.left_out.push((original, why)),
        }
    }
}

/// Accumulated values of the counters the program runs.
fn counted(image: &Image) -> Vec<Address> {
    let mut all = Vec::new();
    for (_, instruction) in crate::instructions(image) {
        if matches!(instruction.mnemonic.name(), Some("CTU" | "CTD"))
            && let Some(address) = instruction.operands.first().and_then(Operand::address)
            && address.is_direct()
        {
            all.push(address.clone().with_word(2));
        }
    }
    all
}

/// Words that an instruction computes from themselves.
fn accumulated(image: &Image) -> Vec<Address> {
    let mut all: Vec<Address> = Vec::new();
    for (_, instruction) in crate::instructions(image) {
        if let (Some("ADD" | "SUB" | "MUL"), [from @ .., to]) = (instruction.mnemonic.name(), &*instruction.operands)
            && let Some(address) = to.address().filter(|address| address.is_direct())
            && from.iter().any(|operand| operand.address() == Some(address))
            && !all.contains(address)
        {
            all.push(address.clone());
        }
    }
    all
}

/// The words of sequencers' steps: those of the position 0 to the length.
fn steps(image: &Image) -> Vec<Address> {
    let mut all = Vec::new();
    for (_, instruction) in crate::instructions(image) {
        let operands = &instruction.operands;
        let length = operands.get(4).and_then(Operand::constant).and_then(|constant| constant.as_integer());
        let first = operands.first().and_then(Operand::address).filter(|address| address.indexed);
        let place = first.and_then(|it| Some((it.file_type, it.file.number()?, it.element.number()?)));
        if let (Some("SQO" | "SQC"), Some(length), Some((kind, file, element))) =
            (instruction.mnemonic.name(), length, place)
            && matches!(kind, FileType::N | FileType::B)
        {
            let last = element.saturating_add(u16::try_from(length.clamp(0, 255)).unwrap_or(0));
            all.extend((element..=last).map(|element| Address::element(kind, file, element)));
        }
    }
    all
}

/// The value stored at a place of the original.
pub(crate) fn stored(a: &Slc, at: u32, kind: Kind) -> u32 {
    match kind {
        Kind::Bit => a.bit(at).into(),
        Kind::Word | Kind::Text => a.word(at).into(),
        Kind::Long | Kind::Float => u32::from(a.word(at)) | u32::from(a.word(at + 16)) << 16,
    }
}

/// Values at the ends of a type.
fn edges(kind: Kind) -> Vec<u32> {
    match kind {
        Kind::Bit | Kind::Text => Vec::new(),
        Kind::Word => vec![0, 1, 2, 0xFFFF, 0x7FFF, 0x8000, 100, 0x00FF],
        Kind::Long => vec![0, 1, u32::MAX, 0x7FFF_FFFF, 0x8000_0000, 70_000],
        Kind::Float => [0.0f32, 1.0, -1.0, 0.5, -2.5, 1000.25, 40_000.0].map(f32::to_bits).to_vec(),
    }
}

/// Terminals, and bits and words that the program reads but never changes; bits it only ever sets or only
/// ever resets need somebody who does the opposite.
fn is_input(address: &Address, accesses: &[Access<'_>]) -> bool {
    if !accesses.iter().any(|access| access.role.reads()) {
        return false;
    }
    if clock_field(&Address { bit: None, ..address.clone() }).is_some() {
        return true;
    }
    match address.file_type {
        FileType::I => true,
        FileType::B | FileType::N | FileType::F | FileType::L => {
            let mut writers = accesses.iter().filter(|access| access.role.writes()).peekable();
            if writers.peek().is_none() {
                return true;
            }
            let all = |mnemonic: &str| {
                let by = |access: &&Access<'_>| access.role == Role::Write && *access.mnemonic == mnemonic;
                accesses.iter().filter(|access| access.role.writes()).all(|access| by(&access))
            };
            address.bit.is_some() && (all("OTU") || all("OTL"))
        }
        _ => false,
    }
}

/// Data that the program writes only behind a RET that an operator's bit decides: while that leaves the
/// rungs out, people write what they would, as with a map of inputs that is not wired yet.
fn is_left_out(xref: &CrossReference<'_>, address: &Address, accesses: &[Access<'_>]) -> bool {
    let data = matches!(address.file_type, FileType::B | FileType::N | FileType::F | FileType::L);
    let mut writers = accesses.iter().filter(|access| access.role.writes()).peekable();
    let operated = |it: &ladder::Instruction| {
        let address = it.operands.first().and_then(Operand::address).filter(|address| address.is_direct());
        let contact = matches!(it.mnemonic.name(), Some("XIC" | "XIO"));
        contact
            && address.is_some_and(|address| address.file_type != FileType::S && is_input(address, &xref.of(address)))
    };
    let returns = |rung: &ladder::Rung| {
        let mut all: Vec<_> = rung.instructions().collect();
        let last = all.pop().is_some_and(|it| it.mnemonic == "RET");
        last && !all.is_empty() && all.into_iter().all(operated)
    };
    let behind = |access: &Access<'_>| {
        let file = xref.image().program_file(access.location.file);
        let before = file.and_then(|file| file.rungs.get(..access.location.rung as usize));
        before.is_some_and(|rungs| rungs.iter().any(returns))
    };
    data && accesses.iter().any(|access| access.role.reads()) && writers.peek().is_some() && writers.all(behind)
}

pub(crate) fn clock_field(address: &Address) -> Option<(&'static str, u32, u32)> {
    if address.bit.is_some() {
        return None;
    }
    let row = CLOCK.iter().find(|row| match address.file_type {
        FileType::S => address.element.number() == Some(row.0),
        FileType::RTC => address.element.number() == Some(0) && address.word == Some(row.1),
        _ => false,
    })?;
    Some((row.2, row.3, row.4))
}

/// How many values a pointer can take so that no address leaves its file; `None` for what is no pointer.
fn pointer_limit(xref: &CrossReference<'_>, address: &Address, accesses: &[Access<'_>]) -> Option<u32> {
    let pointers: Vec<_> =
        accesses.iter().filter(|it| matches!(it.through, Through::Pointer | Through::IndexRegister)).collect();
    if pointers.is_empty() {
        return None;
    }
    let image = xref.image();
    let mut limit = u32::from(u16::MAX);
    for access in pointers {
        let rung =
            image.program_file(access.location.file).and_then(|file| file.rungs.get(access.location.rung as usize));
        let instruction = rung.and_then(|rung| rung.instructions().nth(access.location.instruction as usize));
        for operand in instruction.iter().flat_map(|it| &it.operands).filter_map(Operand::address) {
            if !operand.indirections().any(|inner| inner == address) {
                continue;
            }
            let file = operand.file.number().and_then(|number| image.data_file(operand.file_type, number));
            let through_element = matches!(&operand.element, ladder::Place::Indirect(inner) if **inner == *address);
            let through_bit = matches!(&operand.bit, Some(ladder::Place::Indirect(inner)) if **inner == *address);
            limit = limit.min(match file {
                Some(file) if through_element => file.elements.into(),
                Some(_) if through_bit => 16,
                _ => 1,
            });
        }
    }
    Some(limit.max(1))
}

/// Per place the values around what the program compares it with.
fn compared_values(image: &Image, a: &Slc) -> BTreeMap<u32, Vec<u32>> {
    let mut found: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (_, instruction) in crate::instructions(image) {
        let operands = &instruction.operands;
        let constants: Vec<i64> = operands
            .iter()
            .filter_map(|operand| match operand {
                Operand::Constant(constant) => constant.as_integer(),
                Operand::Address(address) if address.is_direct() => {
                    let (at, kind) = a.place(&address.to_string()).ok()?;
                    match kind {
                        Kind::Word => Some(i64::from(a.word(at) as i16)),
                        Kind::Long => Some(i64::from(stored(a, at, kind) as i32)),
                        _ => None,
                    }
                }
                _ => None,
            })
            .collect();
        for address in operands.iter().filter_map(Operand::address).filter(|address| address.is_direct()) {
            let Ok((at, kind)) = a.place(&address.to_string()) else { continue };
            let values = found.entry(at).or_default();
            for constant in &constants {
                for near in [constant - 1, *constant, constant + 1] {
                    match kind {
                        Kind::Word => values.extend(i16::try_from(near).map(|value| u32::from(value as u16))),
                        Kind::Long => values.extend(i32::try_from(near).map(|value| value as u32)),
                        Kind::Float => values.push((near as f32).to_bits()),
                        Kind::Bit | Kind::Text => {}
                    }
                }
            }
        }
    }
    found
}
