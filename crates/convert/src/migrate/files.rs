//! COP, CPW, FLL and SWP: runs of words.
//!
//! Files keep the order of their words (see [`super::allocate`]), so a run of words is a run of
//! elements. Where source and destination lie in unlike blocks, the words move one by one.

use instr::exec::Width;
use ladder::{Address, FileType, Instruction, Operand};

use super::allocate::Block;
use super::context::{Context, Converted, Person};
use super::emit::Emitter;
use super::marks::Mark;
use super::operand::{Start, Target, operand};
use super::store::{Wrap, destination, put, settled};
use super::table::{Row, row};
use super::value::{Value, choose, limited, relation, wrapped};

pub(super) const TABLE: &[Row] = &[
    row("COP", |cx, e, i| copy(cx, e, i, false)),
    row("CPW", |cx, e, i| copy(cx, e, i, true)),
    row("FLL", fill),
    row("SWP", swap),
];

/// Most elements of a run that is written out one by one.
const MOST: u32 = 128;

/// A run of words in the data table, or of elements decided at run time.
#[derive(Clone, Debug)]
enum Run {
    /// Words one after the other in one block: elements of it, from this one.
    Solid {
        block: Block,
        first: u32,
        /// Elements.
        count: u32,
    },
    /// Words that lie apart, or of which 16 points make one: a plain operand each.
    Words(Vec<String>),
    /// In one block, from the number this expression gives.
    Chosen { block: Block, first: String, count: u32 },
}

/// Words that one element of a block takes.
fn words_per(block: Block) -> u32 {
    match block {
        Block::D | Block::R => 2,
        Block::Sl => 42,
        _ => 1,
    }
}

/// LENGTH as a number.
fn length(i: &Instruction, index: usize) -> Converted<u32> {
    let constant = operand(i, index)?.constant().and_then(|constant| constant.as_integer());
    match constant {
        Some(length) => Ok(u32::try_from(length).unwrap_or(0)),
        None => Err(Person::new(Mark::Files, format!("{}: its length is decided at run time", i.mnemonic))),
    }
}

/// The words of inputs or outputs in the order of the image, by slot and word.
fn image_words(cx: &Context<'_>, file_type: FileType) -> Vec<(u16, u16)> {
    let mut words = Vec::new();
    for slot in &cx.image.io.slots {
        let range = if file_type == FileType::I { slot.inputs } else { slot.outputs };
        for word in 0..range.words {
            words.push((range.first_word.saturating_add(word), slot.number, word));
        }
    }
    words.sort_unstable();
    words.into_iter().map(|(_, slot, word)| (slot, word)).collect()
}

/// Words from a fixed start to the end of its file.
fn room(cx: &Context<'_>, start: &Start) -> u32 {
    let Some((file_type, slot, word)) = start.place else { return start.words };
    if !file_type.has_slots() {
        return start.words;
    }
    let words = image_words(cx, file_type);
    let at = words.iter().position(|found| (found.0, u32::from(found.1)) == (slot, word));
    at.map_or(start.words, |at| (words.len() - at) as u32)
}

