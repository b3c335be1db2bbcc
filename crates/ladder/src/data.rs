//! Data files: words, and the values engineers read in them.

use std::fmt;

use crate::{Address, FileType, Place};

/// A data table file or function file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataFile {
    /// File number; for function files the number in the name (`ES1` is 1), mostly 0.
    pub number: u16,
    /// Type of its elements.
    pub file_type: FileType,
    /// Name, at most 10 characters; empty for function files.
    pub name: String,
    /// Description.
    pub description: String,
    /// Number of elements.
    pub elements: u16,
    /// 16-bit words per element.
    pub words_per_element: u16,
    /// `elements * words_per_element` words, element after element.
    pub words: Vec<u16>,
    /// One per word of O and I files; empty for all other types.
    pub forces: Vec<Force>,
}

/// The force masks of one I/O word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Force {
    /// Bits forced on.
    pub on: u16,
    /// Bits *not* forced off: 0xFFFF when nothing is.
    pub off: u16,
}

impl Force {
    /// Nothing forced.
    pub const NONE: Force = Force { on: 0, off: 0xFFFF };

    /// What a word becomes under the force.
    pub fn apply(self, word: u16) -> u16 {
        (word | self.on) & self.off
    }
}

/// Time base of a timer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TimeBase {
    /// 0.001 s.
    Millisecond,
    /// 0.01 s.
    Centisecond,
    /// 1.0 s.
    Second,
}

impl TimeBase {
    /// The spelling in a timer's box: `1.0`, `0.01`, `0.001`.
    pub fn text(self) -> &'static str {
        match self {
            TimeBase::Millisecond => "0.001",
            TimeBase::Centisecond => "0.01",
            TimeBase::Second => "1.0",
        }
    }

    /// Reads the spelling of a box or of a printed data table (`.01`, `0.010`, `1.0`, `1`).
    pub fn from_text(text: &str) -> Option<TimeBase> {
        let seconds: f64 = text.trim().parse().ok()?;
        [TimeBase::Millisecond, TimeBase::Centisecond, TimeBase::Second]
            .into_iter()
            .find(|base| base.text().parse() == Ok(seconds))
    }

    /// Milliseconds per tick.
    pub fn milliseconds(self) -> u32 {
        match self {
            TimeBase::Millisecond => 1,
            TimeBase::Centisecond => 10,
            TimeBase::Second => 1000,
        }
    }

    /// From bits 9..8 of a timer's control word; `None` for the unused combination.
    pub fn from_control(control: u16) -> Option<TimeBase> {
        match (control >> 8) & 3 {
            0 => Some(TimeBase::Centisecond),
            1 => Some(TimeBase::Millisecond),
            2 => Some(TimeBase::Second),
            _ => None,
        }
    }

    /// Bits 9..8 of a timer's control word.
    pub fn control_bits(self) -> u16 {
        match self {
            TimeBase::Centisecond => 0,
            TimeBase::Millisecond => 0x0100,
            TimeBase::Second => 0x0200,
        }
    }

    /// Seconds of this many ticks, without rounding: `5000` ticks of 0.01 s are `50`.
    pub fn seconds_text(self, ticks: i32) -> String {
        let milliseconds = i64::from(ticks) * i64::from(self.milliseconds());
        let sign = if milliseconds < 0 { "-" } else { "" };
        let (whole, part) = (milliseconds.abs() / 1000, milliseconds.abs() % 1000);
        let text = format!("{sign}{whole}.{part:03}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}

impl fmt::Display for TimeBase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}

/// A timer element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimerElement {
    /// The whole control word: EN 15, TT 14, DN 13, time base 9..8.
    pub control: u16,
    /// Preset in ticks.
    pub pre: i16,
    /// Accumulated ticks.
    pub acc: i16,
}

impl TimerElement {
    /// Enabled.
    pub fn en(&self) -> bool {
        self.control & 0x8000 != 0
    }
    /// Timing.
    pub fn tt(&self) -> bool {
        self.control & 0x4000 != 0
    }
    /// Done.
    pub fn dn(&self) -> bool {
        self.control & 0x2000 != 0
    }
    /// The time base, `None` for the combination no processor uses.
    pub fn base(&self) -> Option<TimeBase> {
        TimeBase::from_control(self.control)
    }
}

/// A counter element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CounterElement {
    /// The whole control word: CU 15, CD 14, DN 13, OV 12, UN 11, UA 10.
    pub control: u16,
    /// Preset.
    pub pre: i16,
    /// Accumulated value.
    pub acc: i16,
}

