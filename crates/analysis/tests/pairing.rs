//! What belongs together in two programs: every name leads to its place on the other side and back, or nowhere.

mod rungs;

use std::sync::Arc;

use analysis::proof::{
    AnySide, AnySideMut, DoMore, Mapping, Options, Pairing, Progress, Slc, Verdict, fates, origins, prove_domore,
};
use ladder::{Image, Value};

fn image(rungs: &[&str]) -> Image {
    rungs::with(rungs::motor(), rungs)
}

const RUNGS: [&str; 4] = [
    "XIC I:0.0/0 TON T4:0 0.01 300 0",
    "XIC T4:0/DN OTE O:0.0/0",
    "XIC I:0.0/2 ADD N7:0 1 N7:1",
    "EQU S:40 12 OTE B3:0/3",
];

struct Both {
    image: Image,
    project: domore::Project,
    map: Vec<Mapping>,
    a: Slc,
    b: DoMore,
}

fn both() -> Both {
    let image = image(&RUNGS);
    let migration = convert::migrate::migrate(&image, &[], &Default::default()).expect("migrates");
    let rows = migration.map.iter().filter(|row| row.places_data());
    let map = rows.map(|row| Mapping { original: row.slc.clone(), words: row.words, other: row.domore.clone() });
    let program = sim::Program::compile(&image, &sim::Options::default()).expect("runs");
    let other = domore::engine::Program::compile(&migration.project, &Default::default()).expect("runs");
    let (a, b) = (Slc { machine: sim::Machine::new(program) }, DoMore::new(other));
    Both { map: map.collect(), project: migration.project, image, a, b }
}

#[test]
fn names_lead_there_and_back() {
    let Both { image, project, map, a, mut b } = both();
    let pairing = Pairing::new(&image, &a, AnySide::DoMore(&b), &map, fates(&project).as_deref());
    assert_eq!((pairing.unmapped(), pairing.incomparable()), (&[][..], &[][..]));
    for address in ["I:0.0/0", "O:0.0/0", "N7:1", "N7:1/15", "T4:0/DN", "T4:0.PRE", "T4:0.ACC", "B3:0/3"] {
        let other = pairing.other(&a, address).unwrap_or_else(|why| panic!("{address}: {why}"));
        assert_eq!(pairing.original(&a, AnySide::DoMore(&b), &other).as_deref(), Ok(address), "{other}");
    }
    // The clock is the system's own there; it is written, and begins alike.
    assert_eq!(pairing.other(&a, "S:40").as_deref(), Ok("SDT0.Hour"));
    assert!(pairing.start().iter().any(|(own, other, _)| own == "S:37" && other == "SDT0.Year"));
    for address in ["N99:0", "N7:400", "nothing", ""] {
        assert!(pairing.other(&a, address).is_err(), "{address}");
    }
    for helper in ["ST0", "T0.Acc", "C17", "V0", "nothing", ""] {
        assert!(pairing.original(&a, AnySide::DoMore(&b), helper).is_err(), "{helper}");
    }
    let rows: Vec<(&str, bool)> = pairing.rows().iter().map(|row| (row.original.as_str(), row.compared)).collect();
    for row in ["I:0.0/0", "O:0.0/0", "T4:0/DN", "T4:0.ACC", "N7:1"] {
        assert!(rows.contains(&(row, true)), "{row}: {rows:?}");
    }
    // The same bits, whatever the other side calls such a value.
    let place = pairing.other(&a, "N7:1").expect("is mapped");
    pairing.write(AnySideMut::DoMore(&mut b), &place, &Value::Word(-2)).expect("a number");
    let row = pairing.rows().iter().position(|row| row.original == "N7:1").expect("is named");
    assert_eq!(pairing.values(row, &a, AnySide::DoMore(&b)), Some([Value::Word(500), Value::Word(-2)]));
    assert!(pairing.differing(&a, AnySide::DoMore(&b)).contains(&u32::try_from(row).expect("few")));
}

#[test]
fn every_converted_rung_knows_its_own() {
    let Both { image, project, .. } = both();
    let rungs = image.program_file(2).map_or(0, |file| file.rungs.len() - 1);
    let from: Vec<(u16, u32)> = origins(&project).iter().map(|it| (it.file, it.from)).collect();
    assert_eq!(from, (0..u32::try_from(rungs).expect("few")).map(|rung| (2, rung)).collect::<Vec<_>>());
}

#[test]
fn a_run_that_is_stopped_claims_no_more_than_it_saw() {
    let Both { image, project, map, .. } = both();
    let progress = Arc::new(Progress::default());
    progress.stop();
    let options = Options { progress: Some(Arc::clone(&progress)), ..Options::default() };
    let report = prove_domore(&image, &project, &map, fates(&project).as_deref(), &options);
    assert_eq!((report.verdict(), report.scans, progress.scans()), (Verdict::NotComparable, 0, 0));
    assert!(report.to_string().contains("stopped before its first scan"), "{report}");
}
