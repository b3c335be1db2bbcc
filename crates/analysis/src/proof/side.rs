//! One side of a comparison: a machine with memory that is looked at by number.

use std::time::Duration;

use domore::engine::Handle;
use domore::memory::{Kind as DoMoreKind, Num, Resolved};
use ladder::{Address, Value};

/// What stands at a place both sides know.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// One bit.
    Bit,
    /// 16 bits.
    Word,
    /// 32 bits, whole number.
    Long,
    /// 32 bits, IEEE single.
    Float,
    /// Characters.
    Text,
}

/// A machine that can be compared with another one. Values are raw bits: 0 or 1, a word, a long word, the
/// bits of a float. Places are first bits, counted through all memory of the side.
pub trait Side: Sized {
    /// Where an input is written, found once.
    type Target: Clone;

    /// Finds what stands at an address.
    ///
    /// # Errors
    /// There is no such place, or it holds no value of these kinds.
    fn place(&self, address: &str) -> Result<(u32, Kind), String>;

    /// Finds an address to write to.
    ///
    /// # Errors
    /// There is no such place, or nobody may write it.
    fn target(&self, address: &str) -> Result<Self::Target, String>;

    /// The bit at a place.
    fn bit(&self, at: u32) -> bool;

    /// The word at a place.
    fn word(&self, at: u32) -> u16;

    /// Whether the words from a place on are these, in the bits of the mask.
    fn holds(&self, at: u32, words: &[u16], mask: u16) -> bool;

    /// Appends the characters at a place.
    fn text(&self, at: u32, into: &mut Vec<u8>);

    /// What the output terminals of the word at a place carry.
    fn terminals(&self, at: u32) -> u16;

    /// Writes an input.
    fn write(&mut self, target: &Self::Target, value: u32);

    /// Time passes, then one scan runs.
    fn scan(&mut self, dt: Duration);

    /// As [`Side::scan`], noting what its instructions did where the side can tell.
    fn scan_seen(&mut self, dt: Duration, seen: &mut Seen) {
        let _ = seen;
        self.scan(dt);
    }

    /// Operations that [`Side::scan_seen`] tells about.
    fn operations(&self) -> usize {
        0
    }

    /// Where an operation stands: code block, rung and instruction, all from 0.
    fn spot(&self, operation: u32) -> Option<(usize, usize, usize)> {
        let _ = operation;
        None
    }

    /// Leaves run.
    fn leave_run(&mut self);

    /// Enters run; the next scan is the first one.
    fn enter_run(&mut self);

    /// Why the program is not executed any more although nobody stopped it.
    fn stopped(&self) -> Option<String>;

    /// A second machine in the same state.
    fn fork(&self) -> Self;

    /// Takes over the state of a fork, without allocating.
    fn copy_from(&mut self, other: &Self);
}

/// What the instructions of the other program did so far: it leads a run to what was converted into more than
/// the original shows, and says how much of it ran.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    operations: Vec<u8>,
    /// Second minus first value of each comparison when it was made last.
    gaps: Vec<i64>,
    /// Something was seen for the first time since somebody asked last.
    fresh: bool,
}

const ON: u8 = 1;
const OFF: u8 = 2;
const BELOW: u8 = 4;
const EQUAL: u8 = 8;
const ABOVE: u8 = 16;

impl Seen {
    pub(crate) fn new(operations: usize) -> Seen {
        Seen { operations: vec![0; operations], gaps: vec![0; operations], fresh: false }
    }

    fn note(&mut self, operation: u32, what: u8) {
        if let Some(seen) = self.operations.get_mut(operation as usize) {
            self.fresh |= *seen | what != *seen;
            *seen |= what;
        }
    }

    /// Operations that ran, but not seen both on and off, or never ran at all.
    pub(crate) fn missing(&self) -> impl Iterator<Item = u32> {
        let open = |(_, seen): &(u32, &u8)| **seen & (ON | OFF) != ON | OFF;
        (0..).zip(&self.operations).filter(open).map(|(number, _)| number)
    }

    /// What lacked to equal values when each comparison was made last; 0 for all else.
    pub(crate) fn gaps(&self) -> &[i64] {
        &self.gaps
    }

    /// The comparison has seen equal values.
    pub(crate) fn was_equal(&self, operation: usize) -> bool {
        self.operations.get(operation).is_some_and(|seen| seen & EQUAL != 0)
    }

    pub(crate) fn take_fresh(&mut self) -> bool {
        std::mem::take(&mut self.fresh)
    }

    /// Ways of contacts and outputs that were seen, on and off, and twice the number of those that ran.
    pub(crate) fn both_ways(&self) -> (usize, usize) {
        let told = self.operations.iter().filter(|seen| **seen & (ON | OFF) != 0);
        told.fold((0, 0), |(ways, all), seen| (ways + (seen & (ON | OFF)).count_ones() as usize, all + 2))
    }
}

