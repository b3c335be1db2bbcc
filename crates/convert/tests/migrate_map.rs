//! Address maps: written, edited by a person, and read again.

mod migrate_support;

use convert::migrate::{MapRow, Options, map_file, migrate};
use ladder::{Family, Image};
use migrate_support::image;

fn program() -> Image {
    image(Family::Slc503, &[(2, "XIC I:0/3 OTE O:0/1\nADD N7:1 N7:2 N7:3\nXIC B3:1/2 OTL B3:2/3\nRTO T4:2 1.0 5 0")])
}

/// The map with the places of some rows changed.
fn edited(rows: &[MapRow], changes: &[(&str, &str)]) -> Vec<MapRow> {
    let mut rows = rows.to_vec();
    for (slc, domore) in changes {
        match rows.iter_mut().find(|row| row.slc == *slc) {
            Some(row) => row.domore = (*domore).to_owned(),
            None => rows.push(MapRow { slc: (*slc).to_owned(), domore: (*domore).to_owned(), ..MapRow::default() }),
        }
    }
    rows
}

fn code(image: &Image, map: &[MapRow]) -> Vec<String> {
    let migration = migrate(image, map, &Options::default()).expect("it migrates");
    migration.rungs.iter().map(|rung| rung.code.join("; ")).collect()
}

#[test]
fn an_unchanged_map_changes_nothing() {
    let image = program();
    let first = migrate(&image, &[], &Options::default()).expect("it migrates");
    let text = map_file::write(&first.map);
    assert!(text.starts_with("slc,last,words,domore,name,description\r\n"), "{text}");
    let rows = map_file::read(&text).expect("a map");
    assert_eq!(rows, first.map);
    let second = migrate(&image, &rows, &Options::default()).expect("it migrates");
    assert_eq!(domore::text::write(&second.project), domore::text::write(&first.project));
    assert_eq!(second.map, first.map);
}

#[test]
fn a_person_moves_words_and_single_points() {
    let image = program();
    let map = migrate(&image, &[], &Options::default()).expect("it migrates").map;
    let moved = edited(&map, &[("N7:0", "N2000"), ("B3:0", "C512"), ("I:0.0/3", "X100"), ("O:0.0", "Y32")]);
    let code = code(&image, &moved);
    let [io, sum, bits, _] = code.as_slice() else { panic!("{code:?}") };
    assert_eq!(io, "STR X100; OUT Y33");
    assert!(sum.contains("N2001") && sum.contains("N2003"), "{sum}");
    assert_eq!(bits, "STR C530; SET C547");
    // A second run with what the first wrote keeps every choice.
    let again = migrate(&image, &moved, &Options::default()).expect("it migrates").map;
    assert_eq!(self::code(&image, &again), code);
}

fn documented() -> Image {
    let mut image = program();
    for (address, symbol, description) in [
        ("I:0.0/3", "START_CONVEYOR_LINE_2", "start"),
        ("N7:1", "SPEED", "set by\nthe panel"),
        ("B3:1/2", "", "only described"),
    ] {
        let target = ladder::Target::Address(ladder::Address::parse(address).expect("address"));
        let description = description.lines().map(str::to_owned).collect();
        let symbol = symbol.to_owned();
        image.documentation.add(ladder::AddressEntry { target, symbol, description });
    }
    image
}

/// Nickname and description of an element.
fn nickname(image: &Image, map: &[MapRow], element: &str) -> (String, Vec<String>) {
    let migration = migrate(image, map, &Options::default()).expect("it migrates");
    let found = migration.project.documentation().find(|line| line.element == element).cloned();
    found.map(|line| (line.nickname, line.description)).unwrap_or_default()
}

#[test]
fn nicknames_and_descriptions_of_a_person_are_kept() {
    let image = documented();
    let first = migrate(&image, &[], &Options::default()).expect("it migrates").map;
    let shown: Vec<_> = first.iter().map(|row| (row.slc.as_str(), row.domore.as_str(), row.name.as_str())).collect();
    for row in [
        ("I:0.0/3", "X3", "START_CONVEYOR_L"),
        ("N7:1", "N1", "SPEED"),
        ("B3:1/2", "C18", ""),
        ("T4:2/DN", "N302:13", "T4_2_DN"),
    ] {
        assert!(shown.contains(&row) || row.0 == "T4:2/DN", "{row:?}: {shown:?}");
    }
    let mut edits = first.clone();
    let mut edit = |slc: &str, name: &str, description: &str| {
        let row = edits.iter_mut().find(|row| row.slc == slc && row.words == 0).expect("a row");
        (row.name, row.description) = (name.to_owned(), description.to_owned());
    };
    edit("I:0.0/3", "StartLine2", "start of line 2");
    edit("N7:1", "-", "set by the panel");
    edit("B3:1/2", "SPEED", "-");
    // An address the original says nothing about.
    edits.push(MapRow {
        slc: "N7:2".to_owned(),
        domore: "N2".to_owned(),
        name: "Offset".to_owned(),
        ..MapRow::default()
    });
    // Words that move take their names along.
    let span = edits.iter_mut().find(|row| row.slc == "N7:0" && row.words > 0).expect("the span");
    span.domore = "N2000".to_owned();
    let text = map_file::write(&edits);
    let edits = map_file::read(&text).expect("a map");
    let lines = |lines: &[&str]| lines.iter().map(|line| (*line).to_owned()).collect::<Vec<_>>();
    let mut map = edits;
    for _ in 0..3 {
        assert_eq!(
            nickname(&image, &map, "X3"),
            ("StartLine2".to_owned(), lines(&["I:0.0/3", "symbol START_CONVEYOR_LINE_2", "start of line 2"]))
        );
        assert_eq!(
            nickname(&image, &map, "N2001"),
            (String::new(), lines(&["N7:1", "symbol SPEED", "set by", "the panel"]))
        );
        assert_eq!(nickname(&image, &map, "C18"), ("SPEED".to_owned(), lines(&["B3:1/2"])));
        assert_eq!(nickname(&image, &map, "N2002"), ("Offset".to_owned(), lines(&["N7:2"])));
        // What a run writes says the same to the next one.
        map = migrate(&image, &map, &Options::default()).expect("it migrates").map;
    }
    // A map with symbols in full, as older ones have, changes nothing.
    let mut older = first.clone();
    older.iter_mut().find(|row| row.slc == "I:0.0/3").expect("a row").name = "START_CONVEYOR_LINE_2".to_owned();
    assert_eq!(nickname(&image, &older, "X3").0, "START_CONVEYOR_L");
}

