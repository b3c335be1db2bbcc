//! Which project a report may have been printed from.
//!
//! Reports and projects of one origin lie in one folder, but a report may be of
//! another save than the file with the same base name. The program ID is the
//! best key; the name only orders the candidates.

use std::path::{Path, PathBuf};

/// A project that may be the source of a report.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The project file.
    pub path: PathBuf,
    /// Likeness of the base names, 0 to 1.
    pub likeness: f64,
}

/// The projects in the folder of the report, the most likely name first.
///
/// `printed` is the name in the page heads ([`super::Printout::name`]): it counts as
/// much as the report's own file name, since either may have been changed.
#[must_use]
pub fn candidates(report: &Path, printed: &str, projects: &[PathBuf]) -> Vec<Candidate> {
    let names = [base(report), pairs(printed.trim_end_matches(".RSS"))];
    let mut found: Vec<Candidate> = projects
        .iter()
        .filter(|p| p.parent() == report.parent())
        .map(|path| {
            let own = base(path);
            let likeness = names.iter().map(|n| likeness(n, &own)).fold(0.0, f64::max);
            Candidate { path: path.clone(), likeness }
        })
        .collect();
    found.sort_by(|a, b| b.likeness.total_cmp(&a.likeness).then_with(|| a.path.cmp(&b.path)));
    found
}

/// Letter pairs of a file's base name.
fn base(path: &Path) -> Vec<[char; 2]> {
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    pairs(name.split('.').next().unwrap_or_default())
}

fn pairs(name: &str) -> Vec<[char; 2]> {
    let letters: Vec<char> = name.to_lowercase().chars().filter(|c| c.is_alphanumeric()).collect();
    letters.array_windows().copied().collect()
}

/// Dice coefficient over letter pairs: twice the shared pairs over all pairs.
fn likeness(a: &[[char; 2]], b: &[[char; 2]]) -> f64 {
    let mut left = b.to_vec();
    let mut shared = 0_u32;
    for pair in a {
        if let Some(at) = left.iter().position(|p| p == pair) {
            left.swap_remove(at);
            shared += 1;
        }
    }
    let all = u32::try_from(a.len() + b.len()).unwrap_or(u32::MAX);
    if all == 0 { 0.0 } else { f64::from(2 * shared) / f64::from(all) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closest_name_of_the_folder_comes_first() {
        let projects = ["a/motor.RSS", "a/lamp_two_timers.RSS", "b/lamp_timer.RSS", "a/lamp_timer.RSS"];
        let projects: Vec<PathBuf> = projects.iter().map(PathBuf::from).collect();
        let found = candidates(Path::new("a/lamp_timer_live.pdf.txt"), "LAMP_TIMER_LIVE.RSS", &projects);
        let names: Vec<_> = found.iter().map(|c| c.path.to_string_lossy().into_owned()).collect();
        assert_eq!(names, ["a/lamp_timer.RSS", "a/lamp_two_timers.RSS", "a/motor.RSS"]);
    }
}
