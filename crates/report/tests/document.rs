//! The document of an example project: its sections in order, its links, the choice of sections.

use std::collections::HashSet;

use report::{Block, Document, Kind, Options, Selection, Source, Text};

fn example(name: &str) -> ladder::Project {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name);
    let bytes = std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    convert::open(&bytes, name, rss::Mode::Permissive).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn texts<'d>(document: &'d Document<'_>) -> Vec<&'d Text> {
    let mut all = Vec::new();
    for block in document.sections.iter().flat_map(|section| &section.blocks) {
        match block {
            Block::Table(table) => all.extend(table.rows.iter().flat_map(|row| &row.cells)),
            Block::Pairs(pairs) => all.extend(pairs.iter().map(|pair| &pair.value)),
            Block::Note(note) => all.push(&note.text),
            _ => {}
        }
    }
    all
}

#[test]
fn sections_stand_in_the_order_of_paper() {
    let project = example("traffic_light/traffic_light.RSS");
    let document = report::project(&Source::of(&project), &Options::default());
    let kinds: Vec<Kind> = document.chapters().map(|chapter| chapter[0].kind).collect();
    assert_eq!(kinds, Kind::all().collect::<Vec<_>>(), "every kind once, in order");
    let ladder: Vec<&str> =
        document.sections.iter().filter(|s| s.kind == Kind::Ladder).map(|s| s.title.as_str()).collect();
    assert_eq!(ladder.len(), project.main.ladder_files().count());
    for (file, title) in project.main.ladder_files().zip(&ladder) {
        assert!(title.starts_with(&format!("LAD {} - ", file.number)), "{title}");
        assert!(title.ends_with(&format!("--- Total Rungs in File = {}", file.rungs.len())), "{title}");
    }
    let rungs = document.sections.iter().flat_map(|s| &s.blocks).filter(|b| matches!(b, Block::Rung(_))).count();
    assert_eq!(rungs, project.main.ladder_files().map(|file| file.rungs.len()).sum::<usize>());
}

#[test]
fn every_link_leads_to_one_place() {
    let project = example("motor/motor.RSS");
    let document = report::project(&Source::of(&project), &Options::default());
    let mut places = HashSet::new();
    let mut place = |anchor: &report::Anchor| assert!(places.insert(anchor.clone()), "{anchor} twice");
    for section in &document.sections {
        place(&section.anchor);
        for block in &section.blocks {
            match block {
                Block::Table(table) => table.rows.iter().filter_map(|row| row.anchor.as_ref()).for_each(&mut place),
                Block::Rung(rung) => place(&rung.anchor),
                _ => {}
            }
        }
    }
    let links: Vec<_> =
        texts(&document).into_iter().flat_map(|text| &text.runs).filter_map(|run| run.link.as_ref()).collect();
    assert!(links.len() > 50, "{} links", links.len());
    for link in links {
        assert!(places.contains(link), "{link} leads nowhere");
    }
    // Addresses that rungs show lead to their cross reference.
    for rung in project.main.ladder_files().flat_map(|file| &file.rungs) {
        for address in rung.instructions().flat_map(|it| &it.operands).filter_map(ladder::Operand::address) {
            let place = document.place_of_address(&address.to_string());
            assert!(place.is_some_and(|place| places.contains(&place)), "{address}");
        }
    }
}

#[test]
fn a_word_leads_to_the_first_of_its_bits() {
    let project = example("traffic_light/traffic_light.RSS");
    let document = report::project(&Source::of(&project), &Options::default());
    let mut runs = texts(&document).into_iter().flat_map(|text| &text.runs);
    // The program names B3:0/0 only.
    let expected = report::Anchor::reference("B3:0/0");
    assert!(runs.any(|run| run.text == "B3:0" && run.link.as_ref() == Some(&expected)));
}

#[test]
fn sections_left_out_take_their_links_with_them() {
    let project = example("motor/motor.RSS");
    let sections = Selection::parse("xref,timers", "").expect("names");
    let document = report::project(&Source::of(&project), &Options { sections, date: None });
    assert_eq!(document.sections.iter().map(|s| s.kind).collect::<Vec<_>>(), [Kind::CrossReference, Kind::Timers]);
    assert!(!document.has(&report::Anchor::rung(2, 0)));
    let to_rungs = texts(&document).into_iter().flat_map(|text| &text.runs).filter_map(|run| run.link.as_ref());
    assert_eq!(to_rungs.filter(|link| link.as_str().starts_with("r-")).count(), 0);
}

#[test]
fn what_could_not_be_read_is_said_whatever_was_chosen() {
    let mut project = example("motor/motor.RSS");
    project.diagnostics.push(ladder::Diagnostic {
        severity: ladder::Severity::Error,
        place: "PROGRAM FILES".into(),
        message: "expected a rung, found the end".into(),
    });
    let sections = Selection::parse("timers", "").expect("names");
    let document = report::project(&Source::of(&project), &Options { sections, date: None });
    assert_eq!(document.notes.len(), 1);
    assert_eq!(document.notes[0].kind, report::NoteKind::Error);
    let whole = report::project(&Source::of(&project), &Options::default());
    assert!(texts(&whole).iter().any(|text| text.characters().contains("expected a rung, found the end")));
}
