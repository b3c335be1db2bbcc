//! The drawn ladder of the printouts: every rung must be understood in full.

use rungs_tests::{corpus, drawing, printout};
use std::collections::BTreeMap;

#[test]
fn every_drawn_rung_is_understood() {
    let Some(root) = corpus::root() else { return };
    let (mut wrong, mut rungs, mut instructions) = (Vec::new(), 0, 0);
    for path in corpus::files(&root, ".pdf").expect("corpus can be listed") {
        let name = corpus::name(&root, &path);
        let bytes = std::fs::read(&path).expect("a report can be read");
        let files = match drawing::read(&bytes) {
            Ok(files) => files,
            Err(error) => {
                wrong.push(format!("{name}: {error}"));
                continue;
            }
        };
        for file in files {
            for rung in &file.rungs {
                rungs += 1;
                instructions += rung.instructions().len();
                for fault in &rung.faults {
                    wrong.push(format!("{name} LAD {} rung {:?}: {fault}", file.number, rung.number));
                }
            }
        }
    }
    println!("{rungs} rungs, {instructions} instructions");
    assert!(wrong.is_empty(), "{} faults:\n{}", wrong.len(), wrong[..wrong.len().min(50)].join("\n"));
}

/// How often each character stands in the texts, spaces left out.
fn letters<'a>(texts: impl Iterator<Item = &'a str>) -> BTreeMap<char, i32> {
    let mut found = BTreeMap::new();
    for c in texts.flat_map(str::chars).filter(|c| !c.is_whitespace()) {
        *found.entry(c).or_default() += 1;
    }
    found
}

/// The texts of a page; mnemonics of boxes are drawn twice over each other and count once, as in the text.
fn once(page: &drawing::Page) -> Vec<&str> {
    let mut seen: Vec<&drawing::Text> = Vec::new();
    for text in &page.texts {
        let over = |t: &&drawing::Text| (t.x0 - text.x0).abs() < 3.0 && (t.y - text.y).abs() < 3.0;
        if !seen.iter().any(|t| over(t) && t.text == text.text) {
            seen.push(text);
        }
    }
    seen.iter().map(|t| t.text.as_str()).collect()
}

#[test]
fn the_drawing_holds_the_same_letters_as_the_text_of_the_report() {
    let Some(root) = corpus::root() else { return };
    let (mut wrong, mut pages) = (Vec::new(), 0);
    for path in corpus::files(&root, ".pdf").expect("corpus can be listed") {
        let name = corpus::name(&root, &path);
        let text = path.with_extension("pdf.txt");
        let text = std::fs::read_to_string(&text).expect("a text lies beside each report");
        let drawn = drawing::pages(&std::fs::read(&path).expect("a report can be read")).expect("a PDF");
        for (number, (drawn, text)) in drawn.iter().zip(text.split('\u{c}')).enumerate() {
            if !drawn.texts.iter().any(|t| t.text.starts_with("LAD ")) {
                continue;
            }
            pages += 1;
            let mut difference = letters(std::iter::once(text));
            for (c, count) in letters(once(drawn).into_iter()) {
                *difference.entry(c).or_default() -= count;
            }
            difference.retain(|_, count| *count != 0);
            if !difference.is_empty() {
                wrong.push(format!("{name} page {number}: {difference:?}"));
            }
        }
    }
    println!("{pages} ladder pages");
    assert!(wrong.is_empty(), "{} pages:\n{}", wrong.len(), wrong[..wrong.len().min(20)].join("\n"));
}

#[test]
fn drawn_rungs_and_printed_rungs_are_the_same() {
    let Some(root) = corpus::root() else { return };
    let mut wrong = Vec::new();
    for path in corpus::files(&root, ".pdf").expect("corpus can be listed") {
        let name = corpus::name(&root, &path);
        let text = std::fs::read_to_string(path.with_extension("pdf.txt")).expect("a text lies beside each report");
        let printed: Vec<_> = printout::parse(&text)
            .ladder
            .iter()
            .map(|f| (f.number, f.rungs.iter().map(|r| (Some(r.number), r.edited)).collect::<Vec<_>>()))
            .collect();
        let drawn: Vec<_> = drawing::read(&std::fs::read(&path).expect("a report can be read"))
            .expect("a PDF")
            .iter()
            .map(|f| (f.number, f.rungs.iter().map(|r| (r.number, r.edited)).collect::<Vec<_>>()))
            .collect();
        if printed != drawn {
            wrong.push(format!("{name}:\n {printed:?}\n {drawn:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
