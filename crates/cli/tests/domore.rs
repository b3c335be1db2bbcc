//! The commands on a Do-more project, as a user runs them.

mod support;

use std::path::Path;

use serde_json::Value;
use support::among_examples::{examples, rungs, text};

const FILE: &str = "filling_domore/filling.txt";

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&text(arguments)).expect("one JSON document")
}

#[test]
fn show_draws_its_rungs() {
    insta::assert_snapshot!("domore_show", text(&["show", FILE]));
    let one = text(&["show", FILE, "--block", "Fill", "--rung", "3"]);
    assert!(one.contains("0003") && !one.contains("0002") && !one.contains("0004"), "{one}");
    let rungs = &json(&["show", "--json", FILE, "--block", "Report"])["code_blocks"][0]["rungs"];
    assert_eq!(rungs[1]["text"], "RET");
}

#[test]
fn info_and_xref_tell_of_it() {
    insta::assert_snapshot!("domore_info", text(&["info", FILE]));
    insta::assert_snapshot!("domore_xref", text(&["xref", FILE, "CT0", "Bottle", "D100", "Report"]));
    let xref = json(&["xref", "--json", FILE, "T1"]);
    assert_eq!(xref["addresses"][0]["accesses"][0]["operand"], "T1.Acc");
    assert_eq!(rungs(&["xref", FILE, "Nothing"]).status.code(), Some(1));
}

#[test]
fn it_is_written_back_byte_for_byte() {
    let bytes = std::fs::read(examples().join(FILE)).expect("the example");
    assert_eq!(rungs(&["export", FILE, "--to", "domore"]).stdout, bytes);
    let verify = json(&["verify", "--json", FILE]);
    assert_eq!((&verify["roundtrip"], &verify["balanced"]), (&Value::Bool(true), &verify["rungs"]));
    assert_eq!(verify["instructions_unknown"], 0);
}

#[test]
fn other_tools_get_json_and_tables() {
    let document = json(&["export", FILE, "--to", "json"]);
    assert_eq!(document["schema"], "rungs.domore/1");
    assert_eq!(document["controller"], "DM-SIM");
    assert_eq!(document["code_blocks"].as_array().map(Vec::len), Some(3));
    let comment = &document["code_blocks"][1]["rungs"][2]["comment"];
    assert_eq!(comment["text"], "Bottles in the crate; the counter keeps counting beyond 100%.");
    let table = text(&["export", FILE, "--to", "csv"]);
    assert!(table.contains("X0,Start,\"start button\npanel\","), "{table}");
    assert!(
        text(&["export", FILE, "--to", "csv", "--table", "xref"]).contains("CT0.Done,Fill,4,STR,read,definite,operand")
    );
}

#[test]
fn what_does_not_fit_says_so() {
    for (arguments, code, says) in [
        (vec!["check", FILE], 2, "rungs verify"),
        (vec!["data", FILE, "Nothing"], 1, "no memory block"),
        (vec!["timers", FILE, "T99"], 1, "no instruction of this program"),
        (vec!["diff", FILE, "motor/motor.RSS"], 2, "rungs prove"),
        (vec!["diff", FILE, "--online"], 2, "no online image"),
        (vec!["export", FILE, "--to", "slc"], 2, "no SLC text"),
        (vec!["export", "motor/motor.RSS", "--to", "domore"], 2, "rungs migrate"),
        (vec!["show", FILE, "--file", "2"], 1, "--block NAME"),
        (vec!["show", "motor/motor.RSS", "--block", "Fill"], 1, "--file N"),
    ] {
        let output = rungs(&arguments);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
        assert!(message.contains(says), "{arguments:?}: {message}");
    }
}

