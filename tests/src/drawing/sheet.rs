//! One rung's marks, cut out of the pages by its rails and joined over page breaks.
//!
//! Beside every rung stands a piece of the left and of the right rail as long as the
//! rung is high. On each further page of a long rung the same piece is drawn again,
//! starting above the paper by what earlier pages have shown, so the heights below
//! the rail's upper end are the same on all pages.

use super::near;
use super::page::{Colour, Fill, Page, Stroke, Text};

/// The marks of a rung; y is measured from the upper end of its rail.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sheet {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) height: f64,
    pub(super) strokes: Vec<Stroke>,
    pub(super) fills: Vec<Fill>,
    pub(super) texts: Vec<Text>,
}

/// Where RSLogix draws the left rail.
const LEFT_RAIL: f64 = 39.12;

/// Adds the rungs of a page; the first may go on from the page before.
pub(super) fn add(sheets: &mut Vec<Sheet>, page: &Page) {
    let (top, bottom) = frame(page);
    let mut rails: Vec<&Stroke> = page.strokes.iter().filter(|s| is_rail(s)).collect();
    rails.sort_by(|a, b| a.y0.total_cmp(&b.y0));
    for rail in rails {
        let goes_on = rail.y0 < top && sheets.last().is_some_and(|s| near(s.height, rail.y1 - rail.y0));
        if !goes_on {
            sheets.push(Sheet {
                left: rail.x0,
                right: right_rail(page, rail),
                height: rail.y1 - rail.y0,
                strokes: Vec::new(),
                fills: Vec::new(),
                texts: Vec::new(),
            });
        }
        if let Some(sheet) = sheets.last_mut() {
            take(sheet, page, rail, (top, bottom));
        }
    }
}

/// Heights of the two black lines between which a page's content lies.
fn frame(page: &Page) -> (f64, f64) {
    let lines = page.strokes.iter().filter(|s| s.colour == Colour::Black && near(s.y0, s.y1));
    lines.fold((f64::INFINITY, f64::NEG_INFINITY), |(top, bottom), s| (top.min(s.y0), bottom.max(s.y0)))
}

fn is_rail(s: &Stroke) -> bool {
    s.colour == Colour::Blue && near(s.x0, LEFT_RAIL) && near(s.x1, LEFT_RAIL) && s.y1 - s.y0 > super::ROW
}

/// The right rail is the rightmost vertical as high as the left one.
fn right_rail(page: &Page, rail: &Stroke) -> f64 {
    let twins = page.strokes.iter().filter(|s| near(s.x0, s.x1) && near(s.y0, rail.y0) && near(s.y1, rail.y1));
    twins.map(|s| s.x0).fold(rail.x0, f64::max)
}

/// Adds a stroke. The vertical of a branch is drawn on every page that it crosses, on
/// some cut off at the paper's edge: pieces that overlap become one line again.
fn put(strokes: &mut Vec<Stroke>, mut new: Stroke) {
    let twin = |s: &Stroke| near(s.x0, s.x1) && near(s.x0, new.x0) && near(s.x1, new.x1);
    if near(new.x0, new.x1) {
        let overlaps: Vec<usize> = strokes
            .iter()
            .enumerate()
            .filter(|(_, s)| twin(s) && s.y0 < new.y1 && new.y0 < s.y1)
            .map(|(at, _)| at)
            .collect();
        for at in overlaps.into_iter().rev() {
            let old = strokes.swap_remove(at);
            (new.y0, new.y1) = (new.y0.min(old.y0), new.y1.max(old.y1));
        }
    } else if strokes.contains(&new) {
        return;
    }
    strokes.push(new);
}

fn take(sheet: &mut Sheet, page: &Page, rail: &Stroke, (top, bottom): (f64, f64)) {
    let up = rail.y0;
    let beside = |y0: f64, y1: f64| y0 > rail.y0 - 0.1 && y1 < rail.y1 + 0.1;
    for s in page.strokes.iter().filter(|s| s.colour == Colour::Blue) {
        let (low, high) = (s.y0.min(s.y1), s.y0.max(s.y1));
        let moved = Stroke { y0: s.y0 - up, y1: s.y1 - up, ..*s };
        if beside(low, high) && high > top && low < bottom {
            put(&mut sheet.strokes, moved);
        }
    }
    for f in page.fills.iter().filter(|f| f.colour != Colour::White) {
        if beside(f.y0, f.y1) {
            sheet.fills.push(Fill { y0: f.y0 - up, y1: f.y1 - up, ..*f });
        }
    }
    for t in page.texts.iter().filter(|t| t.y > top && t.y < bottom && t.y > rail.y0 && t.y < rail.y1) {
        sheet.texts.push(Text { y: t.y - up, ..t.clone() });
    }
}
