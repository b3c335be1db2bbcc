//! Instructions on data, migrated and run beside the original on random operands and on those at the
//! limits. What is called exact must also be independent of every reading of Do-more that can be
//! switched.

mod migrate_support;

use convert::migrate::{self, Options, Verdict};
use domore::choices::{Choice, Choices};
use domore::engine;
use ladder::{Address, DataFile, Family, FileType, Image, Value};
use migrate_support::dice::Dice;

const WORDS: [i16; 18] = [0, 1, -1, 2, -2, 5, 10, -10, 99, 255, 256, 4095, 16383, 16384, 32766, 32767, -32767, -32768];
const LONGS: [i32; 12] = [0, 1, -1, 10, -15, 32767, 32768, -32769, 100_000, i32::MAX, i32::MIN, i32::MIN + 1];
const FLOATS: [f32; 16] = [
    0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    1.5,
    2.5,
    -2.5,
    0.1,
    100.25,
    32767.4,
    32767.5,
    -32768.5,
    40000.0,
    -1e9,
    2_147_483_648.0,
];

/// Every choice alone, and none.
fn readings() -> Vec<Choices> {
    let one = |choice| Choices::default().with(choice);
    vec![
        Choices::default(),
        one(Choice::MathSaturates),
        one(Choice::DivideByZeroGivesZero),
        one(Choice::RoundHalfEven),
        one(Choice::StoreSaturates),
        one(Choice::StoreRounds),
    ]
}

struct Case {
    family: Family,
    /// Sets S:2/14.
    wrap: bool,
    rungs: String,
}

fn image(case: &Case) -> Image {
    let rungs = convert::slc::rung::parse_rungs(&case.rungs, Some(case.family))
        .unwrap_or_else(|errors| panic!("{errors:?}\n{}", case.rungs));
    let mut image = sim::inline_image(case.family, vec![(2, rungs)]);
    let mut files = vec![
        (FileType::O, 0, 4),
        (FileType::I, 1, 4),
        (FileType::S, 2, 33),
        (FileType::B, 3, 4),
        (FileType::T, 4, 4),
        (FileType::C, 5, 4),
        (FileType::R, 6, 4),
        (FileType::N, 7, 54),
        (FileType::F, 8, 12),
        (FileType::B, 10, 9),
        (FileType::N, 11, 24),
    ];
    if matches!(case.family, Family::MicroLogix1100 | Family::MicroLogix1400) {
        files.push((FileType::L, 9, 12));
    }
    image.data_files =
        files.into_iter().map(|(kind, number, elements)| DataFile::new(kind, number, elements)).collect();
    for file in &mut image.data_files {
        if file.file_type == FileType::R {
            for (element, length) in [(0, 5), (1, 16), (2, 20), (3, 37)] {
                file.words[element * 3 + 1] = length;
            }
        }
        if file.file_type == FileType::S && case.wrap {
            file.words[2] |= 1 << 14;
        }
    }
    image
}

struct Cell {
    slc: Address,
    domore: engine::Handle,
    kind: FileType,
    /// Word of the element; LEN and POS of control elements must make sense.
    sub: u16,
}

