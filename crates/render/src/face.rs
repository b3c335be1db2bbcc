//! What is written at an instruction: its drawing, operands, values, symbol and description.

use instr::{Category, Drawing, Form, Kind, Position, Stored};
use ladder::{Address, Documentation, FileType, Image, Instruction, Operand, Target, Value};

use crate::scene::Role;
use crate::state;
use crate::text::clean;
use crate::{Live, Style};

/// An instruction as texts, before it has a size.
#[derive(Debug)]
pub(crate) struct Face {
    /// Number of the instruction in its rung.
    pub index: usize,
    /// The instruction in words.
    pub words: String,
    /// Description lines, then the symbol: stand above.
    pub labels: Vec<Text>,
    /// The drawing.
    pub body: Body,
    /// Stands at the right power rail; `None`: an instruction of which that is not known.
    pub output: Option<bool>,
    /// See [`crate::scene::Spot::forced`].
    pub forced: Option<bool>,
    /// See [`crate::scene::Spot::state`].
    pub state: Option<bool>,
}

/// A text with its meaning.
#[derive(Clone, Debug)]
pub(crate) struct Text {
    pub role: Role,
    pub text: String,
    /// The operand it shows.
    pub operand: Option<usize>,
    /// The address it stands for.
    pub link: Option<String>,
}

impl Text {
    /// A text that stands for no operand.
    pub(crate) fn new(role: Role, text: impl Into<String>) -> Text {
        Text { role, text: text.into(), operand: None, link: None }
    }

    /// Another text about the same operand.
    pub(crate) fn with(&self, role: Role, text: impl Into<String>) -> Text {
        Text { role, text: text.into(), ..self.clone() }
    }
}

/// The drawing of an instruction.
#[derive(Debug)]
pub(crate) enum Body {
    /// Contact, coil or letters in brackets.
    Symbol {
        /// The sign on the wire.
        sign: Sign,
        /// Address, above the wire; may be empty.
        above: Text,
        /// Bit, module and remarks, below the wire.
        below: Vec<Text>,
    },
    /// Frame with rows.
    Box {
        /// In the upper side of the frame.
        name: String,
        /// First row.
        title: String,
        /// The other rows.
        rows: Vec<Row>,
        /// Status flags at the right side.
        flags: &'static [&'static str],
    },
}

/// A sign on the wire.
#[derive(Debug)]
pub(crate) enum Sign {
    Contact { closed: bool },
    Coil(&'static str),
    Marked(&'static str),
}

/// A row of a box.
#[derive(Debug)]
pub(crate) struct Row {
    /// Name at the left side, empty in a row that only has a value.
    pub name: String,
    /// Text at the right side.
    pub text: Text,
    /// `<` follows: the value comes from the data table.
    pub live: bool,
}

/// What faces are made from.
pub(crate) struct Source<'a> {
    pub image: &'a Image,
    /// Number of the program file.
    pub file: u16,
    /// The rung has been edited: paper leaves the `<` after its values out.
    pub edited: bool,
    pub documentation: &'a Documentation,
    pub style: &'a Style,
    /// Live values, see [`crate::Live`].
    pub live: Option<&'a Live<'a>>,
}

impl Source<'_> {
    /// The face of instruction `index` of the rung.
    pub(crate) fn face(&self, instruction: &Instruction, index: usize) -> Face {
        let entry = instruction.mnemonic.name().and_then(instr::by_mnemonic);
        let form = entry.and_then(|entry| form(entry, self.image, instruction.operands.len()));
        let (Some(entry), Some(form)) = (entry, form) else {
            return self.unknown(instruction, index);
        };
        let output = Some(!matches!(form.position, Position::Input | Position::RungStart));
        let known = form.operands.len() == instruction.operands.len();
        let labels = if known { self.labels(instruction, documented(entry, form)) } else { Vec::new() };
        let sign = match form.drawing {
            Drawing::Contact { closed } => Some(Sign::Contact { closed }),
            Drawing::Coil(letters) => Some(Sign::Coil(letters)),
            Drawing::Marked(letters) => Some(Sign::Marked(letters)),
            Drawing::Box { .. } => None,
        };
        let forced = instruction.operands.first().and_then(Operand::address).and_then(|a| state::forced(self.image, a));
        let shown = if self.style.state { state::shown(self.image, instruction) } else { None };
        let body = match (sign, instruction.operands.as_slice()) {
            (Some(sign), []) => Body::Symbol { sign, above: Text::new(Role::Address, ""), below: Vec::new() },
            (Some(sign), [operand]) => self.symbol(sign, operand, forced, shown),
            _ => Body::Box {
                name: entry.mnemonic.to_owned(),
                title: entry.title.to_owned(),
                rows: self.rows(instruction, form, index),
                flags: match form.drawing {
                    Drawing::Box { flags } => flags,
                    _ => &[],
                },
            },
        };
        // A box shows no force: its operand is a word, or it has several.
        let forced = forced.filter(|_| matches!(body, Body::Symbol { .. }));
        Face { index, words: self.words(instruction, &labels), labels, body, output, forced, state: shown }
    }

