//! `rungs timers`: every timer and counter.

use std::collections::HashSet;
use std::io::Write;

use analysis::{
    Certainty, CrossReference, DataValues, ElementKind, InstructionValues, LeftOut, Reference, TimerCounter,
    TimerReport, Usage,
};
use ladder::{Address, TimeBase};
use serde::Serialize;
use serde_json::{Value, json};

use super::{Opened, diagnostics_json, domore, each_dialect, more, one_line, places};
use crate::args::AddressArguments;
use crate::files;
use crate::output::{Columns, Error, Outcome, Printable};

pub fn run(arguments: &AddressArguments) -> Result<Outcome, Error> {
    let (paths, wanted) = files::split(&arguments.files);
    let slc = |opened: &Opened, out: &mut dyn Write| {
        let xref = CrossReference::build(opened.image(), opened.documentation());
        let mut report = TimerReport::build(opened.image(), &xref);
        if !wanted.is_empty() {
            report.complete(&xref, |element| is_wanted(element, &wanted) && !is_file_wanted(element, &wanted));
        }
        let elements: Vec<&TimerCounter> = report.elements.iter().filter(|e| is_wanted(e, &wanted)).collect();
        if arguments.input.json {
            describe(opened, &report, &elements, out)?;
        } else {
            print(opened, &report, &elements, !wanted.is_empty(), &mut Printable(out))?;
        }
        let mut outcome = Outcome::Done;
        for text in &wanted {
            if !report.elements.iter().any(|element| is_wanted(element, std::slice::from_ref(text))) {
                eprintln!("{}: `{text}` is no timer or counter of this program", opened.path.display());
                outcome = Outcome::Finding;
            }
        }
        Ok(outcome)
    };
    each_dialect(&paths, &arguments.input, slc, |opened, out| {
        domore::timers(opened, &wanted, arguments.input.json, out)
    })
}

/// By address, by file (`T4`) or by symbol; all without a wish.
fn is_wanted(element: &TimerCounter, wanted: &[String]) -> bool {
    let address = element.address.to_string();
    let symbol = element.symbol.as_deref();
    let matches = |text: &String| {
        text.eq_ignore_ascii_case(&address) || symbol.is_some_and(|symbol| symbol.eq_ignore_ascii_case(text))
    };
    wanted.is_empty() || wanted.iter().any(matches) || is_file_wanted(element, wanted)
}

fn is_file_wanted(element: &TimerCounter, wanted: &[String]) -> bool {
    let address = element.address.to_string();
    let file = address.split(':').next().unwrap_or("");
    wanted.iter().any(|text| text.eq_ignore_ascii_case(file))
}

fn kind_word(kind: ElementKind) -> &'static str {
    match kind {
        ElementKind::Timer => "timer",
        ElementKind::Counter => "counter",
    }
}

fn usage_word(usage: Usage) -> &'static str {
    match usage {
        Usage::Active => "active",
        Usage::ReferencedOnly => "referenced only",
        Usage::ConfiguredOnly => "configured only",
    }
}

/// Writes the document piece by piece: with all references in memory it could be far larger than the
/// program.
fn describe(
    opened: &Opened,
    report: &TimerReport,
    elements: &[&TimerCounter],
    out: &mut dyn Write,
) -> Result<(), Error> {
    write!(out, "{{\"file\":{},\"counts\":", json!(opened.path.display().to_string()))?;
    serde_json::to_writer(&mut *out, &counts(report)).map_err(std::io::Error::from)?;
    write!(out, ",\"timers\":")?;
    write_list(elements.iter().map(|element| ElementRow::of(element)), out)?;
    write!(out, ",\"elsewhere\":")?;
    write_list(report.elsewhere.iter().map(InstructionRow::of), out)?;
    write!(out, ",\"findings\":")?;
    let findings = report.findings.iter().map(|finding| {
        json!({
            "address": finding.address.to_string(),
            "finding": finding.kind.as_str(),
            "rungs": finding.locations.iter().map(ToString::to_string).collect::<Value>(),
            "left_out": finding.left_out,
        })
    });
    write_list(findings, out)?;
    writeln!(out, ",\"diagnostics\":{}}}", diagnostics_json(&opened.project))?;
    Ok(())
}

fn write_list(rows: impl Iterator<Item = impl Serialize>, out: &mut dyn Write) -> Result<(), Error> {
    let mut before = "[";
    for row in rows {
        out.write_all(std::mem::replace(&mut before, ",").as_bytes())?;
        serde_json::to_writer(&mut *out, &row).map_err(std::io::Error::from)?;
    }
    out.write_all(if before == "[" { b"[]" } else { b"]" })?;
    Ok(())
}

