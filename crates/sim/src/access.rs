//! Reading and writing a machine from outside, by address.

use std::fmt;

use ladder::{Address, ControlElement, CounterElement, FileType, TimerElement, Value};

use crate::Machine;
use crate::layout::{Location, Width};
use crate::status;

/// What stands at an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// One bit.
    Bit,
    /// A 16-bit word.
    Word,
    /// A 32-bit long word.
    Long,
    /// A float.
    Float,
    /// A string.
    Text,
    /// Any other structured element.
    Element,
}

/// Why an address could not be read or written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AccessError {
    /// There is no such place in the data table.
    Missing(Address),
    /// The address names its place by brackets or S:24: outside a program that is no place.
    NotDirect(Address),
    /// The value does not fit what stands there.
    Unfit {
        /// The address.
        address: Address,
        /// What stands there.
        kind: Kind,
        /// The value.
        value: String,
    },
}

impl fmt::Display for AccessError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AccessError::Missing(address) => write!(f, "{address} does not exist in the data table"),
            AccessError::NotDirect(address) => write!(f, "{address} is no fixed place"),
            AccessError::Unfit { address, kind, value } => {
                let kind = match kind {
                    Kind::Bit => "a bit",
                    Kind::Word => "a word",
                    Kind::Long => "a long word",
                    Kind::Float => "a float",
                    Kind::Text => "a string",
                    Kind::Element => "a structured element",
                };
                write!(f, "{value} does not fit {address}, which is {kind}")
            }
        }
    }
}

impl std::error::Error for AccessError {}

impl Machine {
    fn locate(&self, address: &Address) -> Result<Location, AccessError> {
        if !address.is_direct() {
            return Err(AccessError::NotDirect(address.clone()));
        }
        self.program.layout.locate(address).ok_or_else(|| AccessError::Missing(address.clone()))
    }

    /// What stands at an address.
    ///
    /// # Errors
    /// There is no such place.
    pub fn kind(&self, address: &Address) -> Result<Kind, AccessError> {
        let location = self.locate(address)?;
        Ok(match location.width {
            Width::Bit => Kind::Bit,
            Width::Word => Kind::Word,
            Width::Long => Kind::Long,
            Width::Float => Kind::Float,
            Width::Element if self.file_type(location) == FileType::ST => Kind::Text,
            Width::Element => Kind::Element,
        })
    }

    /// The first bit of what stands at an address, counted through [`Machine::data`], and what stands
    /// there: for callers that look at the same places scan after scan.
    ///
    /// # Errors
    /// There is no such place.
    pub fn place(&self, address: &Address) -> Result<(u32, Kind), AccessError> {
        let location = self.locate(address)?;
        Ok((location.word * 16 + u32::from(location.bit), self.kind(address)?))
    }

    fn file_type(&self, location: Location) -> FileType {
        self.program.layout.files.get(location.file).map_or(FileType::N, |file| file.file_type)
    }

    fn word(&self, at: u32) -> u16 {
        self.state.mem.get(at as usize).copied().unwrap_or(0)
    }

    fn long(&self, at: u32) -> u32 {
        u32::from(self.word(at)) | u32::from(self.word(at + 1)) << 16
    }

    /// The value at a direct address: bits, words, whole elements, strings. I and O give the images,
    /// see [`Machine::output`] for terminals.
    ///
    /// # Errors
    /// There is no such place.
    pub fn get(&self, address: &Address) -> Result<Value, AccessError> {
        let location = self.locate(address)?;
        let at = location.word;
        let signed = |at: u32| self.word(at) as i16;
        Ok(match location.width {
            Width::Bit => Value::Bit(self.word(at) >> location.bit & 1 != 0),
            Width::Word => Value::Word(signed(at)),
            Width::Long => Value::Long(self.long(at) as i32),
            Width::Float => Value::Float(f32::from_bits(self.long(at))),
            Width::Element => match self.file_type(location) {
                FileType::T => {
                    Value::Timer(TimerElement { control: self.word(at), pre: signed(at + 1), acc: signed(at + 2) })
                }
                FileType::C => {
                    Value::Counter(CounterElement { control: self.word(at), pre: signed(at + 1), acc: signed(at + 2) })
                }
                FileType::R => {
                    Value::Control(ControlElement { control: self.word(at), len: signed(at + 1), pos: signed(at + 2) })
                }
                file_type => {
                    let size = self.program.layout.files.get(location.file).map_or(1, |file| file.size);
                    let words: Vec<u16> = (at..at + size).map(|at| self.word(at)).collect();
                    match file_type {
                        // The model knows how a string element reads.
                        FileType::ST => {
                            let mut file = ladder::DataFile::new(FileType::ST, 0, 1);
                            file.words = words;
                            file.value(0).unwrap_or(Value::Text(String::new()))
                        }
                        _ => Value::Words(words),
                    }
                }
            },
        })
    }

