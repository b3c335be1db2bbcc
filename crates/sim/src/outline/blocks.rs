//! Steps of the instructions that stand in the block table.

use super::{Binary as Pair, Does, Relation, TimerKind, Value, Write, bit};
use crate::choices::Choice;
use crate::op::{Binary, BitAt, Block, Compiled, Part, Source, Start, StartAt, Stepped, SteppedTarget, Target, Unary};
use ladder::FileType;

pub(super) fn kind(kind: crate::op::TimerKind) -> TimerKind {
    match kind {
        crate::op::TimerKind::On => TimerKind::On,
        crate::op::TimerKind::Off => TimerKind::Off,
        crate::op::TimerKind::Retentive => TimerKind::Retentive,
    }
}

pub(super) fn relation(relation: crate::op::Relation) -> Relation {
    match relation {
        crate::op::Relation::Equal => Relation::Equal,
        crate::op::Relation::NotEqual => Relation::NotEqual,
        crate::op::Relation::Less => Relation::Less,
        crate::op::Relation::LessOrEqual => Relation::LessOrEqual,
        crate::op::Relation::Greater => Relation::Greater,
        crate::op::Relation::GreaterOrEqual => Relation::GreaterOrEqual,
    }
}

/// A block of the table: a condition (`test`), an output that acts without power too (`always`), or one that
/// does not.
pub(super) fn does(compiled: &Compiled, block: u32, test: bool, always: bool) -> Does {
    let Some(block) = compiled.blocks.get(block as usize) else {
        let writes = vec![Write::Anywhere];
        return Does::Other { condition: test, always, writes, reads: Vec::new(), faults: true };
    };
    exact(block).unwrap_or_else(|| {
        let condition = test || matches!(block, Block::OneShot(_));
        let sources = sources(block);
        let faults = sources.is_none() || decides_bit(compiled, block);
        let computed = sources.unwrap_or_default().into_iter().filter_map(|source| match source {
            Source::At(reference) => Some(indirect(compiled, reference)),
            _ => None,
        });
        Does::Other { condition, always, writes: writes(compiled, block), reads: computed.collect(), faults }
    })
}

/// What a block reads that ends in no fault by itself; `None`: it may.
fn sources(block: &Block) -> Option<Vec<Source>> {
    Some(match block {
        Block::Bit { bit: BitAt::At(reference), .. } => vec![Source::At(*reference)],
        Block::Bit { .. } | Block::OneShot(_) | Block::Coil(_) | Block::Latch(_) | Block::Unlatch(_) => Vec::new(),
        Block::Rising { .. } | Block::Falling { .. } | Block::Counter { .. } | Block::Reset { .. } => Vec::new(),
        Block::Clear(_) | Block::ClockRead { .. } | Block::HighSpeedCounter { .. } => Vec::new(),
        Block::Compare { a, b, .. } | Block::Binary { a, b, .. } => vec![*a, *b],
        Block::MaskedEqual { source, mask, compare } => vec![*source, *mask, *compare],
        Block::Limit { low, test, high } => vec![*low, *test, *high],
        Block::Unary { source, .. }
        | Block::ToBcd { source, .. }
        | Block::FromBcd { source, .. }
        | Block::DoubleDivide { source, .. } => vec![*source],
        // The bits of the destination that are not in the mask are read where they are written.
        Block::MaskedMove { source, mask, .. } => vec![*source, *mask],
        Block::Scale { source, rate, offset, .. } => vec![*source, *rate, *offset],
        Block::ScaleParameters { input, .. } => input.to_vec(),
        _ => return None,
    })
}

