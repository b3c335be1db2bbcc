//! What was done to both sides, scan by scan.

/// One scan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Head {
    /// Leave run and enter it again before the scan; it has no time before it then.
    pub(crate) program_run: bool,
    /// Time before the scan, in microseconds.
    pub(crate) dt: u32,
    /// End of its changes of inputs.
    end: u32,
}

/// A change of an input: its number and its value.
pub(crate) type Set = (u16, u32);

/// Scans with the changes of inputs before each. Keeps its memory when it is cleared.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Tape {
    heads: Vec<Head>,
    sets: Vec<Set>,
}

impl Tape {
    pub(crate) fn clear(&mut self) {
        self.heads.clear();
        self.sets.clear();
    }

    pub(crate) fn len(&self) -> usize {
        self.heads.len()
    }

    /// Adds a change that belongs to the scan pushed next.
    pub(crate) fn set(&mut self, set: Set) {
        self.sets.push(set);
    }

    /// Adds a scan with the changes added since the last one.
    pub(crate) fn push(&mut self, program_run: bool, dt: u32) {
        let end = u32::try_from(self.sets.len()).unwrap_or(u32::MAX);
        self.heads.push(Head { program_run, dt, end });
    }

    /// A scan and its changes.
    pub(crate) fn get(&self, index: usize) -> Option<(Head, &[Set])> {
        let head = *self.heads.get(index)?;
        let start = index.checked_sub(1).and_then(|before| self.heads.get(before)).map_or(0, |before| before.end);
        Some((head, self.sets.get(start as usize..head.end as usize).unwrap_or_default()))
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = (Head, &[Set])> {
        (0..self.len()).filter_map(|index| self.get(index))
    }

    /// Appends scans of another tape.
    pub(crate) fn extend<'t>(&mut self, scans: impl Iterator<Item = (Head, &'t [Set])>) {
        for (head, sets) in scans {
            self.sets.extend_from_slice(sets);
            self.push(head.program_run, head.dt);
        }
    }

    /// The first scans.
    pub(crate) fn first(&self, scans: usize) -> Tape {
        let mut tape = Tape::default();
        tape.extend(self.iter().take(scans));
        tape
    }

    /// The scans behind the first ones.
    pub(crate) fn rest(&self, scans: usize) -> Tape {
        let mut tape = Tape::default();
        tape.extend(self.iter().skip(scans));
        tape
    }

    /// Changes of inputs.
    pub(crate) fn changes(&self) -> usize {
        self.sets.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_belong_to_the_scan_behind_them() {
        let mut tape = Tape::default();
        tape.push(false, 0);
        tape.set((1, 1));
        tape.set((2, 7));
        tape.push(false, 10_000);
        tape.set((1, 0));
        tape.push(true, 0);
        let sets: Vec<_> = tape.iter().map(|(_, sets)| sets.to_vec()).collect();
        assert_eq!(sets, [vec![], vec![(1, 1), (2, 7)], vec![(1, 0)]]);
        assert_eq!(tape.first(2).changes(), 2);
        assert_eq!(tape.get(1).map(|scan| scan.0.dt), Some(10_000));
    }
}
