//! Drawn rungs on pages: whole where a page has room, else cut beside instructions with a word about it.

use render::Style;
use render::pdf::{Color, Font, Grid, Letters, breaks, rung};

use super::book::{ALARM, BODY, Book, Entry};
use super::text::plain_lines;
use crate::model::Rung;

/// Points a column of the grid is wide, about. Courier of 8.8 points.
const CELL: f32 = 5.3;
/// Height of a row in cells: lines of text stay apart, a page holds some sixty.
const ROW: f32 = 2.0;
/// Cut only where at least this part of a page is filled.
const PART: f32 = 0.4;

const REMARK: Letters = Letters { font: Font::Sans, size: 7.0, color: Color(0.3, 0.3, 0.3) };
/// Height of a line that says a rung goes on.
const REMARK_HEIGHT: f32 = 10.0;

impl<'a> Book<'a> {
    pub(super) fn rung(&mut self, drawn: &Rung<'_>) {
        let room = self.room();
        let width = ((room / CELL) as usize).clamp(render::MIN_WIDTH, render::MAX_WIDTH);
        let cell = room / width as f32;
        let row = cell * ROW;
        let style = Style { state: self.state, ..Style::graphic(width) };
        let scene = drawn.scene(&style);
        // The last row only keeps rungs apart.
        let needed = scene.height.saturating_sub(1) as f32 * row;
        let page = self.sheet.height();
        let rows = |points: f32| ((points + 0.01) / row) as usize;
        let whole = needed <= page;
        if whole {
            self.need(needed);
        } else if self.left_over() < page * PART {
            self.new_page();
        }
        let place = self.here();
        self.mark(drawn.anchor.as_str());
        if !drawn.title.is_empty() {
            let title = format!("{} {}", drawn.label, drawn.title);
            self.entries.push(Entry { title, level: 2, place });
        }
        let first = if whole { scene.height } else { rows(self.left_over() - REMARK_HEIGHT) };
        let pieces = breaks(&scene, first, rows(page - 2.0 * REMARK_HEIGHT));
        let last = pieces.len() - 1;
        let document = self.document;
        let mut narrowed = Vec::new();
        for (index, piece) in pieces.into_iter().enumerate() {
            if index > 0 {
                self.new_page();
                self.remark(&format!("Rung {}, continued", drawn.label));
            }
            let grid = Grid { left: self.left(), top: self.y, cell, row };
            let height = piece.len() as f32 * row;
            let mut place = |address: &str| Some(document.place_of_address(address)?.as_str().to_owned());
            narrowed.extend(rung(self.canvas(), &scene, piece, &grid, &mut place));
            self.y += height;
            if index < last {
                self.remark(&format!("Rung {} continues on the next page", drawn.label));
            }
        }
        for text in narrowed {
            self.spelled_out(&text);
        }
    }

    fn remark(&mut self, text: &str) {
        let (left, y) = (self.left(), self.y + 7.0);
        self.canvas().text(left, y, REMARK, text);
        self.y += REMARK_HEIGHT;
    }

    /// A text of a rung for which the drawing had no room.
    fn spelled_out(&mut self, text: &str) {
        let letters = Letters { color: ALARM, size: BODY, font: Font::Mono };
        let (left, room) = (self.left() + 24.0, self.room() - 24.0);
        for line in plain_lines(&format!("shown too narrow above: {text}"), letters.font, letters.size, room) {
            self.need(REMARK_HEIGHT);
            let y = self.y + BODY;
            self.canvas().text(left, y, letters, &line);
            self.y += REMARK_HEIGHT;
        }
    }
}