/// Runs a program on both sides; the verdicts of its rungs.
fn run(case: &Case, scans: usize, seed: u64) -> Vec<Verdict> {
    let image = image(case);
    let migration = migrate::migrate(&image, &[], &Options::default()).expect("it migrates");
    let verdicts: Vec<_> = migration.rungs.iter().map(|rung| rung.verdict).collect();
    let text = domore::text::write(&migration.project);
    let code = || {
        let rungs = migration.rungs.iter().map(|rung| format!("{}\n    {}", rung.original, rung.code.join("\n    ")));
        rungs.collect::<Vec<_>>().join("\n")
    };
    assert!(verdicts.iter().all(|verdict| *verdict != Verdict::Person), "{:?}", migration.rungs);
    let reading = domore::text::read(&text).expect("the text is read back");
    assert!(reading.diagnostics.is_empty(), "{:?}\n{text}", reading.diagnostics);
    let exact = verdicts.iter().all(|verdict| *verdict == Verdict::Exact);
    for (number, choices) in readings().into_iter().enumerate() {
        // What holds under a condition is compared under the readings the conversions name.
        if number > 0 && !exact {
            break;
        }
        let options = engine::Options { choices, ..engine::Options::default() };
        let program = engine::Program::compile(&reading.project, &options)
            .unwrap_or_else(|refusals| panic!("{refusals:#?}\n{}", code()));
        let mut domore = engine::Machine::new(program);
        let mut slc = sim::Machine::new(sim::Program::compile(&image, &sim::Options::default()).expect("it compiles"));
        let cells = cells(&migration, &domore);
        let named: Vec<_> = cells.iter().filter(|cell| code_names(&case.rungs, &cell.slc)).collect();
        let status = case.rungs.contains("MOV S:0 ");
        let mut dice = Dice(seed | 1);
        slc.enter_run();
        domore.enter_run();
        for scan in 0..if number == 0 { scans } else { scans / 4 } {
            for cell in &cells {
                randomize(&mut dice, cell, &mut slc, &mut domore, scan);
            }
            let before: Vec<_> = named.iter().map(|cell| (cell.slc.to_string(), slc.get(&cell.slc))).collect();
            slc.scan(std::time::Duration::from_millis(10));
            domore.scan(std::time::Duration::from_millis(10));
            assert!(slc.is_executing(), "the original stopped: {:?}\n{}", slc.fault(), case.rungs);
            for cell in &cells {
                if cell.kind == FileType::S && !status {
                    continue;
                }
                let (a, b) = (slc.get(&cell.slc).expect("a place"), domore.value(cell.domore));
                let equal = match (&a, &b) {
                    (Value::Word(a), engine::Value::Integer(b)) => i64::from(*a) == *b,
                    (Value::Long(a), engine::Value::Integer(b)) => i64::from(*a) == *b,
                    (Value::Float(a), engine::Value::Real(b)) => a == b || a.is_nan() && b.is_nan() || !a.is_finite(),
                    _ => false,
                };
                if equal {
                    continue;
                }
                panic!("scan {scan}, reading {number}: {} is {a:?} and {b:?}\nbefore {before:?}\n{}", cell.slc, code());
            }
        }
    }
    verdicts
}

fn code_names(rungs: &str, address: &Address) -> bool {
    let address = address.to_string();
    rungs.split_whitespace().any(|word| word == address)
}

fn cells(migration: &migrate::Migration, domore: &engine::Machine) -> Vec<Cell> {
    let mut cells = Vec::new();
    for span in migration.places.spans() {
        let step = if matches!(span.at.block.name(), "D" | "R") { 2 } else { 1 };
        for index in (0..span.words).step_by(step) {
            let places = &migration.places;
            let text = match step {
                2 => places.element(span.file_type, span.file, span.first_word + index).map(|e| e.to_string()),
                _ => places.word(span.file_type, span.file, span.first_word + index),
            };
            let slc = span.address(index).expect("an address");
            let number = slc.element.number().unwrap_or(0);
            if span.file_type == FileType::S && !matches!(number, 0 | 2 | 5 | 13 | 14 | 24) {
                continue;
            }
            let domore = domore.handle(&text.expect("a place")).expect("an element");
            let sub = slc.word.unwrap_or(0);
            cells.push(Cell { slc, domore, kind: span.file_type, sub });
        }
    }
    cells
}

