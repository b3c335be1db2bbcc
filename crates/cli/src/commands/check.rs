//! `rungs check`: what an experienced engineer would question, with codes.

use std::collections::HashSet;
use std::io::{IsTerminal, Write};
use std::path::Path;

use analysis::Location;
use analysis::checks::{self, Check, Finding, Report, Rules, Severity};
use serde_json::{Value, json};

use super::{Opened, each_dialect, file_name, read_file, write_json};
use crate::args::{CheckArguments, CheckLevel};
use crate::output::{Error, Outcome, Printable, printable};

/// Suppression file looked for beside a project.
const RULES: &str = ".rungs-check.toml";
/// Bytes of a suppression file that are read.
const MOST_RULES: usize = 1 << 20;

pub fn run(arguments: &CheckArguments) -> Result<Outcome, Error> {
    if let Some(code) = &arguments.explain {
        return explain(code);
    }
    for code in arguments.only.iter().chain(&arguments.skip) {
        if !checks::all().any(|check| is_named(check, code)) {
            return Err(Error::Use(format!("there is no check `{code}`; see docs/checks.md for all codes")));
        }
    }
    let given = match &arguments.suppress {
        Some(path) => read_rules(path)?,
        None => Rules::default(),
    };
    let lowest = match arguments.level {
        CheckLevel::Error => Severity::Error,
        CheckLevel::Warning => Severity::Warning,
        CheckLevel::Note => Severity::Note,
    };
    let selected = |check: &Check| {
        let named = |codes: &[String]| codes.iter().any(|code| is_named(check, code));
        let on = if arguments.only.is_empty() { check.default_on } else { named(&arguments.only) };
        on && !named(&arguments.skip) && check.severity >= lowest
    };
    let style = super::drawing_style(None);
    let slc = |opened: &Opened, out: &mut dyn Write| {
        let mut rules = given.clone();
        let beside = opened.path.parent().unwrap_or(Path::new("")).join(RULES);
        if beside.is_file() {
            rules.extend(read_rules(&beside)?);
        }
        let name = file_name(&opened.path);
        let report = checks::run(opened.image(), opened.documentation(), &name, &rules, selected);
        if arguments.input.json {
            write_json(opened, describe(opened, &report), out)?;
        } else {
            print(opened, &report, (!arguments.no_draw).then_some(&style), out)?;
        }
        let failed = report.findings.iter().any(|it| it.check.severity == Severity::Error);
        Ok(if failed { Outcome::Finding } else { Outcome::Done })
    };
    each_dialect(&arguments.files, &arguments.input, slc, |opened, out| {
        let why = "the checks are about programs of RSLogix 500; of a Do-more program `rungs verify` checks every rung and \
                   `rungs xref --findings` lists what is only read or only written";
        if arguments.input.json {
            opened.write_json(json!({"file": opened.name(), "error": why}), out)?;
        }
        let message = printable(&format!("{}: {why}", opened.name()));
        if arguments.files.contains(&opened.path) {
            return Err(Error::Use(message));
        }
        // Found in a folder beside others.
        eprintln!("{message}");
        Ok(Outcome::Done)
    })
}

/// By its code, or by the letters of its subject.
fn is_named(check: &Check, code: &str) -> bool {
    code.eq_ignore_ascii_case(check.code)
        || check.code.get(..3).is_some_and(|subject| code.eq_ignore_ascii_case(subject))
}

fn read_rules(path: &Path) -> Result<Rules, Error> {
    let bytes = read_file(path, MOST_RULES).map_err(|why| Error::Use(format!("{}: {why}", path.display())))?;
    let text = String::from_utf8_lossy(&bytes);
    Rules::parse(&text).map_err(|why| Error::Use(format!("{}: {why}", path.display())))
}

fn explain(code: &str) -> Result<Outcome, Error> {
    let Some(check) = checks::by_code(code) else {
        return Err(Error::Use(format!("there is no check `{code}`; see docs/checks.md for all codes")));
    };
    let mut out = std::io::stdout().lock();
    let on = if check.default_on { "on by default" } else { "off by default, run with --only" };
    writeln!(out, "{}  {}", check.code, check.title)?;
    writeln!(out, "{}, {}, {on}\n", check.severity.as_str(), checks::subject(check))?;
    let mut line = String::new();
    for word in check.explanation.split_whitespace() {
        if !line.is_empty() && line.len() + 1 + word.len() > 90 {
            writeln!(out, "{line}")?;
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    writeln!(out, "{line}")?;
    Ok(Outcome::Done)
}

fn print(opened: &Opened, report: &Report, style: Option<&render::Style>, out: &mut dyn Write) -> Result<(), Error> {
    writeln!(Printable(&mut *out), "{}: {}", opened.title(), summary(report))?;
    if report.incomplete {
        writeln!(out, "  so many accesses overlap that not all of them were looked at")?;
    }
    let mut drawn: HashSet<(u16, u32)> = HashSet::new();
    for finding in &report.findings {
        let severity = finding.check.severity.as_str();
        let place = finding.locations.first().map_or_else(|| "-".to_owned(), Location::to_string);
        let (code, message) = (finding.check.code, &finding.message);
        writeln!(Printable(&mut *out), "\n{severity:7}  {code}  {place:>6}  {message}")?;
        if let (Some(style), Some(at)) = (style, finding.locations.first()) {
            if drawn.insert((at.file, at.rung)) {
                super::draw_rung(opened, *at, style, out)?;
            } else {
                writeln!(out, "         (rung {at} is drawn above)")?;
            }
        }
    }
    writeln!(out)?;
    Ok(())
}

fn count(report: &Report, severity: Severity) -> usize {
    report.findings.iter().filter(|it| it.check.severity == severity).count()
}

/// `1 error, 2 warnings, 5 notes, 1 suppressed`.
fn summary(report: &Report) -> String {
    let number = |count: usize, word: &str| format!("{count} {word}{}", if count == 1 { "" } else { "s" });
    let mut parts: Vec<String> = [Severity::Error, Severity::Warning, Severity::Note]
        .into_iter()
        .map(|severity| number(count(report, severity), severity.as_str()))
        .collect();
    if !report.suppressed.is_empty() {
        parts.push(format!("{} suppressed", report.suppressed.len()));
    }
    if report.not_listed > 0 {
        parts.push(format!("{} more not listed", report.not_listed));
    }
    parts.join(", ")
}

fn describe(opened: &Opened, report: &Report) -> Value {
    let suppressed = report.suppressed.iter().map(|it| {
        let mut row = finding_json(&it.finding);
        row["by"] = it.by.clone().into();
        row
    });
    json!({
        "file": opened.path.display().to_string(),
        "counts": {
            "error": count(report, Severity::Error),
            "warning": count(report, Severity::Warning),
            "note": count(report, Severity::Note),
            "suppressed": report.suppressed.len(),
            "not_listed": report.not_listed,
        },
        "incomplete": report.incomplete,
        "findings": report.findings.iter().map(finding_json).collect::<Value>(),
        "suppressed": suppressed.collect::<Value>(),
    })
}

fn finding_json(finding: &Finding) -> Value {
    json!({
        "code": finding.check.code,
        "severity": finding.check.severity.as_str(),
        "title": finding.check.title,
        "address": finding.address,
        "message": finding.message,
        "rungs": finding.locations.iter().map(|at| json!({"file": at.file, "rung": at.rung})).collect::<Value>(),
        "left_out": finding.left_out,
    })
}

/// Colour only where somebody sees it.
pub(super) fn is_coloured() -> bool {
    std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
