//! The instructions of Do-more: what each does to the stack of booleans, what its operands are and how
//! well its text form is known. One place per instruction; every other part asks here.

mod table;

pub use table::TABLE;

/// One instruction.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// `TMR`, `STRGE`, ...
    pub mnemonic: &'static str,
    /// What the box or contact is called.
    pub title: &'static str,
    /// What it does to the stack of booleans.
    pub effect: Effect,
    /// Operands in the order of the text.
    pub operands: &'static [Operand],
    /// How many of the operands must be there; the others may be left out.
    pub required: usize,
    /// How well spelling, operand order and legs are known.
    pub evidence: Evidence,
    /// What it does, in a sentence.
    pub doc: &'static str,
}

/// What an instruction does to the stack of booleans that a rung works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// A contact.
    Contact {
        /// How it joins what is on the stack.
        join: Join,
        /// What it examines.
        test: Test,
    },
    /// `ANDSTR`: the two top values become one, in series.
    Series,
    /// `ORSTR`: the two top values become one, in parallel.
    Parallel,
    /// `NOT`, and one-shots of the power flow: the top value becomes another.
    Flow(Flow),
    /// `DUPBOOL`: pushes a copy of the top value.
    Duplicate,
    /// `POPBOOL`: drops the top value.
    Drop,
    /// A coil or box with one leg: executed with the top value, which stays.
    Output,
    /// A box with several legs, pushed in this order (top to bottom).
    Box {
        /// Names of the legs, top leg first.
        legs: &'static [&'static str],
    },
    /// Stands alone in its rung and takes no power flow: `SG`, `RET`, `FOR`, `NEXT`, `NOP`, ...
    Alone,
}

/// How a contact joins what is on the stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Join {
    /// `STR`: pushes.
    Push,
    /// `AND`: in series with the top.
    And,
    /// `OR`: in parallel with the top.
    Or,
}

/// What a contact examines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Test {
    /// The bit is ON.
    On,
    /// The bit is OFF.
    Off,
    /// The bit went from OFF to ON.
    Rise,
    /// The bit went from ON to OFF.
    Fall,
    /// The value differs from that of the previous scan.
    Change,
    /// Two values compare so.
    Compare(Relation),
}

/// A relation of two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// Equal.
    Equal,
    /// Not equal.
    NotEqual,
    /// Greater.
    Greater,
    /// Greater or equal.
    GreaterOrEqual,
    /// Less.
    Less,
    /// Less or equal.
    LessOrEqual,
}

impl Relation {
    /// The sign: `=`, `<>`, `>`, `>=`, `<`, `<=`.
    pub fn sign(self) -> &'static str {
        match self {
            Relation::Equal => "=",
            Relation::NotEqual => "<>",
            Relation::Greater => ">",
            Relation::GreaterOrEqual => ">=",
            Relation::Less => "<",
            Relation::LessOrEqual => "<=",
        }
    }
}

/// What becomes of the power flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Inverted.
    Invert,
    /// ON for one scan when it rises.
    Rise,
    /// ON for one scan when it falls.
    Fall,
}

/// One operand of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operand {
    /// Its name in the box.
    pub name: &'static str,
    /// What happens to it.
    pub role: Role,
    /// What it may be.
    pub kind: Kind,
    /// How far it reaches beyond the element it names.
    pub extent: Extent,
}

/// What an instruction does with an operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// Reads it.
    Read,
    /// Writes it.
    Write,
    /// Reads and writes it.
    ReadWrite,
    /// Resets it: a bit, or a timer or counter structure.
    Reset,
    /// The structure that the instruction owns: a timer's, a counter's.
    Own,
    /// A code block or stage that it starts, stops, calls or names.
    Refer,
    /// A number or word that says how the instruction works.
    Parameter,
}

/// What an operand may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A bit element.
    Bit,
    /// A numeric element or constant.
    Number,
    /// A bit or number.
    Value,
    /// A timer structure.
    Timer,
    /// A counter structure.
    Counter,
    /// A string element or a quoted text.
    Text,
    /// Another structure, such as PID or RAMPSOAK.
    Structure,
    /// A code block.
    CodeBlock,
    /// A stage: `Batch.S1`.
    Stage,
    /// A quoted MATH expression.
    Expression,
    /// A quoted table: `"3 src dst count ..."`, the number of columns first.
    Table(Table),
    /// A number whose bits are settings; mostly not decoded.
    Flags,
    /// A word from a fixed set.
    Word,
}

