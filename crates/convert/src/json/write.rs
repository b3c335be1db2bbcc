//! From the model to the shape of a JSON document.

use std::borrow::Cow;

use ladder::{
    AddressEntry, Channel, Comment, CommentOwner, DataFile, Diagnostic, Element, Family, FileType, Force, Image,
    Instruction, InstructionComment, IoConfiguration, IoRange, Memory, Processor, ProgramFile, Project, RevisionNote,
    Rung, Slot, Source, Target,
};

use super::document::*;
use super::structure::structure_of;
use super::target::kind_of;
use super::value::{ElementDoc, value_of, words_of};
use crate::slc::rung::{parse_rung, rung_text};

pub(super) fn document(project: &Project) -> Document<'_> {
    let ImageDoc {
        processor,
        program_files,
        data_files,
        function_files,
        symbols,
        instruction_comments,
        detached_comments,
        io,
        io_base,
        channels,
        memory,
    } = image(&project.main);
    Document {
        schema: super::SCHEMA.into(),
        source: source(&project.source),
        processor,
        program_files,
        data_files,
        function_files,
        symbols,
        instruction_comments,
        detached_comments,
        io,
        io_base,
        channels,
        memory,
        revision_notes: project.revision_notes.iter().map(revision_note).collect(),
        diagnostics: project.diagnostics.iter().map(diagnostic).collect(),
        online: project.online.as_ref().map(image),
        autosave: project.autosave.as_ref().map(image),
    }
}

fn text(text: &str) -> Cow<'_, str> {
    Cow::Borrowed(text)
}

fn option(text: &Option<String>) -> Option<Cow<'_, str>> {
    text.as_deref().map(Cow::Borrowed)
}

/// `null` stands for an empty title or comment.
fn non_empty(text: &str) -> Option<Cow<'_, str>> {
    (!text.is_empty()).then_some(Cow::Borrowed(text))
}

fn lines(lines: &[String]) -> Vec<Cow<'_, str>> {
    lines.iter().map(|line| text(line)).collect()
}

fn signed(words: &[u16]) -> Vec<i16> {
    words.iter().map(|word| *word as i16).collect()
}

fn source(source: &Source) -> SourceDoc<'_> {
    SourceDoc {
        file: text(&source.file),
        sha256: text(&source.sha256),
        saved_by: text(&source.saved_by),
        application: text(&source.application),
        saved_at: option(&source.saved_at),
        created_at: option(&source.created_at),
        bytes: source.bytes,
    }
}

fn image(image: &Image) -> ImageDoc<'_> {
    let family = image.family();
    ImageDoc {
        processor: processor(&image.processor),
        program_files: image.program_files.iter().map(|file| program_file(file, family)).collect(),
        data_files: image.data_files.iter().map(|file| data_file(file, &image.io)).collect(),
        function_files: image.function_files.iter().map(|file| data_file(file, &image.io)).collect(),
        symbols: image.documentation.entries().iter().map(symbol).collect(),
        instruction_comments: image.documentation.instruction_comments().iter().map(instruction_comment).collect(),
        detached_comments: image.documentation.detached_comments.iter().map(detached_comment).collect(),
        io: image.io.slots.iter().map(slot).collect(),
        io_base: IoBaseDoc { base_unit: text(&image.io.base_unit), unknown: option(&image.io.unknown) },
        channels: image.channels.iter().map(channel).collect(),
        memory: image.memory.map(memory),
    }
}

fn processor(processor: &Processor) -> ProcessorDoc<'_> {
    ProcessorDoc {
        catalog: option(&processor.catalog),
        name: option(&processor.name),
        family: processor.family.id().into(),
        project_name: text(&processor.project_name),
        family_confidence: Some(processor.family_confidence.as_str().into()),
        evidence: text(&processor.evidence),
        model: processor.model,
        main_program: text(&processor.main_program),
        program_id: processor.program_id,
        reported_type: processor.reported_type,
        driver: text(&processor.driver),
        route: text(&processor.route),
        deny_future_access: processor.deny_future_access,
        password_fields_used: processor.password_fields_used,
    }
}

