//! SQO, SQC, SQL, BSL, BSR, FFL, FFU, LFL and LFU: instructions with a control element.
//!
//! EN, DN and the other bits stand where the original has them, in the control word, so that the edge
//! is that of the original, over a stop too. LEN is taken as a number: one that the program changes is
//! a condition.

use instr::exec::Width;
use ladder::{FileType, Instruction, Operand};

use super::allocate::Block;
use super::context::{Context, Converted, Person};
use super::counters::Parts;
use super::emit::{Emitter, FIRST_SCAN, Relation};
use super::files::{leave_index, looks_at_index};
use super::marks::Mark;
use super::moves::blend;
use super::operand::{Start, Target, operand};
use super::store::{destination, put, settled};
use super::table::{Row, row};
use super::value::{Value, wrapped};

pub(super) const TABLE: &[Row] = &[
    row("SQO", output),
    row("SQC", compare),
    row("SQL", load),
    row("BSL", |cx, e, i| shift(cx, e, i, true)),
    row("BSR", |cx, e, i| shift(cx, e, i, false)),
    row("FFL", push),
    row("LFL", push),
    row("FFU", |cx, e, i| pull(cx, e, i, true)),
    row("LFU", |cx, e, i| pull(cx, e, i, false)),
];

const EN: u16 = 15;
const EU: u16 = 14;
const DN: u16 = 13;
const EM: u16 = 12;
const ER: u16 = 11;
const UL: u16 = 10;
const FD: u16 = 8;

/// Longest array or stack that is written out.
const MOST_WORDS: u32 = 160;

/// A control element.
struct Control {
    parts: Parts,
    length: i64,
    position: String,
    name: String,
    address: ladder::Address,
}

impl Control {
    fn of(cx: &mut Context<'_>, i: &Instruction, index: usize) -> Converted<Control> {
        let parts = Parts::at(cx, i, index, FileType::R)?;
        let name = parts.name();
        let address = super::operand::address(i, index)?;
        let stored = address
            .file
            .number()
            .and_then(|file| cx.image.data_file(FileType::R, file))
            .and_then(|file| file.words.get(usize::from(address.element.number()?) * 3 + 1).copied());
        let length = i64::from(stored.unwrap_or(0) as i16);
        let position = parts.accumulated(cx)?;
        if length_changes(cx, address, length) {
            cx.condition(Mark::Files, format!("{name}.LEN stays {length}, its value in the data table"));
        }
        if length <= 0 {
            return Err(Person::new(Mark::Files, format!("{name}.LEN is {length}: a length of nothing")));
        }
        Ok(Control { parts, length, position, name, address: address.clone() })
    }

    fn bit(&self, cx: &Context<'_>, bit: u16) -> Converted<String> {
        self.parts.bit(cx, bit)
    }

    /// POS must stay in the file, unless the program itself keeps it there.
    fn position_condition(&self, cx: &mut Context<'_>) {
        let position = self.address.clone().with_word(2);
        let last = i32::try_from(self.length).unwrap_or(i32::MAX);
        if !cx.facts.stays_within(&position, 0, last) {
            cx.condition(Mark::Files, format!("{}.POS stays within 0 to {last}", self.name));
        }
    }
}

/// Something writes another LEN than the one in the data table.
fn length_changes(cx: &Context<'_>, control: &ladder::Address, length: i64) -> bool {
    let rungs = cx.image.program_files.iter().flat_map(|file| &file.rungs);
    rungs.flat_map(|rung| rung.instructions()).any(|one| {
        let name = one.mnemonic.name().unwrap_or_default();
        let form = instr::by_mnemonic(name).and_then(|known| known.forms.first());
        one.operands.iter().enumerate().any(|(index, operand)| {
            let Some(address) = operand.address() else { return false };
            if address.file_type != FileType::R
                || address.file != control.file && address.file.number().is_some()
                || address.element != control.element && address.element.number().is_some() && !address.indexed
            {
                return false;
            }
            let writes = form.and_then(|form| form.operands.get(index)).is_none_or(|operand| operand.role.writes());
            let same = || {
                let source = one.operands.first().and_then(Operand::constant).and_then(|c| c.as_integer());
                name == "MOV" && source == Some(length)
            };
            let as_word = address.word == Some(1) && writes && !same();
            let as_file = matches!(name, "COP" | "CPW" | "FLL") && writes;
            as_word || as_file
        })
    })
}

