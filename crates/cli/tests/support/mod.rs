//! Starting the command as a user does.
#![allow(dead_code)] // every test file uses its own part

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder of the workspace.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Runs `rungs` in a folder.
pub(crate) fn rungs_in(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rungs"))
        .current_dir(folder)
        .args(arguments)
        .env_remove("NO_COLOR")
        .output()
        .expect("the command starts")
}

/// The examples, and `rungs` run among them.
pub(crate) mod among_examples {
    use super::{Output, PathBuf, root, rungs_in};

    pub(crate) fn examples() -> PathBuf {
        root().join("examples")
    }

    pub(crate) fn rungs(arguments: &[&str]) -> Output {
        rungs_in(&examples(), arguments)
    }

    /// What it says on success.
    pub(crate) fn text(arguments: &[&str]) -> String {
        let output = rungs(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("text")
    }
}

/// `rungs` run in the folder of the workspace.
pub(crate) mod at_root {
    use super::{Output, root, rungs_in};

    pub(crate) fn rungs(arguments: &[&str]) -> Output {
        rungs_in(&root(), arguments)
    }

    pub(crate) fn text(bytes: &[u8]) -> String {
        String::from_utf8(bytes.to_vec()).expect("text")
    }
}
