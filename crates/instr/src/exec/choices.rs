//! Readings of open questions, each switchable where two are possible.
//!
//! Documentation of these processors ends in places. Every [`Choice`] is such a place; its default
//! is the reading taken unless it is switched, [`LIST`] says why. Some concern the functions of this
//! module, the others a scan engine that calls them; they stand together because a user sees one list.

/// One answer per open question; [`Choices::default`] is what happens unless told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Choices(u64);

/// A question whose answer can be switched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Choice {
    /// Entering run sets the storage bits of OSR and ONS, so that the first scan gives no pulse.
    OneShotSetByPrescan,
    /// A done TON or RTO whose PRE is raised (or ACC lowered) while the rung stays true times on.
    DoneFollowsPreset,
    /// ACC may pass PRE when one scan brings several ticks.
    AccOvershoots,
    /// A timer not executed for long loses whole periods of 2.56 s.
    TimerGapWraps,
    /// Negative PRE or ACC of a timer faults with a false rung too.
    NegativeTimerAlways,
    /// RTO drops the part of a tick it has gathered when its rung goes false.
    RtoDropsPartTick,
    /// Counting back clears OV and UN on MicroLogix 1100 to 1500 too.
    CountBackClearsOnMx,
    /// Counting back over the wrap sets the opposite flag as well as clearing the first.
    CountBackSetsOpposite,
    /// A later good math result clears S:5/0 on MicroLogix 1100 to 1500.
    TrapFollowsOverflow,
    /// Exact halves of a float become the integer away from zero instead of the even one.
    FloatTiesAway,
    /// DIV by zero with a negative dividend stores -32768.
    DivideByZeroSigned,
    /// Exact halves of negative quotients round towards zero in DIV.
    DivHalfTowardsZero,
    /// Unloading an empty FIFO or LIFO writes 0 to the destination.
    EmptyUnloadClears,
    /// LFU clears the word it took out.
    LfuClears,
    /// COP between F or L files and word files moves the high word first.
    HighWordFirst,
    /// On MicroLogix 1100 to 1500 an indirect address beyond its own file faults even where other data
    /// files follow.
    IndirectStaysInFile,
    /// Integer sources with a float destination are computed as integers, then converted.
    FloatDestinationConverts,
    /// SCP rounds exact halves to the even integer.
    ScpTiesToEven,
    /// SCP with an input range of no width leaves its destination.
    ScpFlatKeeps,
    /// FRD takes digits above 9 at face value instead of leaving its destination.
    FrdTakesAnyDigit,
    /// CPT computes each step in the type of its own operands.
    CptStepwise,
    /// ACI stores the negative limit for a number below the range.
    AciSigned,
    /// Storing a string clears the characters after its end.
    StringClearsRest,
    /// AEX with fewer characters left than asked for is an error.
    ExtractNeedsAll,
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
    row(
        Choice::OneShotSetByPrescan,
        "one-shot-set-by-prescan",
        "entering run leaves storage bits as they are in the data table",
        "entering run sets them: no pulse in the first scan",
        "no page of these processors describes it; only a related family sets them",
    ),
    row(
        Choice::DoneFollowsPreset,
        "done-follows-preset",
        "DN stays until the rung goes false (TON) or RES (RTO), whatever happens to PRE and ACC",
        "DN is computed anew: raising PRE resumes timing",
        "the printed tables end DN with the rung or a reset only",
    ),
    row(
        Choice::AccOvershoots,
        "acc-overshoots",
        "ACC stops at PRE",
        "ACC keeps all ticks of the scan that passed PRE",
        "the MicroLogix 1100 manual stops timing at the preset; the others do not say",
    ),
    row(
        Choice::TimerGapWraps,
        "timer-gap-wraps",
        "a timer that was not executed gains the whole time at its next execution",
        "it gains the time modulo 2.56 s",
        "manuals only promise accuracy up to 2.5 s between executions",
    ),
    row(
        Choice::NegativeTimerAlways,
        "negative-timer-always",
        "negative PRE or ACC faults (0034) when TON or RTO is true, or TOF is true or timing",
        "it faults at every execution, false rungs included",
        "the error is described for timers that are executed; false rungs are not mentioned",
    ),
    row(
        Choice::RtoDropsPartTick,
        "rto-drops-part-tick",
        "RTO keeps the part of a tick over a false rung",
        "the part of a tick is lost when the rung goes false",
        "a kept accumulator suggests a kept remainder; accuracy is one tick either way",
    ),
    row(
        Choice::CountBackClearsOnMx,
        "count-back-clears-on-mx",
        "on MicroLogix 1100 to 1500 only RES clears OV and UN",
        "counting back over the wrap clears them as on SLC",
        "the MicroLogix 1100 table names RES alone",
    ),
    row(
        Choice::CountBackSetsOpposite,
        "count-back-sets-opposite",
        "counting back over the wrap only clears OV (or UN)",
        "it also sets UN (or OV)",
        "nothing is printed about the opposite flag",
    ),
    row(
        Choice::TrapFollowsOverflow,
        "trap-follows-overflow",
        "S:5/0 stays set until the program or a person clears it",
        "on MicroLogix 1100 to 1500 each math result rewrites it",
        "manuals ask for an OTU before END, and the MicroLogix 1400 one says the bit remains in its last state; \
         other pages of it say it is reset otherwise",
    ),
    row(
        Choice::FloatTiesAway,
        "float-ties-away",
        "a float halfway between integers becomes the even one",
        "it becomes the one away from zero",
        "the even one is printed for the MicroLogix 1100; nothing was found for SLC, and a MicroLogix 1400 saved \
         while running holds 3 where 3.0 - 0.5 was stored in an integer",
    ),
    row(
        Choice::DivideByZeroSigned,
        "divide-by-zero-signed",
        "DIV by zero stores 32767",
        "with a negative dividend it stores -32768",
        "the DIV page prints 32767 only; the page on S:2/14 speaks of the sign",
    ),
    row(
        Choice::DivHalfTowardsZero,
        "div-half-towards-zero",
        "negative halves round away from zero in DIV: -11 / 2 is -6",
        "they round towards zero: -5",
        "only positive examples are printed",
    ),
    row(
        Choice::EmptyUnloadClears,
        "empty-unload-clears",
        "FFU and LFU on an empty stack leave the destination",
        "they write 0",
        "not described",
    ),
    row(
        Choice::LfuClears,
        "lfu-clears",
        "LFU leaves the word it took out",
        "it clears that word",
        "only FFU is described as filling with 0",
    ),
    row(
        Choice::HighWordFirst,
        "high-word-first",
        "L and F elements hold their low word first",
        "COP, CPW and FLL see their high word first",
        "inferred from the order on the network",
    ),
    row(
        Choice::IndirectStaysInFile,
        "indirect-stays-in-file",
        "on MicroLogix 1100 to 1500 an indirect address past its file reaches the files behind it and is reported; \
         0029 only outside all data",
        "it is fault 0029 as soon as it leaves its file",
        "the text of 0029 speaks of the whole data space; reports from the field disagree",
    ),
    row(
        Choice::FloatDestinationConverts,
        "float-destination-converts",
        "a float destination makes the operation a float one: 10 / 4 into F8:0 is 2.5",
        "integer sources are computed as integers and the result is converted: 3.0",
        "any float operand is said to make the operation a float one, and the destination is an operand",
    ),
    row(
        Choice::ScpTiesToEven,
        "scp-ties-to-even",
        "exact halves of an integer SCP go away from zero, as in DIV",
        "they go to the even integer",
        "the float rules of the MicroLogix 1100 exempt SCP without saying what holds instead",
    ),
    row(
        Choice::ScpFlatKeeps,
        "scp-flat-keeps",
        "SCP with equal input limits stores the upper limit of the destination, as DIV by zero",
        "the destination keeps its value",
        "only the overflow flag is described",
    ),
    row(
        Choice::FrdTakesAnyDigit,
        "frd-takes-any-digit",
        "FRD with a digit above 9 leaves its destination and sets the overflow flag",
        "such digits count as 10 to 15 in their place",
        "only the overflow flag is described",
    ),
    row(
        Choice::CptStepwise,
        "cpt-stepwise",
        "CPT computes in floats as soon as one operand of the expression is a float, else in 32-bit integers",
        "each step is computed in the type of its own operands",
        "the precision between the steps is not described",
    ),
    row(
        Choice::AciSigned,
        "aci-signed",
        "ACI stores 32767 for every number outside the range",
        "it stores -32768 for one below the range",
        "the manual names 32767 alone",
    ),
    row(
        Choice::StringClearsRest,
        "string-clears-rest",
        "characters behind the end of a stored string stay as they were",
        "they become 0",
        "not described; they are no part of the string",
    ),
    row(
        Choice::ExtractNeedsAll,
        "extract-needs-all",
        "AEX takes the characters up to the end of the source when fewer are left than asked for",
        "it sets S:5/15 and leaves its destination, as for an index behind the end",
        "the page gives the end of the source as the limit; a summary of the errors reads as if it were one",
    ),
];

