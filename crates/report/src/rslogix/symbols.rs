//! Symbols, descriptions, comments.

use ladder::{AddressEntry, CommentOwner, Target};

use super::{Context, remark};
use crate::anchor::Anchor;
use crate::model::{Block, ColumnKind, Note, NoteKind, Table, Text};
use crate::words::one_line;

/// Paper sorts by the letters of the file, then by numbers; symbols without an address come first.
fn order(target: &Target) -> (u8, String, u16, u16, u16, u16, String) {
    match target {
        Target::Unassigned => (0, String::new(), 0, 0, 0, 0, String::new()),
        Target::Address(address) => {
            let number = |place: &ladder::Place| place.number().unwrap_or(u16::MAX);
            (
                1,
                address.file_type.to_string(),
                number(&address.file),
                number(&address.element),
                address.word.map_or(0, |word| word.saturating_add(1)),
                address.bit.as_ref().map_or(0, |bit| number(bit).saturating_add(1)),
                address.to_string(),
            )
        }
        Target::ProgramFileOperand(number) => (2, String::new(), *number, 0, 0, 0, String::new()),
        Target::Label { file, number } => (3, String::new(), *file, *number, 0, 0, String::new()),
        Target::ProgramFile(number) => (4, String::new(), *number, 0, 0, 0, String::new()),
        Target::DataFile(number) => (5, String::new(), *number, 0, 0, 0, String::new()),
        Target::Other(text) => (6, text.clone(), 0, 0, 0, 0, String::new()),
    }
}

/// Where a target is looked up: an address in the cross reference, a program file at its rungs.
fn place(target: &Target) -> Option<Anchor> {
    match target {
        Target::Address(address) => Some(Anchor::reference(&address.to_string())),
        Target::ProgramFileOperand(number) | Target::ProgramFile(number) => Some(Anchor::file(number)),
        _ => None,
    }
}

fn linked(target: &Target) -> Text {
    let mut text = Text::default();
    text.push(target.to_string(), place(target));
    text
}

pub(super) fn database<'a>(context: &Context<'a, '_>) -> Vec<Block<'a>> {
    let mut entries: Vec<&AddressEntry> = context.documentation().entries().iter().collect();
    if entries.is_empty() {
        return vec![remark("The project holds no symbols and descriptions.")];
    }
    entries.sort_by_cached_key(|entry| order(&entry.target));
    let mut table =
        Table::new(&[("Address", ColumnKind::Fixed), ("Symbol", ColumnKind::Text), ("Description", ColumnKind::Text)]);
    for entry in entries {
        let cells = [linked(&entry.target), entry.symbol.as_str().into(), one_line(&entry.description).into()];
        match &entry.target {
            Target::Address(address) => table.row_at(Anchor::symbol(&address.to_string()), cells),
            _ => table.row(cells),
        }
    }
    vec![Block::Table(table)]
}

pub(super) fn instruction_comments<'a>(context: &Context<'a, '_>) -> Vec<Block<'a>> {
    let documentation = context.documentation();
    let mut table = Table::new(&[
        ("Address", ColumnKind::Fixed),
        ("Instruction", ColumnKind::Text),
        ("Description", ColumnKind::Text),
    ]);
    for comment in documentation.instruction_comments() {
        let target = comment.target.as_ref().map_or_else(|| Text::plain("(address record gone)"), linked);
        table.row([target, comment.mnemonic.as_str().into(), one_line(&comment.lines).into()]);
    }
    let mut blocks = Vec::new();
    blocks.push(if table.rows.is_empty() {
        remark("The project holds no instruction comments.")
    } else {
        Block::Table(table)
    });
    if !documentation.detached_comments.is_empty() {
        blocks.push(Block::Heading("Rung comments that no rung shows".to_owned()));
        blocks.push(remark("Their rung was deleted or has another comment; they are kept in the project."));
        let mut table = Table::new(&[
            ("Belongs to", ColumnKind::Fixed),
            ("Title", ColumnKind::Text),
            ("Comment", ColumnKind::Text),
        ]);
        for comment in &documentation.detached_comments {
            let owner = match &comment.owner {
                CommentOwner::Rung { file, rung } => Text::plain(format!("{file}:{rung}")),
                CommentOwner::Address(target) => linked(target),
            };
            let lines: Vec<&str> = comment.lines().collect();
            table.row([owner, comment.title.as_str().into(), lines.join("\n").into()]);
        }
        blocks.push(Block::Table(table));
    }
    blocks
}

/// Symbol groups have a list of their own in a project. What stands in it is not known: no project has
/// been seen with one, so that the reader carries it and says so.
pub(super) fn groups<'a>(context: &Context<'a, '_>) -> Vec<Block<'a>> {
    let mut found = context.source.project.diagnostics.iter().filter(|it| it.message.contains("symbol group"));
    vec![match found.next() {
        Some(it) => Block::Note(Note::new(
            NoteKind::Warning,
            Text::link(format!("Symbol groups were not read: {}", it.message), Anchor::named("diagnostics")),
        )),
        None => remark("The project holds no symbol groups."),
    }]
}
