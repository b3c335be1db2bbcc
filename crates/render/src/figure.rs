//! A scene as areas, strokes and texts with places in points: what SVG and PDF have in common.
//!
//! A grid cell is [`CELL_WIDTH`] by [`CELL_HEIGHT`] units, y grows downwards. Everything stays inside
//! [`Figure::width`] and [`Figure::height`].

use std::collections::BTreeMap;

use crate::paint::{arrow_columns, arrow_rows};
use crate::scene::{Direction, Item, Node, Of, Role, Scene, Shape};
use crate::text::width as columns;

/// Units of a column.
pub const CELL_WIDTH: usize = 8;
/// Units of a row.
pub const CELL_HEIGHT: usize = 16;
/// From the upper side of a row to the line its text stands on.
pub const BASELINE: usize = 12;

/// Half the height of contacts, coils and brackets.
const SIGN: usize = 7;
/// Between an instruction and its outline.
const MARGIN: usize = 3;

/// A drawing without a medium.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Figure {
    /// Units.
    pub width: usize,
    /// Units.
    pub height: usize,
    /// What belongs to no instruction, without wires: backgrounds first.
    pub rung: Vec<Ink>,
    /// Wires, one path for each node. Nodes without a visible wire have none.
    pub wires: Vec<(Node, Vec<Step>)>,
    /// Instructions in the order of [`Scene::instructions`].
    pub instructions: Vec<Group>,
}

/// An instruction of a figure.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Group {
    /// Its number in the rung.
    pub index: usize,
    /// Backgrounds first.
    pub inks: Vec<Ink>,
    /// Around all of it, a little wider: for marks.
    pub outline: Area,
    /// Left and right of a contact or coil: filled to show that it conducts. None at boxes.
    pub bars: Vec<Area>,
}

/// A rectangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Area {
    /// Left side.
    pub x: usize,
    /// Upper side.
    pub y: usize,
    /// Units to the right side.
    pub width: usize,
    /// Units to the lower side.
    pub height: usize,
}

/// One thing to put on the medium.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ink {
    /// A background.
    Fill(Role, Area),
    /// A path to draw, not to fill.
    Stroke(Pen, Vec<Step>),
    /// A line of text.
    Text(Line),
}

/// What a stroke is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pen {
    /// A power rail.
    Rail,
    /// A wire at a flag of a box, or an arrow head.
    Wire,
    /// A contact, coil or bracket.
    Sign,
    /// The frame of a box.
    Frame,
}

/// A line of text that fills its width exactly, whatever the font.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// Left end.
    pub x: usize,
    /// The line it stands on.
    pub y: usize,
    /// Units it takes; [`CELL_WIDTH`] for each column.
    pub width: usize,
    /// What it says.
    pub role: Role,
    /// The text, without spaces at its ends.
    pub text: String,
    /// The operand it shows.
    pub operand: Option<usize>,
    /// The address it stands for.
    pub link: Option<String>,
}

/// A step of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Begins a line.
    Move(usize, usize),
    /// A straight line.
    Line(usize, usize),
    /// A cubic curve: two control points and its end.
    Curve((usize, usize), (usize, usize), (usize, usize)),
}

/// Centre of a column.
fn across(x: usize) -> usize {
    x * CELL_WIDTH + CELL_WIDTH / 2
}

/// Centre of a row.
fn down(y: usize) -> usize {
    y * CELL_HEIGHT + CELL_HEIGHT / 2
}

