//! Data that rungs left to a person decide, directly or through other rungs: it cannot be compared.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use instr::Role;
use ladder::{Image, Instruction, Operand};

use super::side::{Side, Slc};
use crate::CrossReference;
use crate::space::{Area, Spaces};
use crate::xref::Span;

/// What cannot be compared.
#[derive(Debug, Default)]
pub(crate) struct Taint {
    /// Bits of words of the original, by number of the word.
    pub(crate) bits: BTreeMap<u32, u16>,
    /// Rungs whose effect is not known: file and rung.
    pub(crate) rungs: BTreeSet<(u16, u32)>,
    /// One of them can stop the controller, or keep it from being stopped.
    pub(crate) stops: bool,
}

/// Words of a space whose size nobody knows.
const UNKNOWN_WORDS: u64 = 4096;

/// Instructions no data can make stop a controller.
const HARMLESS: [&str; 10] = ["XIC", "XIO", "OTE", "OTL", "OTU", "ONS", "OSR", "OSF", "NOP", "LBL"];

/// What rungs left to a person decide; `None`: which rungs run at all depends on one of them.
pub(crate) fn tainted(
    image: &Image,
    xref: &CrossReference<'_>,
    a: &Slc,
    persons: &BTreeSet<(u16, u32)>,
) -> Option<Taint> {
    if persons.is_empty() {
        return Some(Taint::default());
    }
    let mut uses: HashMap<(u16, u32), Vec<Span>> = HashMap::new();
    for (location, span) in xref.spans() {
        uses.entry((location.file, location.rung)).or_default().push(*span);
    }
    let mut bits = Bits { spaces: xref.spaces(), words: BTreeMap::new() };
    let mut dark = BTreeSet::new();
    let mut open: Vec<(u16, u32)> = persons.iter().copied().collect();
    loop {
        while let Some(place) = open.pop() {
            if !dark.insert(place) {
                continue;
            }
            for span in uses.get(&place).into_iter().flatten().filter(|span| span.role.writes()) {
                bits.set(span.area);
            }
            open.extend(decided(image, place)?);
        }
        let reads = |span: &Span| matches!(span.role, Role::Read | Role::ReadWrite) && bits.any(span.area);
        let found = uses.iter().filter(|(place, spans)| !dark.contains(place) && spans.iter().any(reads));
        open.extend(found.map(|(place, _)| *place));
        if open.is_empty() {
            break;
        }
    }
    let acts = |instruction: &Instruction| !instruction.mnemonic.name().is_some_and(|name| HARMLESS.contains(&name));
    let rungs = dark.iter().filter_map(|(file, rung)| image.program_file(*file)?.rungs.get(*rung as usize));
    let stops = rungs.flat_map(ladder::Rung::instructions).any(acts);
    Some(Taint { bits: bits.of_machine(a), rungs: dark, stops })
}

/// Rungs that run or not as a rung of unknown effect decides; `None`: that cannot be told.
fn decided(image: &Image, (number, rung): (u16, u32)) -> Option<Vec<(u16, u32)>> {
    let file = image.program_file(number)?;
    let all = |number: u16| {
        let file = image.program_file(number);
        file.into_iter().flat_map(move |file| (0..).zip(&file.rungs).map(move |(rung, _)| (number, rung)))
    };
    let is = |rung: u32, name: &str| {
        let found = file.rungs.get(rung as usize);
        found.is_some_and(|found| found.instructions().any(|instruction| instruction.mnemonic == name))
    };
    let end = u32::try_from(file.rungs.len()).ok()?;
    let mut decided = Vec::new();
    for instruction in file.rungs.get(rung as usize).into_iter().flat_map(ladder::Rung::instructions) {
        match instruction.mnemonic.name() {
            Some("JSR") => decided.extend(all(called(instruction)?)),
            Some("JMP") => {
                let label = label(instruction)?;
                let to = (0..end).find(|rung| {
                    let found = file.rungs.get(*rung as usize).into_iter().flat_map(ladder::Rung::instructions);
                    found.filter(|found| found.mnemonic == "LBL").any(|found| self::label(found) == Some(label))
                })?;
                decided.extend((to.min(rung)..to.max(rung + 1)).map(|rung| (number, rung)));
            }
            Some("MCR") => {
                let close = (rung + 1..end).find(|rung| is(*rung, "MCR")).unwrap_or(end.saturating_sub(1));
                decided.extend((rung..=close).map(|rung| (number, rung)));
            }
            Some("TND") if number != 2 => return None,
            Some("RET" | "TND") => decided.extend((rung..end).map(|rung| (number, rung))),
            Some("SUS" | "STS" | "REF") => return None,
            _ => {}
        }
    }
    Some(decided)
}

