//! What reading found wrong, with its place.

use std::fmt;

use ladder::Severity;

/// One finding about a project.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Line of the file, from 1; 0 if the program was not read from one.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
    /// Code block, and number of the rung in it as Designer counts, from 1.
    pub rung: Option<(String, usize)>,
    /// What is wrong.
    pub problem: Problem,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Problem {
    /// A line outside of code blocks that is none of the known kinds.
    UnknownLine,
    /// A line of a section that does not have the form of its lines.
    Row {
        /// Name of the section.
        section: String,
        /// The form.
        expected: &'static str,
    },
    /// A section without `#END`.
    OpenSection(String),
    /// `#END` without a section.
    StrayEnd,
    /// A code block without the line that ends it.
    OpenCodeBlock {
        /// Name of the block.
        name: String,
        /// The line that was expected.
        expected: String,
    },
    /// A line that ends a code block which is not open.
    StrayCodeEnd(String),
    /// A code block with the name of an earlier one.
    DuplicateCodeBlock(String),
    /// A word with `$` that begins no known kind of code block.
    UnknownCodeKind(String),
    /// The first word of a line in a code block cannot be an instruction.
    NotAnInstruction(String),
    /// An instruction that is not in the table.
    UnknownInstruction(String),
    /// An operand whose closing quote is missing.
    OpenQuote,
    /// A line of a comment without quotes around it.
    CommentLine,
    /// Too few or too many operands.
    OperandCount {
        /// The instruction.
        mnemonic: String,
        /// Fewest and most.
        expected: (usize, usize),
        /// How many there are.
        found: usize,
    },
    /// More values are taken from the stack of booleans than were pushed.
    StackUnderflow {
        /// The instruction that takes them.
        mnemonic: String,
        /// How many it needs.
        needs: usize,
        /// How many there are.
        found: usize,
    },
    /// The rung ends with values on the stack that nothing took.
    StackLeft(usize),
    /// The rung pushes and joins contacts, and executes nothing.
    NoOutput,
    /// A coil or box without any contact before it, in a rung that does not follow a stage.
    NoContact(String),
    /// An instruction behind a box with several legs: what the power flow is there is not known.
    BehindBox(String),
    /// An instruction that must stand alone in its rung.
    NotAlone(String),
    /// A contact that begins a new group directly behind an output: reads as the start of a new rung.
    GroupBehindOutput(String),
    /// An operand that reads as an element and names no memory.
    NoSuchElement {
        /// The operand as written.
        operand: String,
        /// What is missing.
        why: String,
    },
    /// Nested deeper than is handled.
    Depth(usize),
    /// Line ends of both kinds; written as the first one is.
    MixedLineEnds,
}

impl Problem {
    /// How much it matters.
    pub fn severity(&self) -> Severity {
        use Problem as P;
        match self {
            P::MixedLineEnds => Severity::Note,
            P::UnknownLine
            | P::OpenSection(_)
            | P::StrayEnd
            | P::OpenCodeBlock { .. }
            | P::StrayCodeEnd(_)
            | P::NotAnInstruction(_)
            | P::OpenQuote
            | P::StackUnderflow { .. }
            | P::StackLeft(_)
            | P::Depth(_) => Severity::Error,
            _ => Severity::Warning,
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use Problem as P;
        match self {
            P::UnknownLine => {
                f.write_str("expected PLC, #BEGIN, $PRGRM or an instruction, found another text; carried as it is")
            }
            P::Row { section, expected } => {
                write!(f, "{section}: expected {expected}, found another text; carried as it is")
            }
            P::OpenSection(name) => write!(f, "expected #END of {name}, found the end of its surroundings"),
            P::StrayEnd => f.write_str("#END without #BEGIN"),
            P::OpenCodeBlock { name, expected } => write!(f, "code block {name}: expected {expected}, found none"),
            P::StrayCodeEnd(line) => write!(f, "`{line}` ends a code block that is not open"),
            P::DuplicateCodeBlock(name) => write!(f, "a second code block with the name {name}"),
            P::UnknownCodeKind(word) => write!(f, "{word} is no known kind of code block"),
            P::NotAnInstruction(word) => write!(f, "expected an instruction, found `{word}`"),
            P::UnknownInstruction(name) => {
                write!(f, "instruction {name} is not known; carried, and taken as a coil or box with one leg")
            }
            P::OpenQuote => f.write_str("a quote is not closed on its line"),
            P::CommentLine => f.write_str("comment: expected a text in quotes"),
            P::OperandCount { mnemonic, expected: (fewest, most), found } if fewest == most => {
                write!(f, "{mnemonic}: expected {most} operands, found {found}")
            }
            P::OperandCount { mnemonic, expected: (fewest, most), found } => {
                write!(f, "{mnemonic}: expected {fewest} to {most} operands, found {found}")
            }
            P::StackUnderflow { mnemonic, needs, found } => {
                write!(f, "{mnemonic} needs {needs} conditions from STR instructions, found {found}")
            }
            P::StackLeft(count) => {
                write!(f, "too many STR instructions: {count} conditions are left that nothing joins or uses")
            }
            P::NoOutput => f.write_str("the rung has no coil or box"),
            P::NoContact(name) => write!(f, "{name} has no condition before it"),
            P::BehindBox(name) => {
                write!(f, "{name} stands behind a box with several legs; its power flow is not known")
            }
            P::NotAlone(name) => write!(f, "{name} must stand alone in its rung"),
            P::GroupBehindOutput(name) => write!(f, "{name} directly behind a coil or box reads as a new rung"),
            P::NoSuchElement { operand, why } => write!(f, "{operand}: {why}"),
            P::Depth(limit) => write!(f, "more than {limit} conditions on the stack"),
            P::MixedLineEnds => f.write_str("line ends of both kinds; all are written as the first"),
        }
    }
}

impl fmt::Display for Diagnostic {
    /// `line 12, column 4, $Main rung 3: ...`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place(), self.problem)
    }
}

impl Diagnostic {
    /// Where: `line 12, column 4, $Main rung 3`.
    pub fn place(&self) -> String {
        let mut place = match self.line {
            0 => String::new(),
            line => format!("line {line}, column {}", self.column),
        };
        if let Some((block, rung)) = &self.rung {
            if !place.is_empty() {
                place.push_str(", ");
            }
            let block = if block.is_empty() { "rungs without a code block" } else { block };
            place.push_str(&format!("{block} rung {rung}"));
        }
        place
    }

    /// The finding in the form all dialects share.
    pub fn to_ladder(&self) -> ladder::Diagnostic {
        ladder::Diagnostic { severity: self.problem.severity(), place: self.place(), message: self.problem.to_string() }
    }
}
