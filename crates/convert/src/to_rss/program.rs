//! Rungs to `PROGRAM FILES`: structure becomes marks, operands become texts and code.

use std::borrow::Cow;

use instr::{Form, Instruction as Definition, Stored};
use ladder::{
    Address, Constant, Element, Family, FileType, Image, Instruction, Mnemonic, Operand, ProgramFile, ProgramFileKind,
    Rung, TimeBase, Value,
};
use rss::program::{self, Branch, Item, LadFile, Leg, ProgramFiles, mark};
use rss::{Error, Result, Text};

use super::documentation::CommentWriter;
use super::{Notes, owned, text};
use crate::{code, message};

pub(super) fn files<'a>(image: &'a Image, comments: &mut CommentWriter, notes: &mut Notes) -> Result<ProgramFiles<'a>> {
    let mut writer = ProgramWriter { image, comments, notes };
    let last = image.program_files.iter().map(|file| file.number).max().unwrap_or(2).max(2);
    let mut files = Vec::with_capacity(usize::from(last) + 1);
    for number in 0..=last {
        files.push(match image.program_file(number) {
            Some(file) => writer.file(file)?,
            // Files 0 and 1 always exist; gaps above are unused numbers.
            None => LadFile { number, flags: if number == 0 { 0 } else { unused_flags(number) }, ..LadFile::default() },
        });
    }
    Ok(ProgramFiles { files })
}

pub(super) fn unused_flags(number: u16) -> u16 {
    LadFile::NO_PROGRAM | if number < 2 { 0 } else { LadFile::LADDER }
}

/// The name in its ten bytes.
pub(super) fn stored_name(file: &ProgramFile) -> Result<[u8; 10]> {
    let place = format!("program file {}", file.number);
    let bytes = rss::text::encode(&file.name).map_err(|c| Error::Unwritable(format!("{place}: {c:?} in its name")))?;
    let mut name = [0; 10];
    match name.get_mut(..bytes.len()) {
        Some(start) => start.copy_from_slice(&bytes),
        None => {
            return Err(Error::Unwritable(format!("{place}: name `{}` has more than 10 characters", file.name)));
        }
    }
    Ok(name)
}

struct ProgramWriter<'n> {
    image: &'n Image,
    comments: &'n mut CommentWriter,
    notes: &'n mut Notes,
}

