//! Timers: one form per time base.

use ladder::FileType::T;
use ladder::TimeBase;

use crate::Families;
use crate::model::*;
use crate::row::*;

const TOUCHES: &[Touch] = &[w(T, "EN"), w(T, "TT"), rw(T, "DN"), r(T, "PRE"), rw(T, "ACC")];

const OPERANDS: &[Operand] = &[
    op("Timer", Role::ReadWrite, Kind::Timer).touching(TOUCHES),
    op("Time Base", Role::Parameter, Kind::TimeBase),
    op("Preset", Role::Parameter, Kind::Preset).snapshot(),
    op("Accum", Role::Parameter, Kind::Accum).snapshot(),
];

/// The compiled code holds the timer only: base, preset and accumulator live in the element.
const fn timer(opcode: u16, base: TimeBase, evidence: Evidence, text: TextLevel) -> Form {
    let families = match base {
        TimeBase::Centisecond => Families::ALL,
        TimeBase::Second => Families::SLC_5_02_UP.and(Families::ML_1000).and(Families::ML_FUNCTION_FILES),
        TimeBase::Millisecond => Families::ML_FUNCTION_FILES,
    };
    form(opcode, evidence, families, OPERANDS).flags(&["EN", "DN"]).code(&[0]).base(base).text(text)
}

pub(super) const SET: &[Instruction] = &[
    Instruction {
        mnemonic: "TON",
        title: "Timer On Delay",
        names: Names::Printout,
        category: Category::Timer,
        forms: &[
            timer(0xA7, TimeBase::Millisecond, Evidence::Printed, TextLevel::Seen),
            timer(0x0F, TimeBase::Centisecond, Evidence::Printed, TextLevel::Seen),
            timer(0x56, TimeBase::Second, Evidence::Printed, TextLevel::Seen),
        ],
        status: NOTHING,
        doc: "Counts time while the rung is true; DN comes on when ACC reaches PRE. A false rung clears ACC, EN, TT \
              and DN. EN follows the rung, TT is on while it is timing.",
    },
    Instruction {
        mnemonic: "TOF",
        title: "Timer Off Delay",
        names: Names::Printout,
        category: Category::Timer,
        forms: &[
            timer(0xA6, TimeBase::Millisecond, Evidence::Printed, TextLevel::Published),
            timer(0x10, TimeBase::Centisecond, Evidence::Printed, TextLevel::Published),
            timer(0x55, TimeBase::Second, Evidence::Printed, TextLevel::Published),
        ],
        status: NOTHING,
        doc: "DN comes on with the rung and stays on until the rung has been false for PRE ticks. TT is on while it \
              is timing off. Resetting it with RES is unpredictable.",
    },
    Instruction {
        mnemonic: "RTO",
        title: "Retentive Timer On",
        names: Names::Printout,
        category: Category::Timer,
        forms: &[
            timer(0xA3, TimeBase::Millisecond, Evidence::Printed, TextLevel::Published),
            timer(0x0E, TimeBase::Centisecond, Evidence::Inferred, TextLevel::Published),
            timer(0x54, TimeBase::Second, Evidence::Printed, TextLevel::Published),
        ],
        status: NOTHING,
        doc: "Counts time while the rung is true and keeps ACC while it is false, through mode changes and power \
              loss too. DN comes on when ACC reaches PRE and stays on until a RES.",
    },
];
