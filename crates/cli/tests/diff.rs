//! `rungs diff` as a user runs it: what it prints, its JSON, its exit codes.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod corpus;

const OLD: &str = "SOR XIC I:0/0 BST XIC B3:0/1 NXB XIO B3:0/2 BND OTE O:0/0 EOR
SOR XIC B3:0/3 TON T4:0 0.01 100 0 EOR
SOR XIC T4:0/DN CTU C5:0 10 0 EOR
SOR XIC C5:0/DN RES C5:0 EOR
SOR GRT N7:0 50 MOV N7:0 N7:1 EOR
";

/// One contact of rung 0 is another one, rung 3 stands first, rung 2 is gone, one is new.
const NEW: &str = "SOR XIC C5:0/DN RES C5:0 EOR
SOR XIC I:0/0 BST XIC B3:0/1 NXB XIO B3:0/7 BND OTE O:0/0 EOR
SOR XIC B3:0/3 TON T4:0 0.01 100 0 EOR
SOR GRT N7:0 50 MOV N7:0 N7:1 EOR
SOR LES N7:5 12 OTL B3:1/4 EOR
";

/// A folder of its own for each test, with both programs.
fn folder(name: &str, texts: &[(&str, &str)]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("diff").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    for (file, text) in texts {
        let path = folder.join(file);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(&path, whole(text)).expect("a file");
    }
    folder
}

/// The rungs as program file 2 of a project text.
fn whole(rungs: &str) -> String {
    let (head, _) = include_str!("../../../examples/motor/motor.SLC").split_once("LADDER 2").expect("a ladder");
    format!("{head}LADDER 2\n{rungs}")
}

fn diff(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rungs"));
    command.current_dir(folder).arg("diff").args(arguments).env_remove("NO_COLOR").output().expect("the command starts")
}

fn text(output: &Output, code: i32) -> String {
    assert_eq!(output.status.code(), Some(code), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).expect("text")
}

#[test]
fn rungs_are_told_apart_by_what_happened_to_them() {
    let folder = folder("text", &[("old.SLC", OLD), ("new.SLC", NEW)]);
    insta::assert_snapshot!("unified", text(&diff(&folder, &["old.SLC", "new.SLC"]), 1));
    let wide = ["old.SLC", "new.SLC", "--two-sided", "--width", "130", "--only", "logic"];
    insta::assert_snapshot!("two_sided", text(&diff(&folder, &wide), 1));
}

#[test]
fn json_names_file_and_rungs() {
    let folder = folder("json", &[("old.SLC", OLD), ("new.SLC", NEW)]);
    let json: Value =
        serde_json::from_str(&text(&diff(&folder, &["old.SLC", "new.SLC", "--json"]), 1)).expect("a document");
    let logic = json["logic"].as_array().expect("logic").iter();
    let rows: Vec<_> = logic
        .map(|row| {
            (
                row["kind"].as_str().unwrap_or(""),
                row["file"].as_u64(),
                row["old_rung"].as_u64(),
                row["new_rung"].as_u64(),
            )
        })
        .collect();
    assert_eq!(
        rows,
        [
            ("moved", Some(2), Some(3), Some(0)),
            ("changed", Some(2), Some(0), Some(1)),
            ("deleted", Some(2), Some(2), None),
            ("inserted", Some(2), None, Some(4)),
        ]
    );
    let edit = &json["logic"][1]["edits"][0];
    assert_eq!((&edit["old"], &edit["new"]), (&Value::from("B3:0/2"), &Value::from("B3:0/7")));
    for section in ["documentation", "values", "configuration"] {
        assert_eq!(json[section], Value::Array(Vec::new()), "{section}");
    }
}

