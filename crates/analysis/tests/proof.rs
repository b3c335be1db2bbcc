//! Proof runs: what they find, what they refuse to call equal, and whether what they write can be run again.

mod migrated;

use analysis::proof::{Difference, Kind, Mapping, Named, Options, Report, RungFate, Verdict, prove_domore, prove_slc};
use ladder::Image;
use sim::scenario::{Loader, Scenario, Subject};

/// An SLC text with the data files these rungs need.
fn program(rungs: &[&str]) -> Image {
    let motor = std::fs::read(migrated::root().join("examples/motor/motor.SLC")).expect("the example is there");
    let mut image = convert::open(&motor, "motor.SLC", rss::Mode::Permissive).expect("reads").main;
    let family = Some(image.processor.family);
    let file = image.program_files.iter_mut().find(|file| file.number == 2).expect("a main program");
    let end = file.rungs.pop().expect("an END rung");
    file.rungs = rungs.iter().map(|text| convert::slc::rung::parse_rung(text, family).expect("a rung")).collect();
    file.rungs.push(end);
    image.program_files.retain(|file| file.number <= 2);
    image
}

fn options(scans: u64) -> Options {
    let named = |program: &str| Named { program: program.to_owned(), family: None };
    Options { scans, original: named("a"), other: named("b"), ..Options::default() }
}

fn migrated(image: &Image) -> (domore::Project, Vec<Mapping>) {
    let migration = convert::migrate::migrate(image, &[], &Default::default()).expect("no map to be wrong");
    let rows = migration.map.iter().filter(|row| row.places_data());
    let map = rows.map(|row| Mapping { original: row.slc.clone(), words: row.words, other: row.domore.clone() });
    (migration.project, map.collect())
}

const BASE: [&str; 3] = [
    "XIC I:0.0/0 TON T4:0 0.01 300 0",
    "XIC T4:0/DN XIO I:0.0/1 OTE O:0.0/0",
    "XIC I:0.0/2 GEQ T4:0.ACC 120 OTL B3:0/3",
];

/// Gives scenarios their programs.
struct Two<'a>(&'a Image, &'a Image);

impl Loader for Two<'_> {
    fn program(&self, path: &str) -> Result<Image, String> {
        Ok(if path == "a" { self.0.clone() } else { self.1.clone() })
    }

    fn rungs(&self, _: &str, _: ladder::Family) -> Result<Vec<ladder::Rung>, Vec<(u32, String)>> {
        Err(Vec::new())
    }
}

fn failures(text: &str, loader: &Two<'_>) -> usize {
    let scenario = Scenario::parse(text).expect("a scenario");
    assert!(matches!(scenario.program, Subject::File(_)));
    sim::scenario::run(&scenario, loader, sim::Choices::default()).expect("it runs").failures.len()
}

#[test]
fn a_program_does_not_differ_from_itself_and_all_of_it_is_reached() {
    let image = program(&BASE);
    let report = prove_slc(&image, &image, None, &options(20_000));
    assert_eq!(report.verdict(), Verdict::NoDifference, "{report}");
    assert_eq!(report.scans, 20_000);
    let covered = report.conditions_covered();
    assert_eq!(covered.reached, covered.all, "{report}");
    assert!(report.mode_changes > 10 && report.inputs == 3, "{report}");
    assert!(report.rungs().iter().all(|rung| rung.missing.is_empty() || rung.rung < 3));
}

#[test]
fn the_same_seed_gives_the_same_run() {
    let (a, b) = (program(&BASE), program(&[BASE[0], BASE[1], "XIC I:0.0/2 GEQ T4:0.ACC 121 OTL B3:0/3"]));
    let run = |seed| prove_slc(&a, &b, None, &Options { seed, ..options(50_000) });
    let example = |report: &Report| report.found.clone().expect("a difference").1;
    assert_eq!(example(&run(7)), example(&run(7)));
    assert_eq!(run(7).scans, run(7).scans);
}

