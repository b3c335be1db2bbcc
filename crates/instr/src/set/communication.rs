//! Messages, block transfers, communication service.

use ladder::FileType::MG;

use crate::Families;
use crate::model::*;
use crate::row::*;

const TOUCHES: &[Touch] =
    &[rw(MG, "EN"), w(MG, "EW"), w(MG, "ST"), w(MG, "DN"), w(MG, "ER"), rw(MG, "TO"), r(MG, "NOD"), r(MG, "MTO")];

const SETUP: Operand = op("Setup Screen", Role::Parameter, Kind::SetupScreen).blank();
const MESSAGE_FILE: Operand = op("MSG File", Role::ReadWrite, Kind::MessageBlock).touching(TOUCHES);

/// How many words a message moves, and in which direction, is decided by its set-up.
const fn data(name: &'static str, role: Role) -> Operand {
    op(name, role, Kind::Word).reaching(Extent::Open)
}

const LOCAL: &[Operand] = &[MESSAGE_FILE, SETUP, data("Data Table Address", Role::ReadWrite)];
const ROUTED: &[Operand] = &[
    MESSAGE_FILE,
    SETUP,
    data("Data Table Address (Receive)", Role::Write),
    data("Data Table Address (Send)", Role::Read),
    op("Routing Information File", Role::Read, Kind::RoutingBlock),
];
// Saved by RSLogix with the last two still unset.
const SAMPLED: &[Operand] = &[
    MESSAGE_FILE,
    SETUP,
    op("Operand 3", Role::Parameter, Kind::Unidentified),
    op("Operand 4", Role::Parameter, Kind::Unidentified),
];

const CHOICES: [Operand; 4] = [
    op("Type", Role::Parameter, Kind::Choice),
    op("Read/Write", Role::Parameter, Kind::Choice),
    op("Target Device", Role::Parameter, Kind::Choice),
    op("Local/Remote", Role::Parameter, Kind::Choice),
];
const BLOCK: Operand = op("Control Block", Role::ReadWrite, Kind::ControlBlock).reaching(Extent::Open);
const BLOCK_LENGTH: Operand = op("Control Block Length", Role::Parameter, Kind::Display).snapshot();
const SLC_MESSAGE: &[Operand] = &[CHOICES[0], CHOICES[1], CHOICES[2], CHOICES[3], BLOCK, BLOCK_LENGTH, SETUP];
const ML_1000_MESSAGE: &[Operand] = &[CHOICES[1], CHOICES[2], BLOCK, BLOCK_LENGTH, SETUP];
const EXPLICIT: &[Operand] = &[BLOCK, BLOCK_LENGTH, SETUP];

const SERVICE: &[Operand] = &[op("Channel Select", Role::Read, Kind::Mask)];
const CHANNELS: &[Operand] =
    &[op("Channel 0", Role::Parameter, Kind::Choice), op("Channel 1", Role::Parameter, Kind::Choice)];

const fn transferred(data_role: Role) -> [Operand; 6] {
    [
        op("Rack", Role::Parameter, Kind::Constant),
        op("Group", Role::Parameter, Kind::Constant),
        op("Slot", Role::Parameter, Kind::Constant),
        op("Control", Role::ReadWrite, Kind::ControlBlock).reaching(Extent::Block { words: 3 }),
        op("Data", data_role, Kind::Word).reaching(Extent::Block { words: 64 }),
        SETUP,
    ]
}

const READ_BLOCK: &[Operand] = &transferred(Role::Write);
const WRITTEN_BLOCK: &[Operand] = &transferred(Role::Read);

const fn entry(mnemonic: &'static str, title: &'static str, forms: &'static [Form], doc: &'static str) -> Instruction {
    Instruction {
        mnemonic,
        title,
        names: Names::Unconfirmed,
        category: Category::Communication,
        forms,
        status: NOTHING,
        doc,
    }
}

const fn message(form: Form) -> Form {
    form.flags(&["EN", "DN", "ER"]).text(TextLevel::Unknown)
}

pub(super) const SET: &[Instruction] = &[
    entry(
        "MSG",
        "Read/Write Message",
        &[
            message(form(0x9C, Evidence::Inferred, Families::ML_FUNCTION_FILES, LOCAL).code(&[0, 2])),
            message(form(0xB6, Evidence::Inferred, Families::ML_FUNCTION_FILES, ROUTED).code(&[0, 2, 3, 4])),
            message(form(0xB3, Evidence::Samples, Families::ML_1100, SAMPLED).code(&[0])),
            message(manual(Families::SLC_5_02_UP, SLC_MESSAGE)),
            message(manual(Families::ML_1000, ML_1000_MESSAGE)),
        ],
        "Exchanges data with another device, in the background. EN comes on when the rung becomes true, DN when the \
         exchange is complete, ER with an error code when it failed. What is exchanged is set up behind the setup screen.",
    ),
    entry(
        "SVC",
        "Service Communications",
        &[
            form(0xA5, Evidence::Samples, Families::ML_FUNCTION_FILES, SERVICE),
            manual(Families::SLC_5_02, &[]),
            manual(Families::SLC_5_03_UP, CHANNELS).text(TextLevel::Unknown),
        ],
        "Interrupts the scan to service communication, then goes on.",
    ),
    entry(
        "BTR",
        "Block Transfer Read",
        &[message(manual(Families::SLC_5_03_UP, READ_BLOCK))],
        "Reads up to 64 words from a module in a remote chassis, in the background.",
    ),
    entry(
        "BTW",
        "Block Transfer Write",
        &[message(manual(Families::SLC_5_03_UP, WRITTEN_BLOCK))],
        "Writes up to 64 words to a module in a remote chassis, in the background.",
    ),
    entry(
        "CEM",
        "ControlNet Explicit Message",
        &[message(manual(Families::SLC_5_03_UP, EXPLICIT))],
        "Sends a CIP request over a ControlNet scanner module.",
    ),
    entry(
        "DEM",
        "DeviceNet Explicit Message",
        &[message(manual(Families::SLC_5_03_UP, EXPLICIT))],
        "Sends a CIP request over a DeviceNet scanner module.",
    ),
    entry(
        "EEM",
        "EtherNet/IP Explicit Message",
        &[message(manual(Families::SLC_5_05, EXPLICIT))],
        "Sends a CIP request over the processor's own Ethernet channel.",
    ),
];
