//! Operands of instructions bound to memory.

use super::op::{Compiled, CopyRow, Piece, Source, Span, Target};
use crate::address::{Address, Cast, Element, Operand, columns, unquote, written_columns};
use crate::math::IndexedPlace;
use crate::memory::{Block, ElementType, Kind, Num, Place, Resolved};

/// What is wrong with an operand, in words.
pub(crate) type Why = String;

/// The characters of a literal; `$0D` is one by its number. (Designer export)
fn characters(literal: &str) -> Result<Vec<u8>, Why> {
    let mut found = Vec::new();
    let mut rest = literal.chars();
    while let Some(c) = rest.next() {
        let wrong = || format!("{literal}: `{c}` in a literal is not decoded");
        match c {
            '$' => {
                let digits: String = rest.by_ref().take(2).collect();
                found.push(u8::from_str_radix(&digits, 16).ok().filter(|_| digits.len() == 2).ok_or_else(wrong)?);
            }
            '"' => return Err(wrong()),
            c => found.push(u8::try_from(u32::from(c)).map_err(|_| wrong())?),
        }
    }
    Ok(found)
}

impl Compiled {
    fn operand(&self, text: &str) -> Result<Operand, Why> {
        Operand::parse_with(text, |block| self.map.radix(block)).map_err(|error| error.to_string())
    }

    fn resolve(&self, text: &str) -> Result<(Address, Resolved), Why> {
        match self.operand(text)? {
            Operand::Address(address) => {
                let resolved = self.map.resolve(&address).map_err(|error| error.to_string())?;
                Ok((address, resolved))
            }
            _ => Err(format!("{text}: expected an element")),
        }
    }

    fn index(&mut self, block: usize, expression: &str, address: &Address) -> Result<(u32, Kind), Why> {
        let block = self.map.blocks().get(block).ok_or("no such block")?;
        let Resolved::Place(first) = crate::memory::member(block, 0, address)? else {
            return Err(format!("{address}: name a member"));
        };
        let place = IndexedPlace::bind(&self.map, block, expression, address)?;
        self.indexed.push(place);
        Ok((self.indexed.len() as u32 - 1, first.kind))
    }

    /// A number: constant, element, named constant, indexed element.
    pub(crate) fn source(&mut self, text: &str) -> Result<Source, Why> {
        if let Operand::Constant(constant) = self.operand(text)? {
            return Ok(Source::Constant(Num::of(constant.value)));
        }
        let (address, resolved) = self.resolve(text)?;
        match resolved {
            Resolved::Constant(value) => Ok(Source::Constant(value)),
            Resolved::Place(Place { kind: Kind::Text(_), .. }) => Err(format!("{text} is a string, expected a number")),
            Resolved::Place(place) => Ok(Source::Place(place)),
            Resolved::Structure(..) => Err(format!("{text} is a whole structure: expected a member")),
            Resolved::Indexed { block, expression } => match self.index(block, &expression, &address)? {
                (_, Kind::Text(_)) => Err(format!("{text} is a string, expected a number")),
                (index, _) => Ok(Source::Indexed(index)),
            },
        }
    }

    /// A preset or a time: as a constant one that 32 bits hold, which is the most a structure can. (help DMD0177, DMD0030)
    pub(crate) fn preset(&mut self, text: &str) -> Result<Source, Why> {
        let source = self.source(text)?;
        let beyond = match source {
            Source::Constant(Num::Int(value)) => i32::try_from(value).is_err(),
            Source::Constant(Num::Real(value)) => !(-2_147_483_648.0..2_147_483_648.0).contains(&value),
            _ => false,
        };
        if beyond { Err(format!("{text}: a preset goes up to {}", i32::MAX)) } else { Ok(source) }
    }

    /// A place to write a number.
    pub(crate) fn target(&mut self, text: &str) -> Result<Target, Why> {
        match self.source(text)? {
            Source::Constant(_) => Err(format!("{text}: a constant cannot be written")),
            Source::Place(place) if place.read_only => Err(format!("{text} is read-only")),
            Source::Place(place) => Ok(Target::Place(place)),
            Source::Indexed(index) => Ok(Target::Indexed(index)),
        }
    }

    /// A bit to examine: its place, or what finds it.
    pub(crate) fn contact(&mut self, text: &str) -> Result<Source, Why> {
        let bits = |place: &Place| place.kind == Kind::Bit;
        match self.source(text)? {
            Source::Place(place) if bits(&place) => Ok(Source::Place(place)),
            Source::Indexed(index) => Ok(Source::Indexed(index)),
            _ => Err(format!("{text} is no bit")),
        }
    }

    /// A bit to write.
    pub(crate) fn coil(&mut self, text: &str) -> Result<u32, Why> {
        match self.target(text)? {
            Target::Place(place) if place.kind == Kind::Bit => Ok(place.bit),
            Target::Place(_) => Err(format!("{text} is no bit")),
            Target::Indexed(_) => Err(format!("{text}: a coil found by index is not modelled")),
        }
    }

    /// The first bit of a whole structure.
    pub(crate) fn structure(&self, text: &str, wanted: ElementType) -> Result<u32, Why> {
        match self.resolve(text)?.1 {
            Resolved::Structure(found, bit) if found == wanted => Ok(bit),
            _ if wanted == ElementType::Timer => Err(format!("{text} is no timer structure")),
            _ => Err(format!("{text} is no counter structure")),
        }
    }

