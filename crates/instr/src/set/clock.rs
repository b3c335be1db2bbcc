//! Clocks and short times.

use crate::Families;
use crate::model::*;
use crate::row::*;

const FAST_CLOCK: Families = Families::SLC_5_03_UP.and(Families::ML_1400);

const CLOCK: &[Operand] = &[op("Dest", Role::Write, Kind::Word)];
const DIFFERENCE: &[Operand] =
    &[op("Start", Role::Read, Kind::Word), op("Stop", Role::Read, Kind::Word), op("Dest", Role::Write, Kind::Word)];

/// RTA names no operand; the real-time clock it adjusts is listed with the other things it writes.
const ADJUSTED: &[&str] = &["RTC:0"];

const fn clock(mnemonic: &'static str, title: &'static str, forms: &'static [Form], doc: &'static str) -> Instruction {
    Instruction { mnemonic, title, names: Names::Unconfirmed, category: Category::Clock, forms, status: NOTHING, doc }
}

pub(super) const SET: &[Instruction] = &[
    clock(
        "RHC",
        "Read High Speed Clock",
        &[manual(FAST_CLOCK, CLOCK)],
        "Stores the free running clock of 10 µs ticks, which wraps after 10.48575 s. An integer takes its low 16 bits.",
    ),
    clock(
        "TDF",
        "Time Difference",
        &[manual(FAST_CLOCK, DIFFERENCE)],
        "Stores the ticks of 10 µs from a start to a stop stamp taken by RHC.",
    ),
    clock(
        "RTA",
        "Real Time Clock Adjust",
        &[form(0xAD, Evidence::Samples, Families::ML_FUNCTION_FILES, &[])],
        "Each time the rung becomes true, sets the real-time clock to the nearest minute.",
    )
    .writing(ADJUSTED),
];