#[test]
fn timers_memory_and_search_answer_for_it() {
    insta::assert_snapshot!("domore_timers", text(&["timers", FILE]));
    let timer = &json(&["timers", "--json", FILE, "RunUp"])["timers"][0];
    assert_eq!((&timer["preset_seconds"], &timer["read_by"][0]["operand"]), (&"2.5".into(), &"T0.Done".into()));
    let memory = json(&["data", "--json", FILE]);
    assert!(memory["memory"].as_array().is_some_and(Vec::is_empty));
    assert_eq!(json(&["data", "--json", FILE, "ct"])["memory"][0]["count"], 256);
    // A folder with programs of both dialects.
    let all = text(&["search", "--no-draw", "TMR *", "."]);
    assert!(all.contains("filling.txt: 1 found") && all.contains("Fill:2  instruction  TMR T0 2500"), "{all}");
    let hit = &json(&["search", "--json", "Bottle", FILE])["hits"][0];
    assert_eq!(
        (&hit["rung"]["code_block"], &hit["rung"]["rung"], &hit["kind"]),
        (&"Fill".into(), &3.into(), &"read".into())
    );
    assert!(text(&["search", "start button", FILE]).contains("description  X0 Start start button panel"));
    assert!(text(&["search", "T0", FILE]).contains("0002"), "the rung is drawn");
}

#[test]
fn differences_name_code_blocks() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("domore_diff");
    std::fs::create_dir_all(&folder).expect("a folder");
    let old = std::fs::read_to_string(examples().join(FILE)).expect("the example");
    let new = old.replacen("OUT\tY0", "OUT\tY7", 1).replacen("TMR\tT0\t2500", "AND\tC77\nTMR\tT0\t2600", 1).replacen(
        "belt motor",
        "<b>belt</b>",
        1,
    );
    let path = folder.join("new.txt");
    std::fs::write(&path, new).expect("written");
    let path = path.to_str().expect("a path");
    let document = rungs(&["diff", "--json", FILE, path]);
    assert_eq!(document.status.code(), Some(1));
    let document: Value = serde_json::from_slice(&document.stdout).expect("one JSON document");
    let rung = |row: &Value| {
        (
            row["kind"].clone(),
            row["file"].clone(),
            row["code_block"].clone(),
            row["old_rung"].clone(),
            row["new_rung"].clone(),
        )
    };
    let rows: Vec<_> = document["logic"].as_array().expect("rows").iter().map(rung).collect();
    let expected = |number: u32| ("changed".into(), 2.into(), "Fill".into(), number.into(), number.into());
    assert_eq!(rows, [expected(1), expected(2)]);
    assert_eq!(document["logic"][1]["edits"][0]["new"], "AND C77");
    assert_eq!(document["documentation"][0]["name"], "Y0");
    let shown = String::from_utf8(rungs(&["diff", FILE, path]).stdout).expect("text");
    assert!(shown.contains("Code block Fill rung 2 changed") && shown.contains("Values: not compared"), "{shown}");
    assert!(shown.contains("+ <b>belt</b>"), "{shown}");
    assert!(String::from_utf8_lossy(&rungs(&["diff", FILE, path, "--two-sided"]).stdout).contains("0002"));
    for only in ["values", "configuration"] {
        assert_eq!(rungs(&["diff", FILE, path, "--only", only]).status.code(), Some(0), "{only}");
    }
    assert_eq!(rungs(&["diff", FILE, FILE]).status.code(), Some(0));
}

#[test]
fn unbalanced_rungs_are_a_finding_with_a_place() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("domore_unbalanced");
    std::fs::create_dir_all(&folder).expect("a folder");
    let file = folder.join("bad.txt");
    std::fs::write(&file, "PLC DM-SIM\n$PRGRM $Main\n\nSTR X0\nSTR X1\nOUT Y0\n\n$PGMEND $Main\n").expect("a file");
    let output = rungs(&["show", &file.to_string_lossy()]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stdout).contains("STR X0; STR X1; OUT Y0"));
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(message.contains("line 6, column 1, $Main rung 1: too many STR instructions"), "{message}");
}