impl ProgramWriter<'_> {
    fn file<'a>(&mut self, file: &'a ProgramFile) -> Result<LadFile<'a>> {
        let place = format!("program file {}", file.number);
        let name = stored_name(file)?;
        let mut rungs = Vec::with_capacity(file.rungs.len() + 1);
        for (index, rung) in file.rungs.iter().enumerate() {
            if rung.is_end() && index + 1 < file.rungs.len() {
                let more = file.rungs.len() - index - 1;
                return Err(Error::Unwritable(format!("{place}: {more} rungs after END in rung {index}")));
            }
            rungs.push(self.rung(rung, file.number, index)?);
        }
        let ends = file.rungs.last().is_some_and(Rung::is_end);
        if file.kind == ProgramFileKind::Ladder && !ends {
            rungs.push(end_rung());
        }
        let rung_count = u16::try_from(rungs.len())
            .map_err(|_| Error::Unwritable(format!("{place}: {} rungs, a file holds 65,535", rungs.len())))?;
        let flags = match file.kind {
            ProgramFileKind::Ladder => LadFile::LADDER,
            ProgramFileKind::System if file.number == 0 => 0,
            ProgramFileKind::System | ProgramFileKind::Unused => unused_flags(file.number),
        };
        let description = text(&file.description)?;
        Ok(LadFile { rung_count, flags, name, number: file.number, description, rungs })
    }

    fn rung<'a>(&mut self, rung: &'a Rung, file: u16, index: usize) -> Result<program::Rung<'a>> {
        let place = format!("file {file} > rung {index}");
        let comment_id = match &rung.comment {
            Some(comment) => self.comments.id(comment, file, index)?,
            None => 0,
        };
        let leg = self.leg(&rung.series, [mark::RUNG_START, mark::RUNG_END], &place)?;
        Ok(program::Rung { leg, unknown_0: 0, edited: u32::from(rung.edited), comment_id })
    }

    fn leg<'a>(&mut self, series: &'a [Element], [open, close]: [u16; 2], place: &str) -> Result<Leg<'a>> {
        let mut items = vec![mark_item(open)];
        for element in series {
            items.push(match element {
                Element::Instruction(instruction) => Item::Instruction(self.instruction(instruction, place)?),
                Element::Branch(branch) => {
                    let mut legs = vec![mark_item(mark::BRANCH_START)];
                    for leg in &branch.legs {
                        legs.push(Item::Leg(self.leg(leg, [mark::LEG_START, mark::LEG_END], place)?));
                    }
                    legs.push(mark_item(mark::BRANCH_END));
                    Item::Branch(Branch { items: legs })
                }
            });
        }
        items.push(mark_item(close));
        Ok(Leg { items })
    }

    fn instruction<'a>(&mut self, instruction: &'a Instruction, place: &str) -> Result<program::Instruction<'a>> {
        let name = match &instruction.mnemonic {
            Mnemonic::Named(name) => name,
            Mnemonic::Unknown(opcode) => {
                let operands = instruction.operands.iter().map(|operand| owned(operand.to_string()));
                self.notes.warning(place, format!("operation code {opcode:#04x} is written without compiled code"));
                return Ok(program::Instruction {
                    operands: operands.collect::<Result<_>>()?,
                    opcode: *opcode,
                    ..program::Instruction::default()
                });
            }
        };
        let definition = instr::by_mnemonic(name)
            .ok_or_else(|| Error::Unwritable(format!("{place}: {name} is no instruction of these processors")))?;
        let form = form(definition, instruction, self.image.family()).ok_or_else(|| {
            Error::Unwritable(format!("{place}: {name} with {} operands has no known form", instruction.operands.len()))
        })?;
        let Some(opcode) = form.opcode else {
            return Err(Error::Unwritable(format!("{place}: the operation code of {name} is not known")));
        };
        for number in instruction.operands.iter().filter_map(called) {
            if self.image.ladder_files().all(|file| file.number != number) {
                self.notes.warning(place, format!("{name} {number}: there is no such program file"));
            }
        }
        let message = instruction.message.as_deref().map(message::record).transpose()?;
        let lacks_setup = definition.mnemonic == "MSG" && message.is_none();
        let code = match code::compile(definition, form, instruction) {
            Ok(_) if lacks_setup => {
                self.notes
                    .warning(place, "MSG is written without compiled code: its set-up is not known, enter it again");
                None
            }
            Ok(code) => Some(code),
            Err(why) => {
                self.notes.warning(place, format!("{name} is written without compiled code: {why}"));
                None
            }
        };
        Ok(program::Instruction {
            operands: texts(self.image, definition, form, instruction, code.as_deref())?.into(),
            has_code: u16::from(code.is_some()),
            opcode,
            code: Cow::Owned(code.unwrap_or_default()),
            message: message.map(Box::new),
            ..program::Instruction::default()
        })
    }
}

/// The program file an operand names.
fn called(operand: &Operand) -> Option<u16> {
    match operand {
        Operand::ProgramFile(number) => Some(*number),
        _ => None,
    }
}

/// The rung that ends a program file.
fn end_rung() -> program::Rung<'static> {
    let opcode = instr::by_mnemonic("END").and_then(|end| end.forms.first()?.opcode).unwrap_or_default();
    let end = program::Instruction {
        has_code: 1,
        opcode,
        code: opcode.to_le_bytes().into_iter().take(1).collect(),
        ..program::Instruction::default()
    };
    let items = vec![mark_item(mark::RUNG_START), Item::Instruction(end), mark_item(mark::RUNG_END)];
    program::Rung { leg: Leg { items }, ..program::Rung::default() }
}

fn mark_item(opcode: u16) -> Item<'static> {
    Item::Instruction(program::Instruction { opcode, ..program::Instruction::default() })
}

/// The form to store: by time base for timers, by destination and routing for MSG, by number of
/// operands and family for the rest.
pub(crate) fn form(
    definition: &'static Definition,
    instruction: &Instruction,
    family: Family,
) -> Option<&'static Form> {
    let fits = |form: &&Form| form.operands.len() == instruction.operands.len();
    let base = instruction.operands.get(1).and_then(|operand| TimeBase::from_text(&operand.to_string()));
    if definition.forms.iter().any(|form| form.time_base.is_some()) {
        return definition.form_with_time_base(base?).filter(fits);
    }
    definition.forms_for(family).find(|f| fits(f) && f.opcode.is_some()).or_else(|| definition.forms.iter().find(fits))
}

