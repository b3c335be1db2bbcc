//! FFL, FFU, LFL and LFU.

use super::choices::Choice;
use super::control::Control;
use super::control::bit::{DONE, EMPTY, ENABLE, ENABLE_UNLOAD, ERROR};
use super::rules::Rules;
use super::{BeyondFile, Done};

/// Which value an unload takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Order {
    /// FFU: the oldest. The others move down by one.
    FirstIn,
    /// LFU: the newest.
    LastIn,
}

/// Words of an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Entry {
    /// A word; in the values of this module it stands in the low 16 bits.
    Word,
    /// A long word, low word first.
    Long,
}

impl Entry {
    const fn words(self) -> usize {
        match self {
            Entry::Word => 1,
            Entry::Long => 2,
        }
    }
}

/// LEN and POS as counts, when they make sense: negative ones and POS above LEN are errors (manual,
/// unseen).
fn counts(control: Control) -> Option<(usize, usize)> {
    let (length, position) = (usize::try_from(control.length).ok()?, usize::try_from(control.position).ok()?);
    (position <= length).then_some((length, position))
}

/// The words of the stack, when they are within its file.
fn area(file: &mut [u16], length: usize, entry: Entry) -> Result<&mut [u16], BeyondFile> {
    file.get_mut(..length * entry.words()).ok_or(BeyondFile)
}

/// DN and EM say full and empty; recomputed whenever a load or unload works (inferred).
fn fill_flags(control: &mut Control) {
    let (length, position) = (control.length, control.position);
    control.put(DONE, position >= length);
    control.put(EMPTY, position == 0);
}

fn failed(mut control: Control, enable: u16) -> Done {
    control.put(enable | ERROR, true);
    Done { control, control_error: true }
}

/// FFL and LFL: when the rung becomes true and DN is off, the value goes to place POS and POS rises;
/// DN comes on when the stack is full (printed). EN follows the rung.
///
/// `file` reaches from the named address to the end of its file. On processors with S:24 the
/// instruction leaves the POS it found there (printed).
///
/// # Errors
/// LEN reaches beyond the file: major error 0033 (manual, unseen).
pub fn load(rung: bool, mut control: Control, value: u32, file: &mut [u16], entry: Entry) -> Result<Done, BeyondFile> {
    if !rung {
        control.put(ENABLE, false);
        return Ok(Done { control, control_error: false });
    }
    if control.has(ENABLE) {
        return Ok(Done { control, control_error: false });
    }
    let Some((length, position)) = counts(control) else {
        return Ok(failed(control, ENABLE));
    };
    let stack = area(file, length, entry)?;
    if !control.has(DONE) && position < length {
        put(stack, position, value, entry);
        control.position = control.position.saturating_add(1);
    }
    control.put(ENABLE, true);
    control.put(ERROR, false);
    fill_flags(&mut control);
    Ok(Done { control, control_error: false })
}

