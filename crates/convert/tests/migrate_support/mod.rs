//! Runs a program and what it was migrated to side by side, in scans of the same inputs and time, and
//! compares all data after every scan.
#![allow(dead_code)] // every test file uses its own part

#[path = "../../../../tests/src/dice.rs"]
#[allow(unreachable_pub, reason = "one text for every crate's tests")]
pub(crate) mod dice;

use std::time::Duration;

use convert::migrate::{self, Migration, Options};
use domore::choices::Choices;
use domore::engine;
use ladder::{Address, DataFile, Family, FileType, Image, Value};

/// Data files of every test program: type, number, elements.
pub(crate) const FILES: [(FileType, u16, u16); 10] = [
    (FileType::O, 0, 2),
    (FileType::I, 1, 2),
    (FileType::S, 2, 66),
    (FileType::B, 3, 8),
    (FileType::T, 4, 6),
    (FileType::C, 5, 4),
    (FileType::R, 6, 4),
    (FileType::N, 7, 24),
    (FileType::F, 8, 6),
    (FileType::B, 10, 8),
];

/// An image of these rungs with the data files above.
pub(crate) fn image(family: Family, files: &[(u16, &str)]) -> Image {
    let files = files
        .iter()
        .map(|(number, text)| {
            let rungs = convert::slc::rung::parse_rungs(text, Some(family));
            (*number, rungs.unwrap_or_else(|errors| panic!("{errors:?}\n{text}")))
        })
        .collect();
    let mut image = sim::inline_image(family, files);
    image.data_files =
        FILES.iter().map(|(file_type, number, elements)| DataFile::new(*file_type, *number, *elements)).collect();
    image
}

/// A word of the data table and the operand that stands for it.
struct Pair {
    slc: Address,
    domore: engine::Handle,
    text: String,
    kind: FileType,
}

/// Both machines.
pub(crate) struct Both {
    pub(crate) slc: sim::Machine,
    pub(crate) domore: engine::Machine,
    pub(crate) migration: Migration,
    inputs: Vec<Vec<Pair>>,
    pairs: Vec<Pair>,
    scans: usize,
}

impl Both {
    pub(crate) fn new(image: &Image, options: &Options) -> Both {
        let migration = migrate::migrate(image, &[], options).expect("it migrates");
        Both::with(image, migration).unwrap_or_else(|why| panic!("{why}"))
    }

    /// Both sides of a migration; why one of them does not run.
    pub(crate) fn with(image: &Image, migration: Migration) -> Result<Both, String> {
        Both::under(image, migration, Choices::default())
    }

    /// The same under other readings of Do-more.
    pub(crate) fn under(image: &Image, migration: Migration, choices: Choices) -> Result<Both, String> {
        let behind = pushes_behind_outputs(&migration.project);
        assert!(behind.is_empty(), "STR behind an output: {behind:#?}");
        let text = domore::text::write(&migration.project);
        let reading = domore::text::read(&text).expect("the text is read back");
        assert!(reading.diagnostics.is_empty(), "{:?}\n{text}", reading.diagnostics);
        let program =
            engine::Program::compile(&reading.project, &engine::Options { choices, ..engine::Options::default() })
                .map_err(|refusals| format!("{refusals:#?}\n{text}"))?;
        let domore = engine::Machine::new(program);
        // What lies behind a file is other data there and here: an index that leads out of its file stops the original.
        let choices = sim::Choices::default().with(sim::Choice::IndirectStaysInFile);
        let program = sim::Program::compile(image, &sim::Options { choices, ..sim::Options::default() });
        let program = program.map_err(|refusals| format!("the original: {refusals:?}"))?;
        let slc = sim::Machine::new(program);
        let facts = migrate::facts::Facts::of(image);
        let (mut inputs, mut pairs) = (Vec::new(), Vec::new());
        for span in migration.places.spans() {
            // Strings and what the controller itself keeps are not compared here.
            if span.at.block.name() == "SL" || span.file_type.is_function_file() {
                continue;
            }
            let step = if matches!(span.at.block.name(), "D" | "R") { 2 } else { 1 };
            for index in (0..span.words).step_by(step) {
                let address = span.address(index).expect("address");
                let places = &migration.places;
                let text = match step {
                    2 => places.element(span.file_type, span.file, span.first_word + index).map(|e| e.to_string()),
                    _ => places.word(span.file_type, span.file, span.first_word + index),
                };
                if slc.get(&address).is_err() {
                    continue;
                }
                let handle = |text: &str| domore.handle(text).unwrap_or_else(|error| panic!("{text}: {error:?}"));
                // Words that have no form of their own are compared bit by bit.
                let parts: Vec<Pair> = match text {
                    Some(text) => {
                        vec![Pair { slc: address, domore: handle(&text), text, kind: span.file_type }]
                    }
                    None => (0..16)
                        .filter_map(|bit| {
                            let text = places.bit(span.file_type, span.file, span.first_word + index, bit)?;
                            let slc = address.clone().with_bit(bit);
                            Some(Pair { slc, domore: handle(&text), text, kind: span.file_type })
                        })
                        .collect(),
                };
                match span.file_type {
                    FileType::I => inputs.push(parts),
                    // Of the status file what the program can see.
                    FileType::S if !matches!(index, 0 | 4 | 5 | 13 | 14 | 24) => {}
                    FileType::S if !facts.names_status(u16::try_from(index).unwrap_or(0)) => {}
                    _ => pairs.extend(parts),
                }
            }
        }
        Ok(Both { slc, domore, migration, inputs, pairs, scans: 0 })
    }

