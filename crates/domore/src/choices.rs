//! Readings of Do-more where documentation ends, each switchable where two are possible.

/// One answer per open question; [`Choices::default`] is what happens unless told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Choices(u32);

/// A question whose answer can be switched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Choice {
    /// A leg, coil or contact that is ON when it is processed for the first time has an edge.
    FirstScanEdge,
    /// RSTT and RSTCT act when the box is processed next instead of at their place.
    ResetWhenProcessed,
    /// TMRA and TMRADOWN keep .Timing when EN goes OFF.
    TimingKept,
    /// A 32-bit result that overflows in MATH stops at the limit.
    MathSaturates,
    /// MATH computes reals in double instead of single precision.
    MathInDouble,
    /// A division by zero gives 0 instead of leaving the destination.
    DivideByZeroGivesZero,
    /// ROUND takes halves to the even number.
    RoundHalfEven,
    /// A number too large for an integer destination stops at the limit.
    StoreSaturates,
    /// A real stored in an integer is rounded.
    StoreRounds,
}

/// A row of [`LIST`].
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The switch.
    pub choice: Choice,
    /// Its name in options and reports.
    pub name: &'static str,
    /// What the engine does unless the switch is on.
    pub default: &'static str,
    /// What the switch makes it do.
    pub switched: &'static str,
    /// Why the default is the default.
    pub reason: &'static str,
}

/// Every switchable question.
pub const LIST: &[Row] = &[
    Row {
        choice: Choice::FirstScanEdge,
        name: "dm-first-scan-edge",
        default: "a leg or contact that is ON (or OFF) when it is first processed has no edge",
        switched: "what is ON when first processed has just gone ON",
        reason: "not described; a count at power-up that nobody pressed for is the worse error",
    },
    Row {
        choice: Choice::ResetWhenProcessed,
        name: "dm-reset-when-processed",
        default: "RSTT and RSTCT act at their place in the scan and hold the box for the rest of it",
        switched: "they act when the timer or counter is processed next",
        reason: "the reset is described, its moment is not",
    },
    Row {
        choice: Choice::TimingKept,
        name: "dm-timing-kept",
        default: "TMRA, TMRADOWN and TMRAG clear .Timing when EN goes OFF",
        switched: "they keep it with the other flags",
        reason: "flags are said to keep their values, and .Timing to be ON whenever enabled: the two disagree",
    },
    Row {
        choice: Choice::MathSaturates,
        name: "dm-math-saturates",
        default: "integers of MATH are 32 bits and wrap",
        switched: "they stop at the limits",
        reason: "not described",
    },
    Row {
        choice: Choice::MathInDouble,
        name: "dm-math-in-double",
        default: "reals of MATH are single precision at each step",
        switched: "double precision up to the destination",
        reason: "REAL is the only real type of the controller",
    },
    Row {
        choice: Choice::DivideByZeroGivesZero,
        name: "dm-divide-by-zero-gives-zero",
        default: "a MATH expression that divides by zero leaves its destination",
        switched: "the quotient is 0",
        reason: "not described",
    },
    Row {
        choice: Choice::RoundHalfEven,
        name: "dm-round-half-even",
        default: "ROUND takes halves away from zero",
        switched: "to the even number",
        reason: "not described; away from zero is what people expect",
    },
    Row {
        choice: Choice::StoreSaturates,
        name: "dm-store-saturates",
        default: "an integer too large for its destination keeps its low bits",
        switched: "it becomes the limit of the destination",
        reason: "not described; reals beyond the range become the limit in both readings",
    },
    Row {
        choice: Choice::StoreRounds,
        name: "dm-store-rounds",
        default: "a real stored in an integer loses its fraction",
        switched: "it is rounded, halves away from zero",
        reason: "reported from the field, not found in the documentation",
    },
];

