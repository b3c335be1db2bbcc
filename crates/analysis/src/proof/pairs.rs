//! Which data of the two sides belongs together, and the comparison after every scan.

use std::collections::{BTreeMap, BTreeSet};

use ladder::{Address, FileType, Image};

use super::play::MINOR_ERROR;
use super::side::{Kind, Side, Slc};
use crate::CrossReference;

/// Data of the original and where the other program has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mapping {
    /// First word of the original (`N7:0`, `I:1.0`, `T4:0`), or a single bit.
    pub original: String,
    /// Words that follow one another on both sides; 0 for a single bit.
    pub words: u32,
    /// The element of the other side the first one lies in (`N0`, `X0`, `C16`; an address of the same
    /// form where the other side is an SLC program too).
    pub other: String,
}

impl Mapping {
    /// Every data file of an image mapped to itself: for two versions of one program.
    pub fn identity(image: &Image) -> Vec<Mapping> {
        let mut all = Vec::new();
        for file in &image.data_files {
            let io = file.file_type.has_slots();
            if io || matches!(file.file_type, FileType::Unused | FileType::Reserved | FileType::Unknown(_)) {
                continue;
            }
            let first = Address::element(file.file_type, file.number, 0).to_string();
            let words = u32::from(file.elements) * u32::from(file.words_per_element.max(1));
            all.push(Mapping { original: first.clone(), words, other: first });
        }
        all.extend(io_words(image).into_iter().map(|address| {
            let text = address.to_string();
            Mapping { original: text.clone(), words: 1, other: text }
        }));
        all
    }
}

/// I/O words of the configuration and those the program names besides.
fn io_words(image: &Image) -> Vec<Address> {
    let mut words = BTreeSet::new();
    for slot in &image.io.slots {
        for (file_type, range) in [(FileType::I, slot.inputs), (FileType::O, slot.outputs)] {
            words.extend((0..range.words).map(|word| (file_type, slot.number, word)));
        }
    }
    for (_, instruction) in crate::instructions(image) {
        for address in instruction.operands.iter().filter_map(ladder::Operand::address) {
            if matches!(address.file_type, FileType::I | FileType::O)
                && let Some(slot) = address.element.number()
            {
                let bit = address.bit.as_ref().and_then(ladder::Place::number).unwrap_or(0);
                words.insert((address.file_type, slot, address.word.unwrap_or(0) + bit / 16));
            }
        }
    }
    let address = |(file_type, slot, word): (FileType, u16, u16)| {
        Some(Address::element(file_type, file_type.implied_file()?, slot).with_word(word))
    };
    words.into_iter().filter_map(address).collect()
}

/// A run of words of the original.
#[derive(Clone, Debug)]
struct Span {
    file_type: FileType,
    /// Words per element.
    size: u32,
    first: Address,
    other: String,
    a: u32,
    b: u32,
    words: u32,
}

/// A word that is compared.
#[derive(Clone, Copy, Debug)]
struct Word {
    a: u32,
    b: u32,
    mask: u16,
    span: u32,
}

/// Words that are compared in one go.
#[derive(Clone, Copy, Debug)]
struct Run {
    a: u32,
    b: u32,
    mask: u16,
    first: usize,
    words: usize,
}

/// A bit that lies apart from its word.
#[derive(Clone, Debug)]
struct Point {
    a: u32,
    b: u32,
    names: (String, String),
}

/// Everything that is compared.
#[derive(Debug)]
pub(crate) struct Pairs {
    spans: Vec<Span>,
    words: Vec<Word>,
    runs: Vec<Run>,
    points: Vec<Point>,
    texts: Vec<(u32, u32, String, String)>,
    outputs: Vec<(u32, u32, u32)>,
    /// Program file, rung and conditions: a stop there that a condition names is no difference.
    pub(crate) conditions: Vec<(u16, u32, Vec<String>)>,
    /// Rungs left to a person, and those whose effect depends on them: what they do in the original is not compared,
    /// a stop included.
    pub(crate) persons: BTreeSet<(u16, u32)>,
    /// Data that is not compared can stop one of the programs.
    pub(crate) stops_unknown: bool,
    /// Addresses the program uses that the map does not place, with why.
    pub(crate) unmapped: Vec<(String, String)>,
    /// Rows of the map that could not be used, with why.
    pub(crate) unusable: Vec<(String, String)>,
}

