//! The size and the items of one instruction.

use crate::face::{Body, Face, Row, Sign, Text};
use crate::scene::{Item, Node, Of, Role, Shape};
use crate::text::{width, wrap};

/// In a leaf, before it is placed: the wire that leaves it. Wires that enter have the following
/// numbers, one for each leg.
pub(crate) const OUT: Node = 0;
/// The wire that enters first.
pub(crate) const IN: Node = 1;

/// Narrowest place an instruction is drawn in; texts that need more are wrapped.
pub(crate) const LEAF_MIN: usize = 18;

/// Columns of a contact with nothing but short texts: some wire at both sides.
const SYMBOL_MIN: usize = 5;

/// Boxes do not grow beyond this for the sake of a long operand.
const TEXT_MAX: usize = 48;

/// A drawn instruction. Its wire enters at column 0 and leaves at column `width`, `above` rows below
/// its top.
#[derive(Debug, Default)]
pub(crate) struct Leaf {
    /// Columns.
    pub width: usize,
    /// Rows above the wire.
    pub above: usize,
    /// Rows below the wire.
    pub below: usize,
    /// Items, from the top left corner.
    pub items: Vec<Item>,
}

/// Draws a face in at most `limit` columns, which are at least [`LEAF_MIN`].
pub(crate) fn leaf(face: &Face, limit: usize) -> Leaf {
    leaf_with_legs(face, &[], limit)
}

