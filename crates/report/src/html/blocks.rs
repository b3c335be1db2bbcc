//! Blocks as HTML. End tags that HTML lets stand without are left out: a report has tens of thousands.

use std::io::{self, Write};

use render::svg;

use crate::model::{Block, Column, ColumnKind, Document, Note, NoteKind, Row, RowKind, Rung, Table, Text, TreeItem};

use super::escape;
use super::sizes::{self, Sizes};

/// Columns of a drawing.
const WIDTH: usize = 110;

/// Writes blocks and tells about how high they are.
pub(super) fn write(
    document: &Document<'_>,
    blocks: &[Block<'_>],
    heights: &mut Sizes,
    out: &mut dyn Write,
) -> io::Result<usize> {
    let mut pixels = 0;
    let mut in_rungs = false;
    for block in blocks {
        // The rungs of a file move sideways together where they are wider than the window.
        pixels += sizes::of_block(block);
        let is_rung = matches!(block, Block::Rung(_));
        if is_rung != std::mem::replace(&mut in_rungs, is_rung) {
            out.write_all(if is_rung { b"<div class=rungs>\n" } else { b"</div>\n" })?;
        }
        match block {
            Block::Heading(heading) => writeln!(out, "<h3>{}</h3>", escape(heading))?,
            Block::Pairs(pairs) => {
                out.write_all(b"<dl>\n")?;
                for pair in pairs {
                    write!(out, "<div><dt>{}</dt><dd>", escape(&pair.name))?;
                    text(&pair.value, out)?;
                    out.write_all(b"</dd></div>\n")?;
                }
                out.write_all(b"</dl>\n")?;
            }
            Block::Table(of) if of.rows.iter().any(|row| row.kind == RowKind::Group) => grouped(of, heights, out)?,
            Block::Table(of) => table(of, heights, out)?,
            Block::Rung(of) => pixels += rung(document, of, heights, out)?,
            Block::Note(of) => note(of, out)?,
            Block::Tree(items) => {
                out.write_all(b"<ul class=tree>\n")?;
                tree(items, out)?;
                out.write_all(b"</ul>\n")?;
            }
        }
    }
    if in_rungs {
        out.write_all(b"</div>\n")?;
    }
    Ok(pixels)
}

pub(super) fn note(note: &Note, out: &mut dyn Write) -> io::Result<()> {
    let class = match note.kind {
        NoteKind::Remark => "",
        NoteKind::Warning => " w",
        NoteKind::Error => " b",
    };
    write!(out, "<p class=\"note{class}\">")?;
    if note.kind != NoteKind::Remark {
        write!(out, "<strong>{}:</strong> ", note.kind.as_str())?;
    }
    text(&note.text, out)?;
    out.write_all(b"</p>\n")
}

/// A text with its links.
pub(super) fn text(text: &Text, out: &mut dyn Write) -> io::Result<()> {
    for run in &text.runs {
        match &run.link {
            Some(link) => write!(out, "<a href=\"#{link}\">{}</a>", escape(&run.text))?,
            None => write!(out, "{}", escape(&run.text))?,
        }
    }
    Ok(())
}

fn class(column: Option<&Column>) -> &'static str {
    match column.map(|column| column.kind) {
        Some(ColumnKind::Number) => " class=n",
        Some(ColumnKind::Fixed) => " class=f",
        _ => "",
    }
}

fn table(table: &Table, heights: &mut Sizes, out: &mut dyn Write) -> io::Result<()> {
    write!(out, "<div class=\"wide v {}\"><table><thead><tr>", heights.class(sizes::of_table(table)))?;
    for column in &table.columns {
        write!(out, "<th{}>{}", class(Some(column)), escape(&column.title))?;
    }
    out.write_all(b"<tbody>\n")?;
    for row in &table.rows {
        plain(table, row, true, out)?;
    }
    out.write_all(b"</table></div>\n")
}

