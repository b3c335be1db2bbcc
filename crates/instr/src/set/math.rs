//! Arithmetic, scaling, functions and CPT.

use crate::Families;
use crate::model::*;
use crate::row::*;

const THREE: &[Operand] = &[
    op("Source A", Role::Read, Kind::Word).valued(),
    op("Source B", Role::Read, Kind::Word).valued(),
    op("Dest", Role::Write, Kind::Word).valued(),
];
pub(super) const SOURCE_DEST: &[Operand] =
    &[op("Source", Role::Read, Kind::Word).valued(), op("Dest", Role::Write, Kind::Word).valued()];
const DEST: &[Operand] = &[op("Dest", Role::Write, Kind::Word).valued()];
const SCALED: &[Operand] = &[
    op("Source", Role::Read, Kind::Word).valued(),
    op("Rate [/10000]", Role::Read, Kind::Word).valued(),
    op("Offset", Role::Read, Kind::Word).valued(),
    op("Dest", Role::Write, Kind::Word).valued(),
];
const PARAMETERS: &[Operand] = &[
    op("Input", Role::Read, Kind::Word).valued(),
    op("Input Min.", Role::Read, Kind::Word).valued(),
    op("Input Max.", Role::Read, Kind::Word).valued(),
    op("Scaled Min.", Role::Read, Kind::Word).valued(),
    op("Scaled Max.", Role::Read, Kind::Word).valued(),
    op("Output", Role::Write, Kind::Word).valued(),
];
const COMPUTED: &[Operand] = &[
    op("Dest", Role::Write, Kind::Word).valued(),
    op("Expression", Role::Read, Kind::Expression).reaching(Extent::Value),
];
const RAMPED: &[Operand] = &[
    op("Control", Role::ReadWrite, Kind::ControlBlock).reaching(Extent::Block { words: 7 }),
    op("Dest", Role::Write, Kind::Word),
];

/// Everything but the small processors.
const SCALING: Families = Families::SLC_5_02_UP.and(Families::ML_1000).and(Families::ML_FUNCTION_FILES);
const FLOATING: Families = Families::SLC_5_03_UP.and(Families::ML_FUNCTION_FILES);
const FUNCTIONS: Families = Families::SLC_5_03_UP.and(Families::ML_1400);

const fn math(mnemonic: &'static str, title: &'static str, forms: &'static [Form], doc: &'static str) -> Instruction {
    Instruction { mnemonic, title, names: Names::Printout, category: Category::Math, forms, status: FLAGS, doc }
}

const FUNCTION: &[Form] = &[manual(FUNCTIONS, SOURCE_DEST)];

/// A function of one value, of which no code is known.
const fn function(mnemonic: &'static str, title: &'static str, doc: &'static str) -> Instruction {
    Instruction { names: Names::Unconfirmed, ..math(mnemonic, title, FUNCTION, doc) }
}

const fn three(opcode: u16, text: TextLevel) -> Form {
    form(opcode, Evidence::Printed, Families::ALL, THREE).text(text)
}

