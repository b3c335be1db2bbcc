//! One instruction of the model to one operation.

use instr::by_mnemonic;
use instr::exec::function::Function;
use instr::exec::{coverage, expression};
use instr::parameters::time_base;
use ladder::{FileType, Instruction, Operand};

use super::Compiler;
use super::lacks::fits;
use super::operand::{Result, unusable};
use crate::op::*;

impl Compiler<'_> {
    /// Compiles one instruction; an error is why it cannot run.
    pub(super) fn translate(&mut self, instruction: &Instruction, rung_start: u32) -> Result<()> {
        let Some(name) = instruction.mnemonic.name() else {
            return Err(format!("operation code {} is not known", instruction.mnemonic));
        };
        let Some(entry) = by_mnemonic(name) else { return Err("the instruction is not known".to_owned()) };
        if !entry.families().contains(self.family()) {
            self.approximate(
                instruction,
                format!("{name} is not an instruction of this processor: it runs as on those that have it"),
            );
        }
        fits(instruction)?;
        self.lacks(instruction);
        if let Some(why) = coverage::undocumented(name) {
            return Err(why.to_owned());
        }
        if let Some(why) = coverage::approximation(name) {
            self.approximate(instruction, why);
        }
        let operands: Vec<Operand> =
            instruction.operands.iter().filter(|operand| **operand != Operand::Empty).cloned().collect();
        let given = Given { operands: &operands };
        match entry.category {
            instr::Category::Bit => self.bit_instruction(name, &given),
            instr::Category::Timer => self.timer(name, &given),
            instr::Category::Counter => self.counter(name, &given),
            instr::Category::Compare => self.compare(name, &given),
            instr::Category::Math | instr::Category::Conversion | instr::Category::Logic => self.math(name, &given),
            instr::Category::File | instr::Category::Sequencer => self.file(name, &given),
            instr::Category::Ascii => self.ascii(name, &given),
            instr::Category::ProgramControl => self.flow(name, &given, rung_start, instruction),
            instr::Category::Interrupt => self.interrupt(name, &given, rung_start, instruction),
            instr::Category::HighSpeed
            | instr::Category::Process
            | instr::Category::Clock
            | instr::Category::Communication
            | instr::Category::Storage => self.device(name, &given, instruction),
        }
    }

    pub(super) fn family(&self) -> ladder::Family {
        family_of(self.image, self.options)
    }

    pub(super) fn test(&mut self, block: Block) -> Result<()> {
        let block = self.block(block);
        self.push(Op::Test(block));
        Ok(())
    }

    pub(super) fn act(&mut self, block: Block) -> Result<()> {
        let block = self.block(block);
        self.push(Op::Do(block));
        Ok(())
    }

    pub(super) fn always(&mut self, block: Block) -> Result<()> {
        let block = self.block(block);
        self.push(Op::Always(block));
        Ok(())
    }

    fn bit_instruction(&mut self, name: &str, given: &Given<'_>) -> Result<()> {
        let bit = self.bit(given.at(0))?;
        if given.len() >= 2 {
            let output = self.bit(given.at(1))?;
            return match name {
                "OSF" => self.always(Block::Falling { storage: bit, output }),
                _ => self.always(Block::Rising { storage: bit, output }),
            };
        }
        match (name, bit) {
            ("OSF", _) => return Err(unusable(None, "an output bit")),
            ("OTE", _) => self.prescan.push(Prescan { bit, set: false }),
            ("ONS" | "OSR", _) => self.one_shots.push(bit),
            _ => {}
        }
        match (name, bit) {
            ("XIC", BitAt::Direct { mask, word }) => self.push(Op::Contact { invert: 0, mask, word }),
            ("XIO", BitAt::Direct { mask, word }) => self.push(Op::Contact { invert: 0xFFFF, mask, word }),
            ("OTE", BitAt::Direct { mask, word }) => self.push(Op::Ote { mask, word }),
            ("OTL", BitAt::Direct { mask, word }) => self.push(Op::Otl { mask, word }),
            ("OTU", BitAt::Direct { mask, word }) => self.push(Op::Otu { mask, word }),
            (_, BitAt::Direct { mask, word }) => self.push(Op::OneShot { mask, word }),
            ("XIC", bit) => return self.test(Block::Bit { bit, closed: false }),
            ("XIO", bit) => return self.test(Block::Bit { bit, closed: true }),
            ("OTE", bit) => return self.always(Block::Coil(bit)),
            ("OTL", bit) => return self.act(Block::Latch(bit)),
            ("OTU", bit) => return self.act(Block::Unlatch(bit)),
            (_, bit) => {
                // A one-shot remembers a false rung too, so it runs without power.
                let block = self.block(Block::OneShot(bit));
                self.push(Op::Always(block));
            }
        }
        Ok(())
    }

    fn timer(&mut self, name: &str, given: &Given<'_>) -> Result<()> {
        let start = self.element(given.at(0), FileType::T)?;
        let kind = match name {
            "TON" => TimerKind::On,
            "TOF" => TimerKind::Off,
            _ => TimerKind::Retentive,
        };
        let base = time_base(given.at(1)).or_else(|| self.stored_base(given.at(0)));
        let base = base.ok_or_else(|| unusable(given.at(1), "a time base"))?;
        match start.at {
            StartAt::Fixed { word, .. } => {
                let slot = self.slot_of(word).ok_or("the timer file has no such element")?;
                self.push(Op::Timer { kind, base, word, slot });
                Ok(())
            }
            StartAt::At(at) => self.always(Block::Timer { kind, base, at }),
        }
    }

    /// The base in the timer's own control word.
    fn stored_base(&self, operand: Option<&Operand>) -> Option<ladder::TimeBase> {
        let address = operand?.address()?;
        self.image.data_file(FileType::T, address.file.number()?)?.timer(address.element.number()?)?.base()
    }

    fn slot_of(&self, word: u32) -> Option<u32> {
        self.timer_slots.iter().find_map(|(file, first)| {
            let info = self.layout.files.get(*file)?;
            info.contains(word).then(|| first + (word - info.start) / info.size.max(1))
        })
    }

    fn counter(&mut self, name: &str, given: &Given<'_>) -> Result<()> {
        if name == "RES" {
            let Some(address) = given.at(0).and_then(Operand::address) else {
                return Err(unusable(given.at(0), "a timer, counter or control element"));
            };
            let file_type = address.file_type;
            if !matches!(file_type, FileType::T | FileType::C | FileType::R) {
                return Err(unusable(given.at(0), "a timer, counter or control element"));
            }
            let at = self.element(given.at(0), file_type)?;
            return self.act(Block::Reset { at, file_type });
        }
        let down = name == "CTD";
        let start = self.element(given.at(0), FileType::C)?;
        let mask = if down { 0x4000 } else { 0x8000 };
        match start.at {
            StartAt::Fixed { word, .. } => {
                self.prescan.push(Prescan { bit: BitAt::Direct { mask, word }, set: true });
                self.push(Op::Counter { down, word });
                Ok(())
            }
            StartAt::At(at) => self.always(Block::Counter { down, at }),
        }
    }

    fn compare(&mut self, name: &str, given: &Given<'_>) -> Result<()> {
        let relation = match name {
            "EQU" => Relation::Equal,
            "NEQ" => Relation::NotEqual,
            "LES" => Relation::Less,
            "LEQ" => Relation::LessOrEqual,
            "GRT" => Relation::Greater,
            "GEQ" => Relation::GreaterOrEqual,
            "MEQ" => {
                let long = self.any_long(given, &[0, 2])?;
                let source = self.source(given.at(0), long)?;
                let mask = self.source(given.at(1), long)?;
                let compare = self.source(given.at(2), long)?;
                return self.test(Block::MaskedEqual { source, mask, compare });
            }
            _ => {
                let long = self.any_long(given, &[0, 1, 2])?;
                let low = self.source(given.at(0), long)?;
                let test = self.source(given.at(1), long)?;
                let high = self.source(given.at(2), long)?;
                return self.test(Block::Limit { low, test, high });
            }
        };
        let long = self.any_long(given, &[0, 1])?;
        let (a, b) = (self.source(given.at(0), long)?, self.source(given.at(1), long)?);
        match (a, b) {
            (Source::Word(a), Source::Word(b)) => self.push(Op::CompareWords { relation, a, b }),
            (Source::Word(a), Source::Integer(value)) if i16::try_from(value).is_ok() => {
                self.push(Op::CompareConstant { relation, value: value as i16, a });
            }
            _ => return self.test(Block::Compare { relation, a, b }),
        }
        Ok(())
    }

    /// One of these operands is a long word, so hex constants beside it are 32 bits wide.
    pub(super) fn any_long(&mut self, given: &Given<'_>, operands: &[usize]) -> Result<bool> {
        let before = self.references.len();
        let mut long = false;
        for index in operands {
            if matches!(given.at(*index), Some(Operand::Address(_))) {
                let source = self.source(given.at(*index), false)?;
                long |= self.is_long(&source);
            }
        }
        self.references.truncate(before);
        Ok(long)
    }

    fn math(&mut self, name: &str, given: &Given<'_>) -> Result<()> {
        let unary = |name: &str| {
            Some(match name {
                "MOV" => Unary::Move,
                "NOT" => Unary::Not,
                "NEG" => Unary::Negate,
                "ABS" => Unary::Absolute,
                "SQR" => Unary::SquareRoot,
                "DCD" => Unary::Decode,
                "ENC" => Unary::Encode,
                "GCD" => Unary::GrayCode,
                _ => Unary::Function(Function::by_mnemonic(name)?),
            })
        };
        let binary = |name: &str| {
            Some(match name {
                "ADD" => Binary::Add,
                "SUB" => Binary::Subtract,
                "MUL" => Binary::Multiply,
                "DIV" => Binary::Divide,
                "XPY" => Binary::Power,
                "AND" => Binary::And,
                "OR" => Binary::Or,
                "XOR" => Binary::Xor,
                _ => return None,
            })
        };
        if let Some(op) = unary(name) {
            let long = self.any_long(given, &[0, 1])?;
            let (source, dest) = (self.source(given.at(0), long)?, self.target(given.at(1))?);
            return self.act(Block::Unary { op, source, dest });
        }
        if let Some(op) = binary(name) {
            let long = self.any_long(given, &[0, 1, 2])?;
            let a = self.source(given.at(0), long)?;
            let b = self.source(given.at(1), long)?;
            let dest = self.target(given.at(2))?;
            return self.act(Block::Binary { op, a, b, dest });
        }
        match name {
            "CLR" => {
                let dest = self.target(given.at(0))?;
                self.act(Block::Clear(dest))
            }
            "MVM" => {
                let long = self.any_long(given, &[0, 2])?;
                let source = self.source(given.at(0), long)?;
                let mask = self.source(given.at(1), long)?;
                let dest = self.target(given.at(2))?;
                self.act(Block::MaskedMove { source, mask, dest })
            }
            "TOD" => {
                let (source, dest) = (self.source(given.at(0), false)?, self.target(given.at(1))?);
                let register = self.is_math_register(given.at(1));
                self.act(Block::ToBcd { source, dest, register })
            }
            "FRD" => {
                let (source, dest) = (self.source(given.at(0), false)?, self.target(given.at(1))?);
                let register = self.is_math_register(given.at(0));
                self.act(Block::FromBcd { source, dest, register })
            }
            "DDV" => {
                let (source, dest) = (self.source(given.at(0), false)?, self.target(given.at(1))?);
                self.act(Block::DoubleDivide { source, dest })
            }
            "SCL" => {
                let source = self.source(given.at(0), false)?;
                let rate = self.source(given.at(1), false)?;
                let offset = self.source(given.at(2), false)?;
                let dest = self.target(given.at(3))?;
                self.act(Block::Scale { source, rate, offset, dest })
            }
            "SCP" => {
                let mut input = [Source::Integer(0); 5];
                for (index, place) in input.iter_mut().enumerate() {
                    *place = self.source(given.at(index), true)?;
                }
                let dest = self.target(given.at(5))?;
                self.act(Block::ScaleParameters { input, dest })
            }
            "CPT" => {
                let dest = self.target(given.at(0))?;
                let Some(Operand::Expression(expression)) = given.expression() else {
                    return Err(unusable(given.at(1), "an expression"));
                };
                let mut resolve = |operand: &Operand| self.source(Some(operand), true);
                let steps = expression::postfix(&expression, &mut resolve)?;
                if !expression::is_well_formed(&steps) {
                    return Err("the expression nests too deep".to_owned());
                }
                let kind = self.kind_of_target(dest);
                let float = expression::is_float(&steps, kind, |source| self.kind_of(*source));
                self.act(Block::Compute { steps, float, dest })
            }
            "SWP" => {
                let at = self.start(given.at(0))?;
                let length = self.source(given.at(1), false)?;
                self.act(Block::SwapBytes { at, length })
            }
            _ => Err("this instruction is not simulated".to_owned()),
        }
    }

    /// `S:13` as operand of TOD and FRD means the register pair.
    fn is_math_register(&self, operand: Option<&Operand>) -> bool {
        let wanted = self.layout.status + crate::status::MATH_LOW;
        let location = operand.and_then(Operand::address).and_then(|address| self.layout.locate(address));
        location
            .is_some_and(|location| location.word as usize == wanted && location.width == crate::layout::Width::Word)
    }

    fn flow(&mut self, name: &str, given: &Given<'_>, rung_start: u32, instruction: &Instruction) -> Result<()> {
        match name {
            "JMP" => {
                let label = given.label(0)?;
                self.jumps.push((self.ops.len(), label, self.here));
                self.push(Op::Jump(rung_start));
            }
            "LBL" => {
                let label = given.label(0)?;
                if self.labels.insert(label, rung_start).is_some() {
                    self.going_to_run.get_or_insert((crate::fault::code::LABEL, self.here));
                }
                self.push(Op::Marker);
            }
            "JSR" => {
                let file = given.program_file(0)?;
                if self.image.program_file(file).is_none_or(|f| f.kind != ladder::ProgramFileKind::Ladder) {
                    self.approximate(
                        instruction,
                        format!("program file {file} does not exist: fault 0031 when called"),
                    );
                    return self.act(Block::Unsupported);
                }
                self.push(Op::Call(u32::from(file)));
            }
            "SBR" => self.push(Op::Marker),
            "RET" => self.push(Op::Return),
            "MCR" => self.push(Op::Mcr),
            "TND" => self.push(Op::TempEnd),
            "END" => self.push(Op::End),
            "SUS" => {
                let code = given.number(0)?;
                self.push(Op::Suspend(code as i16));
            }
            "REF" => return self.act(Block::Refresh),
            "IIM" | "IOM" => return self.immediate(name == "IIM", given),
            _ => return Err("this instruction is not simulated".to_owned()),
        }
        Ok(())
    }

    /// Words of one slot, from the word named, as many as the length says.
    fn immediate(&mut self, input: bool, given: &Given<'_>) -> Result<()> {
        let file_type = if input { FileType::I } else { FileType::O };
        let (slot, first_word) = match given.at(0) {
            Some(Operand::Address(address)) if address.file_type == file_type => {
                (address.element.number(), address.word.unwrap_or(0))
            }
            Some(Operand::Constant(constant)) => (constant.as_integer().and_then(|slot| u16::try_from(slot).ok()), 0),
            other => return Err(unusable(other, "a slot")),
        };
        let slot = slot.ok_or("the slot is not a number")?;
        let mask = self.source(given.at(1), false)?;
        let length = if given.len() > 2 { given.number(2)?.clamp(1, 32) as u32 } else { 1 };
        let first = self.layout.io_word(file_type, slot, first_word);
        let first = first.ok_or_else(|| format!("{file_type}:{slot}.{first_word} does not exist"))?;
        let words = self.layout.slot_words(file_type, slot).filter(|word| *word >= first).count() as u32;
        let words = length.min(words);
        if input {
            self.act(Block::ImmediateInput { first, words, mask })
        } else {
            self.act(Block::ImmediateOutput { first, words, mask })
        }
    }
}

