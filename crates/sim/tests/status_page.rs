//! The simulator's part of `docs/status.md`: how every instruction of the table runs, written from what
//! compiling says, so that it cannot differ from what the simulator does.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use ladder::{Family, Rung};
use sim::scenario::{Scenario, Subject, Target};
use sim::{Options, Program, Unsupported, inline_image};

/// Instructions that stand in no scenario of the suite: an example of each.
const EXAMPLES: &[(Family, &str)] = &[
    (Family::Slc503, "BTR 0 0 0 R6:0 N7:0"),
    (Family::Slc503, "BTW 0 0 0 R6:0 N7:0"),
    (Family::Slc503, "CEM N7:0 40 0"),
    (Family::Slc503, "DEM N7:0 40 0"),
    (Family::Slc505, "EEM N7:0 40 0"),
    (Family::MicroLogix1400, "DLG 0"),
    (Family::SlcFixed, "HSC C5:0 100 0"),
    (Family::MicroLogix1000, "HSD C5:0"),
    (Family::MicroLogix1000, "HSE C5:0"),
    (Family::MicroLogix1400, "LCD N7:0 N7:1 N7:2 N7:3 N7:4 N7:5 0"),
    (Family::MicroLogix1400, "RCP RCP:0 0 0"),
    (Family::Slc503, "RMP N7:0 N7:10"),
    (Family::Slc503, "RPC 0 N7:0"),
];

/// Forms that run in another way than those of the cases.
const OTHER_FORMS: &[(Family, &str)] = &[(Family::MicroLogix1000, "HSL C5:0 N7:0 5")];

const BEGIN: &str = "<!-- simulator: written by `crates/sim/tests/status_page.rs`; run it with RUNGS_BLESS=1 -->\n";
const END: &str = "<!-- simulator end -->\n";