#[test]
fn differences_are_cut_down_to_scenarios_that_pass_and_fail() {
    let changes: [(usize, &str); 6] = [
        (0, "XIC I:0.0/0 TON T4:0 0.01 301 0"),
        (0, "XIO I:0.0/0 TON T4:0 0.01 300 0"),
        (1, "XIC T4:0/DN XIC I:0.0/1 OTE O:0.0/0"),
        (1, "XIC T4:0/DN OTE O:0.0/0"),
        (2, "XIC I:0.0/2 GRT T4:0.ACC 120 OTL B3:0/3"),
        (2, "XIC I:0.0/2 GEQ T4:0.ACC 120 OTE B3:0/3"),
    ];
    for (index, changed) in changes {
        let mut rungs = BASE;
        rungs[index] = changed;
        let (a, mut b) = (program(&BASE), program(&rungs));
        if changed.contains("301") {
            // PRE lives in the data table.
            let timers = b.data_files.iter_mut().find(|file| file.file_type == ladder::FileType::T).expect("timers");
            timers.words[1] = 301;
        }
        let mut a = a;
        if let Some(timers) = a.data_files.iter_mut().find(|file| file.file_type == ladder::FileType::T) {
            (timers.words[0], timers.words[1], timers.words[2]) = (0, 300, 0);
        }
        if let Some(timers) = b.data_files.iter_mut().find(|file| file.file_type == ladder::FileType::T) {
            (timers.words[0], timers.words[2]) = (0, 0);
            timers.words[1] = if changed.contains("301") { 301 } else { 300 };
        }
        let report = prove_slc(&a, &b, None, &options(50_000));
        let (_, example) = report.found.as_ref().unwrap_or_else(|| panic!("{changed}: {report}"));
        assert_eq!(report.verdict(), Verdict::Different);
        let loader = Two(&a, &b);
        assert_eq!(failures(&example.original, &loader), 0, "{changed}\n{}", example.original);
        assert!(failures(&example.other, &loader) > 0, "{changed}\n{}", example.other);
        // Two scans and two inputs show the simple ones; a GEQ at its boundary needs the time to get there.
        assert!(example.changes <= 6, "{changed}\n{}", example.original);
        assert!(example.scans <= 400, "{changed}\n{}", example.original);
    }
}

#[test]
fn a_stop_of_one_side_is_a_difference() {
    let a = program(&["XIC I:0.0/0 ADD 32767 1 N7:0"]);
    let b = program(&["XIC I:0.0/0 MOV 32767 N7:0"]);
    let report = prove_slc(&a, &b, None, &options(5_000));
    let Some((Difference::OriginalStopped(why, code), example)) = &report.found else { panic!("{report}") };
    assert!(why.contains("0020") && *code == Some(0x20), "{why}");
    let loader = Two(&a, &b);
    assert_eq!(failures(&example.original, &loader), 0, "{}", example.original);
    assert!(failures(&example.other, &loader) > 0, "{}", example.other);
    // Both stopping alike is none, and it is counted.
    let same = prove_slc(&a, &a, None, &options(5_000));
    assert_eq!(same.verdict(), Verdict::NoDifference, "{same}");
    assert!(same.stops > 10);
}

#[test]
fn converted_programs_are_compared_by_their_map() {
    let image = program(&BASE);
    let (project, map) = migrated(&image);
    let options = |scans| Options { without_marks: true, ..options(scans) };
    let report = prove_domore(&image, &project, &map, None, &options(20_000));
    assert_eq!(report.verdict(), Verdict::NoDifference, "{report}");
    assert!(report.other_coverage.all > 0);
    assert!(report.notes.iter().any(|note| note.contains("missing rung")));
    assert!(report.to_string().lines().next().is_some_and(|line| line.contains("was not checked")), "{report}");
    // Unless that is asked for, a text without marks cannot be compared.
    let report = prove_domore(&image, &project, &map, None, &Options { without_marks: false, ..options(2_000) });
    assert_eq!(report.verdict(), Verdict::NotComparable, "{report}");
    assert!(report.incomparable.iter().any(|why| why.contains("no rung marks")), "{report}");

    // Without a row for the output nothing can be said of it.
    let partial: Vec<Mapping> = map.iter().filter(|row| !row.original.starts_with("O:")).cloned().collect();
    let report = prove_domore(&image, &project, &partial, None, &options(2_000));
    assert_eq!(report.verdict(), Verdict::NotComparable, "{report}");
    assert!(report.unmapped.iter().any(|(address, _)| address == "O:0.0/0"), "{:?}", report.unmapped);

    // A word in the wrong place.
    let mut wrong = map.clone();
    let row = wrong.iter_mut().find(|row| row.original.starts_with("B3:0")).expect("a row of B3");
    row.other = "C512".to_owned();
    assert_eq!(prove_domore(&image, &project, &wrong, None, &options(20_000)).verdict(), Verdict::Different);
    assert_eq!(prove_domore(&image, &project, &[], None, &options(2_000)).verdict(), Verdict::NotComparable);
}