/// The figure of a scene.
pub fn figure(scene: &Scene) -> Figure {
    // Nothing is cut off, so some texts may go beyond the scene.
    let overflow = scene.items.iter().map(right_end).max().unwrap_or(0);
    let mut figure = Figure {
        width: scene.width.max(overflow) * CELL_WIDTH,
        height: scene.height * CELL_HEIGHT,
        ..Figure::default()
    };
    let mut wires = BTreeMap::new();
    let mut current: Option<Group> = None;
    for item in &scene.items {
        match item.of {
            Of::Node(node) => {
                wires.entry(node).or_insert_with(Vec::new).extend(ends(item));
                arrows(item, &mut figure.rung);
            }
            Of::Rung => ink(item, scene.height, &mut figure.rung),
            Of::Instruction { index, .. } => {
                if let Some(done) = current.take_if(|group| group.index != index) {
                    figure.instructions.push(finished(done, &figure));
                }
                let group = current.get_or_insert_with(|| Group { index, ..Group::default() });
                bars(item, &mut group.bars);
                ink(item, scene.height, &mut group.inks);
            }
        }
    }
    if let Some(group) = current {
        figure.instructions.push(finished(group, &figure));
    }
    let mut rails = scene.items.iter().filter(|item| item.shape == Shape::Rail).map(|item| across(item.x));
    if let (Some(left), Some(right)) = (rails.next(), rails.next()) {
        // Comments and titles have a background from rail to rail.
        let (x, width) = (left + 2, right.saturating_sub(left + 4));
        let wide = |area: Area| Area { x, width, ..area };
        put_behind(&mut figure.rung, wide);
    }
    figure.wires = wires.into_iter().map(|(node, ends)| (node, path(ends))).collect();
    figure
}

/// The column after the last one of a text.
fn right_end(item: &Item) -> usize {
    match &item.shape {
        Shape::Text(_, text) => item.x + columns(text),
        _ => 0,
    }
}

fn finished(mut group: Group, figure: &Figure) -> Group {
    // Flags beside a box (EN, DN) have bits of their own: that the box has power says nothing about them.
    if group.inks.iter().any(|ink| matches!(ink, Ink::Stroke(Pen::Frame, _))) {
        group.bars.clear();
    }
    put_behind(&mut group.inks, |area| area);
    let areas = group.inks.iter().map(extent);
    let Some(all) = areas.reduce(|a, b| {
        let (x, y) = (a.x.min(b.x), a.y.min(b.y));
        let width = (a.x + a.width).max(b.x + b.width) - x;
        Area { x, y, width, height: (a.y + a.height).max(b.y + b.height) - y }
    }) else {
        return group;
    };
    let (x, y) = (all.x.saturating_sub(MARGIN), all.y.saturating_sub(MARGIN));
    let width = (all.x + all.width + MARGIN).min(figure.width) - x;
    group.outline = Area { x, y, width, height: (all.y + all.height + MARGIN).min(figure.height) - y };
    group
}

/// The rectangle around something.
fn extent(ink: &Ink) -> Area {
    match ink {
        Ink::Fill(_, area) => *area,
        Ink::Text(line) => {
            Area { x: line.x, y: line.y.saturating_sub(BASELINE), width: line.width, height: CELL_HEIGHT }
        }
        Ink::Stroke(_, steps) => {
            let points = steps.iter().map(|step| match *step {
                Step::Move(x, y) | Step::Line(x, y) | Step::Curve(_, _, (x, y)) => (x, y),
            });
            let (mut from, mut to) = ((usize::MAX, usize::MAX), (0, 0));
            for (x, y) in points {
                from = (from.0.min(x), from.1.min(y));
                to = (to.0.max(x), to.1.max(y));
            }
            let (x, y) = (from.0.min(to.0), from.1.min(to.1));
            Area { x, y, width: to.0 - x, height: to.1 - y }
        }
    }
}

/// Puts backgrounds behind the texts that have one, one for all lines of a role that follow each other.
fn put_behind(inks: &mut Vec<Ink>, shape: impl Fn(Area) -> Area) {
    let mut fills: Vec<(Role, Area)> = Vec::new();
    for ink in inks.iter() {
        let Ink::Text(Line { role, .. }) = ink else { continue };
        if !matches!(role, Role::Title | Role::Comment | Role::Description | Role::Symbol) {
            continue;
        }
        let area = shape(extent(ink));
        match fills.last_mut() {
            // A blank line is part of the comment it stands in.
            Some((last, whole)) if last == role && area.y > whole.y => {
                let right = (whole.x + whole.width).max(area.x + area.width);
                whole.x = whole.x.min(area.x);
                whole.width = right - whole.x;
                whole.height = area.y + area.height - whole.y;
            }
            _ => fills.push((*role, area)),
        }
    }
    inks.splice(0..0, fills.into_iter().map(|(role, area)| Ink::Fill(role, area)));
}

