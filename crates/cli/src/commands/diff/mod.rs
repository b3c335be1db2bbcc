//! `rungs diff`: what changed between two programs.

mod do_more;
mod folders;
mod html;
pub(super) mod json;
pub(super) mod text;
mod text_side;
mod unified;

use std::io::{IsTerminal, Write};
use std::path::Path;

use analysis::diff::{Difference, Side, compare};
use convert::AnyProject;
use convert::designer::Document;
use ladder::{Documentation, Image, Project, Severity};

use super::{MOST_BYTES, diagnostics_json, file_name, mode, read_file};
use crate::args::{DiffArguments, Section};
use crate::output::{Error, Outcome, Printable, printable};
use folders::Paired;

/// Columns when nobody tells.
const PIPE_WIDTH: usize = 100;

/// Narrowest terminal for two rungs beside each other.
const TWO_SIDED: usize = 2 * render::MIN_WIDTH + 3;

/// Which sections count and are shown.
#[derive(Clone, Copy)]
pub(super) struct Sections {
    logic: bool,
    documentation: bool,
    values: bool,
    configuration: bool,
}

impl Sections {
    fn only_documentation(self) -> bool {
        self.documentation && !(self.logic || self.values || self.configuration)
    }

    fn of(chosen: &[Section]) -> Sections {
        let has = |section| chosen.is_empty() || chosen.contains(&section);
        Sections {
            logic: has(Section::Logic),
            documentation: has(Section::Documentation),
            values: has(Section::Values),
            configuration: has(Section::Configuration),
        }
    }

    /// Leaves what was not asked for out of a difference.
    fn apply(self, difference: &mut Difference) {
        if !self.logic {
            difference.logic.clear();
            difference.renames.clear();
        }
        if !self.documentation {
            difference.documentation.clear();
        }
        if !self.values {
            difference.values.clear();
        }
        if !self.configuration {
            difference.configuration.clear();
        }
    }
}

/// A program with its name on the command line.
pub(super) struct Program<'a> {
    pub(super) name: String,
    pub(super) image: &'a Image,
    pub(super) documentation: &'a Documentation,
}

impl<'a> Program<'a> {
    fn main(path: &Path, project: &'a Project) -> Program<'a> {
        let image = &project.main;
        Program { name: path.display().to_string(), image, documentation: &image.documentation }
    }
}

/// How results are written.
struct Printer {
    sections: Sections,
    json: bool,
    unified: bool,
    look: text::Look,
    pages: Option<html::Pages>,
}

pub fn run(arguments: &DiffArguments) -> Result<Outcome, Error> {
    let terminal = std::io::stdout().is_terminal();
    let width = arguments.width.unwrap_or_else(|| match terminal_size::terminal_size() {
        Some((width, _)) if terminal => width.0.into(),
        _ => PIPE_WIDTH,
    });
    let compared: Vec<&Path> =
        [Some(&arguments.old), arguments.new.as_ref()].into_iter().flatten().map(|it| &**it).collect();
    let folder = compared.len() == 2 && compared.iter().all(|path| path.is_dir());
    let pages = arguments
        .html
        .as_ref()
        .map(|target| html::Pages::new(target, &compared, folder, arguments.force))
        .transpose()?;
    let printer = Printer {
        sections: Sections::of(&arguments.only),
        json: arguments.json,
        unified: arguments.unified,
        look: text::Look {
            width: width.clamp(render::MIN_WIDTH, render::MAX_WIDTH),
            two_sided: arguments.two_sided || width >= TWO_SIDED,
            color: terminal && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty()),
        },
        pages,
    };
    let mut out = crate::output::standard(arguments.json);
    let outcome = match (&arguments.new, arguments.online) {
        (Some(_), true) => {
            return Err(Error::Use("--online compares the two images of one file: leave out the second".to_owned()));
        }
        (None, false) => {
            return Err(Error::Use("expected a second file or folder, or --online for the online image".to_owned()));
        }
        (None, true) if printer.sections.only_documentation() => {
            // Nothing would be compared, and that is not the same as equal.
            let why = "--only documentation: an online image holds none, so that there is nothing to compare";
            return Err(Error::Use(why.to_owned()));
        }
        (None, true) => online(&arguments.old, arguments.strict, &printer, &mut out)?,
        (Some(new), false) => match (arguments.old.is_dir(), new.is_dir()) {
            (false, false) => pair((&arguments.old, new), arguments.strict, None, &printer, &mut out)?,
            (true, true) => folders::compare(&arguments.old, new, arguments.strict, &printer, &mut out)?,
            _ => return Err(Error::Use("expected two files or two folders, found one of each".to_owned())),
        },
    };
    if let Some(pages) = &printer.pages {
        // What was not readable has no page.
        if folder || outcome != Outcome::Unreadable || pages.has_page() {
            let path = pages.finish(&arguments.old, arguments.new.as_deref().unwrap_or(Path::new("")))?;
            writeln!(Printable(&mut out), "{}", path.display())?;
        }
    }
    out.flush()?;
    Ok(outcome)
}