/// A timer or counter in JSON.
#[derive(Serialize)]
struct ElementRow<'r> {
    address: String,
    #[serde(rename = "type")]
    kind: &'static str,
    usage: &'static str,
    kinds: Vec<&'static str>,
    symbol: Option<&'r str>,
    description: &'r [String],
    base: Option<&'static str>,
    preset: Option<i32>,
    accum: Option<i32>,
    preset_seconds: Option<String>,
    accum_seconds: Option<String>,
    instructions: Vec<InstructionRow<'r>>,
    data: Option<Value>,
    read_by: Vec<ReferenceRow<'r>>,
    reset_by: Vec<ReferenceRow<'r>>,
    written_by: Vec<ReferenceRow<'r>>,
    /// References that are not listed; `null` if not even counted.
    left_out: Option<usize>,
}

impl<'r> ElementRow<'r> {
    fn of(element: &'r TimerCounter) -> ElementRow<'r> {
        let references = |list: &'r [Reference]| list.iter().map(ReferenceRow::of).collect();
        let data = |values: DataValues| {
            let mut value = json!({"base": values.base.map(TimeBase::text), "PRE": values.preset, "ACC": values.accum});
            for (name, set) in values.bits(element.kind) {
                value[name] = u8::from(set).into();
            }
            value
        };
        ElementRow {
            address: element.address.to_string(),
            kind: kind_word(element.kind),
            usage: usage_word(element.usage),
            kinds: element.mnemonics(),
            symbol: element.symbol.as_deref(),
            description: &element.description,
            base: element.base.map(TimeBase::text),
            preset: element.preset,
            accum: element.accum,
            preset_seconds: element.preset_seconds(),
            accum_seconds: element.accum_seconds(),
            instructions: element.instructions.iter().map(InstructionRow::of).collect(),
            data: element.data.map(data),
            read_by: references(&element.read_by),
            reset_by: references(&element.reset_by),
            written_by: references(&element.written_by),
            left_out: element.left_out.map(|it| it.read_by + it.reset_by + it.written_by),
        }
    }
}

#[derive(Serialize)]
struct InstructionRow<'r> {
    file: u16,
    rung: u32,
    mnemonic: &'static str,
    address: &'r str,
    base: Option<&'static str>,
    preset: Option<i32>,
    accum: Option<i32>,
    compiled: bool,
}

impl<'r> InstructionRow<'r> {
    fn of(it: &'r InstructionValues) -> InstructionRow<'r> {
        InstructionRow {
            file: it.location.file,
            rung: it.location.rung,
            mnemonic: it.mnemonic,
            address: &it.address,
            base: it.base.map(TimeBase::text),
            preset: it.preset,
            accum: it.accum,
            compiled: it.compiled,
        }
    }
}

#[derive(Serialize)]
struct ReferenceRow<'r> {
    file: u16,
    rung: u32,
    mnemonic: &'r str,
    operand: &'r str,
    members: &'r [String],
    certainty: &'static str,
}

