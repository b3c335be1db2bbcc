//! Pages one after the other: where the next thing stands, and what each page is about.

use std::collections::HashMap;

use render::pdf::{Area, Canvas, Color, Font, Letters, printable};

use super::text::Line;
use super::{Format, Paper};
use crate::model::{Document, Section};

/// Text in tables and lists.
pub(super) const BODY: f32 = 8.0;
/// From one line of [`BODY`] to the next.
pub(super) const LEADING: f32 = 10.0;
/// What leads somewhere.
pub(super) const LINK: Color = Color(0.05, 0.2, 0.55);
/// Thin lines and areas that only guide the eye.
pub(super) const RULE: Color = Color(0.7, 0.7, 0.7);
pub(super) const SHADE: Color = Color(0.92, 0.92, 0.92);
/// What a person must not overlook.
pub(super) const ALARM: Color = Color(0.6, 0.05, 0.05);

/// Measures of a page in points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sheet {
    /// Of the paper.
    pub paper: (f32, f32),
}

/// Left and right of everything; enough for holes.
const SIDE: f32 = 38.0;
const TOP: f32 = 28.0;
const BOTTOM: f32 = 28.0;
/// Height of the head and the foot of a page, with the line between them and the rest.
const HEAD: f32 = 30.0;
const FOOT: f32 = 18.0;

impl Sheet {
    fn of(format: Format) -> Sheet {
        let (short, long) = match format.paper {
            Paper::A4 => (595.28, 841.89),
            Paper::Letter => (612.0, 792.0),
        };
        Sheet { paper: if format.landscape { (long, short) } else { (short, long) } }
    }

    pub(super) fn left(&self) -> f32 {
        SIDE
    }

    pub(super) fn right(&self) -> f32 {
        self.paper.0 - SIDE
    }

    pub(super) fn width(&self) -> f32 {
        self.right() - self.left()
    }

    pub(super) fn height(&self) -> f32 {
        self.bottom() - self.top()
    }

    pub(super) fn top(&self) -> f32 {
        TOP + HEAD
    }

    pub(super) fn bottom(&self) -> f32 {
        self.paper.1 - BOTTOM - FOOT
    }
}

/// A page.
pub(super) struct Page {
    pub canvas: Canvas,
    /// The section its first line belongs to.
    pub section: String,
}

/// A place in the book.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    /// Index of its page, in the pages it was made with.
    pub page: usize,
    /// Points from the upper side of the page.
    pub y: f32,
}

/// An entry of the list of contents and of the bookmarks.
pub(super) struct Entry {
    pub title: String,
    /// 0: a chapter; 1: a section of it; 2: a rung with a title, in bookmarks only.
    pub level: usize,
    pub place: Place,
}

/// A document on its way to pages.
pub(super) struct Book<'a> {
    pub document: &'a Document<'a>,
    pub sheet: Sheet,
    /// Rungs show what conducts.
    pub state: bool,
    pub pages: Vec<Page>,
    /// Where the next thing stands on the last page.
    pub y: f32,
    pub places: HashMap<String, Place>,
    pub entries: Vec<Entry>,
    /// Spelled out characters of texts that were cut into lines before they were painted.
    pub escaped: usize,
    section: String,
    strips: Strips,
}

/// Columns of text side by side, filled one after the other.
#[derive(Clone, Copy, Debug)]
struct Strips {
    count: usize,
    /// The one being filled.
    index: usize,
    /// Where they begin on this page.
    top: f32,
    /// Lower end of the fullest on this page.
    bottom: f32,
}

const WHOLE: Strips = Strips { count: 1, index: 0, top: 0.0, bottom: 0.0 };
/// Between strips.
const STRIP_GAP: f32 = 16.0;