/// Blocks with a step of their own.
fn exact(block: &Block) -> Option<Does> {
    Some(match *block {
        Block::Compare { relation: how, a, b } => Does::Compare { relation: relation(how), a: value(a)?, b: value(b)? },
        Block::Limit { low, test, high } => Does::Limit { low: value(low)?, test: value(test)?, high: value(high)? },
        Block::MaskedEqual { source, mask, compare } => {
            Does::MaskedEqual { source: value(source)?, mask: value(mask)?, compare: value(compare)? }
        }
        Block::Rising { storage, output } => Does::Rising { storage: bit(storage)?, output: bit(output)? },
        Block::Falling { storage, output } => Does::Falling { storage: bit(storage)?, output: bit(output)? },
        Block::Reset { at, file_type: FileType::T } => Does::ResetTimer(fixed(at)?.0),
        Block::Reset { at, file_type: FileType::C } => Does::ResetCounter(fixed(at)?.0),
        Block::Unary { op: Unary::Move, source, dest } => Does::Move { source: value(source)?, dest: target(dest)? },
        Block::Clear(dest) => Does::Move { source: Value::Constant(0), dest: target(dest)? },
        Block::Binary { op, a, b, dest } => {
            let op = match op {
                Binary::Add => Pair::Add,
                Binary::Subtract => Pair::Subtract,
                Binary::And => Pair::And,
                Binary::Or => Pair::Or,
                Binary::Xor => Pair::Xor,
                _ => return None,
            };
            Does::Binary { op, a: value(a)?, b: value(b)?, dest: target(dest)? }
        }
        Block::Copy { source, dest, length: Source::Integer(length), words } => {
            let ((from, _), (to, end)) = (fixed(source)?, fixed(dest)?);
            let size = if words { 1 } else { dest.size };
            let words = u32::try_from(length).ok()?.checked_mul(size)?.min(end.saturating_sub(to));
            let apart = from.checked_add(words)? <= to || to.checked_add(words)? <= from;
            (apart && words <= LONGEST).then_some(Does::Copy { from, to, words })?
        }
        Block::Fill { source: Source::Integer(filled), dest, length: Source::Integer(length) } => {
            let (to, end) = fixed(dest)?;
            let words = u32::try_from(length).ok()?.checked_mul(dest.size)?.min(end.saturating_sub(to));
            let plain = dest.kind == instr::exec::Width::Word && words <= LONGEST;
            let filled = i16::try_from(filled).ok().filter(|_| plain)?;
            Does::Fill { value: filled as u16, to, words }
        }
        Block::SequencerOutput { file, mask: Stepped::Value(mask), dest, control } => {
            let SteppedTarget::Value(Target::Word(dest)) = dest else { return None };
            let plain = file.kind == instr::exec::Width::Word && file.size == 1;
            let file = fixed(file).filter(|_| plain)?;
            Does::Sequencer { control: fixed(control)?.0, file, mask: value(mask)?, dest }
        }
        Block::Pulse | Block::Service | Block::Idle => Does::Nothing,
        _ => return None,
    })
}

/// Words a copy or fill may have to have its own step.
const LONGEST: u32 = 64;

fn value(source: Source) -> Option<Value> {
    match source {
        Source::Word(at) => Some(Value::Word(at)),
        Source::Long(at) => Some(Value::Long(at)),
        Source::Integer(value) => Some(Value::Constant(value)),
        Source::Float(_) | Source::Real(_) | Source::At(_) => None,
    }
}

fn target(target: Target) -> Option<Value> {
    match target {
        Target::Word(at) => Some(Value::Word(at)),
        Target::Long(at) => Some(Value::Long(at)),
        Target::Float(_) | Target::At(_) => None,
    }
}

fn fixed(start: Start) -> Option<(u32, u32)> {
    match start.at {
        StartAt::Fixed { word, end } => Some((word, end)),
        StartAt::At(_) => None,
    }
}

/// A bit number is read when the program runs, and can be none.
fn decides_bit(compiled: &Compiled, block: &Block) -> bool {
    let decides = |bit: &BitAt| match bit {
        BitAt::Direct { .. } => false,
        BitAt::At(reference) => {
            let reference = compiled.references.get(*reference as usize);
            reference.is_none_or(|reference| matches!(reference.bit, Some(Part::Read(_))))
        }
    };
    match block {
        Block::Bit { bit, .. } => decides(bit),
        Block::OneShot(bit) | Block::Coil(bit) | Block::Latch(bit) | Block::Unlatch(bit) => decides(bit),
        Block::Rising { storage, output } | Block::Falling { storage, output } => decides(storage) || decides(output),
        _ => false,
    }
}