fn randomize(dice: &mut Dice, cell: &Cell, slc: &mut sim::Machine, domore: &mut engine::Machine, scan: usize) {
    let number = cell.slc.element.number().unwrap_or(0);
    let (value, same) = match cell.kind {
        FileType::S => return,
        // Pointers stay inside their files; some words are left to the program.
        FileType::N if cell.slc.file.number() == Some(7) && number >= 50 => {
            let index = dice.below(8) as i16;
            (Value::Word(index), domore::memory::Num::Int(index.into()))
        }
        FileType::R | FileType::T | FileType::C if cell.sub != 2 || scan > 0 => return,
        FileType::R => (Value::Word(0), domore::memory::Num::Int(0)),
        FileType::F => {
            let value = match dice.below(4) {
                0 => (dice.below(200_000) as f32 - 100_000.0) / 64.0,
                1 => dice.below(100) as f32 - 50.0,
                2 => (dice.below(2000) as f32 - 1000.0) / 2.0,
                _ => FLOATS[dice.below(FLOATS.len() as u64) as usize],
            };
            (Value::Float(value), domore::memory::Num::Real(value.into()))
        }
        FileType::L => {
            let value = match dice.below(4) {
                0 => dice.next() as i32,
                1 => dice.below(200_000) as i32 - 100_000,
                2 => dice.next() as i16 as i32,
                _ => LONGS[dice.below(LONGS.len() as u64) as usize],
            };
            (Value::Long(value), domore::memory::Num::Int(value.into()))
        }
        _ => {
            let value = match dice.below(4) {
                0 => dice.next() as i16,
                1 => dice.below(200) as i16 - 100,
                2 => 1 << dice.below(15),
                _ => WORDS[dice.below(WORDS.len() as u64) as usize],
            };
            (Value::Word(value), domore::memory::Num::Int(value.into()))
        }
    };
    slc.set(&cell.slc, &value).expect("a place");
    domore.set_number(cell.domore, same);
}

/// The trap is shown in B3:0/0 and cleared, so that the original goes on.
const TRAP: &str = "BST XIC S:5/0 OTL B3:0/0 NXB XIO S:5/0 OTU B3:0/0 BND\nOTU S:5/0\nOTU S:5/2\n";

fn check(family: Family, rungs: &[&str], verdict: Verdict) {
    for (seed, rung) in rungs.iter().enumerate() {
        let case = Case { family, wrap: false, rungs: format!("{rung}\n{TRAP}") };
        let verdicts = run(&case, 200, seed as u64 * 7919 + 3);
        let expected: Vec<_> = rung.lines().map(|_| verdict).collect();
        let worst = verdicts.iter().take(expected.len()).copied().max();
        assert_eq!(worst, Some(verdict), "{rung}");
    }
}

const MX: Family = Family::MicroLogix1400;
const S3: Family = Family::Slc503;

#[test]
fn gray_code_and_division_of_the_register() {
    check(MX, &["GCD N7:0 N7:1", "GCD N7:0 N7:0", "GCD B3:2 N7:1"], Verdict::Exact);
    for flags in ["", "MOV S:0 N11:0"] {
        for wrap in [false, true] {
            let rungs = format!("GCD N7:0 N7:1\n{flags}\n{TRAP}");
            assert_eq!(run(&Case { family: MX, wrap, rungs }, 200, 5).into_iter().max(), Some(Verdict::Exact));
        }
    }
    // The register from data of the program, from a product, and what is left in it.
    for before in
        ["MOV N7:0 S:13 MOV N7:1 S:14", "MUL N7:0 N7:1 N7:2", "MOV N7:0 S:13 CLR S:14", "MUL N7:0 N7:1 N7:2 MOV 0 S:5"]
    {
        for divide in [
            "DDV N7:3 N7:4",
            "DDV 7 N7:4",
            "DDV -3 N7:4",
            "DDV 0 N7:4",
            "DDV N7:3 N7:3",
            "DDV S:13 N7:4",
            "DDV N7:3 S:14",
        ] {
            for (behind, wrap) in [("", false), ("MOV S:13 N11:1 MOV S:14 N11:2 MOV S:0 N11:3", true)] {
                let rungs = format!("{before}\n{divide}\n{behind}\n{TRAP}");
                let verdicts = run(&Case { family: S3, wrap, rungs }, 150, 17);
                assert_eq!(verdicts.into_iter().max(), Some(Verdict::Exact), "{before} {divide} {behind}");
            }
        }
    }
}

