//! The model of a Do-more project as Designer's text form holds it: parts in file order.
//!
//! Everything of a file is in the model, in the order of the file. What a person would call content is
//! in plain fields; what only concerns the spelling of the file (blank lines, `//` lines, separators) is
//! in the [`Origin`] beside it. A program made from nothing leaves every origin at its default and is
//! written the way Designer writes.

use std::fmt;

/// A Do-more project.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Project {
    /// How lines end and characters are stored.
    pub format: Format,
    /// Everything in the file, in its order.
    pub parts: Vec<Part>,
    /// Blank and `//` lines after the last part.
    pub tail: Origin,
}

/// How the file as a whole is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Format {
    /// How lines end.
    pub line_end: LineEnd,
    /// The last line has a line end too.
    pub ends_with_line_end: bool,
    /// How characters are stored.
    pub encoding: Encoding,
}

impl Default for Format {
    fn default() -> Self {
        Format { line_end: LineEnd::CrLf, ends_with_line_end: true, encoding: Encoding::default() }
    }
}

/// How lines end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineEnd {
    /// Carriage return and line feed: what Designer writes.
    #[default]
    CrLf,
    /// Line feed alone: files that went through version control.
    Lf,
}

impl LineEnd {
    /// The characters.
    pub fn as_str(self) -> &'static str {
        match self {
            LineEnd::CrLf => "\r\n",
            LineEnd::Lf => "\n",
        }
    }
}

/// How characters are stored. Designer's exports are ASCII, for which all of these are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// Windows code page 1252.
    #[default]
    Windows1252,
    /// UTF-8.
    Utf8,
    /// UTF-8 behind a byte order mark.
    Utf8WithMark,
}

/// One part of a project file.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    /// `PLC model`.
    Controller(Controller),
    /// `#BEGIN DEVICE`.
    Devices(Section<Device>),
    /// `#BEGIN MEM_CONFIG`.
    Memory(Section<MemoryBlock>),
    /// `#BEGIN ELEMENT_DOC`.
    Documentation(Section<ElementDoc>),
    /// Any other `#BEGIN` section, `SYS_CONFIG` among them: carried untouched.
    Raw(RawSection),
    /// Rungs.
    Code(CodeBlock),
    /// A line that is none of these; carried.
    Unread(Unread),
}

/// The `PLC` line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Controller {
    /// `BX-DM1E-18ED23`, `DM-SIM`, ...
    pub model: String,
    /// How it was written.
    pub origin: Origin,
}

/// A line that could not be read, with the diagnostic that says so.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Unread {
    /// The line.
    pub text: String,
    /// How it was written.
    pub origin: Origin,
}

/// A `#BEGIN` section of lines that are understood.
#[derive(Clone, Debug, PartialEq)]
pub struct Section<T> {
    /// Its lines.
    pub rows: Vec<Row<T>>,
    /// The `#BEGIN` line.
    pub origin: Origin,
    /// The `#END` line, and blank and `//` lines before it.
    pub end: Origin,
}

impl<T> Default for Section<T> {
    fn default() -> Self {
        Section { rows: Vec::new(), origin: Origin::default(), end: Origin::default() }
    }
}

impl<T> Section<T> {
    /// A section of these entries.
    pub fn new(entries: impl IntoIterator<Item = T>) -> Self {
        Section { rows: entries.into_iter().map(Row::Entry).collect(), ..Section::default() }
    }

    /// The lines that were understood.
    pub fn entries(&self) -> impl Iterator<Item = &T> {
        self.rows.iter().filter_map(|row| match row {
            Row::Entry(entry) => Some(entry),
            Row::Unread(_) => None,
        })
    }
}

/// A line of a [`Section`].
#[derive(Clone, Debug, PartialEq)]
pub enum Row<T> {
    /// An understood line.
    Entry(T),
    /// Any other line; carried.
    Unread(Unread),
}

/// A line of `DEVICE`: `@IntSerial, 10, 15`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Device {
    /// Name, `@` included.
    pub name: String,
    /// Id, type and parameters, whose number depends on the type.
    pub parameters: Vec<String>,
    /// How it was written.
    pub origin: Origin,
}

