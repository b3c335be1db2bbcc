//! The page of a difference: what is on it, that both sides are whole, and that no text breaks out.

use analysis::diff::{self, Difference};
use ladder::{AddressEntry, Comment, CommentOwner, Image, ProgramFile, ProgramFileKind, Rung, Target};
use report::diff::{Comparison, Entry, Row, Shown, Side, chapters, index, page};

const HOSTILE: &str = "<script>alert(1)</script>\"'><img src=x onerror=alert(1)> & \u{1B}[2J \u{202E}";

fn rungs(text: &str) -> Vec<Rung> {
    convert::slc::rung::parse_rungs(text, None).expect("rungs")
}

fn image(files: &[(u16, &str)]) -> Image {
    let mut image = Image::default();
    for (number, text) in files {
        image.program_files.push(ProgramFile {
            number: *number,
            name: format!("FILE{number}"),
            description: String::new(),
            kind: ProgramFileKind::Ladder,
            rungs: rungs(text),
        });
    }
    image
}

fn compare(old: &Image, new: &Image) -> Difference {
    let side = |image| diff::Side { image, documentation: Some(&image.documentation) };
    diff::compare(side(old), side(new))
}

fn written(old: &Side<'_>, new: &Side<'_>, difference: &Difference, names: (&str, &str)) -> String {
    let comparison =
        Comparison { names, sides: (old, new), difference, shown: Shown::default(), tool: "rungs test", warnings: &[] };
    let mut out = Vec::new();
    page(&comparison, &mut out).expect("a vector takes all");
    String::from_utf8(out).expect("text")
}

fn of(old: &Image, new: &Image) -> String {
    let sides = (Side::rslogix(old, &old.documentation), Side::rslogix(new, &new.documentation));
    written(&sides.0, &sides.1, &compare(old, new), ("old.RSS", "new.RSS"))
}

const OLD: &str = "SOR XIC B3:0/0 OTE B3:0/1 EOR SOR XIC B3:0/2 TON T4:0 0.01 500 0 EOR SOR XIC B3:0/3 OTE B3:0/4 EOR \
                   SOR XIC B3:0/5 OTE B3:0/6 EOR SOR XIC I:0/1 XIC I:0/2 OTE O:0/1 EOR SOR XIC I:0/3 XIC I:0/4 OTE O:0/2 EOR";
const NEW: &str = "SOR XIC I:0/1 XIC I:0/2 OTE O:0/1 EOR SOR XIC B3:0/0 OTE B3:0/1 EOR SOR XIC B3:0/2 TON T4:0 0.01 900 0 EOR \
                   SOR XIC B3:0/5 OTE B3:0/6 EOR SOR XIC N7:0/1 XIO N7:0/2 OTE N7:0/3 EOR SOR XIC I:0/3 XIC I:0/4 OTE O:0/2 EOR";

#[test]
fn rows_are_in_the_order_of_both_programs() {
    let (old, new) = (image(&[(2, OLD), (3, OLD)]), image(&[(2, NEW), (3, OLD)]));
    let difference = compare(&old, &new);
    let sides = (Side::rslogix(&old, &old.documentation), Side::rslogix(&new, &new.documentation));
    let all = chapters((&sides.0, &sides.1), &difference);
    let words = |row: &Row<'_>| match row {
        Row::Same { old, new, count } => format!("{count} same {}-{}", old.rung, new.rung),
        Row::Change(change) => change.kind.as_str().to_owned(),
        Row::Left(_) => "left".to_owned(),
    };
    let rows: Vec<Vec<String>> = all.iter().map(|chapter| chapter.rows.iter().map(words).collect()).collect();
    assert_eq!(rows[0], ["moved", "1 same 0-1", "changed", "deleted", "1 same 3-3", "left", "inserted", "1 same 5-5"]);
    assert_eq!(rows[1], ["6 same 0-0"]);
}

#[test]
fn every_change_is_told_once_and_leads_somewhere() {
    let shown = of(&image(&[(2, OLD)]), &image(&[(2, NEW)]));
    for (id, kind) in [("c-2-0", "moved"), ("c-2-2", "changed"), ("o-2-2", "deleted"), ("c-2-4", "inserted")] {
        assert_eq!(shown.matches(&format!("<article class=\"change {kind}\" id=\"{id}\">")).count(), 1, "{id}");
    }
    assert!(shown.contains("TON Preset: 500 -&gt; 900"), "{shown}");
    for (at, _) in shown.match_indices("href=\"#") {
        let rest = &shown[at + 7..];
        let id = &rest[..rest.find('"').expect("a quote")];
        let quoted = format!("id=\"{id}\"");
        assert!(id == "content" || shown.contains(&quoted) || shown.contains(&format!("id={id}>")), "{id}");
    }
}

#[test]
fn equal_programs_say_so() {
    let one = image(&[(2, OLD)]);
    let shown = of(&one, &one);
    assert_eq!(shown.matches("<td>equal").count(), 4);
    assert!(!shown.contains("class=\"change") && shown.contains("1 file without a change <span>6 rungs"));
}

