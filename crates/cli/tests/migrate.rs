//! `rungs migrate` as a user types it, on the example projects.

mod support;

use std::path::{Path, PathBuf};
use std::process::Output;
use support::at_root::{rungs, text};

/// An empty folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("migrate").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    folder
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn migrate(program: &str, out: &Path, more: &[&str]) -> Output {
    let out = out.to_str().expect("a path");
    rungs(&[&["migrate", program, "--to", "domore", "--out", out], more].concat())
}

const FILES: [&str; 6] =
    ["address-map.csv", "documentation.csv", "initial-values.csv", "motor.txt", "report.html", "report.json"];

#[test]
fn a_folder_with_everything_is_written_once() {
    let out = folder("once");
    let first = migrate("examples/motor/motor.RSS", &out, &[]);
    assert!(first.status.success(), "{}", text(&first.stderr));
    assert_eq!(names(&out), FILES);
    let program = std::fs::read(out.join("motor.txt")).expect("a text");
    assert!(text(&program).contains("$PRGRM\t$Main\r\n"), "lines end in CR LF");
    let second = migrate("examples/motor/motor.RSS", &out, &[]);
    assert_eq!(second.status.code(), Some(2));
    assert!(text(&second.stderr).contains("--overwrite replaces it"), "{}", text(&second.stderr));
    let third = migrate("examples/motor/motor.RSS", &out, &["--overwrite"]);
    assert!(third.status.success());
    assert_eq!(std::fs::read(out.join("motor.txt")).expect("a text"), program, "the same twice");
}

#[test]
fn the_report_tells_every_rung() {
    let out = folder("report");
    let run = migrate("examples/batch/batch.RSS", &out, &["--json"]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let summary: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.join("report.json")).expect("a report")).expect("JSON");
    assert_eq!(report["schema"], "rungs.migration/1");
    assert_eq!(report["counts"], summary["counts"]);
    assert_eq!(report["rungs"].as_array().map(Vec::len), report["counts"]["rungs"].as_u64().map(|n| n as usize));
    assert!(report["unchecked"].as_str().is_some_and(|text| text.contains("No copy of Do-more Designer")));
    let page = text(&std::fs::read(out.join("report.html")).expect("a page"));
    assert!(
        !page.contains("<script") && !page.contains("http:") && !page.contains("https:"),
        "the page needs nothing else"
    );
    assert_eq!(page.matches("<section").count() as u64, report["counts"]["rungs"].as_u64().expect("a count"));
}

#[test]
fn the_text_is_a_project_for_the_other_commands() {
    let out = folder("reads");
    assert!(migrate("examples/traffic_light/traffic_light.RSS", &out, &[]).status.success());
    let program = out.join("traffic_light.txt");
    let shown = rungs(&["show", program.to_str().expect("a path")]);
    assert!(shown.status.success(), "{}", text(&shown.stderr));
    assert!(text(&shown.stdout).contains("SLC 2:0  XIO T4:3/DN TON T4:0 0.01 1200 0"));
}

#[test]
fn a_map_is_kept() {
    let (first, second) = (folder("map-1"), folder("map-2"));
    assert!(migrate("examples/motor/motor.RSS", &first, &[]).status.success());
    let map = first.join("address-map.csv");
    let edited = text(&std::fs::read(&map).expect("a map")).replace(",Y0,", ",Y160,");
    std::fs::write(&map, edited).expect("written");
    let run = migrate("examples/motor/motor.RSS", &second, &["--map", map.to_str().expect("a path")]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let program = text(&std::fs::read(second.join("motor.txt")).expect("a text"));
    assert!(program.contains("OUT\tY160") && !program.contains("OUT\tY0\r"), "{program}");
}

#[test]
fn both_programs_run_side_by_side() {
    let out = folder("proof");
    let run = migrate("examples/motor/motor.RSS", &out, &["--prove", "--scans", "2000"]);
    assert!(run.status.success(), "{}{}", text(&run.stdout), text(&run.stderr));
    assert!(text(&run.stdout).contains("no difference found within this coverage"));
    assert!(names(&out).contains(&"proof.txt".to_owned()));
}

#[test]
fn bad_use_and_bad_input_end_with_their_codes() {
    let out = folder("bad");
    let nothing = migrate("README.md", &out, &[]);
    assert_eq!(nothing.status.code(), Some(3), "{}", text(&nothing.stderr));
    let missing = migrate("examples/motor/none.RSS", &out, &[]);
    assert_eq!(missing.status.code(), Some(3));
    let map = migrate("examples/motor/motor.RSS", &out, &["--map", "README.md"]);
    assert_eq!(map.status.code(), Some(3));
    assert!(text(&map.stderr).contains("columns named slc and domore"), "{}", text(&map.stderr));
    let image = migrate("examples/motor/motor.RSS", &out, &["--image", "online"]);
    assert_eq!(image.status.code(), Some(1));
    assert!(!out.exists(), "nothing was written");
}
