//! Timers and counters with seconds and the rungs that use them.

use analysis::{Certainty, ElementKind, Reference, TimerCounter, TimerReport, Usage};
use ladder::TimeBase;

use super::{Context, remark, rung, rungs};
use crate::anchor::Anchor;
use crate::model::{Block, ColumnKind, Table, Text};
use crate::words;

pub(super) fn report<'a>(context: &Context<'a, '_>) -> Vec<Block<'a>> {
    let report = TimerReport::build(context.image(), &context.xref);
    let chosen = |usage: Usage, kind: ElementKind| {
        report.elements.iter().filter(move |element| element.usage == usage && element.kind == kind)
    };
    let mut blocks = Vec::new();
    for (usage, kind, title) in [
        (Usage::Active, ElementKind::Timer, "Timers"),
        (Usage::Active, ElementKind::Counter, "Counters"),
        (Usage::ReferencedOnly, ElementKind::Timer, "Timers that are read, written or reset, but never timed"),
        (Usage::ReferencedOnly, ElementKind::Counter, "Counters that are read, written or reset, but never counted"),
        (Usage::ConfiguredOnly, ElementKind::Timer, "Timers with a preset that the program does not use"),
        (Usage::ConfiguredOnly, ElementKind::Counter, "Counters with a preset that the program does not use"),
    ] {
        let elements: Vec<&TimerCounter> = chosen(usage, kind).collect();
        if !elements.is_empty() {
            blocks.push(Block::Heading(format!("{title} ({})", elements.len())));
            blocks.push(Block::Table(table(kind, &elements)));
        }
    }
    if !report.elsewhere.is_empty() {
        blocks.push(Block::Heading("Timer and counter instructions whose element is decided at run time".to_owned()));
        let mut table = Table::new(&[
            ("Rung", ColumnKind::Fixed),
            ("Instruction", ColumnKind::Fixed),
            ("Element", ColumnKind::Fixed),
        ]);
        for it in &report.elsewhere {
            table.row([rung(it.location), it.mnemonic.into(), it.address.as_str().into()]);
        }
        blocks.push(Block::Table(table));
    }
    if !report.findings.is_empty() {
        blocks.push(Block::Heading("Worth a look".to_owned()));
        let mut table =
            Table::new(&[("Address", ColumnKind::Fixed), ("Finding", ColumnKind::Text), ("Rungs", ColumnKind::Text)]);
        for finding in &report.findings {
            let shown = finding.address.to_string();
            let anchor = Anchor::timer(&shown);
            let rungs = rungs(&finding.locations, finding.left_out);
            table.row([Text::link(shown, anchor), finding.kind.as_str().into(), rungs]);
        }
        blocks.push(Block::Table(table));
    }
    if blocks.is_empty() {
        return vec![remark("The program has no timers and counters.")];
    }
    blocks.push(remark(
        "Values are those saved in the project; \"box\" stands where the box shows others. ? marks access decided at run time.",
    ));
    blocks
}

fn table(kind: ElementKind, elements: &[&TimerCounter]) -> Table {
    let timer = kind == ElementKind::Timer;
    let mut columns = vec![("Address", ColumnKind::Fixed), ("Kind", ColumnKind::Text)];
    if timer {
        columns.push(("Base", ColumnKind::Number));
    }
    columns.extend([("Preset", ColumnKind::Number), ("Accum", ColumnKind::Number)]);
    if timer {
        columns.extend([("Preset s", ColumnKind::Number), ("Accum s", ColumnKind::Number)]);
    }
    columns.extend([
        ("State", ColumnKind::Text),
        ("Symbol and description", ColumnKind::Text),
        (if timer { "Timed in" } else { "Counted in" }, ColumnKind::Text),
        ("Read in", ColumnKind::Text),
        ("Reset in", ColumnKind::Text),
        ("Written in", ColumnKind::Text),
    ]);
    let mut table = Table::new(&columns);
    for element in elements {
        let number = |value: Option<i32>| Text::plain(value.map(|value| value.to_string()).unwrap_or_default());
        let shown = element.address.to_string();
        let anchor = Anchor::timer(&shown);
        let reference = Anchor::reference(&shown);
        let mut cells = vec![Text::link(shown, reference), element.mnemonics().join("+").into()];
        if timer {
            cells.push(element.base.map(TimeBase::text).unwrap_or("").into());
        }
        cells.extend([number(element.preset), number(element.accum)]);
        if timer {
            cells.extend(
                [element.preset_seconds(), element.accum_seconds()].map(|s| Text::plain(s.unwrap_or_default())),
            );
        }
        let timed: Vec<_> = element.instructions.iter().map(|it| it.location).collect();
        let left_out = element.left_out.unwrap_or_default();
        cells.extend([
            state(element).into(),
            named(element).into(),
            rungs(&timed, 0),
            references(&element.read_by, true, left_out.read_by),
            // RES clears the whole element: naming its members says nothing.
            references(&element.reset_by, false, left_out.reset_by),
            references(&element.written_by, true, left_out.written_by),
        ]);
        if element.left_out.is_none() {
            // Too many accesses overlap: nobody looked, which is not the same as none.
            let last = cells.len() - 1;
            cells.iter_mut().skip(last - 2).for_each(|cell| *cell = "not listed".into());
        }
        table.row_at(anchor, cells);
    }
    table
}

/// Set bits, and what the box shows where it is something else.
fn state(element: &TimerCounter) -> String {
    let Some(data) = element.data else { return "no element".to_owned() };
    let mut parts: Vec<String> =
        data.bits(element.kind).filter(|(_, on)| *on).map(|(name, _)| name.to_owned()).collect();
    for it in element.instructions.iter().filter(|it| it.setting_differs(&data) || it.accum_differs(&data)) {
        let text = |value: Option<i32>| value.map_or_else(|| "?".to_owned(), |value| value.to_string());
        parts.push(format!("box {}/{}", text(it.preset), text(it.accum)));
    }
    parts.join(" ")
}

fn named(element: &TimerCounter) -> String {
    let description = words::one_line(&element.description);
    match &element.symbol {
        Some(symbol) => format!("{symbol} {description}").trim_end().to_owned(),
        None => description,
    }
}

fn references(list: &[Reference], with_members: bool, left_out: usize) -> Text {
    let mut text = Text::default();
    let mut last = None;
    for reference in list {
        let members = if with_members { reference.members.join(",") } else { String::new() };
        let may = reference.certainty == Certainty::May;
        let key = (reference.location.file, reference.location.rung, members.clone(), may);
        if last.as_ref() == Some(&key) {
            continue;
        }
        text.push(if text.runs.is_empty() { "" } else { ", " }, None);
        text = text.and(rung(reference.location));
        text.push(if members.is_empty() { String::new() } else { format!(" {members}") }, None);
        text.push(if may { "?" } else { "" }, None);
        last = Some(key);
    }
    if left_out > 0 {
        text.push(format!(", and {left_out} more"), None);
    }
    text
}