/// A value that differs.
#[derive(Clone, Debug, PartialEq)]
pub struct Mismatch {
    /// Address of the original.
    pub original: String,
    /// Address of the other program.
    pub other: String,
    /// What it is.
    pub kind: Kind,
    /// Its value in the original, as scenarios write it.
    pub expected: String,
    /// Its value in the other program.
    pub found: String,
}

/// Status words that are compared where the program names them; all others each controller keeps for
/// itself, and they count through what the program does with them.
const STATUS: [u16; 12] = [0, 4, 5, 13, 14, 24, 37, 38, 39, 40, 41, 42];

impl Pairs {
    /// Finds all places. `tainted` are bits of words of the original, by number, that must not be compared.
    pub(crate) fn new<B: Side>(
        image: &Image,
        xref: &CrossReference<'_>,
        a: &Slc,
        b: &B,
        mappings: &[Mapping],
        tainted: &BTreeMap<u32, u16>,
    ) -> Pairs {
        let mut pairs = Pairs {
            spans: Vec::new(),
            words: Vec::new(),
            runs: Vec::new(),
            points: Vec::new(),
            texts: Vec::new(),
            outputs: Vec::new(),
            conditions: Vec::new(),
            persons: BTreeSet::new(),
            stops_unknown: false,
            unmapped: Vec::new(),
            unusable: Vec::new(),
        };
        let named = named_bits(xref, a);
        let mut moved: BTreeMap<u32, u16> = BTreeMap::new();
        for mapping in mappings {
            if let Err(why) = pairs.row(image, a, b, mapping, &mut moved) {
                pairs.unusable.push((mapping.original.clone(), why));
            }
        }
        for (index, span) in pairs.spans.iter().enumerate() {
            for offset in 0..span.words {
                let at = span.a + 16 * offset;
                let apart = moved.get(&(at >> 4)).copied().unwrap_or(0);
                let mut mask = !apart;
                let element = u16::try_from(offset).unwrap_or(u16::MAX);
                let own = span.file_type == FileType::S || span.file_type.is_function_file();
                if own {
                    mask &= named.get(&(at >> 4)).copied().unwrap_or(0);
                    if span.file_type == FileType::S && !STATUS.contains(&element) {
                        mask = 0;
                    }
                }
                mask &= !tainted.get(&(at >> 4)).copied().unwrap_or(0);
                if mask != 0 {
                    pairs.words.push(Word { a: at, b: span.b + 16 * offset, mask, span: index as u32 });
                }
                if span.file_type == FileType::O {
                    pairs.outputs.push((at, span.b + 16 * offset, index as u32));
                }
            }
        }
        let is_tainted = |at: u32| tainted.get(&(at >> 4)).is_some_and(|mask| mask >> (at & 15) & 1 != 0);
        pairs.points.retain(|point| !is_tainted(point.a));
        pairs.texts.retain(|text| tainted.range(text.0 >> 4..(text.0 >> 4) + 42).next().is_none());
        pairs.join();
        pairs.find_unmapped(xref, a);
        pairs
    }

    fn row<B: Side>(
        &mut self,
        image: &Image,
        a: &Slc,
        b: &B,
        mapping: &Mapping,
        moved: &mut BTreeMap<u32, u16>,
    ) -> Result<(), String> {
        let first = Address::parse(&mapping.original).map_err(|error| error.to_string())?;
        let at = a.place(&mapping.original)?;
        let other = b.place(&mapping.other)?;
        if mapping.words == 0 {
            // Rows that only document a bit where its word has it anyway are no points of their own.
            let usual = self.find(at.0).is_some_and(|(span, word, bit)| span.b + 16 * word + u32::from(bit) == other.0);
            if !usual && at.1 == Kind::Bit && other.1 == Kind::Bit {
                *moved.entry(at.0 >> 4).or_default() |= 1 << (at.0 & 15);
                let names = (mapping.original.clone(), mapping.other.clone());
                self.points.push(Point { a: at.0, b: other.0, names });
            }
            return Ok(());
        }
        let size = words_of(image, &first);
        if other.1 == Kind::Text {
            let element = |text: &str, index: u32| advance(text, index);
            for index in 0..mapping.words / size {
                let names = (element(&mapping.original, index), element(&mapping.other, index));
                let (Some(own), Some(other)) = names else { continue };
                let (Ok(x), Ok(y)) = (a.place(&own), b.place(&other)) else { continue };
                self.texts.push((x.0, y.0, own, other));
            }
            return Ok(());
        }
        if other.0 % 8 != 0 {
            return Err(format!("{} does not begin a word", mapping.other));
        }
        self.spans.push(Span {
            file_type: first.file_type,
            size,
            first,
            other: mapping.other.clone(),
            a: at.0,
            b: other.0,
            words: mapping.words,
        });
        Ok(())
    }