impl<'r> ReferenceRow<'r> {
    fn of(reference: &'r Reference) -> ReferenceRow<'r> {
        ReferenceRow {
            file: reference.location.file,
            rung: reference.location.rung,
            mnemonic: &reference.mnemonic,
            operand: &reference.written,
            members: &reference.members,
            certainty: reference.certainty.as_str(),
        }
    }
}

/// How many elements each mnemonic times or counts.
fn counts(report: &TimerReport) -> serde_json::Map<String, Value> {
    let count = |mnemonic: &str| report.active().filter(|e| e.mnemonics().contains(&mnemonic)).count();
    ["TON", "TOF", "RTO", "CTU", "CTD", "HSC"].into_iter().map(|name| (name.to_owned(), count(name).into())).collect()
}

/// Rungs of references, then how many more there are.
fn references(list: &[Reference], with_members: bool, left_out: usize) -> String {
    let mut texts: Vec<String> = list
        .iter()
        .map(|r| {
            let members =
                if !with_members || r.members.is_empty() { String::new() } else { format!(" {}", r.members.join(",")) };
            let may = if r.certainty == Certainty::May { "?" } else { "" };
            format!("{}{members}{may}", r.location)
        })
        .collect();
    texts.dedup();
    if left_out > 0 {
        texts.push(more(left_out));
    }
    texts.join(", ")
}

fn print(
    opened: &Opened,
    report: &TimerReport,
    elements: &[&TimerCounter],
    detailed: bool,
    out: &mut dyn Write,
) -> Result<(), Error> {
    writeln!(out, "{}", opened.title())?;
    let active = elements.iter().filter(|element| element.usage == Usage::Active);
    let (timers, counters): (Vec<&&TimerCounter>, Vec<&&TimerCounter>) =
        active.partition(|element| element.kind == ElementKind::Timer);
    if !detailed {
        let count = |name: &str| report.active().filter(|e| e.mnemonics().contains(&name)).count();
        writeln!(
            out,
            "{} timers ({} TON, {} TOF, {} RTO), {} counters ({} CTU, {} CTD)\n",
            timers.len(),
            count("TON"),
            count("TOF"),
            count("RTO"),
            counters.len(),
            count("CTU"),
            count("CTD")
        )?;
    }
    table(opened, &timers, "Timers", out)?;
    table(opened, &counters, "Counters", out)?;
    for (usage, title) in [
        (Usage::ReferencedOnly, "Read, written or reset, but never timed or counted"),
        (Usage::ConfiguredOnly, "With a preset in the data table, not used by the program"),
    ] {
        let list: Vec<&&TimerCounter> = elements.iter().filter(|element| element.usage == usage).collect();
        table(opened, &list, title, out)?;
    }
    if !report.elsewhere.is_empty() && !detailed {
        writeln!(out, "Timer and counter instructions whose element is decided at run time")?;
        for it in &report.elsewhere {
            writeln!(out, "  {} {} {}", it.location, it.mnemonic, it.address)?;
        }
        writeln!(out)?;
    }
    let shown: HashSet<&Address> = elements.iter().map(|element| &element.address).collect();
    let findings: Vec<_> = report.findings.iter().filter(|finding| shown.contains(&finding.address)).collect();
    if !findings.is_empty() {
        writeln!(out, "Worth a look")?;
        let mut table = Columns::new(&["Address", "Finding", "Rungs"]);
        for finding in findings {
            let places = places(&finding.locations, finding.left_out);
            table.row([finding.address.to_string(), finding.kind.as_str().to_owned(), places]);
        }
        table.write(out, "  ")?;
        writeln!(out)?;
    }
    writeln!(
        out,
        "Rungs are written file:rung; ? marks access decided at run time. Values are those saved in the project."
    )?;
    Ok(())
}

fn table(opened: &Opened, elements: &[&&TimerCounter], title: &str, out: &mut dyn Write) -> Result<(), Error> {
    if elements.is_empty() {
        return Ok(());
    }
    writeln!(out, "{title}")?;
    let mut table = Columns::new(&["Address", "Kind", "Base", "Preset", "Accum", "Seconds", "Box", "State", "Symbol"]);
    for element in elements {
        let text = |value: Option<i32>| value.map(|value| value.to_string()).unwrap_or_default();
        let state = element.data.map(|data| {
            let set = data.bits(element.kind).filter(|(_, on)| *on).map(|(name, _)| name);
            set.collect::<Vec<_>>().join(" ")
        });
        // Preset/accum of the box where they are not those of the data table.
        let differing = element.instructions.iter().filter(|it| {
            element.data.is_some_and(|data| {
                it.preset.is_some_and(|pre| pre != i32::from(data.preset))
                    || it.accum.is_some_and(|acc| acc != i32::from(data.accum))
            })
        });
        let boxes: Vec<String> = differing.map(|it| format!("{}/{}", text(it.preset), text(it.accum))).collect();
        let timed: Vec<String> = element.instructions.iter().map(|it| it.location.to_string()).collect();
        let symbol = element.symbol.clone().unwrap_or_else(|| one_line(&element.description));
        table.row([
            element.address.to_string(),
            element.mnemonics().join("+"),
            element.base.map(TimeBase::text).unwrap_or("").to_owned(),
            text(element.preset),
            text(element.accum),
            element.preset_seconds().unwrap_or_default(),
            boxes.join(" "),
            state.unwrap_or_else(|| "no element".to_owned()),
            symbol,
        ]);
        let timed_in = if element.kind == ElementKind::Timer { "timed in" } else { "counted in" };
        let left_out = element.left_out.unwrap_or_default();
        let uses = [
            (timed_in, timed.join(", ")),
            ("read in", references(&element.read_by, true, left_out.read_by)),
            // RES clears the whole element: naming its members says nothing.
            ("reset in", references(&element.reset_by, false, left_out.reset_by)),
            ("written in", references(&element.written_by, true, left_out.written_by)),
        ];
        for (what, places) in uses.iter().filter(|(_, places)| !places.is_empty()) {
            table.note(&format!("{what} {places}"));
        }
        let ask = format!("`rungs timers {} {}` lists all", opened.path.display(), element.address);
        match element.left_out {
            Some(left_out) if left_out == LeftOut::default() => {}
            Some(_) => table.note(&format!("not all rungs are listed; {ask}")),
            None => table.note(&format!("its rungs are not listed; {ask}")),
        }
    }
    table.write(out, "  ")?;
    writeln!(out)?;
    Ok(())
}