/// A control element of file, sequencer and ASCII instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ControlElement {
    /// The whole control word: EN 15, EU 14, DN 13, EM 12, ER 11, UL 10, IN 9, FD 8.
    pub control: u16,
    /// Length.
    pub len: i16,
    /// Position.
    pub pos: i16,
}

/// The value of an element or of an addressed part of it.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// One bit.
    Bit(bool),
    /// A 16-bit word, signed as the processor computes with it.
    Word(i16),
    /// A long word.
    Long(i32),
    /// A float.
    Float(f32),
    /// A timer.
    Timer(TimerElement),
    /// A counter.
    Counter(CounterElement),
    /// A control element.
    Control(ControlElement),
    /// A string; its bytes read as Windows-1252.
    Text(String),
    /// An element of any other structure, as words.
    Words(Vec<u16>),
}

impl DataFile {
    /// A data file of `elements` zero elements. Types without a fixed size get one word.
    pub fn new(file_type: FileType, number: u16, elements: u16) -> DataFile {
        let words_per_element = file_type.words_per_element().unwrap_or(1);
        let io = matches!(file_type, FileType::O | FileType::I);
        DataFile {
            number,
            file_type,
            name: String::new(),
            description: String::new(),
            elements,
            words_per_element,
            words: vec![0; usize::from(elements) * usize::from(words_per_element)],
            forces: if io { vec![Force::NONE; usize::from(elements)] } else { Vec::new() },
        }
    }

    /// `N7`, `T4`; function files without their number when it is 0 (`HSC`); `?15-7` for file 7 of a
    /// type that has no known letters.
    pub fn label(&self) -> String {
        match self.file_type.implied_file() {
            Some(number) if self.file_type.is_function_file() && number == self.number => self.file_type.to_string(),
            // The type number would run into the file number.
            _ if matches!(self.file_type, FileType::Unknown(_)) => format!("{}-{}", self.file_type, self.number),
            _ => format!("{}{}", self.file_type, self.number),
        }
    }

    /// Words as RSLogix counts them in the data file list of its printouts: three per element of O
    /// and I (value and two force masks), none of the status file, else those of the elements.
    pub fn listed_words(&self) -> usize {
        match self.file_type {
            FileType::O | FileType::I => 3 * usize::from(self.elements),
            FileType::S => 0,
            _ => usize::from(self.elements) * usize::from(self.words_per_element),
        }
    }

    /// The words of an element, or `None` beyond the file's end.
    pub fn element_words(&self, element: u16) -> Option<&[u16]> {
        if element >= self.elements {
            return None;
        }
        let size = usize::from(self.words_per_element);
        let start = usize::from(element).checked_mul(size)?;
        self.words.get(start..start.checked_add(size)?)
    }

    /// The value of a whole element as its type reads it.
    pub fn value(&self, element: u16) -> Option<Value> {
        let words = self.element_words(element)?;
        Some(match (self.file_type, words) {
            (FileType::T, &[control, pre, acc]) => {
                Value::Timer(TimerElement { control, pre: pre as i16, acc: acc as i16 })
            }
            (FileType::C, &[control, pre, acc]) => {
                Value::Counter(CounterElement { control, pre: pre as i16, acc: acc as i16 })
            }
            (FileType::R, &[control, len, pos]) => {
                Value::Control(ControlElement { control, len: len as i16, pos: pos as i16 })
            }
            (FileType::F, &[low, high]) => Value::Float(f32::from_bits(long(low, high))),
            (FileType::L, &[low, high]) => Value::Long(long(low, high) as i32),
            (FileType::ST, words) => Value::Text(string(words)),
            (_, &[word]) => Value::Word(word as i16),
            (_, words) => Value::Words(words.to_vec()),
        })
    }

    /// The timer at this element, if this is a timer file and has it.
    pub fn timer(&self, element: u16) -> Option<TimerElement> {
        match self.value(element)? {
            Value::Timer(timer) => Some(timer),
            _ => None,
        }
    }

    /// The counter at this element, if this is a counter file and has it.
    pub fn counter(&self, element: u16) -> Option<CounterElement> {
        match self.value(element)? {
            Value::Counter(counter) => Some(counter),
            _ => None,
        }
    }