/// The run of `words` words from a start.
fn run(cx: &Context<'_>, start: &Start, words: u32, name: &str) -> Converted<Run> {
    let per = words_per(start.block);
    if !words.is_multiple_of(per) {
        return Err(Person::new(Mark::Files, format!("{name}: the run ends inside an element")));
    }
    let Some((file_type, file, word)) = start.place else {
        if start.block.is_bits() {
            return Err(Person::new(Mark::Indirect, format!("{name}: words of points decided at run time")));
        }
        return Ok(Run::Chosen { block: start.block, first: start.first.clone(), count: words / per });
    };
    let lost = |index: u32| Person::new(Mark::Files, format!("{name}: word {index} of the run has no place"));
    if file_type.has_slots() {
        let image = image_words(cx, file_type);
        let at = image.iter().position(|found| (found.0, u32::from(found.1)) == (file, word));
        let texts = (0..words).map(|index| {
            let place = match at {
                Some(at) => image.get(at + index as usize).copied().map(|(slot, word)| (slot, u32::from(word))),
                None => Some((file, word + index)),
            };
            place.and_then(|(slot, word)| cx.places.word(file_type, slot, word)).ok_or_else(|| lost(index))
        });
        return Ok(Run::Words(texts.collect::<Converted<Vec<_>>>()?));
    }
    if start.block.is_bits() {
        let texts = (0..words).map(|index| cx.places.word(file_type, file, word + index).ok_or_else(|| lost(index)));
        return Ok(Run::Words(texts.collect::<Converted<Vec<_>>>()?));
    }
    if per > 1 && cx.places.element(file_type, file, word).is_none() {
        return Err(Person::new(Mark::Files, format!("{name}: the run begins inside an element")));
    }
    let first = start.fixed.ok_or_else(|| lost(0))?;
    Ok(Run::Solid { block: start.block, first, count: words / per })
}

fn element(block: Block, number: u32) -> String {
    format!("{}{number}", block.name())
}

/// COP moves elements of the destination, CPW words; nothing is converted.
fn copy(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction, in_words: bool) -> Converted {
    let (source, to) = (operand(i, 0)?, operand(i, 1)?);
    let (from, into) = (cx.start(source)?, cx.start(to)?);
    written(cx, to)?;
    let unit = if in_words { 1 } else { into.size };
    let wanted = length(i, 2)?.saturating_mul(unit);
    let words = if into.fixed.is_some() { wanted.min(room(cx, &into)) } else { wanted };
    run_time_room(cx, to, &into, wanted);
    run_time_room(cx, source, &from, words);
    if from.fixed.is_some() && words > room(cx, &from) {
        return Err(Person::new(
            Mark::Files,
            format!("{source} has less than {words} words: the copy would leave its file"),
        ));
    }
    let (from, into) = (run(cx, &from, words, &source.to_string())?, run(cx, &into, words, &to.to_string())?);
    move_run(cx, e, &from, &into)?;
    leave_index(cx, e, words);
    Ok(())
}

/// A run from a place decided at run time has to stay in its file.
fn run_time_room(cx: &mut Context<'_>, operand: &Operand, start: &Start, words: u32) {
    if start.fixed.is_none() && words > start.size {
        cx.condition(Mark::Indirect, format!("{words} words from {operand} on must lie inside its file"));
    }
}

/// What writing to a file means.
fn written(cx: &mut Context<'_>, operand: &Operand) -> Converted {
    let Operand::Address(address) = operand else { return Ok(()) };
    if address.file_type == FileType::S || address.file_type.is_function_file() {
        return Err(Person::new(Mark::Status, format!("{address}: words of the controller are written as a file")));
    }
    if !address.is_direct_file() {
        cx.needs_unconfirmed("a destination decided at run time")?;
    }
    Ok(())
}

/// Whether a file operand leads to one place.
trait FileOperand {
    fn is_direct_file(&self) -> bool;
}

impl FileOperand for Address {
    fn is_direct_file(&self) -> bool {
        Address { indexed: false, ..self.clone() }.is_direct()
    }
}

/// On processors with S:24 file instructions leave a number there.
pub(super) fn leave_index(cx: &mut Context<'_>, e: &mut Emitter, number: u32) {
    if cx.indexes() && looks_at_index(cx) {
        let index = cx.status_word(24);
        e.mov(&number.to_string(), &index);
    }
}

/// The program reads S:24, by name or by a word operand written with `#`.
pub(super) fn looks_at_index(cx: &Context<'_>) -> bool {
    cx.facts.names_status(24)
        || cx.image.program_files.iter().flat_map(|file| &file.rungs).flat_map(|rung| rung.instructions()).any(|one| {
            let name = one.mnemonic.name().unwrap_or_default();
            let takes_files = instr::by_mnemonic(name).is_some_and(|known| {
                matches!(known.category, instr::Category::File | instr::Category::Sequencer | instr::Category::Ascii)
            });
            let indexed = |operand: usize| {
                one.operands.get(operand).and_then(Operand::address).is_some_and(|address| address.indexed)
            };
            match name {
                // Beside their file these take a word.
                "FFL" | "LFL" | "FLL" => indexed(0),
                "FFU" | "LFU" => indexed(1),
                _ => !takes_files && super::facts::addresses(one).into_iter().any(|address| address.indexed),
            }
        })
}