#[test]
fn no_rung_goes_missing_and_none_left_to_a_person_counts_as_equal() {
    let image = program(&BASE);
    let (project, map) = migrated(&image);
    let fate = |rung, person: Option<&str>| RungFate {
        file: 2,
        rung,
        person: person.map(str::to_owned),
        conditions: Vec::new(),
    };
    let all = [fate(0, None), fate(1, None), fate(2, None)];
    let prove = |fates: &[RungFate]| prove_domore(&image, &project, &map, Some(fates), &options(5_000));
    assert_eq!(prove(&all).verdict(), Verdict::NoDifference);
    let report = prove(&all[..2]);
    assert_eq!(report.verdict(), Verdict::Different, "{report}");
    assert_eq!(report.missing_rungs, ["2:2"]);

    // The person's rung latches B3:0/3: its word is not compared, the rest is.
    let report = prove(&[fate(0, None), fate(1, None), fate(2, Some("because"))]);
    assert_eq!(report.verdict(), Verdict::NotComparable, "{report}");
    assert!(report.not_compared > 0 && report.compared > 0, "{report}");
    assert!(report.found.is_none());

    // The marks a migration leaves in the text say the same.
    let marks = analysis::proof::fates(&project).expect("marks");
    assert_eq!(marks.iter().map(|fate| (fate.file, fate.rung)).collect::<Vec<_>>(), [(2, 0), (2, 1), (2, 2)]);
}

#[test]
fn what_cannot_run_cannot_be_compared() {
    let image = program(&BASE);
    let other = program(&["RPC I:0.0 1"]);
    let report = prove_slc(&image, &other, None, &options(1_000));
    if report.found.is_none() {
        assert_eq!(report.verdict(), Verdict::NotComparable, "{report}");
    }
    let text = "$PRGRM $Main\n\nSTR X0\nMRX D0 D1\n\n$PGMEND $Main\n";
    let project = domore::text::read(text).expect("reads").project;
    let report = prove_domore(&image, &project, &Mapping::identity(&image), None, &options(1_000));
    assert_eq!((report.verdict(), report.scans), (Verdict::NotComparable, 0), "{report}");
    assert!(!report.incomparable.is_empty());
}

#[test]
fn names_and_values_are_those_of_the_sides() {
    let a = program(&["XIC I:0.0/0 MOV 5 N7:0"]);
    let b = program(&["XIC I:0.0/0 MOV 6 N7:0"]);
    let report = prove_slc(&a, &b, None, &options(2_000));
    let Some((Difference::Value(found), example)) = &report.found else { panic!("{report}") };
    assert_eq!((found.original.as_str(), found.kind), ("N7:0", Kind::Word));
    assert_eq!((found.expected.as_str(), found.found.as_str()), ("5", "6"));
    assert_eq!(example.scans, 2, "{}", example.original);
}

/// Our own examples and the corpus: 100,000 scans without a difference.
#[test]
fn proven_programs_stay_proven() {
    let scans = if cfg!(debug_assertions) { 5_000 } else { 100_000 };
    for program in migrated::proven(true) {
        let options = Options { scans, ..Options::default() };
        let report = prove_domore(&program.image, &program.project, &program.map, Some(&program.fates), &options);
        println!("{}: {} conditions {}", program.name, report.verdict().as_str(), report.conditions_covered());
        assert_eq!(report.verdict(), Verdict::NoDifference, "{}: {report}", program.name);
    }
}

#[test]
fn a_rung_emptied_under_its_mark_is_a_difference() {
    let image = program(&BASE);
    let (mut project, map) = migrated(&image);
    let marks = analysis::proof::fates(&project).expect("marks");
    let marked = |rung: &domore::Rung| {
        rung.comment.iter().flat_map(|comment| &comment.lines).any(|line| line.starts_with("SLC 2:2 "))
    };
    let blocks = project.parts.iter_mut().filter_map(|part| match part {
        domore::Part::Code(block) => Some(block),
        _ => None,
    });
    for rung in blocks.flat_map(|block| &mut block.rungs).filter(|rung| marked(rung)) {
        rung.instructions = vec![domore::Instruction::new("NOP", [""; 0])];
    }
    // One scan does not show it in behaviour.
    let report = prove_domore(&image, &project, &map, Some(&marks), &options(1));
    assert!(report.found.is_none(), "{report}");
    assert_eq!(report.verdict(), Verdict::Different, "{report}");
    assert!(matches!(report.missing_rungs.as_slice(), [one] if one.starts_with("2:2")), "{report}");
    // One that is left to a person is said to be empty.
    let person = |mut fate: RungFate| {
        fate.person = (fate.rung == 2).then(|| "because".to_owned());
        fate
    };
    let persons: Vec<RungFate> = marks.into_iter().map(person).collect();
    let report = prove_domore(&image, &project, &map, Some(&persons), &options(1_000));
    assert_eq!(report.verdict(), Verdict::NotComparable, "{report}");
}

#[test]
fn no_scan_compares_nothing() {
    let image = program(&BASE);
    let report = prove_slc(&image, &image, None, &options(0));
    assert_eq!((report.verdict(), report.scans), (Verdict::NotComparable, 0), "{report}");
    let text = report.to_string();
    assert!(text.contains("nothing compared") && !text.contains("100.0 %") && !text.contains("0 of 0"), "{text}");
}
