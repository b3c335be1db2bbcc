//! What commands share about ending and printing: outcomes, errors, plain-text tables.

use std::fmt;
use std::io;
use std::process::ExitCode;

/// How a command that ran to its end came out; the worst over all files counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    /// Done, nothing to complain about.
    Done,
    /// A difference, a failed expectation, a finding at error level.
    Finding,
    /// At least one output was not written, because it would overwrite another or its place takes none.
    NotWritten,
    /// At least one input could not be read.
    Unreadable,
}

impl From<Outcome> for ExitCode {
    fn from(outcome: Outcome) -> ExitCode {
        ExitCode::from(match outcome {
            Outcome::Done => 0,
            Outcome::Finding => 1,
            Outcome::NotWritten => 2,
            Outcome::Unreadable => 3,
        })
    }
}

/// What stops a command.
#[derive(Debug)]
pub enum Error {
    /// Arguments that cannot be meant, or a place that cannot be written.
    Use(String),
    /// Standard output went away or a file could not be written.
    Write(io::Error),
}

impl Error {
    /// 2: bad use, or output that could not be written.
    pub fn exit_code(&self) -> u8 {
        2
    }

    /// The reader of standard output closed it.
    pub fn is_broken_pipe(&self) -> bool {
        matches!(self, Error::Write(error) if error.kind() == io::ErrorKind::BrokenPipe)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Use(why) => f.write_str(why),
            Error::Write(error) => write!(f, "cannot write: {error}"),
        }
    }
}

impl From<io::Error> for Error {
    fn from(error: io::Error) -> Self {
        Error::Write(error)
    }
}

/// Passes text on with every character that could command a terminal spelled out (`\x1B`): names,
/// symbols and descriptions come from projects of strangers.
pub struct Printable<W>(pub W);

