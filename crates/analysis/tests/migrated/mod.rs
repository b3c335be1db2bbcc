//! Programs that are migrated and proven.

use std::path::{Path, PathBuf};

use analysis::proof::{Mapping, RungFate};
use convert::migrate::{Migration, Options, Verdict, migrate};
use ladder::Image;

#[path = "../../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod place;

/// A program and what a migration made of it.
pub(crate) struct Migrated {
    pub(crate) name: String,
    pub(crate) image: Image,
    pub(crate) project: domore::Project,
    pub(crate) map: Vec<Mapping>,
    pub(crate) fates: Vec<RungFate>,
}

impl Migrated {
    pub(crate) fn of(path: &Path) -> Migrated {
        let bytes = std::fs::read(path).expect("the file is there");
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let project = convert::open(&bytes, &name, rss::Mode::Permissive).expect("reads");
        let image = project.main;
        let migration = migrate(&image, &[], &Options::default()).expect("no map to be wrong");
        let (map, fates) = (mappings(&migration), fates(&migration));
        Migrated { name, image, project: migration.project, map, fates }
    }
}

fn mappings(migration: &Migration) -> Vec<Mapping> {
    let rows = migration.map.iter().filter(|row| row.places_data());
    rows.map(|row| Mapping { original: row.slc.clone(), words: row.words, other: row.domore.clone() }).collect()
}

fn fates(migration: &Migration) -> Vec<RungFate> {
    let of = |verdict| move |rung: &&convert::migrate::RungResult| rung.verdict == verdict;
    let notes = |rung: &convert::migrate::RungResult| rung.notes.iter().map(ToString::to_string).collect::<Vec<_>>();
    let fate = |rung: &convert::migrate::RungResult| RungFate {
        file: rung.file,
        rung: rung.rung,
        person: Some(rung).filter(of(Verdict::Person)).map(|rung| notes(rung).join("; ")),
        conditions: Some(rung).filter(of(Verdict::Condition)).map(notes).unwrap_or_default(),
    };
    migration.rungs.iter().map(fate).collect()
}

/// The workspace.
pub(crate) fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The corpus, if it is here.
#[allow(dead_code)]
pub(crate) fn corpus() -> Option<PathBuf> {
    place::root()
}

/// Our own examples, and if asked for the programs of the corpus that must be proven, as far as they are here.
pub(crate) fn proven(with_corpus: bool) -> Vec<Migrated> {
    let own = ["motor/motor.SLC", "batch/batch.SLC", "traffic_light/traffic_light.SLC"];
    let mut paths: Vec<PathBuf> = own.iter().map(|path| root().join("examples").join(path)).collect();
    if !with_corpus {
        // Our own only.
    } else if let Some(corpus) = corpus() {
        paths.extend(CORPUS.iter().map(|path| corpus.join(path)));
    } else {
        println!("skipped: corpus not present");
    }
    let wanted = std::env::var("RUNGS_PROGRAM").unwrap_or_default();
    paths.retain(|path| path.to_string_lossy().contains(&wanted));
    paths.iter().map(|path| Migrated::of(path)).collect()
}

const CORPUS: [&str; 18] = [
    "PLC_traffic_light_rtc/TRAFFIC_LIGHT_6TON_orig.RSS",
    "PLC_traffic_light_rtc/traffic_light_6TON.RSS",
    "PLC_traffic_light_rtc/traffic_light_rtc.RSS",
    "PLC/TRAFFIC_LIGHT.RSS",
    "PLC/TRAFFIC_LIGHT_BAK017.RSS",
    "PLC/TRAFFIC_LIGHT_STOP.RSS",
    "PLC/TRAFFIC_LIGHT_STOP_BAK015.RSS",
    "PLC/TRAFFIC_LIGHT_SEQUENCER.RSS",
    "PLC/TRAFFIC_LIGHT_SEQUENCER_BAK017.RSS",
    "PLC_2s_lamp_flash/single_timer.RSS",
    "PLC_2s_lamp_flash/cascading_timers.RSS",
    "PLC_2s_lamp_flash/free_running_clock_bit_14.RSS",
    "PLC_2s_lamp_flash/rtc_bit_1.RSS",
    "PLC_2s_lamp_flash/sti_1000ms_live.RSS",
    "PLC_3_pump_sequencing/3_pump_sequencing.RSS",
    "PLC_reject_timing/lecky_demo.RSS",
    "PLC_reject_timing/lecky_demo_tof.RSS",
    "PLC_reject_timing/lecky_demo_tof_loop.RSS",
];
