//! `rungs xref`: who reads, who writes.

use std::io::Write;

use analysis::{Access, CallGraph, CrossReference, Finding, Found, Group, Target};
use ladder::Address;
use serde::Serialize;
use serde_json::{Value, json};

use super::{Opened, diagnostics_json, domore, each_dialect, one_line, places};
use crate::args::XrefArguments;
use crate::files;
use crate::output::{Columns, Error, Outcome, Printable};

pub fn run(arguments: &XrefArguments) -> Result<Outcome, Error> {
    let (paths, wanted) = files::split(&arguments.files);
    let slc = |opened: &Opened, out: &mut dyn Write| {
        let xref = CrossReference::build(opened.image(), opened.documentation());
        let calls = CallGraph::build(opened.image(), opened.documentation());
        let mut report =
            Report { opened, xref: &xref, calls: &calls, groups: None, calls_asked: Vec::new(), unknown: Vec::new() };
        if !wanted.is_empty() {
            report.groups = Some(Vec::new());
            wanted.iter().for_each(|text| report.find(text));
        }
        if arguments.input.json {
            report.describe(arguments.findings, out)?;
        } else {
            report.print(arguments.findings, &mut Printable(out))?;
        }
        for text in &report.unknown {
            eprintln!("{}: `{text}` is no address, symbol or data file of this program", opened.path.display());
        }
        Ok(if report.unknown.is_empty() { Outcome::Done } else { Outcome::Finding })
    };
    each_dialect(&paths, &arguments.input, slc, |opened, out| {
        domore::xref(opened, &wanted, arguments.findings, arguments.input.json, &mut Printable(out))
    })
}

/// A bit beyond the sixteen of a word, or the 32 of a long word.
fn has_no_such_bit(address: &Address) -> bool {
    let bits = if address.file_type == ladder::FileType::L { 32 } else { 16 };
    address.bit.as_ref().and_then(ladder::Place::number).is_some_and(|bit| bit >= bits)
}

struct Report<'r> {
    opened: &'r Opened,
    xref: &'r CrossReference<'r>,
    calls: &'r CallGraph,
    /// What was asked for; `None`: everything. That is made and printed one address after the other,
    /// because all of it together can be far larger than the program.
    groups: Option<Vec<Group<'r>>>,
    calls_asked: Vec<String>,
    unknown: Vec<String>,
}

