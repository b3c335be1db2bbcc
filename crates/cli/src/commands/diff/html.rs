//! `rungs diff --html`: a page of the difference, or a folder of pages with a list.

use std::cell::{Cell, RefCell};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use analysis::diff::Difference;
use report::diff::{Comparison, Entry, Shown};

use super::folders::Paired;
use super::{Both, Sections};
use crate::files::is_same_file;
use crate::output::{Error, printable};

/// Characters of a page's name that come from the name of a file.
const MOST_NAME: usize = 60;

/// The list of pages.
const INDEX: &str = "index.html";

fn exists(path: &Path) -> Error {
    Error::Use(printable(&format!("{} exists; --force overwrites it", path.display())))
}

/// Where pages go.
pub(super) struct Pages {
    target: PathBuf,
    /// Two folders are compared: the target is a folder too.
    folder: bool,
    entries: RefCell<Vec<Entry>>,
    /// Pages that exist are overwritten.
    force: bool,
    /// A page was written.
    any: Cell<bool>,
}

fn failed(path: &Path, error: &std::io::Error) -> Error {
    Error::Use(printable(&format!("{}: {error}", path.display())))
}

fn tool() -> String {
    format!("rungs {}", env!("CARGO_PKG_VERSION"))
}

impl Pages {
    /// Prepares the target: a file for two files, a folder for two folders.
    ///
    /// # Errors
    /// A target that is one of the compared files, of the wrong sort, or there without `force`.
    pub(super) fn new(target: &Path, compared: &[&Path], folder: bool, force: bool) -> Result<Pages, Error> {
        if let Some(path) = compared.iter().find(|path| is_same_file(path, target)) {
            return Err(Error::Use(printable(&format!("{}: is compared, and cannot be the page too", path.display()))));
        }
        let is_page =
            target.extension().is_some_and(|it| it.eq_ignore_ascii_case("html") || it.eq_ignore_ascii_case("htm"));
        if target.is_file() && !is_page {
            // With or without --force: a project of this name is not a page.
            let why = "exists and is not named as a page: give a name that ends with .html";
            return Err(Error::Use(printable(&format!("{}: {why}", target.display()))));
        }
        let first = if folder { target.join(INDEX) } else { target.to_owned() };
        if first.is_file() && !force {
            return Err(exists(&first));
        }
        if folder {
            std::fs::create_dir_all(target).map_err(|error| failed(target, &error))?;
        } else if target.is_dir() {
            let why = "is a folder: the comparison of two files is one page, give its name";
            return Err(Error::Use(printable(&format!("{}: {why}", target.display()))));
        }
        Ok(Pages { target: target.to_owned(), folder, entries: RefCell::default(), force, any: Cell::new(false) })
    }

    /// Whether a page was written.
    pub(super) fn has_page(&self) -> bool {
        self.any.get()
    }

    /// Writes the page of a comparison.
    pub(super) fn page(
        &self,
        both: &Both<'_>,
        how: Option<Paired>,
        sections: Sections,
        difference: &Difference,
    ) -> Result<(), Error> {
        let counts = [
            difference.logic.len(),
            difference.documentation.len(),
            difference.values.len(),
            difference.configuration.len(),
        ];
        let warnings: Vec<String> = both
            .files
            .iter()
            .filter(|read| !read.errors.is_empty())
            .map(|read| {
                let count = read.errors.len();
                let first = read.errors.first().map_or("", String::as_str);
                format!("{}: {count} parts could not be read ({first}): what is equal here may differ there", read.file)
            })
            .collect();
        let (old, new) = (both.names.0.as_str(), both.names.1.as_str());
        let comparison = Comparison {
            names: (old, new),
            sides: (&both.sides.0, &both.sides.1),
            difference,
            shown: Shown {
                logic: sections.logic,
                documentation: sections.documentation,
                values: sections.values,
                configuration: sections.configuration,
            },
            tool: &tool(),
            warnings: &warnings,
        };
        self.any.set(true);
        if !self.folder {
            return write(&self.target, |out| report::diff::page(&comparison, out));
        }
        let remark = match how {
            Some(Paired::Bytes) => "the same bytes under another name",
            Some(Paired::Content) => "found under another name by its content",
            _ if !warnings.is_empty() => "parts could not be read",
            _ if difference.is_empty() => "equal",
            _ => "",
        };
        let mut entry = Entry {
            href: String::new(),
            old: old.to_owned(),
            new: new.to_owned(),
            counts: Some(counts),
            remark: remark.to_owned(),
        };
        if !difference.is_empty() || !warnings.is_empty() {
            entry.href = self.name(new);
            let path = self.target.join(&entry.href);
            if path.is_file() && !self.force {
                return Err(exists(&path));
            }
            write(&path, |out| report::diff::page(&comparison, out))?;
        }
        self.entries.borrow_mut().push(entry);
        Ok(())
    }

    /// A file that is in one folder only or was not compared, for the list.
    pub(super) fn without_page(&self, old: &str, new: &str, remark: &str) {
        let entry = Entry { old: old.to_owned(), new: new.to_owned(), remark: remark.to_owned(), ..Entry::default() };
        self.entries.borrow_mut().push(entry);
    }

    /// Writes the list of pages, if folders were compared.
    pub(super) fn finish(&self, old: &Path, new: &Path) -> Result<PathBuf, Error> {
        if !self.folder {
            return Ok(self.target.clone());
        }
        let path = self.target.join(INDEX);
        let (old, new) = (old.display().to_string(), new.display().to_string());
        let entries = self.entries.borrow();
        write(&path, |out| report::diff::index((&old, &new), &tool(), &entries, out))?;
        Ok(path)
    }

    /// A name no other page has. Nothing of a project's name leads out of the folder.
    fn name(&self, file: &str) -> String {
        let number = self.entries.borrow().len() + 1;
        let last = Path::new(file).file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let plain = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '-' | '_') { c } else { '_' };
        format!("{number:04}-{}.html", last.chars().take(MOST_NAME).map(plain).collect::<String>())
    }
}

fn write(path: &Path, work: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> Result<(), Error> {
    let written = File::create(path).and_then(|file| {
        let mut out = BufWriter::new(file);
        work(&mut out)?;
        out.flush()
    });
    written.map_err(|error| failed(path, &error))
}
