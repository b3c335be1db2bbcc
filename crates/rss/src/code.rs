//! The compiled code of an instruction: how operands are encoded, apart from what the instruction does with them.
//!
//! `code := u8 opcode, operand*`, or for an expression `8A step* 8B` with
//! `step := u8 operator, operand A, operand B, operand result`. An operand takes
//! six bytes, and those of its indirections follow it:
//!
//! | bytes | operand |
//! |---|---|
//! | `00 02` i16 `00 00` | 16-bit constant |
//! | `00 01` i32 | 32-bit constant |
//! | `00 04` f32 | float constant |
//! | six zeros | top of the expression stack |
//! | u16 flags, u16 place, u8 file, u8 element, then file, element, bit operands | address |
//!
//! Decoding accepts only what encoding gives back byte for byte; for anything
//! else it says where it stopped, and the caller keeps the bytes.

use std::fmt;

/// Opens an expression (first byte of the code).
pub const EXPRESSION_START: u8 = 0x8A;
/// Closes an expression (last byte of the code).
pub const EXPRESSION_END: u8 = 0x8B;

/// Address in an operand of an address lies this deep at most (known: 1).
const MAX_INDIRECTION: usize = 8;

mod flag {
    pub(super) const ADDRESS: u16 = 0x0001;
    pub(super) const FILE: u16 = 0x0002;
    pub(super) const ELEMENT: u16 = 0x0004;
    pub(super) const WORD: u16 = 0x0008;
    pub(super) const BIT: u16 = 0x0010;
    pub(super) const BIT_BY: u16 = 0x0040;
    pub(super) const WIDE: u16 = 0x0080;
    pub(super) const NARROW: u16 = 0x0800;
    pub(super) const ELEMENT_BY: u16 = 0x2000;
    pub(super) const FILE_BY: u16 = 0x4000;
    pub(super) const INDEXED: u16 = 0x8000;
}

/// First u16 of the operands that are no address.
const STACK: u16 = 0;
const INT: u16 = 0x0200;
const LONG: u16 = 0x0100;
const FLOAT: u16 = 0x0400;

/// Type codes from here on take the wide form of the place field.
const FIRST_WIDE_TYPE: u8 = 16;

/// An operand of compiled code.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Operand {
    /// A 16-bit constant.
    Int(i16),
    /// A 32-bit constant.
    Long(i32),
    /// A float constant, by its bits, so that every value compares and comes back.
    Float(u32),
    /// The top of the expression stack.
    Stack,
    /// An address.
    Address(Box<Address>),
}

/// Where a file, element or bit number comes from.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Place {
    /// A number in the code.
    Number(u8),
    /// The value of another address, e.g. `[N7:0]`.
    By(Operand),
}

/// Which file an address lies in.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum FilePlace {
    /// A data table file.
    Data(Place),
    /// A function file, with the number in its name: `ES1` is 1, `HSC` is 0.
    Function(u8),
}

/// An address in compiled code.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Address {
    /// Type code of the file, as in the data file streams.
    pub type_code: u8,
    /// File.
    pub file: FilePlace,
    /// Element; for inputs and outputs the slot.
    pub element: Place,
    /// Word inside the element; for inputs and outputs the word of the slot.
    pub word: Option<u8>,
    /// Bit.
    pub bit: Option<Place>,
    /// Indexed, or the start of a run of elements: written with `#`.
    pub indexed: bool,
}

/// One step of an expression, in post-order: takes its stack operands off the stack
/// (B was pushed last) and puts its result on it, or into an address.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Step {
    /// Opcode of the operation.
    pub operator: u8,
    /// First operand.
    pub a: Operand,
    /// Second operand.
    pub b: Operand,
    /// Where the result goes.
    pub result: Operand,
}

/// Compiled code of one instruction.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Code {
    /// Opcode and operands.
    Operands {
        /// First byte, equal to the instruction's opcode.
        opcode: u8,
        /// Operands in code order, which need not be that of the texts.
        operands: Vec<Operand>,
    },
    /// An expression.
    Expression(Vec<Step>),
}

/// Why code could not be decoded (or encoded).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CodeError {
    /// Offset in the code.
    pub offset: usize,
    /// What is there.
    pub found: String,
}

impl fmt::Display for CodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "code byte {}: {}", self.offset, self.found)
    }
}

impl std::error::Error for CodeError {}