impl Report<'_> {
    fn find(&mut self, text: &str) {
        match self.xref.find(text) {
            Some(Found::Address(group)) if group.accesses.is_empty() && has_no_such_bit(&group.address) => {
                self.unknown.push(text.to_owned());
            }
            Some(Found::Address(group)) => self.groups.get_or_insert_default().push(group),
            Some(Found::File { groups, .. }) => self.groups.get_or_insert_default().extend(groups),
            Some(Found::ProgramFile(number)) => {
                let callers = self.calls.file(number).map(|file| {
                    let rungs: Vec<String> = file.called_by.iter().map(ToString::to_string).collect();
                    let entries: Vec<String> = file.entries.iter().map(|e| e.kind.as_str().to_owned()).collect();
                    format!("U:{number}  called in {}{}", none_if_empty(&rungs), suffix(&entries))
                });
                self.calls_asked.push(callers.unwrap_or_else(|| format!("U:{number}  no such ladder file")));
            }
            Some(Found::Label { file, number }) => {
                let label = self.calls.labels.iter().find(|label| label.file == file && label.number == number);
                let text = label.map(|label| {
                    let list = |places: &[analysis::Location]| {
                        none_if_empty(&places.iter().map(ToString::to_string).collect::<Vec<_>>())
                    };
                    format!("Q{file}:{number}  label in {}, jumps in {}", list(&label.defined), list(&label.jumps))
                });
                self.calls_asked.push(text.unwrap_or_else(|| format!("Q{file}:{number}  no such label")));
            }
            None => self.unknown.push(text.to_owned()),
        }
    }

    fn documentation(&self, address: &Address) -> (Option<String>, String) {
        let shown = self.opened.documentation().shown(&address.into(), "");
        (shown.symbol, one_line(&shown.description))
    }

    /// Calls `each` with the groups that were asked for, in their order.
    fn each_group<E>(&self, mut each: impl FnMut(&Group<'_>) -> Result<(), E>) -> Result<(), E> {
        match &self.groups {
            Some(groups) => groups.iter().try_for_each(each),
            None => self.xref.all().try_for_each(|group| each(&group)),
        }
    }

    fn describe(&self, only_findings: bool, out: &mut dyn Write) -> Result<(), Error> {
        write!(out, "{{\"file\":{}", json!(self.opened.path.display().to_string()))?;
        if !only_findings {
            let mut before = ",\"addresses\":[";
            self.each_group(|group| {
                out.write_all(std::mem::replace(&mut before, ",").as_bytes())?;
                let (symbol, description) = self.documentation(&group.address);
                let row = GroupRow {
                    address: group.address.to_string(),
                    symbol,
                    description,
                    module: self.opened.image().io.describe(&group.address),
                    accesses: group.accesses.iter().map(AccessRow::of).collect(),
                    left_out: group.left_out,
                };
                serde_json::to_writer(&mut *out, &row).map_err(std::io::Error::from)
            })?;
            write!(out, "{}]", if before == "," { "" } else { before })?;
        }
        for (name, value) in self.describe_rest(only_findings) {
            write!(out, ",{}:{value}", json!(name))?;
        }
        writeln!(out, "}}")?;
        Ok(())
    }

    /// What is said about the program as a whole.
    fn describe_rest(&self, only_findings: bool) -> serde_json::Map<String, Value> {
        let mut value = serde_json::Map::new();
        let mut put = |name: &str, list: Value| drop(value.insert(name.to_owned(), list));
        if !only_findings {
            let call = |call: &analysis::Call| json!({"file": call.location.file, "rung": call.location.rung, "target": target(&call.target)});
            put("calls", self.calls.calls.iter().map(call).collect());
        }
        if self.groups.is_none() {
            let findings = self.xref.findings();
            put("findings", findings.list.iter().map(finding).collect());
            put("not_judged", findings.not_judged.into());
            put("never_called", self.without_caller().map(|file| file.number).collect());
            let entries = self.calls.files.iter().flat_map(|file| {
                let entry = |entry: &analysis::Entry| {
                    json!({"file": file.number, "runs_as": entry.kind.as_str(), "source": entry.source})
                };
                file.entries.iter().map(entry)
            });
            put("entries", entries.collect());
            let unresolved = |it: &analysis::Unresolved<'_>| {
                json!({
                    "file": it.location.file, "rung": it.location.rung, "mnemonic": it.mnemonic.to_string(),
                    "operand": it.operand, "text": it.text, "why": it.kind.as_str(),
                })
            };
            put("unresolved", self.xref.unresolved().iter().map(unresolved).collect());
            let note = |note: &analysis::Note| json!({"note": note.as_str(), "rung": note.location().map(|location| location.to_string())});
            put("notes", self.xref.notes().iter().map(note).collect());
        }
        put("diagnostics", diagnostics_json(&self.opened.project));
        value
    }

    /// Ladder files no JSR names, the main program aside.
    fn without_caller(&self) -> impl Iterator<Item = &analysis::CalledFile> {
        self.calls.files.iter().filter(|file| file.called_by.is_empty() && file.number != 2)
    }

    fn print(&self, only_findings: bool, out: &mut dyn Write) -> Result<(), Error> {
        writeln!(out, "{}", self.opened.title())?;
        if !only_findings {
            self.each_group(|group| self.print_group(group, out))?;
            for line in &self.calls_asked {
                writeln!(out, "{line}")?;
            }
        }
        if self.groups.is_none() {
            self.print_findings(out)?;
        }
        Ok(())
    }

    fn print_group(&self, group: &Group<'_>, out: &mut dyn Write) -> Result<(), Error> {
        let (symbol, description) = self.documentation(&group.address);
        let parts = [
            symbol.unwrap_or_default(),
            description,
            self.opened.image().io.describe(&group.address).unwrap_or_default(),
        ];
        let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        writeln!(out, "{}  {}", group.address, parts.join("  -  "))?;
        let mut table = Columns::new(&["Rung", "Does", "Instruction", "Operand", "As", "Touches", ""]);
        for access in &group.accesses {
            let may = match access.certainty {
                analysis::Certainty::May => format!("may {}", access.role.as_str()),
                analysis::Certainty::Definite => access.role.as_str().to_owned(),
            };
            let through = match access.through {
                analysis::Through::Operand => String::new(),
                other => other.as_str().to_owned(),
            };
            table.row([
                access.location.to_string(),
                may,
                access.mnemonic.to_string(),
                access.operand.to_owned(),
                access.symbol.map_or_else(|| access.address.to_string(), str::to_owned),
                access.touched.clone(),
                through,
            ]);
        }
        if !table.is_empty() {
            table.write(out, "    ")?;
        }
        let ask = format!("`rungs xref {} '{}'` lists all", self.opened.path.display(), group.address);
        match group.left_out {
            Some(0) if table.is_empty() => writeln!(out, "    no instruction reads or writes it")?,
            Some(0) => {}
            Some(more) => writeln!(out, "    and {more} more accesses; {ask}")?,
            None => writeln!(out, "    accesses not listed; {ask}")?,
        }
        Ok(())
    }

    fn print_findings(&self, out: &mut dyn Write) -> Result<(), Error> {
        let findings = self.xref.findings();
        let mut table = Columns::new(&["Finding", "Address", "Symbol", "Rungs"]);
        // What is normal for its kind of address (an input nobody writes) is in the JSON only. Verifying
        // a rung makes elements of data files, and no modules.
        let worth = |f: &&analysis::Finding| f.expected.is_none() || f.kind == analysis::FindingKind::NoSuchPoint;
        for finding in findings.list.iter().filter(worth) {
            let (symbol, _) = self.documentation(&finding.address);
            let reason = finding.expected.map(|reason| format!(" ({})", reason.as_str())).unwrap_or_default();
            table.row([
                format!("{}{reason}", finding.kind.as_str()),
                finding.address.to_string(),
                symbol.unwrap_or_default(),
                places(&finding.locations, finding.left_out),
            ]);
        }
        if !table.is_empty() {
            writeln!(out, "\nWorth a look")?;
            table.write(out, "  ")?;
        }
        if findings.not_judged > 0 {
            let addresses = findings.not_judged;
            writeln!(out, "{addresses} addresses not judged: too many accesses overlap; ask for each with rungs xref")?;
        }
        let mut first = true;
        for file in self.without_caller() {
            if std::mem::take(&mut first) {
                writeln!(out, "\nProgram files that no JSR calls")?;
            }
            let entries: Vec<String> =
                file.entries.iter().map(|e| format!("{} {}", e.kind.as_str(), e.source)).collect();
            let why = if entries.is_empty() {
                "nothing runs it".to_owned()
            } else {
                format!("runs as {}", entries.join(", "))
            };
            writeln!(out, "  {} {}  {why}", file.number, file.name)?;
        }
        for it in self.xref.unresolved() {
            writeln!(out, "{}  {} {}: {} ({})", it.location, it.mnemonic, it.operand, it.text, it.kind.as_str())?;
        }
        for note in self.xref.notes() {
            let place = note.location().map(|location| format!("{location}  ")).unwrap_or_default();
            writeln!(out, "{place}{}", note.as_str())?;
        }
        Ok(())
    }
}

