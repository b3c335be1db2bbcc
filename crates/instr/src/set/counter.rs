//! Counters and the reset instruction.

use ladder::FileType::{C, R, T};

use crate::Families;
use crate::model::*;
use crate::row::*;

const fn counter(touches: &'static [Touch]) -> Operand {
    op("Counter", Role::ReadWrite, Kind::Counter).touching(touches)
}

const PRESET: Operand = op("Preset", Role::Parameter, Kind::Preset).snapshot();
const ACCUM: Operand = op("Accum", Role::Parameter, Kind::Accum).snapshot();

const UP: &[Operand] =
    &[counter(&[rw(C, "CU"), w(C, "DN"), rw(C, "OV"), w(C, "UN"), r(C, "PRE"), rw(C, "ACC")]), PRESET, ACCUM];
const DOWN: &[Operand] =
    &[counter(&[rw(C, "CD"), w(C, "DN"), w(C, "OV"), rw(C, "UN"), r(C, "PRE"), rw(C, "ACC")]), PRESET, ACCUM];

const RESET: &[Operand] = &[op("Timer, Counter or Control", Role::Write, Kind::Resettable).touching(&[
    w(T, "EN"),
    w(T, "TT"),
    w(T, "DN"),
    w(T, "ACC"),
    w(C, "CU"),
    w(C, "CD"),
    w(C, "DN"),
    w(C, "OV"),
    w(C, "UN"),
    w(C, "ACC"),
    w(R, "EN"),
    w(R, "EU"),
    w(R, "DN"),
    w(R, "EM"),
    w(R, "ER"),
    w(R, "UL"),
    w(R, "POS"),
])];

pub(super) const SET: &[Instruction] = &[
    Instruction {
        mnemonic: "CTU",
        title: "Count Up",
        names: Names::Printout,
        category: Category::Counter,
        forms: &[form(0x11, Evidence::Printed, Families::ALL, UP)
            .flags(&["CU", "DN"])
            .code(&[0])
            .text(TextLevel::Published)],
        status: NOTHING,
        doc: "Adds 1 to ACC each time the rung changes from false to true; CU remembers the state of the rung. DN is \
              on while ACC is at or above PRE. Counting on past 32767 sets OV and continues at -32768.",
    },
    Instruction {
        mnemonic: "CTD",
        title: "Count Down",
        names: Names::Unconfirmed,
        category: Category::Counter,
        forms: &[form(0x12, Evidence::Printed, Families::ALL, DOWN)
            .flags(&["CD", "DN"])
            .code(&[0])
            .text(TextLevel::Published)],
        status: NOTHING,
        doc: "Subtracts 1 from ACC each time the rung changes from false to true; CD remembers the state of the \
              rung. DN is on while ACC is at or above PRE, as for CTU. Counting on below -32768 sets UN and \
              continues at 32767.",
    },
    Instruction {
        mnemonic: "RES",
        title: "Reset",
        names: Names::Manual,
        category: Category::Counter,
        forms: &[form(0x13, Evidence::Printed, Families::ALL, RESET).coil("RES").text(TextLevel::Published)],
        status: NOTHING,
        doc: "While the rung is true, clears ACC and the status bits of a timer or counter, or POS and the status \
              bits of a control element. PRE and LEN, and the IN and FD bits of a control element, are kept. Not for \
              a TOF.",
    },
];
