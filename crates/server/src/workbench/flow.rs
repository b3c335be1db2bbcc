//! Power flow of the last scan, a byte for every instruction.

use std::collections::BTreeMap;
use std::sync::Arc;

/// The instruction was executed in the last scan that was watched.
pub const EXECUTED: u8 = 1;
/// Power reached it.
pub const BEFORE: u8 = 2;
/// It passed power on; for an output: its rung was true.
pub const AFTER: u8 = 4;
/// What it passes on is not what it passed on in the scan before.
pub const CHANGED: u8 = 8;

/// Power at every instruction of a program. A routine is a program file, by its number, or a code block, by
/// its place in the text; rungs and instructions count from 0.
#[derive(Clone, Debug, Default)]
pub struct Flow {
    /// Per routine the first slot of each rung, and the end of the last one.
    routines: Arc<BTreeMap<u16, Vec<u32>>>,
    bits: Vec<u8>,
    before: Vec<u8>,
}

impl Flow {
    /// Room for a program: routines with the number of instructions of each rung.
    pub fn new(routines: impl IntoIterator<Item = (u16, Vec<usize>)>) -> Flow {
        let mut all = BTreeMap::new();
        let mut slot = 0u32;
        for (routine, rungs) in routines {
            let mut starts = Vec::with_capacity(rungs.len() + 1);
            for count in rungs {
                starts.push(slot);
                slot = slot.saturating_add(u32::try_from(count).unwrap_or(u32::MAX));
            }
            starts.push(slot);
            all.insert(routine, starts);
        }
        Flow { routines: Arc::new(all), bits: vec![0; slot as usize], before: vec![0; slot as usize] }
    }

    /// A scan begins: what is known becomes what was before.
    pub fn begin(&mut self) {
        std::mem::swap(&mut self.bits, &mut self.before);
        self.bits.fill(0);
    }

    /// An instruction was executed. In a routine that runs more than once in a scan the last time counts.
    pub fn saw(&mut self, routine: u16, rung: u16, instruction: u16, before: bool, after: bool) {
        let Some(range) = self.range(routine, rung) else { return };
        let slot = range.start + usize::from(instruction);
        if slot >= range.end {
            return;
        }
        let was = self.before.get(slot).copied().unwrap_or(0);
        let mut bits = EXECUTED | if before { BEFORE } else { 0 } | if after { AFTER } else { 0 };
        if was & EXECUTED != 0 && (was ^ bits) & AFTER != 0 {
            bits |= CHANGED;
        }
        if let Some(spot) = self.bits.get_mut(slot) {
            *spot = bits;
        }
    }

    /// The instructions of a rung.
    pub fn rung(&self, routine: u16, rung: u16) -> &[u8] {
        self.range(routine, rung).and_then(|range| self.bits.get(range)).unwrap_or(&[])
    }

    fn range(&self, routine: u16, rung: u16) -> Option<std::ops::Range<usize>> {
        let starts = self.routines.get(&routine)?;
        let rung = usize::from(rung);
        Some(*starts.get(rung)? as usize..*starts.get(rung + 1)? as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_contact_is_marked_for_one_scan() {
        let mut flow = Flow::new([(2, vec![2, 1]), (3, vec![1])]);
        for (after, marks) in [(false, 0), (true, CHANGED), (true, 0), (false, CHANGED)] {
            flow.begin();
            flow.saw(2, 1, 0, true, after);
            let power = if after { AFTER } else { 0 };
            assert_eq!(flow.rung(2, 1), [EXECUTED | BEFORE | power | marks]);
            assert_eq!(flow.rung(2, 0), [0, 0], "not executed");
        }
    }

    #[test]
    fn what_is_beyond_the_program_is_ignored() {
        let mut flow = Flow::new([(2, vec![1])]);
        flow.saw(2, 0, 1, true, true);
        flow.saw(2, 1, 0, true, true);
        flow.saw(9, 0, 0, true, true);
        assert_eq!((flow.rung(2, 0), flow.rung(9, 0)), (&[0][..], &[][..]));
    }
}