fn move_run(cx: &mut Context<'_>, e: &mut Emitter, from: &Run, into: &Run) -> Converted {
    match (from, into) {
        (Run::Solid { block, first, count }, Run::Solid { block: other, first: to, .. }) if block == other => {
            copy_solid(cx, e, *block, *first, *to, *count);
            Ok(())
        }
        (Run::Chosen { .. }, _) | (_, Run::Chosen { .. }) => by_index(cx, e, from, into),
        _ => by_words(e, from, into),
    }
}

/// Elements of one block. A copy to an overlapping higher place repeats what it has copied: then it is
/// made of copies that do not overlap.
fn copy_solid(cx: &mut Context<'_>, e: &mut Emitter, block: Block, from: u32, to: u32, count: u32) {
    if count == 0 || from == to {
        return;
    }
    if block == Block::Sl {
        cx.condition(Mark::Text, "a string copied as it is stays within the length of a Do-more string");
    }
    let shift = if to > from && to - from < count { to - from } else { count };
    let mut done = 0;
    while done < count {
        // Everything from `from` to here repeats with the period `shift`.
        let step = (shift + done).min(count - done);
        copy_apart(e, block, from, to + done, step);
        done += step;
    }
}

fn copy_apart(e: &mut Emitter, block: Block, from: u32, to: u32, count: u32) {
    let (source, target) = (element(block, from), element(block, to));
    if block == Block::Sl {
        e.output("MEMCOPY", [source, target, "0x20000".to_owned(), count.to_string()]);
    } else if count == 1 {
        e.mov(&source, &target);
    } else if to < from && from - to < count {
        // Downwards over itself: the vendor's help promises this for MEMCOPY.
        e.output("MEMCOPY", [source, target, "0x20000".to_owned(), count.to_string()]);
    } else {
        e.output("COPY", ["0x0".to_owned(), format!("\"4 0x0 {source} {target} {count}\"")]);
    }
}

/// Elements of which one side is decided at run time, one by one from the lowest on.
fn by_index(cx: &mut Context<'_>, e: &mut Emitter, from: &Run, into: &Run) -> Converted {
    let mut side = |run: &Run, scratch: usize| -> Converted<(Block, u32, Vec<String>)> {
        match run {
            Run::Solid { block, first, count } => {
                Ok((*block, *count, (0..*count).map(|index| element(*block, first + index)).collect()))
            }
            Run::Chosen { block, first, count } => {
                if *count > MOST {
                    return Err(Person::new(Mark::Files, format!("{count} elements decided at run time")));
                }
                let base = cx.scratch_long(scratch);
                e.math(&base, first);
                let text = |index: u32| match index {
                    0 => format!("{}[{base}]", block.name()),
                    _ => format!("{}[{base} + {index}]", block.name()),
                };
                Ok((*block, *count, (0..*count).map(text).collect()))
            }
            Run::Words(_) => Err(Person::new(Mark::Files, "points beside elements decided at run time")),
        }
    };
    let (source, _, texts) = side(from, 2)?;
    let (target, _, targets) = side(into, 3)?;
    if source != target {
        return Err(Person::new(Mark::Files, "elements of unlike memory decided at run time"));
    }
    if source == Block::Sl {
        return Err(Person::new(Mark::Text, "strings decided at run time"));
    }
    for (source, target) in texts.iter().zip(&targets) {
        e.math(&target.replace(' ', ""), source);
    }
    Ok(())
}

