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
