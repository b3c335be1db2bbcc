//! FBC and DDT: finding bits that differ from a reference.

use super::BeyondFile;
use super::control::Control;
use super::control::bit::{DONE, ENABLE, ERROR, FOUND, INHIBIT};

/// The two control elements of the instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Controls {
    /// The first: LEN bits are compared, POS is the next bit.
    pub compare: Control,
    /// The second: the result file has LEN words, POS is the next free one.
    pub result: Control,
}

/// What an execution leaves behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Detected {
    /// Both control elements afterwards.
    pub controls: Controls,
    /// S:5/2 is to be set (inferred: as for other control errors).
    pub control_error: bool,
}

/// FBC and DDT: when the rung becomes true, compares bits of the source with the reference and stores
/// the numbers of those that differ in the result file; DDT (`adopt`) also makes the reference equal
/// (printed).
///
/// With IN off the whole file is searched in one scan, with IN on one bit is compared per transition of
/// the rung. DN of the comparison is set at the end of the files, DN of the result when the result file
/// is full, which also stops the search; FD when mismatches were recorded. The transition of the rung
/// starts anew from bit 0 when POS has reached LEN, and from the first result word when the result file
/// is full. A false rung clears EN, DN and FD of both (printed: the control bits are reset). LEN ≤ 0 or
/// POS < 0 sets ER, which the program must clear (printed); while ER is set nothing is done (inferred).
///
/// Slices reach from the named address to the end of its file. Bit numbers count from 0 (inferred: the
/// results are called positions).
///
/// # Errors
/// A length reaches beyond its file.
pub fn detect(
    rung: bool,
    adopt: bool,
    controls: Controls,
    source: &[u16],
    reference: &mut [u16],
    results: &mut [u16],
) -> Result<Detected, BeyondFile> {
    let Controls { mut compare, mut result } = controls;
    if !rung {
        compare.put(ENABLE | DONE | FOUND, false);
        result.put(ENABLE | DONE | FOUND, false);
        return Ok(Detected { controls: Controls { compare, result }, control_error: false });
    }
    if compare.has(ENABLE) || compare.has(ERROR) {
        return Ok(Detected { controls, control_error: false });
    }
    compare.put(ENABLE, true);
    let sound = |control: Control| control.length > 0 && control.position >= 0;
    if !sound(compare) || !sound(result) {
        compare.put(ERROR, true);
        return Ok(Detected { controls: Controls { compare, result }, control_error: true });
    }
    if compare.position >= compare.length {
        (compare.position, result.position) = (0, 0);
    }
    if result.position >= result.length {
        result.position = 0;
    }
    let (length, room) = (usize::from(compare.length.unsigned_abs()), usize::from(result.length.unsigned_abs()));
    let words = length.div_ceil(16);
    let source = source.get(..words).ok_or(BeyondFile)?;
    let reference = reference.get_mut(..words).ok_or(BeyondFile)?;
    let results = results.get_mut(..room).ok_or(BeyondFile)?;
    while compare.position < compare.length {
        let number = usize::from(compare.position.unsigned_abs());
        let (word, mask) = (number / 16, 1_u16 << (number % 16));
        compare.position += 1;
        let (Some(found), Some(expected)) = (source.get(word), reference.get_mut(word)) else { break };
        if (*found ^ *expected) & mask != 0 {
            if adopt {
                *expected ^= mask;
            }
            if let Some(place) = results.get_mut(usize::from(result.position.unsigned_abs())) {
                *place = number as u16;
            }
            result.position = result.position.saturating_add(1);
            compare.put(FOUND, true);
            result.put(DONE, result.position >= result.length);
        }
        if compare.has(INHIBIT) || result.has(DONE) {
            break;
        }
    }
    compare.put(DONE, compare.position >= compare.length);
    Ok(Detected { controls: Controls { compare, result }, control_error: false })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn controls(bits: i16, words: i16) -> Controls {
        let control = |length| Control { length, ..Control::default() };
        Controls { compare: control(bits), result: control(words) }
    }

    fn edge(adopt: bool, c: Controls, source: &[u16], reference: &mut [u16], results: &mut [u16]) -> Controls {
        let off = detect(false, adopt, c, source, reference, results).map_or(c, |d| d.controls);
        detect(true, adopt, off, source, reference, results).map_or(c, |d| d.controls)
    }

    #[test]
    fn all_in_one_scan() {
        let (source, mut reference, mut results) = ([0x0005, 0x8000], [0x0001, 0], [99; 4]);
        let c = edge(false, controls(32, 4), &source, &mut reference, &mut results);
        assert_eq!((results, reference), ([2, 31, 99, 99], [1, 0]));
        assert_eq!((c.compare.status, c.compare.position), (ENABLE | DONE | FOUND, 32));
        assert_eq!((c.result.status, c.result.position), (0, 2));
        let c = edge(true, c, &source, &mut reference, &mut results);
        assert_eq!((reference, c.result.position), (source, 2), "starts anew, adopts the source");
        let c = edge(true, c, &source, &mut reference, &mut results);
        assert_eq!((c.compare.status, c.result.position), (ENABLE | DONE, 0), "nothing left to find");
        assert_eq!(results, [2, 31, 99, 99]);
    }

    #[test]
    fn one_bit_per_transition() {
        let (source, mut reference, mut results) = ([0b110], [0], [99; 2]);
        let mut c = controls(3, 2);
        c.compare.status = INHIBIT;
        let mut seen = Vec::new();
        for _ in 0..3 {
            c = edge(false, c, &source, &mut reference, &mut results);
            seen.push((c.compare.position, c.compare.has(FOUND), c.compare.has(DONE)));
        }
        assert_eq!(seen, [(1, false, false), (2, true, false), (3, true, true)]);
        assert_eq!((results, c.result.has(DONE)), ([1, 2], true));
    }

    #[test]
    fn a_full_result_stops_the_search() {
        let (source, mut reference, mut results) = ([0xFFFF], [0], [99; 2]);
        let c = edge(false, controls(16, 2), &source, &mut reference, &mut results);
        assert_eq!((results, c.compare.position, c.compare.has(DONE), c.result.has(DONE)), ([0, 1], 2, false, true));
        let c = edge(false, c, &source, &mut reference, &mut results);
        assert_eq!((results, c.compare.position), ([2, 3], 4));
    }

    #[test]
    fn errors() {
        let (mut reference, mut results) = ([0], [0]);
        for bad in [controls(0, 1), controls(1, 0), controls(-1, 1)] {
            let detected = detect(true, false, bad, &[0], &mut reference, &mut results);
            assert!(detected.is_ok_and(|d| d.control_error && d.controls.compare.has(ERROR)));
        }
        assert!(detect(true, false, controls(17, 1), &[0], &mut reference, &mut results).is_err());
        assert!(detect(true, false, controls(16, 2), &[0], &mut reference, &mut results).is_err());
    }

    proptest! {
        #[test]
        fn adopting_makes_equal(source: [u16; 3], mut reference: [u16; 3], bits in 1_i16..49) {
            let mut results = [0; 48];
            let before = reference;
            let c = edge(true, controls(bits, 48), &source, &mut reference, &mut results);
            let differing: u32 = (0..bits as usize)
                .map(|n| u32::from((source[n / 16] ^ before[n / 16]) >> (n % 16) & 1))
                .sum();
            prop_assert_eq!(u32::from(c.result.position.unsigned_abs()), differing);
            for n in 0..48 {
                let bit = |words: [u16; 3]| words[n / 16] >> (n % 16) & 1;
                prop_assert_eq!(bit(reference), if n < bits as usize { bit(source) } else { bit(before) });
            }
        }
    }
}
