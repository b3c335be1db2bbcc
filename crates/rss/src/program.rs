//! Program files: ladder files, rungs, legs, branches, instructions, as the stream stores them.
//!
//! ```text
//! CProgHolder := count  OBJ CLadFile*
//! CLadFile    := u16 rungs, u16 flags, char[10] name, u16 number, CString description, count, OBJ CRung*
//! CRung       := OBJ CBranchLeg, u32, u32 edited, u32 comment id
//! CBranchLeg  := count, OBJ (CIns | CBranch)*
//! CBranch     := count, OBJ (CIns | CBranchLeg)*
//! CIns        := count, CString*, u16 has code, u16 opcode, u16 x, u16 y, [count, code], [set-up record]
//! ```
//!
//! The marks that open and close rungs, branches and legs are instructions of
//! their own in the stream and stay so here, because they can carry code or not.

mod message;
mod operands;
mod read;
mod write;

pub use message::{CipTail, MessageSetup, PathHop};
pub use operands::Operands;

use crate::archive::{Reader, Record, Writer};
use crate::error::Result;
use crate::text::Text;
use std::borrow::Cow;

/// Opcodes of the marks that structure a rung. All others are instructions,
/// which this crate does not know.
pub mod mark {
    /// Opens a rung.
    pub const RUNG_START: u16 = 0;
    /// Closes a rung.
    pub const RUNG_END: u16 = 1;
    /// Opens a branch.
    pub const BRANCH_START: u16 = 2;
    /// Closes a branch.
    pub const BRANCH_END: u16 = 3;
    /// Opens a leg of a branch.
    pub const LEG_START: u16 = 4;
    /// Closes a leg of a branch.
    pub const LEG_END: u16 = 5;
}

/// The stream `PROGRAM FILES`: all program files, in the order of their numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgramFiles<'a> {
    /// Program files. The index is the file number.
    pub files: Vec<LadFile<'a>>,
}

/// A program file (class `CLadFile`).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LadFile<'a> {
    /// Number of rungs as stated before the name; equals `rungs.len()`. Includes the rung that only ends the file.
    pub rung_count: u16,
    /// See [`LadFile::LADDER`], [`LadFile::NO_PROGRAM`], [`LadFile::RESERVED`].
    pub flags: u16,
    /// Name, padded with zero bytes; not terminated if ten bytes long. Code page 1252.
    pub name: [u8; 10],
    /// Number of the program file.
    pub number: u16,
    /// One line of description.
    pub description: Text<'a>,
    /// The rungs.
    pub rungs: Vec<Rung<'a>>,
}

impl LadFile<'_> {
    /// Flag: a ladder file. Inferred: set exactly on files numbered from 2.
    pub const LADDER: u16 = 1;
    /// Flag: the file holds no program. Inferred from files without rungs.
    pub const NO_PROGRAM: u16 = 2;
    /// Flag: reserved by the processor. Seen on file 16 of every MicroLogix 1000 project.
    pub const RESERVED: u16 = 0x80;

    /// The name without its padding.
    #[must_use]
    pub fn name(&self) -> Cow<'_, str> {
        let end = self.name.iter().position(|&b| b == 0).unwrap_or(self.name.len());
        crate::text::decode(self.name.get(..end).unwrap_or_default())
    }
}

/// A rung (class `CRung`).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rung<'a> {
    /// What stands on the rung, between its start and end mark.
    pub leg: Leg<'a>,
    /// First u32 after the leg: 0 in all but three known rungs. Meaning unknown.
    pub unknown_0: u32,
    /// 0, or 1 if the rung was edited and not verified since.
    pub edited: u32,
    /// Id of the rung's comment in the documentation database, 0 for none.
    pub comment_id: u32,
}

/// A row of instructions and branches in power-flow order (class `CBranchLeg`).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Leg<'a> {
    /// Start mark, instructions and branches, end mark.
    pub items: Vec<Item<'a>>,
}

/// Parallel legs, from top to bottom (class `CBranch`).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Branch<'a> {
    /// Start mark, legs, end mark.
    pub items: Vec<Item<'a>>,
}

/// An object in a leg or a branch.
#[derive(Clone, Debug, PartialEq)]
pub enum Item<'a> {
    /// An instruction or a mark.
    Instruction(Instruction<'a>),
    /// A branch; stands in a leg.
    Branch(Branch<'a>),
    /// A leg; stands in a branch.
    Leg(Leg<'a>),
    /// No object. Never seen.
    Null,
    /// An object read before, by its archive number. Never seen.
    Reference(u32),
}

/// An instruction (class `CIns`).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Instruction<'a> {
    /// Operand texts as RSLogix shows them: sources, each mostly followed by the value last displayed.
    pub operands: Operands<'a>,
    /// 1 if compiled code follows, 0 if the instruction was not compiled since it was edited.
    pub has_code: u16,
    /// Which instruction.
    pub opcode: u16,
    /// Always 0. Meaning unknown.
    pub x: u16,
    /// Always 0. Meaning unknown.
    pub y: u16,
    /// Compiled code, see [`crate::code`]; empty if `has_code` is 0.
    pub code: Cow<'a, [u8]>,
    /// Set-up record of a message instruction.
    pub message: Option<Box<MessageSetup<'a>>>,
}

impl Instruction<'_> {
    /// True for the marks of [`mark`].
    #[must_use]
    pub fn is_mark(&self) -> bool {
        self.opcode <= mark::LEG_END
    }
}

impl<'a> Item<'a> {
    /// The instruction, if the item is one (a mark counts).
    #[must_use]
    pub fn as_instruction(&self) -> Option<&Instruction<'a>> {
        match self {
            Item::Instruction(i) => Some(i),
            _ => None,
        }
    }
}

impl<'a> Rung<'a> {
    /// Calls `visit` for each instruction of the rung in stored order, marks included.
    pub fn for_each_instruction<'r>(&'r self, mut visit: impl FnMut(&'r Instruction<'a>)) {
        fn walk<'r, 'a>(items: &'r [Item<'a>], visit: &mut impl FnMut(&'r Instruction<'a>)) {
            for item in items {
                match item {
                    Item::Instruction(i) => visit(i),
                    Item::Branch(Branch { items }) | Item::Leg(Leg { items }) => walk(items, visit),
                    Item::Null | Item::Reference(_) => {}
                }
            }
        }
        walk(&self.leg.items, &mut visit);
    }
}

impl<'a> Record<'a> for ProgramFiles<'a> {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        read::files(self, r)
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        write::files(self, w)
    }
}

#[cfg(test)]
mod tests;