#[test]
fn strings_are_joined_and_begin_with_their_contents() {
    let mut image =
        image(&Case { family: MX, wrap: false, rungs: "ACN ST9:0 ST9:1 ST9:2\nACN ST9:1 ST9:0 ST9:1\n".to_owned() });
    image.data_files.retain(|file| file.number != 9);
    let mut strings = DataFile::new(FileType::ST, 9, 4);
    for (element, text) in [(0, "50 % \"ok\" $5"), (1, "\tb"), (3, "kept")] {
        let bytes: Vec<u8> = text.chars().map(|c| c as u8).collect();
        strings.words[element * 42] = bytes.len() as u16;
        for (index, byte) in bytes.iter().enumerate() {
            strings.words[element * 42 + 1 + index / 2] |= u16::from(*byte) << if index % 2 == 0 { 8 } else { 0 };
        }
    }
    image.data_files.push(strings);
    let migration = migrate::migrate(&image, &[], &Options::default()).expect("it migrates");
    assert!(migration.rungs.iter().all(|rung| rung.verdict == Verdict::Condition), "{:?}", migration.rungs);
    let reading = domore::text::read(&domore::text::write(&migration.project)).expect("the text is read back");
    assert!(reading.diagnostics.is_empty(), "{:?}", reading.diagnostics);
    let program = engine::Program::compile(&reading.project, &engine::Options::default()).expect("it compiles");
    let mut domore = engine::Machine::new(program);
    let mut slc = sim::Machine::new(sim::Program::compile(&image, &sim::Options::default()).expect("it compiles"));
    domore.enter_run();
    slc.enter_run();
    for scan in 0..3 {
        slc.scan(std::time::Duration::from_millis(10));
        domore.scan(std::time::Duration::from_millis(10));
        for element in 0..4 {
            let address = Address::parse(&format!("ST9:{element}")).expect("an address");
            let Ok(Value::Text(own)) = slc.get(&address) else { panic!("{address}") };
            let other = domore.get(&format!("SL{element}")).expect("a string");
            assert_eq!(other, engine::Value::Text(own), "scan {scan}, {address}");
        }
    }
    let person = |rung: &str| {
        let image = with_strings(rung);
        let migration = migrate::migrate(&image, &[], &Options::default()).expect("it migrates");
        assert_eq!(migration.rungs[0].verdict, Verdict::Person, "{rung}");
        migration.rungs[0].notes[0].to_string()
    };
    for (rung, code, why) in [
        ("ASR ST9:0 ST9:1 OTE B3:0/0", "STRING", "compares two strings"),
        ("ASC ST9:0 1 ST9:1 N7:0", "STRING", "looks for a string"),
        ("AEX ST9:0 1 2 ST9:1", "STRING", "takes a part"),
        ("ACI ST9:0 N7:0", "STRING", "reads a number"),
        ("AIC N7:0 ST9:0", "STRING", "writes a number"),
        ("ARD 0 ST9:0 R6:0 10 0 0", "NO-EQUAL", "serial port"),
        ("MOV ST9:0.LEN N7:0", "STRING", "no numbers here"),
    ] {
        let found = person(rung);
        assert!(found.starts_with(code) && found.contains(why), "{rung}: {found}");
    }
}

/// A rung with a file of strings.
fn with_strings(rung: &str) -> Image {
    let mut image = image(&Case { family: MX, wrap: false, rungs: rung.to_owned() });
    image.data_files.retain(|file| file.number != 9);
    image.data_files.push(DataFile::new(FileType::ST, 9, 4));
    image
}

