//! The online image against the offline program.

use analysis::diff::{Change, Difference, LogicChange, Place, Side, Word, compare};

use super::{Context, remark};
use crate::anchor::Anchor;
use crate::model::{Block, ColumnKind, Note, NoteKind, Table, Text};
use crate::words;

/// Rows of one table; a difference beyond is one of two different programs.
const ROWS: usize = 2_000;

pub(super) fn difference<'a>(context: &Context<'a, '_>) -> Vec<Block<'a>> {
    let project = context.source.project;
    let Some(online) = &project.online else {
        return vec![remark("The project holds no online image.")];
    };
    let offline = Side { image: &project.main, documentation: None };
    let found = compare(offline, Side { image: online, documentation: None });
    let mut blocks = vec![remark(
        "The online image is the program as it was last exchanged with a processor. It has no documentation of its own, \
         so none is compared; values are those of the moment it was read.",
    )];
    if found.is_empty() {
        blocks.push(remark("Logic, values and configuration of the two are equal."));
        return blocks;
    }
    logic(context, &found, &mut blocks);
    values(&found, &mut blocks);
    changes(&found.configuration, &mut blocks);
    // That documentation was left out is said above.
    let notes = found.notes.iter().filter(|note| !note.starts_with("documentation"));
    blocks.extend(notes.map(|note| Block::Note(Note::new(NoteKind::Warning, format!("{note}.")))));
    blocks
}

fn heading<'a>(name: &str, count: usize, blocks: &mut Vec<Block<'a>>) -> bool {
    let text = match count {
        0 => format!("{name}: equal"),
        count => format!("{name}: {}", words::count(count, "difference")),
    };
    blocks.push(Block::Heading(text));
    count > 0
}

fn cut(table: &mut Table, blocks: &mut Vec<Block<'_>>) {
    let more = table.rows.len().saturating_sub(ROWS);
    table.rows.truncate(ROWS);
    if more > 0 {
        let text = format!("{more} more rows are not listed; `rungs diff --online` lists all.");
        blocks.push(Block::Note(Note::new(NoteKind::Warning, text)));
    }
}

fn logic<'a>(context: &Context<'a, '_>, found: &Difference, blocks: &mut Vec<Block<'a>>) {
    if !heading("Logic", found.logic.len(), blocks) {
        return;
    }
    for it in &found.renames {
        let operands = words::count(it.operands, "operand");
        blocks.push(remark(format!("{} offline is {} online, throughout ({operands}).", it.old, it.new)));
    }
    // Only the image that is shown has its rungs in the document.
    let shows_main = std::ptr::eq(context.image(), &context.source.project.main);
    let place = |at: Option<Place>, shown: bool| match at {
        Some(at) if shown => Text::link(format!("{}:{}", at.file, at.rung), Anchor::rung(at.file, at.rung)),
        Some(at) => Text::plain(format!("{}:{}", at.file, at.rung)),
        None => Text::default(),
    };
    let mut table = Table::new(&[
        ("Change", ColumnKind::Text),
        ("Offline", ColumnKind::Fixed),
        ("Online", ColumnKind::Fixed),
        ("Offline rung", ColumnKind::Text),
        ("Online rung", ColumnKind::Text),
    ]);
    for change in &found.logic {
        match change {
            LogicChange::File(file) => {
                let number = |number: Option<u16>| Text::plain(number.map(|n| format!("file {n}")).unwrap_or_default());
                let kind = format!("program file {}", file.kind);
                table.row([kind.into(), number(file.old), number(file.new), words::count(file.rungs, "rung").into()]);
            }
            LogicChange::Rung(rung) => table.row([
                rung.kind.as_str().into(),
                place(rung.old, shows_main),
                place(rung.new, !shows_main),
                marked(&rung.old_words),
                marked(&rung.new_words),
            ]),
        }
    }
    cut(&mut table, blocks);
    blocks.push(Block::Table(table));
}

/// The words of a rung; those that differ stand between arrows, which need no colour.
fn marked(words: &[Word]) -> Text {
    let text =
        words.iter().map(|word| if word.marked { format!("\u{25B8}{}\u{25C2}", word.text) } else { word.text.clone() });
    Text::plain(text.collect::<Vec<_>>().join(" "))
}

fn values(found: &Difference, blocks: &mut Vec<Block<'_>>) {
    if !heading("Values", found.values.len(), blocks) {
        return;
    }
    let mut table =
        Table::new(&[("Addresses", ColumnKind::Fixed), ("Offline", ColumnKind::Text), ("Online", ColumnKind::Text)]);
    for change in &found.values {
        let places = if change.first == change.last {
            change.first.clone()
        } else {
            format!("{} .. {}", change.first, change.last)
        };
        table.row([places.into(), change.old.join(" ").into(), change.new.join(" ").into()]);
    }
    cut(&mut table, blocks);
    blocks.push(Block::Table(table));
}

fn changes(list: &[Change], blocks: &mut Vec<Block<'_>>) {
    if !heading("Configuration", list.len(), blocks) {
        return;
    }
    let mut table = Table::new(&[
        ("What", ColumnKind::Text),
        ("Which", ColumnKind::Text),
        ("Offline", ColumnKind::Text),
        ("Online", ColumnKind::Text),
    ]);
    for change in list {
        let text = |text: &Option<String>| Text::plain(text.clone().unwrap_or_else(|| "not there".to_owned()));
        table.row([change.what.into(), change.name.as_str().into(), text(&change.old), text(&change.new)]);
    }
    cut(&mut table, blocks);
    blocks.push(Block::Table(table));
}
