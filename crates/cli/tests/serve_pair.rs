//! `rungs serve A B`: what it opens, and what it refuses with a reason.

mod support;

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use support::among_examples::examples;
use support::served::Server;

fn rungs(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rungs")).args(arguments).output().expect("the command starts")
}

/// The motor example and its migration in a folder of their own.
fn migrated(name: &str) -> (PathBuf, PathBuf) {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("serve-pair-{name}"));
    let original = examples().join("motor/motor.RSS");
    let texts = [&original, &out].map(|path| path.to_string_lossy().into_owned());
    let done = rungs(&["migrate", &texts[0], "--to", "domore", "--out", &texts[1], "--overwrite"]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    (original, out)
}

fn get(server: &Server, path: &str) -> String {
    let mut stream = TcpStream::connect(server.at).expect("listens");
    let request = format!("GET {path} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", server.at);
    stream.write_all(request.as_bytes()).expect("takes it");
    let mut answer = String::new();
    stream.read_to_string(&mut answer).expect("text");
    answer
}

#[test]
fn a_migration_is_served_beside_its_original() {
    let (original, out) = migrated("served");
    let [text, map] = ["motor.txt", "address-map.csv"].map(|name| out.join(name).to_string_lossy().into_owned());
    let server = Server::start(&original, &[&text, "--map", &map]);
    let pair = get(&server, "/api/pair");
    assert!(pair.contains("\"original\":\"motor.RSS\",\"other\":\"motor.txt\""), "{pair}");
    assert!(get(&server, "/api/other/project").contains("\"dialect\":\"do-more\""));
}

#[test]
fn two_versions_need_no_map() {
    let (original, _) = migrated("versions");
    let server = Server::start(&original, &[&examples().join("motor/motor.SLC").to_string_lossy()]);
    let pair = get(&server, "/api/pair");
    assert!(pair.contains("[2,0,2,0],[2,1,2,1]") && pair.contains("\"unmapped\":[]"), "{pair}");
}

/// A counterexample that `rungs prove` wrote, of either side, is the tape.
#[test]
fn a_counterexample_is_replayed() {
    let (original, out) = migrated("replayed");
    let path = |name: &str| out.join(name).to_string_lossy().into_owned();
    let text = std::fs::read_to_string(path("motor.txt")).expect("text");
    let changed = text.replacen("OR\tC0", "ORN\tC0", 1);
    assert_ne!(changed, text);
    std::fs::write(path("changed.txt"), changed).expect("writes");
    let (first, map) = (original.to_string_lossy(), path("address-map.csv"));
    let proof = rungs(&["prove", &first, &path("changed.txt"), "--map", &map, "--out", &path("proof")]);
    assert_eq!(proof.status.code(), Some(1), "different");
    for side in ["original", "converted"] {
        let tape = path(&format!("proof/{side}.toml"));
        let server = Server::start(&original, &[&path("changed.txt"), "--map", &map, "--replay", &tape]);
        let state = get(&server, "/api/state");
        let named =
            "\"tape\":{\"name\":\"O:0.0/1 is 0 in the original, Y1 is 1 in the other program\",\"at\":0,\"scans\":2}";
        assert!(state.contains(named), "{side}: {state}");
    }
}

#[test]
fn what_cannot_be_served_together_is_told() {
    let (original, out) = migrated("refused");
    let path = |name: &str| out.join(name).to_string_lossy().into_owned();
    let (first, text, map) = (original.to_string_lossy().into_owned(), path("motor.txt"), path("address-map.csv"));
    std::fs::write(path("bad-map.csv"), "slc,last,words,domore,name,description\nN7:0,,1,Q0,,\n").expect("writes");
    std::fs::write(
        path("bad.toml"),
        "program = \"x\"\nscan = \"10ms\"\n[[step]]\nset = { \"N99:0\" = 1 }\nscans = 1\n",
    )
    .expect("writes");
    let cases: &[(&[&str], i32, &str)] = &[
        (&[&first, &text], 2, "--map is needed"),
        (&[&first, "--map", &map], 2, "<OTHER>"),
        (&[&first, &out.to_string_lossy(), "--map", &map], 2, "is a folder"),
        (&[&text, &first, "--map", &map], 2, "the original must be an SLC 500"),
        (&[&first, &path("nothing.txt"), "--map", &map], 3, "nothing.txt"),
        (&[&first, &text, "--map", &path("nothing.csv")], 3, "nothing.csv"),
        (&[&first, &text, "--map", &path("bad-map.csv")], 2, "row 1"),
        (&[&first, &text, "--map", &map, "--replay", &path("bad.toml")], 2, "line 4: N99:0"),
        (&[&first, &text, "--map", &map, "--replay", &path("nothing.toml")], 2, "nothing.toml"),
    ];
    for (arguments, code, why) in cases {
        let done = rungs(&[&["serve", "--port", "0"], *arguments].concat());
        let told = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(*code), "{arguments:?}: {told}");
        assert!(told.contains(why), "{arguments:?}: {told}");
    }
}
