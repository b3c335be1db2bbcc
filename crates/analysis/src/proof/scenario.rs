//! A counterexample as scenarios that anybody can run again: one for each side.

use std::fmt::Write;
use std::time::Duration;

use sim::scenario::spell::{duration, quoted};

use super::inputs::Inputs;
use super::pairs::literal;
use super::play::Difference;
use super::side::Kind;
use super::tape::Tape;

/// A difference as two scenario files. Run with `rungs test`, the one of the original passes and the other
/// one fails.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counterexample {
    /// What differs, in words.
    pub what: String,
    /// Scans of it.
    pub scans: usize,
    /// Changes of inputs in it.
    pub changes: usize,
    /// Scenario for the original.
    pub original: String,
    /// Scenario for the other program.
    pub other: String,
}

/// How a program is named in a scenario.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Named {
    /// Path, relative to the folder the scenario is written to.
    pub program: String,
    /// `family` of the scenario, where it needs one.
    pub family: Option<String>,
}

/// A value written before run is entered, on both sides.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Preset {
    pub(crate) original: String,
    pub(crate) other: String,
    pub(crate) kind: Kind,
    pub(crate) value: u32,
}

/// One step: what is set, then scans of one length.
#[derive(Clone, Debug, Default, PartialEq)]
struct Step {
    program_run: bool,
    /// Microseconds; 0: does not matter, the scan is the first of run.
    dt: u32,
    scans: usize,
    /// Input and value.
    sets: Vec<(u16, u32)>,
}

fn steps(tape: &Tape) -> Vec<Step> {
    let mut steps: Vec<Step> = Vec::new();
    for (head, sets) in tape.iter() {
        match steps.last_mut() {
            Some(last) if sets.is_empty() && !head.program_run && (last.dt == head.dt || last.dt == 0) => {
                last.scans += 1;
                last.dt = head.dt;
            }
            _ => steps.push(Step { program_run: head.program_run, dt: head.dt, scans: 1, sets: sets.to_vec() }),
        }
    }
    steps
}

/// In words.
pub(crate) fn describe(difference: &Difference) -> String {
    match difference {
        Difference::Value(it) => format!(
            "{} is {} in the original, {} is {} in the other program",
            it.original, it.expected, it.other, it.found
        ),
        Difference::OriginalStopped(why, _) => format!("the original stops ({why}), the other program goes on"),
        Difference::OtherStopped(why) => format!("the other program stops ({why}), the original goes on"),
    }
}

/// Writes both scenarios.
pub(crate) fn write<T>(
    tape: &Tape,
    difference: &Difference,
    inputs: &Inputs<T>,
    presets: &[Preset],
    (a, b): (&Named, &Named),
    seed: u64,
) -> Counterexample {
    let what = describe(difference);
    let [original, other] = [true, false].map(|own| {
        let named = if own { a } else { b };
        let mut text = String::new();
        let side = if own { "the original, which behaves so" } else { "the other program, which behaves otherwise" };
        let _ = writeln!(text, "# Found by rungs prove with seed {seed}. This is {side}.");
        let _ = writeln!(text, "name = {}", quoted(&what));
        let _ = writeln!(text, "program = {}", quoted(&named.program));
        if let Some(family) = &named.family {
            let _ = writeln!(text, "family = {}", quoted(family));
        }
        let steps = steps(tape);
        let usual = steps.iter().map(|step| step.dt).find(|dt| *dt > 0).unwrap_or(10_000);
        let _ = writeln!(text, "scan = {}", duration(Duration::from_micros(usual.into())));
        let last = steps.len().saturating_sub(1);
        for (index, step) in steps.iter().enumerate() {
            let _ = writeln!(text, "\n[[step]]");
            if step.program_run {
                let _ = writeln!(text, "mode = \"program-run\"");
            }
            let mut set = Vec::new();
            if index == 0 {
                set.extend(presets.iter().map(|preset| {
                    let address = if own { &preset.original } else { &preset.other };
                    format!("{} = {}", quoted(address), literal(preset.kind, preset.value))
                }));
            }
            set.extend(step.sets.iter().filter_map(|(number, value)| {
                let input = inputs.all.get(usize::from(*number))?;
                let address = if own { &input.original } else { &input.other };
                Some(format!("{} = {}", quoted(address), literal(input.kind, *value)))
            }));
            // A key can stand once only: the last value is the one that counts.
            let mut unique: Vec<String> = Vec::new();
            for one in set {
                let key = |text: &str| text.split(" = ").next().unwrap_or("").to_owned();
                unique.retain(|other| key(other) != key(&one));
                unique.push(one);
            }
            if !unique.is_empty() {
                let _ = writeln!(text, "set = {{ {} }}", unique.join(", "));
            }
            if step.dt > 0 && step.dt != usual {
                let _ = writeln!(text, "scan = {}", duration(Duration::from_micros(step.dt.into())));
            }
            let _ = writeln!(text, "scans = {}", step.scans);
            if index == last {
                expectation(&mut text, difference, own);
            }
        }
        text
    });
    Counterexample { what, scans: tape.len(), changes: tape.changes(), original, other }
}

fn expectation(text: &mut String, difference: &Difference, own: bool) {
    match difference {
        Difference::Value(it) => {
            let address = if own { &it.original } else { &it.other };
            let _ = writeln!(text, "expect = {{ {} = {} }}", quoted(address), it.expected);
        }
        Difference::OriginalStopped(_, Some(code)) => {
            let _ = writeln!(text, "fault = \"{code:04X}\"");
        }
        Difference::OriginalStopped(_, None) => {}
        Difference::OtherStopped(why) => {
            // A major fault fails by itself; the bit of a converted program is looked at.
            let bit = why.strip_suffix(" is on");
            if let (false, Some(bit)) = (own, bit) {
                let _ = writeln!(text, "expect = {{ {} = 0 }}", quoted(bit));
            }
        }
    }
}
