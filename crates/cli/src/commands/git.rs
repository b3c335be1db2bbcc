//! The git executable: started without the settings and hooks of whoever runs us.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Variables that would make git work on another repository than the one meant.
const REDIRECTING: [&str; 8] = [
    "GIT_DIR",
    "GIT_WORK_TREE",
    "GIT_INDEX_FILE",
    "GIT_OBJECT_DIRECTORY",
    "GIT_ALTERNATE_OBJECT_DIRECTORIES",
    "GIT_COMMON_DIR",
    "GIT_NAMESPACE",
    "GIT_PREFIX",
];

/// A git command in this folder.
pub fn git(folder: &Path) -> Command {
    let mut command = Command::new("git");
    command.arg("-C").arg(folder);
    for name in REDIRECTING {
        command.env_remove(name);
    }
    command
}

/// Runs a command, with `input` on its standard input if there is one.
///
/// # Errors
/// What git says, or that there is no git.
pub fn run(mut command: Command, input: Option<&[u8]>) -> Result<Vec<u8>, String> {
    let no_git = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => "git was not found: install it, or put it into PATH".to_owned(),
        _ => format!("git does not start: {error}"),
    };
    command.stdin(if input.is_some() { Stdio::piped() } else { Stdio::null() });
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(no_git)?;
    let written = match (child.stdin.take(), input) {
        (Some(mut stdin), Some(input)) => stdin.write_all(input),
        _ => Ok(()),
    };
    let Output { status, stdout, stderr } = child.wait_with_output().map_err(no_git)?;
    if !status.success() {
        return Err(format!("git: {}", String::from_utf8_lossy(&stderr).trim()));
    }
    written.map_err(|error| format!("git: {error}"))?;
    Ok(stdout)
}