/// Words of unlike blocks, one by one from the lowest on. The two runs never overlap.
fn by_words(e: &mut Emitter, from: &Run, into: &Run) -> Converted {
    let words = words_of(from)?;
    if words.len() > MOST as usize {
        return Err(Person::new(Mark::Files, format!("{} words between unlike blocks", words.len())));
    }
    match into {
        Run::Words(targets) => {
            for (word, target) in words.iter().zip(targets) {
                put(e, word, &Target { text: target.clone(), width: Width::Word, plain: true });
            }
        }
        Run::Solid { block: Block::D, first, .. } => {
            for (pair, number) in words.chunks_exact(2).zip(*first..) {
                let [low, high] = pair else { continue };
                let low = low.bit_and(&Value::integer(65_535)).bounded(0, 65_535);
                let long = high.times(&Value::integer(65_536)).plus(&low);
                e.math(&element(Block::D, number), long.text());
            }
        }
        Run::Solid { block: block @ (Block::R | Block::Sl), .. } => {
            return Err(Person::new(
                Mark::Files,
                format!("words as they are into {}: their order is not documented", block.name()),
            ));
        }
        Run::Solid { block, first, .. } => {
            for (word, number) in words.iter().zip(*first..) {
                let target = Target { text: element(*block, number), width: Width::Word, plain: true };
                put(e, word, &target);
            }
        }
        Run::Chosen { .. } => return Err(Person::new(Mark::Files, "words decided at run time")),
    }
    Ok(())
}

/// The words of a run as values.
fn words_of(run: &Run) -> Converted<Vec<Value>> {
    Ok(match run {
        Run::Words(texts) => texts.iter().map(|text| Value::element(text, Width::Word)).collect(),
        Run::Solid { block: Block::D, first, count } => {
            let mut words = Vec::new();
            for number in *first..first + count {
                let long = Value::element(element(Block::D, number), Width::Long);
                let low = long.bit_and(&Value::integer(65_535)).bounded(0, 65_535);
                let top = Value::integer(32_767);
                let signed = choose(&relation(&low, ">", &top), &low.minus(&Value::integer(65_536)), &low);
                words.push(signed.bounded(-32_768, 32_767));
                let high = format!("({} - {}) / 65536", long.text(), low.atom());
                words.push(Value::expression(high, Width::Word));
            }
            words
        }
        Run::Solid { block: block @ (Block::R | Block::Sl), .. } => {
            return Err(Person::new(
                Mark::Files,
                format!("words of {} as they are: their order is not documented", block.name()),
            ));
        }
        Run::Solid { block, first, count } => {
            (*first..first + count).map(|number| Value::element(element(*block, number), Width::Word)).collect()
        }
        Run::Chosen { .. } => return Err(Person::new(Mark::Files, "words decided at run time")),
    })
}

