//! Tests of the program records, with bytes laid out by hand after a real project.

use super::*;
use crate::archive::{MAX_DEPTH, parse, serialize};
use crate::error::{Error, Mode};

const STREAM: &str = "PROGRAM FILES/ObjectData";

/// Class numbers of the payloads below: file 3, rung, leg, instruction, branch as they first appear.
const RUNG: &[u8] = b"\xFF\xFF\x80\0\x05\0CRung";
const LEG: &[u8] = b"\xFF\xFF\x80\0\x0A\0CBranchLeg";
const INS: &[u8] = b"\xFF\xFF\x80\0\x04\0CIns";
const BRANCH: &[u8] = b"\xFF\xFF\x80\0\x07\0CBranch";

/// A mark or instruction without operands and code.
fn plain(opcode: u8) -> Vec<u8> {
    vec![0, 0, 0, 0, opcode, 0, 0, 0, 0, 0]
}

/// An instruction with one operand and its code.
fn with_bit(operand: &str, code: &[u8]) -> Vec<u8> {
    let length = u8::try_from(operand.len()).expect("short");
    let head = [&[1, 0, length][..], operand.as_bytes(), &[1, 0, code[0], 0, 0, 0, 0, 0]].concat();
    [&head[..], &[u8::try_from(code.len()).expect("short"), 0], code].concat()
}

/// A motor seal-in: `[XIC I:0.0/0 , XIC B3:0/0] XIO I:0.0/1 OTE B3:0/0` and an end rung in file 2.
fn seal_in() -> Vec<u8> {
    let ins = b"\x0B\x80".as_slice();
    let parts: Vec<Vec<u8>> = vec![
        b"\xFF\xFF\x80\0\x0B\0CProgHolder\x03\0".to_vec(),
        b"\xFF\xFF\x80\0\x08\0CLadFile".to_vec(),
        [&[0, 0, 0, 0][..], &[0; 10], &[0, 0], &[0], &[0, 0]].concat(),
        b"\x03\x80".to_vec(),
        [&[0, 0, 2, 0][..], &[0; 10], &[1, 0], &[0], &[0, 0]].concat(),
        b"\x03\x80".to_vec(),
        [&[2, 0, 1, 0][..], b"MAIN\0\0\0\0\0\0", &[2, 0], b"\x05motor", &[2, 0]].concat(),
        [RUNG, LEG, &[5, 0], INS, &plain(0)].concat(),
        [BRANCH, &[4, 0], ins, &plain(2)].concat(),
        [b"\x09\x80\x03\0", ins, &plain(4), ins].concat(),
        with_bit("I:0.0/0", &[0x39, 0x1F, 0x08, 0x01, 0x00, 0x01, 0x00]),
        [ins, &plain(5), b"\x09\x80\x03\0", ins, &plain(4), ins].concat(),
        with_bit("B3:0/0", &[0x39, 0x17, 0x08, 0x03, 0x00, 0x03, 0x00]),
        [ins, &plain(5), ins, &plain(3), ins].concat(),
        with_bit("I:0.0/1", &[0x3A, 0x1F, 0x08, 0x11, 0x00, 0x01, 0x00]),
        [ins, &with_bit("B3:0/0", &[0x2F, 0x17, 0x08, 0x03, 0x00, 0x03, 0x00])].concat(),
        [ins, &plain(1), &[0, 0, 0, 0, 1, 0, 0, 0, 83, 0, 0, 0]].concat(),
        [b"\x07\x80\x09\x80\x03\0", ins, &plain(0), ins, &[0, 0, 1, 0, 0x0C, 0, 0, 0, 0, 0, 1, 0, 0x0C]].concat(),
        [ins, &plain(1), &[0; 12]].concat(),
    ];
    parts.concat()
}

