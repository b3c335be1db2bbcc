//! Every project of the corpus migrated: how many rungs hold, and that every result reads back, balances
//! and compiles, with no `STR` behind an output.

use std::collections::BTreeMap;
use std::path::Path;

use convert::from_rss;
use convert::migrate::{self, Options, Verdict};
use ladder::{Force, Source};

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod corpus;
mod migrate_support;

fn read(path: &Path) -> Option<ladder::Project> {
    let project = rss::Project::read(&std::fs::read(path).expect("file"), rss::Mode::Permissive).ok()?;
    Some(from_rss::project(&project, Source::default()))
}

/// Programs of which at least 90 % of the rungs have to hold, by a part of their path.
const NAMED: [&str; 13] = [
    "LANLOGIX_BR",
    "SW2012",
    "SW2014",
    "SW2084",
    "TVZ",
    "Water",
    "3_pump",
    "lowpass",
    "traffic_light_rtc",
    "PLC/TRAFFIC",
    "lamp_flash",
    "lecky",
    "rslogix500/",
];

#[test]
fn rungs_hold() {
    let Some(folder) = corpus::root() else { return };
    let files = corpus::files(&folder, ".rss").expect("the corpus can be listed");
    let mut reasons: BTreeMap<String, usize> = BTreeMap::new();
    let mut low = Vec::new();
    let mut table = Vec::new();
    for path in &files {
        let Some(project) = read(path) else { continue };
        let name = path.strip_prefix(&folder).unwrap_or(path).display().to_string();
        let before = std::time::Instant::now();
        let migration = match migrate::migrate(&project.main, &[], &Options::default()) {
            Ok(migration) => migration,
            Err(error) => panic!("{name}: {error}"),
        };
        let took = before.elapsed();
        let rungs = project.main.ladder_files().flat_map(|file| &file.rungs).filter(|rung| !rung.is_end()).count();
        assert_eq!(migration.rungs.len(), rungs, "{name}: a rung is lost");
        let behind = migrate_support::pushes_behind_outputs(&migration.project);
        assert!(behind.is_empty(), "{name}: STR behind an output: {behind:#?}");
        let text = domore::text::write(&migration.project);
        let reading = domore::text::read(&text).expect("text");
        assert!(reading.diagnostics.is_empty(), "{name}: {:?}", reading.diagnostics.first());
        let balance = domore::stack::check_project(&reading.project);
        assert!(balance.is_empty(), "{name}: {:?}", balance.first());
        if let Err(refusals) = domore::engine::Program::compile(&reading.project, &domore::engine::Options::default()) {
            println!("{name}: {} refusals, first {}", refusals.len(), refusals.first().expect("one"));
        }
        for rung in &migration.rungs {
            if rung.verdict == Verdict::Person {
                for note in &rung.notes {
                    let text: String = note.text.chars().filter(|c| !c.is_ascii_digit()).collect();
                    *reasons.entry(format!("{} {text}", note.mark)).or_default() += 1;
                }
            }
        }
        let [exact, condition, person] =
            [Verdict::Exact, Verdict::Condition, Verdict::Person].map(|verdict| migration.count(verdict));
        let held = 100.0 * (exact + condition) as f64 / rungs.max(1) as f64;
        let named = NAMED.iter().any(|part| name.contains(part));
        // `RUNGS_SHOW`, a part of a path, prints what is not exact.
        if std::env::var("RUNGS_SHOW").is_ok_and(|part| name.contains(&part)) {
            for rung in migration.rungs.iter().filter(|rung| rung.verdict != Verdict::Exact) {
                println!("{}:{} {:?}\n   {}", rung.file, rung.rung, rung.notes, rung.original);
            }
        }
        table.push(format!(
            "{held:5.1} % {exact:5} exact {condition:4} condition {person:4} person {:4} ms {name}",
            took.as_millis()
        ));
        if named && held < 90.0 && rungs > 0 {
            low.push(name);
        }
    }
    table.sort();
    for row in &table {
        println!("{row}");
    }
    let mut reasons: Vec<_> = reasons.into_iter().collect();
    reasons.sort_by_key(|reason| std::cmp::Reverse(reason.1));
    for (reason, count) in reasons.iter().take(60) {
        println!("{count:6} {reason}");
    }
    assert!(low.is_empty(), "below 90 %: {low:#?}");
}

