//! Processor page, I/O, channels, program file list and data file list.

use crate::{Outcome, Pair};
use ladder::{DataFile, FileType, ProgramFile, ProgramFileKind};

/// Type, name and program ID of the processor, and the numbers of files.
pub(crate) fn processor(pair: &Pair<'_>) -> Outcome {
    let mut outcome = Outcome::default();
    let Some(printed) = &pair.report.printout.processor else { return outcome };
    let read = &pair.image.processor;
    let kind = format!("{} {}", read.catalog.as_deref().unwrap_or("?"), read.name.as_deref().unwrap_or("?"));
    outcome.row("processor type", printed.kind.as_str(), kind.as_str());
    outcome.row("processor name", printed.name.as_str(), read.project_name.as_str());
    outcome.row("program ID", printed.program_id, read.program_id);
    let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    outcome.row("program files", printed.program_files, count(programs(pair).count()));
    outcome.row("data files", printed.data_files, count(data(pair).count()));
    outcome
}

/// Words used and left. RSLogix prints `*` for them exactly while a rung waits to be verified.
pub(crate) fn memory(pair: &Pair<'_>) -> Outcome {
    let mut outcome = Outcome::default();
    let Some(printed) = &pair.report.printout.processor else { return outcome };
    let read = pair.image.memory.filter(|_| !pair.image.is_edited());
    outcome.row("instruction words left", printed.left, read.map(|m| m.instruction_words_left));
    let used = read.and_then(|m| Some((m.instruction_words_used, m.data_words_used?)));
    outcome.row("words used", printed.used, used);
    outcome
}

/// Slots, empty ones included.
pub(crate) fn io(pair: &Pair<'_>) -> Outcome {
    let mut outcome = Outcome::default();
    for row in pair.report.printout.io.iter().flatten() {
        let slot = pair.image.io.slots.iter().find(|s| s.number == row.slot);
        let read = slot.map(|s| (s.module.catalog.clone().unwrap_or_default(), s.module.description.clone()));
        let printed = (row.catalog.clone(), row.description.clone());
        outcome.row(format!("slot {}", row.slot), printed, read.unwrap_or_default());
    }
    outcome
}

/// Drivers, and every printed setting by its printed name.
pub(crate) fn channels(pair: &Pair<'_>) -> Outcome {
    let mut outcome = Outcome::default();
    for channel in &pair.report.printout.channels {
        let read = pair.image.channels.iter().find(|c| c.number == channel.number);
        let driver = read.map(|c| c.driver.as_str());
        outcome.row(format!("channel {} driver", channel.number), Some(channel.driver.as_str()), driver);
        // Contact and location are empty in all reports: nothing to compare.
        for setting in channel.settings.iter().filter(|s| !s.value.is_empty()) {
            let value = read.and_then(|c| c.settings.iter().find(|s| s.name == setting.label));
            let value = value.map(|s| s.value.as_str());
            outcome.row(format!("channel {} {}", channel.number, setting.label), Some(setting.value.as_str()), value);
        }
    }
    outcome
}

/// Program files that RSLogix lists: all but unused numbers.
fn programs<'a>(pair: &Pair<'a>) -> impl Iterator<Item = &'a ProgramFile> {
    pair.image.program_files.iter().filter(|f| f.kind != ProgramFileKind::Unused)
}

/// Data files that RSLogix lists: all but unused and reserved numbers.
fn data<'a>(pair: &Pair<'a>) -> impl Iterator<Item = &'a DataFile> {
    let listed = |f: &&DataFile| !matches!(f.file_type, FileType::Unused | FileType::Reserved);
    pair.image.data_files.iter().filter(listed)
}

/// Number, name, type and rungs of every program file.
pub(crate) fn program_files(pair: &Pair<'_>) -> Outcome {
    let mut outcome = Outcome::default();
    let Some(printed) = &pair.report.printout.program_files else { return outcome };
    for row in printed {
        let name = if row.name == "[SYSTEM]" { "" } else { row.name.trim() };
        let file = programs(pair).find(|f| f.number == row.number);
        let read = file.map(|f| (f.name.trim(), f.kind.as_str(), f.rungs.len()));
        outcome.row(format!("program file {}", row.number), Some((name, row.kind.as_str(), row.rungs)), read);
    }
    for file in programs(pair).filter(|f| printed.iter().all(|row| row.number != f.number)) {
        outcome.missing(format!("program file {} is not printed", file.number));
    }
    outcome
}

/// Number, name, type, words, elements and last address of every data file.
pub(crate) fn data_files(pair: &Pair<'_>) -> Outcome {
    let mut outcome = Outcome::default();
    let Some(printed) = &pair.report.printout.data_files else { return outcome };
    for row in printed {
        let read = data(pair).find(|f| f.number == row.number).map(|f| {
            // Beside each I/O word RSLogix counts its two force masks; the status file counts nothing.
            let per_element = match f.file_type {
                FileType::O | FileType::I => 3,
                FileType::S => 0,
                _ => u32::from(f.words_per_element),
            };
            let elements = u32::from(f.elements);
            let last = elements.checked_sub(1).map_or(String::new(), |last| match f.file_type {
                FileType::O | FileType::I | FileType::S => format!("{}:{last}", f.file_type),
                _ => format!("{}:{last}", f.label()),
            });
            (f.name.trim().to_owned(), f.file_type.to_string(), per_element * elements, elements, last)
        });
        let expected = (row.name.clone(), row.kind.clone(), row.words, row.elements, row.last.clone());
        outcome.row(format!("data file {}", row.number), Some(expected), read);
    }
    for file in data(pair).filter(|f| printed.iter().all(|row| row.number != f.number)) {
        outcome.missing(format!("data file {} is not printed", file.number));
    }
    outcome
}
