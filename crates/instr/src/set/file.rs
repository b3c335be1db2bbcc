//! File instructions: copy, fill, bit shift, stacks, bit comparison.

use ladder::FileType::R;

use crate::Families;
use crate::model::*;
use crate::row::*;

use super::control_operands::{LENGTH, POSITION, control};

const COUNT: Operand = op("Length", Role::Parameter, Kind::Length);

const fn file(name: &'static str, role: Role, extent: Extent) -> Operand {
    op(name, role, Kind::File).reaching(extent)
}

/// LENGTH counts elements of the destination, on the source side too.
const OF_DEST: Extent = Extent::Elements { length: 2, size_of: 1 };

const COPIED: &[Operand] = &[file("Source", Role::Read, OF_DEST), file("Dest", Role::Write, OF_DEST), COUNT];
const FILLED: &[Operand] = &[op("Source", Role::Read, Kind::Word), file("Dest", Role::Write, OF_DEST), COUNT];
const WORDS: &[Operand] = &[
    file("Source", Role::Read, Extent::Words { length: 2 }),
    file("Dest", Role::Write, Extent::Words { length: 2 }),
    COUNT,
];

const SHIFTED: &[Operand] = &[
    file("File", Role::ReadWrite, Extent::Bits { length: 3 }),
    control(&[rw(R, "EN"), w(R, "DN"), w(R, "ER"), w(R, "UL"), r(R, "LEN")]),
    op("Bit Address", Role::Read, Kind::Bit),
    LENGTH,
];

const LOADING: Operand = control(&[rw(R, "EN"), rw(R, "DN"), w(R, "EM"), w(R, "ER"), r(R, "LEN"), rw(R, "POS")]);
const UNLOADING: Operand = control(&[rw(R, "EU"), w(R, "DN"), rw(R, "EM"), w(R, "ER"), r(R, "LEN"), rw(R, "POS")]);

const FIFO_IN: &[Operand] =
    &[op("Source", Role::Read, Kind::Word), stack("FIFO", 1, Role::Write), LOADING, LENGTH, POSITION];
const FIFO_OUT: &[Operand] =
    &[stack("FIFO", 0, Role::ReadWrite), op("Dest", Role::Write, Kind::Word), UNLOADING, LENGTH, POSITION];
const LIFO_IN: &[Operand] =
    &[op("Source", Role::Read, Kind::Word), stack("LIFO", 1, Role::Write), LOADING, LENGTH, POSITION];
const LIFO_OUT: &[Operand] =
    &[stack("LIFO", 0, Role::Read), op("Dest", Role::Write, Kind::Word), UNLOADING, LENGTH, POSITION];

const fn stack(name: &'static str, itself: usize, role: Role) -> Operand {
    file(name, role, Extent::Elements { length: 3, size_of: itself })
}

const fn compared(reference: Role) -> [Operand; 9] {
    const CONTROL: Operand =
        control(&[rw(R, "EN"), w(R, "DN"), w(R, "ER"), r(R, "IN"), w(R, "FD"), r(R, "LEN"), rw(R, "POS")]);
    [
        file("Source", Role::Read, Extent::Bits { length: 4 }),
        file("Reference", reference, Extent::Bits { length: 4 }),
        file("Result", Role::Write, Extent::Elements { length: 7, size_of: 2 }),
        CONTROL,
        LENGTH,
        POSITION,
        CONTROL,
        LENGTH,
        POSITION,
    ]
}

const BIT_COMPARED: &[Operand] = &compared(Role::Read);
const DETECTED: &[Operand] = &compared(Role::ReadWrite);

const fn entry(
    mnemonic: &'static str,
    title: &'static str,
    names: Names,
    status: &'static [&'static str],
    forms: &'static [Form],
    doc: &'static str,
) -> Instruction {
    Instruction { mnemonic, title, names, category: Category::File, forms, status, doc }
}

const STACKS: Families = Families::SLC_5_02_UP.and(Families::ML_1000).and(Families::ML_FUNCTION_FILES);

const fn copying(opcode: u16, families: Families, operands: &'static [Operand]) -> Form {
    form(opcode, Evidence::Printed, families, operands).code(&[2, 0, 1]).text(TextLevel::Published)
}

