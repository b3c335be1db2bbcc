//! Contacts, coils and one-shots.

use ladder::{FileType, Instruction, Operand};

use super::context::{Context, Converted};
use super::emit::{Contact, Emitter, Relation};
use super::operand::{Bit, operand};
use super::table::{Row, row};

pub(super) const TABLE: &[Row] = &[
    Row { mnemonic: "XIC", convert: xic, contact: Some(|context, instruction| plain(context, instruction, false)) },
    Row { mnemonic: "XIO", convert: xio, contact: Some(|context, instruction| plain(context, instruction, true)) },
    row("OTE", ote),
    row("OTL", |context, e, instruction| latch(context, e, instruction, true)),
    row("OTU", |context, e, instruction| latch(context, e, instruction, false)),
    row("ONS", one_shot),
    row("OSR", rising),
    row("OSF", falling),
];

/// A contact on a bit whose place is fixed.
fn plain(context: &mut Context<'_>, instruction: &Instruction, closed: bool) -> Option<Contact> {
    let Some(Operand::Address(address)) = instruction.operands.first() else { return None };
    if !address.is_direct() {
        return None;
    }
    match context.bit(instruction.operands.first()?).ok()? {
        Bit::Plain(bit) if closed => Some(Contact::Off(bit)),
        Bit::Plain(bit) => Some(Contact::On(bit)),
        _ => None,
    }
}

fn xic(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    let contact = context.bit_contact(e, operand(instruction, 0)?, false)?;
    e.contact(&contact);
    Ok(())
}

fn xio(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    let contact = context.bit_contact(e, operand(instruction, 0)?, true)?;
    e.contact(&contact);
    Ok(())
}

/// OTE: `OUT`. Entering RUN clears the bit on the original too, before the first rung; an input is read from its
/// terminal in between.
fn ote(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    let coil = operand(instruction, 0)?;
    let is_input = coil.address().is_some_and(|address| address.file_type == FileType::I);
    match context.bit_target(coil)? {
        Bit::Plain(bit) => {
            e.out(&bit);
            if !is_input {
                context.needs.clear.insert(bit);
            }
        }
        bit => {
            e.when(|e| bit.write(e, true));
            e.unless(|e| bit.write(e, false));
            if !is_input && !context.needs.clear_found.contains(&bit) {
                context.needs.clear_found.push(bit);
            }
        }
    }
    Ok(())
}

fn latch(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction, on: bool) -> Converted {
    context.bit_target(operand(instruction, 0)?)?.write(e, on);
    Ok(())
}

/// ONS and OSR with one operand: the storage bit remembers the rung, power flows on in the scan in
/// which it becomes true. While the rung is false the bit is reset; then power passes only where the
/// bit is off, and sets it.
fn one_shot(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    let storage = context.bit_target(operand(instruction, 0)?)?;
    shot(context, e, &storage);
    Ok(())
}

fn shot(context: &mut Context<'_>, e: &mut Emitter, storage: &Bit) {
    e.invert();
    storage.write(e, false);
    e.invert();
    match storage {
        Bit::Plain(bit) => e.and_not(bit),
        other => {
            let scratch = context.scratch_long(0);
            e.math(&scratch, &other.term());
            e.and_compare(Relation::Equal, &scratch, "0");
        }
    }
    storage.write(e, true);
}

/// OSR: with one operand a condition, with two an output that writes its pulse to the second bit.
fn rising(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    if instruction.operands.len() < 2 {
        return one_shot(context, e, instruction);
    }
    let storage = context.bit_target(operand(instruction, 0)?)?;
    let output = context.bit_target(operand(instruction, 1)?)?;
    e.when(|e| {
        shot(context, e, &storage);
        hold(e, &output);
    });
    Ok(())
}

/// OSF: the second bit is on in the scan in which the rung becomes false.
fn falling(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    let storage = context.bit_target(operand(instruction, 0)?)?;
    let output = context.bit_target(operand(instruction, 1)?)?;
    e.when(|e| {
        // The same as a rising edge of what the rung is not, with the storage bit the other way round.
        storage.write(e, true);
        e.invert();
        match &storage {
            Bit::Plain(bit) => e.and(bit),
            other => {
                let scratch = context.scratch_long(0);
                e.math(&scratch, &other.term());
                e.and_compare(Relation::NotEqual, &scratch, "0");
            }
        }
        storage.write(e, false);
        hold(e, &output);
    });
    Ok(())
}

/// The bit follows the power flow and keeps its state over a stop.
fn hold(e: &mut Emitter, bit: &Bit) {
    match bit {
        Bit::Plain(bit) => e.hold(bit),
        other => {
            e.when(|e| other.write(e, true));
            e.unless(|e| other.write(e, false));
        }
    }
}
