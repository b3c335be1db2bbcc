//! The schema-driven tester of the interface of `rungs serve`, in an environment of its own below the target folder.

use std::path::Path;
use std::process::Command;

use crate::{Outcome, run, target_directory};

/// One version, so that the same seed makes the same requests. What it depends on may move.
const TESTER: &str = "schemathesis==4.32.5";

/// Set to 1, tests that need it say that they are skipped.
pub(crate) const WITHOUT: &str = "RUNGS_NO_API_TESTER";

/// Where the tests look for it.
fn environment() -> std::path::PathBuf {
    target_directory().join("schemathesis")
}

fn program(name: &str) -> std::path::PathBuf {
    let folder = if cfg!(windows) { "Scripts" } else { "bin" };
    environment().join(folder).join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
}

fn stamp() -> std::path::PathBuf {
    environment().join("rungs-version")
}

/// Whether it is installed.
pub(crate) fn is_there() -> bool {
    std::fs::read_to_string(stamp()).is_ok_and(|version| version == TESTER)
}

/// Installs it where it is missing. Without Python or packages this says what is missing and is no failure: `cargo
/// xtask test` leaves the tests out then and says so, `cargo test` by itself fails.
pub(crate) fn setup() -> Outcome {
    if is_there() || crate::is_left_out(WITHOUT) {
        return Ok(());
    }
    let stamp = stamp();
    println!("installing {TESTER} into {}", environment().display());
    match install() {
        Ok(()) => std::fs::write(&stamp, TESTER).map_err(|why| format!("{}: {why}", stamp.display())),
        Err(why) => {
            println!("{why}");
            println!("tests of the interface need python3 with venv, and {TESTER} from its package index;");
            println!("install them, or set {WITHOUT}=1");
            Ok(())
        }
    }
}

fn install() -> Outcome {
    let python = if cfg!(windows) { "python" } else { "python3" };
    venv(python).or_else(|_| {
        // Debian keeps venv in a package of its own.
        crate::apt(&["install", "-qy", "--no-install-recommends", "python3", "python3-venv"])?;
        venv(python)
    })?;
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", TESTER];
    run(Command::new(program("python")).args(pip))
}

fn venv(python: &str) -> Outcome {
    let environment = environment();
    let at: &Path = &environment;
    run(Command::new(python).args(["-m", "venv", "--clear"]).arg(at))
}
