//! Data log, recipes, the display of the controller, program checksum.

use crate::Families;
use crate::model::*;
use crate::row::*;

const QUEUE: &[Operand] = &[op("Queue Number", Role::Parameter, Kind::QueueNumber)];
const RECIPE: &[Operand] = &[
    op("Recipe File", Role::Parameter, Kind::RecipeFile),
    op("Recipe Number", Role::Read, Kind::Word),
    op("File Operation", Role::Parameter, Kind::Choice),
];
const DISPLAYED: &[Operand] = &[
    op("L2 Source A", Role::Read, Kind::Word),
    op("L2 Source B", Role::Read, Kind::Word),
    op("L3 Source A", Role::Read, Kind::Word),
    op("L3 Source B", Role::Read, Kind::Word),
    op("L4 Source A", Role::Read, Kind::Word),
    op("L4 Source B", Role::Read, Kind::Word),
    op("Display With Input", Role::Parameter, Kind::Choice).valued(),
];
const CHECKSUM: &[Operand] = &[op("Proc/Mmod", Role::Parameter, Kind::Choice), op("Dest", Role::Write, Kind::Word)];

const LOGGING: Families = Families::ML_1100.and(Families::ML_1400).and(Families::ML_1500);

const fn entry(mnemonic: &'static str, title: &'static str, forms: &'static [Form], doc: &'static str) -> Instruction {
    Instruction { mnemonic, title, names: Names::Unconfirmed, category: Category::Storage, forms, status: NOTHING, doc }
}

pub(super) const SET: &[Instruction] = &[
    entry(
        "DLG",
        "Data Log",
        &[form(0xAC, Evidence::Samples, LOGGING, QUEUE)],
        "Each time the rung becomes true, adds a record of the configured addresses to a data log queue.",
    ),
    entry(
        "RCP",
        "Recipe",
        &[form(0xB0, Evidence::Samples, LOGGING, RECIPE)],
        "Loads the values of a recipe into the data table, or stores them from it.",
    ),
    entry(
        "LCD",
        "LCD Display",
        &[form(0xB2, Evidence::Samples, Families::ML_1100.and(Families::ML_1400), DISPLAYED)],
        "Shows strings or values on lines 2 to 4 of the controller's display, and can wait for input at its keys.",
    ),
    entry(
        "RPC",
        "Read Program Checksum",
        &[manual(Families::SLC_5_03_UP, CHECKSUM)],
        "Stores the checksum of the ladder program in the processor or in the memory module, to notice changed programs.",
    ),
];
