//! JSR, JMP, LBL, RET, TND, MCR: what they append to their rung.

use std::collections::BTreeMap;

use ladder::Instruction;

use super::allocate::Block;
use super::context::{Context, Converted, Person};
use super::emit::{Contact, Emitter};
use super::marks::Mark;
use super::plan::{self, Zone};
use super::table::{Row, row};

pub(super) const TABLE: &[Row] = &[
    row("JSR", call),
    row("SBR", |_, _, _| Ok(())),
    row("LBL", |_, _, _| Ok(())),
    row("JMP", jump),
    row("RET", leave),
    row("TND", leave),
    row("MCR", zone),
    row("SUS", |_, _, _| Err(Person::new(Mark::NoCounterpart, "SUS stops the processor for debugging"))),
    row("REF", immediate),
    row("IIM", immediate),
    row("IOM", immediate),
    row("SVC", |context, _, _| {
        context.condition(Mark::AsyncIo, "SVC only serves communication in the middle of the scan: left out");
        Ok(())
    }),
];

/// Where the rung at hand stands.
#[derive(Clone, Debug)]
pub(super) struct Flow {
    /// Program file.
    pub(super) file: u16,
    /// Rung of each label.
    pub(super) labels: BTreeMap<u16, u32>,
    /// Where a return leads.
    pub(super) end: u32,
    /// Rungs can be skipped.
    pub(super) jumps: bool,
    /// First and last rung of each loop.
    pub(super) loops: Vec<(u32, u32)>,
    /// Number of the rung.
    pub(super) rung: u32,
    /// With respect to MCR zones.
    pub(super) zone: Zone,
    /// The file this rung calls follows in place.
    pub(super) in_place: Option<u16>,
}

/// The register that holds where a jump of a file leads.
pub(super) fn jump_register(context: &mut Context<'_>, file: u16) -> String {
    context.helper(Block::D, &format!("slcJump{file}"), &format!("file {file}: rung a jump leads to, 0 for none"))
}

/// The bit that is ON when the loop at a rung is over.
pub(super) fn loop_bit(context: &mut Context<'_>, file: u16, from: u32) -> String {
    let text = format!("file {file}: the loop at rung {from} is over");
    context.helper(Block::C, &format!("slcLoop{file}_{from}"), &text)
}

/// The bit that is ON while the zone of a file is true.
pub(super) fn zone_bit(context: &mut Context<'_>, file: u16) -> String {
    context.helper(Block::C, &format!("slcZone{file}"), &format!("file {file}: the MCR zone is true"))
}

/// Appends a call.
pub(super) fn append_call(e: &mut Emitter, block: &str) {
    e.output("CALL", std::iter::once(block).chain(super::forms::PLAIN_CALL));
}

fn flow<'c>(context: &'c Context<'_>) -> Converted<&'c Flow> {
    context.flow.as_ref().ok_or_else(|| Person::new(Mark::Flow, "outside a program file"))
}

fn call(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    let Some(file) = plan::called(instruction) else {
        return Err(Person::new(Mark::Operand, "JSR without a program file"));
    };
    if flow(context)?.in_place == Some(file) {
        return Ok(());
    }
    match context.subroutines.get(&file) {
        Some(name) => append_call(e, &name.clone()),
        None if file == 2 || context.image.program_file(file).is_some() => {
            return Err(Person::new(Mark::Flow, format!("JSR to file {file}, which runs already")));
        }
        None => return Err(Person::new(Mark::Fault, format!("JSR to file {file}, which does not exist"))),
    }
    Ok(())
}

fn jump(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    let (file, jumps) = (flow(context)?.file, flow(context)?.jumps);
    let target = plan::label(instruction).and_then(|label| flow(context).ok()?.labels.get(&label).copied());
    let Some(target) = target else {
        return Err(Person::new(Mark::Flow, "JMP to a label that is not there"));
    };
    let rung = flow(context)?.rung;
    let mut target = target;
    taken(context, e);
    if target <= rung {
        // Back: the rest of the loop is skipped, and the loop goes on.
        let last = flow(context)?.loops.iter().find(|found| found.0 == target).map(|found| found.1);
        let Some(last) = last else { return Err(Person::new(Mark::Flow, "a jump back that is no loop")) };
        let over = loop_bit(context, file, target);
        e.reset(&over);
        target = last.saturating_add(1);
    }
    if jumps && target > rung.saturating_add(1) {
        let register = jump_register(context, file);
        e.mov(&target.to_string(), &register);
    }
    Ok(())
}

/// A jump with instructions behind it in its rung: these get no power when it is taken.
fn taken(context: &mut Context<'_>, e: &mut Emitter) {
    if context.left == 0 {
        return;
    }
    let bit = context.helper(Block::C, "slcJumped", "a jump in the rung at hand was taken");
    match context.jumped {
        Some(_) => e.set(&bit),
        None => e.hold(&bit),
    }
    context.jumped = Some(bit);
}

/// RET and TND of the main program: the rest of the file is skipped.
fn leave(context: &mut Context<'_>, e: &mut Emitter, _: &Instruction) -> Converted {
    taken(context, e);
    let (file, jumps, end) = (flow(context)?.file, flow(context)?.jumps, flow(context)?.end);
    if jumps && end > flow(context)?.rung.saturating_add(1) {
        let register = jump_register(context, file);
        e.mov(&end.to_string(), &register);
    }
    Ok(())
}

fn zone(context: &mut Context<'_>, e: &mut Emitter, _: &Instruction) -> Converted {
    let (file, zone) = (flow(context)?.file, flow(context)?.zone);
    match zone {
        Zone::Opens => {
            let bit = zone_bit(context, file);
            e.out(&bit);
        }
        Zone::Turns => {
            // A false zone ends here; a true one goes on as this rung says.
            let bit = zone_bit(context, file);
            e.when(|e| {
                e.or(&Contact::Off(bit.clone()));
                e.hold(&bit);
            });
        }
        Zone::Outside | Zone::Inside | Zone::Closes => {}
    }
    Ok(())
}

fn immediate(_: &mut Context<'_>, _: &mut Emitter, instruction: &Instruction) -> Converted {
    let name = &instruction.mnemonic;
    Err(Person::new(Mark::ImmediateIo, format!("{name} transfers points in the middle of the scan")))
}
