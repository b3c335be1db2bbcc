//! Rows of a map that cannot mean anything, found before a run.

use ladder::{Address, Image};

use super::Options;
use super::pairs::{Mapping, advance, spell_domore, words_per_element};
use super::side::{DoMore, Kind, Side, Slc};

/// A row of a map that cannot mean anything.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Refused {
    /// Its index in the map.
    pub row: usize,
    /// The index of the row it contradicts.
    pub with: Option<usize>,
    /// Why.
    pub why: String,
}

/// Rows of a map to a Do-more program that name no data of one of the sides, or place the same data or at the same
/// place as another one. Empty too where a program cannot be run: the proof says so itself.
pub fn refused_domore(original: &Image, other: &domore::Project, map: &[Mapping], options: &Options) -> Vec<Refused> {
    let settings = domore::engine::Options { choices: options.domore_choices, ..Default::default() };
    match (super::slc(original, "original", options), domore::engine::Program::compile(other, &settings)) {
        (Ok((_, a)), Ok(program)) => refused(original, &a, &DoMore::new(program), map),
        _ => Vec::new(),
    }
}

/// As [`refused_domore`], to another SLC program.
pub fn refused_slc(original: &Image, other: &Image, map: &[Mapping], options: &Options) -> Vec<Refused> {
    match (super::slc(original, "original", options), super::slc(other, "other program", options)) {
        (Ok((_, a)), Ok((_, b))) => refused(original, &a, &b, map),
        _ => Vec::new(),
    }
}

fn refused<B: Side>(image: &Image, a: &Slc, b: &B, map: &[Mapping]) -> Vec<Refused> {
    let rows = map.iter().enumerate();
    let bad = |(row, mapping)| Some(Refused { row, with: None, why: wrong(a, b, mapping).err()? });
    let found: Vec<_> = rows.filter_map(bad).collect();
    if found.is_empty() { overlapping(image, a, b, map) } else { found }
}

/// Bits a row takes on one side.
struct Stretch {
    first: u32,
    end: u32,
    row: usize,
    /// A single bit, which may lie inside the word it belongs to, or apart from it.
    point: bool,
}

/// Rows that place the same data twice, or different data at one place: whichever row is looked at first would
/// decide what is compared. Told at the later row.
fn overlapping<B: Side>(image: &Image, a: &Slc, b: &B, map: &[Mapping]) -> Vec<Refused> {
    let (mut own, mut other) = (Vec::new(), Vec::new());
    for (row, mapping) in map.iter().enumerate() {
        let (Ok(x), Ok(y)) = (a.place(&mapping.original), b.place(&mapping.other)) else { continue };
        let point = mapping.words == 0;
        let bits = if point { 1 } else { mapping.words.saturating_mul(16) };
        own.push(Stretch { first: x.0, end: x.0.saturating_add(bits), row, point });
        // Strings take another number of words there: up to the first one of the last string.
        let last =
            || advance(&mapping.other, (mapping.words / words_per_element(image, &mapping.original)).checked_sub(1)?);
        let text = (y.1 == Kind::Text).then(last).flatten().and_then(|last| b.place(&last).ok());
        let end = text.map_or(y.0.saturating_add(bits), |last| last.0.saturating_add(16));
        other.push(Stretch { first: y.0, end, row, point });
    }
    let mut found = meeting(map, own, false);
    found.extend(meeting(map, other, true));
    found.sort();
    found.dedup_by_key(|found| found.row);
    found
}

/// Stretches that have bits in common. `there`: on the other side.
fn meeting(map: &[Mapping], mut stretches: Vec<Stretch>, there: bool) -> Vec<Refused> {
    stretches.sort_by_key(|stretch| (stretch.point, stretch.first, stretch.row));
    let (runs, points) = stretches.split_at(stretches.partition_point(|stretch| !stretch.point));
    let told = |a: &Stretch, b: &Stretch| {
        let (with, row) = (a.row.min(b.row), a.row.max(b.row));
        let name = |row: usize| map.get(row).map_or("", |row| if there { &row.other } else { &row.original });
        let what = if there { "meet in the other program" } else { "are in part the same data" };
        Refused { row, with: Some(with), why: format!("{} and {} {what}", name(row), name(with)) }
    };
    let mut found = Vec::new();
    let mut widest: Option<&Stretch> = None;
    for run in runs {
        found.extend(widest.filter(|before| run.first < before.end).map(|before| told(before, run)));
        if widest.is_none_or(|before| run.end > before.end) {
            widest = Some(run);
        }
    }
    let twice = |pair: &[Stretch]| matches!(pair, [a, b] if a.first == b.first);
    found.extend(
        points.windows(2).filter(|pair| twice(pair)).filter_map(|pair| Some(told(pair.first()?, pair.last()?))),
    );
    // A bit taken out of its word does not lie in the word of something else.
    for point in points.iter().filter(|_| there) {
        let at = runs.partition_point(|run| run.first <= point.first);
        let run = at.checked_sub(1).and_then(|at| runs.get(at)).filter(|run| point.first < run.end);
        found.extend(run.filter(|run| !belongs(map.get(point.row), map.get(run.row))).map(|run| told(run, point)));
    }
    found
}

/// The bit of one row is one of the words of the other, by the address of the original.
fn belongs(point: Option<&Mapping>, run: Option<&Mapping>) -> bool {
    let parsed = |row: Option<&Mapping>| row.and_then(|row| Address::parse(&row.original).ok());
    let (Some(point), Some(run)) = (parsed(point), parsed(run)) else { return false };
    let same = (&point.file_type, &point.file) == (&run.file_type, &run.file);
    same && (!run.file_type.has_slots() || (point.element, point.word) == (run.element, run.word))
}

fn wrong<B: Side>(a: &Slc, b: &B, row: &Mapping) -> Result<(), String> {
    let (original, other) = (&row.original, &row.other);
    if other.is_empty() {
        return Err(format!("{original} has no place in the other program"));
    }
    let first = Address::parse(original).map_err(|error| format!("`{original}` is {error}"))?;
    let own = a.place(original)?;
    let found = b.place(other).map_err(|why| format!("{original} to `{other}`: {why}"))?;
    if row.words == 0 {
        return match (own.1, found.1) {
            (Kind::Bit, Kind::Bit) => Ok(()),
            (Kind::Bit, _) => Err(format!("{original} is a bit, `{other}` is none")),
            // Without a number of words such a row would place nothing, and nobody would see it.
            _ => Err(format!("{original} is no bit, and the row names no number of words")),
        };
    }
    if first.bit.is_some() {
        return Err(format!("{original} is a bit and cannot be {} words", row.words));
    }
    // Strings are placed one by one, and SLC programs name their last word in many forms.
    if found.1 == Kind::Text || other.contains(':') || advance(other, 0).is_none() {
        return Ok(());
    }
    if found.0 % 8 != 0 {
        return Err(format!("{original} to `{other}`: {other} does not begin a word"));
    }
    let last = spell_domore(other, row.words - 1, None, Kind::Word);
    match last.map(|last| (b.place(&last), last)) {
        Some((Err(why), last)) => Err(format!("{original} to `{other}`: {} words end at {last}: {why}", row.words)),
        _ => Ok(()),
    }
}
