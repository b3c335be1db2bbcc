//! A whole rung: number, edit marks, rails, title, comment and what stands between the rails.

use ladder::{ProgramFile, ProgramFileKind, Rung};

use crate::Style;
use crate::face::Source;
use crate::layout::{NotDrawn, is_drawable, measure, place};
use crate::plain::words;
use crate::scene::{Item, Role, Scene, Shape};
use crate::text::{clean, width, wrap};

/// Lines of a comment that are drawn. On paper a page has some seventy.
const COMMENT_LINES: usize = 2000;

/// Columns of the widest rung number of a file, at least the four of paper.
fn number_columns(file: &ProgramFile) -> usize {
    file.rungs.len().saturating_sub(1).to_string().len().max(4)
}

/// The scene of a rung.
pub(crate) fn compose(source: &Source<'_>, file: &ProgramFile, index: usize, rung: &Rung) -> Scene {
    let columns = source.style.columns();
    let digits = number_columns(file);
    let (left, right) = (digits + 2, columns - 1);
    let mut items = Vec::new();
    let mut top = 0;
    if let Some(comment) = rung.comment.as_ref().filter(|_| source.style.comments) {
        let room = right - left - 3;
        for line in wrap(&clean(comment.title.trim()), room).iter().filter(|line| !line.is_empty()) {
            let x = left + 2 + (room - width(line).min(room)) / 2;
            items.push(Item::text(x, top, Role::Title, line.as_str()));
            top += 1;
        }
        let mut lines = comment.lines();
        for line in lines.by_ref().take(COMMENT_LINES) {
            for part in wrap(&clean(line), room) {
                items.push(Item::text(left + 2, top, Role::Comment, part));
                top += 1;
            }
        }
        let more = lines.count();
        if more > 0 {
            items.push(Item::text(left + 2, top, Role::Note, format!("({more} more lines of this comment)")));
            top += 1;
        }
    }
    let room = right - left - 1;
    let measured = if is_drawable(&rung.series) { measure(source, &rung.series, room, 0) } else { Err(NotDrawn::Size) };
    let (number_row, bottom) = match measured {
        Ok(series) => {
            let row = top + series.above;
            let bottom = row + series.below;
            items.push(Item::across(left, left + 1, row));
            place(&mut items, series, left + 1, row, room);
            (row, bottom)
        }
        Err(reason) => {
            let text = words(&rung.series);
            (top, place_words(&mut items, reason, &text, left, top, room))
        }
    };
    let height = bottom + 2;
    items.push(Item::text(0, number_row, Role::RungNumber, format!("{index:0digits$}")));
    for x in [left, right] {
        items.push(Item { x, y: 0, shape: Shape::Rail });
    }
    if rung.edited {
        // On paper every row of an edited rung is marked.
        items.extend((0..height - 1).map(|row| Item::text(left - 1, row, Role::EditMark, "e")));
    }
    Scene { width: columns, height, items }
}

/// The rung in words between the rails; returns its last row.
fn place_words(items: &mut Vec<Item>, reason: NotDrawn, text: &str, left: usize, top: usize, room: usize) -> usize {
    let remark = match reason {
        NotDrawn::Depth => "branches nested too deep to draw; the rung in words:",
        NotDrawn::Size => "more elements than a drawing can show; the rung in words:",
        NotDrawn::Width => "too many nested branches for this width; the rung in words:",
    };
    let mut row = top;
    for line in wrap(remark, room - 2) {
        items.push(Item::text(left + 2, row, Role::Note, line));
        row += 1;
    }
    for line in wrap(text, room - 2) {
        items.push(Item::text(left + 2, row, Role::Operand, line));
        row += 1;
    }
    row - 1
}

/// The head of a program file.
pub(crate) fn header(file: &ProgramFile, style: &Style) -> String {
    let columns = style.columns();
    let kind = match file.kind {
        ProgramFileKind::Ladder => "LAD",
        other => other.as_str(),
    };
    let mut text = format!("{kind} {} - {}", file.number, clean(file.name.trim()));
    if !file.description.trim().is_empty() {
        text = format!("{text} - {}", clean(file.description.trim()));
    }
    let text = format!("{text} --- Total Rungs in File = {}", file.rungs.len());
    let mut out = String::new();
    for line in wrap(&text, columns) {
        let indent = columns.saturating_sub(width(&line)) / 2;
        out.extend(std::iter::repeat_n(' ', indent));
        out.push_str(&line);
        out.push('\n');
    }
    let line = if style.ascii { '-' } else { '─' };
    out.extend(std::iter::repeat_n(line, columns));
    out.push('\n');
    out
}
