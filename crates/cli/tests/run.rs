//! `rungs run` and `rungs test` as a user types them, on the example projects.

mod support;

use support::at_root::{rungs, text};
use support::root;

/// The motor example: the start button, with stop button and overload closed, gives three seconds of
/// warning; then the contactor pulls in.
const MOTOR: [&str; 8] = ["run", "examples/motor/motor.RSS", "--for", "4s", "--set", "I:0/0=1", "I:0/1=1", "I:0/2=1"];

fn motor(rest: &[&str]) -> String {
    let output = rungs(&[&MOTOR[..], rest].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stdout)
}

#[test]
fn csv_has_every_scan() {
    let table = motor(&["--watch", "T4:0.ACC", "O:0/0", "O:0/1", "--format", "csv"]);
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.first(), Some(&"scan,time_s,T4:0.ACC,O:0.0/0,O:0.0/1"));
    // Scans at 0, 10 ms, .. 4 s.
    assert_eq!(lines.len(), 402);
    assert_eq!(lines.get(1), Some(&"1,0,0,0,1"));
    assert_eq!(lines.get(300), Some(&"300,2.99,299,0,1"));
    assert_eq!(lines.get(301), Some(&"301,3,300,1,0"));
    assert_eq!(lines.last(), Some(&"401,4,300,1,0"));
}

#[test]
fn values_can_change_on_the_way() {
    let table = motor(&["I:0/1=0@1s", "--watch", "T4:0.ACC", "--format", "csv"]);
    assert_eq!(table.lines().nth(100), Some("100,0.99,99"));
    assert_eq!(table.lines().nth(101), Some("101,1,0"));
}

#[test]
fn a_table_shows_changes_only() {
    let table = motor(&["--watch", "O:0/0", "O:0/1", "--trace-rung", "3"]);
    let scans: Vec<&str> = table.lines().filter(|line| !line.contains("rung")).collect();
    assert_eq!(scans.len(), 4, "{table}");
    assert!(table.contains("rung 2:3  ━[XIC T4:0/DN]╌ ╌[OTE O:0.0/0]╌"), "{table}");
    assert!(table.contains("rung 2:3  ━[XIC T4:0/DN]━ ━[OTE O:0.0/0]━"), "{table}");
}

#[test]
fn branches_of_a_traced_rung_are_marked() {
    let table = motor(&["--trace-rung", "0"]);
    assert!(table.contains("rung 2:0  BST ━[XIC I:0.0/0]"), "{table}");
    assert!(table.contains(" NXB ━[XIC B3:0/0]") && table.contains(" BND ━[XIC I:0.0/1]"), "{table}");
}

/// What is counted is the same on every machine; what is measured is only there.
#[test]
fn a_measurement_counts_scans_and_instructions() {
    let output = rungs(&["bench", "examples/motor/motor.RSS", "--scans", "1000", "--json"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let found: serde_json::Value = serde_json::from_str(&text(&output.stdout)).expect("JSON");
    assert_eq!((&found["scans"], &found["simulated_s"]), (&1000.into(), &9.99.into()));
    let per_scan = found["instructions_per_scan"].as_f64().expect("a number");
    assert_eq!(found["instructions"].as_f64(), Some(1000.0 * per_scan));
    assert!(found["ns_per_instruction"].is_number() && found["scans_per_second"].is_number(), "{found}");
    assert!(found["stopped"].is_null());
    let output = rungs(&["bench", "examples/filling_domore/filling.txt", "--scans", "10"]);
    assert!(text(&output.stdout).contains("scans                10 in"), "{}", text(&output.stdout));
    assert_eq!(rungs(&["bench", "no such file"]).status.code(), Some(3));
}

#[test]
fn json_lines_end_with_a_summary() {
    let lines = motor(&["--watch", "T4:0", "--format", "json", "--trace-rung", "1"]);
    let parse = |line: &str| serde_json::from_str::<serde_json::Value>(line).expect("JSON");
    let first = parse(lines.lines().next().expect("a line"));
    assert_eq!(first["values"]["T4:0/TT"], 1);
    assert_eq!(first["values"]["T4:0.PRE"], 300);
    assert_eq!(first["rungs"]["2:1"][0]["after"], true);
    let last = parse(lines.lines().last().expect("a line"));
    assert_eq!((&last["end"], &last["scans"]), (&true.into(), &401.into()));
}

/// Reads a value change dump by its grammar: declarations, then times and changes.
#[test]
fn a_value_change_dump_follows_its_grammar() {
    let dump = motor(&["--watch", "T4:0.ACC", "O:0/0", "--format", "vcd"]);
    let (head, body) = dump.split_once("$enddefinitions $end\n").expect("an end of definitions");
    assert!(head.contains("$timescale 1 us $end") && head.contains("$scope module motor $end"), "{head}");
    let codes: Vec<(&str, &str)> = head
        .lines()
        .filter_map(|line| line.strip_prefix("$var wire "))
        .map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            (words[0], words[1])
        })
        .collect();
    assert_eq!(codes.iter().map(|code| code.0).collect::<Vec<_>>(), ["16", "1"]);
    // A colon in a name makes GTKWave drop the variable.
    assert!(head.contains(" T4_0_ACC $end") && head.contains(" O_0_0/0 $end"), "{head}");
    let (mut time, mut contactor) = (None, Vec::new());
    for line in body.lines().filter(|line| !line.starts_with('$')) {
        if let Some(now) = line.strip_prefix('#') {
            let now: u64 = now.parse().expect("a time");
            assert!(time.is_none_or(|before| before < now), "times ascend");
            time = Some(now);
        } else if let Some(vector) = line.strip_prefix('b') {
            let (bits, code) = vector.split_once(' ').expect("bits and a code");
            assert!(bits.len() == 16 && bits.bytes().all(|b| b == b'0' || b == b'1'));
            assert_eq!(code, codes[0].1);
        } else {
            let (value, code) = line.split_at(1);
            assert_eq!(code, codes[1].1);
            contactor.push((time.expect("a time before"), value.to_owned()));
        }
    }
    assert_eq!(contactor, [(0, "0".to_owned()), (3_000_000, "1".to_owned())]);
    assert_eq!(time, Some(4_000_000));
}

