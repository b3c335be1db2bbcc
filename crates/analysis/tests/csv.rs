//! The CSV tables of a small program of our own, cell by cell.

use analysis::{CrossReference, TimerFindingKind, TimerReport};
use convert::slc::rung::parse_rungs;
use ladder::{Address, AddressEntry, DataFile, Element, FileType, Image, ProgramFile, ProgramFileKind, Rung, Target};

/// Marks all instructions as verified, as in a stored project.
fn verified(mut rung: Rung) -> Rung {
    for element in &mut rung.series {
        if let Element::Instruction(instruction) = element {
            instruction.compiled = true;
        }
    }
    rung
}

fn image(text: &str) -> Image {
    let mut rungs: Vec<Rung> = parse_rungs(text, None).expect("rungs").into_iter().map(verified).collect();
    if let Some(Element::Instruction(last)) = rungs.last_mut().and_then(|rung| rung.series.last_mut()) {
        last.compiled = false;
    }
    let mut image = Image::default();
    image.program_files.push(ProgramFile {
        number: 2,
        name: "MAIN".into(),
        description: String::new(),
        kind: ProgramFileKind::Ladder,
        rungs,
    });
    let mut timers = DataFile::new(FileType::T, 4, 3);
    timers.words = vec![0xA000, 200, 7, 0x0200, 30, 0, 0, 0, 0];
    let mut counters = DataFile::new(FileType::C, 5, 1);
    counters.words = vec![0x2000, 5, 6];
    image.data_files = vec![DataFile::new(FileType::B, 3, 1), timers, counters, DataFile::new(FileType::N, 7, 10)];
    image.documentation.add(AddressEntry {
        target: Target::Address(Address::parse("T4:0").expect("address")),
        symbol: "PUMP_ON".into(),
        description: vec!["pump, \"A\"".into(), "on delay".into()],
    });
    image
}

const PROGRAM: &str = "XIC B3:0/0 TON T4:0 0.01 100 7\n\
                       XIC T4:0/DN CTU C5:0 5 6\n\
                       XIC B3:0/1 RES C5:0\n\
                       MOV T4:[N7:0].ACC N7:1\n\
                       XIC B3:0/1 TON T4:[N7:2] 1.0 5 0\n\
                       XIC NOT_THERE OTE B3:0/2\n\
                       RTO T4:1 1.0 40 0";

fn rows(write: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>) -> Vec<Vec<(String, String)>> {
    let mut bytes = Vec::new();
    write(&mut bytes).expect("writing to memory");
    let mut reader = csv::Reader::from_reader(bytes.as_slice());
    let header = reader.headers().expect("header").clone();
    let row = |record: csv::StringRecord| {
        let cells = header.iter().zip(record.iter()).filter(|(_, cell)| !cell.is_empty());
        cells.map(|(name, cell)| (name.to_owned(), cell.to_owned())).collect()
    };
    reader.records().map(|record| row(record.expect("a row"))).collect()
}

#[track_caller]
fn assert_cells(row: &[(String, String)], expected: &[(&str, &str)]) {
    let row: Vec<(&str, &str)> = row.iter().map(|(name, cell)| (name.as_str(), cell.as_str())).collect();
    assert_eq!(row, expected);
}