    /// Mnemonic, operands, symbol and description on one line.
    fn words(&self, instruction: &Instruction, labels: &[Text]) -> String {
        let mut words = clean(&instruction.mnemonic.to_string()).into_owned();
        for text in instruction.operands.iter().map(|operand| self.text(operand)).filter(|text| !text.is_empty()) {
            words.push(' ');
            words.push_str(&text);
        }
        add_labels(&mut words, labels);
        words
    }

    /// An instruction that is not in the table: everything stored, nothing guessed.
    fn unknown(&self, instruction: &Instruction, number: usize) -> Face {
        let (name, title) = match &instruction.mnemonic {
            ladder::Mnemonic::Named(name) => (clean(name).into_owned(), "(unknown instruction)".to_owned()),
            ladder::Mnemonic::Unknown(code) => ("?".to_owned(), format!("op 0x{code:02X} (unknown instruction)")),
        };
        let mut rows = Vec::new();
        for (index, operand) in instruction.operands.iter().enumerate() {
            let text = self.operand(operand, index);
            rows.push(Row { name: format!("Operand {}", index + 1), text, live: false });
            self.push_displayed(&mut rows, instruction, index, number, false);
        }
        push_setup(&mut rows, instruction);
        let body = Body::Box { name, title, rows, flags: &[] };
        let words = self.words(instruction, &[]);
        Face { index: number, words, labels: Vec::new(), body, output: None, forced: None, state: None }
    }

    /// Description and symbol of operand `index`.
    fn labels(&self, instruction: &Instruction, index: usize) -> Vec<Text> {
        if !self.style.descriptions {
            return Vec::new();
        }
        let Some(operand) = instruction.operands.get(index) else { return Vec::new() };
        let target = match operand {
            Operand::Address(address) => Target::from(address),
            Operand::ProgramFile(number) => Target::ProgramFileOperand(*number),
            Operand::Label { number, .. } => Target::Label { file: self.file, number: *number },
            _ => return Vec::new(),
        };
        let shown = self.documentation.shown(&target, instruction.mnemonic.name().unwrap_or(""));
        let mut labels: Vec<Text> =
            shown.description.iter().map(|line| Text::new(Role::Description, clean(line.trim_end()))).collect();
        let operand = self.operand(operand, index);
        labels.extend(shown.symbol.map(|symbol| operand.with(Role::Symbol, clean(&symbol))));
        labels
    }

    /// Operand `index` as a text with its meaning.
    fn operand(&self, operand: &Operand, index: usize) -> Text {
        let text = self.text(operand);
        let link = operand.address().map(|_| text.trim_start_matches('#').to_owned());
        Text { role: Role::Operand, text, operand: Some(index), link }
    }

    /// An operand as a person reads it in this program file.
    fn text(&self, operand: &Operand) -> String {
        match operand {
            // The stored file number of a label can be stale; a label belongs to its own file.
            Operand::Label { number, .. } => format!("Q{}:{number}", self.file),
            other => clean(other.to_string().trim()).into_owned(),
        }
    }

    fn symbol(&self, sign: Sign, operand: &Operand, forced: Option<bool>, state: Option<bool>) -> Body {
        let mut below = Vec::new();
        let whole = self.operand(operand, 0);
        let above = match self.split(operand) {
            Some((element, bit)) => {
                below.push(whole.with(Role::Address, bit));
                whole.with(Role::Address, element)
            }
            None => Text { role: Role::Address, ..whole },
        };
        if let Some(address) = operand.address() {
            below.extend(self.module(address).into_iter().map(|(role, text)| Text::new(role, clean(&text))));
        }
        if let Some(on) = forced {
            below.push(Text::new(Role::Force, if on { state::FORCED_ON } else { state::FORCED_OFF }));
        }
        if state == Some(true) {
            below.push(Text::new(Role::State, state::TRUE));
        }
        Body::Symbol { sign, above, below }
    }

