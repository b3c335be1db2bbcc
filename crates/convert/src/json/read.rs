//! From the shape of a JSON document to the model.

use std::borrow::Cow;
use std::collections::HashSet;

use ladder::{
    AddressEntry, Channel, Comment, CommentOwner, Confidence, DataFile, Diagnostic, Documentation, Element, Family,
    FileType, Image, Instruction, InstructionComment, IoConfiguration, IoRange, Memory, MessageSetup, Mnemonic, Module,
    Operand, Processor, ProgramFile, ProgramFileKind, Project, RevisionNote, Rung, Setting, Severity, Slot, Source,
    Target,
};

use super::data_file::data_file;
use super::document::*;
use super::error::JsonError;
use super::path::{Path, quoted};
use super::structure::series_from;
use super::target::target_from;
use crate::limits::{self, MAX_DATA_WORDS, MAX_PARTS, Parts};
use crate::slc::rung::{parse_rung, rung_text};

type Result<T> = std::result::Result<T, JsonError>;

pub(super) fn project(document: Document<'_>) -> Result<Project> {
    let path = Path::whole();
    if document.schema != super::SCHEMA {
        return Err(path.member("schema").error(quoted(super::SCHEMA), quoted(&document.schema)));
    }
    let main = ImageDoc {
        processor: document.processor,
        program_files: document.program_files,
        data_files: document.data_files,
        function_files: document.function_files,
        symbols: document.symbols,
        instruction_comments: document.instruction_comments,
        detached_comments: document.detached_comments,
        io: document.io,
        io_base: document.io_base,
        channels: document.channels,
        memory: document.memory,
    };
    let other = |name, doc: Option<ImageDoc<'_>>| doc.map(|doc| image(doc, &path.member(name))).transpose();
    Ok(Project {
        source: source(document.source),
        main: image(main, &path)?,
        online: other("online", document.online)?,
        autosave: other("autosave", document.autosave)?,
        revision_notes: document.revision_notes.into_iter().map(revision_note).collect(),
        diagnostics: path.each("diagnostics", document.diagnostics, diagnostic)?,
    })
}

fn option(text: Option<Cow<'_, str>>) -> Option<String> {
    text.map(Cow::into_owned)
}

fn lines(lines: Vec<Cow<'_, str>>) -> Vec<String> {
    lines.into_iter().map(Cow::into_owned).collect()
}

/// The value that writes itself as `text`.
fn named<T>(
    all: impl IntoIterator<Item = T>,
    name: impl Fn(&T) -> &'static str,
    text: &str,
    path: Path<'_>,
) -> Result<T> {
    let mut names = Vec::new();
    for value in all {
        if name(&value) == text {
            return Ok(value);
        }
        names.push(name(&value));
    }
    Err(path.error(format!("one of {}", names.join(", ")), quoted(text)))
}

fn confidence(text: &str, path: Path<'_>) -> Result<Confidence> {
    use Confidence::*;
    named([Unknown, Weak, Inferred, Published, Proven], |confidence| confidence.as_str(), text, path)
}

fn source(doc: SourceDoc<'_>) -> Source {
    Source {
        file: doc.file.into_owned(),
        sha256: doc.sha256.into_owned(),
        bytes: doc.bytes,
        saved_by: doc.saved_by.into_owned(),
        application: doc.application.into_owned(),
        saved_at: option(doc.saved_at),
        created_at: option(doc.created_at),
    }
}

fn image(doc: ImageDoc<'_>, path: &Path<'_>) -> Result<Image> {
    let processor = processor(doc.processor, &path.member("processor"))?;
    let family = processor.family;
    let mut documentation = Documentation::default();
    for entry in path.each("symbols", doc.symbols, symbol)? {
        documentation.add(entry);
    }
    for comment in path.each("instruction_comments", doc.instruction_comments, instruction_comment)? {
        documentation.add_instruction_comment(comment);
    }
    let mut words = 0;
    documentation.detached_comments = path.each("detached_comments", doc.detached_comments, detached_comment)?;
    Ok(Image {
        processor,
        program_files: program_files(doc.program_files, family, &path.member("program_files"))?,
        data_files: data_files(doc.data_files, &mut words, &path.member("data_files"))?,
        function_files: data_files(doc.function_files, &mut words, &path.member("function_files"))?,
        io: IoConfiguration {
            slots: path.each("io", doc.io, slot)?,
            base_unit: doc.io_base.base_unit.into_owned(),
            unknown: option(doc.io_base.unknown),
        },
        channels: path.each("channels", doc.channels, channel)?,
        memory: doc.memory.map(memory),
        documentation,
    })
}

