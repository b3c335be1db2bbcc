//! A document as one HTML page that needs nothing beside it.
//!
//! Style and script stand in the page; its content security policy names their hashes and forbids
//! everything else, so that not even a mistake here could make a text of a project run. Without the
//! script all content is there, and folds and links work.

mod blocks;
mod index;
mod sizes;

use std::io::{self, Write};

use crate::model::{Document, Section};
use crate::options::Kind;
use crate::page;

use crate::page::escape;
pub use index::{Page, index};

const SCRIPT: &str = concat!(include_str!("../../assets/theme.js"), include_str!("../../assets/report.js"));

/// Writes a document as a page.
///
/// # Errors
/// What writing gives.
pub fn page(document: &Document<'_>, out: &mut dyn Write) -> io::Result<()> {
    // The style names the sizes of what follows it.
    let mut heights = sizes::Sizes::default();
    let mut body = Vec::new();
    for section in &document.sections {
        write_section(document, section, &mut heights, &mut body)?;
    }
    head(&document.title, &heights.rules(), out)?;
    bar(&document.title, out)?;
    out.write_all(b"<div class=frame>\n<nav aria-label=Contents>\n<ol>\n")?;
    for chapter in document.chapters() {
        contents(chapter, out)?;
    }
    out.write_all(b"</ol>\n</nav>\n<main id=content tabindex=-1>\n")?;
    write!(out, "<h1 class=title>{}</h1>\n<p class=made>{}", escape(&document.title), escape(&document.tool))?;
    if !document.date.is_empty() {
        write!(out, ", {}", escape(&document.date))?;
    }
    out.write_all(b"\n")?;
    for note in &document.notes {
        blocks::note(note, out)?;
    }
    out.write_all(&body)?;
    foot(out)
}

fn write_section(
    document: &Document<'_>,
    section: &Section<'_>,
    heights: &mut sizes::Sizes,
    out: &mut Vec<u8>,
) -> io::Result<()> {
    let mut body = Vec::new();
    let pixels = blocks::write(document, &section.blocks, heights, &mut body)?;
    writeln!(
        out,
        "<section id=\"{}\" data-kind={} data-short=\"{}\">\n<details open><summary><h2>{}</h2></summary>\n<div class=\"v {}\">",
        section.anchor,
        section.kind.name(),
        escape(&section.short),
        escape(&section.title),
        heights.class(pixels)
    )?;
    out.append(&mut body);
    out.write_all(b"</div></details>\n</section>\n")
}

/// The contents entry of sections of one kind.
fn contents(chapter: &[Section<'_>], out: &mut dyn Write) -> io::Result<()> {
    let entry = |section: &Section<'_>, out: &mut dyn Write| {
        writeln!(out, "<li><a href=\"#{}\">{}</a></li>", section.anchor, escape(&section.short))
    };
    let Some(first) = chapter.first() else { return Ok(()) };
    if !matches!(first.kind, Kind::Ladder | Kind::Data) {
        return chapter.iter().try_for_each(|section| entry(section, out));
    }
    // A long list must not hide what comes after it.
    let open = if first.kind == Kind::Ladder { " open" } else { "" };
    writeln!(out, "<li><details{open}><summary>{} ({})</summary>\n<ol>", first.kind.title(), chapter.len())?;
    chapter.iter().try_for_each(|section| entry(section, out))?;
    out.write_all(b"</ol></details></li>\n")
}

/// All before what can be seen; `rules` are added to the style of the page and its drawings.
fn head(title: &str, rules: &str, out: &mut dyn Write) -> io::Result<()> {
    page::head(title, &format!("{}\n{}\n{rules}", page::STYLE, render::svg::STYLE), SCRIPT, out)
}

/// The bar at the top: title, search, buttons.
fn bar(title: &str, out: &mut dyn Write) -> io::Result<()> {
    write!(
        out,
        "<a class=skip href=\"#content\">To the content</a>\n<header>\n<h1 title=\"{0}\">{0}</h1>\n\
         <div class=\"find script\" role=search><input id=search type=search autocomplete=off spellcheck=false \
         aria-label=Search aria-controls=found placeholder=\"Search addresses, symbols, comments ( / )\">\n\
         <div id=found hidden><p role=status></p><ol role=listbox aria-label=\"Found\"></ol></div></div>\n\
         <button class=script id=fold type=button title=\"Fold or unfold all (c)\">Fold</button>\n\
         <button class=script id=theme type=button title=\"Dark or light (t)\">Theme</button>\n\
         <button class=script id=keys type=button title=\"Keys (?)\" aria-label=Keys>?</button>\n</header>\n",
        escape(title)
    )
}

/// What stands below the content.
fn foot(out: &mut dyn Write) -> io::Result<()> {
    const KEYS: [(&str, &str); 7] = [
        ("/", "search addresses, symbols, descriptions, comments"),
        ("&uarr; &darr; Enter", "choose and follow what was found"),
        ("Esc", "close"),
        ("j k", "next and previous rung or section"),
        ("c", "fold or unfold all"),
        ("t", "dark or light"),
        ("?", "these keys"),
    ];
    out.write_all(b"</main>\n</div>\n<dialog id=help aria-label=Keys><h3>Keys</h3>\n<table>\n")?;
    for (key, what) in KEYS {
        writeln!(out, "<tr><td><kbd>{key}</kbd><td>{what}")?;
    }
    out.write_all(b"</table>\n<form method=dialog><button>Close</button></form></dialog>\n<script>")?;
    out.write_all(SCRIPT.as_bytes())?;
    out.write_all(b"</script>\n</body>\n</html>\n")
}