/// What a block can write of the data table. Status words and function files are left out: nobody may rely
/// on them.
fn writes(compiled: &Compiled, block: &Block) -> Vec<Write> {
    let to = |target: Target| match target {
        Target::Word(at) => Write::Words(at, at.saturating_add(1)),
        Target::Long(at) | Target::Float(at) => Write::Words(at, at.saturating_add(2)),
        Target::At(reference) => indirect(compiled, reference),
    };
    let bit = |bit: BitAt| match bit {
        BitAt::Direct { word, .. } => Write::Words(word, word.saturating_add(1)),
        BitAt::At(reference) => indirect(compiled, reference),
    };
    // A part of a file is written to its end at most.
    let area = |start: Start| match start.at {
        StartAt::Fixed { word, end } => Write::Words(word, end),
        StartAt::At(reference) => indirect(compiled, reference),
    };
    // Timers, counters and control elements: three words.
    let element = |start: Start| match start.at {
        StartAt::Fixed { word, .. } => Write::Words(word, word.saturating_add(3)),
        StartAt::At(reference) => indirect(compiled, reference),
    };
    match *block {
        Block::Bit { .. }
        | Block::Compare { .. }
        | Block::MaskedEqual { .. }
        | Block::Limit { .. }
        | Block::StringsEqual { .. } => Vec::new(),
        Block::OneShot(storage) => vec![bit(storage)],
        Block::Coil(at) | Block::Latch(at) | Block::Unlatch(at) => vec![bit(at)],
        Block::Rising { storage, output } | Block::Falling { storage, output } => vec![bit(storage), bit(output)],
        Block::Timer { at, .. } | Block::Counter { at, .. } => vec![indirect(compiled, at)],
        Block::Reset { at, .. } => vec![element(at)],
        Block::Unary { dest, .. }
        | Block::Binary { dest, .. }
        | Block::Clear(dest)
        | Block::MaskedMove { dest, .. }
        | Block::ToBcd { dest, .. }
        | Block::FromBcd { dest, .. }
        | Block::DoubleDivide { dest, .. }
        | Block::Scale { dest, .. }
        | Block::ScaleParameters { dest, .. }
        | Block::Compute { dest, .. }
        | Block::StringToInteger { dest, .. }
        | Block::Search { dest, .. }
        | Block::ClockRead { dest }
        | Block::ClockDifference { dest, .. } => vec![to(dest)],
        Block::SwapBytes { at, .. } => vec![area(at)],
        Block::Copy { dest, .. } | Block::Fill { dest, .. } | Block::FillElement { dest, .. } => vec![area(dest)],
        Block::Shift { file, control, .. } => vec![area(file), element(control)],
        Block::Load { file, control, .. } => vec![area(file), element(control)],
        Block::Unload { file, dest, control, .. } => vec![area(file), to(dest), element(control)],
        Block::SequencerOutput { dest, control, .. } => {
            let dest = match dest {
                SteppedTarget::Value(target) => to(target),
                SteppedTarget::File(start) => area(start),
            };
            vec![dest, element(control)]
        }
        Block::SequencerCompare { control, .. } => vec![element(control)],
        Block::SequencerLoad { file, control, .. } => vec![area(file), element(control)],
        Block::FileBits { reference, result, compare, control, .. } => {
            vec![area(reference), area(result), element(compare), element(control)]
        }
        Block::IntegerToString { dest, .. } | Block::Concatenate { dest, .. } | Block::Extract { dest, .. } => {
            vec![area(dest)]
        }
        Block::Pid { at, control, .. } => vec![area(at), to(control)],
        Block::ImmediateInput { first, words, .. } => vec![Write::Words(first, first.saturating_add(words))],
        Block::Refresh => {
            let (first, count) = compiled.inputs;
            vec![Write::Words(first as u32, (first + count) as u32)]
        }
        Block::HighSpeedCounter { word } => vec![Write::Words(word, word.saturating_add(3))],
        // They answer when a partner does, and have several places.
        Block::Port(_) | Block::Message(_) => vec![Write::Anywhere],
        Block::ClearPort { .. }
        | Block::ImmediateOutput { .. }
        | Block::Service
        | Block::InterruptMask { .. }
        | Block::TimedStart { .. }
        | Block::TimedEnable(_)
        | Block::EventInterrupts { .. }
        | Block::HighSpeedLoad { .. }
        | Block::HighSpeedReset { .. }
        | Block::Pulse
        | Block::ClockAdjust { .. }
        | Block::Idle
        | Block::Unsupported => Vec::new(),
    }
}

/// Where an address can lead that is decided at run time. Out of its file it is a fault, or reaches other
/// data.
fn indirect(compiled: &Compiled, reference: u32) -> Write {
    let Some(reference) = compiled.references.get(reference as usize) else { return Write::Anywhere };
    let (Part::Fixed(number), false) = (reference.file, reference.indexed) else { return Write::Anywhere };
    let slots = reference.file_type.has_slots();
    let file = compiled.layout.files.iter().find(|file| file.file_type == reference.file_type && file.number == number);
    let (Some(file), false) = (file, slots) else { return Write::Anywhere };
    let strays = compiled.traits.mx() && !compiled.choices.has(Choice::IndirectStaysInFile);
    let bit_decides = matches!(reference.bit, Some(Part::Read(_)));
    if bit_decides && strays {
        return Write::Anywhere;
    }
    let element = match reference.element {
        Part::Fixed(element) => Value::Constant(element.into()),
        Part::Read(source) => match value(source) {
            Some(value) => value,
            None => return Write::Anywhere,
        },
    };
    // What begins in a file ends in it.
    Write::Element { file: (file.start, file.end()), element, elements: file.elements, strays }
}
