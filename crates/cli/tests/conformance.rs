//! The conformance suite: every scenario under `conformance/` holds, and its page in docs is up to date.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use sim::scenario::Scenario;

/// What the suite must at least hold.
const LEAST: usize = 600;

/// Worked examples the suite is built around; sources name them by number.
const EXAMPLES: u32 = 135;

/// Tags of evidence and the documents they stand for.
const DOCUMENTS: &[(&str, &str)] = &[
    ("SLC", "SLC 500 Instruction Set Reference Manual, 1747-RM001G"),
    ("1100", "MicroLogix 1100 Instruction Set Reference Manual, 1763-RM001C"),
    ("1200", "MicroLogix 1200 and 1500 Instruction Set Reference Manual, 1762-RM001C, single pages"),
    ("1200UM", "MicroLogix 1200 User Manual, 1762-UM001D"),
    ("1500UM", "MicroLogix 1500 User Manual, 1764-UM001, chapter 5"),
    ("1400", "MicroLogix 1400 Instruction Set Reference Manual, 1766-RM001A"),
    ("1000", "MicroLogix 1000 User Manual"),
    ("HHP", "MicroLogix 1000 Hand-Held Programmer Manual, 1761-HHP-B30"),
    ("HHT", "Hand-Held Terminal Manual, 1747-NP002"),
    ("DTAM", "Data Table Access Module Manual, 1747-6.1, appendix B"),
    ("AI", "A.I. Series Software Reference, 9323-S5500D"),
    ("UM011", "SLC 500 Modular Hardware Manual, 1747-UM011G"),
    ("PLC5", "PLC-5 quick reference: a relative of these processors"),
    ("DMD", "Do-more Designer help: the topic of that number"),
    ("DMX", "exports that Do-more Designer wrote: operands, legs and use of the instruction"),
    ("PSU", "a university's course notes on sequencers"),
];

/// How good evidence is, best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Grade {
    Page,
    Recalled,
    Community,
    Inferred,
    Open,
}

const GRADES: [(Grade, &str); 5] = [
    (Grade::Page, "page"),
    (Grade::Recalled, "recalled"),
    (Grade::Community, "community"),
    (Grade::Inferred, "inferred"),
    (Grade::Open, "open"),
];

