//! Which file calls which, labels and jumps.

use std::collections::HashSet;

use analysis::{CallGraph, CalledFile, Target};

use super::{Context, remark, rung, rungs};
use crate::anchor::Anchor;
use crate::model::{Block, ColumnKind, Table, Text, TreeItem};

/// Levels of calls that are shown; controllers allow eight, or four within an interrupt.
const DEPTH: usize = 16;

pub(super) fn tree<'a>(context: &Context<'a, '_>) -> Vec<Block<'a>> {
    let calls = &context.calls;
    let mut expanded = HashSet::new();
    let started = calls.files.iter().filter(|file| !file.entries.is_empty());
    let items: Vec<TreeItem> = started
        .map(|file| {
            let mut text = name(file);
            for entry in &file.entries {
                let source = if entry.source.is_empty() { String::new() } else { format!(" ({})", entry.source) };
                text.push(format!(" - {}{source}", entry.kind.as_str()), None);
            }
            TreeItem { text, items: below(calls, file.number, &mut expanded, &mut vec![file.number]) }
        })
        .collect();
    let mut blocks =
        vec![if items.is_empty() { remark("The program has no ladder files.") } else { Block::Tree(items) }];
    let idle: Vec<&CalledFile> = calls.files.iter().filter(|file| !file.reachable).collect();
    if !idle.is_empty() {
        blocks.push(Block::Heading("Files that cannot run".to_owned()));
        blocks.push(remark(
            "No call leads there from the main program or an interrupt known here. Interrupt routines that are assigned \
             to modules stand in the modules' configuration and are not known.",
        ));
        let mut table =
            Table::new(&[("File", ColumnKind::Text), ("Rungs", ColumnKind::Number), ("Called in", ColumnKind::Text)]);
        for file in idle {
            table.row([name(file), file.rungs.to_string().into(), rungs(&file.called_by, 0)]);
        }
        blocks.push(Block::Table(table));
    }
    let broken = calls.calls.iter().filter_map(|call| {
        let what = match &call.target {
            Target::File(_) => return None,
            Target::Missing(number) => format!("file {number} holds no ladder"),
            Target::Unknown(text) => format!("`{text}` names no file"),
        };
        Some([rung(call.location), what.into()])
    });
    let mut table = Table::new(&[("JSR in", ColumnKind::Fixed), ("Why it leads nowhere", ColumnKind::Text)]);
    broken.for_each(|row| table.row(row));
    if !table.rows.is_empty() {
        blocks.push(Block::Heading("Calls that lead nowhere".to_owned()));
        blocks.push(Block::Table(table));
    }
    if !calls.labels.is_empty() {
        blocks.push(Block::Heading("Labels and jumps".to_owned()));
        let mut table = Table::new(&[
            ("Label", ColumnKind::Fixed),
            ("Stands in", ColumnKind::Text),
            ("Jumps in", ColumnKind::Text),
        ]);
        for label in &calls.labels {
            let or_none = |text: Text| if text.is_empty() { Text::plain("no rung") } else { text };
            let shown = format!("Q{}:{}", label.file, label.number);
            table.row([shown.into(), or_none(rungs(&label.defined, 0)), or_none(rungs(&label.jumps, 0))]);
        }
        blocks.push(Block::Table(table));
    }
    blocks
}

fn name(file: &CalledFile) -> Text {
    Text::link(format!("{} {}", file.number, file.name).trim_end().to_owned(), Anchor::file(file.number))
}

/// The files a file calls, each once, expanded where it is called first.
fn below(calls: &CallGraph, file: u16, expanded: &mut HashSet<u16>, path: &mut Vec<u16>) -> Vec<TreeItem> {
    if !expanded.insert(file) || path.len() > DEPTH {
        return Vec::new();
    }
    let mut targets: Vec<u16> = Vec::new();
    for call in calls.calls.iter().filter(|call| call.location.file == file) {
        if let Target::File(number) = call.target
            && !targets.contains(&number)
        {
            targets.push(number);
        }
    }
    let item = |number: u16| {
        let mut text = calls.file(number).map(name).unwrap_or_default();
        text.push(" - called in ", None);
        let from = calls.calls.iter().filter(|c| c.location.file == file && c.target == Target::File(number));
        text = text.and(rungs(&from.map(|call| call.location).collect::<Vec<_>>(), 0));
        if path.contains(&number) {
            text.push(" - recursion: it is already running here", None);
            return TreeItem { text, items: Vec::new() };
        }
        if expanded.contains(&number) && calls.calls.iter().any(|call| call.location.file == number) {
            text.push(" - its calls are listed above", None);
        }
        path.push(number);
        let items = below(calls, number, expanded, path);
        path.pop();
        TreeItem { text, items }
    };
    targets.into_iter().map(item).collect()
}