/// FFU and LFU: when the rung becomes true, a value leaves the stack, POS falls and DN goes off; EM
/// comes on when the stack is empty (printed). EU follows the rung.
///
/// With [`Order::FirstIn`] all LEN entries move down and the highest becomes 0 (printed). Whether LFU
/// clears the word it took out is open ([`Choice::LfuClears`]), and so is what an empty stack gives
/// ([`Choice::EmptyUnloadClears`]): `None` leaves the destination. On processors with S:24 the
/// instruction leaves the new POS there (printed).
///
/// # Errors
/// LEN reaches beyond the file: major error 0033 (manual, unseen).
pub fn unload(
    order: Order,
    rung: bool,
    mut control: Control,
    file: &mut [u16],
    entry: Entry,
    rules: Rules,
) -> Result<(Done, Option<u32>), BeyondFile> {
    if !rung {
        control.put(ENABLE_UNLOAD, false);
        return Ok((Done { control, control_error: false }, None));
    }
    if control.has(ENABLE_UNLOAD) {
        return Ok((Done { control, control_error: false }, None));
    }
    let Some((length, position)) = counts(control) else {
        return Ok((failed(control, ENABLE_UNLOAD), None));
    };
    let stack = area(file, length, entry)?;
    let value = match (position.checked_sub(1), order) {
        (None, _) => rules.has(Choice::EmptyUnloadClears).then_some(0),
        (Some(_), Order::FirstIn) => {
            let value = get(stack, 0, entry);
            let words = entry.words();
            stack.copy_within(words.min(stack.len()).., 0);
            put(stack, length - 1, 0, entry);
            Some(value)
        }
        (Some(top), Order::LastIn) => {
            let value = get(stack, top, entry);
            if rules.has(Choice::LfuClears) {
                put(stack, top, 0, entry);
            }
            Some(value)
        }
    };
    control.position = control.position.saturating_sub(1).max(0);
    control.put(ENABLE_UNLOAD, true);
    control.put(ERROR, false);
    fill_flags(&mut control);
    Ok((Done { control, control_error: false }, value))
}

fn get(stack: &[u16], index: usize, entry: Entry) -> u32 {
    let word = |at: usize| stack.get(at).copied().map_or(0, u32::from);
    match entry {
        Entry::Word => word(index),
        Entry::Long => word(2 * index) | word(2 * index + 1) << 16,
    }
}

