//! Where the elements of a rung stand: series cut into lines, legs under each other.
//!
//! Everything is measured once from the inside out, with the width left at its depth, and then
//! placed from the outside in, so the cost grows with the number of elements.

use ladder::{Branch, Element, Series};

use crate::face::Source;
use crate::leaf::{LEAF_MIN, Leaf, leaf};
use crate::scene::{Direction, Item, Shape};

/// Branches nest at most this deep in a drawing.
pub(crate) const MAX_DEPTH: usize = 32;

/// Why a rung is not drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NotDrawn {
    /// Branches nested deeper than [`MAX_DEPTH`].
    Depth,
    /// Too many nested branches for the width.
    Width,
    /// More elements than [`MAX_ELEMENTS`].
    Size,
}

/// Instructions, branches and legs of one drawing. Editors allow some hundred in a rung; a drawing takes
/// a kilobyte and more for each.
const MAX_ELEMENTS: usize = 20_000;

/// Whether a rung can be drawn with memory that a rung is worth. Stops counting where it cannot.
pub(crate) fn is_drawable(series: &Series) -> bool {
    let mut open = vec![series];
    let mut count = 0;
    while let Some(series) = open.pop() {
        count += series.len();
        for element in series {
            if let Element::Branch(branch) = element {
                count += branch.legs.len();
                open.extend(&branch.legs);
            }
        }
        if count > MAX_ELEMENTS {
            return false;
        }
    }
    true
}

/// Columns a branch needs besides its legs: two rails and a stub of wire outside each.
const BRANCH_SIDES: usize = 4;
/// Columns at the left side of a line that continues another one.
const INDENT: usize = 2;
/// Columns that lines of a wrapped series leave for the wires between them.
const WRAP_SIDES: usize = INDENT + 2;

/// A measured element: its wire enters at column 0 and leaves at column `width`.
struct Block {
    width: usize,
    above: usize,
    below: usize,
    output: bool,
    content: Content,
}

enum Content {
    Leaf(Vec<Item>),
    Legs(Vec<Measured>),
}

/// A measured series.
pub(crate) struct Measured {
    lines: Vec<Line>,
    /// Columns.
    pub width: usize,
    /// Rows above the wire it starts on.
    pub above: usize,
    /// Rows below that wire.
    pub below: usize,
    output: bool,
}

struct Line {
    blocks: Vec<Block>,
    /// Blocks from here on stand at the right side, if this is the last line.
    right: usize,
    width: usize,
    above: usize,
    below: usize,
}

/// Measures a series for at most `limit` columns.
pub(crate) fn measure(source: &Source<'_>, series: &Series, limit: usize, depth: usize) -> Result<Measured, NotDrawn> {
    if depth > MAX_DEPTH {
        return Err(NotDrawn::Depth);
    }
    let inner = if series.len() > 1 { limit.saturating_sub(WRAP_SIDES) } else { limit };
    let mut blocks = Vec::with_capacity(series.len());
    for (index, element) in series.iter().enumerate() {
        blocks.push(match element {
            Element::Instruction(instruction) => {
                if inner < LEAF_MIN {
                    return Err(NotDrawn::Width);
                }
                let face = source.face(instruction);
                let Leaf { width, above, below, items } = leaf(&face, inner);
                // Rungs end in outputs, so an unknown instruction behind conditions is taken for one.
                let output = face.output.unwrap_or(index > 0 && index + 1 == series.len());
                Block { width, above, below, output, content: Content::Leaf(items) }
            }
            Element::Branch(branch) => measure_branch(source, branch, inner, depth)?,
        });
    }
    Ok(cut(blocks, limit))
}

fn measure_branch(source: &Source<'_>, branch: &Branch, limit: usize, depth: usize) -> Result<Block, NotDrawn> {
    let inner = limit.saturating_sub(BRANCH_SIDES);
    let mut legs = Vec::with_capacity(branch.legs.len());
    for leg in &branch.legs {
        legs.push(measure(source, leg, inner, depth + 1)?);
    }
    let width = legs.iter().map(|leg| leg.width).max().unwrap_or(0) + BRANCH_SIDES;
    let output = legs.iter().any(|leg| leg.output);
    let above = legs.first().map_or(0, |leg| leg.above);
    // One row between legs keeps the bit of one apart from the symbol of the next.
    let rows: usize = legs.iter().map(|leg| leg.above + 1 + leg.below).sum::<usize>() + legs.len().saturating_sub(1);
    Ok(Block { width, above, below: rows.saturating_sub(above + 1), output, content: Content::Legs(legs) })
}

