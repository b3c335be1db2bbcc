//! Every real file: each stream accounted for byte by byte, written back identically, and the whole file written anew.

mod common;

use rss::code::Code;
use rss::program::{Item, Leg, ProgramFiles, mark};
use rss::verify::verify;
use rss::{Error, Foreign, ImageKind, Mode, Project, StreamKind, parse};
use std::collections::BTreeMap;
use std::path::Path;

/// Streams whose every byte belongs to a field of a record.
const UNDERSTOOD: [StreamKind; 4] =
    [StreamKind::ProgramFiles, StreamKind::DataFiles, StreamKind::ExtensionalDataFiles, StreamKind::MemDatabase];

fn read(path: &Path) -> Result<Project, Error> {
    let bytes = std::fs::read(path).expect("a corpus file can be read");
    // Strict: the envelopes of real files are without fault.
    Project::read(&bytes, Mode::Strict)
}

#[test]
fn every_byte_is_accounted_for_and_comes_back() {
    let Some(files) = common::corpus() else { return };
    let (mut read_files, mut foreign) = (0, Vec::new());
    let mut totals: BTreeMap<&str, [usize; 3]> = BTreeMap::new();
    for path in &files {
        let name = path.display();
        let project = match read(path) {
            Ok(project) => project,
            Err(Error::Foreign(kind)) => {
                foreign.push(kind);
                continue;
            }
            Err(error) => panic!("{name}: {error}"),
        };
        read_files += 1;
        let account = verify(&project);
        assert!(account.roundtrip, "{name}: does not come back");
        for s in &account.streams {
            assert_eq!(s.error, None, "{name}");
            assert_eq!(s.deviations, [], "{name}");
            assert!(s.identical, "{name}: {}", s.stream);
            if UNDERSTOOD.contains(&s.kind) {
                assert_eq!(s.understood, s.bytes, "{name}: {}", s.stream);
            }
            let total = totals.entry(s.kind.name()).or_default();
            *total = [total[0] + 1, total[1] + s.bytes, total[2] + s.understood];
        }
    }
    println!("{read_files} of {} files read; others: {foreign:?}", files.len());
    for (name, [streams, bytes, understood]) in &totals {
        println!("{name:30} {streams:5} streams {bytes:10} bytes {understood:10} understood");
    }
    assert!(foreign.iter().all(|kind| matches!(kind, Foreign::Pdf | Foreign::CompoundWithoutStreams)), "{foreign:?}");
    assert!(read_files > 0, "a corpus folder without a single project");
}

/// All compiled code is made of operands of the known forms, and encodes back to the same bytes.
#[test]
fn all_compiled_code_decodes_and_encodes_back() {
    let Some(files) = common::corpus() else { return };
    let mut decoded = 0;
    for path in &files {
        let Ok(project) = read(path) else { continue };
        for image in ImageKind::ALL {
            let Some(stream) = project.stream(image, StreamKind::ProgramFiles) else { continue };
            let program = parse::<ProgramFiles>(stream.payload(), stream.path(), Mode::Strict);
            for rung in program.value.files.iter().flat_map(|f| &f.rungs) {
                rung.for_each_instruction(|i| {
                    if i.has_code == 0 {
                        return;
                    }
                    let code =
                        Code::decode(&i.code).unwrap_or_else(|e| panic!("{}: {e}: {:02x?}", path.display(), i.code));
                    assert_eq!(code.encode().as_deref(), Ok(&*i.code), "{}", path.display());
                    decoded += 1;
                });
            }
        }
    }
    println!("{decoded} instructions");
}

/// Counts published for the largest project, taken from its printout and by hand.
#[test]
fn the_largest_project_has_its_known_counts() {
    let Some(files) = common::corpus() else { return };
    let Some(path) = files.iter().find(|p| p.file_name().is_some_and(|n| n == "LANLOGIX_BR.RSS")) else {
        println!("skipped: LANLOGIX_BR.RSS not present");
        return;
    };
    let project = read(path).expect("reads");
    for image in [ImageKind::Main, ImageKind::Online] {
        let stream = project.stream(image, StreamKind::ProgramFiles).expect("has a program");
        assert_eq!(stream.payload().len(), 569_038);
        let program = parse::<ProgramFiles>(stream.payload(), stream.path(), Mode::Strict).value;
        let with_rungs: Vec<u16> = program.files.iter().filter(|f| !f.rungs.is_empty()).map(|f| f.number).collect();
        let known = [
            (2..=2).collect::<Vec<u16>>(),
            (4..=17).collect(),
            vec![19],
            (27..=33).collect(),
            vec![41, 42, 43, 45, 49, 50, 52, 98, 99, 100, 101, 115, 116, 117, 214, 250, 251, 255],
        ]
        .concat();
        assert_eq!(with_rungs, known);
        assert_eq!(program.files.len(), 256);
        assert_eq!(program.files.iter().map(|f| f.rungs.len()).sum::<usize>(), 1016);
        let mut by_opcode: BTreeMap<u16, usize> = BTreeMap::new();
        let (mut branches, mut legs) = (0, 0);
        for rung in program.files.iter().flat_map(|f| &f.rungs) {
            rung.for_each_instruction(|i| *by_opcode.entry(i.opcode).or_default() += 1);
            count(&rung.leg, &mut branches, &mut legs);
        }
        assert_eq!((branches, legs), (1550, 4498));
        let instructions: usize = by_opcode.iter().filter(|(op, _)| **op > mark::LEG_END).map(|(_, n)| n).sum();
        assert_eq!(instructions, 8519);
        // Contacts, coils, moves and the end marks, by the codes whose symbols are drawn on the printout.
        for (opcode, n) in [(0x39, 2977), (0x3A, 1244), (0x2F, 901), (0x1C, 951), (0x0C, 41), (0x15, 38), (0x9C, 3)] {
            assert_eq!(by_opcode.get(&opcode), Some(&n), "opcode {opcode:#x}");
        }
    }
}

fn count(leg: &Leg<'_>, branches: &mut usize, legs: &mut usize) {
    for item in &leg.items {
        if let Item::Branch(branch) = item {
            *branches += 1;
            for item in &branch.items {
                if let Item::Leg(leg) = item {
                    *legs += 1;
                    count(leg, branches, legs);
                }
            }
        }
    }
}
