//! Damaged and hostile input: always an error with a place or a partial read with deviations, never a panic,
//! within a second and within bounds. All inputs are made by the crate's own writer.

use rss::channel::ChannelConfiguration;
use rss::data::{DataFile, DataFiles, DataHolder, ExtensionalDataFiles, FileTypeCode};
use rss::io::{IoConfiguration, IoLayout, PackedIo};
use rss::processor::Model;
use rss::program::{Branch, Instruction, Item, LadFile, Leg, ProgramFiles, Rung, mark};
use rss::verify::verify;
use rss::{Container, Error, Foreign, ImageKind, Mode, Project, StreamKind, Text, envelope, parse, serialize, small};
use std::borrow::Cow;
use std::time::{Duration, Instant};

const LIMIT: Duration = Duration::from_secs(1);

fn instruction(opcode: u16, operands: &[&'static str], code: &'static [u8]) -> Item<'static> {
    Item::Instruction(Instruction {
        operands: operands.iter().map(|o| Text::new(o).expect("ASCII")).collect(),
        has_code: u16::from(!code.is_empty()),
        opcode,
        code: Cow::Borrowed(code),
        ..Instruction::default()
    })
}

fn program() -> ProgramFiles<'static> {
    let bare = |opcode| instruction(opcode, &[], &[]);
    let contact = || instruction(0x39, &["B3:0/15"], &[0x39, 0x17, 0x08, 0xF3, 0x00, 0x03, 0x00]);
    let timer = || instruction(0x0F, &["T4:0", "0.01", "100", "0"], &[0x0F, 0x07, 0x08, 0x04, 0x00, 0x04, 0x00]);
    let leg = || Item::Leg(Leg { items: vec![bare(mark::LEG_START), contact(), bare(mark::LEG_END)] });
    let branch =
        || Item::Branch(Branch { items: vec![bare(mark::BRANCH_START), leg(), leg(), bare(mark::BRANCH_END)] });
    let rung = |id| Rung {
        leg: Leg { items: vec![bare(mark::RUNG_START), branch(), contact(), timer(), bare(mark::RUNG_END)] },
        comment_id: id,
        ..Rung::default()
    };
    let file = |number: u16| {
        let rungs: Vec<_> = if number < 2 { Vec::new() } else { (0..12).map(rung).collect() };
        LadFile {
            rung_count: u16::try_from(rungs.len()).expect("few"),
            flags: u16::from(number >= 2),
            number,
            description: Text::new("a description").expect("ASCII"),
            rungs,
            ..LadFile::default()
        }
    };
    ProgramFiles { files: (0..8).map(file).collect() }
}

fn data() -> DataHolder<'static> {
    let file = |number: u16| DataFile {
        type_code: FileTypeCode(number),
        elements: 200,
        words: 1,
        data: (0..200).collect(),
        forces: if number < 2 {
            (0..400).map(|i| if i % 2 == 0 { 0 } else { 0xFFFF }).collect()
        } else {
            Default::default()
        },
        number,
        name: Text::new("NAME").expect("ASCII"),
        ..DataFile::default()
    };
    DataHolder { user: (0..9).map(file).collect(), ..DataHolder::default() }
}

/// A MicroLogix 1100 without modules.
fn io() -> IoConfiguration<'static> {
    let onboard = PackedIo { slot_count: 1, offset: 4, ..PackedIo::default() };
    IoConfiguration { model: Model(61), layout: IoLayout::Packed(onboard) }
}

fn channels() -> ChannelConfiguration<'static> {
    ChannelConfiguration { model: Model(61), tail: &[0; 11], ..ChannelConfiguration::default() }
}

/// The payloads that make up the sample, and the whole of it as a file.
fn payloads() -> Vec<(StreamKind, Vec<u8>)> {
    let mut all = vec![
        (StreamKind::ProgramFiles, serialize(&program()).expect("writes")),
        (StreamKind::DataFiles, serialize(&DataFiles(data())).expect("writes")),
        (StreamKind::ExtensionalDataFiles, serialize(&ExtensionalDataFiles(data())).expect("writes")),
        (StreamKind::Processor, serialize(&rss::processor::Processor::default()).expect("writes")),
        (StreamKind::MemDatabase, serialize(&rss::database::Database::default()).expect("writes")),
        (StreamKind::IoConfiguration, serialize(&io()).expect("writes")),
        (StreamKind::ChannelConfiguration, serialize(&channels()).expect("writes")),
        (StreamKind::Compiler, serialize(&rss::compiler::Compiler::default()).expect("writes")),
        (StreamKind::Contents, small::CONTENTS.to_vec()),
    ];
    all.extend(small::CONSTANTS.iter().map(|constant| (constant.kind, constant.payload())));
    all
}

