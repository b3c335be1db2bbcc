//! Mutants that are equivalent by an argument a person made: no run shows them, and the automatic one does not see why.

use analysis::proof::Scope;

use super::mutate::Mutant;

/// A mutant that does the same, and why.
#[derive(Debug)]
pub(crate) struct Argued {
    /// The programs that are alike in what it speaks of.
    programs: &'static [&'static str],
    /// The mutant as it is named, and which instruction of its rung is meant.
    what: &'static str,
    instruction: usize,
    /// Data the argument needs left alone between scans.
    steady: &'static [&'static str],
    why: &'static str,
}

impl Argued {
    /// Whether it is this one.
    pub(crate) fn is(&self, program: &str, mutant: &Mutant) -> bool {
        self.programs.contains(&program) && self.what == mutant.what && mutant.place.2 == Some(self.instruction)
    }
}

/// The argument about a mutant, if there is one.
pub(crate) fn argument(program: &str, mutant: &Mutant) -> Option<&'static Argued> {
    ARGUED.iter().find(|row| row.is(program, mutant))
}

/// Every argument must be about a mutant there is, and no input of the run may change what it takes as steady.
pub(crate) fn check(program: &str, mutants: &[Mutant], scope: &Scope) {
    for row in ARGUED.iter().filter(|row| row.programs.contains(&program)) {
        assert!(mutants.iter().any(|mutant| row.is(program, mutant)), "there is no such mutant: {row:?}");
        assert!(!row.why.is_empty(), "{row:?}");
        // The word itself or one of its bits.
        let is_steady = |address: &str| {
            let word = address.split(':').next().unwrap_or_default();
            row.steady.iter().any(|it| *it == word || *it == address)
        };
        let changed = scope.driven.iter().find(|driven| is_steady(&driven.address));
        assert!(changed.is_none(), "an input changes {changed:?}, which must be left alone: {row:?}");
    }
}

