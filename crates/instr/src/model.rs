//! What an entry of the instruction table says.

use ladder::{Family, FileType, TimeBase};

use crate::Families;

/// One instruction.
#[derive(Clone, Copy, Debug)]
pub struct Instruction {
    /// Upper-case mnemonic as drawn and as written in rung text.
    pub mnemonic: &'static str,
    /// Title in the box, as RSLogix prints it; the full name where the instruction is drawn as a symbol.
    pub title: &'static str,
    /// Where the title and the operand names of its box were read.
    pub names: Names,
    /// Group for lists and the reference page.
    pub category: Category,
    /// The ways it is stored: one per operation code, more where processors differ. Never empty.
    pub forms: &'static [Form],
    /// Addresses outside the operands that it writes when it executes: arithmetic flags, math
    /// register, index register, error bits. Which of them applies depends on the processor.
    pub status: &'static [&'static str],
    /// What it does, in one to three sentences, for help and tooltips.
    pub doc: &'static str,
}

impl Instruction {
    /// Forms for processors of `family`, in table order.
    pub fn forms_for(&self, family: Family) -> impl Iterator<Item = &'static Form> {
        self.forms.iter().filter(move |form| form.families.contains(family))
    }

    /// The form a program text for `family` means, when that text has `operands` operands.
    ///
    /// Falls back to other families' forms, because a text can name an instruction its processor does
    /// not have; such a program must still be readable.
    pub fn form_for(&self, family: Family, operands: usize) -> Option<&'static Form> {
        let fits = |form: &&'static Form| form.text_operands().accepts(operands);
        self.forms_for(family).find(fits).or_else(|| self.forms.iter().find(fits))
    }

    /// The form of a timer with this time base.
    pub fn form_with_time_base(&self, base: TimeBase) -> Option<&'static Form> {
        self.forms.iter().find(|form| form.time_base == Some(base))
    }

    /// All families that have some form of it.
    pub fn families(&self) -> Families {
        self.forms.iter().fold(Families::NONE, |all, form| all | form.families)
    }
}

/// One way an instruction is stored.
#[derive(Clone, Copy, Debug)]
pub struct Form {
    /// Operation code; `None` when no project with this form has been seen.
    pub opcode: Option<u16>,
    /// How the code is known.
    pub evidence: Evidence,
    /// Processors with this form.
    pub families: Families,
    /// How it is drawn.
    pub drawing: Drawing,
    /// Where it may stand in a rung.
    pub position: Position,
    /// Operands in the order of the box, which is also the order of the stored texts and of rung text.
    pub operands: &'static [Operand],
    /// Operands the compiled code holds, in its order, as indexes into `operands`. For CPT the
    /// expression is compiled into steps instead and this is empty.
    pub code_order: &'static [usize],
    /// `code_order` agrees with compiled code of real projects. `false`: assumed from the order in the
    /// box or from a related instruction.
    pub code_seen: bool,
    /// Time base this code stands for (TON, TOF, RTO).
    pub time_base: Option<TimeBase>,
    /// How well its spelling in rung text is known.
    pub text: TextLevel,
    /// RSLogix stores this instruction with the code of another one, which a stored code then stands
    /// for as well (AWT as AWA).
    pub stored_as: Option<&'static str>,
}

impl Form {
    /// Number of texts a stored instruction of this form has: operands, plus a value text for those
    /// that are displayed with one.
    pub fn string_count(&self) -> usize {
        self.operands.iter().map(|operand| operand.stored.strings()).sum()
    }

    /// Which operand the stored text number `string` belongs to, and whether it is its value text.
    pub fn operand_of_string(&self, string: usize) -> Option<(usize, bool)> {
        let mut first = 0;
        for (index, operand) in self.operands.iter().enumerate() {
            let next = first + operand.stored.strings();
            if string < next {
                return Some((index, string > first));
            }
            first = next;
        }
        None
    }

    /// How many operands follow the mnemonic in rung text.
    pub fn text_operands(&self) -> TextCount {
        let count = self.operands.iter().filter(|operand| operand.in_text()).count();
        match self.operands.last() {
            _ if self.text == TextLevel::Unknown => TextCount::Unknown { at_least: count },
            Some(last) if matches!(last.kind, Kind::Expression) => TextCount::Expression { before: count - 1 },
            _ => TextCount::Exactly(count),
        }
    }
}

/// How many operands an instruction has in rung text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextCount {
    /// Always this many tokens.
    Exactly(usize),
    /// This many tokens, then an expression that ends where it cannot continue.
    Expression {
        /// Tokens before the expression.
        before: usize,
    },
    /// What RSLogix writes has not been seen: a rung with it is ambiguous and stays text.
    Unknown {
        /// Operands of the box.
        at_least: usize,
    },
}

impl TextCount {
    /// `operands` operands can be meant, an expression counting as one.
    pub fn accepts(self, operands: usize) -> bool {
        match self {
            TextCount::Exactly(count) => operands == count,
            TextCount::Expression { before } => operands == before + 1,
            TextCount::Unknown { at_least } => operands == at_least,
        }
    }
}