fn data_files(docs: Vec<DataFileDoc<'_>>, words: &mut usize, path: &Path<'_>) -> Result<Vec<DataFile>> {
    let mut files = Vec::with_capacity(docs.len());
    let mut seen = HashSet::new();
    for (index, doc) in docs.into_iter().enumerate() {
        let path = path.index(index);
        let file = data_file(doc, &path)?;
        // M0 and M1 are numbered on their own, and so is each kind of function file.
        let apart = file.file_type.is_function_file() || matches!(file.file_type, FileType::M0 | FileType::M1);
        if !seen.insert((file.number, apart.then_some(file.file_type))) {
            return Err(path.member("number").error("each file once", format!("another file {}", file.number)));
        }
        if !limits::admit_words(words, file.words.len()) {
            return Err(path.error(format!("data files of at most {MAX_DATA_WORDS} words together"), "more"));
        }
        files.push(file);
    }
    Ok(files)
}

fn processor(doc: ProcessorDoc<'_>, path: &Path<'_>) -> Result<Processor> {
    let family_confidence = match doc.family_confidence {
        Some(text) => confidence(&text, path.member("family_confidence"))?,
        None => Confidence::Unknown,
    };
    // Two members that name the controller must not name two.
    if let (Some(model), Some(catalog)) = (doc.model.and_then(rss::tables::processor_model), &doc.catalog)
        && !catalog.eq_ignore_ascii_case(model.catalog)
    {
        let expected = format!("{} as the model {} has", quoted(model.catalog), model.code);
        return Err(path.member("catalog").error(expected, quoted(catalog)));
    }
    Ok(Processor {
        model: doc.model,
        catalog: option(doc.catalog),
        name: option(doc.name),
        family: named(Family::all(), |family| family.id(), &doc.family, path.member("family"))?,
        family_confidence,
        evidence: doc.evidence.into_owned(),
        project_name: doc.project_name.into_owned(),
        main_program: doc.main_program.into_owned(),
        program_id: doc.program_id,
        reported_type: doc.reported_type,
        driver: doc.driver.into_owned(),
        route: doc.route.into_owned(),
        deny_future_access: doc.deny_future_access,
        password_fields_used: doc.password_fields_used,
    })
}

fn program_files(docs: Vec<ProgramFileDoc<'_>>, family: Family, path: &Path<'_>) -> Result<Vec<ProgramFile>> {
    let mut parts = Parts::default();
    let mut seen = HashSet::new();
    if let Some((index, doc)) = docs.iter().enumerate().find(|(_, doc)| !seen.insert(doc.number)) {
        let found = format!("another file {}", doc.number);
        return Err(path.index(index).member("number").error("each file once", found));
    }
    let files = docs.into_iter().enumerate();
    files.map(|(index, doc)| program_file(doc, family, &mut parts, &path.index(index))).collect()
}

fn program_file(doc: ProgramFileDoc<'_>, family: Family, parts: &mut Parts, path: &Path<'_>) -> Result<ProgramFile> {
    use ProgramFileKind::*;
    let number = doc.number;
    let kind = named([System, Ladder, Unused], |kind| kind.as_str(), &doc.kind, path.member("type"))?;
    let list = path.member("rungs");
    let rungs = doc.rungs.into_iter().enumerate().map(|(index, doc)| {
        let path = list.index(index);
        if usize::try_from(doc.number) != Ok(index) {
            return Err(path.member("number").error(index.to_string(), doc.number.to_string()));
        }
        let rung = rung(doc, number, family, &path)?;
        if !parts.admit(limits::of_rung(&rung.series)) {
            let expected = format!("a program of at most {MAX_PARTS} rungs, instructions, operands and branches");
            return Err(path.error(expected, "more"));
        }
        Ok(rung)
    });
    Ok(ProgramFile {
        number,
        name: doc.name.into_owned(),
        description: doc.description.into_owned(),
        kind,
        rungs: rungs.collect::<Result<_>>()?,
    })
}