    /// What stands above and below the sign of a bit; `None` where the whole address stands above.
    fn split(&self, operand: &Operand) -> Option<(String, String)> {
        if !self.style.split_bits {
            return None;
        }
        let address = operand.address().filter(|address| is_io(address));
        if let Some((slot, bit)) = address.and_then(slot_bit) {
            return Some((slot, bit));
        }
        let text = self.text(operand);
        let (element, bit) = split_bit(&text)?;
        // Word 0 of a slot goes without saying, also before a bit that is indirect.
        let element = address.and_then(|_| element.strip_suffix(".0")).unwrap_or(element);
        Some((element.to_owned(), bit.to_owned()))
    }

    /// The module under an I/O bit.
    fn module(&self, address: &Address) -> Vec<(Role, String)> {
        let io = &self.image.io;
        if !is_io(address) || address.element.number().is_none() || io.slots.is_empty() {
            return Vec::new();
        }
        let Some(point) = io.resolve(address) else {
            return vec![(Role::Note, "not in the I/O".to_owned())];
        };
        let mut lines = match &point.slot.module.catalog {
            Some(catalog) => vec![(Role::Module, catalog.clone())],
            None => vec![(Role::Note, "unknown module".to_owned())],
        };
        if !point.in_range {
            lines.push((Role::Note, "no such point".to_owned()));
        }
        lines
    }

    /// The rows of a box below its title.
    fn rows(&self, instruction: &Instruction, form: &Form, number: usize) -> Vec<Row> {
        let mut rows = Vec::new();
        let known = form.operands.len() == instruction.operands.len();
        for (index, operand) in instruction.operands.iter().enumerate() {
            let definition = form.operands.get(index).filter(|_| known);
            let name = definition.map_or_else(|| format!("Operand {}", index + 1), |d| d.name.to_owned());
            let whole = self.operand(operand, index);
            let text = &whole.text;
            match definition.map(|d| d.stored) {
                Some(Stored::Value) if self.live_value(number, index).is_some() => {
                    let shown = self.live_value(number, index).unwrap_or_default();
                    rows.push(Row { name, text: whole.with(Role::Operand, shown), live: true });
                }
                Some(Stored::Value) if instruction.compiled => {
                    let table = self.table_value(form, &instruction.operands, index);
                    let stale = table.as_ref().is_some_and(|value| value != text && !text.is_empty());
                    let shown = table.unwrap_or_else(|| text.clone());
                    let live = !shown.is_empty() && !self.edited;
                    rows.push(Row { name, text: whole.with(Role::Operand, shown), live });
                    if stale {
                        let text = Text::new(Role::Note, text.as_str());
                        rows.push(Row { name: "  last shown".into(), text, live: false });
                    }
                }
                _ => rows.push(Row { name, text: whole, live: false }),
            }
            let valued = definition.is_some_and(|d| d.stored == Stored::SourceAndValue);
            self.push_displayed(&mut rows, instruction, index, number, valued);
        }
        push_setup(&mut rows, instruction);
        rows
    }

    /// The row with the value of operand `index`: what RSLogix last displayed, else for an operand
    /// whose box has a place for one (`valued`) what the data table holds at a direct address.
    fn push_displayed(
        &self,
        rows: &mut Vec<Row>,
        instruction: &Instruction,
        index: usize,
        number: usize,
        valued: bool,
    ) {
        let text = |value| Text { operand: Some(index), ..Text::new(Role::Value, value) };
        if valued && let Some(value) = self.live_value(number, index) {
            rows.push(Row { name: String::new(), text: text(value), live: true });
            return;
        }
        if !self.style.values {
            return;
        }
        let value = match instruction.displayed(index) {
            Some(text) => clean(text.trim()).into_owned(),
            None if !valued => return,
            None => match instruction.operands.get(index).and_then(|operand| self.data_value(operand)) {
                Some(text) => text,
                None => return,
            },
        };
        let live = instruction.compiled && !self.edited;
        rows.push(Row { name: String::new(), text: text(value), live });
    }

    /// The live value of an operand.
    fn live_value(&self, instruction: usize, operand: usize) -> Option<String> {
        let value = (self.live?.value)(instruction, operand)?;
        Some(clean(value.trim()).into_owned())
    }

    /// The value in the data table at a direct address that names one number.
    fn data_value(&self, operand: &Operand) -> Option<String> {
        let address = operand.address().filter(|a| a.is_direct() && a.bit.is_none())?;
        number_text(&self.image.value_at(address)?)
    }

