//! Addresses that another one replaced throughout, and program files with another number.

use std::collections::BTreeMap;
use std::hash::Hash;

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};
use ladder::{Address, Expression, Image, Operand, Place};

use super::Rename;

/// From the old program to the new: applied to the old one before rungs are compared.
#[derive(Clone, Debug, Default)]
pub(super) struct Mapping {
    /// Whole elements; of I and O whole words.
    elements: HashMap<Address, Address>,
    /// Bits and words on their own.
    parts: HashMap<Address, Address>,
    /// Numbers of program files.
    files: BTreeMap<u16, u16>,
}

impl Mapping {
    /// Program files with another number.
    pub(super) fn of_files(files: impl IntoIterator<Item = (u16, u16)>) -> Mapping {
        Mapping { files: files.into_iter().collect(), ..Mapping::default() }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.elements.is_empty() && self.parts.is_empty() && self.files.is_empty()
    }

    pub(super) fn file(&self, number: u16) -> u16 {
        self.files.get(&number).copied().unwrap_or(number)
    }

    pub(super) fn operand(&self, operand: &Operand) -> Operand {
        match operand {
            Operand::Address(address) => Operand::Address(self.address(address)),
            Operand::Expression(expression) => Operand::Expression(self.expression(expression)),
            Operand::ProgramFile(number) => Operand::ProgramFile(self.file(*number)),
            other => other.clone(),
        }
    }

    /// Expressions nest no deeper than their reader admits.
    fn expression(&self, expression: &Expression) -> Expression {
        let inside = |part: &Expression| Box::new(self.expression(part));
        match expression {
            Expression::Value(operand) => Expression::Value(Box::new(self.operand(operand))),
            Expression::Unary(function, part) => Expression::Unary(*function, inside(part)),
            Expression::Binary(operator, left, right) => Expression::Binary(*operator, inside(left), inside(right)),
            Expression::Group(part) => Expression::Group(inside(part)),
        }
    }

    pub(super) fn address(&self, address: &Address) -> Address {
        let place = |place: &Place| match place {
            Place::Indirect(inner) => Place::Indirect(Box::new(self.address(inner))),
            number => number.clone(),
        };
        let plain = Address { indexed: false, ..address.clone() };
        if let Some(new) = self.parts.get(&plain) {
            return Address { indexed: address.indexed, ..new.clone() };
        }
        let mut changed = Address {
            file: place(&address.file),
            element: place(&address.element),
            bit: address.bit.as_ref().map(place),
            ..address.clone()
        };
        if let Some(new) = address.element_address().and_then(|element| self.elements.get(&element)) {
            changed.file_type = new.file_type;
            changed.file = new.file.clone();
            changed.element = new.element.clone();
            if new.file_type.has_slots() {
                changed.word = new.word;
            }
        }
        changed
    }
}

/// Operands of matched instructions where one address stands in the place of another.
#[derive(Default)]
pub(super) struct Replaced {
    pairs: Vec<(Address, Address)>,
}

impl Replaced {
    pub(super) fn add(&mut self, old: &Operand, new: &Operand) {
        let (Operand::Address(old), Operand::Address(new)) = (old, new) else { return };
        let plain = |address: &Address| Address { indexed: false, ..address.clone() };
        let (old, new) = (plain(old), plain(new));
        if old.is_direct() && new.is_direct() && old != new {
            self.pairs.push((old, new));
        }
    }

    /// What was replaced throughout: twice or more, always by the same address, the old one gone and the
    /// new one not used before.
    pub(super) fn find(&self, old: &Image, new: &Image, mapping: &mut Mapping) -> Vec<Rename> {
        if self.pairs.is_empty() {
            return Vec::new();
        }
        let (before, after) = (Used::of(old), Used::of(new));
        let mut found = Vec::new();
        let whole = self.pairs.iter().filter(|(old, new)| same_part(old, new)).filter_map(|(old, new)| {
            Some((old.element_address()?, new.element_address()?)).filter(|(old, new)| old != new)
        });
        for (from, (to, operands)) in consistent(whole) {
            if !after.elements.contains(&from) && !before.elements.contains(&to) {
                found.push(Rename { old: from.to_string(), new: to.to_string(), operands });
                mapping.elements.insert(from, to);
            }
        }
        let parts = self
            .pairs
            .iter()
            .filter(|(old, _)| old.element_address().is_none_or(|element| !mapping.elements.contains_key(&element)));
        for (from, (to, operands)) in consistent(parts.cloned()) {
            if !after.parts.contains(&from) && !before.parts.contains(&to) {
                found.push(Rename { old: from.to_string(), new: to.to_string(), operands });
                mapping.parts.insert(from, to);
            }
        }
        found
    }
}

/// The same member or bit of elements of one kind.
fn same_part(old: &Address, new: &Address) -> bool {
    let slots = old.file_type.has_slots();
    old.bit == new.bit
        && (slots || old.word == new.word)
        && slots == new.file_type.has_slots()
        && old.file_type.words_per_element() == new.file_type.words_per_element()
        && old.file_type.is_structure() == new.file_type.is_structure()
}

/// What each address became when it became one thing only, at least twice, and nothing else became that.
pub(super) fn consistent<A: Clone + Eq + Hash>(pairs: impl Iterator<Item = (A, A)>) -> Vec<(A, (A, usize))> {
    let (mut became, mut order): (HashMap<A, Option<(A, usize)>>, _) = (HashMap::new(), Vec::new());
    let mut from: HashMap<A, Option<A>> = HashMap::new();
    for (old, new) in pairs {
        let source = from.entry(new.clone()).or_insert_with(|| Some(old.clone()));
        if source.as_ref() != Some(&old) {
            *source = None;
        }
        match became.get_mut(&old) {
            None => {
                order.push(old.clone());
                became.insert(old, Some((new, 1)));
            }
            Some(Some((to, count))) if *to == new => *count += 1,
            Some(other) => *other = None,
        }
    }
    let single = |to: &A| from.get(to).is_some_and(Option::is_some);
    order
        .into_iter()
        .filter_map(|old| {
            let (to, count) = became.remove(&old).flatten()?;
            (count >= 2 && single(&to)).then_some((old, (to, count)))
        })
        .collect()
}

/// Every address a program names.
struct Used {
    elements: HashSet<Address>,
    parts: HashSet<Address>,
}

impl Used {
    fn of(image: &Image) -> Used {
        let mut used = Used { elements: HashSet::new(), parts: HashSet::new() };
        for (_, instruction) in crate::instructions(image) {
            instruction.operands.iter().for_each(|operand| used.operand(operand));
        }
        used
    }

    fn operand(&mut self, operand: &Operand) {
        match operand {
            Operand::Address(address) => self.address(address),
            Operand::Expression(expression) => {
                let mut parts = vec![expression];
                while let Some(part) = parts.pop() {
                    match part {
                        Expression::Value(operand) => self.operand(operand),
                        Expression::Unary(_, part) | Expression::Group(part) => parts.push(part),
                        Expression::Binary(_, left, right) => parts.extend([&**left, &**right]),
                    }
                }
            }
            _ => {}
        }
    }

    fn address(&mut self, address: &Address) {
        self.elements.extend(address.element_address());
        self.parts.insert(Address { indexed: false, ..address.clone() });
        address.indirections().for_each(|inner| self.address(inner));
    }
}
