//! The commands as a user runs them, on the example projects: exit codes, text and JSON.

mod support;

use std::path::{Path, PathBuf};

use serde_json::Value;
use support::among_examples::{examples, rungs, text};

/// The documents of `--json`, one per line.
fn json(arguments: &[&str]) -> Vec<Value> {
    text(arguments).lines().map(|line| serde_json::from_str(line).expect("a JSON document a line")).collect()
}

/// An empty folder of its own for each test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

#[test]
fn show_reads_like_a_printout() {
    insta::assert_snapshot!("show_motor", text(&["show", "motor/motor.RSS"]));
    insta::assert_snapshot!(
        "show_range",
        text(&["show", "batch/batch.RSS", "--file", "4", "--rung", "2..3", "--width", "80", "--ascii"])
    );
}

#[test]
fn info_says_what_a_project_is() {
    insta::assert_snapshot!("info_batch", text(&["info", "batch/batch.RSS"]));
    let info = &json(&["info", "--json", "batch/batch.RSS"])[0];
    assert_eq!(info["processor"]["name"], "MicroLogix 1100 Series B");
    assert_eq!(info["program_files"].as_array().map(Vec::len), Some(5));
    assert_eq!(info["diagnostics"], Value::Array(Vec::new()));
}

#[test]
fn timers_and_counters_with_their_rungs() {
    insta::assert_snapshot!("timers_motor", text(&["timers", "motor/motor.RSS"]));
    insta::assert_snapshot!("timers_batch", text(&["timers", "batch/batch.RSS"]));
    let report = &json(&["timers", "--json", "motor/motor.RSS", "FAN_RUN_ON"])[0];
    let timer = &report["timers"][0];
    assert_eq!((&timer["address"], &timer["preset_seconds"]), (&Value::from("T4:2"), &Value::from("30")));
    assert_eq!(timer["read_by"][0]["rung"], 5);
}

#[test]
fn cross_reference_of_an_address_and_of_a_symbol() {
    insta::assert_snapshot!("xref_box_size", text(&["xref", "batch/batch.RSS", "BOX_SIZE", "C5:0", "U:3"]));
    let report = &json(&["xref", "--json", "motor/motor.RSS", "O:0/0"])[0];
    let roles: Vec<&str> = report["addresses"][0]["accesses"]
        .as_array()
        .expect("list")
        .iter()
        .filter_map(|a| a["role"].as_str())
        .collect();
    assert_eq!(roles, ["write", "read"]);
    assert_eq!(rungs(&["xref", "motor/motor.RSS", "NO_SUCH_SYMBOL"]).status.code(), Some(1));
}

#[test]
fn a_slot_with_more_words_than_any_module_has_still_reads() {
    let path = folder("wide_slot").join("wide.json");
    let exported = text(&["export", "motor/motor.RSS", "--to", "json"]);
    let mut project: Value = serde_json::from_str(&exported).expect("a JSON document");
    project["io"][0]["inputs"]["words"] = 65_535.into();
    let text_of = project.to_string().replace("I:0.0/1", "I:0.5000/1").replace("I:0/1", "I:0.5000/1");
    std::fs::write(&path, text_of).expect("written");
    let shown = text(&["xref", path.to_str().expect("a path"), "I:0.5000/1"]);
    assert!(shown.contains("point 80001"), "{shown}");
}

#[test]
fn data_tables_in_any_radix() {
    insta::assert_snapshot!("data_motor", text(&["data", "motor/motor.RSS", "T4", "N7", "B3:0/0"]));
    assert!(text(&["data", "motor/motor.RSS", "N7:1", "--radix", "hex"]).contains("N7:1  1F4"));
    assert_eq!(rungs(&["data", "motor/motor.RSS", "N7:99"]).status.code(), Some(1));
}

