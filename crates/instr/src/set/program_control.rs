//! Program flow: jumps, subroutines, zones, ends, immediate I/O.

use crate::Families;
use crate::model::*;
use crate::row::*;

const NONE: &[Operand] = &[];
const LABEL: &[Operand] = &[op("Label", Role::Parameter, Kind::Label)];
const SUBROUTINE: &[Operand] = &[op("SBR File Number", Role::Parameter, Kind::ProgramFile)];
const SUSPEND: &[Operand] = &[op("Suspend ID", Role::Parameter, Kind::Constant)];
const IMMEDIATE_IN: &[Operand] = &[
    op("Slot", Role::Write, Kind::Slot).reaching(Extent::Words { length: 2 }),
    op("Mask", Role::Read, Kind::Mask),
    op("Length", Role::Parameter, Kind::Length),
];
const IMMEDIATE_OUT: &[Operand] = &[
    op("Slot", Role::Read, Kind::Slot).reaching(Extent::Words { length: 2 }),
    op("Mask", Role::Read, Kind::Mask),
    op("Length", Role::Parameter, Kind::Length),
];
const CHANNELS: &[Operand] =
    &[op("Channel 0", Role::Parameter, Kind::Choice), op("Channel 1", Role::Parameter, Kind::Choice)];

const fn flow(
    mnemonic: &'static str,
    title: &'static str,
    names: Names,
    forms: &'static [Form],
    doc: &'static str,
) -> Instruction {
    Instruction { mnemonic, title, names, category: Category::ProgramControl, forms, status: NOTHING, doc }
}

pub(super) const SET: &[Instruction] = &[
    flow(
        "JMP",
        "Jump",
        Names::Manual,
        &[form(0x16, Evidence::Printed, Families::ALL, LABEL).coil("JMP").text(TextLevel::Published)],
        "Goes on at the LBL with the same number in the same program file. The rungs between are not executed: their \
         outputs keep their state.",
    ),
    flow(
        "LBL",
        "Label",
        Names::Manual,
        &[form(0x3B, Evidence::Printed, Families::ALL, LABEL)
            .marked("LBL", Position::RungStart)
            .text(TextLevel::Published)],
        "Target of JMP. Stands first in its rung and is always true.",
    ),
    flow(
        "JSR",
        "Jump To Subroutine",
        Names::Printout,
        &[form(0x15, Evidence::Printed, Families::ALL, SUBROUTINE).text(TextLevel::Seen)],
        "While the rung is true, executes another program file and returns. While it is false the file is not scanned: its \
         outputs and timers keep their state.",
    ),
    flow(
        "SBR",
        "Subroutine",
        Names::Printout,
        &[form(0x3D, Evidence::Printed, Families::ALL, NONE).at(Position::RungStart).text(TextLevel::Published)],
        "Marks the start of a subroutine. First instruction of the first rung of the file, always true, not required.",
    ),
    flow(
        "RET",
        "Return",
        Names::Printout,
        &[form(0x09, Evidence::Printed, Families::ALL, NONE).text(TextLevel::Published)],
        "While the rung is true, ends the subroutine. Without one the file returns at its end.",
    ),
    flow(
        "MCR",
        "Master Control Reset",
        Names::Manual,
        &[form(0x08, Evidence::Usage, Families::ALL, NONE).coil("MCR").text(TextLevel::Published)],
        "In pairs: opens a zone behind conditions, and closes it alone on a rung. While the conditions are false the rungs \
         of the zone are scanned as false: coils drop, latched bits and counts stay.",
    ),
    flow(
        "TND",
        "Temporary End",
        Names::Manual,
        &[form(0x0B, Evidence::Samples, Families::ALL, NONE).coil("TND").text(TextLevel::Published)],
        "While the rung is true, ends the program scan here.",
    ),
    flow(
        "SUS",
        "Suspend",
        Names::Unconfirmed,
        &[form(0x1F, Evidence::Samples, Families::ALL, SUSPEND).text(TextLevel::Published)],
        "While the rung is true, stops the program in suspend mode and stores its number in S:7 and the program file in \
         S:8. A debugging aid.",
    )
    .writing(&["S:1/0", "S:7", "S:8"]),
    flow(
        "END",
        "End",
        Names::Manual,
        &[form(0x0C, Evidence::Printed, Families::ALL, NONE)
            .coil("END")
            .at(Position::FileEnd)
            .text(TextLevel::Published)],
        "Ends a program file. RSLogix adds it; it stands alone in the last rung.",
    ),
    flow(
        "IIM",
        "Immediate Input w/Mask",
        Names::Unconfirmed,
        &[form(0x5D, Evidence::Samples, Families::ALL, IMMEDIATE_IN).text(TextLevel::Published)],
        "Reads inputs of one slot now, in the middle of the scan, for the bits that are 1 in the mask.",
    ),
    flow(
        "IOM",
        "Immediate Output w/Mask",
        Names::Unconfirmed,
        &[form(0x5E, Evidence::Samples, Families::ALL, IMMEDIATE_OUT).text(TextLevel::Published)],
        "Writes outputs of one slot now, in the middle of the scan, for the bits that are 1 in the mask.",
    ),
    flow(
        "REF",
        "I/O Refresh",
        Names::Unconfirmed,
        &[
            form(0x48, Evidence::Samples, Families::ML_FUNCTION_FILES.and(Families::SLC_5_02), NONE)
                .text(TextLevel::Published),
            manual(Families::SLC_5_03_UP, CHANNELS).text(TextLevel::Unknown),
        ],
        "Interrupts the scan to update inputs and outputs and to service communication, then goes on.",
    ),
];

impl Instruction {
    pub(super) const fn writing(self, status: &'static [&'static str]) -> Instruction {
        Instruction { status, ..self }
    }
}