/// A row; `classes`: its cells say how they are set.
fn plain(table: &Table, row: &Row, classes: bool, out: &mut dyn Write) -> io::Result<()> {
    match &row.anchor {
        Some(anchor) => write!(out, "<tr id=\"{anchor}\">")?,
        None => out.write_all(b"<tr>")?,
    }
    // Empty cells at the end say nothing.
    let used = row.cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1);
    for (number, cell) in row.cells.iter().take(used).enumerate() {
        write!(out, "<td{}>", class(table.columns.get(number).filter(|_| classes)))?;
        text(cell, out)?;
    }
    out.write_all(b"\n")
}

/// Groups as blocks of their own, which a browser can leave out while they are not in sight.
fn grouped(table: &Table, heights: &mut Sizes, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(b"<div class=wide><table class=heads><thead><tr>")?;
    for (number, column) in table.columns.iter().enumerate() {
        write!(out, "<th class=c{number}>{}", escape(&column.title))?;
    }
    // Tens of thousands of cells do not say themselves how they are set.
    out.write_all(b"</table></div>\n<div class=\"gs")?;
    for (number, _) in table.columns.iter().enumerate().filter(|(_, column)| column.kind == ColumnKind::Fixed) {
        write!(out, " f{number}")?;
    }
    out.write_all(b"\">\n")?;
    let mut rows = table.rows.iter().peekable();
    while let Some(row) = rows.next() {
        if row.kind != RowKind::Group {
            continue;
        }
        let below = rows.clone().take_while(|row| row.kind == RowKind::Plain).count();
        let class = heights.class(sizes::of_row(row.kind) + below * sizes::of_row(RowKind::Plain));
        write!(out, "<div class=\"g v {class}\"")?;
        match &row.anchor {
            Some(anchor) => write!(out, " id=\"{anchor}\"><p>")?,
            None => out.write_all(b"><p>")?,
        }
        for (number, cell) in row.cells.iter().enumerate().filter(|(_, cell)| !cell.is_empty()) {
            let tag = match number {
                0 => "b",
                1 => "strong",
                2 => "span",
                _ => "i",
            };
            write!(out, "<{tag}>")?;
            text(cell, out)?;
            write!(out, "</{tag}> ")?;
        }
        out.write_all(b"</p>")?;
        if rows.peek().is_some_and(|row| row.kind == RowKind::Plain) {
            // Widths come from the first row.
            out.write_all(b"<table>")?;
            for number in 0..table.columns.len() {
                write!(out, "<col class=c{number}>")?;
            }
            out.write_all(b"<tbody>\n")?;
            while let Some(row) = rows.next_if(|row| row.kind == RowKind::Plain) {
                plain(table, row, false, out)?;
            }
            out.write_all(b"</table>")?;
        }
        out.write_all(b"</div>\n")?;
    }
    out.write_all(b"</div>\n")
}

fn tree(items: &[TreeItem], out: &mut dyn Write) -> io::Result<()> {
    for item in items {
        out.write_all(b"<li><span>")?;
        text(&item.text, out)?;
        out.write_all(b"</span>")?;
        if !item.items.is_empty() {
            out.write_all(b"<ul>\n")?;
            tree(&item.items, out)?;
            out.write_all(b"</ul>")?;
        }
        out.write_all(b"</li>\n")?;
    }
    Ok(())
}

/// Draws a rung and tells how high it is.
fn rung(document: &Document<'_>, rung: &Rung<'_>, heights: &mut Sizes, out: &mut dyn Write) -> io::Result<usize> {
    let scene = rung.scene(&render::Style::graphic(WIDTH));
    let href = |address: &str| document.place_of_address(address).map(|place| format!("#{place}"));
    let pixels = sizes::of_rows(scene.height);
    let label = format!("Rung {}", rung.label);
    let options = svg::Options { href: &href, label: &label, ..svg::Options::default() };
    writeln!(
        out,
        "<div class=\"r v {}\" id=\"{}\" data-rung=\"{}\">{}</div>",
        heights.class(pixels),
        rung.anchor,
        escape(&rung.label),
        svg::drawing(&scene, &options)
    )?;
    Ok(pixels)
}
