//! BSL and BSR.

use super::control::Control;
use super::control::bit::{DONE, ENABLE, ERROR, UNLOAD};
use super::{BeyondFile, Done};

/// Which way bits move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// BSL: to higher numbers. The bit at the bit address enters at number 0, the last one leaves.
    Left,
    /// BSR: to lower numbers. The bit enters at number LENGTH - 1, bit 0 leaves.
    Right,
}

/// BSL and BSR: when the rung becomes true, all LENGTH bits move by one in that scan, and the one that
/// leaves goes to UL (printed).
///
/// `entering` is the bit at the bit address, read before this call: with the old end bit or UL as bit
/// address the array is a ring (printed; UL: inferred). `array` reaches from the named word to the end of
/// its file. Bits behind LENGTH in the last word, of which the manual says not to use them, stay. EN
/// follows the rung; DN is set by the shift and cleared with the rung. LENGTH 0 moves the entering bit
/// to UL; a negative LEN or POS sets ER and asks for S:5/2 (manual, unseen).
///
/// # Errors
/// LENGTH reaches beyond the file: major error 0033 (manual, unseen).
pub fn shift(
    direction: Direction,
    rung: bool,
    mut control: Control,
    entering: bool,
    array: &mut [u16],
) -> Result<Done, BeyondFile> {
    if !rung {
        control.put(ENABLE | DONE, false);
        return Ok(Done { control, control_error: false });
    }
    if control.has(ENABLE) {
        return Ok(Done { control, control_error: false });
    }
    let Ok(length) = usize::try_from(control.length) else {
        return Ok(failed(control));
    };
    if control.position < 0 {
        return Ok(failed(control));
    }
    let words = array.get_mut(..length.div_ceil(16)).ok_or(BeyondFile)?;
    let leaving = match direction {
        Direction::Left => left(words, length, entering),
        Direction::Right => right(words, length, entering),
    };
    control.put(ENABLE | DONE, true);
    control.put(ERROR, false);
    control.put(UNLOAD, leaving);
    Ok(Done { control, control_error: false })
}

fn failed(mut control: Control) -> Done {
    control.put(ENABLE | ERROR, true);
    Done { control, control_error: true }
}

/// Bits of the array in its last word, 1 to 16.
const fn bits_in_last(length: usize) -> u32 {
    match length % 16 {
        0 => 16,
        part => part as u32,
    }
}

/// The lowest `bits` bits, at most 16.
const fn mask(bits: u32) -> u16 {
    (u16::MAX as u32 >> (16 - bits)) as u16
}

fn left(words: &mut [u16], length: usize, entering: bool) -> bool {
    let mut carry = u16::from(entering);
    let count = words.len();
    for (index, word) in words.iter_mut().enumerate() {
        let bits = if index + 1 == count { bits_in_last(length) } else { 16 };
        let used = mask(bits);
        let leaving = *word >> (bits - 1) & 1;
        *word = (*word << 1 | carry) & used | *word & !used;
        carry = leaving;
    }
    carry != 0
}

fn right(words: &mut [u16], length: usize, entering: bool) -> bool {
    let mut carry = u16::from(entering);
    let count = words.len();
    for (index, word) in words.iter_mut().enumerate().rev() {
        let bits = if index + 1 == count { bits_in_last(length) } else { 16 };
        let used = mask(bits);
        let leaving = *word & 1;
        *word = (*word & used) >> 1 | carry << (bits - 1) | *word & !used;
        carry = leaving;
    }
    carry != 0
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn control(length: i16) -> Control {
        Control { length, ..Control::default() }
    }

    fn edge(direction: Direction, length: i16, entering: bool, array: &mut [u16]) -> Control {
        shift(direction, true, control(length), entering, array).map_or_else(|_| panic!("beyond"), |done| done.control)
    }

    #[test]
    fn left_in_one_word() {
        let mut array = [0x8001];
        let mut c = edge(Direction::Left, 16, false, &mut array);
        assert_eq!((array, c.status), ([0x0002], ENABLE | DONE | UNLOAD));
        for _ in 0..5 {
            c = shift(Direction::Left, true, c, true, &mut array).map_or(c, |done| done.control);
        }
        assert_eq!(array, [0x0002], "no more shifts while the rung stays true");
        let off = shift(Direction::Left, false, c, true, &mut array).map(|done| done.control.status);
        assert_eq!(off, Ok(UNLOAD));
    }

    #[test]
    fn right_in_one_word() {
        let mut array = [0x8001];
        assert!(edge(Direction::Right, 16, true, &mut array).has(UNLOAD));
        assert_eq!(array, [0xC000]);
    }

    #[test]
    fn printed_arrays() {
        // B3/16 to B3/73: 58 bits from B3:1.
        let mut array = [0, 0, 0, 1 << 9];
        assert!(edge(Direction::Left, 58, true, &mut array).has(UNLOAD));
        assert_eq!(array[0], 1);
        assert_eq!(array[3] & 0x03FF, 0, "bit 57 has left");
        // B3/32 to B3/69: 38 bits from B3:2.
        let mut array = [1, 0, 1 << 5];
        assert!(edge(Direction::Right, 38, false, &mut array).has(UNLOAD));
        assert_eq!(array, [0, 0, 1 << 4]);
    }

    #[test]
    fn bits_behind_the_array_stay() {
        let mut array = [0xFFE0];
        assert!(!edge(Direction::Left, 5, true, &mut array).has(UNLOAD));
        assert_eq!(array, [0xFFE1]);
        assert!(edge(Direction::Right, 5, true, &mut array).has(UNLOAD));
        assert_eq!(array, [0xFFF0]);
    }

    #[test]
    fn lengths_out_of_order() {
        let mut array = [0xAAAA];
        assert_eq!(edge(Direction::Left, 0, true, &mut array).status, ENABLE | DONE | UNLOAD);
        let bad = shift(Direction::Left, true, control(-1), true, &mut array);
        assert_eq!(bad.map(|done| (done.control.status, done.control_error)), Ok((ENABLE | ERROR, true)));
        let bad = Control { position: -1, ..control(3) };
        assert!(shift(Direction::Right, true, bad, true, &mut array).is_ok_and(|done| done.control_error));
        assert_eq!(shift(Direction::Left, true, control(17), true, &mut array), Err(BeyondFile));
        assert_eq!(shift(Direction::Left, true, control(i16::MAX), true, &mut []), Err(BeyondFile));
        assert_eq!(array, [0xAAAA]);
    }

    proptest! {
        #[test]
        fn a_ring_comes_round(mut array in prop::collection::vec(any::<u16>(), 1..8), cut in 0_usize..16) {
            let length = array.len() * 16 - cut;
            let before = array.clone();
            let bit = |array: &[u16], n: usize| array[n / 16] >> (n % 16) & 1 != 0;
            for _ in 0..length {
                let entering = bit(&array, length - 1);
                let c = edge(Direction::Left, length as i16, entering, &mut array);
                prop_assert_eq!(c.has(UNLOAD), entering);
            }
            prop_assert_eq!(&array, &before);
            let entering = bit(&array, 0);
            let left_out = edge(Direction::Right, length as i16, entering, &mut array).has(UNLOAD);
            prop_assert_eq!(left_out, entering);
            edge(Direction::Left, length as i16, bit(&array, length - 1), &mut array);
            prop_assert_eq!(array, before, "left undoes right");
        }
    }
}
