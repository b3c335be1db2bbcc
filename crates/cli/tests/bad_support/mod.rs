//! A project of our own to damage, and the command run on what comes of it.

// Not every test file needs all of it.
#![allow(dead_code)]

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use rss::{Container, ImageKind, Project, StreamKind, envelope};

/// Every command that reads a project, with what it needs beside the file.
pub(crate) const COMMANDS: &[&[&str]] = &[
    &["info"],
    &["show"],
    &["data"],
    &["timers"],
    &["xref"],
    &["xref", "--findings"],
    &["verify"],
    &["history"],
    &["export", "--to", "json"],
    &["export", "--to", "slc"],
    &["export", "--to", "csv"],
];

const TEXT: &str = "\
START Bul.1763    % Bul.1763     MicroLogix 1100 Series B %

PROJECT \"DAMAGED\"
  2  \"MAIN\"
  3  \"PUMPS\"

LADDER 2
% Rung: 0 %
SOR BST XIC I:0.0/0 NXB XIC O:0.0/0 BND XIO I:0.0/1 BST OTE O:0.0/0 NXB TON T4:0 1.0 30 0 BND EOR
% TITLE/RUNG DESCRIPTION
TITLE: Motor
RUNG DESCRIPTION: Start, stop and seal-in %
% Rung: 1 %
SOR XIC T4:0/DN JSR 3 EOR

LADDER 3
% Rung: 0 %
SOR GRT N7:0 100 CTU C5:0 10 0 EOR
% Rung: 1 %
SOR COP #N7:0 #N7:10 5 MOV N7:[N7:1] N7:2 EOR

DATA N7:0
% N7:0 % 1 2 3 4 5 6 7 8 9 10
% N7:10 % 11 12 13 14 15 16 17 18 19 20
";

/// The project to damage.
pub(crate) fn sample() -> Project {
    let project = convert::slc::project::read(TEXT).expect("our own text");
    convert::to_rss::project_file(&project).expect("a project").file
}

/// The same as a file.
pub(crate) fn sample_file() -> Vec<u8> {
    sample().write().expect("a file")
}

/// The sample with another payload in one stream.
pub(crate) fn with_payload(kind: StreamKind, payload: &[u8]) -> Vec<u8> {
    let mut project = sample();
    project.set_payload(ImageKind::Main, kind, payload).expect("any payload can be stored");
    project.write().expect("a file")
}

/// The sample with these streams holding `stored`, envelope included.
pub(crate) fn with_stored(streams: &[(ImageKind, StreamKind)], stored: &[u8]) -> Vec<u8> {
    let mut container = Container::read(&sample_file()).expect("our own file");
    for (image, kind) in streams {
        container.set_stream(&kind.path(*image), stored.to_vec());
    }
    container.write().expect("a file")
}

/// A payload as streams store it.
pub(crate) fn sealed(payload: &[u8]) -> Vec<u8> {
    envelope::seal(payload, envelope::Storage::ZLIB).expect("fits")
}

/// An empty folder of its own for each test.
pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// Writes a file and gives its path.
pub(crate) fn put(folder: &Path, name: &str, content: &[u8]) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, content).expect("written");
    path
}

/// What a run of the command came to.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) code: i32,
    pub(crate) out: String,
    pub(crate) err: String,
}

/// Runs a command on a file (or folder) behind its arguments. A panic or a signal fails the test.
pub(crate) fn rungs(arguments: &[&str], path: &Path) -> Run {
    judged(Command::new(env!("CARGO_BIN_EXE_rungs")).args(arguments).arg(path))
}

/// The same with less to live on: `limits` are options of the shell's `ulimit`, one each.
pub(crate) fn rungs_within(limits: &[&str], arguments: &[&str], path: &Path) -> Run {
    let limits: Vec<String> = limits.iter().map(|limit| format!("ulimit {limit} || exit 99; ")).collect();
    let script = format!("{}exec \"$0\" \"$@\"", limits.concat());
    let own: [&OsStr; 3] = ["-c".as_ref(), script.as_ref(), env!("CARGO_BIN_EXE_rungs").as_ref()];
    judged(Command::new("sh").args(own).args(arguments).arg(path))
}

fn judged(command: &mut Command) -> Run {
    let Output { status, stdout, stderr } = command.output().expect("the command starts");
    let (out, err) = (String::from_utf8_lossy(&stdout).into_owned(), String::from_utf8_lossy(&stderr).into_owned());
    let Some(code) = status.code() else { panic!("{command:?}: {status}\n{err}") };
    assert!(matches!(code, 0..=3), "{command:?}: {status}\n{err}");
    assert!(!err.contains("panicked") && !err.contains("RUST_BACKTRACE"), "{command:?}\n{err}");
    Run { code, out, err }
}

/// All files below a folder with their content, to see that a command wrote none.
pub(crate) fn listing(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder).expect("the folder") {
        let path = entry.expect("the folder").path();
        match path.is_dir() {
            true => all.extend(listing(&path)),
            false => all.push((path.clone(), std::fs::read(&path).expect("the file"))),
        }
    }
    all.sort();
    all
}
