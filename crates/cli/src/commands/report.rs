//! `rungs report`: a project as a document.

use std::cell::RefCell;
use std::collections::HashSet;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use ladder::Severity;
use report::html::Page;
use report::pdf::Format;
use report::{Document, DomoreSource, Options, Selection, Source};

use super::{Opened, domore::OpenedDomore, each_dialect};
use crate::args::{ImageChoice, Input, Medium, ReportArguments};
use crate::files::is_same_file;
use crate::output::{Error, Outcome, printable};

/// Name of the list of several reports.
const INDEX: &str = "index.html";

pub fn run(arguments: &ReportArguments) -> Result<Outcome, Error> {
    let sections = Selection::parse(&arguments.sections.join(","), &arguments.without.join(","));
    let options = Options { sections: sections.map_err(Error::Use)?, date: arguments.date.clone() };
    let input = Input { strict: arguments.strict, image: arguments.image, json: false };
    let many = arguments.files.len() > 1 || arguments.files.iter().any(|path| path.is_dir());
    let target = &arguments.out;
    if many {
        if target.is_file() {
            return Err(Error::Use(format!("several projects: {} must be a folder", target.display())));
        }
        std::fs::create_dir_all(target).map_err(|error| Error::Use(format!("{}: {error}", target.display())))?;
    }
    let medium = medium(arguments, many)?;
    let pages = RefCell::new(Pages { many, target, arguments, medium, names: HashSet::new(), list: Vec::new() });
    let slc = |opened: &Opened, out: &mut dyn Write| {
        let which = match opened.choice {
            ImageChoice::Main => "",
            ImageChoice::Online => "online image",
            ImageChoice::Autosave => "autosave image",
        };
        let (image, documentation) = (opened.image(), opened.documentation());
        let document = report::project(&Source { project: &opened.project, image, documentation, which }, &options);
        let page = Page {
            processor: document.processor.clone(),
            files: image.ladder_files().count(),
            rungs: image.ladder_files().map(|file| file.rungs.len()).sum(),
            saved_at: opened.project.source.saved_at.clone().unwrap_or_default(),
            ..described(&opened.path, &opened.project.source, &opened.project.diagnostics)
        };
        pages.borrow_mut().put(&opened.path, &document, page, out)
    };
    let domore = |opened: &OpenedDomore, out: &mut dyn Write| {
        let (source, project) = (&opened.document.source, &opened.document.project);
        let found: Vec<ladder::Diagnostic> = opened.document.diagnostics.iter().map(|it| it.to_ladder()).collect();
        let document = report::domore_project(
            &DomoreSource { source, project, diagnostics: &opened.document.diagnostics },
            &options,
        );
        let page = Page {
            processor: document.processor.clone(),
            files: project.code_blocks().count(),
            rungs: project.code_blocks().map(|block| block.rungs.len()).sum(),
            ..described(&opened.path, source, &found)
        };
        pages.borrow_mut().put(&opened.path, &document, page, out)
    };
    let outcome = each_dialect(&arguments.files, &input, slc, domore)?;
    let pages = pages.into_inner();
    if many { pages.write_index(arguments).map(|written| outcome.max(written)) } else { Ok(outcome) }
}

/// What `--to` names, else the ending of the file; pages in a folder.
fn medium(arguments: &ReportArguments, many: bool) -> Result<Medium, Error> {
    let ending = arguments.out.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    let named = match ending.as_deref() {
        Some("html" | "htm") => Some(Medium::Html),
        Some("pdf") => Some(Medium::Pdf),
        _ => None,
    };
    let medium = match (arguments.to, named) {
        (Some(wanted), Some(named)) if !many && wanted != named => {
            return Err(Error::Use(format!("{}: its ending is not that of what --to names", arguments.out.display())));
        }
        (Some(wanted), _) => wanted,
        (None, Some(named)) if !many => named,
        (None, _) if many => Medium::Html,
        (None, _) => {
            let place = arguments.out.display();
            return Err(Error::Use(format!("{place}: expected a name that ends with .html or .pdf, or --to")));
        }
    };
    if medium != Medium::Pdf && (arguments.paper.is_some() || arguments.landscape) {
        return Err(Error::Use("--paper and --landscape are for PDF".to_owned()));
    }
    Ok(medium)
}

/// What the list says of any project.
fn described(path: &Path, source: &ladder::Source, found: &[ladder::Diagnostic]) -> Page {
    let count = |severity| found.iter().filter(|it| it.severity == severity).count();
    let remark = match (count(Severity::Error), count(Severity::Warning)) {
        (0, 0) => String::new(),
        (0, deviations) => format!("deviations: {deviations}"),
        (parts, _) => format!("not read whole, parts missing: {parts}"),
    };
    Page { name: path.display().to_string(), sha256: source.sha256.clone(), remark, ..Page::default() }
}

