//! Timers and counters: which value is in force, who uses an element, what deserves a look.

mod support;

use analysis::{
    Certainty, CrossReference, ElementKind, TimerCounter, TimerFindingKind, TimerReport, Usage, instructions,
};
use ladder::{Address, AddressEntry, DataFile, Element, FileType, Image, Target, TimeBase};
use support::{image, set};

fn report(image: &Image) -> TimerReport {
    let xref = CrossReference::build(image, &image.documentation);
    TimerReport::build(image, &xref)
}

#[track_caller]
fn element<'r>(report: &'r TimerReport, address: &str) -> &'r TimerCounter {
    let found = report.elements.iter().find(|element| element.address.to_string() == address);
    found.unwrap_or_else(|| panic!("{address} in the report"))
}

fn kinds(report: &TimerReport, address: &str) -> Vec<TimerFindingKind> {
    let of = report.findings.iter().filter(|finding| finding.address.to_string() == address);
    of.map(|finding| finding.kind).collect()
}

/// Control word, preset, accumulated value of an element.
fn set_element(image: &mut Image, file_type: FileType, number: u16, element: usize, words: [u16; 3]) {
    for (word, value) in words.into_iter().enumerate() {
        set(image, file_type, number, element * 3 + word, value);
    }
}

fn not_verified(image: &mut Image, rung: usize) {
    for element in &mut image.program_files[0].rungs[rung].series {
        if let Element::Instruction(instruction) = element {
            instruction.compiled = false;
        }
    }
}

#[test]
fn a_verified_instruction_shows_a_copy_of_the_data_table() {
    let mut image = image(&["TON T4:0 0.01 50 0", "XIC T4:0/DN; OTE B3:0/0"]);
    set_element(&mut image, FileType::T, 4, 0, [0xA000, 75, 75]);
    let report = report(&image);
    let timer = element(&report, "T4:0");
    assert_eq!((timer.base, timer.preset, timer.accum), (Some(TimeBase::Centisecond), Some(75), Some(75)));
    assert_eq!(timer.preset_seconds().as_deref(), Some("0.75"));
    assert_eq!((timer.instructions[0].preset, timer.instructions[0].accum), (Some(50), Some(0)));
    let data = timer.data.expect("element");
    let bits: Vec<_> = data.bits(ElementKind::Timer).collect();
    assert_eq!(bits, [("EN", true), ("TT", false), ("DN", true)]);
    assert_eq!(kinds(&report, "T4:0"), [TimerFindingKind::DiffersFromData, TimerFindingKind::AccumDiffers]);
}

#[test]
fn an_instruction_never_verified_holds_what_was_entered() {
    let mut image = image(&["TON T4:0 1.0 3600 5", "TON T4:30 1.0 60 0"]);
    set_element(&mut image, FileType::T, 4, 0, [0, 7, 7]);
    not_verified(&mut image, 0);
    not_verified(&mut image, 1);
    let report = report(&image);
    let timer = element(&report, "T4:0");
    assert_eq!((timer.base, timer.preset, timer.accum), (Some(TimeBase::Second), Some(3600), Some(5)));
    assert_eq!(timer.preset_seconds().as_deref(), Some("3600"));
    assert_eq!(timer.data.map(|data| data.preset), Some(7), "both are shown");
    // The element does not exist before the rung is verified.
    let beyond = element(&report, "T4:30");
    assert_eq!((beyond.data, beyond.preset), (None, Some(60)));
    assert!(kinds(&report, "T4:30").contains(&TimerFindingKind::NoElement));
}

#[test]
fn seconds_follow_the_time_base() {
    let mut image = image(&["TON T4:0 0.001 1500 0", "RTO T4:1 1.0 5994 0", "TOF T4:2 0.01 32000 0"]);
    for (element, words) in [[0x0100, 1500, 0], [0x0200, 5994, 12], [0, 32000, 0]].into_iter().enumerate() {
        set_element(&mut image, FileType::T, 4, element, words);
    }
    let report = report(&image);
    let seconds: Vec<_> = report.active().map(|timer| timer.preset_seconds().unwrap_or_default()).collect();
    assert_eq!(seconds, ["1.5", "5994", "320"]);
    assert_eq!(element(&report, "T4:1").accum_seconds().as_deref(), Some("12"));
    let mnemonics: Vec<_> = report.active().flat_map(TimerCounter::mnemonics).collect();
    assert_eq!(mnemonics, ["TON", "RTO", "TOF"]);
}

#[test]
fn every_rung_that_uses_a_timer_is_listed_with_what_it_does() {
    let mut image = image(&[
        "TON T4:0 0.01 50 0",
        "XIC T4:0/DN; XIO T4:0/TT; OTE B3:0/0",
        "MOV 100 T4:0.PRE",
        "RES T4:0",
        "MOV T4:0.ACC N7:0",
        "COP #N7:10 #T4:0 2",
        "MOV N7:1 T4:[N7:2].PRE",
        "XIC T4:1/DN; OTE B3:0/1",
    ]);
    set_element(&mut image, FileType::T, 4, 0, [0, 50, 0]);
    let report = report(&image);
    let timer = element(&report, "T4:0");
    let texts = |all: &[analysis::Reference]| {
        let text = |it: &analysis::Reference| format!("{} {} {}", it.location, it.mnemonic, it.members.join("+"));
        all.iter().map(text).collect::<Vec<_>>()
    };
    assert_eq!(texts(&timer.read_by), ["2:1 XIC DN", "2:1 XIO TT", "2:4 MOV ACC"]);
    assert_eq!(texts(&timer.written_by), ["2:2 MOV PRE", "2:5 COP ", "2:6 MOV PRE"]);
    assert_eq!(timer.written_by[2].certainty, Certainty::May);
    assert_eq!(timer.reset_by[0].location.rung, 3);
    assert_eq!(timer.instructions.len(), 1);
    // T4:1 is read and copied over, never timed.
    assert_eq!(element(&report, "T4:1").usage, Usage::ReferencedOnly);
    // Nothing refers to T4:2 for certain and it has no preset.
    assert!(!report.elements.iter().any(|element| element.address.to_string() == "T4:2"));
}

