//! Random programs of data instructions in all their operands (words, bits in words, parts of timers, counters and
//! control elements, the status file, indexed and indirect addresses, constants at the limits), migrated and run
//! beside the original: where every rung is called exact, all data must agree after every scan, up to the same fault.

mod migrate_support;
#[path = "../../sim/tests/random/shape.rs"]
mod shape;

use std::collections::BTreeSet;
use std::time::Duration;

use convert::migrate::{self, Options, Verdict};
use domore::choices::{Choice, Choices};
use ladder::{Address, DataFile, Family, FileType, Image, Value};
use migrate_support::Both;
use migrate_support::dice::Dice;
use proptest::prelude::*;
use shape::Words;

const FAMILIES: [Family; 9] = [
    Family::Slc501,
    Family::Slc502,
    Family::Slc503,
    Family::Slc505,
    Family::MicroLogix1000,
    Family::MicroLogix1100,
    Family::MicroLogix1200,
    Family::MicroLogix1400,
    Family::MicroLogix1500,
];

const READINGS: [Choice; 5] = [
    Choice::MathSaturates,
    Choice::DivideByZeroGivesZero,
    Choice::RoundHalfEven,
    Choice::StoreSaturates,
    Choice::StoreRounds,
];

const WORDS: [i16; 16] = [0, 1, -1, 2, 3, 7, 10, -10, 99, 255, 256, 16383, 32766, 32767, -32767, -32768];

/// MicroLogix with long words and indirect addresses.
fn is_mx(family: Family) -> bool {
    shape::is_mx(family) || matches!(family, Family::MicroLogix1200 | Family::MicroLogix1500)
}

const FLOATS: [f32; 14] = [0.0, 1.0, -1.0, 0.5, -0.5, 1.5, 2.5, -2.5, 0.1, 100.25, 32767.4, 32767.5, -32768.5, 40000.0];

/// Conditions that the floats of these programs keep.
const KEPT: [&str; 4] = [
    "floats are ordinary numbers of single precision",
    "a long word becomes the nearest float",
    "integers and floats compare by value",
    "the name SQRT of the square root is inferred",
];

struct Vocabulary {
    dice: Dice,
    family: Family,
    /// Floats among the words.
    floats: bool,
}

impl Vocabulary {
    fn mx(&self) -> bool {
        is_mx(self.family)
    }

    fn below(&mut self, limit: u64) -> u64 {
        self.dice.below(limit)
    }

    fn indirect(&self) -> bool {
        self.mx() || matches!(self.family, Family::Slc503 | Family::Slc505)
    }

    fn constant(&mut self) -> String {
        if self.floats && self.below(3) == 0 {
            return format!("{:?}", FLOATS[self.dice.below(FLOATS.len() as u64) as usize]);
        }
        match self.below(3) {
            0 => (self.dice.next() as i16).to_string(),
            1 => self.below(20).to_string(),
            _ => WORDS[self.dice.below(WORDS.len() as u64) as usize].to_string(),
        }
    }

    /// A word that is read or written.
    fn word(&mut self) -> String {
        if self.floats && self.below(3) == 0 {
            return format!("F8:{}", self.below(6));
        }
        match self.below(24) {
            0 => format!("T4:{}.{}", self.dice.below(6), self.dice.pick(&["PRE", "ACC"])),
            1 => format!("C5:{}.{}", self.dice.below(4), self.dice.pick(&["PRE", "ACC"])),
            2 => format!("R6:{}.POS", self.dice.below(4)),
            3 => format!("B3:{}", self.below(8)),
            4 => format!("B10:{}", self.below(8)),
            5 => "O:0.0".to_owned(),
            6 => "S:13".to_owned(),
            7 => "S:14".to_owned(),
            8 if self.family != Family::Slc501 => format!("#N7:{}", self.below(8)),
            9 if self.indirect() => format!("N7:[N7:{}]", 20 + self.below(4)),
            10 if self.indirect() => format!("N11:[N7:{}]", 20 + self.below(4)),
            11 | 12 if self.mx() => format!("L9:{}", self.below(6)),
            _ => format!("N7:{}", self.below(20)),
        }
    }

