//! Operands of the compiled form: where operations read and write.

use ladder::FileType;

use crate::layout::Width;

/// Where a value is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Source {
    Word(u32),
    Long(u32),
    Float(u32),
    Integer(i32),
    Real(f32),
    /// Index of a reference decided at run time.
    At(u32),
}

/// Where a value is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Target {
    Word(u32),
    Long(u32),
    Float(u32),
    At(u32),
}

/// A bit operand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BitAt {
    Direct { mask: u16, word: u32 },
    At(u32),
}

/// The start of a file operand or of a block of words.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Start {
    pub(crate) at: StartAt,
    /// Words per element there.
    pub(crate) size: u32,
    /// What its elements are as numbers; words unless long words or floats.
    pub(crate) kind: instr::exec::Width,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum StartAt {
    /// First word and first word after the file.
    Fixed {
        word: u32,
        end: u32,
    },
    At(u32),
}

/// A part of an address: fixed, or read when the instruction executes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Part {
    Fixed(u16),
    Read(Source),
}

/// An address decided at run time, by brackets or by S:24.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reference {
    pub(crate) file_type: FileType,
    pub(crate) file: Part,
    pub(crate) element: Part,
    pub(crate) sub: u16,
    pub(crate) bit: Option<Part>,
    /// Add S:24 to the element.
    pub(crate) indexed: bool,
    pub(crate) width: Width,
}

/// Operands of a sequencer that are a word or, with `#`, a file stepped along with POS.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Stepped {
    Value(Source),
    File(Start),
}

/// Where a sequencer writes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SteppedTarget {
    Value(Target),
    File(Start),
}
