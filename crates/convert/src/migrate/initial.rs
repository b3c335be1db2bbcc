//! The values of the data table: rungs that store them once, and rows for a person.

use domore::{Instruction, Rung};
use ladder::{FileType, Image};

use super::allocate::{Block, Element, Places, Span};
use super::facts::Facts;

/// The subroutine that stores initial values.
pub(super) const INIT_BLOCK: &str = "SLCinit";

/// Rows of one INIT box.
const ROWS: usize = 24;
/// Moves of one rung.
const MOVES: usize = 12;

/// A value other than zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Initial {
    /// Address of the original.
    pub slc: String,
    /// Operand of the result.
    pub domore: String,
    /// The value as the result writes it.
    pub value: String,
}

impl Initial {
    /// Whether a text can have it: infinity and what is no number have no constant.
    pub(super) fn is_written(&self) -> bool {
        !matches!(self.value.as_str(), "NaN" | "inf" | "-inf") || self.domore.starts_with("SL")
    }
}

/// All values that are not zero, in the order of the allocation, inputs left out.
pub fn values(image: &Image, facts: &Facts, places: &Places) -> Vec<Initial> {
    let mut found = Vec::new();
    for span in places.spans() {
        let Some(words) = words_of(image, span) else { continue };
        for index in 0..span.words {
            let Some(address) = span.address(index) else { break };
            // The controller's own words mean nothing in another controller.
            if span.file_type == FileType::S
                && !address.element.number().is_some_and(|word| facts.names_status(word) || word == 2)
            {
                continue;
            }
            let word = |offset: u32| words.get((index + offset) as usize).copied().unwrap_or(0);
            let slc = address.to_string();
            let domore = |places: &Places| match span.at.block {
                Block::D | Block::R | Block::Sl => {
                    places.element(span.file_type, span.file, span.first_word + index).map(|e| e.to_string())
                }
                _ => places.word(span.file_type, span.file, span.first_word + index),
            };
            let value = match span.at.block {
                Block::D | Block::R if index % 2 != 0 => continue,
                Block::T | Block::X | Block::Wx => continue,
                Block::Sl if index % 42 != 0 => continue,
                Block::Sl => literal(words.get(index as usize..).unwrap_or_default()),
                Block::D => (long(word(0), word(1)) as i32).to_string(),
                Block::R => super::operand::float(f32::from_bits(long(word(0), word(1)))),
                _ => (word(0) as i16).to_string(),
            };
            if matches!(value.as_str(), "0" | "0.0" | "") {
                continue;
            }
            match domore(places) {
                Some(domore) => found.push(Initial { slc, domore, value }),
                None => found.extend(points(places, span, index, word(0))),
            }
        }
    }
    found
}

/// A word whose points lie apart, bit by bit.
fn points(places: &Places, span: &Span, index: u32, word: u16) -> Vec<Initial> {
    let on = (0..16).filter(|bit| word >> bit & 1 != 0);
    on.filter_map(|bit| {
        let domore = places.bit(span.file_type, span.file, span.first_word + index, bit)?;
        let slc = span.address(index)?.with_bit(bit).to_string();
        Some(Initial { slc, domore, value: "1".to_owned() })
    })
    .collect()
}

/// The characters of a string element as a literal has them: what could end it or begin an escape by its number.
fn literal(words: &[u16]) -> String {
    let length = usize::from(words.first().copied().unwrap_or(0)).min(82);
    let characters = words.iter().skip(1).take(41).flat_map(|word| word.to_be_bytes()).take(length);
    let spelled = characters.map(|byte| match byte {
        b'"' | b'$' | ..b' ' | 0x7F.. => format!("${byte:02X}"),
        byte => char::from(byte).to_string(),
    });
    spelled.collect()
}

fn long(low: u16, high: u16) -> u32 {
    u32::from(low) | u32::from(high) << 16
}

/// The stored words of a span.
fn words_of(image: &Image, span: &Span) -> Option<Vec<u16>> {
    let file = match span.file_type {
        FileType::I | FileType::O => image.data_file(span.file_type, u16::from(span.file_type == FileType::I))?,
        other => image.data_file(other, span.file)?,
    };
    let first = match span.file_type.has_slots() {
        true => usize::try_from(span.stored?).ok()?,
        false => usize::try_from(span.first_word).ok()?,
    };
    let end = first.checked_add(usize::try_from(span.words).ok()?)?;
    let words = file.words.get(first..end.min(file.words.len()))?;
    Some(words.to_vec())
}

/// The rungs of [`INIT_BLOCK`]; empty when there is nothing to store.
pub(super) fn rungs(values: &[Initial], done: &str) -> Vec<Rung> {
    let mut boxes: Vec<Vec<String>> = Vec::new();
    let mut rows: Vec<(String, String, String)> = Vec::new();
    let mut moves: Vec<Instruction> = Vec::new();
    let mut row: Option<(Element, Element, String)> = None;
    for initial in values.iter().filter(|initial| initial.is_written()) {
        let element = element(&initial.domore);
        match (element, &mut row) {
            (None, _) if initial.domore.contains(':') => {
                moves.push(Instruction::new("MOVE", [initial.value.clone(), initial.domore.clone()]));
            }
            (None, _) => moves.push(Instruction::new("SET", [initial.domore.clone()])),
            (Some(Element { block: Block::Sl, .. }), _) => {
                let text = domore::address::quote(&format!("\"{}\"", initial.value));
                moves.push(Instruction::new("STRPRINT", [initial.domore.clone(), "0x4".to_owned(), text]));
            }
            (Some(at), Some((_, last, value)))
                if last.block == at.block && last.number + 1 == at.number && *value == initial.value =>
            {
                *last = at;
            }
            (Some(at), open) => {
                rows.extend(open.take().map(|(first, last, value)| (first.to_string(), last.to_string(), value)));
                *open = Some((at, at, initial.value.clone()));
            }
        }
    }
    rows.extend(row.map(|(first, last, value)| (first.to_string(), last.to_string(), value)));
    for part in rows.chunks(ROWS) {
        boxes.push(part.iter().map(|(first, last, value)| format!("{first} {last} {value}")).collect());
    }
    let always = || Instruction::new("STR", [super::emit::ALWAYS]);
    let mut rungs: Vec<Rung> = boxes
        .into_iter()
        .map(|rows| {
            let table = domore::address::quote(&format!("3 {}", rows.join(" ")));
            Rung::new([always(), Instruction::new("INIT", [table])])
        })
        .collect();
    rungs.extend(moves.chunks(MOVES).map(|part| Rung::new([always()].into_iter().chain(part.iter().cloned()))));
    rungs.push(Rung::new([always(), Instruction::new("SET", [done])]));
    rungs
}

/// A whole element that INIT takes, from its text.
fn element(text: &str) -> Option<Element> {
    let digits = text.bytes().rev().take_while(u8::is_ascii_digit).count();
    let (block, number) = text.split_at(text.len() - digits);
    let block = Block::by_name(block).filter(|block| !block.is_bits())?;
    Some(Element { block, number: number.parse().ok()? })
}
