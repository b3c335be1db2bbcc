//! Bit instructions: contacts, coils, one shots.

use crate::Families;
use crate::model::*;
use crate::row::*;

const EXAMINED: &[Operand] = &[op("Bit", Role::Read, Kind::Bit)];
const DRIVEN: &[Operand] = &[op("Bit", Role::Write, Kind::Bit)];
const STORAGE: &[Operand] = &[op("Storage Bit", Role::ReadWrite, Kind::Bit)];
const STORAGE_AND_OUTPUT: &[Operand] =
    &[op("Storage Bit", Role::ReadWrite, Kind::Bit), op("Output Bit", Role::Write, Kind::Bit)];

const SLC_AND_ML_1000: Families = Families::SLC.and(Families::ML_1000);

pub(super) const SET: &[Instruction] = &[
    Instruction {
        mnemonic: "XIC",
        title: "Examine If Closed",
        names: Names::Manual,
        category: Category::Bit,
        forms: &[form(0x39, Evidence::Printed, Families::ALL, EXAMINED).contact(false).text(TextLevel::Seen)],
        status: NOTHING,
        doc: "True while the bit is 1.",
    },
    Instruction {
        mnemonic: "XIO",
        title: "Examine If Open",
        names: Names::Manual,
        category: Category::Bit,
        forms: &[form(0x3A, Evidence::Printed, Families::ALL, EXAMINED).contact(true).text(TextLevel::Seen)],
        status: NOTHING,
        doc: "True while the bit is 0.",
    },
    Instruction {
        mnemonic: "OTE",
        title: "Output Energize",
        names: Names::Manual,
        category: Category::Bit,
        forms: &[form(0x2F, Evidence::Printed, Families::ALL, DRIVEN).coil("").text(TextLevel::Seen)],
        status: NOTHING,
        doc: "Makes the bit follow the rung: 1 while the rung is true, 0 while it is false.",
    },
    Instruction {
        mnemonic: "OTL",
        title: "Output Latch",
        names: Names::Manual,
        category: Category::Bit,
        forms: &[form(0x30, Evidence::Printed, Families::ALL, DRIVEN).coil("L").text(TextLevel::Seen)],
        status: NOTHING,
        doc: "Sets the bit while the rung is true and leaves it alone while the rung is false. \
              The bit stays 1 until something else clears it, usually an OTU.",
    },
    Instruction {
        mnemonic: "OTU",
        title: "Output Unlatch",
        names: Names::Manual,
        category: Category::Bit,
        forms: &[form(0x31, Evidence::Printed, Families::ALL, DRIVEN).coil("U").text(TextLevel::Seen)],
        status: NOTHING,
        doc: "Clears the bit while the rung is true and leaves it alone while the rung is false.",
    },
    Instruction {
        mnemonic: "ONS",
        title: "One Shot",
        names: Names::Manual,
        category: Category::Bit,
        forms: &[form(0xAB, Evidence::Printed, Families::ML_FUNCTION_FILES, STORAGE)
            .marked("ONS", Position::Input)
            .text(TextLevel::Quoted)],
        status: NOTHING,
        doc: "True for one scan when the conditions before it change from false to true. \
              The storage bit remembers their state and must not be used elsewhere.",
    },
    Instruction {
        mnemonic: "OSR",
        title: "One Shot Rising",
        names: Names::Printout,
        category: Category::Bit,
        forms: &[
            form(0x9E, Evidence::Printed, Families::ML_FUNCTION_FILES, STORAGE_AND_OUTPUT).text(TextLevel::Published),
            // Seen on the MicroLogix 1000 only; the SLC manuals draw the same symbol with one bit.
            form(0x3C, Evidence::Inferred, SLC_AND_ML_1000, STORAGE)
                .marked("OSR", Position::Input)
                .text(TextLevel::Published),
        ],
        status: NOTHING,
        doc: "SLC 500 and MicroLogix 1000: a condition, true for one scan when the conditions before it become \
              true. Other MicroLogix: an output that turns its output bit on for one scan when the rung becomes \
              true. The storage bit remembers the state of the rung.",
    },
    Instruction {
        mnemonic: "OSF",
        title: "One Shot Falling",
        names: Names::Printout,
        category: Category::Bit,
        forms: &[
            form(0x9D, Evidence::Printed, Families::ML_FUNCTION_FILES, STORAGE_AND_OUTPUT).text(TextLevel::Published)
        ],
        status: NOTHING,
        doc: "Turns its output bit on for one scan when the rung changes from true to false. \
              The storage bit remembers the state of the rung.",
    },
];