/// Arguments rest on the text of the converted program; read them beside it.
const ARGUED: [Argued; 19] = [
    Argued {
        programs: &["batch.SLC"],
        what: "$Main rung 4: MATH D5 \"IF(T0.Acc < D6, 0, T0.Acc - D6)\" -> MATH D5 \"IF(T0.Acc < D6, 1, T0.Acc - D6)\"",
        instruction: 1,
        steady: &["T0", "D1", "D2", "D5", "D6"],
        why: "The clock D1 gains a millisecond in a scan that enters run, before any timer. D1 is read by the timer alone, as D1 less D2 modulo 1,000,000,000; \
              entering run sets C16, so that the next execution takes D2 anew, counts no time and begins at 0 (C16 resets N2:15). Both are shifted alike from \
              there on: no difference changes.",
    },
    Argued {
        programs: &["batch.SLC"],
        what: "$Main rung 5: STRGE T0.Acc 1000000000 -> STRGE T0.Acc 999999999",
        instruction: 0,
        steady: &["T0", "D1", "D2", "D5", "D6"],
        why: "Only where T0.Acc is 999,999,999 exactly: T0.Acc and D6 go on from -1, the difference of which is the same, and both programs hold the same again as \
              soon as time passes. With run left and entered in between, T0.Acc is 0 and D5 1 instead of 0: the clock D1 gains a millisecond, \
              which nothing shows, as for rung 4.",
    },
    Argued {
        programs: &["batch.SLC"],
        what: "SLC3_FILL rung 2: AND C16 -> AND C17",
        instruction: 6,
        steady: &["C16", "C17", "N2", "D3", "N16"],
        why: "MOVE 0 D3 is left out where C16 is on and C17 off; but there the next lines reset N2:15, and D3 is read only with N2:15 on. C17 (slcFault) is set by the \
              last rung alone, by bits of S:5 that nothing resets: it is on only in a scan that enters run and halts at its end, where C16 is on as well at \
              the one execution of the timer.",
    },
    Argued {
        programs: &["lecky_demo_tof.RSS"],
        what: "SLC253_2FAILS512 rung 1: AND C114 -> AND C115",
        instruction: 7,
        steady: &["C114", "C115", "N7", "D9", "N378"],
        why: "MOVE 0 D9 is left out where C114 is on and C115 off; but there the next lines reset N7:15, D9 is read only with N7:15 on, and the next timer computes \
              it anew. C115 (slcFault) is set by the last rung alone, by bits of S:5 that nothing resets: it is on only in a scan that enters run and halts at \
              its end, where C114 is on as well at the one execution of the timer.",
    },
    Argued {
        programs: &["lecky_demo_tof.RSS"],
        what: "$Main rung 8: ANDN N34:13 -> ANDN N34:14",
        instruction: 2,
        steady: &["N34", "N16:0", "N16:5"],
        why: "AND N16:0 follows. N34:13 and N34:14 differ before the rung only if its last execution, one scan ago, had power (13 on, 14 off), so N16:0 was on then \
              and rung 7 had set N16:5. Now rung 7 either finds C99 on, and N16:5 keeps N16:0 off, or finds it off: N16:0 is off either way.",
    },
    Argued {
        programs: &["lecky_demo_tof.RSS"],
        what: "$Main rung 9: ANDN N37:13 -> ANDN N37:14",
        instruction: 2,
        steady: &["N37", "N16:0", "N16:5"],
        why: "As for rung 8: AND N16:0 follows, and N37:13 and N37:14 differ only one scan after N16:0 was on at this rung. Rung 7 lets it be on in no two scans in a \
              row, because N16:5 has to be reset by a scan with C99 off.",
    },
    Argued {
        programs: &["3_pump_sequencing.RSS"],
        what: "SLC225_ONOFFSQTY rung 2: OR ST1 -> ORN ST1",
        instruction: 50,
        steady: &["N24", "N25", "N26", "C32"],
        why: "C32 stays on while the rung is false instead of its first execution. That first one has reset N24:13 and moved N25 to N26; doing so again changes \
              nothing (N25 is 600, nothing writes it, and nothing counts with N24:13 off), D14 is not read with N24:13 off nor with power, and the next \
              timer computes it anew. The first execution with power resets C32 in both.",
    },
    Argued {
        programs: &["3_pump_sequencing.RSS"],
        what: "SLC225_ONOFFSQTY rung 3: OR ST1 -> OR ST2",
        instruction: 4,
        steady: &["N27", "D14", "D16"],
        why: "The time of T4:1 is taken (D16) only when it has power. Without power it is not read, and N27:15 goes off; D14 counts only with N27:15 on, \
              that is, when the execution before had power and took the time as well. The next timer computes D14 anew.",
    },
    Argued {
        programs: &["TRAFFIC_LIGHT_SEQUENCER.RSS", "TRAFFIC_LIGHT_SEQUENCER_BAK017.RSS"],
        what: "$Main rung 7: OR ST1 -> OR ST2",
        instruction: 50,
        steady: &["C512", "N108", "D3"],
        why: "C512 goes off at the first execution with power instead of the first one. With power it resets N108:15 and makes D3 0; if an execution without \
              power came before, that one has reset N108:15, and D3 is read only with N108:15 on. Without power C512 does nothing else.",
    },
    Argued {
        programs: &["TRAFFIC_LIGHT_SEQUENCER_BAK017.RSS"],
        what: "$Main rung 7: MOVE 0 D4 -> MOVE 1 D4",
        instruction: 48,
        steady: &["D4", "N108"],
        why: "D4 is left at 1 where the rung has no power, which also resets N108:15. The next execution with power finds N108:15 off and makes D4 0 before it \
              is read; it is read nowhere else.",
    },
    Argued {
        programs: &["TRAFFIC_LIGHT.RSS", "TRAFFIC_LIGHT_BAK017.RSS"],
        what: "$Main rung 4: MATH D12 \"IF(T0.Acc < D13, 0, T0.Acc - D13)\" -> MATH D12 \"IF(T0.Acc < D14, 0, T0.Acc - D13)\"",
        instruction: 1,
        steady: &["T0", "D0", "D12", "D13", "D14"],
        why: "Nothing writes D14: it is 0, and T0.Acc is never below. T0.Acc is below D13 only in a scan that enters run; there the clock D0 falls by D13 instead of standing still. \
              D0 is read by the timers alone, as D0 less what it was at their execution before, modulo 1,000,000,000; entering run sets C512 to C516, so that each \
              of them takes D0 anew at its next execution and counts no time there. From there on both are shifted alike: no difference changes.",
    },
    Argued {
        programs: &["TRAFFIC_LIGHT.RSS", "TRAFFIC_LIGHT_BAK017.RSS"],
        what: "$Main rung 5: STRGE T0.Acc 1000000000 -> STRGE T0.Acc 999999999",
        instruction: 0,
        steady: &["T0", "D0", "D12", "D13"],
        why: "Only where T0.Acc is 999,999,999 exactly: T0.Acc and D13 go on from -1, the difference of which is the same, and both programs hold the same again as soon as \
              time passes. With run left and entered in between, T0.Acc is 0 and D12 1 instead of 0: the clock D0 gains a millisecond, which nothing shows, as for \
              rung 4.",
    },
    Argued {
        programs: &["TRAFFIC_LIGHT.RSS"],
        what: "SLC3_FLASHER rung 1: MOVE 0 D2 -> MOVE 0 D3",
        instruction: 6,
        steady: &["C515", "N117", "D2", "D3", "C512", "N105"],
        why: "With C515 on N117:15 is reset next, and D2 is read only with N117:15 on; the next timer computes it anew. D3 belongs to T4:0, which is executed before in the \
              same scan, or not at all: C512 was set with C515, so that T4:0 begins with D3 at 0 at its next execution in either case, and without power D3 is 0 too.",
    },
    Argued {
        programs: &["TRAFFIC_LIGHT.RSS"],
        what: "SLC3_FLASHER rung 1: OR ST1 -> ORN ST1",
        instruction: 50,
        steady: &["C515", "N117", "D9", "N119"],
        why: "C515 stays on while the rung is false instead of going off at its first execution. That first one has reset N117:15 and made N119 and D9 0. With C515 still on, \
              the first execution with power makes D2 0, which is not read with N117:15 off, resets N117:15, which is off, and resets C515.",
    },
    Argued {
        programs: &["TRAFFIC_LIGHT_BAK017.RSS"],
        what: "SLC4_TIMER rung 1: MATH D3 \"IF(N107 < N106, D3 % 1000, 0)\" -> MATH D3 \"IF(N107 < N106, D3 % 1000, 1)\"",
        instruction: 23,
        steady: &["N105", "N106", "N107", "D3", "C512"],
        why: "D3 is left at 1 where N107 has reached N106; the same execution then sets N105:13. D3 is read only with N105:15 on and N105:13 off. N105:13 goes off with N105:15 \
              on in no execution; where N105:15 goes off, D3 is made 0 before it is read: without power at once, at the first execution after entering run by the line for \
              N105:15 off.",
    },
    Argued {
        programs: &["TRAFFIC_LIGHT_BAK017.RSS"],
        what: "SLC3_FLASHER rung 1: OR ST1 -> ORN ST1",
        instruction: 2,
        steady: &["C515", "N117", "D2", "D8", "D9"],
        why: "The time of T4:4 is taken (D2, D8) only when it has power. Without power N117:15 goes off, and D2 is read only with N117:15 on, that is, when the execution \
              before had power and took the time as well. The next timer computes D2 anew.",
    },
    Argued {
        programs: &["TRAFFIC_LIGHT_BAK017.RSS"],
        what: "SLC3_FLASHER rung 1: MATH D9 \"IF(N119 < N118, D9 % 10, 0)\" -> MATH D9 \"IF(N120 < N118, D9 % 10, 0)\"",
        instruction: 23,
        steady: &["N117", "N118", "N119", "N120", "D9"],
        why: "N120, the first word of T4:5, is 0 or has bit 15 on: it is below N118, which is 30, always. So D9 keeps its rest where N119 has reached N118; the same execution \
              then sets N117:13, and D9 is read only with N117:15 on and N117:13 off. N117:13 goes off with N117:15 alone, and D9 is made 0 before it is read again.",
    },
    Argued {
        programs: &["TRAFFIC_LIGHT_BAK017.RSS"],
        what: "SLC3_FLASHER rung 1: MOVE 0 D9 -> MOVE 1 D9",
        instruction: 48,
        steady: &["N117", "D9"],
        why: "D9 is left at 1 where the rung has no power, which also resets N117:15. The next execution with power finds N117:15 off and makes D9 0 before it is read; it is \
              read nowhere else.",
    },
    Argued {
        programs: &["TRAFFIC_LIGHT_BAK017.RSS"],
        what: "SLC3_FLASHER rung 1: OR ST1 -> OR ST2",
        instruction: 50,
        steady: &["C515", "N117", "D9", "N119"],
        why: "C515 goes off at the first execution with power instead of the first one. With power it resets N117:15 and makes D2 0; if an execution without power came \
              before, that one has reset N117:15, and D2 is read only with N117:15 on. Without power C515 does nothing that lasts: the next timer computes D2 anew.",
    },
];