#[test]
fn exit_codes_say_equal_different_misused_unreadable() {
    let folder = folder("codes", &[("old.SLC", OLD), ("new.SLC", NEW), ("one/a.SLC", OLD)]);
    std::fs::write(folder.join("broken.RSS"), b"nothing").expect("a file");
    for (arguments, code) in [
        (vec!["old.SLC", "old.SLC"], 0),
        (vec!["old.SLC", "new.SLC"], 1),
        (vec!["old.SLC", "new.SLC", "--only", "documentation,values,configuration"], 0),
        (vec!["old.SLC", "new.SLC", "--only", "logic", "--json"], 1),
        (vec!["old.SLC"], 2),
        (vec!["old.SLC", "new.SLC", "--online"], 2),
        (vec!["old.SLC", "--online"], 2),
        (vec!["old.SLC", "new.SLC", "--only", "colour"], 2),
        (vec!["old.SLC", "one"], 2),
        // No project at all is no equality.
        (vec!["one", "one"], 2),
        (vec!["old.SLC", "broken.RSS"], 3),
        (vec!["missing.RSS", "old.SLC"], 3),
    ] {
        assert_eq!(diff(&folder, &arguments).status.code(), Some(code), "{arguments:?}");
    }
    let output = diff(&folder, &["old.SLC", "--online", "--only", "documentation"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text_of(&output).contains("nothing to compare"), "{}", text_of(&output));
}

#[test]
fn folders_are_compared_by_names() {
    let folder = folder("folders", &[]);
    let motor = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/motor/motor.RSS");
    for (to, names) in [("one", vec!["motor.RSS", "gone.RSS"]), ("two", vec!["MOTOR.rss"])] {
        std::fs::create_dir_all(folder.join(to)).expect("a folder");
        for name in names {
            std::fs::copy(&motor, folder.join(to).join(name)).expect("a copy");
        }
    }
    let found = text(&diff(&folder, &["one", "two"]), 1);
    assert!(found.contains("gone.RSS: only in one (removed)"), "{found}");
    assert!(found.contains("two/MOTOR.rss: equal"), "{found}");
    assert!(found.contains("Same bytes: one/gone.RSS, one/motor.RSS"), "{found}");
    std::fs::remove_file(folder.join("one/gone.RSS")).expect("the file");
    let json: Value = serde_json::from_str(&text(&diff(&folder, &["one", "two", "--json"]), 0)).expect("a document");
    assert_eq!(json["equal"], true);
}

#[test]
fn files_of_other_names_are_found_by_their_content() {
    let folder = folder("renamed", &[("texts/a.SLC", OLD), ("texts/b.SLC", NEW)]);
    for name in ["one", "two"] {
        std::fs::create_dir_all(folder.join(name)).expect("a folder");
    }
    let example = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name);
    let copy = |from: &Path, to: &str| {
        std::fs::copy(from, folder.join(to)).expect("a copy");
    };
    copy(&example("motor/motor.RSS"), "one/press.RSS");
    copy(&example("motor/motor.RSS"), "two/mixer.RSS");
    copy(&example("batch/batch.RSS"), "one/batch old.RSS");
    // The batch program with one value of its data table changed, under another name.
    let text =
        |path: &Path| convert::open(&std::fs::read(path).expect("a file"), "x", rss::Mode::Strict).expect("reads");
    let mut project = text(&example("batch/batch.RSS"));
    let file = project.main.data_files.iter_mut().find(|file| file.file_type == ladder::FileType::N).expect("a file");
    file.words[0] ^= 1;
    let bytes = convert::to_rss::project_file(&project).expect("builds").file.write().expect("writes");
    std::fs::write(folder.join("two/batch new.RSS"), bytes).expect("a file");
    copy(&example("traffic_light/traffic_light.RSS"), "two/added.RSS");

    let output = diff(&folder, &["one", "two", "--json"]);
    let found = self::text(&output, 1);
    let all: Vec<Value> = found.lines().map(|line| serde_json::from_str(line).expect("a document")).collect();
    let named = |name: &str| all.iter().find(|v| v["new"] == name || v["file"] == name).unwrap_or(&Value::Null);
    assert_eq!(
        (&named("two/mixer.RSS")["paired_by"], &named("two/mixer.RSS")["equal"]),
        (&"bytes".into(), &true.into())
    );
    assert_eq!(named("two/batch new.RSS")["paired_by"], "content");
    assert_eq!(named("two/batch new.RSS")["values"].as_array().map(Vec::len), Some(1));
    assert_eq!(named("two/added.RSS")["change"], "added");
    let found = self::text(&diff(&folder, &["one", "two"]), 1);
    assert!(
        found.ends_with(
            "1 files differ or were not readable, 1 equal, 2 of them under another name; 0 removed, 1 added\n"
        ),
        "{found}"
    );
}