/// Cuts blocks into lines.
fn cut(blocks: Vec<Block>, limit: usize) -> Measured {
    let total: usize = blocks.iter().map(|block| block.width).sum();
    let output = blocks.iter().any(|block| block.output);
    let capacity = if total <= limit { total } else { limit.saturating_sub(WRAP_SIDES) };
    let mut lines = Vec::new();
    let mut current = Vec::new();
    let mut used = 0;
    for block in blocks {
        if !current.is_empty() && used + block.width > capacity {
            lines.push(Line::new(std::mem::take(&mut current)));
            used = 0;
        }
        used += block.width;
        current.push(block);
    }
    lines.push(Line::new(current));
    let last = lines.len() - 1;
    let width = if last == 0 {
        lines.iter().map(|line| line.width).sum()
    } else {
        lines.iter().map(|line| line.width).max().unwrap_or(0) + WRAP_SIDES
    };
    let above = lines.first().map_or(0, |line| line.above);
    // The turn of the wire takes a row between two lines.
    let rows: usize = lines.iter().map(|line| line.above + 1 + line.below).sum::<usize>() + last;
    Measured { lines, width, above, below: rows - above - 1, output }
}

impl Line {
    fn new(blocks: Vec<Block>) -> Line {
        Line {
            right: blocks.iter().position(|block| block.output).unwrap_or(blocks.len()),
            width: blocks.iter().map(|block| block.width).sum(),
            above: blocks.iter().map(|block| block.above).max().unwrap_or(0),
            below: blocks.iter().map(|block| block.below).max().unwrap_or(0),
            blocks,
        }
    }
}

/// Places a series whose wire enters at column `x` of row `y` and leaves at column `x + room`;
/// returns the row it leaves on.
pub(crate) fn place(items: &mut Vec<Item>, series: Measured, x: usize, y: usize, room: usize) -> usize {
    let mut row = y;
    let mut start = x;
    let mut lines = series.lines.into_iter();
    while let Some(line) = lines.next() {
        let Some(next) = lines.as_slice().first() else {
            place_last(items, line, start, row, x + room);
            break;
        };
        let end = start + line.width;
        let below = line.below;
        place_blocks(items, line.blocks, start, row);
        // Outputs alone on the last line stand at the right rail; the wire goes there directly.
        let alone = lines.len() == 1 && next.right == 0;
        let back = if alone { (x + room).saturating_sub(next.width + 1).max(x) } else { x + INDENT - 1 };
        let turn = row + below + 1;
        let next_row = turn + 1 + next.above;
        items.push(Item { x: end, y: row, shape: Shape::Down { length: turn - row, arrows: true } });
        let (from, to, arrow) = if back <= end { (back, end, Direction::Left) } else { (end, back, Direction::Right) };
        items.push(Item { x: from, y: turn, shape: Shape::Across { length: to - from, arrows: Some(arrow) } });
        items.push(Item::down(back, turn, next_row));
        items.push(Item::across(back, back + 1, next_row));
        start = back + 1;
        row = next_row;
    }
    row
}

/// The last line: conditions at the left, outputs at the right, wire between.
fn place_last(items: &mut Vec<Item>, line: Line, start: usize, y: usize, end: usize) {
    let Line { mut blocks, right, .. } = line;
    let outputs = blocks.split_off(right.min(blocks.len()));
    let outputs_width: usize = outputs.iter().map(|block| block.width).sum();
    let left_end = place_blocks(items, blocks, start, y);
    let right_start = end.saturating_sub(outputs_width).max(left_end);
    items.push(Item::across(left_end, right_start, y));
    place_blocks(items, outputs, right_start, y);
}

/// Blocks next to each other; returns the column after them.
fn place_blocks(items: &mut Vec<Item>, blocks: Vec<Block>, mut x: usize, y: usize) -> usize {
    for block in blocks {
        let top = y.saturating_sub(block.above);
        match block.content {
            Content::Leaf(own) => items.extend(own.into_iter().map(|item| item.moved(x, top))),
            Content::Legs(legs) => place_legs(items, legs, x, y, block.width),
        }
        x += block.width;
    }
    x
}

fn place_legs(items: &mut Vec<Item>, legs: Vec<Measured>, x: usize, y: usize, width: usize) {
    let (left, right) = (x + 1, x + width - 2);
    if legs.is_empty() {
        items.push(Item::across(x, x + width, y));
        return;
    }
    items.push(Item::across(x, left, y));
    items.push(Item::across(right, x + width, y));
    let mut entry = y;
    let mut last = (y, y);
    let mut bottom = None;
    for leg in legs {
        if let Some(bottom) = bottom {
            entry = bottom + 2 + leg.above;
        }
        bottom = Some(entry + leg.below);
        items.push(Item::across(left, left + 1, entry));
        let exit = place(items, leg, left + 1, entry, right - left - 1);
        last = (entry, exit);
    }
    items.push(Item::down(left, y, last.0));
    items.push(Item::down(right, y, last.1));
}
