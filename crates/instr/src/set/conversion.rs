//! Conversions between codes, and byte order.

use crate::Families;
use crate::model::*;
use crate::row::*;

use super::math::SOURCE_DEST;

const SWAPPED: &[Operand] = &[
    op("Source", Role::ReadWrite, Kind::File).reaching(Extent::Words { length: 1 }),
    op("Length", Role::Parameter, Kind::Length),
];

const fn conversion(
    mnemonic: &'static str,
    title: &'static str,
    status: &'static [&'static str],
    forms: &'static [Form],
    doc: &'static str,
) -> Instruction {
    Instruction { mnemonic, title, names: Names::Unconfirmed, category: Category::Conversion, forms, status, doc }
}

const fn sample(opcode: u16, families: Families) -> Form {
    form(opcode, Evidence::Samples, families, SOURCE_DEST).text(TextLevel::Published)
}

pub(super) const SET: &[Instruction] = &[
    Instruction {
        names: Names::Manual,
        ..conversion(
            "TOD",
            "To BCD",
            FLAGS_AND_REGISTER,
            &[sample(0x17, Families::ALL)],
            "Converts an integer to BCD. A word holds up to 9999; for more the destination must be S:13, which then \
             takes the digits together with S:14. A negative source converts as its absolute value.",
        )
    },
    conversion(
        "FRD",
        "From BCD",
        FLAGS,
        &[sample(0x18, Families::ALL)],
        "Converts BCD to an integer. With S:13 as the source the fifth digit comes from S:14.",
    ),
    conversion(
        "DCD",
        "Decode 4 to 1 of 16",
        NOTHING,
        &[sample(0x20, Families::ALL)],
        "Stores a word with one bit on: the bit whose number is in the low four bits of the source.",
    ),
    conversion(
        "ENC",
        "Encode 1 of 16 to 4",
        FLAGS,
        &[sample(0x64, Families::SLC_5_03_UP.and(Families::ML_1000).and(Families::ML_FUNCTION_FILES))],
        "Stores the number of the lowest bit that is on in the source. More than one bit on sets the overflow flag.",
    ),
    conversion(
        "GCD",
        "Gray Code",
        FLAGS,
        &[form(0xAF, Evidence::Samples, Families::ML_FUNCTION_FILES, SOURCE_DEST)],
        "Converts Gray code, as absolute encoders send it, to an integer.",
    ),
    conversion(
        "SWP",
        "Swap",
        NOTHING,
        &[form(0x96, Evidence::Inferred, Families::SLC_5_03_UP.and(Families::ML_FUNCTION_FILES), SWAPPED)
            .text(TextLevel::Published)],
        "Exchanges the low and the high byte of each of a number of words, counted in words whatever the file type.",
    ),
];
