//! The report of a migration: what became of every rung, for people (HTML) and for programs (JSON).

mod html;

use ladder::{Image, Source};
use serde::Serialize;

use super::{Migration, Note, Options, Verdict, forms};

/// The schema of the JSON report.
pub const SCHEMA: &str = "rungs.migration/1";

/// Everything a report says.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// [`SCHEMA`].
    pub schema: &'static str,
    /// File name of the original.
    pub file: String,
    /// SHA-256 of the original.
    pub sha256: String,
    /// Processor of the original.
    pub processor: String,
    /// Only forms that Designer itself has written or read were to be used.
    pub only_confirmed: bool,
    /// Rungs by verdict.
    pub counts: Counts,
    /// What was not checked against Designer, in words.
    pub unchecked: &'static str,
    /// Forms of the result that no export shows.
    pub unconfirmed: Vec<Form>,
    /// What concerns the program as a whole.
    pub notes: Vec<NoteRow>,
    /// How often each code occurs.
    pub marks: Vec<MarkRow>,
    /// Rows of the proof run, name and value; absent when none was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub proof: Option<Vec<(String, String)>>,
    /// Every rung of the original.
    pub rungs: Vec<RungRow>,
}

/// Rungs by verdict.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Counts {
    /// All rungs, END left out.
    pub rungs: usize,
    /// Converted exactly.
    pub exact: usize,
    /// Converted with a stated condition.
    pub condition: usize,
    /// Needs a person.
    pub person: usize,
}

/// A form that was not confirmed.
#[derive(Clone, Debug, Serialize)]
pub struct Form {
    /// What it is.
    pub form: String,
    /// How it is known.
    pub evidence: &'static str,
    /// How often it is used.
    pub uses: usize,
}

/// A note with its code.
#[derive(Clone, Debug, Serialize)]
pub struct NoteRow {
    /// The code.
    pub code: &'static str,
    /// What it says.
    pub text: String,
}

/// How often a code occurs.
#[derive(Clone, Debug, Serialize)]
pub struct MarkRow {
    /// The code.
    pub code: &'static str,
    /// What it is about.
    pub title: &'static str,
    /// The vendor's PCE mark for the same trap, if it has one.
    pub pce: Option<u16>,
    /// Rungs with a condition of this code.
    pub conditions: usize,
    /// Rungs that need a person for this.
    pub persons: usize,
}

/// A rung.
#[derive(Clone, Debug, Serialize)]
pub struct RungRow {
    /// Program file of the original.
    pub file: u16,
    /// Rung of the original.
    pub rung: u32,
    /// `exact`, `condition` or `person`.
    pub verdict: &'static str,
    /// Conditions or reasons.
    pub notes: Vec<NoteRow>,
    /// The original as rung text.
    pub original: String,
    /// Code block of the result.
    pub block: String,
    /// Rung of that block, from 1 as Designer counts.
    pub block_rung: u32,
    /// The result, an instruction per row.
    pub result: Vec<String>,
}

/// What no report may leave out.
const UNCHECKED: &str = "No copy of Do-more Designer was available: nothing written here has been imported into it. \
    The text follows Designer's own exports; forms that no export shows are listed below with what is known of them. \
    What instructions do follows the vendor's help; readings of open questions are those listed in the documentation \
    of this program. Import the text into a new project, compare it with this report, and test without machinery \
    before use.";

impl From<&Note> for NoteRow {
    fn from(note: &Note) -> NoteRow {
        NoteRow { code: note.mark.code(), text: note.text.clone() }
    }
}

impl Report {
    /// The report of a migration.
    pub fn new(source: &Source, image: &Image, migration: &Migration, options: &Options) -> Report {
        let count = |verdict| migration.count(verdict);
        let marked = |mark, verdict| {
            let has =
                |rung: &&super::RungResult| rung.verdict == verdict && rung.notes.iter().any(|note| note.mark == mark);
            migration.rungs.iter().filter(has).count()
        };
        Report {
            schema: SCHEMA,
            file: source.file.clone(),
            sha256: source.sha256.clone(),
            processor: image.processor.family.to_string(),
            only_confirmed: options.only_confirmed,
            counts: Counts {
                rungs: migration.rungs.len(),
                exact: count(Verdict::Exact),
                condition: count(Verdict::Condition),
                person: count(Verdict::Person),
            },
            unchecked: UNCHECKED,
            unconfirmed: forms::unconfirmed(&migration.project)
                .into_iter()
                .map(|form| Form { form: form.form, evidence: form.evidence, uses: form.uses })
                .collect(),
            notes: migration.notes.iter().map(NoteRow::from).collect(),
            marks: super::Mark::all()
                .map(|mark| MarkRow {
                    code: mark.code(),
                    title: mark.title(),
                    pce: mark.pce(),
                    conditions: marked(mark, Verdict::Condition),
                    persons: marked(mark, Verdict::Person),
                })
                .filter(|row| row.conditions + row.persons > 0)
                .collect(),
            proof: None,
            rungs: migration
                .rungs
                .iter()
                .map(|rung| RungRow {
                    file: rung.file,
                    rung: rung.rung,
                    verdict: rung.verdict.as_str(),
                    notes: rung.notes.iter().map(NoteRow::from).collect(),
                    original: rung.original.clone(),
                    block: rung.block.clone(),
                    block_rung: rung.block_rung.saturating_add(1),
                    result: rung.code.clone(),
                })
                .collect(),
        }
    }

    /// The report as JSON.
    pub fn json(&self) -> String {
        // A report holds nothing that JSON cannot.
        let plain = serde_json::to_string_pretty(self).unwrap_or_default() + "\n";
        // JSON leaves DEL and the second set of control characters as they are; terminals may obey them.
        let command = |c: char| c.is_control() && c != '\n';
        if !plain.contains(command) {
            return plain;
        }
        let spelled = |c: char| if command(c) { format!("\\u{:04x}", u32::from(c)) } else { c.to_string() };
        plain.chars().map(spelled).collect()
    }

    /// The report as one HTML page that needs nothing else.
    pub fn html(&self) -> String {
        html::page(self)
    }
}