#[test]
fn unified_text_has_rungs_with_their_neighbours_and_sections() {
    let folder = folder("reviews", &[("old.SLC", OLD), ("new.SLC", NEW)]);
    insta::assert_snapshot!("review", text(&diff(&folder, &["old.SLC", "new.SLC", "--unified"]), 1));
    assert_eq!(text(&diff(&folder, &["old.SLC", "old.SLC", "--unified"]), 0), "");
}

#[test]
fn a_project_equals_the_text_made_of_it() {
    let folder = folder("text", &[]);
    std::fs::create_dir_all(&folder).expect("a folder");
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/traffic_light/traffic_light.RSS");
    let mut export = Command::new(env!("CARGO_BIN_EXE_rungs"));
    let export = export.args(["export", "--to", "slc", "--force", "-o"]).arg(folder.join("text.SLC")).arg(&project);
    assert!(export.output().expect("the command starts").status.success());
    let found = text(&diff(&folder, &[project.to_str().expect("a path"), "text.SLC"]), 0);
    assert!(found.contains("were not compared"), "{found}");
}

/// Controllers of every family: I/O on board that text counts in words, files without elements that it does not list.
#[test]
fn real_projects_equal_the_text_made_of_them() {
    let Some(root) = corpus::root() else { return };
    let folder = folder("real_text", &[]);
    std::fs::create_dir_all(&folder).expect("a folder");
    let files = corpus::files(&root, ".rss").expect("the corpus can be listed");
    let mut compared = 0;
    for project in files.iter().step_by(9) {
        let mut export = Command::new(env!("CARGO_BIN_EXE_rungs"));
        let export = export.args(["export", "--to", "slc", "--force", "-o"]).arg(folder.join("text.SLC")).arg(project);
        // What cannot be read has no text.
        if export.output().expect("the command starts").status.success() {
            let found = diff(&folder, &[project.to_str().expect("a path of text"), "text.SLC"]);
            assert_eq!(found.status.code(), Some(0), "{}", text_of(&found));
            compared += 1;
        }
    }
    assert!(compared > files.len() / 10, "{compared}");
}

