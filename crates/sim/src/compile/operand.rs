//! Operands to places in the block.

use ladder::{Address, FileType, Number, Operand, Place};

use super::Compiler;
use crate::layout::{Location, Width, is_long, whole};
use crate::op::*;

/// Why an operand cannot be used; the text goes into a refusal.
pub(super) type Result<T> = std::result::Result<T, String>;

impl Compiler<'_> {
    /// A value that is read. Hex constants up to FFFF are words unless `long`.
    pub(super) fn source(&mut self, operand: Option<&Operand>, long: bool) -> Result<Source> {
        match operand {
            Some(Operand::Constant(constant)) => Ok(match constant.number() {
                Number::Float(value) => Source::Real(value),
                Number::Integer(value) if constant.is_hex() && !long => {
                    let bits = u32::try_from(value).unwrap_or(0);
                    Source::Integer(if bits <= 0xFFFF { i32::from(bits as u16 as i16) } else { bits as i32 })
                }
                Number::Integer(value) => Source::Integer(value as u32 as i32),
            }),
            Some(Operand::Address(address)) => match self.value(address)? {
                Place1::Direct(location) => match location.width {
                    Width::Word => Ok(Source::Word(location.word)),
                    Width::Long => Ok(Source::Long(location.word)),
                    Width::Float => Ok(Source::Float(location.word)),
                    Width::Bit => Err(format!("{address} is a bit, a value is needed")),
                    Width::Element => Err(format!("{address} is a structure, a value is needed")),
                },
                Place1::AtRun(reference) => Ok(Source::At(reference)),
            },
            other => Err(unusable(other, "a value")),
        }
    }

    /// A value that is written.
    pub(super) fn target(&mut self, operand: Option<&Operand>) -> Result<Target> {
        match self.source(operand, false)? {
            Source::Word(word) => Ok(Target::Word(word)),
            Source::Long(word) => Ok(Target::Long(word)),
            Source::Float(word) => Ok(Target::Float(word)),
            Source::At(reference) => Ok(Target::At(reference)),
            Source::Integer(_) | Source::Real(_) => Err("the destination is a constant".to_owned()),
        }
    }

    /// A value or, written with `#`, a file.
    pub(super) fn stepped(&mut self, operand: Option<&Operand>, long: bool) -> Result<Stepped> {
        match operand {
            Some(Operand::Address(address)) if address.indexed => Ok(Stepped::File(self.start(operand)?)),
            other => Ok(Stepped::Value(self.source(other, long)?)),
        }
    }

    pub(super) fn stepped_target(&mut self, operand: Option<&Operand>) -> Result<SteppedTarget> {
        match operand {
            Some(Operand::Address(address)) if address.indexed => Ok(SteppedTarget::File(self.start(operand)?)),
            other => Ok(SteppedTarget::Value(self.target(other)?)),
        }
    }

    pub(super) fn bit(&mut self, operand: Option<&Operand>) -> Result<BitAt> {
        let Some(Operand::Address(address)) = operand else { return Err(unusable(operand, "a bit")) };
        match self.value(address)? {
            Place1::Direct(Location { word, bit, width: Width::Bit, .. }) => Ok(BitAt::Direct { mask: 1 << bit, word }),
            Place1::Direct(_) => Err(format!("{address} is not a bit")),
            Place1::AtRun(reference) => match self.references.get(reference as usize) {
                Some(found) if found.bit.is_some() => Ok(BitAt::At(reference)),
                _ => Err(format!("{address} is not a bit")),
            },
        }
    }

    /// The first word of a file operand, element or block; a `#` is part of its spelling, not S:24.
    pub(super) fn start(&mut self, operand: Option<&Operand>) -> Result<Start> {
        let Some(Operand::Address(address)) = operand else { return Err(unusable(operand, "an address")) };
        let plain = Address { indexed: false, ..address.clone() };
        if plain.is_direct() {
            let location = self.layout.locate(&plain).ok_or_else(|| self.missing(&plain))?;
            let info = self.layout.files.get(location.file).ok_or_else(|| self.missing(&plain))?;
            let at = StartAt::Fixed { word: location.word, end: info.end() };
            return Ok(Start { at, size: info.size, kind: kind_of_file(info.file_type) });
        }
        let reference = self.reference(&plain)?;
        let size = self.size_of(address.file_type);
        Ok(Start { at: StartAt::At(reference), size, kind: kind_of_file(address.file_type) })
    }

    /// A timer, counter or control element.
    pub(super) fn element(&mut self, operand: Option<&Operand>, file_type: FileType) -> Result<Start> {
        match operand {
            Some(Operand::Address(address)) if address.file_type == file_type && address.bit.is_none() => {
                self.start(operand)
            }
            other => Err(unusable(other, file_type.description())),
        }
    }

    fn size_of(&self, file_type: FileType) -> u32 {
        let declared = self.layout.files.iter().find(|file| file.file_type == file_type).map(|file| file.size);
        declared.unwrap_or_else(|| u32::from(file_type.words_per_element().unwrap_or(1)))
    }

    fn value(&mut self, address: &Address) -> Result<Place1> {
        let indexed = address.indexed && self.traits.indexes();
        if address.indexed && !indexed {
            return Err(format!("{address}: this processor has no indexed addressing"));
        }
        if address.is_direct() {
            let location = self.layout.locate(address).ok_or_else(|| self.missing(address))?;
            return Ok(Place1::Direct(location));
        }
        self.reference(address).map(Place1::AtRun)
    }

    fn missing(&self, address: &Address) -> String {
        format!("{address} does not exist in the data table")
    }

    /// An entry of the reference table.
    fn reference(&mut self, address: &Address) -> Result<u32> {
        let file = self.part(&address.file)?;
        let element = self.part(&address.element)?;
        let bit = address.bit.as_ref().map(|bit| self.part(bit)).transpose()?;
        let sub = address.word.unwrap_or(0);
        let size = self.size_of(address.file_type);
        let width = match (&bit, address.word) {
            (Some(_), _) => Width::Bit,
            (None, Some(_)) if is_long(address.file_type, u32::from(sub)) => Width::Long,
            (None, Some(_)) => Width::Word,
            (None, None) => whole(address.file_type, size),
        };
        if matches!(file, Part::Fixed(number)
            if !address.file_type.has_slots() && self.layout.file(address.file_type, number).is_none())
        {
            return Err(format!("{address}: there is no such data file"));
        }
        let indexed = address.indexed && self.traits.indexes();
        self.references.push(Reference { file_type: address.file_type, file, element, sub, bit, indexed, width });
        Ok((self.references.len() - 1) as u32)
    }

    fn part(&mut self, place: &Place) -> Result<Part> {
        match place {
            Place::Number(number) => Ok(Part::Fixed(*number)),
            Place::Indirect(inner) if !inner.is_direct() => {
                Err(format!("[{inner}]: brackets in brackets, no processor has them"))
            }
            Place::Indirect(inner) => {
                let location = self.layout.locate(inner).ok_or_else(|| self.missing(inner))?;
                match location.width {
                    Width::Word => Ok(Part::Read(Source::Word(location.word))),
                    Width::Long => Ok(Part::Read(Source::Long(location.word))),
                    _ => Err(format!("[{inner}] is not a word")),
                }
            }
        }
    }

    /// The kind of number an operand gives.
    pub(super) fn kind_of(&self, source: Source) -> instr::exec::Width {
        use instr::exec::Width as Kind;
        match source {
            Source::Word(_) => Kind::Word,
            Source::Integer(value) if i16::try_from(value).is_ok() => Kind::Word,
            Source::Long(_) | Source::Integer(_) => Kind::Long,
            Source::Float(_) | Source::Real(_) => Kind::Float,
            Source::At(reference) => match self.references.get(reference as usize).map(|found| found.width) {
                Some(Width::Long) => Kind::Long,
                Some(Width::Float) => Kind::Float,
                _ => Kind::Word,
            },
        }
    }

    pub(super) fn kind_of_target(&self, target: Target) -> instr::exec::Width {
        self.kind_of(match target {
            Target::Word(at) => Source::Word(at),
            Target::Long(at) => Source::Long(at),
            Target::Float(at) => Source::Float(at),
            Target::At(reference) => Source::At(reference),
        })
    }

    /// The width of a value, for the choice between 16 and 32 bits.
    pub(super) fn is_long(&self, source: &Source) -> bool {
        match source {
            Source::Long(_) => true,
            Source::At(reference) => {
                self.references.get(*reference as usize).is_some_and(|found| found.width == Width::Long)
            }
            _ => false,
        }
    }
}

/// Where an address leads.
enum Place1 {
    Direct(Location),
    AtRun(u32),
}

pub(super) fn unusable(operand: Option<&Operand>, wanted: &str) -> String {
    match operand {
        None => format!("an operand is missing: {wanted}"),
        Some(Operand::Unset) => format!("an operand was never entered: {wanted}"),
        Some(Operand::Symbol(symbol)) => format!("symbol {symbol} has no address"),
        Some(other) => format!("{other} stands where {wanted} is needed"),
    }
}

fn kind_of_file(file_type: FileType) -> instr::exec::Width {
    match file_type {
        FileType::F => instr::exec::Width::Float,
        FileType::L => instr::exec::Width::Long,
        _ => instr::exec::Width::Word,
    }
}
