//! Paints a scene, or some rows of it, on a page.
//!
//! A cell of the grid is as wide as a character of Courier, so texts stand where the layout put them.
//! Everything is told by form and by words: colours are dark on light, and grey print loses nothing.

use std::ops::Range;

use super::canvas::{Area, Canvas, Color, Letters};
use super::font::Font;
use crate::paint::{arrow_columns, has_arrow};
use crate::scene::{Direction, Item, Role, Scene, Shape};
use crate::text::width;

/// Where a scene stands on a page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Left side of the first column, in points from the left.
    pub left: f32,
    /// Upper side of the first row painted, in points from the top.
    pub top: f32,
    /// Width of a column in points.
    pub cell: f32,
    /// Height of a row in points.
    pub row: f32,
}

impl Grid {
    /// Size of Courier whose characters are as wide as a column.
    pub fn size(&self) -> f32 {
        self.cell / 0.6
    }
}

/// Wires, rails, frames and what names them.
const WIRE: Color = Color(0.08, 0.16, 0.45);
const REMARK: Color = Color(0.6, 0.05, 0.05);
const COMMENT_BAND: Color = Color(1.0, 0.97, 0.8);
const SYMBOL_BAND: Color = Color(0.84, 0.94, 0.84);

const WIRE_WIDTH: f32 = 0.7;
const RAIL_WIDTH: f32 = 1.2;
const SIGN_WIDTH: f32 = 1.1;
/// Half the height of contacts and coils, in rows.
const SIGN: f32 = 0.44;

/// Narrower than this, a text is hard to read.
const LEGIBLE: f32 = 0.7;

/// Paints `rows` of a scene. `place` gives the name of the place an address in the rung leads to.
///
/// Returns the texts that had to be made so narrow that they are hard to read, spelled out: characters
/// the fonts lack take more room than the layout gave them.
pub fn rung(
    canvas: &mut Canvas,
    scene: &Scene,
    rows: Range<usize>,
    grid: &Grid,
    place: &mut dyn FnMut(&str) -> Option<String>,
) -> Vec<String> {
    let mut painter = Painter { canvas, rows, grid: *grid, narrowed: Vec::new() };
    painter.bands(scene);
    for item in &scene.items {
        painter.wires(item);
    }
    for item in &scene.items {
        painter.sign(item);
    }
    for item in &scene.items {
        painter.text(item, place);
    }
    painter.narrowed
}

struct Painter<'a> {
    canvas: &'a mut Canvas,
    rows: Range<usize>,
    grid: Grid,
    narrowed: Vec<String>,
}