fn rung(doc: RungDoc<'_>, file: u16, family: Family, path: &Path<'_>) -> Result<Rung> {
    let mut rung = match doc.structure {
        Some(structure) => {
            let list = doc.instructions.unwrap_or_default();
            let instructions = list.into_iter().map(|doc| {
                let operands = doc.operands.iter().map(|text| Operand::parse(text)).collect();
                let mut instruction = Instruction::new(mnemonic(&doc.mnemonic), operands);
                add_extras(&mut instruction, doc.compiled, doc.displayed, doc.message);
                instruction
            });
            let series = series_from(&structure, instructions.collect());
            Rung::new(series.map_err(|(expected, found)| path.member("structure").error(expected, quoted(&found)))?)
        }
        None => {
            let read = parse_rung(&doc.text, Some(family));
            let mut rung = read.map_err(|error| {
                let place = format!("line {}, column {}", error.line, error.column);
                let found = if error.found.is_empty() { "the end".to_owned() } else { quoted(&error.found) };
                path.member("text").error(error.expected, format!("{found} at {place}"))
            })?;
            if let Some(list) = doc.instructions {
                let read_text = rung_text(&rung);
                let mut list = list.into_iter().enumerate();
                let list_path = path.member("instructions");
                overlay(&mut rung.series, &mut list, &list_path)?;
                if let Some((index, extra)) = list.next() {
                    return Err(list_path.index(index).error("no more instructions than the text has", extra.mnemonic));
                }
                // What the list holds must be what the text says, however either is spelled.
                let listed = rung_text(&rung);
                if listed != doc.text && listed != read_text {
                    let expected = format!("the operands of the text, {}", quoted(&doc.text));
                    return Err(list_path.error(expected, quoted(&listed)));
                }
            }
            rung
        }
    };
    rung.edited = doc.edited;
    let own = || CommentOwner::Rung { file, rung: doc.number };
    let has_comment = doc.title.is_some() || doc.comment.is_some() || doc.comment_owner.is_some();
    if has_comment {
        let owner = doc.comment_owner.map(|doc| owner(doc, &path.member("comment_owner"))).transpose()?;
        rung.comment = Some(comment(doc.title, doc.comment, owner.unwrap_or_else(own)));
    }
    Ok(rung)
}

/// Replaces what the text says of each instruction by what the list says: the list holds operands as
/// stored and everything that text has no words for.
fn overlay<'a>(
    series: &mut [Element],
    list: &mut impl Iterator<Item = (usize, InstructionDoc<'a>)>,
    path: &Path<'_>,
) -> Result<()> {
    for element in series {
        match element {
            Element::Branch(branch) => {
                for leg in &mut branch.legs {
                    overlay(leg, list, path)?;
                }
            }
            Element::Instruction(instruction) => {
                let Some((index, doc)) = list.next() else {
                    return Err(path.error(format!("{} of the text", instruction.mnemonic), "the end of the list"));
                };
                let path = path.index(index);
                if mnemonic(&doc.mnemonic) != instruction.mnemonic {
                    let expected = format!("{} as in the text", instruction.mnemonic);
                    return Err(path.member("mnemonic").error(expected, quoted(&doc.mnemonic)));
                }
                let from_text = std::mem::take(&mut instruction.operands);
                let mut from_text = from_text.into_iter();
                instruction.operands = doc
                    .operands
                    .iter()
                    .map(|text| match from_text.next() {
                        // The text's reader knows what the instruction has there; the same words are
                        // typed by it.
                        Some(operand) if operand.to_string() == *text => operand,
                        _ => Operand::parse(text),
                    })
                    .collect();
                add_extras(instruction, doc.compiled, doc.displayed, doc.message);
            }
        }
    }
    Ok(())
}

fn add_extras(
    instruction: &mut Instruction,
    compiled: bool,
    displayed: Vec<Option<Cow<'_, str>>>,
    message: Option<Vec<MessageSettingDoc<'_>>>,
) {
    instruction.compiled = compiled;
    instruction.displayed = displayed.into_iter().map(option).collect();
    instruction.message = message.map(|settings| {
        let settings = settings.into_iter();
        let setting = |doc: MessageSettingDoc<'_>| (Cow::Owned(doc.name.into_owned()), doc.value.into_owned());
        Box::new(MessageSetup { settings: settings.map(setting).collect() })
    });
}