#[test]
fn verify_accounts_for_every_byte_and_goes_on_after_a_bad_file() {
    let bad = folder("verify").join("bad.RSS");
    std::fs::write(&bad, b"%PDF-1.4 not a project").expect("written");
    let output = rungs(&["verify", "--json", "motor/motor.RSS", &bad.display().to_string(), "batch/batch.RSS"]);
    assert_eq!(output.status.code(), Some(3));
    let lines: Vec<Value> =
        String::from_utf8_lossy(&output.stdout).lines().map(|l| serde_json::from_str(l).expect("JSON")).collect();
    assert_eq!(lines.len(), 3);
    assert_eq!(lines[1]["error"], "this is a PDF document");
    for line in [&lines[0], &lines[2]] {
        assert_eq!(line["roundtrip"], true);
        assert_eq!(line["code_differs"], Value::Array(Vec::new()));
        for stream in line["streams"].as_array().expect("streams") {
            assert_eq!(stream["identical"], true, "{stream}");
            assert_eq!(stream["bytes"], stream["understood"], "{stream}");
        }
    }
    assert_eq!(lines[0]["code_agrees"], 22);
}

#[test]
fn a_project_survives_text_and_json() {
    let folder = folder("round");
    let path = |name: &str| folder.join(name).display().to_string();
    for example in ["motor", "traffic_light", "batch"] {
        let project = format!("{example}/{example}.RSS");
        text(&["export", &project, "--to", "slc", "-o", &path("a.SLC"), "--force"]);
        text(&["export", &project, "--to", "csv", "-o", &path("a.csv"), "--force"]);
        text(&["build", &path("a.SLC"), "-o", &path("a.RSS"), "--force"]);
        text(&["export", &project, "--to", "json", "-o", &path("b.json"), "--force"]);
        text(&["build", &path("b.json"), "-o", &path("b.RSS"), "--force"]);
        let original = std::fs::read(examples().join(&project)).expect("example");
        assert!(std::fs::read(path("a.RSS")).expect("built") == original, "{example} from text");
        assert!(std::fs::read(path("b.RSS")).expect("built") == original, "{example} from JSON");
    }
}

#[test]
fn folders_and_outputs() {
    let out = folder("many").display().to_string();
    text(&["export", ".", "--to", "csv", "--table", "timers", "-o", &out, "--image", "main"]);
    // The texts beside the projects are not taken for projects; nothing is overwritten unasked.
    let again = rungs(&["export", ".", "--to", "csv", "--table", "timers", "-o", &out]);
    assert_eq!(again.status.code(), Some(2), "{}", String::from_utf8_lossy(&again.stderr));
    assert_eq!(json(&["info", "--json", "motor", "batch/batch.RSS"]).len(), 2);
}

#[test]
fn bad_use_ends_with_2() {
    for arguments in [
        &["show"][..],
        &["show", "motor/motor.RSS", "--rung", "7..4"],
        &["export", "motor/motor.RSS"],
        &["build", "motor/motor.SLC", "-o", "motor/motor.RSS"],
        &["frobnicate"],
    ] {
        assert_eq!(rungs(arguments).status.code(), Some(2), "{arguments:?}");
    }
    assert_eq!(rungs(&["info", "no/such/file.RSS"]).status.code(), Some(3));
}

