//! `docs/checks.md` holds every check as it is, with how often it finds something in real projects.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

use analysis::checks::{self, Check, Rules};
use ladder::Source;
use rss::Mode;

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod corpus;

/// Set to write the page anew.
const WRITE: &str = "RUNGS_WRITE_DOCS";
/// Where the generated part of the page begins.
const MARK: &str = "<!-- generated: the checks, from here to the end -->\n";

/// Findings, and projects with a finding.
#[derive(Default, Clone, Copy)]
struct Count {
    findings: usize,
    projects: usize,
}

/// Counts per check over the main images, and the number of different projects.
fn counts() -> Option<(BTreeMap<&'static str, Count>, usize)> {
    let root = corpus::root()?;
    let mut counts: BTreeMap<&str, Count> = BTreeMap::new();
    let mut projects = BTreeSet::new();
    for path in corpus::files(&root, ".rss").expect("the corpus can be listed") {
        let bytes = std::fs::read(&path).expect("readable");
        // Copies of one file count once.
        if !projects.insert(bytes.clone()) {
            continue;
        }
        let Ok(file) = rss::Project::read(&bytes, Mode::Permissive) else {
            projects.remove(&bytes);
            continue;
        };
        let project = convert::from_rss::project(&file, Source::default());
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let image = &project.main;
        let report = checks::run(image, &image.documentation, &name, &Rules::default(), |_| true);
        assert!(!report.incomplete && report.not_listed == 0, "{name}");
        let mut met = BTreeSet::new();
        for finding in report.findings.iter().chain(report.suppressed.iter().map(|it| &it.finding)) {
            let count = counts.entry(finding.check.code).or_default();
            count.findings += 1;
            count.projects += usize::from(met.insert(finding.check.code));
            if std::env::var("RUNGS_SHOW").is_ok_and(|code| code == finding.check.code) {
                let place = finding.locations.first().map(ToString::to_string).unwrap_or_default();
                println!("{name} {place} {}", finding.message);
            }
        }
    }
    (!projects.is_empty()).then_some((counts, projects.len()))
}

fn kind(check: &Check) -> String {
    format!("{}{}", check.severity.as_str(), if check.default_on { "" } else { ", off" })
}

/// The generated part of the page; counts are kept out of it where there is no corpus.
fn page(counts: &BTreeMap<&'static str, Count>, projects: usize) -> String {
    let mut text = format!(
        "\n## The checks\n\nFound in: findings and, after the slash, projects with one, of the {projects} different projects \
         with all checks on. `off` checks run when they are named with `--only`.\n\n| code | what | level | found in |\n|---|---|---|---|\n"
    );
    for check in checks::all() {
        let count = counts.get(check.code).copied().unwrap_or_default();
        let (findings, projects) = (count.findings, count.projects);
        writeln!(text, "| {} | {} | {} | {findings} / {projects} |", check.code, check.title, kind(check))
            .expect("text");
    }
    for check in checks::all() {
        let subject = checks::subject(check);
        write!(text, "\n### {}: {}\n\n{} ({subject}). {}\n", check.code, check.title, kind(check), check.explanation)
            .expect("text");
    }
    text
}

/// The page without its counts.
fn without_counts(page: &str) -> String {
    let cut = |line: &str| match line.starts_with("| ").then(|| line.rsplitn(3, '|').nth(2)).flatten() {
        Some(row) => row.to_owned(),
        None => line.to_owned(),
    };
    page.lines().filter(|line| !line.starts_with("Found in: ")).map(cut).collect::<Vec<_>>().join("\n")
}

#[test]
fn the_page_is_what_the_table_says() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/checks.md");
    let stored = std::fs::read_to_string(&path).expect("docs/checks.md");
    let (head, generated) = stored.split_once(MARK).expect("the mark");
    let Some((counts, projects)) = counts() else {
        assert_eq!(without_counts(generated), without_counts(&page(&BTreeMap::new(), 0)));
        return;
    };
    let made = page(&counts, projects);
    if std::env::var_os(WRITE).is_some() {
        std::fs::write(&path, format!("{head}{MARK}{made}")).expect("written");
        return;
    }
    assert!(generated == made, "docs/checks.md is not current: run this test with {WRITE}=1");
}