/// One operand of a form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operand {
    /// Name as printed in the box; a plain word where nothing is printed (`Bit` of a contact).
    pub name: &'static str,
    /// What the instruction does with the data it names.
    pub role: Role,
    /// What may stand here.
    pub kind: Kind,
    /// How it is stored and displayed.
    pub stored: Stored,
    /// How much of the data table it reaches, from the address it names.
    pub extent: Extent,
    /// Members of the named element that are read or written without being named. Members of other
    /// types than the one named do not apply (RES on a timer touches no `CU`).
    pub touches: &'static [Touch],
}

impl Operand {
    /// A value text follows the source text in a stored instruction.
    pub fn has_value(&self) -> bool {
        self.stored == Stored::SourceAndValue
    }

    /// It is written in rung text.
    pub fn in_text(&self) -> bool {
        self.stored != Stored::Blank
    }

    /// It is compiled program content: neither a placeholder nor a snapshot of data.
    pub fn is_source(&self) -> bool {
        matches!(self.stored, Stored::Source | Stored::SourceAndValue)
    }
}

/// A member of a structured element that an instruction uses without naming it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Touch {
    /// Type of element it applies to.
    pub file_type: FileType,
    /// Member as RSLogix spells it.
    pub member: &'static str,
    /// What happens to it.
    pub role: Role,
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
    /// A number, name or setting: no data is reached through it.
    Parameter,
}

impl Role {
    /// Data is read.
    pub const fn reads(self) -> bool {
        matches!(self, Role::Read | Role::ReadWrite)
    }

    /// Data is written.
    pub const fn writes(self) -> bool {
        matches!(self, Role::Write | Role::ReadWrite)
    }

    /// `read`, `write`, `read/write`, `parameter`.
    pub const fn as_str(self) -> &'static str {
        match self {
            Role::Read => "read",
            Role::Write => "write",
            Role::ReadWrite => "read/write",
            Role::Parameter => "parameter",
        }
    }
}

/// What may stand as an operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A bit address.
    Bit,
    /// A numeric value: word, long word or float address, or a constant where it is only read.
    Word,
    /// A mask: word address or hexadecimal constant.
    Mask,
    /// A timer element.
    Timer,
    /// A counter element.
    Counter,
    /// A control element.
    Control,
    /// A timer, counter or control element.
    Resettable,
    /// A file address, written with `#`.
    File,
    /// A word address that becomes a file address when written with `#`.
    WordOrFile,
    /// A string element.
    String,
    /// A label, stored `Q2:1`, drawn above the symbol.
    Label,
    /// A program file, stored `U:3`, plain `3` in rung text.
    ProgramFile,
    /// A plain number.
    Constant,
    /// `1.0`, `0.01` or `0.001` seconds per tick.
    TimeBase,
    /// Preset of the element named before it.
    Preset,
    /// Accumulator of the element named before it.
    Accum,
    /// Number of elements, words or bits.
    Length,
    /// Position of the control element named before it.
    Position,
    /// An expression of CPT.
    Expression,
    /// A high-speed counter, `HSC0`.
    HscNumber,
    /// A pulse train output, `0`.
    PtoNumber,
    /// A pulse width modulation output, `0`.
    PwmNumber,
    /// A PID element, or a block of integers on SLC 500.
    PidBlock,
    /// A message element, or a block of integers on SLC 500.
    MessageBlock,
    /// A routing information element.
    RoutingBlock,
    /// Start of a block of words used by a control instruction.
    ControlBlock,
    /// A slot number or an I/O word of the slot: input words for IIM, output words for IOM.
    Slot,
    /// A slot mask or list.
    Slots,
    /// A communication channel.
    Channel,
    /// A bit mask of interrupt sources.
    InterruptTypes,
    /// A data log queue.
    QueueNumber,
    /// A recipe file.
    RecipeFile,
    /// A value chosen from a list (`Yes`, `Load`, `Local`).
    Choice,
    /// A status the box displays and nobody enters.
    Display,
    /// Text in the box that leads to a dialog and holds nothing.
    SetupScreen,
    /// Stored, but what it is has not been established.
    Unidentified,
}

/// How an operand is stored and displayed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stored {
    /// One text: what was entered.
    Source,
    /// Two texts: what was entered, then the value last displayed.
    SourceAndValue,
    /// One text: the value last displayed, a snapshot of a data element. In an instruction that was
    /// never compiled it is the value entered.
    Value,
    /// One text without program content.
    Blank,
}

impl Stored {
    /// Texts it takes in a stored instruction.
    pub const fn strings(self) -> usize {
        match self {
            Stored::SourceAndValue => 2,
            Stored::Source | Stored::Value | Stored::Blank => 1,
        }
    }
}

