//! Hostile input within bounds: every reading command on files made to be expensive, with a bound on
//! memory. A run that needs more is killed by the system, which no exit code allows for.

#![cfg(target_os = "linux")]

mod bad_support;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use bad_support::*;
use rss::{ImageKind, StreamKind};

/// Address space in KiB. What a command may use is 256 MB; the program itself, its stack and what the
/// allocator keeps in reserve come on top, more so in debug builds.
const MEMORY: &str = "-v 393216";

/// Nothing takes that long; it only keeps a hanging test from hanging forever.
const TIME: &str = "-t 60";

/// A command has a second where it is built for speed; debug builds and busy machines need more.
const HANG: Duration = Duration::from_secs(60);

const READING: &[&[&str]] = &[
    &["info"],
    &["info", "--json"],
    &["show"],
    &["show", "--json"],
    &["data"],
    &["data", "--json"],
    &["timers"],
    &["timers", "--json"],
    &["xref"],
    &["xref", "--json"],
    &["xref", "--findings"],
    &["verify"],
    &["history"],
    &["export", "--to", "json"],
    &["export", "--to", "slc"],
    &["export", "--to", "csv", "--table", "timers"],
    &["export", "--to", "csv", "--table", "xref"],
];

/// Those of them that hold or print most.
const LARGEST: &[&[&str]] = &[&["show"], &["data", "--json"], &["xref", "--json"], &["export", "--to", "json"]];

fn within(arguments: &[&str], path: &Path) -> Run {
    let start = Instant::now();
    let run = rungs_within(&[MEMORY, TIME], arguments, path);
    assert!(start.elapsed() < HANG, "{arguments:?} {path:?}: {:?}", start.elapsed());
    assert!(matches!(run.code, 0 | 1 | 3), "{arguments:?} {path:?}: {} {}", run.code, head(&run.err));
    run
}

fn head(text: &str) -> String {
    text.chars().take(400).collect()
}

/// An SLC text with these lines in its main program.
fn program(lines: impl IntoIterator<Item = String>) -> String {
    let mut text = "START Bul.1763    % Bul.1763     MicroLogix 1100 Series B %\n\nLADDER 2\n".to_owned();
    lines.into_iter().for_each(|line| {
        text.push_str(&line);
        text.push('\n');
    });
    text
}

fn repeated(line: &str, count: usize) -> impl Iterator<Item = String> {
    std::iter::repeat_n(line.to_owned(), count)
}

/// Runs commands on a text; gives what `asked` of them printed.
fn outputs(name: &str, text: &str, commands: &[&[&str]], asked: &[&[&str]]) -> Vec<Run> {
    let folder = folder(&format!("limits_{name}"));
    let path: PathBuf = put(&folder, &format!("{name}.SLC"), text.as_bytes());
    let mut kept = Vec::new();
    for arguments in commands.iter().filter(|arguments| arguments[0] != "verify") {
        let run = within(arguments, &path);
        if asked.contains(arguments) {
            kept.push(run);
        }
    }
    kept
}

#[test]
fn programs_whose_accesses_all_overlap() {
    let timers = (0..600).map(|n| format!("SOR XIC T4:{}/DN OTE B3:0/0 EOR", n % 300));
    let text = program(timers.chain(repeated("SOR COP #T4:0 #T9:0 128 EOR", 6_000)));
    let asked: &[&[&str]] = &[&["timers"], &["timers", "--json"], &["xref"], &["xref", "--json"]];
    const OTHERS: &[&[&str]] = &[
        &["xref", "--findings"],
        &["export", "--to", "csv", "--table", "timers"],
        &["export", "--to", "csv", "--table", "xref"],
    ];
    let runs = outputs("overlap", &text, &[asked, OTHERS].concat(), asked);
    let [timers, timers_json, xref, xref_json] = &runs[..] else { panic!("{}", runs.len()) };
    // Each of the first 128 timers is copied 6,000 times and read twice.
    assert!(timers.out.contains("more") && timers.out.contains("lists all"), "{}", head(&timers.out));
    assert!(xref.out.contains("more accesses; `rungs xref "), "{}", head(&xref.out));
    let count = |run: &Run, list: &str, address: &str, members: &[&str]| {
        let document: serde_json::Value = serde_json::from_str(&run.out).expect("a document");
        let row = document[list].as_array().expect("a list").iter().find(|row| row["address"] == address);
        let row = row.expect("the address");
        let listed: usize = members.iter().filter_map(|member| row[*member].as_array()).map(Vec::len).sum();
        let left_out = row["left_out"].as_u64().and_then(|count| usize::try_from(count).ok());
        (listed, left_out.expect("counted"))
    };
    let (listed, left_out) = count(timers_json, "timers", "T4:5", &["read_by", "reset_by", "written_by"]);
    assert_eq!(listed + left_out, 6_002);
    let (listed, left_out) = count(xref_json, "addresses", "T4:5/DN", &["accesses"]);
    assert_eq!((listed + left_out, left_out > 0), (6_002, true));
    // Asked for alone, an address has all.
    let folder = folder("limits_overlap_one");
    let path = put(&folder, "one.SLC", text.as_bytes());
    let run = judged_address(&path, "T4:5");
    let document: serde_json::Value = serde_json::from_str(&run.out).expect("a document");
    assert_eq!(document["addresses"][0]["accesses"].as_array().map(Vec::len), Some(6_002), "{}", head(&run.out));
    assert_eq!(document["addresses"][0]["left_out"], 0);
}