#[test]
fn nicknames_that_do_not_fit_are_named_with_their_row() {
    let image = documented();
    let map = migrate(&image, &[], &Options::default()).expect("it migrates").map;
    let error = |slc: &str, words: bool, change: &dyn Fn(&mut MapRow)| {
        let mut rows = map.clone();
        let at = rows.iter().position(|row| row.slc == slc && (row.words > 0) == words).expect("a row");
        change(&mut rows[at]);
        let error = migrate(&image, &rows, &Options::default()).expect_err("refused");
        assert_eq!(error.row, at + 1, "{error}");
        error.to_string()
    };
    let named = |name: &'static str| move |row: &mut MapRow| row.name = name.to_owned();
    for (name, why) in [
        ("two words", "letters, digits and _"),
        ("nicknames_of_17_c", "has 17 characters, Designer takes 16"),
        ("X12", "reads as a number or as an element"),
        ("7seas", "reads as a number or as an element"),
        ("slcclock", "is taken by slcClock"),
        ("$MAIN", "found `$`"),
    ] {
        let found = error("I:0.0/3", false, &named(name));
        assert!(found.contains(why) && found.contains(name), "{found}");
    }
    assert!(error("N7:1", false, &named("start_conveyor_l")).contains("is taken by X3"));
    assert!(error("helper", false, &named("mine")).contains("helpers keep their names"));
    assert!(error("N7:0", true, &named("mine")).contains("for reading"));
    assert!(error("N7:1", false, &|row| row.domore = "N77".to_owned()).contains("does not begin a run"));
    assert!(error("B3:1/2", false, &|row| row.domore = "C99".to_owned()).contains("I and O only"));
    let mut twice = map.clone();
    twice.push(map.iter().find(|row| row.slc == "N7:1").expect("a row").clone());
    twice.last_mut().expect("a row").name = "Other".to_owned();
    let error = migrate(&image, &twice, &Options::default()).expect_err("refused");
    assert!(error.row == twice.len() && error.what.contains("already"), "{error}");
}

#[test]
fn a_part_of_a_map_is_enough() {
    let row = MapRow { slc: "N7:0".to_owned(), domore: "N100".to_owned(), ..MapRow::default() };
    let code = code(&program(), &[row]);
    assert!(code.iter().any(|rung| rung.contains("N101 + N102") || rung.contains("N103")), "{code:?}");
}

#[test]
fn what_does_not_fit_is_named() {
    let image = program();
    let map = migrate(&image, &[], &Options::default()).expect("it migrates").map;
    let error = |changes: &[(&str, &str)]| {
        migrate(&image, &edited(&map, changes), &Options::default()).expect_err("refused").to_string()
    };
    assert!(error(&[("N7:0", "C0")]).contains("N7:0 cannot lie in C0"), "{}", error(&[("N7:0", "C0")]));
    assert!(error(&[("N7:0", "nowhere")]).contains("expected an element"));
    assert!(error(&[("B3:0", "C8")]).contains("multiple of 16"));
    assert!(error(&[("N7:0", "N30")]).contains("overlap"));
    assert!(error(&[("I:0.0/3", "X4")]).contains("both X4"));
    assert!(error(&[("N99:0", "N3000")]).contains("N99:0 is not in the program"));
    assert!(error(&[("N7:5", "N3000")]).contains("does not begin a run"));
    assert!(error(&[("N7:", "N3000")]).contains("not an address"));
}

#[test]
fn a_text_that_is_no_map_is_refused() {
    for (text, why) in [
        ("", "columns named slc and domore"),
        ("a,b\n1,2\n", "columns named slc and domore"),
        ("slc,domore,words\nN7:0,N0,many\n", "row 1: expected a number of words"),
    ] {
        let error = map_file::read(text).expect_err(text).to_string();
        assert!(error.contains(why), "{text}: {error}");
    }
    // Spreadsheets put a mark before the first name and leave columns out.
    let rows = map_file::read("\u{feff}slc,domore\nN7:0,N5\n").expect("a map");
    assert_eq!(rows.len(), 1);
}