/// What the columns of a table operand are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Table {
    /// `src dst count`: copied.
    Copies,
    /// `flags src dst count`: copied.
    FlaggedCopies,
    /// `first last value`: written.
    Fills,
    /// Columns of which only the number is known.
    Unknown,
}

/// How far an operand reaches beyond the element it names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Extent {
    /// The element alone.
    One,
    /// Up to the element that this operand names.
    To(usize),
    /// As many elements as this operand says.
    Count(usize),
}

/// How well the text form of an instruction is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Evidence {
    /// Designer wrote it.
    Export,
    /// Text that someone imported into Designer.
    Imported,
    /// Named in the vendor's help; its text form follows from that.
    Help,
    /// Written by a public program that makes files for Designer.
    Generator,
    /// Follows from its siblings; stated nowhere that is known.
    Inferred,
}

impl Evidence {
    /// Lower-case word used in every output.
    pub fn as_str(self) -> &'static str {
        match self {
            Evidence::Export => "export",
            Evidence::Imported => "imported",
            Evidence::Help => "help",
            Evidence::Generator => "generator",
            Evidence::Inferred => "inferred",
        }
    }

    /// Whether Designer itself has written or read the form.
    pub fn is_confirmed(self) -> bool {
        self <= Evidence::Imported
    }
}

impl Entry {
    /// Number of legs on the stack of booleans: 0 for contacts and what stands alone.
    pub fn legs(&self) -> usize {
        match self.effect {
            Effect::Output => 1,
            Effect::Box { legs } => legs.len(),
            _ => 0,
        }
    }

    /// What happens to operand `index`.
    pub fn operand(&self, index: usize) -> Option<&'static Operand> {
        self.operands.get(index)
    }

    /// Executed with a power flow: a coil or box.
    pub fn is_output(&self) -> bool {
        matches!(self.effect, Effect::Output | Effect::Box { .. })
    }
}

/// The entry of a mnemonic, in any case of letters; `None` for an unknown instruction.
pub fn by_mnemonic(mnemonic: &str) -> Option<&'static Entry> {
    let mut upper = [0_u8; LONGEST];
    let upper = upper.get_mut(..mnemonic.len())?;
    upper.copy_from_slice(mnemonic.as_bytes());
    upper.make_ascii_uppercase();
    let index = table::SORTED.binary_search_by(|index| TABLE[*index].mnemonic.as_bytes().cmp(upper)).ok()?;
    table::SORTED.get(index).and_then(|index| TABLE.get(*index))
}

/// Longest mnemonic that is looked up.
const LONGEST: usize = 16;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mnemonic_is_found_once() {
        for entry in TABLE {
            let found = by_mnemonic(&entry.mnemonic.to_lowercase()).expect("found");
            assert_eq!(found.mnemonic, entry.mnemonic);
            let count = TABLE.iter().filter(|other| other.mnemonic == entry.mnemonic).count();
            assert_eq!(count, 1, "{} stands twice", entry.mnemonic);
            assert!(entry.mnemonic.len() <= LONGEST);
            assert!(entry.required <= entry.operands.len(), "{}", entry.mnemonic);
            assert!(!entry.doc.is_empty() && entry.doc.ends_with('.'), "{}", entry.mnemonic);
        }
        assert!(by_mnemonic("XIC").is_none() && by_mnemonic("").is_none());
        assert!(by_mnemonic(&"A".repeat(100)).is_none());
    }

    #[test]
    fn extents_name_operands_that_exist() {
        for entry in TABLE {
            for operand in entry.operands {
                if let Extent::To(index) | Extent::Count(index) = operand.extent {
                    assert!(index < entry.operands.len(), "{}", entry.mnemonic);
                }
            }
        }
    }

    #[test]
    fn legs_are_those_of_the_boxes() {
        let legs = |name| by_mnemonic(name).map(Entry::legs);
        for (name, expected) in [
            ("CNT", 2),
            ("CNTDN", 2),
            ("UDC", 3),
            ("UDCG", 2),
            ("TMRA", 2),
            ("TMRADOWN", 2),
            ("RAMPSOAK", 3),
            ("TMR", 1),
            ("STR", 0),
        ] {
            assert_eq!(legs(name), Some(expected), "{name}");
        }
    }
}
