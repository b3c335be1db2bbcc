//! A rung of a comparison, drawn with what changed in it marked.

use std::io::{self, Write};

use analysis::diff::{Edit, EditKind, Word};
use render::svg::{self, Change, Mark};

use crate::Rung;
use crate::page::escape;

/// Columns of a drawing: two of them stand side by side on a common screen.
const WIDTH: usize = 84;

/// The style sheet of drawings.
pub(super) fn style() -> &'static str {
    svg::STYLE
}

/// One of two rungs: its instructions that differ.
#[derive(Clone, Debug, Default)]
pub(super) struct Half<'a> {
    marks: Vec<(u32, Change)>,
    words: &'a [Word],
}

impl<'a> Half<'a> {
    /// A rung in which nothing is marked.
    pub(super) fn plain() -> Half<'a> {
        Half::default()
    }

    pub(super) fn old(edits: &[Edit], words: &'a [Word]) -> Half<'a> {
        Half { marks: marks(edits, true), words }
    }

    pub(super) fn new(edits: &[Edit], words: &'a [Word]) -> Half<'a> {
        Half { marks: marks(edits, false), words }
    }
}

fn marks(edits: &[Edit], is_old: bool) -> Vec<(u32, Change)> {
    let mark = |edit: &Edit| {
        let mark = match edit.kind {
            EditKind::Inserted => Change::Inserted,
            EditKind::Deleted => Change::Deleted,
            _ => Change::Changed,
        };
        let number = if is_old { edit.old_instruction } else { edit.new_instruction };
        Some((number?, mark))
    };
    let mut all: Vec<(u32, Change)> = edits.iter().filter_map(mark).collect();
    all.dedup();
    all
}

/// Writes a rung.
pub(super) fn drawing(rung: &Rung<'_>, half: &Half<'_>, out: &mut dyn Write) -> io::Result<()> {
    // Values in force are told in their own section: they must not look like a change of the rung.
    let style = render::Style { values: false, ..render::Style::graphic(WIDTH) };
    let scene = rung.scene(&style);
    let mark = |index: usize| {
        let found = half.marks.iter().find(|(number, _)| usize::try_from(*number) == Ok(index));
        Mark { change: found.map(|(_, change)| *change), ..Mark::default() }
    };
    let label = format!("Rung {}", rung.label);
    let options = svg::Options { mark: &mark, label: &label, ..svg::Options::default() };
    writeln!(out, "<div class=draw>{}</div>", svg::drawing(&scene, &options))?;
    // A rung that stands in words has no instructions to mark.
    if !scene.instructions.is_empty() || !half.words.iter().any(|word| word.marked) {
        return Ok(());
    }
    out.write_all(b"<p class=line>")?;
    for (number, word) in half.words.iter().enumerate() {
        let space = if number > 0 { " " } else { "" };
        let text = escape(&word.text);
        if word.marked { write!(out, "{space}<mark>{text}</mark>")? } else { write!(out, "{space}{text}")? }
    }
    out.write_all(b"</p>\n")
}