/// The image last exchanged with a processor, against the program as an engineer opens it.
fn online(path: &Path, strict: bool, printer: &Printer, out: &mut dyn Write) -> Result<Outcome, Error> {
    if path.is_dir() {
        return Err(Error::Use("--online takes a file, not a folder".to_owned()));
    }
    let project = match opened(path, strict, printer, out)? {
        Some(Opened::Rslogix(project, _)) => project,
        Some(Opened::Domore(_)) => {
            let why = "a Do-more text holds no online image";
            return Err(Error::Use(printable(&format!("{}: {why}", path.display()))));
        }
        None => return Ok(Outcome::Unreadable),
    };
    let Some(image) = &project.online else {
        return Err(Error::Use(format!("{}: the project holds no online image", path.display())));
    };
    let documentation = &project.main.documentation;
    let name = path.display();
    let old = Program { name: format!("{name} (online image)"), image, documentation };
    let new = Program { name: name.to_string(), image: &project.main, documentation };
    let difference =
        compare(Side { image, documentation: None }, Side { image: &project.main, documentation: Some(documentation) });
    printer.print(&Both::rslogix(&old, &new, &[&project]), None, difference, out)
}

/// Two files; `how` they were found to belong together if their folders are compared.
fn pair(
    (old, new): (&Path, &Path),
    strict: bool,
    how: Option<Paired>,
    printer: &Printer,
    out: &mut dyn Write,
) -> Result<Outcome, Error> {
    let (a, b) = (opened(old, strict, printer, out)?, opened(new, strict, printer, out)?);
    let ((mut a, a_is_text), (mut b, b_is_text)) = match (a, b) {
        (Some(Opened::Rslogix(a, a_is_text)), Some(Opened::Rslogix(b, b_is_text))) => ((a, a_is_text), (b, b_is_text)),
        (Some(Opened::Domore(a)), Some(Opened::Domore(b))) => {
            return do_more::compare((old, &a), (new, &b), how, printer, out);
        }
        (Some(_), Some(_)) => return do_more::refuse(old, new, how, printer, out),
        _ => {
            if let Some(pages) = &printer.pages {
                pages.without_page(&old.display().to_string(), &new.display().to_string(), "could not be read");
            }
            return Ok(Outcome::Unreadable);
        }
    };
    match (a_is_text, b_is_text) {
        (true, false) => text_side::fill_in(&mut a, &b),
        (false, true) => text_side::fill_in(&mut b, &a),
        _ => {}
    }
    let (x, y) = (Program::main(old, &a), Program::main(new, &b));
    let mut difference = compare(
        Side { image: x.image, documentation: Some(x.documentation) },
        Side { image: y.image, documentation: Some(y.documentation) },
    );
    text_side::leave_out(&mut difference, a_is_text, b_is_text);
    let outcome = printer.print(&Both::rslogix(&x, &y, &[&a, &b]), how, difference, out);
    // Giving back two large models piece by piece would take longer than comparing them.
    std::mem::forget((a, b));
    outcome
}

/// A project of either dialect.
enum Opened {
    /// And whether it is rung text.
    Rslogix(Box<Project>, bool),
    Domore(Box<Document>),
}

