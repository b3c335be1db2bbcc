//! `rungs report` as a user runs it: one page, a folder of pages, sections, what is refused.

mod support;

use std::path::{Path, PathBuf};
use support::among_examples::{examples, rungs};

fn code(arguments: &[&str]) -> Option<i32> {
    rungs(arguments).status.code()
}

/// An empty folder of its own for each test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("report_{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn shown(path: &Path) -> &str {
    path.to_str().expect("a path of text")
}

#[test]
fn one_page_the_same_every_time() {
    let folder = folder("page");
    let (a, b) = (folder.join("a.html"), folder.join("b.html"));
    assert_eq!(code(&["report", "motor/motor.RSS", "--out", shown(&a)]), Some(0));
    assert_eq!(code(&["report", "motor/motor.RSS", "--out", shown(&b), "--sections", "", "--without", ""]), Some(0));
    let page = read(&a);
    assert_eq!(page, read(&b));
    assert!(page.starts_with("<!DOCTYPE html>"));
    for title in
        ["Processor Information", "Address/Symbol Database", "Cross Reference", "Timers and Counters", "I/O Map"]
    {
        assert!(page.contains(&format!("<h2>{title}</h2>")), "{title}");
    }
    // Nothing is fetched, nothing but its own style and script may run.
    for outside in ["http:", "https:", "src=", "@import", "url("] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(page.contains("default-src 'none'"));
    assert!(!page.contains("unsafe"));
}

