//! Symbols and descriptions as a CSV table, for spreadsheets and for `rungs build`.
//!
//! RFC 4180: a header row, CR LF between rows, quotes where a cell needs them; UTF-8 without a byte
//! order mark. Columns:
//!
//! | column | content |
//! |---|---|
//! | `address` | `T4:0/DN`, `U:5` (a program file as operand), `Q51:1` (a label), `program file 2`, `data file 7`; empty for a symbol without an address |
//! | `symbol` | the symbol |
//! | `description` | the lines, each on a line of the cell |
//! | `kind` | what the row documents: `address`, `program_file_operand`, `label`, `program_file`, `data_file`, `unassigned`, `other` as in a JSON project, or `instruction_comment` |
//! | `mnemonic` | the instruction an instruction comment is for |
//!
//! Cells hold the text exactly as the project has it. A spreadsheet program takes a cell that begins
//! with `=`, `+`, `-` or `@` for a formula: import the columns of a table from a stranger as text.

use std::fmt;
use std::io::{self, Write};

use ::csv::{ReaderBuilder, StringRecord, Terminator, WriterBuilder};
use ladder::{AddressEntry, Documentation, Image, InstructionComment, Target};

use crate::json::target::{kind_of, target_from};

const ADDRESS: &str = "address";
const SYMBOL: &str = "symbol";
const DESCRIPTION: &str = "description";
const KIND: &str = "kind";
const MNEMONIC: &str = "mnemonic";
const COLUMNS: [&str; 5] = [ADDRESS, SYMBOL, DESCRIPTION, KIND, MNEMONIC];

/// The kind of a row that describes an address under one instruction.
const INSTRUCTION_COMMENT: &str = "instruction_comment";

/// Largest table that [`read_symbols`] is meant for: ten times that of the largest known program.
pub const MAX_BYTES: usize = 8 << 20;

/// Why a table cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CsvError {
    /// Line in the text, from 1.
    pub line: u64,
    /// Column name; empty where the whole row is meant.
    pub column: &'static str,
    /// What belongs there.
    pub expected: String,
    /// What is there.
    pub found: String,
}

impl fmt::Display for CsvError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}", self.line)?;
        if !self.column.is_empty() {
            write!(f, ", column {}", self.column)?;
        }
        write!(f, ": expected {}, found {}", self.expected, self.found)
    }
}

impl std::error::Error for CsvError {}

/// Writes symbols and descriptions in stored order, then the instruction comments.
///
/// # Errors
/// Only those of `writer`.
pub fn write_symbols(documentation: &Documentation, writer: impl Write) -> io::Result<()> {
    let mut table = WriterBuilder::new().terminator(Terminator::CRLF).from_writer(writer);
    table.write_record(COLUMNS)?;
    for entry in documentation.entries() {
        let address = entry.target.to_string();
        let description = entry.description.join("\n");
        table.write_record([&address, entry.symbol.as_str(), &description, kind_of(&entry.target), ""])?;
    }
    for comment in documentation.instruction_comments() {
        let address = comment.target.as_ref().map(Target::to_string).unwrap_or_default();
        let description = comment.lines.join("\n");
        table.write_record([&address, "", description.as_str(), INSTRUCTION_COMMENT, &comment.mnemonic])?;
    }
    table.flush()
}

/// Adds the rows of a table to the documentation of an image; a row replaces what the image has for
/// the same target. Columns are found by their names in the first row; only `address` must be there,
/// so a table kept by hand can be short. Program and data files without a name or description of
/// their own take it from their rows. Rows without symbol and description are kept too.
///
/// # Errors
/// The first row that is no row of such a table; the image is then unchanged.
pub fn read_symbols(text: &str, image: &mut Image) -> Result<(), CsvError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut table = ReaderBuilder::new().has_headers(false).flexible(true).from_reader(text.as_bytes());
    let mut records = table.records();
    let header = records.next().transpose().map_err(broken)?.unwrap_or_default();
    let columns = columns(&header)?;
    let mut entries: Vec<AddressEntry> = Vec::new();
    let mut comments: Vec<InstructionComment> = Vec::new();
    for record in records {
        match row(&record.map_err(broken)?, &columns, header.len())? {
            Row::Entry(entry) => entries.push(entry),
            Row::Comment(comment) => comments.push(comment),
        }
    }
    image.documentation = merged(&image.documentation, entries, comments);
    crate::tables::name_files(image);
    Ok(())
}