fn program_file(file: &ProgramFile, family: Family) -> ProgramFileDoc<'_> {
    let numbered = (0u32..).zip(&file.rungs);
    ProgramFileDoc {
        number: file.number,
        name: text(&file.name),
        description: text(&file.description),
        kind: file.kind.as_str().into(),
        rungs: numbered.map(|(number, rung)| rung_doc(rung, file.number, number, family)).collect(),
    }
}

fn rung_doc(rung: &Rung, file: u16, number: u32, family: Family) -> RungDoc<'_> {
    let rung_text = rung_text(rung);
    let readable = parse_rung(&rung_text, Some(family)).is_ok_and(|read| same_shape(&read.series, &rung.series));
    let comment = rung.comment.as_ref();
    RungDoc {
        number,
        title: comment.and_then(|comment| non_empty(&comment.title)),
        comment: comment.and_then(|comment| non_empty(&comment.text)),
        edited: rung.edited,
        comment_owner: comment.and_then(|comment| rung_owner(comment, file, number)),
        structure: (!readable).then(|| structure_of(rung)),
        instructions: Some(rung.instructions().map(instruction).collect()),
        text: rung_text.into(),
    }
}

/// Same branches around the same mnemonics; operands come from the list of instructions.
fn same_shape(a: &[Element], b: &[Element]) -> bool {
    a.len() == b.len()
        && a.iter().zip(b).all(|pair| match pair {
            (Element::Instruction(a), Element::Instruction(b)) => a.mnemonic == b.mnemonic,
            (Element::Branch(a), Element::Branch(b)) => {
                a.legs.len() == b.legs.len() && a.legs.iter().zip(&b.legs).all(|(a, b)| same_shape(a, b))
            }
            _ => false,
        })
}

/// The owner of a rung's comment, where it is not simply the rung's own number.
fn rung_owner(comment: &Comment, file: u16, number: u32) -> Option<OwnerDoc<'_>> {
    let plain = comment.owner == CommentOwner::Rung { file, rung: number };
    let shown = !comment.title.is_empty() || !comment.text.is_empty();
    (!plain || !shown).then(|| owner(&comment.owner))
}

fn owner(owner: &CommentOwner) -> OwnerDoc<'_> {
    match owner {
        CommentOwner::Rung { file, rung } => OwnerDoc { file: Some(*file), rung: Some(*rung), ..OwnerDoc::default() },
        CommentOwner::Address(target) => {
            OwnerDoc { address: Some(target.to_string()), kind: Some(kind_of(target).into()), ..OwnerDoc::default() }
        }
    }
}

fn instruction(instruction: &Instruction) -> InstructionDoc<'_> {
    InstructionDoc {
        mnemonic: instruction.mnemonic.to_string(),
        operands: instruction.operands.iter().map(ToString::to_string).collect(),
        compiled: instruction.compiled,
        displayed: instruction.displayed.iter().map(option).collect(),
        message: instruction.message.as_ref().map(|setup| {
            let setting = |(name, value)| MessageSettingDoc { name: text(name), value: text(value) };
            setup.settings.iter().map(|(name, value)| setting((name.as_ref(), value.as_str()))).collect()
        }),
    }
}

fn data_file<'a>(file: &'a DataFile, io: &IoConfiguration) -> DataFileDoc<'a> {
    let values: Vec<_> = (0..file.elements).map(|element| value_of(file, element)).collect();
    let forces = (!file.forces.is_empty()).then(|| {
        // Masks of words that the file does not have are listed even where they force nothing: a short
        // document can then not ask for many of them.
        let listed = |word: usize, force: &Force| *force != Force::NONE || word >= file.words.len();
        let forced = file.forces.iter().enumerate().filter(|(word, force)| listed(*word, force));
        forced.map(|(word, force)| force_doc(file.file_type, io, word, *force)).collect()
    });
    DataFileDoc {
        number: file.number,
        file_type: file.file_type.to_string(),
        name: text(&file.name),
        description: text(&file.description),
        elements: file.elements,
        words: file.listed_words(),
        words_per_element: Some(file.words_per_element),
        raw: raw(file, &values),
        values,
        force_words: (forces.is_some() && file.forces.len() != file.words.len()).then_some(file.forces.len()),
        forces,
    }
}