fn sample() -> Vec<u8> {
    let mut project = Project::new();
    for image in [ImageKind::Main, ImageKind::Online] {
        for (kind, payload) in payloads() {
            project.set_payload(image, kind, &payload).expect("sets");
        }
    }
    project.write().expect("writes")
}

/// Reads the file and everything in it. True if something was reported:
/// an error, or a deviation of a project read in part.
fn reports(bytes: &[u8]) -> bool {
    let start = Instant::now();
    let reported = match Project::read(bytes, Mode::Permissive) {
        Ok(project) => {
            let account = verify(&project);
            let in_streams = account.streams.iter().any(|s| s.error.is_some() || !s.deviations.is_empty());
            for s in &account.streams {
                assert!(s.understood <= s.bytes, "{}", s.stream);
                if let Some(error) = &s.error {
                    assert!(error.deviation().is_some(), "{error}: without a place");
                }
            }
            in_streams || project.missing().next().is_some() || project.deviations().next().is_some()
        }
        Err(error) => {
            assert!(error.deviation().is_some() || matches!(error, Error::Foreign(_)), "{error}: without a place");
            true
        }
    };
    assert!(start.elapsed() < LIMIT, "took {:?}", start.elapsed());
    reported
}

/// A fixed sequence of numbers, so that a failure repeats.
fn noise() -> impl FnMut() -> usize {
    let mut state = 0x2545_F491_4F6C_DD1D_u64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        usize::try_from(state >> 1).unwrap_or(0)
    }
}

#[test]
fn the_sample_itself_is_sound() {
    let bytes = sample();
    assert!(!reports(&bytes));
    let account = verify(&Project::read(&bytes, Mode::Strict).expect("reads"));
    for s in &account.streams {
        assert_eq!((s.error.clone(), s.understood, s.identical), (None, s.bytes, true), "{}", s.stream);
    }
    assert!(account.roundtrip);
}

#[test]
fn truncated_at_every_kilobyte_and_at_odd_places() {
    let bytes = sample();
    let places = (0..bytes.len()).step_by(1024).chain((0..bytes.len()).step_by(997)).chain(0..600);
    for at in places.filter(|&at| at < bytes.len()) {
        assert!(reports(&bytes[..at]), "cut at {at}");
    }
}

#[test]
fn one_bit_flipped_in_the_file() {
    let bytes = sample();
    let mut next = noise();
    for _ in 0..2000 {
        let mut broken = bytes.clone();
        broken[next() % bytes.len()] ^= 1 << (next() % 8);
        reports(&broken);
    }
}

#[test]
fn one_bit_flipped_in_each_payload() {
    let mut next = noise();
    for (kind, payload) in payloads() {
        for _ in 0..2000 {
            let mut broken = payload.clone();
            broken[next() % payload.len()] ^= 1 << (next() % 8);
            let mut project = Project::new();
            project.set_payload(ImageKind::Main, kind, &broken).expect("sets");
            for s in verify(&project).streams {
                // Read without a complaint means read right: it comes back.
                assert!(s.identical || s.error.is_some() || !s.deviations.is_empty(), "{}: {broken:02x?}", s.stream);
            }
        }
    }
}

#[test]
fn payloads_truncated_everywhere() {
    for (kind, payload) in payloads() {
        if kind == StreamKind::Contents || small::constant(kind).is_some() {
            continue;
        }
        for at in (0..payload.len()).step_by(1 + payload.len() / 2000) {
            let mut project = Project::new();
            project.set_payload(ImageKind::Main, kind, &payload[..at]).expect("sets");
            for s in verify(&project).streams {
                assert!(s.understood <= at);
                assert!(s.error.is_some() || !s.deviations.is_empty(), "{} cut at {at}", s.stream);
            }
        }
    }
}

