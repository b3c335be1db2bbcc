//! Process control: the PID loop.

use ladder::FileType::PD;

use crate::Families;
use crate::model::*;
use crate::row::*;

const TOUCHES: &[Touch] = &[
    r(PD, "TM"),
    r(PD, "AM"),
    r(PD, "CM"),
    r(PD, "OL"),
    r(PD, "RG"),
    r(PD, "SC"),
    w(PD, "TF"),
    r(PD, "DA"),
    w(PD, "DB"),
    w(PD, "UL"),
    w(PD, "LL"),
    w(PD, "SP"),
    w(PD, "PV"),
    w(PD, "DN"),
    w(PD, "EN"),
    r(PD, "SPS"),
    r(PD, "KC"),
    r(PD, "Ti"),
    r(PD, "TD"),
    r(PD, "FF"),
    r(PD, "MAXS"),
    r(PD, "MINS"),
    r(PD, "ZCD"),
    r(PD, "CVH"),
    r(PD, "CVL"),
    r(PD, "LUT"),
    w(PD, "SPV"),
    w(PD, "SE"),
    rw(PD, "CVP"),
];

const PROCESS: Operand = op("Process Variable", Role::Read, Kind::Word);
const CONTROL: Operand = op("Control Variable", Role::ReadWrite, Kind::Word);
const SETUP: Operand = op("Setup Screen", Role::Parameter, Kind::SetupScreen).blank();

const PID_FILE: &[Operand] =
    &[op("PID File", Role::ReadWrite, Kind::PidBlock).touching(TOUCHES), PROCESS, CONTROL, SETUP];
const PID_BLOCK: &[Operand] = &[
    op("Control Block", Role::ReadWrite, Kind::PidBlock).reaching(Extent::Block { words: 23 }),
    PROCESS,
    CONTROL,
    op("Control Block Length", Role::Parameter, Kind::Display).snapshot(),
    SETUP,
];

pub(super) const SET: &[Instruction] = &[Instruction {
    mnemonic: "PID",
    title: "PID",
    names: Names::Unconfirmed,
    category: Category::Process,
    forms: &[
        form(0x9F, Evidence::Inferred, Families::ML_FUNCTION_FILES, PID_FILE).text(TextLevel::Published),
        manual(Families::SLC_5_02_UP, PID_BLOCK).text(TextLevel::Unknown),
    ],
    status: &["S:13", "S:14"],
    doc: "Closes a control loop: computes the control variable (0 to 16383) from set point and process variable with \
          proportional, integral and derivative action. In timed mode it updates by its own loop time, in STI mode each \
          time it is executed.",
}];
