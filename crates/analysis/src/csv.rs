//! Timers, counters and the cross reference as CSV tables.
//!
//! RFC 4180: a header row, CR LF between rows, quotes where a cell needs them; UTF-8. Places are
//! `file:rung`. Several entries in a cell are separated by `; `, lines of a description by line ends.
//!
//! Cells hold the text exactly as the project has it. A spreadsheet program takes a cell that begins
//! with `=`, `+`, `-` or `@` for a formula: import the columns of a table from a stranger as text.

use std::io::{self, Write};

use ::csv::{Terminator, Writer, WriterBuilder};
use ladder::{Address, FileType, Target, TimeBase};

use crate::{
    Access, Certainty, CrossReference, DataValues, ElementKind, InstructionValues, LeftOut, Reference, TimerCounter,
    TimerReport, Unresolved, Usage,
};

const TIMER_COLUMNS: [&str; 30] = [
    "address",
    "kind",
    "usage",
    "symbol",
    "description",
    "instructions",
    "base",
    "preset",
    "preset_seconds",
    "accum",
    "accum_seconds",
    "instruction_base",
    "instruction_preset",
    "instruction_accum",
    "verified",
    "data_base",
    "data_preset",
    "data_accum",
    "EN",
    "TT",
    "DN",
    "CU",
    "CD",
    "OV",
    "UN",
    "UA",
    "read_by",
    "reset_by",
    "written_by",
    "findings",
];

/// State bits in the order of their columns.
const BITS: [&str; 8] = ["EN", "TT", "DN", "CU", "CD", "OV", "UN", "UA"];

const XREF_COLUMNS: [&str; 15] = [
    "address",
    "symbol",
    "description",
    "file",
    "rung",
    "instruction",
    "mnemonic",
    "operand",
    "written_as",
    "access",
    "certainty",
    "level",
    "through",
    "touched",
    "note",
];

/// Writes one row per timer and counter, then one per instruction whose element is decided at run
/// time (usage `run time`).
///
/// `base`, `preset` and `accum` are the values in force; those of the instructions and of the data
/// table stand beside them, because they can differ. `verified` is `no` for an instruction whose texts
/// were entered and never verified.
///
/// # Errors
/// Only those of `writer`.
pub fn timers(report: &TimerReport, writer: impl Write) -> io::Result<()> {
    let mut table = start(writer);
    table.write_record(TIMER_COLUMNS)?;
    // Findings are in the order of the elements they are about.
    let mut rest = report.findings.iter().peekable();
    for element in &report.elements {
        let found = std::iter::from_fn(|| rest.next_if(|finding| finding.address == element.address));
        let findings = joined(found.map(|finding| finding.kind.as_str().to_owned()));
        table.write_record(timer_row(element, findings))?;
    }
    for values in &report.elsewhere {
        table.write_record(elsewhere_row(values))?;
    }
    table.flush()
}

/// Writes one row per address and access, addresses as in [`CrossReference::all`]; then one row per
/// operand or instruction about which nothing can be said, and per limit of the cross reference, with
/// the reason in the column `note`. Where an address has more accesses than are listed, see
/// [`crate::MAX_LISTED`], a row with such a note counts them.
///
/// # Errors
/// Only those of `writer`.
pub fn xref(xref: &CrossReference<'_>, writer: impl Write) -> io::Result<()> {
    let mut table = start(writer);
    table.write_record(XREF_COLUMNS)?;
    for group in xref.all() {
        let shown = xref.documentation().shown(&Target::from(&group.address), "");
        let address = group.address.to_string();
        let (symbol, description) = (shown.symbol.unwrap_or_default(), shown.description.join("\n"));
        for access in &group.accesses {
            table.write_record(access_row(&address, &symbol, &description, access))?;
        }
        let note = match group.left_out {
            Some(0) => continue,
            Some(more) => format!("{more} more accesses are not listed"),
            None => "its accesses are not listed".to_owned(),
        };
        let mut row = empty_xref_row(&note);
        [row[0], row[1], row[2]] = [address, symbol, description];
        table.write_record(row)?;
    }
    for unresolved in xref.unresolved() {
        table.write_record(unresolved_row(unresolved))?;
    }
    for note in xref.notes() {
        let mut row = empty_xref_row(note.as_str());
        if let Some(location) = note.location() {
            [row[3], row[4], row[5]] =
                [location.file.to_string(), location.rung.to_string(), location.instruction.to_string()];
        }
        table.write_record(row)?;
    }
    table.flush()
}

fn start<W: Write>(writer: W) -> Writer<W> {
    WriterBuilder::new().terminator(Terminator::CRLF).from_writer(writer)
}

fn joined(items: impl Iterator<Item = String>) -> String {
    items.collect::<Vec<_>>().join("; ")
}

fn number<T: ToString>(value: Option<T>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}

/// One entry per instruction, so that the n-th entries of several columns belong together; nothing
/// where no instruction has any.
fn per_instruction<T: ToString>(
    instructions: &[InstructionValues],
    value: impl Fn(&InstructionValues) -> Option<T>,
) -> String {
    let all: Vec<String> = instructions.iter().map(|it| number(value(it))).collect();
    if all.iter().all(String::is_empty) { String::new() } else { all.join("; ") }
}

