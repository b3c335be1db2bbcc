//! Search in a program: an address or symbol, an instruction with wildcards, a text, a regular expression.
//!
//! One query works on programs of every dialect: each decides for itself whether its first word is a mnemonic. A
//! text of several words that begins like an instruction (`add water`) is looked for as a text if no instruction matches.
//!
//! A pattern is a mnemonic and one word per operand, in the order of the box: `TON * 0.01 >=500 *`. `*` and `?` stand
//! for any characters, `>=500`, `<5`, `=3`, `!=0` compare numbers; operands not given can be anything. Preset and
//! accumulated value of a verified timer or counter are those of the data table, which the processor works with.

mod do_more;

use instr::Kind;
use ladder::{Address, Documentation, Image, Instruction, Number, Operand, Target, Value};
use regex::{Regex, RegexBuilder};

use crate::checks::context_form;
use crate::location::{Location, instructions};
use crate::xref::{CrossReference, Found};

pub use do_more::search_domore;

/// Hits listed of one program.
pub const MAX_HITS: usize = 10_000;

/// What is searched for.
#[derive(Clone, Debug)]
pub enum Query {
    /// Decided by each program: an instruction pattern, else an address or symbol it knows, else a text.
    Any(String),
    /// A regular expression over instructions, symbols, descriptions and comments.
    Regex(Regex),
}

impl Query {
    /// What a person means by a text.
    pub fn new(text: &str) -> Query {
        Query::Any(text.trim().to_owned())
    }

    /// A regular expression; upper and lower case are the same unless it says `(?-i)`.
    ///
    /// # Errors
    /// Why it is none, or that it is too large.
    pub fn regex(text: &str) -> Result<Query, String> {
        let built = RegexBuilder::new(text).case_insensitive(true).build();
        built.map(Query::Regex).map_err(|error| error.to_string())
    }
}

/// A place where something was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hit {
    /// The rung; `None` for documentation that belongs to no rung. Of Do-more its file is the place of the code block
    /// in the text, from 1.
    pub location: Option<Location>,
    /// `instruction`, `read`, `write`, `read/write`, `comment`, `title`, `symbol`, `description`, `instruction comment`,
    /// `program file`, `data file`, `detached comment`; of Do-more also `nickname`, `code block`, `memory`, `device` and
    /// the roles of its cross reference.
    pub kind: &'static str,
    /// The instruction, address or text.
    pub text: String,
    /// What documentation without a rung is about; `None` where that is nothing one could look at.
    pub about: Option<About>,
}

/// What documentation can be about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum About {
    /// An address of the data table, an element of Do-more.
    Address(String),
    /// A program file by its number, a code block by its place in the text, from 1.
    ProgramFile(u16),
    /// A data file by its number.
    DataFile(u16),
}

impl About {
    fn of(target: &Target) -> Option<About> {
        Some(match target {
            Target::Address(address) => About::Address(address.to_string()),
            Target::ProgramFileOperand(file) | Target::ProgramFile(file) | Target::Label { file, .. } => {
                About::ProgramFile(*file)
            }
            Target::DataFile(file) => About::DataFile(*file),
            Target::Unassigned | Target::Other(_) => return None,
        })
    }
}

/// What a search found.
#[derive(Clone, Debug, Default)]
pub struct Hits {
    /// Rungs first, in program order.
    pub list: Vec<Hit>,
    /// Hits beyond [`MAX_HITS`].
    pub not_listed: usize,
}

impl Hits {
    fn add(&mut self, location: Option<Location>, kind: &'static str, text: impl FnOnce() -> String) {
        if self.list.len() < MAX_HITS {
            self.list.push(Hit { location, kind, text: text(), about: None });
        } else {
            self.not_listed += 1;
        }
    }

    /// Documentation that belongs to no rung.
    fn add_about(&mut self, about: Option<About>, kind: &'static str, text: impl FnOnce() -> String) {
        if self.list.len() < MAX_HITS {
            self.list.push(Hit { location: None, kind, text: text(), about });
        } else {
            self.not_listed += 1;
        }
    }
}