/// An address in JSON. Written piece by piece: a report can have hundreds of thousands.
#[derive(Serialize)]
struct GroupRow<'x> {
    address: String,
    symbol: Option<String>,
    description: String,
    module: Option<String>,
    accesses: Vec<AccessRow<'x>>,
    /// Accesses that are not listed; `null` if not even counted.
    left_out: Option<usize>,
}

#[derive(Serialize)]
struct AccessRow<'x> {
    file: u16,
    rung: u32,
    mnemonic: String,
    operand: &'x str,
    #[serde(rename = "as")]
    written: String,
    symbol: Option<&'x str>,
    role: &'static str,
    certainty: &'static str,
    level: &'static str,
    through: &'static str,
    touches: &'x str,
}

impl<'x> AccessRow<'x> {
    fn of(access: &'x Access<'x>) -> AccessRow<'x> {
        AccessRow {
            file: access.location.file,
            rung: access.location.rung,
            mnemonic: access.mnemonic.to_string(),
            operand: access.operand,
            written: access.address.to_string(),
            symbol: access.symbol,
            role: access.role.as_str(),
            certainty: access.certainty.as_str(),
            level: access.level.as_str(),
            through: access.through.as_str(),
            touches: &access.touched,
        }
    }
}

fn finding(finding: &Finding) -> Value {
    json!({
        "finding": finding.kind.as_str(),
        "address": finding.address.to_string(),
        "expected": finding.expected.map(analysis::Reason::as_str),
        "rungs": finding.locations.iter().map(ToString::to_string).collect::<Value>(),
        "left_out": finding.left_out,
    })
}

fn target(target: &Target) -> Value {
    match target {
        Target::File(number) => json!(number),
        Target::Missing(number) => json!({"missing": number}),
        Target::Unknown(text) => json!({"unknown": text}),
    }
}

fn none_if_empty(list: &[String]) -> String {
    if list.is_empty() { "no rung".to_owned() } else { list.join(", ") }
}

fn suffix(entries: &[String]) -> String {
    if entries.is_empty() { String::new() } else { format!("; {}", entries.join(", ")) }
}