/// A line of `MEM_CONFIG`: a memory block, a code block or an item of the heap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MemoryBlock {
    /// `X`, `N`, `Batch`, ...
    pub name: String,
    /// `BIT`, `SWORD`, `TIMER`, `PROGRAM`, `<Virtual>`, a user type, ...
    pub type_word: String,
    /// How elements are numbered; `None` where a line has no such column content.
    pub radix: Option<Radix>,
    /// Number of elements; 0 for what is no array.
    pub count: u32,
    /// Columns after the count. The first is `-1` on I/O and Programs and absent on retentive blocks;
    /// its exact meaning is not known.
    pub extra: Vec<String>,
    /// How it was written.
    pub origin: Origin,
}

impl MemoryBlock {
    /// The count in the radix of the block's numbers, octal with a leading 0.
    pub fn count_text(&self) -> String {
        match self.radix {
            Some(Radix::Octal) => format!("0{:o}", self.count),
            _ => self.count.to_string(),
        }
    }
}

/// How elements of a memory block are numbered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Radix {
    /// `decimal`.
    #[default]
    Decimal,
    /// `octal`: the guest memory of DirectLOGIC (`DLX`, `DLV`, ...).
    Octal,
}

impl Radix {
    /// The word in lists.
    pub fn as_str(self) -> &'static str {
        match self {
            Radix::Decimal => "decimal",
            Radix::Octal => "octal",
        }
    }
}

/// A line of `ELEMENT_DOC`: documentation of an element.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ElementDoc {
    /// `X0`, `T0`, `V84:SD`, `SK3` (a named constant), `UN1` (a nickname without an element), ...
    pub element: String,
    /// Words behind `FLAGS =`; `None` where the file has no such column.
    pub flags: Option<String>,
    /// Nickname, at most 16 characters; empty if none.
    pub nickname: String,
    /// Fourth column: the value of a named constant; otherwise mostly empty.
    pub extra: String,
    /// Description, one line per column.
    pub description: Vec<String>,
    /// How it was written.
    pub origin: Origin,
}

impl ElementDoc {
    /// Description without the empty lines at its end.
    pub fn lines(&self) -> &[String] {
        let used = self.description.iter().rposition(|line| !line.is_empty()).map_or(0, |last| last + 1);
        self.description.get(..used).unwrap_or_default()
    }
}

/// A section whose lines are carried as they are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RawSection {
    /// Word behind `#BEGIN`.
    pub name: String,
    /// Lines up to `#END`.
    pub lines: Vec<String>,
    /// The `#BEGIN` line.
    pub origin: Origin,
    /// The `#END` line.
    pub end: Origin,
}

/// A code block: a stretch of rungs between delimiters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CodeBlock {
    /// Program, subroutine, task, ...
    pub kind: CodeKind,
    /// `$Main`, `Batch`, ...; empty for [`CodeKind::Bare`].
    pub name: String,
    /// The rungs.
    pub rungs: Vec<Rung>,
    /// The line that begins it.
    pub origin: Origin,
    /// The line that ends it, and blank and `//` lines before that.
    pub end: Origin,
}

/// What a code block is.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub enum CodeKind {
    /// `$PRGRM`: enabled by RUN, executed every scan until stopped.
    #[default]
    Program,
    /// `$LGCMOD`: executed by CALL.
    Subroutine,
    /// `$TSK`: enabled by its rung, executed in its turn.
    Task,
    /// `$INT`: executed by an event.
    Interrupt,
    /// Rungs without delimiters, as in a file of instructions to insert.
    Bare,
    /// Another word with `$`; the words that begin and end it, `$` included.
    Other {
        /// `$XYZ`.
        begin: String,
        /// `$XYZEND`.
        end: String,
    },
}

impl CodeKind {
    /// The delimiters that Designer writes, in the order begin, end.
    const DELIMITERS: [(CodeKind, &'static str, &'static str); 4] = [
        (CodeKind::Program, "$PRGRM", "$PGMEND"),
        (CodeKind::Subroutine, "$LGCMOD", "$LGCEND"),
        (CodeKind::Task, "$TSK", "$TSKEND"),
        (CodeKind::Interrupt, "$INT", "$INTEND"),
    ];

