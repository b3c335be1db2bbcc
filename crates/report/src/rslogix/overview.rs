//! Processor, channels, diagnostics.

use ladder::{Confidence, Diagnostic, FileType, ProgramFileKind, Severity};

use super::{Context, remark};
use crate::model::{Block, ColumnKind, Note, NoteKind, Pair, Table, Text};
use crate::words;

/// Collects names and values, without those that say nothing.
pub(crate) struct Pairs(Vec<Pair>);

impl Pairs {
    pub(crate) fn new() -> Pairs {
        Pairs(Vec::new())
    }

    pub(crate) fn add(&mut self, name: &str, value: impl Into<Text>) {
        let value = value.into();
        if !value.is_empty() {
            self.0.push(Pair { name: name.to_owned(), value });
        }
    }

    pub(crate) fn block<'a>(self) -> Block<'a> {
        Block::Pairs(self.0)
    }
}

pub(super) fn processor<'a>(context: &Context<'a, '_>) -> Vec<Block<'a>> {
    let (project, image) = (context.source.project, context.image());
    let (source, processor) = (&project.source, &image.processor);
    let mut pairs = Pairs::new();
    pairs.add("Processor Type", words::processor(processor));
    pairs.add("Processor Name", processor.project_name.as_str());
    if let Some(memory) = &image.memory {
        // The figures of an edited program are not known before it is verified, on paper neither.
        let stale = |text: String| {
            if image.is_edited() { format!("*  (not verified; at the last verify: {text})") } else { text }
        };
        pairs.add("Total Memory Used", stale(words::memory_used(memory)));
        pairs.add("Total Memory Left", stale(words::memory_left(memory)));
    } else {
        pairs.add("Total Memory Used", "not stored in this project");
    }
    let programs = image.program_files.iter().filter(|file| file.kind != ProgramFileKind::Unused).count();
    let data = image.data_files.iter().filter(|file| file.file_type != FileType::Unused).count();
    pairs.add("Program Files", programs.to_string());
    pairs.add("Data Files", data.to_string());
    pairs.add("Program ID", processor.program_id.map(|id| format!("{id:x}")).unwrap_or_default());
    pairs.add("Main Program", processor.main_program.as_str());
    pairs.add("Protection", words::protection(processor));
    let mut online = Pairs::new();
    online.add("File", source.file.as_str());
    online.add("Size", format!("{} bytes", source.bytes));
    online.add("SHA-256", source.sha256.as_str());
    online.add("Saved by", words::saved_by(source));
    online.add("Saved at", source.saved_at.clone().unwrap_or_default());
    online.add("Created at", source.created_at.clone().unwrap_or_default());
    let images = [(true, "main"), (project.online.is_some(), "online"), (project.autosave.is_some(), "autosave")];
    let images: Vec<&str> = images.into_iter().filter_map(|(present, name)| present.then_some(name)).collect();
    online.add("Images", images.join(", "));
    online.add("Driver", processor.driver.as_str());
    online.add("Route", processor.route.as_str());
    let mut blocks = vec![pairs.block(), Block::Heading("Source".to_owned()), online.block()];
    if !project.revision_notes.is_empty() {
        blocks.push(Block::Heading("Revision Notes".to_owned()));
        let mut table = Table::new(&[("Revision", ColumnKind::Number), ("Note", ColumnKind::Text)]);
        for note in &project.revision_notes {
            table.row([note.revision.to_string().into(), note.note.as_str().into()]);
        }
        blocks.push(Block::Table(table));
    }
    blocks
}

pub(super) fn channels<'a>(context: &Context<'a, '_>) -> Vec<Block<'a>> {
    let mut blocks = Vec::new();
    for channel in &context.image().channels {
        blocks.push(Block::Heading(format!("CHANNEL {} - Driver: {}", channel.number, channel.driver)));
        let mut pairs = Pairs::new();
        for setting in &channel.settings {
            let doubt = match setting.confidence {
                sure if sure >= Confidence::Proven => String::new(),
                doubt => format!("  ({})", doubt.as_str()),
            };
            // A setting without a value is one: the name alone says that it is empty.
            let value = if setting.value.is_empty() { "-" } else { setting.value.as_str() };
            pairs.add(&setting.name, format!("{value}{doubt}"));
        }
        blocks.push(pairs.block());
        if channel.unexplained_words > 0 {
            let text = format!("{} of unknown meaning.", words::count(channel.unexplained_words, "configuration word"));
            blocks.push(Block::Note(Note::new(NoteKind::Warning, text)));
        }
    }
    if blocks.is_empty() {
        blocks.push(remark("The project holds no channel configuration."));
    }
    blocks
}

/// Everything the reader found, notes included.
pub(crate) fn diagnostics<'a>(found: &[Diagnostic]) -> Vec<Block<'a>> {
    if found.is_empty() {
        return vec![remark("Everything in the project was read; nothing deviates from the known form.")];
    }
    let mut table =
        Table::new(&[("Severity", ColumnKind::Text), ("Place", ColumnKind::Text), ("Finding", ColumnKind::Text)]);
    let mut sorted: Vec<&Diagnostic> = found.iter().collect();
    sorted.sort_by_key(|it| std::cmp::Reverse(it.severity));
    for it in sorted {
        table.row([it.severity.as_str().into(), it.place.as_str().into(), it.message.as_str().into()]);
    }
    let errors = found.iter().filter(|it| it.severity == Severity::Error).count();
    let mut blocks = Vec::new();
    if errors > 0 {
        let text = format!("{} could not be read: what is shown is incomplete.", words::count(errors, "part"));
        blocks.push(Block::Note(Note::new(NoteKind::Error, text)));
    }
    blocks.push(Block::Table(table));
    blocks
}
