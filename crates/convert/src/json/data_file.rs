//! A data file of a document: its values turned back into words.

use ladder::{DataFile, FileType, Force};

use super::document::{DataFileDoc, ForceDoc, RawDoc};
use super::error::JsonError;
use super::path::{Path, quoted};
use super::value::{ElementDoc, words_of};

type Result<T> = std::result::Result<T, JsonError>;

pub(super) fn data_file(doc: DataFileDoc<'_>, path: &Path<'_>) -> Result<DataFile> {
    let wanted = || path.member("type").error("data file letters such as N or T", quoted(&doc.file_type));
    let file_type = file_type(&doc.file_type).ok_or_else(wanted)?;
    let words_per_element = doc.words_per_element.or(file_type.words_per_element()).unwrap_or(1);
    if doc.values.len() != usize::from(doc.elements) {
        let expected = format!("{} values, as many as elements", doc.elements);
        return Err(path.member("values").error(expected, doc.values.len().to_string()));
    }
    let mut words = words_of_values(file_type, words_per_element, &doc.values, path)?;
    let raw = path.member("raw");
    for (index, patch) in doc.raw.iter().enumerate() {
        patch_words(&mut words, patch, &raw.index(index))?;
    }
    let forces = match &doc.forces {
        None => Vec::new(),
        Some(list) => forces(list, doc.force_words.unwrap_or(words.len()), words.len(), path)?,
    };
    let file = DataFile {
        number: doc.number,
        file_type,
        name: doc.name.into_owned(),
        description: doc.description.into_owned(),
        elements: doc.elements,
        words_per_element,
        words,
        forces,
    };
    // Other writers may not know how RSLogix counts O, I and S.
    if ![file.listed_words(), file.words.len()].contains(&doc.words) {
        let expected = format!("{}, as the data file list counts them", file.listed_words());
        return Err(path.member("words").error(expected, doc.words.to_string()));
    }
    Ok(file)
}

/// The type that writes itself so.
fn file_type(text: &str) -> Option<FileType> {
    let code = || text.strip_prefix('?')?.parse().ok().map(FileType::Unknown);
    let special = [FileType::Reserved, FileType::Unused].into_iter().find(|kind| kind.to_string() == text);
    special.or_else(|| FileType::from_letters(text)).or_else(code)
}

fn words_of_values(
    file_type: FileType,
    words_per_element: u16,
    values: &[ElementDoc<'_>],
    path: &Path<'_>,
) -> Result<Vec<u16>> {
    let list = path.member("values");
    let mut words = Vec::new();
    for (index, value) in values.iter().enumerate() {
        let path = list.index(index);
        let before = words.len();
        words_of(file_type, value, &mut words).map_err(|error| match error.member.as_str() {
            "" => path.error(error.expected, error.found),
            member => path.member(member).error(error.expected, error.found),
        })?;
        let added = words.len() - before;
        let missing = *value == ElementDoc::Missing;
        if missing && values.get(index + 1).is_some_and(|next| *next != ElementDoc::Missing) {
            return Err(path.error("a value: only the last ones can be missing", "null"));
        }
        if !missing && added != usize::from(words_per_element) {
            return Err(path.error(format!("a value of {words_per_element} words"), format!("one of {added}")));
        }
    }
    Ok(words)
}

fn patch_words(words: &mut Vec<u16>, patch: &RawDoc, path: &Path<'_>) -> Result<()> {
    let expected = || format!("a word from 0 to {}", words.len());
    if patch.word > words.len() {
        return Err(path.member("word").error(expected(), patch.word.to_string()));
    }
    for (offset, word) in patch.words.iter().enumerate() {
        match words.get_mut(patch.word + offset) {
            Some(slot) => *slot = *word as u16,
            None => words.push(*word as u16),
        }
    }
    Ok(())
}

fn forces(list: &[ForceDoc], count: usize, words: usize, path: &Path<'_>) -> Result<Vec<Force>> {
    // Masks beyond the words of the file are all listed: a short document cannot claim many.
    let most = words.saturating_add(list.len());
    if count > most {
        return Err(path.member("force_words").error(format!("at most {most}"), count.to_string()));
    }
    let mut forces = vec![Force::NONE; count];
    let list_path = path.member("forces");
    for (index, doc) in list.iter().enumerate() {
        let path = list_path.index(index);
        let Some(force) = forces.get_mut(doc.word) else {
            return Err(path.member("word").error(format!("a word below {count}"), doc.word.to_string()));
        };
        *force = Force { on: mask(&doc.on, path.member("on"))?, off: !mask(&doc.off, path.member("off"))? };
    }
    Ok(forces)
}

fn mask(bits: &[u8], path: Path<'_>) -> Result<u16> {
    bits.iter().enumerate().try_fold(0, |mask, (index, bit)| match 1u16.checked_shl((*bit).into()) {
        Some(one) => Ok(mask | one),
        None => Err(path.index(index).error("a bit from 0 to 15", bit.to_string())),
    })
}
