//! File, sequencer and string instructions.

use instr::exec::stack::Order;
use ladder::{FileType, Operand};

use super::Compiler;
use super::instruction::Given;
use super::operand::Result;
use crate::op::*;

impl Compiler<'_> {
    pub(super) fn file(&mut self, name: &str, given: &Given<'_>) -> Result<()> {
        match name {
            "COP" | "CPW" => {
                let (source, dest) = (self.start(given.at(0))?, self.start(given.at(1))?);
                let length = self.source(given.at(2), false)?;
                self.act(Block::Copy { source, dest, length, words: name == "CPW" })
            }
            "FLL" => {
                let dest = self.start(given.at(1))?;
                let length = self.source(given.at(2), false)?;
                if self.is_element(given.at(0)) {
                    let source = self.start(given.at(0))?;
                    return self.act(Block::FillElement { source, dest, length });
                }
                let source = self.source(given.at(0), dest.kind == instr::exec::Width::Long)?;
                self.act(Block::Fill { source, dest, length })
            }
            "BSL" | "BSR" => {
                let file = self.start(given.at(0))?;
                let control = self.element(given.at(1), FileType::R)?;
                let bit = self.bit(given.at(2))?;
                self.always(Block::Shift { left: name == "BSL", file, control, bit })
            }
            "FFL" | "LFL" => {
                let long = self.any_long(given, &[0])? || self.is_long_file(given, 1);
                let source = self.source(given.at(0), long)?;
                let file = self.start(given.at(1))?;
                let control = self.element(given.at(2), FileType::R)?;
                self.always(Block::Load { source, file, control, long: self.is_long_file(given, 1) })
            }
            "FFU" | "LFU" => {
                let file = self.start(given.at(0))?;
                let dest = self.target(given.at(1))?;
                let control = self.element(given.at(2), FileType::R)?;
                let long = self.is_long_file(given, 0);
                let order = if name == "LFU" { Order::LastIn } else { Order::FirstIn };
                self.always(Block::Unload { order, file, dest, control, long })
            }
            "SQO" => {
                let file = self.start(given.at(0))?;
                let long = self.is_long_file(given, 0) || self.is_long_file(given, 2);
                let mask = self.stepped(given.at(1), long)?;
                let dest = self.stepped_target(given.at(2))?;
                let control = self.element(given.at(3), FileType::R)?;
                self.always(Block::SequencerOutput { file, mask, dest, control })
            }
            "SQC" => {
                let file = self.start(given.at(0))?;
                let long = self.is_long_file(given, 0) || self.is_long_file(given, 2);
                let mask = self.stepped(given.at(1), long)?;
                let source = self.stepped(given.at(2), long)?;
                let control = self.element(given.at(3), FileType::R)?;
                self.always(Block::SequencerCompare { file, mask, source, control })
            }
            "SQL" => {
                let file = self.start(given.at(0))?;
                let source = self.stepped(given.at(1), self.is_long_file(given, 0))?;
                let control = self.element(given.at(2), FileType::R)?;
                self.always(Block::SequencerLoad { file, source, control })
            }
            // Operands 4, 5 and 7, 8 are the lengths and positions of the two control elements.
            "FBC" | "DDT" => {
                let source = self.start(given.at(0))?;
                let reference = self.start(given.at(1))?;
                let result = self.start(given.at(2))?;
                let compare = self.element(given.at(3), FileType::R)?;
                let control = self.element(given.at(6), FileType::R)?;
                self.always(Block::FileBits { detect: name == "DDT", source, reference, result, compare, control })
            }
            _ => Err("this instruction is not simulated".to_owned()),
        }
    }

    /// A whole element of several words.
    fn is_element(&self, operand: Option<&Operand>) -> bool {
        let location = operand.and_then(Operand::address).and_then(|address| self.layout.locate(address));
        location.is_some_and(|location| location.width == crate::layout::Width::Element)
    }

    fn is_long_file(&self, given: &Given<'_>, index: usize) -> bool {
        given.at(index).and_then(Operand::address).is_some_and(|address| address.file_type == FileType::L)
    }

    pub(super) fn ascii(&mut self, name: &str, given: &Given<'_>) -> Result<()> {
        let string = |compiler: &mut Self, index| compiler.element(given.at(index), FileType::ST);
        match name {
            "ACI" => {
                let (source, dest) = (string(self, 0)?, self.target(given.at(1))?);
                self.act(Block::StringToInteger { source, dest })
            }
            "AIC" => {
                let (source, dest) = (self.source(given.at(0), false)?, string(self, 1)?);
                self.act(Block::IntegerToString { source, dest })
            }
            "ACN" => {
                let (a, b, dest) = (string(self, 0)?, string(self, 1)?, string(self, 2)?);
                self.act(Block::Concatenate { a, b, dest })
            }
            "AEX" => {
                let source = string(self, 0)?;
                let index = self.source(given.at(1), false)?;
                let number = self.source(given.at(2), false)?;
                let dest = string(self, 3)?;
                self.act(Block::Extract { source, index, number, dest })
            }
            "ASC" => {
                let source = string(self, 0)?;
                let index = self.source(given.at(1), false)?;
                let within = string(self, 2)?;
                let dest = self.target(given.at(3))?;
                self.act(Block::Search { source, index, within, dest })
            }
            "ASR" => {
                let (a, b) = (string(self, 0)?, string(self, 1)?);
                self.test(Block::StringsEqual { a, b })
            }
            "ACL" => {
                let channel = given.channel(0)?;
                let both = given.len() < 3;
                let (transmit, receive) = (both || given.says_yes(1), both || given.says_yes(2));
                self.act(Block::ClearPort { channel, transmit, receive })
            }
            _ => self.port(name, given),
        }
    }

    fn port(&mut self, name: &str, given: &Given<'_>) -> Result<()> {
        let what = match name {
            "ABL" => PortAction::TestLine,
            "ACB" => PortAction::CountCharacters,
            "ARD" => PortAction::Read,
            "ARL" => PortAction::ReadLine,
            "AWT" => PortAction::Write,
            "AWA" => PortAction::WriteAppend,
            "AHL" => PortAction::Handshake,
            _ => return Err("this instruction is not simulated".to_owned()),
        };
        let channel = given.channel(0)?;
        let (string, masks, control) = match what {
            PortAction::TestLine | PortAction::CountCharacters => (None, None, 1),
            PortAction::Handshake => {
                let masks = (self.source(given.at(1), false)?, self.source(given.at(2), false)?);
                (None, Some(masks), 3)
            }
            _ => (Some(self.element(given.at(1), FileType::ST)?), None, 2),
        };
        let control = self.element(given.at(control), FileType::R)?;
        self.always(Block::Port(Port { what, channel, string, control, masks }))
    }
}
