//! The address map as CSV: what the migration wrote, and what a person made of it.
//!
//! ```csv
//! slc,last,words,domore,name,description
//! I:1.0,I:1.0,1,X0,,
//! I:1.0/3,,,X40,START,panel A
//! N7:0,N7:99,100,N0,,
//! ```
//!
//! A row tells where the word of the first column lies (`domore`), and how many words follow it there.
//! To move data, change `domore`. A row for a single point of I or O moves that point. Rows whose `slc`
//! begins with `helper` only inform.

use std::fmt;

use ladder::{Address, Image, Target};

use super::allocate::{Block, Element, Places, Span};
use super::context::Context;

/// A row of the map.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MapRow {
    /// First word of the original (`N7:0`, `I:1.0`, `T4:0`), a point of I or O, or `helper`.
    pub slc: String,
    /// Last word, for reading.
    pub last: String,
    /// Number of words; 0 for a point and for helpers.
    pub words: u32,
    /// The element of the result the first one lies in.
    pub domore: String,
    /// Symbol or nickname, for reading.
    pub name: String,
    /// Description, for reading.
    pub description: String,
}

/// Why a map does not fit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MapError {
    /// Row of the file, from 1, the line of names not counted; 0 for the map as a whole.
    pub row: usize,
    /// What is wrong.
    pub what: String,
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.row {
            0 => write!(f, "address map: {}", self.what),
            row => write!(f, "address map, row {row}: {}", self.what),
        }
    }
}

impl std::error::Error for MapError {}

const HEADER: [&str; 6] = ["slc", "last", "words", "domore", "name", "description"];

/// Most rows that are read.
const MOST_ROWS: usize = 200_000;

/// Reads a map.
///
/// # Errors
/// The first row that is none.
pub fn read(text: &str) -> Result<Vec<MapRow>, MapError> {
    let mut reader = csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(text.as_bytes());
    let headers = reader.headers().map_err(|error| MapError { row: 0, what: error.to_string() })?.clone();
    let column = |name: &str| headers.iter().position(|header| header.trim_start_matches('\u{feff}') == name);
    let (Some(slc), Some(domore)) = (column("slc"), column("domore")) else {
        return Err(MapError { row: 0, what: "expected columns named slc and domore in the first line".to_owned() });
    };
    let [last, words, name, description] = ["last", "words", "name", "description"].map(column);
    let mut rows = Vec::new();
    for (index, record) in reader.records().enumerate() {
        let row = index + 1;
        if row > MOST_ROWS {
            return Err(MapError { row, what: format!("more than {MOST_ROWS} rows") });
        }
        let record = record.map_err(|error| MapError { row, what: error.to_string() })?;
        let get = |column: Option<usize>| column.and_then(|at| record.get(at)).unwrap_or("").to_owned();
        let count = get(words);
        let words = match count.as_str() {
            "" => 0,
            number => number
                .parse()
                .map_err(|_| MapError { row, what: format!("expected a number of words, found `{number}`") })?,
        };
        rows.push(MapRow {
            slc: get(Some(slc)),
            last: get(last),
            words,
            domore: get(Some(domore)),
            name: get(name),
            description: get(description),
        });
    }
    Ok(rows)
}

/// Writes a map, lines ending in CR LF.
pub fn write(rows: &[MapRow]) -> String {
    let mut writer = csv::WriterBuilder::new().terminator(csv::Terminator::CRLF).from_writer(Vec::new());
    let lines = rows.iter().map(|row| {
        let words = if row.words == 0 { String::new() } else { row.words.to_string() };
        [&row.slc, &row.last, &words, &row.domore, &row.name, &row.description].map(String::from)
    });
    let header = HEADER.map(str::to_owned);
    // Writing to memory does not fail.
    for line in std::iter::once(header).chain(lines) {
        let _ = writer.write_record(line);
    }
    writer.into_inner().ok().and_then(|bytes| String::from_utf8(bytes).ok()).unwrap_or_default()
}