    /// Writes a value to a direct address, converting where nothing is lost: 0 and 1 to bits, 0 to
    /// 65535 to words. An input is written to its terminal and its image.
    ///
    /// # Errors
    /// There is no such place, or the value does not fit it.
    pub fn set(&mut self, address: &Address, value: &Value) -> Result<(), AccessError> {
        let location = self.locate(address)?;
        let unfit = |machine: &Machine| {
            let kind = machine.kind(address).unwrap_or(Kind::Word);
            AccessError::Unfit { address: address.clone(), kind, value: shown(value) }
        };
        let at = location.word;
        match location.width {
            Width::Bit => {
                let on = match value {
                    Value::Bit(on) => *on,
                    Value::Word(0) | Value::Long(0) => false,
                    Value::Word(1) | Value::Long(1) => true,
                    _ => return Err(unfit(self)),
                };
                let word = self.word(at) & !(1 << location.bit) | u16::from(on) << location.bit;
                self.write_bits(at, word, 1 << location.bit);
            }
            Width::Word => {
                let word = match value {
                    Value::Word(word) => *word as u16,
                    Value::Bit(on) => u16::from(*on),
                    Value::Long(long) if (-32768..=65535).contains(long) => *long as u16,
                    Value::Float(float) if float.fract() == 0.0 && (-32768.0..=65535.0).contains(float) => {
                        *float as i32 as u16
                    }
                    _ => return Err(unfit(self)),
                };
                self.write(at, word);
            }
            Width::Long => {
                let long = match value {
                    Value::Word(word) => i32::from(*word),
                    Value::Bit(on) => i32::from(*on),
                    Value::Long(long) => *long,
                    _ => return Err(unfit(self)),
                };
                self.write_long(at, long as u32);
            }
            Width::Float => {
                let float = match value {
                    Value::Word(word) => f32::from(*word),
                    Value::Long(long) => *long as f32,
                    Value::Float(float) => *float,
                    _ => return Err(unfit(self)),
                };
                self.write_long(at, float.to_bits());
            }
            Width::Element => {
                let size = self.program.layout.files.get(location.file).map_or(1, |file| file.size as usize);
                let words = match (value, self.file_type(location)) {
                    (Value::Text(text), FileType::ST) => string_words(text).ok_or_else(|| unfit(self))?,
                    (Value::Timer(t), FileType::T) => vec![t.control, t.pre as u16, t.acc as u16],
                    (Value::Counter(c), FileType::C) => vec![c.control, c.pre as u16, c.acc as u16],
                    (Value::Control(r), FileType::R) => vec![r.control, r.len as u16, r.pos as u16],
                    (Value::Words(words), _) if words.len() <= size => words.clone(),
                    _ => return Err(unfit(self)),
                };
                for (offset, word) in words.into_iter().enumerate() {
                    self.write(at + offset as u32, word);
                }
            }
        }
        Ok(())
    }

    fn write(&mut self, at: u32, word: u16) {
        self.write_bits(at, word, u16::MAX);
    }

    /// Writes a word of which the bits of the mask were asked for: of an input the image of the others can be what the
    /// program or a force made of it, which its terminals are not told.
    fn write_bits(&mut self, at: u32, word: u16, mask: u16) {
        if self.clock_refuses(at, word) {
            return;
        }
        let word = self.key_latches(at, self.word(at), word);
        let at = at as usize;
        if let Some(place) = self.state.mem.get_mut(at) {
            *place = word;
        }
        // A timer whose flags or ACC are written from outside is taken as it stands, not as one that
        // was stopped by the last change of mode. PRE, the word between, says nothing about that.
        let slot_of = |at: usize| self.program.timer_slot(u32::try_from(at).ok()?);
        let is_preset = |slot: u32| slot_of(at.saturating_sub(1)) == Some(slot) && slot_of(at + 1) == Some(slot);
        let slot = slot_of(at).filter(|slot| !is_preset(*slot));
        if let Some(timer) = slot.and_then(|slot| self.state.timers.get_mut(slot as usize)) {
            timer.fresh = false;
            timer.last = self.state.now;
        }
        let (first, count) = self.program.inputs;
        if (first..first + count).contains(&at)
            && let Some(terminal) = self.state.inputs.get_mut(at - first)
        {
            *terminal = *terminal & !mask | word & mask;
        }
    }

