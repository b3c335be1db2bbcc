//! Facts of a project in words, the same in every output.

use ladder::{IoRange, Memory, Processor, ProgramFile, ProgramFileKind, Slot, Source};

/// The controller of a Do-more project.
pub fn controller(project: &domore::Project) -> String {
    format!("Do-more {}", project.controller()).trim_end().to_owned()
}

/// Processor type with catalogue number and name, and how sure that is.
pub fn processor(processor: &Processor) -> String {
    let sure = format!("({}: {})", processor.family_confidence.as_str(), processor.evidence);
    match (&processor.catalog, &processor.name) {
        (Some(catalog), Some(name)) => format!("{catalog}  {name}  {sure}"),
        // A text can name the catalogue number alone.
        (Some(catalog), None) if processor.model.is_none() => {
            format!("{catalog}  {}, model not told  {sure}", processor.family)
        }
        _ => match processor.model {
            Some(code) => format!("unknown (model code {code}); its bytes are kept"),
            None => "unknown".to_owned(),
        },
    }
}

/// Product and version that saved the file.
pub fn saved_by(source: &Source) -> String {
    match source.application.as_str() {
        // Our own writer states the version whose format it follows.
        ours if ours == "rungs" || ours.starts_with("rungs, ") => {
            format!("{ours}, in the format of RSLogix {}", source.saved_by)
        }
        application => [application, source.saved_by.as_str()].join(" ").trim().to_owned(),
    }
}

/// What protects the program; never a secret.
pub fn protection(processor: &Processor) -> &'static str {
    match (processor.deny_future_access, processor.password_fields_used) {
        (Some(true), _) => "future access is denied (S:1/14)",
        (_, Some(true)) => "a field that may hold a password is in use; its content is not shown",
        (Some(false), Some(false)) => "none found",
        _ => "unknown",
    }
}

/// Memory used, as paper says it: `288 Instruction Words Used - 191 Data Table Words Used`.
pub fn memory_used(memory: &Memory) -> String {
    let data = memory.data_words_used.map(|words| format!(" - {words} Data Table Words Used")).unwrap_or_default();
    format!("{} Instruction Words Used{data}", memory.instruction_words_used)
}

/// Memory left, as paper says it.
pub fn memory_left(memory: &Memory) -> String {
    let data = memory.data_words_left.map(|words| format!(" - {words} Data Table Words Left")).unwrap_or_default();
    format!("{} Instruction Words Left{data}", memory.instruction_words_left)
}

/// Words and points of a slot in file I or O: `I:1.0-1 (24 points)`; empty without words.
pub fn points(slot: &Slot, range: &IoRange, letter: &str) -> String {
    match range.words {
        0 => String::new(),
        words => format!("{letter}:{}.0-{} ({} points)", slot.number, words - 1, range.bits),
    }
}

/// The name of a program file in lists.
pub fn file_name(file: &ProgramFile) -> String {
    if file.number == 0 && file.name.is_empty() { "[SYSTEM]".to_owned() } else { file.name.clone() }
}

/// `LAD 2 - MAIN - description`.
pub fn file_title(file: &ProgramFile) -> String {
    let kind = match file.kind {
        ProgramFileKind::Ladder => "LAD",
        other => other.as_str(),
    };
    let mut text = format!("{kind} {} - {}", file.number, file.name.trim());
    if !file.description.trim().is_empty() {
        text = format!("{text} - {}", file.description.trim());
    }
    text
}

/// The last element of a data file as lists name it.
pub fn last_element(file: &ladder::DataFile) -> String {
    match (file.elements, file.file_type.has_slots()) {
        (0, _) => String::new(),
        // Words of O and I are counted through all slots, as printed file lists do.
        (count, true) => format!("{}:{}", file.file_type, count - 1),
        (count, false) => ladder::Address::element(file.file_type, file.number, count - 1).to_string(),
    }
}

/// `first line second line` of a description, for one cell.
pub fn one_line(lines: &[String]) -> String {
    lines.iter().map(|line| line.trim()).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}

/// `1 rung`, `2 rungs`.
pub(crate) fn count(number: usize, one: &str) -> String {
    if number == 1 { format!("1 {one}") } else { format!("{number} {one}s") }
}

/// `40 %`; empty of nothing.
pub(crate) fn percent(part: usize, of: usize) -> String {
    match (part * 100).checked_div(of) {
        Some(percent) => format!("{percent} %"),
        None => String::new(),
    }
}

/// `4 of 10  (40 %)`.
pub(crate) fn share(part: usize, of: usize) -> String {
    let percent = percent(part, of);
    if percent.is_empty() { "none there".to_owned() } else { format!("{part} of {of}  ({percent})") }
}
