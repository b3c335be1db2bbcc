//! Operation codes that shape a rung and are no instructions: rung ends, branches, branch legs.
//!
//! They carry no operands. Written as text the leg marks vanish: a new leg is `NXB`.

/// Start of a rung.
pub const SOR: u16 = 0;
/// End of a rung.
pub const EOR: u16 = 1;
/// Start of a branch.
pub const BST: u16 = 2;
/// End of a branch.
pub const BND: u16 = 3;
/// Start of a leg of a branch.
pub const LEG_START: u16 = 4;
/// End of a leg of a branch.
pub const LEG_END: u16 = 5;

/// One structural code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mark {
    /// The operation code.
    pub opcode: u16,
    /// The word rung text uses, where it has one.
    pub text: Option<&'static str>,
    /// What the mark does.
    pub meaning: &'static str,
}

/// The codes with their words, ascending.
pub const MARKS: [Mark; 6] = [
    Mark { opcode: SOR, text: Some("SOR"), meaning: "start of rung" },
    Mark { opcode: EOR, text: Some("EOR"), meaning: "end of rung" },
    Mark { opcode: BST, text: Some("BST"), meaning: "branch start" },
    Mark { opcode: BND, text: Some("BND"), meaning: "branch end" },
    Mark { opcode: LEG_START, text: None, meaning: "start of a branch leg" },
    Mark { opcode: LEG_END, text: None, meaning: "end of a branch leg" },
];

/// The word between two legs of a branch in rung text; no single stored code stands for it.
pub const NXB: &str = "NXB";

/// `opcode` shapes the rung instead of being an instruction.
pub const fn is_structural(opcode: u16) -> bool {
    opcode <= LEG_END
}
