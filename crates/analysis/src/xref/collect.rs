//! From instructions to the stretches of data they touch.

use std::borrow::Borrow;
use std::hash::{Hash, Hasher};
use std::ops::Deref;
use std::rc::Rc;
use std::sync::Arc;

use foldhash::{HashMap, HashMapExt};
use instr::{Form, Kind, Role};
use ladder::{Address, Documentation, Expression, FileType, Image, Instruction, Mnemonic, Operand, Target};

use crate::location::{Location, instructions};
use crate::space::{Area, OPEN, Placed, Spaces};

use super::index::Span;
use super::reach::member_area;
use super::symbols::Symbols;
use super::{Level, Note, Through, Unresolved, UnresolvedKind};

/// An address of the program, or one made on the way. Small, because every use of an operand has one.
#[derive(Clone)]
pub(crate) enum Spelled<'a> {
    Stored(&'a Address),
    Made(Arc<Address>),
}

impl Deref for Spelled<'_> {
    type Target = Address;

    fn deref(&self) -> &Address {
        match self {
            Spelled::Stored(address) => address,
            Spelled::Made(address) => address,
        }
    }
}

impl Borrow<Address> for Spelled<'_> {
    fn borrow(&self) -> &Address {
        self
    }
}

impl PartialEq for Spelled<'_> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl Eq for Spelled<'_> {}

impl Hash for Spelled<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (**self).hash(state);
    }
}

impl From<Address> for Spelled<'_> {
    fn from(address: Address) -> Self {
        Spelled::Made(Arc::new(address))
    }
}

/// One operand of one instruction, or something it touches without naming it.
pub(crate) struct Use<'a> {
    pub(crate) location: Location,
    pub(crate) mnemonic: &'a Mnemonic,
    /// Operand name as in the box, empty for status bits.
    pub(crate) operand: &'static str,
    /// What the table says may stand there; `None` for instructions that are not in the table.
    pub(crate) kind: Option<Kind>,
    /// As written, a symbol resolved.
    pub(crate) address: Spelled<'a>,
    pub(crate) symbol: Option<&'a str>,
    pub(crate) through: Through,
    pub(crate) compiled: bool,
    /// Number of the named address it is, if operands name it and nothing is decided at run time.
    pub(crate) named: Option<usize>,
}

/// An address that operands name directly.
pub(crate) struct Named<'a> {
    pub(crate) address: Spelled<'a>,
    /// What it names.
    pub(crate) area: Area,
    /// As far as instructions that take it as the start of a file reach.
    pub(crate) reach: u64,
}

/// An extent that LEN of a control element decides.
pub(crate) struct RunTimeLength {
    /// LEN.
    pub(crate) len: Area,
    /// From the end of what the present LEN covers.
    pub(crate) beyond: Span,
    pub(crate) location: Location,
}

/// Everything found in one walk over the program.
pub(crate) struct Collected<'a> {
    pub(crate) spaces: Spaces<'a>,
    pub(crate) uses: Vec<Use<'a>>,
    pub(crate) spans: Vec<Span>,
    pub(crate) named: Vec<Named<'a>>,
    /// Uses whose address is decided at run time.
    pub(crate) computed: Vec<usize>,
    pub(crate) lengths: Vec<RunTimeLength>,
    pub(crate) unresolved: Vec<Unresolved<'a>>,
    pub(crate) notes: Vec<Note>,
    pub(crate) symbols: Symbols<'a>,
}

pub(crate) fn collect<'a>(image: &'a Image, documentation: &'a Documentation) -> Collected<'a> {
    let mut collector = Collector {
        image,
        status: HashMap::new(),
        named: HashMap::new(),
        out: Collected {
            spaces: Spaces::new(image),
            uses: Vec::new(),
            spans: Vec::new(),
            named: Vec::new(),
            computed: Vec::new(),
            lengths: Vec::new(),
            unresolved: Vec::new(),
            notes: Vec::new(),
            symbols: Symbols::new(documentation),
        },
    };
    // About two operands with three stretches per instruction; growing step by step costs more.
    let count: usize = image.ladder_files().flat_map(|file| &file.rungs).map(|rung| rung.series.len()).sum();
    collector.out.uses.reserve(count.saturating_mul(2));
    collector.out.spans.reserve(count.saturating_mul(2));
    for (location, instruction) in instructions(image) {
        collector.instruction(location, instruction);
    }
    collector.out
}

