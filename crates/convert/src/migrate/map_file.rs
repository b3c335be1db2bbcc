//! The address map as CSV: what the migration wrote, and what a person made of it.
//!
//! ```csv
//! slc,last,words,domore,name,description
//! I:1.0,I:1.0,1,X0,,
//! I:1.0/3,,,X40,START,panel A
//! N7:0,N7:99,100,N0,,
//! N7:5,,,N5,SPEED,set by the panel
//! ```
//!
//! A row with `words` tells where the word of the first column lies (`domore`), and how many words follow it there.
//! To move data, change `domore`. A row without gives an address its nickname and description, and moves a
//! single point of I or O. Rows whose `slc` begins with `helper` only inform.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use ladder::{Address, Image};

use super::allocate::{Block, Element, Places, Span};
use super::context::Context;
use super::docs::Documented;

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

impl MapRow {
    /// Whether it says where data of the original lies. Helpers have no counterpart there, and rows of single
    /// addresses only tell nicknames, but for points of I and O and for bits that another SLC program has elsewhere.
    pub fn places_data(&self) -> bool {
        let point = self.slc.contains('/') && (self.slc.starts_with(['I', 'O']) || self.domore.contains('/'));
        !self.slc.starts_with("helper") && !self.slc.is_empty() && (self.words > 0 || point)
    }
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

/// The nickname and description a person wants for an address.
#[derive(Clone, Debug)]
pub(super) struct Wish {
    /// Row of the map, from 1.
    pub(super) row: usize,
    /// `None` for a row of a helper.
    pub(super) address: Option<Address>,
    /// The element of the row.
    pub(super) domore: String,
    /// The nickname; blank for the one made from the symbol, `-` for none.
    pub(super) name: String,
    /// The description; blank for the original's, `-` for none.
    pub(super) description: String,
}

/// What stands for nothing where a blank stands for what the original has.
pub(super) const NOTHING: &str = "-";

/// Moves spans and points to where a person put them; what they are to be called.
///
/// # Errors
/// A row that names nothing of the program, a block that cannot hold it, or places that overlap.
pub(super) fn apply(image: &Image, places: &mut Places, rows: &[MapRow]) -> Result<Vec<Wish>, MapError> {
    if rows.is_empty() {
        return Ok(Vec::new());
    }
    let before = places.clone();
    let beginning = |address: &Address| {
        let key = before.word_of(address).filter(|_| address.bit.is_none())?;
        before.spans().iter().position(|span| (span.file_type, span.file, span.first_word) == key)
    };
    let runs = rows.iter().filter(|row| row.words > 0).filter_map(|row| Address::parse(&row.slc).ok());
    let told: BTreeSet<usize> = runs.filter_map(|address| beginning(&address)).collect();
    // The row that placed each span.
    let mut pinned: Vec<Option<usize>> = vec![None; places.spans().len()];
    let (mut named, mut wishes) = (Vec::new(), Vec::new());
    for (index, row) in rows.iter().enumerate() {
        let wrong = |what: String| MapError { row: index + 1, what };
        if row.slc.is_empty() {
            continue;
        }
        if row.slc.starts_with("helper") {
            let (domore, name) = (row.domore.clone(), row.name.clone());
            wishes.push(Wish { row: index + 1, address: None, domore, name, description: String::new() });
            continue;
        }
        let address = Address::parse(&row.slc).map_err(|error| wrong(format!("`{}` is {error}", row.slc)))?;
        let key = places.word_of(&address).ok_or_else(|| wrong(format!("{} is not in the program", row.slc)))?;
        // A row of one address tells where its words are only if no other row does, and if it moves them.
        let unmoved = || super::docs::operand(&before, &address).is_some_and(|known| known == row.domore);
        let span = beginning(&address).filter(|span| row.words > 0 || !told.contains(span) && !unmoved());
        let Some(span) = span else {
            if row.words > 0 {
                return Err(wrong(format!("{} does not begin a run of words of the program", row.slc)));
            }
            named.push((index + 1, address, key));
            continue;
        };
        let at = parsed(row).map_err(wrong)?;
        let found = places.spans_mut().get_mut(span).filter(|found| fits(found, at.block));
        let found = found.ok_or_else(|| wrong(format!("{} cannot lie in {}", row.slc, row.domore)))?;
        if at.block.is_bits() && at.number % 16 != 0 {
            return Err(wrong(format!("{}: words of bits begin at a multiple of 16", row.domore)));
        }
        if pinned.get(span).is_some_and(Option::is_some) {
            return Err(wrong(format!("{} is placed by another row before", row.slc)));
        }
        found.at = at;
        if let Some(pinned) = pinned.get_mut(span) {
            *pinned = Some(index + 1);
        }
        let (name, description) = of_file(image, key.0, key.1);
        let edited = |text: &str, own: &str| !text.is_empty() && text != own.trim();
        if row.words > 0 && (edited(&row.name, &name) || edited(&row.description, &description)) {
            let first = row.slc.as_str();
            return Err(wrong(format!(
                "{first}: name and description of a run of words are those of its data file, `{name}`, for reading; \
                 a nickname goes into a row of its address alone, `{first},,,{},NICKNAME,`",
                row.domore
            )));
        }
        if row.words == 0 {
            named.push((index + 1, address, key));
        }
    }
    for (row_number, address, key) in named {
        let Some(row) = rows.get(row_number - 1) else { continue };
        let wrong = |what: String| MapError { row: row_number, what };
        let bit = address.bit.as_ref().and_then(ladder::Place::number);
        // Where its word goes it goes, unless its own row says otherwise.
        let known = [&before, &*places].map(|places| super::docs::operand(places, &address));
        let stays = row.domore.is_empty() || known.iter().flatten().any(|known| *known == row.domore);
        if let (false, Some(bit)) = (stays, bit) {
            let element = parsed(row).map_err(wrong)?;
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
            places.set_point((key.0, key.1, key.2, bit % 16), element);
        } else if !stays {
            return Err(wrong(format!("{} does not begin a run of words of the program", row.slc)));
        }
        let MapRow { domore, name, description, .. } = row.clone();
        wishes.push(Wish { row: row_number, address: Some(address), domore, name, description });
    }
    settle(places, &pinned)?;
    Ok(wishes)
}

/// The element a row gives.
fn parsed(row: &MapRow) -> Result<Element, String> {
    element(&row.domore).ok_or_else(|| format!("expected an element such as X0, C16 or N100, found `{}`", row.domore))
}

/// Name and description of a data file; I and O have none of their own.
fn of_file(image: &Image, file_type: ladder::FileType, file: u16) -> (String, String) {
    match file_type.has_slots() {
        true => Default::default(),
        false => image
            .data_file(file_type, file)
            .map_or_else(Default::default, |file| (file.name.clone(), file.description.clone())),
    }
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
fn settle(places: &mut Places, pinned: &[Option<usize>]) -> Result<(), MapError> {
    let mut next: BTreeMap<Block, u32> = BTreeMap::new();
    for (span, _) in places.spans().iter().zip(pinned).filter(|(_, pinned)| pinned.is_some()) {
        let end = next.entry(span.at.block).or_default();
        *end = (*end).max(span.at.number.saturating_add(span.elements()));
    }
    for (_, element) in places.points().collect::<Vec<_>>() {
        let end = next.entry(element.block).or_default();
        *end = (*end).max(element.number.saturating_add(1));
    }
    for (span, pinned) in places.spans_mut().iter_mut().zip(pinned) {
        if pinned.is_none() {
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
    let mut ranges: Vec<(Block, u32, u32, String, Option<usize>)> = places
        .spans()
        .iter()
        .zip(pinned)
        .map(|(span, row)| {
            let name = span.address(0).map(|address| address.to_string()).unwrap_or_default();
            (span.at.block, span.at.number, span.at.number.saturating_add(span.elements()), name, *row)
        })
        .collect();
    ranges.sort();
    for pair in ranges.windows(2) {
        if let [a, b] = pair
            && a.0 == b.0
            && b.1 < a.2
        {
            let what = format!("{} and {} overlap at {}{}", a.3, b.3, a.0.name(), b.1);
            return Err(MapError { row: b.4.or(a.4).unwrap_or(0), what });
        }
    }
    let mut taken: BTreeMap<String, String> = BTreeMap::new();
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

/// The rows of a migration: of each span, and behind it of what it documents.
pub(super) fn rows(image: &Image, context: &Context<'_>, documented: &[Documented]) -> Vec<MapRow> {
    let mut rows = Vec::new();
    let mut within: BTreeMap<_, Vec<(u32, u16, &Documented)>> = BTreeMap::new();
    for row in documented {
        let key = row.address.as_ref().and_then(|address| context.places.word_of(address));
        let span = key.and_then(|key| context.places.span(key.0, key.1, key.2));
        if let (Some(address), Some(key), Some(span)) = (&row.address, key, span) {
            // Bits behind their word.
            let bit = address.bit.as_ref().and_then(ladder::Place::number).map_or(0, |bit| bit % 16 + 1);
            let own = key.2.checked_sub(span.first_word).is_some_and(|offset| offset < span.own);
            if own {
                within.entry((span.file_type, span.file, span.first_word)).or_default().push((key.2, bit, row));
            }
        }
    }
    for span in context.places.spans() {
        let Some(first) = span.address(0) else { continue };
        let last = span.address(span.words.saturating_sub(1)).unwrap_or_else(|| first.clone());
        let (name, description) = of_file(image, span.file_type, span.file);
        rows.push(MapRow {
            slc: plain(&first, span.size),
            last: plain(&last, span.size),
            words: span.words,
            domore: span.at.to_string(),
            name,
            description,
        });
        let mut found = within.remove(&(span.file_type, span.file, span.first_word)).unwrap_or_default();
        found.sort_by_key(|(word, bit, _)| (*word, *bit));
        let apart = context.places.points().filter(|(key, _)| {
            let known = |row: &(u32, u16, &Documented)| (row.0, row.1) == (key.2, key.3 + 1);
            (key.0, key.1, key.2) == (span.file_type, span.file, span.first_word) && !found.iter().any(known)
        });
        for (key, element) in apart {
            let address = first.clone().with_bit(key.3);
            rows.push(MapRow { slc: address.to_string(), domore: element.to_string(), ..MapRow::default() });
        }
        rows.extend(found.into_iter().map(|(_, _, row)| MapRow {
            slc: row.address.as_ref().map_or_else(String::new, Address::to_string),
            domore: row.element.clone(),
            name: row.nickname_in_map(),
            description: row.description_in_map(),
            ..MapRow::default()
        }));
    }
    for helper in documented.iter().filter(|row| row.address.is_none()) {
        rows.push(MapRow {
            slc: "helper".to_owned(),
            domore: helper.element.clone(),
            name: helper.nickname_in_map(),
            description: helper.description_in_map(),
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
