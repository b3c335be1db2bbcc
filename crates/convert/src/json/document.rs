//! The shape of a JSON project, member by member, as plain data.
//!
//! These structs are the wire format and nothing else: the model stays free of it, so either can
//! change without the other. Names and meaning are those of the published JSON Schema. A member the
//! schema requires has no default here; every other one may be left out by whoever writes a document.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::value::ElementDoc;

type Text<'a> = Cow<'a, str>;

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// The whole document: the offline image, what surrounds it, and the other images.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Document<'a> {
    pub(super) schema: Text<'a>,
    pub(super) source: SourceDoc<'a>,
    pub(super) processor: ProcessorDoc<'a>,
    pub(super) program_files: Vec<ProgramFileDoc<'a>>,
    pub(super) data_files: Vec<DataFileDoc<'a>>,
    #[serde(default)]
    pub(super) function_files: Vec<DataFileDoc<'a>>,
    pub(super) symbols: Vec<SymbolDoc<'a>>,
    #[serde(default)]
    pub(super) instruction_comments: Vec<InstructionCommentDoc<'a>>,
    #[serde(default)]
    pub(super) detached_comments: Vec<DetachedCommentDoc<'a>>,
    pub(super) io: Vec<SlotDoc<'a>>,
    #[serde(default)]
    pub(super) io_base: IoBaseDoc<'a>,
    pub(super) channels: Vec<ChannelDoc<'a>>,
    #[serde(default)]
    pub(super) memory: Option<MemoryDoc>,
    #[serde(default)]
    pub(super) revision_notes: Vec<RevisionNoteDoc<'a>>,
    pub(super) diagnostics: Vec<DiagnosticDoc<'a>>,
    #[serde(default)]
    pub(super) online: Option<ImageDoc<'a>>,
    #[serde(default)]
    pub(super) autosave: Option<ImageDoc<'a>>,
}