/// What tells the machines of the plant archive apart: name and family of the processor, as many are called
/// `UNTITLED`, and the name of the file without the number RSLogix gives its backups.
fn machine(project: &ladder::Project, path: &Path) -> (String, &'static str, String) {
    let processor = &project.main.processor;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().to_ascii_uppercase();
    let name = stem.find("_BAK").map_or(stem.as_str(), |at| stem.get(..at).unwrap_or(""));
    (processor.project_name.trim().to_owned(), processor.family.id(), name.to_owned())
}

#[test]
fn newest_saves_of_the_plant_archive_hold() {
    let Some(folder) = corpus::root() else { return };
    let files = corpus::files(&folder.join("rslogix500"), ".rss").expect("the archive can be listed");
    let mut newest: BTreeMap<_, (String, ladder::Project)> = BTreeMap::new();
    for path in &files {
        let Some(project) = read(path) else { continue };
        let saved = project.source.saved_at.clone().unwrap_or_default();
        let key = machine(&project, path);
        if newest.get(&key).is_none_or(|known| known.0 < saved) {
            newest.insert(key, (saved, project));
        }
    }
    let mut families: BTreeMap<&str, [usize; 6]> = BTreeMap::new();
    println!("  held  rungs  exact condition person  last save             machine");
    for ((name, family, stem), (saved, project)) in &newest {
        let migration = migrate::migrate(&project.main, &[], &Options::default()).expect("it migrates");
        let rungs = migration.rungs.len();
        let [exact, condition, person] =
            [Verdict::Exact, Verdict::Condition, Verdict::Person].map(|verdict| migration.count(verdict));
        let held = 100.0 * (exact + condition) as f64 / rungs.max(1) as f64;
        println!("{held:5.1} % {rungs:6} {exact:6} {condition:9} {person:6}  {saved}  {name}, {family}, {stem}");
        assert!(held >= 90.0 || rungs == 0, "{name}, {family}, {stem}: {held:.1} %");
        assert!(migration.rungs.iter().all(|rung| rung.verdict == Verdict::Exact || !rung.notes.is_empty()));
        // One save has no rungs at all.
        let least = if rungs == 0 { 1000 } else { (10.0 * held) as usize };
        let row = families.entry(family).or_insert([0, 0, 0, 0, 0, 1000]);
        for (total, more) in row.iter_mut().zip([1, rungs, exact, condition, person]) {
            *total += more;
        }
        row[5] = row[5].min(least);
    }
    println!("{} machines", newest.len());
    for (family, [machines, rungs, exact, condition, person, least]) in &families {
        let share = |part: usize| 100.0 * part as f64 / (*rungs).max(1) as f64;
        println!(
            "| {family} | {machines} | {rungs} | {:.1} % | {:.1} % | {:.1} % | {:.1} % |",
            share(*exact),
            share(*condition),
            share(*person),
            *least as f64 / 10.0
        );
    }
    assert!(newest.len() > 50);
}

/// Scans of each program beside what it was migrated to.
const SCANS: usize = 60;

