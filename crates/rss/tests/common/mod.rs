//! Where the real projects are, for this crate's tests over them.

use std::path::PathBuf;

#[path = "../../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod place;

/// Every `.RSS` file below `RUNGS_CORPUS`, else below `../shared/corpus` beside
/// the workspace, in the order of their paths. Without such a folder it prints
/// a plain line and gives `None`.
pub(crate) fn corpus() -> Option<Vec<PathBuf>> {
    let root = place::root()?;
    Some(place::files(&root, ".rss").expect("the corpus can be listed"))
}