    fn source(&mut self) -> String {
        match self.below(6) {
            0 | 1 => self.constant(),
            2 => match self.below(6) {
                0 => "I:0.0".to_owned(),
                1 => "S:4".to_owned(),
                2 => "S:0".to_owned(),
                3 => "S:24".to_owned(),
                4 => format!("R6:{}.LEN", self.below(4)),
                _ => format!("C5:{}.ACC", self.below(4)),
            },
            _ => self.word(),
        }
    }

    /// A word that is no long word.
    fn short(&mut self) -> String {
        loop {
            let word = self.word();
            if !word.starts_with(['L', 'F']) {
                return word;
            }
        }
    }

    fn file(&mut self, room: u64) -> String {
        match self.below(8) {
            0 => format!("#B3:{}", self.below(8 - room.min(7))),
            1 => format!("#B10:{}", self.below(8 - room.min(7))),
            2 => format!("#N11:{}", self.below(24 - room)),
            3 if room <= 6 && self.mx() => format!("#L9:{}", self.below(7 - room)),
            _ => format!("#N7:{}", self.below(24 - room)),
        }
    }

    fn bit(&mut self) -> String {
        let bit = self.below(16);
        match self.below(16) {
            0..=3 => format!("I:0/{}", self.below(6)),
            4 => format!("S:0/{}", self.below(4)),
            5 => self.dice.pick(&["S:5/0", "S:5/2", "S:1/15", "S:4/0", "S:4/2", "S:13/15"]).to_owned(),
            6 => format!(
                "R6:{}/{}",
                self.dice.below(4),
                self.dice.pick(&["EN", "DN", "ER", "UL", "FD", "IN", "EU", "EM"])
            ),
            7 => format!("C5:{}/{}", self.dice.below(4), self.dice.pick(&["CU", "CD", "DN", "OV", "UN"])),
            8 => format!("T4:{}/{}", self.dice.below(6), self.dice.pick(&["EN", "TT", "DN"])),
            9 => format!("N7:{}/{bit}", self.below(20)),
            10 => format!("O:0/{bit}"),
            11 if self.indirect() => format!("N7:[N7:{}]/{bit}", 20 + self.below(4)),
            _ => format!("B3:{}/{}", self.below(8), bit % 4),
        }
    }

    fn expression(&mut self, depth: u32) -> String {
        if depth > 1 || self.below(3) == 0 {
            let part = self.source();
            return part;
        }
        let operator = self.dice.pick(&["+", "-", "*", "|", "AND", "OR", "XOR"]);
        let (a, b) = (self.expression(depth + 1), self.expression(depth + 1));
        format!("( {a} {operator} {b} )")
    }

    fn computed(&mut self) -> String {
        let name = self.dice.pick(&["ADD", "SUB", "MUL", "DIV", "AND", "OR", "XOR", "ADD", "SUB"]);
        format!("{name} {} {} {}", self.source(), self.source(), self.word())
    }
}

impl Words for Vocabulary {
    const TND_IN_SUBROUTINES: bool = false;

    fn dice(&mut self) -> &mut Dice {
        &mut self.dice
    }

    fn condition(&mut self) -> String {
        match self.below(14) {
            0..=3 => format!("XIC {}", self.bit()),
            4..=6 => format!("XIO {}", self.bit()),
            7 => format!("LIM {} {} {}", self.source(), self.source(), self.source()),
            8 => format!("MEQ {} {} {}", self.short(), self.source(), self.source()),
            9 if self.mx() => format!("ONS B3:{}/{}", self.below(8), 4 + self.below(12)),
            9 => format!("OSR B3:{}/{}", self.below(8), 4 + self.below(12)),
            _ => {
                let name = self.dice.pick(&["EQU", "NEQ", "LES", "LEQ", "GRT", "GEQ"]);
                format!("{name} {} {}", self.word(), self.source())
            }
        }
    }

