//! Tables of Do-more projects: documentation and cross reference. RFC 4180, UTF-8, a header row.

use std::io::{self, Write};

use ::csv::{Terminator, WriterBuilder};
use domore::Project;
use domore::xref::CrossReference;

/// Element, nickname, description (its lines each on a line of the cell), fourth column, flags.
///
/// # Errors
/// Only those of `writer`.
pub fn write_symbols(project: &Project, writer: impl Write) -> io::Result<()> {
    let mut table = WriterBuilder::new().terminator(Terminator::CRLF).from_writer(writer);
    table.write_record(["element", "nickname", "description", "extra", "flags"])?;
    for entry in project.documentation() {
        let description = entry.lines().join("\n");
        let flags = entry.flags.as_deref().unwrap_or("");
        table.write_record([&entry.element, &entry.nickname, description.as_str(), &entry.extra, flags])?;
    }
    table.flush()
}

/// Every access in the order of the program: where, which instruction, what it names and does.
///
/// # Errors
/// Only those of `writer`.
pub fn write_xref(xref: &CrossReference, writer: impl Write) -> io::Result<()> {
    let mut table = WriterBuilder::new().terminator(Terminator::CRLF).from_writer(writer);
    table.write_record(["address", "code_block", "rung", "mnemonic", "role", "certainty", "through"])?;
    for access in xref.accesses() {
        let rung = access.rung.to_string();
        let role = access.role.map_or("unknown", domore::instruction::Role::as_str);
        let certainty = if access.may { "may" } else { "definite" };
        let through = access.through.as_str();
        table.write_record([
            access.written.as_str(),
            &access.code_block,
            &rung,
            &access.mnemonic,
            role,
            certainty,
            through,
        ])?;
    }
    table.flush()
}
