//! Tests of the documentation database: a stream laid out by hand, and random ones written and read back.

use super::*;
use crate::archive::{parse, serialize};
use crate::error::Mode;
use proptest::prelude::*;

/// The hand-made stream of `docs/format/mem-database.md`, with an instruction comment added.
fn sample() -> Vec<u8> {
    let mut b = b"\xFF\xFF\x80\0\x09\0DBXMemMap".to_vec();
    for field in [1u32, 20, 5, 20, 0, 5] {
        b.extend(field.to_le_bytes());
    }
    b.push(0);
    for field in [40u32, 1, 1, 1, 0] {
        b.extend(field.to_le_bytes());
    }
    b.extend(b"\x01\0");
    b.extend([1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    b.extend(b"\x0CB0003:000/05\x05PUMP1\x04pump\x06runs 1\0\0\0\0\0\0\0");
    b.extend([1, 0, 0, 0, 0, 0, 0, 0]);
    b.extend(b"\x01\0");
    b.extend([1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    b.extend(b"\0\0\x09seals in.\0\0\0\0\0\0\0\x03XIC");
    b.extend([1, 0, 0, 0, 0, 0, 0, 0]);
    b.extend(b"\x01\0\x03XIC\x01\0\x01\0\0\0\x01\0\0\0");
    b.extend(b"\x01\0\x01\0\0\0\x0ASeal-in.\r\n\x06Page 1\x11RUNG000002-000000");
    b.extend(b"\0\0");
    b
}

#[test]
fn a_stream_laid_out_by_hand() {
    let bytes = sample();
    let parsed = parse::<Database>(&bytes, "MEM DATABASE/ObjectData", Mode::Strict);
    assert_eq!(parsed.error, None);
    assert_eq!(parsed.understood, bytes.len());
    let db = parsed.value;
    assert_eq!(db.header.last_address_id, 1);
    let [entry] = &db.addresses[..] else { panic!("one record") };
    assert_eq!(entry.key, "B0003:000/05");
    assert_eq!(entry.symbol, "PUMP1");
    assert_eq!(entry.lines[1], "runs 1");
    let [comment] = &db.instruction_comments[..] else { panic!("one instruction comment") };
    assert_eq!((comment.mnemonic.to_string().as_str(), comment.address_id), ("XIC", 1));
    assert_eq!(db.mnemonics[0].uses, [(1, 1)]);
    assert_eq!(db.comments[0].text, "Seal-in.\r\n");
    assert_eq!(db.comments[0].title, "Page 1");
    assert_eq!(db.comments[0].rung(), Some((2, 0)));
    assert_eq!(serialize(&db), Ok(bytes));
}

#[test]
fn rung_keys_name_file_and_rung() {
    assert_eq!(rung_key(234, 10), "RUNG000234-000010");
    assert_eq!(parse_rung_key(b"RUNG000234-000010"), Some((234, 10)));
    for other in ["N0007:002/04", "RUNG00234-000010", "RUNG000234-00001", "RUNG+00234-000010"] {
        assert_eq!(parse_rung_key(other.as_bytes()), None, "{other}");
    }
}

#[test]
fn symbol_groups_are_carried_and_reported() {
    let mut bytes = sample();
    let at = bytes.len() - 2;
    bytes[at] = 2;
    bytes.extend(b"\x05GROUP\x01\x02");
    let parsed = parse::<Database>(&bytes, "S", Mode::Permissive);
    assert_eq!(parsed.error, None);
    assert_eq!(parsed.deviations.len(), 1);
    assert_eq!(parsed.understood, at + 2);
    assert_eq!(serialize(&parsed.value), Ok(bytes.clone()));
    assert!(parse::<Database>(&bytes, "S", Mode::Strict).error.is_some());
}

#[test]
fn every_truncation_is_located_and_keeps_what_was_complete() {
    let bytes = sample();
    for end in 0..bytes.len() {
        let parsed = parse::<Database>(&bytes[..end], "S", Mode::Permissive);
        let error = parsed.error.expect("a truncated stream is an error");
        let place = error.deviation().expect("located").offset;
        assert!(place <= end, "{end}: {error}");
        assert!(parsed.understood <= end);
    }
}

fn text() -> impl Strategy<Value = Text<'static>> {
    proptest::collection::vec(any::<u8>(), 0..300).prop_map(|bytes| Text::from_bytes(&bytes).into_owned())
}

fn entry() -> impl Strategy<Value = Entry<'static>> {
    (any::<(u32, u32, u32, u32, u32)>(), proptest::array::uniform5(text()), proptest::array::uniform6(text())).prop_map(
        |(numbers, lines, others)| {
            let [key, symbol, a, b, c, mnemonic] = others;
            Entry {
                id: numbers.0,
                field_1: numbers.1,
                field_2: numbers.2,
                key,
                symbol,
                lines,
                fields_10_to_12: [a, b, c],
                mnemonic,
                address_id: numbers.3,
                field_15: numbers.4,
            }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn what_is_written_reads_back(
        message in text(),
        addresses in proptest::collection::vec(entry(), 0..4),
        instruction_comments in proptest::collection::vec(entry(), 0..3),
        mnemonics in proptest::collection::vec((text(), proptest::collection::vec(any::<(u32, u32)>(), 0..4)), 0..3),
        comments in proptest::collection::vec((any::<u32>(), text(), text(), text()), 0..4),
    ) {
        let database = Database {
            header: Header { message, ..Header::default() },
            addresses,
            instruction_comments,
            mnemonics: mnemonics
                .into_iter()
                .map(|(mnemonic, uses)| Mnemonic { mnemonic, uses })
                .collect(),
            comments: comments
                .into_iter()
                .map(|(id, text, title, key)| Comment { id, text, title, key })
                .collect(),
            group_count: 0,
            groups: &[],
        };
        let bytes = serialize(&database).expect("short texts can be stored");
        let parsed = parse::<Database>(&bytes, "S", Mode::Strict);
        prop_assert_eq!(parsed.error, None);
        prop_assert_eq!(parsed.understood, bytes.len());
        prop_assert_eq!(parsed.value, database);
    }

    #[test]
    fn no_bytes_bring_it_down(bytes in proptest::collection::vec(any::<u8>(), 0..400), cut in 0usize..200) {
        let mut stream = sample();
        stream.truncate(cut);
        stream.extend(bytes);
        let parsed = parse::<Database>(&stream, "S", Mode::Permissive);
        prop_assert!(parsed.understood <= stream.len());
    }
}
