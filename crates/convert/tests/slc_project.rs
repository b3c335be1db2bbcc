//! `.SLC` files and the program model: what is read, and that our own export gives everything back.

use convert::slc::file;
use convert::slc::project::{export, project, read};
use convert::slc::rung::{UNREAD, parse_rung, rung_text};
use ladder::{
    AddressEntry, Comment, CommentOwner, DataFile, Family, FileType, Force, Image, IoRange, Module, ProgramFile,
    ProgramFileKind, Rung, Severity, Slot, Target,
};
use proptest::prelude::*;

const SAMPLE: &str = "\
START Bul.1766    % Bul.1766     MicroLogix 1400 Series B %

SLOT 0 Bul.1766    % Bul.1766     MicroLogix 1400 Series B %  SCAN_IN 8 SCAN_OUT 6  G_FILE 2
     526 255 IOCARD 4625 0 8 0 0 6 0 0 0 2 0 0
SLOT 2 1762-IQ8    % 8-Input 10/30 VDC %  SCAN_IN 1 SCAN_OUT 0
SLOT 3 1762-OW16   % 16-Output Relay %  SCAN_IN 0 SCAN_OUT 1

PROJECT \"PUMP\"
  2  \"MAIN\"
  4  \"OLD\"

LADDER 2
% Rung: 0 %
SOR XIC I:2/7 OSR B3:0/0 B3:0/1 OTE O:3/15 EOR
% TITLE/RUNG DESCRIPTION
TITLE: Page 1
RUNG DESCRIPTION: first
second %
% Rung: 1 %
SOR XIC B3:0/0 XYZ 5 EOR
LADDER 5
SOR TON T4:0 1.0 60 0 EOR

DATA O:3
% O:3.0 % 0X8000
DATA I:0
% I:0.0 % 0X0000 0X0000 0X0000 0X0000 0X0000 0X0000 0X0000 0X0001
DATA I:2
% I:2.0 % 0X0002
DATA S:0
% S:0 % 4 16384
DATA T4:0
% .CTL .PRE .ACC %
0X0200 60 0 % T4:0 %
DATA N10:0
% N10:0 % 1 2 3
DATA XYZ11:0
% XYZ11:0 % 1
DATA RTC0:0
% RTC0:0 %
2024 1 2 3 4 5 6 0X0000
FORCE O:03
% ON OFF %
0X0001 0X7FFF % FORCE O:3.0 %
FORCE I:09
0X0001 0XFFFF % FORCE I:9.0 %
";

#[test]
fn a_text_becomes_a_project() {
    let project = read(SAMPLE).expect("a project");
    let image = &project.main;
    let processor = &image.processor;
    assert_eq!((image.family(), processor.model), (Family::MicroLogix1400, Some(63)));
    assert_eq!(processor.name.as_deref(), Some("MicroLogix 1400 Series B"));
    assert_eq!(processor.project_name, "PUMP");
    assert_eq!(processor.deny_future_access, Some(true));
    assert_eq!(image.io.base_unit, "BWA");
    let slot = &image.io.slots[1];
    assert_eq!(slot.inputs, IoRange { first_word: 8, words: 1, bits: 8 });
    assert_eq!(slot.module.identity, "vendor 1, type 7, code 96");
    assert_eq!(image.io.slots[2].outputs, IoRange { first_word: 6, words: 1, bits: 16 });

    let kinds: Vec<_> = image.program_files.iter().map(|f| (f.number, f.kind, f.name.as_str())).collect();
    use ProgramFileKind::{Ladder, System, Unused};
    assert_eq!(
        kinds,
        [(0, System, ""), (1, System, ""), (2, Ladder, "MAIN"), (3, Unused, ""), (4, Unused, "OLD"), (5, Ladder, "")]
    );
    let rungs = &image.program_files[2].rungs;
    assert_eq!(rung_text(&rungs[0]), "XIC I:2.0/7 OSR B3:0/0 B3:0/1 OTE O:3.0/15");
    let comment = Comment {
        text: "first\r\nsecond".into(),
        title: "Page 1".into(),
        owner: CommentOwner::Rung { file: 2, rung: 0 },
    };
    assert_eq!(rungs[0].comment, Some(comment));
    assert_eq!(rungs[1].instructions().next().map(|i| i.mnemonic.to_string()).as_deref(), Some(UNREAD));
    assert_eq!(rung_text(&rungs[1]), "XIC B3:0/0 XYZ 5");
    assert!(rungs[2].is_end());

    let table = |file_type, number| image.data_file(file_type, number).expect("data file");
    assert_eq!(table(FileType::O, 0).words, [0, 0, 0, 0, 0, 0, 0x8000]);
    assert_eq!(table(FileType::O, 0).forces[6], Force { on: 1, off: 0x7FFF });
    assert_eq!((table(FileType::I, 1).words[7], table(FileType::I, 1).words[8]), (1, 2));
    assert_eq!(table(FileType::T, 4).timer(0).map(|t| t.pre), Some(60));
    assert_eq!(table(FileType::RTC, 0).words[0], 2024);
    assert!(image.data_files.iter().any(|file| file.number == 9 && file.file_type == FileType::Unused));
    let wrong: Vec<_> = project.diagnostics.iter().map(|d| (d.severity, d.place.as_str())).collect();
    assert_eq!(
        wrong,
        [
            (Severity::Error, "line 38"),
            (Severity::Error, "file 2 > rung 1"),
            (Severity::Error, "DATA XYZ11"),
            (Severity::Error, "FORCE I:09")
        ]
    );
    assert!(project.diagnostics[1].message.contains("line 20, column 16"), "{}", project.diagnostics[1].message);
}

