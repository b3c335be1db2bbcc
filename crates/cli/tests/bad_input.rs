//! Files that are something else, or damaged: named or located, exit code 3, nothing written.

mod bad_support;

use bad_support::*;
use rss::{Container, ImageKind, StreamKind};

/// A Logix 5000 project database as far as it is recognized: its table of members at the end.
fn acd() -> Vec<u8> {
    let mut bytes = b"some header".to_vec();
    let start = bytes.len();
    bytes.extend("Comps.Dat".encode_utf16().flat_map(u16::to_le_bytes));
    bytes.resize(start + 520, 0);
    bytes.extend_from_slice(&[4, 0, 0, 0, 2, 0, 0, 0]);
    bytes.extend_from_slice(&[1, 0, 0, 0, 9, 9, 9, 9]);
    bytes
}

fn compound(streams: &[(&str, &[u8])]) -> Vec<u8> {
    let mut container = Container::default();
    for (path, content) in streams {
        container.set_stream(path, content.to_vec());
    }
    container.write().expect("a file")
}

#[test]
fn a_file_is_called_what_it_is() {
    let folder = folder("foreign");
    let l5x = b"\xEF\xBB\xBF<?xml version=\"1.0\"?>\r\n<RSLogix5000Content SchemaRevision=\"1.0\">".to_vec();
    let plc5 = compound(&[("PROGRAM FILES/ObjectData", b"x"), ("\u{5}SummaryInformation", b"..RSLogix 5\0")]);
    let cases: [(&str, Vec<u8>, &str); 15] = [
        ("empty.RSS", Vec::new(), "an empty file"),
        ("zeros.RSS", vec![0; 5000], "a file of zero bytes only"),
        ("report.RSS", b"%PDF-1.5\n1 0 obj".to_vec(), "this is a PDF document"),
        ("saved.RSS", compound(&[]), "a compound file without RSLogix streams"),
        ("letter.RSS", compound(&[("WordDocument", b"Dear")]), "a compound file without RSLogix streams"),
        ("plc5.RSP", plc5, "an RSLogix 5 (PLC-5) project"),
        ("backup.RSS", b"PK\x03\x04\x14\0\0\0".to_vec(), "a zip archive"),
        ("backup.gz", b"\x1F\x8B\x08\0".to_vec(), "a compressed archive"),
        ("line.ACD", acd(), "a Logix 5000 project database (.ACD)"),
        ("line.L5X", l5x, "a Logix 5000 export in XML (.L5X)"),
        ("line.L5K", b"IE_VER := 2.8;\nCONTROLLER c (".to_vec(), "a Logix 5000 export as text (.L5K)"),
        ("page.RSS", b"<html><body>not found</body></html>".to_vec(), "an XML document"),
        ("notes.RSS", b"Remember to save the program.\r\n".repeat(50), "a text file"),
        ("old.ACH", b"\x02\x81\x90\xFF\x01\x00".repeat(40), "an .ACH archive of the DOS editors"),
        ("picture.RSS", b"\x89PNG\r\n\x1A\n\0\0\0\rIHDR".to_vec(), "of no kind known here"),
    ];
    for (name, content, what) in &cases {
        let path = put(&folder, name, content);
        let before = listing(&folder);
        for command in COMMANDS {
            let run = rungs(command, &path);
            assert_eq!((run.code, run.out.as_str()), (3, ""), "{command:?} {name}: {}", run.err);
            assert!(run.err.contains(name) && run.err.contains(what), "{command:?} {name}: {}", run.err);
        }
        assert!(listing(&folder) == before, "{name}: something was written");
    }
}

#[test]
fn slc_text_is_read_by_its_content_and_is_no_project_file() {
    let folder = folder("slc");
    let path = put(&folder, "text.RSS", b"START Bul.1763 % Bul.1763 %\nLADDER 2\nSOR XIC B3:0/0 OTE B3:0/1 EOR\n");
    let run = rungs(&["show"], &path);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("B3:0"), "{}", run.out);
    let run = rungs(&["verify"], &path);
    assert_eq!((run.code, run.out.as_str()), (3, ""));
    assert!(run.err.contains("a project in SLC text form (.SLC)"), "{}", run.err);
}

/// What must be said of damage: an error with its place, or results with the deviations beside them.
fn speaks(run: &Run, what: &str) {
    let place = |text: &str| text.contains("offset 0x");
    match run.code {
        3 => assert!(place(&run.err) || place(&run.out) || run.err.contains("this is "), "{what}: {run:?}"),
        _ => {
            let said = ["error: ", "warning: "].iter().any(|word| run.err.contains(word));
            assert!(said || run.out.contains("deviation: "), "{what}: {run:?}");
        }
    }
}

#[test]
fn a_file_cut_short_is_reported_with_the_place() {
    let folder = folder("cut");
    let sound = sample_file();
    for at in (0..sound.len()).step_by(1024) {
        let path = put(&folder, "cut.RSS", &sound[..at]);
        let run = rungs(&["verify"], &path);
        assert_eq!(run.code, 3, "cut at {at}: {run:?}");
        speaks(&run, &format!("cut at {at}"));
        speaks(&rungs(&["info"], &path), &format!("cut at {at}"));
    }
    assert_eq!(listing(&folder).len(), 1);
}

