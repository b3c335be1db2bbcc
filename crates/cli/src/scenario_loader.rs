//! Where scenarios get their programs: files beside them, ladder text inside them.

use std::path::PathBuf;

use convert::slc::rung::parse_rungs;
use ladder::{Family, Image, Rung, Severity};
use sim::scenario::Loader;

use crate::commands::open;

/// Loads for scenarios of one folder.
pub struct FolderLoader {
    /// Folder that relative paths start from.
    pub folder: PathBuf,
}

impl Loader for FolderLoader {
    fn program(&self, path: &str) -> Result<Image, String> {
        // A scenario written on Windows means the same file.
        let project = open(&self.folder.join(path.replace('\\', "/")), rss::Mode::Permissive)?;
        match project.diagnostics.iter().find(|diagnostic| diagnostic.severity == Severity::Error) {
            // A test on half a program would prove nothing.
            Some(worst) => Err(format!("not all of it could be read: {}: {}", worst.place, worst.message)),
            None => Ok(project.main),
        }
    }

    fn rungs(&self, text: &str, family: Family) -> Result<Vec<Rung>, Vec<(u32, String)>> {
        let family = (family != Family::Unknown).then_some(family);
        parse_rungs(text, family)
            .map_err(|errors| errors.into_iter().map(|error| (error.line, error.to_string())).collect())
    }
}