#[test]
fn words_are_computed_exactly() {
    check(
        S3,
        &[
            "ADD N7:0 N7:1 N7:2",
            "ADD N7:0 1 N7:0",
            "ADD N7:0 -5 N7:1",
            "SUB N7:0 N7:1 N7:0",
            "SUB 0 N7:1 N7:0",
            "SUB N7:0 100 N7:0",
            "MUL N7:0 N7:1 N7:2",
            "MUL N7:0 60 N7:0",
            "MUL N7:0 N7:0 N7:0",
            "DIV N7:0 10 N7:1",
            "DIV N7:0 3 N7:0",
            "DIV N7:0 -7 N7:0",
            "DIV N7:0 N7:1 N7:2",
            "DIV N7:0 N7:1 N7:1",
            "DIV N7:0 N7:1 N7:0",
            "DIV 1000 N7:1 N7:0",
            "NEG N7:0 N7:1",
            "ABS N7:0 N7:0",
            "CLR N7:0",
            "SCL N7:0 N7:1 N7:2 N7:3",
            "SCL N7:0 25000 127 N7:3",
            "AND N7:0 N7:1 N7:2",
            "AND N7:0 255 N7:0",
            "OR N7:0 N7:1 N7:2",
            "XOR N7:0 N7:1 N7:2",
            "XOR N7:2 7 N7:2",
            "NOT N7:0 N7:1",
            "MVM N7:0 00FFh N7:1",
            "MVM N7:0 N7:1 N7:2",
            "MVM N7:0 FF00h B3:2",
            "MOV N7:0 N7:1",
            "MOV -5 N7:1",
            "MOV 32000 T4:1.PRE",
            "MOV T4:1.ACC N7:1",
            "MOV N7:0 O:0.0",
            "MOV B3:1 N7:0",
            "TOD N7:0 N7:1",
            "FRD N7:0 N7:1",
            "DCD N7:0 N7:1",
            "ENC N7:0 N7:1",
            "SCP N7:0 0 16383 0 55 N7:1",
            "SCP N7:0 6269 32767 0 100 N7:0",
            "SCP N7:0 100 0 0 1000 N7:1",
            "CPT N7:0 N7:1 * ( N7:2 | 100 )",
            "CPT N7:0 ( ( N7:1 * 16 ) + N7:2 ) + 1",
            "CPT N7:0 N7:1 + ( N7:2 | 2 )",
            "CPT N7:0 N7:1 AND N7:2 OR 7",
        ],
        Verdict::Exact,
    );
}

#[test]
fn compares_are_exact() {
    let mut rungs = Vec::new();
    for name in ["EQU", "NEQ", "LES", "LEQ", "GRT", "GEQ"] {
        for operands in ["N7:0 N7:1", "N7:0 10", "N7:0 C5:0.ACC", "L9:0 N7:0", "L9:0 L9:1", "F8:0 F8:1", "F8:0 0.5"] {
            rungs.push(format!("{name} {operands} OTE B3:1/0"));
        }
        rungs.push(format!("{name} N7:0 0.0 OTE B3:1/0"));
        rungs.push(format!("{name} N7:0 2.5 OTE B3:1/0"));
        rungs.push(format!("XIC B3:2/0 BST {name} N7:0 N7:1 NXB {name} N7:2 0 BND OTE B3:1/0"));
    }
    for limits in
        ["5 N7:0 8", "8 N7:0 5", "N7:0 N7:1 N7:2", "0 N7:1 N7:2", "N7:1 5 N7:2", "L9:0 N7:1 L9:1", "0.0 F8:0 32000.0"]
    {
        rungs.push(format!("LIM {limits} OTE B3:1/0"));
        rungs.push(format!("XIC B3:2/0 LIM {limits} OTE B3:1/0"));
        rungs.push(format!("BST XIC B3:2/0 NXB LIM {limits} BND XIC B3:2/1 OTE B3:1/0"));
    }
    rungs.extend(["MEQ N7:0 00F0h N7:1 OTE B3:1/0".to_owned(), "MEQ N7:0 N7:1 5 OTE B3:1/0".to_owned()]);
    let rungs: Vec<_> = rungs.iter().map(String::as_str).collect();
    check(MX, &rungs, Verdict::Exact);
}

