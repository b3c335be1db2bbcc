//! Projects made of text: what the text says is in the file that is written, or somebody is told.

use convert::from_rss;
use ladder::{Project, Severity, Source};
use rss::Mode;

/// A text for a processor that is known, before its ladder.
const START: &str = "START Bul.1766 % Bul.1766     MicroLogix 1400 Series B %\n\nLADDER 2\n";

/// The project a text gives once it was written and read again, and the notes of the writer.
#[track_caller]
fn built(text: &str) -> (Project, Vec<(Severity, String)>) {
    let project = convert::slc::project::read(text).expect("an SLC text");
    assert!(project.diagnostics.iter().all(|d| d.severity < Severity::Error), "{:#?}", project.diagnostics);
    let built = convert::to_rss::project_file(&project).expect("a project file");
    let bytes = built.file.write().expect("written");
    let file = rss::Project::read(&bytes, Mode::Strict).expect("read");
    let notes = built.notes.into_iter().map(|note| (note.severity, format!("{}: {}", note.place, note.message)));
    (from_rss::project(&file, Source::default()), notes.collect())
}

#[track_caller]
fn words(project: &Project, address: &str) -> [u16; 3] {
    let address = ladder::Address::parse(address).expect("an address");
    let number = address.file.number().expect("a file");
    let file = project.main.data_file(address.file_type, number).expect("a data file");
    let at = usize::from(address.element.number().expect("an element")) * 3;
    file.words.get(at..at + 3).expect("an element").try_into().expect("three words")
}

#[test]
fn parameters_of_the_text_set_elements_no_table_gives() {
    let text = format!(
        "{START}SOR TON T4:0 1.0 10 3 TOF T4:3 0.001 7 0 CTU C5:0 33 1 EOR\n\
         SOR BSL #B3:0 R6:0 I:0/0 33 EOR\nSOR SQO #N7:0 FFFFh N8:0 R6:1 4 2 EOR\nSOR FFL N7:0 #N13:0 R6:2 12 5 EOR\n"
    );
    let (project, notes) = built(&text);
    assert_eq!(words(&project, "T4:0"), [0x0200, 10, 3]);
    assert_eq!(words(&project, "T4:3")[1..], [7, 0]);
    assert_eq!(
        project.main.data_file(ladder::FileType::T, 4).and_then(|f| f.timer(3)?.base()),
        Some(ladder::TimeBase::Millisecond)
    );
    assert_eq!(words(&project, "C5:0")[1..], [33, 1]);
    assert_eq!((words(&project, "R6:0")[1], words(&project, "R6:1")[1..].to_vec()), (33, vec![4, 2]));
    assert_eq!(words(&project, "R6:2")[1..], [12, 5]);
    let elements = |file_type, number| project.main.data_file(file_type, number).map(|file| file.elements);
    use ladder::FileType::{B, N};
    assert_eq!((elements(B, 3), elements(N, 7), elements(N, 13)), (Some(3), Some(5), Some(12)));
    assert!(notes.iter().all(|note| note.0 < Severity::Warning), "{notes:#?}");
}

#[test]
fn a_table_counts_and_a_difference_is_told() {
    let text = format!(
        "{START}SOR TON T4:0 1.0 10 0 EOR\nSOR TON T4:1 0.01 20 0 EOR\n\n\
         DATA T4:0\n% .CTL .PRE .ACC %\n0X0200 60 4 % T4:0 %\n"
    );
    let (project, notes) = built(&text);
    assert_eq!(words(&project, "T4:0"), [0x0200, 60, 4]);
    assert_eq!(words(&project, "T4:1")[1], 20);
    let warned: Vec<_> = notes.iter().filter(|note| note.0 == Severity::Warning).map(|note| note.1.as_str()).collect();
    assert_eq!(
        warned,
        [
            "T4:0: an instruction shows PRE 10 (the data table holds 60), ACC 0 (the data table holds 4); the data table counts"
        ]
    );
}

#[test]
fn two_instructions_that_differ_on_one_element_are_told() {
    let (project, notes) = built(&format!("{START}SOR TON T4:0 1.0 10 0 EOR\nSOR TON T4:0 1.0 99 0 EOR\n"));
    assert_eq!(words(&project, "T4:0")[1], 10);
    assert!(notes.iter().any(|note| note.0 == Severity::Warning && note.1.contains("PRE 99")), "{notes:#?}");
}