    fn output(&mut self) -> String {
        let control = self.below(4);
        let length = 1 + self.below(6);
        match self.below(44) {
            0..=9 => self.computed(),
            10..=12 => format!("MOV {} {}", self.source(), self.word()),
            13 => format!("MVM {} {} {}", self.short(), self.source(), self.short()),
            14 => format!("NOT {} {}", self.word(), self.word()),
            15 => format!("{} {} {}", self.dice.pick(&["NEG", "ABS"]), self.word(), self.word()),
            16 => format!("CLR {}", self.word()),
            17 => format!("SQR {} {}", self.source(), self.word()),
            18 => format!("SCL {} {} {} {}", self.short(), self.source(), self.source(), self.short()),
            19 => {
                let numbers: Vec<_> = (0..4).map(|_| self.constant()).collect();
                format!("SCP {} {} {}", self.short(), numbers.join(" "), self.word())
            }
            20 => format!("CPT {} {}", self.word(), self.expression(0)),
            21 => format!("TOD {} {}", self.short(), self.short()),
            22 => format!("FRD {} {}", self.short(), self.short()),
            23 => format!("DCD {} {}", self.short(), self.short()),
            24 => format!("ENC {} {}", self.short(), self.short()),
            25 if self.mx() => format!("GCD {} {}", self.short(), self.short()),
            25 | 26 => format!("DDV {} {}", self.source(), self.short()),
            27 => format!("COP {} {} {length}", self.file(length), self.file(length)),
            28 => format!("FLL {} {} {length}", self.source(), self.file(length)),
            29 if self.mx() => format!("CPW {} {} {length}", self.file(2 * length), self.file(2 * length)),
            29 if self.family == Family::Slc503 => format!("SWP #N7:{} {length}", self.below(16)),
            30 => {
                let (name, bits) = (self.dice.pick(&["BSL", "BSR"]), 1 + self.below(60));
                format!(
                    "{name} #{}:{} R6:{control} {} {bits}",
                    self.dice.pick(&["B3", "B10"]),
                    self.below(4),
                    self.bit()
                )
            }
            31 => {
                let (source, mask, to) = (self.file(length + 1), self.source(), self.short());
                format!("SQO {source} {mask} {to} R6:{control} {length} 0")
            }
            32 => format!("SQC {} {} {} R6:{control} {length} 0", self.file(length + 1), self.source(), self.short()),
            33 => format!("SQL {} {} R6:{control} {length} 0", self.file(length + 1), self.short()),
            34 => format!("FFL {} {} R6:{control} {length} 0", self.short(), self.file(length)),
            35 => format!("FFU {} {} R6:{control} {length} 0", self.file(length), self.short()),
            36 => format!("{} R6:{control}", self.dice.pick(&["RES", "RES", "CLR"]).replace("CLR", "RES")),
            37 => format!("OTU {}", self.dice.pick(&["S:5/0", "S:5/2", "S:0/0", "R6:0/ER", "R6:1/IN", "C5:0/OV"])),
            38 => {
                let name = self.dice.pick(&["CTU", "CTD"]);
                format!("{name} C5:{} 3 0", self.below(4))
            }
            39 => {
                let (name, base) = (
                    self.dice.pick(&["TON", "TOF", "RTO"]),
                    self.dice.pick(if self.mx() { &["0.001", "0.01", "1.0"] } else { shape::bases(self.family) }),
                );
                format!("{name} T4:{} {base} 10 0", self.below(6))
            }
            _ => format!("{} {}", self.dice.pick(&["OTE", "OTL", "OTU"]), {
                let word = self.short();
                let word = if word.starts_with("S:") || word.starts_with('#') { "N7:1".to_owned() } else { word };
                format!("{word}/{}", self.below(16))
            }),
        }
    }
}

fn image(family: Family, main: &str, sub: &str) -> Option<Image> {
    let mut files = Vec::new();
    for (number, text) in [(2, main), (3, sub)] {
        files.push((number, convert::slc::rung::parse_rungs(text, Some(family)).ok()?));
    }
    let mut image = sim::inline_image(family, files);
    let more = (FileType::N, 11, 24);
    let long = is_mx(family).then_some((FileType::L, 9, 6));
    image.data_files = migrate_support::FILES
        .into_iter()
        .chain([more])
        .chain(long)
        .map(|(kind, number, elements)| DataFile::new(kind, number, elements))
        .collect();
    Some(image)
}