/// Searches an image. `documentation` may be that of another image: the online image has none of its own.
pub fn search(image: &Image, documentation: &Documentation, query: &Query) -> Hits {
    let mut hits = Hits::default();
    match query {
        Query::Regex(regex) => texts(image, documentation, true, &|text| regex.is_match(text), &mut hits),
        Query::Any(text) => {
            if let Some(pattern) = Pattern::parse(text, |word| instr::by_mnemonic(word).is_some()) {
                for (at, it) in instructions(image).filter(|(_, it)| matches(&pattern, image, it)) {
                    hits.add(Some(at), "instruction", || written(it));
                }
            }
            let is_mnemonic = instr::by_mnemonic(&text.to_ascii_uppercase()).is_some();
            if !is_mnemonic && hits.list.is_empty() && !addresses(image, documentation, text, &mut hits) {
                let lower = text.to_lowercase();
                texts(image, documentation, false, &|text| text.to_lowercase().contains(&lower), &mut hits);
            }
        }
    }
    hits
}

/// An instruction as rung text.
fn written(it: &Instruction) -> String {
    let mut text = it.mnemonic.to_string();
    for operand in it.operands.iter().filter(|operand| !matches!(operand, Operand::Empty)) {
        text.push_str(&format!(" {operand}"));
    }
    text
}

/// Accesses of an address, symbol or data file; `false` when the text is none of these here.
fn addresses(image: &Image, documentation: &Documentation, text: &str, hits: &mut Hits) -> bool {
    let xref = CrossReference::build(image, documentation);
    let groups = match xref.find(text) {
        Some(Found::Address(group)) => vec![group],
        Some(Found::File { groups, .. }) => groups,
        Some(Found::ProgramFile(_) | Found::Label { .. }) => {
            for (at, it) in instructions(image) {
                let names = |operand: &Operand| operand.to_string().eq_ignore_ascii_case(text);
                if it.operands.iter().any(names) {
                    hits.add(Some(at), "instruction", || written(it));
                }
            }
            return true;
        }
        None => return false,
    };
    let mut all: Vec<_> = groups.iter().flat_map(|group| &group.accesses).collect();
    all.sort_by_key(|access| access.location);
    for access in all {
        hits.add(Some(access.location), access.role.as_str(), || {
            format!("{} {} ({})", access.mnemonic, access.address, access.certainty.as_str())
        });
    }
    hits.not_listed += groups.iter().filter_map(|group| group.left_out).sum::<usize>();
    true
}

/// Texts of documentation, and of instructions when asked for.
fn texts(
    image: &Image,
    documentation: &Documentation,
    with_instructions: bool,
    is: &dyn Fn(&str) -> bool,
    hits: &mut Hits,
) {
    for file in image.ladder_files() {
        if is(&file.name) || is(&file.description) {
            hits.add_about(Some(About::ProgramFile(file.number)), "program file", || {
                format!("{} {} {}", file.number, file.name, file.description)
            });
        }
        for (number, rung) in (0..).zip(&file.rungs) {
            let at = Location { file: file.number, rung: number, instruction: 0 };
            if let Some(comment) = &rung.comment {
                if is(&comment.title) {
                    hits.add(Some(at), "title", || comment.title.clone());
                }
                if is(&comment.text) {
                    hits.add(Some(at), "comment", || comment.text.clone());
                }
            }
            if with_instructions {
                for (instruction, it) in (0..).zip(rung.instructions()) {
                    let text = written(it);
                    if is(&text) {
                        hits.add(Some(Location { instruction, ..at }), "instruction", || text);
                    }
                }
            }
        }
    }
    for entry in documentation.entries() {
        if is(&entry.symbol) {
            hits.add_about(About::of(&entry.target), "symbol", || format!("{} {}", entry.target, entry.symbol));
        }
        let description = entry.description.join(" ");
        if is(&description) {
            hits.add_about(About::of(&entry.target), "description", || {
                format!("{} {} {description}", entry.target, entry.symbol)
            });
        }
    }
    for comment in documentation.instruction_comments() {
        let text = comment.lines.join(" ");
        if is(&text) {
            let target = comment.target.as_ref().map(ToString::to_string).unwrap_or_default();
            hits.add_about(comment.target.as_ref().and_then(About::of), "instruction comment", || {
                format!("{} {target} {text}", comment.mnemonic)
            });
        }
    }
    for comment in documentation.detached_comments.iter().filter(|it| is(&it.text) || is(&it.title)) {
        hits.add(None, "detached comment", || format!("{} {}", comment.title, comment.text));
    }
    for file in image.data_files.iter().filter(|file| is(&file.name) || is(&file.description)) {
        hits.add_about(Some(About::DataFile(file.number)), "data file", || {
            format!("{} {} {}", file.label(), file.name, file.description)
        });
    }
}

/// An instruction with wildcards.
struct Pattern<'t> {
    mnemonic: &'t str,
    operands: Vec<Test<'t>>,
}

enum Test<'t> {
    Like(&'t str),
    Compare(fn(&f64, &f64) -> bool, f64),
}

