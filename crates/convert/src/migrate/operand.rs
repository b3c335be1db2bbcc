//! Operands of the original as Do-more operands and as terms of an expression.

use instr::exec::Width;
use ladder::{Address, FileType, Instruction, Number, Operand, Place};

use super::allocate::Block;
use super::context::{Context, Converted, Person};
use super::emit::{Contact, Emitter, Relation};
use super::marks::{Mark, Note};

/// A value that is read.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Its text inside an expression; a plain one is an operand of contacts and boxes too.
    pub text: String,
    /// What kind of number it is.
    pub width: Width,
    /// An element, a cast or a constant: usable outside expressions.
    pub plain: bool,
    /// The number, if it is a constant.
    pub constant: Option<Number>,
}

/// A place that is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Target {
    /// Destination operand of MATH; of MOVE and others too when plain.
    pub text: String,
    /// What kind of number it holds.
    pub width: Width,
    /// An element or a cast: not `Block[expression]`.
    pub plain: bool,
}

/// A bit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Bit {
    /// An operand of contacts and coils.
    Plain(String),
    /// Decided at run time, in a word: `block[word]` and the bit in it, both as expressions.
    InWord {
        /// `N[..]` as a term and destination.
        word: String,
        /// Number of the bit, 0 to 15 (31 in D), as an expression.
        bit: String,
    },
    /// Decided at run time, in a block of bits: `C[..]`.
    Indexed(String),
    /// As one of the others while the number of the bit, a plain operand, is 0 to 15: else it reads as 0
    /// and writing it does nothing.
    Within {
        /// Number of the bit.
        index: String,
        /// The bit.
        bit: Box<Bit>,
    },
}

/// Where a file operand (`#N7:0`, `T4:3`, ...) begins.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Start {
    /// Type of the file.
    pub file_type: FileType,
    /// The block its words lie in.
    pub block: Block,
    /// Number in the block of the element the first word lies in, as an expression; for blocks of bits
    /// that of bit 0.
    pub first: String,
    /// The same as a number, when it is fixed.
    pub fixed: Option<u32>,
    /// Words per element of the file.
    pub size: u32,
    /// Words from the first one to the end of the file; when decided at run time, those of the file.
    pub words: u32,
    /// Fixed: file and word, for [`Places::word`](super::allocate::Places::word) and the like.
    pub place: Option<(FileType, u16, u32)>,
}

fn missing(address: &Address) -> Person {
    Person::new(Mark::Operand, format!("{address} does not exist in the data table"))
}

/// An address the data table does not have.
fn beyond_note(address: &Address) -> Note {
    Note::new(Mark::Operand, format!("{address} lies beyond the original's data table: it has a place here, from 0"))
}

/// Operand `index` of an instruction.
pub fn operand(instruction: &Instruction, index: usize) -> Converted<&Operand> {
    let wrong = || Person::new(Mark::Operand, format!("{} lacks operand {}", instruction.mnemonic, index + 1));
    instruction.operands.get(index).ok_or_else(wrong)
}

/// The address at operand `index`.
pub fn address(instruction: &Instruction, index: usize) -> Converted<&Address> {
    let operand = operand(instruction, index)?;
    operand.address().ok_or_else(|| {
        Person::new(Mark::Operand, format!("{}: `{operand}` stands where an address belongs", instruction.mnemonic))
    })
}