impl domore::engine::Watch for Seen {
    #[inline]
    fn contact(&mut self, operation: u32, on: bool) {
        self.note(operation, if on { ON } else { OFF });
    }

    #[inline]
    fn compare(&mut self, operation: u32, a: Num, b: Num, on: bool) {
        if let (Num::Int(a), Num::Int(b), Some(gap)) = (a, b, self.gaps.get_mut(operation as usize)) {
            *gap = b.saturating_sub(a);
        }
        let near = match (a, b) {
            (Num::Int(a), Num::Int(b)) => match a.saturating_sub(b) {
                0 => EQUAL,
                -1 => BELOW,
                1 => ABOVE,
                _ => 0,
            },
            _ => 0,
        };
        self.note(operation, near | if on { ON } else { OFF });
    }

    #[inline]
    fn power(&mut self, operation: u32, on: bool) {
        self.note(operation, if on { ON } else { OFF });
    }
}

/// An SLC 500 or MicroLogix program.
#[derive(Debug)]
pub struct Slc {
    /// The machine.
    pub machine: sim::Machine,
}

impl Side for Slc {
    type Target = (Address, Kind);

    fn place(&self, address: &str) -> Result<(u32, Kind), String> {
        let address = Address::parse(address).map_err(|error| error.to_string())?;
        let (at, kind) = self.machine.place(&address).map_err(|error| error.to_string())?;
        let kind = match kind {
            sim::Kind::Bit => Kind::Bit,
            sim::Kind::Word | sim::Kind::Element => Kind::Word,
            sim::Kind::Long => Kind::Long,
            sim::Kind::Float => Kind::Float,
            sim::Kind::Text => Kind::Text,
        };
        Ok((at, kind))
    }

    fn target(&self, address: &str) -> Result<Self::Target, String> {
        let (_, kind) = self.place(address)?;
        Ok((Address::parse(address).map_err(|error| error.to_string())?, kind))
    }

    #[inline]
    fn bit(&self, at: u32) -> bool {
        self.machine.data().get((at >> 4) as usize).is_some_and(|word| word >> (at & 15) & 1 != 0)
    }

    #[inline]
    fn word(&self, at: u32) -> u16 {
        self.machine.data().get((at >> 4) as usize).copied().unwrap_or(0)
    }

    #[inline]
    fn holds(&self, at: u32, words: &[u16], mask: u16) -> bool {
        let first = (at >> 4) as usize;
        let own = self.machine.data().get(first..first + words.len()).unwrap_or_default();
        own.len() == words.len()
            && if mask == u16::MAX { own == words } else { own.iter().zip(words).all(|(a, b)| (a ^ b) & mask == 0) }
    }

    fn text(&self, at: u32, into: &mut Vec<u8>) {
        let first = (at >> 4) as usize;
        let words = self.machine.data().get(first..first + 42).unwrap_or_default();
        let length = usize::from(words.first().copied().unwrap_or(0)).min(82);
        let characters = words.iter().skip(1).flat_map(|word| word.to_be_bytes());
        into.extend(characters.take(length));
    }

    fn terminals(&self, at: u32) -> u16 {
        if self.machine.mode() == sim::Mode::Run { self.word(at) } else { 0 }
    }

    fn write(&mut self, target: &Self::Target, value: u32) {
        let value = match target.1 {
            Kind::Bit => Value::Bit(value != 0),
            Kind::Word => Value::Word(value as u16 as i16),
            Kind::Long => Value::Long(value as i32),
            Kind::Float => Value::Float(f32::from_bits(value)),
            Kind::Text => return,
        };
        // The address was found before; a value the clock refuses is refused as on the controller.
        let _ = self.machine.set(&target.0, &value);
    }

    fn scan(&mut self, dt: Duration) {
        self.machine.scan(dt);
    }

    fn leave_run(&mut self) {
        self.machine.enter_program();
    }

    fn enter_run(&mut self) {
        self.machine.enter_run();
    }

    fn stopped(&self) -> Option<String> {
        match (self.machine.fault(), self.machine.mode()) {
            (Some(fault), _) => Some(fault.to_string()),
            (None, sim::Mode::Suspend) => Some("suspended by SUS".to_owned()),
            _ => None,
        }
    }

    fn fork(&self) -> Slc {
        Slc { machine: self.machine.fork() }
    }

    fn copy_from(&mut self, other: &Slc) {
        self.machine.copy_from(&other.machine);
    }
}