#[test]
fn timers_show_both_sources_of_their_values() {
    let image = image(PROGRAM);
    let xref = CrossReference::build(&image, &image.documentation);
    let rows = rows(|bytes| analysis::csv::timers(&TimerReport::build(&image, &xref), bytes));
    assert_eq!(rows.len(), 4);
    assert_cells(
        &rows[0],
        &[
            ("address", "T4:0"),
            ("kind", "timer"),
            ("usage", "active"),
            ("symbol", "PUMP_ON"),
            ("description", "pump, \"A\"\non delay"),
            ("instructions", "2:0 TON"),
            ("base", "0.01"),
            ("preset", "200"),
            ("preset_seconds", "2"),
            ("accum", "7"),
            ("accum_seconds", "0.07"),
            ("instruction_base", "0.01"),
            ("instruction_preset", "100"),
            ("instruction_accum", "7"),
            ("verified", "yes"),
            ("data_base", "0.01"),
            ("data_preset", "200"),
            ("data_accum", "7"),
            ("EN", "1"),
            ("TT", "0"),
            ("DN", "1"),
            ("read_by", "2:1 XIC DN; may 2:3 MOV ACC"),
            ("findings", TimerFindingKind::DiffersFromData.as_str()),
        ],
    );
    // Never verified: what was entered counts.
    let cell = |row: usize, name: &str| rows[row].iter().find(|(own, _)| own == name).map(|(_, cell)| cell.as_str());
    assert_eq!(cell(1, "address"), Some("T4:1"));
    assert_eq!((cell(1, "preset"), cell(1, "data_preset")), (Some("40"), Some("30")));
    assert_eq!(cell(1, "verified"), Some("no"));
    assert_cells(
        &rows[2],
        &[
            ("address", "C5:0"),
            ("kind", "counter"),
            ("usage", "active"),
            ("instructions", "2:1 CTU"),
            ("preset", "5"),
            ("accum", "6"),
            ("instruction_preset", "5"),
            ("instruction_accum", "6"),
            ("verified", "yes"),
            ("data_preset", "5"),
            ("data_accum", "6"),
            ("DN", "1"),
            ("CU", "0"),
            ("CD", "0"),
            ("OV", "0"),
            ("UN", "0"),
            ("UA", "0"),
            ("reset_by", "2:2 RES"),
            ("findings", "never read"),
        ],
    );
    assert_cells(
        &rows[3],
        &[
            ("address", "T4:[N7:2]"),
            ("kind", "timer"),
            ("usage", "run time"),
            ("instructions", "2:4 TON"),
            ("instruction_base", "1.0"),
            ("instruction_preset", "5"),
            ("instruction_accum", "0"),
            ("verified", "yes"),
        ],
    );
}

#[test]
fn every_access_is_a_row() {
    let image = image(PROGRAM);
    let xref = CrossReference::build(&image, &image.documentation);
    let rows = rows(|bytes| analysis::csv::xref(&xref, bytes));
    let of = |address: &str| {
        let first = |row: &&Vec<(String, String)>| row.first() == Some(&("address".to_owned(), address.to_owned()));
        rows.iter().filter(first).collect::<Vec<_>>()
    };
    assert_cells(
        of("T4:0/DN")[0],
        &[
            ("address", "T4:0/DN"),
            ("symbol", "PUMP_ON/DN"),
            ("description", "pump, \"A\"\non delay"),
            ("file", "2"),
            ("rung", "0"),
            ("instruction", "1"),
            ("mnemonic", "TON"),
            ("operand", "Timer"),
            ("written_as", "T4:0"),
            ("access", "read/write"),
            ("certainty", "definite"),
            ("level", "bit"),
            ("through", "operand"),
            ("touched", "T4:0/DN"),
        ],
    );
    assert_eq!(of("T4:[N7:0].ACC").len(), 1);
    assert_eq!(of("N7:0").len(), 1);
    // What cannot be told is a row too.
    let unknown = rows.iter().find(|row| row.iter().any(|(name, cell)| name == "written_as" && cell == "NOT_THERE"));
    assert_cells(
        unknown.expect("a row for the symbol"),
        &[
            ("file", "2"),
            ("rung", "5"),
            ("instruction", "0"),
            ("mnemonic", "XIC"),
            ("operand", "Bit"),
            ("written_as", "NOT_THERE"),
            ("note", "symbol without an address"),
        ],
    );
    let accesses: usize = xref.all().map(|group| group.accesses.len()).sum();
    assert_eq!(rows.len(), accesses + xref.unresolved().len() + xref.notes().len());
}
