//! The table of instructions.

use super::Evidence::{Export, Generator, Help, Imported, Inferred};
use super::Role::{Own, Parameter, Read, ReadWrite, Refer, Reset, Write};
use super::{Effect, Entry, Evidence, Extent, Flow, Join, Kind, Operand, Relation, Role, Table, Test};

const fn op(name: &'static str, role: Role, kind: Kind) -> Operand {
    Operand { name, role, kind, extent: Extent::One }
}

const fn reach(name: &'static str, role: Role, kind: Kind, extent: Extent) -> Operand {
    Operand { name, role, kind, extent }
}

const fn entry(
    mnemonic: &'static str,
    title: &'static str,
    effect: Effect,
    operands: &'static [Operand],
    evidence: Evidence,
    doc: &'static str,
) -> Entry {
    Entry { mnemonic, title, effect, operands, required: operands.len(), evidence, doc }
}

/// An entry whose last operands may be missing, or whose operands are not known to be complete.
const fn at_least(required: usize, entry: Entry) -> Entry {
    Entry { required, ..entry }
}

const BIT: &[Operand] = &[op("Bit", Read, Kind::Bit)];
const VALUE: &[Operand] = &[op("Element", Read, Kind::Value)];
const PAIR: &[Operand] = &[op("A", Read, Kind::Value), op("B", Read, Kind::Value)];
const COIL: &[Operand] = &[op("Bit", Write, Kind::Bit)];
const TIMER: &[Operand] = &[op("Timer", Own, Kind::Timer), op("Preset", Read, Kind::Number)];
const TIMER_OUTPUT: &[Operand] =
    &[op("Timer", Own, Kind::Timer), op("Delay", Read, Kind::Number), op("Output", Write, Kind::Bit)];
const COUNTER: &[Operand] = &[op("Counter", Own, Kind::Counter), op("Preset", Read, Kind::Number)];
const UP_DOWN: &[Operand] =
    &[op("Counter", Own, Kind::Counter), op("Up preset", Read, Kind::Number), op("Down preset", Read, Kind::Number)];
const CODE: &[Operand] = &[op("Code block", Refer, Kind::CodeBlock)];
const STAGE: &[Operand] = &[op("Stage", Refer, Kind::Stage)];
const STAGES: &[Operand] = &[op("First", Refer, Kind::Stage), op("Last", Refer, Kind::Stage)];
const PULSES: &[Operand] =
    &[op("On time", Read, Kind::Number), op("Off time", Read, Kind::Number), op("Output", Write, Kind::Bit)];
const ENABLE_RESET: Effect = Effect::Box { legs: &["EN", "RST"] };

const fn contact(mnemonic: &'static str, join: Join, kind: (Test, &'static str, &'static str, Evidence)) -> Entry {
    let (test, title, doc, evidence) = kind;
    let operands = match test {
        Test::Compare(_) => PAIR,
        Test::Change => VALUE,
        _ => BIT,
    };
    entry(mnemonic, title, Effect::Contact { join, test }, operands, evidence, doc)
}

const ON: (Test, &str, &str, Evidence) = (Test::On, "Normally open", "Passes power while the bit is ON.", Export);
const OFF: (Test, &str, &str, Evidence) = (Test::Off, "Normally closed", "Passes power while the bit is OFF.", Export);
const RISE: (Test, &str, &str, Evidence) =
    (Test::Rise, "Leading edge", "Passes power in the scan in which the bit went from OFF to ON.", Export);
const FALL: (Test, &str, &str, Evidence) =
    (Test::Fall, "Trailing edge", "Passes power in the scan in which the bit went from ON to OFF.", Export);
const CHANGE: (Test, &str, &str, Evidence) =
    (Test::Change, "Delta", "Passes power when the element differs from what it was in the previous scan.", Export);
const CHANGE_SIBLING: (Test, &str, &str, Evidence) = (Test::Change, CHANGE.1, CHANGE.2, Inferred);
const EQUAL: (Test, &str, &str, Evidence) =
    (Test::Compare(Relation::Equal), "Equal", "Passes power while A = B.", Export);
const NOT_EQUAL: (Test, &str, &str, Evidence) =
    (Test::Compare(Relation::NotEqual), "Not equal", "Passes power while A and B differ.", Export);
const GREATER: (Test, &str, &str, Evidence) =
    (Test::Compare(Relation::Greater), "Greater than", "Passes power while A > B.", Export);
