//! Why something cannot happen, in words.

use std::collections::{BTreeMap, BTreeSet};

use ladder::{Address, FileType};

use super::Surroundings;
use super::cells::is_hidden;
use super::facts::{Fact, Induction};

/// Facts that an argument names.
const NAMED: usize = 3;

/// The argument that rests on these facts.
pub(super) fn of(induction: &mut Induction<'_>, used: &BTreeSet<usize>, given: &Surroundings<'_>) -> String {
    let count = induction.support(used).len();
    if count == 0 {
        return "no scan gets there, whatever the data".to_owned();
    }
    let facts = used.iter().filter_map(|index| induction.fact(*index)).cloned();
    let mut said = said(&facts.collect::<Vec<_>>(), &known_words(induction), given);
    let more = said.len().saturating_sub(NAMED);
    said.truncate(NAMED);
    if said.is_empty() {
        said.push("no scan gets there".to_owned());
    }
    let mut text = said.join("; ");
    if more > 0 {
        text.push_str(&format!("; and {more} more"));
    }
    let facts = if count == 1 { "1 fact".to_owned() } else { format!("{count} facts") };
    text.push_str(&format!(" (between scans; {facts} by induction)"));
    text
}

/// Words of which every bit is known.
fn known_words(induction: &Induction<'_>) -> BTreeMap<u32, u16> {
    let mut words: BTreeMap<u32, (u16, u16)> = BTreeMap::new();
    for fact in induction.facts() {
        if let [(at, on)] = fact.0.as_slice()
            && !is_hidden(*at)
        {
            let entry = words.entry(at / 16).or_default();
            entry.0 |= 1 << (at % 16);
            entry.1 |= u16::from(*on) << (at % 16);
        }
    }
    words.into_iter().filter(|(_, (known, _))| *known == u16::MAX).map(|(word, (_, value))| (word, value)).collect()
}

/// Facts in words, what says most first: bits, then words, then what keeps numbers in their range.
fn said(facts: &[Fact], words: &BTreeMap<u32, u16>, given: &Surroundings<'_>) -> Vec<String> {
    let (mut bits, mut values, mut ranges) = (Vec::new(), BTreeSet::new(), BTreeSet::new());
    for fact in facts {
        if fact.0.iter().any(|(at, _)| is_hidden(*at)) {
            continue;
        }
        let [(at, on)] = fact.0.as_slice() else {
            bits.extend(pair(fact, given));
            continue;
        };
        let Some(place) = Place::of(*at, given) else { continue };
        match words.get(&(at / 16)) {
            _ if place.is_flag => {
                let state = if *on { "on" } else { "off" };
                bits.push(format!("{} is always {state}", place.bit));
            }
            Some(value) => {
                values.insert(format!("{} is always {}", place.word, *value as i16));
            }
            None if at % 16 == 15 && !on => {
                ranges.insert(format!("{} is never negative", place.word));
            }
            None => {
                ranges.insert(format!("{} keeps some of its bits", place.word));
            }
        }
    }
    bits.into_iter().chain(values).chain(ranges).collect()
}

fn pair(fact: &Fact, given: &Surroundings<'_>) -> Option<String> {
    let name = |at: u32| Place::of(at, given).map(|place| place.bit);
    match fact.0.as_slice() {
        [(a, false), (b, false)] => Some(format!("{} and {} are never on together", name(*a)?, name(*b)?)),
        [(a, true), (b, true)] => Some(format!("{} and {} are never off together", name(*a)?, name(*b)?)),
        [(a, false), (b, true)] | [(b, true), (a, false)] => {
            Some(format!("{} is never on without {}", name(*a)?, name(*b)?))
        }
        _ => None,
    }
}

/// What stands at a bit.
struct Place {
    bit: String,
    word: String,
    /// People know it as a bit: of an output, a bit file, the flags of a timer.
    is_flag: bool,
}

impl Place {
    fn of(at: u32, given: &Surroundings<'_>) -> Option<Place> {
        let word = at / 16;
        let file = given.outline.files.iter().find(|file| (file.words.0..file.words.1).contains(&word))?;
        let offset = word - file.words.0;
        let (element, sub) = (u16::try_from(offset / file.size).ok()?, (offset % file.size) as u16);
        let address = Address::element(file.file_type, file.number, element);
        let address = if sub == 0 { address } else { address.with_word(sub) };
        let is_flag = match file.file_type {
            FileType::T | FileType::C | FileType::R => sub == 0,
            FileType::O | FileType::B => true,
            _ => false,
        };
        let bit = given.names.get(&at).cloned();
        let bit = bit.unwrap_or_else(|| address.clone().with_bit((at % 16) as u16).to_string());
        Some(Place { bit, word: address.to_string(), is_flag })
    }
}
