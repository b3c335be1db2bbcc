//! How wide the columns of a table are, how large its letters, and how many of it stand side by side.

use render::pdf::{Color, Font, Letters};

use super::book::BODY;
use super::text::{longest_word, natural};
use crate::model::{ColumnKind, RowKind, Table};

/// Letters of tables that are too wide, or stand side by side.
const SMALL: f32 = 7.0;
/// Letters of tables that would not fit side by side otherwise.
const SMALLEST: f32 = 6.5;
/// Between columns, in sizes of letters.
const GAP: f32 = 0.8;
/// From one line to the next, in sizes of letters.
const LEADING: f32 = 1.25;
/// A column that is cut into lines keeps this width in points.
const NARROWEST: f32 = 30.0;
/// Longer words are cut: symbols have up to 20 capitals. In sizes of letters.
const LONG: f32 = 16.0;
/// Fewer rows than this do not go side by side.
const MANY: usize = 24;
/// Most tables side by side.
const MOST_STRIPS: usize = 3;

/// A column with its place.
pub(super) struct Column {
    /// Points from the left side of the table.
    x: f32,
    /// Points.
    pub width: f32,
    pub letters: Letters,
    to_right: bool,
    /// Addresses and bits: rather set narrower than cut.
    fixed: bool,
}

/// By how much letters of fixed width may be made narrower.
const NARROWER: f32 = 0.65;

impl Column {
    /// The width at which cells are cut into lines.
    pub(super) fn cell_room(&self) -> f32 {
        if self.fixed { self.width / NARROWER } else { self.width }
    }

    /// Where a line of this width starts, in a table that starts at `left`.
    pub(super) fn start(&self, left: f32, width: f32) -> f32 {
        left + self.x + if self.to_right { (self.width - width).max(0.0) } else { 0.0 }
    }
}

/// How a table is set.
pub(super) struct Plan {
    /// Size of letters in points.
    pub size: f32,
    /// So many parts of it stand side by side.
    pub strips: usize,
    pub columns: Vec<Column>,
}

/// What the cells of a column want, in sizes of letters.
struct Wish {
    /// All cells in one line each.
    most: f32,
    /// Nine of ten cells in one line each.
    usual: f32,
    /// No word cut, unless it is very long.
    least: f32,
}

impl Plan {
    /// Plans a table; `room` gives the width of so many parts side by side.
    pub(super) fn of(table: &Table, room: impl Fn(usize) -> f32) -> Plan {
        let wishes: Vec<Wish> = (0..table.columns.len()).map(|index| wish(table, index)).collect();
        let usual: f32 = wishes.iter().map(|wish| wish.usual).sum();
        let least: f32 = wishes.iter().map(|wish| wish.least).sum();
        let gaps = GAP * table.columns.len().saturating_sub(1) as f32;
        let fitting = |strips: &usize| (usual.max(least) + gaps) * SMALLEST <= room(*strips);
        let side_by_side = if table.rows.len() < MANY { None } else { (2..=MOST_STRIPS).rev().find(fitting) };
        let strips = side_by_side.unwrap_or(1);
        let size = match strips {
            1 if (usual + gaps) * BODY <= room(1) => BODY,
            1 => SMALL,
            // Sums of widths differ in the last digits.
            several => SMALL.min(room(several) / (usual.max(least) + gaps)).max(SMALLEST),
        };
        let widths = widths(&wishes, room(strips) / size - gaps);
        let mut x = 0.0;
        let place = |(width, column): (f32, &crate::model::Column)| {
            let letters = Letters { font: font(column.kind), size, color: Color::BLACK };
            let to_right = column.kind == ColumnKind::Number;
            let fixed = column.kind == ColumnKind::Fixed;
            let placed = Column { x, width: width * size, letters, to_right, fixed };
            x += (width + GAP) * size;
            placed
        };
        Plan { size, strips, columns: widths.into_iter().zip(&table.columns).map(place).collect() }
    }

    /// From one line to the next, in points.
    pub(super) fn leading(&self) -> f32 {
        self.size * LEADING
    }
}