fn grade(source: &str) -> Option<Grade> {
    let tag = source.split([' ', ':']).next().unwrap_or("");
    match tag {
        "RCL" => Some(Grade::Recalled),
        "COM" => Some(Grade::Community),
        "INF" => Some(Grade::Inferred),
        "UNK" => Some(Grade::Open),
        _ => DOCUMENTS.iter().any(|row| row.0 == tag).then_some(Grade::Page),
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Folder, file and scenario, in order.
fn suite() -> Vec<(String, PathBuf, Scenario)> {
    let list = |folder: &Path| -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
        paths.sort();
        paths
    };
    let mut suite = Vec::new();
    let folders = |path: &Path| list(path).into_iter().filter(|path| path.is_dir()).collect::<Vec<_>>();
    let name = |path: &Path| path.file_name().expect("a name").to_string_lossy().into_owned();
    let mut subjects = Vec::new();
    for folder in folders(&root().join("conformance")) {
        // The other dialect has a folder of its own with one per subject.
        let inner = folders(&folder).into_iter().map(|inner| (format!("{}/{}", name(&folder), name(&inner)), inner));
        let before = subjects.len();
        subjects.extend(inner);
        if subjects.len() == before {
            subjects.push((name(&folder), folder));
        }
    }
    for (name, folder) in subjects {
        for path in list(&folder) {
            let text = std::fs::read_to_string(&path).expect("a readable file");
            let scenario = Scenario::parse(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            suite.push((name.clone(), path, scenario));
        }
    }
    suite
}

#[test]
fn every_scenario_holds() {
    let output = Command::new(env!("CARGO_BIN_EXE_rungs"))
        .args(["test", "--quiet"])
        .arg(root().join("conformance"))
        .output()
        .expect("the command runs");
    let report = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{report}{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn every_case_names_evidence_and_expects_something() {
    let suite = suite();
    assert!(suite.len() >= LEAST, "{} cases", suite.len());
    for (_, path, scenario) in &suite {
        let place = path.display();
        assert!(!scenario.name.is_empty(), "{place}: no name");
        assert!(!scenario.source.is_empty(), "{place}: no source");
        for source in &scenario.source {
            assert!(grade(source).is_some(), "{place}: `{source}` begins with no known tag");
        }
        let expects = scenario.steps.iter().any(|step| !step.expect.is_empty() || step.fault.is_some());
        let runs = scenario.steps.iter().any(|step| step.set.is_empty() || !step.expect.is_empty());
        assert!(expects || runs, "{place}: nothing is expected");
    }
}

/// The numbers a source names: `worked examples 7, 8 and 9`, `worked examples 1 to 4`.
fn examples(text: &str) -> BTreeSet<u32> {
    let mut found = BTreeSet::new();
    for (at, word) in text.match_indices("worked example") {
        let mut range = false;
        let list = text.get(at + word.len()..).unwrap_or("").trim_start_matches('s');
        for word in list.split([' ', ',']).filter(|word| !word.is_empty()) {
            match (word.trim_end_matches([':', ';', ')']).parse::<u32>(), word) {
                (Ok(number), _) => {
                    let first = if range { found.last().copied().unwrap_or(number) } else { number };
                    found.extend(first..=number);
                    if word.ends_with([':', ';', ')']) {
                        break;
                    }
                }
                (_, "and" | "to") => range = word == "to",
                _ => break,
            }
        }
    }
    found
}

#[test]
fn every_worked_example_has_a_case() {
    let sources = suite().into_iter().flat_map(|(_, _, scenario)| scenario.source);
    let named: BTreeSet<u32> = sources.flat_map(|source| examples(&source)).collect();
    let missing: Vec<u32> = (1..=EXAMPLES).filter(|number| !named.contains(number)).collect();
    assert!(missing.is_empty(), "no case names worked examples {missing:?}");
    assert!(named.last() <= Some(&EXAMPLES), "{named:?}");
}

#[test]
fn a_wrong_expectation_is_found() {
    let folder = std::env::temp_dir().join(format!("rungs-conformance-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("wrong.toml");
    let text = "name = \"wrong\"\nfamily = \"slc-5/03\"\nladder = \"ADD 20 N7:0 N7:1\"\n\
                [[step]]\nnote = \"add\"\nset = { \"N7:0\" = 22 }\nscans = 2\nexpect = { \"N7:1\" = 43 }\n";
    std::fs::write(&path, text).expect("a file");
    let output = Command::new(env!("CARGO_BIN_EXE_rungs")).arg("test").arg(&folder).output().expect("the command runs");
    std::fs::remove_dir_all(&folder).expect("removed");
    assert_eq!(output.status.code(), Some(1));
    let report = String::from_utf8_lossy(&output.stdout);
    assert!(report.contains("step 1 (add), scan 2, 0.010 s: N7:1 expected 43 (002Bh), found 42 (002Ah)"), "{report}");
}

#[test]
fn the_page_is_up_to_date() {
    let page = page(&suite());
    let path = root().join("docs/conformance.md");
    if std::env::var_os("RUNGS_BLESS").is_some() {
        std::fs::write(&path, &page).expect("docs can be written");
    }
    let stored = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(stored == page, "docs/conformance.md is stale: run this test with RUNGS_BLESS=1");
}

/// An instruction in capitals, any other subject as it is.
fn do_more(name: &str) -> String {
    let known = |part: &str| domore::instruction::by_mnemonic(part).is_some();
    if name.split('-').all(known) { name.to_uppercase().replace('-', ", ") } else { name.to_owned() }
}

fn page(suite: &[(String, PathBuf, Scenario)]) -> String {
    let mut text = String::from(
        "<!-- Written by `crates/cli/tests/conformance.rs`; run it with RUNGS_BLESS=1. -->\n\n# Conformance\n\n\
         What instructions do is held to the scenarios under `conformance/`: one file per case, run by\n\
         `rungs test conformance` and by the tests. Expectations come from what is written about these processors,\n\
         never from what the simulator prints. Every case names its evidence; a case with several counts by the best:\n\n\
         * **page**: a manual page that was seen;\n\
         * **recalled**: content of the manuals, or of the programming software's help, whose page was not seen;\n\
         * **community**: forums, courses, reports from the field;\n\
         * **inferred**: follows from statements of the other kinds;\n\
         * **open**: nothing is written; the case holds the reading taken, see [semantics-choices.md](semantics-choices.md).\n\n",
    );
    let mut groups: BTreeMap<&str, Vec<&Scenario>> = BTreeMap::new();
    for (folder, _, scenario) in suite {
        groups.entry(folder).or_default().push(scenario);
    }
    let best = |scenario: &&Scenario| scenario.source.iter().filter_map(|source| grade(source)).min();
    let count = |cases: &[&Scenario], wanted: Grade| cases.iter().filter(|case| best(case) == Some(wanted)).count();
    let all: Vec<&Scenario> = suite.iter().map(|row| &row.2).collect();
    let names = GRADES.map(|row| row.1).join(" | ");
    let _ = writeln!(text, "| subject | cases | {names} | pages |\n|---|---|---|---|---|---|---|---|");
    let cells = |cases: &[&Scenario]| GRADES.map(|row| count(cases, row.0).to_string()).join(" | ");
    for (name, cases) in &groups {
        let subject = match name.strip_prefix("domore/") {
            Some(name) => format!("Do-more: {}", do_more(name)),
            None if name.len() <= 3 => name.to_uppercase(),
            None => (*name).to_owned(),
        };
        let sources = cases.iter().flat_map(|case| &case.source).filter(|source| grade(source) == Some(Grade::Page));
        // What stands behind a colon or in parentheses explains; the page stands before it.
        let pages: BTreeSet<&str> =
            sources.map(|source| source.split([':', '(', ';']).next().unwrap_or(source).trim()).collect();
        let pages = pages.into_iter().collect::<Vec<_>>().join("; ");
        let _ = writeln!(text, "| {subject} | {} | {} | {pages} |", cases.len(), cells(cases));
    }
    let _ = writeln!(text, "| **all** | {} | {} | |", all.len(), cells(&all));
    text.push_str("\n## Documents\n\n| tag | document |\n|---|---|\n");
    for (tag, document) in DOCUMENTS {
        let _ = writeln!(text, "| {tag} | {document} |");
    }
    text
}