/// FLL: one value in every element of the destination.
fn fill(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (source, to) = (operand(i, 0)?, operand(i, 1)?);
    let into = cx.start(to)?;
    written(cx, to)?;
    let wanted = length(i, 2)?.saturating_mul(into.size);
    let words = if into.fixed.is_some() { wanted.min(room(cx, &into)) } else { wanted };
    run_time_room(cx, to, &into, wanted);
    if into.size > 2 || into.block == Block::Sl {
        return Err(Person::new(Mark::Files, format!("FLL of the elements of {to}")));
    }
    let target = run(cx, &into, words, &to.to_string())?;
    let width = match into.block {
        Block::D => Width::Long,
        Block::R => Width::Float,
        _ => Width::Word,
    };
    let long = cx.any_long(&[source]) || width == Width::Long;
    let value = cx.value(source, long)?;
    let value = converted(cx, e, &value, width)?;
    match &target {
        Run::Solid { block, first, count } if *count > 0 => {
            let (start, last) = (element(*block, *first), element(*block, first + count - 1));
            match (&value.constant, value.plain()) {
                (Some(_), Some(number)) if *count > 1 => {
                    e.output("INIT", [format!("\"3 {start} {last} {number}\"")]);
                }
                _ => {
                    put(e, &value, &Target { text: start, width, plain: true });
                    // The first element holds the value from here on, the source may be filled itself.
                    copy_solid(cx, e, *block, *first, first + 1, count - 1);
                }
            }
        }
        Run::Solid { .. } => {}
        Run::Words(texts) => {
            let held = settled(e, &value, &cx.scratch_long(4));
            let held = if held.constant.is_none() && texts.iter().any(|text| held.plain() == Some(text)) {
                let scratch = cx.scratch_long(4);
                e.mov(held.text(), &scratch);
                Value::element(scratch, Width::Word)
            } else {
                held
            };
            for text in texts {
                put(e, &held, &Target { text: text.clone(), width, plain: true });
            }
        }
        Run::Chosen { block, first, count } => {
            if *count > MOST {
                return Err(Person::new(Mark::Files, format!("{count} elements decided at run time")));
            }
            let held = match (&value.constant, width) {
                (Some(_), _) => value.clone(),
                (None, Width::Float) => {
                    let scratch = cx.scratch_float(4);
                    e.math(&scratch, value.text());
                    Value::element(scratch, width)
                }
                (None, _) => {
                    let scratch = cx.scratch_long(4);
                    e.math(&scratch, value.text());
                    Value::element(scratch, width)
                }
            };
            let base = cx.scratch_long(3);
            e.math(&base, first);
            for index in 0..*count {
                let text = if index == 0 {
                    format!("{}[{base}]", block.name())
                } else {
                    format!("{}[{base}+{index}]", block.name())
                };
                e.math(&destination(&Target { text, width, plain: false }), held.text());
            }
        }
    }
    leave_index(cx, e, words);
    Ok(())
}

/// A value in the kind of the elements it fills: limited (or cut with S:2/14), without flags and trap.
fn converted(cx: &mut Context<'_>, e: &mut Emitter, value: &Value, width: Width) -> Converted<Value> {
    if let Some(number) = value.constant {
        let outcome = instr::exec::logic::mov(number, width, cx.rules.math(0));
        return Ok(outcome.value.map_or_else(|| value.clone(), Value::number));
    }
    match (value.width, width) {
        (a, b) if a == b => Ok(value.clone()),
        (Width::Word, Width::Long) => Ok(value.clone()),
        (Width::Word | Width::Long, Width::Float) => Ok(value.as_float()),
        (Width::Long, Width::Word) => {
            let value = settled(e, value, &cx.scratch_long(2));
            let (limited, cut) = (limited(&value, Width::Word), wrapped(&value));
            Ok(match cx.wrap() {
                Wrap::Never => limited,
                Wrap::Always => cut,
                Wrap::By(bit) => choose(&format!("{bit} == 1"), &cut, &limited),
            })
        }
        _ => Err(Person::new(Mark::Rounding, "FLL of a float into integers")),
    }
}

/// SWP: the bytes of each word exchanged.
fn swap(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let file = operand(i, 0)?;
    let start = cx.start(file)?;
    written(cx, file)?;
    let words = length(i, 1)?;
    let words = if start.fixed.is_some() { words.min(room(cx, &start)) } else { words };
    let texts = match run(cx, &start, words, &file.to_string())? {
        Run::Words(texts) => texts,
        Run::Solid { block, .. } if words_per(block) > 1 => {
            return Err(Person::new(Mark::Files, format!("SWP of {file}")));
        }
        Run::Solid { block, first, count } => (first..first + count).map(|number| element(block, number)).collect(),
        Run::Chosen { .. } => return Err(Person::new(Mark::Indirect, format!("SWP of {file}"))),
    };
    if texts.len() > MOST as usize {
        return Err(Person::new(Mark::Files, format!("SWP of {} words", texts.len())));
    }
    for text in texts {
        let scratch = cx.scratch_long(2);
        e.math(&scratch, &format!("({text} & 255) * 256 + (({text} & 65280) / 256)"));
        let value = Value::element(scratch, Width::Long).bounded(0, 65_535);
        put(e, &wrapped(&value), &Target { text, width: Width::Word, plain: true });
    }
    Ok(())
}