pub(super) struct Collector<'a> {
    pub(super) image: &'a Image,
    /// Parsed addresses of the status words an instruction writes.
    status: HashMap<&'static str, Rc<[Arc<Address>]>>,
    named: HashMap<(usize, u64, u64), usize>,
    pub(super) out: Collected<'a>,
}

/// The instruction at hand.
#[derive(Clone, Copy)]
pub(super) struct Site<'a> {
    pub(super) location: Location,
    pub(super) instruction: &'a Instruction,
    pub(super) form: &'static Form,
}

/// One operand of it.
#[derive(Clone, Copy)]
pub(super) struct Slot<'a> {
    pub(super) site: Site<'a>,
    pub(super) row: &'static instr::Operand,
}

impl<'a> Collector<'a> {
    fn instruction(&mut self, location: Location, instruction: &'a Instruction) {
        let known = instruction.mnemonic.name().and_then(instr::by_mnemonic);
        let operands = instruction.operands.len();
        let form = known.and_then(|known| {
            let fits = |form: &&'static Form| form.operands.len() == operands;
            known
                .forms_for(self.image.family())
                .find(fits)
                .or_else(|| known.forms.iter().find(fits))
                .or_else(|| known.form_for(self.image.family(), operands))
        });
        let (Some(known), Some(form)) = (known, form) else {
            return self.unknown_instruction(location, instruction, known.is_some());
        };
        let site = Site { location, instruction, form };
        // Text forms leave placeholders out; every stored form has them.
        let aligned = form.operands.len() == operands;
        let rows = form.operands.iter().filter(|row| aligned || row.in_text());
        for (row, operand) in rows.zip(&instruction.operands) {
            self.operand(Slot { site, row }, operand);
        }
        self.fixed_registers(site);
        self.status_writes(site, known);
        if known.mnemonic == "RCP" {
            self.out.notes.push(Note::RecipeAddresses(location));
        }
    }

    /// Nothing says what an unknown instruction does with its operands: each may be read or written.
    fn unknown_instruction(&mut self, location: Location, instruction: &'a Instruction, named: bool) {
        let kind = if named { UnresolvedKind::OperandCount } else { UnresolvedKind::Instruction };
        self.unresolved(location, instruction, "", instruction.mnemonic.to_string(), kind);
        for operand in &instruction.operands {
            let mut addresses = Vec::new();
            self.addresses_in(operand, &mut addresses);
            for (address, symbol) in addresses {
                self.pointers(location, instruction, "", &address);
                let placed = self.out.spaces.place(&address);
                let open = if address.indexed { self.whole_file(placed, &address) } else { placed };
                let by = self.add_use(Use {
                    location,
                    mnemonic: &instruction.mnemonic,
                    operand: "",
                    kind: None,
                    address: address.into(),
                    symbol,
                    through: Through::Operand,
                    compiled: instruction.compiled,
                    named: None,
                });
                self.name(by, placed, 0);
                self.span(by, open.area, Role::ReadWrite, false, None);
            }
        }
    }

