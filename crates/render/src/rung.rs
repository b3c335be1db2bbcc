//! A whole rung: number, edit marks, rails, title, comment and what stands between the rails.

use std::borrow::Cow;

use ladder::{ProgramFile, ProgramFileKind, Rung};

use crate::Style;
use crate::face::Source;
use crate::layout::{Drawing, LEFT, NotDrawn, Part, RIGHT, Way, is_drawable, measure, parts, place};
use crate::plain::words;
use crate::scene::{Item, Role, Scene, Shape};
use crate::text::{clean, width, wrap};

/// Lines of a comment that are drawn. On paper a page has some seventy.
const COMMENT_LINES: usize = 2000;

/// Columns of the widest rung number of a file, at least the four of paper.
fn number_columns(file: &ProgramFile) -> usize {
    file.rungs.len().saturating_sub(1).to_string().len().max(4)
}

/// A rung in a form that knows no dialect.
pub(crate) struct Diagram<'a> {
    /// At the left rail.
    pub number: String,
    /// Above the comment, centred.
    pub title: &'a str,
    /// Lines of the comment.
    pub comment: Vec<Cow<'a, str>>,
    /// Every row carries a mark.
    pub edited: bool,
    /// What stands between the rails; otherwise why it cannot be drawn.
    pub parts: Result<Vec<Part>, NotDrawn>,
    /// The rung in words, for when it cannot be drawn.
    pub words: &'a dyn Fn() -> String,
}

/// The scene of a rung of an RSLogix project.
pub(crate) fn scene(source: &Source<'_>, file: &ProgramFile, index: usize, rung: &Rung) -> Scene {
    let digits = number_columns(file);
    let comment = rung.comment.as_ref();
    let parts = if is_drawable(&rung.series) { parts(source, &rung.series, &mut 0, 0) } else { Err(NotDrawn::Size) };
    let diagram = Diagram {
        number: format!("{index:0digits$}"),
        title: comment.map_or("", |comment| comment.title.as_str()),
        comment: comment.map(|comment| comment.lines().map(Cow::Borrowed).collect()).unwrap_or_default(),
        edited: rung.edited,
        parts,
        words: &|| words(&rung.series),
    };
    compose(diagram, source.style)
}

/// The scene of a rung.
pub(crate) fn compose(diagram: Diagram<'_>, style: &Style) -> Scene {
    let columns = style.columns();
    let (left, right) = (diagram.number.len() + 2, columns - 1);
    let mut items = Vec::new();
    let mut top = 0;
    if style.comments {
        let room = right - left - 3;
        for line in wrap(&clean(diagram.title.trim()), room).iter().filter(|line| !line.is_empty()) {
            let x = left + 2 + (room - width(line).min(room)) / 2;
            items.push(Item::text(x, top, Role::Title, line.as_str()));
            top += 1;
        }
        for line in diagram.comment.iter().take(COMMENT_LINES) {
            for part in wrap(&clean(line), room) {
                items.push(Item::text(left + 2, top, Role::Comment, part));
                top += 1;
            }
        }
        let more = diagram.comment.len().saturating_sub(COMMENT_LINES);
        if more > 0 {
            items.push(Item::text(left + 2, top, Role::Note, format!("({more} more lines of this comment)")));
            top += 1;
        }
    }
    let room = right - left - 1;
    let mut drawing = Drawing::new(items);
    let (number_row, bottom) = match diagram.parts.and_then(|parts| measure(&parts, room, 0)) {
        Ok(series) => {
            let row = top + series.above;
            let bottom = row + series.below;
            drawing.items.push(Item::across(left, left + 1, row).on(LEFT));
            place(&mut drawing, series, Way { x: left + 1, y: row, room, enter: LEFT, leave: RIGHT });
            (row, bottom)
        }
        Err(reason) => (top, place_words(&mut drawing.items, reason, &(diagram.words)(), left, top, room)),
    };
    let height = bottom + 2;
    let Drawing { mut items, instructions, shorts, .. } = drawing;
    items.push(Item::text(0, number_row, Role::RungNumber, diagram.number.as_str()));
    for x in [left, right] {
        items.push(Item::new(x, 0, Shape::Rail));
    }
    if diagram.edited {
        // On paper every row of an edited rung is marked.
        items.extend((0..height - 1).map(|row| Item::text(left - 1, row, Role::EditMark, "e")));
    }
    Scene { width: columns, height, items, instructions, shorts, number: diagram.number }
}

/// The rung in words between the rails; returns its last row.
fn place_words(items: &mut Vec<Item>, reason: NotDrawn, text: &str, left: usize, top: usize, room: usize) -> usize {
    let remark = match reason {
        NotDrawn::Depth => "branches nested too deep to draw; the rung in words:".into(),
        NotDrawn::Size => "more elements than a drawing can show; the rung in words:".into(),
        NotDrawn::Width => "too many nested branches for this width; the rung in words:".into(),
        NotDrawn::Form(why) => format!("not drawn, because {why}; the rung in words:"),
    };
    let mut row = top;
    for line in wrap(&remark, room - 2) {
        items.push(Item::text(left + 2, row, Role::Note, line));
        row += 1;
    }
    for line in wrap(text, room - 2) {
        items.push(Item::text(left + 2, row, Role::Operand, line));
        row += 1;
    }
    row - 1
}

/// What a program file is, on one line.
pub(crate) fn title(file: &ProgramFile) -> String {
    let kind = match file.kind {
        ProgramFileKind::Ladder => "LAD",
        other => other.as_str(),
    };
    let mut text = format!("{kind} {} - {}", file.number, clean(file.name.trim()));
    if !file.description.trim().is_empty() {
        text = format!("{text} - {}", clean(file.description.trim()));
    }
    format!("{text} --- Total Rungs in File = {}", file.rungs.len())
}

/// A clean text in the middle, and a line below it.
pub(crate) fn head(text: &str, style: &Style) -> String {
    let columns = style.columns();
    let mut out = String::new();
    for line in wrap(text, columns) {
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