/// `op0x4D` is an operation code without a known name.
fn mnemonic(text: &str) -> Mnemonic {
    let code = text.strip_prefix("op0x").and_then(|digits| u16::from_str_radix(digits, 16).ok());
    code.map_or_else(|| Mnemonic::named(text.to_owned()), Mnemonic::Unknown)
}

fn comment(title: Option<Cow<'_, str>>, text: Option<Cow<'_, str>>, owner: CommentOwner) -> Comment {
    Comment { text: option(text).unwrap_or_default(), title: option(title).unwrap_or_default(), owner }
}

fn owner(doc: OwnerDoc<'_>, path: &Path<'_>) -> Result<CommentOwner> {
    match (doc.file, doc.rung, doc.address) {
        (Some(file), Some(rung), None) if doc.kind.is_none() => Ok(CommentOwner::Rung { file, rung }),
        (None, None, Some(address)) => Ok(CommentOwner::Address(target(doc.kind, &address, path)?)),
        _ => Err(path.error("file and rung, or address and kind", "other members")),
    }
}

fn target(kind: Option<Cow<'_, str>>, address: &str, path: &Path<'_>) -> Result<Target> {
    target_from(kind.as_deref(), address).map_err(|expected| match kind {
        Some(kind) if expected.starts_with("address, ") => {
            path.member("kind").error(format!("one of {expected}"), quoted(&kind))
        }
        _ => path.member("address").error(expected, quoted(address)),
    })
}

fn symbol(doc: SymbolDoc<'_>, path: Path<'_>) -> Result<AddressEntry> {
    Ok(AddressEntry {
        target: target(doc.kind, &doc.address, &path)?,
        symbol: doc.symbol.into_owned(),
        description: lines(doc.description),
    })
}

fn instruction_comment(doc: InstructionCommentDoc<'_>, path: Path<'_>) -> Result<InstructionComment> {
    let (kind, address) = (doc.kind, doc.address);
    Ok(InstructionComment {
        mnemonic: doc.mnemonic.into_owned(),
        target: address.map(|address| target(kind, &address, &path)).transpose()?,
        lines: lines(doc.description),
    })
}

fn detached_comment(doc: DetachedCommentDoc<'_>, path: Path<'_>) -> Result<Comment> {
    Ok(comment(doc.title, doc.comment, owner(doc.owner, &path.member("owner"))?))
}

fn slot(doc: SlotDoc<'_>, path: Path<'_>) -> Result<Slot> {
    let range = |doc: RangeDoc| IoRange { first_word: doc.first_word, words: doc.words, bits: doc.bits };
    let module = path.member("module");
    Ok(Slot {
        number: doc.slot,
        module: Module {
            confidence: confidence(&doc.module.confidence, module.member("confidence"))?,
            catalog: option(doc.module.catalog),
            description: doc.module.description.into_owned(),
            identity: doc.module.identity.into_owned(),
        },
        inputs: range(doc.inputs),
        outputs: range(doc.outputs),
        configuration: doc.configuration.into_iter().map(|word| word as u16).collect(),
    })
}

fn channel(doc: ChannelDoc<'_>, path: Path<'_>) -> Result<Channel> {
    Ok(Channel {
        number: doc.number,
        driver: doc.driver.into_owned(),
        settings: path.each("settings", doc.settings, |doc, path| {
            Ok(Setting {
                confidence: confidence(&doc.confidence, path.member("confidence"))?,
                name: doc.name.into_owned(),
                value: doc.value.into_owned(),
            })
        })?,
        unexplained_words: doc.unexplained_words,
    })
}

fn memory(doc: MemoryDoc) -> Memory {
    Memory {
        instruction_words_used: doc.instruction_words_used,
        instruction_words_left: doc.instruction_words_left,
        data_words_used: doc.data_words_used,
        data_words_left: doc.data_words_left,
    }
}

fn revision_note(doc: RevisionNoteDoc<'_>) -> RevisionNote {
    RevisionNote { revision: doc.revision, note: doc.note.into_owned() }
}

fn diagnostic(doc: DiagnosticDoc<'_>, path: Path<'_>) -> Result<Diagnostic> {
    use Severity::*;
    Ok(Diagnostic {
        severity: named([Note, Warning, Error], |s| s.as_str(), &doc.severity, path.member("severity"))?,
        place: doc.place.into_owned(),
        message: doc.message.into_owned(),
    })
}