const fn shift(opcode: u16) -> Form {
    form(opcode, Evidence::Printed, Families::ALL, SHIFTED)
        .flags(&["EN", "DN"])
        .code(&[1, 2, 0])
        .text(TextLevel::Published)
}

/// The order in code (control first, then in box order) is taken over from SQO.
const fn loading(opcode: u16, operands: &'static [Operand]) -> Form {
    form(opcode, Evidence::Samples, STACKS, operands)
        .flags(&["EN", "DN", "EM"])
        .code(&[2, 0, 1])
        .text(TextLevel::Published)
}

const fn unloading(opcode: u16, operands: &'static [Operand]) -> Form {
    loading(opcode, operands).flags(&["EU", "DN", "EM"])
}

pub(super) const SET: &[Instruction] = &[
    entry(
        "COP",
        "Copy File",
        Names::Printout,
        INDEX,
        &[copying(0x22, Families::ALL, COPIED)],
        "Copies words as they are from one file to another. LENGTH counts elements of the destination, so a timer \
         destination of length 2 copies six words.",
    ),
    entry(
        "FLL",
        "Fill File",
        Names::Printout,
        INDEX,
        &[copying(0x21, Families::ALL, FILLED)],
        "Writes the source value into LENGTH elements of the destination file.",
    ),
    entry(
        "CPW",
        "Copy Word",
        Names::Printout,
        NOTHING,
        &[copying(0xAE, Families::ML_FUNCTION_FILES, WORDS)],
        "Copies LENGTH words between files of any types, function files included, without conversion.",
    ),
    entry(
        "BSL",
        "Bit Shift Left",
        Names::Printout,
        INDEX_AND_ERROR,
        &[shift(0x2C)],
        "Each time the rung becomes true, shifts LENGTH bits to the next higher bit number. The bit at the bit address \
         enters at the bottom, the bit that falls out goes to UL.",
    ),
    entry(
        "BSR",
        "Bit Shift Right",
        Names::Unconfirmed,
        INDEX_AND_ERROR,
        &[shift(0x2B)],
        "Each time the rung becomes true, shifts LENGTH bits to the next lower bit number. The bit at the bit address \
         enters at the top, the bit that falls out goes to UL.",
    ),
    entry(
        "FFL",
        "FIFO Load",
        Names::Manual,
        INDEX_AND_ERROR,
        &[loading(0x41, FIFO_IN)],
        "Each time the rung becomes true, puts the source at the end of the queue and raises POS. DN means the queue is \
         full and inhibits loading.",
    ),
    entry(
        "FFU",
        "FIFO Unload",
        Names::Manual,
        INDEX_AND_ERROR,
        &[unloading(0x42, FIFO_OUT)],
        "Each time the rung becomes true, takes the first value out of the queue, moves the others up and lowers POS. EM \
         means the queue is empty.",
    ),
    entry(
        "LFL",
        "LIFO Load",
        Names::Manual,
        INDEX_AND_ERROR,
        &[loading(0x43, LIFO_IN)],
        "Each time the rung becomes true, puts the source on top of the stack and raises POS. DN means the stack is \
         full and inhibits loading.",
    ),
    entry(
        "LFU",
        "LIFO Unload",
        Names::Manual,
        INDEX_AND_ERROR,
        &[unloading(0x44, LIFO_OUT)],
        "Each time the rung becomes true, takes the last value off the stack and lowers POS. EM means the stack is empty.",
    ),
    entry(
        "FBC",
        "File Bit Comparison",
        Names::Manual,
        INDEX_AND_ERROR,
        &[manual(Families::SLC_5_03_UP, BIT_COMPARED).flags(&["EN", "DN", "FD", "IN", "ER"])],
        "Compares bits of a source file with a reference file and stores the numbers of the bits that differ. One bit per \
         rung transition while IN is set, all of them in one scan otherwise.",
    ),
    entry(
        "DDT",
        "Diagnostic Detect",
        Names::Manual,
        INDEX_AND_ERROR,
        &[manual(Families::SLC_5_03_UP, DETECTED).flags(&["EN", "DN", "FD", "IN", "ER"])],
        "As FBC, and changes each differing bit of the reference file to the bit of the source file.",
    ),
];