    /// Puts words that follow one another on both sides together.
    fn join(&mut self) {
        self.words.sort_by_key(|word| (word.mask, word.a));
        for (index, word) in self.words.iter().enumerate() {
            match self.runs.last_mut() {
                Some(run)
                    if run.mask == word.mask
                        && run.a + 16 * run.words as u32 == word.a
                        && run.b + 16 * run.words as u32 == word.b =>
                {
                    run.words += 1;
                }
                _ => self.runs.push(Run { a: word.a, b: word.b, mask: word.mask, first: index, words: 1 }),
            }
        }
    }

    fn find_unmapped(&mut self, xref: &CrossReference<'_>, a: &Slc) {
        let mut unmapped = BTreeMap::new();
        for address in xref.named().into_iter().filter(|address| address.is_direct()) {
            let text = address.to_string();
            match a.place(&text) {
                Err(why) => drop(unmapped.insert(text, why)),
                Ok((at, _)) => {
                    let known = self.find(at).is_some()
                        || self.points.iter().any(|point| point.a == at)
                        || self.texts.iter().any(|row| (row.0..row.0 + 42 * 16).contains(&at));
                    // Status and clock exist on both sides as the system's own.
                    if !known && address.file_type != FileType::S && !address.file_type.is_function_file() {
                        unmapped.insert(text, "the map has no row for it".to_owned());
                    }
                }
            }
        }
        self.unmapped = unmapped.into_iter().collect();
    }

    /// The span, word and bit of a place of the original.
    fn find(&self, at: u32) -> Option<(&Span, u32, u16)> {
        let span = self.spans.iter().find(|span| (span.a..span.a + 16 * span.words).contains(&at))?;
        Some((span, (at - span.a) / 16, (at & 15) as u16))
    }

    /// A stated condition says that the original stops with this fault where it is not kept, or the rung is
    /// left to a person anyway.
    pub(crate) fn is_stated(&self, fault: sim::MajorFault) -> bool {
        let code = format!("fault {:04X}", fault.code);
        let (file, rung) = fault.place();
        let here = |row: &&(u16, u32, Vec<String>)| (row.0, row.1) == (file, u32::from(rung));
        let mut conditions = self.conditions.iter().filter(here).flat_map(|row| &row.2);
        self.persons.contains(&(file, u32::from(rung)))
            || conditions.any(|condition| {
                // An index that leads nowhere stops the rung at once.
                condition.contains(&code) || condition.starts_with("INDIRECT") && fault.code != MINOR_ERROR
            })
    }

    /// How the other side spells a place of the original.
    pub(crate) fn other(&self, at: u32, kind: Kind) -> Option<String> {
        if let Some(point) = self.points.iter().find(|point| point.a == at && kind == Kind::Bit) {
            return Some(point.names.1.clone());
        }
        let (span, word, bit) = self.find(at)?;
        spell(span, false, word, (kind == Kind::Bit).then_some(bit), kind)
    }

    /// How the original spells a place of the other side.
    pub(crate) fn original(&self, at: u32, kind: Kind) -> Option<String> {
        if let Some(point) = self.points.iter().find(|point| point.b == at && kind == Kind::Bit) {
            return Some(point.names.0.clone());
        }
        if kind == Kind::Text {
            return self.texts.iter().find(|text| text.1 == at).map(|text| text.2.clone());
        }
        let span = self.spans.iter().find(|span| (span.b..span.b + 16 * span.words).contains(&at))?;
        let bit = (kind == Kind::Bit).then_some((at & 15) as u16);
        spell(span, true, (at - span.b) / 16, bit, kind)
    }

