//! Interrupts: user, timed, I/O.

use ladder::FileType::STI;

use crate::Families;
use crate::model::*;
use crate::row::*;

const NONE: &[Operand] = &[];
const TYPES: &[Operand] = &[op("Interrupt Types", Role::Read, Kind::InterruptTypes).reaching(Extent::Value)];
const SLOTS: &[Operand] = &[op("Slots", Role::Read, Kind::Slots).reaching(Extent::Value)];
const TIME: &[Operand] = &[op("Time", Role::Read, Kind::Word).touching(&[w(STI, "SPM")])];
const FILE_AND_TIME: &[Operand] = &[op("File", Role::Read, Kind::Word), op("Time", Role::Read, Kind::Word)];

/// Selectable timed interrupts of the processors that keep them in the status file.
const STATUS_FILE_STI: Families = Families::SLC_5_02_UP.and(Families::ML_1000);

const fn interrupt(
    mnemonic: &'static str,
    title: &'static str,
    forms: &'static [Form],
    doc: &'static str,
) -> Instruction {
    Instruction {
        mnemonic,
        title,
        names: Names::Unconfirmed,
        category: Category::Interrupt,
        forms,
        status: NOTHING,
        doc,
    }
}

const fn user(opcode: u16) -> Form {
    form(opcode, Evidence::Samples, Families::ML_FUNCTION_FILES, TYPES)
}

pub(super) const SET: &[Instruction] = &[
    interrupt(
        "INT",
        "I/O Interrupt",
        &[form(
            0x4B,
            Evidence::Samples,
            Families::SLC_5_02_UP.and(Families::ML_1000).and(Families::ML_FUNCTION_FILES),
            NONE,
        )
        .at(Position::RungStart)
        .text(TextLevel::Published)],
        "Marks a program file as an interrupt routine. First instruction of its first rung, always true.",
    ),
    Instruction {
        names: Names::Printout,
        ..interrupt(
            "STS",
            "Selectable Timed Start",
            &[form(0xA4, Evidence::Printed, Families::ML_FUNCTION_FILES, TIME), manual(STATUS_FILE_STI, FILE_AND_TIME)],
            "Starts the selectable timed interrupt with a new interval.",
        )
    }
    .writing(&["S:2/1", "S:30", "S:31"]),
    interrupt(
        "STD",
        "Selectable Timed Disable",
        &[manual(STATUS_FILE_STI, NONE).text(TextLevel::Published)],
        "Disables the selectable timed interrupt. Its timer keeps running.",
    )
    .writing(&["S:2/1"]),
    interrupt(
        "STE",
        "Selectable Timed Enable",
        &[manual(STATUS_FILE_STI, NONE).text(TextLevel::Published)],
        "Enables the selectable timed interrupt.",
    )
    .writing(&["S:2/1"]),
    interrupt("UID", "User Interrupt Disable", &[user(0xA8)], "Disables the interrupt sources chosen by the mask."),
    interrupt("UIE", "User Interrupt Enable", &[user(0xA9)], "Enables the interrupt sources chosen by the mask."),
    interrupt(
        "UIF",
        "User Interrupt Flush",
        &[user(0xAA)],
        "Discards waiting interrupts of the sources chosen by the mask.",
    ),
    interrupt(
        "IID",
        "I/O Interrupt Disable",
        &[manual(Families::SLC_5_02_UP, SLOTS)],
        "Disables I/O event interrupts of the chosen slots.",
    )
    .writing(&["S:27", "S:28"]),
    interrupt(
        "IIE",
        "I/O Interrupt Enable",
        &[manual(Families::SLC_5_02_UP, SLOTS)],
        "Enables I/O event interrupts of the chosen slots.",
    )
    .writing(&["S:27", "S:28"]),
    interrupt(
        "RPI",
        "Reset Pending Interrupt",
        &[manual(Families::SLC_5_02_UP, SLOTS)],
        "Discards pending I/O event interrupts of the chosen slots.",
    )
    .writing(&["S:25", "S:26"]),
];