    /// Elements in a row from a first one, or a constant repeated.
    pub(crate) fn span(&mut self, text: &str) -> Result<Span, Why> {
        if let Operand::Constant(constant) = self.operand(text)? {
            return Ok(Span::Constant(Num::of(constant.value)));
        }
        let (address, resolved) = self.resolve(text)?;
        let stride = |block: &Block| match address.cast {
            Some(Cast::As(view, None)) => Ok(view.bits()),
            None => Ok(block.element.bits()),
            Some(_) => Err(format!("{text}: a range of parts is not modelled")),
        };
        match resolved {
            Resolved::Constant(value) => Ok(Span::Constant(value)),
            Resolved::Structure(..) => Err(format!("{text}: structures are copied by member only")),
            Resolved::Place(place) => {
                let block = self.map.blocks().iter().find(|block| block.bits().contains(&place.bit));
                let block = block.ok_or_else(|| format!("{text}: no element that a range begins with"))?;
                // A member or part is a range of its own.
                let alone =
                    address.field.is_some() || matches!(address.cast, Some(cast) if !matches!(cast, Cast::As(_, None)));
                let (stride, room) = if alone {
                    (0, 1)
                } else {
                    let stride = stride(block)?;
                    let end = block.start + block.count * block.element.bits();
                    (stride, (end - place.bit) / stride.max(1))
                };
                Ok(Span::Fixed { first: place, stride, room })
            }
            Resolved::Indexed { block, expression } => {
                let (bits, end) = {
                    let block = self.map.blocks().get(block).ok_or("no such block")?;
                    (stride(block)?, block.start + block.count * block.element.bits())
                };
                let (first, kind) = self.index(block, &expression, &address)?;
                if matches!(kind, Kind::Text(_)) || address.field.is_some() {
                    return Err(format!("{text}: a range of these is not modelled"));
                }
                Ok(Span::Indexed { first, stride: bits, end })
            }
        }
    }

    /// The columns of a table operand behind the number of columns, which must be `width`.
    pub(crate) fn table(&self, text: &str, width: usize) -> Result<Vec<String>, Why> {
        let Operand::Quoted(inside) = self.operand(text)? else {
            return Err(format!("{text}: expected a table in quotes"));
        };
        let mut cells = columns(&inside).map_err(|error| error.to_string())?;
        if cells.is_empty() || cells.remove(0) != width.to_string() || !cells.len().is_multiple_of(width) {
            return Err(format!("{text}: expected a table of {width} columns"));
        }
        Ok(cells)
    }

    /// A string to write.
    pub(crate) fn text_place(&self, text: &str) -> Result<Place, Why> {
        match self.resolve(text)?.1 {
            Resolved::Place(place @ Place { kind: Kind::Text(_), read_only: false, .. }) => Ok(place),
            _ => Err(format!("{text} is no string")),
        }
    }

    /// What STRPRINT writes: literals and strings.
    pub(crate) fn pieces(&self, text: &str) -> Result<Vec<Piece>, Why> {
        let Operand::Quoted(inside) = self.operand(text)? else {
            return Err(format!("{text}: expected a text in quotes"));
        };
        let columns = written_columns(&inside).map_err(|error| error.to_string())?;
        let piece = |column: &str| match unquote(column) {
            Some(literal) => characters(&literal).map(Piece::Literal),
            None => match self.text_place(column) {
                Ok(place) => Ok(Piece::Text(place)),
                Err(_) => Err(format!("{column}: only literals and strings are printed")),
            },
        };
        columns.into_iter().map(piece).collect()
    }

    /// Rows `src dst count`.
    pub(crate) fn copies(&mut self, cells: &[String]) -> Result<Vec<CopyRow>, Why> {
        let mut rows = Vec::new();
        for row in cells.chunks(3) {
            let [from, to, count] = row else { return Err("expected rows of source, destination, count".to_owned()) };
            rows.push(CopyRow { from: self.span(from)?, to: self.writable(to)?, count: self.source(count)? });
        }
        Ok(rows)
    }

    /// A range to write.
    pub(crate) fn writable(&mut self, text: &str) -> Result<Span, Why> {
        match self.span(text)? {
            Span::Constant(_) => Err(format!("{text}: a constant cannot be written")),
            Span::Fixed { first: Place { kind: Kind::Text(_), .. }, .. } => Err(format!("{text} is a string")),
            Span::Fixed { first: Place { read_only: true, .. }, .. } => Err(format!("{text} is read-only")),
            span => Ok(span),
        }
    }

    /// The number of an element in its block with the block, for ranges given by their ends.
    pub(crate) fn ends(&self, first: &str, last: &str) -> Result<(Place, u32, u32), Why> {
        let parse = |text: &str| match self.operand(text)? {
            Operand::Address(address @ Address { element: Element::Numbered { .. }, field: None, cast: None }) => {
                Ok(address)
            }
            _ => Err(format!("{text}: expected an element")),
        };
        let (start, end) = (parse(first)?, parse(last)?);
        let (Element::Numbered { block, number, .. }, Element::Numbered { block: other, number: to, .. }) =
            (&start.element, &end.element)
        else {
            return Err(format!("{first}: expected an element"));
        };
        if !block.eq_ignore_ascii_case(other) || to < number {
            return Err(format!("{last} does not stand behind {first} in one block"));
        }
        self.map.resolve(&end).map_err(|error| error.to_string())?;
        match self.map.resolve(&start).map_err(|error| error.to_string())? {
            Resolved::Place(place) => {
                let stride = self.map.block(block).map_or(1, |block| block.element.bits());
                Ok((place, stride, to - number + 1))
            }
            _ => Err(format!("{first}: structures are not modelled here")),
        }
    }
}
