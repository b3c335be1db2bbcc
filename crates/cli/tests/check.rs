//! `rungs check` and `rungs search` as a user runs them: exit codes, text, JSON, suppression.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn rungs(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rungs")).args(arguments).output().expect("the command starts")
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// A folder of its own for each test, with a program in SLC text.
fn project(name: &str, rungs: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("line.SLC");
    let text = format!("START Bul.1763 % Bul.1763 %\nLADDER 2\n{rungs}\nSOR END EOR\n");
    std::fs::write(&path, text).expect("written");
    path
}

const TWO_COILS: &str = "SOR XIC B3:0/0 OTE B3:0/1 EOR\nSOR XIC B3:0/2 OTE B3:0/1 EOR";

#[test]
fn findings_have_codes_and_their_rung_drawn() {
    let path = project("check_draw", TWO_COILS);
    let path = path.to_str().expect("a path");
    let output = rungs(&["check", path, "--only", "OUT01"]);
    let shown = text(&output);
    assert_eq!(output.status.code(), Some(0), "{shown}{}", String::from_utf8_lossy(&output.stderr));
    assert!(shown.contains("0 errors, 1 warning, 0 notes") && shown.contains("OUT01"), "{shown}");
    assert!(shown.contains("0000") && shown.contains("( )"), "{shown}");
    let plain = text(&rungs(&["check", path, "--only", "out", "--no-draw"]));
    assert!(plain.contains("OUT01") && !plain.contains("( )"), "{plain}");
}

#[test]
fn json_suppression_and_exit_codes() {
    let path = project("check_json", TWO_COILS);
    let name = path.to_str().expect("a path");
    let document = |output: &Output| -> Value { serde_json::from_str(text(output).trim()).expect("JSON") };
    let report = document(&rungs(&["check", "--json", name, "--only", "OUT01"]));
    assert_eq!(report["counts"]["warning"], 1);
    assert_eq!(report["findings"][0]["rungs"][1]["rung"], 1);
    let rules = path.with_file_name(".rungs-check.toml");
    std::fs::write(&rules, "[[allow]]\ncheck = \"OUT01\"\nreason = \"selector\"\n").expect("written");
    let report = document(&rungs(&["check", "--json", name, "--only", "OUT01"]));
    assert_eq!((&report["counts"]["warning"], &report["counts"]["suppressed"]), (&0.into(), &1.into()));
    assert_eq!(report["suppressed"][0]["by"], "rule: selector");
    std::fs::write(&rules, "[[allow]]\ncheck = \"NONE\"\n").expect("written");
    assert_eq!(rungs(&["check", name]).status.code(), Some(2));
    std::fs::remove_file(&rules).expect("removed");

    let broken = project("check_error", "SOR XIC B3:0/0 JSR 9 EOR");
    assert_eq!(rungs(&["check", broken.to_str().expect("a path")]).status.code(), Some(1));
    assert_eq!(rungs(&["check", "--explain", "tim04"]).status.code(), Some(0));
    assert_eq!(rungs(&["check", "--explain", "tim99"]).status.code(), Some(2));
    assert_eq!(rungs(&["check", name, "--only", "NONE"]).status.code(), Some(2));
    let missing = path.with_file_name("missing.RSS");
    assert_eq!(rungs(&["check", missing.to_str().expect("a path")]).status.code(), Some(3));
}

#[test]
fn search_finds_addresses_patterns_and_expressions() {
    let path = project("search", "SOR XIC B3:0/0 TON T4:0 0.01 500 0 EOR\nSOR XIC B3:0/0 TON T4:1 0.01 499 0 EOR");
    let name = path.to_str().expect("a path");
    let found = |arguments: &[&str]| {
        let mut all = vec!["search", "--no-draw"];
        all.extend(arguments);
        let output = rungs(&all);
        (output.status.code(), text(&output).lines().filter(|line| line.trim_start().starts_with("2:")).count())
    };
    assert_eq!(found(&["B3/0", name]), (Some(0), 2));
    assert_eq!(found(&["TON * 0.01 >=500 *", name]), (Some(0), 1));
    assert_eq!(found(&["ton T4:? .01 <500", name]), (Some(0), 1));
    assert_eq!(found(&["TON * 1.0", name]), (Some(1), 0));
    assert_eq!(found(&["T4:1", name]), (Some(0), 1));
    assert_eq!(found(&["--regex", "^ton t4:[01] ", name]), (Some(0), 2));
    assert_eq!(found(&["no such text", name]), (Some(1), 0));
    assert_eq!(found(&["--regex", "(", name]), (Some(2), 0));
    let shown = text(&rungs(&["search", "TON T4:0", name]));
    assert!(shown.contains("Timer On Delay"), "{shown}");
    let document: Value = serde_json::from_str(text(&rungs(&["search", "--json", "T4:0", name])).trim()).expect("JSON");
    assert_eq!((&document["hits"][0]["kind"], &document["hits"][0]["rung"]["rung"]), (&"read/write".into(), &0.into()));
}
