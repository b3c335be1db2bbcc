//! Following the wire of a rung from the left rail to the right one.

use super::page::{Colour, Stroke, Text};
use super::sheet::Sheet;
use super::symbol::{self, Shape};
use super::{DrawnRung, NEAR, Node, ROW, near};

/// A rung cannot hold more pieces than this; a walk that gets there goes in a circle.
const MOST: usize = 10_000;

/// Reads a rung's number, marks, comment and tree.
pub(super) fn rung(sheet: &Sheet) -> DrawnRung {
    let (number, edited) = margin(sheet);
    let mut walk = Walk { sheet, faults: Vec::new(), steps: 0 };
    let nodes = match walk.start() {
        Some(y) => walk.leg(sheet.left, y, End::Rail),
        None => {
            walk.faults.push("no wire at the left rail".to_owned());
            Vec::new()
        }
    };
    let mut faults = walk.faults;
    if number.is_none() {
        faults.push("no rung number".to_owned());
    }
    DrawnRung { number, edited, title: sheet.title(), comment: sheet.comment(), nodes, faults }
}

/// Rung number and `e` marks left of the rail.
fn margin(sheet: &Sheet) -> (Option<usize>, bool) {
    let (mut number, mut edited) = (None, false);
    for text in sheet.texts.iter().filter(|t| t.x1 < sheet.left + 1.0) {
        match text.text.trim() {
            "e" => edited = true,
            digits => number = digits.parse().ok().or(number),
        }
    }
    (number, edited)
}

/// Where a leg ends.
#[derive(Clone, Copy)]
enum End {
    /// At the right rail.
    Rail,
    /// At the vertical that closes its branch, which reaches from the upper leg (`top`)
    /// at least down to the second one. Only the upper leg finds out where that is.
    Closing { top: f64, second: f64 },
    /// At a known place.
    At(f64),
}

struct Walk<'a> {
    sheet: &'a Sheet,
    faults: Vec<String>,
    steps: usize,
}