#[test]
fn damage_in_a_stream_is_reported_with_the_place() {
    let folder = folder("damage");
    let sound = sample();
    let payload = |kind| sound.stream(ImageKind::Main, kind).expect("in the sample").payload().to_vec();
    let program = payload(StreamKind::ProgramFiles);
    // The place of the first object's count of members: behind tag, schema, length and class name.
    let after_root = 2 + 2 + 2 + "CProgHolder".len();
    let changed = |at: usize, bytes: &[u8]| {
        let mut changed = program.clone();
        changed[at..at + bytes.len()].copy_from_slice(bytes);
        changed
    };
    let deep = {
        let leg = program.windows(10).position(|w| w == b"CBranchLeg").expect("a leg") + 10;
        // Instead of its members, legs in legs; their class is the last one so far.
        let class = program.windows(5).take(leg).filter(|w| w.starts_with(b"\xFF\xFF\x80\0")).count();
        let objects = u8::try_from(2 * class).expect("few");
        [&program[..leg], &[1, 0], &[objects - 1, 0x80, 1, 0].repeat(100_000)].concat()
    };
    let cases: [(&str, StreamKind, Vec<u8>); 6] = [
        ("half a program", StreamKind::ProgramFiles, program[..program.len() / 2].to_vec()),
        ("a count at its maximum", StreamKind::ProgramFiles, changed(after_root, &[0xFE, 0xFF])),
        ("a class never named", StreamKind::ProgramFiles, changed(0, &[0xFF, 0x8F])),
        ("a root of another class", StreamKind::ProgramFiles, payload(StreamKind::DataFiles)),
        ("objects 100,000 deep", StreamKind::ProgramFiles, deep),
        ("bytes behind the end", StreamKind::ProgramFiles, [&program[..], b"more"].concat()),
    ];
    for (what, kind, payload) in cases {
        let path = put(&folder, "damaged.RSS", &with_payload(kind, &payload));
        for command in COMMANDS {
            speaks(&rungs(command, &path), &format!("{command:?}: {what}"));
        }
        let run = rungs(&["verify", "--json"], &path);
        assert_ne!(run.code, 0, "{what}");
        let line: serde_json::Value = serde_json::from_str(run.out.trim()).expect("one document");
        let streams = line["streams"].as_array().expect("streams");
        let (stream, others): (Vec<_>, Vec<_>) =
            streams.iter().partition(|stream| stream["stream"] == kind.path(ImageKind::Main));
        assert_eq!(stream.len(), 1, "{what}");
        assert!(others.iter().all(|stream| stream["identical"] == true), "{what}: {line}");
        let strict = rungs(&["info", "--strict"], &path);
        assert_eq!((strict.code, strict.out.as_str()), (3, ""), "{what}");
    }
}

#[test]
fn the_others_of_a_folder_are_worked_through() {
    let folder = folder("mixed");
    let sound = sample_file();
    put(&folder, "a.RSS", &sound);
    put(&folder, "b.RSS", b"%PDF-1.5");
    put(&folder, "c.RSS", &sound[..sound.len() / 2]);
    put(&folder, "d.rss", &sound);
    for command in COMMANDS {
        let run = rungs(command, &folder);
        assert_eq!(run.code, 3, "{command:?}: {}", run.err);
        assert!(run.err.contains("b.RSS: this is a PDF document"), "{command:?}: {}", run.err);
        assert!(run.err.contains("c.RSS") || run.out.contains("c.RSS"), "{command:?}: {}", run.err);
    }
    let run = rungs(&["verify", "--json"], &folder);
    let lines: Vec<serde_json::Value> =
        run.out.lines().map(|line| serde_json::from_str(line).expect("a document a line")).collect();
    let file = |index: usize| lines[index]["file"].as_str().unwrap_or("").to_owned();
    assert_eq!(lines.len(), 4, "{}", run.out);
    assert!(["a.RSS", "b.RSS", "c.RSS", "d.rss"].iter().enumerate().all(|(i, name)| file(i).ends_with(name)));
    assert_eq!(lines[1]["error"], "this is a PDF document");
    assert_eq!((&lines[0]["roundtrip"], &lines[3]["roundtrip"]), (&true.into(), &true.into()));
}

#[test]
fn nothing_is_written_from_what_cannot_be_read() {
    let folder = folder("write");
    let text = |name: &str, content: &[u8]| put(&folder, name, content);
    let inputs = [
        text("pdf.SLC", b"%PDF-1.5"),
        text("empty.SLC", b""),
        text("notes.SLC", b"Remember to save the program.\n"),
        text("rung.SLC", b"START Bul.1763 % Bul.1763 %\nLADDER 2\nSOR BST XIC B3:0/0 EOR\n"),
        text("open.json", b"{\"schema\": \"rungs.project/1\", \"main"),
        text("more.json", b"{\"schema\": \"rungs.project/9\"}"),
        text("cut.RSS", &sample_file()[..3000]),
    ];
    let before = listing(&folder);
    let out = folder.join("out.RSS").display().to_string();
    for input in &inputs {
        for arguments in [&["build", "-o", &out][..], &["export", "--to", "slc", "-o", &out]] {
            // An SLC text with an unreadable rung can be exported: the rung is kept as text.
            if arguments[0] == "build" || !input.ends_with("rung.SLC") {
                let run = rungs(arguments, input);
                assert_eq!((run.code, run.out.as_str()), (3, ""), "{arguments:?} {input:?}: {}", run.err);
                assert!(!run.err.is_empty());
            }
        }
        assert!(listing(&folder) == before, "{input:?}");
    }
}
