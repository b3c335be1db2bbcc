//! High-speed counters and pulse outputs.

use ladder::FileType::{C, HSC};

use crate::Families;
use crate::model::*;
use crate::row::*;

const PRESET: Operand = op("Preset", Role::Parameter, Kind::Preset).snapshot();
const ACCUM: Operand = op("Accum", Role::Parameter, Kind::Accum).snapshot();

const fn counter(touches: &'static [Touch]) -> Operand {
    op("Counter", Role::ReadWrite, Kind::Counter).touching(touches)
}

const COUNTING: Operand =
    counter(&[rw(C, "CU"), w(C, "CD"), rw(C, "DN"), w(C, "OV"), w(C, "UN"), rw(C, "UA"), r(C, "PRE"), rw(C, "ACC")]);

const FIXED_SLC: &[Operand] = &[COUNTING, PRESET, ACCUM];
const MICROLOGIX_1000: &[Operand] = &[
    op("Type", Role::Parameter, Kind::Choice),
    COUNTING,
    op("High Preset", Role::Parameter, Kind::Preset).snapshot(),
    ACCUM,
];
const ENABLED: &[Operand] = &[op("Counter", Role::Parameter, Kind::Counter)];
const LOADED: &[Operand] = &[
    op("HSC Number", Role::ReadWrite, Kind::HscNumber).touching(&[w(HSC, "HIP"), w(HSC, "LOP")]),
    op("High Preset", Role::Read, Kind::Word),
    op("Low Preset", Role::Read, Kind::Word),
    op("Output High Source", Role::Read, Kind::Word),
    op("Output Low Source", Role::Read, Kind::Word),
];
const LOADED_1000: &[Operand] = &[
    op("Counter", Role::ReadWrite, Kind::Counter),
    op("Source", Role::Read, Kind::Word).reaching(Extent::Words { length: 2 }),
    op("Length", Role::Parameter, Kind::Length),
];
const RESET: &[Operand] =
    &[op("Counter", Role::Write, Kind::HscNumber).touching(&[w(HSC, "ACC")]), op("Source", Role::Read, Kind::Word)];
const RESET_1000: &[Operand] =
    &[op("Counter", Role::Write, Kind::Counter).touching(&[w(C, "ACC")]), op("Source", Role::Read, Kind::Word)];
const PTO: &[Operand] = &[op("PTO Number", Role::ReadWrite, Kind::PtoNumber)];
const PWM: &[Operand] = &[op("PWM Number", Role::ReadWrite, Kind::PwmNumber)];

const fn fast(
    mnemonic: &'static str,
    title: &'static str,
    names: Names,
    forms: &'static [Form],
    doc: &'static str,
) -> Instruction {
    Instruction { mnemonic, title, names, category: Category::HighSpeed, forms, status: NOTHING, doc }
}

pub(super) const SET: &[Instruction] = &[
    fast(
        "HSC",
        "High Speed Counter",
        Names::Unconfirmed,
        &[
            manual(Families::SLC_FIXED, FIXED_SLC).flags(&["CU", "DN"]),
            manual(Families::ML_1000, MICROLOGIX_1000).flags(&["CU", "CD", "DN"]),
        ],
        "Counts pulses at a fast input in hardware, beside the program scan. The instruction enables the counter and \
         updates the counter element.",
    ),
    fast(
        "HSL",
        "High Speed Counter Load",
        Names::Printout,
        &[form(0x9B, Evidence::Printed, Families::ML_FUNCTION_FILES, LOADED), manual(Families::ML_1000, LOADED_1000)],
        "Loads presets and output patterns of a high-speed counter. MicroLogix 1000: takes mask, outputs and presets from \
         a block of words.",
    ),
    fast(
        "HSD",
        "HSC Interrupt Disable",
        Names::Unconfirmed,
        &[manual(Families::ML_1000, ENABLED)],
        "Disables the interrupt of the high-speed counter.",
    ),
    fast(
        "HSE",
        "HSC Interrupt Enable",
        Names::Unconfirmed,
        &[manual(Families::ML_1000, ENABLED)],
        "Enables the interrupt of the high-speed counter.",
    ),
    fast(
        "RAC",
        "Reset Accumulated Value",
        Names::Manual,
        &[form(0xA2, Evidence::Inferred, Families::ML_FUNCTION_FILES, RESET), manual(Families::ML_1000, RESET_1000)],
        "Sets the accumulator of a high-speed counter to the source value.",
    ),
    fast(
        "PTO",
        "Pulse Train Output",
        Names::Unconfirmed,
        &[form(0xA0, Evidence::Inferred, Families::ML_FUNCTION_FILES, PTO)],
        "Starts a train of pulses at a fast output: accelerate, run, decelerate, as set in its function file. A started \
         train runs to its end.",
    ),
    fast(
        "PWM",
        "Pulse Width Modulation",
        Names::Unconfirmed,
        &[form(0xA1, Evidence::Samples, Families::ML_FUNCTION_FILES, PWM)],
        "While the rung is true, drives a fast output with the frequency and duty cycle of its function file.",
    ),
];
