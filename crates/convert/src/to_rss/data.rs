//! Data tables to both data file streams.

use ladder::{DataFile, FileType, Image};
use rss::data::{self, DataFiles, DataHolder, Extension, ExtensionalDataFiles, FileTypeCode};
use rss::{Error, Result};

use super::text;
use crate::codes;

pub(super) fn files(image: &Image) -> Result<DataFiles<'_>> {
    holder(image, None).map(DataFiles)
}

pub(super) fn extensional(image: &Image) -> Result<ExtensionalDataFiles<'_>> {
    let mut holder = holder(image, Some(Extension::default()))?;
    holder.between = Some(0);
    Ok(ExtensionalDataFiles(holder))
}

fn holder(image: &Image, extension: Option<Extension>) -> Result<DataHolder<'_>> {
    let is_module = |file: &&DataFile| matches!(file.file_type, FileType::M0 | FileType::M1);
    let user: Vec<&DataFile> = image.data_files.iter().filter(|file| !is_module(file)).collect();
    let last = user.iter().map(|file| file.number).max().unwrap_or(0);
    let mut files = Vec::with_capacity(usize::from(last) + 1);
    for number in 0..=last {
        // The index in the list is the file number: gaps are unused files.
        let file = match user.iter().find(|file| file.number == number) {
            Some(file) => stored(file)?,
            None => data::DataFile { number, ..data::DataFile::default() },
        };
        files.push(data::DataFile { extension, ..file });
    }
    let function = image.function_files.iter().map(|file| Ok(data::DataFile { extension, ..stored(file)? }));
    let function = function.collect::<Result<_>>()?;
    let m =
        [(FileType::M0, "M0", 0), (FileType::M1, "M1", 1)].into_iter().map(|(file_type, name, number)| {
            match image.data_files.iter().find(|file| file.file_type == file_type) {
                Some(file) => Ok(data::DataFile { extension, ..stored(file)? }),
                None => Ok(data::DataFile {
                    type_code: code(file_type)?,
                    words: 1,
                    number,
                    name: text(name)?,
                    extension,
                    ..data::DataFile::default()
                }),
            }
        });
    let m = m.collect::<Result<_>>()?;
    Ok(DataHolder { user: files, between: None, function, m })
}

pub(super) fn code(file_type: FileType) -> Result<FileTypeCode> {
    codes::type_code(file_type)
        .map(FileTypeCode)
        .ok_or_else(|| Error::Unwritable(format!("no stored number of data file type {file_type} is known")))
}

pub(super) fn stored(file: &DataFile) -> Result<data::DataFile<'_>> {
    Ok(data::DataFile {
        type_code: code(file.file_type)?,
        elements: file.elements,
        words: file.words_per_element,
        data: file.words.iter().copied().collect(),
        forces: file.forces.iter().flat_map(|force| [force.on, force.off]).collect(),
        number: file.number,
        description: text(&file.description)?,
        name: text(&file.name)?,
        ..data::DataFile::default()
    })
}