#[test]
fn sections_are_chosen_and_a_date_is_given() {
    let folder = folder("sections");
    let out = folder.join("r.html");
    let arguments =
        ["report", "motor/motor.RSS", "--out", shown(&out), "--sections", "io,timers", "--date", "2024-05-06"];
    assert_eq!(code(&arguments), Some(0));
    let page = read(&out);
    assert_eq!(page.matches("<section ").count(), 2);
    assert!(page.contains("2024-05-06"));
    let other = folder.join("other.html");
    let refused = rungs(&["report", "motor/motor.RSS", "--out", shown(&other), "--sections", "cross"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("xref"));
    assert!(!other.exists());
    let help = String::from_utf8_lossy(&rungs(&["report", "--help"]).stdout).into_owned();
    for kind in ["processor", "symbol-groups", "read-never-written", "online"] {
        assert!(help.contains(kind), "{kind}");
    }
}

#[test]
fn nothing_is_overwritten_unasked() {
    let folder = folder("force");
    let out = folder.join("r.html");
    std::fs::write(&out, "mine").expect("a file");
    assert_eq!(code(&["report", "motor/motor.RSS", "--out", shown(&out)]), Some(2));
    assert_eq!(read(&out), "mine");
    assert_eq!(code(&["report", "motor/motor.RSS", "--out", shown(&out), "--force"]), Some(0));
    assert_ne!(read(&out), "mine");
    assert_eq!(code(&["report", "motor/motor.RSS", "--out", shown(&folder.join("r.doc"))]), Some(2));
    // Not even --force replaces the project itself.
    let project = folder.join("p.RSS");
    std::fs::copy(examples().join("motor/motor.RSS"), &project).expect("a copy");
    let before = std::fs::read(&project).expect("the project");
    for command in [["report", "--to", "html", "--out"], ["export", "--to", "json", "-o"]] {
        let mut arguments = command.to_vec();
        arguments.extend([shown(&project), shown(&project), "--force"]);
        assert_eq!(code(&arguments), Some(2), "{arguments:?}");
    }
    assert_eq!(std::fs::read(&project).expect("the project"), before);
    assert_eq!(code(&["report", "missing.RSS", "--out", shown(&folder.join("m.html"))]), Some(3));
}

#[test]
fn several_projects_get_a_list() {
    let folder = folder("list");
    let source = folder.join("in");
    for (name, of) in
        [("a/line.RSS", "motor/motor.RSS"), ("b/line.RSS", "batch/batch.RSS"), ("a/index.RSS", "motor/motor.RSS")]
    {
        let to = source.join(name);
        std::fs::create_dir_all(to.parent().expect("a folder")).expect("a folder");
        std::fs::copy(examples().join(of), to).expect("a copy");
    }
    std::fs::write(source.join("broken.RSS"), "no project").expect("a file");
    let out = folder.join("out");
    // The broken one is told, and the rest goes on.
    assert_eq!(code(&["report", shown(&source), "--out", shown(&out)]), Some(3));
    let list = read(&out.join("index.html"));
    for name in ["line.html", "line-2.html", "index-2.html"] {
        assert!(list.contains(&format!("href=\"./{name}\"")), "{name}: {list}");
        assert!(read(&out.join(name)).contains("<h2>Cross Reference</h2>"));
    }
    assert!(list.contains("broken.RSS") && list.contains("could not be read"));
}

#[test]
fn a_do_more_project_has_a_report_too() {
    let folder = folder("domore");
    let out = folder.join("new/r.html");
    assert_eq!(code(&["report", "filling_domore/filling.txt", "--out", shown(&out)]), Some(0));
    let page = read(&out);
    for title in ["Controller", "Code Blocks", "Memory", "Element Documentation", "Cross Reference"] {
        assert!(page.contains(&format!("<h2>{title}</h2>")), "{title}");
    }
    assert!(page.matches("<svg class=\"rung\"").count() > 2);
    assert!(page.matches("href=\"#x-").count() > 5, "addresses in rungs lead to the cross reference");
}

#[test]
fn a_book_on_the_paper_that_was_asked_for() {
    let folder = folder("book");
    let out = folder.join("r.pdf");
    assert_eq!(code(&["report", "motor/motor.RSS", "--out", shown(&out)]), Some(0));
    let book = std::fs::read(&out).expect("a file");
    assert!(book.starts_with(b"%PDF-1.7") && book.ends_with(b"%%EOF"));
    let has = |book: &[u8], part: &str| book.windows(part.len()).any(|window| window == part.as_bytes());
    assert!(has(&book, "595.28 841.89"), "A4");
    let letter = folder.join("letter.pdf");
    let arguments = ["report", "motor/motor.RSS", "--out", shown(&letter), "--paper", "letter", "--landscape"];
    assert_eq!(code(&arguments), Some(0));
    assert!(has(&std::fs::read(&letter).expect("a file"), "792 612"));
    // Nothing is ignored silently.
    let page = folder.join("r.html");
    assert_eq!(code(&["report", "motor/motor.RSS", "--out", shown(&page), "--landscape"]), Some(2));
    assert_eq!(code(&["report", "motor/motor.RSS", "--out", shown(&page), "--to", "pdf"]), Some(2));
    assert!(!page.exists());
    let books = folder.join("books");
    assert_eq!(code(&["report", "motor/motor.RSS", "batch/batch.RSS", "--out", shown(&books), "--to", "pdf"]), Some(0));
    assert!(read(&books.join("index.html")).contains("href=\"./motor.pdf\""));
    assert!(books.join("batch.pdf").exists());
}

#[test]
fn the_ladder_alone_is_exported_as_a_book() {
    let folder = folder("export");
    let whole = folder.join("ladder.pdf");
    assert_eq!(code(&["export", "motor/motor.RSS", "--to", "pdf", "--out", shown(&whole)]), Some(0));
    let one = folder.join("one.pdf");
    let arguments = ["export", "motor/motor.RSS", "--to", "pdf", "--out", shown(&one), "--file", "2", "--rung", "0"];
    assert_eq!(code(&arguments), Some(0));
    let size = |path: &Path| std::fs::metadata(path).map(|data| data.len()).expect("a file");
    assert!(size(&one) < size(&whole));
    let domore = folder.join("domore.pdf");
    assert_eq!(code(&["export", "filling_domore/filling.txt", "--to", "pdf", "--out", shown(&domore)]), Some(0));
    assert!(std::fs::read(&domore).expect("a file").starts_with(b"%PDF-1.7"));
}