#[test]
fn a_rung_beyond_the_file_is_a_finding() {
    let output = rungs(&["show", "motor/motor.RSS", "--rung", "900"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("has rungs 0 to 8"));
}

#[test]
fn an_empty_folder_does_not_stop_the_rest() {
    let empty = folder("empty").display().to_string();
    assert_eq!(json(&["info", "--json", &empty, "motor"]).len(), 1);
    assert_eq!(rungs(&["info", &empty]).status.code(), Some(2));
}

#[test]
fn a_project_read_in_part_is_not_written_to_a_file() {
    let folder = folder("partial");
    let mut bytes = std::fs::read(examples().join("motor/motor.RSS")).expect("example");
    // The first compressed stream that is damaged enough not to inflate.
    let damaged = folder.join("damaged.RSS");
    let target = folder.join("out.json");
    let (damaged_name, target_name) = (damaged.display().to_string(), target.display().to_string());
    let start = bytes.windows(2).position(|pair| pair == [0x78, 0x9C]).expect("a zlib stream");
    bytes[start + 2..start + 6].fill(0xFF);
    std::fs::write(&damaged, bytes).expect("written");
    let output = rungs(&["export", &damaged_name, "--to", "json", "-o", &target_name]);
    assert_eq!(output.status.code(), Some(3), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(!target.exists());
}

#[test]
fn a_folder_is_exported_whole_into_the_same_subfolders() {
    let (from, to) = (folder("export_from"), folder("export_to"));
    for below in ["a", "b"] {
        std::fs::create_dir_all(from.join(below)).expect("a folder");
        std::fs::copy(examples().join("motor/motor.RSS"), from.join(below).join("motor.RSS")).expect("a copy");
    }
    let (from, to) = (from.display().to_string(), to.display().to_string());
    text(&["export", &from, "--to", "json", "-o", &to]);
    for below in ["a", "b"] {
        assert!(Path::new(&to).join(below).join("motor.json").is_file(), "{below}");
    }
    // One that is in the way does not stop the others.
    std::fs::remove_file(Path::new(&to).join("b/motor.json")).expect("removed");
    let again = rungs(&["export", &from, "--to", "json", "-o", &to]);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("a/motor.json exists; --force overwrites it"));
    assert!(Path::new(&to).join("b/motor.json").is_file());
    // Two of one name and no folder to keep them apart: the second is told what is the matter.
    let (a, b) = (format!("{from}/a/motor.RSS"), format!("{from}/b/motor.RSS"));
    let clash = rungs(&["export", &a, &b, "--to", "json", "-o", &to, "--force"]);
    assert_eq!(clash.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&clash.stderr).contains("was just written from another project"));
}

#[test]
fn several_json_projects_are_one_document_a_line() {
    assert_eq!(json(&["export", "motor/motor.RSS", "batch/batch.RSS", "--to", "json"]).len(), 2);
}

#[test]
fn a_build_never_replaces_its_source_and_says_what_it_cannot_write() {
    let folder = folder("build");
    let path = |name: &str| folder.join(name).display().to_string();
    std::fs::copy(examples().join("motor/motor.SLC"), folder.join("motor.SLC")).expect("a copy");
    let before = std::fs::read(folder.join("motor.SLC")).expect("the text");
    let over = rungs(&["build", &path("motor.SLC"), "-o", &path("./motor.SLC"), "--force"]);
    assert_eq!(over.status.code(), Some(2));
    assert_eq!(std::fs::read(folder.join("motor.SLC")).expect("the text"), before);
    assert_eq!(rungs(&["build", &path("motor.SLC"), "-o", &path("none/motor.RSS")]).status.code(), Some(2));
    let garbage = "START Bul.1763 % x %\n\nLADDER 2\nSOR XIC B3:0/0 OTE B3:0/1 EOR\nsor XIC B3:0/2 OTE B3:0/3 eor\n";
    std::fs::write(folder.join("g.SLC"), garbage).expect("written");
    let refused = rungs(&["build", &path("g.SLC"), "-o", &path("g.RSS")]);
    assert_eq!(refused.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("line 5: expected a rung"));
    assert!(!folder.join("g.RSS").exists());
    let escape = text(&["export", "motor/motor.RSS", "--to", "json"]).replacen("\"LADDER\"", "\"\\u001b[31m\"", 1);
    std::fs::write(folder.join("e.json"), escape).expect("written");
    let refused = rungs(&["build", &path("e.json"), "-o", &path("e.RSS")]);
    assert_eq!(refused.status.code(), Some(3));
    assert!(!refused.stderr.contains(&0x1B), "{}", String::from_utf8_lossy(&refused.stderr));
}