#[test]
fn long_words_are_exact() {
    check(
        MX,
        &[
            "ADD L9:0 1 L9:0",
            "ADD L9:0 L9:1 L9:2",
            "ADD L9:0 N7:0 N7:1",
            "ADD N7:0 N7:1 L9:1",
            "SUB L9:0 1 L9:0",
            "SUB L9:0 L9:1 L9:0",
            "SUB 0 N7:0 L9:1",
            "SUB 0 L9:0 L9:1",
            "MUL N7:0 N7:1 L9:0",
            "MUL L9:0 256 L9:1",
            "MUL L9:0 -3 L9:0",
            "MUL L9:0 10 N7:0",
            "DIV L9:0 2 L9:0",
            "DIV L9:0 10 N7:0",
            "DIV L9:0 -7 L9:1",
            "DIV N7:0 N7:1 L9:0",
            "NEG L9:0 L9:1",
            "ABS L9:0 L9:0",
            "ABS L9:0 N7:0",
            "CLR L9:0",
            "MOV L9:0 N7:0",
            "MOV N7:0 L9:0",
            "MOV 100000 L9:0",
            "AND L9:0 L9:1 L9:0",
            "AND L9:0 255 L9:1",
            "OR L9:0 L9:1 L9:0",
            "XOR L9:0 L9:1 L9:2",
            "NOT L9:0 L9:1",
            "SCP L9:1 0 60500 0 135 N7:2",
            "CPT L9:0 N7:0 * N7:1 + 5",
        ],
        Verdict::Exact,
    );
}

#[test]
fn floats_agree_where_they_are_ordinary() {
    check(
        MX,
        &[
            "ADD F8:0 F8:1 F8:2",
            "ADD F8:0 N7:0 F8:0",
            "ADD N7:0 0.5 F8:0",
            "SUB F8:0 0.5 N7:0",
            "SUB 4095.0 F8:0 N7:3",
            "MUL F8:0 F8:1 F8:2",
            "MUL F8:0 60.0 N7:0",
            "MUL N7:0 N7:1 F8:0",
            "DIV F8:0 10.0 F8:0",
            "DIV N7:0 100.0 F8:0",
            "DIV N7:0 N7:1 F8:0",
            "DIV F8:0 F8:1 F8:0",
            "DIV N7:0 F8:0 N7:0",
            "DIV 120.0 N7:0 F8:0",
            "NEG F8:0 F8:1",
            "ABS F8:0 F8:1",
            "MOV F8:0 N7:0",
            "MOV F8:0 L9:0",
            "MUL F8:0 100.0 L9:0",
            "CPT N7:95 ( N7:0 - F8:1 ) + N7:1",
            "CPT F8:5 F8:7 - ( F8:7 | ( N7:5 | 10.0 ) )",
            "SCP N7:0 0.0 16383.0 0.0 20.0 F8:0",
            "SCP N7:0 90.0 120.0 5.0 3.0 F8:1",
            "SCP F8:1 0.0 4000.0 0.0 100.0 N7:3",
            "SCP N7:0 0.0 N7:1 6.0 0.0 F8:1",
        ]
        .map(|rung| if rung.starts_with("CPT N7:95") { "CPT N7:45 ( N7:0 - F8:1 ) + N7:1" } else { rung }),
        Verdict::Condition,
    );
    check(
        MX,
        &["MOV F8:0 F8:1", "MOV 2.5 F8:0", "MOV 2.5 N7:0", "MOV 7 F8:0", "MOV N7:0 F8:0", "CLR F8:0"],
        Verdict::Exact,
    );
}

#[test]
fn a_float_division_by_zero_stores_the_same() {
    let floats = "MOV N7:0 F8:0\nMOV N7:1 F8:1\n";
    for (dividend, expected) in [(5, f32::INFINITY), (-3, f32::NEG_INFINITY), (0, f32::NAN)] {
        let constant = format!("DIV {dividend}.0 F8:1 F8:2");
        for divide in ["DIV N7:0 N7:1 F8:2", "DIV F8:0 F8:1 F8:2", "DIV F8:0 F8:1 F8:0 MOV F8:0 F8:2", &constant] {
            let rungs = format!("{floats}{divide}\n{TRAP}");
            let image = image(&Case { family: MX, wrap: false, rungs });
            let migration = migrate::migrate(&image, &[], &Options::default()).expect("it migrates");
            let program =
                engine::Program::compile(&migration.project, &engine::Options::default()).expect("it compiles");
            let mut domore = engine::Machine::new(program);
            let mut slc =
                sim::Machine::new(sim::Program::compile(&image, &sim::Options::default()).expect("it compiles"));
            slc.enter_run();
            domore.enter_run();
            for scan in 0..2 {
                for cell in cells(&migration, &domore).iter().filter(|cell| scan > 0 && cell.slc.to_string() == "N7:0")
                {
                    slc.set(&cell.slc, &Value::Word(dividend)).expect("a place");
                    domore.set_number(cell.domore, domore::memory::Num::Int(dividend.into()));
                }
                slc.scan(std::time::Duration::from_millis(10));
                domore.scan(std::time::Duration::from_millis(10));
            }
            let cells = cells(&migration, &domore);
            let cell = cells.iter().find(|cell| cell.slc.to_string() == "F8:2").expect("a place");
            let same = |value: f32| value == expected || value.is_nan() && expected.is_nan();
            let (a, b) = (slc.get(&cell.slc), domore.value(cell.domore));
            assert!(matches!(&a, Ok(Value::Float(a)) if same(*a)), "{divide}: {a:?}");
            assert!(matches!(&b, engine::Value::Real(b) if same(*b)), "{divide}: {b:?}");
        }
    }
}