/// Readings without a switch: what is not described and how it is taken.
pub const FIXED: &[(&str, &str)] = &[
    ("an up timer behind its preset", ".Acc goes on to 2147483647 and stays there"),
    ("a down timer behind 0", ".Acc stays 0"),
    ("counters at the limits of 32 bits", ".Acc stays at the limit"),
    ("both count legs of UDC or UDCG rise in one scan", "they cancel out"),
    ("a leg of a counter during a reset", "its edge memory follows it: no count when the reset ends"),
    ("the first enabled scan of a timer", "no time is charged; a TMRDOWN starts from its preset"),
    ("a timer that was not executed for some scans and stayed enabled", "it gains the time that has passed"),
    ("an RSTT behind a timer that stays enabled", "its time counts from the reset on, as behind its reset leg"),
    ("a negative preset", "an up timer is done at once, a down timer too"),
    (".EN of a timer", "its first leg; .DN is another name of .Done"),
    ("OFFDTMR with the input ON", ".Acc is the delay, .Reset is ON"),
    ("OFFDTMR reset by RSTT or termination", ".Acc 0, output OFF"),
    ("the order of programs and tasks", "tasks that are due, then programs as they stand in the text"),
    ("a program that is restarted", "one termination scan, then from its start"),
    ("SUSPEND", "the program pauses without termination; RUN goes on with it"),
    ("coils of a stage that stops", "OFF, as those of a program"),
    ("coils and timers of a subroutine that is not called", "they hold"),
    ("a differential contact", "compares with the state when it was executed last"),
    ("several OROUT of a bit", "the first of a scan writes it, the others only turn it ON"),
    ("what stands behind a box with several legs", "its top leg is the power flow"),
    ("the square waves ST3 to ST5", "OFF in the first half of their period"),
    (
        "X, WX and RX that no module has",
        "they have terminals as all others: what the program writes there lasts until the next scan reads them",
    ),
    ("the clock", "1 January 2000 when the machine is made, moved by simulated time; Sunday is day 0"),
    ("retention", "blocks with -1 in their fifth column lose their content at power loss, all others keep it"),
    ("IF in MATH", "only the side that is taken is computed"),
    ("an index or a count that leads out of its block", "nothing is written"),
    ("V against N in a comparison", "by value: 40000 is greater than -1"),
];

/// The page of readings in Markdown: what `docs/domore-choices.md` holds.
pub fn markdown() -> String {
    let mut page = String::from(
        "<!-- Written from the lists in `crates/domore/src/choices.rs` by a test beside it; run it with RUNGS_BLESS=1. \
         -->\n\n# Readings of Do-more where documentation ends\n\n\
         What the vendor's help and Designer's exports say is followed; each row below is a question they leave open.\n\n\
         ## With a switch\n\n`--choice NAME` takes the other reading.\n\n\
         | name | default | switched | reason |\n|---|---|---|---|\n",
    );
    for row in LIST {
        page.push_str(&format!("| `{}` | {} | {} | {} |\n", row.name, row.default, row.switched, row.reason));
    }
    page.push_str("\n## Without a switch\n\n| question | reading |\n|---|---|\n");
    for (question, reading) in FIXED {
        page.push_str(&format!("| {question} | {reading} |\n"));
    }
    page
}

impl Choices {
    /// Whether the switch is on.
    pub fn has(self, choice: Choice) -> bool {
        self.0 & (1 << choice as u8) != 0
    }

    /// The same with this switch on.
    #[must_use]
    pub fn with(self, choice: Choice) -> Choices {
        Choices(self.0 | 1 << choice as u8)
    }

    /// Switches by name; `None` for a name that is none.
    pub fn parse<'a>(names: impl IntoIterator<Item = &'a str>) -> Option<Choices> {
        names.into_iter().try_fold(Choices::default(), |choices, name| {
            LIST.iter().find(|row| row.name == name).map(|row| choices.with(row.choice))
        })
    }

    pub(crate) fn bits(self) -> u32 {
        self.0
    }
}