/// Moves spans and points to where a person put them.
///
/// # Errors
/// A row that names nothing of the program, a block that cannot hold it, or places that overlap.
pub(super) fn apply(places: &mut Places, rows: &[MapRow]) -> Result<(), MapError> {
    if rows.is_empty() {
        return Ok(());
    }
    let mut pinned = vec![false; places.spans().len()];
    let mut moved: Vec<(usize, Element)> = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let wrong = |what: String| MapError { row: index + 1, what };
        if row.slc.is_empty() || row.slc.starts_with("helper") {
            continue;
        }
        let address = Address::parse(&row.slc).map_err(|error| wrong(format!("`{}` is {error}", row.slc)))?;
        let element = element(&row.domore)
            .ok_or_else(|| wrong(format!("expected an element such as X0, C16 or N100, found `{}`", row.domore)))?;
        let key = places.word_of(&address).ok_or_else(|| wrong(format!("{} is not in the program", row.slc)))?;
        if let Some(bit) = address.bit.as_ref().and_then(ladder::Place::number) {
            let bits = if address.file_type == ladder::FileType::I { Block::X } else { Block::Y };
            if !address.file_type.has_slots() {
                return Err(wrong(format!("{}: single bits can be moved in I and O only", row.slc)));
            }
            if element.block != bits && element.block != Block::C {
                return Err(wrong(format!("{} cannot lie in {}", row.slc, row.domore)));
            }
            if places.span(key.0, key.1, key.2).is_none() {
                return Err(wrong(format!("{} is not in the program", row.slc)));
            }
            // A point where its word has it anyway is none of its own.
            let usual = places.bit(key.0, key.1, key.2, bit % 16);
            if usual.as_deref() != Some(row.domore.as_str()) {
                places.set_point((key.0, key.1, key.2, bit % 16), element);
            }
            continue;
        }
        let span = places
            .spans()
            .iter()
            .position(|span| (span.file_type, span.file, span.first_word) == (key.0, key.1, key.2));
        let Some(span) = span else {
            return Err(wrong(format!("{} does not begin a run of words of the program", row.slc)));
        };
        if let Some(found) = places.spans().get(span)
            && !fits(found, element.block)
        {
            return Err(wrong(format!("{} cannot lie in {}", row.slc, row.domore)));
        }
        if element.block.is_bits() && element.number % 16 != 0 {
            return Err(wrong(format!("{}: words of bits begin at a multiple of 16", row.domore)));
        }
        if let Some(pinned) = pinned.get_mut(span) {
            *pinned = true;
        }
        moved.push((span, element));
    }
    for (span, element) in moved {
        if let Some(span) = places.spans_mut().get_mut(span) {
            span.at = element;
        }
    }
    settle(places, &pinned)
}

/// Words of this span can lie in that block.
fn fits(span: &Span, block: Block) -> bool {
    match span.at.block {
        Block::X | Block::Wx => matches!(block, Block::X | Block::Wx | Block::C | Block::N),
        Block::Y | Block::Wy => matches!(block, Block::Y | Block::Wy | Block::C | Block::N),
        same => same == block,
    }
}

