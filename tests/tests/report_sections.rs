//! A report has every section that RSLogix printed of the same project, in the same order and of the same size.

use std::path::Path;

use report::{Block, Document, Kind, Options, Section, Source};
use rungs_tests::{corpus, printout};

/// Reports and the projects they were printed from.
const PAIRS: [(&str, &str); 3] = [
    (
        "PLC_reject_timing/TVZ_1100_REV02_LatchmoorAnnotations.pdf.txt",
        "PLC_reject_timing/TVZ_1100_REV02_LatchmoorAnnotations.RSS",
    ),
    (
        "pressure_control_via_fan_velocity/pressure_control.pdf.txt",
        "pressure_control_via_fan_velocity/pressure_control.RSS",
    ),
    ("PLC_reject_timing/lecky_demo.pdf.txt", "PLC_reject_timing/lecky_demo.RSS"),
];

fn project(path: &Path) -> ladder::Project {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    convert::open(&bytes, "x.RSS", rss::Mode::Permissive).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn squeezed(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The title below the head of each page, each once, in printed order. A cover has none.
fn titles(text: &str) -> Vec<String> {
    let mut titles: Vec<String> = Vec::new();
    for page in text.split('\u{C}') {
        let mut lines = page.lines().map(squeezed).filter(|line| !line.is_empty());
        if let (Some(_), Some(title)) = (lines.next(), lines.next())
            && !titles.contains(&title)
        {
            titles.push(title);
        }
    }
    titles
}

fn rows(section: &Section<'_>) -> Vec<Vec<String>> {
    let tables = section.blocks.iter().filter_map(|block| match block {
        Block::Table(table) => Some(&table.rows),
        _ => None,
    });
    tables.flatten().map(|row| row.cells.iter().map(report::Text::characters).collect()).collect()
}

fn only<'d>(document: &'d Document<'_>, kind: Kind) -> &'d Section<'d> {
    document
        .sections
        .iter()
        .find(|section| section.kind == kind)
        .unwrap_or_else(|| panic!("no section {}", kind.name()))
}

#[test]
fn every_printed_section_is_there() {
    let Some(root) = corpus::root() else { return };
    for (paper, file) in PAIRS {
        let text = String::from_utf8_lossy(&std::fs::read(root.join(paper)).expect(paper)).into_owned();
        let project = project(&root.join(file));
        let document = report::project(&Source::of(&project), &Options::default());
        let ours: Vec<String> = document.sections.iter().map(|section| squeezed(&section.title)).collect();
        let mut last = 0;
        let printed = titles(&text);
        assert!(printed.len() > 8, "{paper}: {} sections", printed.len());
        for title in &printed {
            let at = ours.iter().position(|own| own == title || own.starts_with(&format!("{title} - ")));
            let at = at.unwrap_or_else(|| panic!("{paper}: `{title}` is missing in {ours:#?}"));
            assert!(at >= last, "{paper}: `{title}` stands elsewhere");
            last = at;
        }
        println!("{paper}: {} printed sections", printed.len());
    }
}

#[test]
fn sections_are_as_large_as_printed() {
    let Some(root) = corpus::root() else { return };
    for (paper, file) in PAIRS {
        let text = String::from_utf8_lossy(&std::fs::read(root.join(paper)).expect(paper)).into_owned();
        let printed = printout::parse(&text);
        let project = project(&root.join(file));
        let document = report::project(&Source::of(&project), &Options::default());
        if let Some(files) = &printed.program_files {
            let ours: Vec<_> =
                rows(only(&document, Kind::ProgramFiles)).iter().map(|row| (row[1].clone(), row[3].clone())).collect();
            let theirs: Vec<_> = files.iter().map(|row| (row.number.to_string(), row.rungs.to_string())).collect();
            assert_eq!(ours, theirs, "{paper}: program files");
        }
        if let Some(files) = &printed.data_files {
            let ours: Vec<_> =
                rows(only(&document, Kind::DataFiles)).iter().map(|row| (row[1].clone(), row[4].clone())).collect();
            let theirs: Vec<_> = files.iter().map(|row| (row.number.to_string(), row.elements.to_string())).collect();
            assert_eq!(ours, theirs, "{paper}: data files");
        }
        if let Some(symbols) = &printed.symbols {
            // Paper has no entries for the files themselves.
            let is_file = |row: &&Vec<String>| row[0].contains(" file ") || row[0].starts_with("U:");
            let ours = rows(only(&document, Kind::Symbols));
            let ours: Vec<&String> = ours.iter().filter(|row| !is_file(row)).map(|row| &row[1]).collect();
            let theirs: Vec<&String> = symbols.iter().map(|row| &row.symbol).collect();
            assert_eq!(ours.len(), theirs.len(), "{paper}: symbols");
            for symbol in theirs {
                assert!(ours.contains(&symbol), "{paper}: {symbol}");
            }
        }
        for ladder in &printed.ladder {
            let section = document.sections.iter().find(|s| s.anchor == report::Anchor::file(ladder.number));
            let section = section.unwrap_or_else(|| panic!("{paper}: file {}", ladder.number));
            let drawn = section.blocks.iter().filter(|block| matches!(block, Block::Rung(_))).count();
            assert_eq!(drawn, ladder.rungs.len(), "{paper}: file {}", ladder.number);
        }
    }
}