impl<W: io::Write> io::Write for Printable<W> {
    /// Formatted output arrives in whole characters; bytes that are none become replacement characters.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write_all(printable(&String::from_utf8_lossy(bytes)).as_bytes())?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

/// Passes JSON on with the control characters that JSON itself allows in strings spelled out (`\u009b` begins a command
/// in some terminals): the document stays the same.
pub struct Json<W>(pub W);

impl<W: io::Write> io::Write for Json<W> {
    /// Formatted output arrives in whole characters; bytes that are none become replacement characters.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let is_control = |c: char| matches!(c, '\u{7F}'..='\u{9F}');
        if !bytes.contains(&0x7F) && !bytes.windows(2).any(|pair| matches!(pair, [0xC2, 0x80..=0x9F])) {
            self.0.write_all(bytes)?;
            return Ok(bytes.len());
        }
        for c in String::from_utf8_lossy(bytes).chars() {
            if is_control(c) {
                write!(self.0, "\\u{:04x}", u32::from(c))?;
            } else {
                write!(self.0, "{c}")?;
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

/// Standard output for a command that prints JSON or text for people.
pub fn standard(json: bool) -> Box<dyn io::Write> {
    let out = io::BufWriter::new(io::stdout().lock());
    if json { Box::new(Json(out)) } else { Box::new(out) }
}

/// The text as [`Printable`] writes it; line ends stay.
pub fn printable(text: &str) -> String {
    text.split('\n').map(render::clean).collect::<Vec<_>>().join("\n")
}

/// A table with left-aligned columns as wide as their widest cell; columns whose every cell below
/// the heading is a number stand right.
pub struct Columns {
    rows: Vec<Vec<String>>,
    /// Row and text of each note.
    notes: Vec<(usize, String)>,
}

/// Columns that notes under a row keep to.
const NOTE_WIDTH: usize = 100;
/// How far notes stand in from their row.
const NOTE_INDENT: &str = "          ";

impl Columns {
    /// A table with these headings.
    pub fn new(headings: &[&str]) -> Columns {
        Columns { rows: vec![headings.iter().map(|heading| (*heading).to_owned()).collect()], notes: Vec::new() }
    }

    /// Adds a row; missing cells are empty. Cells are cleaned here, before they are measured.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().map(|cell| render::clean(&cell).into_owned()).collect());
    }

    /// Adds a text below the last row, for what would make the columns too wide. Broken at blanks.
    pub fn note(&mut self, text: &str) {
        self.notes.push((self.rows.len(), render::clean(text).into_owned()));
    }

    /// No row below the headings.
    pub fn is_empty(&self) -> bool {
        self.rows.len() < 2
    }

    /// Writes the table, each line led by `indent`.
    pub fn write(&self, out: &mut (impl io::Write + ?Sized), indent: &str) -> io::Result<()> {
        let count = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let cell = |row: &Vec<String>, column: usize| row.get(column).cloned().unwrap_or_default();
        let width = |column| self.rows.iter().map(|row| cell(row, column).chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..count).map(width).collect();
        let is_number =
            |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit() || matches!(c, '-' | '.'));
        let right = |column| {
            let mut cells =
                self.rows.iter().skip(1).map(|row| cell(row, column)).filter(|text| !text.is_empty()).peekable();
            cells.peek().is_some() && cells.all(|text| is_number(&text))
        };
        let right: Vec<bool> = (0..count).map(right).collect();
        let mut notes = self.notes.iter().peekable();
        for (number, row) in (1..).zip(&self.rows) {
            let mut line = String::from(indent);
            for (column, (width, right)) in widths.iter().zip(&right).enumerate() {
                let text = cell(row, column);
                let space = " ".repeat(width - text.chars().count());
                line.push_str(&if *right { space + &text } else { text + &space });
                line.push_str("  ");
            }
            writeln!(out, "{}", line.trim_end())?;
            while let Some((_, text)) = notes.next_if(|(row, _)| *row == number) {
                write_note(out, indent, text)?;
            }
        }
        Ok(())
    }
}

fn write_note(out: &mut (impl io::Write + ?Sized), indent: &str, text: &str) -> io::Result<()> {
    let mut line = format!("{indent}{NOTE_INDENT}");
    let mut empty = true;
    for word in text.split(' ') {
        if !empty && line.chars().count() + 1 + word.chars().count() > NOTE_WIDTH {
            writeln!(out, "{line}")?;
            line = format!("{indent}{NOTE_INDENT}  ");
            empty = true;
        }
        if !empty {
            line.push(' ');
        }
        line.push_str(word);
        empty = false;
    }
    writeln!(out, "{line}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn texts_of_a_project_cannot_command_the_terminal() {
        let mut out = Vec::new();
        let symbol = "A\u{1B}[2J\u{9B}1mB";
        writeln!(Printable(&mut out), "T4:0  {symbol}").expect("a vector takes all");
        let mut table = Columns::new(&["Symbol"]);
        table.row([format!("{symbol}\n")]);
        table.write(&mut out, "").expect("a vector takes all");
        let text = String::from_utf8(out).expect("text");
        assert_eq!(text, "T4:0  A\\x1B[2J\\x9B1mB\nSymbol\nA\\x1B[2J\\x9B1mB\\x0A\n");
    }

    #[test]
    fn json_says_the_same_without_commands() {
        let value = serde_json::json!({"symbol": "a\u{9B}31m\u{7F}\u{1B}é漢"});
        let mut out = Vec::new();
        write!(Json(&mut out), "{value}").expect("a vector takes all");
        let text = String::from_utf8(out).expect("text");
        assert_eq!(text, "{\"symbol\":\"a\\u009b31m\\u007f\\u001bé漢\"}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&text).expect("JSON"), value);
    }

    #[test]
    fn numbers_stand_right_and_lines_end_clean() {
        let mut table = Columns::new(&["Name", "Rungs", "Description"]);
        table.row(["MAIN".into(), "10".into(), String::new()]);
        table.row(["A".into(), "5".into(), "x".into()]);
        table.note(&["word"; 20].join(" "));
        let mut out = Vec::new();
        table.write(&mut out, "  ").expect("a vector takes all");
        let text = String::from_utf8(out).expect("text");
        let note = format!("            {}\n              {}\n", ["word"; 17].join(" "), ["word"; 3].join(" "));
        assert_eq!(text, format!("  Name  Rungs  Description\n  MAIN     10\n  A         5  x\n{note}"));
    }
}
