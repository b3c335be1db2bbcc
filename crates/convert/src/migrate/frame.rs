//! What stands before the first rung of the original and behind its last one: initial values, the
//! original's prescan, the clock, status words, the check of minor errors.

use std::collections::BTreeSet;

use domore::{Instruction, Rung};

use super::allocate::{Block, Element};
use super::context::Context;
use super::control::append_call;
use super::emit::{Contact, Emitter, FIRST_SCAN, Relation};
use super::initial::INIT_BLOCK;

/// Bits one rung of the prescan writes.
const BITS_PER_RUNG: usize = 16;

/// Limit at which the millisecond count starts again.
const ROUND: u32 = 1_000_000_000;

fn rung(e: Emitter, comment: &str) -> Rung {
    let mut rung = Rung::new(e.finish());
    if !comment.is_empty() {
        rung.comment = Some(domore::Comment::plain([comment.to_owned()]));
    }
    rung
}

/// The rungs before the program.
pub(super) fn before(context: &mut Context<'_>, has_initial: bool) -> Vec<Rung> {
    // Status words can need the clock, so they come first here and last in the program.
    let mut status = status_words(context);
    status.extend(super::interrupts::rungs(context));
    let mut rungs = Vec::new();
    if has_initial {
        let done = initialized(context);
        let mut e = Emitter::new();
        e.and_not(&done);
        append_call(&mut e, INIT_BLOCK);
        rungs.push(rung(e, "data of the original, once"));
    }
    prescan(context, &mut rungs);
    clock(context, &mut rungs);
    rungs.extend(status);
    rungs
}

/// The bit that is ON once initial values have been stored.
pub(super) fn initialized(context: &mut Context<'_>) -> String {
    context.helper(Block::C, "slcInitDone", "initial values have been stored; must be retentive")
}

/// Entering RUN: coils of the original go off, edge bits of counters come on.
fn prescan(context: &mut Context<'_>, rungs: &mut Vec<Rung>) {
    let clear = std::mem::take(&mut context.needs.clear);
    let set = std::mem::take(&mut context.needs.set);
    let found = std::mem::take(&mut context.needs.clear_found);
    if !found.is_empty() {
        let mut e = Emitter::new();
        e.and(FIRST_SCAN);
        found.iter().for_each(|bit| bit.write(&mut e, false));
        rungs.push(rung(e, "entering RUN: coils that are found at run time off, before the first rung"));
    }
    let mut outputs: Vec<Instruction> = Vec::new();
    for (first, last) in runs(&clear) {
        outputs.push(match last {
            Some(last) => Instruction::new("RSTR", [first, last]),
            None => Instruction::new("RST", [first]),
        });
    }
    // What is both (nothing but an odd program writes OTE C5:0/CU) ends as the original leaves it: set.
    outputs.extend(set.into_iter().map(|bit| Instruction::new("SET", [bit])));
    for (index, part) in outputs.chunks(BITS_PER_RUNG).enumerate() {
        let mut rung = Rung::new([Instruction::new("STR", [FIRST_SCAN])].into_iter().chain(part.iter().cloned()));
        if index == 0 {
            let text = "entering RUN: coils off, edge bits on, before the first rung";
            rung.comment = Some(domore::Comment::plain([text.to_owned()]));
        }
        rungs.push(rung);
    }
}

/// Bits in order, neighbours of one block as ranges.
fn runs(bits: &BTreeSet<String>) -> Vec<(String, Option<String>)> {
    let mut numbered: Vec<(String, u32)> = Vec::new();
    let mut others = Vec::new();
    for bit in bits {
        let digits = bit.bytes().rev().take_while(u8::is_ascii_digit).count();
        let (block, number) = bit.split_at(bit.len() - digits);
        match number.parse() {
            Ok(number) if matches!(block, "C" | "Y" | "X") => numbered.push((block.to_owned(), number)),
            _ => others.push((bit.clone(), None)),
        }
    }
    numbered.sort();
    let mut found: Vec<(String, u32, u32)> = Vec::new();
    for (block, number) in numbered {
        match found.last_mut() {
            Some(last) if last.0 == block && last.2.checked_add(1) == Some(number) => last.2 = number,
            _ => found.push((block, number, number)),
        }
    }
    let ranges = found.into_iter().map(|(block, first, last)| {
        let end = (last > first).then(|| format!("{block}{last}"));
        (format!("{block}{first}"), end)
    });
    ranges.chain(others).collect()
}

