//! CTU, CTD and RES.
//!
//! Counters are written in registers and bits instead of counter boxes: CU, CD, DN, OV and UN, the wrap
//! at 32767 and the count over a stop are then those of the original, and nothing depends on details
//! of boxes that are not documented.

use ladder::{FileType, Instruction};

use super::context::{Context, Converted, Person};
use super::emit::{Emitter, Relation};
use super::marks::Mark;
use super::operand::address;
use super::table::{Row, row};

pub(super) const TABLE: &[Row] = &[
    row("CTU", |context, e, instruction| count(context, e, instruction, false)),
    row("CTD", |context, e, instruction| count(context, e, instruction, true)),
    row("RES", reset),
];

const CU: u16 = 15;
const CD: u16 = 14;
const DN: u16 = 13;
const OV: u16 = 12;
const UN: u16 = 11;

/// The parts of a structured element of three words.
pub(super) struct Parts {
    file_type: FileType,
    file: u16,
    word: u32,
}

impl Parts {
    /// The parts of the element an instruction names first.
    pub(super) fn of(context: &mut Context<'_>, instruction: &Instruction, file_type: FileType) -> Converted<Parts> {
        Parts::at(context, instruction, 0, file_type)
    }

    /// The parts of the element that operand `index` names.
    pub(super) fn at(
        context: &mut Context<'_>,
        instruction: &Instruction,
        index: usize,
        file_type: FileType,
    ) -> Converted<Parts> {
        let address = address(instruction, index)?;
        if address.file_type != file_type || address.bit.is_some() || address.word.is_some() {
            let wanted = file_type.description();
            return Err(Person::new(Mark::Operand, format!("{address} stands where a {wanted} belongs")));
        }
        if !address.is_direct() {
            let what = file_type.description();
            return Err(Person::new(Mark::Indirect, format!("{address}: a {what} chosen at run time")));
        }
        let found = context.places.word_of(address);
        let Some((file_type, file, word)) = found.filter(|(t, f, w)| context.places.span(*t, *f, *w).is_some()) else {
            return Err(Person::new(Mark::Operand, format!("{address} does not exist in the data table")));
        };
        context.note_beyond(address);
        Ok(Parts { file_type, file, word })
    }

    /// A bit of the control word.
    pub(super) fn bit(&self, context: &Context<'_>, bit: u16) -> Converted<String> {
        context.places.bit(self.file_type, self.file, self.word, bit).ok_or_else(lost)
    }

    /// The second word: PRE or LEN.
    pub(super) fn preset(&self, context: &Context<'_>) -> Converted<String> {
        context.places.word(self.file_type, self.file, self.word + 1).ok_or_else(lost)
    }

    /// The third word: ACC or POS.
    pub(super) fn accumulated(&self, context: &Context<'_>) -> Converted<String> {
        context.places.word(self.file_type, self.file, self.word + 2).ok_or_else(lost)
    }

    /// How many timer instructions work on the element.
    pub(super) fn instructions(&self, context: &Context<'_>) -> usize {
        context.facts.timer_instructions(self.file, u16::try_from(self.word / 3).unwrap_or(u16::MAX))
    }

    /// The element as the original spells it.
    pub(super) fn name(&self) -> String {
        format!("{}{}:{}", self.file_type, self.file, self.word / 3)
    }
}

fn lost() -> Person {
    Person::new(Mark::Operand, "the element has no words of its own in the map")
}

fn count(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction, down: bool) -> Converted {
    let parts = Parts::of(context, instruction, FileType::C)?;
    let (acc, pre) = (parts.accumulated(context)?, parts.preset(context)?);
    let rung = parts.bit(context, if down { CD } else { CU })?;
    let own = parts.bit(context, if down { UN } else { OV })?;
    let opposite = parts.bit(context, if down { OV } else { UN })?;
    let (last, first, step) = if down { ("-32768", "32767", "- 1") } else { ("32767", "-32768", "+ 1") };
    e.when(|e| {
        e.and_not(&rung);
        e.when(|e| {
            e.and_compare(Relation::Equal, &acc, last);
            if context.slc_like() {
                // Counting back over the wrap takes the other flag back instead of setting its own.
                e.when(|e| {
                    e.and_not(&opposite);
                    e.set(&own);
                });
                e.reset(&opposite);
            } else {
                e.set(&own);
            }
        });
        e.math(&acc, &format!("IF({acc} == {last}, {first}, {acc} {step})"));
    });
    e.hold(&rung);
    let done = parts.bit(context, DN)?;
    e.always(|e| {
        e.and_compare(Relation::GreaterOrEqual, &acc, &pre);
        e.hold(&done);
    });
    context.needs.set.insert(rung);
    Ok(())
}

fn reset(context: &mut Context<'_>, e: &mut Emitter, instruction: &Instruction) -> Converted {
    let file_type = address(instruction, 0)?.file_type;
    let bits: &[u16] = match file_type {
        FileType::T => &[15, 14, 13],
        FileType::C => &[CU, CD, DN, OV, UN],
        // IN and FD, 9 and 8, stay.
        FileType::R => &[15, 14, 13, 12, 11, 10],
        other => {
            let what = other.description();
            return Err(Person::new(Mark::Operand, format!("RES on a {what}")));
        }
    };
    let parts = Parts::of(context, instruction, file_type)?;
    for bit in bits {
        let bit = parts.bit(context, *bit)?;
        e.reset(&bit);
    }
    let acc = parts.accumulated(context)?;
    e.mov("0", &acc);
    if file_type == FileType::T {
        let part = super::timers::part(context, &parts);
        e.mov("0", &part);
    }
    Ok(())
}
