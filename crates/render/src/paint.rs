//! Paints a scene as lines of text, one row at a time.
//!
//! Only one row is held in memory; what runs through several rows is a short list of open lines.
//! Wires are kept as the directions in which a cell is left, so crossings and corners come out right
//! whatever draws them.

use std::borrow::Cow;

use crate::scene::{Direction, Item, Role, Scene, Shape};
use crate::text::{columns, width};

const UP: u8 = 1;
const RIGHT: u8 = 2;
const DOWN: u8 = 4;
const LEFT: u8 = 8;

/// Box drawing by directions; a single direction is drawn as the whole line.
const LINES: [char; 16] = [' ', '│', '─', '└', '│', '│', '┌', '├', '─', '┘', '─', '┴', '┐', '┤', '┬', '┼'];
/// The same in ASCII.
const PLAIN: [char; 16] = [' ', '|', '-', '+', '|', '|', '+', '+', '-', '+', '-', '+', '+', '+', '+', '+'];

/// Columns between the arrow heads of a continuation.
const ARROW_COLUMNS: usize = 8;
/// Rows between them.
const ARROW_ROWS: usize = 3;

/// Part of an item that begins in a row.
enum Stroke<'a> {
    Across { x: usize, length: usize, arrows: Option<Direction> },
    Down { x: usize, from: usize, to: usize, arrows: bool },
    Rail { x: usize },
    Text { x: usize, role: Option<Role>, text: Cow<'a, str> },
}

#[derive(Clone, Copy, Default)]
struct Cell {
    lines: u8,
    text: Option<char>,
    role: Option<Role>,
    /// The right half of a wide character.
    covered: bool,
}

/// Gives the rows of the scene to `emit`, each ended by a line feed.
pub(crate) fn paint<E>(
    scene: &Scene,
    color: bool,
    ascii: bool,
    mut emit: impl FnMut(&str) -> Result<(), E>,
) -> Result<(), E> {
    let mut strokes = Vec::with_capacity(scene.items.len() * 2);
    for item in &scene.items {
        strokes_of(item, ascii, &mut strokes);
    }
    strokes.sort_by_key(|(row, _)| *row);
    let mut strokes = strokes.into_iter().peekable();
    let mut open = Vec::new();
    let mut rails = Vec::new();
    let mut cells = Vec::with_capacity(scene.width);
    let mut line = String::new();
    for y in 0..scene.height {
        cells.clear();
        cells.resize(scene.width, Cell::default());
        let mut texts = Vec::new();
        while let Some((_, stroke)) = strokes.next_if(|(row, _)| *row <= y) {
            match stroke {
                Stroke::Across { x, length, arrows } => {
                    across(&mut cells, x, length);
                    let head = if arrows == Some(Direction::Right) { ">" } else { "<" };
                    let places = arrows.map(|_| arrow_columns(x, length)).into_iter().flatten();
                    texts.extend(places.map(|x| (x, None, Cow::Borrowed(head))));
                }
                Stroke::Down { x, from, to, arrows } => open.push((x, from, to, arrows)),
                Stroke::Rail { x } => rails.push(x),
                Stroke::Text { x, role, text } => texts.push((x, role, text)),
            }
        }
        for x in &rails {
            mark(&mut cells, *x, UP | DOWN);
        }
        for (x, from, to, arrows) in &open {
            mark(&mut cells, *x, if y > *from { UP } else { 0 });
            mark(&mut cells, *x, if y < *to { DOWN } else { 0 });
            if *arrows && has_arrow(*from, *to, y) {
                texts.push((*x, None, Cow::Borrowed("v")));
            }
        }
        open.retain(|(_, _, to, _)| *to > y);
        for (x, role, text) in texts {
            write_text(&mut cells, x, role, &text);
        }
        line.clear();
        finish(&cells, color, if ascii { &PLAIN } else { &LINES }, &mut line);
        emit(&line)?;
    }
    Ok(())
}

