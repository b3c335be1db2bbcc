//! What the cross reference shows to be missing, and how much is documented.

use analysis::{Coverage, Finding, FindingKind};
use ladder::Radix;

use super::overview::Pairs;
use super::{Context, remark, rungs};
use crate::anchor::Anchor;
use crate::model::{Block, ColumnKind, Note, NoteKind, Table, Text};
use crate::words;

pub(super) fn list<'a>(context: &Context<'a, '_>, kind: FindingKind) -> Vec<Block<'a>> {
    let findings = context.xref.findings();
    let (worth, expected): (Vec<&Finding>, Vec<&Finding>) =
        findings.list.iter().filter(|finding| finding.kind == kind).partition(|finding| finding.expected.is_none());
    let mut blocks = vec![remark(match kind {
        FindingKind::WrittenNeverRead => {
            "The program writes these addresses and nothing in it reads them: results for an operator panel or another \
             controller, or left over."
        }
        FindingKind::ReadNeverWritten => {
            "The program reads these addresses and nothing in it writes them: most likely set by an operator panel or \
             another controller, or constants in the data table."
        }
        _ => "The program uses these addresses; they and their elements have neither symbol nor description.",
    })];
    blocks.push(if worth.is_empty() { remark("None.") } else { Block::Table(table(context, &worth, false)) });
    if !expected.is_empty() {
        blocks.push(Block::Heading("Normal for their kind".to_owned()));
        blocks.push(Block::Table(table(context, &expected, true)));
    }
    if findings.not_judged > 0 {
        let text = format!("{} not judged: too many accesses overlap.", words::count(findings.not_judged, "address"));
        blocks.push(Block::Note(Note::new(NoteKind::Warning, text)));
    }
    blocks
}

fn table(context: &Context<'_, '_>, findings: &[&Finding], reasons: bool) -> Table {
    let mut columns = vec![
        ("Address", ColumnKind::Fixed),
        ("Symbol", ColumnKind::Text),
        ("Description", ColumnKind::Text),
        ("Value", ColumnKind::Text),
        ("Rungs", ColumnKind::Text),
    ];
    if reasons {
        columns.push(("Why", ColumnKind::Text));
    }
    let mut table = Table::new(&columns);
    for finding in findings {
        let (symbol, description) = context.documented(&finding.address);
        let shown = finding.address.to_string();
        let anchor = Anchor::reference(&shown);
        let value = finding.value.as_ref().map(|value| value.text(Radix::Decimal)).unwrap_or_default();
        let mut cells = vec![
            Text::link(shown, anchor),
            symbol.into(),
            description.into(),
            value.into(),
            rungs(&finding.locations, finding.left_out),
        ];
        cells.extend(finding.expected.map(|reason| Text::plain(reason.as_str())));
        table.row(cells);
    }
    table
}

pub(super) fn coverage<'a>(context: &Context<'a, '_>) -> Vec<Block<'a>> {
    let (image, documentation) = (context.image(), context.documentation());
    let figures = Coverage::build(image, documentation, &context.xref);
    let mut pairs = Pairs::new();
    pairs.add("Addresses with a symbol or description", words::share(figures.documented, figures.addresses));
    pairs.add("Addresses with a symbol", words::share(figures.with_symbol, figures.addresses));
    pairs.add("Addresses with a description", words::share(figures.with_description, figures.addresses));
    pairs.add("Rungs with a comment", words::share(figures.with_comment, figures.rungs));
    pairs.add("Rungs with a page title", words::share(figures.with_title, figures.rungs));
    pairs.add("Ladder files with a name", words::share(figures.files_with_name, figures.files));
    pairs.add("Ladder files with a description", words::share(figures.files_with_description, figures.files));
    let mut table = Table::new(&[
        ("File", ColumnKind::Text),
        ("Rungs", ColumnKind::Number),
        ("With comment", ColumnKind::Number),
        ("Share", ColumnKind::Number),
    ]);
    for file in image.ladder_files() {
        let rungs = file.rungs.iter().filter(|rung| !rung.is_end());
        let commented = |rung: &&ladder::Rung| rung.comment.as_ref().is_some_and(|c| !c.text.trim().is_empty());
        let (all, with) = (rungs.clone().count(), rungs.filter(commented).count());
        let name = format!("{} {}", file.number, file.name).trim_end().to_owned();
        let share = words::percent(with, all);
        table.row([
            Text::link(name, Anchor::file(file.number)),
            all.to_string().into(),
            with.to_string().into(),
            share.into(),
        ]);
    }
    vec![pairs.block(), Block::Table(table)]
}
