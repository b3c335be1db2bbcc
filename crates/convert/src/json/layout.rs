//! The layout of a written document: one rung, value or symbol per line.
//!
//! Indented down to the items of the long lists and written in one line below that, a document is
//! easy to read, and a line-by-line difference of two saves shows whole rungs.

use std::io::{self, Write};

use serde_json::ser::Formatter;

/// Lists whose items take one line each, whatever is in them.
const LISTS: [&str; 12] = [
    "rungs",
    "values",
    "raw",
    "forces",
    "symbols",
    "instruction_comments",
    "detached_comments",
    "io",
    "settings",
    "revision_notes",
    "diagnostics",
    "instructions",
];

#[derive(Default)]
pub(super) struct Layout {
    /// Open brackets.
    depth: usize,
    /// Depth from which everything stays in one line: inside the items of a list.
    one_line: Option<usize>,
    /// The collection that ends next has something in it.
    filled: bool,
    /// The name being written, or written last.
    name: String,
    in_name: bool,
}

impl Layout {
    fn begin<W: Write + ?Sized>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.depth += 1;
        self.filled = false;
        writer.write_all(bracket)
    }

    fn end<W: Write + ?Sized>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        let lines = self.filled && self.has_lines();
        self.depth -= 1;
        self.filled = true;
        if self.one_line.is_some_and(|depth| depth > self.depth + 1) {
            self.one_line = None;
        }
        if lines {
            self.new_line(writer)?;
        }
        writer.write_all(bracket)
    }

    /// Items at this depth stand in lines of their own.
    fn has_lines(&self) -> bool {
        self.one_line.is_none_or(|depth| self.depth < depth)
    }

    fn new_line<W: Write + ?Sized>(&self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b"\n")?;
        (0..self.depth).try_for_each(|_| writer.write_all(b" "))
    }

    fn item<W: Write + ?Sized>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        if !first {
            writer.write_all(b",")?;
        }
        if self.has_lines() { self.new_line(writer) } else { Ok(()) }
    }
}

impl Formatter for Layout {
    fn begin_array<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        if self.one_line.is_none() && LISTS.contains(&self.name.as_str()) {
            self.one_line = Some(self.depth + 2);
        }
        self.begin(writer, b"[")
    }
    fn end_array<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.end(writer, b"]")
    }
    fn begin_array_value<W: Write + ?Sized>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.item(writer, first)
    }
    fn end_array_value<W: Write + ?Sized>(&mut self, _: &mut W) -> io::Result<()> {
        self.filled = true;
        Ok(())
    }
    fn begin_object<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.begin(writer, b"{")
    }
    fn end_object<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.end(writer, b"}")
    }
    fn begin_object_key<W: Write + ?Sized>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.name.clear();
        self.in_name = true;
        self.item(writer, first)
    }
    fn begin_object_value<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.in_name = false;
        writer.write_all(b":")
    }
    fn end_object_value<W: Write + ?Sized>(&mut self, _: &mut W) -> io::Result<()> {
        self.filled = true;
        Ok(())
    }
    fn write_string_fragment<W: Write + ?Sized>(&mut self, writer: &mut W, fragment: &str) -> io::Result<()> {
        if self.in_name {
            self.name.push_str(fragment);
        }
        writer.write_all(fragment.as_bytes())
    }
}