impl Code {
    /// Decodes the code of an instruction.
    ///
    /// ```
    /// use rss::code::{Code, Operand};
    /// let bytes = [0x39, 0x17, 0x08, 0xF3, 0x00, 0x03, 0x00]; // B3:0/15
    /// let code = Code::decode(&bytes)?;
    /// let Code::Operands { operands, .. } = &code else { panic!() };
    /// let [Operand::Address(a)] = &operands[..] else { panic!() };
    /// assert_eq!((a.type_code, a.word), (3, None));
    /// assert_eq!(code.encode()?, bytes);
    /// # Ok::<(), rss::code::CodeError>(())
    /// ```
    ///
    /// # Errors
    /// The first place that is no operand of a known form.
    pub fn decode(bytes: &[u8]) -> Result<Self, CodeError> {
        let mut cursor = Cursor { bytes, pos: 0 };
        let opcode = cursor.u8()?;
        if opcode == EXPRESSION_START {
            let mut steps = Vec::with_capacity(bytes.len() / 19);
            loop {
                match cursor.u8()? {
                    EXPRESSION_END if cursor.pos == bytes.len() => return Ok(Code::Expression(steps)),
                    operator => {
                        let mut operand = || cursor.operand(0);
                        steps.push(Step { operator, a: operand()?, b: operand()?, result: operand()? });
                    }
                }
            }
        }
        let mut operands = Vec::with_capacity(bytes.len() / 6);
        while cursor.pos < bytes.len() {
            operands.push(cursor.operand(0)?);
        }
        Ok(Code::Operands { opcode, operands })
    }

    /// The bytes of the code.
    ///
    /// # Errors
    /// If a number does not fit its field.
    pub fn encode(&self) -> Result<Vec<u8>, CodeError> {
        let mut out = Vec::with_capacity(32);
        match self {
            Code::Operands { opcode, operands } => {
                out.push(*opcode);
                operands.iter().try_for_each(|o| o.encode(&mut out))?;
            }
            Code::Expression(steps) => {
                out.push(EXPRESSION_START);
                for step in steps {
                    out.push(step.operator);
                    [&step.a, &step.b, &step.result].into_iter().try_for_each(|o| o.encode(&mut out))?;
                }
                out.push(EXPRESSION_END);
            }
        }
        Ok(out)
    }
}

struct Cursor<'a> {
    bytes: &'a [u8],
    pos: usize,
}

impl Cursor<'_> {
    fn fail<T>(&self, offset: usize, found: impl Into<String>) -> Result<T, CodeError> {
        Err(CodeError { offset, found: found.into() })
    }

    fn u8(&mut self) -> Result<u8, CodeError> {
        match self.bytes.get(self.pos) {
            Some(&b) => {
                self.pos += 1;
                Ok(b)
            }
            None => self.fail(self.pos, "the end of the code"),
        }
    }

    fn operand(&mut self, depth: usize) -> Result<Operand, CodeError> {
        let at = self.pos;
        let Some(&[f0, f1, b2, b3, b4, b5]) = self.bytes.get(at..).and_then(|rest| rest.first_chunk::<6>()) else {
            return self.fail(at, format!("{} bytes where an operand takes 6", self.bytes.len() - at));
        };
        self.pos += 6;
        let flags = u16::from_le_bytes([f0, f1]);
        match (flags, [b2, b3, b4, b5]) {
            (STACK, [0, 0, 0, 0]) => Ok(Operand::Stack),
            (INT, [low, high, 0, 0]) => Ok(Operand::Int(i16::from_le_bytes([low, high]))),
            (LONG, value) => Ok(Operand::Long(i32::from_le_bytes(value))),
            (FLOAT, value) => Ok(Operand::Float(u32::from_le_bytes(value))),
            (_, [low, high, file, element]) if flags & flag::ADDRESS != 0 => {
                self.address(at, flags, u16::from_le_bytes([low, high]), file, element, depth)
            }
            _ => self.fail(at, format!("an operand of unknown form, flags {flags:#06x}")),
        }
    }

    fn address(
        &mut self,
        at: usize,
        flags: u16,
        place: u16,
        file: u8,
        element: u8,
        depth: usize,
    ) -> Result<Operand, CodeError> {
        if depth >= MAX_INDIRECTION {
            return self.fail(at, format!("indirection deeper than {MAX_INDIRECTION}"));
        }
        let has = |bit: u16| flags & bit != 0;
        let [low, high] = place.to_le_bytes();
        let (type_code, bit, word) = match has(flag::WIDE) {
            // Masks and shifts leave 6, 5 and 5 bits, 4, 4 and 8 bits.
            true => ((place & 0x3F) as u8, ((place >> 6) & 0x1F) as u8, high >> 3),
            false => (low & 0x0F, low >> 4, high),
        };
        let file = match (has(flag::FILE_BY), has(flag::FILE)) {
            (true, false) => FilePlace::Data(Place::By(self.operand(depth + 1)?)),
            (false, true) => FilePlace::Data(Place::Number(file)),
            (false, false) => FilePlace::Function(file),
            (true, true) => return self.fail(at, format!("a file both direct and indirect, flags {flags:#06x}")),
        };
        let element = match has(flag::ELEMENT_BY) {
            true => Place::By(self.operand(depth + 1)?),
            false => Place::Number(element),
        };
        let bit = match (has(flag::BIT_BY), has(flag::BIT)) {
            (true, _) => Some(Place::By(self.operand(depth + 1)?)),
            (false, true) => Some(Place::Number(bit)),
            (false, false) => None,
        };
        let word = has(flag::WORD).then_some(word);
        let address =
            Operand::Address(Box::new(Address { type_code, file, element, word, bit, indexed: has(flag::INDEXED) }));
        // Whatever the fields above do not express (unknown flags, values in
        // fields said to be absent) shows as a difference here.
        let mut again = Vec::with_capacity(24);
        address.encode(&mut again)?;
        if self.bytes.get(at..self.pos) != Some(&again[..]) {
            return self.fail(at, format!("an address of unknown form, flags {flags:#06x}, place {place:#06x}"));
        }
        Ok(address)
    }
}

