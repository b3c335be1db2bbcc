//! Checks: what an experienced engineer would question in a program, each with a code.
//!
//! A [`Check`] is one row of a table in the module of its subject: code, severity, explanation and the
//! function that finds it. [`run`] applies a choice of them to an image; [`Rules`] and rung comments of the
//! form `rungs: allow OUT01` take findings out again, which are counted and never lost. A finding says what
//! stands in the program; whether it is wrong there is for a person to decide, so few are errors.

mod addressing;
mod configuration;
mod context;
mod counters;
mod documentation;
mod elements;
mod flow;
mod io;
mod logic;
mod math;
mod outputs;
mod suppress;
mod timers;

/// Note: worth knowing; warning: often wrong; error: the program cannot run so, or the instruction cannot do its work.
pub use ladder::Severity;
use ladder::{Documentation, Image};

use crate::location::Location;
pub(crate) use context::{Context, form as context_form};
pub use suppress::{Rule, Rules};

/// One check.
#[derive(Clone, Copy)]
pub struct Check {
    /// Three letters of its subject and two digits: `OUT01`. Never given to another check.
    pub code: &'static str,
    /// What is found, in a few words.
    pub title: &'static str,
    /// How much it matters.
    pub severity: Severity,
    /// It is among the checks that run when nobody chooses.
    pub default_on: bool,
    /// Why it matters and what to do about it.
    pub explanation: &'static str,
    find: fn(&Context<'_>, &mut Found),
}

impl std::fmt::Debug for Check {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.code)
    }
}

const SUBJECTS: &[(&str, &[Check])] = &[
    ("outputs", outputs::CHECKS),
    ("rung logic", logic::CHECKS),
    ("timers", timers::CHECKS),
    ("counters", counters::CHECKS),
    ("program flow", flow::CHECKS),
    ("math and compare", math::CHECKS),
    ("addressing", addressing::CHECKS),
    ("I/O and communication", io::CHECKS),
    ("documentation", documentation::CHECKS),
    ("configuration", configuration::CHECKS),
];

/// Every check, by subject.
pub fn all() -> impl Iterator<Item = &'static Check> {
    SUBJECTS.iter().flat_map(|(_, checks)| checks.iter())
}

/// The check with this code, upper or lower case.
pub fn by_code(code: &str) -> Option<&'static Check> {
    all().find(|check| check.code.eq_ignore_ascii_case(code))
}

/// The subject of a check in words.
pub fn subject(check: &Check) -> &'static str {
    SUBJECTS.iter().find(|(_, checks)| checks.iter().any(|one| one.code == check.code)).map_or("", |row| row.0)
}

/// Something a check found.
#[derive(Clone, Debug)]
pub struct Finding {
    /// Which check.
    pub check: &'static Check,
    /// The rungs it is about, the one to look at first. Empty when it is about the project.
    pub locations: Vec<Location>,
    /// Rungs beyond those in `locations`.
    pub left_out: usize,
    /// The address or name it is about; empty when there is none.
    pub address: String,
    /// What was found, in a sentence without its place.
    pub message: String,
}

/// A finding that a rule or a comment takes out.
#[derive(Clone, Debug)]
pub struct Suppressed {
    /// The finding.
    pub finding: Finding,
    /// The rule or comment.
    pub by: String,
}

/// What the checks found.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Errors first, then by place in the program.
    pub findings: Vec<Finding>,
    /// Findings taken out.
    pub suppressed: Vec<Suppressed>,
    /// Findings beyond [`MAX_FINDINGS`] of a check.
    pub not_listed: usize,
    /// The program has so many accesses that overlap that some checks did not look at all of them.
    pub incomplete: bool,
}

/// Findings listed of one check.
pub const MAX_FINDINGS: usize = 1_000;

/// Rungs listed of one finding.
const MAX_LOCATIONS: usize = 100;

/// Where checks put their findings.
pub(crate) struct Found {
    check: &'static Check,
    list: Vec<Finding>,
    not_listed: usize,
}

impl Found {
    /// Adds a finding; places are listed once each, in the order given.
    pub(crate) fn add(&mut self, locations: &[Location], address: impl ToString, message: impl Into<String>) {
        if self.list.len() >= MAX_FINDINGS {
            self.not_listed += 1;
            return;
        }
        let mut seen = std::collections::HashSet::new();
        let mut places: Vec<Location> =
            locations.iter().filter(|at| seen.insert((at.file, at.rung))).copied().collect();
        let left_out = places.len().saturating_sub(MAX_LOCATIONS);
        places.truncate(MAX_LOCATIONS);
        self.list.push(Finding {
            check: self.check,
            locations: places,
            left_out,
            address: address.to_string(),
            message: message.into(),
        });
    }
}

/// Applies the checks that `selected` answers for. `documentation` may be that of another image: the online
/// image has none of its own. `name` is the project's file name, for rules that are about one project.
pub fn run(
    image: &Image,
    documentation: &Documentation,
    name: &str,
    rules: &Rules,
    selected: impl Fn(&Check) -> bool,
) -> Report {
    let context = Context::new(image, documentation);
    let mut report = Report::default();
    let mut findings = Vec::new();
    for check in all().filter(|check| selected(check)) {
        let mut found = Found { check, list: Vec::new(), not_listed: 0 };
        (check.find)(&context, &mut found);
        report.not_listed += found.not_listed;
        findings.append(&mut found.list);
    }
    let comments = suppress::comments(image);
    for finding in findings {
        match rules.allow(&finding, name).or_else(|| suppress::in_comment(&comments, &finding)) {
            Some(by) => report.suppressed.push(Suppressed { finding, by }),
            None => report.findings.push(finding),
        }
    }
    report.findings.sort_by_key(|it| {
        (std::cmp::Reverse(it.check.severity), it.locations.is_empty(), it.locations.first().copied(), it.check.code)
    });
    report.incomplete = context.is_spent();
    report
}

/// Rungs in a sentence: `2:4, 2:9 and 3 more`.
pub(crate) fn rungs(locations: &[Location]) -> String {
    const SAID: usize = 6;
    let mut all: Vec<String> = Vec::new();
    for at in locations {
        let text = at.to_string();
        if !all.contains(&text) {
            all.push(text);
        }
        if all.len() > SAID {
            break;
        }
    }
    if all.len() > SAID {
        all.truncate(SAID);
        return format!("{} and more", all.join(", "));
    }
    all.join(", ")
}