/// `rungs xref --json FILE ADDRESS`: the file is not the last argument here.
fn judged_address(path: &Path, address: &str) -> Run {
    let path = path.to_str().expect("a path in UTF-8");
    within(&["xref", "--json", path], Path::new(address))
}

#[test]
fn rungs_of_any_size() {
    for (name, rung) in [
        ("contacts", format!("SOR {}OTE B3/2 EOR", "XIC B3/1 ".repeat(90_000))),
        ("too_many", format!("SOR {}OTE B3/2 EOR", "TND ".repeat(700_000))),
        ("legs", format!("SOR BST {}TND BND OTE B3/2 EOR", "TND NXB ".repeat(90_000))),
        ("corner", format!("SOR BST {}{}BND OTE B3/2 EOR", "TND NXB ".repeat(9000), "TND ".repeat(9000))),
        ("nested", format!("SOR {}EOR", ("BST TND NXB ".repeat(60) + "TND " + &"BND ".repeat(60)).repeat(700))),
        ("too_deep", format!("SOR {}EOR", "BST ".repeat(100_000))),
        ("expression", format!("SOR CPT N7:0 {}1 EOR", "( 1 + ".repeat(100_000))),
        ("operands", format!("SOR ABC({} ) EOR", " N7:1".repeat(100_000))),
    ] {
        let shown = outputs(name, &program([rung]), LARGEST, &[&["show"]]);
        let (out, err) = (&shown[0].out, &shown[0].err);
        match name {
            "contacts" | "legs" => assert!(out.contains("more elements than a drawing can show"), "{}", head(out)),
            "corner" | "nested" => {}
            _ => assert!(err.contains("expected") || out.contains("UNREAD"), "{name}: {} {}", head(err), head(out)),
        }
    }
}

#[test]
fn texts_of_any_size() {
    let many = |line: &str| program(repeated(line, 3_900_000 / (line.len() + 1)));
    let mut data = program(["SOR TND EOR".to_owned()]);
    for file in 9..39 {
        // Writing to a string cannot fail.
        let _ = writeln!(data, "\nDATA N{file}:65000");
        data.push_str(&" 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16\n".repeat(3000));
    }
    let title = "% TITLE/RUNG DESCRIPTION\nTITLE: x\nRUNG DESCRIPTION: ";
    for (name, text, says) in [
        ("unreadable", many("SOR FOO 1 EOR"), "rungs"),
        ("short", many("SOR A"), "at most 65535 rungs"),
        ("empty", many("SOR EOR"), "at most 65535 rungs"),
        ("junk", many("zz"), "the project does not hold this line"),
        ("moves", program(repeated("SOR MOV #N7:1 #N9:1 MOV N[N7:1]:[N7:2] N7:[N7:3] EOR", 64_000)), "are left out"),
        ("data", data, "of this one are left out"),
        ("comment", program(["SOR TND EOR".to_owned(), format!("{title}{} %", "x\n".repeat(1_900_000))]), ""),
        ("beyond", program(repeated("SOR TND EOR", 500_000)), "an SLC text of at most"),
    ] {
        let runs = outputs(name, &text, LARGEST, &[&["show"]]);
        assert!(runs[0].err.contains(says), "{name}: {}", head(&runs[0].err));
    }
}

#[test]
fn projects_made_to_be_expensive() {
    let folder = folder("limits_projects");
    let bomb = sealed(&vec![0; 16 << 20]);
    let every: Vec<(ImageKind, StreamKind)> = [ImageKind::Main, ImageKind::Online]
        .into_iter()
        .flat_map(|image| [StreamKind::ProgramFiles, StreamKind::DataFiles].map(|kind| (image, kind)))
        .collect();
    let payload = sample().stream(ImageKind::Main, StreamKind::ProgramFiles).expect("in the sample").payload().to_vec();
    let leg = payload.windows(10).position(|window| window == b"CBranchLeg").expect("a leg") + 10;
    let class = payload.windows(5).take(leg).filter(|window| window.starts_with(b"\xFF\xFF\x80\0")).count();
    let objects = u8::try_from(2 * class).expect("few");
    let deep = [&payload[..leg], &[1, 0], &[objects - 1, 0x80, 1, 0].repeat(100_000)].concat();
    let null_objects = [&payload[..leg], &[0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x00][..], &[0; 8 << 20][..]].concat();
    for (name, content) in [
        ("bombs.RSS", with_stored(&every, &bomb)),
        ("deep.RSS", with_payload(StreamKind::ProgramFiles, &deep)),
        ("null.RSS", with_payload(StreamKind::ProgramFiles, &null_objects)),
        ("names.RSS", with_payload(StreamKind::MemDatabase, &[0xFF; 8 << 20])),
    ] {
        let path = put(&folder, name, &content);
        for arguments in READING {
            let run = within(arguments, &path);
            assert_ne!(run.code, 0, "{arguments:?} {name}");
        }
    }
}
