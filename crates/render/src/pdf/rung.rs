//! Paints a scene, or some rows of it, on a page.
//!
//! A cell of the grid is as wide as a character of Courier, so texts stand where the layout put them.
//! Everything is told by form and by words: colours are dark on light, and grey print loses nothing.

use std::ops::Range;

use super::canvas::{self, Canvas, Color, Letters};
use super::font::{Font, printable};
use crate::figure::{self, Area, BASELINE, CELL_HEIGHT, CELL_WIDTH, Group, Ink, Line, Pen, Step};
use crate::scene::{Role, Scene, Shape, Spot};
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

/// A colour of the style sheet of drawings, by its name there.
macro_rules! colors {
    ($($name:ident $property:literal $hex:literal;)*) => {
        $(const $name: Color = Color::of($hex);)*
        #[cfg(test)]
        const COLORS: &[(&str, u32)] = &[$(($property, $hex)),*];
    };
}

// The light half of the style sheet: paper is white.
colors! {
    WIRE "wire" 0x1f3fae;
    INK "ink" 0x111111;
    SOFT "soft" 0x555555;
    SYMBOL "symbol" 0xcdeccd;
    COMMENT "comment" 0xfff6c4;
    ON "on" 0x15803d;
    FORCE "force" 0xb00020;
    NOTE "note" 0xa04000;
}

/// Narrower than this, a text is hard to read.
const LEGIBLE: f32 = 0.7;

/// Paints `rows` of a scene. `place` gives the name of the place an address leads to.
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
    let figure = figure::figure(scene);
    let spot = |group: &Group| scene.instructions.iter().find(|spot| spot.index == group.index);
    let mut painter = Painter { canvas, rows, grid: *grid, narrowed: Vec::new() };
    let groups = || figure.instructions.iter().map(|group| (&group.inks, spot(group)));
    let all = || std::iter::once((&figure.rung, None)).chain(groups());
    for (inks, _) in all() {
        inks.iter().for_each(|ink| painter.background(ink));
    }
    for group in &figure.instructions {
        if spot(group).is_some_and(|spot| spot.state == Some(true)) {
            group.bars.iter().for_each(|bar| painter.fill(*bar, ON));
        }
    }
    for (_, steps) in &figure.wires {
        painter.stroke(steps, pen(Pen::Wire, None));
    }
    for (inks, spot) in all() {
        for ink in inks {
            if let Ink::Stroke(kind, steps) = ink {
                painter.stroke(steps, pen(*kind, spot));
            }
        }
    }
    for (inks, _) in all() {
        for ink in inks {
            if let Ink::Text(line) = ink {
                painter.text(line, place);
            }
        }
    }
    painter.narrowed
}

/// Width in points and colour of a stroke. What conducts is thicker, so that it shows without its colour.
fn pen(pen: Pen, spot: Option<&Spot>) -> (f32, Color) {
    let on = spot.is_some_and(|spot| spot.state == Some(true));
    let forced = spot.is_some_and(|spot| spot.forced.is_some());
    match pen {
        Pen::Rail => (1.2, WIRE),
        Pen::Wire => (0.8, WIRE),
        Pen::Sign => (if on { 1.7 } else { 1.0 }, if forced { FORCE } else { INK }),
        Pen::Frame => (if on { 1.7 } else { 0.8 }, INK),
    }
}

/// Font and colour of a text.
fn letters(role: Role) -> (Font, Color) {
    match role {
        Role::Title | Role::Symbol | Role::Address | Role::EditMark => (Font::MonoBold, INK),
        Role::Mnemonic | Role::RungNumber => (Font::MonoBold, WIRE),
        Role::Module | Role::Name => (Font::Mono, SOFT),
        Role::Force => (Font::MonoBold, FORCE),
        Role::State => (Font::MonoBold, ON),
        Role::Note => (Font::Mono, NOTE),
        Role::Comment | Role::Description | Role::BoxTitle | Role::Operand | Role::Value => (Font::Mono, INK),
    }
}

struct Painter<'a> {
    canvas: &'a mut Canvas,
    rows: Range<usize>,
    grid: Grid,
    narrowed: Vec<String>,
}

