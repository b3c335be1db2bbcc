//! Which words of a record are decoded, and what the others hold beside a printout.
//!
//! Some settings (parity, error detection ..) have one value in every report, so no word or bit can be
//! named for them. But a record that differs from a printed one in decoded words only must print the
//! same values: that much is known without knowing the places.

use super::{ChannelRecord, DRIVER, ETHERNET_BYTES, GENERAL, SERIAL_BYTES};

/// A word that is not zero in every printed record.
struct Word {
    /// Number, as in the format page.
    at: usize,
    /// Bits that have a setting of their own.
    decoded: u16,
    /// Bits that differ between printouts with the same values of the other settings.
    free: u16,
    /// The bits that are not free, beside the printouts.
    printed: u16,
}

const fn decoded(at: usize) -> Word {
    Word { at, decoded: 0xFFFF, free: 0xFFFF, printed: 0 }
}

const fn fixed(at: usize, decoded: u16, printed: u16) -> Word {
    Word { at, decoded, free: 0, printed }
}

const GENERAL_WORDS: &[Word] = &[decoded(3), decoded(4), fixed(5, 0x0003, 0x0003), decoded(9)];
const DF1_WORDS: &[Word] = &[
    fixed(14, 0xFFFF, 8),
    fixed(15, 0, 0x0048),
    decoded(17),
    decoded(22),
    decoded(23),
    Word { at: 25, decoded: 0x00FF, free: 0x00FF, printed: 0x1C00 },
];
const MODBUS_WORDS: &[Word] =
    &[fixed(14, 0xFFFF, 9), fixed(15, 0, 0x0049), Word { at: 25, decoded: 0x00FF, free: 0x00FF, printed: 0 }];
/// Of another driver only what both known ones have in common; it never equals a printed one.
const SERIAL_WORDS: &[Word] = &[
    Word { at: 14, decoded: 0xFFFF, free: 0, printed: 8 },
    Word { at: 25, decoded: 0x00FF, free: 0x00FF, printed: 0 },
];
const ETHERNET_WORDS: &[Word] = &[
    fixed(15, 0, 0x0084),
    decoded(16),
    decoded(17),
    decoded(18),
    decoded(19),
    decoded(20),
    decoded(21),
    decoded(22),
    decoded(23),
    decoded(24),
    decoded(27),
    decoded(28),
    decoded(29),
    decoded(30),
    Word { at: 63, decoded: 0x2103, free: 0x0003, printed: 0x0100 },
    Word { at: 65, decoded: 0, free: 0x0001, printed: 0 },
    fixed(66, 0, 0x000F),
];

/// The words of a record, and the number its first word has on the format page.
fn known(record: &ChannelRecord<'_>) -> Option<(&'static [Word], usize)> {
    match (record.id, record.data.len()) {
        (GENERAL, 18) if record.word == 0 => Some((GENERAL_WORDS, 0)),
        (DRIVER, SERIAL_BYTES) => match record.word(record.word + 2) {
            Some(8) => Some((DF1_WORDS, 12)),
            Some(9) => Some((MODBUS_WORDS, 12)),
            _ => Some((SERIAL_WORDS, 12)),
        },
        (DRIVER, ETHERNET_BYTES) => Some((ETHERNET_WORDS, 12)),
        _ => None,
    }
}

/// Each word of the record with what is known of it.
fn words<'r>(record: &'r ChannelRecord<'_>) -> impl Iterator<Item = (u16, Option<&'static Word>)> + 'r {
    let (known, first) = known(record).unwrap_or((&[], 0));
    let values = record.data.as_chunks::<2>().0.iter().map(|pair| u16::from_le_bytes(*pair));
    values.zip(first + 2..).map(move |(value, at)| (value, known.iter().find(|word| word.at == at)))
}

/// Whether a record equals one that RSLogix printed the settings of, up to decoded words.
pub(super) fn as_printed(record: &ChannelRecord<'_>) -> bool {
    known(record).is_some()
        && words(record).all(|(value, word)| match word {
            Some(word) => value & !word.free == word.printed,
            None => value == 0,
        })
}

/// Words of the record with a bit set that no setting tells.
pub(super) fn unexplained(record: &ChannelRecord<'_>) -> usize {
    if as_printed(record) {
        return 0;
    }
    words(record).filter(|(value, word)| value & !word.map_or(0, |word| word.decoded) != 0).count()
}