#[test]
fn the_trap_may_wrap() {
    for rung in [
        "ADD N7:0 N7:1 N7:2",
        "SUB N7:0 N7:1 N7:0",
        "MUL N7:0 N7:1 N7:2",
        "DIV N7:0 N7:1 N7:2",
        "DIV N7:0 -1 N7:2",
        "NEG N7:0 N7:0",
        "ABS N7:0 N7:0",
        "MOV L9:0 N7:0",
        "ADD L9:0 1 L9:0",
        "ADD L9:0 L9:1 L9:2",
        "ADD L9:0 N7:1 L9:0",
        "ADD L9:0 -100 L9:0",
        "SUB L9:0 L9:1 L9:0",
        "SUB L9:0 100000 L9:1",
        "SUB 0 L9:0 L9:1",
        "NEG L9:0 L9:1",
    ] {
        let case = Case { family: MX, wrap: true, rungs: format!("{rung}\n{TRAP}") };
        assert_eq!(run(&case, 100, 5)[0], Verdict::Exact, "{rung}");
        // The program itself chooses.
        let chosen = format!("XIC B3:2/0 OTE S:2/14\n{rung}\n{TRAP}");
        let case = Case { family: MX, wrap: false, rungs: chosen };
        assert_eq!(run(&case, 100, 9)[1], Verdict::Exact, "{rung}");
    }
}

#[test]
fn flags_and_register_follow() {
    for family in [S3, MX] {
        for rung in [
            "ADD N7:0 N7:1 N7:2",
            "ADD N7:0 1 N7:0",
            "SUB N7:0 N7:1 N7:0",
            "MUL N7:0 N7:1 N7:0",
            "DIV N7:0 10 N7:0",
            "DIV N7:0 -10 N7:1",
            "DIV N7:0 N7:1 N7:1",
            "DIV N7:0 60 S:13",
            "NEG N7:0 N7:0",
            "ABS N7:0 N7:0",
            "CLR N7:0",
            "AND N7:0 N7:1 N7:2",
            "NOT N7:0 N7:0",
            "MVM N7:0 N7:1 N7:2",
            "MOV N7:0 N7:1",
            "MOV -5 N7:1",
            "TOD N7:0 N7:0",
            "FRD N7:0 N7:0",
            "ENC N7:0 N7:0",
            "SCP N7:0 0 100 0 5000 N7:1",
            "CPT N7:0 N7:1 * ( N7:2 | 100 )",
        ] {
            let rungs = format!("XIC B3:2/0 {rung}\nMOV S:0 N11:0\nMOV S:13 N11:1\nMOV S:14 N11:2\n{TRAP}");
            run(&Case { family, wrap: false, rungs }, 100, 11);
        }
    }
}