    pub(crate) fn enter_run(&mut self) {
        self.slc.enter_run();
        self.domore.enter_run();
        self.scans = 0;
    }

    pub(crate) fn stop(&mut self) {
        self.slc.enter_program();
        self.domore.enter_program();
    }

    /// Sets the clocks of both sides to the same moment.
    pub(crate) fn set_clocks(&mut self) {
        let fields = ["Year", "Month", "Day", "Hour", "Minute", "Second", "DayOfWeek"];
        for (index, (field, value)) in fields.iter().zip([2024, 5, 14, 10, 59, 30, 2]).enumerate() {
            let words = [Address::element(FileType::RTC, 0, 0).with_word(index as u16), {
                let word = if index == 6 { 53 } else { 37 + index as u16 };
                Address::element(FileType::S, 2, word)
            }];
            for word in words {
                // A controller has the one or the other.
                let _ = self.slc.set(&word, &Value::Word(value));
            }
            // The day of the week follows from the date.
            let _ = self.domore.set(&format!("SDT0.{field}"), &engine::Value::Integer(value.into()));
        }
    }

    /// How many input words there are.
    pub(crate) fn input_words(&self) -> usize {
        self.inputs.len()
    }

    /// Writes an input word on both sides.
    pub(crate) fn input(&mut self, word: usize, value: u16) {
        for pair in self.inputs.get(word).into_iter().flatten() {
            let (slc, domore) = match pair.slc.bit.as_ref().and_then(ladder::Place::number) {
                Some(bit) => (Value::Bit(value >> bit & 1 != 0), i64::from(value >> bit & 1)),
                None => (Value::Word(value as i16), i64::from(value as i16)),
            };
            self.slc.set(&pair.slc, &slc).expect("an input");
            self.domore.set_number(pair.domore, domore::memory::Num::Int(domore));
        }
    }

    /// Writes a word of the data table on both sides.
    pub(crate) fn set(&mut self, address: &str, value: i16) {
        let address = Address::parse(address).expect("address");
        self.slc.set(&address, &Value::Word(value)).expect("an address");
        let (t, f, w) = self.migration.places.word_of(&address).expect("a place");
        let text = self.migration.places.word(t, f, w).expect("a word");
        self.domore.set(&text, &engine::Value::Integer(value.into())).expect("an element");
    }

    /// One scan on both sides; the first difference as text.
    pub(crate) fn scan(&mut self, dt: Duration) -> Option<String> {
        let dt = if self.scans == 0 { Duration::ZERO } else { dt };
        self.scans += 1;
        self.slc.scan(dt);
        self.domore.scan(dt);
        self.difference()
    }

    pub(crate) fn running(&self) -> bool {
        self.slc.is_executing()
    }

    /// Whether the converted program goes on: where the original stops it sets a bit.
    pub(crate) fn other_runs(&self) -> bool {
        let fault = self.migration.project.documentation().find(|row| row.nickname == "slcFault");
        fault.is_none_or(|row| self.domore.get(&row.element) != Ok(engine::Value::Bit(true)))
    }

    pub(crate) fn difference(&self) -> Option<String> {
        // A stopped original keeps its data; what its outputs show is zero on both sides.
        if !self.slc.is_executing() {
            return None;
        }
        for pair in &self.pairs {
            // S:4 and the clock only where the program asks for them.
            if pair.kind == FileType::S && pair.slc.element.number() == Some(4) && !self.reads_clock() {
                continue;
            }
            let slc = self.slc.get(&pair.slc).expect("a place");
            let domore = self.domore.value(pair.domore);
            let equal = match (&slc, &domore) {
                (Value::Word(a), engine::Value::Integer(b)) => i64::from(*a) == *b,
                (Value::Bit(a), engine::Value::Bit(b)) => a == b,
                (Value::Long(a), engine::Value::Integer(b)) => i64::from(*a) == *b,
                (Value::Float(a), engine::Value::Real(b)) => a.to_bits() == b.to_bits() || a == b,
                _ => false,
            };
            if !equal {
                return Some(format!("scan {}: {} is {slc:?}, {} is {domore:?}", self.scans, pair.slc, pair.text));
            }
        }
        None
    }

    fn reads_clock(&self) -> bool {
        self.migration.rungs.iter().any(|rung| rung.original.contains("S:4"))
    }

    pub(crate) fn text(&self) -> String {
        domore::text::write(&self.migration.project)
    }
}

/// Rungs in which an instruction of the `STR` family stands directly behind a coil or box: Designer may
/// begin a new rung there. An instruction that is not known counts as a box.
pub(crate) fn pushes_behind_outputs(project: &domore::Project) -> Vec<String> {
    use domore::instruction::by_mnemonic;
    let family = ["STR", "STRN", "STRPD", "STRND", "STRDLT", "STRE", "STRNE", "STRGT", "STRGE", "STRLT", "STRLE"];
    let is_bad = |pair: &[domore::Instruction]| {
        let [before, next] = pair else { return false };
        by_mnemonic(&before.mnemonic).is_none_or(|entry| entry.is_output())
            && family.contains(&next.mnemonic.to_ascii_uppercase().as_str())
    };
    let code = project.parts.iter().filter_map(|part| match part {
        domore::Part::Code(block) => Some(block),
        _ => None,
    });
    code.flat_map(|block| block.rungs.iter().map(move |rung| (block, rung)))
        .filter(|(_, rung)| rung.instructions.windows(2).any(is_bad))
        .map(|(block, rung)| {
            let code: Vec<_> = rung.instructions.iter().map(ToString::to_string).collect();
            format!("{}: {}", block.name, code.join("; "))
        })
        .collect()
}