impl Painter<'_> {
    /// Left side of a column; halves are the middle of a cell.
    fn x(&self, column: f32) -> f32 {
        self.grid.left + column * self.grid.cell
    }

    /// Upper side of a row, on the page or beyond its ends.
    fn y(&self, row: f32) -> f32 {
        self.grid.top + (row - self.rows.start as f32) * self.grid.row
    }

    /// A wire downwards, as far as it is in the rows.
    fn down(&mut self, column: usize, from: f32, to: f32, width: f32) {
        let (from, to) = (from.max(self.rows.start as f32), to.min(self.rows.end as f32));
        if from < to {
            let x = self.x(column as f32 + 0.5);
            let points = [(x, self.y(from)), (x, self.y(to))];
            self.canvas.line(&points, width, WIRE);
        }
    }

    fn across(&mut self, from: f32, to: f32, row: usize) {
        if self.rows.contains(&row) && from < to {
            let y = self.y(row as f32 + 0.5);
            self.canvas.line(&[(self.x(from), y), (self.x(to), y)], WIRE_WIDTH, WIRE);
        }
    }

    /// The areas behind comments, titles, descriptions and symbols. Labels above one instruction are as
    /// wide as the widest of them.
    fn bands(&mut self, scene: &Scene) {
        let rails = || scene.items.iter().filter(|item| item.shape == Shape::Rail).map(|item| item.x);
        let (first, last) = (rails().min().unwrap_or(0), rails().max().unwrap_or(scene.width));
        let mut labels: Vec<(usize, usize, usize, Role)> = Vec::new();
        for item in &scene.items {
            let Shape::Text(role, text) = &item.shape else { continue };
            match role {
                Role::Title => self.band(first as f32 + 1.0, last as f32, item.y, SYMBOL_BAND),
                Role::Comment => self.band(first as f32 + 1.0, last as f32, item.y, COMMENT_BAND),
                Role::Description | Role::Symbol => labels.push((item.x, item.y, width(text), *role)),
                _ => {}
            }
        }
        labels.sort_unstable_by_key(|(x, y, ..)| (*x, *y));
        for stack in labels.chunk_by(|(x, y, ..), (next, below, ..)| x == next && *below == y + 1) {
            let columns = stack.iter().map(|(.., columns, _)| *columns).max().unwrap_or(0);
            for (x, y, _, role) in stack {
                let color = if *role == Role::Symbol { SYMBOL_BAND } else { COMMENT_BAND };
                self.band(*x as f32 - 0.3, (x + columns) as f32 + 0.3, *y, color);
            }
        }
    }

    fn band(&mut self, from: f32, to: f32, row: usize, color: Color) {
        if self.rows.contains(&row) {
            let (top, bottom) = (self.y(row as f32), self.y(row as f32 + 1.0));
            self.canvas.fill(Area { left: self.x(from), top, right: self.x(to), bottom }, color);
        }
    }

    fn wires(&mut self, item: &Item) {
        let Item { x, y, ref shape, .. } = *item;
        let middle = y as f32 + 0.5;
        match shape {
            Shape::Across { length, .. } => self.across(x as f32 + 0.5, (x + length) as f32 + 0.5, y),
            Shape::Down { length, .. } => self.down(x, middle, middle + *length as f32, WIRE_WIDTH),
            Shape::Rail => self.down(x, y as f32, self.rows.end as f32, RAIL_WIDTH),
            Shape::Frame { width, height, .. } => {
                let (right, bottom) = (x + width.saturating_sub(1), y + height.saturating_sub(1));
                for row in [y, bottom] {
                    self.across(x as f32 + 0.5, right as f32 + 0.5, row);
                }
                for side in [x, right] {
                    self.down(side, middle, bottom as f32 + 0.5, WIRE_WIDTH);
                }
            }
            Shape::Text(..) | Shape::Contact { .. } | Shape::Coil(_) | Shape::Marked(_) => {}
        }
    }

    /// Contacts, coils, brackets and the arrow heads of wires.
    fn sign(&mut self, item: &Item) {
        let Item { x, y, ref shape, .. } = *item;
        match shape {
            Shape::Across { length, arrows: Some(direction) } if self.rows.contains(&y) => {
                let tip = if *direction == Direction::Right { 0.5 } else { -0.5 };
                for column in arrow_columns(x, *length) {
                    self.arrow(column as f32 + 0.5, y as f32 + 0.5, (tip, 0.0));
                }
            }
            Shape::Down { length, arrows: true } => {
                for row in self.rows.clone().filter(|row| has_arrow(y, y + length, *row)) {
                    self.arrow(x as f32 + 0.5, row as f32 + 0.5, (0.0, 0.35));
                }
            }
            _ if !self.rows.contains(&y) => {}
            Shape::Contact { closed } => self.contact(x as f32, y as f32, *closed),
            Shape::Coil(letters) => self.coil(x as f32, y as f32, width(letters).max(1) as f32),
            Shape::Marked(letters) => self.brackets(x as f32, y as f32, width(letters) as f32),
            _ => {}
        }
    }

    /// An arrow head about a point of the grid; `tip` is from there to its tip.
    fn arrow(&mut self, x: f32, y: f32, tip: (f32, f32)) {
        let (along, up) = tip;
        let wings = if up == 0.0 { (0.0, 0.25) } else { (0.4, 0.0) };
        let points = [
            (self.x(x + along), self.y(y + up)),
            (self.x(x - along + wings.0), self.y(y - up + wings.1)),
            (self.x(x - along - wings.0), self.y(y - up - wings.1)),
        ];
        self.canvas.polygon(&points, WIRE);
    }

    fn contact(&mut self, x: f32, y: f32, closed: bool) {
        let (top, middle, bottom) = (self.y(y + 0.5 - SIGN), self.y(y + 0.5), self.y(y + 0.5 + SIGN));
        let (left, right) = (self.x(x + 0.95), self.x(x + 2.05));
        // Wires end in the middle of the outer cells.
        for (from, to) in [(self.x(x + 0.5), left), (right, self.x(x + 2.5))] {
            self.canvas.line(&[(from, middle), (to, middle)], WIRE_WIDTH, WIRE);
        }
        for side in [left, right] {
            self.canvas.line(&[(side, top), (side, bottom)], SIGN_WIDTH, WIRE);
        }
        if closed {
            let points = [(self.x(x + 0.8), bottom), (self.x(x + 2.2), top)];
            self.canvas.line(&points, SIGN_WIDTH, WIRE);
        }
    }

    fn coil(&mut self, x: f32, y: f32, letters: f32) {
        let (top, bottom) = (self.y(y + 0.5 - SIGN), self.y(y + 0.5 + SIGN));
        // A wire may run through the cells of the sign.
        self.canvas.fill(Area { left: self.x(x + 0.55), top, right: self.x(x + letters + 1.45), bottom }, Color::WHITE);
        // The sides bulge as far as the wires come.
        for (end, bulge) in [(x + 1.0, x + 0.3), (x + letters + 1.0, x + letters + 1.7)] {
            let (end, bulge) = (self.x(end), self.x(bulge));
            self.canvas.curve([(end, top), (bulge, top), (bulge, bottom), (end, bottom)], SIGN_WIDTH, WIRE);
        }
    }

    fn brackets(&mut self, x: f32, y: f32, letters: f32) {
        let (top, bottom) = (self.y(y + 0.5 - SIGN), self.y(y + 0.5 + SIGN));
        self.canvas.fill(Area { left: self.x(x + 0.5), top, right: self.x(x + letters + 1.5), bottom }, Color::WHITE);
        for (end, side) in [(x + 0.9, x + 0.5), (x + letters + 1.1, x + letters + 1.5)] {
            let (end, side) = (self.x(end), self.x(side));
            self.canvas.line(&[(end, top), (side, top), (side, bottom), (end, bottom)], SIGN_WIDTH, WIRE);
        }
    }

    fn text(&mut self, item: &Item, place: &mut dyn FnMut(&str) -> Option<String>) {
        let Item { x, y, ref shape, .. } = *item;
        if !self.rows.contains(&y) {
            return;
        }
        match shape {
            Shape::Text(role, text) => {
                self.write(x, y, *role, text);
                if matches!(role, Role::Address | Role::Operand)
                    && let Some(target) = place(text.trim_end_matches('<'))
                {
                    self.canvas.link(self.area(x, y, width(text)), &target);
                }
            }
            Shape::Coil(letters) | Shape::Marked(letters) => self.write(x + 1, y, Role::Mnemonic, letters),
            Shape::Frame { width: frame, name, .. } if !name.is_empty() => {
                let at = x + frame.saturating_sub(width(name)) / 2;
                // The name stands in the upper side of the frame, which is left open for it.
                let Area { left, top, right, bottom } = self.area(at, y, width(name));
                let margin = self.grid.cell * 0.2;
                self.canvas.fill(Area { left: left - margin, top, right: right + margin, bottom }, Color::WHITE);
                self.write(at, y, Role::Mnemonic, name);
            }
            _ => {}
        }
    }

    fn area(&self, x: usize, y: usize, columns: usize) -> Area {
        let (left, right) = (self.x(x as f32), self.x((x + columns) as f32));
        Area { left, top: self.y(y as f32), right, bottom: self.y(y as f32 + 1.0) }
    }

    fn write(&mut self, x: usize, y: usize, role: Role, text: &str) {
        let (font, color) = match role {
            Role::RungNumber | Role::EditMark | Role::Mnemonic => (Font::MonoBold, WIRE),
            Role::Title => (Font::MonoBold, Color::BLACK),
            Role::BoxTitle | Role::Name => (Font::Mono, WIRE),
            Role::Note => (Font::Mono, REMARK),
            Role::Symbol | Role::Address | Role::Force | Role::State => (Font::MonoBold, Color::BLACK),
            Role::Comment | Role::Description | Role::Module | Role::Operand | Role::Value => {
                (Font::Mono, Color::BLACK)
            }
        };
        let size = self.grid.size();
        let Area { left, top, right, bottom } = self.area(x, y, width(text));
        // Capitals of Courier are 0.56 of the size high.
        let line = (top + bottom) / 2.0 + 0.28 * size;
        let (_, ratio) = self.canvas.fitted(left, line, Letters { font, size, color }, right - left, text);
        if ratio < LEGIBLE {
            self.narrowed.push(super::printable(text).0.into_owned());
        }
    }
}