fn font(kind: ColumnKind) -> Font {
    if kind == ColumnKind::Fixed { Font::Mono } else { Font::Sans }
}

/// The font of the title of a column. Numbers of bits stand above the bits.
pub(super) fn heading(column: &crate::model::Column) -> Font {
    let numbers = column.title.contains(' ') && column.title.chars().all(|c| c == ' ' || c.is_ascii_digit());
    if numbers && column.kind == ColumnKind::Fixed { Font::MonoBold } else { Font::SansBold }
}

fn wish(table: &Table, index: usize) -> Wish {
    let Some(column) = table.columns.get(index) else { return Wish { most: 0.0, usual: 0.0, least: 0.0 } };
    let font = font(column.kind);
    let plain = table.rows.iter().filter(|row| row.kind == RowKind::Plain);
    let cells: Vec<_> = plain.filter_map(|row| row.cells.get(index)).collect();
    let mut widths: Vec<f32> = cells.iter().map(|cell| natural(cell, font, 1.0)).collect();
    widths.sort_unstable_by(f32::total_cmp);
    let title = &column.title;
    let heading = match heading(column) {
        Font::MonoBold => Font::MonoBold.width(title, 1.0),
        font => title.split(' ').map(|word| font.width(word, 1.0)).fold(0.0, f32::max),
    };
    let most = widths.last().copied().unwrap_or(0.0).max(heading);
    let usual = widths.get(widths.len() * 9 / 10).copied().unwrap_or(0.0).max(heading);
    let narrowest = (NARROWEST / BODY).min(most);
    match column.kind {
        ColumnKind::Text => {
            let word = cells.iter().map(|cell| longest_word(cell, font, 1.0)).fold(heading, f32::max);
            let least = word.min(LONG).max(narrowest);
            Wish { most, usual: usual.max(least), least }
        }
        ColumnKind::Number => Wish { most, usual: usual.max(narrowest), least: most.min(usual * 1.3) },
        // The few that are longer are set narrower, see `Column::cell_room`.
        ColumnKind::Fixed => Wish { most, usual, least: usual },
    }
}

/// Widths of columns that together take `room` at most: what all cells want, or what most want, or less.
fn widths(wishes: &[Wish], room: f32) -> Vec<f32> {
    let sum = |of: &dyn Fn(&Wish) -> f32| wishes.iter().map(of).sum::<f32>();
    let between = |low: &dyn Fn(&Wish) -> f32, high: &dyn Fn(&Wish) -> f32| -> Vec<f32> {
        let (base, top) = (sum(low), sum(high));
        // What is left is shared by what each could use.
        let share = if top > base { ((room - base) / (top - base)).clamp(0.0, 1.0) } else { 0.0 };
        wishes.iter().map(|wish| low(wish) + (high(wish) - low(wish)).max(0.0) * share).collect()
    };
    if sum(&|wish| wish.usual.max(wish.least)) <= room {
        return between(&|wish| wish.usual.max(wish.least), &|wish| wish.most);
    }
    if sum(&|wish| wish.least) <= room {
        return between(&|wish| wish.least, &|wish| wish.usual.max(wish.least));
    }
    // Too many columns for the page: each as much narrower as it is wide.
    let scale = room / sum(&|wish| wish.least).max(0.1);
    wishes.iter().map(|wish| wish.least * scale).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wish(least: f32, usual: f32, most: f32) -> Wish {
        Wish { most, usual, least }
    }

    #[test]
    fn columns_get_what_they_want_while_there_is_room() {
        assert_eq!(widths(&[wish(5.0, 10.0, 20.0), wish(5.0, 5.0, 5.0)], 40.0), [20.0, 5.0]);
        assert_eq!(widths(&[wish(5.0, 10.0, 30.0), wish(5.0, 10.0, 20.0)], 35.0), [20.0, 15.0]);
        assert_eq!(widths(&[wish(5.0, 25.0, 30.0), wish(5.0, 15.0, 20.0)], 25.0), [15.0, 10.0]);
        assert_eq!(widths(&[wish(10.0, 25.0, 30.0), wish(30.0, 35.0, 40.0)], 20.0), [5.0, 15.0]);
    }
}
