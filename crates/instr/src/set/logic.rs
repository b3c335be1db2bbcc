//! Moves and bitwise logic.

use crate::Families;
use crate::model::*;
use crate::row::*;

use super::math::SOURCE_DEST;

const THREE: &[Operand] = &[
    op("Source A", Role::Read, Kind::Word).valued(),
    op("Source B", Role::Read, Kind::Word).valued(),
    op("Dest", Role::Write, Kind::Word).valued(),
];
const MASKED: &[Operand] = &[
    op("Source", Role::Read, Kind::Word).valued(),
    op("Mask", Role::Read, Kind::Mask).valued(),
    op("Dest", Role::Write, Kind::Word).valued(),
];

const fn logic(mnemonic: &'static str, title: &'static str, forms: &'static [Form], doc: &'static str) -> Instruction {
    Instruction { mnemonic, title, names: Names::Printout, category: Category::Logic, forms, status: FLAGS, doc }
}

pub(super) const SET: &[Instruction] = &[
    logic(
        "MOV",
        "Move",
        &[form(0x1C, Evidence::Printed, Families::ALL, SOURCE_DEST).text(TextLevel::Quoted)],
        "Copies a value to the destination, converting it to the type of the destination. The source stays as it is.",
    ),
    logic(
        "MVM",
        "Masked Move",
        &[form(0x26, Evidence::Printed, Families::ALL, MASKED).text(TextLevel::Published)],
        "Copies the bits that are 1 in the mask; the other bits of the destination keep their state.",
    ),
    logic(
        "AND",
        "Bitwise AND",
        &[form(0x23, Evidence::Printed, Families::ALL, THREE).text(TextLevel::Published)],
        "Stores the bits that are 1 in both sources.",
    ),
    logic(
        "OR",
        "Bitwise Inclusive OR",
        &[form(0x24, Evidence::Printed, Families::ALL, THREE).text(TextLevel::Published)],
        "Stores the bits that are 1 in either source.",
    ),
    logic(
        "XOR",
        "Bitwise Exclusive OR",
        &[form(0x25, Evidence::Printed, Families::ALL, THREE).text(TextLevel::Published)],
        "Stores the bits in which the sources differ.",
    ),
    Instruction {
        names: Names::Unconfirmed,
        ..logic(
            "NOT",
            "NOT",
            &[form(0x1B, Evidence::Samples, Families::ALL, SOURCE_DEST).text(TextLevel::Published)],
            "Stores the source with every bit inverted.",
        )
    },
];
