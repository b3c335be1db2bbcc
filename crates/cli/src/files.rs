//! Which files to work on: several paths, folders, and paths mixed with addresses.

use std::io::{IsTerminal, Read};
use std::path::{Path, PathBuf};

use indicatif::{ProgressBar, ProgressStyle};

/// Ending of projects picked up from folders, texts of Do-more Designer (`.txt`, by their content) besides. SLC text
/// mostly lies beside the project it belongs to, which must not be listed twice: name it to read it.
pub const PROJECTS: &str = "rss";

/// Ending of texts that Designer exports; other texts have it too.
const DESIGNER: &str = "txt";

/// Bytes of a text that tell whose it is.
const HEAD: u64 = 16 << 10;

/// Ending of scenarios.
pub const SCENARIOS: &str = "toml";

/// Files in the order given, folders replaced by the files with this ending below them in order of
/// name. A file named on the command line is taken whatever its ending: its content decides.
///
/// # Errors
/// A folder that cannot be listed, or no file at all. A folder without such a file among others is
/// reported, and the rest goes on.
pub fn expand(paths: &[PathBuf], ending: &str) -> Result<Vec<PathBuf>, String> {
    let mut files = Vec::new();
    let mut empty = Vec::new();
    for path in paths {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let before = files.len();
        collect(path, ending, &mut files, 0)?;
        if files.len() == before {
            empty.push(format!("{}: no .{} file in this folder", path.display(), ending.to_uppercase()));
        }
    }
    if files.is_empty() {
        return Err(empty.join("\n"));
    }
    empty.iter().for_each(|folder| eprintln!("{folder}"));
    Ok(files)
}

/// Links to folders are not followed, so the walk ends; the bound is for absurd nesting.
const MAX_DEPTH: usize = 64;

fn collect(folder: &Path, ending: &str, files: &mut Vec<PathBuf>, depth: usize) -> Result<(), String> {
    let list = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut entries: Vec<_> = list.filter_map(Result::ok).collect();
    entries.sort_by_key(std::fs::DirEntry::file_name);
    for entry in entries {
        let path = entry.path();
        let Ok(kind) = entry.file_type() else { continue };
        if kind.is_dir() && depth < MAX_DEPTH {
            collect(&path, ending, files, depth + 1)?;
        } else if path.is_file() && (has_ending(&path, ending) || (ending == PROJECTS && is_designer(&path))) {
            files.push(path);
        }
    }
    Ok(())
}

fn has_ending(path: &Path, wanted: &str) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(wanted))
}

/// A text for Do-more Designer.
fn is_designer(path: &Path) -> bool {
    let mut head = Vec::new();
    has_ending(path, DESIGNER)
        && std::fs::File::open(path).is_ok_and(|file| file.take(HEAD).read_to_end(&mut head).is_ok())
        && convert::designer::is_designer(&head)
}

/// Splits `FILE [ADDRESS ..]`: the first word is a file, later ones are if such a path exists.
pub fn split(words: &[String]) -> (Vec<PathBuf>, Vec<String>) {
    let mut files = Vec::new();
    let mut addresses = Vec::new();
    for word in words {
        if files.is_empty() || Path::new(word).exists() {
            files.push(PathBuf::from(word));
        } else {
            addresses.push(word.clone());
        }
    }
    (files, addresses)
}

/// Both paths lead to one file that is there.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// A bar for work over many files: on a terminal only, and not when results are printed there too.
pub fn progress(files: usize, results_on_terminal: bool) -> ProgressBar {
    if files < 2 || results_on_terminal || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(u64::try_from(files).unwrap_or(u64::MAX));
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {wide_msg}") {
        bar.set_style(style);
    }
    bar
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_word_is_a_file_and_addresses_follow() {
        let words = ["missing.RSS", "N7:0", "START_PB"].map(str::to_owned);
        let (files, addresses) = split(&words);
        assert_eq!(files, [PathBuf::from("missing.RSS")]);
        assert_eq!(addresses, ["N7:0", "START_PB"]);
    }
}
