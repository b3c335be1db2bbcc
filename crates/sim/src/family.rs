//! What differs between processor families, as the engine needs it.

use instr::exec::Lineage as L;
pub(crate) use instr::exec::Lineage;
use ladder::Family;

/// Family facts resolved once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Traits {
    pub(crate) lineage: Lineage,
    /// JSR levels from the main program.
    pub(crate) levels: usize,
    /// JSR levels from interrupt and fault routines.
    pub(crate) interrupt_levels: usize,
    /// Nanoseconds per count of S:4.
    pub(crate) clock_tick: u64,
}

impl Traits {
    pub(crate) fn of(family: Family) -> Traits {
        let lineage = L::of(family);
        Traits {
            lineage,
            levels: if lineage == L::S1 { 4 } else { 8 },
            interrupt_levels: if lineage == L::S1 { 4 } else { 3 },
            clock_tick: if lineage == L::Mx { 100_000 } else { 10_000_000 },
        }
    }

    pub(crate) fn mx(self) -> bool {
        self.lineage == L::Mx
    }

    /// S:24 exists and indexes word operands written with `#`.
    pub(crate) fn indexes(self) -> bool {
        matches!(self.lineage, L::S2 | L::S3 | L::M10)
    }

    /// Interrupt set-up lives in the status file.
    pub(crate) fn status_file_sti(self) -> bool {
        self.indexes()
    }
}
