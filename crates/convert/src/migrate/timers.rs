//! TON, TOF and RTO.
//!
//! A TON that nothing else touches, in a rung of every scan, becomes a `TMR` box with EN, TT, DN and ACC
//! written behind it. All others are written in registers and bits: EN, TT, DN and ACC change where the
//! original changes them, ACC stops at PRE, PRE and ACC are words that anything may read and write, and all
//! of it survives a stop. Their time comes from one free-running timer box.

use ladder::{FileType, Instruction, Operand, TimeBase};

use super::allocate::Block;
use super::context::{Context, Converted, Person};
use super::counters::Parts;
use super::emit::{Emitter, FIRST_SCAN, Relation};
use super::marks::Mark;
use super::operand::address;
use super::table::{Row, row};

pub(super) const TABLE: &[Row] = &[row("TON", on_delay), row("TOF", off_delay), row("RTO", retentive)];

const EN: u16 = 15;
const TT: u16 = 14;
const DN: u16 = 13;

/// What a timer's conversion works on.
struct Timer {
    en: String,
    tt: String,
    dn: String,
    pre: String,
    acc: String,
    part: String,
    /// Milliseconds since the timer was executed last.
    elapsed: String,
    /// On until the timer is executed for the first time after entering RUN.
    fresh: String,
    base: u32,
    /// No part of a tick is ever left: 1 ms, and no other instruction with another base.
    whole: bool,
}

/// The register with the part of a tick a timer has gathered, in milliseconds.
pub(super) fn part(context: &mut Context<'_>, parts: &Parts) -> String {
    let name = nickname(parts, "ms");
    context.helper(Block::D, &name, &format!("{}: milliseconds gathered towards the next tick", parts.name()))
}

fn nickname(parts: &Parts, suffix: &str) -> String {
    format!("{}_{suffix}", parts.name().replace(':', "_"))
}