fn text_of(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

#[test]
fn what_a_project_says_cannot_command_a_terminal() {
    // U+009B begins a command in terminals that take 8-bit controls; a text with escapes is no project text.
    let comment = "% TITLE/RUNG DESCRIPTION\nTITLE: \u{9B}31m\nRUNG DESCRIPTION: a\u{9B}2Jb %\n";
    let evil = NEW.replace("OTL B3:1/4 EOR\n", &format!("OTL B3:1/4 EOR\n{comment}"));
    let folder = folder("escapes", &[("old.SLC", OLD), ("new.SLC", &evil)]);
    for look in ["--unified", "--two-sided"] {
        let found = text(&diff(&folder, &["old.SLC", "new.SLC", look]), 1);
        assert!(!found.contains(['\u{9B}', '\u{1B}']), "{look}: {found}");
        assert!(found.contains("a\\x9B2Jb"), "{look}: {found}");
    }
}

#[test]
fn pages_show_a_difference_and_never_overwrite_what_is_compared() {
    let folder = folder("diff_html", &[("old.SLC", OLD), ("new.SLC", NEW)]);
    let before = std::fs::read(folder.join("new.SLC")).expect("the file");
    let shown = text(&diff(&folder, &["old.SLC", "new.SLC", "--html", "out.html"]), 1);
    assert_eq!(shown.trim(), "out.html");
    let page = std::fs::read_to_string(folder.join("out.html")).expect("a page");
    assert!(
        page.starts_with("<!DOCTYPE html>") && page.contains("default-src 'none'") && page.contains("<svg"),
        "{page}"
    );
    assert!(!page.contains("http://") && !page.contains("https://") && !page.contains(" src="));
    text(&diff(&folder, &["old.SLC", "old.SLC", "--html", "same.html"]), 0);
    for arguments in [["old.SLC", "new.SLC", "--html", "new.SLC"], ["old.SLC", "new.SLC", "--html", "."]] {
        let output = diff(&folder, &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
    assert_eq!(std::fs::read(folder.join("new.SLC")).expect("the file"), before);
    // Nor anything else that is no page; a page is made anew when asked to.
    std::fs::write(folder.join("other.RSS"), "mine").expect("a file");
    assert_eq!(diff(&folder, &["old.SLC", "new.SLC", "--html", "other.RSS"]).status.code(), Some(2));
    assert_eq!(std::fs::read(folder.join("other.RSS")).expect("the file"), b"mine");
    let again = ["old.SLC", "old.SLC", "--html", "out.html"];
    assert_eq!(diff(&folder, &again).status.code(), Some(2));
    assert_eq!(std::fs::read_to_string(folder.join("out.html")).expect("a page"), page);
    let forced = [again.as_slice(), &["--force"]].concat();
    assert_eq!(diff(&folder, &forced).status.code(), Some(0));
    assert_ne!(std::fs::read_to_string(folder.join("out.html")).expect("a page"), page);
    assert_eq!(diff(&folder, &["old.SLC", "new.SLC", "--force"]).status.code(), Some(2));
    assert_eq!(diff(&folder, &["old.SLC", "new.SLC", "--html", "x.html", "--json"]).status.code(), Some(2));
    assert_eq!(diff(&folder, &["old.SLC", "missing.SLC", "--html", "x.html"]).status.code(), Some(3));
    assert!(!folder.join("x.html").exists());
}

#[test]
fn unified_text_of_do_more_has_rungs_with_their_neighbours() {
    let folder = folder("diff_unified_domore", &[]);
    std::fs::create_dir_all(&folder).expect("a folder");
    let rungs = |preset: &str, more: &str| {
        format!("$PRGRM $Main\n\nSTR X0\nOUT Y0\n\nSTR C0\nTMR T0 {preset}\n\nSTR X1\nOUT Y1\n{more}\n$PGMEND $Main\n")
    };
    std::fs::write(folder.join("a.txt"), rungs("500", "")).expect("a file");
    let more = "\n#BEGIN COMMENT\n\"fan\"\n#END\n\nSTR X2\nOUT Y2\n";
    std::fs::write(folder.join("b.txt"), rungs("600", more)).expect("a file");
    let shown = text(&diff(&folder, &["a.txt", "b.txt", "--unified"]), 1);
    let expected = "--- a.txt\n+++ b.txt\n# Logic\n@@ -1,3 +1,4 @@ code block $Main\n STR X0; OUT Y0\n-STR C0; TMR T0 \
                    500\n+STR C0; TMR T0 600\n STR X1; OUT Y1\n+(* fan *)\n+STR X2; OUT Y2\n";
    assert_eq!(shown, expected);
    assert_eq!(text(&diff(&folder, &["a.txt", "a.txt", "--unified"]), 0), "");
}

#[test]
fn folders_give_a_folder_of_pages() {
    let folder = folder("diff_html_folders", &[]);
    let example = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name);
    for side in ["a", "b"] {
        let _ = std::fs::remove_dir_all(folder.join(side));
        std::fs::create_dir_all(folder.join(side)).expect("a folder");
    }
    std::fs::copy(example("motor/motor.RSS"), folder.join("a/line.RSS")).expect("copied");
    std::fs::copy(example("batch/batch.RSS"), folder.join("b/line.RSS")).expect("copied");
    std::fs::copy(example("batch/batch.RSS"), folder.join("a/batch <1>.RSS")).expect("copied");
    std::fs::copy(example("batch/batch.RSS"), folder.join("b/batch <1>.RSS")).expect("copied");
    let filling = std::fs::read_to_string(example("filling_domore/filling.txt")).expect("the example");
    std::fs::write(folder.join("a/filling.txt"), &filling).expect("written");
    std::fs::write(folder.join("b/filling.txt"), filling.replace("2500", "2600")).expect("written");
    let _ = std::fs::remove_dir_all(folder.join("pages"));
    text(&diff(&folder, &["a", "b", "--html", "pages"]), 1);
    assert_eq!(diff(&folder, &["a", "b", "--html", "pages"]).status.code(), Some(2));
    text(&diff(&folder, &["a", "b", "--html", "pages", "--force"]), 1);
    let list = std::fs::read_to_string(folder.join("pages/index.html")).expect("a list");
    assert!(list.contains("a/batch &lt;1&gt;.RSS") && list.contains("equal"), "{list}");
    let mut pages = 0;
    for (at, _) in list.match_indices("href=\"./") {
        let name = list[at + 8..].split('"').next().expect("a name");
        assert!(folder.join("pages").join(name).is_file(), "{name}");
        pages += 1;
    }
    // Two names of one pair lead to one page.
    assert_eq!(pages, 4);
}
