//! `rungs timers`: every timer and counter.

use std::io::Write;

use analysis::{
    Certainty, CrossReference, DataValues, ElementKind, InstructionValues, Reference, TimerCounter, TimerReport, Usage,
};
use ladder::TimeBase;
use serde_json::{Value, json};

use super::{Opened, each_project, one_line, write_json};
use crate::args::AddressArguments;
use crate::files;
use crate::output::{Columns, Error, Outcome, Printable};

pub fn run(arguments: &AddressArguments) -> Result<Outcome, Error> {
    let (paths, wanted) = files::split(&arguments.files);
    each_project(&paths, &arguments.input, |opened, out| {
        let xref = CrossReference::build(opened.image(), opened.documentation());
        let report = TimerReport::build(opened.image(), &xref);
        let elements: Vec<&TimerCounter> = report.elements.iter().filter(|e| is_wanted(e, &wanted)).collect();
        if arguments.input.json {
            write_json(opened, describe(opened, &report, &elements), out)?;
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
    })
}

/// By address, by file (`T4`) or by symbol; all without a wish.
fn is_wanted(element: &TimerCounter, wanted: &[String]) -> bool {
    let address = element.address.to_string();
    let file = address.split(':').next().unwrap_or("");
    let symbol = element.symbol.as_deref();
    let matches = |text: &String| {
        text.eq_ignore_ascii_case(&address)
            || text.eq_ignore_ascii_case(file)
            || symbol.is_some_and(|symbol| symbol.eq_ignore_ascii_case(text))
    };
    wanted.is_empty() || wanted.iter().any(matches)
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

fn describe(opened: &Opened, report: &TimerReport, elements: &[&TimerCounter]) -> Value {
    let base = |base: Option<TimeBase>| base.map(TimeBase::text);
    let instruction = |it: &InstructionValues| {
        json!({
            "file": it.location.file, "rung": it.location.rung, "mnemonic": it.mnemonic, "address": it.address,
            "base": base(it.base), "preset": it.preset, "accum": it.accum, "compiled": it.compiled,
        })
    };
    let data = |values: DataValues, kind: ElementKind| {
        let mut value = json!({"base": base(values.base), "PRE": values.preset, "ACC": values.accum});
        for (name, set) in values.bits(kind) {
            value[name] = u8::from(set).into();
        }
        value
    };
    let reference = |reference: &Reference| {
        json!({
            "file": reference.location.file, "rung": reference.location.rung, "mnemonic": reference.mnemonic,
            "operand": reference.written, "members": reference.members, "certainty": reference.certainty.as_str(),
        })
    };
    let references = |list: &[Reference]| list.iter().map(reference).collect::<Value>();
    let timers = elements.iter().map(|element| {
        json!({
            "address": element.address.to_string(),
            "type": kind_word(element.kind),
            "usage": usage_word(element.usage),
            "kinds": element.mnemonics(),
            "symbol": element.symbol,
            "description": element.description,
            "base": base(element.base),
            "preset": element.preset,
            "accum": element.accum,
            "preset_seconds": element.preset_seconds(),
            "accum_seconds": element.accum_seconds(),
            "instructions": element.instructions.iter().map(instruction).collect::<Value>(),
            "data": element.data.map(|values| data(values, element.kind)),
            "read_by": references(&element.read_by),
            "reset_by": references(&element.reset_by),
            "written_by": references(&element.written_by),
        })
    });
    json!({
        "file": opened.path.display().to_string(),
        "counts": counts(report),
        "timers": timers.collect::<Value>(),
        "elsewhere": report.elsewhere.iter().map(instruction).collect::<Value>(),
        "findings": report.findings.iter().map(|finding| json!({
            "address": finding.address.to_string(),
            "finding": finding.kind.as_str(),
            "rungs": finding.locations.iter().map(ToString::to_string).collect::<Value>(),
        })).collect::<Value>(),
    })
}

/// How many elements each mnemonic times or counts.
fn counts(report: &TimerReport) -> serde_json::Map<String, Value> {
    let count = |mnemonic: &str| report.active().filter(|e| e.mnemonics().contains(&mnemonic)).count();
    ["TON", "TOF", "RTO", "CTU", "CTD", "HSC"].into_iter().map(|name| (name.to_owned(), count(name).into())).collect()
}

fn places(list: &[Reference], with_members: bool) -> String {
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
    table(&timers, "Timers", out)?;
    table(&counters, "Counters", out)?;
    for (usage, title) in [
        (Usage::ReferencedOnly, "Read, written or reset, but never timed or counted"),
        (Usage::ConfiguredOnly, "With a preset in the data table, not used by the program"),
    ] {
        let list: Vec<&&TimerCounter> = elements.iter().filter(|element| element.usage == usage).collect();
        table(&list, title, out)?;
    }
    if !report.elsewhere.is_empty() && !detailed {
        writeln!(out, "Timer and counter instructions whose element is decided at run time")?;
        for it in &report.elsewhere {
            writeln!(out, "  {} {} {}", it.location, it.mnemonic, it.address)?;
        }
        writeln!(out)?;
    }
    let findings: Vec<_> = report.findings.iter().filter(|f| elements.iter().any(|e| e.address == f.address)).collect();
    if !findings.is_empty() {
        writeln!(out, "Worth a look")?;
        let mut table = Columns::new(&["Address", "Finding", "Rungs"]);
        for finding in findings {
            let places: Vec<String> = finding.locations.iter().map(ToString::to_string).collect();
            table.row([finding.address.to_string(), finding.kind.as_str().to_owned(), places.join(", ")]);
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

fn table(elements: &[&&TimerCounter], title: &str, out: &mut dyn Write) -> Result<(), Error> {
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
        let uses = [
            (if element.kind == ElementKind::Timer { "timed in" } else { "counted in" }, timed.join(", ")),
            ("read in", places(&element.read_by, true)),
            // RES clears the whole element: naming its members says nothing.
            ("reset in", places(&element.reset_by, false)),
            ("written in", places(&element.written_by, true)),
        ];
        for (what, places) in uses.iter().filter(|(_, places)| !places.is_empty()) {
            table.note(&format!("{what} {places}"));
        }
    }
    table.write(out, "  ")?;
    writeln!(out)?;
    Ok(())
}