    /// The word that begins a block of this kind; empty for bare rungs.
    pub fn begin(&self) -> &str {
        match self {
            CodeKind::Bare => "",
            CodeKind::Other { begin, .. } => begin,
            kind => CodeKind::DELIMITERS.iter().find(|row| row.0 == *kind).map_or("", |row| row.1),
        }
    }

    /// The word that ends a block of this kind; empty for bare rungs.
    pub fn end(&self) -> &str {
        match self {
            CodeKind::Bare => "",
            CodeKind::Other { end, .. } => end,
            kind => CodeKind::DELIMITERS.iter().find(|row| row.0 == *kind).map_or("", |row| row.2),
        }
    }

    /// The kind that `word` (`$PRGRM`) begins; `None` if the word ends one or is none.
    pub fn from_begin(word: &str) -> Option<CodeKind> {
        if !word.starts_with('$') || word.ends_with("END") {
            return None;
        }
        let known = CodeKind::DELIMITERS.into_iter().find(|row| row.1 == word).map(|row| row.0);
        Some(known.unwrap_or_else(|| CodeKind::Other { begin: word.to_owned(), end: format!("{word}END") }))
    }

    /// `Program`, `Subroutine`, ... as a person calls it; an unknown kind by its word.
    pub fn title(&self) -> &str {
        match self {
            CodeKind::Program => "Program",
            CodeKind::Subroutine => "Subroutine",
            CodeKind::Task => "Task",
            CodeKind::Interrupt => "Interrupt",
            CodeKind::Bare => "Rungs",
            CodeKind::Other { begin, .. } => begin,
        }
    }
}

/// A rung: a postfix program over a stack of booleans, see [`crate::stack`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rung {
    /// What stands above it.
    pub comment: Option<Comment>,
    /// Its instructions in the order of the text. Empty only where a comment has no rung to belong to.
    pub instructions: Vec<Instruction>,
}

impl Rung {
    /// A rung without comment.
    pub fn new(instructions: impl IntoIterator<Item = Instruction>) -> Rung {
        Rung { comment: None, instructions: instructions.into_iter().collect() }
    }

    /// The stage a `SG` rung begins, such as `$Main.S1`.
    pub fn stage(&self) -> Option<&str> {
        match self.instructions.as_slice() {
            [only] if only.is("SG") => only.operands.first().map(String::as_str),
            _ => None,
        }
    }

    /// Line of the file the rung begins at (its first instruction, or its comment), if it was read.
    pub fn line(&self) -> Option<u32> {
        let comment = self.comment.as_ref().and_then(|comment| comment.origin.line());
        self.instructions.first().and_then(|first| first.origin.line()).or(comment)
    }
}

/// A comment above a rung.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comment {
    /// Plain, formatted, or a section that is neither.
    pub kind: CommentKind,
    /// Its lines, without quotes. For [`CommentKind::Other`] the lines as they stand.
    pub lines: Vec<String>,
    /// The `#BEGIN` line; its spelling is that of the whole section.
    pub origin: Origin,
}

/// What kind of comment.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum CommentKind {
    /// `COMMENT`.
    #[default]
    Plain,
    /// `FMT_COMMENT`: a small subset of HTML, see [`Comment::plain_lines`].
    Formatted,
    /// Another section that stands among rungs; its word. Carried.
    Other(String),
}

impl Comment {
    /// A plain comment.
    pub fn plain(lines: impl IntoIterator<Item = String>) -> Comment {
        Comment { lines: lines.into_iter().collect(), ..Comment::default() }
    }

    /// Word behind `#BEGIN`.
    pub fn word(&self) -> &str {
        match &self.kind {
            CommentKind::Plain => "COMMENT",
            CommentKind::Formatted => "FMT_COMMENT",
            CommentKind::Other(word) => word,
        }
    }
}

/// One instruction as it is written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Instruction {
    /// `STR`, `TMR`, ...; upper case in Designer's exports.
    pub mnemonic: String,
    /// Operands as spelled, quotes included (`"D0 + 1"`), without the separators between them.
    pub operands: Vec<String>,
    /// How it was written.
    pub origin: Origin,
}

