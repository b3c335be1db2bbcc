//! Short constructors for the rows of the instruction table, all usable in constants.

use ladder::{FileType, TimeBase};

use crate::model::*;
use crate::{Drawing, Families};

/// Everybody's arithmetic flags: carry, overflow, zero, sign, and the overflow trap.
pub(crate) const FLAGS: &[&str] = &["S:0/0", "S:0/1", "S:0/2", "S:0/3", "S:5/0"];
/// Arithmetic flags and the math register.
pub(crate) const FLAGS_AND_REGISTER: &[&str] = &["S:0/0", "S:0/1", "S:0/2", "S:0/3", "S:5/0", "S:13", "S:14"];
/// Index register used as the instruction's own pointer, control error bit.
pub(crate) const INDEX_AND_ERROR: &[&str] = &["S:24", "S:5/2"];
/// Index register.
pub(crate) const INDEX: &[&str] = &["S:24"];
/// String error bit.
pub(crate) const STRING_ERROR: &[&str] = &["S:5/15"];
/// Flags of a conversion from or to a string, and the string error bit.
pub(crate) const STRING_FLAGS: &[&str] = &["S:0/0", "S:0/1", "S:0/2", "S:0/3", "S:5/0", "S:5/15"];
/// Nothing outside the operands.
pub(crate) const NOTHING: &[&str] = &[];

const INDEXES: &[usize] = &[0, 1, 2, 3, 4, 5, 6, 7];

/// An operand with one stored text; the extent follows from kind and role.
pub(crate) const fn op(name: &'static str, role: Role, kind: Kind) -> Operand {
    let extent = match (role, kind) {
        (Role::Parameter, _) => Extent::None,
        (_, Kind::Bit) => Extent::Bit,
        (_, Kind::Word | Kind::Mask | Kind::WordOrFile) => Extent::Value,
        (_, Kind::Timer | Kind::Counter | Kind::Control | Kind::Resettable) => Extent::Element,
        (_, Kind::PidBlock | Kind::MessageBlock | Kind::RoutingBlock) => Extent::Element,
        (_, Kind::String) => Extent::String,
        _ => Extent::None,
    };
    Operand { name, role, kind, stored: Stored::Source, extent, touches: &[] }
}

impl Operand {
    /// A value text follows.
    pub(crate) const fn valued(self) -> Operand {
        Operand { stored: Stored::SourceAndValue, ..self }
    }

    /// Only the value last displayed is stored.
    pub(crate) const fn snapshot(self) -> Operand {
        Operand { stored: Stored::Value, ..self }
    }

    /// A place in the box without content.
    pub(crate) const fn blank(self) -> Operand {
        Operand { stored: Stored::Blank, ..self }
    }

    pub(crate) const fn reaching(self, extent: Extent) -> Operand {
        Operand { extent, ..self }
    }

    pub(crate) const fn touching(self, touches: &'static [Touch]) -> Operand {
        Operand { touches, ..self }
    }
}

/// A member that is read.
pub(crate) const fn r(file_type: FileType, member: &'static str) -> Touch {
    Touch { file_type, member, role: Role::Read }
}

/// A member that is written.
pub(crate) const fn w(file_type: FileType, member: &'static str) -> Touch {
    Touch { file_type, member, role: Role::Write }
}

/// A member that is read and written.
pub(crate) const fn rw(file_type: FileType, member: &'static str) -> Touch {
    Touch { file_type, member, role: Role::ReadWrite }
}

/// An output drawn as a box, compiled in the order of its sources.
pub(crate) const fn form(opcode: u16, evidence: Evidence, families: Families, operands: &'static [Operand]) -> Form {
    Form { opcode: Some(opcode), evidence, ..manual(families, operands) }.with_code_seen()
}

/// A form of which only manuals tell.
pub(crate) const fn manual(families: Families, operands: &'static [Operand]) -> Form {
    let mut sources = 0;
    while sources < operands.len() && matches!(operands[sources].stored, Stored::Source | Stored::SourceAndValue) {
        sources += 1;
    }
    Form {
        opcode: None,
        evidence: Evidence::Manual,
        families,
        drawing: Drawing::Box { flags: &[] },
        position: Position::Output,
        operands,
        code_order: INDEXES.split_at(sources).0,
        code_seen: false,
        time_base: None,
        text: TextLevel::Assumed,
        stored_as: None,
    }
}

impl Form {
    /// One-at-a-time samples recorded the code of the instruction, not the bytes of its operands.
    const fn with_code_seen(self) -> Form {
        let seen = match self.evidence {
            Evidence::Printed | Evidence::Usage | Evidence::Inferred => true,
            Evidence::Samples | Evidence::Manual => self.operands.is_empty(),
        };
        Form { code_seen: seen, ..self }
    }

    pub(crate) const fn input(self) -> Form {
        Form { position: Position::Input, ..self }
    }

    pub(crate) const fn at(self, position: Position) -> Form {
        Form { position, ..self }
    }

    pub(crate) const fn contact(self, closed: bool) -> Form {
        Form { drawing: Drawing::Contact { closed }, position: Position::Input, ..self }
    }

    pub(crate) const fn coil(self, letters: &'static str) -> Form {
        Form { drawing: Drawing::Coil(letters), ..self }
    }

    pub(crate) const fn marked(self, letters: &'static str, position: Position) -> Form {
        Form { drawing: Drawing::Marked(letters), position, ..self }
    }

    pub(crate) const fn flags(self, flags: &'static [&'static str]) -> Form {
        Form { drawing: Drawing::Box { flags }, ..self }
    }

    pub(crate) const fn code(self, code_order: &'static [usize]) -> Form {
        Form { code_order, ..self }
    }

    pub(crate) const fn base(self, base: TimeBase) -> Form {
        Form { time_base: Some(base), ..self }
    }

    pub(crate) const fn text(self, text: TextLevel) -> Form {
        Form { text, ..self }
    }

    pub(crate) const fn with_code_of(self, other: &'static str) -> Form {
        Form { stored_as: Some(other), ..self }
    }
}