    /// Where the other side holds what is compared of a place of the original: its first bit there. `None`: it has no
    /// place there.
    pub(crate) fn beside(&self, at: u32, kind: Kind) -> Option<u32> {
        if let Some(point) = self.points.iter().find(|point| point.a == at && kind == Kind::Bit) {
            return Some(point.b);
        }
        if kind == Kind::Text {
            return self.texts.iter().find(|text| text.0 == at).map(|text| text.1);
        }
        let (span, word, bit) = self.find(at)?;
        Some(span.b + 16 * word + u32::from(bit))
    }

    /// How the other side spells a string of the original.
    pub(crate) fn other_text(&self, at: u32) -> Option<String> {
        self.texts.iter().find(|text| text.0 == at).map(|text| text.3.clone())
    }

    /// Which bits of each word of the original are compared, by the number of the word.
    pub(crate) fn masks(&self) -> BTreeMap<u32, u16> {
        let mut masks: BTreeMap<u32, u16> = BTreeMap::new();
        let words = self.words.iter().map(|word| (word.a >> 4, word.mask));
        let points = self.points.iter().map(|point| (point.a >> 4, 1 << (point.a & 15)));
        let texts = self.texts.iter().flat_map(|text| (0..42).map(|word| ((text.0 >> 4) + word, u16::MAX)));
        for (word, mask) in words.chain(points).chain(texts) {
            *masks.entry(word).or_default() |= mask;
        }
        masks
    }

    /// How the other side spells a field of the clock of the original.
    pub(crate) fn clock(&self, field: &str, original: &str) -> Option<String> {
        let slc = self.spans.iter().any(|span| span.other.contains(':'));
        Some(if slc { original.to_owned() } else { format!("SDT0.{field}") })
    }

    /// Words compared after every scan.
    pub(crate) fn compared(&self) -> usize {
        self.words.len() + self.points.len() + self.texts.len()
    }

    /// Where the other side holds what is compared: first bits, and which of 16.
    pub(crate) fn places(&self) -> Vec<(u32, u16)> {
        let words = self.words.iter().map(|word| (word.b, word.mask));
        let points = self.points.iter().map(|point| (point.b, 1));
        // Length and characters of strings.
        let texts = self.texts.iter().flat_map(|text| (0..43).map(|word| (text.1 + 16 * word, u16::MAX)));
        words.chain(points).chain(texts).collect()
    }

    /// The first difference after a scan both sides executed.
    pub(crate) fn difference<B: Side>(&self, a: &Slc, b: &B, buffers: &mut [Vec<u8>; 2]) -> Option<Mismatch> {
        let data = a.machine.data();
        for run in &self.runs {
            let first = (run.a >> 4) as usize;
            let words = data.get(first..first + run.words).unwrap_or_default();
            if !b.holds(run.b, words, run.mask)
                && let Some(found) = self.in_run(run, a, b)
            {
                return Some(found);
            }
        }
        for point in &self.points {
            let (x, y) = (a.bit(point.a), b.bit(point.b));
            if x != y {
                let (original, other) = point.names.clone();
                let [expected, found] = [x, y].map(|on| literal(Kind::Bit, on.into()));
                return Some(Mismatch { original, other, kind: Kind::Bit, expected, found });
            }
        }
        let [left, right] = buffers;
        for (x, y, original, other) in &self.texts {
            left.clear();
            right.clear();
            a.text(*x, left);
            b.text(*y, right);
            if left != right {
                let (original, other) = (original.clone(), other.clone());
                let [expected, found] = [left, right].map(|text| quoted(text));
                return Some(Mismatch { original, other, kind: Kind::Text, expected, found });
            }
        }
        None
    }

    /// The first difference in data a stop left; outputs are off then, whatever their words hold.
    pub(crate) fn left<B: Side>(&self, a: &Slc, b: &B) -> Option<Mismatch> {
        self.words.iter().find_map(|word| {
            let span = self.spans.get(word.span as usize).filter(|span| span.file_type != FileType::O)?;
            let differs = (a.word(word.a) ^ b.word(word.b)) & word.mask;
            (differs != 0).then(|| mismatch(span, word, differs, a, b)).flatten()
        })
    }