#[test]
fn programs_stay_equal() {
    let Some(folder) = corpus::root() else { return };
    let files = corpus::files(&folder, ".rss").expect("the corpus can be listed");
    let (mut ran, mut differ) = (0, Vec::new());
    for path in &files {
        let Some(project) = read(path) else { continue };
        let name = path.strip_prefix(&folder).unwrap_or(path).display().to_string();
        let migration = migrate::migrate(&project.main, &[], &Options::default()).expect("it migrates");
        // Forces are the original's alone.
        let forced = project.main.data_files.iter().flat_map(|file| &file.forces).any(|force| *force != Force::NONE);
        if migration.count(Verdict::Person) > 0 || migration.rungs.is_empty() || forced {
            continue;
        }
        let Ok(mut both) = migrate_support::Both::with(&project.main, migration) else { continue };
        let mut dice = migrate_support::dice::Dice(0x5EED | 1);
        both.set_clocks();
        both.enter_run();
        for scan in 0..SCANS {
            for word in 0..both.input_words() {
                both.input(word, dice.next() as u16 & dice.next() as u16);
            }
            if scan == SCANS / 2 {
                both.stop();
                both.enter_run();
            }
            let steps = [0, 1, 7, 10, 13, 30, 250, 1000];
            let step = steps.get(dice.below(steps.len() as u64) as usize).copied().unwrap_or(1);
            if let Some(difference) = both.scan(std::time::Duration::from_millis(step)) {
                differ.push(format!("{name}: {difference}"));
                break;
            }
            if !both.running() {
                break;
            }
        }
        ran += 1;
    }
    println!("{ran} programs ran {SCANS} scans beside what they were migrated to, {} differ", differ.len());
    for difference in &differ {
        println!("{difference}");
    }
    assert!(ran > 100, "only {ran} programs ran");
    assert!(differ.is_empty(), "{} programs differ", differ.len());
}