/// Where pages go, and which there are.
struct Pages<'a> {
    many: bool,
    target: &'a Path,
    arguments: &'a ReportArguments,
    medium: Medium,
    names: HashSet<String>,
    list: Vec<Page>,
}

impl Pages<'_> {
    /// Writes one document, as a file or as one of the folder.
    fn put(
        &mut self,
        project: &Path,
        document: &Document<'_>,
        page: Page,
        out: &mut dyn Write,
    ) -> Result<Outcome, Error> {
        let (target, href) = if self.many {
            let name = self.name(project);
            (self.target.join(&name), name)
        } else {
            (self.target.to_owned(), String::new())
        };
        let why = match self.write(&target, |file| self.content(document, file)) {
            Ok(()) => {
                writeln!(out, "{}", target.display())?;
                self.list.push(Page { href, ..page });
                return Ok(Outcome::Done);
            }
            Err(why) => why,
        };
        if !self.many {
            return Err(Error::Use(why));
        }
        // One project must not stop the others.
        eprintln!("{}", printable(&format!("{}: not written: {why}", project.display())));
        self.list.push(Page { remark: format!("not written: {why}"), ..page });
        Ok(Outcome::NotWritten)
    }

    fn content(&self, document: &Document<'_>, file: &mut dyn Write) -> std::io::Result<()> {
        match self.medium {
            Medium::Html => report::html::page(document, file),
            Medium::Pdf => {
                let paper = self.arguments.paper.unwrap_or_default().into();
                let format = Format { paper, landscape: self.arguments.landscape, ..Format::default() };
                file.write_all(&report::pdf::write(document, format).bytes)
            }
        }
    }

    fn write(&self, target: &Path, content: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> Result<(), String> {
        // Not even --force lets a report replace the project it is of.
        if self.arguments.files.iter().any(|project| is_same_file(project, target)) {
            return Err(format!("{} is the project, and cannot be its report too", target.display()));
        }
        if target.exists() && !self.arguments.force {
            return Err(format!("{} exists; --force overwrites it", target.display()));
        }
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty());
        let file = folder.map_or(Ok(()), std::fs::create_dir_all).and_then(|()| std::fs::File::create(target));
        let written = file.and_then(|file| {
            let mut file = BufWriter::with_capacity(1 << 16, file);
            content(&mut file)?;
            file.flush()
        });
        written.map_err(|error| format!("{}: {error}", target.display()))
    }

    /// A file name of letters, digits, `-` and `_` from a project's path, another one for every project: two of
    /// a name lie in different folders.
    fn name(&mut self, project: &Path) -> String {
        let stem = project.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let letters: String = stem
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() || matches!(c, '-' | '_') { c } else { '_' })
            .take(80)
            .collect();
        let letters = if letters.is_empty() { "project".to_owned() } else { letters };
        let ending = match self.medium {
            Medium::Html => "html",
            Medium::Pdf => "pdf",
        };
        let mut name = format!("{letters}.{ending}");
        let mut number = 1;
        // Some file systems take upper and lower case for the same.
        while name.eq_ignore_ascii_case(INDEX) || !self.names.insert(name.to_ascii_lowercase()) {
            number += 1;
            name = format!("{letters}-{number}.{ending}");
        }
        name
    }

    fn write_index(self, arguments: &ReportArguments) -> Result<Outcome, Error> {
        let target: PathBuf = self.target.join(INDEX);
        let folders: Vec<String> = arguments.files.iter().map(|path| path.display().to_string()).collect();
        let title = if let [one] = folders.as_slice() { one.clone() } else { format!("{} projects", self.list.len()) };
        let tool = concat!("rungs ", env!("CARGO_PKG_VERSION"));
        let unread = "could not be read; see the messages of the run";
        let mut list = self.list.clone();
        for path in crate::files::expand(&arguments.files, crate::files::PROJECTS).map_err(Error::Use)? {
            let name = path.display().to_string();
            if !list.iter().any(|page| page.name == name) {
                // Never a list that lacks one silently.
                list.push(Page { name, remark: unread.to_owned(), ..Page::default() });
            }
        }
        list.sort_by(|a, b| a.name.cmp(&b.name));
        match self.write(&target, |file| report::html::index(&title, tool, &list, file)) {
            Ok(()) => {
                println!("{}", target.display());
                Ok(Outcome::Done)
            }
            Err(why) => Err(Error::Use(why)),
        }
    }
}
