//! Where the real projects are, for this crate's tests over them.

use std::path::{Path, PathBuf};

/// Every `.RSS` file below `RUNGS_CORPUS`, else below `../shared/corpus` beside
/// the workspace, in the order of their paths. Without such a folder it prints
/// a plain line and gives `None`.
pub(crate) fn corpus() -> Option<Vec<PathBuf>> {
    let root = std::env::var_os("RUNGS_CORPUS")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/corpus"), PathBuf::from);
    if !root.is_dir() {
        println!("skipped: corpus not present");
        return None;
    }
    let mut files = Vec::new();
    let mut open = vec![root];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).expect("the corpus can be listed") {
            let path = entry.expect("the corpus can be listed").path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("rss")) {
                files.push(path);
            }
        }
    }
    files.sort();
    Some(files)
}