impl Operand {
    /// Appends the bytes of the operand and of its indirections.
    ///
    /// # Errors
    /// If a number does not fit its field.
    pub fn encode(&self, out: &mut Vec<u8>) -> Result<(), CodeError> {
        let mut six = |first: u16, rest: [u8; 4]| {
            out.extend_from_slice(&first.to_le_bytes());
            out.extend_from_slice(&rest);
        };
        match self {
            Operand::Stack => six(STACK, [0; 4]),
            Operand::Int(v) => {
                let [low, high] = v.to_le_bytes();
                six(INT, [low, high, 0, 0]);
            }
            Operand::Long(v) => six(LONG, v.to_le_bytes()),
            Operand::Float(bits) => six(FLOAT, bits.to_le_bytes()),
            Operand::Address(address) => return address.encode(out),
        }
        Ok(())
    }

    /// A float constant.
    #[must_use]
    pub fn float(value: f32) -> Self {
        Operand::Float(value.to_bits())
    }
}

impl Address {
    fn encode(&self, out: &mut Vec<u8>) -> Result<(), CodeError> {
        let wide = self.type_code >= FIRST_WIDE_TYPE;
        let mut flags = flag::ADDRESS | if wide { flag::WIDE } else { flag::NARROW };
        let mut set = |on: bool, bit: u16| flags |= if on { bit } else { 0 };
        set(self.indexed, flag::INDEXED);
        set(self.word.is_some(), flag::WORD);
        let (file, file_by) = match &self.file {
            FilePlace::Data(Place::Number(n)) => {
                set(true, flag::FILE);
                (*n, None)
            }
            FilePlace::Data(Place::By(o)) => {
                set(true, flag::FILE_BY);
                (0, Some(o))
            }
            FilePlace::Function(n) => (*n, None),
        };
        let (element, element_by) = match &self.element {
            Place::Number(n) => (*n, None),
            Place::By(o) => (0, Some(o)),
        };
        set(element_by.is_none(), flag::ELEMENT);
        set(element_by.is_some(), flag::ELEMENT_BY);
        let (bit, bit_by) = match &self.bit {
            None => (0, None),
            Some(Place::Number(n)) => {
                set(true, flag::BIT);
                (*n, None)
            }
            Some(Place::By(o)) => {
                set(true, flag::BIT_BY);
                (0, Some(o))
            }
        };
        let word = self.word.unwrap_or(0);
        let (max_bit, max_word, max_type) = if wide { (31, 31, 63) } else { (15, 255, 15) };
        if bit > max_bit || word > max_word || self.type_code > max_type {
            let found = format!("type {}, word {word}, bit {bit}: more than the field holds", self.type_code);
            return Err(CodeError { offset: out.len(), found });
        }
        let (ty, bit, word) = (u16::from(self.type_code), u16::from(bit), u16::from(word));
        let place = if wide { word << 11 | bit << 6 | ty } else { word << 8 | bit << 4 | ty };
        out.extend_from_slice(&flags.to_le_bytes());
        out.extend_from_slice(&place.to_le_bytes());
        out.extend_from_slice(&[file, element]);
        [file_by, element_by, bit_by].into_iter().flatten().try_for_each(|o| o.encode(out))
    }
}

#[cfg(test)]
mod tests;
