//! `rungs prove` from the command line: verdicts, exit codes, files.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn rungs(arguments: &[&str]) -> Output {
    let output = Command::new(env!("CARGO_BIN_EXE_rungs")).args(arguments).output();
    output.expect("the program starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn example(name: &str) -> String {
    format!("{}/../../examples/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn path(path: &Path) -> &str {
    path.to_str().expect("a plain path")
}

#[test]
fn a_program_and_itself() {
    let motor = example("motor/motor.SLC");
    let output = rungs(&["prove", &motor, &example("motor/motor.RSS"), "--scans", "3000", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one document");
    assert_eq!(report["verdict"], "no difference found within this coverage");
    assert_eq!(report["schema"], "rungs.proof/1");
    assert_eq!((report["scans"].as_u64(), report["seed"].as_u64()), (Some(3000), Some(1)));
    assert!(report["coverage"]["rung_conditions"]["reached"].as_u64() > Some(20));
    // The same seed prints the same report.
    assert_eq!(
        output.stdout,
        rungs(&["prove", &motor, &example("motor/motor.RSS"), "--scans", "3000", "--json"]).stdout
    );
}

#[test]
fn a_difference_comes_with_scenarios_that_run() {
    let folder = folder("prove_difference");
    let original = std::fs::read_to_string(example("motor/motor.SLC")).expect("the example");
    let changed = original.replacen("XIC I:0.0/1 ", "XIO I:0.0/1 ", 1);
    assert_ne!(changed, original, "the example has a contact to invert");
    let other = folder.join("changed.SLC");
    std::fs::write(&other, changed).expect("written");
    let out = folder.join("proof");
    let output = rungs(&["prove", &example("motor/motor.SLC"), path(&other), "--out", path(&out)]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stdout));
    assert!(text(&output.stdout).starts_with("different\n"), "{}", text(&output.stdout));
    assert!(out.join("proof.txt").is_file());
    let test = |name: &str| rungs(&["test", path(&out.join(name))]);
    assert_eq!(test("original.toml").status.code(), Some(0), "{}", text(&test("original.toml").stdout));
    let converted = test("converted.toml");
    assert_eq!(converted.status.code(), Some(1), "{}", text(&converted.stdout));
    assert!(text(&converted.stdout).contains("expected"), "{}", text(&converted.stdout));
    // A run that finds nothing leaves no difference of an earlier one beside its report.
    let motor = example("motor/motor.SLC");
    let output = rungs(&["prove", &motor, &motor, "--out", path(&out), "--scans", "500"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stdout));
    assert!(out.join("proof.txt").is_file());
    assert!(!out.join("original.toml").exists() && !out.join("converted.toml").exists());
}

#[test]
fn a_run_ends_in_time_and_says_so() {
    let motor = example("motor/motor.SLC");
    let started = std::time::Instant::now();
    let output = rungs(&["prove", &motor, &motor, "--scans", "4000000000", "--seconds", "0.5"]);
    assert!(started.elapsed() < std::time::Duration::from_secs(60));
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stdout));
    assert!(text(&output.stdout).contains("stopped early, after"), "{}", text(&output.stdout));
    assert!(output.stderr.is_empty(), "no bar in a pipe: {}", text(&output.stderr));
    assert_eq!(rungs(&["prove", &motor, &motor, "--seconds", "soon"]).status.code(), Some(2));
}

#[test]
fn bad_use_and_unreadable_files() {
    let motor = example("motor/motor.SLC");
    assert_eq!(rungs(&["prove", &motor]).status.code(), Some(2));
    assert_eq!(rungs(&["prove", &motor, "no such file"]).status.code(), Some(3));
    let folder = folder("prove_bad");
    let domore = folder.join("x.txt");
    std::fs::write(&domore, "PLC DM-SIM\r\n$PRGRM $Main\r\n\r\nSTR X0\r\nOUT Y0\r\n\r\n$PGMEND $Main\r\n")
        .expect("written");
    let output = rungs(&["prove", &motor, path(&domore)]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("--map"), "{}", text(&output.stderr));
    assert_eq!(rungs(&["prove", path(&domore), &motor]).status.code(), Some(2));
    let map = folder.join("map.csv");
    std::fs::write(&map, "a,b\n1,2\n").expect("written");
    assert_eq!(rungs(&["prove", &motor, path(&domore), "--map", path(&map)]).status.code(), Some(3));
    // A map that places nothing: not comparable, and never 0.
    std::fs::write(&map, "slc,domore\n").expect("written");
    let output = rungs(&["prove", &motor, path(&domore), "--map", path(&map)]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stdout).starts_with("not comparable\n"), "{}", text(&output.stdout));
}

