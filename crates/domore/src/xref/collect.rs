//! The accesses of a program, instruction by instruction.

use super::{Access, Area, Through, Unresolved, area};
use crate::address::{Address, Constant, Element, Number, columns};
use crate::instruction::{self, Extent, Kind, Operand, Role, Table};
use crate::math::Expression;
use crate::memory::Map;
use crate::program::{Instruction, Project};
use crate::text::unquote;

/// All accesses, and operands that could not be looked into.
pub(super) fn collect(project: &Project, map: &Map) -> (Vec<Access>, Vec<Unresolved>) {
    let mut collector = Collector { map, code_block: "", rung: 0, accesses: Vec::new(), unresolved: Vec::new() };
    for block in project.code_blocks() {
        collector.code_block = &block.name;
        for (index, rung) in block.rungs.iter().enumerate() {
            collector.rung = index + 1;
            rung.instructions.iter().for_each(|instruction| collector.instruction(instruction));
        }
    }
    (collector.accesses, collector.unresolved)
}

struct Collector<'p> {
    map: &'p Map,
    code_block: &'p str,
    rung: usize,
    accesses: Vec<Access>,
    unresolved: Vec<Unresolved>,
}

/// How an address is used.
#[derive(Clone, Copy)]
struct Use<'i> {
    instruction: &'i Instruction,
    role: Option<Role>,
    through: Through,
    /// Elements from the first on; `None`: as many as only running decides.
    count: Option<u32>,
}

