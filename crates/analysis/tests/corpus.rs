//! Figures of real projects that are known from their printouts and from counts made by hand.
//!
//! The projects are no part of this repository: without them each test says so and passes.

use std::path::Path;

use analysis::{CallGraph, Coverage, CrossReference, FindingKind, Target, TimerReport, Usage};
use ladder::{Project, Source, TimeBase};
use rss::Mode;

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod corpus;

fn read(path: &Path) -> Option<Project> {
    let bytes = std::fs::read(path).ok()?;
    let file = rss::Project::read(&bytes, Mode::Permissive).ok()?;
    Some(convert::from_rss::project(&file, Source::default()))
}

fn lanlogix() -> Option<Project> {
    let all = corpus::files(&corpus::root()?, ".rss").expect("the corpus can be listed");
    let path = all.into_iter().find(|path| path.file_name().is_some_and(|name| name == "LANLOGIX_BR.RSS"))?;
    Some(read(&path).expect("a readable project"))
}

#[test]
fn timers_of_a_large_program() {
    let Some(project) = lanlogix() else { return };
    let image = &project.main;
    let xref = CrossReference::build(image, &image.documentation);
    let report = TimerReport::build(image, &xref);

    let active: Vec<_> = report.active().collect();
    let with = |mnemonic| active.iter().filter(|timer| timer.mnemonics() == [mnemonic]).count();
    assert_eq!(active.len(), 127);
    assert_eq!((with("TON"), with("RTO")), (112, 15));
    assert!(report.elsewhere.is_empty());

    let values = |address: &str| {
        let found = active.iter().find(|timer| timer.address.to_string() == address);
        let timer = found.unwrap_or_else(|| panic!("{address}"));
        let base = timer.base.map(TimeBase::text).unwrap_or_default();
        (base, timer.preset.unwrap_or(-1), timer.accum.unwrap_or(-1), timer.preset_seconds().unwrap_or_default())
    };
    for (address, base, preset, accum, seconds) in [
        ("T4:0", "0.01", 50, 0, "0.5"),
        ("T4:14", "0.01", 300, 0, "3"),
        ("T4:30", "0.01", 5000, 5000, "50"),
        ("T4:41", "1.0", 5994, 0, "5994"),
        ("T4:62", "1.0", 3600, 1216, "3600"),
        ("T4:76", "0.01", 32000, 0, "320"),
    ] {
        assert_eq!(values(address), (base, preset, accum, seconds.to_owned()), "{address}");
    }

    let read_only = report.elements.iter().find(|timer| timer.address.to_string() == "T4:174").expect("T4:174");
    assert_eq!(read_only.usage, Usage::ReferencedOnly);
    assert!(!read_only.read_by.is_empty() && read_only.written_by.is_empty() && read_only.reset_by.is_empty());
    // 24 resets of timers.
    let resets: usize = report.elements.iter().map(|timer| timer.reset_by.len()).sum();
    assert_eq!(resets, 24);
}

#[test]
fn calls_of_a_large_program() {
    let Some(project) = lanlogix() else { return };
    let graph = CallGraph::build(&project.main, &project.main.documentation);
    let mut called: Vec<u16> = graph
        .calls
        .iter()
        .filter_map(|call| match call.target {
            Target::File(number) => Some(number),
            _ => None,
        })
        .collect();
    assert_eq!((graph.calls.len(), called.len()), (38, 38));
    called.sort_unstable();
    called.dedup();
    assert_eq!(called.len(), 38);
    assert_eq!(graph.files.iter().filter(|file| file.rungs > 0).count(), 41);
    assert_eq!(graph.never_called().map(|file| file.number).collect::<Vec<_>>(), [214, 255]);
    // Both are routines of interrupts, by the function files.
    let sources = |number| graph.file(number).map(|f| f.entries.iter().map(|e| e.source.as_str()).collect::<Vec<_>>());
    assert_eq!(sources(214), Some(vec!["STI:0.PFN"]));
    assert_eq!(sources(255), Some(vec!["HSC:0.PFN", "HSC:1.PFN", "HSC:3.PFN"]));
}

#[test]
fn every_project_can_be_analysed() {
    let Some(root) = corpus::root() else { return };
    let paths = corpus::files(&root, ".rss").expect("the corpus can be listed");
    let (mut read_in, mut accesses, mut unknown) = (0, 0, 0);
    for path in &paths {
        let Some(project) = read(path) else { continue };
        read_in += 1;
        for image in [Some(&project.main), project.online.as_ref(), project.autosave.as_ref()].into_iter().flatten() {
            let documentation = &project.main.documentation;
            let xref = CrossReference::build(image, documentation);
            let report = TimerReport::build(image, &xref);
            let graph = CallGraph::build(image, documentation);
            let coverage = Coverage::build(image, documentation, &xref);
            assert!(coverage.documented <= coverage.addresses);
            assert!(
                report.active().all(|timer| timer.base.is_some() == (timer.address.file_type == ladder::FileType::T))
            );
            assert!(graph.files.iter().filter(|file| file.reachable).count() <= graph.files.len());
            for group in xref.all() {
                // Each address the program names is found by itself.
                assert!(!group.accesses.is_empty(), "{}: {}", path.display(), group.address);
                accesses += group.accesses.len();
            }
            unknown += xref.unresolved().len();
            // RSLogix verifies a rung only if all its data exists: an address that seems to lie outside
            // would be a wrong length, slot or element size of ours.
            let outside = [FindingKind::BeyondEnd, FindingKind::NoSuchFile, FindingKind::NoSuchPoint];
            let findings = xref.findings();
            let wrong = findings.list.iter().find(|f| outside.contains(&f.kind) && f.expected.is_none());
            assert!(wrong.is_none(), "{}: {wrong:?}", path.display());
        }
    }
    println!("{read_in} projects of {}, {accesses} accesses, {unknown} operands without data", paths.len());
    assert!(paths.is_empty() || read_in > 0);
}