fn timer_row(element: &TimerCounter, findings: String) -> Vec<String> {
    let kind = match element.kind {
        ElementKind::Timer => "timer",
        ElementKind::Counter => "counter",
    };
    let usage = match element.usage {
        Usage::Active => "active",
        Usage::ReferencedOnly => "referenced only",
        Usage::ConfiguredOnly => "not used",
    };
    let seconds = |text: Option<String>| text.unwrap_or_default();
    let data = element.data;
    let mut row = vec![
        element.address.to_string(),
        kind.to_owned(),
        usage.to_owned(),
        element.symbol.clone().unwrap_or_default(),
        element.description.join("\n"),
    ];
    row.push(joined(element.instructions.iter().map(|it| format!("{} {}", it.location, it.mnemonic))));
    row.extend([number(element.base), number(element.preset), seconds(element.preset_seconds())]);
    row.extend([number(element.accum), seconds(element.accum_seconds())]);
    row.extend(instruction_cells(&element.instructions));
    row.extend([
        number(data.and_then(|data| data.base)),
        number(data.map(|data| data.preset)),
        number(data.map(|data| data.accum)),
    ]);
    row.extend(BITS.map(|name| bit(data, element.kind, name)));
    // A reset always clears the same parts: naming them says nothing.
    let more = |of: fn(LeftOut) -> usize| element.left_out.map(of);
    row.push(references(&element.read_by, true, more(|it| it.read_by)));
    row.push(references(&element.reset_by, false, more(|it| it.reset_by)));
    row.push(references(&element.written_by, true, more(|it| it.written_by)));
    row.push(findings);
    row
}

/// Base, preset, accum and whether the texts were verified, each per instruction.
fn instruction_cells(instructions: &[InstructionValues]) -> [String; 4] {
    [
        per_instruction(instructions, |it| it.base.map(TimeBase::text)),
        per_instruction(instructions, |it| it.preset),
        per_instruction(instructions, |it| it.accum),
        per_instruction(instructions, |it| Some(if it.compiled { "yes" } else { "no" })),
    ]
}

/// `0` or `1`; nothing for a bit the element does not have.
fn bit(data: Option<DataValues>, kind: ElementKind, name: &str) -> String {
    let found = data.and_then(|data| data.bits(kind).find(|(own, _)| *own == name));
    number(found.map(|(_, set)| u8::from(set)))
}

/// `2:14 XIC DN; may 3:0 COP`; behind them how many are not listed.
fn references(all: &[Reference], with_members: bool, left_out: Option<usize>) -> String {
    let more = match left_out {
        Some(0) => None,
        Some(more) => Some(format!("and {more} more")),
        None => Some("not looked up".to_owned()),
    };
    joined(
        all.iter()
            .map(|it| {
                let may = if it.certainty == Certainty::May { "may " } else { "" };
                let mut text = format!("{may}{} {}", it.location, it.mnemonic);
                for member in it.members.iter().filter(|_| with_members) {
                    text.push(' ');
                    text.push_str(member);
                }
                text
            })
            .chain(more),
    )
}

fn elsewhere_row(values: &InstructionValues) -> Vec<String> {
    let file_type = Address::parse(&values.address).map(|address| address.file_type);
    let kind = match file_type {
        Ok(FileType::T) => "timer",
        Ok(FileType::C) => "counter",
        _ => "",
    };
    let mut row = vec![values.address.clone(), kind.to_owned(), "run time".to_owned()];
    row.extend([String::new(), String::new(), format!("{} {}", values.location, values.mnemonic)]);
    row.resize(11, String::new());
    row.extend(instruction_cells(std::slice::from_ref(values)));
    row.resize(TIMER_COLUMNS.len(), String::new());
    row
}

fn access_row(address: &str, symbol: &str, description: &str, access: &Access<'_>) -> Vec<String> {
    vec![
        address.to_owned(),
        symbol.to_owned(),
        description.to_owned(),
        access.location.file.to_string(),
        access.location.rung.to_string(),
        access.location.instruction.to_string(),
        access.mnemonic.to_string(),
        access.operand.to_owned(),
        access.symbol.map_or_else(|| access.address.to_string(), str::to_owned),
        access.role.as_str().to_owned(),
        access.certainty.as_str().to_owned(),
        access.level.as_str().to_owned(),
        access.through.as_str().to_owned(),
        access.touched.clone(),
        String::new(),
    ]
}

fn empty_xref_row(note: &str) -> [String; 15] {
    let mut row: [String; 15] = Default::default();
    note.clone_into(&mut row[14]);
    row
}

fn unresolved_row(unresolved: &Unresolved<'_>) -> [String; 15] {
    let mut row = empty_xref_row(unresolved.kind.as_str());
    row[3] = unresolved.location.file.to_string();
    row[4] = unresolved.location.rung.to_string();
    row[5] = unresolved.location.instruction.to_string();
    row[6] = unresolved.mnemonic.to_string();
    unresolved.operand.clone_into(&mut row[7]);
    row[8].clone_from(&unresolved.text);
    row
}