/// A file, mask, source or destination of a sequencer: a word, or with `#` the word of the step.
fn stepped(
    cx: &mut Context<'_>,
    e: &mut Emitter,
    operand: &Operand,
    position: &str,
    scratch: usize,
) -> Converted<Value> {
    let Some(address) = operand.address().filter(|address| address.indexed) else { return cx.value(operand, false) };
    let start = cx.start(operand)?;
    let text = entry(&start, position, &address.to_string())?;
    let width = if start.block == Block::D { Width::Long } else { Width::Word };
    let value = Value::indexed(text, width);
    Ok(settled(e, &value, &cx.scratch_long(scratch)))
}

/// Of a long word beside a file of words only the low one counts.
fn low_word(value: Value) -> Converted<Value> {
    match value.is_float() {
        true => Err(Person::new(Mark::Files, "a float beside words of a file")),
        false if value.fits(Width::Word) => Ok(value),
        false => Ok(wrapped(&value)),
    }
}

/// `N[first + POS]`.
fn entry(start: &Start, position: &str, name: &str) -> Converted<String> {
    if start.block.is_bits() || matches!(start.block, Block::R | Block::Sl) {
        return Err(Person::new(Mark::Files, format!("{name}: points or floats stepped through")));
    }
    let text = if start.first == "0" { position.to_owned() } else { format!("{} + {position}", start.first) };
    Ok(format!("{}[{text}]", start.block.name()))
}