#[test]
fn a_seal_in_reads_to_its_last_field() {
    let payload = seal_in();
    let parsed = parse::<ProgramFiles>(&payload, STREAM, Mode::Strict);
    assert_eq!(parsed.error, None);
    assert_eq!(parsed.understood, payload.len());
    let files = &parsed.value.files;
    assert_eq!(
        files.iter().map(|f| (f.number, f.flags, f.rungs.len())).collect::<Vec<_>>(),
        [(0, 0, 0), (1, 2, 0), (2, 1, 2)]
    );
    assert_eq!((files[2].name().as_ref(), files[2].description.to_string()), ("MAIN", "motor".to_owned()));
    let rung = &files[2].rungs[0];
    assert_eq!((rung.unknown_0, rung.edited, rung.comment_id), (0, 1, 83));
    let mut text = Vec::new();
    rung.for_each_instruction(|i| {
        text.push(format!("{:x} {}", i.opcode, i.operands.first().map(ToString::to_string).unwrap_or_default()));
    });
    assert_eq!(
        text,
        ["0 ", "2 ", "4 ", "39 I:0.0/0", "5 ", "4 ", "39 B3:0/0", "5 ", "3 ", "3a I:0.0/1", "2f B3:0/0", "1 "]
    );
    let Item::Branch(branch) = &rung.leg.items[1] else { panic!("{:?}", rung.leg.items[1]) };
    assert_eq!(branch.items.len(), 4);
    assert_eq!(serialize(&parsed.value), Ok(payload));
}

#[test]
fn what_precedes_an_error_stays() {
    let payload = seal_in();
    let end_rung = payload.len() - (2 + 2 + 2 + 12 + 15 + 12 + 12);
    let mut broken = payload.clone();
    // The class tag of the last rung's leg.
    broken[end_rung + 2] = 0x0A;
    let parsed = parse::<ProgramFiles>(&broken, STREAM, Mode::Permissive);
    assert_eq!(parsed.value.files.len(), 3);
    assert_eq!(parsed.value.files[2].rungs.len(), 1);
    assert_eq!(parsed.understood, end_rung);
    let Some(Error::Record(d)) = parsed.error else { panic!("{:?}", parsed.error) };
    assert_eq!((d.record.as_str(), d.offset), ("file 2 > rung 1", end_rung + 2));
    assert_eq!(d.found, "class number 10");
}

#[test]
fn broken_shapes_are_reported_and_kept() {
    let mut payload = seal_in();
    // The end mark of the first leg becomes an instruction.
    let at = payload.windows(10).position(|w| w == plain(5)).expect("there");
    payload[at + 4] = 9;
    let parsed = parse::<ProgramFiles>(&payload, STREAM, Mode::Permissive);
    assert_eq!((parsed.error.clone(), parsed.deviations.len()), (None, 1));
    assert_eq!(
        parsed.deviations[0].to_string(),
        format!(
            "{STREAM}, inflated offset {:#x}, in file 2 > rung 0 > branch 1 > leg 1: expected a leg between its marks 4 and 5, \
             found instruction 0x4, instruction 0x39, instruction 0x9",
            // The list begins before its start mark: count, class tag, mark.
            payload.windows(10).position(|w| w == plain(4)).expect("there") - 4
        )
    );
    assert_eq!(serialize(&parsed.value), Ok(payload.clone()));
    assert!(parse::<ProgramFiles>(&payload, STREAM, Mode::Strict).error.is_some());
}

/// The seal-in with the bytes of `record` put behind the code of its XIO, whose opcode becomes `opcode`.
fn with_record(opcode: u8, compiled: bool, record: &[u8]) -> Vec<u8> {
    let mut payload = seal_in();
    let code = [0x3A, 0x1F, 0x08, 0x11, 0x00, 0x01, 0x00];
    let at = payload.windows(code.len()).position(|w| w == code).expect("there");
    payload.splice(at + code.len()..at + code.len(), record.iter().copied());
    payload[at] = opcode;
    payload[at - 8] = opcode;
    if !compiled {
        payload[at - 10] = 0;
        payload.drain(at - 2..at + code.len());
    }
    payload
}

/// A set-up record as a real project holds it, without its CIP tail.
fn modbus() -> Vec<u8> {
    let parts: &[&[u8]] = &[
        &[0, 0, 0, 0, 0, 0, 0x84, 0, 0, 0, 0, 0],
        b"\x2203 Read Holding Registers (4xxxxx)\0\0\x010\x017",
        b"\0\0\0\0\x0516386\x06N211:0\0\0\0\0\x010\x012\x010\x06CLIENT\x010\x010\0\x14\0\0\0\0\0\x01?",
    ];
    parts.concat()
}

fn cip() -> Vec<u8> {
    let parts: &[&[u8]] = &[
        &[1, 0, 0, 0, 0, 0, 0xC0, 0, 0, 0, 0, 0],
        b"\x0BCIP Generic\x01\0\x0233\x010",
        b"\0\0\0\0\x01?\x010\0\0\0\0\x010\x010\x010\x10172.16.14.73:502\x010\x010\0\x1E\0\0\0\x01\0",
        b"\xFF\xFF\x80\0\x0B\0CASAPathHop\x04\0\0\0\x0C172.16.14.73\x01\0\0\0\0\0\0\0\0\0\0\0",
        b"\x07RIX80:0\x01\0\0\0\x0210\x014\x03150\x013\x014\x0296\x013\x03252\x05N64:0\x03\0\0\0abc",
    ];
    parts.concat()
}

