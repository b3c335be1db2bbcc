//! Where the real projects and their printouts are, if they are there at all.
//!
//! Tests of other packages take this file in by its path, so that the place is told once.

use std::path::{Path, PathBuf};

/// Environment variable naming the corpus folder.
pub const VARIABLE: &str = "RUNGS_CORPUS";

/// The corpus folder: `RUNGS_CORPUS`, else `../shared/corpus` beside the workspace.
///
/// Prints one plain line and gives `None` when there is no such folder, so a
/// test can return early without looking like a pass of something it did not do.
#[must_use]
pub fn root() -> Option<PathBuf> {
    let named = std::env::var_os(VARIABLE).map(PathBuf::from);
    // Packages lie at different depths; the lock file is where the workspace begins.
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    let workspace = manifest.ancestors().find(|folder| folder.join("Cargo.lock").is_file()).unwrap_or(manifest);
    let path = named.unwrap_or_else(|| workspace.join("..").join("shared").join("corpus"));
    if path.is_dir() {
        return Some(path);
    }
    println!("skipped: corpus not present");
    None
}

/// All files below the corpus folder whose name ends with `ending` (ASCII case
/// ignored), sorted by path.
///
/// # Errors
/// The message of the first folder that cannot be listed.
pub fn files(root: &Path, ending: &str) -> Result<Vec<PathBuf>, String> {
    let mut found = Vec::new();
    let mut open = vec![root.to_path_buf()];
    while let Some(folder) = open.pop() {
        let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        for entry in entries {
            let path = entry.map_err(|e| format!("{}: {e}", folder.display()))?.path();
            if path.is_dir() {
                open.push(path);
            } else if ends_with(&path, ending) {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

/// The path below the corpus folder with `/` between its parts: how tests name a file.
#[must_use]
pub fn name(root: &Path, path: &Path) -> String {
    let below = path.strip_prefix(root).unwrap_or(path);
    let parts: Vec<_> = below.iter().map(|p| p.to_string_lossy()).collect();
    parts.join("/")
}

fn ends_with(path: &Path, ending: &str) -> bool {
    let name = path.file_name().map(|n| n.to_string_lossy().to_ascii_lowercase());
    name.is_some_and(|n| n.ends_with(&ending.to_ascii_lowercase()))
}
