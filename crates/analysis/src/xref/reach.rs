//! How far an operand reaches from the address it names, and what of that it touches.

use instr::{Extent, Kind, Role, Stored};
use ladder::{Address, FileType, Operand, member_by_name, members_of};

use crate::space::{Area, OPEN, Part, Placed};

use super::collect::{Collector, RunTimeLength, Site, Slot, Spelled};
use super::index::Span;
use super::message::{Size, transfer};
use super::{Level, Note, Through};

impl<'a> Collector<'a> {
    pub(super) fn address(&mut self, slot: Slot<'a>, address: Spelled<'a>, symbol: Option<&'a str>) {
        let Slot { site, row } = slot;
        self.pointers(site.location, site.instruction, row.name, &address);
        let as_file = takes_file(row);
        let by_index = address.indexed && !as_file;
        if by_index {
            let register = Address::element(FileType::S, 2, 24);
            let placed = self.out.spaces.place(&register);
            let by = self.add_slot_use(slot, register.into(), None, Through::IndexRegister);
            self.span(by, placed.area, Role::Read, true, None);
        }
        // A parameter written as an address is read for its value.
        let role = if row.role == Role::Parameter { Role::Read } else { row.role };
        let placed = self.out.spaces.place(&address);
        let file_type = address.file_type;
        let touched = row.touches.iter().any(|touch| touch.file_type == file_type);
        let by = self.add_slot_use(slot, address.clone(), symbol, Through::Operand);
        if by_index {
            self.out.computed.push(by);
            let area = self.whole_file(placed, &address).area;
            return self.span(by, area, role, false, None);
        }
        let whole = placed.area.bits == self.out.spaces.stride(placed.area.space)
            || (placed.area.part.is_none() && address.element.number().is_none());
        if touched && whole {
            self.name(by, placed, 0);
            return self.members(by, slot, placed, file_type);
        }
        let reach = match row.extent {
            Extent::None | Extent::Bit | Extent::Value | Extent::Element | Extent::String => Reach::Named,
            Extent::ValueOrSteps { .. } if !address.indexed => Reach::Named,
            Extent::ValueOrSteps { length } | Extent::Steps { length } => {
                let words = u64::from(self.out.spaces.words_per_element(&address));
                self.length(site, length).map(|steps| steps.saturating_add(1).saturating_mul(words * 16))
            }
            Extent::Elements { length, size_of } => {
                let words = self.element_words(site, size_of, &address);
                self.length(site, length).map(|elements| elements.saturating_mul(words * 16))
            }
            Extent::Words { length } => self.length(site, length).map(|words| words.saturating_mul(16)),
            Extent::Bits { length } => self.length(site, length),
            Extent::Block { words } => Reach::Bits { bits: u64::from(words) * 16, len: None },
            Extent::Open => return self.open(by, slot, placed, &address, role),
        };
        self.reach(by, slot, placed, &address, role, reach);
        if !touched {
            self.function_file_touches(slot);
        }
    }

    /// Turns what an operand reaches into spans.
    fn reach(&mut self, by: usize, slot: Slot<'a>, placed: Placed, address: &Address, role: Role, reach: Reach) {
        let (bits, len) = match reach {
            Reach::Named => {
                self.name(by, placed, 0);
                return self.named_value(by, slot, placed, role);
            }
            // A length of 0 is not set yet: what the operand names is in use all the same.
            Reach::Bits { bits: 0, .. } | Reach::Unknown => (OPEN, None),
            Reach::Bits { bits, len } => (bits, len),
        };
        if address.element.number().is_none() {
            self.name(by, placed, 0);
            let area = self.whole_file(placed, address).area;
            return self.span(by, area, role, false, None);
        }
        let area = Area { bits, ..placed.area };
        self.name(by, placed, if bits == OPEN { 0 } else { bits });
        if let (Some(mask), true) = (constant_mask(slot.site), role == Role::Write && bits == 16) {
            self.masked(by, Placed { area, ..placed }, role, mask);
        } else if bits > 0 {
            self.span(by, area, role, placed.definite && bits != OPEN, Some(Level::Range));
        }
        if let Some(len) = len {
            let first = area.end();
            let rest = Area { first, bits: OPEN, ..area };
            let beyond = Span { area: rest, role, definite: false, level: Level::Range, by };
            self.out.lengths.push(RunTimeLength { len, beyond, location: slot.site.location });
        }
    }