#[test]
fn set_up_records_are_told_by_what_follows() {
    let cases: [(u8, bool, Vec<u8>, usize); 8] = [
        (0x9C, true, modbus(), 0),
        (0xB6, true, cip(), 0),
        (0x9C, false, modbus(), 1), // never seen without code: reported
        (0xB3, true, modbus(), 1),
        (0xB6, true, modbus(), 1), // an unusual form
        (0x9C, true, Vec::new(), 1),
        (0x9C, false, Vec::new(), 0),
        (0xB3, true, Vec::new(), 0),
    ];
    for (opcode, compiled, record, deviations) in cases {
        let payload = with_record(opcode, compiled, &record);
        let parsed = parse::<ProgramFiles>(&payload, STREAM, Mode::Permissive);
        assert_eq!(parsed.error, None, "{opcode:x} {compiled} {}", record.len());
        assert_eq!(parsed.deviations.len(), deviations, "{opcode:x}: {:?}", parsed.deviations);
        let Item::Instruction(i) = &parsed.value.files[2].rungs[0].leg.items[2] else { panic!() };
        assert_eq!(i.message.is_some(), !record.is_empty());
        assert_eq!(serialize(&parsed.value), Ok(payload));
    }
}

#[test]
fn the_fields_of_a_set_up_record() {
    let payload = with_record(0xB6, true, &cip());
    let parsed = parse::<ProgramFiles>(&payload, STREAM, Mode::Strict);
    let Item::Instruction(Instruction { message: Some(m), .. }) = &parsed.value.files[2].rungs[0].leg.items[2] else {
        panic!("{:?}", parsed.error)
    };
    assert_eq!((m.command.to_string(), m.channel, m.timeout.to_string()), ("CIP Generic".into(), 1, "33".into()));
    assert_eq!((m.status, m.routing.to_string()), (0xC0, "RIX80:0".into()));
    assert_eq!(m.hops[0].address, "172.16.14.73");
    let tail = m.cip.as_ref().expect("has one");
    assert_eq!(
        (tail.service.to_string(), tail.data.to_string(), &tail.blob[..]),
        ("10".into(), "N64:0".into(), &b"abc"[..])
    );
    assert_eq!(tail.path_hex[1], "96");
}

#[test]
fn a_deep_nest_is_an_error_with_a_place() {
    let mut payload = [
        b"\xFF\xFF\x80\0\x0B\0CProgHolder\x01\0",
        &b"\xFF\xFF\x80\0\x08\0CLadFile\x01\0\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x01\0"[..],
        RUNG,
        LEG,
        &[1, 0],
        BRANCH,
        &[1, 0],
    ]
    .concat();
    // Leg 7, branch 9: file 3, rung 5, leg 7, branch 9.
    for _ in 0..100_000 {
        payload.extend_from_slice(b"\x07\x80\x01\0\x09\x80\x01\0");
    }
    let parsed = parse::<ProgramFiles>(&payload, STREAM, Mode::Permissive);
    let Some(Error::Record(d)) = parsed.error else { panic!("{:?}", parsed.error) };
    assert!(d.expected.contains(&MAX_DEPTH.to_string()), "{d}");
    assert!(d.record.starts_with("file 0 > rung 0 > branch 0 > leg 0"), "{d}");
    assert!(d.record.len() < 300);
}

#[test]
fn nulls_by_the_million_stay_within_bounds() {
    let mut payload = [
        b"\xFF\xFF\x80\0\x0B\0CProgHolder\x01\0",
        &b"\xFF\xFF\x80\0\x08\0CLadFile\x01\0\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x01\0"[..],
        RUNG,
        LEG,
        b"\xFF\xFF\x80\x84\x1E\0", // 2,000,000 items
    ]
    .concat();
    payload.resize(payload.len() + 5_000_000, 0);
    let parsed = parse::<ProgramFiles>(&payload, STREAM, Mode::Permissive);
    assert!(parsed.error.is_some());
    assert!(size_of::<Item>() <= 128, "{}", size_of::<Item>());
}