impl Context<'_> {
    /// A value that is read, as a term of an expression. `long`: a hexadecimal constant is 32 bits wide
    /// because a long word stands beside it; else up to `FFFF` it is a signed word.
    pub fn read(&mut self, operand: &Operand, long: bool) -> Converted<Term> {
        match operand {
            Operand::Constant(constant) => {
                let term = match constant.number() {
                    Number::Float(value) => Term {
                        text: float(value),
                        width: Width::Float,
                        plain: true,
                        constant: Some(Number::Float(value)),
                    },
                    Number::Integer(value) => {
                        let value = match u32::try_from(value) {
                            Ok(bits) if constant.is_hex() && !long && bits <= 0xFFFF => i64::from(bits as u16 as i16),
                            Ok(bits) => i64::from(bits as i32),
                            Err(_) => value,
                        };
                        let width = if i16::try_from(value).is_ok() { Width::Word } else { Width::Long };
                        let constant = Some(Number::Integer(value));
                        Term { text: value.to_string(), width, plain: true, constant }
                    }
                };
                Ok(term)
            }
            Operand::Address(address) => {
                let Target { text, width, plain } = self.place(address)?;
                Ok(Term { text, width, plain, constant: None })
            }
            Operand::Symbol(symbol) => Err(Person::new(Mark::Operand, format!("symbol {symbol} has no address"))),
            Operand::Unset => Err(Person::new(Mark::Operand, "an operand was never entered")),
            other => Err(Person::new(Mark::Operand, format!("`{other}` stands where a value belongs"))),
        }
    }

    /// As [`Context::read`], and a term decided at run time is computed into a scratch first: the
    /// result is an operand of contacts and boxes. `number` tells scratches of one rung apart.
    pub fn read_plain(&mut self, e: &mut Emitter, operand: &Operand, long: bool, number: usize) -> Converted<Term> {
        let term = self.read(operand, long)?;
        if term.plain {
            return Ok(term);
        }
        let scratch = match term.width {
            Width::Float => self.scratch_float(number),
            _ => self.scratch_long(number),
        };
        e.math(&scratch, &term.text);
        Ok(Term { text: scratch, plain: true, ..term })
    }

    /// A place that is written.
    pub fn write(&mut self, operand: &Operand) -> Converted<Target> {
        match operand {
            Operand::Address(address) => {
                let target = self.place(address)?;
                if !target.plain {
                    self.needs_unconfirmed("a destination decided at run time")?;
                }
                self.status_write(address)?;
                Ok(target)
            }
            other => Err(Person::new(Mark::Operand, format!("`{other}` stands where a destination belongs"))),
        }
    }

    /// With [`Options::only_confirmed`](super::Options::only_confirmed), a form that Designer was never
    /// seen to write or read is not used.
    pub fn needs_unconfirmed(&mut self, what: &str) -> Converted {
        if self.options.only_confirmed {
            return Err(Person::new(Mark::Indirect, format!("{what}: its text form is not confirmed by Designer")));
        }
        Ok(())
    }

    /// Some operand of these is a long word, so hex constants beside it are 32 bits wide.
    pub fn any_long(&mut self, operands: &[&Operand]) -> bool {
        operands.iter().any(|operand| {
            matches!(operand, Operand::Address(address)
                if address.bit.is_none() && (address.file_type == FileType::L || is_long_member(address)))
        })
    }

    /// The value at an address, direct or not.
    fn place(&mut self, address: &Address) -> Converted<Target> {
        if address.bit.is_some() {
            return Err(Person::new(Mark::Operand, format!("{address} is a bit, a value is needed")));
        }
        if address.indexed && !self.indexes() {
            return Err(Person::new(Mark::Indirect, format!("{address}: this processor has no indexed addressing")));
        }
        if address.is_direct() {
            return self.direct(address);
        }
        let (block, number) = self.run_time(address)?;
        let width = self.width_of(address);
        if is_long_member(address) {
            return Err(Person::new(Mark::Indirect, format!("{address}: a 32-bit member decided at run time")));
        }
        if block.is_bits() {
            return Err(Person::new(Mark::Indirect, format!("{address}: words of points decided at run time")));
        }
        Ok(Target { text: format!("{}[{number}]", block.name()), width, plain: false })
    }

    fn width_of(&self, address: &Address) -> Width {
        match address.file_type {
            FileType::F => Width::Float,
            FileType::L => Width::Long,
            _ => Width::Word,
        }
    }

    fn direct(&mut self, address: &Address) -> Converted<Target> {
        let (file_type, file, word) = self.places.word_of(address).ok_or_else(|| missing(address))?;
        self.note_beyond(address);
        let span = self.places.span(file_type, file, word).ok_or_else(|| missing(address))?;
        if matches!(span.at.block, Block::D | Block::R | Block::Sl) {
            let width = if span.at.block == Block::R { Width::Float } else { Width::Long };
            if span.at.block == Block::Sl {
                return Err(Person::new(
                    Mark::Text,
                    format!(
                        "{address}: length and characters of a string are words of the original, and no numbers here"
                    ),
                ));
            }
            let element = self.places.element(file_type, file, word).ok_or_else(|| missing(address))?;
            return Ok(Target { text: element.to_string(), width, plain: true });
        }
        if span.size > 1 && address.word.is_none() {
            return Err(Person::new(Mark::Operand, format!("{address} is a structure, a value is needed")));
        }
        if is_long_member(address) {
            let text = self.places.word(file_type, file, word).ok_or_else(|| missing(address))?;
            self.function_file(address);
            return Ok(Target { text: format!("{text}:SD"), width: Width::Long, plain: true });
        }
        if file_type.is_function_file() {
            self.function_file(address);
        }
        if file_type == FileType::S {
            self.status_read(address)?;
        }
        if matches!(file_type, FileType::M0 | FileType::M1) {
            self.condition(Mark::AsyncIo, format!("{address} is module memory: here it is plain memory"));
        }
        let text = self.places.word(file_type, file, word).ok_or_else(|| {
            let why = if self.options.only_confirmed {
                "points and relays as a word: the text form is not confirmed by Designer"
            } else {
                "its points lie apart in the map, so it is no word"
            };
            Person::new(Mark::Operand, format!("{address}: {why}"))
        })?;
        Ok(Target { text, width: Width::Word, plain: true })
    }

    /// The number in the block of the word an address leads to at run time (bit left out), as an
    /// expression; for blocks of bits that of bit 0 of the word.
    fn run_time(&mut self, address: &Address) -> Converted<(Block, String)> {
        if address.file_type.has_slots() {
            return Err(Person::new(Mark::Indirect, format!("{address}: a slot decided at run time")));
        }
        let sub = u32::from(address.word.unwrap_or(0));
        let (block, base, size, elements) = match &address.file {
            Place::Number(file) => {
                let base = self.places.base(address.file_type, *file, 0).ok_or_else(|| missing(address))?;
                let size = self.places.span(address.file_type, *file, 0).map_or(1, |span| span.size.max(1));
                (base.at.block, base.at.number.to_string(), size, base.words / size)
            }
            Place::Indirect(inner) => self.file_at_run_time(address, inner)?,
        };
        let (scale, sub) = match block {
            block if block.is_bits() => (16, sub * 16),
            Block::D | Block::R | Block::Sl => (1, 0),
            _ => (size, sub),
        };
        let mut text = base;
        match &address.element {
            Place::Number(element) => add(&mut text, u32::from(*element) * scale + sub),
            Place::Indirect(inner) => {
                let index = self.index_term(inner)?;
                let limit = elements.saturating_sub(1);
                self.index_condition(inner, limit, address);
                if scale == 1 {
                    text = format!("{text} + {index}");
                } else {
                    text = format!("{text} + {index} * {scale}");
                }
                add(&mut text, sub);
            }
        }
        if address.indexed {
            let index = self.status_word(24);
            let scale = if block.is_bits() { 16 } else { 1 };
            self.condition(Mark::Indirect, format!("S:24 must lead inside the file for {address}"));
            text = if scale == 1 { format!("{text} + {index}") } else { format!("{text} + {index} * {scale}") };
        }
        Ok((block, fold(&text)))
    }

    /// An index must stay in its file, unless the program itself keeps it there.
    fn index_condition(&mut self, inner: &Address, limit: u32, address: &Address) {
        if !self.facts.stays_within(inner, 0, i32::try_from(limit).unwrap_or(i32::MAX)) {
            self.condition(Mark::Indirect, format!("{inner} must stay within 0 to {limit} for {address}"));
        }
    }

    /// The value in brackets as a term.
    fn index_term(&mut self, inner: &Address) -> Converted<String> {
        if !inner.is_direct() {
            return Err(Person::new(Mark::Indirect, format!("[{inner}]: brackets in brackets")));
        }
        let target = self.direct(inner)?;
        if target.width == Width::Float {
            return Err(Person::new(Mark::Indirect, format!("[{inner}] is a float")));
        }
        Ok(target.text)
    }

    /// A file chosen at run time: the first element of the chosen one as a chain of IF.
    fn file_at_run_time(&mut self, address: &Address, inner: &Address) -> Converted<(Block, String, u32, u32)> {
        let number = self.index_term(inner)?;
        let wanted = u32::from(address.element.number().unwrap_or(0));
        let files: Vec<_> = self
            .places
            .files(address.file_type)
            .map(|span| (span.file, span.at, span.size.max(1), span.words / span.size.max(1)))
            .filter(|file| file.3 > wanted)
            .collect();
        let Some(first) = files.first().copied() else { return Err(missing(address)) };
        if files.iter().any(|file| file.1.block != first.1.block || file.2 != first.2) {
            return Err(Person::new(Mark::Indirect, format!("{address}: its files lie in unlike memory")));
        }
        if files.len() > MOST_FILES {
            let count = files.len();
            return Err(Person::new(Mark::Indirect, format!("{address}: one of {count} files decided at run time")));
        }
        let numbers: Vec<_> = files.iter().map(|file| file.0.to_string()).collect();
        self.condition(Mark::Indirect, format!("{inner} must be one of {} for {address}", numbers.join(", ")));
        let mut text = String::new();
        for (file, at, ..) in &files {
            text.push_str(&format!("IF({number} == {file}, {}, ", at.number));
        }
        text.push_str("-1");
        text.push_str(&")".repeat(files.len()));
        let shortest = files.iter().map(|file| file.3).min().unwrap_or(0);
        Ok((first.1.block, text, first.2, shortest))
    }

    /// A bit that is read or written.
    pub fn bit(&mut self, operand: &Operand) -> Converted<Bit> {
        let Operand::Address(address) = operand else {
            return Err(match operand {
                Operand::Symbol(symbol) => Person::new(Mark::Operand, format!("symbol {symbol} has no address")),
                Operand::Unset => Person::new(Mark::Operand, "an operand was never entered"),
                other => Person::new(Mark::Operand, format!("`{other}` stands where a bit belongs")),
            });
        };
        let Some(bit) = &address.bit else {
            return Err(Person::new(Mark::Operand, format!("{address} is not a bit")));
        };
        if address.is_direct() {
            return self.direct_bit(address).map(Bit::Plain);
        }
        let word_address = Address { bit: None, ..address.clone() };
        // In a file of single words a bit number past 15 leads to the words behind, from element 0.
        let (block, number) = match word_address.is_direct() {
            true => {
                let (file_type, file, word) = self.places.word_of(&word_address).ok_or_else(|| missing(address))?;
                if file_type.has_slots() {
                    return Err(Person::new(Mark::Indirect, format!("{address}: a point decided at run time")));
                }
                let base = self.places.base(file_type, file, word).ok_or_else(|| missing(address))?;
                (base.at.block, base.at.number.to_string())
            }
            false => self.run_time(&word_address)?,
        };
        match bit {
            Place::Number(bit) if block.is_bits() => {
                let mut text = number;
                add(&mut text, u32::from(*bit));
                Ok(Bit::Indexed(format!("{}[{}]", block.name(), fold(&text))))
            }
            Place::Number(bit) => Ok(Bit::InWord { word: format!("{}[{number}]", block.name()), bit: bit.to_string() }),
            Place::Indirect(inner) => {
                let index = self.index_term(inner)?;
                // From element 0 on the bits of all words are numbered through; not where the element
                // is decided at run time too.
                let place = self.places.word_of(&word_address).filter(|place| place.2 == 0);
                let words = place.and_then(|(file_type, file, word)| self.places.base(file_type, file, word));
                let words = words.map_or(1, |base| base.words);
                let through = words > 1;
                let limit = if through { words.saturating_mul(16) - 1 } else { 15 };
                // MicroLogix 1100 to 1500 read 0 past the last bit of a word and write nothing there.
                let ends = !through && !self.slc_like();
                if !ends {
                    self.index_condition(inner, limit, address);
                }
                if ends && !self.facts.stays_within(inner, 0, 15) {
                    let bit = match block {
                        block if block.is_bits() => {
                            Bit::Indexed(format!("{}[{}]", block.name(), fold(&format!("{number} + {index}"))))
                        }
                        Block::N => Bit::InWord { word: format!("N[{number}]"), bit: index.clone() },
                        _ => {
                            return Err(Person::new(
                                Mark::Indirect,
                                format!("{address}: a bit of a long word at run time"),
                            ));
                        }
                    };
                    return Ok(Bit::Within { index, bit: Box::new(bit) });
                }
                if block.is_bits() {
                    Ok(Bit::Indexed(format!("{}[{}]", block.name(), fold(&format!("{number} + {index}")))))
                } else if matches!(block, Block::D | Block::R | Block::Sl) {
                    Err(Person::new(Mark::Indirect, format!("{address}: a bit of a long word at run time")))
                } else if through {
                    Ok(Bit::InWord {
                        word: format!("{}[{}]", block.name(), fold(&format!("{number} + {index} / 16"))),
                        bit: format!("{index} % 16"),
                    })
                } else {
                    Ok(Bit::InWord { word: format!("{}[{number}]", block.name()), bit: index })
                }
            }
        }
    }

    /// Notes what a function file is here: memory that nothing of the controller writes, the clock apart,
    /// which is copied at the beginning of each scan.
    fn function_file(&mut self, address: &Address) {
        match address.file_type {
            // Read as the clock of this controller; see the notes on the program.
            FileType::RTC => self.reads_rtc = true,
            _ => self.condition(
                Mark::AsyncIo,
                format!("{address} belongs to the original's controller: here it is memory that a person connects"),
            ),
        }
    }

    /// Notes an element the original's data table does not have.
    pub(super) fn note_beyond(&mut self, address: &Address) {
        let Some((file_type, file, word)) = self.places.word_of(address) else { return };
        if self.places.span(file_type, file, word).is_some_and(|span| word - span.first_word >= span.own) {
            self.conditions.insert(beyond_note(address));
        }
    }

    fn direct_bit(&mut self, address: &Address) -> Converted<String> {
        let (file_type, file, word) = self.places.word_of(address).ok_or_else(|| missing(address))?;
        let bit = address.bit.as_ref().and_then(Place::number).unwrap_or(0) % 16;
        if file_type == FileType::S
            && let Some(found) = self.status_bit_read(u16::try_from(word).unwrap_or(u16::MAX), bit)?
        {
            return Ok(found);
        }
        if matches!(file_type, FileType::M0 | FileType::M1) {
            self.condition(Mark::AsyncIo, format!("{address} is module memory: here it is plain memory"));
        }
        if file_type.is_function_file() {
            self.function_file(address);
        }
        self.note_beyond(address);
        self.places.bit(file_type, file, word, bit).ok_or_else(|| missing(address))
    }

    /// A bit that is written: as [`Context::bit`], with what writing a status bit means.
    pub fn bit_target(&mut self, operand: &Operand) -> Converted<Bit> {
        let bit = self.bit(operand)?;
        if let Operand::Address(address) = operand {
            self.status_write(address)?;
        }
        if bit.plain().is_none() {
            self.needs_unconfirmed("a bit decided at run time as destination")?;
        }
        Ok(bit)
    }

    /// A contact on a bit; a bit decided at run time is computed into a scratch first.
    pub fn bit_contact(&mut self, e: &mut Emitter, operand: &Operand, closed: bool) -> Converted<Contact> {
        let bit = self.bit(operand)?;
        let contact = match &bit {
            Bit::Plain(text) if closed => Contact::Off(text.clone()),
            Bit::Plain(text) => Contact::On(text.clone()),
            other => {
                let scratch = self.scratch_long(0);
                e.math(&scratch, &other.term());
                let relation = if closed { Relation::Equal } else { Relation::NotEqual };
                Contact::Compare(relation, scratch, "0".to_owned())
            }
        };
        Ok(contact)
    }

    /// Where a file operand begins; a `#` there is spelling, not S:24.
    pub fn start(&mut self, operand: &Operand) -> Converted<Start> {
        let Operand::Address(address) = operand else {
            return Err(Person::new(Mark::Operand, format!("`{operand}` stands where a file belongs")));
        };
        let plain = Address { indexed: false, ..address.clone() };
        if plain.bit.is_some() {
            return Err(Person::new(Mark::Operand, format!("{address} is a bit, a file is needed")));
        }
        if plain.is_direct() {
            let place = self.places.word_of(&plain).ok_or_else(|| missing(address))?;
            let base = self.places.base(place.0, place.1, place.2).ok_or_else(|| missing(address))?;
            let size = self.places.span(place.0, place.1, place.2).map_or(1, |span| span.size.max(1));
            return Ok(Start {
                file_type: plain.file_type,
                block: base.at.block,
                first: base.at.number.to_string(),
                fixed: Some(base.at.number),
                size,
                words: base.words,
                place: Some(place),
            });
        }
        let (block, first) = self.run_time(&plain)?;
        let (size, words) = match plain.file.number().and_then(|file| self.places.span(plain.file_type, file, 0)) {
            Some(span) => (span.size.max(1), span.words),
            None => (1, 0),
        };
        Ok(Start { file_type: plain.file_type, block, first, fixed: None, size, words, place: None })
    }
}