/// A wire from end to end.
fn ends(item: &Item) -> Option<[(usize, usize); 2]> {
    let Item { x, y, ref shape, .. } = *item;
    let end = match shape {
        Shape::Across { length, .. } => (x + length, y),
        Shape::Down { length, .. } => (x, y + length),
        _ => return None,
    };
    ((x, y) != end).then_some([(x, y), end])
}

/// Wires as one path; what goes on in the same direction becomes one line.
fn path(mut wires: Vec<[(usize, usize); 2]>) -> Vec<Step> {
    wires.sort_by_key(|[from, to]| (from.0 == to.0, if from.0 == to.0 { *from } else { (from.1, from.0) }));
    let mut joined: Vec<[(usize, usize); 2]> = Vec::with_capacity(wires.len());
    for [from, to] in wires {
        match joined.last_mut() {
            Some([start, end]) if *end == from && (start.0 == end.0) == (from.0 == to.0) => *end = to,
            _ => joined.push([from, to]),
        }
    }
    let step = |[from, to]: [(usize, usize); 2]| {
        [Step::Move(across(from.0), down(from.1)), Step::Line(across(to.0), down(to.1))]
    };
    joined.into_iter().flat_map(step).collect()
}

/// The arrow heads of a wire that goes on elsewhere.
fn arrows(item: &Item, out: &mut Vec<Ink>) {
    let mut head = |tip: (usize, usize), wings: [(usize, usize); 2]| {
        let [one, other] = wings;
        let steps = vec![Step::Move(one.0, one.1), Step::Line(tip.0, tip.1), Step::Line(other.0, other.1)];
        out.push(Ink::Stroke(Pen::Wire, steps));
    };
    match item.shape {
        Shape::Across { length, arrows: Some(direction) } => {
            for column in arrow_columns(item.x, length) {
                let (x, y) = (across(column), down(item.y));
                let (tip, back) = match direction {
                    Direction::Left => (x.saturating_sub(3), x + 2),
                    Direction::Right => (x + 3, x.saturating_sub(2)),
                };
                head((tip, y), [(back, y - 4), (back, y + 4)]);
            }
        }
        Shape::Down { length, arrows: true } => {
            for row in arrow_rows(item.y, item.y + length) {
                let (x, y) = (across(item.x), down(row));
                head((x, y + 3), [(x.saturating_sub(4), y - 2), (x + 4, y - 2)]);
            }
        }
        _ => {}
    }
}

/// Where a contact or coil is filled to show that it conducts: on the wire at both sides of the sign.
fn bars(item: &Item, out: &mut Vec<Area>) {
    let width = match &item.shape {
        Shape::Contact { .. } => 3,
        Shape::Coil(letters) | Shape::Marked(letters) => columns(letters).max(1) + 2,
        _ => return,
    };
    let (left, right, y) = (item.x * CELL_WIDTH, (item.x + width) * CELL_WIDTH, down(item.y));
    let from = left.saturating_sub(CELL_WIDTH);
    out.push(Area { x: from, y: y - 3, width: left + 5 - from, height: 6 });
    out.push(Area { x: right - 5, y: y - 3, width: CELL_WIDTH + 5, height: 6 });
}