    fn in_run<B: Side>(&self, run: &Run, a: &Slc, b: &B) -> Option<Mismatch> {
        let words = self.words.get(run.first..run.first + run.words)?;
        words.iter().find_map(|word| {
            let (x, y) = (a.word(word.a), b.word(word.b));
            let differs = (x ^ y) & word.mask;
            let span = self.spans.get(word.span as usize)?;
            (differs != 0).then(|| mismatch(span, word, differs, a, b)).flatten()
        })
    }

    /// The first output terminal that is on although it must be off.
    pub(crate) fn output_on<B: Side>(&self, b: &B) -> Option<Mismatch> {
        self.outputs.iter().find_map(|(at, other, span)| {
            let carries = b.terminals(*other);
            let span = self.spans.get(*span as usize)?;
            if carries == 0 {
                return None;
            }
            let bit = Some(carries.trailing_zeros() as u16);
            let word = (at - span.a) / 16;
            Some(Mismatch {
                original: spell(span, true, word, bit, Kind::Bit)?,
                other: spell(span, false, word, bit, Kind::Bit)?,
                kind: Kind::Bit,
                expected: "0".to_owned(),
                found: "1".to_owned(),
            })
        })
    }

    /// Words of inputs: places of the original and names on both sides.
    pub(crate) fn input_words(&self) -> impl Iterator<Item = (u32, String, String)> {
        self.spans.iter().filter(|span| span.file_type == FileType::I).flat_map(|span| {
            (0..span.words).filter_map(|word| {
                let names = [true, false].map(|own| spell(span, own, word, None, Kind::Word));
                let [Some(own), Some(other)] = names else { return None };
                Some((span.a + 16 * word, own, other))
            })
        })
    }
}

/// Words of an element of the file an address lies in, at least 1.
fn words_of(image: &Image, address: &Address) -> u32 {
    if address.file_type.has_slots() {
        return 1;
    }
    let file = image.data_file(address.file_type, address.file.number().unwrap_or(0));
    let file = file.or_else(|| image.function_files.iter().find(|file| file.file_type == address.file_type));
    let words = file.map_or_else(|| address.file_type.words_per_element().unwrap_or(1), |file| file.words_per_element);
    u32::from(words.max(1))
}

/// As `words_of`, of an address as text.
pub(crate) fn words_per_element(image: &Image, address: &str) -> u32 {
    Address::parse(address).map_or(1, |address| words_of(image, &address))
}

fn mismatch<B: Side>(span: &Span, word: &Word, differs: u16, a: &Slc, b: &B) -> Option<Mismatch> {
    let offset = (word.a - span.a) / 16;
    let long = |low: u16, high: u16| u32::from(low) | u32::from(high) << 16;
    let sub = offset % span.size;
    let bits = matches!(span.file_type, FileType::B | FileType::I | FileType::O | FileType::S)
        || matches!(span.file_type, FileType::T | FileType::C | FileType::R) && sub == 0;
    let kind = match span.file_type {
        FileType::F => Kind::Float,
        FileType::L => Kind::Long,
        // Words of single bits that differ in many of them are numbers.
        _ if bits && (differs.count_ones() <= 4 || span.size > 1) => Kind::Bit,
        _ => Kind::Word,
    };
    let bit = differs.trailing_zeros() as u16;
    let first = 32 * (offset / 2);
    let (expected, found) = match kind {
        Kind::Float | Kind::Long => (
            long(a.word(span.a + first), a.word(span.a + first + 16)),
            long(b.word(span.b + first), b.word(span.b + first + 16)),
        ),
        Kind::Bit => (u32::from(a.word(word.a) >> bit) & 1, u32::from(b.word(word.b) >> bit) & 1),
        _ => (u32::from(a.word(word.a)), u32::from(b.word(word.b))),
    };
    if kind == Kind::Float && f32::from_bits(expected).is_nan() && f32::from_bits(found).is_nan() {
        return None;
    }
    let bit = (kind == Kind::Bit).then_some(bit);
    let [original, other] = [true, false].map(|own| spell(span, own, offset, bit, kind));
    let [expected, found] = [expected, found].map(|value| literal(kind, value));
    Some(Mismatch { original: original?, other: other?, kind, expected, found })
}

/// A value as scenarios write it.
pub(crate) fn literal(kind: Kind, value: u32) -> String {
    match kind {
        Kind::Bit => u8::from(value != 0).to_string(),
        Kind::Word => (value as u16 as i16).to_string(),
        Kind::Long => (value as i32).to_string(),
        Kind::Float => format!("{:?}", f32::from_bits(value)),
        Kind::Text => "\"\"".to_owned(),
    }
}

