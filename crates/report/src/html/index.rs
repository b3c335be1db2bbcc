//! The page that lists the pages of several projects.

use std::io::{self, Write};

use super::{bar, escape, foot, head};
use crate::page::relative;

/// A project in the list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Page {
    /// The name of its page, a file beside the list; characters that need it are made harmless here. Empty: the
    /// project could not be read.
    pub href: String,
    /// Name of the project, with its folder.
    pub name: String,
    /// Processor in words.
    pub processor: String,
    /// Ladder files or code blocks.
    pub files: usize,
    /// Rungs in them.
    pub rungs: usize,
    /// Time of the last save, or empty.
    pub saved_at: String,
    /// SHA-256 of the file.
    pub sha256: String,
    /// What a reader must know: why it could not be read, or what deviates.
    pub remark: String,
}

/// Writes the list.
///
/// # Errors
/// What writing gives.
pub fn index(title: &str, tool: &str, pages: &[Page], out: &mut dyn Write) -> io::Result<()> {
    head(title, "", out)?;
    bar(title, out)?;
    write!(
        out,
        "<div>\n<main id=content tabindex=-1>\n<h1 class=title>{}</h1>\n<p class=made>{}\n\
         <section id=projects data-short=Projects>\n<details open><summary><h2>Projects ({})</h2></summary>\n\
         <div class=wide><table><thead><tr><th>Project<th>Processor<th class=n>Files<th class=n>Rungs<th>Saved at\
         <th>Remark<th class=f>SHA-256<tbody>\n",
        escape(title),
        escape(tool),
        pages.len()
    )?;
    for page in pages {
        out.write_all(b"<tr><td>")?;
        if page.href.is_empty() {
            write!(out, "{}", escape(&page.name))?;
        } else {
            write!(out, "<a href=\"{}\">{}</a>", relative(&page.href), escape(&page.name))?;
        }
        let number = |number: usize| if page.href.is_empty() { String::new() } else { number.to_string() };
        writeln!(
            out,
            "<td>{}<td class=n>{}<td class=n>{}<td>{}<td>{}<td class=f>{}",
            escape(&page.processor),
            number(page.files),
            number(page.rungs),
            escape(&page.saved_at),
            escape(&page.remark),
            escape(page.sha256.get(..16).unwrap_or(&page.sha256))
        )?;
    }
    out.write_all(b"</table></div></details></section>\n")?;
    foot(out)
}
