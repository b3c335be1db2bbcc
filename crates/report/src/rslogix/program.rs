//! The list of program files, and every ladder file.

use ladder::{ProgramFile, ProgramFileKind};

use super::{Context, remark, rungs};
use crate::anchor::Anchor;
use crate::model::{Block, ColumnKind, Rung, Section, Table, Text};
use crate::options::Kind;
use crate::words;

pub(super) fn list<'a>(context: &Context<'a, '_>) -> Vec<Block<'a>> {
    let mut table = Table::new(&[
        ("Name", ColumnKind::Text),
        ("Number", ColumnKind::Number),
        ("Type", ColumnKind::Text),
        ("Rungs", ColumnKind::Number),
        ("Runs", ColumnKind::Text),
        ("Description", ColumnKind::Text),
    ]);
    for file in context.image().program_files.iter().filter(|file| file.kind != ProgramFileKind::Unused) {
        let to = Anchor::file(file.number);
        let runs = if file.kind == ProgramFileKind::Ladder { runs(context, file) } else { Text::default() };
        table.row([
            Text::link(words::file_name(file), to.clone()),
            Text::link(file.number.to_string(), to),
            file.kind.as_str().into(),
            file.rungs.len().to_string().into(),
            runs,
            file.description.as_str().into(),
        ]);
    }
    vec![Block::Table(table)]
}

/// What makes a ladder file run.
fn runs(context: &Context<'_, '_>, file: &ProgramFile) -> Text {
    let Some(called) = context.calls.file(file.number) else { return Text::default() };
    let mut text = Text::default();
    for entry in &called.entries {
        let source = if entry.source.is_empty() { String::new() } else { format!(" ({})", entry.source) };
        text.push(format!("{}{}{source}", if text.is_empty() { "" } else { "; " }, entry.kind.as_str()), None);
    }
    if !called.called_by.is_empty() {
        text.push(if text.is_empty() { "called in " } else { "; called in " }, None);
        text = text.and(rungs(&called.called_by, 0));
    }
    if text.is_empty() {
        text.push("nothing calls it", None);
    } else if !called.reachable {
        text.push("; only from files that cannot run", None);
    }
    text
}

pub(super) fn ladder<'a>(context: &Context<'a, '_>, sections: &mut Vec<Section<'a>>) {
    let image = context.image();
    for file in image.ladder_files() {
        let title = words::file_title(file);
        let mut blocks = vec![remark(Text::plain("Runs: ").and(runs(context, file)))];
        let drawn = (0..file.rungs.len()).map(|index| Rung::of_file(image, file, index, context.documentation()));
        blocks.extend(drawn.map(Block::Rung));
        sections.push(Section {
            kind: Kind::Ladder,
            anchor: Anchor::file(file.number),
            title: format!("{title} --- Total Rungs in File = {}", file.rungs.len()),
            short: title,
            blocks,
        });
    }
}