#[test]
fn elements_that_never_start_are_listed_apart() {
    let mut image = image(&["XIC T4:3/DN; OTE B3:0/0"]);
    set_element(&mut image, FileType::T, 4, 5, [0x0200, 90, 0]);
    let report = report(&image);
    assert_eq!(report.active().count(), 0);
    assert_eq!(element(&report, "T4:3").usage, Usage::ReferencedOnly);
    assert_eq!(kinds(&report, "T4:3"), [TimerFindingKind::OnlyRead]);
    let configured = element(&report, "T4:5");
    assert_eq!((configured.usage, configured.preset_seconds().as_deref()), (Usage::ConfiguredOnly, Some("90")));
    assert_eq!(kinds(&report, "T4:5"), [TimerFindingKind::Unused]);
}

#[test]
fn what_deserves_a_look() {
    use TimerFindingKind as K;
    let mut image = image(&[
        "TON T4:0 0.01 50 0",
        "TON T4:0 0.01 50 0",
        "XIC T4:0/DN; OTE B3:0/0",
        "TON T4:1 0.01 0 0; XIC T4:1/DN",
        "RTO T4:2 1.0 5 0; XIC T4:2/DN",
        "TOF T4:3 1.0 5 0; XIC T4:3/DN; RES T4:3",
        "CTU C5:0 5 0; CTD C5:0 5 0; XIC C5:0/DN; RES C5:0",
        "CTU C5:1 5 0; CTU C5:1 5 0; XIC C5:1/DN; RES C5:1",
        "TON T4:4 1.0 5 0; XIC T4:4/DN; MOV 9 T4:1.PRE",
        "TON T4:5 1.0 5 0",
    ]);
    for (file_type, file, element, words) in [
        (FileType::T, 4, 0, [0, 50, 0]),
        (FileType::T, 4, 2, [0x0200, 5, 0]),
        (FileType::T, 4, 3, [0x0200, 5, 0]),
        (FileType::T, 4, 4, [0x0200, 0xFFFF, 0]),
        (FileType::T, 4, 5, [0x0200, 5, 0]),
        (FileType::C, 5, 0, [0, 5, 0]),
        (FileType::C, 5, 1, [0, 5, 0]),
    ] {
        set_element(&mut image, file_type, file, element, words);
    }
    let report = report(&image);
    for (address, expected) in [
        ("T4:0", &[K::SeveralInstructions][..]),
        ("T4:1", &[]),
        ("T4:2", &[K::NeverReset]),
        ("T4:3", &[K::ResetOfOffDelay]),
        ("T4:4", &[K::Negative, K::DiffersFromData]),
        ("T4:5", &[K::NeverRead]),
        ("C5:0", &[]),
        ("C5:1", &[K::SeveralInstructions]),
    ] {
        assert_eq!(kinds(&report, address), expected, "{address}");
    }
}

#[test]
fn symbols_stand_for_timers_and_name_them() {
    let mut image = image(&["TON ENTRY_TON 1.0 5 0", "XIC ENTRY_TON/DN; OTE B3:0/0", "TON NOBODY 1.0 5 0"]);
    image.documentation.add(AddressEntry {
        target: Target::Address(Address::parse("T4:6").expect("address")),
        symbol: "ENTRY_TON".into(),
        description: vec!["box".into(), "enters".into()],
    });
    (0..3).for_each(|rung| not_verified(&mut image, rung));
    let report = report(&image);
    let timer = element(&report, "T4:6");
    assert_eq!(timer.symbol.as_deref(), Some("ENTRY_TON"));
    assert_eq!(timer.description, ["box", "enters"]);
    assert_eq!(timer.read_by[0].written, "ENTRY_TON/DN");
    assert_eq!(report.elsewhere.len(), 1, "a timer whose element is not known is not dropped");
    assert_eq!(report.elsewhere[0].address, "NOBODY");
}

#[test]
fn counters_show_their_own_bits() {
    let mut image = image(&["CTU C5:0 10 0", "XIC C5:0/OV; OTE B3:0/0", "RES C5:0"]);
    set_element(&mut image, FileType::C, 5, 0, [0xB000, 10, 11]);
    let report = report(&image);
    let counter = element(&report, "C5:0");
    assert_eq!((counter.kind, counter.base, counter.preset_seconds()), (ElementKind::Counter, None, None));
    let on: Vec<_> = counter.data.into_iter().flat_map(|d| d.bits(counter.kind)).filter(|bit| bit.1).collect();
    assert_eq!(on, [("CU", true), ("DN", true), ("OV", true)]);
    assert_eq!(counter.read_by[0].members, ["OV"]);
}

#[test]
fn an_empty_image_gives_an_empty_report() {
    let image = Image { data_files: vec![DataFile::new(FileType::T, 4, 3)], ..Image::default() };
    let report = report(&image);
    assert!(report.elements.is_empty() && report.findings.is_empty() && report.elsewhere.is_empty());
    assert_eq!(instructions(&image).count(), 0);
}
