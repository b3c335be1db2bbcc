//! Where the corpus is, for tests that read it.

use std::path::{Path, PathBuf};

/// The corpus folder, or `None` with a line that says so.
pub(crate) fn corpus() -> Option<PathBuf> {
    let folder = std::env::var_os("RUNGS_CORPUS")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/corpus"), PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: corpus not present");
    None
}