#[test]
fn a_map_that_is_passed_back_changes_nothing() {
    let Some(folder) = corpus::root() else { return };
    let files = corpus::files(&folder, ".rss").expect("the corpus can be listed");
    let mut rows = 0;
    for path in &files {
        let Some(project) = read(path) else { continue };
        let name = path.display();
        let first = migrate::migrate(&project.main, &[], &Options::default()).expect("it migrates");
        let text = migrate::map_file::write(&first.map);
        let map = migrate::map_file::read(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        rows += map.len();
        let second = migrate::migrate(&project.main, &map, &Options::default());
        let second = second.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(second.map, first.map, "{name}");
        assert!(domore::text::write(&second.project) == domore::text::write(&first.project), "{name}");
    }
    println!("{rows} rows");
}

/// Every word Designer's exports or an import on hardware show: instructions that are no contacts.
const SHOWN: &str = "NOT ANDSTR ORSTR DUPBOOL POPBOOL OUT SET RST RSTR PD ND TMR TMRDOWN ONDTMR OFFDTMR CNT CNTDN UDC MOVE MATH COPY \
    INIT MEMCOPY STRCLEAR STRPRINT SCALE CLAMP FILTER FLASHER DEBOUNCE TIMEDOUT INC CALL RET RUN SUSPEND JMP SG FOR NEXT REPEAT UNTIL NOP";

/// Endings of STR, AND and OR in exports.
const TESTS: [&str; 11] = ["", "N", "PD", "ND", "DLT", "E", "NE", "GT", "GE", "LT", "LE"];

/// What an instruction uses that neither exports nor the vendor's help nor a public generator of such texts shows.
fn never_shown(instruction: &domore::Instruction) -> Vec<String> {
    let (name, mut found) = (instruction.mnemonic.as_str(), Vec::new());
    let contact = ["STR", "AND", "OR"].iter().filter_map(|family| name.strip_prefix(family));
    if !contact.into_iter().any(|ending| TESTS.contains(&ending)) && !SHOWN.split(' ').any(|shown| shown == name) {
        found.push(name.to_owned());
    }
    if name == "CALL" && instruction.operands.get(1..).unwrap_or_default() != ["0x0", "DST511", "\"3\"", "\"3\""] {
        found.push(instruction.to_string());
    }
    for operand in &instruction.operands {
        if !operand.starts_with('"') {
            let cast = operand.split_once(':').map_or("", |(_, cast)| cast);
            if operand.contains('[') || cast.starts_with('S') && cast != "SD" {
                found.push(operand.clone());
            }
            continue;
        }
        if name != "MATH" {
            continue;
        }
        let (mut word, mut rest) = (String::new(), operand.as_str());
        while let Some(c) = rest.chars().next() {
            let sign = ["<<", ">>", ">=", "<=", "!=", "**", "&&", "||", "^", "~", "!"]
                .iter()
                .find(|sign| rest.starts_with(**sign));
            found.extend(sign.filter(|sign| !matches!(**sign, "<<" | ">>")).map(|sign| (*sign).to_owned()));
            let known = ["", "IF", "ROUND", "TRUNC", "FRAC", "ABS", "TOREAL", "AVGR"];
            if c == '(' && !known.contains(&word.as_str()) {
                found.push(word.clone());
            }
            word = if c.is_ascii_alphanumeric() { word + &c.to_string() } else { String::new() };
            rest = rest.get(sign.map_or(c.len_utf8(), |sign| sign.len())..).unwrap_or("");
        }
    }
    found
}

#[test]
fn what_was_never_shown_is_seen() {
    for (text, expected) in [
        ("STRGE CT0.Acc 5", 0),
        ("CALL Sub 0x0 DST511 \"3\" \"3\"", 0),
        ("CALL Sub 0x1 DST511 \"3\" \"3\"", 1),
        ("MATH N0 \"IF(N1 > 3, (N2 & 15) << 2, ABS(N3))\"", 0),
        ("MATH N0 \"IF(N1 >= 3, SQRT(N2 ^ 1), 0)\"", 3),
        ("MOVE N[D0] N1", 1),
        ("MOVE C0:SW V84:SD", 1),
        ("TMRAG T0 5", 1),
        ("ANDPDPF", 1),
        ("HALT $Main", 1),
    ] {
        let text = format!("$PRGRM $Main\n\n{text}\n\n$PGMEND $Main\n");
        let project = domore::text::read(&text).expect("text").project;
        let instruction = project.code_blocks().next().expect("a block").rungs[0].instructions[0].clone();
        assert_eq!(never_shown(&instruction).len(), expected, "{text}: {:?}", never_shown(&instruction));
    }
}

#[test]
fn only_confirmed_forms_are_used_when_asked_for() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut files = corpus::files(&examples, ".rss").expect("the examples can be listed");
    assert!(files.len() >= 3);
    if let Some(folder) = corpus::root() {
        files.extend(corpus::files(&folder, ".rss").expect("the corpus can be listed"));
    }
    let mut found: BTreeMap<(String, &str), usize> = BTreeMap::new();
    let mut never: BTreeMap<String, String> = BTreeMap::new();
    let (mut rungs, mut persons) = (0, 0);
    for path in &files {
        let Some(project) = read(path) else { continue };
        let options = Options { only_confirmed: true };
        let migration = migrate::migrate(&project.main, &[], &options).expect("it migrates");
        let behind = migrate_support::pushes_behind_outputs(&migration.project);
        assert!(behind.is_empty(), "STR behind an output: {behind:#?}");
        rungs += migration.rungs.len();
        persons += migration.count(Verdict::Person);
        for form in migrate::forms::unconfirmed(&migration.project) {
            *found.entry((form.form, form.evidence)).or_default() += form.uses;
        }
        // What is written, looked at without the list the report is made from.
        let written = domore::text::read(&domore::text::write(&migration.project)).expect("text").project;
        for instruction in written.code_blocks().flat_map(|block| &block.rungs).flat_map(|rung| &rung.instructions) {
            for form in never_shown(instruction) {
                never.entry(form).or_insert_with(|| format!("{}: {instruction}", path.display()));
            }
        }
    }
    println!("{rungs} rungs, {persons} need a person");
    println!("{found:#?}");
    let inferred: Vec<_> =
        found.keys().filter(|(_, evidence)| matches!(*evidence, "inferred" | "third-party")).collect();
    assert!(inferred.is_empty(), "{inferred:?}");
    assert!(never.is_empty(), "{never:#?}");
}
