//! Headings, names with values, notes and trees on pages.

use render::pdf::{Color, Font, Letters};

use super::book::{ALARM, BODY, Book, LEADING, RULE};
use super::text::{Lines, lines, natural, plain_lines};
use crate::model::{Note, NoteKind, Pair, Text, TreeItem};

const PLAIN: Letters = Letters { font: Font::Sans, size: BODY, color: Color::BLACK };
const BOLD: Letters = Letters { font: Font::SansBold, size: BODY, color: Color::BLACK };
/// Names take at most this part of the width.
const NAMES: f32 = 0.35;
/// How far an item of a tree stands to the right of the one it is below.
const INDENT: f32 = 14.0;

impl<'a> Book<'a> {
    pub(super) fn heading(&mut self, title: &str) {
        self.space(8.0);
        // Not alone at the foot of a page.
        self.need(4.0 * LEADING);
        self.title(title, 9.5, false);
        self.y += 2.0;
    }

    /// Paints lines from `x`, going to the next page where one is full.
    fn lines(&mut self, lines: Lines<'_>, x: f32, letters: Letters) {
        self.escaped += lines.escaped;
        for line in &lines.lines {
            self.need(LEADING);
            let y = self.y + BODY;
            self.paint(line, x, y, letters, f32::INFINITY);
            self.y += LEADING;
        }
    }

    pub(super) fn pairs(&mut self, pairs: &[Pair]) {
        self.space(4.0);
        let (left, room) = (self.left(), self.room());
        let widest = pairs.iter().map(|pair| natural(&Text::plain(&*pair.name), BOLD.font, BODY)).fold(0.0, f32::max);
        let names = (widest + 12.0).min(room * NAMES);
        for pair in pairs {
            let name = plain_lines(&pair.name, BOLD.font, BODY, names - 6.0);
            self.need(LEADING * name.len() as f32);
            let top = self.y;
            for (index, line) in name.iter().enumerate() {
                let y = top + BODY + LEADING * index as f32;
                self.canvas().text(left, y, BOLD, line);
            }
            let page = self.pages.len();
            let value = lines(&pair.value, PLAIN.font, BODY, room - names);
            self.lines(value, left + names, PLAIN);
            if self.pages.len() == page {
                self.y = self.y.max(top + LEADING * name.len() as f32);
            }
            self.y += 1.5;
        }
    }

    pub(super) fn note(&mut self, note: &Note) {
        self.space(4.0);
        let color = if note.kind == NoteKind::Remark { Color(0.25, 0.25, 0.25) } else { ALARM };
        let word = format!("{}: ", note.kind.as_str());
        let indent = BOLD.font.width(&word, BODY);
        let (left, room) = (self.left(), self.room());
        self.need(LEADING);
        let y = self.y + BODY;
        self.canvas().text(left, y, Letters { color, ..BOLD }, &word);
        let text = lines(&note.text, PLAIN.font, BODY, room - indent);
        self.lines(text, left + indent, Letters { color, ..PLAIN });
        self.y += 2.0;
    }

    pub(super) fn tree(&mut self, items: &[TreeItem]) {
        self.space(4.0);
        // No call to itself: depth comes from the project.
        let mut open = vec![items.iter()];
        while let Some(level) = open.last_mut() {
            match level.next() {
                Some(item) => {
                    self.tree_item(item, open.len() - 1);
                    open.push(item.items.iter());
                }
                None => drop(open.pop()),
            }
        }
    }

    fn tree_item(&mut self, item: &TreeItem, depth: usize) {
        let (left, room) = (self.left(), self.room());
        let deepest = (room / 2.0 / INDENT) as usize;
        let indent = INDENT * depth.min(deepest) as f32;
        self.need(LEADING);
        let top = self.y;
        for level in 1..=depth.min(deepest) {
            let x = left + INDENT * level as f32 - INDENT * 0.6;
            let points = if level == depth.min(deepest) {
                vec![(x, top), (x, top + 0.6 * LEADING), (x + INDENT * 0.4, top + 0.6 * LEADING)]
            } else {
                vec![(x, top), (x, top + LEADING)]
            };
            self.canvas().line(&points, 0.5, RULE);
        }
        let text = if depth > deepest {
            Text::plain(format!("(level {}) ", depth + 1)).and(item.text.clone())
        } else {
            item.text.clone()
        };
        let text = lines(&text, PLAIN.font, BODY, room - indent);
        self.lines(text, left + indent, PLAIN);
    }
}
