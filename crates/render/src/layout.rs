//! Where the elements of a rung stand: series cut into lines, legs under each other.
//!
//! Everything is measured once from the inside out, with the width left at its depth, and then
//! placed from the outside in, so the cost grows with the number of elements.

use ladder::{Element, Series};

use crate::face::{Face, Source};
use crate::leaf::{IN, LEAF_MIN, Leaf, OUT, leaf, leaf_with_legs};
use crate::scene::{Direction, Item, Node, Of, Shape, Spot};

/// What stands on a wire, in a form that knows no dialect.
#[derive(Debug)]
pub(crate) enum Part {
    /// An instruction.
    Leaf(Face),
    /// Parallel legs, top leg first.
    Legs(Vec<Vec<Part>>),
    /// A box with several legs that each come from the left rail: name and way of each, top leg first.
    Box(Face, Vec<(&'static str, Vec<Part>)>),
}

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
    /// It is not contacts between rails; why.
    Form(domore::circuit::NotDrawable),
}

/// Instructions, branches and legs of one drawing. Editors allow some hundred in a rung; a drawing takes
/// a kilobyte and more for each.
pub(crate) const MAX_ELEMENTS: usize = 20_000;

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

/// The parts of a series. `next` is the number of the next instruction.
pub(crate) fn parts(
    source: &Source<'_>,
    series: &Series,
    next: &mut usize,
    depth: usize,
) -> Result<Vec<Part>, NotDrawn> {
    if depth > MAX_DEPTH {
        return Err(NotDrawn::Depth);
    }
    let part = |element: &Element| match element {
        Element::Instruction(instruction) => {
            let index = *next;
            *next += 1;
            Ok(Part::Leaf(source.face(instruction, index)))
        }
        Element::Branch(branch) => {
            let legs = branch.legs.iter().map(|leg| parts(source, leg, next, depth + 1));
            legs.collect::<Result<_, _>>().map(Part::Legs)
        }
    };
    series.iter().map(part).collect()
}

/// Columns a branch needs besides its legs: two rails and a stub of wire outside each.
const BRANCH_SIDES: usize = 4;
/// Columns between the left side of a box with several legs and the ways to them: stub and rail.
const BOX_SIDES: usize = 2;
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
    Leaf(Spot, Vec<Item>),
    Legs(Vec<Measured>),
    /// Ways to the legs of a box, and the box with its columns and the row of its first leg.
    Box {
        ways: Vec<Measured>,
        spot: Spot,
        items: Vec<Item>,
        width: usize,
        first: usize,
    },
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
pub(crate) fn measure(series: &[Part], limit: usize, depth: usize) -> Result<Measured, NotDrawn> {
    if depth > MAX_DEPTH {
        return Err(NotDrawn::Depth);
    }
    let inner = if series.len() > 1 { limit.saturating_sub(WRAP_SIDES) } else { limit };
    let mut blocks = Vec::with_capacity(series.len());
    for (index, part) in series.iter().enumerate() {
        blocks.push(match part {
            Part::Leaf(face) => {
                if inner < LEAF_MIN {
                    return Err(NotDrawn::Width);
                }
                let Leaf { width, above, below, items } = leaf(face, inner);
                // Rungs end in outputs, so an unknown instruction behind conditions is taken for one.
                let output = face.output.unwrap_or(index > 0 && index + 1 == series.len());
                Block { width, above, below, output, content: Content::Leaf(spot(face), items) }
            }
            Part::Legs(legs) => measure_branch(legs, inner, depth)?,
            Part::Box(face, legs) => measure_box(face, legs, inner, depth)?,
        });
    }
    Ok(cut(blocks, limit))
}

fn measure_branch(parts: &[Vec<Part>], limit: usize, depth: usize) -> Result<Block, NotDrawn> {
    let inner = limit.saturating_sub(BRANCH_SIDES);
    let mut legs = Vec::with_capacity(parts.len());
    for leg in parts {
        legs.push(measure(leg, inner, depth + 1)?);
    }
    let width = legs.iter().map(|leg| leg.width).max().unwrap_or(0) + BRANCH_SIDES;
    let output = legs.iter().any(|leg| leg.output);
    let above = legs.first().map_or(0, |leg| leg.above);
    // One row between legs keeps the bit of one apart from the symbol of the next.
    let rows: usize = legs.iter().map(|leg| leg.above + 1 + leg.below).sum::<usize>() + legs.len().saturating_sub(1);
    Ok(Block { width, above, below: rows.saturating_sub(above + 1), output, content: Content::Legs(legs) })
}

/// A box whose legs enter its left side at the rows where their ways end.
fn measure_box(face: &Face, legs: &[(&'static str, Vec<Part>)], limit: usize, depth: usize) -> Result<Block, NotDrawn> {
    // The box gets what it needs up to half of the place; conditions can go on below, its rows too.
    let room = limit.saturating_sub(BOX_SIDES);
    if room < 2 * LEAF_MIN {
        return Err(NotDrawn::Width);
    }
    let own = leaf_with_legs(face, &legs.iter().map(|(name, _)| (*name, 0)).collect::<Vec<_>>(), room / 2);
    let mut ways = Vec::with_capacity(legs.len());
    for (_, leg) in legs {
        ways.push(measure(leg, room - own.width, depth + 1)?);
    }
    // Rows from the wire of the first way: where each way ends, and the last row of all.
    let mut entry = 0;
    let mut bottom = 0;
    let mut ends = Vec::with_capacity(legs.len());
    for (index, way) in ways.iter().enumerate() {
        if index > 0 {
            entry = bottom + 2 + way.above;
        }
        bottom = entry + way.below;
        ends.push(entry + way.exit());
    }
    let first = ends.first().copied().unwrap_or(0);
    let pins: Vec<_> = legs.iter().zip(&ends).map(|((name, _), end)| (*name, end - first)).collect();
    let Leaf { width, above, below, items } = leaf_with_legs(face, &pins, room / 2);
    let own_above = ways.first().map_or(0, |way| way.above);
    let ways_width = ways.iter().map(|way| way.width).max().unwrap_or(0);
    Ok(Block {
        width: BOX_SIDES + ways_width + width,
        above: own_above.max(above.saturating_sub(first)),
        below: bottom.max(first + below),
        output: true,
        content: Content::Box { ways, spot: spot(face), items, width, first: above },
    })
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

impl Measured {
    /// Rows from the wire it starts on to the one it leaves on.
    fn exit(&self) -> usize {
        match self.lines.last() {
            Some(last) if self.lines.len() > 1 => self.below - last.below,
            _ => 0,
        }
    }
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

/// What a drawing becomes while it is placed.
#[derive(Debug)]
pub(crate) struct Drawing {
    /// See [`crate::scene::Scene::items`].
    pub items: Vec<Item>,
    /// See [`crate::scene::Scene::instructions`].
    pub instructions: Vec<Spot>,
    /// See [`crate::scene::Scene::shorts`].
    pub shorts: Vec<(Node, Node)>,
    nodes: Node,
}

/// The wire at the left rail.
pub(crate) const LEFT: Node = 0;
/// The wire at the right rail.
pub(crate) const RIGHT: Node = 1;

impl Drawing {
    /// With these items already.
    pub(crate) fn new(items: Vec<Item>) -> Drawing {
        Drawing { items, instructions: Vec::new(), shorts: Vec::new(), nodes: RIGHT + 1 }
    }

    /// A wire that has no number yet.
    fn node(&mut self) -> Node {
        self.nodes += 1;
        self.nodes - 1
    }

    fn wire(&mut self, item: Item, node: Node) {
        self.items.push(item.on(node));
    }

    /// An instruction and its items, between wires that enter and the one that leaves.
    fn leaf(&mut self, mut spot: Spot, own: Vec<Item>, (x, y): (usize, usize), enter: &[Node], leave: Node) {
        spot.enters = enter.first().copied().unwrap_or(LEFT);
        spot.leaves = leave;
        self.instructions.push(spot);
        self.items.extend(own.into_iter().map(|item| {
            let mut item = item.moved(x, y);
            if let Of::Node(node) = &mut item.of {
                let entering = node.checked_sub(IN).and_then(|leg| enter.get(leg)).copied();
                *node = if *node == OUT { leave } else { entering.unwrap_or(LEFT) };
            }
            item
        }));
    }
}

/// An instruction that is not placed yet.
fn spot(face: &Face) -> Spot {
    let Face { index, ref words, forced, state, .. } = *face;
    Spot { index, title: words.clone(), enters: LEFT, leaves: RIGHT, forced, state }
}

/// Where a series goes: its wire enters at column `x` of row `y` and leaves at column `x + room`.
#[derive(Clone, Copy)]
pub(crate) struct Way {
    pub x: usize,
    pub y: usize,
    pub room: usize,
    /// The wire that enters.
    pub enter: Node,
    /// The wire that leaves.
    pub leave: Node,
}

/// Places a series; returns the row it leaves on.
pub(crate) fn place(drawing: &mut Drawing, series: Measured, way: Way) -> usize {
    let Way { x, y, room, .. } = way;
    let mut row = y;
    let mut start = x;
    let mut node = way.enter;
    let mut lines = series.lines.into_iter();
    while let Some(line) = lines.next() {
        let Some(next) = lines.as_slice().first() else {
            place_last(
                drawing,
                line,
                Way { x: start, y: row, room: (x + room).saturating_sub(start), enter: node, ..way },
            );
            break;
        };
        let end = start + line.width;
        let below = line.below;
        (_, node) = place_blocks(drawing, line.blocks, start, row, node, None);
        // Outputs alone on the last line stand at the right rail; the wire goes there directly.
        let alone = lines.len() == 1 && next.right == 0;
        let back = if alone { (x + room).saturating_sub(next.width + 1).max(x) } else { x + INDENT - 1 };
        let turn = row + below + 1;
        let next_row = turn + 1 + next.above;
        drawing.wire(Item::new(end, row, Shape::Down { length: turn - row, arrows: true }), node);
        let (from, to, arrow) = if back <= end { (back, end, Direction::Left) } else { (end, back, Direction::Right) };
        drawing.wire(Item::new(from, turn, Shape::Across { length: to - from, arrows: Some(arrow) }), node);
        drawing.wire(Item::down(back, turn, next_row), node);
        drawing.wire(Item::across(back, back + 1, next_row), node);
        start = back + 1;
        row = next_row;
    }
    row
}

/// The last line: conditions at the left, outputs at the right, wire between.
fn place_last(drawing: &mut Drawing, line: Line, way: Way) {
    let Way { x, y, room, enter, leave } = way;
    let Line { mut blocks, right, .. } = line;
    let end = x + room;
    let mut outputs = blocks.split_off(right.min(blocks.len()));
    let outputs_width: usize = outputs.iter().map(|block| block.width).sum();
    if blocks.is_empty() && outputs.is_empty() {
        drawing.shorts.push((enter, leave));
    }
    let last = outputs.is_empty().then_some(leave);
    let (left_end, node) = place_blocks(drawing, blocks, x, y, enter, last);
    if let [Block { content: Content::Box { .. }, width, .. }] = outputs.as_mut_slice() {
        // Its ways come from the left rail, wherever the box stands.
        *width = end.saturating_sub(left_end).max(*width);
        place_blocks(drawing, outputs, left_end, y, node, Some(leave));
        return;
    }
    let right_start = end.saturating_sub(outputs_width).max(left_end);
    drawing.wire(Item::across(left_end, right_start, y), node);
    place_blocks(drawing, outputs, right_start, y, node, Some(leave));
}

/// Blocks next to each other; returns the column after them and the wire that leaves them. `last` is
/// that wire where it has a number.
fn place_blocks(
    drawing: &mut Drawing,
    blocks: Vec<Block>,
    mut x: usize,
    y: usize,
    enter: Node,
    last: Option<Node>,
) -> (usize, Node) {
    let mut node = enter;
    let count = blocks.len();
    for (index, block) in blocks.into_iter().enumerate() {
        let top = y.saturating_sub(block.above);
        let leave = match last.filter(|_| index + 1 == count) {
            Some(last) => last,
            None => drawing.node(),
        };
        match block.content {
            Content::Leaf(spot, own) => drawing.leaf(spot, own, (x, top), &[node], leave),
            Content::Legs(legs) => {
                place_legs(drawing, legs, Way { x, y, room: block.width, enter: node, leave });
            }
            Content::Box { ways, spot, items: own, width, first } => {
                let at = x + block.width - width;
                let (row, ends) = place_ways(drawing, ways, x, y, at, node);
                drawing.leaf(spot, own, (at, row.saturating_sub(first)), &ends, leave);
            }
        }
        node = leave;
        x += block.width;
    }
    (x, node)
}

fn place_legs(drawing: &mut Drawing, legs: Vec<Measured>, way: Way) {
    let Way { x, y, room: width, enter, leave } = way;
    let (left, right) = (x + 1, x + width - 2);
    if legs.is_empty() {
        drawing.shorts.push((enter, leave));
        drawing.wire(Item::across(x, x + width, y), enter);
        return;
    }
    drawing.wire(Item::across(x, left, y), enter);
    drawing.wire(Item::across(right, x + width, y), leave);
    let mut entry = y;
    let mut last = (y, y);
    let mut bottom = None;
    for leg in legs {
        if let Some(bottom) = bottom {
            entry = bottom + 2 + leg.above;
        }
        bottom = Some(entry + leg.below);
        drawing.wire(Item::across(left, left + 1, entry), enter);
        let exit = place(drawing, leg, Way { x: left + 1, y: entry, room: right - left - 1, enter, leave });
        last = (entry, exit);
    }
    drawing.wire(Item::down(left, y, last.0), enter);
    drawing.wire(Item::down(right, y, last.1), leave);
}

/// Ways from a rail at the left side to column `end`; returns the row on which the first one ends, and
/// the wires at their ends.
fn place_ways(
    drawing: &mut Drawing,
    ways: Vec<Measured>,
    x: usize,
    y: usize,
    end: usize,
    enter: Node,
) -> (usize, Vec<Node>) {
    let left = x + 1;
    drawing.wire(Item::across(x, left, y), enter);
    let mut entry = y;
    let mut bottom = None;
    let mut first = None;
    let mut ends = Vec::with_capacity(ways.len());
    for way in ways {
        if let Some(bottom) = bottom {
            entry = bottom + 2 + way.above;
        }
        bottom = Some(entry + way.below);
        drawing.wire(Item::across(left, left + 1, entry), enter);
        let leave = drawing.node();
        let room = end.saturating_sub(left + 1);
        let row = place(drawing, way, Way { x: left + 1, y: entry, room, enter, leave });
        ends.push(leave);
        first.get_or_insert(row);
    }
    drawing.wire(Item::down(left, y, entry), enter);
    (first.unwrap_or(y), ends)
}