/// Draws a box whose legs enter at its left side: name and row of each, from the row of the first.
pub(crate) fn leaf_with_legs(face: &Face, legs: &[(&'static str, usize)], limit: usize) -> Leaf {
    let limit = limit.max(LEAF_MIN);
    let mut leaf = match &face.body {
        Body::Symbol { sign, above, below } => symbol(&face.labels, sign, above, below, limit),
        Body::Box { name, title, rows, flags } => boxed(&face.labels, name, title, rows, flags, legs, limit),
    };
    for item in &mut leaf.items {
        match &mut item.of {
            Of::Instruction { index, .. } => *index = face.index,
            of @ Of::Rung => *of = Of::Instruction { index: face.index, operand: None, link: None },
            Of::Node(_) => {}
        }
    }
    // Wires first, so that all of an instruction's own items follow each other.
    leaf.items.sort_by_key(|item| item.instruction().is_some());
    leaf
}

fn wrapped<'a>(texts: impl IntoIterator<Item = &'a Text>, limit: usize) -> Vec<Text> {
    texts
        .into_iter()
        .flat_map(|text| wrap(&text.text, limit).into_iter().map(|line| text.with(text.role, line)))
        .collect()
}

fn widest(lines: &[Text]) -> usize {
    lines.iter().map(|text| width(&text.text)).max().unwrap_or(0)
}

/// The item of a text; the number of its instruction is filled in later.
fn item(x: usize, y: usize, text: Text) -> Item {
    let of = Of::Instruction { index: 0, operand: text.operand, link: text.link };
    Item { x, y, shape: Shape::Text(text.role, text.text), of }
}

/// Lines from row `y` on, as one block or each centred, between columns 1 and `1 + inner`.
fn stack(items: &mut Vec<Item>, lines: Vec<Text>, y: usize, inner: usize, centred: bool) {
    let all = widest(&lines);
    for (row, text) in lines.into_iter().enumerate() {
        let own = if centred { width(&text.text) } else { all };
        // Rounded up: a two-letter member stands under the middle of a contact like one digit.
        let x = 1 + inner.saturating_sub(own).div_ceil(2);
        if !text.text.is_empty() {
            items.push(item(x, y + row, text));
        }
    }
}

/// A contact or coil: symbol and address above, bit and module below, everything about one axis.
fn symbol(labels: &[Text], sign: &Sign, above: &Text, below: &[Text], limit: usize) -> Leaf {
    let room = limit - 2;
    let labels = wrapped(labels, room);
    let address = wrapped([above].into_iter().filter(|above| !above.text.is_empty()), room);
    let below = wrapped(below, room);
    let (sign_width, shape) = match sign {
        Sign::Contact { closed } => (3, Shape::Contact { closed: *closed }),
        Sign::Coil(letters) => (2 + letters.len().max(1), Shape::Coil((*letters).to_owned())),
        Sign::Marked(letters) => (2 + letters.len(), Shape::Marked((*letters).to_owned())),
    };
    let texts = widest(&labels).max(widest(&address)).max(widest(&below));
    // A name in the sign can be wider than the operand above it.
    let needed = texts.max(sign_width).max(SYMBOL_MIN);
    // An odd width gives an odd sign a middle.
    let inner = (needed + usize::from((needed ^ sign_width) & 1 == 1)).min(room.max(needed));

    let wire = labels.len() + address.len();
    let sign_at = 1 + (inner - sign_width) / 2;
    let mut leaf = Leaf { width: inner + 2, above: wire, below: below.len(), items: Vec::new() };
    leaf.items.push(Item::across(0, sign_at, wire).on(IN));
    leaf.items.push(Item::new(sign_at, wire, shape));
    leaf.items.push(Item::across(sign_at + sign_width - 1, inner + 2, wire).on(OUT));
    let address_at = labels.len();
    stack(&mut leaf.items, labels, 0, inner, false);
    stack(&mut leaf.items, address, address_at, inner, true);
    stack(&mut leaf.items, below, wire + 1, inner, true);
    leaf
}

/// A line inside a frame.
enum Line {
    /// From the left side.
    Left(Role, String),
    /// Name at the left, text at the right side; whether `<` follows.
    Pair(String, Text, bool),
}

/// A frame with its rows; the wire enters at the row of the title.
fn boxed(
    labels: &[Text],
    name: &str,
    title: &str,
    rows: &[Row],
    flags: &[&'static str],
    legs: &[(&'static str, usize)],
    limit: usize,
) -> Leaf {
    let flag_width = flags.iter().map(|flag| flag.len() + 3).max().unwrap_or(0);
    let leg_width = legs.iter().map(|(name, _)| name.len() + 2).max().unwrap_or(0);
    // Stubs of the wire at both ends, frame and a space inside it at both sides.
    let room = (limit - 6).saturating_sub(flag_width + leg_width).min(TEXT_MAX);
    let lines = lines(title, rows, room);
    let text = lines.iter().map(Line::width).max().unwrap_or(0).max(width(name) + 2).min(room);

    let labels = wrapped(labels, limit - 2);
    let names = wrap(name, text.max(2));
    // A name too long for the upper side is a first row as well.
    let (side, extra) = match names.as_slice() {
        [short] if width(short) + 2 <= text + 2 => (short.clone(), Vec::new()),
        _ => (String::new(), names),
    };
    let top = labels.len();
    let wire = top + 1;
    let last_leg = legs.last().map_or(0, |(_, row)| row + 1);
    let count = (extra.len() + lines.len()).max((flags.len() * 2).saturating_sub(1)).max(last_leg);
    let frame = text + 4 + leg_width;
    let mut leaf = Leaf { above: wire, below: count, ..Leaf::default() };
    leaf.width = (1 + frame + flag_width + 1).max(widest(&labels) + 2);

    let items = &mut leaf.items;
    for (leg, row) in legs.iter().map(|(_, row)| *row).chain(legs.is_empty().then_some(0)).enumerate() {
        items.push(Item::across(0, 1, wire + row).on(IN + leg));
    }
    for (name, row) in legs {
        items.push(Item::text(3, wire + row, Role::Name, *name));
    }
    items.push(Item::new(1, top, Shape::Frame { width: frame, height: count + 2, name: side }));
    // A wire ends where a flag stands on it.
    let (mut from, flag_at) = (frame, frame + 2);
    for (index, flag) in flags.iter().enumerate() {
        let y = wire + 2 * index;
        let wire = Item::across(frame, flag_at, y);
        items.push(if index == 0 { wire.on(OUT) } else { wire });
        items.push(Item::new(flag_at, y, Shape::Coil((*flag).to_owned())));
        if index == 0 {
            from = flag_at + flag.len() + 1;
        }
    }
    items.push(Item::across(from, leaf.width, wire).on(OUT));
    for (row, text) in labels.into_iter().enumerate().filter(|(_, text)| !text.text.is_empty()) {
        items.push(item(1, row, text));
    }
    let extra = extra.into_iter().map(|text| Line::Left(Role::BoxTitle, text));
    for (row, line) in extra.chain(lines).enumerate() {
        line.place(items, leg_width, wire + row, text);
    }
    leaf
}

/// The rows as lines of at most `room` columns. Values stand one column further right than operands,
/// by the `<` after them.
fn lines(title: &str, rows: &[Row], room: usize) -> Vec<Line> {
    let mut lines: Vec<Line> = wrap(title, room).into_iter().map(|line| Line::Left(Role::BoxTitle, line)).collect();
    for row in rows {
        let gap = if row.name.is_empty() || row.text.text.is_empty() { 0 } else { 2 };
        if width(&row.name) + gap + width(&row.text.text) < room {
            lines.push(Line::Pair(row.name.clone(), row.text.clone(), row.live));
            continue;
        }
        if !row.name.is_empty() {
            lines.extend(wrap(&row.name, room).into_iter().map(|line| Line::Left(Role::Name, line)));
        }
        let parts = wrapped([&row.text], room - 1);
        let last = parts.len() - 1;
        for (index, part) in parts.into_iter().enumerate() {
            lines.push(Line::Pair(String::new(), part, row.live && index == last));
        }
    }
    lines
}

impl Line {
    fn width(&self) -> usize {
        match self {
            Line::Left(_, text) => width(text),
            Line::Pair(name, text, _) if text.text.is_empty() => width(name),
            Line::Pair(name, text, _) => width(name) + 2 * usize::from(!name.is_empty()) + width(&text.text) + 1,
        }
    }

    fn place(self, items: &mut Vec<Item>, left: usize, y: usize, room: usize) {
        let left = left + 3;
        match self {
            Line::Left(role, text) => items.push(Item::text(left, y, role, text)),
            Line::Pair(name, mut text, live) => {
                if !name.is_empty() {
                    items.push(Item::text(left, y, Role::Name, name));
                }
                if !text.text.is_empty() {
                    let x = left + room.saturating_sub(width(&text.text) + 1);
                    text.text.push_str(if live { "<" } else { "" });
                    items.push(item(x, y, text));
                }
            }
        }
    }
}