/// Operand texts, each source followed by its displayed value where the form has one.
fn texts<'a>(
    image: &Image,
    definition: &Definition,
    form: &Form,
    instruction: &'a Instruction,
    code: Option<&[u8]>,
) -> Result<Vec<Text<'a>>> {
    let mut texts = Vec::with_capacity(form.string_count());
    for (index, (operand_definition, operand)) in form.operands.iter().zip(&instruction.operands).enumerate() {
        texts.push(match operand {
            // Stored with a blank at both ends.
            Operand::Expression(expression) => owned(format!(" {expression} "))?,
            Operand::Symbol(symbol) => text(symbol)?,
            other => owned(other.to_string())?,
        });
        if operand_definition.stored == Stored::SourceAndValue {
            let shown = instruction.displayed(index).map(str::to_owned);
            let value = shown.or_else(|| match operand {
                Operand::Constant(constant) => Some(constant_value(form, index, constant, code)),
                Operand::Address(address) => address_value(image, definition, address),
                _ => None,
            });
            texts.push(owned(value.unwrap_or_else(|| "?".to_owned()))?);
        }
    }
    Ok(texts)
}

/// A constant repeats itself as the instruction sees it, which is how a reader tells `10` from
/// `10.0`.
fn constant_value(form: &Form, index: usize, constant: &Constant, code: Option<&[u8]>) -> String {
    let compiled = || {
        let position = form.code_order.iter().position(|operand| *operand == index)?;
        match rss::code::Code::decode(code?).ok()? {
            rss::code::Code::Operands { operands, .. } => operands.get(position).cloned(),
            rss::code::Code::Expression(_) => None,
        }
    };
    match compiled() {
        Some(rss::code::Operand::Float(bits)) => ladder::format_float(f32::from_bits(bits)),
        _ => constant.text().to_owned(),
    }
}

/// The value in the data table that is written along, in the notation of the box: hexadecimal for
/// the logical instructions. `None` where that notation is not known.
fn address_value(image: &Image, definition: &Definition, address: &Address) -> Option<String> {
    let hex = matches!(definition.mnemonic, "AND" | "OR" | "XOR" | "NOT");
    match image.value_at(address).filter(|_| address.is_direct())? {
        Value::Word(word) if hex => Some(format!("{word:04X}h")),
        Value::Long(long) if hex => Some(format!("{long:08X}h")),
        Value::Word(word) => Some(word.to_string()),
        Value::Long(long) => Some(long.to_string()),
        Value::Float(float) => Some(ladder::format_float(float)),
        _ => None,
    }
}

/// Addresses that instructions of the image name directly, each with the words the instruction reaches
/// from there: for tables that must exist before the program can run.
pub(crate) fn addresses(image: &Image) -> impl Iterator<Item = (&Address, u32)> {
    fn of_operand<'a>(operand: &'a Operand, words: u32, found: &mut Vec<(&'a Address, u32)>) {
        match operand {
            Operand::Address(address) => push(address, words, found),
            Operand::Expression(expression) => {
                for operand in expression.operands() {
                    of_operand(operand, 1, found);
                }
            }
            _ => {}
        }
    }
    fn push<'a>(address: &'a Address, words: u32, found: &mut Vec<(&'a Address, u32)>) {
        found.push((address, words));
        for inner in address.indirections() {
            push(inner, 1, found);
        }
    }
    instructions(image).flat_map(|instruction| {
        let mut found = Vec::new();
        for (index, operand) in instruction.operands.iter().enumerate() {
            of_operand(operand, instr::parameters::words(instruction, index, image.family()), &mut found);
        }
        found.retain(|(address, _)| !matches!(address.file_type, FileType::Unknown(_)));
        found
    })
}

/// Every instruction of the image, in the order of files and rungs.
pub(crate) fn instructions(image: &Image) -> impl Iterator<Item = &Instruction> {
    image.program_files.iter().flat_map(|file| &file.rungs).flat_map(Rung::instructions)
}