    /// The named bit, word or element itself; through a constant mask only its bits.
    fn named_value(&mut self, by: usize, slot: Slot<'a>, placed: Placed, role: Role) {
        match constant_mask(slot.site) {
            Some(mask) if role == Role::Write && (16..=32).contains(&placed.area.bits) => {
                self.masked(by, placed, role, mask);
            }
            _ => self.span(by, placed.area, role, placed.definite, None),
        }
    }

    fn masked(&mut self, by: usize, placed: Placed, role: Role, mask: u32) {
        let width = placed.area.bits.min(32) as u32;
        let full = if width >= 32 { u32::MAX } else { (1 << width) - 1 };
        if mask & full == full {
            return self.span(by, placed.area, role, placed.definite, None);
        }
        let mut bit = 0;
        while bit < width {
            let run = (mask >> bit).trailing_ones().min(width - bit);
            if run > 0 {
                let area = Area { first: placed.area.first + u64::from(bit), bits: run.into(), ..placed.area };
                self.span(by, area, role, placed.definite, Some(if run == 1 { Level::Bit } else { Level::Bits }));
            }
            bit += run.max(1);
        }
    }

    /// Members an instruction uses of the element it names.
    pub(super) fn members(&mut self, by: usize, slot: Slot<'a>, placed: Placed, file_type: FileType) {
        for touch in slot.row.touches.iter().filter(|touch| touch.file_type == file_type) {
            if let Some((area, level)) = member_area(placed, file_type, touch.member) {
                self.span(by, area, touch.role, placed.definite, Some(level));
            }
        }
        // The rest of a message or PID block holds settings and working values of the instruction.
        if !matches!(slot.row.kind, Kind::MessageBlock | Kind::PidBlock) {
            return;
        }
        let stride = self.out.spaces.stride(placed.area.space);
        let words = u16::try_from(stride / 16).unwrap_or(0);
        let is_touched = |word: u16| {
            let mut touches = slot.row.touches.iter().filter(|touch| touch.file_type == file_type);
            touches.any(|touch| member_by_name(file_type, touch.member).is_some_and(|m| m.word == word))
        };
        for word in (0..words).filter(|word| !is_touched(*word)) {
            let area = inside(placed, u64::from(word) * 16, 16);
            self.span(by, area, slot.row.role, placed.definite, Some(Level::Word));
        }
    }

    /// A block whose size only a set-up tells: message data, control blocks.
    fn open(&mut self, by: usize, slot: Slot<'a>, placed: Placed, address: &Address, role: Role) {
        if slot.row.kind == Kind::ControlBlock {
            let shown = slot.site.form.operands.iter().zip(&slot.site.instruction.operands);
            let length = shown
                .filter(|(row, _)| row.kind == Kind::Display)
                .find_map(|(_, operand)| operand.constant()?.as_integer());
            let reach = match length.and_then(|words| u64::try_from(words).ok()).filter(|words| *words > 0) {
                Some(words) => Reach::Bits { bits: words * 16, len: None },
                None => Reach::Unknown,
            };
            return self.reach(by, slot, placed, address, role, reach);
        }
        let transfer = transfer(slot.site.instruction, role);
        let words = u64::from(self.out.spaces.words_per_element(address));
        let bits = match transfer.size {
            Size::Elements(elements) => Some(elements.saturating_mul(words * 16)),
            Size::Bits(bits) => Some(bits),
            Size::Unknown => None,
        };
        if let Some(it) = self.out.uses.get_mut(by) {
            it.through = Through::Message;
        }
        self.name(by, placed, bits.unwrap_or(0));
        let area = match address.element.number() {
            Some(_) => Area { bits: bits.unwrap_or(OPEN), ..placed.area },
            None => self.whole_file(placed, address).area,
        };
        let definite = placed.definite && bits.is_some() && transfer.direction_known;
        self.span(by, area, transfer.role, definite, Some(Level::Range));
        if !definite {
            self.out.notes.push(Note::MessageArea(slot.site.location));
        }
    }

    /// What an address can mean when its element is decided at run time.
    pub(super) fn whole_file(&self, placed: Placed, address: &Address) -> Placed {
        let area = match (address.file_type, address.element.number()) {
            // S:24 counts sub-elements inside the one string.
            (FileType::ST, Some(element)) => {
                let stride = self.out.spaces.stride(placed.area.space);
                Area { first: u64::from(element) * stride, bits: stride, part: None, ..placed.area }
            }
            _ => Area { first: 0, bits: OPEN, part: None, ..placed.area },
        };
        Placed { area, definite: false }
    }

