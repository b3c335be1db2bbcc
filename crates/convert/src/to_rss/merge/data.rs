//! Data tables: records of ours with merged words, further ones from theirs.

use ladder::{DataFile, FileType, Image};
use rss::Result;
use rss::data::{self, DataHolder};

use crate::to_rss::data::{code, stored};
use crate::to_rss::text;

/// The tables of one stream.
pub(super) fn holder<'a>(
    (ours, theirs): &(DataHolder<'a>, DataHolder<'a>),
    before: &Image,
    merged: &'a Image,
) -> Result<DataHolder<'a>> {
    let is_module = |file: &&DataFile| matches!(file.file_type, FileType::M0 | FileType::M1);
    let files: Vec<&DataFile> = merged.data_files.iter().filter(|file| !is_module(file)).collect();
    let last = files.iter().map(|file| usize::from(file.number)).max().unwrap_or(0);
    let mut user = Vec::new();
    for index in 0..=last.max(ours.user.len().saturating_sub(1)) {
        let Some(file) = files.iter().find(|file| usize::from(file.number) == index) else {
            // The index in the list is the file number: gaps are unused files.
            let number = u16::try_from(index).unwrap_or(u16::MAX);
            let unused = ours.user.get(index).filter(|file| file.elements == 0).cloned();
            let extension = ours.user.first().and_then(|file| file.extension);
            user.push(unused.unwrap_or(data::DataFile { number, extension, ..data::DataFile::default() }));
            continue;
        };
        let old = before.data_files.iter().find(|old| old.number == file.number && old.file_type == file.file_type);
        user.push(one(file, old, (ours.user.get(index), theirs.user.get(index)))?);
    }
    let mut function = Vec::new();
    for file in &merged.function_files {
        let same = |old: &&DataFile| old.number == file.number && old.file_type == file.file_type;
        let type_code = code(file.file_type)?;
        let find = |holder: &DataHolder<'a>| {
            holder.function.iter().find(|old| old.type_code == type_code && old.number == file.number).cloned()
        };
        let (x, y) = (find(ours), find(theirs));
        function.push(one(file, before.function_files.iter().find(same), (x.as_ref(), y.as_ref()))?);
    }
    Ok(DataHolder { user, between: ours.between, function, m: ours.m.clone() })
}

/// A table: the record as it is stored if nothing of it changed.
fn one<'a>(
    file: &'a DataFile,
    old: Option<&DataFile>,
    (ours, theirs): (Option<&data::DataFile<'a>>, Option<&data::DataFile<'a>>),
) -> Result<data::DataFile<'a>> {
    let type_code = code(file.file_type)?;
    let of_type = |record: &&data::DataFile<'a>| record.type_code == type_code;
    if let Some(record) = ours.filter(of_type)
        && old == Some(file)
    {
        return Ok(record.clone());
    }
    let fresh = stored(file)?;
    let extension = ours.or(theirs).and_then(|record| record.extension);
    let record = ours.filter(of_type).or(theirs.filter(of_type));
    let record = record.cloned().unwrap_or_else(|| data::DataFile { extension, ..fresh.clone() });
    Ok(data::DataFile {
        elements: fresh.elements,
        words: fresh.words,
        data: fresh.data,
        forces: if file.forces.is_empty() { record.forces.clone() } else { fresh.forces },
        name: text(&file.name)?,
        description: text(&file.description)?,
        ..record
    })
}