fn fill(image: &mut Image, dice: &mut Dice) {
    for data in &mut image.data_files {
        let (number, wraps) = (data.number, dice.below(4) == 0);
        for (index, word) in data.words.iter_mut().enumerate() {
            *word = match (data.file_type, index % 3) {
                (FileType::T, 0) => (dice.next() as u16) & 0xE000,
                (FileType::T | FileType::C, _) if index % 3 > 0 => dice.below(12) as u16,
                (FileType::C, 0) => (dice.next() as u16) & 0xF800,
                (FileType::R, 0) => (dice.next() as u16) & 0xFF00,
                (FileType::R, 1) => 1 + dice.below(8) as u16,
                (FileType::R, _) => dice.below(3) as u16,
                (FileType::N, _) if number == 7 && index >= 20 => dice.below(8) as u16,
                (FileType::S, _) if index == 2 && wraps => 1 << 14,
                (FileType::S | FileType::I | FileType::F, _) => 0,
                _ => match dice.below(3) {
                    0 => dice.next() as u16,
                    1 => dice.below(40) as u16,
                    _ => WORDS[dice.below(WORDS.len() as u64) as usize] as u16,
                },
            };
        }
    }
}

/// Whether a rung is compared: it is exact, or what it states is kept here. An index that leaves its file stops the
/// original.
fn holds(rung: &migrate::RungResult, floats: bool) -> bool {
    let reach = |note: &migrate::marks::Note| note.mark == migrate::Mark::Indirect;
    let kept = |note: &migrate::marks::Note| floats && KEPT.iter().any(|kept| note.text.starts_with(kept));
    match rung.verdict {
        Verdict::Exact => true,
        Verdict::Condition => rung.notes.iter().all(|note| kept(note) || reach(note)),
        Verdict::Person => false,
    }
}

/// A float that the stated condition excludes.
fn is_beyond(both: &Both) -> bool {
    (0..6).any(|element| {
        let value = both.slc.get(&Address::element(FileType::F, 8, element));
        matches!(value, Ok(Value::Float(value)) if value != 0.0 && !(1e-30..1e30).contains(&value.abs()))
    })
}

/// Runs a program for a while: the mnemonics that were compared, or the first difference.
fn run(
    (family, floats): (Family, bool),
    main: &[u64],
    sub: &[u64],
    seed: u64,
    scans: usize,
) -> Result<BTreeSet<String>, String> {
    let words = |dice| Vocabulary { dice, family, floats };
    let mut dice = Dice(seed | 1);
    let (mut main, sub) = (shape::file(main, false, words), shape::file(sub, true, words));
    if dice.below(4) > 0 {
        main.push_str("OTU S:5/0\nOTU S:5/2\n");
    }
    let mut sub = sub;
    let options = Options { only_confirmed: seed.is_multiple_of(4) };
    // Rungs that are not called exact are left out, until none is.
    let (image, migration) = loop {
        let Some(mut image) = image(family, &main, &sub) else { return Ok(BTreeSet::new()) };
        fill(&mut image, &mut Dice(seed | 1));
        let Ok(migration) = migrate::migrate(&image, &[], &options) else { return Ok(BTreeSet::new()) };
        let left: Vec<_> = migration.rungs.iter().filter(|rung| !holds(rung, floats)).collect();
        if left.is_empty() {
            break (image, migration);
        }
        for (number, text) in [(2, &mut main), (3, &mut sub)] {
            let keeps = |index: &usize| !left.iter().any(|rung| rung.file == number && rung.rung as usize == *index);
            let kept = text.lines().enumerate().filter(|(index, _)| keeps(index)).map(|(_, line)| format!("{line}\n"));
            *text = kept.collect();
        }
    };
    if main.is_empty() {
        return Ok(BTreeSet::new());
    }
    let reaches = migration.rungs.iter().any(|rung| rung.verdict == Verdict::Condition);
    // What is exact depends on no reading of Do-more.
    let choices = match READINGS.get(dice.below(READINGS.len() as u64 + 1) as usize) {
        Some(choice) => Choices::default().with(*choice),
        None => Choices::default(),
    };
    let mut both = match Both::under(&image, migration, choices) {
        Ok(both) => both,
        // What the controller itself would not take.
        Err(why) if why.starts_with("the original") => return Ok(BTreeSet::new()),
        Err(why) => return Err(format!("{family}: {why}\n{main}")),
    };
    let mut seen: BTreeSet<String> = BTreeSet::new();
    for text in [&main, &sub] {
        seen.extend(
            text.split_whitespace().filter(|word| word.chars().all(|c| c.is_ascii_uppercase())).map(str::to_owned),
        );
    }
    both.enter_run();
    for scan in 0..scans {
        let bits = dice.next() as u16;
        both.input(0, bits);
        if dice.below(40) == 0 {
            both.stop();
            both.enter_run();
        }
        let dt = Duration::from_millis([0, 1, 7, 10, 13, 30, 250, 1000][dice.below(8) as usize]);
        let difference = both.scan(dt);
        if both.slc.fault().is_some_and(|fault| fault.code != 0x20) && reaches {
            break;
        }
        if floats && is_beyond(&both) {
            break;
        }
        let difference = difference.or_else(|| {
            (both.running() != both.other_runs()).then(|| {
                format!(
                    "the original runs: {}, the other: {}, {:?}",
                    both.running(),
                    both.other_runs(),
                    both.slc.fault()
                )
            })
        });
        if let Some(difference) = difference {
            let text = both.text();
            return Err(format!("{family} {choices:?}\n{difference} after {scan}\n{main}file 3\n{sub}\n{text}"));
        }
        if !both.running() {
            break;
        }
    }
    Ok(seen)
}