fn strokes_of<'a>(item: &'a Item, ascii: bool, out: &mut Vec<(usize, Stroke<'a>)>) {
    let Item { x, y, ref shape, .. } = *item;
    let mut text = |x, role, text| out.push((y, Stroke::Text { x, role, text }));
    match shape {
        Shape::Text(role, content) => text(x, Some(*role), Cow::Borrowed(content)),
        Shape::Contact { closed } => {
            let sign = match (ascii, closed) {
                (false, false) => "┤ ├",
                (false, true) => "┤/├",
                (true, false) => "] [",
                (true, true) => "]/[",
            };
            text(x, None, Cow::Borrowed(sign));
        }
        Shape::Coil(letters) if letters.is_empty() => text(x, None, Cow::Borrowed("( )")),
        Shape::Coil(letters) => text(x, None, Cow::Owned(format!("({letters})"))),
        Shape::Marked(letters) => text(x, None, Cow::Owned(format!("[{letters}]"))),
        Shape::Across { length, arrows } => out.push((y, Stroke::Across { x, length: *length, arrows: *arrows })),
        Shape::Down { length, arrows } => {
            out.push((y, Stroke::Down { x, from: y, to: y + length, arrows: *arrows }));
        }
        Shape::Rail => out.push((y, Stroke::Rail { x })),
        Shape::Frame { width: frame, height, name } => {
            let (right, bottom) = (x + frame.saturating_sub(1), y + height.saturating_sub(1));
            if !name.is_empty() {
                text(x + frame.saturating_sub(width(name)) / 2, Some(Role::Mnemonic), Cow::Borrowed(name));
            }
            for row in [y, bottom] {
                out.push((row, Stroke::Across { x, length: right - x, arrows: None }));
            }
            for side in [x, right] {
                out.push((y, Stroke::Down { x: side, from: y, to: bottom, arrows: false }));
            }
        }
    }
}

/// Rows of the arrow heads on a wire downwards.
pub(crate) fn arrow_rows(from: usize, to: usize) -> impl Iterator<Item = usize> {
    (from + 1..to).step_by(ARROW_ROWS)
}

/// Columns of the arrow heads on a wire: evenly spread, one in the middle of a short wire.
pub(crate) fn arrow_columns(x: usize, length: usize) -> impl Iterator<Item = usize> {
    let count = length.div_ceil(ARROW_COLUMNS).max(1);
    (0..count)
        .map(move |index| x + (2 * index + 1) * length / (2 * count))
        .filter(move |at| *at > x && *at < x + length)
}

/// Whether a wire downwards with arrow heads has one in row `y`.
pub(crate) fn has_arrow(from: usize, to: usize, y: usize) -> bool {
    y > from && y < to && (y - from) % ARROW_ROWS == 1
}

fn mark(cells: &mut [Cell], x: usize, directions: u8) {
    if let Some(cell) = cells.get_mut(x) {
        cell.lines |= directions;
    }
}

fn across(cells: &mut [Cell], x: usize, length: usize) {
    for step in 0..length {
        mark(cells, x + step, RIGHT);
        mark(cells, x + step + 1, LEFT);
    }
}

/// Text wins over lines. It may go beyond the width of the scene: nothing is cut off.
fn write_text(cells: &mut Vec<Cell>, mut x: usize, role: Option<Role>, text: &str) {
    for c in text.chars() {
        let size = columns(c).unwrap_or(1);
        if cells.len() < x + size {
            cells.resize(x + size, Cell::default());
        }
        for (index, cell) in cells.iter_mut().skip(x).take(size).enumerate() {
            *cell = Cell { lines: 0, text: Some(c), role, covered: index > 0 };
        }
        x += size;
    }
}

fn finish(cells: &[Cell], color: bool, lines: &[char; 16], out: &mut String) {
    let blank = |cell: &Cell| cell.lines == 0 && cell.text.is_none_or(|c| c == ' ');
    let end = cells.iter().rposition(|cell| !blank(cell)).map_or(0, |last| last + 1);
    let mut active = "";
    for cell in cells.iter().take(end).filter(|cell| !cell.covered) {
        if color {
            let wanted = cell.role.map_or("", escape);
            if wanted != active {
                out.push_str(if wanted.is_empty() { "\x1B[0m" } else { wanted });
                active = wanted;
            }
        }
        match cell.text {
            Some(c) => out.push(c),
            None => out.push(lines.get(usize::from(cell.lines & 15)).copied().unwrap_or(' ')),
        }
    }
    if !active.is_empty() {
        out.push_str("\x1B[0m");
    }
    out.push('\n');
}

/// The colours of the paper where there are any: symbols and titles green, comments and descriptions
/// yellow. Each begins with a reset, so that one can follow another.
fn escape(role: Role) -> &'static str {
    match role {
        Role::RungNumber => "\x1B[0;2m",
        Role::EditMark => "\x1B[0;1m",
        Role::Title => "\x1B[0;1;32m",
        Role::Symbol => "\x1B[0;32m",
        Role::Comment | Role::Description => "\x1B[0;33m",
        Role::Note => "\x1B[0;31m",
        Role::Force => "\x1B[0;1;31m",
        Role::State => "\x1B[0;1;32m",
        Role::Mnemonic => "\x1B[0;1m",
        Role::Address | Role::Module | Role::BoxTitle | Role::Name | Role::Operand | Role::Value => "",
    }
}