/// Puts what nobody placed behind everything else, and refuses overlaps.
fn settle(places: &mut Places, pinned: &[bool]) -> Result<(), MapError> {
    let mut next: std::collections::BTreeMap<Block, u32> = std::collections::BTreeMap::new();
    for (span, _) in places.spans().iter().zip(pinned).filter(|(_, pinned)| **pinned) {
        let end = next.entry(span.at.block).or_default();
        *end = (*end).max(span.at.number.saturating_add(span.elements()));
    }
    for (_, element) in places.points().collect::<Vec<_>>() {
        let end = next.entry(element.block).or_default();
        *end = (*end).max(element.number.saturating_add(1));
    }
    for (span, pinned) in places.spans_mut().iter_mut().zip(pinned) {
        if !pinned {
            let end = next.entry(span.at.block).or_default();
            if span.at.block.is_bits() {
                *end = end.next_multiple_of(16);
            }
            span.at.number = *end;
            *end = end.saturating_add(span.elements());
        }
    }
    for (block, end) in next {
        places.set_next(block, end);
    }
    let mut ranges: Vec<(Block, u32, u32, String)> = places
        .spans()
        .iter()
        .map(|span| {
            let name = span.address(0).map(|address| address.to_string()).unwrap_or_default();
            (span.at.block, span.at.number, span.at.number.saturating_add(span.elements()), name)
        })
        .collect();
    ranges.sort();
    for pair in ranges.windows(2) {
        if let [a, b] = pair
            && a.0 == b.0
            && b.1 < a.2
        {
            let what = format!("{} and {} overlap at {}{}", a.3, b.3, a.0.name(), b.1);
            return Err(MapError { row: 0, what });
        }
    }
    let mut taken: std::collections::BTreeMap<String, String> = std::collections::BTreeMap::new();
    let moved: Vec<Element> = places.points().map(|(_, element)| element).collect();
    if moved.is_empty() {
        return Ok(());
    }
    for span in places.spans().iter().filter(|span| span.at.block.is_bits()) {
        for (word, bit) in (0..span.words).flat_map(|word| (0..16).map(move |bit| (word, bit))) {
            let Some(place) = places.bit(span.file_type, span.file, span.first_word + word, bit) else { continue };
            let Some(address) = span.address(word) else { continue };
            let name = address.with_bit(bit).to_string();
            if let Some(other) = taken.insert(place.clone(), name.clone()) {
                return Err(MapError { row: 0, what: format!("{other} and {name} are both {place}") });
            }
        }
    }
    Ok(())
}

/// `X0`, `N100`.
fn element(text: &str) -> Option<Element> {
    let digits = text.bytes().rev().take_while(u8::is_ascii_digit).count();
    let (block, number) = text.split_at(text.len() - digits);
    Some(Element { block: Block::by_name(block)?, number: number.parse().ok()? })
}

/// The rows of a migration.
pub(super) fn rows(image: &Image, context: &Context<'_>) -> Vec<MapRow> {
    let mut rows = Vec::new();
    let documentation = |address: &Address| {
        let shown = image.documentation.shown(&Target::Address(address.clone()), "");
        (shown.symbol.unwrap_or_default(), shown.description.join(" "))
    };
    for span in context.places.spans() {
        let Some(first) = span.address(0) else { continue };
        let last = span.address(span.words.saturating_sub(1)).unwrap_or_else(|| first.clone());
        let (name, description) = match span.file_type.has_slots() {
            true => (String::new(), String::new()),
            false => image
                .data_file(span.file_type, span.file)
                .map_or_else(Default::default, |file| (file.name.clone(), file.description.clone())),
        };
        rows.push(MapRow {
            slc: plain(&first, span.size),
            last: plain(&last, span.size),
            words: span.words,
            domore: span.at.to_string(),
            name,
            description,
        });
        if matches!(span.at.block, Block::X | Block::Y) {
            for bit in 0..16 {
                let address = first.clone().with_bit(bit);
                let (name, description) = documentation(&address);
                let place = context.places.bit(span.file_type, span.file, span.first_word, bit);
                let own =
                    context.places.points().any(|(key, _)| key == (span.file_type, span.file, span.first_word, bit));
                if !own && name.is_empty() && description.is_empty() {
                    continue;
                }
                rows.push(MapRow {
                    slc: address.to_string(),
                    domore: place.unwrap_or_default(),
                    name,
                    description,
                    ..MapRow::default()
                });
            }
        }
    }
    for (element, helper) in &context.helpers {
        rows.push(MapRow {
            slc: "helper".to_owned(),
            domore: element.to_string(),
            name: helper.nickname.clone(),
            description: helper.text.clone(),
            ..MapRow::default()
        });
    }
    rows
}

/// The element of a word of a structure.
fn plain(address: &Address, size: u32) -> String {
    if size > 1 && !address.file_type.has_slots() {
        return Address { word: None, ..address.clone() }.to_string();
    }
    address.to_string()
}
