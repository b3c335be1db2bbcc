//! Documentation, values and configuration of a page, compared word by word.

use std::io;

use analysis::diff::{Change, ValueChange};

use super::{Writer, sign};
use crate::diff::text::{Stretch, stretches};
use crate::page::escape;

/// Values of one range that are shown.
const MOST_VALUES: usize = 200;

impl Writer<'_, '_> {
    pub(super) fn changes(&mut self, changes: &[Change]) -> io::Result<()> {
        if changes.is_empty() {
            return Ok(());
        }
        self.out
            .write_all(b"<div class=wide><table class=texts><thead><tr><th>What<th>Name<th>Before<th>After<tbody>\n")?;
        for change in changes {
            let kind = change.kind();
            write!(
                self.out,
                "<tr class=\"change {}\"><td><b class=sign>{}</b> {}<td>{}",
                kind.as_str(),
                sign(kind),
                escape(change.what),
                escape(&change.name)
            )?;
            match (&change.old, &change.new) {
                (Some(old), Some(new)) => {
                    let all = stretches(old, new);
                    self.out.write_all(b"<td>")?;
                    self.marked(&all, true)?;
                    self.out.write_all(b"<td>")?;
                    self.marked(&all, false)?;
                }
                (old, new) => {
                    let text = |text: &Option<String>, tag: &str| match text.as_deref() {
                        None => String::new(),
                        Some("") => format!("<{tag}>(empty)</{tag}>"),
                        Some(text) => format!("<{tag}>{}</{tag}>", escape(text)),
                    };
                    write!(self.out, "<td>{}<td>{}", text(old, "del"), text(new, "ins"))?;
                }
            }
            self.out.write_all(b"\n")?;
        }
        self.out.write_all(b"</table></div>\n")
    }

    /// One side of two texts.
    fn marked(&mut self, all: &[Stretch<'_>], is_old: bool) -> io::Result<()> {
        // Neighbouring words in one mark.
        let mut open = false;
        let tag = if is_old { "del" } else { "ins" };
        for stretch in all {
            let (text, mark) = match (stretch, is_old) {
                (Stretch::Same(text), _) => (text, false),
                (Stretch::Old(text), true) | (Stretch::New(text), false) => (text, true),
                _ => continue,
            };
            if mark != open {
                write!(self.out, "<{}{tag}>", if mark { "" } else { "/" })?;
                open = mark;
            }
            write!(self.out, "{}", escape(text))?;
        }
        if open { write!(self.out, "</{tag}>") } else { Ok(()) }
    }

    pub(super) fn values(&mut self, values: &[ValueChange]) -> io::Result<()> {
        if values.is_empty() {
            return Ok(());
        }
        self.out.write_all(
            b"<div class=wide><table class=texts><thead><tr><th>File<th>Address<th class=n>Elements<th>Before<th>After<tbody>\n",
        )?;
        for found in values {
            let range = if found.first == found.last {
                found.first.clone()
            } else {
                format!("{} .. {}", found.first, found.last)
            };
            write!(
                self.out,
                "<tr class=\"change changed\"><td class=f>{}<td class=f>{}<td class=n>{}<td class=vals>",
                escape(&found.file),
                escape(&range),
                found.old.len()
            )?;
            self.list(&found.old, "del")?;
            self.out.write_all(b"<td class=vals>")?;
            self.list(&found.new, "ins")?;
            self.out.write_all(b"\n")?;
        }
        self.out.write_all(b"</table></div>\n")
    }

    fn list(&mut self, values: &[String], tag: &str) -> io::Result<()> {
        let shown: Vec<&str> = values.iter().take(MOST_VALUES).map(String::as_str).collect();
        write!(self.out, "<{tag}>{}</{tag}>", escape(&shown.join("  ")))?;
        if values.len() > MOST_VALUES {
            write!(self.out, " and {} more", values.len() - MOST_VALUES)?;
        }
        Ok(())
    }
}