impl Walk<'_> {
    /// Height of the wire that leaves the left rail.
    fn start(&self) -> Option<f64> {
        let left = self.sheet.left;
        self.horizontals().find(|s| near(s.x0, left) && s.x1 > left + NEAR).map(|s| s.y0)
    }

    fn horizontals(&self) -> impl Iterator<Item = &Stroke> {
        self.sheet.strokes.iter().filter(|s| near(s.y0, s.y1) && s.x1 - s.x0 > NEAR)
    }

    fn verticals(&self) -> impl Iterator<Item = &Stroke> {
        self.sheet.strokes.iter().filter(|s| near(s.x0, s.x1) && s.y1 > s.y0 + ROW)
    }

    /// The right end of the wire that covers `x` at height `y`.
    fn wire(&self, x: f64, y: f64) -> Option<f64> {
        let on = |s: &&Stroke| near(s.y0, y) && s.x0 < x + NEAR && s.x1 > x + NEAR;
        self.horizontals().filter(on).map(|s| s.x1).max_by(f64::total_cmp)
    }

    /// Walks one leg; gives its nodes. For the upper leg of a branch see [`Self::upper`].
    fn leg(&mut self, x: f64, y: f64, end: End) -> Vec<Node> {
        self.upper(x, y, end).0
    }

    /// Walks a leg and tells where it ended.
    fn upper(&mut self, mut x: f64, mut y: f64, end: End) -> (Vec<Node>, f64) {
        let mut nodes = Vec::new();
        loop {
            self.steps += 1;
            if self.steps > MOST {
                self.faults.push("the wire goes in a circle".to_owned());
                return (nodes, x);
            }
            let limit = match end {
                End::Rail => self.sheet.right,
                End::At(limit) => limit,
                End::Closing { .. } => f64::INFINITY,
            };
            if x >= limit - NEAR {
                return (nodes, x);
            }
            let Some(wire) = self.wire(x, y) else {
                let Some(next) = self.gap(x, y, &mut nodes) else { return (nodes, x) };
                x = next;
                continue;
            };
            match self.junction(x, y, wire.min(limit - 2.0 * NEAR), end) {
                None => x = wire.min(limit),
                Some(Junction::Closing(at)) => return (nodes, at),
                Some(Junction::Turn { at, bottom }) => {
                    let Some(next) = self.turn(at, bottom) else {
                        self.faults.push(format!("a turned wire at x {at:.1} does not go on"));
                        return (nodes, x);
                    };
                    (x, y) = next;
                }
                Some(Junction::Branch { at, bottom }) => {
                    let (legs, after) = self.branch(at, y, bottom);
                    nodes.push(Node::Branch(legs));
                    x = after;
                }
            }
        }
    }

    /// The first vertical that meets the wire behind `x` and not behind `wire`.
    fn junction(&self, x: f64, y: f64, wire: f64, end: End) -> Option<Junction> {
        let ahead = |s: &&Stroke| s.x0 > x + NEAR && s.x0 < wire + NEAR && s.y0 < y + NEAR && s.y1 > y - NEAR;
        let closes = |s: &Stroke| match end {
            End::Closing { top, second } => near(s.y0, top) && s.y1 > second - NEAR,
            End::Rail | End::At(_) => false,
        };
        let meets = |s: &&Stroke| near(s.y0, y) || closes(s);
        let first = self.verticals().filter(ahead).filter(meets).min_by(|a, b| a.x0.total_cmp(&b.x0))?;
        let (at, bottom) = (first.x0, first.y1);
        Some(if self.turned(first) {
            Junction::Turn { at, bottom }
        } else if closes(first) {
            Junction::Closing(at)
        } else {
            Junction::Branch { at, bottom }
        })
    }

    /// A rung too wide for the paper turns: its wire runs down, back to the left and down
    /// again, with arrow heads on it, two short strokes each that meet on the line.
    fn turned(&self, line: &Stroke) -> bool {
        self.sheet.strokes.iter().any(|s| {
            let slanted = !near(s.x0, s.x1) && !near(s.y0, s.y1) && s.x1 - s.x0 < ROW / 2.0;
            // The left stroke of an arrow head comes from the left above and ends on the line.
            slanted && near(s.x1, line.x0) && s.y0 < s.y1 && s.y0 > line.y0 - NEAR && s.y1 < line.y1 + NEAR
        })
    }

    /// Where a turned wire goes on: the lower end of the vertical at the far end of its way back
    /// (mostly to the left, to the right where only little stands on the line below).
    fn turn(&self, x: f64, bottom: f64) -> Option<(f64, f64)> {
        let way = self.horizontals().filter(|s| near(s.y0, bottom));
        let far = way.filter_map(|s| if near(s.x1, x) { Some(s.x0) } else { near(s.x0, x).then_some(s.x1) });
        let far = far.max_by(|a, b| (a - x).abs().total_cmp(&(b - x).abs()))?;
        let down = self.verticals().find(|s| near(s.x0, far) && near(s.y0, bottom))?;
        Some((far, down.y1))
    }

    /// Reads the shape in the gap at `x`; gives the place where the wire goes on.
    fn gap(&mut self, x: f64, y: f64, nodes: &mut Vec<Node>) -> Option<f64> {
        let right = self.horizontals().filter(|s| near(s.y0, y) && s.x0 > x + NEAR).map(|s| s.x0);
        let right = right.min_by(f64::total_cmp).unwrap_or(self.sheet.right);
        let Some(found) = symbol::recognise(self.sheet, x, right, y) else {
            self.faults.push(format!("nothing known at x {x:.1}, {:.1} rows down", y / ROW));
            return None;
        };
        let after_box = matches!(nodes.last(), Some(Node::Instruction(last)) if last.shape == Shape::Box);
        if !(after_box && symbol::is_flag(&found.instruction)) {
            nodes.push(Node::Instruction(found.instruction));
        }
        Some(found.end)
    }

    /// Walks the legs of the branch whose left vertical falls from (`x`, `y`) to `bottom`.
    fn branch(&mut self, x: f64, y: f64, bottom: f64) -> (Vec<Vec<Node>>, f64) {
        let mut heights: Vec<f64> = self
            .horizontals()
            .filter(|s| near(s.x0, x) && s.y0 > y + NEAR && s.y0 < bottom + NEAR)
            .map(|s| s.y0)
            .collect();
        heights.sort_by(f64::total_cmp);
        heights.dedup_by(|a, b| near(*a, *b));
        if !heights.last().is_some_and(|&last| near(last, bottom)) {
            self.faults.push(format!("a branch at x {x:.1} without a wire at its lower end"));
        }
        let second = heights.first().copied().unwrap_or(bottom);
        let (first, close) = self.upper(x, y, End::Closing { top: y, second });
        let mut legs = vec![first];
        for height in heights {
            legs.push(self.leg(x, height, End::At(close)));
        }
        (legs, close)
    }
}

/// What a vertical on the way of a wire is.
enum Junction {
    /// The end of the branch that the leg belongs to.
    Closing(f64),
    /// A wire that turns to the next line of the paper.
    Turn { at: f64, bottom: f64 },
    /// The begin of a branch.
    Branch { at: f64, bottom: f64 },
}

impl Sheet {
    /// A page title lies on a green strip from rail to rail.
    pub(super) fn is_title(&self, strip: &super::Fill) -> bool {
        strip.colour == Colour::Green && strip.x0 < self.left + ROW && strip.x1 > self.right - ROW
    }

    fn title(&self) -> Option<String> {
        let strip = self.fills.iter().find(|f| self.is_title(f))?;
        let on = |t: &&Text| t.y > strip.y0 && t.y < strip.y1 && t.x0 > strip.x0 && t.x1 < strip.x1 + 1.0;
        self.texts.iter().find(on).map(|t| t.text.trim().to_owned())
    }

    /// The texts on yellow, each printed line once.
    fn comment(&self) -> Vec<String> {
        let on_yellow = |t: &Text| {
            let under = |f: &super::Fill| f.y0 < t.y && t.y < f.y1 && f.x0 < t.x0 + 1.0 && t.x0 < f.x1;
            self.fills.iter().any(|f| f.colour == Colour::Yellow && under(f))
        };
        let mut lines: Vec<&Text> = self.texts.iter().filter(|t| on_yellow(t)).collect();
        lines.sort_by(|a, b| a.y.total_cmp(&b.y).then(a.x0.total_cmp(&b.x0)));
        lines.iter().map(|t| t.text.trim_end().to_owned()).collect()
    }
}