    /// The value at a direct address of this file, bits and members included. O and I addresses
    /// name slots: resolve them with [`crate::IoConfiguration::word_index`] first and ask for the
    /// word as an element.
    pub fn value_at(&self, address: &Address) -> Option<Value> {
        let element = address.element.number()?;
        let words = self.element_words(element)?;
        let bit = match &address.bit {
            None => None,
            Some(Place::Number(bit)) => Some(*bit),
            Some(Place::Indirect(_)) => return None,
        };
        let first = usize::from(address.word.unwrap_or(0));
        match bit {
            Some(bit) => {
                let word = words.get(first + usize::from(bit / 16))?;
                Some(Value::Bit(word >> (bit % 16) & 1 != 0))
            }
            None if address.word.is_none() => self.value(element),
            None => {
                let long_member = crate::members_of(self.file_type).any(|m| m.long && usize::from(m.word) == first);
                let low = *words.get(first)?;
                match words.get(first + 1) {
                    Some(&high) if long_member => Some(Value::Long(long(low, high) as i32)),
                    _ => Some(Value::Word(low as i16)),
                }
            }
        }
    }

    /// Any word is forced.
    pub fn has_forces(&self) -> bool {
        self.forces.iter().any(|force| *force != Force::NONE)
    }
}

/// Two words, low word first.
fn long(low: u16, high: u16) -> u32 {
    u32::from(low) | u32::from(high) << 16
}

/// A string element: length word, then two characters per word, the first in the high byte.
fn string(words: &[u16]) -> String {
    let Some((&length, text)) = words.split_first() else { return String::new() };
    let bytes = text.iter().flat_map(|word| word.to_be_bytes());
    bytes.take(usize::from(length)).map(char_of).collect()
}

/// Windows-1252, the code page of the projects; its five unassigned codes stay control characters.
fn char_of(byte: u8) -> char {
    const HIGH: [char; 32] = [
        '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8D}', 'Ž', '\u{8F}', '\u{90}', '‘',
        '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9D}', 'ž', 'Ÿ',
    ];
    match byte {
        0x80..=0x9F => HIGH.get(usize::from(byte - 0x80)).copied().unwrap_or('?'),
        other => char::from(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(file_type: FileType, words: &[u16]) -> DataFile {
        let mut file = DataFile::new(file_type, 9, 1);
        file.words[..words.len()].copy_from_slice(words);
        file
    }

    #[test]
    fn elements_read_as_their_type() {
        let timer = file(FileType::T, &[0xA200, 5994, 12]).timer(0).expect("timer");
        assert_eq!((timer.en(), timer.tt(), timer.dn(), timer.base()), (true, false, true, Some(TimeBase::Second)));
        assert_eq!(timer.pre, 5994);
        assert_eq!(file(FileType::F, &[0x0000, 0x3FC0]).value(0), Some(Value::Float(1.5)));
        assert_eq!(file(FileType::L, &[0xFFFF, 0xFFFF]).value(0), Some(Value::Long(-1)));
        assert_eq!(file(FileType::ST, &[3, 0x4142, 0x4344]).value(0), Some(Value::Text("ABC".into())));
        assert_eq!(file(FileType::N, &[0xFFFE]).value(0), Some(Value::Word(-2)));
        assert_eq!(file(FileType::N, &[1]).value(1), None);
    }

    #[test]
    fn addressed_parts() {
        let at = |file: &DataFile, text: &str| file.value_at(&Address::parse(text).expect("address"));
        let timer = file(FileType::T, &[0x2000, 100, 7]);
        assert_eq!(at(&timer, "T9:0.ACC"), Some(Value::Word(7)));
        assert_eq!(at(&timer, "T9:0/DN"), Some(Value::Bit(true)));
        assert_eq!(at(&timer, "T9:0.PRE/2"), Some(Value::Bit(true)));
        let long = file(FileType::L, &[0, 0x8000]);
        assert_eq!(at(&long, "L9:0/31"), Some(Value::Bit(true)));
    }

    #[test]
    fn seconds_are_exact() {
        for (base, ticks, text) in [
            (TimeBase::Centisecond, 50, "0.5"),
            (TimeBase::Centisecond, 300, "3"),
            (TimeBase::Centisecond, 32000, "320"),
            (TimeBase::Second, 5994, "5994"),
            (TimeBase::Millisecond, 1, "0.001"),
            (TimeBase::Millisecond, -1500, "-1.5"),
        ] {
            assert_eq!(base.seconds_text(ticks), text);
        }
    }
}
