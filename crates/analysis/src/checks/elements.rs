//! What checks ask in the same way of timers and of counters.

use ladder::FileType;

use super::context::Context;
use super::{Found, rungs};
use crate::timers::{TimerFinding, TimerFindingKind as Kind};

/// Timers or counters, and what their instructions do.
pub(super) struct Elements {
    file_type: FileType,
    /// What an instruction does: it times, it counts.
    runs: &'static str,
    /// What is done to an element: it is timed, counted.
    run: &'static str,
}

pub(super) const TIMERS: Elements = Elements { file_type: FileType::T, runs: "times", run: "timed" };
pub(super) const COUNTERS: Elements = Elements { file_type: FileType::C, runs: "counts", run: "counted" };

impl Elements {
    /// Passes findings of the timer report on.
    pub(super) fn report(
        &self,
        context: &Context<'_>,
        found: &mut Found,
        kind: Kind,
        message: impl Fn(&TimerFinding) -> String,
    ) {
        for it in self.findings(context, kind) {
            found.add(&it.locations, &it.address, message(it));
        }
    }

    /// Findings of the timer report about these elements.
    pub(super) fn findings<'a>(
        &self,
        context: &'a Context<'_>,
        kind: Kind,
    ) -> impl Iterator<Item = &'a TimerFinding> + use<'a> {
        let file_type = self.file_type;
        context.timers.findings.iter().filter(move |it| it.kind == kind && it.address.file_type == file_type)
    }

    /// Elements that several instructions run.
    pub(super) fn shared(&self, context: &Context<'_>, found: &mut Found) {
        self.report(context, found, Kind::SeveralInstructions, |it| {
            format!("{} is {} in {}", it.address, self.run, rungs(&it.locations))
        });
    }

    /// Elements that are read and that nothing runs.
    pub(super) fn only_read(&self, context: &Context<'_>, found: &mut Found) {
        self.report(context, found, Kind::OnlyRead, |it| {
            format!("{} is read in {} and nothing {} it", it.address, rungs(&it.locations), self.runs)
        });
    }

    /// Elements that run and that nothing reads.
    pub(super) fn never_read(&self, context: &Context<'_>, found: &mut Found) {
        self.report(context, found, Kind::NeverRead, |it| format!("nothing in the program reads {}", it.address));
    }
}