#[test]
fn a_migrated_program_is_proven_by_its_map() {
    let folder = folder("prove_migrated");
    let motor = example("motor/motor.SLC");
    let made = rungs(&["migrate", &motor, "--to", "domore", "--out", path(&folder)]);
    assert_eq!(made.status.code(), Some(0), "{}", text(&made.stderr));
    let found = |end: &str| {
        let all = std::fs::read_dir(&folder).expect("a folder").filter_map(Result::ok).map(|entry| entry.path());
        all.into_iter().find(|file| file.to_string_lossy().ends_with(end)).expect("written")
    };
    let (program, map) = (found(".txt"), found("map.csv"));
    let arguments = ["prove", &motor, path(&program), "--map", path(&map), "--scans", "3000"];
    let output = rungs(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stdout));

    // Rows that place nothing are refused by their number; helpers are none of the data.
    let rows = std::fs::read_to_string(&map).expect("text");
    for row in ["O:0.0/1,,,BOGUS7,,", "N7:0,N7:0,1,N5000000,,", "O:0.0/1,,,,,", "O:0.0/1,,,N5,,", "nonsense,,1,N5,,"] {
        std::fs::write(&map, format!("{rows}helper,,,BOGUS7,,\r\n{row}\r\n")).expect("written");
        let output = rungs(&arguments);
        assert_eq!(output.status.code(), Some(2), "{row}: {}", text(&output.stdout));
        let number = format!("row {}:", rows.lines().count() + 1);
        assert!(text(&output.stderr).contains(&number), "{row}: {number} {}", text(&output.stderr));
    }
    std::fs::write(&map, format!("{rows}helper,,,BOGUS7,,\r\n")).expect("written");
    assert_eq!(rungs(&arguments).status.code(), Some(0));

    // No scan, no claim.
    let output = rungs(&["prove", &motor, path(&program), "--map", path(&map), "--scans", "0"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stdout));
    assert!(text(&output.stdout).contains("\nnothing compared\n"), "{}", text(&output.stdout));
    assert!(!text(&output.stdout).contains("100.0 %"), "{}", text(&output.stdout));

    // Without marks nobody knows whether a rung is missing.
    let whole = std::fs::read_to_string(&program).expect("text");
    std::fs::write(&program, whole.replace("SLC 2:", "Rung 2:").replace("SLC 3:", "Rung 3:")).expect("written");
    let output = rungs(&arguments);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stdout));
    assert!(text(&output.stdout).contains("no rung marks"), "{}", text(&output.stdout));
    let mut unmarked = arguments.to_vec();
    unmarked.push("--no-marks");
    let output = rungs(&unmarked);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stdout));
    let first = text(&output.stdout).lines().next().map(str::to_owned).unwrap_or_default();
    assert!(first.contains("the identity of the rungs was not checked"), "{first}");

    // A rung less: its mark is missed whatever it does.
    let start = whole.find("SLC 2:1 ").and_then(|at| whole[..at].rfind("#BEGIN")).expect("a mark");
    let end = whole.find("SLC 2:2 ").and_then(|at| whole[..at].rfind("#BEGIN")).expect("a mark");
    std::fs::write(&program, format!("{}{}", &whole[..start], &whole[end..])).expect("written");
    let output = rungs(&arguments);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stdout));
    assert!(text(&output.stdout).contains("2:1"), "{}", text(&output.stdout));
}