#[test]
fn addresses_decided_at_run_time() {
    check(
        MX,
        &[
            "MOV N7:[N7:50] N7:1",
            "MOV N7:0 N11:[N7:50]",
            "ADD L9:[N7:51] 1 L9:[N7:51]",
            "ADD F8:0 F8:[N7:52] F8:0",
            "ADD N11:[N7:50] 1 N11:[N7:50]",
            "SUB N7:2 N7:1 N11:[N7:50]",
            "LES N11:[N7:50] 100 OTE B3:1/0",
            "LEQ N11:[N7:50] N11:[N7:51] OTE B3:1/0",
            "CPT N11:[N7:51] ( ( N7:4 * 16 ) + N7:6 ) + 1",
            "FLL 0 #N11:[N7:50] 5",
            "COP #N11:[N7:50] #N7:0 4",
            "COP #N7:0 #N11:[N7:51] 4",
            "COP #N11:[N7:50] #N11:[N7:51] 4",
            "XIC N11:[N7:50]/[N7:51] OTE B3:1/0",
            "XIC B3:2/0 OTL N11:[N7:50]/[N7:51]",
            "XIC B3:2/0 OTE N11:[N7:50]/[N7:51]",
            "XIC B3:2/0 BSR #B10:0 R6:2 N11:[N7:50]/6 20",
        ],
        Verdict::Condition,
    );
}

#[test]
fn files_are_copied_word_by_word() {
    check(
        MX,
        &[
            "COP #N7:0 #N7:10 5",
            "COP #N7:0 #N7:1 9",
            "COP #N7:0 #N7:3 10",
            "COP #N7:5 #N7:0 10",
            "COP #N7:5 #N7:0 1",
            "COP #N11:0 #T4:0 3",
            "COP #C5:0 #N11:0 6",
            "COP #L9:0 #L9:1 4",
            "COP #F8:0 #F8:3 2",
            "COP #B3:1 #N11:0 3",
            "COP #N11:0 #B3:1 3",
            "COP #N11:0 #L9:0 3",
            "COP #L9:0 #N11:0 6",
            "CPW #L9:0 #N11:0 2",
            "CPW #N7:0 #O:0.0 2",
            "FLL 0 #N7:0 20",
            "FLL -1 #B10:2 7",
            "FLL 576 #O:0.1 2",
            "FLL N7:3 #N7:0 10",
            "FLL N7:30 #N7:0 2",
            "FLL 0 #L9:0 5",
            "FLL L9:0 #L9:1 3",
            "FLL N7:0 #L9:1 3",
            "FLL L9:0 #N7:1 3",
            "FLL 0.0 #F8:0 6",
            "FLL F8:0 #F8:1 3",
            "SWP #N7:0 1",
            "SWP #N7:2 7",
        ],
        Verdict::Exact,
    );
}

#[test]
fn shifts_and_sequencers_step_on() {
    check(
        S3,
        &[
            "XIC B3:2/0 BSL #B10:0 R6:2 B3:1/3 20",
            "XIC B3:2/0 BSR #B10:0 R6:2 B3:1/3 20",
            "XIC B3:2/0 BSL #B10:1 R6:1 N11:10/15 16",
            "XIC B3:2/0 BSR #B10:1 R6:1 N11:10/15 16",
            "XIC B3:2/0 BSL #B10:1 R6:3 R6:3/UL 37",
            "XIC B3:2/0 BSR #B10:1 R6:3 R6:3/UL 37",
            "XIC B3:2/0 SQO #N11:0 00FFh N7:3 R6:0 5 0",
            "XIC B3:2/0 SQO #N11:0 #N11:10 O:0.0 R6:0 5 0",
            "XIC B3:2/0 SQO #N11:0 -1 T4:1.PRE R6:0 5 0",
            "XIC B3:2/0 SQC #N11:0 000Fh N7:3 R6:0 5 0",
            "XIC B3:2/0 SQL #N11:0 N7:3 R6:0 5 0",
        ],
        Verdict::Exact,
    );
    check(
        S3,
        &[
            "XIC B3:2/0 FFL N7:3 #N11:0 R6:0 5 0\nXIC B3:2/1 FFU #N11:0 N7:4 R6:0 5 0",
            "XIC B3:2/0 LFL N7:3 #N11:0 R6:0 5 0\nXIC B3:2/1 LFU #N11:0 N7:4 R6:0 5 0",
        ],
        Verdict::Exact,
    );
}