impl Collector<'_> {
    fn instruction(&mut self, instruction: &Instruction) {
        let entry = instruction::by_mnemonic(&instruction.mnemonic);
        for (index, operand) in instruction.operands.iter().enumerate() {
            match entry.map(|entry| entry.operand(index)) {
                Some(Some(known)) => self.operand(instruction, operand, known),
                // More operands than are known, or an instruction that is not.
                _ => self.unknown(instruction, operand),
            }
        }
    }

    fn operand(&mut self, instruction: &Instruction, operand: &str, known: &Operand) {
        let role = Some(known.role);
        match known.kind {
            Kind::Expression => self.expression(instruction, operand),
            Kind::Table(table) => self.table(instruction, operand, table),
            Kind::Flags | Kind::Word => {}
            Kind::Text if operand.starts_with('"') => {}
            _ => {
                let count = match known.extent {
                    Extent::One => Some(1),
                    Extent::Count(of) => constant(instruction.operand(of)),
                    Extent::To(last) => return self.range(instruction, operand, instruction.operand(last), known.role),
                };
                self.address(operand, Use { instruction, role, through: Through::Operand, count });
            }
        }
    }

    /// Everything that looks like an address in an operand of which nothing is known.
    fn unknown(&mut self, instruction: &Instruction, operand: &str) {
        if operand.starts_with('"') {
            self.unresolved(instruction, operand, "an instruction or operand that is known");
        } else {
            self.address(operand, Use { instruction, role: None, through: Through::Operand, count: Some(1) });
        }
    }

    fn unresolved(&mut self, instruction: &Instruction, operand: &str, why: &str) {
        self.unresolved.push(Unresolved {
            code_block: self.code_block.to_owned(),
            rung: self.rung,
            mnemonic: instruction.mnemonic.clone(),
            operand: operand.to_owned(),
            why: why.to_owned(),
        });
    }

    fn push(&mut self, written: &str, used: Use<'_>, may: bool, area: Area) {
        self.accesses.push(Access {
            code_block: self.code_block.to_owned(),
            rung: self.rung,
            line: used.instruction.origin.line(),
            mnemonic: used.instruction.mnemonic.clone(),
            written: written.to_owned(),
            role: used.role,
            through: used.through,
            may,
            area,
        });
    }

    /// A single address, or so many elements from it on. Constants touch nothing.
    fn address(&mut self, written: &str, used: Use<'_>) {
        if written.is_empty() || Constant::parse(written).is_some() {
            return;
        }
        let Ok(address) = Address::parse_with(written, |block| self.map.radix(block)) else {
            return self.unresolved(used.instruction, written, "an element or number");
        };
        let mut indexed = false;
        if let Element::Indexed { expression, .. } = &address.element {
            indexed = true;
            let inner = Use { role: Some(Role::Read), through: Through::Index, count: Some(1), ..used };
            // The addresses of an expression already include those in brackets.
            let descends = matches!(used.through, Through::Operand | Through::Table);
            match self.parse(expression).filter(|_| descends) {
                Some(addresses) => addresses.into_iter().for_each(|(text, _)| self.address(&text, inner)),
                None if descends => self.unresolved(used.instruction, expression, "an index expression"),
                None => {}
            }
        }
        let Some(mut area) = area(self.map, written) else { return };
        let may = indexed || used.count.is_none();
        if let (Area::Bits(first, end), false) = (&mut area, indexed) {
            *end = match used.count {
                Some(count) => first.saturating_add(end.saturating_sub(*first).saturating_mul(count.max(1))),
                None => self.block_end(*first).max(*end),
            };
        }
        self.push(written, used, may, area);
    }

    /// One behind the last bit of the block that holds a bit.
    fn block_end(&self, bit: u32) -> u32 {
        let end = |block: &crate::memory::Block| {
            let end = block.start.saturating_add(block.count.saturating_mul(block.element.bits()));
            (block.start <= bit && bit < end).then_some(end)
        };
        self.map.blocks().iter().find_map(end).unwrap_or(bit)
    }

    /// All from one element to another.
    fn range(&mut self, instruction: &Instruction, first: &str, last: &str, role: Role) {
        let used = Use { instruction, role: Some(role), through: Through::Operand, count: Some(1) };
        match (area(self.map, first), area(self.map, last)) {
            (Some(Area::Bits(from, _)), Some(Area::Bits(_, to))) if from < to => {
                self.push(first, used, false, Area::Bits(from, to));
            }
            _ => {
                self.unresolved(instruction, &format!("{first} {last}"), "two elements of one block in order");
                self.address(first, used);
            }
        }
    }

    /// Addresses of an expression with whether each is the first of a range; those in brackets of an
    /// indexed one too. `None` if it does not read.
    fn parse(&self, text: &str) -> Option<Vec<(String, bool)>> {
        let expression = Expression::parse_with(text, &|block| self.map.radix(block)).ok()?;
        Some(expression.addresses().into_iter().map(|(address, range)| (address.to_string(), range)).collect())
    }

    fn expression(&mut self, instruction: &Instruction, operand: &str) {
        let text = unquote(operand).unwrap_or_else(|| operand.to_owned());
        let Some(addresses) = self.parse(&text) else {
            return self.unresolved(instruction, operand, "an expression");
        };
        for (address, range) in addresses {
            // How many elements a range function takes is an argument of its own.
            let count = if range { None } else { Some(1) };
            self.address(&address, Use { instruction, role: Some(Role::Read), through: Through::Expression, count });
        }
    }

    fn table(&mut self, instruction: &Instruction, operand: &str, table: Table) {
        let words = unquote(operand).and_then(|text| columns(&text).ok()).unwrap_or_default();
        let Some((width, words)) = words.split_first() else {
            return self.unresolved(instruction, operand, "a table in quotes");
        };
        let expected = match table {
            Table::Copies | Table::Fills => 3,
            Table::FlaggedCopies => 4,
            Table::Unknown => return self.unresolved(instruction, operand, "a table whose columns are known"),
        };
        if width.parse() != Ok(expected) || words.len() % expected != 0 {
            return self.unresolved(instruction, operand, "as many columns as the table says");
        }
        for row in words.chunks(expected) {
            let used = |role, count| Use { instruction, role: Some(role), through: Through::Table, count };
            match (table, row) {
                (Table::Fills, [first, last, value]) => {
                    match (area(self.map, first), area(self.map, last)) {
                        (Some(Area::Bits(from, _)), Some(Area::Bits(_, to))) if from < to => {
                            self.push(first, used(Role::Write, Some(1)), false, Area::Bits(from, to));
                        }
                        _ => self.address(first, used(Role::Write, Some(1))),
                    }
                    self.address(value, used(Role::Read, Some(1)));
                }
                (_, [.., source, destination, count]) => {
                    self.address(source, used(Role::Read, constant(count)));
                    self.address(destination, used(Role::Write, constant(count)));
                    self.address(count, used(Role::Read, Some(1)));
                }
                _ => {}
            }
        }
    }
}

/// The number an operand is; `None` for an element.
fn constant(text: &str) -> Option<u32> {
    match Constant::parse(text)?.value {
        Number::Integer(value) => u32::try_from(value).ok(),
        Number::Real(_) => None,
    }
}