/// The operands of an instruction that are not blank.
pub(super) struct Given<'a> {
    operands: &'a [Operand],
}

impl Given<'_> {
    pub(super) fn at(&self, index: usize) -> Option<&Operand> {
        self.operands.get(index)
    }

    pub(super) fn len(&self) -> usize {
        self.operands.len()
    }

    /// A plain number.
    pub(super) fn number(&self, index: usize) -> Result<i64> {
        let constant = self.at(index).and_then(Operand::constant).and_then(|constant| constant.as_integer());
        constant.ok_or_else(|| unusable(self.at(index), "a number"))
    }

    fn label(&self, index: usize) -> Result<u16> {
        match self.at(index) {
            Some(Operand::Label { number, .. }) => Ok(*number),
            _ => u16::try_from(self.number(index)?).map_err(|_| "the label number is negative".to_owned()),
        }
    }

    fn program_file(&self, index: usize) -> Result<u16> {
        match self.at(index) {
            Some(Operand::ProgramFile(number)) => Ok(*number),
            _ => u16::try_from(self.number(index)?).map_err(|_| "the file number is negative".to_owned()),
        }
    }

    /// The expression of CPT; a single value counts as one.
    fn expression(&self) -> Option<Operand> {
        match self.at(1)? {
            expression @ Operand::Expression(_) => Some(expression.clone()),
            value @ (Operand::Address(_) | Operand::Constant(_)) => {
                Some(Operand::Expression(ladder::Expression::Value(Box::new(value.clone()))))
            }
            _ => None,
        }
    }
}