fn put(stack: &mut [u16], index: usize, value: u32, entry: Entry) {
    let at = index * entry.words();
    let halves = [value as u16, (value >> 16) as u16];
    for (word, half) in stack.iter_mut().skip(at).zip(halves).take(entry.words()) {
        *word = half;
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;

    use proptest::prelude::*;

    use super::*;
    use crate::exec::Lineage;

    fn rules() -> Rules {
        Rules::new(Lineage::S3)
    }

    fn control(length: i16, position: i16) -> Control {
        Control { status: 0, length, position }
    }

    /// A true execution after a false one.
    fn push(c: Control, value: u32, stack: &mut [u16], entry: Entry) -> Control {
        let off = load(false, c, value, stack, entry).map_or(c, |done| done.control);
        load(true, off, value, stack, entry).map_or(c, |done| done.control)
    }

    fn pop(order: Order, c: Control, stack: &mut [u16], entry: Entry, rules: Rules) -> (Control, Option<u32>) {
        let off = unload(order, false, c, stack, entry, rules).map_or(c, |(done, _)| done.control);
        unload(order, true, off, stack, entry, rules).map_or((c, None), |(done, value)| (done.control, value))
    }

    #[test]
    fn loads_until_full() {
        let (mut stack, mut c) = ([0; 4], control(3, 0));
        for value in [11, 22, 33] {
            c = push(c, value, &mut stack, Entry::Word);
        }
        assert_eq!((stack, c.position, c.status), ([11, 22, 33, 0], 3, ENABLE | DONE));
        c = push(c, 44, &mut stack, Entry::Word);
        assert_eq!((stack, c.position, c.status), ([11, 22, 33, 0], 3, ENABLE | DONE));
        let held = load(true, control(3, 0), 1, &mut stack, Entry::Word).map(|done| done.control);
        let again = held.and_then(|c| load(true, c, 2, &mut stack, Entry::Word)).map(|done| done.control.position);
        assert_eq!(again, Ok(1), "one load per transition");
    }

    #[test]
    fn first_in_first_out() {
        let mut stack = [11, 22, 33];
        let full = Control { status: ENABLE | DONE, length: 3, position: 3 };
        let (c, value) = pop(Order::FirstIn, full, &mut stack, Entry::Word, rules());
        assert_eq!((value, stack, c.position), (Some(11), [22, 33, 0], 2));
        assert_eq!(c.status, ENABLE | ENABLE_UNLOAD);
        let (c, _) = pop(Order::FirstIn, c, &mut stack, Entry::Word, rules());
        let (c, value) = pop(Order::FirstIn, c, &mut stack, Entry::Word, rules());
        assert_eq!((value, c.position), (Some(33), 0));
        assert!(c.has(EMPTY));
        let (c, value) = pop(Order::FirstIn, c, &mut stack, Entry::Word, rules());
        assert_eq!((value, c.position), (None, 0));
        assert!(c.has(EMPTY | ENABLE_UNLOAD));
        let clearing = rules().with(Choice::EmptyUnloadClears);
        assert_eq!(pop(Order::LastIn, c, &mut stack, Entry::Word, clearing).1, Some(0));
    }

    #[test]
    fn last_in_first_out() {
        let mut stack = [11, 22, 33];
        let full = Control { status: DONE, length: 3, position: 3 };
        let (c, value) = pop(Order::LastIn, full, &mut stack, Entry::Word, rules());
        assert_eq!((value, stack, c.position, c.has(DONE)), (Some(33), [11, 22, 33], 2, false));
        let (_, value) = pop(Order::LastIn, c, &mut stack, Entry::Word, rules().with(Choice::LfuClears));
        assert_eq!((value, stack), (Some(22), [11, 0, 33]));
    }

    #[test]
    fn long_entries() {
        let (mut stack, mut c) = ([0; 4], control(2, 0));
        c = push(c, 0x0001_0002, &mut stack, Entry::Long);
        c = push(c, 0xFFFF_FFFE, &mut stack, Entry::Long);
        assert_eq!(stack, [2, 1, 0xFFFE, 0xFFFF]);
        let (_, value) = pop(Order::FirstIn, c, &mut stack, Entry::Long, rules());
        assert_eq!((value, stack), (Some(0x0001_0002), [0xFFFE, 0xFFFF, 0, 0]));
    }

    #[test]
    fn words_out_of_order() {
        let mut stack = [0; 3];
        for bad in [control(-1, 0), control(3, -1), control(3, 4), control(i16::MIN, i16::MIN)] {
            let loaded = load(true, bad, 1, &mut stack, Entry::Word);
            assert_eq!(loaded.map(|done| (done.control.status, done.control_error)), Ok((ENABLE | ERROR, true)));
            let unloaded = unload(Order::FirstIn, true, bad, &mut stack, Entry::Word, rules());
            assert!(unloaded.is_ok_and(|(done, value)| done.control_error && value.is_none()));
        }
        assert_eq!(load(true, control(4, 0), 1, &mut stack, Entry::Word), Err(BeyondFile));
        assert_eq!(load(true, control(2, 0), 1, &mut stack, Entry::Long), Err(BeyondFile));
        assert!(unload(Order::LastIn, true, control(9, 1), &mut stack, Entry::Word, rules()).is_err());
        let none = unload(Order::FirstIn, true, control(0, 0), &mut [], Entry::Word, rules());
        assert!(none.is_ok_and(|(done, value)| done.control.has(DONE | EMPTY) && value.is_none()));
        assert_eq!(stack, [0; 3]);
    }

    proptest! {
        #[test]
        fn behaves_as_a_queue(actions in prop::collection::vec(prop::option::of(any::<u16>()), 0..60), length in 1_i16..6) {
            let (mut stack, mut c, mut model) = (vec![0; 6], control(length, 0), VecDeque::new());
            for action in actions {
                match action {
                    Some(value) => {
                        c = push(c, value.into(), &mut stack, Entry::Word);
                        if model.len() < length as usize {
                            model.push_back(u32::from(value));
                        }
                    }
                    None => {
                        let (next, value) = pop(Order::FirstIn, c, &mut stack, Entry::Word, rules());
                        prop_assert_eq!(value, model.pop_front());
                        c = next;
                    }
                }
                prop_assert_eq!(c.position as usize, model.len());
                prop_assert_eq!(c.has(EMPTY), model.is_empty());
                prop_assert_eq!(c.has(DONE), model.len() == length as usize);
            }
        }
    }
}