#[test]
fn lengths_size_the_tables() {
    let (project, _) = built(&format!("{START}SOR COP #N7:0 #N10:0 10 COP #T4:0 #T4:5 2 FLL 0 #N11:0 10 EOR\n"));
    let elements = |file_type, number| project.main.data_file(file_type, number).map(|file| file.elements);
    use ladder::FileType::{N, T};
    assert_eq!((elements(N, 7), elements(N, 10), elements(N, 11)), (Some(10), Some(10), Some(10)));
    assert_eq!(elements(T, 4), Some(7));
    let given = format!("{START}SOR COP #N7:0 #N10:0 10 EOR\n\nDATA N10:0\n% N10:0 % 1 2\n");
    let (project, notes) = built(&given);
    assert_eq!(project.main.data_file(N, 10).map(|file| file.elements), Some(2));
    assert!(notes.iter().any(|note| note.1.contains("the table has 2")), "{notes:#?}");
}

/// The errors of reading a text, each with its place.
fn errors(text: &str) -> Vec<String> {
    let project = convert::slc::project::read(text).expect("an SLC text");
    let errors = project.diagnostics.into_iter().filter(|d| d.severity == Severity::Error);
    errors.map(|d| format!("{}: {}", d.place, d.message)).collect()
}

#[test]
fn what_a_project_would_lack_is_an_error_with_its_line() {
    for (lines, expected) in [
        ("SOR XIC B3:0/0 OTE B3:0/1 EOR\nXIC B3:0/2 OTE B3:0/3\n", "line 5: expected a rung"),
        ("sor XIC B3:0/0 OTE B3:0/1 eor\n", "line 4: expected a rung"),
        ("SOR EOR\nLADDRE 3\nSOR XIC B3:0/0 OTE B3:0/1 EOR\n", "line 5: expected a rung"),
        ("SOR EOR\nRACK 1 1746-A7 % 7 slots %\n", "line 5: expected a rung"),
        ("SOR EOR\nDATTA N7:0\n% N7:0 % 1 2\n", "line 5: expected a rung"),
        ("SOR EOR\nDATA N7:0\n% N7:0 % 1 2 x\n", "line 6: expected a row of data"),
        ("SOR EOR\nLADDER 300\nSOR EOR\n", "LADDER 300: expected program files from 2 to 255"),
        ("SOR END EOR\nSOR XIC B3:0/0 OTE B3:0/1 EOR\n", "line 4: END ends the program file, and 1 more"),
        ("SOR TON T4:0 0.02 5 0 EOR\n", "line 4: TON T4:0: expected a time base of 0.001, 0.01 or 1.0, found 0.02"),
        ("SOR TON T4:0 0.01 40000 0 EOR\n", "line 4: TON T4:0: expected a preset up to 32767, found 40000"),
    ] {
        let found = errors(&format!("{START}{lines}"));
        assert!(found.iter().any(|error| error.contains(expected)), "{lines}: {found:#?}");
    }
    assert_eq!(errors(&format!("{START}SOR XIC B3:0/0 OTE B3:0/1 EOR\nSOR END EOR\n")), [""; 0]);
    let section = "START Bul.1766 % x %\n\nLADDRE 2\n\nDATA N7:0\n% N7:0 % 1\n";
    assert!(errors(section)[0].starts_with("line 3: expected a section, found `LADDRE 2`"), "{:?}", errors(section));
}

/// The family's confidence and the notes about the processor of a text with this START line.
fn processor(start: &str) -> Result<(Option<u16>, ladder::Confidence, Vec<String>), String> {
    let project = convert::slc::project::read(&format!("START {start}\n\nLADDER 2\nSOR EOR\n")).expect("an SLC text");
    let built = convert::to_rss::project_file(&project).map_err(|error| error.to_string())?;
    let file = rss::Project::read(&built.file.write().expect("written"), Mode::Strict).expect("read");
    let processor = from_rss::project(&file, Source::default()).main.processor;
    let notes = built.notes.iter().filter(|note| note.place == "processor").map(|note| note.message.clone());
    Ok((processor.model, processor.family_confidence, notes.collect()))
}