/// The file a JSR calls.
pub(crate) fn called(instruction: &Instruction) -> Option<u16> {
    match instruction.operands.first()? {
        Operand::ProgramFile(file) => Some(*file),
        Operand::Constant(constant) => constant.as_integer().and_then(|file| u16::try_from(file).ok()),
        _ => None,
    }
}

/// The label an instruction names.
pub(crate) fn label(instruction: &Instruction) -> Option<u16> {
    match instruction.operands.first()? {
        Operand::Label { number, .. } => Some(*number),
        Operand::Constant(constant) => constant.as_integer().and_then(|number| u16::try_from(number).ok()),
        _ => None,
    }
}

/// Bits of the data table, by space and word.
struct Bits<'x> {
    spaces: &'x Spaces<'x>,
    words: BTreeMap<(usize, u64), u16>,
}

impl Bits<'_> {
    /// Spaces an area lies in: where the file is decided at run time, all of its type.
    fn within(&self, area: Area) -> Vec<usize> {
        let Some(space) = self.spaces.get(area.space) else { return Vec::new() };
        let any = space.key.number.is_none() || space.key.slot.is_some();
        let alike = |other: &usize| {
            let Some(other) = self.spaces.get(*other) else { return false };
            other.key.file_type == space.key.file_type && (any || other.key.number.is_none())
        };
        let mut found: Vec<usize> = (0..self.spaces.len()).filter(alike).collect();
        found.push(area.space);
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Words of an area in a space, each with its bits.
    fn each(&self, space: usize, area: Area, mut visit: impl FnMut((usize, u64), u16) -> bool) {
        let Some(known) = self.spaces.get(space) else { return };
        let whole = space != area.space;
        let size = known.bits().unwrap_or(UNKNOWN_WORDS * 16).max(16);
        let (first, end) = if whole { (0, size) } else { (area.first, area.end().min(size.max(area.first + 16))) };
        let part = area.part.filter(|_| !whole);
        for word in first / 16..end.div_ceil(16) {
            let bits = (0..16).filter(|bit| {
                let at = word * 16 + bit;
                let inside = part.is_none_or(|part| {
                    (part.offset..part.offset.saturating_add(part.bits)).contains(&(at % known.stride()))
                });
                (first..end).contains(&at) && inside
            });
            let mask = bits.fold(0u16, |mask, bit| mask | 1 << bit);
            if mask != 0 && visit((space, word), mask) {
                return;
            }
        }
    }

    fn set(&mut self, area: Area) {
        for space in self.within(area) {
            let mut found = Vec::new();
            self.each(space, area, |key, mask| {
                found.push((key, mask));
                false
            });
            for (key, mask) in found {
                *self.words.entry(key).or_default() |= mask;
            }
        }
    }

    fn any(&self, area: Area) -> bool {
        self.within(area).into_iter().any(|space| {
            let mut hit = false;
            // Most spaces hold nothing that is looked for.
            if self.words.range((space, 0)..=(space, u64::MAX)).next().is_some() {
                self.each(space, area, |key, mask| {
                    hit = self.words.get(&key).is_some_and(|known| known & mask != 0);
                    hit
                });
            }
            hit
        })
    }

    /// The same as words of the machine.
    fn of_machine(&self, a: &Slc) -> BTreeMap<u32, u16> {
        let mut found: BTreeMap<u32, u16> = BTreeMap::new();
        for ((space, word), mask) in &self.words {
            let Some(known) = self.spaces.get(*space) else { continue };
            let stride = if known.key.file_type.has_slots() { 16 } else { known.stride() };
            let (element, offset) = (word * 16 / stride * stride, word * 16 % stride / 16);
            let address = self.spaces.address_of(*space, element, stride);
            let place = address.and_then(|address| a.place(&address.to_string()).ok());
            if let (Some((at, _)), Ok(offset)) = (place, u32::try_from(offset)) {
                *found.entry((at >> 4) + offset).or_default() |= mask;
            }
        }
        found
    }
}