#[test]
fn other_texts_are_refused() {
    for text in ["", "hello\nworld", "%PDF-1.4", "{\"schema\":1}"] {
        assert!(read(text).is_err(), "{text}");
    }
    assert!(read("LADDER 2\nSOR EOR").is_ok());
}

#[test]
fn what_the_text_cannot_hold_is_said() {
    let mut image = read(SAMPLE).expect("a project").main;
    image.documentation.add(AddressEntry {
        target: Target::Address(ladder::Address::parse("N10:0").expect("address")),
        symbol: "COUNT".into(),
        description: Vec::new(),
    });
    image.data_files.push(DataFile::new(FileType::Unknown(99), 12, 1));
    image.program_files[2].rungs[0] = parse_rung("MSG MG9:0 N7:0", None).expect("rung");
    if let Some(ladder::Element::Instruction(message)) = image.program_files[2].rungs[0].series.first_mut() {
        message.message = Some(Box::default());
    }
    let notes: Vec<String> = export(&image).notes.iter().map(|d| format!("{}: {}", d.place, d.message)).collect();
    for expected in [
        "file 2 > rung 0: not in the text: the settings",
        "data file ?99-12: not",
        "symbols and descriptions of addresses (1)",
    ] {
        assert!(notes.iter().any(|note| note.contains(expected)), "{expected}: {notes:#?}");
    }
}

/// Everything the text carries.
#[track_caller]
fn assert_same(a: &Image, b: &Image) {
    assert_eq!(a.processor.catalog, b.processor.catalog);
    assert_eq!(a.processor.name, b.processor.name);
    assert_eq!(a.processor.project_name, b.processor.project_name);
    for (a, b) in a.program_files.iter().zip(&b.program_files) {
        assert_eq!((a.number, a.kind, &a.name), (b.number, b.kind, &b.name));
        assert_eq!(a.rungs.len(), b.rungs.len());
        for (index, (x, y)) in a.rungs.iter().zip(&b.rungs).enumerate() {
            assert!(x.same_logic(y), "file {} rung {index}: {} | {}", a.number, rung_text(x), rung_text(y));
            let texts = |rung: &Rung| rung.comment.as_ref().map(|c| (c.text.clone(), c.title.clone()));
            assert_eq!(texts(x), texts(y));
        }
    }
    assert_eq!(a.program_files.len(), b.program_files.len());
    let tables = |image: &Image| {
        let used = |file: &&DataFile| !matches!(file.file_type, FileType::Unused | FileType::Reserved);
        let all = image.data_files.iter().filter(used).chain(&image.function_files);
        all.map(|f| (f.file_type, f.number, f.elements, f.words.clone(), f.forces.clone())).collect::<Vec<_>>()
    };
    assert_eq!(tables(a), tables(b));
    let slots = |image: &Image| {
        let slots = image.io.slots.iter();
        slots
            .map(|s| (s.number, s.inputs, s.outputs, s.configuration.clone(), s.module.catalog.clone()))
            .collect::<Vec<_>>()
    };
    assert_eq!(slots(a), slots(b));
}

