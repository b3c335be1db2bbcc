//! Tests of the data file records, with bytes laid out by hand after a real project.

use super::*;
use crate::archive::{parse, serialize};
use crate::error::Mode;
use proptest::prelude::*;

const STREAM: &str = "DATA FILES/ObjectData";

/// Outputs (4 words, word 1 forced), timers (2), no function file, M0 and M1.
fn payload(extended: bool) -> Vec<u8> {
    let tail: &[u8] = if extended { &[2, 0, 0, 0, 0, 1] } else { &[] };
    let between: &[u8] = if extended { &[0; 4] } else { &[] };
    let parts: &[&[u8]] = &[
        b"\xFF\xFF\x80\0\x0B\0CDataHolder\x02\0",
        b"\xFF\xFF\x80\0\x09\0CDataFile\0\0\0\0\0\0\0\0\x04\0\x01\0\0\0\xFF\xFF",
        &[0; 8],
        b"\0\0\xFF\xFF\x08\0\xFB\xFF\0\0\xFF\xFF\0\0\xFF\xFF",
        b"\0\0\0\x06OUTPUT\0\0\0\0",
        tail,
        b"\x03\x80\x04\0\0\0\0\0\0\0\x02\0\x03\0\0\0\xFF\xFF",
        b"\0\x01\xA0\x0F\0\0\0\x01\xD0\x07\0\0",
        b"\x04\0\0\x05TIMER\0\0\0\0",
        tail,
        between,
        b"\0\0\x02\0",
        b"\xFF\xFF\x80\0\x0D\0CSlcMDataFile\x0D\0\0\0\0\0\0\0\0\0\x01\0\0\0\xFF\xFF\0\0\0\x02M0\0\0\0\0",
        tail,
        b"\x06\x80\x0C\0\0\0\0\0\0\0\0\0\x01\0\0\0\xFF\xFF\x01\0\0\x02M1\0\0\0\0",
        tail,
    ];
    parts.concat()
}

#[test]
fn files_read_to_their_last_field() {
    let bytes = payload(false);
    let parsed = parse::<DataFiles>(&bytes, STREAM, Mode::Strict);
    assert_eq!((parsed.error, parsed.understood), (None, bytes.len()));
    let holder = &parsed.value.0;
    let [outputs, timers] = &holder.user[..] else { panic!() };
    assert_eq!((outputs.type_code, outputs.elements, outputs.name.to_string()), (FileTypeCode(0), 4, "OUTPUT".into()));
    assert_eq!(outputs.force(0), Some((0, 0xFFFF)));
    assert_eq!(outputs.force(1), Some((0x0008, 0xFFFB)));
    assert_eq!(outputs.force(4), None);
    assert_eq!(timers.data.iter().collect::<Vec<_>>(), [0x0100, 4000, 0, 0x0100, 2000, 0]);
    assert_eq!((timers.number, timers.force(0)), (4, None));
    assert_eq!(holder.m.iter().map(|f| f.name.to_string()).collect::<Vec<_>>(), ["M0", "M1"]);
    assert_eq!(serialize(&parsed.value), Ok(bytes));
}

#[test]
fn the_extensional_twin_has_tails() {
    let bytes = payload(true);
    let parsed = parse::<ExtensionalDataFiles>(&bytes, STREAM, Mode::Strict);
    assert_eq!((parsed.error, parsed.understood), (None, bytes.len()));
    assert_eq!(parsed.value.0.user[1].extension, Some(Extension { x0: 2, x1: [0, 0, 0, 1] }));
    assert_eq!(serialize(&parsed.value), Ok(bytes));
}

#[test]
fn a_size_beyond_the_stream_is_located_and_keeps_what_came_before() {
    let mut bytes = payload(false);
    let at = bytes.windows(4).position(|w| w == [2, 0, 3, 0]).expect("the timer file");
    bytes[at..at + 4].fill(0xFF);
    let parsed = parse::<DataFiles>(&bytes, STREAM, Mode::Permissive);
    assert_eq!(parsed.value.0.user.len(), 1);
    let error = parsed.error.expect("must fail").to_string();
    assert!(error.contains("in data file 1: expected data words (8589672450 bytes)"), "{error}");
}

#[test]
fn sizes_that_disagree_are_not_written() {
    let file = DataFile { elements: 2, words: 1, data: [5].into_iter().collect(), ..DataFile::default() };
    let holder = DataHolder { user: vec![file], ..DataHolder::default() };
    assert!(serialize(&DataFiles(holder)).is_err());
}

#[test]
fn a_word_can_be_set() {
    let bytes = payload(false);
    let mut files = parse::<DataFiles>(&bytes, STREAM, Mode::Strict).value;
    assert!(files.0.user[1].data.set(1, 9));
    assert!(!files.0.user[1].data.set(6, 9));
    let again = serialize(&files).expect("writes");
    let at = bytes.windows(2).position(|w| w == [0xA0, 0x0F]).expect("the preset");
    assert_eq!((&again[at..at + 2], again.len()), (&[9, 0][..], bytes.len()));
}

proptest! {
    #[test]
    fn what_is_written_reads_back_equal(
        files in proptest::collection::vec((0..50_u16, 0..40_u16, 0..4_u16, "[A-Z0-9_]{0,10}", "[ -~]{0,300}"), 0..12),
        extended: bool,
    ) {
        let user: Vec<DataFile<'static>> = files.iter().enumerate().map(|(i, (ty, elements, words, name, text))| {
            let type_code = FileTypeCode(*ty);
            let count = usize::from(*elements) * usize::from(*words);
            DataFile {
                type_code,
                elements: *elements,
                words: *words,
                data: (0..count).map(|w| (w * 7919) as u16).collect(),
                forces: if type_code.has_forces() { (0..*elements * 2).collect() } else { Words::default() },
                number: i as u16,
                name: Text::new(name).expect("ASCII").into_owned(),
                description: Text::new(text).expect("ASCII").into_owned(),
                extension: extended.then(Extension::default),
                ..DataFile::default()
            }
        }).collect();
        let holder = DataHolder { user, between: extended.then_some(0), ..DataHolder::default() };
        if extended {
            let record = ExtensionalDataFiles(holder);
            let bytes = serialize(&record).expect("writes");
            prop_assert_eq!(parse::<ExtensionalDataFiles>(&bytes, STREAM, Mode::Strict).into_result(), Ok(record));
        } else {
            let record = DataFiles(holder);
            let bytes = serialize(&record).expect("writes");
            prop_assert_eq!(parse::<DataFiles>(&bytes, STREAM, Mode::Strict).into_result(), Ok(record));
        }
    }
}