/// Characters as a string of TOML.
fn quoted(text: &[u8]) -> String {
    let escaped = text.iter().map(|byte| match byte {
        b'"' => "\\\"".to_owned(),
        b'\\' => "\\\\".to_owned(),
        b' '..=b'~' => char::from(*byte).to_string(),
        other => format!("\\u{:04X}", other),
    });
    format!("\"{}\"", escaped.collect::<String>())
}

/// Bits per word of the original that operands of the program name.
fn named_bits(xref: &CrossReference<'_>, a: &Slc) -> BTreeMap<u32, u16> {
    let mut named: BTreeMap<u32, u16> = BTreeMap::new();
    for address in xref.named() {
        let Ok((at, kind)) = a.place(&address.to_string()) else { continue };
        let mask = if kind == Kind::Bit { 1 << (at & 15) } else { u16::MAX };
        *named.entry(at >> 4).or_default() |= mask;
    }
    named
}

/// The element `index` behind the one a text names: `ST9:0` and 2 give `ST9:2`, `SL4` and 1 give `SL5`.
pub(crate) fn advance(text: &str, index: u32) -> Option<String> {
    let digits = text.bytes().rev().take_while(u8::is_ascii_digit).count();
    let (head, number) = text.split_at(text.len() - digits);
    let number = number.parse::<u32>().ok()?.checked_add(index)?;
    Some(format!("{head}{number}"))
}

/// The address of a word or bit of a span on one of the sides.
fn spell(span: &Span, own: bool, word: u32, bit: Option<u16>, kind: Kind) -> Option<String> {
    match own {
        true => spell_slc(&span.first, span.size, word, bit),
        false => match Address::parse(&span.other) {
            Ok(first) if span.other.contains(':') => spell_slc(&first, span.size, word, bit),
            _ => spell_domore(&span.other, word, bit, kind),
        },
    }
}

fn spell_slc(first: &Address, size: u32, word: u32, bit: Option<u16>) -> Option<String> {
    let sub = u32::from(first.word.unwrap_or(0));
    let mut address = first.clone();
    if first.file_type.has_slots() {
        address.word = Some(u16::try_from(sub + word).ok()?);
    } else {
        let element = first.element.number()?;
        address.element = ladder::Place::Number(u16::try_from(u32::from(element) + word / size).ok()?);
        let long = matches!(first.file_type, FileType::F | FileType::L);
        address.word = (size > 1 && !long).then(|| u16::try_from(word % size).unwrap_or(0));
        if long && bit.is_some() {
            return Some(address.with_bit(bit? + 16 * (word % 2) as u16).to_string());
        }
    }
    Some(match bit {
        // The flags of a structure are named without their word: `T4:0/DN`.
        Some(bit) if address.word == Some(0) && size > 1 => {
            address.word = None;
            address.with_bit(bit).to_string()
        }
        Some(bit) => address.with_bit(bit).to_string(),
        None => address.to_string(),
    })
}

pub(crate) fn spell_domore(first: &str, word: u32, bit: Option<u16>, kind: Kind) -> Option<String> {
    let digits = first.bytes().rev().take_while(u8::is_ascii_digit).count();
    let (block, number) = first.split_at(first.len() - digits);
    let number: u32 = number.parse().ok()?;
    let bits = matches!(block.to_ascii_uppercase().as_str(), "X" | "Y" | "C" | "DLX" | "DLY" | "DLC" | "MI" | "MC");
    let long = matches!(block.to_ascii_uppercase().as_str(), "D" | "R");
    Some(match (bit, kind) {
        (Some(bit), _) if bits => format!("{block}{}", number + 16 * word + u32::from(bit)),
        (Some(bit), _) if long => format!("{block}{}:{}", number + word / 2, word % 2 * 16 + u32::from(bit)),
        (Some(bit), _) => format!("{block}{}:{bit}", number + word),
        (None, _) if bits => format!("{block}{}:SW", number + 16 * word),
        (None, Kind::Word) if long => format!("{block}{}:W{}", number + word / 2, word % 2),
        (None, _) if long => format!("{block}{}", number + word / 2),
        (None, _) => format!("{block}{}", number + word),
    })
}