    /// Element size that the count of a file instruction refers to.
    fn element_words(&mut self, site: Site<'a>, operand: usize, fallback: &Address) -> u64 {
        let address = site.instruction.operands.get(operand).and_then(|it| self.out.symbols.address(it));
        let address = address.as_ref().unwrap_or(fallback);
        // A destination given as a word of an element (`T4:0.PRE`) still counts elements of its type;
        // words of function files are counted one by one.
        if address.file_type.is_function_file() && address.word.is_some() {
            let long = members_of(address.file_type).any(|m| m.long && Some(m.word) == address.word);
            return if long { 2 } else { 1 };
        }
        u64::from(self.out.spaces.words_per_element(address))
    }

    /// The count that operand `index` gives.
    fn length(&mut self, site: Site<'a>, index: usize) -> Reach {
        let Some(row) = site.form.operands.get(index) else { return Reach::Unknown };
        let text = site.instruction.operands.get(index).and_then(Operand::constant).and_then(|c| c.as_integer());
        if row.stored != Stored::Value {
            return match text.and_then(|count| u64::try_from(count).ok()) {
                Some(bits) => Reach::Bits { bits, len: None },
                None => Reach::Unknown,
            };
        }
        // The box shows a copy; LEN of the control element named before it is the program's.
        let mut before = site.form.operands.iter().zip(&site.instruction.operands).take(index);
        let control = before.rfind(|(row, _)| row.kind == Kind::Control).map(|(_, operand)| operand);
        let control = control.and_then(|operand| self.out.symbols.address(operand));
        let len = control.filter(Address::is_direct).map(|control| control.with_word(1));
        let stored = len.as_ref().and_then(|len| match self.image.value_at(len) {
            Some(ladder::Value::Word(word)) => Some(i64::from(word)),
            _ => None,
        });
        let count = if site.instruction.compiled { stored.or(text) } else { text.or(stored) };
        match count.and_then(|count| u64::try_from(count).ok()) {
            Some(bits) => Reach::Bits { bits, len: len.map(|len| self.out.spaces.place(&len).area) },
            None => Reach::Unknown,
        }
    }
}

/// How far an operand reaches from its address.
#[derive(Clone, Copy)]
enum Reach {
    /// What is named, no further.
    Named,
    /// This many bits; `len` when they come from LEN of a control element.
    Bits { bits: u64, len: Option<Area> },
    /// Perhaps to the end of the file.
    Unknown,
}

impl Reach {
    fn map(self, bits_of: impl Fn(u64) -> u64) -> Reach {
        match self {
            Reach::Bits { bits, len } => Reach::Bits { bits: bits_of(bits), len },
            other => other,
        }
    }
}

/// The area of a part of a placed element, wherever the element is.
fn inside(placed: Placed, offset: u64, bits: u64) -> Area {
    if placed.area.bits == OPEN {
        Area { part: Some(Part { offset, bits }), ..placed.area }
    } else {
        Area { first: placed.area.first + offset, bits, ..placed.area }
    }
}

pub(super) fn member_area(placed: Placed, file_type: FileType, name: &str) -> Option<(Area, Level)> {
    let member = member_by_name(file_type, name)?;
    let offset = u64::from(member.word) * 16 + u64::from(member.bit.unwrap_or(0));
    let (bits, level) = match member.bit {
        Some(_) => (1, Level::Bit),
        None if member.long => (32, Level::Word),
        None => (16, Level::Word),
    };
    Some((inside(placed, offset, bits), level))
}

/// `#` before this operand marks the start of a file; before any other it means S:24.
fn takes_file(row: &instr::Operand) -> bool {
    matches!(row.kind, Kind::File | Kind::WordOrFile | Kind::Slot | Kind::ControlBlock)
        || matches!(
            row.extent,
            Extent::Elements { .. }
                | Extent::Steps { .. }
                | Extent::ValueOrSteps { .. }
                | Extent::Words { .. }
                | Extent::Bits { .. }
                | Extent::Block { .. }
                | Extent::Open
        )
}

/// The bits a constant mask lets through, for instructions that write through one.
fn constant_mask(site: Site<'_>) -> Option<u32> {
    if !matches!(site.instruction.mnemonic.name(), Some("MVM" | "SQO" | "IIM")) {
        return None;
    }
    let at = site.form.operands.iter().position(|row| row.kind == Kind::Mask)?;
    let mask = site.instruction.operands.get(at)?.constant()?.as_integer()?;
    // A mask can be written as a negative decimal number.
    u32::try_from(mask).ok().or_else(|| i32::try_from(mask).ok().map(|mask| mask as u32))
}
