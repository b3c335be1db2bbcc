//! How much a report lists of what can grow with the square of a program.
//!
//! Where many instructions each touch a whole file, every address of it has all of them for accesses.
//! A report over all addresses stays in proportion to the program by these bounds, and counts what
//! it leaves out. Asking for one address always gives everything.

/// Accesses listed of one address. The most known of a real program are 1,144.
pub const MAX_LISTED: usize = 5_000;

/// Accesses listed in one report. The largest known program has 24,852.
pub const MAX_ROWS: usize = 200_000;

/// Stretches compared in one report; a real program needs about one per row.
const MAX_COMPARED: usize = 4_000_000;

/// What is left of the bounds while a report is made.
pub(crate) struct Budget {
    rows: usize,
    compared: usize,
}

impl Budget {
    /// Of a report over all addresses.
    pub(crate) fn of_report() -> Budget {
        Budget { rows: MAX_ROWS, compared: MAX_COMPARED }
    }

    /// Of a question about one address.
    pub(crate) fn unlimited() -> Budget {
        Budget { rows: usize::MAX, compared: usize::MAX }
    }

    /// There have been too many comparisons to look up another address.
    pub(crate) fn is_spent(&self) -> bool {
        self.compared == 0
    }

    pub(crate) fn spend(&mut self, compared: usize) {
        self.compared = self.compared.saturating_sub(compared);
    }

    /// How many of `found` accesses of one address are listed.
    pub(crate) fn rows(&mut self, found: usize) -> usize {
        let most = if self.rows == usize::MAX { usize::MAX } else { self.rows.min(MAX_LISTED) };
        let listed = found.min(most);
        if self.rows != usize::MAX {
            self.rows -= listed;
        }
        listed
    }
}
