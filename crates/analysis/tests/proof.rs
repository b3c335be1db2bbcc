//! Proof runs: what they find, what they refuse to call equal, and whether what they write can be run again.

mod migrated;
mod rungs;

use analysis::proof::{
    Difference, Kind, Mapping, Named, Options, Report, RungFate, Verdict, fates, prove_domore, prove_slc,
};
use ladder::Image;
use sim::scenario::{Loader, Scenario, Subject};

/// An SLC text with the data files these rungs need.
fn program(rungs: &[&str]) -> Image {
    rungs::with(rungs::motor(), rungs)
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

/// A conversion that does not set S:5/0.
fn without_traps(project: &domore::Project) -> domore::Project {
    let mut silent = project.clone();
    let sets =
        |it: &domore::Instruction| it.is("SET") && it.operand(0).starts_with('N') && it.operand(0).ends_with(":0");
    let mut traps = 0;
    for part in &mut silent.parts {
        let domore::Part::Code(code) = part else { continue };
        for rung in &mut code.rungs {
            let before = rung.instructions.len();
            rung.instructions.retain(|it| !sets(it));
            traps += before - rung.instructions.len();
        }
    }
    assert!(traps > 0, "no trap in {project:?}");
    silent
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
fn an_input_with_a_coil_is_read_from_its_terminal_when_run_is_entered() {
    let image = program(&["XIC I:0.0/0 OTE O:0.0/0", "XIC I:0.0/1 OTE I:0.0/0"]);
    let (project, map) = migrated(&image);
    let report = prove_domore(&image, &project, &map, fates(&project).as_deref(), &options(20_000));
    assert_eq!(report.verdict(), Verdict::NoDifference, "{report}");
}

#[test]
fn a_stated_condition_excuses_only_the_stops_of_its_rung() {
    let power =
        "XIC I:0.0/0 BST MUL F8:0 F8:0 F8:1 NXB MUL F8:1 F8:1 F8:1 NXB MUL F8:1 F8:1 F8:1 NXB MUL F8:1 F8:1 F8:1 BND";
    let mut image = program(&[power, "XIC I:0.0/1 ADD N7:0 N7:1 N7:2"]);
    image.data_files.push(ladder::DataFile::new(ladder::FileType::F, 8, 2));
    if let Some(words) = image.data_files.iter_mut().find(|file| file.number == 7) {
        *words = ladder::DataFile::new(ladder::FileType::N, 7, 3);
    }
    let (project, map) = migrated(&image);
    let marks = fates(&project).expect("marks");
    assert!(marks.iter().any(|mark| mark.conditions.iter().any(|why| why.contains("fault 0020"))), "{marks:?}");
    let report = prove_domore(&image, &project, &map, Some(&marks), &options(20_000));
    assert_eq!(report.verdict(), Verdict::NoDifference, "{report}");
    assert!(report.outside > 0, "no float overflowed: {report}");

    // The sum overflows and nothing is done about it.
    let report = prove_domore(&image, &without_traps(&project), &map, Some(&marks), &options(20_000));
    assert!(matches!(report.found, Some((Difference::OriginalStopped(_, Some(0x20)), _))), "{report}");
}

#[test]
fn an_index_that_must_stay_inside_excuses_no_overflow() {
    let image = program(&["XIC I:0.0/1 ADD N7:[N7:1] 32000 N7:0"]);
    let (project, map) = migrated(&image);
    let marks = fates(&project).expect("marks");
    assert!(marks[0].conditions[0].starts_with("INDIRECT"), "{marks:?}");
    let report = prove_domore(&image, &project, &map, Some(&marks), &options(20_000));
    assert_eq!(report.verdict(), Verdict::NoDifference, "{report}");
    let report = prove_domore(&image, &without_traps(&project), &map, Some(&marks), &options(20_000));
    assert!(matches!(report.found, Some((Difference::OriginalStopped(_, Some(0x20)), _))), "{report}");
}

#[test]
fn timed_interrupts_come_once_between_two_scans() {
    let corpus = migrated::corpus().map(|corpus| corpus.join("PLC_2s_lamp_flash/sti_1000ms_live.RSS"));
    let Some(path) = corpus.filter(|path| path.exists()) else {
        println!("skipped: corpus not present");
        return;
    };
    let live = migrated::Migrated::of(&path).image;
    let parse = |text: &str| convert::slc::rung::parse_rung(text, Some(live.processor.family)).expect("a rung");
    // Shorter than most times before a scan.
    for main in ["XIC S:1/15 STS 1", "XIC S:1/15 STS 5", "XIC S:1/15 STS 1000"] {
        let mut image = live.clone();
        for file in image.program_files.iter_mut().filter(|file| matches!(file.number, 2 | 3)) {
            let end = file.rungs.pop().expect("an END rung");
            let rung = if file.number == 2 { main } else { "XIO O:0.0/0 OTE O:0.0/0" };
            file.rungs = vec![parse(rung), end];
        }
        let (project, map) = migrated(&image);
        let report = prove_domore(&image, &project, &map, fates(&project).as_deref(), &options(20_000));
        assert_eq!(report.verdict(), Verdict::NoDifference, "{main}: {report}");
    }
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

#[test]
fn flow_that_leads_nowhere_is_no_missing_rung() {
    let family = Some(program(&BASE).processor.family);
    let rungs = |texts: &[&str]| -> Vec<ladder::Rung> {
        texts.iter().map(|text| convert::slc::rung::parse_rung(text, family).expect("a rung")).collect()
    };
    for (main, sub) in [
        (vec!["XIC I:0.0/0 JSR 3"], vec![]),
        (vec!["XIC I:0.0/0 JSR 3", "XIC I:0.0/1 JSR 3"], vec![]),
        (vec!["JSR 3"], vec!["XIC I:0.0/0 OTE B3:0/1", "XIC I:0.0/1 RET"]),
        (vec!["XIC I:0.0/2 JSR 3"], vec!["SBR", "XIC I:0.0/0 OTE B3:0/1", "XIC I:0.0/1 RET"]),
        (vec!["XIC I:0.0/0 OTE B3:0/1", "XIC I:0.0/1 TND"], vec![]),
        (vec!["XIC I:0.0/0 JMP 1", "LBL 1 XIC I:0.0/1 OTE B3:0/1"], vec![]),
    ] {
        let mut image = program(&[&main[..], &BASE].concat());
        let end = image.program_files.iter().find(|file| file.number == 2).and_then(|file| file.rungs.last()).cloned();
        let mut file = ladder::ProgramFile { number: 3, ..image.program_files.last().expect("file 2").clone() };
        file.rungs = rungs(&sub);
        file.rungs.extend(end);
        image.program_files.push(file);
        let migration = convert::migrate::migrate(&image, &[], &Default::default()).expect("it migrates");
        let map: Vec<_> = migrated(&image).1;
        let fates = analysis::proof::fates(&migration.project).expect("marks");
        let report = prove_domore(&image, &migration.project, &map, Some(&fates), &options(2_000));
        assert!(report.missing_rungs.is_empty(), "{main:?} {sub:?}: {:?}", report.missing_rungs);
        assert_eq!(report.verdict(), Verdict::NoDifference, "{main:?} {sub:?}: {report}");
    }
}

/// The first contact of the rungs converted from `2:rung` turned over.
fn inverted(project: &domore::Project, rung: u32) -> domore::Project {
    let mut project = project.clone();
    let mark = format!("SLC 2:{rung} ");
    let blocks = project.parts.iter_mut().filter_map(|part| match part {
        domore::Part::Code(block) => Some(block),
        _ => None,
    });
    for found in blocks.flat_map(|block| &mut block.rungs) {
        let marked = found.comment.iter().flat_map(|comment| &comment.lines).any(|line| line.starts_with(&mark));
        if let Some(first) = found.instructions.first_mut().filter(|_| marked) {
            let name = if first.mnemonic == "STR" { "STRN" } else { "STR" };
            first.mnemonic = name.to_owned();
        }
    }
    project
}

#[test]
fn what_a_person_has_to_write_taints_no_more_than_depends_on_it() {
    let rungs = [
        "XIC I:0.0/0 OTE B3:0/0",   // 0: left to a person
        "XIC B3:0/0 OTE B3:0/1",    // 1: depends on it
        "XIC I:0.0/1 OTE B3:0/2",   // 2: another bit of the same word
        "XIC B3:0/2 MOV N7:0 N7:1", // 3
        "XIC B3:0/1 JSR 3",         // 4: what it calls depends on it
        "XIC I:0.0/3 OTE B3:0/5",   // 5
    ];
    let mut image = program(&rungs);
    let family = Some(image.processor.family);
    let mut file = ladder::ProgramFile { number: 3, ..image.program_files.last().expect("file 2").clone() };
    let end = file.rungs.pop().expect("an END rung");
    file.rungs = vec![convert::slc::rung::parse_rung("XIC I:0.0/2 OTE B3:0/4", family).expect("a rung"), end];
    image.program_files.push(file);
    let (project, map) = migrated(&image);
    let mut fates = analysis::proof::fates(&project).expect("marks");
    let first = fates.iter_mut().find(|fate| (fate.file, fate.rung) == (2, 0)).expect("a mark");
    first.person = Some("because".to_owned());
    let prove = |other: &domore::Project| prove_domore(&image, other, &map, Some(&fates), &options(5_000));
    let report = prove(&project);
    assert_eq!((report.verdict(), report.not_compared), (Verdict::NotComparable, 1), "{report}");
    assert!(report.incomparable.is_empty() && report.scans == 5_000, "{report}");
    // What depends on the rung can be anything; what does not is compared as ever, bits of one word apart.
    for (rung, differs) in [(0, false), (1, false), (2, true), (3, true), (4, false), (5, true)] {
        let report = prove(&inverted(&project, rung));
        assert_eq!(report.found.is_some(), differs, "rung {rung}: {report}");
        assert_ne!(report.verdict(), Verdict::NoDifference, "rung {rung}");
    }
}

#[test]
fn rows_of_a_map_that_overlap_are_told_with_both() {
    let image = program(&BASE);
    let (project, map) = migrated(&image);
    let refused = |map: &[Mapping]| analysis::proof::refused_domore(&image, &project, map, &options(1));
    assert_eq!(refused(&map), []);
    let at = |original: &str| map.iter().position(|row| row.original == original).expect("a row");
    let (bits, words) = (at("B3:0"), at("N7:0"));
    let row = |original: &str, words: u32, other: &str| Mapping {
        original: original.to_owned(),
        words,
        other: other.to_owned(),
    };
    let found = |changed: Vec<Mapping>| {
        let found = refused(&changed);
        assert_eq!(found.len(), 1, "{found:?}");
        (found[0].row, found[0].with.unwrap_or_else(|| panic!("{found:?}")), found[0].why.clone())
    };
    // The same place twice: bits on words, and a word twice.
    let mut meets = map.clone();
    meets[words].other = map[at("T4:0")].other.clone();
    let (later, earlier, why) = found(meets);
    assert_eq!((earlier.min(later), earlier.max(later)), (words.min(at("T4:0")), words.max(at("T4:0"))), "{why}");
    assert!(why.contains("meet in the other program"), "{why}");
    // The same data twice.
    let mut twice = map.clone();
    twice.push(row("B3:0", 1, "C512"));
    assert_eq!(found(twice), (map.len(), bits, "B3:0 and B3:0 are in part the same data".to_owned()));
    // A point may lie in its word or apart from it, but not in another's, and not twice.
    let point = |other: &str| [&map[..], &[row("I:0.0/3", 0, other)]].concat();
    assert_eq!(refused(&point("X3")), []);
    assert_eq!(refused(&point("X99")), []);
    assert_eq!(found(point(&map[bits].other)).1, bits);
    let mut both = point("X99");
    both.push(row("I:0.0/3", 0, "X98"));
    assert_eq!(found(both).1, map.len());
}