/// Moves the sequencer on; `body` works with power on the word at POS.
fn step(
    cx: &mut Context<'_>,
    e: &mut Emitter,
    control: &Control,
    body: impl FnOnce(&mut Context<'_>, &mut Emitter) -> Converted,
) -> Converted {
    let (en, dn, er) = (control.bit(cx, EN)?, control.bit(cx, DN)?, control.bit(cx, ER)?);
    let (position, length) = (&control.position, control.length);
    let last = length.to_string();
    control.position_condition(cx);
    e.when(|e| {
        e.and_not(&en);
        // In the first scan a sequencer that stands at 0 works with step 0.
        e.when(|e| {
            e.store(&super::emit::Contact::Off(FIRST_SCAN.to_owned()));
            e.or(&super::emit::Contact::Compare(Relation::NotEqual, position.clone(), "0".to_owned()));
            e.join_and();
            e.math(position, &format!("IF({position} > {}, 1, {position} + 1)", length - 1));
            e.reset(&dn);
            e.reset(&er);
        });
    });
    e.hold(&en);
    let mut result = Ok(());
    e.when(|e| {
        e.when(|e| {
            e.and_compare(Relation::Equal, position, &last);
            e.set(&dn);
        });
        if cx.indexes() && looks_at_index(cx) {
            let index = cx.status_word(24);
            e.mov(position, &index);
        }
        result = body(cx, e);
    });
    result
}

/// SQO: every scan with power the word at POS goes to the destination through the mask.
fn output(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let control = Control::of(cx, i, 3)?;
    let (file, mask, to) = (operand(i, 0)?, operand(i, 1)?, operand(i, 2)?);
    let start = cx.start(file)?;
    reaches(&start, &control, file)?;
    let position = control.position.clone();
    step(cx, e, &control, |cx, e| {
        let word = Value::indexed(entry(&start, &position, &file.to_string())?, Width::Word);
        let word = settled(e, &word, &cx.scratch_long(2));
        let mask = low_word(stepped(cx, e, mask, &position, 3)?)?;
        let (old, target) = if to.address().is_some_and(|address| address.indexed) {
            cx.needs_unconfirmed("a destination decided at run time")?;
            let target = cx.start(to)?;
            let text = entry(&target, &position, &to.to_string())?;
            let old = Value::indexed(text.clone(), Width::Word);
            (old, Target { text, width: Width::Word, plain: false })
        } else {
            (cx.value(to, false)?, cx.write(to)?)
        };
        if target.width != Width::Word || start.block == Block::D {
            return Err(Person::new(Mark::Files, "a sequencer of long words"));
        }
        let value = blend(&word, &mask, &old);
        if target.plain {
            put(e, &value, &target);
        } else {
            e.math(&destination(&target), value.text());
        }
        Ok(())
    })
}

/// SQC: FD says whether source and word agree under the mask.
fn compare(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let control = Control::of(cx, i, 3)?;
    let (file, mask, source) = (operand(i, 0)?, operand(i, 1)?, operand(i, 2)?);
    let start = cx.start(file)?;
    reaches(&start, &control, file)?;
    if start.block == Block::D {
        return Err(Person::new(Mark::Files, "a sequencer of long words"));
    }
    let (position, found) = (control.position.clone(), control.bit(cx, FD)?);
    step(cx, e, &control, |cx, e| {
        let word = Value::indexed(entry(&start, &position, &file.to_string())?, Width::Word);
        let word = settled(e, &word, &cx.scratch_long(2));
        let mask = low_word(stepped(cx, e, mask, &position, 3)?)?;
        let source = low_word(stepped(cx, e, source, &position, 4)?)?;
        let left = settled(e, &source.bit_and(&mask), &cx.scratch_long(5));
        let right = settled(e, &word.bit_and(&mask), &cx.scratch_long(6));
        e.reset(&found);
        e.when(|e| {
            e.and_compare(Relation::Equal, left.plain().unwrap_or("0"), right.plain().unwrap_or("0"));
            e.set(&found);
        });
        Ok(())
    })
}

/// SQL: the source goes to the word at POS.
fn load(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let control = Control::of(cx, i, 2)?;
    let (file, source) = (operand(i, 0)?, operand(i, 1)?);
    let start = cx.start(file)?;
    reaches(&start, &control, file)?;
    cx.needs_unconfirmed("a destination decided at run time")?;
    let position = control.position.clone();
    step(cx, e, &control, |cx, e| {
        let value = stepped(cx, e, source, &position, 2)?;
        if value.is_float() || !value.fits(Width::Word) {
            return Err(Person::new(Mark::Files, "SQL of other than words"));
        }
        let stepped = source.address().is_some_and(|address| address.indexed);
        if start.block == Block::D && stepped && value.width == Width::Word {
            // Whether the sign of a word goes with it is not documented.
            return Err(Person::new(Mark::Files, "a sequencer that steps through words and long words"));
        }
        let text = entry(&start, &position, &file.to_string())?;
        e.math(&text.replace(' ', ""), value.text());
        Ok(())
    })
}

/// The file has a word for every step.
fn reaches(start: &Start, control: &Control, file: &Operand) -> Converted {
    let steps = u32::try_from(control.length).unwrap_or(u32::MAX).saturating_add(1);
    // A step of long words takes two words.
    let (each, name) = if start.block == Block::D { (2, "long words") } else { (1, "words") };
    if start.fixed.is_none() || start.words < steps.saturating_mul(each) {
        return Err(Person::new(Mark::Files, format!("{file}: {steps} {name} from a fixed place are needed")));
    }
    Ok(())
}

/// The words of an array of bits or of a stack.
fn words(cx: &Context<'_>, file: &Operand, start: &Start, words: u32) -> Converted<Vec<String>> {
    let Some((file_type, number, word)) = start.place.filter(|place| !place.0.has_slots()) else {
        return Err(Person::new(Mark::Files, format!("{file}: an array at a place decided at run time, or of points")));
    };
    if words > start.words {
        return Err(Person::new(Mark::Files, format!("{file}: the array is longer than its file")));
    }
    if words > MOST_WORDS {
        return Err(Person::new(Mark::Files, format!("{file}: an array of {words} words")));
    }
    let lost = || Person::new(Mark::Files, format!("{file}: the array has no words of its own"));
    (0..words).map(|index| cx.places.word(file_type, number, word + index).ok_or_else(lost)).collect()
}

/// BSL and BSR: when the rung becomes true all bits move by one; the one that leaves goes to UL.
fn shift(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction, left: bool) -> Converted {
    let control = Control::of(cx, i, 1)?;
    let (file, bit) = (operand(i, 0)?, operand(i, 2)?);
    let start = cx.start(file)?;
    let length = u32::try_from(control.length).unwrap_or(0);
    let words = words(cx, file, &start, length.div_ceil(16))?;
    if !cx.facts.stays_within(&control.address.clone().with_word(2), 0, i32::from(i16::MAX)) {
        cx.condition(Mark::Files, format!("{}.POS is not negative", control.name));
    }
    let bit = cx.bit(bit)?;
    let (en, dn, er, ul) = (control.bit(cx, EN)?, control.bit(cx, DN)?, control.bit(cx, ER)?, control.bit(cx, UL)?);
    e.when(|e| {
        e.and_not(&en);
        // The entering and the leaving bit are read before anything moves.
        let (entering, leaving) = (cx.scratch_long(2), cx.scratch_long(3));
        let end = if left { (length - 1) % 16 } else { 0 };
        let from = if left { words.last() } else { words.first() };
        e.math(&entering, &format!("IF({} == 0, 0, 1)", bit.term()));
        if let Some(word) = from {
            e.math(&leaving, &format!("IF(({word} & {}) == 0, 0, 1)", 1_u32 << end));
        }
        if left {
            shift_left(e, &words, length, &entering);
        } else {
            shift_right(e, &words, length, &entering);
        }
        e.when(|e| {
            e.and_compare(Relation::NotEqual, &leaving, "0");
            e.set(&ul);
        });
        e.when(|e| {
            e.and_compare(Relation::Equal, &leaving, "0");
            e.reset(&ul);
        });
        e.set(&dn);
        e.reset(&er);
        leave_index(cx, e, length / 16);
    });
    e.hold(&en);
    e.unless(|e| e.reset(&dn));
    Ok(())
}

/// The bits of a word that belong to the array.
fn used(length: u32, index: usize) -> u32 {
    let before = index as u32 * 16;
    (length - before).min(16)
}

/// From the highest word down, so that each takes the old top bit of the one below.
fn shift_left(e: &mut Emitter, words: &[String], length: u32, entering: &str) {
    for (index, word) in words.iter().enumerate().rev() {
        let below = match index.checked_sub(1).and_then(|below| words.get(below)) {
            Some(below) => format!("IF({below} < 0, 1, 0)"),
            None => entering.to_owned(),
        };
        let bits = used(length, index);
        if bits == 16 {
            // Bit 14 becomes the sign.
            e.math(word, &format!("({word} & 16383) * 2 + {below} - IF(({word} & 16384) == 0, 0, 32768)"));
        } else {
            let (moved, kept) = ((1_u32 << (bits - 1)) - 1, -(1_i64 << bits));
            e.math(word, &format!("({word} & ({kept})) + ({word} & {moved}) * 2 + {below}"));
        }
    }
}

/// From the lowest word up, so that each takes the old bottom bit of the one above.
fn shift_right(e: &mut Emitter, words: &[String], length: u32, entering: &str) {
    for (index, word) in words.iter().enumerate() {
        let bits = used(length, index);
        let above = match words.get(index + 1) {
            Some(above) => format!("({above} & 1)"),
            None => entering.to_owned(),
        };
        if bits == 16 {
            // What comes in at the top is the sign.
            e.math(word, &format!("(({word} & 65535) / 2) - {above} * 32768"));
        } else {
            let (all, kept) = ((1_u32 << bits) - 1, -(1_i64 << bits));
            e.math(word, &format!("({word} & ({kept})) + (({word} & {all}) / 2) + {above} * {}", 1_u32 << (bits - 1)));
        }
    }
}

/// A stack and its control element.
struct Stack {
    control: Control,
    words: Vec<String>,
    first: String,
    block: Block,
}

impl Stack {
    fn of(cx: &mut Context<'_>, i: &Instruction, file_index: usize) -> Converted<Stack> {
        let control = Control::of(cx, i, 2)?;
        let file = operand(i, file_index)?;
        let start = cx.start(file)?;
        if start.size != 1 || start.block.is_bits() {
            return Err(Person::new(Mark::Files, format!("{file}: a stack of other than words")));
        }
        let words = words(cx, file, &start, u32::try_from(control.length).unwrap_or(0))?;
        control.position_condition(cx);
        Ok(Stack { control, words, first: start.first, block: start.block })
    }

    /// DN and EM say full and empty.
    fn levels(&self, cx: &Context<'_>, e: &mut Emitter) -> Converted {
        let (dn, em, er) = (self.control.bit(cx, DN)?, self.control.bit(cx, EM)?, self.control.bit(cx, ER)?);
        let position = &self.control.position;
        e.reset(&dn);
        e.reset(&em);
        e.reset(&er);
        e.when(|e| {
            e.and_compare(Relation::GreaterOrEqual, position, &self.control.length.to_string());
            e.set(&dn);
        });
        e.when(|e| {
            e.and_compare(Relation::Equal, position, "0");
            e.set(&em);
        });
        Ok(())
    }

    fn at(&self, offset: &str) -> String {
        format!("{}[{} + {}{offset}]", self.block.name(), self.first, self.control.position)
    }
}

/// FFL and LFL: when the rung becomes true and the stack is not full, the source goes to place POS.
fn push(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let stack = Stack::of(cx, i, 1)?;
    cx.needs_unconfirmed("a destination decided at run time")?;
    let source = cx.value(operand(i, 0)?, false)?;
    let source = low_word(source)?;
    let (en, dn) = (stack.control.bit(cx, EN)?, stack.control.bit(cx, DN)?);
    let position = stack.control.position.clone();
    // S:24 gets the POS it found in every scan with power, behind the source, which may be S:24 or indexed by it.
    let index = (cx.indexes() && looks_at_index(cx)).then(|| (cx.status_word(24), cx.scratch_long(2)));
    if let Some((_, found)) = &index {
        e.mov(&position, found);
    }
    let mut result = Ok(());
    e.when(|e| {
        e.and_not(&en);
        e.when(|e| {
            e.and_not(&dn);
            e.and_compare(Relation::Less, &position, &stack.control.length.to_string());
            e.math(&stack.at("").replace(' ', ""), source.text());
            e.math(&position, &format!("{position} + 1"));
        });
        result = stack.levels(cx, e);
    });
    if let Some((index, found)) = &index {
        e.mov(found, index);
    }
    e.hold(&en);
    result
}

/// FFU and LFU: when the rung becomes true and the stack is not empty, an entry leaves it.
fn pull(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction, first_in: bool) -> Converted {
    let stack = Stack::of(cx, i, 0)?;
    let to = cx.write(operand(i, 1)?)?;
    let eu = stack.control.bit(cx, EU)?;
    let position = stack.control.position.clone();
    let (first, last) =
        (stack.words.first().cloned().unwrap_or_default(), stack.words.last().cloned().unwrap_or_default());
    let (taken, had) = (cx.scratch_long(2), cx.scratch_bit(92));
    let mut result = Ok(());
    e.when(|e| {
        e.and_not(&eu);
        e.when(|e| {
            e.and_compare(Relation::Greater, &position, "0");
            e.hold(&had);
        });
        e.when(|e| {
            e.and_compare(Relation::Greater, &position, "0");
            if first_in {
                e.mov(&first, &taken);
                match stack.words.get(1) {
                    Some(second) if stack.words.len() > 2 => {
                        let count = stack.words.len() - 1;
                        e.output("MEMCOPY", [second.clone(), first.clone(), "0x20000".to_owned(), count.to_string()]);
                    }
                    Some(second) => e.mov(second, &first),
                    None => {}
                }
                e.mov("0", &last);
            } else {
                e.math(&taken, &stack.at(" - 1"));
            }
            e.math(&position, &format!("{position} - 1"));
        });
        result = stack.levels(cx, e);
    });
    if cx.indexes() && looks_at_index(cx) {
        let index = cx.status_word(24);
        e.mov(&position, &index);
    }
    // The destination last: it may be a word of the control element, or indexed by S:24.
    e.when(|e| {
        e.and(&had);
        let value = Value::element(taken.clone(), Width::Word);
        let value = if to.width == Width::Float { value.as_float() } else { value };
        put(e, &value, &to);
        e.reset(&had);
    });
    e.hold(&eu);
    result
}
