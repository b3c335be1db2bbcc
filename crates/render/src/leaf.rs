//! The size and the items of one instruction.

use crate::face::{Body, Face, Row, Sign};
use crate::scene::{Item, Role, Shape};
use crate::text::{width, wrap};

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
    let limit = limit.max(LEAF_MIN);
    match &face.body {
        Body::Symbol { sign, above, below } => symbol(&face.labels, sign, above, below, limit),
        Body::Box { name, title, rows, flags } => boxed(&face.labels, name, title, rows, flags, &[], limit),
    }
}

/// Draws a box whose legs enter at its left side: name and row of each, from the row of the first.
pub(crate) fn leaf_with_legs(face: &Face, legs: &[(&'static str, usize)], limit: usize) -> Leaf {
    let limit = limit.max(LEAF_MIN);
    match &face.body {
        Body::Symbol { .. } => leaf(face, limit),
        Body::Box { name, title, rows, flags } => boxed(&face.labels, name, title, rows, flags, legs, limit),
    }
}

fn wrapped(lines: &[(Role, String)], limit: usize) -> Vec<(Role, String)> {
    lines.iter().flat_map(|(role, text)| wrap(text, limit).into_iter().map(|line| (*role, line))).collect()
}

fn widest(lines: &[(Role, String)]) -> usize {
    lines.iter().map(|(_, text)| width(text)).max().unwrap_or(0)
}

/// Lines from row `y` on, as one block or each centred, between columns 1 and `1 + inner`.
fn stack(items: &mut Vec<Item>, lines: Vec<(Role, String)>, y: usize, inner: usize, centred: bool) {
    let all = widest(&lines);
    for (row, (role, text)) in lines.into_iter().enumerate() {
        let own = if centred { width(&text) } else { all };
        // Rounded up: a two-letter member stands under the middle of a contact like one digit.
        let x = 1 + inner.saturating_sub(own).div_ceil(2);
        if !text.is_empty() {
            items.push(Item::text(x, y + row, role, text));
        }
    }
}

/// A contact or coil: symbol and address above, bit and module below, everything about one axis.
fn symbol(labels: &[(Role, String)], sign: &Sign, above: &str, below: &[(Role, String)], limit: usize) -> Leaf {
    let room = limit - 2;
    let labels = wrapped(labels, room);
    let address = if above.is_empty() { Vec::new() } else { wrapped(&[(Role::Address, above.to_owned())], room) };
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
    leaf.items.push(Item::across(0, sign_at, wire));
    leaf.items.push(Item { x: sign_at, y: wire, shape });
    leaf.items.push(Item::across(sign_at + sign_width - 1, inner + 2, wire));
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
    /// Name at the left, text at the right side.
    Pair(String, Role, String, bool),
}

/// A frame with its rows; the wire enters at the row of the title.
fn boxed(
    labels: &[(Role, String)],
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
    for row in legs.iter().map(|(_, row)| *row).chain(legs.is_empty().then_some(0)) {
        items.push(Item::across(0, 1, wire + row));
    }
    for (name, row) in legs {
        items.push(Item::text(3, wire + row, Role::Name, *name));
    }
    items.push(Item { x: 1, y: top, shape: Shape::Frame { width: frame, height: count + 2, name: side } });
    items.push(Item::across(frame, leaf.width, wire));
    for (index, flag) in flags.iter().enumerate() {
        let y = wire + 2 * index;
        items.push(Item { x: frame + 2, y, shape: Shape::Coil((*flag).to_owned()) });
        if index > 0 {
            items.push(Item::across(frame, frame + flag_width, y));
        }
    }
    for (row, (role, text)) in labels.into_iter().enumerate() {
        items.push(Item::text(1, row, role, text));
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
        let gap = if row.name.is_empty() || row.text.is_empty() { 0 } else { 2 };
        if width(&row.name) + gap + width(&row.text) < room {
            lines.push(Line::Pair(row.name.clone(), row.role, row.text.clone(), row.live));
            continue;
        }
        if !row.name.is_empty() {
            lines.extend(wrap(&row.name, room).into_iter().map(|line| Line::Left(Role::Name, line)));
        }
        let parts = wrap(&row.text, room - 1);
        let last = parts.len() - 1;
        for (index, part) in parts.into_iter().enumerate() {
            lines.push(Line::Pair(String::new(), row.role, part, row.live && index == last));
        }
    }
    lines
}

impl Line {
    fn width(&self) -> usize {
        match self {
            Line::Left(_, text) => width(text),
            Line::Pair(name, _, text, _) if text.is_empty() => width(name),
            Line::Pair(name, _, text, _) => width(name) + 2 * usize::from(!name.is_empty()) + width(text) + 1,
        }
    }

    fn place(self, items: &mut Vec<Item>, left: usize, y: usize, room: usize) {
        let left = left + 3;
        match self {
            Line::Left(role, text) => items.push(Item::text(left, y, role, text)),
            Line::Pair(name, role, text, live) => {
                if !name.is_empty() {
                    items.push(Item::text(left, y, Role::Name, name));
                }
                if !text.is_empty() {
                    let x = left + room.saturating_sub(width(&text) + 1);
                    let text = if live { text + "<" } else { text };
                    items.push(Item::text(x, y, role, text));
                }
            }
        }
    }
}