    /// Addresses an operand holds, symbols resolved; for instructions whose operands have no meaning.
    fn addresses_in(&self, operand: &'a Operand, into: &mut Vec<(Address, Option<&'a str>)>) {
        match operand {
            Operand::Address(address) => into.push((address.clone(), None)),
            Operand::Symbol(text) => {
                if let Some(Target::Address(address)) = self.out.symbols.resolve(text) {
                    into.push((address, Some(text)));
                }
            }
            Operand::Expression(expression) => {
                for value in values(expression) {
                    if !matches!(value, Operand::Expression(_)) {
                        self.addresses_in(value, into);
                    }
                }
            }
            _ => {}
        }
    }

    fn operand(&mut self, slot: Slot<'a>, operand: &'a Operand) {
        match operand {
            Operand::Address(address) => self.address(slot, Spelled::Stored(address), None),
            Operand::Symbol(text) => self.symbol(slot, text),
            Operand::Expression(expression) => {
                for value in values(expression) {
                    if !matches!(value, Operand::Expression(_)) {
                        self.operand(slot, value);
                    }
                }
            }
            Operand::HighSpeedCounter(number) => self.unit(slot, &[FileType::HSC], *number),
            Operand::Constant(constant) => {
                let number = constant.as_integer().and_then(|number| u16::try_from(number).ok());
                match (slot.row.kind, number) {
                    (Kind::PtoNumber, Some(number)) => self.unit(slot, &[FileType::PTO, FileType::PTOX], number),
                    (Kind::PwmNumber, Some(number)) => self.unit(slot, &[FileType::PWM, FileType::PWMX], number),
                    (Kind::HscNumber, Some(number)) => self.unit(slot, &[FileType::HSC], number),
                    (Kind::Slot, _) => self.unresolved_operand(slot, operand, UnresolvedKind::Operand),
                    _ => self.function_file_touches(slot),
                }
            }
            Operand::Unset if slot.row.is_source() => {
                self.unresolved_operand(slot, operand, UnresolvedKind::NotEntered);
            }
            Operand::Text(_) if slot.row.is_source() && !free_text(slot.row) => {
                self.unresolved_operand(slot, operand, UnresolvedKind::Operand);
            }
            Operand::Text(_) | Operand::Unset | Operand::Empty | Operand::Label { .. } | Operand::ProgramFile(_) => {}
        }
    }

    fn symbol(&mut self, slot: Slot<'a>, text: &'a str) {
        match self.out.symbols.resolve(text) {
            Some(Target::Address(address)) => self.address(slot, address.into(), Some(text)),
            // Called files and labels are the business of the call graph.
            Some(_) => {}
            None if free_text(slot.row) => {}
            None => {
                let site = slot.site;
                let operand = slot.row.name;
                self.unresolved(site.location, site.instruction, operand, text.to_owned(), UnresolvedKind::Symbol);
            }
        }
    }

    /// A function file element that the operand names by its number alone. The first type whose file
    /// the controller has: the MicroLogix 1400 spells its pulse outputs with an X.
    fn unit(&mut self, slot: Slot<'a>, types: &[FileType], number: u16) {
        let exists = |file_type: &&FileType| self.image.data_file(**file_type, 0).is_some();
        if let Some(file_type) = types.iter().find(exists).or(types.first()) {
            self.address(slot, Address::element(*file_type, 0, number).into(), None);
        }
    }

    /// Members of function files that an instruction sets from an operand: STS and `STI:0.SPM`.
    pub(super) fn function_file_touches(&mut self, slot: Slot<'a>) {
        for touch in slot.row.touches {
            if touch.file_type.is_function_file() && self.image.data_file(touch.file_type, 0).is_some() {
                let element = Address::element(touch.file_type, 0, 0);
                let placed = self.out.spaces.place(&element);
                if let Some((area, level)) = member_area(placed, touch.file_type, touch.member) {
                    let by = self.add_slot_use(slot, element.into(), None, Through::Implied);
                    self.span(by, area, touch.role, placed.definite, Some(level));
                }
            }
        }
    }

    /// The math register where an instruction uses it without naming it whole.
    fn fixed_registers(&mut self, site: Site<'a>) {
        let double_word = |operand: &Operand| operand.address().is_some_and(|a| a.to_string() == "S:13");
        let high: &[u16] = match site.instruction.mnemonic.name() {
            Some("DDV") => &[13, 14],
            Some("FRD") if site.instruction.operands.first().is_some_and(double_word) => &[14],
            _ => &[],
        };
        for word in high {
            let address = Address::element(FileType::S, 2, *word);
            let placed = self.out.spaces.place(&address);
            let by = self.add_use(Use {
                location: site.location,
                mnemonic: &site.instruction.mnemonic,
                operand: "",
                kind: None,
                address: address.into(),
                symbol: None,
                through: Through::Implied,
                compiled: site.instruction.compiled,
                named: None,
            });
            self.span(by, placed.area, Role::Read, true, None);
        }
    }

    /// Flags and registers: which of them an execution writes depends on processor and result.
    fn status_writes(&mut self, site: Site<'a>, known: &'static instr::Instruction) {
        if known.status.is_empty() {
            return;
        }
        let addresses = self.status.entry(known.mnemonic).or_insert_with(|| {
            known.status.iter().filter_map(|text| Address::parse(text).ok().map(Arc::new)).collect()
        });
        let addresses = Rc::clone(addresses);
        for address in addresses.iter() {
            let placed = self.out.spaces.place(address);
            let by = self.add_use(Use {
                location: site.location,
                mnemonic: &site.instruction.mnemonic,
                operand: "",
                kind: None,
                address: Spelled::Made(Arc::clone(address)),
                symbol: None,
                through: Through::Implied,
                compiled: site.instruction.compiled,
                named: None,
            });
            self.span(by, placed.area, Role::Write, false, None);
        }
    }

    /// The addresses in brackets are read to find the place.
    pub(super) fn pointers(
        &mut self,
        location: Location,
        instruction: &'a Instruction,
        operand: &'static str,
        of: &Address,
    ) {
        for inner in of.indirections() {
            self.pointers(location, instruction, operand, inner);
            let placed = self.out.spaces.place(inner);
            let by = self.add_use(Use {
                location,
                mnemonic: &instruction.mnemonic,
                operand,
                kind: Some(Kind::Word),
                address: inner.clone().into(),
                symbol: None,
                through: Through::Pointer,
                compiled: instruction.compiled,
                named: None,
            });
            self.name(by, placed, 0);
            self.span(by, placed.area, Role::Read, placed.definite, None);
        }
    }

    fn add_use(&mut self, it: Use<'a>) -> usize {
        self.out.uses.push(it);
        self.out.uses.len() - 1
    }

    pub(super) fn add_slot_use(
        &mut self,
        slot: Slot<'a>,
        address: Spelled<'a>,
        symbol: Option<&'a str>,
        through: Through,
    ) -> usize {
        self.add_use(Use {
            location: slot.site.location,
            mnemonic: &slot.site.instruction.mnemonic,
            operand: slot.row.name,
            kind: Some(slot.row.kind),
            address,
            symbol,
            through,
            compiled: slot.site.instruction.compiled,
            named: None,
        })
    }

    /// Lists the address of a use as one that the program names.
    pub(super) fn name(&mut self, by: usize, placed: Placed, reach: u64) {
        if !placed.definite {
            self.out.computed.push(by);
            return;
        }
        let area = placed.area;
        let Some(it) = self.out.uses.get_mut(by) else { return };
        let next = self.out.named.len();
        let index = *self.named.entry((area.space, area.first, area.bits)).or_insert(next);
        it.named = Some(index);
        if index == next {
            let address = match it.address.indexed {
                true => Address { indexed: false, ..(*it.address).clone() }.into(),
                false => it.address.clone(),
            };
            self.out.named.push(Named { address, area, reach: area.bits });
        }
        if let Some(named) = self.out.named.get_mut(index) {
            named.reach = named.reach.max(reach);
        }
    }

    pub(super) fn span(&mut self, by: usize, area: Area, role: Role, definite: bool, level: Option<Level>) {
        let space = self.out.spaces.get(area.space);
        let level = match (level, space) {
            (_, Some(space)) if space.key.number.is_none() => Level::AnyFile,
            (_, _) if area.bits == OPEN || area.part.is_some() => Level::File,
            (Some(level), _) => level,
            (None, _) if area.bits == 1 => Level::Bit,
            (None, Some(space)) if area.bits == space.stride() && space.key.file_type.is_structure() => Level::Element,
            (None, _) => Level::Word,
        };
        self.out.spans.push(Span { area, role, definite, level, by });
    }

    fn unresolved_operand(&mut self, slot: Slot<'a>, operand: &Operand, kind: UnresolvedKind) {
        let site = slot.site;
        self.unresolved(site.location, site.instruction, slot.row.name, operand.to_string(), kind);
    }

    fn unresolved(
        &mut self,
        location: Location,
        instruction: &'a Instruction,
        operand: &'static str,
        text: String,
        kind: UnresolvedKind,
    ) {
        self.out.unresolved.push(Unresolved { location, mnemonic: &instruction.mnemonic, operand, text, kind });
    }
}

/// Operands that hold words, not data.
fn free_text(row: &instr::Operand) -> bool {
    matches!(
        row.kind,
        Kind::Choice
            | Kind::Display
            | Kind::SetupScreen
            | Kind::Unidentified
            | Kind::RecipeFile
            | Kind::Slots
            | Kind::Channel
            | Kind::TimeBase
            | Kind::InterruptTypes
    )
}

/// The operands of an expression, left to right.
fn values(expression: &Expression) -> Vec<&Operand> {
    let mut found = Vec::new();
    let mut stack = vec![expression];
    while let Some(next) = stack.pop() {
        match next {
            Expression::Value(operand) => found.push(&**operand),
            Expression::Unary(_, inner) | Expression::Group(inner) => stack.push(inner),
            Expression::Binary(_, left, right) => {
                stack.push(right);
                stack.push(left);
            }
        }
    }
    found
}