/// `RUNGS_CASES` for long runs.
fn cases() -> u32 {
    std::env::var("RUNGS_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(200)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), failure_persistence: None, max_shrink_iters: 4000, ..ProptestConfig::default() })]

    #[test]
    fn random_programs_of_data_stay_equal(
        family in proptest::sample::select(FAMILIES.to_vec()),
        main in proptest::collection::vec(any::<u64>(), 1..10),
        sub in proptest::collection::vec(any::<u64>(), 0..4),
        seed in any::<u64>(),
        scans in 5usize..40,
    ) {
        if let Err(difference) = run((family, false), &main, &sub, seed, scans) {
            return Err(TestCaseError::fail(difference));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), failure_persistence: None, max_shrink_iters: 4000, ..ProptestConfig::default() })]

    #[test]
    fn random_programs_of_floats_stay_equal(
        family in proptest::sample::select(vec![Family::Slc503, Family::MicroLogix1100, Family::MicroLogix1400]),
        main in proptest::collection::vec(any::<u64>(), 1..8),
        seed in any::<u64>(),
        scans in 5usize..30,
    ) {
        if let Err(difference) = run((family, true), &main, &[], seed, scans) {
            return Err(TestCaseError::fail(difference));
        }
    }
}

#[test]
fn every_instruction_is_compared() {
    let mut dice = Dice(4711);
    let mut seen = BTreeSet::new();
    let mut compared = 0;
    for number in 0..600 {
        let main: Vec<u64> = (0..2).map(|_| dice.next()).collect();
        let family = FAMILIES[number % FAMILIES.len()];
        let found =
            run((family, false), &main, &[], dice.next(), 6).unwrap_or_else(|difference| panic!("{difference}"));
        compared += usize::from(!found.is_empty());
        seen.extend(found);
    }
    println!("{compared} compared; {seen:?}");
    assert!(compared >= 200, "{compared} of 600");
    for name in [
        "ADD", "SUB", "MUL", "DIV", "DDV", "AND", "OR", "XOR", "NOT", "MOV", "MVM", "NEG", "ABS", "CLR", "SCL", "SCP",
        "CPT", "TOD", "FRD", "DCD", "ENC", "GCD", "COP", "FLL", "CPW", "SWP", "BSL", "BSR", "SQO", "SQC", "SQL", "RES",
        "CTU", "CTD", "TON", "TOF", "RTO", "LIM", "MEQ", "EQU", "NEQ", "LES", "LEQ", "GRT", "GEQ",
    ] {
        assert!(seen.contains(name), "{name} was never compared");
    }
}