impl Painter<'_> {
    /// A place of the figure on the page.
    fn at(&self, (x, y): (usize, usize)) -> (f32, f32) {
        let (x, y) = (x as f32 / CELL_WIDTH as f32, y as f32 / CELL_HEIGHT as f32 - self.rows.start as f32);
        (self.grid.left + x * self.grid.cell, self.grid.top + y * self.grid.row)
    }

    /// Upper and lower end of what is painted, in units of the figure.
    fn ends(&self) -> (usize, usize) {
        (self.rows.start * CELL_HEIGHT, self.rows.end * CELL_HEIGHT)
    }

    fn background(&mut self, ink: &Ink) {
        match ink {
            Ink::Fill(Role::Title | Role::Symbol, area) => self.fill(*area, SYMBOL),
            Ink::Fill(_, area) => self.fill(*area, COMMENT),
            Ink::Stroke(..) | Ink::Text(_) => {}
        }
    }

    /// Fills the part of an area that is in the rows.
    fn fill(&mut self, area: Area, color: Color) {
        let (first, last) = self.ends();
        let (top, bottom) = (area.y.max(first), (area.y + area.height).min(last));
        if top < bottom {
            let ((left, top), (right, bottom)) = (self.at((area.x, top)), self.at((area.x + area.width, bottom)));
            self.canvas.fill(canvas::Area { left, top, right, bottom }, color);
        }
    }

    /// Draws the part of a path that is in the rows. Only lines straight down leave a row.
    fn stroke(&mut self, steps: &[Step], (width, color): (f32, Color)) {
        let (first, last) = self.ends();
        let mut from = (0, 0);
        let mut open: Vec<(f32, f32)> = Vec::new();
        for step in steps {
            let (Step::Move(x, y) | Step::Line(x, y) | Step::Curve(_, _, (x, y))) = *step;
            let to = (x, y);
            let (top, bottom) = (from.1.min(y), from.1.max(y));
            match *step {
                Step::Line(..) if top >= first && bottom <= last => {
                    if open.is_empty() {
                        open.push(self.at(from));
                    }
                    open.push(self.at(to));
                    from = to;
                    continue;
                }
                Step::Line(..) if from.0 == x && top.max(first) < bottom.min(last) => {
                    let part = [self.at((x, top.max(first))), self.at((x, bottom.min(last)))];
                    self.canvas.line(&part, width, color);
                }
                Step::Curve(one, two, _) if top >= first && bottom <= last => {
                    self.canvas.curve([from, one, two, to].map(|point| self.at(point)), width, color);
                }
                _ => {}
            }
            self.canvas.line(&std::mem::take(&mut open), width, color);
            from = to;
        }
        self.canvas.line(&open, width, color);
    }

    fn text(&mut self, line: &Line, place: &mut dyn FnMut(&str) -> Option<String>) {
        let top = line.y.saturating_sub(BASELINE);
        if !self.rows.contains(&(top / CELL_HEIGHT)) {
            return;
        }
        let (font, color) = letters(line.role);
        let size = self.grid.size();
        let ((left, upper), (right, lower)) =
            (self.at((line.x, top)), self.at((line.x + line.width, top + CELL_HEIGHT)));
        // Capitals of Courier are 0.56 of the size high.
        let y = (upper + lower) / 2.0 + 0.28 * size;
        let (_, ratio) = self.canvas.fitted(left, y, Letters { font, size, color }, right - left, &line.text);
        if ratio < LEGIBLE {
            self.narrowed.push(printable(&line.text).0.into_owned());
        }
        if let Some(target) = line.link.as_deref().and_then(place) {
            self.canvas.link(canvas::Area { left, top: upper, right, bottom: lower }, &target);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_those_of_the_style_sheet() {
        for (property, hex) in COLORS {
            let [long, short] =
                [format!("--rung-{property}:#{hex:06x}"), format!("--rung-{property}:#{:03x}", hex & 0xFFF)];
            let grey = hex & 0xFF == hex >> 8 & 0xFF && hex & 0xFF == hex >> 16;
            assert!(crate::svg::STYLE.contains(&long) || grey && crate::svg::STYLE.contains(&short), "{long}");
        }
    }
}