#[test]
fn another_controller_is_never_written_silently() {
    use ladder::Confidence::{Proven, Weak};
    let named = processor("Bul.1766 % Bul.1766     MicroLogix 1400 Series A %");
    assert_eq!(named, Ok((Some(62), Proven, Vec::new())));
    for (start, model, said) in [
        ("Bul.1766 % Bul.1766 %", 63, "written as Bul.1766 MicroLogix 1400 Series B, not MicroLogix 1400 Series A"),
        ("Bul.1761 % Bul.1761 %", 28, "written as Bul.1761 MicroLogix 1000, not MicroLogix 1000 DH-485"),
        ("1747-L40A % 1747-L40A %", 8, "1747-L40A does not tell the model"),
    ] {
        let (code, confidence, notes) = processor(start).expect("a known family");
        assert_eq!((code, confidence), (Some(model), Weak), "{start}");
        assert!(notes.iter().any(|note| note.contains(said)), "{start}: {notes:#?}");
    }
    for start in ["1747-L20A % 1747-L20A %", "1747-L20A", "1747-L532 % 1747-L532B 5/03 %"] {
        let why = processor(start).expect_err("refused");
        assert!(why.contains("no model number is known") && why.contains(&start[..9]), "{why}");
    }
}

#[test]
fn a_processor_of_unknown_model_keeps_its_number() {
    let (mut project, _) = built(&format!("{START}SOR XIC B3:0/0 OTE B3:0/1 EOR\n"));
    let processor = &mut project.main.processor;
    (processor.model, processor.catalog, processor.name) = (Some(20), None, None);
    (processor.family, processor.reported_type) = (ladder::Family::Unknown, Some(0x9F));
    "HOST!AB_ETH-1\\10.0.0.1".clone_into(&mut processor.route);
    project.main.io = ladder::IoConfiguration::default();
    let text = convert::json::to_json_text(&project);
    let project = convert::json::from_json(&text).expect("a document");
    let built = convert::to_rss::project_file(&project).expect("a project file");
    let file = rss::Project::read(&built.file.write().expect("written"), Mode::Permissive).expect("read");
    let back = from_rss::project(&file, Source::default()).main;
    assert_eq!((back.processor.model, back.processor.reported_type), (Some(20), Some(0x9F)));
    assert_eq!(back.processor.route, "HOST!AB_ETH-1\\10.0.0.1");
    assert_eq!(back.ladder_files().count(), 1);
    assert!(built.notes.iter().any(|note| note.message.contains("model 20 is not known")), "{:#?}", built.notes);
}

#[test]
fn what_a_file_will_not_hold_is_told() {
    let (mut project, _) = built(&format!("{START}SOR JSR 9 EOR\n"));
    project.online = Some(project.main.clone());
    let built = convert::to_rss::project_file(&project).expect("a project file");
    let notes: Vec<String> = built.notes.iter().map(|note| format!("{}: {}", note.place, note.message)).collect();
    for expected in ["online image: is not written", "file 2 > rung 0: JSR 9: there is no such program file"] {
        assert!(notes.iter().any(|note| note.starts_with(expected)), "{expected}: {notes:#?}");
    }
}

#[test]
fn any_character_of_a_comment_survives_the_text() {
    let text = format!("{START}SOR XIC B3:0/0 OTE B3:0/1 EOR\n");
    let mut project = convert::slc::project::read(&text).expect("an SLC text");
    let comment = ladder::Comment {
        text: "a\u{1}b\u{1B}[31m\u{0}\r\n\u{B}c".to_owned(),
        title: "\u{7F}".to_owned(),
        owner: ladder::CommentOwner::Rung { file: 2, rung: 0 },
    };
    project.main.program_files[2].rungs[0].comment = Some(comment.clone());
    let bytes = convert::slc::encode(&convert::slc::project::export(&project.main).file.write());
    let back = convert::open(&bytes, "a.SLC", Mode::Strict).expect("our own text");
    assert_eq!(back.main.program_files[2].rungs[0].comment, Some(comment));
}

#[test]
fn strict_reading_names_the_deviation_once() {
    let text = format!("{START}sor XIC B3:0/0 eor\n");
    let error = convert::open(text.as_bytes(), "a.SLC", Mode::Strict).expect_err("a deviation").to_string();
    assert!(error.starts_with("strict reading: line 4: expected a rung"), "{error}");
    assert_eq!(error.matches("found").count(), 1, "{error}");
}