/// One image: the members of [`Document`] that each image has of its own.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ImageDoc<'a> {
    pub(super) processor: ProcessorDoc<'a>,
    pub(super) program_files: Vec<ProgramFileDoc<'a>>,
    pub(super) data_files: Vec<DataFileDoc<'a>>,
    #[serde(default)]
    pub(super) function_files: Vec<DataFileDoc<'a>>,
    pub(super) symbols: Vec<SymbolDoc<'a>>,
    #[serde(default)]
    pub(super) instruction_comments: Vec<InstructionCommentDoc<'a>>,
    #[serde(default)]
    pub(super) detached_comments: Vec<DetachedCommentDoc<'a>>,
    pub(super) io: Vec<SlotDoc<'a>>,
    #[serde(default)]
    pub(super) io_base: IoBaseDoc<'a>,
    pub(super) channels: Vec<ChannelDoc<'a>>,
    #[serde(default)]
    pub(super) memory: Option<MemoryDoc>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SourceDoc<'a> {
    pub(super) file: Text<'a>,
    pub(super) sha256: Text<'a>,
    pub(super) saved_by: Text<'a>,
    #[serde(default)]
    pub(super) application: Text<'a>,
    #[serde(default)]
    pub(super) saved_at: Option<Text<'a>>,
    #[serde(default)]
    pub(super) created_at: Option<Text<'a>>,
    #[serde(default)]
    pub(super) bytes: u64,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ProcessorDoc<'a> {
    pub(super) catalog: Option<Text<'a>>,
    pub(super) name: Option<Text<'a>>,
    pub(super) family: Text<'a>,
    pub(super) project_name: Text<'a>,
    #[serde(default)]
    pub(super) family_confidence: Option<Text<'a>>,
    #[serde(default)]
    pub(super) evidence: Text<'a>,
    #[serde(default)]
    pub(super) model: Option<u16>,
    #[serde(default)]
    pub(super) main_program: Text<'a>,
    #[serde(default)]
    pub(super) program_id: Option<u16>,
    #[serde(default)]
    pub(super) reported_type: Option<u16>,
    #[serde(default)]
    pub(super) driver: Text<'a>,
    #[serde(default)]
    pub(super) route: Text<'a>,
    #[serde(default)]
    pub(super) deny_future_access: Option<bool>,
    #[serde(default)]
    pub(super) password_fields_used: Option<bool>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ProgramFileDoc<'a> {
    pub(super) number: u16,
    pub(super) name: Text<'a>,
    pub(super) description: Text<'a>,
    #[serde(rename = "type")]
    pub(super) kind: Text<'a>,
    pub(super) rungs: Vec<RungDoc<'a>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RungDoc<'a> {
    pub(super) number: u32,
    pub(super) title: Option<Text<'a>>,
    pub(super) comment: Option<Text<'a>>,
    pub(super) text: Text<'a>,
    #[serde(default)]
    pub(super) edited: bool,
    /// Left out when the comment hangs on the number of this very rung.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) comment_owner: Option<OwnerDoc<'a>>,
    /// Left out when the text alone gives branches and instructions back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) structure: Option<String>,
    /// Absent in documents that give text only.
    #[serde(default)]
    pub(super) instructions: Option<Vec<InstructionDoc<'a>>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InstructionDoc<'a> {
    pub(super) mnemonic: String,
    pub(super) operands: Vec<String>,
    #[serde(default)]
    pub(super) compiled: bool,
    #[serde(default, skip_serializing_if = "is_default")]
    pub(super) displayed: Vec<Option<Text<'a>>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) message: Option<Vec<MessageSettingDoc<'a>>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MessageSettingDoc<'a> {
    pub(super) name: Text<'a>,
    pub(super) value: Text<'a>,
}

/// What a comment hangs on: `file` and `rung`, or `address` with its kind.
#[derive(Serialize, Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct OwnerDoc<'a> {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) file: Option<u16>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) rung: Option<u32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) address: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) kind: Option<Text<'a>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DataFileDoc<'a> {
    pub(super) number: u16,
    #[serde(rename = "type")]
    pub(super) file_type: String,
    pub(super) name: Text<'a>,
    pub(super) description: Text<'a>,
    pub(super) elements: u16,
    pub(super) words: usize,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) words_per_element: Option<u16>,
    pub(super) values: Vec<ElementDoc<'a>>,
    /// Words that the values do not tell exactly.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) raw: Vec<RawDoc>,
    /// `None` for files that cannot be forced.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) forces: Option<Vec<ForceDoc>>,
    /// Left out when each word of the file has a force mask.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) force_words: Option<usize>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawDoc {
    pub(super) word: usize,
    pub(super) words: Vec<i16>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ForceDoc {
    pub(super) word: usize,
    /// For people; the word number decides.
    #[serde(default)]
    pub(super) address: Option<String>,
    pub(super) on: Vec<u8>,
    pub(super) off: Vec<u8>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SymbolDoc<'a> {
    pub(super) address: String,
    pub(super) symbol: Text<'a>,
    pub(super) description: Vec<Text<'a>>,
    #[serde(default)]
    pub(super) kind: Option<Text<'a>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InstructionCommentDoc<'a> {
    pub(super) mnemonic: Text<'a>,
    pub(super) address: Option<String>,
    pub(super) description: Vec<Text<'a>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) kind: Option<Text<'a>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DetachedCommentDoc<'a> {
    pub(super) title: Option<Text<'a>>,
    pub(super) comment: Option<Text<'a>>,
    pub(super) owner: OwnerDoc<'a>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SlotDoc<'a> {
    pub(super) slot: u16,
    pub(super) module: ModuleDoc<'a>,
    pub(super) inputs: RangeDoc,
    pub(super) outputs: RangeDoc,
    #[serde(default)]
    pub(super) configuration: Vec<i16>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ModuleDoc<'a> {
    pub(super) catalog: Option<Text<'a>>,
    pub(super) description: Text<'a>,
    pub(super) identity: Text<'a>,
    pub(super) confidence: Text<'a>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RangeDoc {
    pub(super) first_word: u16,
    pub(super) words: u16,
    pub(super) bits: u16,
}

#[derive(Serialize, Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct IoBaseDoc<'a> {
    #[serde(default)]
    pub(super) base_unit: Text<'a>,
    #[serde(default)]
    pub(super) unknown: Option<Text<'a>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ChannelDoc<'a> {
    pub(super) number: u16,
    pub(super) driver: Text<'a>,
    pub(super) settings: Vec<SettingDoc<'a>>,
    #[serde(default)]
    pub(super) unexplained_words: usize,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SettingDoc<'a> {
    pub(super) name: Text<'a>,
    pub(super) value: Text<'a>,
    pub(super) confidence: Text<'a>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MemoryDoc {
    pub(super) instruction_words_used: u32,
    pub(super) instruction_words_left: u32,
    pub(super) data_words_used: Option<u32>,
    pub(super) data_words_left: Option<u32>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RevisionNoteDoc<'a> {
    pub(super) revision: u32,
    pub(super) note: Text<'a>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DiagnosticDoc<'a> {
    pub(super) severity: Text<'a>,
    pub(super) place: Text<'a>,
    pub(super) message: Text<'a>,
}
