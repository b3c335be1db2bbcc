//! Tables on pages: heads on every page, long cells in several lines, narrow tables side by side.

use render::pdf::{Area, Color, Font, Letters};

use super::book::{Book, RULE, SHADE};
use super::columns::{Column, Plan, heading};
use super::text::{Line, lines, plain_lines};
use crate::model::{Row, RowKind, Table, Text};

/// Above and below the lines of a row.
const PAD: f32 = 1.0;

/// The cells of a row, each in lines.
type Cells<'t> = Vec<Vec<Line<'t>>>;

/// What is the same on every page of a table.
struct Frame {
    plan: Plan,
    /// The titles of the columns, each in lines of a font; empty: the table has none.
    titles: Vec<(Font, Vec<String>)>,
}

impl Frame {
    fn head(&self) -> Letters {
        Letters { font: Font::SansBold, size: self.plan.size, color: Color::BLACK }
    }

    fn head_height(&self) -> f32 {
        match self.titles.iter().map(|(_, lines)| lines.len()).max() {
            Some(lines) => self.plan.leading() * lines as f32 + 4.0,
            None => 0.0,
        }
    }

    /// Height of a row of some lines.
    fn height(&self, lines: usize) -> f32 {
        self.plan.leading() * lines as f32 + 2.0 * PAD
    }
}

impl<'a> Book<'a> {
    pub(super) fn table(&mut self, table: &Table) {
        if table.columns.is_empty() {
            return;
        }
        self.space(4.0);
        let plan = Plan::of(table, |strips| self.room_of(strips));
        let titled = table.columns.iter().any(|column| !column.title.is_empty());
        let cut = |(column, at): (&crate::model::Column, &Column)| {
            (heading(column), plain_lines(&column.title, heading(column), plan.size, at.width))
        };
        let titles = if titled { table.columns.iter().zip(&plan.columns).map(cut).collect() } else { Vec::new() };
        let frame = Frame { plan, titles };
        self.need(frame.head_height() + 3.0 * frame.height(1));
        self.begin_strips(frame.plan.strips);
        self.head(&frame, None);
        let mut group: Option<&Row> = None;
        for (index, row) in table.rows.iter().enumerate() {
            if row.kind == RowKind::Group {
                group = Some(row);
                // Not alone at the foot of a page.
                let next = table.rows.get(index + 1).is_some_and(|next| next.kind == RowKind::Plain);
                let below = if next { frame.height(1) } else { 0.0 };
                let text = group_text(row);
                let cut = lines(&text, Font::SansBold, frame.plan.size, self.room() - 4.0);
                self.escaped += cut.escaped;
                self.row(row, vec![cut.lines], &frame, None, below);
            } else {
                let mut cells = Vec::with_capacity(frame.plan.columns.len());
                for (cell, column) in row.cells.iter().zip(&frame.plan.columns) {
                    let cut = lines(cell, column.letters.font, frame.plan.size, column.cell_room());
                    self.escaped += cut.escaped;
                    cells.push(cut.lines);
                }
                self.row(row, cells, &frame, group, 0.0);
            }
        }
        self.end_strips();
        self.y += 4.0;
    }

    /// Paints a row; `below`: height that must be left after it.
    fn row(&mut self, row: &Row, cells: Cells<'_>, frame: &Frame, group: Option<&Row>, below: f32) {
        let count = cells.iter().map(Vec::len).max().unwrap_or(1).max(1);
        let height = frame.height(count);
        let page = self.sheet.height() - frame.head_height() - 2.0 * frame.height(1);
        // A row stays whole unless it is high; nothing is cut for less than three lines.
        let whole = height <= page / 3.0;
        let wanted = if whole { height } else { height.min(frame.height(3)) };
        if self.left_over() + 0.01 < wanted + below {
            self.advance();
            self.head(frame, group);
        }
        if let Some(anchor) = &row.anchor {
            self.mark(anchor.as_str());
        }
        let mut from = 0;
        while from < count {
            if from > 0 {
                self.advance();
                self.head(frame, group);
            }
            let fits = ((self.left_over() - 2.0 * PAD + 0.01) / frame.plan.leading()) as usize;
            let to = (from + fits.max(1)).min(count);
            self.part(row, &cells, frame, from..to);
            from = to;
        }
    }

    /// Paints some lines of the cells of a row.
    fn part(&mut self, row: &Row, cells: &Cells<'_>, frame: &Frame, part: std::ops::Range<usize>) {
        let (left, right) = (self.left(), self.right());
        let (top, height) = (self.y, frame.height(part.len()));
        let group = row.kind == RowKind::Group;
        if group {
            self.canvas().fill(Area { left, top, right, bottom: top + height }, SHADE);
        }
        for (cell, column) in cells.iter().zip(&frame.plan.columns) {
            for (line, index) in cell.iter().take(part.end).skip(part.start).zip(0_u16..) {
                let y = top + PAD + frame.plan.size + frame.plan.leading() * f32::from(index);
                let x = column.start(left, line.width);
                let (x, letters) = if group { (left + 2.0, frame.head()) } else { (x, column.letters) };
                let room = if group { right - left } else { column.width };
                self.paint(line, x, y, letters, room);
            }
        }
        self.y += height;
        let y = self.y;
        self.canvas().line(&[(left, y), (right, y)], 0.25, RULE);
    }

    /// The titles of the columns, and the group a page goes on with.
    fn head(&mut self, frame: &Frame, group: Option<&Row>) {
        let (left, right, letters) = (self.left(), self.right(), frame.head());
        if !frame.titles.is_empty() {
            let bottom = self.y + frame.head_height();
            for ((font, lines), column) in frame.titles.iter().zip(&frame.plan.columns) {
                let letters = Letters { font: *font, ..letters };
                for (line, index) in lines.iter().rev().zip(0_u16..) {
                    let x = column.start(left, letters.font.width(line, letters.size));
                    // Titles stand on the line below them.
                    let y = bottom - 4.0 - frame.plan.leading() * f32::from(index);
                    self.canvas().text(x, y, letters, line);
                }
            }
            self.y = bottom;
            self.canvas().line(&[(left, bottom - 1.0), (right, bottom - 1.0)], 0.6, Color::BLACK);
        }
        if let Some(group) = group {
            let name = group.cells.first().map(Text::characters).unwrap_or_default();
            let (top, bottom) = (self.y, self.y + frame.height(1));
            self.canvas().fill(Area { left, top, right, bottom }, SHADE);
            let (y, room) = (top + PAD + frame.plan.size, right - left - 4.0);
            self.canvas().fitted(left + 2.0, y, letters, room, &format!("{name} (continued)"));
            self.y = bottom;
        }
    }
}

/// A row that heads others: its name, then what is told about it.
fn group_text(row: &Row) -> Text {
    let mut text = Text::default();
    for cell in row.cells.iter().filter(|cell| !cell.is_empty()) {
        if !text.is_empty() {
            text.push("   ", None);
        }
        text = text.and(cell.clone());
    }
    text
}
