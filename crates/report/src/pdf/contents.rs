//! The first pages: what the document is, what a reader must know, and where everything stands.

use render::pdf::{Area, Color, Font, Letters};

use super::Format;
use super::book::{BODY, Book, Entry, LEADING, LINK};
use super::text::plain_lines;
use crate::model::{Note, NoteKind, Text};

const CHAPTER: Letters = Letters { font: Font::SansBold, size: 9.0, color: LINK };
const SECTION: Letters = Letters { font: Font::Sans, size: BODY, color: LINK };
const DOTS: Letters = Letters { font: Font::Sans, size: BODY, color: Color(0.5, 0.5, 0.5) };
const NUMBER: Letters = Letters { font: Font::Sans, size: BODY, color: Color::BLACK };
/// Room for a page number.
const NUMBERS: f32 = 32.0;

/// More entries than this stand side by side.
const MANY: usize = 40;

/// The name of the place of an entry. No anchor has a space.
pub(super) fn place_name(index: usize) -> String {
    format!("entry {index}")
}

/// The first pages of a book whose other pages are done.
pub(super) fn front<'a>(book: &Book<'a>, format: Format) -> Book<'a> {
    // How many pages it takes does not depend on the numbers in it.
    let pages = paint(book, format, 0).pages.len();
    paint(book, format, pages)
}

fn paint<'a>(book: &Book<'a>, format: Format, before: usize) -> Book<'a> {
    let document = book.document;
    let mut front = Book::new(document, format);
    front.begin("Contents");
    front.title(&document.title, 18.0, false);
    let made = [&document.processor, &document.date, &document.tool];
    for line in made.into_iter().filter(|text| !text.is_empty()) {
        let (left, y, room) = (front.left(), front.y + BODY, front.room());
        front.canvas().fitted(left, y, NUMBER, room, line);
        front.y += LEADING;
    }
    front.space(6.0);
    for note in &document.notes {
        front.note(note);
    }
    let escaped = book.escaped + book.pages.iter().map(|page| page.canvas.escaped()).sum::<usize>();
    if escaped > 0 {
        let what = if escaped == 1 { "1 character is".to_owned() } else { format!("{escaped} characters are") };
        let text = format!("{what} not in the fonts of this document and spelled out, as \\u{{2192}} or \\x1B.");
        front.note(&Note { kind: NoteKind::Warning, text: Text::plain(text) });
    }
    front.space(12.0);
    front.title("Contents", 11.0, true);
    let entries: Vec<_> = book.entries.iter().enumerate().filter(|(_, entry)| entry.level < 2).collect();
    front.begin_strips(if entries.len() > MANY { 2 } else { 1 });
    for (index, entry) in entries {
        front.entry(index, entry, before);
    }
    front.end_strips();
    front
}

impl Book<'_> {
    fn entry(&mut self, index: usize, entry: &Entry, before: usize) {
        let letters = if entry.level == 0 { CHAPTER } else { SECTION };
        if entry.level == 0 {
            self.space(3.0);
        }
        let indent = 14.0 * entry.level as f32;
        let room = self.room() - indent - NUMBERS - 10.0;
        let lines = plain_lines(&entry.title, letters.font, letters.size, room);
        let height = LEADING + 1.0;
        self.need(height * lines.len() as f32);
        let (left, right) = (self.left() + indent, self.right());
        let top = self.y;
        let mut end = left;
        for line in &lines {
            self.y += height;
            let y = self.y - 3.0;
            end = left + self.canvas().text(left, y, letters, line);
        }
        let y = self.y - 3.0;
        let number = (entry.place.page + before + 1).to_string();
        let at = right - NUMBER.font.width(&number, NUMBER.size);
        let dot = DOTS.font.width(" .", DOTS.size);
        let dots = ((at - 4.0 - end) / dot).max(0.0) as usize;
        let start = at - 4.0 - dot * dots as f32;
        self.canvas().text(start, y, DOTS, &" .".repeat(dots));
        self.canvas().text(at, y, NUMBER, &number);
        let bottom = self.y;
        self.canvas().link(Area { left, top, right, bottom }, &place_name(index));
    }
}

/// A text as a bookmark or title, which readers show in fonts of their own.
pub(super) fn bookmark(text: &str) -> String {
    render::clean(text.trim()).into_owned()
}
