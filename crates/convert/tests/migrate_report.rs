//! Reports of a migration of a project whose texts try to be more than texts.

mod migrate_support;

use convert::migrate::{MapRow, Options, map_file, migrate, report::Report};
use ladder::{
    Address, AddressEntry, Comment, CommentOwner, Element, Family, Instruction, Mnemonic, Operand, Source, Target,
};
use migrate_support::image;

/// Markup, ends of attributes and elements, what terminals obey, the end of a Designer comment, letters that turn
/// the direction of writing.
const HOSTILE: [&str; 9] = [
    "<script>alert(1)</script>",
    "\"><img src=x onerror=alert(1)>",
    "' onmouseover='alert(1)",
    "</pre></section><h1>forged",
    "&lt;b&gt; &#60;script&#62;",
    "\u{1b}[2J\u{1b}]0;title\u{7}\u{9b}31m",
    "\"\r\n#END\r\nSTR ST1\r\nOUT Y0\r\n$PGMEND $Main",
    "\u{202e}desrever\u{2066}\u{0}\u{8}",
    "=cmd|' /C calc'!A0",
];

/// Elements and attributes the page is made of.
const ELEMENTS: &str = "html head meta title style body h1 h2 h3 p table tr th td ul li code nav a section div pre";
const ATTRIBUTES: [&str; 7] = ["class", "id", "href", "charset", "lang", "http-equiv", "content"];

#[test]
fn hostile_texts_stay_texts() {
    let long = "x<y>\"&".repeat(500);
    let texts: Vec<&str> = HOSTILE.into_iter().chain([long.as_str()]).collect();
    for text in &texts {
        let mut image = image(
            Family::Slc503,
            &[
                (2, "XIC B3:0/0 OTE B3:0/1\nXIC B3:0/2 ARD 0 N7:0 R6:0 1 0 0\nMOV 1 N7:0\nJSR 3\nXIC B3:0/1 JSR 3"),
                (3, "OTE B3:0/4"),
            ],
        );
        let rungs = &mut image.program_files.iter_mut().find(|file| file.number == 2).expect("file 2").rungs;
        rungs[0].comment = Some(Comment {
            title: (*text).to_owned(),
            text: format!("{text}\r\n{text}"),
            owner: CommentOwner::Rung { file: 2, rung: 0 },
        });
        // A symbol in a rung that was never verified.
        let unknown = Instruction::new(Mnemonic::named("XIC"), vec![Operand::Symbol((*text).to_owned())]);
        rungs[1].series.insert(0, Element::Instruction(unknown));
        for file in &mut image.program_files {
            (file.name, file.description) = ((*text).to_owned(), (*text).to_owned());
        }
        for file in &mut image.data_files {
            (file.name, file.description) = ((*text).to_owned(), (*text).to_owned());
        }
        let target = Target::Address(Address::parse("B3:0/0").expect("an address"));
        image.documentation.add(AddressEntry {
            target,
            symbol: (*text).to_owned(),
            description: vec![(*text).to_owned()],
        });
        let source = Source { file: (*text).to_owned(), ..Source::default() };
        let migration = migrate(&image, &[], &Options::default()).expect("it migrates");
        let mut report = Report::new(&source, &image, &migration, &Options::default());
        report.proof = Some(vec![((*text).to_owned(), (*text).to_owned())]);

        // Every tag of the page is one of its own, whatever the texts say.
        let page = report.html();
        for part in page.split('<').skip(1) {
            let tag = part.split('>').next().expect("a tag");
            if tag == "!DOCTYPE html" {
                continue;
            }
            let mut words = tag.trim_start_matches('/').splitn(2, ' ');
            let name = words.next().expect("a name");
            assert!(ELEMENTS.split(' ').any(|known| known == name), "{text}: <{tag}>");
            let attributes = words.next().unwrap_or("").split('"').step_by(2).filter(|name| !name.trim().is_empty());
            for name in attributes {
                let name = name.trim().trim_end_matches('=');
                assert!(ATTRIBUTES.contains(&name), "{text}: <{tag}>");
            }
        }
        assert!(!page.contains("<script") && page.matches("</pre></section>").count() == 0, "{text}");
        let bad =
            |c: char| c.is_control() && c != '\n' || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        assert_eq!(page.chars().find(|c| bad(*c)), None, "{text}");
        assert!(page.contains("default-src 'none'"), "a page that would load nothing");
        assert!(page.len() < 200_000, "{}", page.len());

        // JSON gives the texts back as they were and holds no control character.
        let json = report.json();
        assert_eq!(json.chars().find(|c| c.is_control() && *c != '\n'), None, "{text}");
        let value: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        assert_eq!(value["file"], **text);
        assert_eq!(value["proof"][0][1], **text);
        assert!(value["rungs"][1]["original"].as_str().is_some_and(|original| original.contains("ARD")), "{text}");

        // The text for Designer holds as many rungs as before and reads back without a diagnostic.
        let written = domore::text::write(&migration.project);
        let reading = domore::text::read(&written).expect("the text is read back");
        assert!(reading.diagnostics.is_empty(), "{text}: {:?}", reading.diagnostics);
        let count =
            |project: &domore::Project| project.code_blocks().map(|block| block.rungs.len()).collect::<Vec<_>>();
        assert_eq!(count(&reading.project), count(&migration.project), "{text}");
        assert_eq!(written.chars().find(|c| c.is_control() && !matches!(c, '\r' | '\n' | '\t')), None, "{text}");

        // The map comes back as it was written.
        let rows = map_file::read(&map_file::write(&migration.map)).expect("a map");
        let trimmed = |rows: &[MapRow]| -> Vec<_> {
            rows.iter().map(|row| (row.slc.clone(), row.domore.clone(), row.name.trim().to_owned())).collect()
        };
        assert_eq!(trimmed(&rows), trimmed(&migration.map), "{text}");
        migrate(&image, &rows, &Options::default()).unwrap_or_else(|error| panic!("{text}: {error}"));
    }
}

#[test]
fn timers_not_executed_in_every_scan_are_named() {
    let rung = "XIC B3:0/0 TON T4:0 0.01 500 0";
    let told = |files: &[(u16, &str)]| {
        let migration = migrate(&image(Family::Slc503, files), &[], &Options::default()).expect("migrates");
        let notes = migration.notes.iter().map(ToString::to_string);
        notes.filter(|note| note.starts_with("TIMER-BASE: T4:0 ") && note.contains("11.5 days")).count()
    };
    assert_eq!(told(&[(2, rung)]), 0);
    assert_eq!(told(&[(2, "XIC B3:0/1 JSR 3"), (3, rung)]), 1);
}