#[test]
fn lengths_set_to_their_maximum() {
    for (kind, payload) in payloads() {
        // Every place in a small payload; in a large one, records repeat.
        for at in (0..payload.len()).step_by(1 + payload.len() / 250) {
            for width in [1, 2, 4, 8] {
                let mut broken = payload.clone();
                let end = (at + width).min(broken.len());
                broken[at..end].fill(0xFF);
                let mut project = Project::new();
                project.set_payload(ImageKind::Main, kind, &broken).expect("sets");
                let start = Instant::now();
                let _ = verify(&project);
                assert!(start.elapsed() < LIMIT, "{kind:?} at {at}");
            }
        }
    }
    let file = sample();
    for at in (0..2048.min(file.len() - 4)).chain((2048..file.len() - 4).step_by(97)) {
        let mut broken = file.clone();
        broken[at..at + 4].fill(0xFF);
        reports(&broken);
        broken[at..at + 4].copy_from_slice(&0x7FFF_FFFF_u32.to_le_bytes());
        reports(&broken);
    }
}

/// The sample as a compound file with one stream's stored bytes replaced.
fn with_stored(kind: StreamKind, stored: Vec<u8>) -> Vec<u8> {
    let mut container = Container::read(&sample()).expect("reads");
    container.set_stream(&kind.path(ImageKind::Main), stored);
    container.write().expect("writes")
}

#[test]
fn zlib_bombs() {
    // 16 MB of zeros in 16 KB; each stream alone claims what all may take together.
    let bomb = envelope::seal(&vec![0; envelope::MAX_PAYLOAD], envelope::Storage::ZLIB).expect("seals");
    let mut container = Container::read(&sample()).expect("reads");
    for image in ImageKind::ALL {
        for &kind in StreamKind::NAMED.iter().filter(|kind| kind.has_envelope()) {
            container.set_stream(&kind.path(image), bomb.clone());
        }
    }
    let bytes = container.write().expect("writes");
    assert!(reports(&bytes));
    // A claim of four gigabytes.
    let mut liar = bomb.clone();
    liar[12..16].fill(0xFF);
    assert!(reports(&with_stored(StreamKind::ProgramFiles, liar)));
    // A claim of nothing.
    let mut modest = bomb;
    modest[12..16].fill(0);
    assert!(reports(&with_stored(StreamKind::ProgramFiles, modest)));
    assert_bounded();
}

#[test]
fn objects_nested_a_hundred_thousand_deep() {
    let mut payload = serialize(&ProgramFiles {
        files: vec![LadFile { rung_count: 1, rungs: vec![Rung::default()], ..LadFile::default() }],
    })
    .expect("writes");
    // The rung's leg is empty: instead of its count, a nest of legs. Class numbers: leg 7.
    payload.truncate(payload.len() - 14);
    payload.extend_from_slice(&[1, 0]);
    payload.extend_from_slice(&b"\x07\x80\x01\0".repeat(100_000));
    let parsed = parse::<ProgramFiles>(&payload, "PROGRAM FILES/ObjectData", Mode::Permissive);
    let error = parsed.error.expect("must fail");
    assert!(error.to_string().contains("nested at most"), "{error}");
    let sealed = envelope::seal(&payload, envelope::Storage::ZLIB).expect("seals");
    assert!(reports(&with_stored(StreamKind::ProgramFiles, sealed)));
}