/// Most files a run-time choice among is written out.
const MOST_FILES: usize = 24;

impl Bit {
    /// The operand, unless it is decided at run time.
    pub fn plain(&self) -> Option<&str> {
        match self {
            Bit::Plain(text) => Some(text),
            _ => None,
        }
    }

    /// 0 or not 0, as a term of an expression.
    pub fn term(&self) -> String {
        match self {
            Bit::Plain(text) | Bit::Indexed(text) => text.clone(),
            // The order of & against comparisons is not documented.
            Bit::InWord { word, bit } => format!("(({word} >> ({bit})) & 1)"),
            Bit::Within { index, bit } => format!("IF({index} < 0, 0, IF({index} > 15, 0, {}))", bit.term()),
        }
    }

    /// Switches the bit on (or off) with power.
    pub fn write(&self, e: &mut Emitter, on: bool) {
        match self {
            Bit::Plain(text) if on => e.set(text),
            Bit::Plain(text) => e.reset(text),
            // A space would end the operand.
            Bit::Indexed(text) => e.math(&text.replace(' ', ""), if on { "1" } else { "0" }),
            Bit::InWord { word, bit } => {
                let set = format!("{word} | (1 << ({bit}))");
                let value = if on { set } else { format!("{word} & (-1 - (1 << ({bit})))") };
                e.math(&word.replace(' ', ""), &sign_extended(&value));
            }
            Bit::Within { index, bit } => e.when(|e| {
                e.and_compare(Relation::GreaterOrEqual, index, "0");
                e.and_compare(Relation::LessOrEqual, index, "15");
                bit.write(e, on);
            }),
        }
    }
}

