//! What the conversions of all instructions share: places, helpers, notes of the rung at hand.

use std::collections::{BTreeMap, BTreeSet};

use instr::exec::{Lineage, Rules};
use ladder::{Image, Instruction};

use super::Options;
use super::allocate::{Block, Element, Places};
use super::control::Flow;
use super::emit::Emitter;
use super::facts::Facts;
use super::interrupts::Timed;
use super::marks::{Mark, Note};
use super::operand::Bit;

/// Why an instruction has no conversion: its rung needs a person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Person(pub Note);

impl Person {
    /// A reason.
    pub fn new(mark: Mark, text: impl Into<String>) -> Person {
        Person(Note::new(mark, text))
    }
}

/// What an instruction's conversion answers.
pub type Converted<T = ()> = Result<T, Person>;

/// Appends an instruction to the rung. The power flow it gets is at the top of the stack; the one it
/// hands on is there afterwards.
pub type Convert = fn(&mut Context<'_>, &mut Emitter, &Instruction) -> Converted;

/// State of a migration while rungs are converted.
pub struct Context<'a> {
    /// The program.
    pub image: &'a Image,
    /// Its processor's rules.
    pub rules: Rules,
    /// What the program does with its data.
    pub facts: &'a Facts,
    /// Settings.
    pub options: &'a Options,
    /// Where data lies. Helpers are added at the end of the blocks.
    pub places: Places,
    /// The rung at hand is not executed in every scan: it stands in a subroutine or behind a jump.
    pub conditional: bool,
    /// Conditions under which the rung at hand is converted exactly.
    pub conditions: BTreeSet<Note>,
    /// Helpers with a meaning: what they are for, in words, and a proposed nickname.
    pub helpers: BTreeMap<Element, Helper>,
    named: BTreeMap<String, Element>,
    /// The real-time clock file is read.
    pub reads_rtc: bool,
    /// Instructions of the rung at hand behind the one at hand.
    pub(super) left: usize,
    /// A bit that is ON when a jump before the instruction at hand, in its rung, was taken.
    pub(super) jumped: Option<String>,
    /// Where the rung at hand stands.
    pub(super) flow: Option<Flow>,
    /// The timed interrupt of the program.
    pub(super) timed: Option<Timed>,
    /// Names of the subroutines that called files became.
    pub(super) subroutines: BTreeMap<u16, String>,
    /// Status words that are computed at the beginning of each scan.
    pub status_words: BTreeSet<u16>,
    /// Things other than rungs the program needs.
    pub needs: Needs,
}

/// A helper element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Helper {
    /// Nickname to propose, at most 16 characters.
    pub nickname: String,
    /// What it holds.
    pub text: String,
}

/// What the beginning and the end of the program must do besides the rungs.
#[derive(Clone, Debug, Default)]
pub struct Needs {
    /// Milliseconds since the previous scan are needed.
    pub elapsed: bool,
    /// The running millisecond count is needed, for what is not executed in every scan.
    pub now: bool,
    /// Timers that are not executed in every scan, as `T4:0`.
    pub apart: BTreeSet<String>,
    /// Bits that are switched off in the first scan after entering RUN, before all rungs.
    pub clear: BTreeSet<String>,
    /// The same of bits that are found at run time.
    pub clear_found: Vec<Bit>,
    /// Bits that are switched on then.
    pub set: BTreeSet<String>,
    /// Minor error bits of S:5 are set by rungs: the end of the scan has to look.
    pub minor_errors: bool,
}

impl<'a> Context<'a> {
    /// A context.
    pub fn new(image: &'a Image, facts: &'a Facts, options: &'a Options, places: Places) -> Context<'a> {
        Context {
            image,
            rules: Rules::of(image.processor.family),
            facts,
            options,
            places,
            conditional: false,
            conditions: BTreeSet::new(),
            helpers: BTreeMap::new(),
            named: BTreeMap::new(),
            reads_rtc: false,
            left: 0,
            jumped: None,
            flow: None,
            timed: None,
            subroutines: BTreeMap::new(),
            status_words: BTreeSet::new(),
            needs: Needs::default(),
        }
    }

    /// The rung at hand is converted exactly only if this holds.
    pub fn condition(&mut self, mark: Mark, text: impl Into<String>) {
        self.conditions.insert(Note::new(mark, text));
    }

    /// The processor is SLC 500 or MicroLogix 1000.
    pub fn slc_like(&self) -> bool {
        self.rules.lineage.is_slc_like()
    }

    /// S:24 exists and indexes operands written with `#`.
    pub fn indexes(&self) -> bool {
        matches!(self.rules.lineage, Lineage::S2 | Lineage::S3 | Lineage::M10)
    }

    /// The helper of this name, one per name for the whole program: the same element each time. The
    /// name is its nickname (at most 16 characters), `text` says what it holds.
    pub fn helper(&mut self, block: Block, name: &str, text: &str) -> String {
        if let Some(element) = self.named.get(name) {
            return element.to_string();
        }
        let element = self.places.helper(block);
        self.named.insert(name.to_owned(), element);
        self.helpers.insert(element, Helper { nickname: name.to_owned(), text: text.to_owned() });
        element.to_string()
    }

    /// A D word that holds a value between two instructions of one rung; `number` tells several apart.
    pub fn scratch_long(&mut self, number: usize) -> String {
        self.helper(Block::D, &format!("slcTemp{number}"), "intermediate result, free after its rung")
    }

    /// As [`Context::scratch_long`] for floats.
    pub fn scratch_float(&mut self, number: usize) -> String {
        self.helper(Block::R, &format!("slcTempR{number}"), "intermediate result, free after its rung")
    }

    /// As [`Context::scratch_long`] for a bit.
    pub fn scratch_bit(&mut self, number: usize) -> String {
        self.helper(Block::C, &format!("slcFlow{number}"), "power flow inside a rung, free after its rung")
    }

    /// Milliseconds since the previous scan, as a plain D operand.
    pub fn elapsed(&mut self) -> String {
        self.needs.elapsed = true;
        self.helper(Block::D, "slcElapsed", "milliseconds since the previous scan; 0 in the first")
    }

    /// Milliseconds of run time, 0 to 999,999,999 and again from 0, as a plain D operand.
    pub fn now(&mut self) -> String {
        self.needs.now = true;
        self.needs.elapsed = true;
        self.helper(Block::D, "slcNow", "milliseconds counted since RUN, starts again at 1,000,000,000")
    }

    /// A word of the status file as a plain operand: a signed word.
    pub fn status_word(&mut self, word: u16) -> String {
        self.places.word(ladder::FileType::S, 2, word.into()).unwrap_or_else(|| {
            // An image without status file: a helper serves.
            self.helper(Block::N, &format!("slcS{word}"), "status word the original has no file for")
        })
    }

    /// A bit of the status file.
    pub fn status_bit(&mut self, word: u16, bit: u16) -> String {
        match self.places.bit(ladder::FileType::S, 2, word.into(), bit) {
            Some(found) => found,
            None => format!("{}:{bit}", self.status_word(word)),
        }
    }

    /// A minor error bit of S:5 (0: overflow trap, 2: control register error) that this rung may set;
    /// the end of the scan then stops the program as the original stops.
    pub fn minor_error_bit(&mut self, bit: u16) -> String {
        self.needs.minor_errors = true;
        if self.options.only_confirmed {
            let text =
                "a minor error stops the original at the end of the scan: here its outputs go off, the program goes on";
            self.condition(Mark::Fault, text);
        }
        self.status_bit(5, bit)
    }
}
