//! Interrupts, counters and pulse outputs, PID, clocks, messages, logs.

use ladder::{FileType, Instruction, Operand};

use super::Compiler;
use super::instruction::Given;
use super::operand::{Result, unusable};
use crate::op::*;

/// What reports say about instructions whose partner outside the controller is missing.
const NO_QUEUE: &str = "data log, recipe and display act outside the program: it does nothing but pass power";

impl Compiler<'_> {
    pub(super) fn interrupt(
        &mut self,
        name: &str,
        given: &Given<'_>,
        _rung_start: u32,
        instruction: &Instruction,
    ) -> Result<()> {
        let change = match name {
            "UID" | "IID" => MaskChange::Disable,
            "UIE" | "IIE" => MaskChange::Enable,
            _ => MaskChange::Flush,
        };
        match name {
            "INT" => {
                self.push(Op::Marker);
                Ok(())
            }
            "STS" => {
                let file = if given.len() >= 2 { Some(self.source(given.at(0), false)?) } else { None };
                let time = self.source(given.at(given.len().saturating_sub(1)), false)?;
                self.act(Block::TimedStart { file, time })
            }
            "STD" => self.act(Block::TimedEnable(false)),
            "STE" => self.act(Block::TimedEnable(true)),
            "UID" | "UIE" | "UIF" => {
                let types = self.source(given.at(0), false)?;
                self.act(Block::InterruptMask { change, types })
            }
            "IID" | "IIE" | "RPI" => {
                let slots = self.source(given.at(0), false)?;
                self.approximate(
                    instruction,
                    "no module raises I/O interrupts: the enable and pending bits of slots 1 to 15 follow, nothing else",
                );
                self.act(Block::EventInterrupts { change, slots })
            }
            _ => Err("this instruction is not simulated".to_owned()),
        }
    }

    pub(super) fn device(&mut self, name: &str, given: &Given<'_>, instruction: &Instruction) -> Result<()> {
        match name {
            "PID" => self.pid(given),
            "RHC" => {
                let dest = self.target(given.at(0))?;
                self.act(Block::ClockRead { dest })
            }
            "TDF" => {
                let start = self.source(given.at(0), false)?;
                let stop = self.source(given.at(1), false)?;
                let dest = self.target(given.at(2))?;
                self.act(Block::ClockDifference { start, stop, dest })
            }
            "RTA" => {
                let slot = self.adjusts;
                self.adjusts += 1;
                self.always(Block::ClockAdjust { slot })
            }
            "MSG" => self.message(given, instruction),
            "SVC" => self.act(Block::Service),
            "DLG" | "RCP" | "LCD" => {
                self.approximate(instruction, NO_QUEUE);
                self.act(Block::Idle)
            }
            "HSL" | "RAC" | "HSC" | "HSE" | "HSD" => self.high_speed(name, given, instruction),
            "PTO" | "PWM" => {
                self.approximate(
                    instruction,
                    "no pulses are produced and its status bits stay as they are set: a scenario can set them by name",
                );
                self.always(Block::Pulse)
            }
            "BTR" | "BTW" | "CEM" | "DEM" | "EEM" => {
                Err("it speaks to a module or a network, and the layout of its control block was not found".to_owned())
            }
            _ => Err("this instruction is not simulated".to_owned()),
        }
    }

    fn pid(&mut self, given: &Given<'_>) -> Result<()> {
        let address = given.at(0).and_then(Operand::address);
        if !address.is_some_and(|address| matches!(address.file_type, FileType::PD | FileType::N)) {
            return Err(unusable(given.at(0), "a PID element or block"));
        }
        let at = self.start(given.at(0))?;
        if let StartAt::Fixed { word, end } = at.at
            && end - word < instr::exec::process::WORDS as u32
        {
            return Err("its block of 23 words reaches beyond the data file".to_owned());
        }
        let process = self.source(given.at(1), false)?;
        let present = self.source(given.at(2), false)?;
        let control = self.target(given.at(2))?;
        let slot = self.pids;
        self.pids += 1;
        self.always(Block::Pid { at, process, control, present, slot })
    }

    fn message(&mut self, given: &Given<'_>, instruction: &Instruction) -> Result<()> {
        let block = given.address_of(|t| matches!(t, FileType::MG | FileType::N), 0);
        let Some((index, file_type)) = block else { return Err(unusable(given.at(0), "a message element or block")) };
        let at = self.start(given.at(index))?;
        let local = match given.address_of(|_| true, index + 1) {
            Some((local, _)) => Some(self.start(given.at(local))?),
            None => None,
        };
        let id = self.messages;
        self.messages += 1;
        let setup = instruction.message.iter().flat_map(|message| message.settings.iter());
        let setup = setup.map(|(name, text)| (name.to_string(), text.clone())).collect();
        self.approximate(
            instruction,
            "the partner is whatever the caller connects; without one every message times out with error 37h",
        );
        self.always(Block::Message(Message { at, local, slc: file_type == FileType::N, id, setup }))
    }

    fn high_speed(&mut self, name: &str, given: &Given<'_>, instruction: &Instruction) -> Result<()> {
        let counter = match given.at(0) {
            Some(Operand::HighSpeedCounter(number)) => Some(*number),
            Some(Operand::Address(address)) if address.file_type == FileType::HSC => address.element.number(),
            Some(Operand::Constant(constant)) => constant.as_integer().and_then(|n| u16::try_from(n).ok()),
            _ => None,
        };
        match (name, counter) {
            ("HSL", Some(counter)) if given.len() >= 5 => {
                let mut values = [Source::Integer(0); 4];
                for (index, value) in values.iter_mut().enumerate() {
                    *value = self.source(given.at(index + 1), true)?;
                }
                self.act(Block::HighSpeedLoad { counter, values })
            }
            ("RAC", Some(counter)) => {
                let source = self.source(given.at(1), true)?;
                self.act(Block::HighSpeedReset { counter, source })
            }
            ("RAC", None) => {
                let at = self.element(given.at(0), FileType::C)?;
                let StartAt::Fixed { word, .. } = at.at else { return Err("the counter must be direct".to_owned()) };
                let source = self.source(given.at(1), false)?;
                self.act(Block::Unary { op: Unary::Move, source, dest: Target::Word(word + 2) })
            }
            ("HSC", _) => {
                let counter = given.address_of(|t| t == FileType::C, 0);
                let (index, _) = counter.ok_or_else(|| unusable(given.at(0), "a counter"))?;
                let at = self.element(given.at(index), FileType::C)?;
                let StartAt::Fixed { word, .. } = at.at else { return Err("the counter must be direct".to_owned()) };
                self.approximate(instruction, "no pulses reach the high-speed counter: its flags follow ACC and PRE");
                self.always(Block::HighSpeedCounter { word })
            }
            _ => {
                self.approximate(
                    instruction,
                    "no pulses reach the high-speed counter of a fixed SLC or MicroLogix 1000: it does nothing",
                );
                self.act(Block::Idle)
            }
        }
    }
}

impl Given<'_> {
    /// First address of a wanted type from operand `from` on.
    fn address_of(&self, wanted: impl Fn(FileType) -> bool, from: usize) -> Option<(usize, FileType)> {
        (from..self.len()).find_map(|index| {
            let address = self.at(index)?.address()?;
            wanted(address.file_type).then_some((index, address.file_type))
        })
    }

    pub(super) fn channel(&self, index: usize) -> Result<u16> {
        u16::try_from(self.number(index)?).map_err(|_| "the channel is not a number".to_owned())
    }

    /// `Yes`, as boxes print a choice.
    pub(super) fn says_yes(&self, index: usize) -> bool {
        match self.at(index) {
            Some(Operand::Symbol(text) | Operand::Text(text)) => text.eq_ignore_ascii_case("yes"),
            Some(Operand::Constant(constant)) => constant.as_integer() != Some(0),
            _ => false,
        }
    }
}