type Comparison = fn(&f64, &f64) -> bool;

const COMPARISONS: &[(&str, Comparison)] =
    &[(">=", f64::ge), ("<=", f64::le), ("!=", f64::ne), (">", f64::gt), ("<", f64::lt), ("=", f64::eq)];

impl<'t> Pattern<'t> {
    /// `None` when the first word is no mnemonic and no wildcard before operands.
    fn parse(text: &'t str, is_mnemonic: impl Fn(&str) -> bool) -> Option<Pattern<'t>> {
        let mut words = text.split_whitespace();
        let mnemonic = words.next()?;
        let operands: Vec<Test<'t>> = words.map(Test::parse).collect();
        let known = is_mnemonic(&mnemonic.to_ascii_uppercase());
        let wild = mnemonic.contains('*') && mnemonic.bytes().all(|b| b.is_ascii_alphabetic() || b == b'*');
        (known || (wild && !operands.is_empty())).then_some(Pattern { mnemonic, operands })
    }
}

fn matches(pattern: &Pattern<'_>, image: &Image, it: &Instruction) -> bool {
    like(pattern.mnemonic, &it.mnemonic.to_string())
        && pattern.operands.len() <= it.operands.len()
        && pattern.operands.iter().enumerate().all(|(index, test)| holds(test, image, it, index))
}

impl<'t> Test<'t> {
    fn parse(word: &'t str) -> Test<'t> {
        for (sign, compare) in COMPARISONS {
            if let Some(number) = word.strip_prefix(sign).and_then(|rest| rest.parse().ok()) {
                return Test::Compare(*compare, number);
            }
        }
        Test::Like(word)
    }
}

fn holds(test: &Test<'_>, image: &Image, it: &Instruction, index: usize) -> bool {
    let Some(operand) = it.operands.get(index) else { return false };
    let number = number(image, it, index, operand);
    match test {
        Test::Compare(compare, wanted) => number.is_some_and(|number| compare(&number, wanted)),
        Test::Like(word) => {
            let same = word.parse::<f64>().is_ok_and(|wanted| number == Some(wanted));
            // `B3/17` and `B3:1/1` are one address.
            let address = || Address::parse(word).is_ok_and(|address| operand.address() == Some(&address));
            let shown = number.filter(|_| operand.constant().is_some_and(|it| it.as_integer().is_some()));
            let text = shown.map_or_else(|| operand.to_string(), |number| number.to_string());
            // What a box showed before the data table got another value.
            let stale =
                shown.is_some() && shown != operand.constant().and_then(|it| it.as_integer()).map(|it| it as f64);
            same || address() || (!stale && like(word, &operand.to_string())) || like(word, &text)
        }
    }
}

/// The number of a constant, or the preset or accumulated value in force. Time bases compare exactly.
fn number(image: &Image, it: &Instruction, index: usize, operand: &Operand) -> Option<f64> {
    let info = it.mnemonic.name().and_then(instr::by_mnemonic);
    let kind = info.and_then(|info| context_form(info, image, it)?.operands.get(index)).map(|operand| operand.kind);
    let word = match kind {
        Some(Kind::Preset) => Some(1),
        Some(Kind::Accum) => Some(2),
        _ => None,
    };
    if let (Some(word), true, Some(Operand::Address(element))) = (word, it.compiled, it.operands.first())
        && let Some(Value::Word(value)) = image.value_at(&element.clone().with_word(word))
    {
        return Some(value.into());
    }
    match operand.constant()?.number() {
        Number::Integer(number) => Some(number as f64),
        // As it is written: 0.01 as a float is not 0.01.
        Number::Float(_) => operand.to_string().parse().ok(),
    }
}

/// `*` stands for any characters and `?` for one; upper and lower case are the same.
fn like(pattern: &str, text: &str) -> bool {
    let (pattern, text) = (pattern.as_bytes(), text.as_bytes());
    let (mut p, mut t, mut star) = (0, 0, None);
    loop {
        match (pattern.get(p), text.get(t)) {
            (Some(b'*'), _) => {
                star = Some((p + 1, t));
                p += 1;
            }
            (Some(wanted), Some(found)) if *wanted == b'?' || wanted.eq_ignore_ascii_case(found) => {
                p += 1;
                t += 1;
            }
            (None, None) => return true,
            _ => match star {
                Some((after, from)) if from < text.len() => {
                    star = Some((after, from + 1));
                    (p, t) = (after, from + 1);
                }
                _ => return false,
            },
        }
    }
}