#[test]
fn payloads_of_one_tiny_thing_repeated() {
    // Whatever is small in the stream and large in memory, as often as a payload can hold it.
    let head = b"\xFF\xFF\x80\0\x0B\0CProgHolder\x01\0\xFF\xFF\x80\0\x08\0CLadFile\x01\0\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x01\0\
        \xFF\xFF\x80\0\x05\0CRung\xFF\xFF\x80\0\x0A\0CBranchLeg\xFF\xFF\xFF\xFF\x10\0\xFF\xFF\x80\0\x04\0CIns";
    let tiny: [&[u8]; 5] = [
        &[0, 0],                                                 // nulls
        &[2, 0],                                                 // references
        &[0x0B, 0x80, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],             // instructions
        &[0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x00, 0, 0],             // counts
        &[0x0B, 0x80, 4, 0, 0, 0, 0, 0, 0, 0, 9, 0, 0, 0, 0, 0], // instructions with four empty operands
    ];
    for one in tiny {
        let mut payload = head.to_vec();
        payload.extend_from_slice(&[0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
        payload.extend_from_slice(&one.repeat((envelope::MAX_PAYLOAD - payload.len()) / one.len()));
        let start = Instant::now();
        let parsed = parse::<ProgramFiles>(&payload, "PROGRAM FILES/ObjectData", Mode::Permissive);
        assert!(parsed.error.is_some());
        drop(parsed);
        assert!(start.elapsed() < LIMIT, "{one:02x?} took {:?}", start.elapsed());
    }
    // One huge file of a data table, and a million data files of no size.
    let mut payload = serialize(&DataFiles(DataHolder::default())).expect("writes");
    payload.truncate(payload.len() - 6);
    payload.extend_from_slice(b"\xFF\xFF\0\0\x08\0\xFF\xFF\x80\0\x09\0CDataFile");
    let file = [&[10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF][..], &[0; 8], &[3, 0x80]].concat();
    payload.extend_from_slice(&file.repeat((envelope::MAX_PAYLOAD - payload.len()) / file.len()));
    let start = Instant::now();
    assert!(parse::<DataFiles>(&payload, "DATA FILES/ObjectData", Mode::Permissive).error.is_some());
    assert!(start.elapsed() < LIMIT, "took {:?}", start.elapsed());
    assert_bounded();
}

#[test]
fn compound_files_with_loops_and_huge_claims() {
    let bytes = sample();
    // Every field of the header and of the first directory and table sectors, set to values that loop or overrun.
    let sector_at = |at: usize| {
        let n = u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"));
        (usize::try_from(n).expect("small") + 1) * 512
    };
    for base in [0, sector_at(48), sector_at(60), sector_at(76)] {
        for at in (base..base + 512).step_by(4) {
            for value in [0, 2, 0x7FFF_FFFF, 0xFFFF_FFFA, 0xFFFF_FFFE] {
                let mut broken = bytes.clone();
                broken[at..at + 4].copy_from_slice(&u32::to_le_bytes(value));
                reports(&broken);
            }
        }
    }
    // As large as a file may be: a sound head, and a directory or table wherever one looks.
    let mut large = bytes.clone();
    while large.len() < rss::container::MAX_FILE {
        large.extend_from_within(..large.len().min(rss::container::MAX_FILE - large.len()));
    }
    reports(&large);
    large.push(0);
    assert!(reports(&large));
    assert_bounded();
}

#[test]
fn storages_nested_deep_and_entries_without_number() {
    let mut container = Container::default();
    container.set_stream(&format!("{}x", "storage/".repeat(300)), vec![1]);
    let error = Container::read(&container.write().expect("writes")).expect_err("must fail");
    assert!(error.to_string().contains("paths of at most"), "{error}");
    let mut container = Container::default();
    for i in 0..=rss::container::MAX_ENTRIES {
        container.set_stream(&format!("s{i}"), Vec::new());
    }
    let error = Container::read(&container.write().expect("writes")).expect_err("must fail");
    assert!(error.to_string().contains("at most 4096 storages"), "{error}");
}

#[test]
fn files_that_are_something_else() {
    let mut empty = Container::default();
    empty.root.state = 1;
    let cases: [(Vec<u8>, Foreign); 5] = [
        (Vec::new(), Foreign::Empty),
        (b"Just a text file, renamed.\r\n".repeat(100), Foreign::Text),
        (b"%PDF-1.7 and so on".to_vec(), Foreign::Pdf),
        (b"PK\x03\x04\x14\0".to_vec(), Foreign::Zip),
        (empty.write().expect("writes"), Foreign::CompoundWithoutStreams),
    ];
    for (bytes, kind) in cases {
        assert_eq!(Project::read(&bytes, Mode::Permissive).err(), Some(Error::Foreign(kind)));
    }
}

/// The whole test process has stayed within the memory that one file may take.
fn assert_bounded() {
    let Ok(status) = std::fs::read_to_string("/proc/self/status") else { return };
    let peak = status.lines().find_map(|l| l.strip_prefix("VmHWM:")).and_then(|l| l.trim().strip_suffix(" kB"));
    if let Some(kilobytes) = peak.and_then(|p| p.trim().parse::<usize>().ok()) {
        // The inputs of the tests themselves are in it too.
        assert!(kilobytes < 256 << 10, "peak memory {} MB", kilobytes / 1024);
    }
}