/// A Do-more program.
#[derive(Debug)]
pub struct DoMore {
    /// The machine.
    pub machine: domore::engine::Machine,
    program: domore::engine::Program,
    /// The bit a converted program sets when the original would have stopped with a major fault.
    fault: Option<u32>,
}

/// Nickname of the bit a converted program sets where the original stops.
const FAULT_BIT: &str = "slcFault";

impl DoMore {
    /// A machine in program mode, its memory zero.
    pub fn new(program: domore::engine::Program) -> DoMore {
        let fault = match program.memory().resolve_text(FAULT_BIT) {
            Ok(Resolved::Place(place)) if place.kind == DoMoreKind::Bit => Some(place.bit),
            _ => None,
        };
        DoMore { machine: domore::engine::Machine::new(program.clone()), program, fault }
    }

    /// The program.
    pub fn program(&self) -> &domore::engine::Program {
        &self.program
    }
}

impl Side for DoMore {
    type Target = Handle;

    fn place(&self, address: &str) -> Result<(u32, Kind), String> {
        match self.program.memory().resolve_text(address).map_err(|error| error.to_string())? {
            Resolved::Place(place) => {
                let kind = match place.kind {
                    DoMoreKind::Bit => Kind::Bit,
                    DoMoreKind::U16 | DoMoreKind::I16 => Kind::Word,
                    DoMoreKind::I32 | DoMoreKind::U32 => Kind::Long,
                    DoMoreKind::F32 => Kind::Float,
                    DoMoreKind::Text(_) => Kind::Text,
                    DoMoreKind::U8 | DoMoreKind::I8 => return Err(format!("{address} is a byte")),
                };
                Ok((place.bit, kind))
            }
            _ => Err(format!("{address} is no single value")),
        }
    }

    fn target(&self, address: &str) -> Result<Handle, String> {
        self.machine.handle(address).map_err(|error| error.to_string())
    }

    #[inline]
    fn bit(&self, at: u32) -> bool {
        self.machine.data().bit(at)
    }

    #[inline]
    fn word(&self, at: u32) -> u16 {
        let first = (at >> 3) as usize;
        let bytes = self.machine.data().bytes().get(first..).and_then(<[u8]>::first_chunk);
        bytes.map_or(0, |bytes| u16::from_le_bytes(*bytes))
    }

    #[inline]
    fn holds(&self, at: u32, words: &[u16], mask: u16) -> bool {
        let first = (at >> 3) as usize;
        let own = self.machine.data().bytes().get(first..first + 2 * words.len()).unwrap_or_default();
        let (pairs, _) = own.as_chunks::<2>();
        pairs.len() == words.len()
            && pairs.iter().zip(words).fold(0, |different, (own, word)| different | (u16::from_le_bytes(*own) ^ word))
                & mask
                == 0
    }

    fn text(&self, at: u32, into: &mut Vec<u8>) {
        // Strings hold at most 256 characters; a length that says more is cut there.
        let first = (at >> 3) as usize;
        let bytes = self.machine.data().bytes();
        let length = usize::from(self.word(at)).min(256);
        into.extend(bytes.get(first + 4..first + 4 + length).unwrap_or_default());
    }

    fn terminals(&self, at: u32) -> u16 {
        self.word(at)
    }

    fn write(&mut self, target: &Handle, value: u32) {
        let number = match target.kind() {
            DoMoreKind::F32 => Num::Real(f32::from_bits(value).into()),
            DoMoreKind::I16 => Num::Int((value as u16 as i16).into()),
            DoMoreKind::I32 => Num::Int((value as i32).into()),
            _ => Num::Int(value.into()),
        };
        self.machine.set_number(*target, number);
    }

    fn scan(&mut self, dt: Duration) {
        self.machine.scan(dt);
    }

    fn scan_seen(&mut self, dt: Duration, seen: &mut Seen) {
        self.machine.scan_watched(dt, seen);
    }

    fn operations(&self) -> usize {
        self.program.operations() as usize
    }

    fn spot(&self, operation: u32) -> Option<(usize, usize, usize)> {
        self.program.spot(operation)
    }

    fn leave_run(&mut self) {
        self.machine.enter_program();
    }

    fn enter_run(&mut self) {
        self.machine.enter_run();
    }

    fn stopped(&self) -> Option<String> {
        if let Some(fault) = self.machine.fault() {
            return Some(fault.to_string());
        }
        self.fault.filter(|bit| self.machine.data().bit(*bit)).map(|_| format!("{FAULT_BIT} is on"))
    }

    fn fork(&self) -> DoMore {
        DoMore { machine: self.machine.fork(), program: self.program.clone(), fault: self.fault }
    }

    fn copy_from(&mut self, other: &DoMore) {
        self.machine.copy_from(&other.machine);
    }
}
