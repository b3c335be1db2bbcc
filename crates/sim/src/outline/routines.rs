//! Program files that run without a call, and other things the processor does by itself.

use ladder::FileType;

use super::{Does, Outline, Value, Write};
use crate::family::Lineage;
use crate::op::{Block, Compiled, Op};
use crate::status;

/// On which occasion a processor starts a program file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Routine {
    /// A fault that a routine may clear.
    Fault,
    /// The timed interrupt: never before the first scan.
    Timed,
    /// An input, a high-speed counter.
    Event,
    /// As [`Routine::Timed`] and [`Routine::Event`], but between any two rungs.
    Anytime,
}

/// Words of the flags of a function file element, and its bit for a start on going to run.
const FLAGS: u32 = 2;
const AUTO_START: u16 = 1 << 5;
const ENABLED: u16 = 1 << 4;
/// Words of an HSC element: the mask of outputs it switches.
const OUTPUT_MASK: u32 = 15;

impl Outline {
    /// Finds routines, and what can go wrong outside the program scan.
    pub(super) fn surroundings(&mut self, compiled: &Compiled) {
        let status = compiled.layout.status as u32;
        let data = |word: u32| compiled.data.get(word as usize).copied().unwrap_or(0);
        let any = |found: fn(&Block) -> bool| compiled.blocks.iter().any(found);
        let masks = any(|block| {
            matches!(block, Block::TimedEnable(_) | Block::InterruptMask { .. } | Block::EventInterrupts { .. })
        });
        let timed_start = any(|block| matches!(block, Block::TimedStart { .. }));
        let mut places = vec![(status + status::FAULT_ROUTINE as u32, Routine::Fault)];
        if compiled.traits.status_file_sti() {
            places.push((status + status::STI_FILE as u32, Routine::Timed));
        }
        if compiled.traits.lineage == Lineage::S3 {
            places.push((status + status::DII_FILE as u32, Routine::Event));
        }
        for (file_type, routine) in
            [(FileType::STI, Routine::Timed), (FileType::EII, Routine::Event), (FileType::HSC, Routine::Event)]
        {
            for element in 0..8 {
                let Some(word) = compiled.layout.interrupt(file_type, element) else { break };
                places.push((word, routine));
                let starts = data(word + FLAGS) & AUTO_START != 0 || self.writes(word + FLAGS);
                self.refuses_run |= starts && file_type == FileType::HSC;
                let enabled = starts || data(word + FLAGS) & ENABLED != 0 || self.writes(word + FLAGS);
                let masked = data(word + OUTPUT_MASK) != 0 || self.writes(word + OUTPUT_MASK);
                if file_type == FileType::HSC && enabled && masked {
                    // It switches outputs by itself, whatever the program does.
                    self.routines.push((0, Routine::Anytime));
                }
            }
        }
        let all: Vec<u16> = (3..=255).filter(|number| compiled.entry(*number).is_some()).collect();
        for (word, routine) in places {
            let routine = if masks && routine != Routine::Fault { Routine::Anytime } else { routine };
            let named = data(word);
            // STS can name a file, which stands in its operand.
            let decided = self.writes(word) || timed_start && word == status + status::STI_FILE as u32;
            let missing = named != 0 && !all.contains(&named);
            self.refuses_run |= decided || missing && routine != Routine::Fault;
            match decided {
                true => self.routines.extend(all.iter().map(|number| (*number, routine))),
                false if all.contains(&named) => self.routines.push((named, routine)),
                false => {}
            }
        }
        // A period or an input slot that makes no sense stops on the way to run.
        let set_up = [status::STI_PERIOD, status::DII_SLOT].map(|word| status + word as u32);
        self.refuses_run |= compiled.traits.status_file_sti()
            && self.routines.iter().any(|(_, routine)| *routine != Routine::Fault)
            && (set_up.iter().any(|word| self.writes(*word)) || data(set_up[0]) > 255 || data(set_up[1]) != 0);
        self.routines.sort_unstable();
        self.routines.dedup();
        let minor = status + status::MINOR as u32;
        self.minor_error = data(minor) & status::MINOR_FATAL != 0
            || self.writes(minor)
            || self.writes(status + status::MODE as u32)
            || compiled.ops.iter().any(|op| matches!(op, Op::Always(_) | Op::Do(_)) && self.raises(compiled, op));
    }

    /// Some step can write this word, as long as no element number leads out of its file.
    pub fn writes(&self, word: u32) -> bool {
        let within = |from: u32, to: u32| (from..to).contains(&word);
        let long = |at: u32| within(at, at.saturating_add(2));
        let hits = |write: &Write| match *write {
            Write::Words(from, to) => within(from, to),
            Write::Element { file: (from, to), .. } => within(from, to),
            Write::Anywhere => true,
        };
        self.steps.iter().any(|step| match &step.does {
            Does::Coil(bit) | Does::Latch(bit) | Does::Unlatch(bit) | Does::OneShot(bit) => bit / 16 == word,
            Does::Rising { storage, output } | Does::Falling { storage, output } => {
                storage / 16 == word || output / 16 == word
            }
            Does::Timer { word: at, .. }
            | Does::Counter { word: at, .. }
            | Does::ResetTimer(at)
            | Does::ResetCounter(at) => word == *at || word == at.saturating_add(2),
            Does::Move { dest, .. } | Does::Binary { dest, .. } => match dest {
                Value::Word(at) => *at == word,
                Value::Long(at) => long(*at),
                Value::Constant(_) => false,
            },
            Does::Copy { to, words, .. } | Does::Fill { to, words, .. } => within(*to, to.saturating_add(*words)),
            Does::Sequencer { control, dest, .. } => within(*control, control.saturating_add(3)) || *dest == word,
            Does::Other { writes, .. } => writes.iter().any(hits),
            _ => false,
        })
    }

    /// The step can set one of the minor errors that end a scan with a fault.
    fn raises(&self, compiled: &Compiled, op: &Op) -> bool {
        let (Op::Always(block) | Op::Do(block)) = op else { return false };
        let Some(block) = compiled.blocks.get(*block as usize) else { return true };
        match super::blocks::does(compiled, *block_number(op), false, matches!(op, Op::Always(_))) {
            Does::Other { .. } => !matches!(
                block,
                Block::Coil(_)
                    | Block::Latch(_)
                    | Block::Unlatch(_)
                    | Block::OneShot(_)
                    | Block::Rising { .. }
                    | Block::Falling { .. }
                    | Block::Counter { .. }
                    | Block::Reset { .. }
                    | Block::Copy { .. }
                    | Block::FillElement { .. }
                    | Block::SwapBytes { .. }
                    | Block::MaskedMove { .. }
                    | Block::ImmediateInput { .. }
                    | Block::ImmediateOutput { .. }
            ),
            Does::Move { source, dest } => !fits(source, dest),
            Does::Binary { op, .. } => matches!(op, super::Binary::Add | super::Binary::Subtract),
            _ => false,
        }
    }
}

fn block_number(op: &Op) -> &u32 {
    match op {
        Op::Always(block) | Op::Do(block) | Op::Test(block) => block,
        _ => &u32::MAX,
    }
}

/// The value fits its destination whatever it is.
fn fits(source: Value, dest: Value) -> bool {
    match (source, dest) {
        (_, Value::Long(_)) | (Value::Word(_), _) => true,
        (Value::Constant(value), _) => i16::try_from(value).is_ok(),
        (Value::Long(_), _) => false,
    }
}