/// How much of the data table an operand reaches, counted from the address it names.
/// `length` is the index of the operand that gives the count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Extent {
    /// No data.
    None,
    /// One bit.
    Bit,
    /// The one word, long word or float named.
    Value,
    /// The whole structured element named.
    Element,
    /// One string: its length word and characters.
    String,
    /// As many elements as operand `length` says, each of the size of the elements operand `size_of`
    /// names (COP counts elements of its destination, on both sides).
    Elements {
        /// Operand with the count.
        length: usize,
        /// Operand whose element size counts.
        size_of: usize,
    },
    /// One element more than operand `length` says: a sequencer file has its step 0 before step 1.
    Steps {
        /// Operand with the number of steps.
        length: usize,
    },
    /// The value named, or as a sequencer file when written with `#`.
    ValueOrSteps {
        /// Operand with the number of steps.
        length: usize,
    },
    /// As many words as operand `length` says.
    Words {
        /// Operand with the count.
        length: usize,
    },
    /// As many bits as operand `length` says, from bit 0 of the word named.
    Bits {
        /// Operand with the count.
        length: usize,
    },
    /// A fixed number of words.
    Block {
        /// Words.
        words: u16,
    },
    /// A block whose size depends on the set-up.
    Open,
}

/// How the operation code of a form is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Evidence {
    /// The form stands in manuals; no project with it has been seen.
    Manual,
    /// Fits in operands and neighbouring codes; never printed beside its code.
    Inferred,
    /// One instruction at a time was saved by RSLogix and its code recorded.
    Samples,
    /// As `Samples`, and real projects use it with the same operands.
    Usage,
    /// Reports printed by RSLogix name it on rungs whose stored code is known.
    Printed,
}

impl Evidence {
    /// Lower-case word.
    pub const fn as_str(self) -> &'static str {
        match self {
            Evidence::Manual => "manual",
            Evidence::Inferred => "inferred",
            Evidence::Samples => "samples",
            Evidence::Usage => "usage",
            Evidence::Printed => "printed",
        }
    }
}

/// Where title and operand names were read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Names {
    /// In a report printed by RSLogix.
    Printout,
    /// In a manual that shows the box.
    Manual,
    /// In neither: the usual name, its exact wording unconfirmed.
    Unconfirmed,
}

/// How well the spelling of a form in rung text is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextLevel {
    /// Used in complete files written by RSLogix.
    Seen,
    /// In rungs quoted from RSLogix.
    Quoted,
    /// Operand count from published readers of the format.
    Published,
    /// Assumed: operands in the order of the box.
    Assumed,
    /// Not known: what is written differs from the operands of the box.
    Unknown,
}

/// How an instruction is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Drawing {
    /// A contact, `] [` or `]/[`.
    Contact {
        /// Examines for 0.
        closed: bool,
    },
    /// A coil with letters inside: none (OTE), `L`, `U`, `RES`, `JMP`.
    Coil(&'static str),
    /// Letters in a contact: `[OSR]`, `]LBL[`.
    Marked(&'static str),
    /// A box with title and operands, and status flags at its right edge.
    Box {
        /// Flags from top to bottom.
        flags: &'static [&'static str],
    },
}

/// Where an instruction may stand in a rung.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Position {
    /// A condition.
    Input,
    /// A condition that is always true and stands first in its rung.
    RungStart,
    /// An output.
    Output,
    /// Alone in the last rung of a file.
    FileEnd,
}

/// Groups of instructions, in the order of the reference page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)] // `title` says what each group is
pub enum Category {
    Bit,
    Timer,
    Counter,
    Compare,
    Math,
    Conversion,
    Logic,
    File,
    Sequencer,
    Ascii,
    ProgramControl,
    Interrupt,
    HighSpeed,
    Process,
    Clock,
    Communication,
    Storage,
}

impl Category {
    /// All groups in order.
    pub const ALL: [Category; 17] = [
        Category::Bit,
        Category::Timer,
        Category::Counter,
        Category::Compare,
        Category::Math,
        Category::Conversion,
        Category::Logic,
        Category::File,
        Category::Sequencer,
        Category::Ascii,
        Category::ProgramControl,
        Category::Interrupt,
        Category::HighSpeed,
        Category::Process,
        Category::Clock,
        Category::Communication,
        Category::Storage,
    ];

    /// Heading of the group.
    pub const fn title(self) -> &'static str {
        match self {
            Category::Bit => "Bit",
            Category::Timer => "Timer",
            Category::Counter => "Counter",
            Category::Compare => "Compare",
            Category::Math => "Math",
            Category::Conversion => "Conversion",
            Category::Logic => "Move and logical",
            Category::File => "File",
            Category::Sequencer => "Sequencer",
            Category::Ascii => "ASCII and string",
            Category::ProgramControl => "Program control",
            Category::Interrupt => "Interrupt",
            Category::HighSpeed => "High speed",
            Category::Process => "Process control",
            Category::Clock => "Clock and time",
            Category::Communication => "Communication",
            Category::Storage => "Data log, recipe, display and checksum",
        }
    }
}