/// The words that `values` do not give back, element by element, and those beyond the last element.
fn raw(file: &DataFile, values: &[ElementDoc<'_>]) -> Vec<RawDoc> {
    let size = usize::from(file.words_per_element);
    let (mut raw, mut told) = (Vec::new(), Vec::with_capacity(size));
    let mut at = 0;
    for value in values {
        let Some(words) = file.words.get(at..at + size) else { break };
        told.clear();
        // What the writer of values cannot say in words is listed like any other difference.
        if words_of(file.file_type, value, &mut told).is_err() || told != words {
            raw.push(RawDoc { word: at, words: signed(words) });
        }
        at += size;
    }
    match file.words.get(at..) {
        Some(rest) if !rest.is_empty() => raw.push(RawDoc { word: at, words: signed(rest) }),
        _ => {}
    }
    raw
}

fn force_doc(file_type: FileType, io: &IoConfiguration, word: usize, force: Force) -> ForceDoc {
    let bits = |mask: u16| (0..16).filter(|bit| mask >> bit & 1 != 0).collect();
    let address = u16::try_from(word).ok().and_then(|word| io.address_of(file_type, word));
    ForceDoc { word, address: address.map(|address| address.to_string()), on: bits(force.on), off: bits(!force.off) }
}

fn symbol(entry: &AddressEntry) -> SymbolDoc<'_> {
    SymbolDoc {
        address: entry.target.to_string(),
        symbol: text(&entry.symbol),
        description: lines(&entry.description),
        kind: Some(kind_of(&entry.target).into()),
    }
}

fn instruction_comment(comment: &InstructionComment) -> InstructionCommentDoc<'_> {
    InstructionCommentDoc {
        mnemonic: text(&comment.mnemonic),
        address: comment.target.as_ref().map(Target::to_string),
        description: lines(&comment.lines),
        kind: comment.target.as_ref().map(|target| kind_of(target).into()),
    }
}

fn detached_comment(comment: &Comment) -> DetachedCommentDoc<'_> {
    DetachedCommentDoc {
        title: non_empty(&comment.title),
        comment: non_empty(&comment.text),
        owner: owner(&comment.owner),
    }
}

fn slot(slot: &Slot) -> SlotDoc<'_> {
    SlotDoc {
        slot: slot.number,
        module: ModuleDoc {
            catalog: option(&slot.module.catalog),
            description: text(&slot.module.description),
            identity: text(&slot.module.identity),
            confidence: slot.module.confidence.as_str().into(),
        },
        inputs: range(slot.inputs),
        outputs: range(slot.outputs),
        configuration: signed(&slot.configuration),
    }
}

fn range(range: IoRange) -> RangeDoc {
    RangeDoc { first_word: range.first_word, words: range.words, bits: range.bits }
}

fn channel(channel: &Channel) -> ChannelDoc<'_> {
    let settings = channel.settings.iter().map(|setting| SettingDoc {
        name: text(&setting.name),
        value: text(&setting.value),
        confidence: setting.confidence.as_str().into(),
    });
    ChannelDoc {
        number: channel.number,
        driver: text(&channel.driver),
        settings: settings.collect(),
        unexplained_words: channel.unexplained_words,
    }
}

fn memory(memory: Memory) -> MemoryDoc {
    MemoryDoc {
        instruction_words_used: memory.instruction_words_used,
        instruction_words_left: memory.instruction_words_left,
        data_words_used: memory.data_words_used,
        data_words_left: memory.data_words_left,
    }
}

fn revision_note(note: &RevisionNote) -> RevisionNoteDoc<'_> {
    RevisionNoteDoc { revision: note.revision, note: text(&note.note) }
}

fn diagnostic(diagnostic: &Diagnostic) -> DiagnosticDoc<'_> {
    DiagnosticDoc {
        severity: diagnostic.severity.as_str().into(),
        place: text(&diagnostic.place),
        message: text(&diagnostic.message),
    }
}
