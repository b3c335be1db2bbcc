//! Reads PDF books that rungs wrote, with a library that had no part in writing them: where each text
//! stands and how wide it is, links, bookmarks.

use std::collections::BTreeMap;

use lopdf::content::Content;
use lopdf::{Dictionary, Document, Object, ObjectId};

/// A text on a page.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// Characters.
    pub text: String,
    /// Left end in points.
    pub left: f32,
    /// Right end in points.
    pub right: f32,
    /// Line its letters stand on, in points from the bottom.
    pub line: f32,
    /// Size in points.
    pub size: f32,
}

/// A link.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Left, bottom, right, top in points.
    pub area: [f32; 4],
    /// Index of the page it leads to.
    pub page: usize,
    /// Points from the bottom of that page.
    pub top: f32,
}

/// A page.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// Points.
    pub width: f32,
    /// Points.
    pub height: f32,
    /// In the order they are painted.
    pub texts: Vec<Text>,
    /// Links.
    pub links: Vec<Link>,
}

/// A bookmark.
#[derive(Clone, Debug, PartialEq)]
pub struct Bookmark {
    /// 0 at the top.
    pub level: usize,
    /// What it says.
    pub title: String,
    /// Index of the page it leads to.
    pub page: usize,
}

/// A book.
#[derive(Clone, Debug, Default)]
pub struct Book {
    /// In order.
    pub pages: Vec<Page>,
    /// In order, each before those below it.
    pub bookmarks: Vec<Bookmark>,
    /// Title of the document.
    pub title: String,
}

/// A font: width of each code in thousandths.
type Widths = Vec<f32>;

impl Book {
    /// Reads a file.
    ///
    /// # Errors
    /// What is not as PDF demands, or as rungs writes it.
    pub fn read(bytes: &[u8]) -> Result<Book, String> {
        let pdf = Document::load_mem(bytes).map_err(told)?;
        let ids: Vec<ObjectId> = pdf.get_pages().into_values().collect();
        let index: BTreeMap<ObjectId, usize> = ids.iter().enumerate().map(|(at, id)| (*id, at)).collect();
        let mut book = Book::default();
        for id in &ids {
            book.pages.push(page(&pdf, *id, &index)?);
        }
        let catalog = pdf.catalog().map_err(told)?;
        if let Ok(outlines) = catalog.get(b"Outlines").and_then(Object::as_reference) {
            bookmarks(&pdf, outlines, 0, &index, &mut book.bookmarks)?;
        }
        let info = pdf.trailer.get(b"Info").and_then(Object::as_reference).map_err(told)?;
        book.title = text_string(pdf.get_dictionary(info).and_then(|info| info.get(b"Title")).map_err(told)?)?;
        Ok(book)
    }
}

fn told(error: lopdf::Error) -> String {
    error.to_string()
}

/// The encoding, as Unicode's table of it gives it.
fn character(code: u8) -> Result<char, String> {
    const HIGH: &str = "€\0‚ƒ„…†‡ˆ‰Š‹Œ\0Ž\0\0‘’“”•–—˜™š›œ\0žŸ";
    match code {
        0x80..=0x9F => HIGH.chars().nth(usize::from(code - 0x80)).filter(|c| *c != '\0'),
        0x00..=0x1F | 0x7F => None,
        _ => Some(char::from(code)),
    }
    .ok_or_else(|| format!("code {code:#04x} has no character"))
}

fn page(pdf: &Document, id: ObjectId, index: &BTreeMap<ObjectId, usize>) -> Result<Page, String> {
    let dictionary = pdf.get_dictionary(id).map_err(told)?;
    let media = inherited(pdf, dictionary, b"MediaBox")?.as_array().map_err(told)?;
    let number = |at: usize| media.get(at).ok_or("MediaBox")?.as_float().map_err(|_| "MediaBox");
    let mut page = Page { width: number(2)?, height: number(3)?, ..Page::default() };
    let fonts = inherited(pdf, dictionary, b"Resources")?.as_dict().and_then(|it| it.get(b"Font")).map_err(told)?;
    let mut widths: BTreeMap<Vec<u8>, Widths> = BTreeMap::new();
    for (name, font) in fonts.as_dict().map_err(told)?.iter() {
        widths.insert(name.clone(), font_widths(pdf, font)?);
    }
    let content = Content::decode(&pdf.get_page_content(id)).map_err(told)?;
    page.texts = texts(&content, &widths)?;
    if let Ok(annotations) = dictionary.get(b"Annots").and_then(Object::as_array) {
        for annotation in annotations {
            page.links.push(link(annotation.as_dict().map_err(told)?, index)?);
        }
    }
    Ok(page)
}

fn inherited<'a>(pdf: &'a Document, dictionary: &'a Dictionary, key: &[u8]) -> Result<&'a Object, String> {
    let mut node = dictionary;
    for _ in 0..16 {
        if let Ok(found) = node.get(key) {
            return Ok(found);
        }
        let parent = node.get(b"Parent").and_then(Object::as_reference).map_err(told)?;
        node = pdf.get_dictionary(parent).map_err(told)?;
    }
    Err("page tree too deep".to_owned())
}