#[test]
fn wrong_use_says_what_is_wrong() {
    for (arguments, says) in [
        (&["run", "examples/motor/motor.RSS"][..], "--watch"),
        (&["run", "examples/motor/motor.RSS", "--watch", "N99:0"], "N99:0"),
        (&["run", "examples/motor/motor.RSS", "--watch", "no such"], "no such"),
        (&["run", "examples/motor/motor.RSS", "--watch", "T4:0", "--trace-rung", "9:1"], "program file 9"),
        (&["run", "examples/motor/motor.RSS", "--watch", "T4:0", "--set", "B3:0/0=2"], "a bit is 0 or 1"),
        (&["run", "examples/motor/motor.RSS", "--watch", "T4:0", "--scan", "0ms"], "--scan"),
        (&["run", "examples/motor/motor.RSS", "--watch", "T4:0", "--choice", "nonsense"], "acc-overshoots"),
    ] {
        let output = rungs(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(text(&output.stderr).contains(says), "{arguments:?}: {}", text(&output.stderr));
    }
    assert_eq!(rungs(&["run", "examples/none.RSS", "--watch", "T4:0"]).status.code(), Some(3));
}

#[test]
fn scenarios_on_projects_and_broken_ones() {
    let folder = std::env::temp_dir().join(format!("rungs-scenarios-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let motor = root().join("examples/motor/motor.RSS").canonicalize().expect("the example");
    let good = format!(
        "name = \"starts after the warning\"\nprogram = '{}'\n\
         [[step]]\nset = {{ \"I:0/0\" = 1, \"I:0/1\" = 1, \"I:0/2\" = 1 }}\nrun = \"3s\"\n\
         expect = {{ \"O:0/0\" = 1, \"T4:0/DN\" = 1 }}\n",
        motor.display()
    );
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("a file");
    write("a.toml", &good);
    write("b.toml", "name = \"typing slip\"\nladder = \"XCI B3:0/0 OTE B3:0/1\"\n[[step]]\nscans = 1\n");
    write("c.toml", "ladder = \"OTE B3:0/1\"\n[[step]]\nexpct = { \"B3:0/1\" = 1 }\n");
    write("d.toml", &good.replace("motor.RSS", "absent.RSS"));
    let junit = folder.join("result.xml");
    let output = rungs(&["test", "--junit", &junit.display().to_string(), &folder.display().to_string()]);
    let report = text(&output.stdout);
    let xml = std::fs::read_to_string(&junit).expect("a report");
    std::fs::remove_dir_all(&folder).expect("removed");
    assert_eq!(output.status.code(), Some(3), "{report}");
    assert!(report.contains("a.toml  starts after the warning"), "{report}");
    assert!(report.contains("line 2: ladder of program file 2: line 1, column 1: expected"), "{report}");
    assert!(report.contains("line 3: step[1].expct: there is no such key"), "{report}");
    assert!(report.contains("absent.RSS"), "{report}");
    assert!(report.ends_with("1 passed, 0 failed, 3 not run; 2 expectations, 301 scans\n"), "{report}");
    assert!(xml.contains("tests=\"4\" failures=\"0\" errors=\"3\""), "{xml}");
}

/// What is only approximated stands in every report, with its rung; what cannot run is refused with it.
#[test]
fn approximations_and_refusals_name_their_rung() {
    let folder = std::env::temp_dir().join(format!("rungs-approximations-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text).expect("a scenario");
        path.to_str().expect("a path").to_owned()
    };
    let steps = "[[step]]\nscans = 1\n";
    let pulses = "family = \"micrologix-1400\"\nladder = \"MOV 1 N7:0\\nXIC B3:0/0 PTO 0\"\n";
    let ramp = "family = \"slc-5/03\"\nladder = \"MOV 1 N7:0\\nXIC B3:0/0 RMP N7:10 N7:20\"\n";
    let (pulses, ramp) =
        (write("pulses.toml", &format!("{pulses}{steps}")), write("ramp.toml", &format!("{ramp}{steps}")));
    let junit = folder.join("junit.xml");
    let output = rungs(&["test", &pulses, &ramp, "--junit", junit.to_str().expect("a path")]);
    let report = text(&output.stdout);
    assert!(report.contains("approximate: file 2 rung 1: PTO 0: no pulses are produced"), "{report}");
    assert!(report.contains("file 2 rung 1: RMP N7:10 N7:20: no page"), "{report}");
    assert!(report.contains("1 of them ran with instructions that are only approximated"), "{report}");
    assert_eq!(output.status.code(), Some(1));
    let xml = std::fs::read_to_string(&junit).expect("a report");
    assert!(xml.contains("<system-out>approximate: file 2 rung 1: PTO 0"), "{xml}");
    assert!(xml.contains("<error message=\"the program cannot be simulated; file 2 rung 1: RMP"), "{xml}");
    let quiet = text(&rungs(&["test", "--quiet", &pulses]).stdout);
    assert!(quiet.contains("only approximated"), "{quiet}");
    let json = text(&rungs(&["test", "--json", &pulses]).stdout);
    assert!(json.contains("\"approximations\":[\"file 2 rung 1: PTO 0"), "{json}");

    let program = folder.join("program.slc");
    let program = program.to_str().expect("a path");
    let export = rungs(&["export", "--to", "slc", "examples/motor/motor.RSS", "--output", program]);
    assert!(export.status.success(), "{}", text(&export.stderr));
    let changed = std::fs::read_to_string(program).expect("a project").replacen("OTE O:0.0/0", "RPC 0 N7:0", 1);
    std::fs::write(program, changed).expect("a project");
    let output = rungs(&["run", program, "--for", "1s", "--watch", "O:0/0"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("file 2 rung "), "{}", text(&output.stderr));
    for (form, wanted) in
        [("json", "\"approximations\":[\"file 2 rung "), ("vcd", "$comment approximate: file 2 rung ")]
    {
        let rest = ["--accept-unsupported", "--for", "20ms", "--watch", "O:0/0", "--format", form];
        let output = rungs(&[&["run", program][..], &rest].concat());
        assert!(text(&output.stdout).contains(wanted), "{}", text(&output.stdout));
        assert!(text(&output.stderr).contains("approximate: file 2 rung "), "{}", text(&output.stderr));
    }
    std::fs::remove_dir_all(&folder).expect("the folder goes");
}

#[test]
fn do_more_text_runs_with_the_same_options() {
    let folder = std::env::temp_dir().join(format!("rungs-run-domore-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("flash.txt");
    std::fs::write(&path, "$PRGRM $Main\n\nSTR X0\nTMR T0 20\n\nSTR T0.Done\nOUT Y0\n\n$PGMEND $Main\n")
        .expect("a file");
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_rungs"))
        .arg("run")
        .arg(&path)
        .args(["--set", "X0=1@10ms", "--watch", "T0.Acc", "--watch", "Y0", "--for", "40ms", "--format", "csv"])
        .output()
        .expect("the command runs");
    std::fs::remove_dir_all(&folder).expect("removed");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows, ["scan,time_s,T0.Acc,Y0", "1,0,0,0", "2,0.01,0,0", "3,0.02,10,0", "4,0.03,20,1", "5,0.04,30,1"]);
}

#[test]
fn do_more_text_that_does_not_run_ends_with_the_reason() {
    let folder = std::env::temp_dir().join(format!("rungs-run-refused-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    // What is not read whole is unreadable; a rung that does not balance or an instruction without a model is refused.
    for (name, body, code, why) in [
        ("open.txt", "STR X0\nOUT Y0\n\n", 3, "expected $PGMEND"),
        ("stack.txt", "STR X0\nSTR X1\nOUT Y0\n\n$PGMEND $Main\n", 1, "too many STR"),
        ("pid.txt", "STR X0\nPIDBOX P0\n\n$PGMEND $Main\n", 1, "PIDBOX"),
        ("preset.txt", "STR X0\nTMR T0 2147483648\n\n$PGMEND $Main\n", 1, "goes up to 2147483647"),
    ] {
        let path = folder.join(name);
        std::fs::write(&path, format!("PLC DM-SIM\n$PRGRM $Main\n\n{body}")).expect("a file");
        for command in ["run", "bench"] {
            let mut run = std::process::Command::new(env!("CARGO_BIN_EXE_rungs"));
            run.arg(command).arg(&path);
            if command == "run" {
                run.args(["--watch", "Y0"]);
            }
            let output = run.output().expect("the command runs");
            let shown = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(code), "{command} {name}: {shown}");
            assert!(shown.contains(why), "{command} {name}: {shown}");
        }
    }
    std::fs::remove_dir_all(&folder).expect("removed");
}