    fn write_long(&mut self, at: u32, value: u32) {
        self.write(at, value as u16);
        self.write(at + 1, (value >> 16) as u16);
    }

    /// What an output terminal or word of terminals carries: forces applied, 0 while the controller
    /// does not run. `None` for an address that is no output.
    pub fn output(&self, address: &Address) -> Option<Value> {
        let location = self.locate(address).ok()?;
        let (first, count) = self.program.outputs;
        let at = location.word as usize;
        if !(first..first + count).contains(&at) {
            return None;
        }
        let word = *self.state.outputs.get(at - first)?;
        Some(match location.width {
            Width::Bit => Value::Bit(word >> location.bit & 1 != 0),
            _ => Value::Word(word as i16),
        })
    }

    /// What an input terminal or word of terminals carries, whatever forces make of it. `None` for an address that is no
    /// input.
    pub fn input(&self, address: &Address) -> Option<Value> {
        let location = self.locate(address).ok()?;
        let (first, count) = self.program.inputs;
        let at = location.word as usize;
        let word = *self.state.inputs.get(at.checked_sub(first).filter(|at| *at < count)?)?;
        Some(match location.width {
            Width::Bit => Value::Bit(word >> location.bit & 1 != 0),
            _ => Value::Word(word as i16),
        })
    }

    /// Installs or removes a force on an input or output bit; `None` removes. Forces act while they are
    /// enabled, see [`Machine::enable_forces`]. `false`: the address is no bit of I or O.
    pub fn force(&mut self, address: &Address, state: Option<bool>) -> bool {
        let Ok(location) = self.locate(address) else { return false };
        if location.width != Width::Bit {
            return false;
        }
        let at = location.word as usize;
        let mask = 1u16 << location.bit;
        let (input, output) = (self.program.inputs, self.program.outputs);
        let forces = if (input.0..input.0 + input.1).contains(&at) {
            self.state.input_forces.get_mut(at - input.0)
        } else if (output.0..output.0 + output.1).contains(&at) {
            self.state.output_forces.get_mut(at - output.0)
        } else {
            None
        };
        let Some((on, off)) = forces else { return false };
        *on &= !mask;
        *off |= mask;
        match state {
            Some(true) => *on |= mask,
            Some(false) => *off &= !mask,
            None => {}
        }
        let all = self.state.input_forces.iter().chain(&self.state.output_forces);
        let installed = all.into_iter().any(|force| *force != (0, 0xFFFF));
        self.core().set_status_bit(status::FORCES_INSTALLED, installed);
        true
    }

    /// Enables or disables all installed forces (S:1/5).
    pub fn enable_forces(&mut self, on: bool) {
        self.core().set_status_bit(status::FORCES_ENABLED, on);
    }

    /// All data words, files one after the other: for comparing whole states.
    pub fn data(&self) -> &[u16] {
        &self.state.mem
    }
}

/// A value in messages.
fn shown(value: &Value) -> String {
    match value {
        Value::Text(text) if text.chars().count() > 82 => {
            format!("a string of {} characters, more than 82,", text.chars().count())
        }
        Value::Text(text) => format!("\"{text}\""),
        value => crate::scenario::text(value),
    }
}

/// A string element of 42 words; `None` if it has more than 82 characters or one outside 0 to 255.
fn string_words(text: &str) -> Option<Vec<u16>> {
    let bytes: Option<Vec<u8>> = text.chars().map(|c| u8::try_from(u32::from(c)).ok()).collect();
    let bytes = bytes.filter(|bytes| bytes.len() <= 82)?;
    let mut words = vec![0u16; 42];
    if let Some(length) = words.first_mut() {
        *length = bytes.len() as u16;
    }
    for (index, byte) in bytes.iter().enumerate() {
        if let Some(word) = words.get_mut(1 + index / 2) {
            *word |= u16::from(*byte) << if index % 2 == 0 { 8 } else { 0 };
        }
    }
    Some(words)
}
