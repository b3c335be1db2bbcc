//! Comparisons of two or three values.

use crate::Families;
use crate::model::*;
use crate::row::*;

const TWO: &[Operand] =
    &[op("Source A", Role::Read, Kind::Word).valued(), op("Source B", Role::Read, Kind::Word).valued()];
const MASKED: &[Operand] = &[
    op("Source", Role::Read, Kind::Word).valued(),
    op("Mask", Role::Read, Kind::Mask).valued(),
    op("Compare", Role::Read, Kind::Word).valued(),
];
const LIMITS: &[Operand] = &[
    op("Low Lim", Role::Read, Kind::Word).valued(),
    op("Test", Role::Read, Kind::Word).valued(),
    op("High Lim", Role::Read, Kind::Word).valued(),
];

const fn compare(
    mnemonic: &'static str,
    title: &'static str,
    forms: &'static [Form],
    doc: &'static str,
) -> Instruction {
    Instruction { mnemonic, title, names: Names::Printout, category: Category::Compare, forms, status: NOTHING, doc }
}

const fn two(opcode: u16, text: TextLevel) -> Form {
    form(opcode, Evidence::Printed, Families::ALL, TWO).input().text(text)
}

pub(super) const SET: &[Instruction] = &[
    compare("EQU", "Equal", &[two(0x32, TextLevel::Published)], "True while source A equals source B."),
    compare("NEQ", "Not Equal", &[two(0x33, TextLevel::Published)], "True while source A differs from source B."),
    compare(
        "GRT",
        "Greater Than (A>B)",
        &[two(0x34, TextLevel::Quoted)],
        "True while source A is greater than source B.",
    ),
    compare(
        "GEQ",
        "Grtr Than or Eql (A>=B)",
        &[two(0x35, TextLevel::Seen)],
        "True while source A is greater than or equal to source B.",
    ),
    compare("LES", "Less Than (A<B)", &[two(0x36, TextLevel::Published)], "True while source A is less than source B."),
    compare(
        "LEQ",
        "Less Than or Eql (A<=B)",
        &[two(0x37, TextLevel::Quoted)],
        "True while source A is less than or equal to source B.",
    ),
    Instruction {
        names: Names::Unconfirmed,
        ..compare(
            "MEQ",
            "Masked Equal",
            &[form(0x38, Evidence::Samples, Families::ALL, MASKED).input().text(TextLevel::Published)],
            "True while source and compare agree in every bit that is 1 in the mask.",
        )
    },
    compare(
        "LIM",
        "Limit Test",
        &[form(
            0x3F,
            Evidence::Printed,
            Families::SLC_5_02_UP.and(Families::ML_1000).and(Families::ML_FUNCTION_FILES),
            LIMITS,
        )
        .input()
        .code(&[1, 2, 0])
        .text(TextLevel::Published)],
        "With the low limit at or below the high limit: true while the test value is within both, limits included. \
         With the low limit above the high limit: true while the test value is at or outside them.",
    ),
];