pub(super) const SET: &[Instruction] = &[
    math(
        "ADD",
        "Add",
        &[three(0x27, TextLevel::Seen)],
        "Adds source B to source A. An integer result that does not fit sets the overflow flag and is limited, or \
         cut to its low bits when S:2/14 is 1.",
    ),
    math(
        "SUB",
        "Subtract",
        &[three(0x28, TextLevel::Seen)],
        "Subtracts source B from source A. Overflow is handled as by ADD.",
    ),
    Instruction {
        status: FLAGS_AND_REGISTER,
        ..math(
            "MUL",
            "Multiply",
            &[three(0x29, TextLevel::Seen)],
            "Multiplies source A by source B. The 32-bit product of two words also goes to the math register S:14, S:13.",
        )
    },
    Instruction {
        status: FLAGS_AND_REGISTER,
        ..math(
            "DIV",
            "Divide",
            &[three(0x2A, TextLevel::Seen)],
            "Divides source A by source B and rounds. The unrounded quotient and the remainder of integers go to S:14 \
             and S:13. Division by zero sets the overflow flag.",
        )
    },
    Instruction {
        status: FLAGS_AND_REGISTER,
        names: Names::Unconfirmed,
        ..math(
            "DDV",
            "Double Divide",
            &[manual(Families::SLC.and(Families::ML_1000), SOURCE_DEST).text(TextLevel::Published)],
            "Divides the 32-bit math register S:14, S:13 by the source and stores the rounded quotient. The unrounded \
             quotient and the remainder go back to the math register.",
        )
    },
    Instruction {
        names: Names::Unconfirmed,
        ..math(
            "NEG",
            "Negate",
            &[form(0x1E, Evidence::Samples, Families::ALL, SOURCE_DEST).text(TextLevel::Published)],
            "Stores the source with its sign changed.",
        )
    },
    math(
        "CLR",
        "Clear",
        &[form(0x14, Evidence::Printed, Families::ALL, DEST).text(TextLevel::Seen)],
        "Stores 0 in the destination.",
    ),
    Instruction {
        names: Names::Unconfirmed,
        ..math(
            "SQR",
            "Square Root",
            &[form(0x46, Evidence::Printed, SCALING, SOURCE_DEST).text(TextLevel::Published)],
            "Stores the square root of the absolute value of the source, rounded for an integer destination.",
        )
    },
    math(
        "ABS",
        "Absolute Value",
        &[form(0x98, Evidence::Printed, FLOATING, SOURCE_DEST).text(TextLevel::Published)],
        "Stores the source without its sign.",
    ),
    Instruction {
        names: Names::Unconfirmed,
        ..math(
            "SCL",
            "Scale",
            &[form(0x45, Evidence::Samples, SCALING, SCALED).text(TextLevel::Published)],
            "Stores source × rate / 10000 + offset, rounded.",
        )
    },
    math(
        "SCP",
        "Scale w/Parameters",
        &[form(0x95, Evidence::Printed, FLOATING, PARAMETERS).text(TextLevel::Published)],
        "Scales the input along the straight line that maps the input range to the scaled range. An input outside its \
         range is not limited.",
    ),
    Instruction {
        names: Names::Unconfirmed,
        status: FLAGS_AND_REGISTER,
        ..math(
            "CPT",
            "Compute",
            &[form(0x8A, Evidence::Inferred, FUNCTIONS, COMPUTED).code(&[]).text(TextLevel::Published)],
            "Evaluates an expression (+ - * and | for division, powers, functions) and stores the result.",
        )
    },
    function("XPY", "X To the Power of Y", "Raises source A to the power of source B.")
        .with_forms(&[manual(FUNCTIONS, THREE)]),
    function("LN", "Natural Log", "Stores the natural logarithm of the source."),
    function("LOG", "Log Base 10", "Stores the logarithm to base 10 of the source."),
    function("SIN", "Sine", "Stores the sine of the source, an angle in radians."),
    function("COS", "Cosine", "Stores the cosine of the source, an angle in radians."),
    function("TAN", "Tangent", "Stores the tangent of the source, an angle in radians."),
    function("ASN", "Arc Sine", "Stores the angle in radians whose sine is the source."),
    function("ACS", "Arc Cosine", "Stores the angle in radians whose cosine is the source."),
    function("ATN", "Arc Tangent", "Stores the angle in radians whose tangent is the source."),
    function("DEG", "Radians to Degrees", "Converts an angle from radians to degrees."),
    function("RAD", "Degrees to Radians", "Converts an angle from degrees to radians."),
    Instruction {
        names: Names::Unconfirmed,
        status: NOTHING,
        ..math(
            "RMP",
            "Ramp",
            &[manual(Families::SLC_5_03_UP, RAMPED).text(TextLevel::Unknown)],
            "Moves the destination from a start to an end value over a set time, along a line or a curve. The control \
             block holds settings, elapsed time and the done bit.",
        )
    },
];

impl Instruction {
    const fn with_forms(self, forms: &'static [Form]) -> Instruction {
        Instruction { forms, ..self }
    }
}