fn font_widths(pdf: &Document, font: &Object) -> Result<Widths, String> {
    let font = pdf.get_dictionary(font.as_reference().map_err(told)?).map_err(told)?;
    let encoding = font.get(b"Encoding").and_then(Object::as_name).map_err(told)?;
    if encoding != b"WinAnsiEncoding" {
        return Err("a font with another encoding".to_owned());
    }
    let first = font.get(b"FirstChar").and_then(Object::as_i64).map_err(told)?;
    let mut widths = vec![0.0; usize::try_from(first).map_err(|_| "FirstChar")?];
    for width in font.get(b"Widths").and_then(Object::as_array).map_err(told)? {
        widths.push(width.as_float().map_err(told)?);
    }
    Ok(widths)
}

fn texts(content: &Content, fonts: &BTreeMap<Vec<u8>, Widths>) -> Result<Vec<Text>, String> {
    let mut texts = Vec::new();
    let (mut font, mut size, mut scaling, mut at) = (None, 0.0, 1.0, None);
    for operation in &content.operations {
        let number = |at: usize| {
            operation.operands.get(at).ok_or("an operand")?.as_float().map_err(|_| "an operand that is a number")
        };
        match operation.operator.as_str() {
            "Tf" => {
                let name = operation.operands.first().ok_or("Tf")?.as_name().map_err(told)?;
                font = Some(fonts.get(name).ok_or("a font that is not there")?);
                size = number(1)?;
            }
            "Tz" => scaling = number(0)? / 100.0,
            "BT" => at = None,
            "Td" => at = Some((number(0)?, number(1)?)),
            "Tj" => {
                let codes = operation.operands.first().ok_or("Tj")?.as_str().map_err(told)?;
                let (font, (left, line)) = (font.ok_or("a text without font")?, at.ok_or("a text nowhere")?);
                let width: f32 = codes.iter().map(|code| font.get(usize::from(*code)).copied().unwrap_or(0.0)).sum();
                let text = codes.iter().map(|code| character(*code)).collect::<Result<String, _>>()?;
                texts.push(Text { text, left, right: left + width * size * scaling / 1000.0, line, size });
            }
            _ => {}
        }
    }
    Ok(texts)
}

/// Page and height a destination `[page /XYZ x y zoom]` leads to.
fn destination(object: &Object, index: &BTreeMap<ObjectId, usize>) -> Result<(usize, f32), String> {
    let [page, kind, _, top, _] = object.as_array().map_err(told)?.as_slice() else {
        return Err("a destination of another form".to_owned());
    };
    if kind.as_name().map_err(told)? != b"XYZ" {
        return Err("a destination of another form".to_owned());
    }
    let page = index.get(&page.as_reference().map_err(told)?).ok_or("a destination outside the pages")?;
    Ok((*page, top.as_float().map_err(told)?))
}

fn link(annotation: &Dictionary, index: &BTreeMap<ObjectId, usize>) -> Result<Link, String> {
    let mut area = [0.0; 4];
    for (side, value) in area.iter_mut().zip(annotation.get(b"Rect").and_then(Object::as_array).map_err(told)?) {
        *side = value.as_float().map_err(told)?;
    }
    let (page, top) = destination(annotation.get(b"Dest").map_err(told)?, index)?;
    Ok(Link { area, page, top })
}

fn bookmarks(
    pdf: &Document,
    parent: ObjectId,
    level: usize,
    index: &BTreeMap<ObjectId, usize>,
    out: &mut Vec<Bookmark>,
) -> Result<(), String> {
    if level > 8 {
        return Err("bookmarks too deep".to_owned());
    }
    let mut next = pdf.get_dictionary(parent).map_err(told)?.get(b"First").and_then(Object::as_reference).ok();
    while let Some(id) = next {
        let item = pdf.get_dictionary(id).map_err(told)?;
        if item.get(b"Parent").and_then(Object::as_reference).map_err(told)? != parent {
            return Err("a bookmark below another one than its parent".to_owned());
        }
        let title = text_string(item.get(b"Title").map_err(told)?)?;
        let (page, _) = destination(item.get(b"Dest").map_err(told)?, index)?;
        out.push(Bookmark { level, title, page });
        bookmarks(pdf, id, level + 1, index, out)?;
        next = item.get(b"Next").and_then(Object::as_reference).ok();
    }
    Ok(())
}

fn text_string(object: &Object) -> Result<String, String> {
    let bytes = object.as_str().map_err(told)?;
    match bytes {
        [0xFE, 0xFF, rest @ ..] => {
            let units: Vec<u16> =
                rest.chunks(2).map(|pair| pair.iter().fold(0, |all, b| all << 8 | u16::from(*b))).collect();
            String::from_utf16(&units).map_err(|error| error.to_string())
        }
        ascii => String::from_utf8(ascii.to_vec()).map_err(|error| error.to_string()),
    }
}
