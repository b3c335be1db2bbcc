//! What the cross reference reports as missing, and how a person asks it.

mod support;

use analysis::{CallGraph, Coverage, CrossReference, FindingKind, Found, Note};
use ladder::{Address, AddressEntry, Comment, CommentOwner, Image, Target};
use support::{image, set};

/// Findings as `kind address`, expected ones in parentheses.
fn findings(image: &Image, kind: FindingKind) -> Vec<String> {
    let xref = CrossReference::build(image, &image.documentation);
    let found = xref.findings();
    let of_kind = found.list.iter().filter(|finding| finding.kind == kind);
    of_kind
        .map(|finding| match finding.expected {
            Some(reason) => format!("({}: {})", finding.address, reason.as_str()),
            None => finding.address.to_string(),
        })
        .collect()
}

fn document(image: &mut Image, address: &str, symbol: &str) {
    let target = Target::Address(Address::parse(address).expect(address));
    image.documentation.add(AddressEntry { target, symbol: symbol.into(), description: Vec::new() });
}

#[test]
fn readers_and_writers_count_however_they_reach_the_data() {
    let image = image(&[
        "XIC I:0.0/1; OTE O:0.0/1",
        "XIC B3:0/0; OTE B3:0/1",
        "MOV 5 B3:1",
        "XIC B3:1/3; OTE B3:2/0",
        "FLL 0 #N10:0 10",
        "EQU N10:4 3; OTE B3:2/1",
        "XIC B3:2/0; XIC B3:2/1; OTE B3:3/0",
        "MOV 1 N7:[N7:9]",
        "EQU N7:3 3; OTE B3:4/0",
        "XIC S:1/15; OTE B3:5/0",
        "TON T4:0 1.0 5 0; XIC T4:0/DN",
        "TON T4:1 1.0 5 0",
        "EQU T4:0.PRE 5",
    ]);
    let normal = |text: &str| text.starts_with('(');
    let (expected, plain): (Vec<String>, Vec<String>) =
        findings(&image, FindingKind::ReadNeverWritten).into_iter().partition(|text| normal(text));
    // N7:3 and the pointer N7:9 itself may be written by the indirect move.
    assert_eq!(plain, ["B3:0/0"]);
    assert_eq!(
        expected,
        ["(I:0.0/1: input, written by the input scan)", "(S:1/15: status file)", "(T4:0.PRE: set in the data table)"]
    );
    let (expected, plain): (Vec<String>, Vec<String>) =
        findings(&image, FindingKind::WrittenNeverRead).into_iter().partition(|text| normal(text));
    assert_eq!(plain, ["B3:0/1", "B3:3/0", "B3:4/0", "B3:5/0", "T4:1"]);
    assert_eq!(expected, ["(O:0.0/1: output, read by the output scan)"]);
}

#[test]
fn data_that_is_not_there() {
    let mut image = image(&[
        "XIC B3:31/15; OTE B3:32/0",
        "COP #N7:0 #N10:46 5",
        "MOV N77:0 N7:1",
        "XIC I:3.0/1; OTE O:2.0/4",
        "XIC I:0.1/9",
    ]);
    image.io.slots[0].inputs.bits = 20;
    assert_eq!(findings(&image, FindingKind::BeyondEnd), ["B3:32/0", "N10:46"]);
    assert_eq!(findings(&image, FindingKind::NoSuchFile), ["N77:0"]);
    assert_eq!(findings(&image, FindingKind::NoSuchPoint), ["I:0.1/9", "I:3.0/1"]);
    // Nothing is said about I/O when the modules are not known.
    image.io.unknown = Some("chassis".into());
    assert_eq!(findings(&image, FindingKind::NoSuchPoint), [""; 0]);
}

#[test]
fn documentation_and_its_coverage() {
    let mut image = image(&["XIC T4:0/DN; OTE B3:0/0", "XIC B3:0/1; OTE B3:0/2", "END"]);
    document(&mut image, "T4:0", "CYCLE");
    document(&mut image, "B3:0/1", "START");
    let owner = CommentOwner::Rung { file: 2, rung: 0 };
    image.program_files[0].rungs[0].comment = Some(Comment { text: "cycle\r\n".into(), title: "Part 1".into(), owner });
    assert_eq!(findings(&image, FindingKind::Undocumented), ["B3:0/0", "B3:0/2"]);
    let xref = CrossReference::build(&image, &image.documentation);
    let coverage = Coverage::build(&image, &image.documentation, &xref);
    assert_eq!((coverage.addresses, coverage.with_symbol, coverage.documented), (4, 2, 2));
    assert_eq!((coverage.rungs, coverage.with_comment, coverage.with_title), (2, 1, 1));
}

#[test]
fn a_person_asks_by_address_symbol_file_or_number() {
    let mut image = image(&["XIC B3:0/5; MOV N7:0 B3:0", "OTE B3:1/0; JSR U:2"]);
    document(&mut image, "B3:0", "FLAGS");
    let xref = CrossReference::build(&image, &image.documentation);
    let count = |text: &str| match xref.find(text) {
        Some(Found::Address(group)) => group.accesses.len(),
        _ => 99,
    };
    assert_eq!(count("b3/5"), 2);
    assert_eq!(count("FLAGS/5"), 2);
    assert_eq!(count("flags/6"), 1);
    assert_eq!(count("N7:0"), 1);
    assert_eq!(count("N99:0"), 0);
    match xref.find("b3") {
        Some(Found::File { label, groups }) => {
            let addresses: Vec<String> = groups.iter().map(|group| group.address.to_string()).collect();
            assert_eq!((label.as_str(), addresses.join(" ").as_str()), ("B3", "B3:0 B3:0/5 B3:1/0"));
        }
        other => panic!("{other:?}"),
    }
    assert!(matches!(xref.find("U:4"), Some(Found::ProgramFile(4))));
    assert!(matches!(xref.find("Q2:1"), Some(Found::Label { file: 2, number: 1 })));
    assert!(xref.find("NO_SUCH").is_none());
    assert_eq!(CallGraph::build(&image, &image.documentation).calls.len(), 1);
}

#[test]
fn groups_come_in_the_order_of_files_and_addresses() {
    let image = image(&[
        "MOV N10:[N7:3] N7:20",
        "XIC T4:0/DN; MOV T4:0.ACC N7:3; TON T4:0 1.0 5 0",
        "XIC I:2.0/1; XIC I:0.1/1; OTE O:0.0/3; XIC B3:0/1; MOV 0 B3:0",
    ]);
    let xref = CrossReference::build(&image, &image.documentation);
    let order: Vec<String> = xref.all().map(|group| group.address.to_string()).collect();
    assert_eq!(
        order,
        [
            "O:0.0/3",
            "I:0.1/1",
            "I:2.0/1",
            "B3:0",
            "B3:0/1",
            "T4:0",
            "T4:0/DN",
            "T4:0.ACC",
            "N7:3",
            "N7:20",
            "N10:[N7:3]"
        ]
    );
}

#[test]
fn limits_are_said() {
    let mut image = image(&["MOV #N7:0 N10:0"]);
    let notes = |image: &Image| CrossReference::build(image, &image.documentation).notes().to_vec();
    assert_eq!(notes(&image), []);
    set(&mut image, ladder::FileType::S, 2, 2, 8);
    assert_eq!(notes(&image), [Note::IndexLeavesFiles]);
}