/// The old documentation with rows replaced or added.
fn merged(old: &Documentation, entries: Vec<AddressEntry>, comments: Vec<InstructionComment>) -> Documentation {
    let mut fresh = Documentation::default();
    let mut added = Documentation::default();
    entries.into_iter().for_each(|entry| added.add(entry));
    for entry in old.entries() {
        if added.entry(&entry.target).is_none() {
            fresh.add(entry.clone());
        }
    }
    added.entries().iter().for_each(|entry| fresh.add(entry.clone()));
    let same = |a: &InstructionComment, b: &InstructionComment| a.mnemonic == b.mnemonic && a.target == b.target;
    for comment in old.instruction_comments() {
        if !comments.iter().any(|new| new.target.is_some() && same(new, comment)) {
            fresh.add_instruction_comment(comment.clone());
        }
    }
    comments.into_iter().for_each(|comment| fresh.add_instruction_comment(comment));
    fresh.detached_comments.clone_from(&old.detached_comments);
    fresh
}

enum Row {
    Entry(AddressEntry),
    Comment(InstructionComment),
}

fn row(record: &StringRecord, columns: &[Option<usize>; 5], width: usize) -> Result<Row, CsvError> {
    let line = line(record);
    if record.len() > width {
        let expected = format!("{width} cells, as in the first row");
        return Err(CsvError { line, column: "", expected, found: record.len().to_string() });
    }
    let cell = |index: usize| columns.get(index).copied().flatten().and_then(|at| record.get(at)).unwrap_or("");
    let (address, symbol, kind, mnemonic) = (cell(0).trim(), cell(1), cell(3).trim(), cell(4));
    let description: Vec<String> = cell(2).lines().map(str::to_owned).collect();
    if kind == INSTRUCTION_COMMENT || (kind.is_empty() && !mnemonic.is_empty()) {
        let target = (!address.is_empty()).then(|| target_from(None, address).map_err(|e| no_target(line, e, address)));
        let target = target.transpose()?;
        if !symbol.is_empty() {
            let expected = "no symbol in the row of an instruction comment".to_owned();
            return Err(CsvError { line, column: SYMBOL, expected, found: symbol.to_owned() });
        }
        return Ok(Row::Comment(InstructionComment { mnemonic: mnemonic.to_owned(), target, lines: description }));
    }
    // By hand nobody means an address of unknown form: it must say so.
    let target = target_from((!kind.is_empty()).then_some(kind), address).and_then(|target| match target {
        Target::Other(_) if kind.is_empty() => Err("an address, or its kind in the column kind".to_owned()),
        target => Ok(target),
    });
    let target = target.map_err(|expected| no_target(line, expected, address))?;
    Ok(Row::Entry(AddressEntry { target, symbol: symbol.to_owned(), description }))
}

fn no_target(line: u64, expected: String, found: &str) -> CsvError {
    CsvError { line, column: ADDRESS, expected, found: format!("\"{found}\"") }
}

/// Where each of [`COLUMNS`] stands in the table.
fn columns(header: &StringRecord) -> Result<[Option<usize>; 5], CsvError> {
    let mut found = [None; 5];
    let bad = |expected: String, found: &str| CsvError { line: 1, column: "", expected, found: format!("\"{found}\"") };
    for (at, name) in header.iter().enumerate() {
        let known = COLUMNS.iter().position(|column| column.eq_ignore_ascii_case(name.trim()));
        match known.and_then(|index| found.get_mut(index)) {
            Some(slot @ None) => *slot = Some(at),
            Some(_) => return Err(bad("each column once".to_owned(), name)),
            None => return Err(bad(format!("columns from {}", COLUMNS.join(", ")), name)),
        }
    }
    match found[0] {
        Some(_) => Ok(found),
        None => Err(bad("a column address".to_owned(), &header.iter().collect::<Vec<_>>().join(","))),
    }
}

fn line(record: &StringRecord) -> u64 {
    record.position().map_or(1, ::csv::Position::line)
}

fn broken(error: ::csv::Error) -> CsvError {
    let line = error.position().map_or(1, ::csv::Position::line);
    CsvError { line, column: "", expected: "a row of a CSV table".to_owned(), found: error.to_string() }
}
