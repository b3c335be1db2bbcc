//! Tests of both I/O forms with configurations laid out by hand.

use super::*;
use crate::archive::{parse, serialize};
use crate::error::Mode;

fn stream(model: u16, body: &[u8]) -> Vec<u8> {
    let mut bytes = b"\xFF\xFF\x80\0\x07\0CIOInfo".to_vec();
    bytes.extend(model.to_le_bytes());
    bytes.extend(body);
    bytes
}

fn words(words: &[u16]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// A MicroLogix 1400 with one 16-input module in slot 1.
fn packed() -> Vec<u8> {
    let mut body = vec![2, 0, 0x1211, 0, 0, 8, 0, 0, 6, 0, 0x200, 0, 0, 0, 6, 3, 0x20E, 14, 0xFF];
    body.extend([1, 0, 16, 0, 1, 0, 1, 8, 0, 0, 6, 1, 7, 97, 0, 0, 0]);
    words(&body)
}

/// An SLC 500 fixed with a 16-point output module in slot 2.
fn slots() -> Vec<u8> {
    let mut body = vec![0; 2032];
    body[..6].copy_from_slice(&[3, 0, 2, 0, 21, 0]);
    for slot in 1..31 {
        body[24 * slot + 4..24 * slot + 6].copy_from_slice(&[0xFF, 0xFF]);
    }
    body[48..54].copy_from_slice(&[0, 2, 2, 1, 29, 0]);
    body[744] = 2;
    body[2028..].copy_from_slice(&[5, 5, 5, 0]);
    body
}

#[test]
fn packed_form() {
    let bytes = stream(63, &packed());
    let parsed = parse::<IoConfiguration>(&bytes, "IO CONFIGURATION/ObjectData", Mode::Strict);
    assert_eq!((parsed.error, parsed.understood), (None, bytes.len()));
    let io = parsed.value;
    assert_eq!(io.total_words(), Some((9, 6)));
    let slots = io.slots();
    assert_eq!(slots[0].module, SlotModule::Base(BaseUnit(0x1211)));
    let identity = ModuleIdentity { vendor: 1, device_type: 7, code: 97 };
    assert_eq!(slots[1].module, SlotModule::Identity(identity));
    assert_eq!((slots[1].slot, slots[1].words.first_input), (1, 8));
    assert_eq!(slots[1].words.input_points(), 16);
    assert_eq!(serialize(&io), Ok(bytes));
}

#[test]
fn slot_form() {
    let bytes = stream(8, &slots());
    assert_eq!(bytes.len(), 13 + 2034);
    let parsed = parse::<IoConfiguration>(&bytes, "S", Mode::Strict);
    assert_eq!((parsed.error, parsed.understood), (None, bytes.len()));
    let io = parsed.value;
    assert_eq!(io.total_words(), Some((2, 2)));
    let found: Vec<_> = io.slots().iter().map(|s| (s.slot, s.module)).collect();
    assert_eq!(found, [(0, SlotModule::IdCode(2100)), (2, SlotModule::IdCode(2900))]);
    let base = io.slots()[0].words;
    assert_eq!((base.input_points(), base.output_points()), (24, 16));
    assert_eq!(serialize(&io), Ok(bytes));
}

#[test]
fn an_unknown_model_is_read_in_the_form_that_fits() {
    for body in [packed(), slots()] {
        let bytes = stream(0x123, &body);
        let parsed = parse::<IoConfiguration>(&bytes, "S", Mode::Strict);
        assert_eq!((parsed.error, parsed.understood), (None, bytes.len()));
        assert!(parsed.value.total_words().is_some());
        assert_eq!(serialize(&parsed.value), Ok(bytes));
    }
}

#[test]
fn the_form_of_another_model_is_a_deviation() {
    let bytes = stream(8, &packed());
    let parsed = parse::<IoConfiguration>(&bytes, "S", Mode::Permissive);
    assert_eq!((parsed.error, parsed.deviations.len()), (None, 1));
    assert_eq!(serialize(&parsed.value), Ok(bytes.clone()));
    assert!(parse::<IoConfiguration>(&bytes, "S", Mode::Strict).error.is_some());
}

#[test]
fn a_longer_slot_table_is_read_as_far_as_it_is_known() {
    let bytes = stream(0x31, &[slots(), vec![7; 9]].concat());
    let parsed = parse::<IoConfiguration>(&bytes, "S", Mode::Permissive);
    assert_eq!((parsed.error, parsed.deviations.len()), (None, 1));
    assert_eq!(parsed.understood, bytes.len() - 9);
    assert_eq!(parsed.value.slots().len(), 2);
    assert_eq!(serialize(&parsed.value), Ok(bytes));
}

#[test]
fn slots_that_do_not_fit_together_are_no_slots_of_an_unknown_model() {
    for (model, opaque) in [(8, false), (0x31, true)] {
        let bytes = stream(model, &[9; 2032]);
        let parsed = parse::<IoConfiguration>(&bytes, "S", Mode::Permissive);
        assert_eq!((parsed.error, parsed.deviations.len()), (None, 1));
        assert_eq!(matches!(parsed.value.layout, IoLayout::Opaque(_)), opaque);
        assert_eq!(serialize(&parsed.value), Ok(bytes));
    }
}

#[test]
fn contradictions_are_located() {
    let mut body = packed();
    let slot = body.len() - 26;
    body[slot] = 5;
    let bytes = stream(63, &body);
    let parsed = parse::<IoConfiguration>(&bytes, "S", Mode::Permissive);
    assert_eq!(parsed.error, None);
    let [deviation] = &parsed.deviations[..] else { panic!("one deviation") };
    assert_eq!(deviation.offset, 15 + slot);
    assert_eq!(deviation.record, "slot 1");
    assert_eq!(serialize(&parsed.value), Ok(bytes));
}

#[test]
fn any_other_body_is_carried() {
    for body in [&b"\x01"[..], &packed()[..40], &[0; 2000], &[slots()[1..].to_vec(), vec![0; 9]].concat()] {
        for model in [8, 61, 0x123] {
            let bytes = stream(model, body);
            let parsed = parse::<IoConfiguration>(&bytes, "S", Mode::Permissive);
            assert_eq!((parsed.error, parsed.deviations.len()), (None, 1));
            assert_eq!(parsed.value.layout, IoLayout::Opaque(body));
            assert_eq!(parsed.understood, bytes.len() - body.len());
            assert_eq!(parsed.value.total_words(), None);
            assert_eq!(serialize(&parsed.value), Ok(bytes));
        }
    }
}
