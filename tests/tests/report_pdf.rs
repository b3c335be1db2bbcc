//! Reports as PDF, read back with another library: every address of the ladder stands in the text, nothing
//! lies outside the page or on something else, links and bookmarks lead where they say.

use std::collections::{BTreeSet, HashSet};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use ladder::{Element, Project, Series};
use report::pdf::{Format, Paper, Pdf};
use report::{Document, Options, Source};
use rungs_tests::book::{Book, Page, Text};
use rungs_tests::corpus;

fn opened(path: &Path) -> Result<Project, convert::OpenError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    convert::open(&bytes, &name, rss::Mode::Permissive)
}

fn open(path: &Path) -> Project {
    opened(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn examples() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples");
    corpus::files(&folder, ".rss").expect("the examples")
}

/// Makes [`large()`] give every project of the corpus: minutes.
const ALL: &str = "RUNGS_REPORTS";

/// The two programs with the most rungs and the most shapes.
fn large() -> Vec<PathBuf> {
    let Some(root) = corpus::root() else { return Vec::new() };
    if std::env::var_os(ALL).is_some() {
        return corpus::files(&root, ".rss").expect("the corpus");
    }
    ["acd/LANLOGIX_BR.RSS", "PLC_reject_timing/TVZ_1100_REV02_LatchmoorAnnotations.RSS"]
        .map(|name| root.join(name))
        .into()
}

/// Every address in a series, as rungs show it.
fn addresses(series: &Series, out: &mut BTreeSet<String>) {
    for element in series {
        match element {
            Element::Instruction(it) => {
                out.extend(it.operands.iter().filter_map(|operand| Some(operand.address()?.to_string())));
            }
            Element::Branch(branch) => branch.legs.iter().for_each(|leg| addresses(leg, out)),
        }
    }
}

/// What a search finds: texts as they are painted, and their words.
fn findable(book: &Book) -> HashSet<&str> {
    let texts = || book.pages.iter().flat_map(|page| &page.texts).map(|text| text.text.trim());
    texts().chain(texts().flat_map(str::split_whitespace)).map(|text| text.trim_end_matches('<')).collect()
}

/// Texts whose letters cover letters of another one, or that leave the page.
fn misplaced(page: &Page) -> Vec<String> {
    let mut wrong = Vec::new();
    for text in &page.texts {
        if text.left < 20.0 || text.right > page.width - 20.0 || text.line < 20.0 || text.line > page.height - 20.0 {
            wrong.push(format!("{text:?} lies outside"));
        }
    }
    let mut lines: Vec<&Text> = page.texts.iter().filter(|text| !text.text.trim().is_empty()).collect();
    lines.sort_by(|a, b| a.line.total_cmp(&b.line).then(a.left.total_cmp(&b.left)));
    for (index, a) in lines.iter().enumerate() {
        let near = lines[index + 1..].iter().take_while(|b| b.line - a.line < a.size * 0.6);
        for b in near.filter(|b| a.left + 0.3 < b.right && b.left + 0.3 < a.right) {
            wrong.push(format!("{a:?} and {b:?} lie on each other"));
        }
    }
    wrong
}

fn check(project: &Project, document: &Document<'_>, pdf: &Pdf) -> Book {
    let name = &document.title;
    let book = Book::read(&pdf.bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(book.pages.len(), pdf.pages, "{name}");
    assert_eq!(&book.title, name);
    for (index, page) in book.pages.iter().enumerate() {
        let number = format!("Page {} of {}", index + 1, pdf.pages);
        assert!(page.texts.iter().any(|text| text.text == number), "{name}: {number}");
        assert_eq!(misplaced(page), [""; 0], "{name}, {number}");
    }
    let mut wanted = BTreeSet::new();
    for rung in project.main.ladder_files().flat_map(|file| &file.rungs) {
        addresses(&rung.series, &mut wanted);
    }
    let found = findable(&book);
    let missing: Vec<_> = wanted.iter().filter(|address| !found.contains(address.as_str())).collect();
    assert!(missing.is_empty(), "{name}: {missing:?} of {} addresses are not in the text", wanted.len());
    for file in project.main.ladder_files() {
        let head = format!("LAD {} -", file.number);
        let mark = book.bookmarks.iter().find(|mark| mark.level <= 1 && format!("{} -", mark.title).starts_with(&head));
        let mark = mark.unwrap_or_else(|| panic!("{name}: no bookmark for {head} in {:?}", book.bookmarks));
        let page = &book.pages[mark.page];
        assert!(page.texts.iter().any(|text| text.text.starts_with(&head)), "{name}: {mark:?}");
    }
    book
}

#[test]
fn every_address_stands_in_the_text_of_the_examples() {
    let mut count = 0;
    for path in examples() {
        let project = open(&path);
        let document = report::project(&Source::of(&project), &Options::default());
        for paper in [Paper::A4, Paper::Letter] {
            for landscape in [false, true] {
                let pdf = report::pdf::write(&document, Format { paper, landscape, ..Format::default() });
                check(&project, &document, &pdf);
                validate(&document.title, &pdf.bytes);
                count += 1;
            }
        }
    }
    assert!(count >= 4, "no example found");
}

#[test]
fn every_address_stands_in_the_text_of_large_programs() {
    for path in large() {
        // Some files of the corpus are no projects, which other tests count.
        let Ok(project) = opened(&path) else { continue };
        let document = report::project(&Source::of(&project), &Options::default());
        let pdf = report::pdf::write(&document, Format::default());
        let book = check(&project, &document, &pdf);
        let links: usize = book.pages.iter().map(|page| page.links.len()).sum();
        println!("{}: {} pages, {} bytes, {links} links", document.title, pdf.pages, pdf.bytes.len());
        validate(&document.title, &pdf.bytes);
    }
}

#[test]
fn an_address_in_a_rung_leads_to_its_cross_reference() {
    let project = open(&examples()[0]);
    let document = report::project(&Source::of(&project), &Options::default());
    let book = Book::read(&report::pdf::write(&document, Format::default()).bytes).expect("a book");
    let chapter = |title: &str| {
        let at = book.bookmarks.iter().position(|mark| mark.title == title).unwrap_or_else(|| panic!("{title}"));
        let next = book.bookmarks[at + 1..].iter().find(|mark| mark.level == 0);
        (book.bookmarks[at].page, next.map_or(book.pages.len(), |next| next.page))
    };
    let (ladder, after) = (chapter("Ladder"), chapter("Cross Reference"));
    let links = book.pages[ladder.0..ladder.1].iter().flat_map(|page| {
        page.links.iter().filter_map(|link| {
            let [left, bottom, right, top] = link.area;
            let inside = |t: &&Text| t.left < right && t.right > left && t.line > bottom && t.line < top;
            Some((page.texts.iter().find(inside)?.text.trim_end_matches('<').to_owned(), link))
        })
    });
    // Symbols lead to the same places; an address is what can be compared.
    let links =
        links.filter(|(text, link)| (after.0..=after.1).contains(&link.page) && ladder::Address::parse(text).is_ok());
    let links: Vec<_> = links.collect();
    assert!(links.len() > 10);
    for (address, link) in links {
        let target = &book.pages[link.page];
        let there = |t: &&Text| t.text == address && t.line < link.top && t.line > link.top - 30.0;
        assert!(target.texts.iter().any(|text| there(&text)), "{address} leads to page {} at {}", link.page, link.top);
    }
}

#[test]
fn the_same_project_gives_the_same_bytes() {
    let project = open(&examples()[0]);
    let write = || {
        let document = report::project(&Source::of(&project), &Options::default());
        report::pdf::write(&document, Format::default()).bytes
    };
    assert!(write() == write());
}

/// A project whose names and comments try everything.
fn hostile() -> (Project, Vec<String>) {
    let texts: Vec<String> = [
        "(open",
        "close)",
        "back\\slash\\",
        "endstream",
        "endobj",
        ") Tj ET",
        "<script>x</script>",
        "../../etc/passwd",
        "\u{1B}[2J",
        "nul\0byte",
        "<</Type/Page>>",
        "%%EOF",
        "quo\"te'",
        "20 °C",
        "wörd",
        "温度",
        "a\u{202E}b",
    ]
    .map(str::to_owned)
    .into();
    let long: String = (0..500).map(|n| format!("{n:05} ")).collect();
    let mut project = open(&examples()[0]);
    let owner = |rung| ladder::CommentOwner::Rung { file: 2, rung };
    let file = project.main.program_files.iter_mut().find(|file| file.number == 2).expect("file 2");
    let rung = file.rungs.first().cloned().expect("a rung");
    file.rungs = texts.iter().chain([&long]).map(|_| rung.clone()).collect();
    for ((rung, text), index) in file.rungs.iter_mut().zip(texts.iter().chain([&long])).zip(0_u32..) {
        let title = if index % 2 == 0 { text.chars().take(20).collect() } else { String::new() };
        rung.comment = Some(ladder::Comment { text: text.clone(), title, owner: owner(index) });
    }
    file.name = "(\\) endstream".to_owned();
    for (text, bit) in texts.iter().zip(0_u8..) {
        let address = ladder::Address::parse(&format!("B3:1/{}", bit % 16)).expect("an address");
        project.main.documentation.add(ladder::AddressEntry {
            target: ladder::Target::Address(address),
            symbol: text.chars().take(20).collect(),
            description: vec![text.clone(), long.clone()],
        });
    }
    project.source.file = "a(b\\c<d>\u{1B}.RSS".to_owned();
    (project, texts.into_iter().chain([long]).collect())
}

#[test]
fn hostile_texts_break_nothing_and_are_shown() {
    let (project, texts) = hostile();
    let document = report::project(&Source::of(&project), &Options::default());
    let pdf = report::pdf::write(&document, Format::default());
    let book = Book::read(&pdf.bytes).expect("a book");
    validate("hostile", &pdf.bytes);
    for page in &book.pages {
        assert_eq!(misplaced(page), [""; 0]);
    }
    let all: String =
        book.pages.iter().flat_map(|page| &page.texts).flat_map(|text| [text.text.as_str(), "\n"]).collect();
    for text in texts.iter().filter(|text| text.len() < 100) {
        let wanted = render::pdf::printable(text).0;
        assert!(all.contains(&*wanted), "{wanted}");
    }
    for n in 0..500 {
        assert!(all.contains(&format!("{n:05}")), "word {n} of the long comment");
    }
    assert!(pdf.escaped > 0);
    assert!(all.contains("spelled out"), "the reader is told");
    assert_eq!(book.title, "a(b\\c<d>\\x1B.RSS");
}

/// Asks qpdf, where there is one.
fn validate(name: &str, bytes: &[u8]) {
    let file = std::env::temp_dir().join(format!("rungs-{}-{name}.pdf", std::process::id()));
    let file = PathBuf::from(file.to_string_lossy().replace(['(', '\\', '<', '>', '\u{1B}'], "_"));
    let started = Command::new("qpdf").arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    if started.is_err() {
        println!("skipped: no qpdf to validate {name}");
        return;
    }
    std::fs::File::create(&file).and_then(|mut to| to.write_all(bytes)).expect("a temporary file");
    let output = Command::new("qpdf").arg("--check").arg(&file).output().expect("qpdf");
    let _ = std::fs::remove_file(&file);
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && !said.contains("WARNING"), "{name}: {said}");
}
