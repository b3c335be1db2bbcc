//! Both machines at one moment: entering run, what comes before a scan, and the comparison after it.

use super::inputs::Inputs;
use super::pairs::{Mismatch, Pairs};
use super::side::{Side, Slc};
use super::tape::{Head, Set};

/// How the two sides differ.
#[derive(Clone, Debug, PartialEq)]
pub enum Difference {
    /// A value.
    Value(Mismatch),
    /// The original stopped and the other did not: why, and the code of its major fault if it has one.
    OriginalStopped(String, Option<u16>),
    /// The other stopped and the original did not.
    OtherStopped(String),
}

/// Both machines at one moment.
#[derive(Debug)]
pub(crate) struct Both<B> {
    pub(crate) a: Slc,
    pub(crate) b: B,
}

impl<B: Side> Both<B> {
    pub(crate) fn fork(&self) -> Both<B> {
        Both { a: self.a.fork(), b: self.b.fork() }
    }

    pub(crate) fn copy_from(&mut self, other: &Both<B>) {
        self.a.copy_from(&other.a);
        self.b.copy_from(&other.b);
    }
}

/// Goes to run for the first time.
pub(crate) fn enter<B: Side>(both: &mut Both<B>) {
    both.a.enter_run();
    both.b.enter_run();
}

/// Does to both sides what comes before a scan.
pub(crate) fn apply<B: Side>(both: &mut Both<B>, inputs: &Inputs<B::Target>, head: Head, sets: &[Set]) {
    if head.program_run {
        both.a.leave_run();
        both.b.leave_run();
        write(both, inputs, sets);
        both.a.enter_run();
        both.b.enter_run();
    }
    write(both, inputs, sets);
}

fn write<B: Side>(both: &mut Both<B>, inputs: &Inputs<B::Target>, sets: &[Set]) {
    for (index, value) in sets {
        if let Some(input) = inputs.all.get(usize::from(*index)) {
            both.a.write(&input.a, *value);
            both.b.write(&input.b, *value);
        }
    }
}

/// Major fault of a minor error at the end of a scan.
pub(super) const MINOR_ERROR: u16 = 0x0020;

/// Compares both sides after a scan.
pub(crate) fn compare<B: Side>(a: &Slc, b: &B, pairs: &Pairs, buffers: &mut [Vec<u8>; 2]) -> Option<Difference> {
    match (a.stopped(), b.stopped()) {
        (None, None) => pairs.difference(a, b, buffers).map(Difference::Value),
        // Stopped alike: outputs are off on both; data is what the fault left.
        (Some(_), Some(_)) => {
            let on = pairs.output_on(b);
            // Behind a minor error all rungs of the scan were executed: the data is that of any other scan.
            let whole = a.machine.fault().is_some_and(|fault| fault.code == MINOR_ERROR);
            on.or_else(|| if whole { pairs.left(a, b) } else { None }).map(Difference::Value)
        }
        // The inputs left the conditions under which the programs are the same: nothing follows from it.
        (Some(_), None) if a.machine.fault().is_some_and(|fault| pairs.is_stated(fault)) => None,
        (Some(_), None) | (None, Some(_)) if pairs.stops_unknown => None,
        (Some(why), None) => Some(Difference::OriginalStopped(why, a.machine.fault().map(|fault| fault.code))),
        (None, Some(why)) => Some(Difference::OtherStopped(why)),
    }
}
