//! Slots with their modules, and what the program does with each of their points.

use std::collections::HashMap;

use ladder::{Address, FileType, IoRange, Slot};

use super::{Context, remark, rungs};
use crate::anchor::Anchor;
use crate::model::{Block, ColumnKind, Note, NoteKind, Table, Text};
use crate::words;

pub(super) fn configuration<'a>(context: &Context<'a, '_>) -> Vec<Block<'a>> {
    let io = &context.image().io;
    let mut blocks = Vec::new();
    if let Some(unknown) = &io.unknown {
        blocks.push(Block::Note(Note::new(NoteKind::Warning, unknown.as_str())));
    }
    if !io.base_unit.is_empty() {
        blocks.push(remark(format!("Base unit {} (inferred).", io.base_unit)));
    }
    let mut table = Table::new(&[
        ("Slot", ColumnKind::Number),
        ("Module", ColumnKind::Text),
        ("Description", ColumnKind::Text),
        ("Inputs", ColumnKind::Text),
        ("Outputs", ColumnKind::Text),
        ("Identity", ColumnKind::Text),
        ("Evidence", ColumnKind::Text),
    ]);
    for slot in &io.slots {
        table.row([
            slot.number.to_string().into(),
            slot.module.catalog.as_deref().unwrap_or("unknown").into(),
            slot.module.description.as_str().into(),
            words::points(slot, &slot.inputs, "I").into(),
            words::points(slot, &slot.outputs, "O").into(),
            slot.module.identity.as_str().into(),
            slot.module.confidence.as_str().into(),
        ]);
    }
    blocks.push(if table.rows.is_empty() {
        remark("The project holds no I/O configuration.")
    } else {
        Block::Table(table)
    });
    blocks
}

/// Points listed of one module; the largest known has 64. A count beyond is not one of a real module.
const POINTS: u16 = 256;

/// What accesses do to a point.
#[derive(Clone, Default)]
struct Uses {
    read: Vec<analysis::Location>,
    written: Vec<analysis::Location>,
    left_out: bool,
}

pub(super) fn map<'a>(context: &Context<'a, '_>) -> Vec<Block<'a>> {
    let io = &context.image().io;
    let mut uses: HashMap<Address, Uses> = HashMap::new();
    for group in context.xref.all().filter(|group| group.address.file_type.has_slots() && group.address.is_direct()) {
        let Some(point) = io.resolve(&group.address) else { continue };
        // Spelled in one way, whatever the program wrote.
        let mut key = Address::element(group.address.file_type, 0, point.slot.number).with_word(point.word);
        key.bit = point.bit.map(ladder::Place::Number);
        let entry = uses.entry(key).or_default();
        entry.left_out |= group.left_out != Some(0);
        for access in &group.accesses {
            if access.role.reads() {
                entry.read.push(access.location);
            }
            if access.role.writes() {
                entry.written.push(access.location);
            }
        }
    }
    let mut blocks = Vec::new();
    for slot in &io.slots {
        let mut table = Table::new(&[
            ("Point", ColumnKind::Fixed),
            ("Symbol", ColumnKind::Text),
            ("Description", ColumnKind::Text),
            ("Read in", ColumnKind::Text),
            ("Written in", ColumnKind::Text),
        ]);
        let mut more = 0;
        for (file_type, range) in [(FileType::I, slot.inputs), (FileType::O, slot.outputs)] {
            more += range.bits.saturating_sub(POINTS);
            points(context, slot, file_type, range, &uses, &mut table);
        }
        if table.rows.is_empty() {
            continue;
        }
        let name = slot.module.catalog.as_deref().unwrap_or("unknown module");
        blocks.push(Block::Heading(format!("Slot {}  {name}  {}", slot.number, slot.module.description)));
        blocks.push(Block::Table(table));
        if more > 0 {
            blocks.push(Block::Note(Note::new(NoteKind::Warning, format!("{more} more points are not listed."))));
        }
    }
    if blocks.is_empty() {
        blocks.push(remark("No slot of the I/O configuration has points."));
    }
    blocks
}

fn points(
    context: &Context<'_, '_>,
    slot: &Slot,
    file_type: FileType,
    range: IoRange,
    uses: &HashMap<Address, Uses>,
    table: &mut Table,
) {
    let none = Uses::default();
    for word in 0..range.words.min(POINTS / 16) {
        let address = Address::element(file_type, 0, slot.number).with_word(word);
        let of_word = uses.get(&address);
        let bits = range.bits.saturating_sub(word * 16).min(16);
        let used_as_bits = (0..bits).any(|bit| uses.contains_key(&address.clone().with_bit(bit)));
        let documented = |address: &Address| {
            let (symbol, description) = context.documented(address);
            !(symbol.is_empty() && description.is_empty())
        };
        let documented_bits = (0..bits).any(|bit| documented(&address.clone().with_bit(bit)));
        // An analogue word is one thing; its bits are not listed unless someone uses them.
        if let Some(of_word) = of_word.or_else(|| documented(&address).then_some(&none)) {
            row(context, &address, of_word, table);
            if !used_as_bits && !documented_bits {
                continue;
            }
        }
        for bit in 0..bits {
            let point = address.clone().with_bit(bit);
            row(context, &point, uses.get(&point).or(of_word).unwrap_or(&none), table);
        }
    }
}

fn row(context: &Context<'_, '_>, address: &Address, uses: &Uses, table: &mut Table) {
    let (symbol, description) = context.documented(address);
    let list = |locations: &[analysis::Location]| {
        let mut sorted = locations.to_vec();
        sorted.sort_unstable();
        let mut text = rungs(&sorted, 0);
        if uses.left_out {
            text.push(" and more", None);
        }
        text
    };
    let shown = address.to_string();
    let place = Anchor::reference(&shown);
    table.row([Text::link(shown, place), symbol.into(), description.into(), list(&uses.read), list(&uses.written)]);
}