/// How one instruction runs.
#[derive(Default)]
struct Seen {
    /// It stands in a scenario of the suite.
    case: bool,
    /// Reasons why it is only approximated, over all processors.
    approximate: BTreeSet<String>,
    /// Reasons why it is refused.
    refused: BTreeSet<String>,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn scenarios(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<_> = std::fs::read_dir(folder).expect("folder").flatten().map(|entry| entry.path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            scenarios(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "toml") {
            found.push(path);
        }
    }
}

/// Compiles a ladder and notes what is said about each of its instructions.
fn look(family: Family, files: Vec<(u16, Vec<Rung>)>, seen: &mut BTreeMap<&'static str, Seen>, case: bool) {
    let used: BTreeSet<&str> = files
        .iter()
        .flat_map(|file| &file.1)
        .flat_map(|rung| rung.instructions())
        .filter_map(|instruction| Some(instr::by_mnemonic(instruction.mnemonic.name()?)?.mnemonic))
        .collect();
    for mnemonic in used {
        seen.entry(mnemonic).or_default().case |= case;
    }
    let image = inline_image(family, files);
    let name = |text: &str| instr::by_mnemonic(text.split(' ').next().unwrap_or("")).map(|entry| entry.mnemonic);
    let options = Options { inline: true, ..Options::default() };
    let refusals = Program::compile(&image, &options).err().unwrap_or_default();
    for refusal in refusals {
        if let Some(mnemonic) = refusal.site.as_ref().and_then(|site| name(&site.text)) {
            seen.entry(mnemonic).or_default().refused.insert(refusal.why);
        }
    }
    let options = Options { unsupported: Unsupported::Fault, ..options };
    let Ok(program) = Program::compile(&image, &options) else { return };
    for approximation in program.approximations() {
        let mnemonic = approximation.site.as_ref().and_then(|site| name(&site.text));
        // A program for another processor says nothing about the instruction.
        let elsewhere = approximation.why.ends_with("it runs as on those that have it");
        if let Some(mnemonic) = mnemonic.filter(|_| !elsewhere) {
            let seen = seen.entry(mnemonic).or_default();
            if !seen.refused.iter().any(|why| approximation.why.contains(why)) {
                seen.approximate.insert(approximation.why.clone());
            }
        }
    }
}

fn rungs(text: &str, family: Family) -> Option<Vec<Rung>> {
    convert::slc::rung::parse_rungs(text, Some(family)).ok()
}

fn section() -> String {
    let mut seen: BTreeMap<&'static str, Seen> = instr::all().iter().map(|i| (i.mnemonic, Seen::default())).collect();
    let mut files = Vec::new();
    scenarios(&root().join("conformance"), &mut files);
    for path in files {
        let text = std::fs::read_to_string(&path).expect("a scenario");
        let scenario = Scenario::parse(&text).expect("a scenario");
        let (Subject::Inline(routines), Some(Target::Slc(family))) = (scenario.program, scenario.target) else {
            continue;
        };
        let files =
            routines.iter().map(|routine| Some((routine.name.value.parse().ok()?, rungs(&routine.text, family)?)));
        if let Some(files) = files.collect::<Option<Vec<_>>>() {
            look(family, files, &mut seen, true);
        }
        // END stands in every program; its cases are those in its folder.
        if path.parent().is_some_and(|folder| folder.ends_with("end"))
            && let Some(seen) = seen.get_mut("END")
        {
            seen.case = true;
        }
    }
    for (family, text) in OTHER_FORMS {
        let rungs = rungs(text, *family).unwrap_or_else(|| panic!("{text} is no ladder"));
        look(*family, vec![(2, rungs)], &mut seen, false);
    }
    for (family, text) in EXAMPLES {
        let rungs = rungs(text, *family).unwrap_or_else(|| panic!("{text} is no ladder"));
        let mut alone = BTreeMap::new();
        look(*family, vec![(2, rungs)], &mut alone, false);
        for (mnemonic, new) in alone {
            let seen = seen.entry(mnemonic).or_default();
            assert!(!seen.case || !text.starts_with(mnemonic), "{mnemonic} has cases and needs no example");
            seen.approximate.extend(new.approximate);
            seen.refused.extend(new.refused);
        }
    }
    let examples: BTreeSet<&str> =
        EXAMPLES.iter().filter_map(|row| row.1.split(' ').find(|word| seen.contains_key(word))).collect();
    let unseen: Vec<_> = seen.iter().filter(|row| !row.1.case && !examples.contains(row.0)).map(|row| row.0).collect();
    assert!(unseen.is_empty(), "no case and no example: {unseen:?}");
    page(&seen)
}

fn page(seen: &BTreeMap<&'static str, Seen>) -> String {
    let (odd, plain): (Vec<_>, Vec<_>) =
        seen.iter().partition(|row| !row.1.approximate.is_empty() || !row.1.refused.is_empty());
    let name = |(mnemonic, seen): &(&&str, &Seen)| match seen.case {
        true => mnemonic.to_string(),
        false => format!("{mnemonic} (no case)"),
    };
    let mut page = format!(
        "\nRun as described in [instructions.md](instructions.md) ({}):\n\n{}.\n\n\
         | instruction | in conformance cases | how it runs | why |\n|---|---|---|---|\n",
        plain.len(),
        plain.iter().map(name).collect::<Vec<_>>().join(", ")
    );
    for (mnemonic, seen) in odd {
        let case = if seen.case { "yes" } else { "no" };
        for (how, reasons) in [("approximated", &seen.approximate), ("refused", &seen.refused)] {
            for why in reasons {
                page.push_str(&format!("| {mnemonic} | {case} | {how} | {why} |\n"));
            }
        }
    }
    page.push('\n');
    page
}

#[test]
fn the_status_of_every_instruction_is_current() {
    let path = root().join("docs/status.md");
    let text = std::fs::read_to_string(&path).expect("docs/status.md");
    let (before, rest) = text.split_once(BEGIN).expect("the beginning of the simulator's part");
    let (_, after) = rest.split_once(END).expect("the end of the simulator's part");
    let wanted = format!("{before}{BEGIN}{}{END}{after}", section());
    if std::env::var_os("RUNGS_BLESS").is_some() {
        std::fs::write(&path, &wanted).expect("docs/status.md can be written");
    } else {
        assert!(text == wanted, "docs/status.md is old: run this test with RUNGS_BLESS=1");
    }
}