impl<'a> Book<'a> {
    pub(super) fn new(document: &'a Document<'a>, format: Format) -> Book<'a> {
        Book {
            document,
            sheet: Sheet::of(format),
            state: format.state,
            pages: Vec::new(),
            y: f32::INFINITY,
            places: HashMap::new(),
            entries: Vec::new(),
            escaped: 0,
            section: String::new(),
            strips: WHOLE,
        }
    }

    /// Left side of what is painted next.
    pub(super) fn left(&self) -> f32 {
        self.sheet.left() + (self.room() + STRIP_GAP) * self.strips.index as f32
    }

    /// Right side of what is painted next.
    pub(super) fn right(&self) -> f32 {
        self.left() + self.room()
    }

    /// Width of what is painted next.
    pub(super) fn room(&self) -> f32 {
        self.room_of(self.strips.count)
    }

    /// Width of each of some strips side by side.
    pub(super) fn room_of(&self, strips: usize) -> f32 {
        let strips = strips.max(1) as f32;
        (self.sheet.width() - STRIP_GAP * (strips - 1.0)) / strips
    }

    /// Goes on in strips side by side.
    pub(super) fn begin_strips(&mut self, count: usize) {
        let top = self.here().y;
        self.strips = Strips { count, index: 0, top, bottom: top };
    }

    /// Goes on in the whole width, below the strips.
    pub(super) fn end_strips(&mut self) {
        self.y = self.y.max(self.strips.bottom);
        self.strips = WHOLE;
    }

    /// Goes to the next strip, or page.
    pub(super) fn advance(&mut self) {
        if self.strips.index + 1 < self.strips.count {
            self.strips.bottom = self.strips.bottom.max(self.y);
            self.strips.index += 1;
            self.y = self.strips.top;
            let (x, top, bottom) = (self.left() - STRIP_GAP / 2.0, self.strips.top, self.sheet.bottom());
            self.canvas().line(&[(x, top), (x, bottom)], 0.25, RULE);
        } else {
            self.new_page();
        }
    }

    /// The page being painted; the first one if there is none.
    pub(super) fn canvas(&mut self) -> &mut Canvas {
        if self.pages.is_empty() {
            self.new_page();
        }
        let last = self.pages.len() - 1;
        &mut self.pages[last].canvas
    }

    pub(super) fn new_page(&mut self) {
        self.pages.push(Page { canvas: Canvas::new(self.sheet.paper.1), section: self.section.clone() });
        self.y = self.sheet.top();
        self.strips = Strips { index: 0, top: self.y, bottom: self.y, ..self.strips };
    }

    /// Begins on a new page, outside the sections.
    pub(super) fn begin(&mut self, section: &str) {
        section.clone_into(&mut self.section);
        self.new_page();
    }

    /// Points left on the page.
    pub(super) fn left_over(&self) -> f32 {
        if self.pages.is_empty() { 0.0 } else { self.sheet.bottom() - self.y }
    }

    /// Goes to the next strip or page unless this many points are left.
    pub(super) fn need(&mut self, height: f32) {
        // Sums of heights differ in the last digits.
        if self.left_over() + 0.01 < height && (self.pages.is_empty() || self.y > self.sheet.top()) {
            self.advance();
        }
    }

    /// Space between two things; none at the top of a page.
    pub(super) fn space(&mut self, height: f32) {
        if !self.pages.is_empty() && self.y > self.sheet.top() {
            self.y += height;
        }
    }

    /// The place where the next thing stands.
    pub(super) fn here(&mut self) -> Place {
        if self.pages.is_empty() {
            self.new_page();
        }
        Place { page: self.pages.len() - 1, y: self.y }
    }

    /// Names the place where the next thing stands.
    pub(super) fn mark(&mut self, name: &str) {
        let place = self.here();
        self.places.entry(name.to_owned()).or_insert(place);
    }

    /// Begins a section. `part`: which one of its chapter it is, if that has several.
    pub(super) fn section(&mut self, section: &Section<'_>, part: Option<usize>) {
        self.section = section.title.clone();
        // Ladder begins on a page of its own, as on paper; elsewhere that would waste most of the paper.
        let drawn = section.kind == crate::options::Kind::Ladder;
        let wanted = if drawn { self.sheet.height() } else { self.sheet.height() / 5.0 };
        self.space(18.0);
        self.need(wanted);
        if self.left_over() > self.sheet.height() - 0.01
            && let Some(page) = self.pages.last_mut()
        {
            page.section.clone_from(&section.title);
        }
        let place = self.here();
        if part.is_none_or(|part| part == 0) {
            let title = if part.is_some() { section.kind.title() } else { &section.short };
            self.entries.push(Entry { title: title.to_owned(), level: 0, place });
        }
        if part.is_some() {
            self.entries.push(Entry { title: section.short.clone(), level: 1, place });
        }
        self.mark(section.anchor.as_str());
        self.title(&section.title, 11.0, true);
    }

    /// A title over the whole width; `ruled`: with a line below it.
    pub(super) fn title(&mut self, title: &str, size: f32, ruled: bool) {
        let (left, right, room) = (self.left(), self.right(), self.room());
        for line in super::text::plain_lines(title, Font::SansBold, size, room) {
            self.need(size * 1.3);
            let y = self.y + size;
            let letters = Letters { font: Font::SansBold, size, color: Color::BLACK };
            self.canvas().text(left, y, letters, &line);
            self.y += size * 1.3;
        }
        if ruled {
            let y = self.y + 1.0;
            self.canvas().line(&[(left, y), (right, y)], 0.8, Color::BLACK);
            self.y += 6.0;
        }
    }

    /// Paints a line from `x`, its letters standing on `y`, with its links; narrower where it is wider than
    /// `room`.
    pub(super) fn paint(&mut self, line: &Line<'_>, x: f32, y: f32, letters: Letters, room: f32) {
        let ratio = if line.width > room * 1.001 { room / line.width } else { 1.0 };
        for piece in &line.pieces {
            let (left, width) = (x + piece.x * ratio, piece.width * ratio);
            let color = if piece.link.is_some() { LINK } else { letters.color };
            let canvas = self.canvas();
            canvas.fitted(left, y, Letters { color, ..letters }, width, &piece.text);
            if let Some(link) = piece.link {
                let (top, bottom) = (y - letters.size, y + letters.size * 0.25);
                canvas.link(Area { left, top, right: left + width, bottom }, link.as_str());
            }
        }
    }

    /// Paints the head and the foot of every page.
    pub(super) fn heads_and_feet(&mut self) {
        let total = self.pages.len();
        let sheet = self.sheet;
        let (left, right, room) = (sheet.left(), sheet.right(), sheet.width());
        let small = Letters { font: Font::Sans, size: 7.5, color: Color(0.2, 0.2, 0.2) };
        let bold = Letters { font: Font::SansBold, size: 8.5, color: Color::BLACK };
        let Document { title, processor, tool, date, .. } = self.document;
        for (index, page) in self.pages.iter_mut().enumerate() {
            let canvas = &mut page.canvas;
            let top = TOP + 9.0;
            let (used, _) = canvas.fitted(left, top, bold, room * 0.6, title);
            let wanted = small.font.width(&printable(processor).0, small.size);
            let width = wanted.min(room - used - 12.0);
            canvas.fitted(right - width, top, small, width, processor);
            canvas.fitted(left, top + 11.0, small, room, &page.section);
            let line = TOP + HEAD - 7.0;
            canvas.line(&[(left, line), (right, line)], 0.5, RULE);
            let line = sheet.paper.1 - BOTTOM - FOOT + 7.0;
            canvas.line(&[(left, line), (right, line)], 0.5, RULE);
            let foot = line + 9.0;
            let number = format!("Page {} of {total}", index + 1);
            let width = small.font.width(&number, small.size);
            canvas.text(right - width, foot, small, &number);
            let mut words = tool.clone();
            if !date.is_empty() {
                words = if words.is_empty() { date.clone() } else { format!("{date}  -  {words}") };
            }
            canvas.fitted(left, foot, small, room - width - 12.0, &words);
        }
    }
}
