//! COP, CPW and FLL.

/// Words that LENGTH elements of the destination take, cut to what its file has left.
///
/// LENGTH counts elements of the destination (community; manual, unseen). SLC processors stop at the
/// end of the destination file (manual, unseen); a LENGTH of 0 or below moves nothing (open).
pub fn extent(length: i16, words_per_element: usize, room: usize) -> usize {
    usize::try_from(length).unwrap_or(0).saturating_mul(words_per_element).min(room)
}

/// COP and CPW: copies `count` words within the data table, from the lowest to the highest, so that a
/// copy to an overlapping higher place repeats what it has copied (community). Nothing is converted.
///
/// What would be outside the table is left out; returns the words copied.
pub fn copy(table: &mut [u16], from: usize, to: usize, count: usize) -> usize {
    let room = table.len().saturating_sub(from.max(to));
    let count = count.min(room);
    if count == 0 {
        return 0;
    }
    if from < to && to - from < count {
        for offset in 0..count {
            let Some(&word) = table.get(from + offset) else { break };
            if let Some(place) = table.get_mut(to + offset) {
                *place = word;
            }
        }
    } else {
        table.copy_within(from..from + count, to);
    }
    count
}

/// FLL: repeats the words of a value over the destination (manual, unseen). A part of the value at the
/// end is written too.
pub fn fill(destination: &mut [u16], value: &[u16]) {
    if value.is_empty() {
        return;
    }
    for place in destination.chunks_mut(value.len()) {
        for (word, source) in place.iter_mut().zip(value) {
            *word = *source;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn length_counts_elements() {
        assert_eq!(extent(3, 1, 100), 3);
        assert_eq!(extent(2, 3, 100), 6, "a timer has three words");
        assert_eq!(extent(2, 42, 50), 50, "the file ends");
        assert_eq!(extent(0, 3, 9), 0);
        assert_eq!(extent(-5, 3, 9), 0);
        assert_eq!(extent(i16::MAX, usize::MAX, 7), 7);
    }

    #[test]
    fn copies_words_as_they_are() {
        // A timer's words to integers: control, PRE, ACC.
        let mut table = [0, 100, 25, 0, 0, 0];
        assert_eq!(copy(&mut table, 0, 3, 3), 3);
        assert_eq!(table, [0, 100, 25, 0, 100, 25]);
    }

    #[test]
    fn overlap_upwards_repeats() {
        let mut table = [1, 2, 3, 4, 5];
        copy(&mut table, 0, 1, 4);
        assert_eq!(table, [1, 1, 1, 1, 1]);
        let mut table = [1, 2, 3, 4, 5];
        copy(&mut table, 1, 0, 4);
        assert_eq!(table, [2, 3, 4, 5, 5]);
    }

    #[test]
    fn fills_whole_elements() {
        let mut words = [9; 5];
        fill(&mut words, &[1, 2]);
        assert_eq!(words, [1, 2, 1, 2, 1]);
        fill(&mut words, &[]);
        fill(&mut [], &[1]);
        assert_eq!(words, [1, 2, 1, 2, 1]);
    }

    proptest! {
        #[test]
        fn copies_as_a_plain_loop_does(table in prop::collection::vec(any::<u16>(), 0..20),
                                       from in 0_usize..25, to in 0_usize..25, count in 0_usize..30) {
            let mut expected = table.clone();
            for offset in 0..count {
                let (source, place) = (from + offset, to + offset);
                if source < expected.len() && place < expected.len() {
                    expected[place] = expected[source];
                } else {
                    break;
                }
            }
            let mut actual = table;
            copy(&mut actual, from, to, count);
            prop_assert_eq!(actual, expected);
        }
    }
}
