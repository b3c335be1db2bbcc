//! Texts cut into lines of a width in points, with their links.

use render::pdf::{Font, printable};

use crate::anchor::Anchor;
use crate::model::Text;

/// Sums of widths differ in the last digits, by points.
const TOLERANCE: f32 = 0.05;

/// Part of a line that leads to one place, or to none.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece<'a> {
    /// Distance from the start of the line in points.
    pub x: f32,
    /// Characters the fonts have.
    pub text: String,
    /// Width in points.
    pub width: f32,
    /// Where it leads.
    pub link: Option<&'a Anchor>,
}

/// A line.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Line<'a> {
    /// Its pieces from left to right.
    pub pieces: Vec<Piece<'a>>,
    /// Width in points.
    pub width: f32,
}

/// A text cut into lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Lines<'a> {
    /// At least one.
    pub lines: Vec<Line<'a>>,
    /// Characters that stand spelled out.
    pub escaped: usize,
}

/// Cuts a text at its line ends, then between words, then anywhere, so that no line is wider than `room`
/// unless a single character is.
pub(super) fn lines<'a>(text: &'a Text, font: Font, size: f32, room: f32) -> Lines<'a> {
    let mut out = Lines::default();
    let mut cutter = Cutter { font, size, room, ..Cutter::default() };
    for run in &text.runs {
        let whole = run.text.replace("\r\n", "\n");
        for (index, part) in whole.split(['\n', '\r']).enumerate() {
            if index > 0 {
                cutter.end_line(&mut out.lines);
            }
            let (part, escaped) = printable(part);
            out.escaped += escaped;
            cutter.add(&part, run.link.as_ref(), &mut out.lines);
        }
    }
    cutter.end_line(&mut out.lines);
    out
}

/// As [`lines()`] for a text without links.
pub(super) fn plain_lines(text: &str, font: Font, size: f32, room: f32) -> Vec<String> {
    let text = Text::plain(text);
    let lines = lines(&text, font, size, room).lines;
    lines.into_iter().map(|line| line.pieces.into_iter().map(|piece| piece.text).collect()).collect()
}

/// How wide a text is when its lines are not cut.
pub(super) fn natural(text: &Text, font: Font, size: f32) -> f32 {
    let mut widest = 0.0_f32;
    let mut line = 0.0;
    for run in &text.runs {
        for (index, part) in run.text.split(['\n', '\r']).enumerate() {
            if index > 0 {
                widest = widest.max(line);
                line = 0.0;
            }
            line += font.width(&printable(part).0, size);
        }
    }
    widest.max(line)
}

/// The longest part of a text that should stay on one line.
pub(super) fn longest_word(text: &Text, font: Font, size: f32) -> f32 {
    let words = text.runs.iter().flat_map(|run| run.text.split(char::is_whitespace));
    words.map(|word| font.width(&printable(word).0, size)).fold(0.0, f32::max)
}

struct Cutter<'a> {
    font: Font,
    size: f32,
    room: f32,
    /// Characters of the line that is being filled, where each leads.
    open: Vec<(char, Option<&'a Anchor>)>,
    width: f32,
    /// Where a word begins that could go to the next line, and the width up to there.
    word: Option<(usize, f32)>,
}

impl Default for Cutter<'_> {
    fn default() -> Self {
        Cutter { font: Font::Sans, size: 0.0, room: 0.0, open: Vec::new(), width: 0.0, word: None }
    }
}

impl<'a> Cutter<'a> {
    fn add(&mut self, text: &str, link: Option<&'a Anchor>, out: &mut Vec<Line<'a>>) {
        for c in text.chars() {
            let advance = self.font.advance(c, self.size);
            if self.width + advance > self.room + TOLERANCE && c != ' ' && !self.open.is_empty() {
                self.cut(out);
            }
            self.open.push((c, link));
            self.width += advance;
            if c == ' ' && self.open.iter().any(|(c, _)| *c != ' ') {
                self.word = Some((self.open.len(), self.width));
            }
        }
    }

    /// Ends the line before the word that did not fit, or right here.
    fn cut(&mut self, out: &mut Vec<Line<'a>>) {
        let (at, width) = self.word.take().unwrap_or((self.open.len(), self.width));
        let rest = self.open.split_off(at.min(self.open.len()));
        let left = self.width - width;
        self.end_line(out);
        self.open = rest;
        self.width = left;
    }

    fn end_line(&mut self, out: &mut Vec<Line<'a>>) {
        let mut open = std::mem::take(&mut self.open);
        self.width = 0.0;
        self.word = None;
        let end = open.iter().rposition(|(c, _)| *c != ' ').map_or(0, |last| last + 1);
        open.truncate(end);
        let mut line = Line::default();
        for part in open.chunk_by(|(_, a), (_, b)| a == b) {
            let text: String = part.iter().map(|(c, _)| c).collect();
            let width = self.font.width(&text, self.size);
            let link = part.first().and_then(|(_, link)| *link);
            line.pieces.push(Piece { x: line.width, text, width, link });
            line.width += width;
        }
        out.push(line);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(text: &str, room: f32) -> Vec<String> {
        // At size 10 a character of Courier is 6 points wide.
        plain_lines(text, Font::Mono, 10.0, room)
    }

    #[test]
    fn lines_are_cut_between_words_and_nothing_is_lost() {
        assert_eq!(cut("one two three", 48.0), ["one two", "three"]);
        assert_eq!(cut("abcdefgh", 18.0), ["abc", "def", "gh"]);
        assert_eq!(cut("ab abcdefgh", 18.0), ["ab", "abc", "def", "gh"]);
        assert_eq!(cut("  indented text", 60.0), ["  indented", "text"]);
        assert_eq!(cut("a\r\nb\n\nc\rd", 60.0), ["a", "b", "", "c", "d"]);
        assert_eq!(cut("", 60.0), [""]);
        assert_eq!(cut("x\u{1B}[0m", 60.0), ["x\\x1B[0m"]);
        assert_eq!(cut("abc", 1.0), ["a", "b", "c"]);
        assert_eq!(cut(&"word ".repeat(200_000), 120.0).len(), 50_000);
    }

    #[test]
    fn links_stay_with_their_characters() {
        let text =
            Text::link("T4:0", Anchor::file(1)).and(Text::plain(" and ")).and(Text::link("N7:1", Anchor::file(2)));
        let lines = lines(&text, Font::Mono, 10.0, 54.0);
        let shown: Vec<Vec<_>> = lines
            .lines
            .iter()
            .map(|line| line.pieces.iter().map(|p| (p.x, p.text.as_str(), p.link.map(Anchor::as_str))).collect())
            .collect();
        assert_eq!(shown, [vec![(0.0, "T4:0", Some("f-1")), (24.0, " and", None)], vec![(0.0, "N7:1", Some("f-2"))]]);
        assert_eq!((natural(&text, Font::Mono, 10.0), longest_word(&text, Font::Mono, 10.0)), (78.0, 24.0));
    }
}