#[test]
fn a_reversed_range_is_named() {
    let output = rungs(&["show", "motor/motor.RSS", "--rung", "5..2"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("the range is reversed"));
}

#[test]
fn a_bit_that_no_word_has_is_not_reported_on() {
    let output = rungs(&["xref", "motor/motor.RSS", "B3:0/17"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("`B3:0/17` is no address"));
}

#[test]
fn a_length_of_zero_does_not_hide_a_file_from_the_cross_reference() {
    let folder = folder("length");
    let path = |name: &str| folder.join(name).display().to_string();
    let program = "START Bul.1763 % Bul.1763     MicroLogix 1100 Series B %\n\nLADDER 2\n\
                   SOR XIC B3:9/0 FFL N7:0 #N13:0 R6:0 8 0 EOR\nSOR XIC B3:9/0 BSL #B3:0 R6:1 I:0/0 16 EOR\n\n\
                   DATA R6:0\n% .CTL .LEN .POS %\n0X0000 0 0 % R6:0 %\n0X0000 0 0 % R6:1 %\n";
    std::fs::write(folder.join("z.SLC"), program).expect("written");
    text(&["build", &path("z.SLC"), "-o", &path("z.RSS"), "--force"]);
    for address in ["#N13:0", "N13:2", "B3:0"] {
        let found = &json(&["xref", &path("z.RSS"), address, "--json"])[0]["addresses"][0]["accesses"];
        let may = found.as_array().expect("accesses").iter().any(|it| it["certainty"] == "may");
        assert!(may, "{address}: {found}");
    }
}

#[test]
fn rungs_are_drawn_as_files_and_as_a_page() {
    let one = text(&["export", "motor/motor.RSS", "--to", "svg", "--rung", "0"]);
    assert!(one.starts_with("<svg ") && one.ends_with("</svg>\n") && one.contains("<style>"), "{one}");
    let many = rungs(&["export", "motor/motor.RSS", "--to", "svg"]);
    assert_eq!(many.status.code(), Some(2), "several files on standard output");
    let to = folder("export_svg").to_string_lossy().into_owned();
    let written = text(&["export", "motor/motor.RSS", "--to", "svg", "--out", &to]);
    let files: Vec<&str> = written.lines().collect();
    assert!(files.len() > 1 && files.iter().all(|file| std::path::Path::new(file).is_file()), "{written}");
    let none = rungs(&["export", "motor/motor.RSS", "--to", "svg", "--file", "77", "--out", &to]);
    assert_eq!(none.status.code(), Some(1), "no such file");
    for project in ["motor/motor.RSS", "filling_domore/filling.txt"] {
        let page = text(&["export", project, "--to", "html"]);
        assert!(page.starts_with("<!doctype html>") && page.ends_with("</body></html>\n"));
        assert!(!page.contains("<script") && !page.contains("http"), "{project} needs something from elsewhere");
        // Every link leads to a place of the page.
        for link in page.split("href=\"#").skip(1).filter_map(|rest| rest.split('"').next()) {
            assert!(page.contains(&format!(" id=\"{link}\"")), "{project}: {link}");
        }
        assert!(page.contains("href=\"#a0\""), "{project} has no link");
    }
}

#[test]
fn drawings_in_the_documents_are_what_is_drawn_now() {
    let docs = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/drawings");
    let shapes = docs.join("shapes.SLC").to_string_lossy().into_owned();
    let sets: [(&str, &[&str]); 3] = [
        ("shapes", &[&shapes, "--state", "--file", "2", "--rung", "0..10"]),
        ("motor", &["motor/motor.RSS", "--file", "2", "--rung", "0..1"]),
        ("filling", &["filling_domore/filling.txt", "--rung", "3", "--block", "Fill"]),
    ];
    for (name, arguments) in sets {
        let to = folder(&format!("drawings_{name}"));
        let out = to.to_string_lossy().into_owned();
        let common = ["export", "--to", "svg", "--width", "100", "--force", "--out", &out];
        let written = text(&[&common[..], arguments].concat());
        for file in written.lines().map(std::path::Path::new) {
            let kept = docs.join(name).join(file.file_name().expect("a name"));
            let drawn = std::fs::read_to_string(file).expect("a drawing");
            if std::env::var_os("RUNGS_BLESS").is_some() {
                std::fs::write(&kept, &drawn).expect("written");
            }
            let same = std::fs::read_to_string(&kept).is_ok_and(|text| text == drawn);
            assert!(same, "{} is not what is drawn now: RUNGS_BLESS=1 writes it", kept.display());
        }
    }
}
