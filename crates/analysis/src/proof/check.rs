//! Rows of a map that cannot mean anything, found before a run.

use ladder::{Address, Image};

use super::Options;
use super::pairs::{Mapping, advance, spell_domore};
use super::side::{DoMore, Kind, Side, Slc};

/// Rows of a map to a Do-more program that name no data of one of the sides: index in `map`, and why.
/// Empty too where a program cannot be run: the proof says so itself.
pub fn refused_domore(
    original: &Image,
    other: &domore::Project,
    map: &[Mapping],
    options: &Options,
) -> Vec<(usize, String)> {
    let settings = domore::engine::Options { choices: options.domore_choices, ..Default::default() };
    match (super::slc(original, "original", options), domore::engine::Program::compile(other, &settings)) {
        (Ok((_, a)), Ok(program)) => refused(&a, &DoMore::new(program), map),
        _ => Vec::new(),
    }
}

/// As [`refused_domore`], to another SLC program.
pub fn refused_slc(original: &Image, other: &Image, map: &[Mapping], options: &Options) -> Vec<(usize, String)> {
    match (super::slc(original, "original", options), super::slc(other, "other program", options)) {
        (Ok((_, a)), Ok((_, b))) => refused(&a, &b, map),
        _ => Vec::new(),
    }
}

fn refused<B: Side>(a: &Slc, b: &B, map: &[Mapping]) -> Vec<(usize, String)> {
    let rows = map.iter().enumerate();
    rows.filter_map(|(index, row)| wrong(a, b, row).err().map(|why| (index, why))).collect()
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
