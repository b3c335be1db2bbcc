//! The cross reference: every address the program names, with all that reads or writes it.

use analysis::{Access, Certainty, Group, Through};

use super::{Context, remark, rung};
use crate::anchor::Anchor;
use crate::model::{Block, ColumnKind, Note, NoteKind, Table, Text};

pub(super) fn entries<'a>(context: &Context<'a, '_>) -> Vec<Block<'a>> {
    let mut table = Table::new(&[
        ("Rung", ColumnKind::Fixed),
        ("Does", ColumnKind::Text),
        ("Instruction", ColumnKind::Fixed),
        ("Operand", ColumnKind::Text),
        ("As written", ColumnKind::Fixed),
        ("Touches", ColumnKind::Fixed),
    ]);
    for group in context.xref.all() {
        entry(context, &group, &mut table);
    }
    let mut blocks = vec![remark(
        "Rungs are written file:rung. \"May\" stands where brackets or S:24 decide the place while the program runs. \
         Writers outside the program (panels, other controllers) do not stand in a project.",
    )];
    blocks.push(if table.rows.is_empty() { remark("The program names no address.") } else { Block::Table(table) });
    for note in context.xref.notes() {
        let mut text = note.location().map(rung).unwrap_or_default();
        let lead = if text.is_empty() { "" } else { "  " };
        text.push(format!("{lead}{}", note.as_str()), None);
        blocks.push(Block::Note(Note::new(NoteKind::Warning, text)));
    }
    if !context.xref.unresolved().is_empty() {
        blocks.push(Block::Heading("Operands about which nothing can be said".to_owned()));
        let mut table = Table::new(&[
            ("Rung", ColumnKind::Fixed),
            ("Instruction", ColumnKind::Fixed),
            ("Operand", ColumnKind::Text),
            ("As written", ColumnKind::Fixed),
            ("Why", ColumnKind::Text),
        ]);
        for it in context.xref.unresolved() {
            let (mnemonic, why) = (it.mnemonic.to_string(), it.kind.as_str());
            table.row([rung(it.location), mnemonic.into(), it.operand.into(), it.text.as_str().into(), why.into()]);
        }
        blocks.push(Block::Table(table));
    }
    blocks
}

fn entry(context: &Context<'_, '_>, group: &Group<'_>, table: &mut Table) {
    let (symbol, description) = context.documented(&group.address);
    let shown = group.address.to_string();
    let element = group.address.element_address().map(|whole| whole.to_string());
    let mut head = Text::default();
    head.push(shown.as_str(), Some(Anchor::element(element.as_deref().unwrap_or(&shown))));
    let module = context.image().io.describe(&group.address).unwrap_or_default();
    table.group(Anchor::reference(&shown), [head, symbol.into(), description.into(), module.into()]);
    for access in &group.accesses {
        let written = access.symbol.map_or_else(|| access.address.to_string(), str::to_owned);
        let same = |text: &str| if text == shown { String::new() } else { text.to_owned() };
        table.row([
            rung(access.location),
            does(access).into(),
            access.mnemonic.to_string().into(),
            access.operand.into(),
            same(&written).into(),
            if access.touched == written { String::new() } else { same(&access.touched) }.into(),
        ]);
    }
    let remark = match group.left_out {
        Some(0) if group.accesses.is_empty() => "no instruction reads or writes it".to_owned(),
        Some(0) => return,
        Some(more) => format!("and {more} more accesses; `rungs xref` with this address lists all"),
        None => "accesses not listed; `rungs xref` with this address lists them".to_owned(),
    };
    table.row([Text::default(), remark.into()]);
}

fn does(access: &Access<'_>) -> String {
    let may = if access.certainty == Certainty::May { "may " } else { "" };
    let through = match access.through {
        Through::Operand => String::new(),
        other => format!(" ({})", other.as_str()),
    };
    format!("{may}{}{through}", access.role.as_str())
}
