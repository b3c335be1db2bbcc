//! The objects of a PDF file: page tree, fonts, contents, links, bookmarks.

use std::collections::HashMap;
use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{AnnotationType, PageMode};
use pdf_writer::{Filter, Finish, Name, Pdf, Rect, Ref, Settings, TextStr};
use render::pdf::{Area, Font, Link};

use super::book::{Book, Entry, Place, Sheet};
use super::contents::{bookmark, front, place_name};
use super::{Format, Pdf as Finished};

/// Pages in one node of the page tree.
const NODE: usize = 64;
/// Of compression: the highest saves a tenth more and takes three times as long.
const LEVEL: u32 = 6;

/// Numbers of objects, in the order they are given out.
struct Objects(i32);

impl Objects {
    fn next(&mut self) -> Ref {
        self.0 += 1;
        Ref::new(self.0)
    }
}

/// Writes a book whose pages are painted: puts its first pages before them, then heads and feet on all.
pub(super) fn write(book: Book<'_>, format: Format) -> Finished {
    let mut front = front(&book, format);
    let before = front.pages.len();
    let Book { document, sheet, pages, places, entries, escaped, .. } = book;
    front.escaped += escaped;
    front.pages.extend(pages);
    front.heads_and_feet();
    let escaped = front.escaped;

    let mut objects = Objects(0);
    let (catalog, tree, info, outline) = (objects.next(), objects.next(), objects.next(), objects.next());
    let fonts = Font::ALL.map(|font| (font, objects.next(), objects.next()));
    let pages: Vec<(Ref, Ref)> = front.pages.iter().map(|_| (objects.next(), objects.next())).collect();
    let shifted = |place: Place| Place { page: place.page + before, ..place };
    let mut all: HashMap<String, Place> = places.into_iter().map(|(name, place)| (name, shifted(place))).collect();
    all.extend(entries.iter().enumerate().map(|(index, entry)| (place_name(index), shifted(entry.place))));
    let to = |place: Place| pages.get(place.page).map(|(page, _)| (*page, sheet.paper.1 - (place.y - 4.0).max(0.0)));

    let mut pdf = Pdf::with_settings(Settings { pretty: false });
    pdf.catalog(catalog)
        .pages(tree)
        .outlines(outline)
        .page_mode(PageMode::UseOutlines)
        .lang(TextStr("en"))
        .viewer_preferences()
        .display_doc_title(true);
    let title = bookmark(&document.title);
    pdf.document_info(info).title(TextStr(&title)).creator(TextStr(&document.tool)).producer(TextStr(&document.tool));
    for (font, id, descriptor) in fonts {
        font.write(&mut pdf, id, descriptor);
    }
    let nodes: Vec<Ref> = pages.chunks(NODE).map(|_| objects.next()).collect();
    pdf.pages(tree).kids(nodes.iter().copied()).count(count(pages.len()));
    for (node, kids) in nodes.iter().zip(pages.chunks(NODE)) {
        let mut node = pdf.pages(*node);
        node.parent(tree).kids(kids.iter().map(|(page, _)| *page)).count(count(kids.len()));
        node.media_box(Rect::new(0.0, 0.0, sheet.paper.0, sheet.paper.1));
        let mut resources = node.resources();
        let mut dictionary = resources.fonts();
        for (font, id, _) in fonts {
            dictionary.pair(Name(font.resource().as_bytes()), id);
        }
    }
    let mut spelled_out = escaped;
    let parents = nodes.iter().flat_map(|node| std::iter::repeat_n(*node, NODE));
    for ((page, (id, contents)), parent) in front.pages.into_iter().zip(&pages).zip(parents) {
        let painted = page.canvas.finish();
        spelled_out += painted.escaped;
        let bytes = compress(&painted.content);
        pdf.stream(*contents, &bytes).filter(Filter::FlateDecode);
        let mut object = pdf.page(*id);
        object.parent(parent).contents(*contents);
        let links: Vec<_> =
            painted.links.iter().filter_map(|link| Some((link, to(*all.get(&link.target)?)?))).collect();
        if !links.is_empty() {
            let mut annotations = object.insert(Name(b"Annots")).array();
            for (link, target) in links {
                annotate(&mut annotations.push().start(), link, &sheet, target);
            }
        }
        object.finish();
    }
    outlines(&mut pdf, outline, &entries, &mut objects, |place| to(shifted(place)));
    Finished { bytes: pdf.finish(), pages: pages.len(), escaped: spelled_out }
}