impl Instruction {
    /// An instruction with these operands.
    pub fn new<O: Into<String>>(mnemonic: impl Into<String>, operands: impl IntoIterator<Item = O>) -> Instruction {
        Instruction {
            mnemonic: mnemonic.into(),
            operands: operands.into_iter().map(Into::into).collect(),
            origin: Origin::default(),
        }
    }

    /// Whether this is the instruction of that name.
    pub fn is(&self, mnemonic: &str) -> bool {
        self.mnemonic.eq_ignore_ascii_case(mnemonic)
    }

    /// Operand `index` as spelled; empty if there is none.
    pub fn operand(&self, index: usize) -> &str {
        self.operands.get(index).map_or("", String::as_str)
    }
}

impl fmt::Display for Instruction {
    /// Words separated by blanks: `TMR T0 5000`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.mnemonic)?;
        self.operands.iter().try_for_each(|operand| write!(f, " {operand}"))
    }
}

/// Where and how something was written, for messages and for writing the same text back.
///
/// Two origins always compare equal: a model that differs only in spelling is the same model.
#[derive(Clone, Debug, Default)]
pub struct Origin {
    /// Line of the file, from 1; 0 for what was not read from one.
    pub(crate) line: u32,
    /// Blank and `//` lines before it; `None`: as Designer would place it.
    pub(crate) before: Option<Box<[Box<str>]>>,
    /// The line as it stood, where writing the content would give another. Ignored as soon as it no
    /// longer reads as the content it is beside.
    pub(crate) spelling: Option<Box<str>>,
}

impl PartialEq for Origin {
    fn eq(&self, _: &Origin) -> bool {
        true
    }
}

impl Origin {
    /// An origin with these lines (blank, or beginning with `//`) before what it belongs to.
    pub fn after_lines(lines: impl IntoIterator<Item = String>) -> Origin {
        let before = lines.into_iter().map(String::into_boxed_str).collect();
        Origin { before: Some(before), ..Origin::default() }
    }

    /// Line of the file, from 1, if it was read from one.
    pub fn line(&self) -> Option<u32> {
        (self.line > 0).then_some(self.line)
    }

    /// Blank and `//` lines before it.
    pub fn lines_before(&self) -> impl Iterator<Item = &str> {
        self.before.iter().flat_map(|lines| lines.iter().map(|line| &**line))
    }
}

impl Project {
    /// The controller model; empty if the file names none.
    pub fn controller(&self) -> &str {
        match self.parts.iter().find(|part| matches!(part, Part::Controller(_))) {
            Some(Part::Controller(controller)) => &controller.model,
            _ => "",
        }
    }

    /// All code blocks in file order.
    pub fn code_blocks(&self) -> impl Iterator<Item = &CodeBlock> {
        self.parts.iter().filter_map(|part| match part {
            Part::Code(block) => Some(block),
            _ => None,
        })
    }

    /// The code block of that name.
    pub fn code_block(&self, name: &str) -> Option<&CodeBlock> {
        self.code_blocks().find(|block| block.name == name)
    }

    /// All devices.
    pub fn devices(&self) -> impl Iterator<Item = &Device> {
        self.parts
            .iter()
            .flat_map(|part| match part {
                Part::Devices(section) => section.rows.as_slice(),
                _ => &[],
            })
            .filter_map(Row::entry)
    }

    /// All lines of the memory configuration.
    pub fn memory(&self) -> impl Iterator<Item = &MemoryBlock> {
        self.parts
            .iter()
            .flat_map(|part| match part {
                Part::Memory(section) => section.rows.as_slice(),
                _ => &[],
            })
            .filter_map(Row::entry)
    }

    /// All lines of element documentation.
    pub fn documentation(&self) -> impl Iterator<Item = &ElementDoc> {
        self.parts
            .iter()
            .flat_map(|part| match part {
                Part::Documentation(section) => section.rows.as_slice(),
                _ => &[],
            })
            .filter_map(Row::entry)
    }
}

impl<T> Row<T> {
    /// What was understood.
    pub fn entry(&self) -> Option<&T> {
        match self {
            Row::Entry(entry) => Some(entry),
            Row::Unread(_) => None,
        }
    }
}