/// A project, or `None` when it cannot be read, which is reported.
fn opened(path: &Path, strict: bool, printer: &Printer, out: &mut dyn Write) -> Result<Option<Opened>, Error> {
    let read = read_file(path, MOST_BYTES).and_then(|bytes| {
        let project = convert::open_any(&bytes, &file_name(path), mode(strict)).map_err(|error| error.to_string())?;
        Ok((project, text_side::is_text(&bytes)))
    });
    let why = match read {
        Ok((AnyProject::Rslogix(project), is_text)) => return Ok(Some(Opened::Rslogix(project, is_text))),
        Ok((AnyProject::Domore(document), _)) => return Ok(Some(Opened::Domore(document))),
        Err(why) => why,
    };
    if printer.json {
        writeln!(out, "{}", serde_json::json!({"file": path.display().to_string(), "error": why}))?;
    }
    eprintln!("{}", printable(&format!("{}: {why}", path.display())));
    Ok(None)
}

/// Two programs as they are shown, whatever their dialect.
struct Both<'p> {
    names: (String, String),
    sides: (report::diff::Side<'p>, report::diff::Side<'p>),
    /// For rung text with its context.
    rslogix: Option<(&'p Program<'p>, &'p Program<'p>)>,
    files: Vec<Read>,
}

/// What reading a file found wrong.
struct Read {
    file: String,
    diagnostics: serde_json::Value,
    /// Parts that are missing.
    errors: Vec<String>,
}

impl<'p> Both<'p> {
    fn rslogix(old: &'p Program<'p>, new: &'p Program<'p>, projects: &[&Project]) -> Both<'p> {
        let side = |program: &'p Program<'p>| report::diff::Side::rslogix(program.image, program.documentation);
        let read = |project: &&Project| {
            let errors = project.diagnostics.iter().filter(|found| found.severity == Severity::Error);
            Read {
                file: project.source.file.clone(),
                diagnostics: diagnostics_json(project),
                errors: errors.map(|found| format!("{}: {}", found.place, found.message)).collect(),
            }
        };
        Both {
            names: (old.name.clone(), new.name.clone()),
            sides: (side(old), side(new)),
            rslogix: Some((old, new)),
            files: projects.iter().map(read).collect(),
        }
    }
}

impl Printer {
    fn print(
        &self,
        both: &Both<'_>,
        how: Option<Paired>,
        mut difference: Difference,
        out: &mut dyn Write,
    ) -> Result<Outcome, Error> {
        self.sections.apply(&mut difference);
        let (old, new) = (both.names.0.as_str(), both.names.1.as_str());
        if let Some(pages) = &self.pages {
            pages.page(both, how, self.sections, &difference)?;
        } else if self.json {
            let mut document = json::describe(old, new, &difference);
            if both.rslogix.is_none() {
                do_more::name_places(&mut document, &difference, &both.sides);
            }
            if let Some(how) = how {
                document["paired_by"] = how.as_str().into();
            }
            document["diagnostics"] = both.files.iter().map(|read| read.diagnostics.clone()).collect();
            writeln!(out, "{document}")?;
        } else {
            let renamed = match how {
                Some(Paired::Bytes) => "the same bytes under another name",
                Some(Paired::Content) => "found under another name by its content",
                _ => "",
            };
            if !renamed.is_empty() {
                writeln!(Printable(&mut *out), "# {old} is now {new}: {renamed}")?;
            }
            if self.unified {
                let listings = match both.rslogix {
                    Some((old, new)) => (unified::Listing::rslogix(old), unified::Listing::rslogix(new)),
                    None => {
                        (unified::Listing::domore(old, &both.sides.0), unified::Listing::domore(new, &both.sides.1))
                    }
                };
                unified::write(self.sections, (&listings.0, &listings.1), &difference, out)?;
            } else if how.is_some() && difference.is_empty() {
                writeln!(Printable(&mut *out), "{new}: equal\n")?;
            } else {
                let sides = ((old, &both.sides.0), (new, &both.sides.1));
                text::write(&self.look, self.sections, sides, &difference, out)?;
            }
        }
        out.flush()?;
        let mut whole = true;
        for Read { file, errors, .. } in both.files.iter().filter(|read| !read.errors.is_empty()) {
            whole = false;
            for found in errors.iter().take(5) {
                eprintln!("{}", printable(&format!("{file}: {found}")));
            }
            let count = errors.len();
            eprintln!(
                "{}: not all of it could be read ({count} errors): what is equal above may differ there",
                printable(file)
            );
        }
        Ok(match (whole, difference.is_empty()) {
            (false, _) => Outcome::Unreadable,
            (true, true) => Outcome::Done,
            (true, false) => Outcome::Finding,
        })
    }
}
