//! Sequencers: output, compare, load.

use ladder::FileType::R;

use crate::Families;
use crate::model::*;
use crate::row::*;

use super::control_operands::{LENGTH, POSITION, control};

const fn steps(length: usize, role: Role) -> Operand {
    op("File", role, Kind::File).reaching(Extent::Steps { length })
}

const fn stepping(name: &'static str, role: Role, kind: Kind, length: usize) -> Operand {
    op(name, role, kind).reaching(Extent::ValueOrSteps { length })
}

const CONTROL: Operand = control(&[rw(R, "EN"), rw(R, "DN"), w(R, "ER"), r(R, "LEN"), rw(R, "POS")]);
const COMPARING: Operand = control(&[rw(R, "EN"), rw(R, "DN"), w(R, "ER"), w(R, "FD"), r(R, "LEN"), rw(R, "POS")]);

const OUTPUT: &[Operand] = &[
    steps(4, Role::Read),
    stepping("Mask", Role::Read, Kind::Mask, 4),
    stepping("Dest", Role::Write, Kind::WordOrFile, 4),
    CONTROL,
    LENGTH,
    POSITION,
];
const COMPARE: &[Operand] = &[
    steps(4, Role::Read),
    stepping("Mask", Role::Read, Kind::Mask, 4),
    stepping("Source", Role::Read, Kind::WordOrFile, 4),
    COMPARING,
    LENGTH,
    POSITION,
];
const LOAD: &[Operand] =
    &[steps(3, Role::Write), stepping("Source", Role::Read, Kind::WordOrFile, 3), CONTROL, LENGTH, POSITION];

const fn sequencer(
    mnemonic: &'static str,
    title: &'static str,
    forms: &'static [Form],
    doc: &'static str,
) -> Instruction {
    Instruction {
        mnemonic,
        title,
        names: Names::Unconfirmed,
        category: Category::Sequencer,
        forms,
        status: INDEX_AND_ERROR,
        doc,
    }
}

pub(super) const SET: &[Instruction] = &[
    sequencer(
        "SQO",
        "Sequencer Output",
        &[form(0x2D, Evidence::Usage, Families::ALL, OUTPUT)
            .flags(&["EN", "DN"])
            .code(&[3, 1, 0, 2])
            .text(TextLevel::Published)],
        "Each time the rung becomes true, advances POS by one, from LENGTH back to 1. While the rung is true it writes the \
         file word at POS through the mask to the destination. Step 0 is used only at the start.",
    ),
    sequencer(
        "SQC",
        "Sequencer Compare",
        &[form(0x2E, Evidence::Samples, Families::ALL, COMPARE)
            .flags(&["EN", "DN", "FD"])
            .code(&[3, 1, 0, 2])
            .text(TextLevel::Published)],
        "Advances like SQO. While the rung is true, FD says whether the source equals the file word at POS in the bits of \
         the mask.",
    ),
    sequencer(
        "SQL",
        "Sequencer Load",
        &[form(
            0x40,
            Evidence::Samples,
            Families::SLC_5_02_UP.and(Families::ML_1000).and(Families::ML_FUNCTION_FILES),
            LOAD,
        )
        .flags(&["EN", "DN"])
        .code(&[2, 0, 1])
        .text(TextLevel::Published)],
        "Advances like SQO. While the rung is true it stores the source into the file word at POS, to teach a sequence.",
    ),
];