fn count(number: usize) -> i32 {
    i32::try_from(number).unwrap_or(i32::MAX)
}

fn compress(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::with_capacity(bytes.len() / 4), Compression::new(LEVEL));
    // Writing to memory cannot fail.
    let _ = encoder.write_all(bytes);
    encoder.finish().unwrap_or_default()
}

fn annotate(annotation: &mut pdf_writer::writers::Annotation<'_>, link: &Link, sheet: &Sheet, to: (Ref, f32)) {
    let Area { left, top, right, bottom } = link.area;
    let tenths = |value: f32| (value * 10.0).round() / 10.0;
    let y = |value: f32| tenths(sheet.paper.1 - value);
    annotation.subtype(AnnotationType::Link).rect(Rect::new(tenths(left), y(bottom), tenths(right), y(top)));
    annotation.border(0.0, 0.0, 0.0, None);
    let (page, top) = to;
    annotation.insert(Name(b"Dest")).start::<pdf_writer::writers::Destination<'_>>().page(page).xyz(
        0.0,
        tenths(top),
        None,
    );
}

/// Writes the bookmarks: chapters, their sections, rungs with titles, folded.
fn outlines(
    pdf: &mut Pdf,
    root: Ref,
    entries: &[Entry],
    objects: &mut Objects,
    to: impl Fn(Place) -> Option<(Ref, f32)>,
) {
    let ids: Vec<Ref> = entries.iter().map(|_| objects.next()).collect();
    // For each entry the index of the one it stands below; the entries below each, with the root last.
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); entries.len() + 1];
    let mut parents = Vec::with_capacity(entries.len());
    let mut path: Vec<usize> = Vec::new();
    for (index, entry) in entries.iter().enumerate() {
        while path.last().and_then(|last| entries.get(*last)).is_some_and(|last| last.level >= entry.level) {
            path.pop();
        }
        let parent = path.last().copied();
        parents.push(parent);
        if let Some(siblings) = children.get_mut(parent.unwrap_or(entries.len())) {
            siblings.push(index);
        }
        path.push(index);
    }
    let id = |index: usize| ids.get(index).copied();
    let of = |index: usize| children.get(index).map(Vec::as_slice).unwrap_or_default();
    let ends = |index: usize| Some((id(*of(index).first()?)?, id(*of(index).last()?)?));
    let mut outline = pdf.outline(root);
    if let Some((first, last)) = ends(entries.len()) {
        outline.first(first).last(last).count(count(of(entries.len()).len()));
    }
    outline.finish();
    for siblings in &children {
        for (at, index) in siblings.iter().enumerate() {
            let (Some(own), Some(entry)) = (id(*index), entries.get(*index)) else { continue };
            let title = bookmark(&entry.title);
            let mut item = pdf.outline_item(own);
            item.title(TextStr(&title));
            item.parent(parents.get(*index).copied().flatten().and_then(id).unwrap_or(root));
            if let Some(next) = siblings.get(at + 1).and_then(|next| id(*next)) {
                item.next(next);
            }
            if let Some(prev) = at.checked_sub(1).and_then(|at| siblings.get(at)).and_then(|prev| id(*prev)) {
                item.prev(prev);
            }
            if let Some((first, last)) = ends(*index) {
                // Negative: folded.
                item.first(first).last(last).count(-count(of(*index).len()));
            }
            if let Some((page, top)) = to(entry.place) {
                item.dest().page(page).xyz(0.0, top, None);
            }
        }
    }
}
