//! Pages of a PDF as plain marks: strokes, filled rectangles and texts with their places.

use super::content;
use super::font::{Font, told};
use lopdf::{Document, Object};
use std::collections::{BTreeMap, BTreeSet};

/// Colour of a mark, as far as the reports tell things by colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colour {
    /// Values, addresses, page frame.
    Black,
    /// Wires, mnemonics, labels.
    Blue,
    /// Behind a symbol, a page title, or a true instruction.
    Green,
    /// Behind a rung comment.
    Yellow,
    /// Behind a description.
    PaleYellow,
    /// Paper.
    White,
    /// Anything else.
    Other,
}

impl Colour {
    /// From red, green and blue parts between 0 and 1.
    pub(super) fn new([r, g, b]: [f64; 3]) -> Self {
        let is = |value: f64, wanted: f64| (value - wanted).abs() < 0.02;
        match (is(r, 1.0), is(r, 0.0), is(g, 1.0), is(g, 0.0), is(b, 1.0), is(b, 0.0)) {
            (_, true, _, true, _, true) => Self::Black,
            (_, true, _, true, true, _) => Self::Blue,
            (_, true, true, _, _, true) => Self::Green,
            (true, _, true, _, true, _) => Self::White,
            (true, _, true, _, _, true) => Self::Yellow,
            (true, _, true, _, _, _) if is(b, 0.5) => Self::PaleYellow,
            _ => Self::Other,
        }
    }
}

/// A drawn line segment; `x0 <= x1`, and `y0 <= y1` where it is vertical.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Left end.
    pub x0: f64,
    /// Height of the left end, or upper end.
    pub y0: f64,
    /// Right end.
    pub x1: f64,
    /// Height of the right end, or lower end.
    pub y1: f64,
    /// Line colour.
    pub colour: Colour,
}

/// A filled rectangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fill {
    /// Left edge.
    pub x0: f64,
    /// Upper edge.
    pub y0: f64,
    /// Right edge.
    pub x1: f64,
    /// Lower edge.
    pub y1: f64,
    /// Colour.
    pub colour: Colour,
}

/// A text drawn in one go.
#[derive(Debug, Clone, PartialEq)]
pub struct Text {
    /// Left end.
    pub x0: f64,
    /// Right end.
    pub x1: f64,
    /// Middle of the row that the text stands in.
    pub y: f64,
    /// The characters.
    pub text: String,
    /// Colour.
    pub colour: Colour,
}

/// A page of marks in drawing order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Page {
    /// Line segments.
    pub strokes: Vec<Stroke>,
    /// Filled rectangles.
    pub fills: Vec<Fill>,
    /// Texts.
    pub texts: Vec<Text>,
    /// Operators left out because no ladder page needs them (images of the cover, other fonts).
    pub skipped: BTreeSet<String>,
}

/// Reads all pages of a PDF.
///
/// # Errors
/// When the bytes are no PDF, or a drawing cannot be decoded.
pub fn pages(pdf: &[u8]) -> Result<Vec<Page>, String> {
    let pdf = Document::load_mem(pdf).map_err(told)?;
    pdf.get_pages().values().map(|&id| read(&pdf, id)).collect()
}

fn read(pdf: &Document, id: lopdf::ObjectId) -> Result<Page, String> {
    let mut fonts = BTreeMap::new();
    for (name, font) in pdf.get_page_fonts(id).map_err(told)? {
        // A font of another kind is only an error where a text uses it.
        if let Ok(font) = Font::read(pdf, font) {
            fonts.insert(name, font);
        }
    }
    let bytes = pdf.get_page_content(id);
    content::run(&bytes, &fonts, height(pdf, id)?)
}

/// Height of the page in points, from its media box.
fn height(pdf: &Document, id: lopdf::ObjectId) -> Result<f64, String> {
    let page = pdf.get_dictionary(id).map_err(told)?;
    let area = page.get_deref(b"MediaBox", pdf).and_then(Object::as_array).map_err(told)?;
    let top = area.get(3).ok_or("a media box of fewer than four numbers")?;
    top.as_float().map(f64::from).map_err(told)
}