/// Cuts a scene into pieces of at most `first` rows, then at most `others` rows each, where a cut does
/// least harm: beside instructions rather than through them. Both are taken as 4 at least.
pub fn breaks(scene: &Scene, first: usize, others: usize) -> Vec<Range<usize>> {
    let mut pieces = Vec::new();
    let mut start = 0;
    let mut room = first.max(4);
    let harm = if scene.height > room { harm(scene) } else { Vec::new() };
    while scene.height - start > room {
        let from = start + room - room / 3;
        let best = (from..=start + room).rev().min_by_key(|at| harm.get(*at).copied().unwrap_or(0));
        let end = best.unwrap_or(start + room);
        pieces.push(start..end);
        start = end;
        room = others.max(4);
    }
    pieces.push(start..scene.height);
    pieces
}

/// What a cut above each row would part: sides of frames, texts from the sign they belong to.
fn harm(scene: &Scene) -> Vec<u32> {
    let mut harm = vec![0_u32; scene.height + 1];
    // Columns taken in each row.
    let mut taken: Vec<Vec<(usize, usize)>> = vec![Vec::new(); scene.height];
    for item in &scene.items {
        let columns = match &item.shape {
            Shape::Frame { height, width, .. } => {
                for at in harm.iter_mut().skip(item.y + 1).take(height.saturating_sub(1)) {
                    *at += 4;
                }
                // Labels stand above it.
                *width
            }
            Shape::Text(Role::Comment | Role::Title | Role::Note | Role::EditMark, _) => continue,
            Shape::Text(_, text) => width(text),
            Shape::Contact { .. } => 3,
            Shape::Coil(letters) | Shape::Marked(letters) => 2 + width(letters).max(1),
            Shape::Across { .. } | Shape::Down { .. } | Shape::Rail => continue,
        };
        if let Some(row) = taken.get_mut(item.y) {
            row.push((item.x, item.x + columns));
        }
    }
    for (at, rows) in harm.iter_mut().skip(1).zip(taken.windows(2)) {
        let [above, below] = rows else { continue };
        let parted = above.iter().flat_map(|a| below.iter().map(move |b| (a, b)));
        *at += parted.filter(|((from, to), (start, end))| from < end && start < to).count() as u32;
    }
    harm
}