#[test]
fn the_sample_comes_back() {
    let image = read(SAMPLE).expect("a project").main;
    let made = export(&image);
    let text = made.file.write();
    let parsed = file::read(&text);
    assert_eq!(parsed.diagnostics, [], "{text}");
    assert_eq!(parsed.write(), text);
    assert_same(&project(&parsed).main, &image);
    assert_eq!(export(&project(&parsed).main), made);
}

fn comment() -> impl Strategy<Value = Option<(String, String)>> {
    let line = prop_oneof![
        "[ -~]{0,12}",
        Just("100 %".to_owned()),
        Just("TITLE: x".to_owned()),
        Just("RUNG DESCRIPTION:".to_owned()),
        Just("% Rung: 1 %".to_owned()),
        Just("% \\".to_owned()),
        Just("DATA N7:0".to_owned()),
    ];
    let text = prop::collection::vec(line, 0..5).prop_map(|lines| lines.join("\r\n"));
    prop::option::weighted(0.4, ("[ -~]{0,10}", text))
}

fn rung() -> impl Strategy<Value = Rung> {
    let text = prop::sample::select(vec![
        "XIC B3:0/0 OTE B3:0/1",
        "BST XIC I:0/0 NXB BND OTE O:0/1",
        "TON T4:0 0.01 100 0",
        "SOR EOR",
        "CPT N7:0 ( N7:1 + 5 ) * 2",
        "op0x4D( N7:0 \"a b\" )",
        "XIC \"% x %\" JSR 3 LBL Q2:1 MSG MG9:0 N7:0",
        "OSR B3:0/0 B3:0/1",
        "MOV \"SOR\" ?",
    ]);
    (text, comment()).prop_map(|(text, comment)| {
        let mut rung = parse_rung(text, None).expect("one of our rungs");
        rung.comment =
            comment.map(|(title, text)| Comment { text, title, owner: CommentOwner::Rung { file: 0, rung: 0 } });
        rung
    })
}

fn table(number: u16) -> impl Strategy<Value = DataFile> {
    use FileType::*;
    let types = vec![B, T, C, R, N, F, A, ST, L, PD, MG, PLS, RIX, D, G, Unused];
    (prop::sample::select(types), 0..13_u16, any::<u64>()).prop_map(move |(file_type, elements, seed)| {
        let elements = if file_type == Unused { 0 } else { elements };
        filled(DataFile::new(file_type, number, elements), seed)
    })
}

/// Words of every size and sign, and now and then a string that is one.
fn filled(mut file: DataFile, mut seed: u64) -> DataFile {
    for word in &mut file.words {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        *word = match seed >> 61 {
            0 | 1 => 0,
            2 => (seed >> 40) as u16 & 0x7F,
            3 => u16::MAX,
            _ => (seed >> 40) as u16,
        };
    }
    if file.file_type == FileType::ST {
        for element in file.words.chunks_mut(42) {
            if let Some(length) = element.first_mut() {
                *length %= 90;
            }
        }
    }
    file
}

fn function_files() -> impl Strategy<Value = Vec<DataFile>> {
    use FileType::*;
    let sizes =
        [(HSC, 18), (PTO, 12), (PTOX, 15), (PWM, 8), (PWMX, 10), (STI, 4), (RTC, 8), (MMI, 8), (TPI, 3), (LCD, 16)];
    let file = |(file_type, words): (FileType, u16), seed: u64, elements: u16| {
        let mut file = DataFile::new(file_type, 0, elements);
        file.words_per_element = words;
        file.words = vec![0; usize::from(elements * words)];
        filled(file, seed)
    };
    (any::<u64>(), prop::collection::vec(1..4_u16, sizes.len()), 0..80_u16).prop_map(move |(seed, elements, status)| {
        let mut files: Vec<DataFile> =
            sizes.iter().zip(elements).map(|(size, elements)| file(*size, seed, elements)).collect();
        files.extend(
            [(CS, 0), (IOS, 0), (ES, 1), (CS, 2)].map(|(file_type, number)| DataFile {
                number,
                ..filled(DataFile::new(file_type, number, status), seed)
            }),
        );
        files
    })
}