const GREATER_OR_EQUAL: (Test, &str, &str, Evidence) =
    (Test::Compare(Relation::GreaterOrEqual), "Greater than or equal", "Passes power while A >= B.", Export);
const LESS: (Test, &str, &str, Evidence) =
    (Test::Compare(Relation::Less), "Less than", "Passes power while A < B.", Export);
const LESS_OR_EQUAL: (Test, &str, &str, Evidence) =
    (Test::Compare(Relation::LessOrEqual), "Less than or equal", "Passes power while A <= B.", Export);

/// All known instructions, by family.
pub const TABLE: &[Entry] = &[
    // Contacts.
    contact("STR", Join::Push, ON),
    contact("AND", Join::And, ON),
    contact("OR", Join::Or, ON),
    contact("STRN", Join::Push, OFF),
    contact("ANDN", Join::And, OFF),
    contact("ORN", Join::Or, OFF),
    contact("STRPD", Join::Push, RISE),
    contact("ANDPD", Join::And, RISE),
    contact("ORPD", Join::Or, RISE),
    contact("STRND", Join::Push, FALL),
    contact("ANDND", Join::And, FALL),
    contact("ORND", Join::Or, FALL),
    contact("STRDLT", Join::Push, CHANGE),
    contact("ANDDLT", Join::And, CHANGE_SIBLING),
    contact("ORDLT", Join::Or, CHANGE_SIBLING),
    contact("STRE", Join::Push, EQUAL),
    contact("ANDE", Join::And, EQUAL),
    contact("ORE", Join::Or, EQUAL),
    contact("STRNE", Join::Push, NOT_EQUAL),
    contact("ANDNE", Join::And, NOT_EQUAL),
    contact("ORNE", Join::Or, NOT_EQUAL),
    contact("STRGT", Join::Push, GREATER),
    contact("ANDGT", Join::And, GREATER),
    contact("ORGT", Join::Or, GREATER),
    contact("STRGE", Join::Push, GREATER_OR_EQUAL),
    contact("ANDGE", Join::And, GREATER_OR_EQUAL),
    contact("ORGE", Join::Or, GREATER_OR_EQUAL),
    contact("STRLT", Join::Push, LESS),
    contact("ANDLT", Join::And, LESS),
    contact("ORLT", Join::Or, LESS),
    contact("STRLE", Join::Push, LESS_OR_EQUAL),
    contact("ANDLE", Join::And, LESS_OR_EQUAL),
    contact("ORLE", Join::Or, LESS_OR_EQUAL),
    // The stack of booleans.
    entry("ANDSTR", "And store", Effect::Series, &[], Export, "Joins the two top values of the stack in series."),
    entry("ORSTR", "Or store", Effect::Parallel, &[], Export, "Joins the two top values of the stack in parallel."),
    entry("NOT", "Invert", Effect::Flow(Flow::Invert), &[], Export, "Inverts the power flow at this point."),
    entry(
        "ANDPDPF",
        "Leading edge of power flow",
        Effect::Flow(Flow::Rise),
        &[],
        Help,
        "Passes power for one scan when the power flow rises.",
    ),
    entry(
        "ANDNDPF",
        "Trailing edge of power flow",
        Effect::Flow(Flow::Fall),
        &[],
        Help,
        "Passes power for one scan when the power flow falls.",
    ),
    entry("DUPBOOL", "Duplicate", Effect::Duplicate, &[], Export, "Pushes a copy of the power flow."),
    entry("POPBOOL", "Pop", Effect::Drop, &[], Export, "Drops the top value, back to what was duplicated."),
    // Coils.
    entry("OUT", "Out", Effect::Output, COIL, Export, "Writes the power flow to the bit."),
    entry("OROUT", "Or out", Effect::Output, COIL, Inferred, "Turns the bit ON if any OROUT of it has power."),
    entry("OUTI", "Out immediate", Effect::Output, COIL, Inferred, "OUT that writes the output point at once."),
    entry("SET", "Set", Effect::Output, COIL, Export, "Turns the bit ON while there is power; it stays ON."),
    entry("SETI", "Set immediate", Effect::Output, COIL, Inferred, "SET that writes the output point at once."),
    entry(
        "RST",
        "Reset",
        Effect::Output,
        &[op("Bit", Reset, Kind::Bit)],
        Export,
        "Turns the bit OFF while there is power; it stays OFF.",
    ),
    entry(
        "RSTI",
        "Reset immediate",
        Effect::Output,
        &[op("Bit", Reset, Kind::Bit)],
        Inferred,
        "RST that writes the output point at once.",
    ),
    entry(
        "RSTR",
        "Reset range",
        Effect::Output,
        &[reach("First", Reset, Kind::Bit, Extent::To(1)), op("Last", Parameter, Kind::Bit)],
        Imported,
        "Turns all bits of one block from the first to the last OFF.",
    ),
    entry(
        "PD",
        "Leading edge coil",
        Effect::Output,
        COIL,
        Export,
        "Turns the bit ON for one scan when the power flow rises.",
    ),
    entry(
        "ND",
        "Trailing edge coil",
        Effect::Output,
        COIL,
        Export,
        "Turns the bit ON for one scan when the power flow falls.",
    ),
    // Timers.
    entry("TMR", "Timer", Effect::Output, TIMER, Export, "Counts milliseconds up while enabled; disabling resets."),
    entry(
        "TMRDOWN",
        "Down timer",
        Effect::Output,
        TIMER,
        Export,
        "Counts milliseconds down from the preset while enabled; disabling resets.",
    ),
    entry(
        "TMRA",
        "Accumulating timer",
        ENABLE_RESET,
        TIMER,
        Inferred,
        "Counts milliseconds up while enabled and keeps them; the second leg resets.",
    ),
    entry(
        "TMRADOWN",
        "Accumulating down timer",
        ENABLE_RESET,
        TIMER,
        Inferred,
        "Counts milliseconds down while enabled and keeps them; the second leg resets to the preset.",
    ),
    entry(
        "TMRAG",
        "Accumulating global timer",
        Effect::Output,
        TIMER,
        Inferred,
        "Counts milliseconds up while enabled and keeps them, also when its code block stops; reset by RSTT.",
    ),
    entry(
        "ONDTMR",
        "On delay timer",
        Effect::Output,
        TIMER_OUTPUT,
        Export,
        "Turns the output ON after the delay; OFF at once.",
    ),
    entry(
        "OFFDTMR",
        "Off delay timer",
        Effect::Output,
        TIMER_OUTPUT,
        Export,
        "Turns the output ON at once; OFF after the delay.",
    ),
    entry(
        "RSTT",
        "Reset timer",
        Effect::Output,
        &[op("Timer", Reset, Kind::Timer)],
        Inferred,
        "Resets a timer structure.",
    ),
    // Counters.
    entry(
        "CNT",
        "Up counter",
        Effect::Box { legs: &["UP", "RST"] },
        COUNTER,
        Export,
        "Counts up at each rise of the first leg; the second leg resets.",
    ),
    entry(
        "CNTDN",
        "Down counter",
        Effect::Box { legs: &["DN", "RST"] },
        COUNTER,
        Export,
        "Counts down from the preset at each rise of the first leg; the second leg resets.",
    ),
    entry(
        "UDC",
        "Up/down counter",
        Effect::Box { legs: &["UP", "DN", "RST"] },
        UP_DOWN,
        Export,
        "Counts up and down at each rise of its legs; the third leg resets.",
    ),
    entry(
        "UDCG",
        "Global up/down counter",
        Effect::Box { legs: &["UP", "DN"] },
        UP_DOWN,
        Inferred,
        "Counts up and down and keeps the count when its code block stops; reset by RSTCT.",
    ),
    entry(
        "RSTCT",
        "Reset counter",
        Effect::Output,
        &[op("Counter", Reset, Kind::Counter)],
        Inferred,
        "Resets a counter structure.",
    ),
    // Data.
    entry(
        "MOVE",
        "Move",
        Effect::Output,
        &[op("Source", Read, Kind::Value), op("Destination", Write, Kind::Value)],
        Export,
        "Copies one value, converted to the type of the destination.",
    ),
    entry(
        "MATH",
        "Math",
        Effect::Output,
        &[op("Destination", Write, Kind::Value), op("Expression", Read, Kind::Expression)],
        Export,
        "Computes an expression.",
    ),
    entry("INC", "Increment", Effect::Output, &[op("Element", ReadWrite, Kind::Number)], Export, "Adds 1."),
    entry("DEC", "Decrement", Effect::Output, &[op("Element", ReadWrite, Kind::Number)], Inferred, "Subtracts 1."),
    entry(
        "COPY",
        "Copy data",
        Effect::Output,
        &[op("Flags", Parameter, Kind::Flags), op("Copies", ReadWrite, Kind::Table(Table::FlaggedCopies))],
        Export,
        "Copies elements or ranges, converted by type.",
    ),
    entry(
        "INIT",
        "Initialize data",
        Effect::Output,
        &[op("Values", ReadWrite, Kind::Table(Table::Fills))],
        Export,
        "Writes a value to ranges of elements.",
    ),
    entry(
        "MEMCOPY",
        "Copy memory",
        Effect::Output,
        &[
            reach("Source", Read, Kind::Value, Extent::Count(3)),
            reach("Destination", Write, Kind::Value, Extent::Count(3)),
            op("Mode", Parameter, Kind::Flags),
            op("Count", Read, Kind::Number),
        ],
        Export,
        "Copies memory as it is, as if through a buffer.",
    ),
    entry(
        "MEMCLEAR",
        "Clear memory",
        Effect::Output,
        &[reach("First", Write, Kind::Value, Extent::Count(1)), op("Count", Read, Kind::Number)],
        Generator,
        "Writes zero to a range of elements.",
    ),
    entry(
        "SCALE",
        "Scale",
        Effect::Output,
        &[
            op("Input", Read, Kind::Number),
            op("Input minimum", Read, Kind::Number),
            op("Input maximum", Read, Kind::Number),
            op("Output minimum", Read, Kind::Number),
            op("Output maximum", Read, Kind::Number),
            op("Output", Write, Kind::Number),
        ],
        Export,
        "Maps one range on another, linear and not limited.",
    ),
    entry(
        "CLAMP",
        "Limit",
        Effect::Output,
        &[
            op("Input", Read, Kind::Number),
            op("Limit", Read, Kind::Number),
            op("Limit", Read, Kind::Number),
            op("Output", Write, Kind::Number),
        ],
        Export,
        "Keeps a value between two limits.",
    ),
    entry(
        "FILTER",
        "Filter",
        Effect::Output,
        &[op("Factor", Read, Kind::Number), op("Input", Read, Kind::Number), op("Output", ReadWrite, Kind::Number)],
        Export,
        "Smooths a value.",
    ),
    entry("FLASHER", "Flasher", Effect::Output, PULSES, Export, "Turns the output ON and OFF in turn while enabled."),
    entry(
        "DEBOUNCE",
        "Debounce",
        Effect::Output,
        PULSES,
        Export,
        "Follows the power flow once it has been stable for the given times.",
    ),
    entry(
        "TIMEDOUT",
        "Timed output",
        Effect::Output,
        &[op("Time", Read, Kind::Number), op("Output", Write, Kind::Bit), op("Flags", Parameter, Kind::Flags)],
        Export,
        "Turns the output ON for a time.",
    ),
    entry(
        "RAMPSOAK",
        "Ramp/soak",
        Effect::Box { legs: &["EN", "leg 2", "leg 3"] },
        &[
            op("Structure", Own, Kind::Structure),
            op("Operand 2", ReadWrite, Kind::Value),
            op("Operand 3", ReadWrite, Kind::Value),
            op("Operand 4", ReadWrite, Kind::Value),
        ],
        Export,
        "Generates a profile of set points.",
    ),
    // Strings.
    entry(
        "STRCLEAR",
        "Clear string",
        Effect::Output,
        &[reach("String", Write, Kind::Text, Extent::Count(1)), op("Count", Read, Kind::Number)],
        Export,
        "Empties strings.",
    ),
    at_least(
        1,
        entry(
            "STRPRINT",
            "Print to string",
            Effect::Output,
            &[
                op("String", Write, Kind::Text),
                op("Flags", Parameter, Kind::Flags),
                op("Text", Read, Kind::Table(Table::Unknown)),
                op("Operand 4", Read, Kind::Value),
            ],
            Export,
            "Writes text and values to a string.",
        ),
    ),
    // Program flow.
    at_least(
        1,
        entry(
            "CALL",
            "Call subroutine",
            Effect::Output,
            &[
                op("Subroutine", Refer, Kind::CodeBlock),
                op("Flags", Parameter, Kind::Flags),
                op("Operand 3", Parameter, Kind::Value),
                op("Inputs", ReadWrite, Kind::Table(Table::Copies)),
                op("Outputs", ReadWrite, Kind::Table(Table::Copies)),
            ],
            Export,
            "Copies the inputs, executes a subroutine, copies the outputs.",
        ),
    ),
    entry("RET", "Return", Effect::Alone, &[], Export, "Ends a subroutine."),
    entry("RETC", "Return conditionally", Effect::Output, &[], Generator, "Ends a subroutine while there is power."),
    entry("RUN", "Run program", Effect::Output, CODE, Export, "Enables a program, which then runs every scan."),
    entry("HALT", "Halt program", Effect::Output, CODE, Inferred, "Stops a program, with a termination scan."),
    entry("RESTART", "Restart program", Effect::Output, CODE, Inferred, "Stops a program and enables it anew."),
    entry("SUSPEND", "Suspend program", Effect::Output, CODE, Export, "Pauses a program."),
    entry("EXIT", "Exit program", Effect::Output, &[], Inferred, "Stops the program it stands in."),
    at_least(
        1,
        entry(
            "ENTASK",
            "Enable task",
            Effect::Output,
            &[
                op("Task", Refer, Kind::CodeBlock),
                op("Parameter", Parameter, Kind::Value),
                op("Parameter", Parameter, Kind::Value),
            ],
            Inferred,
            "Enables a task.",
        ),
    ),
    at_least(
        1,
        entry(
            "INTCONFIG",
            "Configure interrupt",
            Effect::Output,
            &[
                op("Flags", Parameter, Kind::Flags),
                op("Routine", Refer, Kind::CodeBlock),
                op("Values", ReadWrite, Kind::Table(Table::Copies)),
                op("Flags", Parameter, Kind::Flags),
            ],
            Export,
            "Sets up an interrupt.",
        ),
    ),
    at_least(
        3,
        entry(
            "FOR",
            "For",
            Effect::Alone,
            &[
                op("Variable", ReadWrite, Kind::Number),
                op("From", Read, Kind::Number),
                op("To", Read, Kind::Number),
                op("Step", Read, Kind::Number),
            ],
            Export,
            "Repeats the rungs up to NEXT with a running variable.",
        ),
    ),
    entry("NEXT", "Next", Effect::Alone, &[], Export, "Ends a FOR loop."),
    entry("REPEAT", "Repeat", Effect::Alone, &[], Export, "Begins a loop that UNTIL ends."),
    entry("UNTIL", "Until", Effect::Alone, BIT, Export, "Repeats from REPEAT until the bit is ON."),
    entry("NOP", "No operation", Effect::Alone, &[], Export, "Does nothing; carries a comment."),
    entry("END", "End", Effect::Alone, &[], Inferred, "Ends a program."),
    // Stages.
    entry("SG", "Stage", Effect::Alone, STAGE, Export, "Begins a stage: the rungs behind it run while it is enabled."),
    entry(
        "JMP",
        "Jump to stage",
        Effect::Output,
        STAGE,
        Export,
        "Disables the stage it stands in and enables another.",
    ),
    entry(
        "SGSET",
        "Set stage",
        Effect::Output,
        STAGE,
        Inferred,
        "Enables a stage; the one it stands in stays enabled.",
    ),
    entry("SGRST", "Reset stage", Effect::Output, STAGE, Inferred, "Disables a stage."),
    entry("SGRSTR", "Reset range of stages", Effect::Output, STAGES, Inferred, "Disables stages."),
    at_least(
        1,
        entry(
            "SGDIVRG",
            "Jump to several stages",
            Effect::Output,
            &[
                op("Stage", Refer, Kind::Stage),
                op("Stage", Refer, Kind::Stage),
                op("Stage", Refer, Kind::Stage),
                op("Stage", Refer, Kind::Stage),
            ],
            Inferred,
            "Disables the stage it stands in and enables others.",
        ),
    ),
];

/// Indices of [`TABLE`] in the order of the mnemonics.
pub(super) static SORTED: [usize; TABLE.len()] = sorted();

const fn sorted() -> [usize; TABLE.len()] {
    let mut order = [0; TABLE.len()];
    let mut count = 0;
    while count < TABLE.len() {
        let mut at = count;
        while at > 0 && less(TABLE[count].mnemonic, TABLE[order[at - 1]].mnemonic) {
            order[at] = order[at - 1];
            at -= 1;
        }
        order[at] = count;
        count += 1;
    }
    order
}

const fn less(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut at = 0;
    while at < a.len() && at < b.len() {
        if a[at] != b[at] {
            return a[at] < b[at];
        }
        at += 1;
    }
    a.len() < b.len()
}