/// Names, comments, symbols and values with marks, quotes and control characters are texts everywhere.
#[test]
fn nothing_breaks_out() {
    let mut old = image(&[(2, OLD)]);
    let mut new = image(&[(2, NEW)]);
    for (image, extra) in [(&mut old, "one"), (&mut new, "two")] {
        let file = image.program_files.first_mut().expect("a file");
        file.name = HOSTILE.to_owned();
        for (number, rung) in (0..).zip(&mut file.rungs) {
            let owner = CommentOwner::Rung { file: 2, rung: number };
            rung.comment = Some(Comment { text: format!("{HOSTILE} {extra}"), title: HOSTILE.to_owned(), owner });
        }
        image.processor.project_name = format!("{HOSTILE}{extra}");
        let target = Target::from(&ladder::Address::parse("B3:0/0").expect("an address"));
        image.documentation.add(AddressEntry {
            target,
            symbol: format!("{HOSTILE}{extra}"),
            description: vec![HOSTILE.to_owned(), extra.to_owned()],
        });
    }
    let sides = (Side::rslogix(&old, &old.documentation), Side::rslogix(&new, &new.documentation));
    let mut difference = compare(&old, &new);
    difference.notes.push(HOSTILE.to_owned());
    let shown = written(&sides.0, &sides.1, &difference, (HOSTILE, HOSTILE));
    let (_, body) = shown.split_once("</style>").expect("a style");
    let body = body.rsplit_once("<script>").expect("our script").0;
    for mark in ["<script", "<img", "\u{1B}", "\u{202E}", "onerror=alert(1)>"] {
        assert!(!body.contains(mark), "{mark:?}");
    }
    assert!(body.contains("&lt;script&gt;alert(1)&lt;/script&gt;"));
    // Words that differ are marked one by one, inside of texts that are all marks.
    assert!(body.contains("<del>one</del>") && body.contains("<ins>two</ins>"), "{body}");
    let entry =
        Entry { href: HOSTILE.into(), old: HOSTILE.into(), new: HOSTILE.into(), remark: HOSTILE.into(), counts: None };
    let mut list = Vec::new();
    index((HOSTILE, HOSTILE), "rungs", &[entry], &mut list).expect("a vector takes all");
    let list = String::from_utf8(list).expect("text");
    assert!(
        list.matches("<script").count() == 1 && !list.contains("<img") && list.contains("href=\"./%3Cscript"),
        "{list}"
    );
}

#[test]
fn sections_that_were_not_asked_for_are_no_equal_ones() {
    let (old, new) = (image(&[(2, OLD)]), image(&[(2, NEW)]));
    let sides = (Side::rslogix(&old, &old.documentation), Side::rslogix(&new, &new.documentation));
    let mut difference = compare(&old, &new);
    difference.documentation.clear();
    let comparison = Comparison {
        names: ("a", "b"),
        sides: (&sides.0, &sides.1),
        difference: &difference,
        shown: Shown { documentation: false, ..Shown::default() },
        tool: "",
        warnings: &["a.RSS: 2 parts could not be read".to_owned()],
    };
    let mut out = Vec::new();
    page(&comparison, &mut out).expect("a vector takes all");
    let shown = String::from_utf8(out).expect("text");
    assert!(shown.contains("<tr><td>Documentation<td><td><td><td><td>not asked for"));
    assert!(!shown.contains("id=documentation") && shown.contains("Not complete:</strong> a.RSS"));
}

#[test]
fn code_blocks_have_names_and_rungs_count_from_one() {
    let text = "PLC DM-SIM\n\n$PRGRM Fill\n\nSTR X0\nOUT Y0\n\nSTR X1\nTMR T0 500\n\n$PGMEND Fill\n";
    let read = |text: &str| domore::text::read(text).expect("a program").project;
    let (old, new) = (read(text), read(&text.replace("STR X1", "STR X2\nAND X1").replace("500", "700")));
    let difference = diff::compare_domore(&old, &new);
    let shown = written(&Side::domore(&old), &Side::domore(&new), &difference, ("a.txt", "b.txt"));
    assert!(shown.contains("Fill:2 changed") && shown.contains("TMR Preset: 500 -&gt; 700"), "{shown}");
    assert!(shown.contains("inserted AND X1") || shown.contains("inserted STR X2"), "{shown}");
    assert!(shown.contains("not compared: the files hold none"));
    let gone = diff::compare_domore(&old, &read("PLC DM-SIM\n"));
    let shown = written(&Side::domore(&old), &Side::domore(&read("PLC DM-SIM\n")), &gone, ("a.txt", "b.txt"));
    assert!(shown.contains("Program Fill <span>gone, 2 rungs"), "{shown}");
}

/// As many code blocks as a comparison takes: the page must not look at each beside each.
#[test]
fn many_code_blocks_end_quickly() {
    let mut text = String::from("PLC DM-SIM\n");
    for number in 0..20_000 {
        text.push_str(&format!("\n$LGCMOD B{}\n\nSTR C{}\nOUT Y0\n\n$LGCEND B{0}\n", number / 2, number % 1000));
    }
    let project = domore::text::read(&text).expect("a program").project;
    let start = std::time::Instant::now();
    let difference = diff::compare_domore(&project, &project);
    assert!(difference.is_empty(), "{:?}", difference.logic.first());
    let shown = written(&Side::domore(&project), &Side::domore(&project), &difference, ("a.txt", "b.txt"));
    assert!(shown.contains("20000 files without a change"));
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
}