impl Timer {
    fn of(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted<Timer> {
        let parts = Parts::of(context, instruction, FileType::T)?;
        let base = time_base(context, instruction)?;
        let elapsed;
        let fresh;
        // Two instructions on one timer: the second finds no time gone.
        if context.conditional || parts.instructions(context) > 1 {
            if context.conditional {
                context.needs.apart.insert(parts.name().to_owned());
            }
            let now = context.now();
            let last = nickname(&parts, "at");
            let last = context.helper(Block::D, &last, &format!("{}: time of its last execution", parts.name()));
            let gone = context.helper(Block::D, "slcGap", "time since the last execution of the timer at hand");
            let name = nickname(&parts, "new");
            let text = format!("{}: not executed yet since RUN", parts.name());
            fresh = context.helper(Block::C, &name, &text);
            context.needs.set.insert(fresh.clone());
            let gap = format!("IF({now} < {last}, {now} + 1000000000 - {last}, {now} - {last})");
            e.always(|e| {
                e.math(&gone, &gap);
                e.mov(&now, &last);
                e.and(&fresh);
                e.mov("0", &gone);
            });
            elapsed = gone;
        } else {
            elapsed = context.elapsed();
            fresh = FIRST_SCAN.to_owned();
        }
        Ok(Timer {
            en: parts.bit(context, EN)?,
            tt: parts.bit(context, TT)?,
            dn: parts.bit(context, DN)?,
            pre: parts.preset(context)?,
            acc: parts.accumulated(context)?,
            part: part(context, &parts),
            elapsed,
            fresh,
            base: base.milliseconds(),
            whole: base == TimeBase::Millisecond && parts.instructions(context) == 1,
        })
    }

    /// With power: adds the elapsed ticks to ACC, at most up to PRE.
    fn count(&self, e: &mut Emitter) {
        let Timer { pre, acc, part, elapsed, base, .. } = self;
        if self.whole {
            e.math(acc, &format!("IF({acc} + {elapsed} > {pre}, {pre}, {acc} + {elapsed})"));
            return;
        }
        e.math(part, &format!("{part} + {elapsed}"));
        e.math(acc, &format!("IF({acc} + {part} / {base} > {pre}, {pre}, {acc} + {part} / {base})"));
        e.math(part, &format!("IF({acc} < {pre}, {part} % {base}, 0)"));
    }

    /// With power: ACC and the part of a tick become 0.
    fn clear(&self, e: &mut Emitter) {
        e.mov("0", &self.acc);
        if !self.whole {
            e.mov("0", &self.part);
        }
    }

    /// The first execution is over.
    fn executed(&self, e: &mut Emitter) {
        if self.fresh != FIRST_SCAN {
            e.always(|e| e.reset(&self.fresh));
        }
    }
}

/// The time base in the box, else the one in the timer's own control word.
fn time_base(context: &Context<'_>, instruction: &Instruction) -> Converted<TimeBase> {
    let written = instruction.operands.get(1).map(Operand::to_string).and_then(|text| TimeBase::from_text(&text));
    let stored = || {
        let address = address(instruction, 0).ok()?;
        let file = context.image.data_file(FileType::T, address.file.number()?)?;
        file.timer(address.element.number()?)?.base()
    };
    written.or_else(stored).ok_or_else(|| Person::new(Mark::TimerBase, "the time base is not known"))
}

/// The original faults on a negative PRE or ACC.
fn negative(context: &mut Context<'_>, instruction: &Instruction) {
    let Ok(address) = address(instruction, 0) else { return };
    let (Some(file), Some(element)) = (address.file.number(), address.element.number()) else { return };
    let stored = context.image.data_file(FileType::T, file).and_then(|file| file.timer(element));
    let negative = stored.is_some_and(|timer| timer.pre < 0 || timer.acc < 0);
    let stays = |word| {
        let word = address.clone().with_word(word);
        context.facts.stays_within(&word, 0, i32::from(i16::MAX))
    };
    if negative || context.facts.timer_is_written(file, element) && !(stays(1) && stays(2)) {
        let text = format!("PRE and ACC of {address} can be written and must not be negative (fault 0034)");
        context.condition(Mark::TimerBase, text);
    }
}

/// A true rung of TON and RTO behind what is particular to each: counts and sets EN, TT, DN. The power
/// flow is the rung.
fn time_on(t: &Timer, e: &mut Emitter) {
    count_on(t, e);
    e.when(|e| {
        // Done lasts, once it is reached, while the timer stays enabled.
        e.when(|e| {
            e.and(&t.en);
            e.and(&t.dn);
            e.invert();
            e.and_compare(Relation::Less, &t.acc, &t.pre);
            e.reset(&t.dn);
        });
        e.and_compare(Relation::GreaterOrEqual, &t.acc, &t.pre);
        e.set(&t.dn);
    });
}

/// A TON whose timer nothing else changes, in a rung of every scan: a timer box keeps the time, EN, TT,
/// DN and ACC follow it. `false`: it is another one, nothing was appended.
fn plain_on_delay(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted<bool> {
    let address = address(instruction, 0)?;
    let (Some(file), Some(element)) = (address.file.number(), address.element.number()) else { return Ok(false) };
    let stored = context.image.data_file(FileType::T, file).and_then(|file| file.timer(element));
    let preset = stored.map_or(0, |timer| timer.pre);
    if context.conditional || preset < 1 || !context.facts.timer_is_plain(file, element) {
        return Ok(false);
    }
    let base = time_base(context, instruction)?.milliseconds();
    let Some(milliseconds) = i32::try_from(base).ok().and_then(|base| base.checked_mul(preset.into())) else {
        return Ok(false);
    };
    let parts = Parts::of(context, instruction, FileType::T)?;
    let (en, tt, dn) = (parts.bit(context, EN)?, parts.bit(context, TT)?, parts.bit(context, DN)?);
    let (pre, acc) = (parts.preset(context)?, parts.accumulated(context)?);
    let name = parts.name().replace(':', "_");
    let timer = context.helper(Block::T, &name, &format!("{}: its time", parts.name()));
    let done = format!("{timer}.Done");
    e.output("TMR", [timer.clone(), milliseconds.to_string()]);
    e.set(&en);
    let ticks = if base == 1 { format!("{timer}.Acc") } else { format!("{timer}.Acc / {base}") };
    e.math(&acc, &format!("IF({ticks} > {pre}, {pre}, {ticks})"));
    e.when(|e| {
        e.and(&done);
        e.hold(&dn);
    });
    e.when(|e| {
        e.and_not(&done);
        e.hold(&tt);
    });
    e.invert();
    e.reset(&en);
    e.mov("0", &acc);
    e.invert();
    Ok(true)
}

fn on_delay(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    if plain_on_delay(context, e, instruction)? {
        return Ok(());
    }
    negative(context, instruction);
    let t = Timer::of(context, e, instruction)?;
    // Stopped in mid-timing it starts again from 0.
    e.when(|e| {
        e.and(&t.fresh);
        e.reset(&t.en);
    });
    e.when(|e| {
        e.and_not(&t.en);
        t.clear(e);
    });
    time_on(&t, e);
    show_timing(&t, e);
    e.set(&t.en);
    e.invert();
    e.reset(&t.en);
    e.reset(&t.dn);
    t.clear(e);
    e.invert();
    t.executed(e);
    Ok(())
}

/// Counts what an enabled timer that is not done still has to time.
fn count_on(t: &Timer, e: &mut Emitter) {
    e.when(|e| {
        e.and(&t.en);
        e.and_not(&t.dn);
        e.and_compare(Relation::Less, &t.acc, &t.pre);
        t.count(e);
    });
}

/// TT is on while a timer times whose rung is true.
fn show_timing(t: &Timer, e: &mut Emitter) {
    e.when(|e| {
        e.and_not(&t.dn);
        e.hold(&t.tt);
    });
}

fn retentive(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    negative(context, instruction);
    let t = Timer::of(context, e, instruction)?;
    count_on(&t, e);
    e.when(|e| {
        e.and_compare(Relation::GreaterOrEqual, &t.acc, &t.pre);
        e.set(&t.dn);
    });
    show_timing(&t, e);
    e.hold(&t.en);
    t.executed(e);
    Ok(())
}

fn off_delay(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    negative(context, instruction);
    let t = Timer::of(context, e, instruction)?;
    // An off-delay that was interrupted does not resume.
    e.unless(|e| {
        e.and(&t.fresh);
        e.and_compare(Relation::GreaterOrEqual, &t.pre, "0");
        e.reset(&t.dn);
        e.mov(&t.pre, &t.acc);
    });
    e.unless(|e| {
        e.and(&t.dn);
        e.when(|e| {
            e.and(&t.tt);
            e.and_compare(Relation::Less, &t.acc, &t.pre);
            t.count(e);
        });
        e.and_compare(Relation::GreaterOrEqual, &t.acc, &t.pre);
        e.reset(&t.dn);
    });
    e.unless(|e| {
        if !t.whole {
            e.when(|e| {
                e.and_not(&t.dn);
                e.mov("0", &t.part);
            });
        }
        e.and(&t.dn);
        e.hold(&t.tt);
    });
    e.set(&t.dn);
    t.clear(e);
    e.hold(&t.en);
    t.executed(e);
    Ok(())
}