/// Milliseconds since the previous scan, from one timer that always runs.
fn clock(context: &mut Context<'_>, rungs: &mut Vec<Rung>) {
    if !context.needs.elapsed {
        return;
    }
    let elapsed = context.elapsed();
    let timer = context.helper(Block::T, "slcClock", "always running: the time all timers count");
    let last = context.helper(Block::D, "slcClockLast", "count of the clock in the previous scan");
    let mut e = Emitter::new();
    e.output("TMR", [timer.clone(), i32::MAX.to_string()]);
    rungs.push(rung(e, "time since the previous scan"));
    let mut e = Emitter::new();
    e.math(&elapsed, &format!("IF({timer}.Acc < {last}, 0, {timer}.Acc - {last})"));
    e.math(&last, &format!("{timer}.Acc"));
    if context.needs.now {
        let now = context.now();
        e.math(&now, &format!("({now} + {elapsed}) % {ROUND}"));
    }
    rungs.push(rung(e, ""));
    let mut e = Emitter::new();
    e.and_compare(Relation::GreaterOrEqual, &format!("{timer}.Acc"), &ROUND.to_string());
    e.math(&format!("{timer}.Acc"), &format!("{timer}.Acc - {ROUND}"));
    e.math(&last, &format!("{last} - {ROUND}"));
    rungs.push(rung(e, ""));
}

/// Fields of the clock with their status words and words of RTC:0.
const CLOCK: [(u16, &str); 7] =
    [(37, "Year"), (38, "Month"), (39, "Day"), (40, "Hour"), (41, "Minute"), (42, "Second"), (53, "DayOfWeek")];

/// Status words the controller itself keeps.
fn status_words(context: &mut Context<'_>) -> Vec<Rung> {
    let mut rungs = Vec::new();
    if context.status_words.contains(&4) {
        let (elapsed, word) = (context.elapsed(), context.status_word(4));
        let mut e = Emitter::new();
        if context.slc_like() {
            let part = context.helper(Block::D, "slcTick", "milliseconds towards the next count of S:4");
            e.math(&part, &format!("{part} + {elapsed}"));
            e.math(&word, &format!("(({word} + {part} / 10 + 32768) & 65535) - 32768"));
            e.math(&part, &format!("{part} % 10"));
        } else {
            e.math(&word, &format!("(({word} + {elapsed} * 10 + 32768) & 65535) - 32768"));
        }
        rungs.push(rung(e, "S:4, the free-running clock"));
    }
    if context.status_words.contains(&35) {
        // The time of the last scan: 100 microseconds on MicroLogix 1100 to 1500, else milliseconds.
        let (elapsed, word) = (context.elapsed(), context.status_word(35));
        let units = if context.slc_like() { elapsed.clone() } else { format!("{elapsed} * 10") };
        let mut e = Emitter::new();
        e.and_compare(Relation::Greater, &elapsed, "0");
        e.math(&word, &format!("IF({units} > 65535, -1, (({units} + 32768) & 65535) - 32768)"));
        rungs.push(rung(e, "S:35, the time of the last scan"));
    }
    let clock: Vec<_> = CLOCK.iter().filter(|(word, _)| context.status_words.contains(word)).collect();
    if !clock.is_empty() {
        let mut e = Emitter::new();
        for (word, field) in clock {
            let word = context.status_word(*word);
            e.mov(&format!("SDT0.{field}"), &word);
        }
        rungs.push(rung(e, "S:37 to S:42 and S:53, the clock"));
    }
    if context.reads_rtc {
        let mut e = Emitter::new();
        for (index, (_, field)) in CLOCK.iter().enumerate() {
            let word = u32::try_from(index).unwrap_or(0);
            if let Some(text) = context.places.word(ladder::FileType::RTC, 0, word) {
                e.mov(&format!("SDT0.{field}"), &text);
            }
        }
        if !e.is_empty() {
            rungs.push(rung(e, "RTC:0, the clock"));
        }
    }
    rungs
}

/// The rungs behind the program: minor errors stop it, as on the original at the end of the scan.
pub(super) fn after(context: &mut Context<'_>) -> Vec<Rung> {
    if !context.needs.minor_errors {
        return Vec::new();
    }
    let mut e = Emitter::new();
    e.and(&context.status_bit(5, 0));
    e.or(&Contact::On(context.status_bit(5, 2)));
    e.or(&Contact::On(context.status_bit(5, 3)));
    let fault = context.helper(Block::C, "slcFault", "the original would have stopped with major fault 0020");
    e.set(&fault);
    let outputs = context.places.used(Block::Y);
    if outputs > 0 {
        let last = Element { block: Block::Y, number: outputs - 1 };
        e.output("RSTR", ["Y0".to_owned(), last.to_string()]);
    }
    for number in 0..context.places.used(Block::Wy) {
        e.mov("0", &Element { block: Block::Wy, number }.to_string());
    }
    if !context.options.only_confirmed {
        e.output("HALT", ["$Main"]);
    }
    vec![rung(e, "S:5: a minor error at the end of the scan stops the program (major fault 0020)")]
}