const fn row(
    choice: Choice,
    name: &'static str,
    default: &'static str,
    switched: &'static str,
    reason: &'static str,
) -> Row {
    Row { choice, name, default, switched, reason }
}

impl Choices {
    /// Every question with its default answer.
    pub const NONE: Choices = Choices(0);

    /// The same answers with this one switched.
    #[must_use]
    pub const fn with(self, choice: Choice) -> Choices {
        Choices(self.0 | 1 << choice as u8)
    }

    /// The answer is switched from its default.
    pub const fn has(self, choice: Choice) -> bool {
        self.0 & (1 << choice as u8) != 0
    }

    /// All answers that are switched.
    pub fn switched(self) -> impl Iterator<Item = &'static Row> {
        LIST.iter().filter(move |row| self.has(row.choice))
    }

    /// The choice with this name.
    pub fn by_name(name: &str) -> Option<Choice> {
        LIST.iter().find(|row| row.name == name).map(|row| row.choice)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_choice_has_a_row_and_a_bit() {
        let mut all = Choices::default();
        for (index, row) in LIST.iter().enumerate() {
            assert_eq!(row.choice as usize, index);
            assert!(!all.has(row.choice));
            all = all.with(row.choice);
            assert_eq!(Choices::by_name(row.name), Some(row.choice));
        }
        assert_eq!(all.switched().count(), LIST.len());
    }
}