/// An item as ink.
fn ink(item: &Item, rows: usize, out: &mut Vec<Ink>) {
    let Item { x, y, ref shape, .. } = *item;
    let mut stroke = |pen, steps: Vec<Step>| out.push(Ink::Stroke(pen, steps));
    use Step::{Line as L, Move as M};
    match shape {
        Shape::Text(role, text) => out.extend(line(item, *role, text, x)),
        Shape::Across { .. } | Shape::Down { .. } => {
            stroke(Pen::Wire, path(ends(item).into_iter().collect()));
        }
        Shape::Rail => stroke(Pen::Rail, vec![M(across(x), y * CELL_HEIGHT), L(across(x), rows * CELL_HEIGHT)]),
        Shape::Frame { width, height, name } => {
            let (left, right) = (across(x), across(x + width.saturating_sub(1)));
            let (top, bottom) = (down(y), down(y + height.saturating_sub(1)));
            // The name stands in a gap of the upper side.
            let at = x + width.saturating_sub(columns(name)) / 2;
            let gap = if name.is_empty() { 0 } else { columns(name) * CELL_WIDTH + 4 };
            let from = (at * CELL_WIDTH).saturating_sub(2).clamp(left, right);
            let to = (from + gap).min(right);
            let mut steps =
                vec![M(from, top), L(left, top), L(left, bottom), L(right, bottom), L(right, top), L(to, top)];
            if gap == 0 {
                steps = vec![M(left, top), L(left, bottom), L(right, bottom), L(right, top), L(left, top)];
            }
            stroke(Pen::Frame, steps);
            out.extend(line(item, Role::Mnemonic, name, at));
        }
        Shape::Contact { closed } => {
            let (left, right, wire) = (x * CELL_WIDTH, (x + 3) * CELL_WIDTH, down(y));
            let (one, other) = (left + CELL_WIDTH, right - CELL_WIDTH);
            let mut steps =
                vec![M(one, wire - SIGN), L(one, wire + SIGN), M(other, wire - SIGN), L(other, wire + SIGN)];
            steps.extend([M(across(x), wire), L(one, wire), M(other, wire), L(across(x + 2), wire)]);
            if *closed {
                steps.extend([M(one - 2, wire + SIGN), L(other + 2, wire - SIGN)]);
            }
            stroke(Pen::Sign, steps);
        }
        Shape::Coil(letters) => {
            let width = columns(letters).max(1) + 2;
            // The arcs meet the wires, which end in the middle of the first and last column.
            let (left, right, wire) = (across(x), across(x + width - 1), down(y));
            let arc = |side: usize, inner: usize| {
                let (top, bottom) = (wire - SIGN, wire + SIGN);
                [M(inner, top), Step::Curve((side, top + 3), (side, bottom - 3), (inner, bottom))]
            };
            let mut steps = Vec::from(arc(left - 1, left + 3));
            steps.extend(arc(right + 1, right - 3));
            stroke(Pen::Sign, steps);
            out.extend(line(item, Role::Mnemonic, letters, x + 1));
        }
        Shape::Marked(letters) => {
            let width = columns(letters) + 2;
            let (left, right, wire) = (across(x), across(x + width - 1), down(y));
            let bracket = |side: usize, inner: usize| {
                [M(inner, wire - SIGN), L(side, wire - SIGN), L(side, wire + SIGN), L(inner, wire + SIGN)]
            };
            let mut steps = Vec::from(bracket(left, left + 3));
            steps.extend(bracket(right, right - 3));
            stroke(Pen::Sign, steps);
            out.extend(line(item, Role::Mnemonic, letters, x + 1));
        }
    }
}

/// A text without the spaces at its ends; nothing if nothing is left.
fn line(item: &Item, role: Role, text: &str, x: usize) -> Option<Ink> {
    let start = text.trim_start_matches(' ');
    let shown = start.trim_end_matches(' ');
    if shown.is_empty() {
        return None;
    }
    let (operand, link) = match &item.of {
        Of::Instruction { operand, link, .. } => (*operand, link.clone()),
        _ => (None, None),
    };
    Some(Ink::Text(Line {
        x: (x + text.len() - start.len()) * CELL_WIDTH,
        y: item.y * CELL_HEIGHT + BASELINE,
        width: columns(shown) * CELL_WIDTH,
        role,
        text: shown.to_owned(),
        operand,
        link,
    }))
}
