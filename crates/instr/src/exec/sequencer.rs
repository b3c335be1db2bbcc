//! SQO, SQC and SQL.

use super::control::Control;
use super::control::bit::{DONE, ENABLE, ERROR, FOUND};

/// What a sequencer does in this execution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// The control element afterwards. It leaves POS in S:24 on processors that have it (printed for SQC).
    pub control: Control,
    /// Number of the file word to work with, and of the word of every operand written with `#`.
    /// `None`: nothing to do. A number beyond the file is major error 0032, for the caller to find.
    pub word: Option<usize>,
    /// S:5/2 is to be set.
    pub control_error: bool,
}

/// Moves a sequencer on: when the rung becomes true POS rises by one, from LEN to 1; while the rung is
/// true every scan works with the word at POS. EN follows the rung; DN is set after the word at LEN has
/// been worked on and cleared when the rung next becomes true (printed).
///
/// With POS 0 and a rung that is true in the first scan, step 0 is used and POS stays 0: `first_pass` is
/// S:1/15 (community, from a course; the values: manual, unseen). LEN ≤ 0 or POS < 0 sets ER and asks
/// for S:5/2 (printed). ER goes off when the sequencer next moves with good values (open).
pub fn advance(rung: bool, first_pass: bool, mut control: Control) -> Step {
    if !rung {
        control.put(ENABLE, false);
        return Step { control, word: None, control_error: false };
    }
    let edge = !control.has(ENABLE);
    control.put(ENABLE, true);
    if control.length <= 0 || control.position < 0 {
        control.put(ERROR, true);
        return Step { control, word: None, control_error: true };
    }
    let start = first_pass && control.position == 0;
    if edge && !start {
        control.position = if control.position >= control.length { 1 } else { control.position.saturating_add(1) };
        control.put(DONE | ERROR, false);
    }
    if control.position == control.length {
        control.put(DONE, true);
    }
    Step { control, word: usize::try_from(control.position).ok(), control_error: false }
}

/// SQC: FD says whether source and file word agree in the bits of the mask, at every execution with a
/// true rung (printed).
#[must_use]
pub const fn found(mut control: Control, source: u32, mask: u32, word: u32) -> Control {
    control.put(FOUND, super::compare::meq(source, mask, word));
    control
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::exec::logic::masked;

    fn control(length: i16, position: i16) -> Control {
        Control { status: 0, length, position }
    }

    fn edge(c: Control) -> Step {
        advance(true, false, advance(false, false, c).control)
    }

    #[test]
    fn steps_through_its_file() {
        let file = [0_u32, 1, 2, 4, 8];
        let (mut c, mut seen) = (control(4, 0), Vec::new());
        for _ in 0..5 {
            let step = edge(c);
            c = step.control;
            let output = masked(step.word.and_then(|word| file.get(word)).copied().unwrap_or(99), 0x000F, 0x00F0);
            seen.push((output & 0xF, c.position, c.has(DONE)));
        }
        assert_eq!(seen, [(1, 1, false), (2, 2, false), (4, 3, false), (8, 4, true), (1, 1, false)]);
        assert_eq!(masked(file[1], 0x000F, 0x00F0), 0x00F1, "masked bits stay");
    }

    #[test]
    fn works_on_while_the_rung_is_true() {
        let first = edge(control(4, 3));
        assert_eq!(first.control.status, ENABLE | DONE);
        let held = advance(true, false, first.control);
        assert_eq!((held.word, held.control), (Some(4), first.control));
        let off = advance(false, false, held.control);
        assert_eq!((off.word, off.control.status), (None, DONE), "DN lasts until the next transition");
    }

    #[test]
    fn step_zero_is_for_the_start() {
        let start = advance(true, true, control(4, 0));
        assert_eq!((start.word, start.control.position), (Some(0), 0));
        let held = advance(true, false, start.control);
        assert_eq!(held.word, Some(0));
        assert_eq!(edge(held.control).word, Some(1));
        assert_eq!(advance(true, true, control(4, 2)).word, Some(3), "not the start");
        assert_eq!(edge(advance(false, true, control(4, 0)).control).word, Some(1));
    }

    #[test]
    fn compare_printed_numbers() {
        let step = edge(control(4, 1));
        assert_eq!(step.word, Some(2));
        let c = found(step.control, 0x249D, 0xFFF0, 0x249A);
        assert!(c.has(FOUND));
        assert!(!found(c, 0x249D, 0xFFFF, 0x249A).has(FOUND));
    }

    #[test]
    fn errors() {
        for bad in [control(0, 0), control(-1, 0), control(4, -1)] {
            let step = edge(bad);
            assert_eq!((step.word, step.control_error), (None, true));
            assert!(step.control.has(ERROR | ENABLE));
        }
        let repaired = edge(Control { status: ERROR, length: 2, position: 0 });
        assert_eq!((repaired.control.status, repaired.word), (ENABLE, Some(1)));
        assert_eq!(edge(control(4, 9)).word, Some(1), "a POS beyond LEN wraps");
    }

    proptest! {
        #[test]
        fn stays_between_one_and_length(status: u16, length: i16, position: i16, edges in 1_usize..20) {
            let mut c = Control { status, length, position };
            for _ in 0..edges {
                let step = edge(c);
                c = step.control;
                if let Some(word) = step.word {
                    prop_assert!((1..=length as usize).contains(&word));
                }
                prop_assert_eq!(step.control_error, length <= 0 || position < 0);
            }
        }
    }
}