    /// What the data element holds that snapshot operand `index` shows: PRE and ACC of a timer or
    /// counter, LEN and POS of a control element. Compiled code has only the element, so this is the
    /// program; the stored text is what the box last showed.
    fn table_value(&self, form: &Form, operands: &[Operand], index: usize) -> Option<String> {
        let member = match form.operands.get(index)?.kind {
            Kind::Preset => "PRE",
            Kind::Accum => "ACC",
            Kind::Length => "LEN",
            Kind::Position => "POS",
            _ => return None,
        };
        let before = form.operands.get(..index)?;
        let element = before.iter().rposition(|o| matches!(o.kind, Kind::Timer | Kind::Counter | Kind::Control))?;
        let address = operands.get(element)?.address().filter(|a| a.is_direct() && a.word.is_none())?;
        let member = ladder::member_by_name(address.file_type, member)?;
        number_text(&self.image.value_at(&address.clone().with_word(member.word))?)
    }
}

/// Symbol and description behind an instruction in words.
pub(crate) fn add_labels(words: &mut String, labels: &[Text]) {
    // The symbol stands last above an instruction, and first in words.
    let of = |symbol: bool| labels.iter().filter(move |label| (label.role == Role::Symbol) == symbol);
    for label in of(true).chain(of(false)).filter(|label| !label.text.trim().is_empty()) {
        words.push_str(", ");
        words.push_str(label.text.trim());
    }
}

/// Settings behind the set-up screen of a MSG, which paper does not show in the box.
fn push_setup(rows: &mut Vec<Row>, instruction: &Instruction) {
    for (name, value) in instruction.message.iter().flat_map(|setup| &setup.settings) {
        let text = Text::new(Role::Operand, clean(value));
        rows.push(Row { name: clean(name).into_owned(), text, live: false });
    }
}

fn number_text(value: &Value) -> Option<String> {
    match value {
        Value::Word(word) => Some(word.to_string()),
        Value::Long(long) => Some(long.to_string()),
        Value::Float(float) => Some(ladder::format_float(*float)),
        _ => None,
    }
}

fn is_io(address: &Address) -> bool {
    matches!(address.file_type, FileType::I | FileType::O)
}

/// Slot and bit of a direct I/O bit the way paper counts them: through all words of the slot, so that
/// `O:0.2/5` is `O:0` above and 37 below.
fn slot_bit(address: &Address) -> Option<(String, String)> {
    let bit = u32::from(address.bit.as_ref()?.number()?) + 16 * u32::from(address.word?);
    let slot = Address { word: None, bit: None, ..address.clone() };
    Some((slot.to_string(), bit.to_string()))
}

/// Element and bit of an address text, cut at the last slash outside brackets.
fn split_bit(text: &str) -> Option<(&str, &str)> {
    let mut depth = 0_usize;
    for (at, byte) in text.bytes().enumerate().rev() {
        match byte {
            b']' => depth += 1,
            b'[' => depth = depth.saturating_sub(1),
            b'/' if depth == 0 && at > 0 && at + 1 < text.len() => return Some((&text[..at], &text[at + 1..])),
            _ => {}
        }
    }
    None
}

/// The form with this many operands, of the image's family where it has one.
fn form(entry: &'static instr::Instruction, image: &Image, operands: usize) -> Option<&'static Form> {
    let fits = |form: &&'static Form| form.operands.len() == operands;
    let of_family = entry.forms_for(image.family()).find(fits);
    let any = || entry.forms.iter().find(fits);
    of_family.or_else(any).or(entry.forms.first())
}

/// The operand whose symbol and description stand above, and no other, documented or not: what an
/// input tests first, the control element of shift instructions, the destination of outputs, the
/// first operand of string instructions. Agrees with every printed box that tells operands apart;
/// for sequencers, stacks and ASCII port instructions, never seen printed, it follows BSL.
fn documented(entry: &instr::Instruction, form: &Form) -> usize {
    let of = |wanted: &dyn Fn(&instr::Operand) -> bool| form.operands.iter().position(wanted);
    let control = of(&|o| matches!(o.kind, Kind::Control));
    let index = match form.position {
        Position::Output if entry.category == Category::Ascii => control,
        Position::Output => control.or_else(|| of(&|o| o.role.writes())),
        _ => form.code_order.first().copied(),
    };
    index.unwrap_or(0)
}