/// The low 16 bits of an integer expression as a signed word.
pub fn sign_extended(expression: &str) -> String {
    format!("((({expression}) + 32768) & 65535) - 32768")
}

fn is_long_member(address: &Address) -> bool {
    let Some(word) = address.word else { return false };
    address.bit.is_none() && ladder::members_of(address.file_type).any(|member| member.long && member.word == word)
}

/// A float as an expression spells it.
pub fn float(value: f32) -> String {
    let text = format!("{value:?}");
    if text.contains(['.', 'e', 'E', 'N', 'i']) { text } else { format!("{text}.0") }
}

fn add(text: &mut String, number: u32) {
    if number > 0 {
        text.push_str(&format!(" + {number}"));
    }
}

/// Adds up the plain numbers of a sum: `100 + 3 + N0` becomes `103 + N0`.
fn fold(text: &str) -> String {
    // Only sums of the forms made above: no parentheses but those of IF, which stands first.
    if text.starts_with("IF(") {
        return text.to_owned();
    }
    let (mut sum, mut rest) = (0u64, Vec::new());
    for part in text.split(" + ") {
        match part.parse::<u64>() {
            Ok(number) => sum += number,
            Err(_) => rest.push(part),
        }
    }
    if rest.is_empty() {
        return sum.to_string();
    }
    if sum == 0 { rest.join(" + ") } else { format!("{sum} + {}", rest.join(" + ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_fold() {
        assert_eq!(fold("100 + 3 + N0 * 3 + 2"), "105 + N0 * 3");
        assert_eq!(fold("0 + N0"), "N0");
        assert_eq!(fold("7"), "7");
        assert_eq!(float(1.0), "1.0");
        assert_eq!(float(1e20), "1e20");
    }
}
