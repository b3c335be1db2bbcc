//! The selectable timed interrupt as a call at the beginning of the scan, and what has no counterpart.

use domore::Rung;
use ladder::Instruction;

use super::allocate::Block;
use super::context::{Context, Converted, Person};
use super::control::append_call;
use super::emit::{Emitter, FIRST_SCAN, Relation};
use super::marks::Mark;
use super::operand::operand;
use super::table::{Row, row};

pub(super) const TABLE: &[Row] = &[
    row("STS", start),
    row("STE", |context, e, _| enable(context, e, true)),
    row("STD", |context, e, _| enable(context, e, false)),
    row("INT", |_, _, _| Ok(())),
    row("UID", masked),
    row("UIE", masked),
    row("UIF", masked),
    row("IID", masked),
    row("IIE", masked),
    row("RPI", masked),
];

/// The timed interrupt of a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Timed {
    /// Its program file.
    pub(super) file: u16,
    /// Stored period in milliseconds; 0: it is not running.
    pub(super) period: u32,
    /// Milliseconds of a unit of its set point.
    pub(super) unit: u32,
}

struct Helpers {
    period: String,
    part: String,
    on: String,
}

fn helpers(context: &mut Context<'_>) -> Helpers {
    Helpers {
        period: context.helper(Block::D, "slcStiPeriod", "period of the timed interrupt in milliseconds, 0 for none"),
        part: context.helper(Block::D, "slcStiTime", "milliseconds since the timed interrupt was due"),
        on: context.helper(Block::C, "slcStiOn", "the timed interrupt is enabled"),
    }
}

fn timed(context: &Context<'_>) -> Converted<Timed> {
    let missing = || Person::new(Mark::Interrupt, "the program has no routine for its timed interrupt");
    context.timed.clone().ok_or_else(missing)
}

/// STS: time of the period, before it the file on SLC 500.
fn start(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    let timed = timed(context)?;
    let last = instruction.operands.len().saturating_sub(1);
    if last > 0 {
        let file = operand(instruction, 0)?.to_string();
        if file.trim_start_matches("U:") != timed.file.to_string() {
            return Err(Person::new(Mark::Interrupt, format!("STS chooses file {file} for the timed interrupt")));
        }
    }
    let time = context.read_plain(e, operand(instruction, last)?, false, 1)?;
    let helpers = helpers(context);
    e.math(&helpers.period, &format!("{} * {}", time.text, timed.unit));
    e.mov("0", &helpers.part);
    e.set(&helpers.on);
    context.condition(Mark::Interrupt, "the timed interrupt runs at the beginning of a scan here, once in a scan");
    Ok(())
}

fn enable(context: &mut Context<'_>, e: &mut Emitter, on: bool) -> Converted {
    timed(context)?;
    let helpers = helpers(context);
    if on {
        e.set(&helpers.on);
    } else {
        e.reset(&helpers.on);
    }
    context.condition(Mark::Interrupt, "an interrupt that is due while disabled does not wait here");
    Ok(())
}

fn masked(_: &mut Context<'_>, _: &mut Emitter, instruction: &Instruction) -> Converted {
    let name = &instruction.mnemonic;
    Err(Person::new(Mark::Interrupt, format!("{name} controls interrupts that have no counterpart here")))
}

/// The rungs that call the routine, for the beginning of the program.
pub(super) fn rungs(context: &mut Context<'_>) -> Vec<Rung> {
    let Some(timed) = context.timed.clone() else { return Vec::new() };
    let Some(block) = context.subroutines.get(&timed.file).cloned() else { return Vec::new() };
    if timed.period == 0 && !context.facts.has("STS") {
        return Vec::new();
    }
    let elapsed = context.elapsed();
    let Helpers { period, part, on } = helpers(context);
    let mut first = Emitter::new();
    first.and(FIRST_SCAN);
    first.mov(&timed.period.to_string(), &period);
    first.mov("0", &part);
    if timed.period > 0 {
        first.set(&on);
    } else {
        first.reset(&on);
    }
    let mut first = Rung::new(first.finish());
    first.comment = Some(domore::Comment::plain([format!("timed interrupt, file {}", timed.file)]));
    let mut e = Emitter::new();
    e.and(&on);
    e.and_compare(Relation::Greater, &period, "0");
    e.math(&part, &format!("{part} + {elapsed}"));
    e.and_compare(Relation::GreaterOrEqual, &part, &period);
    e.math(&part, &format!("{part} - {period}"));
    append_call(&mut e, &block);
    vec![first, Rung::new(e.finish())]
}