fn slots() -> impl Strategy<Value = Vec<Slot>> {
    prop::collection::vec((0..4_u16, 0..4_u16, any::<bool>(), prop::collection::vec(any::<u16>(), 0..20)), 0..5)
        .prop_map(|sizes| {
            let (mut input, mut output) = (0, 0);
            (0..)
                .zip(sizes)
                .map(|(number, (inputs, outputs, known, configuration))| {
                    let range = |first: &mut u16, words: u16| {
                        let range = IoRange { first_word: *first, words, bits: 16 * words };
                        *first += words;
                        range
                    };
                    let controller = number == 0;
                    Slot {
                        number,
                        module: Module {
                            catalog: match (controller, known) {
                                (true, _) => Some("Bul.1766".into()),
                                (false, true) => Some("1762-IF4".into()),
                                (false, false) => None,
                            },
                            description: "4-Channel Analog".into(),
                            identity: if controller { "base unit 0x1211".into() } else { String::new() },
                            confidence: ladder::Confidence::Proven,
                        },
                        inputs: range(&mut input, inputs),
                        outputs: range(&mut output, outputs),
                        configuration,
                    }
                })
                .collect()
        })
}

fn image() -> impl Strategy<Value = Image> {
    let programs = prop::collection::vec(prop::collection::vec(rung(), 0..4), 1..4);
    let tables: Vec<_> = (3..14_u16).map(table).collect();
    (programs, tables, function_files(), slots(), any::<u64>()).prop_map(
        |(programs, tables, functions, slots, seed)| {
            let mut image = Image::default();
            image.processor.catalog = Some("Bul.1766".into());
            image.processor.name = Some("MicroLogix 1400 Series B".into());
            image.processor.family = Family::MicroLogix1400;
            image.processor.project_name = "A \"quoted\" name".into();
            let file = |number, kind, rungs| ProgramFile {
                number,
                name: if number == 2 { "MAIN".into() } else { String::new() },
                description: String::new(),
                kind,
                rungs,
            };
            image.program_files =
                vec![file(0, ProgramFileKind::System, vec![]), file(1, ProgramFileKind::System, vec![])];
            for (number, mut rungs) in (2..).zip(programs) {
                rungs.push(parse_rung("END", None).expect("END"));
                image.program_files.push(file(number, ProgramFileKind::Ladder, rungs));
            }
            let words = |range: fn(&Slot) -> IoRange| slots.iter().map(|slot| range(slot).words).sum();
            for (file_type, elements) in [(FileType::O, words(|s| s.outputs)), (FileType::I, words(|s| s.inputs))] {
                let elements = if slots.is_empty() { 3 } else { elements };
                let mut file = DataFile::new(file_type, file_type.implied_file().unwrap_or(0), elements);
                if !slots.is_empty() {
                    let masks = filled(file.clone(), seed).words;
                    for (force, word) in file.forces.iter_mut().zip(masks) {
                        *force = Force { on: word, off: !word };
                    }
                }
                // A table without words leaves no section.
                if elements > 0 {
                    image.data_files.push(filled(file, seed));
                }
            }
            image.data_files.push(filled(DataFile::new(FileType::S, 2, 66), seed));
            image.data_files.extend(tables);
            image.function_files = functions;
            image.io.slots = slots;
            image
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn exports_come_back(image in image()) {
        let text = export(&image).file.write();
        let parsed = file::read(&text);
        prop_assert!(parsed.diagnostics.is_empty(), "{:#?}", parsed.diagnostics);
        prop_assert_eq!(parsed.write(), text.clone());
        let again = project(&parsed);
        prop_assert!(again.diagnostics.iter().all(|d| d.severity < Severity::Error), "{:#?}", again.diagnostics);
        assert_same(&again.main, &image);
        prop_assert_eq!(export(&again.main).file.write(), text);
    }
}
