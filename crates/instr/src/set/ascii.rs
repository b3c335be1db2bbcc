//! ASCII port and string instructions.

use crate::Families;
use crate::model::*;
use crate::row::*;

use super::control_operands::ASCII_CONTROL;

const FAMILIES: Families = Families::SLC_5_03_UP.and(Families::ML_FUNCTION_FILES);

const fn string(name: &'static str, role: Role) -> Operand {
    op(name, role, Kind::String)
}

const CHANNEL: Operand = op("Channel", Role::Parameter, Kind::Channel);
const STRING_LENGTH: Operand = op("String Length", Role::Parameter, Kind::Length);
const ERROR: Operand = op("Error", Role::Parameter, Kind::Display).snapshot();

const fn shown(name: &'static str) -> Operand {
    op(name, Role::Parameter, Kind::Display).snapshot()
}

const BUFFER: &[Operand] = &[CHANNEL, ASCII_CONTROL, shown("Characters"), ERROR];
const CLEARED: &[Operand] = &[
    CHANNEL,
    op("Transmit Buffer", Role::Parameter, Kind::Choice),
    op("Receive Buffer", Role::Parameter, Kind::Choice),
];
const LINES: &[Operand] = &[
    CHANNEL,
    op("AND Mask", Role::Read, Kind::Mask),
    op("OR Mask", Role::Read, Kind::Mask),
    ASCII_CONTROL,
    shown("Channel Status"),
    ERROR,
];
const READ: &[Operand] =
    &[CHANNEL, string("Dest", Role::Write), ASCII_CONTROL, STRING_LENGTH, shown("Characters Read"), ERROR];
const WRITTEN: &[Operand] =
    &[CHANNEL, string("Source", Role::Read), ASCII_CONTROL, STRING_LENGTH, shown("Characters Sent"), ERROR];

const TO_INTEGER: &[Operand] = &[string("Source", Role::Read), op("Dest", Role::Write, Kind::Word).valued()];
const FROM_INTEGER: &[Operand] = &[op("Source", Role::Read, Kind::Word).valued(), string("Dest", Role::Write)];
const JOINED: &[Operand] =
    &[string("Source A", Role::Read), string("Source B", Role::Read), string("Dest", Role::Write)];
const EXTRACTED: &[Operand] = &[
    string("Source", Role::Read),
    op("Index", Role::Read, Kind::Word),
    op("Number", Role::Read, Kind::Word),
    string("Dest", Role::Write),
];
const SEARCHED: &[Operand] = &[
    string("Source", Role::Read),
    op("Index", Role::Read, Kind::Word),
    string("String Search", Role::Read),
    op("Result", Role::Write, Kind::Word).valued(),
];
const COMPARED: &[Operand] = &[string("Source A", Role::Read), string("Source B", Role::Read)];

const fn entry(
    mnemonic: &'static str,
    title: &'static str,
    names: Names,
    forms: &'static [Form],
    doc: &'static str,
) -> Instruction {
    Instruction { mnemonic, title, names, category: Category::Ascii, forms, status: STRING_ERROR, doc }
}

const fn port(form: Form) -> Form {
    form.flags(&["EN", "DN", "ER"])
}

pub(super) const SET: &[Instruction] = &[
    entry(
        "ABL",
        "ASCII Test For Line",
        Names::Unconfirmed,
        &[port(manual(FAMILIES, BUFFER))],
        "Counts the characters in the receive buffer up to and including the end-of-line characters. POS takes the count, \
         FD says that a line was found.",
    ),
    entry(
        "ACB",
        "ASCII Chars In Buffer",
        Names::Unconfirmed,
        &[port(manual(FAMILIES, BUFFER))],
        "Counts the characters in the receive buffer; POS takes the count.",
    ),
    Instruction {
        status: STRING_FLAGS,
        ..entry(
            "ACI",
            "String to Integer",
            Names::Printout,
            &[form(0x7A, Evidence::Printed, FAMILIES, TO_INTEGER)],
            "Converts the first number found in a string to an integer. Without a digit nothing is stored.",
        )
    },
    entry(
        "ACL",
        "ASCII Clear Buffers",
        Names::Unconfirmed,
        &[manual(FAMILIES, CLEARED)],
        "Clears the receive buffer, the transmit buffer or both of a channel, and ends waiting ASCII instructions.",
    ),
    entry(
        "ACN",
        "String Concatenate",
        Names::Printout,
        &[form(0x7B, Evidence::Printed, FAMILIES, JOINED)],
        "Stores source A followed by source B, cut at 82 characters.",
    ),
    entry(
        "AEX",
        "String Extract",
        Names::Printout,
        &[form(0x7D, Evidence::Printed, FAMILIES, EXTRACTED)],
        "Copies a number of characters of the source, starting at the index (1 is the first character).",
    ),
    entry(
        "AHL",
        "ASCII Handshake Lines",
        Names::Manual,
        &[port(form(0x7E, Evidence::Samples, FAMILIES, LINES))],
        "Sets or resets the DTR and RTS lines of a channel through two masks and shows the state of the lines.",
    ),
    Instruction {
        status: STRING_FLAGS,
        ..entry(
            "AIC",
            "Integer to String",
            Names::Unconfirmed,
            &[form(0x7F, Evidence::Usage, FAMILIES, FROM_INTEGER)],
            "Writes an integer as decimal characters, with a minus sign where needed, without padding.",
        )
    },
    entry(
        "ARD",
        "ASCII Read",
        Names::Unconfirmed,
        &[port(form(0x80, Evidence::Samples, FAMILIES, READ))],
        "Started by a rising rung: reads a number of characters from the receive buffer into a string, in the background. \
         DN comes on at the end, POS takes the number read.",
    ),
    entry(
        "ARL",
        "ASCII Read Line",
        Names::Unconfirmed,
        &[port(form(0x81, Evidence::Samples, FAMILIES, READ))],
        "As ARD, up to the end-of-line characters of the channel.",
    ),
    entry(
        "ASC",
        "String Search",
        Names::Printout,
        &[form(0x82, Evidence::Printed, FAMILIES, SEARCHED)],
        "Searches the string named String Search from the index for the source. The result is the position of the first \
         match, counted from 1, or 0.",
    ),
    entry(
        "ASR",
        "ASCII String Compare",
        Names::Printout,
        &[form(0x85, Evidence::Printed, FAMILIES, COMPARED).input()],
        "True while both strings have the same length and the same characters, upper and lower case apart.",
    ),
    entry(
        "AWA",
        "ASCII Write Append",
        Names::Manual,
        &[port(form(0x83, Evidence::Samples, FAMILIES, WRITTEN))],
        "Started by a rising rung: sends characters of a string and the two append characters of the channel (usually CR \
         LF), in the background. RSLogix stores AWT with the same code, so this can also be an AWT.",
    ),
    entry(
        "AWT",
        "ASCII Write",
        Names::Manual,
        &[port(form(0x83, Evidence::Samples, FAMILIES, WRITTEN).with_code_of("AWA"))],
        "As AWA without the append characters. RSLogix stores it with the code of AWA.",
    ),
];
